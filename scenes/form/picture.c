/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forms as colours on their triangles: 0-forms and dual 2-forms at vertices, linear between; at triangles by
   value or density, constant on each; 1-forms by the size of their vectors, the mean at vertices, under arrows in
   the middle of triangles. */
#include <math.h>
#include <string.h>

#include "core/form/values.h"
#include "core/functions/functions.h"
#include "scenes/common/graph.h"
#include "scenes/common/system/texts.h"
#include "scenes/form/form.h"

enum { MOST_GRAPHS = 3, LEVELS = 12 };

static size_t named_count(const struct gm_system_lane *lane)
{
    return gm_form_scene_of(lane)->model.named_count;
}

bool gm_form_shows_numbers(const struct gm_system_lane *lane)
{
    return lane->numbers || (size_t)lane->grid.show == named_count(lane);
}

bool gm_form_shows_names(const struct gm_system_lane *lane)
{
    return (size_t)lane->grid.show == named_count(lane) + 1;
}

/* The number of the form that a lane shows. */
static size_t shown_number(const struct gm_system_lane *lane)
{
    return (size_t)lane->grid.show < named_count(lane) ? (size_t)lane->grid.show : 0;
}

/* A form as it is painted. */
struct painted {
    struct gm_form_type type;
    const double *form;
    double *value;  /* 3 a triangle: of its corners */
    double *vector; /* of 1-forms: 3 a triangle, in its middle */
};

/* Sizes at vertices of the mean vectors around them, at the corners of triangles. */
static void paint_sizes(struct gm_picture *picture, const struct gm_form_space *space,
                        struct painted *painted)
{
    const struct gm_complex *complex = space->complex;
    double *sum = gm_picture_memory(picture, 4 * complex->vertices * sizeof *sum);
    double *scratch = gm_picture_memory(picture, complex->edges * sizeof *scratch);
    painted->vector = gm_picture_memory(picture, 3 * complex->triangles * sizeof *painted->vector);
    gm_form_vectors(space, painted->type.dual, painted->form, scratch, painted->vector);
    memset(sum, 0, 4 * complex->vertices * sizeof *sum);
    for (size_t t = 0; t < complex->triangles; t++) {
        const double *v = painted->vector + 3 * t;
        for (size_t i = 0; i < 12; i++) {
            sum[4 * (size_t)complex->triangle[3 * t + i / 4] + i % 4] +=
                complex->area[t] * (i % 4 < 3 ? v[i % 4] : 1);
        }
    }
    for (size_t i = 0; i < 3 * complex->triangles; i++) {
        const double *s = sum + 4 * (size_t)complex->triangle[i];
        painted->value[i] = sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / s[3];
    }
}

/* The values of the form that a view shows. */
static struct painted paint(struct gm_picture *picture, const struct gm_view *view)
{
    const struct gm_form_space *space = gm_form_space_of(view->problem);
    const struct gm_complex *complex = space->complex;
    const size_t number = shown_number(view->parameters);
    const struct gm_form_type type = gm_form_scene_of(view->parameters)->model.named[number].type;
    struct painted painted = {.type = type,
                              .form = gm_form_numbers(view->problem, view->state, view->t, number),
                              .value =
                                  gm_picture_memory(picture, 3 * complex->triangles * sizeof *painted.value)};
    if (type.degree == 1) {
        paint_sizes(picture, space, &painted);
        return painted;
    }
    const bool at_vertex = (type.degree == 0) != type.dual;
    for (size_t i = 0; i < 3 * complex->triangles; i++) {
        const size_t at = at_vertex ? (size_t)complex->triangle[i] : i / 3;
        const double cell = type.degree == 0 ? 1 : at_vertex ? complex->star0[at] : complex->area[at];
        painted.value[i] = painted.form[at] / cell;
    }
    return painted;
}

/* ---- marks over the colours ---- */

/* Draws level lines of what is linear between vertices. */
static void draw_levels(const struct gm_form_sheet *sheet, const double *values, const double range[2],
                        struct gm_style style)
{
    const struct gm_form_surface surface = gm_form_surface_of(sheet, values);
    double levels[LEVELS];
    for (size_t i = 0; i < LEVELS; i++) {
        levels[i] = range[0] + ((double)i + 0.5) / LEVELS * (range[1] - range[0]);
    }
    gm_mark_level_lines(sheet->picture, sheet->panel, style, surface.points, surface.values, surface.count,
                        surface.triangles, surface.triangle_count, levels, LEVELS);
}

