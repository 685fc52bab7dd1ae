/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a sweep: over one key a graph with a line for each scheme, over two a map for each. A table
   of any length goes into bins, each of which shows the mean of its runs. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/grid.h"
#include "app/grid/sweep.h"
#include "app/output/row.h"
#include "core/arena.h"
#include "core/expression/number.h"
#include "core/schemes.h"
#include "scenes/common/symbol.h"

enum {
    GRAPH_BINS = 1024, /* across */
    MAP_BINS = 256,    /* across, and up */
    MOST_PANELS = 9,
    MOST_POINTS = 1 << 18, /* of many values a run; more are thinned */
};

struct bin {
    double sum;
    size_t runs;
};

/* Points of a line: every `every`-th of those that came. */
struct dots {
    double *points;
    size_t count, came, every;
};

struct gm_sweep_chart {
    const struct gm_sweep *sweep;
    size_t keys[2], key_count; /* the words along the axes */
    size_t bins[2];            /* 1 up, in a graph */
    size_t lines;              /* lines per observable: the combinations of all other words */
    size_t shown;              /* observables: the first of the sweep's */
    struct bin *cells;         /* [((observable * lines + line) * bins up + up) * bins across + across] */
    struct dots *dots;         /* per line, of many values a run; else NULL */
    size_t failed;             /* runs, which are left out */
};

/* Plans the picture's axes and lines; returns false with a sentence if the sweep has none. */
static bool plan(struct gm_sweep_chart *chart, const struct gm_sweep *sweep, char *message)
{
    size_t axes = 0;
    *chart = (struct gm_sweep_chart){.sweep = sweep, .lines = 1};
    for (size_t i = 0; i < sweep->words.count; i++) {
        const struct gm_word *word = &sweep->words.list[i];
        const struct gm_parameter *row = gm_word_parameter(sweep->scene, word->key);
        const bool number = gm_word_is_number(sweep->scene, word->key) && !(row && row->automatic);
        /* of many values a run only the first key is along an axis */
        if (number && word->count > 1 && !(sweep->values && axes > 0)) {
            chart->keys[axes % 2] = i;
            axes++;
        } else if (!sweep->words.zip) {
            chart->lines *= word->count;
        }
    }
    chart->key_count = axes;
    chart->shown = sweep->values ? 1 : sweep->measure || sweep->chosen.count < 1 ? sweep->chosen.count : 1;
    if (chart->shown == 0) {
        return gm_refuse(message, "%s has no observable that a picture could show", sweep->scene->name);
    }
    const size_t panels = chart->shown * (axes == 2 || sweep->values ? chart->lines : 1);
    if (axes < 1 || axes > 2 || (axes == 2 && sweep->words.zip)) {
        return gm_refuse(message,
                         "a picture is made of one key with several numbers, or of two, and not of %zu%s",
                         axes, axes == 2 ? " that are paired" : "");
    }
    if (panels > MOST_PANELS) {
        return gm_refuse(message, "a picture has up to %d %s, and these are %zu", MOST_PANELS,
                         axes == 1 ? "graphs" : "maps", panels);
    }
    if (axes == 1 && chart->lines > GM_LANE_COLOURS && !sweep->values) {
        return gm_refuse(message, "a picture has up to %d lines, and these are %zu", GM_LANE_COLOURS,
                         chart->lines);
    }
    for (size_t i = 0; i < 2; i++) {
        const size_t count = i < axes ? sweep->words.list[chart->keys[i]].count : 1;
        const size_t most = axes == 1 ? GRAPH_BINS : MAP_BINS;
        chart->bins[i] = count < most ? count : most;
    }
    return true;
}

bool gm_sweep_is_drawable(const struct gm_sweep *sweep, char *message)
{
    struct gm_sweep_chart chart;
    return plan(&chart, sweep, message);
}

/* Returns true if a word is along an axis. */
static bool is_axis(const struct gm_sweep_chart *chart, size_t word)
{
    return word == chart->keys[0] || (chart->key_count == 2 && word == chart->keys[1]);
}

