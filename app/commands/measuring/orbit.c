/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint orbit: a periodic orbit of a flow or of a scheme's map, and its multipliers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/data/save.h"
#include "app/output/folder.h"
#include "app/output/say.h"
#include "app/words/drive.h"
#include "app/words/system.h"
#include "core/arena.h"
#include "core/expression/nearest.h"
#include "core/expression/number.h"
#include "core/expression/reader.h"
#include "core/functions/functions.h"
#include "core/memory.h"
#include "core/ode/indicators/periodic.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/action.h"
#include "core/quantity.h"
#include "core/schemes.h"
#include "render/files/temporary.h"

enum { MOST_RETURN = 1000000 /* steps until the first return */, MOST_STEPS = 1000000000 };

struct work {
    const struct gm_options *options;
    struct gm_arguments *words; /* without those of the command */
    const char *period, *held;  /* the words period= and fix=, or NULL */
    struct gm_request *request;
    const struct gm_lane *lane;
    struct gm_periodic orbit;
};

/* Takes period= and fix= from the words. */
static void read_words(struct work *work)
{
    const struct gm_arguments *typed = &work->options->arguments;
    work->words = gm_arguments_in(work->options->arena);
    for (int i = 0; i < typed->count; i++) {
        const char *word = typed->words[i];
        if (i > 0 && strncmp(word, "period=", 7) == 0) {
            work->period = word + 7;
        } else if (i > 0 && strncmp(word, "fix=", 4) == 0) {
            work->held = word + 4;
        } else {
            gm_arena_need(work->options->arena, gm_arguments_add(work->words, word));
        }
    }
}

static bool is_typed(const struct work *work, const char *key)
{
    const char *word = gm_arguments_find(work->words, key);
    return word && strncmp(word, key, strlen(key)) == 0;
}

static const char *component_of(size_t component, const void *work)
{
    const struct work *of = work;
    return gm_component_name(of->options->arena, of->lane->run, component);
}

/* Ends the command if the lane has no periodic orbits that can be followed. */
static void check_lane(const struct work *work)
{
    const struct gm_options *options = work->options;
    const struct gm_problem *problem = &work->lane->problem;
    const struct gm_scheme *scheme = work->orbit.scheme;
    const char *why = problem->kind != &gm_kind_ode ? "it is not a system of ordinary differential equations"
                      : problem->m > 1              ? "it has several members; members=1 has one"
                      : problem->n - 2 * problem->passive > GM_NEWTON_LARGEST
                          ? "it has more than 64 components"
                      : gm_action_constraints(problem) > 0 ? "it has constraints"
                                                           : NULL;
    gm_command_end_if(options, why, GM_EXIT_USAGE, "orbit does not follow %s: %s", work->lane->scene->name,
                      why);
    gm_command_end_if(options, !gm_scheme_fits(scheme, problem), GM_EXIT_USAGE,
                      "%s does not fit %s; scheme= names another", scheme->name, work->lane->scene->name);
    gm_command_end_if(
        options, strcmp(gm_tangent_word(scheme), "none") == 0 || scheme->family->adaptive, GM_EXIT_USAGE,
        "the step size of %s varies or its state is hidden, so its map has no derivative; take gauss8",
        scheme->name);
}

/* Returns why the steps from the start to some time fail, as a part of a sentence; "" if they do not. */
static const char *failure_of(const struct work *work, int64_t steps)
{
    char sentence[GM_MESSAGE] = "";
    if (gm_run_advance(work->lane->run, steps) != GM_OK) {
        gm_failure_sentence(work->lane, sentence, sizeof sentence);
    }
    return gm_arena_print(work->options->arena, "%s", sentence);
}

/* The period of equations that contain t is one of their right side. */
static void check_period(const struct work *work)
{
    const struct gm_periodic *orbit = &work->orbit;
    struct gm_period_miss miss;
    if (gm_has_time(orbit->problem) && !gm_period_fits(orbit, &miss)) {
        gm_command_end(
            work->options, GM_EXIT_USAGE,
            "%.10g%s is not a period of the equations: at the same state the rate of %s is %.6g at "
            "t = %.6g, and %.6g a period later",
            orbit->period, work->period ? "" : ", which is steps times dt,",
            component_of(miss.component, work), miss.rates[0], miss.t, miss.rates[1]);
    }
}

