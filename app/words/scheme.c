/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes that are brought along: read from files and words, and told from each other by what they say. */
#include "app/words/scheme.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/base/exit.h"
#include "app/base/files.h"
#include "app/base/place.h"
#include "core/expression/nearest.h"
#include "core/expression/reader.h"
#include "core/memory.h"
#include "core/schemes.h"
#include "render/cells/text.h"
#include "render/files/regular_file.h"

static bool is_path(const char *name)
{
    return gm_word_ends(name, gm_file_endings[GM_FILE_SCHEME]);
}

/* Whether what stands for a scheme's name means one's own: a path that ends with .scheme, or a word such as
   composition(verlet; g, 1 - 2*g, g). */
static bool is_user(const char *name)
{
    return is_path(name) || gm_written_is_word(name, strlen(name));
}

enum { DEEPEST = 8 };

/* Files that are being read, each named by the one before. */
struct reading {
    const struct reading *by;
    const char *path;
    bool unreadable;
    char message[GM_MESSAGE];
};

static const struct gm_scheme *read_file(const char *name, const struct gm_file *file,
                                         struct reading *reading);

/* A file that a file names is found from the folder of that one. */
static const struct gm_scheme *bring(void *data, const char *name, char *sentence)
{
    struct reading *by = data, reading = {.by = by};
    const char *slash = by->path ? strrchr(by->path, '/') : NULL;
    struct gm_file file = {0};
    char *path = file.path;
    const int folder = slash && name[0] != '/' ? (int)(slash - by->path) + 1 : 0;
    sentence[0] = '\0';
    if (snprintf(path, sizeof file.path, "%.*s%s", folder, by->path ? by->path : "", name) >=
        (int)sizeof file.path) {
        snprintf(sentence, GM_FAULT_SENTENCE, "the path is too long");
        return NULL;
    }
    reading.path = path;
    struct stat here, there;
    const bool found = stat(path, &here) == 0;
    int depth = 0;
    for (const struct reading *before = by; before; before = before->by, depth++) {
        if (found && before->path && stat(before->path, &there) == 0 && here.st_dev == there.st_dev &&
            here.st_ino == there.st_ino) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%.200s is made of itself", name);
            return NULL;
        }
    }
    if (depth > DEEPEST) {
        snprintf(sentence, GM_FAULT_SENTENCE, "files name files at most %d deep", DEEPEST);
        return NULL;
    }
    const struct gm_scheme *scheme = read_file(path, &file, &reading);
    if (!scheme) {
        by->unreadable = reading.unreadable;
        const char *line = strchr(reading.message, '\n');
        snprintf(sentence, GM_FAULT_SENTENCE, "%.*s",
                 line ? (int)(line - reading.message) : GM_FAULT_SENTENCE - 1, reading.message);
    }
    return scheme;
}

/* The one that says the same under that name, or the new one. */
static const struct gm_scheme *keep(const struct gm_scheme *made, struct reading *reading)
{
    const struct gm_scheme *known = gm_scheme_find(made->name);
    if (known && known->word && strcmp(known->word, made->word) == 0) {
        gm_user_scheme_close(made);
        return known;
    }
    if (!gm_scheme_bring(made)) {
        gm_user_scheme_close(made);
        gm_refuse(reading->message, "not enough memory");
        return NULL;
    }
    return made;
}

/* What is wrong, and where: in a file its line and column, in a word the column. */
static void tell(const struct gm_user_scheme_source *source, const struct gm_fault *fault,
                 struct reading *reading)
{
    size_t line, column;
    if (!fault->sentence[0]) {
        gm_refuse(reading->message, "not enough memory");
        return;
    }
    gm_text_place(source->text, fault->offset, &line, &column);
    if (reading->path) {
        gm_refuse(reading->message, "%.120s:%zu:%zu: %.250s", reading->path, line, column, fault->sentence);
    } else {
        gm_refuse(reading->message, "scheme, column %zu: %.250s", column, fault->sentence);
    }
    gm_place_show(source->text, source->length, fault->offset, reading->message);
}

