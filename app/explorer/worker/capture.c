/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Saves a session as a picture, a movie, or command lines that redo it. */
#include "app/explorer/worker/session.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/explorer/background/background.h"
#include "app/output/folder.h"
#include "app/output/printer.h"
#include "app/words/system.h"
#include "render/clock.h"
#include "render/files/sink.h"
#include "render/files/temporary.h"
#include "render/message.h"
#include "render/pixels/canvas.h"

/* ---- the recorder ---- */

enum { WIDTH = 1280, HEIGHT = 720, RATE = 30 };

struct gm_recorder {
    struct gm_job painting;
    char path[128];
    enum gm_theme theme;
    struct gm_sink *sink;

    /* owned by the caller */
    double begun; /* wall time of the first frame, in seconds, shifted by the omitted pauses */
    long frames;  /* number of frames, including those being painted */

    /* owned by the caller, or by the thread while it paints */
    struct gm_picture *picture;
    long repeat; /* number of frames that show the picture */

    /* owned by the thread */
    struct gm_canvas *canvas; /* NULL before the first picture */
    bool failed;
    char message[GM_MESSAGE];
};

/* Paints a picture once and adds `repeat` frames of it to the movie. The canvas is the thread's own. */
static void record(void *self)
{
    struct gm_recorder *recorder = self;
    const struct gm_appearance look = {.width = WIDTH, .height = HEIGHT, .theme = recorder->theme};
    if (!recorder->canvas && !recorder->failed) {
        recorder->canvas = gm_canvas_open(&look, recorder->message);
    }
    const unsigned char *rgb =
        recorder->canvas ? gm_canvas_paint(recorder->canvas, recorder->picture, NULL) : NULL;
    recorder->failed = recorder->failed || !rgb || !gm_sink_hold(recorder->sink, rgb, recorder->repeat);
}

static void end(void *self)
{
    struct gm_recorder *recorder = self;
    gm_canvas_close(recorder->canvas);
}

static void release(struct gm_recorder *recorder)
{
    gm_picture_close(recorder->picture);
    free(recorder);
}

static struct gm_recorder *open_recorder(const char *path, enum gm_theme theme, char *message)
{
    const struct gm_sink_settings settings = {
        .width = WIDTH, .height = HEIGHT, .fps = RATE, .interruptions = &gm_interrupted};
    char given_up[GM_MESSAGE];
    struct gm_recorder *recorder = calloc(1, sizeof *recorder);
    if (!recorder) {
        gm_refuse(message, "There is not enough memory.");
        return NULL;
    }
    *recorder = (struct gm_recorder){.theme = theme, .begun = NAN, .picture = gm_picture_open()};
    snprintf(recorder->path, sizeof recorder->path, "%s", path);
    if (!recorder->picture) {
        gm_refuse(message, "There is not enough memory.");
    } else {
        recorder->sink = gm_sink_open_movie(recorder->path, &settings, message);
    }
    if (recorder->sink && gm_job_open(&recorder->painting, record, end, recorder, -1, message)) {
        return recorder;
    }
    if (recorder->sink) {
        gm_sink_close(recorder->sink, false, given_up);
    }
    release(recorder);
    return NULL;
}

double gm_recorder_length(const struct gm_recorder *recorder)
{
    return (double)recorder->frames / RATE;
}

/* ---- pictures and systems ---- */

/* 300 dots per inch on 32 cm, 600 on the 16 cm of a text column */
enum { PRINT_WIDTH = 3840, PRINT_HEIGHT = 2160 };

bool gm_capture_save(struct gm_play *play, enum gm_theme theme, char *sentence)
{
    struct gm_session *session = &play->session;
    char path[128], message[GM_MESSAGE] = "";
    gm_folder_free_file(session->scene->name, ".png", path, sizeof path);
    for (size_t i = 0; i < session->count; i++) {
        session->log.lanes[i].steps = session->lanes[i]->run->steps;
    }
    struct gm_print print = {.path = path,
                             .look = {.width = PRINT_WIDTH, .height = PRINT_HEIGHT, .theme = theme}};
    bool ok = gm_still_write(&print, &session->log, (const struct gm_lane *const *)session->lanes, message);
    return gm_refuse(sentence, ok ? "Saved %.400s." : "Not saved: %.400s", ok ? path : message);
}

bool gm_capture_save_system(const struct gm_play *play, char *sentence)
{
    const struct gm_session *session = &play->session;
    char path[128];
    if (!session->scene->text) {
        return true;
    }
    char *text = gm_system_now(session->scene, gm_session_owner(session, session->selected, false), NULL);
    gm_folder_free_file(session->scene->name, ".system", path, sizeof path);
    const int error = text ? gm_temporary_write(path, text, strlen(text)) : ENOMEM;
    free(text);
    return error == 0 ? gm_refuse(sentence, "Saved %.400s: geomint ./%.60s runs it.", path, path)
                      : gm_refuse(sentence, "Not saved: %.400s: %.60s", path,
                                  error == ENOMEM ? "not enough memory" : strerror(error));
}

