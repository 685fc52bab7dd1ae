/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_SHEET_H
#define GM_APP_EXPLORER_SURFACE_SHEET_H

#include "app/explorer/surface/face.h"

/* A rectangle of the screen to write in, and what a click on it means. */

/* What a click does. */
enum gm_hit_kind {
    GM_HIT_KEY,       /* the same as key `index` */
    GM_HIT_SCENE,     /* of the start screen: a scene or a tour, entry `index` of those found */
    GM_HIT_LANE,      /* selects lane `index` */
    GM_HIT_SCHEME,    /* `scheme` for the selected lane */
    GM_HIT_PARAMETER, /* chooses parameter `index` */
    GM_HIT_SLIDER,    /* and sets it */
    GM_HIT_PAST,      /* to that part of the past */
    GM_HIT_PICTURE,   /* starts from that point */
};

struct gm_hit {
    enum gm_hit_kind kind;
    size_t index;
    const struct gm_scheme *scheme;
    int column, row, width, height; /* on the screen; set by gm_sheet_hit */
};

enum { GM_MOST_HITS = 160 };

struct gm_hits {
    struct gm_hit hits[GM_MOST_HITS];
    size_t count;
};

struct gm_sheet {
    struct gm_cells *cells;
    const struct gm_face *face;
    int column, row, width, height;
    struct gm_hits *hits; /* NULL: nothing can be clicked */
};

/* A part of a sheet, in its coordinates. */
struct gm_sheet gm_sheet_part(const struct gm_sheet *sheet, int column, int row, int width, int height);

/* Writes in the sheet's own coordinates and stays in it; returns the cells that the text takes. */
int gm_sheet_text(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold);
/* The same; what does not fit ends with an ellipsis. */
void gm_sheet_cut(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold);
/* The same, with the text's end at `column` (exclusive). */
void gm_sheet_right(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                    bool bold);
void gm_sheet_glyph(const struct gm_sheet *sheet, int column, int row, uint32_t glyph, enum gm_role role,
                    bool bold);
int gm_sheet_width(const struct gm_sheet *sheet, const char *text);
/* A number as short as can be, with a true minus sign. */
void gm_sheet_number(double value, char *text, size_t size);
/* A bar with a mark at a part of it, 0 to 1; `chosen` stands out. */
void gm_sheet_slider(const struct gm_sheet *sheet, int from, int to, int row, double position, bool chosen);
/* Writes a text of several lines as they are; NULL: none. Returns the rows it takes. */
int gm_sheet_lines(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role);
/* Breaks a text at its blanks, and words that are too long at their commas or anywhere, in at most `rows`
   rows from `row` on, that begin at `column`; what does not fit ends with an ellipsis. Returns the rows it
   takes. */
int gm_sheet_wrapped(const struct gm_sheet *sheet, int column, int row, int rows, const char *text,
                     enum gm_role role);

/* A hint: a key and a word. */
struct gm_hint {
    const char *key, *word;
    int code; /* of the key, for a click; 0: none */
};
/* As many hints as fit at the right of row 0, from a column on; a key NULL ends them. Returns the column
   where they begin. */
int gm_sheet_hints(const struct gm_sheet *sheet, int from, const struct gm_hint *hints);

/* A picture painted as blocks, kept for as long as it is the same. */
struct gm_painting {
    struct gm_cells cells;
    bool fresh;            /* they show the picture */
    enum gm_blocks blocks; /* and were painted with these */
    enum gm_theme theme;
};
/* Fills the sheet, which is not empty, with it. */
void gm_sheet_paint(const struct gm_sheet *sheet, struct gm_painting *painting, struct gm_picture *picture);

/* Gives cells a size, their content anything; false when memory is short. */
bool gm_cells_resize(struct gm_cells *cells, int columns, int rows);
void gm_cells_clear(struct gm_cells *cells, enum gm_theme theme);

/* Makes cells of one row clickable. */
void gm_sheet_hit(const struct gm_sheet *sheet, int column, int row, int width, struct gm_hit hit);
/* What is at a cell of the screen: the one that was made last; NULL: nothing. */
const struct gm_hit *gm_hits_at(const struct gm_hits *hits, int column, int row);

#endif
