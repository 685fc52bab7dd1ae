/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reasons after the status of a run that ended: a part of a formula that is not finite, momenta without
   velocities, a monitor that falls. */
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"

enum { PARTS = 16, STEPS = 2 }; /* of the way ahead that is searched */

/* The view of a run that failed, and where the reason is written. */
struct failed {
    const struct gm_view *view;
    const struct gm_system_scene *scene;
    char *text;
    size_t size;
};

/* Writes a formula that is not finite: "log(x) is not finite where x = -0.3". */
static void tell_node(const struct failed *failed, gm_node_id node, const double *values)
{
    const struct gm_user_system *system = &failed->scene->system;
    const struct gm_naming naming = gm_system_naming(system);
    const struct gm_node *at = &system->graph.nodes[node];
    const gm_node_id operand = at->operation == GM_OPERATION_DIVIDE ? at->b : at->a;
    char *part = gm_formula_text(&system->graph, node, &naming), *inside = NULL;
    if (at->operation != GM_VARIABLE) {
        inside = gm_formula_text(&system->graph, operand, &naming);
    }
    snprintf(failed->text, failed->size,
             inside ? "%.120s is not finite where %.80s = %.4g" : "%.120s is not finite",
             part ? part : "a long formula", inside ? inside : "", inside ? values[operand] : 0);
    free(part);
    free(inside);
}

/* Appends the first components of a member's state: "q = 1.5, p = 0". */
static void tell_components(const struct failed *failed, const double *state, size_t member, size_t count,
                            int digits)
{
    size_t length = strlen(failed->text);
    for (size_t i = 0; i < count && length + 60 < failed->size; i++) {
        length += (size_t)snprintf(failed->text + length, failed->size - length, "%s%.16s = %.*g",
                                   i > 0 ? ", " : "", failed->scene->system.variables[i].name, digits,
                                   state[i * failed->view->problem->m + member]);
    }
}

/* The values of all nodes in a member's state; the caller frees. NULL when out of memory. */
static double *values_at(const struct failed *failed, const double *state, size_t member)
{
    const struct gm_user_system *system = &failed->scene->system;
    struct gm_view there = *failed->view;
    double *variables = malloc(system->variable_count * sizeof *variables);
    double *values = variables ? malloc((system->graph.count + (size_t)1) * sizeof *values) : NULL;
    there.state = state;
    there.t = system->timed ? state[system->n * there.problem->m + member] : there.t;
    if (values) {
        gm_system_variables(&there, member, false, variables);
        gm_formula_evaluate(&system->graph, system->graph.count, variables, values);
    }
    free(variables);
    return values;
}

/* Writes the first part of H, else of a rate, that is not finite in a member's state; false without one. */
static bool tell_part(const struct failed *failed, const double *state, size_t member)
{
    const struct gm_user_system *system = &failed->scene->system;
    double *values = values_at(failed, state, member);
    bool told = false;
    for (size_t i = 0; values && i <= system->n && !told; i++) {
        const gm_node_id root = i > 0                      ? system->rates[i - 1]
                                : system->kind != GM_RATES ? system->energy
                                                           : GM_NO_NODE;
        size_t count = 0;
        gm_node_id *parts = root != GM_NO_NODE && !isfinite(values[root])
                                ? gm_formula_parts(&system->graph, root, &count)
                                : NULL;
        for (size_t k = 0; parts && k < count && !told; k++) {
            told = !isfinite(values[parts[k]]);
            if (told) {
                tell_node(failed, parts[k], values);
            }
        }
        free(parts);
    }
    free(values);
    return told;
}

/* Writes where the Pfaffian of theta's form changes its sign on the line of the next two steps of the first member. */
static void tell_form(const struct failed *failed, const double *slope, double *ahead)
{
    const struct gm_view *view = failed->view;
    const size_t total = view->problem->n * view->problem->m;
    double before = 0;
    for (int part = 0; part <= STEPS * PARTS && !failed->text[0]; part++) {
        for (size_t i = 0; i < total; i++) {
            ahead[i] = view->state[i] + view->dt * part / PARTS * slope[i];
        }
        double *values = values_at(failed, ahead, 0);
        const double here = values ? values[failed->scene->system.pfaffian] : NAN;
        free(values);
        if (here == 0 || here * before < 0) {
            snprintf(failed->text, failed->size, "the form of theta loses its rank near ");
            tell_components(failed, ahead, 0, failed->scene->system.n, 4);
        }
        before = here;
    }
}

