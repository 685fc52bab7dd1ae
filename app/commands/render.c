/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint render: pictures, frames and movies. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/output/folder.h"
#include "app/output/frames.h"
#include "app/output/printer.h"
#include "app/output/say.h"
#include "app/words/drive.h"
#include "core/arena.h"
#include "core/expression/number.h"
#include "core/memory.h"
#include "render/clock.h"
#include "render/files/sink.h"
#include "render/pixels/canvas.h"

/* A render of many frames writes them as pictures from the first one, a movie's into a folder beside the
   movie until it is complete, and a checkpoint of its lanes from time to time. The same command resumes a
   killed render: existing frames are checked and kept. The state comes from the checkpoint or, without a
   usable one, from the start without painting. Both give the same bits as an uninterrupted render. */

struct work {
    struct gm_request *request;
    const struct gm_options *options;
    const char *name; /* how the names of files begin */
    struct gm_drive *drives;
    struct gm_lane **lanes;
    struct gm_canvas *canvas;
    struct gm_picture *picture;
    struct gm_schedule schedule;
    struct gm_provenance provenance;
    /* the files of a sequence */
    struct gm_frames frames;
    const char *checkpoint; /* the checkpoint's path; NULL: the lanes cannot be resumed from a snapshot */
    long done;              /* the number of existing frames */
    struct gm_sink *pictures, *movie; /* NULL: not requested */
};

static const struct gm_lane *const *lanes_of(const struct work *work)
{
    return (const struct gm_lane *const *)work->lanes;
}

static void show_progress(const struct work *work, long made, double started)
{
    const long count = work->schedule.ours;
    const double rate = (double)made / fmax(gm_clock_seconds() - started, 1e-9);
    enum { WIDTH = 30 };
    const int filled = (int)((double)WIDTH * (double)work->done / (double)count);
    char bar[WIDTH + 1];
    for (int i = 0; i < WIDTH; i++) {
        bar[i] = i < filled ? '#' : '.';
    }
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r%s %ld/%ld frames, %.1f a second, %.0f s left  ", bar, work->done, count, rate,
            (double)(count - work->done) / fmax(rate, 1e-9));
}

static bool drive_to(struct work *work, long frame, char *message)
{
    for (size_t i = 0; i < work->request->count; i++) {
        if (!gm_drive_until(&work->drives[i], gm_schedule_time(&work->schedule, frame), true, message)) {
            return false;
        }
    }
    return true;
}

/* Passes a painted frame to the pictures, with its metadata. */
static void put_picture(struct work *work, unsigned char *rgb, long frame)
{
    struct gm_arena *arena = work->options->arena;
    const size_t mark = gm_arena_mark(arena), lanes = work->request->count;
    const char *steps = gm_arena_keep(arena, gm_provenance_steps(lanes_of(work), lanes), free);
    const char *failures = gm_arena_keep(arena, gm_provenance_failures(lanes_of(work), lanes), free);
    struct gm_png_text texts[3] = {{GM_KEY_STEPS, steps}};
    size_t count = 1;
    if (failures[0]) {
        texts[count++] = (struct gm_png_text){GM_KEY_FAILURES, failures};
    }
    texts[count++] = (struct gm_png_text){GM_KEY_FRAME, gm_frames_text(&work->frames, frame)};
    gm_sink_put(work->pictures, rgb, frame, texts, count);
    gm_arena_release(arena, mark);
}

static unsigned char *frame_of(const struct work *work, struct gm_sink *sink)
{
    unsigned char *rgb = gm_sink_frame(sink);
    if (!rgb) {
        gm_arena_leave(work->options->arena); /* the sink reports the reason when it is closed */
    }
    return rgb;
}

