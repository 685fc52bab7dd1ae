/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint manual: the page geomint(1), in the macros of man(7). */
#include <stdio.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/commands/reference/reference.h"
#include "app/words/words.h"
#include "core/aliases.h"
#include "core/basics.h"
#include "core/schemes.h"

/* Writes text for troff: no request at the start of a line, hyphens that can be copied. */
static void put(const char *text)
{
    printf("%s", *text == '.' || *text == '\'' ? "\\&" : "");
    for (; *text; text++) {
        if (*text == '\\' || *text == '-') {
            printf("%s", *text == '-' ? "\\-" : "\\e");
        } else {
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

static void put_commands(void)
{
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

static void put_claims(void)
{
    char text[512];
    putchar(' ');
    put(gm_catalogue_claims((1U << GM_CLAIM_COUNT) - 1, true, text, sizeof text));
}

static void put_schemes(void)
{
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

static void put_keys(void)
{
    for (size_t i = 0; i < gm_common_key_count; i++) {
        char name[40];
        snprintf(name, sizeof name, "%s=", gm_common_keys[i].name);
        put_term(name, gm_common_keys[i].value, gm_common_keys[i].help);
    }
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        put_parameter(&gm_settings_parameters[i]);
    }
}

static void put_synopsis(void)
{
    for (size_t i = 0; i < gm_command_count; i++) {
        printf("%s.B geomint%s", i ? ".br\n" : "", i ? " " : "");
        put_line(i ? gm_commands[i].name : "");
        if (gm_commands[i].synopsis[0]) {
            printf(".I ");
            put_line(gm_commands[i].synopsis);
        }
    }
}

static void put_version(void)
{
    printf("%s", GM_VERSION);
}

int gm_command_manual(const struct gm_options *options)
{
    static const struct {
        const char *slot;
        void (*put)(void);
    } parts[] = {{"version", put_version}, {"synopsis", put_synopsis}, {"commands", put_commands},
                 {"keys", put_keys},       {"scenes", put_scenes},     {"claims", put_claims},
                 {"schemes", put_schemes}};
    gm_command_end_if(options, options->arguments.count > 0, GM_EXIT_USAGE, "manual takes no arguments");
    char slot[GM_PAGE_SLOT];
    for (const char *text = gm_page_text("geomint"); gm_page_next(stdout, &text, slot);) {
        for (size_t i = 0; i < GM_COUNT(parts); i++) {
            if (strcmp(parts[i].slot, slot) == 0) {
                parts[i].put();
            }
        }
    }
    return GM_EXIT_OK;
}
