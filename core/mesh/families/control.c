/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Partitioned Runge-Kutta methods for the field on a mesh that follows it (the control-theoretic strategy),
   and on a uniform mesh. At the stages i, with X(y) given by the constraint g(y, X) = 0,
       Y_i = y_n + h sum_j a_ij Ydot_j
       P_i = p_n + h sum_j abar_ij F_j
       P_i = dL/dydot(Y_i, Q_i, Ydot_i, Qdot_i),   F_j = dL/dy(Y_j, Q_j, Ydot_j, Qdot_j)
       g(Y_i, Q_i) = 0,   d/dt g = Dg(Y_i, Q_i) (Ydot_i, Qdot_i) = 0
       unknowns (Ydot_i, Q_i, Qdot_i); on the uniform mesh Q is fixed and only Ydot_i and P_i are left
   The mesh is an explicit function of time for the Lagrangian, so symplecticity in (y, p) does not keep its
   energy. On the uniform mesh the methods of order 2 come from discrete Lagrangians of the elements, that of
   the midpoint rule (gauss2) and the trapezoidal one (lobatto2), and are multisymplectic; more stages couple
   all elements. Tyranowski & Desbrun (2019), eq. 21 and sections 2.6 and 4.2. */
#include "core/mesh/families/control.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/mesh/families/advance.h"
#include "core/mesh/families/families.h"
#include "core/mesh/nodes.h"

/* The scratch. Unknowns at a node, stage by stage: dy/dt, and where the mesh moves X and dX/dt. */
struct work {
    struct gm_mesh mesh;
    const struct gm_control *row;
    double h;
    const double *state;
    struct gm_solver solver;
    struct gm_elements stages[GM_STAGES];
    struct gm_elements ends;  /* of a step: the start, then the end */
    struct gm_banded places;  /* N, for the mesh at the end */
    struct gm_banded motions; /* velocities from momenta */
    double *momenta, *scratch;
};

static bool moves(const struct gm_control *row)
{
    return row->kind == GM_MESH_MOVING;
}

/* unknowns at a node for one stage, and for all */
static size_t width(const struct gm_control *row)
{
    return moves(row) ? 3 : 1;
}

static size_t unknowns_at_node(const struct gm_control *row)
{
    return width(row) * row->tableau->stages;
}

/* The equations at the stages, and their derivative, as struct gm_step_equations asks for them. */

static void place(void *self, const double *state, double step)
{
    struct work *work = self;
    work->h = step;
    const size_t points = work->mesh.points;
    work->state = state;
    gm_elements_place(&work->ends, state);
    gm_elements_evaluate(&work->ends, &work->mesh);
    for (size_t k = 1; k <= points; k++) {
        work->momenta[k - 1] = gm_momentum_u(&work->ends, k);
    }
    for (size_t i = 0; i < work->row->tableau->stages; i++) {
        gm_elements_place(&work->stages[i], state);
    }
}

static void guess(void *self, double *unknowns)
{
    struct work *work = self;
    const size_t points = work->mesh.points, stages = work->row->tableau->stages,
                 per_stage = width(work->row);
    for (size_t k = 0; k < points; k++) {
        for (size_t i = 0; i < stages; i++) {
            double *at = unknowns + (k * stages + i) * per_stage;
            at[0] = work->state[2 * points + k];
            if (per_stage == 3) {
                at[1] = work->state[points + k];
                at[2] = work->state[3 * points + k];
            }
        }
    }
}

