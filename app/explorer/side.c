/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The side panel: schemes with claims, parameters with sliders, observables with tiny graphs. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/explorer/screen.h"

/* A lane's line, as three cells of text; the same dash as in the picture. */
static const char *const dash_marks[GM_DASH_COUNT] = {
    [GM_SOLID] = "━━━",    [GM_LONG_DASH] = "╍╍╍",  [GM_DOTS] = "•••",
    [GM_DASH_DOT] = "━•━", [GM_SHORT_DASH] = "┅┅┅", [GM_DASH_DOT_DOT] = "━••",
};

static enum gm_role role_of(const struct gm_shot_lane *lane)
{
    return gm_lane_role(lane->shown.colour);
}

/* ---- sections ---- */

struct plan {
    int schemes;    /* rows of schemes without a lane, the last one perhaps "more" */
    int parameters; /* rows */
    bool sparks;
    int observables; /* rows, sparks included */
    int gap;         /* blank rows before a section */
    bool more;
};

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Shares the rows out: what must be seen first, then what is good to see, then air. */
static struct plan make_plan(int rows, const struct gm_shot *shot)
{
    int lanes = (int)shot->lane_count, parameters = (int)shot->parameter_count;
    int observables = (int)shot->observable_count, unused = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        bool used = false;
        for (size_t k = 0; k < shot->lane_count; k++) {
            used = used || shot->lanes[k].scheme == shot->schemes[i];
        }
        unused += !used;
    }
    struct plan plan = {0};
    int left = rows - 3 - lanes; /* three headings */
    plan.parameters = least(parameters, left > 6 ? 4 : left > 0 ? left / 2 : 0);
    left -= plan.parameters;
    plan.observables = least(observables, left > 0 ? left : 0);
    left -= plan.observables;
    int more = least(parameters - plan.parameters, left);
    plan.parameters += more;
    left -= more;
    if (unused > 0 && left > 0) {
        plan.schemes = 1;
        left--;
    }
    if (left >= 3) {
        plan.gap = 1;
        left -= 3;
    }
    if (left >= observables && plan.observables == observables) {
        plan.sparks = true;
        plan.observables = 2 * observables;
        left -= observables;
    }
    more = least(unused - plan.schemes, left > 0 ? left : 0);
    plan.schemes += more;
    plan.more = unused > plan.schemes;
    return plan;
}

static void heading(const struct gm_sheet *sheet, int row, const char *text)
{
    gm_sheet_text(sheet, 0, row, text, GM_SECONDARY, true);
}

/* ---- schemes ---- */

/* Only the claims that some scheme here makes take a column. */
static unsigned claims_here(const struct gm_shot *shot)
{
    unsigned claims = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        claims |= shot->schemes[i]->claims;
    }
    for (size_t i = 0; i < shot->lane_count; i++) {
        claims |= shot->lanes[i].scheme->claims;
    }
    return claims;
}

static void claims_text(unsigned claims, unsigned columns, char *text, size_t size)
{
    size_t at = 0;
    text[0] = '\0';
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT && at + 1 < size; bit++) {
        if (columns >> bit & 1) {
            at +=
                (size_t)snprintf(text + at, size - at, "%s", claims >> bit & 1 ? gm_claim_letter(bit) : " ");
        }
    }
}

static void scheme_facts(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme,
                         unsigned columns, enum gm_role role)
{
    char text[64], order[16];
    claims_text(scheme->claims, columns, text, sizeof text);
    snprintf(order, sizeof order, "%d", scheme->order);
    gm_sheet_right(sheet, sheet->width - 6, row, text, role, false);
    gm_sheet_right(sheet, sheet->width - 2, row, order, role, false);
}

static int title_width(const struct gm_sheet *sheet, unsigned columns)
{
    int width = sheet->width - 7;
    for (; columns; columns &= columns - 1) {
        width--;
    }
    return width;
}

static void scheme_title(const struct gm_sheet *sheet, int column, int row, const char *text,
                         unsigned columns, enum gm_role role, bool bold)
{
    const struct gm_sheet left = {
        sheet->cells, sheet->face, sheet->column, sheet->row, title_width(sheet, columns), sheet->height};
    gm_sheet_text(&left, column, row, text, role, bold);
}

static void lane_name(const struct gm_shot_lane *lane, char *text, size_t size)
{
    const char *panel = lane->shown.panel_name, *colour = lane->shown.colour_name,
               *title = lane->scheme->title;
    if (strcmp(colour, title) == 0) {
        colour = "";
    }
    snprintf(text, size, "%s%s%s%s%s", title, panel[0] ? ", " : "", panel, colour[0] ? ", " : "", colour);
}

