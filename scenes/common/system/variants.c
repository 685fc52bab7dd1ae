/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems of one file, the rows that their tables have in common, and the values of a lane of one of them. */
#include "scenes/common/system/variants.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/model/equations.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"

/* Guards the list of a scene's systems, which grows while lanes are opened. */
static pthread_mutex_t listing = PTHREAD_MUTEX_INITIALIZER;

/* The rows of all systems, those of the first system first. */
struct tables {
    struct gm_parameter *rows; /* the common ones follow */
    struct gm_observable *observables;
    size_t row_count, common_count, observable_count;
};

/* Returns the number of the row of `size` bytes that begins with the key; `count` if it is missing. */
static size_t find(const void *rows, size_t size, size_t count, const char *key)
{
    size_t i = 0;
    while (i < count && strcmp(*(const char *const *)((const char *)rows + i * size), key) != 0) {
        i++;
    }
    return i;
}

/* Returns true if another value of a row makes another system: a choice, or a parameter that equations are
   built on unless words make the scene. */
static bool builds(const struct gm_system_scene *scene, size_t row)
{
    const size_t number = scene->variables[row];
    const struct gm_system_variable *variable =
        number != GM_NO_VARIABLE ? &scene->system.variables[number] : NULL;
    return row >= GM_SYSTEM_ROWS &&
           (scene->rows[row].type == GM_CHOICE ||
            (variable && variable->fixed && !isnan(variable->low) && !scene->scene.words));
}

/* Adds rows and observables with new keys; the range of a row includes the ranges of all. */
static void add(struct tables *tables, const struct gm_system_scene *other)
{
    for (size_t i = 0; i < other->row_count; i++) {
        const size_t row = find(tables->rows, sizeof *tables->rows, tables->row_count, other->rows[i].key);
        struct gm_parameter *to = &tables->rows[row], own = other->rows[i];
        if (builds(other, i) && own.type != GM_CHOICE) {
            own.lowest = other->system.variables[other->variables[i]].low;
            own.highest = other->system.variables[other->variables[i]].high;
        }
        if (row == tables->row_count) {
            *to = own;
            to->offset += (row - i) * sizeof(double);
            tables->row_count++;
        }
        to->lowest = fmin(to->lowest, own.lowest);
        to->highest = fmax(to->highest, own.highest);
    }
    for (size_t i = 0; i < other->observable_count; i++) {
        struct gm_observable *rows = tables->observables;
        if (find(rows, sizeof *rows, tables->observable_count, other->observables[i].key) ==
            tables->observable_count) {
            rows[tables->observable_count++] = other->observables[i];
        }
    }
}

static double nothing(const struct gm_view *view)
{
    (void)view;
    return NAN;
}

/* Gives a system the rows, and moves its values and measures to them. */
static void take(struct gm_arena *arena, struct gm_system_scene *own, const struct tables *tables)
{
    const size_t rows = tables->row_count, count = tables->observable_count,
                 size = sizeof *own->initial + rows * (sizeof(double) + 1);
    const struct gm_system_scene before = *own;
    char text[GM_CHOICE_SIZE + 32];
    own->rows = tables->rows;
    own->variables = gm_arena_take(arena, rows, sizeof *own->variables);
    own->initial = gm_arena_take(arena, 1, size);
    own->observables = gm_arena_take(arena, count + 1, sizeof *own->observables);
    own->measures = gm_arena_take(arena, count + 1, sizeof *own->measures);
    own->lacks = gm_arena_take(arena, rows, sizeof *own->lacks);
    for (size_t row = 0; row < rows; row++) {
        const struct gm_parameter *to = &tables->rows[row];
        const size_t from = find(before.rows, sizeof *to, before.row_count, to->key);
        const bool found = from < before.row_count;
        own->variables[row] = found ? before.variables[from] : GM_NO_VARIABLE;
        gm_parameter_set(to, own->initial,
                         found ? gm_parameter_format(&before.rows[from], before.initial, text, sizeof text)
                               : to->standard);
    }
    for (size_t i = 0; i < count; i++) {
        const struct gm_observable *row = &tables->observables[i];
        const size_t from = find(before.observables, sizeof *row, before.observable_count, row->key);
        if (from < before.observable_count) {
            own->observables[i] = before.observables[from];
            own->measures[i] = before.measures[from];
        } else {
            own->observables[i] = (struct gm_observable){.key = row->key,
                                                         .title = row->title,
                                                         .unit = row->unit,
                                                         .evaluate = nothing,
                                                         .logarithmic = row->logarithmic};
        }
    }
    memcpy(own->initial, before.initial, offsetof(struct gm_system_lane, values));
    own->common = own->rows + rows;
    own->common_count = tables->common_count;
    own->scene.parameter_count += rows - own->row_count;
    own->row_count = rows;
    own->observable_count = own->scene.observable_count = count;
    own->scene.size = size;
    own->scene.initial = own->initial;
    own->scene.parameters = own->rows;
    own->scene.observables = own->observables;
}

