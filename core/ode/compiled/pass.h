/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One pass of core/ode/compiled/over_kernels.c: the lane type, the problem's kernels, every family's loop. */

#include "core/functions/lanes.h"

#include GM_KERNELS

#ifdef GM_SEPARABLE
GM_INLINE void K(field)(const real *y, real *f, const void *parameters)
{
    K(velocity)(y + GM_COMPONENTS / 2, f, parameters);
    K(force)(y, f + GM_COMPONENTS / 2, parameters);
}
#endif

#include "core/ode/kernel/block.h"

#ifdef GM_LOOP_EXPLICIT
#include "core/ode/families/runge_kutta/explicit.loop.h"
#endif
#ifdef GM_LOOP_IMPLICIT
#include "core/ode/families/runge_kutta/implicit.loop.h"
#endif
#if defined(GM_LOOP_SPLITTING) && defined(GM_SEPARABLE)
#include "core/ode/families/splitting/splitting.loop.h"
#endif

#undef real
#undef mask
#undef pattern
#undef GM_LANES
#undef K
