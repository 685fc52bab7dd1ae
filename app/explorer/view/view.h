/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_VIEW_H
#define GM_APP_EXPLORER_VIEW_VIEW_H

#include "app/explorer/background/background.h"
#include "app/explorer/surface/surface.h"
#include "app/runs/session.h"
#include "app/tours/tour.h"
#include "app/words/typed.h"

/* The keys while a scene is open, and nothing else takes them: one table. */

enum { GM_KEY_CODES = 4 };

/* A key of a row, and what the row's function takes it for: an order, a list, a prompt or a page, and which way. */
struct gm_key_code {
    int code, meaning, amount;
};

/* Everything there is to say of a key while a scene is open: the help, the hints in the status line and what
   the key does come from this one row. */
struct gm_key_row {
    struct gm_key_code keys[GM_KEY_CODES]; /* the code 0 ends them */
    const char *label;                     /* as the help writes them */
    const char *hint;                      /* a word for the status line; NULL: none */
    int rank;                              /* of the hint: the smallest comes first */
    const char *text;                      /* for the help; NULL: another row says it */
    enum gm_key_result (*press)(const struct gm_keystroke *press, const struct gm_key_code *key);
};
extern const struct gm_key_row gm_key_rows[];
extern const size_t gm_key_row_count;

/* What a key does while a scene is open. */
enum gm_key_result gm_key_press(const struct gm_keystroke *press);

/* Leads through a tour in the explorer: where it is, what is told below the picture, its keys. */

struct gm_guide {
    const struct gm_tour *tour;
    size_t step;
    bool answered; /* the step's question is, or it has none */
};

enum gm_guide_result {
    GM_GUIDE_OPEN, /* a step is to be shown from its start */
    GM_GUIDE_RUN,  /* its question is answered: let it run */
    GM_GUIDE_END,  /* there is no step there */
};

/* A tour at the start of its first step. */
struct gm_guide gm_guide_open(const struct gm_tour *tour);

/* What a key of the tour does: n answers or goes on, N goes back, a shows the step again. */
enum gm_guide_result gm_guide_press(struct gm_guide *guide, int key);

/* How many rows below the picture the texts take on a screen of this size. */
int gm_guide_rows(const struct gm_sheet *screen, const struct gm_guide *guide);
/* Writes them into a sheet of so many rows. */
void gm_guide_draw(const struct gm_sheet *sheet, const struct gm_guide *guide);

/* Schemes in the rows of a list: title, claims and order in columns, the formula below. */

/* The colour of a lane, and its line as three cells of text. */
enum gm_role gm_schemes_role(const struct gm_shot_lane *lane);
const char *gm_schemes_dash(const struct gm_shot_lane *lane);

/* The claims that some scheme here makes: only those take a column. */
unsigned gm_schemes_claims(const struct gm_shot *shot);
/* Whether there is no room for air between the columns. */
bool gm_schemes_narrow(const struct gm_sheet *sheet);

/* A heading, with those of the columns. */
void gm_schemes_heading(const struct gm_sheet *sheet, int row, const char *text);
/* What a scheme claims, and its order, right of a title so wide: where that is not whole beside the letters
   in their columns, they stand close, and those of a lane, which its page tells too, give way at last, and
   then its order. Returns where the title's room ends. */
int gm_schemes_facts(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme, int title_end,
                     unsigned columns, bool give_way, enum gm_role role);
/* The title of a scheme that fits at a column, with that of another one whose steps are the same here, and its facts. */
void gm_schemes_row(const struct gm_sheet *sheet, int column, int row, const struct gm_shot *shot,
                    const struct gm_scheme *scheme, enum gm_role role, bool bold);

/* The formula with its reference, and the rows that it takes. */
int gm_schemes_formula_rows(const struct gm_scheme *scheme);
void gm_schemes_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme);

/* The screen at the start: what was found of what there is, group by group. */

enum gm_start_group {
    GM_START_SCENES, /* and a system of one's own, last */
    GM_START_TOURS,
    GM_START_SYSTEMS, /* of files */
    GM_START_ROOMS,
    GM_START_GROUPS
};
struct gm_start_entry {
    enum gm_start_group group;
    const char *name, *title;
    const struct gm_scene *scene; /* NULL: it is made of a file, or typed */
    const struct gm_tour *tour;   /* NULL: it is none */
};
#define GM_START_OWN "your own system"
#define GM_START_OWN_TITLE "A formula that you type, or a file"
enum { GM_START_ENTRIES = 512 };
struct gm_start {
    struct gm_start_entry found[GM_START_ENTRIES];
    size_t count, choice;
    int ranks[GM_START_ENTRIES]; /* how well each answers what was typed */
    char typed[GM_TYPED];
};

/* Whether it is what somebody types. */
bool gm_start_is_user(const struct gm_start_entry *entry);
/* The place of the first of the next group that something was found of, after that of the choice, or of the
   first; the choice where there is one group alone. */
size_t gm_start_next_group(const struct gm_start *start);

/* With `choice` marked; `shot` is a look at that scene, or NULL where there is none yet, `fresh` says that
   its picture is a new one, and `said` why it cannot be looked at, or "". */
void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said);

/* The background studies of the explorer, one of each kind, and which of them is on the screen. */

