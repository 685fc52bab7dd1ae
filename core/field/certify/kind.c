/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kind of fields in one space dimension: its facets, the families of schemes that need them, and their
   certification. */
#include "core/field/field.h"
#include "core/functions/functions.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/families.h"
#include "core/field/families/frames.h"
#include "core/field/families/laws/laws.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/field/user/equation.h"
#include "core/field/user/form.h"
#include "core/field/user/potential.h"
#include "core/files/files.h"
#include "core/model/equations.h"
#include "core/quantity.h"
#include "core/run.h"
#include "core/theory/certify.h"

static unsigned facets(const struct gm_problem *problem)
{
    const struct gm_field *field = gm_field_of(problem);
    const unsigned form = !field->form ? 0 : gm_form_is_state(field->form) ? GM_NEEDS_ALL : GM_NEEDS_FORM;
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

/* ---- short runs: forward and back, for conserved quantities, and on finer and finer grids ---- */

static const struct gm_settings no_settings;

enum { RUN_STEPS = 61 }; /* most steps of a run from a system's own start */

/* An equation on which a scheme is certified. */
struct subject {
    struct gm_problem problem;
    const struct gm_scheme *scheme;
    double dt;
    struct gm_run *run; /* opened by begin_run; the caller closes it */
};

/* The number of values of the field in a state: u, or all components, without those that only a two-step
   scheme holds. */
static size_t numbers_of(const struct gm_problem *problem)
{
    return problem->n == gm_wave_size(problem->line.points) ? problem->line.points : problem->n;
}

/* The largest magnitude of the field; 1 if it is less. */
static double field_size(const struct gm_problem *problem, const double *y)
{
    double size = 1;
    for (size_t i = 0; i < numbers_of(problem); i++) {
        size = fmax(size, fabs(y[i]));
    }
    return size;
}

/* Opens a run from the state y at time 0. Returns false when out of memory. */
static bool begin_run(struct subject *subject, const double *y)
{
    subject->run = gm_run_open(&subject->problem, subject->scheme, &no_settings, 0, subject->dt, y);
    return subject->run != NULL;
}

/* Returns true if a component has a rate of its own. The others follow by slopes and sums, with round-off
   and, if they begin as sums, with the errors of these. */
static bool moves(const struct gm_problem *problem, size_t component)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    const bool all = gm_form_is_state(form);
    bool rate = !all;
    for (size_t row = 0; all && row < form->dimension; row++) {
        rate = rate || form->m[row * form->dimension + component] != 0;
    }
    for (size_t k = 0; all && k < form->potential_count; k++) {
        rate = rate && form->potentials[k].component != component;
    }
    return rate;
}

/* The largest difference of two states at common nodes: `other` has `finer` nodes for each of the
   problem's. */
static double apart(const struct gm_problem *problem, const double *y, const double *other, size_t finer)
{
    const size_t points = problem->line.points, components = numbers_of(problem) / points;
    double largest = 0;
    for (size_t c = 0; c < components; c++) {
        for (size_t i = 0; i < points && moves(problem, c); i++) {
            largest = gm_larger(fabs(y[c * points + i] - other[finer * (c * points + i)]), largest);
        }
    }
    return largest;
}

/* Forth 8 steps, back 7: the distance from the level after the first. Two-step schemes come back along their
   levels. */
static double return_defect(struct subject *subject, const double *y)
{
    const size_t numbers = numbers_of(&subject->problem);
    double *first = malloc(numbers * sizeof *first), largest = INFINITY;
    if (first && begin_run(subject, y)) {
        gm_run_advance(subject->run, 1);
        memcpy(first, gm_run_state(subject->run), numbers * sizeof *first);
        gm_run_advance(subject->run, 7);
        gm_run_set_step(subject->run, -subject->dt);
        if (gm_run_advance(subject->run, 7) == GM_OK) {
            largest = apart(&subject->problem, gm_run_state(subject->run), first, 1);
        }
        gm_run_close(subject->run);
    }
    free(first);
    return largest;
}

