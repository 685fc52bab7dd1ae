/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas that nobody would write. */
#include "tests/common/random_formula.h"
#include "core/basics.h"

#include <stdlib.h>
#include <string.h>

void gm_random_formula(FILE *out, const char *variables, int depth)
{
    static const char *const functions[] = {"sqrt", "exp",  "log",  "sin",  "cos",  "tan",
                                            "asin", "acos", "atan", "sinh", "cosh", "tanh",
                                            "erfc", "abs",  "min",  "max",  "mod",  "atan2"};
    enum { FUNCTIONS = GM_COUNT(functions), OF_ONE = 14 };
    const int kind = depth == 0 ? rand() % 3 : rand() % 14;
    if (kind < 2) {
        fputc(variables[(size_t)rand() % strlen(variables)], out);
    } else if (kind == 2) {
        static const char *const numbers[] = {"0", "1", "2", "0.5", "3.25", "1e-3", "7", ".1", "16", "17"};
        fputs(numbers[rand() % 10], out);
    } else if (kind < 9) {
        /* without parentheses: priorities decide */
        gm_random_formula(out, variables, depth - 1);
        fputc("+-*/^*"[kind - 3], out);
        gm_random_formula(out, variables, depth - 1);
    } else if (kind == 9) {
        fprintf(out, "(-");
        gm_random_formula(out, variables, depth - 1);
        fprintf(out, ")^%s%d", rand() % 3 ? "" : "-", rand() % 18);
    } else if (kind < 12) {
        fputc('(', out);
        gm_random_formula(out, variables, depth - 1);
        fputc(')', out);
    } else {
        const int function = rand() % FUNCTIONS;
        fprintf(out, "%s(", functions[function]);
        gm_random_formula(out, variables, depth - 1);
        if (function >= OF_ONE) {
            fputc(',', out);
            gm_random_formula(out, variables, depth - 1);
        }
        fputc(')', out);
    }
}
