/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_CHART_H
#define GM_APP_OUTPUT_CHART_H

#include "app/commands/options.h"

/* The PNG and the CSV of a command that measures: OUT/NAME.png and OUT/NAME.csv. */

struct gm_chart {
    const struct gm_options *options;
    const char *command; /* "stability" */
    char png[4096], csv[4096];
};

/* Settles the paths, from `name` unless the options have one, and makes the folder. False with a sentence. */
bool gm_chart_open(struct gm_chart *chart, const struct gm_options *options, const char *command,
                   const char *name, char *message);

/* Lets `draw` fill a picture from `data` and writes it as PNG, with the command that `again` needs. False
   with a sentence. */
bool gm_chart_paint(const struct gm_chart *chart, const void *data,
                    void (*draw)(const void *data, struct gm_picture *picture), char *message);

/* Says on standard error that both are written. */
void gm_chart_tell(const struct gm_chart *chart);

#endif
