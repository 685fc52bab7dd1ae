/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/form/matrix.h"

#include <stdlib.h>
#include <string.h>

static struct gm_matrix empty(struct gm_arena *arena, size_t rows, size_t columns, size_t count)
{
    return (struct gm_matrix){.rows = rows,
                              .columns = columns,
                              .start = gm_arena_take(arena, rows + 1, sizeof(int)),
                              .column = gm_arena_take(arena, count + 1, sizeof(int)),
                              .value = gm_arena_take(arena, count + 1, sizeof(double))};
}

static int compare(const void *a, const void *b)
{
    const struct gm_matrix_entry *p = a, *q = b;
    const int row = (p->row > q->row) - (p->row < q->row);
    return row ? row : (p->column > q->column) - (p->column < q->column);
}

struct gm_matrix gm_matrix_of(struct gm_arena *arena, size_t rows, size_t columns,
                              struct gm_matrix_entry *entries, size_t count)
{
    struct gm_matrix matrix = empty(arena, rows, columns, count);
    int made = 0;
    qsort(entries, count, sizeof *entries, compare);
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && compare(&entries[i - 1], &entries[i]) == 0) {
            matrix.value[made - 1] += entries[i].value;
            continue;
        }
        matrix.column[made] = entries[i].column;
        matrix.value[made++] = entries[i].value;
        matrix.start[entries[i].row + 1] = made;
    }
    for (size_t i = 0; i < rows; i++) { /* rows without entries */
        matrix.start[i + 1] = matrix.start[i + 1] > matrix.start[i] ? matrix.start[i + 1] : matrix.start[i];
    }
    return matrix;
}

struct gm_matrix gm_matrix_transposed(struct gm_arena *arena, const struct gm_matrix *a, double factor)
{
    struct gm_matrix to = empty(arena, a->columns, a->rows, (size_t)a->start[a->rows]);
    int *next = to.start;
    for (int k = 0; k < a->start[a->rows]; k++) {
        to.start[a->column[k] + 1]++;
    }
    for (size_t i = 0; i < to.rows; i++) {
        to.start[i + 1] += to.start[i];
    }
    for (size_t i = 0; i < a->rows; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            const int place = next[a->column[k]]++;
            to.column[place] = (int)i;
            to.value[place] = factor * a->value[k];
        }
    }
    memmove(next + 1, next, to.rows * sizeof *next);
    next[0] = 0;
    return to;
}

/* Row by row: the entries of a row gather in a dense one, whose used columns are marked by the row. */
struct gm_matrix gm_matrix_product(struct gm_arena *arena, const struct gm_matrix *a,
                                   const struct gm_matrix *b)
{
    size_t most = 0;
    for (int k = 0; k < a->start[a->rows]; k++) {
        most += (size_t)(b->start[a->column[k] + 1] - b->start[a->column[k]]);
    }
    struct gm_matrix_entry *entries = gm_arena_keep(arena, malloc((most + 1) * sizeof *entries), free);
    gm_arena_need(arena, entries);
    size_t count = 0;
    for (size_t i = 0; i < a->rows; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            const int j = a->column[k];
            for (int l = b->start[j]; l < b->start[j + 1]; l++) {
                entries[count++] = (struct gm_matrix_entry){(int)i, b->column[l], a->value[k] * b->value[l]};
            }
        }
    }
    struct gm_matrix product = gm_matrix_of(arena, a->rows, b->columns, entries, count);
    gm_arena_drop(arena, entries);
    return product;
}

struct gm_matrix gm_matrix_sum(struct gm_arena *arena, double p, const struct gm_matrix *a, double q,
                               const struct gm_matrix *b)
{
    const size_t most = (size_t)a->start[a->rows] + (b ? (size_t)b->start[b->rows] : 0);
    struct gm_matrix_entry *entries = gm_arena_keep(arena, malloc((most + 1) * sizeof *entries), free);
    gm_arena_need(arena, entries);
    size_t count = 0;
    for (size_t i = 0; i < a->rows; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            entries[count++] = (struct gm_matrix_entry){(int)i, a->column[k], p * a->value[k]};
        }
        for (int k = b ? b->start[i] : 0; b && k < b->start[i + 1]; k++) {
            entries[count++] = (struct gm_matrix_entry){(int)i, b->column[k], q * b->value[k]};
        }
    }
    struct gm_matrix sum = gm_matrix_of(arena, a->rows, a->columns, entries, count);
    gm_arena_drop(arena, entries);
    return sum;
}

void gm_matrix_scale(struct gm_matrix *matrix, const double *scale)
{
    for (size_t i = 0; i < matrix->rows; i++) {
        for (int k = matrix->start[i]; k < matrix->start[i + 1]; k++) {
            matrix->value[k] *= scale[i];
        }
    }
}

struct gm_matrix gm_matrix_diagonal(struct gm_arena *arena, const double *numbers, size_t count, int power,
                                    double factor)
{
    struct gm_matrix matrix = empty(arena, count, count, count);
    for (size_t i = 0; i < count; i++) {
        matrix.start[i + 1] = (int)i + 1;
        matrix.column[i] = (int)i;
        matrix.value[i] = factor * (power > 0 ? numbers[i] : 1 / numbers[i]);
    }
    return matrix;
}

void gm_matrix_apply(const struct gm_matrix *a, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i++) {
        double sum = 0;
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            sum += a->value[k] * x[a->column[k]];
        }
        y[i] = sum;
    }
}
