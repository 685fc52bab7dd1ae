/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of commands. */
#include "app/commands/commands.h"

#include <string.h>

#include "app/words/system.h"

const struct gm_command_row *const gm_commands[] = {
#define GM_COMMAND(name) &gm_command_##name,
#include "app/commands/commands.def"
#include "core/basics.h"
#undef GM_COMMAND
};
const size_t gm_command_count = GM_COUNT(gm_commands);

const struct gm_command_row *gm_command_find(const char *word)
{
    for (size_t i = 0; i < gm_command_count; i++) {
        if (strcmp(gm_commands[i]->name, word) == 0) {
            return gm_commands[i];
        }
    }
    return gm_scene_find(word) || gm_system_is(word) ? gm_commands[0] : NULL;
}