static bool residual(void *self, const double *unknowns, double *out)
{
    struct work *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t points = work->mesh.points, stages = tableau->stages, per_stage = width(work->row);
    const size_t per_node = stages * per_stage;
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &work->stages[i];
        for (size_t k = 0; k < points; k++) {
            const double *at = unknowns + k * per_node;
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                sum += tableau->a[i][j] * at[j * per_stage];
            }
            stage->y[k + 1] = work->state[k] + work->h * sum;
            stage->u[k + 1] = at[i * per_stage];
            if (per_stage == 3) {
                stage->x[k + 1] = at[i * per_stage + 1];
                stage->v[k + 1] = at[i * per_stage + 2];
            }
        }
        if (!gm_elements_evaluate(stage, &work->mesh)) {
            return false;
        }
        if (per_stage == 3) {
            gm_elements_constrain(stage, &work->mesh);
        }
    }
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &work->stages[i];
        for (size_t k = 1; k <= points; k++) {
            double *at = out + (k - 1) * per_node + i * per_stage;
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                const struct gm_elements *other = &work->stages[j];
                sum += tableau->abar[i][j] * (other->force_y1[k - 1] + other->force_y0[k]);
            }
            at[0] = gm_momentum_u(stage, k) - work->momenta[k - 1] - work->h * sum;
            if (per_stage == 3) {
                at[1] = gm_jump(stage->ell, k);
                at[2] = gm_jump(stage->rate, k);
            }
        }
    }
    return true;
}

/* Rows and columns that do not exist are left out of a 4 x 4 block by the places (y, y) of a 2 x 2 one. */
static void add(struct gm_banded *matrix, const struct work *work, size_t element, size_t row, size_t column,
                double factor, double block[4][4], size_t from, size_t by)
{
    const size_t points = work->mesh.points, per_node = unknowns_at_node(work->row);
    for (size_t a = 0; a < 2; a++) {
        const size_t i = element + a;
        for (size_t b = 0; b < 2; b++) {
            const size_t j = element + b;
            if (i >= 1 && i <= points && j >= 1 && j <= points) {
                gm_banded_add(matrix, (i - 1) * per_node + row, (j - 1) * per_node + column,
                              factor * block[2 * a + from][2 * b + by]);
            }
        }
    }
}

/* The derivative of an element quantity by y (by = 0) or X (by = 1), in the constraint rows. */
static void add_row(struct gm_banded *matrix, const struct work *work, size_t element, size_t row,
                    size_t column, double factor, const double values[4], size_t by)
{
    const size_t points = work->mesh.points, per_node = unknowns_at_node(work->row);
    for (size_t b = 0; b < 2; b++) {
        const size_t j = element + b;
        if (j < 1 || j > points) {
            continue;
        }
        if (element >= 1) {
            gm_banded_add(matrix, (element - 1) * per_node + row, (j - 1) * per_node + column,
                          factor * values[2 * b + by]);
        }
        if (element < points) {
            gm_banded_add(matrix, element * per_node + row, (j - 1) * per_node + column,
                          -factor * values[2 * b + by]);
        }
    }
}

static void transpose(double block[4][4], double out[4][4])
{
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < 4; b++) {
            out[a][b] = block[b][a];
        }
    }
}

static void jacobian(void *self, const double *unknowns, struct gm_banded *matrix)
{
    (void)unknowns;
    struct work *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t stages = tableau->stages, per_stage = width(work->row);
    const bool mesh_moves = moves(work->row);
    const double h = work->h;
    enum { Y, X };
    for (size_t e = 0; e <= work->mesh.points; e++) {
        struct gm_element_matrices at[GM_STAGES];
        double turned[GM_STAGES][4][4]; /* d2l / dz dzdot */
        for (size_t i = 0; i < stages; i++) {
            gm_elements_matrices(&work->stages[i], &work->mesh, e, mesh_moves, &at[i]);
            transpose(at[i].mixed, turned[i]);
        }
        for (size_t i = 0; i < stages; i++) {
            const size_t row = i * per_stage;
            for (size_t m = 0; m < stages; m++) {
                const size_t column = m * per_stage;
                const double a = tableau->a[i][m], abar = tableau->abar[i][m];
                add(matrix, work, e, row, column, h * a, at[i].mixed, Y, Y);
                add(matrix, work, e, row, column, -h * abar, turned[m], Y, Y);
                for (size_t j = 0; j < stages; j++) {
                    add(matrix, work, e, row, column, -h * h * tableau->abar[i][j] * tableau->a[j][m],
                        at[j].stiff, Y, Y);
                }
                if (mesh_moves) {
                    add(matrix, work, e, row, column + 1, -h * abar, at[m].stiff, Y, X);
                    add(matrix, work, e, row, column + 2, -h * abar, turned[m], Y, X);
                    add_row(matrix, work, e, row + 1, column, h * a, at[i].gradient, Y);
                    add_row(matrix, work, e, row + 2, column, h * a, at[i].bend, Y);
                }
            }
            add(matrix, work, e, row, row, 1, at[i].mass, Y, Y);
            if (mesh_moves) {
                add(matrix, work, e, row, row + 1, 1, at[i].mixed, Y, X);
                add(matrix, work, e, row, row + 2, 1, at[i].mass, Y, X);
                add_row(matrix, work, e, row + 1, row + 1, 1, at[i].gradient, X);
                add_row(matrix, work, e, row + 2, row, 1, at[i].gradient, Y);
                add_row(matrix, work, e, row + 2, row + 1, 1, at[i].bend, X);
                add_row(matrix, work, e, row + 2, row + 2, 1, at[i].gradient, X);
            }
        }
    }
}

