/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the commands that measure have in common: their diagram and their table, as their options say. */
#include "app/commands/measuring/charted.h"

#include <stdio.h>
#include <stdlib.h>

#include "app/output/chart.h"
#include "app/output/provenance.h"
#include "app/output/say.h"

/* "stability kepler dt=0.1": what `again` reads; malloc'ed, NULL when memory is short. */
static char *command_line(const char *command, const struct gm_options *options)
{
    struct gm_arguments all = {0};
    char *words = NULL, *text = NULL;
    bool good = !options->on || (gm_arguments_add(&all, GM_ON) && gm_arguments_add(&all, options->on));
    for (int i = 0; good && i < options->arguments.count; i++) {
        good = gm_arguments_add(&all, options->arguments.words[i]);
    }
    words = good ? gm_arguments_join(command, &all) : NULL;
    if (words && asprintf(&text, "%s%s%s%s%s%s%s", words, options->measure ? " --measure " : "",
                          options->measure ? options->measure : "", options->region ? " --region " : "",
                          options->region ? options->region : "", options->judge ? " --judge " : "",
                          options->judge ? options->judge : "") < 0) {
        text = NULL;
    }
    gm_arguments_close(&all);
    free(words);
    return text;
}

int gm_command_chart(const struct gm_options *options, const char *command, const char *name,
                     const void *data, void (*draw)(const void *data, struct gm_picture *picture),
                     bool (*write)(const void *data, const char *path))
{
    char message[GM_MESSAGE] = "not enough memory";
    char *words = command_line(command, options);
    struct gm_chart chart = {.path = options->output,
                             .folder = options->out,
                             .name = options->name ? options->name : name,
                             .command = words,
                             .print = {.format = options->format, .look = options->look}};
    const bool good = words && gm_chart_write(&chart, data, draw, write, message);
    free(words);
    if (!good) {
        return gm_printer_fail(options->output, message);
    }
    gm_printer_report(&chart.print, write ? chart.csv : "");
    return GM_EXIT_OK;
}
