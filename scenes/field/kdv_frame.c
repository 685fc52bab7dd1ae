/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Korteweg-de Vries equation from frames that move with the velocity lambda,
       (t, x, u) -> (t, x + lambda t, u + lambda/eta)
   drawn at rest: schemes that step in a moving frame, on nodes that move along, give one and the same from
   each; with show=frame the nodes around one and where the moving frame carries them, as in figures 19 to 23
   of Razafindralandy, Hamdouni & Chhay (2018) for Burgers' equation. */
#include "scenes/field/kdv_frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/field/families/kdv_moving_frames.h"
#include "core/field/problems/dispersive.h"
#include "scenes/field/moving_frame.h"

/* Returns how far the nodes have moved from their start, in the original frame. */
static double travelled(const struct gm_view *view)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    return gm_kdv_fixed(kdv, view->scheme) ? -kdv->lambda * view->t : 0;
}

double gm_kdv_shift(const struct gm_view *view)
{
    return gm_kdv_of(view->problem)->lambda * view->t + travelled(view);
}

double gm_kdv_at_rest(const struct gm_view *view, size_t node)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    const size_t points = view->problem->line.points;
    const double place = (double)node - travelled(view) / view->problem->line.dx;
    const double below = floor(place), part = place - below;
    const double around = below - floor(below / (double)points) * (double)points;
    const size_t here = around < (double)points ? (size_t)around : 0, next = here + 1 < points ? here + 1 : 0;
    const double u = part > 0 ? (1 - part) * view->state[here] + part * view->state[next] : view->state[here];
    return u - kdv->lambda / kdv->eta;
}

double gm_kdv_boost_defect(const struct gm_view *view)
{
    return gm_kdv_defect(view->problem, view->scheme, view->dt,
                         &(const struct gm_kdv_symmetry){.boost = 0.5, .scale = 1}, view->state);
}

double gm_kdv_scaling_defect(const struct gm_view *view)
{
    return gm_kdv_defect(view->problem, view->scheme, view->dt, &(const struct gm_kdv_symmetry){.scale = 1.3},
                         view->state);
}

/* Returns the place of the node that is shown; 0 if the file has no parameter `at`. */
static double place_of(const struct gm_lane *lane)
{
    const struct gm_parameter *row = gm_scene_parameter(lane->scene, "at");
    return row ? gm_parameter_get(row, lane->parameters) : 0;
}

/* Returns the moving frame at a node in which the lane's scheme steps next; the scaling that makes the nodes
   `unit` apart follows the boost. */
static struct gm_moving_frame moving_frame(const struct gm_lane *lane, double unit)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_kdv *kdv = gm_kdv_of(view.problem);
    const struct gm_grid1 *grid = &view.problem->line;
    const size_t points = grid->points;
    const double sigma = gm_kdv_fixed(kdv, view.scheme) ? 0 : kdv->lambda * view.dt;
    const double at = place_of(lane) - travelled(&view);
    const double turns = floor((at - grid->first) / (grid->dx * (double)points));
    const size_t j = gm_stencil_node(grid, at - turns * grid->dx * (double)points);
    double *boosts = malloc(points * sizeof *boosts);
    struct gm_moving_frame made = {
        .known = gm_kdv_has_frames(view.scheme) && boosts &&
                 gm_kdv_moving_frames(view.problem, view.scheme, view.dt, view.state, boosts)};
    const struct gm_kdv_symmetry frame = {.boost = made.known ? boosts[j] : 0, .scale = unit / grid->dx};
    for (size_t e = 0; made.known && e < 2 * GM_STENCIL; e++) {
        const size_t i = j + e % GM_STENCIL - GM_STENCIL / 2;
        const bool next = e >= GM_STENCIL;
        made.seen[e] = (struct gm_event){.t = next ? view.dt : 0,
                                         .x = ((double)i - (double)j) * grid->dx + (next ? sigma : 0),
                                         .u = view.state[i]};
        made.carried[e] = gm_kdv_carried(kdv, &frame, made.seen[e]);
    }
    free(boosts);
    return made;
}

void gm_kdv_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const double h = lanes[0]->problem.line.dx;
    struct gm_moving_frame *made = gm_picture_memory(picture, count * sizeof *made);
    bool any = false, all = true;
    for (size_t i = 0; made && i < count; i++) {
        made[i] = moving_frame(lanes[i], h);
        any |= gm_kdv_solves(lanes[i]->scheme);
        all &= gm_kdv_solves(lanes[i]->scheme);
    }
    picture->title = "The moving frame at a node of the Korteweg-de Vries equation";
    picture->subtitle = gm_picture_text(picture, "the node nearest to x = %g,  h = %.3g,  k = %s,  and ĥ = h",
                                        place_of(lanes[0]), h, gm_step_text(picture, lanes[0]->run->dt));
    const struct gm_axes_style look = {.h = h,
                                       .k = lanes[0]->run->dt,
                                       .value = "u",
                                       .carried = "û",
                                       .section = all ? "û + v̂ⱼ = 0 where the node arrives"
                                                  : any
                                                      ? "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0, or û + v̂ⱼ = 0 where it arrives"
                                                      : "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0"};
    gm_draw_clock(picture, lanes, count);
    if (made) {
        gm_draw_moving_frame(picture, lanes, count, made, &look);
    }
}

void gm_kdv_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    double steepest = 0;
    for (size_t i = 0; i < grid->points; i++) {
        const size_t right = i + 1 < grid->points ? i + 1 : 0;
        steepest = fmax(steepest, kdv->eta * fabs(view->state[right] - view->state[i]) / grid->dx);
    }
    text[0] = '\0';
    if (gm_kdv_solves(view->scheme) && steepest * fabs(view->dt) >= 2) {
        snprintf(text, size,
                 "neighbours that move with the wave meet within a step: eta |u_x| dt = %.3g is not below 2",
                 steepest * fabs(view->dt));
    }
}
