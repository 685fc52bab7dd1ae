/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a picture tells of itself: the command, the changes in flight, the steps, the failures. */
#include "app/output/provenance.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/drive.h"

static bool take(struct gm_provenance *provenance, const char *key, char *text)
{
    if (!text) {
        return false;
    }
    provenance->owned[provenance->count] = text;
    provenance->texts[provenance->count++] = (struct gm_png_text){key, text};
    return true;
}

__attribute__((format(printf, 1, 2))) static char *format(const char *pattern, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, pattern);
    const int length = vasprintf(&text, pattern, arguments);
    va_end(arguments);
    return length < 0 ? NULL : text;
}

static char *scheme_names(const struct gm_request *request)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    for (size_t i = 0; i < request->count; i++) {
        fprintf(stream, "%s%s", i ? " " : "", request->lanes[i].scheme->name);
    }
    fclose(stream);
    return text;
}

/* Every parameter of every lane, a line each. */
static char *all_parameters(const struct gm_request *request)
{
    char *text = NULL, value[GM_TEXT_SIZE];
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    const struct gm_scene *scene = request->scene;
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        fprintf(stream, "scheme=%s", spec->scheme->name);
        for (size_t k = 0; k < scene->parameter_count; k++) {
            if (!gm_scene_idle(scene, spec->parameters, scene->parameters[k].key)) {
                fprintf(stream, " %s=%s", scene->parameters[k].key,
                        gm_parameter_format(&scene->parameters[k], spec->parameters, value, sizeof value));
            }
        }
        for (const struct gm_parameter *const *row = spec->scheme->family->parameters; row && *row; row++) {
            fprintf(stream, " %s=%s", (*row)->key,
                    gm_parameter_format(*row, &spec->settings, value, sizeof value));
        }
        fputc('\n', stream);
    }
    fclose(stream);
    return text;
}

static const char *theme_name(const struct gm_appearance *look)
{
    return look->theme == GM_THEME_DARK ? "dark" : "light";
}

/* Whether the look has another scale of letters and lines than that of most. */
static bool is_scaled(const struct gm_appearance *look)
{
    return look->scale > 0 && look->scale != 1;
}

/* What of the look is not as it mostly is. */
static bool take_look(struct gm_provenance *provenance, const struct gm_appearance *look)
{
    return (!is_scaled(look) || take(provenance, GM_KEY_SCALE, format("%.17g", look->scale))) &&
           (!(look->dpi > 0) || take(provenance, GM_KEY_DPI, format("%.17g", look->dpi))) &&
           (!(look->page_width > 0) ||
            take(provenance, GM_KEY_PAGE, format("%.17gx%.17g", look->page_width, look->page_height))) &&
           (!look->title || take(provenance, GM_KEY_TITLE, format("%s", look->title)));
}

bool gm_provenance_make(struct gm_provenance *provenance, const struct gm_request *request,
                        const struct gm_appearance *look, const char *backend)
{
    *provenance = (struct gm_provenance){0};
    const bool good =
        take(provenance, "Title", format("%s", request->scene->title)) &&
        take(provenance, "Software", format("geomint %s", GM_VERSION)) &&
        take(provenance, "geomint:scene", format("%s", request->scene->name)) &&
        take(provenance, "geomint:schemes", scheme_names(request)) &&
        take(provenance, "geomint:parameters", all_parameters(request)) &&
        take(provenance, GM_KEY_ARGUMENTS, gm_request_format(request)) &&
        take(provenance, GM_KEY_CHANGES, gm_changes_format(request)) &&
        take(provenance, GM_KEY_PICTURE, format("%dx%d %s", look->width, look->height, theme_name(look))) &&
        take_look(provenance, look) &&
        (!request->scene->source || take(provenance, GM_KEY_SYSTEM, format("%s", request->scene->source))) &&
        (!request->scene->room || take(provenance, GM_KEY_ROOM, format("%s", request->scene->mark))) &&
        take(provenance, GM_KEY_PAINTER, format("%s", backend));
    if (!good) {
        gm_provenance_close(provenance);
    }
    return good;
}

/* The options of a look, each with a blank before it. */
static char *look_options(const struct gm_appearance *look)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    if (look->page_width > 0) {
        fprintf(stream, " --size %.17gx%.17gmm", look->page_width, look->page_height);
    } else {
        fprintf(stream, " --size %dx%d", look->width, look->height);
    }
    fprintf(stream, " --theme %s", theme_name(look));
    if (is_scaled(look)) {
        fprintf(stream, " --scale %.17g", look->scale);
    }
    if (look->dpi > 0) {
        fprintf(stream, " --dpi %.17g", look->dpi);
    }
    if (look->title) {
        fputs(" --title ", stream);
        gm_arguments_put(stream, look->title);
    }
    fclose(stream);
    return text;
}

bool gm_provenance_of_command(struct gm_provenance *provenance, const char *command, const char *system,
                              const struct gm_appearance *look, const char *backend)
{
    *provenance = (struct gm_provenance){0};
    char *options = look_options(look);
    const bool good = options && take(provenance, "Software", format("geomint %s", GM_VERSION)) &&
                      take(provenance, GM_KEY_COMMAND, format("%s%s", command, options)) &&
                      (!system || take(provenance, GM_KEY_SYSTEM, format("%s", system))) &&
                      take(provenance, GM_KEY_PAINTER, format("%s", backend));
    free(options);
    if (!good) {
        gm_provenance_close(provenance);
    }
    return good;
}

int gm_provenance_scene_place(const struct gm_arguments *command)
{
    return command->count > 2 && strcmp(command->words[1], GM_ON) == 0 ? 2 : 1;
}

void gm_provenance_close(struct gm_provenance *provenance)
{
    for (size_t i = 0; i < provenance->count; i++) {
        free(provenance->owned[i]);
    }
    provenance->count = 0;
}

char *gm_provenance_steps(const struct gm_lane *const *lanes, size_t count)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    for (size_t i = 0; i < count; i++) {
        const struct gm_run *run = lanes[i]->run;
        fprintf(stream, "%s%" PRId64, i ? " " : "", run->steps + (run->status != GM_OK));
    }
    fclose(stream);
    return text;
}

char *gm_provenance_failures(const struct gm_lane *const *lanes, size_t count)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    for (size_t i = 0; i < count; i++) {
        char sentence[GM_MESSAGE];
        gm_failure_sentence(lanes[i], sentence, sizeof sentence);
        if (sentence[0]) {
            fprintf(stream, "%s: %s: %s\n", lanes[i]->scheme->name, gm_status_name(lanes[i]->run->status),
                    sentence);
        }
    }
    fclose(stream);
    return text;
}
