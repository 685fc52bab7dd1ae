/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One panel of a layout: the room for its texts, then its box and its axes. */
#include "render/layout/panel.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

/* Distances in pixels of a picture 720 high. */
static const double tick_gap = 9.0, label_gap = 3.0, title_gap = 7.0, bar_gap = 16.0, bar_width = 14.0;

enum { FEWEST_TICKS = 3, MOST_TICKS = 6 };

static struct gm_axis bar_axis(const struct gm_mark *field)
{
    return (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = field->low, .high = field->high};
}

void gm_axis_range(const struct gm_axis *axis, double *low, double *high)
{
    gm_axis_shown(axis, low, high);
    if (axis->scale == GM_LOG) {
        *low = log10(*low);
        *high = log10(*high);
    }
}

static double step_of(enum gm_scale scale, const double *values, size_t count)
{
    if (count < 2) {
        return scale == GM_LOG ? 1.0 : 0.0;
    }
    return scale == GM_LOG ? log10(values[1] / values[0]) : values[1] - values[0];
}

/* Returns the widest tick label that an axis may get with any number of ticks. */
static double widest_tick(const struct gm_label_list *list, const struct gm_axis *axis, bool calm)
{
    if (calm) {
        return gm_labels_width(list, GM_TEXT_TICK, axis->scale == GM_LINEAR ? "−0.05" : "10⁻¹⁰");
    }
    double widest = 0.0;
    for (size_t max = FEWEST_TICKS; max <= MOST_TICKS; max++) {
        double values[GM_TICK_MAX];
        const size_t count = gm_ticks(axis, max, values);
        for (size_t i = 0; i < count; i++) {
            char text[64];
            gm_tick_format(axis->scale, values[i], step_of(axis->scale, values, count), text, sizeof text);
            widest = fmax(widest, gm_labels_width(list, GM_TEXT_TICK, text));
        }
    }
    return widest;
}

static bool has(const char *text)
{
    return text != NULL && text[0] != '\0';
}

static enum gm_text_size title_size(const struct gm_panel *panel)
{
    return panel->place == GM_PLACE_STATE ? GM_TEXT_PANEL : GM_TEXT_LABEL;
}

struct gm_border gm_border_of(const struct gm_label_list *list, const struct gm_panel *panel,
                              enum gm_detail detail, bool x_label, bool calm)
{
    const struct gm_metrics *metrics = list->metrics;
    const double scale = metrics->scale;
    struct gm_border border = {0};
    if (detail < GM_DETAIL_DATA && has(panel->title)) {
        border.top += metrics->line[title_size(panel)];
    }
    if (detail < GM_DETAIL_NO_NOTE && (has(panel->note) || panel->first_key)) {
        border.top += metrics->line[GM_TEXT_LABEL];
    }
    if (border.top > 0.0) {
        border.top += title_gap * scale;
    }
    if (panel->axes && detail < GM_DETAIL_NO_TICKS) {
        border.left = widest_tick(list, &panel->y, calm) + tick_gap * scale;
        border.right = 0.5 * widest_tick(list, &panel->x, calm);
        border.bottom = metrics->line[GM_TEXT_TICK] + tick_gap * scale;
        border.top = fmax(border.top, 0.5 * metrics->line[GM_TEXT_TICK]);
        if (detail < GM_DETAIL_NO_AXIS_LABELS && has(panel->y.label)) {
            border.left += metrics->line[GM_TEXT_LABEL] + label_gap * scale;
        }
        if (detail < GM_DETAIL_NO_AXIS_LABELS && x_label && has(panel->x.label)) {
            border.bottom += metrics->line[GM_TEXT_LABEL] + label_gap * scale;
        }
    }
    const struct gm_mark *field = panel->colour_bar ? gm_panel_field(panel) : NULL;
    if (field && detail < GM_DETAIL_NO_TICKS) {
        const struct gm_axis axis = bar_axis(field);
        double right = (bar_gap + bar_width + tick_gap) * scale + widest_tick(list, &axis, calm);
        if (has(panel->colour_bar_label)) {
            right += metrics->line[GM_TEXT_LABEL] + label_gap * scale;
        }
        border.bar = fmax(0.0, right - border.right);
        border.top = fmax(border.top, 0.5 * metrics->line[GM_TEXT_TICK]);
        border.bottom = fmax(border.bottom, 0.5 * metrics->line[GM_TEXT_TICK]);
    }
    return border;
}

