/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The terminal painter: a picture to character cells. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/cells/grid.h"
#include "render/cells/text.h"
#include "render/layout/panel.h"

/* ---- sub-pixels as characters: half blocks, quadrants, braille and ASCII ---- */

enum { PARTS = 8 }; /* the most sub-pixels per cell, stored row by row */

struct block {
    struct gm_subpixel part[PARTS];
    int count;
};

static bool same(struct gm_rgb a, struct gm_rgb b)
{
    return a.r == b.r && a.g == b.g && a.b == b.b;
}

/* The mean colour of the parts in a set (bit i is part i). */
static struct gm_rgb mean(const struct block *block, unsigned set)
{
    int r = 0, g = 0, b = 0, n = 0;
    for (int i = 0; i < block->count; i++) {
        if (set >> i & 1) {
            r += block->part[i].colour.r;
            g += block->part[i].colour.g;
            b += block->part[i].colour.b;
            n++;
        }
    }
    if (n == 0) {
        return (struct gm_rgb){0, 0, 0};
    }
    return (struct gm_rgb){(uint8_t)((r + n / 2) / n), (uint8_t)((g + n / 2) / n),
                           (uint8_t)((b + n / 2) / n)};
}

static unsigned parts_of_level(const struct block *block, int level)
{
    unsigned set = 0;
    for (int i = 0; i < block->count; i++) {
        if (block->part[i].level == level) {
            set |= 1u << i;
        }
    }
    return set;
}

/* Returns the role of most parts of a set; on a tie the later one. */
static enum gm_role chief_role(const struct block *block, unsigned set)
{
    int votes[GM_ROLE_COUNT] = {0};
    int best = GM_INK;
    for (int i = 0; i < block->count; i++) {
        if (set >> i & 1 && ++votes[block->part[i].role] >= votes[best]) {
            best = block->part[i].role;
        }
    }
    return (enum gm_role)best;
}

/* The parts of a cell that a glyph with one colour shows: lines before areas, areas before the grid. */
struct stencil {
    unsigned inked;  /* the parts that are drawn */
    unsigned colour; /* the drawn parts that give the colour */
    unsigned ground; /* the parts of fields and fills */
    bool lines;      /* the drawn parts are lines or points */
    enum gm_role role;
};

static struct stencil stencil_of(const struct block *block)
{
    struct stencil stencil = {.role = GM_INK};
    unsigned lines = parts_of_level(block, GM_LEVEL_LINE) | parts_of_level(block, GM_LEVEL_OVER);
    stencil.ground = parts_of_level(block, GM_LEVEL_FIELD) | parts_of_level(block, GM_LEVEL_FILL);
    stencil.lines = lines != 0;
    stencil.inked = lines ? lines : stencil.ground ? stencil.ground : parts_of_level(block, GM_LEVEL_GRID);
    if (stencil.inked) {
        stencil.role = chief_role(block, stencil.inked);
        for (int i = 0; i < block->count; i++) {
            const bool shown = stencil.inked >> i & 1 && block->part[i].role == stencil.role;
            stencil.colour |= (unsigned)shown << i;
        }
    }
    return stencil;
}

/* Braille's dot of part i: the first three rows are numbered down the columns, the fourth came later. */
static const uint8_t braille_dots[PARTS] = {0x01, 0x08, 0x02, 0x10, 0x04, 0x20, 0x40, 0x80};

const uint16_t gm_quadrants[16] = {' ',    0x2598, 0x259D, 0x2580, 0x2596, 0x258C, 0x259E, 0x259B,
                                   0x2597, 0x259A, 0x2590, 0x259C, 0x2584, 0x2599, 0x259F, 0x2588};

