/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes for u_t + u u_x = nu u_xx and their invariantised forms, which commute with its symmetries.

   The time step is k, v = u^{n+1}, D0 u = (u_{j+1} - u_{j-1})/(2h), D2 u = (u_{j+1} - 2 u_j + u_{j-1})/h^2:
       FTCS              v = u - k u D0 u + k nu D2 u
       Lax-Wendroff      v = u - k D0 f + k^2/(2h^2) [A+ (f_{j+1} - f_j) - A- (f_j - f_{j-1})] + k nu D2 u
                         f = u^2/2,   A+- = (u_j + u_{j+-1})/2
       Crank-Nicolson    (v - u)/k + (v D0 v + u D0 u)/2 = nu/2 (D2 u + D2 v)
   with D0(u^2/2) instead of u D0 u, but where the problem asks for the printed form.

   A moving frame turns the three values around a node into u = 0, D0 u = 0 by a boost and a projection with
       a4 = -D0 u,   m = 1 + k D0 u;
   there the step is made, and transformed back. A node that moves by sigma a step gives a5 = -sigma/k (the
   print omits sigma a4):
       FTCS              v = [u - sigma a4 + k nu D2 u / m] / m
       Lax-Wendroff      v = [u - sigma a4 + k/m (nu + k a^2/(2m)) D2 u] / m
                         a = (u_{j+1} + 2 u_j + u_{j-1})/4 + a5
       Crank-Nicolson    m (m v + sigma a4 - u)/k + (m v + sigma a4 + a5) m (m D0 v + a4)/2
                             = nu/2 (D2 u + m^3 D2 v)
   It is one of a family (eqs. 117 to 119), whose two numbers a and d every symmetry is kept with:
       a4 = [a u_{j+1} - (1 + 2 a) u_j + (1 + a) u_{j-1}]/h,   a5 = d h^2 D2 u - u_j,   m = 1 - k a4
       FTCS              v = [u - sigma a4 + k/m (nu D2 u - (u + a5) (D0 u + a4))] / m
   There D0 u + a4 = (a + 1/2) h D2 u: what is left of the convection diffuses by (u - sigma/k)(a + 1/2) h,
   which only a = -1/2, the frame above, turns into second order in h; d then has no effect.
   M. Chhay & A. Hamdouni, Symmetry 2 (2010) 868; Razafindralandy et al. (2018), eqs. 97 to 123. */
#include "core/field/families/between_ends.h"

#include "core/field/families/family.h"
#include "core/linear/settled.h"

const struct gm_problem gm_problem_burgers = {
    .name = "Burgers",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_BURGERS},
    .m = 1,
    .bound = 1e3,
};

static const struct gm_burgers *burgers_of(const struct gm_ends_step *step)
{
    return (const struct gm_burgers *)step->framed;
}

GM_CLONES static enum gm_status ftcs(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double *restrict u = step->u;
    double *restrict v = step->out;
    const double k = step->k, h = step->h, viscosity = step->framed->viscosity;
    const double convection = k / (2 * h), diffusion = viscosity * k / (h * h);
    progress->evaluations++;
    if (burgers_of(step)->printed) {
        /* the order of the formula matters: at h/nu > 2 rounding errors grow */
        for (size_t j = 1; j + 1 < step->points; j++) {
            v[j] = u[j] - k * u[j] * (u[j + 1] - u[j - 1]) / (2 * h) +
                   k * viscosity * (u[j + 1] - 2 * u[j] + u[j - 1]) / (h * h);
        }
        return GM_OK;
    }
    for (size_t j = 1; j + 1 < step->points; j++) {
        v[j] = u[j] - convection * (u[j + 1] * u[j + 1] - u[j - 1] * u[j - 1]) / 2 +
               diffusion * (u[j + 1] - 2 * u[j] + u[j - 1]);
    }
    return GM_OK;
}

