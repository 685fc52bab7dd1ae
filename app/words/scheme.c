/* SPDX-License-Identifier: GPL-3.0-or-later */
/* User-defined schemes: read from files and words, and identified by their text. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/base/interrupt.h"
#include "app/words/names.h"
#include "core/expression/nearest.h"
#include "core/expression/reader.h"
#include "core/memory.h"
#include "core/ode/user/scheme.h"
#include "core/schemes.h"
#include "render/cells/text.h"

static bool is_path(const char *name)
{
    return gm_word_ends(name, gm_file_endings[GM_FILE_SCHEME]);
}

/* Returns true if a name means a user-defined scheme: a path that ends with .scheme, or a word such as
   composition(verlet; g, 1 - 2*g, g). */
static bool is_user(const char *name)
{
    return is_path(name) || gm_user_scheme_is_word(name, strlen(name));
}

enum { DEEPEST = 8 };

/* A text of a scheme that is read: a word, or a file, which the text before may name. */
struct reading {
    const struct reading *by;
    const char *path; /* NULL: a word */
    char *text, title[64];
    struct gm_user_scheme_source source;
    struct gm_fault fault;
    bool unreadable;
    char *message;
};

static const struct gm_scheme *bring(void *data, const char *name, char *sentence);

/* Reads the text of a file, or of a name that is a word. Returns false with a message. The caller frees
   the text. */
static bool open_source(struct reading *reading, const char *name, const struct gm_file *file)
{
    size_t length = strlen(name);
    const char *text = name;
    if (file) {
        reading->path = file->path;
        text = reading->text = gm_file_read(file, GM_LARGEST_SCHEME, &length, reading->message);
        reading->unreadable = !text;
        if (!text) {
            return false;
        }
        const char *base = basename(file->path);
        /* a title without the file's ending and without an incomplete letter */
        size_t letters = strlen(base) - strlen(gm_file_endings[GM_FILE_SCHEME]);
        letters = letters < sizeof reading->title ? letters : sizeof reading->title - 1;
        while (letters > 0 && ((unsigned char)base[letters] & 0xC0) == 0x80) {
            letters--;
        }
        for (size_t i = 0; i < letters; i++) {
            reading->title[i] = (char)(strchr(";()#", base[i]) ? '-' : base[i]);
        }
    }
    const size_t skipped = file && gm_text_has_mark(text, length) ? GM_TEXT_MARK : 0;
    reading->source = (struct gm_user_scheme_source){.text = text + skipped,
                                                     .length = length - skipped,
                                                     .name = name,
                                                     .title = file ? reading->title : NULL,
                                                     .part = reading->by != NULL,
                                                     .bring = bring,
                                                     .data = reading};
    return true;
}

/* Reports a fault and its place: line and column in a file, only the column for a word. */
static void report(const struct reading *reading)
{
    const struct gm_user_scheme_source *source = &reading->source;
    size_t line, column;
    if (!reading->fault.sentence[0]) {
        gm_refuse(reading->message, "not enough memory");
        return;
    }
    if (reading->path) {
        gm_place_report(reading->path, source->text, &reading->fault, reading->message);
    } else {
        gm_text_place(source->text, reading->fault.offset, &line, &column);
        gm_refuse(reading->message, "scheme, column %zu: %.250s", column, reading->fault.sentence);
    }
    gm_place_show(source->text, source->length, reading->fault.offset, reading->message);
}

/* Makes the scheme of a file or a word, or finds the one that is the same under that name. */
static const struct gm_scheme *read_scheme(struct reading *reading, const char *name,
                                           const struct gm_file *file)
{
    const struct gm_scheme *made = NULL, *known = NULL;
    if (open_source(reading, name, file)) {
        made = gm_user_scheme_open(&reading->source, &reading->fault);
        known = made ? gm_scheme_find(made->name) : NULL;
        known = known && known->word && strcmp(known->word, made->word) == 0 ? known : NULL;
        if (!made) {
            report(reading);
        } else if (known || !gm_scheme_bring(made)) {
            gm_user_scheme_close(made);
            made = known;
            gm_refuse(reading->message, known ? "" : "not enough memory");
        }
    }
    free(reading->text);
    return made;
}

