/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods of Lie groups, for the bracket of angular momenta, of one or several, which rotations turn, y' = omega(y) x
   y; and for that of a top, whose angular momentum y and vertical z motions of space move: k = (omega, u) acts as
       y' = omega x y + u x z,   z' = omega x z,   omega = -s dH/dy,  u = -s dH/dz
       exp(k) (y, z) = (R y + V u x R z, R z),   R = exp(omega),  V = int_0^1 exp(t omega) dt
       [(omega, u), (omega', u')] = (omega x omega', omega x u' - omega' x u)
   Every step is such an action, so that Casimirs, |y|^2 or |z|^2 and y.z, stay at round-off, whatever H. F(y) is h k
   at y.
   rkmk4: Kutta's method in the algebra, with the commutators that order 4 needs,
       k_1 = F(y_0),                                k_2 = F(exp(k_1/2) y_0),
       k_3 = F(exp(k_2/2 - [k_1, k_2]/8) y_0),      k_4 = F(exp(k_3) y_0),
       y_1 = exp((k_1 + 2 k_2 + 2 k_3 + k_4 - [k_1, k_4]/2)/6) y_0
   H. Munthe-Kaas & B. Owren, Phil. Trans. R. Soc. A 357 (1999) 957; Hairer, Lubich & Wanner (2006), IV.8.2.
   crouch-grossman3, crouch-grossman4: products of exponentials at each stage,
       k_i = F(exp(a_i,i-1 k_i-1) ... exp(a_i1 k_1) y_0),   y_1 = exp(b_s k_s) ... exp(b_1 k_1) y_0
   P.E. Crouch & R. Grossman, J. Nonlinear Sci. 3 (1993) 1; B. Owren & A. Marthinsen, BIT 39 (1999) 116. */
#include "core/functions/functions.h"
#include "core/ode/families/family.h"
#include "core/ode/families/poisson/turns.h"

enum { STAGES = 5, VECTORS = 7 /* vectors of scratch */ };

struct crouch_grossman {
    int stages; /* 0: Munthe-Kaas */
    double a[STAGES][STAGES], b[STAGES];
};

/* a := V a for the rotation by `axis`; V = I + (1 - cos x)/x^2 axis x + (x - sin x)/x^3 axis x axis x, x = |axis| */
static void drag(const double *axis, double *a)
{
    const double square = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2], angle = sqrt(square);
    const double half = angle > 0 ? gm_sin(angle / 2) / (angle / 2) : 1;
    double once[3], twice[3], along = 0;
    if (angle > 0.5) {
        along = (angle - gm_sin(angle)) / (square * angle);
    } else { /* 1/6 - x^2/120 + ..., if the difference would cancel */
        for (int k = 7; k >= 0; k--) {
            along = (1 - square * along) / ((2 * k + 2) * (2 * k + 3));
        }
    }
    gm_cross(axis, a, once);
    gm_cross(axis, once, twice);
    for (int i = 0; i < 3; i++) {
        a[i] += half * half / 2 * once[i] + along * twice[i];
    }
}

/* y := exp(factor k) y */
static void act(const struct gm_problem *problem, double factor, const double *k, double *y)
{
    const size_t spins = gm_ode_of(problem)->poisson->spins;
    for (size_t i = 0; i < spins; i++) {
        double axis[3], vector[3];
        gm_vector_take(k, i, spins, axis);
        gm_vector_take(y, i, spins, vector);
        gm_turn(factor, axis, vector);
        gm_vector_put(y, i, spins, vector);
    }
    if (spins == 0) {
        double axis[3], arm[3], moment[3];
        for (int i = 0; i < 3; i++) {
            axis[i] = factor * k[i];
            arm[i] = factor * k[3 + i];
        }
        drag(axis, arm);
        gm_turn(1, axis, y);
        gm_turn(1, axis, y + 3);
        gm_cross(arm, y + 3, moment);
        for (int i = 0; i < 3; i++) {
            y[i] += moment[i];
        }
    }
}

