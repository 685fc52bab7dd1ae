/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames go to ffmpeg's standard input; its messages go to a file, which needs no reader. Measured on 300
   plots of 1280x720, two cores, ffmpeg 5.1 (seconds, megabytes of file, of memory):

       mp4    libx264 veryfast, crf 18                        2.7     .60    172   (medium: 3.8, .64)
       webm   libvpx-vp9 realtime, crf 24                     1.6    1.0     208   (good: 9.4, .76)
       gif    frames kept without loss while the palette
              is gathered, then one more pass                 3.2    4.9     131
              one pass: every frame waits for the palette     7.9    4.9    1984
              one pass: a palette for every frame             9.3   21       127

   The first two lose nothing that can be seen (50 dB and more), so the fast settings are the right ones. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "render/clock.h"
#include "render/files/sink.h"
#include "render/files/temporary.h"

extern char **environ;

int gm_sink_movie_patience = 300000;

enum {
    DYING = 5000,        /* milliseconds for ffmpeg to report why it has closed its standard input */
    IDLE = 1000,         /* milliseconds for an idle ffmpeg after an interrupt */
    SLICE = 20,          /* milliseconds between two checks */
    PIPE_SIZE = 1 << 20, /* bytes of the pipe: fewer changes between the two processes; a wish */
    PATH_SHOWN = 200,    /* characters of a path in a sentence */
    LOG_SHOWN = 160,
    MOST_WORDS = 48,
};

enum format { MP4, WEBM, GIF, FORMATS };

static const char *const endings[FORMATS] = {[MP4] = ".mp4", [WEBM] = ".webm", [GIF] = ".gif"};

struct movie_sink {
    enum format format;
    int width, height;
    double fps;
    char *path, *log;
    char *temporary;        /* the name of the movie until it is complete */
    char *frames, *palette; /* the files between the two passes of a GIF */
    int log_descriptor, input;
    pid_t ffmpeg; /* 0 if it does not run */
    const atomic_int *interruptions;
    long count; /* frames written */
    bool failed;
};

struct command {
    const char *words[MOST_WORDS];
    size_t count;
};

static void add(struct command *command, size_t count, const char *const *words)
{
    for (size_t i = 0; i < count && command->count + 1 < MOST_WORDS; i++) {
        command->words[command->count++] = words[i];
    }
}

#define ADD(command, ...)                                                                                    \
    add(command, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *),                                \
        (const char *const[]){__VA_ARGS__})

/* Without -xerror ffmpeg 5.1 fills a disk and calls that success. */
static struct command begin(void)
{
    struct command command = {.count = 0};
    ADD(&command, "ffmpeg", "-hide_banner", "-nostats", "-loglevel", "warning", "-nostdin", "-xerror", "-y");
    return command;
}

/* Returns an errno, 0 if ffmpeg runs. ffmpeg has its own process group, so that geomint handles an interrupt
   from the keyboard. */
static int start_ffmpeg(struct movie_sink *self, struct command *command, int input)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none;
    sigemptyset(&none);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, self->log_descriptor, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, self->log_descriptor, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &none);
    int error = posix_spawnp(&self->ffmpeg, "ffmpeg", &actions, &attributes,
                             (char *const *)(const void *)command->words, environ);
    if (error) {
        self->ffmpeg = 0;
    }
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

