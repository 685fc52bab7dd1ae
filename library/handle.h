/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_LIBRARY_HANDLE_H
#define GM_LIBRARY_HANDLE_H

#include <locale.h>
#include <stdbool.h>

#include "app/words/names.h"
#include "app/words/drive.h"
#include "core/quantity.h"
#include "library/geomint.h"

/* What a handle of the library holds: a request, its lanes, and copies of these that are drawn. */

struct gm_handle_lane {
    struct gm_drive drive;
    double *state;                                /* what the host looks at; NULL: it does not */
    struct gm_quantity quantities[GM_QUANTITIES]; /* those that change first */
    size_t quantity_count, fixed_count;           /* of all, and of those that do not change */
    size_t sizes[GM_QUANTITIES];                  /* numbers in each */
    double *scratch;                              /* for the largest of those that are derived */
};

struct geomint {
    struct gm_request request;
    struct gm_chosen chosen; /* observables of a row */
    struct gm_handle_lane *lanes;
    struct gm_drive *drawn; /* a lane for each, which is recorded step by step; NULL: nothing was drawn */
    char *text;
    int status;
    char message[GM_MESSAGE];
};

/* A call of the host begins, with its handle as good as new, and ends: a refusal of memory since then is its
   status. All of these take the NULL of a handle for which there was no memory: it has no lanes, and its
   status stays. */
struct gm_call {
    geomint *handle;
    locale_t outside;
    unsigned long refusals;
};
struct gm_call gm_call_begin(geomint *handle);
int gm_call_end(const struct gm_call *call);

/* Says how a call went. Returns false. */
bool gm_handle_refuse(geomint *handle, int status, const char *sentence);

/* Whether the host gave a pointer, which geomint.h calls so; false with a sentence. */
bool gm_handle_given(geomint *handle, const void *pointer, const char *name);

/* The same of each of its words. */
bool gm_handle_given_words(geomint *handle, int count, const char *const words[]);

/* Whether there is such a lane; false with a sentence. */
bool gm_handle_has(geomint *handle, size_t lane);

/* The copies are where the lanes are. False with a sentence. */
bool gm_handle_follow(geomint *handle);

#endif
