/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step of a tour: what it tells, and what it shows, which is tried out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/request/words.h"
#include "app/studies/stability.h"
#include "app/studies/work.h"
#include "app/tours/reader.h"

enum { MOST_WORDS = 64, MOST_SCHEMES = 3 };

static const double usual_seconds = 8;

/* Reads the words of step->show; false with a sentence. */
static bool parse_show(struct gm_tour_step *step, char *message)
{
    char *list[MOST_WORDS], *copy = strdup(step->show);
    if (!copy) {
        snprintf(message, GM_MESSAGE, "not enough memory");
        return false;
    }
    const int count = gm_words_split(copy, list, MOST_WORDS);
    gm_request_close(&step->request);
    const bool good = gm_request_parse(&step->request, count, list, MOST_SCHEMES, message);
    free(copy);
    return good;
}

static bool read_show(struct gm_tour_reader *reader, const struct gm_tour_entry *entry,
                      const struct gm_tour_entry *until, struct gm_tour_step *step)
{
    char message[GM_MESSAGE];
    if (!parse_show(step, message)) {
        return gm_tour_refuse(reader, entry->line, "%s", message);
    }
    /* a scene that is told where to stop draws its time axes so far */
    if (until && !strstr(step->show, " until=") && !strstr(step->show, " steps=")) {
        char *longer = NULL;
        if (asprintf(&longer, "%s until=%s", step->show, until->text) < 0) {
            return gm_tour_short_of_memory(reader);
        }
        free(step->show);
        step->show = longer;
        if (!parse_show(step, message)) {
            return gm_tour_refuse(reader, until->line, "%s", message);
        }
    }
    const struct gm_timing *timing = step->request.lanes[0].parameters;
    if (isnan(step->until)) {
        step->until = timing->until;
        for (size_t i = 1; i < step->request.count; i++) {
            step->until =
                fmax(step->until, ((const struct gm_timing *)step->request.lanes[i].parameters)->until);
        }
    }
    return true;
}

static bool read_study(struct gm_tour_reader *reader, const struct gm_tour_entry *entry,
                       struct gm_tour_step *step)
{
    static const char *const names[GM_STUDY_COUNT] = {"", "work-precision", "stability"};
    char message[GM_MESSAGE], *list[MOST_WORDS], *copy = strdup(entry->text);
    if (!copy) {
        return gm_tour_short_of_memory(reader);
    }
    const int count = gm_words_split(copy, list, MOST_WORDS);
    for (int i = GM_STUDY_WORK; i < GM_STUDY_COUNT; i++) {
        if (count > 0 && strcmp(list[0], names[i]) == 0) {
            step->study = (enum gm_study_kind)i;
        }
    }
    bool good = true;
    const struct gm_options options = {.words = list + 1, .word_count = count - 1};
    switch (step->study) {
    case GM_STUDY_WORK: {
        struct gm_work_table table;
        good = gm_work_open(&table, &options, message);
        if (good) {
            gm_work_close(&table);
        }
        break;
    }
    case GM_STUDY_STABILITY: {
        struct gm_stability_table table;
        good = gm_stability_open(&table, &options, message);
        if (good) {
            gm_stability_close(&table);
        }
        break;
    }
    default:
        snprintf(message, sizeof message, "a study is work-precision or stability, with a scene: \"%.60s\"",
                 entry->text);
        good = false;
    }
    free(copy);
    if (!good) {
        return gm_tour_refuse(reader, entry->line, "%s", message);
    }
    step->study_words = strdup(entry->text + strlen(names[step->study]));
    return step->study_words || gm_tour_short_of_memory(reader);
}

/* "2*pi lane=2 scheme=midpoint"; tried out on a lane at its start. */
static bool read_change(struct gm_tour_reader *reader, const struct gm_tour_entry *entry,
                        const struct gm_request *shown, struct gm_tour_step *step)
{
    char message[GM_MESSAGE], *list[4], *copy = strdup(entry->text);
    struct gm_tour_change *more = realloc(step->changes, (step->change_count + 1) * sizeof *more);
    if (more) {
        step->changes = more;
    }
    if (!copy || !more) {
        free(copy);
        return gm_tour_short_of_memory(reader);
    }
    struct gm_tour_change *change = &more[step->change_count];
    *change = (struct gm_tour_change){.lane = GM_EVERY_LANE};
    const int count = gm_words_split(copy, list, 4);
    double lane = NAN;
    const bool has_lane = count == 3 && strncmp(list[1], "lane=", 5) == 0;
    bool good = true;
    if ((count != 2 && !has_lane) || !gm_number_parse(list[0], &change->t) || !isfinite(change->t)) {
        good = gm_tour_refuse(reader, entry->line,
                              "a change is \"at: TIME key=value\" or \"at: TIME lane=N scheme=NAME\"");
    } else if (has_lane && (!gm_number_parse(list[1] + 5, &lane) ||
                            !(lane >= 1 && lane <= (double)shown->count) || lane != floor(lane))) {
        good = gm_tour_refuse(reader, entry->line, "%.40s: there are lanes 1 to %zu", list[1], shown->count);
    } else if (has_lane && strncmp(list[2], "scheme=", 7) != 0) {
        good =
            gm_tour_refuse(reader, entry->line, "lane= goes with scheme=; a parameter changes in every lane");
    } else {
        change->lane = has_lane ? (long)lane - 1 : GM_EVERY_LANE;
        snprintf(change->text, sizeof change->text, "%s", list[count - 1]);
        struct gm_lane *trial = gm_request_open_lane(shown, has_lane ? (size_t)change->lane : 0, message);
        good = (trial && gm_change_apply(trial, change->text, message)) ||
               gm_tour_refuse(reader, entry->line, "%s", message);
        gm_lane_close(trial);
    }
    free(copy);
    step->change_count += good;
    return good;
}

