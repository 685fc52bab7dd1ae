/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint stability: which time step keeps which scheme bounded, and how it fails beyond. */
#include <math.h>
#include <stdio.h>

#include "app/commands/commands.h"
#include "app/commands/measuring/region.h"
#include "app/commands/measuring/studied.h"
#include "app/grid/judge.h"
#include "app/output/say.h"
#include "core/expression/number.h"

static void print_table(const struct gm_grid *grid)
{
    const struct gm_stability *plan = grid->plan;
    const struct gm_timing *timing = grid->request.lanes[0].parameters;
    char letters[128], question[GM_TEXT_SIZE];
    gm_stability_letters(grid, letters, sizeof letters);
    printf("%s, which step is %s, after t = %.6g: . %s%s%s\n", grid->request.scene->name,
           gm_stability_question(grid, question, sizeof question), timing->until, gm_stability_judge(grid),
           letters[0] ? ", " : "", letters);
    if (plan->told) {
        printf("%s: %.4g here\n", plan->told, 1 / plan->unit(timing));
    }
    for (size_t i = 0; i < grid->count; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        printf("\n%-20s %s\n%12s", line->scheme->name, plan->parameter, plan->label);
        for (size_t v = 0; v < grid->values.count; v++) {
            printf(" %7.4g", grid->values.values[v]);
        }
        printf("\n");
        for (size_t s = grid->steps.count; s-- > 0;) {
            printf("%12.4g", grid->steps.values[s]);
            for (size_t v = 0; v < grid->values.count; v++) {
                printf(" %7c", gm_cell_letter(&line->cells[s * grid->values.count + v]));
            }
            printf("\n");
        }
        const double limit = gm_stability_limit(grid, line);
        if (isnan(limit)) {
            printf("  how far it is %s is open: not every step was tried\n", gm_stability_judge(grid));
        } else if (limit > 0) {
            printf("  %s for all values up to %.4g\n", gm_stability_judge(grid), limit);
        } else {
            printf("  at no step %s for all values\n", gm_stability_judge(grid));
        }
    }
}

static void put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    const struct gm_timing *timing = grid->request.lanes[0].parameters;
    const double limit = gm_stability_limit(grid, line);
    gm_row_text(row, "parameter", grid->parameter->key);
    gm_row_text(row, "unit", grid->plan->label);
    gm_row_number(row, "until", timing->until, 17);
    gm_row_text(row, "judge", gm_stability_judge(grid));
    gm_row_number(row, "accuracy", grid->accuracy, 17);
    gm_row_number(row, "limit", limit > 0 ? limit : NAN, 17);
}

static int command_stability(const struct gm_options *options)
{
    if (options->region && options->arguments.count > 0) {
        gm_complain("--region takes a scheme alone, no scene");
        return GM_EXIT_USAGE;
    }
    if (options->region) {
        return gm_region(options);
    }
    return gm_command_study(options, GM_STUDY_STABILITY,
                            &(const struct gm_study_printer){print_table, "cells", put_front, NULL});
}

const struct gm_command_row gm_command_stability = {
    .name = "stability",
    .synopsis = "SCENE [key=value ...]",
    .help = "which time step keeps which scheme bounded or accurate, and how it fails beyond",
    .bit = GM_STABILITY,
    .function = command_stability,
};
