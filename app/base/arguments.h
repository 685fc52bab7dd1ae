/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_ARGUMENTS_H
#define GM_APP_BASE_ARGUMENTS_H

#include <stdbool.h>
#include <stdio.h>

/* Typed words, or the words of a text: a scene and its key=value, or the words of a command. */

struct gm_arena;
struct gm_scene;

struct gm_arguments { /* {0} is an empty list */
    char **words;     /* copies of the words, and a NULL after the last */
    int count;
    bool failed; /* memory was short, and words are missing: asked once, when all have been added */
};
void gm_arguments_close(void *arguments);
/* An empty list that closes with the arena; called in a body of it. */
struct gm_arguments *gm_arguments_in(struct gm_arena *arena);
/* The same with the words of a text (gm_arguments_split). */
struct gm_arguments *gm_arguments_of(struct gm_arena *arena, const char *text);

/* Add one word, a formatted one, several, or the words of a text: separated by blanks, with a backslash before
   a blank or backslash that belongs to a word. Return false when this or an earlier one was out of memory; the
   caller closes the list in any case. */
bool gm_arguments_add(struct gm_arguments *arguments, const char *word);
__attribute__((format(printf, 2, 3))) bool gm_arguments_print(struct gm_arguments *arguments,
                                                              const char *format, ...);
bool gm_arguments_append(struct gm_arguments *arguments, char *const words[], int count);
bool gm_arguments_split(struct gm_arguments *arguments, const char *text);

/* The first word that sets the same key as `word`, "dt=" or "dt=0.1", or NULL. Both steps= and until= set
   the end of a run. */
const char *gm_arguments_find(const struct gm_arguments *arguments, const char *word);
bool gm_arguments_have(const struct gm_arguments *arguments, const char *word);

/* Writes one word as gm_arguments_split reads it. */
void gm_arguments_put(FILE *stream, const char *word);
/* Writes one word for a shell, with quotes if they are needed. */
void gm_arguments_put_shell(FILE *stream, const char *word);
/* Writes a scene as its name, or as the words on which it was built. */
void gm_arguments_put_scene(FILE *stream, const struct gm_scene *scene);
/* The same as a shell reads it, as far as `text` has room. */
void gm_arguments_tell_scene(const struct gm_scene *scene, char *text, size_t size);
/* "FRONT word word"; malloc'ed. Returns NULL when out of memory. */
char *gm_arguments_join(const char *front, const struct gm_arguments *arguments);

/* A text that grows as its stream is written. gm_stream_begin returns the stream, NULL when out of memory;
   gm_stream_end closes it and returns the text, malloc'ed, or NULL without a stream, also after an end, or memory; the size stays. */
struct gm_text_stream {
    FILE *stream;
    char *text;
    size_t size;
};
FILE *gm_stream_begin(struct gm_text_stream *writing);
char *gm_stream_end(struct gm_text_stream *writing);

/* Appends to a text, as far as its `size` bytes have room. */
__attribute__((format(printf, 3, 4))) void gm_append(char *text, size_t size, const char *format, ...);

#endif
