/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_SYSTEM_H
#define GM_APP_COMMANDS_SYSTEM_H

#include "app/commands/options.h"

/* geomint list SYSTEM: what a system says, and what was found out about it. The words behind the first give
   parameters other values. Returns the exit status. */
int gm_list_system(const struct gm_options *options, const char *path);

#endif
