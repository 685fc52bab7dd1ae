/* SPDX-License-Identifier: GPL-3.0-or-later */
/* atan, atan2, asin and acos, all as the angle of a point (d, n), 0 <= n <= d:
       atan(n/d) = atan c + atan t,  t = (n - c d)/(d + c n),  c = i/32 next to n/d,  |t| <= 1/64
   with a table of atan c, the series of atan t to t^9, which ends 2^-63 of the value too early, and n, d and t as
   hi + lo. asin x is the angle of (sqrt(1 - x^2), x), acos x that of (x, sqrt(1 - x^2)). The error of atan c + atan t
   is 2^-60 of the value, so that of its rounded sum is 1/2 of a unit of the last place and .01. Gal & Bachelis, ACM
   TOMS 17 (1991) 26, for tables with a short series. Included for each pass. */
#ifdef GM_PASS_SCALAR
/* atan(i/32) as hi and lo */
static const double gm_angle_rows[33][2] = {
    {0, 0},
    {0x1.ffd55bba97625p-6, -0x1.5ec431444912cp-60},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.7ee182602f10fp-4, -0x1.cfb654c0c3d98p-58},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.3d6eee8c6626cp-3, 0x1.61a3b0ce9281bp-57},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.b90d7529260a2p-3, 0x1.17b10d2e0e5abp-61},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.18bf5a30bf178p-2, 0x1.30ca4748b1bf9p-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.530ad9951cd4ap-2, -0x1.2566480884082p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.8b24d394a1b25p-2, 0x1.b6d0ba3748fa8p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.c0db4c94ec9f0p-2, -0x1.cc1ce70934c34p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.f40dd0b541418p-2, -0x1.a3992dc382a23p-57},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1255d9bfbd2a9p-1, -0x1.2bdaee1c0ee35p-58},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.2958e59308e31p-1, -0x1.09e73b0c6c087p-56},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.3f13fb89e96f4p-1, 0x1.ecf8b492644f0p-56},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.538f57b89061fp-1, -0x1.1bb74abda520cp-55},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.66d663923e087p-1, -0x1.6ea6febe8bbbap-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.78f6bbd5d315ep-1, 0x1.406a089803740p-55},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.89ff5ff57f1f8p-1, -0x1.55b9a5e177a1bp-55},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};
#endif

/* the angle of (x, y) in [0, pi/2], x and y >= 0, not both 0 */
GM_INLINE struct K(pair) K(angle)(struct K(pair) x, struct K(pair) y)
{
    const mask steep = y.hi > x.hi;
    const struct K(pair) n = {K(pick)(steep, x.hi, y.hi), K(pick)(steep, x.lo, y.lo)},
                         d = {K(pick)(steep, y.hi, x.hi), K(pick)(steep, y.lo, x.lo)};
    const real c32 = (n.hi / d.hi * 32 + 0x1.8p52) - 0x1.8p52, c = c32 * 0x1p-5;
    real table_hi = c, table_lo = c;
    for (int l = 0; l < GM_LANES; l++) {
        /* a NaN has no row */
        const double at = K(lane)(c32, l), *row = gm_angle_rows[at >= 0 && at <= 32 ? (int)at : 0];
        K(set_lane)(&table_hi, l, row[0]);
        K(set_lane)(&table_lo, l, row[1]);
    }
    const real dh = K(head)(d.hi), nh = K(head)(n.hi);
    struct K(pair) over = K(any_sum)(n.hi - c * dh, -c * (d.hi - dh)), under = K(sum)(d.hi, c * nh);
    over.lo = over.lo + (n.lo - c * d.lo);
    under = K(sum)(under.hi, under.lo + (c * (n.hi - nh) + (d.lo + c * n.lo)));
    const struct K(pair) t = K(quotient)(over, under);
    const real z = t.hi * t.hi, zz = z * z,
               series = z * t.hi *
                        ((0.2 * z - 0x1.5555555555555p-2) +
                         zz * (0x1.c71c71c71c71cp-4 * z - 0x1.2492492492492p-3));
    const struct K(pair) sum = K(sum)(table_hi, t.hi);
    const real lo = sum.lo + (table_lo + (t.lo + series));
    const struct K(pair) rest = K(sum)(K(constant)(0x1.921fb54442d18p+0), -sum.hi);
    return (struct K(pair)){K(pick)(steep, rest.hi, sum.hi),
                            K(pick)(steep, rest.lo + (0x1.1a62633145c07p-54 - lo), lo)};
}

