/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the differences between screens to a terminal, without blocking. */
#include "app/explorer/terminal/device.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/explorer/surface/surface.h"
#include "app/explorer/terminal/curses.h"
#include "render/cells/text.h"
#include "render/clock.h"
#include "render/files/images.h"

/* ---- the colours of a picture in terminals of 256 and of 16 colours ---- */

/* Returns a distance that counts a shift of hue four times as much as one of brightness; otherwise every
   faded colour would become a grey. */
static int shift(struct gm_rgb a, struct gm_rgb b)
{
    int r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b, light = (2 * r + 5 * g + blue) / 8;
    return light * light + 4 * ((r - light) * (r - light) + (blue - light) * (blue - light)) / 2;
}

static struct gm_rgb of_256(int number)
{
    static const uint8_t levels[6] = {0, 95, 135, 175, 215, 255};
    if (number >= 232) {
        uint8_t grey = (uint8_t)(8 + 10 * (number - 232));
        return (struct gm_rgb){grey, grey, grey};
    }
    number -= 16;
    return (struct gm_rgb){levels[number / 36], levels[number / 6 % 6], levels[number % 6]};
}

/* Returns the nearest of xterm's 256 colours, except the first sixteen, which users redefine. */
static int nearest_256(struct gm_rgb colour)
{
    int best = 16;
    for (int i = 17; i < 256; i++) {
        if (shift(colour, of_256(i)) < shift(colour, of_256(best))) {
            best = i;
        }
    }
    return best;
}

/* the usual sixteen colours; users' palettes differ, but not in hue */
static const struct gm_rgb sixteen[16] = {
    {0, 0, 0},     {205, 0, 0},     {0, 205, 0},     {205, 205, 0},   {0, 0, 238}, {205, 0, 205},
    {0, 205, 205}, {229, 229, 229}, {127, 127, 127}, {255, 0, 0},     {0, 255, 0}, {255, 255, 0},
    {92, 92, 255}, {255, 0, 255},   {0, 255, 255},   {255, 255, 255},
};

/* the roles' strong and faded colours on white, then on black */
static const uint8_t roles[GM_ROLE_COUNT][GM_THEME_COUNT][2] = {
    [GM_PAPER] = {{15, 15}, {0, 0}},    [GM_INK] = {{0, 8}, {15, 7}},
    [GM_SECONDARY] = {{8, 8}, {7, 7}},  [GM_GRID] = {{7, 7}, {8, 8}},
    [GM_INITIAL] = {{1, 9}, {9, 1}},    [GM_EXACT] = {{8, 7}, {7, 8}},
    [GM_OVER] = {{15, 7}, {15, 7}},     [GM_LANE + 0] = {{4, 12}, {14, 6}},
    [GM_LANE + 1] = {{3, 11}, {11, 3}}, [GM_LANE + 2] = {{2, 10}, {10, 2}},
    [GM_LANE + 3] = {{5, 13}, {13, 5}}, [GM_LANE + 4] = {{6, 14}, {12, 4}},
    [GM_LANE + 5] = {{0, 8}, {15, 7}},
};

/* Returns a role's colour, or the darker one of its pair if it is faded. */
static int nearest_role(enum gm_theme theme, struct gm_rgb colour, enum gm_role role)
{
    struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER);
    /* distances are squared: 1/3 is 0.58 of the distance */
    bool faded = 3 * gm_rgb_distance(colour, paper) < gm_rgb_distance(gm_theme_colour(theme, role), paper);
    return roles[role][theme][faded];
}

static int nearest_ground(enum gm_theme theme, struct gm_rgb colour)
{
    struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER);
    if (gm_rgb_distance(colour, paper) < 4000) {
        return roles[GM_PAPER][theme][0];
    }
    int best = 0;
    for (int i = 1; i < 16; i++) {
        if (gm_rgb_distance(colour, sixteen[i]) < gm_rgb_distance(colour, sixteen[best])) {
            best = i;
        }
    }
    return best;
}

