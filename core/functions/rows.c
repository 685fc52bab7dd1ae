/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/functions/rows.h"

#include "core/functions/instructions.h"

const struct gm_function_rows *gm_function_rows(void)
{
    static const struct gm_function_rows *const rows[GM_ISA_COUNT] = {
        &gm_function_rows_baseline,
#ifdef GM_LOOPS_X86
        &gm_function_rows_avx2,
        &gm_function_rows_avx512,
#endif
    };
    return rows[gm_isa_best()];
}
