/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Convection and diffusion as a matrix in the pattern of the complex' rings, and systems with it. */
#include "core/flow/solver.h"

#include <math.h>
#include <string.h>

#include "core/form/matrix.h"
#include "core/linear/cholesky.h"

struct gm_transport gm_transport_of(struct gm_arena *arena, const struct gm_complex *complex)
{
    return (struct gm_transport){.complex = complex,
                                 .diagonal = gm_arena_take(arena, complex->vertices, sizeof(double)),
                                 .ring = gm_arena_take(arena, 2 * complex->edges, sizeof(double)),
                                 .pivot = gm_arena_take(arena, complex->vertices, sizeof(double))};
}

void gm_transport_assemble(struct gm_transport *transport, const double *flux, double shift, double share,
                           double diffusion, enum gm_backflow backflow)
{
    const struct gm_complex *complex = transport->complex;
    double *diagonal = transport->diagonal;
    for (size_t v = 0; v < complex->vertices; v++) {
        diagonal[v] = shift * complex->star0[v];
    }
    for (size_t e = 0; e < complex->edges; e++) {
        const double carried = share * flux[e] / 2, spread = share * diffusion * complex->star1[e];
        diagonal[complex->edge[2 * e]] += spread + carried;
        diagonal[complex->edge[2 * e + 1]] += spread - carried;
        transport->ring[complex->edge_ring[2 * e]] = carried - spread;
        transport->ring[complex->edge_ring[2 * e + 1]] = -carried - spread;
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        double out = 0;
        for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
            const int e = complex->ring_edge[k];
            out += complex->edge[2 * e] == v ? -flux[e] : flux[e];
        }
        diagonal[v] += share * (backflow == GM_BACKFLOW_ZERO ? fmax(out, 0) : out);
    }
}

void gm_transport_apply(const struct gm_transport *transport, const double *x, double *y)
{
    const struct gm_complex *complex = transport->complex;
    for (size_t v = 0; v < complex->vertices; v++) {
        double sum = transport->diagonal[v] * x[v];
        for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
            sum += transport->ring[k] * x[complex->ring_vertex[k]];
        }
        y[v] = sum;
    }
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* residual = right - matrix x on the rows that are not fixed, 0 on the others; its norm */
static double residual_of(const struct gm_transport *transport, const bool *fixed, const double *right,
                          const double *x, double *residual)
{
    gm_transport_apply(transport, x, residual);
    const size_t n = transport->complex->vertices;
    for (size_t v = 0; v < n; v++) {
        residual[v] = fixed[v] ? 0 : right[v] - residual[v];
    }
    return sqrt(dot(residual, residual, n));
}

void gm_transport_factor(struct gm_transport *transport, const bool *fixed)
{
    const struct gm_complex *complex = transport->complex;
    for (size_t v = 0; v < complex->vertices; v++) {
        double pivot = transport->diagonal[v];
        for (int k = complex->ring_start[v];
             k < complex->ring_start[v + 1] && complex->ring_vertex[k] < (int)v; k++) {
            const int *ring = complex->edge_ring + 2 * complex->ring_edge[k];
            pivot -= transport->ring[ring[0]] * transport->ring[ring[1]] *
                     transport->pivot[complex->ring_vertex[k]];
        }
        transport->pivot[v] = fixed[v] ? 0 : 1 / pivot;
    }
}

void gm_transport_precondition(const struct gm_transport *transport, const double *r, double *x)
{
    const struct gm_complex *complex = transport->complex;
    const int *start = complex->ring_start, *vertex = complex->ring_vertex;
    /* each row waits for the one before: for a product and a difference, of an x that is taken before it is
       in memory */
    double last = 0;
    for (int v = 0; v < (int)complex->vertices; v++) {
        double sum = r[v], next = 0;
        int k = start[v];
        for (; k < start[v + 1] && vertex[k] < v - 1; k++) {
            sum -= transport->ring[k] * x[vertex[k]];
        }
        if (k < start[v + 1] && vertex[k] == v - 1) {
            next = transport->pivot[v] * transport->ring[k];
        }
        x[v] = last = transport->pivot[v] * sum - next * last;
    }
    for (int v = (int)complex->vertices - 1; v >= 0; v--) {
        double sum = 0, next = 0;
        int k = start[v + 1] - 1;
        for (; k >= start[v] && vertex[k] > v + 1; k--) {
            sum += transport->ring[k] * x[vertex[k]];
        }
        if (k >= start[v] && vertex[k] == v + 1) {
            next = transport->pivot[v] * transport->ring[k];
        }
        x[v] = last = x[v] - transport->pivot[v] * sum - next * last;
    }
}

/* matrix times p preconditioned, on the rows that are not fixed */
static void apply_scaled(const struct gm_transport *transport, const bool *fixed, const double *p,
                         double *scaled, double *product)
{
    const size_t n = transport->complex->vertices;
    gm_transport_precondition(transport, p, scaled);
    gm_transport_apply(transport, scaled, product);
    for (size_t v = 0; v < n; v++) {
        product[v] = fixed[v] ? 0 : product[v];
    }
}

/* Adds to x the solution of matrix d = r. Stops when the residual is below `small`; returns false if it
   stays above. */