static const double weights[3 * GM_STAGES] = {1, 1, 1, 1, 1, 1, 1, 1, 1};

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t points = problem->n / 4;
    return gm_solver_memory(points, unknowns_at_node(scheme->coefficients), 4 * points);
}

static void workspace_close(void *workspace)
{
    struct work *work = workspace;
    for (size_t i = 0; i < GM_STAGES; i++) {
        gm_elements_close(&work->stages[i]);
    }
    gm_elements_close(&work->ends);
    gm_solver_close(&work->solver);
    gm_banded_close(&work->places);
    gm_banded_close(&work->motions);
    free(work->momenta);
    free(work);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    struct work *work = calloc(1, sizeof *work);
    if (!work) {
        return NULL;
    }
    gm_moving_mesh_of(problem)->describe(problem, &work->mesh);
    work->row = scheme->coefficients;
    const size_t points = work->mesh.points, per_node = unknowns_at_node(work->row);
    const size_t velocities = moves(work->row) ? 2 : 1;
    bool good = gm_elements_open(&work->ends, &work->mesh);
    for (size_t i = 0; i < work->row->tableau->stages; i++) {
        good = good && gm_elements_open(&work->stages[i], &work->mesh);
    }
    good = good && gm_solver_open(&work->solver, points, per_node, 2 * per_node - 1);
    good = good && gm_banded_open(&work->places, points, 1);
    good = good && gm_banded_open(&work->motions, velocities * points, 2 * velocities - 1);
    work->momenta = calloc(4 * points, sizeof *work->momenta);
    if (!good || !work->momenta) {
        workspace_close(work);
        return NULL;
    }
    work->scratch = work->momenta + points;
    return work;
}

static void workspace_reset(void *workspace)
{
    ((struct work *)workspace)->solver.stamp = 0;
}

/* Velocities with M_yy ydot + M_yX Xdot = p and Dg (ydot, Xdot) = 0, into the state. */
static bool velocities(struct work *work, const double *p, double *state)
{
    const size_t points = work->mesh.points;
    const struct gm_elements *ends = &work->ends;
    const size_t count = moves(work->row) ? 2 : 1;
    gm_banded_clear(&work->motions);
    for (size_t e = 0; e <= points; e++) {
        for (size_t a = 0; a < 2; a++) {
            for (size_t b = 0; b < 2; b++) {
                const size_t i = e + a, j = e + b;
                if (i < 1 || i > points || j < 1 || j > points) {
                    continue;
                }
                const double share = a == b ? 1. / 3 : 1. / 6;
                const size_t row = (i - 1) * count, column = (j - 1) * count;
                gm_banded_add(&work->motions, row, column, ends->width[e] * share);
                if (count == 2) {
                    const double by_y = b ? ends->ell_y1[e] : ends->ell_y0[e];
                    const double by_x = b ? ends->ell_d[e] : -ends->ell_d[e];
                    const double sign = a ? -1 : 1;
                    gm_banded_add(&work->motions, row, column + 1, -ends->rise[e] * share);
                    gm_banded_add(&work->motions, row + 1, column, sign * by_y);
                    gm_banded_add(&work->motions, row + 1, column + 1, sign * by_x);
                }
            }
        }
    }
    double *solution = work->scratch;
    for (size_t k = 0; k < points; k++) {
        solution[count * k] = p[k];
        if (count == 2) {
            solution[2 * k + 1] = 0;
        }
    }
    if (!gm_banded_factor(&work->motions)) {
        return false;
    }
    gm_banded_solve(&work->motions, solution);
    for (size_t k = 0; k < points; k++) {
        state[2 * points + k] = solution[count * k];
        state[3 * points + k] = count == 2 ? solution[2 * k + 1] : 0;
    }
    return true;
}

