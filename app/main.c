/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint: the first word is the command, or a scene for the explorer. The exit status is the command's,
   or GM_EXIT_MEMORY. */
#include <locale.h>
#include <malloc.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/commands/reference/reference.h"
#include "app/native/cache.h"
#include "app/output/say.h"
#include "app/words/names.h"
#include "core/aliases.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/memory.h"
#include "render/address_space.h"
#include "render/gl/context.h"
#include "render/pixels/canvas.h"

/* Returns candidate i for the first word, a command or a scene. */
static const char *first_word(size_t i, const void *data)
{
    (void)data;
    return i < gm_command_count ? gm_commands[i].name : gm_scene_name(i - gm_command_count);
}

/* Returns true if the word is one of a NULL-terminated list. */
static bool is_one_of(const char *word, const char *const *words)
{
    while (*words && strcmp(*words, word) != 0) {
        words++;
    }
    return *words != NULL;
}

static void help_command(const struct gm_command_row *command)
{
    enum { OPTION = 28 };
    gm_print_wrapped(command->synopsis, printf("geomint %s ", command->name), 4);
    gm_print_wrapped(command->help, printf("  "), 2);
    for (size_t i = 0; i < gm_option_count; i++) {
        const struct gm_option *option = &gm_option_rows[i];
        if (option->commands & command->bit) {
            gm_print_wrapped(option->help, printf("  %s %s  ", option->name, option->value), OPTION);
        }
    }
}

/* Lines that do not go to a terminal are as wide as an ordinary one, unless COLUMNS gives the width. */
static void set_width(void)
{
    if (!isatty(STDOUT_FILENO)) {
        setenv("COLUMNS", "80", 0);
    }
}

static int help_of(const struct gm_command_row *command)
{
    set_width();
    help_command(command);
    return gm_finish(GM_EXIT_OK);
}

/* Reports an unknown first word, with what it probably means: a command, a scene, or scenes that contain it. */
static int unknown_command(const char *word)
{
    char near[GM_NEAR_NAMES] = "", folder[GM_MESSAGE];
    const struct gm_near *row;
    for (size_t i = 0; (row = gm_near_find(GM_NEAR_COMMAND, word, i)); i++) {
        gm_append(near, sizeof near, "%s%s", i > 0 ? " or " : "", row->meant);
    }
    const char *nearest = gm_nearest(word, gm_command_count + gm_scene_count(), first_word, NULL);
    if (!near[0] && nearest) {
        snprintf(near, sizeof near, "%s", nearest);
    } else if (!near[0]) {
        gm_system_near(word, near, folder);
    }
    return gm_give_up(GM_EXIT_USAGE, "there is no command or scene \"%.60s\"%s%s", word,
                      near[0] ? "; did you mean " : "; see geomint --help", near);
}

/* `all`: with the options of every command. */
static int help(bool all)
{
    enum { COMMAND = 18 };
    static const char *const notes[] = {
        "geomint COMMAND --help explains the options of a command, geomint --help --all those of all commands.",
        ("key=value sets a parameter (geomint list SCENE shows them), and scheme=a,b,c the schemes. Every key takes "
         "a list. The lanes are the product of the lists; zip=yes pairs them, and overlay=yes draws all lanes in "
         "one panel. Numbers are typed as 1e-3 or pi/60. Ranges are 0..0.9:10, or 1e-4..1e-1:log7 by equal factors."),
        ("Exit status: 0 done, 1 wrong usage, 2 numerical failure, 3 a file, 4 a broken claim, 5 not enough memory, "
         "130 interrupted.")};
    set_width();
    gm_print_wrapped("see what a geometric integrator conserves and what an ordinary one destroys",
                     printf("geomint %s: ", GM_VERSION), 2);
    printf("\n");
    for (size_t i = 0; i < gm_command_count; i++) {
        if (all) {
            help_command(&gm_commands[i]);
        } else {
            gm_print_wrapped(gm_commands[i].help, printf("  %s ", gm_commands[i].name), COMMAND);
        }
    }
    gm_print_wrapped("version and libraries", printf("  --version, -V "), COMMAND);
    for (size_t i = 0; i < GM_COUNT(notes); i++) {
        printf("\n");
        gm_print_wrapped(notes[i], 0, 0);
    }
    return gm_finish(GM_EXIT_OK);
}

static void tell(const char *sentence)
{
    gm_complain("%s", sentence);
}

