/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of flows on complexes as the hall sees it: the families of schemes, and how those are
   certified. */
#include "core/flow/flow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "core/certify.h"
#include "core/flow/boundary.h"
#include "core/flow/certify/quantities.h"
#include "core/flow/families/families.h"
#include "core/flow/rectangle.h"
#include "core/flow/start.h"
#include "core/memory.h"
#include "core/run.h"

enum { EDGES = 6, STRIPS = 8, MOST = EDGES * STRIPS };

static struct gm_flow *open_torus(double viscosity)
{
    const struct gm_rectangle torus = {
        .width = 1, .height = 1, .edges = EDGES, .strips = STRIPS, .torus = true, .irregular = 0.2};
    struct gm_triangulation_fault fault;
    struct gm_complex *complex = gm_rectangle_open(&torus, &fault);
    struct gm_flow *flow = complex ? gm_flow_open(complex) : NULL;
    if (flow) {
        flow->viscosity = viscosity;
    }
    return flow;
}

static struct gm_problem problem_of(const struct gm_flow *flow)
{
    return (struct gm_problem){
        .name = "flow", .n = gm_flow_size(flow), .m = 1, .kind = &gm_kind_flow, .parameters = flow};
}

static void swirl(const struct gm_flow *flow, double *omega)
{
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        const double x = 2 * M_PI * flow->complex->point[2 * v],
                     z = 2 * M_PI * flow->complex->point[2 * v + 1];
        omega[v] = 6 * sin(x + z + 0.3) + 5 * sin(x - 2 * z + 1.1) + 4 * sin(2 * x + z + 0.2);
    }
}

/* The semi-discrete equations. */
struct semi_discrete {
    const struct gm_flow *flow;
    gsl_matrix *inverse; /* of K with the last row and column left out */
};

static int rates(double t, const double *omega, double *rate, void *data)
{
    (void)t;
    const struct semi_discrete *system = data;
    const struct gm_complex *complex = system->flow->complex;
    const size_t n = complex->vertices;
    double psi[MOST] = {0}, centre[2 * MOST];
    for (size_t i = 0; i + 1 < n; i++) {
        for (size_t k = 0; k + 1 < n; k++) {
            psi[i] += gsl_matrix_get(system->inverse, i, k) * complex->star0[k] * omega[k];
        }
    }
    for (size_t f = 0; f < complex->triangles; f++) {
        centre[f] = 0;
        for (size_t k = 3 * f; k < 3 * f + 3; k++) {
            centre[f] += complex->weight[k] * psi[complex->triangle[k]];
        }
    }
    memset(rate, 0, n * sizeof *rate);
    for (size_t e = 0; e < complex->edges; e++) {
        const int a = complex->edge[2 * e], b = complex->edge[2 * e + 1];
        const double flux = centre[complex->edge_triangle[2 * e]] - centre[complex->edge_triangle[2 * e + 1]];
        const double carried = flux * (omega[a] + omega[b]) / 2 -
                               system->flow->viscosity * complex->star1[e] * (omega[b] - omega[a]);
        rate[a] -= carried / complex->star0[a];
        rate[b] += carried / complex->star0[b];
    }
    return GSL_SUCCESS;
}

/* Under the guard: no allocation returns without memory. */
static bool invert_poisson(void *data)
{
    struct semi_discrete *system = data;
    const struct gm_complex *complex = system->flow->complex;
    const size_t n = complex->vertices;
    gsl_matrix *matrix = gsl_matrix_calloc(n - 1, n - 1);
    gsl_permutation *permutation = gsl_permutation_alloc(n - 1);
    int sign = 0;
    system->inverse = gsl_matrix_alloc(n - 1, n - 1);
    for (size_t e = 0; e < complex->edges; e++) {
        const size_t ends[2] = {(size_t)complex->edge[2 * e], (size_t)complex->edge[2 * e + 1]};
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 2; k++) {
                if (ends[i] + 1 < n && ends[k] + 1 < n) {
                    *gsl_matrix_ptr(matrix, ends[i], ends[k]) += (i == k ? 1 : -1) * complex->star1[e];
                }
            }
        }
    }
    gsl_linalg_LU_decomp(matrix, permutation, &sign);
    gsl_linalg_LU_invert(matrix, permutation, system->inverse);
    gsl_matrix_free(matrix);
    gsl_permutation_free(permutation);
    return true;
}

