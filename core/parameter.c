/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameters: how numbers are read, checked against their range, stored and written. */
#include "core/parameter.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The grammar of numbers:
       sum     = product { (+|-) product }
       product = factor { (*|/) factor }
       factor  = [+|-] ( decimal | pi | sqrt ( sum ) | ( sum ) )
   Depth is bounded, so that hostile input cannot exhaust the stack. */

enum { DEEPEST = 64 };

struct reader {
    const char *at;
    int depth;
    bool failed;
};

static double read_sum(struct reader *reader);

static void skip_blanks(struct reader *reader)
{
    while (*reader->at == ' ') {
        reader->at++;
    }
}

static bool take(struct reader *reader, const char *word)
{
    skip_blanks(reader);
    size_t length = strlen(word);
    if (strncmp(reader->at, word, length) != 0) {
        return false;
    }
    reader->at += length;
    return true;
}

static double read_factor(struct reader *reader)
{
    if (++reader->depth > DEEPEST) {
        reader->failed = true;
    }
    double value = 0;
    if (reader->failed) {
        value = 0;
    } else if (take(reader, "-")) {
        value = -read_factor(reader);
    } else if (take(reader, "+")) {
        value = read_factor(reader);
    } else if (take(reader, "pi")) {
        value = M_PI;
    } else if (take(reader, "sqrt(")) {
        value = sqrt(read_sum(reader));
        reader->failed |= !take(reader, ")");
    } else if (take(reader, "(")) {
        value = read_sum(reader);
        reader->failed |= !take(reader, ")");
    } else if (isdigit((unsigned char)*reader->at) || *reader->at == '.') {
        /* strtod also reads hexadecimal floats, which nobody types on purpose */
        if (reader->at[0] == '0' && (reader->at[1] == 'x' || reader->at[1] == 'X')) {
            reader->failed = true;
            return 0;
        }
        char *end = NULL;
        value = strtod(reader->at, &end);
        reader->failed |= end == reader->at;
        reader->at = end;
    } else {
        reader->failed = true;
    }
    reader->depth--;
    return value;
}

static double read_product(struct reader *reader)
{
    double value = read_factor(reader);
    while (!reader->failed) {
        if (take(reader, "*")) {
            value *= read_factor(reader);
        } else if (take(reader, "/")) {
            value /= read_factor(reader);
        } else {
            break;
        }
    }
    return value;
}

static double read_sum(struct reader *reader)
{
    double value = read_product(reader);
    while (!reader->failed) {
        if (take(reader, "+")) {
            value += read_product(reader);
        } else if (take(reader, "-")) {
            value -= read_product(reader);
        } else {
            break;
        }
    }
    return value;
}

bool gm_number_parse(const char *text, double *value)
{
    struct reader reader = {.at = text};
    double result = read_sum(&reader);
    skip_blanks(&reader);
    if (reader.failed || *reader.at != '\0') {
        return false;
    }
    *value = result;
    return true;
}

/* The shortest decimal that reads back to the same double: 100, 0.02, 1e-6. */
static void format_decimal(double value, char *text, size_t size)
{
    if (fabs(value) < 1e6 && value == floor(value)) {
        snprintf(text, size, "%.0f", value);
        return;
    }
    char shortest[32] = "";
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(shortest, sizeof shortest, "%.*g", digits, value);
        if (strtod(shortest, NULL) == value) {
            break;
        }
    }
    char *exponent = strchr(shortest, 'e');
    if (!exponent) {
        snprintf(text, size, "%s", shortest);
        return;
    }
    *exponent = '\0';
    snprintf(text, size, "%se%d", shortest, atoi(exponent + 1));
}

char *gm_number_format(double value, char *text, size_t size)
{
    /* numerator * pi / denominator is worth saying only where it is short and exact to the bit */
    for (int denominator = 1; isfinite(value) && value != 0 && denominator <= 1000; denominator++) {
        double numerator = round(value * denominator / M_PI);
        if (numerator == 0 || fabs(numerator) > 1e6) {
            continue;
        }
        char times[32] = "";
        if (numerator == -1) {
            snprintf(times, sizeof times, "-");
        } else if (numerator != 1) {
            snprintf(times, sizeof times, "%.0f*", numerator);
        }
        char over[32] = "";
        if (denominator != 1) {
            snprintf(over, sizeof over, "/%d", denominator);
        }
        char candidate[80];
        snprintf(candidate, sizeof candidate, "%spi%s", times, over);
        double back = 0;
        if (gm_number_parse(candidate, &back) && back == value) {
            snprintf(text, size, "%s", candidate);
            return text;
        }
    }
    format_decimal(value, text, size);
    return text;
}

