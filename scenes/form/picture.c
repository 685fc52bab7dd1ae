/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forms as colours on their triangles: 0-forms at vertices linearly, at triangles and 2-forms by density, 1-forms
   by the size of Whitney's vector at the centre of mass. A surface in space is seen by parallel light, from its
   back to its front, which is right where no triangle crosses another. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/common/graph.h"
#include "scenes/common/system/texts.h"
#include "scenes/field/field.h"
#include "scenes/form/form.h"

enum { MOST_GRAPHS = 3 };

/* The form that a lane shows. */
static const double *shown(const struct gm_view *view, struct gm_form_type *type)
{
    const struct gm_form_scene *scene = gm_form_scene_of(view->parameters);
    const struct gm_system_lane *lane = view->parameters;
    const struct gm_form_subject subject = scene->shown[lane->grid.show];
    if (subject.what == GM_FORM_ERROR) {
        const struct gm_form_declared *form = &scene->of_file.system.forms[subject.index];
        *type = (struct gm_form_type){form->degree, form->dual};
        return gm_form_of(view->problem, view->state, view->t, subject.index);
    }
    const struct gm_form_program *observed = &scene->model.observed;
    *type = observed->steps[observed->roots[subject.index]].type;
    return gm_form_observed(view->problem, view->state, view->t, subject.index);
}

/* The size of Whitney's form at the centre of mass, the sum over edges i -> j of a (g_j - g_i)/3; of a
   dual 1-form, that of its numbers over the lengths of dual edges. */
