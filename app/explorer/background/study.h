/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_STUDY_H
#define GM_APP_EXPLORER_BACKGROUND_STUDY_H

#include "app/tours/tour.h"
#include "render/layout/theme.h"

/* A diagram that is measured in the background: work-precision or stability, in a thread of its own that
   leaves the processor to the one that draws. It alone touches its table; looks at it are handed over. */

struct gm_study_look {
    struct gm_picture *picture;
    char what[64]; /* under way */
    size_t done, all;
    bool finished;            /* by itself, or stopped */
    bool impossible;          /* nothing can be measured, and the message says why */
    char message[GM_MESSAGE]; /* the last news, and how many there were */
    unsigned long message_number;
};

struct gm_study;

/* Starts to measure; `words` are those of the command, the scene first. `wake` is an eventfd that is written
   to when there is a new look. NULL with a sentence (GM_MESSAGE bytes). */
struct gm_study *gm_study_open(enum gm_study_kind kind, const char *words, int wake, char *message);
/* Gives up what is not finished. NULL is ignored. */
void gm_study_close(struct gm_study *study);

const char *gm_study_words(const struct gm_study *study);
/* "work-precision" or "stability" */
const char *gm_study_name(enum gm_study_kind kind);

/* A new look since the last call, or NULL. It may be read, and its picture laid out, until the next one. */
struct gm_study_look *gm_study_take(struct gm_study *study);

/* The words of the run that panel number `panel` of its picture shows at (x, y), the scene first; malloc'ed,
   NULL: there is none. */
char *gm_study_pick(const struct gm_study *study, size_t panel, double x, double y);

/* Ends the measuring; what is finished stays. */
void gm_study_stop(struct gm_study *study);
/* Writes what there is as PNG and CSV here; the look after it says under what name. */
void gm_study_save(struct gm_study *study, enum gm_theme theme);

#endif
