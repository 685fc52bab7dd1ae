/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete multisymplectic form formula, for the trapezoidal discrete Lagrangian of element e over a
   step,
       L_e(z, z') = h/2 [l_e(z, v) + l_e(z', v)] - Lambda_e ell_e(z),   v = (z' - z) / h,   z = (q_e, q_{e+1})
   and on a mesh that is given, which has no constraint Lambda_e, also for that of the midpoint rule, which is
   Gauss' method of order 2,
       L_e(z, z') = h l_e((z + z') / 2, v),
   with the places and velocities of a known mesh, at the middle of the step, instead of means.
   Where the Euler-Lagrange equations hold at the nodes, the symplectic form of any stretch of nodes a ... b
   changes by what its two ends let through:
       sum_{i=a}^{b} (dq_i' ^ dp_i' - dq_i ^ dp_i)
               = f(a, a-1) + f(b, b) - dell_a ^ dlambda_a + dell_b ^ dlambda_b
       f(i, e) = dq_i' ^ d(dL_e/dq_i') + dq_i ^ d(dL_e/dq_i)
   on motions of three steps that the scheme makes. Momenta are those of the discrete Lagrangian of the step
   before, the multipliers those that the places ask for: nothing is taken from the scheme but where the
   nodes are. Tyranowski & Desbrun (2019), sections 4.2 and 4.3, eqs. 154-155; J.E. Marsden, G.W. Patrick &
   S. Shkoller, Commun. Math. Phys. 199 (1998) 351. */
#include "core/mesh/certify/subject.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/linear/iteration.h"
#include "core/mesh/nodes.h"

enum { POINTS = 3, ELEMENTS = POINTS + 1, DIRECTIONS = 2 * POINTS };