static int by_time(const void *a, const void *b)
{
    const struct gm_tour_change *x = a, *y = b;
    return (x->t > y->t) - (x->t < y->t);
}

/* Texts and numbers of one step; what it shows comes after them. */
static bool take_entry(struct gm_tour_reader *reader, const struct gm_tour_entry *entry,
                       struct gm_tour_step *step)
{
    char **const places[GM_TOUR_WORDS] = {
        [GM_TOUR_STEP] = &step->title,    [GM_TOUR_SAY] = &step->say,   [GM_TOUR_ASK] = &step->ask,
        [GM_TOUR_ANSWER] = &step->answer, [GM_TOUR_SHOW] = &step->show, [GM_TOUR_WATCH] = &step->watch,
        [GM_TOUR_TRY] = &step->attempt};
    switch (entry->word) {
    case GM_TOUR_UNTIL:
        return gm_tour_read_number(reader, entry, &step->until);
    case GM_TOUR_SECONDS:
        return gm_tour_read_number(reader, entry, &step->seconds) &&
               ((step->seconds >= 1 && step->seconds <= 600) ||
                gm_tour_refuse(reader, entry->line, "seconds: %.60s does not lie between 1 and 600",
                               entry->text));
    case GM_TOUR_AT:
        return true;
    case GM_TOUR_STUDY:
        return (!step->study_words && step->study == GM_STUDY_NONE)
                   ? read_study(reader, entry, step)
                   : gm_tour_refuse(reader, entry->line, "study: is given twice");
    default:
        return places[entry->word]
                   ? gm_tour_take_text(reader, entry, places[entry->word])
                   : gm_tour_refuse(reader, entry->line,
                                    "%s: stands before the first step:", gm_tour_word_names[entry->word]);
    }
}

static const struct gm_tour_entry *entry_of(const struct gm_tour_entry *entries, size_t count,
                                            enum gm_tour_word word)
{
    for (size_t i = 0; i < count; i++) {
        if (entries[i].word == word) {
            return &entries[i];
        }
    }
    return NULL;
}

/* entries[0] is the step's title. */
bool gm_tour_read_step(struct gm_tour_reader *reader, const struct gm_tour_entry *entries, size_t count)
{
    struct gm_tour *tour = reader->tour;
    const size_t number = tour->count;
    if (number == GM_TOUR_STEPS) {
        return gm_tour_refuse(reader, entries[0].line, "a tour has at most %d steps", GM_TOUR_STEPS);
    }
    struct gm_tour_step *step = &tour->steps[tour->count++];
    *step = (struct gm_tour_step){.until = NAN, .seconds = usual_seconds};
    for (size_t i = 0; i < count; i++) {
        if (!take_entry(reader, &entries[i], step)) {
            return false;
        }
    }
    const struct gm_tour_entry *show = entry_of(entries, count, GM_TOUR_SHOW),
                               *until = entry_of(entries, count, GM_TOUR_UNTIL);
    if (!step->say) {
        return gm_tour_refuse(reader, entries[0].line, "the step \"%.60s\" has no say:", step->title);
    }
    if (!step->ask != !step->answer) {
        return gm_tour_refuse(reader, entries[0].line, "the step \"%.60s\" has %s: but no %s:", step->title,
                              step->ask ? "ask" : "answer", step->ask ? "answer" : "ask");
    }
    if (!show && number == 0) {
        return gm_tour_refuse(reader, entries[0].line,
                              "the first step has no show:, so there is nothing to see");
    }
    if (show && !read_show(reader, show, until, step)) {
        return false;
    }
    const double begin = gm_tour_begin(tour, number);
    if (isnan(step->until)) {
        step->until = begin;
    }
    if (step->until < begin) {
        return gm_tour_refuse(reader, until ? until->line : entries[0].line,
                              "until: %g lies before the step's begin, t = %g", step->until, begin);
    }
    const struct gm_request *shown = &tour->steps[gm_tour_first(tour, number)].request;
    for (size_t i = 0; i < count; i++) {
        if (entries[i].word != GM_TOUR_AT) {
            continue;
        }
        if (!read_change(reader, &entries[i], shown, step)) {
            return false;
        }
        const double t = step->changes[step->change_count - 1].t;
        if (!(t >= begin && t < step->until)) {
            return gm_tour_refuse(reader, entries[i].line,
                                  "at: %g lies outside of what the step shows, %g to %g", t, begin,
                                  step->until);
        }
    }
    if (step->change_count > 1) {
        qsort(step->changes, step->change_count, sizeof *step->changes, by_time);
    }
    return true;
}