/* Returns the room of a label along an axis. */
static double extent(const struct gm_label_list *list, bool across, const char *text)
{
    return across ? gm_labels_width(list, GM_TEXT_TICK, text) + 8.0 * list->metrics->scale
                  : 1.2 * list->metrics->line[GM_TEXT_TICK];
}

/* Places the most ticks that have room, with their labels; surface = origin + factor * value. Returns their
   number. */
static size_t place_ticks(struct gm_label_list *list, const struct gm_axis *axis, double origin,
                          double factor, bool across, struct gm_tick *ticks)
{
    for (size_t max = MOST_TICKS; max > 0; max--) {
        double values[GM_TICK_MAX], end = -INFINITY;
        const size_t count = gm_ticks(axis, max, values);
        const double step = step_of(axis->scale, values, count);
        bool fits = count > 0;
        for (size_t k = 0; k < count; k++) {
            const size_t i = factor > 0.0 ? k : count - 1 - k; /* order along the surface */
            char text[64];
            gm_tick_format(axis->scale, values[i], step, text, sizeof text);
            const double value = axis->scale == GM_LOG ? log10(values[i]) : values[i];
            ticks[i] = (struct gm_tick){.position = origin + factor * value,
                                        .value = values[i],
                                        .label = gm_picture_text(list->picture, "%s", text)};
            const double half = 0.5 * extent(list, across, text);
            fits = fits && ticks[i].position - half >= end;
            end = ticks[i].position + half;
        }
        if (fits) {
            return count;
        }
    }
    return 0;
}

static void label_ticks(struct gm_label_list *list, const struct gm_tick *ticks, size_t count, bool across,
                        double at, enum gm_anchor anchor)
{
    const double half = 0.5 * list->metrics->line[GM_TEXT_TICK];
    for (size_t i = 0; i < count; i++) {
        struct gm_label label = {ticks[i].label,
                                 GM_TEXT_TICK,
                                 GM_SECONDARY,
                                 across ? ticks[i].position : at,
                                 across ? at : ticks[i].position - half,
                                 .anchor = anchor};
        if (!gm_labels_add(list, label) && across && i == 0) { /* the other axis has a label in the corner */
            label.anchor = GM_ANCHOR_LEFT;
            gm_labels_add(list, label);
        }
    }
}

/* Returns the start of a title of this width: at the box, or as far before it as its room needs. */
static double title_start(const struct gm_fill *fill, double width)
{
    return fmax(fill->title_left, fmin(fill->box.x, fill->title_left + fill->title_width - width));
}

enum { LONGEST_NAME = 256 };

static const char *key_text(const struct gm_label_list *list, const struct gm_key *key)
{
    static const char *const samples[GM_DASH_COUNT] = {"───", "╌╌", "···", "─·", "╴╴╴", "─··"};
    return gm_picture_text(list->picture, "%s %s", samples[key->style.dash], key->name);
}

/* Returns the width of the keys in one line, with that distance. */
static double keys_width(const struct gm_label_list *list, const struct gm_panel *panel, double gap)
{
    double all = -gap;
    for (const struct gm_key *key = panel->first_key; key; key = key->next) {
        all += gm_labels_width(list, GM_TEXT_LABEL, key_text(list, key)) + gap;
    }
    return all;
}

/* Returns the distance of keys in a line: half of it if all of them then fit into the line. */
static double key_gap(const struct gm_label_list *list, const struct gm_panel *panel, double width)
{
    const double gap = 1.2 * list->metrics->line[GM_TEXT_LABEL];
    return keys_width(list, panel, gap) > width ? 0.5 * gap : gap;
}

/* Returns a key that is wider than a line without " at t = 3", and, if still too wide, without ", blow-up" or
   ", lost: ...". Panels with room show both, and so does the explorer's list of lanes. */
static struct gm_key without_failure(const struct gm_label_list *list, const struct gm_key *key, double width)
{
    struct gm_key shown = *key;
    const char *when = strstr(key->name, " at t = "), *what = strstr(key->name, ", lost: ");
    for (const char *at = key->name; when && (at = strstr(at, ", ")) && at < when; at++) {
        what = at;
    }
    const char *const ends[] = {when, what};
    for (size_t i = 0; i < 2; i++) {
        if (ends[i] && gm_labels_width(list, GM_TEXT_LABEL, key_text(list, &shown)) > width) {
            shown.name = gm_picture_text(list->picture, "%.*s", (int)(ends[i] - key->name), key->name);
        }
    }
    return shown;
}

