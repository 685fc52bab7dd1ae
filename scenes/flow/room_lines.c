/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines of a room other than its boundary: parameters, observables, pictures and studies. All data is in the
   scene's arena; its body calls this. */
#include "scenes/flow/room_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/observed.h"
#include "core/memory.h"
#include "core/model/scope.h"
#include "scenes/common/written.h"

const char *const gm_flows_outlets[] = {"soft", "dirichlet", "free", NULL};
const char *const gm_flows_stars[] = {"auto", "circumcentric", "barycentric", "galerkin", NULL};

/* Checks words key=value: each has one of the scene's keys, or a word that all scenes have. */
static void check_words(const struct gm_user_room *user_room, const char *words, size_t place)
{
    for (const char *word = words; *word; word += strcspn(word, " "), word += *word == ' ') {
        const char *key = gm_arena_print(user_room->of_file.arena, "%.*s", (int)strcspn(word, "= "), word);
        gm_system_refuse_if(&user_room->room.system,
                            word[strlen(key)] != '=' ||
                                !(gm_scene_parameter(&user_room->of_file.scene, key) ||
                                  gm_reading_reserves(key, strlen(key))),
                            place, "words key=value were expected, with keys of the room: until=5");
    }
}

#define SHOWS "scalar", "vorticity", "speed", "pressure", "none", "profiles", "convergence", "divergence"
static const char *const shows[] = {SHOWS, NULL}, *const warm_shows[] = {SHOWS, "temperature", NULL};

/* The rows that a file may name; others are its own numbers. */
static const struct gm_parameter known[] = {
    GM_REAL_ROW(struct gm_flows, reynolds, "reynolds", "1", 0.01, 1e5, "Reynolds number",
                .logarithmic = true),
    GM_REAL_ROW(struct gm_flows, viscosity, "viscosity", "1", 1e-12, 1e6, "kinematic viscosity",
                .logarithmic = true),
    GM_REAL_ROW(struct gm_flows, schmidt, "schmidt", "1", 1e-6, 1e6,
                "Schmidt number, viscosity / diffusivity", .logarithmic = true),
    GM_INTEGER_ROW(struct gm_flows, rows, "rows", "0", 0, 2000, "", .logarithmic = true, .required = true),
    GM_INTEGER_ROW(struct gm_flows, columns, "columns", "0", 0, 2000, "", .logarithmic = true,
                   .required = true),
    GM_REAL_ROW(struct gm_flows, irregular, "irregular", "0", 0, 0.45,
                "random shift of the vertices, as a part of their shortest edge"),
    GM_TEXT_ROW(struct gm_flows, outlet, "outlet", "soft", "soft, dirichlet or free",
                .choices = gm_flows_outlets, .names = true),
    GM_TEXT_ROW(struct gm_flows, inlet, "inlet", "inlet", "names or tags of the inlets", .names = true),
    GM_TEXT_ROW(struct gm_flows, lid, "lid", "lid", "name or tag of the lid, with mesh= alone"),
    GM_TEXT_ROW(struct gm_flows, mesh, "mesh", "none",
                "a Gmsh file (2.2 or 4.1) of another room; none: the rectangle", .file = true),
    GM_CHOICE_ROW(
        struct gm_flows, star, "star", "auto", gm_flows_stars,
        "Hodge star of a mesh=FILE: circumcentric needs Delaunay triangles, barycentric, or galerkin, takes any"),
    GM_INTEGER_ROW(struct gm_flows, refine, "refine", "1", 1, 64,
                   "parts that each edge of a mesh=FILE is cut into: 1, 2, 4 ...", .logarithmic = true),
    GM_INTEGER_ROW(struct gm_flows, tracers, "tracers", "350", 0, 20000,
                   "particles that the flow carries along", .logarithmic = true),
    GM_BOOLEAN_ROW(struct gm_flows, smoke, "smoke", "no",
                   "tracers come in at inlets and sources, and do not fill the room at the start"),
    GM_CHOICE_ROW(struct gm_flows, show, "show", "scalar", shows, "what the picture shows", .live = true),
    GM_BOOLEAN_ROW(struct gm_flows, streamlines, "streamlines", "yes",
                   "streamlines, as level lines of the stream function", .live = true, .looks = true),
    GM_BOOLEAN_ROW(struct gm_flows, arrows, "arrows", "no", "arrows of velocity", .live = true,
                   .looks = true),
    GM_BOOLEAN_ROW(struct gm_flows, grid, "grid", "no", "the edges of the mesh", .live = true, .looks = true),
};