/* Adds a system to those of the file, with their rows. */
static void join(struct gm_arena *arena, struct gm_system_scene *own, struct gm_system_scene *first,
                 const struct tables *tables)
{
    own->scene.asked = first->scene.asked;
    own->scene.asked_count = first->scene.asked_count;
    take(arena, own, tables);
    own->first = first;
}

/* Returns true if a system has a row or, with row_count added, an observable. */
static bool has(const struct gm_system_scene *own, size_t i)
{
    return i < own->row_count ? own->variables[i] != GM_NO_VARIABLE || own->rows[i].type == GM_CHOICE
                              : own->observables[i - own->row_count].evaluate != nothing;
}

/* Returns true if a row has one value in two systems. */
static bool is_equal(const struct gm_system_scene *own, const struct gm_system_scene *other, size_t row)
{
    return gm_parameter_get(&own->rows[row], own->initial) ==
           gm_parameter_get(&other->rows[row], other->initial);
}

/* Returns the last row that builds two systems and differs in them, and how many do. */
static size_t find_difference(const struct gm_system_scene *own, const struct gm_system_scene *other,
                              size_t *count)
{
    size_t found = 0;
    *count = 0;
    for (size_t row = GM_SYSTEM_ROWS; row < own->row_count; row++) {
        if (builds(own, row) && !is_equal(own, other, row)) {
            found = row;
            ++*count;
        }
    }
    return found;
}

/* Gives the value of a row as the reason for what a system lacks without a reason: all of it, or what only
   one has of the first system and `other`, which differs from it in that row alone. */
static void give_reason(struct gm_arena *arena, struct gm_system_scene *own, size_t row,
                        const struct gm_system_scene *other)
{
    const char *reason = NULL;
    char value[GM_CHOICE_SIZE + 32];
    for (size_t i = GM_SYSTEM_ROWS; i < own->row_count + own->observable_count; i++) {
        const char **place =
            i < own->row_count ? &own->lacks[i] : &own->observables[i - own->row_count].missing;
        const bool decides = !other || (has(own->first, i) != has(other, i) &&
                                        has(own->first, i) == is_equal(own, other, row));
        if (*place || has(own, i) || !decides) {
            continue;
        }
        if (!reason) {
            gm_parameter_format(&own->rows[row], own->initial, value, sizeof value);
            reason = gm_arena_print(arena, "it is not defined with %s=%s", own->rows[row].key, value);
        }
        *place = reason;
    }
}

/* Gives the reasons for what a system lacks. */
static void explain(struct gm_arena *arena, struct gm_system_scene *own)
{
    size_t count;
    for (const struct gm_system_scene *other = own->first->next; other; other = other->next) {
        const size_t row = find_difference(own->first, other, &count);
        if (count == 1) {
            give_reason(arena, own, row, other);
        }
    }
    const size_t last = find_difference(own, own->first, &count);
    if (count > 0) {
        give_reason(arena, own, last, NULL);
    }
}

/* ---- one system ---- */

static void close_problem(void *thing)
{
    struct gm_system_making *making = thing;
    making->scene->scene.close(&making->problem);
}

void gm_system_open_problem(struct gm_system_making *making)
{
    char sentence[GM_MESSAGE];
    struct gm_system_scene *system_scene = making->scene;
    gm_arena_check(system_scene->arena,
                   system_scene->scene.setup(system_scene->initial, &making->problem, sentence), sentence);
    gm_arena_keep(system_scene->arena, making, close_problem);
}

struct taking {
    struct gm_user_system *system;
    const struct gm_system_maker *maker;
    const struct gm_system_origin *origin;
    struct gm_system_making making;
};

