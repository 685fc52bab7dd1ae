/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_PARTS_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_PARTS_H

#include "core/ode/families/splitting/splitting.h"
#include "core/scheme.h"

enum { GM_MOST_PARTS = 16 };

/* The coefficients of a splitting by parts: the flows of `list` in turns, a piece's number is its part's. */
struct gm_parts_row {
    struct gm_splitting splitting; /* first: what reads splittings reads these */
    double corrector; /* c: before and behind each step, p += c h^3 B'' M^-1 B' of parts A, B; 0: none */
    size_t parts;     /* 0: the pieces of the system's own, palindromic in the steps of `of_pieces` */
    struct gm_named_part {
        const char *name;
        const struct gm_scheme *by; /* the part moves by steps of this scheme; NULL: by its exact flow */
        size_t column;              /* of the name in the word that was typed, from 1; 0: no word names it */
    } list[GM_MOST_PARTS];
    const struct gm_composition *of_pieces; /* NULL: once each, in order */
};

/* Returns the column of the part that a problem lacks for a scheme, from 1; 0: it lacks none, or no word names it. */
size_t gm_parts_column(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* Returns how the flow of a named part is computed, in words; NULL: it is not known. */
const char *gm_part_flow(const struct gm_problem *problem, const char *name);

#endif
