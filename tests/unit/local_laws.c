/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The local laws of energy and momentum that the box for Korteweg-de Vries and Schroedinger tells of, against
   densities and fluxes of all its variables, which are found here from its equations. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/field/families/laws/laws.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/dispersive_solitons.h"

enum { POINTS = 151, LAWS = 3 };

static const struct gm_settings no_settings;

/* What both levels say: means over a cell in space, differences of those in time, at nodes the means in time
   and their differences. */
struct levels {
    double dt, dx;
    const double *now, *next; /* POINTS */
};

static size_t behind(size_t i)
{
    return (i + 1) % POINTS;
}
static double at_side(const struct levels *f, size_t i)
{
    return (f->now[i % POINTS] + f->next[i % POINTS]) / 2;
}
static double rate(const struct levels *f, size_t i)
{
    return (f->next[i % POINTS] - f->now[i % POINTS]) / f->dt;
}
static double face(const double *u, size_t i)
{
    return (u[i] + u[behind(i)]) / 2;
}
static double slope(const struct levels *f, const double *u, size_t i)
{
    return (u[behind(i)] - u[i]) / f->dx;
}

/* w with A_x w = D_x A_t f around a ring of odd length */
static void sides(const struct levels *f, double factor, double *w)
{
    double sum = 0;
    for (size_t i = 0; i < POINTS; i++) {
        const double s = factor * (at_side(f, i + 1) - at_side(f, i)) / f->dx;
        sum += i % 2 ? -s : s;
    }
    w[0] = sum;
    for (size_t i = 0; i < POINTS; i++) {
        const double s = factor * (at_side(f, i + 1) - at_side(f, i)) / f->dx;
        const double next = 2 * s - w[i];
        if (i + 1 < POINTS) {
            w[i + 1] = next;
        } else {
            assert_true(fabs(next - w[0]) < 1e-10);
        }
    }
    w[POINTS] = w[0];
}

/* The laws of a cell, and by how much its equations fail. */
static double kdv_laws(const struct levels *u, double *laws[LAWS])
{
    const double eta = 1.5, mu = 0.8, dt = u->dt, dx = u->dx;
    double v[POINTS + 1], w[POINTS + 1], phi_t[POINTS + 1], worst = 0;
    sides(u, mu, v);
    w[0] = phi_t[0] = 0;
    for (size_t i = 0; i < POINTS; i++) {
        const double change = (face(u->next, i) - face(u->now, i)) / dt;
        w[i + 1] = w[i] - dx * change / 2;
        phi_t[i + 1] = phi_t[i] + dx * change;
    }
    /* the constant of w from the second equation in the first cell; the others have to hold with it */
    double constant = 0;
    for (size_t i = 0; i < POINTS; i++) {
        const double mean = (at_side(u, i) + at_side(u, i + 1)) / 2;
        const double left = -(phi_t[i] + phi_t[i + 1]) / 4 - (v[i + 1] - v[i]) / dx;
        const double needed = eta * mean * mean / 2 - left - (w[i] + w[i + 1]) / 2;
        constant = i == 0 ? needed : constant;
        worst = fmax(worst, fabs(needed - constant));
    }
    for (size_t i = 0; i < POINTS; i++) {
        double density[2][2], flux[2][2];
        for (size_t level = 0; level < 2; level++) {
            const double *f = level ? u->next : u->now, a = face(f, i), s = slope(u, f, i);
            const size_t node = i + level;
            const double here = at_side(u, node), ww = w[node] + constant;
            density[0][level] = mu * s * s / 2 - eta * a * a * a / 6;
            density[1][level] = a * a / 2;
            flux[0][level] = ww * phi_t[node] - v[node] * rate(u, node);
            flux[1][level] = here * ww - eta * here * here * here / 6 - v[node] * v[node] / (2 * mu) -
                             here * phi_t[node] / 2;
        }
        for (size_t law = 0; law < 2; law++) {
            laws[law][i] = (density[law][1] - density[law][0]) / dt + (flux[law][1] - flux[law][0]) / dx;
        }
    }
    return worst;
}

