/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint figures: reproduces published figures on one page, with the documents' statements and the
   verdicts; user files are added or replace them. It uses as many processes as there are processors. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/commands.h"
#include "app/figures/figure.h"
#include "app/output/folder.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "core/arena.h"
#include "core/expression/number.h"
#include "render/clock.h"
#include "render/message.h"

enum { MOST_WORKERS = 64, QUICK_WIDTH = 640, QUICK_HEIGHT = 360 };

struct series {
    const struct gm_options *options;
    struct gm_figure_output output;
    struct gm_figure *user; /* user-defined systems, one per word */
    struct gm_figure_job *jobs;
    struct gm_outcome *outcomes;             /* shared with the workers */
    pid_t *workers;                          /* the process of a job; 0: it does not run */
    size_t most, count, next, made, printed; /* `most`: the length of these lists */
    size_t running, most_running;
    double started, page_written;
    bool progress;
};

/* A figure's own name, or the beginning of it up to a hyphen: "tyranowski", "razafindralandy-34". */
static bool named(const char *name, const char *word)
{
    const size_t length = strlen(word);
    return strncmp(name, word, length) == 0 && (name[length] == '\0' || name[length] == '-');
}

static bool wanted(const struct gm_options *options, const char *name)
{
    for (int i = 0; i < options->arguments.count; i++) {
        if (named(name, options->arguments.words[i])) {
            return true;
        }
    }
    return options->arguments.count == 0;
}

/* Sorts names in the order of the documents, and numbers in them by value. */
static int by_name(const void *one, const void *other)
{
    return strverscmp(((const struct gm_figure_job *)one)->figure->name,
                      ((const struct gm_figure_job *)other)->figure->name);
}

static bool is_published(const char *word)
{
    const struct gm_scene *scene;
    const struct gm_figure *figure;
    bool known = false;
    for (size_t i = 0; (figure = gm_figure_at(i, &scene)); i++) {
        known |= named(figure->name, word);
    }
    return known;
}

/* The user-defined system that a word names; NULL with a sentence and an exit status. */
static const struct gm_scene *own_scene(char *word, int *status, char *message)
{
    const struct gm_scene *scene = gm_request_scene(1, &word, status, message);
    if (scene ? !scene->words : *status == GM_EXIT_USAGE && !strpbrk(word, "/.")) {
        *status = GM_EXIT_USAGE;
        gm_refuse(message, "there is no figure \"%.60s\"; geomint list figures names them", word);
        return NULL;
    }
    return scene;
}

static void plan_user_figures(struct series *series, const struct gm_arguments *words)
{
    char message[GM_MESSAGE];
    int status = GM_EXIT_OK;
    for (int i = 0; i < words->count; i++) {
        if (is_published(words->words[i])) {
            continue;
        }
        const struct gm_scene *scene = own_scene(words->words[i], &status, message);
        gm_command_end_if(series->options, !scene, status, "%s", message);
        for (int k = 0; k < i; k++) {
            gm_command_end_if(series->options,
                              series->user[k].name && strcmp(series->user[k].name, scene->name) == 0,
                              GM_EXIT_USAGE, "the pictures of %.200s and %.200s would have one name",
                              words->words[k], words->words[i]);
        }
        series->user[i] = (struct gm_figure){.name = scene->name, .statement = scene->title, .arguments = ""};
        gm_figure_plan(&series->jobs[series->count++], scene, &series->user[i], false);
    }
}