/* Fits two colours to two or four parts: of all divisions the one with the least error. */
static void fit_two(const struct block *block, struct gm_rgb paper, struct gm_cell *cell)
{
    unsigned all = (1u << block->count) - 1, best = all;
    long least = -1;
    for (unsigned set = all; set > all / 2; set--) { /* each division once: the last part is always in set */
        struct gm_rgb one = mean(block, set), other = mean(block, all & ~set);
        long off = 0;
        for (int i = 0; i < block->count; i++) {
            off += gm_rgb_distance(block->part[i].colour, set >> i & 1 ? one : other);
        }
        if (least < 0 || off < least) {
            least = off;
            best = set;
        }
    }
    struct gm_rgb one = mean(block, best), other = mean(block, all & ~best);
    /* The set nearer to the paper is the background: a blank cell is a space, and a terminal with few colours
       still shows the ink. */
    if (best != all && gm_rgb_distance(one, paper) < gm_rgb_distance(other, paper)) {
        best = all & ~best;
        one = mean(block, best);
        other = mean(block, all & ~best);
    }
    bool blank = best == all && same(one, paper);
    unsigned high = 0;
    for (int i = 0; i < block->count; i++) {
        if (best >> i & 1 && block->part[i].level > high) {
            high = block->part[i].level;
        }
    }
    unsigned chief = parts_of_level(block, (int)high) & best;
    cell->role = blank || high == GM_LEVEL_PAPER ? GM_INK : chief_role(block, chief);
    cell->foreground = blank ? gm_theme_colour(GM_THEME_DARK, GM_INK) : one;
    cell->background = best == all ? paper : other;
    if (blank) {
        cell->glyph = ' ';
    } else if (block->count == 4) {
        cell->glyph = gm_quadrants[best];
    } else {
        cell->glyph = best == 3 ? 0x2588 : best == 1 ? 0x2580 : 0x2584;
    }
}

/* Paints lines as dots of one colour, and areas in quarters. An area beneath a line becomes the
   background. */
static void braille(const struct block *block, const struct block *area, struct gm_rgb paper,
                    struct gm_cell *cell)
{
    struct stencil stencil = stencil_of(block);
    bool over = parts_of_level(block, GM_LEVEL_OVER) != 0;
    if (!over && (stencil.ground || parts_of_level(area, GM_LEVEL_FILL))) {
        fit_two(area, paper, cell);
        return;
    }
    if (!stencil.inked) {
        return;
    }
    if (2 * __builtin_popcount(stencil.ground) >= block->count - __builtin_popcount(stencil.inked) &&
        stencil.ground) {
        cell->background = mean(block, stencil.ground);
    }
    uint32_t dots = 0;
    for (int i = 0; i < PARTS; i++) {
        if (stencil.inked >> i & 1) {
            dots |= braille_dots[i];
        }
    }
    cell->glyph = 0x2800 + dots;
    cell->foreground = mean(block, stencil.colour);
    cell->role = stencil.role;
}

/* Returns the letter whose ink is nearest to the line, from the line's rows and slope. */
static uint32_t ascii_line(unsigned set)
{
    int left = 0, right = 0, left_rows = 0, right_rows = 0, rows = 0, low = 3, high = 0;
    for (int row = 0; row < 4; row++) {
        unsigned pair = set >> (2 * row) & 3;
        if (pair) {
            rows++;
            low = row < low ? row : low;
            high = row > high ? row : high;
        }
        if (pair & 1) {
            left++;
            left_rows += row;
        }
        if (pair & 2) {
            right++;
            right_rows += row;
        }
    }
    if (left + right >= 6) {
        return '#';
    }
    if (left + right == 1) {
        return high == 0 ? '\'' : '.';
    }
    if (left == 0 || right == 0 || (rows >= 3 && left_rows * right == right_rows * left)) {
        return rows >= 3 ? '|' : high <= 1 ? '\'' : low >= 2 ? '.' : ':';
    }
    int slope = left_rows * right - right_rows * left; /* above 0: the left end is lower */
    if (rows >= 3 || (rows == 2 && abs(slope) > left * right)) {
        return slope > 0 ? '/' : slope < 0 ? '\\' : '*';
    }
    return high == 0 ? '"' : high <= 2 ? '-' : '_';
}

static void ascii(const struct block *block, struct gm_rgb paper, struct gm_rgb ink, struct gm_cell *cell)
{
    struct stencil stencil = stencil_of(block);
    if (!stencil.inked) {
        return;
    }
    if (stencil.lines) {
        cell->glyph = ascii_line(stencil.inked);
    } else if (!stencil.ground) {
        int covered = __builtin_popcount(stencil.inked);
        cell->glyph = covered >= 4 ? '|' : covered >= 2 ? '-' : '.';
    } else {
        /* more coverage and more contrast give a darker glyph */
        static const char ramp[] = " .:-+*#@";
        long strength = 0, full = gm_rgb_distance(ink, paper);
        for (int i = 0; i < PARTS; i++) {
            if (stencil.ground >> i & 1) {
                strength += gm_rgb_distance(block->part[i].colour, paper);
            }
        }
        int step = (int)(strength * 14 / (full * PARTS));
        cell->glyph = (uint32_t)ramp[step < 1 ? 1 : step > 7 ? 7 : step];
    }
    cell->foreground = mean(block, stencil.colour);
    cell->role = stencil.role;
}

