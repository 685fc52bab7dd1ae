/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parameter trails= of scenes of orbits: which part of the past their pictures draw. */
#ifndef GM_SCENES_COMMON_TRAILS_H
#define GM_SCENES_COMMON_TRAILS_H

#include "scenes/common/entries.h"
#include "scenes/common/rows.h"

extern const char *const gm_trails_words[];
/* Returns true if the text is yes, no or a time above 0, else false with a sentence. */
bool gm_trails_admit(const struct gm_parameter *row, const char *text, char *sentence);
/* Returns the first of the entries that is drawn at time t. */
size_t gm_trails_from(const char *text, const struct gm_entries *entries, double t);

/* The row of the member `trails`, a char[GM_TEXT_SIZE]. */
#define GM_TRAILS_ROW(own)                                                                                   \
    GM_TEXT_ROW(own, trails, "trails", "yes", "paths of the past: yes, no, or those of the last time T",     \
                .choices = gm_trails_words, .admits = gm_trails_admit, .live = true, .looks = true)

#endif
