/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boxes of every order for any M s_t + K s_x = grad S(s) whose state is s at the nodes, and for waves,
   whose state is u at two levels: Gauss-Legendre collocation in space and time (collocation.c),
       r = 1   M D_t A_x s + K A_t D_x s = grad S(A_t A_x s),
               A f = (f_i + f_{i+1})/2,   D f = (f_{i+1} - f_i)/dx
   S. Reich, J. Comput. Phys. 157 (2000) 473; T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184. The
   memory is s at the stages of the cells, and the stages of three steps, of which the next step's are
   guessed. What the form calls M and K are the K and L of a system's file, and of the formulas that users
   read.

   Values at the nodes are found of those at the stages, and the other way round at the start: of one stage
   they are means, so that on an odd number of cells a step is the box's of nodes to the last digits. On an
   even number no mean shows the part that alternates from node to node; it is left out. */
#include "core/field/families/boxes/any_form.h"

#include "core/field/families/family.h"
#include "core/field/multisymplectic.h"

static const struct gm_collocation_tableau midpoint = {1, {{0.5}}, {1}, {0.5}};

#define ROOT3 1.7320508075688772935
const struct gm_collocation_tableau gm_collocation_gauss4 = {
    2,
    {{0.25, 0.25 - ROOT3 / 6}, {0.25 + ROOT3 / 6, 0.25}},
    {0.5, 0.5},
    {0.5 - ROOT3 / 6, 0.5 + ROOT3 / 6},
};

#define ROOT15 3.8729833462074168852
static const struct gm_collocation_tableau gauss6 = {
    3,
    {{5.0 / 36, 2.0 / 9 - ROOT15 / 15, 5.0 / 36 - ROOT15 / 30},
     {5.0 / 36 + ROOT15 / 24, 2.0 / 9, 5.0 / 36 - ROOT15 / 24},
     {5.0 / 36 + ROOT15 / 30, 2.0 / 9 + ROOT15 / 15, 5.0 / 36}},
    {5.0 / 18, 4.0 / 9, 5.0 / 18},
    {0.5 - ROOT15 / 10, 0.5, 0.5 + ROOT15 / 10},
};

/* The stored memory: 1 + the number of steps with stored stages (0: nothing yet), a flag for Newton's
   method, s at the stages of the level, and the stages and sides of the last steps. */
enum { KNOWN, NEWTON, ARRAYS };

static size_t of_level(const struct gm_collocation *work)
{
    return work->d * work->r * work->points;
}

size_t gm_any_form_memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t r = ((const struct gm_collocation_tableau *)scheme->coefficients)->r,
                 d = gm_field_of(problem)->form->dimension;
    /* sides of full rank, at most */
    return ARRAYS + (d * r + GM_COLLOCATION_PAST * (d * r * r + d * r)) * problem->line.points;
}

/* Copies between the memory and the workspace. */
static void exchange_memory(struct gm_collocation *work, double *to, const double *from)
{
    struct {
        double *array;
        size_t size;
    } arrays[1 + 2 * GM_COLLOCATION_PAST] = {{work->low, of_level(work)}};
    for (size_t k = 0; k < GM_COLLOCATION_PAST; k++) {
        arrays[1 + 2 * k].array = work->past_z[k];
        arrays[1 + 2 * k].size = work->stages * work->points;
        arrays[2 + 2 * k].array = work->past_y[k];
        arrays[2 + 2 * k].size = work->sides * work->points;
    }
    for (size_t i = 0, at = ARRAYS; i < GM_COUNT(arrays); at += arrays[i++].size) {
        if (to) {
            memcpy(to + at, arrays[i].array, arrays[i].size * sizeof *to);
        } else {
            memcpy(arrays[i].array, from + at, arrays[i].size * sizeof *from);
        }
    }
}

static void remember(struct gm_collocation *work, size_t known, double *memory)
{
    memory[KNOWN] = (double)known;
    memory[NEWTON] = work->needs_newton;
    exchange_memory(work, memory, NULL);
}

static size_t recall(struct gm_collocation *work, const double *memory)
{
    work->needs_newton = memory[NEWTON] != 0;
    exchange_memory(work, NULL, memory);
    return (size_t)memory[KNOWN];
}

/* Potentials from their slopes, cell after cell by collocation, as the stages of every step have them:
   from values at the nodes they would differ by an error of the grid, which would change its sign at every
   step. */