static bool is_interrupted(void)
{
    return gm_interrupted;
}

/* A movie needs the same buffers for every frame. The process retains freed memory, up to a few frames'
   worth: fetching it from the system page by page takes a seventh of a frame's time. The first 31 MB use
   huge pages if the system has them: pages of 4 KB cost a sixth of the time of one picture. What paints nothing uses
   them after `small` bytes: a short run needs less, and one huge page costs it more than all of its own. */
static void keep_buffers(size_t small)
{
    static const size_t huge = (size_t)2 << 20, room = (size_t)31 << 20;
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
    /* the end of the heap, to which the block is freed */
    void *block = gm_address_space_is_limited() ? NULL : malloc(room);
    if (block) {
        const uintptr_t first = ((uintptr_t)block + small + huge - 1) / huge * huge;
        madvise((void *)first, ((uintptr_t)block + room - first) / huge * huge, MADV_HUGEPAGE);
        free(block);
    } else {
        gm_memory_forget(); /* the block only saves time, so its failure is not a shortage */
    }
}

/* A command, its options and its exit status, passed to the body of the arena. */
struct running {
    const struct gm_command_row *command;
    struct gm_options options;
    int status;
};

static void obey(struct gm_arena *arena, void *data)
{
    struct running *running = data;
    running->options.arena = arena;
    running->options.end = &running->status;
    running->status = gm_finish(running->command->function(&running->options));
}

static int run(int argc, char *argv[])
{
    setlocale(LC_CTYPE, "");
    /* the writers handle a broken pipe and a full disk */
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    gm_context_answer_crashes();
    const struct gm_command_row *command = &gm_commands[0];
    int first = 1;
    if (argc > 1) {
        if (is_one_of(argv[1], (const char *const[]){"--help", "-h", "help", NULL})) {
            const bool all = argc == 3 && strcmp(argv[2], "--all") == 0;
            if (argc == 2 || all) {
                return help(all);
            }
            command = gm_command_find(argv[2]);
            return command ? help_of(command) : unknown_command(argv[2]);
        }
        if (is_one_of(argv[1], (const char *const[]){"--version", "-V", "version", NULL})) {
            return gm_version();
        }
        const bool option = argv[1][0] == '-'; /* an option of the explorer */
        command = option ? command : gm_command_find(argv[1]);
        if (!command) {
            return unknown_command(argv[1]);
        }
        /* a scene's name opens the explorer as its first word */
        first = !option && strcmp(command->name, argv[1]) == 0 ? 2 : 1;
    }
    for (int i = first; i < argc && command->bit != GM_COMPLETE; i++) {
        if (is_one_of(argv[i], (const char *const[]){"--help", "-h", NULL})) {
            return help_of(command);
        }
    }
    keep_buffers(command->bit & GM_PAINTS ? 0 : (size_t)1 << 20);
    char message[GM_MESSAGE];
    struct running running = {.command = command, .status = GM_EXIT_USAGE};
    struct gm_options *options = &running.options;
    if (gm_options_parse(options, command->bit, argc, argv, first, message) &&
        (!(command->bit & GM_PAINTS) || gm_canvas_choose(options->painter, message))) {
        char kernels[4096];
        gm_kernel_folder(kernels, sizeof kernels);
        gm_engine_choose(options->engine, kernels, command->bit == GM_TUI ? NULL : tell, is_interrupted);
        if (!(command->bit & (GM_TUI | GM_TERMINAL | GM_TOUR))) { /* those give the terminal back first */
            gm_interrupts_end_reading();
        }
        struct gm_arena *arena = gm_arena_open();
        running.status = GM_EXIT_MEMORY; /* unless the command sets it */
        if (!gm_arena_run(arena, obey, &running)) {
            gm_complain("%s", gm_arena_reason(arena));
        }
        gm_arena_close(arena);
        gm_canvas_settle();
    } else {
        gm_complain("%s", message);
    }
    gm_options_close(options);
    return running.status;
}

int main(int argc, char *argv[])
{
    const int status = run(argc, argv);
    /* a shortage may have been reported as a mistake in the request, or have reduced the result */
    if (!gm_memory_was_short() || status == GM_EXIT_INTERRUPTED || status == GM_EXIT_PIPE) {
        return status;
    }
    if (!gm_complained_of_memory()) {
        gm_complain("there was not enough memory for all that was asked for");
    }
    return GM_EXIT_MEMORY;
}