static const struct gm_scheme *read_text(const struct gm_user_scheme_source *source, struct reading *reading)
{
    struct gm_fault fault;
    const struct gm_scheme *made = gm_user_scheme_open(source, &fault);
    if (!made) {
        tell(source, &fault, reading);
        return NULL;
    }
    return keep(made, reading);
}

/* What a file says, as a source; the text is to be freed. NULL with a message. */
struct file {
    char *text, title[64];
    struct gm_user_scheme_source source;
};

static bool open_file(struct file *file, const char *name, const struct gm_file *from,
                      struct reading *reading)
{
    char reason[GM_REGULAR_REASON];
    size_t length = 0;
    file->text = gm_file_read(from, GM_LARGEST_SCHEME, &length, reason);
    if (!file->text) {
        reading->unreadable = true;
        return gm_refuse(reading->message, "%.300s could not be read: %s", from->path, reason);
    }
    const char *slash = strrchr(from->path, '/'), *base = slash ? slash + 1 : from->path;
    /* a title, without what ends one where the scheme is one word, and no half letter */
    size_t letters = strlen(base) - strlen(gm_file_endings[GM_FILE_SCHEME]);
    letters = letters < sizeof file->title ? letters : sizeof file->title - 1;
    while (letters > 0 && ((unsigned char)base[letters] & 0xC0) == 0x80) {
        letters--;
    }
    for (size_t i = 0; i < letters; i++) {
        file->title[i] = (char)(strchr(";()#", base[i]) ? '-' : base[i]);
    }
    file->title[letters] = '\0';
    const size_t skipped = gm_text_has_mark(file->text, length) ? GM_TEXT_MARK : 0;
    file->source = (struct gm_user_scheme_source){.text = file->text + skipped,
                                                  .length = length - skipped,
                                                  .name = name,
                                                  .title = file->title,
                                                  .part = reading->by != NULL,
                                                  .bring = bring,
                                                  .data = reading};
    return true;
}

static const struct gm_scheme *read_file(const char *name, const struct gm_file *from,
                                         struct reading *reading)
{
    struct file file;
    if (!open_file(&file, name, from, reading)) {
        return NULL;
    }
    const struct gm_scheme *scheme = read_text(&file.source, reading);
    free(file.text);
    return scheme;
}

char *gm_scheme_polished(const char *name, struct gm_polish *polish, bool *unreadable, char *message)
{
    struct gm_file from;
    const bool path = is_path(name) && gm_file_find(GM_FILE_SCHEME, name, &from);
    struct reading reading = {.path = path ? from.path : NULL};
    struct file file = {
        .source = {.text = name, .length = strlen(name), .name = name, .bring = bring, .data = &reading}};
    char *text = NULL;
    if (!gm_text_is_plain(name)) {
        gm_refuse(reading.message, "the scheme's name holds a character that cannot be shown");
    } else if (!is_user(name)) {
        gm_refuse(reading.message, "--polish takes a file or a word, not a scheme of the program");
    } else if (!reading.path || open_file(&file, name, &from, &reading)) {
        struct gm_fault fault;
        text = gm_user_scheme_polish(&file.source, polish, &fault);
        if (!text) {
            tell(&file.source, &fault, &reading);
        }
    }
    free(file.text);
    *unreadable = reading.unreadable;
    memcpy(message, reading.message, sizeof reading.message);
    return text;
}

static const char *kind_name(size_t i, const void *data)
{
    return (void)data, gm_written_kind_name((enum gm_written_kind)i);
}

/* A word whose kind there is not: which may be meant. */
static void tell_kind(const char *word, char *message)
{
    char kind[40];
    const size_t length = strcspn(word, "(");
    if (word[length] == '\0' || length == 0 || length >= sizeof kind) {
        return;
    }
    memcpy(kind, word, length);
    kind[length] = '\0';
    const char *near = gm_nearest(kind, GM_WRITTEN_KINDS, kind_name, NULL);
    gm_refuse(message, "there is no kind of scheme \"%s(...)\"%s%s%s", kind, near ? "; did you mean " : "",
              near ? near : "", near ? "(...)" : "; docs/own-schemes.md names them");
}

