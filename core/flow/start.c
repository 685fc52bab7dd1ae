/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The states that a run may start from, without and with vorticity. */

#include <math.h>
#include <string.h>

#include "core/flow/matrices.h"

/* K psi = right inside, with the given boundary values; right == NULL: 0. */
struct poisson {
    const struct gm_flow *flow;
    const double *right;
    double *psi;
};

static void solve(struct gm_arena *arena, void *data)
{
    const struct poisson *poisson = data;
    const struct gm_unknowns unknowns = gm_unknowns_of(arena, poisson->flow);
    if (unknowns.count > 0) {
        struct gm_cholesky *factor = gm_arena_keep(
            arena, gm_unknowns_factor(&unknowns, poisson->flow, GM_CHOLESKY_EXACT, 1, 0), gm_cholesky_close);
        double *b = gm_arena_take(arena, 2 * unknowns.count, sizeof *b);
        gm_unknowns_solve_poisson(&unknowns, poisson->flow, factor, poisson->right, b, poisson->psi);
    }
}

/* Completes a state whose psi and omega are set. */
static void complete_start(const struct gm_flow *flow, double *y)
{
    const size_t n = flow->complex->vertices;
    memcpy(y + GM_FLOW_PSI_HALF * n, y, n * sizeof *y);
    memcpy(y + GM_FLOW_PSI_BEFORE * n, y, n * sizeof *y);
    memcpy(y + GM_FLOW_OMEGA_USED * n, y + GM_FLOW_OMEGA * n, n * sizeof *y);
    memcpy(y + GM_FLOW_THETA * n, flow->theta, n * sizeof *y);
    memcpy(y + GM_FLOW_THETA_BEFORE * n, flow->theta, n * sizeof *y);
    for (int block = GM_FLOW_TEMPERATURE; flow->heat && block < GM_FLOW_MOST_BLOCKS; block++) {
        memcpy(y + (size_t)block * n, flow->temperature, n * sizeof *y);
    }
    memset(y + gm_flow_block_numbers(flow), 0, (1 + GM_TRACER_NUMBERS * flow->tracers) * sizeof *y);
    gm_tracers_strew(flow, y);
}

bool gm_flow_start(const struct gm_flow *flow, const double *omega, double *y)
{
    const struct gm_complex *complex = flow->complex;
    const size_t n = complex->vertices;
    double *mine = y + GM_FLOW_OMEGA * n, *right = y + GM_FLOW_THETA * n;
    double sum = 0;
    for (size_t v = 0; omega && v < n; v++) {
        sum += complex->star0[v] * omega[v];
    }
    for (size_t v = 0; omega && v < n; v++) {
        mine[v] = flow->kind[v] == GM_VERTEX_SLIP ? 0
                  : complex->boundary == 0        ? omega[v] - sum / complex->total_area
                                                  : omega[v];
        right[v] = complex->star0[v] * mine[v];
    }
    memcpy(y, flow->psi, n * sizeof *y);
    if (!gm_arena_run_once(solve, &(struct poisson){flow, omega ? right : NULL, y})) {
        return false;
    }
    if (!omega) {
        memset(mine, 0, n * sizeof *y);
        gm_flow_vorticity(flow, y, mine);
    }
    complete_start(flow, y);
    return true;
}
