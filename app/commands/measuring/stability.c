/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint stability: which time step keeps which scheme bounded, and how it fails beyond. */
#include <math.h>
#include <stdio.h>

#include "app/commands/commands.h"
#include "app/commands/measuring/region.h"
#include "app/commands/measuring/studied.h"
#include "app/output/json.h"
#include "app/output/say.h"

static void print_table(const union gm_study_table *all)
{
    const struct gm_stability_table *table = &all->stability;
    const struct gm_stability *plan = table->plan;
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    char letters[128], question[GM_TEXT_SIZE];
    gm_stability_letters(table, letters, sizeof letters);
    printf("%s, which step is %s, after t = %.6g: . %s%s%s\n", table->request.scene->name,
           gm_stability_question(table, question, sizeof question), timing->until, gm_stability_judge(table),
           letters[0] ? ", " : "", letters);
    if (plan->told) {
        printf("%s: %.4g here\n", plan->told, 1 / plan->unit(timing));
    }
    for (size_t i = 0; i < table->count; i++) {
        const struct gm_stability_map *map = &table->maps[i];
        printf("\n%-20s %s\n%12s", map->scheme->name, plan->parameter, plan->label);
        for (size_t v = 0; v < plan->value_count; v++) {
            printf(" %7.4g", plan->values[v]);
        }
        printf("\n");
        for (size_t s = plan->step_count; s-- > 0;) {
            printf("%12.4g", plan->steps[s]);
            for (size_t v = 0; v < plan->value_count; v++) {
                printf(" %7c", gm_cell_letter(&map->cells[s * plan->value_count + v]));
            }
            printf("\n");
        }
        const double limit = gm_stability_limit(table, map);
        if (isnan(limit)) {
            printf("  how far it is %s is open: not every step was tried\n", gm_stability_judge(table));
        } else if (limit > 0) {
            printf("  %s for all values up to %.4g\n", gm_stability_judge(table), limit);
        } else {
            printf("  at no step %s for all values\n", gm_stability_judge(table));
        }
    }
}

static void print_json(const union gm_study_table *all)
{
    const struct gm_stability_table *table = &all->stability;
    const struct gm_stability *plan = table->plan;
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    for (size_t i = 0; i < table->count; i++) {
        const struct gm_stability_map *map = &table->maps[i];
        const char *comma = "";
        printf("{");
        gm_json_pair("scene", table->request.scene->name);
        printf(",");
        gm_json_pair("scheme", map->scheme->name);
        printf(",");
        gm_json_pair("parameter", plan->parameter);
        printf(",");
        gm_json_pair("unit", plan->label);
        printf(",");
        gm_json_number_pair("until", timing->until);
        printf(",");
        gm_json_pair("judge", gm_stability_judge(table));
        printf(",");
        gm_json_number_pair("accuracy", table->accuracy);
        printf(",");
        const double limit = gm_stability_limit(table, map);
        gm_json_number_pair("limit", limit > 0 ? limit : NAN);
        printf(",\"cells\":[");
        for (size_t k = 0; k < plan->step_count * plan->value_count; k++) {
            const struct gm_map_cell *cell = &map->cells[k];
            if (cell->verdict == GM_UNTRIED) {
                continue;
            }
            printf("%s{", comma);
            gm_json_number_pair(plan->parameter, plan->values[k % plan->value_count]);
            printf(",");
            gm_json_number_pair("step", plan->steps[k / plan->value_count]);
            printf(",");
            gm_json_number_pair("dt", cell->dt);
            printf(",\"verdict\":\"%s\",\"status\":\"%s\",", gm_cell_word(table, cell),
                   gm_status_name(cell->status));
            gm_json_number_pair("t", cell->t);
            printf(",");
            gm_json_number_pair("ratio", cell->ratio);
            printf(",");
            gm_json_number_pair("error", cell->error);
            printf("}");
            comma = ",";
        }
        printf("]}\n");
    }
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
    return gm_command_study(options, GM_STUDY_STABILITY, print_table, print_json);
}

const struct gm_command_row gm_command_stability = {
    .name = "stability",
    .synopsis = "SCENE [key=value ...]",
    .help = "which time step keeps which scheme bounded or accurate, and how it fails beyond",
    .bit = GM_STABILITY,
    .function = command_stability,
};
