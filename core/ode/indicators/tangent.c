/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stages of a Runge-Kutta method, plain or partitioned, with their derivatives along v: with k_j =
   f(Y_j),
       Y_i = y0 + h sum_j a_ij k_j,   dY_i = v + h sum_j a_ij w_j,   w_j = f'(Y_j) dY_j
       y1  = y0 + h sum_j b_j  k_j,   dy1  = v + h sum_j b_j  w_j
   where momenta may have other a and b. Splittings and Nystrom methods are of this form
   (core/theory/coefficients.h). Stages that depend on one another form a block, which Newton's method solves:
   its last matrix gives the dY_i. If a scheme has no such form, or that solution is not the scheme's, central
   differences at two distances are extrapolated, which eliminates the error of second order. */
#include "core/ode/indicators/tangent.h"

#include <math.h>
#include <string.h>

#include "core/arena.h"
#include "core/functions/functions.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/theory/theory.h"

struct gm_tangent {
    struct gm_arena *arena; /* owns all memory but the runs */
    struct gm_run *run;
    const struct gm_problem *motion; /* of the step or part, with its switches frozen */
    struct gm_problem between;       /* the same without events */
    struct gm_run *probe;            /* a second run for differences; NULL: not needed yet */
    double h;                        /* the length of the step or part */
    size_t n, memory;
    double *units;         /* n, see gm_tangent_units */
    size_t stages;         /* number of stages; 0: differences only */
    double *a[GM_SIDES];   /* stages * stages by rows */
    double *b[GM_SIDES];   /* stages */
    int *side;             /* the side of each component */
    size_t *from, *to;     /* per stage: the range of components whose slopes are needed */
    bool running;          /* the stages before have their final weights, as in splittings */
    double *k, *w;         /* stages * n each */
    double *y, *dy;        /* n each: the sums over the stages that are done */
    double *base, *d_base; /* n per stage of a block: the sums over the stages before the block */
    double *at;            /* n per stage of a block: the states */
    double *jacobians;     /* n * n per stage */
    bool again;            /* k and the Jacobians are those of the previous vector, from the same state */
    double *scratch;       /* scratch of Newton's method */
    double *kicked, *kick; /* n; n + n * n: the last stage's state, k and Jacobian, if it was a kick */
    double *before, *plus, *minus, *slope, *far_slope; /* n + memory each */
    double *v;                                         /* the vectors, while a step is made */
    double *square;                                    /* n * n; NULL: volumes are not followed */
    double volume;                                     /* ln |det| of the exact motion so far */
    size_t count;
    double t;       /* where its next part begins; `before` is the state there */
    size_t events;  /* events of the step so far */
    bool grazes;    /* an event has no tangent (gm_events.carry) */
    bool broken;    /* a part has no derivative */
    bool together;  /* the stages have reproduced the scheme to the last bit so far */
    void *snapshot; /* the run's state before these steps, restored if not */
};

const char *gm_tangent_word(const struct gm_scheme *scheme)
{
    return scheme->family->not_resumable || scheme->family->by_tolerance ? "none"
           : gm_scheme_has_coefficients(scheme)                          ? "exact"
                                                                         : "differences";
}

/* ---- opening ---- */

/* Returns the end of the block that starts with this stage: its stages need no later one. */
static size_t end_of_block(const struct gm_tangent *tangent, size_t first)
{
    const size_t s = tangent->stages;
    size_t end = first + 1;
    for (size_t i = first; i < end; i++) {
        for (size_t j = end; j < s; j++) {
            const bool asks = tangent->a[GM_SIDE_Q][i * s + j] != 0 || tangent->a[GM_SIDE_P][i * s + j] != 0;
            end = asks ? j + 1 : end;
        }
    }
    return end;
}

/* Returns true if the slopes of a stage are needed on that side. */
static bool is_asked(const struct gm_tangent *tangent, size_t stage, size_t side)
{
    const size_t s = tangent->stages;
    bool asked = tangent->b[side][stage] != 0;
    for (size_t i = 0; i < s; i++) {
        asked = asked || tangent->a[side][i * s + stage] != 0;
    }
    return asked;
}

