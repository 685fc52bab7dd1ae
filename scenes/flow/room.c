/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The polluted room: air enters top left with a parabolic profile and carries a pollutant, and leaves bottom
   right; a square of side 5, or a mesh of Gmsh. Lengths in inlet heights h, velocities in the inlet's centre
   speed U, time in return periods, perimeter / U; Reynolds number U h / nu. What to look at: the vortex fills
   with pollutant long after the jet has found the outlet; the divergence and the pollutant's budget are zero
   to the last digit.

   Razafindralandy, Hamdouni & Chhay (2018):
       figure 35   the room        figure 36   the grid
       figure 37   streamlines and pollutant after half, one and two return periods */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/flow/flows.h"

static const double side = 5; /* of the room, in inlet heights */

static const struct gm_parameter parameters[] = {
    GM_DT("0.002", 1e-7, 10),
    GM_UNTIL("3"),
    GM_REAL_ROW(struct gm_flows, reynolds, "reynolds", "100", 0.01, 1e5, "Reynolds number U h / ν",
                .logarithmic = true),
    GM_REAL_ROW(struct gm_flows, schmidt, "schmidt", "1", 1e-3, 1e4, "Schmidt number ν / κ",
                .logarithmic = true),
    GM_INTEGER_ROW(struct gm_flows, rows, "rows", "50", 10, 1000,
                   "edges on each of the walls x = 0 and x = 5", .logarithmic = true, .required = true),
    GM_INTEGER_ROW(struct gm_flows, columns, "columns", "66", 0, 2000,
                   "strips of triangles along x; 0: the best", .logarithmic = true, .required = true),
    GM_FLOWS_IRREGULAR,
    GM_TEXT_ROW(struct gm_flows, outlet, "outlet", "soft",
                "soft, dirichlet or free; of a mesh also GROUP,GROUP or GROUP,GROUP:free",
                .choices = gm_flows_outlets, .names = true),
    GM_TEXT_ROW(struct gm_flows, inlet, "inlet", "inlet", "names or tags of the inlets, with mesh= alone",
                .names = true),
    GM_TEXT_ROW(
        struct gm_flows, mesh, "mesh", "none",
        "a Gmsh file (2.2 or 4.1) of another room, instead of rows, columns and irregular; none: the square",
        .file = true),
    GM_FLOWS_STAR,
    GM_FLOWS_REFINE,
    GM_REAL_ROW(struct gm_flows, inlet_scalar, "inlet_scalar", "1000", -1e300, 1e300,
                "concentration that enters"),
    GM_FLOWS_TRACERS("350"),
    GM_FLOWS_LOOKS("scalar", "yes"),
};

/* Rows and columns agree. */
static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    gm_flows_follow(self, (struct gm_rectangle){.width = side, .height = side, .transposed = true}, keys,
                    count);
    struct gm_flows *flows = self;
    if (!gm_is_given("rows", keys, count)) { /* the lips are vertices, and two edges long at least */
        flows->rows = (long)fmax(10, (double)(5 * ((flows->rows + 2) / 5)));
    }
    return true;
}

static unsigned char side_at(const double middle[2])
{
    return middle[0] == 0 && middle[1] > side - 1 ? GM_EDGE_INLET
           : middle[0] == side && middle[1] < 1   ? GM_EDGE_OUTLET
                                                  : GM_EDGE_WALL;
}

static struct gm_flow *open_square(const struct gm_flows *flows, unsigned char **sides, char *sentence)
{
    if (flows->rows % 5 != 0) {
        gm_refuse(
            sentence,
            "rows=%ld: the lips of inlet and outlet are vertices only if rows is a multiple of 5; the nearest is %ld",
            flows->rows, 5 * ((flows->rows + 2) / 5));
        return NULL;
    }
    const double lips[] = {0, side - 1, side, 1};
    struct gm_rectangle rectangle = {.width = side,
                                     .height = side,
                                     .edges = flows->rows,
                                     .strips = flows->columns,
                                     .transposed = true,
                                     .irregular = flows->irregular,
                                     .fixed = lips,
                                     .fixed_count = 2};
    struct gm_flow *flow = gm_flows_rectangle(&rectangle, sentence);
    *sides = flow ? gm_flows_sides(flow, side_at, sentence) : NULL;
    return flow;
}

