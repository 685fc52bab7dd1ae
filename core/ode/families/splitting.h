/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a splitting method, which its loop over kernels reads at run time. */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_H

enum { GM_SPLITTING_PIECES = 64 };

enum gm_piece { GM_DRIFT, GM_KICK };

/* A composition of exact flows: the pieces in the order in which they act, each with its fraction of h. */
struct gm_splitting {
    int count;
    struct {
        enum gm_piece piece;
        double fraction;
    } pieces[GM_SPLITTING_PIECES];
};

#endif