static void paint_frame(struct work *work, long frame)
{
    char message[GM_MESSAGE];
    struct gm_arena *arena = work->options->arena;
    gm_arena_check(arena, drive_to(work, frame, message), message);
    if (gm_interrupted) {
        return;
    }
    unsigned char *rgb = frame_of(work, work->pictures),
                  *copy = work->movie ? frame_of(work, work->movie) : NULL;
    gm_picture_clear(work->picture);
    gm_lanes_draw(lanes_of(work), work->request->count, work->picture);
    gm_arena_refuse_if(arena, !gm_canvas_paint(work->canvas, work->picture, rgb) || gm_memory_was_short(),
                       "not enough memory to paint");
    if (copy) {
        memcpy(copy, rgb, 3 * (size_t)work->options->look.width * (size_t)work->options->look.height);
        gm_sink_put(work->movie, copy, frame, NULL, 0);
    }
    put_picture(work, rgb, frame);
}

/* An existing frame goes into the movie as it is. */
static void reuse_frame(const struct work *work, long frame)
{
    char message[GM_MESSAGE];
    const struct gm_appearance *look = &work->options->look;
    if (work->movie) {
        unsigned char *rgb = frame_of(work, work->movie);
        gm_arena_check(
            work->options->arena,
            gm_png_read(gm_frames_path(&work->frames, frame), look->width, look->height, rgb, message),
            message);
        gm_sink_put(work->movie, rgb, frame, NULL, 0);
    }
}

static void close_lanes(struct work *work)
{
    for (size_t i = 0; work->lanes && i < work->request->count; i++) {
        gm_lane_close(work->lanes[i]);
        work->lanes[i] = NULL;
    }
}

static void open_lanes(struct work *work)
{
    char message[GM_MESSAGE];
    for (size_t i = 0; i < work->request->count; i++) {
        work->lanes[i] = gm_request_open_lane(work->request, i, message);
        gm_arena_check(work->options->arena, work->lanes[i], message);
        work->drives[i] = (struct gm_drive){.lane = work->lanes[i], .request = work->request, .index = i};
    }
}

/* The first of our missing frames, or the last; -1: none is missing. */
static long missing_frame(const struct gm_frames *frames, bool last)
{
    long found = -1;
    for (long frame = 0; frame < frames->schedule->count && (last || found < 0); frame++) {
        if (!frames->there[frame] && gm_schedule_is_ours(frames->schedule, frame)) {
            found = frame;
        }
    }
    return found;
}

/* Loads the state after the frame before the first missing one, if a checkpoint has it. */
static void resume(struct work *work)
{
    const long first = missing_frame(&work->frames, false);
    long frame = -1;
    bool spoilt = false;
    if (first < 0 || !work->checkpoint) {
        return;
    }
    const bool read = gm_checkpoint_read(work->checkpoint, &work->frames, &frame, work->lanes,
                                         work->request->count, &spoilt);
    gm_arena_refuse_if(work->options->arena, gm_memory_was_short(), "not enough memory to read %.300s",
                       work->checkpoint);
    if ((read && frame >= first) ||
        spoilt) { /* a frame before it is missing: all begins at the start again */
        close_lanes(work);
        open_lanes(work);
    }
}

/* Saves the lanes' state after a frame, when all frames up to it are written. */
static void keep_state(const struct work *work, long frame)
{
    char message[GM_MESSAGE];
    gm_arena_check(work->options->arena,
                   !gm_sink_flush(work->pictures) ||
                       gm_checkpoint_write(work->checkpoint, &work->frames, frame, lanes_of(work),
                                           work->request->count, message),
                   message);
}

static void make_frames(struct work *work)
{
    enum { INTERVAL = 5, SHARE = 20 }; /* seconds between checkpoints; part of the time that they may take */
    const double started = gm_clock_seconds();
    const bool progress = isatty(STDERR_FILENO);
    const long last = work->movie ? work->schedule.count - 1 : missing_frame(&work->frames, true);
    double due = started + INTERVAL;
    long made = 0, painted = -1;
    work->done = work->frames.found;
    for (long frame = 0; frame <= last && !gm_interrupted; frame++) {
        if (!gm_schedule_is_ours(&work->schedule, frame)) {
            continue;
        }
        if (work->frames.there[frame]) {
            reuse_frame(work, frame);
            continue;
        }
        paint_frame(work, frame);
        if (!gm_interrupted) {
            made++;
            work->done++;
            painted = frame;
        }
        const double now = gm_clock_seconds();
        if (work->checkpoint && painted >= 0 && (now > due || (gm_interrupted && made > 0))) {
            keep_state(work, painted);
            const double after = gm_clock_seconds();
            due = after + fmax(INTERVAL, SHARE * (after - now));
        }
        if (progress) {
            show_progress(work, made, started);
        }
    }
    if (progress) {
        fputc('\n', stderr);
    }
}

