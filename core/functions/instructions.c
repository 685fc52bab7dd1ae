/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The instruction set of this machine, detected at run time: one binary serves all. */
#include "core/functions/instructions.h"

enum gm_isa gm_isa_best(void)
{
#ifdef GM_LOOPS_X86
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512cd")) {
        return GM_ISA_AVX512;
    }
    if (__builtin_cpu_supports("avx2")) {
        return GM_ISA_AVX2;
    }
#endif
    return GM_ISA_BASELINE;
}

const char *gm_isa_name(enum gm_isa isa)
{
    static const char *const names[GM_ISA_COUNT] = {"baseline", "avx2", "avx512"};
    return names[isa];
}
