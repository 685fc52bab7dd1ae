/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Korteweg-de Vries equation from frames that move with the velocity lambda,
       (t, x, u) -> (t, x + lambda t, u + lambda/eta)
   drawn at rest: schemes that step in a moving frame, on nodes that move along, give one and the same from
   each; with show=frame the nodes around one and where the moving frame carries them, as in figures 19 to 23
   of Razafindralandy, Hamdouni & Chhay (2018) for Burgers' equation. */
#include "scenes/field/frames.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/field/families/kdv_moving_frames.h"
#include "core/field/problems/dispersive.h"

double gm_kdv_shift(const struct gm_view *view)
{
    return gm_kdv_of(view->problem)->framed.lambda * view->t - gm_frame_travel(view);
}

double gm_kdv_at_rest(const struct gm_view *view, size_t node)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    const size_t points = view->problem->line.points;
    const double place = (double)node + gm_frame_travel(view) / view->problem->line.dx;
    const double below = floor(place), part = place - below;
    const double around = below - floor(below / (double)points) * (double)points;
    const size_t here = around < (double)points ? (size_t)around : 0, next = here + 1 < points ? here + 1 : 0;
    const double u = part > 0 ? (1 - part) * view->state[here] + part * view->state[next] : view->state[here];
    return u - kdv->framed.lambda / kdv->eta;
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

/* Carries by the frame in which the lane's scheme steps next; the scaling that makes the nodes `unit` apart follows the
   boost. */
static bool carry(const struct gm_view *view, size_t j, double unit, struct gm_event *seen,
                  struct gm_event *carried)
{
    double *boosts = malloc(view->problem->line.points * sizeof *boosts);
    const bool known = gm_kdv_has_frames(view->scheme) && boosts &&
                       gm_kdv_moving_frames(view->problem, view->scheme, view->dt, view->state, boosts);
    const struct gm_kdv_symmetry frame = {.boost = known ? boosts[j] : 0,
                                          .scale = unit / view->problem->line.dx};
    for (size_t e = 0; e < 2 * GM_STENCIL; e++) {
        carried[e] = gm_kdv_carried(gm_kdv_of(view->problem), &frame, seen[e]);
    }
    free(boosts);
    return known;
}

void gm_kdv_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    bool any = false, all = true;
    for (size_t i = 0; i < count; i++) {
        any |= gm_kdv_solves(lanes[i]->scheme);
        all &= gm_kdv_solves(lanes[i]->scheme);
    }
    const char *const some =
        any ? "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0, or û + v̂ⱼ = 0 where it arrives" : "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0";
    const struct gm_axes_style look = {.title =
                                           "The moving frame at a node of the Korteweg-de Vries equation",
                                       .constant = "",
                                       .note = ",  and ĥ = h",
                                       .value = "u",
                                       .carried = "û",
                                       .section = all ? "û + v̂ⱼ = 0 where the node arrives" : some,
                                       .carry = carry};
    gm_draw_moving_frame(picture, lanes, count, &look);
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
