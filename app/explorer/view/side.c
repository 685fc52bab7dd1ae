/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The side panel: lanes and schemes, parameters, observables, and the formula. */
#include "app/explorer/view/view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "render/layout/panel.h"

/* The rows of the sections. */
struct plan {
    bool lanes;     /* the lanes are listed */
    int schemes;    /* rows of schemes without a lane, the last perhaps "more" */
    int parameters; /* rows of parameters */
    bool sparks;
    bool stacked;    /* an observable's name has its own row */
    int observables; /* rows of observables, with sparks */
    int gap;         /* blank rows before a section */
    bool more;       /* there are more schemes than rows */
};

/* ---- the distribution of rows ---- */

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

/* Returns the rows of observables: the scene's, and after a reversal of time the way back. */
static int observable_rows(const struct gm_shot *shot)
{
    return (int)shot->measured_count + shot->turned;
}

static struct plan plan_one(int rows, enum gm_side_panel side, const struct gm_shot *shot)
{
    struct plan plan = {.lanes = side != GM_SIDE_PARAMETERS};
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
    int observables = observable_rows(shot), each = left >= 3 * observables   ? 3
                                                    : left >= 2 * observables ? 2
                                                                              : 1;
    plan.stacked = each > 1;
    plan.sparks = each > 2;
    plan.observables = least(each * observables, left > 0 ? left : 0);
    return plan;
}

