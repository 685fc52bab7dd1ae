/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/common/framed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/files/files.h"
#include "core/model/equations.h"

static double kernel(double nu, double x, double age, double t)
{
    return sqrt(age / (age + t)) * exp(-x * x / (4 * nu * (age + t)));
}

double heat_exact(const struct heat_solution *solution, bool fixed, double x, double t)
{
    const double nu = solution->diffusivity, age = solution->age, lambda = solution->lambda;
    const double rest = fixed ? x - lambda * t : x;
    const double factor = exp(-lambda / (4 * nu) * (2 * rest + lambda * t));
    switch (solution->start) {
    case HEAT_KERNEL:
        return factor * kernel(nu, rest, age, t);
    case HEAT_TWO:
        return factor * (kernel(nu, rest + 1.5, age, t) + 0.6 * kernel(nu, rest - 1.5, 3 * age, t));
    default:
        return factor * (0.1 + 0.45 * erfc(rest / sqrt(4 * nu * (age + t))));
    }
}

double burgers_begin(const struct burgers_solution *solution)
{
    return solution->test == BURGERS_SHOCK ? 1 : 0;
}

/* lambda = 0; without overflow for any viscosity, which for 0 means the limit */
static double unboosted(const struct burgers_solution *solution, double x, double t)
{
    const double nu = solution->viscosity;
    if (solution->test == BURGERS_SHOCK) {
        const double jump = nu > 0 ? tanh(x / (2 * nu * t)) : (double)((x > 0) - (x < 0));
        return (x - jump) / t;
    }
    if (nu == 0) {
        return (double)((x < 0) - (x > 0));
    }
    const double e = exp(-fabs(x) / nu);
    return copysign((1 - e) / (1 + e + 2 * exp(-fabs(x) / (2 * nu) - t / (4 * nu))), -x);
}

double burgers_exact(const struct burgers_solution *solution, bool fixed, double x, double t)
{
    const double back = fixed ? solution->lambda * (t - burgers_begin(solution)) : 0;
    return unboosted(solution, x - back, t) + solution->lambda;
}

static void open_file(struct framed *framed, const char *name, const struct gm_system_value *values,
                      size_t count, int frame, const struct gm_grid1 *line)
{
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SYSTEM, name);
    struct gm_fault fault;
    assert_true(gm_equations_open(&framed->system, file->text, file->length, values, count, &fault));
    assert_true(gm_user_equation_derive(&framed->equation, &framed->system));
    double *start = gm_equations_start(&framed->system, NULL);
    assert_true(gm_user_equation_open(&framed->problem, &framed->equation, start, line));
    free(start);
    ((struct gm_framed *)framed->problem.parameters)->frame = frame;
}

enum { NUMBER = 32 };
static char *written(char text[NUMBER], double number)
{
    snprintf(text, NUMBER, "%.17g", number);
    return text;
}

void heat_open(struct framed *framed, const struct heat_solution *solution, struct gm_grid1 line)
{
    static const char *const starts[] = {"kernel", "two-kernels", "front"};
    char texts[3][NUMBER];
    const struct gm_system_value values[] = {
        {"start", starts[solution->start]},
        {"diffusivity", written(texts[0], solution->diffusivity)},
        {"lambda", written(texts[1], solution->lambda)},
        {"age", written(texts[2], solution->age)},
    };
    open_file(framed, "heat", values, GM_COUNT(values), solution->frame, &line);
}

void burgers_open(struct framed *framed, const struct burgers_solution *solution, struct gm_grid1 line)
{
    char texts[4][NUMBER];
    const struct gm_system_value values[] = {
        {"test", solution->test == BURGERS_SHOCK ? "shock" : "front"},
        {"viscosity", written(texts[0], solution->viscosity)},
        {"lambda", written(texts[1], solution->lambda)},
        {"a", written(texts[2], solution->a)},
        {"d", written(texts[3], solution->d)},
    };
    open_file(framed, "burgers", values, GM_COUNT(values), solution->frame, &line);
    ((struct gm_burgers *)framed->problem.parameters)->printed = solution->printed;
}

void framed_close(struct framed *framed)
{
    gm_user_line_close(&framed->problem);
    gm_system_close(&framed->system);
}
