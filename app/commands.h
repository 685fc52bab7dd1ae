/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_H
#define GM_APP_COMMANDS_H

#include "app/options.h"

/* One function a command; each returns the exit status. */
int gm_command_tui(const struct gm_options *options);
int gm_command_list(const struct gm_options *options);
int gm_command_run(const struct gm_options *options);
int gm_command_render(const struct gm_options *options);
int gm_command_figures(const struct gm_options *options);
int gm_command_work_precision(const struct gm_options *options);
int gm_command_stability(const struct gm_options *options);
int gm_command_certify(const struct gm_options *options);
int gm_command_again(const struct gm_options *options);
int gm_command_tour(const struct gm_options *options);
int gm_command_terminal(const struct gm_options *options);

/* Renders a request, as `geomint render`; output files below options->out begin with `name`. */
int gm_render(struct gm_request *request, const struct gm_options *options, const char *name);

#endif
