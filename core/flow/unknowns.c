/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The unknown values of the stream function, and the matrices K and K W K between them. */
#include "core/flow/unknowns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool gm_unknowns_open(struct gm_unknowns *unknowns, const struct gm_flow *flow)
{
    const size_t n = flow->complex->vertices;
    *unknowns = (struct gm_unknowns){.start = malloc((n + 1) * sizeof(int)),
                                     .vertex = malloc(n * sizeof(int)),
                                     .index = malloc(n * sizeof(int)),
                                     .closed = flow->complex->boundary == 0};
    if (!unknowns->start || !unknowns->vertex || !unknowns->index) {
        return false;
    }
    int used = 0;
    for (size_t v = 0; v < n; v++) {
        const bool free_psi = flow->kind[v] == GM_VERTEX_FREE || flow->kind[v] == GM_VERTEX_OPEN;
        const bool pinned = unknowns->closed && v == 0;
        unknowns->index[v] = -1;
        if (free_psi && !pinned) {
            unknowns->start[unknowns->count] = used;
            unknowns->index[v] = (int)unknowns->count++;
            unknowns->vertex[used++] = (int)v;
        }
    }
    for (int hole = 1; hole <= (int)flow->holes; hole++) {
        unknowns->start[unknowns->count] = used;
        for (size_t v = 0; v < n; v++) {
            if (flow->hole[v] == hole) {
                unknowns->index[v] = (int)unknowns->count;
                unknowns->vertex[used++] = (int)v;
            }
        }
        unknowns->count++;
    }
    unknowns->start[unknowns->count] = used;
    return true;
}

void gm_unknowns_close(struct gm_unknowns *unknowns)
{
    free(unknowns->start);
    free(unknowns->vertex);
    free(unknowns->index);
}

void gm_unknowns_gather(const struct gm_unknowns *unknowns, const double *values, double *into)
{
    for (size_t i = 0; i < unknowns->count; i++) {
        int k = unknowns->start[i];
        into[i] = values[unknowns->vertex[k]];
        while (++k < unknowns->start[i + 1]) {
            into[i] += values[unknowns->vertex[k]];
        }
    }
}

/* Rows of a matrix that grow. */
struct rows {
    int *start, *column;
    double *value;
    size_t capacity, used;
};

static bool rows_open(struct rows *rows, size_t n, size_t capacity)
{
    *rows = (struct rows){.start = malloc((n + 1) * sizeof(int)),
                          .column = malloc(capacity * sizeof(int)),
                          .value = malloc(capacity * sizeof(double)),
                          .capacity = capacity};
    return rows->start && rows->column && rows->value;
}

static void rows_close(struct rows *rows)
{
    free(rows->start);
    free(rows->column);
    free(rows->value);
}

/* Row v of K: calls are made with every neighbour and with v itself. */
static double diagonal(const struct gm_complex *complex, int v)
{
    double sum = 0;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        sum += complex->star1[complex->ring_edge[k]];
    }
    return sum;
}

/* Adds to the entry of column j in the row being made; `place`: entries of columns, below the row's start
   if they have none. */
static void add_entry(struct rows *rows, int *place, int row, int j, double value)
{
    if (place[j] < rows->start[row]) {
        place[j] = (int)rows->used;
        rows->column[rows->used] = j;
        rows->value[rows->used++] = 0;
    }
    rows->value[place[j]] += value;
}

static bool by_formula(const struct gm_flow *flow, int v)
{
    return flow->kind[v] != GM_VERTEX_SOFT && flow->kind[v] != GM_VERTEX_SLIP;
}

/* Adds scale times row `middle` of K, between unknowns, to the row being made in `dense`. */
static void add_row(const struct gm_unknowns *unknowns, const struct gm_complex *complex, int middle,
                    double scale, struct rows *rows, int *place, int row)
{
    for (int k = complex->ring_start[middle] - 1; k < complex->ring_start[middle + 1]; k++) {
        const bool self = k < complex->ring_start[middle];
        const int v = self ? middle : complex->ring_vertex[k], j = unknowns->index[v];
        if (j >= 0 && j <= row) {
            add_entry(rows, place, row, j,
                      scale * (self ? diagonal(complex, middle) : -complex->star1[complex->ring_edge[k]]));
        }
    }
}

