/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tour as a movie or as pictures: the explorer's display, with the texts below. */
#include "app/tours/tour.h"

#include <math.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/output/folder.h"
#include "app/output/provenance.h"
#include "app/output/say.h"
#include "core/arena.h"
#include "core/memory.h"
#include "render/files/images.h"
#include "render/files/sink.h"
#include "render/pixels/canvas.h"

enum { PARAGRAPHS = 4 };

/* Reading speed, and durations of a step's last picture, in seconds. */
static const double words_a_second = 2.7, settle_seconds = 1.5, end_seconds = 2;

struct show {
    struct gm_arena *arena;
    const struct gm_tour *tour;
    const struct gm_tour_output *output;
    const struct gm_tour_step *step;
    struct gm_session session;
    bool open; /* the session is */
    struct gm_canvas *canvas;
    struct gm_picture *picture;
    struct gm_sink *sink;       /* the movie; NULL: pictures */
    const unsigned char *rgb;   /* the picture on display */
    bool answered;              /* the step's question, if it has one, is answered */
    const struct gm_grid *grid; /* the study that is drawn instead of the scene, or NULL */
    bool failed;                /* the growing diagram could not be shown */
};

static double reading_seconds(const char *text)
{
    double words = 0;
    for (const char *at = text; at && *at; at++) {
        words += *at != ' ' && (at[1] == ' ' || at[1] == '\0');
    }
    return words > 0 ? words / words_a_second : 0;
}

/* ---- one picture ---- */

static size_t tell(const struct show *show, struct gm_paragraph *told)
{
    const struct gm_tour_step *step = show->step;
    const bool asks = step->ask && !show->answered;
    size_t count = 0;
    told[count++] = (struct gm_paragraph){step->title, GM_INK, true};
    if (asks || !step->ask) {
        told[count++] = (struct gm_paragraph){step->say, GM_INK, false};
    }
    if (asks) {
        told[count++] = (struct gm_paragraph){step->ask, GM_INK, true};
        return count;
    }
    if (step->ask) {
        told[count++] = (struct gm_paragraph){step->answer, GM_INK, false};
    }
    if (step->watch) {
        const char *watch = gm_picture_text(show->picture, "Watch: %s", step->watch);
        told[count++] = (struct gm_paragraph){watch, GM_SECONDARY, false};
    }
    return count;
}

static bool paint(struct show *show)
{
    const struct gm_session *session = &show->session;
    struct gm_paragraph told[PARAGRAPHS];
    gm_picture_clear(show->picture);
    if (!show->grid) {
        gm_lanes_draw((const struct gm_lane *const *)session->lanes, session->count, show->picture);
    } else {
        gm_picture_draw(show->picture, gm_grid_draw, show->grid);
    }
    show->picture->told = told;
    show->picture->told_count = tell(show, told);
    show->picture->told_lines = 5;
    show->rgb = gm_canvas_paint(show->canvas, show->picture, NULL);
    return show->rgb && !gm_memory_was_short();
}

/* Shows the current picture for `count` frames. Returns false after a failure, which the sink reports when
   it is closed. */
static bool put(struct show *show, long count)
{
    for (long i = 0; show->sink && i < count && !gm_interrupted; i++) {
        if (!gm_sink_hold(show->sink, show->rgb, 1)) {
            return false;
        }
    }
    return true;
}

/* Paints the current state and shows it for `count` frames. */
static void present(struct show *show, long count)
{
    gm_arena_refuse_if(show->arena, !paint(show), "not enough memory to paint");
    if (!put(show, count)) {
        gm_arena_leave(show->arena);
    }
}

static long frames_of(const struct show *show, double seconds)
{
    return (long)fmax(1, round(seconds * show->output->fps));
}

/* Writes OUT/NAME-03.png, or OUT/NAME-03-question.png, unless there is a movie. */
static void write_page(struct show *show, const char *suffix)
{
    char message[GM_MESSAGE];
    struct gm_session *session = &show->session;
    const struct gm_tour_output *output = show->output;
    const size_t number = (size_t)(show->step - show->tour->steps) + 1;
    if (show->sink) {
        return;
    }
    const char *path = gm_arena_print(show->arena, "%s/%s-%02zu%s.png", output->folder ? output->folder : ".",
                                      show->tour->name, number, suffix);
    struct gm_provenance provenance = {0};
    const bool made =
        gm_provenance_make(&provenance, &session->log, &output->look, gm_canvas_backend(show->canvas)) &&
        gm_provenance_take_lanes(&provenance, (const struct gm_lane *const *)session->lanes, session->count,
                                 false);
    const struct gm_png image = {.width = output->look.width,
                                 .height = output->look.height,
                                 .dpi = output->look.dpi,
                                 .pixels = show->rgb,
                                 .texts = provenance.texts,
                                 .text_count = provenance.count};
    const bool written = made && gm_png_write(path, &image, message);
    gm_provenance_close(&provenance);
    gm_arena_need(show->arena, made);
    gm_arena_check(show->arena, written, message);
}

/* ---- one step ---- */

static void open_scene(struct show *show)
{
    char message[GM_MESSAGE];
    if (show->open) {
        gm_session_close(&show->session);
    }
    show->open = gm_session_open(&show->session, &show->step->request, message);
    gm_arena_check(show->arena, show->open, message);
}

