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
static const double settled = 1e-11, resolved = 1e-6, stalled = 1e-9, smallest_factor = 0x1p-12;

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
    bool across;  /* corrections are normal to f */
    double guess; /* of the period */
};

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
    bool good = run->status == GM_OK;
    if (with_frame) {
        struct gm_tangent *tangent = gm_tangent_open(run);
        gm_arena_keep(search->arena, tangent, gm_tangent_close);
        search->stride = gm_tangent_size(tangent);
        memset(search->frame, 0, search->n * search->stride * sizeof *search->frame);
        for (size_t k = 0; k < search->n; k++) {
            search->frame[k * search->stride + k] = 1;
            good = good && gm_tangent_begin(tangent, search->frame + k * search->stride);
        }
        for (int64_t i = 0; i < orbit->steps && good; i++) {
            good = gm_tangent_step(tangent, search->frame, search->n);
        }
    } else {
        good = good && gm_run_advance(run, orbit->steps) == GM_OK;
    }
    double square = 0;
    memcpy(search->end, gm_run_state(run), orbit->problem->n * sizeof(double));
    for (size_t c = 0; c < search->n; c++) {
        square += (search->end[c] - y[c]) * (search->end[c] - y[c]);
    }
    gm_arena_release(search->arena, mark);
    return good && isfinite(square) ? sqrt(square) : INFINITY;
}

/* Returns the size that errors are compared with, 1 + the largest component. */
static double scale_of(const struct search *search)
{
    double largest = 0;
    for (size_t c = 0; c < search->n; c++) {
        largest = fmax(largest, fabs(search->orbit->start[c]));
    }
    return 1 + largest;
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
        search->change[i] = orbit->start[i] - search->end[i];
    }
    if (search->across) {
        gm_field(orbit->problem, orbit->start, search->slope, 1);
        leave_out(search->matrix, search->slope, n);
    }
    if (orbit->free) {
        gm_field(orbit->problem, search->end, search->slope, 1);
        for (size_t i = 0; i < n; i++) {
            search->matrix[i * size + n] = search->slope[i];
        }
        gm_field(orbit->problem, orbit->start, search->slope, 1);
        for (size_t k = 0; k < n; k++) {
            search->matrix[n * size + k] = orbit->held == SIZE_MAX ? search->slope[k] : k == orbit->held;
        }
        search->matrix[n * size + n] = search->change[n] = 0;
    }
    return gm_singular_solve(search->matrix, size, 1e-9, search->change);
}

/* Makes the change, halved until the residual falls below `residual`, which is that of the start. Returns false, and
   leaves the orbit as it is, if it does not fall. */
static bool correct(struct search *search, double residual)
{
    struct gm_periodic *orbit = search->orbit;
    /* next to the solution only round-off is left, which no shorter change reduces */
    const double least = residual <= stalled * scale_of(search) ? 1 : smallest_factor;
    memcpy(search->trial, orbit->start, orbit->problem->n * sizeof(double));
    for (double factor = 1; factor >= least; factor /= 2) {
        const double period = orbit->period + (orbit->free ? factor * search->change[search->n] : 0);
        for (size_t c = 0; c < search->n; c++) {
            search->trial[c] = orbit->start[c] + factor * search->change[c];
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
    return GM_EPSILON * sqrt(square) * scale_of(search);
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
        if (corrected) {
            orbit->iterations++;
            orbit->residual = follow(search, orbit->start, orbit->period, true);
        }
    }
}

/* Halves the steps until the end changes by less than 1e-11, or only by round-off, which steps do not reduce. Returns
   true if they were halved. */
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
        done = apart < settled * scale_of(search) ||
               (before < resolved * scale_of(search) && apart > before / 8);
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
            along += search->slope[c] * (orbit->start[c] - search->end[c]);
            square += search->slope[c] * search->slope[c];
        }
        const double period = orbit->period + along / square;
        before = residual;
        residual = period > 0 ? follow(search, orbit->start, period, false) : INFINITY;
        orbit->period = residual < before ? period : orbit->period;
    }
    orbit->period = fmin(residual, before) <= resolved * scale_of(search) ? orbit->period : search->guess;
}

/* An orbit that closes several times in its period has a shorter one: a start far away may return only after some
   turns. */
