/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/slider.h"

#include <math.h>
#include <stdio.h>

/* The value; of a step that runs backwards its size. */
static double size_of(const struct gm_parameter *row, const void *owner)
{
    double value = gm_parameter_get(row, owner);
    return value < 0 && row->lowest >= 0 ? -value : value;
}

/* The ends of a slider; false where there is none. */
static bool slider_range(const struct gm_parameter *row, double *low, double *high)
{
    *low = row->lowest;
    *high = row->highest;
    if (row->type == GM_CHOICE || row->type == GM_BOOLEAN || row->type == GM_TEXT || !(*high > *low) ||
        !isfinite(*high - *low)) {
        return false;
    }
    if (row->logarithmic && *low <= 0) { /* a range from 0 on has no logarithm; ten decades stand for it */
        *low = *high * 1e-10;
    }
    return true;
}

double gm_slider_position(const struct gm_parameter *row, const void *owner)
{
    double value = size_of(row, owner), low, high;
    if (!slider_range(row, &low, &high)) {
        return -1;
    }
    double position =
        row->logarithmic ? log(fmax(value, low) / low) / log(high / low) : (value - low) / (high - low);
    return fmin(fmax(position, 0), 1);
}

/* Round values of about equal ratio, ten a decade. */
static const double rounds[] = {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
enum { ROUND_COUNT = sizeof rounds / sizeof *rounds };

static double next_by_ratio(double value, int direction)
{
    double decade = floor(log10(value) + 1e-9), scale = pow(10, decade), mantissa = value / scale;
    double near = 1e-6; /* what differs less is the same value, read back from its text */
    for (int i = 0; direction > 0 && i < ROUND_COUNT; i++) {
        if (rounds[i] > mantissa * (1 + near)) {
            return rounds[i] * scale;
        }
    }
    for (int i = ROUND_COUNT - 1; direction < 0 && i >= 0; i--) {
        if (rounds[i] < mantissa * (1 - near)) {
            return rounds[i] * scale;
        }
    }
    return direction > 0 ? 12 * scale : 0.8 * scale;
}

/* The distance of the values of a linear slider: 1, 2 or 5 times a power of ten. Ranges are often far wider
   than what is of use, so it is a tenth of the value or of its default, whichever is larger. */
static double linear_step(const struct gm_parameter *row, double value)
{
    double range = row->highest - row->lowest, standard = 0;
    gm_number_parse(row->standard, &standard);
    double size = isfinite(standard) && standard != 0 ? fabs(standard) : fmin(1, range / 4);
    double raw = fmin(fmax(size, fabs(value)) / 10, range / 20);
    double scale = pow(10, floor(log10(raw) + 1e-9)), mantissa = raw / scale;
    return scale * (mantissa < 1.5 ? 1 : mantissa < 3.5 ? 2 : mantissa < 7.5 ? 5 : 10);
}

static double next_by_step(double value, double step, int direction)
{
    double count = value / step, near = 1e-6;
    return step * (direction > 0 ? floor(count + near) + 1 : ceil(count - near) - 1);
}

static bool next_choice(const struct gm_parameter *row, const void *owner, int direction, char *text)
{
    int count = 0, at = (int)gm_parameter_get(row, owner);
    if (row->type == GM_BOOLEAN) {
        snprintf(text, GM_VALUE_TEXT, "%s", at ? "no" : "yes");
        return true;
    }
    while (row->choices[count]) {
        count++;
    }
    if (count < 2) {
        return false;
    }
    snprintf(text, GM_VALUE_TEXT, "%s", row->choices[(at + (direction > 0 ? 1 : count - 1)) % count]);
    return true;
}

bool gm_slider_next(const struct gm_parameter *row, const void *owner, int direction,
                    char text[GM_VALUE_TEXT])
{
    if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
        return next_choice(row, owner, direction, text);
    }
    if (row->type == GM_TEXT) {
        return false;
    }
    double value = size_of(row, owner), next;
    if (row->logarithmic && value > 0) {
        next = next_by_ratio(value, direction);
    } else if (row->logarithmic) {
        next = direction > 0 ? fmax(row->highest * 1e-10, row->type == GM_INTEGER ? 1 : 0) : 0;
    } else {
        next = next_by_step(value, linear_step(row, value), direction);
    }
    if (row->type == GM_INTEGER) {
        next = direction > 0 ? fmax(value + 1, floor(next)) : fmin(value - 1, ceil(next));
    }
    next = fmin(fmax(next, row->lowest), row->highest);
    if (next == value) {
        return false;
    }
    snprintf(text, GM_VALUE_TEXT, row->type == GM_INTEGER ? "%.0f" : "%.10g", next == 0 ? 0.0 : next);
    return true;
}

bool gm_slider_at(const struct gm_parameter *row, double position, char text[GM_VALUE_TEXT])
{
    double low, high;
    if (!slider_range(row, &low, &high)) {
        return false;
    }
    position = fmin(fmax(position, 0), 1);
    double value = row->logarithmic ? low * pow(high / low, position) : low + position * (high - low);
    if (row->type == GM_INTEGER) {
        value = round(value);
    } else if (position > 0 && position < 1) {
        /* two digits of the value, or of the range where that is all a slider can tell */
        double unit = pow(10, floor(log10(row->logarithmic ? fabs(value) : high - low)) - 1);
        value = round(value / unit) * unit;
    }
    value = fmin(fmax(value, row->lowest), row->highest);
    snprintf(text, GM_VALUE_TEXT, row->type == GM_INTEGER ? "%.0f" : "%.6g", value == 0 ? 0.0 : value);
    return true;
}
