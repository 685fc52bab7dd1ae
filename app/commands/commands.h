/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_COMMANDS_H
#define GM_APP_COMMANDS_COMMANDS_H

#include "app/base/arguments.h"
#include "app/base/files.h"
#include "app/explorer/terminal/device.h"
#include "app/grid/grid.h"
#include "app/native/engine.h"
#include "app/output/frames.h"
#include "app/output/printer.h"
#include "app/output/row.h"
#include "app/words/request.h"

/* The commands, as bits: an option has the set of commands that take it. */
enum {
#define GM_COMMAND(bit, ...) bit##_NUMBER,
#include "app/commands/commands.def"
#undef GM_COMMAND
};
enum gm_command {
#define GM_COMMAND(bit, ...) bit = 1 << bit##_NUMBER,
#include "app/commands/commands.def"
#undef GM_COMMAND
    /* the commands that draw a measurement */
    GM_CHARTS = GM_WORK_PRECISION | GM_STABILITY | GM_BACKWARD | GM_SWEEP | GM_ORBIT | GM_CERTIFY,
    /* the commands that paint pixels */
    GM_PAINTS = GM_CHARTS | GM_RENDER | GM_FIGURES | GM_TOUR | GM_AGAIN | GM_TUI | GM_TERMINAL,
};

/* The --options of a command line; an option that is not given is 0, NULL or the stated default. */
struct gm_options {
    int json, state, maximum, strict, longer, quick, markdown, latex, source, listing, yes, clear, invariants;
    const char *save, *tracks, *checkpoint, *from_checkpoint;
    const char *csv, *profile, *out, *measure, *region, *judge, *changes, *on, *polish;
    const char *output; /* one picture's file; NULL: not given */
    const char *lesson; /* a page's file; NULL: not given */
    const char *tour;   /* the tour of a page; NULL: none */
    const char *painter;
    const char *format_name;
    enum gm_engine engine; /* auto, if it is not given */
    enum gm_format format; /* the pictures' format: png, unless the two options before give another one */
    const char *name;      /* the name of a chart's files, set only by `again`; NULL: the command's */
    const char *table, *retry, *join, *values, *place; /* options of sweep; the last is --at */
    struct gm_pace pace; /* frames; also --every of run, --fps of tour and --shard of sweep */
    long jobs, degree;
    double interval;               /* NAN: not given */
    struct gm_appearance look;     /* 1280 x 720, light */
    double page[2];                /* the page's size in mm, if it was given; else 0 */
    bool sized;                    /* a size was given */
    struct gm_overrides terminal;  /* the assumed abilities of the terminal */
    struct gm_arguments arguments; /* the other words: scene, key=value, names */
    struct gm_arena *arena;        /* owns the command's memory: refused memory ends the command */
    int *end;                      /* the exit status of gm_command_end */
};

/* Reads argv[first..]; the texts point into it. Returns false with a sentence. The caller closes it in
   both cases. */
bool gm_options_parse(struct gm_options *options, enum gm_command command, int argc, char *argv[], int first,
                      char *message);
void gm_options_close(void *options);

/* Returns true if two paths name one file, which need not exist yet. */
bool gm_command_same_file(const char *a, const char *b);

/* Returns true if a picture goes to standard output; nothing else may then be written there. */
bool gm_options_take_stdout(const struct gm_options *options);

/* The description of an option, from which it is read, explained and completed. */
struct gm_option {
    const char *name;  /* "--size" */
    int kind;          /* the kind of its value, for the reader */
    unsigned commands; /* the set of commands that take it */
    size_t offset;     /* the offset of its value in gm_options */
    const char *value; /* "WxH"; "" if it takes none */
    const char *help;
};
extern const struct gm_option gm_option_rows[];
extern const size_t gm_option_count;
/* The row of this command for an option, with or without its =VALUE, or else one of the same name that other
   commands have, or NULL. */
const struct gm_option *gm_option_find(const char *word, enum gm_command command);
/* The name of the option that a short one stands for, "--output" for "-o"; other words are returned. */
const char *gm_option_name(const char *word);

/* A command, from a line of commands.def: its bit, its function, which returns the exit status, and texts. */
struct gm_command_row {
    enum gm_command bit;
    int (*function)(const struct gm_options *options);
    const char *name, *synopsis, *help;
};

#define GM_COMMAND(bit, name, ...) int gm_command_##name(const struct gm_options *options);
#include "app/commands/commands.def"
#undef GM_COMMAND

/* Ends the command with an exit status and a sentence on standard error. */
__attribute__((format(printf, 3, 4))) _Noreturn void gm_command_end(const struct gm_options *options,
                                                                    int status, const char *format, ...);

/* The same if that is so. */
__attribute__((format(printf, 4, 5))) void gm_command_end_if(const struct gm_options *options, bool wrong,
                                                             int status, const char *format, ...);

extern const struct gm_command_row gm_commands[]; /* the first is the explorer */
extern const size_t gm_command_count;
/* The command of that name; for the name of a scene the explorer; or NULL. */
const struct gm_command_row *gm_command_find(const char *word);

/* The request of these words, which closes with the command; one that cannot be ends it. */
struct gm_request *gm_command_parse(const struct gm_options *options, int count, char *const words[],
                                    size_t schemes);

/* More steps than these are made if --yes confirms that. */
extern const double gm_many_steps;

/* Reports the number of steps and their time, and ends the command unless the user agrees to the run. */
void gm_command_confirm(const struct gm_options *options, const struct gm_request *request);

/* Prints a lane's note, unless it is `last`, that of the lane before (GM_MESSAGE bytes, at first ""). */
void gm_command_note(const struct gm_lane *lane, char *last);

/* "3.2 years" */
void gm_put_duration(double seconds, char *text, size_t size);

/* geomint list SYSTEM: a system's definition and its derived structure. Further words give parameters
   other values. Without a file the words are the whole system, "system H=... key=value ...". Returns the
   exit status. */
int gm_list_system(const struct gm_options *options, const struct gm_file *file);
/* Prints the structure and the parts of the scene's system, as that list has them. */
void gm_list_structure(const struct gm_options *options, const struct gm_file *file);

/* Puts "schemes" and "same_as": for every scheme with other names here, these. same[i] makes the steps of schemes[i], or is NULL. */
void gm_list_put_schemes(struct gm_row *row, const struct gm_scheme *const *schemes,
                         const struct gm_scheme *const *same, size_t count);
/* "file":"systems/toda.system","source":"..."; both are null without a file. */
void gm_list_put_file(struct gm_row *row, const struct gm_file *file, const char *source);

/* The tours, as `tour` and `list tours` print them. Returns an exit status. */
int gm_list_tours(const struct gm_options *options);

/* ---- the commands that measure ---- */

/* Writes the picture and the table of a measuring command, as its options demand, and reports them; the chart
   has its data, its functions and its default name. Returns the exit status. */
int gm_command_chart(const struct gm_options *options, const char *command, struct gm_chart *chart);

/* The whole command of a study: reads its words, measures, prints the table and writes its chart. Returns the
   exit status. */
int gm_command_study(const struct gm_options *options, enum gm_study_kind kind);

#endif
