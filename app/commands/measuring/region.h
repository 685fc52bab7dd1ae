/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_MEASURING_REGION_H
#define GM_APP_COMMANDS_MEASURING_REGION_H

#include "app/commands/options.h"

/* geomint stability --region SCHEME; returns the exit status. */
int gm_region(const struct gm_options *options);

#endif
