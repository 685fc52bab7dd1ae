/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arithmetic of balls: midpoints by MPFR in storage of our own, which it never allocates, and bounds in
   double, each enlarged by more than what its own rounding may have lost. */
#include "core/theory/ball.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"
#include "loader/library.h"

static GM_LIBRARY_TABLE(mpfr, GM_MPFR_FUNCTIONS);
GM_LIBRARY(mpfr, "libmpfr.so.6", GM_MPFR_FUNCTIONS)

enum { BITS = 256, EXACT_BITS = 26, DIGITS = 15 };
static const double LARGEST = 1e6;

static _Thread_local bool used; /* true once this thread may have cached constants */

/* A view of the midpoint, valid until the ball is moved. */
static void view(mpfr_t number, const struct gm_ball *ball)
{
    mpfr_custom_init_set(number, ball->kind, ball->exponent, BITS, (void *)ball->limbs);
}

/* A result to be: a zero whose limbs MPFR may write. */
static void begin(mpfr_t number, struct gm_ball *ball)
{
    used = true;
    mpfr_custom_init(ball->limbs, BITS);
    mpfr_custom_init_set(number, MPFR_ZERO_KIND, 0, BITS, ball->limbs);
}

/* Takes the result over, with its bound and that of its rounding. */
static void finish(struct gm_ball *ball, mpfr_t number, bool rounded, double radius)
{
    ball->kind = mpfr_custom_get_kind(number);
    ball->exponent = mpfr_custom_get_exp(number);
    if (rounded) {
        radius += ldexp(fabs(mpfr()->mpfr_get_d(number, MPFR_RNDA)), 1 - BITS);
    }
    ball->radius = radius * (1 + 8 * DBL_EPSILON);
}

struct gm_ball gm_ball_of(double value)
{
    struct gm_ball ball;
    mpfr_t number;
    begin(number, &ball);
    mpfr()->mpfr_set_d(number, value, MPFR_RNDN);
    finish(&ball, number, false, 0);
    return ball;
}

struct gm_ball gm_ball_ratio(long p, long q)
{
    struct gm_ball ball;
    mpfr_t number;
    begin(number, &ball);
    mpfr()->mpfr_set_si_2exp(number, p, 0, MPFR_RNDN);
    finish(&ball, number, (mpfr()->mpfr_div_si)(number, number, q, MPFR_RNDN) != 0, 0);
    return ball;
}

static bool is_short_dyadic(double value)
{
    int exponent;
    const double scaled = ldexp(frexp(value, &exponent), EXACT_BITS);
    return scaled == nearbyint(scaled);
}

/* Returns half a unit of digit number DIGITS of a value. */
static double half_unit(double value)
{
    return gm_pow(10, floor(gm_log10(fabs(value))) + 1 - DIGITS) / 2;
}

struct gm_ball gm_ball_written(double value)
{
    enum { LARGEST_DENOMINATOR = 100 };
    for (long q = 1; q <= LARGEST_DENOMINATOR; q++) {
        const double p = nearbyint(value * (double)q);
        if (p / (double)q == value) {
            return gm_ball_ratio((long)p, q);
        }
    }
    struct gm_ball ball = gm_ball_of(value);
    if (!is_short_dyadic(value)) {
        ball.radius = half_unit(value);
    }
    return ball;
}

struct gm_ball gm_ball_decimal(const char *text, size_t length, double value)
{
    enum { EXACT_DIGITS = 3 };
    int digits = 0, behind = 0; /* from the first that is not 0; behind the point */
    bool point = false;
    size_t i = 0;
    for (; i < length && text[i] != 'e' && text[i] != 'E'; i++) {
        point = point || text[i] == '.';
        digits += text[i] != '.' && (digits > 0 || text[i] != '0');
        behind += text[i] != '.' && point;
    }
    struct gm_ball ball;
    mpfr_t number;
    begin(number, &ball);
    const bool rounded = mpfr()->mpfr_strtofr(number, text, NULL, 10, MPFR_RNDN) != 0;
    const double unit = gm_pow(10, (i < length ? strtod(text + i + 1, NULL) : 0) - behind);
    const bool whole = !point && i == length;
    const bool dyadic = !rounded && mpfr()->mpfr_cmp_d(number, value) == 0 && is_short_dyadic(value);
    const bool printed = digits > DIGITS && digits <= DIGITS + 2;
    finish(&ball, number, rounded,
           whole || dyadic || digits <= EXACT_DIGITS ? 0
           : printed                                 ? half_unit(value)
                                                     : unit / 2);
    return ball;
}

struct gm_ball gm_ball_pi(void)
{
    struct gm_ball ball;
    mpfr_t number;
    begin(number, &ball);
    finish(&ball, number, mpfr()->mpfr_const_pi(number, MPFR_RNDN) != 0, 0);
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
    return combine(mpfr()->mpfr_add, &a, &b, a.radius + b.radius);
}

struct gm_ball gm_ball_subtract(struct gm_ball a, struct gm_ball b)
{
    return combine(mpfr()->mpfr_sub, &a, &b, a.radius + b.radius);
}

struct gm_ball gm_ball_multiply(struct gm_ball a, struct gm_ball b)
{
    mpfr_t x, y;
    view(x, &a);
    view(y, &b);
    const double size_a = fabs(mpfr()->mpfr_get_d(x, MPFR_RNDA)),
                 size_b = fabs(mpfr()->mpfr_get_d(y, MPFR_RNDA));
    return combine(mpfr()->mpfr_mul, &a, &b, size_a * b.radius + size_b * a.radius + a.radius * b.radius);
}