/* Returns true if a colour counts as ink on a monochrome terminal. */
static bool is_ink(enum gm_theme theme, struct gm_rgb colour)
{
    struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER), ink = gm_theme_colour(theme, GM_INK);
    return 16 * gm_rgb_distance(colour, paper) > gm_rgb_distance(ink, paper);
}

/* ---- the line of bytes ---- */

static void put(struct gm_writer *writer, const char *bytes, size_t size)
{
    if (size == 0) { /* `bytes` may be NULL then */
        return;
    }
    if (writer->length + size > writer->capacity) {
        size_t capacity = 2 * (writer->length + size) + 4096;
        char *more = realloc(writer->out, capacity);
        if (!more) {
            writer->failed = true;
            return;
        }
        writer->out = more;
        writer->capacity = capacity;
    }
    memcpy(writer->out + writer->length, bytes, size);
    writer->length += size;
}

void gm_writer_tell(struct gm_writer *writer, const char *text)
{
    put(writer, text, strlen(text));
}

__attribute__((format(printf, 2, 3))) static void put_format(struct gm_writer *writer, const char *format,
                                                             ...)
{
    char text[64];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    gm_writer_tell(writer, text);
}

const char *gm_capability(const char *name)
{
    const char *text = gm_curses()->tigetstr(name);
    return text == (char *)-1 ? NULL : text;
}

size_t gm_capability_copy(const char *capability, char *bytes, size_t size)
{
    size_t count = 0;
    for (const char *at = capability; at && *at && count < size;) {
        const char *end = at[0] == '$' && at[1] == '<' ? strchr(at, '>') : NULL;
        if (end) {
            at = end + 1;
        } else {
            bytes[count++] = *at++;
        }
    }
    return count;
}

static void put_capability(struct gm_writer *writer, const char *capability)
{
    char bytes[256];
    put(writer, bytes, gm_capability_copy(capability, bytes, sizeof bytes));
}

/* ---- colours ---- */

static long colour_number(struct gm_writer *writer, struct gm_rgb colour, enum gm_role role, bool ground)
{
    switch (writer->colours) {
    case GM_COLOURS_TRUE:
        return (long)colour.r << 16 | colour.g << 8 | colour.b;
    case GM_COLOURS_256: {
        size_t key = (size_t)(colour.r >> 3) << 10 | (size_t)(colour.g >> 3) << 5 | (size_t)(colour.b >> 3);
        if (writer->nearest[key] < 0) {
            writer->nearest[key] = (int16_t)nearest_256(colour);
        }
        return writer->nearest[key];
    }
    case GM_COLOURS_16:
        return ground ? nearest_ground(writer->theme, colour) : nearest_role(writer->theme, colour, role);
    case GM_COLOURS_NONE:
        break;
    }
    return 0;
}

static void put_colour(struct gm_writer *writer, long number, bool ground)
{
    if (writer->colours == GM_COLOURS_TRUE) {
        put_format(writer, "\033[%d;2;%ld;%ld;%ldm", ground ? 48 : 38, number >> 16 & 255, number >> 8 & 255,
                   number & 255);
    } else if (writer->colours == GM_COLOURS_256) {
        put_format(writer, "\033[%d;5;%ldm", ground ? 48 : 38, number);
    } else if (writer->set_foreground) {
        put_capability(writer, gm_curses()->tiparm(ground ? writer->set_background : writer->set_foreground,
                                                   (int)(writer->bright ? number : number & 7)));
    } else {
        put_format(writer, "\033[%ldm", (number < 8 ? 30 + number : 82 + number) + (ground ? 10 : 0));
    }
}

/* The glyph, colours and attributes of a cell on this terminal. */
struct look {
    uint32_t glyph;
    long foreground, background;
    bool bold, reverse;
};

enum { BLUE = 4, DARK_GREY = 8 };

