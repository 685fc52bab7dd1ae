/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multiplier strategy with a time-symmetric step: the density rho of steps follows the mesh,
       rho_{n+1/2} = rho_n + dt/2 G(q_n, qdot_n)
       h           = dt / rho_{n+1/2}
       rho_{n+1}   = rho_{n+1/2} + dt/2 G(q_{n+1}, qdot_{n+1})
       G           = d/dt log sigma,   sigma = (c^-4 + sum_e d_e^-4)^(1/8),   rho_0 = 1
   with d_e the cells' widths and c = 0.208 of their mean: steps shrink with the smallest cells, as the square
   root, and do not grow without bound where all cells are wide. Changing the signs of dt and of the run of
   time undoes it exactly: (q, p, rho) is reversible. It delays the loss of energy on coarse meshes with a
   strong density; a density that is limited (core/mesh/moving_mesh.h) prevents it. E. Hairer & G. Soderlind,
   SIAM J. Sci. Comput. 26 (2005) 1838; Tyranowski & Desbrun (2019), section 6.3, leave this step open. */
#include "core/mesh/families/families.h"
#include "core/mesh_scheme_texts.h"

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_multiplier_adaptive4, .family = &gm_family_adaptive,
     .coefficients = &(const struct gm_mesh_row){.kind = GM_MESH_MOVING,
                                                 .tableau = &gm_tableau_lobatto4,
                                                 .multiplied = true}},
};

const struct gm_family gm_family_adaptive = {
    .title = "moving meshes with a time-symmetric step", GM_MESH_FAMILY, .adaptive = true};