static size_t line_of(const struct gm_sweep_chart *chart, size_t run)
{
    const struct gm_words *words = &chart->sweep->words;
    size_t line = 0;
    for (size_t i = 0; i < words->count && chart->lines > 1; i++) {
        if (!is_axis(chart, i)) {
            line = line * words->list[i].count + gm_words_choice(words, i, run);
        }
    }
    return line;
}

static size_t bin_of(const struct gm_sweep_chart *chart, size_t axis, size_t run)
{
    if (axis >= chart->key_count) {
        return 0;
    }
    const struct gm_words *words = &chart->sweep->words;
    const size_t choice = gm_words_choice(words, chart->keys[axis], run);
    const double part = (double)choice / (double)words->list[chart->keys[axis]].count;
    return chart->bins[axis] == words->list[chart->keys[axis]].count
               ? choice
               : (size_t)(part * (double)chart->bins[axis]);
}

static struct bin *bins_of(const struct gm_sweep_chart *chart, size_t observable, size_t line)
{
    return &chart->cells[(observable * chart->lines + line) * chart->bins[0] * chart->bins[1]];
}

static size_t most_points(const struct gm_sweep_chart *chart)
{
    return MOST_POINTS / chart->lines;
}

static void add_dot(struct dots *dots, size_t most, double x, double y)
{
    if (dots->count == most) {
        dots->count = 0;
        for (size_t i = 0; i < most; i += 2) {
            memmove(dots->points + 2 * dots->count++, dots->points + 2 * i, 2 * sizeof x);
        }
        dots->every *= 2;
    }
    if (dots->came++ % dots->every == 0) {
        dots->points[2 * dots->count] = x;
        dots->points[2 * dots->count++ + 1] = y;
    }
}

/* The number that a choice of a word is; NaN: none. */
static double number_of(const struct gm_word *word, size_t choice)
{
    char text[GM_TEXT_SIZE];
    double number = NAN;
    gm_number_parse(gm_word_value(word, choice, text), &number);
    return number;
}

/* Takes the rows of a run with many values. */
static void take_values(struct gm_sweep_chart *chart, size_t run, const char *rows)
{
    const struct gm_words *words = &chart->sweep->words;
    const struct gm_word *word = &words->list[chart->keys[0]];
    const size_t value = chart->sweep->index + 2;
    const double x = number_of(word, gm_words_choice(words, chart->keys[0], run));
    for (const char *row = rows; *row; row = strchr(row, '\n') + 1) {
        char *end = NULL;
        const char *cell = gm_csv_cell(row, value);
        const double y = strtod(cell, &end);
        if (end != cell && isfinite(y)) {
            add_dot(&chart->dots[line_of(chart, run)], most_points(chart), x, y);
        }
    }
}

void gm_sweep_chart_take(struct gm_sweep_chart *chart, size_t run, const char *row)
{
    if (strncmp(gm_csv_cell(row, chart->sweep->status), "ok,", 3) != 0) {
        chart->failed++;
        return;
    }
    if (chart->dots) {
        take_values(chart, run, row);
        return;
    }
    for (size_t i = 0; i < chart->shown; i++) {
        char *end = NULL;
        const char *cell = gm_csv_cell(row, chart->sweep->status + GM_SWEEP_COSTS + i);
        const double value = strtod(cell, &end);
        struct bin *bin = &bins_of(
            chart, i, line_of(chart, run))[bin_of(chart, 1, run) * chart->bins[0] + bin_of(chart, 0, run)];
        if (end != cell && isfinite(value)) {
            bin->sum += value;
            bin->runs++;
        }
    }
}

struct gm_sweep_chart *gm_sweep_chart_open(struct gm_arena *arena, const struct gm_sweep *sweep)
{
    char message[GM_MESSAGE];
    struct gm_sweep_chart *chart = gm_arena_take(arena, 1, sizeof *chart);
    gm_arena_check(arena, plan(chart, sweep, message), message);
    chart->dots = sweep->values ? gm_arena_take(arena, chart->lines, sizeof *chart->dots) : NULL;
    for (size_t line = 0; chart->dots && line < chart->lines; line++) {
        chart->dots[line] = (struct dots){.every = 1};
        chart->dots[line].points = gm_arena_take(arena, most_points(chart), 2 * sizeof(double));
    }
    chart->cells = gm_arena_take(arena, chart->shown * chart->lines * chart->bins[0] * chart->bins[1],
                                 sizeof *chart->cells);
    return chart;
}

