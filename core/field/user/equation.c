/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/field/user/equation.h"

#include <string.h>

#include "core/field/problems/problems.h"

/* The parameters of every equation. */
union equation {
    struct gm_user_line line; /* first of all */
    struct gm_framed framed;  /* first of all but the nonlinear Schroedinger equation */
    struct gm_kdv kdv;
    struct gm_nls nls;
    struct gm_burgers burgers;
};

static const struct gm_problem *const problems[] = {&gm_problem_kdv, &gm_problem_nls, &gm_problem_heat,
                                                    &gm_problem_burgers};

static const struct gm_problem *problem_of(const struct gm_user_equation *equation)
{
    const struct gm_problem *found = NULL;
    for (size_t i = 0; i < sizeof problems / sizeof *problems && equation->recognised.name; i++) {
        found = strcmp(problems[i]->name, equation->recognised.name) == 0 ? problems[i] : found;
    }
    return found;
}

/* Adds the rate of one field at the start to the formulas of the start. */
static bool derive_rate(struct gm_line_formulas *formulas, struct gm_user_system *system)
{
    gm_node_id *others = gm_system_no_nodes(system, system->variable_count),
               last = system->variables[0].start;
    for (size_t k = 0; others && k <= GM_MOST_DERIVATIVES && !system->graph.failed; k++) {
        others[k == 0 ? 0 : system->velocities + k] = last;
        last = gm_system_derivative(system, last, system->velocities);
    }
    formulas->start[1] = system->rates[0];
    return others && !system->graph.failed &&
           gm_formula_substitute(&system->graph, &formulas->start[1], 1, others, system->variable_count) &&
           gm_system_place(system, &formulas->start[1], 1);
}

bool gm_user_equation_derive(struct gm_user_equation *equation, struct gm_user_system *system)
{
    *equation = (struct gm_user_equation){.system = system, .outputs = system->n};
    if (!gm_equation_recognise(system, &equation->recognised)) {
        return false;
    }
    const struct gm_problem *problem = problem_of(equation);
    if (!problem) {
        return true;
    }
    equation->needs = gm_field_of(problem)->equation;
    const bool rates = equation->needs == GM_NEEDS_KDV && !gm_line_is_solved(system);
    equation->outputs += rates;
    return gm_line_derive(&equation->formulas, system) &&
           (!rates || derive_rate(&equation->formulas, system));
}

double gm_frames_number(const struct gm_user_system *system, const double *values, const char *name,
                        double otherwise)
{
    const char *hook = system->texts[GM_WORD_HOOK];
    for (size_t i = system->parameters; hook && i < system->velocities; i++) {
        if (strcmp(hook, "frames") == 0 && strcmp(system->variables[i].name, name) == 0) {
            return values[i];
        }
    }
    return otherwise;
}

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct gm_line_opening *opening = data;
    const struct gm_user_equation *equation = opening->formulas;
    const double *values = opening->values;
    const struct gm_user_system *system = equation->system;
    struct gm_problem *problem = opening->problem;
    union equation *parameters = gm_user_line_take(arena, problem, system, sizeof *parameters);
    const size_t points = problem->line.points;
    double constants[GM_EQUATION_CONSTANTS] = {0};
    size_t count = 0;
    while (count < GM_EQUATION_CONSTANTS && equation->recognised.constants[count]) {
        count++;
    }
    gm_arena_need(arena, gm_user_line_numbers(system, equation->recognised.values, count, values, constants));
    gm_user_line_open(&parameters->line, equation->formulas.start, equation->outputs,
                      equation->formulas.exact, values);
    if (equation->needs != GM_NEEDS_NLS) {
        parameters->framed.lambda = gm_frames_number(system, values, "lambda", 0);
    }
    switch (equation->needs) {
    case GM_NEEDS_KDV:
        parameters->kdv.eta = constants[0];
        parameters->kdv.mu = constants[1];
        problem->n = gm_wave_size(points);
        break;
    case GM_NEEDS_NLS:
        parameters->nls.k = constants[0];
        problem->n = 2 * points;
        break;
    case GM_NEEDS_HEAT:
        parameters->framed.viscosity = constants[0];
        problem->n = points;
        break;
    default:
        parameters->framed.viscosity = constants[0];
        parameters->burgers.a = gm_frames_number(system, values, "a", -0.5);
        parameters->burgers.d = gm_frames_number(system, values, "d", 0);
        problem->n = gm_burgers_size(&parameters->burgers, points);
        break;
    }
}

bool gm_user_equation_open(struct gm_problem *problem, const struct gm_user_equation *equation,
                           const double *values, const struct gm_grid1 *line)
{
    *problem = *problem_of(equation);
    problem->line = *line;
    return gm_user_line_problem(open_problem, &(struct gm_line_opening){problem, equation, values, NULL});
}
