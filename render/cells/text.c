/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text in character cells. */
#include "render/cells/text.h"

#include <stdlib.h>
#include <string.h>

uint32_t gm_text_next(const char **text)
{
    const unsigned char *at = (const unsigned char *)*text;
    if (at[0] == 0) {
        return 0;
    }
    int more = at[0] < 0x80 ? 0 : at[0] >= 0xF0 ? 3 : at[0] >= 0xE0 ? 2 : at[0] >= 0xC0 ? 1 : -1;
    if (more < 0 || at[0] > 0xF4) {
        *text += 1;
        return 0xFFFD;
    }
    uint32_t code = more == 0 ? at[0] : at[0] & (0x3Fu >> more);
    for (int i = 1; i <= more; i++) {
        if ((at[i] & 0xC0) != 0x80) {
            *text += i;
            return 0xFFFD;
        }
        code = code << 6 | (at[i] & 0x3F);
    }
    *text += more + 1;
    static const uint32_t least[] = {0, 0x80, 0x800, 0x10000}; /* the least code point of this length */
    return code < least[more] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000) ? 0xFFFD : code;
}

size_t gm_text_put(uint32_t code, char bytes[GM_TEXT_BYTES])
{
    static const unsigned char lead[] = {0, 0xC0, 0xE0, 0xF0};
    const int more = (code >= 0x80) + (code >= 0x800) + (code >= 0x10000); /* bytes after the first */
    bytes[0] = (char)(lead[more] | code >> 6 * more);
    for (int i = 1; i <= more; i++) {
        bytes[i] = (char)(0x80 | (code >> 6 * (more - i) & 0x3F));
    }
    return 1 + (size_t)more;
}

bool gm_text_is_shown(uint32_t code)
{
    static const struct {
        uint32_t first, last;
    } hidden[] = {
        {0, 0x1F},        {0x7F, 0x9F},       {0xAD, 0xAD},        {0x61C, 0x61C},   {0x180E, 0x180E},
        {0x200B, 0x200F}, {0x2028, 0x202E},   {0x2060, 0x206F},    {0xFEFF, 0xFEFF}, {0xFFF0, 0xFFFB},
        {0xFFFD, 0xFFFF}, {0x1D173, 0x1D17A}, {0xE0000, 0x10FFFF},
    };
    for (size_t i = 0; i < sizeof hidden / sizeof hidden[0]; i++) {
        if (code >= hidden[i].first && code <= hidden[i].last) {
            return false;
        }
    }
    return true;
}

bool gm_text_is_plain(const char *text)
{
    for (uint32_t code; (code = gm_text_next(&text)) != 0;) {
        if (!gm_text_is_shown(code)) {
            return false;
        }
    }
    return true;
}

char *gm_text_tame(char *text)
{
    char *to = text;
    for (const char *at = text; *at;) {
        const char *from = at;
        if (gm_text_is_shown(gm_text_next(&at))) {
            while (from < at) {
                *to++ = *from++;
            }
        } else {
            *to++ = '?';
        }
    }
    *to = '\0';
    return text;
}

