/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A channel with a hot upper wall, whose parabolic flow carries heat until velocity and temperature have the
   profiles that are known exactly: u = 4 y (1 - y), theta proportional to y. Length 2 pi H; lengths in H,
   velocities in the centreline's, time in H^2 / nu. What to look at: the mean errors of both profiles at
   three quarters of the length, and the budget of heat, which closes to the last digit. Razafindralandy,
   Hamdouni & Chhay (2018), figures 30 (the profiles) and 31 (the temperature). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/flow/flows.h"

static const double hot = 20, length = 2 * M_PI;

static const struct gm_parameter parameters[] = {
    GM_DT("0.01", 1e-7, 10),
    GM_UNTIL("5"),
    GM_REAL_ROW(struct gm_flows, viscosity, "viscosity", "1", 1e-5, 1e3, "kinematic viscosity ν",
                .logarithmic = true),
    GM_REAL_ROW(struct gm_flows, schmidt, "schmidt", "1", 1e-3, 1e4, "Prandtl number ν / κ",
                .logarithmic = true),
    GM_INTEGER_ROW(struct gm_flows, rows, "rows", "14", 3, 1000, "edges on each of the walls x = 0 and x = L",
                   .logarithmic = true, .required = true),
    GM_INTEGER_ROW(struct gm_flows, columns, "columns", "98", 0, 6000,
                   "strips of triangles along x; 0: the best", .logarithmic = true, .required = true),
    GM_FLOWS_IRREGULAR,
    GM_TEXT_ROW(struct gm_flows, outlet, "outlet", "free", "soft, dirichlet or free",
                .choices = gm_flows_outlets),
    GM_FLOWS_TRACERS("150"),
    GM_FLOWS_LOOKS("scalar", "yes"),
};

/* Rows and columns agree. */
static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    gm_flows_follow(self, (struct gm_rectangle){.width = length, .height = 1, .transposed = true}, keys,
                    count);
    return true;
}

static double velocity(double y)
{
    return 4 * y * (1 - y);
}

static double theta(double y)
{
    return hot * y;
}

static double psi(double y)
{
    return 2 * y * y - 4.0 / 3 * y * y * y;
}

static unsigned char side_at(const double middle[2])
{
    return middle[0] == 0 ? GM_EDGE_INLET : middle[0] == length ? GM_EDGE_OUTLET : GM_EDGE_WALL;
}

static bool setup(const void *parameters_of, struct gm_problem *problem, char *sentence)
{
    const struct gm_flows *flows = parameters_of;
    enum gm_vertex_kind outlet = GM_VERTEX_OPEN;
    char group[GM_TEXT_SIZE];
    if (!gm_flows_outlet(flows->outlet, GM_VERTEX_OPEN, &outlet, group, sentence)) {
        return false;
    }
    if (strcmp(group, "outlet") != 0) {
        return gm_refuse(sentence, "outlet=%.60s is none of: soft, dirichlet, free", flows->outlet);
    }
    struct gm_rectangle rectangle = {.width = length,
                                     .height = 1,
                                     .edges = flows->rows,
                                     .strips = flows->columns,
                                     .transposed = true,
                                     .irregular = flows->irregular};
    struct gm_flow *flow = gm_flows_rectangle(&rectangle, sentence);
    unsigned char *sides = flow ? gm_flows_sides(flow, side_at, sentence) : NULL;
    const bool good = sides && gm_flows_boundary(gm_flow_set_boundary(flow, sides, 1, outlet, 0), sentence);
    free(sides);
    if (!good) {
        gm_flow_close(flow);
        return false;
    }
    const struct gm_complex *complex = flow->complex;
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        flow->theta[v] = flow->theta_fixed[v] && complex->point[2 * v + 1] == 1 ? hot : 0;
    }
    flow->viscosity = flows->viscosity;
    flow->diffusivity = flows->viscosity / flows->schmidt;
    flow->reynolds = 1 / flows->viscosity;
    flow->time_unit = 1 / flows->viscosity;
    flow->scalar = true;
    flow->tracers = (size_t)flows->tracers;
    return gm_flows_problem(problem, flow, "channel", sentence);
}

