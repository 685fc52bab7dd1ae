/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system of forms as a scene: its parameters and its star are keys; errors, invariants, what it observes and
   the facts of its mesh are observables. The scene is made while the program runs, and does not change
   afterwards; each lane has its own mesh. */
#include "scenes/form/form.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/schemes.h"
#include "render/files/regular_file.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/common/system/variants.h"
#include "scenes/common/written.h"

enum { DT, UNTIL };
enum { SHOW, STAR, INTERIOR, LINES, GRID, DUAL, NUMBERS, COMMON_ROWS = NUMBERS + 1 + GM_CAMERA_KEYS };

/* ---- observables ---- */

enum fact { VERTICES, EDGES, TRIANGLES, EULER, BETTI0, BETTI1, BETTI2, AREA, STAR_LEAST, OBTUSE, FACTS };

static const struct {
    const char *key, *title;
} facts[FACTS] = {
    [VERTICES] = {"vertices", "vertices of the mesh"},
    [EDGES] = {"edges", "edges of the mesh"},
    [TRIANGLES] = {"triangles", "triangles of the mesh"},
    [EULER] = {"euler", "vertices − edges + triangles"},
    [BETTI0] = {"betti0", "connected pieces"},
    [BETTI1] = {"betti1", "independent loops without an inside"},
    [BETTI2] = {"betti2", "closed pieces"},
    [AREA] = {"area", "area of the mesh"},
    [STAR_LEAST] = {"star_least", "least |dual edge| / |edge| of circumcentres"},
    [OBTUSE] = {"obtuse_share", "share of obtuse triangles"},
};

static double fact(const struct gm_complex *complex, enum fact fact)
{
    const double vertices = (double)complex->vertices, edges = (double)complex->edges,
                 triangles = (double)complex->triangles;
    const double values[FACTS] = {[VERTICES] = vertices,
                                  [EDGES] = edges,
                                  [TRIANGLES] = triangles,
                                  [EULER] = vertices - edges + triangles,
                                  [BETTI0] = (double)gm_form_betti(complex, 0),
                                  [BETTI1] = (double)gm_form_betti(complex, 1),
                                  [BETTI2] = (double)gm_form_betti(complex, 2),
                                  [AREA] = complex->total_area,
                                  [STAR_LEAST] = complex->star_least,
                                  [OBTUSE] = (double)complex->obtuse / triangles};
    return values[fact];
}

static double observe(const struct gm_view *view)
{
    const struct gm_system_measure *subject = gm_system_measure_of(view);
    double defect;
    switch (subject->what) {
    case GM_FORM_ERROR:
        return gm_form_error(view->problem, view->state, view->t, subject->index);
    case GM_FORM_CONTRADICTION:
        gm_form_balance(view->problem, view->state, view->t, subject->index, &defect);
        return defect;
    case GM_FORM_REMAINDER:
        return gm_form_balance(view->problem, view->state, view->t, subject->index, &defect);
    case GM_FORM_OBSERVED:
        return *gm_form_observed(view->problem, view->state, view->t, subject->index);
    default:
        return fact(gm_form_space_of(view->problem)->complex, (enum fact)subject->index);
    }
}

static void add(struct gm_form_scene *scene, struct gm_observable row, struct gm_form_subject subject)
{
    *gm_system_add_observable(&scene->of_file, row, GM_MOST_FORM_OBSERVABLES) =
        (struct gm_system_measure){.what = subject.what, .index = subject.index};
}

