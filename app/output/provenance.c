/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The metadata of a picture: the command, the changes during the run, the steps, the failures. */
#include "app/output/provenance.h"

#include <inttypes.h>
#include <libdeflate.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/drive.h"
#include "core/schemes.h"
#include "render/cells/grid.h"

static bool take(struct gm_provenance *provenance, const char *key, char *text)
{
    if (!text) {
        return false;
    }
    provenance->owned[provenance->count] = text;
    provenance->texts[provenance->count++] = (struct gm_png_text){key, text};
    return true;
}

/* A text that `put` writes; malloc'ed. Returns NULL when out of memory. */
static char *text_of(void (*put)(FILE *stream, const void *data), const void *data)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream) {
        put(stream, data);
        fclose(stream);
    }
    return text;
}

static void put_schemes(FILE *stream, const void *data)
{
    const struct gm_request *request = data;
    for (size_t i = 0; i < request->count; i++) {
        fprintf(stream, "%s%s", i ? " " : "", request->lanes[i].scheme->name);
    }
}

void gm_provenance_put_lanes(FILE *stream, const struct gm_request *request, bool identity)
{
    const struct gm_scene *scene = request->scene;
    char value[GM_TEXT_SIZE];
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        fprintf(stream, "scheme=%s", identity ? gm_scheme_word(spec->scheme) : spec->scheme->name);
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            const bool has_effect = !gm_scene_idle(scene, spec->parameters, row->key);
            if (identity ? strcmp(row->key, "until") != 0 : has_effect) {
                fprintf(stream, " %s=%s", row->key,
                        gm_parameter_format(row, spec->parameters, value, sizeof value));
            }
        }
        for (const struct gm_parameter *const *row = spec->scheme->family->parameters; row && *row; row++) {
            fprintf(stream, " %s=%s", (*row)->key,
                    gm_parameter_format(*row, &spec->settings, value, sizeof value));
        }
        fputc('\n', stream);
    }
}

static void put_parameters(FILE *stream, const void *data)
{
    gm_provenance_put_lanes(stream, data, false);
}

static const char *theme_name(const struct gm_appearance *look)
{
    return look->theme == GM_THEME_DARK ? "dark" : "light";
}

/* Returns true if the look has a scale of letters and lines other than 1. */
static bool is_scaled(const struct gm_appearance *look)
{
    return look->scale > 0 && look->scale != 1;
}

/* Adds the parts of the look that differ from the default. */
static bool take_look(struct gm_provenance *provenance, const struct gm_appearance *look)
{
    return (!is_scaled(look) || take(provenance, GM_KEY_SCALE, gm_text("%.17g", look->scale))) &&
           (!(look->dpi > 0) || take(provenance, GM_KEY_DPI, gm_text("%.17g", look->dpi))) &&
           (!(look->page_width > 0) ||
            take(provenance, GM_KEY_PAGE, gm_text("%.17gx%.17g", look->page_width, look->page_height))) &&
           (!look->title || take(provenance, GM_KEY_TITLE, gm_text("%s", look->title)));
}

bool gm_provenance_make(struct gm_provenance *provenance, const struct gm_request *request,
                        const struct gm_appearance *look, const char *backend)
{
    *provenance = (struct gm_provenance){0};
    const bool good =
        take(provenance, "Title", gm_text("%s", request->scene->title)) &&
        take(provenance, "Software", gm_text("geomint %s", GM_VERSION)) &&
        take(provenance, "geomint:scene", gm_text("%s", request->scene->name)) &&
        take(provenance, "geomint:schemes", text_of(put_schemes, request)) &&
        take(provenance, "geomint:parameters", text_of(put_parameters, request)) &&
        take(provenance, GM_KEY_ARGUMENTS, gm_request_format(request)) &&
        take(provenance, GM_KEY_CHANGES, gm_changes_format(request)) &&
        take(provenance, GM_KEY_PICTURE, gm_text("%dx%d %s", look->width, look->height, theme_name(look))) &&
        take_look(provenance, look) &&
        (!request->scene->source || take(provenance, GM_KEY_SYSTEM, gm_text("%s", request->scene->source))) &&
        (!request->scene->room || take(provenance, GM_KEY_ROOM, gm_text("%s", request->scene->mark))) &&
        take(provenance, GM_KEY_PAINTER, gm_text("%s", backend));
    if (!good) {
        gm_provenance_close(provenance);
    }
    return good;
}

