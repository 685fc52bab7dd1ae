/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of fields in one space dimension as the hall sees it: its facets, the families of schemes that
   need them, and how those are certified. */
#include "core/field/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/certify.h"
#include "core/field/certify/quantities.h"
#include "core/field/certify/runs.h"
#include "core/field/families/burgers.h"
#include "core/field/families/families.h"
#include "core/field/families/heat.h"
#include "core/field/families/kdv_moving_frames.h"
#include "core/field/families/laws/form.h"
#include "core/field/families/laws/wave.h"
#include "core/field/problems/dirac.h"
#include "core/field/problems/dispersive.h"
#include "core/field/problems/sine_gordon.h"
#include "core/field/problems/wave.h"
#include "core/run.h"

static unsigned facets(const struct gm_problem *problem)
{
    const struct gm_field *field = gm_field_of(problem);
    const unsigned form = !field->form ? 0 : field->form->hessians ? GM_NEEDS_ALL : GM_NEEDS_FORM;
    return form | (field->wave ? GM_NEEDS_WAVE : 0) | (problem->line.points % 2 == 0 ? GM_NEEDS_PAIRS : 0) |
           field->equation;
}

static const struct gm_facet_words words[] = {
    {GM_NEEDS_BURGERS, "Burgers' equation", "Burgers' equation"},
    {GM_NEEDS_HEAT, "the heat equation", "the heat equation"},
    {GM_NEEDS_KDV, "the Korteweg-de Vries equation", "the Korteweg-de Vries equation"},
    {GM_NEEDS_NLS, "the nonlinear Schrödinger equation", "the nonlinear Schrödinger equation"},
    {GM_NEEDS_WAVE, "a wave equation", "wave equations"},
    {GM_NEEDS_ALL, "a multisymplectic form as its state", "multisymplectic equations of all components"},
    {GM_NEEDS_PAIRS, "an even number of points", "grids of an even number of points"},
    {GM_NEEDS_FORM, "a multisymplectic form", "multisymplectic equations"},
    {0},
};

static void note_order(struct gm_certificate *certificate, double *farthest, double order,
                       const char *problem)
{
    const double away = isnan(order) ? INFINITY : fabs(order - certificate->scheme->order);
    if (away > *farthest) {
        *farthest = away;
        certificate->order = order;
        certificate->order_problem = problem;
    }
}

static const struct gm_settings no_settings;

/* Steps to the time t; the largest difference of the field from `exact`, INFINITY for a failure. */
static double error_at(struct gm_field_subject *subject, double t,
                       double (*exact)(const struct gm_problem *problem, size_t i, double t))
{
    double largest = INFINITY;
    if (gm_run_until(subject->run, t) == GM_OK) {
        largest = 0;
        for (size_t i = 0; i < subject->problem.line.points; i++) {
            largest = fmax(largest, fabs(gm_run_state(subject->run)[i] - exact(&subject->problem, i, t)));
        }
    }
    gm_run_close(subject->run);
    return largest;
}

static double wave_energy(const void *problem, const double *y, const double *memory)
{
    (void)memory;
    return gm_wave_energy(problem, y);
}

static double kdv_mass(const void *problem, const double *y, const double *memory)
{
    (void)memory;
    return gm_kdv_mass(problem, y);
}

static double nls_charge(const void *problem, const double *y, const double *memory)
{
    (void)memory;
    return gm_nls_node_charge(problem, y);
}

static void note_kept(struct gm_certificate *certificate, enum gm_claim claim,
                      struct gm_field_subject *subject, const double *y,
                      double (*quantity)(const void *problem, const double *y, const double *memory))
{
    const struct gm_kept kept = {.value = quantity, .data = &subject->problem};
    gm_field_note_kept(certificate, claim, subject, y, &kept, subject->problem.name);
}

static const struct gm_sine_gordon breather = {.initial = GM_BREATHER, .frequency = 0.6};

static double exact_breather(const struct gm_problem *problem, size_t i, double t)
{
    return gm_sine_gordon_exact(&breather, 15, gm_grid1_node(&problem->line, i), t);
}

