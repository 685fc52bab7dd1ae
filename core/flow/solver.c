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
#include "core/form/matrix.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Returns true if omega of a vertex has an equation of its own. */
static bool has_row(const struct gm_flow_solver *solver, size_t v)
{
    const struct gm_unknowns *unknowns = &solver->unknowns;
    const int i = unknowns->index[v];
    return solver->flow->kind[v] == GM_VERTEX_SOFT ||
           (i >= 0 && unknowns->start[i + 1] - unknowns->start[i] == 1);
}

static void take_memory(struct gm_flow_solver *solver)
{
    const struct gm_complex *complex = solver->flow->complex;
    struct gm_arena *arena = solver->arena;
    const struct gm_unknowns *unknowns = &solver->unknowns;
    const size_t v = complex->vertices, z = unknowns->flow;
    solver->flux = gm_arena_take(arena, complex->edges, sizeof(double));
    solver->centre = gm_arena_take(arena, complex->triangles, sizeof(double));
    solver->rate = gm_arena_take(arena, v, sizeof(double));
    solver->field = gm_arena_take(arena, v, sizeof(double));
    solver->velocities = gm_arena_take(arena, 3 * v, sizeof(double));
    solver->carried_rate = gm_arena_take(arena, v, sizeof(double));
    solver->held = gm_arena_take(arena, v, sizeof(bool));
    solver->b = gm_arena_take(arena, 2 * unknowns->all, sizeof(double));
    solver->x = solver->b + unknowns->all;
    solver->small_b = gm_arena_take(arena, z, sizeof(double));
    solver->bicgstab = gm_arena_take(arena, 8 * v, sizeof(double));
    solver->transport = gm_transport_of(arena, complex);
    if (!solver->vorticity_form) {
        solver->convection = gm_transport_of(arena, complex);
        solver->gmres = gm_arena_take(arena, gm_gmres_scratch(z), sizeof(double));
    }
    if (solver->flow->heat) {
        solver->heat = gm_transport_of(arena, complex);
    }
    if (solver->flow->scalar) {
        solver->carried = gm_transport_of(arena, complex);
    }
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
    gm_unknowns_solve_poisson(&solver->unknowns, flow, solver->poisson, NULL, solver->b, solver->rate);
    const double largest = gm_flow_largest_speed(flow, solver->rate);
    return largest * largest * flow->complex->total_area;
}

/* Returns true if omega at the unknowns of psi is an unknown without boundary values of psi: on closed
   surfaces and with slip walls. Then omega is stepped. */
static bool is_vorticity_form(const struct gm_flow *flow)
{
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        if (flow->kind[v] != GM_VERTEX_FREE && flow->kind[v] != GM_VERTEX_SLIP) {
            return false;
        }
    }
    return true;
}

/* Opens the solver of the flow that the data points to, and lets it point to the solver. */
static void open_solver(struct gm_arena *arena, void *data)
{
    const struct gm_flow *flow = *(const void **)data;
    struct gm_flow_solver *solver = gm_arena_take(arena, 1, sizeof *solver);
    solver->arena = arena;
    solver->now = flow->give ? gm_arena_keep(arena, gm_flow_open_now(flow), gm_flow_close) : NULL;
    solver->flow = flow->give ? solver->now : flow;
    solver->energy_limit = INFINITY;
    solver->vorticity_form = is_vorticity_form(flow);
    solver->unknowns = gm_unknowns_of(arena, flow);
    take_memory(solver);
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        solver->held[v] = solver->vorticity_form ? flow->kind[v] == GM_VERTEX_SLIP : !has_row(solver, v);
    }
    *(void **)data = solver;
}

void *gm_flow_solver_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    const void *opened = gm_flow_of(problem);
    struct gm_arena *arena = gm_arena_open();
    if (!gm_arena_run(arena, open_solver, &opened)) {
        gm_arena_close(arena);
        return NULL;
    }
    return (void *)(uintptr_t)opened;
}