/* Reads a cell's parts, `across` per row. Returns true if one is not blank. */
static bool take_block(struct block *block, const struct gm_raster *raster, int across, int column, int row)
{
    const struct gm_rgb paper = gm_theme_colour(raster->theme, GM_PAPER);
    const int down = block->count / across;
    bool drawn = false;
    for (int i = 0; i < block->count; i++) {
        size_t y = (size_t)(row * down + i / across), x = (size_t)(column * across + i % across);
        block->part[i] = raster->at[y * (size_t)raster->width + x];
        drawn = drawn || block->part[i].level || !same(block->part[i].colour, paper);
    }
    return drawn;
}

/* Turns the raster into glyphs with two colours each. Braille draws lines well and areas badly, so it takes
   areas from a second raster, made for GM_QUADRANTS; NULL for other blocks. */
static void draw_blocks(struct gm_cells *cells, const struct gm_raster *raster, const struct gm_raster *areas,
                        enum gm_blocks blocks)
{
    struct gm_rgb paper = gm_theme_colour(raster->theme, GM_PAPER),
                  ink = gm_theme_colour(raster->theme, GM_INK);
    const int across = raster->width / cells->columns, down = raster->height / cells->rows;
    for (int row = 0; row < cells->rows; row++) {
        for (int column = 0; column < cells->columns; column++) {
            struct block block = {.count = across * down}, area = {.count = 4};
            bool drawn = take_block(&block, raster, across, column, row);
            if (areas) {
                drawn |= take_block(&area, areas, 2, column, row);
            }
            struct gm_cell *cell = &cells->cells[(size_t)row * (size_t)cells->columns + (size_t)column];
            *cell = (struct gm_cell){.glyph = ' ', .foreground = ink, .background = paper, .role = GM_INK};
            if (!drawn) {
                continue;
            }
            if (blocks == GM_BRAILLE) {
                braille(&block, &area, paper, cell);
            } else if (blocks == GM_ASCII) {
                ascii(&block, paper, ink, cell);
            } else {
                fit_two(&block, paper, cell);
            }
            if (cell->glyph == ' ') {
                cell->foreground = ink;
            }
        }
    }
}

/* ---- the painter ---- */

/* A cell on the layout's surface: twice as high as wide, like the cells of nearly every font, and divisible
   by the sub-pixels of every kind of block. */
enum { CELL_WIDTH = 8, CELL_HEIGHT = 16 };

/* A smaller screen has room for the states and one graph. */
enum { ROOMY_COLUMNS = 72, ROOMY_ROWS = 27 };

static double measure(const void *self, enum gm_text_size size, const char *text)
{
    (void)size;
    return CELL_WIDTH * gm_text_width(text, *(const bool *)self);
}

struct painter {
    struct gm_cells *cells;
    enum gm_theme theme;
    bool ascii;
    bool *taken; /* cells that hold text */
};

static bool is_free(const struct painter *painter, int column, int row, int width)
{
    if (row < 0 || row >= painter->cells->rows || column < 0 || column + width > painter->cells->columns) {
        return false;
    }
    /* a cell of air on both sides */
    for (int i = column - 1; i <= column + width; i++) {
        if (i >= 0 && i < painter->cells->columns &&
            painter->taken[(size_t)row * (size_t)painter->cells->columns + (size_t)i]) {
            return false;
        }
    }
    return true;
}

/* Writes a label. Texts move by up to half a cell to whole cells. A label that no longer fits is left out,
   although the layout had room for it. */
static void paint_text(struct painter *painter, const struct gm_label *label, int row)
{
    int width = gm_text_width(label->text, painter->ascii);
    double left = label->x / CELL_WIDTH - gm_anchor_share(label->anchor) * width;
    if (!(fabs(left) < 1e6) || width == 0) {
        return;
    }
    int column = (int)floor(left + 0.5);
    if (column + width > painter->cells->columns && column + width <= painter->cells->columns + 2) {
        column = painter->cells->columns - width;
    }
    if (column < 0 && column >= -2) {
        column = 0;
    }
    if (!is_free(painter, column, row, width)) {
        return;
    }
    size_t first = (size_t)row * (size_t)painter->cells->columns + (size_t)column;
    for (size_t i = first; i < first + (size_t)width; i++) {
        painter->taken[i] = true;
        if (!label->among_marks) {
            painter->cells->cells[i].background = gm_theme_colour(painter->theme, GM_PAPER);
        }
    }
    const struct gm_text_look look = {painter->theme, label->role, label->bold, painter->ascii};
    gm_cells_text(painter->cells, column, row, -1, label->text, &look);
}

