/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss and Newton's iteration: with the residuals F of the conditions at the decimals x,
       x := x - J^+ F,   J = dF / dx,
   J^+ the pseudo-inverse, so that each step is the shortest one. x and F have 77 digits, J and its inverse
   those of a double: an iteration gains about a dozen. The columns of J are differences, of the whole scheme
   as it is made of its text: what a decimal stands for, in a let, a base or a tableau, need not be known
   here. P. Deuflhard, Newton Methods for Nonlinear Problems (2004), section 4.4. */
#include "core/ode/user/polish.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "core/memory.h"
#include "core/theory/theory.h"

/* The decimals, their current values, and the conditions on them. */
struct polishing {
    const struct gm_user_scheme_source *source;
    struct gm_polish *polish;
    struct gm_decimals decimals;
    struct gm_ball *x;
    struct gm_row_sums sums; /* the row sums of the moved decimals */
    bool counted;            /* the number of conditions is known */
    struct gm_fault *fault;
};

__attribute__((format(printf, 2, 3))) static void *fail(struct polishing *polishing, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(polishing->fault->sentence, sizeof polishing->fault->sentence, format, arguments);
    va_end(arguments);
    polishing->fault->offset = 0;
    return NULL;
}

static void *no_memory(struct polishing *polishing)
{
    *polishing->fault = (struct gm_fault){0};
    return NULL;
}

/* Returns the scheme with x for its decimals; NULL with a fault. */
static const struct gm_scheme *scheme_at(struct polishing *polishing)
{
    struct gm_user_scheme_source source = *polishing->source;
    struct gm_decimals decimals = polishing->decimals;
    decimals.instead = polishing->x;
    source.decimals = &decimals;
    return gm_user_scheme_open(&source, polishing->fault);
}

/* Returns F at x; the caller frees. NULL with a fault. */
static struct gm_ball *residuals(struct polishing *polishing)
{
    struct gm_polish *polish = polishing->polish;
    const struct gm_scheme *scheme = scheme_at(polishing);
    if (!scheme) {
        return NULL;
    }
    size_t count = 0;
    struct gm_ball *all = gm_theory_residuals(scheme->exact, polish->order, polish->claims & GM_SYMPLECTIC,
                                              polish->claims & GM_SYMMETRIC, &count);
    gm_user_scheme_close(scheme);
    if (!all) {
        return no_memory(polishing);
    }
    if (polishing->counted && count != polish->conditions) {
        free(all);
        return fail(polishing,
                    "a coefficient vanishes at some of the numbers near these, and conditions with it");
    }
    polish->conditions = count;
    polishing->counted = true;
    return all;
}

/* Returns the largest residual; its doubt comes from the rows, as the decimals are exact here. */
static double largest(struct gm_polish *polish, const struct gm_ball *all)
{
    double size = 0;
    polish->doubt = 0;
    for (size_t i = 0; i < polish->conditions; i++) {
        const double residual = fabs(gm_ball_midpoint(all[i]));
        if (isnan(residual)) {
            return INFINITY;
        }
        size = fmax(size, residual);
        polish->doubt = fmax(polish->doubt, all[i].radius);
    }
    return size;
}

/* Computes J, with rows of zeros below if there are more decimals than conditions. */
static bool differentiate(struct polishing *polishing, const struct gm_ball *here, gsl_matrix *jacobian)
{
    const double step = 1e-30;
    gsl_matrix_set_zero(jacobian);
    for (size_t k = 0; k < polishing->decimals.count; k++) {
        const struct gm_ball kept = polishing->x[k];
        polishing->x[k] = gm_ball_add(kept, gm_ball_of(step));
        struct gm_ball *there = residuals(polishing);
        polishing->x[k] = kept;
        if (!there) {
            return false;
        }
        for (size_t i = 0; i < polishing->polish->conditions; i++) {
            gsl_matrix_set(jacobian, i, k, gm_ball_midpoint(gm_ball_subtract(there[i], here[i])) / step);
        }
        free(there);
    }
    return true;
}

/* x := x - J^+ F, J = U diag(values) V'. Where F hardly changes along a direction, it is that of a free
   parameter. */
