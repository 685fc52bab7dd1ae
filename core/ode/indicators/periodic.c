/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Newton's method for periodic orbits. A correction is halved until the residual falls. */
#include "core/ode/indicators/periodic.h"

#include <math.h>
#include <string.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/linear/eigenvalues.h"
#include "core/linear/settled.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/ode.h"

enum { MOST_ITERATIONS = 50, LEAST_STEPS = 64, MOST_STEPS = 1 << 18 };
static const double settled = 2e-12, resolved = 1e-6, stalled = 1e-9, smallest_factor = 0x1p-12;

struct search {
    struct gm_periodic *orbit;
    struct gm_arena *arena;
    size_t n;       /* unknown components: all but the time */
    size_t size;    /* unknowns, with the period */
    double *end;    /* phi_T(y) */
    double *frame;  /* the columns of M, one after the other, each with the scheme's memory */
    size_t stride;  /* of a column */
    double *matrix; /* size * size by rows */
    double *change, *trial, *slope;
    double *gap;    /* y - phi_T(y) */
    double extent;  /* the largest distance from the start along the orbit */
    double first;   /* extent of the first guess */
    double largest; /* component of the first guess */
    bool across;    /* corrections are normal to f */
    double guess;   /* of the period */
};

/* The difference of a component, of an angle between -pi and pi. */
static double difference(const struct gm_problem *problem, size_t c, double a, double b)
{
    const bool *angles = gm_ode_of(problem)->angles;
    return a - b - (angles && angles[c] ? 2 * M_PI * round((a - b) / (2 * M_PI)) : 0);
}

static double distance(const struct search *search, const double *a, const double *b)
{
    double square = 0;
    for (size_t c = 0; c < search->n; c++) {
        const double apart = difference(search->orbit->problem, c, a[c], b[c]);
        square += apart * apart;
    }
    return sqrt(square);
}

static struct gm_run *open_run(const struct gm_periodic *orbit, struct gm_arena *arena, const double *y,
                               double dt)
{
    struct gm_run *run = gm_run_open(orbit->problem, orbit->scheme, orbit->settings, orbit->t0, dt, y);
    return gm_arena_keep(arena, run, gm_run_close);
}

/* Makes the steps of a period from y, the frame with them if that is wanted. Returns the residual; infinity if a step
   fails. */
static double follow(struct search *search, const double *y, double period, bool with_frame)
{
    const struct gm_periodic *orbit = search->orbit;
    const size_t mark = gm_arena_mark(search->arena);
    struct gm_run *run = open_run(orbit, search->arena, y, period / (double)orbit->steps);
    struct gm_tangent *tangent = NULL;
    bool good = run->status == GM_OK;
    if (with_frame) {
        tangent = gm_tangent_open(run);
        gm_arena_keep(search->arena, tangent, gm_tangent_close);
        search->stride = gm_tangent_size(tangent);
        memset(search->frame, 0, search->n * search->stride * sizeof *search->frame);
        for (size_t k = 0; k < search->n; k++) {
            search->frame[k * search->stride + k] = 1;
            good = good && gm_tangent_begin(tangent, search->frame + k * search->stride);
        }
    }
    double farthest = 0;
    for (int64_t i = 0; i < orbit->steps && good; i++) {
        good = tangent ? gm_tangent_step(tangent, search->frame, search->n) : gm_run_advance(run, 1) == GM_OK;
        farthest = fmax(farthest, distance(search, gm_run_state(run), y));
    }
    search->extent = y == orbit->start ? farthest : search->extent;
    memcpy(search->end, gm_run_state(run), orbit->problem->n * sizeof(double));
    for (size_t c = 0; c < search->n; c++) {
        search->gap[c] = difference(orbit->problem, c, y[c], search->end[c]);
    }
    const double residual = distance(search, search->end, y);
    gm_arena_release(search->arena, mark);
    return good && isfinite(residual) ? residual : INFINITY;
}

static double largest_of(const struct search *search)
{
    double largest = search->largest;
    for (size_t c = 0; c < search->n; c++) {
        largest = fmax(largest, fabs(search->orbit->start[c]));
    }
    return largest;
}

