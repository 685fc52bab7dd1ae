/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons between walls on linear elements whose nodes follow them: r-adaptive variational integrators.
   Tyranowski & Desbrun (2019), section 5, figures 2 to 14. */
#include "core/problems/soliton.h"

#include <math.h>
#include <stdio.h>

#include "scenes/graph.h"

enum { SHOW_ALL, SHOW_FIELD, SHOW_MESH, SHOW_ENERGY, SHOW_CONVERGENCE };
enum { EXACT_POINTS = 1500, PATHS = 255 /* most nodes whose paths are recorded */, RECORDS = 400 };

struct soliton {
    struct gm_timing timing;
    struct gm_soliton own;
    int show;
};

static const char *const fields[] = {"sine-gordon", "phi4", NULL};
static const char *const densities[] = {"arclength", "curvature", "mix", NULL};
static const char *const shows[] = {"all", "field", "mesh", "energy", "convergence", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.01", 1e-6, 10),
    GM_UNTIL("50"),
    {
        .key = "solitons",
        .unit = "",
        .help = "one soliton, or two that bounce off each other",
        .type = GM_INTEGER,
        .offset = offsetof(struct soliton, own.solitons),
        .standard = "1",
        .lowest = 1,
        .highest = 2,
    },
    {
        .key = "points",
        .unit = "",
        .help = "nodes between the ends",
        .type = GM_INTEGER,
        .offset = offsetof(struct soliton, own.points),
        .standard = "31",
        .lowest = 1,
        .highest = 1e5,
        .logarithmic = true,
    },
    {
        .key = "velocity",
        .unit = "",
        .help = "of the solitons; 1 is that of light",
        .type = GM_REAL,
        .offset = offsetof(struct soliton, own.velocity),
        .standard = "0.9",
        .lowest = 0.01,
        .highest = 0.999999,
    },
    {
        .key = "alpha",
        .unit = "",
        .help = "weight of the field's slope in the mesh density; auto: 2.5 for one soliton, 1.5 for two",
        .type = GM_REAL,
        .offset = offsetof(struct soliton, own.alpha),
        .standard = "auto",
        .lowest = 0,
        .highest = 1000,
        .automatic = true,
    },
    {
        .key = "density",
        .unit = "",
        .help = "what the nodes equidistribute: arclength, curvature or a mix of both",
        .type = GM_CHOICE,
        .offset = offsetof(struct soliton, own.density),
        .standard = "arclength",
        .choices = densities,
    },
    {
        .key = "potential",
        .unit = "",
        .help = "W(φ) = 1 − cos φ or (φ² − 1)²/4",
        .type = GM_CHOICE,
        .offset = offsetof(struct soliton, own.field),
        .standard = "sine-gordon",
        .choices = fields,
    },
    {
        .key = "length",
        .unit = "",
        .help = "distance of the walls",
        .type = GM_REAL,
        .offset = offsetof(struct soliton, own.length),
        .standard = "25",
        .lowest = 1,
        .highest = 1e4,
        .logarithmic = true,
    },
    {
        .key = "show",
        .unit = "",
        .help =
            "what the picture shows: all, the field, the paths of the nodes, the energy, or error over nodes",
        .type = GM_CHOICE,
        .offset = offsetof(struct soliton, show),
        .standard = "all",
        .choices = shows,
        .live = true,
    },
};

static void resolve(void *own)
{
    struct soliton *soliton = own;
    soliton->own.alpha = gm_soliton_alpha(&soliton->own);
}

static bool setup(const void *own, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct soliton *soliton = own;
    gm_soliton_problem(&soliton->own, problem);
    return true;
}

static bool start_with(const void *own, const struct gm_problem *problem, const struct gm_scheme *scheme,
                       double *y, char *sentence)
{
    const struct soliton *soliton = own;
    struct gm_mesh mesh;
    problem->moving_mesh->describe(problem, &mesh);
    if (gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &soliton->own, y)) {
        return true;
    }
    snprintf(
        sentence, GM_SENTENCE,
        "no mesh of %ld nodes was found for alpha = %g and velocity = %g; a smaller alpha or more points help",
        soliton->own.points, gm_soliton_alpha(&soliton->own), soliton->own.velocity);
    return false;
}