/* Returns the plan for all sections: first what must be visible, then what is useful, then space. */
static struct plan plan_all(int rows, const struct gm_shot *shot)
{
    int lanes = (int)shot->lane_count, parameters = (int)shot->parameter_count;
    int observables = observable_rows(shot), unused = count_unused(shot);
    struct plan plan = {.lanes = true};
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

/* ---- schemes: each section draws from `row` on and returns the next free row ---- */

/* a lane's line as three cells of text, dashed as in the picture */
static const char *const dashes[GM_DASH_COUNT] = {
    [GM_SOLID] = "━━━",    [GM_LONG_DASH] = "╍╍╍",  [GM_DOTS] = "•••",
    [GM_DASH_DOT] = "━•━", [GM_SHORT_DASH] = "┅┅┅", [GM_DASH_DOT_DOT] = "━••",
};

/* Returns the column of a lane's title, after the selection's mark and the lane's line. */
static int title_column(const struct gm_sheet *sheet)
{
    return gm_schemes_narrow(sheet) ? 5 : 6;
}

/* Returns a name without the scheme's title at its start, which precedes it on the screen. */
static const char *beyond_title(const char *name, const char *title)
{
    const size_t length = strlen(title);
    if (strncmp(name, title, length) != 0 || (name[length] != '\0' && name[length] != ',')) {
        return name;
    }
    return name[length] ? name + length + 2 : "";
}

/* Draws a title and difference up to column `end`. If they are too long, the difference is reduced to its
   values; then the title is cut, before a bracket at its end that distinguishes similar titles. */
static void lane_title(const struct gm_sheet *sheet, int row, const struct gm_shot_lane *lane,
                       const char *difference, int end, bool bold)
{
    enum { LEAST_TITLE = 5 };
    char front[320], values[256], tail[320];
    const int column = title_column(sheet), room = end - column;
    const char *title = lane->scheme->title, *bracket = strstr(title, " (");
    if (gm_sheet_width(sheet, title) + gm_sheet_width(sheet, difference) > room) {
        gm_name_without_keys(difference, values, sizeof values);
        difference = values;
    }
    snprintf(tail, sizeof tail, "%s%s", bracket ? bracket : "", difference);
    if (!bracket || room - gm_sheet_width(sheet, tail) < LEAST_TITLE) {
        bracket = title + strlen(title);
        snprintf(tail, sizeof tail, "%s", difference);
    }
    snprintf(front, sizeof front, "%.*s", (int)(bracket - title), title);
    if (room - gm_sheet_width(sheet, tail) < LEAST_TITLE) {
        snprintf(front, sizeof front, "%s%s", title, difference);
        tail[0] = '\0';
    }
    const int most = end - gm_sheet_width(sheet, tail), whole = column + gm_sheet_width(sheet, front);
    const struct gm_sheet left = gm_sheet_part(sheet, 0, 0, most, sheet->height);
    gm_sheet_cut(&left, column, row, front, gm_lane_role(lane->shown.colour), bold);
    gm_sheet_text(sheet, whole < most ? whole : most, row, tail, gm_lane_role(lane->shown.colour), bold);
}

enum { NOTES = 3, NOTE = 160, DIFFERENCE = 256 };

/* Writes a lane's failure in the longest of three forms, number 0, or a shorter one; "" if all is well. */
static void note_of(const struct gm_shot *shot, const struct gm_shot_lane *lane, int form, char text[NOTE])
{
    static const char *const failures[NOTES] = {"✕ %s, t = %.4g", "✕ %s", "✕"};
    static const char *const losses[NOTES] = {"! %s %.1g", "! lost", "!"};
    text[0] = '\0';
    if (lane->status != GM_OK) {
        snprintf(text, NOTE, failures[form], gm_status_name(lane->status), lane->t);
    } else if (lane->lost >= 0) {
        snprintf(text, NOTE, losses[form], shot->scene->observables[lane->lost].title,
                 lane->values[lane->lost]);
    }
}

/* Writes the difference of a lane from others of its scheme. Returns the column at which its title and that
   end. */
static int title_end(const struct gm_sheet *sheet, const struct gm_shot *shot,
                     const struct gm_shot_lane *lane, char *difference, size_t size)
{
    const char *title = lane->first_scheme->title;
    const char *panel = shot->overlaid ? "" : beyond_title(lane->shown.panel_name, title);
    const char *colour = beyond_title(lane->shown.colour_name, title);
    snprintf(difference, size, "%s%s%s%s", panel[0] ? ", " : "", panel, colour[0] ? ", " : "", colour);
    return title_column(sheet) + gm_sheet_width(sheet, lane->scheme->title) +
           gm_sheet_width(sheet, difference);
}

/* Returns the first form for which the notes of all lanes have room: they are all of one form. */
static int form_of_notes(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    char text[NOTE], difference[DIFFERENCE];
    int form = 0;
    for (size_t i = 0; i < shot->lane_count; i++) {
        const int end = title_end(sheet, shot, &shot->lanes[i], difference, sizeof difference);
        for (;; form++) {
            note_of(shot, &shot->lanes[i], form, text);
            if (!text[0] || form + 1 == NOTES || end < sheet->width - gm_sheet_width(sheet, text)) {
                break;
            }
        }
    }
    return form;
}

static void lane_row(const struct gm_sheet *sheet, int row, const struct gm_shot *shot, size_t index,
                     int form, unsigned columns)
{
    const struct gm_shot_lane *lane = &shot->lanes[index];
    const bool selected = index == shot->selected;
    char note[NOTE], difference[DIFFERENCE];
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    if (selected) {
        gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
    }
    gm_sheet_text(sheet, title_column(sheet) - 4, row, dashes[gm_lane_dash(lane->shown.dash)], role, false);
    const int whole = title_end(sheet, shot, lane, difference, sizeof difference);
    int end = sheet->width;
    note_of(shot, lane, form, note);
    if (note[0]) {
        gm_sheet_right(sheet, end, row, note, GM_INITIAL, true);
        end -= gm_sheet_width(sheet, note) + 1;
    } else {
        end = gm_schemes_facts(sheet, row, lane->scheme, whole, columns, true, GM_INK);
    }
    lane_title(sheet, row, lane, difference, end, selected);
}

static int draw_schemes(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                        const struct plan *plan)
{
    if (!plan->lanes) {
        return row;
    }
    const unsigned columns = gm_schemes_claims(shot);
    const int form = form_of_notes(sheet, shot);
    char text[64];
    gm_schemes_heading(sheet, row++, "SCHEMES");
    for (size_t i = 0; i < shot->lane_count; i++) {
        gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_LANE, .index = i});
        lane_row(sheet, row++, shot, i, form, columns);
    }
    int shown = 0, unused = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        if (gm_shot_uses(shot, shot->schemes[i])) {
            continue;
        }
        unused++;
        if (shown < plan->schemes - plan->more) {
            shown++;
            gm_sheet_hit(sheet, 0, row, sheet->width,
                         (struct gm_hit){.kind = GM_HIT_SCHEME, .scheme = shot->schemes[i]});
            gm_schemes_row(sheet, title_column(sheet), row++, shot, shot->schemes[i], GM_SECONDARY, false);
        }
    }
    if (plan->more && plan->schemes > 0) {
        snprintf(text, sizeof text, "… %d more fit", unused - shown);
        gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_KEY, .index = 's'});
        gm_sheet_text(sheet, title_column(sheet), row++, text, GM_SECONDARY, false);
    }
    return row;
}

