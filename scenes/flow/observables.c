/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables of flows and their units: measures of their states, and errors against the exact solution that a room's file
   gives (NAN without one). */
#include "scenes/flow/room_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/common/system/pieces.h"

const char *gm_room_unit(const struct gm_user_room *user_room, struct gm_powers powers, char *name)
{
    static const char *const raised[] = {"", "", "²", "³", "⁴"};
    static const int order[3] = {2, 0, 1};
    char above[GM_ROOM_UNIT / 2] = "", below[GM_ROOM_UNIT / 2] = "";
    for (int i = 0; i < 3; i++) {
        const char *units = user_room->room.system.texts[GM_WORD_UNITS], *at = units ? units : "";
        const int power = powers.of[order[i]];
        for (int place = order[i]; place > 0 && *at; place--) {
            at += strcspn(at, ", ");
            at += strspn(at, ", ");
        }
        const int length = (int)strcspn(at, ", ");
        if (power != 0 && (length == 0 || length > 12)) {
            name[0] = '\0';
            return name;
        }
        char *part = power > 0 ? above : below;
        const size_t used = strlen(part);
        if (power != 0) {
            snprintf(part + used, sizeof above - used, "%s%.*s%s", used > 0 ? " " : "", length, at,
                     raised[abs(power)]);
        }
    }
    snprintf(name, GM_ROOM_UNIT, "%s%s%s", above[0] || !below[0] ? above : "1", below[0] ? "/" : "", below);
    return name;
}

const char *gm_room_beside_unit(const struct gm_user_room *user_room, struct gm_powers powers, char *text)
{
    char unit[GM_ROOM_UNIT];
    gm_room_unit(user_room, powers, unit);
    const bool alone = !strpbrk(unit, "/ ");
    snprintf(text, GM_ROOM_UNIT + 8, "%s%s%s%s", unit[0] ? " / " : "", alone ? "" : "(", unit,
             alone ? "" : ")");
    return text;
}

void gm_room_observe(struct gm_user_room *user_room, struct gm_observable row, struct gm_room_subject subject)
{
    const struct gm_system_measure *measure =
        gm_system_add_observable(&user_room->of_file, row, GM_ROOM_OBSERVED);
    user_room->subjects[measure - user_room->of_file.measures] = subject;
}

static const struct gm_flow *flow_of(const struct gm_view *view)
{
    return gm_flow_of(view->problem);
}

static double measured(const struct gm_view *view)
{
    return gm_room_subject_of(view)->row->measure(flow_of(view), view->state);
}

static double scalar_outflow(const struct gm_view *view)
{
    return gm_flow_budget(flow_of(view), view->state).outflow;
}

static double budget_defect(const struct gm_view *view)
{
    return view->t == view->t0 ? 0 : gm_flow_budget(flow_of(view), view->state).defect;
}

static double psi_low(const struct gm_view *view)
{
    double low = INFINITY;
    for (size_t v = 0; v < flow_of(view)->complex->vertices; v++) {
        low = fmin(low, view->state[v]);
    }
    return low;
}

static double change(const struct gm_view *view)
{
    const double *before = gm_flow_block(flow_of(view), view->state, GM_FLOW_PSI_BEFORE);
    double change = 0, size = 0;
    for (size_t v = 0; v < flow_of(view)->complex->vertices; v++) {
        change = fmax(change, fabs(view->state[v] - before[v]));
        size = fmax(size, fabs(view->state[v]));
    }
    return size > 0 ? change / size : 0;
}

/* Returns a measure of the mesh of a flow, by the observable's key. */
static double of_mesh(const struct gm_view *view)
{
    static const char *const keys[] = {"triangles", "obtuse_share", "star_least", "mean_edge"};
    const struct gm_complex *complex = flow_of(view)->complex;
    const double triangles = (double)complex->triangles;
    const double values[] = {triangles, (double)complex->obtuse / triangles, complex->star_least,
                             complex->mean_edge};
    size_t i = 0;
    while (strcmp(keys[i], view->observable->key) != 0) {
        i++;
    }
    return values[i];
}

static double scalar_mean(const struct gm_view *view)
{
    const struct gm_flow *flow = flow_of(view);
    return gm_flow_scalar_total(flow, view->state) / flow->complex->total_area;
}