static void lane_row(const struct gm_sheet *sheet, int row, const struct gm_shot_lane *lane, bool selected,
                     unsigned columns)
{
    char text[160];
    enum gm_role role = role_of(lane);
    if (selected) {
        gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
    }
    gm_sheet_text(sheet, 2, row, dash_marks[gm_lane_dash(lane->shown.colour)], role, false);
    lane_name(lane, text, sizeof text);
    if (lane->status == GM_OK) {
        scheme_title(sheet, 6, row, text, columns, role, selected);
        scheme_facts(sheet, row, lane->scheme, columns, GM_INK);
        return;
    }
    gm_sheet_text(sheet, 6, row, text, role, selected);
    snprintf(text, sizeof text, "  ✕ %s, t = %.4g", gm_status_name(lane->status), lane->t);
    gm_sheet_right(sheet, sheet->width, row, text, GM_INITIAL, true);
}

static int draw_schemes(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                        const struct plan *plan)
{
    unsigned columns = claims_here(shot);
    char text[64];
    heading(sheet, row, "SCHEMES");
    gm_sheet_right(sheet, sheet->width, row, sheet->width > 34 ? "claims order" : "order", GM_SECONDARY,
                   false);
    row++;
    for (size_t i = 0; i < shot->lane_count; i++) {
        lane_row(sheet, row++, &shot->lanes[i], i == shot->selected, columns);
    }
    int shown = 0, unused = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        bool used = false;
        for (size_t k = 0; k < shot->lane_count; k++) {
            used = used || shot->lanes[k].scheme == shot->schemes[i];
        }
        if (used) {
            continue;
        }
        unused++;
        if (shown < plan->schemes - plan->more) {
            shown++;
            scheme_title(sheet, 6, row, shot->schemes[i]->title, columns, GM_SECONDARY, false);
            scheme_facts(sheet, row++, shot->schemes[i], columns, GM_SECONDARY);
        }
    }
    if (plan->more && plan->schemes > 0) {
        snprintf(text, sizeof text, "… %d more fit", unused - shown);
        gm_sheet_text(sheet, 6, row++, text, GM_SECONDARY, false);
    }
    return row;
}

/* ---- parameters ---- */

static void draw_slider(const struct gm_sheet *sheet, int from, int to, int row, double position, bool chosen)
{
    int at = from + (int)(position * (to - from - 1) + 0.5);
    for (int i = from; i < to; i++) {
        gm_sheet_glyph(sheet, i, row,
                       i == at  ? 0x25CF
                       : i < at ? 0x2501
                                : 0x2500,
                       chosen && i <= at ? GM_INK
                       : i <= at         ? GM_SECONDARY
                                         : GM_GRID,
                       false);
    }
}

static void short_number(double value, char *text, size_t size)
{
    char digits[40];
    snprintf(digits, sizeof digits, "%.3g", value);
    /* a true minus sign, and no zeros or plus signs to fill an exponent */
    size_t at = 0;
    text[0] = '\0';
    for (const char *c = digits; *c && at + 4 < size; c++) {
        if (*c == '-') {
            at += (size_t)snprintf(text + at, size - at, "−");
        } else if (*c != '+') {
            at += (size_t)snprintf(text + at, size - at, "%c", *c);
        }
        if (*c == 'e') {
            bool minus = c[1] == '-';
            while (c[1] == '-' || c[1] == '+' || (c[1] == '0' && c[2])) {
                c++;
            }
            if (minus) {
                at += (size_t)snprintf(text + at, size - at, "−");
            }
        }
    }
}

static void parameter_row(const struct gm_sheet *sheet, int row, const struct gm_shot_parameter *parameter,
                          bool chosen)
{
    char text[64];
    enum gm_role ink = chosen ? GM_INK : GM_SECONDARY;
    int values = 14, bar = sheet->width >= 40 ? 25 : 23;
    if (chosen) {
        gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
    }
    gm_sheet_text(sheet, 2, row, parameter->row->key, ink, chosen);
    if (parameter->position < 0) {
        snprintf(text, sizeof text, chosen ? "‹ %s ›" : "%s", parameter->value);
        gm_sheet_text(sheet, values - (chosen ? 2 : 0), row, text, GM_INK, chosen);
        return;
    }
    int width = gm_sheet_text(sheet, values, row, parameter->value, GM_INK, chosen);
    if (parameter->differs) {
        width += gm_sheet_text(sheet, values + width, row, "…", GM_SECONDARY, false);
    }
    if (values + width + 1 > bar) {
        bar = values + width + 1;
    }
    int end = sheet->width;
    if (sheet->width - bar >= 24) {
        short_number(parameter->row->lowest, text, sizeof text);
        gm_sheet_right(sheet, bar + 6, row, text, GM_SECONDARY, false);
        bar += 7;
        short_number(parameter->row->highest, text, sizeof text);
        gm_sheet_text(sheet, end - 5, row, text, GM_SECONDARY, false);
        end -= 6;
    }
    draw_slider(sheet, bar, end, row, parameter->position, chosen);
}

static int draw_parameters(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                           const struct plan *plan)
{
    int count = (int)shot->parameter_count, chosen = (int)sheet->face->parameter;
    if (plan->parameters <= 0) {
        return row;
    }
    heading(sheet, row++, "PARAMETERS");
    /* the chosen one is always among those shown */
    int first = chosen - plan->parameters / 2;
    first = least(first, count - plan->parameters);
    first = first < 0 ? 0 : first;
    for (int i = first; i < first + plan->parameters && i < count; i++) {
        parameter_row(sheet, row++, &shot->parameters[i], i == chosen);
    }
    if (first + plan->parameters < count) {
        gm_sheet_right(sheet, sheet->width, row - plan->parameters - 1, "↑↓ more", GM_SECONDARY, false);
    }
    return row;
}

