/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scenes that are made of systems, of files and of formulas. */
#include "app/words/system.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/exit.h"
#include "app/base/files.h"
#include "app/base/place.h"
#include "app/words/lines.h"
#include "app/words/replacing.h"
#include "app/words/room.h"
#include "app/words/worded.h"
#include "core/expression/reader.h"
#include "core/memory.h"
#include "core/model/equations.h"
#include "core/model/reader.h"
#include "render/message.h"
#include "scenes/field/user_field.h"
#include "scenes/ode/system.h"

const char gm_system_typed[] = "system";

/* The exit status, and the sentence: where memory was short, that, whatever else is blamed. */
static int lines_fault(const struct gm_system_lines *written, char *const words[], struct gm_fault *fault,
                       unsigned long refusals, struct gm_word_place *place, char *message)
{
    if (gm_memory_refusals() != refusals) {
        *fault = (struct gm_fault){0};
    }
    return gm_system_lines_fault(written, words, fault, place, message);
}

int gm_system_open(struct gm_user_system *system, const struct gm_file *file,
                   const struct gm_system_value *values, size_t count, char *message)
{
    size_t length = 0;
    const unsigned long refusals = gm_memory_refusals();
    char *text = gm_system_lines_read(file, &length, message);
    *system = (struct gm_user_system){0};
    if (!text) {
        return gm_memory_refusals() != refusals ? GM_EXIT_MEMORY : GM_EXIT_FILE;
    }
    struct gm_fault fault;
    struct gm_word_place place;
    struct gm_system_lines written = {.path = file->path, .text = text, .length = length};
    int status = GM_EXIT_OK;
    if (!gm_equations_open(system, text, length, values, count, &fault)) {
        status = lines_fault(&written, NULL, &fault, refusals, &place, message);
    }
    gm_system_lines_close(&written);
    return status;
}

int gm_system_open_typed(struct gm_user_system *system, int count, char *const words[], char *message)
{
    struct gm_system_lines written = {0};
    struct gm_word_place place;
    struct gm_fault fault;
    int status = GM_EXIT_OK;
    const unsigned long refusals = gm_memory_refusals();
    *system = (struct gm_user_system){0};
    if (!gm_worded_write(&written, count, words, &place, message)) {
        status = gm_memory_refusals() != refusals ? GM_EXIT_MEMORY : GM_EXIT_USAGE;
    } else if (!gm_equations_open(system, written.text, written.length, NULL, 0, &fault)) {
        status = lines_fault(&written, words, &fault, refusals, &place, message);
    }
    system->typed = true;
    gm_system_lines_close(&written);
    return status;
}

/* ---- scenes ---- */

/* A scene that was made, and what of; or a text that a word means. They live as long as the program. */
struct gm_made_system {
    struct gm_made_system *next;
    char *key; /* the words and the text; of a text the word */
    char *text;
    struct gm_arguments words;
    char *name;
    const struct gm_scene *scene;
    void (*close)(const struct gm_scene *scene);
};
static struct gm_made_system *all_made, *all_texts;
static pthread_mutex_t making = PTHREAD_MUTEX_INITIALIZER;

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

