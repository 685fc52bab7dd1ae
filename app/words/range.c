/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ranges of values: how they are read, and which values they hold. */
#include "app/words/range.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/parameter.h"
#include "render/message.h"

size_t gm_word_first(const char *value)
{
    int depth = 0;
    size_t length = 0;
    for (; value[length]; length++) {
        const char here = value[length];
        depth += (here == '(' || here == '[') - (here == ')' || here == ']');
        if (depth == 0 && (here == ',' || (here == '.' && value[length + 1] == '.'))) {
            break;
        }
    }
    return length;
}

bool gm_range_is(const char *text)
{
    return text[gm_word_first(text)] == '.';
}

static double to_15_digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.15g", value);
    return strtod(text, NULL);
}

double gm_range_at(const struct gm_range *range, size_t index)
{
    const double last = (double)(range->count - 1), at = (double)index;
    if (index == 0 || index + 1 == range->count) {
        return index == 0 ? range->first : range->last;
    }
    if (range->logarithmic) {
        return to_15_digits(range->first * pow(range->last / range->first, at / last));
    }
    const double value = (range->first * (last - at) + range->last * at) / last;
    const double shorter = to_15_digits(value);
    return shorter == nextafter(value, shorter) ? shorter : value;
}

/* A piece of the text as a finite number. */
static bool read_end(const char *from, const char *to, double *value)
{
    char text[256];
    const size_t length = (size_t)(to - from);
    if (length >= sizeof text) {
        return false;
    }
    memcpy(text, from, length);
    text[length] = '\0';
    return gm_number_parse(text, value) && isfinite(*value);
}

/* What is wrong with it; NULL: nothing. */
static const char *fault_of(const struct gm_range *range, bool whole)
{
    if (!(range->first < range->last)) {
        return "a range ends above its start";
    }
    if (range->logarithmic && !(range->first > 0 || range->last < 0)) {
        return "a range of equal factors does not lead through 0";
    }
    if (whole) {
        /* evenly, all are whole if two neighbours are; by equal factors, few can be */
        const size_t tried = range->logarithmic ? range->count : 2;
        for (size_t i = 0; i < tried; i++) {
            const double value = gm_range_at(range, i);
            if (value != floor(value)) {
                return "not all values of this range are whole numbers";
            }
        }
    }
    return NULL;
}

bool gm_range_read(struct gm_range *range, const char *key, const char *text, bool whole, char *message)
{
    const char *between = strstr(text, ".."), *colon = strrchr(text, ':');
    const char *fault = "a range is START..END:COUNT, or START..END:logCOUNT for equal factors";
    double count = NAN;
    *range = (struct gm_range){0};
    if (between && colon && colon > between) {
        range->logarithmic = strncmp(colon + 1, "log", 3) == 0;
        const char *number = colon + 1 + (range->logarithmic ? 3 : 0);
        if (!read_end(text, between, &range->first) || !read_end(between + 2, colon, &range->last)) {
            fault = "the ends of a range are numbers";
        } else if (!gm_number_parse(number, &count) || !(count >= 2 && count <= 1e15) ||
                   count != floor(count)) {
            fault = "a range has a whole number of values, from 2 to 1e15";
        } else {
            range->count = (size_t)count;
            fault = fault_of(range, whole);
        }
    }
    if (fault) {
        snprintf(message, GM_MESSAGE, "%s=%.80s: %s", key, text, fault);
    }
    return !fault;
}
