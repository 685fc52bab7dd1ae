/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of fields in one space dimension as the hall sees it: its facets, the families of schemes that
   need them, and how those are certified. */
#include "core/field/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/certify.h"
#include "core/field/certify/quantities.h"
#include "core/field/families/burgers.h"
#include "core/field/families/families.h"
#include "core/field/families/heat.h"
#include "core/field/families/kdv_frames.h"
#include "core/field/families/laws/wave.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/dirac.h"
#include "core/field/problems/dispersive.h"
#include "core/field/problems/sine_gordon.h"
#include "core/field/problems/wave.h"
#include "core/larger.h"
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

/* What is certified on a kind of equation: everything that the equation's data are needed for. */
struct subject {
    struct gm_problem problem;
    const struct gm_scheme *scheme;
    double dt;
    struct gm_run *run;
};

static const struct gm_settings no_settings;

/* A run from the start; false where memory is short. */
static bool open_run(struct subject *subject, double t0, const double *y)
{
    subject->run = gm_run_open(&subject->problem, subject->scheme, &no_settings, t0, subject->dt, y);
    return subject->run != NULL;
}

/* Steps to the time t; the largest difference of the field from `exact`, INFINITY for a failure. */
static double error_at(struct subject *subject, double t,
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

/* Forth 8 steps, back 7: the distance from the level after the first. Two-step schemes come back along their
   levels. */
static double return_defect(struct subject *subject, const double *y)
{
    const size_t points = subject->problem.line.points;
    double *first = malloc(points * sizeof *first), largest = INFINITY;
    if (first && open_run(subject, 0, y)) {
        gm_run_advance(subject->run, 1);
        memcpy(first, gm_run_state(subject->run), points * sizeof *first);
        gm_run_advance(subject->run, 7);
        gm_run_set_step(subject->run, -subject->dt);
        if (gm_run_advance(subject->run, 7) == GM_OK) {
            largest = gm_distance(gm_run_state(subject->run), first, points);
        }
        gm_run_close(subject->run);
    }
    free(first);
    return largest;
}

/* The relative change of a quantity from the state after one step over 60 more. */
static double drift(struct subject *subject, const double *y,
                    double (*quantity)(const struct gm_problem *problem, const double *y))
{
    double change = INFINITY;
    if (open_run(subject, 0, y)) {
        gm_run_advance(subject->run, 1);
        const double before = quantity(&subject->problem, gm_run_state(subject->run));
        if (gm_run_advance(subject->run, 60) == GM_OK) {
            change = fabs(quantity(&subject->problem, gm_run_state(subject->run)) - before) /
                     fmax(1, fabs(before));
        }
        gm_run_close(subject->run);
    }
    return change;
}

/* The multisymplectic law after 25 steps, where the scheme has one. */
static void note_form(struct gm_certificate *certificate, struct subject *subject, const double *y)
{
    if (!open_run(subject, 0, y)) {
        return;
    }
    gm_run_advance(subject->run, 25);
    const double defect = gm_form_defect(&subject->problem, subject->scheme, subject->dt,
                                         gm_run_state(subject->run), gm_run_memory(subject->run));
    if (!isnan(defect)) {
        gm_certificate_claim(certificate, GM_MULTISYMPLECTIC)->tolerance = 1e-8;
        gm_certificate_note(certificate, GM_MULTISYMPLECTIC, defect, subject->problem.name);
    }
    gm_run_close(subject->run);
}

static const struct gm_sine_gordon breather = {.initial = GM_BREATHER, .frequency = 0.6};

static double exact_breather(const struct gm_problem *problem, size_t i, double t)
{
    return gm_sine_gordon_exact(&breather, 15, gm_line_node(&problem->line, i), t);
}

static void certify_wave(struct gm_certificate *certificate, double *farthest)
{
    struct subject subject = {.problem = gm_problem_sine_gordon, .scheme = certificate->scheme};
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
            (struct gm_line){.points = points, .dx = length / (double)points, .first = -length / 2};
        problem->n = gm_wave_size(points);
        subject.dt = (fine ? 0.025 : 0.08) / (double)(1u << k);
        double *y = malloc(problem->n * sizeof *y);
        if (!y) {
            return;
        }
        gm_sine_gordon_levels(problem, 0, subject.dt, y);
        if (k == 0) {
            gm_certificate_note(certificate, GM_SYMMETRIC, return_defect(&subject, y), name);
            note_form(certificate, &subject, y);
            gm_certificate_note(certificate, GM_KEEPS_ENERGY, drift(&subject, y, gm_wave_energy), name);
        }
        if (open_run(&subject, 0, y)) {
            error[k] = error_at(&subject, 4, exact_breather);
        }
        free(y);
    }
    note_order(certificate, farthest, log2(error[0] / error[1]), name);
}

