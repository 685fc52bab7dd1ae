/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint work-precision: error against run time and evaluations. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "app/commands/commands.h"
#include "app/commands/measuring/studied.h"
#include "app/output/json.h"

static void print_cell(double value)
{
    if (isfinite(value)) {
        printf(" %11.3g", value);
    } else {
        printf(" %11s", "-");
    }
}

static void print_table(const union gm_study_table *all)
{
    const struct gm_work_table *table = &all->work;
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    char sentence[512];
    printf("%s, %s at t = %.6g", table->request.scene->name, table->measure, timing->until);
    printf(table->reference[0] ? " against %s\n" : "\n", table->reference);
    const enum gm_work_cost second = gm_work_second_cost(table);
    char heading[64];
    snprintf(heading, sizeof heading, "%s for an error of",
             table->resolution ? table->resolution->key : "evaluations");
    printf("%-26s %35s %35s %9s\n%-26s", "", "milliseconds for an error of", heading, "least", "scheme");
    for (int cost = 0; cost < 2; cost++) {
        for (size_t i = 0; i < 3; i++) {
            printf(" %11.0e", table->errors[i]);
        }
    }
    printf(" %9s\n", "error");
    for (size_t i = 0; i < table->line_count; i++) {
        const struct gm_work_line *line = &table->lines[i];
        double least = INFINITY;
        printf("%-26s", line->scheme->name);
        for (size_t k = 0; k < 3; k++) {
            print_cell(1e3 * gm_work_price(line, table->errors[k], GM_COST_SECONDS));
        }
        for (size_t k = 0; k < 3; k++) {
            const double price = gm_work_price(line, table->errors[k], second);
            print_cell(second == GM_COST_RESOLUTION ? gm_work_resolution(table, price) : price);
        }
        for (size_t k = 0; k < line->count; k++) {
            least = fmin(least, line->points[k].error);
        }
        if (isfinite(least)) {
            printf(" %9.1e\n", least);
        } else {
            const enum gm_status last = line->count > 0 ? line->points[line->count - 1].status : GM_OK;
            printf(" %9s\n", last == GM_OK ? "-" : gm_status_name(last));
        }
        if (line->reason[0]) {
            printf("  none: %s\n", line->reason);
        }
    }
    printf("%s\n", gm_work_sentence(table, sentence, sizeof sentence));
}

static void print_json_point(const struct gm_work_table *table, const struct gm_work_point *point)
{
    printf("{");
    if (table->resolution) {
        gm_json_number_pair(table->resolution->key, gm_work_resolution(table, point->resolution));
        printf(",");
    }
    gm_json_number_pair("dt", point->dt);
    printf(",\"steps\":%" PRId64 ",", point->steps);
    gm_json_number_pair("t", point->t);
    printf(",\"status\":\"%s\",", gm_status_name(point->status));
    gm_json_number_pair("error", point->error);
    printf(",");
    gm_json_number_pair("seconds", point->seconds);
    printf(",\"evaluations\":%.0f,\"solves\":%.0f}", point->evaluations, point->solves);
}

static void print_json(const union gm_study_table *all)
{
    const struct gm_work_table *table = &all->work;
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    const enum gm_work_cost second = gm_work_second_cost(table);
    for (size_t i = 0; i < table->line_count; i++) {
        const struct gm_work_line *line = &table->lines[i];
        printf("{");
        gm_json_pair("scene", table->request.scene->name);
        printf(",");
        gm_json_pair("scheme", line->scheme->name);
        printf(",\"order\":%d,", line->scheme->order);
        gm_json_pair("measure", table->measure);
        printf(",");
        gm_json_pair("against", table->reference);
        printf(",");
        gm_json_number_pair("until", timing->until);
        printf(",\"points\":[");
        for (size_t k = 0; k < line->count; k++) {
            printf("%s", k ? "," : "");
            print_json_point(table, &line->points[k]);
        }
        printf("],\"prices\":[");
        for (size_t k = 0; k < 3; k++) {
            const double error = table->errors[k], price = gm_work_price(line, error, second);
            printf("%s{", k ? "," : "");
            gm_json_number_pair("error", error);
            printf(",");
            gm_json_number_pair("seconds", gm_work_price(line, error, GM_COST_SECONDS));
            printf(",");
            gm_json_number_pair(table->resolution ? table->resolution->key : "evaluations",
                                second == GM_COST_RESOLUTION ? gm_work_resolution(table, price) : price);
            printf("}");
        }
        printf("]");
        if (line->reason[0]) {
            printf(",");
            gm_json_pair("reason", line->reason);
        }
        printf("}\n");
    }
}

static int command_work_precision(const struct gm_options *options)
{
    return gm_command_study(options, GM_STUDY_WORK, print_table, print_json);
}

const struct gm_command_row gm_command_work_precision = {
    .name = "work-precision",
    .synopsis = "SCENE [key=value ...]",
    .help = "error against run time and evaluations, of every scheme that fits",
    .bit = GM_WORK_PRECISION,
    .function = command_work_precision,
};
