/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear algebra of the steps. With z = (psi at unknowns I, omega at soft vertices O) and, psi of a hole's
   wall being one unknown, rows of its vertices summed up (the pressure comes back to itself around the hole),
       omega(z) = W (K psi + sheet) + omega_O,   W = 1 / star0, 0 at soft and slip vertices
   steps and steady states are equations R omega(z) = right on the rows I and O, R = C + B with the convection
   C and B = shift star0 + viscosity K. The preconditioner knows C where omega is free (J: I without holes,
   and O), by incomplete factors of R_JJ; what walls give back is solved without it:
       w_J ~ R_JJ^-1 r_J,   0 elsewhere,   z_O = w_O
       z_I = (shift K_II + viscosity K_I W K_I)^-1 (r_I - C_IJ w_J - B_IO w_O)
   That is the better, the thinner the layer is that walls make in a step. */
#include "core/flow/solver.h"
#include "core/basics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns true if omega of a vertex has an equation of its own. */
static bool has_row(const struct gm_flow_solver *solver, size_t v)
{
    const struct gm_unknowns *unknowns = &solver->unknowns;
    const int i = unknowns->index[v];
    return solver->flow->kind[v] == GM_VERTEX_SOFT ||
           (i >= 0 && unknowns->start[i + 1] - unknowns->start[i] == 1);
}

static bool list_unknowns(struct gm_flow_solver *solver)
{
    const struct gm_flow *flow = solver->flow;
    const size_t n = flow->complex->vertices;
    solver->soft_vertex = malloc(n * sizeof *solver->soft_vertex);
    solver->warm_vertex = malloc(n * sizeof *solver->warm_vertex);
    solver->held = malloc(n * sizeof *solver->held);
    if (!solver->soft_vertex || !solver->warm_vertex || !solver->held) {
        return false;
    }
    for (size_t v = 0; v < n; v++) {
        if (flow->heat && !flow->temperature_fixed[v]) {
            solver->warm_vertex[solver->warm++] = (int)v;
        }
        solver->held[v] = solver->vorticity_form ? flow->kind[v] == GM_VERTEX_SLIP : !has_row(solver, v);
        if (flow->kind[v] == GM_VERTEX_SOFT) {
            solver->soft_vertex[solver->soft++] = (int)v;
        }
    }
    return true;
}

static bool take_memory(struct gm_flow_solver *solver)
{
    const struct gm_complex *complex = solver->flow->complex;
    const bool psi = !solver->vorticity_form;
    const size_t v = complex->vertices, z = solver->unknowns.count + solver->soft;
    const struct {
        double **place;
        size_t size;
    } wanted[] = {
        {&solver->flux, complex->edges},
        {&solver->centre, complex->triangles},
        {&solver->rate, v},
        {&solver->field, v},
        {&solver->velocities, 3 * v},
        {&solver->carried_rate, solver->flow->scalar ? v : 0},
        {&solver->b, z + solver->warm},
        {&solver->x, z + solver->warm},
        {&solver->small_b, z},
        {&solver->convection.diagonal, psi ? v : 0},
        {&solver->convection.ring, psi ? 2 * complex->edges : 0},
        {&solver->gmres, psi ? gm_gmres_scratch(z) : 0},
        {&solver->bicgstab, 8 * v},
    };
    size_t total = 0;
    for (size_t i = 0; i < GM_COUNT(wanted); i++) {
        total += wanted[i].size;
    }
    solver->numbers = calloc(total, sizeof *solver->numbers);
    if (!solver->numbers) {
        return false;
    }
    double *at = solver->numbers;
    for (size_t i = 0; i < GM_COUNT(wanted); i++) {
        *wanted[i].place = at;
        at += wanted[i].size;
    }
    return true;
}

/* A flow driven by inlet, outlet and lid is on the whole no faster than the fastest point of their flow
   without vorticity: a state above twice its square, in the mean over the domain, is an artefact. Without
   a drive, with heat, or with a changing boundary there is no limit. */
