/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OSMesa: Mesa's renderer into memory. Mesa has dropped it since 25.1. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GL/gl.h>
#include <GL/osmesa.h>

#include "render/gl/backend.h"

enum { SIDE = 16 }; /* side in pixels of the buffer that a context must have; nothing is drawn there */

struct osmesa {
    OSMesaContext context;
    OSMesaContext (*create)(const int *attributes, OSMesaContext shared);
    void (*destroy)(OSMesaContext context);
    GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width,
                              GLsizei height);
    OSMESAproc (*get_proc_address)(const char *name);
    unsigned char buffer[SIDE * SIDE * 4];
};

static bool osmesa_use(void *self)
{
    struct osmesa *osmesa = self;
    return osmesa->make_current(osmesa->context, osmesa->buffer, GL_UNSIGNED_BYTE, SIDE, SIDE);
}

static void osmesa_release(void *self)
{
    struct osmesa *osmesa = self;
    osmesa->make_current(NULL, NULL, 0, 0, 0);
}

static void osmesa_close(void *self)
{
    struct osmesa *osmesa = self;
    if (osmesa->context) {
        osmesa_release(self);
        osmesa->destroy(osmesa->context);
    }
    free(osmesa);
}

/* OSMesa crashes with a driver that it does not know, such as one for a graphics card. */
static void *osmesa_load(char *message, size_t size)
{
    static const char *const libraries[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", NULL};
    const char *driver = getenv("GALLIUM_DRIVER");
    if (driver && *driver && strcmp(driver, "llvmpipe") != 0 && strcmp(driver, "softpipe") != 0) {
        snprintf(message, size, "it has no driver %.40s, for which GALLIUM_DRIVER asks", driver);
        return NULL;
    }
    return gm_library_open(libraries, message, size);
}

static void *osmesa_open(void *library, char *message, size_t size)
{
    struct osmesa *osmesa = calloc(1, sizeof *osmesa);
    if (!osmesa) {
        snprintf(message, size, "there is not enough memory for OSMesa");
        return NULL;
    }
    const struct gm_library_symbol symbols[] = {
        {"OSMesaCreateContextAttribs", &osmesa->create},
        {"OSMesaDestroyContext", &osmesa->destroy},
        {"OSMesaMakeCurrent", &osmesa->make_current},
        {"OSMesaGetProcAddress", &osmesa->get_proc_address},
    };
    if (!gm_library_find(library, symbols, sizeof symbols / sizeof *symbols)) {
        snprintf(message, size, "libOSMesa is too old");
        osmesa_close(osmesa);
        return NULL;
    }
    static const int attributes[] = {OSMESA_FORMAT,
                                     OSMESA_RGBA,
                                     OSMESA_PROFILE,
                                     OSMESA_CORE_PROFILE,
                                     OSMESA_CONTEXT_MAJOR_VERSION,
                                     3,
                                     OSMESA_CONTEXT_MINOR_VERSION,
                                     3,
                                     0};
    osmesa->context = osmesa->create(attributes, NULL);
    if (!osmesa->context || !osmesa_use(osmesa)) {
        snprintf(message, size, "OSMesa gives no OpenGL 3.3 context");
        osmesa_close(osmesa);
        return NULL;
    }
    return osmesa;
}

static gm_library_function osmesa_find(void *self, const char *name)
{
    struct osmesa *osmesa = self;
    return (gm_library_function)osmesa->get_proc_address(name);
}

const struct gm_backend gm_backend_osmesa = {
    .load = osmesa_load,
    .open = osmesa_open,
    .close = osmesa_close,
    .use = osmesa_use,
    .release = osmesa_release,
    .find = osmesa_find,
};