static void certify_wave(struct gm_certificate *certificate, double *farthest)
{
    struct gm_field_subject subject = {.problem = gm_problem_sine_gordon, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    const char *name = problem->name;
    problem->parameters = &breather;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        /* two-step schemes and boxes alike are good for dt < dx; a higher order is seen on finer grids, on a
           ring that the breather's ends do not reach around */
        const bool fine = certificate->scheme->order > 2;
        const size_t points = (fine ? 1200u : certificate->scheme->needs & GM_NEEDS_PAIRS ? 302u : 301u) << k;
        const double length = fine ? 60 : 30;
        problem->line =
            (struct gm_grid1){.points = points, .dx = length / (double)points, .first = -length / 2};
        problem->n = gm_wave_size(points);
        subject.dt = (fine ? 0.025 : 0.08) / (double)(1u << k);
        double *y = malloc(problem->n * sizeof *y);
        if (!y) {
            return;
        }
        gm_sine_gordon_levels(problem, 0, subject.dt, y);
        if (k == 0) {
            gm_field_note_form(certificate, &subject, y, 1);
            note_kept(certificate, GM_KEEPS_ENERGY, &subject, y, wave_energy);
        }
        if (gm_field_begin(&subject, y)) {
            error[k] = error_at(&subject, 4, exact_breather);
        }
        free(y);
    }
    note_order(certificate, farthest, log2(error[0] / error[1]), name);
}

static const struct gm_kdv soliton = {.initial = GM_KDV_SOLITON, .eta = 1, .mu = 1, .velocity = 1};

static double exact_kdv(const struct gm_problem *problem, size_t i, double t)
{
    return gm_kdv_exact(&soliton, &problem->line, gm_grid1_node(&problem->line, i), t);
}

/* The difference between a run to t = 1 and one from a frame of velocity 2, which travels over whole nodes; or
   the defect of a step under a boost and a scaling, where there is one and it is larger. */
static double frame_defect(const struct gm_field_subject *subject, const double *y)
{
    static const struct gm_kdv boosted = {
        .initial = GM_KDV_SOLITON, .eta = 1, .mu = 1, .velocity = 1, .lambda = 2};
    static const struct gm_kdv_symmetry symmetry = {.boost = 0.5, .scale = 1.3};
    struct gm_field_subject rest = *subject, moving = *subject;
    const struct gm_grid1 *grid = &subject->problem.line;
    const bool fixed = gm_kdv_fixed(&boosted, subject->scheme);
    const size_t travelled = fixed ? (size_t)lround(boosted.lambda / grid->dx) : 0;
    const double step = gm_kdv_defect(&subject->problem, subject->scheme, subject->dt, &symmetry, y);
    double *start = malloc(subject->problem.n * sizeof *start), largest = INFINITY;
    if (!start) {
        return INFINITY;
    }
    moving.problem.parameters = &boosted;
    gm_kdv_levels(&moving.problem, subject->dt, start);
    if (gm_field_begin(&rest, y)) {
        if (gm_field_begin(&moving, start)) {
            if (gm_run_until(rest.run, 1) == GM_OK && gm_run_until(moving.run, 1) == GM_OK) {
                largest = isnan(step) ? 0 : step;
                for (size_t i = 0; i < grid->points; i++) {
                    const double seen = gm_run_state(moving.run)[(i + travelled) % grid->points];
                    const double apart =
                        fabs(seen - boosted.lambda / boosted.eta - gm_run_state(rest.run)[i]);
                    largest = gm_larger(apart, largest);
                }
            }
            gm_run_close(moving.run);
        }
        gm_run_close(rest.run);
    }
    free(start);
    return largest;
}