static struct gm_mesh mesh_of(const struct gm_view *view)
{
    struct gm_mesh mesh;
    view->problem->moving_mesh->describe(view->problem, &mesh);
    return mesh;
}

static bool moves(const struct gm_view *view)
{
    return gm_scheme_mesh(view->run->scheme) == GM_MESH_MOVING;
}

static double solution_error(const struct gm_view *view)
{
    const struct soliton *soliton = view->parameters;
    const size_t points = (size_t)soliton->own.points;
    double largest = 0;
    for (size_t k = 0; k < points; k++) {
        const double difference =
            fabs(view->state[k] - gm_soliton_exact(&soliton->own, view->state[points + k], view->t));
        largest = difference <= largest ? largest : difference;
    }
    return largest;
}

static double energy(const struct gm_view *view)
{
    const struct gm_mesh mesh = mesh_of(view);
    return gm_mesh_energy(&mesh, view->state);
}

static double energy_continuum_error(const struct gm_view *view)
{
    const struct soliton *soliton = view->parameters;
    const double continuum = gm_soliton_energy(&soliton->own);
    return fabs(energy(view) - continuum) / continuum;
}

static double constraint_defect(const struct gm_view *view)
{
    const struct gm_mesh mesh = mesh_of(view);
    return moves(view) ? gm_mesh_constraint_defect(&mesh, view->state) : NAN;
}

static double multiplier_norm(const struct gm_view *view)
{
    return gm_mesh_multiplier_norm(view->run);
}

static double smallest_cell(const struct gm_view *view)
{
    const struct gm_mesh mesh = mesh_of(view);
    return gm_mesh_smallest_cell(&mesh, view->state);
}

static double newton_iterations(const struct gm_view *view)
{
    return (double)view->run->iterations;
}

static double factorisations(const struct gm_view *view)
{
    return gm_mesh_factorisations(view->run);
}

static const struct gm_observable observables[] = {
    {.key = "solution_error",
     .title = "error  max |φ − exact| at the nodes",
     .unit = "",
     .evaluate = solution_error,
     .logarithmic = true},
    {.key = "energy", .title = "discrete energy", .unit = "", .evaluate = energy},
    {.key = "energy_error",
     .title = "energy error  |E − E₀| / E₀",
     .unit = "",
     .evaluate = energy,
     .error = true,
     .scale = 1e-3,
     .logarithmic = true},
    {.key = "energy_continuum_error",
     .title = "difference from the solitons' energy",
     .unit = "",
     .evaluate = energy_continuum_error,
     .logarithmic = true},
    {.key = "constraint_defect",
     .title = "defect of the mesh constraint",
     .unit = "",
     .evaluate = constraint_defect,
     .logarithmic = true},
    {.key = "multiplier_norm", .title = "largest multiplier", .unit = "", .evaluate = multiplier_norm},
    {.key = "smallest_cell",
     .title = "smallest cell",
     .unit = "",
     .evaluate = smallest_cell,
     .logarithmic = true},
    {.key = "newton_iterations", .title = "Newton iterations", .unit = "", .evaluate = newton_iterations},
    {.key = "factorisations", .title = "matrices factored", .unit = "", .evaluate = factorisations},
};

/* Paths of all nodes, or of evenly chosen ones. */
static size_t path_stride(size_t points)
{
    return (points + PATHS - 1) / PATHS;
}

static size_t path_count(const struct gm_view *view)
{
    const size_t points = view->problem->n / 4, stride = path_stride(points);
    return (points + stride - 1) / stride;
}

static double path_interval(const void *own)
{
    return ((const struct gm_timing *)own)->until / (RECORDS / 2 - 1);
}

static void record_paths(const struct gm_view *view, double *entry)
{
    const size_t points = view->problem->n / 4, stride = path_stride(points);
    for (size_t k = 0; k < points; k += stride) {
        *entry++ = view->state[points + k];
    }
}

static const struct gm_track tracks[] = {
    {.key = "paths",
     .width = path_count,
     .interval = path_interval,
     .bound = RECORDS,
     .record = record_paths},
};