static void store_double(const struct gm_parameter *row, void *owner, double value)
{
    char *place = (char *)owner + row->offset;
    switch (row->type) {
    case GM_REAL:
        memcpy(place, &value, sizeof value);
        break;
    case GM_INTEGER: {
        long whole = (long)value;
        memcpy(place, &whole, sizeof whole);
        break;
    }
    case GM_CHOICE:
    case GM_BOOLEAN: {
        int index = (int)value;
        memcpy(place, &index, sizeof index);
        break;
    }
    case GM_TEXT:
        break;
    }
}

static enum gm_parse store_text(const struct gm_parameter *row, void *owner, const char *text)
{
    const size_t length = strlen(text);
    if (length == 0 || length >= GM_TEXT_SIZE || strpbrk(text, ",\t\n\r")) {
        return GM_NOT_UNDERSTOOD;
    }
    memcpy((char *)owner + row->offset, text, length + 1);
    return GM_PARSED;
}

/* FNV-1a, 32 bits */
static double text_number(const char *text)
{
    uint32_t hash = UINT32_C(2166136261);
    for (; *text; text++) {
        hash = (hash ^ (unsigned char)*text) * UINT32_C(16777619);
    }
    return hash;
}

static const char *const booleans[] = {"no", "yes", NULL};

static const char *const *words_of(const struct gm_parameter *row)
{
    return row->type == GM_BOOLEAN ? booleans : row->choices;
}

enum gm_parse gm_parameter_set(const struct gm_parameter *row, void *owner, const char *text)
{
    if (row->type == GM_TEXT) {
        return store_text(row, owner, text);
    }
    if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
        const char *const *words = words_of(row);
        for (int i = 0; words[i]; i++) {
            if (strcmp(words[i], text) == 0) {
                store_double(row, owner, i);
                return GM_PARSED;
            }
        }
        return GM_NOT_UNDERSTOOD;
    }
    if (row->automatic && strcmp(text, "auto") == 0) {
        store_double(row, owner, NAN);
        return GM_PARSED;
    }
    double value = 0;
    if (!gm_number_parse(text, &value)) {
        return GM_NOT_UNDERSTOOD;
    }
    if (!isfinite(value) || value < row->lowest || value > row->highest) {
        return GM_OUT_OF_RANGE;
    }
    if (row->type == GM_INTEGER && value != floor(value)) {
        return GM_NOT_UNDERSTOOD;
    }
    store_double(row, owner, value);
    return GM_PARSED;
}

enum gm_parse gm_parameter_put(const struct gm_parameter *row, void *owner, double value)
{
    char text[64];
    snprintf(text, sizeof text, "%.17g", value);
    return gm_parameter_set(row, owner, text);
}

double gm_parameter_get(const struct gm_parameter *row, const void *owner)
{
    const char *place = (const char *)owner + row->offset;
    double value = 0;
    switch (row->type) {
    case GM_REAL:
        memcpy(&value, place, sizeof value);
        break;
    case GM_INTEGER: {
        long whole = 0;
        memcpy(&whole, place, sizeof whole);
        value = (double)whole;
        break;
    }
    case GM_CHOICE:
    case GM_BOOLEAN: {
        int index = 0;
        memcpy(&index, place, sizeof index);
        value = index;
        break;
    }
    case GM_TEXT:
        value = text_number(place);
        break;
    }
    return value;
}

char *gm_parameter_format(const struct gm_parameter *row, const void *owner, char *text, size_t size)
{
    double value = gm_parameter_get(row, owner);
    if (row->type == GM_TEXT) {
        snprintf(text, size, "%s", (const char *)owner + row->offset);
        return text;
    }
    if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
        snprintf(text, size, "%s", words_of(row)[(int)value]);
        return text;
    }
    if (row->automatic && isnan(value)) {
        snprintf(text, size, "auto");
        return text;
    }
    if (row->type == GM_INTEGER) {
        snprintf(text, size, "%.0f", value);
        return text;
    }
    return gm_number_format(value, text, size);
}

void gm_parameters_reset(const struct gm_parameter *rows, size_t count, void *owner)
{
    for (size_t i = 0; i < count; i++) {
        gm_parameter_set(&rows[i], owner, rows[i].standard);
    }
}
