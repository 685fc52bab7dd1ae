/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arithmetic of balls: midpoints by MPFR in storage of our own, which it never allocates, and bounds in double,
   each enlarged by more than what its own rounding may have lost. */
#include "core/theory/ball.h"

#include <float.h>
#include <math.h>

enum { BITS = 256, EXACT_BITS = 26, DIGITS = 15 };

/* A view of the midpoint, good while the ball stays where it is. */
static void view(mpfr_t number, const struct gm_ball *ball)
{
    mpfr_custom_init_set(number, ball->kind, ball->exponent, BITS, (void *)ball->limbs);
}

/* A result to be: a zero whose limbs MPFR may write. */
static void begin(mpfr_t number, struct gm_ball *ball)
{
    mpfr_custom_init(ball->limbs, BITS);
    mpfr_custom_init_set(number, MPFR_ZERO_KIND, 0, BITS, ball->limbs);
}

/* Takes the result over, with its bound and that of its rounding. */
static void finish(struct gm_ball *ball, mpfr_t number, bool rounded, double radius)
{
    ball->kind = mpfr_custom_get_kind(number);
    ball->exponent = mpfr_custom_get_exp(number);
    if (rounded) {
        radius += ldexp(fabs(mpfr_get_d(number, MPFR_RNDA)), 1 - BITS);
    }
    ball->radius = radius * (1 + 8 * DBL_EPSILON);
}

struct gm_ball gm_ball_of(double value)
{
    struct gm_ball ball;
    mpfr_t number;
    begin(number, &ball);
    mpfr_set_d(number, value, MPFR_RNDN);
    finish(&ball, number, false, 0);
    return ball;
}

struct gm_ball gm_ball_ratio(long p, long q)
{
    struct gm_ball ball;
    mpfr_t number;
    begin(number, &ball);
    mpfr_set_si(number, p, MPFR_RNDN);
    finish(&ball, number, mpfr_div_si(number, number, q, MPFR_RNDN) != 0, 0);
    return ball;
}

struct gm_ball gm_ball_written(double value)
{
    struct gm_ball ball = gm_ball_of(value);
    int exponent;
    const double scaled = ldexp(frexp(value, &exponent), EXACT_BITS);
    if (scaled != nearbyint(scaled)) {
        ball.radius = pow(10, floor(log10(fabs(value))) + 1 - DIGITS) / 2;
    }
    return ball;
}

typedef int operation(mpfr_ptr result, mpfr_srcptr x, mpfr_srcptr y, mpfr_rnd_t rounding);

/* The midpoints' result, whose bound without its rounding is known. */
static struct gm_ball combine(operation *apply, const struct gm_ball *a, const struct gm_ball *b,
                              double radius)
{
    struct gm_ball result;
    mpfr_t x, y, number;
    view(x, a);
    view(y, b);
    begin(number, &result);
    finish(&result, number, apply(number, x, y, MPFR_RNDN) != 0, radius);
    return result;
}

struct gm_ball gm_ball_add(struct gm_ball a, struct gm_ball b)
{
    return combine(mpfr_add, &a, &b, a.radius + b.radius);
}

struct gm_ball gm_ball_subtract(struct gm_ball a, struct gm_ball b)
{
    return combine(mpfr_sub, &a, &b, a.radius + b.radius);
}

struct gm_ball gm_ball_multiply(struct gm_ball a, struct gm_ball b)
{
    mpfr_t x, y;
    view(x, &a);
    view(y, &b);
    const double size_a = fabs(mpfr_get_d(x, MPFR_RNDA)), size_b = fabs(mpfr_get_d(y, MPFR_RNDA));
    return combine(mpfr_mul, &a, &b, size_a * b.radius + size_b * a.radius + a.radius * b.radius);
}

double gm_ball_midpoint(struct gm_ball a)
{
    mpfr_t number;
    view(number, &a);
    return mpfr_get_d(number, MPFR_RNDN);
}

int gm_ball_sign(struct gm_ball a)
{
    mpfr_t number;
    view(number, &a);
    const double least = fabs(mpfr_get_d(number, MPFR_RNDZ));
    return least > a.radius ? mpfr_sgn(number) : 0;
}

bool gm_ball_may_vanish(struct gm_ball a)
{
    return gm_ball_sign(a) == 0;
}
