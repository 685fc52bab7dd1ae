/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kepler's motion against its closed forms, and the parts of the gravity of bodies in Jacobi coordinates against Newton's
   law. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/ode/families/splitting/jacobi.h"
#include "core/ode/families/splitting/kepler.h"

/* a place and a velocity in the plane of the orbit, at a time */
struct at {
    double t, q[2], v[2];
};

/* At the eccentric anomaly E, with more digits than those of the result, of an ellipse, or of a hyperbola, with the least distance 1 */
static struct at on_conic(long double mu, long double e, long double E)
{
    const bool open = e > 1;
    const long double a = 1 / fabsl(1 - e), n = sqrtl(mu / (a * a * a)), c = open ? coshl(E) : cosl(E),
                      s = open ? sinhl(E) : sinl(E), b = a * sqrtl(fabsl(1 - e) * (1 + e)),
                      sign = open ? -1 : 1, rate = n / (sign * (1 - e * c)); /* dE/dt */
    return (struct at){(double)(sign * (E - e * s) / n),
                       {(double)(sign * a * (c - e)), (double)(b * s)},
                       {(double)(-a * s * rate), (double)(b * c * rate)}};
}

/* Barker's equation: at D = tan(half of the true anomaly), with the least distance 1 */
static struct at on_parabola(double mu, double D)
{
    const double rate = sqrt(mu / 2) / (1 + D * D); /* dD/dt */
    return (struct at){sqrt(2 / mu) * (D + D * D * D / 3), {1 - D * D, 2 * D}, {-2 * D * rate, 2 * rate}};
}

/* A rounding of the energy moves the time by as much of the whole. */
static double rounding_of(double mu, struct at from, struct at to)
{
    const double r = hypot(from.q[0], from.q[1]), v = hypot(from.v[0], from.v[1]);
    const double far = hypot(to.q[0], to.q[1]), fast = hypot(to.v[0], to.v[1]);
    return 4e-15 * (2 * mu / r + v * v) / fabs(2 * mu / r - v * v) * fabs(to.t - from.t) *
               (fast / far + mu / (far * far * fast)) +
           1e-15 * v / fast;
}

static void expect_motion(double mu, double turns, struct at from, struct at to, double tolerance)
{
    /* an orthonormal pair in space */
    static const double along[] = {2. / 3, -1. / 3, 2. / 3}, across[] = {1. / 3, -2. / 3, -2. / 3};
    const double h = to.t - from.t + turns;
    double q[3], v[3], plane[4] = {from.q[0], from.q[1], from.v[0], from.v[1]};
    for (size_t c = 0; c < 3; c++) {
        q[c] = from.q[0] * along[c] + from.q[1] * across[c];
        v[c] = from.v[0] * along[c] + from.v[1] * across[c];
    }
    assert_true(gm_kepler_flow(3, mu, h, q, v) && gm_kepler_flow(2, mu, h, plane, plane + 2));
    const double far = hypot(to.q[0], to.q[1]), fast = hypot(to.v[0], to.v[1]);
    for (size_t c = 0; c < 3; c++) {
        const double wrong = fabs(q[c] - to.q[0] * along[c] - to.q[1] * across[c]) / far +
                             fabs(v[c] - to.v[0] * along[c] - to.v[1] * across[c]) / fast;
        if (!(wrong <= tolerance)) {
            fail_msg("off by %.2g, not %.2g, in the time %.17g from %g %g to %g %g", wrong, tolerance, h,
                     from.q[0], from.q[1], to.q[0], to.q[1]);
        }
    }
    assert_true(fabs(plane[0] - to.q[0]) + fabs(plane[1] - to.q[1]) <= 2 * tolerance * far);
}

static void orbits_are_closed_forms(void **unused)
{
    (void)unused;
    static const double shapes[] = {0, 1e-3, 0.2, 0.9, 0.999, 1.001, 1.2, 3, 40},
                        ends[] = {-3, -0.7, 0, 0.1, 2.5};
    for (size_t i = 0; i < GM_COUNT(shapes); i++) {
        for (size_t k = 0; k < GM_COUNT(ends) * GM_COUNT(ends); k++) {
            const double mu = 0.3 + 2 * (double)(k % 3), e = shapes[i];
            const struct at from = on_conic(mu, e, ends[k % GM_COUNT(ends)]),
                            to = on_conic(mu, e, ends[k / GM_COUNT(ends)]);
            expect_motion(mu, 0, from, to, 3e-13 + rounding_of(mu, from, to));
            expect_motion(mu, 0, on_parabola(mu, ends[k % GM_COUNT(ends)]),
                          on_parabola(mu, ends[k / GM_COUNT(ends)]), 1e-13);
        }
    }
}

/* A rounding of the energy moves the phase by as much of the whole angle. */
static void revolutions_lead_back(void **unused)
{
    (void)unused;
    for (double turns = -1e6; turns <= 1e6; turns += 4e5) {
        const double period = 2 * M_PI / pow(1 - 0.4, -1.5) * pow(1 - 0.4, -3);
        expect_motion(1, turns * period, on_conic(1, 0.4, 0.3), on_conic(1, 0.4, 1.9),
                      2e-14 + 2e-14 * fabs(turns));
    }
}

