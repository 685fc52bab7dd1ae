/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a state is called: asked of its kind. */
#include "core/quantity.h"

#include "core/kind.h"
#include "core/run.h"

size_t gm_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    return run->problem->kind->quantities(run, quantities);
}

size_t gm_quantity_size(const struct gm_run *run, const struct gm_quantity *quantity)
{
    return quantity->count * quantity->width * run->problem->m;
}

const double *gm_quantity_values(const struct gm_run *run, const struct gm_quantity *quantity,
                                 double *scratch)
{
    if (!quantity->derive) {
        return gm_run_state(run) + quantity->first * run->problem->m;
    }
    quantity->derive(run, scratch);
    return scratch;
}
