/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a system's scene, and the values that follow from others. */
#include "scenes/common/system/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/equations.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/common/written.h"

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

bool gm_system_settle(void *parameters, const char *const *keys, size_t count, char *sentence)
{
    struct settling settling = {parameters, keys, count};
    struct gm_arena *arena = gm_arena_open();
    const bool settled =
        gm_system_choose(parameters, sentence) &&
        (gm_arena_run(arena, settle, &settling) || gm_refuse(sentence, "%s", gm_arena_reason(arena)));
    gm_arena_close(arena);
    return settled;
}

const struct gm_scene *gm_system_variant(const void *parameters)
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

void gm_system_make_rows(struct gm_system_scene *system_scene, const struct gm_parameter *timing,
                         const struct gm_parameter *common, size_t count, bool typed)
{
    const struct gm_user_system *system = &system_scene->system;
    const size_t n = system->n, half = n / 2, parameters = system->velocities - system->parameters,
                 starts = gm_system_is_field(system) || gm_system_is_form(system) ? 0 : n;
    const size_t choices = system->choices.count, most = GM_SYSTEM_ROWS + choices + parameters + starts;
    struct gm_arena *arena = system_scene->arena;
    system_scene->rows = gm_arena_take(arena, most + count, sizeof *system_scene->rows);
    system_scene->variables = gm_arena_take(arena, most, sizeof *system_scene->variables);
    system_scene->initial =
        gm_arena_take(arena, 1, sizeof *system_scene->initial + most * (sizeof(double) + 1));
    const double *start = gm_arena_keep(arena, gm_equations_start(system, NULL), free);
    for (size_t i = 0; i < choices; i++) {
        system_scene->variables[GM_SYSTEM_ROWS + i] = GM_NO_VARIABLE;
        system_scene->rows[GM_SYSTEM_ROWS + i] = gm_written_choice(
            arena, system, i, "", offsetof(struct gm_system_lane, values) + i * sizeof(double));
    }
    size_t row = GM_SYSTEM_ROWS + choices;
    for (size_t i = 0; i < parameters + starts; i++) {
        const bool is_start = i >= parameters;
        size_t number = is_start ? i - parameters : system->parameters + i;
        if (is_start && system->variables[number].start == GM_NO_NODE) {
            number = system->velocities + number - half; /* it is the velocity that the file gives */
        }
        const struct gm_system_variable *variable = &system->variables[number];
        if (variable->derived) {
            continue;
        }
        system_scene->variables[row] = number;
        system_scene->rows[row] =
            gm_written_row(arena, variable, start[number], is_start ? "where it starts" : "a parameter",
                           offsetof(struct gm_system_lane, values) + (row - GM_SYSTEM_ROWS) * sizeof(double));
        system_scene->rows[row++].required = typed;
    }
    system_scene->row_count = row;
    system_scene->common = system_scene->rows + row;
    system_scene->common_count = count;
    memcpy(system_scene->rows, timing, GM_SYSTEM_ROWS * sizeof *timing);
    memcpy(system_scene->common, common, count * sizeof *common);
    system_scene->initial->owner = system_scene;
}

void gm_system_open_timing(struct gm_system_scene *system_scene, double numbers[GM_SYSTEM_TIMES])
{
    struct gm_arena *arena = system_scene->arena;
    const double *values = gm_arena_keep(arena, gm_system_start_values(system_scene->initial, NULL), free);
    for (size_t i = 0; i < GM_SYSTEM_TIMES; i++) {
        const struct gm_system_item *item =
            gm_system_item_of(&system_scene->system, (enum gm_system_word)((int)GM_WORD_DT + (int)i), 0);
        numbers[i] = NAN;
        if (item) {
            gm_system_open_tape(system_scene, &system_scene->timing[i], item->nodes, 1);
            gm_tape_values(&system_scene->timing[i], values, &numbers[i], 1);
        }
    }
    const double steps = numbers[GM_SYSTEM_TIMES - 1];
    if (steps < 0 || (isfinite(steps) && steps != floor(steps))) {
        gm_arena_refuse(arena, "steps: %.10g is not a whole number", steps);
    }
}
