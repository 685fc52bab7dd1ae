/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With a left vector u of the pencil, u' (B + z C) = 0, the number e_i = u' C y_i obeys
       e_{i+1} = z e_i + u' g_i
   which runs forwards where |z| < 1 and backwards where |z| > 1, so that rounding dies out; what it starts
   from is a geometric sum around the ring. y follows from the n of them. G.W. Stewart & J. Sun, Matrix
   Perturbation Theory (1990), chapter VI. */
#include "core/linear/ring/blocks.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/complex.h"
#include "core/functions/functions.h"
#include "core/linear/eigenvalues.h"

enum { MOST = GM_RING_BLOCKS_MOST };

/* Solves a x = b for `columns` right sides, which it overwrites. Returns false if a, which is destroyed,
   is singular. */
static bool solve(double complex a[MOST][MOST], double complex b[MOST][MOST], size_t n, size_t columns)
{
    for (size_t p = 0; p < n; p++) {
        size_t best = p;
        for (size_t i = p + 1; i < n; i++) {
            best = gm_cabs(a[i][p]) > gm_cabs(a[best][p]) ? i : best;
        }
        for (size_t j = 0; j < n; j++) {
            const double complex held = a[p][j];
            a[p][j] = a[best][j];
            a[best][j] = held;
        }
        for (size_t j = 0; j < columns; j++) {
            const double complex held = b[p][j];
            b[p][j] = b[best][j];
            b[best][j] = held;
        }
        if (!(gm_cabs(a[p][p]) > 0)) {
            return false;
        }
        for (size_t i = 0; i < n; i++) {
            const double complex factor = i == p ? 0 : gm_cdivide(a[i][p], a[p][p]);
            for (size_t j = p; j < n; j++) {
                a[i][j] -= factor * a[p][j];
            }
            for (size_t j = 0; j < columns; j++) {
                b[i][j] -= factor * b[p][j];
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < columns; j++) {
            b[i][j] = gm_cdivide(b[i][j], a[i][i]);
        }
    }
    return true;
}

/* -C^-1 B; returns false if C is singular or nearly so. */
static bool find_roots(size_t n, const double *b, const double *c, double *real, double *imaginary)
{
    double complex left[MOST][MOST], right[MOST][MOST];
    double matrix[MOST * MOST];
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            left[i][j] = c[i * n + j];
            right[i][j] = -b[i * n + j];
        }
    }
    bool bounded = solve(left, right, n, n);
    for (size_t i = 0; i < n * n; i++) {
        matrix[i] = creal(right[i / n][i % n]);
        bounded &= fabs(matrix[i]) < 1e8;
    }
    return bounded && gm_eigenvalues(matrix, n, real, imaginary);
}

/* A left vector, by inverse iteration; of length 1. */
static bool find_left(size_t n, const double *b, const double *c, double complex root, double complex *left)
{
    double complex x[MOST][MOST];
    for (size_t i = 0; i < n; i++) {
        x[i][0] = 1 + 0.3 * (double)i;
    }
    for (int k = 0; k < 3; k++) {
        double complex a[MOST][MOST];
        double size = 0;
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                a[i][j] = b[j * n + i] + root * (1 + 1e-11) * c[j * n + i];
            }
        }
        if (!solve(a, x, n, 1)) {
            return false;
        }
        for (size_t i = 0; i < n; i++) {
            size = gm_hypot(size, gm_cabs(x[i][0]));
        }
        for (size_t i = 0; i < n; i++) {
            left[i] = x[i][0] /= size;
        }
    }
    return true;
}

