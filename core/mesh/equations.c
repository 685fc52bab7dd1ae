/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of a step, once for all that may hold a mesh: a partitioned Runge-Kutta method for q = (y, X). At the
   stages i, with p = dL/dqdot of the field's Lagrangian L (and the cells'),
       Q_i = q_n + h sum_j a_ij Qdot_j
       P_i = p_n + h sum_j abar_ij F_j,   P_i = dL/dqdot(Q_i, Qdot_i),   F_j = dL/dq(Q_j, Qdot_j)
   The rows of y are always these; the rows of X are
       known        X_i = F(x, t_n + c_i h),   Xdot_i = F_t;   uniform: F = x. No rows, no unknowns
       held         g(Q_i) = 0,   Dg(Q_i) Qdot_i = 0; unknowns X_i and Xdot_i: the control-theoretic strategy
       smoothed     E Xdot_i = g(Q_i),   E = 2 length T / (N + 1)^3: with density 1 the slowest mode of the mesh decays as
                    exp(-pi^2 t / T)
       free         those of y (section 3.3, remarks 1 to 4)
       multiplied   those of y with the constraint g(q) = 0 enforced by multipliers. The mass matrix M is singular where
                    the field is straight; so slack variables r with the Lagrangian L + rdot^T Dg(q) qdot and r = 0 are
                    added, which leaves Rdot_j = kappa_j W, a kappa = 0:
                        P_i = M(Q_i) Qdot_i + Dg(Q_i)^T Rdot_i
                        F_j = d/dq [L + Rdot_j^T Dg(q) qdot] - Dg(Q_j)^T Lambda_j
                        g(Q_i) = 0,  i > 1,   sum_i l_i Dg(Q_i) Qdot_i = 0,   l^T abar = 0
                    The last column of abar is 0, so that Lambda_s follows from Dg qdot = 0 at the end of the step.
       one velocity the same with Qdot_i = v for all i, and the rows of y and X in the mean, sum_i b_i (..). W is 0 then.
                    With Lobatto's two stages it is the discrete Lagrangian h/2 [L(q_n, v) + L(q_{n+1}, v)]: the
                    multisymplectic trapezoidal rule, eqs. 154-155; Lambda_1 is 2/h times its multiplier.
   A mesh that is held, smoothed or known is an explicit function of time for L, so symplecticity in (y, p) does not
   conserve its energy. On a known mesh the midpoint rule (gauss2) comes from a discrete Lagrangian of the elements, and on
   the uniform one the trapezoidal rule (lobatto2) too: they are multisymplectic; more stages couple all elements.
   Tyranowski & Desbrun (2019), eqs. 20, 21, 95-98, 154-155, propositions 2 to 4, sections 2.6, 4.2 and 6.5; L.O. Jay, SIAM
   J. Numer. Anal. 33 (1996) 368. */
#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/mesh/equations.h"

struct gm_mesh_layout gm_mesh_layout_of(const struct gm_mesh_row *row, const struct gm_mesh *mesh)
{
    const size_t stages = row->tableau->stages, velocities = row->one_velocity ? 1 : stages;
    const bool known = row->kind == GM_MESH_UNIFORM || row->kind == GM_MESH_GIVEN,
               pushed = row->kind == GM_MESH_FREE || row->multiplied,
               smoothed = !known && !pushed && mesh->relax > 0, held = !known && !pushed && !smoothed,
               slack = row->multiplied && !row->one_velocity;
    const size_t per_stage = 1 + !known + held, of_stages = per_stage * velocities;
    return (struct gm_mesh_layout){.per_stage = per_stage,
                                   .per_node = of_stages + (row->multiplied ? slack + stages - 1 : 0),
                                   .stride = row->one_velocity ? 0 : per_stage,
                                   .slack = slack ? of_stages : 0,
                                   .multiplier = row->multiplied ? of_stages + slack : 0,
                                   .held = held,
                                   .drifts = per_stage == 2,
                                   .smoothed = smoothed,
                                   .pushed = pushed,
                                   .constrained = row->kind == GM_MESH_MOVING,
                                   .projected = 1 + (!known && !smoothed) + row->multiplied};
}

/* E of a mesh that is smoothed in time */
static double friction(const struct gm_mesh *mesh)
{
    return 2 * mesh->length * mesh->relax / (mesh->level * gm_pow((double)mesh->points + 1, 3));
}