static void make(struct gm_arena *arena, void *data)
{
    struct taking *taking = data;
    /* a block of its own: a pointer to it makes all that the arena has reachable for checks of leaks */
    struct gm_system_scene *system_scene = gm_arena_keep(arena, calloc(1, taking->maker->size), free);
    taking->making.scene = system_scene;
    system_scene->arena = arena;
    system_scene->maker = taking->maker;
    system_scene->origin = *taking->origin;
    if (taking->origin->path) {
        system_scene->origin.path = gm_arena_print(arena, "%s", taking->origin->path);
    }
    system_scene->system = *taking->system;
    *taking->system = (struct gm_user_system){0};
    gm_arena_keep(arena, &system_scene->system, gm_system_close);
    taking->maker->make(&taking->making);
    if (taking->making.problem.kind) { /* the maker of rooms opens none */
        gm_arena_drop(arena, &taking->making);
    }
}

/* Makes the scene of a system, which it takes; NULL with a sentence, and possibly a fault. */
static struct gm_system_scene *open_one(struct gm_user_system *system, const struct gm_system_maker *maker,
                                        const struct gm_system_origin *origin,
                                        struct gm_system_opening *opening)
{
    struct gm_arena *arena = gm_arena_open();
    struct taking taking = {system, maker, origin, {.fault = opening->fault}};
    const bool made = gm_arena_run(arena, make, &taking);
    opening->unread = taking.making.unread;
    if (made) {
        return taking.making.scene;
    }
    gm_system_close(system);
    gm_refuse(opening->sentence, "%s", gm_arena_reason(arena));
    gm_arena_close(arena);
    return NULL;
}

void gm_system_scene_close(const struct gm_scene *scene)
{
    const struct gm_system_scene *system_scene =
        (const struct gm_system_scene *)scene; /* the scene is its first member */
    if (system_scene->next) {
        gm_system_scene_close(&system_scene->next->scene);
    }
    gm_arena_close(system_scene->arena);
}

/* ---- several ---- */

/* Opens the system of the text of `first` with other values, and adds it to its list. */
static struct gm_system_scene *open_other(struct gm_system_scene *first, const struct gm_system_value *values,
                                          size_t count, const struct gm_system_opening *opening)
{
    struct gm_user_system system;
    const char *text = first->system.source;
    const struct gm_system_value *last = &values[count - 1];
    const bool field = gm_system_is_field(&first->system);
    if (!gm_equations_open(&system, text, first->system.length, values, count, opening->fault)) {
        gm_refuse(opening->sentence, "%s",
                  opening->fault->sentence[0] ? opening->fault->sentence : "not enough memory");
    } else if (field ? system.kind != first->system.kind : gm_system_is_field(&system)) {
        gm_refuse(opening->sentence, "choice: %s=%s is %s, and other words are %s", last->name, last->text,
                  field ? "another equation" : "a field", field ? "of one kind" : "none");
    } else {
        struct gm_fault unplaced = {0};
        struct gm_system_origin origin = first->origin;
        origin.typed = false;
        struct gm_system_scene *made =
            open_one(&system, first->maker, &origin,
                     &(struct gm_system_opening){.fault = &unplaced, .sentence = opening->sentence});
        if (made) {
            made->next = first->next;
            first->next = made;
        }
        return made;
    }
    gm_system_close(&system);
    return NULL;
}

/* Collects the views of all systems of a file: all, the section, planes, and the modified Hamiltonian. */
static void unite_shows(struct gm_arena *arena, struct gm_system_scene *first)
{
    size_t most = 1, count = 0;
    for (const struct gm_system_scene *other = first; other; other = other->next) {
        for (size_t k = 0; other->shows[k]; k++) {
            most++;
        }
    }
    first->all_shows = gm_arena_take(arena, most, sizeof *first->all_shows);
    for (int pass = 0; pass < 3; pass++) {
        for (const struct gm_system_scene *other = first; other; other = other->next) {
            for (size_t k = 0; other->shows[k]; k++) {
                const char *name = other->shows[k];
                const bool modified = other->system.kind == GM_CANONICAL && !other->shows[k + 1];
                const bool section = other->has_section && k == GM_SHOW_SECTION;
                const int last = modified ? 2 : 1;
                const int place = k == GM_SHOW_ALL || section ? 0 : last;
                if (place == pass && find(first->all_shows, sizeof name, count, name) == count) {
                    first->all_shows[count++] = name;
                }
            }
        }
    }
}

static bool has_scheme(const struct gm_system_scene *system_scene, const char *scheme)
{
    size_t k = 0;
    while (system_scene->schemes[k] && strcmp(system_scene->schemes[k], scheme) != 0) {
        k++;
    }
    return system_scene->schemes[k] != NULL;
}

