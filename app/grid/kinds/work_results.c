/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Results of work-precision: fronts and the costs of errors on them, their tables, and the diagram, in which every
   scheme is a line; the few that matter are coloured and named, the others grey. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/grid.h"
#include "core/expression/number.h"
#include "render/cells/text.h"

/* ---- costs ---- */

static double cost_of(const struct gm_grid_cell *cell, enum gm_cost cost)
{
    const double costs[] = {[GM_COST_SECONDS] = cell->seconds,
                            [GM_COST_EVALUATIONS] = cell->evaluations,
                            [GM_COST_RESOLUTION] = cell->resolution};
    return costs[cost];
}

static bool is_better(const struct gm_grid_cell *a, const struct gm_grid_cell *b, enum gm_cost cost)
{
    const double here = cost_of(a, cost), there = cost_of(b, cost);
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

/* The cells that make up a line's curve and costs. */
static const struct gm_grid_cell *front_of(const struct gm_grid_line *line, enum gm_cost cost, size_t *count)
{
    *count = line->front[cost] ? line->front_count[cost] : line->count;
    return line->front[cost] ? line->front[cost] : line->cells;
}

/* The second cost for comparing schemes, after the run time. */
static enum gm_cost second_cost(const struct gm_grid *grid)
{
    return grid->parameter ? GM_COST_RESOLUTION : GM_COST_EVALUATIONS;
}

/* This cost of an error, as it is printed. */
static double second_price(const struct gm_grid *grid, const struct gm_grid_line *line, double error)
{
    const double price = gm_work_price(line, error, second_cost(grid));
    return grid->parameter && grid->smaller_is_finer ? 1 / price : price;
}

double gm_work_price(const struct gm_grid_line *line, double error, enum gm_cost cost)
{
    size_t count;
    const struct gm_grid_cell *cells = front_of(line, cost, &count);
    for (size_t k = 0; k < count; k++) {
        const struct gm_grid_cell *here = &cells[k];
        if (!(here->error <= error)) {
            continue;
        }
        const struct gm_grid_cell *before = here - 1;
        /* the coarsest step is good enough, or the one before gives no information */
        if (k == 0 || !isfinite(before->error) || before->error <= here->error) {
            return cost_of(here, cost);
        }
        const double low = log(fmax(here->error, 1e-300)), high = log(before->error);
        const double part = (log(error) - low) / (high - low);
        const double from = cost_of(here, cost), to = cost_of(before, cost);
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

/* "Cheapest by run time: ..." */
static const char *sentence_of(const struct gm_grid *grid, char *text, size_t size)
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
    double smallest = INFINITY;
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
        smallest = fmin(smallest, least);
        if (isfinite(least)) {
            printf(" %9.1e\n", least);
        } else {
            printf(" %9s\n", last == GM_OK ? "-" : gm_status_name(last));
        }
        if (line->reason[0]) {
            printf("  none: %s\n", line->reason);
        }
    }
    if (grid->reference_error > fmax(0.1 * smallest, 1e-11)) {
        printf(
            "the reference has an error of about %.1e itself, which is a part of errors that are not far larger\n",
            grid->reference_error);
    }
    printf("%s\n", sentence_of(grid, sentence, sizeof sentence));
    if (grid->best_is_none) {
        printf("best adds no scheme: no other one of the family of %s has its order or a higher one\n",
               grid->lines[0].scheme->name);
    }
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
    }
    if (line->reason[0]) {
        gm_row_put(row, "reason %s", line->reason);
    }
}

/* ---- the diagram ---- */

enum { NAMED = GM_LANE_COLOURS };

static bool holds(const struct gm_grid_line *const *chosen, size_t count, const struct gm_grid_line *line)
{
    for (size_t i = 0; i < count; i++) {
        if (chosen[i] == line) {
            return true;
        }
    }
    return false;
}

static bool is_line(const struct gm_grid_line *line)
{
    return line->count > 1 && line->cells[1].tried;
}

/* Adds a line to those that are named, unless they are many, or it is among them. */
static void name_line(const struct gm_grid_line *chosen[NAMED], size_t *count,
                      const struct gm_grid_line *line)
{
    if (*count < NAMED && !holds(chosen, *count, line)) {
        chosen[(*count)++] = line;
    }
}

/* Chooses lines to name: the cheapest at each error by either cost, then the scene's preferred schemes,
 * then, if there are few, others. */
