/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words as one owned list: split from a text, completed by defaults, written so that they can be read
   again. */
#include "app/base/arguments.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "scenes/common/scene.h"

void gm_arguments_close(void *self)
{
    struct gm_arguments *arguments = self;
    for (int i = 0; i < arguments->count; i++) {
        free(arguments->words[i]);
    }
    free(arguments->words);
    *arguments = (struct gm_arguments){0};
}

struct gm_arguments *gm_arguments_in(struct gm_arena *arena)
{
    return gm_arena_keep(arena, gm_arena_take(arena, 1, sizeof(struct gm_arguments)), gm_arguments_close);
}

/* Takes a malloc'ed word; NULL: it was out of memory. */
static bool take(struct gm_arguments *arguments, char *word)
{
    const size_t count = (size_t)arguments->count;
    char **more = word && !arguments->failed ? realloc(arguments->words, (count + 2) * sizeof *more) : NULL;
    arguments->failed = !more;
    if (more) {
        more[count] = word;
        more[count + 1] = NULL;
        arguments->words = more;
        arguments->count++;
    } else {
        free(word);
    }
    return more;
}

bool gm_arguments_add(struct gm_arguments *arguments, const char *word)
{
    return take(arguments, strdup(word));
}

bool gm_arguments_print(struct gm_arguments *arguments, const char *format, ...)
{
    char *word = NULL;
    va_list values;
    va_start(values, format);
    const int length = vasprintf(&word, format, values);
    va_end(values);
    return take(arguments, length < 0 ? NULL : word);
}

bool gm_arguments_append(struct gm_arguments *arguments, char *const words[], int count)
{
    for (int i = 0; i < count; i++) {
        gm_arguments_add(arguments, words[i]);
    }
    return !arguments->failed;
}

struct gm_arguments *gm_arguments_of(struct gm_arena *arena, const char *text)
{
    struct gm_arguments *words = gm_arguments_in(arena);
    gm_arena_need(arena, gm_arguments_split(words, text));
    return words;
}

bool gm_arguments_split(struct gm_arguments *arguments, const char *text)
{
    char *word = malloc(strlen(text) + 1);
    arguments->failed = arguments->failed || !word;
    while (!arguments->failed && *(text += strspn(text, " \t"))) {
        char *to = word;
        while (*text != '\0' && *text != ' ' && *text != '\t') {
            text += text[0] == '\\' && text[1] != '\0';
            *to++ = *text++;
        }
        *to = '\0';
        gm_arguments_add(arguments, word);
    }
    free(word);
    return !arguments->failed;
}

/* The length of a word's key; both keys of a run's end count as one. */
static size_t key_of(const char *word, const char **key)
{
    *key = strncmp(word, "steps=", 6) == 0 ? "until=" : word;
    return strcspn(*key, "=") + 1;
}

const char *gm_arguments_find(const struct gm_arguments *arguments, const char *word)
{
    const char *key, *other;
    const size_t length = key_of(word, &key);
    for (int i = 0; i < arguments->count; i++) {
        if (key_of(arguments->words[i], &other) == length && strncmp(other, key, length) == 0) {
            return arguments->words[i];
        }
    }
    return NULL;
}

bool gm_arguments_have(const struct gm_arguments *arguments, const char *word)
{
    return gm_arguments_find(arguments, word) != NULL;
}

void gm_arguments_put(FILE *stream, const char *word)
{
    for (; *word; word++) {
        if (*word == ' ' || *word == '\\') {
            putc('\\', stream);
        }
        putc(*word, stream);
    }
}

void gm_arguments_put_shell(FILE *stream, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:%@^";
    size_t front = strspn(word, plain);
    if (!word[front] && front > 0) {
        fputs(word, stream);
        return;
    }
    const char *equals = strchr(word, '=');
    front = equals && equals < word + front ? (size_t)(equals - word) + 1 : 0;
    fprintf(stream, "%.*s'", (int)front, word);
    for (const char *at = word + front; *at; at++) {
        fputs(*at == '\'' ? "'\\'" : "", stream);
        putc(*at, stream);
    }
    putc('\'', stream);
}

void gm_arguments_put_scene(FILE *stream, const struct gm_scene *scene)
{
    gm_arguments_put(stream, scene->words ? scene->words[0] : scene->name);
    for (size_t i = 1; scene->words && scene->words[i]; i++) {
        fputc(' ', stream);
        gm_arguments_put(stream, scene->words[i]);
    }
}

void gm_arguments_tell_scene(const struct gm_scene *scene, char *text, size_t size)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    for (size_t i = 0; stream && scene->words && scene->words[i]; i++) {
        fputs(i ? " " : "", stream);
        gm_arguments_put_shell(stream, scene->words[i]);
    }
    char *whole = gm_stream_end(&writing);
    snprintf(text, size, "%s", whole && scene->words ? whole : scene->name);
    free(whole);
}

char *gm_arguments_join(const char *front, const struct gm_arguments *arguments)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    fputs(front, stream);
    for (int i = 0; i < arguments->count; i++) {
        fputc(' ', stream);
        gm_arguments_put(stream, arguments->words[i]);
    }
    return gm_stream_end(&writing);
}

FILE *gm_stream_begin(struct gm_text_stream *writing)
{
    *writing = (struct gm_text_stream){0};
    return writing->stream = open_memstream(&writing->text, &writing->size);
}

char *gm_stream_end(struct gm_text_stream *writing)
{
    const bool good = writing->stream && fclose(writing->stream) == 0;
    char *text = writing->text;
    writing->stream = NULL;
    writing->text = NULL;
    if (!good) {
        free(text);
    }
    return good ? text : NULL;
}

void gm_append(char *text, size_t size, const char *format, ...)
{
    const size_t used = strlen(text);
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(text + used, size - used, format, values);
    va_end(values);
    if (length >= (int)(size - used)) {
        gm_message_mark_cut(text, size);
    }
}
