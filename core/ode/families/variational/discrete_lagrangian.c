/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Variational integrators with a fixed step, for every Lagrangian L(t, q, v) and forces F(t, q, v). The
   discrete Lagrangian is the action of a polynomial of degree s with values q0 = Q_0, .. Q_s = q1 at control
   points, q(c) = sum_j Q_j l_j(c), by a quadrature of r points:
       L_d = h sum_i b_i L(t + c_i h, q(c_i), q'(c_i) / h)
   and of it follow, with the forces' virtual work by the same quadrature (discrete Lagrange-d'Alembert),
       R_j  = sum_i b_i [ h (dL/dq + F)_i l_j(c_i) + (dL/dv)_i l_j'(c_i) ]
       -p0  = R_0,   0 = R_j  (0 < j < s),   p1 = R_s
   J.E. Marsden & M. West, Acta Numerica 10 (2001) 357, sections 1.5, 2.2 and 2.6; S. Ober-Blobaum & N. Saake,
   Adv. Comput. Math. 41 (2015) 955. One point in the middle is the midpoint rule, the end points make
   Verlet's scheme, and Gauss points are those of collocation where r = s; here r = s + 1.

   With constraints g(q) = 0, at control points that are those of Lobatto's quadrature, G = dg/dq:
       R_j + b_j G(Q_j)' mu_j instead of R_j,   g(Q_j) = 0  (0 < j <= s)
       p1 with the multiplier that makes G v = 0 there
   which, if the mass matrix is constant, is RATTLE for s = 1, and for s = 2, 3 the Lobatto IIIA-IIIB pairs
   of L. Jay, SIAM J. Numer. Anal. 33 (1996) 368, of order 2 s. SHAKE takes the momenta with the last
   multiplier, and puts them into the tangent when the next step begins.

   With a friction F = -c p the step without it is between two halves of the friction's exact flow,
       p := exp(-c h / 2) p
   so that every area shrinks by exp(-c h). R.I. McLachlan & M. Perlmutter, J. Geom. Phys. 39 (2001) 276. */
#include "core/ode/families/variational/discrete_lagrangian.h"

#include "core/functions/functions.h"
#include "core/ode/families/family.h"
#include "core/ode/kernel/tiles.h"
#include "core/ode/variational/manifold.h"

/* The scratch: the basis at the points, unknowns, and their equations. */
struct step {
    const struct gm_variational_row *rule;
    const struct gm_task *task;
    struct gm_manifold manifold;
    size_t half, constraints, unknowns;
    double friction, t;      /* t: the state's time, if the equations hold it */
    double *values, *slopes; /* l_j(c_i), l_j'(c_i): points * (degree + 1) */
    double *q, *p;           /* at the start */
    double *solution;        /* Q_j - q0, then mu_j, of the unknowns */
    double *scratch, *residual, *matrix;
    double *impulse; /* the momenta's gain, without the last multiplier */
    struct gm_progress *progress;
};

static size_t unknowns_of(const struct gm_problem *problem, const struct gm_variational_row *rule)
{
    return rule->degree * (problem->n / 2 + gm_action_constraints(problem));
}

/* The unknowns, and the scratch of Newton's method; the tables, and three vectors of coordinates. */
static size_t room_of(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_variational_row *rule = scheme->coefficients;
    const size_t unknowns = unknowns_of(problem, rule);
    return 2 * rule->points * (rule->degree + 1) + 3 * (problem->n / 2) + unknowns +
           gm_newton_scratch(unknowns) + gm_manifold_scratch_size(problem);
}

static struct step lay(const struct gm_problem *problem, const struct gm_variational_row *rule,
                       double *storage)
{
    const size_t half = problem->n / 2, unknowns = unknowns_of(problem, rule),
                 table = rule->points * (rule->degree + 1);
    struct step step = {.rule = rule,
                        .half = half,
                        .constraints = gm_action_constraints(problem),
                        .unknowns = unknowns,
                        .values = storage,
                        .slopes = storage + table,
                        .q = storage + 2 * table};
    step.p = step.q + half;
    step.impulse = step.p + half;
    step.solution = step.impulse + half;
    step.scratch = step.solution + unknowns;
    step.manifold = gm_manifold_lay(problem, step.scratch + gm_newton_scratch(unknowns));
    return step;
}

/* l_j(c) and its derivative, by Lagrange's formula */
static void basis(const struct gm_variational_row *rule, size_t j, double c, double *value, double *slope)
{
    *value = 1;
    *slope = 0;
    for (size_t k = 0; k <= rule->degree; k++) {
        if (k != j) {
            const double width = rule->control[j] - rule->control[k], factor = (c - rule->control[k]) / width;
            *slope = *slope * factor + *value / width;
            *value *= factor;
        }
    }
}

/* Fills the tables. */
static void *open_tables(struct gm_members *members, const struct gm_problem *problem,
                         const struct gm_scheme *scheme)
{
    const struct gm_variational_row *rule = scheme->coefficients;
    const struct step step = lay(problem, rule, members->scratch);
    for (size_t i = 0; i < rule->points && !rule->tables; i++) {
        for (size_t j = 0; j <= rule->degree; j++) {
            const size_t at = i * (rule->degree + 1) + j;
            basis(rule, j, rule->c[i], &step.values[at], &step.slopes[at]);
        }
    }
    return NULL;
}

/* leaves out the friction, F + c p, if it is solved apart */
static void leave_friction(const struct step *step)
{
    const struct gm_motion *motion = &step->manifold.action.motion;
    for (size_t i = 0; i < step->half && step->friction != 0; i++) {
        motion->forces[i] += step->friction * motion->momenta[i];
        for (size_t k = i * step->half; k < (i + 1) * step->half; k++) {
            motion->forces_q[k] += step->friction * motion->momenta_q[k];
            motion->forces_v[k] += step->friction * motion->momenta_v[k];
        }
    }
}

/* Point i of the quadrature, in the equations and their derivatives over the unknowns. */
static bool add_point(const struct step *step, const double *unknowns, size_t i)
{
    const struct gm_variational_row *rule = step->rule;
    const struct gm_motion *motion = &step->manifold.action.motion;
    const size_t half = step->half, all = step->unknowns;
    const double *l = step->values + i * (rule->degree + 1), *dl = step->slopes + i * (rule->degree + 1);
    const double h = step->task->dt, b = rule->b[i];
    double *at = step->manifold.at;
    for (size_t a = 0; a < half; a++) {
        at[a] = step->q[a];
        at[half + a] = 0;
        for (size_t j = 1; j <= rule->degree; j++) {
            at[a] += l[j] * unknowns[(j - 1) * half + a];
            at[half + a] += dl[j] * unknowns[(j - 1) * half + a];
        }
        at[half + a] /= h;
    }
    if (step->manifold.action.problem->n > 2 * half) {
        at[2 * half] = step->t + rule->c[i] * h;
    }
    if (!gm_action_evaluate(&step->manifold.action, at)) {
        return false;
    }
    leave_friction(step);
    for (size_t a = 0; a < half; a++) {
        step->impulse[a] += h * b * motion->forces[a];
        for (size_t j = 0; j < rule->degree; j++) {
            step->residual[j * half + a] -= b * (h * motion->forces[a] * l[j] + motion->momenta[a] * dl[j]);
        }
    }
    for (size_t j = 0; j < rule->degree; j++) {
        for (size_t k = 1; k <= rule->degree; k++) {
            const double forces_q = b * h * l[k] * l[j], forces_v = b * dl[k] * l[j],
                         momenta_q = b * l[k] * dl[j], momenta_v = b * dl[k] / h * dl[j];
            for (size_t a = 0; a < half; a++) {
                double *row = step->matrix + (j * half + a) * all + (k - 1) * half;
                for (size_t c = 0; c < half; c++) {
                    const size_t of = a * half + c;
                    row[c] += forces_q * motion->forces_q[of] + forces_v * motion->forces_v[of] +
                              momenta_q * motion->momenta_q[of] + momenta_v * motion->momenta_v[of];
                }
            }
        }
    }
    return true;
}

/* Adds the constraints at control point j, whose weight is b. */
static void add_constraints(const struct step *step, const double *unknowns, size_t j)
{
    const struct gm_manifold *manifold = &step->manifold;
    const size_t half = step->half, constraints = step->constraints, all = step->unknowns,
                 degree = step->rule->degree;
    const double b = step->rule->b[j];
    const double *moved = j > 0 ? unknowns + (j - 1) * half : NULL;
    for (size_t a = 0; a < half; a++) {
        manifold->at[a] = step->q[a] + (moved ? moved[a] : 0);
    }
    for (size_t k = 0; k < constraints; k++) {
        manifold->multipliers[k] = j < degree ? unknowns[degree * half + j * constraints + k] : 0;
    }
    gm_manifold_constrain(manifold, manifold->at);
    for (size_t k = 0; k < constraints; k++) {
        const size_t equation = degree * half + (j - 1) * constraints + k; /* g(Q_j) = 0 */
        if (moved) {
            step->residual[equation] = -manifold->g[k];
        }
        for (size_t a = 0; a < half; a++) {
            const double slope = manifold->slopes[k * half + a];
            if (moved) {
                step->matrix[equation * all + (j - 1) * half + a] = slope;
            }
            if (j < degree) {
                step->matrix[(j * half + a) * all + degree * half + j * constraints + k] = b * slope;
                step->residual[j * half + a] -= b * slope * manifold->multipliers[k];
                step->impulse[a] += b * slope * manifold->multipliers[k];
            }
        }
    }
    for (size_t a = 0; moved && j < degree && a < half; a++) {
        double *row = step->matrix + (j * half + a) * all + (j - 1) * half;
        for (size_t c = 0; c < half; c++) {
            row[c] += b * manifold->curvature[a * half + c];
        }
    }
}

/* -R at these unknowns, and the derivatives of R. */
static bool linear(void *data, const double *unknowns, double *residual, double *matrix, double *scale)
{
    struct step *step = data;
    const struct gm_variational_row *rule = step->rule;
    step->residual = residual;
    step->matrix = matrix;
    memset(step->impulse, 0, step->half * sizeof(double));
    memset(residual, 0, step->unknowns * sizeof(double));
    memset(matrix, 0, step->unknowns * step->unknowns * sizeof(double));
    for (size_t a = 0; a < step->half; a++) {
        residual[a] = -step->p[a];
    }
    for (size_t i = 0; i < rule->points; i++) {
        if (!add_point(step, unknowns, i)) {
            return false;
        }
    }
    for (size_t j = 0; j <= rule->degree && step->constraints > 0; j++) {
        add_constraints(step, unknowns, j);
    }
    step->progress->evaluations += rule->points;
    *scale += (double)rule->degree * gm_sum_of(step->q, step->half) +
              gm_sum_of(unknowns, rule->degree * step->half);
    return true;
}

/* Adds the last change of the multipliers to the momenta's gain. */
static void correct_impulse(const struct step *step)
{
    const struct gm_manifold *manifold = &step->manifold;
    const size_t half = step->half, degree = step->rule->degree;
    for (size_t j = 0; j < degree && step->constraints > 0; j++) {
        for (size_t a = 0; a < half; a++) {
            manifold->at[a] = step->q[a] + (j > 0 ? step->solution[(j - 1) * half + a] : 0);
        }
        gm_manifold_constrain(manifold, manifold->at);
        for (size_t k = 0; k < step->constraints; k++) {
            const double change = step->scratch[degree * half + j * step->constraints + k];
            for (size_t a = 0; a < half; a++) {
                step->impulse[a] += step->rule->b[j] * manifold->slopes[k * half + a] * change;
            }
        }
    }
}

/* Solves by Newton's method from rest, whose first step is the Legendre transform. The last change is below
   rounding, but has one sign in all steps: left out it would add up. */
static bool solve(struct step *step)
{
    const struct gm_implicit_equations equations = {.linear = linear,
                                                    .size = step->unknowns,
                                                    .data = step,
                                                    .counted = step->rule->degree * step->half,
                                                    .least = 0x1p-53,
                                                    .roundoff = 0x1p-46,
                                                    .halved = true};
    memset(step->solution, 0, step->unknowns * sizeof(double));
    if (!gm_newton_solve(&equations, step->scratch, step->solution, step->progress)) {
        return false;
    }
    correct_impulse(step);
    return true;
}

/* p1 := the momenta at the end, G v = 0 */
static bool end_on_manifold(const struct step *step, double *y)
{
    const struct gm_variational_row *rule = step->rule;
    const struct gm_manifold *manifold = &step->manifold;
    const size_t half = step->half;
    if (!rule->late) {
        for (size_t a = 0; a < half; a++) {
            manifold->at[half + a] = step->solution[(rule->degree - 1) * half + a] / step->task->dt;
        }
        return gm_manifold_settle(manifold, y);
    }
    gm_manifold_constrain(manifold, y);
    for (size_t k = 0; k < step->constraints; k++) {
        for (size_t a = 0; a < half; a++) {
            y[half + a] += rule->b[rule->degree] * manifold->slopes[k * half + a] *
                           step->solution[rule->degree * half + k];
        }
    }
    return true;
}

static enum gm_status make_step(const struct gm_task *task, struct gm_members *members,
                                struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_variational_row *rule = task->scheme->coefficients;
    struct step step = lay(problem, rule, members->scratch);
    const size_t half = step.half;
    double *y = members->y;
    step.task = task;
    step.progress = progress;
    step.friction = rule->damped ? *gm_ode_of(problem)->action->friction : 0;
    const double fades = gm_exp(-step.friction * task->dt / 2);
    if (rule->late) {
        memset(step.manifold.at + half, 0, half * sizeof *y);
        if (!gm_manifold_settle(&step.manifold, y)) {
            return GM_NO_CONVERGENCE;
        }
    }
    memcpy(step.q, y, half * sizeof *y);
    for (size_t a = 0; a < half; a++) {
        step.p[a] = rule->damped ? fades * y[half + a] : y[half + a];
    }
    step.t = problem->n > 2 * half ? y[2 * half] : 0;
    if (rule->tables) {
        rule->tables(task->settings, step.values, step.slopes);
    }
    if (!solve(&step)) {
        return GM_NO_CONVERGENCE;
    }
    double *carry = members->carry;
    memcpy(y + half, step.p, half * sizeof *y);
    gm_tile_add(y, 1, step.solution + (rule->degree - 1) * half, carry, half);
    gm_tile_add(y + half, 1, step.impulse, carry ? carry + half : NULL, half);
    if (problem->n > 2 * half) {
        gm_tile_add(y + 2 * half, 1, &task->dt, carry ? carry + 2 * half : NULL, 1);
    }
    if (step.constraints > 0 && !end_on_manifold(&step, y)) {
        return GM_NO_CONVERGENCE;
    }
    for (size_t a = 0; rule->damped && a < half; a++) {
        y[half + a] *= fades;
    }
    return GM_OK;
}

const struct gm_member_family gm_variational_members = {
    .step = make_step, .open = open_tables, .room = room_of};

#define TRAPEZOIDAL .degree = 1, .points = 2, .control = {0, 1}, .b = {0.5, 0.5}, .c = {0, 1}
#define MIDPOINT .degree = 1, .points = 1, .control = {0, 1}, .b = {1}, .c = {0.5}
#define SIMPSON                                                                                              \
    .degree = 2, .points = 3, .control = {0, 0.5, 1}, .b = {1. / 6, 2. / 3, 1. / 6}, .c = {0, 0.5, 1}
/* (1 - 1/sqrt(5)) / 2, (1 - 1/sqrt(3)) / 2, (1 - sqrt(3/5)) / 2, and the four points of Gauss */
#define OF_LOBATTO 0.27639320225002103036
#define OF_GAUSS2 0.21132486540518711775
#define OF_GAUSS3 0.11270166537925831148
#define OF_GAUSS4 0.06943184420297371239
#define MORE_OF_GAUSS4 0.33000947820757186760
#define WEIGHT_OF_GAUSS4 0.17392742256872692869

static const struct gm_variational_row midpoint = {MIDPOINT}, damped_midpoint = {MIDPOINT, .damped = true},
                                       trapezoidal = {TRAPEZOIDAL},
                                       damped_trapezoidal = {TRAPEZOIDAL, .damped = true},
                                       shake = {TRAPEZOIDAL, .late = true}, simpson = {SIMPSON};
static const struct gm_variational_row lobatto6 = {
    .degree = 3,
    .points = 4,
    .control = {0, OF_LOBATTO, 1 - OF_LOBATTO, 1},
    .b = {1. / 12, 5. / 12, 5. / 12, 1. / 12},
    .c = {0, OF_LOBATTO, 1 - OF_LOBATTO, 1},
};
static const struct gm_variational_row galerkin2 = {
    .degree = 1, .points = 2, .control = {0, 1}, .b = {0.5, 0.5}, .c = {OF_GAUSS2, 1 - OF_GAUSS2}};
static const struct gm_variational_row galerkin4 = {.degree = 2,
                                                    .points = 3,
                                                    .control = {0, 0.5, 1},
                                                    .b = {5. / 18, 4. / 9, 5. / 18},
                                                    .c = {OF_GAUSS3, 0.5, 1 - OF_GAUSS3}};
static const struct gm_variational_row galerkin6 = {
    .degree = 3,
    .points = 4,
    .control = {0, OF_LOBATTO, 1 - OF_LOBATTO, 1},
    .b = {WEIGHT_OF_GAUSS4, 0.5 - WEIGHT_OF_GAUSS4, 0.5 - WEIGHT_OF_GAUSS4, WEIGHT_OF_GAUSS4},
    .c = {OF_GAUSS4, MORE_OF_GAUSS4, 1 - MORE_OF_GAUSS4, 1 - OF_GAUSS4},
};

const struct gm_family gm_family_discrete_lagrangian = {
    .title = "variational, with fixed step",
    GM_ROWS(discrete_lagrangian),
    .parameters = gm_settings_of_sums,
    GM_MEMBERS_BY(&gm_variational_members),
};