static const struct gm_parameter *find_row(const char *key)
{
    size_t i = 0;
    while (i < GM_COUNT(known) && strcmp(known[i].key, key) != 0) {
        i++;
    }
    return i < GM_COUNT(known) ? &known[i] : NULL;
}

static struct gm_parameter *add_row(struct gm_user_room *user_room, const struct gm_parameter *row)
{
    struct gm_scene *scene = &user_room->of_file.scene;
    user_room->of_file.rows[scene->parameter_count] = *row;
    return &user_room->of_file.rows[scene->parameter_count++];
}

/* Checks that the usual value of a row is one of its values. */
static void check_row(struct gm_user_room *user_room, const struct gm_parameter *row, size_t place)
{
    struct gm_flows scratch;
    const unsigned long refusals = gm_memory_refusals();
    const bool taken = gm_parameter_set(row, &scratch, row->standard) == GM_PARSED;
    gm_arena_need(user_room->of_file.arena, gm_memory_refusals() == refusals);
    gm_system_refuse_if(&user_room->room.system, !taken, place,
                        "the usual value lies outside of the range, or is none of the words");
}

/* Adds choices that come before a place of the file. */
static void add_choices(struct gm_user_room *user_room, size_t place, size_t *count)
{
    const struct gm_user_system *system = &user_room->room.system;
    for (; *count < system->choices.count && system->choices.list[*count].place < place; ++*count) {
        const struct gm_parameter row =
            gm_written_choice(user_room->of_file.arena, system, *count, "a choice",
                              offsetof(struct gm_flows, choices) + sizeof(int) * *count);
        gm_system_refuse_if(system, find_row(row.key), system->choices.list[*count].place,
                            "this name is reserved");
        add_row(user_room, &row);
    }
}

static void make_rows(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    const struct gm_user_system *system = &room->system;
    struct gm_parameter timing[] = {GM_DT("", gm_room_dt.least, gm_room_dt.most), GM_UNTIL("")};
    size_t own = 0, choices = 0;
    user_room->of_file.rows =
        gm_arena_take(user_room->of_file.arena, GM_ROOM_ROWS, sizeof *user_room->of_file.rows);
    gm_written_timing(user_room->of_file.arena, system, gm_room_timing(room, GM_WORD_DT, 0.01),
                      gm_room_timing(room, GM_WORD_UNTIL, 10), timing);
    add_row(user_room, &timing[0]);
    add_row(user_room, &timing[1]);
    if (!gm_room_parameter(room, "viscosity") && !gm_room_parameter(room, "reynolds")) {
        add_row(user_room, find_row("viscosity"))->standard =
            gm_written_number(user_room->of_file.arena, room->viscosity, NULL);
        if (!gm_room_parameter(room, "schmidt")) {
            add_row(user_room, find_row("schmidt"))->standard =
                gm_written_number(user_room->of_file.arena, room->viscosity / room->diffusivity, NULL);
        }
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        const struct gm_system_variable *parameter = &system->variables[i];
        const struct gm_parameter *template = find_row(parameter->name);
        const struct gm_parameter plain =
            GM_REAL_ROW(struct gm_flows, own[0], "", "0", -1e300, 1e300, "a parameter");
        gm_system_refuse_if(system, !template && own == GM_FLOWS_OWN, parameter->start_place,
                            "a room has at most 8 parameters of its own");
        add_choices(user_room, parameter->start_place, &choices);
        struct gm_parameter *row = add_row(user_room, template ? template : &plain);
        row->key = parameter->name;
        row->offset += template ? 0 : sizeof(double) * own++;
        row->standard = parameter->text[0] ? parameter->text : row->standard;
        row->help = parameter->meaning[0] ? parameter->meaning : row->help;
        if (!isnan(parameter->low)) {
            row->lowest = parameter->low;
            row->highest = parameter->high;
            row->logarithmic = row->type == GM_INTEGER || row->lowest > 0;
        }
        check_row(user_room, row, parameter->start_place);
    }
    add_choices(user_room, SIZE_MAX, &choices);
    user_room->of_file.scene.parameters = user_room->of_file.rows;
    for (size_t i = (size_t)(find_row("star") - known); i < GM_COUNT(known); i++) {
        const bool of_file = known[i].offset == offsetof(struct gm_flows, star) ||
                             known[i].offset == offsetof(struct gm_flows, refine) ||
                             known[i].offset == offsetof(struct gm_flows, smoke);
        if (!gm_room_parameter(room, known[i].key) && !(of_file && room->rectangular)) {
            struct gm_parameter *row = add_row(user_room, &known[i]);
            if (!isnan(room->buoyancy) && strcmp(row->key, "show") == 0) {
                row->choices = warm_shows;
                row->standard = "temperature";
            }
        }
    }
}

