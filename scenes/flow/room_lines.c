/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lines of a room say beside its boundary: parameters, observables, pictures and studies. Everything stands in the
   scene's arena, whose body this is called from. */
#include "scenes/flow/room_lines.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/scope.h"
#include "core/schemes.h"
#include "scenes/flow/observables.h"
#include "scenes/flow/profiles.h"

/* The text of an option; NULL: it is not given. */
static const char *option(const struct gm_statement *line, enum gm_statement_row row)
{
    const struct gm_piece *piece = gm_statement_piece(line, row);
    return piece ? piece->text : NULL;
}

/* The place at which something is not as it should be. */
__attribute__((format(printf, 3, 4))) _Noreturn static void refuse(struct gm_user_room *user_room,
                                                                   size_t place, const char *format, ...)
{
    struct gm_fault fault = {.offset = place};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(fault.sentence, sizeof fault.sentence, format, arguments);
    va_end(arguments);
    gm_room_refuse(user_room, &fault);
}

/* Words that are separated by blanks or commas, NULL behind them; NULL: there is no text. */
static const char *const *list_words(struct gm_user_room *user_room, const char *text)
{
    size_t count = 0;
    const char **list = NULL;
    for (const char *at = text; at && *(at += strspn(at, ", ")); at += strcspn(at, ", ")) {
        char *word = gm_room_format(user_room, "%.*s", (int)(strcspn(at, ", ")), at);
        list = gm_arena_resize(user_room->arena, list, count + 2, sizeof *list);
        list[count++] = word;
        list[count] = NULL;
    }
    return list;
}

/* Names of schemes; NULL: there is no text. */
static const char *const *list_schemes(struct gm_user_room *user_room, const struct gm_piece *piece)
{
    const char *const *list = list_words(user_room, piece ? piece->text : NULL);
    for (const char *const *word = list; word && *word; word++) {
        if (!gm_scheme_find(*word)) {
            refuse(user_room, piece->span.begin, "%.60s is no scheme", *word);
        }
    }
    return list;
}

static const char *observable_key(struct gm_user_room *user_room, const struct gm_piece *piece)
{
    if (gm_scene_observable(&user_room->scene, piece->text) < 0) {
        refuse(user_room, piece->span.begin, "this is no observable of the room");
    }
    return piece->text;
}

/* Whether every value of a list can be a row's. */
static bool takes(const struct gm_parameter *row, const char *values)
{
    struct gm_flows scratch;
    char value[GM_TEXT_SIZE];
    bool good = true;
    for (const char *at = values; good && *at; at += strcspn(at, ", "), at += *at == ',') {
        snprintf(value, sizeof value, "%.*s", (int)strcspn(at, ", "), at);
        good = strstr(value, "..") || gm_parameter_set(row, &scratch, value) == GM_PARSED;
        if (at[strcspn(at, ", ")] == ' ') {
            break;
        }
    }
    return good;
}

/* Words key=value of a command line, which the scene's keys take. */
static const char *arguments(struct gm_user_room *user_room, const struct gm_piece *piece)
{
    for (const char *word = piece->text; *word; word += strcspn(word, " "), word += *word == ' ') {
        const int letters = (int)strcspn(word, " ");
        const char *key = gm_room_format(user_room, "%.*s", (int)strcspn(word, "="), word);
        const struct gm_parameter *row = gm_scene_parameter(&user_room->scene, key);
        if (row ? !takes(row, word + strlen(key) + 1) : !gm_reading_reserves(key, strlen(key))) {
            refuse(user_room, piece->span.begin, "%.*s: the room has no such key, or not with that value",
                   letters, word);
        }
    }
    return piece->text;
}

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
    GM_CHOICE_ROW(struct gm_flows, show, "show", "scalar", gm_flows_shows, "what the picture shows",
                  .live = true),
    GM_BOOLEAN_ROW(struct gm_flows, streamlines, "streamlines", "yes",
                   "streamlines, as level lines of the stream function", .live = true),
    GM_BOOLEAN_ROW(struct gm_flows, arrows, "arrows", "no", "arrows of velocity", .live = true),
    GM_BOOLEAN_ROW(struct gm_flows, grid, "grid", "no", "the edges of the mesh", .live = true),
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
    struct gm_scene *scene = &user_room->scene;
    user_room->rows[scene->parameter_count] = *row;
    return &user_room->rows[scene->parameter_count++];
}