bool gm_sweep_chart_read(struct gm_sweep_chart *chart, const char *path, char *message)
{
    struct gm_csv_lines table = {.stream = fopen(path, "r"), .group = chart->sweep->index};
    if (!table.stream) {
        return gm_refuse(message, "%.360s could not be read: %s", path, strerror(errno));
    }
    gm_csv_next(&table);
    for (size_t run = 0; run < chart->sweep->count && gm_csv_next(&table); run++) {
        gm_sweep_chart_take(chart, run, table.line);
    }
    gm_csv_close(&table);
    return true;
}

/* ---- drawing ---- */

static double mean_of(const struct bin *bin)
{
    return bin->runs > 0 ? bin->sum / (double)bin->runs : NAN;
}

/* The drawn values of an observable: their ends, and the choice of a logarithmic scale. */
struct extent {
    double low, high;
    bool logarithmic, is_signed;
};

static struct extent extent_of(const struct gm_sweep_chart *chart, size_t observable)
{
    const double wide = 30, balanced = 0.05;
    const struct bin *bins = bins_of(chart, observable, 0);
    double low = 1, high = 0, least = 1, greatest = 0;
    for (size_t i = 0; i < chart->lines * chart->bins[0] * chart->bins[1]; i++) {
        const double value = mean_of(&bins[i]);
        gm_range_add(&low, &high, value);
        if (value > 0) {
            gm_range_add(&least, &greatest, value);
        }
    }
    const bool powers = low >= 0 && least > 0 && greatest > wide * least;
    return (struct extent){.low = powers ? least : low,
                           .high = powers ? greatest : high,
                           .logarithmic = powers,
                           .is_signed = fmin(-low, high) > balanced * fmax(-low, high)};
}

/* The number that stands for a bin: of those of its runs the middle one. */
static double value_at(const struct gm_sweep_chart *chart, size_t axis, size_t bin)
{
    const struct gm_word *word = &chart->sweep->words.list[chart->keys[axis]];
    const double each = (double)word->count / (double)chart->bins[axis];
    return number_of(word, (size_t)(each * ((double)bin + 0.5)));
}

/* The bins of an axis by their values, which may have been typed in any order. */
static void order_bins(const struct gm_sweep_chart *chart, size_t axis, size_t *order, double *values)
{
    const size_t count = chart->bins[axis];
    for (size_t i = 0; i < count; i++) {
        const double value = value_at(chart, axis, i);
        size_t at = i;
        for (; at > 0 && values[at - 1] > value; at--) {
            values[at] = values[at - 1];
            order[at] = order[at - 1];
        }
        values[at] = value;
        order[at] = i;
    }
}

/* Returns true if an axis is logarithmic: by equal factors in the range, or by its parameter. */
static bool is_logarithmic(const struct gm_sweep_chart *chart, size_t axis)
{
    const struct gm_word *word = &chart->sweep->words.list[chart->keys[axis]];
    const struct gm_parameter *row = gm_scene_parameter(chart->sweep->scene, word->key);
    bool equal_factors = row && row->logarithmic, even = false;
    for (size_t i = 0; i < word->piece_count; i++) {
        equal_factors |= word->pieces[i].range.logarithmic;
        even |= word->pieces[i].range.count > 0 && !word->pieces[i].range.logarithmic;
    }
    for (size_t i = 0; i < chart->bins[axis]; i++) {
        equal_factors = equal_factors && value_at(chart, axis, i) > 0;
    }
    return equal_factors && !even;
}

static const char *key_label(const struct gm_sweep_chart *chart, size_t axis, struct gm_picture *picture)
{
    const char *key = chart->sweep->words.list[chart->keys[axis]].key;
    const struct gm_parameter *row = gm_scene_parameter(chart->sweep->scene, key);
    const char *unit = row ? row->unit : "";
    return gm_picture_text(picture, "%s%s%s", gm_key_symbol(key), unit[0] ? ", " : "", unit);
}

