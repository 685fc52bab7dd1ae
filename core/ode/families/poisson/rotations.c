/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes of rotations, for the bracket of angular momenta, {y_1, y_2} = -s y_3 and cyclic with s = +-1:
       y' = s y x grad H(y) = omega(y) x y,   omega = -s grad H
   They turn y, so that its length, the Casimir, stays at round-off, whatever H. exp(a) is the rotation by the
   vector a.

   rotations2: H = H_1(y_1) + H_2(y_2) + H_3(y_3), each of which turns about its axis at a constant rate,
       exp(h/2 omega_1 e_1) exp(h/2 omega_2 e_2) exp(h omega_3 e_3) exp(h/2 omega_2 e_2) exp(h/2 omega_1 e_1),
   a composition of Poisson maps. R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; S. Reich, Physica D 76 (1994)
   375. A heavy top has besides a vector z that it turns, the vertical seen from the body, and a potential:
       y' = s (y x grad T(y) + z x grad V(z)),   z' = s z x grad T(y)
   The rotations turn z as well, between two halves of the potential's exact flow, y := y + h/2 s z x grad V(z).
   A. Dullweber, B. Leimkuhler & R. McLachlan, J. Chem. Phys. 107 (1997) 5840.
   spherical-midpoint2:  y_1 = y_0 + h omega(z) x z,   z = |y_0| (y_0 + y_1) / |y_0 + y_1|
   R.I. McLachlan, K. Modin & O. Verdier, Phys. Rev. E 89 (2014) 061301. A Poisson map, too.
   rkmk4: Kutta's method in the algebra, with the commutators that order 4 needs,
       k_1 = h omega(y_0),                          k_2 = h omega(exp(k_1/2) y_0),
       k_3 = h omega(exp(k_2/2 - k_1 x k_2/8) y_0), k_4 = h omega(exp(k_3) y_0),
       y_1 = exp((k_1 + 2 k_2 + 2 k_3 + k_4 - k_1 x k_4/2)/6) y_0
   H. Munthe-Kaas & B. Owren, Phil. Trans. R. Soc. A 357 (1999) 957; Hairer, Lubich & Wanner (2006), IV.8.2.
   crouch-grossman3, crouch-grossman4: products of rotations at each stage,
       k_i = h omega(exp(a_i,i-1 k_i-1) ... exp(a_i1 k_1) y_0),   y_1 = exp(b_s k_s) ... exp(b_1 k_1) y_0
   P.E. Crouch & R. Grossman, J. Nonlinear Sci. 3 (1993) 1; B. Owren & A. Marthinsen, BIT 39 (1999) 116. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/count.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/members.h"

enum { STAGES = 5 };

struct crouch_grossman {
    int stages;
    double a[STAGES][STAGES], b[STAGES];
};

struct row {
    enum gm_status (*step)(const struct gm_problem *problem, const struct crouch_grossman *tableau, double h,
                           double *y, struct gm_progress *progress);
    struct crouch_grossman tableau;
};

static void cross(const double *a, const double *b, double *c)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * b[k] - a[k] * b[j];
    }
}

/* y := exp(factor a) y, by Rodrigues' formula */
static void turn(double factor, const double *a, double *y)
{
    const double axis[3] = {factor * a[0], factor * a[1], factor * a[2]};
    const double angle = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    const double half = angle > 0 ? sin(angle / 2) / (angle / 2) : 1;
    const double across = angle > 0 ? sin(angle) / angle : 1, along = half * half / 2;
    double once[3], twice[3];
    cross(axis, y, once);
    cross(axis, once, twice);
    for (int i = 0; i < 3; i++) {
        y[i] += across * once[i] + along * twice[i];
    }
}

/* h omega(y), as many numbers as the state has */
static void spin(const struct gm_problem *problem, double h, const double *y, double *k,
                 struct gm_progress *progress)
{
    const struct gm_poisson *poisson = gm_ode_of(problem)->poisson;
    poisson->gradient(problem, y, k);
    for (size_t i = 0; i < problem->n; i++) {
        k[i] *= -h * poisson->turning;
    }
    progress->evaluations++;
}

enum { MOST = 6 };

