/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The certification problems: non-linear, not chaotic over the times that are used, each with structure of
   its own. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/files/files.h"
#include "core/model/equations.h"
#include "core/ode/certify/measure.h"
#include "core/ode/families/composition.h"
#include "core/ode/problems/problems.h"
#include "core/ode/user/problem.h"

static const double strength = 2;

/* Quantities that a motion conserves, as sums of factor y_first y_second, or factor y_first alone, for `count` of each,
   one after the other; of at most TERMS terms. */
enum { ALONE = -1, TERMS = 3 };
struct term {
    double factor;
    int first, second, count;
};

static double sum_of_terms(const void *data, const double *y, const double *memory)
{
    (void)memory;
    double sum = 0;
    for (const struct term *term = data, *end = term + TERMS; term < end; term++) {
        for (int k = 0; k < term->count; k++) {
            sum += term->factor * y[term->first + k] * (term->second == ALONE ? 1 : y[term->second + k]);
        }
    }
    return sum;
}

static const struct term momentum[TERMS] = {{1, 2, ALONE, 2}};
static const struct term angular_momentum[TERMS] = {{1, 0, 3, 1}, {-1, 1, 2, 1}};
static const struct term vertical_momentum[TERMS] = {{1, 0, 4, 1}, {-1, 1, 3, 1}};
static const struct term circle[TERMS] = {{0.5, 0, 0, 2}};
static const struct term sphere[TERMS] = {{0.5, 0, 0, 3}};
static const struct term ellipsoid[TERMS] = {{0.25, 0, 0, 1}, {0.5, 1, 1, 1}, {0.75, 2, 2, 1}};
static const struct term impulse_x[TERMS] = {{1, 0, ALONE, 4}};
static const struct term impulse_y[TERMS] = {{1, 4, ALONE, 4}};
static const struct term angular_impulse[TERMS] = {{1, 0, 0, 8}};
static const struct term ring_sum[TERMS] = {{1, 0, ALONE, 12}};
static const struct term ring_square[TERMS] = {{1, 0, 0, 12}};

#define FPU_START                                                                                            \
    {                                                                                                        \
        0.4, 0.1, -0.2, 0.02, 0.03, -0.02, 0.5, -0.3, 0.2, 0.3, 0.1, -0.2                                    \
    }
#define KEPT(terms)                                                                                          \
    {                                                                                                        \
        .value = sum_of_terms, .data = terms                                                                 \
    }

/* A subject: a problem in C with these parameters, or a built-in file: one of share/subjects, or a system. */
static const struct row {
    const struct gm_problem *problem;
    const void *parameters;
    const char *file;
    struct gm_system_value value; /* a parameter's value that replaces the file's */
    double dt;
    unsigned only; /* facets of which a scheme must need one; 0: any scheme */
    double start[12];
    struct gm_kept kept[GM_SUBJECT_INVARIANTS];
    const char *name; /* the subject's name, if not the file's */
} rows[] = {
    {.file = "pendulum", .dt = 0.6, .start = {0.6, 1.1}},
    {.file = "particles", .dt = 0.6, .start = {0.5, -0.4, 0.3, 0.8}},
    {.file = "particles",
     .value = {"a", "0"},
     .dt = 0.6,
     .start = {0.7, -0.2, 0.4, -0.9},
     .kept = {KEPT(momentum)}},
    {.file = "kepler", .dt = 0.3, .start = {0.8, 0.1, -0.2, 1.2}, .kept = {KEPT(angular_momentum)}},
    /* not of the form q' A p, as angular momentum is, which more schemes conserve */
    {.file = "oscillator",
     .dt = 0.1,
     .only = GM_NEEDS_SPLIT | GM_NEEDS_HAMILTONIAN,
     .start = {0.8, -0.5},
     .kept = {KEPT(circle)}},
    {.file = "damped-pendulum",
     .dt = 0.6,
     .only = GM_NEEDS_FRICTION,
     .start = {0.6, 1.1},
     .name = "damped pendulum"},
    {.file = "bowl",
     .dt = 0.3,
     .only = GM_NEEDS_CONSTRAINTS,
     .start = {1, 0, 0.25, 0.4, 0.7, 0.4},
     .kept = {KEPT(vertical_momentum)}},
    {.file = "henon-heiles", .dt = 0.6, .start = {0.1, -0.1, 0.3, 0.2}},
    {.file = "product", .dt = 0.3, .start = {0.5, -0.6}},
    {.file = "fish-eye",
     .dt = 0.3,
     .only = GM_NEEDS_INSEPARABLE,
     .start = {0.8, 0.1, -0.2, 0.7},
     .kept = {KEPT(angular_momentum)}},
    {&gm_problem_vortices_four, &strength, .dt = 0.6, .start = {1, -0.6, -1.1, 0.5, 0.1, 0.8, -0.2, -0.9},
     .kept = {KEPT(impulse_x), KEPT(impulse_y), KEPT(angular_impulse)}},
    {.file = "rigid-body", .dt = 0.6, .start = {0.9, 0.5, -0.7}, .kept = {KEPT(sphere), KEPT(ellipsoid)}},
    {.file = "abc", .dt = 0.6, .start = {0.5, 1.1, -0.4}},
    {.file = "linear", .dt = 0.6, .only = GM_NEEDS_VOLUME, .start = {0.5, 1.1, -0.4}},
    {.file = "kepler",
     .value = {"perturbation", "0.05"},
     .dt = 0.3,
     .only = GM_NEEDS_KEPLER_SPLIT | GM_NEEDS_KEPLER | GM_NEEDS_ATTRACTION | GM_NEEDS_PARTS,
     .start = {0.8, 0.1, -0.2, 1.2},
     .kept = {KEPT(angular_momentum)},
     .name = "kepler-perturbed"},
    {&gm_problem_ring, .dt = 0.3, .only = GM_NEEDS_SEMILINEAR,
     .start = {0.4, 0.9, 1.3, 0.7, -0.2, -0.5, 0.1, 0.3, -0.4, 0.6, 0.2, 0.5},
     .kept = {KEPT(ring_sum), KEPT(ring_square)}},
    {.file = "charged-particle", .dt = 0.3, .only = GM_NEEDS_MAGNETIC, .start = {0.3, -1, 0.5, 0.2}},
    {.file = "lotka-volterra-L", .dt = 0.3, .only = GM_NEEDS_DEGENERATE, .start = {1.2, 1.7}},
    {.file = "fpu", .dt = 0.3, .only = GM_NEEDS_FAST_LINEAR, .start = FPU_START},
    /* (h Omega)^2 = 0.09, at which two copies of phase space are stable with the binding given here */
    {.file = "fpu", .dt = 0.06, .only = GM_NEEDS_HAMILTONIAN, .start = FPU_START},
};

