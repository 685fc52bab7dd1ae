/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss, Lobatto IIIA-IIIB and Radau IIA. abar of a pair that is symplectic is
       abar_ij = b_j (1 - a_ji / b_i);
   Gauss' is a itself; Radau's is taken as a, and is not symplectic. Hairer, Lubich & Wanner (2006), chapters
   II and IV. */
#include "core/mesh/solver.h"

#define ROOT_3 1.7320508075688772
#define ROOT_6 2.449489742783178

const struct gm_mesh_tableau gm_tableau_gauss2 = {1, false, {{0.5}}, {{0.5}}, {1}};

#define GAUSS_4                                                                                              \
    {                                                                                                        \
        {0.25, 0.25 - ROOT_3 / 6},                                                                           \
        {                                                                                                    \
            0.25 + ROOT_3 / 6, 0.25                                                                          \
        }                                                                                                    \
    }
const struct gm_mesh_tableau gm_tableau_gauss4 = {2, false, GAUSS_4, GAUSS_4, {0.5, 0.5}};

/* Lobatto IIIA and IIIB, abar_ij = b_j (1 - a_ji / b_i) */
const struct gm_mesh_tableau gm_tableau_lobatto2 = {
    2, true, {{0, 0}, {0.5, 0.5}}, {{0.5, 0}, {0.5, 0}}, {0.5, 0.5}};
const struct gm_mesh_tableau gm_tableau_lobatto4 = {
    3,
    true,
    {{0, 0, 0}, {5. / 24, 1. / 3, -1. / 24}, {1. / 6, 2. / 3, 1. / 6}},
    {{1. / 6, -1. / 6, 0}, {1. / 6, 1. / 3, 0}, {1. / 6, 5. / 6, 0}},
    {1. / 6, 2. / 3, 1. / 6}};

/* Radau IIA */
#define RADAU_3                                                                                              \
    {                                                                                                        \
        {5. / 12, -1. / 12},                                                                                 \
        {                                                                                                    \
            0.75, 0.25                                                                                       \
        }                                                                                                    \
    }
const struct gm_mesh_tableau gm_tableau_radau3 = {2, true, RADAU_3, RADAU_3, {0.75, 0.25}};

#define RADAU_5                                                                                              \
    {                                                                                                        \
        {(88 - 7 * ROOT_6) / 360, (296 - 169 * ROOT_6) / 1800, (-2 + 3 * ROOT_6) / 225},                     \
            {(296 + 169 * ROOT_6) / 1800, (88 + 7 * ROOT_6) / 360, (-2 - 3 * ROOT_6) / 225},                 \
        {                                                                                                    \
            (16 - ROOT_6) / 36, (16 + ROOT_6) / 36, 1. / 9                                                   \
        }                                                                                                    \
    }
const struct gm_mesh_tableau gm_tableau_radau5 = {
    3, true, RADAU_5, RADAU_5, {(16 - ROOT_6) / 36, (16 + ROOT_6) / 36, 1. / 9}};
