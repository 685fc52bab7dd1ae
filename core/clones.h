/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_CLONES_H
#define GM_CORE_CLONES_H

/* A hot loop over points, compiled for several instruction sets and picked when the program is loaded. No
   clone fuses or reorders an operation (-ffp-contract=off), so all give the same bits. It is inlined nowhere. */
#ifdef GM_LOOPS_X86
#define GM_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GM_CLONES __attribute__((noinline))
#endif

#endif
