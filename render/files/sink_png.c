/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sink of numbered PNG files, written by several threads. */
#include "render/files/sink.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_WORKERS = 64, MOST_DIGITS = 64 };

/* The pattern is parsed and not given to printf, because the user may have put a % into the folder's name. */
struct png_sink {
    char *pattern;
    size_t before, after; /* start and end of the conversion in the pattern; both 0 without one */
    bool zeros;
    int digits;
    int width, height;
    double dpi;
    struct gm_png_text *texts;
    size_t text_count;
};

/* Finds the last %d, %6d, %06ld, ... of the file's name. */
static void find_conversion(struct png_sink *self)
{
    const char *slash = strrchr(self->pattern, '/');
    for (const char *at = slash ? slash : self->pattern; (at = strchr(at, '%')); at++) {
        const char *end = at + 1;
        bool zeros = *end == '0';
        int digits = 0;
        for (; *end >= '0' && *end <= '9' && digits <= MOST_DIGITS; end++) {
            digits = 10 * digits + (*end - '0');
        }
        end += *end == 'l';
        if (*end == 'd' && digits <= MOST_DIGITS) {
            self->before = (size_t)(at - self->pattern);
            self->after = (size_t)(end + 1 - self->pattern);
            self->zeros = zeros;
            self->digits = digits;
        }
    }
}

static char *format_path(const struct png_sink *self, long number)
{
    char *path = NULL;
    if (self->after == 0) {
        return strdup(self->pattern);
    }
    if (asprintf(&path, self->zeros ? "%.*s%0*ld%s" : "%.*s%*ld%s", (int)self->before, self->pattern,
                 self->digits, number, self->pattern + self->after) < 0) {
        return NULL;
    }
    return path;
}

static bool write_frame(void *argument, const unsigned char *rgb, long number,
                        const struct gm_png_text *texts, size_t count, char *message)
{
    const struct png_sink *self = argument;
    size_t total = self->text_count + count;
    struct gm_png_text *all = calloc(total ? total : 1, sizeof *all);
    char *path = format_path(self, number);
    bool written = false;
    if (all && path) {
        memcpy(all, self->texts, self->text_count * sizeof *all);
        for (size_t i = 0; i < count; i++) {
            all[self->text_count + i] = texts[i];
        }
        const struct gm_png image = {.width = self->width,
                                     .height = self->height,
                                     .dpi = self->dpi,
                                     .pixels = rgb,
                                     .texts = all,
                                     .text_count = total};
        written = gm_png_write(path, &image, message);
    } else {
        gm_refuse(message, "not enough memory for a frame");
    }
    free(all);
    free(path);
    return written;
}

static bool close_png(void *argument, bool keep, char *message)
{
    struct png_sink *self = argument;
    (void)keep; /* finished files stay, the others have no name yet */
    (void)message;
    gm_texts_free(self->texts, self->text_count);
    free(self->pattern);
    free(self);
    return true;
}

static int count_processors(void)
{
    cpu_set_t processors;
    return sched_getaffinity(0, sizeof processors, &processors) == 0 ? CPU_COUNT(&processors) : 1;
}

struct gm_sink *gm_sink_open_png(const char *pattern, const struct gm_sink_settings *settings, char *message)
{
    static const struct gm_sink_kind kind = {.frame = write_frame, .close = close_png};
    struct png_sink *self = calloc(1, sizeof *self);
    if (!self) {
        gm_refuse(message, "not enough memory to write frames");
        return NULL;
    }
    *self = (struct png_sink){
        .pattern = strdup(pattern),
        .width = settings->width,
        .height = settings->height,
        .dpi = settings->dpi,
        .texts = gm_texts_copy(settings->texts, settings->text_count),
        .text_count = settings->text_count,
    };
    if (!self->pattern || !self->texts) {
        close_png(self, false, message);
        gm_refuse(message, "not enough memory to write frames");
        return NULL;
    }
    find_conversion(self);
    int workers = settings->threads > 0 ? settings->threads : count_processors();
    if (self->after == 0) {
        workers = 1; /* of several frames with one name the last must win */
    }
    return gm_sink_start(&kind, self, workers < MOST_WORKERS ? workers : MOST_WORKERS,
                         (size_t)settings->width * (size_t)settings->height * 3, message);
}
