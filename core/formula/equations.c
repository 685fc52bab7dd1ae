/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of motion by exact derivatives, and the checks of what a file says of them. */
#include "core/formula/equations.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/formula/derivative.h"

static gm_node_id apply(struct gm_own_system *system, enum gm_operation operation, gm_node_id a, gm_node_id b)
{
    system->graph.simplifies = true;
    const gm_node_id node = gm_formula_apply(&system->graph, operation, a, b);
    system->graph.simplifies = false;
    return node;
}

static gm_node_id add_force(struct gm_own_system *system, gm_node_id rate, gm_node_id force)
{
    return force == GM_NO_NODE ? rate : apply(system, GM_OPERATION_ADD, rate, force);
}

/* the gradient of a node over all variables; malloc'ed */
static gm_node_id *gradient_of(struct gm_own_system *system, gm_node_id node)
{
    bool *all = malloc(system->variable_count);
    gm_node_id *gradient = malloc(system->variable_count * sizeof *gradient);
    if (all && gradient) {
        memset(all, true, system->variable_count);
        gm_gradient(&system->graph, node, all, system->variable_count, gradient);
    } else {
        system->graph.failed = true;
    }
    free(all);
    return gradient;
}

static void derive_poisson(struct gm_own_system *system, const gm_node_id *gradient)
{
    const size_t n = system->n;
    for (size_t i = 0; i < n; i++) {
        system->rates[i] = gm_formula_constant(&system->graph, 0);
        for (size_t k = 0; k < n; k++) {
            const gm_node_id term =
                apply(system, GM_OPERATION_MULTIPLY, system->bracket[i * n + k], gradient[k]);
            system->rates[i] = apply(system, GM_OPERATION_ADD, system->rates[i], term);
        }
    }
}

static bool derive(struct gm_own_system *system)
{
    const size_t half = system->n / 2;
    gm_node_id *gradient = system->kind == GM_RATES ? NULL : gradient_of(system, system->energy);
    if (system->kind == GM_CANONICAL && !system->graph.failed) {
        for (size_t i = 0; i < half; i++) {
            system->rates[i] = gradient[half + i];
            system->rates[half + i] = add_force(system, apply(system, GM_OPERATION_NEGATE, gradient[i], 0),
                                                system->variables[i].force);
        }
    } else if (system->kind == GM_LAGRANGIAN && !system->graph.failed) {
        system->momenta = malloc((half + 1) * sizeof *system->momenta);
        for (size_t i = 0; i < half && system->momenta; i++) {
            system->momenta[i] = gradient[system->velocities + i];
            system->rates[half + i] = add_force(system, gradient[i], system->variables[i].force);
        }
        system->graph.failed |= !system->momenta;
    } else if (system->kind == GM_POISSON && !system->graph.failed) {
        derive_poisson(system, gradient);
    }
    free(gradient);
    bool *marked = calloc(system->variable_count, sizeof *marked);
    bool *timed = NULL;
    if (marked && !system->graph.failed) {
        marked[system->n] = true;
        timed = gm_formula_dependent(&system->graph, marked, system->variable_count);
    }
    for (size_t i = 0; timed && i < system->n; i++) {
        system->timed |= system->rates[i] != GM_NO_NODE && timed[system->rates[i]];
    }
    system->timed |= timed && system->kind != GM_RATES && timed[system->energy];
    free(marked);
    const bool good = timed && !system->graph.failed;
    free(timed);
    return good;
}

static bool has(const struct gm_own_system *system, enum gm_word word)
{
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == word) {
            return true;
        }
    }
    return false;
}

static gm_node_id along(struct gm_own_system *system, gm_node_id node, const gm_node_id *direction)
{
    gm_node_id *slopes = gm_derivative_along(&system->graph, node + 1, direction, system->n + 1);
    const gm_node_id slope = slopes ? slopes[node] : GM_NO_NODE;
    free(slopes);
    return slope;
}

gm_node_id gm_equations_rate_of(struct gm_own_system *system, gm_node_id node)
{
    gm_node_id *direction = malloc((system->n + 1) * sizeof *direction), rate = GM_NO_NODE;
    if (direction && system->kind != GM_LAGRANGIAN && !has(system, GM_WORD_CONSTRAINT)) {
        memcpy(direction, system->rates, system->n * sizeof *direction);
        direction[system->n] = gm_formula_constant(&system->graph, 1);
        rate = along(system, node, direction);
    }
    free(direction);
    return rate;
}