void gm_step_place(struct gm_mesh_solver *solver, const double *state, double t, double h)
{
    solver->t = t;
    solver->h = h;
    solver->state = state;
    gm_elements_place(&solver->ends, state);
    gm_elements_evaluate(&solver->ends, &solver->mesh);
    for (size_t k = 1; k <= solver->mesh.points; k++) {
        solver->momenta[2 * k - 2] = gm_momentum_u(&solver->ends, k);
        solver->momenta[2 * k - 1] = gm_momentum_v(&solver->ends, k);
    }
    for (size_t i = 0; i < solver->stages; i++) {
        double c = 0;
        for (size_t j = 0; j < solver->stages; j++) {
            c += solver->row->tableau->a[i][j];
        }
        gm_elements_place(&solver->stage[i], state);
        gm_mesh_known(&solver->mesh, solver->kind, t + c * h, &solver->stage[i]);
    }
}

void gm_step_guess(const struct gm_mesh_solver *solver, double *unknowns)
{
    const struct gm_mesh_layout of = solver->of;
    const size_t points = solver->mesh.points;
    memset(unknowns, 0, points * of.per_node * sizeof *unknowns);
    for (size_t k = 0; k < points; k++) {
        for (size_t i = 0; i < solver->stages; i++) {
            double *at = unknowns + k * of.per_node + i * of.stride;
            at[0] = solver->state[2 * points + k];
            if (of.per_stage > 1) {
                at[1] = solver->state[points + k];
                /* far from its place a mesh that is smoothed begins too fast for a whole step */
                at[of.per_stage - 1] = of.smoothed ? 0 : solver->state[3 * points + k];
            }
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

/* The forces at the nodes at stage i; without multipliers the slack is 0. */
static void find_forces(struct gm_mesh_solver *solver, const double *unknowns, size_t i)
{
    const struct gm_mesh_layout *of = &solver->of;
    const size_t points = solver->mesh.points;
    const bool acts = of->multiplier > 0 && i + 1 < solver->stages;
    if (acts) {
        gm_nodes_spread(unknowns, points, of->per_node, of->multiplier + i, solver->share[i]);
    }
    force(&solver->stage[i], solver->slack, solver->row->tableau->kappa[i], acts ? solver->share[i] : NULL,
          points, solver->forces[i]);
}

/* It is compiled for each number of stages, which unrolls its inner loops. */
static inline __attribute__((always_inline)) bool residual_of(struct gm_mesh_solver *solver, size_t stages,
                                                              const double *unknowns)
{
    const struct gm_mesh_layout of = solver->of;
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t points = solver->mesh.points, per_node = of.per_node;
    const size_t acting = of.multiplier > 0 ? stages - 1 : stages; /* the last column of abar is zero then */
    const double h = solver->h, *state = solver->state, *momenta = solver->momenta;
    if (of.slack > 0) {
        gm_nodes_spread(unknowns, points, per_node, of.slack, solver->slack);
    }
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &solver->stage[i];
        const double *a = tableau->a[i];
        for (size_t k = 0; k < points; k++) {
            const double *at = unknowns + k * per_node, *here = at + i * of.stride;
            double rise = 0, shift = 0;
            for (size_t j = 0; j < stages; j++) {
                rise += a[j] * at[j * of.stride];
                shift += of.drifts ? a[j] * at[j * of.stride + 1] : 0;
            }
            stage->y[k + 1] = state[k] + h * rise;
            stage->u[k + 1] = here[0];
            if (of.per_stage > 1) {
                stage->x[k + 1] = of.held ? here[1] : state[points + k] + h * shift;
                stage->v[k + 1] = here[of.per_stage - 1];
            }
        }
        if (!gm_elements_evaluate(stage, &solver->mesh)) {
            return false;
        }
        if (of.constrained) {
            gm_elements_constrain(stage, &solver->mesh);
        }
        find_forces(solver, unknowns, i);
    }
    const double resists = friction(&solver->mesh), *slack = solver->slack;
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &solver->stage[i];
        const double kappa = tableau->kappa[i], *abar = tableau->abar[i];
        double *const *by = stage->gradient;
        for (size_t k = 1; k <= points; k++) {
            double *node = solver->residual + (k - 1) * per_node, *at = node + i * of.stride;
            double sum = 0, sum_x = 0, p_y = gm_momentum_u(stage, k),
                   p_x = of.pushed ? gm_momentum_v(stage, k) : 0;
            for (size_t j = 0; j < acting; j++) {
                sum += abar[j] * solver->forces[j][2 * k - 2];
                sum_x += abar[j] * solver->forces[j][2 * k - 1];
            }
            if (of.slack > 0) {
                const double before = kappa * slack[k - 1], after = kappa * slack[k],
                             hidden = tableau->left[i] * gm_jump(stage->rate, k);
                p_y = p_y + before * by[2][k - 1] + after * by[0][k];
                p_x = p_x + before * by[3][k - 1] + after * by[1][k];
                node[of.slack] = i == 0 ? hidden : node[of.slack] + hidden;
            }
            if (of.multiplier > 0 && i > 0) {
                node[of.multiplier + i - 1] = gm_jump(stage->ell, k);
            }
            const double row = p_y - momenta[2 * k - 2] - h * sum,
                         row_x = p_x - momenta[2 * k - 1] - h * sum_x;
            if (of.stride == 0) {
                at[0] = (i > 0 ? at[0] : 0) + tableau->b[i] * row;
                at[1] = (i > 0 ? at[1] : 0) + tableau->b[i] * row_x;
                continue;
            }
            at[0] = row;
            if (of.held) {
                at[1] = gm_jump(stage->ell, k);
                at[2] = gm_jump(stage->rate, k);
            } else if (of.smoothed) {
                at[1] = resists * stage->v[k] - gm_jump(stage->ell, k);
            } else if (of.pushed) {
                at[1] = row_x;
            }
        }
    }
    return true;
}

bool gm_step_residual(struct gm_mesh_solver *solver, const double *unknowns)
{
    return solver->stages == 1   ? residual_of(solver, 1, unknowns)
           : solver->stages == 2 ? residual_of(solver, 2, unknowns)
                                 : residual_of(solver, GM_STAGES, unknowns);
}

/* Derivatives of z and zdot at the stages by an unknown of one stage: dy/dt and dX/dt move places by h a_im, and X
   itself, if it is held, moves its own. */
struct follows {
    double place[GM_STAGES], rate[GM_STAGES];
};

static struct follows follow(const struct gm_mesh_solver *solver, size_t m, size_t unknown)
{
    const bool held = solver->of.held;
    struct follows made = {0};
    for (size_t i = 0; i < solver->stages; i++) {
        const double moved = solver->h * solver->row->tableau->a[i][m], own = i == m;
        made.place[i] = !held || unknown == 0 ? moved : unknown == 1 ? own : 0;
        made.rate[i] = held && unknown == 1 ? 0 : own;
    }
    return made;
}

/* The part that stage i has in its rows. */
static double share_of(const struct gm_mesh_solver *solver, size_t i)
{
    return solver->of.stride == 0 ? solver->row->tableau->b[i] : 1;
}

/* Adds what slack and multipliers do, and their columns, without third derivatives of ell times the slack, O(h^2). */
static void add_multipliers(const struct gm_mesh_solver *solver, const struct gm_assembly *assembly,
                            struct gm_element_matrices at[GM_STAGES])
{
    const struct gm_mesh_layout *of = &solver->of;
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t e = assembly->element, stages = solver->stages;
    for (size_t i = 0; i < stages; i++) {
        const double omega = tableau->kappa[i] * solver->slack[e],
                     lambda = i + 1 < stages ? solver->share[i][e] : 0, h = solver->h * share_of(solver, i);
        const double *abar = tableau->abar[i];
        const struct gm_places rows = {i * of->stride, i * of->stride + 1};
        double by_slack[4];
        for (size_t a = 0; a < 4; a++) {
            for (size_t b = 0; b < 4; b++) {
                at[i].mixed[a][b] += omega * at[i].hessian[a][b];
                at[i].stiff[a][b] -= lambda * at[i].hessian[a][b];
            }
            by_slack[a] = tableau->kappa[i] * at[i].gradient[a];
            for (size_t j = 0; j < stages; j++) {
                by_slack[a] -= solver->h * abar[j] * tableau->kappa[j] * at[j].bend[a];
            }
        }
        if (of->slack > 0) {
            gm_nodes_add_column(assembly, rows, of->slack, 1, by_slack);
        }
        for (size_t j = 0; j + 1 < stages; j++) {
            gm_nodes_add_column(assembly, rows, of->multiplier + j, h * abar[j], at[j].gradient);
        }
    }
}

void gm_step_matrix(struct gm_mesh_solver *solver, const struct gm_assembly *assembly)
{
    const struct gm_mesh_layout of = solver->of;
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t stages = solver->stages;
    const double share = friction(&solver->mesh) / 2; /* a node is in two elements */
    struct gm_element_matrices at[GM_STAGES] = {0};
    for (size_t i = 0; i < stages; i++) {
        gm_elements_matrices(&solver->stage[i], &solver->mesh, assembly->element, of.constrained, &at[i]);
    }
    if (of.multiplier > 0) {
        add_multipliers(solver, assembly, at);
    }
    /* the columns of dy/dt and the next unknown together, then those of dX/dt where X is held */
    for (size_t k = 0; k < stages * (1 + of.held); k++) {
        const size_t m = k % stages, last = k / stages, column = m * of.stride;
        const bool both = of.per_stage > 1;
        const struct gm_places columns = {last ? GM_NOWHERE : column, both ? column + 1 + last : GM_NOWHERE};
        const struct follows by[2] = {follow(solver, m, 0), follow(solver, m, 1 + last)};
        for (size_t i = 0; i < stages; i++) {
            const size_t row = i * of.stride;
            const double part = share_of(solver, i);
            double block[4][4], ell[4], rate[4], resists[4][4] = {{0}};
            for (size_t b = last; b < 4; b += 1 + (last > 0 || !both)) {
                const double *place = by[b % 2].place, *own = by[b % 2].rate;
                for (size_t a = 0; a < 4; a++) {
                    double pushed = 0;
                    for (size_t j = 0; j < stages; j++) {
                        pushed +=
                            tableau->abar[i][j] * (place[j] * at[j].stiff[a][b] + own[j] * at[j].mixed[b][a]);
                    }
                    block[a][b] = part * (place[i] * at[i].mixed[a][b] + own[i] * at[i].mass[a][b] -
                                          solver->h * pushed);
                }
                resists[b][b] = share * own[i];
                ell[b] = (of.smoothed ? -1 : 1) * place[i] * at[i].gradient[b];
                rate[b] = (of.slack > 0 ? tableau->left[i] : 1) *
                          (place[i] * at[i].bend[b] + own[i] * at[i].gradient[b]);
            }
            gm_nodes_add(assembly, (struct gm_places){row, of.pushed ? row + 1 : GM_NOWHERE}, columns, block);
            if (of.slack > 0 || of.held) {
                gm_nodes_add_row(assembly, of.held ? row + 2 : of.slack, columns, rate);
            }
            if (of.constrained && !last && !(of.multiplier > 0 && i == 0)) {
                gm_nodes_add_row(assembly, of.multiplier > 0 ? of.multiplier + i - 1 : row + 1, columns, ell);
            }
            if (of.smoothed) {
                gm_nodes_add(assembly, (struct gm_places){GM_NOWHERE, row + 1},
                             (struct gm_places){GM_NOWHERE, column + 1}, resists);
            }
        }
    }
}

/* Completes the places at the end; false if a cell is not positive there. */
static bool find_places(struct gm_mesh_solver *solver)
{
    const struct gm_mesh_layout *of = &solver->of;
    struct gm_elements *ends = &solver->ends;
    if (of->held && !solver->row->tableau->stiffly_accurate) {
        return gm_nodes_equidistribute(ends, &solver->mesh, NULL, NULL, &solver->places, solver->trial);
    }
    gm_mesh_known(&solver->mesh, solver->kind, solver->t + solver->h, ends);
    const bool free = !of->constrained && of->pushed, good = free ? gm_elements_evaluate(ends, &solver->mesh)
                                                                  : gm_elements_measure(ends, &solver->mesh);
    for (size_t k = 1; of->smoothed && k <= solver->mesh.points; k++) {
        ends->v[k] = gm_jump(ends->ell, k) / friction(&solver->mesh);
    }
    return good;
}

/* The velocities at the end, of the momenta there, with `projected` unknowns a node:
       3  u, V, lambda  of  M (u, V) + Dg^T lambda = p,  Dg (u, V) = 0
       2  u, V          of the same if p has no part in X, which Dg (u, V) = 0 alone determines; or free, of dL/dqdot = p,
                        by Newton's method from those at hand: one step if L has squares of velocities alone
       1  u             of M_yy u + M_yX V = p on a mesh with a known velocity */
static bool find_velocities(struct gm_mesh_solver *solver)
{
    enum { MOST = 20 };
    struct gm_elements *ends = &solver->ends;
    struct gm_banded *matrix = &solver->projection;
    const size_t points = solver->mesh.points, width = solver->of.projected, last = width - 1;
    const bool constrained = solver->of.constrained && width > 1, free = width == 2 && !constrained;
    const struct gm_places rows = {0, width > 2 || free ? 1 : GM_NOWHERE},
                           columns = {0, width > 1 ? 1 : GM_NOWHERE};
    double change = INFINITY, *motion = solver->motion;
    if (!free) {
        memset(ends->u, 0, (points + 2) * sizeof *ends->u);
        memset(ends->v, 0, width > 1 ? (points + 2) * sizeof *ends->v : 0);
    }
    for (int i = 0; i < MOST && change > 1e-13; i++) {
        if (free && !gm_elements_evaluate(ends, &solver->mesh)) {
            return false;
        }
        gm_banded_clear(matrix);
        for (size_t k = 1; k <= points; k++) {
            double *at = motion + width * (k - 1);
            at[last] = 0;
            at[0] = solver->momenta[2 * k - 2] - (free ? gm_momentum_u(ends, k) : 0);
            if (rows.x == 1) {
                at[1] = solver->momenta[2 * k - 1] - (free ? gm_momentum_v(ends, k) : 0);
            }
        }
        for (size_t e = 0; e <= points; e++) {
            const struct gm_assembly assembly = {matrix, points, width, e};
            struct gm_element_matrices at;
            if (solver->mesh.cell) {
                gm_elements_matrices(ends, &solver->mesh, e, false, &at);
            } else {
                gm_elements_mass(ends, e, at.mass);
            }
            gm_nodes_add(&assembly, rows, columns, at.mass);
            for (size_t side = e == 0; width == 1 && side <= (e < points); side++) {
                motion[e + side - 1] -=
                    at.mass[2 * side][1] * ends->v[e] + at.mass[2 * side][3] * ends->v[e + 1];
            }
            if (constrained) {
                for (size_t a = 0; a < 4; a++) {
                    at.gradient[a] = ends->gradient[a][e];
                }
                gm_nodes_add_row(&assembly, last, columns, at.gradient);
            }
            if (width > 2) {
                gm_nodes_add_column(&assembly, rows, last, 1, at.gradient);
            }
        }
        if (!gm_banded_factor(matrix)) {
            return false;
        }
        gm_banded_solve(matrix, motion);
        change = 0;
        for (size_t k = 1; k <= points; k++) {
            const double u = motion[width * (k - 1)], v = width > 1 ? motion[width * (k - 1) + 1] : 0;
            ends->u[k] += u;
            ends->v[k] += v;
            change = !free ? 0
                           : fmax(change,
                                  fmax(fabs(u) / (1 + fabs(ends->u[k])), fabs(v) / (1 + fabs(ends->v[k]))));
        }
    }
    return change < 1e-9;
}

bool gm_step_begin(struct gm_mesh_solver *solver)
{
    return find_places(solver) && find_velocities(solver);
}

enum gm_status gm_step_end(struct gm_mesh_solver *solver, double *multiplier)
{
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const struct gm_mesh_layout *of = &solver->of;
    const size_t points = solver->mesh.points, stages = solver->stages;
    struct gm_elements *ends = &solver->ends;
    double largest = 0;
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
        solver->momenta[2 * k - 2] += solver->h * force;
        solver->momenta[2 * k - 1] += solver->h * force_x;
        largest = fmax(largest, fabs(solver->unknowns[(k - 1) * of->per_node + of->multiplier]));
    }
    if (of->multiplier > 0) {
        *multiplier = largest;
    }
    if (!find_places(solver)) {
        return GM_MESH_CROSSING;
    }
    return find_velocities(solver) ? GM_OK : GM_NO_CONVERGENCE;
}
