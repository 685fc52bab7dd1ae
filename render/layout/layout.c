/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a picture on a surface of given size. */
#include "render/layout/panel.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Distances in pixels of a picture 720 high. */
static const double side_margin = 40.0, top_margin = 16.0, bottom_margin = 18.0, header_gap = 18.0,
                    column_gap = 26.0, row_gap = 22.0, group_gap = 44.0;

/* The part of the width for a column of graphs beside states. */
static const double graph_share = 0.3, terse_graph_share = 0.38;

/* The least part of the height for a row of graphs under states, and its greatest width in heights. */
static const double row_share = 0.36, flattest_row = 9.0;

/* The weight of how well states fill their area, against their size. */
static const double fill_power = 0.25;

/* The usual width of a graph in heights, and the least. */
static const double graph_aspect = 1.75, graph_narrowest = 1.0;

/* Panels of one place, in a grid over an area. */
struct group {
    struct gm_axes *frames; /* the frames; only their panels are set at first */
    size_t count;
    enum gm_place place;
    struct gm_box area;
    size_t wanted; /* requested columns; 0: any number */
    size_t columns, rows;
    size_t title_lines; /* lines of each panel's title; 0 counts as 1 */
    enum gm_detail detail;
};

/* Margins shrink on narrow surfaces. */
static double margin_of(double width, double wanted)
{
    return fmin(wanted, 0.035 * width);
}

/* Only the lowest of graphs with a common axis names it. */
static bool names_x(const struct group *group, size_t i)
{
    const size_t below = i + group->columns;
    return group->place == GM_PLACE_STATE || below >= group->count ||
           strcmp(group->frames[i].panel->x.label, group->frames[below].panel->x.label) != 0;
}

/* A common colour bar is next to the grid: border->bar. */
static double cell_width(const struct group *group, const struct gm_border *border, double gap)
{
    const double gaps = (double)(group->columns - 1) * gap;
    return fmax(0.0, (group->area.width - border->bar - gaps) / (double)group->columns);
}

static double cell_height(const struct group *group, double gap)
{
    return fmax(0.0, (group->area.height - (double)(group->rows - 1) * gap) / (double)group->rows);
}

/* Returns the border of the neediest panel for all, so that their boxes are equal and in line. */
static struct gm_border common_border(const struct gm_label_list *list, const struct group *group, bool calm)
{
    struct gm_border border = {0};
    size_t bars = 0;
    bool between = false; /* a panel with a bar has another one beside it */
    for (size_t i = 0; i < group->count; i++) {
        const struct gm_border self =
            gm_border_of(list, group->frames[i].panel, group->detail, names_x(group, i), calm);
        border.left = fmax(border.left, self.left);
        border.right = fmax(border.right, self.right);
        border.top = fmax(border.top, self.top);
        border.bottom = fmax(border.bottom, self.bottom);
        border.bar = fmax(border.bar, self.bar);
        bars += self.bar > 0.0;
        between |= self.bar > 0.0 && i + 1 < group->count && (i + 1) % group->columns != 0;
    }
    if (bars > 1 || between) {
        border.right += border.bar;
        border.bar = 0.0;
    }
    if (group->detail < GM_DETAIL_NO_NOTE) {
        const double width = cell_width(group, &border, column_gap * list->metrics->scale);
        for (size_t i = 0; i < group->count; i++) {
            const struct gm_panel *panel = group->frames[i].panel;
            const bool noted = panel->first_key != NULL || (panel->note != NULL && panel->note[0] != '\0');
            const size_t lines = noted ? gm_key_lines(list, panel, width) : 0;
            border.note_lines = lines > border.note_lines ? lines : border.note_lines;
        }
        border.top += border.note_lines > 1
                          ? (double)(border.note_lines - 1) * list->metrics->line[GM_TEXT_LABEL]
                          : 0.0;
    }
    if (group->detail < GM_DETAIL_DATA && group->title_lines > 1) {
        border.top += (double)(group->title_lines - 1) * list->metrics->line[GM_TEXT_TICK];
    }
    return border;
}

