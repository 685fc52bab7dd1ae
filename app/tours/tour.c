/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tour from its file, and what it tells of its steps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/tours/reader.h"
#include "render/files/regular_file.h"

enum { MOST_BYTES = 1 << 20 };

static bool read_head(struct gm_tour_reader *reader, size_t count)
{
    struct gm_tour *tour = reader->tour;
    tour->place = MOST_BYTES; /* those without a place come last */
    for (size_t i = 0; i < count; i++) {
        const struct gm_tour_entry *entry = &reader->entries[i];
        double place = NAN;
        switch (entry->word) {
        case GM_TOUR_TITLE:
            if (!gm_tour_take_text(reader, entry, &tour->title)) {
                return false;
            }
            break;
        case GM_TOUR_ABOUT:
            if (!gm_tour_take_text(reader, entry, &tour->about)) {
                return false;
            }
            break;
        case GM_TOUR_PLACE:
            if (!gm_tour_read_number(reader, entry, &place)) {
                return false;
            }
            if (!(place >= 0 && place <= 1e6) || place != floor(place)) {
                return gm_tour_refuse(reader, entry->line, "place: %.60s is not a whole number", entry->text);
            }
            tour->place = (long)place;
            break;
        default:
            return gm_tour_refuse(reader, entry->line,
                                  "%s: stands before the first step:", gm_tour_word_names[entry->word]);
        }
    }
    return tour->title || gm_tour_refuse(reader, 1, "a tour begins with title:");
}

static bool read_entries(struct gm_tour_reader *reader)
{
    struct gm_tour *tour = reader->tour;
    size_t from = 0;
    while (from < reader->count && reader->entries[from].word != GM_TOUR_STEP) {
        from++;
    }
    if (!read_head(reader, from)) {
        return false;
    }
    if (from == reader->count) {
        return gm_tour_refuse(reader, from > 0 ? reader->entries[from - 1].line : 1,
                              "there is no step: after this");
    }
    tour->steps = calloc(GM_TOUR_STEPS, sizeof *tour->steps);
    if (!tour->steps) {
        return gm_tour_short_of_memory(reader);
    }
    while (from < reader->count) {
        size_t next = from + 1;
        while (next < reader->count && reader->entries[next].word != GM_TOUR_STEP) {
            next++;
        }
        if (!gm_tour_read_step(reader, &reader->entries[from], next - from)) {
            return false;
        }
        from = next;
    }
    return true;
}

bool gm_tour_parse(struct gm_tour *tour, const char *name, const char *text, size_t size, char *message)
{
    *tour = (struct gm_tour){.name = strdup(name)};
    struct gm_tour_reader reader = {.name = name, .message = message, .tour = tour};
    const bool good = tour->name ? gm_tour_read_lines(&reader, text, size) && read_entries(&reader)
                                 : gm_tour_short_of_memory(&reader);
    for (size_t i = 0; i < reader.count; i++) {
        free(reader.entries[i].text);
    }
    free(reader.entries);
    if (!good) {
        gm_tour_close(tour);
    }
    return good;
}

/* "share/tours/area.tour" is called area. */
static void shorten_name(struct gm_tour *tour)
{
    const char *slash = strrchr(tour->name, '/');
    if (slash) {
        memmove(tour->name, slash + 1, strlen(slash));
    }
    char *dot = strrchr(tour->name, '.');
    if (dot && dot > tour->name) {
        *dot = '\0';
    }
}

bool gm_tour_read(struct gm_tour *tour, const char *path, char *message)
{
    *tour = (struct gm_tour){0};
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    char *text = gm_regular_read(path, MOST_BYTES, &size, reason);
    if (!text) {
        snprintf(message, GM_MESSAGE, "%.300s could not be read: %s", path, reason);
    }
    const bool good = text && gm_tour_parse(tour, path, text, size, message);
    free(text);
    if (good) {
        shorten_name(tour);
    }
    return good;
}

void gm_tour_close(struct gm_tour *tour)
{
    for (size_t i = 0; i < tour->count; i++) {
        struct gm_tour_step *step = &tour->steps[i];
        char *texts[] = {step->title, step->say,     step->ask,  step->answer,
                         step->watch, step->attempt, step->show, step->study_words};
        for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
            free(texts[k]);
        }
        gm_request_close(&step->request);
        free(step->changes);
    }
    free(tour->steps);
    free(tour->name);
    free(tour->title);
    free(tour->about);
    *tour = (struct gm_tour){0};
}

size_t gm_tour_first(const struct gm_tour *tour, size_t step)
{
    while (step > 0 && !tour->steps[step].show) {
        step--;
    }
    return step;
}

double gm_tour_begin(const struct gm_tour *tour, size_t step)
{
    if (!tour->steps[step].show) {
        return tour->steps[step - 1].until;
    }
    const struct gm_request *request = &tour->steps[step].request;
    return gm_scene_t0(request->scene, request->lanes[0].parameters);
}
