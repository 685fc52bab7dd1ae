/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Partitioned Runge-Kutta methods for the field on a mesh that follows it (the control-theoretic strategy),
   and on a uniform mesh. At the stages i, with X(y) given by the constraint g(y, X) = 0,
       Y_i = y_n + h sum_j a_ij Ydot_j
       P_i = p_n + h sum_j abar_ij F_j
       P_i = dL/dydot(Y_i, Q_i, Ydot_i, Qdot_i),   F_j = dL/dy(Y_j, Q_j, Ydot_j, Qdot_j)
       g(Y_i, Q_i) = 0,   d/dt g = Dg(Y_i, Q_i) (Ydot_i, Qdot_i) = 0
       unknowns (Ydot_i, Q_i, Qdot_i); on the uniform mesh Q is fixed and only Ydot_i and P_i are left
   The mesh is an explicit function of time for the Lagrangian, so symplecticity in (y, p) does not conserve
   its energy. On the uniform mesh the methods of order 2 come from discrete Lagrangians of the elements, that
   of the midpoint rule (gauss2) and the trapezoidal one (lobatto2), and are multisymplectic; more stages
   couple all elements. Tyranowski & Desbrun (2019), eq. 21 and sections 2.6 and 4.2. */
#include <string.h>

#include "core/mesh/families/families.h"

/* Unknowns at a node, stage by stage: dy/dt, and where the mesh moves X and dX/dt. */

static bool moves(const struct gm_mesh_solver *solver)
{
    return solver->row->strategy->kind == GM_MESH_MOVING;
}

static void guess(const struct gm_mesh_solver *solver, double *unknowns)
{
    const size_t points = solver->mesh.points, per_stage = solver->row->strategy->unknowns;
    for (size_t k = 0; k < points; k++) {
        for (size_t i = 0; i < solver->stages; i++) {
            double *at = unknowns + k * solver->per_node + i * per_stage;
            at[0] = solver->state[2 * points + k];
            if (per_stage == 3) {
                at[1] = solver->state[points + k];
                at[2] = solver->state[3 * points + k];
            }
        }
    }
}

static bool residual(struct gm_mesh_solver *solver, const double *unknowns, double *out)
{
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t points = solver->mesh.points, stages = solver->stages, per_node = solver->per_node;
    const size_t per_stage = solver->row->strategy->unknowns;
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &solver->stage[i];
        for (size_t k = 0; k < points; k++) {
            const double *at = unknowns + k * per_node;
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                sum += tableau->a[i][j] * at[j * per_stage];
            }
            stage->y[k + 1] = solver->state[k] + solver->h * sum;
            stage->u[k + 1] = at[i * per_stage];
            if (per_stage == 3) {
                stage->x[k + 1] = at[i * per_stage + 1];
                stage->v[k + 1] = at[i * per_stage + 2];
            }
        }
        if (!gm_elements_evaluate(stage, &solver->mesh)) {
            return false;
        }
        if (per_stage == 3) {
            gm_elements_constrain(stage, &solver->mesh);
        }
    }
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &solver->stage[i];
        for (size_t k = 1; k <= points; k++) {
            double *at = out + (k - 1) * per_node + i * per_stage;
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                sum += tableau->abar[i][j] * gm_force_y(&solver->stage[j], k);
            }
            at[0] = gm_momentum_u(stage, k) - solver->momenta[2 * k - 2] - solver->h * sum;
            if (per_stage == 3) {
                at[1] = gm_jump(stage->ell, k);
                at[2] = gm_jump(stage->rate, k);
            }
        }
    }
    return true;
}

/* Assembles the derivative of the equations of a stage by its unknowns: Ydot, which z follows by `moved`,
   and X in one block, Xdot in another. The odd columns, of X, exist only if the mesh moves. */
static void jacobian(struct gm_mesh_solver *solver, const struct gm_assembly *assembly)
{
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t stages = solver->stages, per_stage = solver->row->strategy->unknowns;
    const bool constrained = moves(solver);
    const double h = solver->h;
    struct gm_element_matrices at[GM_STAGES] = {0};
    for (size_t i = 0; i < stages; i++) {
        gm_elements_matrices(&solver->stage[i], &solver->mesh, assembly->element, constrained, &at[i]);
    }
    for (size_t i = 0; i < stages; i++) {
        const size_t row = i * per_stage;
        for (size_t m = 0; m < stages; m++) {
            const size_t column = m * per_stage;
            const struct gm_places rows = {row, GM_NOWHERE},
                                   places = {column, constrained ? column + 1 : GM_NOWHERE},
                                   rates = {GM_NOWHERE, column + 2};
            const double push = h * tableau->abar[i][m], own = i == m;
            double by_places[4][4], by_rates[4][4], ell[4], rate[4], rate_by_rates[4];
            for (size_t b = 0; b < 4; b++) {
                const double moved = b % 2 ? own : h * tableau->a[i][m], still = b % 2 ? 0 : own;
                for (size_t a = 0; a < 4; a++) {
                    by_rates[a][b] = own * at[i].mass[a][b] - push * at[m].mixed[b][a];
                    by_places[a][b] = moved * at[i].mixed[a][b];
                    if (b % 2) {
                        by_places[a][b] -= push * at[m].stiff[a][b];
                        continue;
                    }
                    by_places[a][b] += by_rates[a][b];
                    for (size_t j = 0; j < stages; j++) {
                        by_places[a][b] -= h * h * tableau->abar[i][j] * tableau->a[j][m] * at[j].stiff[a][b];
                    }
                }
                ell[b] = moved * at[i].gradient[b];
                rate[b] = moved * at[i].bend[b] + still * at[i].gradient[b];
                rate_by_rates[b] = own * at[i].gradient[b];
            }
            gm_nodes_add(assembly, rows, places, by_places);
            if (constrained) {
                gm_nodes_add(assembly, rows, rates, by_rates);
                gm_nodes_add_row(assembly, row + 1, places, ell);
                gm_nodes_add_row(assembly, row + 2, places, rate);
                gm_nodes_add_row(assembly, row + 2, rates, rate_by_rates);
            }
        }
    }
}