/* The factor of a number in slopes in space and time. */
static double slopes_of(const struct subject *subject)
{
    return 1 + 1 / fabs(subject->dt) + 1 / subject->problem.line.dx;
}

/* A bound of the round-off in slopes in space and time of a state, multiplied by a scheme's equations. */
static double round_off(const struct subject *subject, const double *y)
{
    enum { MULTIPLIED = 100 };
    return MULTIPLIED * DBL_EPSILON * field_size(&subject->problem, y) * slopes_of(subject);
}

/* Notes a defect; one below `hidden`, the round-off, refutes no claim. */
static void note(struct gm_certificate *certificate, enum gm_claim claim, double defect, double hidden,
                 const char *name)
{
    if (defect > gm_certificate_claim(certificate, claim)->tolerance && defect < hidden) {
        gm_certificate_withhold(
            certificate, claim,
            "round-off hides it: the numbers are too large for so short a dt or so fine a grid");
    } else {
        gm_certificate_note(certificate, claim, defect, name);
    }
}

/* Notes the defects of symmetry, after 8 steps forth and 7 back, of numbers of this size, and of the
   multisymplectic law after 25 steps, where the scheme has one. */
static void note_form(struct gm_certificate *certificate, struct subject *subject, const double *y,
                      double size)
{
    /* tangents are differences over so much of a unit wave, of which the law takes slopes again; solves of
       steps that are long beside dx add as much as ten times that */
    const double over = 0.05 / 8 / 10;
    const char *const name = subject->problem.name;
    note(certificate, GM_SYMMETRIC, return_defect(subject, y) / size, round_off(subject, y) / size, name);
    if (!begin_run(subject, y)) {
        return;
    }
    gm_run_advance(subject->run, 25);
    const double *const now = gm_run_state(subject->run);
    const double defect =
        gm_form_residual((struct gm_law){&subject->problem, subject->scheme, subject->dt, now,
                                         gm_run_memory(subject->run), .by_differences = true});
    if (!isnan(defect)) {
        gm_certificate_claim(certificate, GM_MULTISYMPLECTIC)->tolerance = 1e-8;
        note(certificate, GM_MULTISYMPLECTIC, defect, round_off(subject, now) * slopes_of(subject) / over,
             name);
    } else if (subject->scheme->family->form) {
        gm_certificate_withhold(certificate, GM_MULTISYMPLECTIC,
                                "the step could not be differentiated at this state");
    }
    gm_run_close(subject->run);
}

/* Notes the relative change of a quantity from the state after one step over 60 more, INFINITY if a step
   fails, under the name of what is kept. Like the law it is withheld where round-off alone may have made
   it. */
static void note_change(struct gm_certificate *certificate, enum gm_claim claim, struct subject *subject,
                        const double *y, const struct gm_kept *kept, const char *name)
{
    double change = INFINITY;
    if (begin_run(subject, y)) {
        gm_run_advance(subject->run, 1);
        const double before =
            kept->value(kept->data, gm_run_state(subject->run), gm_run_memory(subject->run));
        if (gm_run_advance(subject->run, RUN_STEPS - 1) == GM_OK) {
            const double after =
                kept->value(kept->data, gm_run_state(subject->run), gm_run_memory(subject->run));
            change = fabs(after - before) / fmax(1, fabs(before));
        }
        gm_run_close(subject->run);
    }
    note(certificate, claim, change, round_off(subject, y), name);
}

/* The order in time on one grid from the differences between runs with dt, dt/2 and dt/4; NaN: one fails. */
static double order_in_time(const struct subject *subject, const double *y, double until)
{
    const size_t n = subject->problem.n;
    double *end = calloc(3 * n, sizeof *end), change[2] = {0};
    bool made = end != NULL;
    for (int k = 0; made && k < 3; k++) {
        const struct gm_trial trial = {&subject->problem, subject->scheme, &no_settings,
                                       ldexp(subject->dt, -k), (int64_t)lround(until / subject->dt) << k};
        made = gm_trial_advance(&trial, y, end + (size_t)k * n);
    }
    for (size_t k = 0; made && k < 2; k++) {
        change[k] = gm_distance(end + k * n, end + (k + 1) * n, subject->problem.line.points);
    }
    free(end);
    return made ? gm_log2(change[0] / change[1]) : NAN;
}