static void integrate_potentials(struct gm_collocation *work)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = work->r, d = work->d;
    const double dx = work->problem->line.dx;
    gm_collocation_gradients(work, work->low, work->gradient, r * points);
    for (size_t p = 0; p < form->potential_count; p++) {
        const size_t component = form->potentials[p].component, row = form->potentials[p].row;
        const double *slope = work->gradient + row * r * points, over = 1 / form->k[row * d + component];
        double *to = work->low + component * r * points, left = 0;
        for (size_t k = 0; k < work->rank; k++) {
            left += work->basis[component][k] * work->y[k * points];
        }
        for (size_t i = 0; i < points; i++) {
            double rise = 0;
            for (size_t m = 0; m < r; m++) {
                to[m * points + i] = left;
                for (size_t l = 0; l < r; l++) {
                    to[m * points + i] += dx * tableau->a[m][l] * over * slope[l * points + i];
                }
                rise += dx * tableau->b[m] * over * slope[m * points + i];
            }
            left += rise;
        }
    }
}

/* The polynomial through the past values, at the step to come. */
static void extrapolate(double *const *past, size_t steps, double *to, size_t count)
{
    static const double weights[GM_COLLOCATION_PAST][GM_COLLOCATION_PAST] = {{1}, {2, -1}, {3, -3, 1}};
    const double *w = weights[steps - 1];
    for (size_t i = 0; i < count; i++) {
        to[i] = w[0] * past[0][i] + w[1] * past[1][i] + w[2] * past[2][i];
    }
}

/* Nothing determines the constant of a potential: on the first side it stays what it was. */
static void anchor(struct gm_collocation *work)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const size_t points = work->points, r = work->r;
    for (size_t at = 0; at < form->potential_count * work->sides; at++) {
        const size_t c = form->potentials[at / work->sides].component, side = at % work->sides;
        const double part = work->basis[c][side % work->rank];
        double *y = work->y + side * points, *z = work->z + (c * r + side / work->rank) * r * points;
        const double by = part != 0 ? work->past_y[0][side * points] - y[0] : 0;
        for (size_t i = 0; i < points && by != 0; i++) {
            y[i] += by;
        }
        for (size_t i = 0; i < r * points && by != 0; i++) {
            z[i] += by * part;
        }
    }
}

/* z and y of the step to come, from those of `known` - 1 before. */
static void guess(struct gm_collocation *work, size_t known)
{
    const size_t points = work->points, r = work->r, steps = known > 1 ? known - 1 : 1;
    extrapolate(work->past_y, steps, work->y, work->sides * points);
    extrapolate(work->past_z, steps, work->z, work->stages * points);
    for (size_t at = 0; at < work->d * r * r && known == 1; at++) {
        memcpy(work->z + at * points, work->low + (at / (r * r) * r + at % r) * points,
               points * sizeof(double));
    }
    anchor(work);
}

/* If a potential ties components without a rate to rates of others, waves of the branches that no smooth
   field has are too fast for a step: two stages leave them unchanged, three change their sign, and such a
   component is 1/dt of them, which two stages add up step after step. This removes them from the start:
   the stages of a step forward and of one back have almost nothing of them, and the polynomial through
   both, even in time, is s at the start up to dt^(2 r). */
static void settle(struct gm_collocation *work, double dt)
{
    const size_t points = work->points, r = work->r;
    const double *c = work->tableau->c;
    double *sum = work->past_z[1]; /* there are no steps before */
    memset(sum, 0, of_level(work) * sizeof *sum);
    for (int way = -1; way <= 1; way += 2) {
        struct gm_progress uncounted = {.status = GM_OK};
        guess(work, 1);
        if (gm_collocation_step(work, way * dt, &uncounted) != GM_OK) {
            return;
        }
        for (size_t j = 0; j < r; j++) {
            double weight = 0.5;
            for (size_t k = 0; k < r; k++) {
                weight *= k == j ? 1 : c[k] * c[k] / (c[k] * c[k] - c[j] * c[j]);
            }
            for (size_t at = 0; at < work->d * r; at++) {
                const double *stage = work->z + ((at / r * r + j) * r + at % r) * points;
                for (size_t i = 0; i < points; i++) {
                    sum[at * points + i] += weight * stage[i];
                }
            }
        }
    }
    memcpy(work->low, sum, of_level(work) * sizeof *sum);
}

/* The mean over the ring of both stages of v: where they differ, no slope of w moves them. */
static void share_mean(double *stages, size_t points)
{
    double means[2] = {0};
    for (size_t at = 0; at < 2 * points; at++) {
        means[at / points] += stages[at] / (double)points;
    }
    for (size_t at = 0; at < 2 * points; at++) {
        stages[at] += (means[0] + means[1]) / 2 - means[at / points];
    }
}