static size_t choose(const struct gm_grid *grid, const struct gm_grid_line *chosen[NAMED])
{
    size_t count = 0;
    for (size_t i = 0; grid->begun <= NAMED && i < grid->begun; i++) {
        name_line(chosen, &count, &grid->lines[i]);
    }
    const enum gm_cost costs[] = {GM_COST_SECONDS, second_cost(grid)};
    for (size_t i = 0; i < 6; i++) {
        const struct gm_grid_line *line = gm_work_cheapest(grid, grid->errors[i % 3], costs[i / 3]);
        if (line) {
            name_line(chosen, &count, line);
        }
    }
    for (const char *const *preferred = grid->request.scene->schemes; *preferred; preferred++) {
        for (size_t i = 0; i < grid->begun; i++) {
            if (strcmp(grid->lines[i].scheme->name, *preferred) == 0 && is_line(&grid->lines[i])) {
                name_line(chosen, &count, &grid->lines[i]);
            }
        }
    }
    for (size_t i = 0; grid->begun <= 2 * NAMED && i < grid->begun; i++) {
        if (is_line(&grid->lines[i])) {
            name_line(chosen, &count, &grid->lines[i]);
        }
    }
    return count;
}

static size_t points_of(const struct gm_grid_line *line, enum gm_cost cost, double *points)
{
    size_t count = 0, all;
    const struct gm_grid_cell *front = front_of(line, cost, &all);
    for (size_t k = 0; k < all; k++) {
        const double price = cost_of(&front[k], cost), error = front[k].error;
        if (isfinite(error) && error > 0 && price > 0 && isfinite(price)) {
            points[2 * count] = price;
            points[2 * count + 1] = error;
            count++;
        }
    }
    return count;
}

/* A rectangle for a name, in fractions of the panel's width and height. */
struct place {
    double left, low, right, high;
};

/* A line that the panel shows. */
struct drawn {
    const double *points;
    size_t count;
};

static double across(const struct gm_axis *axis, double value)
{
    return log(value / axis->low) / log(axis->high / axis->low);
}

/* The part of a line that runs through a place, in steps of a hundredth of the panel. */
static double covered(const struct gm_panel *panel, const struct drawn *line, const struct place *place)
{
    double steps = 0;
    for (size_t k = 0; k + 1 < line->count; k++) {
        const double *from = &line->points[2 * k], *to = from + 2;
        const double x = across(&panel->x, from[0]), y = across(&panel->y, from[1]);
        const double dx = across(&panel->x, to[0]) - x, dy = across(&panel->y, to[1]) - y;
        const int pieces = 1 + (int)fmin(100, 100 * hypot(dx, dy));
        for (int i = 0; i <= pieces; i++) {
            const double u = x + dx * i / pieces, v = y + dy * i / pieces;
            steps += u > place->left && u < place->right && v > place->low && v < place->high;
        }
    }
    return steps;
}

/* The lines of a panel, the coloured ones first, and the places of their names. */
struct names {
    const struct gm_panel *panel;
    struct drawn *lines;
    size_t line_count;
    struct place taken[NAMED];
    size_t taken_count;
};

/* The place for the name of a line, that covers least and touches no other name: beside one of its points, right
   or left, above or below, near or up to two lines of text away. */
static struct place name_place(const struct names *names, const struct drawn *own, size_t letters)
{
    const struct gm_panel *panel = names->panel;
    /* a letter, and a line of text, in a picture of usual size */
    const double wide = 0.0165 * (double)letters, tall = 0.042, aside = 0.012;
    enum { SIDES = 16 };
    struct place best = {0};
    double least = INFINITY;
    for (size_t k = 0; k < own->count; k++) {
        const double u = across(&panel->x, own->points[2 * k]);
        const double v = across(&panel->y, own->points[2 * k + 1]);
        for (int side = 0; side < SIDES; side++) {
            const double left = side & 1 ? u - aside - wide : u + aside;
            const double far = 0.5 * tall * (double)(side / 4);
            const double low = side & 2 ? v - 0.8 * tall - far : v - 0.2 * tall + far;
            const struct place place = {left, low, left + wide, low + tall};
            /* later points are lower, and lines separate there */
            double cost = 0.2 * (double)side + 0.5 * (double)(own->count - k) / (double)own->count;
            cost +=
                place.left < 0.5 * aside || place.right > 1 ? 400 : 0; /* what begins outside is not drawn */
            cost += place.low < 0 || place.high > 1.02 ? 40 : 0;
            for (size_t i = 0; i < names->taken_count; i++) {
                const struct place *taken = &names->taken[i];
                const bool apart = place.left > taken->right || place.right < taken->left ||
                                   place.low > taken->high || place.high < taken->low;
                cost += apart ? 0 : 100;
            }
            for (size_t i = 0; i < names->line_count; i++) {
                cost += covered(panel, &names->lines[i], &place);
            }
            if (cost < least) {
                least = cost;
                best = place;
            }
        }
    }
    return best;
}

/* Values in rising order. */
static const double *rising(struct gm_picture *picture, const double *values, size_t count)
{
    double *sorted = gm_picture_memory(picture, count * sizeof *sorted);
    for (size_t i = 0; i < count; i++) {
        size_t at = i;
        for (; at > 0 && sorted[at - 1] > values[i]; at--) {
            sorted[at] = sorted[at - 1];
        }
        sorted[at] = values[i];
    }
    return sorted;
}