static void field_axes(struct gm_panel *panel, const struct soliton *soliton, const struct gm_mesh *mesh)
{
    const double low = fmin(mesh->left, mesh->right);
    const double high = soliton->own.field == GM_PHI4 ? 1 : fmax(mesh->left, mesh->right);
    const double room = 0.16 * (high - low);
    panel->axes = true;
    panel->x = (struct gm_axis){.label = "X", .scale = GM_LINEAR, .low = 0, .high = mesh->length};
    panel->y = (struct gm_axis){.label = "φ",
                                .scale = soliton->own.field == GM_PHI4 ? GM_LINEAR : GM_PI,
                                .low = low - room,
                                .high = high + room};
}

static void draw_exact(struct gm_picture *picture, struct gm_panel *panel, const struct gm_view *view)
{
    const struct soliton *soliton = view->parameters;
    double *points = gm_picture_memory(picture, 2 * EXACT_POINTS * sizeof *points);
    if (!points) {
        return;
    }
    for (size_t i = 0; i < EXACT_POINTS; i++) {
        const double x = soliton->own.length * (double)i / (EXACT_POINTS - 1);
        points[2 * i] = x;
        points[2 * i + 1] = gm_soliton_exact(&soliton->own, x, view->t);
    }
    gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 3, GM_SOLID}, points, EXACT_POINTS, false);
}

/* The nodes with both ends, as points of a line. */
static double *nodes_of(struct gm_picture *picture, const struct gm_mesh *mesh, const double *state)
{
    const size_t points = mesh->points;
    double *nodes = gm_picture_memory(picture, 2 * (points + 2) * sizeof *nodes);
    if (!nodes) {
        return NULL;
    }
    nodes[0] = 0;
    nodes[1] = mesh->left;
    for (size_t k = 0; k < points; k++) {
        nodes[2 * k + 2] = state[points + k];
        nodes[2 * k + 3] = state[k];
    }
    nodes[2 * points + 2] = mesh->length;
    nodes[2 * points + 3] = mesh->right;
    return nodes;
}

static void draw_field(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_mesh mesh = mesh_of(&view);
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    double *nodes = nodes_of(picture, &mesh, view.start);
    if (nodes && view.t != view.t0) {
        gm_mark_line(picture, panel, (struct gm_style){GM_INITIAL, 0.35, 1.2, GM_SOLID}, nodes,
                     mesh.points + 2, false);
    }
    nodes = nodes_of(picture, &mesh, view.state);
    if (!nodes) {
        return;
    }
    gm_mark_line(picture, panel, (struct gm_style){role, 1, 1.6, GM_SOLID}, nodes, mesh.points + 2, false);
    if (mesh.points <= 400) {
        const double size = mesh.points <= 40 ? 6 : mesh.points <= 130 ? 4.5 : 3;
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = size}, nodes,
                       mesh.points + 2);
    }
}

static void draw_fields(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    for (size_t p = 0; p < gm_panel_count(lanes, count); p++) {
        struct gm_panel *panel = NULL;
        for (size_t i = 0; i < count; i++) {
            if (lanes[i]->shown.panel != p) {
                continue;
            }
            if (!panel) {
                const struct gm_view view = gm_lane_view(lanes[i]);
                const struct gm_mesh mesh = mesh_of(&view);
                panel = gm_panel_add(picture, GM_PLACE_STATE, gm_lane_title(lanes[i]));
                field_axes(panel, view.parameters, &mesh);
                panel->title_role = gm_lane_role(lanes[i]->shown.colour);
                const char *failure = gm_lane_failure(picture, lanes[i]);
                const double error = solution_error(&view);
                panel->note = failure[0]        ? failure
                              : isfinite(error) ? gm_picture_text(picture, "error %.3f", error)
                                                : "";
                draw_exact(picture, panel, &view);
            } else {
                panel->title_role = GM_INK;
                panel->note = "";
            }
            draw_field(picture, panel, lanes[i]);
        }
    }
}

