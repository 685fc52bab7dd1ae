/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sin, cos and tan, of  x = q pi/2 + r + y,  |r| <= pi/4,  y a rest below a unit of r:
       |x| < pi/4        q = 0, r = x, y = 0
       |x| <= 2^15 pi/2  pi/2 = P1 + P2 + P3 of 38, 38 and 53 bits: q P1, q P2 and x - q P1 are exact, the error of
                         r + y is at most 2^-114; no double is nearer to a multiple of pi/2 than 2^-61
       beyond            x 2/pi modulo 4 by whole numbers, with 192 bits of 2/pi; r + y has 62 bits
       sin(r + y) = r - (r^3 S(r^2) + r^2 y/2 - y),  cos(r + y) = 1 - r^2/2 + (r^4 C(r^2) - r y)
   S and C are the polynomials of degree 5 with the least largest error (Remez's algorithm in 200 bits), 2^-57 of the
   value. Errors in units of the last place: sin 1/2 for the last sum, and .29 since r^3 S <= .11 sin r has three
   roundings; cos 1/2, and .29 since half of r^2, rounded, is a quarter unit. tan is a quotient of pairs: .87 measured.
   Cody & Waite, Software Manual for the Elementary Functions, 1980; Payne & Hanek, SIGNUM Newsl. 18 (1983) 19; Muller,
   Elementary Functions, 3rd ed. 2016, ch. 11. Included for each pass; functions that share an argument share their
   operations. */
#ifdef GM_PASS_SCALAR
__extension__ typedef unsigned __int128 gm_wide_word;

/* Reduces a finite |x| >= 2^15: x = q pi/2 + turned[0] + turned[1], q = turned[2] modulo 4; for others NaN. */
static __attribute__((noinline, cold, unused)) void gm_far_turned(double x, double turned[3])
{
    /* 2/pi after 64 bits of zeros */
    static const uint64_t two_over_pi[] = {
        0,
        0xa2f9836e4e441529U,
        0xfc2757d1f534ddc0U,
        0xdb6295993c439041U,
        0xfe5163abdebbc561U,
        0xb7246e3a424dd2e0U,
        0x06492eea09d1921cU,
        0xfe1deb1cb129a73eU,
        0xe88235f52ebb4484U,
        0xe99c7026b45f7e41U,
        0x3991d639835339f4U,
        0x9c845f8bbdf9283bU,
        0x1ff897ffde05980fU,
        0xef2f118b5a0a6d1fU,
        0x6d367ecf27cb09b7U,
        0x4f463f669e5fea2dU,
        0x7527bac7ebe5f17bU,
        0x3d0739f78a5292eaU,
        0x6bfb5fb11f8d5d08U,
        0x56033046fc7b6babU,
        0xf0cfbc209af4361dU,
    };
    const uint64_t bits = bits_scalar(x), m = (bits & ~(uint64_t)0 >> 12) | (uint64_t)1 << 52;
    const int exponent = (int)(bits >> 52 & 2047) - 1075;
    if (exponent > 971) {
        turned[0] = turned[1] = turned[2] = NAN;
        return;
    }
    /* bits of 2/pi before these make whole multiples of 4 */
    const int from = exponent - 2 + 64, at = from / 64, shift = from % 64;
    uint64_t w[3], product[3];
    for (int i = 0; i < 3; i++) {
        const uint64_t next = shift ? two_over_pi[at + i + 1] >> (64 - shift) : 0;
        w[i] = two_over_pi[at + i] << shift | next;
    }
    const gm_wide_word low = (gm_wide_word)m * w[2], middle = (gm_wide_word)m * w[1] + (uint64_t)(low >> 64);
    product[0] = m * w[0] + (uint64_t)(middle >> 64);
    product[1] = (uint64_t)middle;
    product[2] = (uint64_t)low;
    uint64_t q = product[0] >> 62, first = product[0] << 2 | product[1] >> 62,
             second = product[1] << 2 | product[2] >> 62;
    const bool above = first >> 63;
    if (above) { /* to the nearest multiple */
        q++;
        first = ~first;
        second = ~second;
    }
    const int zeros = __builtin_clzll(first | 1);
    first = zeros ? first << zeros | second >> (64 - zeros) : first;
    /* pi/2 in 64 bits; the product's first half is r in as many */
    const uint64_t r = (uint64_t)(((gm_wide_word)first * 0xc90fdaa22168c234) >> 64);
    const double unit = number_scalar((uint64_t)(1023 - 63 - zeros) << 52),
                 sign = above != (bits >> 63 != 0) ? -1 : 1;
    turned[0] = sign * unit * (double)(r & ~(uint64_t)0x7ff);
    turned[1] = sign * unit * (double)(r & 0x7ff);
    turned[2] = (double)(bits >> 63 ? (4 - q % 4) % 4 : q % 4);
}
#endif

struct K(turned) {
    real r, y, z; /* z = r^2 */
    pattern quarter;
};

GM_INLINE struct K(turned) K(turned)(real x)
{
    const real q = (x * 0x1.45f306dc9c883p-1 + 0x1.8p52) - 0x1.8p52;
    /* 38 bits each: their products with |q| <= 2^15 are exact, and so is the first difference. The last part is
       below any r that a double leaves. */
    const real first = x - q * 0x1.921fb54440000p+0, w = q * 0x1.68c234c4c0000p-39, r = first - w;
    real parts[3] = {r, (first - r) - (w + q * 0x1.98a2e03707345p-77), q};
    const mask far = K(other)(K(magnitude)(x) <= 0x1.921fb5p15);
    if (__builtin_expect(K(somewhere)(far), 0)) {
        for (int l = 0; l < GM_LANES; l++) {
            if (K(mask_lane)(far, l)) {
                double turned[3];
                gm_far_turned(K(lane)(x, l), turned);
                for (int i = 0; i < 3; i++) {
                    K(set_lane)(&parts[i], l, turned[i]);
                }
            }
        }
    }
    return (struct K(turned)){parts[0], parts[1], parts[0] * parts[0], K(bits)(parts[2] + 0x1.8p52)};
}

/* sin(r + y) = r - this */
GM_INLINE real K(below_r)(struct K(turned) t)
{
    const real z = t.z, zz = z * z;
    const real s = ((0x1.5555555555549p-3 - z * 0x1.111111110f887p-7) +
                    zz * (0x1.a01a019c131e6p-13 - z * 0x1.71de3578f07e4p-19)) +
                   zz * zz * (0x1.ae5e6720ab00ep-26 - z * 0x1.5d934003f37bep-33);
    return z * t.r * s + (0.5 * z * t.y - t.y);
}

GM_INLINE struct K(pair) K(cosine_of)(struct K(turned) t)
{
    const real z = t.z, zz = z * z, half = 0.5 * z, w = 1 - half;
    const real c = ((0x1.5555555555555p-5 - z * 0x1.6c16c16c16967p-10) +
                    zz * (0x1.a01a019f4eafap-16 - z * 0x1.27e4fa17d9864p-22)) +
                   zz * zz * (0x1.1eeb68e8b2371p-29 - z * 0x1.907da304ce723p-37);
    return (struct K(pair)){w, ((1 - w) - half) + (zz * c - t.r * t.y)};
}

GM_INLINE real K(cosine)(struct K(turned) t)
{
    const struct K(pair) c = K(cosine_of)(t);
    return c.hi + c.lo;
}

/* sin(x + quarters pi/2). Near 0 nothing is reduced, and there, as for one number, a single polynomial is enough: the
   same bits sooner. */
GM_INLINE real K(sine_after)(real x, uint64_t quarters)
{
    if (K(everywhere)(K(magnitude)(x) < 0x1.921fb5p-1)) {
        const struct K(turned) near = {x, K(constant)(0), x * x, K(bits)(x)};
        return quarters ? K(cosine)(near) : x - K(below_r)(near);
    }
    const struct K(turned) t = K(turned)(x);
    const pattern n = t.quarter + quarters;
#ifdef GM_PASS_SCALAR
    const real either = n & 1 ? K(cosine)(t) : t.r - K(below_r)(t);
#else
    const real either = K(blend)(-(n & 1), K(cosine)(t), t.r - K(below_r)(t));
#endif
    return K(turned_by)(either, (n & 2) << 62);
}

GM_INLINE real K(sin)(real x)
{
    return K(sine_after)(x, 0);
}

GM_INLINE real K(cos)(real x)
{
    return K(sine_after)(x, 1);
}

/* sin / cos, or -cos / sin after an odd quarter */
GM_FUNCTION_OF_PASS real K(tan)(real x)
{
    const struct K(turned) t = K(turned)(x);
    const struct K(pair) c = K(cosine_of)(t),
                         cosine = K(sum)(c.hi, c.lo - 0.5 * K(product)(t.r, t.r).lo), /* r^2 was rounded */
        sine = K(sum)(t.r, -K(below_r)(t));
    const pattern odd = -(t.quarter & 1);
    const struct K(pair) over = {K(blend)(odd, -cosine.hi, sine.hi), K(blend)(odd, -cosine.lo, sine.lo)},
                         under = {K(blend)(odd, sine.hi, cosine.hi), K(blend)(odd, sine.lo, cosine.lo)},
                         ratio = K(quotient)(over, under);
    return K(pick)(K(magnitude)(x) < 0x1p-28, x, ratio.hi + ratio.lo);
}