/* Sets the period and the steps, before they are refined. */
static void choose_period(struct work *work, struct gm_problem *problem)
{
    const struct gm_options *options = work->options;
    struct gm_periodic *orbit = &work->orbit;
    const bool map = is_typed(work, "steps=");
    const double dt = work->lane->run->dt;
    orbit->free = !map && !gm_has_time(problem);
    orbit->refined = !map && !is_typed(work, "scheme=");
    gm_command_end_if(
        options, map && (work->period || work->held), GM_EXIT_USAGE,
        "%s= is a word of the flow; the orbit of a map has steps= and dt=", work->period ? "period" : "fix");
    gm_command_end_if(options, work->held && !orbit->free, GM_EXIT_USAGE,
                      "fix= holds a component of autonomous equations; these contain t");
    if (work->period) {
        gm_command_end_if(options,
                          !gm_number_parse(work->period, &orbit->period) || !(orbit->period > 0) ||
                              !isfinite(orbit->period),
                          GM_EXIT_USAGE, "period=%.60s is not a number above 0", work->period);
    } else if (map) {
        orbit->steps = work->request->lanes[0].steps;
        orbit->period = (double)orbit->steps * dt;
        gm_command_end_if(options, orbit->steps < 1, GM_EXIT_USAGE,
                          "the orbit of a map has at least one step");
        check_period(work);
        return;
    } else {
        gm_command_end_if(options, !orbit->free, GM_EXIT_USAGE,
                          "the equations contain t: period= gives the period of their right side");
        gm_command_end_if(options, gm_start_rests(orbit, dt), GM_EXIT_NUMERICAL,
                          "the start is an equilibrium, where f is 0: an orbit moves; start elsewhere");
        /* a motion that nears an orbit does so in a tenth of them, and returns from there */
        orbit->period = gm_first_return(orbit, dt, work->held ? MOST_RETURN : MOST_RETURN / 10);
        if (isnan(orbit->period) && !work->held) {
            orbit->period = gm_first_return(orbit, dt, MOST_RETURN);
        }
        const char *failure = isnan(orbit->period) ? failure_of(work, 2 * MOST_RETURN) : "";
        gm_command_end_if(options, failure[0], GM_EXIT_NUMERICAL, "the motion ends before it returns: %s",
                          failure);
        gm_command_end_if(options, isnan(orbit->period), GM_EXIT_NUMERICAL,
                          "the motion does not return to the plane through its start normal to f; start "
                          "closer to the orbit, or give its period=");
    }
    const double steps = fmax(1, round(orbit->period / dt));
    gm_command_end_if(options, !(steps <= MOST_STEPS), GM_EXIT_USAGE,
                      "a period of %g has more than %d steps of dt=%g: give a longer dt=", orbit->period,
                      MOST_STEPS, dt);
    orbit->steps = (int64_t)steps;
    check_period(work);
}

/* The value of an invariant in a state near the start. */
static double invariant_at(const struct gm_lane *lane, const struct gm_observable *row, const double *y)
{
    struct gm_view view = gm_lane_view(lane);
    view.state = y;
    return gm_observe(row, &view);
}

/* Writes the gradient of an invariant at the start, of length 1, or 0 where it vanishes: where the invariant differs from
   its value at the start by less than a millionth of what it differs farther away. */
static void find_gradient(const struct work *work, const struct gm_observable *row, double *gradient)
{
    const double *start = work->orbit.start, there = invariant_at(work->lane, row, start);
    const size_t n = work->orbit.problem->n;
    double *y = gm_arena_take(work->options->arena, n, sizeof *y), size = 0, square = 0, away = 0;
    memcpy(y, start, n * sizeof *y);
    for (size_t c = 0; c < n; c++) {
        size = fmax(size, fabs(start[c]));
    }
    size = size > 0 ? size : 1;
    for (size_t c = 0; c < n; c++) {
        const double h = 1e-4 * size;
        y[c] = start[c] + h;
        const double above = invariant_at(work->lane, row, y);
        y[c] = start[c] - h;
        gradient[c] = (above - invariant_at(work->lane, row, y)) / 2e-4;
        y[c] = start[c] + size / 4;
        away = fmax(away, fabs(invariant_at(work->lane, row, y) - there));
        y[c] = start[c];
        square += gradient[c] * gradient[c];
    }
    for (size_t c = 0; c < n; c++) {
        gradient[c] = sqrt(square) > 1e-6 * away ? gradient[c] / sqrt(square) : 0;
    }
}

