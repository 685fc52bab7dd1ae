/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined scheme: its text becomes a row like those of the families. */
#ifndef GM_CORE_ODE_USER_SCHEME_H
#define GM_CORE_ODE_USER_SCHEME_H

#include "core/scheme.h"
#include "core/model/written_scheme.h"

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

/* A scheme whose coefficients were typed with too few digits, or with a wrong one: the decimals next to these
   that satisfy the order conditions. */
struct gm_polish {
    int order;            /* the scheme's order, whose conditions are solved */
    unsigned claims;      /* the claims whose equations are solved as well */
    size_t decimals;      /* number of decimals that may move: not exact numbers */
    size_t conditions;    /* number of conditions of the order and of the claimed structure */
    double before, after; /* the largest residual, as typed and as solved */
    double change;        /* the largest change of a decimal */
    double doubt;         /* radius of the residuals, from rows known to 15 digits */
};

/* Returns the text of the scheme with its decimals to 30 digits (15 if rows beside them have 15), its order
   and its claims. The solution nearest to the typed one is used, so that a family's free parameters stay. The
   caller frees. Returns NULL with a fault, whose sentence is empty when out of memory. */
char *gm_user_scheme_polish(const struct gm_user_scheme_source *source, struct gm_polish *polish,
                            struct gm_fault *fault);

#endif