/* FOLDER/NAME.checkpoint, or NAME-I-of-N.checkpoint of a shard; in the frames' arena. */
static const char *checkpoint_path(const struct gm_frames *frames)
{
    const struct gm_schedule *schedule = frames->schedule;
    return schedule->shards > 1
               ? gm_arena_print(frames->arena, "%s/%s-%ld-of-%ld.checkpoint", frames->folder, frames->name,
                                schedule->shard, schedule->shards)
               : gm_arena_print(frames->arena, "%s/%s.checkpoint", frames->folder, frames->name);
}

static void open_sinks(struct work *work)
{
    char message[GM_MESSAGE];
    const struct gm_options *options = work->options;
    const char *movie = options->pace.movie, *folder = options->out ? options->out : ".";
    const struct gm_sink_settings settings = {
        .width = options->look.width,
        .height = options->look.height,
        .dpi = options->look.dpi,
        .fps = isnan(options->pace.fps) ? 30 : options->pace.fps,
        .texts = work->provenance.texts,
        .text_count = work->provenance.count,
        .interruptions = &gm_interrupted,
    };
    /* the parts that can fail come first */
    if (movie) {
        gm_arena_check(options->arena,
                       gm_folder_make_for(movie, message) &&
                           (work->movie = gm_sink_open_movie(movie, &settings, message)),
                       message);
        /* the frames are beside the movie until it is complete */
        folder = options->out ? folder : gm_arena_print(options->arena, "%s.frames", movie);
    }
    gm_frames_open(&work->frames, options->arena, &work->schedule, folder, work->name, &work->provenance);
    if (gm_checkpoint_fits(work->request)) {
        work->checkpoint = checkpoint_path(&work->frames);
    }
    const char *pattern =
        gm_arena_print(options->arena, "%s/%s-%%06ld.png", work->frames.folder, work->frames.name);
    work->pictures = gm_sink_open_png(pattern, &settings, message);
    gm_arena_check(options->arena, work->pictures, message);
}

static void make_all(struct gm_arena *arena, void *data)
{
    char message[GM_MESSAGE];
    struct work *work = data;
    const struct gm_appearance *look = &work->options->look;
    work->canvas = gm_canvas_open(look, message);
    gm_arena_check(arena, work->canvas, message);
    gm_arena_need(
        arena, gm_provenance_make(&work->provenance, work->request, look, gm_canvas_backend(work->canvas)));
    open_sinks(work);
    if (work->frames.found > 0) {
        gm_complain("%ld of %ld frame%s %s there already", work->frames.found, work->schedule.ours,
                    gm_plural((double)work->schedule.ours), work->frames.found == 1 ? "is" : "are");
    }
    resume(work);
    make_frames(work);
}

/* The last of our frames, or -1. */
static long last_frame(const struct gm_schedule *schedule)
{
    long frame = schedule->count - 1;
    while (frame >= 0 && !gm_schedule_is_ours(schedule, frame)) {
        frame--;
    }
    return frame;
}

/* The failures of lanes in the shard's last frame, painted now or read from its file. */
static char *last_failures(const struct work *work)
{
    const long last = last_frame(&work->schedule);
    if (work->schedule.still || last < 0 || !work->frames.there[last]) {
        char *text = gm_provenance_failures(lanes_of(work), work->request->count);
        return gm_arena_keep(work->options->arena, text, free);
    }
    char message[GM_MESSAGE];
    char *text = gm_png_read_text(gm_frames_path(&work->frames, last), GM_KEY_FAILURES, message);
    return gm_arena_keep(work->options->arena, text ? text : strdup(""), free);
}

