/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system's formulas as the text of a kernel file (core/ode/compiled/over_kernels.c), to be compiled. */
#ifndef GM_CORE_ODE_USER_KERNEL_H
#define GM_CORE_ODE_USER_KERNEL_H

#include "core/expression/derivative.h"
#include "core/ode/kernel/digest.h"
#include "core/tape.h"

/* The functions of a kernel file. */
enum gm_kernel_function {
    GM_KERNEL_FIELD,
    GM_KERNEL_VELOCITY,
    GM_KERNEL_FORCE,
    GM_KERNEL_JACOBIAN,
    GM_KERNEL_ENERGY,
    GM_KERNEL_POTENTIAL, /* V, V', V'' */
    GM_KERNEL_SURFACES,  /* of frozen switches: above 0 on their side */
    GM_KERNEL_FUNCTIONS
};

struct gm_kernel_source {
    size_t components;
    const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS]; /* NULL: the function is missing */
    const struct gm_sparse *jacobian;                 /* the entries that the Jacobian's outputs are */
    bool jacobian_wanted; /* true: no text without it; false: omitted if too large */
    /* true: constants are written out and `parameters` points to numbers, the tapes' inputs from this one on.
       false: `parameters` points to one array of constants per function. */
    bool written_out;
    size_t parameters;
};

/* Returns true if, as written, p alone moves q and q alone moves p; velocity and force must be given. */
bool gm_kernel_splits(const struct gm_kernel_source *source);

/* Returns the text: a statement for every instruction of the tapes, in their order, so that the bits are
   those of the interpreter. It depends only on the structure of the tapes, not on constants behind pointers,
   and holds no word of the system's text. H = T(p) + V(q) if there is a force. The caller frees. Returns NULL
   with the reason in *lacks, which is NULL when out of memory. */
char *gm_kernel_text(const struct gm_kernel_source *source, const char **lacks);

/* Returns the digest of a text's functions. The layout of structs, which the rest asserts, is another one in a browser than
   on the machine that writes the text. */
struct gm_digest gm_kernel_digest(const char *text);

#endif
