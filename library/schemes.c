/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The texts of a scheme and of its certificate. */
#include <stdio.h>
#include <stdlib.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/grid/certified_lane.h"
#include "app/output/scheme_json.h"
#include "app/words/scheme.h"
#include "core/arena.h"
#include "library/handle.h"
#include "library/host.h"

/* NULL with a sentence. */
static const struct gm_scheme *find(geomint *handle, const char *word)
{
    int status = GEOMINT_USAGE;
    const bool given = gm_handle_given(handle, word, "the scheme");
    const struct gm_scheme *scheme = given ? gm_scheme_sought(word, &status, handle->message) : NULL;
    if (given && !scheme) {
        gm_handle_refuse(handle, status, handle->message);
    }
    return scheme;
}

geomint *geomint_scheme(const char *word)
{
    geomint *handle = calloc(1, sizeof *handle);
    if (!handle) {
        return NULL;
    }
    const struct gm_call call = gm_call_begin(handle);
    const struct gm_scheme *scheme = find(handle, word);
    size_t size = 0;
    FILE *stream = scheme ? open_memstream(&handle->text, &size) : NULL;
    if (stream) {
        gm_scheme_put(stream, scheme);
        fclose(stream); /* the text is there, or a refusal is noted */
    }
    gm_call_end(&call);
    return handle;
}

struct certifying {
    geomint *handle;
    const char *word; /* of the scheme, as it was given */
    const struct gm_scheme *scheme;
    const char *system;       /* NULL: the systems of all certificates */
    const char *const *words; /* key=value of that system */
    int count;                /* of these words */
    int status;               /* if the body is left */
};

/* The certificate points into the arena, so its text is written before the body returns. */
static void certify(struct gm_arena *arena, void *data)
{
    struct certifying *certifying = data;
    geomint *handle = certifying->handle;
    struct gm_arguments *typed = gm_arguments_in(arena);
    gm_arena_need(arena, gm_arguments_add(typed, certifying->word));
    for (int i = 0; i < certifying->count; i++) {
        gm_arena_need(arena, gm_arguments_add(typed, certifying->words[i]));
    }
    size_t size = 0;
    const struct gm_certificate certificate =
        certifying->system ? gm_certify_words(arena, certifying->system, typed, &certifying->status)
                           : gm_certify(certifying->scheme);
    FILE *stream = open_memstream(&handle->text, &size);
    if (stream) {
        gm_certificate_put(stream, &certificate, certifying->system);
        fclose(stream);
        if (!certificate.holds) {
            gm_refuse(handle->message, "%.100s does not satisfy all its claims", certifying->scheme->name);
            handle->status = GEOMINT_CLAIM;
        }
    }
}

geomint *geomint_certify(const char *word, int count, const char *const words[])
{
    geomint *handle = calloc(1, sizeof *handle);
    if (!handle) {
        return NULL;
    }
    const struct gm_call call = gm_call_begin(handle);
    const struct gm_scheme *scheme = find(handle, word);
    if (scheme && gm_handle_given_words(handle, count, words)) {
        struct certifying certifying = {.handle = handle,
                                        .word = word,
                                        .scheme = scheme,
                                        .system = count > 0 ? words[0] : NULL,
                                        .words = words + 1,
                                        .count = count - 1,
                                        .status = GM_EXIT_MEMORY};
        struct gm_arena *arena = gm_arena_open();
        if (!gm_arena_run(arena, certify, &certifying)) {
            gm_handle_refuse(handle, certifying.status, gm_arena_reason(arena));
        }
        gm_arena_close(arena);
    }
    gm_call_end(&call);
    return handle;
}