/* Adds an observable of a form, whose key and title have its name. */
static void add_of_form(struct gm_form_scene *scene, struct gm_form_subject subject)
{
    static const struct {
        const char *key, *before, *after;
    } rows[] = {[GM_FORM_ERROR] = {"error", "error of ", ""},
                [GM_FORM_CONTRADICTION] = {"defect", "what the equation of ", " cannot meet"},
                [GM_FORM_REMAINDER] = {"residual", "residual of the equation of ", ""}};
    struct gm_arena *arena = scene->of_file.arena;
    const char *name = scene->of_file.system.variables[subject.index].name;
    const char *key = gm_arena_print(arena, "%s_%s", name, rows[subject.what].key),
               *title =
                   gm_arena_print(arena, "%s%s%s", rows[subject.what].before, name, rows[subject.what].after);
    struct gm_observable row = GM_LOG_OBSERVABLE(key, observe, title);
    row.most = subject.what == GM_FORM_REMAINDER ? 1e-9 : 0; /* of a linear system that is solved */
    add(scene, row, subject);
}

static void make_observables(struct gm_form_scene *scene)
{
    struct gm_system_scene *of_file = &scene->of_file;
    struct gm_arena *arena = of_file->arena;
    const struct gm_user_system *system = &of_file->system;
    bool first = true;
    gm_system_take_observables(of_file, GM_MOST_FORM_OBSERVABLES);
    for (size_t i = 0; i < system->n; i++) {
        const struct gm_form_subject error = {GM_FORM_ERROR, i};
        if (system->forms[i].exact == GM_NO_NODE) {
            continue;
        }
        if (first) { /* its error is also that of the solution */
            add(scene,
                (struct gm_observable)GM_LOG_OBSERVABLE("solution_error", observe, "error of the solution"),
                error);
        }
        add_of_form(scene, error);
        first = false;
    }
    for (size_t i = 0; i < scene->model.observed_count; i++) {
        const struct gm_system_item *item = &system->items[scene->model.observed_item[i]];
        if (item->word == GM_WORD_LET) {
            continue;
        }
        const bool kept = item->word == GM_WORD_INVARIANT;
        struct gm_observable row =
            kept ? (struct gm_observable)GM_KEPT_OBSERVABLE(gm_arena_print(arena, "%s_error", item->name),
                                                            observe, item->name, item->name)
                 : (struct gm_observable)GM_OBSERVABLE(item->name, observe, item->name);
        gm_written_options(&row, item);
        row.least = kept ? gm_system_option_number(item, GM_OPTION_SCALE, 0) : 0;
        add(scene, row, (struct gm_form_subject){GM_FORM_OBSERVED, i});
    }
    for (size_t i = 0; i < system->n; i++) {
        if (system->forms[i].unknown && system->forms[i].degree == 0) {
            add_of_form(scene, (struct gm_form_subject){GM_FORM_CONTRADICTION, i});
        }
    }
    for (size_t i = 0; i < system->n; i++) {
        if (system->forms[i].unknown) {
            add_of_form(scene, (struct gm_form_subject){GM_FORM_REMAINDER, i});
        }
    }
    for (size_t i = 0; i < FACTS; i++) {
        add(scene, (struct gm_observable)GM_OBSERVABLE(facts[i].key, observe, facts[i].title),
            (struct gm_form_subject){GM_FORM_FACT, i});
    }
}

/* ---- keys ---- */

/* The words of show=. */
static void make_shows(struct gm_form_scene *scene)
{
    const struct gm_form_model *model = &scene->model;
    struct gm_arena *arena = scene->of_file.arena;
    gm_arena_refuse_if(arena, model->named_count == 0, "the file has no form: a line field, unknown or let");
    scene->shows = gm_arena_take(arena, model->named_count + 3, sizeof *scene->shows);
    for (size_t i = 0; i < model->named_count; i++) {
        scene->shows[i] = model->named[i].name;
    }
    scene->shows[model->named_count] = "numbers";
    scene->shows[model->named_count + 1] = "mesh";
}

