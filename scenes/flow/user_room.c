/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of one's own, from files: the scene that is made of one. Lengths, times and concentrations are in the
   file's units. */
#include "scenes/flow/user_room.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/basics.h"
#include "core/files/files.h"
#include "scenes/flow/flows.h"

/* What an observable of a room looks at. */
struct subject {
    size_t number; /* of the line, or of the hole */
    double at[2];  /* of a probe */
};

enum { ROWS = 14, MOST_OBSERVED = GM_MOST_OBSERVABLES, UNIT = 96 /* bytes of one */ };

struct gm_user_room {
    struct gm_scene scene; /* first: a scene is found to be this */
    struct gm_room room;
    struct gm_flows initial;
    char *path, *word, *mesh, *mark;
    const struct gm_built_in *inside; /* the mesh; NULL: it is the file at `mesh` */
    const char *words[2];
    struct gm_parameter rows[ROWS];
    char numbers[4][40];
    const char *sides[GM_ROOM_SIDES]; /* names, by the number of the side */
    struct gm_observable observables[MOST_OBSERVED];
    struct subject subjects[MOST_OBSERVED];
    bool overfull;       /* there are more */
    const char *doubled; /* a key that two of them have; NULL: none */
    char scalar_titles[4][128], common_titles[4][128];
    char observed[MOST_OBSERVED][2][2 * GM_ROOM_NAME + UNIT]; /* keys and titles */
    size_t observable_count;
    const char *forces
        [2]; /* on the first hole: what a room shows where no scalar is brought; NULL: it is, or no hole */
};

static const struct gm_user_room *rooms_of(const void *parameters)
{
    return ((const struct gm_flows *)parameters)->room;
}

/* Powers of the units of length, time and temperature. */
struct powers {
    int of[3];
};

/* A product of powers of what the line `units:` names, "K m²/s"; "" where one of them is not named. */
static const char *name_unit(const struct gm_user_room *user_room, struct powers powers, char *name)
{
    static const char *const raised[] = {"", "", "²", "³", "⁴"};
    static const int order[3] = {2, 0, 1};
    char above[UNIT / 2] = "", below[UNIT / 2] = "";
    for (int i = 0; i < 3; i++) {
        const char *at = user_room->room.units ? user_room->room.units : "";
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
    snprintf(name, UNIT, "%s%s%s", above[0] || !below[0] ? above : "1", below[0] ? "/" : "", below);
    return name;
}

/* " / (m/s)", behind what is measured in it. */
static const char *beside_unit(const struct gm_user_room *user_room, struct powers powers, char *text)
{
    char unit[UNIT];
    name_unit(user_room, powers, unit);
    const bool alone = !strpbrk(unit, "/ ");
    snprintf(text, UNIT + 8, "%s%s%s%s", unit[0] ? " / " : "", alone ? "" : "(", unit, alone ? "" : ")");
    return text;
}

static const struct subject *subject_of(const struct gm_view *view)
{
    const struct gm_user_room *user_room = rooms_of(view->parameters);
    return &user_room->subjects[view->observable - user_room->observables];
}

static double sampled(const struct gm_view *view, struct gm_sample *sample)
{
    const struct subject *subject = subject_of(view);
    return gm_flow_sample(gm_flow_of(view->problem), view->state, subject->at[0], subject->at[1], sample)
               ? 0
               : NAN;
}

static double probe_scalar(const struct gm_view *view)
{
    struct gm_sample sample = {0};
    return sampled(view, &sample) + sample.theta;
}

static double probe_temperature(const struct gm_view *view)
{
    struct gm_sample sample = {0};
    return sampled(view, &sample) + sample.temperature;
}

static double probe_speed(const struct gm_view *view)
{
    struct gm_sample sample = {0};
    return sampled(view, &sample) + hypot(sample.u, sample.v);
}

static bool has_stepped(const struct gm_view *view)
{
    return view->run && view->run->steps > 0;
}

static double probe_pressure(const struct gm_view *view)
{
    const double *at = subject_of(view)->at;
    double pressure;
    return has_stepped(view) &&
                   gm_flow_pressure_at(gm_flow_of(view->problem), view->state, at[0], at[1], &pressure)
               ? pressure
               : NAN;
}

/* Through the pieces of a side: air, or the scalar that goes with it. */
static double through(const struct gm_view *view, bool scalar)
{
    const struct gm_flow *flow = gm_flow_of(view->problem);
    const struct gm_complex *complex = flow->complex;
    const double *theta = gm_flow_block(flow, view->state, GM_FLOW_THETA);
    double sum = 0;
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        size_t e = opening->first;
        for (size_t k = 0; opening->side == subject_of(view)->number && k < opening->count; k++) {
            const size_t next = gm_complex_next(complex, e);
            const int v = complex->boundary_vertex[e], w = complex->boundary_vertex[next];
            const double out = view->state[w] - view->state[v], part = scalar ? (theta[v] + theta[w]) / 2 : 1;
            sum += (opening->inlet ? -out : out) * part;
            e = next;
        }
    }
    return sum;
}