/* Keeps the schemes that fit all systems of a file that names none, if any does. */
static void keep_common_schemes(struct gm_system_scene *first)
{
    const char *kept[GM_COUNT(first->schemes)] = {NULL};
    size_t count = 0;
    for (size_t k = 0; first->schemes[k]; k++) {
        const struct gm_system_scene *other = first->next;
        while (other && has_scheme(other, first->schemes[k])) {
            other = other->next;
        }
        if (!other) {
            kept[count++] = first->schemes[k];
        }
    }
    if (count > 0 && !first->system.texts[GM_WORD_SCHEMES]) {
        memcpy(first->schemes, kept, sizeof kept);
    }
}

/* The first system of a file, and the one that a body opens for a lane. */
struct uniting {
    struct gm_system_scene *first, *made;
    const struct gm_system_lane *lane;
    const struct gm_system_opening *opening;
};

static void unite(struct gm_arena *arena, void *data)
{
    const struct uniting *uniting = data;
    struct gm_system_scene *first = uniting->first;
    const struct gm_written_choices *choices = &first->system.choices;
    size_t building = 0, rows = first->row_count + first->common_count,
           observables = first->observable_count + 1;
    for (size_t row = 0; row < first->row_count; row++) {
        building += builds(first, row);
    }
    for (size_t i = 0; i < choices->count; i++) {
        const struct gm_written_choice *choice = &choices->list[i];
        for (size_t k = 0; k < choice->count; k++) {
            const struct gm_system_value word = {choice->name, choice->words[k]};
            if (k == choice->chosen) {
                continue;
            }
            const struct gm_system_scene *other = open_other(first, &word, 1, uniting->opening);
            if (!other) {
                gm_arena_refuse(arena, "%s", uniting->opening->sentence);
            }
            rows += other->row_count;
            observables += other->observable_count;
        }
    }
    keep_common_schemes(first);
    struct tables tables = {.rows = gm_arena_take(arena, rows, sizeof *tables.rows),
                            .common_count = first->common_count,
                            .observables = gm_arena_take(arena, observables, sizeof *tables.observables)};
    for (const struct gm_system_scene *other = first; building > 0 && other; other = other->next) {
        add(&tables, other);
    }
    memcpy(tables.rows + tables.row_count, first->common, first->common_count * sizeof *tables.rows);
    if (first->shows) {
        unite_shows(arena, first);
        tables.rows[tables.row_count + GM_ROW_SHOW - gm_system_skipped(first)].choices = first->all_shows;
    }
    for (struct gm_system_scene *other = first; building > 0 && other; other = other->next) {
        join(arena, other, first, &tables);
    }
    for (struct gm_system_scene *other = first; building > 0 && other; other = other->next) {
        explain(arena, other);
    }
}

const struct gm_scene *gm_system_scene_make(const struct gm_system_maker *maker,
                                            struct gm_user_system *system,
                                            const struct gm_system_origin *origin,
                                            struct gm_system_opening *opening)
{
    const bool alone = !maker->rebuilt && system->choices.count == 0;
    *opening->fault = (struct gm_fault){0};
    struct gm_system_scene *first = open_one(system, maker, origin, opening);
    const unsigned long refusals = gm_memory_refusals();
    if (!first) {
        return NULL;
    }
    if (!alone && !gm_arena_run(first->arena, unite, &(struct uniting){.first = first, .opening = opening})) {
        gm_refuse(opening->sentence, "%s", gm_arena_reason(first->arena));
    } else if (gm_memory_refusals() != refusals) {
        gm_refuse(opening->sentence, "not enough memory");
    } else {
        return &first->scene;
    }
    gm_system_scene_close(&first->scene);
    return NULL;
}

/* Returns true if a system has a lane's values. */
static bool is_of(const struct gm_system_scene *other, const struct gm_system_lane *lane)
{
    for (size_t row = 0; other->first && row < other->row_count; row++) {
        if (builds(other, row) && gm_parameter_get(&other->rows[row], lane) !=
                                      gm_parameter_get(&other->rows[row], other->initial)) {
            return false;
        }
    }
    return other->first != NULL;
}

/* Opens the system of a lane's values. */
static void open_variant(struct gm_arena *arena, void *data)
{
    struct uniting *uniting = data;
    const struct gm_system_scene *first = uniting->first;
    size_t count = 0;
    struct gm_system_value *values = gm_arena_take(arena, first->row_count, sizeof *values);
    for (size_t row = 0; row < first->row_count; row++) {
        if (builds(first, row)) {
            const struct gm_parameter *at = &first->rows[row];
            char text[GM_CHOICE_SIZE + 32];
            gm_parameter_format(at, uniting->lane, text, sizeof text);
            values[count++] = (struct gm_system_value){at->key, gm_arena_print(arena, "%s", text)};
        }
    }
    uniting->made = open_other(uniting->first, values, count, uniting->opening);
}

