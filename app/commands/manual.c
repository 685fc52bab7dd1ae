/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint manual: the page geomint(1), in the macros of man(7). */
#include <stdio.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/commands/reference/reference.h"
#include "app/output/say.h"
#include "app/words/words.h"
#include "core/aliases.h"
#include "core/basics.h"
#include "core/schemes.h"

/* Writes text for troff: no request at the start of a line, hyphens that can be copied. */
static void put(const char *text)
{
    if (*text == '.' || *text == '\'') {
        printf("\\&");
    }
    for (; *text; text++) {
        switch (*text) {
        case '\\':
            printf("\\e");
            break;
        case '-':
            printf("\\-");
            break;
        default:
            putchar(*text);
        }
    }
}

static void put_line(const char *text)
{
    put(text);
    putchar('\n');
}

/* A tagged paragraph: a term in bold, the rest of it in italics, then text unless it is NULL. */
static void put_term(const char *term, const char *rest, const char *text)
{
    printf(".TP\n\\fB");
    put(term);
    printf("\\fR");
    if (*rest) {
        printf(" \\fI");
        put(rest);
        printf("\\fR");
    }
    putchar('\n');
    if (text) {
        put_line(text);
    }
}

static void put_terms(const char *heading, const char *const terms[][2], size_t count)
{
    printf(".SH %s\n", heading);
    for (size_t i = 0; i < count; i++) {
        put_term(terms[i][0], "", terms[i][1]);
    }
}

static void put_commands(void)
{
    printf(".SH COMMANDS\n");
    for (size_t i = 0; i < gm_command_count; i++) {
        put_term(gm_commands[i].name, gm_commands[i].synopsis, gm_commands[i].help);
        size_t options = 0;
        for (size_t k = 0; k < gm_option_count; k++) {
            const struct gm_option *option = &gm_option_rows[k];
            if (option->commands & gm_commands[i].bit) {
                printf("%s", options++ ? "" : ".RS\n");
                put_term(option->name, option->value, option->help);
            }
        }
        printf("%s", options ? ".RE\n" : "");
    }
    put_term("--help, -h", "",
             "the commands; after a command, its options; with --all, the options of all commands");
    put_term("--version, -V", "", "version and libraries");
}

static void put_parameter(const struct gm_parameter *row)
{
    char range[256], term[160], text[512];
    snprintf(term, sizeof term, "%s=%s", row->key, row->standard);
    snprintf(text, sizeof text, "%s (%s)%s%s", row->help, gm_catalogue_range(row, range, sizeof range),
             row->unit[0] ? ", in " : "", row->unit);
    put_term(term, "", text);
}

static void put_scenes(void)
{
    printf(".SH SCENES\nEach with its parameters at their defaults, and what they may be.\n");
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        printf(".SS ");
        put_line(scene->name);
        put(scene->title);
        printf(". ");
        put_line(scene->blurb);
        printf(".PP\nObservables:");
        const struct gm_observable *observable;
        for (size_t k = 0; (observable = gm_scene_observable_at(scene, k)) != NULL; k++) {
            printf(k == scene->observable_count ? "; when asked for: " : k ? ", " : " ");
            put(observable->key);
        }
        printf(".\n");
        for (size_t k = 0; k < scene->parameter_count; k++) {
            put_parameter(&scene->parameters[k]);
        }
    }
}

static void put_schemes(void)
{
    printf(".SH SCHEMES\nWith order and claims:");
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        printf("%s %s ", bit ? "," : "", gm_claim_letter(bit));
        put(gm_claim_word(bit));
    }
    printf(".\n");
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        char letters[GM_CLAIM_COUNT + 1];
        gm_catalogue_letters(scheme, letters);
        put_term(scheme->name, "", NULL);
        put(scheme->title);
        if (scheme->order > 0) {
            printf(", order %d", scheme->order);
        }
        printf("%s", letters[0] ? ", " : "");
        put(letters);
        const char *alias;
        for (size_t k = 0; (alias = gm_alias_of(scheme->name, k)); k++) {
            printf("%s", k == 0 ? "; also called " : ", ");
            put(alias);
        }
        printf("\n");
    }
}