double gm_room_exact(const struct gm_view *view, enum gm_room_key key, const double at[2])
{
    const struct gm_room *room = gm_room_of(view->problem);
    const struct gm_room_line *line = gm_room_line(room, GM_ROOM_EXACT);
    const double place[4] = {0, at[0], at[1], view->t * gm_flow_of(view->problem)->time_unit};
    return room->unsolved || !line ? NAN
                                   : gm_room_value(room, line, key, place, key == GM_ROOM_SPEED_Y ? 0 : NAN);
}

/* |values - exact| / |exact| at the vertices in the norm sum star0 w^2, of psi or the scalar by the observable's key */
static double vertex_error(const struct gm_view *view)
{
    const struct gm_complex *complex = flow_of(view)->complex;
    const bool stream = strcmp(view->observable->key, "psi_error") == 0;
    const enum gm_room_key key = stream ? GM_ROOM_STREAM_FUNCTION : GM_ROOM_SCALAR;
    const double *values = gm_flow_block(flow_of(view), view->state, stream ? GM_FLOW_PSI : GM_FLOW_THETA);
    double error = 0, size = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double truth = gm_room_exact(view, key, complex->point + 2 * v), away = values[v] - truth;
        error += complex->star0[v] * away * away;
        size += complex->star0[v] * truth * truth;
    }
    return sqrt(error / size);
}

static double solution_error(const struct gm_view *view)
{
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double largest = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double truth = gm_room_exact(view, GM_ROOM_STREAM_FUNCTION, complex->point + 2 * v);
        largest = gm_larger(largest, fabs(view->state[v] - truth));
    }
    return largest;
}

/* Sets an end of a dual edge: a dual vertex, or on the boundary the edge's middle. */
static void dual_end(const struct gm_complex *complex, size_t e, int side, double p[2])
{
    const int t = complex->edge_triangle[2 * e + (size_t)side];
    if (t >= 0) {
        gm_complex_centre(complex, (size_t)t, p);
    } else {
        gm_complex_middle(complex, e, p);
    }
}

static double flux_error(const struct gm_view *view)
{
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double error = 0, size = 0;
    for (size_t e = 0; e < complex->edges; e++) {
        double from[2], to[2], exact = 0;
        dual_end(complex, e, 1, from);
        dual_end(complex, e, 0, to);
        const double middle[2] = {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2};
        for (int c = 0; c < 2; c++) { /* Simpson's rule is exact for a parabola */
            const enum gm_room_key key = c == 0 ? GM_ROOM_SPEED_X : GM_ROOM_SPEED_Y;
            exact += (to[c] - from[c]) *
                     (gm_room_exact(view, key, from) + 4 * gm_room_exact(view, key, middle) +
                      gm_room_exact(view, key, to)) /
                     6;
        }
        const double circulation =
            -complex->star1[e] * (view->state[complex->edge[2 * e + 1]] - view->state[complex->edge[2 * e]]);
        error += complex->length[e] * (circulation - exact) * (circulation - exact);
        size += complex->length[e] * exact * exact;
    }
    return sqrt(error / size);
}

static double velocity_error(const struct gm_view *view)
{
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double error = 0, size = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double u[2], p[6];
        gm_flow_velocity(complex, view->state, t, u);
        gm_complex_corners(complex, t, p);
        const double middle[2] = {(p[0] + p[2] + p[4]) / 3, (p[1] + p[3] + p[5]) / 3},
                     x = gm_room_exact(view, GM_ROOM_SPEED_X, middle),
                     y = gm_room_exact(view, GM_ROOM_SPEED_Y, middle);
        error += complex->area[t] * ((u[0] - x) * (u[0] - x) + (u[1] - y) * (u[1] - y));
        size += complex->area[t] * (x * x + y * y);
    }
    return sqrt(error / size);
}

/* Returns the error of the total pressure over the triangles, or over those whose dual vertex is further than 0.2 from
   the boundary of the rectangle, by the observable's key; both pressures with mean 0 there. */
