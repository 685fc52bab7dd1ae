/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lane type `real` of one pass, and `pattern`, the bits of its numbers. A source of functions or kernels
   includes this twice: with GM_PASS_SCALAR real is a double, for a single run; otherwise a vector of GM_WIDTH
   doubles, for a block of members of an ensemble. Every operation is the same IEEE operation in both, lane by
   lane, so a member's bits do not depend on the pass. K(name) is the name of a function of this pass. */

#ifndef GM_INLINE /* once for both passes */

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define GM_INLINE static inline __attribute__((always_inline, unused))

/* Unrolls the next loop, whose count is known at compile time (gcc: by at most 8). */
#ifdef __clang__
#define GM_UNROLL _Pragma("clang loop unroll(full)")
#else
#define GM_UNROLL _Pragma("GCC unroll 8")
#endif

/* A lane type as wide as a register: wider ones live in memory (measured: four times slower). */
#if defined(__AVX512F__)
enum { GM_WIDTH = 8 };
#elif defined(__AVX2__)
enum { GM_WIDTH = 4 };
#else
enum { GM_WIDTH = 2 };
#endif
typedef double gm_lanes __attribute__((vector_size(GM_WIDTH * 8)));
typedef int64_t gm_lanes_mask __attribute__((vector_size(GM_WIDTH * 8)));
typedef uint64_t gm_lanes_pattern __attribute__((vector_size(GM_WIDTH * 8)));
typedef long long gm_lanes_signs __attribute__((vector_size(GM_WIDTH * 8))); /* a name that builtins take */
/* Lanes in the state, aligned like doubles. One instruction moves them: memcpy makes two halves of them, for
   which the register then has to wait. */
typedef double gm_lanes_of_state __attribute__((vector_size(GM_WIDTH * 8), aligned(8), may_alias));

/* Two components of one member, side by side in the state, in one register. */
typedef double gm_packed __attribute__((vector_size(16), aligned(8), may_alias));
typedef int64_t gm_packed_bits __attribute__((vector_size(16)));

#endif

#undef real
#undef mask
#undef pattern
#undef GM_LANES
#undef K
#ifdef GM_PASS_SCALAR

#define real double
#define mask bool
#define pattern uint64_t
#define GM_LANES 1
#define K(name) name##_scalar

