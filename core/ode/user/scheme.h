/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined scheme: its text becomes a row like those of the families. */
#ifndef GM_CORE_ODE_USER_SCHEME_H
#define GM_CORE_ODE_USER_SCHEME_H

#include "core/model/written_scheme.h"
#include "core/scheme.h"

struct gm_user_scheme_source {
    const char *text; /* a word, or the content of a file */
    size_t length;
    const char *name;  /* the name that finds the scheme */
    const char *title; /* the title if the text has none; NULL: it follows from the text */
    bool part; /* true: another scheme names it, and its weights need not sum to 1, as in a processor */
    /* Returns the scheme of a file that the text names; NULL with a sentence (GM_FAULT_SENTENCE bytes). */
    const struct gm_scheme *(*bring)(void *data, const char *path, char *sentence);
    void *data;
    struct gm_decimals *decimals; /* the decimals of the text are written here; NULL: nowhere */
};

/* Returns true if a text is a word: a kind, or a scheme that exists, and a parenthesis. */
bool gm_user_scheme_is_word(const char *text, size_t length);

/* Makes the scheme; theory fills an order or claims that the text does not give. Returns NULL with a fault,
   whose sentence is empty when out of memory. */
const struct gm_scheme *gm_user_scheme_open(const struct gm_user_scheme_source *source,
                                            struct gm_fault *fault);
void gm_user_scheme_close(const struct gm_scheme *scheme);

#endif