enum { LEVELS = 4, STEPS = 16 };

/* The errors of runs, and by how much each differs from the next finer one. */
struct refined {
    double dt[LEVELS], error[LEVELS], change[LEVELS]; /* error: NaN without an exact solution */
    size_t count;
};

/* Adds a level; returns its state, which the caller frees. NULL if a step fails or when out of memory. */
static double *refine(const struct gm_certified_system *system, const struct gm_scheme *scheme,
                      struct refined *refined)
{
    const size_t k = refined->count;
    const int64_t steps = (int64_t)STEPS << k;
    const struct gm_trial trial = {system->problem, scheme, &no_settings, system->dt, steps};
    double *end = malloc(system->problem->n * sizeof *end);
    if (!end || !gm_trial_advance(&trial, system->start, end)) {
        free(end);
        return NULL;
    }
    refined->dt[k] = system->dt;
    refined->error[k] =
        system->error ? system->error(system->error_data, (double)steps * system->dt, end) : NAN;
    refined->count++;
    return end;
}

/* An exact solution closes on its ring up to a thousandth of its size. If that hides the remaining error,
   differences give the order. */
static double tell(const struct refined *refined, double by_differences, double wanted, double size,
                   struct gm_ladder *ladder, const char **reason)
{
    const size_t last = refined->count - 1;
    const double by_errors = gm_log2(refined->error[last - 1] / refined->error[last]);
    const bool exactly =
        by_errors > wanted || refined->error[last] > 2 * refined->change[last - 1] + 1e-3 * size;
    ladder->count = exactly ? last + 1 : last;
    for (size_t k = 0; k < ladder->count; k++) {
        ladder->dt[k] = refined->dt[k];
        ladder->error[k] = exactly ? refined->error[k] : refined->change[k];
    }
    ladder->settled = true;
    *reason = exactly && by_errors < wanted && by_differences > by_errors + 0.5
                  ? "runs agree with one another, but not with the solution of exact:"
                  : NULL;
    return exactly ? by_errors : by_differences;
}

/* The largest difference of this order of the start around the ring. */
static double largest_difference(const struct gm_certified_system *system, int order)
{
    const struct gm_grid1 *grid = &system->problem->line;
    const size_t points = grid->points;
    double largest = 0;
    for (size_t c = 0; c < system->problem->n / points; c++) {
        for (size_t i = 0; i < points && moves(system->problem, c); i++) {
            double sum = 0, weight = 1;
            for (int j = 0; j <= order; j++) {
                const size_t node = i + (size_t)j;
                sum += weight *
                       (system->start[c * points + node % points] + grid->jump * (double)(node / points));
                weight *= -(double)(order - j) / (j + 1);
            }
            largest = fmax(fabs(sum), largest);
        }
    }
    return largest;
}

/* Returns true if a start has the derivatives that an order needs: if one jumps, differences fall by less
   from grid to grid. */
static bool is_smooth(const struct gm_certified_system *coarse, const struct gm_certified_system *fine,
                      int order)
{
    const int differences = order + 2;
    const double on_coarse = largest_difference(coarse, differences),
                 on_fine = largest_difference(fine, differences),
                 round_off = ldexp(8 * DBL_EPSILON, differences) * field_size(fine->problem, fine->start);
    return on_fine <= round_off || gm_log2(on_coarse / on_fine) > differences - 0.5;
}

/* The order over 16 steps, from a system and its refinements: the slope of the error if the exact solution
   closes on the ring, else of the differences between a run and the next finer one. NaN with *reason if it
   cannot be measured, or is low because the start lacks derivatives. *reason is also set if the exact
   solution alone refutes it; else NULL. */
