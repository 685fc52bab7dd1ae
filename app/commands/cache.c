/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint cache: the loops that were compiled, listed and removed. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/native/cache.h"
#include "app/output/say.h"
#include "core/expression/number.h"
#include "core/memory.h"

int gm_command_cache(const struct gm_options *options)
{
    char folder[GM_CACHE_PATH], message[GM_MESSAGE];
    if (options->arguments.count > 0) {
        return gm_give_up(GM_EXIT_USAGE, "cache takes no word: \"%.60s\"", options->arguments.words[0]);
    }
    gm_command_end_if(options, !gm_cache_folder(folder, message), GM_EXIT_FILE, "%s", message);
    if (options->clear) {
        size_t removed;
        const bool all = gm_cache_clear(folder, &removed, message);
        gm_say("%zu removed from %s", removed, folder);
        if (!all) {
            gm_complain("%s", message);
        }
        return all ? GM_EXIT_OK : GM_EXIT_FILE;
    }
    size_t count = 0, bytes = 0;
    struct gm_cache_entry *entries = NULL;
    if (!gm_cache_list(folder, &entries, &count) || gm_memory_was_short()) {
        const bool short_of_memory = gm_memory_was_short() || errno == ENOMEM;
        gm_complain("%s could not be read: %s", folder,
                    short_of_memory ? "not enough memory" : strerror(errno));
        free(entries);
        return short_of_memory ? GM_EXIT_MEMORY : GM_EXIT_FILE;
    }
    for (size_t i = 0; i < count; i++) {
        char used[32];
        struct tm date;
        bytes += entries[i].size;
        strftime(used, sizeof used, "%Y-%m-%d %H:%M", localtime_r(&entries[i].used, &date));
        gm_say("%s  %8zu bytes  %s", entries[i].key.text, entries[i].size, used);
    }
    gm_say("%zu kernel%s of %zu bytes in %s", count, gm_plural((double)count), bytes, folder);
    free(entries);
    return GM_EXIT_OK;
}
