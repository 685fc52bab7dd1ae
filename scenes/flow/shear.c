/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flow between two walls in a unit square, u = U(y) and theta = y: that of Couette, between a wall at rest
   and one that moves, and that of Poiseuille, which a pressure drives,
       couette   u = y,   psi = y^2/2        poiseuille   u = 4 y (1 - y),   psi = 2 y^2 - 4 y^3/3
   Lengths in H, velocities in the U of the moving wall or of the centreline, time in H^2 / nu; kappa = nu.
   What to look at: the errors over meshes, from which the convergence of discrete exterior calculus is read
   off, and the divergence, which is zero on every mesh.

   Razafindralandy, Hamdouni & Chhay (2018):
       figures 32, 33   the orders of both        figure 34   the divergence */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/flow/flows.h"

struct shear {
    const char *name, *title;
    double (*velocity)(double y);
    double (*psi)(double y);
    double slope; /* of the pressure along x, over the viscosity */
    double vorticity_range;
};

static double height(double y)
{
    return y;
}
static double couette_psi(double y)
{
    return y * y / 2;
}
static double poiseuille_velocity(double y)
{
    return 4 * y * (1 - y);
}
static double poiseuille_psi(double y)
{
    return 2 * y * y - 4.0 / 3 * y * y * y;
}

static const struct shear couette = {.name = "couette",
                                     .title = "Couette flow",
                                     .velocity = height,
                                     .psi = couette_psi,
                                     .vorticity_range = 2},
                          poiseuille = {.name = "poiseuille",
                                        .title = "Poiseuille flow",
                                        .velocity = poiseuille_velocity,
                                        .psi = poiseuille_psi,
                                        .slope = -8,
                                        .vorticity_range = 4};

static const struct shear *shear_of(const struct gm_problem *problem)
{
    return strcmp(problem->name, couette.name) == 0 ? &couette : &poiseuille;
}

static double total_pressure(const struct shear *shear, const double *point, double viscosity)
{
    const double u = shear->velocity(point[1]);
    return shear->slope * viscosity * point[0] + u * u / 2;
}

static const struct gm_parameter parameters[] = {
    GM_DT("0.05", 1e-7, 10),
    GM_UNTIL("5"),
    GM_REAL_ROW(struct gm_flows, reynolds, "reynolds", "1", 0.01, 1e5, "Reynolds number U H / ν",
                .logarithmic = true),
    GM_INTEGER_ROW(struct gm_flows, rows, "rows", "24", 3, 1000, "edges at the bottom and at the top",
                   .logarithmic = true, .required = true),
    GM_INTEGER_ROW(struct gm_flows, columns, "columns", "0", 0, 2000,
                   "strips of triangles along y; 0: the best", .logarithmic = true, .required = true),
    GM_FLOWS_IRREGULAR,
    GM_FLOWS_TRACERS("0"),
    GM_FLOWS_LOOKS("speed", "yes"),
};

/* A mesh of the square with psi and theta given all round. */
static bool make(const struct gm_flows *flows, const struct shear *shear, struct gm_problem *problem,
                 char *sentence)
{
    struct gm_rectangle rectangle = {.width = 1,
                                     .height = 1,
                                     .edges = flows->rows,
                                     .strips = flows->columns,
                                     .irregular = flows->irregular};
    struct gm_flow *flow = gm_flows_rectangle(&rectangle, sentence);
    if (!flow) {
        return false;
    }
    const struct gm_complex *complex = flow->complex;
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        const double z = complex->point[2 * v + 1];
        double middle[2];
        gm_flows_middle(complex, b, middle);
        flow->kind[v] = GM_VERTEX_FIXED;
        flow->psi[v] = shear->psi(z);
        flow->theta_fixed[v] = true;
        flow->theta[v] = z;
        /* a wall that moves to the right drags counter-clockwise at the bottom, clockwise on top */
        const double drag = middle[1] == 0 ? shear->velocity(0) : middle[1] == 1 ? -shear->velocity(1) : 0;
        for (int k = 0; k < 2; k++) {
            flow->sheet[complex->edge[2 * complex->boundary_edge[b] + k]] +=
                drag * complex->length[complex->boundary_edge[b]] / 2;
        }
    }
    flow->viscosity = flow->diffusivity = 1 / flows->reynolds;
    flow->reynolds = flows->reynolds;
    flow->time_unit = flows->reynolds;
    flow->speed = 1;
    flow->scalar = true;
    flow->tracers = (size_t)flows->tracers;
    return gm_flows_problem(problem, flow, shear->name, sentence);
}

static bool setup_couette(const void *self, struct gm_problem *problem, char *sentence)
{
    return make(self, &couette, problem, sentence);
}

static bool setup_poiseuille(const void *self, struct gm_problem *problem, char *sentence)
{
    return make(self, &poiseuille, problem, sentence);
}

static double solution_error(const struct gm_view *view)
{
    return gm_flows_psi_error(view, shear_of(view->problem)->psi);
}

