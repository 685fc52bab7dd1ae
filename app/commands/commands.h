/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_COMMANDS_H
#define GM_APP_COMMANDS_COMMANDS_H

#include "app/commands/options.h"

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

/* --version: the program, the OpenGL context and the libraries. Returns the exit status. */
int gm_version(void);
int gm_command_manual(const struct gm_options *options);
/* Takes the words as they are: an unfinished option is no mistake here. */
int gm_command_complete(int count, char *const words[]);

/* What the options say of the terminal. */
struct gm_overrides gm_overrides_of(const struct gm_options *options);

struct gm_command_row {
    const char *name, *synopsis, *help;
    enum gm_command bit;
    int (*function)(const struct gm_options *options); /* NULL: complete, whose options are not to be read */
};
extern const struct gm_command_row gm_commands[]; /* the first is the explorer */
extern const size_t gm_command_count;
/* The command of that name; for the name of a scene the explorer; or NULL. */
const struct gm_command_row *gm_command_find(const char *word);

/* Renders a request, as `geomint render`; output files below options->out begin with `name`. */
int gm_render(struct gm_request *request, const struct gm_options *options, const char *name);

#endif