static const struct gm_kdv soliton = {.initial = GM_KDV_SOLITON, .eta = 1, .mu = 1, .velocity = 1};

static double exact_kdv(const struct gm_problem *problem, size_t i, double t)
{
    return gm_kdv_exact(&soliton, &problem->line, gm_line_node(&problem->line, i), t);
}

/* Of a scheme that follows dx^2, or has no error in space to speak of: on one grid, the differences between
   runs with dt, dt/2 and dt/4. */
static double order_in_time(struct subject *subject, const double *y)
{
    const size_t points = subject->problem.line.points;
    double *end = calloc(3 * points, sizeof *end), apart[2] = {0};
    bool good = end != NULL;
    for (size_t k = 0; good && k < 3; k++) {
        struct subject part = {subject->problem, subject->scheme, ldexp(subject->dt, -(int)k), NULL};
        good = open_run(&part, 0, y);
        if (good) {
            good = gm_run_until(part.run, 1) == GM_OK;
            memcpy(end + k * points, gm_run_state(part.run), points * sizeof *end);
            gm_run_close(part.run);
        }
    }
    for (size_t i = 0; good && i < points; i++) {
        apart[0] = fmax(apart[0], fabs(end[i] - end[points + i]));
        apart[1] = fmax(apart[1], fabs(end[points + i] - end[2 * points + i]));
    }
    free(end);
    return good ? log2(apart[0] / apart[1]) : NAN;
}

/* The difference between a run to t = 1 and one from a frame of velocity 2, which travels over whole nodes; or
   the defect of a step under a boost and a scaling, where there is one and it is larger. */
