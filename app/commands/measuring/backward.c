/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint backward: the modified Hamiltonian that a scheme conserves, by truncation order and step size. */
#include <math.h>
#include <stdio.h>

#include "app/commands/commands.h"
#include "app/commands/measuring/measuring.h"

static void print_line(const struct gm_grid_line *line)
{
    printf("\n%s, order %d\n", line->scheme->name, line->scheme->order);
    if (line->reason[0]) {
        printf("  none: %s\n", line->reason);
        return;
    }
    static const char *const heads[] = {"H", "dt", "dt^2", "dt^3", "dt^4", "dt^5", "dt^6"};
    printf("%12s", "dt");
    for (int k = 0; k < GM_POWERS; k++) {
        if (line->shown[k]) {
            printf(" %9s", heads[k]);
        }
    }
    printf(" %9s %9s %9s %9s\n", "best", "gamma", "gamma/dt", "drift");
    for (size_t p = 0; p < line->count; p++) {
        const struct gm_grid_cell *cell = &line->cells[p];
        if (!cell->tried) {
            continue;
        }
        printf("%12.6g", cell->dt);
        for (int k = 0; k < GM_POWERS; k++) {
            if (line->shown[k]) {
                gm_print_number(" %9.2e", 9, cell->errors[k]);
            }
        }
        printf(" %9s", heads[cell->best]);
        gm_print_number(" %9.3g", 9, cell->gamma);
        gm_print_number(" %9.3g", 9, cell->gamma / cell->dt);
        gm_print_number(" %9.1e", 9, exp(-cell->gamma / (2 * cell->dt)));
        printf("%s%s\n", cell->status == GM_OK ? "" : "  ",
               cell->status == GM_OK ? "" : gm_status_name(cell->status));
    }
    printf("%12s", "slope");
    for (int k = 0; k < GM_POWERS; k++) {
        if (line->shown[k]) {
            gm_print_number(" %9.3f", 9, line->orders[k]);
        }
    }
    printf("\n");
}

static void print_table(const struct gm_grid *grid)
{
    printf("%s, up to t = %.6g: largest error of H + dt H1 + dt^2 H2 + ..., cut off after a power of dt\n",
           grid->request.scene->name, gm_grid_timing(grid)->until);
    for (size_t i = 0; i < grid->count; i++) {
        print_line(&grid->lines[i]);
    }
    printf(
        "\ngamma: term k is about k! (dt/gamma)^k, estimated from the last two; it is smallest at k = gamma/dt, and "
        "what\nis left drifts by exp(-gamma / 2 dt) in the time exp(gamma / 2 dt)\n");
}

static void put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    gm_row_put(row, "order %i, until %.17g, reason %s", line->scheme->order, gm_grid_timing(grid)->until,
               line->reason);
    gm_row_list(row, "slopes", line->orders, GM_POWERS);
}

int gm_command_backward(const struct gm_options *options)
{
    return gm_command_study(options, GM_STUDY_BACKWARD,
                            &(const struct gm_study_printer){print_table, "points", put_front, NULL});
}
