/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kind of fields in one space dimension: its facets, the families of schemes that need them, and their
   certification. */
#include "core/field/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/certify.h"
#include "core/field/certify/runs.h"
#include "core/field/families/families.h"
#include "core/field/families/laws/form.h"
#include "core/field/families/laws/wave.h"
#include "core/field/problems/dispersive.h"
#include "core/field/problems/wave.h"
#include "core/field/user/equation.h"
#include "core/field/user/form.h"
#include "core/files/files.h"
#include "core/model/equations.h"
#include "core/quantity.h"
#include "core/run.h"

static const struct gm_settings no_settings;

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

static void note_kept(struct gm_certificate *certificate, enum gm_claim claim,
                      struct gm_field_subject *subject, const double *y,
                      double (*value)(const struct gm_problem *problem, const double *y))
{
    const struct gm_invariant invariant = {value, &subject->problem};
    const struct gm_kept kept = {.value = gm_invariant_value, .data = &invariant};
    gm_field_note_kept(certificate, claim, subject, y, &kept, subject->problem.name);
}

/* ---- on the program's own equations ---- */

static void exact_breather(const struct gm_problem *problem, double x, double t, double *values)
{
    const double w = 0.6, g = sqrt((1 - w) * (1 + w));
    (void)problem;
    values[0] = 4 * atan(g * sin(w * t) / (w * cosh(g * x)));
}

/* A soliton of velocity 1. */
static void exact_kdv(const struct gm_problem *problem, double x, double t, double *values)
{
    const double lambda = gm_kdv_of(problem)->framed.lambda,
                 period = problem->line.dx * (double)problem->line.points;
    const double along = x - (1 + lambda) * t, away = along - period * floor(along / period + 0.5);
    values[0] = 3 / (cosh(away / 2) * cosh(away / 2)) + lambda;
}

static void exact_nls(const struct gm_problem *problem, double x, double t, double *values)
{
    (void)problem;
    const double size = sqrt(2) / cosh(x - t), phase = (x - t) / 2 + 1.25 * t;
    values[0] = size * cos(phase);
    values[1] = size * sin(phase);
}

/* dx sum of u in the original frame */
static double kdv_mass(const struct gm_problem *problem, const double *y)
{
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += y[i] - kdv->framed.lambda / kdv->eta;
    }
    return problem->line.dx * sum;
}

/* dx sum |psi|^2 */
static double nls_charge(const struct gm_problem *problem, const double *y)
{
    double sum = 0;
    for (size_t i = 0; i < 2 * problem->line.points; i++) {
        sum += y[i] * y[i];
    }
    return problem->line.dx * sum;
}

static void exact_of_file(const struct gm_problem *problem, double x, double t, double *values)
{
    for (size_t c = 0; c < gm_field_of(problem)->form->dimension; c++) {
        values[c] = gm_user_line_exact(problem->parameters, c, x, t);
    }
}

/* On nodes that move with their frame. */
static void exact_in_frame(const struct gm_problem *problem, double x, double t, double *values)
{
    values[0] = gm_frame_exact(gm_framed_of(problem), gm_framed_of(problem)->lambda, x, t);
}

/* Frames of reference: the same solution from a moving one, and the value at node i that the original frame sees of a
   run. */
struct frames {
    const void *parameters; /* of an equation without a file */
    double (*seen)(const struct gm_run *run, size_t i);
};

/* Nodes that rest in the frame have travelled over whole nodes of the original one. */
static double seen_kdv(const struct gm_run *run, size_t i)
{
    const struct gm_kdv *kdv = gm_kdv_of(run->problem);
    const struct gm_grid1 *line = &run->problem->line;
    const long travelled =
        gm_frame_rests(&kdv->framed, run->scheme) ? lround(kdv->framed.lambda * run->t / line->dx) : 0;
    return gm_run_state(run)[(i + (size_t)travelled) % line->points] - kdv->framed.lambda / kdv->eta;
}

static double seen_burgers(const struct gm_run *run, size_t i)
{
    return gm_run_state(run)[i] - gm_framed_of(run->problem)->lambda;
}