static void join_variant(struct gm_arena *arena, void *data)
{
    const struct uniting *uniting = data;
    struct gm_system_scene *first = uniting->first;
    join(arena, uniting->made, first,
         &(struct tables){first->rows, first->observables, first->row_count, first->common_count,
                          first->observable_count});
    explain(arena, uniting->made);
}

/* Makes a missing system and adds it to the list. */
static struct gm_system_scene *add_variant(struct gm_system_scene *first, const struct gm_system_lane *lane,
                                           const struct gm_system_opening *opening)
{
    struct uniting uniting = {.first = first, .lane = lane, .opening = opening};
    const unsigned long refusals = gm_memory_refusals();
    const size_t mark = gm_arena_mark(first->arena);
    gm_refuse(opening->sentence, "not enough memory");
    gm_arena_run(first->arena, open_variant, &uniting);
    gm_arena_release(first->arena, mark);
    struct gm_system_scene *made = uniting.made;
    if (made && gm_arena_run(made->arena, join_variant, &uniting) && gm_memory_refusals() == refusals) {
        opening->sentence[0] = '\0';
        return made;
    }
    if (made) {
        first->next = made->next;
        made->next = NULL;
        gm_system_scene_close(&made->scene);
        gm_refuse(opening->sentence, "not enough memory");
    } else if (opening->fault->sentence[0]) {
        size_t line, column;
        gm_text_place(first->system.source, opening->fault->offset, &line, &column);
        gm_refuse(opening->sentence, "line %zu: %s", line, opening->fault->sentence);
    }
    return NULL;
}

/* Gives a lane the system of its values. False with a sentence on failure. */
static bool choose(struct gm_system_lane *lane, char *sentence)
{
    struct gm_fault fault = {0};
    const struct gm_system_opening opening = {.fault = &fault, .sentence = sentence};
    struct gm_system_scene *first = lane->owner->first, *other = first;
    if (!first) {
        return true;
    }
    pthread_mutex_lock(&listing);
    while (other && !is_of(other, lane)) {
        other = other->next;
    }
    other = other ? other : add_variant(first, lane, &opening);
    pthread_mutex_unlock(&listing);
    lane->owner = other ? other : lane->owner;
    return other != NULL;
}

/* ---- the values of a lane ---- */

enum { DT, UNTIL };

/* Returns the bytes after the values: 1 if the row was given. */
static char *given_of(struct gm_system_lane *lane)
{
    return (char *)(lane->values + (lane->owner->row_count - GM_SYSTEM_ROWS));
}

struct settling {
    struct gm_system_lane *lane;
    const char *const *keys;
    size_t count;
};

static void check_range(struct gm_arena *arena, const struct gm_parameter *row, double value)
{
    gm_arena_refuse_if(arena, !(value >= row->lowest && value <= row->highest),
                       "%s is %g with these values, and lies between %g and %g", row->key, value, row->lowest,
                       row->highest);
}