static double energy_limit(struct gm_flow_solver *solver)
{
    const struct gm_flow *flow = solver->flow;
    if (flow->speed == 0 || flow->give || (flow->heat && flow->buoyancy != 0) ||
        solver->unknowns.count == 0) {
        return INFINITY;
    }
    memcpy(solver->rate, flow->psi, flow->complex->vertices * sizeof *solver->rate);
    gm_unknowns_solve_poisson(&solver->unknowns, flow, solver->poisson, NULL, solver->b, solver->x,
                              solver->rate);
    const double largest = gm_flow_largest_speed(flow, solver->rate);
    return largest * largest * flow->complex->total_area;
}

struct gm_flow_solver *gm_flow_solver_open(const struct gm_flow *flow)
{
    struct gm_flow_solver *solver = calloc(1, sizeof *solver);
    if (!solver) {
        return NULL;
    }
    solver->now = flow->give ? gm_flow_open_now(flow) : NULL;
    if (flow->give && !solver->now) {
        free(solver);
        return NULL;
    }
    solver->flow = flow->give ? solver->now : flow;
    solver->convection.complex = solver->flow->complex;
    solver->energy_limit = INFINITY;
    solver->vorticity_form = gm_flow_is_vorticity_form(flow);
    bool good = gm_unknowns_open(&solver->unknowns, flow) && list_unknowns(solver) && take_memory(solver) &&
                gm_transport_open(&solver->transport, flow->complex) &&
                (!flow->heat || gm_transport_open(&solver->heat, flow->complex)) &&
                (!flow->scalar || gm_transport_open(&solver->carried, flow->complex));
    if (!good) {
        gm_flow_solver_close(solver);
        solver = NULL;
    }
    return solver;
}

void gm_flow_solver_close(struct gm_flow_solver *solver)
{
    if (!solver) {
        return;
    }
    gm_flow_close_now(solver->now);
    gm_unknowns_close(&solver->unknowns);
    gm_cholesky_close(solver->poisson);
    gm_cholesky_close(solver->stokes);
    gm_transport_close(&solver->transport);
    gm_transport_close(&solver->heat);
    gm_transport_close(&solver->carried);
    free(solver->soft_vertex);
    free(solver->warm_vertex);
    free(solver->held);
    free(solver->numbers);
    free(solver);
}

bool gm_flow_solver_give(struct gm_flow_solver *solver, double t)
{
    return !solver->now || solver->now->give(solver->now, t, solver->now);
}

/* The larger factor first: while it is made there is room for the other one, which memory at its most does
   not hold then. */
bool gm_flow_solver_factor(struct gm_flow_solver *solver, double shift, double viscosity)
{
    const struct gm_unknowns *unknowns = &solver->unknowns;
    const bool there = solver->poisson &&
                       (solver->vorticity_form || (solver->shift == shift && solver->viscosity == viscosity));
    if (unknowns->count == 0 || there) {
        return true;
    }
    const bool first = !solver->poisson && !solver->stokes;
    gm_cholesky_close(solver->poisson);
    gm_cholesky_close(solver->stokes);
    solver->poisson = solver->stokes = NULL;
    if (!solver->vorticity_form) {
        solver->stokes = gm_unknowns_factor_stokes(unknowns, solver->flow, shift, viscosity);
    }
    if (solver->vorticity_form || solver->stokes) {
        solver->poisson = gm_unknowns_factor_poisson(unknowns, solver->flow);
    }
    solver->shift = shift;
    solver->viscosity = viscosity;
    if (first && solver->poisson) {
        solver->energy_limit = energy_limit(solver);
    }
    return solver->poisson != NULL;
}

/* y = (R omega(z) without sheet and given psi) on the rows I and O */
static void apply(void *data, const double *z, double *y)
{
    struct gm_flow_solver *solver = data;
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    const struct gm_unknowns *unknowns = &solver->unknowns;
    double *psi = solver->rate, *omega = solver->field;
    for (size_t v = 0; v < complex->vertices; v++) {
        psi[v] = unknowns->index[v] < 0 ? 0 : z[unknowns->index[v]];
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        omega[v] = flow->kind[v] == GM_VERTEX_SLIP ? 0 : gm_flow_row(complex, psi, v) / complex->star0[v];
    }
    for (size_t i = 0; i < solver->soft; i++) {
        omega[solver->soft_vertex[i]] = z[unknowns->count + i];
    }
    gm_transport_apply(&solver->transport, omega, psi);
    gm_unknowns_gather(unknowns, psi, y);
    for (size_t i = 0; i < solver->soft; i++) {
        y[unknowns->count + i] = psi[solver->soft_vertex[i]];
    }
}