static struct look look_of(struct gm_writer *writer, const struct gm_cell *cell)
{
    struct look look = {.glyph = cell->glyph ? cell->glyph : ' ', .bold = cell->bold};
    if (writer->colours == GM_COLOURS_NONE) {
        /* only ink and paper: two inks in one cell are a full block, an inked ground is reversed */
        bool ink = is_ink(writer->theme, cell->foreground);
        bool ground = is_ink(writer->theme, cell->background);
        bool block = cell->glyph >= 0x2580 && cell->glyph <= 0x259F;
        if (ground && ink && block) {
            look.glyph = 0x2588;
        } else if (ground) {
            look.reverse = true;
        }
        return look;
    }
    look.foreground = colour_number(writer, cell->foreground, cell->role, false);
    look.background = colour_number(writer, cell->background, GM_PAPER, true);
    if (writer->colours == GM_COLOURS_16 && !writer->bright) {
        if (look.foreground == DARK_GREY) { /* bold black is black on many terminals */
            look.foreground = BLUE;
        }
        look.bold = look.bold || look.foreground >= 8;
        look.foreground &= 7;
        look.background &= 7;
    }
    if (look.glyph == ' ') { /* a blank shows only its background */
        look.foreground = writer->foreground >= 0 ? writer->foreground : look.foreground;
    }
    return look;
}

static void take_look(struct gm_writer *writer, const struct look *look)
{
    bool blank = look->glyph == ' ' && !look->reverse;
    bool bold = blank ? writer->bold : look->bold;
    if (writer->foreground < 0 || (writer->bold && !bold) || (writer->reverse && !look->reverse)) {
        put_capability(writer, writer->plain ? writer->plain : "\033[0m");
        writer->bold = writer->reverse = false;
        writer->foreground = writer->background = -1;
    }
    if (bold && !writer->bold) {
        put_capability(writer, writer->strong);
    }
    if (look->reverse && !writer->reverse) {
        put_capability(writer, writer->reversed);
    }
    if (writer->colours != GM_COLOURS_NONE) {
        if (look->foreground != writer->foreground) {
            put_colour(writer, look->foreground, false);
        }
        if (look->background != writer->background) {
            put_colour(writer, look->background, true);
        }
    }
    writer->foreground = look->foreground;
    writer->background = look->background;
    writer->bold = bold;
    writer->reverse = look->reverse;
}

/* ---- screens ---- */

static bool same_cell(const struct gm_cell *a, const struct gm_cell *b)
{
    return a->glyph == b->glyph && memcmp(&a->background, &b->background, sizeof a->background) == 0 &&
           (a->glyph == ' ' || (memcmp(&a->foreground, &b->foreground, sizeof a->foreground) == 0 &&
                                a->bold == b->bold && a->role == b->role));
}

static void put_cell(struct gm_writer *writer, const struct gm_cells *cells, int column, int row)
{
    char bytes[GM_TEXT_BYTES];
    struct look look = look_of(writer, &cells->cells[(size_t)row * (size_t)cells->columns + (size_t)column]);
    take_look(writer, &look);
    put(writer, bytes, gm_text_put(look.glyph, bytes));
    writer->column++;
    if (writer->column >= cells->columns) {
        writer->row = -1; /* at the right edge terminals differ in the cursor's position */
    }
}

enum { CHEAPER = 4 }; /* the most cells that are cheaper to rewrite than to skip */

/* Returns true if the cells from the cursor to the column can be rewritten: they are few and not covered
   by a picture. */
static bool may_write_on(const struct gm_writer *writer, const struct gm_cells *cells, int column, int row)
{
    if (writer->row != row || column <= writer->column || column - writer->column > CHEAPER) {
        return false;
    }
    const struct gm_cell *line = &cells->cells[(size_t)row * (size_t)cells->columns];
    for (int i = writer->column; i < column; i++) {
        if (!line[i].glyph) {
            return false;
        }
    }
    return true;
}

