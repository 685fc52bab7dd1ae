/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ticks of an axis: round values, multiples of pi, powers of ten, and their labels. */
#include "render/layout/panel.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define MINUS "\u2212"

/* A tick may lie outside its range by this share of a step: bounds are rarely exact multiples. */
static const double slack = 1e-6;

/* A log axis with more decades shows powers of ten alone. */
static const double few_decades = 1.5;

void gm_axis_shown(const struct gm_axis *axis, double *low, double *high)
{
    const bool log = axis->scale == GM_LOG;
    const bool spans = isfinite(axis->low) && isfinite(axis->high) && axis->high > axis->low &&
                       isfinite(axis->high - axis->low) && (!log || axis->low > 0.0);
    *low = spans ? axis->low : log ? 0.1 : 0.0;
    *high = spans ? axis->high : 1.0;
}

/* Returns mantissa * 10^exponent, as exact as can be. */
static double scaled(double mantissa, int exponent)
{
    return exponent < 0 ? mantissa / pow(10.0, -exponent) : mantissa * pow(10.0, exponent);
}

/* Returns the number of multiples of step in the range; the first is *first. */
static double multiples(double low, double high, double step, double *first)
{
    *first = ceil(low / step - slack);
    return floor(high / step + slack) - *first + 1.0;
}

static size_t fill_multiples(double low, double high, double mantissa, int exponent, size_t max,
                             double *values)
{
    double first;
    const double count = multiples(low, high, scaled(mantissa, exponent), &first);
    if (!(count >= 1.0 && count <= (double)max)) {
        return 0;
    }
    for (size_t i = 0; i < (size_t)count; i++) {
        values[i] = scaled((first + (double)i) * mantissa, exponent);
    }
    return (size_t)count;
}

/* Takes the first of the familiar steps that gives at least that many ticks; returns 0 if none does. */
static size_t first_step(double low, double high, int exponent, size_t least, size_t max, double *values)
{
    static const double familiar[] = {1.0, 2.0, 5.0, 10.0, 20.0, 50.0};
    for (size_t i = 0; i < sizeof familiar / sizeof *familiar; i++) {
        const size_t count = fill_multiples(low, high, familiar[i], exponent, max, values);
        if (count >= least) {
            return count;
        }
    }
    return 0;
}

static bool spans(double low, double high, const double *values, size_t count)
{
    const double close = slack * (high - low);
    return count > 1 && fabs(values[0] - low) < close && fabs(values[count - 1] - high) < close;
}

static size_t ticks_linear(double low, double high, size_t max, double *values)
{
    static const double further[] = {1.5, 2.5, 3.0, 4.0, 6.0, 8.0, 15.0, 25.0, 30.0, 40.0};
    const double span = high - low;
    if (span < 64.0 * DBL_EPSILON * fmax(fabs(low), fabs(high)) || !isfinite(span)) {
        return 0; /* the labels of such values would be equal */
    }
    const int exponent = (int)floor(log10(span / (double)max));
    size_t count = first_step(low, high, exponent, 3, max, values);
    if (count > 3 || max < 3 || spans(low, high, values, count)) {
        return count > 0 ? count : first_step(low, high, exponent, 1, max, values);
    }

    /* Less familiar steps, if the others give too few ticks, or if both ends of the axis then have one. */
    for (size_t i = 0; i < sizeof further / sizeof *further; i++) {
        double others[GM_TICK_MAX];
        const size_t other = fill_multiples(low, high, further[i], exponent, max, others);
        if (other >= 3 && (count == 0 || spans(low, high, others, other))) {
            memcpy(values, others, other * sizeof *values);
            return other;
        }
    }
    return count > 0 ? count : first_step(low, high, exponent, 1, max, values);
}

static size_t ticks_pi(double low, double high, size_t max, double *values)
{
    static const double steps[] = {1.0 / 8, 1.0 / 4, 1.0 / 2, 1.0},
                        further[] = {1.0 / 6, 1.0 / 3, 2.0 / 3, 3.0 / 4};
    const double from = low / PI, to = high / PI;
    if ((to - from) * 8.0 < 3.0) {
        return ticks_linear(low, high, max, values);
    }
    size_t count = 0;
    for (size_t i = 0; i < sizeof steps / sizeof *steps && count == 0; i++) {
        count = fill_multiples(from, to, steps[i], 0, max, values);
    }
    for (size_t i = 0; i < sizeof further / sizeof *further && count < 3 && to - from < 4.0; i++) {
        double first;
        const double n = multiples(from, to, further[i], &first);
        if (n >= 3.0 && n <= (double)max) {
            count = fill_multiples(from, to, further[i], 0, max, values);
        }
    }
    if (count == 0) {
        count = ticks_linear(from, to, max, values);
    }
    for (size_t i = 0; i < count; i++) {
        values[i] *= PI;
    }
    return count;
}

