/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers modulo the prime 2^61 - 1. */
#ifndef GM_CORE_EXPRESSION_RESIDUE_H
#define GM_CORE_EXPRESSION_RESIDUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint64_t gm_residue;
__extension__ typedef unsigned __int128 gm_wide;

#define GM_PRIME ((UINT64_C(1) << 61) - 1) /* 3 modulo 4: roots are powers */

/* The residue of any number: of a sum of up to 63 products of residues. */
static inline gm_residue gm_residue_folded(gm_wide sum)
{
    const gm_wide once = (sum & GM_PRIME) + (sum >> 61);
    const gm_residue folded = (gm_residue)(once & GM_PRIME) + (gm_residue)(once >> 61);
    return folded >= GM_PRIME ? folded - GM_PRIME : folded;
}

/* a b + c */
static inline gm_residue gm_residue_fused(gm_residue a, gm_residue b, gm_residue c)
{
    const gm_wide sum = (gm_wide)a * b + c;
    const gm_residue folded = (gm_residue)(sum & GM_PRIME) + (gm_residue)(sum >> 61);
    return folded >= GM_PRIME ? folded - GM_PRIME : folded;
}

static inline gm_residue gm_residue_times(gm_residue a, gm_residue b)
{
    return gm_residue_fused(a, b, 0);
}

static inline gm_residue gm_residue_plus(gm_residue a, gm_residue b)
{
    return a + b >= GM_PRIME ? a + b - GM_PRIME : a + b;
}

static inline gm_residue gm_residue_minus(gm_residue a)
{
    return a ? GM_PRIME - a : 0;
}

gm_residue gm_residue_power(gm_residue a, uint64_t n);
gm_residue gm_residue_inverse(gm_residue a);

/* A pseudorandom number (splitmix64). */
uint64_t gm_mixed(uint64_t x);

/* The residue of the number that a finite double stands for: p / q where one with p q < 2^36 rounds to this double,
   or to a neighbour of it, so that 0.1 and 8/3 are what was written; or a decimal of up to 15 digits. False: there is
   neither, and the residue is pseudorandom. Its only relation to others is that to twice and half the number: what is
   proved with it holds for other values, too, and what is refuted may hold. */
bool gm_residue_of(double value, gm_residue *residue);

/* The whole numbers with these ratios and no common divisor, the first that is not 0 above 0. False if they are not
   below 2^53, or the ratios are not fractions with parts below 2^20. P. S. Wang, ISSAC 1981, 212. */
bool gm_residues_whole(const gm_residue *residues, size_t count, double *whole);

#endif
