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
#include "core/ode/problems/problems.h"
#include "core/ode/user/problem.h"
#include "core/run.h"

static const double omega = 5, strength = 2;
static const double abc_constants[] = {1, 0.8, 0.6};
static const double trace_free[] = {0.4, 1.1, -0.3, -0.7, 0.5, 0.2, 0.9, -0.6, -0.9};

/* On a line, coupled by a hard spring, in a well unless a = 0. Masses that differ catch a scheme that takes p for the
   velocity; steps shorten with the distance. */
#define PARTICLES                                                                                            \
    "coordinates: q1 q2\nmomenta: p1 p2\nparameter: a = 0.3\nlet: d = q1 - q2\n"                             \
    "H: p1^2/2 + p2^2/6 + d*d/2 + d*d*d*d/4 + a*(q1*q1*q1*q1 + q2*q2*q2*q2)/4\n"                             \
    "monitor: 1 + d^2\nstart: q1 = 1, q2 = 0, p1 = 0, p2 = 0\n"
/* Rays of light where the index of refraction is 2/(1 + |q|^2), which are circles. M. Born & E. Wolf, Principles of
   Optics, 4.2.2. */
#define FISH_EYE                                                                                             \
    "coordinates: q1 q2\nmomenta: p1 p2\nlet: n = 1 + (q1^2 + q2^2)\nH: n^2*(p1^2 + p2^2)/8\n"               \
    "start: q1 = 1, q2 = 0, p1 = 0, p2 = 1\n"

static double momentum(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[2] + y[3];
}

static double sphere(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]) / 2;
}

static double ellipsoid(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[0] * y[0] / 4 + y[1] * y[1] / 2 + 3 * y[2] * y[2] / 4;
}

static double angular_momentum(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[0] * y[3] - y[1] * y[2];
}

static double vertical_momentum(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[0] * y[4] - y[1] * y[3];
}

static double impulse_x(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[0] + y[1] + y[2] + y[3];
}

static double impulse_y(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[4] + y[5] + y[6] + y[7];
}

static double angular_impulse(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    double sum = 0;
    for (int i = 0; i < 8; i++) {
        sum += y[i] * y[i];
    }
    return sum;
}

static double ring_sum(const struct gm_problem *problem, const double *y)
{
    double sum = 0;
    for (size_t i = 0; i < problem->n; i++) {
        sum += y[i];
    }
    return sum;
}

static double ring_square(const struct gm_problem *problem, const double *y)
{
    double sum = 0;
    for (size_t i = 0; i < problem->n; i++) {
        sum += y[i] * y[i];
    }
    return sum;
}

/* of the oscillator: not of the form q' A p, as angular momentum is, which more schemes keep */
static double circle(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return (y[0] * y[0] + y[1] * y[1]) / 2;
}

