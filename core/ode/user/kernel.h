/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system's formulas as the text of a kernel file (core/ode/compiled/over_kernels.c), to be compiled. */
#ifndef GM_CORE_ODE_USER_KERNEL_H
#define GM_CORE_ODE_USER_KERNEL_H

#include "core/expression/derivative.h"
#include "core/tape.h"

/* The functions of a kernel file. */
enum gm_kernel_function {
    GM_KERNEL_FIELD,
    GM_KERNEL_VELOCITY,
    GM_KERNEL_FORCE,
    GM_KERNEL_JACOBIAN,
    GM_KERNEL_ENERGY,
    GM_KERNEL_POTENTIAL, /* V, V', V'' */
    GM_KERNEL_FUNCTIONS
};

struct gm_kernel_source {
    size_t components;
    const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS]; /* NULL: there is none */
    const struct gm_sparse *jacobian;                 /* what the Jacobian's outputs are */
    bool
        jacobian_wanted; /* else it is left out where it is not there, or with it the text would be too large */
    /* Where constants are written out, and not led to by as many pointers as there are functions, problems
       lead by `parameters` to numbers: those inputs of the tapes from this one on. */
    bool written_out;
    size_t parameters;
};

/* Whether, of what has a velocity and a force, p alone moves q and q alone moves p also as they are
   written. */
bool gm_kernel_splits(const struct gm_kernel_source *source);

/* The text: a statement for every instruction of the tapes, in their order, so that the bits are those of the
   interpreter. It depends on how the tapes are made alone, not on constants that are led to, and no word of
   the system's text is in it. H = T(p) + V(q) where there is a force. malloc'ed; NULL with *lacks: why there
   is none, or NULL where memory is short. */
char *gm_kernel_text(const struct gm_kernel_source *source, const char **lacks);

#endif
