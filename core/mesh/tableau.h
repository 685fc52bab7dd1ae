/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_TABLEAU_H
#define GM_CORE_MESH_TABLEAU_H

#include <stdbool.h>
#include <stddef.h>

/* Partitioned Runge-Kutta coefficients: a for places, abar for momenta, the same weights b
   (Hairer, Lubich & Wanner 2006, chapters II and IV; Hairer & Wanner 1996, IV.5). */
enum { GM_STAGES = 3 };

struct gm_mesh_tableau {
    size_t stages;
    bool stiffly_accurate; /* the last stage is the end of the step, for places */
    double a[GM_STAGES][GM_STAGES], abar[GM_STAGES][GM_STAGES], b[GM_STAGES];
};

extern const struct gm_mesh_tableau gm_tableau_gauss2, gm_tableau_gauss4, gm_tableau_lobatto2,
    gm_tableau_lobatto4, gm_tableau_radau3, gm_tableau_radau5;

#endif