static void check_tables(const struct gm_user_room *user_room)
{
    const struct gm_user_system *system = &user_room->room.system;
    const struct gm_system_item *table;
    for (size_t i = 0; (table = gm_system_item_of(system, GM_WORD_TABLE, i)); i++) {
        gm_system_refuse_if(system,
                            !gm_system_item_named(system, GM_WORD_PROFILE, table->words) ||
                                !gm_scene_parameter(&user_room->of_file.scene, table->text),
                            table->place,
                            "a table has a name and a profile, the value of a parameter, and points");
    }
}

/* The value of a formula; the subject has its number. */
static double observed(const struct gm_view *view)
{
    return gm_flow_observed(gm_room_of(view->problem)->forms, view->state,
                            view->t * gm_flow_of(view->problem)->time_unit, gm_room_subject_of(view)->number);
}

/* observe: KEY; title TEXT; missing TEXT; along PROFILE: a new observable, or a new title of one; or a formula, with their
   count so far */
static void observe(struct gm_user_room *user_room, const struct gm_system_item *item, size_t *formulas)
{
    const char *along = gm_system_option_text(item, GM_OPTION_ALONG, NULL);
    const struct gm_system_item *profile =
        along ? gm_system_item_named(&user_room->room.system, GM_WORD_PROFILE, along) : NULL;
    struct gm_system_scene *of_file = &user_room->of_file;
    size_t kind = 0;
    while (kind < GM_ROOM_KINDS && (strcmp(gm_room_rows[kind].observable.key, item->name) != 0 ||
                                    gm_room_rows[kind].along != (along != NULL))) {
        kind++;
    }
    int i = gm_scene_observable(&of_file->scene, item->name);
    if (item->count > 0) {
        const struct gm_observable row = GM_OBSERVABLE(item->name, observed, item->name);
        gm_system_refuse_if(&user_room->room.system, i >= 0, item->place, "%s is observed already",
                            item->name);
        i = (int)of_file->observable_count;
        gm_room_observe(user_room, row, (struct gm_room_subject){.number = (*formulas)++});
    } else if (i < 0) {
        gm_system_refuse_if(&user_room->room.system, kind == GM_ROOM_KINDS || (along && !profile),
                            item->place,
                            "this is nothing that is observed of a room, or of a profile that it has");
        i = (int)of_file->observable_count;
        gm_room_observe(user_room, gm_room_rows[kind].observable,
                        (struct gm_room_subject){.row = &gm_room_rows[kind], .profile = profile});
    }
    gm_written_options(&of_file->observables[i], item);
}

void gm_room_take_lines(struct gm_user_room *user_room)
{
    static const enum gm_system_word worded[] = {GM_WORD_WORK, GM_WORD_STABILITY, GM_WORD_FIGURE};
    const struct gm_user_system *system = &user_room->room.system;
    const struct gm_read_line *lanes = gm_room_said(&user_room->room, GM_WORD_LANES);
    struct gm_system_scene *of_file = &user_room->of_file;
    struct gm_scene *scene = &of_file->scene;
    const struct gm_system_item *item;
    size_t formulas = 0;
    make_rows(user_room);
    check_tables(user_room);
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_OBSERVE, i)); i++) {
        observe(user_room, item, &formulas);
    }
    if (gm_written_schemes(of_file->arena, system->texts[GM_WORD_SCHEMES],
                           &(struct gm_problem){.kind = &gm_kind_flow, .m = 1}, of_file->schemes) > 0) {
        scene->schemes = of_file->schemes;
    }
    if (lanes) {
        scene->lanes = system->texts[GM_WORD_LANES];
        check_words(user_room, scene->lanes, lanes->value.begin);
    }
    for (size_t k = 0; k < GM_COUNT(worded); k++) {
        for (size_t i = 0; (item = gm_system_item_of(system, worded[k], i)); i++) {
            check_words(user_room, item->words, item->place);
        }
    }
    scene->profile = gm_room_said(&user_room->room, GM_WORD_PROFILE) ? gm_room_write_profiles : NULL;
}
