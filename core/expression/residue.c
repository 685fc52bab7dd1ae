/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/expression/residue.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

gm_residue gm_residue_power(gm_residue a, uint64_t n)
{
    gm_residue result = 1;
    for (; n; n /= 2, a = gm_residue_times(a, a)) {
        result = n % 2 ? gm_residue_times(result, a) : result;
    }
    return result;
}

/* Euclid's algorithm: `inverse` times a and `rest` differ by a multiple of the prime. The power a^(p - 2) takes eight
   times as long, which the opening of a scene shows. */
gm_residue gm_residue_inverse(gm_residue a)
{
    uint64_t before = GM_PRIME, rest = a;
    int64_t inverse_before = 0, inverse = a != 0;
    while (rest > 1) {
        const uint64_t quotient = before / rest, next = before % rest;
        const int64_t inverse_next = inverse_before - (int64_t)quotient * inverse;
        before = rest;
        rest = next;
        inverse_before = inverse;
        inverse = inverse_next;
    }
    return (gm_residue)(inverse < 0 ? inverse + (int64_t)GM_PRIME : inverse);
}

/* Steele, Lea, Flood: SplitMix64 */
uint64_t gm_mixed(uint64_t x)
{
    x += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

/* The decimal m 10^n of up to 15 digits that is read as this double. */
static bool find_decimal(double size, gm_residue *residue)
{
    char text[32];
    uint64_t digits = 0;
    snprintf(text, sizeof text, "%.14e", size);
    const char *c = text;
    for (; *c != 'e'; c++) {
        digits = *c >= '0' && *c <= '9' ? 10 * digits + (uint64_t)(*c - '0') : digits;
    }
    const long exponent = strtol(c + 1, NULL, 10) - 14;
    const gm_residue power = gm_residue_power(10, (uint64_t)labs(exponent));
    *residue = gm_residue_times(digits, exponent < 0 ? gm_residue_inverse(power) : power);
    return strtod(text, NULL) == size;
}

bool gm_residue_of(double value, gm_residue *residue)
{
    const double largest = 0x1p36, size = fabs(value);
    bool found = true;
    if (!isfinite(value)) {
        *residue = 0;
        return false;
    }
    gm_residue result = 0;
    double rest = size, p[2] = {1, floor(size)}, q[2] = {0, 1}; /* the last two continued fractions */
    while (p[1] * q[1] < largest && fabs(p[1] / q[1] - size) > 0x1p-52 * size) {
        rest = 1 / (rest - floor(rest));
        const double next[] = {floor(rest) * p[1] + p[0], floor(rest) * q[1] + q[0]};
        p[0] = p[1];
        q[0] = q[1];
        p[1] = next[0];
        q[1] = next[1];
    }
    if (p[1] * q[1] < largest) {
        result = gm_residue_times((gm_residue)p[1], gm_residue_inverse((gm_residue)q[1]));
    } else if (!find_decimal(size,
                             &result)) { /* m 2^e: 2^61 = 1 in the field, so that 1 + 2^-52 would be 513 */
        found = false;
        int exponent = 0;
        uint64_t whole = (uint64_t)ldexp(frexp(size, &exponent), 53);
        exponent -= 53;
        for (; whole % 2 == 0; whole /= 2) {
            exponent++;
        }
        const int small = (exponent % 60 + 60) % 60;
        result = gm_residue_times(gm_mixed(gm_mixed(whole) ^ (uint64_t)(exponent - small)) % GM_PRIME,
                                  (gm_residue)1 << small);
    }
    *residue = value < 0 ? gm_residue_minus(result) : result;
    return found;
}

static int64_t divisor(int64_t a, int64_t b)
{
    while (b) {
        const int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return llabs(a);
}

/* Euclid's algorithm for the prime and a, stopped at the first remainder below 2^20: a = remainder / factor. Of random
   residues one in two million is such a fraction. Nothing divides both. */
static bool find_fraction(gm_residue a, int64_t *numerator, int64_t *denominator)
{
    const int64_t bound = (int64_t)1 << 20;
    int64_t remainders[] = {(int64_t)GM_PRIME, (int64_t)a}, factors[] = {0, 1};
    while (remainders[1] >= bound) {
        const int64_t quotient = remainders[0] / remainders[1],
                      remainder = remainders[0] - quotient * remainders[1],
                      factor = factors[0] - quotient * factors[1];
        remainders[0] = remainders[1];
        factors[0] = factors[1];
        remainders[1] = remainder;
        factors[1] = factor;
    }
    *numerator = factors[1] < 0 ? -remainders[1] : remainders[1];
    *denominator = llabs(factors[1]);
    return *denominator < bound;
}

bool gm_residues_whole(const gm_residue *residues, size_t count, double *whole)
{
    const int64_t largest = (int64_t)1 << 53;
    int64_t common = 1, numerator, denominator;
    gm_residue first = 0;
    for (size_t i = 0; i < count && !first; i++) {
        first = residues[i] ? gm_residue_inverse(residues[i]) : 0;
    }
    for (size_t i = 0; i < count; i++) {
        if (!find_fraction(gm_residue_times(first, residues[i]), &numerator, &denominator)) {
            return false;
        }
        const int64_t more = denominator / divisor(common, denominator);
        if (common > largest / more) {
            return false;
        }
        common *= more;
    }
    /* one of them is the common denominator itself, of which no factor divides all the others */
    for (size_t i = 0; i < count; i++) {
        find_fraction(gm_residue_times(first, residues[i]), &numerator, &denominator);
        if (llabs(numerator) > largest / (common / denominator)) {
            return false;
        }
        whole[i] = (double)(numerator * (common / denominator));
    }
    return true;
}