/* The end of the step, from the solved stages, into `state`, where its start is. */
static enum gm_status finish(void *self, double *state, double *multiplier)
{
    (void)multiplier;
    struct work *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t points = work->mesh.points, stages = tableau->stages;
    struct gm_elements *ends = &work->ends;
    for (size_t k = 1; k <= points; k++) {
        double rise = 0, force = 0, shift = 0;
        for (size_t i = 0; i < stages; i++) {
            const struct gm_elements *stage = &work->stages[i];
            rise += tableau->b[i] * stage->u[k];
            shift += tableau->b[i] * stage->v[k];
            force += tableau->b[i] * (stage->force_y1[k - 1] + stage->force_y0[k]);
        }
        ends->y[k] = state[k - 1] + work->h * rise;
        work->momenta[k - 1] += work->h * force;
        if (moves(work->row)) {
            ends->x[k] = tableau->stiffly_accurate ? work->stages[stages - 1].x[k]
                                                   : state[points + k - 1] + work->h * shift;
        }
    }
    if (moves(work->row) && !tableau->stiffly_accurate) {
        if (!gm_nodes_equidistribute(ends, &work->mesh, NULL, NULL, &work->places, work->scratch)) {
            return GM_MESH_CROSSING;
        }
    } else if (!gm_elements_measure(ends, &work->mesh)) {
        return GM_MESH_CROSSING;
    }
    memcpy(state, ends->y + 1, points * sizeof *state);
    memcpy(state + points, ends->x + 1, points * sizeof *state);
    return velocities(work, work->momenta, state) ? GM_OK : GM_NO_CONVERGENCE;
}

static enum gm_status start(const struct gm_task *task)
{
    struct work *work = task->workspace;
    gm_solver_start(&work->solver, task->memory_out);
    return gm_mesh_carry(&work->mesh, work->row->kind, task->y, task->out) ? GM_OK : GM_MESH_CROSSING;
}

static struct gm_progress loop(const struct gm_task *task)
{
    struct work *work = task->workspace;
    const size_t points = work->mesh.points, per_node = unknowns_at_node(work->row);
    const struct gm_step_equations equations = {
        .self = work,
        .nodes = points,
        .per_node = per_node,
        .state = 4 * points,
        .noise = DBL_EPSILON * work->mesh.length / fabs(task->dt),
        .weights = weights,
        .step = task->dt,
        .place = place,
        .guess = guess,
        .residual = residual,
        .jacobian = jacobian,
    };
    return gm_mesh_advance(task, &work->solver, &equations, finish);
}

#define CONTROL(which)                                                                                       \
    .coefficients = &(const struct gm_control)                                                               \
    {                                                                                                        \
        GM_MESH_MOVING, &gm_tableau_##which                                                                  \
    }
#define UNIFORM(which)                                                                                       \
    .coefficients = &(const struct gm_control)                                                               \
    {                                                                                                        \
        GM_MESH_UNIFORM, &gm_tableau_##which                                                                 \
    }
#define COMMON .family = &gm_family_control