/* A file that a file names is found from the folder of that one. */
static const struct gm_scheme *bring(void *data, const char *name, char *sentence)
{
    struct reading *by = data;
    char message[GM_MESSAGE] = "";
    struct reading reading = {.by = by, .message = message};
    const char *slash = by->path ? strrchr(by->path, '/') : NULL;
    struct gm_file file = {0};
    const int folder = slash && name[0] != '/' ? (int)(slash - by->path) + 1 : 0;
    sentence[0] = '\0';
    if (snprintf(file.path, sizeof file.path, "%.*s%s", folder, by->path ? by->path : "", name) >=
        (int)sizeof file.path) {
        snprintf(sentence, GM_FAULT_SENTENCE, "the path is too long");
        return NULL;
    }
    struct stat here, there;
    const bool found = stat(file.path, &here) == 0;
    int depth = 0;
    for (const struct reading *before = by; before; before = before->by, depth++) {
        if (found && before->path && stat(before->path, &there) == 0 && here.st_dev == there.st_dev &&
            here.st_ino == there.st_ino) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%.200s contains itself", name);
            return NULL;
        }
    }
    if (depth > DEEPEST) {
        snprintf(sentence, GM_FAULT_SENTENCE, "files name files at most %d deep", DEEPEST);
        return NULL;
    }
    const struct gm_scheme *scheme = read_scheme(&reading, file.path, &file);
    by->unreadable = by->unreadable || reading.unreadable;
    if (!scheme) {
        message[strcspn(message, "\n")] = '\0';
        snprintf(sentence, GM_FAULT_SENTENCE, "%.*s", GM_FAULT_SENTENCE - 1, message);
    }
    return scheme;
}

char *gm_scheme_polished(const char *name, struct gm_polish *polish, bool *unreadable, char *message)
{
    struct gm_file from;
    struct reading reading = {.message = message};
    const bool path = is_path(name) && gm_file_find(GM_FILE_SCHEME, name, &from);
    char *text = NULL;
    if (!gm_text_is_plain(name)) {
        gm_refuse(message, "the scheme's name holds a character that cannot be shown");
    } else if (!is_user(name)) {
        gm_refuse(message, "--polish takes a file or a word, not a scheme of the program");
    } else if (open_source(&reading, name, path ? &from : NULL)) {
        text = gm_user_scheme_polish(&reading.source, polish, &reading.fault);
        if (!text) {
            report(&reading);
        }
    }
    free(reading.text);
    *unreadable = reading.unreadable;
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
    struct reading reading = {.message = message};
    struct gm_file file;
    const bool plain = gm_text_is_plain(name);
    message[0] = '\0';
    const struct gm_scheme *scheme = plain && !is_path(name) ? gm_scheme_find(name) : NULL;
    if (scheme && !scheme->word && strcmp(scheme->name, name) != 0 && gm_file_is(GM_FILE_SCHEME, name)) {
        scheme = NULL; /* a file has precedence over an alias */
    }
    if (!plain) {
        gm_refuse(message, "the scheme's name holds a character that cannot be shown");
    } else if (!scheme && gm_file_find(GM_FILE_SCHEME, name, &file)) {
        scheme = read_scheme(&reading, name, &file);
    } else if (!scheme && is_user(name)) {
        scheme = read_scheme(&reading, name, NULL);
    } else if (!scheme && gm_files_folder_opens(GM_FILE_SCHEME, message)) {
        tell_kind(name, message);
    } else if (!scheme) {
        reading.unreadable = true;
    }
    *unreadable = reading.unreadable;
    return scheme;
}

const struct gm_scheme *gm_scheme_sought(const char *name, int *status, char *message)
{
    bool unreadable = false;
    const unsigned long refusals = gm_memory_refusals();
    const struct gm_scheme *scheme = gm_scheme_named(name, &unreadable, message);
    if (!scheme && !message[0]) {
        gm_scheme_refuse(NULL, name, message);
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
    const char *ending = gm_file_endings[GM_FILE_SCHEME], *slash = strrchr(path, '/'), *before = key;
    struct gm_text_stream writing;
    struct gm_span rest = {sizeof key - 1, strlen(word)}, name;
    if (!slash || strncmp(word, key, sizeof key - 1) != 0 || !strstr(word, ending)) {
        return strdup(word);
    }
    FILE *stream = gm_stream_begin(&writing);
    while (stream && rest.begin < rest.end) {
        name = (struct gm_span){rest.begin, gm_span_until(word, rest, ",")};
        const size_t length = name.end - name.begin, letters = strlen(ending);
        const bool file = length > letters && memcmp(word + name.end - letters, ending, letters) == 0 &&
                          word[name.begin] != '/';
        fprintf(stream, "%s%.*s%.*s", before, file ? (int)(slash - path) + 1 : 0, path, (int)length,
                word + name.begin);
        before = ",";
        rest.begin = name.end + 1;
    }
    return gm_stream_end(&writing);
}

bool gm_scheme_check(const char *name, size_t *at, char *message)
{
    struct reading reading = {.message = message};
    const struct gm_scheme *made = NULL;
    int status;
    *at = 0;
    if (is_path(name) || !is_user(name) || !gm_text_is_plain(name)) {
        return gm_scheme_sought(name, &status, message);
    }
    if (open_source(&reading, name, NULL)) {
        made = gm_user_scheme_open(&reading.source, &reading.fault);
    }
    if (!made) {
        *at = reading.fault.offset;
        return gm_refuse(message, "%.400s",
                         reading.fault.sentence[0] ? reading.fault.sentence : "not enough memory");
    }
    gm_user_scheme_close(made);
    return true;
}
