/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbered pictures of a render: which there are already, and whose they are. */
#include "app/output/frames.h"

#include <dirent.h>
#include <errno.h>
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/text.h"
#include "app/output/folder.h"
#include "render/files/temporary.h"

static char *identify(const struct gm_schedule *schedule, const struct gm_provenance *provenance,
                      unsigned program)
{
    unsigned checksum = 0;
    for (size_t i = 0; i < provenance->count; i++) {
        const char *text = provenance->texts[i].text;
        checksum = libdeflate_crc32(checksum, text, strlen(text) + 1);
    }
    return gm_text("%ld from t = %.17g to %.17g, render %08x, program %08x", schedule->count, schedule->first,
                   schedule->last, checksum, program);
}

char *gm_frames_text(const struct gm_frames *frames, long frame)
{
    return gm_text("%ld of %s", frame + 1, frames->identity);
}

char *gm_frames_path(const struct gm_frames *frames, long frame)
{
    return gm_text("%s/%s-%06ld.png", frames->folder, frames->name, frame);
}

/* Looks at one file of the folder: a frame, or what a killed run left of one. */
static bool look_at(struct gm_frames *frames, int folder, const char *file)
{
    const size_t length = strlen(frames->name);
    const bool hidden = file[0] == '.';
    long frame = 0;
    int used = 0;
    if (strncmp(file + hidden, frames->name, length) != 0 ||
        sscanf(file + hidden + length, "-%ld.png%n", &frame, &used) != 1 || used == 0 || frame < 0 ||
        frame >= frames->schedule->count) {
        return true;
    }
    if (hidden) {
        if (gm_schedule_is_ours(frames->schedule, frame) && gm_temporary_is_stale(file)) {
            unlinkat(folder, file, 0);
        }
        return true;
    }
    char *path = gm_frames_path(frames, frame), *text = gm_frames_text(frames, frame);
    const bool good = path && text;
    if (good && !frames->there[frame] && gm_png_tells(path, GM_KEY_FRAME, text)) {
        frames->there[frame] = true;
        frames->found += gm_schedule_is_ours(frames->schedule, frame);
    }
    free(path);
    free(text);
    return good;
}

/* What the folder holds is looked at, not every frame that there could be. */
static bool look(struct gm_frames *frames)
{
    frames->there = calloc((size_t)frames->schedule->count, sizeof *frames->there);
    DIR *folder = frames->there ? opendir(frames->folder) : NULL;
    bool good = frames->there != NULL;
    const struct dirent *entry = NULL;
    while (good && folder && (entry = readdir(folder))) {
        good = look_at(frames, dirfd(folder), entry->d_name);
    }
    if (folder) {
        closedir(folder);
    }
    return good;
}

bool gm_frames_open(struct gm_frames *frames, const struct gm_schedule *schedule, const char *folder,
                    const char *name, const struct gm_provenance *provenance, char *message)
{
    unsigned program = 0;
    *frames = (struct gm_frames){0};
    if (!gm_program_checksum(&program)) {
        return gm_refuse(message, "the program itself could not be read: %s", strerror(errno));
    }
    *frames = (struct gm_frames){
        .schedule = schedule,
        .folder = strdup(folder),
        .name = strdup(name),
        .pattern = gm_text("%s/%s-%%06ld.png", folder, name),
        .identity = identify(schedule, provenance, program),
    };
    if (!gm_folder_make(folder, message)) {
        gm_frames_close(frames);
        return false;
    }
    if (!frames->folder || !frames->name || !frames->pattern || !frames->identity || !look(frames)) {
        gm_refuse(message, "not enough memory for %ld frames", schedule->count);
        gm_frames_close(frames);
        return false;
    }
    return true;
}

void gm_frames_close(struct gm_frames *frames)
{
    free(frames->folder);
    free(frames->name);
    free(frames->pattern);
    free(frames->identity);
    free(frames->there);
    *frames = (struct gm_frames){0};
}

long gm_frames_missing(const struct gm_frames *frames, bool last)
{
    long found = -1;
    for (long frame = 0; frame < frames->schedule->count && (last || found < 0); frame++) {
        if (!frames->there[frame] && gm_schedule_is_ours(frames->schedule, frame)) {
            found = frame;
        }
    }
    return found;
}

void gm_frames_remove(const struct gm_frames *frames)
{
    for (long frame = 0; frame < frames->schedule->count; frame++) {
        char *path = gm_frames_path(frames, frame);
        if (path) {
            unlink(path);
        }
        free(path);
    }
    rmdir(frames->folder);
}