/* Makes edges of the groups of a list, "1,2", one side. */
static bool name_sides(const struct gm_triangulation *mesh, const char *key, const char *list,
                       enum gm_edge_kind kind, unsigned char *sides, char *sentence)
{
    for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        char name[GM_TEXT_SIZE];
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
        const long tag = gm_flows_group(mesh, key, name, sentence);
        bool good = tag != 0;
        for (size_t b = 0; good && b < mesh->complex->boundary; b++) {
            if (gm_triangulation_has(mesh, (size_t)mesh->complex->boundary_edge[b], tag)) {
                good = sides[b] == GM_EDGE_WALL ||
                       gm_refuse(sentence, "the group \"%.60s\" is named twice", name);
                sides[b] = (unsigned char)kind;
            }
        }
        if (!good) {
            return false;
        }
    }
    return true;
}

static struct gm_flow *open_file(const struct gm_flows *flows, const char *outlet, unsigned char **sides,
                                 char *sentence)
{
    struct gm_triangulation mesh;
    if (!gm_flows_file(flows->mesh, NULL, (enum gm_star)flows->star, &mesh, sentence) ||
        !gm_flows_refine(flows->mesh, (enum gm_star)flows->star, flows->refine, &mesh, sentence)) {
        return NULL;
    }
    struct gm_flow *flow = NULL;
    *sides = calloc(mesh.complex->boundary + 1, 1);
    if (!*sides) {
        gm_refuse(sentence, "not enough memory");
    } else if (name_sides(&mesh, "inlet", flows->inlet, GM_EDGE_INLET, *sides, sentence) &&
               name_sides(&mesh, "outlet", outlet, GM_EDGE_OUTLET, *sides, sentence)) {
        flow = gm_flow_open(mesh.complex);
        mesh.complex = NULL;
    }
    gm_triangulation_close(&mesh);
    return flow;
}

static bool setup(const void *parameters_of, struct gm_problem *problem, char *sentence)
{
    const struct gm_flows *flows = parameters_of;
    const bool from_file = strcmp(flows->mesh, "none") != 0;
    enum gm_vertex_kind outlet = GM_VERTEX_SOFT;
    char group[GM_TEXT_SIZE];
    unsigned char *sides = NULL;
    if (!gm_flows_outlet(flows->outlet, GM_VERTEX_SOFT, &outlet, group, sentence)) {
        return false;
    }
    if (!from_file && (strcmp(group, "outlet") != 0 || strcmp(flows->inlet, "inlet") != 0)) {
        return gm_refuse(
            sentence,
            "inlet= and the outlet's name are for a mesh=FILE; here outlet is soft, dirichlet or free");
    }
    struct gm_flow *flow =
        from_file ? open_file(flows, group, &sides, sentence) : open_square(flows, &sides, sentence);
    bool good = flow && sides;
    if (good) {
        good = gm_flows_boundary(gm_flow_set_boundary(flow, sides, 1, outlet, flows->inlet_scalar), sentence);
    }
    free(sides);
    if (!good) {
        gm_flow_close(flow);
        return false;
    }
    const struct gm_complex *complex = flow->complex;
    double perimeter = 0;
    for (size_t b = 0; b < complex->boundary; b++) {
        perimeter += complex->length[complex->boundary_edge[b]];
    }
    flow->viscosity = flow->inlet_length / flows->reynolds;
    flow->diffusivity = flow->viscosity / flows->schmidt;
    flow->reynolds = flows->reynolds;
    flow->time_unit = perimeter;
    flow->scalar = true;
    flow->tracers = (size_t)flows->tracers;
    return gm_flows_problem(problem, flow, "room", sentence);
}

static const struct gm_observable observables[] = {
    GM_FLOWS_OF_ROOMS,
};