struct gm_ball gm_ball_dot(const struct gm_ball *x, const struct gm_ball *y, int count)
{
    struct gm_ball sum = gm_ball_of(0);
    for (int i = 0; i < count; i++) {
        sum = gm_ball_add(sum, gm_ball_multiply(x[i], y[i]));
    }
    return sum;
}

/* At least, and at most, the size of what is in the ball. */
static double least_size(struct gm_ball a)
{
    mpfr_t x;
    view(x, &a);
    return fmax(0, fabs(mpfr()->mpfr_get_d(x, MPFR_RNDZ)) - a.radius) * (1 - 4 * DBL_EPSILON);
}

static double most_size(struct gm_ball a)
{
    mpfr_t x;
    view(x, &a);
    return fabs(mpfr()->mpfr_get_d(x, MPFR_RNDA)) + a.radius;
}

static struct gm_ball unknown(void)
{
    struct gm_ball ball = gm_ball_of(0);
    ball.radius = INFINITY;
    return ball;
}

/* |a / b - x / y| <= (r_a + |x / y| r_b) / |b| */
struct gm_ball gm_ball_divide(struct gm_ball a, struct gm_ball b)
{
    const double least = least_size(b);
    if (!(least > 0)) {
        return unknown();
    }
    const double quotient = most_size(a) / least;
    return combine(mpfr()->mpfr_div, &a, &b,
                   a.radius == 0 && b.radius == 0 ? 0 : (a.radius + quotient * b.radius) / least);
}

typedef int function(mpfr_ptr result, mpfr_srcptr x, mpfr_rnd_t rounding);

/* The midpoint's value; `slope` bounds the derivative between it and what is in the ball. Of large arguments
   MPFR would need as many bits as they have. */
static struct gm_ball map(function *apply, const struct gm_ball *a, double slope)
{
    struct gm_ball result;
    mpfr_t x, number;
    if (!(most_size(*a) < LARGEST)) {
        return unknown();
    }
    view(x, a);
    begin(number, &result);
    finish(&result, number, apply(number, x, MPFR_RNDN) != 0, a->radius > 0 ? slope * a->radius : 0);
    return result;
}

/* (sqrt a - sqrt x) (sqrt a + sqrt x) = a - x */
struct gm_ball gm_ball_sqrt(struct gm_ball a)
{
    const double x = gm_ball_midpoint(a);
    const bool zero = x == 0 && a.radius == 0;
    return zero ? a : x >= a.radius ? map(mpfr()->mpfr_sqrt, &a, 1.0000001 / sqrt(x)) : unknown();
}

struct gm_ball gm_ball_exp(struct gm_ball a)
{
    return map(mpfr()->mpfr_exp, &a, gm_exp(gm_ball_midpoint(a) + a.radius) * 1.0000001);
}

struct gm_ball gm_ball_log(struct gm_ball a)
{
    return gm_ball_sign(a) > 0 ? map(mpfr()->mpfr_log, &a, 1 / least_size(a)) : unknown();
}

struct gm_ball gm_ball_sin(struct gm_ball a)
{
    return map(mpfr()->mpfr_sin, &a, 1);
}

struct gm_ball gm_ball_cos(struct gm_ball a)
{
    return map(mpfr()->mpfr_cos, &a, 1);
}

void gm_ball_forget(void)
{
    if (used) {
        mpfr()->mpfr_free_cache();
    }
}

double gm_ball_midpoint(struct gm_ball a)
{
    mpfr_t number;
    view(number, &a);
    return mpfr()->mpfr_get_d(number, MPFR_RNDN);
}

void gm_ball_print(struct gm_ball a, int digits, char *text, size_t size)
{
    char figures[GM_BALL_DIGITS + 8];
    mpfr_exp_t point = 0; /* the number is 0.figures 10^point */
    mpfr_t number;
    view(number, &a);
    const double value = fabs(mpfr()->mpfr_get_d(number, MPFR_RNDN));
    const int before = value > 0 ? (int)floor(gm_log10(value)) + 1 : 1;
    mpfr()->mpfr_get_str(figures, &point, 10, (size_t)(digits > before ? digits : before), number, MPFR_RNDN);
    const char *first = figures + (figures[0] == '-');
    const int whole = value > 0 ? (int)point : 1, rest = (int)strlen(first) - whole;
    /* %.*d writes as many zeros as its width says */
    snprintf(text, size, "%s%.*s%s%.*d%s", first > figures ? "-" : "", whole > 0 ? whole : 1,
             whole > 0 ? first : "0", rest > 0 ? "." : "", whole < 0 ? -whole : 0, 0,
             whole > 0 ? first + whole : first);
}

int gm_ball_sign(struct gm_ball a)
{
    mpfr_t number;
    view(number, &a);
    const double least = fabs(mpfr()->mpfr_get_d(number, MPFR_RNDZ));
    return least > a.radius ? MPFR_SIGN(number) : 0;
}

bool gm_ball_is_zero(const struct gm_ball *a)
{
    return abs(a->kind) == MPFR_ZERO_KIND && a->radius == 0;
}

bool gm_ball_is_same(const struct gm_ball *a, const struct gm_ball *b)
{
    const bool zeros = abs(a->kind) == MPFR_ZERO_KIND && abs(b->kind) == MPFR_ZERO_KIND;
    return a->radius == b->radius && (zeros || (a->kind == b->kind && a->exponent == b->exponent &&
                                                memcmp(a->limbs, b->limbs, sizeof a->limbs) == 0));
}

bool gm_ball_may_vanish(struct gm_ball a)
{
    return gm_ball_sign(a) == 0;
}