/* ---- parameters ---- */

enum { VALUE_LETTERS = 9, RANGE_LETTERS = 6 };

/* Writes the value as typed, or with fewer digits to make room for a slider. */
static void value_text(const struct gm_shot_parameter *parameter, char *text, size_t size)
{
    double value;
    snprintf(text, size, "%s", parameter->value);
    if (strlen(text) > VALUE_LETTERS && parameter->row->type == GM_REAL && gm_number_parse(text, &value)) {
        snprintf(text, size, "%.5g", value);
    }
}

/* Returns the column of the values, after the longest key. */
static int value_column(const struct gm_shot *shot)
{
    int longest = 11;
    for (size_t i = 0; i < shot->parameter_count; i++) {
        int length = (int)strlen(shot->parameters[i].row->key);
        longest = length > longest ? length : longest;
    }
    return 2 + least(longest, 16) + 1;
}

/* Draws an end of a range in RANGE_LETTERS columns, if all its digits have room: a rounded end may be refused. */
static void range_end(const struct gm_sheet *sheet, int column, int row, double value, bool right)
{
    char text[64];
    const int width = (int)strlen(gm_number_format(value, text, sizeof text));
    if (width <= RANGE_LETTERS) {
        gm_sheet_text(sheet, column + (right ? RANGE_LETTERS - width : 0), row, text, GM_SECONDARY, false);
    }
}

static void parameter_row(const struct gm_sheet *sheet, int row, const struct gm_shot_parameter *parameter,
                          size_t index, int values, bool chosen)
{
    char text[GM_TEXT_SIZE + 8];
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
        range_end(sheet, bar, row, parameter->row->lowest, true);
        range_end(sheet, end - RANGE_LETTERS, row, parameter->row->highest, false);
        bar += RANGE_LETTERS + 1;
        end -= RANGE_LETTERS + 1;
    }
    gm_sheet_slider(sheet, bar, end, row, parameter->position, chosen);
    gm_sheet_hit(sheet, bar, row, end - bar, (struct gm_hit){.kind = GM_HIT_SLIDER, .index = index});
}

