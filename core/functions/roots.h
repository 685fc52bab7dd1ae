/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hypot = s sqrt((x/s)^2 + (y/s)^2), s a power of two, 1 between 2^-400 and 2^500. The sum of squares is rounded once,
   to q, from its parts hi + lo:
       |hypot - fl(sqrt q)| <= (1/2 + 1/sqrt 8) units of the last place = .854
   where the root's own rounding is the half, and that of q, halved by the root, is most where q is just above 2.
   Included for each pass. */
GM_FUNCTION_OF_PASS real K(hypot)(real x, real y)
{
    const real a = K(magnitude)(x), b = K(magnitude)(y), larger = K(pick)(a > b, a, b),
               smaller = K(pick)(a > b, b, a);
    const bool common = K(everywhere)(K(both)(larger > 0x1p-400, larger < 0x1p500));
    pattern exponent = K(bits)(K(constant)(1)) >> 52;
    real u = larger, v = smaller;
    if (!common) {
        exponent = K(bits)(K(pick)(larger < 0x1p-1022, K(constant)(0x1p-1022), larger)) >> 52;
        const real scale = K(number)((2047 - exponent) << 52);
        u = u * scale;
        v = v * scale;
    }
    const struct K(pair) p = K(product)(u, u), q = K(product)(v, v), sum = K(sum)(p.hi, q.hi);
    const real length = K(root)(sum.hi + (sum.lo + (p.lo + q.lo))), inf = K(constant)(INFINITY);
    if (common) {
        return K(pick)(y != y, y, length);
    }
    return K(pick)(K(either)(a == inf, b == inf), inf,
                   K(pick)(K(either)(x != x, y != y), x + y, 0.5 * length * K(number)(exponent << 52)));
}
