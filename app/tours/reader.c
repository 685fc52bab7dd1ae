/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tour from its file (docs/tours.md): lines to entries, a word and its text; entries to steps; and
   everything that a step shows is tried out, so that a mistake is told of with its line before a class sees
   it. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/tours/tour.h"
#include "app/words/scheme.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/memory.h"
#include "render/cells/text.h"
#include "render/files/regular_file.h"

enum { MOST_BYTES = 1 << 20, MOST_STEPS = 60, MOST_SCHEMES = 3 };

enum word { TITLE, ABOUT, PLACE, STEP, SAY, ASK, ANSWER, SHOW, UNTIL, SECONDS, AT, STUDY, WATCH, TRY, WORDS };

static const char *const word_names[WORDS] = {"title", "about", "place",   "step", "say",   "ask",   "answer",
                                              "show",  "until", "seconds", "at",   "study", "watch", "try"};

struct entry {
    enum word word;
    long line;
    char *text;
};

struct reader {
    const char *name; /* of the file, in sentences */
    struct entry *entries;
    size_t count;
    char *message;
    struct gm_tour *tour;
    unsigned long refusals; /* of memory, before it was read */
};

/* ---- lines ---- */

static bool short_of_memory(struct reader *reader)
{
    return gm_refuse(reader->message, "not enough memory");
}