static void certify_kdv(struct gm_certificate *certificate, double *farthest)
{
    struct gm_field_subject subject = {.problem = gm_problem_kdv, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    problem->parameters = &soliton;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        const size_t points = 200u << k;
        problem->line = (struct gm_grid1){.points = points, .dx = 40.0 / (double)points, .first = -20};
        problem->n = gm_wave_size(points);
        /* an explicit scheme follows dx^3, by less than a quarter */
        const struct gm_scheme *scheme = certificate->scheme;
        const bool is_explicit = scheme->needs & GM_NEEDS_KDV && !gm_kdv_solves(scheme);
        subject.dt = scheme->family == &gm_family_pseudospectral ? 0.005
                     : is_explicit                               ? 0.0016 / (double)(1u << 3 * k)
                                                                 : 0.04 / (double)(1u << k);
        double *y = malloc(problem->n * sizeof *y);
        if (!y) {
            return;
        }
        gm_kdv_levels(problem, subject.dt, y);
        if (k == 0) {
            note_kept(certificate, GM_KEEPS_LINEAR, &subject, y, kdv_mass);
            gm_field_note_form(certificate, &subject, y, 1);
            gm_certificate_note(certificate, GM_EQUIVARIANT, frame_defect(&subject, y), problem->name);
        }
        if (scheme->family == &gm_family_pseudospectral) {
            note_order(certificate, farthest, gm_field_order_in_time(&subject, y), problem->name);
            free(y);
            return;
        }
        if (gm_field_begin(&subject, y)) {
            error[k] = error_at(&subject, 1, exact_kdv);
        }
        free(y);
    }
    note_order(certificate, farthest, log2(error[0] / error[1]), problem->name);
}

static const struct gm_nls bright = {.initial = GM_NLS_SOLITON, .amplitude = 1, .velocity = 1};

static double exact_nls(const struct gm_problem *problem, size_t i, double t)
{
    double re = 0, im = 0;
    gm_nls_exact(&bright, &problem->line, gm_grid1_node(&problem->line, i), t, &re, &im);
    return re;
}

/* The state of a soliton on the grid of the problem; NULL where memory is short. */
static double *nls_state(const struct gm_problem *problem)
{
    const size_t points = problem->line.points;
    double *y = malloc(2 * points * sizeof *y);
    for (size_t i = 0; y && i < points; i++) {
        gm_nls_exact(&bright, &problem->line, gm_grid1_node(&problem->line, i), 0, &y[i], &y[points + i]);
    }
    return y;
}

static void certify_nls(struct gm_certificate *certificate, double *farthest)
{
    struct gm_field_subject subject = {.problem = gm_problem_nls, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    problem->parameters = &bright;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    const bool explicit = certificate->scheme->family == &gm_family_schroedinger_nodes;
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        const size_t points = 300u << k;
        problem->line = (struct gm_grid1){.points = points, .dx = 40.0 / (double)points, .first = -20};
        problem->n = 2 * points;
        subject.dt = (explicit ? 0.005 : 0.02) / (double)(1u << k);
        double *y = nls_state(problem);
        if (!y) {
            return;
        }
        if (k == 0) {
            note_kept(certificate, GM_KEEPS_QUADRATIC, &subject, y, nls_charge);
            gm_field_note_form(certificate, &subject, y, 1);
        }
        if (explicit) {
            note_order(certificate, farthest, gm_field_order_in_time(&subject, y), problem->name);
            free(y);
            return;
        }
        if (gm_field_begin(&subject, y)) {
            error[k] = error_at(&subject, 1, exact_nls);
        }
        free(y);
    }
    note_order(certificate, farthest, log2(error[0] / error[1]), problem->name);
}

static const struct gm_dirac standing = {.mass = 1, .coupling = 0.5, .frequency = 0.75};

static double exact_dirac(const struct gm_problem *problem, size_t i, double t)
{
    double s[4];
    gm_dirac_exact(&standing, gm_grid1_node(&problem->line, i), t, s);
    return s[0];
}