static char *format(struct gm_user_room *user_room, double value)
{
    char text[40];
    return gm_room_format(user_room, "%s", gm_number_format(value, text, sizeof text));
}

/* The usual value of a row has to be one that it can have. */
static void check_row(struct gm_user_room *user_room, const struct gm_parameter *row, size_t place)
{
    struct gm_flows scratch;
    if (gm_parameter_set(row, &scratch, row->standard) == GM_PARSED) {
        return;
    }
    if (row->type == GM_REAL || row->type == GM_INTEGER) {
        refuse(user_room, place, "%s = %.60s is no number of its range, %g .. %g", row->key, row->standard,
               row->lowest, row->highest);
    }
    refuse(user_room, place, "%s = %.60s is none of its words", row->key, row->standard);
}

static void make_rows(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    const struct gm_statement *step = gm_statement(&room->said, GM_LINE_DT, 0);
    const struct gm_piece *range = gm_statement_piece(step, GM_LINE_DT_RANGE);
    const struct gm_room_range steps = gm_statement_range(GM_LINE_DT);
    const struct gm_parameter timing[] = {
        GM_DT(format(user_room, gm_statement_value(&room->said, GM_LINE_DT, 0.01)),
              range ? range->numbers[0] : steps.least, range ? range->numbers[1] : steps.most),
        GM_UNTIL(format(user_room, gm_statement_value(&room->said, GM_LINE_UNTIL, 10)))};
    size_t own = 0, choices = 0;
    check_row(user_room, add_row(user_room, &timing[0]), step ? step->pieces[0].span.begin : 0);
    add_row(user_room, &timing[1]);
    if (!gm_room_parameter(&room->names, "viscosity") && !gm_room_parameter(&room->names, "reynolds")) {
        add_row(user_room, find_row("viscosity"))->standard = format(user_room, room->viscosity);
        if (!gm_room_parameter(&room->names, "schmidt")) {
            add_row(user_room, find_row("schmidt"))->standard =
                format(user_room, room->viscosity / room->diffusivity);
        }
    }
    for (size_t i = 0; i < room->names.count; i++) {
        const struct gm_room_parameter *parameter = &room->names.parameters[i];
        const struct gm_parameter *template = find_row(parameter->name);
        const struct gm_parameter choice =
                                      GM_CHOICE_ROW(struct gm_flows, choices[0], "", "", NULL, "a choice"),
                                  plain = GM_REAL_ROW(struct gm_flows, own[0], "", "0", -1e300, 1e300,
                                                      "a parameter");
        if (template && parameter->words[0]) {
            refuse(user_room, parameter->place, "the name %s is reserved", parameter->name);
        }
        if (!template && (parameter->words[0] ? choices : own) == GM_FLOWS_OWN) {
            refuse(user_room, parameter->place, "a room has at most %d parameters and %d choices of its own",
                   GM_FLOWS_OWN, GM_FLOWS_OWN);
        }
        struct gm_parameter *row = add_row(user_room, template              ? template
                                                      : parameter->words[0] ? &choice
                                                                            : &plain);
        row->key = parameter->name;
        if (parameter->words[0]) {
            row->choices = list_words(user_room, parameter->words);
            row->offset += sizeof(int) * choices++;
        } else if (!template) {
            row->offset += sizeof(double) * own++;
        }
        row->standard = parameter->text[0] ? parameter->text : row->standard;
        row->help = parameter->meaning[0] ? parameter->meaning : row->help;
        if (!isnan(parameter->low)) {
            row->lowest = parameter->low;
            row->highest = parameter->high;
            row->logarithmic = row->type == GM_INTEGER || row->lowest > 0;
        }
        check_row(user_room, row, parameter->place);
    }
    user_room->scene.parameters = user_room->rows;
    for (size_t i = (size_t)(find_row("star") - known); i < GM_COUNT(known); i++) {
        const bool of_file = known[i].offset == offsetof(struct gm_flows, star) ||
                             known[i].offset == offsetof(struct gm_flows, refine) ||
                             known[i].offset == offsetof(struct gm_flows, smoke);
        if (!gm_room_parameter(&room->names, known[i].key) && !(of_file && room->rectangular)) {
            struct gm_parameter *row = add_row(user_room, &known[i]);
            if (!isnan(room->buoyancy) && strcmp(row->key, "show") == 0) {
                row->choices = gm_flows_warm_shows;
                row->standard = "temperature";
            }
        }
    }
}

