/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CHART_H
#define GM_APP_OUTPUT_CHART_H

#include "render/layout/theme.h"
#include "render/picture/picture.h"

/* The diagram of a study and its numbers, FOLDER/NAME.png and FOLDER/NAME.csv. */
struct gm_chart {
    const char *folder;  /* made if it is missing; NULL: the present one */
    const char *name;    /* of both files, without their endings */
    const char *command; /* the words that `again` measures it with, escaped; size and theme are added */
    int width, height;
    enum gm_theme theme;
    char png[4096], csv[4096]; /* where they are, when they are written */
};

/* Lets `draw` fill a picture from `data`, and `write` a file, which returns false with errno (NULL: the
   numbers are somewhere already). False with a sentence (GM_MESSAGE bytes). */
bool gm_chart_write(struct gm_chart *chart, const void *data,
                    void (*draw)(const void *data, struct gm_picture *picture),
                    bool (*write)(const void *data, const char *path), char *message);

#endif
