/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_MEASURING_STUDIED_H
#define GM_APP_COMMANDS_MEASURING_STUDIED_H

#include "app/commands/options.h"
#include "app/grid/kinds/study.h"

/* The whole command of a study: reads its words, measures, prints the table and writes its chart. Returns the
   exit status. */
int gm_command_study(const struct gm_options *options, enum gm_study_kind kind,
                     void (*print)(const union gm_study_table *table),
                     void (*print_json)(const union gm_study_table *table));

#endif
