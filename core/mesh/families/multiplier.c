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
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/mesh/families/advance.h"
#include "core/mesh/families/families.h"
#include "core/mesh/families/multiplier.h"
#include "core/mesh/nodes.h"

struct workspace {
    struct gm_mesh mesh;
    const struct gm_multiplier *row;
    double h;
    const double *state;
    struct gm_solver solver;
    struct gm_elements stages[GM_STAGES];
    struct gm_elements ends; /* of a step: the start, then the end */
    struct gm_banded projection;
    double weights[3 * GM_STAGES];
    double *momenta;           /* 2 N, by node */
    double *forces[GM_STAGES]; /* 2 N, by node */
    double *slack;             /* N + 1, W_e - W_{e+1} of the elements */
    double *share[GM_STAGES];  /* N + 1, the same of the multipliers */
    double *motion;            /* 3 N */
};

static size_t stages_of(const struct workspace *work)
{
    return work->row->tableau->stages;
}

size_t gm_multiplier_memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_multiplier *row = scheme->coefficients;
    const size_t points = problem->n / 4;
    return gm_solver_memory(points, 3 * row->tableau->stages, 4 * points);
}

void gm_multiplier_workspace_close(void *workspace)
{
    struct workspace *work = workspace;
    for (size_t i = 0; i < GM_STAGES; i++) {
        gm_elements_close(&work->stages[i]);
    }
    gm_elements_close(&work->ends);
    gm_solver_close(&work->solver);
    gm_banded_close(&work->projection);
    free(work->momenta);
    free(work);
}

void *gm_multiplier_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    struct workspace *work = calloc(1, sizeof *work);
    if (!work) {
        return NULL;
    }
    gm_moving_mesh_of(problem)->describe(problem, &work->mesh);
    work->row = scheme->coefficients;
    const size_t points = work->mesh.points, stages = stages_of(work), per_node = 3 * stages;
    bool good = gm_elements_open(&work->ends, &work->mesh);
    for (size_t i = 0; i < stages; i++) {
        good = good && gm_elements_open(&work->stages[i], &work->mesh);
    }
    good = good && gm_solver_open(&work->solver, points, per_node, 2 * per_node - 1);
    good = good && gm_banded_open(&work->projection, 3 * points, 5);
    work->momenta = calloc((5 + 2 * stages) * points + (1 + stages) * (points + 1), sizeof *work->momenta);
    if (!good || !work->momenta) {
        gm_multiplier_workspace_close(work);
        return NULL;
    }
    work->motion = work->momenta + 2 * points;
    work->slack = work->motion + 3 * points;
    double *next = work->slack + points + 1;
    for (size_t i = 0; i < stages; i++) {
        work->forces[i] = next;
        work->share[i] = next + 2 * points;
        next += 3 * points + 1;
    }
    return work;
}

void gm_multiplier_workspace_reset(void *workspace)
{
    ((struct workspace *)workspace)->solver.stamp = 0;
}

static void place(void *self, const double *state, double step)
{
    struct workspace *work = self;
    work->h = step;
    const size_t points = work->mesh.points;
    work->state = state;
    gm_elements_place(&work->ends, state);
    gm_elements_evaluate(&work->ends, &work->mesh);
    for (size_t k = 1; k <= points; k++) {
        work->momenta[2 * k - 2] = gm_momentum_u(&work->ends, k);
        work->momenta[2 * k - 1] = gm_momentum_v(&work->ends, k);
    }
}

static void guess(void *self, double *unknowns)
{
    struct workspace *work = self;
    const size_t points = work->mesh.points, stages = stages_of(work);
    for (size_t k = 0; k < points; k++) {
        double *at = unknowns + k * 3 * stages;
        for (size_t i = 0; i < stages; i++) {
            at[2 * i] = work->state[2 * points + k];
            at[2 * i + 1] = work->state[3 * points + k];
            at[2 * stages + i] = 0;
        }
    }
}

/* The share of every element in a multiplier given at the nodes: lambda_e - lambda_{e+1}, none at the
   ends. */
static void spread(const double *unknowns, size_t points, size_t per_node, size_t offset, double *share)
{
    double left = 0;
    for (size_t e = 0; e < points; e++) {
        const double right = unknowns[e * per_node + offset];
        share[e] = left - right;
        left = right;
    }
    share[points] = left;
}