GM_FUNCTION_OF_PASS real K(atan)(real x)
{
    const real size = K(magnitude)(x);
    const struct K(pair) one = {K(constant)(1), K(constant)(0)},
                         within = {K(pick)(size > 0x1p100, K(constant)(0x1p100), size), K(constant)(0)},
                         angle = K(angle)(one, within);
    return K(pick)(size < 0x1p-28, x, K(signed_as)(angle.hi + angle.lo, x));
}

/* pi less the angle where x has the sign */
GM_INLINE real K(beyond)(real x, struct K(pair) angle)
{
    const struct K(pair) rest = K(sum)(K(constant)(0x1.921fb54442d18p+1), -angle.hi);
    const pattern negative = -(K(bits)(x) >> 63);
    return K(blend)(negative, rest.hi + (rest.lo + (0x1.1a62633145c07p-53 - angle.lo)), angle.hi + angle.lo);
}

GM_FUNCTION_OF_PASS real K(atan2)(real y, real x)
{
    const real inf = K(constant)(INFINITY), a = K(magnitude)(x), b = K(magnitude)(y);
    const mask endless = K(both)(a == inf, b == inf), none = K(both)(a == 0, b == 0);
    /* a power of two brings the larger to [2, 4); beyond it the angle is that of an axis */
    const real larger = K(pick)(a > b, a, b);
    const pattern exponent = K(bits)(K(pick)(larger < 0x1p-1022, K(constant)(0x1p-1022), larger)) >> 52;
    const real scale = K(number)((2047 - exponent) << 52);
    const real one = K(constant)(1);
    const mask far_x = K(either)(endless, K(either)(none, a == inf)), far_y = K(either)(endless, b == inf);
    const real u = K(pick)(far_x, one, K(pick)(far_y, K(constant)(0), a * scale)),
               v = K(pick)(far_y, one, K(pick)(K(either)(none, a == inf), K(constant)(0), b * scale));
    const struct K(pair) angle =
        K(angle)((struct K(pair)){u, K(constant)(0)}, (struct K(pair)){v, K(constant)(0)});
    const real turned = K(signed_as)(K(beyond)(x, angle), y), ratio = b / a;
    const mask small = K(both)(ratio < 0x1p-30, K(bits)(x) >> 63 == 0);
    return K(pick)(K(either)(x != x, y != y), x + y, K(pick)(small, K(signed_as)(ratio, y), turned));
}

/* sqrt(1 - x^2) */
GM_INLINE struct K(pair) K(other_leg)(real x)
{
    const struct K(pair) square = K(product)(x, x), rest = K(sum)(K(constant)(1), -square.hi);
    return K(root_of)(K(sum)(rest.hi, rest.lo - square.lo));
}

GM_FUNCTION_OF_PASS real K(asin)(real x)
{
    const real size = K(magnitude)(x);
    const struct K(pair) angle = K(angle)(K(other_leg)(x), (struct K(pair)){size, K(constant)(0)});
    return K(pick)(size < 0x1p-28, x, K(signed_as)(angle.hi + angle.lo, x));
}

GM_FUNCTION_OF_PASS real K(acos)(real x)
{
    const struct K(pair) angle = K(angle)((struct K(pair)){K(magnitude)(x), K(constant)(0)}, K(other_leg)(x));
    return K(beyond)(x, angle);
}