GM_CLONES static enum gm_status lax_wendroff(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double *restrict u = step->u;
    double *restrict v = step->out;
    const double ratio = step->k / step->h;
    const double diffusion = step->framed->viscosity * step->k / (step->h * step->h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double left = u[j - 1] * u[j - 1] / 2, here = u[j] * u[j] / 2, right = u[j + 1] * u[j + 1] / 2;
        const double second = (u[j] + u[j + 1]) / 2 * (right - here) - (u[j - 1] + u[j]) / 2 * (here - left);
        v[j] = u[j] - ratio / 2 * (right - left) + ratio * ratio / 2 * second +
               diffusion * (u[j + 1] - 2 * u[j] + u[j - 1]);
    }
    progress->evaluations++;
    return GM_OK;
}

GM_CLONES static enum gm_status ftcs_invariant(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double *restrict u = step->u;
    double *restrict v = step->out;
    const double k = step->k, sigma = step->sigma, over_2h = 1 / (2 * step->h);
    const double diffusion = step->framed->viscosity * k / (step->h * step->h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double slope = over_2h * (u[j + 1] - u[j - 1]), m = 1 + k * slope;
        v[j] = (u[j] + sigma * slope + diffusion * (u[j + 1] - 2 * u[j] + u[j - 1]) / m) / m;
    }
    progress->evaluations++;
    return GM_OK;
}

GM_CLONES static enum gm_status ftcs_family(const struct gm_ends_step *step, struct gm_progress *progress)
{
    const double *restrict u = step->u;
    double *restrict v = step->out;
    const double k = step->k, sigma = step->sigma, h = step->h, viscosity = step->framed->viscosity;
    const double a = burgers_of(step)->a, d = burgers_of(step)->d;
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double bend = u[j + 1] - 2 * u[j] + u[j - 1];
        const double a4 = (a * u[j + 1] - (1 + 2 * a) * u[j] + (1 + a) * u[j - 1]) / h, m = 1 - k * a4;
        const double rate = viscosity * bend / (h * h) - d * bend * (a + 0.5) * bend / h;
        v[j] = (u[j] - sigma * a4 + k / m * rate) / m;
    }
    progress->evaluations++;
    return GM_OK;
}

GM_CLONES static enum gm_status lax_wendroff_invariant(const struct gm_ends_step *step,
                                                       struct gm_progress *progress)
{
    const double *restrict u = step->u;
    double *restrict v = step->out;
    const double k = step->k, sigma = step->sigma, a5 = -sigma / k, viscosity = step->framed->viscosity;
    const double over_2h = 1 / (2 * step->h), over_square = 1 / (step->h * step->h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double slope = over_2h * (u[j + 1] - u[j - 1]), over_m = 1 / (1 + k * slope);
        const double a = (u[j + 1] + 2 * u[j] + u[j - 1]) / 4 + a5;
        const double second = over_square * (u[j + 1] - 2 * u[j] + u[j - 1]);
        v[j] = (u[j] + sigma * slope + k * over_m * (viscosity + k / 2 * over_m * (a * a)) * second) * over_m;
    }
    progress->evaluations++;
    return GM_OK;
}

/* One row of Newton's system at node j for the guess v. */
struct row {
    double below, diagonal, above, residual;
};

/* Crank-Nicolson; the constant `old` is its part at the old level. */
static struct row row_standard(const struct gm_ends_step *step, const double *v, size_t j, double old)
{
    const double over_2h = 1 / (2 * step->h), over_square = 1 / (step->h * step->h);
    const double nu = step->framed->viscosity / 2;
    const double second = over_square * (v[j + 1] - 2 * v[j] + v[j - 1]);
    struct row row = {-nu * over_square, 1 / step->k + 2 * nu * over_square, -nu * over_square, 0};
    if (burgers_of(step)->printed) {
        const double slope = over_2h * (v[j + 1] - v[j - 1]);
        row.residual = v[j] / step->k + v[j] * slope / 2 - nu * second + old;
        row.below -= v[j] * over_2h / 2;
        row.diagonal += slope / 2;
        row.above += v[j] * over_2h / 2;
    } else {
        const double flux = over_2h * (v[j + 1] * v[j + 1] - v[j - 1] * v[j - 1]) / 2;
        row.residual = v[j] / step->k + flux / 2 - nu * second + old;
        row.below -= over_2h * v[j - 1] / 2;
        row.above += over_2h * v[j + 1] / 2;
    }
    return row;
}

