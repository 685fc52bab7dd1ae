/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lobatto IIIA-IIIB for the field and the mesh together, the mesh constraint g(q) = 0, q = (y, X), enforced
   by Lagrange multipliers. The mass matrix M is singular where the field is straight; so slack variables r
   with the Lagrangian L + rdot^T Dg(q) qdot and the constraint r = 0 are added:
       Q_i = q_n + h sum_j a_ij Qdot_j
       R_i =       h sum_j a_ij Rdot_j
       P_i = p_n + h sum_j abar_ij (G_j - Dg(Q_j)^T Lambda_j),   P_i = M(Q_i) Qdot_i + Dg(Q_i)^T Rdot_i
       B_i = B_n - h sum_j abar_ij mu_j,                         B_i = Dg(Q_i) Qdot_i
       G_j = d/dq [L + Rdot_j^T Dg(q) qdot] at (Q_j, Qdot_j)
       g(Q_i) = 0,   R_i = 0
   R_i = 0 leaves Rdot_j = kappa_j W, kappa in the kernel of a; eliminating mu with the left kernel l of abar
   leaves
       sum_i l_i Dg(Q_i) Qdot_i = 0
   So a node has the unknowns Qdot_1 ... Qdot_s, W, Lambda_1 ... Lambda_{s-1}. The last multiplier follows
   from the hidden constraint Dg qdot = 0 at the end of the step. Stages and steps are those of control.c. Tyranowski & Desbrun (2019), eqs. 95-98;
   L.O. Jay, SIAM J. Numer. Anal. 33 (1996) 368. */
#include "core/mesh/families/families.h"

#define EQUATIONS                                                                                                 \
    "Pᵢ = ∂L/∂q̇(Qᵢ, Q̇ᵢ) + Dg(Qᵢ)ᵀ Ṙᵢ = pₙ + h Σ āᵢⱼ (Gⱼ − Dg(Qⱼ)ᵀ Λⱼ)\n" \
    "Qᵢ = qₙ + h Σ aᵢⱼ Q̇ⱼ,  g(Qᵢ) = 0"
#define COMMON .family = &gm_family_multiplier, .claims = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE

static const struct gm_mesh_row lobatto2 = {&gm_mesh_multiplied, &gm_tableau_lobatto2, {1, -1}, {1, -1}};
const struct gm_mesh_row gm_mesh_multiplier4 = {
    &gm_mesh_multiplied, &gm_tableau_lobatto4, {1, -0.5, 1}, {1, -2, 1}};

static const struct gm_scheme schemes[] = {
    {
        .name = "multiplier-lobatto2",
        .title = "multiplier 2",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eqs. 95–98; L. O. Jay (1996)",
        .coefficients = &lobatto2,
        .order = 2,
        COMMON,
    },
    {
        .name = "multiplier-lobatto4",
        .title = "multiplier 4",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eqs. 95–98; L. O. Jay (1996)",
        .coefficients = &gm_mesh_multiplier4,
        .order = 4,
        COMMON,
    },
};

const struct gm_family gm_family_multiplier = {.title = "meshes held by Lagrange multipliers",
                                               GM_MESH_FAMILY_OF_STEPS};