static const struct gm_profile line = {"three-quarters", {1.5 * M_PI, 0}, {1.5 * M_PI, 1}, 101, NULL};

/* The mean of |u - exact|, or of |theta - exact|, at fifty places across the channel at 3 L / 4, from .02 H
   to .98 H: on the walls velocity and temperature are given, and a polynomial fitted to one side says nothing
   of the flow. */
static double profile_error(const struct gm_view *view, bool scalar)
{
    enum { PLACES = 50 };
    const double margin = 0.02;
    double sum = 0;
    for (size_t i = 0; i < PLACES; i++) {
        const double z = margin + (1 - 2 * margin) * (double)i / (PLACES - 1);
        struct gm_sample sample = {0};
        gm_flow_sample(gm_flow_of(view->problem), view->state, line.a[0], z, &sample);
        sum += fabs(scalar ? sample.theta - theta(z) : sample.u - velocity(z));
    }
    return sum / PLACES;
}

static double u_error(const struct gm_view *view)
{
    return profile_error(view, false);
}

static double theta_error(const struct gm_view *view)
{
    return profile_error(view, true);
}

static double solution_error(const struct gm_view *view)
{
    return gm_flows_psi_error(view, psi);
}

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("u_error", u_error, "mean error of u at 3 L/4"),
    GM_LOG_OBSERVABLE("theta_error", theta_error, "mean error of θ at 3 L/4"),
    GM_LOG_OBSERVABLE("solution_error", solution_error, "error of ψ"),
    GM_OBSERVABLE("scalar_total", gm_flows_scalar_total, "heat in the channel"),
    GM_OBSERVABLE("scalar_outflow", gm_flows_scalar_outflow, "outflow of heat"),
    GM_LOG_OBSERVABLE("budget_defect", gm_flows_budget_defect, "defect of the heat's budget"),
    GM_FLOWS_DIVERGENCE,
    GM_FLOWS_ENERGY,
    GM_FLOWS_SPEED,
    GM_FLOWS_CHANGE,
    GM_FLOWS_TRIANGLES,
};

static double reference(const struct gm_view *view, double s)
{
    return (void)view, velocity(s);
}

static void profile(const struct gm_view *view, const char *front, FILE *stream)
{
    struct gm_profile whole = line;
    whole.reference = reference;
    gm_flows_write_profile(view, front, &whole, stream);
}

static void profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                     enum gm_place place)
{
    gm_flows_draw_profiles(lanes, count, picture, place, &line, velocity, theta);
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_look look = {
        .title = "A channel with a hot wall",
        .told = {{"viscosity", offsetof(struct gm_flows, viscosity), NULL}},
        .remark = ",  profiles at x = 3 L/4",
        .clock_unit = "H²/ν",
        .scalar_high = hot,
        .vorticity_range = 4,
        .speed_high = 1,
        .names = {[GM_SHOW_SCALAR] = "temperature θ"},
        .profiles = profiles,
        .profiles_below = true,
    };
    gm_flows_draw(lanes, count, picture, &look);
}

static const char *const schemes[] = {"semi-implicit", NULL};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-30",
        .statement = "at 3 L/4 the velocity differs by 2.4e-4 on average from the parabola, θ is linear",
        .arguments = "until=5 tracers=0 show=profiles",
    },
    {
        .name = "razafindralandy-31",
        .statement = "θ becomes linear across the channel downstream",
        .arguments = "until=5 tracers=0 show=scalar",
    },
};

const struct gm_scene gm_scene_channel = {
    .name = "channel",
    .title = "A channel with a hot wall",
    .blurb =
        "A parabolic flow through a channel whose upper wall is hot: velocity and temperature find the profiles "
        "that are known exactly.",
    .watch = "Watch the budget of heat: it closes to the last digit.",
    .time = "H²/ν, the height squared over the viscosity",
    .size = sizeof(struct gm_flows),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .settle = settle,
    .no_stability = GM_FLOWS_NO_STABILITY,
    .setup = setup,
    .close = gm_flows_close,
    .start = gm_flows_start,
    .draw = draw,
    .profile = profile,
};