/* A kick needs the slopes of p alone, a drift the slopes of q, the first half; the time moves with q. */
static void choose_components(struct gm_tangent *tangent)
{
    const size_t n = tangent->n;
    for (size_t j = 0; j < tangent->stages; j++) {
        const bool q = is_asked(tangent, j, GM_SIDE_Q), p = is_asked(tangent, j, GM_SIDE_P);
        tangent->from[j] = q ? 0 : n / 2;
        tangent->to[j] = q && (p || n % 2 != 0) ? n : q ? n / 2 : n / 2 * 2;
    }
}

static bool is_running(const struct gm_tangent *tangent)
{
    const size_t s = tangent->stages;
    bool running = true;
    for (size_t i = 0; i < s; i++) {
        for (size_t j = 0; j < s; j++) {
            for (size_t side = 0; side < GM_SIDES; side++) {
                running = running && tangent->a[side][i * s + j] == (j < i ? tangent->b[side][j] : 0);
            }
        }
    }
    return running;
}

static double *doubles(const struct gm_tangent *tangent, size_t count)
{
    return gm_arena_take(tangent->arena, count, sizeof(double));
}

/* Allocates the coefficients and the scratch of the stages. */
static void open_stages(struct gm_tangent *tangent, const struct gm_coefficients *coefficients)
{
    const size_t n = tangent->n, s = (size_t)coefficients->stages;
    tangent->stages = s;
    for (size_t side = 0; side < GM_SIDES; side++) {
        const bool plain = side >= (size_t)gm_coefficients_sides(coefficients);
        const struct gm_ball *a = coefficients->a[plain ? 0 : side], *b = coefficients->b[plain ? 0 : side];
        tangent->a[side] = doubles(tangent, s * s);
        tangent->b[side] = doubles(tangent, s);
        for (size_t i = 0; i < s * s; i++) {
            tangent->a[side][i] = gm_ball_midpoint(a[i]);
        }
        for (size_t i = 0; i < s; i++) {
            tangent->b[side][i] = gm_ball_midpoint(b[i]);
        }
    }
    size_t largest = 1;
    for (size_t first = 0; first < s;) {
        const size_t end = end_of_block(tangent, first);
        largest = end - first > largest ? end - first : largest;
        first = end;
    }
    tangent->running = is_running(tangent);
    tangent->side = gm_arena_take(tangent->arena, n, sizeof *tangent->side);
    for (size_t c = 0; c < n; c++) {
        /* a last component that is the time moves with q */
        tangent->side[c] = c >= n / 2 && c < n / 2 * 2 ? GM_SIDE_P : GM_SIDE_Q;
    }
    tangent->k = doubles(tangent, s * n);
    tangent->w = doubles(tangent, s * n);
    tangent->kicked = doubles(tangent, n);
    tangent->kick = doubles(tangent, n + n * n);
    tangent->y = doubles(tangent, n);
    tangent->dy = doubles(tangent, n);
    tangent->base = doubles(tangent, largest * n);
    tangent->d_base = doubles(tangent, largest * n);
    tangent->at = doubles(tangent, largest * n);
    tangent->jacobians = doubles(tangent, s * n * n);
    tangent->scratch = doubles(tangent, gm_newton_scratch(largest * n));
    tangent->from = gm_arena_take(tangent->arena, s, sizeof *tangent->from);
    tangent->to = gm_arena_take(tangent->arena, s, sizeof *tangent->to);
    tangent->kicked[0] = NAN;
    choose_components(tangent);
}

/* Takes the motion of the next part. */
static void take(struct gm_tangent *tangent, const struct gm_problem *motion)
{
    if (motion != tangent->motion) {
        tangent->motion = motion;
        tangent->between = *motion;
        tangent->between.events = NULL;
        gm_run_close(tangent->probe);
        tangent->probe = NULL;
        if (tangent->stages > 0) {
            tangent->kicked[0] = NAN;
        }
    }
}

