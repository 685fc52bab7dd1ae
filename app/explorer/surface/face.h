/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_FACE_H
#define GM_APP_EXPLORER_SURFACE_FACE_H

#include "app/explorer/worker/orders.h"
#include "core/scheme.h"
#include "render/cells/cells.h"
#include "render/files/inline_image.h"

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

#endif
