/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_TRACKS_H
#define GM_APP_DATA_TRACKS_H

#include "scenes/common/lane.h"

/* What lanes have recorded on their way (trails, crossings of a section ...) as an .npz file: of each track
   the entries, NAME with an axis of entries and one of numbers, and the times, NAME_t. */

struct gm_tracks;

/* Whether the file ends in .npz and the scene has tracks; false with a sentence (GM_MESSAGE bytes). */
bool gm_tracks_knows(const char *path, const struct gm_scene *scene, char *message);

/* Begins a file of `lanes` lanes; NULL with a sentence. */
struct gm_tracks *gm_tracks_open(const char *path, size_t lanes, char *message);
/* Adds lane `index`, and what was run (gm_meta_text). False with a sentence; so is the following. */
bool gm_tracks_add(struct gm_tracks *tracks, size_t index, const struct gm_lane *lane, const char *meta,
                   char *message);
/* Puts the file in its place if it is `complete`, and frees. */
bool gm_tracks_close(struct gm_tracks *tracks, bool complete, char *message);

#endif