static double seen_heat(const struct gm_run *run, size_t i)
{
    const double x = gm_grid1_node(&run->problem->line, i);
    return gm_run_state(run)[i] / gm_heat_factor(gm_framed_of(run->problem), false, x, run->t);
}

static bool is_above_second_order(const struct gm_scheme *scheme)
{
    return scheme->order > 2;
}

static bool is_pseudospectral(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_pseudospectral;
}

static bool is_explicit_for_kdv(const struct gm_scheme *scheme)
{
    return scheme->needs & GM_NEEDS_KDV && !gm_frames_of_kdv.are_special(scheme);
}

static bool is_explicit_for_nls(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_schroedinger_nodes;
}

/* An equation with an exact solution to start from, the runs that the order is measured by, and what else is
   measured; of several rows for an equation a scheme takes the first that is meant for it. */
struct equation {
    const struct gm_problem *problem;
    const char
        *file; /* instead of `problem`: of share/subjects with a multisymplectic form, or of share/systems */
    struct gm_system_value given[3]; /* of its values; its frame moves with the velocity lambda = 2 */
    const void *parameters;
    void (*exact)(const struct gm_problem *problem, double x, double t, double *values);
    size_t numbers; /* numbers of the exact solution at a node; 0: one, with two levels in the state */
    bool (*meant)(const struct gm_scheme *scheme); /* NULL: for every scheme that fits */
    struct gm_grid1 line;
    double dt, until;
    int power; /* dt falls as this power of dx, and errors give the order in space and time; 0: order in time
                  alone */
    enum gm_claim claim;
    double (*kept)(const struct gm_problem *problem, const double *y);
    const struct frames *frames;
};

#define SINE_GORDON                                                                                          \
    .problem = &gm_problem_sine_gordon, .exact = exact_breather, .until = 4, .power = 1,                     \
    .claim = GM_KEEPS_ENERGY, .kept = gm_wave_energy

#define KDV_SOLITON .eta = 1, .mu = 1
#define KDV                                                                                                  \
    .problem = &gm_problem_kdv, .parameters = &(const struct gm_kdv){KDV_SOLITON}, .exact = exact_kdv,       \
    .line = {.points = 200, .dx = 0.2, .first = -20}, .until = 1, .claim = GM_KEEPS_LINEAR,                  \
    .kept = kdv_mass, .frames = &(const struct frames)                                                       \
    {                                                                                                        \
        &(const struct gm_kdv){KDV_SOLITON, .framed.lambda = 2}, seen_kdv                                    \
    }

#define NLS                                                                                                  \
    .problem = &gm_problem_nls, .parameters = &(const struct gm_nls){.k = 1}, .exact = exact_nls,            \
    .numbers = 2, .line = {.points = 300, .dx = 40.0 / 300, .first = -20}, .until = 1,                       \
    .claim = GM_KEEPS_QUADRATIC, .kept = nls_charge

/* Two-step schemes and boxes alike are good for dt < dx; a higher order is seen on finer grids, on a ring
   that the breather's ends do not reach around. An explicit scheme for Korteweg-de Vries follows dx^3, by
   less than a quarter. */
static const struct equation equations[] = {
    {SINE_GORDON, .meant = is_above_second_order, .line = {.points = 1200, .dx = 0.05, .first = -30},
     .dt = 0.025},
    {SINE_GORDON, .line = {.points = 301, .dx = 30.0 / 301, .first = -15}, .dt = 0.08},
    {SINE_GORDON, .line = {.points = 302, .dx = 30.0 / 302, .first = -15}, .dt = 0.08},
    {KDV, .meant = is_pseudospectral, .dt = 0.005},
    {KDV, .meant = is_explicit_for_kdv, .dt = 0.0016, .power = 3},
    {KDV, .dt = 0.04, .power = 1},
    {NLS, .meant = is_explicit_for_nls, .dt = 0.005},
    {NLS, .dt = 0.02, .power = 1},
    {.file = "dirac",
     .exact = exact_of_file,
     .numbers = 4,
     .line = {.points = 361, .dx = 60.0 / 361, .first = -30},
     .dt = 0.05,
     .until = 4,
     .power = 1},
    {.file = "burgers",
     .given = {{"viscosity", "0.1"}, {"a", "-0.3"}, {"d", "0.2"}},
     .exact = exact_in_frame,
     .numbers = 1,
     .line = {.points = 81, .dx = 0.05, .first = -2},
     .dt = 0.002,
     .until = 0.2,
     .frames = &(const struct frames){.seen = seen_burgers}},
    {.file = "heat",
     .exact = exact_in_frame,
     .numbers = 1,
     .line = {.points = 81, .dx = 0.1, .first = -4},
     .dt = 0.002,
     .until = 0.2,
     .frames = &(const struct frames){.seen = seen_heat}},
};