/* The problem is one in C with these parameters, or that of a system: a built-in file of this name or a text. */
static const struct row {
    const struct gm_problem *problem;
    const void *parameters;
    const char *name, *system;
    struct gm_system_value
        value; /* of one of the system's parameters, where it is another one than in the text */
    struct gm_subject subject;
} rows[] = {
    {&gm_problem_pendulum, .subject = {.start = {0.6, 1.1}, .dt = 0.6, .hamiltonian = true}},
    {.name = "particles",
     .system = PARTICLES,
     .subject = {.start = {0.5, -0.4, 0.3, 0.8}, .dt = 0.6, .hamiltonian = true}},
    {.name = "particles",
     .system = PARTICLES,
     .value = {"a", "0"},
     .subject = {.start = {0.7, -0.2, 0.4, -0.9},
                 .dt = 0.6,
                 .hamiltonian = true,
                 .linear = {momentum},
                 .momentum = {momentum}}},
    {.name = "kepler",
     .system = "kepler",
     .subject = {.start = {0.8, 0.1, -0.2, 1.2},
                 .dt = 0.3,
                 .hamiltonian = true,
                 .quadratic = {angular_momentum},
                 .bilinear = {angular_momentum},
                 .momentum = {angular_momentum}}},
    {&gm_problem_oscillator, .subject = {.start = {0.8, -0.5},
                                         .dt = 0.1,
                                         .only = GM_NEEDS_SPLIT | GM_NEEDS_HAMILTONIAN,
                                         .quadratic = {circle}}},
    {.name = "damped pendulum",
     .system = "coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nforce: q = -0.4*p\nstart: q = 0, p = 0\n",
     .subject = {.start = {0.6, 1.1}, .dt = 0.6, .only = GM_NEEDS_FRICTION, .friction = 0.4}},
    {&gm_problem_spherical_pendulum, .subject = {.start = {0.6, 0, -0.8, 0.4, 0.7, 0.3},
                                                 .dt = 0.3,
                                                 .only = GM_NEEDS_CONSTRAINTS,
                                                 .hamiltonian = true,
                                                 .momentum = {vertical_momentum}}},
    {.name = "henon-heiles",
     .system = "henon-heiles",
     .subject = {.start = {0.1, -0.1, 0.3, 0.2}, .dt = 0.6, .hamiltonian = true}},
    {.name = "product", /* not separable: M. Tao, Phys. Rev. E 94 (2016) 043303 */
     .system = "coordinates: q\nmomenta: p\nH: (1 + q^2)*(1 + p^2)/2\nstart: q = 1, p = 0\n",
     .subject = {.start = {0.5, -0.6}, .dt = 0.3, .hamiltonian = true}},
    {.name = "fish-eye",
     .system = FISH_EYE,
     .subject = {.start = {0.8, 0.1, -0.2, 0.7},
                 .dt = 0.3,
                 .only = GM_NEEDS_INSEPARABLE,
                 .hamiltonian = true,
                 .bilinear = {angular_momentum},
                 .momentum = {angular_momentum}}},
    {&gm_problem_vortices_four, &strength,
     .subject = {.start = {1, -0.6, -1.1, 0.5, 0.1, 0.8, -0.2, -0.9},
                 .dt = 0.6,
                 .hamiltonian = true,
                 .linear = {impulse_x, impulse_y},
                 .quadratic = {angular_impulse}}},
    {.name = "rigid-body",
     .system = "rigid-body",
     .subject =
         {.start = {0.9, 0.5, -0.7}, .dt = 0.6, .quadratic = {sphere, ellipsoid}, .casimir = {sphere}}},
    {&gm_problem_abc, abc_constants, .subject = {.start = {0.5, 1.1, -0.4}, .dt = 0.6, .volume = true}},
    {&gm_problem_linear, trace_free,
     .subject = {.start = {0.5, 1.1, -0.4}, .dt = 0.6, .only = GM_NEEDS_VOLUME, .volume = true}},
    {.name = "kepler-perturbed",
     .system = "kepler",
     .value = {"perturbation", "0.05"},
     .subject = {.start = {0.8, 0.1, -0.2, 1.2},
                 .dt = 0.3,
                 .only = GM_NEEDS_KEPLER_SPLIT | GM_NEEDS_ATTRACTION,
                 .hamiltonian = true,
                 .quadratic = {angular_momentum},
                 .bilinear = {angular_momentum}}},
    {&gm_problem_ring, .subject = {.start = {0.4, 0.9, 1.3, 0.7, -0.2, -0.5, 0.1, 0.3, -0.4, 0.6, 0.2, 0.5},
                                   .dt = 0.3,
                                   .only = GM_NEEDS_SEMILINEAR,
                                   .linear = {ring_sum},
                                   .quadratic = {ring_square}}},
    {&gm_problem_fpu, &omega,
     .subject = {.start = {0.4, 0.1, -0.2, 0.02, 0.03, -0.02, 0.5, -0.3, 0.2, 0.3, 0.1, -0.2},
                 .dt = 0.3,
                 .only = GM_NEEDS_FAST_LINEAR,
                 .hamiltonian = true}},
    /* (h Omega)^2 = 0.09, with which two copies of phase space bear the binding that they are given here */
    {&gm_problem_fpu, &omega,
     .subject = {.start = {0.4, 0.1, -0.2, 0.02, 0.03, -0.02, 0.5, -0.3, 0.2, 0.3, 0.1, -0.2},
                 .dt = 0.06,
                 .only = GM_NEEDS_HAMILTONIAN,
                 .hamiltonian = true}},
};

size_t gm_subject_count(void)
{
    return GM_COUNT(rows);
}

bool gm_subject_open(struct gm_subject *subject, size_t index)
{
    const struct row *row = &rows[index];
    *subject = row->subject;
    if (row->problem) {
        subject->problem = *row->problem;
        subject->problem.parameters = row->parameters;
        return true;
    }
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SYSTEM, row->system);
    const char *text = file ? file->text : row->system;
    struct gm_fault fault;
    double *values = NULL;
    const bool good = gm_equations_open(&subject->system, text, strlen(text), &row->value,
                                        row->value.name != NULL, &fault) &&
                      gm_user_model_open(&subject->model, &subject->system) &&
                      (values = gm_equations_start(&subject->system, NULL)) != NULL;
    if (good) {
        memcpy(values, subject->start, subject->system.n * sizeof *values);
    }
    const bool opened = good && gm_user_problem_open(&subject->problem, &subject->model, values);
    subject->problem.name = row->name;
    free(values);
    return opened;
}

void gm_subject_close(struct gm_subject *subject)
{
    if (subject->model.system) {
        gm_user_problem_close(&subject->problem);
    }
    gm_user_model_close(&subject->model);
    gm_system_close(&subject->system);
}

