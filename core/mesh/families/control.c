/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Partitioned Runge-Kutta methods for the field on a mesh whose equation is one of five. At the stages i
       Y_i = y_n + h sum_j a_ij Ydot_j
       P_i = p_n + h sum_j abar_ij F_j
       P_i = dL/dydot(Y_i, Q_i, Ydot_i, Qdot_i),   F_j = dL/dy(Y_j, Q_j, Ydot_j, Qdot_j)
   and
       held      g(Y_i, Q_i) = 0,   d/dt g = Dg(Y_i, Q_i) (Ydot_i, Qdot_i) = 0
                 the control-theoretic strategy, with unknowns Ydot_i, Q_i, Qdot_i
       relaxed   E Qdot_i = g(Y_i, Q_i),   Q_i = X_n + h sum_j a_ij Qdot_j,   E = 2 length T / (N + 1)^3
                 the same smoothed in time: with density 1 the slowest mode of the mesh decays as exp(-pi^2 t / T)
       free      dL/dXdot at the stages is p_n + h sum_j abar_ij dL/dX, as that of y, and so is Q_i: nothing holds the
                 mesh, whose cells may have a Lagrangian of their own (section 3.3, remarks 1 to 4)
       multiplied   the same with the mesh held by Lagrange multipliers, whose equations multiplier.c states
       known     Q_i = F(x, t_n + c_i h),   Qdot_i = F_t(x, t_n + c_i h);   uniform: F = x
   The mesh is an explicit function of time for the Lagrangian, so symplecticity in (y, p) does not conserve
   its energy. On a known mesh the midpoint rule (gauss2) comes from a discrete Lagrangian of the elements, and on the
   uniform one the trapezoidal rule (lobatto2) too: they are multisymplectic; more stages couple all elements.
   Tyranowski & Desbrun (2019), eqs. 20 and 21, propositions 2 to 4, sections 2.6, 4.2 and 6.5. */
#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/mesh/families/families.h"
#include "core/mesh_scheme_texts.h"

/* Unknowns at a node, stage by stage: dy/dt, then X of a mesh that is held, then dX/dt unless it is known; and behind all
   stages, if the constraint has multipliers, the slack W and Lambda_1 ... Lambda_{s-1}. */
struct layout {
    size_t per_stage, rate; /* the number of dX/dt; 0: it is known */
    size_t slack;           /* the number of W; 0: there are no multipliers */
    bool held, drifts;      /* drifts: X follows from dX/dt, as y from dy/dt */
    bool relaxed, pushed;   /* pushed: X has momenta, as y */
    bool constrained;       /* the density takes part */
};

static struct layout layout_of(const struct gm_mesh_solver *solver)
{
    const struct gm_mesh_strategy *strategy = solver->strategy;
    const size_t per_stage = strategy->multiplied ? 2 : strategy->unknowns;
    const bool drifts = per_stage == 2, pushed = strategy->free || strategy->multiplied;
    return (struct layout){.per_stage = per_stage,
                           .rate = per_stage - 1,
                           .slack = strategy->multiplied ? 2 * solver->stages : 0,
                           .held = per_stage == 3,
                           .drifts = drifts,
                           .relaxed = drifts && !pushed,
                           .pushed = pushed,
                           .constrained = per_stage > 1 && !strategy->free};
}

/* E of a mesh that is smoothed in time */
static double friction(const struct gm_mesh *mesh)
{
    return 2 * mesh->length * mesh->relax / gm_pow((double)mesh->points + 1, 3);
}

