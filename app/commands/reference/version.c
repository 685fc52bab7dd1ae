/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint --version: the program, its features here, and its libraries. All but GSL are loaded when
   they are needed; their versions are those of the build. `geomint terminal` reports the painter. */
#include <curses.h>
#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include <cairo.h>
#include <gsl/gsl_version.h>
#include <libdeflate.h>
#include <png.h>
#include <stdio.h>
#include <suitesparse/cholmod.h>

#include "app/commands/reference/reference.h"
#include "app/native/cache.h"
#include "app/output/say.h"
#include "core/ode/kernel/loops.h"
#include "render/pixels/canvas.h"

static void print_libraries(void)
{
    printf("libpng %s, libdeflate %s, FreeType %d.%d.%d, fontconfig %d.%d.%d\n", PNG_LIBPNG_VER_STRING,
           LIBDEFLATE_VERSION_STRING, FREETYPE_MAJOR, FREETYPE_MINOR, FREETYPE_PATCH, FC_MAJOR, FC_MINOR,
           FC_REVISION);
    printf("Cairo %s\n", CAIRO_VERSION_STRING);
    printf("ncurses %s.%d, GSL %s, CHOLMOD %d.%d.%d\n", NCURSES_VERSION, NCURSES_VERSION_PATCH, gsl_version,
           CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION);
}

/* Looks for external programs without starting them. */
static void print_features(void)
{
    char path[GM_CACHE_PATH], kernels[GM_CACHE_PATH], message[GM_MESSAGE];
    struct stat about;
    struct gm_digest unused = gm_digest_open();
    gm_say("pictures: PNG, SVG, PDF; states: NPZ, CSV, VTK; movies: %s",
           gm_program_find("ffmpeg", path, &about) ? path : "none, as there is no ffmpeg");
    const char *painter = getenv("GEOMINT_PAINTER");
    if (!gm_canvas_choose(NULL, message)) {
        gm_say("painter: none, as %s", message);
    } else {
        gm_say("painter: %s", painter && *painter
                                  ? painter
                                  : "auto (osmesa for PNG and movies if it can be loaded, else own)");
    }
    gm_kernel_folder(kernels, sizeof kernels);
    const bool sources = stat(kernels, &about) == 0, compiler = sources && gm_compiler_find(path, &unused);
    gm_say("loops: %s; user-defined systems: interpreted%s%s", gm_isa_name(gm_isa_best()),
           compiler  ? ", or compiled by "
           : sources ? ", as there is no C compiler"
                     : ", as the sources of their loops are not there",
           compiler ? path : "");
}

int gm_version(void)
{
    printf("geomint %s\n", GM_VERSION);
    print_features();
    print_libraries();
    return gm_finish(GM_EXIT_OK);
}
