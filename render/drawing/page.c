/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page: its grids, axes and colour bars, whose rules begin and end on whole pixels, its labels, the sizes of letters
   and strokes, and the order of drawing. */
#include "render/drawing/pen.h"

#include <math.h>
#include <string.h>

#include "render/cells/text.h"

/* ---- the cells of a terminal ---- */

/* The cells of a terminal as a picture: braille, blocks and rules are shapes, so that they join without gaps
   in every font; letters are texts, placed word by word. */

enum { LETTERS = 15, WORD = 256 }; /* the em of a letter, in pixels; the most bytes of a word */
static const float dot = 3.2f;     /* the width of a braille dot, in pixels; two have a distance of 4.5 */

static bool same(struct gm_rgb a, struct gm_rgb b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* Draws a part of a cell, given as fractions of its sides. */
static void cell_box(struct gm_painter *painter, int column, int row, const double part[4], struct gm_ink ink)
{
    const double x = column * GM_CELL_WIDTH, y = row * GM_CELL_HEIGHT;
    painter->pen->box(painter->self, (float)round(x + part[0] * GM_CELL_WIDTH),
                      (float)round(y + part[1] * GM_CELL_HEIGHT), (float)round(x + part[2] * GM_CELL_WIDTH),
                      (float)round(y + part[3] * GM_CELL_HEIGHT), ink);
}

/* Returns the quarters of a block, or 0 for other glyphs. */
static unsigned quarters_of(uint32_t glyph)
{
    unsigned set = 15;
    while (set > 0 && gm_quadrants[set] != glyph) {
        set--;
    }
    return set;
}

static void draw_dots(struct gm_painter *painter, int column, int row, uint32_t dots, struct gm_ink ink)
{
    static const unsigned char places[8] = {0, 2, 4, 1, 3, 5, 6, 7}; /* of a bit: column + 2 row */
    for (int bit = 0; bit < 8; bit++) {
        if (dots >> bit & 1) {
            const struct gm_point centre = {
                (float)(GM_CELL_WIDTH * (column + 0.25 + 0.5 * (places[bit] % 2))),
                (float)(GM_CELL_HEIGHT * (row + 0.125 + 0.25 * (places[bit] / 2)))};
            painter->pen->disc(painter->self, centre, dot, ink);
        }
    }
}

/* Draws a rule of a cell: along, down, or both above a T turned over. */
static void draw_rule(struct gm_painter *painter, int column, int row, uint32_t glyph, struct gm_ink ink)
{
    const double thin_x = 1.0 / GM_CELL_WIDTH, thin_y = 1.0 / GM_CELL_HEIGHT;
    const double along[4] = {0, 0.5 - (glyph == 0x2501) * thin_y, 1, 0.5 + (1 + (glyph == 0x2501)) * thin_y};
    const double down[4] = {0.45, 0, 0.45 + thin_x, glyph == 0x2502 ? 1 : 0.5};
    if (glyph != 0x2502) {
        cell_box(painter, column, row, along, ink);
    }
    if (glyph == 0x2502 || glyph == 0x2534) {
        cell_box(painter, column, row, down, ink);
    }
}

static bool is_rule(uint32_t glyph)
{
    return glyph == 0x2500 || glyph == 0x2501 || glyph == 0x2502 || glyph == 0x2534;
}

static bool is_letter(uint32_t glyph)
{
    const bool blank = glyph == ' ' || glyph == 0;
    const bool braille = glyph >= 0x2800 && glyph < 0x2900;
    const bool eighths = glyph > 0x2580 && glyph < 0x2588;
    return !blank && !braille && !eighths && quarters_of(glyph) == 0 && !is_rule(glyph);
}

static void draw_shape(struct gm_painter *painter, int column, int row, const struct gm_cell *cell)
{
    const struct gm_ink ink = {cell->foreground, 1.0};
    const uint32_t glyph = cell->glyph;
    const unsigned parts = quarters_of(glyph);
    if (glyph > 0x2800 && glyph < 0x2900) {
        draw_dots(painter, column, row, glyph - 0x2800, ink);
    } else if (parts) {
        for (int i = 0; i < 4; i++) {
            const double x = 0.5 * (i % 2), y = 0.5 * (i / 2);
            if (parts >> i & 1) {
                cell_box(painter, column, row, (const double[]){x, y, x + 0.5, y + 0.5}, ink);
            }
        }
    } else if (glyph > 0x2580 && glyph < 0x2588) {
        cell_box(painter, column, row, (const double[]){0, 1 - (glyph - 0x2580) / 8.0, 1, 1}, ink);
    } else if (is_rule(glyph)) {
        draw_rule(painter, column, row, glyph, ink);
    }
}

/* Draws the word that starts at a letter; returns its number of cells. */
static int draw_word(struct gm_painter *painter, int column, int row, const struct gm_cell *cells, int most)
{
    const double ascent = gm_glyphs_ascent(painter->glyphs, GM_FONT_MONO, LETTERS),
                 descent = gm_glyphs_descent(painter->glyphs, GM_FONT_MONO, LETTERS);
    char text[WORD];
    size_t length = 0;
    int count = 0;
    while (count < most && is_letter(cells[count].glyph) && cells[count].bold == cells->bold &&
           same(cells[count].foreground, cells->foreground) && length + GM_TEXT_BYTES < sizeof text) {
        length += gm_text_put(cells[count++].glyph, text + length);
    }
    text[length] = '\0';
    const struct gm_writing writing = {
        .font = cells->bold ? GM_FONT_MONO_BOLD : GM_FONT_MONO,
        .letters = LETTERS,
        .x = column * GM_CELL_WIDTH,
        .y = round((row + 0.5) * GM_CELL_HEIGHT + 0.5 * (ascent - descent)),
        .width = count * GM_CELL_WIDTH,
        .anchor = GM_ANCHOR_LEFT,
        .ink = {cells->foreground, 1.0},
    };
    painter->pen->text(painter->self, &writing, text);
    return count;
}

/* Draws the grounds of a row that are not paper. */
static void draw_grounds(struct gm_painter *painter, int row, const struct gm_cell *cells, int columns)
{
    const struct gm_rgb paper = gm_theme_colour(painter->look.theme, GM_PAPER);
    for (int i = 0; i < columns; i++) {
        if (!same(cells[i].background, paper)) {
            cell_box(painter, i, row, (const double[]){0, 0, 1, 1},
                     (struct gm_ink){cells[i].background, 1.0});
        }
    }
}

static void paint_cells(struct gm_painter *painter, const struct gm_cells *cells)
{
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    for (int row = 0; row < cells->rows; row++) {
        const struct gm_cell *line = &cells->cells[(size_t)row * (size_t)cells->columns];
        draw_grounds(painter, row, line, cells->columns);
        for (int column = 0; column < cells->columns;) {
            if (is_letter(line[column].glyph)) {
                column += draw_word(painter, column, row, &line[column], cells->columns - column);
            } else {
                draw_shape(painter, column, row, &line[column]);
                column++;
            }
        }
    }
}

/* ---- marks: lines, points and polygons in pixels; the pen draws marks with values ---- */

/* A tenth of a pixel is not visible. */
static const float tolerance = 0.1f;

/* Lines are cut this far outside of their panel, in pixels, to hide their ends. */
static const float cut = 16.0f;

/* Lengths drawn and left out, in widths of the line. */
static const struct {
    size_t parts;
    float lengths[GM_DASH_PARTS];
} dashes[GM_DASH_COUNT] = {
    [GM_SOLID] = {0, {0}},
    [GM_LONG_DASH] = {2, {6.0f, 3.5f}},
    [GM_DOTS] = {2, {0.0f, 2.4f}},
    [GM_DASH_DOT] = {4, {5.0f, 2.6f, 0.0f, 2.6f}},
    [GM_SHORT_DASH] = {2, {1.8f, 2.8f}},
    [GM_DASH_DOT_DOT] = {6, {4.0f, 2.5f, 0.0f, 2.5f, 0.0f, 2.5f}},
};

/* Clips marks to a box and half a mark's width, so that strokes along the edge stay whole. */
static void clip_to(struct gm_painter *painter, const struct gm_box *box, double margin)
{
    const int left = (int)floor(box->x - margin), top = (int)floor(box->y - margin);
    painter->pen->clip(painter->self, left, top, (int)ceil(box->x + box->width + margin) - left,
                       (int)ceil(box->y + box->height + margin) - top);
}

/* Maps the mark's points to the surface. Returns false when out of memory. */
static bool project(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    struct gm_polyline *line = &painter->line;
    if (!gm_polyline_reserve(line, mark->count)) {
        return false;
    }
    const bool linear = axes->panel->x.scale != GM_LOG && axes->panel->y.scale != GM_LOG;
    const double far = 1e7; /* floats still resolve pixels here */
    for (size_t i = 0; i < mark->count; i++) {
        const double *p = mark->points + 2 * i;
        const double x = linear ? axes->x_origin + axes->x_factor * p[0] : gm_axes_x(axes, p[0]);
        const double y = linear ? axes->y_origin + axes->y_factor * p[1] : gm_axes_y(axes, p[1]);
        line->points[i] = (struct gm_point){(float)(x > far    ? far
                                                    : x < -far ? -far
                                                               : x),
                                            (float)(y > far    ? far
                                                    : y < -far ? -far
                                                               : y)};
    }
    line->count = mark->count;
    line->closed = mark->closed && mark->count > 2;
    return true;
}

static struct gm_ink ink_of(const struct gm_painter *painter, const struct gm_style *style)
{
    return (struct gm_ink){gm_theme_colour(painter->look.theme, style->role), style->alpha};
}

static float stroke_width(const struct gm_painter *painter, const struct gm_style *style)
{
    return (float)(style->width * painter->scale);
}

static struct gm_bounds bounds_of(const struct gm_axes *axes, float margin)
{
    const struct gm_box *box = &axes->box;
    return (struct gm_bounds){(float)box->x - margin, (float)box->y - margin,
                              (float)(box->x + box->width) + margin, (float)(box->y + box->height) + margin};
}

/* Returns false if the number of dashes is so large that they merge into an area. */
static bool can_be_dashed(const struct gm_polyline *piece, const float *pattern, size_t parts)
{
    const float most_dashes = 4000.0f;
    float period = 0.0f;
    for (size_t i = 0; i < parts; i++) {
        period += pattern[i];
    }
    return gm_polyline_length(piece) * (float)parts < 2.0f * most_dashes * period;
}

static void draw_line(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const struct gm_style *style = &mark->style;
    const float width = stroke_width(painter, style);
    if (!(width > 0.0f) || !project(painter, axes, mark)) {
        return;
    }
    struct gm_stroke stroke = {.width = width, .ink = ink_of(painter, style)};
    const size_t parts = dashes[style->dash].parts;
    for (size_t i = 0; i < parts; i++) { /* thin lines need longer dashes to be distinct */
        stroke.pattern[i] =
            dashes[style->dash].lengths[i] * fmaxf(width, 1.2f * (float)fmax(painter->scale, 0.8));
    }
    const struct gm_bounds bounds = bounds_of(axes, cut + 2.0f * width);
    for (size_t from = 0; gm_polyline_clip(&painter->line, bounds, &from, &painter->piece);) {
        gm_polyline_simplify(&painter->piece, tolerance);
        stroke.parts = can_be_dashed(&painter->piece, stroke.pattern, parts) ? parts : 0;
        painter->pen->line(painter->self, &painter->piece, &stroke);
    }
}

/* Draws a glyph other than a disc, with paper inside. The line of the mark is in use, the piece is not. */
static void draw_glyph(struct gm_painter *painter, const struct gm_mark *mark, struct gm_point centre,
                       float width)
{
    enum { SIDES = 32 };
    const float pi = 3.14159265f, radius = 0.5f * width;
    const struct gm_ink ink = ink_of(painter, &mark->style);
    const struct gm_ink paper = {gm_theme_colour(painter->look.theme, GM_PAPER), 1};
    struct gm_polyline *line = &painter->piece;
    struct gm_stroke stroke = {.width = 0.2f * width, .ink = ink};
    if (!gm_polyline_reserve(line, SIDES)) {
        return;
    }
    if (mark->glyph == GM_CROSS) {
        for (float side = -1.0f; side < 2.0f; side += 2.0f) {
            line->points[0] = (struct gm_point){centre.x - radius, centre.y - side * radius};
            line->points[1] = (struct gm_point){centre.x + radius, centre.y + side * radius};
            line->count = 2;
            line->closed = false;
            painter->pen->line(painter->self, line, &stroke);
        }
        return;
    }
    for (int i = 0; i < SIDES; i++) {
        const float angle = 2.0f * pi * (float)i / SIDES + 0.5f * pi;
        line->points[i] = (struct gm_point){centre.x + radius * cosf(angle), centre.y + radius * sinf(angle)};
    }
    line->count = SIDES;
    line->closed = true;
    painter->pen->disc(painter->self, centre, width, paper);
    if (mark->glyph == GM_DOTTED_RING) { /* eight dots */
        stroke.parts = 2;
        stroke.pattern[1] = 0.125f * pi * width;
    }
    painter->pen->line(painter->self, line, &stroke);
    if (mark->glyph == GM_HALF_DISC) {
        line->count = SIDES / 2 + 1;
        painter->pen->fill(painter->self, line, ink);
    }
}

static void draw_points(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const struct gm_style *style = &mark->style;
    const float width = stroke_width(painter, style);
    if (!(width > 0.0f) || !project(painter, axes, mark)) {
        return;
    }
    const float radius = 0.5f * fmaxf(width, 1.0f);
    const struct gm_ink ink = ink_of(painter, style);
    const struct gm_bounds bounds = bounds_of(axes, 0.5f);
    clip_to(painter, &axes->box, radius + 1.0f);
    for (size_t i = 0; i < painter->line.count; i++) {
        const struct gm_point p = painter->line.points[i];
        if (p.x >= bounds.left && p.x <= bounds.right && p.y >= bounds.top && p.y <= bounds.bottom) {
            if (mark->glyph == GM_DISC) {
                painter->pen->disc(painter->self, p, width, ink);
            } else {
                draw_glyph(painter, mark, p, width);
            }
        }
    }
}

static void draw_polygon(struct gm_painter *painter, const struct gm_axes *axes, const struct gm_mark *mark)
{
    if (!project(painter, axes, mark)) {
        return;
    }
    struct gm_polyline *line = &painter->line;
    gm_polyline_simplify(line, tolerance);
    const struct gm_point first = line->points[0], last = line->points[line->count - 1];
    if (line->count > 1 && hypotf(first.x - last.x, first.y - last.y) < tolerance) {
        line->count--; /* the last corner repeats the first */
    }
    line->closed = true;
    painter->pen->fill(painter->self, line, ink_of(painter, &mark->style));
}

/* Draws everything of a panel's data except its texts. */
static void paint_marks(struct gm_painter *painter, const struct gm_axes *axes)
{
    for (const struct gm_mark *mark = axes->panel->first; mark; mark = mark->next) {
        if (!gm_mark_is_shown(mark, axes->box.width, axes->box.height)) {
            continue;
        }
        clip_to(painter, &axes->box, 2.5 * painter->scale);
        switch (mark->kind) {
        case GM_MARK_LINE:
            draw_line(painter, axes, mark);
            break;
        case GM_MARK_POINTS:
            draw_points(painter, axes, mark);
            break;
        case GM_MARK_POLYGON:
            draw_polygon(painter, axes, mark);
            break;
        case GM_MARK_MESH:
        case GM_MARK_IMAGE:
            painter->pen->field(painter->self, axes, mark);
            break;
        case GM_MARK_TEXT: /* drawn last, by paint_labels */
            break;
        }
    }
}

/* ---- grid, axes and colour bar ---- */

static double hairline(const struct gm_painter *painter)
{
    return floor(fmax(fmax(1.0, 0.5 * painter->density), painter->scale) + 0.5);
}

static void horizontal_rule(struct gm_painter *painter, double left, double right, double y,
                            struct gm_ink ink)
{
    const double thickness = hairline(painter), top = floor(y - 0.5 * thickness + 0.5);
    painter->pen->box(painter->self, (float)floor(left + 0.5), (float)top, (float)floor(right + 0.5),
                      (float)(top + thickness), ink);
}

static void vertical_rule(struct gm_painter *painter, double x, double top, double bottom, struct gm_ink ink)
{
    const double thickness = hairline(painter), left = floor(x - 0.5 * thickness + 0.5);
    painter->pen->box(painter->self, (float)left, (float)floor(top + 0.5), (float)(left + thickness),
                      (float)floor(bottom + 0.5), ink);
}

static void draw_grid(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box box = axes->box;
    const struct gm_ink ink = {gm_theme_colour(painter->look.theme, GM_GRID), 1.0};
    for (size_t i = 0; i < axes->x_tick_count; i++) {
        vertical_rule(painter, axes->x_ticks[i].position, box.y, box.y + box.height, ink);
    }
    for (size_t i = 0; i < axes->y_tick_count; i++) {
        horizontal_rule(painter, box.x, box.x + box.width, axes->y_ticks[i].position, ink);
    }
}

static void draw_axes(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box box = axes->box;
    const struct gm_ink ink = {gm_theme_colour(painter->look.theme, GM_SECONDARY), 1.0};
    const double tick = 4.0 * painter->scale, right = box.x + box.width, bottom = box.y + box.height;
    const double half = 0.5 * hairline(painter);
    vertical_rule(painter, box.x, box.y, bottom + half, ink);
    horizontal_rule(painter, box.x - half, right, bottom, ink);
    for (size_t i = 0; i < axes->x_tick_count; i++) {
        vertical_rule(painter, axes->x_ticks[i].position, bottom, bottom + tick, ink);
    }
    for (size_t i = 0; i < axes->y_tick_count; i++) {
        horizontal_rule(painter, box.x - tick, box.x, axes->y_ticks[i].position, ink);
    }
}

/* Draws tips at the ends of the bar beyond which there are values, in the colours of the ends. */
static void draw_tips(struct gm_painter *painter, const struct gm_axes *axes, enum gm_colour_map map)
{
    const struct gm_box bar = axes->colour_bar;
    for (int end = 0; end < 2; end++) {
        const double base = end == 0 ? bar.y + bar.height : bar.y;
        const double tip = end == 0 ? base + axes->bar_tip[0] : base - axes->bar_tip[1];
        const struct gm_rgb colour = gm_colour_map_at(map, painter->look.theme, end);
        struct gm_point corners[3] = {{(float)bar.x, (float)base},
                                      {(float)(bar.x + bar.width), (float)base},
                                      {(float)(bar.x + 0.5 * bar.width), (float)tip}};
        const struct gm_polyline line = {.points = corners, .count = 3, .closed = true};
        if (axes->bar_tip[end] > 0.0) {
            painter->pen->fill(painter->self, &line, (struct gm_ink){colour, 1.0});
        }
    }
}

static void draw_colour_bar(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box bar = axes->colour_bar;
    const struct gm_ink ink = {gm_theme_colour(painter->look.theme, GM_SECONDARY), 1.0};
    const double tick = 4.0 * painter->scale, right = bar.x + bar.width;
    const struct gm_mark *field = gm_panel_field(axes->panel);
    if (field) {
        painter->pen->ramp(painter->self, bar, field->map);
        draw_tips(painter, axes, field->map);
    }
    for (size_t i = 0; i < axes->bar_tick_count; i++) {
        horizontal_rule(painter, right, right + tick, axes->bar_ticks[i].position, ink);
    }
}

/* Draws grid, marks, axes and colour bar. */
static void paint_axes(struct gm_painter *painter, const struct gm_axes *axes)
{
    const struct gm_box box = axes->box;
    if (!(box.width >= 1.0 && box.height >= 1.0)) {
        return;
    }
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    if (axes->panel->axes) {
        draw_grid(painter, axes);
        draw_axes(painter, axes);
    }
    paint_marks(painter, axes);
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    if (axes->colour_bar.width > 0.0) {
        draw_colour_bar(painter, axes);
    }
}

/* ---- labels ---- */

/* Returns the width of a label in its font: titles are bold, and the clock, in letters of equal width, is as
   large as the title. */
static double measure(const void *self, enum gm_text_size size, const char *text)
{
    const struct gm_painter *painter = self;
    const int height = painter->letters[size];
    switch (size) {
    case GM_TEXT_TITLE:
        return fmax(gm_glyphs_width(painter->glyphs, GM_FONT_BOLD, height, text),
                    gm_glyphs_width(painter->glyphs, GM_FONT_MONO, height, text));
    case GM_TEXT_PANEL:
        return gm_glyphs_width(painter->glyphs, GM_FONT_BOLD, height, text);
    default:
        return gm_glyphs_width(painter->glyphs, GM_FONT_SANS, height, text);
    }
}

static double line_height(const struct gm_painter *painter, int letters)
{
    return ceil(gm_glyphs_ascent(painter->glyphs, GM_FONT_SANS, letters) +
                gm_glyphs_descent(painter->glyphs, GM_FONT_SANS, letters));
}

struct gm_metrics gm_painter_metrics(const struct gm_painter *painter)
{
    const double roomy = 540.0;
    struct gm_metrics metrics = {
        .width = painter->look.width,
        .height = painter->look.height,
        .measure = measure,
        .self = painter,
        .scale = painter->scale,
        .terse = painter->look.height < roomy * painter->density * painter->enlarged,
    };
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        metrics.line[i] = line_height(painter, painter->letters[i]);
    }
    return metrics;
}

