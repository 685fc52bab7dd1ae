/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_TOURS_READER_H
#define GM_APP_TOURS_READER_H

#include "app/tours/tour.h"

/* What the files of the tours' reader share: tour_lines.c makes an entry, a word and its text, of every line;
   tour_steps.c tries out the entries of one step after the other; tour.c does both for a file. */

enum gm_tour_word {
    GM_TOUR_TITLE,
    GM_TOUR_ABOUT,
    GM_TOUR_PLACE,
    GM_TOUR_STEP,
    GM_TOUR_SAY,
    GM_TOUR_ASK,
    GM_TOUR_ANSWER,
    GM_TOUR_SHOW,
    GM_TOUR_UNTIL,
    GM_TOUR_SECONDS,
    GM_TOUR_AT,
    GM_TOUR_STUDY,
    GM_TOUR_WATCH,
    GM_TOUR_TRY,
    GM_TOUR_WORDS
};
extern const char *const gm_tour_word_names[GM_TOUR_WORDS];

enum { GM_TOUR_STEPS = 60 }; /* a tour has at most so many */

struct gm_tour_entry {
    enum gm_tour_word word;
    long line;
    char *text;
};

struct gm_tour_reader {
    const char *name; /* of the file, in sentences */
    struct gm_tour_entry *entries;
    size_t count;
    char *message;
    struct gm_tour *tour;
};

/* Says a sentence with file and line; false. */
__attribute__((format(printf, 3, 4))) bool gm_tour_refuse(struct gm_tour_reader *reader, long line,
                                                          const char *format, ...);
bool gm_tour_short_of_memory(struct gm_tour_reader *reader);

/* Lines to entries. */
bool gm_tour_read_lines(struct gm_tour_reader *reader, const char *text, size_t size);

/* What an entry holds, where that is a number, or a text for a place that is still empty. */
bool gm_tour_read_number(struct gm_tour_reader *reader, const struct gm_tour_entry *entry, double *value);
bool gm_tour_take_text(struct gm_tour_reader *reader, const struct gm_tour_entry *entry, char **place);

/* The entries of one step to a step, of which the tour has room for GM_TOUR_STEPS; entries[0] is its title.
 */
bool gm_tour_read_step(struct gm_tour_reader *reader, const struct gm_tour_entry *entries, size_t count);

#endif