/* Draws the colours of a form. */
static void draw_colours(const struct gm_form_sheet *sheet, const double *corners, const double range[2])
{
    const size_t count = sheet->count;
    double *values = gm_picture_memory(sheet->picture, 3 * count * sizeof *values);
    int *triangles = gm_picture_memory(sheet->picture, 3 * count * sizeof *triangles);
    for (size_t i = 0; i < 3 * count; i++) {
        values[i] = corners[3 * sheet->triangle[i / 3] + i % 3];
        triangles[i] = (int)i;
    }
    gm_mark_mesh(sheet->picture, sheet->panel,
                 range[0] < 0 && range[1] > 0 ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL, range[0], range[1],
                 sheet->places, values, 3 * count, triangles, count)
        ->light = sheet->light;
}

/* Draws the numbers of a lane's form; of the only lane's 0-form also those of d and d d, each in its panel. */
static void draw_numbers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         const struct painted *painted, bool alone)
{
    const struct gm_system_lane *self = lane->parameters;
    const struct gm_form_space *space = gm_form_space_of(&lane->problem);
    const char *name = gm_form_scene_of(self)->shows[shown_number(self)];
    struct gm_form_type type = painted->type;
    const double *form = painted->form;
    for (bool first = true; form; first = false) {
        struct gm_form_sheet sheet;
        if (!first) {
            panel = gm_panel_add(picture, GM_PLACE_STATE, "");
        }
        gm_form_sheet_make(picture, panel, space->complex, &self->camera, lane->run->t, &sheet);
        gm_form_draw_numbers(&sheet, type, form);
        if (!alone) {
            return;
        }
        panel->title = name;
        panel->title_role = GM_INK;
        const bool more = !painted->type.dual && painted->type.degree == 0 && type.degree < 2;
        const struct gm_matrix *d = &space->matrix[type.degree == 0 ? GM_MATRIX_D0 : GM_MATRIX_D1];
        double *next = more ? gm_picture_memory(picture, space->complex->edges * sizeof *next) : NULL;
        if (more) { /* there are fewer triangles than edges */
            gm_matrix_apply(d, form, next);
        }
        form = next;
        type.degree++;
        name = gm_picture_text(picture, "d(%s)", name);
    }
}

static void draw_lane(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                      const double range[2], bool alone)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_system_lane *self = lane->parameters;
    const struct gm_complex *complex = gm_form_space_of(view.problem)->complex;
    const bool fine = gm_form_is_fine(complex);
    struct gm_form_sheet sheet;
    const struct painted painted = paint(picture, &view);
    if (gm_form_shows_numbers(self) && !fine) {
        draw_numbers(picture, panel, lane, &painted, alone);
        return;
    }
    gm_form_sheet_make(picture, panel, complex, &self->camera, lane->run->t, &sheet);
    if (gm_form_shows_names(self) && !fine) {
        (self->dual ? gm_form_draw_duals : gm_form_draw_names)(&sheet);
        return;
    }
    const bool over = !(range[0] < 0 && range[1] > 0);
    const struct gm_style style = {over ? GM_OVER : GM_INK, 0.5, 1.1, GM_SOLID};
    draw_colours(&sheet, painted.value, range);
    gm_form_draw_grid(&sheet, (struct gm_style){GM_SECONDARY, 0.8, 1, GM_SOLID}, true);
    if (self->mesh_grid) {
        gm_form_draw_grid(&sheet, (struct gm_style){style.role, 0.3, 0.8, GM_SOLID}, false);
    }
    if (self->dual) {
        /* white dashes differ from arrows, and are seen on all colours of one sign */
        gm_form_draw_dual(&sheet, (struct gm_style){over ? GM_OVER : GM_INITIAL, 0.9, 1.2,
                                                    over ? GM_SHORT_DASH : GM_SOLID});
    }
    if (self->streamlines && (painted.type.degree == 0) != painted.type.dual) {
        draw_levels(&sheet, painted.value, range, style);
    }
    if (painted.vector) {
        gm_form_draw_arrows(&sheet, (struct gm_style){GM_OVER, 0.95, 1.3, GM_SOLID}, painted.vector,
                            range[1]);
    }
    const char *name = gm_form_scene_of(self)->shows[shown_number(self)];
    panel->colour_bar = true;
    panel->colour_bar_label = painted.vector ? gm_picture_text(picture, "|%s|", name) : name;
}

static double most_of(const double range[2])
{
    return fmax(fabs(range[0]), fabs(range[1]));
}

/* Widens a range to the values of the form that a view shows. */
static void hold(struct gm_picture *picture, const struct gm_view *view, double range[2])
{
    const size_t corners = 3 * gm_form_space_of(view->problem)->complex->triangles;
    const struct painted painted = paint(picture, view);
    for (size_t k = 0; k < corners; k++) { /* NaN fails both */
        range[0] = painted.value[k] < range[0] ? painted.value[k] : range[0];
        range[1] = painted.value[k] > range[1] ? painted.value[k] : range[1];
    }
    range[0] = painted.vector ? 0 : range[0];
}

/* A lane whose values are this much larger than those of another, and of the start, has blown up or soon will:
   it does not set the colours of all. */
