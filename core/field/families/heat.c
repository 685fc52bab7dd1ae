/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes for the heat equation u_t = nu u_xx: forward in time and centred in space, and what moving frames
   make of it. The time step is k, v = u^{n+1}, r = nu k/h^2, sigma the displacement of a node in a step:
       ordinary      v = u + r (u_{j+1} - 2 u_j + u_{j-1})
   commutes with scalings (t, x) -> (s^2 t, s x), and with no boost. The boost of the velocity
       a = (nu/h) ln(u_{j+1}/u_{j-1})
   turns the three values around a node into equal ones on both sides, w = sqrt(u_{j+1} u_{j-1}), and the node
   arrives sigma + a k away; there the step is made, and carried back:
       boosts        v = exp(a sigma/(2 nu) + a^2 k/(4 nu)) [u + 2 r (w - u)]
   The projection with p = (4 nu/h^2) ln(w/u_j) then makes all three the same, which diffusion leaves alone:
       projections   v = u exp(a sigma/(2 nu) + a^2 k/(4 nu) + p (sigma + a k)^2/(4 nu m)) / sqrt(m)
                     m = 1 - p k
   It is exact where ln u is a quadratic in x. Both need u > 0, the last one p k < 1; the one of boosts, like
   convection by centred differences, is stable for a^2 k < 2 nu.

   Razafindralandy et al. (2018), eqs. 73 to 75, 83 and 91; the boosts are those of P.J. Olver, Applications
   of Lie Groups to Differential Equations (1993), ex. 2.41; the frame is built as theirs for Burgers'
   equation, whose slope -u/2nu is that of ln u (E. Hopf, Comm. Pure Appl. Math. 3 (1950) 201). */
#include "core/field/families/between_ends.h"
#include "core/functions/functions.h"

#include "core/field/families/family.h"

const struct gm_problem gm_problem_heat = {
    .name = "heat",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_HEAT},
    .m = 1,
    .bound = 1e200,
};

double gm_heat_factor(const struct gm_framed *framed, bool fixed, double x, double t)
{
    const double lambda = framed->lambda, passed = t - framed->line.begin;
    const double original = fixed ? x - lambda * passed : x;
    return gm_exp(-lambda / (4 * framed->viscosity) * (2 * original + lambda * passed));
}

static enum gm_status ordinary(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double *u = step->u, r = step->framed->viscosity * step->k / (step->h * step->h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        step->out[j] = u[j] + r * (u[j + 1] - 2 * u[j] + u[j - 1]);
    }
    progress->evaluations++;
    return GM_OK;
}

static enum gm_status by_boosts(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double nu = step->framed->viscosity, h = step->h, k = step->k, *u = step->u, r = nu * k / (h * h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double a = nu / h * gm_log(u[j + 1] / u[j - 1]);
        const double away = a / (4 * nu) * (2 * step->sigma + a * k);
        step->out[j] = gm_exp(away) * (u[j] + 2 * r * (sqrt(u[j + 1]) * sqrt(u[j - 1]) - u[j]));
    }
    progress->evaluations++;
    return GM_OK;
}

static enum gm_status by_projections(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double nu = step->framed->viscosity, h = step->h, k = step->k, *u = step->u;
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double right = gm_log(u[j + 1] / u[j]), left = gm_log(u[j - 1] / u[j]);
        const double a = nu / h * (right - left), p = 2 * nu / (h * h) * (right + left), m = 1 - p * k;
        const double arrival = step->sigma + a * k;
        const double away = a * (2 * step->sigma + a * k) + p * arrival * arrival / m;
        step->out[j] = u[j] * gm_exp(away / (4 * nu)) / sqrt(m);
    }
    progress->evaluations++;
    return GM_OK;
}

/* (t, x, u) -> (t, x + b t, u exp(-b x/(2 nu) - b^2 t/(4 nu)))
   (t, x, u) -> (t, x, sqrt(1 - p t) u exp(-p x^2/(4 nu (1 - p t)))) / (1 - p t, 1 - p t, 1)
   (t, x, u) -> (s^2 t, s x, u);   u is NaN if the projection does not exist */
static struct gm_event carry(const struct gm_framed *framed, const struct gm_point_symmetry *symmetry,
                             struct gm_event event)
{
    const double b = symmetry->boost, p = symmetry->projection, s = symmetry->scale;
    const double m = 1 - p * event.t, x = event.x + b * event.t;
    const double power = b * (2 * event.x + b * event.t) + p * x * x / m;
    return (struct gm_event){.t = s * s * event.t / m,
                             .x = s * x / m,
                             .u = event.u * gm_exp(-power / (4 * framed->viscosity)) * sqrt(m)};
}

/* The boost that makes both neighbours equal, of schemes without frames too, and of those that preserve projections the
   one after which all three are. */
static bool find(const struct gm_problem *problem, const struct gm_scheme *scheme, double k, const double *u,
                 size_t j, struct gm_point_symmetry *frame)
{
    const double right = gm_log(u[j + 1] / u[j]), left = gm_log(u[j - 1] / u[j]);
    const double nu = gm_framed_of(problem)->viscosity, h = problem->line.dx;
    *frame = (struct gm_point_symmetry){
        .boost = nu / h * (right - left),
        .projection = gm_ends_are_special(scheme) ? 2 * nu / (h * h) * (right + left) : 0,
        .scale = 1,
    };
    return isfinite(frame->boost) && frame->projection * k < 1;
}

/* About the middle of the nodes, the largest over all, divided by the value there. The carried nodes move, which only
   invariant schemes take into account. */
static double defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                     const struct gm_point_symmetry *symmetry, const double *u)
{
    const struct gm_grid1 *grid = &problem->line;
    struct gm_ends_step step = {.framed = gm_framed_of(problem), .points = 3, .h = grid->dx, .k = k};
    double largest = 0, arrival;
    for (size_t j = 1; j + 1 < grid->points; j++) {
        const double here = gm_grid1_node(grid, j) - gm_grid1_node(grid, (grid->points - 1) / 2);
        step.u = u + j - 1;
        const double made = gm_ends_carried(scheme->coefficients, carry, &step, symmetry, here, &arrival);
        largest = gm_larger(largest, fabs(made / arrival - 1));
    }
    return largest;
}

static double seen(const struct gm_framed *framed, bool fixed, double x, double t, double u)
{
    return u / gm_heat_factor(framed, fixed, x, t);
}

const struct gm_moving_frames gm_frames_of_heat = {carry, find, defect, seen, gm_ends_are_special};

#define OF_HEAT .family = &gm_family_heat, .needs = GM_NEEDS_HEAT

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_heat_ftcs, OF_HEAT, .coefficients = &(const struct gm_ends_method){.make = ordinary}},
    {GM_TEXTS_heat_boosts, OF_HEAT, .coefficients = &(const struct gm_ends_method){.make = by_boosts}},
    {GM_TEXTS_heat_projections, OF_HEAT,
     .coefficients = &(const struct gm_ends_method){.make = by_projections, .special = true}},
};

const struct gm_family gm_family_heat = {
    .title = "Heat equation, standard and invariantised",
    GM_FIELD_FAMILY,
    GM_ENDS_LOOP,
};