/* Derives the values that were not given. */
static void settle(struct gm_arena *arena, void *data)
{
    const struct settling *settling = data;
    struct gm_system_lane *lane = settling->lane;
    const struct gm_system_scene *system_scene = lane->owner;
    char *given = given_of(lane), sentence[GM_MESSAGE];
    bool by_steps = false;
    for (size_t i = 0; i < settling->count; i++) {
        const char *key = settling->keys[i];
        lane->grid.points_given |= strcmp(key, "points") == 0;
        by_steps |= strcmp(key, "steps") == 0;
        for (size_t row = 0; row < system_scene->row_count; row++) {
            given[row] |= strcmp(key, system_scene->rows[row].key) == 0;
        }
    }
    double *values = gm_arena_keep(arena, gm_system_start_values(lane, given), free);
    gm_arena_check(arena, gm_system_is_admitted(lane, values, sentence), sentence);
    for (size_t row = GM_SYSTEM_ROWS; row < system_scene->row_count; row++) {
        if (system_scene->variables[row] == GM_NO_VARIABLE) {
            continue;
        }
        const double value = lane->values[row - GM_SYSTEM_ROWS] = values[system_scene->variables[row]];
        gm_arena_refuse_if(arena, !isfinite(value), "%s is not finite with these values",
                           system_scene->rows[row].key);
        check_range(arena, &system_scene->rows[row], value);
    }
    if (gm_system_is_field(&system_scene->system) && gm_system_points_follow(&system_scene->system)) {
        double *points = &values[system_scene->system.velocities - 1];
        *points = round(*points);
        check_range(arena, gm_scene_parameter(&system_scene->scene, "points"), *points);
        lane->grid.points = (long)*points;
    }
    for (size_t i = 0; i < GM_COUNT(system_scene->timing); i++) {
        double number = NAN;
        const enum gm_system_word word = (enum gm_system_word)((int)GM_WORD_DT + (int)i);
        if (gm_system_item_of(&system_scene->system, word, 0)) {
            gm_tape_values(&system_scene->timing[i], values, &number, 1);
        }
        if (word == GM_WORD_DT && !given[DT] && number > 0) {
            lane->timing.dt = number;
        } else if (word == GM_WORD_UNTIL && !given[UNTIL] && number >= 0) {
            lane->timing.until = number;
        } else if (word == GM_WORD_STEPS && !given[UNTIL] && !by_steps && number >= 0) {
            lane->timing.until = number * lane->timing.dt;
        }
    }
    const struct gm_system_item *line = gm_system_item_of(&system_scene->system, GM_WORD_TIE, 0);
    for (size_t row = GM_SYSTEM_ROWS; line && row < system_scene->row_count; row++) {
        if (system_scene->variables[row] == line->variable) {
            const char *key = system_scene->rows[row].key;
            double unit, *value = &lane->values[row - GM_SYSTEM_ROWS];
            gm_tape_values(&system_scene->of_items[line - system_scene->system.items], values, &unit, 1);
            const double follows = *value * unit, dt = lane->timing.dt;
            const bool by_step = gm_is_given("dt", settling->keys, settling->count);
            gm_arena_refuse_if(arena,
                               by_step && gm_is_given(key, settling->keys, settling->count) &&
                                   !(fabs(follows - dt) <= 1e-9 * follows),
                               "dt= and %s= are both given; one of them follows from the other", key);
            *value = by_step ? dt / unit : *value;
            lane->timing.dt = by_step ? dt : follows;
        }
    }
}

static bool settle_lane(void *parameters, const char *const *keys, size_t count, char *sentence)
{
    struct settling settling = {parameters, keys, count};
    struct gm_arena *arena = gm_arena_open();
    const bool settled = choose(parameters, sentence) && (gm_arena_run(arena, settle, &settling) ||
                                                          gm_refuse(sentence, "%s", gm_arena_reason(arena)));
    gm_arena_close(arena);
    return settled;
}

static const struct gm_scene *variant_of(const void *parameters)
{
    return &((const struct gm_system_lane *)parameters)->owner->scene;
}

const char *gm_system_idle(const void *parameters, const char *key)
{
    const struct gm_system_scene *owner = ((const struct gm_system_lane *)parameters)->owner;
    for (size_t row = GM_SYSTEM_ROWS; row < owner->row_count; row++) {
        const struct gm_parameter *at = &owner->rows[row];
        if (strcmp(at->key, key) == 0 && at->type != GM_CHOICE && owner->variables[row] == GM_NO_VARIABLE) {
            return owner->lacks[row];
        }
    }
    return NULL;
}

void gm_system_describe(struct gm_system_scene *system_scene, struct gm_scene scene)
{
    const struct gm_system_origin *origin = &system_scene->origin;
    const struct gm_user_system *system = &system_scene->system;
    char *const *texts = system->texts;
    scene.name = origin->name;
    scene.title = gm_system_title(system) ? gm_system_title(system) : scene.title;
    scene.blurb = texts[GM_WORD_ABOUT] ? texts[GM_WORD_ABOUT] : scene.blurb;
    scene.watch = texts[GM_WORD_WATCH] ? texts[GM_WORD_WATCH] : "";
    scene.time = texts[GM_WORD_TIME] ? texts[GM_WORD_TIME] : scene.time;
    scene.size = sizeof *system_scene->initial + system_scene->row_count * (sizeof(double) + 1);
    scene.initial = system_scene->initial;
    scene.words = origin->words;
    scene.source = scene.text = origin->words ? system->source : NULL;
    scene.mark = origin->words ? gm_written_mark(system_scene->arena, origin->name, system->source) : NULL;
    scene.parameters = system_scene->rows;
    scene.parameter_count = system_scene->row_count + system_scene->common_count;
    scene.variant = variant_of;
    scene.settle = settle_lane;
    system_scene->scene = scene;
}