/* Returns a part of the orbit's extent, but not less than the rounding of its components. */
static double part_of(const struct search *search, double part)
{
    return fmax(part * search->extent, 32 * GM_EPSILON * largest_of(search));
}

/* Makes a matrix, n * n, that gives 0 for a direction, so that the shortest solutions are normal to it. */
static void leave_out(double *matrix, const double *direction, size_t n)
{
    double square = 0;
    for (size_t k = 0; k < n; k++) {
        square += direction[k] * direction[k];
    }
    for (double *row = matrix; square > 0 && row < matrix + n * n; row += n) {
        double along = 0;
        for (size_t k = 0; k < n; k++) {
            along += row[k] * direction[k] / square;
        }
        for (size_t k = 0; k < n; k++) {
            row[k] -= along * direction[k];
        }
    }
}

/* Fills the matrix and the right side, and solves for the change. Returns false if that fails. */
static bool solve(struct search *search)
{
    const struct gm_periodic *orbit = search->orbit;
    const size_t n = search->n, size = search->size;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            search->matrix[i * size + k] = search->frame[k * search->stride + i] - (i == k);
        }
        search->change[i] = search->gap[i];
    }
    if (search->across) {
        gm_field(orbit->problem, orbit->start, search->slope, 1);
        leave_out(search->matrix, search->slope, n);
    }
    double speeds[2] = {1,
                        1}; /* |f|, in units of which the period and the last equation are of the size of M */
    for (int side = 0; side < 2 && orbit->free; side++) {
        gm_field(orbit->problem, side == 0 ? search->end : orbit->start, search->slope, 1);
        double square = 0;
        for (size_t i = 0; i < n; i++) {
            square += search->slope[i] * search->slope[i];
        }
        speeds[side] = square > 0 ? sqrt(square) : 1;
        for (size_t i = 0; i < n; i++) {
            const double part = search->slope[i] / speeds[side];
            search->matrix[side == 0 ? i * size + n : n * size + i] =
                side == 0 || orbit->held == SIZE_MAX ? part : i == orbit->held;
        }
        search->matrix[n * size + n] = search->change[n] = 0;
    }
    const bool solved = gm_singular_solve(search->matrix, size, 1e-9, search->change);
    search->change[n] /= speeds[0];
    return solved;
}

/* Makes the change, halved until the residual falls below `residual`, which is that of the start. Returns false, and
   leaves the orbit as it is, if it does not fall. */
static bool correct(struct search *search, double residual)
{
    struct gm_periodic *orbit = search->orbit;
    /* next to the solution only round-off is left, which no shorter change reduces */
    const double least = residual <= part_of(search, stalled) ? 1 : smallest_factor;
    memcpy(search->trial, orbit->start, orbit->problem->n * sizeof(double));
    for (double factor = 1; factor >= least; factor /= 2) {
        const double period = orbit->period + (orbit->free ? factor * search->change[search->n] : 0);
        for (size_t c = 0; c < search->n; c++) {
            const double change = factor * search->change[c];
            const bool is_rounding = c == orbit->held && fabs(change) <= 4 * GM_EPSILON * largest_of(search);
            search->trial[c] = orbit->start[c] + (is_rounding ? 0 : change);
        }
        if (period > search->guess / 2 && period < 2 * search->guess &&
            follow(search, search->trial, period, false) < residual) {
            memcpy(orbit->start, search->trial, orbit->problem->n * sizeof(double));
            orbit->period = period;
            return true;
        }
    }
    return false;
}

/* Returns the residual that the rounding of the start makes: no start in double precision has a smaller one. */
static double roundoff_of(const struct search *search)
{
    double square = 0;
    for (size_t i = 0; i < search->n * search->n; i++) {
        const double entry = search->frame[i / search->n * search->stride + i % search->n];
        square += entry * entry;
    }
    return GM_EPSILON * sqrt(square) * largest_of(search);
}

/* Iterates with these steps; the frame is that of the orbit at the end. The orbits of a Hamiltonian system are in
   families, of which a map leaves single orbits next to one another: it is first corrected across the orbit. */
