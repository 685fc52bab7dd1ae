/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_CONFIRMED_H
#define GM_APP_COMMANDS_CONFIRMED_H

#include "app/commands/options.h"
#include "app/words/request.h"

/* More steps than these are made if --yes confirms that. */
extern const double gm_many_steps;

/* Whether the steps of a request are to be made; false with a sentence on how many they are and how long they take. */
bool gm_command_confirmed(const struct gm_options *options, const struct gm_request *request);

/* "3.2 years" */
void gm_put_duration(double seconds, char *text, size_t size);

#endif
