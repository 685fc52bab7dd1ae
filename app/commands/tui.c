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
    const struct gm_arguments *words = &options->arguments;
    const struct gm_request *request =
        words->count > 0 ? gm_command_parse(options, words->count, words->words, GM_RENDER_SCHEMES) : NULL;
    return gm_explorer(request, NULL, &options->terminal);
}
