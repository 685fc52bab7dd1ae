/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_EVENTS_H
#define GM_APP_EXPLORER_EVENTS_H

#include "app/explorer/background/check.h"
#include "app/explorer/background/measure.h"
#include "app/explorer/open.h"
#include "app/explorer/terminal/mouse.h"
#include "app/explorer/view/start.h"
#include "app/explorer/view/typed_system.h"

/* What the files of the explorer share: explorer.c its beginning, its events and its end, choose.c the list
   of what there is, own.c the prompt for a system or scheme of one's own, press.c the keys, point.c the
   mouse, show.c what is shown and when. Everything stands under who writes it. */

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

/* ---- the list of scenes ---- */

void gm_explorer_show_start(struct gm_explorer *explorer);
void gm_explorer_close_list(struct gm_list *list);
/* Whether the worker is a look at what is chosen. */
bool gm_explorer_is_looked_at(const struct gm_explorer *explorer);
/* The chosen scene is looked at in a while, unless it is open already; or now. Tours are only told of. */
void gm_explorer_look_soon(struct gm_explorer *explorer);
void gm_explorer_look(struct gm_explorer *explorer);
/* Opens the chosen scene or tour, or goes back to it where it was left. */
void gm_explorer_enter(struct gm_explorer *explorer);
void gm_explorer_press_in_list(struct gm_explorer *explorer, int key);

/* ---- a system or scheme of one's own, a map ---- */

/* Opens the prompt, with the system that is open, with what was typed before, or with an example. */
void gm_explorer_ask_system(struct gm_explorer *explorer);
void gm_explorer_edit_system(struct gm_explorer *explorer, const char *command);
void gm_explorer_ask_scheme(struct gm_explorer *explorer, bool fork);
void gm_explorer_ask_map(struct gm_explorer *explorer);
void gm_explorer_press_typed(struct gm_explorer *explorer, int key);
/* Finds out what is wrong with what was typed, and takes it once that is nothing and it was entered. */
void gm_explorer_check_typed(struct gm_explorer *explorer);
void gm_explorer_close_typed(struct gm_explorer *explorer);

/* ---- input ---- */

void gm_explorer_key(struct gm_explorer *explorer, int key);
/* Offers the chosen one of the command lines that are shown to the terminal's clipboard. */
void gm_explorer_copy(struct gm_explorer *explorer);
void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event);

/* ---- output ---- */

/* The terminal has another size, or may show anything. */
void gm_explorer_resize(struct gm_explorer *explorer);
/* Composes and sends as the terminal takes it: a slow one loses frames, never model time. Returns how long to
   wait for input, in milliseconds; -1: as long as it takes. */
int gm_explorer_output(struct gm_explorer *explorer);

#endif
