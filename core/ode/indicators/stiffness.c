/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/indicators/stiffness.h"

#include <math.h>
#include <stdlib.h>

#include "core/linear/eigenvalues.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/run.h"
#include "core/schemes.h"

/* Returns max(-Re eig J) at a state, at least 0. */
static double decay_at(const struct gm_problem *problem, const double *y, double *matrix)
{
    const size_t n = problem->n;
    double *re = matrix + n * n, fastest = 0;
    const bool known = gm_jacobian(problem, y, matrix) && gm_eigenvalues(matrix, n, re, re + n);
    for (size_t i = 0; known && i < n; i++) {
        fastest = fmax(fastest, -re[i]);
    }
    return fastest;
}

struct gm_stiffness gm_stiffness_of(const struct gm_problem *problem, const double *y0, double until)
{
    enum { POINTS = 4, PART = 100 };
    const size_t n = problem->n;
    const struct gm_settings settings = {0};
    const struct gm_scheme *scheme = gm_scheme_find("gsl-msbdf");
    struct gm_problem between = *problem;
    between.events = NULL;
    const bool fits = gm_matrix_size(problem) > 0 && gm_scheme_fits(scheme, &between);
    double *matrix = fits ? calloc(n * n + 4 * n, sizeof *matrix) : NULL;
    struct gm_run *run =
        matrix && until > 0 ? gm_run_open(&between, scheme, &settings, 0, until / PART / POINTS, y0) : NULL;
    if (!run) {
        free(matrix);
        return (struct gm_stiffness){0};
    }
    double *sizes = matrix + n * n + 2 * n, *rates = sizes + n, scale = 0;
    double fast = decay_at(problem, y0, matrix), slow = 0;
    for (int i = 0; i < POINTS && gm_run_advance(run, 1) == GM_OK; i++) {
        const double *y = gm_run_state(run);
        fast = fmax(fast, decay_at(problem, y, matrix));
        for (size_t c = 0; c < n; c++) {
            scale = fmax(scale, fmax(fabs(y0[c]), fabs(y[c])));
            sizes[c] = i == 0 ? fabs(y[c]) : sizes[c];
        }
        if (i == 0) {
            gm_field(problem, y, rates, 1);
        }
    }
    for (size_t c = 0; c < n && scale > 0; c++) {
        slow = fmax(slow, fabs(rates[c]) / (sizes[c] + scale));
    }
    const struct gm_stiffness stiffness = {run->status == GM_OK && fast > 1e3 * slow && fast * until > 1e4,
                                           slow, fast};
    gm_run_close(run);
    free(matrix);
    return stiffness;
}
