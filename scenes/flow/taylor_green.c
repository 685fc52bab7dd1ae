/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Taylor-Green vortices: a steady pattern of the ideal fluid that viscosity lets fade, on a torus or in a box
   whose walls are without friction,
       psi = sin(k x) sin(k y) / k exp(-2 k^2 nu t),   k = 2 pi on the torus, pi in the box
   What to look at: the error of psi; and, without viscosity and with other waves mixed in (speed > 0), the
   enstrophy, which crank-nicolson keeps to round-off and semi-implicit wears down. No figure of the
   documents. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scenes/flow/flows.h"

static const char *const domains[] = {"torus", "box", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.01", 1e-7, 10),
    GM_UNTIL("1"),
    GM_REAL_ROW(struct gm_flows, viscosity, "viscosity", "0.005", 0, 10,
                "kinematic viscosity ν; 0: an ideal fluid"),
    GM_CHOICE_ROW(struct gm_flows, domain, "domain", "torus", domains,
                  "opposite sides are one, or walls without friction"),
    GM_REAL_ROW(struct gm_flows, speed, "speed", "0", 0, 10, "strength of other waves that are mixed in"),
    GM_INTEGER_ROW(struct gm_flows, columns, "columns", "32", 4, 1000, "edges along x", .logarithmic = true,
                   .required = true),
    GM_INTEGER_ROW(struct gm_flows, rows, "rows", "0", 0, 2000, "strips of triangles along y; 0: the best",
                   .logarithmic = true, .required = true),
    GM_FLOWS_IRREGULAR,
    GM_FLOWS_TRACERS("0"),
    GM_FLOWS_LOOKS("vorticity", "yes"),
};

static bool setup(const void *parameters_of, struct gm_problem *problem, char *sentence)
{
    const struct gm_flows *flows = parameters_of;
    struct gm_rectangle rectangle = {.width = 1,
                                     .height = 1,
                                     .edges = flows->columns,
                                     .strips = flows->rows,
                                     .torus = flows->domain == GM_DOMAIN_TORUS,
                                     .irregular = flows->irregular};
    struct gm_flow *flow = gm_flows_rectangle(&rectangle, sentence);
    if (!flow) {
        return false;
    }
    const struct gm_complex *complex = flow->complex;
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        flow->kind[v] = GM_VERTEX_SLIP;
        flow->theta_fixed[v] = true;
    }
    flow->viscosity = flows->viscosity;
    flow->tracers = (size_t)flows->tracers;
    return gm_flows_problem(problem, flow, "taylor-green", sentence);
}

static double wave_number(const struct gm_flows *flows)
{
    return flows->domain == GM_DOMAIN_TORUS ? 2 * M_PI : M_PI;
}

static void start(const void *parameters_of, const struct gm_problem *problem, double *y)
{
    const struct gm_flows *flows = parameters_of;
    const struct gm_complex *complex = gm_flow_of(problem)->complex;
    const double k = wave_number(flows);
    double *omega = malloc(complex->vertices * sizeof *omega);
    bool good = omega != NULL;
    for (size_t v = 0; good && v < complex->vertices; v++) {
        const double x = k * complex->point[2 * v], z = k * complex->point[2 * v + 1];
        omega[v] = 2 * k * sin(x) * sin(z);
        if (flows->domain == GM_DOMAIN_TORUS) {
            omega[v] += flows->speed * k * (sin(x - 2 * z + 1.1) + 0.8 * sin(2 * x + z + 0.2));
        } else {
            omega[v] += flows->speed * k * (sin(x) * sin(2 * z) + 0.8 * sin(2 * x) * sin(3 * z));
        }
    }
    good = good && gm_flow_start_vorticity(gm_flow_of(problem), omega, y);
    free(omega);
    for (size_t i = 0; !good && i < problem->n; i++) {
        y[i] = 0;
    }
}

/* The exact psi where no other waves are mixed in. */
static double exact(const struct gm_view *view, size_t v)
{
    const struct gm_flows *flows = view->parameters;
    const double k = wave_number(flows), *p = gm_flow_of(view->problem)->complex->point + 2 * v;
    return sin(k * p[0]) * sin(k * p[1]) / k * exp(-2 * k * k * flows->viscosity * (view->t - view->t0));
}