/* observe: KEY; title TEXT; missing TEXT; along PROFILE: a new one, or what one that there is is called */
static void observe(struct gm_user_room *user_room, const struct gm_statement *line)
{
    const char *key = line->pieces[0].text, *along = option(line, GM_LINE_OBSERVE_ALONG),
               *title = option(line, GM_LINE_OBSERVE_TITLE), *missing = option(line, GM_LINE_OBSERVE_MISSING);
    const struct gm_observable *row = gm_room_observable(key, along);
    size_t profile = 0, i = 0;
    while (along && profile < user_room->profile_count &&
           strcmp(user_room->profiles[profile].line.name, along) != 0) {
        profile++;
    }
    while (i < user_room->observable_count && strcmp(user_room->observables[i].key, key) != 0) {
        i++;
    }
    struct gm_observable *observable = &user_room->observables[i];
    if (i == user_room->observable_count) {
        if (!row || i == GM_ROOM_OBSERVED || (along && profile == user_room->profile_count)) {
            refuse(user_room, line->pieces[0].span.begin,
                   "this is nothing that is observed of a room, or of a profile that it has");
        }
        *observable = *row;
        user_room->subjects[user_room->observable_count++].number = profile;
    }
    observable->title = title ? title : observable->title;
    observable->missing = missing ? missing : observable->missing;
}

/* profile: NAME QUANTITIES; x, y; x, y; points; low .. high; label */
static void add_profile(struct gm_user_room *user_room, const struct gm_statement *line)
{
    user_room->profiles = gm_arena_resize(user_room->arena, user_room->profiles, user_room->profile_count + 1,
                                          sizeof *user_room->profiles);
    struct gm_room_profile *profile = &user_room->profiles[user_room->profile_count++];
    const char *const *words = list_words(user_room, line->pieces[0].text);
    const struct gm_piece *range = gm_statement_piece(line, GM_LINE_PROFILE_RANGE);
    *profile = (struct gm_room_profile){
        .line = {.name = words[0], .count = (size_t)gm_statement_number(line, GM_LINE_PROFILE_POINTS, 0)},
        .label = option(line, GM_LINE_PROFILE_LABEL),
        .range = {range ? range->numbers[0] : NAN, range ? range->numbers[1] : NAN}};
    memcpy(profile->line.a, gm_statement_piece(line, GM_LINE_PROFILE_FROM)->numbers, sizeof profile->line.a);
    memcpy(profile->line.b, gm_statement_piece(line, GM_LINE_PROFILE_TO)->numbers, sizeof profile->line.b);
    char *quantities = gm_arena_take(user_room->arena, strlen(line->pieces[0].text) + 1, 1);
    profile->quantities = quantities;
    for (size_t i = 1; words[i]; i++) {
        if (strcmp(words[i], "u") != 0 && strcmp(words[i], "v") != 0 && strcmp(words[i], "scalar") != 0) {
            refuse(user_room, line->pieces[0].span.begin, "a profile shows u, v or scalar, not %.60s",
                   words[i]);
        }
        quantities[i - 1] = words[i][0];
    }
}