static void iterate(struct search *search)
{
    struct gm_periodic *orbit = search->orbit;
    orbit->residual = follow(search, orbit->start, orbit->period, true);
    for (search->across = !orbit->free && orbit->steps > 1 && gm_ode_of(orbit->problem)->hamiltonian;;) {
        const bool corrected = orbit->residual > roundoff_of(search) && isfinite(orbit->residual) &&
                               orbit->iterations < MOST_ITERATIONS && solve(search) &&
                               correct(search, orbit->residual);
        if (!corrected && !search->across) {
            return;
        }
        search->across = search->across && corrected;
        orbit->iterations += corrected;
        orbit->residual = follow(search, orbit->start, orbit->period, true);
    }
}

/* Halves the steps until the end changes by less than 2e-12 of the extent, or only by round-off, which steps do not
   reduce. Returns true if they were halved. */
static bool refine(struct search *search)
{
    struct gm_periodic *orbit = search->orbit;
    const int64_t first = orbit->steps;
    const size_t n = search->n;
    double before = INFINITY, apart = INFINITY;
    bool done = false;
    follow(search, orbit->start, orbit->period, false);
    while (!done && orbit->steps < MOST_STEPS) {
        memcpy(search->trial, search->end, n * sizeof(double));
        orbit->steps *= 2;
        const bool there = isfinite(follow(search, orbit->start, orbit->period, false));
        before = apart;
        apart = there ? 0 : INFINITY;
        for (size_t c = 0; c < n && there; c++) {
            apart = fmax(apart, fabs(search->end[c] - search->trial[c]));
        }
        done =
            apart <= part_of(search, settled) || (before < part_of(search, resolved) && apart > before / 8);
    }
    const bool halved = orbit->steps > 2 * first;
    orbit->steps /= done ? 2 : 1;
    return halved;
}

/* Corrects the period alone if that closes the orbit: a start on a periodic orbit stays as it is. */
static void adjust_period(struct search *search)
{
    struct gm_periodic *orbit = search->orbit;
    double residual = follow(search, orbit->start, orbit->period, false), before = INFINITY;
    while (residual < before / 2) {
        double along = 0, square = 0;
        gm_field(orbit->problem, search->end, search->slope, 1);
        for (size_t c = 0; c < search->n; c++) {
            along += search->slope[c] * search->gap[c];
            square += search->slope[c] * search->slope[c];
        }
        const double period = orbit->period + along / square;
        before = residual;
        residual = period > 0 ? follow(search, orbit->start, period, false) : INFINITY;
        orbit->period = residual < before ? period : orbit->period;
    }
    orbit->period = fmin(residual, before) <= part_of(search, resolved) ? orbit->period : search->guess;
}

/* An orbit that closes several times in its period has a shorter one: a start far away may return only after some
   turns. */
static void shorten(struct search *search)
{
    enum { MOST_TURNS = 8 };
    struct gm_periodic *orbit = search->orbit;
    for (int turns = MOST_TURNS; turns > 1; turns--) {
        const double period = orbit->period / turns;
        const double most = part_of(search, stalled);
        /* the extent of this part has to be more than what closes */
        if (follow(search, orbit->start, period, false) <= most && search->extent > 4 * most) {
            orbit->period = search->guess = period;
            iterate(search);
            turns = MOST_TURNS + 1;
        }
    }
}

/* Writes the multipliers of an orbit that was found, in descending order of their moduli. */
static void find_multipliers(struct search *search)
{
    struct gm_periodic *orbit = search->orbit;
    const size_t n = search->n;
    double *re = orbit->multipliers, *im = re + n, square = 0;
    for (size_t i = 0; i < n * n; i++) {
        search->matrix[i] = search->frame[i % n * search->stride + i / n];
        square += search->matrix[i] * search->matrix[i];
    }
    const bool exact = strcmp(gm_tangent_word(orbit->scheme), "exact") == 0;
    orbit->error =
        (exact ? 1e-12 : 1e-7) * fmax(1, sqrt(square)); /* of steps, and of differences between them */
    orbit->count = orbit->status == GM_PERIODIC_FOUND && gm_eigenvalues(search->matrix, n, re, im) ? n : 0;
    for (size_t i = 1; i < orbit->count; i++) {
        const double x = re[i], y = im[i];
        size_t at = i;
        for (; at > 0 && gm_hypot(re[at - 1], im[at - 1]) < gm_hypot(x, y); at--) {
            re[at] = re[at - 1];
            im[at] = im[at - 1];
        }
        re[at] = x;
        im[at] = y;
    }
}