static void move(struct polishing *polishing, const struct gm_ball *here, const gsl_matrix *u,
                 const gsl_matrix *v, const gsl_vector *values)
{
    const double least = 1e-9 * gsl_vector_get(values, 0);
    for (size_t k = 0; k < values->size && gsl_vector_get(values, k) > least; k++) {
        double along = 0;
        for (size_t i = 0; i < polishing->polish->conditions; i++) {
            along += gsl_matrix_get(u, i, k) * gm_ball_midpoint(here[i]);
        }
        along /= gsl_vector_get(values, k);
        for (size_t i = 0; i < polishing->decimals.count; i++) {
            polishing->x[i] = gm_ball_subtract(polishing->x[i], gm_ball_of(along * gsl_matrix_get(v, i, k)));
            polishing->x[i].radius = 0; /* wherever it is, it is a number */
        }
    }
}

static bool iterate(struct polishing *polishing, gsl_matrix *u, gsl_matrix *v, gsl_vector *values)
{
    enum { ITERATIONS = 40 };
    const double solved = 1e-45, hopeless = 1e3;
    struct gm_polish *polish = polishing->polish;
    struct gm_ball *here = residuals(polishing);
    bool good = here != NULL;
    polish->after = good ? largest(polish, here) : INFINITY;
    double last = INFINITY;
    for (int i = 0; good && i < ITERATIONS && polish->after > solved && polish->after < hopeless &&
                    (polish->after > polish->doubt || polish->after < last / 2);
         i++) {
        last = polish->after;
        good = differentiate(polishing, here, u);
        if (good) {
            gsl_linalg_SV_decomp_jacobi(u, v, values);
            move(polishing, here, u, v, values);
            free(here);
            here = residuals(polishing);
            good = here != NULL;
            polish->after = good ? largest(polish, here) : INFINITY;
        }
    }
    free(here);
    return good &&
           (polish->after <= fmax(solved, polish->doubt) ||
            fail(polishing,
                 "no coefficients near these satisfy the conditions of order %d and of what is claimed: %.1e "
                 "remains",
                 polish->order, polish->after));
}

static bool solve(void *data)
{
    struct polishing *polishing = data;
    struct gm_polish *polish = polishing->polish;
    const size_t count = polishing->decimals.count;
    struct gm_ball *here = residuals(polishing);
    if (!here) {
        return false;
    }
    polish->before = largest(polish, here);
    free(here);
    const size_t rows = polish->conditions > count ? polish->conditions : count;
    gsl_matrix *u = gsl_matrix_alloc(rows, count), *v = gsl_matrix_alloc(count, count);
    gsl_vector *values = gsl_vector_alloc(count);
    const bool good = u && v && values ? iterate(polishing, u, v, values) : no_memory(polishing) != NULL;
    gsl_matrix_free(u);
    gsl_matrix_free(v);
    gsl_vector_free(values);
    return good;
}

static int by_place(const void *a, const void *b)
{
    const struct gm_decimal *x = a, *y = b;
    return (x->place > y->place) - (x->place < y->place);
}

/* Returns the length of the text to which words may be added: without blanks and a word's last character. */
static size_t end_of(const struct gm_user_scheme_source *source, bool is_word)
{
    size_t end = source->length;
    while (end > 0 && strchr(" \t\r\n", source->text[end - 1])) {
        end--;
    }
    return is_word ? end - 1 : end;
}

/* Returns the numbers to write, x and the sums of rows, in the order of the text; the caller frees. NULL with
   a fault. */
static struct gm_decimal *polished(struct polishing *polishing, size_t *count)
{
    polishing->decimals.sums = &polishing->sums;
    const struct gm_scheme *scheme = scheme_at(polishing);
    polishing->decimals.sums = NULL;
    if (!scheme) {
        return NULL;
    }
    gm_user_scheme_close(scheme);
    const size_t decimals = polishing->decimals.count, sums = polishing->sums.count;
    struct gm_decimal *all = malloc((decimals + sums) * sizeof *all);
    if (!all) {
        return no_memory(polishing);
    }
    for (size_t i = 0; i < decimals; i++) {
        all[i] = polishing->decimals.at[i];
        all[i].ball = polishing->x[i];
    }
    for (size_t i = 0; i < sums; i++) {
        all[decimals + i] = polishing->sums.at[i];
    }
    *count = decimals + sums;
    qsort(all, *count, sizeof *all, by_place);
    return all;
}