struct gm_studies {
    struct gm_study *studies[GM_STUDY_COUNT];
    struct gm_study_look *looks[GM_STUDY_COUNT];   /* the last ones taken; NULL: none yet */
    const struct gm_scene *scenes[GM_STUDY_COUNT]; /* that were open when they began: it may be gone */
    enum gm_study_kind shown;                      /* GM_STUDY_NONE: the scene is */
    struct gm_painting painting;                   /* the shown picture */
    char notice[GM_MESSAGE];                       /* what could not be done; "" after the next key */
};

void gm_studies_close(struct gm_studies *studies);

/* Shows a study of a scene; starts it unless one of the same words is there already. False if it cannot be made: the
   notice says why. */
bool gm_studies_open(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_scene *scene,
                     const char *words, int wake);

/* The same for the scene as it is set now, by the key: w work-precision, m the stability map. */
void gm_studies_begin(struct gm_studies *studies, int key, const struct gm_shot *shot, int wake);

/* The scene with what the user has set, as the words of a study; malloc'ed, NULL: no memory. */
char *gm_studies_words(const struct gm_shot *shot);

/* The words of the run that the shown study has at a cell of its picture, the scene first; malloc'ed, NULL:
   there is none. */
char *gm_studies_pick(const struct gm_studies *studies, enum gm_blocks blocks, int column, int row);

/* What a key does while a study is shown; false: it is for others. */
bool gm_studies_press(struct gm_studies *studies, int key, enum gm_theme theme);

/* Takes what is new; true if the screen has to be composed again. */
bool gm_studies_look(struct gm_studies *studies);

/* The picture of the shown study over the sheet. */
void gm_studies_draw(const struct gm_sheet *sheet, struct gm_studies *studies);
/* The line on how far the shown study is. */
void gm_studies_status(const struct gm_studies *studies, char *text, size_t size);
/* The line on studies of this scene that go on unseen, or the notice; "" if there is nothing to say. */
void gm_studies_news(const struct gm_studies *studies, const struct gm_scene *scene, char *text, size_t size);

/* The prompt for a system or a scheme of one's own, or a map of many runs: what is typed, and below it what
   is wrong, and where. */

enum gm_typed_kind {
    GM_TYPED_NONE,   /* the prompt is closed */
    GM_TYPED_SYSTEM, /* that takes the place of what is open */
    GM_TYPED_SWITCH, /* a scheme for the selected lane */
    GM_TYPED_FORK,   /* a scheme for one more lane from its state */
    GM_TYPED_MAP,    /* a sweep over two keys */
    GM_TYPED_KINDS
};

struct gm_typed_prompt {
    enum gm_typed_kind kind;
    struct gm_edit line;
    bool checked; /* the fault is that of the line as it is; else of an earlier one */
    struct gm_typed_fault fault;
    bool entered;               /* the line is to be taken once it is checked */
    char *last[GM_TYPED_KINDS]; /* what was typed before; NULL: nothing */
};

/* The rows that it takes of a screen of so many columns and rows; 0: it is closed. */
int gm_typed_prompt_rows(const struct gm_typed_prompt *prompt, int columns, int rows);
/* Fills the sheet, of so many rows. */
void gm_typed_prompt_draw(const struct gm_sheet *sheet, const struct gm_typed_prompt *prompt);
/* The keys, in the last row. */
void gm_typed_prompt_keys(const struct gm_sheet *last, const struct gm_typed_prompt *prompt);

/* The parts of the screen: what each draws, and which keys are its own. */

/* The screen while a scene is open: the picture at the left, the side panel at the right, a status line
   below; or a page, or a study. */

/* `fresh` says that the shot's picture is a new one. */
void gm_screen_draw_scene(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot,
                          bool fresh);

/* The side panel: schemes, parameters with their sliders, what is observed. */

void gm_side_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

/* The list of the schemes that fit: one is chosen for a switch or a fork. */

/* The last one of the list: it stands for a scheme that is to be typed. */
extern const struct gm_scheme gm_chooser_user;

enum gm_key_result gm_chooser_open(const struct gm_keystroke *press, const struct gm_key_code *key);
/* A key while it is open. */
enum gm_key_result gm_chooser_press(const struct gm_keystroke *press);
void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot);

/* A line that is typed: a time to run ahead to, a parameter's value. */

/* Begins it, if there is something to type a value of. */
enum gm_key_result gm_prompt_open(const struct gm_keystroke *press, enum gm_prompt prompt);
/* A key while it is open. */
enum gm_key_result gm_prompt_press(const struct gm_keystroke *press);
/* What it asks, with what was typed; while it is open. */
void gm_prompt_text(const struct gm_face *face, const struct gm_shot *shot, char *text, size_t size);

/* Pages that explain: the scene with the keys and claims, a scheme, the command lines, the list of scenes. */

/* A key while a page is open: scrolls it, or closes it. */
enum gm_key_result gm_pages_press(int key, struct gm_face *face);
/* The open page, with its keys in the last row; the shot may be NULL for GM_PAGE_START. */
void gm_screen_draw_page(const struct gm_sheet *whole, struct gm_face *face, const struct gm_shot *shot);

#endif
