/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Four things that any file may need. */
#ifndef GM_CORE_BASICS_H
#define GM_CORE_BASICS_H

/* The number of elements of an array. */
#define GM_COUNT(array) (sizeof(array) / sizeof(array)[0])

/* A hot loop over points, compiled for several instruction sets and picked when the program is loaded. No
   clone fuses or reorders an operation (-ffp-contract=off), so all give the same bits. It is inlined
   nowhere. clang 14 cannot link clones of one name in two files, even of static functions. */
#if defined GM_LOOPS_X86 && !defined __clang__
#define GM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GM_CLONES __attribute__((noinline))
#endif

/* Before a loop: no array that it writes overlaps another one, so that it can be vectorised. clang takes such words for
   an order, and warns of loops that it leaves as they are. */
#ifdef __clang__
#define GM_NO_OVERLAP
#else
#define GM_NO_OVERLAP _Pragma("GCC ivdep")
#endif

/* The larger of both; NaN if one is NaN, which fmax loses. */
static inline double gm_larger(double a, double b)
{
    return a > b || a != a ? a : b;
}

#endif
