/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_TUI_H
#define GM_APP_COMMANDS_TUI_H

#include "app/commands/options.h"
#include "app/explorer/terminal/terminal.h"

/* What the options of a command say of the terminal. */
struct gm_overrides gm_overrides_of(const struct gm_options *options);

#endif
