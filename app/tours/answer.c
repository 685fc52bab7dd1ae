/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Answers to exercises: written as words, and graded by repeating them. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/base/interrupt.h"
#include "app/tours/tour.h"
#include "app/words/drive.h"
#include "core/arena.h"
#include "core/expression/lines.h"

enum answer_word { TOUR, STEP, RUN, MADE, CHANGE, ANSWER_WORDS };
static const struct gm_line_word lines[ANSWER_WORDS] = {[TOUR] = {"tour", GM_LINE_ADDED, 0},
                                                        [STEP] = {"step", GM_LINE_ADDED, 0},
                                                        [RUN] = {"run", GM_LINE_ADDED, 0},
                                                        [MADE] = {"steps", GM_LINE_ADDED, 0},
                                                        [CHANGE] = {"change", GM_LINE_ADDED, 0}};
static const struct gm_line_words line_words = {"an answer", lines, ANSWER_WORDS, "", 0};

char *gm_answer_write(const struct gm_tour *tour, size_t step, const struct gm_request *request,
                      const struct gm_lane *const *lanes)
{
    struct gm_text_stream writing = {0};
    char *arguments = gm_request_format(request);
    FILE *stream = arguments ? gm_stream_begin(&writing) : NULL;
    if (stream) {
        fprintf(stream, "tour: %s%s\nstep: %zu\nrun: %s\nsteps:", tour->name,
                tour->path ? gm_file_endings[GM_FILE_TOUR] : "", step + 1, arguments);
        for (size_t i = 0; i < request->count; i++) {
            fprintf(stream, " %" PRId64, lanes[i]->run->steps + (lanes[i]->run->status != GM_OK));
        }
        fputc('\n', stream);
        for (size_t i = 0; i < request->change_count; i++) {
            const struct gm_change *change = &request->changes[i];
            fprintf(stream, "change: %zu %" PRId64 " %s\n", change->lane, change->step, change->text);
        }
    }
    free(arguments);
    return gm_stream_end(&writing);
}

struct grading {
    const char *text, *word;
    size_t size;
    char *entries[ANSWER_WORDS];
    int status;
    char *exercise, *sentence;
};

/* Reads the lines; several changes are joined by newlines. */
static void read_answer(struct gm_arena *arena, struct grading *grading)
{
    struct gm_text_line line;
    struct gm_fault fault;
    size_t word = 0;
    gm_arena_refuse_if(arena, grading->size > GM_MOST_ANSWER, "an answer has at most %d bytes",
                       GM_MOST_ANSWER);
    gm_arena_check(arena, gm_lines_are_text(grading->text, grading->size, &fault), fault.sentence);
    for (size_t at = 0; gm_lines_next(grading->text, grading->size, &at, &line, &fault);) {
        gm_arena_check(arena, gm_line_find(&line_words, grading->text, &line, &word, &fault), fault.sentence);
        char **entry = &grading->entries[word];
        gm_arena_refuse_if(arena, *entry && word != CHANGE, "%s: is given twice", lines[word].word);
        *entry = gm_arena_print(arena, "%s%.*s\n", *entry ? *entry : "",
                                (int)(line.value.end - line.value.begin), grading->text + line.value.begin);
    }
    gm_arena_check(arena, !fault.sentence[0], fault.sentence);
    for (size_t i = 0; i < CHANGE; i++) {
        gm_arena_refuse_if(arena, !grading->entries[i], "an answer has a line %s:", lines[i].word);
        grading->entries[i][strlen(grading->entries[i]) - 1] = '\0';
    }
}

/* The tour that is named, or that of the answer: NAME.tour is a file of this folder, or one that is found by its name, but none
   that the program has inside. */
