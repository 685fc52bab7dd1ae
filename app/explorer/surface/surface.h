/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_SURFACE_H
#define GM_APP_EXPLORER_SURFACE_SURFACE_H

#include <stddef.h>

#include "app/explorer/worker/session.h"
#include "app/runs/session.h"
#include "core/scheme.h"
#include "render/cells/grid.h"
#include "render/files/images.h"

/* The user's settings of the screen. */

struct gm_guide;
struct gm_typed_prompt;
struct gm_studies;

enum gm_page {
    GM_PAGE_SCENE, /* no page: the scene, or the list of scenes */
    GM_PAGE_HELP,
    GM_PAGE_SCHEME,
    GM_PAGE_COMMAND,
    GM_PAGE_INVARIANTS,
    GM_PAGE_START, /* the help of the list of scenes */
};

/* The purpose of the list of schemes. */
enum gm_choosing { GM_CHOOSE_NOTHING, GM_CHOOSE_SWITCH, GM_CHOOSE_FORK };

/* The purpose of a typed line. */
enum gm_prompt { GM_PROMPT_NONE, GM_PROMPT_AHEAD, GM_PROMPT_VALUE };

/* The number of keys of ncurses. */
enum { GM_KEY_NUMBERS = 1024 };

/* The sections in the side panel. */
enum gm_side_panel {
    GM_SIDE_ALL,
    GM_SIDE_SCHEMES,
    GM_SIDE_PARAMETERS,
    GM_SIDE_OBSERVED,
    GM_SIDE_NONE, /* the picture has the whole screen */
    GM_SIDE_COUNT,
};

struct gm_face {
    enum gm_blocks blocks;
    enum gm_inline_kind pixels; /* the picture uses pixels, unless all is monochrome */
    enum gm_theme theme;
    bool few_colours;
    bool monochrome;      /* only ink and paper are used */
    bool only_monochrome; /* the terminal has no colours */
    enum gm_page page;
    bool awaited; /* a page that the worker's next shot opens; keys typed ahead are for it */
    const struct gm_scheme *explained; /* the scheme that a page explains */
    const char *measured; /* the lines of the last command (struct gm_measure); NULL before it has ended */
    int scroll;           /* lines of the page above the screen */
    size_t command;       /* index of the copied command line */
    enum gm_choosing choosing;
    const struct gm_scheme *choice;
    enum gm_prompt prompt;
    char typed[GM_TYPED]; /* the typed search or answer */
    size_t parameter;     /* index of the parameter that left and right change */
    enum gm_side_panel side;
    bool explaining;                            /* the status line explains that parameter */
    unsigned long read;                         /* number of the last message that was dismissed */
    const struct gm_scene *watched;             /* the scene whose `watch` was shown last; it may be freed */
    int64_t watch_until;                        /* time (ms) at which the `watch` sentence ends; 0: it has */
    char hint[80];                              /* on a key without a meaning */
    int64_t hint_until;                         /* time (ms) at which it ends */
    uint32_t hinted[GM_KEY_NUMBERS / 32];       /* a bit for every key that had its hint */
    const char *loss;                           /* what would be lost by quitting, while that is asked */
    const struct gm_guide *guide;               /* the tour's guide; NULL without a tour */
    const struct gm_typed_prompt *typed_prompt; /* the prompt, if the screen has one, else NULL */
    struct gm_studies *studies;                 /* the background studies; NULL if not available */
};

/* Adds a letter to a line of GM_TYPED bytes, or deletes its last one; returns false for other keys. */
bool gm_typed_key(char *typed, int key);

/* A rectangle of the screen to write in, and its clickable parts. */

/* The effect of a click. */
enum gm_hit_kind {
    GM_HIT_KEY,       /* presses key `index` */
    GM_HIT_SCENE,     /* chooses entry `index` of the start screen's list */
    GM_HIT_LANE,      /* selects lane `index` */
    GM_HIT_SCHEME,    /* gives the selected lane `scheme` */
    GM_HIT_PARAMETER, /* chooses parameter `index` */
    GM_HIT_SLIDER,    /* chooses parameter `index` and sets it */
    GM_HIT_PAST,      /* shows that part of the past */
    GM_HIT_PICTURE,   /* restarts from that point */
};

