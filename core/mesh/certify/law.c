/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete multisymplectic form formula, for the trapezoidal discrete Lagrangian of element e over a
   step,
       L_e(z, z') = h/2 [l_e(z, v) + l_e(z', v)] - Lambda_e ell_e(z),   v = (z' - z) / h,   z = (q_e, q_{e+1})
   and on a mesh that is given, which has no constraint Lambda_e, also for that of the midpoint rule, which is
   Gauss' method of order 2,
       L_e(z, z') = h l_e((z + z') / 2, v),
   with the places and velocities of a known mesh, at the middle of the step, instead of means.
   By the formula the symplectic form of any stretch of nodes changes over a step by what the two ends of the stretch
   let through. d(dL_e) = 0 for every element, whose ell are equal, so that the formula of a stretch is the sum of
   those of its nodes; and the formula of one node is
       dq_i ^ dR_i = 0,   R_i = sum over elements at i of dL_e/dq' of the step before and dL_e/dq of this one
   on motions of two steps that the scheme makes; R_i = 0 are the discrete Euler-Lagrange equations. The multipliers
   are those with which the equations of X hold: nothing is taken from the scheme but where the nodes are. Tyranowski
   & Desbrun (2019), sections 4.2 and 4.3, eqs. 109, 154-155; J.E. Marsden, G.W. Patrick & S. Shkoller, Commun. Math.
   Phys. 199 (1998) 351. */
#include "core/mesh/certify/subject.h"

#include <math.h>
#include <string.h>

#include "core/linear/iteration.h"
#include "core/mesh/nodes.h"

enum { POINTS = 3, ELEMENTS = POINTS + 1, DIRECTIONS = 2 * POINTS };

/* q_i = (y, X) and R_i of all nodes; of the ends, which are held, the numbers mean nothing. */
struct motion {
    double place[POINTS + 2][2], rest[POINTS + 2][2];
};

/* The law that is measured: for the trapezoidal rule or that of the midpoint, with the elements at the start and the end
   of a step, or both in its middle, with its mean velocity. */
struct law {
    const struct gm_mesh_subject *subject;
    bool midpoint;
    struct gm_elements *at; /* 2 */
};

/* Evaluates the elements of the step from one state to another, whose middle is at the time t. */
static bool place(const struct law *law, double t, const double *from, const double *to)
{
    const struct gm_mesh *mesh = &law->subject->mesh;
    const size_t half = 2 * mesh->points;
    for (size_t side = 0; side < 2; side++) {
        double mean[4 * POINTS];
        for (size_t i = 0; i < half; i++) {
            const double end = side ? to[i] : from[i];
            mean[i] = law->midpoint ? (from[i] + to[i]) / 2 : end;
            mean[half + i] = (to[i] - from[i]) / law->subject->trial.dt;
        }
        gm_elements_place(&law->at[side], mean);
        if (law->subject->kind == GM_MESH_GIVEN) {
            gm_mesh_known(mesh, GM_MESH_GIVEN, t, &law->at[side]);
        }
        if (!gm_elements_evaluate(&law->at[side], mesh)) {
            return false;
        }
    }
    gm_elements_constrain(&law->at[0], mesh);
    return true;
}

/* Adds to R_i the derivatives by the end of a step, or by its start: h/2 times the force there, and the mean momentum. */
static void differentiate(const struct law *law, bool by_end, double rest[POINTS + 2][2])
{
    const double half = law->subject->trial.dt / 2, sign = by_end ? 0.5 : -0.5;
    const struct gm_elements *first = &law->at[0], *last = &law->at[1], *at = by_end ? last : first;
    for (size_t k = 1; k <= POINTS; k++) {
        rest[k][0] += half * (at->force_y1[k - 1] + at->force_y0[k]) +
                      sign * (gm_momentum_u(first, k) + gm_momentum_u(last, k));
        rest[k][1] += half * (at->force_d[k - 1] - at->force_d[k]) +
                      sign * (gm_momentum_v(first, k) + gm_momentum_v(last, k));
    }
}