/* Returns true if ffmpeg has ended. It is not reaped, so its process group stays its own. */
static bool has_ended(const struct movie_sink *self)
{
    siginfo_t ended = {0};
    return waitid(P_PID, (id_t)self->ffmpeg, &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != 0;
}

/* Kills ffmpeg and all it started. Returns its wait status; -1 if it ran. */
static int end_ffmpeg(struct movie_sink *self)
{
    const bool ended = has_ended(self);
    int status = -1;
    kill(-self->ffmpeg, SIGKILL);
    while (waitpid(self->ffmpeg, &status, 0) < 0 && errno == EINTR) {
    }
    self->ffmpeg = 0;
    return ended ? status : -1;
}

/* ---- waiting for ffmpeg ---- */

/* Returns the CPU time of ffmpeg, in nanoseconds; -1 if it is not available. */
static int64_t processor_time(const struct movie_sink *self)
{
    clockid_t clock;
    struct timespec used;
    if (clock_getcpuclockid(self->ffmpeg, &clock) != 0 || clock_gettime(clock, &used) != 0) {
        return -1;
    }
    return (int64_t)used.tv_sec * 1000000000 + used.tv_nsec;
}

struct wait {
    int64_t begun, idle; /* milliseconds: start of the wait, and of ffmpeg's idle time */
    int64_t used;        /* CPU time at the start of the idle time */
    int patience;        /* most milliseconds of the wait */
};

static struct wait begin_wait(const struct movie_sink *self, int patience)
{
    const int64_t now = gm_clock_milliseconds();
    return (struct wait){.begun = now, .idle = now, .used = processor_time(self), .patience = patience};
}

static int interruptions_of(const struct movie_sink *self)
{
    return self->interruptions ? *self->interruptions : 0;
}

static bool is_in_vain(const struct movie_sink *self, struct wait *wait)
{
    const int64_t now = gm_clock_milliseconds(), used = processor_time(self);
    if (used != wait->used) {
        wait->used = used;
        wait->idle = now;
    }
    const int interruptions = interruptions_of(self);
    return now - wait->begun > wait->patience || interruptions > 1 ||
           (interruptions == 1 && now - wait->idle > IDLE);
}

/* Returns the wait status; -1 if ffmpeg did not end by itself. */
static int await_ffmpeg(struct movie_sink *self, int patience)
{
    enum { NAP = 5 };
    struct wait wait = begin_wait(self, patience);
    while (!has_ended(self) && !is_in_vain(self, &wait)) {
        nanosleep(&(struct timespec){.tv_nsec = NAP * 1000000L}, NULL);
    }
    return end_ffmpeg(self);
}

/* Returns true if ffmpeg takes data again. */
static bool await_room(struct movie_sink *self)
{
    struct wait wait = begin_wait(self, gm_sink_movie_patience);
    struct pollfd room = {.fd = self->input, .events = POLLOUT};
    while (poll(&room, 1, SLICE) == 0) {
        /* another process may hold ffmpeg's input, and not read it */
        if (has_ended(self) || is_in_vain(self, &wait)) {
            return false;
        }
    }
    return true;
}

/* ---- the log of ffmpeg ---- */

/* Gives the last line of the log that has a reason, or "". */
static void read_reason(const struct movie_sink *self, char *reason, size_t size)
{
    char tail[4096];
    struct stat status;
    reason[0] = '\0';
    if (fstat(self->log_descriptor, &status) != 0) {
        return;
    }
    off_t start = status.st_size > (off_t)sizeof tail - 1 ? status.st_size - ((off_t)sizeof tail - 1) : 0;
    ssize_t length = pread(self->log_descriptor, tail, sizeof tail - 1, start);
    tail[length > 0 ? length : 0] = '\0';
    char *rest = tail;
    for (char *line; (line = strsep(&rest, "\r\n"));) {
        if (line[strspn(line, " \t")] != '\0' && strcmp(line, "Conversion failed!") != 0) {
            snprintf(reason, size, "%s", line);
        }
    }
    for (char *at = reason; *at; at++) {
        if ((unsigned char)*at < ' ' || *at == 127) {
            *at = ' ';
        }
    }
}

/* Makes the sentence for a wait status that is not success. */
static bool tell(struct movie_sink *self, int status, char *message)
{
    const bool interrupted = interruptions_of(self) > 0;
    char how[64];
    snprintf(how, sizeof how, interrupted ? "was interrupted" : "was ended, for it did nothing any more");
    if (status >= 0 && WIFSIGNALED(status)) {
        const char *name = sigdescr_np(WTERMSIG(status));
        snprintf(how, sizeof how, "was ended by a signal (%s)", name ? name : "?");
    } else if (status >= 0) {
        snprintf(how, sizeof how, "gave up (exit status %d)", WEXITSTATUS(status));
    }
    char reason[LOG_SHOWN];
    read_reason(self, reason, sizeof reason);
    gm_refuse(message, "ffmpeg %s and %.*s was not made%s%s", how, PATH_SHOWN, self->path,
              reason[0] ? "; its last message: " : "; it left no message", reason);
    self->failed = true;
    return false;
}

/* A movie has the order in which frames are put, and no texts. */
static bool write_frame(void *argument, const struct gm_sink_job *job, char *message)
{
    struct movie_sink *self = argument;
    const unsigned char *rgb = job->frame;
    size_t left = (size_t)self->width * (size_t)self->height * 3;
    while (left > 0) {
        ssize_t written = write(self->input, rgb, left);
        if (written > 0) {
            rgb += written;
            left -= (size_t)written;
        } else if (errno == EAGAIN) {
            if (!await_room(self)) {
                return tell(self, end_ffmpeg(self), message);
            }
        } else if (errno != EINTR) {
            int patience = gm_sink_movie_patience < DYING ? gm_sink_movie_patience : DYING;
            return tell(self, await_ffmpeg(self, patience), message);
        }
    }
    self->count++;
    return true;
}

/* Makes the second pass of a GIF, with the palette of all frames. */
static bool make_gif(struct movie_sink *self, char *message)
{
    struct command command = begin();
    ADD(&command, "-f", "nut", "-i", self->frames, "-f", "png_pipe", "-i", self->palette);
    ADD(&command, "-filter_complex", "paletteuse=dither=none:diff_mode=rectangle");
    ADD(&command, "-final_delay", "100", "-f", "gif", self->temporary);
    int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    int error = start_ffmpeg(self, &command, nothing);
    close(nothing);
    if (error) {
        gm_refuse(message, "ffmpeg could not be started: %s", strerror(error));
        self->failed = true;
        return false;
    }
    int status = await_ffmpeg(self, gm_sink_movie_patience);
    return status == 0 || tell(self, status, message);
}

/* Returns true if the file begins with the bytes of its format. */
static bool is_movie(const struct movie_sink *self)
{
    static const struct {
        size_t at;
        const char *bytes;
    } marks[FORMATS] = {[MP4] = {4, "ftyp"}, [WEBM] = {0, "\x1a\x45\xdf\xa3"}, [GIF] = {0, "GIF8"}};
    char begin[8] = "";
    const int file = open(self->temporary, O_RDONLY | O_CLOEXEC);
    const bool whole = file >= 0 && read(file, begin, sizeof begin) == (ssize_t)sizeof begin;
    if (file >= 0) {
        close(file);
    }
    return whole && memcmp(begin + marks[self->format].at, marks[self->format].bytes, 4) == 0;
}

static bool complete(struct movie_sink *self, char *message)
{
    int status = await_ffmpeg(self, gm_sink_movie_patience);
    if (status != 0) {
        return tell(self, status, message);
    }
    if (self->count == 0) {
        return gm_refuse(message, "there was no frame and %.*s was not made", PATH_SHOWN, self->path);
    }
    if (self->format == GIF && !make_gif(self, message)) {
        return false;
    }
    if (!is_movie(self)) {
        gm_refuse(message, "ffmpeg says that it is done, but what it left is not %.*s", PATH_SHOWN,
                  self->path);
        self->failed = true;
        return false;
    }
    if (rename(self->temporary, self->path) != 0) {
        return gm_refuse(message, "cannot write %.*s: %s", PATH_SHOWN, self->path, strerror(errno));
    }
    return true;
}

static void remove_and_free(char *path)
{
    if (path) {
        unlink(path);
    }
    free(path);
}

static bool close_movie(void *argument, bool keep, char *message)
{
    struct movie_sink *self = argument;
    if (self->input >= 0) {
        close(self->input);
    }
    bool finished = !keep || complete(self, message);
    if (self->ffmpeg > 0) {
        end_ffmpeg(self);
    }
    remove_and_free(self->temporary);
    remove_and_free(self->frames);
    remove_and_free(self->palette);
    if (self->log_descriptor >= 0) {
        close(self->log_descriptor);
        if (!self->failed) {
            unlink(self->log);
        }
    }
    free(self->log);
    free(self->path);
    free(self);
    return finished;
}

static int first_pass(struct movie_sink *self, int input)
{
    char size[32], rate[32], filters[256];
    snprintf(size, sizeof size, "%dx%d", self->width, self->height);
    /* a fraction, since a decimal point depends on the locale */
    snprintf(rate, sizeof rate, "%ld/1000", lround(self->fps * 1000));
    long still = lround(self->fps) - 1;

    /* 4:2:0 needs even sides: the last row and column are doubled. Without a matrix players guess one from
       the size. */
    int odd_width = self->width % 2, odd_height = self->height % 2;
    int used = 0;
    if (odd_width || odd_height) {
        used = snprintf(filters, sizeof filters, "pad=%d:%d,fillborders=right=%d:bottom=%d:mode=smear,",
                        self->width + odd_width, self->height + odd_height, odd_width, odd_height);
    }
    snprintf(
        filters + used, sizeof filters - (size_t)used,
        "scale=out_color_matrix=bt709:out_range=limited:flags=accurate_rnd+full_chroma_int,format=yuv420p,"
        "tpad=stop_mode=clone:stop=%ld",
        still > 0 ? still : 0);

    struct command command = begin();
    ADD(&command, "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size, "-framerate", rate);
    ADD(&command, "-i", "pipe:0", "-fflags", "+bitexact");
    if (self->format != GIF) {
        ADD(&command, "-vf", filters, "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc",
            "bt709");
    }
    switch (self->format) {
    case MP4:
        ADD(&command, "-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-movflags", "+faststart");
        ADD(&command, "-f", "mp4", self->temporary);
        break;
    case WEBM:
        ADD(&command, "-c:v", "libvpx-vp9", "-deadline", "realtime", "-cpu-used", "7", "-row-mt", "1");
        ADD(&command, "-crf", "24", "-b:v", "0", "-f", "webm", self->temporary);
        break;
    case GIF:
    case FORMATS:
        ADD(&command, "-filter_complex", "split[frames][all];[all]palettegen[palette]", "-map", "[frames]");
        ADD(&command, "-c:v", "libx264rgb", "-preset", "ultrafast", "-qp", "0", "-f", "nut", self->frames);
        ADD(&command, "-map", "[palette]", "-f", "image2", "-update", "1", self->palette);
        break;
    }
    return start_ffmpeg(self, &command, input);
}

static bool start_first_pass(struct movie_sink *self, char *message)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        return gm_refuse(message, "ffmpeg could not be started: %s", strerror(errno));
    }
    self->input = ends[1];
    fcntl(self->input, F_SETFL, O_NONBLOCK);
    fcntl(self->input, F_SETPIPE_SZ, PIPE_SIZE);
    int error = first_pass(self, ends[0]);
    close(ends[0]);
    if (error == ENOENT) {
        gm_refuse(message, "ffmpeg was not found; install it, or leave out --movie to get PNG frames");
    } else if (error) {
        gm_refuse(message, "ffmpeg could not be started: %s", strerror(error));
    }
    return error == 0;
}