/* A cell on the screen; NULL beyond its edges. */
static struct gm_cell *cell_at(const struct gm_cells *cells, int column, int row)
{
    return column >= 0 && row >= 0 && column < cells->columns && row < cells->rows
               ? &cells->cells[(size_t)row * (size_t)cells->columns + (size_t)column]
               : NULL;
}

/* Draws the grid and the axes as rules from (x0, y0) to (x1, y1). */
static void paint_rules(const struct gm_axes *axes,
                        void (*rule)(void *self, const double from_to[4], bool axis), void *self)
{
    const struct gm_box *box = &axes->box;
    const double right = box->x + box->width, bottom = box->y + box->height;
    for (size_t i = 0; i < axes->x_tick_count; i++) {
        const double x = axes->x_ticks[i].position;
        rule(self, (const double[]){x, box->y, x, bottom}, false);
    }
    for (size_t i = 0; i < axes->y_tick_count; i++) {
        const double y = axes->y_ticks[i].position;
        rule(self, (const double[]){box->x, y, right, y}, false);
    }
    rule(self, (const double[]){box->x, bottom, right, bottom}, true);
    rule(self, (const double[]){box->x, box->y, box->x, bottom}, true);
}

/* Draws a rule as dots of the raster, beneath the marks; the dots must be as fine as a hairline. */
static void dotted_rule(void *raster, const double from_to[4], bool axis)
{
    gm_marks_rule(raster, from_to, axis ? GM_SECONDARY : GM_GRID, axis ? 1 : 2);
}

/* The arms of characters for grid and axes, in cells that the marks left blank: thinner than any block. */
enum { RULE_LEFT = 1, RULE_RIGHT = 2, RULE_UP = 4, RULE_DOWN = 8 };

static void rule_cell(const struct painter *painter, int column, int row, unsigned arms, enum gm_role role)
{
    static const uint16_t drawn[16] = {[3] = 0x2500, [12] = 0x2502, [15] = 0x253C, [6] = 0x2514};
    struct gm_cell *cell = cell_at(painter->cells, column, row);
    if (!cell) {
        return;
    }
    bool crosses = cell->role == GM_GRID && cell->glyph != ' ' && role == GM_GRID;
    if (cell->glyph != ' ' && cell->role != GM_GRID) {
        return;
    }
    if (painter->ascii) {
        cell->glyph = role == GM_GRID ? (arms == 3 ? '.' : ':') : arms == 3 ? '-' : arms == 12 ? '|' : '+';
    } else {
        cell->glyph = crosses ? drawn[15] : drawn[arms];
    }
    cell->role = role;
    cell->foreground = gm_theme_colour(painter->theme, role);
}

static int cell_of(double position, int size)
{
    return (int)floor(position / size);
}

static void thin_rule(void *painter, const double from_to[4], bool axis)
{
    const int left = cell_of(from_to[0], CELL_WIDTH), right = cell_of(from_to[2], CELL_WIDTH);
    const int top = cell_of(from_to[1], CELL_HEIGHT), bottom = cell_of(from_to[3], CELL_HEIGHT);
    const unsigned arms = from_to[1] == from_to[3] ? RULE_LEFT | RULE_RIGHT : RULE_UP | RULE_DOWN;
    for (int row = top; row <= bottom; row++) {
        for (int column = left; column <= right; column++) {
            rule_cell(painter, column, row, arms, axis ? GM_SECONDARY : GM_GRID);
        }
    }
}

static void paint_thin_grid(struct painter *painter, const struct gm_axes *axes)
{
    const struct gm_box *box = &axes->box;
    paint_rules(axes, thin_rule, painter);
    struct gm_cell *corner =
        cell_at(painter->cells, cell_of(box->x, CELL_WIDTH), cell_of(box->y + box->height, CELL_HEIGHT));
    if (corner && corner->role == GM_SECONDARY) {
        corner->glyph = painter->ascii ? '+' : 0x2514;
    }
}

