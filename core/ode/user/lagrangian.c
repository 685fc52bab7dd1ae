/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Legendre transform of a Lagrangian at every state, and its derivatives. */
#include "core/ode/user/data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/equations.h"
#include "core/ode/kernel/members.h"

static bool is_linear(struct gm_arena *arena, struct gm_user_system *system, bool *marked)
{
    memset(marked + system->velocities, true, system->n / 2);
    bool *dependent =
        gm_arena_keep(arena, gm_formula_dependent(&system->graph, marked, system->variable_count), free);
    bool linear = true;
    for (size_t i = 0; i < system->mass.count; i++) {
        linear = linear && !dependent[system->mass.entries[i].node];
    }
    gm_arena_drop(arena, dependent);
    memset(marked, false, system->variable_count);
    return linear;
}

/* returns true if the entry belongs to the mass matrix */
static bool is_of_mass(const struct gm_user_lagrangian *model, const struct gm_sparse_entry *entry)
{
    return entry->row < model->half && entry->column >= model->half && entry->column < 2 * model->half;
}

void gm_user_lagrangian_derive(struct gm_arena *arena, struct gm_user_lagrangian *model,
                               struct gm_user_system *system)
{
    const size_t n = system->n, half = n / 2, count = system->variable_count;
    gm_node_id *others = gm_arena_take(arena, count, sizeof *others);
    bool *marked = gm_arena_take(arena, count, sizeof *marked);
    *model = (struct gm_user_lagrangian){.half = half,
                                         .components = n + system->timed,
                                         .linear = is_linear(arena, system, marked),
                                         .nodes = gm_arena_take(arena, n + 1, sizeof *model->nodes)};
    memcpy(model->nodes, system->momenta, half * sizeof *model->nodes);
    memcpy(model->nodes + half, system->rates + half, half * sizeof *model->nodes);
    model->nodes[n] = system->energy;
    gm_equations_in_velocities(system, model->nodes, n + 1); /* a force may hold momenta */
    for (size_t i = 0; i < count; i++) {
        const bool velocity = i >= system->velocities && i < system->velocities + half;
        others[i] =
            velocity ? gm_formula_variable(&system->graph, half + i - system->velocities) : GM_NO_NODE;
    }
    gm_formula_substitute(&system->graph, model->nodes, n + 1, others, count);
    memset(marked, true, model->components);
    model->slopes = gm_sparse_jacobian(arena, &system->graph, model->nodes, n, marked, count);
    model->slope_nodes = gm_sparse_nodes(arena, NULL, 0, &model->slopes);
    model->momenta = gm_sparse_nodes(arena, model->nodes, half, &model->slopes);
    model->momenta_count = half;
    for (size_t i = 0; i < model->slopes.count; i++) {
        if (is_of_mass(model, &model->slopes.entries[i])) {
            model->momenta[model->momenta_count++] = model->slopes.entries[i].node;
        }
    }
}

void gm_user_lagrangian_open(struct gm_user_data *data)
{
    const struct gm_user_lagrangian *model = &data->model->lagrangian;
    const size_t half = model->half, n = model->components;
    struct gm_late_tape *tapes = data->tapes;
    gm_user_compile(data, &tapes[GM_USER_MOMENTA], model->momenta, model->momenta_count, n);
    gm_user_compile(data, &tapes[GM_USER_RATES], model->nodes + half, half, n);
    gm_user_compile(data, &tapes[GM_USER_ACTION], model->nodes + 2 * half, 1, n);
    gm_user_compile(data, &tapes[GM_USER_ACTION_SLOPES], model->slope_nodes, model->slopes.count, n);
}

static void no_numbers(double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        values[i] = NAN;
    }
}

/* One state and the search for its velocities. */
struct transform {
    const struct gm_problem *problem;
    double *at;      /* q, v, t */
    double *outputs; /* the outputs of the tape of momenta */
    double *wanted;  /* p */
    double *scratch;
};

static const struct gm_user_lagrangian *model_of(const struct gm_problem *problem)
{
    return &gm_user_data_of(problem)->model->lagrangian;
}

static struct transform lay_transform(const struct gm_problem *problem, double *memory)
{
    const struct gm_user_lagrangian *model = model_of(problem);
    struct transform transform = {.problem = problem, .at = memory, .outputs = memory + model->components};
    transform.wanted = transform.outputs + model->momenta_count;
    transform.scratch = transform.wanted + model->half;
    return transform;
}