static void run(struct show *show)
{
    const size_t number = (size_t)(show->step - show->tour->steps);
    const double begin = gm_tour_begin(show->tour, number), end = show->step->until;
    struct gm_agenda agenda = gm_agenda_of(show->tour, number, number);
    const long count = end > begin ? frames_of(show, show->step->seconds) : 0;
    for (long k = 1; k <= count && !gm_interrupted; k++) {
        const double t = k < count ? begin + (end - begin) * (double)k / (double)count : end;
        char message[GM_MESSAGE];
        bool more = true;
        while (more && !gm_interrupted) {
            const double limit = fmin(t, gm_agenda_limit(&agenda));
            while (gm_session_advance(&show->session, limit) && !gm_interrupted) {
                ;
            }
            more = limit < t;
            gm_agenda_keep(&agenda, &show->session, message);
            gm_arena_check(show->arena, !message[0], message);
        }
        if (show->sink || k == count) {
            present(show, 1);
        }
    }
}

/* Draws the growing diagram: each point has the same number of frames, for the step's time in all. It is called from
   within the measurement, which must end before the body is left. */
static void grow(void *self, const char *what, size_t done, size_t all)
{
    struct show *show = self;
    (void)what;
    if (show->sink && done > 0 && !show->failed) {
        show->failed = !paint(show) || !put(show, frames_of(show, show->step->seconds / (double)all));
    }
}

static bool has_failed(void *self)
{
    return ((const struct show *)self)->failed;
}

static void measure(struct show *show)
{
    char message[GM_MESSAGE];
    const struct gm_listener listener = {.report = grow, .stopped = has_failed, .self = show};
    const struct gm_arguments *words = gm_arguments_of(show->arena, show->step->study_words);
    struct gm_grid *grid = gm_arena_take(show->arena, 1, sizeof *grid);
    gm_arena_check(show->arena, gm_grid_open(grid, show->step->study, words, NULL, message), message);
    show->grid = gm_arena_keep(show->arena, grid, gm_grid_close);
    const bool measured = gm_grid_measure(grid, &listener, message);
    gm_arena_check(show->arena, measured || gm_interrupted, message);
    if (measured) {
        present(show, frames_of(show, end_seconds));
        write_page(show, "");
    }
    gm_arena_drop(show->arena, grid);
    show->grid = NULL;
}

static void play(struct show *show, const struct gm_tour_step *step)
{
    show->step = step;
    show->answered = false;
    if (step->show) {
        open_scene(show);
    }
    if (step->ask) {
        const double seconds = reading_seconds(step->say) + reading_seconds(step->ask) + settle_seconds;
        present(show, frames_of(show, seconds));
        write_page(show, "-question");
    }
    show->answered = true;
    const double reading =
        reading_seconds(step->ask ? step->answer : step->say) + reading_seconds(step->watch);
    /* one looks while one reads, but not at the very beginning */
    present(show, frames_of(show, fmin(reading / 2, 4)));
    if (step->study != GM_STUDY_NONE) {
        measure(show);
        return;
    }
    run(show);
    if (!put(show, frames_of(show, fmax(end_seconds, reading / 2 - step->seconds)))) {
        gm_arena_leave(show->arena);
    }
    write_page(show, "");
}

static void play_all(struct gm_arena *arena, void *data)
{
    struct show *show = data;
    const struct gm_tour *tour = show->tour;
    const struct gm_tour_output *output = show->output;
    char message[GM_MESSAGE];
    show->canvas = gm_canvas_open(&output->look, message);
    gm_arena_check(arena, show->canvas, message);
    show->picture = gm_picture_open();
    gm_arena_need(arena, show->picture);
    if (output->movie) {
        const struct gm_sink_settings settings = {.width = output->look.width,
                                                  .height = output->look.height,
                                                  .fps = output->fps,
                                                  .interruptions = &gm_interrupted};
        gm_arena_check(arena, gm_folder_make_for(output->movie, message), message);
        show->sink = gm_sink_open_movie(output->movie, &settings, message);
        gm_arena_check(arena, show->sink, message);
    } else {
        gm_arena_check(arena, gm_folder_make(output->folder, message), message);
    }
    for (size_t i = 0; i < tour->count && !gm_interrupted; i++) {
        gm_listener_hears(&gm_terminal_listener, tour->steps[i].title, i + 1, tour->count);
        play(show, &tour->steps[i]);
    }
}

int gm_tour_render(const struct gm_tour *tour, const struct gm_tour_output *output)
{
    struct show show = {.arena = gm_arena_open(), .tour = tour, .output = output};
    bool played = gm_arena_run(show.arena, play_all, &show);
    gm_terminal_listener_clear();
    if (show.open) {
        gm_session_close(&show.session);
    }
    /* an interrupted movie is finished with the frames it has */
    char failure[GM_MESSAGE] = "";
    gm_interrupts_seen();
    const bool made = !show.sink || gm_sink_close(show.sink, played || gm_interrupted, failure);
    if (!made) {
        gm_complain("%s", failure);
    } else if (!played && !gm_interrupted) {
        gm_complain("%s", gm_arena_reason(show.arena));
    }
    played = played && made;
    if (played && !gm_interrupted && output->movie) {
        gm_complain("wrote %s", output->movie);
    } else if (played && !gm_interrupted) {
        gm_complain("wrote %s/%s-*.png", output->folder ? output->folder : ".", tour->name);
    }
    gm_picture_close(show.picture);
    gm_canvas_close(show.canvas);
    gm_arena_close(show.arena);
    return gm_interrupted ? GM_EXIT_INTERRUPTED : played ? GM_EXIT_OK : GM_EXIT_FILE;
}
