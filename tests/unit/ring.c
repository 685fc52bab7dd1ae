/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the schemes for waves are made of: linear systems around a ring, Fourier transforms. */
#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/linear/fourier.h"
#include "core/linear/gmres.h"
#include "core/linear/ring/blocks.h"
#include "core/linear/ring/newton.h"
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
            x[i] = b[i] = sin(1 + 3.7 * (double)i);
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

/* The sum in long double of the numbers x_j exp(-2 pi i j k / n). */
static long double complex defining_sum(const double complex *x, size_t n, size_t k)
{
    long double complex sum = 0;
    for (size_t j = 0; j < n; j++) {
        const long double angle =
            2 * 3.14159265358979323846264338327950288L * (long double)(j * k % n) / (long double)n;
        sum += x[j] * (cosl(angle) - I * sinl(angle));
    }
    return sum;
}

/* Transforms of n complex and of n real numbers: their sums, the way back, Parseval's theorem. */
static void transforms_of_length(size_t n)
{
    double complex *x = calloc(3 * n, sizeof *x), *y = x + n, *waves = y + n;
    double *real = calloc(2 * n + 1, sizeof *real), *back = real + n;
    const double limit = 1e-15 * (2 + log2((double)n));
    double square = 0, squares = 0, real_square = 0, real_squares = 0;
    for (size_t j = 0; j < n; j++) {
        x[j] = y[j] = sin(1 + 3.7 * (double)j) + I * cos(0.3 * (double)(j * j));
        real[j] = creal(x[j]);
        square += creal(x[j] * conj(x[j]));
        real_square += real[j] * real[j];
    }
    const double after = back[n] = -7; /* of what lies behind the numbers nothing is written */
    struct gm_fourier *fourier = gm_fourier_open(n);
    struct gm_modes modes;
    assert_true(fourier && gm_modes_open(&modes, n, 1));
    gm_fourier_forward(fourier, y);
    gm_modes_forward(&modes, real, waves);
    for (size_t k = 0; k < n; k++) {
        const double twice = k > 0 && 2 * k != n ? 2 : 1;
        squares += creal(y[k] * conj(y[k])) / (double)n;
        real_squares += k <= n / 2 ? twice * creal(waves[k] * conj(waves[k])) / (double)n : 0;
    }
    assert_true(fabs(squares - square) <= limit * square &&
                fabs(real_squares - real_square) <= limit * real_square);
    for (size_t k = 0; k < n; k += 1 + n / 70) {
        assert_true(cabs(y[k] - (double complex)defining_sum(x, n, k)) <= limit * sqrt((double)n * square));
        const size_t other = (n - k) % n; /* of the real part: (X_k + conj X_(n-k))/2 */
        const double complex half = (defining_sum(x, n, k) + conjl(defining_sum(x, n, other))) / 2;
        assert_true(k > n / 2 || cabs(waves[k] - half) <= limit * sqrt((double)n * square));
    }
    gm_fourier_inverse(fourier, y);
    gm_modes_back(&modes, waves, back);
    for (size_t j = 0; j < n; j++) {
        assert_true(cabs(y[j] - x[j]) <= 4 * limit && fabs(back[j] - real[j]) <= 4 * limit);
    }
    assert_true(back[n] == after);
    gm_fourier_close(fourier);
    gm_modes_close(&modes);
    free(x);
    free(real);
}

/* Fields that lie one after the other: each has its own modes, and comes back. */
static void transforms_of_fields(void **unused)
{
    (void)unused;
    enum { FIELDS = 3, MOST = 10 };
    for (size_t n = MOST - 1; n <= MOST; n++) {
        struct gm_modes all, one;
        double values[FIELDS * MOST], given[FIELDS * MOST];
        double complex waves[FIELDS * MOST], wave[MOST];
        assert_true(gm_modes_open(&all, n, FIELDS) && gm_modes_open(&one, n, 1));
        for (size_t j = 0; j < FIELDS * n; j++) {
            values[j] = given[j] = sin(1 + 3.7 * (double)j);
        }
        gm_modes_forward(&all, values, waves);
        for (size_t k = 0; k < FIELDS; k++) {
            gm_modes_forward(&one, given + k * n, wave);
            assert_memory_equal(waves + k * n, wave, (n / 2 + 1) * sizeof *wave);
        }
        gm_modes_back(&all, waves, values);
        for (size_t j = 0; j < FIELDS * n; j++) {
            assert_true(fabs(values[j] - given[j]) < 1e-14);
        }
        gm_modes_close(&all);
        gm_modes_close(&one);
    }
}