static void put_words(void)
{
    printf(
        ".SH PARAMETERS\n"
        "Every parameter is a word key=value, and every key takes a list: lanes are the product of the lists, the "
        "first of them gives the panels, the second the colours. Numbers are typed as 1e\\-3, pi/60, 2*pi. A "
        "list may hold ranges: 0..0.9:10 is ten values evenly, both ends among them, 1e\\-4..1e\\-1:log7 seven by "
        "equal factors. An unknown key or a value out of range is refused with the nearest valid one.\n");
    for (size_t i = 0; i < gm_common_key_count; i++) {
        char name[40];
        snprintf(name, sizeof name, "%s=", gm_common_keys[i].name);
        put_term(name, gm_common_keys[i].value, gm_common_keys[i].help);
    }
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        put_parameter(&gm_settings_parameters[i]);
    }
}

static void put_surroundings(void)
{
    static const char *const exits[][2] = {
        {"0", "done"},
        {"1", "wrong usage"},
        {"2",
         "a lane of run (of render with --strict) ended in a numerical failure; its numbers are printed; "
         "with --strict also a lane of run that ended with a warning"},
        {"3", "a file could not be read or written"},
        {"4", "a claim of certify is broken"},
        {"5", "not enough memory; the status of such a lane is out-of-memory"},
        {"130", "interrupted; what is finished stays"},
        {"141", "a broken pipe"},
    };
    static const char *const environment[][2] = {
        {"GEOMINT_PAINTER", "auto, osmesa, egl or own: what paints pixels, where --painter does not say it"},
        {"GEOMINT_COLOURS", "truecolor, 256, 16 or none, whatever the terminal says"},
        {"GEOMINT_GRAPHICS",
         "kitty, sixel, braille, quadrants, half or ascii: what pictures in the terminal are made of"},
        {"GEOMINT_THEME", "light, dark or mono, in the terminal"},
        {"GEOMINT_TOURS", "a folder with tours, beside those of the program"},
        {"GEOMINT_SYSTEMS", "a folder with systems, beside those of the program"},
        {"GEOMINT_ROOMS", "a folder with rooms, beside those of the program"},
        {"GEOMINT_SCHEMES", "a folder with schemes, beside those of the program"},
        {"GEOMINT_KERNEL", "a folder with the sources of loops, instead of the installed one"},
        {"GEOMINT_COMPILER_SECONDS", "seconds of a processor that the compiler of loops may take (10)"},
        {"XDG_CACHE_HOME", "the parent of the folder geomint with compiled code, instead of ~/.cache"},
        {"NO_COLOR", "if it is not empty, the explorer uses no colour"},
    };
    put_terms("EXIT STATUS", exits, GM_COUNT(exits));
    put_terms("ENVIRONMENT", environment, GM_COUNT(environment));
}

static void put_examples(void)
{
    static const char *const examples[][2] = {
        {"geomint run disc scheme=explicit-euler dt=0.02 until=5", "numbers of one run"},
        {"geomint render kepler scheme=rk4,verlet --movie kepler.mp4", "a movie of two schemes side by side"},
        {"geomint render kepler --size 16x9cm -o kepler.pdf", "a figure for a paper"},
        {"geomint work-precision kepler --out diagrams", "error against cost, of every scheme that fits"},
        {"geomint figures tyranowski-11 --out published", "a published figure with its numbers"},
    };
    put_terms("EXAMPLES", examples, GM_COUNT(examples));
    printf(".SH SEE ALSO\n.BR ffmpeg (1),\n.BR gmsh (1)\n");
}

int gm_command_manual(const struct gm_options *options)
{
    if (options->arguments.count > 0) {
        return gm_give_up(GM_EXIT_USAGE, "manual takes no arguments");
    }
    printf(".TH GEOMINT 1 \"\" \"geomint %s\" \"User commands\"\n.SH NAME\ngeomint \\- see what a geometric "
           "integrator keeps and what an ordinary one destroys\n.SH SYNOPSIS\n",
           GM_VERSION);
    for (size_t i = 0; i < gm_command_count; i++) {
        printf("%s.B geomint%s", i ? ".br\n" : "", i ? " " : "");
        put_line(i ? gm_commands[i].name : "");
        if (gm_commands[i].synopsis[0]) {
            printf(".I ");
            put_line(gm_commands[i].synopsis);
        }
    }
    printf(
        ".SH DESCRIPTION\nShows and measures geometric integrators: live in a terminal, or as pictures and movies "
        "made on a machine without a screen. Every scheme comes with its error, its cost and its stability, "
        "measured.\n");
    put_commands();
    put_words();
    put_surroundings();
    put_examples();
    put_scenes();
    put_schemes();
    return gm_finish(GM_EXIT_OK);
}
