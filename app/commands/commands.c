/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of commands. */
#include "app/commands/commands.h"

#include <string.h>

#include "scenes/frame/scene.h"

const struct gm_command_row gm_commands[] = {
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
    {"tour", "[NAME|FILE.tour]", "a class is led through steps; without a name, which tours there are",
     GM_TOUR, gm_command_tour},
    {"terminal", "", "what was found out about this terminal, and why", GM_TERMINAL, gm_command_terminal},
    {"manual", "", "the manual page, for man(1)", GM_MANUAL, gm_command_manual},
    {"complete", "[WORD ...]", "what the last word may become: shells ask this", GM_COMPLETE, NULL},
};
const size_t gm_command_count = sizeof gm_commands / sizeof gm_commands[0];

const struct gm_command_row *gm_command_find(const char *word)
{
    for (size_t i = 0; i < gm_command_count; i++) {
        if (strcmp(gm_commands[i].name, word) == 0) {
            return &gm_commands[i];
        }
    }
    return gm_scene_find(word) ? &gm_commands[0] : NULL;
}
