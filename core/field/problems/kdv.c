/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Korteweg-de Vries equation u_t + eta u u_x + mu u_xxx = 0 in multisymplectic form, s = (phi, u, v, w):
        u_t/2   + w_x = 0
       -phi_t/2 - v_x = -w + eta u^2/2
        u_x           = v/mu
       -phi_x         = -u
       S = v^2/(2 mu) - u w + eta u^3/6
   U. Ascher & R.I. McLachlan, Appl. Numer. Math. 48 (2004) 255. The field u comes second. */
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/linear/ring/ring.h"

static const double m[16] = {0, 0.5, 0, 0, -0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const double k[16] = {0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, -1, 0, 0, 0};

static double dispersion(const struct gm_problem *problem)
{
    return gm_kdv_of(problem)->mu;
}

static void nonlinear(const struct gm_problem *problem, const double *re, const double *im, double *g_re,
                      double *g_im, size_t count)
{
    (void)im;
    const double half = gm_kdv_of(problem)->eta / 2;
    for (size_t i = 0; i < count; i++) {
        g_re[i] = half * re[i] * re[i];
        g_im[i] = 0;
    }
}

static void linearised(const struct gm_problem *problem, const double *base, const double *f, double *g,
                       size_t count)
{
    for (size_t i = 0; i < count; i++) {
        g[i] = gm_kdv_of(problem)->eta * base[i] * f[i];
        g[count + i] = 0;
    }
}

enum { PHI, U, V, W, DIMENSION };

/* The components of s that the scheme eliminated, each from one equation:
       phi   from D_x phi = A_x u, 0 at the first node of every level: its constant in x is free, and w goes
             with it
       v     from D_x u = A_x v / mu
       w     from D_t A_x u/2 + D_x w = 0, and from the mean over the ring of
                 -D_t phi/2 - D_x v = -A_x w + eta m u,
             which else is the scheme; its alternating part is the one of v on an even number of points
   Taking w from the last one would invert A_x twice and rounding with it. */
static void complete(const struct gm_problem *problem, double dt, const double *base, const double *now,
                     const double *next, struct gm_faces *faces)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx;
    double phi_now = 0, phi_next = 0;
    double *sides = faces->sides;
    for (size_t i = 0; i <= points; i++) {
        const size_t here = i < points ? i : 0, r = i + 1 < points ? i + 1 : 0;
        double *side = sides + i * DIMENSION;
        side[PHI] = (phi_now + phi_next) / 2;
        side[U] = (now[here] + next[here]) / 2;
        if (i < points) {
            double *lower = faces->lower + i * DIMENSION, *upper = faces->upper + i * DIMENSION;
            lower[U] = (now[here] + now[r]) / 2;
            upper[U] = (next[here] + next[r]) / 2;
            lower[PHI] = phi_now + dx / 2 * lower[U];
            upper[PHI] = phi_next + dx / 2 * upper[U];
            phi_now += dx * lower[U];
            phi_next += dx * upper[U];
        }
    }
    double *slope = faces->scratch, alternating = 0;
    for (size_t i = 0; i < points; i++) {
        const double u = (faces->lower[i * DIMENSION + U] + faces->upper[i * DIMENSION + U]) / 2;
        const double force = gm_kdv_of(problem)->eta * base[i] * u / (double)points;
        alternating += i % 2 ? -force : force;
        slope[i] = gm_kdv_of(problem)->mu * (sides[(i + 1) * DIMENSION + U] - sides[i * DIMENSION + U]) / dx;
    }
    gm_ring_unaverage(slope, points);
    for (size_t i = 0; points % 2 == 0 && i < points; i++) {
        const double free = dx / 2 * alternating;
        slope[i] += i % 2 ? -free : free;
    }
    for (size_t i = 0; i <= points; i++) {
        sides[i * DIMENSION + V] = slope[i < points ? i : 0];
    }
    double w = 0, mean = 0;
    for (size_t i = 0; i <= points; i++) {
        sides[i * DIMENSION + W] = w;
        if (i < points) {
            const double *lower = faces->lower + i * DIMENSION, *upper = faces->upper + i * DIMENSION;
            const double change = dx * (upper[U] - lower[U]) / (2 * dt);
            mean += (upper[PHI] - lower[PHI]) / (2 * dt) +
                    gm_kdv_of(problem)->eta * base[i] * (lower[U] + upper[U]) / 2 - (w - change / 2);
            w -= change;
        }
    }
    for (size_t i = 0; i <= points; i++) {
        sides[i * DIMENSION + W] += mean / (double)points;
    }
}

static double potential(const struct gm_problem *problem, double re, double im)
{
    (void)im;
    return gm_kdv_of(problem)->eta * re * re * re / 6;
}

/* D_t A^3 u + D_x [A g + mu D^2 A_t u], g in the cells: the mass */
static void content(const struct gm_problem *problem, double dt, double *means, const double *now,
                    const double *next, struct gm_faces *faces, double *residual)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx, eta = gm_kdv_of(problem)->eta, mu = gm_kdv_of(problem)->mu;
    double *flux = faces->scratch;
    for (size_t i = 0; i < points; i++) {
        const size_t r = (i + 1) % points, r2 = (i + 2) % points;
        const double bend = (now[r2] + next[r2] - 2 * (now[r] + next[r]) + now[i] + next[i]) / 2;
        flux[i] = eta / 4 * (means[i] * means[i] + means[r] * means[r]) + mu * bend / (dx * dx);
    }
    for (size_t i = 0; i < points; i++) {
        const size_t r = (i + 1) % points, r2 = (i + 2) % points, r3 = (i + 3) % points;
        const double change =
            next[i] - now[i] + 3 * (next[r] - now[r] + next[r2] - now[r2]) + next[r3] - now[r3];
        residual[i] = change / (8 * dt) + (flux[r] - flux[i]) / dx;
    }
}

static const struct gm_form form = {.dimension = 4, .m = m, .k = k};
static const struct gm_dispersive dispersive = {.power = 3,
                                                .factor = {1, 0},
                                                .dispersion = dispersion,
                                                .derivative = true,
                                                .nonlinear = nonlinear,
                                                .linearised = linearised,
                                                .potential = potential,
                                                .content = content,
                                                .complete = complete};

const struct gm_problem gm_problem_kdv = {
    .name = "Korteweg-de Vries",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &form, .dispersive = &dispersive, .equation = GM_NEEDS_KDV},
    .m = 1,
    .bound = 1e3,
};
