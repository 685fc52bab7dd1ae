/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms from files: the scene of such a room, and its mesh. Lengths, times and concentrations are in the file's units. */
#include "scenes/flow/room_scene.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/files/files.h"
#include "core/functions/functions.h"
#include "core/linear/cholesky.h"
#include "core/model/system.h"
#include "render/files/regular_file.h"
#include "scenes/common/system/pieces.h"

/* Writes what is wrong with a mesh. Returns false. */
static bool explain(const char *name, const struct gm_triangulation_fault *fault, char *sentence)
{
    char text[GM_TRIANGULATION_SENTENCE];
    return gm_refuse(sentence, "%s", gm_triangulation_explain(name, fault, text));
}

/* Makes the mesh of a rectangle; `strips` 0: the best number. Returns false with a sentence on failure. */
static bool lay_rectangle(struct gm_rectangle rectangle, struct gm_triangulation *mesh, char *sentence)
{
    enum { MOST = 10000000 };
    const long best =
        gm_rectangle_strips(rectangle.width, rectangle.height, rectangle.edges, rectangle.transposed);
    rectangle.strips = rectangle.strips == 0 ? best : rectangle.strips;
    if ((double)rectangle.edges * (double)rectangle.strips > MOST) {
        return gm_refuse(sentence, "%ld edges and %ld strips make more than %d triangles", rectangle.edges,
                         rectangle.strips, 2 * MOST);
    }
    if (rectangle.strips % 2 != 0) {
        return gm_refuse(sentence, "the number of strips of triangles must be even; %ld is a good one", best);
    }
    if (!gm_rectangle_is_acute(&rectangle)) {
        return gm_refuse(
            sentence,
            "%ld edges and %ld strips do not make acute triangles: the height of a strip must lie between half an "
            "edge and an edge; %ld strips are best",
            rectangle.edges, rectangle.strips, best);
    }
    struct gm_triangulation_fault fault;
    mesh->complex = gm_rectangle_open(&rectangle, &fault);
    return mesh->complex || explain("the mesh", &fault, sentence);
}

/* Reads the mesh of a file, or a built-in one if `inside` is not NULL. */
static bool read_file(const char *path, const struct gm_built_in *inside, enum gm_star star,
                      struct gm_triangulation *mesh, char *sentence)
{
    enum { LARGEST = 1 << 29 };
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    char *text = inside ? NULL : gm_regular_read(path, LARGEST, &size, reason);
    if (!text && !inside) {
        return gm_refuse(sentence, "%.130s could not be read: %s", path, reason);
    }
    struct gm_triangulation_fault fault;
    const bool read = gm_triangulation_read(inside ? inside->text : text, inside ? inside->length : size,
                                            star, mesh, &fault);
    free(text);
    return read || explain(path, &fault, sentence);
}

/* Cuts each edge of the mesh of a file into `parts`, a power of two. */
static bool refine(const char *path, enum gm_star star, long parts, struct gm_triangulation *mesh,
                   char *sentence)
{
    enum { MOST_TRIANGLES = 5000000 };
    struct gm_triangulation_fault fault;
    if ((parts & (parts - 1)) != 0) {
        return gm_refuse(sentence, "refine=%ld: edges are halved, and halved again: 1, 2, 4 ...", parts);
    }
    if ((double)mesh->complex->triangles * (double)parts * (double)parts > MOST_TRIANGLES) {
        return gm_refuse(sentence, "refine=%ld makes more than %d triangles of the %zu of %.100s", parts,
                         MOST_TRIANGLES, mesh->complex->triangles, path);
    }
    for (; parts > 1; parts /= 2) {
        if (!gm_triangulation_halve(mesh, star, &fault)) {
            return explain(path, &fault, sentence);
        }
    }
    return true;
}

/* Returns true if the mesh is the room's rectangle, with no file named instead. */
static bool has_rectangle(const struct gm_flows *flows)
{
    return flows->room->room.rectangular && strcmp(flows->mesh, "none") == 0;
}

/* Reads or makes the mesh of a lane; without a room, as it is in its file. On failure returns false with a
   sentence that names the line or triangle. */