static double opening_flow(const struct gm_view *view)
{
    return through(view, false);
}

static double opening_scalar_flow(const struct gm_view *view)
{
    return through(view, true);
}

static double wall_heat(const struct gm_view *view)
{
    return has_stepped(view) ? gm_flow_heat(gm_flow_of(view->problem), view->state, subject_of(view)->number)
                             : NAN;
}

static double temperature_mean(const struct gm_view *view)
{
    return gm_flow_temperature_mean(gm_flow_of(view->problem), view->state);
}

static double force_on(const struct gm_view *view, int component)
{
    double force[2];
    const struct gm_flow *flow = gm_flow_of(view->problem);
    return has_stepped(view) && gm_flow_force(flow, view->state, subject_of(view)->number, force)
               ? force[component]
               : NAN;
}

static double hole_drag(const struct gm_view *view)
{
    return force_on(view, 0);
}

static double hole_lift(const struct gm_view *view)
{
    return force_on(view, 1);
}

static double hole_circulation(const struct gm_view *view)
{
    return gm_flow_circulation(gm_flow_of(view->problem), view->state, subject_of(view)->number);
}

static bool read_mesh(const struct gm_user_room *user_room, const struct gm_flows *chosen,
                      struct gm_triangulation *mesh, char *sentence)
{
    return gm_flows_file(user_room->mesh, user_room->inside, (enum gm_star)chosen->star, mesh, sentence);
}

/* What is wrong with the room, at its line; of its boundary as a whole, without one. Nothing where nothing is. */
static void tell(const struct gm_user_room *user_room, const struct gm_fault *fault,
                 enum gm_boundary_fault boundary, char *sentence)
{
    size_t line = 0, column = 0;
    char whole[GM_MESSAGE] = "";
    if (!fault->sentence[0] && gm_flows_boundary(boundary, whole)) {
        return;
    }
    if (whole[0] && fault->offset == 0) {
        gm_refuse(sentence, "%s", whole);
        return;
    }
    gm_text_place(user_room->room.text, fault->offset, &line, &column);
    gm_refuse(sentence, "%.120s:%zu:%zu: %.300s", user_room->path, line, column,
              whole[0] ? whole : fault->sentence);
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_user_room *user_room = rooms_of(parameters);
    const struct gm_flows *chosen = parameters;
    struct gm_triangulation mesh;
    struct gm_fault fault;
    enum gm_boundary_fault boundary;
    if (user_room->overfull) {
        return gm_refuse(sentence,
                         "a room has at most %d observables: two of an opening, three of a probe or a hole",
                         MOST_OBSERVED);
    }
    if (user_room->doubled) {
        return gm_refuse(sentence, "two of the room's names lead to the observable %s", user_room->doubled);
    }
    if (!read_mesh(user_room, chosen, &mesh, sentence) ||
        !gm_flows_refine(user_room->mesh, (enum gm_star)chosen->star, chosen->refine, &mesh, sentence)) {
        return false;
    }
    struct gm_flow *flow = gm_room_flow(&user_room->room, &mesh, &fault, &boundary);
    gm_triangulation_close(&mesh);
    if (!flow) {
        gm_refuse(sentence, "not enough memory");
        tell(user_room, &fault, boundary, sentence);
        return false;
    }
    flow->reynolds *= user_room->room.viscosity / chosen->viscosity;
    flow->viscosity = chosen->viscosity;
    flow->diffusivity = chosen->viscosity / chosen->schmidt;
    flow->tracers = (size_t)chosen->tracers;
    flow->smoke = chosen->smoke;
    return gm_flows_problem(problem, flow, "room", sentence);
}

