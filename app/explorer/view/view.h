/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_VIEW_H
#define GM_APP_EXPLORER_VIEW_VIEW_H

#include "app/explorer/surface/surface.h"
#include "app/runs/session.h"
#include "app/tours/tour.h"
#include "app/words/request.h"

/* A tour in the explorer: its state, and its texts below the picture. */

struct gm_guide {
    const struct gm_tour *tour;
    size_t step;
    bool answered; /* the step's question is answered, or it has none */
    bool hinted;   /* the hint of an exercise is shown */
};

/* Returns a guide at the start of a step of the tour. */
struct gm_guide gm_guide_at(const struct gm_tour *tour, size_t step);

/* Schemes in the rows of a list: title, claims and order in columns, the formula below. */

/* Returns the claims that the shot's schemes make: only those have a column. */
unsigned gm_schemes_claims(const struct gm_shot *shot);
/* Returns true if there is no room for space between the columns. */
bool gm_schemes_narrow(const struct gm_sheet *sheet);

/* Draws a heading, and those of the columns. */
void gm_schemes_heading(const struct gm_sheet *sheet, int row, const char *text);
/* Draws a scheme's claims and order right of a title that ends at title_end. If space is short the letters
   move together. If `give_way`, an ellipsis replaces the claims, and at last both are omitted. Returns the
   column where the title must end. */
int gm_schemes_facts(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme, int title_end,
                     unsigned columns, bool give_way, enum gm_role role);
/* Draws a scheme's title, that of another one with the same steps here, and the facts. */
void gm_schemes_row(const struct gm_sheet *sheet, int column, int row, const struct gm_shot *shot,
                    const struct gm_scheme *scheme, enum gm_role role, bool bold);

/* Draws the formula with its reference down to the sheet's end; a formula that does not fit ends with an ellipsis. */
void gm_schemes_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme);

/* The start screen: the entries found, group by group. */

enum gm_start_group {
    GM_START_SCENES, /* scenes, and last the user-defined system */
    GM_START_TOURS,
    GM_START_SYSTEMS, /* systems of files */
    GM_START_ROOMS,
    GM_START_GROUPS
};
struct gm_start_entry {
    enum gm_start_group group;
    const char *name, *title;
    const char *more[2];          /* further texts that a search reads, or NULL */
    const struct gm_scene *scene; /* NULL for a file or a typed system */
    const struct gm_tour *tour;   /* NULL unless the entry is a tour */
};
#define GM_START_OWN "your own system"
#define GM_START_OWN_TITLE "A formula that you type, or a file"
enum { GM_START_ENTRIES = 512 };
struct gm_start {
    struct gm_start_entry found[GM_START_ENTRIES];
    size_t count, choice;
    int ranks[GM_START_ENTRIES]; /* the search rank of each entry */
    char typed[GM_TYPED];
};

/* Returns true for the entry of the user-defined system. */
bool gm_start_is_user(const struct gm_start_entry *entry);
/* Returns the index of the first entry of the next group, cyclically; the choice if there is only one
   group. */
size_t gm_start_next_group(const struct gm_start *start);

/* Draws the start screen. `shot` is a preview of the chosen scene, or NULL; `fresh`: its picture is new;
   `said`: the reason why there is no preview, or "". */
void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said);

/* The background studies, one of each kind, and the shown one. */

struct gm_studies {
    struct gm_study *studies[GM_STUDY_COUNT]; /* NULL: none of that kind */
    enum gm_study_kind shown;                 /* GM_STUDY_NONE: the scene is shown */
    struct gm_painting painting;              /* the painting of the shown picture */
    char notice[GM_MESSAGE];                  /* the reason of a failure; "" after the next key */
};

void gm_studies_close(struct gm_studies *studies);

/* Shows a study of a scene; starts it unless it exists with the same words. Returns false and sets the
   notice on failure. */
bool gm_studies_open(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_scene *scene,
                     const char *words, int wake);