static bool open_mesh(const struct gm_flows *flows, const struct gm_room *room, struct gm_triangulation *mesh,
                      char *sentence)
{
    const struct gm_user_room *user_room = flows->room;
    const enum gm_star star = (enum gm_star)flows->star;
    *mesh = (struct gm_triangulation){0};
    if (room && has_rectangle(flows)) {
        return lay_rectangle(room->rectangle, mesh, sentence);
    }
    const char *path = user_room->room.rectangular ? flows->mesh : user_room->mesh;
    if (!read_file(path, user_room->inside, star, mesh, sentence)) {
        return false;
    }
    if (room && flows->refine > 1 && !refine(path, star, flows->refine, mesh, sentence)) {
        gm_triangulation_close(mesh);
        return false;
    }
    return true;
}

/* The observables of an opening, a probe, a wall and a hole. */
enum local { FLOW, SCALAR_FLOW, SCALAR, SPEED, PRESSURE, TEMPERATURE, HEAT, DRAG, LIFT, CIRCULATION, LOCALS };

/* Returns the flow through the pieces of a side: of air, or of the scalar in it. */
static double through(const struct gm_view *view, size_t side, bool scalar)
{
    const struct gm_flow *flow = gm_flow_of(view->problem);
    const struct gm_complex *complex = flow->complex;
    const double *theta = gm_flow_block(flow, view->state, GM_FLOW_THETA);
    double sum = 0;
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        size_t e = opening->first;
        for (size_t k = 0; opening->side == side && k < opening->count; k++) {
            const size_t next = gm_complex_next(complex, e);
            const int v = complex->boundary_vertex[e], w = complex->boundary_vertex[next];
            const double out = view->state[w] - view->state[v], part = scalar ? (theta[v] + theta[w]) / 2 : 1;
            sum += (opening->inlet ? -out : out) * part;
            e = next;
        }
    }
    return sum;
}

/* Returns the number, from 1, of the line of a lane's room that names a side, or a probe; else 0. */
static size_t find_line(const struct gm_room *room, const char *name, bool probe)
{
    for (size_t i = 0; i < room->count; i++) {
        const enum gm_room_word word = room->lines[i].word;
        if ((probe ? word == GM_ROOM_PROBE : word <= GM_ROOM_BOUNDARY) &&
            strcmp(room->lines[i].name, name) == 0) {
            return i + 1;
        }
    }
    return 0;
}

static double observe_local(const struct gm_view *view)
{
    const struct gm_room_subject *subject = gm_room_subject_of(view);
    const struct gm_room *room = gm_room_of(view->problem);
    const struct gm_flow *flow = gm_flow_of(view->problem);
    const bool stepped = view->run && view->run->steps > 0,
               probe = subject->what >= SCALAR && subject->what <= TEMPERATURE;
    const size_t number = subject->name ? find_line(room, subject->name, probe) : subject->number;
    struct gm_sample sample;
    double force[2], pressure, at[2];
    if (number == 0) {
        return NAN;
    }
    if (probe) {
        gm_room_point(room, &room->lines[number - 1], at);
    }
    switch ((enum local)subject->what) {
    case FLOW:
    case SCALAR_FLOW:
        return through(view, number, subject->what == SCALAR_FLOW);
    case SCALAR:
    case SPEED:
    case TEMPERATURE:
        if (!gm_flow_sample(flow, view->state, at[0], at[1], &sample)) {
            return NAN;
        }
        return subject->what == SCALAR  ? sample.theta
               : subject->what == SPEED ? gm_hypot(sample.u, sample.v)
                                        : sample.temperature;
    case PRESSURE:
        return stepped && gm_flow_pressure_at(flow, view->state, at[0], at[1], &pressure) ? pressure : NAN;
    case HEAT:
        return stepped ? gm_flow_heat(flow, view->state, number) : NAN;
    case DRAG:
    case LIFT:
        if (!stepped) {
            return NAN;
        }
        gm_flow_force(flow, view->state, number, force);
        return force[subject->what - DRAG];
    default:
        return gm_flow_circulation(flow, view->state, number);
    }
}

