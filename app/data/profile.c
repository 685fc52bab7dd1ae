/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields on a line as CSV. */
#include "app/data/save.h"

#include <stdlib.h>

#include "core/quantity.h"

/* The quantities of the nodes, the coordinate first; returns their number, 0 if the nodes are not on a
   line. */
static size_t list(const struct gm_run *run, struct gm_quantity chosen[GM_QUANTITIES])
{
    struct gm_quantity all[GM_QUANTITIES];
    const size_t count = gm_quantities(run, all);
    size_t used = 1;
    bool on_line = false;
    for (size_t i = 0; i < count; i++) {
        if (all[i].support != GM_ON_NODES) {
            continue;
        }
        if (all[i].axis == 0) {
            chosen[used++] = all[i];
        } else {
            chosen[0] = all[i];
            on_line = all[i].width == 1;
        }
    }
    return on_line ? used : 0;
}

bool gm_profile_is_there(const struct gm_run *run)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    return list(run, quantities) > 0;
}

void gm_profile_columns(const struct gm_run *run, FILE *stream)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    const size_t count = list(run, quantities);
    fputc('x', stream);
    for (size_t i = 1; i < count; i++) {
        fprintf(stream, ",%s", quantities[i].name);
    }
}

bool gm_profile_write(const struct gm_run *run, const char *front, FILE *stream)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    const double *values[GM_QUANTITIES];
    const size_t count = list(run, quantities), nodes = quantities[0].count;
    double *scratch = malloc(count * nodes * sizeof *scratch);
    if (!scratch) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = gm_quantity_values(run, &quantities[i], scratch + i * nodes);
    }
    for (size_t k = 0; k < nodes; k++) {
        fputs(front, stream);
        for (size_t i = 0; i < count; i++) {
            fprintf(stream, ",%.17g", values[i][k]);
        }
        fputc('\n', stream);
    }
    free(scratch);
    return true;
}