/* Shows a study of the scene with its current settings. */
void gm_studies_begin(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_shot *shot,
                      int wake);

/* Returns the scene with the user's settings except dt, as words. The caller frees them; NULL when out of
   memory. */
char *gm_studies_words(const struct gm_shot *shot);

/* Returns the words of the run at a cell of the shown study, the scene first. The caller frees them; NULL
   if no run is there. */
char *gm_studies_pick(const struct gm_studies *studies, enum gm_blocks blocks, int column, int row);

/* Handles a key while a study is shown; returns false if it has another meaning. */
bool gm_studies_press(struct gm_studies *studies, int key, enum gm_theme theme);

/* Returns true while a study measures or carries out an order. */
bool gm_studies_are_busy(const struct gm_studies *studies);

/* Returns the time (ms) after `now` at which the first notice of a finished study ends, or 0. */
int64_t gm_studies_end(const struct gm_studies *studies, int64_t now);
/* Hides the studies and their notices: the scene is left. */
void gm_studies_leave(struct gm_studies *studies);

/* Takes new looks; returns true if the screen must be composed again. */
bool gm_studies_look(struct gm_studies *studies);

/* Draws the shown study's picture over the sheet. */
void gm_studies_draw(const struct gm_sheet *sheet, struct gm_studies *studies);
/* Writes the shown study's progress, or the notice. */
void gm_studies_status(const struct gm_studies *studies, char *text, size_t size);
/* Writes the progress of studies of this scene that are not shown, or the notice; "" without either. */
void gm_studies_news(const struct gm_studies *studies, const struct gm_scene *scene, char *text, size_t size);

/* The prompt for a user-defined system or scheme, or a map of many runs; below the line, its fault. */

enum gm_typed_kind {
    GM_TYPED_NONE,   /* the prompt is closed */
    GM_TYPED_SYSTEM, /* a system that replaces the open scene */
    GM_TYPED_SWITCH, /* a scheme for the selected lane */
    GM_TYPED_FORK,   /* a scheme for a copy of the selected lane */
    GM_TYPED_MAP,    /* a sweep over two keys */
    GM_TYPED_KINDS
};

struct gm_typed_prompt {
    enum gm_typed_kind kind;
    struct gm_edit line;
    bool checked; /* `fault` belongs to the current line; else to an earlier one */
    struct gm_typed_fault fault;
    bool entered;               /* the line is used once it is checked */
    char *last[GM_TYPED_KINDS]; /* the last line of each kind; NULL: never typed */
};

/* Draws the prompt over the last rows of the screen, with its keys; returns the number of these rows, 0 if it is
   closed (or NULL). */
int gm_typed_prompt_draw(const struct gm_sheet *whole, const struct gm_typed_prompt *prompt);

/* The parts of the screen, and their keys. */

/* The screen for an open scene: the picture at the left, the side panel at the right, a status line below;
   or a page, or a study. */

/* Draws the screen; `fresh` means that the shot's picture is new. */
void gm_screen_draw_scene(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot,
                          bool fresh);

/* The side panel: schemes, parameters with their sliders, observables. */

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

/* The list of suitable schemes, for a switch or a fork. */

/* The last entry of the list: a scheme to be typed. */
extern const struct gm_scheme gm_chooser_user;

/* Finds the suitable schemes that match the typed words, the best first, and last the one to be typed.
   Returns their number. */
size_t gm_chooser_find(const struct gm_face *face, const struct gm_shot *shot,
                       const struct gm_scheme *found[GM_SHOT_SCHEMES]);
/* Returns the alias by which the typed words found the chosen scheme; NULL: by its name, or another text. */
const char *gm_chooser_alias(const struct gm_face *face);
void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

/* Pages on the scene with its keys and claims, a scheme, the command lines, or the list of scenes. */

/* Draws the open page and its keys; the shot may be NULL for GM_PAGE_START. */
void gm_screen_draw_page(const struct gm_sheet *whole, struct gm_face *face, const struct gm_shot *shot);

#endif