static void draw_label(struct gm_painter *painter, const struct gm_label *label)
{
    struct gm_writing writing = {.font = label->mono   ? GM_FONT_MONO
                                         : label->bold ? GM_FONT_BOLD
                                                       : GM_FONT_SANS,
                                 .letters = painter->letters[label->size],
                                 .anchor = label->vertical ? GM_ANCHOR_CENTRE : label->anchor,
                                 .upwards = label->vertical,
                                 .ink = {gm_theme_colour(painter->look.theme, label->role), 1.0}};
    writing.width = gm_glyphs_width(painter->glyphs, writing.font, writing.letters, label->text);
    const double ascent = gm_glyphs_ascent(painter->glyphs, GM_FONT_SANS, writing.letters);
    if (label->vertical) {
        writing.x = label->x + ascent;
        writing.y = label->y + 0.5 * writing.width;
    } else {
        writing.x = label->x - gm_anchor_share(label->anchor) * writing.width;
        writing.y = label->y + ascent;
    }
    painter->pen->text(painter->self, &writing, label->text);
}

/* Draws translucent paper, so that a text among the marks is legible on anything. */
static void draw_plate(struct gm_painter *painter, const struct gm_label *label)
{
    const int letters = painter->letters[label->size];
    const double width = gm_glyphs_width(painter->glyphs, GM_FONT_SANS, letters, label->text);
    const double line = line_height(painter, letters);
    const float half = (float)(0.5 * line), middle = (float)(label->y + 0.5 * line);
    const struct gm_stroke plate = {.width = (float)line,
                                    .ink = {gm_theme_colour(painter->look.theme, GM_PAPER), 0.6}};
    const float left = (float)label->x + 0.4f * half, right = (float)(label->x + width) - 0.4f * half;
    struct gm_point ends[2] = {{left, middle}, {fmaxf(left + 1.0f, right), middle}};
    const struct gm_polyline axis = {.points = ends, .count = 2};
    painter->pen->line(painter->self, &axis, &plate);
}

