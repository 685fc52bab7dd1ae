/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts with values, and requirements for a start. */
#include "scenes/common/system/texts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/scope.h"
#include "scenes/common/system/pieces.h"

enum { SIZE = 1024 };

/* The values of a text: of its formulas, of the scene's keys, and the name of the schemes. */
struct values {
    const double *numbers;
    const struct gm_system_lane *lane;
    const char *schemes, *minus;
};

/* A position in a text: the next byte, and the number of the next brace. */
struct place {
    const char *at;
    size_t brace;
};

/* Writes a fraction of `unit`, "2π/3" or "1/8"; false if its numbers are not small. */
static bool put_fraction(FILE *text, double value, double unit, const char *called)
{
    const double times = fabs(value / unit);
    for (int under = 1; under <= 10000; under++) {
        const double over = round(times * under);
        if (over > 10000 || over == 0 || fabs(over - times * under) > 1e-12 * over) {
            continue;
        }
        if (over != 1 || !called[0]) {
            fprintf(text, "%.0f", over);
        }
        fprintf(text, under > 1 ? "%s/%d" : "%s", called, under);
        return true;
    }
    return false;
}

static void put_number(FILE *text, double value, const char *format, const char *minus)
{
    static const struct {
        const char *format;
        double unit;
        const char *called, *otherwise; /* the unit after a fraction, and after other numbers */
    } units[] = {{"pi}", M_PI, "π", NULL}, {"T}", 2 * M_PI, "T", " T"}, {"/}", 1, "", NULL}};
    fputs(value < 0 ? minus : "", text);
    for (size_t i = 0; i < GM_COUNT(units) && isfinite(value) && value != 0; i++) {
        if (strcmp(format, units[i].format) != 0) {
            continue;
        }
        if (put_fraction(text, value, units[i].unit, units[i].called)) {
            return;
        }
        if (units[i].otherwise) {
            fprintf(text, "%.4g%s", fabs(value / units[i].unit), units[i].otherwise);
            return;
        }
    }
    fprintf(text, "%.4g", fabs(value));
}

/* Writes the value of the brace at `at`, which has that number. False if its part is left out. */
static bool put_brace(FILE *text, const struct values *values, const char *at, size_t number,
                      const struct gm_system_item *item)
{
    const size_t first = item->word == GM_WORD_REQUIRE, length = strcspn(at + 1, ":}"),
                 letters = strcspn(at + 1, "*:}");
    const gm_node_id node = item->nodes[first + number];
    char key[64], format[16] = "";
    snprintf(key, sizeof key, "%.*s", (int)(letters < 60 ? letters : 60), at + 1);
    if (at[1 + length] == ':') {
        snprintf(format, sizeof format, "%.*s", (int)strcspn(at + 2 + length, "}") + 1, at + 2 + length);
    }
    if (strcmp(key, "schemes") == 0 && node == GM_NO_NODE) {
        fputs(values->schemes, text);
        return true;
    }
    const struct gm_parameter *row = gm_scene_parameter(&values->lane->owner->scene, key);
    const bool timing = row && row < values->lane->owner->rows + GM_SYSTEM_ROWS;
    const double factor = node == GM_NO_NODE ? 1 : values->numbers[first + number],
                 value = node == GM_NO_NODE || timing ? factor * gm_parameter_get(row, values->lane) : factor;
    if (strcmp(format, "s}") == 0) {
        fputs(value == 1 ? "" : "s", text);
        return true;
    }
    put_number(text, value, format, values->minus);
    return strcmp(format, "nonzero}") != 0 || value != 0;
}

/* Writes the text from `place` to its end, or to the next `separator`, and moves after it. False if the part
   is left out. */
static bool write_part(struct place *place, char separator, const struct values *values,
                       const struct gm_system_item *item, char line[SIZE])
{
    bool shown = true;
    FILE *text = fmemopen(line, SIZE, "w");
    line[0] = '\0';
    while (*place->at && *place->at != separator) {
        if (*place->at != '{') {
            if (text) {
                fputc(*place->at, text);
            }
            place->at++;
            continue;
        }
        shown = text && put_brace(text, values, place->at, place->brace++, item) && shown;
        place->at += strcspn(place->at, "}") + 1;
    }
    place->at += *place->at != '\0';
    place->at += strspn(place->at, " ");
    return text && fclose(text) == 0 && shown;
}

static const struct gm_tape *tape_of(const struct gm_system_scene *system_scene,
                                     const struct gm_system_item *item)
{
    return &system_scene->of_items[item - system_scene->system.items];
}

/* ---- opening ---- */

/* Checks that keys in braces are keys of the scene. */
static void check_keys(const struct gm_system_scene *system_scene, const struct gm_system_item *item)
{
    const size_t first = item->word == GM_WORD_REQUIRE;
    const char *brace = strchr(item->text, '{');
    for (size_t k = first; k < item->count && brace; k++, brace = strchr(brace + 1, '{')) {
        char key[64];
        const size_t length = strcspn(brace + 1, ":}");
        snprintf(key, sizeof key, "%.*s", (int)(length < 60 ? length : 60), brace + 1);
        if (item->nodes[k] == GM_NO_NODE && strcmp(key, "schemes") != 0 &&
            !gm_scene_parameter(&system_scene->scene, key)) {
            gm_arena_refuse(system_scene->arena, "%s: {%s} is not a value of this system",
                            gm_system_words[item->word].word, key);
        }
    }
}

