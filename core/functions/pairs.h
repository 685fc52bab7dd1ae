/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as unevaluated sums hi + lo of two doubles, about 106 bits. With one rounding each:
       s = a + b,  e = (a - s) + b                        exact if |a| >= |b| or a = 0  (Dekker 1971)
       p = a b,    e = ((ah bh - p) + ah bl + al bh) + al bl,  a = ah + al,  ah of 26 bits
   Dekker, A floating-point technique for extending the available precision, Numer. Math. 18 (1971) 224. Without
   fused operations, so that every processor finds the same bits. Included for each pass. */
struct K(pair) {
    real hi, lo;
};

/* magnitude with the sign of x */
GM_INLINE real K(signed_as)(real magnitude, real x)
{
    return K(number)(K(bits)(magnitude) | (K(bits)(x) & (uint64_t)1 << 63));
}

/* 2^k for whole numbers -1023 < k < 1024: the sum with 1.5 2^52 holds k in its last bits */
GM_INLINE real K(power_of_two)(real k)
{
    return K(number)((K(bits)(k + 0x1.8p52) + 1023) << 52);
}

/* the first 26 bits of x */
GM_INLINE real K(head)(real x)
{
    return K(number)(K(bits)(x) & ~(uint64_t)0x7ffffff);
}

GM_INLINE struct K(pair) K(sum)(real larger, real smaller)
{
    const real s = larger + smaller;
    return (struct K(pair)){s, (larger - s) + smaller};
}

/* a sum of any two (Knuth 1969) */
GM_INLINE struct K(pair) K(any_sum)(real a, real b)
{
    const real s = a + b, of_b = s - a;
    return (struct K(pair)){s, (a - (s - of_b)) + (b - of_b)};
}

GM_INLINE struct K(pair) K(product)(real a, real b)
{
    const real p = a * b, ah = K(head)(a), bh = K(head)(b), al = a - ah, bl = b - bh;
    return (struct K(pair)){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

GM_INLINE struct K(pair) K(quotient)(struct K(pair) a, struct K(pair) b)
{
    const real q = a.hi / b.hi;
    const struct K(pair) p = K(product)(q, b.hi);
    return (struct K(pair)){q, ((((a.hi - p.hi) - p.lo) + a.lo) - q * b.lo) / b.hi};
}

/* the square root of a >= 0 */
GM_INLINE struct K(pair) K(root_of)(struct K(pair) a)
{
    const real root = K(root)(a.hi);
    const struct K(pair) square = K(product)(root, root);
    const real rest = (((a.hi - square.hi) - square.lo) + a.lo) / (root + root);
    return (struct K(pair)){root, K(pick)(root > 0, rest, K(constant)(0))};
}
