/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_PROVENANCE_H
#define GM_APP_OUTPUT_PROVENANCE_H

#include "app/base/arguments.h"
#include "app/words/request.h"
#include "render/files/images.h"
#include "render/layout/appearance.h"

/* The metadata of a PNG: enough for `geomint again`. */

enum { GM_PROVENANCE_TEXTS = 15 };

struct gm_provenance {
    struct gm_png_text texts[GM_PROVENANCE_TEXTS]; /* malloc'ed */
    size_t count;
    bool failed; /* true: memory was short */
};

/* Keys of the chunks that `again` reads. */
#define GM_KEY_ARGUMENTS "geomint:arguments"
#define GM_KEY_CHANGES "geomint:changes"
#define GM_KEY_STEPS "geomint:steps"     /* the number of steps of each lane, separated by blanks */
#define GM_KEY_PICTURE "geomint:picture" /* WIDTHxHEIGHT theme */
#define GM_KEY_SCALE "geomint:scale"     /* the scale of letters and lines; default: 1 */
#define GM_KEY_DPI "geomint:dpi"         /* pixels per inch; default: 96 */
#define GM_KEY_PAGE "geomint:page"       /* 80x60, in mm; default: from the pixels */
#define GM_KEY_TITLE "geomint:title"     /* the picture's title; default: the scene's */
#define GM_KEY_SYSTEM "geomint:system"   /* the text of a system, if the scene is a file's */
#define GM_KEY_PAINTER "geomint:painter" /* a PNG's gm_canvas_backend; else the writer */
#define GM_KEY_ROOM "geomint:room" /* the name of a file's room, with a checksum of it and of its mesh */

/* a chart has the words of its command line instead of all these */
#define GM_KEY_COMMAND "geomint:command"

#define GM_KEY_FRAME "geomint:frame"       /* the frame and its render */
#define GM_KEY_FAILURES "geomint:failures" /* a line for each lane that has failed */

/* Everything but the steps. Returns false when out of memory. */
bool gm_provenance_make(struct gm_provenance *provenance, const struct gm_request *request,
                        const struct gm_appearance *look, const char *backend);
/* The same for a chart: the words with which `again` repeats it, to which the look is added, and the text
   of its system, or NULL. */
bool gm_provenance_of_command(struct gm_provenance *provenance, const char *command, const char *system,
                              const struct gm_appearance *look, const char *backend);
void gm_provenance_close(struct gm_provenance *provenance);

/* Writes the parameters of every lane that have an effect, a line a lane; as the identity of a run that a checkpoint
   continues, all of them but until, which may change. */
void gm_provenance_put_lanes(FILE *stream, const struct gm_request *request, bool identity);

/* The checksum of the running program: another build's results are not ours, whatever its version is.
   Returns false if the program cannot be read. */
bool gm_program_checksum(unsigned *checksum);

/* The index of a command's word that is the scene's: the first after its name, or the value of GM_ON for
   `certify`, which then comes first. */
#define GM_ON "--on"
int gm_provenance_scene_place(const struct gm_arguments *command);

/* The steps of the lanes now, as the text of GM_KEY_STEPS; malloc'ed. Returns NULL when out of memory. A
   failed step counts: `again` has to try it. */
char *gm_provenance_steps(const struct gm_lane *const *lanes, size_t count);

/* A line for each lane that has failed; malloc'ed. Returns NULL when out of memory. */
char *gm_provenance_failures(const struct gm_lane *const *lanes, size_t count);

/* Adds the steps of the lanes and, with `failures`, a line for each lane that has failed. Returns false
   when out of memory. */
bool gm_provenance_take_lanes(struct gm_provenance *provenance, const struct gm_lane *const *lanes,
                              size_t count, bool failures);

#endif
