/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss and Newton's iteration: with the residuals F of the conditions at the decimals x,
       x := x - J^+ F,   J = dF / dx,
   J^+ the pseudo-inverse, so that each step is the shortest one. x and F have 77 digits, J and its inverse
   those of a double: an iteration gains about a dozen. The columns of J are differences, of the whole scheme
   as it is made of its text: what a decimal stands for, in a let, a base or a tableau, need not be known
   here. P. Deuflhard, Newton Methods for Nonlinear Problems (2004), section 4.4. */
#include "core/ode/user/scheme.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "core/arena.h"
#include "core/expression/reader.h"
#include "core/memory.h"
#include "core/theory/theory.h"

/* The decimals, their current values, and the conditions on them; the data of an arena's body, which a fault
   leaves. */
struct polishing {
    const struct gm_user_scheme_source *source;
    struct gm_polish *polish;
    struct gm_arena *arena;
    struct gm_decimals decimals;
    struct gm_ball *x;
    struct gm_row_sums sums; /* the row sums of the moved decimals */
    bool counted;            /* the number of conditions is known */
    struct gm_fault *fault;
    char *text; /* the result */
};

/* Returns the scheme with x for its decimals. */
static const struct gm_scheme *scheme_at(struct polishing *polishing)
{
    struct gm_user_scheme_source source = *polishing->source;
    struct gm_decimals decimals = polishing->decimals;
    decimals.instead = polishing->x;
    source.decimals = &decimals;
    const struct gm_scheme *scheme = gm_user_scheme_open(&source, polishing->fault);
    gm_arena_need(polishing->arena, scheme);
    return scheme;
}