/* Writes the text with these numbers, up to `end`. */
static void put_numbers(FILE *stream, const char *text, size_t end, const struct gm_decimal *all,
                        size_t count, double doubt)
{
    const int digits = doubt < 1e-30 ? 30 : 15;
    size_t from = 0;
    for (size_t i = 0; i < count; i++) {
        char number[64];
        gm_ball_print(all[i].ball, digits, number, sizeof number);
        /* parentheses keep a subtraction before a negative number */
        const bool minus = number[0] == '-';
        fprintf(stream, "%.*s%s%s%s", (int)(all[i].place - from), text + from, minus ? "(" : "", number,
                minus ? ")" : "");
        from = all[i].place + all[i].length;
    }
    fprintf(stream, "%.*s", (int)(end - from), text + from);
}

static char *write(struct polishing *polishing, const struct gm_written_scheme *written)
{
    const struct gm_user_scheme_source *source = polishing->source;
    const bool is_word = gm_written_is_word(source->text, source->length);
    char *text = NULL;
    size_t size = 0, count = 0;
    struct gm_decimal *numbers = polished(polishing, &count);
    FILE *stream = numbers ? open_memstream(&text, &size) : NULL;
    if (!stream) {
        free(numbers);
        return numbers ? no_memory(polishing) : NULL;
    }
    put_numbers(stream, source->text, end_of(source, is_word), numbers, count, polishing->polish->doubt);
    free(numbers);
    if (!written->lines[GM_SCHEME_WORD_ORDER].said) {
        fprintf(stream, "%sorder: %d", is_word ? "; " : "\n", polishing->polish->order);
    }
    if (!written->lines[GM_SCHEME_WORD_CLAIMS].said) {
        fprintf(stream, "%sclaims:%s", is_word ? "; " : "\n", polishing->polish->claims ? "" : " none");
        for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
            if (polishing->polish->claims >> bit & 1) {
                fprintf(stream, " %s", gm_claim_key(bit));
            }
        }
    }
    fputs(is_word ? ")\n" : "\n", stream);
    if (fclose(stream) != 0) {
        free(text);
        return no_memory(polishing);
    }
    return text;
}

/* Gathers the decimals and the conditions on them. */
static bool gather(struct polishing *polishing)
{
    struct gm_user_scheme_source source = *polishing->source;
    source.decimals = &polishing->decimals;
    const struct gm_scheme *scheme = gm_user_scheme_open(&source, polishing->fault);
    if (!scheme) {
        return false;
    }
    const bool known = scheme->exact != NULL;
    polishing->polish->order = scheme->order;
    polishing->polish->claims = scheme->claims;
    gm_user_scheme_close(scheme);
    const size_t count = polishing->decimals.count;
    polishing->polish->decimals = count;
    if (!known || count == 0) {
        return fail(polishing, known ? "there is nothing to polish: all its numbers are exact"
                                     : "theory knows no conditions of such a scheme");
    }
    qsort(polishing->decimals.at, count, sizeof *polishing->decimals.at, by_place);
    polishing->x = malloc(count * sizeof *polishing->x);
    for (size_t i = 0; polishing->x && i < count; i++) {
        polishing->x[i] = polishing->decimals.at[i].ball;
        polishing->x[i].radius = 0;
    }
    return polishing->x || no_memory(polishing);
}

char *gm_user_scheme_polish(const struct gm_user_scheme_source *source, struct gm_polish *polish,
                            struct gm_fault *fault)
{
    struct polishing polishing = {.source = source, .polish = polish, .fault = fault};
    struct gm_written_scheme *written = malloc(sizeof *written);
    char *text = NULL;
    *polish = (struct gm_polish){0};
    *fault = (struct gm_fault){0};
    if (!written) {
        return NULL;
    }
    if (gm_written_open(written, source->text, 0, source->length, NULL, fault) && gather(&polishing) &&
        gm_memory_guard_gsl(solve, &polishing)) {
        for (size_t i = 0; i < polish->decimals; i++) {
            polish->change =
                fmax(polish->change,
                     fabs(gm_ball_midpoint(gm_ball_subtract(polishing.x[i], polishing.decimals.at[i].ball))));
        }
        text = write(&polishing, written);
    }
    gm_written_close(written);
    free(written);
    free(polishing.decimals.at);
    free(polishing.sums.at);
    free(polishing.x);
    return text;
}
