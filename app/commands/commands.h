/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_COMMANDS_H
#define GM_APP_COMMANDS_COMMANDS_H

#include "app/commands/options.h"

/* A command: its file defines it, and commands.def names it. Both functions return the exit status. */
struct gm_command_row {
    const char *name, *synopsis, *help;
    enum gm_command bit;
    int (*function)(const struct gm_options *options);
    int (*raw)(int count, char *const words[]); /* instead: an unfinished option is no mistake here */
};

#define GM_COMMAND(name) extern const struct gm_command_row gm_command_##name;
#include "app/commands/commands.def"
#undef GM_COMMAND

extern const struct gm_command_row *const gm_commands[]; /* the first is the explorer */
extern const size_t gm_command_count;
/* The command of that name; for the name of a scene the explorer; or NULL. */
const struct gm_command_row *gm_command_find(const char *word);

/* The tours, as `tour` and `list tours` print them. */
int gm_list_tours(bool json);

#endif