/* Follows the frame a step later. The multipliers are the same there, and a start on a switch or an event would pass it
   neither at the start nor at the end. */
static void follow_later(struct search *search)
{
    const struct gm_periodic *orbit = search->orbit;
    struct gm_run *run = open_run(orbit, search->arena, orbit->start, orbit->period / (double)orbit->steps);
    if (gm_run_advance(run, 1) == GM_OK) {
        memcpy(search->trial, gm_run_state(run), orbit->problem->n * sizeof(double));
        follow(search, search->trial, orbit->period, true);
    }
}

static void find(struct gm_arena *arena, void *data)
{
    struct gm_periodic *orbit = data;
    struct search search = {.orbit = orbit, .arena = arena};
    const size_t all = orbit->problem->n;
    search.n = all - (gm_has_time(orbit->problem) ? 1 : 0);
    search.size = search.n + (orbit->free ? 1 : 0);
    struct gm_run *run = open_run(orbit, arena, orbit->start, orbit->period);
    const struct gm_family *family = orbit->scheme->family;
    const size_t memory =
        gm_scheme_has_memory(orbit->scheme) ? family->memory(run->problem, orbit->scheme) : 0;
    search.end = gm_arena_take(arena, all, sizeof(double));
    search.trial = gm_arena_take(arena, all, sizeof(double));
    search.slope = gm_arena_take(arena, all, sizeof(double));
    search.change = gm_arena_take(arena, all + 1, sizeof(double));
    search.gap = gm_arena_take(arena, all, sizeof(double));
    search.frame = gm_arena_take(arena, all * (all + memory), sizeof(double));
    search.matrix = gm_arena_take(arena, (all + 1) * (all + 1), sizeof(double));
    orbit->iterations = 0;
    search.guess = orbit->period;
    search.largest = largest_of(&search);
    follow(&search, orbit->start, orbit->period, false);
    search.first = search.extent;
    if (orbit->refined) {
        orbit->steps = LEAST_STEPS;
        refine(&search);
    }
    if (orbit->free) {
        adjust_period(&search);
    }
    do {
        iterate(&search);
    } while (orbit->refined && orbit->residual <= part_of(&search, stalled) && refine(&search));
    /* next to an equilibrium of weak decay the residual is small, but not against the motion */
    const double least = fmax(1e6 * orbit->residual, 64 * GM_EPSILON * largest_of(&search)) / orbit->period;
    double fastest = 0;
    gm_field(orbit->problem, orbit->start, search.slope, 1);
    for (size_t c = 0; c < search.n; c++) {
        fastest = fmax(fastest, fabs(search.slope[c]));
    }
    const bool closed = orbit->residual <= part_of(&search, stalled),
               shrank = isfinite(orbit->residual) && search.extent <= 1e-8 * search.first;
    orbit->status = orbit->free && (shrank || (closed && fastest <= least)) ? GM_PERIODIC_EQUILIBRIUM
                    : closed                                                ? GM_PERIODIC_FOUND
                                                                            : GM_PERIODIC_NO_CONVERGENCE;
    if (orbit->free && orbit->status == GM_PERIODIC_FOUND) {
        shorten(&search);
    }
    if (orbit->problem->events && orbit->steps > 1 && orbit->status == GM_PERIODIC_FOUND) {
        follow_later(&search);
    }
    find_multipliers(&search);
}

bool gm_periodic_find(struct gm_periodic *orbit)
{
    return gm_arena_run_once(find, orbit);
}

struct returning {
    struct gm_periodic *orbit;
    double dt, time; /* NAN: no return */
    int64_t steps;
    bool crowded; /* with more than an event in four steps: others may be within one */
};