static const double farthest = 100;

/* Writes the least and the greatest value of all lanes, now and, so that colours stay, at the start. */
static void find_values(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        double range[2])
{
    double(*now)[2] = gm_picture_memory(picture, count * sizeof *now), least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        struct gm_view view = gm_lane_view(lanes[i]);
        now[i][0] = INFINITY;
        now[i][1] = -INFINITY;
        hold(picture, &view, now[i]);
        least = fmin(least, most_of(now[i]));
        view.state = view.start;
        view.t = view.t0;
        hold(picture, &view, range);
    }
    least = isfinite(most_of(range)) ? fmax(least, most_of(range)) : least;
    for (size_t i = 0; i < count; i++) {
        if (most_of(now[i]) <= farthest * least) {
            range[0] = fmin(range[0], now[i][0]);
            range[1] = fmax(range[1], now[i][1]);
        }
    }
}

/* The range of the colours of all lanes: round, and symmetric with both signs. */
static void find_range(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       double range[2])
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    find_values(picture, lanes, count, range);
    const double most = most_of(range);
    if (range[1] - range[0] <= 1e-12 * most || !isfinite(most)) { /* a constant */
        range[0] = isfinite(most) ? range[0] - 1 : 0;
        range[1] = range[0] + 2;
    } else if (range[0] < -0.02 * most && range[1] > 0.02 * most) {
        range[0] = -most;
        range[1] = most;
    }
    const double unit = gm_pow(10, floor(gm_log10(fmin(fmax(most, 1e-300), range[1] - range[0])))) / 5,
                 slack = 0.05;
    range[0] = unit * floor(range[0] / unit + slack);
    range[1] = unit * ceil(range[1] / unit - slack);
}

/* "162 vertices, 480 edges, 320 triangles, dual to circumcentres, Δt = 0.01" */
static const char *subtitle_of(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                               bool steady)
{
    static const char *const stars[] = {[GM_STAR_CIRCUMCENTRIC] = "circumcentres",
                                        [GM_STAR_BARYCENTRIC] = "centres of mass",
                                        [GM_STAR_INCENTRIC] = "centres of inscribed circles"};
    const struct gm_complex *complex = gm_form_space_of(&lanes[0]->problem)->complex;
    const struct gm_system_lane *self = lanes[0]->parameters;
    bool one_mesh = true, one_star = true;
    for (size_t i = 1; i < count; i++) {
        const struct gm_complex *other = gm_form_space_of(&lanes[i]->problem)->complex;
        one_mesh &= other->vertices == complex->vertices && other->triangles == complex->triangles;
        one_star &= other->star == complex->star;
    }
    const char *mesh = one_mesh ? gm_picture_text(picture, "%zu vertices, %zu edges, %zu triangles",
                                                  complex->vertices, complex->edges, complex->triangles)
                                : "Meshes of triangles";
    const char *dual =
        one_star ? gm_picture_text(picture, ", dual vertices at %s", stars[complex->star]) : "";
    const char *asked = (gm_form_shows_numbers(self) || gm_form_shows_names(self)) && gm_form_is_fine(complex)
                            ? ", too many for numbers"
                            : "";
    return gm_picture_text(picture, "%s%s%s%s", mesh, dual, asked,
                           steady ? "" : gm_shared_step(picture, lanes, count));
}

void gm_form_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_form_scene *scene = gm_form_scene_of(lanes[0]->parameters);
    const bool steady = scene->model.rates.root_count == 0;
    struct gm_graph graphs[MOST_GRAPHS];
    size_t graph_count = 0;
    double range[2];
    find_range(picture, lanes, count, range);
    picture->title = gm_system_shown_text(picture, lanes, count, GM_WORD_TITLE, scene->of_file.scene.title);
    picture->subtitle = subtitle_of(picture, lanes, count, steady);
    picture->graphs_below = true;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            struct gm_panel *panel = gm_walk_panel(picture, &walk, "");
            if (steady && count == 1) { /* no scheme made it */
                panel->title = "";
            }
            draw_lane(picture, panel, walk.lane, range, count == 1);
        }
    }
    if (steady) {
        return;
    }
    for (size_t i = 0; i < scene->of_file.observable_count && graph_count < MOST_GRAPHS; i++) {
        const struct gm_system_measure *subject = &scene->of_file.measures[i];
        const struct gm_observable *row = &scene->of_file.observables[i];
        if (subject->what != GM_FORM_FACT && subject->what != GM_FORM_CONTRADICTION &&
            strcmp(row->key, "solution_error") != 0) {
            graphs[graph_count++] = (struct gm_graph){
                .observable = row->key, .highest = true, .scale = row->logarithmic ? GM_LOG : GM_LINEAR};
        }
    }
    gm_draw_clock(picture, lanes, count);
    gm_draw_graphs(picture, lanes, count, graphs, graph_count);
}