void gm_flow_solver_close(void *workspace)
{
    struct gm_flow_solver *solver = workspace;
    if (solver) {
        gm_cholesky_close(solver->poisson);
        gm_cholesky_close(solver->stokes);
        gm_arena_close(solver->arena);
    }
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
        solver->stokes = gm_unknowns_factor(unknowns, solver->flow, GM_CHOLESKY_ROUGH, shift, viscosity);
    }
    if (solver->vorticity_form || solver->stokes) {
        solver->poisson = gm_unknowns_factor(unknowns, solver->flow, GM_CHOLESKY_EXACT, 1, 0);
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
        omega[v] = unknowns->soft[v] >= 0            ? z[unknowns->soft[v]]
                   : flow->kind[v] == GM_VERTEX_SLIP ? 0
                                                     : gm_flow_row(complex, psi, v) / complex->star0[v];
    }
    gm_transport_apply(&solver->transport, omega, psi);
    gm_unknowns_gather(unknowns, psi, y);
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
        const int i = unknowns->index[v] < 0 ? unknowns->soft[v] : unknowns->index[v];
        right[v] = i < 0 ? 0 : r[i];
    }
    gm_transport_precondition(&solver->transport, right, omega);
    gm_transport_apply(&solver->convection, omega, right);
    gm_unknowns_gather(unknowns, right, b);
    for (size_t i = 0; i < unknowns->count; i++) {
        b[i] = r[i] - b[i];
    }
    for (size_t i = unknowns->count; i < unknowns->flow; i++) {
        z[i] = omega[unknowns->vertex[unknowns->start[i]]];
    }
    gm_cholesky_solve(solver->stokes, b, z);
    solver->factor_solves++;
}

/* A system that is solved with LU: with the derivative of the fluxes, and rows of temperature, if they are
   not NULL. */
struct direct {
    struct gm_flow_solver *solver;
    const double *omega, *temperature;
    struct gm_matrix_rows rows;
};

static void put(struct direct *direct, int column, double value)
{
    gm_matrix_add(&direct->rows, column, value);
}

/* Adds to the column of a vertex' temperature, if it has one. */
static void put_warmth(struct direct *direct, int v, double value)
{
    put(direct, direct->solver->unknowns.warm[v], value);
}

/* scale times row v of omega(z) */
static void put_vorticity(struct direct *direct, int v, double scale)
{
    const struct gm_flow_solver *solver = direct->solver;
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    if (flow->kind[v] == GM_VERTEX_SLIP) {
        return;
    }
    if (flow->kind[v] == GM_VERTEX_SOFT) {
        put(direct, solver->unknowns.soft[v], scale);
        return;
    }
    scale /= complex->star0[v];
    double diagonal = 0;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const double star = complex->star1[complex->ring_edge[k]];
        diagonal += star;
        put(direct, solver->unknowns.index[complex->ring_vertex[k]], -scale * star);
    }
    put(direct, solver->unknowns.index[v], scale * diagonal);
}

/* scale times the derivative of the flux over edge e by psi */
static void put_flux(struct direct *direct, size_t e, double scale)
{
    const struct gm_flow_solver *solver = direct->solver;
    const struct gm_complex *complex = solver->flow->complex;
    for (int side = 0; side < 2; side++) {
        const int t = complex->edge_triangle[2 * e + (size_t)side];
        const double sign = side == 0 ? scale : -scale;
        for (int k = 0; k < 3 && t >= 0; k++) {
            put(direct, solver->unknowns.index[complex->triangle[3 * t + k]],
                sign * complex->weight[3 * t + k]);
        }
        for (int k = 0; k < 2 && t < 0; k++) {
            put(direct, solver->unknowns.index[complex->edge[2 * e + (size_t)k]], sign / 2);
        }
    }
}

/* Convection and diffusion of the vorticity, or of temperature, at v, and what the fluxes change in it; what leaves,
   and temperature on the boundary, carries the value of its own cell. */
static void put_transport(struct direct *direct, int v, bool warm)
{
    const struct gm_flow_solver *solver = direct->solver;
    const struct gm_complex *complex = solver->flow->complex;
    const struct gm_transport *transport = warm ? &solver->heat : &solver->transport;
    const double *values = warm ? direct->temperature : direct->omega;
    void (*put_value)(struct direct *, int, double) = warm ? put_warmth : put_vorticity;
    double out = 0;
    bool boundary = false;
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const size_t e = (size_t)complex->ring_edge[k];
        boundary |= complex->edge_triangle[2 * e] < 0 || complex->edge_triangle[2 * e + 1] < 0;
        out -= complex->edge[2 * e] == v ? solver->flux[e] : -solver->flux[e];
    }
    const bool own = warm ? boundary : solver->flow->kind[v] == GM_VERTEX_OPEN && out > 0;
    put_value(direct, v, transport->diagonal[v]);
    for (int k = complex->ring_start[v]; k < complex->ring_start[v + 1]; k++) {
        const int w = complex->ring_vertex[k], e = complex->ring_edge[k];
        put_value(direct, w, transport->ring[k]);
        if (values) {
            const double mean = (values[v] + values[w]) / 2 - (own ? values[v] : 0);
            put_flux(direct, (size_t)e, complex->edge[2 * e] == v ? mean : -mean);
        }
    }
}

