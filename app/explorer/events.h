/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_EVENTS_H
#define GM_APP_EXPLORER_EVENTS_H

#include "app/explorer/background/background.h"
#include "app/explorer/terminal/device.h"
#include "app/explorer/view/view.h"
#include "app/explorer/worker/session.h"
#include "app/words/request.h"

/* The state that the explorer's files share. explorer.c has start, loop, end and scripts, actions.c handles keys and the mouse,
   list.c the list of scenes and the screen, open.c scenes and typed lines. */

enum { GM_NAME = 256 };

/* The open scene, or a tour's step with its study, and its worker. */
struct gm_open {
    int wake;                   /* eventfd, written when a shot is finished */
    struct gm_display *display; /* the display, which may be painting a picture of the worker's */
    struct gm_worker *worker;
    const struct gm_scene *scene; /* the worker's scene; NULL: not yet made */
    char name[GM_NAME];           /* the scene's name in the list */
    struct gm_shot *shot;         /* the last shot; NULL before the first */
    bool asked;                   /* a shot was requested */
    int64_t next_shot;            /* time (ms) of the next request for a shot */
    unsigned long told;           /* number of the last command line shown */
    char said[GM_MESSAGE];        /* the reason why there will be no shot, or "" */
    struct gm_guide guide;        /* the guide; its tour may be NULL */
    bool unsaved;                 /* a formula was typed and not saved to a file */
    bool touring;                 /* the worker plays the guide's tour */
    struct gm_studies studies;
    char *partings; /* the lines to print in the shell at the end, or NULL */
};

/* The list of scenes, tours and files. */
struct gm_list {
    bool shown; /* the list is shown, and the open scene is a preview */
    struct gm_start start;
    struct gm_start_entry *entries; /* all, group by group; the list owns the names and titles of files */
    size_t count;
    struct gm_tour *tours; /* the tours; NULL: not read */
    size_t tour_count;
    bool kept;        /* the open scene was left and can be resumed */
    int64_t look_due; /* time (ms) of the next preview; -1: none is due */
};

/* The mouse and the hit that it holds. */
struct gm_pointer {
    struct gm_mouse mouse;
    struct gm_hit held; /* the hit under the pressed button */
    bool holding;
    int column, row; /* the last cell while the button is pressed */
};

/* Reads a line without storing it; returns false and fills fault if it is wrong. */
typedef bool gm_line_reader(const char *line, struct gm_typed_fault *fault);

struct gm_check { /* the check of a typed line; {0} is empty */
    struct gm_job job;
    bool open;
    gm_line_reader *read;
    char *line; /* the last line checked */
    struct gm_typed_fault fault;
};

struct gm_explorer {
    int wake; /* eventfd for the worker's shots and all signals */
    struct gm_terminal terminal;
    struct gm_face face;
    struct gm_screen screen;
    struct gm_display display;
    struct gm_open open;
    struct gm_list list;
    struct gm_pointer pointer;
    struct gm_measure measure;
    struct gm_typed_prompt typed_prompt;
    struct gm_check check; /* the check of the prompt's line */
    bool editing;          /* the current system's line was requested for editing */
    int64_t held_until;    /* time (ms) until which keys wait for a scene; 0: they do not */
    bool behind;           /* the console may have waiting keys */
    int late;              /* rounds of the terminal's answers still to come */
    bool dirty;            /* the screen must be composed again */
    bool fresh;            /* the picture is new */
    int64_t end;           /* time (ms) at which a text that is shown for some seconds ends; 0: none does */
    double draw_cost;      /* seconds of the last composition */
    bool leave;
    int status;
    char message[GM_MESSAGE]; /* printed when the terminal is restored */
};

/* Gives an order to the open scene's worker. */
static inline void gm_explorer_order(struct gm_explorer *explorer, struct gm_order order)
{
    gm_worker_order(explorer->open.worker, order);
}

/* Ends the explorer's loop; `status` is the exit status. */
static inline void gm_explorer_leave(struct gm_explorer *explorer, int status)
{
    explorer->leave = true;
    explorer->status = status;
}

/* Composes the screen; returns false if there is nothing to show yet. */
bool gm_explorer_compose(struct gm_explorer *explorer);
/* Takes a new shot of the worker, or if that is NULL its failure. */
void gm_explorer_take(struct gm_explorer *explorer, struct gm_shot *shot);

/* ---- scenes ---- */

/* These replace the open scene. They return false and fill message (GM_MESSAGE bytes) on failure. */
bool gm_open_request(struct gm_open *open, const struct gm_request *request, char *message);
/* Opens a scene, system or room by name; a preview is for the list. */
bool gm_open_named(struct gm_open *open, const char *name, bool preview, char *message);
/* Opens the scene of the tour's current step from its start, and its study. */
bool gm_open_step(struct gm_open *open, char *message);

/* Shows the study of the tour's current step once its question is answered. */
void gm_open_study(struct gm_open *open);

/* Leaves the open scene. Finishes a movie and requested files, but does not wait for a step. */
void gm_open_leave(struct gm_open *open);

/* ---- the list of scenes ---- */

void gm_explorer_show_start(struct gm_explorer *explorer);
void gm_explorer_close_list(struct gm_list *list);
/* Opens the preview of the chosen scene once it is due. */
void gm_explorer_look_if_due(struct gm_explorer *explorer);

/* ---- typed lines ---- */

/* Opens the run of a line (app/words/request.h). If the line is wrong, returns false and fills fault; the
   open scene remains. */
bool gm_explorer_open_line(struct gm_explorer *explorer, const char *line, struct gm_typed_fault *fault);
/* Opens the prompt with the open system, the last line or an example. */
void gm_explorer_ask_system(struct gm_explorer *explorer);
void gm_explorer_ask_map(struct gm_explorer *explorer);
void gm_explorer_ask_invariants(struct gm_explorer *explorer);
void gm_explorer_edit_system(struct gm_explorer *explorer, const char *command);
void gm_explorer_press_typed(struct gm_explorer *explorer, int key);
/* Checks the typed line, and carries it out if it is correct and entered. */
void gm_explorer_check_typed(struct gm_explorer *explorer);
void gm_explorer_close_typed(struct gm_explorer *explorer);

/* ---- input ---- */

void gm_explorer_key(struct gm_explorer *explorer, int key);
/* Handles a key of the list. */
void gm_explorer_press_list(struct gm_explorer *explorer, int key);
/* Chooses an entry of the list; the second click on it opens it. */
void gm_explorer_click_entry(struct gm_explorer *explorer, size_t entry);
/* Leaves, or asks first if something would be lost. */
void gm_explorer_quit(struct gm_explorer *explorer);
/* Gives a scheme of the list to the selected lane, or to a copy of it; or asks for a typed one. */
void gm_explorer_choose(struct gm_explorer *explorer, const struct gm_scheme *scheme);
/* Offers the chosen command line to the terminal's clipboard. */
void gm_explorer_copy(struct gm_explorer *explorer);
void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event);

/* Adapts to the terminal's size and writes the screen again. */
void gm_explorer_resize(struct gm_explorer *explorer);

#endif