/* Draws the tips of a colour bar, in the cells of its ends, if values lie beyond them. */
static void paint_tips(const struct painter *painter, const struct gm_axes *axes)
{
    static const uint32_t glyphs[2] = {0x25BC, 0x25B2}, letters[2] = {'v', '^'};
    const struct gm_mark *field = gm_panel_field(axes->panel);
    const struct gm_box *bar = &axes->colour_bar;
    const double places[2] = {bar->y + bar->height + 0.5 * axes->bar_tip[0], bar->y - 0.5 * axes->bar_tip[1]};
    for (int end = 0; end < 2; end++) {
        const int row = cell_of(places[end], CELL_HEIGHT);
        for (int column = cell_of(bar->x, CELL_WIDTH);
             field && axes->bar_tip[end] > 0 && column * CELL_WIDTH < bar->x + bar->width; column++) {
            struct gm_cell *cell = cell_at(painter->cells, column, row);
            if (!cell) {
                break;
            }
            *cell = (struct gm_cell){.glyph = painter->ascii ? letters[end] : glyphs[end],
                                     .foreground = gm_colour_map_at(field->map, painter->theme, end),
                                     .background = gm_theme_colour(painter->theme, GM_PAPER),
                                     .role = GM_INK};
        }
    }
}

/* Returns true if a line goes around the polygon before it. */
static bool is_outline(const struct gm_mark *before, const struct gm_mark *mark)
{
    return before && before->kind == GM_MARK_POLYGON && mark->kind == GM_MARK_LINE && mark->closed &&
           mark->count == before->count && mark->style.role == before->style.role;
}

/* The marks that a raster takes. */
struct taking {
    bool grid;     /* the grid is dotted, beneath the marks */
    bool areas;    /* areas with their outlines */
    bool outlines; /* shapes with an outline are not filled */
    bool only;     /* panels without a filled shape are left out */
};

static bool is_filled(const struct gm_panel *panel)
{
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        if (mark->kind == GM_MARK_POLYGON) {
            return true;
        }
    }
    return gm_panel_field(panel) != NULL;
}

static bool paint_marks(struct gm_raster *raster, const struct gm_layout *layout, struct taking taking)
{
    bool ok = true;
    for (size_t i = 0; i < layout->frame_count; i++) {
        const struct gm_axes *axes = &layout->frames[i];
        const struct gm_mark *before = NULL;
        if (taking.only && !is_filled(axes->panel)) {
            continue;
        }
        if (axes->panel->axes && taking.grid) {
            paint_rules(axes, dotted_rule, raster);
        }
        for (const struct gm_mark *mark = axes->panel->first; ok && mark; before = mark, mark = mark->next) {
            if (!taking.outlines || !mark->next || !is_outline(mark, mark->next)) {
                ok = gm_marks_draw(raster, axes, mark, taking.areas && is_outline(before, mark));
            }
        }
        const struct gm_mark *field = gm_panel_field(axes->panel);
        if (axes->colour_bar.width > 0 && field) {
            gm_marks_bar(raster, &axes->colour_bar, field->map);
        }
    }
    return ok;
}

static int row_of(double y)
{
    return fabs(y) < 1e6 ? (int)floor(y / CELL_HEIGHT) : -1;
}

/* Returns the row of a label. Labels above a panel's data move up and labels below move down, so that the
   first and last row of the data stay free; labels beside it go where most of their height is. */
static int label_row(const struct painter *painter, const struct gm_layout *layout,
                     const struct gm_label *label)
{
    double width = CELL_WIDTH * gm_text_width(label->text, painter->ascii);
    double left = label->x - gm_anchor_share(label->anchor) * width;
    int row = row_of(label->y + 0.5 * CELL_HEIGHT);
    for (size_t i = 0; i < layout->frame_count && label->size != GM_TEXT_TITLE; i++) {
        const struct gm_box *box = &layout->frames[i].box;
        if (left + width < box->x || left > box->x + box->width) {
            continue;
        }
        if (label->y + CELL_HEIGHT <= box->y + 0.5 && label->y + 4 * CELL_HEIGHT > box->y) {
            return row_of(box->y) - 1 - row_of(box->y - label->y - CELL_HEIGHT + 0.5);
        }
        if (label->y >= box->y + box->height - 0.5 && label->y < box->y + box->height + 3 * CELL_HEIGHT) {
            row = row_of(label->y + CELL_HEIGHT - 1);
        }
    }
    return row == painter->cells->rows ? row - 1 : row;
}