/* Writes a fault of the room with its line, if it has one; nothing without a fault. */
static void tell(const struct gm_user_room *user_room, const struct gm_fault *fault, char *sentence)
{
    size_t line = 0, column = 0;
    if (!fault->sentence[0]) {
        return;
    }
    if (fault->offset == GM_ROOM_NOWHERE || !user_room->of_file.origin.path) {
        gm_refuse(sentence, "%s", fault->sentence);
        return;
    }
    gm_text_place(user_room->room.system.source, fault->offset, &line, &column);
    gm_refuse(sentence, "%.120s:%zu:%zu: %.300s", user_room->of_file.origin.path, line, column,
              fault->sentence);
}

/* Closes a problem, also one without a flow. */
static void close_problem(struct gm_problem *problem)
{
    const struct gm_flow *flow = gm_flow_of(problem);
    problem->parameters = NULL;
    gm_room_close(flow ? (struct gm_room *)(uintptr_t)flow->given_by : NULL);
}

/* Returns the room with a lane's parameters; `outlet` names its group; the caller closes it. NULL with a
   fault, whose sentence is empty when out of memory. */
static struct gm_room *room_for(const struct gm_user_room *user_room, const struct gm_flows *chosen,
                                const char *outlet, struct gm_fault *fault)
{
    const struct gm_scene *scene = &user_room->of_file.scene;
    struct gm_system_value given[GM_ROOM_ROWS];
    char texts[GM_ROOM_ROWS][GM_TEXT_SIZE];
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        const bool is_outlet = (const char *)chosen + row->offset == chosen->outlet;
        given[i].name = row->key;
        given[i].text = is_outlet ? outlet : gm_parameter_format(row, chosen, texts[i], sizeof texts[i]);
    }
    const struct gm_user_system *system = &user_room->room.system;
    return gm_room_open(
        &(struct gm_room_input){system->source, system->length, given, scene->parameter_count}, fault);
}

/* Reads the kind and group of outlets, "soft", "dirichlet", "free", or GROUP, or GROUP:free and so on; *group:
   "outlet" unless named. Checks that the named groups fit the mesh. */
static bool choose_outlet(const struct gm_flows *chosen, const struct gm_room *room,
                          enum gm_vertex_kind *kind, char *group, char *sentence)
{
    static const enum gm_vertex_kind kinds[] = {GM_VERTEX_SOFT, GM_VERTEX_FIXED, GM_VERTEX_OPEN};
    const char *text = chosen->outlet, *colon = strrchr(text, ':'), *name = colon ? colon + 1 : text;
    size_t i = 0;
    if (!gm_room_parameter(room, "outlet")) {
        return true;
    }
    while (gm_flows_outlets[i] && strcmp(name, gm_flows_outlets[i]) != 0) {
        i++;
    }
    if (gm_flows_outlets[i]) {
        *kind = kinds[i];
    } else if (colon) {
        return gm_refuse(sentence, "outlet=%.60s: what follows the colon is none of: soft, dirichlet, free",
                         text);
    }
    snprintf(group, GM_TEXT_SIZE, "%.*s", (int)(colon ? colon - text : GM_TEXT_SIZE),
             colon || !gm_flows_outlets[i] ? text : "outlet");
    const bool names = gm_room_parameter(room, "inlet");
    if (has_rectangle(chosen) && names &&
        (strcmp(group, "outlet") != 0 || strcmp(chosen->inlet, "inlet") != 0)) {
        return gm_refuse(
            sentence,
            "inlet= and the outlet's name are for a mesh=FILE; here outlet is soft, dirichlet or free");
    }
    return names || strcmp(group, "outlet") == 0 ||
           gm_refuse(sentence, "outlet=%.60s is none of: soft, dirichlet, free", text);
}

