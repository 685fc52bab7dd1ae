/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_TYPED_H
#define GM_APP_WORDS_TYPED_H

#include "app/base/arguments.h"
#include "app/words/request.h"

/* A typed line without a shell: the words of a command line. A blank ends a key's word if another one,
   NAME=, follows it outside of parentheses. So a formula needs no quotes, H=p^2/2 - cos(q) q=2, and may
   have them. */

/* A fault of a line. */
struct gm_typed_fault {
    char sentence[GM_MESSAGE]; /* "": nothing */
    long at;                   /* the byte of the line; below 0: nowhere in it */
};

/* The words of a line, and the line of words, with quotes if they are needed, malloc'ed. Return false,
   NULL when out of memory. */
bool gm_typed_split(struct gm_arguments *words, const char *line);
char *gm_typed_join(const struct gm_arguments *words);

/* Reads a line of a system: a formula, H= L= rate=, a file or a name, with key=value; or of a scene with
   its keys. `schemes`: see gm_request_parse. Returns false with a fault. NULL: the line is only checked. */
bool gm_typed_request(struct gm_request *request, const char *line, size_t schemes,
                      struct gm_typed_fault *fault);
/* Returns true if the line can be read; stores nothing. */
bool gm_typed_check(const char *line, struct gm_typed_fault *fault);

/* The same for a scheme: a name, a path, a word. */
const struct gm_scheme *gm_typed_scheme(const char *line, struct gm_typed_fault *fault);
bool gm_typed_check_scheme(const char *line, struct gm_typed_fault *fault);

#endif