/* The rank of `count` rows of n numbers of at most length 1, which it makes orthogonal. */
static size_t rank_of(double *rows, size_t count, size_t n)
{
    size_t rank = 0;
    for (size_t i = 0; i < count; i++) {
        double *row = rows + i * n;
        double square = 0;
        for (size_t k = 0; k < rank; k++) {
            double along = 0;
            for (size_t c = 0; c < n; c++) {
                along += row[c] * rows[k * n + c];
            }
            for (size_t c = 0; c < n; c++) {
                row[c] -= along * rows[k * n + c];
            }
        }
        for (size_t c = 0; c < n; c++) {
            square += row[c] * row[c];
        }
        for (size_t c = 0; c < n && square > 1e-10; c++) {
            rows[rank * n + c] = row[c] / sqrt(square);
        }
        rank += square > 1e-10;
    }
    return rank;
}

/* The multipliers that are 1 by the structure of a flow: one of its direction, and one of each independent invariant. Of a
   Hamiltonian flow, whose energy is among them, each invariant also has a flow that keeps the others with which it is in
   involution, so that k invariants whose brackets have rank r give 2 k - r. Invariants whose gradients vanish on the
   orbit, or depend on those of others, give nothing. K. R. Meyer, G. R. Hall & D. Offin, Introduction to Hamiltonian
   Dynamical Systems (2009), chapter 9. */
static size_t structure_of(const struct work *work)
{
    const struct gm_scene *scene = work->lane->scene;
    const struct gm_periodic *orbit = &work->orbit;
    const size_t n = orbit->problem->n, half = n / 2;
    const bool hamiltonian = orbit->problem->kind->facets(orbit->problem) & GM_NEEDS_ENERGY && n % 2 == 0;
    const struct gm_events *events = work->lane->problem.events; /* they may change the energy */
    struct gm_arena *arena = work->options->arena;
    double *gradients = gm_arena_take(arena, scene->observable_count * n, sizeof *gradients);
    size_t count = 0;
    if (!orbit->free) {
        return 0;
    }
    for (size_t i = 0; i < scene->observable_count && !(events && events->changes); i++) {
        if (scene->observables[i].error && scene->observables[i].kept) {
            find_gradient(work, &scene->observables[i], gradients + count++ * n);
        }
    }
    const size_t rank = rank_of(gradients, count, n);
    if (!hamiltonian || rank == 0) {
        return 1 + rank < n ? 1 + rank : n;
    }
    double *brackets = gm_arena_take(arena, rank * rank, sizeof *brackets);
    for (size_t i = 0; i < rank * rank; i++) {
        const double *f = gradients + i / rank * n, *g = gradients + i % rank * n;
        for (size_t c = 0; c < half; c++) {
            brackets[i] += f[c] * g[half + c] - f[half + c] * g[c];
        }
    }
    const size_t all = 2 * rank - rank_of(brackets, rank, rank);
    return all < n ? all : n;
}

static void open_work(struct work *work, struct gm_problem *problem)
{
    char message[GM_MESSAGE];
    const struct gm_options *options = work->options;
    struct gm_periodic *orbit = &work->orbit;
    gm_command_end_if(options, options->arguments.count == 0, GM_EXIT_USAGE,
                      "orbit of which system? See geomint list systems");
    read_words(work);
    work->request = gm_command_parse(options, work->words->count, work->words->words, GM_RUN_SCHEMES);
    gm_command_end_if(options, work->request->count > 1, GM_EXIT_USAGE,
                      "orbit follows one run; lists of values are for sweep");
    if (!is_typed(work, "scheme=") && !is_typed(work, "steps=") &&
        work->request->lanes[0].scheme->family->kind == &gm_kind_ode) {
        work->request->lanes[0].scheme = gm_scheme_find("gauss8");
    }
    struct gm_lane *lane = gm_request_open_lane(work->request, 0, message);
    work->lane = gm_lane_in(options->arena, lane, message);
    orbit->scheme = work->request->lanes[0].scheme;
    check_lane(work);
    *problem = lane->problem;
    problem->n -= 2 * problem->passive; /* tracers change no motion */
    problem->passive = 0;
    orbit->problem = problem;
    lane->settings.compensated |= !is_typed(work, "scheme=") && !is_typed(work, "steps=");
    orbit->settings = &lane->settings;
    orbit->t0 = lane->t0;
    orbit->start = gm_arena_take(options->arena, problem->n, sizeof(double));
    orbit->multipliers = gm_arena_take(options->arena, 2 * problem->n, sizeof(double));
    memcpy(orbit->start, lane->start, problem->n * sizeof(double));
    orbit->held = SIZE_MAX;
    for (size_t c = 0; work->held && c < problem->n && orbit->held == SIZE_MAX; c++) {
        orbit->held = strcmp(component_of(c, work), work->held) == 0 ? c : SIZE_MAX;
    }
    if (work->held && orbit->held == SIZE_MAX) {
        const char *near = gm_nearest(work->held, problem->n, component_of, work);
        gm_command_end(options, GM_EXIT_USAGE, "fix=%.60s is not a component%s%s", work->held,
                       near ? "; did you mean " : "", near ? near : "");
    }
    choose_period(work, problem);
    orbit->by_structure = structure_of(work);
}