static size_t transform_size(const struct gm_user_lagrangian *model)
{
    return model->components + model->momenta_count + model->half + gm_newton_scratch(model->half);
}

/* The mass matrix from the values of all slopes, or of those that are `alone` in it. */
static void fill_mass(const struct gm_user_lagrangian *model, const double *values, bool alone, double *mass)
{
    memset(mass, 0, model->half * model->half * sizeof *mass);
    for (size_t i = 0; i < model->slopes.count; i++) {
        const struct gm_sparse_entry *slope = &model->slopes.entries[i];
        const bool held = is_of_mass(model, slope);
        if (held) {
            mass[slope->row * model->half + slope->column - model->half] = *values;
        }
        values += held || !alone;
    }
}

/* p - dL/dv and the mass matrix; gm_linear_equations */
static bool momenta_at(void *data, const double *v, double *residual, double *matrix, double *scale)
{
    struct transform *transform = data;
    const struct gm_user_lagrangian *model = model_of(transform->problem);
    memcpy(transform->at + model->half, v, model->half * sizeof *v);
    gm_user_values(transform->problem, GM_USER_MOMENTA, transform->at, transform->outputs, 1);
    for (size_t i = 0; i < model->half; i++) {
        residual[i] = transform->wanted[i] - transform->outputs[i];
    }
    fill_mass(model, transform->outputs + model->half, true, matrix);
    *scale += gm_sum_of(v, model->half);
    return true;
}

/* Solves for the velocities of member l of m; transform->at is that state with them. They start at 0, so that
   every state has one field, and are not finite if the solver fails. */
static void find_velocities(struct transform *transform, const double *y, size_t m, size_t l, double *v)
{
    const struct gm_user_lagrangian *model = model_of(transform->problem);
    const struct gm_implicit_equations equations = {.size = model->half,
                                                    .data = transform,
                                                    .linear = momenta_at,
                                                    .counted = model->half,
                                                    .least = 0x1p-52,
                                                    .roundoff = 0x1p-40,
                                                    .halved = true,
                                                    .exact = model->linear};
    struct gm_progress ignored = {0};
    gm_member_take(y, transform->at, model->components, m, l);
    memcpy(transform->wanted, transform->at + model->half, model->half * sizeof *v);
    memset(v, 0, model->half * sizeof *v);
    if (!gm_newton_solve(&equations, transform->scratch, v, &ignored)) {
        no_numbers(v, model->half);
    }
    memcpy(transform->at + model->half, v, model->half * sizeof *v);
}

/* Returns a copy of the m states whose momenta are replaced by velocities, or by 0 if `found` is false. The
   caller frees it; NULL when out of memory, and the `count` numbers are then NaN. */
static double *at_velocities(const struct gm_problem *problem, const double *y, size_t m, bool found,
                             double *numbers, size_t count)
{
    const struct gm_user_lagrangian *model = model_of(problem);
    const size_t half = model->half, n = model->components;
    double *at = malloc((n * m + half + transform_size(model)) * sizeof *at);
    if (!at) {
        no_numbers(numbers, count);
        return NULL;
    }
    double *v = at + n * m;
    struct transform transform = lay_transform(problem, v + half);
    memcpy(at, y, n * m * sizeof *at);
    memset(at + half * m, 0, half * m * sizeof *at);
    for (size_t l = 0; found && l < m; l++) {
        find_velocities(&transform, y, m, l, v);
        gm_member_put(v, at + half * m, half, m, l);
    }
    return at;
}

static void field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    const size_t half = model_of(problem)->half, n = problem->n;
    double *at = at_velocities(problem, y, m, true, f, n * m);
    if (at) {
        memcpy(f, at + half * m, half * m * sizeof *f);
        gm_user_values(problem, GM_USER_RATES, at, f + half * m, m);
        for (size_t i = 2 * half * m; i < n * m; i++) {
            f[i] = 1; /* the rate of t */
        }
    }
    free(at);
}

static void velocity(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    const size_t count = model_of(problem)->half * m;
    double *at = at_velocities(problem, y, m, true, f, count);
    if (at) {
        memcpy(f, at + count, count * sizeof *f);
    }
    free(at);
}

