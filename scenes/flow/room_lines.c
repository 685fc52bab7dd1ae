/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines of a room other than its boundary: parameters, observables, pictures and studies. All data is in the
   scene's arena; its body calls this. */
#include "scenes/flow/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/flow.h"
#include "core/model/scope.h"
#include "core/schemes.h"
#include "scenes/common/written.h"

/* Returns the text of the only line that begins so; NULL without such a line. */
static const char *said(const struct gm_room *room, const char *word)
{
    struct gm_span value;
    return gm_room_said(room, word, 0, &value) ? gm_room_keep(room, value) : NULL;
}

/* Returns the text of an option; NULL if it is not given. */
static const char *option(const struct gm_room *room, struct gm_span pieces, const char *word)
{
    struct gm_span value;
    return gm_room_option(room, pieces, word, &value) ? gm_room_keep(room, value) : NULL;
}

static const char *take(const struct gm_room *room, struct gm_span *rest, const char *separator)
{
    struct gm_span piece;
    gm_span_take(room->text, rest, separator, &piece);
    return gm_room_keep(room, piece);
}

static double number(const struct gm_room *room, struct gm_span span)
{
    double value;
    gm_room_need(room, gm_room_number(room, span, &value, room->fault));
    return value;
}

/* Returns numbers separated by commas: the numbers of an option, or all if `word` is NULL. */
static double *numbers(const struct gm_room *room, struct gm_span pieces, const char *word, size_t *count)
{
    struct gm_span rest = pieces, piece;
    double *list = NULL;
    *count = 0;
    while ((!word || *count > 0 || gm_room_option(room, pieces, word, &rest)) &&
           gm_span_take(room->text, &rest, ",", &piece)) {
        list = gm_arena_resize(room->arena, list, *count + 1, sizeof *list);
        list[(*count)++] = number(room, piece);
    }
    return list;
}

static double option_number(const struct gm_room *room, struct gm_span pieces, const char *word,
                            double otherwise)
{
    size_t count;
    const double *list = numbers(room, pieces, word, &count);
    return count > 0 ? list[0] : otherwise;
}

/* Returns words separated by blanks or commas, NULL-terminated; NULL for an empty text. */
static const char *const *list_words(const struct gm_room *room, const char *text)
{
    size_t count = 0;
    const char **list = NULL;
    for (const char *at = text; at && *(at += strspn(at, ", ")); at += strcspn(at, ", ")) {
        char *word = gm_arena_print(room->arena, "%.*s", (int)(strcspn(at, ", ")), at);
        list = gm_arena_resize(room->arena, list, count + 2, sizeof *list);
        list[count++] = word;
        list[count] = NULL;
    }
    return list;
}

/* Returns the schemes of a list, which must be schemes for flows. */
static const char *const *list_schemes(const struct gm_room *room, struct gm_span text)
{
    const char *const *names = list_words(room, gm_room_keep(room, text));
    for (size_t i = 0; names && names[i]; i++) {
        const struct gm_scheme *scheme = gm_scheme_find(names[i]);
        if (!scheme || scheme->family->kind != &gm_kind_flow) {
            gm_room_refuse(room, text.begin, "%s is not a scheme of rooms", names[i]);
        }
    }
    return names;
}

/* Takes words key=value, each with one of the scene's keys, or a word that all scenes have. */
static const char *take_arguments(struct gm_user_room *user_room, struct gm_span *rest)
{
    const struct gm_room *room = &user_room->room;
    const size_t place = gm_span_trimmed(room->text, *rest).begin;
    const char *text = take(room, rest, ";");
    for (const char *word = text; *word; word += strcspn(word, " "), word += *word == ' ') {
        const char *key = gm_arena_print(user_room->arena, "%.*s", (int)strcspn(word, "= "), word);
        if (word[strlen(key)] != '=' ||
            !(gm_scene_parameter(&user_room->scene, key) || gm_reading_reserves(key, strlen(key)))) {
            gm_room_refuse(room, place, "words key=value were expected, with keys of the room: until=5");
        }
    }
    return text;
}