/* The flow of the potential: y := y + h s z x grad V(z) */
static void pull(const struct gm_problem *problem, double h, double *y, struct gm_progress *progress)
{
    double k[MOST], moment[3];
    if (problem->n > 3) {
        spin(problem, h, y, k, progress);
        cross(k + 3, y + 3, moment);
        for (int i = 0; i < 3; i++) {
            y[i] += moment[i];
        }
    }
}

static enum gm_status about_axes(const struct gm_problem *problem, const struct crouch_grossman *unused,
                                 double h, double *y, struct gm_progress *progress)
{
    static const int axes[] = {0, 1, 2, 1, 0};
    (void)unused;
    pull(problem, h / 2, y, progress);
    for (size_t i = 0; i < GM_COUNT(axes); i++) {
        double k[MOST], about[3] = {0};
        spin(problem, i == 2 ? h : h / 2, y, k, progress);
        about[axes[i]] = k[axes[i]];
        for (size_t vector = 0; vector < problem->n; vector += 3) {
            turn(1, about, y + vector);
        }
    }
    pull(problem, h / 2, y, progress);
    return GM_OK;
}

static enum gm_status spherical_midpoint(const struct gm_problem *problem,
                                         const struct crouch_grossman *unused, double h, double *y,
                                         struct gm_progress *progress)
{
    enum { ITERATIONS = 100 };
    const double radius = sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
    double end[3], k[3], push[3] = {0}, previous = INFINITY;
    (void)unused;
    memcpy(end, y, sizeof end);
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        double z[3], change = 0, length = 0;
        for (int i = 0; i < 3; i++) {
            z[i] = y[i] + end[i];
            length += z[i] * z[i];
        }
        for (int i = 0; i < 3; i++) {
            z[i] *= radius / sqrt(length);
        }
        spin(problem, h, z, k, progress);
        progress->iterations++;
        double next[3];
        cross(k, z, next);
        for (int i = 0; i < 3; i++) {
            change += fabs(next[i] - push[i]);
            push[i] = next[i];
            end[i] = y[i] + push[i];
        }
        if (radius == 0 || gm_is_settled(change, 4e-16 * radius * 3, &previous)) {
            memcpy(y, end, sizeof end);
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

static enum gm_status munthe_kaas(const struct gm_problem *problem, const struct crouch_grossman *unused,
                                  double h, double *y, struct gm_progress *progress)
{
    double k[4][3], there[3], bracket[3], sum[3];
    (void)unused;
    spin(problem, h, y, k[0], progress);
    memcpy(there, y, sizeof there);
    turn(0.5, k[0], there);
    spin(problem, h, there, k[1], progress);
    cross(k[0], k[1], bracket);
    for (int i = 0; i < 3; i++) {
        sum[i] = k[1][i] / 2 - bracket[i] / 8;
    }
    memcpy(there, y, sizeof there);
    turn(1, sum, there);
    spin(problem, h, there, k[2], progress);
    memcpy(there, y, sizeof there);
    turn(1, k[2], there);
    spin(problem, h, there, k[3], progress);
    cross(k[0], k[3], bracket);
    for (int i = 0; i < 3; i++) {
        sum[i] = (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i] - bracket[i] / 2) / 6;
    }
    turn(1, sum, y);
    return GM_OK;
}

static enum gm_status products(const struct gm_problem *problem, const struct crouch_grossman *tableau,
                               double h, double *y, struct gm_progress *progress)
{
    double k[STAGES][3], there[3];
    for (int i = 0; i < tableau->stages; i++) {
        memcpy(there, y, sizeof there);
        for (int j = 0; j < i; j++) {
            turn(tableau->a[i][j], k[j], there);
        }
        spin(problem, h, there, k[i], progress);
    }
    for (int i = 0; i < tableau->stages; i++) {
        turn(tableau->b[i], k[i], y);
    }
    return GM_OK;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct row *row = task->scheme->coefficients;
    return row->step(task->problem, &row->tableau, task->dt, members->y, progress);
}

static struct gm_progress loop(const struct gm_task *task)
{
    return gm_members_advance(task, step);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return gm_members_open(problem, 0, 0);
}

#define ROTATIONS(...)                                                                                       \
    .family = &gm_family_rotations, .coefficients = &(const struct row)                                      \
    {                                                                                                        \
        __VA_ARGS__                                                                                          \
    }

static const struct gm_scheme schemes[] = {
    {
        .name = "rotations2",
        .title = "rotations about the axes",
        .formula =
            "exp(½h ω₁e₁) exp(½h ω₂e₂) exp(h ω₃e₃) exp(½h ω₂e₂) exp(½h ω₁e₁) y₀,  ωᵢ = −s ∂H/∂yᵢ(yᵢ);\n"
            "of a top, y and z turn so, between two halves y ← y + ½h s z × ∇V(z)",
        .reference = "R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; S. Reich, Physica D 76 (1994) 375",
        ROTATIONS(.step = about_axes),
        .order = 2,
        .needs = GM_NEEDS_AXES,
        .claims = GM_SYMMETRIC | GM_KEEPS_CASIMIRS | GM_POISSON_MAP,
    },
    {
        .name = "spherical-midpoint2",
        .title = "spherical midpoint",
        .formula = "y₁ = y₀ + h ω(z) × z,  z = |y₀| (y₀ + y₁)/|y₀ + y₁|",
        .reference = "R.I. McLachlan, K. Modin & O. Verdier, Phys. Rev. E 89 (2014) 061301",
        ROTATIONS(.step = spherical_midpoint),
        .order = 2,
        .needs = GM_NEEDS_ROTATIONS,
        .claims = GM_SYMMETRIC | GM_KEEPS_CASIMIRS | GM_POISSON_MAP,
    },
    {
        .name = "rkmk4",
        .title = "Munthe-Kaas 4",
        .formula =
            "k₁ = hω(y₀),  k₂ = hω(exp(k₁/2)y₀),  k₃ = hω(exp(k₂/2 − [k₁,k₂]/8)y₀),  k₄ = hω(exp(k₃)y₀),\n"
            "y₁ = exp((k₁ + 2k₂ + 2k₃ + k₄ − [k₁,k₄]/2)/6) y₀",
        .reference = "H. Munthe-Kaas & B. Owren, Phil. Trans. R. Soc. A 357 (1999) 957",
        ROTATIONS(.step = munthe_kaas),
        .order = 4,
        .needs = GM_NEEDS_ROTATIONS,
        .claims = GM_KEEPS_CASIMIRS,
    },
    {
        .name = "crouch-grossman3",
        .title = "Crouch-Grossman 3",
        .formula = "kᵢ = hω(exp(aᵢ,ᵢ₋₁kᵢ₋₁) … exp(aᵢ₁k₁)y₀),  y₁ = exp(b₃k₃) exp(b₂k₂) exp(b₁k₁) y₀",
        .reference = "P.E. Crouch & R. Grossman, J. Nonlinear Sci. 3 (1993) 1",
        ROTATIONS(.step = products,
                  .tableau = {3, {{0}, {3. / 4}, {119. / 216, 17. / 108}}, {13. / 51, -2. / 3, 24. / 17}}),
        .order = 3,
        .needs = GM_NEEDS_ROTATIONS,
        .claims = GM_KEEPS_CASIMIRS,
    },
    {
        .name = "crouch-grossman4",
        .title = "Crouch-Grossman 4",
        .formula = "kᵢ = hω(exp(aᵢ,ᵢ₋₁kᵢ₋₁) … exp(aᵢ₁k₁)y₀),  y₁ = exp(b₅k₅) … exp(b₁k₁) y₀",
        .reference = "B. Owren & A. Marthinsen, BIT 39 (1999) 116",
        ROTATIONS(.step = products,
                  .tableau = {5,
                              {{0},
                               {0.8177227988124852},
                               {0.3199876375476427, 0.0659864263556022},
                               {0.9214417194464946, 0.4997857776773573, -1.0969984448371582},
                               {0.3552358559023322, 0.2390958372307326, 1.3918565724203246,
                                -1.1092979392113565}},
                              {0.1370831520630755, -0.0183698531564020, 0.7397813985370780,
                               -0.1907142565505889, 0.3322195591068374}}),
        .order = 4,
        .needs = GM_NEEDS_ROTATIONS,
        .claims = GM_KEEPS_CASIMIRS,
    },
};

const struct gm_family gm_family_rotations = {
    .kind = &gm_kind_ode,
    .title = "rotations",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .workspace_open = workspace_open,
    .workspace_close = free,
};
