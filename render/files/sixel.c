/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of a picture are counted in a grid of 64^3. Their set is cut in two again and again: always the
 * part with the greatest sum of squared deviations, through its mean. So the colours of the paper and of
 * every line are kept, whatever their share, and shades of a field are spaced evenly.
 *
 * libchafa 1.12, tried first, chose 23 colours for a picture of two lanes: a red circle became orange, the
 * mean error was five times as large, the time the same. */
#include "render/files/images.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/grow.h"

enum { COLOURS = 256, BAND = 6, SHIFT = 2, SIDE_BITS = 8 - SHIFT, CELLS = 1 << 3 * SIDE_BITS };

/* A cell of the grid of colours: the pixels in it. */
struct cell {
    uint32_t count, sum[3];
    uint8_t colour; /* number in the palette */
};

/* A set of colours: a part of the list of cells. */
struct part {
    uint32_t first, end;
    double deviation; /* the greatest of the three channels' sums of squared deviations */
    int channel;      /* the channel that has it */
    double mean;      /* the mean of this channel */
};

struct gm_sixel {
    struct cell cells[CELLS];
    uint32_t used[CELLS]; /* the numbers of the cells that are not empty */
    size_t used_count;
    struct part parts[COLOURS];
    uint8_t palette[COLOURS][3];
    /* the picture in numbers of the palette, and for each of them a band's sixels */
    uint8_t *pixels, *bands;
    char *text; /* of a band */
    size_t pixel_room, band_room, text_room;
};

struct gm_sixel *gm_sixel_open(void)
{
    return calloc(1, sizeof(struct gm_sixel));
}

void gm_sixel_close(struct gm_sixel *sixel)
{
    if (sixel) {
        free(sixel->pixels);
        free(sixel->bands);
        free(sixel->text);
    }
    free(sixel);
}

/* ---- colours ---- */

static uint32_t cell_of(const unsigned char *rgb)
{
    return (uint32_t)(rgb[0] >> SHIFT) << 2 * SIDE_BITS | (uint32_t)(rgb[1] >> SHIFT) << SIDE_BITS |
           (uint32_t)(rgb[2] >> SHIFT);
}