static void find_units(const struct gm_tangent *tangent)
{
    const struct gm_gravity *gravity = gm_ode_of(tangent->motion)->gravity;
    for (size_t c = 0; c < tangent->n; c++) {
        tangent->units[c] = 1;
    }
    for (size_t i = 0, half = tangent->n / 2; gravity && i < half; i++) {
        tangent->units[half + gravity->places[i]] =
            gravity->masses[i / gravity->dimensions] / fabs(tangent->run->dt);
    }
}

const double *gm_tangent_units(const struct gm_tangent *tangent)
{
    return tangent->units;
}

struct opening {
    struct gm_run *run;
    struct gm_tangent *tangent;
};

/* The body of an arena. */
static void open_all(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    struct gm_run *run = opening->run;
    const struct gm_family *family = run->scheme->family;
    struct gm_tangent *tangent = opening->tangent = gm_arena_take(arena, 1, sizeof *tangent);
    tangent->arena = arena;
    tangent->run = run;
    take(tangent, run->problem);
    tangent->n = run->problem->n;
    tangent->units = doubles(tangent, tangent->n);
    find_units(tangent);
    tangent->memory = gm_scheme_has_memory(run->scheme) ? family->memory(run->problem, run->scheme) : 0;
    const size_t size = gm_tangent_size(tangent);
    tangent->before = doubles(tangent, size);
    tangent->plus = doubles(tangent, size);
    tangent->minus = doubles(tangent, size);
    tangent->slope = doubles(tangent, size);
    tangent->far_slope = doubles(tangent, size);
    tangent->snapshot = gm_arena_take(arena, 1, gm_run_snapshot_size(run));
    struct gm_coefficients coefficients;
    if (gm_matrix_size(run->problem) > 0 && gm_scheme_coefficients_open(arena, run->scheme, &coefficients)) {
        open_stages(tangent, &coefficients);
        tangent->together = tangent->memory == 0 && !family->adaptive;
    }
}

struct gm_tangent *gm_tangent_open(struct gm_run *run)
{
    struct opening opening = {.run = run};
    return gm_arena_made(open_all, &opening) ? opening.tangent : NULL;
}

void gm_tangent_close(void *data)
{
    struct gm_tangent *tangent = data;
    if (tangent) {
        gm_run_close(tangent->probe);
        gm_arena_close(tangent->arena);
    }
}

size_t gm_tangent_size(const struct gm_tangent *tangent)
{
    return tangent->n + tangent->memory;
}

/* ---- by differences ---- */

static struct gm_run *open_run(const struct gm_tangent *tangent, const double *y)
{
    const struct gm_run *run = tangent->run;
    return gm_run_open(&tangent->between, run->scheme, &run->settings, run->t, run->dt, y);
}

/* Returns the multiple of v by which states are moved: beyond it the terms of order 5 count, below it
   round-off does. A scheme's memory, for example a step, may be small against the state. */
static double distance(const struct gm_tangent *tangent, const double *v)
{
    double largest = 1e-3, most = 0;
    for (size_t c = 0; c < tangent->n; c++) {
        largest = fmax(largest, fabs(tangent->before[c] / tangent->units[c]));
    }
    for (size_t i = 0; i < gm_tangent_size(tangent); i++) {
        const double least = 1e-2 * largest, own = fmax(fabs(tangent->before[i]), least);
        most = fmax(most, fabs(v[i]) / (i < tangent->n ? largest * tangent->units[i] : own));
    }
    return 4e-4 / most;
}

static void take_before(const struct gm_tangent *tangent)
{
    memcpy(tangent->before, gm_run_state(tangent->run), tangent->n * sizeof(double));
    if (tangent->memory > 0) {
        memcpy(tangent->before + tangent->n, gm_run_memory(tangent->run), tangent->memory * sizeof(double));
    }
}

