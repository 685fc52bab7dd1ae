/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sin x = (-1)^q sin(x - q pi), q = round(x / pi); pi in three parts (Cody & Waite), then the Taylor
   polynomial of degree 21, whose remainder on [-pi/2, pi/2] is 1e-18. No branches, so that a compiler turns
   the loop into vectors. */
#include "core/linear/sine.h"

#include <stdint.h>
#include <string.h>

#include "core/basics.h"

GM_CLONES void gm_sines(const double *restrict x, double *restrict sine, size_t count)
{
    const double to_integer = 0x1.8p52;
    for (size_t i = 0; i < count; i++) {
        const double shifted = x[i] * 0.318309886183790671538 + to_integer;
        uint64_t parity;
        memcpy(&parity, &shifted, sizeof parity);
        const double q = shifted - to_integer;
        /* 33 bits each of the first two parts: their products with |q| < 2^20 are exact */
        double r = x[i] - q * 0x1.921fb544p+1;
        r -= q * 0x1.0b4611a6p-33;
        r -= q * 0x1.3198a2e037073p-68;
        const double z = r * r;
        double p = 1.9572941063391261e-20;
        p = p * z - 8.2206352466243297e-18;
        p = p * z + 2.8114572543455208e-15;
        p = p * z - 7.6471637318198165e-13;
        p = p * z + 1.6059043836821615e-10;
        p = p * z - 2.5052108385441719e-08;
        p = p * z + 2.7557319223985893e-06;
        p = p * z - 1.9841269841269841e-04;
        p = p * z + 8.3333333333333333e-03;
        p = p * z - 1.6666666666666667e-01;
        double value = r + r * z * p;
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        bits ^= parity << 63;
        memcpy(&value, &bits, sizeof value);
        sine[i] = value;
    }
}
