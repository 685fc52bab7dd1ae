/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pendulum, (q, p), H = p^2/2 + V(q), V = -cos q. */
#ifdef GM_TANGENT
#define GM_COMPONENTS 6
#else
#define GM_COMPONENTS 2
#endif
#define GM_SEPARABLE

GM_INLINE real K(slope)(real q)
{
    return K(sine)(q);
}
GM_INLINE real K(curvature)(real q)
{
    return K(cosine)(q);
}
GM_INLINE real K(third)(real q)
{
    return -K(sine)(q);
}

#include "core/ode/kernel/one_degree.h"