/* Makes a step from `before` + factor v; false if the result is not finite. */
static bool move(const struct gm_tangent *tangent, const double *v, double factor, double *to)
{
    struct gm_run *probe = tangent->probe;
    for (size_t i = 0; i < gm_tangent_size(tangent); i++) {
        to[i] = tangent->before[i] + factor * v[i];
    }
    if (probe->dt != tangent->h) {
        gm_run_set_step(probe, tangent->h);
    }
    gm_run_set_state(probe, to, tangent->memory > 0 ? to + tangent->n : NULL);
    const bool good = gm_run_advance(probe, 1) == GM_OK;
    memcpy(to, gm_run_state(probe), tangent->n * sizeof *to);
    if (tangent->memory > 0) {
        memcpy(to + tangent->n, gm_run_memory(probe), tangent->memory * sizeof *to);
    }
    return good;
}

/* A function of `before` + factor v; false on failure. */
typedef bool moved(const struct gm_tangent *tangent, const double *v, double factor, double *to);

/* slope := (f(y + factor v) - f(y - factor v)) / (2 factor) */
static bool difference(const struct gm_tangent *tangent, const double *v, double factor, moved *become,
                       double *slope)
{
    const bool became =
        become(tangent, v, factor, tangent->plus) && become(tangent, v, -factor, tangent->minus);
    for (size_t i = 0; became && i < gm_tangent_size(tangent); i++) {
        slope[i] = (tangent->plus[i] - tangent->minus[i]) / (2 * factor);
    }
    return became;
}

/* v[i] := the derivative along v of entry i of the function, from `first` on. Differences that are too far apart are
   taken closer: the components may be large against what the function changes over, such as angles of many turns. */
static bool extrapolate(const struct gm_tangent *tangent, double *v, size_t first, moved *become)
{
    const double close = 1e-6, nearest = 1e-4;
    const double widest = distance(tangent, v);
    double apart = INFINITY, size = 0;
    for (double far = widest; apart > close * size && far > nearest * widest; far /= 4) {
        apart = size = 0;
        if (!difference(tangent, v, far / 2, become, tangent->slope) ||
            !difference(tangent, v, far, become, tangent->far_slope)) {
            return false;
        }
        for (size_t i = first; i < gm_tangent_size(tangent); i++) {
            apart = fmax(apart, fabs(tangent->far_slope[i] - tangent->slope[i]));
            size = fmax(size, fabs(tangent->slope[i]));
        }
    }
    for (size_t i = first; i < gm_tangent_size(tangent); i++) {
        v[i] = 4. / 3 * tangent->slope[i] - tangent->far_slope[i] / 3;
    }
    return true;
}

static bool by_differences(struct gm_tangent *tangent, double *v)
{
    tangent->probe = tangent->probe ? tangent->probe : open_run(tangent, tangent->before);
    return tangent->probe && extrapolate(tangent, v, 0, move);
}

/* Computes the scheme's initial memory at `before` + factor v; false if a run cannot start there. */
static bool recall(const struct gm_tangent *tangent, const double *v, double factor, double *to)
{
    for (size_t c = 0; c < tangent->n; c++) {
        to[c] = tangent->before[c] + factor * v[c];
    }
    struct gm_run *run = open_run(tangent, to);
    const bool opened = run && run->status == GM_OK;
    if (opened) {
        memcpy(to + tangent->n, gm_run_memory(run), tangent->memory * sizeof *to);
    }
    gm_run_close(run);
    return opened;
}

bool gm_tangent_begin(struct gm_tangent *tangent, double *v)
{
    if (tangent->memory == 0) {
        return true;
    }
    take_before(tangent);
    /* unknown entries must not affect the distance by which states are moved */
    memset(v + tangent->n, 0, tangent->memory * sizeof *v);
    return extrapolate(tangent, v, tangent->n, recall);
}

/* ---- by the stages ---- */

/* Computes k and the Jacobian of a stage at its state, unless they are those of the previous vector. */
static void evaluate(const struct gm_tangent *tangent, const double *y, size_t stage)
{
    const size_t n = tangent->n;
    const struct gm_problem *problem = tangent->motion;
    const struct gm_loops *loops = gm_ode_of(problem)->loops[GM_ISA_BASELINE];
    if (!tangent->again) {
        loops->field(problem, y, tangent->k + stage * n, 1);
        loops->jacobian(problem, y, tangent->jacobians + stage * n * n);
    }
}