/* Writes a state of a Lagrangian system in which a member stops: its momenta have no velocities, or no
   rates. */
static bool tell_velocities(const struct failed *failed, const double *state, const double *slope,
                            size_t member)
{
    const size_t m = failed->view->problem->m, half = failed->scene->system.n / 2;
    bool placed = true, moves = true, turns = true;
    for (size_t i = 0; i < 2 * half; i++) {
        const bool finite = isfinite(slope[i * m + member]);
        placed = placed && isfinite(state[i * m + member]);
        moves = moves && (i >= half || finite);
        turns = turns && (i < half || finite);
    }
    if (!placed || (moves && turns)) {
        return false;
    }
    snprintf(failed->text, failed->size, "%s where ",
             moves ? "dL/dq is not finite"
                   : "momenta do not determine velocities (the Legendre transform of L is singular)");
    tell_components(failed, state, member, half, 6);
    return true;
}

/* The density of steps, whose size is dt divided by it, above 0; it may change the state. */
typedef double density_at(const struct gm_problem *problem, double *y);

static double density_of_monitor(const struct gm_problem *problem, double *y)
{
    double value;
    gm_ode_of(problem)->monitor->density(problem, y, &value, NULL);
    return value;
}

static double depth_at_rest(const struct gm_problem *problem, double *y)
{
    memset(y + problem->n / 2, 0, problem->n / 2 * sizeof *y);
    return -gm_energy(problem, y);
}

/* Finds the density here, and the first that is not above 0 on the line of the next two steps. */
static void look_ahead(const struct gm_view *view, const double *slope, density_at *density, double *y,
                       double found[2])
{
    const struct gm_problem *problem = view->problem;
    memcpy(y, view->state, problem->n * sizeof *y);
    found[0] = found[1] = density(problem, y);
    for (int part = 1; part <= STEPS * PARTS && found[1] > 0; part++) {
        for (size_t i = 0; i < problem->n; i++) {
            y[i] = view->state[i] + view->dt / found[0] * part / PARTS * slope[i];
        }
        found[1] = density(problem, y);
    }
}

/* Writes how fast the monitor falls, if it decides the step size. */
static void tell_monitor(const struct failed *failed, const double *slope, double *ahead)
{
    double found[2];
    look_ahead(failed->view, slope, density_of_monitor, ahead, found);
    if (!(found[1] > 0)) {
        snprintf(failed->text, failed->size,
                 "the monitor, the density of steps, is %.3g, and %.3g where the step leads", found[0],
                 found[1]);
    }
}

/* Writes the event whose change has no value, with its place; false without one. */
static bool tell_event(const struct failed *failed)
{
    const struct gm_user_system *system = &failed->scene->system;
    const struct gm_run *run = failed->view->run;
    const struct gm_events *events = failed->view->problem->events;
    const struct gm_system_item *item = system->items;
    size_t line, column;
    if (!events || run->turned >= events->written) {
        return false;
    }
    for (size_t passed = 0; passed <= run->turned; item++) {
        passed += item->word == GM_WORD_EVENT || item->word == GM_WORD_STOP;
    }
    item--;
    snprintf(failed->text, failed->size, "the event %.40s%sat t = %.6g has no value", item->name,
             item->name[0] ? " " : "", run->turned_at);
    if (!system->typed) {
        const size_t length = strlen(failed->text);
        gm_text_place(system->source, item->place, &line, &column);
        snprintf(failed->text + length, failed->size - length, " (line %zu, column %zu)", line, column);
    }
    return true;
}

/* Writes if the energy at rest, which decides the step size, is not negative. */
static void tell_rest(const struct failed *failed, const double *slope, double *ahead)
{
    double found[2];
    look_ahead(failed->view, slope, depth_at_rest, ahead, found);
    if (!(found[1] > 0)) {
        snprintf(failed->text, failed->size,
                 found[0] > 0 ? "the energy at rest, which has to be negative, is %.3g, and %.3g where the "
                                "step leads"
                              : "the energy at rest, which has to be negative, is %.3g",
                 -found[0], -found[1]);
    }
}

