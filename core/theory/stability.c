/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stability function of y' = lambda y, z = h lambda, 1 = (1, ..., 1)':
       R(z) = P(z) / Q(z),   P(z) = det(I - z A + z 1 b'),   Q(z) = det(I - z A)
   whose coefficients are those of characteristic polynomials (Faddeev and Le Verrier). Bounded
       on the negative axis    as long as  Q(-x)^2 - P(-x)^2 >= 0
       on the imaginary axis   as long as  E(y) = |Q(iy)|^2 - |P(iy)|^2 >= 0
   A-stable if E >= 0 everywhere and all zeros of Q lie to the right, L-stable if also deg P < deg Q. E.
   Hairer & G. Wanner, Solving Ordinary Differential Equations II (1996), IV.3.

   A splitting turns the oscillator by a matrix of determinant 1, bounded as long as its trace lies within
   [-2, 2]; with x = (omega h)^2
       drift d:  q := q + d p,   kick k:  p := p - k x q */
#include "core/theory/stability.h"

#include <math.h>
#include <string.h>

#include "core/arena.h"
#include "core/theory/polynomial.h"

static const struct gm_polynomial zero = {.degree = -1};

/* p := p det(I - z M) of a square block of the matrix M, with
       det(I - z M) = 1 + c_1 z + ... + c_s z^s,   X_k = M X_(k-1) + c_(k-1) M,   c_k = -tr(X_k) / k
   m is the block's first entry in rows of `stride`; x and next are scratch. */
static void multiply_determinant(int s, const struct gm_ball *m, int stride, struct gm_ball *x,
                                 struct gm_ball *next, struct gm_polynomial *p)
{
    struct gm_polynomial block = {.degree = s, .at = {gm_ball_of(1)}}, product = zero;
    for (int i = 0; i < s * s; i++) {
        x[i] = gm_ball_of(0);
    }
    for (int k = 1; k <= s; k++) {
        struct gm_ball trace = gm_ball_of(0);
        for (int i = 0; i < s; i++) {
            for (int j = 0; j < s; j++) {
                struct gm_ball sum = gm_ball_multiply(block.at[k - 1], m[i * stride + j]);
                for (int l = 0; l < s; l++) {
                    sum = gm_ball_add(sum, gm_ball_multiply(m[i * stride + l], x[l * s + j]));
                }
                next[i * s + j] = sum;
            }
            trace = gm_ball_add(trace, next[i * s + i]);
        }
        memcpy(x, next, (size_t)s * (size_t)s * sizeof *x);
        block.at[k] = gm_ball_multiply(trace, gm_ball_ratio(-1, k));
    }
    gm_polynomial_add_product(&product, gm_ball_of(1), p, &block);
    *p = product;
}

/* Returns true if rows 0 .. last of a matrix are 0 in the columns after `last`. */
static bool is_closed(int s, const struct gm_ball *m, int last)
{
    for (int i = 0; i <= last; i++) {
        for (int j = last + 1; j < s; j++) {
            if (!gm_ball_is_zero(&m[i * s + j])) {
                return false;
            }
        }
    }
    return true;
}

/* p := det(I - z M), block by block where M is a block triangle: a composition takes no longer than its
   parts, and no digits are lost in the product. */
static void determinant(int s, const struct gm_ball *m, struct gm_ball *x, struct gm_ball *next,
                        struct gm_polynomial *p)
{
    gm_polynomial_set(p, gm_ball_of(1));
    for (int first = 0, last = 0; last < s; last++) {
        if (is_closed(s, m, last)) {
            multiply_determinant(last + 1 - first, m + first * s + first, s, x, next, p);
            first = last + 1;
        }
    }
}

/* q(x) = p(-x) */
static void mirror(const struct gm_polynomial *p, struct gm_polynomial *q)
{
    *q = *p;
    for (int k = 1; k <= q->degree; k += 2) {
        q->at[k] = gm_ball_subtract(gm_ball_of(0), q->at[k]);
    }
}

/* Adds factor |p(iy)|^2 to the polynomial in y^2: p(iy) = even(-y^2) + i y odd(-y^2). */
static void add_modulus(struct gm_polynomial *sum, double factor, const struct gm_polynomial *p)
{
    struct gm_polynomial parts[2] = {zero, zero};
    for (int k = 0; k <= p->degree; k++) {
        struct gm_polynomial *part = &parts[k % 2];
        part->degree = k / 2;
        part->at[k / 2] = k / 2 % 2 == 0 ? p->at[k] : gm_ball_subtract(gm_ball_of(0), p->at[k]);
    }
    struct gm_polynomial odd = zero;
    gm_polynomial_add_product(sum, gm_ball_of(factor), &parts[0], &parts[0]);
    gm_polynomial_add_product(&odd, gm_ball_of(factor), &parts[1], &parts[1]);
    gm_polynomial_add(sum, gm_ball_of(1), 1, &odd);
}

/* R(z) = 1 + sum_k z^k b' A^(k-1) 1 where A has nothing on and above the diagonal: the determinants say the
   same, but of typed decimals they leave fewer digits. x and next are scratch. */
static void of_explicit(const struct gm_coefficients *coefficients, struct gm_ball *x, struct gm_ball *next,
                        struct gm_polynomial *p)
{
    const int s = coefficients->stages;
    gm_polynomial_set(p, gm_ball_of(1));
    for (int i = 0; i < s; i++) {
        x[i] = gm_ball_of(1);
    }
    for (int k = 1; k <= s; k++) {
        p->at[k] = gm_ball_dot(coefficients->b[0], x, s);
        p->degree = k;
        for (int i = 0; i < s; i++) {
            next[i] = gm_ball_dot(coefficients->a[0] + i * s, x, i);
        }
        memcpy(x, next, (size_t)s * sizeof *x);
    }
}

/* R(z) R(-z) = 1 of a symmetric method, so P(z) = Q(-z). */
static void of_plain(struct gm_arena *arena, const struct gm_coefficients *coefficients, bool symmetric,
                     struct gm_theory_stability *stability)
{
    const int s = coefficients->stages;
    if (s > GM_POLYNOMIAL_DEGREE) {
        return;
    }
    const size_t square = (size_t)s * (size_t)s;
    struct gm_ball *m = gm_arena_take(arena, 3 * square, sizeof *m), *x = m + square, *next = x + square;
    struct gm_polynomial p, q, left_p, left_q, on_real = zero, on_imaginary = zero;
    bool is_explicit = true;
    determinant(s, coefficients->a[0], x, next, &q);
    for (int i = 0; i < s; i++) {
        is_explicit = is_explicit && gm_ball_is_zero(&coefficients->a[0][i * s + i]) &&
                      is_closed(s, coefficients->a[0], i);
    }
    if (is_explicit) {
        of_explicit(coefficients, x, next, &p);
    } else if (symmetric) {
        mirror(&q, &p);
    } else {
        /* transposed: the stages of a composition know the weights of those before them, which vanish here */
        for (int i = 0; i < s * s; i++) {
            const struct gm_ball *a = &coefficients->a[0][i], *b = &coefficients->b[0][i % s];
            m[i % s * s + i / s] = gm_ball_is_same(a, b) ? gm_ball_of(0) : gm_ball_subtract(*a, *b);
        }
        determinant(s, m, x, next, &p);
    }
    gm_polynomial_settle(&p);
    gm_polynomial_settle(&q);
    mirror(&p, &left_p);
    mirror(&q, &left_q);
    stability->known = 2 * p.degree <= GM_POLYNOMIAL_DEGREE && 2 * q.degree <= GM_POLYNOMIAL_DEGREE;
    if (stability->known) {
        gm_polynomial_add_product(&on_real, gm_ball_of(1), &left_q, &left_q);
        gm_polynomial_add_product(&on_real, gm_ball_of(-1), &left_p, &left_p);
        add_modulus(&on_imaginary, 1, &q);
        add_modulus(&on_imaginary, -1, &p);
    }
    gm_polynomial_settle(&on_real);
    gm_polynomial_settle(&on_imaginary);
    stability->real = gm_polynomial_first_negative(&on_real);
    stability->imaginary = sqrt(gm_polynomial_first_negative(&on_imaginary));
    if (is_explicit && (isinf(stability->real) || isinf(stability->imaginary))) {
        stability->known = false; /* R is a polynomial, of which too few digits are known */
    }
    stability->a_stable = !is_explicit && isinf(stability->imaginary) && gm_polynomial_is_hurwitz(&left_q);
    stability->l_stable = stability->a_stable && p.degree < q.degree;
}

static void of_splitting(const struct gm_coefficients *coefficients, struct gm_theory_stability *stability)
{
    *stability = (struct gm_theory_stability){.oscillator = true, .real = NAN, .imaginary = INFINITY};
    if (2 * coefficients->stages > GM_POLYNOMIAL_DEGREE) {
        return;
    }
    struct gm_polynomial step[2][2], square = zero, bound;
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            step[i][j] = zero;
        }
        gm_polynomial_set(&step[i][i], gm_ball_of(1));
    }
    for (int i = 0; i < coefficients->stages; i++) {
        const struct gm_ball drift = coefficients->b[GM_SIDE_Q][i], kick = coefficients->b[GM_SIDE_P][i];
        for (int column = 0; column < 2; column++) {
            gm_polynomial_add(&step[0][column], drift, 0, &step[1][column]);
            gm_polynomial_add(&step[1][column], gm_ball_multiply(gm_ball_of(-1), kick), 1, &step[0][column]);
        }
    }
    gm_polynomial_add(&step[0][0], gm_ball_of(1), 0, &step[1][1]);
    gm_polynomial_set(&bound, gm_ball_of(4));
    gm_polynomial_add_product(&square, gm_ball_of(-1), &step[0][0], &step[0][0]);
    gm_polynomial_add(&bound, gm_ball_of(1), 0, &square);
    stability->known = true;
    stability->imaginary = sqrt(gm_polynomial_first_negative(&bound));
}

/* Returns true if each stage is a drift or a kick after those before it. */
static bool is_splitting(const struct gm_coefficients *coefficients)
{
    const int s = coefficients->stages;
    for (int k = 0; k < s * s * GM_SIDES; k++) {
        const int side = k / (s * s), i = k / s % s, j = k % s;
        const struct gm_ball *a = &coefficients->a[side][i * s + j], *b = &coefficients->b[side][j];
        if (!(j < i ? gm_ball_is_same(a, b) : gm_ball_is_zero(a)) ||
            !(gm_ball_is_zero(b) || gm_ball_is_zero(&coefficients->b[1 - side][j]))) {
            return false;
        }
    }
    return true;
}

struct gm_theory_stability gm_theory_stability_of(struct gm_arena *arena,
                                                  const struct gm_coefficients *coefficients, bool symmetric)
{
    struct gm_theory_stability stability = {.real = NAN, .imaginary = NAN};
    if (coefficients->equations == GM_EQUATIONS_PLAIN) {
        of_plain(arena, coefficients, symmetric, &stability);
    } else if (coefficients->equations != GM_EQUATIONS_PARTITIONED && is_splitting(coefficients)) {
        of_splitting(coefficients, &stability);
    }
    return stability;
}