/* Whether heat is carried that nothing takes away. */
static bool is_free(const struct gm_flow *flow)
{
    bool held = flow->openings > 0;
    for (size_t v = 0; flow->heat && v < flow->complex->vertices && !held; v++) {
        held = flow->temperature_fixed[v];
    }
    return flow->heat && !held;
}

/* Why the boundary could give nothing in the next step, or there is no steady state. */
static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_user_room *user_room = rooms_of(view->parameters);
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
        enum gm_boundary_fault boundary;
        gm_room_fault(&user_room->room, gm_flow_of(view->problem), view->t + view->run->dt * half / 2, &fault,
                      &boundary);
        tell(user_room, &fault, boundary, sentence);
    }
    snprintf(text, size, "%s", sentence);
}

/* Over what a mesh and its halves share, the vertices of the coarser one: the distance in the mean square, relative
   to what is furthest from its own mean there. */
static double apart(const struct gm_complex *complex, const double *value, const double *finer)
{
    double mean = 0, square = 0, size = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        mean += complex->star0[v] * finer[v] / complex->total_area;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        square += complex->star0[v] * pow(value[v] - finer[v], 2);
        size += complex->star0[v] * pow(finer[v] - mean, 2);
    }
    return square > 0 ? sqrt(square / size) : 0;
}

/* The largest of those of the stream function, the scalar and the temperature. */
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
    struct gm_triangulation mesh;
    const bool good = read_mesh(rooms_of(parameters), parameters, &mesh, sentence);
    if (good) {
        gm_triangulation_close(&mesh);
    }
    return good;
}

/* About the largest that sources make of the scalar: twice what the air has when it leaves. */
static double enriched(const struct gm_flow *flow)
{
    double sum = 0, through = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        sum += flow->source[v];
    }
    for (size_t i = 0; i < flow->openings; i++) {
        through += flow->opening[i].inlet ? flow->opening[i].flow : 0;
    }
    return through > 0 ? 2 * sum / through : 0;
}

