/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hodge's decomposition of 1-forms. */
#ifndef GM_CORE_FORM_HODGE_H
#define GM_CORE_FORM_HODGE_H

#include "core/form/space.h"

/* The factors of a decomposition on one mesh. */
struct gm_hodge;
struct gm_lu;

/* A body of the arena, which owns it; leaves the body for lack of memory. */
struct gm_hodge *gm_hodge_open(struct gm_arena *arena, const struct gm_form_space *space);
/* The factors of its two matrices. */
const struct gm_cholesky *gm_hodge_factor(const struct gm_hodge *hodge);
const struct gm_lu *gm_hodge_lu(const struct gm_hodge *hodge);
/* Writes the exact part of a 1-form, or its coexact one; edges. NaN when out of memory. */
void gm_hodge_exact(struct gm_hodge *hodge, const double *a, double *part);
void gm_hodge_coexact(struct gm_hodge *hodge, const double *a, double *part);

#endif