/* ---- the output ---- */

static const char *status_of(const struct gm_periodic *orbit)
{
    static const char *const words[] = {"ok", "no-convergence", "an equilibrium"};
    return words[orbit->status];
}

static void print_json(const struct work *work)
{
    const struct gm_periodic *orbit = &work->orbit;
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "scene %s", work->lane->scene->name);
    gm_meta_source(&row, work->lane->scene);
    gm_row_put(&row, "scheme %s, of %s, status %s, steps %.0f, period %.17g, residual %.17g, iterations %i",
               orbit->scheme->name, orbit->refined || orbit->free ? "flow" : "map", status_of(orbit),
               (double)orbit->steps, orbit->period, orbit->residual, orbit->iterations);
    gm_row_list(&row, "start", orbit->start, orbit->problem->n);
    struct gm_row list = gm_row_open(&row, "multipliers", ']');
    for (size_t i = 0; i < orbit->count; i++) {
        gm_row_list(&list, NULL, (double[]){orbit->multipliers[i], orbit->multipliers[orbit->count + i]}, 2);
    }
    gm_row_put(&row, "by_structure %i, stability %s", (int)orbit->by_structure, gm_periodic_kind(orbit));
    gm_row_close(&row, "\n");
}

/* A number of at most this many digits, without those below its error, but of three. */
static const char *known_digits(const struct work *work, double value, double error, int most)
{
    const double digits = fmin(most, floor(gm_log(fabs(value) / error) / gm_log(10)) + 1);
    return gm_arena_print(work->options->arena, "%.*g", (int)fmax(3, digits), value);
}

/* The multipliers as a text: "285.4037, 1, 1, 0.0035", or pairs "0.5 ± 0.8i". */
static const char *multipliers_of(const struct work *work, int digits)
{
    const struct gm_periodic *orbit = &work->orbit;
    struct gm_arena *arena = work->options->arena;
    const char *text = orbit->count == 0 ? "none" : "";
    for (size_t i = 0; i < orbit->count; i++) {
        const double re = orbit->multipliers[i], im = orbit->multipliers[orbit->count + i],
                     error = gm_multiplier_error(orbit, i);
        if (gm_hypot(re, im) <= error) {
            text = gm_arena_print(arena, "%s%sbelow %.1g", text, i ? ", " : "", error);
        } else if (fabs(im) <= error) {
            text =
                gm_arena_print(arena, "%s%s%s", text, i ? ", " : "", known_digits(work, re, error, digits));
        } else if (im > 0) {
            text = gm_arena_print(arena, "%s%s%s ± %si", text, i ? ", " : "",
                                  fabs(re) > error ? known_digits(work, re, error, digits) : "0",
                                  known_digits(work, im, error, digits));
        }
    }
    return text;
}

static void print_text(const struct work *work)
{
    const struct gm_periodic *orbit = &work->orbit;
    gm_say("%s  %s  %lld step%s", work->lane->scene->name, orbit->scheme->name, (long long)orbit->steps,
           orbit->steps == 1 ? "" : "s");
    printf("  %-20s %s\n  %-20s ", "status", status_of(orbit), "start");
    for (size_t c = 0; c < orbit->problem->n; c++) {
        printf("%s%s = %.17g", c ? ", " : "", component_of(c, work), orbit->start[c]);
    }
    printf("\n  %-20s %.16g\n  %-20s %.3g\n  %-20s %d\n  %-20s %s\n  %-20s %s\n", "period", orbit->period,
           "residual", orbit->residual, "iterations", orbit->iterations, "multipliers",
           multipliers_of(work, 10), "kind", gm_periodic_kind(orbit));
    if (orbit->by_structure > 0 && orbit->count > 0) {
        printf("  %-20s %zu\n", "1 by structure", orbit->by_structure);
    }
}