static bool bicgstab(const struct gm_transport *transport, const bool *fixed, double *r, double *x,
                     double small, double *scratch, unsigned long *iterations)
{
    enum { MOST = 200 };
    const size_t n = transport->complex->vertices;
    double *shadow = scratch, *p = scratch + n, *v = scratch + 2 * n, *t = scratch + 3 * n,
           *scaled = scratch + 4 * n, *scaled_r = scratch + 5 * n;
    memcpy(shadow, r, n * sizeof *r);
    memset(p, 0, n * sizeof *p);
    memset(v, 0, n * sizeof *v);
    double rho = 1, alpha = 1, omega = 1;
    for (int i = 0; i < MOST; i++) {
        const double rho_before = rho;
        rho = dot(shadow, r, n);
        const double beta = rho / rho_before * (alpha / omega);
        for (size_t k = 0; k < n; k++) {
            p[k] = r[k] + beta * (p[k] - omega * v[k]);
        }
        apply_scaled(transport, fixed, p, scaled, v);
        alpha = rho / dot(shadow, v, n);
        for (size_t k = 0; k < n; k++) {
            r[k] -= alpha * v[k];
        }
        apply_scaled(transport, fixed, r, scaled_r, t);
        const double tt = dot(t, t, n);
        omega = tt > 0 ? dot(t, r, n) / tt : 0;
        for (size_t k = 0; k < n; k++) {
            x[k] += alpha * scaled[k] + omega * scaled_r[k];
            r[k] -= omega * t[k];
        }
        (*iterations)++;
        const double left = sqrt(dot(r, r, n));
        if (!isfinite(left)) {
            return false;
        }
        if (left <= small) {
            return true;
        }
        if (omega == 0) {
            return false;
        }
    }
    return false;
}

bool gm_transport_solve(struct gm_transport *transport, const bool *fixed, const double *right, double *x,
                        double *scratch, unsigned long *iterations)
{
    enum { ROUNDS = 4 };
    const size_t n = transport->complex->vertices;
    double *r = scratch + 6 * n, *b = scratch + 7 * n;
    /* a power of two keeps squares of huge values finite, and every bit */
    double largest = 0;
    for (size_t v = 0; v < n; v++) {
        largest = fmax(largest, fmax(fabs(right[v]), fabs(x[v])));
    }
    if (!isfinite(largest)) {
        return false;
    }
    int exponent = 0;
    frexp(largest, &exponent);
    for (size_t v = 0; v < n; v++) {
        b[v] = ldexp(right[v], -exponent);
        x[v] = ldexp(x[v], -exponent);
    }
    bool solved = largest == 0;
    double norm = 0;
    for (size_t v = 0; v < n; v++) {
        norm = fmax(norm, fabs(transport->diagonal[v] * x[v]));
        norm = fmax(norm, fixed[v] ? 0 : fabs(b[v]));
    }
    norm *= sqrt((double)n);
    gm_transport_factor(transport, fixed);
    double left = residual_of(transport, fixed, b, x, r);
    for (int round = 0; round < ROUNDS && !solved; round++) {
        if (left <= 2e-17 * norm) {
            solved = true;
            break;
        }
        if (!bicgstab(transport, fixed, r, x, fmax(1e-9 * left, 1e-18 * norm), scratch, iterations)) {
            break;
        }
        const double before = left;
        left = residual_of(transport, fixed, b, x, r);
        solved = left > before / 2 && left <= 1e-13 * norm; /* all that round-off leaves */
    }
    for (size_t v = 0; v < n; v++) {
        x[v] = ldexp(x[v], exponent);
    }
    solved = solved || left <= 1e-13 * norm;
    return solved || gm_transport_solve_directly(transport, fixed, right, x);
}

/* A system that is solved with LU. */
struct direct {
    const struct gm_transport *transport;
    const bool *fixed;
    const double *right;
    double *x;
};

static void solve_directly(struct gm_arena *arena, void *data)
{
    const struct direct *direct = data;
    const struct gm_transport *transport = direct->transport;
    const struct gm_complex *complex = transport->complex;
    const size_t n = complex->vertices;
    struct gm_matrix_rows rows = gm_matrix_begin(arena, n, n, n + 2 * complex->edges);
    double *b = gm_arena_take(arena, n, sizeof *b);
    for (size_t v = 0; v < n; v++) {
        const bool fixed = direct->fixed[v];
        b[v] = fixed ? direct->x[v] : direct->right[v];
        gm_matrix_add(&rows, (int)v, fixed ? 1 : transport->diagonal[v]);
        for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1] && !fixed; k++) {
            gm_matrix_add(&rows, complex->ring_vertex[k], transport->ring[k]);
        }
        gm_matrix_end_row(&rows, true);
    }
    const struct gm_matrix matrix = gm_matrix_end(&rows);
    gm_arena_need(arena, gm_lu_solve(n, matrix.start, matrix.column, matrix.value, b, direct->x));
}

bool gm_transport_solve_directly(const struct gm_transport *transport, const bool *fixed, const double *right,
                                 double *x)
{
    return gm_arena_run_once(solve_directly, &(struct direct){transport, fixed, right, x});
}
