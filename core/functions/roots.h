/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hypot = s sqrt((x/s)^2 + (y/s)^2), s a power of two, with the sum and its root as hi + lo. Included for each
   pass. */
GM_FUNCTION_OF_PASS real K(hypot)(real x, real y)
{
    const real a = K(magnitude)(x), b = K(magnitude)(y), larger = K(pick)(a > b, a, b);
    const pattern exponent = K(bits)(K(pick)(larger < 0x1p-1022, K(constant)(0x1p-1022), larger)) >> 52;
    const real scale = K(number)((2047 - exponent) << 52), u = a * scale, v = b * scale;
    const mask wide = u > v;
    const struct K(pair) p = K(product)(u, u), q = K(product)(v, v),
                         sum = K(sum)(K(pick)(wide, p.hi, q.hi), K(pick)(wide, q.hi, p.hi)),
                         root = K(root_of)((struct K(pair)){sum.hi, sum.lo + (p.lo + q.lo)});
    const real length = 0.5 * (root.hi + root.lo) * K(number)(exponent << 52), inf = K(constant)(INFINITY);
    return K(pick)(K(either)(a == inf, b == inf), inf, K(pick)(K(either)(x != x, y != y), x + y, length));
}