static bool solve_by_gsl(const struct gm_flow *flow, double until, double *omega)
{
    struct semi_discrete system = {.flow = flow};
    const gsl_odeiv2_system equations = {rates, NULL, flow->complex->vertices, &system};
    const bool good =
        gm_memory_guard_gsl(invert_poisson, &system) && gm_certify_solve(&equations, 1e-13, until, omega);
    gsl_matrix_free(system.inverse);
    return good;
}

/* A run of a scheme; NULL when memory is short. */
static struct gm_run *run_for(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                              int64_t steps, const double *start)
{
    const struct gm_settings settings = {0};
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, start);
    if (run) {
        gm_run_advance(run, steps);
    }
    return run;
}

/* The slope over the two finest of three steps, and between the outer ones: they must agree to count. */
static void measure_order(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    enum { LADDER = 3 };
    const double until = 0.1;
    struct gm_flow *flow = open_torus(0.02);
    double exact[MOST], start[GM_FLOW_BLOCKS * MOST + 1], error[LADDER] = {0};
    if (!flow) {
        return;
    }
    const struct gm_problem problem = problem_of(flow);
    swirl(flow, exact);
    bool good = gm_flow_start_vorticity(flow, exact, start);
    memcpy(exact, gm_flow_block(flow, start, GM_FLOW_OMEGA), flow->complex->vertices * sizeof *exact);
    good = good && solve_by_gsl(flow, until, exact);
    int64_t steps = 64;
    for (int i = 0; good && i < LADDER; i++, steps *= 2) {
        struct gm_run *run = run_for(&problem, scheme, until / (double)steps, steps, start);
        good = run && run->status == GM_OK;
        for (size_t v = 0; good && v < flow->complex->vertices; v++) {
            const double *omega = gm_flow_block(flow, gm_run_state(run), GM_FLOW_OMEGA);
            error[i] = fmax(error[i], fabs(omega[v] - exact[v]));
        }
        gm_run_close(run);
    }
    gm_flow_close(flow);
    for (int i = 0; good && i < LADDER; i++) {
        certificate->ladder.dt[i] = until / (64 << i);
        certificate->ladder.error[i] = error[i];
        certificate->ladder.count++;
    }
    certificate->order = good ? log(error[0] / error[2]) / log(4) : NAN;
    certificate->order_problem = "torus";
    certificate->order_holds = fabs(certificate->order - scheme->order) < 0.15;
}

/* Without viscosity: the circulation and the enstrophy of a closed surface. */
static void measure_torus(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    struct gm_flow *flow = open_torus(0);
    double omega[MOST], start[GM_FLOW_BLOCKS * MOST + 1];
    if (!flow) {
        return;
    }
    const struct gm_problem problem = problem_of(flow);
    swirl(flow, omega);
    if (gm_flow_start_vorticity(flow, omega, start)) {
        struct gm_run *run = run_for(&problem, scheme, 0.01, 50, start);
        if (run && run->status == GM_OK) {
            const double *y = gm_run_state(run);
            const double before = gm_flow_enstrophy(flow, start);
            gm_certificate_note(certificate, GM_KEEPS_LINEAR, gm_flow_circulation_error(flow, y), "torus");
            gm_certificate_note(certificate, GM_KEEPS_QUADRATIC,
                                fabs(gm_flow_enstrophy(flow, y) - before) / before, "torus");
        }
        gm_run_close(run);
    }
    gm_flow_close(flow);
}

