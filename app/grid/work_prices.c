/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an error costs, of the points that were measured: the best ones where the resolution varies, prices,
   the table as CSV. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/grid/work.h"
#include "app/output/csv.h"

double gm_work_cost(const struct gm_work_point *point, enum gm_work_cost cost)
{
    switch (cost) {
    case GM_COST_SECONDS:
        return point->seconds;
    case GM_COST_EVALUATIONS:
        return point->evaluations;
    default:
        return point->resolution;
    }
}

double gm_work_resolution(const struct gm_work_table *table, double resolution)
{
    return table->smaller_is_finer ? 1 / resolution : resolution;
}

static bool is_better(const struct gm_work_point *a, const struct gm_work_point *b, enum gm_work_cost cost)
{
    const double here = gm_work_cost(a, cost), there = gm_work_cost(b, cost);
    return here < there || (here == there && a->error < b->error);
}

size_t gm_work_keep_best(const struct gm_work_point *points, size_t count, enum gm_work_cost cost,
                         struct gm_work_point *best)
{
    size_t kept = 0;
    double least = INFINITY;
    const double better = 0.97; /* by less than this, errors are the same */
    for (;;) {
        /* the cheapest of those that are more accurate than all before */
        const struct gm_work_point *next = NULL;
        for (size_t i = 0; i < count; i++) {
            if (points[i].error < better * least && (!next || is_better(&points[i], next, cost))) {
                next = &points[i];
            }
        }
        if (!next) {
            return kept;
        }
        least = next->error;
        best[kept++] = *next;
    }
}

const struct gm_work_point *gm_work_front(const struct gm_work_line *line, enum gm_work_cost cost,
                                          size_t *count)
{
    *count = line->best[cost] ? line->best_count[cost] : line->count;
    return line->best[cost] ? line->best[cost] : line->points;
}

enum gm_work_cost gm_work_second_cost(const struct gm_work_table *table)
{
    return table->resolution ? GM_COST_RESOLUTION : GM_COST_EVALUATIONS;
}

double gm_work_price(const struct gm_work_line *line, double error, enum gm_work_cost cost)
{
    size_t count;
    const struct gm_work_point *points = gm_work_front(line, cost, &count);
    for (size_t k = 0; k < count; k++) {
        const struct gm_work_point *here = &points[k];
        if (!(here->error <= error)) {
            continue;
        }
        const struct gm_work_point *before = here - 1;
        /* the coarsest step is good enough, or the one before says nothing */
        if (k == 0 || !isfinite(before->error) || before->error <= here->error) {
            return gm_work_cost(here, cost);
        }
        const double low = log(fmax(here->error, 1e-300)), high = log(before->error);
        const double part = (log(error) - low) / (high - low);
        const double from = gm_work_cost(here, cost), to = gm_work_cost(before, cost);
        return from > 0 && to > 0 ? from * pow(to / from, part) : from;
    }
    return NAN;
}

const struct gm_work_line *gm_work_cheapest(const struct gm_work_table *table, double error,
                                            enum gm_work_cost cost)
{
    const struct gm_work_line *best = NULL;
    double least = INFINITY;
    for (size_t i = 0; i < table->line_count; i++) {
        const double price = gm_work_price(&table->lines[i], error, cost);
        if (price < least) {
            least = price;
            best = &table->lines[i];
        }
    }
    return best;
}

/* "10⁻³" */
static const char *error_text(double error, char text[24])
{
    static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const double power = round(-log10(error));
    if (power < 1 || power > 9 || fabs(error * pow(10, power) - 1) > 1e-9) {
        snprintf(text, 24, "%.3g", error);
    } else {
        snprintf(text, 24, "10⁻%s", digits[(int)power]);
    }
    return text;
}

/* "uniform Gauss 4 at 1 and 10⁻¹, control Gauss 4 at 10⁻²." */
static size_t tell_cheapest(const struct gm_work_table *table, const char *front, enum gm_work_cost cost,
                            char *text, size_t size)
{
    size_t used = (size_t)snprintf(text, size, "%s", front);
    enum { ERRORS = 3 };
    const struct gm_work_line *lines[ERRORS];
    for (size_t i = 0; i < ERRORS; i++) {
        lines[i] = gm_work_cheapest(table, table->errors[i], cost);
    }
    for (size_t i = 0; i < ERRORS && used < size; i++) {
        char word[24];
        error_text(table->errors[i], word);
        const bool same = i > 0 && lines[i] == lines[i - 1];
        const bool last = i + 1 == ERRORS || lines[i + 1] != lines[i];
        used += same ? (size_t)snprintf(text + used, size - used, "%s %s", last ? " and" : ",", word)
                     : (size_t)snprintf(text + used, size - used, "%s %s at %s", i ? ";" : "",
                                        lines[i] ? lines[i]->scheme->title : "none", word);
    }
    used = used < size ? used : size - 1;
    used += (size_t)snprintf(text + used, size - used, ".");
    return used < size ? used : size - 1;
}

const char *gm_work_sentence(const struct gm_work_table *table, char *text, size_t size)
{
    const size_t used = tell_cheapest(table, "Cheapest by run time:", GM_COST_SECONDS, text, size);
    if (table->resolution) {
        char front[64];
        snprintf(front, sizeof front, "  %s %s:", table->smaller_is_finer ? "Largest" : "Fewest",
                 table->resolution->key);
        tell_cheapest(table, front, GM_COST_RESOLUTION, text + used, size - used);
    }
    return text;
}

bool gm_work_write(const struct gm_work_table *table, const char *path)
{
    FILE *csv = fopen(path, "w");
    if (!csv) {
        return false;
    }
    fprintf(csv, "scene,scheme,order,%s%sdt,steps,t,status,%s,seconds,evaluations,solves\n",
            table->resolution ? table->resolution->key : "", table->resolution ? "," : "", table->measure);
    for (size_t i = 0; i < table->line_count; i++) {
        const struct gm_work_line *line = &table->lines[i];
        for (size_t k = 0; k < line->count; k++) {
            const struct gm_work_point *point = &line->points[k];
            fprintf(csv, "%s,", table->request.scene->name);
            gm_csv_put_text(csv, line->scheme->name);
            fprintf(csv, ",%d,", line->scheme->order);
            if (table->resolution) {
                fprintf(csv, "%.17g,", gm_work_resolution(table, point->resolution));
            }
            fprintf(csv, "%.17g,%" PRId64 ",%.17g,%s,", point->dt, point->steps, point->t,
                    gm_status_name(point->status));
            if (isfinite(point->error)) {
                fprintf(csv, "%.17g", point->error);
            }
            fprintf(csv, ",%.6g,%.0f,%.0f\n", point->seconds, point->evaluations, point->solves);
        }
    }
    const bool failed = ferror(csv) != 0;
    return fclose(csv) == 0 && !failed;
}
