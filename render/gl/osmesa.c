/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OSMesa: Mesa's renderer into memory. Mesa has dropped it since 25.1. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <GL/gl.h>
#include <GL/osmesa.h>

#include "render/gl/backend.h"

enum { SIDE = 16 }; /* side in pixels of the buffer that a context must have; nothing is drawn there */

/* clang-format off */
#define FUNCTIONS(F) \
    F(OSMesaCreateContextAttribs) F(OSMesaDestroyContext) F(OSMesaMakeCurrent) F(OSMesaGetProcAddress)
/* clang-format on */
static struct {
    OSMesaContext context;
    unsigned char buffer[SIDE * SIDE * 4];
} osmesa;
static struct {
    FUNCTIONS(GM_LIBRARY_POINTER)
} mesa;

static bool use(void)
{
    return mesa.OSMesaMakeCurrent(osmesa.context, osmesa.buffer, GL_UNSIGNED_BYTE, SIDE, SIDE);
}

static void release(void)
{
    mesa.OSMesaMakeCurrent(NULL, NULL, 0, 0, 0);
}

static void close_context(void)
{
    if (osmesa.context) {
        release();
        mesa.OSMesaDestroyContext(osmesa.context);
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
    if (!gm_library_find(library, FUNCTIONS(GM_LIBRARY_NAME), &mesa)) {
        return "libOSMesa is too old";
    }
    osmesa.context = mesa.OSMesaCreateContextAttribs(attributes, NULL);
    return osmesa.context && use() ? NULL : "OSMesa gives no OpenGL 3.3 context";
}

static gm_library_function find(const char *name)
{
    return (gm_library_function)mesa.OSMesaGetProcAddress(name);
}

const struct gm_backend gm_backend_osmesa = {load, open_context, close_context, use, release, find};