void gm_writer_draw(struct gm_writer *writer, const struct gm_cells *cells,
                    const struct gm_writer_image *image)
{
    if (writer->shown.columns != cells->columns || writer->shown.rows != cells->rows) {
        writer->known = false;
        if (!gm_cells_resize(&writer->shown, cells->columns, cells->rows)) {
            writer->failed = true;
            return;
        }
    }
    /* Synchronised output: terminals that support it show the frame at once, others ignore it. */
    bool together = writer->colours >= GM_COLOURS_256 || image;
    if (together) {
        gm_writer_tell(writer, "\033[?2026h");
    }
    size_t begun = writer->length;
    if (!writer->known) {
        writer->row = writer->foreground = -1;
    }
    for (int row = 0; row < cells->rows; row++) {
        for (int column = 0; column < cells->columns; column++) {
            size_t at = (size_t)row * (size_t)cells->columns + (size_t)column;
            if (writer->known && same_cell(&cells->cells[at], &writer->shown.cells[at])) {
                continue;
            }
            if (!writer->corner && row + 1 == cells->rows && column + 1 == cells->columns) {
                continue;
            }
            if (may_write_on(writer, cells, column, row)) {
                while (writer->column < column) {
                    put_cell(writer, cells, writer->column, row);
                }
            }
            if (writer->row != row || writer->column != column) {
                put_capability(writer, gm_curses()->tiparm(writer->place, row, column));
                writer->row = row;
                writer->column = column;
            }
            put_cell(writer, cells, column, row);
        }
    }
    memcpy(writer->shown.cells, cells->cells,
           sizeof *cells->cells * (size_t)cells->columns * (size_t)cells->rows);
    writer->known = true;
    if (image && image->size > 0) {
        put(writer, image->bytes, image->size);
        writer->row = -1; /* the cursor may be anywhere */
    }
    if (writer->length == begun) {
        writer->length = writer->sent = 0;
        return;
    }
    if (together) {
        gm_writer_tell(writer, "\033[?2026l");
    }
    if (writer->asks && writer->asked - writer->answered < GM_WRITER_FLYING) {
        gm_writer_tell(writer, GM_ASK_READY);
        writer->asked_at = gm_clock_milliseconds();
        writer->flying[writer->asked % GM_WRITER_FLYING] = writer->length;
        writer->sent_at[writer->asked++ % GM_WRITER_FLYING] = writer->asked_at;
    }
}

/* bytes that may be unanswered, at most and at least: some frames of cells, or one picture; the delay (ms)
   that is too long; the milliseconds after which an answer is lost */
enum { ON_THE_WAY = 32768, LEAST_ON_THE_WAY = 1024, LAG = 200, LOST = 3000 };

/* Adapts the bound by additive increase and multiplicative decrease, like TCP's window. */
static void adapt(struct gm_writer *writer, int64_t now)
{
    const int64_t passed = now - writer->sent_at[(writer->answered - 1) % GM_WRITER_FLYING];
    if (passed < writer->trip) {
        writer->trip = (int)passed;
    }
    if (passed > writer->trip + LAG) {
        writer->bound = writer->bound / 2 > LEAST_ON_THE_WAY ? writer->bound / 2 : LEAST_ON_THE_WAY;
    } else if (writer->bound < ON_THE_WAY) {
        writer->bound += LEAST_ON_THE_WAY;
    }
}

static size_t flying(const struct gm_writer *writer)
{
    size_t bytes = 0;
    for (unsigned long i = writer->answered; i < writer->asked; i++) {
        bytes += writer->flying[i % GM_WRITER_FLYING];
    }
    return bytes;
}

bool gm_writer_takes(struct gm_writer *writer, unsigned long ready)
{
    const int64_t now = gm_clock_milliseconds();
    if (ready > writer->asked) { /* late answers to earlier questions */
        ready = writer->asked;
    }
    if (ready > writer->heard) {
        writer->heard = ready;
        writer->asks = true; /* the terminal does answer */
        writer->asked_at = now;
    }
    if (ready > writer->answered) {
        writer->answered = ready;
        adapt(writer, now);
    } else if (gm_writer_patience(writer) == 0) {
        writer->asks = false;
        writer->answered = writer->asked;
    }
    return gm_writer_idle(writer) && flying(writer) < writer->bound;
}