static double order_on_finer_grids(const struct gm_certified_system *system, const struct gm_scheme *scheme,
                                   struct gm_ladder *ladder, const char **reason)
{
    const double wanted = scheme->order - 0.15;
    struct refined refined = {.count = 0};
    double *before = NULL, size = 1, order = NAN, slope_before = NAN;
    const struct gm_certified_system *coarse = NULL;
    bool smooth = true;
    *reason =
        "differences between runs on finer and finer grids do not fall by one power: take more points and a "
        "shorter dt, or a start that closes better on its ring";
    for (; system && refined.count < LEVELS && isnan(order); system = system->finer) {
        const size_t k = refined.count;
        double *state = refine(system, scheme, &refined);
        if (!state) {
            *reason = "a run on a finer grid fails";
            break;
        }
        if (k == 0) {
            size = field_size(system->problem, system->start);
        } else {
            const double change = apart(coarse->problem, before, state, 2);
            const double slope = k > 1 ? gm_log2(refined.change[k - 2] / change) : NAN;
            refined.change[k - 1] = change;
            if (change < 1e-11 * size) {
                *reason = "differences between runs on finer grids do not exceed round-off";
                free(state);
                break;
            }
            /* an order above that which is claimed may be one of grids that are too coarse for it */
            const double by_errors = gm_log2(refined.error[k - 1] / refined.error[k]);
            const bool told = fabs(by_errors - scheme->order) < 0.15 || fabs(slope - scheme->order) < 0.15 ||
                              fabs(slope - slope_before) < 0.15 ||
                              (slope > wanted && (k + 1 == LEVELS || !system->finer));
            if (told) {
                order = tell(&refined, slope, wanted, size, ladder, reason);
                smooth = !(order < wanted) || is_smooth(coarse, system, scheme->order);
            }
            slope_before = slope;
        }
        coarse = system;
        free(before);
        before = state;
    }
    free(before);
    if (!smooth) {
        *reason = "the start, or the way it closes on its ring, is not as smooth as the order asks for";
        *ladder = (struct gm_ladder){0};
        return NAN;
    }
    return order;
}

static void note_kept(struct gm_certificate *certificate, enum gm_claim claim, struct subject *subject,
                      const double *y, double (*value)(const struct gm_problem *problem, const double *y))
{
    const struct gm_invariant invariant = {value, &subject->problem};
    const struct gm_kept kept = {.value = gm_invariant_value, .data = &invariant};
    note_change(certificate, claim, subject, y, &kept, subject->problem.name);
}

/* ---- on the program's own equations ---- */

