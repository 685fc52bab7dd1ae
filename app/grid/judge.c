/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Verdicts on steps; fronts and the cost of an error on them; slopes. */
#include "app/grid/grid.h"

#include <math.h>
#include <stdio.h>

/* ---- stability ---- */

const char *gm_stability_judge(const struct gm_grid *grid)
{
    return grid->accuracy < INFINITY ? "accurate" : "bounded";
}

const char *gm_stability_question(const struct gm_grid *grid, char *text, size_t size)
{
    const char *judge = gm_stability_judge(grid);
    if (grid->accuracy < INFINITY) {
        snprintf(text, size, "%s to %.3g (%s)", judge, grid->accuracy, grid->plan->error);
    } else {
        snprintf(text, size, "%s", judge);
    }
    return text;
}

static const struct {
    char letter;
    const char *word;
} verdicts[] = {[GM_BOUNDED] = {'.', ""},
                [GM_LOST] = {'L', "lost"},
                [GM_GAINED] = {'G', "gained"},
                [GM_WRONG] = {'W', "wrong"}};

const char *gm_cell_word(const struct gm_grid *grid, const struct gm_grid_cell *cell)
{
    if (!cell->tried) {
        return "untried";
    }
    if (cell->verdict == GM_FAILED) {
        return gm_status_name(cell->status);
    }
    return cell->verdict == GM_BOUNDED ? gm_stability_judge(grid) : verdicts[cell->verdict].word;
}

char gm_cell_letter(const struct gm_grid_cell *cell)
{
    if (!cell->tried || cell->verdict != GM_FAILED) {
        return cell->tried ? verdicts[cell->verdict].letter : '?';
    }
    switch (cell->status) {
    case GM_BLOW_UP:
        return 'B';
    case GM_NO_CONVERGENCE:
        return 'N';
    case GM_MESH_CROSSING:
        return 'M';
    default:
        return 'C';
    }
}

const char *gm_stability_letters(const struct gm_grid *grid, char *text, size_t size)
{
    bool noted[128] = {['.'] = true};
    text[0] = '\0';
    for (size_t i = 0; i < grid->count; i++) {
        for (size_t k = 0; k < grid->lines[i].count; k++) {
            const struct gm_grid_cell *cell = &grid->lines[i].cells[k];
            const char letter = gm_cell_letter(cell);
            if (!noted[(size_t)letter]) {
                gm_append(text, size, "%s%c %s", text[0] ? ", " : "", letter, gm_cell_word(grid, cell));
                noted[(size_t)letter] = true;
            }
        }
    }
    return text;
}

double gm_stability_limit(const struct gm_grid *grid, const struct gm_grid_line *line)
{
    double limit = 0;
    for (size_t s = 0; s < grid->steps.count; s++) {
        bool open = false;
        for (size_t v = 0; v < grid->values.count; v++) {
            const struct gm_grid_cell *cell = &line->cells[s * grid->values.count + v];
            if (cell->tried && cell->verdict != GM_BOUNDED) {
                return limit;
            }
            open = open || !cell->tried;
        }
        if (open) {
            return NAN;
        }
        limit = grid->steps.values[s];
    }
    return limit;
}

/* ---- work-precision ---- */

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

double gm_work_second_price(const struct gm_grid *grid, const struct gm_grid_line *line, double error)
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