/* table: NAME PROFILE; KEY = VALUE; place value, place value ... */
static void add_table(struct gm_user_room *user_room, const struct gm_statement *line)
{
    user_room->tables = gm_arena_resize(user_room->arena, user_room->tables, user_room->table_count + 1,
                                        sizeof *user_room->tables);
    struct gm_room_table *table = &user_room->tables[user_room->table_count++];
    const char *const *words = list_words(user_room, line->pieces[0].text);
    const struct gm_piece *condition = gm_statement_piece(line, GM_LINE_TABLE_CONDITION),
                          *points = gm_statement_piece(line, GM_LINE_TABLE_POINTS);
    *table = (struct gm_room_table){.name = words[0],
                                    .row = gm_scene_parameter(&user_room->scene, condition->text),
                                    .value = condition->numbers[0],
                                    .points = points->numbers,
                                    .count = points->count / 2};
    for (size_t i = 0; i < user_room->profile_count && words[1] && !words[2]; i++) {
        if (strcmp(user_room->profiles[i].line.name, words[1]) == 0) {
            table->profile = &user_room->profiles[i];
        }
    }
    if (!table->profile) {
        refuse(user_room, line->pieces[0].span.begin, "a table has a name and a profile that the room has");
    }
}

/* Values in braces: the first two real parameters by name, where nothing else comes before, and a remark behind mesh
   and scheme. */
static void fill_subtitle(const struct gm_user_room *user_room, const struct gm_room *room,
                          struct gm_picture *picture, struct gm_look *look)
{
    const struct gm_statement *line = gm_statement(&room->said, GM_LINE_SUBTITLE, 0);
    const char *text = room->names.text, *remark = "";
    struct gm_span rest = line ? line->pieces[0].span : (struct gm_span){0, 0};
    for (size_t i = 0; rest.begin < rest.end; i++) {
        const size_t open = gm_span_until(text, rest, "{"),
                     close = gm_span_until(text, (struct gm_span){open, rest.end}, "}"),
                     colon = gm_span_until(text, (struct gm_span){open, close}, ":");
        const struct gm_span key = {open < close ? open + 1 : open, colon};
        const struct gm_parameter *row =
            gm_scene_parameter(&user_room->scene, gm_picture_text(picture, "%.*s", (int)(key.end - key.begin),
                                                                  text + key.begin));
        struct gm_fault fault;
        double value;
        if (i < GM_COUNT(look->told) && row && row->type == GM_REAL && !remark[0]) {
            rest.begin += strspn(text + rest.begin, ", ");
            const struct gm_span name = gm_span_trimmed(text, (struct gm_span){rest.begin, open});
            look->told[i].name =
                gm_picture_text(picture, "%.*s", (int)(name.end - name.begin), text + name.begin);
            look->told[i].offset = row->offset;
            look->told[i].nonzero = colon < close;
        } else {
            remark = gm_picture_text(picture, "%s%.*s", remark, (int)(open - rest.begin), text + rest.begin);
            if (open < close && gm_room_number(&room->names, key, &value, &fault)) {
                remark = gm_picture_text(picture, "%s%.4g", remark, value);
            }
        }
        rest.begin = close < rest.end ? close + 1 : close;
    }
    look->remark = remark;
}