/* dx sum of u */
static double kdv_mass(const struct gm_problem *problem, const double *y)
{
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += y[i];
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

/* The value at node i that the original frame sees of a run. Nodes that rest in the frame have travelled over whole nodes of
   the original one. */
static double seen(const struct gm_run *run, size_t i)
{
    const struct gm_framed *framed = gm_framed_of(run->problem);
    const struct gm_grid1 *line = &run->problem->line;
    const bool rests = gm_frame_rests(framed, run->scheme);
    const long travelled = rests ? lround(framed->lambda * run->t / line->dx) : 0;
    return gm_moving_frames_of(run->problem)
        ->seen(framed, rests, gm_grid1_node(line, i), run->t,
               gm_run_state(run)[(i + (size_t)travelled) % line->points]);
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
    const char *file;                /* of share/systems, or of share/subjects with a multisymplectic form */
    const char *name;                /* in certificates; NULL: the problem has it */
    struct gm_system_value given[3]; /* of the file's values */
    bool (*meant)(const struct gm_scheme *scheme); /* NULL: for every scheme that fits */
    struct gm_grid1 line;
    double dt, until;
    int power; /* dt falls as this power of dx, and errors give the order in space and time; 0: order in time
                  alone */
    enum gm_claim claim;
    double (*kept)(const struct gm_problem *problem, const double *y);
};

#define SINE_GORDON                                                                                          \
    .file = "sine-gordon", .name = "sine-Gordon", .given = {{"frequency", "0.6"}}, .until = 4, .power = 1,   \
    .claim = GM_KEEPS_ENERGY, .kept = gm_wave_energy
#define KDV                                                                                                  \
    .file = "kdv", .given = {{"initial", "soliton"}, {"position", "0"}},                                     \
    .line = {.points = 200, .dx = 0.2, .first = -20}, .until = 1, .claim = GM_KEEPS_LINEAR, .kept = kdv_mass
#define NLS                                                                                                  \
    .file = "nls", .given = {{"initial", "soliton"}, {"position", "0"}},                                     \
    .line = {.points = 300, .dx = 40.0 / 300, .first = -20}, .until = 1, .claim = GM_KEEPS_QUADRATIC,        \
    .kept = nls_charge

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
     .name = "nonlinear Dirac",
     .line = {.points = 361, .dx = 60.0 / 361, .first = -30},
     .dt = 0.05,
     .until = 4,
     .power = 1},
    {.file = "burgers",
     .given = {{"viscosity", "0.1"}, {"a", "-0.3"}, {"d", "0.2"}},
     .line = {.points = 81, .dx = 0.05, .first = -2},
     .dt = 0.002,
     .until = 0.2},
    {.file = "heat", .line = {.points = 81, .dx = 0.1, .first = -4}, .dt = 0.002, .until = 0.2},
};

/* The problem of a file and its start. */
struct opened {
    struct gm_user_system system;
    struct gm_user_wave wave; /* only the member of the system's kind is used */
    struct gm_user_form form;
    struct gm_user_equation equation;
    struct gm_problem problem;
    double *start;
};

static void close_equation(struct opened *opened)
{
    gm_user_line_close(&opened->problem);
    gm_system_close(&opened->system);
    free(opened->start);
}

static bool open_problem(struct opened *opened, const struct gm_grid1 *line, const double *values)
{
    struct gm_user_system *system = &opened->system;
    switch (system->kind) {
    case GM_FIELD:
        return gm_user_wave_derive(&opened->wave, system) &&
               gm_user_wave_open(&opened->problem, &opened->wave, values, line);
    case GM_MATRICES:
        return gm_user_form_derive(&opened->form, system) &&
               gm_user_form_open(&opened->problem, &opened->form, values, line);
    default:
        return gm_user_equation_derive(&opened->equation, system) &&
               gm_user_equation_open(&opened->problem, &opened->equation, values, line);
    }
}

/* Opens an equation on a grid that is twice as fine `finer` times, in a frame with the velocity lambda if it has such
   frames, with the exact state at 0, or at 0 and dt. Returns false when out of memory; the caller closes it in both cases. */
static bool open_equation(struct opened *opened, const struct equation *equation, const char *lambda,
                          int finer)
{
    struct gm_system_value values[GM_COUNT(equation->given) + 1];
    struct gm_grid1 line = equation->line;
    size_t count = 0;
    for (; count < GM_COUNT(equation->given) && equation->given[count].name; count++) {
        values[count] = equation->given[count];
    }
    values[count] = (struct gm_system_value){"lambda", lambda};
    line.points <<= finer;
    line.dx = ldexp(line.dx, -finer);
    *opened = (struct opened){.start = NULL};
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SYSTEM, equation->file);
    file = file ? file : gm_built_in_find(GM_FILE_SUBJECT, equation->file);
    struct gm_fault fault;
    struct gm_problem *problem = &opened->problem;
    if (!gm_equations_open(&opened->system, file->text, file->length, values, count + (lambda != NULL),
                           &fault)) {
        return false;
    }
    double *numbers = gm_equations_start(&opened->system, NULL);
    const bool ready = numbers && open_problem(opened, &line, numbers);
    free(numbers);
    opened->start = ready ? calloc(problem->n, sizeof *opened->start) : NULL;
    if (!opened->start) {
        return false;
    }
    problem->name = equation->name ? equation->name : problem->name;
    if (gm_field_of(problem)->wave || gm_field_of(problem)->equation == GM_NEEDS_KDV) {
        gm_user_line_levels(problem->parameters, &line, ldexp(equation->dt, -finer * equation->power),
                            opened->start);
    } else {
        gm_user_line_start(problem->parameters, &line, opened->start);
    }
    const struct gm_moving_frames *frames = gm_moving_frames_of(problem);
    if (frames && frames != &gm_frames_of_kdv) {
        ((struct gm_framed *)problem->parameters)->frame = GM_FRAME_MOVING;
    }
    return true;
}