/* Prints the warnings on the last frame's lanes, if it was painted now. */
static void tell_warnings(const struct work *work)
{
    const long last = last_frame(&work->schedule);
    const bool painted = work->schedule.still || last < 0 || !work->frames.there[last];
    for (size_t i = 0; painted && i < work->request->count; i++) {
        char sentence[GM_MESSAGE];
        gm_lane_warning(work->lanes[i], sentence, sizeof sentence);
        if (sentence[0]) {
            gm_complain("%s: warning: %s", work->lanes[i]->scheme->name, sentence);
        }
    }
}

/* Reports ends that differ from the requested ones, each once; a scene's default lanes end at the best
   picture. */
static void tell_other_ends(const struct work *work)
{
    char last[GM_MESSAGE] = "", sentence[GM_MESSAGE];
    const struct gm_arguments *typed = &work->options->arguments;
    const bool asked = gm_arguments_have(typed, "until=") || gm_arguments_have(typed, "dt=");
    for (size_t i = 0; asked && i < work->request->count; i++) {
        gm_drive_other_end(&work->drives[i], sentence, sizeof sentence);
        if (sentence[0] && work->lanes[i]->run->steps == work->request->lanes[i].steps &&
            strcmp(sentence, last) != 0) {
            gm_complain("%s", sentence);
            strcpy(last, sentence);
        }
    }
}