/* The convection C of solver->transport, but for the soft vertices' columns, which keep B. */
static void take_convection(struct gm_flow_solver *solver)
{
    const struct gm_complex *complex = solver->flow->complex;
    const struct gm_transport *transport = &solver->transport;
    for (size_t v = 0; v < complex->vertices; v++) {
        double spread = 0;
        for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
            const double star = solver->viscosity * complex->star1[complex->ring_edge[k]];
            const bool soft = solver->flow->kind[complex->ring_vertex[k]] == GM_VERTEX_SOFT;
            spread += star;
            solver->convection.ring[k] = transport->ring[k] + (soft ? 0 : star);
        }
        solver->convection.diagonal[v] = transport->diagonal[v] - solver->shift * complex->star0[v] - spread;
    }
}

static void precondition(void *data, const double *r, double *z)
{
    struct gm_flow_solver *solver = data;
    const struct gm_unknowns *unknowns = &solver->unknowns;
    double *b = solver->small_b, *right = solver->rate, *omega = solver->field;
    for (size_t v = 0; v < solver->flow->complex->vertices; v++) {
        right[v] = unknowns->index[v] < 0 ? 0 : r[unknowns->index[v]];
    }
    for (size_t i = 0; i < solver->soft; i++) {
        right[solver->soft_vertex[i]] = r[unknowns->count + i];
    }
    gm_transport_precondition(&solver->transport, right, omega);
    gm_transport_apply(&solver->convection, omega, right);
    gm_unknowns_gather(unknowns, right, b);
    for (size_t i = 0; i < unknowns->count; i++) {
        b[i] = r[i] - b[i];
    }
    for (size_t i = 0; i < solver->soft; i++) {
        z[unknowns->count + i] = omega[solver->soft_vertex[i]];
    }
    gm_cholesky_solve(solver->stokes, b, z);
    solver->factor_solves++;
}

/* A row of the full matrix on its way: entries by column, added up. */
struct full {
    size_t n;
    int *start, *column, *place;
    double *value;
    size_t used, capacity;
    int row;
};

static void put(struct full *full, int column, double value)
{
    if (column < 0) {
        return;
    }
    if (full->place[column] < full->start[full->row]) {
        full->place[column] = (int)full->used;
        full->column[full->used] = column;
        full->value[full->used++] = 0;
    }
    full->value[full->place[column]] += value;
}

/* scale times row v of omega(z) */
static void put_vorticity(struct full *full, const struct gm_flow_solver *solver, const int *soft_index,
                          int v, double scale)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    if (flow->kind[v] == GM_VERTEX_SLIP) {
        return;
    }
    if (flow->kind[v] == GM_VERTEX_SOFT) {
        put(full, soft_index[v], scale);
        return;
    }
    scale /= complex->star0[v];
    double diagonal = 0;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const double star = complex->star1[complex->ring_edge[k]];
        diagonal += star;
        put(full, solver->unknowns.index[complex->ring_vertex[k]], -scale * star);
    }
    put(full, solver->unknowns.index[v], scale * diagonal);
}

/* scale times the derivative of the flux over edge e by psi */
static void put_flux(struct full *full, const struct gm_flow_solver *solver, size_t e, double scale)
{
    const struct gm_complex *complex = solver->flow->complex;
    for (int side = 0; side < 2; side++) {
        const int t = complex->edge_triangle[2 * e + (size_t)side];
        const double sign = side == 0 ? scale : -scale;
        for (int k = 0; k < 3 && t >= 0; k++) {
            put(full, solver->unknowns.index[complex->triangle[3 * t + k]],
                sign * complex->weight[3 * t + k]);
        }
        for (int k = 0; k < 2 && t < 0; k++) {
            put(full, solver->unknowns.index[complex->edge[2 * e + (size_t)k]], sign / 2);
        }
    }
}

static int compare_columns(const void *a, const void *b)
{
    const int p = *(const int *)a, q = *(const int *)b;
    return (p > q) - (p < q);
}