static void certify_dirac(struct gm_certificate *certificate, double *farthest)
{
    struct gm_field_subject subject = {.problem = gm_problem_dirac, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    problem->parameters = &standing;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        const size_t points = 361u << k;
        problem->line = (struct gm_grid1){.points = points, .dx = 60 / (double)points, .first = -30};
        problem->n = 4 * points;
        subject.dt = 0.05 / (double)(1u << k);
        double *y = malloc(problem->n * sizeof *y);
        if (!y) {
            return;
        }
        for (size_t i = 0; i < points; i++) {
            double s[4];
            gm_dirac_exact(&standing, gm_grid1_node(&problem->line, i), 0, s);
            for (size_t c = 0; c < 4; c++) {
                y[c * points + i] = s[c];
            }
        }
        if (k == 0) {
            gm_field_note_form(certificate, &subject, y, 1);
        }
        if (gm_field_begin(&subject, y)) {
            error[k] = error_at(&subject, 4, exact_dirac);
        }
        free(y);
    }
    note_order(certificate, farthest, log2(error[0] / error[1]), problem->name);
}

enum { FRONT = 81 };

/* The field after a time on a resolved front, nu = 0.1, dx = 0.05; false for a failure. */
static bool front_after(const struct gm_scheme *scheme, double lambda, double dt, double until, double *u)
{
    const struct gm_burgers burgers = {
        .frame = GM_FRAME_MOVING, .viscosity = 0.1, .lambda = lambda, .a = -0.3, .d = 0.2};
    struct gm_problem problem = gm_problem_burgers;
    problem.parameters = &burgers;
    problem.line = (struct gm_grid1){.points = FRONT, .dx = 0.05, .first = -2};
    problem.n = gm_burgers_size(&burgers, FRONT);
    double y[2 * FRONT + 1] = {0};
    for (size_t j = 0; j < FRONT; j++) {
        y[j] = gm_burgers_exact(&burgers, false, gm_grid1_node(&problem.line, j), 0);
    }
    struct gm_run *run = gm_run_open(&problem, scheme, &no_settings, 0, dt, y);
    if (!run) {
        return false;
    }
    const bool good = gm_run_until(run, until) == GM_OK;
    for (size_t j = 0; j < FRONT; j++) {
        u[j] = gm_run_state(run)[j] - lambda;
    }
    gm_run_close(run);
    return good;
}

static void certify_burgers(struct gm_certificate *certificate, double *farthest)
{
    const struct gm_scheme *scheme = certificate->scheme;
    if (!(scheme->needs & GM_NEEDS_BURGERS)) {
        return;
    }
    const char *name = gm_problem_burgers.name;
    double level[3][FRONT], boosted[FRONT];
    bool good = true;
    for (int k = 0; k < 3; k++) {
        good &= front_after(scheme, 0, ldexp(0.002, -k), 0.2, level[k]);
    }
    note_order(certificate, farthest,
               good ? log2(gm_distance(level[0], level[1], FRONT) / gm_distance(level[1], level[2], FRONT))
                    : NAN,
               name);
    static const double u[3] = {0.4, 0.3, 0.15};
    const struct gm_burgers burgers = {.viscosity = 0.005, .a = -0.3, .d = 0.2};
    const struct gm_burgers_symmetry symmetry = {.a4 = 0.5, .a5 = 0.4, .scale = 1.3};
    const double step = gm_burgers_defect(scheme, &burgers, 0.01, 0.01, &symmetry, 0.3, u);
    good &= front_after(scheme, 2, 0.002, 0.2, boosted);
    const double boost = good ? gm_distance(boosted, level[0], FRONT) : INFINITY;
    /* three nodes do not determine an implicit step: its claim is of boosts alone */
    gm_certificate_note(certificate, GM_EQUIVARIANT, isnan(step) ? boost : fmax(boost, step), name);
}

/* The field after a time on two kernels, nu = 1, dx = 0.1, as the original frame sees it; false for a
   failure. */
