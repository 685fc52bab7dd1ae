/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_MEASURING_CHARTED_H
#define GM_APP_COMMANDS_MEASURING_CHARTED_H

#include "app/commands/options.h"
#include "render/picture/picture.h"

/* Writes the PNG and the CSV of a command that measures, as its options say, and tells of it. They are called
   `name` where the options have none. Returns the exit status. */
int gm_command_chart(const struct gm_options *options, const char *command, const char *name,
                     const void *data, void (*draw)(const void *data, struct gm_picture *picture),
                     bool (*write)(const void *data, const char *path));

#endif
