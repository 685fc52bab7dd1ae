/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions of rows, GM_WIDTH numbers at a time. Compiled for each set of instructions, of the name GM_ISA. */
#include "core/functions/rows.h"

#define GM_PASS_SCALAR
#include "core/functions/lanes.h"

#include "core/functions/pass.h"
#undef GM_PASS_SCALAR
#include "core/functions/lanes.h"

#include "core/functions/pass.h"

/* The next numbers of an operand; after the last ones some that functions take without a question. */
GM_INLINE gm_lanes operand(const double *x, bool one, size_t at, size_t left)
{
    if (one) {
        return K(constant)(*x);
    }
    if (left >= GM_WIDTH) {
        return K(load)(x + at);
    }
    gm_lanes some = K(constant)(1);
    for (size_t i = 0; i < left; i++) {
        some[i] = x[at + i];
    }
    return some;
}

GM_INLINE void result(double *to, gm_lanes value, size_t left)
{
    if (left >= GM_WIDTH) {
        K(store)(to, value);
        return;
    }
    for (size_t i = 0; i < left; i++) {
        to[i] = value[i];
    }
}

#define GM_VALUE_1(name) K(name)(operand(x, one_x, i, count - i))
#define GM_VALUE_2(name) K(name)(operand(x, one_x, i, count - i), operand(y, one_y, i, count - i))
#define GM_FUNCTION(name, arity)                                                                             \
    static void name##_row(double *to, const double *x, bool one_x, const double *y, bool one_y,             \
                           size_t count)                                                                     \
    {                                                                                                        \
        (void)y, (void)one_y;                                                                                \
        for (size_t i = 0; i < count; i += GM_WIDTH) {                                                       \
            result(to + i, GM_VALUE_##arity(name), count - i);                                               \
        }                                                                                                    \
    }
#include "core/functions/functions.def"

static void sine_and_cosine(double *sine, double *cosine, const double *x, size_t count)
{
    for (size_t i = 0; i < count; i += GM_WIDTH) {
        const gm_lanes angle = operand(x, false, i, count - i);
        result(sine + i, K(sin)(angle), count - i);
        result(cosine + i, K(cos)(angle), count - i);
    }
}

#define GM_ROWS_NAME(isa) GM_ROWS_NAME_(isa)
#define GM_ROWS_NAME_(isa) gm_function_rows_##isa
const struct gm_function_rows GM_ROWS_NAME(GM_ISA) = {
    .sine_and_cosine = sine_and_cosine,
#define GM_FUNCTION(name, arity) .name = name##_row,
#include "core/functions/functions.def"
};