static double old_standard(const struct gm_ends_step *step, size_t j)
{
    const double *u = step->u;
    const double over_2h = 1 / (2 * step->h), over_square = 1 / (step->h * step->h);
    const double convection = burgers_of(step)->printed
                                  ? u[j] * over_2h * (u[j + 1] - u[j - 1])
                                  : over_2h * (u[j + 1] * u[j + 1] - u[j - 1] * u[j - 1]) / 2;
    return -u[j] / step->k + convection / 2 -
           step->framed->viscosity / 2 * over_square * (u[j + 1] - 2 * u[j] + u[j - 1]);
}

static struct row row_invariant(const struct gm_ends_step *step, const double *v, size_t j, double old)
{
    (void)old;
    const double *u = step->u;
    const double over_2h = 1 / (2 * step->h), over_square = 1 / (step->h * step->h);
    const double nu = step->framed->viscosity / 2;
    const double a4 = -over_2h * (u[j + 1] - u[j - 1]), m = 1 - a4 * step->k;
    const double shift = step->sigma * a4, a5 = -step->sigma / step->k;
    const double value = m * v[j] + shift + a5, slope = m * (m * over_2h * (v[j + 1] - v[j - 1]) + a4);
    const double cube = m * m * m * over_square;
    return (struct row){
        .residual =
            m * (m * v[j] + shift - u[j]) / step->k + value * slope / 2 -
            nu * (over_square * (u[j + 1] - 2 * u[j] + u[j - 1]) + cube * (v[j + 1] - 2 * v[j] + v[j - 1])),
        .below = -value * m * m * over_2h / 2 - nu * cube,
        .diagonal = m * m / step->k + m * slope / 2 + 2 * nu * cube,
        .above = value * m * m * over_2h / 2 - nu * cube,
    };
}

static double nothing(const struct gm_ends_step *step, size_t j)
{
    return (void)step, (void)j, 0;
}

