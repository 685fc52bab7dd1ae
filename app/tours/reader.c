/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tour from its file (docs/tours.md): lines to entries, a word and its text; entries to steps.
   Everything that a step shows is tried out, so that a mistake is reported with its line before a class
   sees it. And the places of tours, and the tour that a word means. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/tours/tour.h"
#include "app/words/names.h"
#include "core/arena.h"
#include "core/expression/lines.h"
#include "core/expression/nearest.h"
#include "core/memory.h"
#include "render/cells/text.h"

enum { MOST_BYTES = 1 << 20, MOST_STEPS = 60, MOST_SCHEMES = 3 };

enum word {
    TITLE,
    ABOUT,
    PLACE,
    STEP,
    SAY,
    ASK,
    ANSWER,
    EXPECT,
    HINT,
    SHOW,
    UNTIL,
    SECONDS,
    AT,
    STUDY,
    WATCH,
    TRY,
    WORDS
};

static const struct gm_line_word lines[WORDS] = {
    {"title", GM_LINE_ADDED, 0},  {"about", GM_LINE_ADDED, 0},  {"place", GM_LINE_ADDED, 0},
    {"step", GM_LINE_ADDED, 0},   {"say", GM_LINE_ADDED, 0},    {"ask", GM_LINE_ADDED, 0},
    {"answer", GM_LINE_ADDED, 0}, {"expect", GM_LINE_ADDED, 0}, {"hint", GM_LINE_ADDED, 0},
    {"show", GM_LINE_ADDED, 0},   {"until", GM_LINE_ADDED, 0},  {"seconds", GM_LINE_ADDED, 0},
    {"at", GM_LINE_ADDED, 0},     {"study", GM_LINE_ADDED, 0},  {"watch", GM_LINE_ADDED, 0},
    {"try", GM_LINE_ADDED, 0}};
static const struct gm_line_words line_words = {"a tour", lines, WORDS, "; docs/tours.md names them", 0};

struct entry {
    enum word word;
    long line;
    char *text;
};

struct reader {
    const char *name; /* the file's name in sentences */
    bool is_file;     /* a file has this path */
    const char *text;
    size_t size;
    struct gm_arena *arena;
    struct gm_tour *tour;
    struct entry *entries;
    size_t count;
    unsigned long refusals; /* refused requests for memory before reading */
};

/* ---- lines ---- */