/* Computes the needed components of a stage's w. */
static void multiply(const struct gm_tangent *tangent, const double *dy, size_t stage)
{
    const size_t n = tangent->n;
    const double *jacobian = tangent->jacobians + stage * n * n;
    for (size_t row = tangent->from[stage]; row < tangent->to[stage]; row++) {
        double sum = 0;
        for (size_t c = 0; c < n; c++) {
            sum += jacobian[row * n + c] * dy[c];
        }
        tangent->w[stage * n + row] = sum;
    }
}

/* Adds h times the weighted slopes of the stages from `first` up to `end`, and of their derivatives. */
static void add_slopes(const struct gm_tangent *tangent, double *const weights[GM_SIDES], size_t first,
                       size_t end, double *y, double *dy)
{
    const size_t n = tangent->n;
    for (size_t j = first; j < end; j++) {
        const double factors[GM_SIDES] = {tangent->h * weights[GM_SIDE_Q][j],
                                          tangent->h * weights[GM_SIDE_P][j]};
        for (size_t c = tangent->from[j]; c < tangent->to[j]; c++) {
            const double factor = factors[tangent->side[c]];
            y[c] += factor * tangent->k[j * n + c];
            dy[c] += factor * tangent->w[j * n + c];
        }
    }
}

/* Some stages that depend on each other. */
struct block {
    const struct gm_tangent *tangent;
    size_t first, count;
};

/* base + h sum_j a_ij k_j - Y_i, and 1 - h a_ij f'(Y_j); gm_linear_equations */
static bool linear(void *data, const double *states, double *residual, double *matrix, double *scale)
{
    const struct block *block = data;
    const struct gm_tangent *tangent = block->tangent;
    const size_t n = tangent->n, s = tangent->stages, first = block->first, count = block->count;
    const double h = tangent->h;
    for (size_t j = 0; j < count; j++) {
        evaluate(tangent, states + j * n, first + j);
    }
    for (size_t r = 0; r < count * n; r++) {
        const size_t c = r % n;
        const double *weights = tangent->a[tangent->side[c]] + (first + r / n) * s + first;
        double slope = 0;
        for (size_t j = 0; j < count; j++) {
            slope += weights[j] * tangent->k[(first + j) * n + c];
            for (size_t k = 0; k < n; k++) {
                matrix[r * count * n + j * n + k] =
                    (r == j * n + k) - h * weights[j] * tangent->jacobians[((first + j) * n + c) * n + k];
            }
        }
        residual[r] = tangent->base[r] + h * slope - states[r];
        *scale += fabs(states[r]) + fabs(h * slope);
    }
    return true;
}

/* Solves for the stages of a block and their derivatives; false if Newton's method fails. The last, small
   change leaves an error of its square. */
static bool solve_block(const struct gm_tangent *tangent, size_t first, size_t count)
{
    const size_t n = tangent->n, all = count * n;
    double *right = tangent->scratch, *matrix = right + all, unused = 0;
    struct block block = {tangent, first, count};
    struct gm_progress ignored = {0};
    const struct gm_implicit_equations equations = {
        .size = all, .data = &block, .linear = linear, .counted = all, .least = 0x1p-40, .roundoff = 0x1p-40};
    if (!tangent->again) {
        memcpy(tangent->at, tangent->base, all * sizeof(double));
        if (!gm_newton_solve(&equations, tangent->scratch, tangent->at, &ignored)) {
            return false;
        }
    }
    linear(&block, tangent->at, right, matrix, &unused);
    memcpy(right, tangent->d_base, all * sizeof(double));
    if (!gm_eliminate(all, matrix, right)) {
        return false;
    }
    for (size_t j = 0; j < count; j++) {
        multiply(tangent, right + j * n, first + j);
    }
    return true;
}

/* Sums the stages before the block for its stage i. */
static void find_base(const struct gm_tangent *tangent, const double *v, size_t first, size_t i)
{
    const size_t n = tangent->n, s = tangent->stages;
    double *const weights[GM_SIDES] = {tangent->a[GM_SIDE_Q] + (first + i) * s,
                                       tangent->a[GM_SIDE_P] + (first + i) * s};
    memcpy(tangent->base + i * n, tangent->before, n * sizeof(double));
    memcpy(tangent->d_base + i * n, v, n * sizeof(double));
    add_slopes(tangent, weights, 0, first, tangent->base + i * n, tangent->d_base + i * n);
}

