/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_EVENTS_H
#define GM_APP_EXPLORER_EVENTS_H

#include "app/explorer/background/background.h"
#include "app/explorer/terminal/device.h"
#include "app/explorer/view/view.h"
#include "app/explorer/worker/worker.h"
#include "app/words/typed.h"

/* What the files of the explorer share: explorer.c its beginning, its loop with what is shown, and its end; input.c the
   list of what there is, the keys and the mouse; open.c what is open, and typed lines. Everything stands under who
   writes it. */

/* What is open: a scene, or a step of a tour with its study; with the thread that plays it. */

enum { GM_NAME = 256 };

struct gm_open {
    int wake;                   /* the worker's shots are announced here */
    struct gm_display *display; /* that may be painting a picture of the worker's */
    struct gm_worker *worker;
    const struct gm_scene *scene; /* the worker's; NULL: it makes it first */
    char name[GM_NAME];           /* of that scene, in the list of what there is */
    struct gm_shot *shot;         /* NULL: it has given none yet */
    bool asked;                   /* for a shot */
    int64_t next_shot;            /* in milliseconds: none is asked for earlier */
    unsigned long told;           /* number of the last command line that was shown */
    char said[GM_MESSAGE];        /* why there will be no shot, or "" */
    struct gm_guide guide;        /* without a tour: none */
    bool touring;                 /* the worker is led by it */
    struct gm_studies studies;
    char *partings; /* a line for every movie that was finished by leaving its scene, or NULL */
};

/* The list of what there is. */
struct gm_list {
    bool shown; /* and what is open is a look at a scene */
    struct gm_start start;
    struct gm_start_entry *files; /* systems and rooms, as they were when the list was shown; names and titles
                                     are its own */
    size_t file_count;
    struct gm_tour *tours; /* that it offers; NULL: not read yet */
    size_t tour_count;
    bool kept;        /* that look is a scene that was left and can be gone back to */
    int64_t look_due; /* when the chosen scene is looked at; -1: it is */
};

/* The mouse. */
struct gm_pointer {
    struct gm_mouse mouse;
    struct gm_hit held; /* what the button went down on */
    bool holding;
    int column, row; /* where it was last, while it is down */
};

/* Whether a line could be read, and nothing is kept of it. */
typedef bool gm_line_reader(const char *line, struct gm_typed_fault *fault);

struct gm_check { /* {0} has found out nothing */
    struct gm_job job;
    bool open;
    gm_line_reader *read;
    char *line; /* that was asked about last */
    struct gm_typed_fault fault;
};

struct gm_explorer {
    int wake; /* the worker's shots and all signals are announced here */
    struct gm_terminal terminal;
    struct gm_face face;
    struct gm_screen screen;
    struct gm_display display;
    struct gm_open open;
    struct gm_list list;
    struct gm_pointer pointer;
    struct gm_measure measure;
    struct gm_typed_prompt typed_prompt;
    struct gm_check check; /* of what is typed in it */
    bool editing;          /* the present system is asked for, to be edited */
    int64_t held_until;    /* keys wait for what is not there yet; 0: they do not */
    bool behind;           /* some of them may have left the terminal */
    int late;              /* how many rounds of the terminal's answers are still to come */
    bool dirty;            /* the screen has to be composed again */
    bool fresh;            /* with a new picture */
    double draw_cost;      /* seconds that composing it took the last time */
    bool leave;
    int status;
    char message[GM_MESSAGE]; /* said when the terminal is the shell's again */
};

/* Ends the explorer with an exit status. */
static inline void gm_explorer_leave(struct gm_explorer *explorer, int status)
{
    explorer->leave = true;
    explorer->status = status;
}

/* ---- what is open ---- */

/* These put something in place of what was there. False with a sentence (GM_MESSAGE bytes). */
bool gm_open_request(struct gm_open *open, const struct gm_request *request, char *message);
/* A scene, a system or a room as its name alone gives it; a preview is for the list of them. */
bool gm_open_named(struct gm_open *open, const char *name, bool preview, char *message);
/* The scene of the tour's present step, from its start, and its study. */
bool gm_open_step(struct gm_open *open, char *message);

/* The study of the tour's present step, once its question is answered. */
void gm_open_study(struct gm_open *open);

/* Leaves what is open. A movie that is being made, and a file that was asked for, are finished first; otherwise a step
   that is being made is not waited for. */
void gm_open_leave(struct gm_open *open);

/* ---- the list of scenes ---- */

void gm_explorer_show_start(struct gm_explorer *explorer);
void gm_explorer_close_list(struct gm_list *list);
/* Whether the worker is a look at what is chosen. */
bool gm_explorer_is_looked_at(const struct gm_explorer *explorer);
/* Looks at the chosen scene now. Tours are only told of. */
void gm_explorer_look(struct gm_explorer *explorer);

/* ---- typed lines ---- */

/* The run of a line (app/words/typed.h) takes the place of what is open, which stays where the line is wrong. */
bool gm_explorer_open_line(struct gm_explorer *explorer, const char *line, struct gm_typed_fault *fault);
/* Opens the prompt, with the system that is open, with what was typed before, or with an example. */
void gm_explorer_ask_system(struct gm_explorer *explorer);
void gm_explorer_ask_scheme(struct gm_explorer *explorer, bool fork);
void gm_explorer_ask_map(struct gm_explorer *explorer);
void gm_explorer_edit_system(struct gm_explorer *explorer, const char *command);
void gm_explorer_press_typed(struct gm_explorer *explorer, int key);
/* Finds out what is wrong with what was typed, and takes it once that is nothing and it was entered. */
void gm_explorer_check_typed(struct gm_explorer *explorer);
void gm_explorer_close_typed(struct gm_explorer *explorer);

/* ---- input ---- */

void gm_explorer_key(struct gm_explorer *explorer, int key);
/* Offers the chosen one of the command lines that are shown to the terminal's clipboard. */
void gm_explorer_copy(struct gm_explorer *explorer);
void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event);

/* The terminal has another size, or may show anything. */
void gm_explorer_resize(struct gm_explorer *explorer);

#endif