/* The largest difference of the field from the exact solution; INFINITY for a failure. */
static double error_of(const struct equation *equation, struct subject *subject, const double *y)
{
    double largest = INFINITY;
    if (begin_run(subject, y)) {
        largest = gm_run_until(subject->run, equation->until) == GM_OK ? 0 : INFINITY;
        for (size_t i = 0; i < subject->problem.line.points; i++) {
            const double x = gm_grid1_node(&subject->problem.line, i),
                         exact = gm_user_line_exact(subject->problem.parameters, 0, x, equation->until);
            largest = fmax(largest, fabs(gm_run_state(subject->run)[i] - exact));
        }
        gm_run_close(subject->run);
    }
    return largest;
}

/* The difference between a run and one from the moving frame, or the defect of a step under a symmetry if
   it is larger; INFINITY for a failure. */
static double frame_defect(const struct equation *equation, const struct subject *subject, const double *y)
{
    const struct gm_moving_frames *frames = gm_moving_frames_of(&subject->problem);
    const bool projects = frames != &gm_frames_of_heat || frames->are_special(subject->scheme);
    const struct gm_point_symmetry symmetry = {.boost = 0.5, .projection = projects ? 0.5 : 0, .scale = 1.3};
    struct opened boosted;
    const bool opened = open_equation(&boosted, equation, "2", 0);
    struct subject rest = *subject, moving = *subject;
    moving.problem = boosted.problem;
    double largest = INFINITY;
    const bool begun = begin_run(&rest, y);
    if (opened && begun && begin_run(&moving, boosted.start)) {
        if (gm_run_until(rest.run, equation->until) == GM_OK &&
            gm_run_until(moving.run, equation->until) == GM_OK) {
            largest = 0;
            for (size_t i = 0; i < subject->problem.line.points; i++) {
                largest = gm_larger(fabs(seen(moving.run, i) - seen(rest.run, i)), largest);
            }
            largest =
                fmax(largest, frames->defect(&subject->problem, subject->scheme, subject->dt, &symmetry, y));
        }
        gm_run_close(moving.run);
    }
    gm_run_close(rest.run);
    close_equation(&boosted);
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

static void measure_claims(struct gm_certificate *certificate, const struct equation *equation,
                           struct subject *subject, const double *y)
{
    if (equation->kept) {
        note_kept(certificate, equation->claim, subject, y, equation->kept);
    }
    if (gm_field_of(&subject->problem)->form) {
        note_form(certificate, subject, y, 1);
    }
    gm_certificate_note_same(certificate, &subject->problem, &no_settings, subject->dt, y);
    if (gm_moving_frames_of(&subject->problem)) {
        gm_certificate_note(certificate, GM_EQUIVARIANT, frame_defect(equation, subject, y),
                            subject->problem.name);
    }
}

static void measure(struct gm_certificate *certificate, const struct equation *equation,
                    const struct opened *opened, double *farthest)
{
    struct subject subject = {.problem = opened->problem, .scheme = certificate->scheme, .dt = equation->dt};
    measure_claims(certificate, equation, &subject, opened->start);
    double order = NAN;
    if (equation->power > 0) {
        const double coarse = error_of(equation, &subject, opened->start);
        struct opened finer;
        if (open_equation(&finer, equation, "0", 1)) {
            subject.problem = finer.problem;
            subject.dt = ldexp(equation->dt, -equation->power);
            order = gm_log2(coarse / error_of(equation, &subject, finer.start));
        }
        close_equation(&finer);
    } else {
        order = order_in_time(&subject, opened->start, equation->until);
    }
    note_order(certificate, farthest, order, opened->problem.name);
}

/* Measures the claims of a scheme for fields on a line, on every equation that it fits. */
static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    const char *measured = "";
    double farthest = -1;
    for (size_t i = 0; i < GM_COUNT(equations); i++) {
        const struct equation *equation = &equations[i];
        struct opened opened;
        if (strcmp(equation->file, measured) == 0 || (equation->meant && !equation->meant(scheme))) {
            continue;
        }
        if (open_equation(&opened, equation, "0", 0) && gm_scheme_fits(scheme, &opened.problem)) {
            measured = equation->file;
            measure(certificate, equation, &opened, &farthest);
        }
        close_equation(&opened);
    }
    certificate->order_holds = farthest >= 0 && farthest < 0.15;
}

