/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes of systems and rooms, from files and from formulas. */
#include "app/words/system.h"
#include "app/words/typed_file.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/base/interrupt.h"
#include "app/words/words.h"
#include "core/expression/lines.h"
#include "core/expression/number.h"
#include "core/flow/room.h"
#include "core/memory.h"
#include "core/model/equations.h"
#include "render/message.h"
#include "scenes/common/system/variants.h"
#include "scenes/field/user_field.h"

const char gm_system_typed[] = "system";

static bool read_file(struct gm_typed_file *written, const struct gm_file *file, size_t most, char *message)
{
    written->path = file->path;
    written->text = written->source = gm_file_read(file, most, &written->size, message);
    written->length = written->size;
    return written->source;
}

int gm_system_open(struct gm_user_system *system, const struct gm_file *file,
                   const struct gm_arguments *arguments, const struct gm_system_value *values, size_t count,
                   char *message)
{
    struct gm_typed_file written = {.count = arguments->count, .words = arguments->words};
    struct gm_word_place place;
    struct gm_fault fault = {0};
    int status = GM_EXIT_OK;
    const unsigned long refusals = gm_memory_refusals();
    *system = (struct gm_user_system){0};
    if (file ? !read_file(&written, file, GM_LARGEST_SYSTEM, message)
             : !gm_typed_file_write(&written, &place, message)) {
        status = file ? GM_EXIT_FILE : GM_EXIT_USAGE;
        status = gm_memory_refusals() != refusals ? GM_EXIT_MEMORY : status;
    } else if (file && (!gm_lines_are_text(written.source, written.size, &fault) ||
                        !gm_typed_file_replace(&written, message))) {
        status = gm_typed_file_fault(&written, &fault, &place, message);
    } else if (!gm_equations_open(system, written.text, written.length, values, count, &fault) ||
               written.missing) {
        if (gm_memory_refusals() != refusals) { /* whatever else is blamed */
            fault = (struct gm_fault){0};
        }
        status = gm_typed_file_fault(&written, &fault, &place, message);
    }
    system->typed = !file;
    gm_typed_file_close(&written);
    return status;
}

/* ---- scenes ---- */

/* A scene with its words and text, or a text that a word means. They live as long as the program. */
struct gm_made_system {
    struct gm_made_system *next;
    char *key; /* the words and the text; for a text the word */
    char *text;
    struct gm_arguments words;
    char *name;
    const struct gm_scene *scene;
    void (*close)(const struct gm_scene *scene);
};
static struct gm_made_system *all_made, *all_texts;
static pthread_mutex_t making_one = PTHREAD_MUTEX_INITIALIZER;

static const struct gm_made_system *find_made(const struct gm_made_system *list, const char *key)
{
    while (list && strcmp(list->key, key) != 0) {
        list = list->next;
    }
    return list;
}

static void free_made(struct gm_made_system *made)
{
    if (made) {
        gm_arguments_close(&made->words);
        free(made->key);
        free(made->text);
        free(made->name);
        free(made);
    }
}

bool gm_system_recall(const char *word, const char *text)
{
    struct gm_made_system *made = calloc(1, sizeof *made);
    if (!made || !(made->key = strdup(word)) || !(made->text = strdup(text))) {
        free_made(made);
        return false;
    }
    made->next = all_texts;
    all_texts = made;
    return true;
}

bool gm_system_is(const char *word)
{
    return strcmp(word, gm_system_typed) == 0 || find_made(all_texts, word) ||
           gm_file_is(GM_FILE_ROOM, word) || gm_file_is(GM_FILE_SYSTEM, word);
}

const struct gm_scene *gm_scene_called(const char *word)
{
    const struct gm_scene *scene = gm_scene_find(word);
    for (size_t i = 0; !scene && i < gm_scene_count(); i++) {
        const bool called = strcasecmp(gm_scene_name(i), word) == 0 && !gm_system_is(word);
        scene = called ? gm_scene_at(i) : NULL;
    }
    return scene;
}