/* Numbers of a motion; [..][2] are those of y and X. */
struct motion {
    double here[POINTS + 2][2], next[POINTS + 2][2]; /* q_i and q_i' */
    double momentum[POINTS + 2][2];                  /* p_i, of the step before */
    double push[ELEMENTS][2][2];                     /* dL_e/dq' at both ends of the element */
    double pull[ELEMENTS][2][2];                     /* dL_e/dq, with the multiplier's share */
    double lambda[POINTS + 2], ell[ELEMENTS];
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

/* Multipliers with which the Euler-Lagrange equations of X hold, (dg/dX)^T lambda = rest. */
static bool find_multipliers(const struct gm_elements *at, double rest[POINTS + 2][2], double *lambda)
{
    double matrix[POINTS * POINTS] = {0};
    for (size_t k = 1; k <= POINTS; k++) {
        lambda[k] = rest[k][1];
        for (size_t i = 0; i < 4; i++) { /* both ends of the elements k - 1 and k: g_k = ell_k - ell_(k-1) */
            const size_t e = k - 1 + i / 2, node = e + i % 2;
            const double by = at->gradient[2 * (i % 2) + 1][e];
            if (node >= 1 && node <= POINTS) {
                matrix[(node - 1) * POINTS + k - 1] += e == k ? by : -by;
            }
        }
    }
    return gm_eliminate(POINTS, matrix, lambda + 1);
}

/* dL_e/dq' and dL_e/dq at both ends of all elements: h/2 times the derivative of l by the place there, and the mean
   momentum. */
static void differentiate(const struct law *law, double push[ELEMENTS][2][2], double pull[ELEMENTS][2][2])
{
    const double h = law->subject->trial.dt;
    for (size_t i = 0; i < 2 * ELEMENTS; i++) {
        const size_t e = i / 2, end = i % 2;
        double force[2][2], momentum[2] = {0};
        for (size_t side = 0; side < 2; side++) {
            const struct gm_elements *at = &law->at[side];
            const double u = (end ? at->momentum_u1 : at->momentum_u0)[e];
            momentum[0] += u / 2;
            momentum[1] -= at->slope[e] * u / 2;
            if (at->cells) {
                momentum[1] += (end ? at->cell_v1 : at->cell_v0)[e] / 2;
            }
            force[side][0] = h / 2 * (end ? at->force_y1 : at->force_y0)[e];
            force[side][1] = h / 2 * (end ? at->force_d[e] : -at->force_d[e]);
        }
        for (size_t c = 0; c < 2; c++) {
            push[e][end][c] = force[1][c] + momentum[c];
            pull[e][end][c] = force[0][c] - momentum[c];
        }
    }
}

/* Measures the motion from a shifted start; `data` is the law, and `values` the motion. */
static bool measure(const void *data, const double *by, double *values)
{
    const struct law *law = data;
    const struct gm_mesh_subject *subject = law->subject;
    const double h = subject->trial.dt, middle = subject->mesh.t + h / 2;
    const struct gm_elements *at = &law->at[0];
    struct motion *motion = (struct motion *)values;
    double states[3][4 * POINTS], push[ELEMENTS][2][2], rest[POINTS + 2][2] = {{0}};
    memset(motion, 0, sizeof *motion);
    struct gm_trial twice = subject->trial;
    twice.steps = 2;
    if (!gm_mesh_subject_shift(subject, by, states[0]) ||
        !gm_trial_advance(&subject->trial, states[0], states[1]) ||
        !gm_trial_advance(&twice, states[0], states[2]) || !place(law, middle, states[0], states[1])) {
        return false;
    }
    differentiate(law, push, motion->pull);
    if (!place(law, middle + h, states[1], states[2])) {
        return false;
    }
    differentiate(law, motion->push, motion->pull);
    memcpy(motion->ell, at->ell, sizeof motion->ell);
    for (size_t c = 0; c < 2; c++) {
        for (size_t i = 1; i <= POINTS; i++) {
            motion->here[i][c] = states[1][c * POINTS + i - 1];
            motion->next[i][c] = states[2][c * POINTS + i - 1];
        }
        for (size_t i = 0; i < 2 * ELEMENTS; i++) {
            const size_t e = i / 2, end = i % 2;
            motion->momentum[e + end][c] += push[e][end][c];
            rest[e + end][c] += push[e][end][c] + motion->pull[e][end][c];
        }
    }
    if (subject->kind != GM_MESH_MOVING) {
        return true;
    }
    if (!find_multipliers(at, rest, motion->lambda)) {
        return false;
    }
    for (size_t e = 0; e < ELEMENTS; e++) {
        const double share = motion->lambda[e] - motion->lambda[e + 1];
        for (size_t a = 0; a < 4; a++) {
            motion->pull[e][a / 2][a % 2] -= share * at->gradient[a][e];
        }
    }
    return true;
}

/* dfirst ^ dsecond, given by pointers into the derivatives along two motions */
static double wedge(const struct motion *v, const struct motion *w, size_t first, size_t second)
{
    const double *a = (const double *)v, *b = (const double *)w;
    return a[first] * b[second] - b[first] * a[second];
}

#define AT(member) (offsetof(struct motion, member) / sizeof(double))

static double through(const struct motion *v, const struct motion *w, size_t node, size_t element)
{
    const size_t end = node - element;
    double sum = 0;
    for (size_t c = 0; c < 2; c++) {
        sum += wedge(v, w, AT(next) + 2 * node + c, AT(push) + 4 * element + 2 * end + c) +
               wedge(v, w, AT(here) + 2 * node + c, AT(pull) + 4 * element + 2 * end + c);
    }
    return sum;
}

static double law_of(const struct motion *v, const struct motion *w, size_t a, size_t b)
{
    double sum = wedge(v, w, AT(ell) + a, AT(lambda) + a) - wedge(v, w, AT(ell) + b, AT(lambda) + b) -
                 through(v, w, a, a - 1) - through(v, w, b, b);
    for (size_t i = a; i <= b; i++) {
        for (size_t c = 0; c < 2; c++) {
            sum += wedge(v, w, AT(next) + 2 * i + c, AT(push) + 4 * (i - 1) + 2 + c) +
                   wedge(v, w, AT(next) + 2 * i + c, AT(push) + 4 * i + c) -
                   wedge(v, w, AT(here) + 2 * i + c, AT(momentum) + 2 * i + c);
        }
    }
    return fabs(sum);
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
        for (size_t w = 0; w < v; w++) {
            for (size_t a = 1; a <= POINTS; a++) {
                for (size_t b = a; b <= POINTS; b++) {
                    defect = fmax(defect, law_of(&tangents[v], &tangents[w], a, b));
                }
            }
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
