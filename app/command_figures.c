/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint figures: published figures made again, with our numbers beside them. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "app/commands.h"
#include "app/drive.h"

enum { MOST_WORDS = 64, QUICK_STEPS = 50 };

static bool chosen(const struct gm_options *options, const char *name)
{
    for (int i = 0; i < options->word_count; i++) {
        if (strcmp(options->words[i], name) == 0) {
            return true;
        }
    }
    return options->word_count == 0;
}

static bool exists(const char *name)
{
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        for (size_t f = 0; f < scene->figure_count; f++) {
            if (strcmp(scene->figures[f].name, name) == 0) {
                return true;
            }
        }
    }
    return false;
}

/* The observables at the end of every lane, under the document's statement. */
static bool print_numbers(const struct gm_request *request, const struct gm_figure *figure, char *message)
{
    const struct gm_scene *scene = request->scene;
    printf("%s: %s\n  geomint render %s %s\n", figure->name, figure->statement, scene->name,
           figure->arguments);
    printf("  %-26s %-12s %10s", "scheme", "", "t");
    for (size_t i = 0; i < scene->observable_count; i++) {
        printf(" %14s", scene->observables[i].key);
    }
    printf("\n");
    for (size_t i = 0; i < request->count; i++) {
        struct gm_lane *lane = gm_request_open_lane(request, i, message);
        struct gm_drive drive = {.lane = lane, .request = request, .index = i};
        if (!lane || !gm_drive_to(&drive, request->lanes[i].steps, false, message)) {
            gm_lane_close(lane);
            return false;
        }
        printf("  %-26s %-12s %10.4g", lane->scheme->name, lane->shown.colour_name, lane->run->t);
        for (size_t k = 0; k < scene->observable_count; k++) {
            printf(" %14.6g", gm_lane_observe(lane, k));
        }
        printf("\n");
        gm_lane_close(lane);
    }
    return true;
}

static int make_figure(const struct gm_scene *scene, const struct gm_figure *figure,
                       const struct gm_options *options)
{
    char arguments[512], message[GM_MESSAGE];
    char *words[MOST_WORDS] = {(char *)(uintptr_t)scene->name}, *rest = NULL;
    int count = 1;
    snprintf(arguments, sizeof arguments, "%s", figure->arguments);
    for (char *word = strtok_r(arguments, " ", &rest); word && count < MOST_WORDS;
         word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    struct gm_request request;
    if (!gm_request_parse(&request, count, words, 3, message)) {
        gm_complain("%s: %s", figure->name, message);
        return GM_EXIT_USAGE;
    }
    for (size_t i = 0; options->quick && i < request.count; i++) {
        request.lanes[i].steps = request.lanes[i].steps < QUICK_STEPS ? request.lanes[i].steps : QUICK_STEPS;
    }
    int status = gm_render(&request, options, figure->name);
    if (status == GM_EXIT_OK && !print_numbers(&request, figure, message)) {
        gm_complain("%s: %s", figure->name, message);
        status = GM_EXIT_USAGE;
    }
    gm_request_close(&request);
    return status;
}

int gm_command_figures(const struct gm_options *options)
{
    for (int i = 0; i < options->word_count; i++) {
        if (!exists(options->words[i])) {
            gm_complain("there is no figure \"%.60s\"; geomint list figures names them", options->words[i]);
            return GM_EXIT_USAGE;
        }
    }
    gm_catch_interrupts();
    struct gm_options each = *options;
    if (options->quick) {
        each.width = 640;
        each.height = 360;
    }
    int status = GM_EXIT_OK;
    for (size_t s = 0; s < gm_scene_count() && status == GM_EXIT_OK; s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        for (size_t f = 0; f < scene->figure_count && status == GM_EXIT_OK; f++) {
            if (chosen(options, scene->figures[f].name)) {
                status = make_figure(scene, &scene->figures[f], &each);
            }
        }
    }
    return gm_finish(status);
}