const struct gm_scene *gm_scene_of_words(int count, char *const words[])
{
    const struct gm_scene *scene = gm_scene_called(words[0]);
    const bool opened = scene && scene->parameter_count > 0;
    for (int i = 1; opened && scene && i < count; i++) {
        const char *key = gm_replacing_key(words[i]);
        scene = key && !gm_scene_parameter(scene, key) && gm_system_is(words[0]) ? NULL : scene;
    }
    return scene;
}

/* The file's name, without characters unusual in names. */
static char *name_of(const char *word, const char *ending)
{
    char *name = strdup(basename(word));
    if (name && gm_word_ends(name, ending)) {
        name[strlen(name) - strlen(ending)] = '\0';
    }
    for (char *at = name; at && *at; at++) {
        const bool usual =
            (*at >= '0' && *at <= '9') || (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z');
        *at = usual || strchr("-_.", *at) ? *at : '_';
    }
    return name;
}

/* A scene while it is made. */
struct making {
    struct gm_system_trial *trial;
    struct gm_typed_file written;
    struct gm_file file;
    bool room;
    struct gm_user_system first, system; /* the system as read, and with the values on which it is built */
    struct gm_system_value *values;
    size_t value_count;
    bool elsewhere; /* a field, with schemes that move its mesh or are for its equation alone */
    double until;   /* of the words; 0: none, or a list */
    double largest; /* the largest length of a list or a sum; 0: none */
    size_t largest_place;
    char largest_name[64];
    char *message;
};

/* Reports a fault of the text, with its exit status. Returns false. */
static bool refuse_text(struct making *making, const struct gm_fault *fault)
{
    making->trial->status =
        gm_typed_file_fault(&making->written, fault, &making->trial->place, making->message);
    return false;
}

/* The words on which the scene is built: formulas, and values for the graph. */
static bool choose_words(struct making *making)
{
    const struct gm_typed_file *written = &making->written;
    struct gm_arguments *words = &making->trial->made->words;
    const struct gm_user_system *system = &making->first;
    gm_arguments_add(words, written->words[0]);
    for (int i = 1; i < written->count; i++) {
        const char *word = written->words[i];
        bool chosen = gm_typed_file_has(written, i);
        for (size_t k = system->parameters; k < system->velocities; k++) {
            const char *name = system->variables[k].name;
            const char *value = system->variables[k].fixed ? gm_word_after(word, name) : NULL;
            if (value && gm_word_first(value) < strlen(value)) {
                making->trial->place = (struct gm_word_place){i, (size_t)(value - word)};
                return gm_refuse(making->message,
                                 "%s= takes one value: it is in an index, and the equations are built on it",
                                 name);
            }
            if (value) {
                making->values[making->value_count++] = (struct gm_system_value){name, value};
                chosen = true;
            }
        }
        gm_arguments_append(words, &written->words[i], chosen);
    }
    return !words->failed;
}

/* Finds the kind of a field's grid by the schemes that are given or, without one, are the file's. Returns false
   with a sentence if a field would be on both kinds of grids. */
static bool choose_grid(struct making *making)
{
    const char *schemes = making->first.texts[GM_WORD_SCHEMES];
    for (int i = 1; i < making->written.count; i++) {
        const char *typed = gm_word_after(making->written.words[i], "scheme");
        schemes = typed ? typed : schemes;
        typed = gm_word_after(making->written.words[i], "until");
        making->until = typed && !gm_number_parse(typed, &making->until) ? 0 : making->until;
    }
    size_t others;
    making->elsewhere = gm_user_field_elsewhere(&making->first, schemes, &others) > 0;
    return !making->elsewhere || others == 0 ||
           gm_refuse(making->message,
                     "some of these schemes %s, and others do not know how: a picture has one "
                     "kind of them",
                     making->first.kind == GM_FIELD ? "move their mesh" : "are for this equation alone");
}

/* The offset of the line that a sentence "word: fault" is about: a line with the next word of the
   sentence, or the value of the first one; 0: no line. */
static size_t line_of(const struct gm_typed_file *written, const char *sentence)
{
    const size_t word = strcspn(sentence, ": ");
    const char *wrong = sentence + word + strspn(sentence + word, ": ");
    size_t at = 0, first = 0; /* the value of the first such line */
    struct gm_text_line line;
    struct gm_fault fault;
    while (sentence[word] == ':' && gm_lines_next(written->text, written->length, &at, &line, &fault)) {
        if (line.word.end - line.word.begin != word ||
            memcmp(written->text + line.word.begin, sentence, word) != 0) {
            continue;
        }
        const char *value = written->text + line.value.begin;
        const char *found = memmem(value, line.value.end - line.value.begin, wrong, strcspn(wrong, " "));
        first = first > 0 ? first : line.value.begin;
        if (found && wrong[0]) {
            return (size_t)(found - written->text);
        }
    }
    return first;
}

/* Builds the equations of the read system with its values, and empties the read one. Then builds the
   scene. */
static bool open_system(struct making *making)
{
    struct gm_typed_file *written = &making->written;
    struct gm_made_system *made = making->trial->made;
    struct gm_fault fault;
    bool derived = making->room;
    if (making->room) {
        making->system = gm_room_unread(written->text, written->length);
    } else if (making->value_count > 0) {
        gm_formula_close(&making->first.graph); /* the names of the values stay */
        derived = gm_equations_open(&making->system, written->text, written->length, making->values,
                                    making->value_count, &fault);
    } else {
        making->system = making->first;
        making->first = (struct gm_user_system){0};
        derived = gm_equations_derive(&making->system, &fault);
    }
    if (!derived) {
        gm_system_close(&making->system);
        return refuse_text(making, &fault);
    }
    const char *const *words = (const char *const *)made->words.words;
    const bool inside = making->room && making->file.built_in;
    made->close = gm_system_scene_close;
    struct gm_system_opening opening = {.fault = &fault, .sentence = making->message};
    made->scene = gm_system_scene_open(&making->system,
                                       &(struct gm_system_origin){.name = made->name,
                                                                  .words = words,
                                                                  .path = inside ? NULL : written->path,
                                                                  .typed = !written->path,
                                                                  .elsewhere = making->elsewhere,
                                                                  .until = making->until},
                                       &opening);
    if (!made->scene && fault.sentence[0]) {
        return refuse_text(making, &fault);
    }
    fault =
        (struct gm_fault){.offset = made->scene || !written->path ? 0 : line_of(written, making->message)};
    if (fault.offset > 0) {
        snprintf(fault.sentence, sizeof fault.sentence, "%s", making->message);
        refuse_text(making, &fault);
    }
    making->trial->status = opening.unread ? GM_EXIT_FILE : making->trial->status;
    return made->scene != NULL;
}

/* Finds the largest of the numbers that lists and sums are as long as. */
static void find_largest(struct making *making)
{
    const struct gm_user_system *system = &making->first;
    for (size_t k = system->parameters; system->variables && k < system->velocities; k++) {
        const struct gm_system_variable *variable = &system->variables[k];
        double value = variable->value;
        for (size_t i = 0; i < making->value_count; i++) {
            const bool given = strcmp(making->values[i].name, variable->name) == 0;
            value = given ? strtod(making->values[i].text, NULL) : value;
        }
        if (variable->fixed && value > making->largest) {
            making->largest = value;
            making->largest_place = variable->start_place;
            snprintf(making->largest_name, sizeof making->largest_name, "%s", variable->name);
        }
    }
}

static void refuse_memory(struct making *making)
{
    struct gm_fault fault = {.offset = making->largest_place};
    snprintf(fault.sentence, sizeof fault.sentence, "not enough memory for %s = %.6g", making->largest_name,
             making->largest);
    if (making->largest > 0 && making->written.path) {
        refuse_text(making, &fault);
    } else {
        gm_refuse(making->message, "not enough memory%s",
                  making->largest > 0 ? " for lists and sums of this length" : "");
    }
    making->trial->status = GM_EXIT_MEMORY;
}

static void make(struct making *making)
{
    const struct gm_typed_file *written = &making->written;
    struct gm_made_system *made = making->trial->made;
    struct gm_fault fault;
    if (making->room) {
        gm_arguments_add(&made->words, written->words[0]);
    } else if (!gm_system_read(&making->first, written->text, written->length, NULL, 0, &fault) ||
               written->missing) {
        refuse_text(making, &fault);
        return;
    } else {
        const bool chosen = choose_grid(making) && choose_words(making);
        find_largest(making);
        if (!chosen) {
            return;
        }
    }
    char *words = gm_arguments_join("", &made->words);
    if (!words ||
        asprintf(&made->key, "%d %g %s\n%s", making->elsewhere, making->until, words, written->text) < 0) {
        made->key = NULL;
    }
    free(words);
    const struct gm_made_system *known = made->key ? find_made(all_made, made->key) : NULL;
    made->name = name_of(making->room ? making->file.path : written->words[0],
                         gm_file_endings[making->room ? GM_FILE_ROOM : GM_FILE_SYSTEM]);
    if (known) {
        making->trial->scene = known->scene;
    } else if (made->key && made->name && open_system(making)) {
        making->trial->scene = made->scene;
    }
}

static bool write_text(struct making *making)
{
    struct gm_typed_file *written = &making->written;
    const char *word = written->words[0];
    const struct gm_made_system *recalled = making->room ? NULL : find_made(all_texts, word);
    struct gm_fault fault;
    if (strcmp(word, gm_system_typed) == 0) {
        return gm_typed_file_write(written, &making->trial->place, making->message);
    }
    if (recalled) {
        snprintf(making->file.path, sizeof making->file.path, "%s", word);
        written->path = making->file.path;
        written->source = strdup(recalled->text);
        written->size = strlen(recalled->text);
        if (!written->source) {
            return gm_refuse(making->message, "not enough memory");
        }
    } else if (gm_file_find(making->room ? GM_FILE_ROOM : GM_FILE_SYSTEM, word, &making->file)) {
        making->trial->status = GM_EXIT_FILE;
        if (!read_file(written, &making->file, making->room ? GM_LARGEST_ROOM : GM_LARGEST_SYSTEM,
                       making->message)) {
            return false;
        }
    } else {
        return gm_refuse(making->message, "there is no system \"%.60s\"", word);
    }
    making->trial->status = GM_EXIT_USAGE;
    if (making->room) {
        return true;
    }
    if (!gm_lines_are_text(written->source, written->size, &fault)) { /* a zero byte ends strings early */
        return refuse_text(making, &fault);
    }
    return gm_typed_file_replace(written, making->message);
}

bool gm_system_try(struct gm_system_trial *trial, int count, char *const words[], char *message)
{
    struct making making = {.trial = trial, .written = {.count = count, .words = words}, .message = message};
    /* a system has precedence over a room of the same name */
    making.room = gm_file_is(GM_FILE_ROOM, words[0]) && !gm_file_is(GM_FILE_SYSTEM, words[0]);
    *trial = (struct gm_system_trial){.status = GM_EXIT_USAGE, .place = {.word = -1}};
    trial->made = calloc(1, sizeof *trial->made);
    making.values = calloc((size_t)count, sizeof *making.values);
    if (!trial->made || !making.values) {
        gm_refuse(message, "not enough memory");
    } else if (write_text(&making)) {
        const unsigned long refusals = gm_memory_refusals();
        pthread_mutex_lock(&making_one);
        make(&making);
        if (gm_memory_refusals() != refusals) { /* other faults, and incomplete results, may follow from it */
            if (trial->made->scene) {
                trial->made->close(trial->made->scene);
            }
            trial->scene = trial->made->scene = NULL;
            refuse_memory(&making);
        }
        pthread_mutex_unlock(&making_one);
    }
    gm_system_close(&making.first);
    free(making.values);
    gm_typed_file_close(&making.written);
    return trial->scene != NULL;
}

void gm_system_trial_close(struct gm_system_trial *trial)
{
    if (trial->made && trial->made->scene) {
        trial->made->close(trial->made->scene);
    }
    free_made(trial->made);
    *trial = (struct gm_system_trial){0};
}

void gm_system_trial_keep(struct gm_system_trial *trial)
{
    if (!trial->made || !trial->made->scene) {
        return;
    }
    pthread_mutex_lock(&making_one);
    trial->made->next = all_made;
    all_made = trial->made;
    pthread_mutex_unlock(&making_one);
    trial->made = NULL;
}

const struct gm_scene *gm_system_scene(int count, char *const words[], int *status, char *message)
{
    struct gm_system_trial trial;
    gm_system_try(&trial, count, words, message);
    const struct gm_scene *scene = trial.scene;
    *status = trial.status;
    gm_system_trial_keep(&trial);
    gm_system_trial_close(&trial);
    return scene;
}

/* ---- a system as it is now, with the values that its keys have ---- */

static bool is_changed(const struct gm_parameter *row, const void *parameters)
{
    char value[GM_TEXT_SIZE];
    return strcmp(gm_parameter_format(row, parameters, value, sizeof value), row->standard) != 0;
}

/* Puts the elements of a row's list, "x[1] = 2, x[2] = 3", or "2, 3" if the text has no indices; without a
   stream nothing. Returns true if a value differs from the text. */
static bool put_list(FILE *stream, const char *name, size_t length, bool named, const struct gm_scene *scene,
                     const void *parameters)
{
    bool changed = false;
    const char *before = "";
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        char value[GM_TEXT_SIZE];
        if (strncmp(row->key, name, length) != 0 || row->key[length] != '[') {
            continue;
        }
        changed = changed || is_changed(row, parameters);
        if (stream) {
            fprintf(stream, "%s%s%s%s", before, named ? "" : row->key, named ? "" : " = ",
                    gm_parameter_format(row, parameters, value, sizeof value));
            before = ", ";
        }
    }
    return changed;
}

