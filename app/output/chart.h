/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CHART_H
#define GM_APP_OUTPUT_CHART_H

#include "app/output/printer.h"

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
