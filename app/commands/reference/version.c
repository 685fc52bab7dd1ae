/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint --version: the program, what paints its pictures, and the libraries it runs with. */
#include <curses.h>
#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include <gsl/gsl_version.h>
#include <libdeflate.h>
#include <png.h>
#include <stdio.h>
#include <suitesparse/cholmod.h>

#include "app/commands/reference/version.h"
#include "app/request/drive.h"
#include "core/memory.h"
#include "render/gl/canvas.h"
#include "render/message.h"
#include "render/vector/pdf.h"

static void print_painter(void)
{
    char message[GM_MESSAGE];
    enum { SMALL = 64 }; /* any size tells */
    struct gm_canvas *canvas =
        gm_canvas_open(&(struct gm_appearance){.width = SMALL, .height = SMALL}, message);
    if (canvas && !gm_memory_was_short()) {
        printf("%s\n", gm_canvas_backend(canvas));
    } else if (!canvas) {
        printf("no pictures: %s\n", message);
    }
    gm_canvas_close(canvas);
}

static void print_libraries(void)
{
    int major = 0, minor = 0, patch = 0, sparse[3] = {0};
    FT_Library freetype;
    if (FT_Init_FreeType(&freetype) != 0) {
        gm_memory_refused(); /* nothing else keeps it from starting */
        return;
    }
    FT_Library_Version(freetype, &major, &minor, &patch);
    FT_Done_FreeType(freetype);
    cholmod_version(sparse);
    int fonts = FcGetVersion();
    printf("libpng %s, libdeflate %s, FreeType %d.%d.%d, fontconfig %d.%d.%d\n", png_get_libpng_ver(NULL),
           LIBDEFLATE_VERSION_STRING, major, minor, patch, fonts / 10000, fonts / 100 % 100, fonts % 100);
    printf("%s\n", gm_pdf_backend());
    printf("%s, GSL %s, CHOLMOD %d.%d.%d\n", curses_version(), gsl_version, sparse[0], sparse[1], sparse[2]);
}

int gm_version(void)
{
    printf("geomint %s\n", GM_VERSION);
    print_painter();
    print_libraries();
    return gm_finish(GM_EXIT_OK);
}