static void shorten(struct search *search)
{
    enum { MOST_TURNS = 8 };
    struct gm_periodic *orbit = search->orbit;
    for (int turns = MOST_TURNS; turns > 1; turns--) {
        const double period = orbit->period / turns;
        if (follow(search, orbit->start, period, false) <= stalled * scale_of(search)) {
            orbit->period = search->guess = period;
            iterate(search);
            return;
        }
    }
}

/* Writes the multipliers of an orbit that was found, in descending order of their moduli. */
static void find_multipliers(struct search *search)
{
    struct gm_periodic *orbit = search->orbit;
    const size_t n = search->n;
    double *re = orbit->multipliers, *im = re + n;
    for (size_t i = 0; i < n * n; i++) {
        search->matrix[i] = search->frame[i % n * search->stride + i / n];
    }
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
    search.frame = gm_arena_take(arena, all * (all + memory), sizeof(double));
    search.matrix = gm_arena_take(arena, (all + 1) * (all + 1), sizeof(double));
    orbit->iterations = 0;
    search.guess = orbit->period;
    if (orbit->refined) {
        orbit->steps = LEAST_STEPS;
        refine(&search);
    }
    if (orbit->free) {
        adjust_period(&search);
    }
    do {
        iterate(&search);
    } while (orbit->refined && orbit->residual <= stalled * scale_of(&search) && refine(&search));
    /* next to an equilibrium of weak decay the residual is small, but not against the motion */
    const double least = fmax(1e-10, 1e6 * orbit->residual / orbit->period);
    double fastest = 0;
    gm_field(orbit->problem, orbit->start, search.slope, 1);
    for (size_t c = 0; c < search.n; c++) {
        fastest = fmax(fastest, fabs(search.slope[c]));
    }
    orbit->status = !(orbit->residual <= stalled * scale_of(&search)) ? GM_PERIODIC_NO_CONVERGENCE
                    : orbit->free && fastest < least                  ? GM_PERIODIC_EQUILIBRIUM
                                                                      : GM_PERIODIC_FOUND;
    if (orbit->free && orbit->status == GM_PERIODIC_FOUND) {
        shorten(&search);
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
};

static void return_once(struct gm_arena *arena, void *data)
{
    struct returning *returning = data;
    struct gm_periodic *orbit = returning->orbit;
    const size_t n = orbit->problem->n;
    double *normal = gm_arena_take(arena, n, sizeof *normal), before = 0, farthest = 0;
    struct gm_run *run = open_run(orbit, arena, orbit->start, returning->dt);
    gm_field(orbit->problem, orbit->start, normal, 1);
    for (int64_t i = 1; i <= returning->steps && gm_run_advance(run, 1) == GM_OK; i++) {
        double beyond = 0, square = 0;
        for (size_t c = 0; c < n; c++) {
            const double away = gm_run_state(run)[c] - orbit->start[c];
            beyond += normal[c] * away;
            square += away * away;
        }
        farthest = fmax(farthest, square);
        if (before < 0 && beyond >= 0 && square < farthest / 4) {
            returning->time = returning->dt * ((double)i - beyond / (beyond - before));
            return;
        }
        before = beyond;
    }
    if (run->status == GM_OK) {
        memcpy(orbit->start, gm_run_state(run), n * sizeof *normal);
    }
}

double gm_first_return(struct gm_periodic *orbit, double dt, int64_t steps)
{
    struct returning returning = {orbit, dt, NAN, steps};
    gm_arena_run_once(return_once, &returning);
    return returning.time;
}

const char *gm_periodic_kind(const struct gm_periodic *orbit)
{
    const double close = 1e-5;
    const double *re = orbit->multipliers, *im = re + orbit->count;
    double volume = 0, farthest = 0, real = 0;
    bool near = false;
    for (size_t i = 0; i < orbit->count; i++) {
        size_t nearer = 0;
        for (size_t k = 0; k < orbit->count; k++) { /* those nearest to 1 are those of the structure */
            const double one = gm_hypot(re[k] - 1, im[k]), own = gm_hypot(re[i] - 1, im[i]);
            nearer += one < own || (one == own && k < i);
        }
        const double modulus = gm_hypot(re[i], im[i]);
        volume += gm_log(modulus);
        if (nearer < orbit->by_structure) {
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