static struct gm_elements *end(struct gm_mesh_solver *solver, double *multiplier)
{
    (void)multiplier;
    const struct gm_mesh_tableau *tableau = solver->row->tableau;
    const size_t points = solver->mesh.points, stages = solver->stages;
    struct gm_elements *ends = &solver->ends;
    for (size_t k = 1; k <= points; k++) {
        double rise = 0, force = 0, shift = 0;
        for (size_t i = 0; i < stages; i++) {
            const struct gm_elements *stage = &solver->stage[i];
            rise += tableau->b[i] * stage->u[k];
            shift += tableau->b[i] * stage->v[k];
            force += tableau->b[i] * gm_force_y(stage, k);
        }
        ends->y[k] = solver->state[k - 1] + solver->h * rise;
        ends->x[k] = tableau->stiffly_accurate ? solver->stage[stages - 1].x[k]
                                               : solver->state[points + k - 1] + solver->h * shift;
        solver->motion[solver->row->strategy->projected * (k - 1)] =
            solver->momenta[2 * k - 2] + solver->h * force;
    }
    const bool good =
        moves(solver) && !tableau->stiffly_accurate
            ? gm_nodes_equidistribute(ends, &solver->mesh, NULL, NULL, &solver->places, solver->trial)
            : gm_elements_measure(ends, &solver->mesh);
    return good ? ends : NULL;
}

#define STRATEGY .guess = guess, .residual = residual, .jacobian = jacobian, .end = end
static const struct gm_mesh_strategy control = {.kind = GM_MESH_MOVING,
                                                .unknowns = 3,
                                                .projected = 2,
                                                STRATEGY},
                                     uniform = {
                                         .kind = GM_MESH_UNIFORM, .unknowns = 1, .projected = 1, STRATEGY};

#define FORMULA_control                                                                                      \
    "∂L/∂ẏ(Yᵢ, Qᵢ) = pₙ + h Σ āᵢⱼ ∂L/∂y,  Yᵢ = yₙ + h Σ aᵢⱼ Ẏⱼ\n"         \
    "g(Yᵢ, Qᵢ) = 0"
#define FORMULA_uniform "∂L/∂ẏ(Yᵢ) = pₙ + h Σ āᵢⱼ ∂L/∂y,  Yᵢ = yₙ + h Σ aᵢⱼ Ẏⱼ,  X fixed"
#define PAIR (GM_SYMMETRIC | GM_REVERSIBLE)

/* The strategy, its stages, its title, the order, what it claims, and the reference. */
#define ROW(by, stages_of, words, degree, claimed, source)                                                   \
    {                                                                                                        \
        .name = #by "-" #stages_of, .title = #by " " words, .formula = FORMULA_##by, .reference = source,    \
        .family = &gm_family_control,                                                                        \
        .coefficients = &(const struct gm_mesh_row){.strategy = &by, .tableau = &gm_tableau_##stages_of},    \
        .order = degree, .claims = claimed                                                                   \
    }
#define UNIFORM(stages_of, words, degree, claimed)                                                           \
    ROW(uniform, stages_of, words, degree, GM_SYMPLECTIC | PAIR | claimed,                                   \
        "Tyranowski & Desbrun (2019), section 5.3")
#define CONTROL(stages_of, words, degree, claimed)                                                           \
    ROW(control, stages_of, words, degree, claimed, "Tyranowski & Desbrun (2019), eq. 21")

static const struct gm_scheme schemes[] = {
    UNIFORM(gauss2, "Gauss 2", 2, GM_MULTISYMPLECTIC),
    UNIFORM(gauss4, "Gauss 4", 4, 0),
    UNIFORM(lobatto2, "Lobatto 2", 2, GM_MULTISYMPLECTIC),
    UNIFORM(lobatto4, "Lobatto 4", 4, 0),
    CONTROL(gauss2, "Gauss 2", 2, PAIR),
    CONTROL(gauss4, "Gauss 4", 4, PAIR),
    CONTROL(lobatto2, "Lobatto 2", 2, PAIR),
    CONTROL(lobatto4, "Lobatto 4", 4, PAIR),
    ROW(control, radau3, "Radau 3", 3, 0, "Tyranowski & Desbrun (2019), eq. 21; B. L. Ehle (1969)"),
    ROW(control, radau5, "Radau 5", 5, 0, "Tyranowski & Desbrun (2019), section 5.4; B. L. Ehle (1969)"),
};

const struct gm_family gm_family_control = {.title = "control-theoretic and uniform meshes",
                                            GM_MESH_FAMILY_OF_STEPS};
