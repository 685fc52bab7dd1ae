/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a system, and the words that parts of them are made of. */
#include "app/words/lines.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/base/exit.h"
#include "app/base/files.h"
#include "core/expression/reader.h"
#include "core/model/system.h"
#include "render/files/regular_file.h"
#include "render/message.h"

char *gm_system_lines_read(const struct gm_file *file, size_t *length, char *message)
{
    char reason[GM_REGULAR_REASON];
    struct stat about;
    const bool large = !file->built_in && stat(file->path, &about) == 0 && S_ISREG(about.st_mode) &&
                       about.st_size > GM_LARGEST_SYSTEM;
    *length = large ? (size_t)about.st_size : 0;
    char *text = large ? strdup("") : gm_file_read(file, GM_LARGEST_SYSTEM, length, reason);
    if (!text) {
        gm_refuse(message, "%.300s could not be read: %s", file->path, large ? strerror(ENOMEM) : reason);
    }
    return text;
}

void gm_system_lines_close(struct gm_system_lines *written)
{
    free(written->text);
    free(written->origins);
    *written = (struct gm_system_lines){0};
}

void gm_system_lines_put(struct gm_system_lines *written, FILE *lines, const char *text, size_t length)
{
    fwrite(text, 1, length, lines);
    written->length += length;
}

void gm_system_lines_put_word(struct gm_system_lines *written, FILE *lines, char *const words[], int word,
                              size_t offset, size_t length)
{
    struct gm_origin *more = realloc(written->origins, (written->origin_count + 1) * sizeof *more);
    if (more) { /* else a place is told less well */
        written->origins = more;
        more[written->origin_count++] = (struct gm_origin){written->length, length, word, offset};
    }
    gm_system_lines_put(written, lines, words[word] + offset, length);
}

static const struct gm_origin *origin_of(const struct gm_system_lines *written, size_t offset)
{
    for (size_t i = 0; i < written->origin_count; i++) {
        const struct gm_origin *origin = &written->origins[i];
        if (offset >= origin->begin && offset <= origin->begin + origin->length) {
            return origin;
        }
    }
    return NULL;
}

void gm_system_word_fault(const char *word, size_t at, const char *sentence, char *message)
{
    const size_t key = strcspn(word, "=") + 1, inside = at >= key ? at - key : 0;
    gm_refuse(message, "in %.*s, column %zu: %.200s", (int)key, word, inside + 1, sentence);
    gm_place_show(word + key, strlen(word + key), inside, message);
}

int gm_system_lines_fault(const struct gm_system_lines *written, char *const words[],
                          const struct gm_fault *fault, struct gm_word_place *place, char *message)
{
    const char *name = written->path ? written->path : "system", *text = written->text;
    const size_t length = written->length;
    if (!fault->sentence[0]) {
        gm_refuse(message, "%.300s: not enough memory", name);
        return GM_EXIT_MEMORY;
    }
    const bool placed = fault->offset > 0 && fault->offset < length;
    const struct gm_origin *origin = placed ? origin_of(written, fault->offset) : NULL;
    if (origin) {
        *place = (struct gm_word_place){origin->word, origin->offset + fault->offset - origin->begin};
        gm_system_word_fault(words[place->word], place->offset, fault->sentence, message);
        return GM_EXIT_USAGE;
    }
    if (written->path) {
        size_t line, column;
        gm_text_place(text, length <= GM_LARGEST_SYSTEM ? fault->offset : 0, &line, &column);
        char first[48] = "";
        if (fault->earlier > 0) {
            size_t other, behind;
            gm_text_place(text, fault->earlier, &other, &behind);
            snprintf(first, sizeof first, ", first in line %zu", other);
        }
        gm_refuse(message, "%.150s:%zu:%zu: %.200s%s", written->path, line, column, fault->sentence, first);
    } else {
        gm_refuse(message, "system: %.200s", fault->sentence);
    }
    if (written->path && fault->offset < length && length <= GM_LARGEST_SYSTEM) {
        gm_place_show(text, length, fault->offset, message);
    }
    return GM_EXIT_USAGE;
}

const char *gm_word_after(const char *word, const char *key, size_t length)
{
    return strncmp(word, key, length) == 0 && word[length] == '=' ? word + length + 1 : NULL;
}

size_t gm_word_first(const char *value)
{
    int depth = 0;
    size_t length = 0;
    for (; value[length]; length++) {
        const char here = value[length];
        depth += (here == '(' || here == '[') - (here == ')' || here == ']');
        if (depth == 0 && (here == ',' || (here == '.' && value[length + 1] == '.'))) {
            break;
        }
    }
    return length;
}

const char *gm_system_lines_end(const char *line)
{
    do {
        line += strcspn(line, "\n");
        line += *line == '\n';
    } while (*line == ' ' || *line == '\t');
    return line;
}
