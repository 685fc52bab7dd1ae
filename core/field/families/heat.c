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

   Razafindralandy et al. (2018), eqs. 73 to 75, 83 and 91; the frame is built as theirs for Burgers'
   equation, whose slope -u/2nu is that of ln u (E. Hopf, Comm. Pure Appl. Math. 3 (1950) 201). */
#include "core/field/families/frames.h"

#include "core/field/families/family.h"
#include "core/field/families/two_step.h"

/* One step of length k on nodes h apart, each displaced by sigma. u and v have `points` entries; the first
   and the last of v hold the boundary values of the new level already. */
struct step {
    size_t points;
    double viscosity, h, k, sigma;
    const double *u;
    double *v;
};

struct row {
    void (*make)(const struct step *step);
    bool projects; /* it commutes with projections too */
};

static void ordinary(const struct step *step)
{
    const double *u = step->u, r = step->viscosity * step->k / (step->h * step->h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        step->v[j] = u[j] + r * (u[j + 1] - 2 * u[j] + u[j - 1]);
    }
}

static void by_boosts(const struct step *step)
{
    const double nu = step->viscosity, h = step->h, k = step->k, *u = step->u, r = nu * k / (h * h);
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double a = nu / h * log(u[j + 1] / u[j - 1]);
        const double away = a / (4 * nu) * (2 * step->sigma + a * k);
        step->v[j] = exp(away) * (u[j] + 2 * r * (sqrt(u[j + 1]) * sqrt(u[j - 1]) - u[j]));
    }
}

static void by_projections(const struct step *step)
{
    const double nu = step->viscosity, h = step->h, k = step->k, *u = step->u;
    for (size_t j = 1; j + 1 < step->points; j++) {
        const double right = log(u[j + 1] / u[j]), left = log(u[j - 1] / u[j]);
        const double a = nu / h * (right - left), p = 2 * nu / (h * h) * (right + left), m = 1 - p * k;
        const double arrival = step->sigma + a * k;
        const double away = a * (2 * step->sigma + a * k) + p * arrival * arrival / m;
        step->v[j] = u[j] * exp(away / (4 * nu)) / sqrt(m);
    }
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
                             .u = event.u * exp(-power / (4 * framed->viscosity)) * sqrt(m)};
}

static bool projects(const struct gm_scheme *scheme)
{
    return ((const struct row *)scheme->coefficients)->projects;
}

/* The boost that makes both neighbours equal, of schemes without frames too, and of those that preserve projections the
   one after which all three are. */
static bool find(const struct gm_problem *problem, const struct gm_scheme *scheme, double k, const double *u,
                 size_t j, struct gm_point_symmetry *frame)
{
    const double right = log(u[j + 1] / u[j]), left = log(u[j - 1] / u[j]);
    const double nu = gm_framed_of(problem)->viscosity, h = problem->line.dx;
    *frame = (struct gm_point_symmetry){
        .boost = nu / h * (right - left),
        .projection = projects(scheme) ? 2 * nu / (h * h) * (right + left) : 0,
        .scale = 1,
    };
    return isfinite(frame->boost) && frame->projection * k < 1;
}

/* About the middle of the nodes, the largest over all, divided by the value there. The carried nodes move, which only
   invariant schemes take into account. */
static double defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                     const struct gm_point_symmetry *symmetry, const double *u)
{
    const struct row *row = scheme->coefficients;
    const struct gm_grid1 *grid = &problem->line;
    const struct gm_framed *framed = gm_framed_of(problem);
    const double nu = framed->viscosity;
    double largest = 0;
    for (size_t j = 1; j + 1 < grid->points; j++) {
        const double here = gm_grid1_node(grid, j) - gm_grid1_node(grid, (grid->points - 1) / 2);
        double v[3] = {0}, carried[3], w[3] = {0};
        struct step step = {.points = 3, .viscosity = nu, .h = grid->dx, .k = k, .u = u + j - 1, .v = v};
        row->make(&step);
        for (int i = 0; i < 3; i++) {
            const struct gm_event event = {.x = here + (i - 1) * grid->dx, .u = u[j - 1 + (size_t)i]};
            carried[i] = carry(framed, symmetry, event).u;
        }
        const struct gm_event arrival =
            carry(framed, symmetry, (struct gm_event){.t = k, .x = here, .u = v[1]});
        step.h *= symmetry->scale;
        step.k = arrival.t;
        step.sigma = arrival.x - symmetry->scale * here;
        step.u = carried;
        step.v = w;
        row->make(&step);
        largest = gm_larger(largest, fabs(w[1] / arrival.u - 1));
    }
    return largest;
}

const struct gm_moving_frames gm_frames_of_heat = {carry, find, defect, projects};

static struct gm_progress advance(const struct gm_task *task)
{
    struct gm_two_step_work *work = task->workspace;
    const struct row *row = task->scheme->coefficients;
    const struct gm_framed *framed = gm_framed_of(task->problem);
    const double speed = gm_frame_rests(framed, task->scheme) ? 0 : framed->lambda;
    struct gm_frame_ends ends = {.speed = speed};
    struct gm_progress progress = {.status = GM_OK};
    struct step step = {
        .points = work->points,
        .viscosity = framed->viscosity,
        .h = task->problem->line.dx,
        .k = task->dt,
        .sigma = speed * task->dt,
    };
    memcpy(work->level[0], task->y, work->points * sizeof(double));
    for (int64_t i = 0; i < task->steps; i++) {
        step.u = work->level[i % 2];
        step.v = work->level[(i + 1) % 2];
        gm_frame_ends_set(&ends, task, i, step.v);
        row->make(&step);
        progress.evaluations++;
        if (!gm_field_stepped(task, &progress, step.v, work->points)) {
            return progress;
        }
    }
    memcpy(task->out, work->level[task->steps % 2], work->points * sizeof(double));
    return progress;
}

#define OF_HEAT .family = &gm_family_heat, .needs = GM_NEEDS_HEAT

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_heat_ftcs, OF_HEAT, .coefficients = &(const struct row){.make = ordinary}},
    {GM_TEXTS_heat_boosts, OF_HEAT, .coefficients = &(const struct row){.make = by_boosts}},
    {GM_TEXTS_heat_projections, OF_HEAT,
     .coefficients = &(const struct row){.make = by_projections, .projects = true}},
};

const struct gm_family gm_family_heat = {
    .title = "Heat equation, standard and invariantised",
    GM_FIELD_FAMILY,
    .loop = advance,
    .workspace_open = gm_two_step_open,
    .workspace_close = gm_two_step_close,
};
