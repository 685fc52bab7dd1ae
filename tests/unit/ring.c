/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the schemes for waves are made of: linear systems around a ring, Fourier transforms. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/linear/fourier.h"
#include "core/linear/ring/ring.h"

/* Both ring solvers against the matrix. */
static void rings_are_solved(void **unused)
{
    (void)unused;
    static const size_t sizes[] = {2, 3, 8, 101};
    for (size_t s = 0; s < 4; s++) {
        const size_t n = sizes[s];
        double b[101], x[101];
        for (size_t i = 0; i < n; i++) {
            b[i] = sin(1 + 3.7 * (double)i);
        }
        double f[101], alternating = 0;
        for (size_t i = 0; i < n; i++) {
            alternating += (i % 2 ? -b[i] : b[i]) / (double)n;
        }
        for (size_t i = 0; i < n; i++) {
            f[i] = b[i] - (n % 2 ? 0 : i % 2 ? -alternating : alternating);
            x[i] = b[i] = f[i];
        }
        gm_ring_unaverage(f, n);
        for (size_t i = 0; i < n; i++) {
            assert_true(fabs((f[i] + f[(i + 1) % n]) / 2 - b[i]) < 1e-13);
        }
        if (n % 2 == 0) {
            for (size_t i = 0; i < n; i++) {
                f[i] = i % 2 ? 0 : 1;
            }
            gm_ring_unaverage(f, n);
            assert_true(isnan(f[n - 1]));
        }
        const struct gm_ring ring = gm_ring_make(n, 2.5, -1.1);
        gm_ring_solve(&ring, x);
        for (size_t i = 0; i < n; i++) {
            assert_true(fabs(2.5 * x[i] - 1.1 * (x[(i + 1) % n] + x[(i + n - 1) % n]) - b[i]) < 1e-13);
        }
        for (size_t reach = 1; reach <= 2 && 2 * reach < n; reach++) {
            struct gm_ring_band band;
            double two[202], matrix[2][2][5][101], given[202];
            assert_true(gm_ring_band_open(&band, n, 2, reach));
            gm_ring_band_clear(&band);
            for (size_t i = 0; i < 2 * n; i++) {
                two[i] = given[i] = sin(0.3 + (double)i);
            }
            for (size_t i = 0; i < n; i++) {
                for (size_t part = 0; part < 4; part++) {
                    for (long by = -(long)reach; by <= (long)reach; by++) {
                        double *entry = &matrix[part / 2][part % 2][by + 2][i];
                        *entry = cos(7.1 * (double)i + 3.3 * (double)part + 1.7 * (double)by);
                        gm_ring_band_add(&band, i, part / 2, by, part % 2, *entry);
                    }
                }
            }
            assert_true(gm_ring_band_factor(&band));
            gm_ring_band_solve(&band, two);
            for (size_t i = 0; i < 2 * n; i++) {
                double left = -given[i];
                for (size_t k = 0; k < 2 * (2 * reach + 1); k++) {
                    const size_t column = k % 2, by = k / 2 + 2 - reach;
                    left += matrix[i / n][column][by][i % n] * two[column * n + (i % n + n + by - 2) % n];
                }
                assert_true(fabs(left) < 1e-11);
            }
            gm_ring_band_close(&band);
        }
        for (int power = 1; power <= 3; power++) {
            const double complex mean = power == 2 ? 3 * I : 3, difference = 0.2;
            const double h = 0.3;
            struct gm_ring_roots roots;
            assert_true(gm_ring_roots_make(&roots, n, power, mean, difference, h));
            double complex left[101];
            double re[101], im[101], scratch[202];
            for (size_t i = 0; i < n; i++) {
                re[i] = b[i];
                im[i] = cos((double)i);
                left[i] = 0;
            }
            gm_ring_roots_solve(&roots, re, im, scratch);
            static const int binomial[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};
            for (size_t i = 0; i < n; i++) {
                for (int k = 0; k <= power; k++) {
                    const double sign = (power - k) % 2 ? -1 : 1;
                    const double complex entry =
                        binomial[power][k] * (mean / pow(2, power) + sign * difference / pow(h, power));
                    left[i] += entry * (re[(i + (size_t)k) % n] + I * im[(i + (size_t)k) % n]);
                }
                assert_true(cabs(left[i] - (b[i] + I * cos((double)i))) < 1e-11);
            }
        }
    }
}

/* Transforms against their sums; lengths with small factors alone, and primes. */
static void transforms_of_any_length(void **unused)
{
    (void)unused;
    static const size_t sizes[] = {1, 2, 3, 64, 101, 300, 809};
    for (size_t s = 0; s < GM_COUNT(sizes); s++) {
        const size_t n = sizes[s];
        double complex x[809], y[809];
        for (size_t j = 0; j < n; j++) {
            x[j] = y[j] = sin(1 + 3.7 * (double)j) + I * cos(0.3 * (double)(j * j));
        }
        struct gm_fourier *fourier = gm_fourier_open(n);
        gm_fourier_forward(fourier, y);
        for (size_t k = 0; k < n; k += 1 + n / 20) {
            double complex sum = 0;
            for (size_t j = 0; j < n; j++) {
                sum += x[j] * cexp(-2 * M_PI * I * (double)(j * k % n) / (double)n);
            }
            assert_true(cabs(y[k] - sum) < 1e-12 * (double)n);
        }
        gm_fourier_inverse(fourier, y);
        for (size_t j = 0; j < n; j++) {
            assert_true(cabs(y[j] - x[j]) < 1e-12);
        }
        gm_fourier_close(fourier);
    }
}
/* f_{i-1}/2 + f_i + f_{i+1}/2, whose root is 1 in magnitude: on an odd number of points it is solved; on an
   even one the alternating part has no solution, and nothing is written beside b. */
static void a_root_on_the_unit_circle(void **unused)
{
    (void)unused;
    enum { MOST = 9, GUARD = 4 };
    for (size_t n = 3; n <= MOST; n++) {
        const struct gm_ring ring = gm_ring_make(n, 1, 0.5);
        assert_true(ring.root == -1);
        double room[MOST + 2 * GUARD], *b = room + GUARD, given[MOST];
        for (size_t i = 0; i < MOST + 2 * GUARD; i++) {
            room[i] = 7;
        }
        for (size_t i = 0; i < n; i++) {
            given[i] = b[i] = sin(1 + 3.7 * (double)i);
        }
        gm_ring_solve(&ring, b);
        for (size_t i = 0; i < n; i++) {
            if (n % 2 == 1) {
                assert_true(fabs(b[(i + n - 1) % n] / 2 + b[i] + b[(i + 1) % n] / 2 - given[i]) < 1e-13);
            } else {
                assert_false(isfinite(b[i]));
            }
        }
        for (size_t i = 0; i < MOST + 2 * GUARD; i++) {
            assert_true((i >= GUARD && i < GUARD + n) || room[i] == 7);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings_are_solved),
        cmocka_unit_test(a_root_on_the_unit_circle),
        cmocka_unit_test(transforms_of_any_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