/* Returns width by height of a panel's data; 0 if it takes any. */
static double aspect_of(const struct gm_panel *panel)
{
    double x_low, x_high, y_low, y_high;
    gm_axis_range(&panel->x, &x_low, &x_high);
    gm_axis_range(&panel->y, &y_low, &y_high);
    return panel->equal ? (x_high - x_low) / (y_high - y_low) : 0.0;
}

/* Returns the size of the data of the group's panels with the current grid and detail: the side of a
   square. */
static double data_size(const struct gm_label_list *list, const struct group *group)
{
    const double scale = list->metrics->scale;
    const struct gm_border border = common_border(list, group, true);
    const double width = cell_width(group, &border, column_gap * scale) - border.left - border.right;
    const double height = cell_height(group, row_gap * scale) - border.top - border.bottom;
    double aspect = 0.0;
    for (size_t i = 0; i < group->count && aspect == 0.0; i++) {
        aspect = aspect_of(group->frames[i].panel);
    }
    if (aspect == 0.0) {
        aspect = graph_aspect;
    }
    return fmin(width / sqrt(aspect), height * sqrt(aspect));
}

/* Returns true if a title of the group's states is wider than that in letters of a size. */
static bool titles_too_long(const struct gm_label_list *list, const struct group *group,
                            enum gm_text_size size, double width)
{
    bool too_long = false;
    for (size_t i = 0; i < group->count && group->place == GM_PLACE_STATE; i++) {
        too_long = too_long || gm_labels_width(list, size, group->frames[i].panel->title) > width;
    }
    return too_long;
}

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* Returns the bytes of a title before "then" if another title begins with them: two forks of one scheme
   differ after them. */
static size_t fork_front(const struct group *group, size_t index)
{
    const char *title = group->frames[index].panel->title, *then = strstr(title, ", then ");
    const size_t front = then ? (size_t)(then - title) + 2 : 0;
    bool shared = false;
    for (size_t i = 0; front > 0 && i < group->count; i++) {
        shared = shared || (i != index && strncmp(title, group->frames[i].panel->title, front) == 0);
    }
    return shared ? front : 0;
}

/* Returns the bytes up to a comma and blank with which all titles of states begin: the rest identifies the
   states. A scheme that was replaced during the run stays before its successor. */
static size_t common_front(const struct group *group)
{
    const char *first = group->frames[0].panel->title;
    size_t length = 0;
    if (group->count < 2 || group->place != GM_PLACE_STATE) {
        return 0;
    }
    for (const char *at = strstr(first, ", "); at && !begins(at, ", then "); at = strstr(at + 1, ", ")) {
        const size_t front = (size_t)(at - first) + 2;
        bool shared = true;
        for (size_t i = 1; i < group->count; i++) {
            shared = shared && strncmp(first, group->frames[i].panel->title, front) == 0;
        }
        length = shared ? front : length;
    }
    return length;
}

/* Returns true if a title of the group's states, without the common front, does not fit into `most` lines of
   that width. */
static bool titles_are_cut(struct gm_label_list *list, const struct group *group, size_t most, double width)
{
    const size_t skip = common_front(group);
    for (size_t i = 0; i < group->count && group->place == GM_PLACE_STATE; i++) {
        const char *title = group->frames[i].panel->title + skip, *lines[GM_TITLE_LINES];
        const size_t count = gm_labels_wrap(list, GM_TEXT_TICK, title, width, most, lines);
        if (!gm_lines_are_whole(lines, count, title)) {
            return true;
        }
    }
    return false;
}

/* Chooses the grid that makes the panels largest, and their details. A hole in the grid costs its share,
   because a comparison is best in one row. A title that is cut or left out costs too; it is broken into lines
   if that costs less. Returns the worth of the best grid, in units of the surface. */
