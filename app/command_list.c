/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint list: scenes, schemes, figures, and what one scene takes. */
#include <stdio.h>
#include <string.h>

#include "app/catalogue.h"
#include "app/commands.h"
#include "app/drive.h"
#include "app/json.h"

static void list_scenes(const struct gm_options *options)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        if (options->json) {
            printf("{");
            gm_json_pair("scene", scene->name);
            printf(",");
            gm_json_pair("title", scene->title);
            printf(",");
            gm_json_pair("blurb", scene->blurb);
            printf(",");
            gm_json_pair("watch", scene->watch);
            printf("}\n");
            continue;
        }
        printf("%-16s %s\n", scene->name, scene->title);
        if (options->longer) {
            printf("  %s\n  %s\n", scene->blurb, scene->watch);
        }
    }
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
    gm_catalogue_letters(scheme, letters);
    if (!options->json) {
        printf("%-26s %d  %-8s %s\n", scheme->name, scheme->order, letters, scheme->title);
        if (options->longer) {
            print_formula(scheme->formula);
            printf("  %s; %s\n", scheme->family->title, scheme->reference);
        }
        return;
    }
    printf("{");
    gm_json_pair("scheme", scheme->name);
    printf(",");
    gm_json_pair("title", scheme->title);
    printf(",\"order\":%d,", scheme->order);
    gm_json_pair("family", scheme->family->title);
    printf(",\"claims\":[");
    const char *comma = "";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            printf("%s\"%s\"", comma, gm_claim_word(bit));
            comma = ",";
        }
    }
    printf("],");
    gm_json_pair("formula", scheme->formula);
    printf(",");
    gm_json_pair("reference", scheme->reference);
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
                gm_json_pair("figure", figure->name);
                printf(",");
                gm_json_pair("scene", scene->name);
                printf(",");
                gm_json_pair("arguments", figure->arguments);
                printf(",");
                gm_json_pair("statement", figure->statement);
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

static void list_parameter(const struct gm_parameter *row, bool json, const char *comma)
{
    char range[128];
    gm_catalogue_range(row, range, sizeof range);
    if (!json) {
        printf("  %-14s %-12s %-24s %s%s%s\n", row->key, row->standard, range, row->help,
               row->unit[0] ? ", in " : "", row->unit);
        return;
    }
    printf("%s{", comma);
    gm_json_pair("key", row->key);
    printf(",");
    gm_json_pair("default", row->standard);
    printf(",");
    gm_json_pair("range", range);
    printf(",\"live\":%s,", row->live ? "true" : "false");
    gm_json_pair("help", row->help);
    printf("}");
}

static void list_scene(const struct gm_scene *scene, const struct gm_options *options)
{
    const struct gm_scheme *fitting[GM_CATALOGUE_SCHEMES];
    const size_t count = gm_catalogue_fitting(scene, fitting);
    if (options->json) {
        printf("{");
        gm_json_pair("scene", scene->name);
        printf(",");
        gm_json_pair("title", scene->title);
        printf(",");
        gm_json_pair("watch", scene->watch);
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
    for (size_t i = 0; i < count; i++) {
        if (options->json) {
            printf("%s\"%s\"", i ? "," : "", fitting[i]->name);
        } else {
            list_scheme(fitting[i], options);
        }
    }
    printf(options->json ? "]}\n" : "");
}

static int list_markdown(const char *what)
{
    if (strcmp(what, "scenes") == 0) {
        gm_catalogue_scenes_markdown();
    } else if (strcmp(what, "schemes") == 0) {
        gm_catalogue_schemes_markdown();
    } else {
        gm_complain("--markdown lists scenes or schemes");
        return GM_EXIT_USAGE;
    }
    return gm_finish(GM_EXIT_OK);
}

int gm_command_list(const struct gm_options *options)
{
    if (options->word_count > 1) {
        gm_complain("list takes one name: scenes, schemes, figures or a scene");
        return GM_EXIT_USAGE;
    }
    const char *what = options->word_count ? options->words[0] : "scenes";
    if (options->markdown) {
        return list_markdown(what);
    }
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