/* Breaks a key into lines of that width and returns their number. A key too long for one line first loses the
   names of its values. Then it takes more lines; the sample of its line goes last, as it has the colour. */
static size_t key_lines(const struct gm_label_list *list, const struct gm_key *key, double width,
                        const char **lines)
{
    char values[LONGEST_NAME];
    const struct gm_key long_key = without_failure(list, key, width);
    gm_name_without_keys(long_key.name, values, sizeof values);
    const struct gm_key short_key = {.style = key->style,
                                     .name = gm_picture_text(list->picture, "%s", values)};
    const struct {
        const char *text;
        size_t most;
    } ways[] = {{key_text(list, &long_key), 1},
                {key_text(list, &short_key), 1},
                {key_text(list, &long_key), GM_KEY_LINES},
                {key_text(list, &short_key), GM_KEY_LINES},
                {short_key.name, GM_KEY_LINES}};
    size_t count = 0;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        count = gm_labels_wrap(list, GM_TEXT_LABEL, ways[i].text, width, ways[i].most, lines);
        if (gm_lines_are_whole(lines, count, ways[i].text)) {
            break;
        }
    }
    return count;
}

/* Sets keys side by side, each after a sample of its line, from (x, y) on. Returns the number of lines;
   without `out` it only counts them. */
static size_t set_keys(const struct gm_label_list *list, const struct gm_panel *panel, double x, double y,
                       double width, struct gm_label_list *out)
{
    const double gap = key_gap(list, panel, width), line = list->metrics->line[GM_TEXT_LABEL];
    double at = 0.0;
    size_t row = 0;
    for (const struct gm_key *key = panel->first_key; key; key = key->next) {
        const char *lines[GM_KEY_LINES];
        const size_t count = key_lines(list, key, width, lines);
        const double wide = count > 1 ? width : gm_labels_width(list, GM_TEXT_LABEL, count ? lines[0] : "");
        if (at > 0.0 && at + wide > width) {
            row++;
            at = 0.0;
        }
        for (size_t i = 0; i < count; i++) {
            row += i > 0;
            if (out) {
                gm_labels_add(out, (struct gm_label){lines[i], GM_TEXT_LABEL, key->style.role, x + at,
                                                     y + (double)row * line, .anchor = GM_ANCHOR_LEFT});
            }
        }
        at += wide + gap;
    }
    return row + 1;
}

size_t gm_key_lines(const struct gm_label_list *list, const struct gm_panel *panel, double width)
{
    return set_keys(list, panel, 0.0, 0.0, width, NULL);
}

static void label_panel(struct gm_label_list *list, const struct gm_panel *panel, const struct gm_fill *fill)
{
    const struct gm_metrics *metrics = list->metrics;
    const bool state = panel->place == GM_PLACE_STATE;
    const enum gm_text_size size = fill->small_title ? GM_TEXT_TICK : title_size(panel);
    const size_t most = fill->title_lines > 1 ? fill->title_lines : 1;
    const char *lines[GM_TITLE_LINES];
    const char *title = panel->title + fill->title_skip;
    size_t count = gm_labels_wrap(list, size, title, fill->title_width, most, lines);
    if (state && !gm_lines_are_whole(lines, count, title)) {
        char values[LONGEST_NAME];
        gm_name_without_keys(title, values, sizeof values);
        title = gm_picture_text(list->picture, "%s", values);
        count = gm_labels_wrap(list, size, title, fill->title_width, most, lines);
    }
    size_t words = fill->note_words;
    const char *note = gm_labels_shorten_number(list, GM_TEXT_LABEL, panel->note, fill->title_width, &words);
    double wider = fill->detail < GM_DETAIL_NO_NOTE ? gm_labels_width(list, GM_TEXT_LABEL, note) : 0.0;
    for (size_t i = 0; i < count; i++) {
        wider = fmax(wider, gm_labels_width(list, size, lines[i]));
    }
    const double x = title_start(fill, wider);
    double y = fill->box.y - title_gap * metrics->scale;
    if (fill->detail < GM_DETAIL_NO_NOTE) {
        y -= (double)fill->note_lines * metrics->line[GM_TEXT_LABEL];
    }
    if (fill->detail < GM_DETAIL_NO_NOTE && has(panel->note)) {
        gm_labels_add(list,
                      (struct gm_label){note, GM_TEXT_LABEL, GM_SECONDARY, x, y, .anchor = GM_ANCHOR_LEFT});
    } else if (fill->detail < GM_DETAIL_NO_NOTE && panel->first_key) {
        const double width = fill->title_width;
        set_keys(list, panel,
                 title_start(fill, fmin(keys_width(list, panel, key_gap(list, panel, width)), width)), y,
                 width, list);
    }
    for (size_t i = 0; fill->detail < GM_DETAIL_DATA && i < count; i++) {
        gm_labels_add(list, (struct gm_label){lines[i], size, state ? panel->title_role : GM_INK, x,
                                              y - (double)(most - i) * metrics->line[size],
                                              .bold = state && !fill->small_title});
    }
}