static struct series *open_series(const struct gm_options *options)
{
    const struct gm_scene *scene;
    const struct gm_figure *figure;
    size_t most = (size_t)options->arguments.count;
    for (size_t i = 0; gm_figure_at(i, &scene); i++) {
        most++;
    }
    struct series *series = gm_arena_take(options->arena, 1, sizeof *series);
    *series = (struct series){
        .options = options,
        .most = most,
        .output = {.folder = options->out ? options->out : ".",
                   .look = options->look,
                   .format = options->format,
                   .quick = options->quick},
        .user = gm_arena_take(options->arena, (size_t)options->arguments.count + 1, sizeof *series->user),
        .jobs = gm_arena_take(options->arena, most, sizeof *series->jobs),
        .workers = gm_arena_take(options->arena, most, sizeof *series->workers)};
    if (options->quick && !options->sized) {
        series->output.look.width = QUICK_WIDTH;
        series->output.look.height = QUICK_HEIGHT;
    }
    series->outcomes = mmap(NULL, most * sizeof *series->outcomes, PROT_READ | PROT_WRITE,
                            MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    gm_command_end_if(options, series->outcomes == MAP_FAILED, GM_EXIT_FILE, "not enough memory");

    for (size_t i = 0; (figure = gm_figure_at(i, &scene)); i++) {
        /* a file that was refused memory before may be read by now */
        if (wanted(options, figure->name) && series->count + (size_t)options->arguments.count < most) {
            gm_figure_plan(&series->jobs[series->count++], scene, figure, options->quick);
        }
    }
    plan_user_figures(series, &options->arguments);
    qsort(series->jobs, series->count, sizeof *series->jobs, by_name);
    const size_t cores = gm_pool_cores();
    series->most_running = cores > MOST_WORKERS ? MOST_WORKERS : cores;
    series->progress = isatty(STDERR_FILENO);
    series->started = series->page_written = gm_clock_seconds();
    return series;
}

static void show_progress(const struct series *series)
{
    enum { WIDTH = 24 };
    if (!series->progress) {
        return;
    }
    char bar[WIDTH + 1];
    const double elapsed = gm_clock_seconds() - series->started;
    for (size_t i = 0; i < WIDTH; i++) {
        bar[i] = i * series->count < series->made * WIDTH ? '#' : '.';
    }
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r%s %zu/%zu figures, %.0f s", bar, series->made, series->count, elapsed);
    if (series->made > 0) {
        fprintf(stderr, ", about %.0f s left",
                elapsed / (double)series->made * (double)(series->count - series->made));
    }
    fputs("\033[K", stderr);
}

static void print_lanes(const struct gm_figure_job *job, const struct gm_outcome *outcome)
{
    printf("  %-44s %10s", "", "t");
    for (size_t i = 0; i < gm_figure_observables(job); i++) {
        if (gm_outcome_has(outcome, i)) {
            printf(" %14s", job->scene->observables[i].key);
        }
    }
    printf("\n");
    for (size_t i = 0; i < outcome->lane_count; i++) {
        printf("  %-44s %10.4g", outcome->lanes[i].label, outcome->lanes[i].t);
        for (size_t k = 0; k < gm_figure_observables(job); k++) {
            if (gm_outcome_has(outcome, k)) {
                const int width = (int)strlen(job->scene->observables[k].key);
                printf(" %*.6g", width > 14 ? width : 14, outcome->lanes[i].observables[k]);
            }
        }
        printf("%s%s\n", outcome->lanes[i].failure[0] ? "  " : "", outcome->lanes[i].failure);
    }
}

static const char *source_name(enum gm_source source)
{
    static const char *const names[] = {
        [GM_OF_DOCUMENT] = "document", [GM_OF_OURS] = "ours", [GM_OF_VARIANT] = "variant"};
    return names[source];
}

static void print_json(const struct gm_figure_job *job, const struct gm_outcome *outcome)
{
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "figure %s, scene %s, arguments %s, statement %s, made %d, message %s, seconds %.17g",
               job->figure->name, gm_figure_word(job), job->arguments, job->figure->statement,
               outcome->progress == GM_MADE, outcome->progress == GM_NOT_MADE ? outcome->message : "",
               outcome->seconds);
    struct gm_row statements = gm_row_open(&row, "statements", ']');
    for (size_t i = 0; i < outcome->verdict_count; i++) {
        const struct gm_statement *statement = &job->published->statements[i];
        const double scale = outcome->verdicts[i].scale;
        struct gm_row said = gm_row_open(&statements, NULL, '}');
        gm_row_put(&said, "says %s, of %s, verdict %s, note %s", statement->says,
                   source_name(gm_statement_source(job, i)), gm_verdict_word(job, outcome, i),
                   job->shortened ? "" : outcome->verdicts[i].note);
        gm_row_list(&said, "found", (const double[]){outcome->verdicts[i].low, outcome->verdicts[i].high}, 2);
        gm_row_list(&said, "expected", (const double[]){statement->low * scale, statement->high * scale}, 2);
    }
    struct gm_row lanes = gm_row_open(&row, "lanes", ']');
    for (size_t i = 0; outcome->progress == GM_MADE && i < outcome->lane_count; i++) {
        struct gm_row lane = gm_row_open(&lanes, NULL, '}');
        gm_row_put(&lane, "lane %s, t %.17g, message %s", outcome->lanes[i].label, outcome->lanes[i].t,
                   outcome->lanes[i].failure);
        struct gm_row observables = gm_row_open(&lane, "observables", '}');
        for (size_t k = 0; k < gm_figure_observables(job); k++) {
            gm_row_number(&observables, job->scene->observables[k].key, outcome->lanes[i].observables[k], 17);
        }
    }
    gm_row_close(&row, "\n");
}