/* The problem of an equation with these parameters, on a grid that is twice as fine `finer` times. */
static struct gm_problem problem_of(const struct equation *equation, const void *parameters, int finer)
{
    struct gm_problem problem = *equation->problem;
    problem.parameters = parameters;
    problem.line = equation->line;
    problem.line.points <<= finer;
    problem.line.dx = ldexp(problem.line.dx, -finer);
    const size_t points = problem.line.points;
    if (equation->numbers == 0) {
        problem.n = gm_wave_size(points);
    } else if (gm_field_of(&problem)->equation == GM_NEEDS_BURGERS) {
        problem.n = gm_burgers_size(parameters, points);
    } else {
        problem.n = equation->numbers * points;
    }
    return problem;
}

/* The exact state at 0, or the levels 0 and dt, which the caller frees; NULL when out of memory. */
static double *start_of(const struct equation *equation, const struct gm_problem *problem, double dt)
{
    const size_t points = problem->line.points;
    double *y = calloc(problem->n, sizeof *y), values[4];
    for (size_t i = 0; y && i < points; i++) {
        const double x = gm_grid1_node(&problem->line, i);
        equation->exact(problem, x, 0, values);
        y[i] = values[0];
        for (size_t c = 1; c < equation->numbers; c++) {
            y[c * points + i] = values[c];
        }
        if (equation->numbers == 0) {
            equation->exact(problem, x, dt, &y[points + i]);
        }
    }
    if (y && equation->numbers == 0) {
        y[2 * points] = dt;
    }
    return y;
}

/* The largest difference of the field from the exact solution; INFINITY for a failure. */
static double error_of(const struct equation *equation, struct gm_field_subject *subject, const double *y)
{
    double largest = INFINITY, values[4];
    if (gm_field_begin(subject, y)) {
        largest = gm_run_until(subject->run, equation->until) == GM_OK ? 0 : INFINITY;
        for (size_t i = 0; i < subject->problem.line.points; i++) {
            equation->exact(&subject->problem, gm_grid1_node(&subject->problem.line, i), equation->until,
                            values);
            largest = fmax(largest, fabs(gm_run_state(subject->run)[i] - values[0]));
        }
        gm_run_close(subject->run);
    }
    return largest;
}

/* The difference between a run and one from the moving frame, or the defect of a step under a symmetry if
   it is larger; INFINITY for a failure. */
static double frame_defect(const struct equation *equation, const struct gm_field_subject *subject,
                           const double *y)
{
    const struct gm_field *field = gm_field_of(&subject->problem);
    const bool projects = field->equation != GM_NEEDS_HEAT || field->frames->are_special(subject->scheme);
    const struct gm_symmetry symmetry = {.boost = 0.5, .projection = projects ? 0.5 : 0, .scale = 1.3};
    struct gm_field_subject rest = *subject, moving = *subject;
    moving.problem = problem_of(equation, equation->frames->parameters, 0);
    double *start = start_of(equation, &moving.problem, subject->dt), largest = INFINITY;
    const bool begun = gm_field_begin(&rest, y);
    if (start && begun && gm_field_begin(&moving, start)) {
        if (gm_run_until(rest.run, equation->until) == GM_OK &&
            gm_run_until(moving.run, equation->until) == GM_OK) {
            largest = 0;
            for (size_t i = 0; i < subject->problem.line.points; i++) {
                const double apart =
                    fabs(equation->frames->seen(moving.run, i) - equation->frames->seen(rest.run, i));
                largest = gm_larger(apart, largest);
            }
            largest = fmax(largest, field->frames->defect(&subject->problem, subject->scheme, subject->dt,
                                                          &symmetry, y));
        }
        gm_run_close(moving.run);
    }
    gm_run_close(rest.run);
    free(start);
    return largest;
}

