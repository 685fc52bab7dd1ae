/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The motion q'' = -mu q/|q|^3 in universal variables: r0 = |q|, alpha = 2 mu/r0 - |v|^2, G_k(s) = s^k c_k(alpha s^2), and
   s the root of
       r0 G1 + (q . v) G2 + mu G3 = h,
   whose left side grows with the derivative r = r0 G0 + (q . v) G1 + mu G2, the distance at the end:
       q1 = f  q + g  v,   f  = 1 - mu G2/r0,       g  = h - mu G3
       v1 = f' q + g' v,   f' = -mu G1/(r r0),      g' = 1 - mu G2/r
   K. Stumpff (1956); J.M.A. Danby, Fundamentals of Celestial Mechanics, section 6.9. */
#include "core/ode/families/splitting/kepler.h"

#include <math.h>

struct universal {
    double h, r0, slope, mu, alpha; /* slope: q . v */
    double s, G[4];
};

/* G_k of s. c_k(z) = 1/k! - z/(k + 2)! + z^2/(k + 4)! - ... by its series for z/4^n, then by doubling of the angle:
   c_1(4 z) = c_0 c_1, c_2(4 z) = c_1^2/2, c_3(4 z) = (c_2 + c_0 c_3)/4, of c_k(z); c_0 = 1 - z c_2. */
static void find_functions(struct universal *motion)
{
    const double s = motion->s, whole = motion->alpha * s * s;
    double z = whole;
    int doublings = 0;
    for (; fabs(z) >= 0.1 && doublings < 600; doublings++) {
        z /= 4;
    }
    const double z2 = z * z, z4 = z2 * z2;
    double c2 = (1. / 2 - z / 24) + z2 * (1. / 720 - z / 40320) +
                z4 * ((1. / 3628800 - z / 479001600) + z2 / 87178291200);
    double c3 = (1. / 6 - z / 120) + z2 * (1. / 5040 - z / 362880) +
                z4 * ((1. / 39916800 - z / 6227020800) + z2 / 1307674368000);
    double c1 = 1 - z * c3, c0 = 1 - z * c2;
    for (; doublings > 0; doublings--) {
        c3 = (c2 + c0 * c3) / 4;
        c2 = c1 * c1 / 2;
        c1 *= c0;
        z *= 4;
        c0 = 1 - z * c2;
    }
    motion->G[0] = c0;
    motion->G[1] = s * c1;
    motion->G[2] = s * s * c2;
    motion->G[3] = s * s * s * c3;
}

/* Moves s by d, which is small, with G by Taylor's series. */
static void move_slightly(struct universal *motion, double d)
{
    double *G = motion->G;
    const double bent = motion->alpha * G[1]; /* -dG0/ds */
    motion->s += d;
    G[3] += d * (G[2] + d / 2 * (G[1] + d / 3 * G[0]));
    G[2] += d * (G[1] + d / 2 * (G[0] - d / 3 * bent));
    G[1] += d * (G[0] - d / 2 * bent);
    G[0] -= d * (bent + d / 2 * motion->alpha * G[0]);
}

/* Finds s by Halley's method, kept between bounds that enclose it, and by bisection where that wanders. Its error is of
   third order in the move d: d^2 (mu + |alpha| r) <= SMALL r makes it a rounding, and the G are then moved. */
static bool solve_universal(struct universal *motion)
{
    enum { ITERATIONS = 400, NEWTON = 50 };
    static const double SMALL = 1e-11;
    const double h = motion->h, r0 = motion->r0, slope = motion->slope, mu = motion->mu, quick = h / r0,
                 second = slope * quick / (2 * r0),
                 third = (mu - motion->alpha * r0) * quick * quick / (6 * r0),
                 turn = second - 2 * second * second + third;
    double low = -INFINITY, high = INFINITY;
    motion->s = fabs(turn) < 0.5 ? quick * (1 - turn) : quick; /* the series of s in h */
    for (int i = 0; i < ITERATIONS; i++) {
        find_functions(motion);
        const double *G = motion->G, s = motion->s;
        const double excess = r0 * G[1] + slope * G[2] + mu * G[3] - h;
        const double r = r0 * G[0] + slope * G[1] + mu * G[2];
        const double bend = slope * G[0] + (mu - motion->alpha * r0) * G[1]; /* dr/ds */
        const double d = -excess * r / (r * r - excess * bend / 2);
        if (d * d * (mu + fabs(motion->alpha) * r) <= SMALL * r) {
            move_slightly(motion, d);
            return true;
        }
        const bool late =
            isfinite(excess) ? excess > 0 : s > 0; /* far on a hyperbola the functions overflow */
        if (late) {
            high = fmin(high, s);
        } else {
            low = fmax(low, s);
        }
        double next = s + d;
        if (!(next >= low && next <= high) || i > NEWTON) { /* the ends may lead to each other */
            next = isfinite(low) && isfinite(high) ? (low + high) / 2
                   : late                          ? s - fabs(quick) - fabs(s)
                                                   : s + fabs(quick) + fabs(s);
        }
        if (next == s) {
            return isfinite(excess);
        }
        motion->s = next;
    }
    return false;
}

static double product(size_t dimensions, const double *a, const double *b)
{
    double sum = a[0] * b[0] + a[1] * b[1];
    return dimensions > 2 ? sum + a[2] * b[2] : sum;
}

bool gm_kepler_flow(size_t dimensions, double mu, double h, double *q, double *v)
{
    const double r0 = sqrt(product(dimensions, q, q)), alpha = 2 * mu / r0 - product(dimensions, v, v);
    struct universal motion = {
        .h = h, .r0 = r0, .slope = product(dimensions, q, v), .mu = mu, .alpha = alpha};
    if (!(r0 > 0) || !isfinite(alpha)) {
        return false;
    }
    if (alpha > 0 && h * h * alpha * alpha * alpha > M_PI * M_PI * mu * mu) {
        motion.h = remainder(h, 2 * M_PI * mu / (alpha * sqrt(alpha))); /* whole revolutions lead back */
    }
    if (!solve_universal(&motion)) {
        return false;
    }
    const double *G = motion.G, r = r0 * G[0] + motion.slope * G[1] + mu * G[2];
    const double f = -mu * G[2] / r0, g = motion.h - mu * G[3], df = -mu * G[1] / (r * r0),
                 dg = -mu * G[2] / r;
    for (size_t c = 0; c < dimensions; c++) { /* increments: the rounding of factors near 1 would add up */
        const double x = q[c], w = v[c];
        q[c] += f * x + g * w;
        v[c] += df * x + dg * w;
    }
    return true;
}