/* c := [a, b] */
static void commute(const struct gm_problem *problem, const double *a, const double *b, double *c)
{
    const size_t spins = gm_ode_of(problem)->poisson->spins;
    for (size_t i = 0; i < spins; i++) {
        double one[3], other[3], both[3];
        gm_vector_take(a, i, spins, one);
        gm_vector_take(b, i, spins, other);
        gm_cross(one, other, both);
        gm_vector_put(c, i, spins, both);
    }
    if (spins == 0) {
        double back[3];
        gm_cross(a, b, c);
        gm_cross(a, b + 3, c + 3);
        gm_cross(b, a + 3, back);
        for (int i = 0; i < 3; i++) {
            c[3 + i] -= back[i];
        }
    }
}

static void munthe_kaas(const struct gm_problem *problem, double h, double *y, double *scratch,
                        struct gm_progress *progress)
{
    const size_t n = problem->n;
    double *k[4] = {scratch, scratch + n, scratch + 2 * n, scratch + 3 * n};
    double *there = scratch + 4 * n, *bracket = there + n, *sum = bracket + n;
    gm_angular_velocity(problem, h, y, k[0], progress);
    memcpy(there, y, n * sizeof *there);
    act(problem, 0.5, k[0], there);
    gm_angular_velocity(problem, h, there, k[1], progress);
    commute(problem, k[0], k[1], bracket);
    for (size_t i = 0; i < n; i++) {
        sum[i] = k[1][i] / 2 - bracket[i] / 8;
    }
    memcpy(there, y, n * sizeof *there);
    act(problem, 1, sum, there);
    gm_angular_velocity(problem, h, there, k[2], progress);
    memcpy(there, y, n * sizeof *there);
    act(problem, 1, k[2], there);
    gm_angular_velocity(problem, h, there, k[3], progress);
    commute(problem, k[0], k[3], bracket);
    for (size_t i = 0; i < n; i++) {
        sum[i] = (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i] - bracket[i] / 2) / 6;
    }
    act(problem, 1, sum, y);
}

static void products(const struct gm_problem *problem, const struct crouch_grossman *tableau, double h,
                     double *y, double *scratch, struct gm_progress *progress)
{
    const size_t n = problem->n;
    double *there = scratch + STAGES * n;
    for (int i = 0; i < tableau->stages; i++) {
        memcpy(there, y, n * sizeof *there);
        for (int j = 0; j < i; j++) {
            act(problem, tableau->a[i][j], scratch + (size_t)j * n, there);
        }
        gm_angular_velocity(problem, h, there, scratch + (size_t)i * n, progress);
    }
    for (int i = 0; i < tableau->stages; i++) {
        act(problem, tableau->b[i], scratch + (size_t)i * n, y);
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct crouch_grossman *tableau = task->scheme->coefficients;
    if (tableau->stages == 0) {
        munthe_kaas(task->problem, task->dt, members->y, members->scratch, progress);
    } else {
        products(task->problem, tableau, task->dt, members->y, members->scratch, progress);
    }
    return GM_OK;
}

static const struct crouch_grossman none = {0};
static const struct crouch_grossman three = {
    3, {{0}, {3. / 4}, {119. / 216, 17. / 108}}, {13. / 51, -2. / 3, 24. / 17}};
static const struct crouch_grossman four = {
    5,
    {{0},
     {0.8177227988124852},
     {0.3199876375476427, 0.0659864263556022},
     {0.9214417194464946, 0.4997857776773573, -1.0969984448371582},
     {0.3552358559023322, 0.2390958372307326, 1.3918565724203246, -1.1092979392113565}},
    {0.1370831520630755, -0.0183698531564020, 0.7397813985370780, -0.1907142565505889, 0.3322195591068374}};

const struct gm_family gm_family_lie_group = {
    .title = "Lie groups",
    GM_MEMBERS(lie_group, .step = step, .vectors = VECTORS),
};
