/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_SURFACE_H
#define GM_APP_EXPLORER_SURFACE_SURFACE_H

#include <stddef.h>

#include "app/explorer/worker/session.h"
#include "app/explorer/worker/worker.h"
#include "app/runs/session.h"
#include "core/scheme.h"
#include "render/cells/cells.h"
#include "render/files/images.h"

/* What the user has set about the screen itself. */

struct gm_guide;
struct gm_typed_prompt;
struct gm_studies;

enum gm_page {
    GM_PAGE_SCENE, /* none: the scene itself, or the list of scenes */
    GM_PAGE_HELP,
    GM_PAGE_SCHEME,
    GM_PAGE_COMMAND,
    GM_PAGE_START, /* help on the list of scenes */
};

/* What the chosen one of the list of schemes is for. */
enum gm_choosing { GM_CHOOSE_NOTHING, GM_CHOOSE_SWITCH, GM_CHOOSE_FORK };

/* What a typed line is for. */
enum gm_prompt { GM_PROMPT_NONE, GM_PROMPT_AHEAD, GM_PROMPT_VALUE };

/* What the side panel gives room to. */
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
    enum gm_inline_kind pixels; /* the picture is not made of blocks, unless all is monochrome */
    enum gm_theme theme;
    bool few_colours;
    bool monochrome;      /* ink and paper alone */
    bool only_monochrome; /* the terminal has no more */
    enum gm_page page;
    bool awaited; /* a page that the worker's next words open: keys typed ahead are for it */
    const struct gm_scheme *explained; /* by its page */
    const char *measured;              /* what certify says of it, line by line; NULL: not yet */
    int scroll;                        /* lines of the page above the screen */
    size_t command;                    /* the one that was copied */
    enum gm_choosing choosing;
    const struct gm_scheme *choice;
    enum gm_prompt prompt;
    char typed[GM_TYPED]; /* a search, or an answer */
    size_t parameter;     /* the one that left and right change */
    enum gm_side_panel side;
    bool explaining;                /* the status line says what that parameter is */
    unsigned long read;             /* the last message that was seen and dismissed */
    const struct gm_scene *watched; /* whose sentence on what to watch was shown last: it may be gone */
    int64_t watch_until;            /* when that gives way; 0: it has */
    const struct gm_guide *guide;   /* through a tour; NULL: there is none */
    const struct gm_typed_prompt *typed_prompt; /* that may be open; NULL: there is none */
    struct gm_studies *studies;                 /* in the background; NULL: none can be */
};

/* A key that is pressed while a scene is open: what it acts on, and what came of it. */

enum gm_key_result {
    GM_KEY_DONE,    /* all that it does */
    GM_KEY_BLOCKS,  /* another way to show pictures is wanted */
    GM_KEY_REPAINT, /* everything is to be written again */
    GM_KEY_THEME,   /* the same, in other colours */
    GM_KEY_SCENES,  /* to the list of scenes */
    GM_KEY_STUDY,   /* a diagram in the background, by the key */
    GM_KEY_MAP,     /* a map of many runs is asked for */
    GM_KEY_TOUR,    /* another step of a tour, by the key */
    GM_KEY_TYPED,   /* a system of one's own; from the list of schemes a scheme */
    GM_KEY_FILE,    /* the system of one's own to a file */
    GM_KEY_COPY,    /* the chosen command line to the clipboard */
    GM_KEY_LEAVE,
};

/* A key, and what it acts on. */
struct gm_keystroke {
    int key; /* as ncurses numbers it */
    struct gm_face *face;
    const struct gm_shot *shot;
    struct gm_worker *worker;
};

/* Which keys mean the same everywhere. */
enum { GM_KEY_REDRAW = 'L' - '@' };
bool gm_key_is_enter(int key);
bool gm_key_is_erase(int key);
bool gm_key_is_escape(int key);