static const char *title_of(const struct gm_sweep_chart *chart, size_t observable, struct gm_picture *picture)
{
    char title[GM_MESSAGE];
    const struct gm_scene *scene = chart->sweep->scene;
    return gm_picture_text(
        picture, "%s",
        gm_observable_title(gm_scene_observable_at(scene, chart->sweep->chosen.numbers[observable]), title,
                            sizeof title));
}

/* The same without the formula that may follow two blanks. */
static const char *short_title(const struct gm_sweep_chart *chart, size_t observable,
                               struct gm_picture *picture)
{
    const char *title = title_of(chart, observable, picture), *formula = strstr(title, "  ");
    return formula ? gm_picture_text(picture, "%.*s", (int)(formula - title), title) : title;
}

/* The name that distinguishes a line: "Verlet, system = pendulum". */
static const char *line_name(const struct gm_sweep_chart *chart, size_t line, struct gm_picture *picture)
{
    const struct gm_words *words = &chart->sweep->words;
    const char *name = "";
    for (size_t i = words->count; i-- > 0;) {
        const struct gm_word *word = &words->list[i];
        if (is_axis(chart, i) || words->zip) {
            continue;
        }
        char text[GM_TEXT_SIZE];
        const char *value = gm_word_name(word, line % word->count, text);
        const bool scheme = strcmp(word->key, "scheme") == 0;
        if (scheme) {
            value = gm_scheme_find(value)->title;
        }
        if (word->count > 1 || scheme) {
            name = gm_picture_text(picture, "%s%s%s%s%s", scheme ? "" : word->key, scheme ? "" : " = ", value,
                                   name[0] ? ", " : "", name);
        }
        line /= word->count;
    }
    return name;
}

static void draw_graph(const struct gm_sweep_chart *chart, size_t observable, struct gm_picture *picture)
{
    enum { SINGLE = 64 }; /* the largest number of separate points */
    const size_t count = chart->bins[0];
    const struct extent extent = extent_of(chart, observable);
    double *points = gm_picture_memory(picture, 3 * count * sizeof *points), *values = points + 2 * count;
    size_t *order = gm_picture_memory(picture, count * sizeof *order);
    const struct gm_axis x = {.label = key_label(chart, 0, picture),
                              .scale = is_logarithmic(chart, 0) ? GM_LOG : GM_LINEAR,
                              .low = 1,
                              .high = 0},
                         y = {.label = "",
                              .scale = extent.logarithmic ? GM_LOG : GM_LINEAR,
                              .low = extent.low,
                              .high = extent.high};
    struct gm_panel *panel =
        gm_chart_panel(picture, GM_PLACE_GRAPH, title_of(chart, observable, picture), &x, &y);
    order_bins(chart, 0, order, values);
    for (size_t i = 0; i < count; i++) {
        points[2 * i] = values[i];
        gm_range_add(&panel->x.low, &panel->x.high, points[2 * i]);
    }
    gm_range_round(&panel->y.low, &panel->y.high, panel->y.scale);
    for (size_t line = 0; line < chart->lines; line++) {
        const struct bin *bins = bins_of(chart, observable, line);
        for (size_t i = 0; i < count; i++) {
            points[2 * i + 1] = mean_of(&bins[order[i]]);
        }
        const struct gm_style style = {gm_lane_role(line), 1, 2, gm_lane_dash(line)};
        gm_mark_line(picture, panel, style, points, count, false);
        if (count <= SINGLE) {
            gm_mark_points(picture, panel, (struct gm_style){style.role, 1, 5, GM_SOLID}, points, count);
        }
        gm_panel_key(picture, panel, style, line_name(chart, line, picture));
    }
}