static void label_axes(struct gm_label_list *list, struct gm_axes *axes, enum gm_detail detail, bool x_label,
                       double left)
{
    const struct gm_metrics *metrics = list->metrics;
    const double scale = metrics->scale;
    const struct gm_panel *panel = axes->panel;
    const struct gm_box box = axes->box;
    const double below = box.y + box.height + tick_gap * scale;
    label_ticks(list, axes->y_ticks, axes->y_tick_count, false, box.x - tick_gap * scale, GM_ANCHOR_RIGHT);
    label_ticks(list, axes->x_ticks, axes->x_tick_count, true, below, GM_ANCHOR_CENTRE);
    if (detail >= GM_DETAIL_NO_AXIS_LABELS) {
        return;
    }
    if (x_label) {
        gm_labels_add(list, (struct gm_label){gm_labels_whole(list, GM_TEXT_LABEL, panel->x.label, box.width),
                                              GM_TEXT_LABEL, GM_INK, box.x + 0.5 * box.width,
                                              below + metrics->line[GM_TEXT_TICK] + label_gap * scale,
                                              .anchor = GM_ANCHOR_CENTRE});
    }
    gm_labels_add(list, (struct gm_label){gm_labels_whole(list, GM_TEXT_LABEL, panel->y.label, box.height),
                                          GM_TEXT_LABEL, GM_INK, box.x - left, box.y + 0.5 * box.height,
                                          .anchor = GM_ANCHOR_CENTRE, .vertical = true});
}

/* Checks if values lie beyond the ends of the bar, in any panel with its colours: one bar may serve all. */
static void find_beyond(const struct gm_picture *picture, const struct gm_mark *field, bool beyond[2])
{
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        const struct gm_mark *other = gm_panel_field(panel);
        if (other && other->map == field->map && other->low == field->low && other->high == field->high) {
            beyond[0] = beyond[0] || other->below;
            beyond[1] = beyond[1] || other->above;
        }
    }
}

/* Returns true for "θ" or "|u|", which has no two letters in a row. */
static bool is_symbol(const char *text)
{
    size_t i = 0;
    while (text[i] != '\0' && !(isalpha((unsigned char)text[i]) && isalpha((unsigned char)text[i + 1]))) {
        i++;
    }
    return i > 0 && text[i] == '\0';
}

/* Returns the label of a colour bar for this height, and its size: whole or its front, else smaller, else the
   symbol at its end, else cut. Without it the colours have no meaning. */
static const char *bar_label(struct gm_label_list *list, const char *text, double height,
                             enum gm_text_size *size)
{
    *size = GM_TEXT_LABEL;
    const char *whole = gm_labels_whole(list, GM_TEXT_LABEL, text, height);
    if (!has(text) || has(whole)) {
        return whole;
    }
    *size = GM_TEXT_TICK;
    const char *last = strrchr(text, ' ');
    const bool cut = gm_labels_width(list, GM_TEXT_TICK, text) > height;
    return gm_labels_shorten(list, GM_TEXT_TICK, cut && last && is_symbol(last + 1) ? last + 1 : text,
                             height);
}