/* Opens the tape of an item: its formulas, then its option `while` or `unit`. */
static void open_item(struct gm_system_scene *system_scene, const struct gm_system_item *item,
                      struct gm_tape *tape)
{
    static const enum gm_system_option_word words[] = {GM_OPTION_WHILE, GM_OPTION_STEP_UNIT};
    gm_node_id *nodes = gm_arena_take(system_scene->arena, item->count + GM_COUNT(words), sizeof *nodes);
    size_t count = 0;
    for (; count < item->count; count++) {
        nodes[count] =
            item->nodes[count] == GM_NO_NODE ? 0 : item->nodes[count]; /* a key has a value elsewhere */
    }
    for (size_t k = 0; k < GM_COUNT(words); k++) {
        const struct gm_system_option *option = gm_system_option(item, words[k]);
        if (option) {
            nodes[count++] = option->node;
        }
    }
    if (count > 0) {
        gm_system_open_tape(system_scene, tape, nodes, count);
    }
}

void gm_system_open_items(struct gm_system_scene *system_scene)
{
    const struct gm_user_system *system = &system_scene->system;
    system_scene->of_items =
        gm_arena_take(system_scene->arena, system->item_count + 1, sizeof *system_scene->of_items);
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->text && item->word != GM_WORD_LEVEL) {
            check_keys(system_scene, item);
        }
        if (item->text || item->word == GM_WORD_STABILITY || item->word == GM_WORD_COLOURS ||
            item->word == GM_WORD_TIE) {
            open_item(system_scene, item, &system_scene->of_items[i]);
        }
    }
}

/* ---- writing ---- */

/* Returns the values of lane number `i`. */
static struct values values_of(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                               size_t i, const struct gm_system_item *item)
{
    const struct gm_view view = gm_lane_view(lanes[i]);
    double *numbers = gm_picture_memory(picture, (item->count + 1) * sizeof *numbers);
    gm_system_values(tape_of(gm_system_scene_of(&view), item), &view, gm_system_centre(&view), numbers);
    return (struct values){
        numbers, lanes[i]->parameters,
        gm_one_scheme(lanes, count) ? lanes[0]->scheme->title : gm_counted_schemes(lanes, count), "−"};
}

const char *gm_system_shown_text(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                                 enum gm_system_word word, const char *otherwise)
{
    const struct gm_system_lane *lane = lanes[0]->parameters;
    const struct gm_system_item *item = gm_system_item_of(&lane->owner->system, word, 0);
    if (!item) {
        return otherwise;
    }
    struct values *values = gm_picture_memory(picture, count * sizeof *values);
    size_t ahead = 0;
    for (size_t i = 0; i < count; i++) {
        const struct gm_system_scene *owner = ((const struct gm_system_lane *)lanes[i]->parameters)->owner;
        const struct gm_system_item *own = gm_system_item_of(&owner->system, word, 0);
        if (!own || strcmp(own->text, item->text) != 0) {
            return otherwise; /* another word of a choice has a text of its own */
        }
        values[i] = values_of(picture, lanes, count, i, own);
        ahead = fabs(lanes[i]->run->t) > fabs(lanes[ahead]->run->t) ? i : ahead;
    }
    const bool parts = word == GM_WORD_SUBTITLE;
    const char *text = "";
    for (struct place place = {.at = item->text}, next; *place.at; place = next) {
        char line[SIZE], other[SIZE];
        next = place;
        bool shown = write_part(&next, parts ? ';' : '\0', &values[ahead], item, line);
        for (size_t i = 0; i < count && parts && shown; i++) {
            struct place again = place;
            shown = write_part(&again, ';', &values[i], item, other) && strcmp(line, other) == 0;
        }
        text = shown ? gm_picture_text(picture, "%s%s%s", text, text[0] ? ",  " : "", line) : text;
    }
    return text;
}

void gm_system_graph(const struct gm_system_item *item, struct gm_graph *graph)
{
    const struct gm_system_option *range = gm_system_option(item, GM_OPTION_RANGE);
    graph->title = gm_system_option_text(item, GM_OPTION_TITLE, graph->title);
    graph->scale = gm_system_option(item, GM_OPTION_LOG) ? GM_LOG : GM_LINEAR;
    graph->highest = gm_system_option(item, GM_OPTION_HIGHEST) != NULL;
    graph->relative = gm_system_option(item, GM_OPTION_RELATIVE) != NULL;
    graph->magnitude = gm_system_option(item, GM_OPTION_MAGNITUDE) != NULL;
    graph->to_last = gm_system_option(item, GM_OPTION_TO_LAST) != NULL;
    graph->calm_low = range ? range->numbers[0] : 0;
    graph->calm_high = range ? range->numbers[1] : 0;
}

bool gm_system_is_admitted(const struct gm_system_lane *lane, const double *values, char *sentence)
{
    const struct gm_system_scene *system_scene = lane->owner;
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(&system_scene->system, GM_WORD_REQUIRE, i)); i++) {
        double *numbers = malloc(item->count * sizeof *numbers);
        char line[SIZE] = "not enough memory";
        struct place place = {.at = item->text};
        bool holds = false;
        if (numbers) {
            gm_tape_values(tape_of(system_scene, item), values, numbers, 1);
            holds = numbers[0] > 0;
            write_part(&place, '\0', &(struct values){numbers, lane, "the scheme", "-"}, item, line);
        }
        free(numbers);
        if (!holds) {
            return gm_refuse(sentence, "%s", line);
        }
    }
    return true;
}