/* Computes k and w of a stage that depends on earlier ones only. If H = T + V, a drift of unit mass needs no
   evaluation, and a kick at the last kick's place, such as the first of a step, has the same force. */
static void find_slopes(const struct gm_tangent *tangent, size_t stage, const double *y, const double *dy)
{
    const size_t n = tangent->n, half = n / 2, from = tangent->from[stage], to = tangent->to[stage];
    const struct gm_split *split = gm_ode_of(tangent->motion)->split;
    double *k = tangent->k + stage * n;
    if (split && split->unit_mass && from == 0 && to == half) {
        memcpy(k, y + half, half * sizeof *k);
        memcpy(tangent->w + stage * n, dy + half, half * sizeof *k);
        return;
    }
    double *jacobian = tangent->jacobians + stage * n * n;
    const bool kick = split && n % 2 == 0 && from == half && !tangent->again;
    if (kick && memcmp(y, tangent->kicked, half * sizeof *y) == 0) {
        memcpy(k, tangent->kick, n * sizeof *k);
        memcpy(jacobian, tangent->kick + n, n * n * sizeof *k);
    } else {
        evaluate(tangent, y, stage);
    }
    if (kick) {
        memcpy(tangent->kicked, y, n * sizeof *y);
        memcpy(tangent->kick, k, n * sizeof *k);
        memcpy(tangent->kick + n, jacobian, n * n * sizeof *k);
    }
    multiply(tangent, dy, stage);
}

/* y and dy at the end of the step that begins in `before`. */
static bool by_stages(const struct gm_tangent *tangent, const double *v)
{
    const size_t n = tangent->n, s = tangent->stages;
    memcpy(tangent->y, tangent->before, n * sizeof(double));
    memcpy(tangent->dy, v, n * sizeof(double));
    for (size_t j = 0; tangent->running && j < s; j++) {
        find_slopes(tangent, j, tangent->y, tangent->dy);
        add_slopes(tangent, tangent->b, j, j + 1, tangent->y, tangent->dy);
    }
    for (size_t first = 0, end; !tangent->running && first < s; first = end) {
        end = end_of_block(tangent, first);
        for (size_t i = 0; i < end - first; i++) {
            find_base(tangent, v, first, i);
        }
        const size_t own = first * s + first;
        if (end == first + 1 && tangent->a[GM_SIDE_Q][own] == 0 && tangent->a[GM_SIDE_P][own] == 0) {
            find_slopes(tangent, first, tangent->base, tangent->d_base);
        } else if (!solve_block(tangent, first, end - first)) {
            return false;
        }
        add_slopes(tangent, tangent->b, first, end, tangent->y, tangent->dy);
    }
    return true;
}

/* Returns true if the stages' result is the scheme's state y; equations with several solutions may give
   another. */
static bool is_there(const struct gm_tangent *tangent, const double *y)
{
    const double close = 1e-9;
    double difference = 0, size = 0;
    for (size_t c = 0; c < tangent->n; c++) {
        difference += fabs(y[c] - tangent->y[c]);
        size += fabs(y[c]) + fabs(y[c] - tangent->before[c]);
    }
    return difference <= close * size;
}

/* ---- volumes ---- */

void gm_tangent_follow_volume(struct gm_tangent *tangent, double *square)
{
    tangent->square = square;
    tangent->volume = 0;
}

double gm_tangent_volume(const struct gm_tangent *tangent)
{
    return tangent->volume;
}

/* Returns NaN if it is not known. */
static double divergence_at(const struct gm_tangent *tangent, const double *y)
{
    const size_t n = tangent->n;
    const bool known = gm_jacobian(tangent->motion, y, tangent->square);
    double sum = 0;
    for (size_t c = 0; c < n; c++) {
        sum += tangent->square[c * n + c];
    }
    return known ? sum : NAN;
}