static int draw_parameters(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                           const struct plan *plan)
{
    int count = (int)shot->parameter_count, chosen = (int)sheet->face->parameter;
    if (plan->parameters <= 0) {
        return row;
    }
    gm_sheet_text(sheet, 0, row++, "PARAMETERS", GM_SECONDARY, true);
    int values = value_column(shot);
    /* the chosen parameter is always visible */
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

/* ---- observables ---- */

enum { VALUE_WIDTH = 9, SPARK_CELLS = GM_SPARK / 2 };

/* The common scale of an observable's graphs. */
struct scale {
    bool logarithmic;
    double low, high;
};

/* Returns false if there is nothing to draw. */
static bool spark_scale(const struct gm_shot *shot, size_t observable, struct scale *scale)
{
    const bool logarithmic = shot->scene->observables[observable].logarithmic;
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < shot->lane_count; i++) {
        const struct gm_spark *spark = &shot->lanes[i].sparks[observable];
        for (size_t k = 0; k < GM_SPARK; k++) {
            if (spark->low[k] > spark->high[k] || (logarithmic && spark->high[k] <= 0)) {
                continue;
            }
            low = fmin(low, logarithmic && spark->low[k] <= 0 ? spark->high[k] : spark->low[k]);
            high = fmax(high, spark->high[k]);
        }
    }
    *scale = (struct scale){logarithmic, logarithmic ? log10(low) : low, logarithmic ? log10(high) : high};
    return scale->low <= scale->high && isfinite(scale->low) && isfinite(scale->high);
}

static double spark_place(double value, const struct scale *scale)
{
    const double low = scale->low, high = scale->high;
    const double at = !scale->logarithmic ? value : value > 0 ? log10(value) : low;
    return high > low ? fmin(fmax((at - low) / (high - low), 0), 1) : 0.5;
}

