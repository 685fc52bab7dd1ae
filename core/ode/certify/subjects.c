/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The certification problems: non-linear, not chaotic over the times that are used, each with structure of
   its own. */
#include <math.h>

#include "core/basics.h"
#include "core/ode/certify/measure.h"
#include "core/ode/problems/problems.h"

static const double well = 0.3, no_well = 0, friction = 0.4, perturbation = 0.05, omega = 5, strength = 2;
static const double abc_constants[] = {1, 0.8, 0.6};
static const double trace_free[] = {0.4, 1.1, -0.3, -0.7, 0.5, 0.2, 0.9, -0.6, -0.9};

/* Quantities that a motion conserves, as sums of factor y_first y_second, or factor y_first alone; a factor 0 ends one. */
enum { ALONE = -1 };
struct term {
    double factor;
    int first, second;
};

static double sum_of_terms(const void *data, const double *y, const double *memory)
{
    (void)memory;
    double sum = 0;
    for (const struct term *term = data; term->factor != 0; term++) {
        sum += term->factor * y[term->first] * (term->second == ALONE ? 1 : y[term->second]);
    }
    return sum;
}

static const struct term momentum[] = {{1, 2, ALONE}, {1, 3, ALONE}, {0, 0, 0}};
static const struct term angular_momentum[] = {{1, 0, 3}, {-1, 1, 2}, {0, 0, 0}};
static const struct term vertical_momentum[] = {{1, 0, 4}, {-1, 1, 3}, {0, 0, 0}};
static const struct term circle[] = {{0.5, 0, 0}, {0.5, 1, 1}, {0, 0, 0}};
static const struct term sphere[] = {{0.5, 0, 0}, {0.5, 1, 1}, {0.5, 2, 2}, {0, 0, 0}};
static const struct term ellipsoid[] = {{0.25, 0, 0}, {0.5, 1, 1}, {0.75, 2, 2}, {0, 0, 0}};
static const struct term impulse_x[] = {
    {1, 0, ALONE}, {1, 1, ALONE}, {1, 2, ALONE}, {1, 3, ALONE}, {0, 0, 0}};
static const struct term impulse_y[] = {
    {1, 4, ALONE}, {1, 5, ALONE}, {1, 6, ALONE}, {1, 7, ALONE}, {0, 0, 0}};
static const struct term angular_impulse[] = {{1, 0, 0}, {1, 1, 1}, {1, 2, 2}, {1, 3, 3}, {1, 4, 4},
                                              {1, 5, 5}, {1, 6, 6}, {1, 7, 7}, {0, 0, 0}};
static const struct term ring_sum[] = {
    {1, 0, ALONE}, {1, 1, ALONE}, {1, 2, ALONE}, {1, 3, ALONE},  {1, 4, ALONE},  {1, 5, ALONE}, {1, 6, ALONE},
    {1, 7, ALONE}, {1, 8, ALONE}, {1, 9, ALONE}, {1, 10, ALONE}, {1, 11, ALONE}, {0, 0, 0}};
static const struct term ring_square[] = {{1, 0, 0},   {1, 1, 1},   {1, 2, 2}, {1, 3, 3}, {1, 4, 4},
                                          {1, 5, 5},   {1, 6, 6},   {1, 7, 7}, {1, 8, 8}, {1, 9, 9},
                                          {1, 10, 10}, {1, 11, 11}, {0, 0, 0}};

#define KEPT(terms)                                                                                          \
    {                                                                                                        \
        .value = sum_of_terms, .data = terms                                                                 \
    }