static double pressure_error(const struct gm_view *view)
{
    const double margin = strcmp(view->observable->key, "pressure_error") == 0 ? -INFINITY : 0.2;
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    const struct gm_rectangle *box = &gm_room_of(view->problem)->rectangle;
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
        const double to_wall =
            fmin(fmin(centre[0], box->width - centre[0]), fmin(centre[1], box->height - centre[1]));
        exact[t] = gm_room_exact(view, GM_ROOM_TOTAL_PRESSURE, centre);
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

/* Returns the mean of |u - exact|, or of |theta - exact|, at fifty points inside a profile: on the walls
   velocity and temperature are given, and a polynomial fitted to one side misses the flow. */
static double profile_error(const struct gm_view *view)
{
    enum { PLACES = 50 };
    const char quantity = view->observable->key[0] == 'u' ? 'u' : 's';
    const double margin = 0.02;
    const double *ends = gm_room_subject_of(view)->profile->options->numbers;
    double sum = 0;
    for (size_t i = 0; i < PLACES; i++) {
        const double s = margin + (1 - 2 * margin) * (double)i / (PLACES - 1),
                     at[2] = {ends[0] + s * (ends[2] - ends[0]), ends[1] + s * (ends[3] - ends[1])};
        struct gm_sample sample = {0};
        gm_flow_sample(gm_flow_of(view->problem), view->state, at[0], at[1], &sample);
        sum += fabs(gm_room_quantity(&sample, quantity) - gm_room_exact(view, gm_room_key_of(quantity), at));
    }
    return sum / PLACES;
}

#define GM_MEASURE(measure_, key, ...)                                                                       \
    .observable = GM_OBSERVABLE(key, measured, __VA_ARGS__), .measure = measure_

const struct gm_room_row gm_room_rows[GM_ROOM_KINDS] = {
    {.observable = GM_LOG_OBSERVABLE("u_error", profile_error, "mean error of u"), .along = true},
    {.observable = GM_LOG_OBSERVABLE("theta_error", profile_error, "mean error of θ"), .along = true},
    {.observable = GM_LOG_OBSERVABLE("solution_error", solution_error, "error of ψ")},
    {.observable = GM_LOG_OBSERVABLE("psi_error", vertex_error, "relative error of ψ")},
    {.observable = GM_LOG_OBSERVABLE("theta_error", vertex_error, "relative error of θ")},
    {.observable = GM_LOG_OBSERVABLE("flux_error", flux_error, "relative error of the flux")},
    {.observable = GM_LOG_OBSERVABLE("velocity_error", velocity_error, "relative error of the velocity")},
    {.observable =
         GM_LOG_OBSERVABLE("pressure_error", pressure_error, "relative error of the total pressure")},
    {.observable = GM_LOG_OBSERVABLE("pressure_error_middle", pressure_error,
                                     "relative error of the total pressure away from the walls")},
    {.observable = GM_OBSERVABLE("psi_min", psi_low, "least stream function")},
    {.observable = GM_OBSERVABLE("mean_edge", of_mesh, "mean edge")},
    {GM_MEASURE(gm_flow_enstrophy, "enstrophy_error", "enstrophy error", .error = true, .symbol = "Z",
                .logarithmic = true)},
    {GM_MEASURE(gm_flow_circulation_error, "circulation_error", "circulation error", .logarithmic = true)},
    {GM_MEASURE(gm_flow_scalar_total, "scalar_total", "pollutant in the room"), .of_scalar = "integral of"},
    {.observable = GM_OBSERVABLE("scalar_outflow", scalar_outflow, "outflow of pollutant"),
     .of_scalar = "outflow of"},
    {.observable = GM_LOG_OBSERVABLE("budget_defect", budget_defect, "defect of the pollutant's budget"),
     .of_scalar = "defect of the budget of"},
    {GM_MEASURE(gm_flow_divergence, "divergence", "divergence  max |d₁ d₀ ψ|", .logarithmic = true)},
    {GM_MEASURE(gm_flow_kinetic_energy, "kinetic_energy", "kinetic energy"), .powers = {{4, -2, 0}}},
    {GM_MEASURE(gm_flow_enstrophy, "enstrophy", "enstrophy"), .powers = {{2, -2, 0}}},
    {GM_MEASURE(gm_flow_largest_speed, "speed_max", "largest speed, of a triangle or of the boundary"),
     .powers = {{1, -1, 0}}},
    {.observable = GM_LOG_OBSERVABLE("change", change, "change of ψ in a step")},
    {.observable = GM_OBSERVABLE("triangles", of_mesh, "triangles")},
    {.observable = GM_OBSERVABLE("obtuse_share", of_mesh, "share of obtuse triangles")},
    {.observable = GM_OBSERVABLE("star_least", of_mesh, "least entry of the circumcentric star")},
    {.observable = GM_OBSERVABLE("scalar_mean", scalar_mean, "mean concentration"), .of_scalar = "mean"},
    {GM_MEASURE(gm_flow_temperature_mean, "temperature_mean", "mean temperature"), .powers = {{0, 0, 1}}},
};