/* Takes in the order on one problem. The one farthest from the claimed order counts. */
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

static void measure(struct gm_certificate *certificate, const struct equation *equation, double *farthest)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const char *const name = equation->problem->name;
    double error[2] = {NAN, NAN}, order = NAN;
    for (int k = 0; k < (equation->power > 0 ? 2 : 1); k++) {
        struct gm_field_subject subject = {.problem = problem_of(equation, equation->parameters, k),
                                           .scheme = scheme,
                                           .dt = ldexp(equation->dt, -k * equation->power)};
        double *y = start_of(equation, &subject.problem, subject.dt);
        if (!y) {
            return;
        }
        if (k == 0 && equation->kept) {
            note_kept(certificate, equation->claim, &subject, y, equation->kept);
        }
        if (k == 0 && gm_field_of(&subject.problem)->form) {
            gm_field_note_form(certificate, &subject, y, 1);
        }
        if (k == 0) {
            gm_certificate_note_same(certificate, &subject.problem, &no_settings, subject.dt, y);
        }
        if (k == 0 && equation->frames) {
            gm_certificate_note(certificate, GM_EQUIVARIANT, frame_defect(equation, &subject, y), name);
        }
        if (equation->power > 0) {
            error[k] = error_of(equation, &subject, y);
        } else {
            order = gm_field_order_in_time(&subject, y, equation->until);
        }
        free(y);
    }
    note_order(certificate, farthest, equation->power > 0 ? log2(error[0] / error[1]) : order, name);
}

/* The equation of a file, and the same from a moving frame. */
struct read {
    struct gm_user_system system;
    struct gm_user_form form;
    struct gm_user_equation equation;
    struct gm_problem problem, moving;
    struct frames frames;
};

/* Opens an equation with frames, at rest or moving. */
static bool open_framed(const struct read *read, const struct equation *equation, const char *lambda,
                        struct gm_problem *problem)
{
    const struct gm_user_system *system = &read->system;
    double *given = malloc(system->variable_count * sizeof *given);
    for (size_t i = 0; given && i < system->variable_count; i++) {
        const struct gm_system_value set[] = {
            equation->given[0], equation->given[1], equation->given[2], {"lambda", lambda}};
        given[i] = NAN;
        for (size_t k = 0; k < GM_COUNT(set); k++) {
            const bool is = set[k].name && strcmp(set[k].name, system->variables[i].name) == 0;
            given[i] = is ? strtod(set[k].text, NULL) : given[i];
        }
    }
    double *values = given ? gm_equations_start(system, given) : NULL;
    const bool good = values && gm_user_equation_open(problem, &read->equation, values, &equation->line);
    if (good) {
        ((struct gm_framed *)problem->parameters)->frame = GM_FRAME_MOVING;
    }
    free(given);
    free(values);
    return good;
}

/* Returns false when out of memory; the caller closes it in both cases. */
static bool open_file(struct read *read, struct equation *equation)
{
    const bool framed = equation->frames != NULL;
    const struct gm_built_in *file =
        gm_built_in_find(framed ? GM_FILE_SYSTEM : GM_FILE_SUBJECT, equation->file);
    struct gm_fault fault;
    double *values = NULL;
    bool good = gm_equations_open(&read->system, file->text, file->length, NULL, 0, &fault);
    if (framed) {
        good = good && gm_user_equation_derive(&read->equation, &read->system) &&
               open_framed(read, equation, "0", &read->problem) &&
               open_framed(read, equation, "2", &read->moving);
        read->frames = *equation->frames;
        read->frames.parameters = read->moving.parameters;
        equation->frames = &read->frames;
    } else {
        good = good && gm_user_form_derive(&read->form, &read->system) &&
               (values = gm_equations_start(&read->system, NULL)) != NULL &&
               gm_user_form_open(&read->problem, &read->form, values, &equation->line);
        read->problem.name = file->title;
    }
    free(values);
    equation->problem = &read->problem;
    equation->parameters = read->problem.parameters;
    return good;
}

