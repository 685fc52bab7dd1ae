/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss, Lobatto IIIA-IIIB and Radau IIA. abar of a pair that is symplectic is
       abar_ij = b_j (1 - a_ji / b_i);
   Gauss' is a itself; Radau's is taken as a, and is not symplectic. Hairer, Lubich & Wanner (2006), chapters
   II and IV. */
#include "core/mesh/equations.h"

#define ROOT_3 1.7320508075688772
#define ROOT_6 2.449489742783178
/* the same coefficients for places and momenta */
#define BOTH(...) .a = {__VA_ARGS__}, .abar = {__VA_ARGS__}

/* clang-format off */
const struct gm_mesh_tableau gm_tableau_gauss2 = {.stages = 1, BOTH({0.5}), .b = {1}},
    gm_tableau_gauss4 = {
        .stages = 2, BOTH({0.25, 0.25 - ROOT_3 / 6}, {0.25 + ROOT_3 / 6, 0.25}), .b = {0.5, 0.5}},
    gm_tableau_lobatto2 = {
        .stages = 2, .stiffly_accurate = true,
        .a = {{0, 0}, {0.5, 0.5}}, .abar = {{0.5, 0}, {0.5, 0}}, .b = {0.5, 0.5},
        .kappa = {1, -1}, .left = {1, -1}},
    gm_tableau_lobatto4 = {
        .stages = 3, .stiffly_accurate = true,
        .a = {{0, 0, 0}, {5. / 24, 1. / 3, -1. / 24}, {1. / 6, 2. / 3, 1. / 6}},
        .abar = {{1. / 6, -1. / 6, 0}, {1. / 6, 1. / 3, 0}, {1. / 6, 5. / 6, 0}},
        .b = {1. / 6, 2. / 3, 1. / 6}, .kappa = {1, -0.5, 1}, .left = {1, -2, 1}},
    gm_tableau_radau3 = {
        .stages = 2, .stiffly_accurate = true, BOTH({5. / 12, -1. / 12}, {0.75, 0.25}), .b = {0.75, 0.25}},
    gm_tableau_radau5 = {
        .stages = 3, .stiffly_accurate = true,
        BOTH({(88 - 7 * ROOT_6) / 360, (296 - 169 * ROOT_6) / 1800, (-2 + 3 * ROOT_6) / 225},
             {(296 + 169 * ROOT_6) / 1800, (88 + 7 * ROOT_6) / 360, (-2 - 3 * ROOT_6) / 225},
             {(16 - ROOT_6) / 36, (16 + ROOT_6) / 36, 1. / 9}),
        .b = {(16 - ROOT_6) / 36, (16 + ROOT_6) / 36, 1. / 9}};
/* clang-format on */