size_t gm_subject_count(void)
{
    return GM_COUNT(rows);
}

/* The problem of a row that is read; false: out of memory. */
static bool read_problem(struct gm_subject *subject, const struct row *row)
{
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SUBJECT, row->file);
    file = file ? file : gm_built_in_find(GM_FILE_SYSTEM, row->file);
    struct gm_fault fault;
    double *values = NULL;
    const bool derived = gm_equations_open(&subject->system, file->text, file->length, &row->value,
                                           row->value.name != NULL, &fault) &&
                         gm_user_model_open(&subject->model, &subject->system) &&
                         (values = gm_equations_start(&subject->system, NULL)) != NULL;
    if (derived) {
        memcpy(values, row->start, subject->system.n * sizeof *values);
    }
    const bool opened = derived && gm_user_problem_open(&subject->problem, &subject->model, values);
    subject->problem.name = row->name ? row->name : row->file;
    free(values);
    return opened;
}

bool gm_subject_open(struct gm_subject *subject, size_t index, const struct gm_scheme *scheme)
{
    const struct row *row = &rows[index];
    *subject = (struct gm_subject){
        .scheme = scheme, .start = row->start, .dt = row->dt, .unit = 1, .scale = 1, .kept = row->kept};
    while (subject->kept_count < GM_SUBJECT_INVARIANTS && row->kept[subject->kept_count].value) {
        subject->kept_count++;
    }
    if (row->only != 0 && (scheme->needs & row->only) == 0) {
        return false;
    }
    if (row->problem) {
        subject->problem = *row->problem;
        subject->problem.parameters = row->parameters;
    } else if (!read_problem(subject, row)) {
        return false;
    }
    const struct gm_ode *ode = gm_ode_of(&subject->problem);
    subject->volume = !ode->hamiltonian && !ode->poisson;
    if (!gm_scheme_fits(scheme, &subject->problem) ||
        (!subject->volume && (scheme->needs & GM_NEEDS_VOLUME) != 0)) {
        return false;
    }
    if (!row->problem) {
        gm_user_problem_take_compiled(&subject->problem, gm_scheme_over_kernels(scheme));
    }
    return true;
}

void gm_subject_close(struct gm_subject *subject)
{
    if (subject->model.system) {
        gm_user_problem_close(&subject->problem);
    }
    gm_system_close(&subject->system);
}

size_t gm_subject_components(const struct gm_subject *subject)
{
    return (subject->scheme->family->doubled ? 2 : 1) * subject->problem.n;
}

void gm_subject_start(const struct gm_subject *subject, double *whole)
{
    const size_t n = subject->problem.n;
    for (size_t c = 0; c < gm_subject_components(subject); c++) {
        whole[c] = subject->start[c % n] + (c < n ? 0 : 0.01); /* the copies need not agree */
    }
}

double gm_subject_friction(const struct gm_subject *subject)
{
    const struct gm_action *action = gm_ode_of(&subject->problem)->action;
    return action && action->friction ? *action->friction : 0;
}

struct gm_settings gm_subject_settings(double dt)
{
    return (struct gm_settings){.compensated = 1, .binding = 5, .tau0 = fabs(dt), .newmark_beta = 0.15};
}

bool gm_subject_advance(const struct gm_subject *subject, double dt, int64_t steps, const double *whole,
                        double *end)
{
    const struct gm_settings settings = gm_subject_settings(dt);
    return gm_trial_advance(
        &(const struct gm_trial){&subject->problem, subject->scheme, &settings, dt, steps}, whole, end);
}

bool gm_subject_turn(const struct gm_subject *subject, double dt, int64_t steps, bool reflected, double push,
                     double *end)
{
    const struct gm_settings settings = gm_subject_settings(dt);
    double start[2 * GM_SUBJECT_COMPONENTS];
    gm_subject_start(subject, start);
    return gm_trial_turn(&(const struct gm_trial){&subject->problem, subject->scheme, &settings, dt, steps},
                         start, reflected, push, end);
}