/* Returns the flow of a lane's room; NULL with a sentence on failure. */
static struct gm_flow *open_flow(const struct gm_user_room *user_room, const struct gm_flows *chosen,
                                 struct gm_room *room, char *sentence)
{
    struct gm_triangulation mesh;
    struct gm_fault fault;
    const long edges = room->rectangle.edges, multiple = room->multiple;
    room->from_file = room->rectangular && !has_rectangle(chosen);
    if (has_rectangle(chosen) && multiple > 0 && edges % multiple != 0) {
        gm_refuse(
            sentence,
            "%s=%ld: the lips of inlet and outlet are vertices only if %s is a multiple of %ld; the nearest is %ld",
            room->edges, edges, room->edges, multiple, multiple * ((edges + multiple / 2) / multiple));
        return NULL;
    }
    if (!open_mesh(chosen, room, &mesh, sentence)) {
        return NULL;
    }
    struct gm_flow *flow = gm_room_flow(room, &mesh, &fault);
    gm_triangulation_close(&mesh);
    if (!flow) {
        gm_refuse(sentence, "not enough memory");
        tell(user_room, &fault, sentence);
        return NULL;
    }
    const struct gm_system_item *unit = gm_system_item_of(&room->system, GM_WORD_TIME, 0);
    flow->time_unit = unit ? gm_room_evaluate(room, unit->nodes[0]) : flow->time_unit;
    if (unit && !(flow->time_unit > 0 && isfinite(flow->time_unit))) {
        gm_fail(&fault, unit->place, "a unit of time is a positive number");
        tell(user_room, &fault, sentence);
        return NULL;
    }
    room->values[room->system.velocities + GM_ROOM_UNTIL] = chosen->timing.until * flow->time_unit;
    flow->tracers = (size_t)chosen->tracers;
    flow->smoke = chosen->smoke;
    return flow;
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_user_room *user_room = gm_user_room_of(parameters);
    struct gm_fault fault;
    char group[GM_TEXT_SIZE];
    enum gm_vertex_kind outlet = GM_VERTEX_SOFT;
    if (gm_cholesky_missing()) {
        return gm_refuse(sentence, "the equations of a flow are solved by SuiteSparse: %s",
                         gm_cholesky_missing());
    }
    if (!choose_outlet(parameters, &user_room->room, &outlet, group, sentence)) {
        return false;
    }
    struct gm_room *room = room_for(user_room, parameters, group, &fault);
    if (!room) {
        gm_refuse(sentence, "not enough memory");
        tell(user_room, &fault, sentence);
        return false;
    }
    room->outlet = outlet;
    const struct gm_flow *flow = open_flow(user_room, parameters, room, sentence);
    if (!flow) {
        gm_room_close(room);
        return false;
    }
    *problem = (struct gm_problem){
        .name = "room", .n = gm_flow_size(flow), .m = 1, .kind = &gm_kind_flow, .parameters = flow};
    return true;
}

/* If one of edges and strips is given, sets the other to its best value; strips 0 are always the best. */
static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    const struct gm_user_room *user_room = gm_user_room_of(self);
    struct gm_fault fault;
    struct gm_room *room = room_for(user_room, self, user_room->initial.outlet, &fault);
    const struct gm_parameter *row[] = {
        room ? gm_scene_parameter(&user_room->of_file.scene, room->edges) : NULL,
        room ? gm_scene_parameter(&user_room->of_file.scene, room->strips) : NULL};
    if (row[0] && row[1] && row[0]->type == GM_INTEGER && row[1]->type == GM_INTEGER) {
        const bool by_edges = gm_is_given(row[0]->key, keys, count),
                   by_strips = gm_is_given(row[1]->key, keys, count);
        const struct gm_rectangle *box = &room->rectangle;
        const long multiple = room->multiple;
        long *edges = (long *)((char *)self + row[0]->offset),
             *strips = (long *)((char *)self + row[1]->offset);
        if (by_edges && !by_strips && *strips > 0) {
            *strips = gm_rectangle_strips(box->width, box->height, *edges, box->transposed);
        } else if (by_strips && !by_edges && *strips > 0) {
            *edges = gm_rectangle_edges(box);
        }
        if (multiple > 0 && !by_edges) {
            *edges = (long)fmax(row[0]->lowest, (double)(multiple * ((*edges + multiple / 2) / multiple)));
        }
    }
    gm_room_close(room);
    return true; /* setup reports a wrong room */
}

static bool start(const void *parameters, const struct gm_problem *problem, const struct gm_scheme *scheme,
                  double *y, char *sentence)
{
    (void)scheme;
    const struct gm_flow *flow = gm_flow_of(problem);
    const struct gm_fault fault = {.sentence =
                                       "the boundary does not determine the stream function at the start"};
    const bool started = gm_flow_start(flow, flow->vorticity, y);
    if (!started) { /* when out of memory, the lane's sentence stays */
        tell(gm_user_room_of(parameters), &fault, sentence);
    }
    return started;
}