static void make_rows(struct gm_form_scene *scene)
{
    struct gm_system_scene *of_file = &scene->of_file;
    const struct gm_user_system *system = &of_file->system;
    const bool steady = scene->model.rates.root_count == 0;
    const struct gm_parameter timing[GM_SYSTEM_ROWS] = {[DT] = GM_DT("", 1e-9, 1e6), [UNTIL] = GM_UNTIL("")};
    const char *const *stars = gm_system_choices(GM_WORD_STAR);
    const char *const *interiors = gm_system_choices(GM_WORD_INTERIOR);
    const struct gm_parameter common[COMMON_ROWS] = {
        GM_CHOICE_ROW(struct gm_system_lane, grid.show, "show", scene->shows[0], scene->shows,
                      "the form that is drawn; numbers of the first form, or names of a mesh, on a small one",
                      .live = true, .looks = true),
        GM_CHOICE_ROW(struct gm_system_lane, star, "star", stars[gm_system_chosen(system, GM_WORD_STAR)],
                      stars, "dual vertices: circumcentres, centres of mass or of the circles inside"),
        GM_CHOICE_ROW(
            struct gm_system_lane, interior, "interior",
            interiors[gm_system_chosen(system, GM_WORD_INTERIOR)], interiors,
            "what a flow carries: the mean of both sides, or the value of that where it comes from"),
        GM_BOOLEAN_ROW(struct gm_system_lane, streamlines, "streamlines", "no",
                       "level lines of what has a value at vertices", .live = true, .looks = true),
        GM_BOOLEAN_ROW(struct gm_system_lane, mesh_grid, "grid", "no", "edges of the mesh", .live = true,
                       .looks = true),
        GM_BOOLEAN_ROW(struct gm_system_lane, dual, "dual", "no", "dual vertices and edges", .live = true,
                       .looks = true),
        GM_BOOLEAN_ROW(struct gm_system_lane, numbers, "numbers", "no",
                       "the numbers of the form that is shown, on a small mesh", .live = true, .looks = true),
        GM_CAMERA_ROWS(struct gm_system_lane, camera)};
    double numbers[GM_SYSTEM_TIMES];
    gm_system_make_rows(of_file, timing, common, COMMON_ROWS, false);
    gm_parameters_reset(of_file->rows + GM_SYSTEM_ROWS, of_file->row_count + COMMON_ROWS - GM_SYSTEM_ROWS,
                        of_file->initial);
    gm_system_open_timing(of_file, numbers);
    const double dt = numbers[0] > 0 ? numbers[0]
                      : steady       ? 1
                                     : 0.01,
                 steps = numbers[2] >= 0 ? numbers[2]
                         : steady        ? 0
                                         : 100,
                 until = numbers[1] >= 0 ? numbers[1] : steps * dt;
    gm_written_timing(of_file->arena, system, dt, until, of_file->rows);
    gm_parameters_reset(of_file->rows, GM_SYSTEM_ROWS, of_file->initial);
}

/* ---- from parameters to problem and start ---- */

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_system_lane *lane = parameters;
    struct gm_fault fault = {0};
    double *values = gm_system_start_values(lane, NULL);
    const bool good =
        values && gm_form_problem_open(
                      problem, &gm_form_scene_of(lane)->model,
                      (struct gm_form_choice){(enum gm_star)lane->star, (enum gm_interior)lane->interior},
                      values, &fault);
    free(values);
    if (!good) {
        return gm_refuse(sentence, "%s", fault.sentence[0] ? fault.sentence : "not enough memory");
    }
    problem->name = lane->owner->scene.name;
    const struct gm_complex *complex = gm_form_space_of(problem)->complex;
    if ((gm_form_shows_numbers(lane) || gm_form_shows_names(lane)) && gm_form_is_fine(complex)) {
        gm_refuse(
            sentence,
            "numbers and names are drawn on at most %d vertices, edges and triangles, and this mesh has "
            "%zu: take a coarser one",
            GM_MOST_NUMBERS, complex->vertices + complex->edges + complex->triangles);
        gm_form_problem_close(problem);
        return false;
    }
    return true;
}