static double choose_grid(struct gm_label_list *list, struct group *group, size_t most_columns)
{
    const double cut_titles = 0.7;
    /* ticks matter most in a graph, so it may become smaller before they go */
    const double least = (group->place == GM_PLACE_GRAPH ? 2.5 : 4.5) * list->metrics->line[GM_TEXT_TICK];
    const double scale = list->metrics->scale;
    double best = -INFINITY;
    struct group chosen = *group;
    for (size_t columns = 1; columns <= most_columns; columns++) {
        if (group->wanted > 0 && group->wanted <= most_columns && columns != group->wanted) {
            continue;
        }
        struct group trial = *group;
        trial.columns = columns;
        trial.rows = (group->count + columns - 1) / columns;
        if ((trial.rows - 1) * columns >= group->count || (columns - 1) * trial.rows >= group->count) {
            continue; /* an empty row or column */
        }
        const double filled = (double)group->count / (double)(trial.columns * trial.rows);
        const struct gm_border border = common_border(list, &trial, true);
        const double width = cell_width(&trial, &border, column_gap * scale);
        bool cut = titles_too_long(list, &trial, GM_TEXT_TICK, width), more = true;
        for (trial.title_lines = 1; more; trial.title_lines++) {
            double loss = filled;
            for (int detail = GM_DETAIL_ALL; detail <= GM_DETAIL_DATA; detail++, loss *= 0.8) {
                trial.detail = (enum gm_detail)detail;
                const double size = data_size(list, &trial);
                /* names of the panels are worth more than the rest */
                if (size < (detail == GM_DETAIL_NO_TICKS ? 0.6 : 1.0) * least && detail < GM_DETAIL_DATA) {
                    continue;
                }
                const double worth = size * loss * (cut || detail == GM_DETAIL_DATA ? cut_titles : 1.0);
                if (worth > best) {
                    best = worth;
                    chosen = trial;
                }
                break;
            }
            more = cut && trial.title_lines < GM_TITLE_LINES &&
                   titles_are_cut(list, &trial, trial.title_lines, width);
            cut = more && titles_are_cut(list, &trial, trial.title_lines + 1, width);
        }
    }
    *group = chosen;
    return best;
}

/* Returns true if a panel's data need not fill its box: equal axes without ticks show more than their
   range. */
static bool expands(const struct gm_panel *panel)
{
    return !panel->axes && !panel->colour_bar && gm_panel_field(panel) == NULL;
}

/* Returns the words before its number that have room in the note of panel i and in all notes with the same
   front: such notes are shortened alike. */
static size_t note_words(struct gm_label_list *list, const struct group *group, size_t i, double width)
{
    const char *note = group->frames[i].panel->note;
    const size_t front = gm_before_number(note);
    size_t words = SIZE_MAX;
    for (size_t k = 0; k < group->count && front > 0; k++) {
        const char *other = group->frames[k].panel->note;
        if (gm_before_number(other) == front && strncmp(note, other, front) == 0) {
            gm_labels_shorten_number(list, GM_TEXT_LABEL, other, width, &words);
        }
    }
    return words;
}

/* Places the panels: boxes narrower than their cell in its middle, or, with `leftmost`, under the picture's
   title. */
static void place_group(struct gm_label_list *list, struct group *group, double overhang, bool leftmost)
{
    const double scale = list->metrics->scale;
    struct gm_border border = common_border(list, group, false);
    bool bars = false;
    for (size_t i = 0; i < group->count; i++) {
        bars = bars || group->frames[i].panel->colour_bar;
    }
    if (!bars) { /* the last tick label may extend into the margin or the gap */
        border.right = fmax(0.0, border.right - fmin(overhang, column_gap * scale));
    }
    const double column = cell_width(group, &border, column_gap * scale),
                 row = cell_height(group, row_gap * scale);
    const double width = fmax(0.0, column - border.left - border.right);
    const double height = fmax(0.0, row - border.top - border.bottom);

    const bool small_titles = titles_too_long(list, group, GM_TEXT_PANEL, column);
    const size_t skip = titles_too_long(list, group, GM_TEXT_TICK, column) ? common_front(group) : 0;
    for (size_t i = 0; i < group->count; i++) {
        const struct gm_panel *panel = group->frames[i].panel;
        const char *lines[GM_TITLE_LINES], *title = panel->title + skip;
        const size_t most = group->title_lines > 1 ? group->title_lines : 1;
        const bool cut =
            small_titles && title && fork_front(group, i) > skip &&
            !gm_lines_are_whole(lines, gm_labels_wrap(list, GM_TEXT_TICK, title, column, most, lines), title);
        const double x = group->area.x + (double)(i % group->columns) * (column + column_gap * scale);
        const double y = group->area.y + (double)(i / group->columns) * (row + row_gap * scale);
        struct gm_box box = {x + border.left, y + border.top, width, height};
        const double aspect = aspect_of(panel);
        if (aspect > 0.0 && !expands(panel)) {
            box.width = fmin(width, height * aspect);
            box.height = fmin(height, width / aspect);
        } else if (group->place == GM_PLACE_GRAPH && group->columns == 1) {
            box.height = fmin(height, width / graph_narrowest);
        }
        if (!leftmost) {
            box.x += 0.5 * (width - box.width);
        }
        box.y += 0.5 * (height - box.height);
        gm_axes_fill(list, &group->frames[i], panel,
                     &(struct gm_fill){.box = box,
                                       .detail = group->detail,
                                       .x_label = names_x(group, i),
                                       .note_lines = border.note_lines,
                                       .note_words = note_words(list, group, i, column),
                                       .small_title = small_titles,
                                       .title_lines = group->title_lines,
                                       .title_skip = cut ? fork_front(group, i) : skip,
                                       .title_left = x,
                                       .title_width = column});
    }
}