static void guess(const struct gm_mesh_solver *solver, double *unknowns)
{
    const struct layout of = layout_of(solver);
    const size_t points = solver->mesh.points;
    for (size_t k = 0; k < points; k++) {
        for (size_t i = 0; i < solver->stages; i++) {
            double *at = unknowns + k * solver->per_node + i * of.per_stage;
            at[0] = solver->state[2 * points + k];
            if (of.held) {
                at[1] = solver->state[points + k];
            }
            if (of.rate > 0) {
                at[of.rate] = solver->state[3 * points + k];
            }
        }
        for (size_t i = 0; i < solver->stages && of.slack > 0; i++) {
            unknowns[k * solver->per_node + of.slack + i] = 0;
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

/* The forces at the nodes at stage i, of which X takes part in those of y alone if it has no momenta. */
static void find_forces(struct gm_mesh_solver *solver, const struct layout *of, const double *unknowns,
                        size_t i)
{
    const struct gm_elements *stage = &solver->stage[i];
    const size_t points = solver->mesh.points;
    double *out = solver->forces[i];
    if (of->slack > 0) {
        const bool has_multiplier = i + 1 < solver->stages;
        if (has_multiplier) {
            gm_nodes_spread(unknowns, points, solver->per_node, of->slack + 1 + i, solver->share[i]);
        }
        force(stage, solver->slack, solver->row->kappa[i], has_multiplier ? solver->share[i] : NULL, points,
              out);
        return;
    }
    for (size_t k = 1; k <= points; k++) {
        out[2 * k - 2] = gm_force_y(stage, k);
        out[2 * k - 1] = of->pushed ? gm_force_x(stage, k) : 0;
    }
}

/* It is compiled for each number of stages, which unrolls its inner loops. */
static inline __attribute__((always_inline)) bool residual_of(struct gm_mesh_solver *solver, size_t stages,
                                                              const double *unknowns, double *out)
{
    const struct layout of = layout_of(solver);
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t points = solver->mesh.points, per_node = solver->per_node;
    const size_t acting = of.slack > 0 ? stages - 1 : stages; /* the last column of abar is zero then */
    const double h = solver->h, *state = solver->state, *momenta = solver->momenta;
    if (of.slack > 0) {
        gm_nodes_spread(unknowns, points, per_node, of.slack, solver->slack);
    }
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &solver->stage[i];
        const double *a = tableau->a[i];
        for (size_t k = 0; k < points; k++) {
            const double *at = unknowns + k * per_node, *here = at + i * of.per_stage;
            double rise = 0, shift = 0;
            for (size_t j = 0; j < stages; j++) {
                rise += a[j] * at[j * of.per_stage];
                shift += of.drifts ? a[j] * at[j * of.per_stage + 1] : 0;
            }
            stage->y[k + 1] = state[k] + h * rise;
            stage->u[k + 1] = here[0];
            if (of.rate > 0) {
                stage->x[k + 1] = of.held ? here[1] : state[points + k] + h * shift;
                stage->v[k + 1] = here[of.rate];
            }
        }
        if (!gm_elements_evaluate(stage, &solver->mesh)) {
            return false;
        }
        if (of.constrained) {
            gm_elements_constrain(stage, &solver->mesh);
        }
        find_forces(solver, &of, unknowns, i);
    }
    const double resists = friction(&solver->mesh), *slack = solver->slack;
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &solver->stage[i];
        const double kappa = solver->row->kappa[i], left = solver->row->left[i], *abar = tableau->abar[i];
        double *const *by = stage->gradient;
        for (size_t k = 1; k <= points; k++) {
            double *node = out + (k - 1) * per_node, *at = node + i * of.per_stage;
            double sum = 0, sum_x = 0, p_y = gm_momentum_u(stage, k),
                   p_x = of.pushed ? gm_momentum_v(stage, k) : 0;
            for (size_t j = 0; j < acting; j++) {
                sum += abar[j] * solver->forces[j][2 * k - 2];
                sum_x += abar[j] * solver->forces[j][2 * k - 1];
            }
            if (of.slack > 0) {
                const double before = kappa * slack[k - 1], after = kappa * slack[k],
                             hidden = left * gm_jump(stage->rate, k);
                p_y = p_y + before * by[2][k - 1] + after * by[0][k];
                p_x = p_x + before * by[3][k - 1] + after * by[1][k];
                node[of.slack] = i == 0 ? hidden : node[of.slack] + hidden;
                if (i > 0) {
                    node[of.slack + i] = gm_jump(stage->ell, k);
                }
            }
            at[0] = p_y - momenta[2 * k - 2] - h * sum;
            if (of.held) {
                at[1] = gm_jump(stage->ell, k);
                at[2] = gm_jump(stage->rate, k);
            } else if (of.relaxed) {
                at[1] = resists * stage->v[k] - gm_jump(stage->ell, k);
            } else if (of.pushed) {
                at[1] = p_x - momenta[2 * k - 1] - h * sum_x;
            }
        }
    }
    return true;
}

static bool residual(struct gm_mesh_solver *solver, const double *unknowns, double *out)
{
    switch (solver->stages) {
    case 1:
        return residual_of(solver, 1, unknowns, out);
    case 2:
        return residual_of(solver, 2, unknowns, out);
    default:
        return residual_of(solver, GM_STAGES, unknowns, out);
    }
}

/* Derivatives of z and zdot at the stages by an unknown of one stage: dy/dt and dX/dt move places by h a_im, and X
   itself, if it is held, moves its own. */
struct follows {
    double place[GM_STAGES], rate[GM_STAGES];
};

static struct follows follow(const struct gm_mesh_solver *solver, size_t m, size_t unknown)
{
    const struct layout of = layout_of(solver);
    struct follows made = {0};
    for (size_t i = 0; i < solver->stages; i++) {
        const double moved = solver->h * solver->row->tableau->a[i][m], own = i == m;
        made.place[i] = !of.held || unknown == 0 ? moved : unknown == 1 ? own : 0;
        made.rate[i] = of.held && unknown == 1 ? 0 : own;
    }
    return made;
}

/* Adds what the slack and the multipliers do to the derivatives of momenta and forces, and their columns. */
static void add_multipliers(const struct gm_mesh_solver *solver, const struct gm_assembly *assembly,
                            struct gm_element_matrices at[GM_STAGES])
{
    const struct gm_mesh_row *row = solver->row;
    const size_t e = assembly->element, stages = solver->stages;
    for (size_t i = 0; i < stages; i++) {
        const double omega = row->kappa[i] * solver->slack[e],
                     lambda = i + 1 < stages ? solver->share[i][e] : 0;
        const double *abar = row->tableau->abar[i];
        const struct gm_places rows = {2 * i, 2 * i + 1};
        double by_slack[4];
        for (size_t a = 0; a < 4; a++) {
            for (size_t b = 0; b < 4; b++) {
                at[i].mixed[a][b] += omega * at[i].hessian[a][b];
                at[i].stiff[a][b] -= lambda * at[i].hessian[a][b];
            }
            by_slack[a] = row->kappa[i] * at[i].gradient[a];
            for (size_t j = 0; j < stages; j++) {
                by_slack[a] -= solver->h * abar[j] * row->kappa[j] * at[j].bend[a];
            }
        }
        gm_nodes_add_column(assembly, rows, 2 * stages, 1, by_slack);
        for (size_t j = 0; j + 1 < stages; j++) {
            gm_nodes_add_column(assembly, rows, 2 * stages + 1 + j, solver->h * abar[j], at[j].gradient);
        }
    }
}

static void jacobian(struct gm_mesh_solver *solver, const struct gm_assembly *assembly)
{
    const struct layout of = layout_of(solver);
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t stages = solver->stages;
    const double share = friction(&solver->mesh) / 2; /* a node is in two elements */
    struct gm_element_matrices at[GM_STAGES] = {0};
    for (size_t i = 0; i < stages; i++) {
        gm_elements_matrices(&solver->stage[i], &solver->mesh, assembly->element, of.constrained, &at[i]);
    }
    if (of.slack > 0) {
        add_multipliers(solver, assembly, at);
    }
    /* the columns of dy/dt and the next unknown together, then those of dX/dt where X is held */
    for (size_t k = 0; k < stages * (1 + of.held); k++) {
        const size_t m = k % stages, last = k / stages, column = m * of.per_stage;
        const struct gm_places columns = {last ? GM_NOWHERE : column,
                                          of.rate > 0 ? column + 1 + last : GM_NOWHERE};
        const struct follows by[2] = {follow(solver, m, 0), follow(solver, m, 1 + last)};
        for (size_t i = 0; i < stages; i++) {
            const size_t row = i * of.per_stage;
            double block[4][4], ell[4], rate[4], resists[4][4] = {{0}};
            for (size_t b = last; b < 4; b += 1 + (last > 0 || of.rate == 0)) {
                const double *place = by[b % 2].place, *own = by[b % 2].rate;
                for (size_t a = 0; a < 4; a++) {
                    double pushed = 0;
                    for (size_t j = 0; j < stages; j++) {
                        pushed +=
                            tableau->abar[i][j] * (place[j] * at[j].stiff[a][b] + own[j] * at[j].mixed[b][a]);
                    }
                    block[a][b] =
                        place[i] * at[i].mixed[a][b] + own[i] * at[i].mass[a][b] - solver->h * pushed;
                }
                resists[b][b] = share * own[i];
                ell[b] = (of.relaxed ? -1 : 1) * place[i] * at[i].gradient[b];
                rate[b] = (of.slack > 0 ? solver->row->left[i] : 1) *
                          (place[i] * at[i].bend[b] + own[i] * at[i].gradient[b]);
            }
            gm_nodes_add(assembly, (struct gm_places){row, of.pushed ? row + 1 : GM_NOWHERE}, columns, block);
            if (of.slack > 0) {
                gm_nodes_add_row(assembly, of.slack, columns, rate);
            }
            if (of.constrained && !last && !(of.slack > 0 && i == 0)) {
                gm_nodes_add_row(assembly, of.slack > 0 ? of.slack + i : row + 1, columns, ell);
            }
            if (of.held) {
                gm_nodes_add_row(assembly, row + 2, columns, rate);
            } else if (of.relaxed) {
                gm_nodes_add(assembly, (struct gm_places){GM_NOWHERE, row + 1},
                             (struct gm_places){GM_NOWHERE, column + 1}, resists);
            }
        }
    }
}

/* The velocities of momenta dL/dqdot = p, from those at hand: one step of Newton's method if L has squares of velocities
   alone. False if it finds none. */
static bool set_free(struct gm_mesh_solver *solver, struct gm_elements *ends, const double *p)
{
    enum { MOST = 20 };
    const size_t points = solver->mesh.points;
    const struct gm_places both = {0, 1};
    struct gm_banded *matrix = &solver->projection;
    double change = INFINITY, *step = solver->trial;
    for (int i = 0; i < MOST && change > 1e-13; i++) {
        if (!gm_elements_evaluate(ends, &solver->mesh)) {
            return false;
        }
        gm_banded_clear(matrix);
        for (size_t e = 0; e <= points; e++) {
            struct gm_element_matrices at;
            gm_elements_matrices(ends, &solver->mesh, e, false, &at);
            gm_nodes_add(&(struct gm_assembly){matrix, points, 2, e}, both, both, at.mass);
        }
        for (size_t k = 1; k <= points; k++) {
            step[2 * k - 2] = p[2 * k - 2] - gm_momentum_u(ends, k);
            step[2 * k - 1] = p[2 * k - 1] - gm_momentum_v(ends, k);
        }
        if (!gm_banded_factor(matrix)) {
            return false;
        }
        gm_banded_solve(matrix, step);
        change = 0;
        for (size_t k = 1; k <= points; k++) {
            ends->u[k] += step[2 * k - 2];
            ends->v[k] += step[2 * k - 1];
            change = fmax(change, fmax(fabs(step[2 * k - 2]) / (1 + fabs(ends->u[k])),
                                       fabs(step[2 * k - 1]) / (1 + fabs(ends->v[k]))));
        }
    }
    return change < 1e-9;
}

static struct gm_elements *end(struct gm_mesh_solver *solver, double *multiplier)
{
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t points = solver->mesh.points, stages = solver->stages, moves = solver->strategy->projected;
    const struct layout of = layout_of(solver);
    struct gm_elements *ends = &solver->ends;
    for (size_t k = 1; k <= points; k++) {
        double rise = 0, force = 0, shift = 0, force_x = 0;
        for (size_t i = 0; i < stages; i++) {
            const struct gm_elements *stage = &solver->stage[i];
            rise += tableau->b[i] * stage->u[k];
            shift += tableau->b[i] * stage->v[k];
            force += tableau->b[i] * solver->forces[i][2 * k - 2];
            force_x += tableau->b[i] * solver->forces[i][2 * k - 1];
        }
        ends->y[k] = solver->state[k - 1] + solver->h * rise;
        ends->x[k] = tableau->stiffly_accurate ? solver->stage[stages - 1].x[k]
                                               : solver->state[points + k - 1] + solver->h * shift;
        solver->motion[moves * (k - 1)] = solver->momenta[2 * k - 2] + solver->h * force;
        if (of.pushed) {
            solver->motion[moves * (k - 1) + 1] = solver->momenta[2 * k - 1] + solver->h * force_x;
        }
    }
    if (solver->strategy->free) {
        const bool found = set_free(solver, ends, solver->motion);
        for (size_t k = 0; k < points; k++) {
            solver->motion[2 * k] = ends->u[k + 1];
            solver->motion[2 * k + 1] = ends->v[k + 1];
        }
        return found ? ends : NULL;
    }
    if (of.rate == 0) {
        gm_mesh_known(&solver->mesh, solver->strategy->kind, solver->t + solver->h, ends);
        return gm_elements_measure(ends, &solver->mesh) ? ends : NULL;
    }
    if (of.slack > 0) {
        *multiplier = gm_mesh_largest(solver, of.slack + 1);
    }
    const bool good =
        of.held && !tableau->stiffly_accurate
            ? gm_nodes_equidistribute(ends, &solver->mesh, NULL, NULL, &solver->places, solver->trial)
            : gm_elements_measure(ends, &solver->mesh);
    for (size_t k = 1; of.relaxed && k <= points; k++) {
        ends->v[k] = gm_jump(ends->ell, k) / friction(&solver->mesh);
    }
    return good ? ends : NULL;
}

/* Multipliers of constraints on places carry round-off divided by the squared step. */
static double weight(size_t stages, size_t unknown, double step)
{
    return unknown > 2 * stages ? step : 1;
}

#define STRATEGY .guess = guess, .residual = residual, .jacobian = jacobian, .end = end
static const struct gm_mesh_strategy relaxed = {
    .kind = GM_MESH_FREE, .unknowns = 2, .projected = 1, STRATEGY};
static const struct gm_mesh_strategy strategy_control = {
    .kind = GM_MESH_MOVING, .unknowns = 3, .projected = 2, .relaxed = &relaxed, STRATEGY};
static const struct gm_mesh_strategy strategy_free = {
    .kind = GM_MESH_FREE, .free = true, .unknowns = 2, .projected = 2, STRATEGY};
const struct gm_mesh_strategy gm_mesh_multiplied = {
    .kind = GM_MESH_MOVING, .multiplied = true, .unknowns = 3, .projected = 3, .weight = weight, STRATEGY};
static const struct gm_mesh_strategy strategy_given = {
    .kind = GM_MESH_GIVEN, .unknowns = 1, .projected = 1, STRATEGY};
static const struct gm_mesh_strategy strategy_uniform = {
    .kind = GM_MESH_UNIFORM, .unknowns = 1, .projected = 1, STRATEGY};

/* The strategy, and its stages. */
#define ROW(by, stages_of)                                                                                   \
    GM_TEXTS_##by##_##stages_of, .family = &gm_family_control, .coefficients = &(const struct gm_mesh_row)   \
    {                                                                                                        \
        .strategy = &strategy_##by, .tableau = &gm_tableau_##stages_of                                       \
    }

static const struct gm_scheme schemes[] = {
    {ROW(uniform, gauss2)},   {ROW(uniform, gauss4)},   {ROW(uniform, lobatto2)}, {ROW(uniform, lobatto4)},
    {ROW(given, gauss2)},     {ROW(given, gauss4)},     {ROW(given, lobatto2)},   {ROW(given, lobatto4)},
    {ROW(free, gauss2)},      {ROW(free, gauss4)},      {ROW(control, gauss2)},   {ROW(control, gauss4)},
    {ROW(control, lobatto2)}, {ROW(control, lobatto4)}, {ROW(control, radau3)},   {ROW(control, radau5)},
};

const struct gm_family gm_family_control = {.title = "control-theoretic, free, known and uniform meshes",
                                            GM_MESH_FAMILY_OF_STEPS};