/* Returns true if heat is carried and nothing takes it away. */
static bool is_free(const struct gm_flow *flow)
{
    bool held = flow->openings > 0;
    for (size_t v = 0; flow->heat && v < flow->complex->vertices && !held; v++) {
        held = flow->temperature_fixed[v];
    }
    return flow->heat && !held;
}

/* Writes why the boundary is wrong in the next step, or why there is no steady state. */
static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_user_room *user_room = gm_user_room_of(view->parameters);
    char sentence[GM_MESSAGE] = "";
    if (user_room->room.timed && view->scheme->steady) {
        gm_refuse(sentence, "what the boundary gives changes in time, and so there is no steady state");
    }
    if (!sentence[0] && view->scheme->steady && is_free(gm_flow_of(view->problem))) {
        gm_refuse(sentence,
                  "nothing holds the temperature or lets heat out, and so there is no single steady state");
    }
    for (int half = 1; half <= 2 && !sentence[0] && view->run; half++) {
        struct gm_fault fault;
        gm_room_fault(gm_room_of(view->problem), gm_flow_of(view->problem),
                      view->t + view->run->dt * half / 2, &fault);
        tell(user_room, &fault, sentence);
    }
    snprintf(text, size, "%s", sentence);
}

/* Returns the distance in the mean square at the vertices of the coarser mesh, relative to the deviation from
   the mean there. */
static double apart(const struct gm_complex *complex, const double *value, const double *finer)
{
    double mean = 0, square = 0, size = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        mean += complex->star0[v] * finer[v] / complex->total_area;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        square += complex->star0[v] * gm_pow(value[v] - finer[v], 2);
        size += complex->star0[v] * gm_pow(finer[v] - mean, 2);
    }
    return square > 0 ? sqrt(square / size) : 0;
}

/* Returns the largest distance of the stream function, the scalar and the temperature. */
static double distance(const struct gm_lane *lane, const struct gm_lane *finer)
{
    const struct gm_flow *flow = gm_flow_of(&lane->problem), *reference = gm_flow_of(&finer->problem);
    const double *y = gm_run_state(lane->run), *z = gm_run_state(finer->run);
    const enum gm_flow_block blocks[] = {GM_FLOW_PSI, GM_FLOW_THETA, GM_FLOW_TEMPERATURE};
    double largest = 0;
    for (size_t i = 0; i < GM_COUNT(blocks); i++) {
        if (blocks[i] == GM_FLOW_TEMPERATURE && !flow->heat) {
            continue;
        }
        const double part =
            apart(flow->complex, gm_flow_block(flow, y, blocks[i]), gm_flow_block(reference, z, blocks[i]));
        largest = gm_larger(largest, part);
    }
    return largest;
}

static bool readable(const void *parameters, char *sentence)
{
    struct gm_triangulation mesh = {0};
    const bool opened = has_rectangle(parameters) || open_mesh(parameters, NULL, &mesh, sentence);
    gm_triangulation_close(&mesh);
    return opened;
}

/* Notes the star that was used if the choice was left to the mesh. */
static void note_star(const struct gm_problem *problem, void *parameters)
{
    struct gm_flows *flows = parameters;
    if (strcmp(flows->mesh, "none") != 0) {
        flows->star = (int)gm_flow_of(problem)->complex->star;
    }
}

/* gm_scene.note: the axes of a mesh outside the plane of x and y, and the number of repeated triangles. */
static void note_origin(const struct gm_problem *problem, const void *parameters, char *sentence)
{
    (void)parameters;
    const struct gm_complex_origin *origin = &gm_flow_of(problem)->complex->origin;
    const double *x = origin->axes[0], *y = origin->axes[1];
    size_t used = 0;
    if (x[0] != 0 || x[1] != 0 || x[2] != 0) {
        used = (size_t)snprintf(
            sentence, GM_MESSAGE,
            "the mesh lies in a plane of its own: x is its direction (%.3g, %.3g, %.3g), y is (%.3g, %.3g, %.3g)",
            x[0] + 0., x[1] + 0., x[2] + 0., y[0] + 0., y[1] + 0., y[2] + 0.);
    }
    if (origin->repeated > 0) {
        snprintf(sentence + used, GM_MESSAGE - used, "%striangles that the mesh has twice count once: %zu",
                 used > 0 ? "; " : "", origin->repeated);
    }
}

