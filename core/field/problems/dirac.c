/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nonlinear Dirac equation with scalar self-interaction, psi_1 = a + i b, psi_2 = c + i d,
       psi_1,t + psi_2,x = -i (m - 2 lambda N) psi_1
       psi_2,t + psi_1,x =  i (m - 2 lambda N) psi_2,   N = |psi_1|^2 - |psi_2|^2
   in multisymplectic form, s = (a, b, c, d):
       -b_t - d_x = S_a     a_t + c_x = S_b     -d_t - b_x = S_c     c_t + a_x = S_d
       S = m N/2 - lambda N^2/2
   M. Soler, Phys. Rev. D 1 (1970) 2766; J. Hong & C. Li, J. Comput. Phys. 211 (2006) 448. Its standing wave, with
   k = sqrt(m^2 - w^2), h = m + w cosh(2 k x),
       psi_1 = sqrt((m + w)/lambda) k cosh(k x)/h exp(-i w t),
       psi_2 = i sqrt((m - w)/lambda) k sinh(k x)/h exp(-i w t)
   S.Y. Lee, T.K. Kuo & A. Gavrielides, Phys. Rev. D 12 (1975) 2249. */
#include "core/field/problems/dirac.h"

#include <math.h>

enum { A, B, C, D, DIMENSION };

static const double m[16] = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0};
static const double k[16] = {0, 0, 0, -1, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 0};

static double difference(const double *s, size_t apart)
{
    return s[A * apart] * s[A * apart] + s[B * apart] * s[B * apart] - s[C * apart] * s[C * apart] -
           s[D * apart] * s[D * apart];
}

static double function(const void *parameters, const double *s)
{
    const struct gm_dirac *dirac = parameters;
    const double n = difference(s, 1);
    return (dirac->mass - dirac->coupling * n) * n / 2;
}

static void gradients(const void *parameters, const double *s, double *gradient, size_t count)
{
    const struct gm_dirac *dirac = parameters;
    for (size_t i = 0; i < count; i++) {
        const double force = dirac->mass - 2 * dirac->coupling * difference(s + i, count);
        for (size_t c = 0; c < DIMENSION; c++) {
            gradient[c * count + i] = (c < C ? force : -force) * s[c * count + i];
        }
    }
}

static void hessians(const void *parameters, const double *s, double *hessian, size_t count)
{
    const struct gm_dirac *dirac = parameters;
    for (size_t i = 0; i < count; i++) {
        const double force = dirac->mass - 2 * dirac->coupling * difference(s + i, count);
        for (size_t r = 0; r < DIMENSION; r++) {
            for (size_t c = 0; c < DIMENSION; c++) {
                const double of_n = (r < C ? 1 : -1) * (c < C ? 1 : -1) * s[r * count + i] * s[c * count + i];
                hessian[(r * DIMENSION + c) * count + i] =
                    (r == c ? (r < C ? force : -force) : 0) - 4 * dirac->coupling * of_n;
            }
        }
    }
}

void gm_dirac_exact(const struct gm_dirac *dirac, double x, double t, double *s)
{
    const double w = dirac->frequency, rate = sqrt((dirac->mass - w) * (dirac->mass + w));
    const double over = 1 / (dirac->mass + w * cosh(2 * rate * x));
    const double first = sqrt((dirac->mass + w) / dirac->coupling) * rate * cosh(rate * x) * over;
    const double second = sqrt((dirac->mass - w) / dirac->coupling) * rate * sinh(rate * x) * over;
    s[A] = first * cos(w * t);
    s[B] = -first * sin(w * t);
    s[C] = second * sin(w * t);
    s[D] = second * cos(w * t);
}

static const char *const names[] = {"psi1_re", "psi1_im", "psi2_re", "psi2_im"};

static const struct gm_form form = {.names = names,
                                    .dimension = DIMENSION,
                                    .m = m,
                                    .k = k,
                                    .function = function,
                                    .gradients = gradients,
                                    .hessians = hessians};

const struct gm_problem gm_problem_dirac = {
    .name = "nonlinear Dirac",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &form},
    .m = 1,
    .bound = 1e3,
};
