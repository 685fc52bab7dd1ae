/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The events of a user-defined system, by tapes of its components and the time. */
#include "core/events.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/user/data.h"

/* Evaluates a tape of events in `count` looks, which begin with what it needs: the components of the system and the time.
   With frozen switches its inputs are all variables, of which the modes are the last. */
static void tape_values(const struct gm_problem *problem, struct gm_late_tape *tape, const double *modes,
                        const double *looks, size_t count, double *values)
{
    enum { FEW = 256 }; /* more inputs are allocated */
    const struct gm_user_data *self = gm_user_data_of(problem);
    const size_t given = self->model->system->n + 1, own = self->model->system->variable_count,
                 all = tape->inputs * count;
    if (!self->model->frozen) {
        gm_late_tape_values(tape, looks, values, count);
        return;
    }
    double few[FEW], *inputs = all <= FEW ? few : malloc(all * sizeof *inputs);
    for (size_t i = 0; i < tape->count * count && !inputs; i++) {
        values[i] = NAN;
    }
    if (inputs) {
        memcpy(inputs, looks, given * count * sizeof *inputs);
        for (size_t i = given; i < tape->inputs; i++) {
            for (size_t k = 0; k < count; k++) {
                inputs[i * count + k] = i < own ? self->values[i] : modes[i - own];
            }
        }
        gm_late_tape_values(tape, inputs, values, count);
    }
    free(inputs == few ? NULL : inputs);
}

static void values(const struct gm_problem *problem, const double *modes, const double *looks, size_t count,
                   double *g)
{
    tape_values(problem, &gm_user_data_of(problem)->tapes[GM_USER_SURFACES], modes, looks, count, g);
}

static const struct gm_user_event *event_of(const struct gm_problem *problem, size_t event)
{
    const struct gm_user_model *model = gm_user_data_of(problem)->model;
    return event >= model->event_count ? &model->frozen->events[event - model->event_count]
           : model->frozen             ? &model->frozen->model.events[event]
                                       : &model->events[event];
}

/* gm_events.change */
static bool change(const struct gm_problem *problem, size_t event, const double *look, double *y)
{
    const struct gm_user_event *formulas = event_of(problem, event);
    struct gm_late_tape *tape = &gm_user_data_of(problem)->changes[event];
    double *outcome = malloc((tape->count + 1) * sizeof *outcome);
    if (outcome && tape->count > 0) {
        gm_late_tape_values(tape, look, outcome, 1);
    }
    bool all = outcome != NULL;
    for (size_t i = 0; i < formulas->conditions && all; i++) {
        all = outcome[i] > 0;
    }
    for (size_t c = 0; c < problem->n && y; c++) {
        y[c] = look[c];
    }
    for (size_t i = 0; i < formulas->changed && y; i++) {
        y[formulas->components[i]] = outcome ? outcome[formulas->conditions + i] : NAN;
    }
    free(outcome);
    return all;
}

/* The slopes of g, and of the new values, along a vector of components and the time, and the sum of the magnitudes of
   the terms of the first. */
static void slopes_along(const struct gm_problem *problem, size_t event, const double *slopes,
                         const double *v, double *along, double *size)
{
    const struct gm_user_event *formulas = event_of(problem, event);
    *size = 0;
    memset(along, 0, (1 + formulas->changed) * sizeof *along);
    for (size_t i = 0; i < formulas->slopes.count; i++) {
        const struct gm_sparse_entry *entry = &formulas->slopes.entries[i];
        const double term = slopes[i] * v[entry->column];
        along[entry->row] += term;
        *size += entry->row == 0 ? fabs(term) : 0;
    }
}

/* Writes the rates of all components of a motion, and 1 for the time. */
static void field_at(const struct gm_problem *motion, const double *look, double *rates)
{
    gm_field(motion, look, rates, 1);
    rates[gm_user_data_of(motion)->model->system->n] = 1;
}

/* The parts of S. */
struct saltation {
    double *slopes;                /* of the event, malloc'ed with all else */
    double *before, *after, *v;    /* f-, f+ and an error, of components and the time */
    double *along_rates, *along_v; /* slopes_along f- and the error */
    double size;                   /* of the terms of the first of along_rates */
};

/* Takes the memory, and writes what follows from the state before an event of the problem, with these modes, and the motion
   there. Returns false when out of memory. */