/* The options of a look, each with a blank before it. */
static void put_options(FILE *stream, const void *data)
{
    const struct gm_appearance *look = data;
    if (look->screen) {
        fprintf(stream, " --screen %dx%d", look->screen->columns, look->screen->rows);
    } else if (look->page_width > 0) {
        fprintf(stream, " --size %.17gx%.17gmm", look->page_width, look->page_height);
    } else {
        fprintf(stream, " --size %dx%d", look->width, look->height);
    }
    if (!look->screen) { /* a key may have changed the theme that the explorer began with */
        fprintf(stream, " --theme %s", theme_name(look));
    }
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
}

bool gm_provenance_of_command(struct gm_provenance *provenance, const char *command, const char *system,
                              const struct gm_appearance *look, const char *backend)
{
    *provenance = (struct gm_provenance){0};
    char *options = text_of(put_options, look);
    const bool good = options && take(provenance, "Software", gm_text("geomint %s", GM_VERSION)) &&
                      take(provenance, GM_KEY_COMMAND, gm_text("%s%s", command, options)) &&
                      (!system || take(provenance, GM_KEY_SYSTEM, gm_text("%s", system))) &&
                      take(provenance, GM_KEY_PAINTER, gm_text("%s", backend));
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

struct lanes {
    const struct gm_lane *const *lanes;
    size_t count;
};

static void put_steps(FILE *stream, const void *data)
{
    const struct lanes *all = data;
    for (size_t i = 0; i < all->count; i++) {
        const struct gm_run *run = all->lanes[i]->run;
        fprintf(stream, "%s%" PRId64, i ? " " : "", run->steps + (run->status != GM_OK));
    }
}

char *gm_provenance_steps(const struct gm_lane *const *lanes, size_t count)
{
    return text_of(put_steps, &(struct lanes){lanes, count});
}

static void put_failures(FILE *stream, const void *data)
{
    const struct lanes *all = data;
    for (size_t i = 0; i < all->count; i++) {
        const struct gm_lane *lane = all->lanes[i];
        char sentence[GM_MESSAGE];
        gm_failure_sentence(lane, sentence, sizeof sentence);
        if (sentence[0]) {
            fprintf(stream, "%s: %s: %s\n", lane->scheme->name, gm_status_name(lane->run->status), sentence);
        }
    }
}

char *gm_provenance_failures(const struct gm_lane *const *lanes, size_t count)
{
    return text_of(put_failures, &(struct lanes){lanes, count});
}

bool gm_provenance_take_lanes(struct gm_provenance *provenance, const struct gm_lane *const *lanes,
                              size_t count, bool failures)
{
    if (!take(provenance, GM_KEY_STEPS, gm_provenance_steps(lanes, count))) {
        return false;
    }
    char *text = failures ? gm_provenance_failures(lanes, count) : NULL;
    if (!failures || (text && !text[0])) {
        free(text);
        return true;
    }
    return take(provenance, GM_KEY_FAILURES, text);
}

bool gm_program_checksum(unsigned *checksum)
{
    FILE *file = fopen("/proc/self/exe", "rbe");
    if (!file) {
        return false;
    }
    char bytes[1 << 16];
    size_t size = 0;
    *checksum = 0;
    while ((size = fread(bytes, 1, sizeof bytes, file)) > 0) {
        *checksum = libdeflate_crc32(*checksum, bytes, size);
    }
    const bool good = !ferror(file);
    fclose(file);
    return good;
}