/* Says a sentence with file and line, unless it was memory; false. */
__attribute__((format(printf, 3, 4))) static bool refuse(struct reader *reader, long line, const char *format,
                                                         ...)
{
    char sentence[GM_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return gm_memory_refusals() != reader->refusals
               ? short_of_memory(reader)
               : gm_refuse(reader->message, "%.100s, line %ld: %.380s", reader->name, line, sentence);
}

static const char *word_name(size_t i, const void *data)
{
    return (void)data, word_names[i];
}

static bool is_blank(char letter)
{
    return letter == ' ' || letter == '\t';
}

/* Letters that a terminal would take for orders, and bytes that are no letters. */
static bool is_readable(const char *text)
{
    for (uint32_t code; (code = gm_text_next(&text)) != 0;) {
        if (code != '\t' && !gm_text_is_shown(code)) {
            return false;
        }
    }
    return true;
}

static bool add_entry(struct reader *reader, enum word word, long line, const char *text)
{
    struct entry *more = realloc(reader->entries, (reader->count + 1) * sizeof *more);
    if (!more) {
        return short_of_memory(reader);
    }
    reader->entries = more;
    more[reader->count] = (struct entry){word, line, strdup(text)};
    return more[reader->count++].text || short_of_memory(reader);
}

/* A line that begins with a blank goes on with the text above. */
static bool continue_entry(struct reader *reader, long line, const char *text)
{
    if (reader->count == 0) {
        return refuse(reader, line, "it begins with a blank, but there is no text above to go on with");
    }
    struct entry *last = &reader->entries[reader->count - 1];
    char *longer = NULL;
    if (asprintf(&longer, "%s%s%s", last->text, last->text[0] ? " " : "", text) < 0) {
        return short_of_memory(reader);
    }
    free(last->text);
    last->text = longer;
    return true;
}

static bool read_line(struct reader *reader, long line, char *text)
{
    size_t length = strlen(text);
    while (length > 0 && (is_blank(text[length - 1]) || text[length - 1] == '\r')) {
        text[--length] = '\0';
    }
    if (!is_readable(text)) {
        return refuse(reader, line, "it holds something that is no letter of UTF-8");
    }
    const char *at = text;
    while (is_blank(*at)) {
        at++;
    }
    if (*at == '\0' || *at == '#') {
        return true;
    }
    if (at > text) {
        return continue_entry(reader, line, at);
    }
    const char *colon = strchr(text, ':');
    if (!colon) {
        return refuse(reader, line, "it is neither \"word: text\" nor, beginning with a blank, more of it");
    }
    char word[32];
    snprintf(word, sizeof word, "%.*s", (int)(colon - text < 31 ? colon - text : 31), text);
    for (size_t i = 0; i < WORDS; i++) {
        if (strcmp(word_names[i], word) == 0) {
            at = colon + 1;
            while (is_blank(*at)) {
                at++;
            }
            return add_entry(reader, (enum word)i, line, at);
        }
    }
    const char *near = gm_nearest(word, WORDS, word_name, NULL);
    return refuse(reader, line, "a tour has no word \"%s:\"%s%s%s", word, near ? "; did you mean " : "",
                  near ? near : "", near ? ":" : "");
}

static bool read_lines(struct reader *reader, const char *text, size_t size)
{
    long line = 1;
    bool good = true;
    while (good && size > 0) {
        const char *end = memchr(text, '\n', size);
        const size_t length = end ? (size_t)(end - text) : size;
        if (memchr(text, '\0', length)) {
            return refuse(reader, line, "it holds a byte 0, so this is no text");
        }
        char *copy = strndup(text, length);
        if (!copy) {
            return short_of_memory(reader);
        }
        good = read_line(reader, line++, copy);
        free(copy);
        text += length + (end != NULL);
        size -= length + (end != NULL);
    }
    return good;
}

static bool read_number(struct reader *reader, const struct entry *entry, double *value)
{
    if (!gm_number_parse(entry->text, value) || !isfinite(*value)) {
        return refuse(reader, entry->line, "\"%.60s\" is not a number", entry->text);
    }
    return true;
}

static bool take_text(struct reader *reader, const struct entry *entry, char **place)
{
    if (!entry->text[0]) {
        return refuse(reader, entry->line, "there is no text after %s:", word_names[entry->word]);
    }
    if (*place) {
        return refuse(reader, entry->line, "%s: is given twice", word_names[entry->word]);
    }
    *place = strdup(entry->text);
    return *place || short_of_memory(reader);
}

/* ---- a step ---- */

static const double usual_seconds = 8;

/* Reads the words of step->show; false with a sentence. */
static bool parse_show(struct gm_tour_step *step, char *message)
{
    struct gm_arguments words = {0};
    gm_request_close(&step->request);
    bool good = gm_arguments_split(&words, step->show);
    if (!good) {
        gm_refuse(message, "not enough memory");
    }
    good = good && gm_request_parse(&step->request, words.count, words.words, MOST_SCHEMES, message);
    gm_arguments_close(&words);
    return good;
}

static bool read_show(struct reader *reader, const struct entry *entry, const struct entry *until,
                      struct gm_tour_step *step)
{
    char message[GM_MESSAGE];
    if (!parse_show(step, message)) {
        return refuse(reader, entry->line, "%s", message);
    }
    /* a scene that is told where to stop draws its time axes so far */
    if (until && !strstr(step->show, " until=") && !strstr(step->show, " steps=")) {
        char *longer = NULL;
        if (asprintf(&longer, "%s until=%s", step->show, until->text) < 0) {
            return short_of_memory(reader);
        }
        free(step->show);
        step->show = longer;
        if (!parse_show(step, message)) {
            return refuse(reader, until->line, "%s", message);
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

/* "stability kepler dt=0.1": the name of a study and its words, which are tried out. */
static bool read_study(struct reader *reader, const struct entry *entry, struct gm_tour_step *step)
{
    char message[GM_MESSAGE], name[32];
    const size_t length = strcspn(entry->text, " \t");
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : 0), entry->text);
    step->study = gm_study_find(name);
    if (step->study == GM_STUDY_NONE) {
        return refuse(reader, entry->line,
                      "a study is work-precision, stability, backward or sweep, with a scene: \"%.60s\"",
                      entry->text);
    }
    step->study_words = strdup(entry->text + length);
    struct gm_arguments words = {0};
    if (!step->study_words || !gm_arguments_split(&words, step->study_words)) {
        gm_arguments_close(&words);
        return short_of_memory(reader);
    }
    struct gm_grid grid;
    const bool good = gm_grid_open(&grid, step->study, &words, NULL, message);
    if (good) {
        gm_grid_close(&grid);
    }
    gm_arguments_close(&words);
    return good || refuse(reader, entry->line, "%s", message);
}

/* "2*pi lane=2 scheme=midpoint"; tried out on a lane at its start. */
static bool read_change(struct reader *reader, const struct entry *entry, const struct gm_request *shown,
                        struct gm_tour_step *step)
{
    char message[GM_MESSAGE];
    struct gm_arguments words = {0};
    struct gm_tour_change *more = realloc(step->changes, (step->change_count + 1) * sizeof *more);
    if (more) {
        step->changes = more;
    }
    if (!more || !gm_arguments_split(&words, entry->text)) {
        gm_arguments_close(&words);
        return short_of_memory(reader);
    }
    struct gm_tour_change *change = &more[step->change_count];
    *change = (struct gm_tour_change){.lane = GM_EVERY_LANE};
    char *const *list = words.words;
    const int count = words.count;
    double lane = NAN;
    const bool has_lane = count == 3 && strncmp(list[1], "lane=", 5) == 0;
    bool good = true;
    if ((count != 2 && !has_lane) || !gm_number_parse(list[0], &change->t) || !isfinite(change->t)) {
        good = refuse(reader, entry->line,
                      "a change is \"at: TIME key=value\" or \"at: TIME lane=N scheme=NAME\"");
    } else if (has_lane && (!gm_number_parse(list[1] + 5, &lane) ||
                            !(lane >= 1 && lane <= (double)shown->count) || lane != floor(lane))) {
        good = refuse(reader, entry->line, "%.40s: there are lanes 1 to %zu", list[1], shown->count);
    } else if (has_lane && strncmp(list[2], "scheme=", 7) != 0) {
        good = refuse(reader, entry->line, "lane= goes with scheme=; a parameter changes in every lane");
    } else {
        change->lane = has_lane ? (long)lane - 1 : GM_EVERY_LANE;
        change->text = strdup(list[count - 1]);
        struct gm_lane *trial = gm_request_open_lane(shown, has_lane ? (size_t)change->lane : 0, message);
        good = change->text ? (trial && gm_change_apply(trial, change->text, message)) ||
                                  refuse(reader, entry->line, "%s", message)
                            : short_of_memory(reader);
        gm_lane_close(trial);
    }
    if (!good) {
        free(change->text);
    }
    gm_arguments_close(&words);
    step->change_count += good;
    return good;
}

static int by_time(const void *a, const void *b)
{
    const struct gm_tour_change *x = a, *y = b;
    return (x->t > y->t) - (x->t < y->t);
}

/* Texts and numbers of one step; what it shows comes after them. */
static bool take_entry(struct reader *reader, const struct entry *entry, struct gm_tour_step *step)
{
    char **const places[WORDS] = {
        [STEP] = &step->title, [SAY] = &step->say,     [ASK] = &step->ask,    [ANSWER] = &step->answer,
        [SHOW] = &step->show,  [WATCH] = &step->watch, [TRY] = &step->attempt};
    switch (entry->word) {
    case UNTIL:
        return read_number(reader, entry, &step->until);
    case SECONDS:
        return read_number(reader, entry, &step->seconds) &&
               ((step->seconds >= 1 && step->seconds <= 600) ||
                refuse(reader, entry->line, "seconds: %.60s does not lie between 1 and 600", entry->text));
    case AT:
        return true;
    case STUDY:
        return (!step->study_words && step->study == GM_STUDY_NONE)
                   ? read_study(reader, entry, step)
                   : refuse(reader, entry->line, "study: is given twice");
    default:
        return places[entry->word] ? take_text(reader, entry, places[entry->word])
                                   : refuse(reader, entry->line,
                                            "%s: stands before the first step:", word_names[entry->word]);
    }
}

static const struct entry *entry_of(const struct entry *entries, size_t count, enum word word)
{
    for (size_t i = 0; i < count; i++) {
        if (entries[i].word == word) {
            return &entries[i];
        }
    }
    return NULL;
}

/* entries[0] is the step's title. */
static bool read_step(struct reader *reader, const struct entry *entries, size_t count)
{
    struct gm_tour *tour = reader->tour;
    const size_t number = tour->count;
    if (number == MOST_STEPS) {
        return refuse(reader, entries[0].line, "a tour has at most %d steps", MOST_STEPS);
    }
    struct gm_tour_step *step = &tour->steps[tour->count++];
    *step = (struct gm_tour_step){.until = NAN, .seconds = usual_seconds};
    for (size_t i = 0; i < count; i++) {
        if (!take_entry(reader, &entries[i], step)) {
            return false;
        }
    }
    const struct entry *show = entry_of(entries, count, SHOW), *until = entry_of(entries, count, UNTIL);
    if (!step->say) {
        return refuse(reader, entries[0].line, "the step \"%.60s\" has no say:", step->title);
    }
    if (!step->ask != !step->answer) {
        return refuse(reader, entries[0].line, "the step \"%.60s\" has %s: but no %s:", step->title,
                      step->ask ? "ask" : "answer", step->ask ? "answer" : "ask");
    }
    if (!show && number == 0) {
        return refuse(reader, entries[0].line, "the first step has no show:, so there is nothing to see");
    }
    if (show && !read_show(reader, show, until, step)) {
        return false;
    }
    const double begin = gm_tour_begin(tour, number);
    if (isnan(step->until)) {
        step->until = begin;
    }
    if (step->until < begin) {
        return refuse(reader, until ? until->line : entries[0].line,
                      "until: %g lies before the step's begin, t = %g", step->until, begin);
    }
    const struct gm_request *shown = &tour->steps[gm_tour_first(tour, number)].request;
    for (size_t i = 0; i < count; i++) {
        if (entries[i].word != AT) {
            continue;
        }
        if (!read_change(reader, &entries[i], shown, step)) {
            return false;
        }
        const double t = step->changes[step->change_count - 1].t;
        if (!(t >= begin && t < step->until)) {
            return refuse(reader, entries[i].line, "at: %g lies outside of what the step shows, %g to %g", t,
                          begin, step->until);
        }
    }
    if (step->change_count > 1) {
        qsort(step->changes, step->change_count, sizeof *step->changes, by_time);
    }
    return true;
}

/* ---- a file ---- */

static bool read_head(struct reader *reader, size_t count)
{
    struct gm_tour *tour = reader->tour;
    tour->place = MOST_BYTES; /* those without a place come last */
    for (size_t i = 0; i < count; i++) {
        const struct entry *entry = &reader->entries[i];
        double place = NAN;
        switch (entry->word) {
        case TITLE:
            if (!take_text(reader, entry, &tour->title)) {
                return false;
            }
            break;
        case ABOUT:
            if (!take_text(reader, entry, &tour->about)) {
                return false;
            }
            break;
        case PLACE:
            if (!read_number(reader, entry, &place)) {
                return false;
            }
            if (!(place >= 0 && place <= 1e6) || place != floor(place)) {
                return refuse(reader, entry->line, "place: %.60s is not a whole number", entry->text);
            }
            tour->place = (long)place;
            break;
        default:
            return refuse(reader, entry->line, "%s: stands before the first step:", word_names[entry->word]);
        }
    }
    return tour->title || refuse(reader, 1, "a tour begins with title:");
}

static bool read_entries(struct reader *reader)
{
    struct gm_tour *tour = reader->tour;
    size_t from = 0;
    while (from < reader->count && reader->entries[from].word != STEP) {
        from++;
    }
    if (!read_head(reader, from)) {
        return false;
    }
    if (from == reader->count) {
        return refuse(reader, from > 0 ? reader->entries[from - 1].line : 1, "there is no step: after this");
    }
    tour->steps = calloc(MOST_STEPS, sizeof *tour->steps);
    if (!tour->steps) {
        return short_of_memory(reader);
    }
    while (from < reader->count) {
        size_t next = from + 1;
        while (next < reader->count && reader->entries[next].word != STEP) {
            next++;
        }
        if (!read_step(reader, &reader->entries[from], next - from)) {
            return false;
        }
        from = next;
    }
    return true;
}

/* A word that names a file of a system or a room which lies beside the tour: its path; else the word as it is,
   with paths of schemes from there. malloc'ed. */
static char *placed(const char *tour, const char *word)
{
    static const char *const endings[] = {".system", ".room"};
    const char *slash = strrchr(tour, '/'), *dot = strrchr(word, '.');
    char *path = NULL;
    for (size_t i = 0; i < GM_COUNT(endings) && slash && dot && word[0] != '/' && !path; i++) {
        if (strcmp(dot, endings[i]) == 0 && asprintf(&path, "%.*s/%s", (int)(slash - tour), tour, word) < 0) {
            return NULL;
        }
    }
    if (path && access(path, R_OK) == 0) {
        return path;
    }
    free(path);
    return gm_scheme_words_from(tour, word);
}

/* Paths are those from the tour's folder. */
static bool place_files(struct reader *reader)
{
    bool good = true;
    for (size_t i = 0; good && i < reader->count; i++) {
        struct entry *entry = &reader->entries[i];
        const bool has_words =
            entry->word == SHOW || entry->word == AT || entry->word == STUDY || entry->word == TRY;
        const bool has_files =
            strstr(entry->text, "scheme=") || strstr(entry->text, ".system") || strstr(entry->text, ".room");
        struct gm_arguments words = {0};
        if (!has_words || !has_files) {
            continue;
        }
        good = gm_arguments_split(&words, entry->text);
        for (int k = 0; good && k < words.count; k++) {
            char *word = placed(reader->name, words.words[k]);
            good = word != NULL;
            if (good) {
                free(words.words[k]);
                words.words[k] = word;
            }
        }
        char *text = good ? gm_arguments_join("", &words) : NULL;
        good = text != NULL;
        if (good) {
            memmove(text, text + 1, strlen(text)); /* the blank in front */
            free(entry->text);
            entry->text = text;
        }
        gm_arguments_close(&words);
    }
    return good || short_of_memory(reader);
}

bool gm_tour_parse(struct gm_tour *tour, const char *name, const char *text, size_t size, char *message)
{
    *tour = (struct gm_tour){.name = strdup(name)};
    struct reader reader = {.name = name, .message = message, .tour = tour, .refusals = gm_memory_refusals()};
    const bool good = tour->name
                          ? read_lines(&reader, text, size) && place_files(&reader) && read_entries(&reader)
                          : short_of_memory(&reader);
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

bool gm_tour_read(struct gm_tour *tour, const struct gm_file *file, char *message)
{
    *tour = (struct gm_tour){0};
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    char *text = gm_file_read(file, MOST_BYTES, &size, reason);
    if (!text) {
        gm_refuse(message, "%.300s could not be read: %s", file->path, reason);
    }
    const bool good = text && gm_tour_parse(tour, file->path, text, size, message);
    free(text);
    if (good) {
        shorten_name(tour);
    }
    return good;
}