/* Returns why a parameter has no effect, with a mesh file or without; NULL if it has one. */
static const char *idle(const void *parameters, const char *key)
{
    static const char *const made[] = {"rows", "columns", "irregular", NULL}, *const named[] = {
                                                                                  "inlet", "lid", "star",
                                                                                  "refine", NULL};
    const bool from_file = strcmp(((const struct gm_flows *)parameters)->mesh, "none") != 0;
    for (const char *const *name = from_file ? made : named; *name; name++) {
        if (strcmp(key, *name) == 0) {
            return from_file ? "the mesh comes from a file" : "it is for a mesh=FILE";
        }
    }
    return NULL;
}

/* Adds observables "NAME_what" of a subject, `from` to `to`, with their units; blanks and signs in names become _. */
static void observe(struct gm_user_room *user_room, const char *name, enum local from, enum local to,
                    struct gm_room_subject subject)
{
    static const char no_force[] = "there is no force before the first step";
    static const struct {
        const char *what, *title;
        struct gm_powers powers;
        const char *missing;
    } rows[LOCALS] = {
        [FLOW] = {"flow", "flow", {{2, -1, 0}}, NULL},
        [SCALAR_FLOW] = {"scalar_flow", "flow of pollutant", {{0, 0, 0}}, NULL},
        [SCALAR] = {"scalar", "concentration", {{0, 0, 0}}, NULL},
        [SPEED] = {"speed", "speed", {{1, -1, 0}}, NULL},
        [PRESSURE] = {"pressure",
                      "pressure, over the density",
                      {{2, -2, 0}},
                      "there is no pressure before the first step"},
        [TEMPERATURE] = {"temperature", "temperature", {{0, 0, 1}}, NULL},
        [HEAT] = {"heat",
                  "heat given to the air, over density and heat capacity",
                  {{2, -1, 1}},
                  "no heat has gone before the first step"},
        [DRAG] = {"drag", "force along x, over the density", {{3, -2, 0}}, no_force},
        [LIFT] = {"lift", "force along y, over the density", {{3, -2, 0}}, no_force},
        [CIRCULATION] = {"circulation", "circulation", {{2, -1, 0}}, NULL},
    };
    for (int what = (int)from; what <= (int)to; what++) {
        char *key = gm_arena_print(user_room->of_file.arena, "%s_%s", name, rows[what].what),
             unit[GM_ROOM_UNIT + 8];
        for (char *at = key; *at; at++) {
            *at = (*at >= '0' && *at <= '9') || gm_is_letter(*at) ? *at : '_';
        }
        subject.what = what;
        gm_room_observe(
            user_room,
            (struct gm_observable){
                .key = key,
                .title = gm_arena_print(user_room->of_file.arena, "%s %s%s", name, rows[what].title,
                                        gm_room_beside_unit(user_room, rows[what].powers, unit)),
                .evaluate = observe_local,
                .missing = rows[what].missing},
            subject);
    }
}

/* Adds the common observables of all rooms from files, with a unit, or with the name of the scalar. */
static void observe_common(struct gm_user_room *user_room, bool heat)
{
    const char *scalar = user_room->room.system.texts[GM_WORD_SCALAR];
    char unit[GM_ROOM_UNIT + 8];
    for (const struct gm_room_row *row = gm_room_rows + GM_ROOM_COMMON;
         row + !heat < gm_room_rows + GM_ROOM_KINDS; row++) {
        struct gm_observable observable = row->observable;
        observable.title = row->of_scalar && scalar
                               ? gm_arena_print(user_room->of_file.arena, "%s %s", row->of_scalar, scalar)
                               : gm_arena_print(user_room->of_file.arena, "%s%s", observable.title,
                                                gm_room_beside_unit(user_room, row->powers, unit));
        gm_room_observe(user_room, observable, (struct gm_room_subject){.row = row});
    }
}

