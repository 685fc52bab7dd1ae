/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flows without divergence in three dimensions: that of Arnold, Beltrami & Childress, and a linear one,
       abc      x' = A sin z + C cos y,   y' = B sin x + A cos z,   z' = C sin y + B cos x
       linear   x' = M x,   tr M = 0
   They are not Hamiltonian: what the exact flow keeps is volume. What to look at: the volume of a small cell
   of fluid, which only the volume-preserving splittings keep; a symplectic Runge-Kutta method does not.
   K. Feng & Z.-J. Shang, Numer. Math. 71 (1995) 451; H. Ammari, lecture 5.

   The member 0 is an orbit; the others surround it at two distances and give the derivative of the flow by
   extrapolated differences. */
#include <math.h>
#include <stdio.h>

#include "core/ode/problems/problems.h"
#include "scenes/common/graph.h"
#include "scenes/ode/asked.h"

enum { ABC, LINEAR };
enum { X, Y, Z, DIMENSION, MEMBERS = 1 + 4 * DIMENSION, CROSSINGS = 1 << 14 };

/* Half the size of the cell, and how far it may be drawn out before differences are no derivatives. */
static const double small = 2e-5, drawn_out = 4e-3;

struct abc {
    struct gm_timing timing;
    int system;
    double abc[3];
    double start[DIMENSION];
};

static const char *const systems[] = {"abc", "linear", NULL};

#define CONSTANT(key_, index, standard_)                                                                     \
    {                                                                                                        \
        .key = key_, .unit = "", .help = "of the ABC flow", .type = GM_REAL,                                 \
        .offset = offsetof(struct abc, abc) + (index) * sizeof(double), .standard = standard_,               \
        .lowest = -10, .highest = 10,                                                                        \
    }

#define START(key_, index, standard_)                                                                        \
    {                                                                                                        \
        .key = key_, .unit = "", .help = "at the start", .type = GM_REAL,                                    \
        .offset = offsetof(struct abc, start) + (index) * sizeof(double), .standard = standard_,             \
        .lowest = -10, .highest = 10,                                                                        \
    }

static const struct gm_parameter parameters[] = {
    GM_DT("0.1", 1e-6, 10),
    GM_UNTIL("500"),
    GM_CHOICE_ROW(struct abc, system, "system", "abc", systems, "abc, or linear with zero trace"),
    CONSTANT("A", 0, "1"),
    CONSTANT("B", 1, "sqrt(2/3)"),
    CONSTANT("C", 2, "sqrt(1/3)"),
    START("x", 0, "0.5"),
    START("y", 1, "1.1"),
    START("z", 2, "-0.4"),
};

/* Its trace is zero. */
static const double matrix[9] = {0.2, 1, -0.1, -0.9, -0.3, 0.4, 0.3, 0.2, 0.1};

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct abc *abc = self;
    *problem = abc->system == ABC ? gm_problem_abc : gm_problem_linear;
    problem->parameters = abc->system == ABC ? abc->abc : matrix;
    problem->m = MEMBERS;
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    const double *at = ((const struct abc *)self)->start;
    const size_t m = problem->m;
    for (size_t c = 0; c < DIMENSION; c++) {
        for (size_t i = 0; i < m; i++) {
            y[c * m + i] = at[c];
        }
        for (size_t k = 0; k < 4; k++) {
            y[c * m + 1 + 4 * c + k] += small * (const double[]){1, -1, 2, -2}[k];
        }
    }
}

/* ln det of the derivative of the flow from the start: that of the cell's volume to what it was. */
static double log_volume(const struct gm_view *view)
{
    const size_t m = view->problem->m;
    double d[DIMENSION][DIMENSION];
    for (size_t r = 0; r < DIMENSION; r++) {
        for (size_t c = 0; c < DIMENSION; c++) {
            const double *row = view->state + r * m + 1 + 4 * c;
            if (fabs(row[2] - row[3]) > drawn_out) {
                return NAN;
            }
            d[r][c] = (8 * (row[0] - row[1]) - (row[2] - row[3])) / (12 * small);
        }
    }
    return log(d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
               d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
               d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]));
}

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("log_volume", log_volume, "ln(volume / initial volume)",
                      .missing = "the cell is drawn out too far for differences to measure"),
};

/* z passes a multiple of 2 pi upwards. */
static double level_z(const struct gm_view *view)
{
    const double z = view->state[Z * view->problem->m];
    const struct abc *self = view->parameters;
    return self->system == ABC && cos(z) > 0 ? sin(z) : NAN;
}

static double wrapped(double angle)
{
    return angle - 2 * M_PI * floor(angle / (2 * M_PI));
}

static void record_crossing(const struct gm_view *view, double *entry)
{
    /* x from -pi to pi, so that what lies around 0 is whole */
    entry[0] = wrapped(view->state[X * view->problem->m] + M_PI) - M_PI;
    entry[1] = wrapped(view->state[Y * view->problem->m]);
}

