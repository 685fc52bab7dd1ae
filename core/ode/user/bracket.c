/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The structure of a Poisson system: a bracket of angular momenta, if it is one, and the pieces of the energy
   whose flows are exact. */
#include "core/ode/user/data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/members.h"

/* ---- angular momenta ---- */

static bool is_zero(const struct gm_user_system *system, gm_node_id node)
{
    return gm_is_constant(&system->graph, node, 0);
}

/* Returns true if {y_i, y_j} is this variable, or with `negative` its negative. */
static bool is_entry(struct gm_user_system *system, size_t row, size_t column, size_t variable, bool negative)
{
    struct gm_formula *graph = &system->graph;
    const gm_node_id positive = gm_formula_variable(graph, variable);
    return system->bracket[system->n * row + column] ==
           (negative ? gm_formula_apply(graph, GM_OPERATION_NEGATE, positive, 0) : positive);
}

/* Returns true if {y_i, y_j} = sign y_k and {y_i, z_j} = sign z_k for i, j, k = 1, 2, 3 and cyclic; the six
   components are y and z, and all else is 0. */
static bool is_top(struct gm_user_system *system, bool negative)
{
    bool same = system->n == 6;
    for (size_t i = 0; i < 3 && same; i++) {
        for (size_t k = i + 1; k < 6 && same; k++) {
            const size_t ahead = (k + 3 - i) % 3, third = (k < 3 ? 0 : 3) + (i + 3 - ahead) % 3;
            same = ahead == 0 ? is_zero(system, system->bracket[6 * i + k])
                              : is_entry(system, i, k, third, (ahead == 1) == negative);
        }
    }
    for (size_t i = 3; i < 6 && same; i++) {
        for (size_t k = i + 1; k < 6; k++) {
            same = same && is_zero(system, system->bracket[6 * i + k]);
        }
    }
    return same;
}

/* Returns true if all components are angular momenta, in three lists; `negative` chooses the sign. */
static bool are_spins(struct gm_user_system *system, bool negative)
{
    const size_t n = system->n, spins = n / 3;
    bool same = n > 0 && n % 3 == 0;
    for (size_t i = 0; i < n && same; i++) {
        for (size_t k = i + 1; k < n && same; k++) {
            const size_t one = i / spins, other = k / spins;
            same = i % spins != k % spins || one == other
                       ? is_zero(system, system->bracket[n * i + k])
                       : is_entry(system, i, k, (3 - one - other) * spins + i % spins,
                                  ((other + 3 - one) % 3 == 1) == negative);
        }
    }
    return same;
}

static void find_turning(struct gm_user_bracket *model, struct gm_user_system *system)
{
    for (int negative = 1; negative >= 0 && model->facet.turning == 0; negative--) {
        const bool spins = are_spins(system, negative);
        if (spins || is_top(system, negative)) {
            model->facet.turning = negative ? 1 : -1;
            model->facet.spins = spins ? system->n / 3 : 0;
        }
    }
}

/* ---- what the slopes of the energy are made of ---- */

/* holds[i * n + j]: true if dH/dy_i holds component j */
static void find_parts(struct gm_arena *arena, struct gm_user_system *system, const gm_node_id *gradient,
                       bool *holds)
{
    const size_t n = system->n;
    for (size_t i = 0; i < n; i++) {
        size_t count = 0;
        gm_node_id *parts = gm_arena_keep(arena, gm_formula_parts(&system->graph, gradient[i], &count), free);
        for (size_t k = 0; k < count; k++) {
            const struct gm_node *part = &system->graph.nodes[parts[k]];
            if (part->operation == GM_VARIABLE && part->a < n) {
                holds[i * n + part->a] = true;
            }
        }
        gm_arena_drop(arena, parts);
    }
}

/* Returns true if the slope over y_i holds y_i only, and the slopes over z hold no y. */
static bool is_sum_over_axes(size_t n, const bool *holds)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            if (holds[i * n + k] && (i < 3 ? k != i : k < 3)) {
                return false;
            }
        }
    }
    return n == 3 || n == 6;
}

/* ---- pieces ---- */

enum { NONE = GM_NEWTON_LARGEST };

static void rename_group(size_t *group, size_t n, size_t from, size_t to)
{
    for (size_t i = 0; i < n; i++) {
        group[i] = group[i] == from ? to : group[i];
    }
}

static bool commute(const struct gm_user_system *system, const size_t *group, size_t one, size_t other)
{
    const size_t n = system->n;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            if (group[i] == one && group[k] == other && !is_zero(system, system->bracket[i * n + k])) {
                return false;
            }
        }
    }
    return true;
}

/* Groups the components: i and k share a group if the slope dH/dy_i holds k; then groups that commute are
   merged, in order. group[i] is the first member of i's group, or NONE if the energy does not hold component
   i. Returns false if the members of a group do not commute. */
static bool find_groups(const struct gm_user_system *system, const gm_node_id *gradient, const bool *holds,
                        size_t *group)
{
    const size_t n = system->n;
    for (size_t i = 0; i < n; i++) {
        group[i] = is_zero(system, gradient[i]) ? NONE : i;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            if (holds[i * n + k] && group[i] != group[k]) {
                rename_group(group, n, group[i] > group[k] ? group[i] : group[k],
                             group[i] > group[k] ? group[k] : group[i]);
            }
        }
    }
    for (size_t k = 0; k < n; k++) {
        if (group[k] == k && !commute(system, group, k, k)) {
            return false;
        }
        for (size_t i = 0; i < k && group[k] == k; i++) {
            if (group[i] == i && commute(system, group, i, k)) {
                rename_group(group, n, k, i);
            }
        }
    }
    return true;
}

