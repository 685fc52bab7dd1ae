/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elementary functions of rows of numbers. */
#ifndef GM_CORE_FUNCTIONS_ROWS_H
#define GM_CORE_FUNCTIONS_ROWS_H

#include <stdbool.h>
#include <stddef.h>

/* A function of rows: to[i] = f(x[i], y[i]); an operand that is the same for all has one number. y is not read by
   functions of one. */
typedef void gm_function_row(double *to, const double *x, bool one_x, const double *y, bool one_y,
                             size_t count);
struct gm_function_rows {
    /* both of each x, with the bits of sin and cos */
    void (*sine_and_cosine)(double *sine, double *cosine, const double *x, size_t count);
#define GM_FUNCTION(name, arity) gm_function_row *name;
#include "core/functions/functions.def"
};

/* The functions compiled for each set of instructions. */
extern const struct gm_function_rows gm_function_rows_baseline;
extern const struct gm_function_rows gm_function_rows_avx2;
extern const struct gm_function_rows gm_function_rows_avx512;

/* Returns the functions for the best set of instructions of this machine. */
const struct gm_function_rows *gm_function_rows(void);

#endif
