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

enum { PHI, U, V, W, DIMENSION };

static void gradients(const void *parameters, const double *s, double *gradient, size_t count)
{
    const struct gm_kdv *kdv = parameters;
    for (size_t i = 0; i < count; i++) {
        gradient[PHI * count + i] = 0;
        gradient[U * count + i] = kdv->eta / 2 * s[U * count + i] * s[U * count + i] - s[W * count + i];
        gradient[V * count + i] = s[V * count + i] / kdv->mu;
        gradient[W * count + i] = -s[U * count + i];
    }
}

static void hessians(const void *parameters, const double *s, double *hessian, size_t count)
{
    const struct gm_kdv *kdv = parameters;
    memset(hessian, 0, sizeof(double[DIMENSION * DIMENSION]) * count);
    for (size_t i = 0; i < count; i++) {
        hessian[(U * DIMENSION + U) * count + i] = kdv->eta * s[U * count + i];
        hessian[(U * DIMENSION + W) * count + i] = hessian[(W * DIMENSION + U) * count + i] = -1;
        hessian[(V * DIMENSION + V) * count + i] = 1 / kdv->mu;
    }
}

static double potential(const struct gm_problem *problem, double re, double im)
{
    (void)im;
    return gm_kdv_of(problem)->eta * re * re * re / 6;
}

/* D_t A^3 u + D_x [A g + mu D^2 A_t u], g in the cells: the mass */
static void content(const struct gm_problem *problem, double dt, const double *means, const double *now,
                    const double *next, double *flux, double *residual)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx, eta = gm_kdv_of(problem)->eta, mu = gm_kdv_of(problem)->mu;
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

static const struct gm_form_potential slope_of_phi = {PHI, W};
static const struct gm_form form = {.dimension = DIMENSION,
                                    .m = m,
                                    .k = k,
                                    .first = U,
                                    .kept = 1,
                                    .gradients = gradients,
                                    .hessians = hessians,
                                    .potentials = &slope_of_phi,
                                    .potential_count = 1};
static const struct gm_dispersive dispersive = {.power = 3,
                                                .factor = {1, 0},
                                                .dispersion = dispersion,
                                                .derivative = true,
                                                .nonlinear = nonlinear,
                                                .potential = potential,
                                                .content = content};

const struct gm_problem gm_problem_kdv = {
    .name = "Korteweg-de Vries",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &form, .dispersive = &dispersive, .equation = GM_NEEDS_KDV},
    .m = 1,
    .bound = 1e3,
};
