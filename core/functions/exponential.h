/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exp, of  x = k log(2)/32 + r,  |r| <= log(2)/64:  e^x = 2^(k/32) (1 + r + ... + r^6/6!)
   with a table of 2^(k/32) as hi + lo; the series ends 2^-58 of the value too early. expm1, sinh, cosh and tanh, of
   x = k log 2 + r,  |r| <= log(2)/2:
       e^x = 2^k (1 + r + r^2/2 + r^3 E(r)),        m = e^|x| - 1
       sinh = (m + m/(m + 1))/2,  cosh = (m + 1 + 1/(m + 1))/2,  tanh = m'/(m' + 2),  m' = e^2|x| - 1
   with hi + lo where parts cancel. E interpolates at the Chebyshev points, of degree 9: the error is 2^-58 of e^x - 1.
   log 2 has two parts, of which k times the first is exact. Errors in units of the last place: exp 1/2 for the last sum
   and .03 for r (e^r - 1)/r, rounded; .75 below 2^-1022, after two roundings. expm1, whose r^2/2 is rounded, .9;
   of it sinh and tanh have .75, cosh .6. Cody & Waite, Software Manual for the Elementary Functions, 1980; Tang, ACM
   TOMS 15 (1989) 144 and 18 (1992) 211. Included for each pass. */
#ifdef GM_PASS_SCALAR
/* 2^(i/32) as hi and lo */
static const double gm_exponential_rows[32][2] = {
    {0x1.0000000000000p+0, 0},
    {0x1.059b0d3158574p+0, 0x1.d73e2a475b465p-55},
    {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54},
    {0x1.11301d0125b51p+0, -0x1.6c51039449b3ap-54},
    {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55},
    {0x1.1d4873168b9aap+0, 0x1.e016e00a2643cp-54},
    {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54},
    {0x1.29e9df51fdee1p+0, 0x1.612e8afad1255p-55},
    {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55},
    {0x1.371a7373aa9cbp+0, -0x1.63aeabf42eae2p-54},
    {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55},
    {0x1.44e086061892dp+0, 0x1.89b7a04ef80d0p-59},
    {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56},
    {0x1.5342b569d4f82p+0, -0x1.07abe1db13cadp-55},
    {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54},
    {0x1.6247eb03a5585p+0, -0x1.383c17e40b497p-54},
    {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54},
    {0x1.71f75e8ec5f74p+0, -0x1.16e4786887a99p-55},
    {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55},
    {0x1.82589994cce13p+0, -0x1.d4c1dd41532d8p-54},
    {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54},
    {0x1.93737b0cdc5e5p+0, -0x1.75fc781b57ebcp-57},
    {0x1.9c49182a3f090p+0, 0x1.c7c46b071f2bep-56},
    {0x1.a5503b23e255dp+0, -0x1.d2f6edb8d41e1p-54},
    {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54},
    {0x1.b7f76f2fb5e47p+0, -0x1.5584f7e54ac3bp-56},
    {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55},
    {0x1.cb720dcef9069p+0, 0x1.503cbd1e949dbp-56},
    {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55},
    {0x1.dfc97337b9b5fp+0, -0x1.1a5cd4f184b5cp-54},
    {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54},
    {0x1.f50765b6e4540p+0, 0x1.9d3e12dd8a18bp-54},
};
#endif

struct K(exponential) {
    real k, r, rest; /* e^x = 2^k (1 + r + rest) */
};

/* |x| <= 1e5 */
GM_INLINE struct K(exponential) K(exponential)(real x)
{
    const real k = (x * 0x1.71547652b82fep+0 + 0x1.8p52) - 0x1.8p52;
    const real near = x - k * 0x1.62e42ffp-1, small = -k * 0x1.718432a1b0e26p-35, r = near - small,
               less = (near - r) - small;
    const real z = r * r, zz = z * z;
    const real e = ((0x1.5555555555556p-3 + r * 0x1.5555555555555p-5) +
                    z * (0x1.11111111109b1p-7 + r * 0x1.6c16c16c167e0p-10)) +
                   zz * (((0x1.a01a01a7c5d00p-13 + r * 0x1.a01a01a47bfdap-16) +
                          z * (0x1.71de0da7cb47ap-19 + r * 0x1.27e4e1f0c0996p-22)) +
                         zz * (0x1.af38b95ff4cbdp-26 + r * 0x1.1f66e8758facdp-29));
    return (struct K(exponential)){k, r, ((less + less * r) + 0.5 * z) + z * r * e};
}

