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

enum { P, Q, V, W, DIMENSION };

static void hessians(const void *parameters, const double *s, double *hessian, size_t count)
{
    const double factor = ((const struct gm_nls *)parameters)->k;
    memset(hessian, 0, sizeof(double[DIMENSION * DIMENSION]) * count);
    for (size_t i = 0; i < count; i++) {
        const double p = s[P * count + i], q = s[Q * count + i], square = factor * (2 * (p * p + q * q));
        hessian[(P * DIMENSION + P) * count + i] = square + factor * (p * p - q * q);
        hessian[(Q * DIMENSION + Q) * count + i] = square - factor * (p * p - q * q);
        hessian[(P * DIMENSION + Q) * count + i] = hessian[(Q * DIMENSION + P) * count + i] =
            factor * (2 * p * q);
        hessian[(V * DIMENSION + V) * count + i] = hessian[(W * DIMENSION + W) * count + i] = 1;
    }
}

static double potential(const struct gm_problem *problem, double re, double im)
{
    const double square = re * re + im * im;
    return gm_nls_of(problem)->k * (square * square / 4);
}

/* D_t |A_x psi|^2/2 + D_x Im[conj(A_t psi) (v + i w)]: the charge. At the sides v and w follow from cell to cell: D_x v =
   D_t A_x q - g_p, D_x w = -D_t A_x p - g_q, from A_x v = D_x A_t p and A_x w = D_x A_t q in the first one. */
static void content(const struct gm_problem *problem, double dt, const double *means, const double *now,
                    const double *next, double *flux, double *residual)
{
    (void)flux;
    const size_t points = problem->line.points;
    const double dx = problem->line.dx, factor = gm_nls_of(problem)->k;
    double left[DIMENSION], right[DIMENSION] = {(now[0] + next[0]) / 2, (now[points] + next[points]) / 2};
    for (size_t i = 0; i < points; i++) {
        const size_t r = i + 1 < points ? i + 1 : 0;
        const double square = means[i] * means[i] + means[points + i] * means[points + i];
        double charge = 0;
        for (size_t part = 0; part < 2; part++) {
            const double *from = now + part * points, *to = next + part * points,
                         *o = now + (1 - part) * points;
            const double lower = (from[i] + from[r]) / 2, upper = (to[i] + to[r]) / 2;
            const double turned =
                (next[(1 - part) * points + i] + next[(1 - part) * points + r] - o[i] - o[r]) / 2;
            const double bend = (part ? -turned : turned) / dt - factor * square * means[part * points + i];
            left[P + part] = right[P + part];
            right[P + part] = (from[r] + to[r]) / 2;
            left[V + part] =
                i > 0 ? right[V + part] : (right[P + part] - left[P + part]) / dx - dx / 2 * bend;
            right[V + part] = left[V + part] + dx * bend;
            charge += (upper - lower) * (upper + lower);
        }
        residual[i] =
            charge / (2 * dt) +
            (right[P] * right[W] - right[Q] * right[V] - left[P] * left[W] + left[Q] * left[V]) / dx;
    }
}

static const struct gm_form form = {
    .dimension = DIMENSION, .m = m, .k = k, .first = P, .kept = 2, .hessians = hessians};
static const struct gm_dispersive dispersive = {.power = 2,
                                                .factor = {0, 1},
                                                .dispersion = dispersion,
                                                .nonlinear = nonlinear,
                                                .potential = potential,
                                                .content = content};

const struct gm_problem gm_problem_nls = {
    .parameters = &(const struct gm_nls){.k = 1},
    .name = "nonlinear Schrödinger",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &form, .dispersive = &dispersive, .equation = GM_NEEDS_NLS},
    .m = 1,
    .bound = 1e3,
};
