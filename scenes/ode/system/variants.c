/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems of one file, and the rows that their tables have in common. */
#include "scenes/ode/system/variants.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/ode/system/pieces.h"

enum { MOST_BUILDING = 16 };

/* Guards the list of a scene's systems, which grows while lanes are opened. */
static pthread_mutex_t listing = PTHREAD_MUTEX_INITIALIZER;

/* The rows of all, those of the first system first. */
struct tables {
    struct gm_parameter *rows; /* with the common ones behind them */
    struct gm_observable *observables;
    size_t row_count, observable_count;
};

/* The number of a row of that key, which is what rows begin with; their number: there is none. */
static size_t find(const void *rows, size_t size, size_t count, const char *key)
{
    size_t i = 0;
    while (i < count && strcmp(*(const char *const *)((const char *)rows + i * size), key) != 0) {
        i++;
    }
    return i;
}

static size_t find_row(const struct gm_parameter *rows, size_t count, const char *key)
{
    return find(rows, sizeof *rows, count, key);
}

static size_t find_observable(const struct gm_observable *rows, size_t count, const char *key)
{
    return find(rows, sizeof *rows, count, key);
}

/* Whether another value of a row is another system: of a choice, and of what the equations are built on where no words
   make the scene anew. */
static bool builds(const struct gm_system_scene *scene, size_t row)
{
    const size_t number = scene->variables[row];
    const struct gm_system_variable *variable =
        number != GM_NO_VARIABLE ? &scene->system.variables[number] : NULL;
    return row >= GM_SYSTEM_ROWS &&
           (scene->rows[row].type == GM_CHOICE ||
            (variable && variable->fixed && !isnan(variable->low) && !scene->scene.words));
}

/* Adds what a system has beside those of the same keys, whose ranges hold those of all. */
static void add(struct tables *tables, const struct gm_system_scene *other)
{
    for (size_t i = 0; i < other->row_count; i++) {
        const size_t row = find_row(tables->rows, tables->row_count, other->rows[i].key);
        struct gm_parameter *to = &tables->rows[row], own = other->rows[i];
        if (row == tables->row_count) {
            *to = own;
            to->offset = row < GM_SYSTEM_ROWS ? own.offset
                                              : offsetof(struct gm_system_lane, values) +
                                                    (row - GM_SYSTEM_ROWS) * sizeof(double);
            tables->row_count++;
        }
        to->lowest = fmin(to->lowest, own.lowest);
        to->highest = fmax(to->highest, own.highest);
    }
    for (size_t i = 0; i < other->observable_count; i++) {
        const struct gm_observable *row = &other->observables[i];
        if (find_observable(tables->observables, tables->observable_count, row->key) ==
            tables->observable_count) {
            tables->observables[tables->observable_count++] = *row;
        }
    }
}

static double nothing(const struct gm_view *view)
{
    (void)view;
    return NAN;
}

/* A system takes the rows, and puts its values where each now is. False: out of memory. */
static bool take_rows(struct gm_system_scene *own, const struct tables *tables)
{
    const size_t all = tables->row_count + GM_COMMON_ROWS + GM_CAMERA_KEYS;
    const size_t size = sizeof *own->initial + tables->row_count * (sizeof(double) + 1);
    struct gm_parameter *rows = malloc(all * sizeof *rows);
    size_t *variables = malloc(tables->row_count * sizeof *variables);
    struct gm_system_lane *initial = calloc(1, size);
    char text[GM_CHOICE_SIZE + 32];
    for (size_t row = 0; rows && variables && initial && row < tables->row_count; row++) {
        const size_t before = find_row(own->rows, own->row_count, tables->rows[row].key);
        variables[row] = before < own->row_count ? own->variables[before] : GM_NO_VARIABLE;
        const char *value = tables->rows[row].standard;
        if (before < own->row_count) {
            value = gm_parameter_format(&own->rows[before], own->initial, text, sizeof text);
        }
        gm_parameter_set(&tables->rows[row], initial, value);
    }
    if (!rows || !variables || !initial) {
        free(rows);
        free(variables);
        free(initial);
        return false;
    }
    memcpy(initial, own->initial, offsetof(struct gm_system_lane, values));
    memcpy(rows, tables->rows, all * sizeof *rows);
    free(own->rows);
    free(own->variables);
    free(own->initial);
    own->rows = rows;
    own->common = rows + tables->row_count;
    own->variables = variables;
    own->initial = initial;
    own->scene.parameter_count += tables->row_count - own->row_count;
    own->row_count = tables->row_count;
    own->scene.size = size;
    own->scene.initial = initial;
    own->scene.parameters = rows;
    return true;
}

static bool take_observables(struct gm_system_scene *own, const struct tables *tables)
{
    const size_t count = tables->observable_count;
    struct gm_observable *observables = calloc(count + 1, sizeof *observables);
    struct gm_tape *formulas = calloc(count + 1, sizeof *formulas), *terms = calloc(count + 1, sizeof *terms);
    const bool good = observables && formulas && terms;
    for (size_t i = 0; good && i < count; i++) {
        const struct gm_observable *row = &tables->observables[i];
        const size_t before = find_observable(own->observables, own->observable_count, row->key);
        const bool found = before < own->observable_count;
        observables[i] = found ? own->observables[before]
                               : (struct gm_observable){.key = row->key,
                                                        .title = row->title,
                                                        .unit = row->unit,
                                                        .evaluate = nothing,
                                                        .missing = own->lacks,
                                                        .logarithmic = row->logarithmic};
        if (found) {
            formulas[i] = own->formulas[before];
            terms[i] = own->terms[before];
        }
    }
    free(good ? own->observables : observables);
    free(good ? own->formulas : formulas);
    free(good ? own->terms : terms);
    if (good) {
        own->scene.observables = own->observables = observables;
        own->scene.observable_count = own->observable_count = count;
        own->formulas = formulas;
        own->terms = terms;
    }
    return good;
}