/* e^(x + lo) = 2^(k/32) e^r. Numbers below 2^-1022 are rounded by the last product alone. */
GM_INLINE real K(exp_of)(real x, real lo)
{
    const bool common = K(everywhere)(K(magnitude)(x) < 700);
    if (!common) {
        const mask above = x > 710, below = x < -746;
        x = K(pick)(above, K(constant)(710), K(pick)(below, K(constant)(-746), x));
        lo = K(pick)(K(either)(above, below), K(constant)(0), lo);
    }
    const real shifted = x * 0x1.71547652b82fep+5 + 0x1.8p52, k = shifted - 0x1.8p52;
    const real r = (x - k * 0x1.62e42ff000000p-6) - (k * -0x1.718432a1b0e26p-40 - lo), z = r * r;
    const pattern row_of = K(bits)(shifted) & 31;
    real table_hi = r, table_lo = r;
    for (int l = 0; l < GM_LANES; l++) {
        const double *row = gm_exponential_rows[K(pattern_lane)(row_of, l)];
        K(set_lane)(&table_hi, l, row[0]);
        K(set_lane)(&table_lo, l, row[1]);
    }
    const real e = (r + 0.5 * z) + z * r *
                                       ((0x1.5555555555555p-3 + r * 0x1.5555555555555p-5) +
                                        z * (0x1.1111111111111p-7 + r * 0x1.6c16c16c16c17p-10));
    const real value = table_hi + (table_lo + table_hi * e);
    if (common) { /* what follows would find the same, later */
        return K(number)(K(bits)(value) + ((K(bits)(shifted) - row_of) << 47));
    }
    /* the power of two in two steps: alone it may overflow */
    const real power = (K(number)(K(bits)(shifted) - row_of) - 0x1.8p52) * 0x1p-5,
               half = (power * 0.5 + 0x1.8p52) - 0x1.8p52;
    return value * K(power_of_two)(half) * K(power_of_two)(power - half);
}

GM_FUNCTION_OF_PASS real K(exp)(real x)
{
    return K(exp_of)(x, K(constant)(0));
}

/* part (e^x - 1), part a power of two, with a relative error of about 2^-56 */
GM_INLINE struct K(pair) K(less_one)(real x, double part)
{
    const struct K(exponential) e = K(exponential)(x);
    /* 2^k times the part, in two steps: k may be 1025, with a part of a quarter */
    const real power = K(power_of_two)(e.k - 2) * (4 * part);
    const struct K(pair) whole_part = K(any_sum)(power, K(constant)(-part)),
                         with_r = K(any_sum)(whole_part.hi, power * e.r);
    return K(sum)(with_r.hi, (with_r.lo + whole_part.lo) + power * e.rest);
}

GM_FUNCTION_OF_PASS real K(expm1)(real x)
{
    const real within = K(pick)(x > 710, K(constant)(710), K(pick)(x < -50, K(constant)(-50), x));
    const struct K(pair) m = K(less_one)(within, 0.5);
    return K(pick)(K(magnitude)(x) < 0x1p-54, x, 2 * (m.hi + m.lo));
}

/* A quarter of m: e^x may be beyond the largest number where half of it is not. */
GM_INLINE struct K(pair) K(quarter)(real x)
{
    const real size = K(magnitude)(x);
    return K(less_one)(K(pick)(size > 710.6, K(constant)(710.6), size), 0.25);
}

GM_FUNCTION_OF_PASS real K(sinh)(real x)
{
    const struct K(pair) m = K(quarter)(x);
    const mask large = m.hi > 0x1p60; /* there m/(m + 1) is 1 */
    const struct K(pair) over = {K(pick)(large, K(constant)(1), m.hi), K(pick)(large, K(constant)(0), m.lo)},
                         one = K(any_sum)(4 * over.hi, K(constant)(1)),
                         under = {one.hi, one.lo + 4 * over.lo}, ratio = K(quotient)(over, under),
                         both = K(sum)(m.hi, ratio.hi);
    const real sine = 2 * (both.hi + (both.lo + (m.lo + ratio.lo)));
    return K(pick)(K(magnitude)(x) < 0x1p-28, x, K(signed_as)(sine, x));
}

GM_FUNCTION_OF_PASS real K(cosh)(real x)
{
    const struct K(pair) m = K(quarter)(x), sum = K(any_sum)(m.hi, K(constant)(0.25));
    const mask large = m.hi > 0x1p60;
    const struct K(pair)
        one = {K(constant)(0.0625), K(constant)(0)},
        under = {K(pick)(large, K(constant)(0x1p60), sum.hi), K(pick)(large, K(constant)(0), sum.lo + m.lo)},
        ratio = K(quotient)(one, under), both = K(sum)(sum.hi, ratio.hi);
    return 2 * (both.hi + (both.lo + (sum.lo + m.lo + ratio.lo)));
}

GM_FUNCTION_OF_PASS real K(tanh)(real x)
{
    const real twice = 2 * K(magnitude)(x);
    const struct K(pair) m = K(less_one)(K(pick)(twice > 50, K(constant)(50), twice), 1),
                         sum = K(any_sum)(m.hi, K(constant)(2)),
                         ratio = K(quotient)(m, (struct K(pair)){sum.hi, sum.lo + m.lo});
    return K(pick)(K(magnitude)(x) < 0x1p-28, x, K(signed_as)(ratio.hi + ratio.lo, x));
}
