/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic trapezoidal rule for the field and the mesh together, like SHAKE, with the discrete
   Lagrangian
       Ld(q0, q1) = h/2 [L(q0, v) + L(q1, v)],   v = (q1 - q0) / h
   Places q_{j+1} and impulses lambda_j (a multiplier times h) come from
       p_j + D1 Ld(q_j, q_{j+1}) - Dg(q_j)^T lambda_j = 0,   g(q_{j+1}) = 0
   and then, with L_q and L_v the derivatives of L,
       p_{j+1}     = D2 Ld(q_j, q_{j+1})
       D1 Ld       = h/2 L_q(q0, v) - [L_v(q0, v) + L_v(q1, v)]/2
       D2 Ld       = h/2 L_q(q1, v) + [L_v(q0, v) + L_v(q1, v)]/2
   p_{j+1} is projected onto the velocities that the constraint allows; the projection does not change any
   later q. Tyranowski & Desbrun (2019), eqs. 154-155. */
#include <math.h>

#include "core/mesh/families/families.h"
#include "core/mesh_scheme_texts.h"

/* The elements are at q_j in solver->ends, and at q_{j+1} in solver->stage[0], both with the velocity v. A
   node has the unknowns y and X of q_{j+1} and lambda. */

/* Places to as many digits as make velocities, places over dt, ten times better than those of other schemes:
   it takes that for 200 steps to be undone to 1e-11. */
static double weight(size_t stages, size_t unknown, double step)
{
    (void)stages;
    return unknown < 2 ? 10 / step : 10;
}

static void guess(const struct gm_mesh_solver *solver, double *unknowns)
{
    const size_t points = solver->mesh.points;
    const double *state = solver->state;
    for (size_t k = 0; k < points; k++) {
        unknowns[3 * k] = state[k] + solver->h * state[2 * points + k];
        unknowns[3 * k + 1] = state[points + k] + solver->h * state[3 * points + k];
        unknowns[3 * k + 2] = 0;
    }
}

static bool residual(struct gm_mesh_solver *solver, const double *unknowns, double *out)
{
    const size_t points = solver->mesh.points;
    const double h = solver->h, *state = solver->state, *momenta = solver->momenta, *share = solver->slack;
    struct gm_elements *before = &solver->ends, *after = &solver->stage[0];
    for (size_t k = 0; k < points; k++) {
        const double *at = unknowns + 3 * k;
        after->y[k + 1] = at[0];
        after->x[k + 1] = at[1];
        before->u[k + 1] = after->u[k + 1] = (at[0] - state[k]) / h;
        before->v[k + 1] = after->v[k + 1] = (at[1] - state[points + k]) / h;
    }
    gm_nodes_spread(unknowns, points, 3, 2, solver->slack);
    if (!gm_elements_evaluate(after, &solver->mesh) || !gm_elements_evaluate(before, &solver->mesh)) {
        return false;
    }
    gm_elements_constrain(after, &solver->mesh);
    gm_elements_constrain(before, &solver->mesh);
    for (size_t k = 1; k <= points; k++) {
        double *at = out + 3 * (k - 1);
        at[0] = momenta[2 * k - 2] + h / 2 * gm_force_y(before, k) -
                (gm_momentum_u(before, k) + gm_momentum_u(after, k)) / 2 -
                share[k - 1] * before->gradient[2][k - 1] - share[k] * before->gradient[0][k];
        at[1] = momenta[2 * k - 1] + h / 2 * gm_force_x(before, k) -
                (gm_momentum_v(before, k) + gm_momentum_v(after, k)) / 2 -
                share[k - 1] * before->gradient[3][k - 1] - share[k] * before->gradient[1][k];
        at[2] = gm_jump(after->ell, k);
    }
    return true;
}

static void jacobian(struct gm_mesh_solver *solver, const struct gm_assembly *assembly)
{
    const struct gm_places places = {0, 1};
    struct gm_element_matrices before, after;
    gm_elements_matrices(&solver->ends, &solver->mesh, assembly->element, true, &before);
    gm_elements_matrices(&solver->stage[0], &solver->mesh, assembly->element, true, &after);
    double block[4][4];
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < 4; b++) {
            const double mass = (before.mass[a][b] + after.mass[a][b]) / solver->h;
            block[a][b] = (before.mixed[b][a] - mass - after.mixed[a][b]) / 2;
        }
    }
    gm_nodes_add(assembly, places, places, block);
    gm_nodes_add_column(assembly, places, 2, -1, before.gradient);
    gm_nodes_add_row(assembly, 2, places, after.gradient);
}

static struct gm_elements *end(struct gm_mesh_solver *solver, double *multiplier)
{
    const struct gm_elements *before = &solver->ends;
    struct gm_elements *after = &solver->stage[0];
    for (size_t k = 1; k <= solver->mesh.points; k++) {
        double *at = solver->motion + 3 * k - 3;
        at[0] =
            solver->h / 2 * gm_force_y(after, k) + (gm_momentum_u(before, k) + gm_momentum_u(after, k)) / 2;
        at[1] =
            solver->h / 2 * gm_force_x(after, k) + (gm_momentum_v(before, k) + gm_momentum_v(after, k)) / 2;
    }
    *multiplier = gm_mesh_largest(solver, 2) / fabs(solver->h);
    return after;
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

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_multiplier_trapezoidal, .family = &gm_family_trapezoidal,
     .coefficients = &(const struct gm_mesh_row){.strategy = &strategy}},
};

const struct gm_family gm_family_trapezoidal = {.title = "multisymplectic moving meshes",
                                                GM_MESH_FAMILY_OF_STEPS};