bool gm_subject_fits(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    const bool meant = subject->only == 0 || (scheme->needs & subject->only) != 0,
               flows = (scheme->needs & GM_NEEDS_VOLUME) == 0 || subject->volume;
    return meant && flows && gm_scheme_fits(scheme, &subject->problem);
}

size_t gm_subject_components(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    return (scheme->family->doubled ? 2 : 1) * subject->problem.n;
}

void gm_subject_start(const struct gm_subject *subject, const struct gm_scheme *scheme, double *whole)
{
    const size_t n = subject->problem.n;
    for (size_t c = 0; c < gm_subject_components(subject, scheme); c++) {
        whole[c] = subject->start[c % n] + (c < n ? 0 : 0.01); /* the copies need not agree */
    }
}

/* The map of both copies of phase space, which no run shows: the memory is given and taken. */
static bool advance_doubled(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const struct gm_settings *settings, double dt, int64_t steps, const double *whole,
                            double *end)
{
    const size_t count = problem->n * problem->m;
    void *workspace = scheme->family->workspace_open(problem, scheme);
    if (!workspace) {
        return false;
    }
    const struct gm_task task = {
        .problem = problem,
        .scheme = scheme,
        .dt = dt,
        .steps = steps,
        .limit = 1e10,
        .y = whole,
        .out = end,
        .memory = whole + count,
        .memory_out = end + count,
        .workspace = workspace,
        .settings = settings,
    };
    const struct gm_progress progress = scheme->family->loop(&task);
    scheme->family->workspace_close(workspace);
    return progress.done == steps;
}

/* for the schemes that choose their step tau0 is what dt is for the others */
static struct gm_settings settings_for(double dt)
{
    return (struct gm_settings){.compensated = 1, .binding = 5, .tau0 = fabs(dt), .newmark_beta = 0.15};
}

bool gm_subject_advance(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                        int64_t steps, size_t m, const double *whole, double *end)
{
    const struct gm_settings settings = settings_for(dt);
    struct gm_problem problem = subject->problem;
    problem.m = m;
    if (scheme->family->doubled) {
        return advance_doubled(&problem, scheme, &settings, dt, steps, whole, end);
    }
    struct gm_run *run = gm_run_open(&problem, scheme, &settings, 0, dt, whole);
    if (!run) {
        return false;
    }
    const bool good = gm_run_advance(run, steps) == GM_OK;
    memcpy(end, gm_run_state(run), problem.n * m * sizeof *end);
    gm_run_close(run);
    return good;
}

/* p := -p in every copy of phase space */
static void reflect(const struct gm_subject *subject, const struct gm_scheme *scheme, double *whole)
{
    const size_t n = subject->problem.n;
    for (size_t c = 0; c < gm_subject_components(subject, scheme); c++) {
        whole[c] = c % n >= n / 2 ? -whole[c] : whole[c];
    }
}

/* Two copies of phase space remember nothing else. */
static bool turn_doubled(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                         int64_t steps, bool reflected, double push, double *end)
{
    double start[2 * GM_SUBJECT_COMPONENTS], there[2 * GM_SUBJECT_COMPONENTS];
    gm_subject_start(subject, scheme, start);
    if (!gm_subject_advance(subject, scheme, dt, steps, 1, start, there)) {
        return false;
    }
    if (reflected) {
        reflect(subject, scheme, there);
    }
    there[0] += push;
    const bool good = gm_subject_advance(subject, scheme, reflected ? dt : -dt, steps, 1, there, end);
    if (reflected) {
        reflect(subject, scheme, end);
    }
    return good;
}

bool gm_subject_turn(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                     int64_t steps, bool reflected, double push, double *end)
{
    if (scheme->family->doubled) {
        return turn_doubled(subject, scheme, dt, steps, reflected, push, end);
    }
    const struct gm_settings settings = settings_for(dt);
    struct gm_run *run = gm_run_open(&subject->problem, scheme, &settings, 0, dt, subject->start);
    const size_t bytes = subject->problem.n * sizeof *end;
    bool good = run && gm_run_advance(run, steps) == GM_OK;
    if (good && (reflected || push != 0)) {
        memcpy(end, gm_run_state(run), bytes);
        if (reflected) {
            reflect(subject, scheme, end);
        }
        end[0] += push;
        gm_run_set_state(run, end, NULL);
    }
    if (good && !reflected) {
        gm_run_set_step(run, -dt);
    }
    good = good && gm_run_advance(run, steps) == GM_OK;
    if (good) {
        memcpy(end, gm_run_state(run), bytes);
        if (reflected) {
            reflect(subject, scheme, end);
        }
    }
    gm_run_close(run);
    return good;
}