/* ---- observables ---- */

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

static int draw_observables(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                            const struct plan *plan)
{
    char text[64];
    int label = sheet->width >= 50 ? 14 : 13;
    size_t columns = (size_t)((sheet->width - label + 1) / VALUE_WIDTH);
    if (plan->observables <= 0) {
        return row;
    }
    columns = columns < 1 ? 1 : columns > shot->lane_count ? shot->lane_count : columns;
    size_t first = first_column(shot, columns);
    int begin = sheet->width - (int)columns * VALUE_WIDTH + 1;
    heading(sheet, row, "OBSERVED");
    for (size_t i = 0; i < columns; i++) {
        const struct gm_shot_lane *lane = &shot->lanes[first + i];
        const char *mark = dash_marks[gm_lane_dash(lane->shown.colour)];
        int right = begin + (int)i * VALUE_WIDTH + SPARK_CELLS;
        gm_sheet_right(sheet, right, row, mark, role_of(lane), false);
    }
    row++;
    int end = row + plan->observables;
    for (size_t k = 0; k < shot->observable_count && row < end; k++) {
        const struct gm_observable *observable = &shot->scene->observables[k];
        double low = 0, high = 0;
        bool graphs = plan->sparks && spark_range(shot, k, &low, &high);
        observable_name(observable, text, sizeof text);
        gm_sheet_text(sheet, 0, row, text, GM_SECONDARY, false);
        for (size_t i = 0; i < columns; i++) {
            const struct gm_shot_lane *lane = &shot->lanes[first + i];
            int column = begin + (int)i * VALUE_WIDTH;
            short_number(lane->values[k], text, sizeof text);
            gm_sheet_right(sheet, column + SPARK_CELLS, row, text, role_of(lane), false);
            if (graphs) {
                draw_spark(sheet, column, row + 1, &lane->sparks[k], observable->logarithmic, low, high,
                           role_of(lane));
            }
        }
        row += plan->sparks ? 2 : 1;
    }
    return row;
}

/* ---- a scheme's formula ---- */

static int formula_rows(const struct gm_scheme *scheme)
{
    int rows = 1; /* the reference */
    for (const char *at = scheme->formula; at && *at; rows++) {
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
    return rows;
}

static void draw_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme)
{
    for (const char *at = scheme->formula; at && *at; row++) {
        char line[256];
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        gm_sheet_text(sheet, 0, row, line, GM_INK, false);
        at += length + (at[length] == '\n');
    }
    gm_sheet_text(sheet, 0, row, scheme->reference ? scheme->reference : "", GM_SECONDARY, false);
}

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    struct plan plan = make_plan(sheet->height, shot);
    int row = draw_schemes(sheet, plan.gap, shot, &plan);
    row = draw_parameters(sheet, row + plan.gap, shot, &plan);
    row = draw_observables(sheet, row + plan.gap, shot, &plan);
    const struct gm_shot_lane *lane = &shot->lanes[shot->selected];
    if (sheet->height - row < formula_rows(lane->scheme) + 2) {
        return;
    }
    heading(sheet, row + 1, "FORMULA");
    gm_sheet_right(sheet, sheet->width, row + 1, lane->scheme->title, role_of(lane), false);
    draw_formula(sheet, row + 2, lane->scheme);
}

/* ---- choosing a scheme ---- */

void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    unsigned columns = claims_here(shot);
    size_t choice = sheet->face->choice;
    int count = (int)shot->scheme_count, row = 0;
    const struct gm_scheme *chosen = choice < shot->scheme_count ? shot->schemes[choice] : NULL;
    int rows = sheet->height > 16 ? sheet->height - 8 : sheet->height - 1;
    int first = (int)choice >= rows ? (int)choice - rows + 1 : 0;
    heading(sheet, row, "SWITCH TO");
    gm_sheet_right(sheet, sheet->width, row++, sheet->width > 34 ? "claims order" : "order", GM_SECONDARY,
                   false);
    for (int i = first; i < count && i < first + rows; i++, row++) {
        enum gm_role role = i == (int)choice ? GM_INK : GM_SECONDARY;
        if (i == (int)choice) {
            gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
        }
        for (size_t k = 0; k < shot->lane_count; k++) {
            if (shot->lanes[k].scheme == shot->schemes[i]) {
                gm_sheet_text(sheet, 2, row, "●", role_of(&shot->lanes[k]), false);
                role = role_of(&shot->lanes[k]);
                break;
            }
        }
        scheme_title(sheet, 4, row, shot->schemes[i]->title, columns, role, i == (int)choice);
        scheme_facts(sheet, row, shot->schemes[i], columns, role);
    }
    if (chosen) {
        draw_formula(sheet, row + 1, chosen);
    }
}
