/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_NUMBER_H
#define GM_CORE_EXPRESSION_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

/* Evaluates a formula without names, such as "1e-3", "pi/60", "2*pi", "sqrt(2/3)", ".5/800" (grammar:
   core/expression/reader.h). Returns false, and leaves *value alone, for any other text. The value may be
   infinite or NaN. */
bool gm_number_parse(const char *text, double *value);

/* Writes value so that gm_number_parse gives the same double: multiples and fractions of pi as such, others
   as the shortest decimal. Returns text. */
char *gm_number_format(double value, char *text, size_t size);

/* The ending of a noun after its number. */
static inline const char *gm_plural(double number)
{
    return number == 1 ? "" : "s";
}

#endif
