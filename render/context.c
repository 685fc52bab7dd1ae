/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/context_kind.h"

static const struct gm_context_kind *const kinds[] = {
#ifdef GM_HAVE_OSMESA
    &gm_context_osmesa,
#endif
#ifdef GM_HAVE_EGL
    &gm_context_egl,
#endif
    NULL,
};

struct gm_context {
    const struct gm_context_kind *kind;
    void *self;
};

static struct gm_context *open_kind(const struct gm_context_kind *kind, char *message, size_t size)
{
    struct gm_context *context = malloc(sizeof *context);
    if (context == NULL) {
        snprintf(message, size, "There is not enough memory for an OpenGL context.");
        return NULL;
    }
    *context = (struct gm_context){.kind = kind, .self = kind->open(message, size)};
    if (context->self == NULL) {
        free(context);
        return NULL;
    }
    return context;
}

static void unknown_kind(const char *wanted, char *message, size_t size)
{
    char known[64] = "";
    for (size_t i = 0; kinds[i] != NULL; i++) {
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i > 0 ? " and " : "",
                 kinds[i]->key);
    }
    snprintf(message, size, "GEOMINT_GL is \"%.40s\", but this geomint knows only %s.", wanted,
             known[0] != '\0' ? known : "none");
}

struct gm_context *gm_context_open(char *message, size_t size)
{
    const char *wanted = getenv("GEOMINT_GL");
    char reasons[2][192] = {"", ""};
    size_t tried = 0;
    for (size_t i = 0; kinds[i] != NULL; i++) {
        if (wanted != NULL && wanted[0] != '\0' && strcmp(wanted, kinds[i]->key) != 0) {
            continue;
        }
        struct gm_context *context = open_kind(kinds[i], reasons[tried], sizeof reasons[tried]);
        if (context != NULL) {
            return context;
        }
        tried++;
    }
    if (tried == 0 && wanted != NULL && wanted[0] != '\0') {
        unknown_kind(wanted, message, size);
    } else if (tried == 0) {
        snprintf(message, size,
                 "This geomint was built without OSMesa and EGL, so it cannot paint pictures.");
    } else {
        snprintf(message, size, "No OpenGL context could be opened: %s%s%s.", reasons[0],
                 tried > 1 ? "; " : "", reasons[1]);
    }
    return NULL;
}

void gm_context_close(struct gm_context *context)
{
    if (context == NULL) {
        return;
    }
    context->kind->close(context->self);
    free(context);
}

bool gm_context_use(const struct gm_context *context)
{
    return context->kind->use(context->self);
}

gm_context_function gm_context_find(const struct gm_context *context, const char *name)
{
    return context->kind->find(context->self, name);
}

const char *gm_context_name(const struct gm_context *context)
{
    return context->kind->name;
}
