/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint backward: the modified Hamiltonian that a scheme keeps, by where it is cut off and by the step. */
#include <math.h>
#include <stdio.h>

#include "app/commands/commands.h"
#include "app/commands/measuring/studied.h"
#include "app/output/json.h"

static void print_number(double value, const char *format)
{
    if (isfinite(value)) {
        printf(format, value);
    } else {
        printf(" %9s", "-");
    }
}

static void print_line(const struct gm_backward_line *line)
{
    printf("\n%s, order %d\n", line->scheme->name, line->scheme->order);
    if (line->why[0]) {
        printf("  none: %s\n", line->why);
        return;
    }
    static const char *const heads[] = {"H", "dt", "dt^2", "dt^3", "dt^4", "dt^5", "dt^6"};
    printf("%12s", "dt");
    for (int k = 0; k < GM_BACKWARD_POWERS; k++) {
        if (line->shown[k]) {
            printf(" %9s", heads[k]);
        }
    }
    printf(" %9s %9s %9s %9s\n", "best", "gamma", "gamma/dt", "drift");
    for (size_t p = 0; p < line->count; p++) {
        const struct gm_backward_point *point = &line->points[p];
        if (!point->tried) {
            continue;
        }
        printf("%12.6g", point->dt);
        for (int k = 0; k < GM_BACKWARD_POWERS; k++) {
            if (line->shown[k]) {
                print_number(point->errors[k], " %9.2e");
            }
        }
        printf(" %9s", heads[point->best]);
        print_number(point->gamma, " %9.3g");
        print_number(point->gamma / point->dt, " %9.3g");
        print_number(exp(-point->gamma / (2 * point->dt)), " %9.1e");
        printf("%s%s\n", point->status == GM_OK ? "" : "  ",
               point->status == GM_OK ? "" : gm_status_name(point->status));
    }
    printf("%12s", "slope");
    for (int k = 0; k < GM_BACKWARD_POWERS; k++) {
        if (line->shown[k]) {
            print_number(line->orders[k], " %9.3f");
        }
    }
    printf("\n");
}

static void print_table(const union gm_study_table *all)
{
    const struct gm_backward_table *table = &all->backward;
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    printf("%s, up to t = %.6g: largest error of H + dt H1 + dt^2 H2 + ..., cut off after a power of dt\n",
           table->request.scene->name, timing->until);
    for (size_t i = 0; i < table->count; i++) {
        print_line(&table->lines[i]);
    }
    printf(
        "\ngamma: terms go on as k! (dt/gamma)^k, estimated from the last two; they are smallest at k = gamma/dt, and "
        "what\nis left drifts by exp(-gamma / 2 dt) in the time exp(gamma / 2 dt)\n");
}

static void print_json_list(const char *key, const double *values)
{
    printf(",\"%s\":[", key);
    for (int k = 0; k < GM_BACKWARD_POWERS; k++) {
        fputs(k ? "," : "", stdout);
        gm_json_number(values[k]);
    }
    printf("]");
}

static void print_json(const union gm_study_table *all)
{
    const struct gm_backward_table *table = &all->backward;
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    for (size_t i = 0; i < table->count; i++) {
        const struct gm_backward_line *line = &table->lines[i];
        const char *comma = "";
        printf("{");
        gm_json_pair("scene", table->request.scene->name);
        printf(",");
        gm_json_pair("scheme", line->scheme->name);
        printf(",\"order\":%d,", line->scheme->order);
        gm_json_number_pair("until", timing->until);
        printf(",");
        gm_json_pair("reason", line->why);
        print_json_list("slopes", line->orders);
        printf(",\"points\":[");
        for (size_t p = 0; p < line->count; p++) {
            const struct gm_backward_point *point = &line->points[p];
            if (!point->tried) {
                continue;
            }
            printf("%s{", comma);
            gm_json_number_pair("dt", point->dt);
            printf(",\"status\":\"%s\",", gm_status_name(point->status));
            gm_json_number_pair("t", point->t);
            print_json_list("errors", point->errors);
            print_json_list("terms", point->terms);
            printf(",\"best\":%d,", point->best);
            gm_json_number_pair("gamma", point->gamma);
            printf(",");
            gm_json_number_pair("drift", exp(-point->gamma / (2 * point->dt)));
            printf("}");
            comma = ",";
        }
        printf("]}\n");
    }
}

static int command_backward(const struct gm_options *options)
{
    return gm_command_study(options, GM_STUDY_BACKWARD, print_table, print_json);
}

const struct gm_command_row gm_command_backward = {
    .name = "backward",
    .synopsis = "SCENE [key=value ...]",
    .help = "the modified Hamiltonian that a symplectic scheme keeps: its error by step and truncation",
    .bit = GM_BACKWARD,
    .function = command_backward,
};
