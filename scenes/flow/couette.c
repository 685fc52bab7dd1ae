/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Couette flow between a wall at rest and one that moves, in a square: psi = y^2/2, u = y, theta = y. Lengths
   in H, velocities in the wall's U, time in H^2 / nu; kappa = nu. What to look at: the errors over meshes,
   from which the convergence of discrete exterior calculus is read off, and the divergence, which is zero on
   every mesh. Razafindralandy, Hamdouni & Chhay (2018), figures 32 (the orders) and 34 (the divergence). */
#include "scenes/flow/shear.h"

#include <math.h>

static double velocity(double y)
{
    return y;
}

static double psi(double y)
{
    return y * y / 2;
}

static double pressure(double x, double y, double viscosity)
{
    return (void)x, (void)viscosity, velocity(y) * velocity(y) / 2;
}

static const struct gm_shear shear = {.velocity = velocity, .psi = psi, .pressure = pressure};

static const struct gm_parameter parameters[] = {GM_SHEAR_PARAMETERS};

static bool setup(const void *own, struct gm_problem *problem, char *sentence)
{
    return gm_shear_setup(own, &shear, "couette", problem, sentence);
}

GM_SHEAR_MEASURES

static const struct gm_observable observables[] = {GM_SHEAR_OBSERVABLES};

static const struct gm_profile middle = {"middle", {0.5, 0}, {0.5, 1}, 101, NULL};

static double reference(const struct gm_view *view, double s)
{
    return (void)view, velocity(s);
}

static void profile(const struct gm_view *view, const char *front, FILE *stream)
{
    struct gm_profile line = middle;
    line.reference = reference;
    gm_flows_write_profile(view, front, &line, stream);
}

static double height(double y)
{
    return y;
}

static void profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                     enum gm_place place)
{
    gm_shear_draw_profiles(lanes, count, picture, place, &middle, velocity, height);
}

static const char *subtitle(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    return gm_picture_text(
        picture, "%s%s",
        gm_flows_common(picture, lanes, count, "Reynolds number", offsetof(struct gm_flows, reynolds)),
        gm_flows_mesh_and_scheme(picture, lanes, count));
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_look look = {
        .title = "Couette flow",
        .subtitle = subtitle,
        .clock_unit = "H²/ν",
        .scalar_high = 1,
        .vorticity_range = 2,
        .speed_high = 1,
        .graphs = {"psi_error", "divergence"},
        .graph_low = {0, 1e-17},
        .graph_high = {0, 1e-15},
        .profiles = profiles,
        .errors = gm_shear_errors,
    };
    gm_flows_draw(lanes, count, picture, &look);
}

static const char *const schemes[] = {"semi-implicit", NULL};

static const struct gm_figure figures[] = {
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

const struct gm_scene gm_scene_couette = {
    .name = "couette",
    .title = "Couette flow",
    .blurb =
        "The flow between a wall at rest and one that moves, in a square. Its stream function converges with the square of the edge length, its velocity with the length itself.",
    .watch = "Watch the divergence: it is zero to the last digit on every mesh, however coarse.",
    .time = "H²/ν, the height squared over the viscosity",
    .size = sizeof(struct gm_flows),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .work = &gm_shear_work,
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .setup = setup,
    .close = gm_flows_close,
    .start = gm_flows_start,
    .draw = draw,
    .profile = profile,
};
