/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The texts of a scheme and of its certificate. */
#include <stdio.h>
#include <stdlib.h>

#include "app/grid/grid.h"
#include "app/output/scheme_json.h"
#include "app/words/names.h"
#include "core/arena.h"
#include "core/theory/certify.h"
#include "library/handle.h"

static const struct gm_scheme *find(struct gm_arena *arena, struct gm_handle_words *opening)
{
    char message[GM_MESSAGE] = "the scheme is NULL";
    const struct gm_scheme *scheme =
        opening->scheme ? gm_scheme_sought(opening->scheme, &opening->refusal, message) : NULL;
    gm_arena_check(arena, scheme, message);
    return scheme;
}

static FILE *open_text(struct gm_arena *arena, geomint *handle, size_t *size)
{
    FILE *stream = open_memstream(&handle->text, size);
    gm_arena_need(arena, stream);
    return stream;
}

static void describe(struct gm_arena *arena, void *data)
{
    struct gm_handle_words *opening = data;
    const struct gm_scheme *scheme = find(arena, opening);
    size_t size;
    FILE *stream = open_text(arena, opening->handle, &size);
    gm_scheme_put(stream, scheme);
    fclose(stream); /* the text is there, or a refusal is noted */
}

geomint *geomint_scheme(const char *word)
{
    return gm_handle_open((struct gm_handle_words){.scheme = word}, describe);
}

/* The certificate of a scheme; with words, on the system that they name. */
static void certify(struct gm_arena *arena, void *data)
{
    struct gm_handle_words *opening = data;
    geomint *handle = opening->handle;
    const struct gm_scheme *scheme = find(arena, opening);
    const char *system = opening->count > 0 ? opening->words[0] : NULL;
    const size_t mark = gm_arena_mark(arena);
    struct gm_arguments *typed = gm_arguments_in(arena);
    size_t size;
    gm_arguments_add(typed, opening->scheme);
    for (int i = 1; i < opening->count; i++) {
        gm_arguments_add(typed, opening->words[i]);
    }
    gm_arena_need(arena, !typed->failed);
    const struct gm_certificate certificate =
        system ? gm_certify_words(arena, system, typed, &opening->refusal) : gm_certify(scheme);
    FILE *stream = open_text(arena, handle, &size);
    gm_certificate_put(stream, &certificate, system);
    fclose(stream);
    if (!certificate.holds) {
        gm_refuse(handle->message, "%.100s does not keep all that it claims", scheme->name);
        handle->status = GEOMINT_CLAIM;
    }
    gm_arena_release(arena, mark);
}

geomint *geomint_certify(const char *word, int count, const char *const words[])
{
    return gm_handle_open((struct gm_handle_words){.scheme = word, .count = count, .words = words}, certify);
}