/* Adds the integral of the divergence over a step or part from `before` to y, which takes this time. */
static void integrate(struct gm_tangent *tangent, double time, const double *y)
{
    const double begin = divergence_at(tangent, tangent->before);
    double middle = NAN;
    tangent->probe = tangent->probe ? tangent->probe : open_run(tangent, tangent->before);
    if (tangent->probe) {
        gm_run_set_step(tangent->probe, tangent->h / 2);
        gm_run_set_state(tangent->probe, tangent->before, NULL);
        if (gm_run_advance(tangent->probe, 1) == GM_OK) {
            middle = divergence_at(tangent, gm_run_state(tangent->probe));
        } else { /* it makes no step any more */
            gm_run_close(tangent->probe);
            tangent->probe = NULL;
        }
    }
    tangent->volume += time / 6 * (begin + 4 * middle + divergence_at(tangent, y));
}

/* v := v less its part along the unit vector u. */
static void remove_part(const double *u, double *v, size_t n, size_t size)
{
    double along = 0;
    for (size_t c = 0; c < n; c++) {
        along += u[c] * v[c];
    }
    for (size_t c = 0; c < size; c++) {
        v[c] -= along * u[c];
    }
}

static double square_of(const double *v, size_t n)
{
    double square = 0;
    for (size_t c = 0; c < n; c++) {
        square += v[c] * v[c];
    }
    return square;
}

double gm_tangent_orthonormalise(double *vectors, size_t k, size_t n, size_t size)
{
    const double noise = 1e-28; /* of the squares of lengths */
    double *v = vectors + k * size;
    const double whole = square_of(v, n);
    for (size_t i = 0; i < 2 * k; i++) {
        remove_part(vectors + i % k * size, v, n, size);
    }
    const double left = square_of(v, n), square = left > noise * whole ? left : 0;
    for (size_t c = 0; c < size; c++) {
        v[c] = square > 0 ? v[c] / sqrt(square) : 0;
    }
    return square;
}

/* Adds ln |det S|, the logarithms of what is left of the lengths of its columns. */
static void jump(struct gm_tangent *tangent, const struct gm_event_part *part)
{
    const size_t n = tangent->n;
    const struct gm_problem *problem = tangent->run->problem;
    double *image = tangent->plus;
    for (size_t k = 0; k < n; k++) {
        memset(image, 0, gm_tangent_size(tangent) * sizeof *image);
        image[k] = 1;
        problem->events->carry(problem, part, image);
        memcpy(tangent->square + k * n, image, n * sizeof *image);
        tangent->volume += gm_log(gm_tangent_orthonormalise(tangent->square, k, n, n)) / 2;
    }
}

/* Each of the vectors := the derivative of a step or part of length h from `before` to y, times it; the time that it
   takes may be another one, of a scheme that chooses it. */
static bool carry(struct gm_tangent *tangent, double h, double time, const double *y)
{
    const size_t size = gm_tangent_size(tangent);
    bool staged = tangent->stages > 0, found = true;
    double *v = tangent->v;
    tangent->h = h;
    if (tangent->square) {
        integrate(tangent, time, y);
    }
    for (size_t k = 0; k < tangent->count && found; k++, v += size) {
        tangent->again = k > 0;
        staged = staged && by_stages(tangent, v) && is_there(tangent, y);
        if (staged) {
            memcpy(v, tangent->dy, tangent->n * sizeof *v);
        } else {
            found = by_differences(tangent, v);
        }
    }
    tangent->again = false;
    return found;
}

/* Carries the vectors to an event, and through it. */
static void see_event(void *data, const struct gm_event_part *part)
{
    struct gm_tangent *tangent = data;
    const struct gm_problem *problem = tangent->run->problem;
    const size_t n = tangent->n, size = gm_tangent_size(tangent);
    const double t = part->before[n], h = t - tangent->t;
    tangent->events++;
    take(tangent, part->ahead);
    tangent->broken = tangent->broken || (h != 0 && !carry(tangent, h, h, part->before));
    for (size_t k = 0; k < tangent->count && !tangent->broken; k++) {
        tangent->grazes = tangent->broken = !problem->events->carry(problem, part, tangent->v + k * size);
    }
    if (tangent->square && !tangent->broken) {
        jump(tangent, part);
    }
    take(tangent, part->beyond);
    memcpy(tangent->before, part->after, n * sizeof *tangent->before);
    tangent->t = t;
}

