/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The side panel: how its rows are shared out, and the parameters with their sliders. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/explorer/view/sections.h"

/* A lane's line, as three cells of text; the same dash as in the picture. */
static const char *const dash_marks[GM_DASH_COUNT] = {
    [GM_SOLID] = "━━━",    [GM_LONG_DASH] = "╍╍╍",  [GM_DOTS] = "•••",
    [GM_DASH_DOT] = "━•━", [GM_SHORT_DASH] = "┅┅┅", [GM_DASH_DOT_DOT] = "━••",
};

const char *gm_side_dash(const struct gm_shot_lane *lane)
{
    return dash_marks[gm_lane_dash(lane->shown.dash)];
}

enum gm_role gm_side_role(const struct gm_shot_lane *lane)
{
    return gm_lane_role(lane->shown.colour);
}

/* ---- sections ---- */

static int least(int a, int b)
{
    return a < b ? a : b;
}

static int count_unused(const struct gm_shot *shot)
{
    int unused = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        unused += !gm_shot_uses(shot, shot->schemes[i]);
    }
    return unused;
}

/* One section alone. */
static struct gm_side_plan plan_one(int rows, enum gm_side side, const struct gm_shot *shot)
{
    struct gm_side_plan plan = {.lanes = side != GM_SIDE_PARAMETERS};
    int left = rows - 1, lanes = (int)shot->lane_count, unused = count_unused(shot);
    if (side == GM_SIDE_PARAMETERS) {
        plan.parameters = least((int)shot->parameter_count, left);
        return plan;
    }
    left -= lanes;
    if (side == GM_SIDE_SCHEMES) {
        plan.schemes = least(unused, left > 0 ? left : 0);
        plan.more = unused > plan.schemes;
        return plan;
    }
    left -= 1; /* a second heading */
    int observables = gm_side_observable_count(shot), each = left >= 3 * observables   ? 3
                                                             : left >= 2 * observables ? 2
                                                                                       : 1;
    plan.stacked = each > 1;
    plan.sparks = each > 2;
    plan.observables = least(each * observables, left > 0 ? left : 0);
    return plan;
}

/* Shares the rows out: what must be seen first, then what is good to see, then air. */
static struct gm_side_plan plan_all(int rows, const struct gm_shot *shot)
{
    int lanes = (int)shot->lane_count, parameters = (int)shot->parameter_count;
    int observables = gm_side_observable_count(shot), unused = count_unused(shot);
    struct gm_side_plan plan = {.lanes = true};
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

void gm_side_heading(const struct gm_sheet *sheet, int row, const char *text)
{
    gm_sheet_text(sheet, 0, row, text, GM_SECONDARY, true);
}

void gm_side_number(double value, char *text, size_t size)
{
    char digits[40];
    if (!isfinite(value)) {
        snprintf(text, size, "–"); /* there is no such number here */
        return;
    }
    if (fabs(value) >= 1e-4 && fabs(value) < 1e-3) { /* shorter so than with all its zeros */
        snprintf(digits, sizeof digits, "%.3ge-4", value * 1e4);
    } else {
        snprintf(digits, sizeof digits, "%.3g", value);
    }
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

/* ---- parameters ---- */

enum { VALUE_LETTERS = 9 };

/* The value as it is typed, or with fewer digits where that leaves no room for a slider. */
static void value_text(const struct gm_shot_parameter *parameter, char *text, size_t size)
{
    double value;
    snprintf(text, size, "%s", parameter->value);
    if (strlen(text) > VALUE_LETTERS && parameter->row->type == GM_REAL && gm_number_parse(text, &value)) {
        snprintf(text, size, "%.5g", value);
    }
}

/* Where the values begin: after the longest key. */
static int value_column(const struct gm_shot *shot)
{
    int longest = 11;
    for (size_t i = 0; i < shot->parameter_count; i++) {
        int length = (int)strlen(shot->parameters[i].row->key);
        longest = length > longest ? length : longest;
    }
    return 2 + least(longest, 16) + 1;
}

static void parameter_row(const struct gm_sheet *sheet, int row, const struct gm_shot_parameter *parameter,
                          size_t index, int values, bool chosen)
{
    char text[64];
    enum gm_role ink = chosen ? GM_INK : GM_SECONDARY;
    int bar = values + VALUE_LETTERS + 1;
    if (chosen) {
        gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
    }
    gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_PARAMETER, .index = index});
    gm_sheet_text(sheet, 2, row, parameter->row->key, ink, chosen);
    if (parameter->position < 0) {
        const bool tight = 2 + gm_sheet_width(sheet, parameter->row->key) > values - 2;
        snprintf(text, sizeof text, !chosen ? "%s" : tight ? "‹%s›" : "‹ %s ›", parameter->value);
        gm_sheet_text(sheet, values - (!chosen ? 0 : tight ? 1 : 2), row, text, GM_INK, chosen);
        return;
    }
    value_text(parameter, text, sizeof text);
    int width = gm_sheet_text(sheet, values, row, text, GM_INK, chosen);
    if (parameter->differs) {
        width += gm_sheet_text(sheet, values + width, row, "…", GM_SECONDARY, false);
    }
    if (values + width + 1 > bar) {
        bar = values + width + 1;
    }
    int end = sheet->width;
    if (sheet->width - bar >= 24) {
        gm_side_number(parameter->row->lowest, text, sizeof text);
        gm_sheet_right(sheet, bar + 6, row, text, GM_SECONDARY, false);
        bar += 7;
        gm_side_number(parameter->row->highest, text, sizeof text);
        gm_sheet_text(sheet, end - 5, row, text, GM_SECONDARY, false);
        end -= 6;
    }
    gm_sheet_slider(sheet, bar, end, row, parameter->position, chosen);
    gm_sheet_hit(sheet, bar, row, end - bar, (struct gm_hit){.kind = GM_HIT_SLIDER, .index = index});
}

static int draw_parameters(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                           const struct gm_side_plan *plan)
{
    int count = (int)shot->parameter_count, chosen = (int)sheet->face->parameter;
    if (plan->parameters <= 0) {
        return row;
    }
    gm_side_heading(sheet, row++, "PARAMETERS");
    int values = value_column(shot);
    /* the chosen one is always among those shown */
    int first = chosen - plan->parameters / 2;
    first = least(first, count - plan->parameters);
    first = first < 0 ? 0 : first;
    for (int i = first; i < first + plan->parameters && i < count; i++) {
        parameter_row(sheet, row++, &shot->parameters[i], (size_t)i, values, i == chosen);
    }
    if (first + plan->parameters < count) {
        gm_sheet_right(sheet, sheet->width, row - plan->parameters - 1, "↑↓ more", GM_SECONDARY, false);
    }
    return row;
}

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    enum gm_side side = sheet->face->side;
    struct gm_side_plan plan =
        side == GM_SIDE_ALL ? plan_all(sheet->height, shot) : plan_one(sheet->height, side, shot);
    int row = gm_side_schemes(sheet, plan.gap, shot, &plan);
    row = draw_parameters(sheet, row + plan.gap, shot, &plan);
    row = gm_side_observables(sheet, row + plan.gap, shot, &plan);
    const struct gm_shot_lane *lane = &shot->lanes[shot->selected];
    if (side == GM_SIDE_PARAMETERS || sheet->height - row < gm_side_formula_rows(lane->scheme) + 2) {
        return;
    }
    gm_side_heading(sheet, row + 1, "FORMULA");
    gm_sheet_right(sheet, sheet->width, row + 1, lane->scheme->title, gm_side_role(lane), false);
    gm_side_formula(sheet, row + 2, lane->scheme);
}