static bool open_saltation(const struct gm_problem *problem, const double *modes,
                           const struct gm_problem *motion, size_t event, const double *before,
                           struct saltation *saltation)
{
    const struct gm_user_event *formulas = event_of(problem, event);
    const size_t width = problem->n + 1, rows = 1 + formulas->changed;
    saltation->slopes = malloc((formulas->slopes.count + 3 * width + 2 * rows) * sizeof *saltation->slopes);
    if (!saltation->slopes) {
        return false;
    }
    saltation->before = saltation->slopes + formulas->slopes.count;
    saltation->after = saltation->before + width;
    saltation->v = saltation->after + width;
    saltation->along_rates = saltation->v + width;
    saltation->along_v = saltation->along_rates + rows;
    tape_values(problem, &gm_user_data_of(problem)->event_slopes[event], modes, before, 1, saltation->slopes);
    field_at(motion, before, saltation->before);
    slopes_along(problem, event, saltation->slopes, saltation->before, saltation->along_rates,
                 &saltation->size);
    return true;
}

/* gm_events.rate */
static double rate(const struct gm_problem *problem, const double *modes, const struct gm_problem *motion,
                   size_t event, const double *look, double time)
{
    struct saltation now, later = {0};
    double sum = NAN;
    if (open_saltation(problem, modes, motion, event, look, &now)) {
        for (size_t c = 0; c <= problem->n; c++) {
            now.v[c] = look[c] + time * (c < problem->n ? now.before[c] : 1);
        }
        sum = time == 0                                                      ? now.along_rates[0]
              : open_saltation(problem, modes, motion, event, now.v, &later) ? later.along_rates[0]
                                                                             : NAN;
        free(later.slopes);
    }
    free(now.slopes);
    return sum;
}

/* to := S from, for every tangent that the state holds, or for an error if it holds none. Returns false where the
   motion only touches g = 0, without a cause, or when out of memory. */
static bool carry_all(const struct gm_problem *problem, const struct gm_event_part *part, const double *from,
                      double *to)
{
    const struct gm_user_event *formulas = event_of(problem, part->event);
    const struct gm_user_system *system = gm_user_data_of(problem)->model->system;
    const size_t motion = gm_system_motion(system);
    struct saltation saltation, cause;
    if (part->cause == gm_user_data_of(problem)->events.count ||
        !open_saltation(problem, part->modes, part->ahead, part->event, part->before, &saltation)) {
        return false;
    }
    if (!open_saltation(problem, part->modes, part->ahead, part->cause, part->before, &cause)) {
        free(saltation.slopes);
        return false;
    }
    field_at(part->beyond, part->after, saltation.after);
    const bool passes = fabs(cause.along_rates[0]) > 1e-12 * cause.size;
    for (size_t k = system->tangents > 0; k <= system->tangents && passes; k++) {
        double *v = saltation.v, unused;
        memset(v, 0, (problem->n + 1) * sizeof *v);
        for (size_t c = 0; c < motion; c++) {
            v[gm_system_component(system, c, 0)] = from[gm_system_component(system, c, k)];
        }
        v[system->n] = k == 0 && problem->n > system->n ? from[system->n] : 0;
        slopes_along(problem, part->event, saltation.slopes, v, saltation.along_v, &unused);
        slopes_along(problem, part->cause, cause.slopes, v, cause.along_v, &unused);
        const double late = cause.along_v[0] / cause.along_rates[0];
        for (size_t c = 0, row = 0; c < system->n; c++) {
            const bool changes = row < formulas->changed && formulas->components[row] == c;
            row += changes;
            v[c] = changes ? saltation.along_v[row] + (saltation.after[c] - saltation.along_rates[row]) * late
                           : v[c] + (saltation.after[c] - saltation.before[c]) * late;
        }
        for (size_t c = 0; c < motion; c++) {
            to[gm_system_component(system, c, k)] = v[gm_system_component(system, c, 0)];
        }
    }
    free(cause.slopes);
    free(saltation.slopes);
    return passes;
}

static bool carry(const struct gm_problem *problem, const struct gm_event_part *part, double *v)
{
    return gm_user_data_of(problem)->model->system->tangents == 0 && carry_all(problem, part, v, v);
}

static bool carry_within(const struct gm_problem *problem, const struct gm_event_part *part, double *y)
{
    return gm_user_data_of(problem)->model->system->tangents == 0 ||
           carry_all(problem, part, part->before, y);
}

static void conserved(const struct gm_problem *problem, const double *look, double *quantities)
{
    const struct gm_user_data *self = gm_user_data_of(problem);
    const size_t formulas = self->tapes[GM_USER_BOOKED].count;
    if (formulas > 0) {
        gm_user_values(problem, GM_USER_BOOKED, look, quantities, 1);
    }
    if (formulas < self->events.quantities) {
        quantities[formulas] = gm_energy(problem, look);
    }
}

