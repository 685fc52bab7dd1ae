/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_RANDOM_FORMULA_H
#define GM_TESTS_COMMON_RANDOM_FORMULA_H

#include <stdio.h>

/* Writes a formula of rand() in variables, each a letter, with every operation that formulas have. */
void gm_random_formula(FILE *out, const char *variables, int depth);

#endif