/* force = d/dq [l + omega ell-dot - Lambda ell] at the nodes */
static void force(const struct gm_elements *stage, const double *restrict slack, double kappa,
                  const double *restrict share, size_t points, double *restrict out)
{
    double y_left = 0, d_left = 0;
    for (size_t e = 0; e <= points; e++) {
        const double omega = kappa * slack[e], lambda = share ? share[e] : 0;
        const double at_y0 = stage->force_y0[e] + omega * stage->bend_y0[e] - lambda * stage->ell_y0[e];
        const double at_y1 = stage->force_y1[e] + omega * stage->bend_y1[e] - lambda * stage->ell_y1[e];
        const double at_d = stage->force_d[e] + omega * stage->bend_d[e] - lambda * stage->ell_d[e];
        if (e > 0) {
            out[2 * e - 2] = y_left + at_y0;
            out[2 * e - 1] = d_left - at_d;
        }
        y_left = at_y1;
        d_left = at_d;
    }
}

static bool residual(void *self, const double *unknowns, double *out)
{
    struct workspace *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t points = work->mesh.points, stages = tableau->stages, per_node = 3 * stages;
    const double h = work->h, *state = work->state;
    spread(unknowns, points, per_node, 2 * stages, work->slack);
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &work->stages[i];
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
        if (!gm_elements_evaluate(stage, &work->mesh)) {
            return false;
        }
        gm_elements_constrain(stage, &work->mesh);
        const bool has_multiplier = i + 1 < stages;
        if (has_multiplier) {
            spread(unknowns, points, per_node, 2 * stages + 1 + i, work->share[i]);
        }
        force(stage, work->slack, work->row->kappa[i], has_multiplier ? work->share[i] : NULL, points,
              work->forces[i]);
    }
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &work->stages[i];
        const double kappa = work->row->kappa[i], *abar = tableau->abar[i];
        const double *f0 = work->forces[0], *f1 = work->forces[1], *slack = work->slack;
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
            at[2 * i] = gm_momentum_u(stage, k) + before * stage->ell_y1[k - 1] + after * stage->ell_y0[k] -
                        work->momenta[y] - h * push_y;
            at[2 * i + 1] = gm_momentum_v(stage, k) + before * stage->ell_d[k - 1] - after * stage->ell_d[k] -
                            work->momenta[x] - h * push_x;
            const double hidden = work->row->left[i] * gm_jump(stage->rate, k);
            at[2 * stages] = i == 0 ? hidden : at[2 * stages] + hidden;
            if (i > 0) {
                at[2 * stages + i] = gm_jump(stage->ell, k);
            }
        }
    }
    return true;
}

static void jacobian(void *self, const double *unknowns, struct gm_banded *matrix)
{
    (void)unknowns;
    struct workspace *work = self;
    const struct gm_multiplier *row = work->row;
    const struct gm_tableau *tableau = row->tableau;
    const size_t points = work->mesh.points, stages = tableau->stages, per_node = 3 * stages;
    const double h = work->h;
    for (size_t e = 0; e <= points; e++) {
        struct gm_element_matrices at[GM_STAGES];
        double sway[GM_STAGES][4][4]; /* d P_i / dq = d2l / dqdot dq + omega hessian */
        double pull[GM_STAGES][4][4]; /* d force / dq */
        for (size_t i = 0; i < stages; i++) {
            gm_elements_matrices(&work->stages[i], &work->mesh, e, true, &at[i]);
            const double omega = row->kappa[i] * work->slack[e],
                         lambda = i + 1 < stages ? work->share[i][e] : 0;
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
            gm_nodes_add_column(matrix, points, per_node, e, rows, 2 * stages, 1, by_slack);
            for (size_t j = 0; j + 1 < stages; j++) {
                gm_nodes_add_column(matrix, points, per_node, e, rows, 2 * stages + 1 + j,
                                    h * tableau->abar[i][j], at[j].gradient);
            }
            for (size_t m = 0; m < stages; m++) {
                const struct gm_places columns = {2 * m, 2 * m + 1};
                double block[4][4];
                for (size_t a = 0; a < 4; a++) {
                    for (size_t b = 0; b < 4; b++) {
                        double sum = h * tableau->a[i][m] * sway[i][a][b] + (i == m ? at[i].mass[a][b] : 0) -
                                     h * tableau->abar[i][m] * sway[m][b][a];
                        for (size_t j = 0; j < stages; j++) {
                            sum -= h * h * tableau->abar[i][j] * tableau->a[j][m] * pull[j][a][b];
                        }
                        block[a][b] = sum;
                    }
                }
                gm_nodes_add(matrix, points, per_node, e, rows, columns, 1, block);
                double hidden[4];
                for (size_t b = 0; b < 4; b++) {
                    hidden[b] = row->left[i] *
                                (h * tableau->a[i][m] * at[i].bend[b] + (i == m ? at[i].gradient[b] : 0));
                }
                gm_nodes_add_row(matrix, points, per_node, e, 2 * stages, columns, 1, hidden);
                if (i > 0) {
                    gm_nodes_add_row(matrix, points, per_node, e, 2 * stages + i, columns,
                                     h * tableau->a[i][m], at[i].gradient);
                }
            }
        }
    }
}