/* Returns F at x, in the arena. */
static struct gm_ball *residuals(struct polishing *polishing)
{
    struct gm_polish *polish = polishing->polish;
    const struct gm_scheme *scheme = scheme_at(polishing);
    size_t count = 0;
    struct gm_ball *all = gm_theory_residuals(scheme->exact, polish->order, polish->claims & GM_SYMPLECTIC,
                                              polish->claims & GM_SYMMETRIC, &count);
    gm_user_scheme_close(scheme);
    gm_arena_keep(polishing->arena, all, free);
    if (polishing->counted && count != polish->conditions) {
        gm_fail(polishing->fault, 0,
                "a coefficient vanishes at some of the numbers near these, and conditions with it");
        gm_arena_leave(polishing->arena);
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
static void differentiate(struct polishing *polishing, const struct gm_ball *here, gsl_matrix *jacobian)
{
    const double step = 1e-30;
    gsl_matrix_set_zero(jacobian);
    for (size_t k = 0; k < polishing->decimals.count; k++) {
        const struct gm_ball kept = polishing->x[k];
        polishing->x[k] = gm_ball_add(kept, gm_ball_of(step));
        struct gm_ball *there = residuals(polishing);
        polishing->x[k] = kept;
        for (size_t i = 0; i < polishing->polish->conditions; i++) {
            gsl_matrix_set(jacobian, i, k, gm_ball_midpoint(gm_ball_subtract(there[i], here[i])) / step);
        }
        gm_arena_drop(polishing->arena, there);
    }
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

static void free_matrix(void *matrix)
{
    gsl_matrix_free(matrix);
}

static void free_vector(void *vector)
{
    gsl_vector_free(vector);
}

static void solve(struct polishing *polishing)
{
    enum { ITERATIONS = 40 };
    const double solved = 1e-45, hopeless = 1e3;
    struct gm_polish *polish = polishing->polish;
    struct gm_arena *arena = polishing->arena;
    const size_t count = polishing->decimals.count;
    struct gm_ball *here = residuals(polishing);
    polish->before = polish->after = largest(polish, here);
    const size_t rows = polish->conditions > count ? polish->conditions : count;
    gsl_matrix *u = gm_arena_keep(arena, gsl_matrix_alloc(rows, count), free_matrix),
               *v = gm_arena_keep(arena, gsl_matrix_alloc(count, count), free_matrix);
    gsl_vector *values = gm_arena_keep(arena, gsl_vector_alloc(count), free_vector);
    double last = INFINITY;
    for (int i = 0; i < ITERATIONS && polish->after > solved && polish->after < hopeless &&
                    (polish->after > polish->doubt || polish->after < last / 2);
         i++) {
        last = polish->after;
        differentiate(polishing, here, u);
        gsl_linalg_SV_decomp_jacobi(u, v, values);
        move(polishing, here, u, v, values);
        gm_arena_drop(arena, here);
        here = residuals(polishing);
        polish->after = largest(polish, here);
    }
    if (!(polish->after <= fmax(solved, polish->doubt))) {
        gm_fail(polishing->fault, 0,
                "no coefficients near these satisfy the conditions of order %d and of what is claimed: %.1e "
                "remains",
                polish->order, polish->after);
        gm_arena_leave(arena);
    }
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

/* Returns the numbers to write, x and the sums of rows, in the order of the text. */
static struct gm_decimal *polished(struct polishing *polishing, size_t *count)
{
    polishing->decimals.sums = &polishing->sums;
    gm_user_scheme_close(scheme_at(polishing));
    const size_t decimals = polishing->decimals.count, sums = polishing->sums.count;
    struct gm_decimal *all = gm_arena_take(polishing->arena, decimals + sums, sizeof *all);
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

static void write(struct polishing *polishing, const struct gm_written_scheme *written)
{
    const struct gm_user_scheme_source *source = polishing->source;
    const bool is_word = gm_written_word_name(source->text, source->length) > 0;
    size_t size = 0, count = 0;
    const struct gm_decimal *numbers = polished(polishing, &count);
    FILE *stream = open_memstream(&polishing->text, &size);
    gm_arena_need(polishing->arena, stream);
    put_numbers(stream, source->text, end_of(source, is_word), numbers, count, polishing->polish->doubt);
    if (!written->lines[GM_SCHEME_WORD_ORDER].said) {
        fprintf(stream, "%sorder: %d", is_word ? "; " : "\n", polishing->polish->order);
    }
    if (!written->lines[GM_SCHEME_WORD_CLAIMS].said) {
        fprintf(stream, "%sclaims:%s", is_word ? "; " : "\n", polishing->polish->claims ? "" : " none");
        for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
            if (polishing->polish->claims >> bit & 1) {
                fprintf(stream, " %s", gm_claims[bit].key);
            }
        }
    }
    fputs(is_word ? ")\n" : "\n", stream);
    gm_arena_need(polishing->arena, fclose(stream) == 0);
}

/* Gathers the decimals and the conditions on them. */
static void gather(struct polishing *polishing)
{
    struct gm_user_scheme_source source = *polishing->source;
    source.decimals = &polishing->decimals;
    const struct gm_scheme *scheme = gm_user_scheme_open(&source, polishing->fault);
    gm_arena_need(polishing->arena, scheme);
    const bool known = scheme->exact != NULL;
    polishing->polish->order = scheme->order;
    polishing->polish->claims = scheme->claims;
    gm_user_scheme_close(scheme);
    const size_t count = polishing->polish->decimals = polishing->decimals.count;
    if (!known || count == 0) {
        gm_fail(polishing->fault, 0, "%s",
                known ? "there is nothing to polish: all its numbers are exact"
                      : "theory knows no conditions of such a scheme");
        gm_arena_leave(polishing->arena);
    }
    qsort(polishing->decimals.at, count, sizeof *polishing->decimals.at, by_place);
    polishing->x = gm_arena_take(polishing->arena, count, sizeof *polishing->x);
    for (size_t i = 0; i < count; i++) {
        polishing->x[i] = polishing->decimals.at[i].ball;
        polishing->x[i].radius = 0;
    }
}

static void polish_all(struct gm_arena *arena, void *data)
{
    struct polishing *polishing = data;
    struct gm_polish *polish = polishing->polish;
    const struct gm_user_scheme_source *source = polishing->source;
    struct gm_written_scheme *written = gm_arena_take(arena, 1, sizeof *written);
    gm_arena_keep(arena, written, gm_written_close);
    gm_arena_need(arena, gm_written_open(written, source->text, 0, source->length, NULL, polishing->fault));
    gather(polishing);
    solve(polishing);
    for (size_t i = 0; i < polish->decimals; i++) {
        polish->change =
            fmax(polish->change,
                 fabs(gm_ball_midpoint(gm_ball_subtract(polishing->x[i], polishing->decimals.at[i].ball))));
    }
    write(polishing, written);
}

static bool work(void *data)
{
    struct polishing *polishing = data;
    return gm_arena_run(polishing->arena, polish_all, polishing);
}

char *gm_user_scheme_polish(const struct gm_user_scheme_source *source, struct gm_polish *polish,
                            struct gm_fault *fault)
{
    struct polishing polishing = {
        .source = source, .polish = polish, .arena = gm_arena_open(), .fault = fault};
    *polish = (struct gm_polish){0};
    *fault = (struct gm_fault){0};
    if (!gm_memory_guard_gsl(work, &polishing)) {
        free(polishing.text);
        polishing.text = NULL;
    }
    gm_arena_close(polishing.arena);
    free(polishing.decimals.at);
    free(polishing.sums.at);
    return polishing.text;
}
