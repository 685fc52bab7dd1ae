/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the commands that are studies of the explorer too have in common: all but how they print. */
#include "app/commands/measuring/studied.h"

#include <stdio.h>

#include "app/base/interrupt.h"
#include "app/commands/confirmed.h"
#include "app/commands/measuring/charted.h"
#include "app/output/say.h"
#include "core/memory.h"

int gm_command_study(const struct gm_options *options, enum gm_study_kind kind,
                     void (*print)(const union gm_study_table *table),
                     void (*print_json)(const union gm_study_table *table))
{
    char message[GM_MESSAGE], name[128];
    const struct gm_study_row *study = &gm_study_rows[kind];
    union gm_study_table table;
    if (!study->open(&table, &options->arguments, options->judge ? options->judge : options->measure,
                     message)) {
        gm_complain("%s", message);
        return gm_request_refusal(&table.request);
    }
    if (!gm_command_confirmed(options, &table.request)) {
        study->close(&table);
        return GM_EXIT_USAGE;
    }
    gm_catch_interrupts();
    int status = GM_EXIT_OK;
    const bool measured = study->measure(&table, &gm_terminal_listener, message);
    gm_terminal_listener_clear();
    if (gm_memory_was_short()) {
        gm_complain("not enough memory to measure what was asked for");
        status = GM_EXIT_MEMORY;
    } else if (measured) {
        if (options->json) {
            print_json(&table);
        } else if (!gm_options_take_stdout(options)) {
            print(&table);
        }
        snprintf(name, sizeof name, "%s-%s", table.request.scene->name, study->name);
        status = gm_command_chart(options, study->name, name, &table, study->draw, study->write);
    } else if (!gm_interrupted) {
        gm_complain("%s", message);
        status = study->refusal;
    }
    study->close(&table);
    return gm_finish(gm_interrupted ? GM_EXIT_INTERRUPTED : status);
}
