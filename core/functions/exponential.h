/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exp, expm1, sinh, cosh and tanh, of  x = k log 2 + r,  |r| <= log(2)/2:
       e^x = 2^k (1 + r + r^2/2 + r^3 E(r)),        m = e^|x| - 1
       sinh = (m + m/(m + 1))/2,  cosh = (m + 1 + 1/(m + 1))/2,  tanh = m'/(m' + 2),  m' = e^2|x| - 1
   with two parts of log 2 (Cody & Waite 1980) and hi + lo where parts cancel. E interpolates at the Chebyshev
   points, of degree 9: the error is 2^-58 of e^x - 1. Included for each pass. */
struct K(exponential) {
    real k, r, rest; /* e^x = 2^k (1 + r + rest) */
};

/* |x| <= 1e5, and |lo| below a unit of x */
GM_INLINE struct K(exponential) K(exponential)(real x, real lo)
{
    const real k = (x * 0x1.71547652b82fep+0 + 0x1.8p52) - 0x1.8p52;
    const real near = x - k * 0x1.62e42ffp-1, small = -k * 0x1.718432a1b0e26p-35 - lo, r = near - small,
               less = (near - r) - small;
    const real z = r * r, zz = z * z;
    const real e = ((0x1.5555555555556p-3 + r * 0x1.5555555555555p-5) +
                    z * (0x1.11111111109b1p-7 + r * 0x1.6c16c16c167e0p-10)) +
                   zz * (((0x1.a01a01a7c5d00p-13 + r * 0x1.a01a01a47bfdap-16) +
                          z * (0x1.71de0da7cb47ap-19 + r * 0x1.27e4e1f0c0996p-22)) +
                         zz * (0x1.af38b95ff4cbdp-26 + r * 0x1.1f66e8758facdp-29));
    return (struct K(exponential)){k, r, ((less + less * r) + 0.5 * z) + z * r * e};
}

/* e^(x + lo). Numbers below 2^-1022 are rounded by the last product alone. */
GM_INLINE real K(exp_of)(real x, real lo)
{
    const mask above = x > 710, below = x < -746;
    x = K(pick)(above, K(constant)(710), K(pick)(below, K(constant)(-746), x));
    lo = K(pick)(K(either)(above, below), K(constant)(0), lo);
    const struct K(exponential) e = K(exponential)(x, lo);
    const struct K(pair) one = K(sum)(K(constant)(1), e.r);
    const real half = (e.k * 0.5 + 0x1.8p52) - 0x1.8p52;
    const real power = K(power_of_two)(half);
    return (one.hi * power + (one.lo + e.rest) * power) * K(power_of_two)(e.k - half);
}

GM_FUNCTION_OF_PASS real K(exp)(real x)
{
    return K(exp_of)(x, K(constant)(0));
}

/* part (e^x - 1), part a power of two, with a relative error of about 2^-56 */
GM_INLINE struct K(pair) K(less_one)(real x, double part)
{
    const struct K(exponential) e = K(exponential)(x, K(constant)(0));
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