/* Gives the lane of the request the orbit's start, step and end. Ends the command if its start has no keys. */
static void place_start(const struct work *work)
{
    const struct gm_periodic *orbit = &work->orbit;
    struct gm_lane_spec *spec = &work->request->lanes[0];
    struct gm_timing *timing = spec->parameters;
    for (size_t c = 0; c < orbit->problem->n; c++) {
        const char *name = component_of(c, work);
        const struct gm_parameter *row = gm_scene_parameter(work->request->scene, name);
        gm_command_end_if(work->options, !row && strcmp(name, "t") != 0, GM_EXIT_USAGE,
                          "the start of %s has no key, so --save and -o cannot set it", name);
        if (row) {
            gm_parameter_set(row, spec->parameters,
                             gm_arena_print(work->options->arena, "%.17g", orbit->start[c]));
        }
    }
    timing->dt = orbit->period / (double)orbit->steps;
    timing->until = orbit->period;
}

static int save(const struct work *work)
{
    char message[GM_MESSAGE];
    const char *path = work->options->save;
    char *text = gm_system_now(work->request->scene, work->request->lanes[0].parameters,
                               gm_scheme_word(work->orbit.scheme));
    gm_arena_need(work->options->arena, text);
    gm_arena_keep(work->options->arena, text, free);
    if (!gm_folder_make_for(path, message) || gm_temporary_write(path, text, strlen(text)) != 0) {
        return gm_give_up(GM_EXIT_FILE, "%.360s could not be written", path);
    }
    gm_complain("wrote %s", path);
    return GM_EXIT_OK;
}

static void draw(const void *data, struct gm_picture *picture)
{
    const struct work *work = data;
    const struct gm_lane *lane = work->lane;
    gm_lanes_draw(&lane, 1, picture);
    picture->caption = gm_picture_text(picture, "A periodic orbit, %s: multipliers %s.",
                                       gm_periodic_kind(&work->orbit), multipliers_of(work, 6));
}

static int paint(struct work *work)
{
    char message[GM_MESSAGE];
    const struct gm_options *options = work->options;
    struct gm_lane *lane =
        gm_lane_in(options->arena, gm_request_open_lane(work->request, 0, message), message);
    for (int64_t i = 1; i <= work->orbit.steps && lane->run->status == GM_OK; i++) {
        gm_lane_to(lane, i, INFINITY);
        gm_lane_record(lane);
    }
    work->lane = lane;
    return gm_command_chart(
        options, "orbit",
        &(struct gm_chart){.name = gm_arena_print(options->arena, "%.80s-orbit", lane->scene->name),
                           .data = work,
                           .draw = draw});
}

int gm_command_orbit(const struct gm_options *options)
{
    struct work *work = gm_arena_take(options->arena, 1, sizeof *work);
    struct gm_problem problem;
    *work = (struct work){.options = options};
    gm_command_end_if(options, options->save && !gm_word_ends(options->save, ".system"), GM_EXIT_USAGE,
                      "--save %.300s is not a .system file", options->save);
    open_work(work, &problem);
    gm_catch_interrupts();
    gm_interrupts_end(true);
    /* a step that memory was too short for looks like one that found no solution */
    const unsigned long refusals = gm_memory_refusals();
    const bool found = gm_periodic_find(&work->orbit);
    gm_command_end_if(options, !found || gm_memory_refusals() != refusals, GM_EXIT_MEMORY,
                      "not enough memory");
    gm_interrupts_end(false);
    if (options->json) {
        print_json(work);
    } else if (!gm_options_take_stdout(options)) {
        print_text(work);
    }
    if (work->orbit.status == GM_PERIODIC_EQUILIBRIUM) {
        gm_complain("the motion rests there, or comes to rest: an orbit moves; start farther away%s",
                    work->held ? ", or without fix=" : "");
    } else if (work->orbit.status == GM_PERIODIC_NO_CONVERGENCE) {
        const char *failure = isfinite(work->orbit.residual) ? "" : failure_of(work, work->orbit.steps);
        gm_complain("Newton's method found no orbit that closes: %s",
                    failure[0] ? failure : "start closer to one, or give its period=");
    }
    int status = work->orbit.status == GM_PERIODIC_FOUND ? GM_EXIT_OK : GM_EXIT_NUMERICAL;
    if (status == GM_EXIT_OK && (options->save || options->output || options->out)) {
        place_start(work);
        status = options->save ? save(work) : GM_EXIT_OK;
        status = status == GM_EXIT_OK && (options->output || options->out) ? paint(work) : status;
    }
    return status;
}