enum gm_identity gm_equations_vanishes(const struct gm_own_system *system, gm_node_id node)
{
    double *fixed = malloc(system->variable_count * sizeof *fixed);
    enum gm_identity identity = GM_UNTESTED;
    if (fixed) {
        for (size_t i = 0; i < system->variable_count; i++) {
            fixed[i] = system->variables[i].value;
        }
        identity = gm_identity_of(&system->graph, node, fixed, system->variable_count);
    }
    free(fixed);
    return identity;
}

__attribute__((format(printf, 3, 4))) static bool fail(struct gm_fault *fault, size_t place,
                                                       const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(fault->sentence, sizeof fault->sentence, format, arguments);
    va_end(arguments);
    fault->offset = place;
    return false;
}

/* sum over l of {i, l} d{j, k}/dl and cyclic */
static bool check_jacobi(struct gm_own_system *system, struct gm_fault *fault)
{
    const size_t n = system->n;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    gm_node_id *direction = malloc((n + 1) * sizeof *direction);
    system->jacobi = GM_ZERO_PROVED;
    for (size_t i = 0; direction && i < n; i++) {
        for (size_t j = i + 1; j < n; j++) {
            for (size_t k = j + 1; k < n; k++) {
                const size_t triple[] = {i, j, k};
                gm_node_id sum = zero;
                for (int turn = 0; turn < 3; turn++) {
                    const size_t a = triple[turn], b = triple[(turn + 1) % 3], c = triple[(turn + 2) % 3];
                    memcpy(direction, &system->bracket[a * n], n * sizeof *direction);
                    direction[n] = zero;
                    if (system->graph.nodes[system->bracket[b * n + c]].operation != GM_CONSTANT) {
                        sum = apply(system, GM_OPERATION_ADD, sum,
                                    along(system, system->bracket[b * n + c], direction));
                    }
                }
                const enum gm_identity found = gm_equations_vanishes(system, sum);
                if (found == GM_NOT_ZERO) {
                    free(direction);
                    return fail(fault, 0, "the bracket breaks Jacobi's identity for %.60s, %.60s and %.60s",
                                system->variables[i].name, system->variables[j].name,
                                system->variables[k].name);
                }
                system->jacobi = found == GM_ZERO_PROVED ? system->jacobi : found;
            }
        }
    }
    system->graph.failed |= !direction;
    free(direction);
    return true;
}

/* {x_i, C} = 0 for all i */
static enum gm_identity check_casimir(struct gm_own_system *system, gm_node_id node)
{
    enum gm_identity all = GM_ZERO_PROVED;
    gm_node_id *direction = malloc((system->n + 1) * sizeof *direction);
    for (size_t i = 0; direction && i < system->n && all != GM_NOT_ZERO; i++) {
        memcpy(direction, &system->bracket[i * system->n], system->n * sizeof *direction);
        direction[system->n] = gm_formula_constant(&system->graph, 0);
        const enum gm_identity found = gm_equations_vanishes(system, along(system, node, direction));
        all = found == GM_ZERO_PROVED ? all : found;
    }
    free(direction);
    return direction ? all : GM_UNTESTED;
}

/* Of coordinates: the energy does not change along the generator, lifted to momenta or velocities. Of
   components: generator and field commute. The momentum map is appended. */
