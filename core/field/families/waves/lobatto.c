/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Multisymplectic partitioned Runge-Kutta methods for u_tt - u_xx + V'(u) = 0. In space, across an element of
   two cells, D = 2 dx, the three stages of Lobatto IIIA for u and of Lobatto IIIB for w = u_x; the end of an
   element is the first stage of the next, which leaves
       f = L u - V'(u)
       L u = (u_{i-1} - 2 u_i + u_{i+1}) 4/D^2                                          in the middle
       L u = (-u_{i-2} + 8 u_{i-1} - 14 u_i + 8 u_{i+1} - u_{i+2}) / D^2                at the ends
       w   = (u_{i+2} - u_i)/D - D [(L u)_i/6 + (L u)_{i+1}/3]                          at an element's left
       end
   of fourth order in dx. In time u'' = f with
       two stages of Lobatto IIIA-IIIB, which is Verlet's scheme
       three stages     u_h = u + dt v/2 + dt^2 (f/12 + f_h/24)     solved by iteration, for dt < 2 dx
                        u_1 = u + dt v + dt^2 (f/6 + f_h/3),   v_1 = v + dt (f + 4 f_h + f_1)/6
       a symplectic Nystrom method: Verlet five times, c, c, 1 - 4 c, c, c, with c = 1/(4 - 4^(1/3)).
   With their weights b in space and time the sums of du ^ dv and of du ^ dw obey the multisymplectic law:
   B.N. Ryland, R.I. McLachlan & J. Frank, Int. J. Comput. Math. 84 (2007) 847; R.I. McLachlan, B.N. Ryland &
   Y. Sun, SIAM J. Sci. Comput. 36 (2014) A2199; M. Suzuki, Phys. Lett. A 146 (1990) 319. Stable where, w the
   fastest frequency of f, w^2 = 6/dx^2 + V'', w dt is below 2 (Verlet), 2 sqrt 2 (three stages).

   The memory is u, v and a number, 1 when they are filled: v so that a step over the gap leads from one level
   of the state to the other. */
#include "core/field/families/waves/lobatto.h"

#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/linear/settled.h"

enum { STAGES = 3 };

struct work {
    size_t points;
    double *u, *v, *force;           /* [points] each; force belongs to u if it is `fresh` */
    double *before;                  /* u before the last step */
    double *stage[GM_LOBATTO_KICKS]; /* u at the kicks of the last step */
    double *last;                    /* scratch of find_force */
    bool fresh;
};

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    const size_t points = problem->line.points;
    struct work *work = calloc(1, sizeof *work + (5 + GM_LOBATTO_KICKS) * points * sizeof(double));
    if (!work) {
        return NULL;
    }
    double *memory = (double *)(work + 1);
    double **const arrays[] = {&work->u, &work->v, &work->force, &work->before, &work->last};
    work->points = points;
    for (size_t i = 0; i < GM_COUNT(arrays); i++) {
        *arrays[i] = memory + i * points;
    }
    for (size_t i = 0; i < GM_LOBATTO_KICKS; i++) {
        work->stage[i] = memory + (GM_COUNT(arrays) + i) * points;
    }
    return work;
}

/* L of a level that gains `jump` around the ring. */
static void bend(const struct gm_grid1 *grid, double jump, const double *u, double *second)
{
    const size_t points = grid->points;
    const double over = 1 / (grid->dx * grid->dx);
    for (size_t i = 0; i < points; i += 2) {
        const double left = i >= 2 ? u[i - 2] : u[points - 2] - jump;
        const double near = i >= 2 ? u[i - 1] : u[points - 1] - jump;
        const double end = i + 2 < points ? u[i + 2] : u[0] + jump;
        second[i] = over / 4 * (8 * (near + u[i + 1]) - 14 * u[i] - left - end);
        second[i + 1] = over * (u[i] - 2 * u[i + 1] + end);
    }
}

/* f; with the `curvature` V'' that of a tangent. */
static void find_force(const struct gm_problem *problem, const double *curvature, const double *u,
                       double *slope, double *force)
{
    const size_t points = problem->line.points;
    bend(&problem->line, curvature ? 0 : problem->line.jump, u, force);
    if (curvature) {
        for (size_t i = 0; i < points; i++) {
            force[i] -= curvature[i] * u[i];
        }
        return;
    }
    gm_field_of(problem)->wave->slopes(problem, u, slope, points);
    for (size_t i = 0; i < points; i++) {
        force[i] -= slope[i];
    }
}