void gm_room_take_look(const struct gm_user_room *user_room, const struct gm_room *room,
                       struct gm_picture *picture, struct gm_look *look)
{
    static const struct gm_look_error errors[] = {{"psi_error", "ψ"},
                                                  {"theta_error", "θ"},
                                                  {"flux_error", "flux"},
                                                  {"velocity_error", "velocity"},
                                                  {"pressure_error", "total pressure"},
                                                  {NULL, NULL}};
    const struct gm_statement *time = gm_statement(&room->said, GM_LINE_TIME, 0),
                              *levels = gm_statement(&room->said, GM_LINE_LEVELS, 0),
                              *colours = gm_statement(&room->said, GM_LINE_COLOURS, 0), *graph;
    look->errors = gm_room_line(room, GM_ROOM_EXACT) ? errors : NULL;
    if (time) {
        const char *unit = option(time, GM_LINE_TIME_TEXT);
        look->clock_unit = gm_picture_text(picture, "%.*s", unit ? (int)strcspn(unit, ", ") : 0, unit);
    }
    if (gm_statement(&room->said, GM_LINE_SUBTITLE, 0)) {
        memset(look->told, 0, sizeof look->told);
        fill_subtitle(user_room, room, picture, look);
    }
    look->levels = levels ? levels->pieces[0].numbers : NULL;
    look->level_count = levels ? levels->pieces[0].count : 0;
    look->vorticity_range = gm_statement_number(colours, GM_LINE_COLOURS_VORTICITY, look->vorticity_range);
    look->speed_high = gm_statement_number(colours, GM_LINE_COLOURS_SPEED, look->speed_high);
    for (size_t i = 0; i < user_room->profile_count; i++) {
        look->profiles = user_room->profiles[i].quantities[0] ? gm_room_draw_profiles : look->profiles;
    }
    const bool graphs = gm_statement(&room->said, GM_LINE_GRAPH, 0);
    look->profiles_below = look->profiles && room->rectangular && !graphs;
    for (size_t i = 0; i < GM_COUNT(look->graphs); i++) {
        graph = gm_statement(&room->said, GM_LINE_GRAPH, i);
        const struct gm_piece *range = gm_statement_piece(graph, GM_LINE_GRAPH_RANGE);
        struct gm_room_range ends = {0, 0};
        struct gm_fault fault;
        if (graphs || look->profiles_below) {
            look->graphs[i] = graph ? gm_picture_text(picture, "%s", graph->pieces[0].text) : NULL;
        }
        if (range && gm_room_range_of(&room->names, range->span, &ends, &fault)) {
            look->graph_low[i] = ends.least;
            look->graph_high[i] = ends.most;
        }
    }
}

/* The time, in a scene's own unit, in which a speed of 1 passes a mean edge: the Courant number is dt over
   it. NAN if setup refuses. */
static double courant_time(const void *parameters)
{
    const struct gm_scene *scene = &gm_user_room_of(parameters)->scene;
    struct gm_problem problem = {0};
    char sentence[GM_MESSAGE];
    if (!scene->setup(parameters, &problem, sentence)) {
        return NAN;
    }
    const double time = gm_flow_of(&problem)->complex->mean_edge / gm_flow_of(&problem)->time_unit;
    scene->close(&problem);
    return time;
}

/* Of a map over Reynolds and Courant numbers: where schemes that march through time lose the speed. */
static const double courant_numbers[] = {0.5, 1, 2, 5, 10, 20, 50, 100};
static const char *const marching[] = {"semi-implicit", "crank-nicolson", NULL};

