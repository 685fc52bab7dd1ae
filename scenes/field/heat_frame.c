/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The heat equation from frames that move with the velocity lambda,
       (t, x, u) -> (t, x + lambda t, u exp(-lambda x/(2 nu) - lambda^2 t/(4 nu)))
   Razafindralandy, Hamdouni & Chhay (2018), section "Invariant integrators", eqs. 73 to 75 and 83. */
#include <math.h>
#include <stdio.h>

#include "core/field/families/heat.h"
#include "core/functions/functions.h"
#include "scenes/field/frames.h"

/* Returns the divisor of a value at a node that gives the value in the original frame. */
static double factor(const struct gm_view *view, size_t j)
{
    const struct gm_heat *heat = gm_heat_of(view->problem);
    return gm_heat_factor(heat, gm_frame_rests(&heat->framed, view->scheme),
                          gm_grid1_node(&view->problem->line, j), view->t);
}

double gm_heat_at_rest(const struct gm_view *view, size_t j)
{
    return view->state[j] / factor(view, j);
}

double gm_heat_exact_at_rest(const struct gm_view *view, double x)
{
    const struct gm_heat *heat = gm_heat_of(view->problem);
    return gm_frame_exact(&heat->framed, heat->framed.lambda, x, view->t) /
           gm_heat_factor(heat, false, x, view->t);
}

double gm_heat_error(const struct gm_view *view)
{
    double largest = 0;
    for (size_t j = 0; j < view->problem->n; j++) {
        largest = fmax(largest, fabs(view->state[j] - gm_exact_at_node(view, j)) / factor(view, j));
    }
    return largest;
}

static double defect(const struct gm_view *view, const struct gm_heat_symmetry *symmetry)
{
    return gm_heat_defect(view->problem, view->scheme, view->dt, symmetry, view->state);
}

double gm_heat_boost_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_heat_symmetry){.boost = 0.5, .scale = 1});
}

double gm_heat_projection_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_heat_symmetry){.projection = 0.5, .scale = 1});
}

double gm_heat_scaling_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_heat_symmetry){.scale = 1.3});
}

void gm_heat_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_grid1 *grid = &view->problem->line;
    text[0] = '\0';
    for (size_t j = 1; gm_heat_keeps(view->scheme) & GM_HEAT_BOOSTS && j + 1 < grid->points; j++) {
        const struct gm_heat_symmetry frame = gm_heat_frame(
            view->scheme, gm_heat_of(view->problem)->diffusivity, grid->dx, view->state + j - 1);
        if (!isfinite(frame.boost)) {
            snprintf(text, size, "u is not positive near x = %.4g, where no boost levels it",
                     gm_grid1_node(grid, j));
            return;
        }
        if (frame.projection * view->dt >= 1) {
            snprintf(text, size, "no projection levels u near x = %.4g: p dt = %.3g is not below 1",
                     gm_grid1_node(grid, j), frame.projection * view->dt);
            return;
        }
    }
}

/* Carries by the frame of the lane's scheme, or by boosts if that has no frame; values are logarithms. */
static bool carry(const struct gm_view *view, size_t j, double unit, struct gm_event *seen,
                  struct gm_event *carried)
{
    (void)unit;
    const double nu = gm_heat_of(view->problem)->diffusivity;
    const struct gm_heat_symmetry frame =
        gm_heat_frame(view->scheme, nu, view->problem->line.dx, view->state + j - 1);
    for (size_t e = 0; e < 2 * GM_STENCIL; e++) {
        seen[e].u /= view->state[j];
        carried[e] = gm_heat_carried(nu, &frame, seen[e]);
        carried[e].u = gm_log(carried[e].u);
        seen[e].u = gm_log(seen[e].u);
    }
    return isfinite(frame.boost) && frame.projection * view->dt < 1;
}

void gm_heat_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    bool any = false, all = true;
    for (size_t i = 0; i < count; i++) {
        const bool projected = gm_heat_keeps(lanes[i]->scheme) & GM_HEAT_PROJECTIONS;
        any |= projected;
        all &= projected;
    }
    const char *const some = any ? "ûⱼ₋₁ = ûⱼ₊₁, by projections = ûⱼ" : "ûⱼ₋₁ = ûⱼ₊₁";
    const struct gm_axes_style look = {
        .title = "The moving frame at a node of the heat equation",
        .note = "",
        .constant = gm_picture_text(picture, ",  ν = %g", gm_heat_of(&lanes[0]->problem)->diffusivity),
        .value = "ln u/uⱼ",
        .carried = "ln û/ûⱼ",
        .section = all ? "ûⱼ₋₁ = ûⱼ = ûⱼ₊₁" : some,
        .carry = carry};
    gm_draw_moving_frame(picture, lanes, count, &look);
}
