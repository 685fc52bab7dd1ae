/* SPDX-License-Identifier: GPL-3.0-or-later */
/* psi = p + i q, s = (p, q, v, w):  q_t - v_x = |psi|^2 p,  -p_t - w_x = |psi|^2 q,  p_x = v,  q_x = w,
   S = (p^2 + q^2)^2/4 + (v^2 + w^2)/2.   Islas, Karpeev & Schober, J. Comput. Phys. 173 (2001) 116. */
#include <math.h>

#include "core/problems/dispersive.h"

static const double m[16] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const double k[16] = {0, 0, -1, 0, 0, 0, 0, -1, 1, 0, 0, 0, 0, 1, 0, 0};

static void gradient(const void *parameters, const double *s, double *gradient)
{
    (void)parameters;
    const double square = s[0] * s[0] + s[1] * s[1];
    gradient[0] = square * s[0];
    gradient[1] = square * s[1];
    gradient[2] = s[2];
    gradient[3] = s[3];
}

static double dispersion(const struct gm_problem *problem)
{
    return (void)problem, 1;
}

static void nonlinear(const struct gm_problem *problem, const double *re, const double *im, double *g_re,
                      double *g_im, size_t count)
{
    (void)problem;
    for (size_t i = 0; i < count; i++) {
        const double square = re[i] * re[i] + im[i] * im[i];
        g_re[i] = square * re[i];
        g_im[i] = square * im[i];
    }
}

/* Adds one soliton; on the ring its phase follows it. */
static void add_soliton(const struct gm_nls *nls, const struct gm_line *line, double c, double x0, double x,
                        double t, double *re, double *im)
{
    const double period = line->dx * (double)line->points, a = nls->amplitude;
    double away = x - x0 - c * t;
    away -= period * floor(away / period + 0.5);
    const double size = sqrt(2) * a / cosh(a * away), phase = c * away / 2 + (a * a + c * c / 4) * t;
    *re += size * cos(phase);
    *im += size * sin(phase);
}

void gm_nls_exact(const struct gm_nls *nls, const struct gm_line *line, double x, double t, double *re,
                  double *im)
{
    *re = *im = nls->initial == GM_NLS_COLLISION && t != 0 ? NAN : 0;
    add_soliton(nls, line, nls->velocity, nls->position, x, t, re, im);
    if (nls->initial == GM_NLS_COLLISION) {
        add_soliton(nls, line, -nls->velocity, -nls->position, x, t, re, im);
    }
}

double gm_nls_charge(const struct gm_problem *problem, const double *y)
{
    const size_t points = problem->line.points;
    double sum = 0;
    for (size_t i = 0; i < points; i++) {
        const size_t right = i + 1 < points ? i + 1 : 0;
        const double re = (y[i] + y[right]) / 2, im = (y[points + i] + y[points + right]) / 2;
        sum += re * re + im * im;
    }
    return problem->line.dx * sum;
}

double gm_nls_energy(const struct gm_problem *problem, const double *y)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx;
    double sum = 0;
    for (size_t i = 0; i < points; i++) {
        const size_t right = i + 1 < points ? i + 1 : 0;
        const double re = (y[i] + y[right]) / 2, im = (y[points + i] + y[points + right]) / 2;
        const double re_slope = (y[right] - y[i]) / dx, im_slope = (y[points + right] - y[points + i]) / dx;
        const double square = re * re + im * im;
        sum += re_slope * re_slope + im_slope * im_slope - square * square / 2;
    }
    return dx * sum;
}

double gm_nls_node_charge(const struct gm_problem *problem, const double *y)
{
    double sum = 0;
    for (size_t i = 0; i < 2 * problem->line.points; i++) {
        sum += y[i] * y[i];
    }
    return problem->line.dx * sum;
}

static const struct gm_field field = {4, m, k, gradient};
static const struct gm_dispersive dispersive = {
    .power = 2, .factor = {0, 1}, .dispersion = dispersion, .complex_valued = true, .nonlinear = nonlinear};

const struct gm_problem gm_problem_nls = {
    .name = "nonlinear Schrödinger", .m = 1, .bound = 1e3, .field = &field, .dispersive = &dispersive};