static double solution_error(const struct gm_view *view)
{
    double largest = ((const struct gm_flows *)view->parameters)->speed == 0 ? 0 : NAN;
    for (size_t v = 0; v < gm_flow_of(view->problem)->complex->vertices; v++) {
        largest = fmax(largest, fabs(view->state[v] - exact(view, v)));
    }
    return ((const struct gm_flows *)view->parameters)->speed == 0 ? largest : NAN;
}

static double psi_error(const struct gm_view *view)
{
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double error = 0, size = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double truth = exact(view, v), away = view->state[v] - truth;
        error += complex->star0[v] * away * away;
        size += complex->star0[v] * truth * truth;
    }
    return ((const struct gm_flows *)view->parameters)->speed == 0 ? sqrt(error / size) : NAN;
}

static const char mixed[] = "no exact solution is known of several waves";

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("solution_error", solution_error, "error of ψ", .missing = mixed),
    GM_LOG_OBSERVABLE("psi_error", psi_error, "relative error of ψ", .missing = mixed),
    GM_FLOWS_ENERGY,
    GM_FLOWS_ENSTROPHY,
    GM_LOG_OBSERVABLE("enstrophy_error", gm_flows_enstrophy, "enstrophy error", .error = true, .symbol = "Z"),
    GM_LOG_OBSERVABLE("circulation_error", gm_flows_circulation_error, "circulation error"),
    GM_OBSERVABLE("mean_edge", gm_flows_mean_edge, "mean edge"),
    GM_FLOWS_DIVERGENCE,
    GM_FLOWS_TRIANGLES,
};

static void profile(const struct gm_view *view, const char *front, FILE *stream)
{
    const struct gm_profile line = {"vertical", {0.5, 0}, {0.5, 1}, 101, NULL};
    gm_flows_write_profile(view, front, &line, stream);
}

static const struct gm_look_error errors[] = {{"psi_error", "ψ"}, {NULL, NULL}};

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_flows *flows = lanes[0]->parameters;
    const struct gm_look look = {
        .title = flows->speed == 0      ? "Taylor–Green vortices"
                 : flows->viscosity > 0 ? "Taylor–Green vortices among other waves"
                                        : "Taylor–Green vortices among other waves, in an ideal fluid",
        .told = {{"viscosity", offsetof(struct gm_flows, viscosity), NULL}},
        .remark = flows->domain == GM_DOMAIN_TORUS ? ",  torus" : ",  walls without friction",
        .clock_unit = "",
        .vorticity_range = 2 * wave_number(flows) * (1 + flows->speed),
        .speed_high = 1,
        .graphs = {"kinetic_energy", "enstrophy"},
        .graph_high = {1e-3, 1e-3}, /* from zero, so that what is lost is seen for what it is */
        .errors = errors,
    };
    gm_flows_draw(lanes, count, picture, &look);
}

static const char *const schemes[] = {"crank-nicolson", "semi-implicit", NULL};

static const double edges[] = {8, 16, 32, 64, 128}, accuracies[] = {1e-1, 1e-2, 1e-3};

static const struct gm_work work = {
    .arguments = "viscosity=0.02",
    .measure = "psi_error",
    .coarsest = 0.25,
    .halvings = 6,
    .resolution = "columns",
    .resolutions = edges,
    .resolution_count = GM_COUNT(edges),
    .errors = accuracies,
    .schemes = schemes,
};

const struct gm_scene gm_scene_taylor_green = {
    .name = "taylor-green",
    .title = "Taylor–Green vortices",
    .blurb =
        "A checkerboard of vortices fades by viscosity alone; its exact solution is known. Without viscosity "
        "circulation stays, and with crank-nicolson enstrophy does too.",
    .watch = "Watch the enstrophy with viscosity=0 speed=1: one scheme keeps it, the other wears it down.",
    .time = "L/U, of the unit length over the greatest speed at the start of the single pattern",
    .size = sizeof(struct gm_flows),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .lanes = "scheme=crank-nicolson,semi-implicit viscosity=0 speed=1 until=5",
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .work = &work,
    .settle = gm_flows_settle_columns,
    .no_stability = GM_FLOWS_NO_STABILITY,
    .setup = setup,
    .close = gm_flows_close,
    .start = start,
    .draw = draw,
    .profile = profile,
};
