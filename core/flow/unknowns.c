/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The unknown values of the stream function, and the matrices K and K W K between them. */
#include "core/flow/matrices.h"

#include "core/form/matrix.h"

/* Adds the unknown omega of soft vertices, or the unknown temperature; returns that of each vertex, or -1. */
static int *list_single(struct gm_arena *arena, const struct gm_flow *flow, bool warm,
                        struct gm_unknowns *unknowns)
{
    const size_t n = flow->complex->vertices;
    int *index = gm_arena_take(arena, n, sizeof *index);
    for (size_t v = 0; v < n; v++) {
        const bool there = warm ? flow->heat && !flow->temperature_fixed[v] : flow->kind[v] == GM_VERTEX_SOFT;
        const int used = unknowns->start[unknowns->all];
        index[v] = there ? (int)unknowns->all : -1;
        if (there) {
            unknowns->vertex[used] = (int)v;
            unknowns->start[++unknowns->all] = used + 1;
        }
    }
    return index;
}

struct gm_unknowns gm_unknowns_of(struct gm_arena *arena, const struct gm_flow *flow)
{
    const size_t n = flow->complex->vertices;
    struct gm_unknowns unknowns = {.start = gm_arena_take(arena, 3 * n + 1, sizeof(int)),
                                   .vertex = gm_arena_take(arena, 3 * n, sizeof(int)),
                                   .index = gm_arena_take(arena, n, sizeof(int)),
                                   .closed = flow->complex->boundary == 0};
    int used = 0;
    for (size_t v = 0; v < n; v++) {
        const bool free_psi = flow->kind[v] == GM_VERTEX_FREE || flow->kind[v] == GM_VERTEX_OPEN;
        const bool pinned = unknowns.closed && v == 0;
        unknowns.index[v] = -1;
        if (free_psi && !pinned) {
            unknowns.start[unknowns.count] = used;
            unknowns.index[v] = (int)unknowns.count++;
            unknowns.vertex[used++] = (int)v;
        }
    }
    for (int hole = 1; hole <= (int)flow->holes; hole++) {
        unknowns.start[unknowns.count] = used;
        for (size_t v = 0; v < n; v++) {
            if (flow->hole[v] == hole) {
                unknowns.index[v] = (int)unknowns.count;
                unknowns.vertex[used++] = (int)v;
            }
        }
        unknowns.count++;
    }
    unknowns.start[unknowns.count] = used;
    unknowns.all = unknowns.count;
    unknowns.soft = list_single(arena, flow, false, &unknowns);
    unknowns.flow = unknowns.all;
    unknowns.warm = list_single(arena, flow, true, &unknowns);
    return unknowns;
}

void gm_unknowns_gather(const struct gm_unknowns *unknowns, const double *values, double *into)
{
    for (size_t i = 0; i < unknowns->flow; i++) {
        int k = unknowns->start[i];
        into[i] = values[unknowns->vertex[k]];
        while (++k < unknowns->start[i + 1]) {
            into[i] += values[unknowns->vertex[k]];
        }
    }
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

static bool by_formula(const struct gm_flow *flow, int v)
{
    return flow->kind[v] != GM_VERTEX_SOFT && flow->kind[v] != GM_VERTEX_SLIP;
}

/* Adds scale times row `middle` of K, between unknowns, to the row that is made, up to the diagonal. */
static void add_row(const struct gm_unknowns *unknowns, const struct gm_complex *complex, int middle,
                    double scale, struct gm_matrix_rows *rows)
{
    for (int k = complex->ring_start[middle] - 1; k < complex->ring_start[middle + 1]; k++) {
        const bool self = k < complex->ring_start[middle];
        const int j = unknowns->index[self ? middle : complex->ring_vertex[k]];
        if (j <= (int)rows->row) {
            gm_matrix_add(
                rows, j, scale * (self ? diagonal(complex, middle) : -complex->star1[complex->ring_edge[k]]));
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

/* A factor while it is made. */
struct factoring {
    const struct gm_unknowns *unknowns;
    const struct gm_flow *flow;
    enum gm_cholesky_precision precision;
    double shift, viscosity;
    struct gm_cholesky *factor;
};

static void factor(struct gm_arena *arena, void *data)
{
    struct factoring *self = data;
    const struct gm_unknowns *unknowns = self->unknowns;
    const struct gm_complex *complex = self->flow->complex;
    const bool stokes = self->precision == GM_CHOLESKY_ROUGH;
    struct gm_matrix_rows rows =
        gm_matrix_begin(arena, unknowns->count, unknowns->count,
                        stokes ? two_ring_bound(unknowns, complex) : unknowns->count + complex->edges);
    for (size_t i = 0; i < unknowns->count; i++) {
        for (int at = unknowns->start[i]; at < unknowns->start[i + 1]; at++) {
            const int v = unknowns->vertex[at];
            add_row(unknowns, complex, v, self->shift, &rows);
            for (int k = complex->ring_start[v] - 1; stokes && k < complex->ring_start[v + 1]; k++) {
                const bool self_row = k < complex->ring_start[v];
                const int w = self_row ? v : complex->ring_vertex[k];
                const double entry = self_row ? diagonal(complex, v) : -complex->star1[complex->ring_edge[k]];
                if (by_formula(self->flow, w)) {
                    add_row(unknowns, complex, w, self->viscosity * entry / complex->star0[w], &rows);
                }
            }
        }
        gm_matrix_end_row(&rows, false);
    }
    const struct gm_matrix matrix = gm_matrix_end(&rows);
    self->factor = gm_cholesky_open(matrix.rows, matrix.start, matrix.column, matrix.value, self->precision);
}

struct gm_cholesky *gm_unknowns_factor(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                                       enum gm_cholesky_precision precision, double shift, double viscosity)
{
    struct factoring self = {unknowns, flow, precision, shift, viscosity, NULL};
    gm_arena_run_once(factor, &self);
    return self.factor;
}

void gm_unknowns_solve_poisson(const struct gm_unknowns *unknowns, const struct gm_flow *flow,
                               struct gm_cholesky *factor, const double *right, double *b, double *psi)
{
    const struct gm_complex *complex = flow->complex;
    double *x = b + unknowns->count;
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