static double scalar_mean(const struct gm_view *view)
{
    const struct gm_flow *flow = gm_flow_of(view->problem);
    return gm_flow_scalar_total(flow, view->state) / flow->complex->total_area;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_user_room *user_room = rooms_of(lanes[0]->parameters);
    const struct gm_flow *flow = gm_flow_of(&lanes[0]->problem);
    static const struct {
        int show;
        const char *name;
        struct powers powers;
    } shown[] = {{GM_SHOW_VORTICITY, "vorticity ω", {{0, -1, 0}}},
                 {GM_SHOW_SPEED, "speed |u|", {{1, -1, 0}}},
                 {GM_SHOW_PRESSURE, "total pressure", {{2, -2, 0}}},
                 {GM_SHOW_TEMPERATURE, "temperature", {{0, 0, 1}}}};
    const struct powers length = {{1, 0, 0}}, time = {{0, 1, 0}}, spread = {{2, -1, 0}};
    char unit[UNIT + 8];
    const double *range = flow->temperature_range,
                 warm[2] = {range[0], range[1] > range[0] ? range[1] : range[0] + 1},
                 high = fmax(flow->theta_high, enriched(flow));
    /* what buoyancy makes of a free fall, a quarter of it: the fastest of convection in a closed room */
    const double size = sqrt(flow->complex->total_area),
                 speed = fmax(flow->speed, sqrt(fabs(flow->buoyancy) * (warm[1] - warm[0]) * size) / 4);
    struct gm_look look = {
        .title = user_room->scene.title,
        .told = {{"viscosity", offsetof(struct gm_flows, viscosity),
                  gm_picture_text(picture, "%s", name_unit(user_room, spread, unit))},
                 {"Schmidt number", offsetof(struct gm_flows, schmidt), NULL}},
        .clock_unit = gm_picture_text(picture, "%s", name_unit(user_room, time, unit)),
        .axes = {gm_picture_text(picture, "x%s", beside_unit(user_room, length, unit)),
                 gm_picture_text(picture, "y%s", beside_unit(user_room, length, unit))},
        .scalar_high = high > 0 ? high : 1,
        .temperature = {warm[0], warm[1]},
        .names = {[GM_SHOW_SCALAR] = user_room->room.scalar},
        .vorticity_range = 6 * speed / fmax(flow->inlet_length, size / 10),
        .speed_high = 1.2 * speed,
        .sides = user_room->sides,
        .graphs = {flow->heat               ? "temperature_mean"
                   : user_room->forces[0]   ? user_room->forces[0]
                   : user_room->room.scalar ? "scalar_mean"
                                            : "scalar_total",
                   flow->heat             ? "kinetic_energy"
                   : user_room->forces[1] ? user_room->forces[1]
                                          : "scalar_outflow"},
    };
    for (size_t i = 0; i < GM_COUNT(shown); i++) {
        look.names[shown[i].show] =
            gm_picture_text(picture, "%s%s", shown[i].name, beside_unit(user_room, shown[i].powers, unit));
    }
    gm_flows_draw(lanes, count, picture, &look);
}

/* Adds an observable "NAME_what" of a subject, with its unit; blanks and signs in names become _. What has no room,
   or a key that is there already, is noted. */
static void observe(struct gm_user_room *user_room, const char *name, const char *what, const char *title,
                    struct powers powers, double (*evaluate)(const struct gm_view *view),
                    struct subject subject)
{
    const size_t i = user_room->observable_count;
    if (i == MOST_OBSERVED) {
        user_room->overfull = true;
        return;
    }
    char *key = user_room->observed[i][0];
    snprintf(key, sizeof user_room->observed[i][0], "%s_%s", name, what);
    for (char *at = key; *at; at++) {
        *at = (*at >= '0' && *at <= '9') || gm_is_letter(*at) ? *at : '_';
    }
    for (size_t k = 0; k < i; k++) {
        user_room->doubled = !user_room->doubled && strcmp(user_room->observables[k].key, key) == 0
                                 ? user_room->observables[k].key
                                 : user_room->doubled;
    }
    char unit[UNIT + 8];
    snprintf(user_room->observed[i][1], sizeof user_room->observed[i][1], "%s %s%s", name, title,
             beside_unit(user_room, powers, unit));
    user_room->observables[i] = (struct gm_observable){
        .key = key,
        .title = user_room->observed[i][1],
        .evaluate = evaluate,
        .missing = evaluate == hole_drag || evaluate == hole_lift ? "there is no force before the first step"
                   : evaluate == probe_pressure ? "there is no pressure before the first step"
                   : evaluate == wall_heat      ? "no heat has gone before the first step"
                                                : NULL};
    user_room->subjects[i] = subject;
    user_room->observable_count++;
}

/* Units of what all rooms have. */
static void name_common(struct gm_user_room *user_room)
{
    static const struct {
        const char *key;
        struct powers powers;
    } rows[] = {{"kinetic_energy", {{4, -2, 0}}},
                {"enstrophy", {{2, -2, 0}}},
                {"speed_max", {{1, -1, 0}}},
                {"temperature_mean", {{0, 0, 1}}}};
    char unit[UNIT + 8];
    for (size_t i = 0; i < user_room->observable_count; i++) {
        for (size_t k = 0; k < GM_COUNT(rows); k++) {
            struct gm_observable *observable = &user_room->observables[i];
            if (strcmp(observable->key, rows[k].key) == 0) {
                snprintf(user_room->common_titles[k], sizeof user_room->common_titles[k], "%.60s%.60s",
                         observable->title, beside_unit(user_room, rows[k].powers, unit));
                observable->title = user_room->common_titles[k];
            }
        }
    }
}