/* Puts "NAME = formula" pairs, with the value instead of the formula if it is not the default. Returns
   their end. */
static size_t put_values(FILE *stream, const char *text, struct gm_span pairs, const struct gm_scene *scene,
                         const void *parameters)
{
    struct gm_span piece;
    size_t from = pairs.begin;
    for (struct gm_span rest = pairs; gm_span_take(text, &rest, ",", &piece);) {
        const char *pair = text + piece.begin;
        const size_t name = gm_name_length(pair, piece.end - piece.begin);
        const size_t index = pair[name] == '[' ? strcspn(pair + name, "]") + 1 : 0;
        const bool is_list = index > 0 && memmem(pair + name, index, "..", 2);
        if (is_list) { /* "m[1..N] = 1, 2, 3" holds its commas */
            piece.end = pairs.end;
            rest.begin = rest.end;
        }
        char key[64], value[GM_TEXT_SIZE];
        snprintf(key, sizeof key, "%.*s", (int)(name + index), pair);
        const struct gm_parameter *row = name > 0 ? gm_scene_parameter(scene, key) : NULL;
        const bool one = row && is_changed(row, parameters);
        const bool all = !row && index > 0 && put_list(NULL, pair, name, is_list, scene, parameters);
        fwrite(text + from, 1, (one || all ? piece.begin : piece.end) - from, stream);
        if (one || (all && is_list)) {
            fprintf(stream, "%s = %s", key,
                    one ? gm_parameter_format(row, parameters, value, sizeof value) : "");
        }
        if (all) {
            put_list(stream, pair, name, is_list, scene, parameters);
        }
        from = piece.end;
    }
    return from;
}

