/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sets of instructions that loops are compiled for. */
#ifndef GM_CORE_FUNCTIONS_INSTRUCTIONS_H
#define GM_CORE_FUNCTIONS_INSTRUCTIONS_H

enum gm_isa { GM_ISA_BASELINE, GM_ISA_AVX2, GM_ISA_AVX512, GM_ISA_COUNT };

/* The best one of this machine and build: an index into gm_ode_of(problem)->loops. */
enum gm_isa gm_isa_best(void);
const char *gm_isa_name(enum gm_isa isa);

#endif
