/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pen that writes SVG. Places are in hundredths of a pixel; lines are differences of the rounded places,
   so that errors do not add up. Neighbours of one look share their attributes, and opaque lines share a
   path. */
#include "render/vector/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/cells/text.h"
#include "render/files/regular_file.h"
#include "render/message.h"

enum shape { NO_SHAPE, LINES, DISCS, FILLS, BOXES };

enum { MOST_CLIPS = 64, STOPS = 64 };

struct gm_svg {
    FILE *out;
    struct gm_painter painter;
    int clip[4];
    bool clipped; /* true inside a group with this clip */
    int clips[MOST_CLIPS][4];
    size_t clip_count;
    /* the open element: shapes of one look */
    enum shape shape;
    struct gm_stroke stroke; /* discs use the width, all shapes the ink */
    bool ramps[2];           /* gradients that are defined */
    size_t fields;
    bool short_of_memory;
};

/* ---- numbers and texts ---- */

static long hundredths(double value)
{
    const double far = 1e9;
    return lround(100.0 * fmin(fmax(value, -far), far));
}

/* A number in its shortest form, in any locale: "12.5", "-.25". */
struct number {
    char text[32];
};

static struct number number_of(long value)
{
    const long whole = labs(value) / 100, part = labs(value) % 100;
    const char *sign = value < 0 ? "-" : "";
    struct number made;
    char *to = made.text;
    to += whole > 0 || part == 0 ? sprintf(to, "%s%ld", sign, whole) : sprintf(to, "%s", sign);
    if (part > 0) {
        sprintf(to, part % 10 ? ".%02ld" : ".%ld", part % 10 ? part : part / 10);
    }
    return made;
}

static struct number number(double value)
{
    return number_of(hundredths(value));
}

static void put_hundredths(FILE *out, long value)
{
    fputs(number_of(value).text, out);
}

/* Writes a number after another one, with a blank if they would merge. */
static void put_next(FILE *out, long value)
{
    if (value >= 0) {
        putc(' ', out);
    }
    put_hundredths(out, value);
}

static void put_ink(FILE *out, const char *name, struct gm_ink ink)
{
    fprintf(out, " %s=\"#%02x%02x%02x\"", name, ink.colour.r, ink.colour.g, ink.colour.b);
    if (ink.alpha < 1.0) {
        fprintf(out, " %s-opacity=\"%s\"", name, number(fmax(ink.alpha, 0.0)).text);
    }
}