/* The words of a list, after the one that comes first. */
static void put_others(FILE *stream, const char *text, struct gm_span value, const char *first)
{
    for (size_t at = value.begin, length; at < value.end; at += length + 1) {
        length = strcspn(text + at, " \t,;#\n");
        if (length > 0 && (strlen(first) != length || strncmp(text + at, first, length) != 0)) {
            fprintf(stream, " %.*s", (int)length, text + at);
        }
    }
}

char *gm_system_now(const struct gm_scene *scene, const void *parameters, const char *scheme)
{
    /* before lanes: of one number, which a key sets; after them: of values */
    enum { DT, MEMBERS = 2, LANES = 5, PARAMETER, START, SPREAD, SCHEMES };
    static const char *const lines[] = {"dt",        "until", "members", "half_length", "points", "lanes",
                                        "parameter", "start", "spread",  "schemes",     NULL};
    const struct gm_parameter *rows[LANES];
    bool put[LANES];
    char number[GM_TEXT_SIZE];
    size_t at = 0, from = 0;
    struct gm_text_line line;
    struct gm_fault fault;
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    for (size_t i = 0; i < LANES; i++) {
        rows[i] = gm_scene_parameter(scene, lines[i]);
        put[i] = rows[i] && is_changed(rows[i], parameters);
    }
    bool has_dt = !rows[DT]; /* a step size from a word or the formula has no line */
    if (stream && !strstr(scene->text, "geomint:")) {
        fputs("geomint: 1\n", stream);
    }
    while (stream && gm_lines_next(scene->text, strlen(scene->text), &at, &line, &fault)) {
        const size_t i = gm_span_among(scene->text, line.word, lines);
        const size_t values = line.value.begin + strcspn(scene->text + line.value.begin, ";#");
        const struct gm_span value =
            gm_span_trimmed(scene->text, (struct gm_span){line.value.begin,
                                                          values < line.value.end ? values : line.value.end});
        has_dt = has_dt || i == DT;
        if (i == SCHEMES && scheme) {
            fwrite(scene->text + from, 1, value.begin - from, stream);
            fputs(scheme, stream);
            put_others(stream, scene->text, value, scheme);
            from = value.end;
            scheme = NULL;
        } else if (i == LANES) { /* the words of lanes are one lane's */
            fwrite(scene->text + from, 1, line.word.begin - from, stream);
            from = at;
        } else if (i == PARAMETER || i == START ||
                   ((i == MEMBERS || i == SPREAD) &&
                    memchr(scene->text + value.begin, '=', value.end - value.begin))) {
            fwrite(scene->text + from, 1, value.begin - from, stream);
            from = put_values(stream, scene->text, value, scene, parameters);
            const size_t length = gm_name_length(scene->text + value.begin, value.end - value.begin);
            const struct gm_span key = {value.begin, value.begin + length};
            const size_t called = gm_span_among(scene->text, key, lines);
            if (called < LANES) {
                put[called] = false; /* a key of the system, called as the line of a field */
            }
        } else if (i < LANES && put[i]) { /* the range stays */
            fwrite(scene->text + from, 1, value.begin - from, stream);
            fputs(gm_parameter_format(rows[i], parameters, number, sizeof number), stream);
            from = value.end;
            put[i] = false;
        }
    }
    if (stream) {
        fputs(scene->text + from, stream);
    }
    for (size_t i = 0; stream && i < LANES; i++) {
        if (put[i] || (i == DT && !has_dt)) {
            fprintf(stream, "%s: %s\n", lines[i],
                    gm_parameter_format(rows[i], parameters, number, sizeof number));
        }
    }
    if (stream && scheme) {
        fprintf(stream, "schemes: %s\n", scheme);
    }
    return gm_stream_end(&writing);
}