/* Draws every label of the layout, labels among the marks on plates of paper. */
static void paint_labels(struct gm_painter *painter, const struct gm_layout *layout)
{
    painter->pen->clip(painter->self, 0, 0, painter->look.width, painter->look.height);
    for (size_t i = 0; i < layout->label_count; i++) {
        if (layout->labels[i].among_marks) {
            draw_plate(painter, &layout->labels[i]);
        }
    }
    for (size_t i = 0; i < layout->label_count; i++) {
        draw_label(painter, &layout->labels[i]);
    }
}

/* ---- the page ---- */

/* Letters and strokes scale with the height, on narrow pages with the width. */
static void set_sizes(struct gm_painter *painter)
{
    static const double shares[GM_TEXT_SIZE_COUNT] = {0.036, 0.025, 0.022, 0.021};
    const double smallest = 9.0, screen_dpi = 96.0;
    const struct gm_appearance *look = &painter->look;
    const double larger = look->scale > 0.0 ? look->scale : 1.0;
    const double by_width = look->width / 960.0, by_height = look->height / 720.0;
    painter->density = look->dpi > 0.0 ? look->dpi / screen_dpi : 1.0;
    painter->scale = larger * (by_height < by_width ? by_height : by_width);
    painter->enlarged = fmax(larger, 1.0);
    const int least = (int)(smallest * painter->density * painter->enlarged + 0.5);
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        const int letters = (int)(720.0 * painter->scale * shares[i] + 0.5);
        painter->letters[i] = letters > least ? letters : least;
    }
}

bool gm_page_open(struct gm_painter *painter, const struct gm_pen *pen, void *self,
                  const struct gm_appearance *look, char *message)
{
    *painter = (struct gm_painter){.pen = pen, .self = self, .look = *look};
    set_sizes(painter);
    painter->glyphs = gm_glyphs_open(message, GM_MESSAGE);
    return painter->glyphs != NULL;
}

void gm_page_close(struct gm_painter *painter)
{
    gm_glyphs_close(painter->glyphs);
    gm_polyline_free(&painter->line);
    gm_polyline_free(&painter->piece);
}

bool gm_page_draw(struct gm_painter *painter, struct gm_picture *picture)
{
    const struct gm_metrics metrics = gm_painter_metrics(painter);
    if (painter->look.screen) {
        paint_cells(painter, painter->look.screen);
        return true;
    }
    if (painter->look.title) {
        picture->title = painter->look.title;
    }
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    if (!layout) {
        return false;
    }
    for (size_t i = 0; i < layout->frame_count; i++) {
        paint_axes(painter, &layout->frames[i]);
    }
    paint_labels(painter, layout);
    return true;
}