#define EQUATIONS                                                                                            \
    "∂L/∂ẏ(Yᵢ, Qᵢ) = pₙ + h Σ āᵢⱼ ∂L/∂y,  Yᵢ = yₙ + h Σ aᵢⱼ Ẏⱼ\n"         \
    "g(Yᵢ, Qᵢ) = 0"
#define FIXED "∂L/∂ẏ(Yᵢ) = pₙ + h Σ āᵢⱼ ∂L/∂y,  Yᵢ = yₙ + h Σ aᵢⱼ Ẏⱼ,  X fixed"
#define SYMPLECTIC_PAIR (GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE)

static const struct gm_scheme schemes[] = {
    {
        .name = "uniform-gauss2",
        .title = "uniform Gauss 2",
        .formula = FIXED,
        .reference = "Tyranowski & Desbrun (2019), section 5.3",
        UNIFORM(gauss2),
        .order = 2,
        .claims = SYMPLECTIC_PAIR | GM_MULTISYMPLECTIC,
        COMMON,
    },
    {
        .name = "uniform-gauss4",
        .title = "uniform Gauss 4",
        .formula = FIXED,
        .reference = "Tyranowski & Desbrun (2019), section 5.3",
        UNIFORM(gauss4),
        .order = 4,
        .claims = SYMPLECTIC_PAIR,
        COMMON,
    },
    {
        .name = "uniform-lobatto2",
        .title = "uniform Lobatto 2",
        .formula = FIXED,
        .reference = "Tyranowski & Desbrun (2019), section 5.3",
        UNIFORM(lobatto2),
        .order = 2,
        .claims = SYMPLECTIC_PAIR | GM_MULTISYMPLECTIC,
        COMMON,
    },
    {
        .name = "uniform-lobatto4",
        .title = "uniform Lobatto 4",
        .formula = FIXED,
        .reference = "Tyranowski & Desbrun (2019), section 5.3",
        UNIFORM(lobatto4),
        .order = 4,
        .claims = SYMPLECTIC_PAIR,
        COMMON,
    },
    {
        .name = "control-gauss2",
        .title = "control Gauss 2",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eq. 21",
        CONTROL(gauss2),
        .order = 2,
        .claims = GM_SYMMETRIC | GM_REVERSIBLE,
        COMMON,
    },
    {
        .name = "control-gauss4",
        .title = "control Gauss 4",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eq. 21",
        CONTROL(gauss4),
        .order = 4,
        .claims = GM_SYMMETRIC | GM_REVERSIBLE,
        COMMON,
    },
    {
        .name = "control-lobatto2",
        .title = "control Lobatto 2",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eq. 21",
        CONTROL(lobatto2),
        .order = 2,
        .claims = GM_SYMMETRIC | GM_REVERSIBLE,
        COMMON,
    },
    {
        .name = "control-lobatto4",
        .title = "control Lobatto 4",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eq. 21",
        CONTROL(lobatto4),
        .order = 4,
        .claims = GM_SYMMETRIC | GM_REVERSIBLE,
        COMMON,
    },
    {
        .name = "control-radau3",
        .title = "control Radau 3",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), eq. 21; B. L. Ehle (1969)",
        CONTROL(radau3),
        .order = 3,
        COMMON,
    },
    {
        .name = "control-radau5",
        .title = "control Radau 5",
        .formula = EQUATIONS,
        .reference = "Tyranowski & Desbrun (2019), section 5.4; B. L. Ehle (1969)",
        CONTROL(radau5),
        .order = 5,
        COMMON,
    },
};

const struct gm_family gm_family_control = {
    .kind = &gm_kind_mesh,
    .title = "control-theoretic and uniform meshes",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = workspace_close,
    .workspace_reset = workspace_reset,
};

enum gm_mesh_kind gm_scheme_mesh(const struct gm_scheme *scheme)
{
    const struct gm_control *row = scheme->coefficients;
    return scheme->family == &gm_family_control ? row->kind : GM_MESH_MOVING;
}
