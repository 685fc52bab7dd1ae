/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint list: scenes, schemes, figures, and what one scene takes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/drive.h"

static void print_json_text(const char *text)
{
    putchar('"');
    for (; *text; text++) {
        if (*text == '\n') {
            fputs("\\n", stdout);
        } else {
            if (*text == '"' || *text == '\\') {
                putchar('\\');
            }
            putchar(*text);
        }
    }
    putchar('"');
}

static void print_json_pair(const char *key, const char *text)
{
    printf("\"%s\":", key);
    print_json_text(text);
}

static void list_scenes(const struct gm_options *options)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        if (options->json) {
            printf("{");
            print_json_pair("scene", scene->name);
            printf(",");
            print_json_pair("title", scene->title);
            printf(",");
            print_json_pair("blurb", scene->blurb);
            printf(",");
            print_json_pair("watch", scene->watch);
            printf("}\n");
            continue;
        }
        printf("%-16s %s\n", scene->name, scene->title);
        if (options->longer) {
            printf("  %s\n  %s\n", scene->blurb, scene->watch);
        }
    }
}

static void claim_letters(const struct gm_scheme *scheme, char *letters)
{
    size_t used = 0;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            letters[used++] = gm_claim_letter(bit)[0];
        }
    }
    letters[used] = '\0';
}

static void print_formula(const char *text)
{
    while (*text) {
        const int length = (int)strcspn(text, "\n");
        printf("  %.*s\n", length, text);
        text += length + (text[length] == '\n');
    }
}

static void list_scheme(const struct gm_scheme *scheme, const struct gm_options *options)
{
    char letters[GM_CLAIM_COUNT + 1];
    claim_letters(scheme, letters);
    if (!options->json) {
        printf("%-26s %d  %-8s %s\n", scheme->name, scheme->order, letters, scheme->title);
        if (options->longer) {
            print_formula(scheme->formula);
            printf("  %s; %s\n", scheme->family->title, scheme->reference);
        }
        return;
    }
    printf("{");
    print_json_pair("scheme", scheme->name);
    printf(",");
    print_json_pair("title", scheme->title);
    printf(",\"order\":%d,", scheme->order);
    print_json_pair("family", scheme->family->title);
    printf(",\"claims\":[");
    const char *comma = "";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            printf("%s\"%s\"", comma, gm_claim_word(bit));
            comma = ",";
        }
    }
    printf("],");
    print_json_pair("formula", scheme->formula);
    printf(",");
    print_json_pair("reference", scheme->reference);
    printf("}\n");
}

static void list_figures(const struct gm_options *options)
{
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        for (size_t f = 0; f < scene->figure_count; f++) {
            const struct gm_figure *figure = &scene->figures[f];
            if (options->json) {
                printf("{");
                print_json_pair("figure", figure->name);
                printf(",");
                print_json_pair("scene", scene->name);
                printf(",");
                print_json_pair("arguments", figure->arguments);
                printf(",");
                print_json_pair("statement", figure->statement);
                printf("}\n");
            } else {
                printf("%-22s %s\n", figure->name, figure->statement);
                if (options->longer) {
                    printf("  geomint render %s %s\n", scene->name, figure->arguments);
                }
            }
        }
    }
}

static void range_text(const struct gm_parameter *row, char *text, size_t size)
{
    if (row->type == GM_TEXT) {
        snprintf(text, size, "a word");
        return;
    }
    if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
        size_t used = 0;
        text[0] = '\0';
        for (size_t i = 0; row->type == GM_CHOICE && row->choices[i] && used < size; i++) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", row->choices[i]);
        }
        if (row->type == GM_BOOLEAN) {
            snprintf(text, size, "no, yes");
        }
        return;
    }
    char low[40], high[40];
    snprintf(text, size, "%s to %s", gm_number_format(row->lowest, low, sizeof low),
             gm_number_format(row->highest, high, sizeof high));
}

static void list_parameter(const struct gm_parameter *row, bool json, const char *comma)
{
    char range[128];
    range_text(row, range, sizeof range);
    if (!json) {
        printf("  %-14s %-12s %-24s %s%s%s\n", row->key, row->standard, range, row->help,
               row->unit[0] ? ", in " : "", row->unit);
        return;
    }
    printf("%s{", comma);
    print_json_pair("key", row->key);
    printf(",");
    print_json_pair("default", row->standard);
    printf(",");
    print_json_pair("range", range);
    printf(",\"live\":%s,", row->live ? "true" : "false");
    print_json_pair("help", row->help);
    printf("}");
}

static void list_scene(const struct gm_scene *scene, const struct gm_options *options)
{
    void *standard = calloc(1, scene->size);
    if (!standard) {
        return;
    }
    gm_parameters_reset(scene->parameters, scene->parameter_count, standard);
    if (options->json) {
        printf("{");
        print_json_pair("scene", scene->name);
        printf(",");
        print_json_pair("title", scene->title);
        printf(",");
        print_json_pair("watch", scene->watch);
        printf(",\"parameters\":[");
    } else {
        printf("%s\n%s\n%s\n\nparameter        default      range                    meaning\n", scene->title,
               scene->blurb, scene->watch);
    }
    for (size_t i = 0; i < scene->parameter_count; i++) {
        list_parameter(&scene->parameters[i], options->json, i ? "," : "");
    }
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        list_parameter(&gm_settings_parameters[i], options->json, ",");
    }
    printf(options->json ? "],\"observables\":[" : "\nobservables\n");
    for (size_t i = 0; i < scene->observable_count; i++) {
        printf(options->json ? "%s\"%s\"" : "%s%s",
               i               ? (options->json ? "," : ", ")
               : options->json ? ""
                               : "  ",
               scene->observables[i].key);
    }
    printf(options->json ? "],\"schemes\":[" : "\n\nschemes that fit           order claims\n");
    const char *comma = "";
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        if (!gm_scene_fits(scene, standard, gm_scheme_at(i))) {
            continue;
        }
        if (options->json) {
            printf("%s\"%s\"", comma, gm_scheme_at(i)->name);
            comma = ",";
        } else {
            list_scheme(gm_scheme_at(i), options);
        }
    }
    printf(options->json ? "]}\n" : "");
    free(standard);
}

int gm_command_list(const struct gm_options *options)
{
    if (options->word_count > 1) {
        gm_complain("list takes one name: scenes, schemes, figures or a scene");
        return GM_EXIT_USAGE;
    }
    const char *what = options->word_count ? options->words[0] : "scenes";
    if (strcmp(what, "scenes") == 0) {
        list_scenes(options);
    } else if (strcmp(what, "schemes") == 0) {
        for (size_t i = 0; i < gm_scheme_count(); i++) {
            list_scheme(gm_scheme_at(i), options);
        }
    } else if (strcmp(what, "figures") == 0) {
        list_figures(options);
    } else if (gm_scene_find(what)) {
        list_scene(gm_scene_find(what), options);
    } else {
        gm_complain("list knows scenes, schemes, figures and the names of scenes, not \"%.60s\"", what);
        return GM_EXIT_USAGE;
    }
    return gm_finish(GM_EXIT_OK);
}
