/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_OPEN_H
#define GM_APP_EXPLORER_OPEN_H

#include "app/explorer/terminal/display.h"
#include "app/explorer/view/guide.h"
#include "app/explorer/view/studies.h"
#include "app/explorer/worker/worker.h"
#include "app/words/typed.h"

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

/* These put something in place of what was there. False with a sentence (GM_MESSAGE bytes). */
bool gm_open_request(struct gm_open *open, const struct gm_request *request, char *message);
/* What a typed line says (app/words/typed.h), as of a file; what was open stays where that is wrong. */
bool gm_open_line(struct gm_open *open, const char *line, struct gm_typed_fault *fault);
/* A scene, a system or a room as its name alone gives it; a preview is for the list of them. */
bool gm_open_named(struct gm_open *open, const char *name, bool preview, char *message);
/* A shot of the worker, which has made its scene by now. */
void gm_open_take(struct gm_open *open, struct gm_shot *shot);
/* The scene of the tour's present step, from its start, and its study. */
bool gm_open_step(struct gm_open *open, char *message);

/* The study of the tour's present step, once its question is answered. */
void gm_open_study(struct gm_open *open);

/* Leaves what is open. A movie that is being made, and a file that was asked for, are finished first; otherwise a step
   that is being made is not waited for. */
void gm_open_leave(struct gm_open *open);

#endif