/* figure: NAME; WORDS; statement, work: WORDS; measure KEY; ..., stability: WORDS; KEY VALUES */
static void make_studies(struct gm_user_room *user_room)
{
    const struct gm_statements *said = &user_room->room.said;
    const struct gm_statement *work_line = gm_statement(said, GM_LINE_WORK, 0),
                              *map_line = gm_statement(said, GM_LINE_STABILITY, 0), *line;
    struct gm_scene *scene = &user_room->scene;
    struct gm_figure *figures = NULL;
    for (; (line = gm_statement(said, GM_LINE_FIGURE, scene->figure_count)); scene->figure_count++) {
        figures = gm_arena_resize(user_room->arena, figures, scene->figure_count + 1, sizeof *figures);
        figures[scene->figure_count] = (struct gm_figure){
            .name = line->pieces[0].text,
            .arguments = arguments(user_room, gm_statement_piece(line, GM_LINE_FIGURE_WORDS)),
            .statement = option(line, GM_LINE_FIGURE_STATEMENT)};
    }
    scene->figures = figures;
    if (work_line) {
        const struct gm_piece *measure = gm_statement_piece(work_line, GM_LINE_WORK_MEASURE),
                              *errors = gm_statement_piece(work_line, GM_LINE_WORK_ERRORS),
                              *resolutions = gm_statement_piece(work_line, GM_LINE_WORK_RESOLUTIONS);
        user_room->work = (struct gm_work){
            .arguments = arguments(user_room, &work_line->pieces[0]),
            .measure = measure ? observable_key(user_room, measure) : NULL,
            .coarsest = gm_statement_number(work_line, GM_LINE_WORK_COARSEST, 0),
            .halvings = (int)gm_statement_number(work_line, GM_LINE_WORK_HALVINGS, 4),
            .schemes = list_schemes(user_room, gm_statement_piece(work_line, GM_LINE_WORK_SCHEMES)),
            .errors = errors ? errors->numbers : NULL,
            .resolutions = resolutions ? resolutions->numbers : NULL,
            .resolution_count = resolutions ? resolutions->count : 0,
            .resolution = resolutions ? resolutions->text : NULL};
        if (errors && (errors->count != 3 || !(errors->numbers[0] > errors->numbers[1] &&
                                               errors->numbers[1] > errors->numbers[2]))) {
            refuse(user_room, errors->span.begin, "work: has three errors that fall");
        }
        scene->work = &user_room->work;
    }
    if (map_line) {
        const struct gm_piece *values = gm_statement_piece(map_line, GM_LINE_STABILITY_VALUES);
        user_room->stability = (struct gm_stability){.arguments = arguments(user_room, &map_line->pieces[0]),
                                                     .parameter = values->text,
                                                     .values = values->numbers,
                                                     .value_count = values->count,
                                                     .label = "Courant number",
                                                     .unit = courant_time,
                                                     .steps = courant_numbers,
                                                     .step_count = GM_COUNT(courant_numbers),
                                                     .kept = "speed_max",
                                                     .schemes = marching};
        scene->stability = &user_room->stability;
    } else if (gm_room_line(&user_room->room, GM_ROOM_EXACT)) {
        scene->no_stability =
            "its exact solution is known, and work-precision measures its steps; stability cavity maps the same schemes";
    }
}

static void check_graphs(struct gm_user_room *user_room, const struct gm_room *room)
{
    const struct gm_statement *graph;
    for (size_t i = 0; (graph = gm_statement(&room->said, GM_LINE_GRAPH, i)); i++) {
        observable_key(user_room, &graph->pieces[0]);
    }
}

void gm_room_take_lines(struct gm_user_room *user_room)
{
    const struct gm_statements *said = &user_room->room.said;
    const struct gm_statement *schemes = gm_statement(said, GM_LINE_SCHEMES, 0),
                              *lanes = gm_statement(said, GM_LINE_LANES, 0),
                              *time = gm_statement(said, GM_LINE_TIME, 0), *line;
    struct gm_scene *scene = &user_room->scene;
    make_rows(user_room);
    for (size_t i = 0; (line = gm_statement(said, GM_LINE_PROFILE, i)); i++) {
        add_profile(user_room, line);
    }
    for (size_t i = 0; (line = gm_statement(said, GM_LINE_TABLE, i)); i++) {
        add_table(user_room, line);
    }
    for (size_t i = 0; (line = gm_statement(said, GM_LINE_OBSERVE, i)); i++) {
        observe(user_room, line);
    }
    scene->observable_count = user_room->observable_count;
    check_graphs(user_room, &user_room->room);
    for (size_t i = 0; i < user_room->other_count; i++) {
        check_graphs(user_room, user_room->others[i]);
    }
    scene->watch = gm_statement_text(said, GM_LINE_WATCH) ? gm_statement_text(said, GM_LINE_WATCH) : "";
    scene->schemes = schemes ? list_schemes(user_room, &schemes->pieces[0]) : scene->schemes;
    scene->lanes = lanes ? arguments(user_room, &lanes->pieces[0]) : NULL;
    if (time) {
        const char *meaning = option(time, GM_LINE_TIME_TEXT);
        scene->time = meaning ? meaning : time->pieces[0].text;
    }
    make_studies(user_room);
    scene->profile = user_room->profile_count > 0 ? gm_room_write_profiles : NULL;
}