static bool find_format(const char *path, enum format *format)
{
    size_t length = strlen(path);
    for (enum format i = 0; i < FORMATS; i++) {
        size_t ending = strlen(endings[i]);
        if (length > ending && strcasecmp(path + length - ending, endings[i]) == 0) {
            *format = i;
            return true;
        }
    }
    return false;
}

bool gm_sink_is_movie(const char *path)
{
    enum format format = MP4;
    return find_format(path, &format);
}

/* Checks at the start all that could fail after hours of simulation. */
static bool open_files(struct movie_sink *self, const char *path, char *message)
{
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        return gm_refuse(message, "cannot write %.*s: it exists and is not an ordinary file", PATH_SHOWN,
                         path);
    }
    gm_temporary_sweep(path);
    self->path = strdup(path);
    self->temporary = gm_temporary_name(path, endings[self->format]);
    if (self->format == GIF) {
        self->frames = gm_temporary_name(path, ".nut");
        self->palette = gm_temporary_name(path, ".png");
    }
    if (!self->path || !self->temporary || (self->format == GIF && (!self->frames || !self->palette)) ||
        asprintf(&self->log, "%s.log", path) < 0) {
        self->log = NULL;
        return gm_refuse(message, "not enough memory for a movie");
    }
    self->log_descriptor = open(self->log, O_RDWR | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (self->log_descriptor < 0) {
        return gm_refuse(message, "cannot write %.*s: %s", PATH_SHOWN, self->log, strerror(errno));
    }
    return true;
}

struct gm_sink *gm_sink_open_movie(const char *path, const struct gm_sink_settings *settings, char *message)
{
    static const struct gm_sink_kind kind = {.write = write_frame, .close = close_movie};
    enum format format = MP4;
    if (!find_format(path, &format)) {
        gm_refuse(message, "a movie is an .mp4, .webm or .gif file, which %.*s is not", PATH_SHOWN, path);
        return NULL;
    }
    struct movie_sink *self = calloc(1, sizeof *self);
    if (!self) {
        gm_refuse(message, "not enough memory for a movie");
        return NULL;
    }
    *self = (struct movie_sink){
        .format = format,
        .width = settings->width,
        .height = settings->height,
        .fps = settings->fps,
        .interruptions = settings->interruptions,
        .log_descriptor = -1,
        .input = -1,
    };
    if (!open_files(self, path, message) || !start_first_pass(self, message)) {
        close_movie(self, false, message);
        return NULL;
    }
    return gm_sink_start(&kind, self, 1, (size_t)settings->width * (size_t)settings->height * 3, message);
}