static void kick(struct work *work, double step)
{
    for (size_t i = 0; i < work->points; i++) {
        work->v[i] += step * work->force[i];
    }
}

/* The stage in the middle, in stage[1], and its f in `force`; the f of the start is in stage[2]. */
static enum gm_status middle_stage(struct work *work, const struct gm_problem *problem, double dt,
                                   const double *curvature, struct gm_progress *progress)
{
    enum { MOST = 200 };
    const size_t points = work->points;
    const double *first = work->stage[2];
    double *half = work->stage[1], last = INFINITY;
    for (size_t i = 0; i < points; i++) {
        half[i] = work->u[i] + dt / 2 * work->v[i] + dt * dt / 8 * first[i];
    }
    for (int round = 0; round < MOST; round++) {
        find_force(problem, curvature, half, work->last, work->force);
        progress->evaluations++;
        progress->iterations++;
        double change = 0, largest = 1;
        for (size_t i = 0; i < points; i++) {
            const double next =
                work->u[i] + dt / 2 * work->v[i] + dt * dt * (first[i] / 12 + work->force[i] / 24);
            change = gm_larger(change, fabs(next - half[i]));
            largest = fmax(largest, fabs(next));
            half[i] = next;
        }
        if (!isfinite(change)) {
            return GM_BLOW_UP;
        }
        if (gm_is_settled_within(change, 1e-16 * largest, 1e-13 * largest, &last)) {
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

/* One step of u and v; with `curvature`, kicks * points values of V'', that of a tangent. */
static enum gm_status make_step(struct work *work, const struct gm_lobatto_row *row,
                                const struct gm_problem *problem, double dt, const double *curvature,
                                struct gm_progress *progress)
{
    const size_t points = work->points, size = points * sizeof(double);
    memcpy(work->before, work->u, size);
    if (!work->fresh) {
        find_force(problem, curvature, work->u, work->last, work->force);
        progress->evaluations++;
    }
    work->fresh = false;
    memcpy(work->stage[0], work->u, size);
    if (row->collocated) {
        double *first = work->stage[2];
        memcpy(first, work->force, size);
        const enum gm_status status =
            middle_stage(work, problem, dt, curvature ? curvature + points : NULL, progress);
        if (status != GM_OK) {
            return status;
        }
        for (size_t i = 0; i < points; i++) {
            const double drift = dt * work->v[i] + dt * dt * (first[i] / 6 + work->force[i] / 3);
            work->v[i] += dt * (row->kick[0] * first[i] + row->kick[1] * work->force[i]);
            work->u[i] += drift;
        }
        find_force(problem, curvature ? curvature + 2 * points : NULL, work->u, work->last, work->force);
        progress->evaluations++;
        kick(work, row->kick[2] * dt);
        memcpy(work->stage[2], work->u, size);
    } else {
        kick(work, row->kick[0] * dt);
        for (size_t k = 1; k < row->kicks; k++) {
            for (size_t i = 0; i < points; i++) {
                work->u[i] += row->drift[k - 1] * dt * work->v[i];
            }
            memcpy(work->stage[k], work->u, size);
            find_force(problem, curvature ? curvature + k * points : NULL, work->u, work->last, work->force);
            progress->evaluations++;
            kick(work, row->kick[k] * dt);
        }
    }
    work->fresh = !curvature;
    return GM_OK;
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return 2 * problem->line.points + 1;
}

static enum gm_status start(const struct gm_task *task)
{
    enum { TIMES = 12 };
    const double far =
        1e6; /* near the limit of stability noise begins farther off than it is large, and stays */
    const struct gm_problem *problem = task->problem;
    struct work *work = task->workspace;
    const size_t points = work->points, size = points * sizeof(double);
    const double gap = task->y[2 * points], *other = task->y + points;
    double *u = task->memory_out, *v = u + points, *filled = v + points;
    struct gm_progress uncounted = {.status = GM_OK};
    if (*filled == 1) {
        return GM_OK;
    }
    memcpy(u, task->y, size);
    for (size_t i = 0; i < points; i++) {
        v[i] = (other[i] - u[i]) / gap;
    }
    for (int k = 0; k < TIMES; k++) {
        memcpy(work->u, u, size);
        memcpy(work->v, v, size);
        work->fresh = false;
        const enum gm_status status =
            make_step(work, task->scheme->coefficients, problem, gap, NULL, &uncounted);
        double miss = 0, most = 1;
        for (size_t i = 0; i < points; i++) {
            miss = gm_larger(miss, fabs(other[i] - work->u[i]));
            most = fmax(most, fabs(other[i]));
            v[i] += (other[i] - work->u[i]) / gap;
        }
        if (status != GM_OK || !(miss <= far * most)) {
            return status != GM_OK ? status : GM_NO_CONVERGENCE;
        }
    }
    *filled = 1;
    return GM_OK;
}

static struct gm_progress advance(const struct gm_task *task)
{
    struct work *work = task->workspace;
    const size_t points = work->points, size = points * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    memcpy(work->u, task->memory, size);
    memcpy(work->v, task->memory + points, size);
    work->fresh = false;
    for (int64_t k = 0; k < task->steps; k++) {
        progress.status =
            make_step(work, task->scheme->coefficients, task->problem, task->dt, NULL, &progress);
        if (!gm_field_stepped(task, &progress, work->u, points)) {
            return progress;
        }
    }
    memcpy(task->memory_out, work->u, size);
    memcpy(task->memory_out + points, work->v, size);
    task->memory_out[2 * points] = 1;
    gm_wave_write(task, work->u, work->before);
    return progress;
}

/* u_t^2/2 + V(u) with Lobatto's rule on the elements, and u_x^2/2 of the parabolas through their stages,
   whose derivative in u is -L u. */
static double wave_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory)
{
    (void)scheme;
    (void)y;
    const struct gm_grid1 *grid = &problem->line;
    const size_t points = grid->points;
    const double *u = memory, *v = u + points;
    double sum = 0;
    for (size_t i = 0; i < points; i += 2) {
        const double end = i + 2 < points ? u[i + 2] : u[0] + grid->jump;
        const double rise = (u[i + 1] - u[i]) / grid->dx, further = (end - u[i + 1]) / grid->dx;
        sum += (7 * (rise * rise + further * further) - 2 * rise * further) / 12;
        for (size_t m = 0; m < 2; m++) {
            sum += (m ? 4. / 3 : 2. / 3) *
                   (v[i + m] * v[i + m] / 2 + gm_field_of(problem)->wave->potential(problem, u[i + m]));
        }
    }
    return grid->dx * sum;
}

/* The discrete multisymplectic law: two tangents of a step, with their faces in time and space. */

/* Advances tangent 0 or 1, u and then v, with V'' at the kicks, and finds its faces. */
static void advance_tangent(const struct gm_law *law, const double *curvature, size_t which,
                            struct gm_faces *faces)
{
    enum { U, V, W, DIMENSION };
    const struct gm_lobatto_row *row = law->scheme->coefficients;
    struct work *work = law->work;
    const size_t points = work->points, size = points * sizeof(double), kicks = row->kicks;
    const double waves = 2 + (double)which, phase = 0.3 + 0.4 * (double)which;
    const double length = 2 * law->problem->line.dx;
    struct gm_progress uncounted = {.status = GM_OK};
    const size_t n = law->problem->n, all = n + memory(law->problem, law->scheme);
    double *direction = gm_arena_take(law->arena, 2 * all, sizeof *direction), *start = direction + n,
           *end = start + all;
    gm_tangent_start(start, points, waves, phase);
    gm_tangent_start(start + points, points, waves, phase + 1);
    if (law->by_differences) {
        gm_law_differentiate(law, law->y, law->memory, direction, direction + all);
    }
    memcpy(work->u, start, size);
    memcpy(work->v, start + points, size);
    work->fresh = false;
    if (make_step(work, row, law->problem, law->dt, curvature, &uncounted) != GM_OK) {
        gm_arena_leave(law->arena);
    }
    if (!law->by_differences) {
        memcpy(end, work->u, size);
        memcpy(end + points, work->v, size);
    }
    for (size_t i = 0; i < points; i += 2) {
        for (size_t m = 0; m < STAGES; m++) {
            const size_t at = (i + m) % points, face = (i / 2 * STAGES + m) * DIMENSION;
            faces->lower[face + U] = start[at];
            faces->lower[face + V] = start[points + at];
            faces->upper[face + U] = end[at];
            faces->upper[face + V] = end[points + at];
        }
    }
    for (size_t k = 0; k < kicks; k++) {
        const double *u = work->stage[k];
        double *second = work->last;
        bend(&law->problem->line, 0, u, second);
        for (size_t i = 0; i <= points; i += 2) {
            const size_t at = i % points, end_at = (i + 2) % points;
            double *side = faces->sides + (i / 2 * kicks + k) * DIMENSION;
            side[U] = u[at];
            side[W] = (u[end_at] - u[at]) / length - length * (second[at] / 6 + second[at + 1] / 3);
        }
    }
}

static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    struct work *work = law->work;
    const size_t points = work->points,
                 kicks = ((const struct gm_lobatto_row *)law->scheme->coefficients)->kicks;
    const size_t more = law->problem->n + memory(law->problem, law->scheme);
    double *curvature = gm_arena_take(law->arena, kicks * points + more, sizeof *curvature),
           *out = curvature + kicks * points;
    if (!gm_law_step(law, 1, law->y, law->memory, out, out + law->problem->n)) {
        gm_arena_leave(law->arena);
    }
    for (size_t at = 0; at < kicks * points; at++) {
        curvature[at] =
            gm_field_of(law->problem)->wave->curvature(law->problem, work->stage[at / points][at % points]);
    }
    advance_tangent(law, curvature, 0, &faces[0]);
    advance_tangent(law, curvature, 1, &faces[1]);
}

static double form(const struct gm_law *law)
{
    static const double space[STAGES] = {1. / 6, 4. / 6, 1. / 6};
    const struct gm_lobatto_row *row = law->scheme->coefficients;
    const struct gm_grid1 *grid = &law->problem->line;
    const struct gm_lattice elements = {grid->points / 2, STAGES,       row->kicks, space,
                                        row->kick,        2 * grid->dx, law->dt};
    return gm_lattice_law(law, &elements, advance_tangents);
}

#define OUTER 0.41449077179437573714 /* 1/(4 - 4^(1/3)) */
#define INNER (1 - 4 * OUTER)

static const struct gm_lobatto_row rows[] = {
    {.kicks = 2, .kick = {0.5, 0.5}, .drift = {1}},
    {.kicks = 3, .kick = {1. / 6, 4. / 6, 1. / 6}, .collocated = true},
    {.kicks = 6,
     .kick = {OUTER / 2, OUTER, (OUTER + INNER) / 2, (OUTER + INNER) / 2, OUTER, OUTER / 2},
     .drift = {OUTER, OUTER, INNER, OUTER, OUTER}},
};

static const struct gm_step_limit verlet_limit = {"4/dt^2 >= 6/dx^2 + V''", 4, 6, false};
static const struct gm_step_limit three_limit = {"8/dt^2 >= 6/dx^2 + V''", 8, 6, false};
/* Suzuki's composition: where the trace of its step of u'' = -w^2 u leaves [-2, 2] first. */
static const struct gm_step_limit suzuki_limit = {"7.4037/dt^2 >= 6/dx^2 + V''", 7.403702439, 6, false};

#define OF_LOBATTO .family = &gm_family_lobatto, .needs = GM_NEEDS_WAVE | GM_NEEDS_PAIRS

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_lobatto_box2, OF_LOBATTO, .limit = &verlet_limit, .coefficients = &rows[0]},
    {GM_TEXTS_lobatto_box4, OF_LOBATTO, .limit = &three_limit, .coefficients = &rows[1]},
    {GM_TEXTS_lobatto_nystrom4, OF_LOBATTO, .limit = &suzuki_limit, .coefficients = &rows[2]},
};

const struct gm_family gm_family_lobatto = {
    .title = "multisymplectic Lobatto collocation",
    GM_FIELD_FAMILY,
    .loop = advance,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = free,
    .form = form,
    .wave_energy = wave_energy,
};