/* The values of a line's runs as points over the key, which are darker where they lie closer. */
static void draw_values(const struct gm_sweep_chart *chart, size_t line, struct gm_picture *picture)
{
    const struct dots *dots = &chart->dots[line];
    struct gm_axis axes[] = {{.label = key_label(chart, 0, picture),
                              .scale = is_logarithmic(chart, 0) ? GM_LOG : GM_LINEAR,
                              .low = 1,
                              .high = 0},
                             {.label = chart->sweep->name, .low = 1, .high = 0}};
    for (size_t other = 0; other < chart->lines; other++) { /* all panels have one scale */
        for (size_t i = 0; i < 2 * chart->dots[other].count; i++) {
            gm_range_add(&axes[i % 2].low, &axes[i % 2].high, chart->dots[other].points[i]);
        }
    }
    gm_range_round(&axes[1].low, &axes[1].high, GM_LINEAR);
    struct gm_panel *panel =
        gm_chart_panel(picture, GM_PLACE_STATE, line_name(chart, line, picture), &axes[0], &axes[1]);
    panel->note = dots->count == 0 ? "no run has a value" : "";
    gm_mark_points(picture, panel, (struct gm_style){.role = gm_lane_role(0), .alpha = 0.35, .width = 1.3},
                   dots->points, dots->count);
}

/* The corners of a map's cells, four for each, and its two triangles. */
struct cells {
    double *points, *values;
    int *triangles;
    size_t count; /* number of cells */
};

static void add_cell(struct cells *cells, const double x[2], const double y[2], double value)
{
    const size_t first = 4 * cells->count;
    for (size_t i = 0; i < 4; i++) {
        cells->points[2 * (first + i)] = x[i == 1 || i == 2];
        cells->points[2 * (first + i) + 1] = y[i >= 2];
        cells->values[first + i] = value;
    }
    const int corner = (int)first;
    const int triangles[] = {corner, corner + 1, corner + 2, corner, corner + 2, corner + 3};
    memcpy(&cells->triangles[6 * cells->count++], triangles, sizeof triangles);
}

static void draw_map(const struct gm_sweep_chart *chart, size_t observable, size_t line,
                     struct gm_picture *picture)
{
    const size_t across = chart->bins[0], up = chart->bins[1], all = across * up;
    const struct extent extent = extent_of(chart, observable);
    const char *title = title_of(chart, observable, picture);
    double values[MAP_BINS], edges[2][MAP_BINS + 1];
    size_t order[2][MAP_BINS];
    struct cells cells = {.points = gm_picture_memory(picture, 8 * all * sizeof *cells.points),
                          .values = gm_picture_memory(picture, 4 * all * sizeof *cells.values),
                          .triangles = gm_picture_memory(picture, 6 * all * sizeof *cells.triangles)};
    const char *name = line_name(chart, line, picture);
    /* a small picture has no room at the bar */
    struct gm_panel *panel = gm_panel_add(
        picture, GM_PLACE_STATE,
        chart->shown > 1 ? gm_picture_text(picture, "%s%s%s", short_title(chart, observable, picture),
                                           name[0] ? ", " : "", name)
                         : name);
    const bool empty = extent.low > extent.high, even = extent.low == extent.high;
    panel->axes = true;
    panel->colour_bar = !empty && !even; /* one number has no scale */
    panel->note = empty                ? "no run has a number"
                  : even               ? gm_picture_text(picture, "%.6g everywhere", extent.low)
                  : extent.logarithmic ? "colour: log₁₀"
                                       : "";
    panel->colour_bar_label = gm_picture_text(picture, "%s%s", extent.logarithmic ? "log₁₀ " : "", title);
    for (size_t axis = 0; axis < 2; axis++) {
        struct gm_axis *shown = axis == 0 ? &panel->x : &panel->y;
        order_bins(chart, axis, order[axis], values);
        *shown = gm_chart_edges(key_label(chart, axis, picture), values, chart->bins[axis],
                                is_logarithmic(chart, axis), edges[axis]);
    }
    const struct bin *bins = bins_of(chart, observable, line);
    for (size_t i = 0; i < all; i++) {
        const double value = mean_of(&bins[order[1][i / across] * across + order[0][i % across]]);
        /* 0 is less than any power: it has the colour of the least */
        const double shown = extent.logarithmic ? log10(fmax(value, extent.low)) : value;
        if (isfinite(value)) {
            add_cell(&cells, &edges[0][i % across], &edges[1][i / across], shown);
        }
    }
    const double reach = fmax(-extent.low, extent.high);
    const double low = extent.logarithmic ? log10(extent.low) : extent.is_signed ? -reach : extent.low;
    const double high = extent.logarithmic ? log10(extent.high) : extent.is_signed ? reach : extent.high;
    if (!empty) {
        gm_mark_mesh(picture, panel, extent.is_signed ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL, low, high,
                     cells.points, cells.values, 4 * cells.count, cells.triangles, 2 * cells.count);
    }
}