static void draw_cost(const struct gm_grid *grid, struct gm_picture *picture, enum gm_cost cost,
                      const struct gm_grid_line *const *chosen, size_t chosen_count)
{
    const char *finer = gm_picture_text(picture, "%s%s", grid->smaller_is_finer ? "1/" : "",
                                        grid->parameter ? grid->parameter->key : "");
    const char *const titles[] = {"error against run time", "error against evaluations",
                                  gm_picture_text(picture, "error against %s", finer)};
    const char *const labels[] = {"CPU time, s", "evaluations of f or force", finer};
    size_t most = 1; /* points of a line: tolerances may be more than steps */
    for (size_t i = 0; i < grid->begun; i++) {
        most = grid->lines[i].count > most ? grid->lines[i].count : most;
    }
    double *points = gm_picture_memory(picture, 2 * most * sizeof *points);
    const struct gm_axis x = {.label = labels[cost], .scale = GM_LOG, .low = 1, .high = 0},
                         y = {.label = "", .scale = GM_LOG, .low = 1, .high = 0};
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_GRAPH, titles[cost], &x, &y);
    for (size_t i = 0; i < grid->begun; i++) {
        const size_t count = points_of(&grid->lines[i], cost, points);
        for (size_t k = 0; k < count; k++) {
            gm_range_add(&panel->x.low, &panel->x.high, points[2 * k]);
            /* errors above 10 are drawn as 10 */
            gm_range_add(&panel->y.low, &panel->y.high, fmin(points[2 * k + 1], 10));
        }
    }
    gm_range_round(&panel->x.low, &panel->x.high, GM_LOG);
    if (cost == GM_COST_RESOLUTION && !grid->smaller_is_finer) {
        panel->x.ticks = rising(picture, grid->values.values, grid->values.count);
        panel->x.tick_count = grid->values.count;
    }
    gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
    struct drawn *lines = gm_picture_memory(picture, (chosen_count + grid->begun) * sizeof *lines);
    struct names names = {.panel = panel, .lines = lines, .line_count = chosen_count};
    for (size_t i = 0; i < chosen_count + grid->begun; i++) {
        const struct gm_grid_line *line = i < chosen_count ? chosen[i] : &grid->lines[i - chosen_count];
        if (i >= chosen_count && holds(chosen, chosen_count, line)) {
            continue;
        }
        double *own = gm_picture_memory(picture, 2 * line->count * sizeof *own);
        const struct drawn drawn = {own, points_of(line, cost, own)};
        if (i < chosen_count) {
            lines[i] = drawn;
        } else {
            lines[names.line_count++] = drawn;
            gm_mark_line(picture, panel, (struct gm_style){GM_SECONDARY, 0.35, 1.1, GM_SOLID}, own,
                         drawn.count, false);
        }
    }
    for (size_t i = 0; i < chosen_count; i++) {
        const double *own = lines[i].points;
        const struct gm_style style = gm_chart_style(i);
        gm_mark_line(picture, panel, style, own, lines[i].count, false);
        gm_mark_points(picture, panel, (struct gm_style){style.role, 1, 6, GM_SOLID}, own, lines[i].count);
    }
    for (size_t i = 0; i < chosen_count; i++) {
        const char *name = chosen[i]->scheme->title;
        if (lines[i].count == 0) {
            continue;
        }
        const struct place place = name_place(&names, &lines[i], (size_t)gm_text_width(name, false));
        names.taken[names.taken_count++] = place;
        gm_mark_text(picture, panel, (struct gm_style){gm_lane_role(i), 1, 1, GM_SOLID},
                     panel->x.low * pow(panel->x.high / panel->x.low, place.left),
                     panel->y.low * pow(panel->y.high / panel->y.low, 0.5 * (place.low + place.high)),
                     GM_ANCHOR_LEFT, name);
    }
}

void gm_work_draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    const struct gm_grid_line *chosen[NAMED] = {NULL};
    const size_t count = choose(grid, chosen);
    char sentence[512];
    picture->title = gm_picture_text(picture, "%s: what an accuracy costs", grid->request.scene->title);
    picture->subtitle =
        gm_picture_text(picture, "%s at t = %s,  %s%s%zu scheme%s%s", grid->measure_title,
                        gm_step_text(picture, gm_grid_timing(grid)->until), grid->settings,
                        grid->settings[0] ? ",  " : "", grid->begun, gm_plural((double)grid->begun),
                        count < grid->begun ? ";  grey: those without a name" : "");

    picture->clock = "";
    picture->caption = gm_picture_text(picture, "%s", sentence_of(grid, sentence, sizeof sentence));
    draw_cost(grid, picture, GM_COST_SECONDS, chosen, count);
    draw_cost(grid, picture, second_cost(grid), chosen, count);
}