static void remember(const struct gm_view *view, double *entry)
{
    entry[0] = view->state[X * view->problem->m];
    entry[1] = view->state[Y * view->problem->m];
}

enum { SECTION, TRAIL };
static const struct gm_track tracks[] = {
    [SECTION] =
        {.key = "section", .numbers = 2, .section = level_z, .bound = CROSSINGS, .record = record_crossing},
    [TRAIL] = {.key = "trail", .numbers = 2, .every = 0.1, .bound = 400, .recent = true, .record = remember},
};

static void trail_range(const struct gm_lane *const *lanes, size_t count, struct gm_axis *x,
                        struct gm_axis *y)
{
    *x = (struct gm_axis){.label = "x", .scale = GM_LINEAR, .low = 1, .high = 0};
    *y = (struct gm_axis){.label = "y", .scale = GM_LINEAR, .low = 1, .high = 0};
    for (size_t i = 0; i < count; i++) {
        const struct gm_entries *trail = &lanes[i]->entries[TRAIL];
        for (size_t k = 0; k < trail->count; k++) {
            gm_range_add(&x->low, &x->high, trail->values[2 * k]);
            gm_range_add(&y->low, &y->high, trail->values[2 * k + 1]);
        }
    }
    gm_range_round(&x->low, &x->high, GM_LINEAR);
    gm_range_round(&y->low, &y->high, GM_LINEAR);
}

/* The section is that of z = 0. */
static size_t point(const void *self, double x, double y, struct gm_choice *choices)
{
    gm_choose(&choices[0], "x", x);
    gm_choose(&choices[1], "y", y);
    gm_choose(&choices[2], "z", 0);
    return ((const struct abc *)self)->system == ABC ? 3 : 2;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct abc *self = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    const bool flow = self->system == ABC;
    picture->title = gm_picture_text(
        picture, flow ? "The ABC flow: section and volume, by %s" : "A linear flow of zero trace, by %s",
        gm_counted_schemes(lanes, count));
    picture->subtitle = gm_picture_text(picture, "%s%s",
                                        flow ? "x and y, modulo 2π, whenever z passes a multiple of 2π"
                                             : "the orbit in x and y",
                                        one_step ? gm_picture_text(picture, ",  Δt = %.4g", dt) : "");
    picture->caption =
        "The exact flow keeps every volume. Being symplectic does not help in three dimensions: the splitting "
        "into shears does. The graph ends where the cell is drawn out too far.";
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const enum gm_role role = gm_lane_role(walk.lane->shown.colour);
        if (walk.first) {
            panel = gm_walk_panel(picture, &walk, "");
            panel->axes = true;
            panel->equal = flow;
            panel->x = (struct gm_axis){.label = "x", .scale = GM_PI, .low = -M_PI, .high = M_PI};
            panel->y = (struct gm_axis){.label = "y", .scale = GM_PI, .low = 0, .high = 2 * M_PI};
            if (!flow) {
                trail_range(lanes, count, &panel->x, &panel->y);
            }
        }
        if (flow) {
            const struct gm_entries *section = &walk.lane->entries[SECTION];
            gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.85, .width = 3},
                           section->values, section->count);
        } else {
            const struct gm_entries *trail = &walk.lane->entries[TRAIL];
            gm_draw_trail(picture, panel, (struct gm_style){role, 0.9, 1.8, GM_SOLID}, trail->values,
                          trail->count);
        }
    }
    static const struct gm_graph graph = {.observable = "log_volume",
                                          .magnitude = true,
                                          .highest = true,
                                          .scale = GM_LOG,
                                          .to_last = true,
                                          .calm_low = 1e-12,
                                          .calm_high = 1e-2};
    gm_draw_graphs(picture, lanes, count, &graph, 1);
}

static const char *const schemes[] = {
    "volume-splitting2", "midpoint",       "rk4", "gauss4", "volume-splitting1",
    "explicit-euler",    "implicit-euler", NULL};

static const struct gm_work work = {
    .arguments = "until=20", .coarsest = 0.8, .halvings = 8, .reference = "gauss8"};

const struct gm_scene gm_scene_abc = {
    .name = "abc",
    .title = "Flow without divergence",
    .blurb =
        "The ABC flow of Arnold, Beltrami and Childress: steady, incompressible, in part chaotic. A small cell of fluid "
        "is stretched and folded, and keeps its volume.",
    .watch =
        "Watch the volume of the cell: a symplectic Runge-Kutta method does not keep it in three dimensions.",
    .time = "length / speed, in the units of x and of A, B, C",
    .size = sizeof(struct abc),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    GM_ASKED_OF_EQUATIONS,
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .work = &work,
    .no_stability =
        "its particles move on a torus, and nothing grows; stability --region SCHEME shows the limit of a scheme",
    .follow = 1,
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
