/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_BALL_H
#define GM_CORE_THEORY_BALL_H

#include <mpfr.h>
#include <stdbool.h>
#include <stddef.h>

/* A number that is known within a bound, |x - midpoint| <= radius: exact order conditions are decided with
   these. The midpoint has 256 bits (77 digits); results are rounded, and their bound says by how much. A
   plain value: nothing is allocated, nothing is freed. */
struct gm_ball {
    mp_limb_t limbs[256 / (8 * sizeof(mp_limb_t))];
    mpfr_exp_t exponent;
    int kind; /* of MPFR: zero, regular ..., with the sign */
    double radius;
};

/* Exactly `value`; p / q, rounded (q is not 0). */
struct gm_ball gm_ball_of(double value);
struct gm_ball gm_ball_ratio(long p, long q);
/* A coefficient of a table: exact where the double is that of a fraction whose denominator is at most 100, or a
   short dyadic fraction (26 bits), else within half a unit of its 15th significant digit. */
struct gm_ball gm_ball_written(double value);
/* The decimal text[0 .. length), behind which no digit stands, with its value as a double: exact where it is a
   whole number, has at most 3 digits or is, by all its digits, a short dyadic fraction, else within half a unit
   of its last digit; 16 or 17 digits are a double that was printed, of which 15 are known. */
struct gm_ball gm_ball_decimal(const char *text, size_t length, double value);
enum { GM_BALL_DIGITS = 77 }; /* of a whole number that is exact */
struct gm_ball gm_ball_pi(void);

struct gm_ball gm_ball_add(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_subtract(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_multiply(struct gm_ball a, struct gm_ball b);
/* x' y */
struct gm_ball gm_ball_dot(const struct gm_ball *x, const struct gm_ball *y, int count);
/* Where b may vanish, and where a function is asked for beyond the numbers that it knows, nothing is known of
   the result: its radius is infinite. */
struct gm_ball gm_ball_divide(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_sqrt(struct gm_ball a);
struct gm_ball gm_ball_exp(struct gm_ball a);
struct gm_ball gm_ball_log(struct gm_ball a);
struct gm_ball gm_ball_sin(struct gm_ball a);
struct gm_ball gm_ball_cos(struct gm_ball a);
/* Frees the constants that this thread's functions have remembered. */
void gm_ball_forget(void);

/* Whether it is 0 and nothing else; whether two are one and the same ball. */
bool gm_ball_is_zero(const struct gm_ball *a);
bool gm_ball_is_same(const struct gm_ball *a, const struct gm_ball *b);
/* Whether it may be 0. */
bool gm_ball_may_vanish(struct gm_ball a);
/* The midpoint as a double, and the sign of the ball: 0 where it may vanish. */
double gm_ball_midpoint(struct gm_ball a);
/* Writes the midpoint with so many digits from the first that is not 0, without an exponent. */
void gm_ball_print(struct gm_ball a, int digits, char *text, size_t size);
int gm_ball_sign(struct gm_ball a);

#endif
