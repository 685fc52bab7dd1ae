/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is observed, in the side panel: numbers and tiny graphs. */
#include <math.h>
#include <stdio.h>

#include "app/explorer/view/sections.h"

enum { VALUE_WIDTH = 9, SPARK_CELLS = GM_SPARK / 2 };

/* The common scale of an observable's graphs. */
static bool spark_range(const struct gm_shot *shot, size_t observable, double *low, double *high)
{
    bool logarithmic = shot->scene->observables[observable].logarithmic;
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < shot->lane_count; i++) {
        const struct gm_spark *spark = &shot->lanes[i].sparks[observable];
        for (size_t k = 0; k < GM_SPARK; k++) {
            if (spark->low[k] > spark->high[k] || (logarithmic && spark->high[k] <= 0)) {
                continue;
            }
            *low = fmin(*low, logarithmic && spark->low[k] <= 0 ? spark->high[k] : spark->low[k]);
            *high = fmax(*high, spark->high[k]);
        }
    }
    if (logarithmic) {
        *low = log10(*low);
        *high = log10(*high);
    }
    return *low <= *high && isfinite(*low) && isfinite(*high);
}

static double spark_place(double value, bool logarithmic, double low, double high)
{
    double at = logarithmic ? (value > 0 ? log10(value) : low) : value;
    return high > low ? fmin(fmax((at - low) / (high - low), 0), 1) : 0.5;
}

/* As braille where the picture has it, otherwise as bars or letters of growing height. */
static void draw_spark(const struct gm_sheet *sheet, int column, int row, const struct gm_spark *spark,
                       bool logarithmic, double low, double high, enum gm_role role)
{
    static const uint8_t dots[2][4] = {{0x40, 0x04, 0x02, 0x01}, {0x80, 0x20, 0x10, 0x08}}; /* from below */
    static const char letters[] = "_.-~'";
    int before = -1;
    for (int cell = 0; cell < SPARK_CELLS; cell++) {
        uint32_t glyph = 0, braille = 0;
        for (int half = 0; half < 2; half++) {
            double bottom = spark->low[2 * cell + half], top = spark->high[2 * cell + half];
            if (bottom > top || (logarithmic && top <= 0)) {
                continue;
            }
            double from = spark_place(bottom, logarithmic, low, high),
                   to = spark_place(top, logarithmic, low, high);
            int first = (int)(from * 3 + 0.5), last = (int)(to * 3 + 0.5);
            /* joined to the place before, so that a steep rise is a line and not two dots */
            if (before >= 0 && before + 1 < first) {
                first = before + 1;
            }
            if (before >= 0 && before - 1 > last) {
                last = before - 1;
            }
            before = (int)(to * 3 + 0.5);
            for (int i = first; i <= last; i++) {
                braille |= dots[half][i];
            }
            glyph = sheet->face->blocks == GM_ASCII ? (uint32_t)letters[(int)(to * 4 + 0.5)]
                                                    : 0x2581 + (uint32_t)(to * 7 + 0.5);
        }
        if (sheet->face->blocks == GM_BRAILLE && braille) {
            gm_sheet_glyph(sheet, column + cell, row, 0x2800 + braille, role, false);
        } else if (glyph) {
            gm_sheet_glyph(sheet, column + cell, row, glyph, role, false);
        }
    }
}

static void observable_name(const struct gm_observable *observable, char *text, size_t size)
{
    snprintf(text, size, "%s", observable->key);
    for (char *c = text; *c; c++) {
        if (*c == '_') {
            *c = ' ';
        }
    }
}

/* The lanes whose values fit side by side; the selected one is always among them. */
static size_t first_column(const struct gm_shot *shot, size_t columns)
{
    if (shot->lane_count <= columns || shot->selected < columns) {
        return 0;
    }
    return shot->selected - columns + 1;
}

int gm_side_observable_count(const struct gm_shot *shot)
{
    return (int)shot->observable_count + shot->turned;
}

/* The columns of numbers: the lanes from `first` on, as many as fit. */
struct columns {
    size_t first, count;
    int begin, label;
};

/* Numbers of the lanes in a row, under or beside a name. */
static void draw_numbers(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                         const struct columns *columns, const char *name,
                         double (*value)(const struct gm_shot_lane *, size_t), size_t k)
{
    const struct gm_sheet label = gm_sheet_part(sheet, 0, 0, columns->label, sheet->height);
    char text[64];
    gm_sheet_cut(&label, 0, row, name, GM_SECONDARY, false);
    if (columns->label == sheet->width) {
        row++;
    }
    for (size_t i = 0; i < columns->count; i++) {
        const struct gm_shot_lane *lane = &shot->lanes[columns->first + i];
        gm_side_number(value(lane, k), text, sizeof text);
        gm_sheet_right(sheet, columns->begin + (int)i * VALUE_WIDTH + SPARK_CELLS, row, text,
                       gm_side_role(lane), false);
    }
}

static double value_of(const struct gm_shot_lane *lane, size_t observable)
{
    return lane->values[observable];
}

static double way_back(const struct gm_shot_lane *lane, size_t unused)
{
    return (void)unused, lane->from_start;
}

int gm_side_observables(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                        const struct gm_side_plan *plan)
{
    if (plan->observables <= 0) {
        return row;
    }
    char text[64];
    int label = plan->stacked ? 0 : sheet->width >= 50 ? 14 : 13;
    struct columns columns = {.count = (size_t)((sheet->width - label + 1) / VALUE_WIDTH)};
    columns.count = columns.count < 1                  ? 1
                    : columns.count > shot->lane_count ? shot->lane_count
                                                       : columns.count;
    columns.first = first_column(shot, columns.count);
    columns.begin = sheet->width - (int)columns.count * VALUE_WIDTH + 1;
    columns.label = plan->stacked ? sheet->width : columns.begin - 1;
    gm_side_heading(sheet, row, "OBSERVED");
    for (size_t i = 0; i < columns.count; i++) {
        const struct gm_shot_lane *lane = &shot->lanes[columns.first + i];
        int right = columns.begin + (int)i * VALUE_WIDTH + SPARK_CELLS;
        gm_sheet_right(sheet, right, row, gm_side_dash(lane), gm_side_role(lane), false);
    }
    row++;
    int end = row + plan->observables, each = 1 + plan->stacked + plan->sparks;
    if (shot->turned) {
        draw_numbers(sheet, row, shot, &columns, "from start", way_back, 0);
        row += 1 + plan->stacked;
    }
    for (size_t k = 0; k < shot->observable_count && row + each <= end; k++) {
        const struct gm_observable *observable = &shot->scene->observables[k];
        double low = 0, high = 0;
        observable_name(observable, text, sizeof text);
        draw_numbers(sheet, row, shot, &columns, text, value_of, k);
        bool graphs = plan->sparks && spark_range(shot, k, &low, &high);
        for (size_t i = 0; graphs && i < columns.count; i++) {
            const struct gm_shot_lane *lane = &shot->lanes[columns.first + i];
            draw_spark(sheet, columns.begin + (int)i * VALUE_WIDTH, row + each - 1, &lane->sparks[k],
                       observable->logarithmic, low, high, gm_side_role(lane));
        }
        row += each;
    }
    return row;
}