/* The file's name, without what no file's name should have. */
static char *name_of(const char *word)
{
    const char *slash = strrchr(word, '/');
    char *name = strdup(slash ? slash + 1 : word);
    const char *ending = gm_file_endings[GM_FILE_SYSTEM];
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

/* Of the words those that the scene is made of: formulas, and values that the graph is built on. */
static bool choose_words(struct gm_made_system *made, const struct gm_user_system *system, bool typed,
                         int count, char *const words[], struct gm_system_value *values, size_t *value_count,
                         struct gm_word_place *place, char *message)
{
    bool good = gm_arguments_add(&made->words, words[0]);
    for (int i = 1; i < count && good; i++) {
        const size_t length = strcspn(words[i], "=");
        for (size_t k = 0; gm_worded_keys[k] && typed && good; k++) {
            if (gm_word_after(words[i], gm_worded_keys[k], strlen(gm_worded_keys[k]))) {
                good = gm_arguments_add(&made->words, words[i]);
            }
        }
        if (!typed && gm_replacing_has(system->source, words[i])) {
            good = gm_arguments_add(&made->words, words[i]);
        }
        for (size_t k = system->parameters; k < system->velocities && good && words[i][length]; k++) {
            const struct gm_system_variable *variable = &system->variables[k];
            if (!variable->fixed || !gm_word_after(words[i], variable->name, strlen(variable->name))) {
                continue;
            }
            const char *value = words[i] + length + 1;
            if (gm_word_first(value) < strlen(value)) {
                *place = (struct gm_word_place){i, length + 1};
                return gm_refuse(message,
                                 "%s= takes one value: it is in an index, and the equations are built on it",
                                 variable->name);
            }
            values[*value_count] = (struct gm_system_value){variable->name, value};
            ++*value_count;
            good = gm_arguments_add(&made->words, words[i]);
        }
    }
    return good || gm_refuse(message, "not enough memory");
}

/* Where the text has the line that a sentence "word: what is wrong" is about: the next word of the sentence in such a
   line, or the value of the first one; 0: nowhere. */
static size_t line_told(const char *text, const char *sentence)
{
    const size_t word = strcspn(sentence, ": ") + 1;
    const char *line = sentence[word - 1] == ':' ? text : NULL;
    const char *wrong = sentence + word + strspn(sentence + word, " ");
    const size_t length = strcspn(wrong, " ");
    size_t first = 0; /* the value of the first such line */
    for (const char *next; line; line = next) {
        next = strchr(line, '\n');
        next += next != NULL;
        if (strncmp(line, sentence, word) != 0) {
            continue;
        }
        const char *value = line + word + strspn(line + word, " \t");
        const size_t capacity = strcspn(value, "\n");
        first = first > 0 ? first : (size_t)(value - text);
        for (size_t i = 0; length > 0 && i + length <= capacity; i++) {
            if (strncmp(value + i, wrong, length) == 0) {
                return (size_t)(value + i - text);
            }
        }
    }
    return first;
}

/* The equations of a system that was read, with the values that these are built on. What was read is emptied. */
static bool derive(struct gm_user_system *system, struct gm_user_system *first,
                   const struct gm_system_lines *written, const struct gm_system_value *values, size_t count,
                   struct gm_fault *fault)
{
    if (count > 0) {
        gm_formula_close(&first->graph); /* the names of the values stay */
        return gm_equations_open(system, written->text, written->length, values, count, fault);
    }
    *system = *first;
    *first = (struct gm_user_system){0};
    return gm_equations_derive(system, fault);
}

/* Whether a scheme of moving meshes is asked for, or, where none is, is the file's: *moves. False with a sentence
   where a field would be on both kinds of grids. */
static bool choose_mesh(const struct gm_user_system *system, int count, char *const words[], bool *moves,
                        char *message)
{
    static const char key[] = "scheme=";
    const char *schemes = system->texts[GM_WORD_SCHEMES];
    for (int i = 1; i < count; i++) {
        if (strncmp(words[i], key, strlen(key)) == 0) {
            schemes = words[i] + strlen(key);
        }
    }
    size_t others;
    *moves = system->kind == GM_FIELD && gm_user_field_moving(schemes, &others) > 0;
    return !*moves || others == 0 ||
           gm_refuse(message,
                     "some of these schemes move their mesh, and others do not know how: a picture has one "
                     "kind of them");
}

/* The largest of the numbers that lists and sums are as long as, and where the text says it; name "": there is
   none. */
struct largest {
    char name[64];
    double value;
    size_t place;
};

/* Where the text gives a parameter its value; 0: nowhere. */
static size_t place_of_parameter(const char *text, const char *name)
{
    static const char word[] = "parameter:";
    for (const char *line = text; line; line = strchr(line, '\n')) {
        line += *line == '\n';
        const char *value = line + strlen(word);
        if (strncmp(line, word, strlen(word)) == 0) {
            value += strspn(value, " \t");
            const size_t length = strlen(name);
            if (strncmp(value, name, length) == 0 && strchr(" \t=", value[length])) {
                return (size_t)(value - text);
            }
        }
    }
    return 0;
}

static struct largest find_largest(const struct gm_user_system *system, const char *text,
                                   const struct gm_system_value *values, size_t count)
{
    struct largest largest = {.value = 0};
    for (size_t k = system->parameters; system->variables && k < system->velocities; k++) {
        const struct gm_system_variable *variable = &system->variables[k];
        double value = variable->value;
        for (size_t i = 0; i < count; i++) {
            value = strcmp(values[i].name, variable->name) == 0 ? strtod(values[i].text, NULL) : value;
        }
        if (variable->fixed && value > largest.value) {
            largest.value = value;
            largest.place = place_of_parameter(text, variable->name);
            snprintf(largest.name, sizeof largest.name, "%s", variable->name);
        }
    }
    return largest;
}

/* Says what there is not enough memory for. */
static void tell_memory(const struct gm_system_lines *written, const struct largest *largest, char *message)
{
    if (!largest->name[0] || !written->path) {
        gm_refuse(message, "not enough memory%s",
                  largest->name[0] ? " for lists and sums of this length" : "");
        return;
    }
    size_t line, column;
    gm_text_place(written->text, largest->place, &line, &column);
    gm_refuse(message, "%.150s:%zu:%zu: not enough memory for %.60s = %.6g", written->path, line, column,
              largest->name, largest->value);
    gm_place_show(written->text, written->length, largest->place, message);
}

/* Makes a scene of the lines, or finds the one that was kept. */
static bool make(struct gm_made_system *made, const struct gm_system_lines *written, int count,
                 char *const words[], struct gm_system_trial *trial, char *message)
{
    struct gm_user_system first, system;
    struct gm_fault fault;
    const bool typed = !written->path;
    bool moves = false;
    const unsigned long refusals = gm_memory_refusals();
    struct gm_system_value *values = calloc((size_t)count, sizeof *values);
    size_t value_count = 0;
    if (!values) {
        trial->status = GM_EXIT_MEMORY;
        return gm_refuse(message, "not enough memory");
    }
    const bool read = gm_system_read(&first, written->text, written->length, NULL, 0, &fault);
    struct largest largest = find_largest(&first, written->text, NULL, 0);
    if (!read) {
        trial->status = gm_system_lines_fault(written, words, &fault, &trial->place, message);
    } else if (choose_mesh(&first, count, words, &moves, message) &&
               choose_words(made, &first, typed, count, words, values, &value_count, &trial->place,
                            message)) {
        largest = find_largest(&first, written->text, values, value_count);
        char *all = gm_arguments_join("", &made->words);
        if (!all || asprintf(&made->key, "%d %s\n%s", moves, all, written->text) < 0) {
            made->key = NULL;
        }
        free(all);
        const struct gm_made_system *known = made->key ? find_made(all_made, made->key) : NULL;
        made->name = name_of(words[0]);
        if (known) {
            trial->scene = known->scene;
        } else if (!made->key || !made->name) {
            gm_refuse(message, "not enough memory");
        } else if (!derive(&system, &first, written, values, value_count, &fault)) {
            trial->status = gm_system_lines_fault(written, words, &fault, &trial->place, message);
            gm_system_close(&system);
        } else if (gm_arguments_end(&made->words)) {
            const char *const *own = (const char *const *)made->words.words;
            const bool field = gm_system_is_field(&system);
            made->close = field ? gm_user_field_close : gm_system_scene_close;
            trial->scene = made->scene = field
                                             ? gm_user_field_open(&system, made->name, own, moves, message)
                                             : gm_system_scene_open(&system, made->name, own, typed, message);
            fault.offset = trial->scene || typed ? 0 : line_told(written->text, message);
            if (fault.offset > 0) {
                snprintf(fault.sentence, sizeof fault.sentence, "%s", message);
                trial->status = gm_system_lines_fault(written, words, &fault, &trial->place, message);
            }
        } else {
            gm_system_close(&system);
            trial->status = GM_EXIT_MEMORY;
            gm_refuse(message, "not enough memory");
        }
    }
    gm_system_close(&first);
    free(values);
    if (gm_memory_refusals() != refusals) { /* whatever else was blamed, and what is only there in part */
        if (made->scene) {
            made->close(made->scene);
        }
        trial->scene = made->scene = NULL;
        trial->status = GM_EXIT_MEMORY;
        tell_memory(written, &largest, message);
    }
    return trial->scene != NULL;
}

/* The lines that the words mean. */
static bool write_lines(struct gm_system_lines *written, struct gm_file *file, int count, char *const words[],
                        struct gm_system_trial *trial, char *message)
{
    const struct gm_made_system *recalled = find_made(all_texts, words[0]);
    if (strcmp(words[0], gm_system_typed) == 0) {
        return gm_worded_write(written, count, words, &trial->place, message);
    }
    written->path = file->path;
    if (recalled) {
        written->text = strdup(recalled->text);
        written->length = strlen(recalled->text);
        snprintf(file->path, sizeof file->path, "%s", words[0]);
    } else if (gm_file_find(GM_FILE_SYSTEM, words[0], file)) {
        trial->status = GM_EXIT_FILE;
        written->text = gm_system_lines_read(file, &written->length, message);
    } else {
        return gm_refuse(message, "there is no system \"%.60s\"", words[0]);
    }
    if (!written->text) {
        return recalled ? gm_refuse(message, "not enough memory") : false;
    }
    if (written->length > GM_LARGEST_SYSTEM ||
        gm_text_valid(written->text, written->length) < written->length) {
        /* what is too long was not read, what is no text ends strings early: the reader says so */
        struct gm_user_system system;
        struct gm_fault fault;
        if (!gm_system_read(&system, written->text, written->length, NULL, 0, &fault)) {
            trial->status = gm_system_lines_fault(written, words, &fault, &trial->place, message);
        }
        gm_system_close(&system);
        return false;
    }
    return gm_replacing_lines(written, count, words) || gm_refuse(message, "not enough memory");
}

bool gm_system_try(struct gm_system_trial *trial, int count, char *const words[], char *message)
{
    struct gm_file file;
    struct gm_system_lines written = {0};
    *trial = (struct gm_system_trial){.status = GM_EXIT_USAGE, .place = {.word = -1}};
    if (gm_file_is(GM_FILE_ROOM, words[0]) && !gm_file_is(GM_FILE_SYSTEM, words[0])) {
        trial->scene = gm_room_scene(words[0], &trial->status, message);
        return trial->scene != NULL;
    }
    struct gm_made_system *made = calloc(1, sizeof *made);
    trial->made = made;
    bool good = made || gm_refuse(message, "not enough memory");
    good = good && write_lines(&written, &file, count, words, trial, message);
    if (good) {
        trial->status = GM_EXIT_USAGE;
        pthread_mutex_lock(&making);
        good = make(made, &written, count, words, trial, message);
        pthread_mutex_unlock(&making);
    }
    gm_system_lines_close(&written);
    return good;
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
    pthread_mutex_lock(&making);
    trial->made->next = all_made;
    all_made = trial->made;
    pthread_mutex_unlock(&making);
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

const char *const *gm_system_keys(const char *word)
{
    return strcmp(word, gm_system_typed) == 0 ? gm_worded_keys : gm_replacing_keys;
}
