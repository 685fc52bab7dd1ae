/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameters: how values are checked against their range, stored and written. */
#include "core/parameter.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static void store_double(const struct gm_parameter *row, void *owner, double value)
{
    void *place = (char *)owner + row->offset;
    if (row->type == GM_REAL) {
        *(double *)place = value;
    } else if (row->type == GM_INTEGER) {
        *(long *)place = (long)value;
    } else {
        *(int *)place = (int)value;
    }
}

static enum gm_parse store_text(const struct gm_parameter *row, void *owner, const char *text)
{
    const size_t length = strlen(text);
    if (length == 0 || length >= GM_TEXT_SIZE || strpbrk(text, row->names ? "\t\n\r" : ",\t\n\r")) {
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
    if (!isfinite(value) || value < row->lowest || value > row->highest ||
        (value > 0 && value < row->least)) {
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
    const void *place = (const char *)owner + row->offset;
    switch (row->type) {
    case GM_REAL:
        return *(const double *)place;
    case GM_INTEGER:
        return (double)*(const long *)place;
    case GM_TEXT:
        return text_number(place);
    default:
        return *(const int *)place;
    }
}

char *gm_parameter_choices(const struct gm_parameter *row, char *text, size_t size)
{
    size_t used = 0;
    bool fits = true;
    for (size_t i = 0; row->choices[i] && fits; i++) {
        fits = used + strlen(row->choices[i]) + sizeof ", , …" <= size;
        used +=
            (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", fits ? row->choices[i] : "…");
    }
    return text;
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