/* Draws a graph as braille if the picture has it, otherwise as bars or letters of growing height. */
static void draw_spark(const struct gm_sheet *sheet, int column, int row, const struct gm_spark *spark,
                       const struct scale *scale, enum gm_role role)
{
    static const uint8_t dots[2][4] = {{0x40, 0x04, 0x02, 0x01}, {0x80, 0x20, 0x10, 0x08}}; /* from below */
    static const char letters[] = "_.-~'";
    int before = -1;
    for (int cell = 0; cell < SPARK_CELLS; cell++) {
        uint32_t glyph = 0, braille = 0;
        for (int half = 0; half < 2; half++) {
            double bottom = spark->low[2 * cell + half], top = spark->high[2 * cell + half];
            if (bottom > top || (scale->logarithmic && top <= 0)) {
                continue;
            }
            double from = spark_place(bottom, scale), to = spark_place(top, scale);
            int first = (int)(from * 3 + 0.5), last = (int)(to * 3 + 0.5);
            /* joined to the previous value, so that a steep rise is a line */
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

/* The columns of numbers: `count` lanes from `first` on. */
struct columns {
    const struct gm_shot *shot;
    size_t first, count;
    int begin, label;
};

/* Formats a number briefly, with a true minus sign. */
static void short_number(double value, char *text, size_t size)
{
    char digits[40];
    if (!isfinite(value)) {
        snprintf(text, size, "–");
        return;
    }
    if (fabs(value) < 1e6 && value == floor(value)) { /* a count is not rounded */
        snprintf(digits, sizeof digits, "%.0f", value);
    } else if (fabs(value) >= 1e-4 && fabs(value) < 1e-3) { /* shorter than with its zeros */
        snprintf(digits, sizeof digits, "%.3ge-4", value * 1e4);
    } else {
        snprintf(digits, sizeof digits, "%.3g", value);
    }
    /* a true minus sign, and no zeros or plus signs to fill an exponent */
    text[0] = '\0';
    for (const char *c = digits; *c && strlen(text) + 4 < size; c++) {
        if (*c == 'e') {
            gm_append(text, size, c[1] == '-' ? "e−" : "e");
            c += 1 + strspn(c + 2, "0");
        } else if (*c == '-') {
            gm_append(text, size, "−");
        } else {
            gm_append(text, size, "%c", *c);
        }
    }
}

/* Draws the lanes' values of observable k, or without one (negative) their way back, in a row, under or beside a
   name. */
static void draw_numbers(const struct gm_sheet *sheet, int row, const struct columns *columns,
                         const char *name, long k)
{
    const struct gm_sheet label = gm_sheet_part(sheet, 0, 0, columns->label, sheet->height);
    char text[64];
    gm_sheet_cut(&label, 0, row, name, GM_SECONDARY, false);
    if (columns->label == sheet->width) {
        row++;
    }
    for (size_t i = 0; i < columns->count; i++) {
        const struct gm_shot_lane *lane = &columns->shot->lanes[columns->first + i];
        short_number(k < 0 ? lane->from_start : lane->values[k], text, sizeof text);
        gm_sheet_right(sheet, columns->begin + (int)i * VALUE_WIDTH + SPARK_CELLS, row, text,
                       gm_lane_role(lane->shown.colour), false);
    }
}

static int draw_observables(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                            const struct plan *plan)
{
    if (plan->observables <= 0) {
        return row;
    }
    char text[64];
    int label = plan->stacked ? 0 : sheet->width >= 50 ? 14 : 13;
    struct columns columns = {.shot = shot, .count = (size_t)((sheet->width - label + 1) / VALUE_WIDTH)};
    columns.count = columns.count < 1                  ? 1
                    : columns.count > shot->lane_count ? shot->lane_count
                                                       : columns.count;
    /* the lanes whose values fit side by side include the selected one */
    columns.first = shot->selected < columns.count ? 0 : shot->selected - columns.count + 1;
    columns.begin = sheet->width - (int)columns.count * VALUE_WIDTH + 1;
    columns.label = plan->stacked ? sheet->width : columns.begin - 1;
    gm_sheet_text(sheet, 0, row, "OBSERVED", GM_SECONDARY, true);
    for (size_t i = 0; i < columns.count; i++) {
        const struct gm_shot_lane *lane = &shot->lanes[columns.first + i];
        int right = columns.begin + (int)i * VALUE_WIDTH + SPARK_CELLS;
        gm_sheet_right(sheet, right, row, dashes[gm_lane_dash(lane->shown.dash)],
                       gm_lane_role(lane->shown.colour), false);
    }
    row++;
    int end = row + plan->observables, each = 1 + plan->stacked + plan->sparks;
    if (shot->turned) {
        draw_numbers(sheet, row, &columns, "from start", -1);
        row += 1 + plan->stacked;
    }
    for (size_t k = 0; k < shot->observable_count && row + each <= end; k++) {
        const struct gm_observable *observable = &shot->scene->observables[k];
        struct scale scale;
        if (!shot->measured[k]) {
            continue;
        }
        observable_name(observable, text, sizeof text);
        draw_numbers(sheet, row, &columns, text, (long)k);
        bool graphs = plan->sparks && spark_scale(shot, k, &scale);
        for (size_t i = 0; graphs && i < columns.count; i++) {
            const struct gm_shot_lane *lane = &shot->lanes[columns.first + i];
            draw_spark(sheet, columns.begin + (int)i * VALUE_WIDTH, row + each - 1, &lane->sparks[k], &scale,
                       gm_lane_role(lane->shown.colour));
        }
        row += each;
    }
    return row;
}

/* ---- the panel ---- */

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    enum gm_side_panel side = sheet->face->side;
    struct plan plan =
        side == GM_SIDE_ALL ? plan_all(sheet->height, shot) : plan_one(sheet->height, side, shot);
    int row = draw_schemes(sheet, plan.gap, shot, &plan);
    row = draw_parameters(sheet, row + plan.gap, shot, &plan);
    row = draw_observables(sheet, row + plan.gap, shot, &plan);
    const struct gm_shot_lane *lane = &shot->lanes[shot->selected];
    if (side == GM_SIDE_PARAMETERS || sheet->height - row < 5) { /* a blank row, a heading, and three rows */
        return;
    }
    gm_sheet_text(sheet, 0, row + 1, "FORMULA", GM_SECONDARY, true);
    gm_sheet_right(sheet, sheet->width, row + 1, lane->scheme->title, gm_lane_role(lane->shown.colour),
                   false);
    gm_schemes_formula(sheet, row + 2, lane->scheme);
}
