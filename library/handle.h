/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_LIBRARY_HANDLE_H
#define GM_LIBRARY_HANDLE_H

#include <locale.h>
#include <stdbool.h>

#include "app/base/arguments.h"
#include "app/runs/session.h"
#include "app/words/drive.h"
#include "app/words/names.h"
#include "core/quantity.h"
#include "library/geomint.h"
#include "render/pixels/canvas.h"

/* A handle of the library holds a request, its lanes, and copies of the lanes, which are drawn. */

struct gm_handle_lane {
    struct gm_drive drive;
    double *state;                                /* the copy that the host has; NULL: none was requested */
    struct gm_quantity quantities[GM_QUANTITIES]; /* quantities that change, then constant ones */
    size_t quantity_count, fixed_count;           /* number of all, and of constant ones */
    size_t sizes[GM_QUANTITIES];                  /* numbers in each */
    double *scratch;                              /* space for the largest derived quantity */
};

/* The canvas of the last picture, with fonts, which take longer than a picture. Only that of the program's own
   rasteriser can be kept. */
struct gm_kept_canvas {
    struct gm_canvas *canvas; /* NULL: none */
    struct gm_appearance look;
    char painter[16]; /* the environment's word for it */
};

struct geomint {
    struct gm_arena *arena;           /* owns the words, the session, the lanes and their copies */
    struct gm_request words;          /* read from the words of the opening */
    const struct gm_request *request; /* the lanes' request: `words`, or the session's log */
    struct gm_session *session;       /* NULL: the lanes are driven one by one */
    struct gm_shot *shot;             /* the session's */
    size_t mark;                      /* in the arena, before the lanes of a session */
    enum gm_theme theme;              /* of pictures */
    struct gm_kept_canvas kept;
    struct gm_chosen chosen; /* observables of a row */
    struct gm_handle_lane *lanes;
    struct gm_drive *drawn; /* a lane for each, which is recorded step by step; NULL: nothing was drawn */
    char *text;
    int status;
    char message[GM_MESSAGE];
};

/* The locale of the library's calls and threads, in which numbers have a point and texts are UTF-8, whatever the
   host's is; 0: there was no memory for it, and the host's stays. */
extern locale_t gm_library_locale;

/* Begin and end a call of the host. The call starts with the status GEOMINT_OK; a refusal of memory during it
   becomes its status. All functions accept a NULL handle, which has no lanes; its status stays. */
struct gm_call {
    geomint *handle;
    locale_t outside;
    unsigned long refusals;
};
struct gm_call gm_call_begin(geomint *handle);
int gm_call_end(const struct gm_call *call);

/* The words from which a handle is opened. */
struct gm_handle_words {
    const char *scheme; /* NULL: none */
    int count;
    const char *const *words;
    geomint *handle; /* set by gm_handle_open, as the next */
    int refusal;     /* the status if the body refuses them; GEOMINT_USAGE unless the body changes it */
};
/* A new handle that the body fills, in its arena: the body's data is the opening. Returns NULL when out of
   memory. */
geomint *gm_handle_open(struct gm_handle_words opening, void (*body)(struct gm_arena *arena, void *opening));

/* Reads the words of an opening; `schemes` as for gm_request_parse. Leaves the body with a sentence. */
void gm_handle_read(struct gm_arena *arena, struct gm_handle_words *opening, size_t schemes);
/* Takes the lanes of a session, which have changed, and reports those that have failed. */
void gm_handle_show(geomint *handle);
/* Ends a text, which the handle has until the next one; NULL when out of memory. */
const char *gm_handle_written(geomint *handle, struct gm_text_stream *writing);

/* Sets the status and the message of a call. Returns false. */
bool gm_handle_refuse(geomint *handle, int status, const char *sentence);

/* Returns true if the host gave a pointer; `name` is its name in geomint.h. Otherwise false with a message. */
bool gm_handle_given(geomint *handle, const void *pointer, const char *name);

/* Returns true if the lane exists, otherwise false with a message. */
bool gm_handle_has(geomint *handle, size_t lane);

/* Advances the copies to the states of the lanes. Returns false with a message on failure. */
bool gm_handle_follow(geomint *handle);

#endif