static void profile(const struct gm_view *view, const char *front, FILE *stream)
{
    const struct gm_complex *complex = gm_flow_of(view->problem)->complex;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < 2 * complex->vertices; i++) {
        low[i % 2] = fmin(low[i % 2], complex->point[i]);
        high[i % 2] = fmax(high[i % 2], complex->point[i]);
    }
    const double middle[2] = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
    const struct gm_profile lines[] = {
        {"vertical", {middle[0], low[1]}, {middle[0], high[1]}, 101, NULL},
        {"horizontal", {low[0], middle[1]}, {high[0], middle[1]}, 101, NULL},
    };
    for (size_t i = 0; i < 2; i++) {
        gm_flows_write_profile(view, front, &lines[i], stream);
    }
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_flows *flows = lanes[0]->parameters;
    /* about half of the room fills, and what enters at the mean of a parabola leaves again; a short run fills
       it with no more than enters */
    const struct gm_flow *flow = gm_flow_of(&lanes[0]->problem);
    const double scalar = fmax(flows->inlet_scalar, 0), inlet = flow->viscosity * flow->reynolds;
    double area = 0;
    for (size_t k = 0; k < flow->complex->triangles; k++) {
        area += flow->complex->area[k];
    }
    const double entering = inlet * scalar * flows->timing.until * flow->time_unit;
    const struct gm_look look = {
        .title = "A polluted room",
        .told = {{"Reynolds number", offsetof(struct gm_flows, reynolds), NULL},
                 {"Schmidt number", offsetof(struct gm_flows, schmidt), NULL}},
        .remark = gm_picture_text(picture, ";  τ = %.4g h/U, the perimeter / U", flow->time_unit),
        .clock_unit = "τ",
        .axes = {"x / h", "y / h"},
        .vorticity_range = 6,
        .speed_high = 1.2,
        .graphs = {"scalar_total", "scalar_outflow"},
        .graph_high = {fmin(0.48 * area * scalar, entering), 0.4 * inlet * scalar},
    };
    gm_flows_draw(lanes, count, picture, &look);
}

static const char *const schemes[] = {"semi-implicit", NULL};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-35",
        .statement = "a square room, its inlet and outlet a fifth of its height",
        .arguments = "until=0.002 show=none streamlines=no tracers=0",
    },
    {
        .name = "razafindralandy-36",
        .statement = "the grid, of 3436 vertices and 6670 acute triangles",
        .arguments = "until=0.002 irregular=0.25 show=none streamlines=no grid=yes tracers=0",
    },
    {
        .name = "razafindralandy-37",
        .statement = "streamlines and pollutant after half, one and two return periods",
        .arguments = "until=0.5,1,2 irregular=0.25 tracers=0",
    },
};

static double courant_time(const void *self)
{
    return gm_flows_courant_time(setup, self);
}

static const double reynolds_numbers[] = {10, 30, 100, 300, 1000};

static const struct gm_stability stability = {
    .arguments = "rows=30 columns=0 tracers=0 until=2",
    .values = reynolds_numbers,
    .value_count = GM_COUNT(reynolds_numbers),
    .unit = courant_time,
    GM_FLOWS_STABILITY,
};

const struct gm_scene gm_scene_room = {
    .name = "room",
    .title = "A polluted room",
    .blurb =
        "Polluted air enters a room top left and leaves it bottom right. Discrete exterior calculus makes no mass, "
        "not even by round-off, and the pollutant's budget closes to the last digit.",
    .watch = "Watch the vortex fill with pollutant long after the jet has found the outlet.",
    .time = "τ = 4H/U, once around the room at the speed of the inlet’s centre",
    .size = sizeof(struct gm_flows),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .stability = &stability,
    .idle = gm_flows_idle,
    .settle = settle,
    .setup = setup,
    .readable = gm_flows_readable,
    .chosen = gm_flows_chosen,
    .note = gm_flows_note,
    .close = gm_flows_close,
    .start = gm_flows_start,
    .draw = draw,
    .profile = profile,
};