/* Refuses the tour, if something is wrong, in a sentence with file and line, unless it was memory. */
__attribute__((format(printf, 4, 5))) static void refuse_if(const struct reader *reader, bool wrong,
                                                            long line, const char *format, ...)
{
    char sentence[GM_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    if (wrong) { /* else what it quotes may not be written */
        vsnprintf(sentence, sizeof sentence, format, arguments);
        va_end(arguments);
        gm_arena_need(reader->arena, gm_memory_refusals() == reader->refusals);
        gm_arena_refuse(reader->arena, "%.100s, line %ld: %.380s", reader->name, line, sentence);
    }
    va_end(arguments);
}

static long line_of(const struct reader *reader, size_t offset)
{
    size_t line, column;
    gm_text_place(reader->text, offset, &line, &column);
    return (long)line;
}

/* The text of a value: its lines with a blank between them, but for those that begin with #. */
static char *text_of(const struct reader *reader, struct gm_span value)
{
    char *text = gm_arena_take(reader->arena, value.end - value.begin + 1, 1), *out = text;
    for (size_t at = value.begin; at < value.end;) {
        const char *from = reader->text + at, *newline = memchr(from, '\n', value.end - at);
        const size_t length = newline ? (size_t)(newline - from) : value.end - at,
                     blanks = strspn(from, " \t\r");
        if (blanks < length && from[blanks] != '#') {
            out = mempcpy(out, " ", (size_t)(out > text));
            out = mempcpy(out, from + blanks, length - blanks);
        }
        while (out > text && strchr(" \t\r", out[-1])) {
            *--out = '\0';
        }
        at += length + 1;
    }
    return text;
}

/* Leaves the body if the text has that fault. */
static void need(const struct reader *reader, bool whole, const struct gm_fault *fault)
{
    refuse_if(reader, !whole, whole ? 0 : line_of(reader, fault->offset), "%s", fault->sentence);
}

static void read_lines(struct reader *reader)
{
    struct gm_text_line line;
    struct gm_fault fault;
    size_t word;
    need(reader, gm_lines_are_text(reader->text, reader->size, &fault), &fault);
    for (size_t at = 0; gm_lines_next(reader->text, reader->size, &at, &line, &fault);) {
        need(reader, gm_line_find(&line_words, reader->text, &line, &word, &fault), &fault);
        char *text = text_of(reader, line.value);
        const long number = line_of(reader, line.word.begin);
        refuse_if(reader, !gm_text_is_plain(text), number, "it holds a character that cannot be shown");
        reader->entries =
            gm_arena_resize(reader->arena, reader->entries, reader->count + 1, sizeof *reader->entries);
        reader->entries[reader->count++] = (struct entry){(enum word)word, number, text};
    }
    need(reader, !fault.sentence[0], &fault);
}

static double read_number(const struct reader *reader, const struct entry *entry)
{
    double value = NAN;
    refuse_if(reader, !gm_number_parse(entry->text, &value) || !isfinite(value), entry->line,
              "\"%.60s\" is not a number", entry->text);
    return value;
}

static void take_text(const struct reader *reader, const struct entry *entry, char **place)
{
    refuse_if(reader, *place, entry->line, "%s: is given twice", lines[entry->word].word);
    *place = entry->text;
}

/* ---- a step ---- */

static const double usual_seconds = 8;

/* Reads the words of step->show, given in this line. */
static void parse_show(const struct reader *reader, long line, struct gm_tour_step *step)
{
    char message[GM_MESSAGE];
    const struct gm_arguments *words = gm_arguments_of(reader->arena, step->show);
    gm_request_close(&step->request);
    refuse_if(reader, !gm_request_parse(&step->request, words->count, words->words, MOST_SCHEMES, message),
              line, "%s", message);
}

static void read_show(const struct reader *reader, const struct entry *entry, const struct entry *until,
                      struct gm_tour_step *step)
{
    parse_show(reader, entry->line, step);
    /* a scene with an end draws its time axes up to there */
    if (until && !strstr(step->show, " until=") && !strstr(step->show, " steps=")) {
        step->show = gm_arena_print(reader->arena, "%s until=%s", step->show, until->text);
        parse_show(reader, until->line, step);
    }
    for (size_t i = 0; !until && i < step->request.count; i++) {
        const struct gm_timing *timing = step->request.lanes[i].parameters;
        step->until = fmax(step->until, timing->until); /* NAN before the first */
    }
}

/* "stability kepler dt=0.1": the name of a study and its words, which are tried out. */
static void read_study(const struct reader *reader, const struct entry *entry, struct gm_tour_step *step)
{
    char message[GM_MESSAGE], name[32];
    struct gm_grid grid;
    const size_t length = strcspn(entry->text, " \t");
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : 0), entry->text);
    step->study = gm_study_find(name);
    refuse_if(reader, step->study == GM_STUDY_NONE, entry->line,
              "a study is work-precision, stability, backward or sweep, with a scene: \"%.60s\"",
              entry->text);
    step->study_words = entry->text + length;
    refuse_if(
        reader,
        !gm_grid_open(&grid, step->study, gm_arguments_of(reader->arena, step->study_words), NULL, message),
        entry->line, "%s", message);
    gm_grid_close(&grid);
}

/* "2*pi lane=2 scheme=midpoint"; tried out on a lane at its start. */
static void read_change(const struct reader *reader, const struct entry *entry,
                        const struct gm_request *shown, struct gm_tour_step *step)
{
    char message[GM_MESSAGE];
    const struct gm_arguments *words = gm_arguments_of(reader->arena, entry->text);
    char *const *list = words->words;
    const int count = words->count;
    struct gm_tour_change change = {.lane = GM_EVERY_LANE,
                                    .line = gm_arena_print(reader->arena, "%s", entry->text)};
    double lane = NAN;
    const bool has_lane = count == 3 && strncmp(list[1], "lane=", 5) == 0;
    refuse_if(reader,
              (count != 2 && !has_lane) || !gm_number_parse(list[0], &change.t) || !isfinite(change.t),
              entry->line, "a change is \"at: TIME key=value\" or \"at: TIME lane=N scheme=NAME\"");
    refuse_if(reader,
              has_lane && (!gm_number_parse(list[1] + 5, &lane) ||
                           !(lane >= 1 && lane <= (double)shown->count) || lane != floor(lane)),
              entry->line, "%.40s: there are lanes 1 to %zu", list[1], shown->count);
    refuse_if(reader, has_lane && strncmp(list[2], "scheme=", 7) != 0, entry->line,
              "lane= goes with scheme=; a parameter changes in every lane");
    change.lane = has_lane ? (long)lane - 1 : GM_EVERY_LANE;
    change.text = list[count - 1];
    const char *key = gm_arena_print(reader->arena, "%.*s", (int)strcspn(change.text, "="), change.text);
    refuse_if(reader, !gm_scene_parameter(shown->scene, key) && gm_setting_find(key), entry->line,
              "%.60s cannot be changed during the run", change.text);
    struct gm_lane *trial = gm_request_open_lane(shown, has_lane ? (size_t)change.lane : 0, message);
    const bool applied = trial && gm_change_apply(trial, change.text, message);
    gm_lane_close(trial);
    refuse_if(reader, !applied, entry->line, "%s", message);
    step->changes =
        gm_arena_resize(reader->arena, step->changes, step->change_count + 1, sizeof *step->changes);
    step->changes[step->change_count++] = change;
}

