/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "app/commands.h"
#include "app/drive.h"
#include "app/explorer/explorer.h"
#include "app/explorer/terminal.h"
#include "app/nearest.h"

static const struct {
    const char *name, *synopsis, *help;
    enum gm_command bit;
    int (*function)(const struct gm_options *options);
} commands[] = {
    {"tui", "[SCENE] [key=value ...]", "the explorer in the terminal (also without \"tui\")", GM_TUI,
     gm_command_tui},
    {"list", "[scenes|schemes|figures|SCENE]", "what there is", GM_LIST, gm_command_list},
    {"run", "SCENE [key=value ...]", "numbers", GM_RUN, gm_command_run},
    {"render", "SCENE [key=value ...]", "pictures, frames, movies", GM_RENDER, gm_command_render},
    {"figures", "[NAME ...]", "published figures, made again", GM_FIGURES, gm_command_figures},
    {"work-precision", "SCENE [key=value ...]",
     "error against run time and evaluations, of every scheme that fits", GM_WORK_PRECISION,
     gm_command_work_precision},
    {"stability", "SCENE [key=value ...]",
     "which time step keeps which scheme bounded, and how it fails beyond", GM_STABILITY,
     gm_command_stability},
    {"certify", "SCHEME|all", "measured order and properties against the claims", GM_CERTIFY,
     gm_command_certify},
    {"again", "FILE.png", "make a picture once more from what it tells of itself", GM_AGAIN,
     gm_command_again},
    {"terminal", "", "what was found out about this terminal, and why", GM_TERMINAL, gm_command_terminal},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static const char *command_name(size_t i, const void *data)
{
    return (void)data, commands[i].name;
}

static int help(void)
{
    printf("geomint %s: see what a geometric integrator keeps and what an ordinary one destroys.\n\n"
           "  geomint [tui [SCENE] [key=value ...]]\n",
           GM_VERSION);
    for (size_t i = 0; i < COMMANDS; i++) {
        printf("  geomint %s %s\n      %s\n", commands[i].name, commands[i].synopsis, commands[i].help);
        gm_options_help(commands[i].bit);
    }
    printf(
        "  geomint --version | --help\n\n"
        "key=value sets a parameter (geomint list SCENE names them), scheme=a,b,c the schemes; every key takes\n"
        "a list, and lanes are the product of the lists (zip=yes pairs them). Numbers are typed as 1e-3, pi/60.\n"
        "Exit: 0 done, 1 wrong usage, 2 numerical failure, 3 a file, 4 a broken claim, 130 interrupted.\n");
    return gm_finish(GM_EXIT_OK);
}

static struct gm_overrides overrides_of(const struct gm_options *options)
{
    return (struct gm_overrides){
        .colours = options->colours, .graphics = options->graphics, .theme = options->look};
}

int gm_command_terminal(const struct gm_options *options)
{
    if (options->word_count > 0) {
        gm_complain("terminal takes no arguments");
        return GM_EXIT_USAGE;
    }
    const struct gm_overrides overrides = overrides_of(options);
    return gm_finish(gm_terminal_report(&overrides));
}

int gm_command_tui(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_request request = {0};
    if (options->word_count > 0 &&
        !gm_request_parse(&request, options->word_count, options->words, 3, message)) {
        gm_complain("%s", message);
        return GM_EXIT_USAGE;
    }
    const struct gm_overrides overrides = overrides_of(options);
    const int status = gm_explorer(options->word_count > 0 ? &request : NULL, &overrides);
    gm_request_close(&request);
    return status;
}

/* Which command a word is: its index, or that of tui for a scene's name, or -1. */
static int command_of(const char *word)
{
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(commands[i].name, word) == 0) {
            return i;
        }
    }
    return gm_scene_find(word) ? 0 : -1;
}

int main(int argc, char *argv[])
{
    setlocale(LC_CTYPE, "");
    /* a broken pipe and a full disk are answered where they are written to */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    int command = 0, first = 1;
    if (argc > 1) {
        if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "help") == 0) {
            return help();
        }
        if (strcmp(argv[1], "--version") == 0) {
            printf("geomint %s\n", GM_VERSION);
            return gm_finish(GM_EXIT_OK);
        }
        command = command_of(argv[1]);
        if (command < 0) {
            const char *near = gm_nearest(argv[1], COMMANDS, command_name, NULL);
            gm_complain("there is no command or scene \"%.60s\"%s%s", argv[1],
                        near ? "; did you mean " : "; see geomint --help", near ? near : "");
            return GM_EXIT_USAGE;
        }
        /* a scene's name opens the explorer, and is its first word */
        first = strcmp(commands[command].name, argv[1]) == 0 ? 2 : 1;
    }
    char message[GM_MESSAGE];
    struct gm_options options;
    int status = GM_EXIT_USAGE;
    if (gm_options_parse(&options, commands[command].bit, argc, argv, first, message)) {
        status = commands[command].function(&options);
    } else {
        gm_complain("%s", message);
    }
    gm_options_close(&options);
    return status;
}