static void transforms_of_any_length(void **unused)
{
    (void)unused;
    for (size_t n = 1; n <= 64; n++) {
        transforms_of_length(n);
    }
    static const size_t sizes[] = {97, 101, 300, 809, 1001, 1024, 2 * 809, 10007};
    for (size_t s = 0; s < GM_COUNT(sizes); s++) {
        transforms_of_length(sizes[s]);
    }
}

/* FNV-1a of the bits of transforms, found with the loops of each instruction set: equal on every processor. */
static void transforms_have_the_same_bits(void **unused)
{
    (void)unused;
    enum { MOST = 1024 };
    static const size_t sizes[] = {61, 97, 1001, MOST};
    uint64_t hash = 0xcbf29ce484222325;
    for (size_t s = 0; s < GM_COUNT(sizes); s++) {
        double real[MOST];
        double complex waves[MOST] = {0};
        struct gm_modes modes;
        assert_true(gm_modes_open(&modes, sizes[s], 1));
        for (size_t j = 0; j < sizes[s]; j++) {
            real[j] = (double)(j * j % 37) / 37 - 0.5;
        }
        gm_modes_forward(&modes, real, waves);
        gm_modes_back(&modes, waves, real);
        gm_modes_close(&modes);
        for (size_t k = 0; k < sizes[s]; k++) {
            const double numbers[] = {creal(waves[k]), cimag(waves[k]), real[k]};
            for (size_t i = 0; i < 3; i++) {
                uint64_t bits;
                const double number = numbers[i] + 0; /* -0 is 0 */
                memcpy(&bits, &number, sizeof bits);
                hash = (hash ^ bits) * 0x100000001b3;
            }
        }
    }
    assert_true(hash == 0xf89e0e4cc9b74744);
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

/* A polynomial whose root (difference - mean)/(difference + mean) is nearer to the unit circle than it can be told is
   refused; 1 - 1e-13 in magnitude is solved. */
static void roots_near_the_unit_circle(void **unused)
{
    (void)unused;
    struct gm_ring_roots ring;
    assert_false(gm_ring_roots_make(&ring, 9, 1, 1, 5e-15 + I, 2));
    assert_true(gm_ring_roots_make(&ring, 9, 1, 1, 1e-13 + I, 2));
    assert_false(gm_ring_roots_make(&ring, 9, 1, 1, -1, 2)); /* it is no polynomial of z */
    assert_false(gm_ring_roots_make(&ring, 9, 1, 0, 0, 2));
    assert_false(gm_ring_roots_make(&ring, 9, 1, NAN, 1, 2));
}

/* The largest entry of B y_i + C y_{i+1} - g_i around a ring of `count` points. */
static double block_residual(size_t count, size_t n, const double *b, const double *c)
{
    struct gm_ring_blocks blocks;
    double y[GM_RING_BLOCKS_MOST * 40], g[GM_RING_BLOCKS_MOST * 40], scratch[(GM_RING_BLOCKS_MOST + 2) * 40],
        largest = 0;
    if (!gm_ring_blocks_make(&blocks, count, n, b, c)) {
        return NAN;
    }
    for (size_t i = 0; i < n * count; i++) {
        y[i] = g[i] = cos(2 + 1.9 * (double)i);
    }
    gm_ring_blocks_solve(&blocks, y, scratch);
    for (size_t i = 0; i < count; i++) {
        for (size_t row = 0; row < n; row++) {
            double sum = -g[row * count + i];
            for (size_t k = 0; k < n; k++) {
                sum += b[row * n + k] * y[k * count + i] + c[row * n + k] * y[k * count + (i + 1) % count];
            }
            largest = fmax(largest, fabs(sum));
        }
    }
    return largest;
}

/* Pencils whose roots are a pair inside the unit circle, a pair outside, and a real one of each kind; of one unknown they
   are the quotient -b/c. What the ring cannot damp, or has no inverse, is refused. */
static void rings_of_blocks_are_solved(void **unused)
{
    (void)unused;
    static const double inside[] = {0.3, -0.5, 0.5, 0.3}, outside[] = {1.1, -2, 2, 1.1},
                        unit[] = {1, 0, 0, 1};
    static const double of_four[] = {0.3, -0.5, 0.1, 0.2, 0.5, 0.3,  0, 0.1,   // rows of B: a pair inside,
                                     0,   0,    3,   0.4, 0,   0.02, 0, -0.6}; // 3 and -0.6
    static const double units[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (size_t count = 2; count <= 40; count += count < 5 ? 1 : 7) {
        assert_true(block_residual(count, 2, inside, unit) < 1e-13);
        assert_true(block_residual(count, 2, outside, unit) < 1e-12);
        assert_true(block_residual(count, 4, of_four, units) < 1e-12);
        assert_true(block_residual(count, 1, &(double){0.5}, &(double){-1.25}) < 1e-14);
        assert_true(block_residual(count, 1, &(double){-2.5}, &(double){0.5}) < 1e-14);
    }
    assert_true(isnan(block_residual(40, 1, &(double){1}, &(double){-1}))); // a constant has no image
    assert_true(isnan(block_residual(40, 1, &(double){1}, &(double){0})));
    assert_true(isnan(block_residual(40, 2, unit, (double[]){1, 2, 2, 4})));
    /* as many unknowns as fit, with roots near -0.3 and -3 */
    enum { MOST = GM_RING_BLOCKS_MOST };
    double full[MOST * MOST], identity[MOST * MOST];
    for (size_t k = 0; k < MOST * MOST; k++) {
        const size_t row = k / MOST;
        identity[k] = row == k % MOST;
        full[k] =
            0.05 * cos(1 + 1.9 * (double)k) + identity[k] * (row % 2 ? 3 : 0.3) * (1 + (double)row / 20);
    }
    assert_true(block_residual(40, MOST, full, identity) < 1e-12);
    struct gm_ring_blocks blocks;
    const double wide[(GM_RING_BLOCKS_MOST + 1) * (GM_RING_BLOCKS_MOST + 1)] = {0};
    assert_false(gm_ring_blocks_make(&blocks, 40, GM_RING_BLOCKS_MOST + 1, wide, wide));
}

/* y_i = d_i x_i - x_{i-1}/2 + x_{i+1}/4, without the entries beyond the ends; with d = 0 the cyclic shift. */
struct chain {
    size_t n;
    double first, slope; /* of the diagonal */
};

static void multiply(void *data, const double *x, double *y)
{
    const struct chain *chain = data;
    for (size_t i = 0; i < chain->n; i++) {
        const double diagonal = chain->first + chain->slope * (double)i;
        y[i] = chain->first == 0
                   ? x[(i + 1) % chain->n]
                   : diagonal * x[i] - (i > 0 ? x[i - 1] / 2 : 0) + (i + 1 < chain->n ? x[i + 1] / 4 : 0);
    }
}

static void divide(void *data, const double *x, double *y)
{
    const struct chain *chain = data;
    for (size_t i = 0; i < chain->n; i++) {
        y[i] = x[i] / (chain->first + chain->slope * (double)i);
    }
}

static void copy(void *data, const double *x, double *y)
{
    memcpy(y, x, ((const struct chain *)data)->n * sizeof *x);
}

/* GMRES reaches a residual as small as it says, in fewer steps with a preconditioner; of three different eigenvalues it
   needs three; the cyclic shift, on which it stagnates for n steps, is given up, and a sum of zeros costs nothing. */
static void systems_are_solved_by_gmres(void **unused)
{
    (void)unused;
    enum { N = 400 };
    static double b[N], x[N], y[N], scratch[(2 * GM_GMRES_BASIS + 4) * N];
    assert_true(gm_gmres_scratch(N) <= sizeof scratch / sizeof *scratch);
    unsigned long taken[2] = {0};
    for (int preconditioned = 0; preconditioned < 2; preconditioned++) {
        struct chain chain = {N, 1.5, 0.02};
        const struct gm_system system = {N, multiply, preconditioned ? divide : copy, &chain};
        double sum = 0;
        for (size_t i = 0; i < N; i++) {
            b[i] = sin(1 + 3.7 * (double)i);
        }
        assert_true(gm_gmres(&system, b, x, 1e-9, scratch, &taken[preconditioned]));
        multiply(&chain, x, y);
        for (size_t i = 0; i < N; i++) {
            sum += (y[i] - b[i]) * (y[i] - b[i]);
        }
        assert_true(sqrt(sum) < 1.01e-9);
    }
    assert_true(taken[1] < taken[0] && taken[1] < 20 && taken[0] < 2 * GM_GMRES_BASIS);
    struct chain two = {2, 3, 1}, shift = {N, 0, 0};
    const struct gm_system small = {2, multiply, copy, &two}, turning = {N, multiply, copy, &shift};
    unsigned long iterations = 0;
    assert_true(gm_gmres(&small, (double[]){1, 0}, x, 1e-14, scratch, &iterations));
    /* by hand: 3 x + y/4 = 1, -x/2 + 4 y = 0 */
    assert_true(iterations == 2 && fabs(x[0] - 32. / 97) < 1e-15 && fabs(x[1] - 4. / 97) < 1e-15);
    memset(b, 0, sizeof b);
    assert_true(gm_gmres(&turning, b, x, 0, scratch, &iterations) && iterations == 2 && x[0] == 0);
    b[0] = 1;
    assert_false(gm_gmres(&turning, b, x, 1e-3, scratch, &iterations));
    assert_true(iterations == 2 + GM_GMRES_BASIS);
}

/* atan v_i + (v_{i-1} - v_{i+1})/8, where v = u - `solution`. The sum of v_i times it is that of v_i atan v_i, so that
   v = 0 is its only zero. */
enum { ARCS = 12 };
struct arcs {
    const double *solution;
    double v[ARCS];
};

static void find_arcs(void *context, const double *u, double *residual)
{
    struct arcs *arcs = context;
    for (size_t i = 0; i < ARCS; i++) {
        arcs->v[i] = u[i] - arcs->solution[i];
    }
    for (size_t i = 0; i < ARCS; i++) {
        residual[i] = -atan(arcs->v[i]) - (arcs->v[(i + ARCS - 1) % ARCS] - arcs->v[(i + 1) % ARCS]) / 8;
    }
}

static void find_slopes_of_arcs(void *context, struct gm_ring_band *matrix)
{
    const struct arcs *arcs = context;
    for (size_t i = 0; i < ARCS; i++) {
        gm_ring_band_add(matrix, i, 0, 0, 0, 1 / (1 + arcs->v[i] * arcs->v[i]));
        gm_ring_band_add(matrix, i, 0, -1, 0, 0.125);
        gm_ring_band_add(matrix, i, 0, 1, 0, -0.125);
    }
}

/* Newton's method for the arcs diverges where |v| > 1.4, as for one arctangent; halved steps lead to the
   solution. It is far from 0, so that steps and places differ. */
static void newton_halves_its_steps(void **unused)
{
    (void)unused;
    double solution[ARCS], u[ARCS];
    for (size_t i = 0; i < ARCS; i++) {
        solution[i] = 1000 + cos((double)i);
        u[i] = solution[i] + 3;
    }
    struct arcs arcs = {.solution = solution};
    const struct gm_ring_equations equations = {&arcs, find_arcs, find_slopes_of_arcs};
    struct gm_ring_newton newton;
    struct gm_progress progress = {0};
    assert_true(gm_ring_newton_open(&newton, ARCS, 1, 1));
    assert_true(gm_ring_newton_solve(&newton, &equations, u, &progress) == GM_OK);
    for (size_t i = 0; i < ARCS; i++) {
        assert_true(fabs(u[i] - solution[i]) < 1e-12);
    }
    assert_true(progress.evaluations > progress.iterations); /* some steps were halved */
    gm_ring_newton_close(&newton);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings_are_solved),
        cmocka_unit_test(newton_halves_its_steps),
        cmocka_unit_test(a_root_on_the_unit_circle),
        cmocka_unit_test(roots_near_the_unit_circle),
        cmocka_unit_test(rings_of_blocks_are_solved),
        cmocka_unit_test(systems_are_solved_by_gmres),
        cmocka_unit_test(transforms_of_fields),
        cmocka_unit_test(transforms_of_any_length),
        cmocka_unit_test(transforms_have_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