/* The greatest part of the height for the picture's title. */
static const double title_share = 0.18;

/* Places title, subtitle and clock. Returns where they end. */
static double place_header(struct gm_label_list *list, const struct gm_picture *picture, double margin)
{
    const struct gm_metrics *metrics = list->metrics;
    const double scale = metrics->scale, width = fmax(0.0, metrics->width - 2.0 * margin);
    double y = top_margin * scale, left = width;
    bool header = false;
    if (gm_labels_width(list, GM_TEXT_TITLE, picture->clock) < 0.6 * width &&
        gm_labels_add(list, (struct gm_label){picture->clock, GM_TEXT_TITLE, GM_INK, metrics->width - margin,
                                              y, .anchor = GM_ANCHOR_RIGHT, .mono = true})) {
        left -= gm_labels_width(list, GM_TEXT_TITLE, picture->clock) + column_gap * scale;
        header = true;
    }
    const char *lines[GM_TITLE_LINES];
    const size_t capacity = (size_t)fmax(1.0, title_share * metrics->height / metrics->line[GM_TEXT_TITLE]);
    const size_t count = gm_labels_wrap(list, GM_TEXT_TITLE, picture->title, left,
                                        capacity < GM_TITLE_LINES ? capacity : GM_TITLE_LINES, lines);
    for (size_t i = 0; i < count; i++) {
        header |= gm_labels_add(list, (struct gm_label){lines[i], GM_TEXT_TITLE, GM_INK, margin,
                                                        y + (double)i * metrics->line[GM_TEXT_TITLE],
                                                        .bold = true});
    }
    if (header) {
        y += (double)(count > 1 ? count : 1) * metrics->line[GM_TEXT_TITLE];
    }
    if (!metrics->terse &&
        gm_labels_add(list,
                      (struct gm_label){gm_labels_shorten(list, GM_TEXT_LABEL, picture->subtitle, width),
                                        GM_TEXT_LABEL, GM_SECONDARY, margin, y, .anchor = GM_ANCHOR_LEFT})) {
        y += metrics->line[GM_TEXT_LABEL];
    }
    return y + (header ? header_gap * scale : 0.0);
}

/* Places the caption's lines along the bottom. Returns where they start. */
static double place_caption(struct gm_label_list *list, const struct gm_picture *picture, double margin)
{
    const struct gm_metrics *metrics = list->metrics;
    const char *lines[2];
    double bottom = metrics->height - bottom_margin * metrics->scale;
    const size_t most = metrics->terse ? 1 : 2;
    size_t count = gm_labels_wrap(list, GM_TEXT_LABEL, picture->caption,
                                  fmax(0.0, metrics->width - 2.0 * margin), most, lines);
    if ((double)count * metrics->line[GM_TEXT_LABEL] > 0.2 * metrics->height) {
        count = 0;
    }
    if (count == 0 || strstr(lines[count - 1], "…")) { /* half a sentence is useless */
        return bottom;
    }
    bottom = metrics->height - 0.6 * bottom_margin * metrics->scale;
    for (size_t i = count; i-- > 0;) {
        bottom -= metrics->line[GM_TEXT_LABEL];
        gm_labels_add(list, (struct gm_label){lines[i], GM_TEXT_LABEL, GM_SECONDARY, margin, bottom,
                                              .anchor = GM_ANCHOR_LEFT});
    }
    return bottom - 0.7 * header_gap * metrics->scale;
}

