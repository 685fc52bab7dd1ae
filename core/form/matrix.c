/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/form/matrix.h"

#include <math.h>
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

static struct gm_matrix ended(struct gm_matrix matrix)
{
    matrix.width = matrix.rows > 0 ? matrix.start[1] : 0;
    for (size_t i = 0; i < matrix.rows; i++) {
        matrix.width = matrix.start[i + 1] - matrix.start[i] == matrix.width ? matrix.width : 0;
    }
    return matrix;
}

struct gm_matrix gm_matrix_transposed(struct gm_arena *arena, const struct gm_matrix *a, double factor)
{
    struct gm_matrix to = empty(arena, a->columns, a->rows, gm_matrix_count(a));
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
    return ended(to);
}

struct gm_matrix_rows gm_matrix_begin(struct gm_arena *arena, size_t rows, size_t columns, size_t most)
{
    struct gm_matrix_rows made = {.arena = arena, .matrix = empty(arena, rows, columns, most)};
    made.scratch = gm_arena_keep(arena, malloc((columns + 1) * (sizeof(double) + sizeof(int))), free);
    made.place = memset(made.scratch + columns + 1, -1, (columns + 1) * sizeof(int));
    return made;
}

void gm_matrix_add(struct gm_matrix_rows *rows, int column, double value)
{
    struct gm_matrix *matrix = &rows->matrix;
    if (column < 0) {
        return;
    }
    int *place = &rows->place[column];
    if (*place >= matrix->start[rows->row]) {
        matrix->value[*place] += value;
        return;
    }
    *place = rows->used++;
    matrix->column[*place] = column;
    matrix->value[*place] = value;
}

static int compare_columns(const void *a, const void *b)
{
    const int p = *(const int *)a, q = *(const int *)b;
    return (p > q) - (p < q);
}

void gm_matrix_end_row(struct gm_matrix_rows *rows, bool sorted)
{
    struct gm_matrix *matrix = &rows->matrix;
    const int begin = matrix->start[rows->row];
    bool jumps = false;
    for (int k = begin + 1; sorted && k < rows->used; k++) {
        jumps |= matrix->column[k] < matrix->column[k - 1];
    }
    for (int k = begin; jumps && k < rows->used; k++) {
        rows->scratch[matrix->column[k]] = matrix->value[k];
    }
    if (jumps) {
        qsort(matrix->column + begin, (size_t)(rows->used - begin), sizeof(int), compare_columns);
    }
    for (int k = begin; jumps && k < rows->used; k++) {
        matrix->value[k] = rows->scratch[matrix->column[k]];
    }
    matrix->start[++rows->row] = rows->used;
}

struct gm_matrix gm_matrix_end(struct gm_matrix_rows *rows)
{
    gm_arena_drop(rows->arena, rows->scratch);
    return ended(rows->matrix);
}

struct gm_matrix_entries gm_matrix_entries(struct gm_arena *arena, size_t most)
{
    struct gm_matrix_entry *list = gm_arena_keep(arena, malloc((most + 1) * sizeof *list), free);
    return (struct gm_matrix_entries){arena, list, 0};
}

void gm_matrix_put(struct gm_matrix_entries *entries, size_t row, size_t column, double value)
{
    entries->list[entries->count++] = (struct gm_matrix_entry){(int)row, (int)column, value};
}

void gm_matrix_put_block(struct gm_matrix_entries *entries, const struct gm_matrix *block, size_t row,
                         size_t column, double factor)
{
    for (size_t i = 0; i < block->rows; i++) {
        for (int k = block->start[i]; k < block->start[i + 1]; k++) {
            gm_matrix_put(entries, row + i, column + (size_t)block->column[k], factor * block->value[k]);
        }
    }
}

