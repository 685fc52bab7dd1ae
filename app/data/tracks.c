/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tracks as an .npz file. */
#include "app/data/save.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/data/format.h"
#include "app/output/folder.h"
#include "core/expression/reader.h"
#include "render/files/temporary.h"
#include "render/message.h"

struct gm_tracks {
    const char *path;
    char *temporary;
    struct gm_bytes file;
    struct gm_npz npz;
    size_t lanes;
};

bool gm_tracks_knows(const char *path, const struct gm_scene *scene, char *message)
{
    if (scene->track_count == 0) {
        return gm_refuse(message, "scene %s records no tracks", scene->name);
    }
    return gm_word_ends(path, ".npz") ||
           gm_refuse(message, "%.300s cannot be saved: tracks go to an .npz file", path);
}

static bool complain(const struct gm_tracks *tracks, char *message)
{
    return gm_refuse(message, "%.360s could not be written: %s", tracks->path, strerror(tracks->file.why));
}

struct gm_tracks *gm_tracks_open(const char *path, size_t lanes, char *message)
{
    if (!gm_folder_make_for(path, message) || !gm_temporary_can_replace(path, message)) {
        return NULL;
    }
    struct gm_tracks *tracks = calloc(1, sizeof *tracks);
    if (!tracks) {
        gm_refuse(message, "not enough memory");
        return NULL;
    }
    gm_temporary_sweep(path);
    *tracks = (struct gm_tracks){.path = path, .lanes = lanes, .npz.file = &tracks->file};
    errno = ENOMEM;
    tracks->temporary = gm_temporary_name(path, ".tmp");
    tracks->file = gm_bytes_of(
        tracks->temporary ? open(tracks->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : -1);
    if (tracks->file.why != 0) {
        gm_tracks_close(tracks, true, message);
        return NULL;
    }
    return tracks;
}

bool gm_tracks_add(struct gm_tracks *tracks, size_t index, const struct gm_lane *lane, const char *meta,
                   char *message)
{
    char prefix[40] = "", name[96];
    if (tracks->lanes > 1) {
        snprintf(prefix, sizeof prefix, "lane%zu/", index);
    }
    snprintf(name, sizeof name, "%smeta", prefix);
    gm_npz_text(&tracks->npz, name, meta);
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        const struct gm_entries *entries = &lane->entries[i];
        struct gm_npz_shape shape = {.axes = 1, .lengths = {entries->count, entries->width}};
        snprintf(name, sizeof name, "%s%s_t", prefix, lane->scene->tracks[i].key);
        gm_npz_array(&tracks->npz, name, &shape, entries->times);
        snprintf(name, sizeof name, "%s%s", prefix, lane->scene->tracks[i].key);
        shape.axes = 2;
        gm_npz_array(&tracks->npz, name, &shape, entries->values);
    }
    return tracks->file.why == 0 || complain(tracks, message);
}

bool gm_tracks_close(struct gm_tracks *tracks, bool complete, char *message)
{
    const bool opened = tracks->file.file >= 0;
    gm_npz_finish(&tracks->npz);
    gm_npz_close(&tracks->npz);
    const bool whole = gm_bytes_close(&tracks->file) && complete;
    gm_bytes_note(&tracks->file, !whole || rename(tracks->temporary, tracks->path) == 0);
    const bool made = whole && tracks->file.why == 0;
    if (complete && !made) {
        complain(tracks, message);
    }
    if (opened && !made) {
        unlink(tracks->temporary);
    }
    free(tracks->temporary);
    free(tracks);
    return made || !complete;
}