static const char *observable_key(struct gm_user_room *user_room, struct gm_span span)
{
    const struct gm_room *room = &user_room->room;
    const char *key = gm_room_keep(room, span);
    if (gm_scene_observable(&user_room->scene, key) < 0) {
        gm_room_refuse(room, span.begin, "this is not an observable of the room");
    }
    return key;
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

/* Checks that the usual value of a row is one of its values. */
static void check_row(struct gm_user_room *user_room, const struct gm_parameter *row, size_t place)
{
    const struct gm_room *room = &user_room->room;
    struct gm_flows scratch;
    if (gm_parameter_set(row, &scratch, row->standard) != GM_PARSED) {
        gm_room_refuse(room, place, "the usual value lies outside of the range, or is none of the words");
    }
}

/* Adds choices that come before a place of the file. */
static void add_choices(struct gm_user_room *user_room, size_t place, size_t *count)
{
    const struct gm_room *room = &user_room->room;
    const struct gm_written_choices *choices = &room->choices;
    for (; *count < choices->count && choices->list[*count].place < place; ++*count) {
        const struct gm_written_choice *choice = &choices->list[*count];
        const char **words = gm_arena_take(user_room->arena, choice->count + 1, sizeof *words);
        for (size_t i = 0; i < choice->count; i++) {
            words[i] = choice->words[i];
        }
        if (find_row(choice->name)) {
            gm_room_refuse(room, choice->place, "this name is reserved");
        }
        const char *meaning =
            gm_arena_keep(user_room->arena, gm_span_words(user_room->file.text, choice->meaning), free);
        struct gm_parameter *row =
            add_row(user_room, &(const struct gm_parameter)GM_CHOICE_ROW(struct gm_flows, choices[0], "",
                                                                         words[choice->standard], words,
                                                                         meaning[0] ? meaning : "a choice"));
        row->key = choice->name;
        row->offset += sizeof(int) * *count;
    }
}

static void make_rows(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    const struct gm_parameter timing[] = {
        GM_DT(gm_written_number(room->arena, isnan(room->dt) ? 0.01 : room->dt, NULL), room->dt_range.least,
              room->dt_range.most),
        GM_UNTIL(gm_written_number(room->arena, isnan(room->until) ? 10 : room->until, NULL))};
    size_t own = 0, choices = 0;
    struct gm_span dt;
    gm_room_said(room, "dt", 0, &dt);
    check_row(user_room, add_row(user_room, &timing[0]), dt.begin);
    add_row(user_room, &timing[1]);
    if (!gm_room_parameter(room, "viscosity") && !gm_room_parameter(room, "reynolds")) {
        add_row(user_room, find_row("viscosity"))->standard =
            gm_written_number(room->arena, room->viscosity, NULL);
        if (!gm_room_parameter(room, "schmidt")) {
            add_row(user_room, find_row("schmidt"))->standard =
                gm_written_number(room->arena, room->viscosity / room->diffusivity, NULL);
        }
    }
    for (size_t i = 0; i < room->parameter_count; i++) {
        const struct gm_room_parameter *parameter = &room->parameters[i];
        const struct gm_parameter *template = find_row(parameter->name);
        const struct gm_parameter plain =
            GM_REAL_ROW(struct gm_flows, own[0], "", "0", -1e300, 1e300, "a parameter");
        if (!template && own == GM_FLOWS_OWN) {
            gm_room_refuse(room, parameter->place, "a room has at most 8 parameters of its own");
        }
        add_choices(user_room, parameter->place, &choices);
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
        check_row(user_room, row, parameter->place);
    }
    add_choices(user_room, SIZE_MAX, &choices);
    user_room->scene.parameters = user_room->rows;
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

/* Checks that all pieces after the first begin with one of `words`, NULL-terminated. */
static void check_options(struct gm_user_room *user_room, struct gm_span rest, const char *const *words)
{
    const struct gm_room *room = &user_room->room;
    struct gm_span piece, word;
    gm_span_take(room->text, &rest, ";", &piece);
    while (gm_span_take(room->text, &rest, ";", &piece)) {
        gm_span_take(room->text, &piece, " ", &word);
        if (!words[gm_span_among(room->text, word, words)]) {
            gm_room_refuse(room, word.begin, "this line has no such option");
        }
    }
}

/* observe: KEY; title TEXT; missing TEXT; along PROFILE: a new observable, or a new title of one */
static void observe(struct gm_user_room *user_room, struct gm_span rest)
{
    const struct gm_room *room = &user_room->room;
    static const char *const options[] = {"along", "title", "missing", NULL};
    const struct gm_span line = rest;
    check_options(user_room, line, options);
    const char *key = take(room, &rest, ";"), *along = option(room, rest, "along"),
               *title = option(room, rest, "title"), *missing = option(room, rest, "missing");
    const struct gm_observable *row = gm_room_observable(key, along);
    size_t profile = 0, i = 0;
    while (along && profile < user_room->profile_count &&
           strcmp(user_room->profiles[profile].name, along) != 0) {
        profile++;
    }
    while (i < user_room->observable_count && strcmp(user_room->observables[i].key, key) != 0) {
        i++;
    }
    struct gm_observable *observable = &user_room->observables[i];
    if (i == user_room->observable_count) {
        if (!row || i == GM_ROOM_OBSERVED || (along && profile == user_room->profile_count)) {
            gm_room_refuse(room, line.begin,
                           "this is nothing that is observed of a room, or of a profile that it has");
        }
        *observable = *row;
        user_room->subjects[user_room->observable_count++].number = profile;
    }
    observable->title = title ? title : observable->title;
    observable->missing = missing ? missing : observable->missing;
}

/* profile: NAME QUANTITIES; x, y; x, y; points; low .. high; label */
static void add_profile(struct gm_user_room *user_room, struct gm_span rest)
{
    const struct gm_room *room = &user_room->room;
    user_room->profiles = gm_arena_resize(user_room->arena, user_room->profiles, user_room->profile_count + 1,
                                          sizeof *user_room->profiles);
    struct gm_room_profile *profile = &user_room->profiles[user_room->profile_count++];
    struct gm_span head, piece;
    const struct gm_span line = rest;
    gm_span_take(room->text, &rest, ";", &head);
    const char *const *words = list_words(room, gm_room_keep(room, head));
    *profile = (struct gm_room_profile){.name = words ? words[0] : "", .range = {NAN, NAN}};
    char *quantities = gm_arena_take(user_room->arena, head.end - head.begin + 1, 1);
    profile->quantities = quantities;
    for (size_t i = 1; words && words[i]; i++) {
        if (strcmp(words[i], "u") != 0 && strcmp(words[i], "v") != 0 && strcmp(words[i], "scalar") != 0) {
            gm_room_refuse(room, line.begin, "a profile shows u, v or scalar");
        }
        quantities[i - 1] = words[i][0];
    }
    double *const ends[2] = {profile->a, profile->b};
    for (int end = 0; end < 2; end++) {
        size_t count;
        gm_span_take(room->text, &rest, ";", &piece);
        const double *place = numbers(room, piece, NULL, &count);
        if (count != 2) {
            gm_room_refuse(room, line.begin,
                           "a profile has a name and quantities, two places and a number of points");
        }
        memcpy(ends[end], place, 2 * sizeof *place);
    }
    gm_span_take(room->text, &rest, ";", &piece);
    profile->count = (size_t)fmin(fmax(number(room, piece), 2), 1e6);
    if (gm_span_take(room->text, &rest, ";", &piece)) {
        gm_room_need(room, gm_room_range_of(room, piece, &profile->range, room->fault));
    }
    profile->label = rest.begin < rest.end ? gm_room_keep(room, rest) : NULL;
}

/* table: NAME PROFILE; KEY = VALUE; position value, position value ... */
static void add_table(struct gm_user_room *user_room, struct gm_span rest)
{
    const struct gm_room *room = &user_room->room;
    user_room->tables = gm_arena_resize(user_room->arena, user_room->tables, user_room->table_count + 1,
                                        sizeof *user_room->tables);
    struct gm_room_table *table = &user_room->tables[user_room->table_count++];
    struct gm_span line = rest, condition, piece;
    const char *const *words = list_words(room, take(room, &rest, ";"));
    gm_span_take(room->text, &rest, ";", &condition);
    const char *key = take(room, &condition, "=");
    *table = (struct gm_room_table){.name = words ? words[0] : "",
                                    .row = gm_scene_parameter(&user_room->scene, key)};
    for (size_t i = 0; i < user_room->profile_count; i++) {
        if (words && words[1] && strcmp(user_room->profiles[i].name, words[1]) == 0) {
            table->profile = &user_room->profiles[i];
        }
    }
    if (!table->profile || !table->row) {
        gm_room_refuse(room, line.begin,
                       "a table has a name and a profile, the value of a parameter, and points");
    }
    table->value = number(room, condition);
    while (gm_span_take(room->text, &rest, ",", &piece)) {
        struct gm_span value;
        gm_span_take(room->text, &piece, " ", &value);
        table->points =
            gm_arena_resize(user_room->arena, table->points, 2 * (table->count + 1), sizeof *table->points);
        table->points[2 * table->count] = number(room, value);
        table->points[2 * table->count++ + 1] = piece.begin < piece.end ? number(room, piece) : NAN;
    }
}

/* Reads the next value in braces: the text before it, and its key. Returns false after the last; the text is
   the rest. */
static bool take_brace(const struct gm_room *room, struct gm_span *rest, struct gm_span *before,
                       struct gm_span *key, bool *nonzero)
{
    const size_t open = gm_span_until(room->text, *rest, "{"),
                 close = gm_span_until(room->text, (struct gm_span){open, rest->end}, "}"),
                 colon = gm_span_until(room->text, (struct gm_span){open, close}, ":");
    *before = (struct gm_span){rest->begin, open};
    *key = (struct gm_span){open < close ? open + 1 : open, colon};
    *nonzero = colon < close;
    rest->begin = close < rest->end ? close + 1 : close;
    return open < close;
}

const char *gm_room_text(struct gm_picture *picture, const struct gm_room *room, struct gm_span span)
{
    return gm_picture_text(picture, "%.*s", (int)(span.end - span.begin), room->text + span.begin);
}

/* subtitle: TEXT {key}, TEXT {key:nonzero}, and a remark after mesh and scheme, with values in braces */
static void fill_subtitle(const struct gm_user_room *user_room, const struct gm_room *room,
                          struct gm_span rest, struct gm_picture *picture, struct gm_look *look)
{
    struct gm_span before, key;
    bool nonzero;
    memset(look->told, 0, sizeof look->told);
    look->remark = "";
    for (size_t i = 0; rest.begin < rest.end; i++) {
        const bool filled = take_brace(room, &rest, &before, &key, &nonzero);
        const struct gm_parameter *row =
            gm_scene_parameter(&user_room->scene, gm_room_text(picture, room, key));
        struct gm_fault fault;
        double value;
        if (i < GM_COUNT(look->told) && row && row->type == GM_REAL && !look->remark[0]) {
            before.begin += strspn(room->text + before.begin, ", ");
            look->told[i].name = gm_room_text(picture, room, gm_span_trimmed(room->text, before));
            look->told[i].offset = row->offset;
            look->told[i].nonzero = nonzero;
        } else {
            look->remark =
                gm_picture_text(picture, "%s%s", look->remark, gm_room_text(picture, room, before));
            if (filled && gm_room_number(room, key, &value, &fault)) {
                look->remark = gm_picture_text(picture, "%s%.4g", look->remark, value);
            }
        }
    }
}

/* colours: vorticity F, speed F. Returns false at another word, or a number that is not positive. */
static bool take_colours(const struct gm_room *room, struct gm_look *look, struct gm_fault *fault)
{
    static const char *const words[] = {"vorticity", "speed", NULL};
    struct gm_span rest, piece;
    gm_room_said(room, "colours", 0, &rest);
    while (gm_span_take(room->text, &rest, ",", &piece)) {
        const struct gm_span word = {piece.begin, gm_span_until(room->text, piece, " ")};
        const size_t which = gm_span_among(room->text, word, words);
        double *end = which == 0 ? &look->vorticity_range : &look->speed_high;
        if (!words[which] || !gm_room_number(room, (struct gm_span){word.end, piece.end}, end, fault) ||
            !(*end > 0)) {
            return gm_fail(fault, piece.begin, "colours: end at positive numbers: vorticity 5, speed 1");
        }
    }
    return true;
}

/* levels: F, F ..., as many numbers at most as the line has characters; NULL: they are only checked. */
static bool take_levels(const struct gm_room *room, double *levels, size_t *count, struct gm_fault *fault)
{
    struct gm_span rest, piece;
    double level;
    *count = 0;
    gm_room_said(room, "levels", 0, &rest);
    while (gm_span_take(room->text, &rest, ",", &piece)) {
        if (!gm_room_number(room, piece, &level, fault)) {
            return false;
        }
        if (levels) {
            levels[*count] = level;
        }
        ++*count;
    }
    return true;
}

/* graph: KEY; low .. high, in terms of the flow's measures */
static bool take_graph(const struct gm_room *room, size_t number, struct gm_span *key,
                       struct gm_room_range *range, struct gm_fault *fault)
{
    struct gm_span rest, piece;
    const bool said = gm_room_said(room, "graph", number, &rest);
    gm_span_take(room->text, &rest, ";", key);
    return said &&
           (!gm_span_take(room->text, &rest, ";", &piece) || gm_room_range_of(room, piece, range, fault));
}

void gm_room_take_look(const struct gm_user_room *user_room, const struct gm_room *room,
                       struct gm_picture *picture, struct gm_look *look)
{
    struct gm_span rest, piece;
    struct gm_fault fault;
    if (gm_room_said(room, "time", 0, &rest)) {
        gm_span_take(room->text, &rest, ";", &piece);
        rest = gm_span_trimmed(room->text, rest);
        rest.end = rest.begin + strcspn(room->text + rest.begin, ", \r\n");
        look->clock_unit = gm_room_text(picture, room, rest);
    }
    if (gm_room_said(room, "subtitle", 0, &rest)) {
        fill_subtitle(user_room, room, rest, picture, look);
    } else if (!gm_scene_parameter(&user_room->scene, "viscosity")) {
        memset(look->told, 0, sizeof look->told);
    }
    take_colours(room, look, &fault);
    gm_room_said(room, "levels", 0, &rest);
    double *levels = gm_picture_memory(picture, (rest.end - rest.begin + 1) * sizeof *levels);
    if (levels && take_levels(room, levels, &look->level_count, &fault)) {
        look->levels = look->level_count > 0 ? levels : NULL;
    }
    for (size_t i = 0; i < user_room->profile_count; i++) {
        look->profiles |= user_room->profiles[i].quantities[0] != 0;
    }
    const bool graphs = gm_room_said(room, "graph", 0, &rest);
    look->profiles_below = look->profiles && room->rectangular && !graphs;
    for (size_t i = 0; i < GM_COUNT(look->graphs) && (graphs || look->profiles_below); i++) {
        struct gm_room_range ends = {0, 0};
        look->graphs[i] =
            take_graph(room, i, &piece, &ends, &fault) ? gm_room_text(picture, room, piece) : NULL;
        look->graph_low[i] = ends.least;
        look->graph_high[i] = ends.most;
    }
}

/* Checks that the lines of the picture can be read. */
static void check_look(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    struct gm_room measured = *room;
    struct gm_look look;
    struct gm_span rest, piece;
    struct gm_room_range ends;
    bool nonzero, good = take_colours(room, &look, room->fault) &&
                         take_levels(room, NULL, &look.level_count, room->fault);
    for (int i = 0; i < GM_ROOM_MEASURES; i++) {
        measured.measures[i] = 1;
    }
    gm_room_said(room, "subtitle", 0, &rest);
    while (good && take_brace(room, &rest, &piece, &piece, &nonzero)) {
        double value;
        good = gm_scene_parameter(&user_room->scene, gm_room_keep(room, piece)) ||
               gm_room_number(&measured, piece, &value, room->fault);
    }
    for (size_t i = 0; good && gm_room_said(room, "graph", i, &rest); i++) {
        good = take_graph(&measured, i, &piece, &ends, room->fault);
        observable_key(user_room, piece);
    }
    gm_room_need(room, good);
}

/* Returns the time, in a scene's own unit, in which a speed of 1 passes a mean edge: the Courant number is dt
   over it. NAN if setup refuses. */
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

/* The Courant numbers and time-stepping schemes of a map of the speed's loss. */
static const double courant_numbers[] = {0.5, 1, 2, 5, 10, 20, 50, 100};
static const char *const marching[] = {"semi-implicit", "crank-nicolson", NULL};

/* figure: NAME; WORDS; statement, work: WORDS; measure KEY; ..., stability: WORDS; reynolds VALUES */
static void make_studies(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    struct gm_scene *scene = &user_room->scene;
    struct gm_figure *figures = NULL;
    struct gm_span rest, piece;
    size_t count = 0;
    while (gm_room_said(room, "figure", scene->figure_count, &rest)) {
        figures = gm_arena_resize(user_room->arena, figures, scene->figure_count + 1, sizeof *figures);
        struct gm_figure *figure = &figures[scene->figure_count++];
        figure->name = take(room, &rest, ";");
        figure->arguments = take_arguments(user_room, &rest);
        figure->statement = gm_room_keep(room, rest);
    }
    scene->figures = figures;
    if (gm_room_said(room, "work", 0, &rest)) {
        const char *const options[] = {"measure", "coarsest",  "halvings", "errors",
                                       "schemes", room->edges, NULL};
        struct gm_work *work = &user_room->work;
        check_options(user_room, rest, options);
        *work =
            (struct gm_work){.arguments = take_arguments(user_room, &rest),
                             .coarsest = option_number(room, rest, "coarsest", 0),
                             .halvings = (int)fmin(fmax(0, option_number(room, rest, "halvings", 4)), 31)};
        if (gm_room_option(room, rest, "schemes", &piece)) {
            work->schemes = list_schemes(room, piece);
        }
        if (gm_room_option(room, rest, "measure", &piece)) {
            work->measure = observable_key(user_room, piece);
        }
        work->errors = numbers(room, rest, "errors", &count);
        work->resolutions = numbers(room, rest, room->edges, &work->resolution_count);
        work->resolution = work->resolutions ? room->edges : NULL;
        if ((count != 0 && count != 3) || work->halvings < 1 || work->halvings > 30) {
            gm_room_refuse(room, rest.begin, "work: has three errors that fall, and 1 to 30 halvings");
        }
        scene->work = work;
    }
    if (gm_room_said(room, "stability", 0, &rest)) {
        struct gm_stability *map = &user_room->stability;
        *map = (struct gm_stability){.arguments = take_arguments(user_room, &rest),
                                     .parameter = "reynolds",
                                     .label = "Courant number",
                                     .unit = courant_time,
                                     .steps = courant_numbers,
                                     .step_count = GM_COUNT(courant_numbers),
                                     .kept = "speed_max",
                                     .schemes = marching};
        map->values = numbers(room, rest, map->parameter, &map->value_count);
        if (!map->values || !gm_scene_parameter(scene, map->parameter)) {
            gm_room_refuse(room, rest.begin, "stability: needs values of a parameter: reynolds 100, 400");
        }
        scene->stability = map;
    } else if (gm_room_line(room, GM_ROOM_EXACT)) {
        scene->no_stability =
            "its exact solution is known, and work-precision measures its steps; stability cavity maps the same schemes";
    }
}

void gm_room_take_lines(struct gm_user_room *user_room)
{
    const struct gm_room *room = &user_room->room;
    struct gm_scene *scene = &user_room->scene;
    struct gm_span rest, piece;
    const char *watch = said(room, "watch"), *time = said(room, "time");
    make_rows(user_room);
    for (size_t i = 0; gm_room_said(room, "profile", i, &rest); i++) {
        add_profile(user_room, rest);
    }
    for (size_t i = 0; gm_room_said(room, "table", i, &rest); i++) {
        add_table(user_room, rest);
    }
    for (size_t i = 0; gm_room_said(room, "observe", i, &rest); i++) {
        observe(user_room, rest);
    }
    scene->observable_count = user_room->observable_count;
    scene->watch = watch ? watch : scene->watch;
    if (gm_room_said(room, "schemes", 0, &rest)) {
        scene->schemes = list_schemes(room, rest);
    }
    if (gm_room_said(room, "lanes", 0, &rest)) {
        scene->lanes = take_arguments(user_room, &rest);
    }
    if (gm_room_said(room, "time", 0, &rest) && gm_span_take(room->text, &rest, ";", &piece)) {
        scene->time = rest.begin < rest.end ? gm_room_keep(room, rest) : time;
    }
    check_look(user_room);
    make_studies(user_room);
    scene->profile = user_room->profile_count > 0 ? gm_room_write_profiles : NULL;
}
