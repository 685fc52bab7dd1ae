/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of an error on the steps of a scheme, and the tables of it. */
#include <math.h>
#include <stdio.h>

#include "app/grid/hooks.h"

double gm_work_cost(const struct gm_grid_cell *cell, enum gm_cost cost)
{
    switch (cost) {
    case GM_COST_SECONDS:
        return cell->seconds;
    case GM_COST_EVALUATIONS:
        return cell->evaluations;
    default:
        return cell->resolution;
    }
}

static bool is_better(const struct gm_grid_cell *a, const struct gm_grid_cell *b, enum gm_cost cost)
{
    const double here = gm_work_cost(a, cost), there = gm_work_cost(b, cost);
    return here < there || (here == there && a->error < b->error);
}

size_t gm_work_keep_best(const struct gm_grid_cell *cells, size_t count, enum gm_cost cost,
                         struct gm_grid_cell *best)
{
    size_t kept = 0;
    double least = INFINITY;
    const double better = 0.97; /* errors count as equal unless they differ by more */
    for (;;) {
        /* the cheapest of those that are more accurate than all before */
        const struct gm_grid_cell *next = NULL;
        for (size_t i = 0; i < count; i++) {
            if (cells[i].error < better * least && (!next || is_better(&cells[i], next, cost))) {
                next = &cells[i];
            }
        }
        if (!next) {
            return kept;
        }
        least = next->error;
        best[kept++] = *next;
    }
}

const struct gm_grid_cell *gm_work_front(const struct gm_grid_line *line, enum gm_cost cost, size_t *count)
{
    *count = line->front[cost] ? line->front_count[cost] : line->count;
    return line->front[cost] ? line->front[cost] : line->cells;
}

enum gm_cost gm_work_second_cost(const struct gm_grid *grid)
{
    return grid->parameter ? GM_COST_RESOLUTION : GM_COST_EVALUATIONS;
}

/* This cost of an error, as it is printed. */
static double second_price(const struct gm_grid *grid, const struct gm_grid_line *line, double error)
{
    const double price = gm_work_price(line, error, gm_work_second_cost(grid));
    return grid->parameter && grid->smaller_is_finer ? 1 / price : price;
}

double gm_work_price(const struct gm_grid_line *line, double error, enum gm_cost cost)
{
    size_t count;
    const struct gm_grid_cell *cells = gm_work_front(line, cost, &count);
    for (size_t k = 0; k < count; k++) {
        const struct gm_grid_cell *here = &cells[k];
        if (!(here->error <= error)) {
            continue;
        }
        const struct gm_grid_cell *before = here - 1;
        /* the coarsest step is good enough, or the one before gives no information */
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

const struct gm_grid_line *gm_work_cheapest(const struct gm_grid *grid, double error, enum gm_cost cost)
{
    const struct gm_grid_line *best = NULL;
    double least = INFINITY;
    for (size_t i = 0; i < grid->begun; i++) {
        const double price = gm_work_price(&grid->lines[i], error, cost);
        if (price < least) {
            least = price;
            best = &grid->lines[i];
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

/* Appends "uniform Gauss 4 at 1 and 10⁻¹, control Gauss 4 at 10⁻²." */
static void name_cheapest(const struct gm_grid *grid, enum gm_cost cost, char *text, size_t size)
{
    enum { ERRORS = 3 };
    const struct gm_grid_line *lines[ERRORS];
    for (size_t i = 0; i < ERRORS; i++) {
        lines[i] = gm_work_cheapest(grid, grid->errors[i], cost);
    }
    for (size_t i = 0; i < ERRORS; i++) {
        char word[24];
        error_text(grid->errors[i], word);
        if (i > 0 && lines[i] == lines[i - 1]) {
            gm_append(text, size, "%s %s", i + 1 == ERRORS || lines[i + 1] != lines[i] ? " and" : ",", word);
        } else {
            gm_append(text, size, "%s %s at %s", i ? ";" : "", lines[i] ? lines[i]->scheme->title : "none",
                      word);
        }
    }
    gm_append(text, size, ".");
}

const char *gm_work_sentence(const struct gm_grid *grid, char *text, size_t size)
{
    snprintf(text, size, "Cheapest by run time:");
    name_cheapest(grid, GM_COST_SECONDS, text, size);
    if (grid->parameter) {
        gm_append(text, size, "  %s %s:", grid->smaller_is_finer ? "Largest" : "Fewest",
                  grid->parameter->key);
        name_cheapest(grid, GM_COST_RESOLUTION, text, size);
    }
    return text;
}

/* ---- tables ---- */

void gm_work_print(const struct gm_grid *grid)
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
            gm_print_number(" %11.3g", 11, second_price(grid, line, grid->errors[k]));
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

void gm_work_put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    (void)line;
    gm_row_put(row, "measure %s, against %s, until %.17g", grid->measure, grid->reference,
               gm_grid_timing(grid)->until);
}

void gm_work_put_end(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    struct gm_row prices = gm_row_open(row, "prices", ']');
    for (size_t k = 0; k < 3; k++) {
        const double error = grid->errors[k];
        struct gm_row price = gm_row_open(&prices, NULL, '}');
        gm_row_put(&price, "error %.17g, seconds %.17g", error, gm_work_price(line, error, GM_COST_SECONDS));
        gm_row_number(&price, grid->parameter ? grid->parameter->key : "evaluations",
                      second_price(grid, line, error), 17);
        gm_row_close(&price);
    }
    gm_row_close(&prices);
    if (line->reason[0]) {
        gm_row_put(row, "reason %s", line->reason);
    }
}