/* A mesh in the plane is not seen from a direction. */
static const char *idle(const void *parameters, const char *key)
{
    static const char *const flat[] = {"rectangle", "flat-torus", "disc", "annulus", "strip"};
    const struct gm_user_system *system = &gm_form_scene_of(parameters)->of_file.system;
    const char *mesh = gm_system_item_of(system, GM_WORD_MESH, 0)->name;
    for (size_t i = 0; i < GM_COUNT(flat) && gm_camera_has(key); i++) {
        if (strcmp(mesh, flat[i]) == 0) {
            return "the mesh is in the plane";
        }
    }
    return gm_system_idle(parameters, key);
}

static void start(const void *parameters, const struct gm_problem *problem, double *y)
{
    (void)parameters;
    gm_form_start(problem, y);
}

/* The longest step of explicit schemes is not known: rk4, or verlet where the fields split. */
static void make_schemes(struct gm_form_scene *scene, const struct gm_problem *problem)
{
    static const char *const usual[] = {"rk4", NULL}, *const splitting[] = {"verlet", "rk4", NULL};
    struct gm_system_scene *of_file = &scene->of_file;
    const size_t count =
        gm_written_schemes(of_file->arena, of_file->system.texts[GM_WORD_SCHEMES], problem, of_file->schemes);
    of_file->scene.schemes = count > 0 ? of_file->schemes : scene->model.split > 0 ? splitting : usual;
    of_file->scene.lanes = of_file->system.texts[GM_WORD_LANES];
}

/* Reads the file of the mesh. */
static void read_mesh(struct gm_form_scene *scene, bool *unread)
{
    enum { LARGEST = 1 << 29 };
    struct gm_form_model *model = &scene->model;
    struct gm_arena *arena = scene->of_file.arena;
    const struct gm_built_in *inside;
    model->mesh_name = gm_system_item_of(&scene->of_file.system, GM_WORD_MESH, 0)->name;
    const char *path = gm_system_find_mesh(&scene->of_file, model->mesh_name, &inside);
    if (inside) {
        model->mesh_text = inside->text;
        model->mesh_size = inside->length;
        return;
    }
    char reason[GM_REGULAR_REASON], *text = gm_regular_read(path, LARGEST, &model->mesh_size, reason);
    *unread = !text;
    if (!text) {
        gm_arena_refuse(arena, "mesh: %.130s could not be read: %s", model->mesh_name, reason);
    }
    model->mesh_text = gm_arena_keep(arena, text, free);
}

static void make(struct gm_system_making *making)
{
    struct gm_form_scene *scene = (struct gm_form_scene *)making->scene;
    struct gm_system_scene *of_file = making->scene;
    struct gm_arena *arena = of_file->arena;
    struct gm_user_system *system = &of_file->system;
    if (!gm_form_model_open(&scene->model, system, making->fault)) {
        gm_arena_refuse(arena, "%s",
                        making->fault->sentence[0] ? making->fault->sentence : "not enough memory");
    }
    if (gm_form_reads_mesh(system)) {
        read_mesh(scene, &making->unread);
    }
    make_shows(scene);
    make_rows(scene);
    gm_system_describe(of_file, (struct gm_scene){.title = "Forms on triangles",
                                                  .blurb = "A user-defined system of forms.",
                                                  .time = "the unit of the equations",
                                                  .idle = idle,
                                                  .setup = setup,
                                                  .close = gm_form_problem_close,
                                                  .start = start,
                                                  .draw = gm_form_draw,
                                                  .work = &of_file->work});
    gm_system_open_items(of_file);
    gm_system_open_problem(making);
    make_observables(scene);
    make_schemes(scene, &making->problem);
    /* the mesh has an error of its own, so that errors of steps are distances from a finer run */
    of_file->work = (struct gm_work){.arguments = "",
                                     .coarsest = 4 * of_file->initial->timing.dt,
                                     .halvings = 4,
                                     .schemes = of_file->scene.schemes,
                                     .reference = "rk4"};
    gm_system_make_studies(of_file, &making->problem, NULL);
}

const struct gm_system_maker gm_system_forms = {.size = sizeof(struct gm_form_scene), .make = make};
