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
   before, the multipliers the best that the places allow: nothing is taken from the scheme but where the
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

/* The quadrature rule of an element's Lagrangian in a step. */
enum rule { TRAPEZOIDAL, MIDPOINT };

struct stages {
    enum rule rule;
    enum gm_mesh_kind kind;
    double t; /* the middle of the step */
    /* at the start and the end of a step, or both in its middle, with its mean velocity */
    struct gm_elements at[2];
};

struct law {
    struct gm_mesh_step step;
    enum gm_mesh_kind kind;
    enum rule rule;
};

static bool place(const struct gm_mesh_subject *subject, struct stages *stages, const double *from,
                  const double *to, double h)
{
    const size_t half = 2 * subject->mesh.points;
    for (size_t side = 0; side < 2; side++) {
        struct gm_elements *at = &stages->at[side];
        double mean[4 * POINTS];
        for (size_t i = 0; i < half; i++) {
            const double end = side ? to[i] : from[i];
            mean[i] = stages->rule == MIDPOINT ? (from[i] + to[i]) / 2 : end;
            mean[half + i] = (to[i] - from[i]) / h;
        }
        gm_elements_place(at, mean);
        if (stages->kind == GM_MESH_GIVEN) {
            gm_mesh_known(&subject->mesh, stages->kind, stages->t, at);
        }
        if (!gm_elements_evaluate(at, &subject->mesh)) {
            return false;
        }
    }
    gm_elements_constrain(&stages->at[0], &subject->mesh);
    return true;
}

/* Multipliers with which the Euler-Lagrange equations hold best: least squares of Dg^T lambda = rest. */
static bool fit_multipliers(const struct gm_elements *at, double rest[POINTS + 2][2], double *lambda)
{
    double row[POINTS][POINTS + 2][2] = {{{0}}}, normal[POINTS * POINTS] = {0};
    for (size_t k = 1; k <= POINTS; k++) {
        /* ell_k - ell_(k-1) */
        for (size_t c = 0; c < 2; c++) {
            row[k - 1][k][c] = at->gradient[c][k] - at->gradient[2 + c][k - 1];
            row[k - 1][k + 1][c] = at->gradient[2 + c][k];
            row[k - 1][k - 1][c] = -at->gradient[c][k - 1];
        }
    }
    for (size_t a = 0; a < POINTS; a++) {
        lambda[a + 1] = 0;
        for (size_t i = 1; i <= POINTS; i++) {
            for (size_t c = 0; c < 2; c++) {
                lambda[a + 1] += row[a][i][c] * rest[i][c];
                for (size_t b = 0; b < POINTS; b++) {
                    normal[a * POINTS + b] += row[a][i][c] * row[b][i][c];
                }
            }
        }
    }
    return gm_eliminate(POINTS, normal, lambda + 1);
}

/* dL_e/dq' and dL_e/dq at both ends of all elements: h/2 times the derivative of l by the place there, and the mean
   momentum. */
static void differentiate(const struct stages *stages, double h, double push[ELEMENTS][2][2],
                          double pull[ELEMENTS][2][2])
{
    for (size_t i = 0; i < 2 * ELEMENTS; i++) {
        const size_t e = i / 2, end = i % 2;
        double force[2][2], momentum[2] = {0};
        for (size_t side = 0; side < 2; side++) {
            const struct gm_elements *at = &stages->at[side];
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

static bool measure(const struct gm_mesh_subject *subject, const struct law *law, struct stages *stages,
                    double states[3][4 * POINTS], struct motion *motion)
{
    *motion = (struct motion){0};
    const double h = law->step.dt;
    const struct gm_elements *at = &stages->at[0];
    double push[ELEMENTS][2][2], rest[POINTS + 2][2] = {{0}};
    stages->t = subject->mesh.t + h / 2;
    if (!place(subject, stages, states[0], states[1], h)) {
        return false;
    }
    differentiate(stages, h, push, motion->pull);
    stages->t += h;
    if (!place(subject, stages, states[1], states[2], h)) {
        return false;
    }
    differentiate(stages, h, motion->push, motion->pull);
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
    if (law->kind != GM_MESH_MOVING) {
        return true;
    }
    if (!fit_multipliers(at, rest, motion->lambda)) {
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

static bool observe(const struct gm_mesh_subject *subject, const void *context, const double *state,
                    double *values)
{
    const struct law *law = context;
    const struct gm_mesh_step *step = &law->step;
    double states[3][4 * POINTS];
    struct stages stages = {.rule = law->rule, .kind = law->kind};
    struct motion motion;
    memcpy(states[0], state, sizeof states[0]);
    const bool good = gm_elements_open(&stages.at[0], &subject->mesh) &&
                      gm_elements_open(&stages.at[1], &subject->mesh) &&
                      gm_mesh_subject_advance(subject, step->scheme, step->dt, 1, states[0], states[1]) &&
                      gm_mesh_subject_advance(subject, step->scheme, step->dt, 2, states[0], states[2]) &&
                      measure(subject, law, &stages, states, &motion);
    if (good) {
        memcpy(values, &motion, sizeof motion);
    }
    gm_elements_close(&stages.at[0]);
    gm_elements_close(&stages.at[1]);
    return good;
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

static double defect_of(const struct gm_mesh_subject *subject, const struct law *law)
{
    struct motion tangents[DIRECTIONS];
    double defect = 0;
    for (size_t v = 0; v < DIRECTIONS; v++) {
        if (!gm_mesh_subject_derive(subject, law->kind, v, observe, law, sizeof tangents[v] / sizeof(double),
                                    (double *)&tangents[v])) {
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

double gm_mesh_law_defect(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt)
{
    if (scheme->family->adaptive || subject->mesh.points != POINTS || subject->mesh.alone) {
        return NAN;
    }
    struct law law = {{scheme, dt}, gm_scheme_mesh(scheme), TRAPEZOIDAL};
    const double trapezoidal = law.kind == GM_MESH_GIVEN ? INFINITY : defect_of(subject, &law);
    if (law.kind == GM_MESH_MOVING) {
        return trapezoidal;
    }
    law.rule = MIDPOINT;
    return fmin(trapezoidal, defect_of(subject, &law));
}