static void force(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    double *at = at_velocities(problem, y, m, false, f, model_of(problem)->half * m);
    if (at) {
        gm_user_values(problem, GM_USER_RATES, at, f, m);
    }
    free(at);
}

void gm_user_lagrangian_energy(const struct gm_problem *problem, const double *y, double *energy, size_t m)
{
    const size_t half = model_of(problem)->half;
    double *at = at_velocities(problem, y, m, true, energy, m);
    if (at) {
        gm_user_values(problem, GM_USER_ACTION, at, energy, m);
        for (size_t l = 0; l < m; l++) {
            double sum = 0;
            for (size_t i = half; i < 2 * half; i++) {
                sum += y[i * m + l] * at[i * m + l];
            }
            energy[l] = sum - energy[l];
        }
    }
    free(at);
}

void gm_user_lagrangian_motion(const struct gm_problem *problem, const double *at,
                               const struct gm_motion *motion)
{
    const struct gm_user_lagrangian *model = model_of(problem);
    const size_t half = model->half, square = half * half * sizeof(double);
    double values[GM_NEWTON_LARGEST * GM_NEWTON_LARGEST];
    gm_user_values(problem, GM_USER_MOMENTA, at, values, 1);
    memcpy(motion->momenta, values, half * sizeof *values);
    gm_user_values(problem, GM_USER_RATES, at, motion->forces, 1);
    gm_user_values(problem, GM_USER_ACTION_SLOPES, at, values, 1);
    /* of momenta and forces, over q and v */
    double *const matrices[2][2] = {{motion->momenta_q, motion->momenta_v},
                                    {motion->forces_q, motion->forces_v}};
    for (size_t i = 0; i < 4; i++) {
        memset(matrices[i / 2][i % 2], 0, square);
    }
    for (size_t i = 0; i < model->slopes.count; i++) {
        const struct gm_sparse_entry *slope = &model->slopes.entries[i];
        if (slope->column < 2 * half) {
            double *matrix = matrices[slope->row >= half][slope->column >= half];
            matrix[slope->row % half * half + slope->column % half] = values[i];
        }
    }
}

/* dL/dv(q, v, t) = p gives M dv = dp - B dq - b dt. */
static void jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    const struct gm_user_lagrangian *model = model_of(problem);
    const size_t half = model->half, n = model->components, count = model->slopes.count;
    const struct gm_sparse_entry *entries = model->slopes.entries;
    /* columns of dv over the state, the slopes' values, a velocity */
    double *columns = calloc(n * half + count + half + transform_size(model), sizeof *columns);
    if (!columns) {
        no_numbers(matrix, n * n);
        return;
    }
    double *values = columns + n * half, *v = values + count;
    struct transform transform = lay_transform(problem, v + half);
    find_velocities(&transform, y, 1, 0, v);
    gm_user_values(problem, GM_USER_ACTION_SLOPES, transform.at, values, 1);
    memset(matrix, 0, n * n * sizeof *matrix);
    for (size_t i = 0; i < half; i++) {
        columns[(half + i) * half + i] = 1;
    }
    for (size_t i = 0; i < count; i++) {
        if (entries[i].row < half && !is_of_mass(model, &entries[i])) {
            columns[entries[i].column * half + entries[i].row] -= values[i];
        }
    }
    fill_mass(model, values, false, transform.scratch);
    gm_eliminate_columns(half, transform.scratch, n, columns);
    for (size_t c = 0; c < n; c++) {
        for (size_t i = 0; i < half; i++) {
            matrix[i * n + c] = columns[c * half + i];
        }
    }
    for (size_t i = 0; i < count; i++) {
        const size_t row = entries[i].row, column = entries[i].column;
        if (row >= half && column >= half && column < 2 * half) {
            for (size_t c = 0; c < n; c++) {
                matrix[row * n + c] += values[i] * columns[c * half + column - half];
            }
        } else if (row >= half) {
            matrix[row * n + column] += values[i];
        }
    }
    if (!isfinite(v[0])) {
        no_numbers(matrix, n * n);
    }
    free(columns);
}

const struct gm_loops gm_user_lagrangian_loops = {
    .field = field, .velocity = velocity, .force = force, .jacobian = jacobian};