/* Newton's method; the tridiagonal systems by elimination. */
static enum gm_status solve(const struct gm_ends_step *step, struct gm_progress *progress,
                            double (*old)(const struct gm_ends_step *, size_t),
                            struct row (*row_at)(const struct gm_ends_step *, const double *, size_t, double))
{
    enum { MOST = 60 };
    const size_t points = step->points;
    double *v = step->out, *constant = step->constant, *above = step->above, *right = step->right;
    double last = INFINITY;
    for (size_t j = 1; j + 1 < points; j++) {
        constant[j] = old(step, j);
        v[j] = step->u[j];
    }
    for (int i = 0; i < MOST; i++) {
        above[0] = right[0] = 0;
        for (size_t j = 1; j + 1 < points; j++) {
            const struct row row = row_at(step, v, j, constant[j]);
            const double pivot = 1 / (row.diagonal - row.below * above[j - 1]);
            above[j] = row.above * pivot;
            right[j] = (row.residual - row.below * right[j - 1]) * pivot;
        }
        double change = 0, largest = 1, size = 0;
        for (size_t j = points - 2; j > 0; j--) {
            change = right[j] - (j + 2 < points ? above[j] * change : 0);
            v[j] -= change;
            size = fabs(change) > size || isnan(change) ? fabs(change) : size;
            largest = fmax(largest, fabs(v[j]));
        }
        progress->iterations++;
        progress->solves++;
        progress->evaluations++;
        if (!isfinite(size)) {
            return GM_NO_CONVERGENCE;
        }
        if (gm_is_settled_within(size, 1e-16 * largest, 1e-12 * largest, &last)) {
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

static enum gm_status crank_nicolson(const struct gm_ends_step *step, struct gm_progress *progress)
{
    return solve(step, progress, old_standard, row_standard);
}

static enum gm_status crank_nicolson_invariant(const struct gm_ends_step *step, struct gm_progress *progress)
{
    return solve(step, progress, nothing, row_invariant);
}

/* (t, x, u) -> (t/m, (x + b t)/m, m u + p x + b),   m = 1 - p t (eq. 98: a4 = p, a5 = b)
   (t, x, u) -> (s^2 t, s x, u/s) */
static struct gm_event carry(const struct gm_framed *framed, const struct gm_point_symmetry *symmetry,
                             struct gm_event event)
{
    (void)framed;
    const double s = symmetry->scale, m = 1 - symmetry->projection * event.t;
    return (struct gm_event){
        .t = s * s * event.t / m,
        .x = s * (event.x + symmetry->boost * event.t) / m,
        .u = (m * event.u + symmetry->projection * event.x + symmetry->boost) / s,
    };
}

/* Schemes without frames have one too. The node becomes 0 and, with a = -1/2, both neighbours the same. */
static bool find(const struct gm_problem *problem, const struct gm_scheme *scheme, double k, const double *u,
                 size_t j, struct gm_point_symmetry *frame)
{
    const struct gm_burgers *burgers = gm_burgers_of(problem);
    const bool family = gm_ends_are_special(scheme);
    const double a = family ? burgers->a : -0.5, d = family ? burgers->d : 0;
    *frame = (struct gm_point_symmetry){
        .boost = d * (u[j + 1] - 2 * u[j] + u[j - 1]) - u[j],
        .projection = (a * u[j + 1] - (1 + 2 * a) * u[j] + (1 + a) * u[j - 1]) / problem->line.dx,
        .scale = 1,
    };
    return frame->projection * k < 1;
}

/* On three nodes about x = 0.3 with the values 0.4, 0.3, 0.15, which do not determine an implicit step. */
static double defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                     const struct gm_point_symmetry *symmetry, const double *unused)
{
    (void)unused;
    static const double u[3] = {0.4, 0.3, 0.15};
    const struct gm_ends_method *method = scheme->coefficients;
    const struct gm_ends_step step = {
        .framed = gm_framed_of(problem), .points = 3, .h = problem->line.dx, .k = k, .u = u};
    double arrival;
    return method->implicit ? NAN
                            : fabs(gm_ends_carried(method, carry, &step, symmetry, 0.3, &arrival) - arrival);
}

static double seen(const struct gm_framed *framed, bool fixed, double x, double t, double u)
{
    return (void)fixed, (void)x, (void)t, u - framed->lambda;
}

const struct gm_moving_frames gm_frames_of_burgers = {carry, find, defect, seen, gm_ends_are_special};

#define OF_BURGERS .family = &gm_family_burgers, .needs = GM_NEEDS_BURGERS

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_ftcs, OF_BURGERS, .coefficients = &(const struct gm_ends_method){.make = ftcs}},
    {GM_TEXTS_lax_wendroff, OF_BURGERS, .coefficients = &(const struct gm_ends_method){.make = lax_wendroff}},
    {GM_TEXTS_crank_nicolson, OF_BURGERS,
     .coefficients = &(const struct gm_ends_method){.make = crank_nicolson, .implicit = true}},
    {GM_TEXTS_ftcs_invariant, OF_BURGERS,
     .coefficients = &(const struct gm_ends_method){.make = ftcs_invariant}},
    {GM_TEXTS_lax_wendroff_invariant, OF_BURGERS,
     .coefficients = &(const struct gm_ends_method){.make = lax_wendroff_invariant}},
    {GM_TEXTS_crank_nicolson_invariant, OF_BURGERS,
     .coefficients = &(const struct gm_ends_method){.make = crank_nicolson_invariant, .implicit = true}},
    {GM_TEXTS_ftcs_family, OF_BURGERS,
     .coefficients = &(const struct gm_ends_method){.make = ftcs_family, .special = true}},
};

const struct gm_family gm_family_burgers = {
    .title = "Burgers, standard and invariantised",
    GM_FIELD_FAMILY,
    GM_ENDS_LOOP,
};