static void place_colour_bar(struct gm_label_list *list, struct gm_axes *axes, const struct gm_mark *field)
{
    const double scale = list->metrics->scale;
    const struct gm_panel *panel = axes->panel;
    const struct gm_box box = axes->box;
    const struct gm_axis axis = bar_axis(field);
    axes->colour_bar =
        (struct gm_box){box.x + box.width + bar_gap * scale, box.y, bar_width * scale, box.height};
    bool beyond[2] = {false, false};
    find_beyond(list->picture, field, beyond);
    for (int end = 0; end < 2; end++) {
        axes->bar_tip[end] = beyond[end] ? fmin(bar_width * scale, 0.1 * box.height) : 0.0;
    }
    struct gm_box *bar = &axes->colour_bar;
    bar->y += axes->bar_tip[1];
    bar->height -= axes->bar_tip[0] + axes->bar_tip[1];
    const double factor = -bar->height / (axis.high - axis.low);
    axes->bar_tick_count =
        place_ticks(list, &axis, bar->y + bar->height - factor * axis.low, factor, false, axes->bar_ticks);
    const double right = axes->colour_bar.x + axes->colour_bar.width + tick_gap * scale;
    label_ticks(list, axes->bar_ticks, axes->bar_tick_count, false, right, GM_ANCHOR_LEFT);
    enum gm_text_size size;
    const char *label = bar_label(list, panel->colour_bar_label, box.height, &size);
    gm_labels_add(list, (struct gm_label){
                            label, size, GM_INK, right + widest_tick(list, &axis, false) + label_gap * scale,
                            box.y + 0.5 * box.height, .anchor = GM_ANCHOR_CENTRE, .vertical = true});
}

void gm_axes_fill(struct gm_label_list *list, struct gm_axes *axes, const struct gm_panel *panel,
                  const struct gm_fill *fill)
{
    const struct gm_box box = fill->box;
    double x_low, x_high, y_low, y_high;
    gm_axis_range(&panel->x, &x_low, &x_high);
    gm_axis_range(&panel->y, &y_low, &y_high);
    *axes = (struct gm_axes){.panel = panel, .box = box};
    axes->x_factor = box.width / (x_high - x_low);
    axes->y_factor = -box.height / (y_high - y_low);
    /* The middle of the range is the middle of the box, even if equal axes show more than the range. */
    if (panel->equal) {
        axes->x_factor = fmin(axes->x_factor, -axes->y_factor);
        axes->y_factor = -axes->x_factor;
    }
    axes->x_origin = box.x + 0.5 * box.width - axes->x_factor * 0.5 * (x_low + x_high);
    axes->y_origin = box.y + 0.5 * box.height - axes->y_factor * 0.5 * (y_low + y_high);

    label_panel(list, panel, fill);
    if (panel->axes && fill->detail < GM_DETAIL_NO_TICKS) {
        axes->x_tick_count =
            place_ticks(list, &panel->x, axes->x_origin, axes->x_factor, true, axes->x_ticks);
        axes->y_tick_count =
            place_ticks(list, &panel->y, axes->y_origin, axes->y_factor, false, axes->y_ticks);
        label_axes(list, axes, fill->detail, fill->x_label,
                   gm_border_of(list, panel, fill->detail, fill->x_label, false).left);
    }
    const struct gm_mark *field = panel->colour_bar ? gm_panel_field(panel) : NULL;
    if (field && fill->detail < GM_DETAIL_NO_TICKS && box.width > 0.0) {
        place_colour_bar(list, axes, field);
    }
}

/* Returns true if a box overlaps the data or the colour bar of a frame. */
static bool stands_on(const struct gm_box *box, const struct gm_axes *axes)
{
    return gm_boxes_overlap(box, &axes->box, 0.0) || gm_boxes_overlap(box, &axes->colour_bar, 0.0);
}

/* `air` is the margin that a label covers around it. */
static bool is_free(const struct gm_axes *axes, size_t count, size_t own, const struct gm_box *box,
                    double air)
{
    bool is_free = !gm_boxes_overlap(box, &axes[own].colour_bar, air);
    for (size_t i = 0; i < count; i++) {
        is_free = is_free && (i == own || !stands_on(box, &axes[i]));
    }
    return is_free;
}

/* The surroundings of a note: the labels so far and the axes of all panels, with the index of its own. */
struct surroundings {
    struct gm_label_list *list;
    const struct gm_axes *axes;
    size_t count, own;
    const struct gm_mark *mark;
};