static enum gm_identity check_symmetry(struct gm_own_system *system, struct gm_system_item *item)
{
    const size_t half = system->n / 2, n = system->n;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    if (system->kind > GM_LAGRANGIAN) {
        gm_node_id *direction = malloc((n + 1) * sizeof *direction);
        enum gm_identity all = GM_ZERO_PROVED;
        for (size_t i = 0; direction && i < n && all != GM_NOT_ZERO; i++) {
            memcpy(direction, item->nodes, n * sizeof *direction);
            direction[n] = zero;
            const gm_node_id one = along(system, system->rates[i], direction);
            memcpy(direction, system->rates, n * sizeof *direction);
            direction[n] = gm_formula_constant(&system->graph, 1);
            const gm_node_id other = along(system, item->nodes[i], direction);
            const enum gm_identity found =
                gm_equations_vanishes(system, apply(system, GM_OPERATION_SUBTRACT, one, other));
            all = found == GM_ZERO_PROVED ? all : found;
        }
        free(direction);
        return direction ? all : GM_UNTESTED;
    }
    gm_node_id map = zero, change = zero;
    gm_node_id *gradient = gradient_of(system, system->energy);
    for (size_t i = 0; i < half && !system->graph.failed; i++) {
        const bool lagrangian = system->kind == GM_LAGRANGIAN;
        const gm_node_id momentum =
            lagrangian ? system->momenta[i] : gm_formula_variable(&system->graph, half + i);
        map = apply(system, GM_OPERATION_ADD, map,
                    apply(system, GM_OPERATION_MULTIPLY, momentum, item->nodes[i]));
        change = apply(system, GM_OPERATION_ADD, change,
                       apply(system, GM_OPERATION_MULTIPLY, gradient[i], item->nodes[i]));
    }
    /* of H by the lift to momenta, -p dX/dq; of L by that to velocities, dX/dq v */
    for (size_t i = 0; i < half && !system->graph.failed; i++) {
        gm_node_id *slopes = gradient_of(system, system->kind == GM_CANONICAL ? map : item->nodes[i]);
        for (size_t k = 0; k < half && !system->graph.failed; k++) {
            if (system->kind == GM_CANONICAL && i == 0) {
                change = apply(system, GM_OPERATION_SUBTRACT, change,
                               apply(system, GM_OPERATION_MULTIPLY, gradient[half + k], slopes[k]));
            } else if (system->kind == GM_LAGRANGIAN) {
                const gm_node_id moved = apply(system, GM_OPERATION_MULTIPLY, slopes[k],
                                               gm_formula_variable(&system->graph, system->velocities + k));
                change = apply(system, GM_OPERATION_ADD, change,
                               apply(system, GM_OPERATION_MULTIPLY, gradient[system->velocities + i], moved));
            }
        }
        free(slopes);
    }
    free(gradient);
    gm_node_id *nodes = realloc(item->nodes, (half + 1) * sizeof *nodes);
    if (!nodes || system->graph.failed) {
        system->graph.failed = true;
        return GM_UNTESTED;
    }
    item->nodes = nodes;
    nodes[half] = map;
    item->count = half + 1;
    return gm_equations_vanishes(system, change);
}

static bool check_items(struct gm_own_system *system, struct gm_fault *fault)
{
    bool forced = has(system, GM_WORD_CONSTRAINT);
    for (size_t i = 0; i < system->n; i++) {
        forced |= system->variables[i].force != GM_NO_NODE;
    }
    for (size_t i = 0; i < system->item_count && !system->graph.failed; i++) {
        struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_INVARIANT) {
            const gm_node_id rate = gm_equations_rate_of(system, item->nodes[0]);
            item->check = rate == GM_NO_NODE ? GM_UNTESTED : gm_equations_vanishes(system, rate);
            if (item->check == GM_NOT_ZERO && !forced) {
                return fail(fault, item->place,
                            "%.60s is no invariant; what is only nearly kept is an observable, observe",
                            item->name);
            }
        } else if (item->word == GM_WORD_CASIMIR) {
            item->check = check_casimir(system, item->nodes[0]);
            if (item->check == GM_NOT_ZERO) {
                return fail(fault, item->place,
                            "%.60s is no Casimir: its bracket with the components is not 0", item->name);
            }
        } else if (item->word == GM_WORD_SYMMETRY) {
            item->check = check_symmetry(system, item);
            if (item->check == GM_NOT_ZERO) {
                return fail(fault, item->place, "this is no symmetry: it changes %s",
                            system->kind == GM_CANONICAL    ? "H"
                            : system->kind == GM_LAGRANGIAN ? "L"
                                                            : "the motion");
            }
        }
    }
    return true;
}

/* values of all nodes; malloc'ed */
static double *values_for(const struct gm_own_system *system, const double *variables)
{
    double *values = malloc((system->graph.count + (size_t)1) * sizeof *values);
    if (values) {
        gm_formula_evaluate(&system->graph, system->graph.count, variables, values);
    }
    return values;
}

double *gm_equations_start(const struct gm_own_system *system)
{
    const size_t half = system->n / 2;
    double *variables = malloc(system->variable_count * sizeof *variables), *values = NULL;
    for (size_t i = 0; variables && i < system->variable_count; i++) {
        variables[i] = i == system->n ? 0 : system->variables[i].value;
    }
    /* a start may hold others: what is found in one round serves the next */
    size_t found = 0, before = 0;
    for (bool first = true; variables && (first || found > before); first = false) {
        before = found;
        free(values);
        values = values_for(system, variables);
        for (size_t i = 0; values && i < system->initial; i++) {
            const gm_node_id start = system->variables[i].start;
            variables[i] = start == GM_NO_NODE ? variables[i] : values[start];
        }
        for (size_t i = 0; values && system->momenta && i < half; i++) {
            const bool given = system->variables[half + i].start != GM_NO_NODE;
            variables[half + i] = given ? variables[half + i] : values[system->momenta[i]];
        }
        found = 0;
        for (size_t i = 0; i < system->initial; i++) {
            found += !isnan(variables[i]);
        }
    }
    for (size_t i = 0; values && i < system->n; i++) {
        variables[system->initial + i] = variables[i];
    }
    if (!values) {
        free(variables);
        variables = NULL;
    }
    free(values);
    return variables;
}