bool gm_ring_blocks_make(struct gm_ring_blocks *blocks, size_t count, size_t n, const double *b,
                         const double *c)
{
    double real[MOST], imaginary[MOST];
    double complex products[MOST][MOST], inverse[MOST][MOST];
    *blocks = (struct gm_ring_blocks){.count = count, .n = n};
    if (n > MOST || !find_roots(n, b, c, real, imaginary)) {
        return false;
    }
    double complex lefts[MOST][MOST];
    for (size_t k = 0; k < n; k++) {
        if (!find_left(n, b, c, real[k] + I * imaginary[k], lefts[k])) {
            return false;
        }
        for (size_t j = 0; j < n; j++) {
            products[k][j] = 0;
            for (size_t i = 0; i < n; i++) {
                products[k][j] += lefts[k][i] * c[i * n + j];
            }
            inverse[k][j] = k == j;
        }
    }
    if (!solve(products, inverse, n, n)) {
        return false;
    }
    for (size_t k = 0; k < n; k++) {
        if (imaginary[k] < 0) {
            continue; /* its pair gives the same */
        }
        struct gm_ring_block_root *root = &blocks->root[blocks->roots++];
        root->value = real[k] + I * imaginary[k];
        root->real = imaginary[k] == 0;
        const bool inside = gm_cabs(root->value) < 1;
        const double complex damped = inside ? root->value : gm_cdivide(1, root->value);
        const double needed = fabs(42 / gm_log(gm_cabs(damped))); /* e^-42 = 6e-19 */
        root->reach = needed < (double)count ? (size_t)needed + 1 : count;
        root->closed = root->reach == count ? gm_cdivide(1, 1 - gm_cpow(damped, (double)count)) : 1;
        if (!(gm_cabs(root->closed) < 1e4)) {
            return false;
        }
        for (size_t i = 0; i < n; i++) {
            root->left[i] = lefts[k][i];
            root->right[i] = inverse[i][k] * (root->real ? 1 : 2);
            if (!(gm_cabs(root->right[i]) < 1e4 * (1 + fabs(1 / c[0])))) {
                return false;
            }
        }
    }
    return true;
}

GM_CLONES static void add(double *restrict to, const double *restrict from, double factor, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] += factor * from[i];
    }
}

/* Replaces u' g by e, real and imaginary parts in place, with e_i at index i. */
static void sweep(const struct gm_ring_block_root *root, size_t count, double *re, double *im)
{
    const bool inside = gm_cabs(root->value) < 1;
    const double complex step = inside ? root->value : gm_cdivide(1, root->value);
    const double s = creal(step), t = cimag(step);
    double x = 0, y = 0;
    /* inside: e_{i+1} = z e_i + h_i; outside: e_i = (e_{i+1} - h_i)/z */
    for (size_t k = 0; k < root->reach; k++) {
        const size_t i = inside ? count - root->reach + k : root->reach - 1 - k;
        const double h = re[i], g = im[i];
        const double u = inside ? s * x - t * y + h : s * (x - h) - t * (y - g);
        y = inside ? s * y + t * x + g : s * (y - g) + t * (x - h);
        x = u;
    }
    const double complex first = (x + I * y) * root->closed;
    x = creal(first);
    y = cimag(first);
    if (inside) {
        for (size_t i = 0; i < count; i++) {
            const double u = s * x - t * y + re[i], v = s * y + t * x + im[i];
            re[i] = x;
            im[i] = y;
            x = u;
            y = v;
        }
    } else {
        for (size_t i = count; i-- > 0;) {
            const double u = x - re[i], v = y - im[i];
            x = s * u - t * v;
            y = s * v + t * u;
            re[i] = x;
            im[i] = y;
        }
    }
}

static void sweep_real(const struct gm_ring_block_root *root, size_t count, double *e)
{
    const bool inside = gm_cabs(root->value) < 1;
    const double s = creal(inside ? root->value : gm_cdivide(1, root->value));
    double x = 0;
    for (size_t k = 0; k < root->reach; k++) {
        x = inside ? s * x + e[count - root->reach + k] : s * (x - e[root->reach - 1 - k]);
    }
    x *= creal(root->closed);
    if (inside) {
        for (size_t i = 0; i < count; i++) {
            const double next = s * x + e[i];
            e[i] = x;
            x = next;
        }
    } else {
        for (size_t i = count; i-- > 0;) {
            e[i] = x = s * (x - e[i]);
        }
    }
}

void gm_ring_blocks_solve(const struct gm_ring_blocks *blocks, double *g, double *scratch)
{
    const size_t count = blocks->count, n = blocks->n;
    double *re = scratch + n * count, *im = re + count;
    memcpy(scratch, g, n * count * sizeof *g);
    memset(g, 0, n * count * sizeof *g);
    for (size_t k = 0; k < blocks->roots; k++) {
        const struct gm_ring_block_root *root = &blocks->root[k];
        memset(re, 0, 2 * count * sizeof *re);
        for (size_t a = 0; a < n; a++) {
            add(re, scratch + a * count, creal(root->left[a]), count);
            if (!root->real) {
                add(im, scratch + a * count, cimag(root->left[a]), count);
            }
        }
        if (root->real) {
            sweep_real(root, count, re);
        } else {
            sweep(root, count, re, im);
        }
        for (size_t a = 0; a < n; a++) {
            add(g + a * count, re, creal(root->right[a]), count);
            if (!root->real) {
                add(g + a * count, im, -cimag(root->right[a]), count);
            }
        }
    }
}