bool gm_tangent_step(struct gm_tangent *tangent, double *v, size_t count)
{
    struct gm_run *run = tangent->run;
    const struct gm_problem *motion = gm_run_motion(run);
    if (!motion) {
        return false;
    }
    take(tangent, motion);
    take_before(tangent);
    tangent->v = v;
    tangent->count = count;
    tangent->t = run->t;
    tangent->events = 0;
    run->witness = (struct gm_event_witness){see_event, tangent};
    const bool good = gm_run_advance(run, 1) == GM_OK;
    run->witness = (struct gm_event_witness){0};
    if (!good || tangent->broken) {
        return false;
    }
    const double time = run->t - tangent->t, h = tangent->events > 0 ? time : run->dt;
    return h == 0 || carry(tangent, h, time, gm_run_state(run));
}

bool gm_tangent_grazes(const struct gm_tangent *tangent)
{
    return tangent->grazes;
}

/* ---- many steps ---- */

/* Scales v to length 1; returns its previous length, 0 if that is 0 or not finite. */
static double normalise(const struct gm_tangent *tangent, double *v)
{
    double square = 0;
    for (size_t c = 0; c < tangent->n; c++) {
        square += v[c] * v[c];
    }
    const double length = sqrt(square);
    if (!(length > 0 && length < INFINITY)) {
        return 0;
    }
    const double inverse = 1 / length;
    for (size_t i = 0; i < gm_tangent_size(tangent); i++) {
        v[i] *= inverse;
    }
    return length;
}

/* Makes steps with the stages alone, from the run's state to the one in `before`. */
static bool follow_stages(struct gm_tangent *tangent, double *v, size_t steps, struct gm_stretch *made)
{
    const struct gm_run *run = tangent->run;
    const size_t bytes = tangent->n * sizeof *v;
    take_before(tangent);
    tangent->h = run->dt;
    for (size_t i = 0; i < steps; i++) {
        if (!by_stages(tangent, v)) {
            return false;
        }
        memcpy(tangent->before, tangent->y, bytes);
        memcpy(v, tangent->dy, bytes);
        made[i] =
            (struct gm_stretch){run->t0 + (double)(run->n + (int64_t)i + 1) * run->dt, normalise(tangent, v)};
        if (!(made[i].length > 0)) {
            return false;
        }
    }
    return true;
}

/* Makes steps with the stages, then the run; unless both agree to the last bit, restores all. */
static bool advance_together(struct gm_tangent *tangent, double *v, size_t steps, struct gm_stretch *made)
{
    const size_t bytes = tangent->n * sizeof *v;
    memcpy(tangent->plus, v, bytes);
    gm_run_save(tangent->run, tangent->snapshot);
    const bool same = follow_stages(tangent, v, steps, made) &&
                      gm_run_advance(tangent->run, (int64_t)steps) == GM_OK &&
                      memcmp(gm_run_state(tangent->run), tangent->before, bytes) == 0;
    if (!same) {
        gm_run_load(tangent->run, tangent->snapshot);
        memcpy(v, tangent->plus, bytes);
    }
    return same;
}

size_t gm_tangent_advance(struct gm_tangent *tangent, double *v, size_t steps, struct gm_stretch *made)
{
    size_t count = 0;
    const struct gm_problem *motion = gm_run_motion(tangent->run);
    if (!motion) {
        return 0;
    }
    take(tangent, motion);
    tangent->together = tangent->together && advance_together(tangent, v, steps, made);
    if (tangent->together) {
        return steps;
    }
    while (count < steps && gm_tangent_step(tangent, v, 1)) {
        made[count] = (struct gm_stretch){tangent->run->t, normalise(tangent, v)};
        if (!(made[count].length > 0)) {
            break;
        }
        count++;
    }
    return count;
}