/* ---- opening ---- */

/* Names the formulas of a tape of the system with frozen switches. */
static void compile_frozen(struct gm_user_data *self, struct gm_late_tape *tape, const gm_node_id *nodes,
                           size_t count)
{
    const struct gm_user_system *system = &self->model->frozen->system;
    *tape = (struct gm_late_tape){&system->graph, nodes, count, system->variable_count, NULL, NULL};
    gm_arena_keep(self->arena, tape, gm_late_tape_close);
}

/* Describes the switches, and names the tapes of their slopes. */
static void open_switches(struct gm_user_data *self, const char **names, enum gm_event_form *forms)
{
    const struct gm_user_frozen *frozen = self->model->frozen;
    const size_t first = self->model->event_count;
    const char **surfaces = gm_arena_take(self->arena, frozen->count, sizeof *surfaces);
    self->events.surfaces = surfaces;
    self->events.inner = frozen->inner;
    for (size_t i = 0; i < frozen->count; i++) {
        names[first + i] = "";
        forms[first + i] = frozen->list[i].whole ? GM_AT_WHOLE : GM_AT_ZERO;
        surfaces[i] = frozen->list[i].text;
    }
    for (size_t i = 0; i < first + frozen->count; i++) {
        const struct gm_user_event *event = i < first ? &frozen->model.events[i] : &frozen->events[i - first];
        compile_frozen(self, &self->event_slopes[i], event->slope_nodes, event->slopes.count);
    }
    compile_frozen(self, &self->tapes[GM_USER_SURFACES], frozen->surfaces, first + frozen->count);
}

void gm_user_events_open(struct gm_problem *problem)
{
    struct gm_user_data *self = gm_user_data_of(problem);
    const struct gm_user_model *model = self->model;
    const struct gm_user_system *system = model->system;
    const size_t written = model->event_count, count = written + (model->frozen ? model->frozen->count : 0),
                 inputs = system->n + 1;
    if (count == 0) {
        return;
    }
    const char **names = gm_arena_take(self->arena, count, sizeof *names);
    bool *ends = gm_arena_take(self->arena, count, sizeof *ends);
    enum gm_event_form *forms = gm_arena_take(self->arena, count, sizeof *forms);
    gm_node_id *booked = gm_arena_take(self->arena, system->item_count + 1, sizeof *booked);
    size_t quantities = 0;
    self->changes = gm_arena_take(self->arena, count, sizeof *self->changes);
    self->event_slopes = gm_arena_take(self->arena, count, sizeof *self->event_slopes);
    self->events = (struct gm_events){.count = count,
                                      .written = written,
                                      .breaks = model->frozen ? model->frozen->breaks : 0,
                                      .names = names,
                                      .ends = ends,
                                      .forms = forms,
                                      .values = values,
                                      .change = change,
                                      .rate = rate,
                                      .carry = carry,
                                      .carry_within = carry_within,
                                      .conserved = conserved};
    if (model->frozen) {
        open_switches(self, names, forms);
    } else {
        gm_user_compile(self, &self->tapes[GM_USER_SURFACES], model->surfaces, written, inputs);
    }
    for (size_t i = 0; i < written; i++) {
        const struct gm_user_event *event = &model->events[i];
        names[i] = event->item->name;
        ends[i] = event->item->ends;
        forms[i] = event->form;
        self->events.ends_runs |= ends[i];
        self->events.changes |= !ends[i];
        gm_user_compile(self, &self->changes[i], event->nodes, event->conditions + event->changed, inputs);
        if (!model->frozen) {
            gm_user_compile(self, &self->event_slopes[i], event->slope_nodes, event->slopes.count, inputs);
        }
    }
    for (size_t i = 0; i < system->item_count && self->events.changes; i++) {
        const gm_node_id node = gm_system_conserved(system, &system->items[i]);
        if (node != GM_NO_NODE) {
            booked[quantities++] = node;
        }
    }
    const bool formula = system->kind == GM_CANONICAL || system->kind == GM_POISSON;
    self->events.has_energy =
        self->events.changes && (formula || (system->kind == GM_LAGRANGIAN && self->ode.hamiltonian));
    if (self->events.has_energy && formula) {
        booked[quantities] = system->energy;
    }
    self->events.quantities = quantities + self->events.has_energy;
    gm_user_compile(self, &self->tapes[GM_USER_BOOKED], booked,
                    quantities + (self->events.has_energy && formula), inputs);
    problem->events = &self->events;
    problem->exact = self->events.changes ? NULL : problem->exact;
}