/* The exit status of frames that are all written. */
static int tell_end(const struct work *work)
{
    char *failures = last_failures(work), *rest = NULL;
    const bool failed = failures[0] != '\0';
    for (char *line = strtok_r(failures, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        gm_complain("%s", line);
    }
    tell_warnings(work);
    tell_other_ends(work);
    return work->options->strict && failed ? GM_EXIT_NUMERICAL : GM_EXIT_OK;
}

/* Reports the written files; existing frames have been reported before. */
static void tell_written(const struct work *work)
{
    const struct gm_options *options = work->options;
    const struct gm_frames *frames = &work->frames;
    const long made = work->done - frames->found;
    if (options->pace.movie) {
        gm_complain("wrote %s", options->pace.movie);
    }
    if (made > 0 && (options->out || !options->pace.movie)) {
        gm_complain("wrote %ld frame%s, %s/%s-*.png", made, gm_plural((double)made), frames->folder,
                    frames->name);
    }
}

static int close_sinks(struct work *work, bool painted, char *message)
{
    /* an interrupted movie is finished with the frames it has; only an error gives it up, but no picture */
    const bool written = !work->pictures || gm_sink_close(work->pictures, true, message);
    const bool moving = !work->movie || gm_sink_close(work->movie, painted && written, message);
    work->pictures = work->movie = NULL;
    return written && moving;
}

/* Removes the frames, and then the folder if it is empty. */
static void remove_frames(const struct gm_frames *frames)
{
    for (long frame = 0; frame < frames->schedule->count; frame++) {
        const size_t mark = gm_arena_mark(frames->arena);
        unlink(gm_frames_path(frames, frame));
        gm_arena_release(frames->arena, mark);
    }
    rmdir(frames->folder);
}

static int paint_all(struct work *work)
{
    char message[GM_MESSAGE] = "";
    const struct gm_options *options = work->options;
    *options->end = GM_EXIT_FILE;
    const bool painted = gm_arena_run(options->arena, make_all, work);
    gm_interrupts_seen();
    gm_refuse(message, "%s", gm_arena_reason(options->arena));
    if (!close_sinks(work, painted, message) || !painted) {
        gm_complain("%s", message);
        if (!gm_interrupted) {
            return GM_EXIT_FILE;
        }
    }
    if (gm_interrupted) {
        return gm_give_up(GM_EXIT_INTERRUPTED,
                          "stopped at %ld of %ld frame%s; the same command resumes from there", work->done,
                          work->schedule.ours, gm_plural((double)work->schedule.ours));
    }
    const int status = tell_end(work);
    tell_written(work);
    if (work->checkpoint) {
        unlink(work->checkpoint);
    }
    if (options->pace.movie && !options->out) {
        remove_frames(&work->frames);
    }
    return status;
}

/* Paints a single picture, without files for a resumed render. */
static int paint_still(struct work *work)
{
    char message[GM_MESSAGE];
    const struct gm_options *options = work->options;
    const char *path = options->output
                           ? options->output
                           : gm_arena_print(options->arena, "%s/%s.%s", options->out ? options->out : ".",
                                            work->name, gm_format_name(options->format));
    struct gm_print print = {.path = path, .format = options->format, .look = options->look};
    gm_printer_expect(print.format);
    bool written = drive_to(work, 0, message);
    if (gm_interrupted) {
        return GM_EXIT_INTERRUPTED;
    }
    if (written) { /* a large picture takes long to paint and to pack */
        gm_interrupts_end(true);
        written = gm_still_write(&print, work->request, lanes_of(work), message);
        gm_interrupts_end(false);
    }
    if (!written) {
        const int status = gm_printer_fail(path, message);
        return gm_interrupted ? GM_EXIT_INTERRUPTED : status; /* a pipe may wait for its reader */
    }
    const int status = tell_end(work);
    gm_printer_report(&print, "");
    return status;
}

static void close_work(void *data)
{
    struct work *work = data;
    char message[GM_MESSAGE];
    close_sinks(work, false, message);
    close_lanes(work);
    gm_provenance_close(&work->provenance);
    gm_picture_close(work->picture);
    gm_canvas_close(work->canvas);
}

/* Output files below options->out begin with `name`. */
static int render(struct gm_request *request, const struct gm_options *options, const char *name)
{
    char message[GM_MESSAGE];
    struct work *work = gm_arena_take(options->arena, 1, sizeof *work);
    work->request = request;
    work->options = options;
    work->name = name;
    work->drives = gm_arena_take(options->arena, request->count, sizeof *work->drives);
    work->lanes = gm_arena_take(options->arena, request->count, sizeof *work->lanes);
    gm_arena_keep(options->arena, work, close_work);
    work->picture = gm_picture_open();
    gm_arena_need(options->arena, work->picture);
    *options->end = GM_EXIT_USAGE;
    gm_arena_check(options->arena, gm_schedule_make(&work->schedule, request, &options->pace, message),
                   message);
    gm_arena_refuse_if(options->arena, !work->schedule.still && options->format != GM_FORMAT_PNG,
                       "--format %s is for one picture: frames are PNG", gm_format_name(options->format));
    open_lanes(work);
    message[0] = '\0';
    for (size_t i = 0; i < request->count; i++) {
        gm_command_note(work->lanes[i], message);
    }
    return (work->schedule.still ? paint_still : paint_all)(work);
}

/* "LANE:STEP:KEY=VALUE,...", as the explorer writes them. */
static void take_changes(const struct gm_options *options, struct gm_request *request)
{
    char sentence[GM_MESSAGE], *text = gm_arena_print(options->arena, "%s", options->changes);
    int colons = 0, depth = 0; /* a scheme may be a word with commas in its parentheses */
    for (char *at = text; *at; at++) {
        depth += (*at == '(') - (*at == ')');
        if (*at == ',' && depth == 0) {
            *at = '\n';
            colons = 0;
        } else if (*at == ':' && colons < 2) {
            *at = ' ';
            colons++;
        }
    }
    gm_command_end_if(options, !gm_changes_parse(request, text), GM_EXIT_USAGE,
                      "--changes %.60s is not LANE:STEP:KEY=VALUE,... of lanes that there are",
                      options->changes);
    for (size_t i = 0; i < request->change_count; i++) {
        gm_command_end_if(options, !gm_change_check(request, &request->changes[i], sentence), GM_EXIT_USAGE,
                          "--changes %.60s: %.400s", options->changes, sentence);
    }
}

int gm_command_render(const struct gm_options *options)
{
    struct gm_request *request =
        gm_command_parse(options, options->arguments.count, options->arguments.words, GM_RENDER_SCHEMES);
    if (options->changes) {
        take_changes(options, request);
    }
    gm_command_confirm(options, request);
    gm_catch_interrupts();
    return render(request, options, gm_arena_print(options->arena, "%s-render", request->scene->name));
}