static struct gm_tour *find_tour(struct gm_arena *arena, struct grading *grading)
{
    char message[GM_MESSAGE];
    struct gm_file file;
    bool unreadable = false;
    struct gm_tour *tour = gm_arena_take(arena, 1, sizeof *tour);
    const char *word = grading->word ? grading->word : grading->entries[TOUR],
               *ending = gm_file_endings[GM_FILE_TOUR];
    const bool by_name =
        !grading->word && gm_word_ends(word, ending) && access(word, F_OK) != 0 &&
        gm_file_find(GM_FILE_TOUR, gm_arena_print(arena, "%.*s", (int)(strlen(word) - strlen(ending)), word),
                     &file) &&
        !file.built_in;
    const bool found = by_name || gm_tour_find(word, &file, &unreadable, message);
    if (!found || !gm_tour_read(tour, &file, message)) {
        grading->status = found || unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE;
        gm_arena_refuse(arena, "%s%s", message,
                        !grading->word && gm_word_ends(word, ending) && access(file.path, F_OK) != 0
                            ? "; the tour may be named: geomint grade FILE.answer FILE.tour"
                            : "");
    }
    return gm_arena_keep(arena, tour, gm_tour_close);
}

/* Repeats the runs of an answer. */
static const struct gm_lane **repeat(struct gm_arena *arena, const struct gm_request *request,
                                     const char *steps)
{
    enum { MOST = 100000000 };
    char message[GM_MESSAGE];
    const struct gm_lane **lanes = gm_arena_take(arena, request->count, sizeof *lanes);
    for (size_t i = 0; i < request->count; i++) {
        char *end = NULL;
        const int64_t made = strtoll(steps, &end, 10);
        const bool last = i + 1 == request->count;
        gm_arena_refuse_if(arena, end == steps || made < 0 || made > MOST || (last && *end != '\0'),
                           "steps: has a number from 0 to %d for each lane", MOST);
        steps = end;
        struct gm_lane *lane = gm_lane_in(arena, gm_request_open_lane(request, i, message), message);
        const double never = GM_NEVER;
        struct gm_drive drive = {
            .lane = lane, .request = request, .index = i, .stop = &never, .whole_steps = true};
        gm_arena_check(arena, gm_drive_to(&drive, made, true, message), message);
        lanes[i] = lane;
    }
    return lanes;
}

static void grade(struct gm_arena *arena, void *data)
{
    struct grading *grading = data;
    char message[GM_MESSAGE];
    double number = 0;
    read_answer(arena, grading);
    const struct gm_tour *tour = find_tour(arena, grading);
    gm_arena_refuse_if(arena,
                       !gm_number_parse(grading->entries[STEP], &number) || !(number >= 1) ||
                           !(number <= (double)tour->count) || number != floor(number),
                       "step: is a number from 1 to %zu", tour->count);
    const struct gm_tour_step *step = &tour->steps[(size_t)number - 1];
    gm_arena_refuse_if(arena, step->expectation_count == 0, "step %g of %s is not an exercise", number,
                       tour->name);
    gm_refuse(grading->exercise, "%s, step %g: %s", tour->name, number, step->title);
    struct gm_request *request = gm_arena_take(arena, 1, sizeof *request);
    gm_arena_check(arena, gm_request_recall(request, step->request.scene, grading->entries[RUN], message),
                   message);
    gm_arena_keep(arena, request, gm_request_close);
    gm_arena_check(arena, gm_exercise_is_about(step, request->scene, message), message);
    gm_arena_refuse_if(arena,
                       grading->entries[CHANGE] && !gm_changes_parse(request, grading->entries[CHANGE]),
                       "a change of the answer is not \"LANE STEP key=value\"");
    const struct gm_lane **lanes = repeat(arena, request, grading->entries[MADE]);
    grading->status =
        gm_exercise_passed(step, request, lanes, grading->sentence) ? GM_EXIT_OK : GM_EXIT_CLAIM;
}

int gm_answer_grade(const char *text, size_t size, const char *tour, char *exercise, char *sentence)
{
    struct grading grading = {.text = text,
                              .size = size,
                              .word = tour,
                              .status = GM_EXIT_USAGE,
                              .exercise = exercise,
                              .sentence = sentence};
    struct gm_arena *arena = gm_arena_open();
    if (!gm_arena_run(arena, grade, &grading)) {
        gm_refuse(sentence, "%s", gm_arena_reason(arena));
    }
    gm_arena_close(arena);
    return grading.status;
}
