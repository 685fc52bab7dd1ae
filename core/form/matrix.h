/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse matrices by rows: the operators of forms, and products of them. */
#ifndef GM_CORE_FORM_MATRIX_H
#define GM_CORE_FORM_MATRIX_H

#include "core/arena.h"

/* Row i has value[k] in column[k], start[i] <= k < start[i + 1], in increasing columns. */
struct gm_matrix {
    size_t rows, columns;
    int *start, *column;
    double *value;
    int width; /* the entries of every row; 0: rows differ */
};

/* The number of entries; 0 of no matrix. */
static inline size_t gm_matrix_count(const struct gm_matrix *a)
{
    return a->start ? (size_t)a->start[a->rows] : 0;
}

/* The entries of a matrix that is being made, in any order; those at the same place are added. */
struct gm_matrix_entries {
    struct gm_arena *arena;
    struct gm_matrix_entry {
        int row, column;
        double value;
    } * list;
    size_t count;
};
/* Begins at most `most` entries. The arena owns the matrix; in a body of the arena, as all below. */
struct gm_matrix_entries gm_matrix_entries(struct gm_arena *arena, size_t most);
void gm_matrix_put(struct gm_matrix_entries *entries, size_t row, size_t column, double value);
/* Puts a whole matrix, times a factor, with its first entry in that row and column. */
void gm_matrix_put_block(struct gm_matrix_entries *entries, const struct gm_matrix *block, size_t row,
                         size_t column, double factor);
/* Makes the matrix, and frees its entries. */
struct gm_matrix gm_matrix_of(struct gm_matrix_entries *entries, size_t rows, size_t columns);

/* A matrix while it is made row by row. */
struct gm_matrix_rows {
    struct gm_arena *arena;
    struct gm_matrix matrix;
    double *scratch;
    int *place; /* of each column in the row; before its start if it is not there */
    int used;
    size_t row;
};
/* Begins a matrix of at most `most` entries. */
struct gm_matrix_rows gm_matrix_begin(struct gm_arena *arena, size_t rows, size_t columns, size_t most);
/* Adds to an entry of the row; no column is below 0. */
void gm_matrix_add(struct gm_matrix_rows *rows, int column, double value);
/* Ends the row; columns that are not to be sorted keep the order in which they came. */
void gm_matrix_end_row(struct gm_matrix_rows *rows, bool sorted);
/* The matrix after its last row. */
struct gm_matrix gm_matrix_end(struct gm_matrix_rows *rows);

/* a b */
struct gm_matrix gm_matrix_product(struct gm_arena *arena, const struct gm_matrix *a,
                                   const struct gm_matrix *b);
/* factor a' */
struct gm_matrix gm_matrix_transposed(struct gm_arena *arena, const struct gm_matrix *a, double factor);
/* p a + q b, of equal sizes; b may be NULL. */
struct gm_matrix gm_matrix_sum(struct gm_arena *arena, double p, const struct gm_matrix *a, double q,
                               const struct gm_matrix *b);
/* True if a square matrix is symmetric, but for round-off, after its rows have been multiplied by weights. */
bool gm_matrix_is_symmetric(const struct gm_matrix *a, const double *weight);
/* Multiplies row i by scale[i]. */
void gm_matrix_scale(struct gm_matrix *matrix, const double *scale);
/* The diagonal matrix of `count` numbers, each to this power, 1 or -1, times a factor. */
struct gm_matrix gm_matrix_diagonal(struct gm_arena *arena, const double *numbers, size_t count, int power,
                                    double factor);

/* y = a x */
void gm_matrix_apply(const struct gm_matrix *a, const double *x, double *y);

#endif