static bool is_crowded(const struct gm_run *run)
{
    return run->problem->events &&
           gm_events_happened(run->problem, gm_run_events(run), SIZE_MAX) > 1 + (double)run->steps / 4;
}

static void return_once(struct gm_arena *arena, void *data)
{
    struct returning *returning = data;
    struct gm_periodic *orbit = returning->orbit;
    const size_t n = orbit->problem->n;
    double *normal = gm_arena_take(arena, n, sizeof *normal), before = 0, farthest = 0;
    struct gm_run *run = open_run(orbit, arena, orbit->start, returning->dt);
    gm_field(orbit->problem, orbit->start, normal, 1);
    returning->time = NAN;
    for (int64_t i = 1; i <= returning->steps && isnan(returning->time) && !is_crowded(run) &&
                        gm_run_advance(run, 1) == GM_OK;
         i++) {
        double beyond = 0, square = 0;
        for (size_t c = 0; c < n; c++) {
            const double away = difference(orbit->problem, c, gm_run_state(run)[c], orbit->start[c]);
            beyond += normal[c] * away;
            square += away * away;
        }
        farthest = fmax(farthest, square);
        returning->time = before < 0 && beyond >= 0 && square < farthest / 4
                              ? returning->dt * ((double)i - beyond / (beyond - before))
                              : NAN;
        before = beyond;
    }
    returning->crowded = is_crowded(run);
    if (isnan(returning->time) && !is_crowded(run) && run->status == GM_OK) {
        memcpy(orbit->start, gm_run_state(run), n * sizeof *normal);
    }
}

double gm_first_return(struct gm_periodic *orbit, double dt, int64_t steps)
{
    enum { MOST_SHORTER = 12 };
    struct returning returning = {orbit, dt, NAN, steps, true};
    for (int i = 0; i < MOST_SHORTER && returning.crowded; i++) {
        returning.crowded = false; /* if memory is short */
        gm_arena_run_once(return_once, &returning);
        returning.dt /= 16;
    }
    return returning.time;
}

struct fitting {
    const struct gm_periodic *orbit;
    struct gm_period_miss *miss;
    bool fits;
};

/* Compares at a time without a simple ratio to the period, where a driving force seldom jumps, with what the time
   changes within the period. */
static void fit(struct gm_arena *arena, void *data)
{
    enum { STATES = 8, APART = 8, PARTS = 8 };
    struct fitting *fitting = data;
    const struct gm_periodic *orbit = fitting->orbit;
    const size_t n = orbit->problem->n;
    double *y = gm_arena_take(arena, 4 * n, sizeof *y), *at = y + n, *later = at + n, *change = later + n;
    struct gm_run *run = open_run(orbit, arena, orbit->start, orbit->period / (STATES * APART));
    for (int k = 0; k < STATES && fitting->fits && run->status == GM_OK; k++) {
        memcpy(y, gm_run_state(run), n * sizeof *y);
        const double t = y[n - 1] += 0.37 * run->dt;
        gm_field(orbit->problem, y, at, 1);
        memset(change, 0, n * sizeof *change);
        for (int part = 1; part <= PARTS; part++) {
            y[n - 1] = t + orbit->period * part / PARTS;
            gm_field(orbit->problem, y, later, 1);
            for (size_t c = 0; c < n - 1 && part < PARTS; c++) {
                change[c] = fmax(change[c], fabs(later[c] - at[c]));
            }
        }
        for (size_t c = 0; c < n - 1 && fitting->fits; c++) {
            const double rounding = 64 * GM_EPSILON * (fabs(at[c]) + fabs(later[c]));
            fitting->fits = !(fabs(later[c] - at[c]) > 1e-6 * change[c] + rounding);
            *fitting->miss = (struct gm_period_miss){c, t, {at[c], later[c]}};
        }
        gm_run_advance(run, APART);
    }
}

bool gm_period_fits(const struct gm_periodic *orbit, struct gm_period_miss *miss)
{
    struct fitting fitting = {orbit, miss, true};
    gm_arena_run_once(fit, &fitting);
    return fitting.fits;
}