static void make_observables(struct gm_user_room *user_room, const struct gm_triangulation *mesh)
{
    gm_system_take_observables(&user_room->of_file, GM_ROOM_OBSERVED);
    const struct gm_room *room = &user_room->room;
    const bool heat = !isnan(room->buoyancy);
    bool brought = false;
    const bool all = !room->rectangular || !gm_room_said(room, GM_WORD_OBSERVE);
    if (all) {
        observe_common(user_room, heat);
    }
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        const struct gm_room_subject subject = {.name = line->name};
        brought |= line->word == GM_ROOM_SOURCE ||
                   (line->word == GM_ROOM_INLET && line->value[GM_ROOM_SCALAR].place > 0);
        if (all && (line->word == GM_ROOM_INLET || line->word == GM_ROOM_OUTLET)) {
            observe(user_room, line->name, FLOW, SCALAR_FLOW, subject);
        } else if (line->word == GM_ROOM_PROBE) {
            observe(user_room, line->name, SCALAR, heat ? TEMPERATURE : PRESSURE, subject);
        } else if (line->word == GM_ROOM_WALL &&
                   (line->value[GM_ROOM_TEMPERATURE].place > 0 || line->value[GM_ROOM_HEAT].place > 0)) {
            observe(user_room, line->name, HEAT, HEAT, subject);
        }
    }
    const size_t first = user_room->of_file.observable_count;
    for (size_t hole = 1; mesh->complex && hole < mesh->complex->loops; hole++) {
        char name[GM_ROOM_NAME];
        gm_room_hole(mesh, mesh->complex, hole, name, sizeof name);
        observe(user_room, name, DRAG, CIRCULATION, (struct gm_room_subject){.number = hole});
    }
    for (size_t k = 0; k < 2 && !brought && first + 1 < user_room->of_file.observable_count; k++) {
        user_room->forces[k] = user_room->of_file.observables[first + k].key;
    }
}

/* Returns the room's name with a checksum of its text and mesh, which distinguishes rooms of one name. */
static const char *make_mark(struct gm_user_room *user_room, const struct gm_triangulation *mesh)
{
    const struct gm_complex *complex = mesh->complex;
    uint32_t sum =
        gm_written_sum(GM_SUM_OF_NOTHING, user_room->room.system.source, user_room->room.system.length);
    if (complex) {
        sum = gm_written_sum(sum, complex->point, 2 * complex->vertices * sizeof *complex->point);
        sum = gm_written_sum(sum, complex->triangle, 3 * complex->triangles * sizeof *complex->triangle);
        for (size_t e = 0; e < complex->edges; e++) {
            const int group = gm_triangulation_first(mesh, e);
            sum = gm_written_sum(sum, &group, sizeof group);
        }
    }
    return gm_arena_print(user_room->of_file.arena, "%s:%08x", user_room->of_file.origin.name, (unsigned)sum);
}

/* Returns the time, in a scene's own unit, in which a speed of 1 passes a mean edge: the Courant number is dt
   over it. NAN if setup refuses. */
static double courant_time(const void *parameters)
{
    const struct gm_scene *scene = &gm_user_room_of(parameters)->of_file.scene;
    struct gm_problem problem = {0};
    char sentence[GM_MESSAGE];
    if (!scene->setup(parameters, &problem, sentence)) {
        return NAN;
    }
    const double time = gm_flow_of(&problem)->complex->mean_edge / gm_flow_of(&problem)->time_unit;
    scene->close(&problem);
    return time;
}

/* The Courant numbers of a map of the speed's loss. */
static const double courant_numbers[] = {0.5, 1, 2, 5, 10, 20, 50, 100};