/* Columns of the row in increasing order; buffer: as many numbers as there are columns. */
static void sort_row(struct full *full, double *buffer)
{
    const size_t begin = (size_t)full->start[full->row], count = full->used - begin;
    for (size_t i = begin; i < full->used; i++) {
        buffer[full->column[i]] = full->value[i];
    }
    qsort(full->column + begin, count, sizeof(int), compare_columns);
    for (size_t i = begin; i < full->used; i++) {
        full->value[i] = buffer[full->column[i]];
        full->place[full->column[i]] = (int)i;
    }
}

static void put_row(struct full *full, const struct gm_flow_solver *solver, const int *soft_index, int v,
                    const double *omega)
{
    const struct gm_complex *complex = solver->flow->complex;
    put_vorticity(full, solver, soft_index, v, solver->transport.diagonal[v]);
    double out = 0;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const int w = complex->ring_vertex[k];
        const size_t e = (size_t)complex->ring_edge[k];
        const double sign = complex->edge[2 * e] == v ? 1 : -1;
        put_vorticity(full, solver, soft_index, w, solver->transport.ring[k]);
        if (omega) {
            put_flux(full, solver, e, sign * (omega[v] + omega[w]) / 2);
            out -= sign * solver->flux[e];
        }
    }
    if (omega && solver->flow->kind[v] == GM_VERTEX_OPEN && out > 0) {
        for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
            const size_t e = (size_t)complex->ring_edge[k];
            put_flux(full, solver, e, (complex->edge[2 * e] == v ? -1 : 1) * omega[v]);
        }
    }
}

/* Row v of what gm_flow_add_lift takes of temperature, on the left side of the equation. */
static void put_lift(struct full *full, const struct gm_flow_solver *solver, const int *warm_index, int v)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const size_t e = (size_t)complex->ring_edge[k];
        const int *end = complex->edge + 2 * e, *side = complex->edge_triangle + 2 * e;
        const double sign = end[0] == v ? -flow->buoyancy : flow->buoyancy,
                     height = (complex->point[2 * end[0] + 1] + complex->point[2 * end[1] + 1]) / 2;
        for (int s = 0; s < 2; s++) {
            double centre[2];
            if (side[s] < 0) {
                continue;
            }
            gm_complex_centre(complex, (size_t)side[s], centre);
            const double half = (s == 0 ? sign : -sign) * (centre[1] - height) / 2;
            for (int c = 0; c < 3; c++) {
                put(full, warm_index[complex->triangle[3 * side[s] + c]],
                    half * complex->weight[3 * side[s] + c]);
            }
            put(full, warm_index[end[0]], half / 2);
            put(full, warm_index[end[1]], half / 2);
        }
        const bool boundary = side[0] < 0 || side[1] < 0;
        if (boundary && flow->hole[v] == 0) {
            /* along the boundary, which has the room on its left */
            const int w = complex->ring_vertex[k];
            const bool leaves = (end[0] == v) == (side[0] >= 0);
            const double rise = (complex->point[2 * w + 1] - complex->point[2 * v + 1]) / 2,
                         part = -flow->buoyancy * (leaves ? rise : -rise);
            put(full, warm_index[v], part * 3 / 4);
            put(full, warm_index[w], part / 4);
        }
    }
}

/* The equation of temperature at v: convection and diffusion, and what the fluxes change in it. */
static void put_heat(struct full *full, const struct gm_flow_solver *solver, const int *warm_index, int v,
                     const double *temperature)
{
    const struct gm_complex *complex = solver->flow->complex;
    put(full, warm_index[v], solver->heat.diagonal[v]);
    bool boundary = false;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const size_t e = (size_t)complex->ring_edge[k];
        boundary |= complex->edge_triangle[2 * e] < 0 || complex->edge_triangle[2 * e + 1] < 0;
    }
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const int w = complex->ring_vertex[k];
        const size_t e = (size_t)complex->ring_edge[k];
        const double sign = complex->edge[2 * e] == v ? 1 : -1,
                     mean = (temperature[v] + temperature[w]) / 2 - (boundary ? temperature[v] : 0);
        put(full, warm_index[w], solver->heat.ring[k]);
        put_flux(full, solver, e, sign * mean);
    }
}

/* x = matrix^-1 b by LU; omega: with the derivative of the fluxes (else NULL); temperature: with its rows,
   too. */