/* `value`: what makes it another system than the first. */
static bool take(struct gm_system_scene *own, struct gm_system_scene *first, const struct tables *tables,
                 const struct gm_system_value *value)
{
    own->first = first;
    own->lacks = gm_system_kept_text(own, "with %s=%s there is none", value->name, value->text);
    own->scene.asked = first->scene.asked;
    own->scene.asked_count = first->scene.asked_count;
    return own->lacks && take_rows(own, tables) && take_observables(own, tables);
}

/* The first system takes the rows of all, and then these do. */
static bool take_all(struct gm_system_scene *first, const struct gm_system_value *values)
{
    size_t rows = GM_COMMON_ROWS + GM_CAMERA_KEYS, observables = 1, number = 0;
    for (const struct gm_system_scene *other = first; other; other = other->next) {
        rows += other->row_count;
        observables += other->observable_count;
    }
    struct tables tables = {.rows = calloc(rows, sizeof *tables.rows),
                            .observables = calloc(observables, sizeof *tables.observables)};
    bool good = tables.rows && tables.observables;
    for (const struct gm_system_scene *other = first; good && other; other = other->next) {
        add(&tables, other);
    }
    for (size_t row = GM_SYSTEM_ROWS; good && row < first->row_count; row++) {
        if (builds(first, row) && tables.rows[row].type != GM_CHOICE) {
            tables.rows[row].lowest = first->system.variables[first->variables[row]].low;
            tables.rows[row].highest = first->system.variables[first->variables[row]].high;
        }
    }
    if (good) {
        memcpy(tables.rows + tables.row_count, first->common,
               (GM_COMMON_ROWS + GM_CAMERA_KEYS) * sizeof *tables.rows);
    }
    for (struct gm_system_scene *other = first; good && other; other = other->next) {
        good = take(other, first, &tables, &values[number++]);
    }
    free(tables.rows);
    free(tables.observables);
    return good;
}

bool gm_system_unite(struct gm_system_scene *first, gm_system_maker make, struct gm_fault *fault,
                     char *sentence)
{
    const struct gm_written_choices *choices = &first->system.choices;
    struct gm_system_value values[1 + GM_MOST_CHOICES * GM_MOST_CHOICE_WORDS] = {{"the usual values", ""}};
    struct gm_system_scene **last = &first->next;
    size_t count = 1, building = 0;
    for (size_t row = 0; row < first->row_count; row++) {
        building += builds(first, row);
    }
    for (size_t i = 0; i < choices->count; i++) {
        const struct gm_written_choice *choice = &choices->list[i];
        values[0] = (struct gm_system_value){choice->name, choice->words[choice->chosen]};
        for (size_t k = 0; k < choice->count; k++) {
            if (k == choice->chosen) {
                continue;
            }
            values[count] = (struct gm_system_value){choice->name, choice->words[k]};
            *last = make(first, &values[count++], 1, fault, sentence);
            if (!*last) {
                return false;
            }
            last = &(*last)->next;
        }
    }
    return building == 0 || take_all(first, values) || gm_refuse(sentence, "not enough memory");
}

/* Whether a system is that of a lane's values. */
static bool is_of(const struct gm_system_scene *other, const struct gm_system_lane *lane)
{
    for (size_t row = 0; row < other->row_count; row++) {
        if (builds(other, row) && gm_parameter_get(&other->rows[row], lane) !=
                                      gm_parameter_get(&other->rows[row], other->initial)) {
            return false;
        }
    }
    return true;
}

/* Makes one that there is not yet. */
static struct gm_system_scene *add_variant(struct gm_system_scene *first, const struct gm_system_lane *lane,
                                           gm_system_maker make, char *sentence)
{
    struct gm_system_value values[MOST_BUILDING];
    char texts[MOST_BUILDING][64];
    size_t count = 0;
    struct gm_fault fault = {0};
    for (size_t row = 0; row < first->row_count && count < MOST_BUILDING; row++) {
        if (builds(first, row)) {
            gm_parameter_format(&first->rows[row], lane, texts[count], sizeof texts[count]);
            values[count] = (struct gm_system_value){first->rows[row].key, texts[count]};
            count++;
        }
    }
    struct gm_system_scene *made = make(first, values, count, &fault, sentence);
    const struct tables tables = {first->rows, first->observables, first->row_count, first->observable_count};
    if (!made) {
        return NULL;
    }
    made->next = first->next;
    first->next = made;
    return take(made, first, &tables, &values[count - 1]) ? made : NULL;
}

bool gm_system_choose(struct gm_system_lane *lane, gm_system_maker make, char *sentence)
{
    struct gm_system_scene *first = lane->owner->first, *other = first;
    if (!first) {
        return true;
    }
    pthread_mutex_lock(&listing);
    while (other && !is_of(other, lane)) {
        other = other->next;
    }
    gm_refuse(sentence, "not enough memory");
    other = other ? other : add_variant(first, lane, make, sentence);
    pthread_mutex_unlock(&listing);
    lane->owner = other ? other : lane->owner;
    return other != NULL;
}