GM_INLINE uint64_t K(bits)(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}
GM_INLINE double K(number)(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

GM_INLINE double K(constant)(double value)
{
    return value;
}
GM_INLINE double K(load)(const double *from)
{
    return *from;
}
GM_INLINE void K(store)(double *to, double x)
{
    *to = x;
}
GM_INLINE double K(pick)(bool choose, double yes, double no)
{
    return choose ? yes : no;
}
GM_INLINE double K(magnitude)(double x)
{
    return fabs(x);
}
GM_INLINE bool K(distance)(double x, double limit)
{
    return !(fabs(x) <= limit);
}
GM_INLINE bool K(farther)(bool a, bool b)
{
    return a | b;
}
GM_INLINE bool K(somewhere_beyond)(bool farthest, double limit)
{
    return (void)limit, farthest;
}
GM_INLINE double K(root)(double x)
{
    return sqrt(x);
}
/* yes where all bits of `which` are set, otherwise no; and x with its sign turned by a bit. In registers of
   numbers: a way through others takes longer than this. */
GM_INLINE double K(blend)(uint64_t which, double yes, double no)
{
    const gm_packed_bits chosen = {(int64_t)which}, of_yes = (gm_packed_bits)(gm_packed){yes},
                         of_no = (gm_packed_bits)(gm_packed){no};
    return ((gm_packed)((chosen & of_yes) | (~chosen & of_no)))[0];
}
GM_INLINE double K(turned_by)(double x, uint64_t sign)
{
    const gm_packed_bits bits = {(int64_t)sign};
    return ((gm_packed)((gm_packed_bits)(gm_packed){x} ^ bits))[0];
}
/* the bits where chosen, else 0 */
GM_INLINE uint64_t K(pick_bits)(bool choose, uint64_t bits)
{
    return choose ? bits : 0;
}
GM_INLINE bool K(everywhere)(bool which)
{
    return which;
}
GM_INLINE bool K(somewhere)(bool which)
{
    return which;
}
GM_INLINE unsigned K(holding)(bool which, int lanes)
{
    return (void)lanes, which;
}
GM_INLINE bool K(all)(void)
{
    return true;
}
GM_INLINE double K(lane)(double x, int lane)
{
    return (void)lane, x;
}
GM_INLINE uint64_t K(pattern_lane)(uint64_t bits, int lane)
{
    return (void)lane, bits;
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
#define pattern gm_lanes_pattern
#define GM_LANES GM_WIDTH
#define K(name) name##_lanes

GM_INLINE gm_lanes_pattern K(bits)(gm_lanes x)
{
    return (gm_lanes_pattern)x;
}
GM_INLINE gm_lanes K(number)(gm_lanes_pattern bits)
{
    return (gm_lanes)bits;
}

GM_INLINE gm_lanes K(constant)(double value)
{
    return value - (gm_lanes){0};
}
GM_INLINE gm_lanes K(load)(const double *from)
{
    return *(const gm_lanes_of_state *)from;
}
GM_INLINE void K(store)(double *to, gm_lanes x)
{
    *(gm_lanes_of_state *)to = x;
}
GM_INLINE gm_lanes K(pick)(gm_lanes_mask choose, gm_lanes yes, gm_lanes no)
{
    return (gm_lanes)((choose & (gm_lanes_mask)yes) | (~choose & (gm_lanes_mask)no));
}
GM_INLINE gm_lanes K(magnitude)(gm_lanes x)
{
    return (gm_lanes)((gm_lanes_mask)x & INT64_MAX);
}
/* The signs of lanes, one bit each: compilers take lanes out one by one for such a question. */
GM_INLINE int K(signs)(gm_lanes_mask which)
{
#if defined(__AVX512DQ__)
    return (unsigned char)__builtin_ia32_cvtq2mask512((gm_lanes_signs)which);
#elif defined(__AVX2__)
    return __builtin_ia32_movmskpd256((gm_lanes)which);
#elif defined(__SSE2__)
    return __builtin_ia32_movmskpd((gm_lanes)which);
#else
    int signs = 0;
    for (int i = 0; i < GM_WIDTH; i++) {
        signs |= (which[i] < 0) << i;
    }
    return signs;
#endif
}
/* Combines, for K(somewhere_beyond), the magnitudes of all x so far: their bits are ordered like the numbers,
   NaN last. A comparison of numbers would use the registers of masks, where each waits for the last. With an
   instruction for it, the largest bits, which GCC makes of this loop alone; otherwise lanes that are negative
   once a magnitude was beyond the positive limit. */
GM_INLINE gm_lanes_mask K(farther)(gm_lanes_mask a, gm_lanes_mask b)
{
#ifdef __AVX512F__
    for (int i = 0; i < GM_WIDTH; i++) {
        a[i] = a[i] > b[i] ? a[i] : b[i];
    }
    return a;
#else
    return a | b;
#endif
}
GM_INLINE gm_lanes_mask K(distance)(gm_lanes x, double limit)
{
    const gm_lanes_mask bits = (gm_lanes_mask)x & INT64_MAX;
#ifdef __AVX512F__
    return (void)limit, bits;
#else
    return (gm_lanes_mask)K(constant)(limit) - bits;
#endif
}
GM_INLINE bool K(somewhere_beyond)(gm_lanes_mask farthest, double limit)
{
#ifdef __AVX512F__
    farthest = (gm_lanes_mask)K(constant)(limit) - farthest;
#else
    (void)limit; /* K(distance) has compared with it */
#endif
    return K(signs)(farthest) != 0;
}
GM_INLINE gm_lanes K(root)(gm_lanes x)
{
    for (int i = 0; i < GM_WIDTH; i++) {
        x[i] = sqrt(x[i]);
    }
    return x;
}
GM_INLINE gm_lanes K(blend)(gm_lanes_pattern which, gm_lanes yes, gm_lanes no)
{
    return (gm_lanes)((which & (gm_lanes_pattern)yes) | (~which & (gm_lanes_pattern)no));
}
GM_INLINE gm_lanes K(turned_by)(gm_lanes x, gm_lanes_pattern sign)
{
    return (gm_lanes)((gm_lanes_pattern)x ^ sign);
}
GM_INLINE gm_lanes_pattern K(pick_bits)(gm_lanes_mask choose, gm_lanes_pattern bits)
{
    return (gm_lanes_pattern)choose & bits;
}
GM_INLINE bool K(everywhere)(gm_lanes_mask which)
{
    return K(signs)(which) == (1 << GM_WIDTH) - 1;
}
GM_INLINE bool K(somewhere)(gm_lanes_mask which)
{
    return K(signs)(which) != 0;
}
/* the number of lanes, of the first `lanes`, where it holds */
GM_INLINE unsigned K(holding)(gm_lanes_mask which, int lanes)
{
    return (unsigned)__builtin_popcount((unsigned)K(signs)(which) & ((1U << lanes) - 1));
}
GM_INLINE gm_lanes_mask K(all)(void)
{
    return ~(gm_lanes_mask){0};
}
GM_INLINE double K(lane)(gm_lanes x, int lane)
{
    return x[lane];
}
GM_INLINE uint64_t K(pattern_lane)(gm_lanes_pattern bits, int lane)
{
    return bits[lane];
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
