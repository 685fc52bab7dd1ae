/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The texts of a scheme and of its certificate. */
#include <stdio.h>
#include <stdlib.h>

#include "app/grid/certified_lane.h"
#include "app/output/scheme_json.h"
#include "app/words/scheme.h"
#include "core/arena.h"
#include "core/memory.h"
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

/* A certificate on a system, words[0], and its status. */
struct certifying {
    const char *word;
    int count;
    const char *const *words;
    struct gm_certificate certificate;
    int status;
};

static void certify_words(struct gm_arena *arena, void *data)
{
    struct certifying *certifying = data;
    struct gm_arguments *typed = gm_arguments_in(arena);
    gm_arena_need(arena, gm_arguments_add(typed, certifying->word));
    for (int i = 1; i < certifying->count; i++) {
        gm_arena_need(arena, gm_arguments_add(typed, certifying->words[i]));
    }
    certifying->certificate = gm_certify_words(arena, certifying->words[0], typed, &certifying->status);
    certifying->status = GEOMINT_OK;
}

geomint *geomint_certify(const char *word, int count, const char *const words[])
{
    geomint *handle = calloc(1, sizeof *handle);
    if (!handle) {
        return NULL;
    }
    const struct gm_call call = gm_call_begin(handle);
    const struct gm_scheme *scheme = find(handle, word);
    struct certifying self = {.word = word, .count = count, .words = words, .status = GEOMINT_OK};
    size_t size = 0;
    if (!scheme || !gm_handle_given_words(handle, count, words)) {
        gm_call_end(&call);
        return handle;
    }
    struct gm_arena *arena = count > 0 ? gm_arena_open() : NULL;
    if (count <= 0) {
        self.certificate = gm_certify(scheme);
    } else if (!gm_arena_run(arena, certify_words, &self)) {
        self.status = gm_memory_was_short() ? GEOMINT_MEMORY : self.status;
        gm_handle_refuse(handle, self.status, gm_arena_reason(arena));
    }
    FILE *stream = self.status == GEOMINT_OK ? open_memstream(&handle->text, &size) : NULL;
    if (stream) {
        gm_certificate_put(stream, &self.certificate, count > 0 ? words[0] : NULL);
        fclose(stream);
        if (!self.certificate.holds) {
            gm_refuse(handle->message, "%.100s does not keep all that it claims", scheme->name);
            handle->status = GEOMINT_CLAIM;
        }
    }
    gm_arena_close(arena);
    gm_call_end(&call);
    return handle;
}