/* The mean of the scalar, and titles of what it has in common with all rooms where it has a name. */
static void name_scalar(struct gm_user_room *user_room)
{
    static const struct {
        const char *key, *title;
    } titles[] = {{"scalar_mean", "mean %s"},
                  {"scalar_total", "integral of %s"},
                  {"scalar_outflow", "outflow of %s"},
                  {"budget_defect", "defect of the budget of %s"}};
    user_room->observables[user_room->observable_count++] =
        (struct gm_observable)GM_OBSERVABLE("scalar_mean", scalar_mean, "mean concentration");
    for (size_t k = 0; k < GM_COUNT(titles) && user_room->room.scalar; k++) {
        for (size_t i = 0; i < user_room->observable_count; i++) {
            if (strcmp(user_room->observables[i].key, titles[k].key) == 0) {
                snprintf(user_room->scalar_titles[k], sizeof user_room->scalar_titles[k], titles[k].title,
                         user_room->room.scalar);
                user_room->observables[i].title = user_room->scalar_titles[k];
            }
        }
    }
}

static bool make_observables(struct gm_user_room *user_room, const struct gm_triangulation *mesh)
{
    double *scratch = malloc((user_room->room.graph.count + 1) * sizeof *scratch);
    if (!scratch) {
        return false;
    }
    static const struct gm_observable common[] = {
        GM_FLOWS_OF_ROOMS,
        GM_FLOWS_OBTUSE,
        GM_FLOWS_STAR_LEAST,
    };
    memcpy(user_room->observables, common, sizeof common);
    user_room->observable_count = GM_COUNT(common);
    const struct gm_room *room = &user_room->room;
    name_scalar(user_room);
    const bool heat = !isnan(room->buoyancy);
    if (heat) {
        user_room->observables[user_room->observable_count++] =
            (struct gm_observable)GM_OBSERVABLE("temperature_mean", temperature_mean, "mean temperature");
    }
    name_common(user_room);
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        struct subject subject = {.number = i + 1};
        if (line->word == GM_ROOM_INLET || line->word == GM_ROOM_OUTLET) {
            observe(user_room, line->name, "flow", "flow", (struct powers){{2, -1, 0}}, opening_flow,
                    subject);
            observe(user_room, line->name, "scalar_flow", "flow of pollutant", (struct powers){{0, 0, 0}},
                    opening_scalar_flow, subject);
        } else if (line->word == GM_ROOM_PROBE) {
            gm_room_point(room, line, scratch, subject.at);
            observe(user_room, line->name, "scalar", "concentration", (struct powers){{0, 0, 0}},
                    probe_scalar, subject);
            observe(user_room, line->name, "speed", "speed", (struct powers){{1, -1, 0}}, probe_speed,
                    subject);
            observe(user_room, line->name, "pressure", "pressure, over the density",
                    (struct powers){{2, -2, 0}}, probe_pressure, subject);
            if (heat) {
                observe(user_room, line->name, "temperature", "temperature", (struct powers){{0, 0, 1}},
                        probe_temperature, subject);
            }
        } else if (line->word == GM_ROOM_WALL &&
                   (line->value[GM_ROOM_TEMPERATURE].place > 0 || line->value[GM_ROOM_HEAT].place > 0)) {
            observe(user_room, line->name, "heat", "heat given to the air, over density and heat capacity",
                    (struct powers){{2, -1, 1}}, wall_heat, subject);
        }
    }
    free(scratch);
    bool brought = false;
    for (size_t i = 0; i < user_room->room.count; i++) {
        const struct gm_room_line *line = &user_room->room.lines[i];
        brought |= line->word == GM_ROOM_SOURCE ||
                   (line->word == GM_ROOM_INLET && line->value[GM_ROOM_SCALAR].place > 0);
    }
    const size_t first = user_room->observable_count;
    if (!brought && mesh->complex->loops > 1 && first + 1 < MOST_OBSERVED) {
        user_room->forces[0] = user_room->observed[first][0];
        user_room->forces[1] = user_room->observed[first + 1][0];
    }
    for (size_t hole = 1; hole < mesh->complex->loops; hole++) {
        char name[GM_ROOM_NAME];
        gm_room_hole(mesh, mesh->complex, hole, name, sizeof name);
        const struct subject subject = {.number = hole};
        observe(user_room, name, "drag", "force along x, over the density", (struct powers){{3, -2, 0}},
                hole_drag, subject);
        observe(user_room, name, "lift", "force along y, over the density", (struct powers){{3, -2, 0}},
                hole_lift, subject);
        observe(user_room, name, "circulation", "circulation", (struct powers){{2, -1, 0}}, hole_circulation,
                subject);
    }
    return true;
}

