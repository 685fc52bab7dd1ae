/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flow of rates that are linear in the components that they move; the others rest, and so do r and A:
       y' = r + A (y - y_0),   y(h) = y_0 + h r + h^2/2! A r + h^3/3! A^2 r + ...
   in parts of h in which the series falls off at once. Drifts and kicks have A = 0. If A is constant, one
   exponential serves all steps, by scaling and squaring, exp(A) = exp(A/2^k)^(2^k), of the balanced matrix:
   C. Moler & C. Van Loan, SIAM Rev. 45 (2003) 3. */
#include "core/ode/families/splitting/linear_flow.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/functions.h"

bool gm_linear_flow_derive(struct gm_arena *arena, struct gm_linear_flow *flow, struct gm_formula *graph,
                           const gm_node_id *rates, size_t n, size_t variables)
{
    bool *moving = gm_arena_take(arena, variables, sizeof *moving),
         *components = gm_arena_take(arena, variables, sizeof *components), linear = true;
    for (size_t i = 0; i < n; i++) {
        moving[i] = !gm_is_constant(graph, rates[i], 0);
        components[i] = true;
    }
    *flow = (struct gm_linear_flow){.n = n, .constant = true};
    gm_arena_need(arena, !graph->failed);
    flow->slopes = gm_sparse_jacobian(arena, graph, rates, n, moving, variables);
    flow->nodes = gm_sparse_nodes(arena, rates, n, &flow->slopes);
    for (size_t i = 0; i < flow->slopes.count; i++) {
        const gm_node_id slope = flow->slopes.entries[i].node;
        linear = linear && !gm_formula_holds(graph, slope, moving, variables);
    }
    if (flow->slopes.count == 0) {
        return true;
    }
    const struct gm_sparse all = gm_sparse_jacobian(arena, graph, rates, n, components, variables);
    for (size_t i = 0; i < all.count && flow->constant; i++) {
        flow->constant = !gm_formula_holds(graph, all.entries[i].node, components, variables);
    }
    gm_arena_need(arena, !graph->failed);
    return linear;
}

/* out := factor A in */
static void apply(const struct gm_linear_flow *flow, const double *A, double factor, const double *in,
                  double *out)
{
    memset(out, 0, flow->n * sizeof *out);
    for (size_t i = 0; i < flow->slopes.count; i++) {
        out[flow->slopes.entries[i].row] += factor * A[i] * in[flow->slopes.entries[i].column];
    }
}

/* Largest sum of a row's magnitudes. */
static double norm_of(const struct gm_linear_flow *flow, const double *A, double *sums)
{
    double largest = 0;
    memset(sums, 0, flow->n * sizeof *sums);
    for (size_t i = 0; i < flow->slopes.count; i++) {
        sums[flow->slopes.entries[i].row] += fabs(A[i]);
    }
    for (size_t i = 0; i < flow->n && flow->slopes.count > 0; i++) {
        largest = gm_larger(largest, sums[i]);
    }
    return largest;
}

void gm_linear_flow_advance(const struct gm_linear_flow *flow, double h, double *values, double *scratch,
                            double *y)
{
    enum { MOST_PARTS = 1000, TERMS = 30 };
    const size_t n = flow->n;
    double *r = values, *A = values + n, *term = scratch, *next = term + n, *moved = next + n;
    const double parts = 1 + floor(fabs(h) * norm_of(flow, A, next)), step = h / parts;
    if (!(parts <= MOST_PARTS)) {
        y[0] = NAN;
        return;
    }
    for (int part = 0; part < (int)parts; part++) {
        double size = 0, last = INFINITY;
        for (size_t i = 0; i < n; i++) {
            moved[i] = term[i] = step * r[i];
            size += fabs(term[i]);
        }
        for (int k = 2; k < TERMS && flow->slopes.count > 0 && last > 0x1p-60 * size; k++) {
            apply(flow, A, step / k, term, next);
            last = 0;
            for (size_t i = 0; i < n; i++) {
                term[i] = next[i];
                moved[i] += next[i];
                last += fabs(next[i]);
            }
        }
        for (size_t i = 0; i < n; i++) {
            y[i] += moved[i];
        }
        if (part + 1 < (int)parts) {
            apply(flow, A, 1, moved, next);
            for (size_t i = 0; i < n; i++) {
                r[i] += next[i];
            }
        }
    }
}

/* C := A B / divisor */
static void multiply(size_t n, const double *A, const double *B, double divisor, double *C)
{
    memset(C, 0, n * n * sizeof *C);
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            for (size_t j = 0; j < n && A[i * n + k] != 0; j++) {
                C[i * n + j] += A[i * n + k] / divisor * B[k * n + j];
            }
        }
    }
}

/* Scales rows and columns by powers of 2, A := D^-1 A D, until their norms agree; `powers` are those of D. */
static void balance(size_t n, double *A, int *powers)
{
    memset(powers, 0, n * sizeof *powers);
    for (bool again = true; again;) {
        again = false;
        for (size_t i = 0; i < n; i++) {
            double row = 0, column = 0;
            for (size_t j = 0; j < n; j++) {
                row += j == i ? 0 : fabs(A[i * n + j]);
                column += j == i ? 0 : fabs(A[j * n + i]);
            }
            const int power = row > 0 && column > 0 ? (int)(gm_log2(row / column) / 2) : 0;
            for (size_t j = 0; j < n && power != 0; j++) {
                A[i * n + j] = ldexp(A[i * n + j], -power);
                A[j * n + i] = ldexp(A[j * n + i], power);
            }
            powers[i] += power;
            again = again || power != 0;
        }
    }
}

void gm_exponential(size_t n, double *A, double *E, double *scratch)
{
    enum { LARGEST = 128, TERMS = 18 };
    int powers[LARGEST], halvings = 0;
    double norm = 0;
    balance(n, A, powers);
    for (size_t i = 0; i < n; i++) {
        double row = 0;
        for (size_t j = 0; j < n; j++) {
            row += fabs(A[i * n + j]);
        }
        norm = gm_larger(norm, row);
    }
    halvings = norm > 0.5 ? ilogb(norm) + 2 : 0;
    for (size_t i = 0; i < n * n; i++) {
        A[i] = ldexp(A[i], -halvings);
        E[i] = i % (n + 1) == 0;
    }
    for (int k = TERMS; k > 0; k--) {
        multiply(n, A, E, k, scratch);
        for (size_t i = 0; i < n * n; i++) {
            E[i] = scratch[i] + (i % (n + 1) == 0);
        }
    }
    for (int k = 0; k < halvings; k++) {
        multiply(n, E, E, 1, scratch);
        memcpy(E, scratch, n * n * sizeof *E);
    }
    for (size_t i = 0; i < n * n; i++) {
        E[i] = ldexp(E[i], powers[i / n] - powers[i % n]);
    }
}