/* Reads the conditions of an exercise. */
static void read_expectations(const struct reader *reader, const struct entry *entries, size_t count,
                              struct gm_tour_step *step)
{
    for (size_t i = 0; i < count; i++) {
        const struct entry *entry = &entries[i];
        if (entry->word != EXPECT) {
            continue;
        }
        struct gm_fault fault = {0};
        refuse_if(reader, !step->show || !step->ask || step->study_words, entry->line,
                  "expect: needs show: and ask:, and no study:");
        if (!gm_expectation_read(reader->arena, step->request.scene, entry->text,
                                 &step->expectations[step->expectation_count++], &fault)) {
            char message[GM_MESSAGE];
            gm_refuse(message, "%.200s", fault.sentence);
            gm_place_show(entry->text, strlen(entry->text), fault.offset, message);
            refuse_if(reader, true, entry->line, "%s", message);
        }
    }
    refuse_if(reader, step->hint && step->expectation_count == 0, entries[0].line,
              "hint: is for an exercise, which has expect:");
}

static int by_time(const void *a, const void *b)
{
    const struct gm_tour_change *x = a, *y = b;
    return (x->t > y->t) - (x->t < y->t);
}

/* Takes texts and numbers of one step; its show and changes come after them. */
static void take_entry(const struct reader *reader, const struct entry *entry, struct gm_tour_step *step)
{
    char **const places[WORDS] = {
        [STEP] = &step->title, [SAY] = &step->say,     [ASK] = &step->ask,     [ANSWER] = &step->answer,
        [SHOW] = &step->show,  [WATCH] = &step->watch, [TRY] = &step->attempt, [HINT] = &step->hint};
    if (entry->word == UNTIL) {
        step->until = read_number(reader, entry);
    } else if (entry->word == SECONDS) {
        step->seconds = read_number(reader, entry);
        refuse_if(reader, !(step->seconds >= 1 && step->seconds <= 600), entry->line,
                  "seconds: %.60s does not lie between 1 and 600", entry->text);
    } else if (entry->word == STUDY) {
        refuse_if(reader, step->study_words, entry->line, "study: is given twice");
        read_study(reader, entry, step);
    } else if (entry->word != AT && entry->word != EXPECT) {
        refuse_if(reader, !places[entry->word], entry->line,
                  "%s: belongs before the first step:", lines[entry->word].word);
        take_text(reader, entry, places[entry->word]);
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
static void read_step(const struct reader *reader, const struct entry *entries, size_t count)
{
    struct gm_tour *tour = reader->tour;
    const size_t number = tour->count;
    refuse_if(reader, number == MOST_STEPS, entries[0].line, "a tour has at most %d steps", MOST_STEPS);
    struct gm_tour_step *step = &tour->steps[tour->count++];
    *step = (struct gm_tour_step){.until = NAN, .seconds = usual_seconds};
    gm_arena_keep(reader->arena, &step->request, gm_request_close);
    for (size_t i = 0; i < count; i++) {
        take_entry(reader, &entries[i], step);
    }
    const struct entry *show = entry_of(entries, count, SHOW), *until = entry_of(entries, count, UNTIL);
    refuse_if(reader, !step->say, entries[0].line, "the step \"%.60s\" has no say:", step->title);
    refuse_if(reader, !step->ask != !step->answer, entries[0].line,
              "the step \"%.60s\" has %s: but no %s:", step->title, step->ask ? "ask" : "answer",
              step->ask ? "answer" : "ask");
    refuse_if(reader, !show && number == 0, entries[0].line,
              "the first step has no show:, so there is nothing to see");
    if (show) {
        read_show(reader, show, until, step);
    }
    const double begin = gm_tour_begin(tour, number);
    step->until = isnan(step->until) ? begin : step->until;
    refuse_if(reader, step->until < begin, until ? until->line : entries[0].line,
              "until: %g lies before the step's begin, t = %g", step->until, begin);
    const struct gm_request *shown = &tour->steps[gm_tour_first(tour, number)].request;
    for (size_t i = 0; i < count; i++) {
        if (entries[i].word != AT) {
            continue;
        }
        read_change(reader, &entries[i], shown, step);
        const double t = step->changes[step->change_count - 1].t;
        refuse_if(reader, !(t >= begin && t < step->until), entries[i].line,
                  "at: %g lies outside of what the step shows, %g to %g", t, begin, step->until);
    }
    step->expectations = gm_arena_take(reader->arena, count, sizeof *step->expectations);
    read_expectations(reader, entries, count, step);
    if (step->change_count > 1) {
        qsort(step->changes, step->change_count, sizeof *step->changes, by_time);
    }
}

/* ---- a file ---- */

static void read_head(const struct reader *reader, size_t count)
{
    struct gm_tour *tour = reader->tour;
    tour->place = MOST_BYTES; /* tours without a place come last */
    for (size_t i = 0; i < count; i++) {
        const struct entry *entry = &reader->entries[i];
        if (entry->word == PLACE) {
            const double place = read_number(reader, entry);
            refuse_if(reader, !(place >= 0 && place <= 1e6) || place != floor(place), entry->line,
                      "place: %.60s is not a whole number", entry->text);
            tour->place = (long)place;
            continue;
        }
        refuse_if(reader, entry->word != TITLE && entry->word != ABOUT, entry->line,
                  "%s: belongs after the first step:", lines[entry->word].word);
        take_text(reader, entry, entry->word == TITLE ? &tour->title : &tour->about);
    }
    refuse_if(reader, !tour->title, 1, "a tour begins with title:");
}

/* The next entry from `from` on that begins a step, or their number. */
static size_t next_step(const struct reader *reader, size_t from)
{
    while (from < reader->count && reader->entries[from].word != STEP) {
        from++;
    }
    return from;
}

static void read_entries(const struct reader *reader)
{
    size_t from = next_step(reader, 0);
    read_head(reader, from);
    refuse_if(reader, from == reader->count, from > 0 ? reader->entries[from - 1].line : 1,
              "there is no step: after this");
    reader->tour->steps = gm_arena_take(reader->arena, MOST_STEPS, sizeof *reader->tour->steps);
    for (size_t next = 0; from < reader->count; from = next) {
        next = next_step(reader, from + 1);
        read_step(reader, &reader->entries[from], next - from);
    }
}

/* The path of a system's or room's file beside the tour that a word names; else the word, with paths of
   schemes relative to the tour. malloc'ed. */
static char *placed(const char *tour, const char *word)
{
    const char *slash = strrchr(tour, '/'), *dot = strrchr(word, '.');
    char path[4096]; /* no file has a path that is longer */
    const bool names =
        slash && dot && word[0] != '/' && (strcmp(dot, ".system") == 0 || strcmp(dot, ".room") == 0);
    if (names && snprintf(path, sizeof path, "%.*s/%s", (int)(slash - tour), tour, word) < (int)sizeof path &&
        access(path, R_OK) == 0) {
        return strdup(path);
    }
    return gm_scheme_words_from(tour, word);
}

/* Paths are those from the tour's folder. */
static void place_files(const struct reader *reader)
{
    for (size_t i = 0; i < reader->count; i++) {
        struct entry *entry = &reader->entries[i];
        const bool has_words =
            entry->word == SHOW || entry->word == AT || entry->word == STUDY || entry->word == TRY;
        const bool has_files =
            strstr(entry->text, "scheme=") || strstr(entry->text, ".system") || strstr(entry->text, ".room");
        if (!has_words || !has_files) {
            continue;
        }
        struct gm_arguments *words = gm_arguments_of(reader->arena, entry->text);
        for (int k = 0; k < words->count; k++) {
            char *word = placed(reader->name, words->words[k]);
            gm_arena_need(reader->arena, word);
            free(words->words[k]);
            words->words[k] = word;
        }
        char *text = gm_arena_keep(reader->arena, gm_arguments_join("", words), free);
        entry->text = text + 1; /* the text after the first blank */
    }
}

static void read_tour(struct gm_arena *arena, void *data)
{
    struct reader *reader = data;
    reader->tour->name = gm_arena_print(arena, "%s", reader->name);
    reader->tour->path = reader->is_file ? gm_arena_print(arena, "%s", reader->name) : NULL;
    read_lines(reader);
    place_files(reader);
    read_entries(reader);
}

static bool parse(struct gm_tour *tour, const char *name, bool is_file, const char *text, size_t size,
                  char *message)
{
    *tour = (struct gm_tour){.arena = gm_arena_open()};
    struct reader reader = {.name = name,
                            .is_file = is_file,
                            .text = text,
                            .size = size,
                            .arena = tour->arena,
                            .tour = tour,
                            .refusals = gm_memory_refusals()};
    if (gm_arena_run(tour->arena, read_tour, &reader)) {
        return true;
    }
    gm_refuse(message, "%s", gm_arena_reason(tour->arena));
    gm_tour_close(tour);
    return false;
}

bool gm_tour_parse(struct gm_tour *tour, const char *name, const char *text, size_t size, char *message)
{
    return parse(tour, name, false, text, size, message);
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
    char *text = gm_file_read(file, MOST_BYTES, &size, message);
    const bool parsed = text && parse(tour, file->path, !file->built_in, text, size, message);
    free(text);
    if (parsed) {
        shorten_name(tour);
    }
    return parsed;
}

void gm_tour_close(void *self)
{
    struct gm_tour *tour = self;
    gm_arena_close(tour->arena);
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

/* ---- many tours ---- */

static int by_place(const void *a, const void *b)
{
    const struct gm_tour *x = a, *y = b;
    return x->place != y->place ? (x->place > y->place) - (x->place < y->place) : strcmp(x->name, y->name);
}

struct tours {
    struct gm_tour *tours;
    size_t count;
    char *message;
};

static void add_tour(const struct gm_listed *listed, const void *data)
{
    struct tours *list = *(struct tours *const *)data;
    char sentence[GM_MESSAGE];
    struct gm_tour *more = realloc(list->tours, (list->count + 1) * sizeof *more);
    if (!more) {
        return;
    }
    list->tours = more;
    if (gm_tour_read(&list->tours[list->count], listed->file, sentence)) {
        list->count++;
    } else if (!list->message[0]) {
        gm_refuse(list->message, "%s", sentence);
    }
}

struct gm_tour *gm_tours_read(size_t *count, char *message)
{
    struct tours list = {.tours = calloc(1, sizeof *list.tours), .message = message}, *data = &list;
    char folder[GM_MESSAGE] = "";
    message[0] = '\0';
    if (!list.tours) {
        gm_refuse(message, "not enough memory");
    } else if (!gm_files_each(GM_FILE_TOUR, add_tour, &data, folder)) {
        gm_refuse(message, "%s", folder);
    }
    if (list.count > 1) {
        qsort(list.tours, list.count, sizeof *list.tours, by_place);
    }
    *count = list.count;
    return list.tours;
}

void gm_tours_close(struct gm_tour *tours, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gm_tour_close(&tours[i]);
    }
    free(tours);
}

static const char *name_at(size_t i, const void *data)
{
    return ((const struct gm_tour *)data)[i].name;
}

bool gm_tour_find(const char *word, struct gm_file *file, bool *unreadable, char *message)
{
    *unreadable = false;
    if (strchr(word, '/')) {
        *file = (struct gm_file){0};
        snprintf(file->path, sizeof file->path, "%s", word);
        return true;
    }
    if (gm_file_find(GM_FILE_TOUR, word, file)) {
        return true;
    }
    size_t count = 0;
    struct gm_tour *tours = gm_tours_read(&count, message);
    bool found = false;
    for (size_t i = 0; i < count && !found; i++) {
        found = (strcasecmp(tours[i].title, word) == 0 || strcasecmp(tours[i].name, word) == 0) &&
                gm_file_find(GM_FILE_TOUR, tours[i].name, file);
    }
    const char *near = gm_nearest(word, count, name_at, tours);
    *unreadable = !found && !near && message[0] != '\0';
    if (!found && !*unreadable) {
        gm_refuse(message, "there is no tour \"%.60s\"%s%s", word,
                  near ? "; did you mean " : "; geomint tour lists them, and a file has the ending .tour",
                  near ? near : "");
    }
    gm_tours_close(tours, count);
    return found;
}