static double nls_laws(const struct levels *p, const struct levels *q, double *laws[LAWS])
{
    const double dt = p->dt, dx = p->dx;
    double v[POINTS + 1], w[POINTS + 1], worst = 0;
    sides(p, 1, v);
    sides(q, 1, w);
    for (size_t i = 0; i < POINTS; i++) {
        const double re = (at_side(p, i) + at_side(p, i + 1)) / 2,
                     im = (at_side(q, i) + at_side(q, i + 1)) / 2, square = re * re + im * im;
        worst = fmax(worst,
                     fabs((face(q->next, i) - face(q->now, i)) / dt - (v[i + 1] - v[i]) / dx - square * re));
        worst = fmax(worst,
                     fabs(-(face(p->next, i) - face(p->now, i)) / dt - (w[i + 1] - w[i]) / dx - square * im));
        double density[LAWS][2], flux[LAWS][2];
        for (size_t level = 0; level < 2; level++) {
            const double *f = level ? p->next : p->now, *g = level ? q->next : q->now;
            const double a = face(f, i), b = face(g, i), s = slope(p, f, i), r = slope(q, g, i);
            const size_t n = i + level;
            const double x = at_side(p, n), y = at_side(q, n), on_face = a * a + b * b,
                         on_side = x * x + y * y;
            density[0][level] = (s * s + r * r) / 2 - on_face * on_face / 4;
            flux[0][level] = -rate(p, n) * v[n] - rate(q, n) * w[n];
            density[1][level] = -a * r;
            flux[1][level] = x * rate(q, n) - on_side * on_side / 4 - (v[n] * v[n] + w[n] * w[n]) / 2;
            density[2][level] = on_face / 2;
            flux[2][level] = x * w[n] - y * v[n];
        }
        for (size_t law = 0; law < LAWS; law++) {
            laws[law][i] = (density[law][1] - density[law][0]) / dt + (flux[law][1] - flux[law][0]) / dx;
        }
    }
    return worst;
}

/* The laws as told, for the step from the state on, and as found here: of opposite sign. */
static void expect_laws(struct gm_run *run, bool complex_valued)
{
    double now[2 * POINTS + 1], found[LAWS][POINTS], told[POINTS], law_largest = 0;
    double *const laws[LAWS] = {found[0], found[1], found[2]};
    memcpy(now, gm_run_state(run), run->problem->n * sizeof *now);
    double of_step[LAWS][POINTS];
    for (int law = 0; law < LAWS; law++) {
        assert_true(
            gm_local_laws(run->problem, run->scheme, run->dt, now, (enum gm_local_law)law, of_step[law]));
    }
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    const double *next = gm_run_state(run), dx = run->problem->line.dx;
    const struct levels first = {run->dt, dx, now, next}, second = {run->dt, dx, now + POINTS, next + POINTS};
    const double equations =
        complex_valued ? nls_laws(&first, &second, (double **)laws) : kdv_laws(&first, (double **)laws);
    assert_true(equations < 1e-9);
    for (int law = 0; law < (complex_valued ? LAWS : 2); law++) {
        memcpy(told, of_step[law], sizeof told);
        for (size_t i = 0; i < POINTS; i++) {
            const double sum = law == GM_LAW_OF_CONTENT ? told[i] - found[law][i] : told[i] + found[law][i];
            law_largest = fmax(law_largest, law == GM_LAW_OF_CONTENT ? 0 : fabs(told[i]));
            if (!(fabs(sum) < 2e-10)) {
                fail_msg("law %d in cell %zu: told %.9g, found %.9g", law, i, told[i], found[law][i]);
            }
        }
    }
    assert_true(law_largest > 1e-4);
}

static void kdv_tells_its_laws(void **unused)
{
    (void)unused;
    static const struct kdv_solution other = {
        .initial = KDV_SOLITON, .kdv.eta = 1.5, .kdv.mu = 0.8, .velocity = 1};
    double y[2 * POINTS + 1];
    struct gm_problem problem = gm_problem_kdv;
    problem.parameters = &other;
    problem.line = (struct gm_grid1){POINTS, 40.0 / POINTS, -20, 0, false};
    problem.n = gm_wave_size(POINTS);
    kdv_levels(&problem, 0.1, y);
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, 0.1, y);
    assert_non_null(run);
    for (int k = 0; k < 10; k++) {
        expect_laws(run, false);
    }
    gm_run_close(run);
}

static void nls_tells_its_laws(void **unused)
{
    (void)unused;
    static const struct bright pair = {.amplitude = 1, .velocity = 1, .position = -2, .collides = true};
    double y[2 * POINTS];
    struct gm_problem problem = gm_problem_nls;
    problem.line = (struct gm_grid1){POINTS, 30.0 / POINTS, -15, 0, false};
    problem.n = 2 * POINTS;
    bright_state(&pair, &problem.line, 0, y);
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("box"), &no_settings, 0, 0.02, y);
    assert_non_null(run);
    for (int k = 0; k < 10; k++) {
        expect_laws(run, true);
    }
    gm_run_close(run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kdv_tells_its_laws),
        cmocka_unit_test(nls_tells_its_laws),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