enum { MOST_TOLD = 12 };

/* Places the picture's paragraphs, below everything. Returns where they start. */
static double place_told(struct gm_label_list *list, const struct gm_picture *picture, double margin)
{
    static const double most_share = 0.4;
    const struct gm_metrics *metrics = list->metrics;
    const double line = metrics->line[GM_TEXT_PANEL], width = fmax(0.0, metrics->width - 2.0 * margin);
    const size_t capacity = (size_t)fmin(MOST_TOLD, most_share * metrics->height / line);
    const char *lines[MOST_TOLD];
    const struct gm_paragraph *owners[MOST_TOLD];
    size_t count = 0;
    for (size_t i = 0; i < picture->told_count; i++) {
        const size_t more = gm_labels_wrap(list, GM_TEXT_PANEL, picture->told[i].text, width,
                                           capacity - count, &lines[count]);
        for (size_t k = 0; k < more; k++) {
            owners[count++] = &picture->told[i];
        }
    }
    const size_t kept = picture->told_lines < capacity ? picture->told_lines : capacity;
    const double top =
        metrics->height - bottom_margin * metrics->scale - (double)(count > kept ? count : kept) * line;
    for (size_t i = 0; i < count; i++) {
        gm_labels_add(list, (struct gm_label){lines[i], GM_TEXT_PANEL, owners[i]->role, margin,
                                              top + (double)i * line, .bold = owners[i]->bold});
    }
    return top - header_gap * metrics->scale;
}

/* Gives frames to the panels of a place. Returns their number. */
static size_t collect(const struct gm_picture *picture, enum gm_place place, size_t most,
                      struct gm_axes *axes)
{
    size_t count = 0;
    for (const struct gm_panel *panel = picture->first; panel && count < most; panel = panel->next) {
        if (panel->place == place) {
            axes[count++].panel = panel;
        }
    }
    return count;
}

/* Makes graphs in a row beside a single row of states as high as the states. */
static void align_graphs(const struct gm_label_list *list, const struct group *states, struct group *graphs)
{
    const struct gm_border border = common_border(list, graphs, false);
    const struct gm_box box = states->frames[0].box;
    const double top = fmax(graphs->area.y, box.y - border.top);
    const double bottom = fmin(graphs->area.y + graphs->area.height, box.y + box.height + border.bottom);
    if (box.height < 0.5 * graphs->area.width) {
        return;
    }
    graphs->area.y = top;
    graphs->area.height = bottom - top;
}

/* On a small surface that is not wide, the graph goes below the states if they become larger. The states then
   have below_share of the height. */
static const double below_share = 0.56, narrow_aspect = 1.3, below_gain = 1.1;

static void try_below(struct gm_label_list *list, const struct gm_box *area, struct group *states,
                      struct group *graphs)
{
    const struct gm_metrics *metrics = list->metrics;
    if (!metrics->terse || metrics->width > narrow_aspect * metrics->height) {
        return;
    }
    struct group beside = *states, below = *states, graph = *graphs;
    below.area = graph.area = *area;
    below.area.height *= below_share;
    graph.area.y += below.area.height + row_gap * metrics->scale;
    graph.area.height -= below.area.height + row_gap * metrics->scale;
    const double gain = choose_grid(list, &below, below.count) / choose_grid(list, &beside, beside.count);
    if (below.detail <= beside.detail && gain > below_gain) {
        states->area = below.area;
        graphs->area = graph.area;
    }
}

/* Returns the height that the states need of their area with the current grid; all of it without equal
   axes. */