/* Writes the fault of these states with slopes `slope`; false if all is finite. */
static bool tell_states(const struct failed *failed, const double *states, const double *slope)
{
    const bool lagrangian = failed->scene->system.kind == GM_LAGRANGIAN; /* its formulas hold velocities */
    const size_t n = failed->view->problem->n, m = failed->view->problem->m;
    for (size_t member = 0; member < m; member++) {
        bool finite = true;
        for (size_t i = 0; i < n; i++) {
            finite = finite && isfinite(slope[i * m + member]);
        }
        if (!finite && (lagrangian ? tell_velocities(failed, states, slope, member)
                                   : tell_part(failed, states, member))) {
            return true;
        }
    }
    return false;
}

/* Returns true if a run continues with such states. */
static bool goes_on(const struct gm_view *view, const double *states)
{
    bool within = true;
    for (size_t i = 0; i < view->problem->n * view->problem->m; i++) {
        within = within && fabs(states[i]) <= view->run->limit;
    }
    return within;
}

/* Writes that the run has ended where the form of theta loses its rank, if it has. */
static void tell_stop(const struct failed *failed)
{
    const struct gm_user_system *system = &failed->scene->system;
    const struct gm_system_item *stop = gm_system_item_of(system, GM_WORD_STOP, 0);
    if (system->theta && stop && stop->nodes[0] == system->pfaffian) {
        snprintf(failed->text, failed->size, "the form of theta loses its rank near ");
        tell_components(failed, failed->view->state, 0, system->n, 4);
    }
}

/* Writes a part of H, or of a rate, that is not finite now, else at the start, where steps may not need it. */
static bool tell_energy(const struct failed *failed)
{
    const size_t m = failed->view->problem->m;
    bool told = false;
    for (size_t k = 0; k < 2 * m && !told && failed->scene->system.kind != GM_LAGRANGIAN; k++) {
        told = tell_part(failed, k < m ? failed->view->state : failed->view->start, k % m);
    }
    return told;
}

/* Looks ahead, as stages do: along the slope, then along the motion, which may bend elsewhere, over two
   steps, since stages overshoot. The search ends at the run's limit, which ends the run by itself. */
void gm_system_tell_failure(const struct gm_view *view, char *text, size_t size)
{
    enum { COARSE = 8 };
    const struct failed failed = {view, gm_system_scene_of(view), text, size};
    const struct gm_problem *problem = view->problem;
    const size_t total = problem->n * problem->m;
    double *slope = malloc(3 * total * sizeof *slope);
    text[0] = '\0';
    if (!slope || view->run->stopped || tell_event(&failed)) {
        tell_stop(&failed);
        free(slope);
        return;
    }
    double *const ahead = slope + total, *const there = ahead + total;
    gm_field(problem, view->state, slope, problem->m);
    memcpy(ahead, view->state, total * sizeof *ahead);
    bool within = !tell_states(&failed, ahead, slope) && !tell_energy(&failed);
    for (int part = 1; part <= 3 * COARSE && within; part++) {
        const bool from_here = part <= COARSE + 1;
        const double h = view->dt * (part <= COARSE ? part : 1) / COARSE;
        for (size_t i = 0; i < total; i++) {
            ahead[i] = from_here ? view->state[i] + h * slope[i] : ahead[i] + h * there[i];
        }
        gm_field(problem, ahead, there, problem->m);
        within = goes_on(view, ahead) && !tell_states(&failed, ahead, there);
    }
    if (!text[0] && (view->scheme->needs & GM_NEEDS_MONITOR)) {
        tell_monitor(&failed, slope, ahead);
    }
    if (!text[0] && failed.scene->system.theta) {
        tell_form(&failed, slope, ahead);
    }
    if (!text[0] && (view->scheme->needs & GM_NEEDS_ATTRACTION)) {
        tell_rest(&failed, slope, ahead);
    }
    free(slope);
}
