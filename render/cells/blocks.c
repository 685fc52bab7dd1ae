/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sub-pixels as characters: half blocks, quadrants, braille and ASCII. */
#include "render/cells/grid.h"

#include <stdlib.h>
#include <string.h>

void gm_blocks_grid(enum gm_blocks blocks, int *columns, int *rows, bool *sharp)
{
    *columns = blocks == GM_HALF_BLOCKS ? 1 : 2;
    *rows = blocks == GM_BRAILLE || blocks == GM_ASCII ? 4 : 2;
    *sharp = blocks == GM_BRAILLE || blocks == GM_ASCII;
}

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

void gm_blocks_glyphs(struct gm_cells *cells, const struct gm_raster *raster, const struct gm_raster *areas,
                      enum gm_blocks blocks)
{
    struct gm_rgb paper = gm_theme_colour(raster->theme, GM_PAPER),
                  ink = gm_theme_colour(raster->theme, GM_INK);
    int across, down;
    bool sharp;
    gm_blocks_grid(blocks, &across, &down, &sharp);
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
