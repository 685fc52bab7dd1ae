/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_BALL_H
#define GM_CORE_THEORY_BALL_H

#include <mpfr.h>
#include <stdbool.h>
#include <stddef.h>

/* The functions of MPFR that are called. */
/* clang-format off */
#define GM_MPFR_FUNCTIONS(F) \
    F(mpfr_add) F(mpfr_cmp_d) F(mpfr_const_pi) F(mpfr_cos) F(mpfr_div) F(mpfr_div_si) F(mpfr_exp) \
    F(mpfr_free_cache) F(mpfr_get_d) F(mpfr_get_str) F(mpfr_log) F(mpfr_mul) F(mpfr_set_d) F(mpfr_set_si_2exp) \
    F(mpfr_sin) F(mpfr_sqrt) F(mpfr_strtofr) F(mpfr_sub)
/* clang-format on */

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
/* Returns the decimal text[0 .. length), not followed by a digit; `value` is its double. It is exact if it is a whole
   number, has at most 3 digits or is a short dyadic fraction, otherwise known within half a unit of its last digit.
   16 or 17 digits are a printed double, of which 15 are known. */
struct gm_ball gm_ball_decimal(const char *text, size_t length, double value);
enum { GM_BALL_DIGITS = 77 }; /* of a whole number that is exact */
struct gm_ball gm_ball_pi(void);

struct gm_ball gm_ball_add(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_subtract(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_multiply(struct gm_ball a, struct gm_ball b);
/* x' y */
struct gm_ball gm_ball_dot(const struct gm_ball *x, const struct gm_ball *y, int count);
/* The radius of the result is infinite if b may vanish, or if the argument is outside the range of the function. */
struct gm_ball gm_ball_divide(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_sqrt(struct gm_ball a);
struct gm_ball gm_ball_exp(struct gm_ball a);
struct gm_ball gm_ball_log(struct gm_ball a);
struct gm_ball gm_ball_sin(struct gm_ball a);
struct gm_ball gm_ball_cos(struct gm_ball a);
/* Frees the constants that the functions have cached for this thread. */
void gm_ball_forget(void);

/* Return true if the ball is exactly 0, and if two balls are identical. */
bool gm_ball_is_zero(const struct gm_ball *a);
bool gm_ball_is_same(const struct gm_ball *a, const struct gm_ball *b);
/* Returns true if the ball contains 0. */
bool gm_ball_may_vanish(struct gm_ball a);
/* Returns the midpoint as a double. gm_ball_sign returns the sign of the ball, 0 if it contains 0. */
double gm_ball_midpoint(struct gm_ball a);
/* Writes the midpoint with this number of significant digits, without an exponent. */
void gm_ball_print(struct gm_ball a, int digits, char *text, size_t size);
int gm_ball_sign(struct gm_ball a);

#endif