static const char *const escapes[][2] = {{"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}};
enum { ESCAPES = sizeof escapes / sizeof *escapes };

/* XML cannot contain most control characters: characters that are not shown become U+FFFD. */
static void put_text(FILE *out, const char *text)
{
    while (*text) {
        const char *start = text;
        const uint32_t code = gm_text_next(&text);
        size_t i = 0;
        while (i < ESCAPES && code != (uint32_t)escapes[i][1][0]) {
            i++;
        }
        if (i < ESCAPES) {
            fputs(escapes[i][0], out);
        } else if (gm_text_is_shown(code) || code == '\n') {
            fprintf(out, "%.*s", (int)(text - start), start);
        } else {
            fputs("\xef\xbf\xbd", out);
        }
    }
}

/* ---- groups ---- */

static void end_shapes(struct gm_svg *svg)
{
    const bool path = svg->shape == BOXES || (svg->shape == LINES && svg->stroke.ink.alpha >= 1.0);
    if (svg->shape != NO_SHAPE) {
        fputs(path ? "\"/>\n" : "</g>\n", svg->out);
    }
    svg->shape = NO_SHAPE;
}

static bool same_stroke(const struct gm_stroke *a, const struct gm_stroke *b)
{
    return a->width == b->width && a->parts == b->parts && a->ink.alpha == b->ink.alpha &&
           memcmp(&a->ink.colour, &b->ink.colour, sizeof a->ink.colour) == 0 &&
           memcmp(a->pattern, b->pattern, a->parts * sizeof *a->pattern) == 0;
}

static void put_clip(struct gm_svg *svg)
{
    const int *clip = svg->clip;
    const size_t known = svg->clip_count < MOST_CLIPS ? svg->clip_count : MOST_CLIPS;
    size_t k = 0;
    while (k < known && memcmp(svg->clips[k], clip, sizeof svg->clip) != 0) {
        k++;
    }
    if (k == known) {
        k = svg->clip_count++;
        if (k < MOST_CLIPS) { /* further clips are defined each time */
            memcpy(svg->clips[k], clip, sizeof svg->clip);
        }
        fprintf(svg->out,
                "<clipPath id=\"c%zu\"><rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\"/></clipPath>\n", k,
                clip[0], clip[1], clip[2], clip[3]);
    }
    fprintf(svg->out, "<g clip-path=\"url(#c%zu)\">\n", k);
}

static void clip(void *self, int left, int top, int width, int height)
{
    struct gm_svg *svg = self;
    const int wanted[4] = {left, top, width, height};
    if (memcmp(wanted, svg->clip, sizeof wanted) == 0) {
        return;
    }
    end_shapes(svg);
    if (svg->clipped) {
        fputs("</g>\n", svg->out);
    }
    memcpy(svg->clip, wanted, sizeof wanted);
    svg->clipped = left > 0 || top > 0 || left + width < svg->painter.look.width ||
                   top + height < svg->painter.look.height;
    if (svg->clipped) {
        put_clip(svg);
    }
}

/* Opens the element for shapes of that look, unless it is open. */
static void begin_shapes(struct gm_svg *svg, enum shape shape, const struct gm_stroke *stroke)
{
    if (svg->shape == shape && same_stroke(&svg->stroke, stroke)) {
        return;
    }
    end_shapes(svg);
    svg->shape = shape;
    svg->stroke = *stroke;
    const bool one = shape == BOXES || (shape == LINES && stroke->ink.alpha >= 1.0);
    fputs(one ? "<path" : "<g", svg->out);
    if (shape == LINES) {
        fputs(" fill=\"none\"", svg->out);
        put_ink(svg->out, "stroke", stroke->ink);
        fprintf(svg->out, " stroke-width=\"%s\"", number(stroke->width).text);
        for (size_t i = 0; i < stroke->parts; i++) {
            fprintf(svg->out, "%s%s", i == 0 ? " stroke-dasharray=\"" : " ",
                    number(fmaxf(stroke->pattern[i], GM_SHORTEST_DASH * stroke->width)).text);
        }
        fputs(stroke->parts > 0 ? "\"" : "", svg->out);
    } else {
        put_ink(svg->out, "fill", stroke->ink);
    }
    fputs(one ? " d=\"" : ">\n", svg->out);
}

/* ---- shapes ---- */

static void put_path(FILE *out, const struct gm_polyline *line, bool closed)
{
    long x = hundredths(line->points[0].x), y = hundredths(line->points[0].y);
    putc('M', out);
    put_hundredths(out, x);
    put_next(out, y);
    bool first = true;
    for (size_t i = 1; i < line->count; i++) {
        const long next_x = hundredths(line->points[i].x), next_y = hundredths(line->points[i].y);
        if (next_x == x && next_y == y && line->count > 2) {
            continue;
        }
        if (first) {
            putc('l', out);
            put_hundredths(out, next_x - x);
        } else {
            put_next(out, next_x - x);
        }
        put_next(out, next_y - y);
        first = false;
        x = next_x;
        y = next_y;
    }
    fputs(closed ? "z" : first ? "h0" : "", out);
}

static void line(void *self, const struct gm_polyline *line, const struct gm_stroke *stroke)
{
    struct gm_svg *svg = self;
    if (line->count == 0) {
        return;
    }
    begin_shapes(svg, LINES, stroke);
    const bool own = stroke->ink.alpha < 1.0;
    fputs(own ? "<path d=\"" : "", svg->out);
    put_path(svg->out, line, line->closed);
    fputs(own ? "\"/>\n" : "\n", svg->out);
}

static void disc(void *self, struct gm_point centre, float width, struct gm_ink ink)
{
    struct gm_svg *svg = self;
    begin_shapes(svg, DISCS, &(struct gm_stroke){.width = width, .ink = ink});
    fprintf(svg->out, "<circle cx=\"%s\" cy=\"%s\" r=\"%s\"/>\n", number(centre.x).text,
            number(centre.y).text, number(0.5 * width).text);
}

static void fill(void *self, const struct gm_polyline *line, struct gm_ink ink)
{
    struct gm_svg *svg = self;
    if (line->count < 3 || !(ink.alpha > 0.0)) {
        return;
    }
    begin_shapes(svg, FILLS, &(struct gm_stroke){.ink = ink});
    fputs("<path fill-rule=\"evenodd\" d=\"", svg->out);
    put_path(svg->out, line, true);
    fputs("\"/>\n", svg->out);
}

static void box(void *self, float left, float top, float right, float bottom, struct gm_ink ink)
{
    struct gm_svg *svg = self;
    begin_shapes(svg, BOXES, &(struct gm_stroke){.ink = ink});
    fprintf(svg->out, "M%.0f %.0fH%.0fV%.0fH%.0fz\n", (double)left, (double)top, (double)right,
            (double)bottom, (double)left);
}

/* ---- fields ---- */

static void put_image(void *self, const struct gm_field_image *image, const struct gm_mark *mark)
{
    struct gm_svg *svg = self;
    uint8_t palette[GM_PALETTE][4];
    gm_field_image_palette(image, mark->map, svg->painter.look.theme, palette);
    size_t size = 0;
    char reason[GM_PNG_REASON];
    const struct gm_png file = {.width = image->columns,
                                .height = image->rows,
                                .pixels = image->pixels,
                                .palette = (const uint8_t(*)[4])palette};
    unsigned char *png = gm_png_pack(&file, &size, reason);
    if (!png) {
        svg->short_of_memory = true;
        return;
    }
    fprintf(svg->out, "<image x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" preserveAspectRatio=\"none\"",
            image->left, image->top, image->width, image->height);
    if (mark->style.alpha < 1.0) {
        fprintf(svg->out, " opacity=\"%s\"", number(mark->style.alpha).text);
    }
    fputs(" xlink:href=\"data:image/png;base64,", svg->out);
    gm_base64_put(png, size, svg->out);
    fputs("\"/>\n", svg->out);
    free(png);
    svg->fields++;
}

static void field(void *self, const struct gm_axes *axes, const struct gm_mark *mark)
{
    struct gm_svg *svg = self;
    end_shapes(svg);
    svg->short_of_memory |= !gm_field_image_draw(axes, mark, svg->clip, put_image, svg);
}

static void ramp(void *self, struct gm_box box, enum gm_colour_map map)
{
    struct gm_svg *svg = self;
    end_shapes(svg);
    if (!svg->ramps[map]) {
        fprintf(svg->out, "<linearGradient id=\"m%d\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">\n", map);
        for (int i = 0; i <= STOPS; i++) {
            const struct gm_rgb rgb = gm_colour_map_at(map, svg->painter.look.theme, (double)i / STOPS);
            fprintf(svg->out, "<stop offset=\"%d.%04d\" stop-color=\"#%02x%02x%02x\"/>\n", i / STOPS,
                    i % STOPS * 10000 / STOPS, rgb.r, rgb.g, rgb.b);
        }
        fputs("</linearGradient>\n", svg->out);
        svg->ramps[map] = true;
    }
    const double left = floor(box.x + 0.5), top = floor(box.y + 0.5);
    fprintf(svg->out, "<rect x=\"%s\" y=\"%s\" width=\"%s\" height=\"%s\" fill=\"url(#m%d)\"/>\n",
            number(left).text, number(top).text, number(floor(box.x + box.width + 0.5) - left).text,
            number(floor(box.y + box.height + 0.5) - top).text, map);
}

/* ---- letters ---- */

/* Writes the family, then other fonts of about its width. */
static void put_family(struct gm_svg *svg, enum gm_font font)
{
    fprintf(svg->out, " font-family=\"'%s', %s\"", gm_glyphs_family(svg->painter.glyphs, font),
            font >= GM_FONT_MONO ? "'Bitstream Vera Sans Mono', monospace"
                                 : "'Bitstream Vera Sans', Verdana, sans-serif");
}

static void text(void *self, const struct gm_writing *writing, const char *text)
{
    static const char *const anchors[] = {
        [GM_ANCHOR_LEFT] = "start", [GM_ANCHOR_CENTRE] = "middle", [GM_ANCHOR_RIGHT] = "end"};
    struct gm_svg *svg = self;
    const double before = gm_anchor_share(writing->anchor) * writing->width;
    const double x = writing->upwards ? floor(writing->x + 0.5) : writing->x + before;
    const double y = writing->upwards ? writing->y - before : floor(writing->y + 0.5);
    end_shapes(svg);
    fprintf(svg->out,
            writing->upwards ? "<text transform=\"translate(%s,%s) rotate(-90)\"" : "<text x=\"%s\" y=\"%s\"",
            number(x).text, number(y).text);
    fprintf(svg->out, " font-size=\"%d\"", writing->letters);
    const bool bold = writing->font == GM_FONT_BOLD || writing->font == GM_FONT_MONO_BOLD;
    fputs(bold ? " font-weight=\"bold\"" : "", svg->out);
    if (writing->font >= GM_FONT_MONO && !svg->painter.look.screen) {
        put_family(svg, writing->font);
    }
    if (writing->anchor != GM_ANCHOR_LEFT) {
        fprintf(svg->out, " text-anchor=\"%s\"", anchors[writing->anchor]);
    }
    put_ink(svg->out, "fill", writing->ink);
    putc('>', svg->out);
    put_text(svg->out, text);
    fputs("</text>\n", svg->out);
}

static const struct gm_pen pen = {.clip = clip,
                                  .box = box,
                                  .line = line,
                                  .disc = disc,
                                  .fill = fill,
                                  .field = field,
                                  .ramp = ramp,
                                  .text = text};

/* ---- the document ---- */

static void put_head(struct gm_svg *svg, const struct gm_picture *picture, const struct gm_png_text *texts,
                     size_t count)
{
    const struct gm_appearance *look = &svg->painter.look;
    const struct gm_rgb paper = gm_theme_colour(look->theme, GM_PAPER);
    const bool paged = look->page_width > 0.0 && look->page_height > 0.0;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"",
          svg->out);
    const double unit = look->dpi > 0.0 && !paged ? 96.0 / look->dpi : 1.0;
    const char *length = paged ? "mm" : "";
    fprintf(svg->out, " width=\"%s%s\" height=\"%s%s\" viewBox=\"0 0 %d %d\"",
            number(paged ? look->page_width : unit * look->width).text, length,
            number(paged ? look->page_height : unit * look->height).text, length, look->width, look->height);
    put_family(svg, look->screen ? GM_FONT_MONO : GM_FONT_SANS);
    fputs(" stroke-linecap=\"round\" stroke-linejoin=\"round\" xml:space=\"preserve\">\n<title>", svg->out);
    put_text(svg->out, look->title ? look->title : picture->title);
    fputs("</title>\n<metadata xmlns:geomint=\"urn:geomint\">\n", svg->out);
    for (size_t i = 0; i < count; i++) {
        fputs("<geomint:text key=\"", svg->out);
        put_text(svg->out, texts[i].key);
        fputs("\">", svg->out);
        put_text(svg->out, texts[i].text);
        fputs("</geomint:text>\n", svg->out);
    }
    fputs("</metadata>\n<rect width=\"100%\" height=\"100%\"", svg->out);
    put_ink(svg->out, "fill", (struct gm_ink){paper, 1.0});
    fputs("/>\n", svg->out);
}

static bool draw(void *self, struct gm_drawing *drawing, FILE *out)
{
    struct gm_svg *svg = self;
    svg->out = out;
    put_head(svg, drawing->picture, drawing->texts, drawing->count);
    const bool drawn = gm_page_draw(&svg->painter, drawing->picture);
    clip(svg, 0, 0, drawing->look->width, drawing->look->height);
    end_shapes(svg);
    fputs("</svg>\n", out);
    drawing->fields = svg->fields;
    return drawn && !svg->short_of_memory;
}

bool gm_svg_write(const char *path, struct gm_drawing *drawing, char *message)
{
    struct gm_svg svg = {.clip = {0, 0, drawing->look->width, drawing->look->height}};
    const struct gm_drawer drawer = {&pen, draw, &svg, &svg.painter};
    return gm_drawing_write(path, drawing, &drawer, message);
}

/* ---- reading the texts of the metadata ---- */

enum { MOST_BYTES = 1 << 28 };

/* Undoes the escapes of a text, in place. */
static void unescape(char *text)
{
    char *to = text;
    while (*text) {
        size_t taken = 1;
        *to = *text;
        for (size_t i = 0; i < ESCAPES; i++) {
            if (strncmp(text, escapes[i][0], strlen(escapes[i][0])) == 0) {
                *to = escapes[i][1][0];
                taken = strlen(escapes[i][0]);
            }
        }
        text += taken;
        to++;
    }
    *to = '\0';
}

/* Returns the text of a key between two places, which the caller frees; NULL without it. */
static char *text_of(const char *from, const char *to, const char *key)
{
    char front[128];
    snprintf(front, sizeof front, "<geomint:text key=\"%s\">", key);
    const char *start = strstr(from, front);
    const char *end = start && start < to ? strstr(start, "</geomint:text>") : NULL;
    if (!end || end > to) {
        return NULL;
    }
    start += strlen(front);
    char *text = strndup(start, (size_t)(end - start));
    if (text) {
        unescape(text);
    }
    return text;
}

bool gm_svg_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message)
{
    char reason[GM_REGULAR_REASON];
    size_t size = 0;
    char *bytes = gm_regular_read(path, MOST_BYTES, &size, reason);
    if (!bytes) {
        snprintf(message, GM_MESSAGE, "%.300s could not be read: %s", path, reason);
        return false;
    }
    const char *from = strstr(bytes, "<metadata"), *to = from ? strstr(from, "</metadata>") : NULL;
    for (size_t i = 0; i < count; i++) {
        texts[i] = to ? text_of(from, to, keys[i]) : NULL;
    }
    free(bytes);
    return true;
}
