/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_EVENTS_H
#define GM_APP_EXPLORER_EVENTS_H

#include "app/explorer/explorer.h"
#include "app/explorer/terminal/display.h"
#include "app/explorer/view/guide.h"
#include "app/explorer/view/measure.h"
#include "app/explorer/view/mouse.h"
#include "app/explorer/view/studies.h"
#include "app/explorer/worker/worker.h"

/* What the files of the explorer share: explorer.c its beginning, its events and its end, explorer_open.c
   which scene or step of a tour is open, explorer_start.c the list of scenes and tours, explorer_press.c the
   keys, explorer_mouse.c the mouse, explorer_show.c what is shown and when. */

struct gm_explorer {
    struct gm_terminal terminal;
    struct gm_face face;
    struct gm_screen screen;
    struct gm_display display;
    int wake; /* the worker's shots and all signals are announced here */
    struct gm_worker *worker;
    const struct gm_scene *scene; /* the worker's */
    struct gm_shot *shot;         /* NULL: it has given none yet */
    bool at_start;                /* the list of scenes is shown, and the worker is a look at one */
    struct gm_start start;
    struct gm_tour *tours; /* that the list offers; NULL: not read yet */
    size_t tour_count;
    char said[GM_MESSAGE]; /* why that look failed, or "" */
    bool kept;             /* that look is a scene that was left and can be gone back to */
    int64_t look_due;      /* when the chosen scene is looked at; -1: it is */
    struct gm_mouse mouse;
    struct gm_hit held; /* what the button went down on */
    bool holding;
    struct gm_measure measure;
    struct gm_guide guide; /* without a tour: none */
    bool touring;          /* the worker is led by it */
    struct gm_studies studies;
    bool dirty;         /* the screen has to be composed again */
    bool fresh;         /* with a new picture */
    bool asked;         /* for a shot */
    unsigned long told; /* number of the last command line that was shown */
    int64_t next_shot;  /* in milliseconds: no shot is asked for earlier */
    bool leave;
    int status;
    char message[GM_MESSAGE]; /* said when the terminal is the shell's again */
    char *partings;           /* and a line for every movie that was finished by leaving its scene, or NULL */
};

int64_t gm_explorer_milliseconds(void);
/* Ends the explorer with an exit status. */
void gm_explorer_leave(struct gm_explorer *explorer, int status);

/* ---- what is open ---- */

/* Ends the worker, a movie that it makes included. */
void gm_explorer_close_worker(struct gm_explorer *explorer);

/* `first` is the worker's first order; NULL: it has none. False with the explorer's message. */
bool gm_explorer_open_request(struct gm_explorer *explorer, const struct gm_request *request,
                              const struct gm_order *first);
/* A scene as its name alone gives it, in place of what was there; a preview is for the list of scenes. */
void gm_explorer_open_scene(struct gm_explorer *explorer, const struct gm_scene *scene, bool preview);
/* The scene of the tour's present step, from its start, in place of what was there. */
bool gm_explorer_open_step(struct gm_explorer *explorer);

/* ---- the list of scenes ---- */

void gm_explorer_show_start(struct gm_explorer *explorer);
/* Whether the worker is a look at what is chosen. */
bool gm_explorer_is_looked_at(const struct gm_explorer *explorer);
/* The chosen scene is looked at in a while, unless it is open already; or now. Tours are only told of. */
void gm_explorer_look_soon(struct gm_explorer *explorer);
void gm_explorer_look(struct gm_explorer *explorer);
/* Opens the chosen scene or tour, or goes back to it where it was left. */
void gm_explorer_enter(struct gm_explorer *explorer);

/* ---- input ---- */

void gm_explorer_press(struct gm_explorer *explorer, int key);
/* Offers the chosen one of the command lines that are shown to the terminal's clipboard. */
void gm_explorer_copy(struct gm_explorer *explorer);
void gm_explorer_press_at_start(struct gm_explorer *explorer, int key);
void gm_explorer_press_in_tour(struct gm_explorer *explorer, int key);
void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event);

/* ---- output ---- */

/* The terminal has another size, or may show anything. */
void gm_explorer_resize(struct gm_explorer *explorer);
/* Composes and sends as the terminal takes it: a slow one loses frames, never model time. Returns how long to
   wait for input, in milliseconds; -1: as long as it takes. */
int gm_explorer_output(struct gm_explorer *explorer);

#endif