/* Row v of what gm_flow_add_lift takes of temperature, on the left side of the equation. */
static void put_lift(struct direct *direct, int v)
{
    const struct gm_flow *flow = direct->solver->flow;
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
                put_warmth(direct, complex->triangle[3 * side[s] + c],
                           half * complex->weight[3 * side[s] + c]);
            }
            put_warmth(direct, end[0], half / 2);
            put_warmth(direct, end[1], half / 2);
        }
        const bool boundary = side[0] < 0 || side[1] < 0;
        if (boundary && flow->hole[v] == 0) {
            /* along the boundary, which has the room on its left */
            const int w = complex->ring_vertex[k];
            const bool leaves = (end[0] == v) == (side[0] >= 0);
            const double rise = (complex->point[2 * w + 1] - complex->point[2 * v + 1]) / 2,
                         part = -flow->buoyancy * (leaves ? rise : -rise);
            put_warmth(direct, v, part * 3 / 4);
            put_warmth(direct, w, part / 4);
        }
    }
}

/* x = matrix^-1 b */
static void solve_directly(struct gm_arena *arena, void *data)
{
    struct direct *direct = data;
    struct gm_flow_solver *solver = direct->solver;
    const struct gm_complex *complex = solver->flow->complex;
    const struct gm_unknowns *unknowns = &solver->unknowns;
    const bool warm = direct->temperature;
    const size_t n = warm ? unknowns->all : unknowns->flow;
    size_t most = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        for (int k = complex->ring_start[v] - 1; k < complex->ring_start[v + 1]; k++) {
            const int w = k < complex->ring_start[v] ? (int)v : complex->ring_vertex[k];
            most += (size_t)(complex->ring_start[w + 1] - complex->ring_start[w] + 2);
        }
    }
    direct->rows = gm_matrix_begin(arena, n, n, warm ? 3 * most : most);
    for (size_t i = 0; i < n; i++) {
        for (int k = unknowns->start[i]; k < unknowns->start[i + 1]; k++) {
            put_transport(direct, unknowns->vertex[k], i >= unknowns->flow);
            if (i < unknowns->flow && warm) {
                put_lift(direct, unknowns->vertex[k]);
            }
        }
        gm_matrix_end_row(&direct->rows, true);
    }
    const struct gm_matrix matrix = gm_matrix_end(&direct->rows);
    gm_arena_need(arena,
                  n > 0 && gm_lu_solve(n, matrix.start, matrix.column, matrix.value, solver->b, solver->x));
}

bool gm_flow_solver_correct(struct gm_flow_solver *solver, double size, unsigned long *iterations)
{
    const double tolerance = 1e-13;
    const size_t n = solver->unknowns.flow;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(solver->b[i])) {
            return false;
        }
    }
    gm_transport_factor(&solver->transport, solver->held);
    take_convection(solver);
    const struct gm_system system = {n, apply, precondition, solver};
    return gm_gmres(&system, solver->b, solver->x, tolerance * size, solver->gmres, iterations) ||
           gm_arena_run_once(solve_directly, &(struct direct){.solver = solver});
}

bool gm_flow_solver_newton(struct gm_flow_solver *solver, const double *omega, const double *temperature)
{
    if (temperature) {
        gm_transport_apply(&solver->heat, temperature, solver->field);
    }
    for (size_t i = solver->unknowns.flow; temperature && i < solver->unknowns.all; i++) {
        const int v = solver->unknowns.vertex[solver->unknowns.start[i]];
        solver->b[i] = solver->flow->heating[v] - solver->field[v];
    }
    return gm_arena_run_once(solve_directly, &(struct direct){solver, omega, temperature, {0}});
}
