/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Poisson maps that turn, for the bracket of angular momenta, {y_1, y_2} = -s y_3 and cyclic with s = +-1:
       y' = s y x grad H(y) = omega(y) x y,   omega = -s grad H
   Vectors are turned, so that their lengths, the Casimirs, stay at round-off, whatever H. exp(a) is the rotation by
   the vector a.

   rotations2: H = H_1(y_1) + H_2(y_2) + H_3(y_3), each of which turns about its axis at a constant rate,
       exp(h/2 omega_1 e_1) exp(h/2 omega_2 e_2) exp(h omega_3 e_3) exp(h/2 omega_2 e_2) exp(h/2 omega_1 e_1),
   a composition of Poisson maps. R.I. McLachlan, Phys. Rev. Lett. 71 (1993) 3043; S. Reich, Physica D 76 (1994)
   375. A heavy top has besides a vector z that it turns, the vertical seen from the body, and a potential:
       y' = s (y x grad T(y) + z x grad V(z)),   z' = s z x grad T(y)
   The rotations turn z as well, between two halves of the potential's exact flow, y := y + h/2 s z x grad V(z).
   A. Dullweber, B. Leimkuhler & R. McLachlan, J. Chem. Phys. 107 (1997) 5840.
   spherical-midpoint2:  y_1 = y_0 + h omega(z) x z,   z = |y_0| (y_0 + y_1) / |y_0 + y_1|,
   for each of several vectors, which turn one another. R.I. McLachlan, K. Modin & O. Verdier, Phys. Rev. E 89 (2014)
   061301; Math. Comp. 86 (2017) 2325. */
#include "core/ode/families/family.h"
#include "core/ode/families/poisson/turns.h"

enum { MOST = 6 };

/* The flow of the potential: y := y + h s z x grad V(z) */
static void pull(const struct gm_problem *problem, double h, double *y, struct gm_progress *progress)
{
    double k[MOST], moment[3];
    if (problem->n > 3) {
        gm_angular_velocity(problem, h, y, k, progress);
        gm_cross(k + 3, y + 3, moment);
        for (int i = 0; i < 3; i++) {
            y[i] += moment[i];
        }
    }
}

static enum gm_status about_axes(const struct gm_task *task, struct gm_members *members,
                                 struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    const double h = task->dt;
    static const int axes[] = {0, 1, 2, 1, 0};
    double *y = members->y;
    pull(problem, h / 2, y, progress);
    for (size_t i = 0; i < GM_COUNT(axes); i++) {
        double k[MOST], about[3] = {0};
        gm_angular_velocity(problem, i == 2 ? h : h / 2, y, k, progress);
        about[axes[i]] = k[axes[i]];
        for (size_t vector = 0; vector < problem->n; vector += 3) {
            gm_turn(1, about, y + vector);
        }
    }
    pull(problem, h / 2, y, progress);
    return GM_OK;
}

/* z of vector number i, where y_1 = y_0 + push; its length is that of y */
static void place(const double *y, const double *push, size_t i, size_t spins, double *z, double *radius)
{
    double before[3], pushed[3], length = 0;
    gm_vector_take(y, i, spins, before);
    gm_vector_take(push, i, spins, pushed);
    *radius = sqrt(before[0] * before[0] + before[1] * before[1] + before[2] * before[2]);
    for (int c = 0; c < 3; c++) {
        z[c] = before[c] + (before[c] + pushed[c]);
        length += z[c] * z[c];
    }
    const double factor = *radius > 0 ? *radius / sqrt(length) : 0;
    for (int c = 0; c < 3; c++) {
        z[c] *= factor;
    }
}

/* A step of the spherical midpoint rule. The scratch is z and omega. */
struct turn {
    const struct gm_problem *problem;
    double h;
    const struct gm_members *members;
    struct gm_progress *progress;
};

/* next := h omega(z) x z */
static bool sweep(void *data, const double *push, double *next, double *scale)
{
    const struct turn *turn = data;
    const size_t n = turn->problem->n, spins = gm_ode_of(turn->problem)->poisson->spins;
    double *z = turn->members->scratch, *k = z + n;
    for (size_t i = 0; i < spins; i++) {
        double vector[3], radius;
        place(turn->members->y, push, i, spins, vector, &radius);
        gm_vector_put(z, i, spins, vector);
        *scale += radius;
    }
    gm_angular_velocity(turn->problem, turn->h, z, k, turn->progress);
    for (size_t i = 0; i < spins; i++) {
        double omega[3], vector[3], turned[3];
        gm_vector_take(k, i, spins, omega);
        gm_vector_take(z, i, spins, vector);
        gm_cross(omega, vector, turned);
        gm_vector_put(next, i, spins, turned);
    }
    return true;
}

static enum gm_status spherical_midpoint(const struct gm_task *task, struct gm_members *members,
                                         struct gm_progress *progress)
{
    const size_t n = members->n;
    double *push = members->scratch + 2 * n, *next = push + n;
    struct turn turn = {task->problem, task->dt, members, progress};
    const struct gm_implicit_equations equations = {
        .sweep = sweep, .size = n, .data = &turn, .roundoff = 12e-16};
    memset(push, 0, n * sizeof *push);
    if (!gm_sweeps_solve(&equations, next, push, progress)) {
        return GM_NO_CONVERGENCE;
    }
    for (size_t c = 0; c < n; c++) {
        members->y[c] += push[c];
    }
    return GM_OK;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    gm_member_step *const *row = task->scheme->coefficients;
    return (*row)(task, members, progress);
}

static gm_member_step *const by_axes = about_axes, *const on_spheres = spherical_midpoint;

const struct gm_family gm_family_rotations = {
    .title = "rotations",
    GM_MEMBERS(rotations, .step = step, .vectors = 4),
};
