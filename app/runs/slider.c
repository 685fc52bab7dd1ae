/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Round values for a parameter that keys move. */
#include "app/runs/session.h"
#include "core/basics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The value; for a negative step its size. */
static double size_of(const struct gm_parameter *row, const void *owner)
{
    double value = gm_parameter_get(row, owner);
    return value < 0 && row->lowest >= 0 ? -value : value;
}

/* The typical size of a linear parameter: its default's. */
static double usual_size(const struct gm_parameter *row)
{
    double standard = 0;
    gm_number_parse(row->standard, &standard);
    return isfinite(standard) && standard != 0 ? fabs(standard) : fmin(1, (row->highest - row->lowest) / 4);
}

/* A linear range more than WIDE times the typical size is bent like arsinh: linear near 0, logarithmic far
   from it. FAR times that size limits its ends. */
enum { WIDE = 50, FAR = 1000000 };

static bool is_bent(const struct gm_parameter *row)
{
    return !row->logarithmic && row->highest - row->lowest > WIDE * usual_size(row);
}

/* Sets the ends of a slider; returns false if the parameter has none. */
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
    if (is_bent(row)) { /* there is no use in 10^300 */
        *low = fmax(*low, -FAR * usual_size(row));
        *high = fmin(*high, FAR * usual_size(row));
    }
    return true;
}

/* The place of a value on a scale that is drawn evenly. */
static double to_scale(const struct gm_parameter *row, double value)
{
    return row->logarithmic ? log(value) : is_bent(row) ? asinh(value / usual_size(row)) : value;
}

double gm_slider_position(const struct gm_parameter *row, const void *owner)
{
    double value = size_of(row, owner), low, high;
    if (!slider_range(row, &low, &high)) {
        return -1;
    }
    double from = to_scale(row, low), to = to_scale(row, high);
    return fmin(fmax((to_scale(row, fmax(value, low)) - from) / (to - from), 0), 1);
}

/* Round values of about equal ratio, ten a decade. */
static const double rounds[] = {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10};
enum { ROUND_COUNT = GM_COUNT(rounds) };

static double next_by_ratio(double value, int direction)
{
    double decade = floor(log10(value) + 1e-9), scale = pow(10, decade), mantissa = value / scale;
    double near = 1e-6; /* values that differ by less are the same, read back from text */
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

/* The distance of the values of a linear slider: 1, 2 or 5 times a power of ten. Ranges are often far too
   wide, so it is a tenth of the value or of its default, whichever is larger. */
static double linear_step(const struct gm_parameter *row, double value)
{
    double raw = fmin(fmax(usual_size(row), fabs(value)) / 10, (row->highest - row->lowest) / 20);
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
    static const char *const answers[] = {"no", "yes", NULL};
    const char *const *choices = row->type == GM_BOOLEAN ? answers : row->choices;
    char present[GM_TEXT_SIZE];
    int count = 0, at = -1; /* an unusual word precedes the choices */
    gm_parameter_format(row, owner, present, sizeof present);
    for (; choices && choices[count]; count++) {
        at = strcmp(choices[count], present) == 0 ? count : at;
    }
    if (count < 2) {
        return false;
    }
    snprintf(text, GM_TEXT_SIZE, "%s",
             choices[direction > 0 ? (at + 1) % count
                     : at > 0      ? at - 1
                                   : count - 1]);
    return true;
}

/* The distance of fine values: a fortieth to a hundredth of the value, about a tenth of a step of
   `rounds`. */
static double fine_step(double value, int direction)
{
    double decade = floor(log10(value) + 1e-9), scale = pow(10, decade), mantissa = value / scale;
    double at = mantissa + direction * 1e-6; /* down from a border the finer distance counts */
    return scale * (at < 1 ? 0.01 : at < 2 ? 0.02 : at < 5 ? 0.05 : 0.1);
}

/* Writes a value as it would be typed; it has all its digits if the rounded value is out of range. */
static void write_value(const struct gm_parameter *row, double value, int digits, char *text)
{
    snprintf(text, GM_TEXT_SIZE, "%.*g", row->type == GM_INTEGER ? 15 : digits, value + 0.0); /* not -0 */
    const double rounded = strtod(text, NULL);
    if (rounded < row->lowest || rounded > row->highest) {
        gm_number_format(value, text, GM_TEXT_SIZE);
    }
}

bool gm_slider_next(const struct gm_parameter *row, const void *owner, int direction, bool fine,
                    char text[GM_TEXT_SIZE])
{
    if (row->type == GM_CHOICE || row->type == GM_BOOLEAN || row->type == GM_TEXT) {
        return next_choice(row, owner, direction, text);
    }
    double value = size_of(row, owner), next;
    if (row->logarithmic && value > 0) {
        next = fine ? next_by_step(value, fine_step(value, direction), direction)
                    : next_by_ratio(value, direction);
    } else if (row->logarithmic) {
        next = direction > 0 ? fmax(row->highest * 1e-10, row->type == GM_INTEGER ? 1 : 0) : 0;
    } else {
        next = next_by_step(value, linear_step(row, value) / (fine ? 10 : 1), direction);
    }
    if (row->type == GM_INTEGER) {
        next = fine ? value : next;
        next = direction > 0 ? fmax(value + 1, floor(next)) : fmin(value - 1, ceil(next));
    }
    next = fmin(fmax(next, row->lowest), row->highest);
    if (next == value) {
        return false;
    }
    write_value(row, next, 10, text);
    return true;
}

bool gm_slider_at(const struct gm_parameter *row, double position, char text[GM_TEXT_SIZE])
{
    double low, high;
    if (!slider_range(row, &low, &high)) {
        return false;
    }
    position = fmin(fmax(position, 0), 1);
    double from = to_scale(row, low), to = to_scale(row, high);
    const double place = from + position * (to - from);
    double value = row->logarithmic ? exp(place) : is_bent(row) ? usual_size(row) * sinh(place) : place;
    value = position <= 0 ? low : position >= 1 ? high : value;
    if (row->type == GM_INTEGER) {
        value = round(value);
    } else if (position > 0 && position < 1) {
        /* two digits of the value, or of the range if a slider shows no more */
        double size = row->logarithmic ? value
                      : is_bent(row)   ? fmax(fabs(value), usual_size(row))
                                       : high - low;
        double unit = pow(10, floor(log10(size)) - 1);
        value = round(value / unit) * unit;
    }
    value = fmin(fmax(value, row->lowest), row->highest);
    write_value(row, value, 6, text);
    return true;
}
