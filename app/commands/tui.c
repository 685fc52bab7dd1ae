/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint tui, the explorer, and geomint terminal, what it found out. */
#include "app/commands/tui.h"

#include "app/commands/commands.h"
#include "app/explorer/explorer.h"
#include "app/output/say.h"

struct gm_overrides gm_overrides_of(const struct gm_options *options)
{
    return (struct gm_overrides){
        .colours = options->colours, .graphics = options->graphics, .theme = options->shade};
}

static int command_terminal(const struct gm_options *options)
{
    if (options->arguments.count > 0) {
        gm_complain("terminal takes no arguments");
        return GM_EXIT_USAGE;
    }
    const struct gm_overrides overrides = gm_overrides_of(options);
    return gm_finish(gm_terminal_report(&overrides));
}

const struct gm_command_row gm_command_terminal = {
    .name = "terminal",
    .synopsis = "",
    .help = "what was found out about this terminal, and why",
    .bit = GM_TERMINAL,
    .function = command_terminal,
};

static int command_tui(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_request request = {0};
    if (options->arguments.count > 0 &&
        !gm_request_parse(&request, options->arguments.count, options->arguments.words, 3, message)) {
        gm_complain("%s", message);
        return gm_request_refusal(&request);
    }
    const struct gm_overrides overrides = gm_overrides_of(options);
    const int status = gm_explorer(options->arguments.count > 0 ? &request : NULL, &overrides);
    gm_request_close(&request);
    return status;
}

const struct gm_command_row gm_command_tui = {
    .name = "tui",
    .synopsis = "[SCENE] [key=value ...]",
    .help = "the explorer in the terminal (also without \"tui\")",
    .bit = GM_TUI,
    .function = command_tui,
};