/* Adds a line of a note, its top at y: at its anchor, or with `within` moved into the frame. */
static bool add_line(const struct surroundings *around, const char *text, double x, double y, bool within)
{
    struct gm_label_list *list = around->list;
    const struct gm_metrics *metrics = list->metrics;
    const struct gm_mark *mark = around->mark;
    const struct gm_box *data = &around->axes[around->own].box;
    const double line = metrics->line[GM_TEXT_TICK], width = gm_labels_width(list, GM_TEXT_TICK, text);
    const double air = 0.3 * line; /* distance to the edge of the surface */
    const double left =
        fmax(air, fmin(x - gm_anchor_share(mark->anchor) * width, metrics->width - width - air));
    const double inside = fmax(data->x + air, fmin(left, data->x + data->width - width));
    const struct gm_box box = {within ? inside : left, fmax(0.0, fmin(y, metrics->height - line)), width,
                               line};
    const bool on_axis = around->axes[around->own].panel->axes && !mark->fixed &&
                         box.x < data->x + air; /* the axis is the left edge of the frame */
    return !on_axis && is_free(around->axes, around->count, around->own, &box, air) &&
           gm_labels_add(list, (struct gm_label){text, GM_TEXT_TICK, mark->style.role, box.x, box.y,
                                                 .among_marks = true});
}

/* Adds the lines of a note with its anchor at (x, y), or none. They move together off the edges of the frame,
   and a little further until all are free. */
static void add_note(const struct surroundings *around, const char *const *lines, size_t made, double x,
                     double y)
{
    struct gm_label_list *list = around->list;
    const struct gm_mark *mark = around->mark;
    static const double shifts[] = {0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0}; /* shifts in lines */
    const size_t before = list->count;
    const double line = list->metrics->line[GM_TEXT_TICK], high = (double)made * line;
    const struct gm_box *data = &around->axes[around->own].box;
    double widest = 0.0;
    for (size_t i = 0; i < made; i++) {
        widest = fmax(widest, gm_labels_width(list, GM_TEXT_TICK, lines[i]));
    }
    if (mark->anchor == GM_ANCHOR_LEFT) { /* the lines are left-aligned, so that the widest has room */
        x = fmin(x, list->metrics->width - widest - 0.3 * line);
    }
    bool placed = false;
    const size_t tries = mark->fixed ? 1 : 2 * sizeof shifts / sizeof *shifts;
    for (size_t k = 0; k < tries && !placed; k++) {
        double top = y - 0.5 * high + shifts[k / 2] * line;
        if (!mark->fixed && high <= data->height) {
            const double below = k < 2 ? 0.0 : 0.2 * line; /* without another place letters touch the axis */
            top = fmax(data->y, fmin(top, data->y + data->height - high + below));
        }
        list->count = before;
        placed = true;
        for (size_t i = 0; i < made && placed; i++) {
            placed = add_line(around, lines[i], x, top, k % 2 == 1);
            top = placed ? list->labels[list->count - 1].y + line : top;
        }
    }
    list->count = placed ? list->count : before;
}

/* A note that is wider than the room on its side of the anchor is broken into two lines, if these fit there
   or at least into the frame: one line would cross the frame's edge. A note too wide for both is left out. */
void gm_axes_note(struct gm_label_list *list, const struct gm_axes *panel_axes, size_t count, size_t own,
                  const struct gm_mark *mark)
{
    const struct gm_metrics *metrics = list->metrics;
    const struct gm_axes *axes = &panel_axes[own];
    const struct gm_box *data = &axes->box;
    const double x = gm_axes_x(axes, mark->points[0]), y = gm_axes_y(axes, mark->points[1]);
    if (!(x >= data->x - 1.0 && x <= data->x + data->width + 1.0 && y >= data->y - 1.0 &&
          y <= data->y + data->height + 1.0)) {
        return;
    }
    const double line = metrics->line[GM_TEXT_TICK];
    const double scratch = mark->anchor == GM_ANCHOR_LEFT    ? metrics->width - 0.3 * line - x
                           : mark->anchor == GM_ANCHOR_RIGHT ? x - data->x
                                                             : data->width;
    const bool fits = gm_labels_width(list, GM_TEXT_TICK, mark->text) <= data->width;
    const struct surroundings around = {list, panel_axes, count, own, mark};
    const char *lines[2];
    size_t made = gm_labels_wrap(list, GM_TEXT_TICK, mark->text, scratch, 2, lines);
    if (!fits && !gm_lines_are_whole(lines, made, mark->text)) {
        made = gm_labels_wrap(list, GM_TEXT_TICK, mark->text, data->width, 2, lines);
    }
    if (made == 2 && gm_lines_are_whole(lines, made, mark->text)) {
        add_note(&around, lines, made, x, y);
    } else if (fits) {
        add_note(&around, &mark->text, 1, x, y);
    }
}