/* u and v of a wave at two stages, from the two levels of its state: by the first terms of Taylor's series,
       v = [u(t + g) - u(t)]/g - g [2 u''(t) + u''(t + g)]/6 + O(g^3),
   then corrected so that a step leads to the other level as well as to the order of the scheme. */
static void start_wave(struct gm_collocation *work, const double *levels)
{
    enum { TIMES = 2 };
    const struct gm_problem *problem = work->problem;
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    const size_t points = work->points, count = work->r * points;
    const double gap = levels[2 * points], *other_level = levels + points;
    /* there are no steps before */
    double *u = work->low, *v = u + count, *other = work->past_z[1], *second = other + count,
           *force = second + count;
    memset(v, 0, 2 * count * sizeof *v);
    for (size_t k = 0; k < 2; k++) {
        const double weight = k == 0 ? 2 : 1;
        gm_collocation_to_stages(work, k == 0 ? levels : other_level, false, other);
        gm_collocation_to_stages(work, k == 0 ? levels : other_level, true, second);
        wave->slopes(problem, other, force, count);
        for (size_t at = 0; at < count; at++) {
            v[at] += (k == 0 ? -1 : 1) * other[at] / gap - gap * weight * (second[at] - force[at]) / 6;
            u[at] = k == 0 ? other[at] : u[at];
        }
    }
    share_mean(v, points);
    for (int k = 0; k < TIMES; k++) {
        struct gm_progress uncounted = {.status = GM_OK};
        guess(work, 1);
        if (gm_collocation_step(work, gap, &uncounted) != GM_OK) {
            return;
        }
        for (size_t at = 0; at < count; at++) {
            v[at] += (other[at] - work->high[at]) / gap;
        }
    }
}

/* s at the stages, once; for another dt the steps before are forgotten. */
enum gm_status gm_any_form_start(const struct gm_task *task)
{
    struct gm_collocation *work = task->workspace;
    if (task->memory_out[KNOWN] > 0) {
        task->memory_out[KNOWN] = 1;
        task->memory_out[NEWTON] = 0;
        return GM_OK;
    }
    work->needs_newton = false;
    gm_collocation_guess_sides(work, task->y);
    memcpy(work->past_y[0], work->y, work->sides * work->points * sizeof(double));
    if (gm_field_of(work->problem)->wave) {
        start_wave(work, task->y);
        remember(work, 1, task->memory_out);
        return GM_OK;
    }
    gm_collocation_to_stages(work, task->y, false, work->low);
    integrate_potentials(work);
    if (work->r > 1 && gm_field_of(work->problem)->form->potential_count > 0) {
        settle(work, task->dt);
    }
    remember(work, 1, task->memory_out);
    return GM_OK;
}

const double *gm_any_form_stages(const double *memory)
{
    return memory + ARRAYS;
}

/* The solution becomes the first of the past ones. */
static void shift(double **now, double **past)
{
    double *oldest = past[GM_COLLOCATION_PAST - 1];
    for (size_t k = GM_COLLOCATION_PAST - 1; k > 0; k--) {
        past[k] = past[k - 1];
    }
    past[0] = *now;
    *now = oldest;
}

/* The state at the nodes; of a wave u at the level before as well, which `work->high` holds. */
static void find_state(struct gm_collocation *work, double dt, double *state)
{
    gm_collocation_to_nodes(work, work->low, state);
    if (gm_field_of(work->problem)->wave) {
        gm_collocation_to_nodes(work, work->high, state + work->points);
        state[2 * work->points] = -dt;
    }
}

struct gm_progress gm_any_form_advance(const struct gm_task *task)
{
    struct gm_collocation *work = task->workspace;
    struct gm_progress progress = {.status = GM_OK};
    size_t known = recall(work, task->memory);
    for (int64_t k = 0; k < task->steps; k++) {
        guess(work, known);
        progress.status = gm_collocation_step(work, task->dt, &progress);
        if (!gm_field_stepped(task, &progress, work->high, work->state * work->r * work->points)) {
            return progress;
        }
        double *low = work->low;
        work->low = work->high;
        work->high = low;
        shift(&work->z, work->past_z);
        shift(&work->y, work->past_y);
        known = known <= GM_COLLOCATION_PAST ? known + 1 : known;
    }
    remember(work, known, task->memory_out);
    find_state(work, task->dt, task->out);
    return progress;
}