static void print_text(const struct gm_figure_job *job, const struct gm_outcome *outcome)
{
    printf("%s: %s\n  geomint render %s%s%s\n", job->figure->name, job->figure->statement,
           gm_figure_word(job), *job->arguments ? " " : "", job->arguments);
    if (outcome->progress == GM_NOT_MADE) {
        printf("  not made: %s\n", outcome->message);
    }
    for (size_t i = 0; i < outcome->verdict_count; i++) {
        char expected[128], found[64];
        const struct gm_statement *statement = &job->published->statements[i];
        const char *note = job->shortened ? "" : outcome->verdicts[i].note;
        gm_statement_expectation(statement, outcome->verdicts[i].scale, expected, sizeof expected);
        gm_verdict_number(outcome->verdicts[i].low, outcome->verdicts[i].high, found, sizeof found);
        printf("  %-14s %s: %s (%s)%s%s\n", gm_verdict_word(job, outcome, i), statement->says, found,
               expected, *note ? "; " : "", note);
    }
    if (outcome->progress == GM_MADE) {
        print_lanes(job, outcome);
    }
}

static void print_outcome(const struct series *series, size_t i)
{
    (series->options->json ? print_json : print_text)(&series->jobs[i], &series->outcomes[i]);
}

static void clear_progress(const struct series *series)
{
    if (series->progress) {
        fputs("\r\033[K", stderr);
    }
}

static void print_finished(struct series *series)
{
    while (series->printed < series->count && series->outcomes[series->printed].progress >= GM_MADE) {
        clear_progress(series);
        print_outcome(series, series->printed++);
        fflush(stdout);
    }
}

static bool write_page(struct series *series, int *status)
{
    char message[GM_MESSAGE];
    series->page_written = gm_clock_seconds();
    const bool written =
        gm_figures_page_write(&series->output, series->jobs, series->outcomes, series->count, message);
    *status = written ? *status : gm_give_up(GM_EXIT_FILE, "%s", message);
    return written;
}

/* The result of a worker that has ended; it is composed here if the worker was killed or crashed. */
static void take_end(struct series *series, size_t job, int end)
{
    struct gm_outcome *outcome = &series->outcomes[job];
    series->made++;
    if (WIFSIGNALED(end) || outcome->progress == GM_RUNNING) {
        outcome->status = WIFSIGNALED(end) ? GM_EXIT_USAGE : WEXITSTATUS(end);
        if (WIFSIGNALED(end)) {
            snprintf(outcome->message, sizeof outcome->message, "it was ended by signal %d (%s)",
                     WTERMSIG(end), strsignal(WTERMSIG(end)));
        } else {
            snprintf(outcome->message, sizeof outcome->message, "it ended early");
        }
        outcome->progress = GM_NOT_MADE;
        outcome->verdict_count = 0;
    }
    if (outcome->progress == GM_NOT_MADE && !gm_interrupted) {
        clear_progress(series);
        gm_complain("%s was not made: %s", series->jobs[job].figure->name, outcome->message);
    }
}