bool gm_capture_save_answer(const struct gm_play *play, char *sentence)
{
    const struct gm_session *session = &play->session;
    const struct gm_agenda *agenda = &play->agenda;
    char path[128];
    char *text = gm_answer_write(agenda->tour, agenda->step, &session->log,
                                 (const struct gm_lane *const *)session->lanes);
    gm_folder_free_file(agenda->tour->name, ".answer", path, sizeof path);
    const bool fits = !text || strlen(text) <= GM_MOST_ANSWER;
    const int error = !text ? ENOMEM : fits ? gm_temporary_write(path, text, strlen(text)) : E2BIG;
    free(text);
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (stream) {
        gm_arguments_put_shell(stream, path);
        if (agenda->tour->path) {
            fputc(' ', stream);
            gm_arguments_put_shell(stream, agenda->tour->path);
        }
    }
    char command[320] = "", *words = gm_stream_end(&writing);
    if (words && strlen(words) <= 300) { /* a command that is cut would be another one */
        snprintf(command, sizeof command, " %s", words);
    }
    free(words);
    return error == 0 ? gm_refuse(sentence, "Saved %.100s: geomint grade%s repeats it.", path, command)
           : !fits    ? gm_refuse(sentence, "Not saved: restart with r and change less during the run.")
                      : gm_refuse(sentence, "Not saved: %.400s: %.60s", path,
                               error == ENOMEM ? "not enough memory" : strerror(error));
}

/* ---- the movie ---- */

bool gm_capture_stop_recording(struct gm_capture *capture, char *sentence)
{
    struct gm_recorder *recorder = capture->recorder;
    char message[GM_MESSAGE] = "";
    if (!recorder) {
        return false;
    }
    gm_job_close(&recorder->painting);
    const bool closed = gm_sink_close(recorder->sink, true, message);
    if (recorder->message[0] || !closed) { /* painting failed, or writing */
        gm_refuse(sentence, "No movie: %.400s", recorder->message[0] ? recorder->message : message);
    } else {
        gm_refuse(sentence, "Saved %.100s, a movie of %.1f s.", recorder->path, gm_recorder_length(recorder));
    }
    release(recorder);
    capture->recorder = NULL;
    return true;
}

bool gm_capture_record(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme,
                       char *sentence)
{
    char path[128], message[GM_MESSAGE] = "";
    if (gm_capture_stop_recording(capture, sentence)) {
        return false;
    }
    gm_folder_free_file(session->scene->name, ".mp4", path, sizeof path);
    capture->recorder = open_recorder(path, theme, message);
    capture->unrecorded = true;
    return capture->recorder ? gm_refuse(sentence, "Recording %.100s; R ends it.", path)
                             : gm_refuse(sentence, "No movie: %.400s", message);
}

void gm_capture_take_frame(struct gm_capture *capture, const struct gm_session *session)
{
    struct gm_recorder *recorder = capture->recorder;
    const double now = gm_clock_seconds();
    if (!recorder || !capture->unrecorded) {
        return;
    }
    if (isnan(recorder->begun)) {
        recorder->begun = now - 1.0 / RATE;
    }
    long due = (long)((now - recorder->begun) * RATE + 1e-6) - recorder->frames;
    if (due < 1 || gm_job_is_busy(&recorder->painting)) {
        return;
    }
    if (due > RATE) { /* no change for over a second */
        recorder->begun += (double)(due - RATE) / RATE;
        due = RATE;
    }
    recorder->repeat = due;
    recorder->frames += due;
    gm_picture_clear(recorder->picture);
    gm_lanes_draw((const struct gm_lane *const *)session->lanes, session->count, recorder->picture);
    gm_job_begin(&recorder->painting);
    capture->unrecorded = false;
}

void gm_capture_wait(struct gm_capture *capture)
{
    if (capture->recorder) {
        gm_job_wait(&capture->recorder->painting);
    }
}

void gm_capture_tell(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme)
{
    gm_capture_close(capture);
    capture->commands[GM_COMMAND_PICTURE] = gm_session_picture_command(session, theme);
    capture->commands[GM_COMMAND_EXPLORER] = gm_session_explorer_command(session);
    capture->command_number++;
}

void gm_capture_close(struct gm_capture *capture)
{
    for (size_t i = 0; i < GM_COMMANDS; i++) {
        free(capture->commands[i]);
    }
}