static void make_rows(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    const double numbers[4] = {isnan(room->dt) ? 0.01 : room->dt, isnan(room->until) ? 10 : room->until,
                               room->viscosity, room->viscosity / room->diffusivity};
    for (int i = 0; i < 4; i++) {
        gm_number_format(numbers[i], user_room->numbers[i], sizeof user_room->numbers[i]);
    }
    const struct gm_parameter rows[] = {
        GM_DT(user_room->numbers[0], gm_room_dt.least, gm_room_dt.most),
        GM_UNTIL(user_room->numbers[1]),
        GM_REAL_ROW(struct gm_flows, viscosity, "viscosity", user_room->numbers[2], gm_room_viscosity.least,
                    gm_room_viscosity.most, "kinematic viscosity", .logarithmic = true),
        GM_REAL_ROW(struct gm_flows, schmidt, "schmidt", user_room->numbers[3], gm_room_schmidt.least,
                    gm_room_schmidt.most, "Schmidt number, viscosity / diffusivity", .logarithmic = true),
        GM_FLOWS_STAR,
        GM_FLOWS_REFINE,
        GM_FLOWS_TRACERS("350"),
        GM_FLOWS_SMOKE,
        GM_FLOWS_LOOKS("scalar", "yes"),
    };
    memcpy(user_room->rows, rows, sizeof rows);
    for (size_t i = 0; i < GM_COUNT(rows) && !isnan(room->buoyancy); i++) {
        if (strcmp(rows[i].key, "show") == 0) {
            user_room->rows[i].choices = gm_flows_warm_shows;
            user_room->rows[i].standard = "temperature";
        }
    }
    user_room->scene.parameters = user_room->rows;
    user_room->scene.parameter_count = GM_COUNT(rows);
}

/* FNV-1a of more bytes. */
static uint32_t checksum(uint32_t sum, const void *bytes, size_t size)
{
    for (const unsigned char *at = bytes, *end = at + size; at < end; at++) {
        sum = (sum ^ *at) * UINT32_C(16777619);
    }
    return sum;
}

/* The room's name with a checksum of its text and of the mesh, in which another room with the same name differs. */
static bool make_mark(struct gm_user_room *user_room, const char *name, const struct gm_triangulation *mesh)
{
    const struct gm_complex *complex = mesh->complex;
    uint32_t sum = checksum(UINT32_C(2166136261), user_room->room.text, strlen(user_room->room.text));
    sum = checksum(sum, complex->point, 2 * complex->vertices * sizeof *complex->point);
    sum = checksum(sum, complex->triangle, 3 * complex->triangles * sizeof *complex->triangle);
    sum = checksum(sum, mesh->edge_group, complex->edges * sizeof *mesh->edge_group);
    if (asprintf(&user_room->mark, "%s:%08x", name, (unsigned)sum) < 0) {
        user_room->mark = NULL;
    }
    return user_room->mark != NULL;
}