static void draw_paths(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                       bool crowded)
{
    const struct gm_entries *entries = &lane->entries[0];
    const struct gm_view view = gm_lane_view(lane);
    const size_t points = view.problem->n / 4, stride = path_stride(points), rows = entries->count + 1;
    const struct gm_style style = {gm_lane_role(lane->shown.colour), crowded ? 0.6 : 0.9, crowded ? 0.8 : 1.2,
                                   GM_SOLID};
    double *path = gm_picture_memory(picture, 2 * rows * sizeof *path);
    for (size_t k = 0; path && k < entries->width; k++) {
        for (size_t i = 0; i < entries->count; i++) {
            path[2 * i] = entries->values[i * entries->width + k];
            path[2 * i + 1] = entries->times[i];
        }
        path[2 * rows - 2] = view.state[points + k * stride];
        path[2 * rows - 1] = view.t;
        gm_mark_line(picture, panel, style, path, rows, false);
    }
}

static void draw_meshes(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        bool named)
{
    for (size_t p = 0; p < gm_panel_count(lanes, count); p++) {
        struct gm_panel *panel = NULL;
        for (size_t i = 0; i < count; i++) {
            if (lanes[i]->shown.panel != p) {
                continue;
            }
            const struct soliton *soliton = lanes[i]->parameters;
            if (!panel) {
                panel = gm_panel_add(picture, GM_PLACE_STATE, named ? gm_lane_title(lanes[i]) : "");
                panel->axes = true;
                panel->title_role = gm_lane_role(lanes[i]->shown.colour);
                panel->x =
                    (struct gm_axis){.label = "X", .scale = GM_LINEAR, .low = 0, .high = soliton->own.length};
                panel->y = (struct gm_axis){.label = "t", .scale = GM_LINEAR, .low = 0, .high = 1};
                panel->note = named ? gm_lane_failure(picture, lanes[i]) : "";
            }
            const double *times = lanes[i]->entries[0].times;
            panel->y.low = fmin(panel->y.low, fmin(times[0], lanes[i]->run->t));
            panel->y.high = fmax(panel->y.high, fmax(soliton->timing.until, lanes[i]->run->t));
            draw_paths(picture, panel, lanes[i], lanes[i]->entries[0].width > 40);
        }
    }
}

/* The largest error so far against the number of elements, a line for each scheme. */
static void draw_convergence(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, "largest error at any node and step");
    double low_x = 1, high_x = 0, low_y = 1, high_y = 0;
    double *largest = gm_picture_memory(picture, count * sizeof *largest);
    double *points = gm_picture_memory(picture, 2 * count * sizeof *points);
    if (!largest || !points) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const struct gm_history *history = &lanes[i]->history;
        const struct soliton *soliton = lanes[i]->parameters;
        largest[i] = lanes[i]->run->status == GM_OK ? 0 : NAN;
        for (size_t b = 0; b < history->count; b++) {
            largest[i] = fmax(history->bins[b * history->series].high, largest[i]);
        }
        largest[i] = lanes[i]->run->status == GM_OK ? largest[i] : NAN;
        gm_range_add(&low_x, &high_x, (double)(soliton->own.points + 1));
        gm_range_add(&low_y, &high_y, largest[i]);
    }
    gm_range_round(&low_y, &high_y, GM_LOG);
    panel->axes = true;
    panel->title_role = GM_INK;
    panel->x =
        (struct gm_axis){.label = "elements", .scale = GM_LOG, .low = low_x / 1.3, .high = high_x * 1.3};
    panel->y = (struct gm_axis){.label = "", .scale = GM_LOG, .low = low_y, .high = high_y};
    size_t series = 0;
    for (size_t i = 0; i < count; i++) {
        bool first = true;
        for (size_t k = 0; k < i; k++) {
            first &= lanes[k]->scheme != lanes[i]->scheme;
        }
        if (!first) {
            continue;
        }
        size_t made = 0;
        for (size_t k = i; k < count; k++) {
            if (lanes[k]->scheme == lanes[i]->scheme && isfinite(largest[k])) {
                const struct soliton *soliton = lanes[k]->parameters;
                points[2 * made] = (double)(soliton->own.points + 1);
                points[2 * made + 1] = largest[k];
                made++;
            }
        }
        const enum gm_role role = gm_lane_role(series);
        gm_mark_line(picture, panel, (struct gm_style){role, 1, 2.4, gm_lane_dash(series)}, points, made,
                     false);
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 7}, points, made);
        if (made > 0) {
            gm_mark_text(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 1}, points[0],
                         points[1] * pow(high_y / low_y, 0.03), GM_ANCHOR_LEFT, lanes[i]->scheme->title);
        }
        series++;
    }
}