/* Gives values mantissa * 10^k for the given mantissas. Returns their number; 0 if it exceeds max. */
static size_t fill_mantissas(double low, double high, const double *mantissas, size_t mantissa_count,
                             size_t max, double *values)
{
    size_t count = 0;
    const int from = (int)floor(log10(low)) - 1, to = (int)ceil(log10(high)) + 1;
    for (int k = from; k <= to; k++) {
        for (size_t i = 0; i < mantissa_count; i++) {
            const double value = scaled(mantissas[i], k);
            if (value < low * (1.0 - slack) || value > high * (1.0 + slack)) {
                continue;
            }
            if (count == max) {
                return 0;
            }
            values[count++] = value;
        }
    }
    return count;
}

static size_t ticks_log(double low, double high, size_t max, double *values)
{
    static const double one[] = {1.0}, one_three[] = {1.0, 3.0}, one_two_five[] = {1.0, 2.0, 5.0},
                        one_two_three_five[] = {1.0, 2.0, 3.0, 5.0};
    static const struct {
        const double *mantissas;
        size_t count;
    } sets[] = {{one, 1}, {one_three, 2}, {one_two_five, 3}, {one_two_three_five, 4}};
    static const int strides[] = {1, 2, 3, 4, 5, 10, 20, 50, 100, 200};
    const double decades = log10(high / low);
    size_t few = 0;
    if (decades > few_decades) {
        for (size_t i = 0; i < sizeof strides / sizeof *strides; i++) {
            double first, exponents[GM_TICK_MAX];
            const double stride = strides[i];
            const double n = multiples(log10(low), log10(high), stride, &first);
            if (!(n >= 1.0 && n <= (double)max)) {
                continue;
            }
            few = fill_multiples(log10(low), log10(high), stride, 0, max, exponents);
            for (size_t k = 0; k < few; k++) {
                values[k] = scaled(1.0, (int)lround(exponents[k]));
            }
            break;
        }
        if (few >= 3 || max < 3) {
            return few;
        }
    }
    for (size_t i = 0; decades < 4.0 && i < sizeof sets / sizeof *sets; i++) {
        const size_t count = fill_mantissas(low, high, sets[i].mantissas, sets[i].count, max, values);
        if (count >= 3) {
            return count;
        }
    }
    if (decades < few_decades) {
        return ticks_linear(low, high, max, values);
    }
    if (few > 0) { /* the values were overwritten */
        return fill_mantissas(low, high, one, 1, max, values);
    }
    return 0;
}

size_t gm_ticks(const struct gm_axis *axis, size_t max, double *values)
{
    double low, high;
    gm_axis_shown(axis, &low, &high);
    max = max < GM_TICK_MAX ? max : GM_TICK_MAX;
    if (max == 0) {
        return 0;
    }
    const size_t own = axis->tick_count;
    if (own > 0 && own <= max && axis->ticks[0] >= low && axis->ticks[own - 1] <= high) {
        memcpy(values, axis->ticks, own * sizeof *values);
        return own;
    }
    const double least = fmax(low, axis->least_tick), largest = fmin(high, axis->largest_tick);
    if (axis->least_tick < axis->largest_tick && least < largest) {
        low = least;
        high = largest;
    }
    switch (axis->scale) {
    case GM_LOG:
        return ticks_log(low, high, max, values);
    case GM_PI:
        return ticks_pi(low, high, max, values);
    case GM_LINEAR:
        break;
    }
    return ticks_linear(low, high, max, values);
}

/* Labels. */

struct writer {
    char *text;
    size_t size, length;
};

static void put(struct writer *writer, const char *text)
{
    const size_t length = strlen(text);
    if (writer->length + length >= writer->size) {
        return; /* whole characters or nothing */
    }
    memcpy(writer->text + writer->length, text, length + 1);
    writer->length += length;
}

static void put_number(struct writer *writer, int decimals, double value)
{
    char digits[64];
    snprintf(digits, sizeof digits, "%.*f", decimals, fabs(value));
    if (value < 0.0 && strtod(digits, NULL) != 0.0) {
        put(writer, MINUS);
    }
    put(writer, digits);
}

