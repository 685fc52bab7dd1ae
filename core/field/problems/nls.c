/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nonlinear Schroedinger equation i psi_t + psi_xx + k |psi|^2 psi = 0 in multisymplectic form,
   psi = p + i q, s = (p, q, v, w):
        q_t - v_x = k |psi|^2 p
       -p_t - w_x = k |psi|^2 q
        p_x       = v
        q_x       = w
       S = k (p^2 + q^2)^2/4 + (v^2 + w^2)/2
   A.L. Islas, D.A. Karpeev & C.M. Schober, J. Comput. Phys. 173 (2001) 116. (S as printed in Razafindralandy
   et al. (2018) is another one.) */
#include <math.h>

#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"
#include "core/linear/ring/ring.h"

static const double m[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const double k[16] = {0, 0, -1, 0, 0, 0, 0, -1, 1, 0, 0, 0, 0, 1, 0, 0};

static double dispersion(const struct gm_problem *problem)
{
    return (void)problem, 1;
}

static void nonlinear(const struct gm_problem *problem, const double *re, const double *im, double *g_re,
                      double *g_im, size_t count)
{
    const double factor = gm_nls_of(problem)->k;
    for (size_t i = 0; i < count; i++) {
        const double square = factor * (re[i] * re[i] + im[i] * im[i]);
        g_re[i] = square * re[i];
        g_im[i] = square * im[i];
    }
}

/* k (2 |m|^2 f + m^2 conj f) */
static void linearised(const struct gm_problem *problem, const double *base, const double *f, double *g,
                       size_t count)
{
    const double factor = gm_nls_of(problem)->k;
    for (size_t i = 0; i < count; i++) {
        const double re = base[i], im = base[count + i], f_re = f[i], f_im = f[count + i];
        const double square = factor * (2 * (re * re + im * im)), twice_re = factor * (re * re - im * im),
                     twice_im = factor * (2 * re * im);
        g[i] = square * f_re + twice_re * f_re + twice_im * f_im;
        g[count + i] = square * f_im + twice_im * f_re - twice_re * f_im;
    }
}

enum { P, Q, V, W, DIMENSION };

/* A_x v = D_x p and A_x w = D_x q at the sides; the other two equations are the scheme, but that on an even
   number of points their alternating parts, of -D_x v and -D_x w and the force, are that of v and w. */
static void complete(const struct gm_problem *problem, double dt, const double *base, const double *now,
                     const double *next, struct gm_faces *faces)
{
    (void)dt;
    const size_t points = problem->line.points;
    double alternating[2] = {0};
    for (size_t i = 0; points % 2 == 0 && i < points; i++) {
        const size_t r = i + 1 < points ? i + 1 : 0;
        const double at[2] = {base[i], base[points + i]};
        const double mean[2] = {(now[i] + now[r] + next[i] + next[r]) / 4,
                                (now[points + i] + now[points + r] + next[points + i] + next[points + r]) /
                                    4};
        double force[2];
        linearised(problem, at, mean, force, 1);
        for (size_t part = 0; part < 2; part++) {
            alternating[part] += (i % 2 ? -force[part] : force[part]) / (double)points;
        }
    }
    for (size_t part = 0; part < 2; part++) {
        const double *f = now + part * points, *g = next + part * points;
        double *slope = faces->scratch;
        for (size_t i = 0; i < points; i++) {
            const size_t r = i + 1 < points ? i + 1 : 0;
            faces->lower[i * DIMENSION + P + part] = (f[i] + f[r]) / 2;
            faces->upper[i * DIMENSION + P + part] = (g[i] + g[r]) / 2;
            slope[i] = (f[r] + g[r] - f[i] - g[i]) / (2 * problem->line.dx);
        }
        gm_ring_unaverage(slope, points);
        for (size_t i = 0; i <= points; i++) {
            const size_t at = i < points ? i : 0;
            faces->sides[i * DIMENSION + P + part] = (f[at] + g[at]) / 2;
            const double free = problem->line.dx / 2 * alternating[part];
            faces->sides[i * DIMENSION + V + part] = slope[at] + (at % 2 ? -free : free);
        }
    }
}

static double potential(const struct gm_problem *problem, double re, double im)
{
    const double square = re * re + im * im;
    return gm_nls_of(problem)->k * (square * square / 4);
}

/* D_t |A_x psi|^2/2 + D_x Im[conj(A_t psi) (v + i w)]: the charge. g is of degree 3: it is the derivative
   of g at m/sqrt 3 applied to m, so that the solution itself can be completed as a tangent. */
static void content(const struct gm_problem *problem, double dt, double *means, const double *now,
                    const double *next, struct gm_faces *faces, double *residual)
{
    const size_t points = problem->line.points;
    for (size_t i = 0; i < 2 * points; i++) {
        means[i] /= sqrt(3);
    }
    complete(problem, dt, means, now, next, faces);
    for (size_t i = 0; i < points; i++) {
        const double *lower = faces->lower + i * DIMENSION, *upper = faces->upper + i * DIMENSION;
        const double *left = faces->sides + i * DIMENSION, *right = left + DIMENSION;
        const double change =
            (upper[P] - lower[P]) * (upper[P] + lower[P]) + (upper[Q] - lower[Q]) * (upper[Q] + lower[Q]);
        residual[i] = change / (2 * dt) +
                      (right[P] * right[W] - right[Q] * right[V] - left[P] * left[W] + left[Q] * left[V]) /
                          problem->line.dx;
    }
}

static const struct gm_form form = {.dimension = 4, .m = m, .k = k};
static const struct gm_dispersive dispersive = {.power = 2,
                                                .factor = {0, 1},
                                                .dispersion = dispersion,
                                                .complex_valued = true,
                                                .nonlinear = nonlinear,
                                                .linearised = linearised,
                                                .potential = potential,
                                                .content = content,
                                                .complete = complete};

const struct gm_problem gm_problem_nls = {
    .parameters = &(const struct gm_nls){.k = 1},
    .name = "nonlinear Schrödinger",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &form, .dispersive = &dispersive, .equation = GM_NEEDS_NLS},
    .m = 1,
    .bound = 1e3,
};
