/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The --options of a command line. */
#ifndef GM_APP_COMMANDS_OPTIONS_H
#define GM_APP_COMMANDS_OPTIONS_H

#include "app/base/arguments.h"
#include "app/native/engine.h"
#include "app/output/printer.h"
#include "app/words/request.h"

/* The commands, as bits: an option says which of them take it. */
enum gm_command {
    GM_TUI = 1 << 0,
    GM_LIST = 1 << 1,
    GM_RUN = 1 << 2,
    GM_RENDER = 1 << 3,
    GM_FIGURES = 1 << 4,
    GM_CERTIFY = 1 << 5,
    GM_AGAIN = 1 << 6,
    GM_TERMINAL = 1 << 7,
    GM_WORK_PRECISION = 1 << 8,
    GM_STABILITY = 1 << 9,
    GM_TOUR = 1 << 10,
    GM_SWEEP = 1 << 11,
    GM_BACKWARD = 1 << 12,
    GM_CACHE = 1 << 13,
    GM_MANUAL = 1 << 29,
    GM_COMPLETE = 1 << 30,
    /* those that draw what they measured */
    GM_CHARTS = GM_WORK_PRECISION | GM_STABILITY | GM_BACKWARD | GM_SWEEP | GM_CERTIFY,
    /* those that paint pixels */
    GM_PAINTS = GM_CHARTS | GM_RENDER | GM_FIGURES | GM_TOUR | GM_AGAIN | GM_TUI | GM_TERMINAL,
};

/* The --options of a command line; what is not given is 0, NULL or as said. */
struct gm_options {
    int json, state, maximum, strict, longer, quick, markdown, latex, source, listing, yes, clear;
    const char *save, *tracks, *checkpoint, *from_checkpoint;
    const char *csv, *profile, *out, *movie, *measure, *region, *judge, *changes, *on, *polish;
    const char *output; /* one picture's file; NULL: not given */
    const char *painter;
    const char *format_name;
    enum gm_engine engine;            /* auto, if it is not given */
    enum gm_format format;            /* of pictures: png, unless the two before say otherwise */
    const char *name;                 /* of a chart's files, by `again` alone; NULL: the command's own */
    const char *table, *retry, *join; /* of sweep */
    long every, frames, jobs;
    long shard, shards;                     /* 0, 0: not given */
    double fps, rate;                       /* NAN: not given */
    double from, at, interval;              /* NAN: not given */
    struct gm_appearance look;              /* 1280 x 720, light */
    double page[2];                         /* its size in mm, where that was given; else 0 */
    bool sized;                             /* a size was given */
    const char *graphics, *colours, *shade; /* what to believe of the terminal */
    struct gm_arguments arguments;          /* what is left: scene, key=value, names */
};

/* Reads argv[first..]; the texts point into it. False with a sentence. To be closed in
   both cases. */
bool gm_options_parse(struct gm_options *options, enum gm_command command, int argc, char *argv[], int first,
                      char *message);
void gm_options_close(struct gm_options *options);

/* Whether a picture goes to standard output, and nothing else may. */
bool gm_options_take_stdout(const struct gm_options *options);

/* What is known of an option. */
struct gm_option {
    const char *name;  /* "--size" */
    const char *value; /* "WxH"; "" if it takes none */
    const char *help;
    unsigned commands; /* those that take it */
};
/* The name of the option that a short one stands for, "--output" for "-o"; other words are returned. */
const char *gm_option_name(const char *word);
size_t gm_option_count(void);
struct gm_option gm_option_at(size_t index);

/* Writes the options of a command for --help. */
void gm_options_help(enum gm_command command);

#endif
