/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_PRINTER_H
#define GM_APP_OUTPUT_PRINTER_H

#include "app/output/provenance.h"
#include "app/words/request.h"
#include "render/files/images.h"
#include "render/layout/appearance.h"
#include "render/picture/picture.h"

/* One picture to a file, in the format of its ending. */

enum gm_format { GM_FORMAT_PNG, GM_FORMAT_SVG, GM_FORMAT_PDF, GM_FORMAT_COUNT };

/* A picture's path, format and appearance. */
struct gm_print {
    const char *path; /* "-": standard output */
    enum gm_format format;
    struct gm_appearance look;
    size_t fields; /* set by printing: colour fields that a drawing stores as images */
};

/* "png", "svg", "pdf" */
const char *gm_format_name(enum gm_format format);
/* The format with that name, or of a file by its ending; false if there is no such format. */
bool gm_format_find(const char *name, enum gm_format *format);
bool gm_format_of(const char *path, enum gm_format *format);

/* Starts the slow part of printing, in parallel with the run. */
void gm_printer_expect(enum gm_format format);

/* The content of a file: its metadata, which name the painter (false: out of memory), and what fills the empty
   picture. */
struct gm_printed {
    const void *data;
    bool (*describe)(struct gm_provenance *provenance, const void *data, const struct gm_appearance *look,
                     const char *painter);
    void (*draw)(const void *data, struct gm_picture *picture);
};
/* Writes the file. Returns false with a sentence (GM_MESSAGE bytes). */
bool gm_print_write(struct gm_print *print, const struct gm_printed *content, char *message);

/* Complains that the picture could not be written to that path (NULL: unknown). Returns the exit status:
   3, or 141 without a message if standard output is a pipe without a reader. */
int gm_printer_fail(const char *path, const char *message);

/* Reports on standard error the written picture, if it is a file, with its table ("": none), and once the
   parts of it that are images. */
void gm_printer_report(const struct gm_print *print, const char *table);

/* Paints the lanes' current state into one file that `geomint again` can redraw, and makes its folders.
   `request` has the lanes' start and the changes since. Returns false with a sentence (GM_MESSAGE bytes). */
bool gm_still_write(struct gm_print *print, const struct gm_request *request,
                    const struct gm_lane *const *lanes, char *message);

/* The diagram of a study and its table: FOLDER/NAME.png and FOLDER/NAME.csv. */
struct gm_chart {
    const char *path;      /* the picture's path; NULL: FOLDER/NAME.ENDING; "-": without a table */
    const char *folder;    /* NULL: the current folder */
    const char *name;      /* the name of both files, without their endings */
    const char *command;   /* the words with which `again` repeats it, escaped, without the look */
    struct gm_print print; /* gm_chart_write sets its path */
    const void *data;
    void (*draw)(const void *data, struct gm_picture *picture); /* fills an empty picture */
    /* Writes the numbers; false with errno if they could not be read. NULL: they exist already. */
    bool (*write)(const void *data, FILE *table);
    char picture[4096], csv[4096]; /* the paths of the written files; the second is "" without a table */
};

/* Writes both files, and makes their folders. Returns false with a sentence (GM_MESSAGE bytes). */
bool gm_chart_write(struct gm_chart *chart, char *message);

#endif
