/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The harmonic oscillator, (q, p), H = p^2/2 + V(q), V = q^2/2. */
#ifdef GM_TANGENT
#define GM_COMPONENTS 6
#else
#define GM_COMPONENTS 2
#endif
#define GM_SEPARABLE

GM_INLINE real K(slope)(real q)
{
    return q;
}
GM_INLINE real K(curvature)(real q)
{
    return (void)q, K(constant)(1);
}
GM_INLINE real K(third)(real q)
{
    return (void)q, K(constant)(0);
}

#include "core/ode/kernel/one_degree.h"