static bool heat_after(const struct gm_scheme *scheme, double lambda, double dt, double until, double *u)
{
    const struct gm_heat heat = {
        .start = GM_HEAT_TWO, .frame = GM_FRAME_MOVING, .diffusivity = 1, .lambda = lambda, .age = 0.25};
    struct gm_problem problem = gm_problem_heat;
    problem.parameters = &heat;
    problem.line = (struct gm_grid1){.points = FRONT, .dx = 0.1, .first = -4};
    problem.n = FRONT;
    double y[FRONT];
    for (size_t j = 0; j < FRONT; j++) {
        y[j] = gm_heat_exact(&heat, false, gm_grid1_node(&problem.line, j), 0);
    }
    struct gm_run *run = gm_run_open(&problem, scheme, &no_settings, 0, dt, y);
    if (!run) {
        return false;
    }
    const bool good = gm_run_until(run, until) == GM_OK;
    for (size_t j = 0; j < FRONT; j++) {
        u[j] = gm_run_state(run)[j] / gm_heat_factor(&heat, false, gm_grid1_node(&problem.line, j), run->t);
    }
    gm_run_close(run);
    return good;
}

static void certify_heat(struct gm_certificate *certificate, double *farthest)
{
    const struct gm_scheme *scheme = certificate->scheme;
    if (!(scheme->needs & GM_NEEDS_HEAT)) {
        return;
    }
    static const struct gm_heat heat = {.diffusivity = 1};
    struct gm_problem problem = gm_problem_heat;
    problem.parameters = &heat;
    problem.line = (struct gm_grid1){.points = FRONT, .dx = 0.1, .first = -4};
    double level[3][FRONT], boosted[FRONT];
    bool good = true;
    for (int k = 0; k < 3; k++) {
        good &= heat_after(scheme, 0, ldexp(0.002, -k), 0.2, level[k]);
    }
    note_order(certificate, farthest,
               good ? log2(gm_distance(level[0], level[1], FRONT) / gm_distance(level[1], level[2], FRONT))
                    : NAN,
               problem.name);
    const unsigned keeps = gm_heat_keeps(scheme);
    const struct gm_heat_symmetry symmetry = {
        .boost = 0.5, .projection = keeps & GM_HEAT_PROJECTIONS ? 0.5 : 0, .scale = 1.3};
    good &= heat_after(scheme, 2, 0.002, 0.2, boosted);
    const double step = gm_heat_defect(&problem, scheme, 0.002, &symmetry, level[0]);
    gm_certificate_note(certificate, GM_EQUIVARIANT,
                        good ? fmax(step, gm_distance(boosted, level[0], FRONT)) : INFINITY, problem.name);
}

/* Measures the claims of a scheme for fields on a line, on every equation that it fits: order against exact
   solutions (Burgers: in time, by itself), the multisymplectic law, energy, mass and charge, return after a
   reversed step, equivariance under boosts, projections and scalings. */
static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    (void)scheme; /* the certificate's */
    double farthest = -1;
    certify_wave(certificate, &farthest);
    certify_kdv(certificate, &farthest);
    certify_nls(certificate, &farthest);
    certify_dirac(certificate, &farthest);
    certify_burgers(certificate, &farthest);
    certify_heat(certificate, &farthest);
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        certificate->claims[bit].reason = NULL; /* on the program's own equations nothing excuses a claim */
    }
    certificate->order_holds = farthest >= 0 && farthest < 0.15;
}

/* ---- on a given equation ---- */

/* Which claims a kept quantity of a field tells of: whether it is linear or quadratic, along directions that a scheme's
   own numbers do not take part in. */
static unsigned claims_of(const struct gm_kept *kept, const struct gm_certified_system *system, double size)
{
    enum { DIRECTIONS = 3 };
    const double none = 1e-11;
    const size_t n = system->problem->n,
                 fixed = n % 2 == 1 && n == gm_wave_size(system->problem->line.points);
    double *direction = calloc(n, sizeof *direction);
    bool varies = false, linear = true, quadratic = true;
    for (int k = 1; direction && k <= DIRECTIONS; k++) {
        for (size_t c = 0; c < n - fixed; c++) {
            direction[c] = size * sin(k * (double)(3 * c + 1)); /* any */
        }
        varies = varies || !(gm_kept_differences(kept, system->start, n, 1, direction) < none);
        linear = linear && gm_kept_differences(kept, system->start, n, 2, direction) < none;
        quadratic = quadratic && gm_kept_differences(kept, system->start, n, 3, direction) < none;
    }
    free(direction);
    return !varies ? 0 : linear ? GM_KEEPS_LINEAR : quadratic ? GM_KEEPS_QUADRATIC : 0;
}

