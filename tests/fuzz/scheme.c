/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any text as a scheme: it is made, and its word makes the same one again, or it is refused with a
   sentence. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/user/scheme.h"
#include "core/theory/certify.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

static const struct gm_scheme *no_file(void *data, const char *path, char *sentence)
{
    (void)data;
    snprintf(sentence, GM_FAULT_SENTENCE, "%.40s is not read here", path);
    return NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    require(text != NULL);
    memcpy(text, data, size);
    text[size] = '\0';
    struct gm_fault fault;
    struct gm_user_scheme_source source = {
        .text = text, .length = size, .name = "own", .title = "own", .bring = no_file};
    const struct gm_scheme *scheme = gm_user_scheme_open(&source, &fault);
    if (scheme) {
        source.text = scheme->word;
        source.length = strlen(scheme->word);
        const struct gm_scheme *again = gm_user_scheme_open(&source, &fault);
        require(again && strcmp(again->word, scheme->word) == 0 && again->family == scheme->family &&
                again->order == scheme->order && again->claims == scheme->claims);
        gm_user_scheme_close(again);
        gm_user_scheme_close(scheme);
    } else {
        require(fault.sentence[0] && strlen(fault.sentence) < GM_FAULT_SENTENCE && fault.offset <= size);
    }
    free(text);
    return 0;
}
