/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_PRINTER_H
#define GM_APP_OUTPUT_PRINTER_H

#include "app/words/request.h"
#include "render/files/images.h"
#include "render/layout/appearance.h"
#include "render/picture/picture.h"

/* One picture to a file, in the format of its ending. */

enum gm_format { GM_FORMAT_PNG, GM_FORMAT_SVG, GM_FORMAT_PDF, GM_FORMAT_COUNT };

/* What is printed where. */
struct gm_print {
    const char *path; /* "-": standard output */
    enum gm_format format;
    struct gm_appearance look;
    size_t fields; /* set when it is printed: the fields of colours that a drawing holds as images */
};

/* "png", "svg", "pdf" */
const char *gm_format_name(enum gm_format format);
/* The format of that name, and that of a file by its ending; false if there is none. */
bool gm_format_find(const char *name, enum gm_format *format);
bool gm_format_of(const char *path, enum gm_format *format);

/* Begins, beside the run whose picture it will print, what takes long of opening a press. */
void gm_printer_expect(enum gm_format format);

/* A press for one format and look, which outlives it. NULL on failure, with a sentence (GM_MESSAGE bytes). */
struct gm_printer;
struct gm_printer *gm_printer_open(const struct gm_print *print, char *message);
void gm_printer_close(struct gm_printer *press);

/* What paints, for the file to tell. */
const char *gm_printer_backend(const struct gm_printer *press);

/* Writes the picture with what it tells of itself. False with a sentence (GM_MESSAGE bytes). */
bool gm_printer_write(struct gm_printer *press, struct gm_print *print, struct gm_picture *picture,
                      const struct gm_png_text *texts, size_t count, char *message);

/* Complains that the picture could not be written to that path (NULL: one that is not known). The status to exit with:
   3, or 141, without a word, where standard output is a pipe that nobody reads. */
int gm_printer_fail(const char *path, const char *message);

/* Says on standard error what was written, of a file, with the table beside it ("": none); and once what of
   it is an image. */
void gm_printer_report(const struct gm_print *print, const char *table);

/* Paints lanes as they are now into one file that `geomint again` can redo, and makes the folders that it
   lies in. `request` holds the lanes' start and the changes since. False with a sentence (GM_MESSAGE
   bytes). */
bool gm_still_write(struct gm_print *print, const struct gm_request *request,
                    const struct gm_lane *const *lanes, char *message);

/* The diagram of a study and its numbers, beside each other: FOLDER/NAME.png and FOLDER/NAME.csv. */
struct gm_chart {
    const char *path;   /* of the picture; NULL: FOLDER/NAME with the format's ending; "-": no numbers then */
    const char *folder; /* NULL: the present one */
    const char *name;   /* of both files, without their endings */
    const char *command;           /* the words that `again` measures it with, escaped; the look is added */
    struct gm_print print;         /* its path is set here */
    char picture[4096], csv[4096]; /* where they are, when they are written; the second is "" for none */
};

/* Lets `draw` fill a picture from `data`, and `write` a file, which returns false with errno (NULL: the
   numbers are somewhere already); makes the folders that they lie in. False with a sentence (GM_MESSAGE
   bytes). */
bool gm_chart_write(struct gm_chart *chart, const void *data,
                    void (*draw)(const void *data, struct gm_picture *picture),
                    bool (*write)(const void *data, const char *path), char *message);

#endif
