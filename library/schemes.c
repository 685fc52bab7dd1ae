/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The texts of a scheme and of its certificate. */
#include <stdio.h>
#include <stdlib.h>

#include "app/grid/certified_lane.h"
#include "app/output/scheme_json.h"
#include "app/words/scheme.h"
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

geomint *geomint_certify(const char *word, int count, const char *const words[])
{
    geomint *handle = calloc(1, sizeof *handle);
    if (!handle) {
        return NULL;
    }
    const struct gm_call call = gm_call_begin(handle);
    const struct gm_scheme *scheme = find(handle, word);
    struct gm_certificate certificate;
    size_t size = 0;
    int status = GEOMINT_OK;
    if (!scheme || !gm_handle_given_words(handle, count, words)) {
        gm_call_end(&call);
        return handle;
    }
    if (count <= 0) {
        certificate = gm_certify(scheme);
    } else if (!gm_certify_words(word, words[0], count - 1, words + 1, &certificate, &status,
                                 handle->message)) {
        gm_handle_refuse(handle, status, handle->message);
    }
    FILE *stream = status == GEOMINT_OK ? open_memstream(&handle->text, &size) : NULL;
    if (stream) {
        gm_certificate_put(stream, &certificate, count > 0 ? words[0] : NULL);
        fclose(stream);
        if (!certificate.holds) {
            gm_refuse(handle->message, "%.100s does not keep all that it claims", scheme->name);
            handle->status = GEOMINT_CLAIM;
        }
    }
    gm_call_end(&call);
    return handle;
}