static const struct {
    const struct gm_problem *problem;
    const void *parameters;
    double dt;
    unsigned only; /* facets: not for schemes that need none of them; 0: for all */
    double start[12];
    struct gm_kept kept[GM_SUBJECT_INVARIANTS];
} subjects[] = {
    {&gm_problem_pendulum, NULL, 0.6, 0, {0.6, 1.1}, {{0}}},
    {&gm_problem_particles, &well, 0.6, 0, {0.5, -0.4, 0.3, 0.8}, {{0}}},
    {&gm_problem_particles, &no_well, 0.6, 0, {0.7, -0.2, 0.4, -0.9}, {KEPT(momentum)}},
    {&gm_problem_kepler, NULL, 0.3, 0, {0.8, 0.1, -0.2, 1.2}, {KEPT(angular_momentum)}},
    /* not of the form q' A p, as angular momentum is, which more schemes conserve */
    {&gm_problem_oscillator, NULL, 0.1, GM_NEEDS_SPLIT | GM_NEEDS_HAMILTONIAN, {0.8, -0.5}, {KEPT(circle)}},
    {&gm_problem_damped_pendulum, &friction, 0.6, GM_NEEDS_FRICTION, {0.6, 1.1}, {{0}}},
    {&gm_problem_spherical_pendulum,
     NULL,
     0.3,
     GM_NEEDS_CONSTRAINTS,
     {0.6, 0, -0.8, 0.4, 0.7, 0.3},
     {KEPT(vertical_momentum)}},
    {&gm_problem_henon_heiles, NULL, 0.6, 0, {0.1, -0.1, 0.3, 0.2}, {{0}}},
    {&gm_problem_product, NULL, 0.3, 0, {0.5, -0.6}, {{0}}},
    {&gm_problem_fish_eye, NULL, 0.3, GM_NEEDS_INSEPARABLE, {0.8, 0.1, -0.2, 0.7}, {KEPT(angular_momentum)}},
    {&gm_problem_vortices_four,
     &strength,
     0.6,
     0,
     {1, -0.6, -1.1, 0.5, 0.1, 0.8, -0.2, -0.9},
     {KEPT(impulse_x), KEPT(impulse_y), KEPT(angular_impulse)}},
    {&gm_problem_rigid_body, NULL, 0.6, 0, {0.9, 0.5, -0.7}, {KEPT(sphere), KEPT(ellipsoid)}},
    {&gm_problem_abc, abc_constants, 0.6, 0, {0.5, 1.1, -0.4}, {{0}}},
    {&gm_problem_linear, trace_free, 0.6, GM_NEEDS_VOLUME, {0.5, 1.1, -0.4}, {{0}}},
    {&gm_problem_kepler_perturbed,
     &perturbation,
     0.3,
     GM_NEEDS_KEPLER_SPLIT | GM_NEEDS_ATTRACTION,
     {0.8, 0.1, -0.2, 1.2},
     {KEPT(angular_momentum)}},
    {&gm_problem_ring,
     NULL,
     0.3,
     GM_NEEDS_SEMILINEAR,
     {0.4, 0.9, 1.3, 0.7, -0.2, -0.5, 0.1, 0.3, -0.4, 0.6, 0.2, 0.5},
     {KEPT(ring_sum), KEPT(ring_square)}},
    {&gm_problem_fpu,
     &omega,
     0.3,
     GM_NEEDS_FAST_LINEAR,
     {0.4, 0.1, -0.2, 0.02, 0.03, -0.02, 0.5, -0.3, 0.2, 0.3, 0.1, -0.2},
     {{0}}},
    /* (h Omega)^2 = 0.09, with which two copies of phase space bear the binding that they are given here */
    {&gm_problem_fpu,
     &omega,
     0.06,
     GM_NEEDS_HAMILTONIAN,
     {0.4, 0.1, -0.2, 0.02, 0.03, -0.02, 0.5, -0.3, 0.2, 0.3, 0.1, -0.2},
     {{0}}},
};

size_t gm_subject_count(void)
{
    return GM_COUNT(subjects);
}

struct gm_subject gm_subject_at(size_t index)
{
    struct gm_subject subject = {.problem = *subjects[index].problem,
                                 .start = subjects[index].start,
                                 .dt = subjects[index].dt,
                                 .unit = 1,
                                 .scale = 1,
                                 .only = subjects[index].only,
                                 .kept = subjects[index].kept};
    subject.problem.parameters = subjects[index].parameters;
    while (subject.kept_count < GM_SUBJECT_INVARIANTS && subject.kept[subject.kept_count].value) {
        subject.kept_count++;
    }
    return subject;
}

bool gm_subject_fits(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    const bool meant = subject->only == 0 || (scheme->needs & subject->only) != 0;
    return meant && gm_scheme_fits(scheme, &subject->problem);
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

double gm_subject_friction(const struct gm_subject *subject)
{
    const struct gm_action *action = gm_ode_of(&subject->problem)->action;
    return action && action->friction ? action->friction(&subject->problem) : 0;
}

struct gm_settings gm_subject_settings(double dt)
{
    return (struct gm_settings){.compensated = 1, .binding = 5, .tau0 = fabs(dt), .newmark_beta = 0.15};
}

bool gm_subject_advance(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                        int64_t steps, const double *whole, double *end)
{
    const struct gm_settings settings = gm_subject_settings(dt);
    return gm_trial_advance(&(const struct gm_trial){&subject->problem, scheme, &settings, dt, steps}, whole,
                            end);
}

bool gm_subject_turn(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                     int64_t steps, bool reflected, double push, double *end)
{
    const struct gm_settings settings = gm_subject_settings(dt);
    double start[2 * GM_SUBJECT_COMPONENTS];
    gm_subject_start(subject, scheme, start);
    return gm_trial_turn(&(const struct gm_trial){&subject->problem, scheme, &settings, dt, steps}, start,
                         reflected, push, end);
}