static double height_needed(const struct gm_label_list *list, const struct group *states)
{
    const double scale = list->metrics->scale;
    const struct gm_border border = common_border(list, states, false);
    const double width = cell_width(states, &border, column_gap * scale) - border.left - border.right;
    double tallest = 0.0;
    for (size_t i = 0; i < states->count; i++) {
        const double aspect = aspect_of(states->frames[i].panel);
        if (aspect == 0.0 || !(width > 0.0)) {
            return states->area.height;
        }
        tallest = fmax(tallest, width / aspect);
    }
    const double needed = (double)states->rows * (tallest + border.top + border.bottom) +
                          (double)(states->rows - 1) * row_gap * scale;
    return fmin(needed, states->area.height);
}

/* Returns the width that the states need of their area with the current grid; all of it without equal
   axes. */
static double width_needed(const struct gm_label_list *list, const struct group *states)
{
    const double scale = list->metrics->scale;
    const struct gm_border border = common_border(list, states, false);
    const double height = cell_height(states, row_gap * scale) - border.top - border.bottom;
    double widest = 0.0;
    for (size_t i = 0; i < states->count; i++) {
        const struct gm_panel *panel = states->frames[i].panel;
        const double aspect = aspect_of(panel);
        if (aspect == 0.0 || expands(panel)) {
            return states->area.width;
        }
        widest = fmax(widest, fmax(0.0, height) * aspect);
        const double title = fmax(gm_labels_width(list, GM_TEXT_PANEL, panel->title),
                                  gm_labels_width(list, GM_TEXT_LABEL, panel->note));
        widest = fmax(widest, title - border.left);
    }
    const double needed = (double)states->columns * (widest + border.left + border.right) + border.bar +
                          (double)(states->columns - 1) * column_gap * scale;
    return fmin(needed, states->area.width);
}

/* Gives flat states the whole width, and the graphs a row under them with the rest of the height. */
static void try_row_below(struct gm_label_list *list, const struct gm_box *area, struct group *states,
                          struct group *graphs)
{
    const double gap = group_gap * list->metrics->scale;
    struct group beside = *states, below = *states;
    below.area = *area;
    below.area.height = fmax(0.0, (1.0 - row_share) * area->height - gap);
    if (area->width > flattest_row * (area->height - below.area.height - gap)) {
        return;
    }
    const double worth_beside = choose_grid(list, &beside, beside.count),
                 worth_below = choose_grid(list, &below, below.count);
    /* space that states leave empty counts */
    const double fill_beside = height_needed(list, &beside) / beside.area.height,
                 fill_below = width_needed(list, &below) / below.area.width;
    if (below.detail <= beside.detail &&
        worth_below * pow(fill_below, fill_power) > worth_beside * pow(fill_beside, fill_power)) {
        below.area.height = height_needed(list, &below);
        states->area = below.area;
        graphs->area = *area;
        graphs->area.y += below.area.height + gap;
        graphs->area.height = fmax(0.0, area->height - below.area.height - gap);
    }
}

/* Gives graphs beside states that are high and narrow the width that is left. */
static void widen_graphs(const struct gm_label_list *list, struct group *states, struct group *graphs)
{
    const double spare = states->area.width - width_needed(list, states);
    states->area.width -= spare;
    graphs->area.x -= spare;
    graphs->area.width += spare;
}

/* Returns the number of graphs of a terse picture: one, or, beside states, as many as have room side by
   side. */
static size_t terse_count(const struct group *graphs, bool beside)
{
    const double narrowest = 1.5, room = graphs->area.width / (narrowest * graphs->area.height);
    if (!beside) {
        return 1;
    }
    return room > 1.0 ? (size_t)fmin(room, (double)graphs->count) : 1;
}

/* Places texts among the marks last. A text that meets another label or the edge of its panel moves a little;
   if that does not help it is left out. */
static void place_notes(struct gm_label_list *list, const struct gm_axes *axes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        for (const struct gm_mark *mark = axes[i].panel->first; mark; mark = mark->next) {
            if (mark->kind == GM_MARK_TEXT) {
                gm_axes_note(list, axes, count, i, mark);
            }
        }
    }
}

/* Returns the greatest number of labels of a picture. */
static size_t most_labels(const struct gm_picture *picture)
{
    size_t most = 8 + MOST_TOLD;
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        most += 4 + GM_TITLE_LINES + 3 * GM_TICK_MAX;
        for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
            most += mark->kind == GM_MARK_TEXT ? 2 : 0;
        }
        for (const struct gm_key *key = panel->first_key; key; key = key->next) {
            most += GM_KEY_LINES;
        }
    }
    return most;
}