struct resting {
    const struct gm_periodic *orbit;
    double dt;
    bool rests;
};

static void look_at_start(struct gm_arena *arena, void *data)
{
    struct resting *resting = data;
    const struct gm_problem *problem = resting->orbit->problem;
    double *slope = gm_arena_take(arena, problem->n, sizeof *slope), fastest = 0, largest = 0;
    gm_field(problem, resting->orbit->start, slope, 1);
    for (size_t c = 0; c < problem->n; c++) {
        fastest = fmax(fastest, fabs(slope[c]));
        largest = fmax(largest, fabs(resting->orbit->start[c]));
    }
    resting->rests = fastest * resting->dt <= GM_EPSILON * largest;
}

bool gm_start_rests(const struct gm_periodic *orbit, double dt)
{
    struct resting resting = {orbit, dt, false};
    gm_arena_run_once(look_at_start, &resting);
    return resting.rests;
}

/* The number of multipliers that are at most so far from 1 as one of them. */
static size_t nearer_than(const struct gm_periodic *orbit, size_t i)
{
    const double *re = orbit->multipliers, *im = re + orbit->count;
    size_t nearer = 0;
    for (size_t k = 0; k < orbit->count; k++) {
        const double one = gm_hypot(re[k] - 1, im[k]), own = gm_hypot(re[i] - 1, im[i]);
        nearer += one < own || (one == own && k < i);
    }
    return nearer;
}

/* The error of `ones` multipliers 1. A root of order k moves by the k-th root of an error. Multipliers of the structure come in
   pairs, f and an invariant, whose blocks have two rows. */
static double error_of_ones(const struct gm_periodic *orbit, size_t ones)
{
    const size_t others = ones > orbit->by_structure ? ones - orbit->by_structure : 0,
                 order = ones < 2 + others ? ones : 2 + others;
    return gm_pow(orbit->error, 1 / (double)order);
}

/* The number of multipliers that cannot be distinguished from 1. */
static size_t count_ones(const struct gm_periodic *orbit)
{
    const double *re = orbit->multipliers, *im = re + orbit->count;
    size_t ones = 0;
    for (size_t i = 0; i < orbit->count; i++) {
        const size_t order = nearer_than(orbit, i) + 1;
        const bool close = gm_hypot(re[i] - 1, im[i]) <= error_of_ones(orbit, order);
        ones = close && order > ones ? order : ones;
    }
    return ones;
}

double gm_multiplier_error(const struct gm_periodic *orbit, size_t i)
{
    const size_t ones = count_ones(orbit);
    return nearer_than(orbit, i) < ones ? error_of_ones(orbit, ones) : orbit->error;
}

const char *gm_periodic_kind(const struct gm_periodic *orbit)
{
    const double close = 10 * orbit->error;
    const double *re = orbit->multipliers, *im = re + orbit->count;
    double volume = 0, farthest = 0, real = 0;
    const size_t ones = count_ones(orbit);
    bool near = false;
    for (size_t i = 0; i < orbit->count; i++) {
        const size_t nearer = nearer_than(orbit, i);
        const double modulus = gm_hypot(re[i], im[i]);
        volume += gm_log(modulus);
        if (nearer < orbit->by_structure ||
            nearer < ones) { /* those nearest to 1 are those of the structure */
            near = near || nearer >= orbit->by_structure;
            continue;
        }
        if (modulus > farthest) {
            farthest = modulus;
            real = fabs(im[i]) <= close ? re[i] : 0;
        }
        near = near || (fabs(modulus - 1) <= close && fabs(im[i]) <= close);
    }
    const bool preserved = fabs(volume) <= close, outside = farthest > 1 + close;
    return orbit->count == 0                                           ? "none"
           : orbit->count <= orbit->by_structure || (near && !outside) ? "parabolic"
           : !preserved && !outside  ? farthest < 1 - close ? "stable" : "parabolic"
           : !outside                ? "elliptic"
           : !preserved || real == 0 ? "unstable"
           : real > 0                ? "hyperbolic"
                                     : "inverse hyperbolic";
}
