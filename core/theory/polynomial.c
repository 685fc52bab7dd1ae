/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polynomials of balls. Where one changes its sign is found between the places where its derivative does, by
   bisection; these come from the derivative's derivative in the same way. */
#include "core/theory/polynomial.h"

#include <math.h>

#include "core/functions/functions.h"

void gm_polynomial_settle(struct gm_polynomial *p)
{
    for (int k = 0; k <= p->degree; k++) {
        if (gm_ball_may_vanish(p->at[k])) {
            p->at[k] = gm_ball_of(0);
        }
    }
    while (p->degree >= 0 && gm_ball_may_vanish(p->at[p->degree])) {
        p->degree--;
    }
}

void gm_polynomial_set(struct gm_polynomial *p, struct gm_ball constant)
{
    p->degree = 0;
    p->at[0] = constant;
}

static void reach(struct gm_polynomial *p, int degree)
{
    while (p->degree < degree) {
        p->at[++p->degree] = gm_ball_of(0);
    }
}

void gm_polynomial_add(struct gm_polynomial *p, struct gm_ball factor, int shift,
                       const struct gm_polynomial *q)
{
    reach(p, q->degree + shift);
    for (int k = 0; k <= q->degree; k++) {
        p->at[k + shift] = gm_ball_add(p->at[k + shift], gm_ball_multiply(factor, q->at[k]));
    }
}

void gm_polynomial_add_product(struct gm_polynomial *p, struct gm_ball factor, const struct gm_polynomial *q,
                               const struct gm_polynomial *r)
{
    if (q->degree < 0 || r->degree < 0) {
        return;
    }
    reach(p, q->degree + r->degree);
    for (int i = 0; i <= q->degree; i++) {
        const struct gm_ball scaled = gm_ball_multiply(factor, q->at[i]);
        for (int k = 0; k <= r->degree; k++) {
            p->at[i + k] = gm_ball_add(p->at[i + k], gm_ball_multiply(scaled, r->at[k]));
        }
    }
}

static struct gm_ball value_at(const struct gm_ball *at, int degree, double x)
{
    struct gm_ball value = gm_ball_of(0);
    for (int k = degree; k >= 0; k--) {
        value = gm_ball_add(gm_ball_multiply(value, gm_ball_of(x)), at[k]);
    }
    return value;
}

/* Bisects [low, high], at whose ends the signs are `sign` and not. */
static double cross(const struct gm_ball *at, int degree, double low, double high, int sign)
{
    for (;;) {
        const double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high) {
            return middle;
        }
        if (gm_ball_midpoint(value_at(at, degree, middle)) * sign > 0) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/* The places x > 0 where it changes its sign, from below; how many. */
static int crossings(const struct gm_ball *at, int degree, double *places)
{
    while (degree > 0 && gm_ball_may_vanish(at[degree])) { /* what cancels leaves noise */
        degree--;
    }
    if (degree <= 0) {
        return 0;
    }
    struct gm_ball slope[GM_POLYNOMIAL_DEGREE + 1];
    double turns[GM_POLYNOMIAL_DEGREE + 1], bound = 0;
    const double leading = fabs(gm_ball_midpoint(at[degree]));
    for (int k = 1; k <= degree; k++) {
        slope[k - 1] = gm_ball_multiply(gm_ball_of(k), at[k]);
    }
    for (int k = 0; k < degree; k++) {
        bound = fmax(bound, 2 * gm_pow(fabs(gm_ball_midpoint(at[k])) / leading, 1. / (degree - k)));
    }
    int count = 0, turn_count = crossings(slope, degree - 1, turns);
    turns[turn_count++] =
        1.1 * bound; /* no zero lies beyond it. M. Fujiwara, Tohoku Math. J. 10 (1916) 167 */
    int lowest = 0;
    while (lowest < degree && gm_ball_may_vanish(at[lowest])) {
        lowest++;
    }
    int sign = gm_ball_sign(at[lowest]); /* just above 0 */
    double from = 0;
    for (int i = 0; i < turn_count; i++) {
        const int here = gm_ball_sign(value_at(at, degree, turns[i]));
        if (here * sign < 0) {
            places[count++] = cross(at, degree, from, turns[i], sign);
            sign = here;
        }
        from = here != 0 ? turns[i] : from;
    }
    return count;
}

double gm_polynomial_first_negative(const struct gm_polynomial *p)
{
    int lowest = 0;
    while (lowest <= p->degree && gm_ball_may_vanish(p->at[lowest])) {
        lowest++;
    }
    if (lowest > p->degree) {
        return INFINITY;
    }
    if (gm_ball_sign(p->at[lowest]) < 0) {
        return 0;
    }
    double places[GM_POLYNOMIAL_DEGREE + 1];
    return crossings(p->at + lowest, p->degree - lowest, places) > 0 ? places[0] : INFINITY;
}

bool gm_polynomial_is_hurwitz(const struct gm_polynomial *p)
{
    if (p->degree < 0) {
        return false;
    }
    struct gm_ball above[GM_POLYNOMIAL_DEGREE + 2], row[GM_POLYNOMIAL_DEGREE + 2];
    const int width = p->degree / 2 + 1;
    for (int k = 0; k <= width; k++) {
        const int even = p->degree - 2 * k, odd = even - 1;
        above[k] = even >= 0 ? p->at[even] : gm_ball_of(0);
        row[k] = odd >= 0 ? p->at[odd] : gm_ball_of(0);
    }
    const int sign = gm_ball_sign(above[0]);
    for (int i = 0; i < p->degree; i++) {
        if (gm_ball_sign(row[0]) * sign <= 0) {
            return false;
        }
        /* the next row, times row[0], whose sign is known: no division */
        struct gm_ball next[GM_POLYNOMIAL_DEGREE + 2];
        for (int k = 0; k < width; k++) {
            next[k] = gm_ball_subtract(gm_ball_multiply(row[0], above[k + 1]),
                                       gm_ball_multiply(above[0], row[k + 1]));
            if (sign < 0) {
                next[k] = gm_ball_subtract(gm_ball_of(0), next[k]);
            }
        }
        next[width] = gm_ball_of(0);
        for (int k = 0; k <= width; k++) {
            above[k] = row[k];
            row[k] = next[k];
        }
    }
    return true;
}