struct gm_matrix gm_matrix_of(struct gm_matrix_entries *entries, size_t rows, size_t columns)
{
    struct gm_arena *arena = entries->arena;
    struct gm_matrix_rows made = gm_matrix_begin(arena, rows, columns, entries->count);
    int *next = gm_arena_keep(arena, calloc(rows + 1, sizeof *next), free);
    int *order = gm_arena_keep(arena, malloc((entries->count + 1) * sizeof *order), free);
    for (size_t i = 0; i < entries->count; i++) {
        next[entries->list[i].row + 1]++;
    }
    for (size_t i = 0; i < rows; i++) {
        next[i + 1] += next[i];
    }
    for (size_t i = 0; i < entries->count; i++) { /* afterwards next[i] is the end of row i */
        order[next[entries->list[i].row]++] = (int)i;
    }
    for (int k = 0; made.row < rows;) {
        for (const int end = next[made.row]; k < end; k++) {
            gm_matrix_add(&made, entries->list[order[k]].column, entries->list[order[k]].value);
        }
        gm_matrix_end_row(&made, true);
    }
    gm_arena_drop(arena, order);
    gm_arena_drop(arena, next);
    gm_arena_drop(arena, entries->list);
    return gm_matrix_end(&made);
}

struct gm_matrix gm_matrix_product(struct gm_arena *arena, const struct gm_matrix *a,
                                   const struct gm_matrix *b)
{
    size_t most = 0;
    for (int k = 0; k < a->start[a->rows]; k++) {
        most += (size_t)(b->start[a->column[k] + 1] - b->start[a->column[k]]);
    }
    struct gm_matrix_rows rows = gm_matrix_begin(arena, a->rows, b->columns, most);
    for (size_t i = 0; i < a->rows; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            const int j = a->column[k];
            for (int l = b->start[j]; l < b->start[j + 1]; l++) {
                gm_matrix_add(&rows, b->column[l], a->value[k] * b->value[l]);
            }
        }
        gm_matrix_end_row(&rows, true);
    }
    return gm_matrix_end(&rows);
}

struct gm_matrix gm_matrix_sum(struct gm_arena *arena, double p, const struct gm_matrix *a, double q,
                               const struct gm_matrix *b)
{
    const size_t most = gm_matrix_count(a) + (b ? gm_matrix_count(b) : 0);
    struct gm_matrix_rows rows = gm_matrix_begin(arena, a->rows, a->columns, most);
    for (size_t i = 0; i < a->rows; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            gm_matrix_add(&rows, a->column[k], p * a->value[k]);
        }
        for (int k = b ? b->start[i] : 0; b && k < b->start[i + 1]; k++) {
            gm_matrix_add(&rows, b->column[k], q * b->value[k]);
        }
        gm_matrix_end_row(&rows, true);
    }
    return gm_matrix_end(&rows);
}

static double entry_of(const struct gm_matrix *a, int row, int column)
{
    int low = a->start[row], high = a->start[row + 1];
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (a->column[middle] < column) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < a->start[row + 1] && a->column[low] == column ? a->value[low] : 0;
}

bool gm_matrix_is_symmetric(const struct gm_matrix *a, const double *weight)
{
    double largest = 0, asymmetry = 0;
    for (int i = 0; i < (int)a->rows; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            const int j = a->column[k];
            const double here = weight[i] * a->value[k], there = weight[j] * entry_of(a, j, i);
            largest = fmax(largest, fabs(here));
            asymmetry = fmax(asymmetry, fabs(here - there));
        }
    }
    return asymmetry <= 1e-12 * largest;
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
    return ended(matrix);
}

/* The same for rows of a width that is a constant of the call; 0: they differ. */
static inline void apply(const struct gm_matrix *a, int width, const double *x, double *y)
{
    for (int i = 0; i < (int)a->rows; i++) {
        const int begin = width > 0 ? i * width : a->start[i],
                  end = width > 0 ? width : a->start[i + 1] - begin;
        double sum = 0;
        for (int k = 0; k < end; k++) {
            sum += a->value[begin + k] * x[a->column[begin + k]];
        }
        y[i] = sum;
    }
}

void gm_matrix_apply(const struct gm_matrix *a, const double *x, double *y)
{
    switch (a->width) {
    case 1:
        apply(a, 1, x, y);
        break;
    case 2:
        apply(a, 2, x, y);
        break;
    case 3:
        apply(a, 3, x, y);
        break;
    case 5:
        apply(a, 5, x, y);
        break;
    default:
        apply(a, 0, x, y);
    }
}