static double frame_defect(const struct subject *subject, const double *y)
{
    static const struct gm_kdv boosted = {
        .initial = GM_KDV_SOLITON, .eta = 1, .mu = 1, .velocity = 1, .lambda = 2};
    static const struct gm_kdv_symmetry symmetry = {.boost = 0.5, .scale = 1.3};
    struct subject rest = *subject, moving = *subject;
    const struct gm_line *line = &subject->problem.line;
    const bool fixed = gm_kdv_fixed(&boosted, subject->scheme);
    const size_t travelled = fixed ? (size_t)lround(boosted.lambda / line->dx) : 0;
    const double step = gm_kdv_defect(&subject->problem, subject->scheme, subject->dt, &symmetry, y);
    double *start = malloc(subject->problem.n * sizeof *start), largest = INFINITY;
    if (!start) {
        return INFINITY;
    }
    moving.problem.parameters = &boosted;
    gm_kdv_levels(&moving.problem, subject->dt, start);
    if (open_run(&rest, 0, y)) {
        if (open_run(&moving, 0, start)) {
            if (gm_run_until(rest.run, 1) == GM_OK && gm_run_until(moving.run, 1) == GM_OK) {
                largest = isnan(step) ? 0 : step;
                for (size_t i = 0; i < line->points; i++) {
                    const double seen = gm_run_state(moving.run)[(i + travelled) % line->points];
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
    struct subject subject = {.problem = gm_problem_kdv, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    problem->parameters = &soliton;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        const size_t points = 200u << k;
        problem->line = (struct gm_line){.points = points, .dx = 40.0 / (double)points, .first = -20};
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
            gm_certificate_note(certificate, GM_KEEPS_LINEAR, drift(&subject, y, gm_kdv_mass), problem->name);
            note_form(certificate, &subject, y);
            gm_certificate_note(certificate, GM_SYMMETRIC, return_defect(&subject, y), problem->name);
            gm_certificate_note(certificate, GM_EQUIVARIANT, frame_defect(&subject, y), problem->name);
        }
        if (scheme->family == &gm_family_pseudospectral) {
            note_order(certificate, farthest, order_in_time(&subject, y), problem->name);
            free(y);
            return;
        }
        if (open_run(&subject, 0, y)) {
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
    gm_nls_exact(&bright, &problem->line, gm_line_node(&problem->line, i), t, &re, &im);
    return re;
}

/* The state of a soliton on the grid of the problem; NULL where memory is short. */
static double *nls_state(const struct gm_problem *problem)
{
    const size_t points = problem->line.points;
    double *y = malloc(2 * points * sizeof *y);
    for (size_t i = 0; y && i < points; i++) {
        gm_nls_exact(&bright, &problem->line, gm_line_node(&problem->line, i), 0, &y[i], &y[points + i]);
    }
    return y;
}

static void certify_nls(struct gm_certificate *certificate, double *farthest)
{
    struct subject subject = {.problem = gm_problem_nls, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    problem->parameters = &bright;
    problem->parameters = &bright;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    const bool explicit = certificate->scheme->family == &gm_family_nodes;
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        const size_t points = 300u << k;
        problem->line = (struct gm_line){.points = points, .dx = 40.0 / (double)points, .first = -20};
        problem->n = 2 * points;
        subject.dt = (explicit ? 0.005 : 0.02) / (double)(1u << k);
        double *y = nls_state(problem);
        if (!y) {
            return;
        }
        if (k == 0) {
            gm_certificate_note(certificate, GM_KEEPS_QUADRATIC, drift(&subject, y, gm_nls_node_charge),
                                problem->name);
            note_form(certificate, &subject, y);
            gm_certificate_note(certificate, GM_SYMMETRIC, return_defect(&subject, y), problem->name);
        }
        if (explicit) {
            note_order(certificate, farthest, order_in_time(&subject, y), problem->name);
            free(y);
            return;
        }
        if (open_run(&subject, 0, y)) {
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
    gm_dirac_exact(&standing, gm_line_node(&problem->line, i), t, s);
    return s[0];
}

static void certify_dirac(struct gm_certificate *certificate, double *farthest)
{
    struct subject subject = {.problem = gm_problem_dirac, .scheme = certificate->scheme};
    struct gm_problem *problem = &subject.problem;
    problem->parameters = &standing;
    if (!gm_scheme_fits(certificate->scheme, problem)) {
        return;
    }
    double error[2] = {NAN, NAN};
    for (size_t k = 0; k < 2; k++) {
        const size_t points = 361u << k;
        problem->line = (struct gm_line){.points = points, .dx = 60 / (double)points, .first = -30};
        problem->n = 4 * points;
        subject.dt = 0.05 / (double)(1u << k);
        double *y = malloc(problem->n * sizeof *y);
        if (!y) {
            return;
        }
        for (size_t i = 0; i < points; i++) {
            double s[4];
            gm_dirac_exact(&standing, gm_line_node(&problem->line, i), 0, s);
            for (size_t c = 0; c < 4; c++) {
                y[c * points + i] = s[c];
            }
        }
        if (k == 0) {
            note_form(certificate, &subject, y);
            gm_certificate_note(certificate, GM_SYMMETRIC, return_defect(&subject, y), problem->name);
        }
        if (open_run(&subject, 0, y)) {
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
    problem.line = (struct gm_line){.points = FRONT, .dx = 0.05, .first = -2};
    problem.n = gm_burgers_size(&burgers, FRONT);
    double y[2 * FRONT + 1] = {0};
    for (size_t j = 0; j < FRONT; j++) {
        y[j] = gm_burgers_exact(&burgers, false, gm_line_node(&problem.line, j), 0);
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
    problem.line = (struct gm_line){.points = FRONT, .dx = 0.1, .first = -4};
    problem.n = FRONT;
    double y[FRONT];
    for (size_t j = 0; j < FRONT; j++) {
        y[j] = gm_heat_exact(&heat, false, gm_line_node(&problem.line, j), 0);
    }
    struct gm_run *run = gm_run_open(&problem, scheme, &no_settings, 0, dt, y);
    if (!run) {
        return false;
    }
    const bool good = gm_run_until(run, until) == GM_OK;
    for (size_t j = 0; j < FRONT; j++) {
        u[j] = gm_run_state(run)[j] / gm_heat_factor(&heat, false, gm_line_node(&problem.line, j), run->t);
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
    problem.line = (struct gm_line){.points = FRONT, .dx = 0.1, .first = -4};
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
    certificate->order_holds = farthest >= 0 && farthest < 0.15;
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
    .families = families,
    .quantities = gm_field_quantities,
};
