/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A tour as a movie or as pictures: the explorer's display, with the texts below. */
#include "app/tours/tour.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/output/folder.h"
#include "app/output/provenance.h"
#include "app/output/say.h"
#include "core/memory.h"
#include "render/files/images.h"
#include "render/files/sink.h"
#include "render/pixels/canvas.h"

enum { PARAGRAPHS = 4 };

/* Reading speed, and durations of a step's last picture, in seconds. */
static const double words_a_second = 2.7, settle_seconds = 1.5, end_seconds = 2;

struct show {
    const struct gm_tour *tour;
    const struct gm_tour_output *output;
    const struct gm_tour_step *step;
    struct gm_session session;
    bool open; /* the session is */
    struct gm_canvas *canvas;
    struct gm_picture *picture;
    struct gm_sink *sink;       /* the movie; NULL: pictures */
    unsigned char *rgb;         /* the picture on display */
    bool answered;              /* the step's question, if it has one, is answered */
    const struct gm_grid *grid; /* the study that is drawn instead of the scene, or NULL */
    bool failed;
    char message[GM_MESSAGE];
};

static bool fail(struct show *show, const char *sentence)
{
    snprintf(show->message, sizeof show->message, "%s", sentence);
    show->failed = true;
    return false;
}

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
        gm_grid_draw(show->grid, show->picture);
    }
    show->picture->told = told;
    show->picture->told_count = tell(show, told);
    show->picture->told_lines = 5;
    return (gm_canvas_paint(show->canvas, show->picture, show->rgb) && !gm_memory_was_short()) ||
           fail(show, "not enough memory to paint");
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

static long frames_of(const struct show *show, double seconds)
{
    return (long)fmax(1, round(seconds * show->output->fps));
}

/* OUT/NAME-03.png, or OUT/NAME-03-question.png. */
static bool write_page(struct show *show, const char *suffix)
{
    char path[4096];
    struct gm_session *session = &show->session;
    const struct gm_tour_output *output = show->output;
    const size_t number = (size_t)(show->step - show->tour->steps) + 1;
    if (show->sink) {
        return true;
    }
    snprintf(path, sizeof path, "%s/%s-%02zu%s.png", output->folder ? output->folder : ".", show->tour->name,
             number, suffix);
    struct gm_provenance provenance = {0};
    if (gm_provenance_make(&provenance, &session->log, &output->look, gm_canvas_backend(show->canvas)) &&
        gm_provenance_take_lanes(&provenance, (const struct gm_lane *const *)session->lanes, session->count,
                                 false)) {
        const struct gm_png image = {.width = output->look.width,
                                     .height = output->look.height,
                                     .dpi = output->look.dpi,
                                     .pixels = show->rgb,
                                     .texts = provenance.texts,
                                     .text_count = provenance.count};
        show->failed = !gm_png_write(path, &image, show->message);
    } else {
        fail(show, "not enough memory");
    }
    gm_provenance_close(&provenance);
    return !show->failed;
}

/* ---- one step ---- */

static bool open_scene(struct show *show)
{
    if (!show->step->show) {
        return true;
    }
    if (show->open) {
        gm_session_close(&show->session);
    }
    show->open = gm_session_open(&show->session, &show->step->request, show->message);
    show->failed = !show->open;
    return show->open;
}

static bool run(struct show *show)
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
            if (message[0]) {
                return fail(show, message);
            }
        }
        if ((show->sink || k == count) && (!paint(show) || !put(show, 1))) {
            return false;
        }
    }
    return true;
}

/* Draws the growing diagram: each point has the same number of frames, for the step's time in all. */
static void grow(void *self, const char *what, size_t done, size_t all)
{
    struct show *show = self;
    (void)what;
    if (show->sink && done > 0 && !show->failed && paint(show)) {
        show->failed = !put(show, frames_of(show, show->step->seconds / (double)all));
    }
}

static bool has_failed(void *self)
{
    return ((const struct show *)self)->failed;
}

static bool measure(struct show *show)
{
    const struct gm_listener listener = {.report = grow, .stopped = has_failed, .self = show};
    struct gm_arguments words = {0};
    struct gm_grid grid;
    bool measured = false;
    if (!gm_arguments_split(&words, show->step->study_words)) {
        fail(show, "not enough memory");
    } else if (gm_grid_open(&grid, show->step->study, &words, NULL, show->message)) {
        show->grid = &grid;
        measured = gm_grid_measure(&grid, &listener, show->message) && paint(show) && write_page(show, "") &&
                   put(show, frames_of(show, end_seconds));
        gm_grid_close(&grid);
    }
    show->grid = NULL;
    show->failed = show->failed || (!measured && !gm_interrupted);
    gm_arguments_close(&words);
    return measured;
}

static bool play(struct show *show, const struct gm_tour_step *step)
{
    show->step = step;
    show->answered = false;
    if (!open_scene(show)) {
        return false;
    }
    if (step->ask) {
        const double seconds = reading_seconds(step->say) + reading_seconds(step->ask) + settle_seconds;
        if (!paint(show) || !put(show, frames_of(show, seconds)) || !write_page(show, "-question")) {
            return false;
        }
    }
    show->answered = true;
    const double reading =
        reading_seconds(step->ask ? step->answer : step->say) + reading_seconds(step->watch);
    /* one looks while one reads, but not at the very beginning */
    if (!paint(show) || !put(show, frames_of(show, fmin(reading / 2, 4)))) {
        return false;
    }
    if (step->study != GM_STUDY_NONE && !measure(show)) {
        return false;
    }
    const double rest = step->study != GM_STUDY_NONE ? 0 : fmax(end_seconds, reading / 2 - step->seconds);
    return step->study != GM_STUDY_NONE ||
           (run(show) && put(show, frames_of(show, rest)) && write_page(show, ""));
}

static bool open_show(struct show *show)
{
    const struct gm_tour_output *output = show->output;
    show->canvas = gm_canvas_open(&output->look, show->message);
    show->picture = gm_picture_open();
    show->rgb = malloc(3 * (size_t)output->look.width * (size_t)output->look.height);
    if (!show->canvas) {
        return false;
    }
    if (!show->picture || !show->rgb) {
        return fail(show, "not enough memory");
    }
    if (output->movie) {
        const struct gm_sink_settings settings = {.width = output->look.width,
                                                  .height = output->look.height,
                                                  .fps = show->output->fps,
                                                  .interruptions = &gm_interrupted};
        if (gm_folder_make_for(output->movie, show->message)) {
            show->sink = gm_sink_open_movie(output->movie, &settings, show->message);
        }
        return show->sink != NULL;
    }
    return gm_folder_make(output->folder, show->message);
}

int gm_tour_render(const struct gm_tour *tour, const struct gm_tour_output *output)
{
    struct show show = {.tour = tour, .output = output};
    bool played = open_show(&show);
    for (size_t i = 0; i < tour->count && played && !gm_interrupted; i++) {
        gm_listener_hears(&gm_terminal_listener, tour->steps[i].title, i + 1, tour->count);
        played = play(&show, &tour->steps[i]);
    }
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
        gm_complain("%s", show.message);
    }
    played = played && made;
    if (played && !gm_interrupted && output->movie) {
        gm_complain("wrote %s", output->movie);
    } else if (played && !gm_interrupted) {
        gm_complain("wrote %s/%s-*.png", output->folder ? output->folder : ".", tour->name);
    }
    gm_picture_close(show.picture);
    free(show.rgb);
    gm_canvas_close(show.canvas);
    return gm_interrupted ? GM_EXIT_INTERRUPTED : played ? GM_EXIT_OK : GM_EXIT_FILE;
}
