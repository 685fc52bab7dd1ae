/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Burgers' equation from frames that move with the velocity lambda, (t, x, u) -> (t, x + lambda t, u + lambda). It is not
   Hamiltonian: what counts are its symmetries, boosts and projections among them, with which the exact flow commutes.
   Razafindralandy, Hamdouni & Chhay (2018), section "Invariantisation". */
#include <math.h>

#include "core/field/families/burgers.h"
#include "scenes/field/frames.h"

static double lambda_of(const struct gm_view *view)
{
    return gm_framed_of(view->problem)->lambda;
}

double gm_burgers_at_rest(const struct gm_view *view, size_t node)
{
    return view->state[node] - lambda_of(view);
}

double gm_burgers_exact_at_rest(const struct gm_view *view, double x)
{
    return gm_frame_exact(gm_framed_of(view->problem), lambda_of(view), x, view->t) - lambda_of(view);
}

/* Returns the largest error at a node; *sum is that of all. */
static double error(const struct gm_view *view, double *sum)
{
    double largest = *sum = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        const double one = fabs(view->state[j] - gm_exact_at_node(view, j));
        largest = fmax(largest, one);
        *sum += one;
    }
    return largest;
}

double gm_burgers_sup_error(const struct gm_view *view)
{
    double sum;
    return error(view, &sum);
}

double gm_burgers_l1_error(const struct gm_view *view)
{
    double sum;
    error(view, &sum);
    return view->problem->line.dx * sum;
}

double gm_burgers_amplitude(const struct gm_view *view)
{
    double largest = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        largest = fmax(largest, fabs(gm_burgers_at_rest(view, j)));
    }
    return largest;
}

double gm_burgers_overshoot(const struct gm_view *view)
{
    return fmax(0, gm_burgers_amplitude(view) - 1);
}

double gm_burgers_galilean_defect(const struct gm_view *view)
{
    const double lambda = lambda_of(view);
    const size_t points = view->problem->line.points;
    if (lambda == 0) {
        return 0;
    }
    const double *companion = view->state + points;
    if (companion[points] == 0) {
        return NAN;
    }
    const double back = gm_frame_travel(view) / view->problem->line.dx;
    double largest = 0;
    for (size_t j = 0; j < points; j++) {
        const double place = (double)j - back, nearest = round(place);
        const double below = fabs(place - nearest) < 1e-6 ? nearest : floor(place), part = place - below;
        if (!(below >= 0 && below + 1 < (double)points)) {
            continue;
        }
        const size_t at = (size_t)below;
        const double there =
            fabs(part) < 1e-6 ? companion[at] : (1 - part) * companion[at] + part * companion[at + 1];
        largest = fmax(largest, fabs(view->state[j] - lambda - there));
    }
    return largest;
}

/* Returns the defect on the three nodes 0.3 - h, 0.3, 0.3 + h with the values 0.4, 0.3, 0.15. */
static double defect(const struct gm_view *view, const struct gm_burgers_symmetry *symmetry)
{
    static const double u[3] = {0.4, 0.3, 0.15};
    return gm_burgers_defect(view->scheme, gm_burgers_of(view->problem), view->problem->line.dx, view->dt,
                             symmetry, 0.3, u);
}

double gm_burgers_projection_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_burgers_symmetry){.a4 = 0.5, .scale = 1});
}

double gm_burgers_scaling_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_burgers_symmetry){.scale = 1.3});
}

double gm_burgers_compression(const struct gm_view *view)
{
    const double half = view->dt / (2 * view->problem->line.dx);
    double largest = 0;
    for (size_t j = 1; j + 1 < view->problem->line.points; j++) {
        largest = fmax(largest, half * (view->state[j - 1] - view->state[j + 1]));
    }
    return largest;
}

/* Carries by the frame of the lane's scheme, also of schemes that do not step in one. */
static bool carry(const struct gm_view *view, size_t j, double unit, struct gm_event *seen,
                  struct gm_event *carried)
{
    (void)unit;
    const struct gm_burgers_symmetry frame = gm_burgers_frame(view->scheme, gm_burgers_of(view->problem),
                                                              view->problem->line.dx, view->state + j - 1);
    for (size_t e = 0; e < 2 * GM_STENCIL; e++) {
        carried[e] = gm_burgers_carried(&frame, seen[e]);
    }
    return frame.a4 * view->dt < 1;
}

void gm_burgers_draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_burgers_row *row = lanes[0]->scheme->coefficients;
    const struct gm_axes_style look = {
        .title = "The moving frame at a node of Burgers' equation",
        .note = "",
        .constant = gm_picture_text(picture, ",  ν = %g", gm_burgers_of(&lanes[0]->problem)->viscosity),
        .value = "u",
        .carried = "û",
        .section = row->family ? "a ûⱼ₊₁ + (1 + a) ûⱼ₋₁ = (1 + 2a) ûⱼ,  ûⱼ = d h² D₂û" : "ûⱼ = 0,  D₀û = 0",
        .carry = carry};
    gm_draw_moving_frame(picture, lanes, count, &look);
}