struct gm_hit {
    enum gm_hit_kind kind;
    size_t index;
    const struct gm_scheme *scheme;
    int column, row, width, height; /* cells of the screen, set by gm_sheet_hit; a height of 0 becomes 1 */
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

/* Returns a part of a sheet, given in the sheet's coordinates. */
struct gm_sheet gm_sheet_part(const struct gm_sheet *sheet, int column, int row, int width, int height);

/* Writes in the sheet's coordinates and stays in it; returns the text's width in cells. */
int gm_sheet_text(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold);
/* Like gm_sheet_text; a text that does not fit ends with an ellipsis. */
void gm_sheet_cut(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                  bool bold);
/* Like gm_sheet_text, with the text's end at `column` (exclusive). */
void gm_sheet_right(const struct gm_sheet *sheet, int column, int row, const char *text, enum gm_role role,
                    bool bold);
void gm_sheet_glyph(const struct gm_sheet *sheet, int column, int row, uint32_t glyph, enum gm_role role,
                    bool bold);
int gm_sheet_width(const struct gm_sheet *sheet, const char *text);
/* Draws a bar with a mark at `position`, 0 to 1, emphasised if `chosen`. */
void gm_sheet_slider(const struct gm_sheet *sheet, int from, int to, int row, double position, bool chosen);
/* Breaks a text of one or several lines at blanks, and long words at commas or anywhere, into at most `rows` rows from (column,
   row) on. A text that does not fit ends with an ellipsis. Returns the rows used. */
int gm_sheet_wrapped(const struct gm_sheet *sheet, int column, int row, int rows, const char *text,
                     enum gm_role role);

/* Writes hints "keys:word|keys:word" as far as they fit, at the right of row 0 from column `from` on. A click on one
   presses the first of its keys. Returns the column of the first hint. */
int gm_sheet_hints(const struct gm_sheet *sheet, int from, const char *hints);

/* A picture painted as blocks, cached until it changes. */
struct gm_painting {
    struct gm_cells cells;
    bool fresh;            /* the cells show the picture */
    enum gm_blocks blocks; /* the blocks of the cells */
    enum gm_theme theme;
};
/* Fills the sheet, which is not empty, with the picture. */
void gm_sheet_paint(const struct gm_sheet *sheet, struct gm_painting *painting, struct gm_picture *picture);

/* Resizes cells, whose content becomes undefined; returns false when out of memory. */
bool gm_cells_resize(struct gm_cells *cells, int columns, int rows);

/* Makes cells clickable, in one row or in hit.height rows. */
void gm_sheet_hit(const struct gm_sheet *sheet, int column, int row, int width, struct gm_hit hit);

/* A line of text, edited at any place and scrolled sideways if it is too long. */

enum { GM_EDIT = 8192 }; /* bytes; a longer text belongs in a file */

struct gm_edit {
    char text[GM_EDIT];
    size_t length, at; /* the cursor precedes byte `at` */
    size_t refused;    /* letters refused since the last accepted one */
};

/* Sets the text, cut to GM_EDIT - 1 bytes, and the cursor before byte `at`, or at the end. */
void gm_edit_set(struct gm_edit *line, const char *text, size_t at);
/* Handles a key: a byte of a letter, a move or a deletion; ignores control characters. Returns false for
   other keys. */
bool gm_edit_press(struct gm_edit *line, int key);

/* Draws the line in one row; its cursor is a cell of its own and always visible. */
void gm_edit_draw(const struct gm_sheet *sheet, int row, const struct gm_edit *line);
/* Returns the column of byte `at`, or the nearest edge if it is not visible. */
int gm_edit_column(const struct gm_sheet *sheet, const struct gm_edit *line, size_t at);

/* The screen as cells, hits and a picture, independent of the terminal. */

struct gm_screen {
    struct gm_cells cells;
    struct gm_painting picture;      /* cached, as it changes less often than the rest */
    int picture_column, picture_row; /* the picture's first cell */
    struct gm_inline_place pixels;   /* cells without a glyph, for a picture of pixels; no columns: none */
    struct gm_hits hits;             /* the clickable parts */
};

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows);
void gm_screen_close(struct gm_screen *screen);

/* Clears the screen; returns a sheet of all of it. */
struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face);
/* The smallest screen with room for a panel and a rule, and for a row of keys that messages leave free. */
enum { GM_SCREEN_COLUMNS = 60, GM_SCREEN_ROWS = 12, GM_SCREEN_ROWS_OF_KEYS = 20 };
/* Returns the rows below the rest: 2 (a rule and the last row), 1 or 0. */
int gm_screen_rows_below(const struct gm_cells *cells);
/* Draws the rule with `below` - 1 rows below it, and the line at the left of a panel of `side` columns; 0:
   no panel. */
void gm_screen_rule(const struct gm_sheet *whole, int below, int side);
/* Draws the rule without a panel, if there is room; returns the last row. */
struct gm_sheet gm_screen_foot(const struct gm_sheet *whole);
/* Writes a text that does not fit beside the hints above the last row, in at most a third of the rows. */
void gm_screen_say_above(const struct gm_sheet *whole, const char *text);
/* Draws the question whether to quit with face->loss, over the rows at the bottom. */
void gm_screen_ask(struct gm_screen *screen, const struct gm_face *face);
/* Paints the shot's picture, or leaves its cells to the pixels. */
void gm_screen_picture(struct gm_screen *screen, const struct gm_sheet *sheet, const struct gm_shot *shot);

/* A search that ignores case. */

/* Returns the rank of the texts (at most GM_SEARCH_TEXTS, name first, then NULL) for the typed words: 0 is
   best, -1 if a word is in no text. The worst word counts. A whole text beats the start of a text, then
   the start of a word, then any place. */
enum { GM_SEARCH_TEXTS = 8 };
int gm_search_rank(const char *typed, const char *const *texts);
/* Inserts a rank into the sorted ranks[first..count), after equal ones; the array has room for it. Returns
   its index. */
size_t gm_search_place(int *ranks, size_t first, size_t count, int rank);

#endif