/* |values - exact| / |exact| in the norm sum star0 w^2 */
static double vertex_error(const struct gm_view *view, enum gm_flow_block block, double (*exact)(double))
{
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    const double *values = gm_flow_block(gm_flow_of(view->problem), view->state, block);
    double error = 0, size = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double z = complex->point[2 * v + 1], truth = exact(z), away = values[v] - truth;
        error += complex->star0[v] * away * away;
        size += complex->star0[v] * truth * truth;
    }
    return sqrt(error / size);
}

static double psi_error(const struct gm_view *view)
{
    return vertex_error(view, GM_FLOW_PSI, shear_of(view->problem)->psi);
}

static double theta_error(const struct gm_view *view)
{
    return vertex_error(view, GM_FLOW_THETA, height);
}

/* An end of a dual edge: a circumcentre, or on the boundary the edge's middle. */
static void dual_end(const struct gm_complex *complex, size_t e, int side, double p[2])
{
    const int t = complex->edge_triangle[2 * e + (size_t)side];
    if (t >= 0) {
        gm_complex_centre(complex, (size_t)t, p);
        return;
    }
    for (int c = 0; c < 2; c++) {
        p[c] = (complex->point[2 * complex->edge[2 * e] + c] +
                complex->point[2 * complex->edge[2 * e + 1] + c]) /
               2;
    }
}

static double flux_error(const struct gm_view *view)
{
    const struct shear *shear = shear_of(view->problem);
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double error = 0, size = 0;
    for (size_t e = 0; e < complex->edges; e++) {
        double from[2], to[2];
        dual_end(complex, e, 1, from);
        dual_end(complex, e, 0, to);
        /* Simpson's rule is exact for a parabola */
        const double exact =
            (to[0] - from[0]) *
            (shear->velocity(from[1]) + 4 * shear->velocity((from[1] + to[1]) / 2) + shear->velocity(to[1])) /
            6;
        const double circulation =
            -complex->star1[e] * (view->state[complex->edge[2 * e + 1]] - view->state[complex->edge[2 * e]]);
        error += complex->length[e] * (circulation - exact) * (circulation - exact);
        size += complex->length[e] * exact * exact;
    }
    return sqrt(error / size);
}

static double velocity_error(const struct gm_view *view)
{
    const struct shear *shear = shear_of(view->problem);
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double error = 0, size = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double u[2], p[6];
        gm_flow_velocity(complex, view->state, t, u);
        gm_complex_corners(complex, t, p);
        const double exact = shear->velocity((p[1] + p[3] + p[5]) / 3);
        error += complex->area[t] * ((u[0] - exact) * (u[0] - exact) + u[1] * u[1]);
        size += complex->area[t] * exact * exact;
    }
    return sqrt(error / size);
}

/* The error of the total pressure over the triangles whose circumcentre is further than `margin` from the
   boundary of the unit square; both pressures with mean 0 there. */
static double pressure_error_within(const struct gm_view *view, double margin)
{
    const struct shear *shear = shear_of(view->problem);
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double *pressure = malloc(3 * complex->triangles * sizeof *pressure);
    if (!pressure || !gm_flow_pressure(gm_flow_of(view->problem), view->state, pressure)) {
        free(pressure);
        return NAN;
    }
    double *exact = pressure + complex->triangles, *area = exact + complex->triangles;
    double mean = 0, exact_mean = 0, total = 0, error = 0, size = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double centre[2];
        gm_complex_centre(complex, t, centre);
        const double to_wall = fmin(fmin(centre[0], 1 - centre[0]), fmin(centre[1], 1 - centre[1]));
        exact[t] = total_pressure(shear, centre, gm_flow_of(view->problem)->viscosity);
        area[t] = to_wall >= margin ? complex->area[t] : 0;
        mean += area[t] * pressure[t];
        exact_mean += area[t] * exact[t];
        total += area[t];
    }
    for (size_t t = 0; t < complex->triangles; t++) {
        const double truth = exact[t] - exact_mean / total, away = pressure[t] - mean / total - truth;
        error += area[t] * away * away;
        size += area[t] * truth * truth;
    }
    free(pressure);
    return sqrt(error / size);
}

static double pressure_error(const struct gm_view *view)
{
    return pressure_error_within(view, -INFINITY);
}

/* Away from the walls: there the layer of wrong vorticity along them, one cell wide, is not met. */
static double pressure_error_middle(const struct gm_view *view)
{
    return pressure_error_within(view, 0.2);
}

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("solution_error", solution_error, "error of ψ"),
    GM_LOG_OBSERVABLE("psi_error", psi_error, "relative error of ψ"),
    GM_LOG_OBSERVABLE("theta_error", theta_error, "relative error of θ"),
    GM_LOG_OBSERVABLE("flux_error", flux_error, "relative error of the flux"),
    GM_LOG_OBSERVABLE("velocity_error", velocity_error, "relative error of the velocity"),
    GM_LOG_OBSERVABLE("pressure_error", pressure_error, "relative error of the total pressure"),
    GM_LOG_OBSERVABLE("pressure_error_middle", pressure_error_middle,
                      "relative error of the total pressure away from the walls"),
    GM_OBSERVABLE("mean_edge", gm_flows_mean_edge, "mean edge"),
    GM_FLOWS_DIVERGENCE,
    GM_FLOWS_ENERGY,
    GM_FLOWS_CHANGE,
    GM_FLOWS_TRIANGLES,
};

