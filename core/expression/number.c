/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as text. */
#include "core/expression/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/reader.h"

bool gm_number_parse(const char *text, double *value)
{
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node;
    gm_formula_open(&graph);
    const bool is_number =
        gm_formula_read(&graph, text, 0, strlen(text), &(struct gm_scope){0}, &node, &fault);
    if (is_number) {
        *value = graph.nodes[node].value;
    }
    gm_formula_close(&graph);
    return is_number;
}

/* The shortest decimal that reads back to the same double: 0.02, 1e-6. */
static void format_decimal(double value, char *text, size_t size)
{
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
    if (fabs(value) < 1e6 && value == floor(value)) { /* these are never multiples of pi */
        snprintf(text, size, "%.0f", value);
        return text;
    }
    /* numerator * pi / denominator is printed only if it is short and exact to the bit */
    for (int denominator = 1; denominator <= 1000; denominator++) {
        const double multiple = value * denominator / M_PI;
        if (!(fabs(multiple) < 1e6 + 0.5)) {
            break;
        }
        const double numerator = (double)(long)(multiple + copysign(0.5, multiple));
        if (numerator == 0 || numerator * M_PI / denominator != value) {
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
        snprintf(text, size, "%spi%s", times, over);
        return text;
    }
    format_decimal(value, text, size);
    return text;
}