static bool solve_directly(struct gm_flow_solver *solver, const double *omega, const double *temperature)
{
    const struct gm_complex *complex = solver->flow->complex;
    const struct gm_unknowns *unknowns = &solver->unknowns;
    const size_t warm = temperature ? solver->warm : 0, flow_rows = unknowns->count + solver->soft;
    struct full full = {.n = flow_rows + warm};
    int *soft_index = malloc(complex->vertices * sizeof *soft_index),
        *warm_index = malloc(complex->vertices * sizeof *warm_index);
    double *buffer = malloc(full.n * sizeof *buffer);
    for (size_t v = 0; v < complex->vertices; v++) {
        for (int k = complex->ring_start[v] - 1; k < complex->ring_start[v + 1]; k++) {
            const int w = k < complex->ring_start[v] ? (int)v : complex->ring_vertex[k];
            full.capacity += (size_t)(complex->ring_start[w + 1] - complex->ring_start[w] + 2);
        }
    }
    full.capacity *= warm > 0 ? 3 : 1;
    full.start = malloc((full.n + 1) * sizeof(int));
    full.column = malloc(full.capacity * sizeof(int));
    full.value = malloc(full.capacity * sizeof(double));
    full.place = malloc(full.n * sizeof(int));
    bool good = soft_index && warm_index && buffer && full.start && full.column && full.value && full.place &&
                full.n > 0;
    if (good) {
        memset(full.place, -1, full.n * sizeof(int));
        memset(soft_index, -1, complex->vertices * sizeof *soft_index);
        memset(warm_index, -1, complex->vertices * sizeof *warm_index);
        for (size_t i = 0; i < solver->soft; i++) {
            soft_index[solver->soft_vertex[i]] = (int)(unknowns->count + i);
        }
        for (size_t i = 0; i < warm; i++) {
            warm_index[solver->warm_vertex[i]] = (int)(flow_rows + i);
        }
        for (full.row = 0; full.row < (int)full.n; full.row++) {
            const size_t i = (size_t)full.row;
            const bool flows = i < flow_rows, stream = i < unknowns->count;
            const int *vertex = stream  ? unknowns->vertex + unknowns->start[i]
                                : flows ? solver->soft_vertex + (i - unknowns->count)
                                        : solver->warm_vertex + (i - flow_rows);
            const int vertices = stream ? unknowns->start[i + 1] - unknowns->start[i] : 1;
            full.start[full.row] = (int)full.used;
            for (int k = 0; k < vertices; k++) {
                if (flows) {
                    put_row(&full, solver, soft_index, vertex[k], omega);
                } else {
                    put_heat(&full, solver, warm_index, vertex[k], temperature);
                }
                if (flows && warm > 0) {
                    put_lift(&full, solver, warm_index, vertex[k]);
                }
            }
            sort_row(&full, buffer);
        }
        full.start[full.n] = (int)full.used;
        good = gm_lu_solve(full.n, full.start, full.column, full.value, solver->b, solver->x);
    }
    free(soft_index);
    free(warm_index);
    free(buffer);
    free(full.start);
    free(full.column);
    free(full.value);
    free(full.place);
    return good;
}

bool gm_flow_solver_correct(struct gm_flow_solver *solver, double size, unsigned long *iterations)
{
    const double tolerance = 1e-13;
    const size_t n = solver->unknowns.count + solver->soft;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(solver->b[i])) {
            return false;
        }
    }
    gm_transport_factor(&solver->transport, solver->held);
    take_convection(solver);
    const struct gm_system system = {n, apply, precondition, solver};
    return gm_gmres(&system, solver->b, solver->x, tolerance * size, solver->gmres, iterations) ||
           solve_directly(solver, NULL, NULL);
}

bool gm_flow_solver_newton(struct gm_flow_solver *solver, const double *omega, const double *temperature)
{
    if (temperature) {
        gm_transport_apply(&solver->heat, temperature, solver->field);
    }
    for (size_t i = 0; temperature && i < solver->warm; i++) {
        const int v = solver->warm_vertex[i];
        solver->b[solver->unknowns.count + solver->soft + i] = solver->flow->heating[v] - solver->field[v];
    }
    return solve_directly(solver, omega, temperature);
}