static const char *subtitle(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const struct soliton *soliton = lanes[0]->parameters;
    bool one_step = true, one_size = true;
    for (size_t i = 1; i < count; i++) {
        const struct soliton *other = lanes[i]->parameters;
        one_step &= lanes[i]->run->dt == lanes[0]->run->dt;
        one_size &= other->own.points == soliton->own.points;
    }
    return gm_picture_text(picture, "%s,  velocity %g%s%s%s%s",
                           soliton->own.field == GM_PHI4 ? "φ⁴" : "sine-Gordon", soliton->own.velocity,
                           one_size ? ",  " : "",
                           one_size ? gm_picture_text(picture, "%ld nodes", soliton->own.points) : "",
                           one_step ? ",  Δt = " : "",
                           one_step ? gm_time_text(picture, lanes[0]->run->dt, lanes[0]->run->dt) : "");
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct soliton *soliton = lanes[0]->parameters;
    const bool two = soliton->own.solitons == 2;
    const char *who = two ? "two solitons" : "a soliton";
    switch (soliton->show) {
    case SHOW_MESH:
        picture->title = gm_picture_text(picture, "The paths of mesh points that follow %s", who);
        break;
    case SHOW_ENERGY:
        picture->title = gm_picture_text(picture, "The energy of %s on a moving mesh", who);
        break;
    case SHOW_CONVERGENCE:
        picture->title = gm_picture_text(picture, "What moving the mesh gains: %s", who);
        break;
    default:
        picture->title = gm_picture_text(picture, "Mesh points that follow %s", who);
    }
    picture->subtitle = subtitle(picture, lanes, count);
    gm_draw_clock(picture, lanes, count);
    const size_t panels = gm_panel_count(lanes, count);
    if (soliton->show == SHOW_CONVERGENCE) {
        draw_convergence(picture, lanes, count);
        return;
    }
    const bool both = soliton->show == SHOW_ALL && panels <= 3;
    if (soliton->show == SHOW_ALL || soliton->show == SHOW_FIELD) {
        draw_fields(picture, lanes, count);
    }
    if (both || soliton->show == SHOW_MESH) {
        draw_meshes(picture, lanes, count, !both);
    }
    if (both) {
        picture->state_columns = panels;
    }
    if (soliton->show == SHOW_ENERGY) {
        for (size_t i = 0; i < count; i++) {
            /* each in its own graph, all on one scale */
            const struct gm_graph graph = {.observable = "energy", .title = gm_lane_title(lanes[i])};
            if (i == 0 || lanes[i]->shown.panel != lanes[i - 1]->shown.panel) {
                gm_draw_graph(picture, lanes, count, &graph, (long)lanes[i]->shown.panel, false);
            }
        }
    }
    if (soliton->show == SHOW_ALL) {
        const struct gm_graph kept = {.observable = "energy",
                                      .title = "energy / initial energy",
                                      .relative = true,
                                      .calm_low = 0.99,
                                      .calm_high = 1.01};
        gm_draw_graph(picture, lanes, count, &kept, -1, false);
    }
    if (soliton->show == SHOW_ALL) {
        const struct gm_graph error = {.observable = "solution_error",
                                       .scale = GM_LOG,
                                       .calm_low = 1e-3,
                                       .calm_high = 10,
                                       .floor = 1e-4};
        gm_draw_graph(picture, lanes, count, &error, -1, false);
    }
}