/* The end of the step, from the solved stages, into `state`, where its start is. */
static enum gm_status finish(void *self, double *state, double *multiplier)
{
    struct workspace *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t points = work->mesh.points, stages = tableau->stages, per_node = 3 * stages;
    const struct gm_elements *last = &work->stages[stages - 1];
    struct gm_elements *ends = &work->ends;
    for (size_t k = 0; k < points; k++) {
        double y = work->momenta[2 * k], x = work->momenta[2 * k + 1];
        for (size_t i = 0; i < stages; i++) {
            y += work->h * tableau->b[i] * work->forces[i][2 * k];
            x += work->h * tableau->b[i] * work->forces[i][2 * k + 1];
        }
        work->motion[3 * k] = y;
        work->motion[3 * k + 1] = x;
    }
    memcpy(ends->y + 1, last->y + 1, points * sizeof *state);
    memcpy(ends->x + 1, last->x + 1, points * sizeof *state);
    if (!gm_elements_measure(ends, &work->mesh)) {
        return GM_MESH_CROSSING;
    }
    if (!gm_nodes_project(ends, &work->mesh, &work->projection, work->motion)) {
        return GM_NO_CONVERGENCE;
    }
    double largest = 0;
    for (size_t k = 0; k < points; k++) {
        state[k] = ends->y[k + 1];
        state[points + k] = ends->x[k + 1];
        state[2 * points + k] = work->motion[3 * k];
        state[3 * points + k] = work->motion[3 * k + 1];
        largest = fmax(largest, fabs(work->solver.unknowns[k * per_node + 2 * stages + 1]));
    }
    *multiplier = largest;
    return GM_OK;
}

enum gm_status gm_multiplier_start(const struct gm_task *task)
{
    struct workspace *work = task->workspace;
    gm_solver_start(&work->solver, task->memory_out);
    return gm_mesh_carry(&work->mesh, GM_MESH_MOVING, task->y, task->out) ? GM_OK : GM_MESH_CROSSING;
}

struct gm_progress gm_multiplier_advance(const struct gm_task *task)
{
    struct workspace *work = task->workspace;
    const size_t points = work->mesh.points, stages = stages_of(work), per_node = 3 * stages;
    /* multipliers of constraints on places carry round-off divided by the squared step */
    for (size_t i = 0; i < per_node; i++) {
        work->weights[i] = i > 2 * stages ? fabs(task->dt) : 1;
    }
    const struct gm_step_equations equations = {
        .self = work,
        .nodes = points,
        .per_node = per_node,
        .state = 4 * points,
        .noise = DBL_EPSILON * work->mesh.length / fabs(task->dt),
        .weights = work->weights,
        .step = task->dt,
        .place = place,
        .guess = guess,
        .residual = residual,
        .jacobian = jacobian,
    };
    return gm_mesh_advance(task, &work->solver, &equations, finish);
}

#define EQUATIONS                                                                                                 \
    "Pᵢ = ∂L/∂q̇(Qᵢ, Q̇ᵢ) + Dg(Qᵢ)ᵀ Ṙᵢ = pₙ + h Σ āᵢⱼ (Gⱼ − Dg(Qⱼ)ᵀ Λⱼ)\n" \
    "Qᵢ = qₙ + h Σ aᵢⱼ Q̇ⱼ,  g(Qᵢ) = 0"
#define COMMON .family = &gm_family_multiplier, .claims = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE

static const struct gm_multiplier lobatto2 = {&gm_tableau_lobatto2, {1, -1}, {1, -1}};
const struct gm_multiplier gm_multiplier_lobatto4 = {&gm_tableau_lobatto4, {1, -0.5, 1}, {1, -2, 1}};

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
        .coefficients = &gm_multiplier_lobatto4,
        .order = 4,
        COMMON,
    },
};

const struct gm_family gm_family_multiplier = {
    .kind = &gm_kind_mesh,
    .title = "meshes held by Lagrange multipliers",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = gm_multiplier_advance,
    .memory = gm_multiplier_memory,
    .start = gm_multiplier_start,
    .workspace_open = gm_multiplier_workspace_open,
    .workspace_close = gm_multiplier_workspace_close,
    .workspace_reset = gm_multiplier_workspace_reset,
};