static void no_motion_from_the_centre(void **unused)
{
    (void)unused;
    double y[4] = {0, 0, 1, 0}, still[4] = {1, 2, 0.3, 0.1}, fast[4] = {1, 0, 1e200, 0};
    assert_false(gm_kepler_flow(2, 1, 0.1, y, y + 2));
    assert_false(gm_kepler_flow(2, 1, 0.1, fast, fast + 2)); /* its energy is beyond all numbers */
    assert_true(gm_kepler_flow(2, 1, 0, still, still + 2));
    assert_true(still[0] == 1 && still[3] == 0.1);
}

enum { BODIES = 4, LARGEST = BODIES * 3 };

/* The components of a body are apart, as in x1, x2, .., y1, y2, .. */
static void fill(struct gm_gravity *gravity, size_t *places, double *masses, double *y)
{
    gravity->places = places;
    gravity->masses = masses;
    gravity->sums = masses + BODIES;
    gravity->G = 0.7;
    const size_t d = gravity->dimensions, half = gravity->bodies * d;
    for (size_t i = 0; i < gravity->bodies; i++) {
        masses[i] = 1. / (double)(i * i + 1);
        gravity->sums[i] = masses[i] + (i > 0 ? gravity->sums[i - 1] : 0);
        for (size_t c = 0; c < d; c++) {
            places[i * d + c] = c * gravity->bodies + (gravity->bodies - 1 - i);
        }
    }
    for (size_t k = 0; k < 2 * half; k++) {
        y[k] = sin(3. * (double)(k * k) + 1);
    }
}

static void bodies_go_there_and_back(void **unused)
{
    (void)unused;
    for (size_t d = 2; d <= 3; d++) {
        struct gm_gravity gravity = {.bodies = BODIES, .dimensions = d};
        size_t places[LARGEST];
        double masses[2 * BODIES], y[2 * LARGEST], there[2 * LARGEST], scratch[2 * LARGEST];
        fill(&gravity, places, masses, y);
        const size_t half = BODIES * d;
        for (size_t k = 0; k < 2 * half; k++) {
            there[k] = y[k];
        }
        gm_jacobi_from_state(&gravity, there, scratch);
        double whole = 0;
        for (size_t i = 0; i < BODIES; i++) {
            whole += y[half + places[i * d]];
        }
        assert_true(fabs(there[half] * gravity.sums[BODIES - 1] - whole) < 1e-15);
        assert_true(fabs(there[d] - (y[places[d]] - y[places[0]])) < 1e-15);
        gm_jacobi_to_state(&gravity, there, scratch);
        for (size_t k = 0; k < 2 * half; k++) {
            assert_true(fabs(there[k] - y[k]) < 4e-16);
        }
    }
}

/* Newton's accelerations, in Jacobi coordinates, are those of the Kepler motions and the interaction: of two bodies, which
   have none, and of more. */
static void parts_are_newtons_law(void **unused)
{
    (void)unused;
    for (size_t bodies = 2; bodies <= BODIES; bodies++) {
        for (size_t d = 2; d <= 3; d++) {
            struct gm_gravity gravity = {.bodies = bodies, .dimensions = d};
            size_t places[LARGEST];
            double masses[2 * BODIES], y[2 * LARGEST], newton[2 * LARGEST], scratch[2 * LARGEST],
                rates[LARGEST];
            fill(&gravity, places, masses, y);
            const size_t half = bodies * d;
            for (size_t i = 0; i < bodies; i++) {
                double force[3] = {0};
                for (size_t j = 0; j < bodies; j++) {
                    double square = 0;
                    for (size_t c = 0; c < d; c++) {
                        square += pow(y[places[j * d + c]] - y[places[i * d + c]], 2);
                    }
                    for (size_t c = 0; c < d && j != i; c++) {
                        force[c] += gravity.G * masses[i] * masses[j] * pow(square, -1.5) *
                                    (y[places[j * d + c]] - y[places[i * d + c]]);
                    }
                }
                for (size_t c = 0; c < d; c++) {
                    newton[half + places[i * d + c]] = force[c];
                }
            }
            for (size_t k = 0; k < half; k++) {
                newton[k] = y[k];
            }
            gm_jacobi_from_state(&gravity, newton, scratch); /* forces as momenta */
            gm_jacobi_interaction(&gravity, newton, rates, scratch);
            for (size_t i = 0; i < bodies; i++) {
                double square = 0;
                for (size_t c = 0; c < d; c++) {
                    square += pow(newton[i * d + c], 2);
                }
                for (size_t c = 0; c < d; c++) {
                    const double attraction =
                        i == 0 ? 0 : gravity.G * gravity.sums[i] * newton[i * d + c] * pow(square, -1.5);
                    const double expected = newton[half + i * d + c] + attraction;
                    assert_true(fabs(rates[i * d + c] - expected) < 1e-13 * (1 + fabs(attraction)));
                    assert_true(i > 1 || rates[i * d + c] == 0 || bodies > 2);
                }
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orbits_are_closed_forms),   cmocka_unit_test(revolutions_lead_back),
        cmocka_unit_test(no_motion_from_the_centre), cmocka_unit_test(bodies_go_there_and_back),
        cmocka_unit_test(parts_are_newtons_law),
    };
    return cmocka_run_group_tests_name("gravity", tests, NULL, NULL);
}