/* At most this many columns, up to the diagonal, in the rows of K W K. */
static size_t two_ring_bound(const struct gm_unknowns *unknowns, const struct gm_complex *complex)
{
    size_t sum = 0;
    for (int i = 0; i < unknowns->start[unknowns->count]; i++) {
        const int v = unknowns->vertex[i];
        for (int k = complex->ring_start[v] - 1; k < complex->ring_start[v + 1]; k++) {
            const int w = k < complex->ring_start[v] ? v : complex->ring_vertex[k];
            sum += (size_t)(complex->ring_start[w + 1] - complex->ring_start[w] + 1);
        }
    }
    return sum;
}

/* shift K, and of a rough factor viscosity K W K, too. */
static struct gm_cholesky *factor_of(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                                     double shift, double viscosity, enum gm_cholesky_precision precision)
{
    const struct gm_complex *complex = flow->complex;
    const bool stokes = precision == GM_CHOLESKY_ROUGH;
    struct rows rows;
    struct gm_cholesky *factor = NULL;
    int *place = malloc((unknowns->count + 1) * sizeof *place);
    if (rows_open(&rows, unknowns->count,
                  stokes ? two_ring_bound(unknowns, complex) : unknowns->count + complex->edges) &&
        place) {
        memset(place, -1, unknowns->count * sizeof *place);
        for (size_t i = 0; i < unknowns->count; i++) {
            rows.start[i] = (int)rows.used;
            for (int at = unknowns->start[i]; at < unknowns->start[i + 1]; at++) {
                const int v = unknowns->vertex[at];
                add_row(unknowns, complex, v, shift, &rows, place, (int)i);
                for (int k = complex->ring_start[v] - 1; stokes && k < complex->ring_start[v + 1]; k++) {
                    const bool self = k < complex->ring_start[v];
                    const int w = self ? v : complex->ring_vertex[k];
                    const double entry = self ? diagonal(complex, v) : -complex->star1[complex->ring_edge[k]];
                    if (by_formula(flow, w)) {
                        add_row(unknowns, complex, w, viscosity * entry / complex->star0[w], &rows, place,
                                (int)i);
                    }
                }
            }
        }
        rows.start[unknowns->count] = (int)rows.used;
        factor = gm_cholesky_open(unknowns->count, rows.start, rows.column, rows.value, precision);
    }
    rows_close(&rows);
    free(place);
    return factor;
}

struct gm_cholesky *gm_unknowns_factor_poisson(const struct gm_unknowns *unknowns, const struct gm_flow *flow)
{
    return factor_of(unknowns, flow, 1, 0, GM_CHOLESKY_EXACT);
}

struct gm_cholesky *gm_unknowns_factor_stokes(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                                              double shift, double viscosity)
{
    return factor_of(unknowns, flow, shift, viscosity, GM_CHOLESKY_ROUGH);
}

void gm_unknowns_solve_poisson(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                               struct gm_cholesky *factor, const double *right, double *b, double *x,
                               double *psi)
{
    const struct gm_complex *complex = flow->complex;
    if (unknowns->closed) {
        psi[0] = 0;
    }
    for (size_t i = 0; i < unknowns->count; i++) {
        b[i] = 0;
        for (int at = unknowns->start[i]; at < unknowns->start[i + 1]; at++) {
            const int v = unknowns->vertex[at];
            double sum = right ? right[v] : 0;
            for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
                const int w = complex->ring_vertex[k];
                sum += unknowns->index[w] < 0 ? complex->star1[complex->ring_edge[k]] * psi[w] : 0;
            }
            b[i] += sum;
        }
    }
    gm_cholesky_solve(factor, b, x);
    for (size_t i = 0; i < unknowns->count; i++) {
        for (int at = unknowns->start[i]; at < unknowns->start[i + 1]; at++) {
            psi[unknowns->vertex[at]] = x[i];
        }
    }
    if (unknowns->closed) {
        double sum = 0;
        for (size_t v = 0; v < complex->vertices; v++) {
            sum += complex->star0[v] * psi[v];
        }
        for (size_t v = 0; v < complex->vertices; v++) {
            psi[v] -= sum / complex->total_area;
        }
    }
}
