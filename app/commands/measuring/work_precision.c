/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint work-precision: error against run time and evaluations. */
#include <math.h>
#include <stdio.h>

#include "app/commands/commands.h"
#include "app/commands/measuring/measuring.h"
#include "app/grid/grid.h"

static void print_table(const struct gm_grid *grid)
{
    char sentence[512];
    printf("%s, %s at t = %.6g", grid->request.scene->name, grid->measure, gm_grid_timing(grid)->until);
    printf(grid->reference[0] ? " against %s\n" : "\n", grid->reference);
    char heading[64];
    snprintf(heading, sizeof heading, "%s for an error of",
             grid->parameter ? grid->parameter->key : "evaluations");
    printf("%-26s %35s %35s %9s\n%-26s", "", "milliseconds for an error of", heading, "least", "scheme");
    for (int cost = 0; cost < 2; cost++) {
        for (size_t i = 0; i < 3; i++) {
            printf(" %11.0e", grid->errors[i]);
        }
    }
    printf(" %9s\n", "error");
    for (size_t i = 0; i < grid->begun; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        double least = INFINITY;
        printf("%-26s", line->scheme->name);
        for (size_t k = 0; k < 3; k++) {
            gm_print_number(" %11.3g", 11, 1e3 * gm_work_price(line, grid->errors[k], GM_COST_SECONDS));
        }
        for (size_t k = 0; k < 3; k++) {
            gm_print_number(" %11.3g", 11, gm_work_second_price(grid, line, grid->errors[k]));
        }
        enum gm_status last = GM_OK;
        for (size_t k = 0; k < line->count; k++) {
            least = fmin(least, line->cells[k].error);
            last = line->cells[k].tried ? line->cells[k].status : last;
        }
        if (isfinite(least)) {
            printf(" %9.1e\n", least);
        } else {
            printf(" %9s\n", last == GM_OK ? "-" : gm_status_name(last));
        }
        if (line->reason[0]) {
            printf("  none: %s\n", line->reason);
        }
    }
    printf("%s\n", gm_work_sentence(grid, sentence, sizeof sentence));
}

static void put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    (void)line;
    gm_row_put(row, "measure %s, against %s, until %.17g", grid->measure, grid->reference,
               gm_grid_timing(grid)->until);
}

static void put_end(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    struct gm_row prices = gm_row_open(row, "prices", ']');
    for (size_t k = 0; k < 3; k++) {
        const double error = grid->errors[k];
        struct gm_row price = gm_row_open(&prices, NULL, '}');
        gm_row_put(&price, "error %.17g, seconds %.17g", error, gm_work_price(line, error, GM_COST_SECONDS));
        gm_row_number(&price, grid->parameter ? grid->parameter->key : "evaluations",
                      gm_work_second_price(grid, line, error), 17);
        gm_row_close(&price);
    }
    gm_row_close(&prices);
    if (line->reason[0]) {
        gm_row_put(row, "reason %s", line->reason);
    }
}

int gm_command_work_precision(const struct gm_options *options)
{
    return gm_command_study(options, GM_STUDY_WORK,
                            &(const struct gm_study_printer){print_table, "points", put_front, put_end});
}
