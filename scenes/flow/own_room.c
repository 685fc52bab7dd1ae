/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of one's own, from files: the scene that is made of one. Lengths, times and concentrations are in the
   file's units. */
#include "scenes/flow/own_room.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/larger.h"
#include "scenes/flow/flows.h"

/* What an observable of a room looks at. */
struct subject {
    size_t number; /* of the line, or of the hole */
    double at[2];  /* of a probe */
};

enum { ROWS = 14, MOST_OBSERVED = GM_MOST_OBSERVABLES, UNIT = 96 /* bytes of one */ };

struct gm_own_room {
    struct gm_scene scene; /* first: a scene is found to be this */
    struct gm_room room;
    struct gm_flows initial;
    char *path, *word, *mesh, *mark;
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

static const struct gm_own_room *rooms_of(const void *parameters)
{
    return ((const struct gm_flows *)parameters)->room;
}

/* Powers of the units of length, time and temperature. */
struct powers {
    int of[3];
};

/* A product of powers of what the line `units:` names, "K m²/s"; "" where one of them is not named. */
static const char *name_unit(const struct gm_own_room *own, struct powers powers, char *name)
{
    static const char *const raised[] = {"", "", "²", "³", "⁴"};
    static const int order[3] = {2, 0, 1};
    char above[UNIT / 2] = "", below[UNIT / 2] = "";
    for (int i = 0; i < 3; i++) {
        const char *at = own->room.units ? own->room.units : "";
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
static const char *beside_unit(const struct gm_own_room *own, struct powers powers, char *text)
{
    char unit[UNIT];
    name_unit(own, powers, unit);
    const bool alone = !strpbrk(unit, "/ ");
    snprintf(text, UNIT + 8, "%s%s%s%s", unit[0] ? " / " : "", alone ? "" : "(", unit, alone ? "" : ")");
    return text;
}

static const struct subject *subject_of(const struct gm_view *view)
{
    const struct gm_own_room *own = rooms_of(view->parameters);
    return &own->subjects[view->observable - own->observables];
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

static bool read_mesh(const struct gm_own_room *own, const struct gm_flows *chosen,
                      struct gm_triangulation *mesh, char *sentence)
{
    return gm_flows_file(own->mesh, (enum gm_star)chosen->star, mesh, sentence);
}

/* What is wrong with the room, at its line; of its boundary as a whole, without one. Nothing where nothing is. */
static void tell(const struct gm_own_room *own, const struct gm_fault *fault, enum gm_boundary_fault boundary,
                 char *sentence)
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
    gm_text_place(own->room.text, fault->offset, &line, &column);
    gm_refuse(sentence, "%.120s:%zu:%zu: %.300s", own->path, line, column,
              whole[0] ? whole : fault->sentence);
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_own_room *own = rooms_of(parameters);
    const struct gm_flows *chosen = parameters;
    struct gm_triangulation mesh;
    struct gm_fault fault;
    enum gm_boundary_fault boundary;
    if (own->overfull) {
        return gm_refuse(sentence,
                         "a room has at most %d observables: two of an opening, three of a probe or a hole",
                         MOST_OBSERVED);
    }
    if (own->doubled) {
        return gm_refuse(sentence, "two of the room's names lead to the observable %s", own->doubled);
    }
    if (!read_mesh(own, chosen, &mesh, sentence) ||
        !gm_flows_refine(own->mesh, (enum gm_star)chosen->star, chosen->refine, &mesh, sentence)) {
        return false;
    }
    struct gm_flow *flow = gm_room_flow(&own->room, &mesh, &fault, &boundary);
    gm_triangulation_close(&mesh);
    if (!flow) {
        gm_refuse(sentence, "not enough memory");
        tell(own, &fault, boundary, sentence);
        return false;
    }
    flow->reynolds *= own->room.viscosity / chosen->viscosity;
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
    const struct gm_own_room *own = rooms_of(view->parameters);
    char sentence[GM_MESSAGE] = "";
    if (own->room.timed && view->scheme->steady) {
        gm_refuse(sentence, "what the boundary gives changes in time, and so there is no steady state");
    }
    if (!sentence[0] && view->scheme->steady && is_free(gm_flow_of(view->problem))) {
        gm_refuse(sentence,
                  "nothing holds the temperature or lets heat out, and so there is no single steady state");
    }
    for (int half = 1; half <= 2 && !sentence[0] && view->run; half++) {
        struct gm_fault fault;
        enum gm_boundary_fault boundary;
        gm_room_fault(&own->room, gm_flow_of(view->problem), view->t + view->run->dt * half / 2, &fault,
                      &boundary);
        tell(own, &fault, boundary, sentence);
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
    const struct gm_own_room *own = rooms_of(lanes[0]->parameters);
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
        .title = own->scene.title,
        .told = {{"viscosity", offsetof(struct gm_flows, viscosity),
                  gm_picture_text(picture, "%s", name_unit(own, spread, unit))},
                 {"Schmidt number", offsetof(struct gm_flows, schmidt), NULL}},
        .clock_unit = gm_picture_text(picture, "%s", name_unit(own, time, unit)),
        .axes = {gm_picture_text(picture, "x%s", beside_unit(own, length, unit)),
                 gm_picture_text(picture, "y%s", beside_unit(own, length, unit))},
        .scalar_high = high > 0 ? high : 1,
        .temperature = {warm[0], warm[1]},
        .names = {[GM_SHOW_SCALAR] = own->room.scalar},
        .vorticity_range = 6 * speed / fmax(flow->inlet_length, size / 10),
        .speed_high = 1.2 * speed,
        .sides = own->sides,
        .graphs = {flow->heat         ? "temperature_mean"
                   : own->forces[0]   ? own->forces[0]
                   : own->room.scalar ? "scalar_mean"
                                      : "scalar_total",
                   flow->heat       ? "kinetic_energy"
                   : own->forces[1] ? own->forces[1]
                                    : "scalar_outflow"},
    };
    for (size_t i = 0; i < GM_COUNT(shown); i++) {
        look.names[shown[i].show] =
            gm_picture_text(picture, "%s%s", shown[i].name, beside_unit(own, shown[i].powers, unit));
    }
    gm_flows_draw(lanes, count, picture, &look);
}

/* Adds an observable "NAME_what" of a subject, with its unit; blanks and signs in names become _. What has no room,
   or a key that is there already, is noted. */
static void observe(struct gm_own_room *own, const char *name, const char *what, const char *title,
                    struct powers powers, double (*evaluate)(const struct gm_view *view),
                    struct subject subject)
{
    const size_t i = own->observable_count;
    if (i == MOST_OBSERVED) {
        own->overfull = true;
        return;
    }
    char *key = own->observed[i][0];
    snprintf(key, sizeof own->observed[i][0], "%s_%s", name, what);
    for (char *at = key; *at; at++) {
        *at = (*at >= '0' && *at <= '9') || gm_is_letter(*at) ? *at : '_';
    }
    for (size_t k = 0; k < i; k++) {
        own->doubled = !own->doubled && strcmp(own->observables[k].key, key) == 0 ? own->observables[k].key
                                                                                  : own->doubled;
    }
    char unit[UNIT + 8];
    snprintf(own->observed[i][1], sizeof own->observed[i][1], "%s %s%s", name, title,
             beside_unit(own, powers, unit));
    own->observables[i] = (struct gm_observable){
        .key = key,
        .title = own->observed[i][1],
        .evaluate = evaluate,
        .missing = evaluate == hole_drag || evaluate == hole_lift ? "there is no force before the first step"
                   : evaluate == probe_pressure ? "there is no pressure before the first step"
                   : evaluate == wall_heat      ? "no heat has gone before the first step"
                                                : NULL};
    own->subjects[i] = subject;
    own->observable_count++;
}

/* Units of what all rooms have. */
static void name_common(struct gm_own_room *own)
{
    static const struct {
        const char *key;
        struct powers powers;
    } rows[] = {{"kinetic_energy", {{4, -2, 0}}},
                {"enstrophy", {{2, -2, 0}}},
                {"speed_max", {{1, -1, 0}}},
                {"temperature_mean", {{0, 0, 1}}}};
    char unit[UNIT + 8];
    for (size_t i = 0; i < own->observable_count; i++) {
        for (size_t k = 0; k < GM_COUNT(rows); k++) {
            struct gm_observable *observable = &own->observables[i];
            if (strcmp(observable->key, rows[k].key) == 0) {
                snprintf(own->common_titles[k], sizeof own->common_titles[k], "%.60s%.60s", observable->title,
                         beside_unit(own, rows[k].powers, unit));
                observable->title = own->common_titles[k];
            }
        }
    }
}

/* The mean of the scalar, and titles of what it has in common with all rooms where it has a name. */
static void name_scalar(struct gm_own_room *own)
{
    static const struct {
        const char *key, *title;
    } titles[] = {{"scalar_mean", "mean %s"},
                  {"scalar_total", "integral of %s"},
                  {"scalar_outflow", "outflow of %s"},
                  {"budget_defect", "defect of the budget of %s"}};
    own->observables[own->observable_count++] =
        (struct gm_observable)GM_OBSERVABLE("scalar_mean", scalar_mean, "mean concentration");
    for (size_t k = 0; k < GM_COUNT(titles) && own->room.scalar; k++) {
        for (size_t i = 0; i < own->observable_count; i++) {
            if (strcmp(own->observables[i].key, titles[k].key) == 0) {
                snprintf(own->scalar_titles[k], sizeof own->scalar_titles[k], titles[k].title,
                         own->room.scalar);
                own->observables[i].title = own->scalar_titles[k];
            }
        }
    }
}

static bool make_observables(struct gm_own_room *own, const struct gm_triangulation *mesh)
{
    double *scratch = malloc((own->room.graph.count + 1) * sizeof *scratch);
    if (!scratch) {
        return false;
    }
    static const struct gm_observable common[] = {
        GM_FLOWS_OF_ROOMS,
        GM_FLOWS_OBTUSE,
        GM_FLOWS_STAR_LEAST,
    };
    memcpy(own->observables, common, sizeof common);
    own->observable_count = GM_COUNT(common);
    const struct gm_room *room = &own->room;
    name_scalar(own);
    const bool heat = !isnan(room->buoyancy);
    if (heat) {
        own->observables[own->observable_count++] =
            (struct gm_observable)GM_OBSERVABLE("temperature_mean", temperature_mean, "mean temperature");
    }
    name_common(own);
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        struct subject subject = {.number = i + 1};
        if (line->word == GM_ROOM_INLET || line->word == GM_ROOM_OUTLET) {
            observe(own, line->name, "flow", "flow", (struct powers){{2, -1, 0}}, opening_flow, subject);
            observe(own, line->name, "scalar_flow", "flow of pollutant", (struct powers){{0, 0, 0}},
                    opening_scalar_flow, subject);
        } else if (line->word == GM_ROOM_PROBE) {
            gm_room_point(room, line, scratch, subject.at);
            observe(own, line->name, "scalar", "concentration", (struct powers){{0, 0, 0}}, probe_scalar,
                    subject);
            observe(own, line->name, "speed", "speed", (struct powers){{1, -1, 0}}, probe_speed, subject);
            observe(own, line->name, "pressure", "pressure, over the density", (struct powers){{2, -2, 0}},
                    probe_pressure, subject);
            if (heat) {
                observe(own, line->name, "temperature", "temperature", (struct powers){{0, 0, 1}},
                        probe_temperature, subject);
            }
        } else if (line->word == GM_ROOM_WALL &&
                   (line->value[GM_ROOM_TEMPERATURE].place > 0 || line->value[GM_ROOM_HEAT].place > 0)) {
            observe(own, line->name, "heat", "heat given to the air, over density and heat capacity",
                    (struct powers){{2, -1, 1}}, wall_heat, subject);
        }
    }
    free(scratch);
    bool brought = false;
    for (size_t i = 0; i < own->room.count; i++) {
        const struct gm_room_line *line = &own->room.lines[i];
        brought |= line->word == GM_ROOM_SOURCE ||
                   (line->word == GM_ROOM_INLET && line->value[GM_ROOM_SCALAR].place > 0);
    }
    const size_t first = own->observable_count;
    if (!brought && mesh->complex->loops > 1 && first + 1 < MOST_OBSERVED) {
        own->forces[0] = own->observed[first][0];
        own->forces[1] = own->observed[first + 1][0];
    }
    for (size_t hole = 1; hole < mesh->complex->loops; hole++) {
        char name[GM_ROOM_NAME];
        gm_room_hole(mesh, mesh->complex, hole, name, sizeof name);
        const struct subject subject = {.number = hole};
        observe(own, name, "drag", "force along x, over the density", (struct powers){{3, -2, 0}}, hole_drag,
                subject);
        observe(own, name, "lift", "force along y, over the density", (struct powers){{3, -2, 0}}, hole_lift,
                subject);
        observe(own, name, "circulation", "circulation", (struct powers){{2, -1, 0}}, hole_circulation,
                subject);
    }
    return true;
}

static void make_rows(struct gm_own_room *own)
{
    const struct gm_room *room = &own->room;
    const double numbers[4] = {isnan(room->dt) ? 0.01 : room->dt, isnan(room->until) ? 10 : room->until,
                               room->viscosity, room->viscosity / room->diffusivity};
    for (int i = 0; i < 4; i++) {
        gm_number_format(numbers[i], own->numbers[i], sizeof own->numbers[i]);
    }
    const struct gm_parameter rows[] = {
        GM_DT(own->numbers[0], gm_room_dt.least, gm_room_dt.most),
        GM_UNTIL(own->numbers[1]),
        GM_REAL_ROW(struct gm_flows, viscosity, "viscosity", own->numbers[2], gm_room_viscosity.least,
                    gm_room_viscosity.most, "kinematic viscosity", .logarithmic = true),
        GM_REAL_ROW(struct gm_flows, schmidt, "schmidt", own->numbers[3], gm_room_schmidt.least,
                    gm_room_schmidt.most, "Schmidt number, viscosity / diffusivity", .logarithmic = true),
        GM_FLOWS_STAR,
        GM_FLOWS_REFINE,
        GM_FLOWS_TRACERS("350"),
        GM_FLOWS_SMOKE,
        GM_FLOWS_LOOKS("scalar", "yes"),
    };
    memcpy(own->rows, rows, sizeof rows);
    for (size_t i = 0; i < GM_COUNT(rows) && !isnan(room->buoyancy); i++) {
        if (strcmp(rows[i].key, "show") == 0) {
            own->rows[i].choices = gm_flows_warm_shows;
            own->rows[i].standard = "temperature";
        }
    }
    own->scene.parameters = own->rows;
    own->scene.parameter_count = GM_COUNT(rows);
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
static bool make_mark(struct gm_own_room *own, const char *name, const struct gm_triangulation *mesh)
{
    const struct gm_complex *complex = mesh->complex;
    uint32_t sum = checksum(UINT32_C(2166136261), own->room.text, strlen(own->room.text));
    sum = checksum(sum, complex->point, 2 * complex->vertices * sizeof *complex->point);
    sum = checksum(sum, complex->triangle, 3 * complex->triangles * sizeof *complex->triangle);
    sum = checksum(sum, mesh->edge_group, complex->edges * sizeof *mesh->edge_group);
    if (asprintf(&own->mark, "%s:%08x", name, (unsigned)sum) < 0) {
        own->mark = NULL;
    }
    return own->mark != NULL;
}

/* Its words and the mesh's path. */
static bool copy_words(struct gm_own_room *own, const char *word, const char *path)
{
    const char *slash = own->room.mesh[0] == '/' ? NULL : strrchr(path, '/');
    own->path = strdup(path);
    if (asprintf(&own->mesh, "%.*s%s", slash ? (int)(slash + 1 - path) : 0, path, own->room.mesh) < 0) {
        own->mesh = NULL;
    }
    own->words[0] = own->word = strdup(word);
    return own->path && own->word && own->mesh;
}

const struct gm_scene *gm_own_room_open(struct gm_room *room, const char *name, const char *word,
                                        const char *path, char *sentence)
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
    struct gm_own_room *own = calloc(1, sizeof *own);
    struct gm_triangulation mesh;
    if (!own) {
        gm_room_close(room);
        gm_refuse(sentence, "not enough memory");
        return NULL;
    }
    own->room = *room;
    bool good = copy_words(own, word, path) || gm_refuse(sentence, "not enough memory");
    if (good && gm_flows_file(own->mesh, GM_STAR_AUTO, &mesh, sentence)) {
        good = (make_observables(own, &mesh) && make_mark(own, name, &mesh)) ||
               gm_refuse(sentence, "not enough memory");
        gm_triangulation_close(&mesh);
    } else {
        good = false;
    }
    if (!good) {
        gm_own_room_close(&own->scene);
        return NULL;
    }
    own->scene = (struct gm_scene){
        .name = name,
        .title = own->room.title ? own->room.title : "A room of one’s own",
        .blurb = own->room.about ? own->room.about : "A room of one’s own.",
        .watch = "",
        .time = "that of its units",
        .size = sizeof own->initial,
        .initial = &own->initial,
        .words = own->words,
        .room = own->room.text,
        .mark = own->mark,
        .schemes = schemes,
        .observables = own->observables,
        .observable_count = own->observable_count,
        .setup = setup,
        .readable = readable,
        .chosen = gm_flows_chosen,
        .close = gm_flows_close,
        .start = gm_flows_start,
        .draw = draw,
        .failure = tell_failure,
        .work = &work,
    };
    make_rows(own);
    for (size_t i = 0; i < own->room.count && i + 1 < GM_ROOM_SIDES; i++) {
        own->sides[i + 1] = own->room.lines[i].name;
    }
    own->initial.room = own;
    snprintf(own->initial.mesh, sizeof own->initial.mesh, "%s", own->mesh);
    return &own->scene;
}

void gm_own_room_close(const struct gm_scene *scene)
{
    struct gm_own_room *own = (struct gm_own_room *)scene; /* which it is the first member of */
    gm_room_close(&own->room);
    free(own->path);
    free(own->word);
    free(own->mesh);
    free(own->mark);
    free(own);
}