/* The energy of a form, which is of a scheme's own kind. */
static double form_energy(const void *subject, const double *y, const double *memory)
{
    const struct gm_field_subject *of = subject;
    (void)y; /* the memory holds the stages that lead to it */
    return gm_form_energy(&of->problem, of->scheme, memory);
}

/* Why no step of this length can tell of a claim; NULL: steps can. */
static const char *no_steps(struct gm_field_subject *subject, const double *y)
{
    const struct gm_step_limit *limit = subject->scheme->limit;
    if (limit && fabs(subject->dt) > limit->longest(&subject->problem, y)) {
        return "dt is beyond the longest step of linear theory (longest_step): take a shorter one";
    }
    bool good = gm_field_begin(subject, y);
    if (good) {
        good = gm_run_advance(subject->run, GM_FIELD_STEPS) == GM_OK;
        gm_run_close(subject->run);
    }
    return good ? NULL : "a run of steps of this dt fails: take a shorter one";
}

/* The order, and what an equation has that is not one of this program's: symmetry and the multisymplectic law, the
   energy, and what the system says that it keeps. */
static void certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate)
{
    struct gm_field_subject subject = {.problem = *system->problem, .scheme = scheme, .dt = system->dt};
    const struct gm_field *field = gm_field_of(system->problem);
    const double *const y = system->start, size = gm_field_size(system->problem, y);
    const char *const name = system->problem->name;
    const char *const failing =
        field->equation ? "without --on it is measured on this equation" : no_steps(&subject, y);
    certificate->order_problem = name;
    certificate->order_reason = failing;
    if (!failing) {
        certificate->order = gm_field_order(system, scheme, &certificate->ladder, &certificate->order_reason);
        gm_field_note_form(certificate, &subject, y, size);
        if (field->wave) {
            note_kept(certificate, GM_KEEPS_ENERGY, &subject, y, wave_energy);
        } else if (field->form && field->form->hessians) {
            const struct gm_kept energy = {.value = form_energy, .data = &subject};
            gm_field_note_kept(certificate, GM_KEEPS_ENERGY, &subject, y, &energy, name);
        }
        for (size_t i = 0; i < system->kept_count; i++) {
            const unsigned claim = claims_of(&system->kept[i], system, size);
            if (claim) {
                gm_field_note_kept(certificate, (enum gm_claim)claim, &subject, y, &system->kept[i],
                                   system->kept[i].name);
            }
        }
    }
    certificate->order_holds = !(certificate->order <= scheme->order - 0.15);
    const struct {
        enum gm_claim claim;
        const char *reason;
    } missing[] = {{GM_MULTISYMPLECTIC, "the scheme has no such law that could be measured"},
                   {GM_KEEPS_ENERGY, "the equation has no energy that is known"},
                   {GM_KEEPS_LINEAR, "the system names no linear invariant"},
                   {GM_KEEPS_QUADRATIC, "the system names no quadratic invariant"}};
    for (size_t i = 0; i < GM_COUNT(missing); i++) {
        gm_certificate_withhold(certificate, missing[i].claim, failing ? failing : missing[i].reason);
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (certificate->claims[bit].claimed && !certificate->claims[bit].reason) {
            gm_certificate_withhold(certificate, (enum gm_claim)(1u << bit),
                                    failing ? failing : "it is measured on the scheme's own equation alone");
        }
    }
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/field/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_field = {
    .name = "field",
    .problems = "waves on a line",
    .words = words,
    .facets = facets,
    .certify = certify,
    .certify_on = certify_on,
    .most_certified = 100000,
    .families = families,
    .quantities = gm_field_quantities,
};