static void paint_texts(struct painter *painter, const struct gm_layout *layout)
{
    for (size_t i = 0; i < layout->label_count; i++) {
        const struct gm_label *label = &layout->labels[i];
        const int row =
            label->among_marks ? row_of(label->y + 0.5 * CELL_HEIGHT) : label_row(painter, layout, label);
        /* a terminal does not turn letters; the panel's title names the axis */
        if (!label->vertical) {
            paint_text(painter, label, row);
        }
    }
}

static bool open_raster(struct gm_raster *raster, const struct gm_cells *cells, enum gm_theme theme,
                        enum gm_blocks blocks, double scale)
{
    const bool sharp = blocks == GM_BRAILLE || blocks == GM_ASCII;
    const int across = blocks == GM_HALF_BLOCKS ? 1 : 2, down = sharp ? 4 : 2;
    *raster = (struct gm_raster){.width = cells->columns * across,
                                 .height = cells->rows * down,
                                 .unit_x = (double)CELL_WIDTH / across,
                                 .unit_y = (double)CELL_HEIGHT / down,
                                 .scale = scale,
                                 .sharp = sharp,
                                 .theme = theme};
    return gm_raster_open(raster);
}

/* Paints the marks; false when out of memory. */
static bool paint_blocks(struct gm_cells *cells, const struct gm_layout *layout, enum gm_theme theme,
                         enum gm_blocks blocks, double scale)
{
    struct gm_raster raster = {0}, areas = {0};
    bool dots = blocks == GM_BRAILLE, two = dots && !cells->outlines;
    const struct taking taking = {.grid = dots, .areas = two, .outlines = dots && cells->outlines};
    bool ok = open_raster(&raster, cells, theme, blocks, scale) &&
              (!two || open_raster(&areas, cells, theme, GM_QUADRANTS, scale));
    if (ok) {
        ok = paint_marks(&raster, layout, taking) &&
             (!two || paint_marks(&areas, layout, (struct taking){.areas = true, .only = true}));
        draw_blocks(cells, &raster, two ? &areas : NULL, blocks);
    }
    gm_raster_close(&raster);
    gm_raster_close(&areas);
    return ok;
}

static struct gm_metrics metrics_of(const struct gm_cells *cells, const bool *ascii)
{
    struct gm_metrics metrics = {.width = (double)cells->columns * CELL_WIDTH,
                                 .height = (double)cells->rows * CELL_HEIGHT,
                                 .measure = measure,
                                 .self = ascii,
                                 .terse = cells->columns < ROOMY_COLUMNS || cells->rows < ROOMY_ROWS};
    metrics.scale = metrics.height / 720;
    for (int size = 0; size < GM_TEXT_SIZE_COUNT; size++) {
        metrics.line[size] = CELL_HEIGHT;
    }
    return metrics;
}

bool gm_cells_paint(struct gm_cells *cells, struct gm_picture *picture, enum gm_theme theme,
                    enum gm_blocks blocks)
{
    bool ascii = blocks == GM_ASCII;
    struct gm_metrics metrics = metrics_of(cells, &ascii);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    struct painter painter = {.cells = cells, .theme = theme, .ascii = ascii};
    painter.taken = calloc((size_t)cells->columns * (size_t)cells->rows, sizeof *painter.taken);
    bool ok = layout && painter.taken && paint_blocks(cells, layout, theme, blocks, metrics.scale);
    for (size_t i = 0; ok && blocks != GM_BRAILLE && i < layout->frame_count; i++) {
        if (layout->frames[i].panel->axes) {
            paint_thin_grid(&painter, &layout->frames[i]);
        }
    }
    for (size_t i = 0; ok && i < layout->frame_count; i++) {
        paint_tips(&painter, &layout->frames[i]);
    }
    if (ok) {
        paint_texts(&painter, layout);
    }
    free(painter.taken);
    return ok;
}

struct gm_spot gm_cells_locate(const struct gm_cells *cells, struct gm_picture *picture,
                               enum gm_blocks blocks, int column, int row)
{
    bool ascii = blocks == GM_ASCII;
    struct gm_metrics metrics = metrics_of(cells, &ascii);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    return gm_layout_locate(layout, (column + 0.5) * CELL_WIDTH, (row + 0.5) * CELL_HEIGHT);
}