/* Whether the matrix of second derivatives over velocities can be factored, by Gauss, in place. */
static bool is_regular(double *matrix, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n * n; i++) {
        largest = fmax(largest, fabs(matrix[i]));
    }
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; i++) {
            pivot = fabs(matrix[i * n + k]) > fabs(matrix[pivot * n + k]) ? i : pivot;
        }
        if (!(fabs(matrix[pivot * n + k]) > 1e-14 * largest)) {
            return false;
        }
        for (size_t j = 0; j < n; j++) {
            const double kept = matrix[k * n + j];
            matrix[k * n + j] = matrix[pivot * n + j];
            matrix[pivot * n + j] = kept;
        }
        for (size_t i = k + 1; i < n; i++) {
            const double factor = matrix[i * n + k] / matrix[k * n + k];
            for (size_t j = k; j < n; j++) {
                matrix[i * n + j] -= factor * matrix[k * n + j];
            }
        }
    }
    return true;
}

static bool check_legendre(struct gm_own_system *system, const double *start, struct gm_fault *fault)
{
    const size_t half = system->n / 2;
    bool *marked = calloc(system->variable_count, sizeof *marked);
    double *matrix = calloc(half * half + 1, sizeof *matrix);
    struct gm_sparse mass = {0};
    for (size_t i = 0; marked && i < half; i++) {
        marked[system->velocities + i] = true;
    }
    bool regular = true;
    if (marked && matrix &&
        gm_sparse_jacobian(&system->graph, system->momenta, half, marked, system->variable_count, &mass)) {
        double *values = values_for(system, start);
        for (size_t i = 0; values && i < mass.count; i++) {
            matrix[mass.entries[i].row * half + mass.entries[i].column - system->velocities] =
                values[mass.entries[i].node];
        }
        regular = !values || is_regular(matrix, half);
        free(values);
    }
    free(mass.entries);
    free(marked);
    free(matrix);
    return regular ||
           fail(fault, 0,
                "the Legendre transform of L is singular at the start: momenta do not determine velocities");
}

static bool check_start(struct gm_own_system *system, struct gm_fault *fault)
{
    double *start = gm_equations_start(system), *values = start ? values_for(system, start) : NULL;
    bool *reached = calloc(system->graph.count + (size_t)1, sizeof *reached);
    bool good = true;
    for (size_t i = 0; values && good && i < system->n; i++) {
        good = isfinite(start[i]) ||
               fail(fault, 0, "%.60s is not finite at the start", system->variables[i].name);
    }
    for (size_t i = 0; values && good && i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_CONSTRAINT && !(fabs(values[item->nodes[0]]) <= 1e-10)) {
            good = fail(fault, item->place, "the start breaks this constraint: it is %g, not 0",
                        values[item->nodes[0]]);
        }
    }
    for (size_t i = 0; values && reached && good && i < system->n; i++) {
        if (system->rates[i] == GM_NO_NODE || isfinite(values[system->rates[i]])) {
            continue;
        }
        /* the first of its parts that is not finite and was written */
        gm_formula_reach(&system->graph, system->rates[i], reached);
        size_t place = 0;
        for (gm_node_id k = 0; k <= system->rates[i] && place == 0; k++) {
            place = reached[k] && !isfinite(values[k]) && system->graph.places[k] != SIZE_MAX
                        ? system->graph.places[k]
                        : 0;
        }
        good = fail(fault, place, "the rate of %.60s is not finite at the start", system->variables[i].name);
    }
    good = good && (!values || system->kind != GM_LAGRANGIAN || check_legendre(system, start, fault));
    system->graph.failed |= !values || !reached;
    free(start);
    free(values);
    free(reached);
    return good;
}

bool gm_equations_open(struct gm_own_system *system, const char *text, size_t length,
                       const struct gm_system_value *values, size_t count, struct gm_fault *fault)
{
    return gm_system_read(system, text, length, values, count, fault) && derive(system) &&
           (system->kind != GM_POISSON || check_jacobi(system, fault)) && check_start(system, fault) &&
           check_items(system, fault) && !system->graph.failed;
}
