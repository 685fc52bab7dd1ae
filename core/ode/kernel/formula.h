/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operations of formulas over the lane type, for kernels that are written from formulas: K(sin)(a) of
   core/functions, K(value_MOD)(a, b) of others. Those are the C of core/expression/operations.def, which the
   interpreter uses too, lane by lane; one operation if registers have it. Included for each pass. */
#include "core/expression/arithmetic.h"

#include "core/functions/pass.h"

/* With registers they are functions: inlined, lane by lane, they take most of a compiler's time. */
#undef GM_OF_LIBRARY
#ifdef GM_PASS_SCALAR
#define GM_OF_LIBRARY GM_INLINE
#else
#define GM_OF_LIBRARY static __attribute__((noinline, unused))
#endif
#define GM_OPERATION(constant, name, latex, arity, smooth, value, over_a, over_b)                            \
    GM_OF_LIBRARY real K(value_##constant)(real x, real y)                                                   \
    {                                                                                                        \
        for (int l = 0; l < GM_LANES; l++) {                                                                 \
            const double a = K(lane)(x, l), b = K(lane)(y, l);                                               \
            (void)b;                                                                                         \
            K(set_lane)(&x, l, value);                                                                       \
        }                                                                                                    \
        return x;                                                                                            \
    }
#include "core/expression/operations.def"
#undef GM_OPERATION

GM_INLINE real K(smaller)(real a, real b)
{
    return K(pick)(a < b, a, b);
}
GM_INLINE real K(larger)(real a, real b)
{
    return K(pick)(a > b, a, b);
}
GM_INLINE real K(sign)(real a)
{
    const real zero = K(constant)(0), one = K(constant)(1);
    return K(pick)(a > zero, one, zero) - K(pick)(a < zero, one, zero);
}
GM_INLINE real K(chosen)(real a, real b)
{
    return K(pick)(a > K(constant)(0.5), b, K(constant)(0));
}
GM_INLINE real K(below)(real a, real b)
{
    return K(pick)(a < b, K(constant)(1), K(constant)(0));
}