/* Its words and where the mesh is. */
static bool copy_words(struct gm_user_room *user_room, const char *word, const char *path, bool built_in)
{
    const char *slash = user_room->room.mesh[0] == '/' ? NULL : strrchr(path, '/');
    user_room->path = strdup(path);
    if (asprintf(&user_room->mesh, "%.*s%s", slash ? (int)(slash + 1 - path) : 0, path,
                 user_room->room.mesh) < 0) {
        user_room->mesh = NULL;
    }
    if (built_in || (user_room->mesh && access(user_room->mesh, F_OK) != 0)) {
        user_room->inside = gm_built_in_find(GM_FILE_MESH, user_room->room.mesh);
    }
    user_room->words[0] = user_room->word = strdup(word);
    return user_room->path && user_room->word && user_room->mesh;
}

const struct gm_scene *gm_user_room_open(struct gm_room *room, const char *name, const char *word,
                                         const char *path, bool built_in, char *sentence)
{
    static const char *const schemes[] = {"semi-implicit", NULL}, *const compared[] = {"semi-implicit",
                                                                                       "crank-nicolson",
                                                                                       NULL};
    static const double parts[] = {1, 2}, accuracies[] = {1e-1, 3e-2, 1e-2};
    static const struct gm_work work = {
        .arguments = "tracers=0",
        .halvings = 3,
        .schemes = compared,
        .reference = "crank-nicolson",
        .resolution = "refine",
        .resolutions = parts,
        .resolution_count = GM_COUNT(parts),
        .errors = accuracies,
        .distance = distance,
        .distance_title = "largest relative distance of stream function, scalar and temperature",
    };
    struct gm_user_room *user_room = calloc(1, sizeof *user_room);
    struct gm_triangulation mesh;
    if (!user_room) {
        gm_room_close(room);
        gm_refuse(sentence, "not enough memory");
        return NULL;
    }
    user_room->room = *room;
    bool good = copy_words(user_room, word, path, built_in) || gm_refuse(sentence, "not enough memory");
    if (good && gm_flows_file(user_room->mesh, user_room->inside, GM_STAR_AUTO, &mesh, sentence)) {
        good = (make_observables(user_room, &mesh) && make_mark(user_room, name, &mesh)) ||
               gm_refuse(sentence, "not enough memory");
        gm_triangulation_close(&mesh);
    } else {
        good = false;
    }
    if (!good) {
        gm_user_room_close(&user_room->scene);
        return NULL;
    }
    user_room->scene = (struct gm_scene){
        .name = name,
        .title = user_room->room.title ? user_room->room.title : "A room of one’s own",
        .blurb = user_room->room.about ? user_room->room.about : "A room of one’s own.",
        .watch = "",
        .time = "that of its units",
        .size = sizeof user_room->initial,
        .initial = &user_room->initial,
        .words = user_room->words,
        .room = user_room->room.text,
        .mark = user_room->mark,
        .schemes = schemes,
        .observables = user_room->observables,
        .observable_count = user_room->observable_count,
        .setup = setup,
        .readable = readable,
        .chosen = gm_flows_chosen,
        .note = gm_flows_note,
        .close = gm_flows_close,
        .start = gm_flows_start,
        .draw = draw,
        .failure = tell_failure,
        .work = &work,
    };
    make_rows(user_room);
    for (size_t i = 0; i < user_room->room.count && i + 1 < GM_ROOM_SIDES; i++) {
        user_room->sides[i + 1] = user_room->room.lines[i].name;
    }
    user_room->initial.room = user_room;
    snprintf(user_room->initial.mesh, sizeof user_room->initial.mesh, "%s", user_room->mesh);
    return &user_room->scene;
}

void gm_user_room_close(const struct gm_scene *scene)
{
    struct gm_user_room *user_room = (struct gm_user_room *)scene; /* which it is the first member of */
    gm_room_close(&user_room->room);
    free(user_room->path);
    free(user_room->word);
    free(user_room->mesh);
    free(user_room->mark);
    free(user_room);
}