static const struct gm_profile middle = {"middle", {0.5, 0}, {0.5, 1}, 101, NULL};

static double reference(const struct gm_view *view, double s)
{
    return shear_of(view->problem)->velocity(s);
}

static void profile(const struct gm_view *view, const char *front, FILE *stream)
{
    struct gm_profile line = middle;
    line.reference = reference;
    gm_flows_write_profile(view, front, &line, stream);
}

static void profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                     enum gm_place place)
{
    const struct shear *shear = shear_of(&lanes[0]->problem);
    gm_flows_draw_profiles(lanes, count, picture, place, &middle, shear->velocity, height);
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    static const struct gm_look_error errors[] = {{"psi_error", "ψ"},
                                                  {"theta_error", "θ"},
                                                  {"flux_error", "flux"},
                                                  {"velocity_error", "velocity"},
                                                  {"pressure_error", "total pressure"},
                                                  {NULL, NULL}};
    const struct shear *shear = shear_of(&lanes[0]->problem);
    const struct gm_look look = {
        .title = shear->title,
        .told = {{"Reynolds number", offsetof(struct gm_flows, reynolds), NULL}},
        .clock_unit = "H²/ν",
        .scalar_high = 1,
        .vorticity_range = shear->vorticity_range,
        .speed_high = 1,
        .graphs = {"psi_error", "divergence"},
        .graph_low = {0, 1e-17},
        .graph_high = {0, 1e-15},
        .profiles = profiles,
        .errors = errors,
    };
    gm_flows_draw(lanes, count, picture, &look);
}

static const char *const schemes[] = {"semi-implicit", NULL};

static const double edges[] = {6, 12, 24, 48, 96}, accuracies[] = {1e-2, 1e-3, 1e-4};

static const struct gm_work work = {
    .arguments = "until=1",
    .measure = "psi_error",
    .coarsest = 0.2,
    .halvings = 4,
    .resolution = "rows",
    .resolutions = edges,
    .resolution_count = GM_COUNT(edges),
    .errors = accuracies,
};

static const struct gm_figure couette_figures[] = {
    {
        .name = "razafindralandy-32",
        .statement =
            "orders 1.84 of the stream function, 2 of the temperature, 1 of flux and velocity, 1.65 of the pressure",
        .arguments = "scheme=steady rows=6,12,24,48,96 irregular=0.25 dt=1 until=6 show=convergence",
    },
    {
        .name = "razafindralandy-34-couette",
        .statement = "the divergence stays below 2e-16 at all times",
        .arguments = "rows=24 irregular=0.25 until=2 show=divergence",
    },
};

static const struct gm_figure poiseuille_figures[] = {
    {
        .name = "razafindralandy-33",
        .statement = "orders 1.37 of the stream function, 1.95 of the temperature, 1 of flux and velocity",
        .arguments = "scheme=steady rows=6,12,24,48,96 irregular=0.25 dt=1 until=6 show=convergence",
    },
    {
        .name = "razafindralandy-34-poiseuille",
        .statement = "the divergence stays below 2e-16 at all times",
        .arguments = "rows=24 irregular=0.25 until=2 show=divergence",
    },
};

#define FIELDS_OF_BOTH                                                                                       \
    .watch = "Watch the divergence: it is zero to the last digit on every mesh, however coarse.",            \
    .time = "H²/ν, the height squared over the viscosity", .size = sizeof(struct gm_flows),                  \
    .parameters = parameters, .parameter_count = GM_COUNT(parameters), .schemes = schemes,                   \
    .observables = observables, .observable_count = GM_COUNT(observables), .work = &work,                    \
    .no_stability = GM_FLOWS_NO_STABILITY, .close = gm_flows_close, .start = gm_flows_start, .draw = draw,   \
    .profile = profile

const struct gm_scene gm_scene_couette = {
    .name = "couette",
    .title = "Couette flow",
    .blurb =
        "The flow between a wall at rest and one that moves, in a square. Its stream function converges with the square of the edge length, its velocity with the length itself.",
    .figures = couette_figures,
    .figure_count = GM_COUNT(couette_figures),
    .settle = gm_flows_settle_rows,
    .setup = setup_couette,
    FIELDS_OF_BOTH,
};

const struct gm_scene gm_scene_poiseuille = {
    .name = "poiseuille",
    .title = "Poiseuille flow",
    .blurb =
        "The flow that a pressure drives between two walls, in a square. Its stream function converges with the square of the edge length, its velocity with the length itself.",
    .figures = poiseuille_figures,
    .figure_count = GM_COUNT(poiseuille_figures),
    .settle = gm_flows_settle_rows,
    .setup = setup_poiseuille,
    FIELDS_OF_BOTH,
};