static double size_at(const struct gm_form_space *space, size_t t, const double *form, bool dual)
{
    const struct gm_complex *complex = space->complex;
    double p[9], g[3][3], v[3] = {0, 0, 0}, normal[3];
    gm_complex_corners_in_space(complex, t, p);
    for (size_t c = 0; c < 3; c++) {
        const size_t a = (c + 1) % 3, b = (c + 2) % 3;
        normal[c] = ((p[3 + a] - p[a]) * (p[6 + b] - p[b]) - (p[6 + a] - p[a]) * (p[3 + b] - p[b])) /
                    (2 * complex->area[t]);
    }
    for (size_t corner = 0; corner < 3; corner++) {
        double e[3];
        for (size_t c = 0; c < 3; c++) {
            e[c] = p[3 * ((corner + 2) % 3) + c] - p[3 * ((corner + 1) % 3) + c];
        }
        for (size_t c = 0; c < 3; c++) {
            g[corner][c] = (normal[(c + 1) % 3] * e[(c + 2) % 3] - normal[(c + 2) % 3] * e[(c + 1) % 3]) /
                           (2 * complex->area[t]);
        }
    }
    for (size_t k = 0; k < 3; k++) {
        const size_t e = (size_t)complex->triangle_edge[3 * t + k];
        const double star = complex->star1[e],
                     value = complex->triangle_sign[3 * t + k] * form[e] / (dual && star > 0 ? star : 1);
        for (size_t c = 0; c < 3; c++) {
            v[c] += value * (g[(k + 1) % 3][c] - g[k][c]) / 3;
        }
    }
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* The density of a form at a corner of a triangle. */
static double density(const struct gm_form_space *space, struct gm_form_type type, const double *form,
                      size_t corner)
{
    const struct gm_complex *complex = space->complex;
    const size_t t = corner / 3, v = (size_t)complex->triangle[corner];
    if (type.degree == 1) {
        return size_at(space, t, form, type.dual);
    }
    const bool at_vertex = (type.degree == 0) != type.dual;
    const double cell = at_vertex ? complex->star0[v] : complex->area[t];
    return form[at_vertex ? v : t] / (type.degree == 2 ? cell : 1);
}

struct placed {
    double depth;
    size_t triangle;
};

static int by_depth(const void *a, const void *b)
{
    const struct placed *p = a, *q = b;
    const int depth = (p->depth > q->depth) - (p->depth < q->depth);
    return depth ? depth : (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

/* Draws one lane's form; each triangle has its own corners. */
static void draw_form(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                      const double ends[2])
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_form_space *space = gm_form_space_of(view.problem);
    const struct gm_complex *complex = space->complex;
    const struct gm_system_lane *self = lane->parameters;
    const size_t count = complex->triangles;
    struct gm_form_type type;
    const double *form = shown(&view, &type);
    struct placed *order = gm_picture_memory(picture, count * sizeof *order);
    double *corners = gm_picture_memory(picture, 9 * count * sizeof *corners);
    double *points = gm_picture_memory(picture, 6 * count * sizeof *points);
    double *values = gm_picture_memory(picture, 3 * count * sizeof *values);
    int *triangles = gm_picture_memory(picture, 3 * count * sizeof *triangles);
    if (!order || !corners || !points || !values || !triangles) {
        return;
    }
    struct gm_space sight = {.low = {INFINITY, INFINITY, INFINITY},
                             .high = {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t t = 0; t < count; t++) {
        gm_complex_corners_in_space(complex, t, corners + 9 * t);
        for (size_t i = 0; i < 9; i++) {
            sight.low[i % 3] = fmin(sight.low[i % 3], corners[9 * t + i]);
            sight.high[i % 3] = fmax(sight.high[i % 3], corners[9 * t + i]);
        }
    }
    const bool flat = sight.low[2] == 0 && sight.high[2] == 0;
    if (flat) {
        panel->x = (struct gm_axis){.label = "x", .low = sight.low[0], .high = sight.high[0]};
        panel->y = (struct gm_axis){.label = "y", .low = sight.low[1], .high = sight.high[1]};
        panel->equal = panel->axes = true;
    } else {
        gm_space_turn(&sight, &self->camera, lane->run->t - lane->t0);
        gm_space_fit(&sight, &self->camera, 0, panel);
    }
    for (size_t t = 0; t < count; t++) {
        double place[2];
        order[t] = (struct placed){0, t};
        for (size_t k = 0; k < 3 && !flat; k++) {
            order[t].depth += gm_space_place(&sight, corners + 9 * t + 3 * k, place);
        }
    }
    qsort(order, count, sizeof *order, by_depth);
    for (size_t i = 0; i < 3 * count; i++) {
        const size_t corner = 3 * order[i / 3].triangle + i % 3;
        if (flat) {
            memcpy(points + 2 * i, corners + 3 * corner, 2 * sizeof *points);
        } else {
            gm_space_place(&sight, corners + 3 * corner, points + 2 * i);
        }
        values[i] = density(space, type, form, corner);
        triangles[i] = (int)i;
    }
    const bool signs = ends[0] < 0 && ends[1] > 0;
    const double most = fmax(fabs(ends[0]), fabs(ends[1]));
    gm_mark_mesh(picture, panel, signs ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL, signs ? -most : ends[0],
                 signs ? most : ends[1], points, values, 3 * count, triangles, count);
    panel->colour_bar = true;
    panel->colour_bar_label = gm_form_scene_of(self)->shows[self->grid.show];
}

/* The values of a lane's form, now and, so that colours stay, at the start. */
static void widen(const struct gm_lane *lane, double ends[2])
{
    for (int begin = 0; begin < 2; begin++) {
        struct gm_view view = gm_lane_view(lane);
        view.state = begin ? view.start : view.state;
        view.t = begin ? view.t0 : view.t;
        struct gm_form_type type;
        const double *form = shown(&view, &type);
        const struct gm_form_space *space = gm_form_space_of(view.problem);
        for (size_t i = 0; i < 3 * space->complex->triangles; i++) {
            gm_range_add(&ends[0], &ends[1], density(space, type, form, i));
        }
    }
}

void gm_form_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_form_scene *scene = gm_form_scene_of(lanes[0]->parameters);
    struct gm_graph graphs[MOST_GRAPHS];
    size_t graph_count = 0;
    double ends[2] = {INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        widen(lanes[i], ends);
    }
    if (!(ends[1] > ends[0])) {
        ends[0] = isfinite(ends[0]) ? ends[0] - 1 : 0;
        ends[1] = ends[0] + 2;
    }
    picture->title = gm_system_shown_text(picture, lanes, count, GM_WORD_TITLE, scene->of_file.scene.title);
    const struct gm_complex *complex = gm_form_space_of(&lanes[0]->problem)->complex;
    static const char *const stars[] = {[GM_STAR_CIRCUMCENTRIC] = "circumcentres",
                                        [GM_STAR_BARYCENTRIC] = "centres of mass",
                                        [GM_STAR_INCENTRIC] = "centres inside"};
    picture->subtitle =
        gm_picture_text(picture, "%zu vertices, %zu edges, %zu triangles, dual to %s%s", complex->vertices,
                        complex->edges, complex->triangles, stars[complex->star],
                        scene->model.rates.root_count > 0 ? gm_shared_step(picture, lanes, count) : "");
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            draw_form(picture, gm_walk_panel(picture, &walk, ""), walk.lane, ends);
        }
    }
    for (size_t i = 0; i < scene->of_file.observable_count && graph_count < MOST_GRAPHS; i++) {
        const struct gm_form_subject *subject = &scene->subjects[i];
        const struct gm_observable *row = &scene->of_file.observables[i];
        if (scene->model.rates.root_count > 0 && subject->what != GM_FORM_FACT &&
            subject->what != GM_FORM_CONTRADICTION && strcmp(row->key, "solution_error") != 0) {
            graphs[graph_count++] = (struct gm_graph){
                .observable = row->key, .highest = true, .scale = row->logarithmic ? GM_LOG : GM_LINEAR};
        }
    }
    gm_draw_clock(picture, lanes, count);
    gm_draw_graphs(picture, lanes, count, graphs, graph_count);
}
