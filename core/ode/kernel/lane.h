/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lane type `real` of one pass over a problem's kernels. core/ode/families/over_kernels.c includes this
   twice: with GM_PASS_SCALAR real is a double, for a single run; otherwise a vector of GM_WIDTH doubles, for
   a block of members of an ensemble. Every operation is the same IEEE operation in both, lane by lane, so a
   member's bits do not depend on the pass. K(name) is the name of a function of this pass. */

#ifdef GM_PASS_SCALAR

#define real double
#define mask bool
#define GM_LANES 1
#define K(name) name##_scalar

GM_INLINE double K(constant)(double value)
{
    return value;
}
GM_INLINE double K(pick)(bool choose, double yes, double no)
{
    return choose ? yes : no;
}
GM_INLINE double K(magnitude)(double x)
{
    return fabs(x);
}
GM_INLINE double K(root)(double x)
{
    return sqrt(x);
}
GM_INLINE double K(sine)(double x)
{
    return sin(x);
}
GM_INLINE double K(cosine)(double x)
{
    return cos(x);
}
GM_INLINE bool K(everywhere)(bool which)
{
    return which;
}
GM_INLINE bool K(somewhere)(bool which)
{
    return which;
}
GM_INLINE bool K(all)(void)
{
    return true;
}
GM_INLINE double K(lane)(double x, int lane)
{
    return (void)lane, x;
}
GM_INLINE void K(set_lane)(double *x, int lane, double value)
{
    (void)lane, *x = value;
}
GM_INLINE bool K(mask_lane)(bool which, int lane)
{
    return (void)lane, which;
}
GM_INLINE void K(set_mask_lane)(bool *which, int lane, bool value)
{
    (void)lane, *which = value;
}
GM_INLINE bool K(other)(bool which)
{
    return !which;
}
GM_INLINE bool K(both)(bool a, bool b)
{
    return a && b;
}
GM_INLINE bool K(either)(bool a, bool b)
{
    return a || b;
}

#else

#define real gm_lanes
#define mask gm_lanes_mask
#define GM_LANES GM_WIDTH
#define K(name) name##_lanes

GM_INLINE gm_lanes K(constant)(double value)
{
    return value - (gm_lanes){0};
}
GM_INLINE gm_lanes K(pick)(gm_lanes_mask choose, gm_lanes yes, gm_lanes no)
{
    return (gm_lanes)((choose & (gm_lanes_mask)yes) | (~choose & (gm_lanes_mask)no));
}
GM_INLINE gm_lanes K(magnitude)(gm_lanes x)
{
    return (gm_lanes)((gm_lanes_mask)x & INT64_MAX);
}
GM_INLINE gm_lanes K(root)(gm_lanes x)
{
    for (int i = 0; i < GM_WIDTH; i++) {
        x[i] = sqrt(x[i]);
    }
    return x;
}
GM_INLINE gm_lanes K(sine)(gm_lanes x)
{
    for (int i = 0; i < GM_WIDTH; i++) {
        x[i] = sin(x[i]);
    }
    return x;
}
GM_INLINE gm_lanes K(cosine)(gm_lanes x)
{
    for (int i = 0; i < GM_WIDTH; i++) {
        x[i] = cos(x[i]);
    }
    return x;
}
GM_INLINE bool K(everywhere)(gm_lanes_mask which)
{
    int64_t all = -1;
    for (int i = 0; i < GM_WIDTH; i++) {
        all &= which[i];
    }
    return all != 0;
}
GM_INLINE bool K(somewhere)(gm_lanes_mask which)
{
    int64_t any = 0;
    for (int i = 0; i < GM_WIDTH; i++) {
        any |= which[i];
    }
    return any != 0;
}
GM_INLINE gm_lanes_mask K(all)(void)
{
    return ~(gm_lanes_mask){0};
}
GM_INLINE double K(lane)(gm_lanes x, int lane)
{
    return x[lane];
}
GM_INLINE void K(set_lane)(gm_lanes *x, int lane, double value)
{
    (*x)[lane] = value;
}
GM_INLINE bool K(mask_lane)(gm_lanes_mask which, int lane)
{
    return which[lane] != 0;
}
GM_INLINE void K(set_mask_lane)(gm_lanes_mask *which, int lane, bool value)
{
    (*which)[lane] = value ? -1 : 0;
}
GM_INLINE gm_lanes_mask K(other)(gm_lanes_mask which)
{
    return ~which;
}
GM_INLINE gm_lanes_mask K(both)(gm_lanes_mask a, gm_lanes_mask b)
{
    return a & b;
}
GM_INLINE gm_lanes_mask K(either)(gm_lanes_mask a, gm_lanes_mask b)
{
    return a | b;
}

#endif