static const char *const schemes[] = {"multiplier-lobatto4", "control-gauss4",         "uniform-gauss4",
                                      "multiplier-lobatto2", "multiplier-trapezoidal", "multiplier-adaptive4",
                                      "control-gauss2",      "control-lobatto2",       "control-lobatto4",
                                      "control-radau3",      "control-radau5",         "uniform-gauss2",
                                      "uniform-lobatto2",    "uniform-lobatto4",       NULL};

static const struct gm_figure figures[] = {
    {
        .name = "tyranowski-2",
        .statement = "the single soliton of the sine-Gordon equation",
        .arguments = "scheme=multiplier-lobatto4 points=63 until=0 show=field",
    },
    {
        .name = "tyranowski-3",
        .statement = "the two-soliton solution",
        .arguments = "scheme=multiplier-lobatto4 solitons=2 points=63 until=0 show=field",
    },
    {
        .name = "tyranowski-4",
        .statement =
            "17 mesh points capture the soliton with the multiplier strategy; it bounces at 13.84 and 41.52",
        .arguments = "scheme=multiplier-lobatto4 points=15 until=50",
    },
    {
        .name = "tyranowski-5",
        .statement = "the multiplier strategy with 31 nodes",
        .arguments = "scheme=multiplier-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-6",
        .statement = "the control-theoretic strategy with 22 nodes",
        .arguments = "scheme=control-gauss4,control-lobatto4 points=22 until=50",
    },
    {
        .name = "tyranowski-7",
        .statement = "the control-theoretic strategy with 31 nodes",
        .arguments = "scheme=control-gauss4,control-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-8",
        .statement = "mesh points of the multiplier strategy, 22 and 31 of them",
        .arguments = "points=22,31 scheme=multiplier-lobatto4 until=50 show=mesh",
    },
    {
        .name = "tyranowski-9",
        .statement = "mesh points of the control-theoretic strategy, 22 and 31 of them",
        .arguments = "points=22,31 scheme=control-gauss4 until=50 show=mesh",
    },
    {
        .name = "tyranowski-10",
        .statement = "31 nodes that stand still do not resolve the soliton",
        .arguments = "scheme=uniform-gauss4 points=31 until=50",
    },
    {
        .name = "tyranowski-11",
        .statement =
            "the multiplier strategy is more accurate than the control-theoretic one, and both than a uniform mesh",
        .arguments = "scheme=multiplier-lobatto4,control-gauss4,uniform-gauss4 points=15,31,63,127 until=50 "
                     "show=convergence",
    },
    {
        .name = "tyranowski-12",
        .statement =
            "the multiplier solution gets ahead of the exact one, the control-theoretic solution lags behind",
        .arguments =
            "scheme=multiplier-lobatto4,control-gauss4 solitons=2 points=25 alpha=1.5 dt=0.05 until=100 "
            "show=field",
    },
    {
        .name = "tyranowski-13",
        .statement =
            "the multiplier strategy keeps the energy, but for spikes at the bounces; order 4 better than 2",
        .arguments = "scheme=multiplier-lobatto2,multiplier-lobatto4 solitons=2 points=25 alpha=1.5 dt=0.05 "
                     "until=300 show=energy",
    },
    {
        .name = "tyranowski-14",
        .statement = "with the control-theoretic strategy the energy wanders, symplectic or not",
        .arguments =
            "scheme=control-gauss4,control-lobatto4,control-radau5 solitons=2 points=25 alpha=1.5 dt=0.05 "
            "until=300 show=energy",
    },
};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

const struct gm_scene gm_scene_soliton = {
    .name = "soliton",
    .title = "Mesh points that follow a soliton",
    .blurb =
        "The sine-Gordon equation between two walls, on linear elements whose nodes move so that the arclength "
        "of the field is equidistributed, with variational integrators for field and mesh.",
    .watch =
        "Watch the energy: the multiplier strategy keeps it, with the control-theoretic one it wanders, although "
        "both meshes follow the soliton equally well.",
    .size = sizeof(struct soliton),
    .parameters = parameters,
    .parameter_count = COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = COUNT(observables),
    .tracks = tracks,
    .track_count = COUNT(tracks),
    .figures = figures,
    .figure_count = COUNT(figures),
    .resolve = resolve,
    .setup = setup,
    .start_with = start_with,
    .draw = draw,
};
