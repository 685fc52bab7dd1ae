/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint tui, the explorer, and geomint terminal, what it found out. */
#include "app/commands/commands.h"
#include "app/explorer/explorer.h"
#include "app/output/say.h"

int gm_command_terminal(const struct gm_options *options)
{
    if (options->arguments.count > 0) {
        return gm_give_up(GM_EXIT_USAGE, "terminal takes no arguments");
    }
    return gm_finish(gm_terminal_report(&options->terminal));
}

int gm_command_tui(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_request request = {0};
    if (options->arguments.count > 0 &&
        !gm_request_parse(&request, options->arguments.count, options->arguments.words, 3, message)) {
        return gm_give_up(gm_request_refusal(&request), "%s", message);
    }
    const int status = gm_explorer(options->arguments.count > 0 ? &request : NULL, NULL, &options->terminal);
    gm_request_close(&request);
    return status;
}