/* Measures the claims of a scheme for fields on a line, on every equation that it fits. */
static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    const struct gm_problem *measured = NULL;
    double farthest = -1;
    for (size_t i = 0; i < GM_COUNT(equations); i++) {
        struct equation equation = equations[i];
        struct read read = {0};
        const bool opened = !equation.file || open_file(&read, &equation);
        const struct gm_problem problem =
            opened ? problem_of(&equation, equation.parameters, 0) : (struct gm_problem){0};
        if (opened && equation.problem != measured && gm_scheme_fits(scheme, &problem) &&
            (!equation.meant || equation.meant(scheme))) {
            measured = equation.problem;
            measure(certificate, &equation, &farthest);
        }
        if (equation.file && equation.frames) {
            gm_user_equation_close(&read.problem);
            gm_user_equation_close(&read.moving);
        } else {
            gm_user_form_close(&read.problem);
        }
        gm_system_close(&read.system);
    }
    certificate->order_holds = farthest >= 0 && farthest < 0.15;
}

/* ---- on a given equation ---- */

/* The energy of a form, which is of a scheme's own kind. */
static double form_energy(const void *subject, const double *y, const double *memory)
{
    const struct gm_field_subject *of = subject;
    (void)y; /* the memory holds the stages that lead to it */
    return gm_form_energy(&of->problem, of->scheme, memory);
}

/* The reason why steps of this length cannot test a claim, or NULL. */
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

/* Measures the order and the properties of a user-defined equation: symmetry and the multisymplectic law,
   the energy, and the conserved quantities that the system lists. */
static void certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate)
{
    struct gm_field_subject subject = {.problem = *system->problem, .scheme = scheme, .dt = system->dt};
    const struct gm_field *field = gm_field_of(system->problem);
    const double *const y = system->start, size = gm_field_size(system->problem, y);
    const size_t n = system->problem->n,
                 levels = n % 2 == 1 && n == gm_wave_size(system->problem->line.points);
    const char *const name = system->problem->name;
    const char *const failing =
        field->equation ? "without --on it is measured on this equation" : no_steps(&subject, y);
    certificate->order_problem = name;
    certificate->order_reason = failing;
    if (!failing) {
        certificate->order = gm_field_order(system, scheme, &certificate->ladder, &certificate->order_reason);
        gm_field_note_form(certificate, &subject, y, size);
        gm_certificate_note_same(certificate, &subject.problem, &no_settings, subject.dt, y);
        if (field->wave) {
            note_kept(certificate, GM_KEEPS_ENERGY, &subject, y, gm_wave_energy);
        } else if (field->form && field->form->hessians) {
            const struct gm_kept energy = {.value = form_energy, .data = &subject};
            gm_field_note_kept(certificate, GM_KEEPS_ENERGY, &subject, y, &energy, name);
        }
        for (size_t i = 0; i < system->kept_count; i++) {
            /* along directions that a scheme's own last number takes no part in */
            const unsigned claims = gm_kept_claims(&system->kept[i], y, n, n - levels, size);
            if (claims & (GM_KEEPS_LINEAR | GM_KEEPS_QUADRATIC)) {
                gm_field_note_kept(certificate,
                                   claims & GM_KEEPS_LINEAR ? GM_KEEPS_LINEAR : GM_KEEPS_QUADRATIC, &subject,
                                   y, &system->kept[i], system->kept[i].name);
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
    gm_certificate_withhold_all(certificate, scheme->claims,
                                failing ? failing : "it is measured on the scheme's own equation alone");
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/field/families/families.def"
#undef GM_FAMILY
    NULL,
};

static bool is_wave(const struct gm_problem *problem)
{
    return gm_field_of(problem)->wave != NULL;
}

/* a wave without a potential */
static bool is_free(const struct gm_problem *problem)
{
    const double places[] = {-1.7, 0.3, 2.1};
    double slopes[GM_COUNT(places)] = {0};
    if (!is_wave(problem)) {
        return false;
    }
    gm_field_of(problem)->wave->slopes(problem, places, slopes, GM_COUNT(places));
    return slopes[0] == 0 && slopes[1] == 0 && slopes[2] == 0;
}

static const struct gm_same same[] = {
    {"euler-box", "leapfrog", is_wave},
    {"energy-conserving", "leapfrog", is_free},
    {0},
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
    .same = same,
    .quantities = gm_field_quantities,
};