/* The studies of a room: of a mesh from a file by finer ones, of a rectangle by its lines alone. */
static void make_studies(struct gm_user_room *user_room)
{
    static const char *const marching[] = {"semi-implicit", "crank-nicolson", NULL};
    static const double parts[] = {1, 2}, accuracies[] = {1e-1, 3e-2, 1e-2};
    struct gm_system_scene *of_file = &user_room->of_file;
    const struct gm_user_system *system = &of_file->system;
    const bool works = gm_system_item_of(system, GM_WORD_WORK, 0);
    of_file->work = (struct gm_work){.coarsest = 4 * gm_room_timing(&user_room->room, GM_WORD_DT, 0.01),
                                     .halvings = works ? 4 : 0};
    if (!works && !user_room->room.rectangular) {
        of_file->work = (struct gm_work){
            .arguments = "tracers=0",
            .halvings = 3,
            .schemes = marching,
            .reference = "crank-nicolson",
            .resolution = "refine",
            .resolutions = parts,
            .resolution_count = GM_COUNT(parts),
            .errors = accuracies,
            .distance = distance,
            .distance_title = "largest relative distance of stream function, scalar and temperature",
        };
    }
    of_file->stability = (struct gm_stability){.label = "Courant number",
                                               .unit = courant_time,
                                               .steps = courant_numbers,
                                               .step_count = GM_COUNT(courant_numbers)};
    gm_system_make_studies(of_file, &(struct gm_problem){.kind = &gm_kind_flow, .m = 1}, NULL);
    struct gm_stability *map = &of_file->stability;
    map->kept = map->kept ? map->kept : "speed_max";
    map->schemes = map->schemes ? map->schemes : marching;
    if (!of_file->scene.stability && gm_room_line(&user_room->room, GM_ROOM_EXACT)) {
        of_file->scene.no_stability =
            "its exact solution is known, and work-precision measures its steps; stability cavity maps the same schemes";
    }
}

static void make(struct gm_system_making *making)
{
    static const char *const usual[] = {"semi-implicit", NULL};
    struct gm_system_scene *of_file = making->scene;
    struct gm_user_room *user_room = (struct gm_user_room *)of_file;
    struct gm_arena *arena = of_file->arena;
    struct gm_scene *scene = &of_file->scene;
    struct gm_triangulation *mesh = gm_arena_take(arena, 1, sizeof *mesh);
    struct gm_room *room = &user_room->room;
    char sentence[GM_MESSAGE];
    gm_room_read(arena, room,
                 &(struct gm_room_input){of_file->system.source, of_file->system.length, NULL, 0},
                 making->fault);
    of_file->system = room->system; /* whose memory is the scene's, and whose graph the room's */
    of_file->system.arena = NULL;
    of_file->system.graph = (struct gm_formula){0};
    user_room->initial.room = user_room;
    user_room->initial.refine = 1;
    snprintf(user_room->initial.mesh, sizeof user_room->initial.mesh, "none");
    if (!room->rectangular) {
        user_room->mesh = gm_system_find_mesh(of_file, room->system.texts[GM_WORD_MESH], &user_room->inside);
        snprintf(user_room->initial.mesh, sizeof user_room->initial.mesh, "%s", user_room->mesh);
        gm_arena_keep(arena, mesh, gm_triangulation_close);
        making->unread = !open_mesh(&user_room->initial, NULL, mesh, sentence);
        gm_arena_check(arena, !making->unread, sentence);
    }
    gm_system_describe(of_file, (struct gm_scene){.title = "A user-defined room",
                                                  .blurb = "A user-defined room.",
                                                  .time = "the unit of the room's numbers",
                                                  .schemes = usual,
                                                  .idle = idle,
                                                  .setup = setup,
                                                  .readable = readable,
                                                  .chosen = note_star,
                                                  .note = note_origin,
                                                  .close = close_problem,
                                                  .start_with = start,
                                                  .draw = gm_room_draw,
                                                  .failure = tell_failure});
    scene->size = sizeof user_room->initial; /* a lane has parameters of its own, of one room */
    scene->initial = &user_room->initial;
    scene->variant = NULL;
    scene->settle = settle;
    make_observables(user_room, mesh);
    gm_room_take_lines(user_room);
    make_studies(user_room);
    if (scene->words) {
        scene->room = scene->source;
        scene->mark = make_mark(user_room, mesh);
        scene->source = scene->text = NULL;
    }
    gm_triangulation_close(mesh);
}

const struct gm_system_maker gm_system_rooms = {.size = sizeof(struct gm_user_room), .make = make};