static size_t count_panels(const struct gm_picture *picture)
{
    size_t count = 0;
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        count++;
    }
    return count;
}

/* Divides the area between states and graphs: beside each other, or below if that is better for both. */
static void divide(struct gm_label_list *list, const struct gm_box *area, struct group *states,
                   struct group *graphs)
{
    const struct gm_metrics *metrics = list->metrics;
    states->area = graphs->area = *area;
    if (states->count == 0 || graphs->count == 0) {
        return;
    }
    const double gap = margin_of(metrics->width, group_gap * metrics->scale);
    graphs->area.width =
        fmin(area->width, (metrics->terse ? terse_graph_share : graph_share) * metrics->width);
    graphs->area.x = area->x + area->width - graphs->area.width;
    states->area.width = fmax(0.0, area->width - graphs->area.width - gap);
    try_below(list, area, states, graphs);
    if (list->picture->graphs_below) {
        try_row_below(list, area, states, graphs);
    }
}

const struct gm_layout *gm_layout_make(struct gm_picture *picture, const struct gm_metrics *metrics)
{
    const size_t panel_count = count_panels(picture);
    struct gm_label_list list;
    struct gm_layout *layout = gm_picture_memory(picture, sizeof *layout);
    struct gm_axes *axes = gm_picture_memory(picture, (panel_count + 1) * sizeof *axes);
    if (!layout || !axes || !gm_labels_open(&list, picture, metrics, most_labels(picture))) {
        return NULL;
    }

    const double margin = margin_of(metrics->width, side_margin * metrics->scale);
    const double top = place_header(&list, picture, margin);
    const double bottom =
        picture->told_count > 0 ? place_told(&list, picture, margin) : place_caption(&list, picture, margin);

    struct group states = {.frames = axes, .place = GM_PLACE_STATE, .wanted = picture->state_columns};
    states.count = collect(picture, GM_PLACE_STATE, panel_count, axes);
    struct group graphs = {.frames = axes + states.count, .place = GM_PLACE_GRAPH};
    graphs.count = collect(picture, GM_PLACE_GRAPH, panel_count, graphs.frames);

    const struct gm_box area = {margin, top, fmax(0.0, metrics->width - 2.0 * margin),
                                fmax(0.0, bottom - top)};
    divide(&list, &area, &states, &graphs);
    const bool beside = states.count > 0 && graphs.area.x > area.x;
    if (states.count > 0) {
        choose_grid(&list, &states, states.count);
        if (beside && graphs.count > 0) {
            widen_graphs(&list, &states, &graphs);
        }
        place_group(&list, &states, graphs.count > 0 ? 0.0 : margin,
                    beside && graphs.count > 0 && states.columns == 1);
    }
    if (graphs.count > 0) {
        graphs.count = metrics->terse ? terse_count(&graphs, beside) : graphs.count;
        choose_grid(&list, &graphs, graphs.count);
        if (states.rows == 1 && graphs.rows == 1 && beside) {
            align_graphs(&list, &states, &graphs);
        }
        place_group(&list, &graphs, margin, false);
    }
    const size_t frame_count = states.count + graphs.count;
    place_notes(&list, axes, frame_count);
    *layout = (struct gm_layout){
        .frames = axes, .frame_count = frame_count, .labels = list.labels, .label_count = list.count};
    return layout;
}

struct gm_spot gm_layout_locate(const struct gm_layout *layout, double across, double down)
{
    for (size_t i = 0; layout && i < layout->frame_count; i++) {
        const struct gm_axes *axes = &layout->frames[i];
        const struct gm_box *box = &axes->box;
        if (axes->panel->place == GM_PLACE_STATE && across >= box->x && across <= box->x + box->width &&
            down >= box->y && down <= box->y + box->height && axes->panel->x.scale != GM_LOG &&
            axes->panel->y.scale != GM_LOG) {
            return (struct gm_spot){axes->panel, (across - axes->x_origin) / axes->x_factor,
                                    (down - axes->y_origin) / axes->y_factor};
        }
    }
    return (struct gm_spot){NULL, 0.0, 0.0};
}