/* A room of 4 by 3 with its inlet top left and its outlet bottom right. */
static struct gm_flow *open_room(void)
{
    const double lips[] = {0, 2, 4, 1};
    const struct gm_rectangle rectangle = {.width = 4,
                                           .height = 3,
                                           .edges = 9,
                                           .strips = 16,
                                           .transposed = true,
                                           .irregular = 0.2,
                                           .fixed = lips,
                                           .fixed_count = 2};
    struct gm_triangulation_fault fault;
    struct gm_complex *complex = gm_rectangle_open(&rectangle, &fault);
    struct gm_flow *flow = complex ? gm_flow_open(complex) : NULL;
    unsigned char *sides = flow ? calloc(complex->boundary, 1) : NULL;
    for (size_t b = 0; sides && b < complex->boundary; b++) {
        const int *edge = complex->edge + 2 * complex->boundary_edge[b];
        const double x = (complex->point[2 * edge[0]] + complex->point[2 * edge[1]]) / 2;
        const double z = (complex->point[2 * edge[0] + 1] + complex->point[2 * edge[1] + 1]) / 2;
        sides[b] = x == 0 && z > 2 ? GM_EDGE_INLET : x == 4 && z < 1 ? GM_EDGE_OUTLET : GM_EDGE_WALL;
    }
    const bool good = sides && gm_flow_set_boundary(flow, sides, 1, GM_VERTEX_SOFT, 1000) == GM_BOUNDARY_OK;
    free(sides);
    if (!good) {
        gm_flow_close(flow);
        return NULL;
    }
    flow->viscosity = 0.02;
    flow->diffusivity = 0.03;
    flow->reynolds = 50;
    flow->scalar = true;
    return flow;
}

/* max |d1 d0|, whose entries are whole numbers */
static double incidence_defect(const struct gm_complex *complex)
{
    int largest = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        for (size_t corner = 3 * t; corner < 3 * t + 3; corner++) {
            int sum = 0;
            for (size_t k = 3 * t; k < 3 * t + 3; k++) {
                const int *edge = complex->edge + 2 * complex->triangle_edge[k];
                const int v = complex->triangle[corner];
                sum += complex->triangle_sign[k] * ((edge[1] == v) - (edge[0] == v));
            }
            largest = abs(sum) > largest ? abs(sum) : largest;
        }
    }
    return largest;
}

static void measure_room(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    enum { STEPS = 20 };
    struct gm_flow *flow = open_room();
    double *start = flow ? malloc(gm_flow_size(flow) * sizeof *start) : NULL;
    if (!start) {
        gm_flow_close(flow);
        return;
    }
    const struct gm_problem problem = problem_of(flow);
    const size_t n = flow->complex->vertices;
    for (int constant = 0; constant < 2; constant++) {
        for (size_t v = 0; constant && v < n; v++) {
            flow->theta[v] = 1;
        }
        struct gm_run *run =
            gm_flow_start_irrotational(flow, start) ? run_for(&problem, scheme, 0.1, 1, start) : NULL;
        for (int i = 0; run && i < STEPS && run->status == GM_OK; i++, gm_run_advance(run, 1)) {
            const double *y = gm_run_state(run), *theta = gm_flow_block(flow, y, GM_FLOW_THETA);
            gm_certificate_note(certificate, GM_DIVERGENCE_FREE,
                                incidence_defect(flow->complex) + gm_flow_divergence(flow, y), "room");
            if (!constant) {
                gm_certificate_note(certificate, GM_CLOSES_BUDGET, gm_flow_budget(flow, y).defect, "room");
            }
            for (size_t v = 0; constant && v < n; v++) {
                gm_certificate_note(certificate, GM_KEEPS_CONSTANTS, fabs(theta[v] - 1), "room");
            }
        }
        gm_run_close(run);
    }
    free(start);
    gm_flow_close(flow);
}

/* Measures a scheme for flows on complexes: fills the certificate's order and claims. */
static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    if (scheme->order > 0) {
        measure_order(scheme, certificate);
        measure_torus(scheme, certificate);
    } else {
        certificate->order = 0; /* there is no time in it */
        certificate->order_problem = "steady";
        certificate->order_holds = true;
    }
    measure_room(scheme, certificate);
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/flow/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_flow = {
    .name = "flow",
    .problems = "flows on a mesh",
    .certify = certify,
    .families = families,
    .quantities = gm_flow_quantities,
};