static void put_power(struct writer *writer, int exponent)
{
    static const char *const superscripts[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                               "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    char digits[16];
    put(writer, "10");
    if (exponent == 1) {
        return;
    }
    if (exponent < 0) {
        put(writer, "\u207b");
    }
    snprintf(digits, sizeof digits, "%d", abs(exponent));
    for (const char *digit = digits; *digit != '\0'; digit++) {
        put(writer, superscripts[*digit - '0']);
    }
}

/* Returns the decimals that a multiple of step needs. */
static int decimals_of(double step)
{
    for (int decimals = 0; decimals < 15; decimals++) {
        const double shifted = scaled(step, decimals);
        if (fabs(shifted - round(shifted)) < 1e-6 * shifted) {
            return decimals;
        }
    }
    return 15;
}

/* Writes mantissa x 10^n without a mantissa of 1. */
static void put_scientific(struct writer *writer, double value, double step)
{
    int exponent = (int)floor(log10(fabs(value)) + 1e-9);
    const double mantissa = scaled(value, -exponent);
    const int decimals = decimals_of(scaled(step, -exponent));
    if (decimals == 0 && fabs(fabs(mantissa) - 1.0) < 1e-9) {
        if (value < 0.0) {
            put(writer, MINUS);
        }
    } else {
        put_number(writer, decimals < 6 ? decimals : 6, mantissa);
        put(writer, "×");
    }
    put_power(writer, exponent);
}

static void format_linear(struct writer *writer, double value, double step)
{
    if (fabs(value) < 1e-9 * step) {
        put(writer, "0");
        return;
    }
    if (step >= 1e4 || (step < 1e-4 && fabs(value) < 1e-2)) {
        put_scientific(writer, value, step);
    } else {
        put_number(writer, decimals_of(step), value);
    }
}

static void format_pi(struct writer *writer, double value, double step)
{
    static const int denominators[] = {1, 2, 3, 4, 6, 8};
    if (fabs(value) < 1e-9 * step) {
        put(writer, "0");
        return;
    }
    for (size_t i = 0; i < sizeof denominators / sizeof *denominators; i++) {
        char text[16];
        const double numerator = round(fabs(value) / PI * denominators[i]);
        const double error = fabs(numerator * PI / denominators[i] - fabs(value));
        if (numerator == 0.0 || error > 1e-9 * fabs(value) || error > 1e-3 * step) {
            continue;
        }
        if (value < 0.0) {
            put(writer, MINUS);
        }
        if (numerator >= 1e5) {
            put_scientific(writer, numerator, 1.0 + round(fmin(step / PI, numerator)));
        } else if (numerator != 1.0) {
            put_number(writer, 0, numerator);
        }
        put(writer, "π");
        if (denominators[i] != 1) {
            snprintf(text, sizeof text, "/%d", denominators[i]);
            put(writer, text);
        }
        return;
    }
    format_linear(writer, value, step);
}

static void format_log(struct writer *writer, double value, double step)
{
    const double exponent = log10(fabs(value));
    if (step >= 1.0 - slack && fabs(exponent - round(exponent)) < 1e-9) {
        if (round(exponent) == 0.0) {
            put(writer, "1");
        } else {
            put_power(writer, (int)lround(exponent));
        }
        return;
    }
    const int leading = (int)floor(exponent + 1e-9);
    /* All digits of the value: ticks are round, but in a narrow range they have more than one digit. */
    const int digits = 1 + decimals_of(scaled(value, -leading));
    if (leading < -2 || leading > 4) {
        put_scientific(writer, value, scaled(1.0, leading + 1 - digits));
        return;
    }
    const int decimals = digits - 1 - leading;
    put_number(writer, decimals > 0 ? decimals : 0, value);
}

void gm_tick_format(enum gm_scale scale, double value, double step, char *text, size_t size)
{
    struct writer writer = {text, size, 0};
    if (size == 0) {
        return;
    }
    text[0] = '\0';
    if (!isfinite(value)) {
        return;
    }
    step = isfinite(step) && step != 0.0 ? fabs(step) : fmax(fabs(value), 1.0);
    if (scale == GM_LOG && value > 0.0) {
        format_log(&writer, value, step);
    } else if (scale == GM_PI) {
        format_pi(&writer, value, step);
    } else {
        format_linear(&writer, value, step);
    }
}