/* The value of an axis that is nearest to a place on it. */
static size_t nearest_choice(const struct gm_sweep_chart *chart, size_t axis, double place)
{
    const struct gm_word *word = &chart->sweep->words.list[chart->keys[axis]];
    const bool powers = is_logarithmic(chart, axis);
    size_t nearest = 0;
    double least = INFINITY;
    for (size_t i = 0; i < word->count; i++) {
        const double value = number_of(word, i);
        const double away = powers ? fabs(log(value / place)) : fabs(value - place);
        if (away < least) {
            least = away;
            nearest = i;
        }
    }
    return nearest;
}

bool gm_sweep_pick(const struct gm_sweep_chart *chart, size_t map, double x, double y, size_t *run)
{
    const struct gm_sweep *sweep = chart->sweep;
    if (chart->key_count != 2 || map >= chart->shown * chart->lines) {
        return false;
    }
    const size_t chosen[] = {nearest_choice(chart, 0, x), nearest_choice(chart, 1, y)};
    size_t line = map % chart->lines, each = 1;
    *run = 0;
    for (size_t i = sweep->words.count; i-- > 0;) { /* the last list changes fastest */
        const struct gm_word *word = &sweep->words.list[i];
        size_t choice = i == chart->keys[0] ? chosen[0] : chosen[1];
        if (!is_axis(chart, i)) {
            choice = line % word->count;
            line /= word->count;
        }
        *run += choice * each;
        each *= word->count;
    }
    return true;
}

/* "until = 10, steps = 5": the keys that have one value. */
static const char *fixed_words(const struct gm_sweep *sweep, struct gm_picture *picture)
{
    const char *text = "";
    for (size_t i = 0; i < sweep->words.count; i++) {
        const struct gm_word *word = &sweep->words.list[i];
        if (word->count == 1 && strcmp(word->key, "scheme") != 0) {
            text = gm_picture_text(picture, "%s,  %s = %s", text, gm_key_symbol(word->key),
                                   word->pieces[0].text);
        }
    }
    return text;
}

void gm_sweep_chart_draw(const void *data, struct gm_picture *picture)
{
    const struct gm_sweep_chart *chart = data;
    const struct gm_sweep *sweep = chart->sweep;
    const size_t last = chart->key_count - 1;
    const char *shown = sweep->values       ? sweep->name
                        : chart->shown == 1 ? short_title(chart, 0, picture)
                                            : "what comes out";
    picture->title = gm_picture_text(picture, "%s: %s over %s%s%s", sweep->scene->title, shown,
                                     key_label(chart, 0, picture), last > 0 ? " and " : "",
                                     last > 0 ? key_label(chart, last, picture) : "");
    picture->subtitle = gm_picture_text(picture, "%zu run%s%s", sweep->count, gm_plural((double)sweep->count),
                                        fixed_words(sweep, picture));
    const bool binned = sweep->words.list[chart->keys[0]].count > chart->bins[0] ||
                        (last > 0 && sweep->words.list[chart->keys[last]].count > chart->bins[last]);
    picture->clock = "";
    picture->caption = gm_picture_text(
        picture, "%s%s",
        sweep->values
            ? gm_picture_text(picture, "The last %zu values of each run, one for each %s. ", sweep->kept,
                              strcmp(sweep->at, "section") == 0 ? "point of the section" : sweep->at)
        : binned ? "What lies closer together is shown by its mean. "
                 : "",
        chart->failed > 0
            ? gm_picture_text(picture, "%zu of the runs gave no numbers and are left out.", chart->failed)
            : "");
    for (size_t line = 0; chart->dots && line < chart->lines; line++) {
        draw_values(chart, line, picture);
    }
    for (size_t i = 0; i < chart->shown && !chart->dots; i++) {
        for (size_t line = 0; line < chart->lines && chart->key_count == 2; line++) {
            draw_map(chart, i, line, picture);
        }
        if (chart->key_count == 1) {
            draw_graph(chart, i, picture);
        }
    }
}