static bool same(const unsigned char *a, const unsigned char *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Returns the number of pixels from x on with the colour of the one at x. */
static int run_length(const unsigned char *line, int x, int width)
{
    int end = x + 1;
    while (end < width && same(line + 3 * (size_t)x, line + 3 * (size_t)end)) {
        end++;
    }
    return end - x;
}

static void count_colours(struct gm_sixel *sixel, const unsigned char *rgb, size_t stride, int width,
                          int height)
{
    sixel->used_count = 0;
    for (int y = 0; y < height; y++) {
        const unsigned char *line = rgb + (size_t)y * stride;
        for (int x = 0, run; x < width; x += run) {
            const unsigned char *pixel = line + 3 * (size_t)x;
            run = run_length(line, x, width);
            uint32_t number = cell_of(pixel);
            struct cell *cell = &sixel->cells[number];
            if (cell->count == 0) {
                sixel->used[sixel->used_count++] = number;
            }
            cell->count += (uint32_t)run;
            for (int i = 0; i < 3; i++) {
                cell->sum[i] += (uint32_t)run * pixel[i];
            }
        }
    }
}

static double cell_mean(const struct cell *cell, int channel)
{
    return (double)cell->sum[channel] / cell->count;
}

static void measure(const struct gm_sixel *sixel, struct part *part)
{
    double count = 0, sum[3] = {0}, squares[3] = {0};
    for (uint32_t i = part->first; i < part->end; i++) {
        const struct cell *cell = &sixel->cells[sixel->used[i]];
        count += cell->count;
        for (int k = 0; k < 3; k++) {
            sum[k] += cell->sum[k];
            squares[k] += cell->sum[k] * cell_mean(cell, k);
        }
    }
    part->deviation = -1;
    for (int k = 0; k < 3; k++) {
        double deviation = squares[k] - sum[k] * sum[k] / count;
        if (deviation > part->deviation) {
            part->deviation = deviation;
            part->channel = k;
            part->mean = sum[k] / count;
        }
    }
    if (part->end - part->first < 2) {
        part->deviation = 0;
    }
}

/* Cuts a part at its mean. Returns the start of the second half. */
static uint32_t cut(struct gm_sixel *sixel, const struct part *part)
{
    uint32_t low = part->first, high = part->end;
    while (low < high) {
        uint32_t number = sixel->used[low];
        if (cell_mean(&sixel->cells[number], part->channel) <= part->mean) {
            low++;
        } else {
            sixel->used[low] = sixel->used[--high];
            sixel->used[high] = number;
        }
    }
    return low;
}

/* Returns the number of colours; each cell stores its own. */
static int choose_colours(struct gm_sixel *sixel)
{
    int count = 1;
    sixel->parts[0] = (struct part){.end = (uint32_t)sixel->used_count};
    measure(sixel, &sixel->parts[0]);
    while (count < COLOURS) {
        struct part *widest = &sixel->parts[0];
        for (int i = 1; i < count; i++) {
            if (sixel->parts[i].deviation > widest->deviation) {
                widest = &sixel->parts[i];
            }
        }
        uint32_t middle = widest->deviation > 0 ? cut(sixel, widest) : widest->end;
        if (middle == widest->first || middle == widest->end) { /* all that is left is round-off */
            break;
        }
        sixel->parts[count] = (struct part){.first = middle, .end = widest->end};
        widest->end = middle;
        measure(sixel, widest);
        measure(sixel, &sixel->parts[count++]);
    }
    for (int i = 0; i < count; i++) {
        uint64_t all = 0, sum[3] = {0};
        for (uint32_t k = sixel->parts[i].first; k < sixel->parts[i].end; k++) {
            struct cell *cell = &sixel->cells[sixel->used[k]];
            cell->colour = (uint8_t)i;
            all += cell->count;
            for (int channel = 0; channel < 3; channel++) {
                sum[channel] += cell->sum[channel];
            }
        }
        for (int channel = 0; channel < 3; channel++) { /* in percent, the unit of sixels */
            sixel->palette[i][channel] = (uint8_t)((double)sum[channel] / (double)all * (100.0 / 255) + 0.5);
        }
    }
    return count;
}

/* Converts the pixels, and empties the grid for the next picture. */
static void map_pixels(struct gm_sixel *sixel, const unsigned char *rgb, size_t stride, int width, int height)
{
    uint8_t *to = sixel->pixels;
    for (int y = 0; y < height; y++) {
        const unsigned char *line = rgb + (size_t)y * stride;
        for (int x = 0, run; x < width; x += run, to += run) {
            run = run_length(line, x, width);
            memset(to, sixel->cells[cell_of(line + 3 * (size_t)x)].colour, (size_t)run);
        }
    }
    for (size_t i = 0; i < sixel->used_count; i++) {
        sixel->cells[sixel->used[i]] = (struct cell){0};
    }
}

/* ---- bytes ---- */

/* Returns the end of a number that is written at `to`; so do the next two. */
static char *put_number(char *to, unsigned number)
{
    to = number > 9 ? put_number(to, number / 10) : to;
    *to = (char)('0' + number % 10);
    return to + 1;
}

static char *put_run(char *to, uint8_t bits, int count)
{
    if (count > 3) {
        *to++ = '!';
        to = put_number(to, (unsigned)count);
        count = 1;
    }
    memset(to, '?' + bits, (size_t)count);
    return to + count;
}

/* Writes one colour of a band, from the first to the last column that has it. */
static char *put_line(char *to, unsigned colour, const uint8_t *bits, int first, int last)
{
    *to++ = '#';
    to = put_run(put_number(to, colour), 0, first);
    for (int x = first; x <= last;) {
        int end = x + 1;
        while (end <= last && bits[end] == bits[x]) {
            end++;
        }
        to = put_run(to, bits[x], end - x);
        x = end;
    }
    return to;
}

static bool put_band(struct gm_sixel *sixel, const uint8_t *pixels, int width, int rows, FILE *out)
{
    int first[COLOURS], last[COLOURS];
    uint8_t present[COLOURS];
    int count = 0;
    memset(last, -1, sizeof last);
    for (int y = 0; y < rows; y++) {
        for (int x = 0; x < width; x++) {
            uint8_t colour = pixels[(size_t)y * (size_t)width + (size_t)x];
            uint8_t *bits = sixel->bands + (size_t)colour * (size_t)width;
            if (last[colour] < 0) {
                present[count++] = colour;
                first[colour] = last[colour] = x;
                memset(bits, 0, (size_t)width);
            }
            first[colour] = x < first[colour] ? x : first[colour];
            last[colour] = x > last[colour] ? x : last[colour];
            bits[x] |= (uint8_t)(1 << y);
        }
    }
    if (!gm_grow(&sixel->text, &sixel->text_room, (size_t)count * ((size_t)width + 16), 1)) {
        return false;
    }
    char *to = sixel->text;
    for (int i = 0; i < count; i++) {
        const unsigned colour = present[i];
        if (i > 0) {
            *to++ = '$';
        }
        to = put_line(to, colour, sixel->bands + (size_t)colour * (size_t)width, first[colour], last[colour]);
    }
    fwrite(sixel->text, 1, (size_t)(to - sixel->text), out);
    return true;
}

bool gm_sixel_encode(struct gm_sixel *sixel, const unsigned char *rgb, size_t stride, int width, int height,
                     FILE *out)
{
    if (!gm_grow(&sixel->pixels, &sixel->pixel_room, (size_t)width * (size_t)height, 1) ||
        !gm_grow(&sixel->bands, &sixel->band_room, (size_t)width, COLOURS)) {
        return false;
    }
    count_colours(sixel, rgb, stride, width, height);
    const int colours = choose_colours(sixel);
    map_pixels(sixel, rgb, stride, width, height);
    /* square pixels; pixels that are not drawn stay as they were */
    fprintf(out, "\033P0;1;0q\"1;1;%d;%d", width, height);
    for (int i = 0; i < colours; i++) {
        fprintf(out, "#%d;2;%d;%d;%d", i, sixel->palette[i][0], sixel->palette[i][1], sixel->palette[i][2]);
    }
    for (int y = 0; y < height; y += BAND) {
        const int rows = height - y < BAND ? height - y : BAND;
        fputs(y > 0 ? "-" : "", out); /* no new line after the last: it could make the screen scroll */
        if (!put_band(sixel, sixel->pixels + (size_t)y * (size_t)width, width, rows, out)) {
            return false;
        }
    }
    fputs("\033\\", out);
    return true;
}
