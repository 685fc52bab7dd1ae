/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OSMesa: Mesa's renderer into memory. Mesa has dropped it since 25.1. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GL/gl.h>
#include <GL/osmesa.h>

#include "render/gl/backend.h"

enum { SIDE = 16 }; /* side in pixels of the buffer that a context must have; nothing is drawn there */

static struct {
    OSMesaContext context;
    OSMesaContext (*create)(const int *attributes, OSMesaContext shared);
    void (*destroy)(OSMesaContext context);
    GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width,
                              GLsizei height);
    OSMESAproc (*get_proc_address)(const char *name);
    unsigned char buffer[SIDE * SIDE * 4];
} osmesa;

static const struct gm_library_symbol symbols[] = {
    {"OSMesaCreateContextAttribs", &osmesa.create},
    {"OSMesaDestroyContext", &osmesa.destroy},
    {"OSMesaMakeCurrent", &osmesa.make_current},
    {"OSMesaGetProcAddress", &osmesa.get_proc_address},
};

static bool use(void)
{
    return osmesa.make_current(osmesa.context, osmesa.buffer, GL_UNSIGNED_BYTE, SIDE, SIDE);
}

static void release(void)
{
    osmesa.make_current(NULL, NULL, 0, 0, 0);
}

static void close_context(void)
{
    if (osmesa.context) {
        release();
        osmesa.destroy(osmesa.context);
        osmesa.context = NULL;
    }
}

/* OSMesa crashes with a driver that it does not know, such as one for a graphics card. */
static void *load(char *message, size_t size)
{
    static const char *const libraries[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so", NULL};
    const char *driver = getenv("GALLIUM_DRIVER");
    if (driver && *driver && strcmp(driver, "llvmpipe") != 0 && strcmp(driver, "softpipe") != 0) {
        snprintf(message, size, "it has no driver %.40s, for which GALLIUM_DRIVER asks", driver);
        return NULL;
    }
    return gm_library_open(libraries, message, size);
}

static const char *open_context(void *library)
{
    static const int attributes[] = {OSMESA_FORMAT,
                                     OSMESA_RGBA,
                                     OSMESA_PROFILE,
                                     OSMESA_CORE_PROFILE,
                                     OSMESA_CONTEXT_MAJOR_VERSION,
                                     3,
                                     OSMESA_CONTEXT_MINOR_VERSION,
                                     3,
                                     0};
    if (!gm_library_find(library, symbols, sizeof symbols / sizeof *symbols)) {
        return "libOSMesa is too old";
    }
    osmesa.context = osmesa.create(attributes, NULL);
    return osmesa.context && use() ? NULL : "OSMesa gives no OpenGL 3.3 context";
}

static gm_library_function find(const char *name)
{
    return (gm_library_function)osmesa.get_proc_address(name);
}

const struct gm_backend gm_backend_osmesa = {load, open_context, close_context, use, release, find};