double gm_any_form_integral(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const double *remembered,
                            double (*density)(const struct gm_problem *problem, const double *s,
                                              const double *slope))
{
    struct gm_collocation *work = remembered ? gm_collocation_open(problem, scheme) : NULL;
    if (!work) {
        return NAN;
    }
    const size_t count = work->r * work->points;
    const double *stages = gm_any_form_stages(remembered);
    double sum = 0, s[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
    gm_collocation_slopes(work, stages, work->high);
    for (size_t at = 0; at < count; at++) {
        for (size_t c = 0; c < work->d; c++) {
            s[c] = stages[c * count + at];
            slope[c] = work->high[c * count + at];
        }
        sum += work->tableau->b[at / work->points] * density(problem, s, slope);
    }
    gm_collocation_close(work);
    return problem->line.dx * sum;
}

static double product(const double *matrix, size_t d, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < d; i++) {
        for (size_t k = 0; k < d; k++) {
            sum += a[i] * matrix[i * d + k] * b[k];
        }
    }
    return sum;
}

static double energy_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    return form->function(problem->parameters, s) - product(form->k, form->dimension, s, slope) / 2;
}

static double momentum_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    return product(form->m, form->dimension, s, slope) / 2;
}

double gm_form_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *memory)
{
    return gm_any_form_integral(problem, scheme, memory, energy_density);
}

double gm_form_momentum(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        const double *memory)
{
    return gm_any_form_integral(problem, scheme, memory, momentum_density);
}

/* ---- the discrete multisymplectic law ---- */

static void differentiate(const struct gm_law *law, const double *tangent, double *next)
{
    const size_t n = law->problem->n, low = of_level(law->work) * sizeof *next;
    const size_t size = n + gm_any_form_memory(law->problem, law->scheme);
    double *direction = gm_arena_take(law->arena, 2 * size, sizeof *direction), *slope = direction + size;
    memcpy(direction + n + ARRAYS, tangent, low);
    gm_law_differentiate(law, law->y, law->memory, direction, slope);
    memcpy(next, slope + n + ARRAYS, low);
}

/* Advances tangents from s at the stages. */
static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    struct gm_collocation *work = law->work;
    const size_t low = of_level(work), points = work->points, r = work->r;
    double *tangents = gm_arena_take(law->arena, 4 * low, sizeof *tangents), *next = tangents + 2 * low;
    for (size_t at = 0; at < 2 * work->d * r; at++) {
        const size_t k = at / (work->d * r), row = at % (work->d * r);
        const double waves = 2 + (double)k;
        gm_tangent_start(tangents + at * points, points, waves,
                         0.3 + 0.4 * (double)k + (double)(row / r) +
                             2 * M_PI * waves * work->tableau->c[row % r] / (double)points);
    }
    for (size_t k = 0; k < 2 && law->by_differences; k++) {
        differentiate(law, tangents + k * low, next + k * low);
    }
    struct gm_progress uncounted = {.status = GM_OK};
    guess(work, recall(work, law->memory));
    if (gm_collocation_step(work, law->dt, &uncounted) != GM_OK || !gm_collocation_linearise(work, law->dt)) {
        gm_arena_leave(law->arena);
    }
    for (size_t k = 0; k < 2; k++) {
        memcpy(work->low, tangents + k * low, low * sizeof *tangents);
        gm_collocation_tangent(work, law->dt);
        if (law->by_differences) {
            memcpy(work->high, next + k * low, low * sizeof *next);
        }
        gm_collocation_faces(work, &faces[k]);
    }
}

double gm_any_form_law(const struct gm_law *law)
{
    const struct gm_collocation *work = law->work;
    const struct gm_collocation_tableau *tableau = work->tableau;
    const struct gm_lattice cells = {work->points,          work->r, work->r, tableau->b, tableau->b,
                                     law->problem->line.dx, law->dt};
    return gm_lattice_law(law, &cells, advance_tangents);
}

#define OF_ANY_FORM .family = &gm_family_any_form, .needs = GM_NEEDS_ALL

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_box_of_all_components, OF_ANY_FORM, .coefficients = &midpoint},
    {GM_TEXTS_gauss_box3_of_all_components, OF_ANY_FORM, .coefficients = &gm_collocation_gauss4},
    {GM_TEXTS_gauss_box4, OF_ANY_FORM, .coefficients = &gauss6},
};

const struct gm_family gm_family_any_form = {
    .title = "multisymplectic boxes of all components",
    GM_FIELD_FAMILY,
    .loop = gm_any_form_advance,
    .memory = gm_any_form_memory,
    .start = gm_any_form_start,
    .workspace_open = gm_collocation_open,
    .workspace_close = gm_collocation_close,
    .form = gm_any_form_law,
};