/* Opens the rates of one group. Returns false if they are not linear in the components that move. */
static bool open_piece(struct gm_arena *arena, struct gm_user_bracket *model, struct gm_user_system *system,
                       const size_t *group, size_t which)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n;
    gm_node_id *rates = gm_arena_take(arena, n + 1, sizeof *rates);
    for (size_t i = 0; i < n; i++) {
        rates[i] = gm_formula_constant(graph, 0);
        for (size_t k = 0; k < n; k++) {
            if (group[k] == which) {
                const gm_node_id term = gm_product(graph, system->bracket[i * n + k], model->gradient[k]);
                rates[i] = gm_sum(graph, rates[i], term);
            }
        }
    }
    return gm_linear_flow_derive(arena, &model->pieces[model->facet.pieces++], graph, rates, n,
                                 system->variable_count);
}

static void find_pieces(struct gm_arena *arena, struct gm_user_bracket *model, struct gm_user_system *system,
                        const bool *holds)
{
    const size_t n = system->n;
    size_t group[GM_NEWTON_LARGEST];
    if (n > GM_NEWTON_LARGEST || !find_groups(system, model->gradient, holds, group)) {
        return;
    }
    model->pieces = gm_arena_take(arena, n, sizeof *model->pieces);
    for (size_t i = 0; i < n; i++) {
        if (group[i] == i && !open_piece(arena, model, system, group, i)) {
            model->facet.pieces = 0;
            return;
        }
    }
}

/* ---- with values ---- */

static double energy(const struct gm_problem *problem, const double *y)
{
    double value;
    gm_user_values(problem, GM_KERNEL_ENERGY, y, &value, 1);
    return value;
}

static void gradient(const struct gm_problem *problem, const double *y, double *slopes)
{
    gm_user_values(problem, GM_USER_GRADIENT, y, slopes, 1);
}

static void bracket(const struct gm_problem *problem, const double *y, double *matrix)
{
    gm_user_values(problem, GM_USER_BRACKET, y, matrix, 1);
}

static void flow(const struct gm_problem *problem, size_t piece, double h, double *y)
{
    struct gm_user_data *data = gm_user_data_of(problem);
    double values[GM_NEWTON_LARGEST * (GM_NEWTON_LARGEST + 1)], scratch[3 * GM_NEWTON_LARGEST];
    gm_late_tape_values(&data->pieces[piece], y, values, 1);
    gm_linear_flow_advance(&data->model->bracket.pieces[piece], h, values, scratch, y);
}

/* The moments of inertia of a body that nothing turns: slopes that are linear, each of its own component. */
static void find_moments(struct gm_poisson *poisson, const struct gm_problem *problem)
{
    double at[3] = {0}, slopes[3], moments[3];
    if (problem->n != 3 || poisson->turning == 0 || !poisson->axes || !gm_ode_of(problem)->quadratic) {
        return;
    }
    gradient(problem, at, slopes);
    bool linear = slopes[0] == 0 && slopes[1] == 0 && slopes[2] == 0;
    for (int i = 0; i < 3; i++) {
        at[i] = 1;
        gradient(problem, at, slopes);
        moments[i] = 1 / slopes[i];
        linear = linear && slopes[i] != 0 && isfinite(moments[i]);
    }
    if (linear) {
        memcpy(poisson->moments, moments, sizeof moments);
    }
}

void gm_user_bracket_derive(struct gm_arena *arena, struct gm_user_bracket *model,
                            struct gm_user_system *system)
{
    *model = (struct gm_user_bracket){
        .facet = {.energy = energy, .gradient = gradient, .bracket = bracket, .flow = flow}};
    if (system->kind != GM_POISSON || system->timed) {
        return;
    }
    const size_t n = system->n;
    bool *marked = gm_arena_take(arena, system->variable_count, sizeof *marked),
         *holds = gm_arena_take(arena, n * n, sizeof *holds);
    model->gradient = gm_arena_take(arena, system->variable_count + 1, sizeof *model->gradient);
    memset(marked, true, n * sizeof *marked);
    gm_arena_need(
        arena, gm_gradient(&system->graph, system->energy, marked, system->variable_count, model->gradient));
    find_parts(arena, system, model->gradient, holds);
    find_turning(model, system);
    model->facet.axes = is_sum_over_axes(n, holds);
    find_pieces(arena, model, system, holds);
}

void gm_user_bracket_open(const struct gm_problem *problem)
{
    struct gm_user_data *data = gm_user_data_of(problem);
    const struct gm_user_bracket *model = &data->model->bracket;
    const struct gm_user_system *system = data->model->system;
    const size_t n = system->n;
    if (!model->gradient) {
        return;
    }
    data->poisson = model->facet;
    data->ode.poisson = &data->poisson;
    data->pieces = gm_arena_take(data->arena, model->facet.pieces, sizeof *data->pieces);
    gm_user_compile(data, &data->tapes[GM_USER_GRADIENT], model->gradient, n, n);
    gm_user_compile(data, &data->tapes[GM_USER_BRACKET], system->bracket, n * n, n);
    for (size_t i = 0; i < model->facet.pieces; i++) {
        const struct gm_linear_flow *piece = &model->pieces[i];
        gm_user_compile(data, &data->pieces[i], piece->nodes, n + piece->slopes.count, n);
    }
    find_moments(&data->poisson, problem);
}
