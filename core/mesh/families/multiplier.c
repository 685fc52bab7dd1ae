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
   from the hidden constraint Dg qdot = 0 at the end of the step. Tyranowski & Desbrun (2019), eqs. 95-98;
   L.O. Jay, SIAM J. Numer. Anal. 33 (1996) 368. */
#include <math.h>
#include <string.h>

#include "core/mesh/families/families.h"

/* Multipliers of constraints on places carry round-off divided by the squared step. */
static double weight(size_t stages, size_t unknown, double step)
{
    return unknown > 2 * stages ? step : 1;
}

static void guess(const struct gm_mesh_solver *solver, double *unknowns)
{
    const size_t points = solver->mesh.points, stages = solver->stages;
    for (size_t k = 0; k < points; k++) {
        double *at = unknowns + k * solver->per_node;
        for (size_t i = 0; i < stages; i++) {
            at[2 * i] = solver->state[2 * points + k];
            at[2 * i + 1] = solver->state[3 * points + k];
            at[2 * stages + i] = 0;
        }
    }
}

/* force = d/dq [l + omega ell-dot - Lambda ell] at the nodes */
static void force(const struct gm_elements *stage, const double *restrict slack, double kappa,
                  const double *restrict share, size_t points, double *restrict out)
{
    double *const *bend = stage->bend, *const *by = stage->gradient;
    double y_left = 0, x_left = 0;
    for (size_t e = 0; e <= points; e++) {
        const double omega = kappa * slack[e], lambda = share ? share[e] : 0;
        if (e > 0) {
            out[2 * e - 2] = y_left + stage->force_y0[e] + omega * bend[0][e] - lambda * by[0][e];
            out[2 * e - 1] = x_left - stage->force_d[e] + omega * bend[1][e] - lambda * by[1][e];
        }
        y_left = stage->force_y1[e] + omega * bend[2][e] - lambda * by[2][e];
        x_left = stage->force_d[e] + omega * bend[3][e] - lambda * by[3][e];
    }
}

static bool residual(struct gm_mesh_solver *solver, const double *unknowns, double *out)
{
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t points = solver->mesh.points, stages = solver->stages, per_node = solver->per_node;
    const double h = solver->h, *state = solver->state;
    gm_nodes_spread(unknowns, points, per_node, 2 * stages, solver->slack);
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &solver->stage[i];
        const double *a = tableau->a[i];
        for (size_t k = 0; k < points; k++) {
            const double *at = unknowns + k * per_node;
            double rise = a[0] * at[0] + a[1] * at[2], shift = a[0] * at[1] + a[1] * at[3];
            if (stages == 3) {
                rise += a[2] * at[4];
                shift += a[2] * at[5];
            }
            stage->y[k + 1] = state[k] + h * rise;
            stage->x[k + 1] = state[points + k] + h * shift;
            stage->u[k + 1] = at[2 * i];
            stage->v[k + 1] = at[2 * i + 1];
        }
        if (!gm_elements_evaluate(stage, &solver->mesh)) {
            return false;
        }
        gm_elements_constrain(stage, &solver->mesh);
        const bool has_multiplier = i + 1 < stages;
        if (has_multiplier) {
            gm_nodes_spread(unknowns, points, per_node, 2 * stages + 1 + i, solver->share[i]);
        }
        force(stage, solver->slack, solver->row->kappa[i], has_multiplier ? solver->share[i] : NULL, points,
              solver->forces[i]);
    }
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &solver->stage[i];
        const double kappa = solver->row->kappa[i], *abar = tableau->abar[i];
        const double *f0 = solver->forces[0], *f1 = solver->forces[1], *slack = solver->slack;
        for (size_t k = 1; k <= points; k++) {
            double *at = out + (k - 1) * per_node;
            const size_t y = 2 * k - 2, x = 2 * k - 1;
            /* the last column of abar is zero */
            double push_y = abar[0] * f0[y], push_x = abar[0] * f0[x];
            if (stages == 3) {
                push_y += abar[1] * f1[y];
                push_x += abar[1] * f1[x];
            }
            const double before = kappa * slack[k - 1], after = kappa * slack[k];
            double *const *by = stage->gradient;
            at[2 * i] = gm_momentum_u(stage, k) + before * by[2][k - 1] + after * by[0][k] -
                        solver->momenta[y] - h * push_y;
            at[2 * i + 1] = gm_momentum_v(stage, k) + before * by[3][k - 1] + after * by[1][k] -
                            solver->momenta[x] - h * push_x;
            const double hidden = solver->row->left[i] * gm_jump(stage->rate, k);
            at[2 * stages] = i == 0 ? hidden : at[2 * stages] + hidden;
            if (i > 0) {
                at[2 * stages + i] = gm_jump(stage->ell, k);
            }
        }
    }
    return true;
}