/* Adds the multipliers' part, with which the equations of X hold: (dg/dX)^T lambda = R_X. */
static bool add_multipliers(const struct gm_elements *at, double rest[POINTS + 2][2])
{
    double matrix[POINTS * POINTS] = {0}, lambda[POINTS], share[ELEMENTS];
    for (size_t k = 1; k <= POINTS; k++) {
        lambda[k - 1] = rest[k][1];
        for (size_t i = 0; i < 4; i++) { /* both ends of the elements k - 1 and k: g_k = ell_k - ell_(k-1) */
            const size_t e = k - 1 + i / 2, node = e + i % 2;
            const double by = at->gradient[2 * (i % 2) + 1][e];
            if (node >= 1 && node <= POINTS) {
                matrix[(node - 1) * POINTS + k - 1] += e == k ? by : -by;
            }
        }
    }
    if (!gm_eliminate(POINTS, matrix, lambda)) {
        return false;
    }
    gm_nodes_spread(lambda, POINTS, 1, 0, share);
    for (size_t i = 0; i < 4 * ELEMENTS; i++) {
        const size_t e = i / 4, a = i % 4;
        rest[e + a / 2][a % 2] -= share[e] * at->gradient[a][e];
    }
    return true;
}

/* Measures the motion from a shifted start; `data` is the law, and `values` the motion. */
static bool measure(const void *data, const double *by, double *values)
{
    const struct law *law = data;
    const struct gm_mesh_subject *subject = law->subject;
    const double h = subject->trial.dt, middle = subject->mesh.t + h / 2;
    struct motion *motion = (struct motion *)values;
    double states[3][4 * POINTS];
    memset(motion, 0, sizeof *motion);
    struct gm_trial twice = subject->trial;
    twice.steps = 2;
    if (!gm_mesh_subject_shift(subject, by, states[0]) ||
        !gm_trial_advance(&subject->trial, states[0], states[1]) ||
        !gm_trial_advance(&twice, states[0], states[2]) || !place(law, middle, states[0], states[1])) {
        return false;
    }
    differentiate(law, true, motion->rest);
    if (!place(law, middle + h, states[1], states[2])) {
        return false;
    }
    differentiate(law, false, motion->rest);
    for (size_t i = 0; i < 2 * POINTS; i++) {
        motion->place[i % POINTS + 1][i / POINTS] = states[1][i];
    }
    return subject->kind != GM_MESH_MOVING || add_multipliers(&law->at[0], motion->rest);
}

static double defect_of(const struct law *law)
{
    const struct gm_map map = {measure, law, 2 * POINTS, sizeof(struct motion) / sizeof(double)};
    struct motion tangents[DIRECTIONS];
    double defect = 0;
    for (size_t v = 0; v < DIRECTIONS; v++) {
        if (!gm_mesh_derive(&map, v, (double *)&tangents[v])) {
            return INFINITY;
        }
        for (size_t i = 0; i < v * POINTS; i++) {
            const struct motion *a = &tangents[v], *b = &tangents[i / POINTS];
            const size_t k = i % POINTS + 1;
            double form = 0;
            for (size_t c = 0; c < 2; c++) {
                form += a->place[k][c] * b->rest[k][c] - b->place[k][c] * a->rest[k][c];
            }
            defect = fmax(defect, fabs(form));
        }
    }
    return defect;
}

double gm_mesh_law_defect(const struct gm_mesh_subject *subject)
{
    const struct gm_mesh *mesh = &subject->mesh;
    if (subject->trial.scheme->family->adaptive || mesh->points != POINTS || mesh->alone) {
        return NAN;
    }
    struct gm_elements at[2] = {{0}};
    double defect = INFINITY;
    if (gm_elements_open(&at[0], mesh) && gm_elements_open(&at[1], mesh)) {
        /* of a mesh that is known only the midpoint rule comes from a Lagrangian, of one that moves only the other */
        for (int midpoint = subject->kind == GM_MESH_GIVEN; midpoint <= (subject->kind != GM_MESH_MOVING);
             midpoint++) {
            defect = fmin(defect, defect_of(&(struct law){subject, midpoint, at}));
        }
    }
    gm_elements_close(&at[0]);
    gm_elements_close(&at[1]);
    return defect;
}