static const struct spelling {
    uint32_t code;
    const char *letters;
} spellings[] = {
    /* sorted by code, for bsearch */
    {0x00A0, " "},     {0x00AB, "<<"},    {0x00B0, "deg"},   {0x00B1, "+-"},     {0x00B2, "^2"},
    {0x00B3, "^3"},    {0x00B7, "."},     {0x00B9, "^1"},    {0x00BB, ">>"},     {0x00BD, "1/2"},
    {0x00C5, "A"},     {0x00D7, "x"},     {0x00E4, "a"},     {0x00E9, "e"},      {0x00F6, "o"},
    {0x00F8, "o"},     {0x00FC, "u"},     {0x0302, "^"},     {0x0307, "'"},      {0x0393, "Gamma"},
    {0x0394, "D"},     {0x03A3, "Sum"},   {0x03A6, "Phi"},   {0x03A8, "Psi"},    {0x03A9, "Omega"},
    {0x03B1, "alpha"}, {0x03B2, "beta"},  {0x03B3, "gamma"}, {0x03B4, "d"},      {0x03B5, "eps"},
    {0x03B7, "eta"},   {0x03B8, "theta"}, {0x03BA, "kappa"}, {0x03BB, "lambda"}, {0x03BC, "mu"},
    {0x03BD, "nu"},    {0x03BE, "xi"},    {0x03C0, "pi"},    {0x03C1, "rho"},    {0x03C3, "sigma"},
    {0x03C4, "tau"},   {0x03C6, "phi"},   {0x03C7, "chi"},   {0x03C8, "psi"},    {0x03C9, "omega"},
    {0x2009, " "},     {0x2010, "-"},     {0x2013, "-"},     {0x2014, "-"},      {0x2016, "||"},
    {0x2018, "'"},     {0x2019, "'"},     {0x201C, "\""},    {0x201D, "\""},     {0x2022, "*"},
    {0x2026, "..."},   {0x2032, "'"},     {0x2070, "^0"},    {0x2074, "^4"},     {0x2075, "^5"},
    {0x2076, "^6"},    {0x2077, "^7"},    {0x2078, "^8"},    {0x2079, "^9"},     {0x207A, "^+"},
    {0x207B, "^-"},    {0x207F, "^n"},    {0x2080, "0"},     {0x2081, "1"},      {0x2082, "2"},
    {0x2083, "3"},     {0x2084, "4"},     {0x2085, "5"},     {0x2086, "6"},      {0x2087, "7"},
    {0x2088, "8"},     {0x2089, "9"},     {0x208A, "+"},     {0x208B, "-"},      {0x2090, "a"},
    {0x2095, "h"},     {0x2099, "n"},     {0x2190, "<-"},    {0x2191, "^"},      {0x2192, "->"},
    {0x2193, "v"},     {0x21BA, "@"},     {0x2202, "d"},     {0x2206, "D"},      {0x2207, "grad"},
    {0x2211, "Sum"},   {0x2212, "-"},     {0x221A, "sqrt"},  {0x221E, "inf"},    {0x222B, "int"},
    {0x2248, "~"},     {0x2260, "!="},    {0x2264, "<="},    {0x2265, ">="},     {0x22C5, "."},
    {0x2500, "-"},     {0x2501, "="},     {0x2502, "|"},     {0x2504, "~"},      {0x2505, "~"},
    {0x2508, "."},     {0x2534, "+"},     {0x254C, "~"},     {0x254D, "~"},      {0x2581, "_"},
    {0x25B8, ">"},     {0x25CB, "o"},     {0x25CC, ":"},     {0x25CF, "*"},      {0x25D0, "%"},
    {0x2715, "x"},
};

static int by_code(const void *key, const void *row)
{
    uint32_t code = *(const uint32_t *)key, other = ((const struct spelling *)row)->code;
    return (code > other) - (code < other);
}

const char *gm_text_ascii(uint32_t code)
{
    const struct spelling *found =
        bsearch(&code, spellings, sizeof spellings / sizeof *spellings, sizeof *spellings, by_code);
    return found ? found->letters : "?";
}

/* A run of raised figures is one exponent: only its first sign is spelled "^". */
static bool is_raised(uint32_t code)
{
    return code == 0xB2 || code == 0xB3 || code == 0xB9 || (code >= 0x2070 && code <= 0x207F);
}

/* The code points of a text as they are shown. */
struct reader {
    const char *text;
    const char *letters; /* the rest of a spelling */
    bool ascii, raised;
};

static uint32_t read_next(struct reader *reader)
{
    if (reader->letters && *reader->letters) {
        return (unsigned char)*reader->letters++;
    }
    uint32_t code = gm_text_next(&reader->text);
    while (!reader->ascii && code >= 0x300 && code < 0x370) { /* an accent would need a cell of its own */
        code = gm_text_next(&reader->text);
    }
    if (code != 0 && !gm_text_is_shown(code)) {
        code = code < ' ' ? ' ' : 0xFFFD;
    }
    if (!reader->ascii || code < 0x7F) {
        reader->raised = false;
        return code;
    }
    reader->letters = gm_text_ascii(code);
    if (is_raised(code) && reader->raised && *reader->letters == '^') {
        reader->letters++;
    }
    reader->raised = is_raised(code);
    return (unsigned char)*reader->letters++;
}

int gm_text_width(const char *text, bool ascii)
{
    struct reader reader = {.text = text, .ascii = ascii};
    int width = 0;
    while (read_next(&reader) != 0) {
        width++;
    }
    return width;
}

int gm_cells_text(struct gm_cells *cells, int column, int row, int limit, const char *text,
                  const struct gm_text_look *look)
{
    struct reader reader = {.text = text, .ascii = look->ascii};
    int width = 0;
    for (uint32_t code; (limit < 0 || width < limit) && (code = read_next(&reader)) != 0; width++) {
        int at = column + width;
        if (row < 0 || row >= cells->rows || at < 0 || at >= cells->columns) {
            continue;
        }
        struct gm_cell *cell = &cells->cells[(size_t)row * (size_t)cells->columns + (size_t)at];
        cell->glyph = code;
        cell->foreground = gm_theme_colour(look->theme, look->role);
        cell->role = look->role;
        cell->bold = look->bold;
    }
    return width;
}