int gm_writer_patience(const struct gm_writer *writer)
{
    if (writer->answered == writer->asked) {
        return -1;
    }
    /* a slow line transfers a kilobyte per second */
    const int64_t left = writer->asked_at + LOST + (int64_t)flying(writer) - gm_clock_milliseconds();
    return left > 0 ? (int)left : 0;
}

void gm_writer_copy(struct gm_writer *writer, const char *text)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (stream) {
        fputs("\033]52;c;", stream);
        gm_base64_put(text, strlen(text), stream);
        fputs("\a", stream);
    }
    char *coded = gm_stream_end(&writing);
    if (coded) {
        put(writer, coded, writing.size);
    }
    free(coded);
}

bool gm_writer_idle(const struct gm_writer *writer)
{
    return writer->sent == writer->length;
}

bool gm_writer_send(struct gm_writer *writer)
{
    while (writer->sent < writer->length) {
        ssize_t done = write(writer->fd, writer->out + writer->sent, writer->length - writer->sent);
        if (done <= 0 && !(done < 0 && errno == EINTR)) {
            return done < 0 && errno == EAGAIN;
        }
        writer->sent += done > 0 ? (size_t)done : 0;
    }
    writer->sent = writer->length = 0;
    return !writer->failed;
}

void gm_writer_cut(struct gm_writer *writer)
{
    if (!gm_writer_idle(writer)) {
        writer->sent = writer->length = 0;
        writer->known = false;
        gm_writer_tell(writer, "\033\\");
    }
}

bool gm_writer_open(struct gm_writer *writer, const struct gm_terminal *terminal)
{
    *writer = (struct gm_writer){.fd = -1,
                                 .colours = terminal->colours,
                                 .theme = terminal->theme,
                                 .asks = terminal->answers.attributes,
                                 .trip = terminal->asked,
                                 .bound = ON_THE_WAY};
    writer->row = -1;
    writer->foreground = writer->background = -1;
    writer->place = gm_capability("cup");
    writer->plain = gm_capability("sgr0");
    writer->strong = gm_capability("bold");
    writer->reversed = gm_capability("rev");
    writer->set_foreground = gm_capability("setaf");
    writer->set_background = gm_capability("setab");
    if (!writer->set_background) {
        writer->set_foreground = NULL;
    }
    writer->bright = gm_curses()->tigetnum("colors") >= 16 || !writer->set_foreground;
    writer->corner = gm_curses()->tigetflag("am") <= 0 || gm_curses()->tigetflag("xenl") > 0;
    /* A second descriptor can be non-blocking without changing the shell's. */
    const char *name = ttyname(STDOUT_FILENO);
    if (name) {
        writer->fd = open(name, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    }
    writer->own_fd = writer->fd >= 0;
    if (!writer->own_fd) {
        writer->fd = STDOUT_FILENO;
    }
    if (writer->colours == GM_COLOURS_256) {
        size_t size = (size_t)1 << 15;
        writer->nearest = malloc(size * sizeof *writer->nearest);
        if (!writer->nearest) {
            gm_writer_close(writer);
            return false;
        }
        for (size_t i = 0; i < size; i++) {
            writer->nearest[i] = -1;
        }
    }
    return true;
}

void gm_writer_close(struct gm_writer *writer)
{
    for (int tries = 0; tries < 10 && !gm_writer_idle(writer) && gm_writer_send(writer); tries++) {
        poll(&(struct pollfd){.fd = writer->fd, .events = POLLOUT}, 1, 50);
    }
    if (writer->own_fd) {
        close(writer->fd);
    }
    free(writer->out);
    free(writer->shown.cells);
    free(writer->nearest);
    *writer = (struct gm_writer){.fd = -1};
}
