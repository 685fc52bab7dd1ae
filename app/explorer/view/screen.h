/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_SCREEN_H
#define GM_APP_EXPLORER_VIEW_SCREEN_H

#include "app/explorer/view/sheet.h"
#include "app/lanes/shot.h"
#include "app/tours/tour.h"
#include "render/files/inline_image.h"

/* What is on the screen: the picture at the left, the side panel at the right, a status line below; or a page
   of help. All of it is composed as cells; nothing here knows the terminal. */

struct gm_screen {
    struct gm_cells cells;
    struct gm_cells picture; /* kept, as it changes less often than what is around it */
    bool fresh;              /* the kept picture shows the last shot */
    enum gm_blocks blocks;   /* and was painted with these */
    enum gm_theme theme;
    int picture_column, picture_row; /* where it is */
    struct gm_inline_place pixels; /* cells for a picture of pixels, all without a glyph; no columns: none */
    struct gm_hits hits;           /* what can be clicked */
};

bool gm_screen_resize(struct gm_screen *screen, int columns, int rows);
/* Gives cells a size and empties them; false when memory is short. */
bool gm_cells_resize(struct gm_cells *cells, int columns, int rows, enum gm_theme theme);
void gm_screen_close(struct gm_screen *screen);

/* Composes the screen. `fresh` says that the shot's picture is a new one. */
void gm_screen_draw(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot, bool fresh);

/* The start: the scenes found, and behind them the tours, number `choice` of all marked; `shot` is a look at
   that scene, or NULL where there is none yet, and `said` why it cannot be looked at, or "". */
struct gm_start_entry {
    const struct gm_scene *scene; /* one of the two is NULL */
    const struct gm_tour *tour;
};
enum { GM_START_ENTRIES = 128 };
struct gm_start {
    struct gm_start_entry found[GM_START_ENTRIES];
    size_t count, choice;
    size_t scenes;               /* so many of them are scenes */
    int ranks[GM_START_ENTRIES]; /* how well each answers what was typed */
    char typed[GM_TYPED];
};
void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said);

/* The schemes that fit and in which everything typed is found: what is called so comes first, then those of
   the scene. Returns how many. */
size_t gm_schemes_found(const struct gm_face *face, const struct gm_shot *shot,
                        const struct gm_scheme *found[GM_SHOT_SCHEMES]);
/* How well the texts (the name first, NULL ends them) answer what was typed, capitals or not: 0 at best, by
   the typed word that fares worst. A text that is the word is better than one that begins with it, then comes
   the beginning of a word in it, then any other place; below 0: a typed word is nowhere. */
enum { GM_SEARCH_TEXTS = 8 };
int gm_search_rank(const char *typed, const char *const *texts);
/* Puts a rank behind those from `first` to `count` that are as good, where there is room for one more.
   Returns its place. */
size_t gm_search_place(int *ranks, size_t first, size_t count, int rank);

/* ---- shared by the files that compose ---- */

/* A hint in the status line: a key and a word. */
struct gm_hint {
    const char *key, *word;
    int code; /* of the key, for a click */
};
/* As many hints as fit at the right of row 0; returns the column where they begin. */
int gm_hints_draw(const struct gm_sheet *sheet, int from, const struct gm_hint *hints);

/* The whole screen, blank; the rows of the status line, and its rule. */
struct gm_sheet gm_screen_clear(struct gm_screen *screen, const struct gm_face *face);
int gm_screen_status_rows(const struct gm_cells *cells);
void gm_screen_rule(const struct gm_sheet *whole, int side);
/* What does not fit beside the hints, and answers the user, has rows of its own above the last one, as many
   as it takes up to a third of them. */
void gm_screen_say_above(const struct gm_sheet *whole, const char *text);
/* Paints the shot's picture, or copies it where it was painted before. */
void gm_screen_picture(struct gm_screen *screen, const struct gm_face *face, const struct gm_shot *shot,
                       int column, int row, int columns, int rows);

void gm_status_draw(const struct gm_sheet *whole, const struct gm_shot *shot, int side);
void gm_speed_text(const struct gm_shot *shot, char *text, size_t size);
void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);
void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);
/* Where running ahead goes if no time is typed. */
void gm_ahead_text(const struct gm_shot *shot, char *text, size_t size);
/* A page over all rows but those of the status line, with its keys there. The shot may be NULL for
   GM_PAGE_START. */
void gm_screen_draw_page(const struct gm_sheet *whole, struct gm_face *face, const struct gm_shot *shot);
/* The page of help, or of a scheme. */
void gm_page_draw(const struct gm_sheet *sheet, struct gm_face *face, const struct gm_shot *shot);

#endif