/* Adds what was typed to a line of GM_TYPED bytes, or takes the last letter away; false for other keys. */
bool gm_typed_key(char *typed, int key);

/* Sends an order. */
enum gm_key_result gm_keystroke_order(const struct gm_keystroke *press, struct gm_order order);
/* Opens a page, one about a scheme. */
enum gm_key_result gm_keystroke_page(const struct gm_keystroke *press, enum gm_page page,
                                     const struct gm_scheme *scheme);

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
    int column, row, width, height; /* on the screen; set by gm_sheet_hit, the height where it is 0 */
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

/* Makes cells clickable: of one row, or of as many as the hit has. */
void gm_sheet_hit(const struct gm_sheet *sheet, int column, int row, int width, struct gm_hit hit);
/* What is at a cell of the screen: the one that was made last; NULL: nothing. */
const struct gm_hit *gm_hits_at(const struct gm_hits *hits, int column, int row);

/* A line of text that is edited anywhere in it, and scrolls sideways where it is longer than its room. */

enum { GM_EDIT = 8192 }; /* bytes; what is longer belongs in a file */

struct gm_edit {
    char text[GM_EDIT];
    size_t length, at; /* the cursor is in front of byte `at` */
    size_t refused;    /* letters that found no room since the last one that did */
};

/* A new text, as much of it as there is room for; the cursor before byte `at`, or at its end. */
void gm_edit_set(struct gm_edit *line, const char *text, size_t at);
/* A key: letters, byte by byte, and those that move or take away. False for other keys; control characters
   change nothing. */
bool gm_edit_press(struct gm_edit *line, int key);

/* Draws it in one row with its cursor, a cell of its own, in sight. */
void gm_edit_draw(const struct gm_sheet *sheet, int row, const struct gm_edit *line);
/* The column where byte `at` is drawn; at the edge where it is out of sight. */
int gm_edit_column(const struct gm_sheet *sheet, const struct gm_edit *line, size_t at);

/* The screen as cells: what is composed on it, what can be clicked, where its picture is. Nothing here knows
   the terminal. */

struct gm_screen {
    struct gm_cells cells;
    struct gm_painting picture;      /* kept, as it changes less often than what is around it */
    int picture_column, picture_row; /* where it is */
    struct gm_inline_place pixels; /* cells for a picture of pixels, all without a glyph; no columns: none */
    struct gm_hits hits;           /* what can be clicked */
};

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows);
void gm_screen_close(struct gm_screen *screen);

/* The whole screen, blank. */
struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face);
/* From so many on there is room for a panel, and for two rows below the rest. */
enum { GM_SCREEN_COLUMNS = 60, GM_SCREEN_ROWS = 12 };
/* The rows below the rest: a rule and the last one, that alone, or none. */
int gm_screen_rows_below(const struct gm_cells *cells);
/* The rule, and the line at the left of a panel of so many columns; 0: there is none. */
void gm_screen_rule(const struct gm_sheet *whole, int side);
/* What does not fit beside the hints, and answers the user, has rows of its own above the last one, as many
   as it takes up to a third of them. */
void gm_screen_say_above(const struct gm_sheet *whole, const char *text);
/* Paints the shot's picture, or leaves its cells to the pixels. */
void gm_screen_picture(struct gm_screen *screen, const struct gm_sheet *sheet, const struct gm_shot *shot);

/* How well texts answer what was typed, capitals or not. */

/* The texts (the name first, NULL ends them) against the typed words: 0 at best, by the typed word that fares
   worst. A text that is the word is better than one that begins with it, then comes the beginning of a word
   in it, then any other place; below 0: a typed word is nowhere. */
enum { GM_SEARCH_TEXTS = 8 };
int gm_search_rank(const char *typed, const char *const *texts);
/* Puts a rank behind those from `first` to `count` that are as good, where there is room for one more.
   Returns its place. */
size_t gm_search_place(int *ranks, size_t first, size_t count, int rank);

#endif