static void jacobian(struct gm_mesh_solver *solver, const struct gm_assembly *assembly)
{
    const struct gm_mesh_row *row = solver->row;
    const struct gm_mesh_tableau *tableau = row->tableau;
    const size_t e = assembly->element, stages = solver->stages;
    const double h = solver->h;
    struct gm_element_matrices at[GM_STAGES];
    double sway[GM_STAGES][4][4]; /* d P_i / dq = d2l / dqdot dq + omega hessian */
    double pull[GM_STAGES][4][4]; /* d force / dq */
    for (size_t i = 0; i < stages; i++) {
        gm_elements_matrices(&solver->stage[i], &solver->mesh, e, true, &at[i]);
        const double omega = row->kappa[i] * solver->slack[e],
                     lambda = i + 1 < stages ? solver->share[i][e] : 0;
        for (size_t a = 0; a < 4; a++) {
            for (size_t b = 0; b < 4; b++) {
                sway[i][a][b] = at[i].mixed[a][b] + omega * at[i].hessian[a][b];
                pull[i][a][b] = at[i].stiff[a][b] - lambda * at[i].hessian[a][b];
            }
        }
    }
    for (size_t i = 0; i < stages; i++) {
        const struct gm_places rows = {2 * i, 2 * i + 1};
        double by_slack[4];
        for (size_t a = 0; a < 4; a++) {
            by_slack[a] = row->kappa[i] * at[i].gradient[a];
            for (size_t j = 0; j < stages; j++) {
                by_slack[a] -= h * tableau->abar[i][j] * row->kappa[j] * at[j].bend[a];
            }
        }
        gm_nodes_add_column(assembly, rows, 2 * stages, 1, by_slack);
        for (size_t j = 0; j + 1 < stages; j++) {
            gm_nodes_add_column(assembly, rows, 2 * stages + 1 + j, h * tableau->abar[i][j], at[j].gradient);
        }
        for (size_t m = 0; m < stages; m++) {
            const struct gm_places columns = {2 * m, 2 * m + 1};
            const double moved = h * tableau->a[i][m];
            double block[4][4], hidden[4], held[4];
            for (size_t a = 0; a < 4; a++) {
                for (size_t b = 0; b < 4; b++) {
                    block[a][b] = moved * sway[i][a][b] + (i == m ? at[i].mass[a][b] : 0) -
                                  h * tableau->abar[i][m] * sway[m][b][a];
                    for (size_t j = 0; j < stages; j++) {
                        block[a][b] -= h * h * tableau->abar[i][j] * tableau->a[j][m] * pull[j][a][b];
                    }
                }
                hidden[a] = row->left[i] * (moved * at[i].bend[a] + (i == m ? at[i].gradient[a] : 0));
                held[a] = moved * at[i].gradient[a];
            }
            gm_nodes_add(assembly, rows, columns, block);
            gm_nodes_add_row(assembly, 2 * stages, columns, hidden);
            if (i > 0) {
                gm_nodes_add_row(assembly, 2 * stages + i, columns, held);
            }
        }
    }
}

static struct gm_elements *end(struct gm_mesh_solver *solver, double *multiplier)
{
    const double *weights = solver->row->tableau->b;
    const size_t points = solver->mesh.points, stages = solver->stages;
    const struct gm_elements *last = &solver->stage[stages - 1];
    struct gm_elements *ends = &solver->ends;
    for (size_t k = 0; k < points; k++) {
        for (size_t c = 0; c < 2; c++) {
            double sum = solver->momenta[2 * k + c];
            for (size_t i = 0; i < stages; i++) {
                sum += solver->h * weights[i] * solver->forces[i][2 * k + c];
            }
            solver->motion[3 * k + c] = sum;
        }
    }
    memcpy(ends->y + 1, last->y + 1, points * sizeof *ends->y);
    memcpy(ends->x + 1, last->x + 1, points * sizeof *ends->x);
    *multiplier = gm_mesh_largest(solver, 2 * stages + 1);
    return gm_elements_measure(ends, &solver->mesh) ? ends : NULL;
}

static const struct gm_mesh_strategy strategy = {
    .kind = GM_MESH_MOVING,
    .unknowns = 3,
    .projected = 3,
    .weight = weight,
    .guess = guess,
    .residual = residual,
    .jacobian = jacobian,
    .end = end,
};

#define EQUATIONS                                                                                                 \
    "Pᵢ = ∂L/∂q̇(Qᵢ, Q̇ᵢ) + Dg(Qᵢ)ᵀ Ṙᵢ = pₙ + h Σ āᵢⱼ (Gⱼ − Dg(Qⱼ)ᵀ Λⱼ)\n" \
    "Qᵢ = qₙ + h Σ aᵢⱼ Q̇ⱼ,  g(Qᵢ) = 0"
#define COMMON .family = &gm_family_multiplier, .claims = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE

static const struct gm_mesh_row lobatto2 = {&strategy, &gm_tableau_lobatto2, {1, -1}, {1, -1}};
const struct gm_mesh_row gm_mesh_multiplier4 = {&strategy, &gm_tableau_lobatto4, {1, -0.5, 1}, {1, -2, 1}};

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
