/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is kept of a session: pictures, a movie, the command lines that redo it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/explorer/worker/shared.h"
#include "app/output/still.h"
#include "app/request/arguments.h"

/* 300 dots an inch on 32 cm, 600 on the 16 cm of a text column. */
enum { PRINT_WIDTH = 3840, PRINT_HEIGHT = 2160 };

/* SCENE-0001.png, or the first number that is free. */
static void free_name(const struct gm_worker *worker, const char *ending, char *path, size_t size)
{
    int number = 1;
    do {
        snprintf(path, size, "%.80s-%04d%s", worker->session.scene->name, number, ending);
    } while (access(path, F_OK) == 0 && number++ < 9999);
}

/* Where the lanes are goes into the log. */
static void note_steps(struct gm_worker *worker)
{
    for (size_t i = 0; i < worker->session.count; i++) {
        worker->session.log.lanes[i].steps = worker->session.lanes[i]->run->steps;
    }
}

void gm_worker_save(struct gm_worker *worker, enum gm_theme theme)
{
    char path[128], message[GM_MESSAGE] = "", sentence[GM_MESSAGE];
    free_name(worker, ".png", path, sizeof path);
    note_steps(worker);
    bool ok = gm_still_write(path, PRINT_WIDTH, PRINT_HEIGHT, theme, &worker->session.log,
                             (const struct gm_lane *const *)worker->session.lanes, message);
    snprintf(sentence, sizeof sentence, ok ? "Saved %.400s." : "Not saved: %.400s", ok ? path : message);
    gm_worker_say(worker, sentence);
}

/* ---- the movie ---- */

bool gm_worker_stop_recording(struct gm_worker *worker, char *sentence)
{
    char path[128], message[GM_MESSAGE] = "";
    if (!worker->recorder) {
        return false;
    }
    snprintf(path, sizeof path, "%s", gm_recorder_path(worker->recorder));
    double length = gm_recorder_length(worker->recorder);
    if (gm_recorder_close(worker->recorder, message)) {
        snprintf(sentence, GM_MESSAGE, "Saved %.100s, a movie of %.1f s.", path, length);
    } else {
        snprintf(sentence, GM_MESSAGE, "No movie: %.400s", message);
    }
    worker->recorder = NULL;
    return true;
}

void gm_worker_record(struct gm_worker *worker, enum gm_theme theme)
{
    char path[128], message[GM_MESSAGE] = "", sentence[GM_MESSAGE];
    if (gm_worker_stop_recording(worker, sentence)) {
        gm_worker_say(worker, sentence);
        return;
    }
    free_name(worker, ".mp4", path, sizeof path);
    worker->recorder = gm_recorder_open(path, theme, message);
    if (worker->recorder) {
        snprintf(sentence, sizeof sentence, "Recording %.100s; R ends it.", path);
    } else {
        snprintf(sentence, sizeof sentence, "No movie: %.400s", message);
    }
    worker->unrecorded = true;
    gm_worker_say(worker, sentence);
}

void gm_worker_take_frame(struct gm_worker *worker)
{
    const struct gm_session *session = &worker->session;
    if (!worker->recorder || !worker->unrecorded) {
        return;
    }
    struct gm_picture *picture = gm_recorder_due(worker->recorder, gm_worker_wall_time());
    if (picture) {
        session->scene->draw((const struct gm_lane *const *)session->lanes, session->count, picture);
        gm_recorder_put(worker->recorder);
        worker->unrecorded = false;
    }
}

/* ---- the command lines ---- */

/* The words of the arguments but those that say when it ends. */
static void put_arguments(FILE *stream, const char *text)
{
    struct gm_arguments arguments = {0};
    gm_arguments_split(&arguments, text);
    for (int i = 0; i < arguments.count; i++) {
        const char *word = arguments.words[i];
        if (strncmp(word, "until=", 6) != 0 && strncmp(word, "steps=", 6) != 0) {
            fputc(' ', stream);
            gm_arguments_put(stream, word);
        }
    }
    gm_arguments_close(&arguments);
}

/* Where the lanes are: the steps, if they have made equally many. */
static void put_end(FILE *stream, const struct gm_session *session)
{
    long steps = session->lanes[0]->run->steps;
    for (size_t i = 1; i < session->count; i++) {
        if (session->lanes[i]->run->steps != steps) {
            fprintf(stream, " until=%.17g", gm_session_time(session));
            return;
        }
    }
    fprintf(stream, " steps=%ld", steps);
}

static char *tell_picture(const struct gm_session *session, enum gm_theme theme)
{
    const struct gm_request *log = &session->log;
    char *text = NULL, *arguments = gm_request_format(log);
    size_t size = 0;
    FILE *stream = arguments ? open_memstream(&text, &size) : NULL;
    if (stream) {
        fputs("geomint render", stream);
        put_arguments(stream, arguments);
        put_end(stream, session);
        for (size_t i = 0; i < log->change_count; i++) {
            const struct gm_change *change = &log->changes[i];
            fprintf(stream, "%s%zu:%ld:%s", i == 0 ? " --changes " : ",", change->lane, change->step,
                    change->text);
        }
        fprintf(stream, " --theme %s", theme == GM_THEME_DARK ? "dark" : "light");
        fclose(stream);
    }
    free(arguments);
    return text;
}

/* The lanes with the schemes and parameters that they have now: what was changed in flight is as if it had
   been typed. */
static char *tell_explorer(const struct gm_session *session)
{
    struct gm_lane_spec lanes[GM_MOST_LANES];
    struct gm_request present = session->log;
    bool good = true;
    present.lanes = lanes;
    present.arguments = session->log.change_count > 0 ? NULL : session->log.arguments;
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_settings *settings = gm_session_owner(session, i, true);
        lanes[i] = (struct gm_lane_spec){
            .shown = session->lanes[i]->shown, .settings = *settings, .scheme = session->lanes[i]->scheme};
        lanes[i].parameters = gm_parameters_copy(session->scene, gm_session_owner(session, i, false));
        struct gm_timing *timing = lanes[i].parameters;
        good = good && timing;
        if (timing) {
            timing->dt = fabs(timing->dt); /* a start is forwards */
        }
    }
    char *text = NULL, *arguments = good ? gm_request_format(&present) : NULL;
    if (arguments && asprintf(&text, "geomint %s", arguments) < 0) {
        text = NULL;
    }
    free(arguments);
    for (size_t i = 0; i < session->count; i++) {
        free(lanes[i].parameters);
    }
    return text;
}

void gm_worker_tell(struct gm_worker *worker, enum gm_theme theme)
{
    for (size_t i = 0; i < GM_COMMANDS; i++) {
        free(worker->commands[i]);
    }
    worker->commands[GM_COMMAND_PICTURE] = tell_picture(&worker->session, theme);
    worker->commands[GM_COMMAND_EXPLORER] = tell_explorer(&worker->session);
    worker->command_number++;
}