static void start(struct series *series)
{
    const size_t job = series->next++;
    struct gm_outcome *outcome = &series->outcomes[job];
    outcome->progress = GM_RUNNING;
    fflush(NULL);
    const pid_t parent = getpid(), process = fork();
    if (process == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (getppid() == parent) {
            gm_figure_make(&series->jobs[job], &series->output, outcome);
        }
        _exit(0);
    }
    if (process < 0) {
        outcome->progress = GM_NOT_MADE;
        outcome->status = GM_EXIT_FILE;
        snprintf(outcome->message, sizeof outcome->message, "no process could be started: %s",
                 strerror(errno));
        take_end(series, job, 0);
        return;
    }
    series->workers[job] = process;
    series->running++;
}

/* Waits until a worker ends, and passes interruptions on. Returns false when all are idle. */
static bool wait_for_one(struct series *series)
{
    int end = 0;
    pid_t process;
    for (bool told = false; (process = waitpid(-1, &end, WNOHANG)) == 0;) {
        const bool interrupted = gm_interrupted; /* it may change during the loop */
        for (size_t i = 0; i < series->count && interrupted && !told; i++) {
            if (series->workers[i]) {
                kill(series->workers[i], SIGTERM);
            }
        }
        told = interrupted;
        nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
    }
    for (size_t i = 0; i < series->count && process > 0; i++) {
        if (series->workers[i] == process) {
            series->workers[i] = 0;
            series->running--;
            take_end(series, i, end);
        }
    }
    return process > 0;
}

static void run(struct series *series, int *status)
{
    const double page_seconds = 10;
    do {
        while (series->running < series->most_running && series->next < series->count && !gm_interrupted) {
            start(series);
        }
        print_finished(series);
        show_progress(series);
        if (gm_clock_seconds() - series->page_written > page_seconds) {
            write_page(series, status);
        }
    } while (wait_for_one(series));
    clear_progress(series);
}

static void print_sum(const struct series *series, bool page)
{
    const struct gm_figure_sum sum = gm_figures_sum(series->jobs, series->outcomes, series->count);
    const struct gm_tally *said = &sum.of[GM_OF_DOCUMENT], *ours = &sum.of[GM_OF_OURS],
                          *variants = &sum.of[GM_OF_VARIANT];
    gm_say("%zu of %zu figure%s made; %zu statement%s of the documents %s, %zu %s not, %zu open%s%s%s",
           sum.made, series->count, gm_plural((double)series->count), said->hold,
           gm_plural((double)said->hold), said->hold == 1 ? "holds" : "hold", said->fail,
           said->fail == 1 ? "does" : "do", said->open, page ? "; " : "", page ? series->output.folder : "",
           page ? "/figures.html" : "");
    gm_say(
        "counted apart: of ours %zu hold, %zu do not, %zu open; of variants of figures %zu hold, %zu do not, "
        "%zu open",
        ours->hold, ours->fail, ours->open, variants->hold, variants->fail, variants->open);
}

int gm_command_figures(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    int status = GM_EXIT_OK;
    struct series *series = open_series(options);
    gm_command_end_if(options, !gm_folder_make(options->out, message), GM_EXIT_FILE, "%s", message);
    gm_catch_interrupts();
    run(series, &status);
    /* finished ones that follow an interrupted one */
    for (size_t i = series->printed; i < series->count; i++) {
        if (series->outcomes[i].progress == GM_MADE) {
            print_outcome(series, i);
        }
    }
    const bool page = write_page(series, &status);
    if (!options->json) {
        print_sum(series, page);
    }
    if (page) {
        gm_complain("wrote %s/figures.html and its pictures", series->output.folder);
    }
    for (size_t i = 0; i < series->count; i++) {
        if (series->outcomes[i].progress == GM_NOT_MADE && series->outcomes[i].status > status) {
            status = series->outcomes[i].status;
        }
    }
    return gm_interrupted ? GM_EXIT_INTERRUPTED : status;
}