const struct gm_scheme *gm_scheme_named(const char *name, bool *unreadable, char *message)
{
    struct reading reading = {.by = NULL};
    if (!gm_text_is_plain(name)) {
        gm_refuse(message, "the scheme's name holds a character that cannot be shown");
        *unreadable = false;
        return NULL;
    }
    struct gm_file file;
    const struct gm_scheme *scheme = is_path(name) ? NULL : gm_scheme_find(name);
    if (!scheme && gm_file_find(GM_FILE_SCHEME, name, &file)) {
        reading.path = file.path;
        scheme = read_file(name, &file, &reading);
    } else if (!scheme && is_user(name)) {
        const struct gm_user_scheme_source source = {
            .text = name, .length = strlen(name), .name = name, .bring = bring, .data = &reading};
        scheme = read_text(&source, &reading);
    } else if (!scheme && gm_files_folder_opens(GM_FILE_SCHEME, reading.message)) {
        tell_kind(name, reading.message);
    } else if (!scheme) {
        reading.unreadable = true;
    }
    *unreadable = reading.unreadable;
    memcpy(message, reading.message, sizeof reading.message);
    return scheme;
}

const struct gm_scheme *gm_scheme_sought(const char *name, int *status, char *message)
{
    bool unreadable = false;
    const unsigned long refusals = gm_memory_refusals();
    const struct gm_scheme *scheme = gm_scheme_named(name, &unreadable, message);
    if (!scheme && !message[0]) {
        const char *near = gm_scheme_near(name);
        gm_refuse(message, "there is no scheme \"%.60s\"%s%s", name,
                  near ? "; did you mean " : "; see geomint list schemes", near ? near : "");
    }
    *status = scheme                             ? GM_EXIT_OK
              : gm_memory_refusals() != refusals ? GM_EXIT_MEMORY
              : unreadable                       ? GM_EXIT_FILE
                                                 : GM_EXIT_USAGE;
    return scheme;
}

char *gm_scheme_words_from(const char *path, const char *word)
{
    static const char key[] = "scheme=";
    const char *ending = gm_file_endings[GM_FILE_SCHEME];
    const size_t end_length = strlen(ending);
    const char *slash = strrchr(path, '/');
    char *text = NULL;
    size_t size = 0;
    if (!slash || strncmp(word, key, sizeof key - 1) != 0 || !strstr(word, ending)) {
        return strdup(word);
    }
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    struct gm_span rest = {sizeof key - 1, strlen(word)};
    const char *before = key;
    while (rest.begin < rest.end) {
        const size_t end = gm_span_until(word, rest, ",");
        const char *name = word + rest.begin;
        const int length = (int)(end - rest.begin);
        const bool file = length > (int)end_length &&
                          memcmp(name + length - end_length, ending, end_length) == 0 && name[0] != '/';
        fprintf(stream, "%s%.*s%.*s", before, file ? (int)(slash - path) + 1 : 0, path, length, name);
        before = ",";
        rest.begin = end + 1;
    }
    return fclose(stream) == 0 ? text : (free(text), NULL);
}

bool gm_scheme_check(const char *name, size_t *at, char *message)
{
    struct reading reading = {.by = NULL};
    struct gm_fault fault;
    bool unreadable;
    *at = 0;
    if (is_path(name) || !is_user(name) || !gm_text_is_plain(name)) {
        const bool found = gm_scheme_named(name, &unreadable, message) != NULL;
        if (!found && !message[0]) {
            gm_refuse(message, "there is no scheme \"%.60s\"", name);
        }
        return found;
    }
    const struct gm_user_scheme_source source = {
        .text = name, .length = strlen(name), .name = name, .bring = bring, .data = &reading};
    const struct gm_scheme *made = gm_user_scheme_open(&source, &fault);
    if (!made) {
        *at = fault.offset;
        return gm_refuse(message, "%.400s", fault.sentence[0] ? fault.sentence : "not enough memory");
    }
    gm_user_scheme_close(made);
    return true;
}