/* ---- on a given equation ---- */

/* The energy of a form, which is of a scheme's own kind. */
static double form_energy(const void *subject, const double *y, const double *memory)
{
    const struct subject *of = subject;
    (void)y; /* the memory holds the stages that lead to it */
    return gm_form_energy(&of->problem, of->scheme, memory);
}

/* The reason why steps of this length cannot test a claim, or NULL. */
static const char *no_steps(struct subject *subject, const double *y)
{
    if (fabs(subject->dt) > gm_wave_longest_step(&subject->problem, subject->scheme, y)) {
        return "dt is beyond the longest step of linear theory (longest_step): take a shorter one";
    }
    bool made = begin_run(subject, y);
    if (made) {
        made = gm_run_advance(subject->run, RUN_STEPS) == GM_OK;
        gm_run_close(subject->run);
    }
    return made ? NULL : "a run of steps of this dt fails: take a shorter one";
}

/* Measures the order and the properties of a user-defined equation: symmetry and the multisymplectic law,
   the energy, and the conserved quantities that the system lists. */
static void certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate)
{
    struct subject subject = {.problem = *system->problem, .scheme = scheme, .dt = system->dt};
    const struct gm_field *field = gm_field_of(system->problem);
    const double *const y = system->start, size = field_size(system->problem, y);
    const size_t n = system->problem->n,
                 levels = n % 2 == 1 && n == gm_wave_size(system->problem->line.points);
    const char *const name = system->problem->name;
    const char *const failing =
        field->equation ? "without --on it is measured on this equation" : no_steps(&subject, y);
    certificate->order_problem = name;
    certificate->order_reason = failing;
    if (!failing) {
        certificate->order =
            order_on_finer_grids(system, scheme, &certificate->ladder, &certificate->order_reason);
        note_form(certificate, &subject, y, size);
        gm_certificate_note_same(certificate, &subject.problem, &no_settings, subject.dt, y);
        if (field->wave) {
            note_kept(certificate, GM_KEEPS_ENERGY, &subject, y, gm_wave_energy);
        } else if (gm_form_is_state(field->form)) {
            const struct gm_kept energy = {.value = form_energy, .data = &subject};
            note_change(certificate, GM_KEEPS_ENERGY, &subject, y, &energy, name);
        }
        for (size_t i = 0; i < system->kept_count; i++) {
            /* along directions that a scheme's own last number takes no part in */
            const unsigned claims = gm_kept_claims(&system->kept[i], y, n, n - levels, size, NULL);
            if (claims & (GM_KEEPS_LINEAR | GM_KEEPS_QUADRATIC)) {
                note_change(certificate, claims & GM_KEEPS_LINEAR ? GM_KEEPS_LINEAR : GM_KEEPS_QUADRATIC,
                            &subject, y, &system->kept[i], system->kept[i].name);
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
