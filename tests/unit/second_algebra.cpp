// SPDX-License-Identifier: GPL-3.0-or-later
// First and second derivatives of forty formulas against those of GiNaC, another computer algebra, to 30 digits.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <ginac/ginac.h>

extern "C" {
#include "core/expression/derivative.h"
#include "core/expression/reader.h"
}

static const char *const formulas[] = {
    "x", "x*y*z", "x^2*y - z^3/7", "(x + 2*y)^5/(1 + z^2)", "1/(x*y) - 3/(2*z)", "x/y/z + x/(y/z)",
    "-x^2 - (-y)^3", "(x - y)^4*(y - z)^-3", "x^13*y^-7", "x^17", "sqrt(x^2 + y^2 + z^2)",
    "1/sqrt((x - 2)^2 + y^2)", "(x^2 + y^2)^(3/2)", "x^y", "(1 + x^2)^(y*z)", "2^x*3^(y - z)",
    "exp(-x^2/2)*y", "exp(sin(x*y)) + exp(-z)", "log(1 + x^2 + y^4)", "log(exp(x) + exp(y) + exp(z))",
    "sin(x)*cos(y)*tan(z/4)", "sin(x + y)^2 + cos(x + y)^2", "tan(x*y/3)", "asin(x*y/8)", "acos((x - z)/5)",
    "atan(x*y*z)", "atan(y/x)", "sinh(x)*cosh(y) - tanh(z)", "tanh(x*y)^3", "cosh(x - y)/cosh(x + y)",
    "1/(1 + exp(-(x + y*z)))", "sin(cos(sin(x*y))) + z", "sqrt(1 + sqrt(1 + sqrt(1 + x^2*y^2)))",
    "exp(x - y) + exp(y - z) + exp(z - x)",
    // what the program is for: Kepler, a double pendulum, the restricted three bodies, a dipole, an electron
    "(x^2 + y^2)/2 - 1/sqrt(x^2 + y^2) - 1/(100*(x^2 + y^2)^2)",
    "(x^2 + 2*y^2 - 2*x*y*cos(z))/(2*(1 + sin(z)^2)) - 2*cos(z)",
    "(3/4)/sqrt((x + 1/4)^2 + y^2) + (1/4)/sqrt((x - 3/4)^2 + y^2) + x*z - y*z",
    "z*x/(x^2 + y^2 + z^2)^(5/2)", "sqrt(1 + (x - y*z)^2 + y^2) - cos(z)*x", "log(x/y)*sin(z)/(1 + x*y)^2"};

static const double points[][3] = {{0.625, 1.375, 0.25}, {1.75, 0.5, 1.125}};
static const char names[] = "xyz";

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *)
{
    *node = gm_formula_variable(static_cast<gm_formula *>(data),
                                static_cast<size_t>(std::strchr(names, name->text[0]) - names));
    return GM_KNOWN;
}

static int failures = 0;

static void compare(const char *formula, const char *what, double ours, const GiNaC::ex &theirs)
{
    const GiNaC::ex number = theirs.evalf();
    const double wanted =
        GiNaC::is_a<GiNaC::numeric>(number) ? GiNaC::ex_to<GiNaC::numeric>(number).to_double() : NAN;
    if (!(std::fabs(ours - wanted) <= 1e-12 * (1 + std::fabs(wanted)))) {
        std::printf("FAILED: %s, %s: %.17g, by GiNaC %.17g\n", formula, what, ours, wanted);
        failures++;
    }
}

static void check(const char *formula)
{
    GiNaC::symtab table;
    const GiNaC::symbol symbols[3] = {GiNaC::symbol("x"), GiNaC::symbol("y"), GiNaC::symbol("z")};
    for (const GiNaC::symbol &symbol : symbols) {
        table[symbol.get_name()] = symbol;
    }
    GiNaC::parser reader(table);
    const GiNaC::ex theirs = reader(formula);

    gm_formula graph;
    gm_fault fault;
    gm_scope scope = {};
    gm_node_id node, gradient[3], hessian[3][3], along[3];
    const bool all[3] = {true, true, true};
    gm_formula_open(&graph);
    scope.find = find;
    scope.data = &graph;
    bool good = gm_formula_read(&graph, formula, 0, std::strlen(formula), &scope, &node, &fault) &&
                gm_gradient(&graph, node, all, 3, gradient);
    for (int i = 0; i < 3 && good; i++) {
        gm_node_id direction[3];
        for (int k = 0; k < 3; k++) {
            direction[k] = gm_formula_constant(&graph, i == k);
        }
        along[i] = gm_derivative_along(&graph, node, direction, 3);
        good = along[i] != GM_NO_NODE && gm_gradient(&graph, gradient[i], all, 3, hessian[i]);
    }
    if (!good) {
        std::printf("FAILED: %s: %s\n", formula, fault.sentence);
        failures++;
        gm_formula_close(&graph);
        return;
    }
    std::vector<double> values(graph.count);
    for (const double(&at)[3] : points) {
        GiNaC::exmap here;
        for (int k = 0; k < 3; k++) {
            here[symbols[k]] = GiNaC::numeric(static_cast<long>(at[k] * 8), 8L);
        }
        gm_formula_evaluate(&graph, graph.count, at, values.data());
        compare(formula, "value", values[node], theirs.subs(here));
        for (int i = 0; i < 3; i++) {
            const GiNaC::ex slope = theirs.diff(symbols[i]);
            const std::string over(1, names[i]);
            compare(formula, ("slope over " + over).c_str(), values[gradient[i]], slope.subs(here));
            compare(formula, ("slope along " + over).c_str(), values[along[i]], slope.subs(here));
            for (int k = 0; k < 3; k++) {
                compare(formula, ("second slope over " + over + names[k]).c_str(), values[hessian[i][k]],
                        slope.diff(symbols[k]).subs(here));
            }
        }
    }
    gm_formula_close(&graph);
}

int main()
{
    GiNaC::Digits = 30;
    int count = 0;
    for (const char *formula : formulas) {
        check(formula);
        count++;
    }
    if (count < 40) {
        std::printf("FAILED: only %d formulas\n", count);
        failures++;
    }
    return failures > 0;
}
