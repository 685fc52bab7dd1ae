/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_MEASURING_MEASURING_H
#define GM_APP_COMMANDS_MEASURING_MEASURING_H

#include "app/commands/commands.h"
#include "app/grid/grid.h"

/* Writes the picture and the table of a measuring command, as its options demand, and reports them; the chart
   has its data, its functions and its default name. Returns the exit status. */
int gm_command_chart(const struct gm_options *options, const char *command, struct gm_chart *chart);

/* The whole command of a study: reads its words, measures, prints the table and writes its chart. Returns the
   exit status. */
int gm_command_study(const struct gm_options *options, enum gm_study_kind kind);

#endif
