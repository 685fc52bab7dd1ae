/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The metadata of a picture: the command, the changes during the run, the steps, the failures. */
#include "app/output/provenance.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/drive.h"
#include "core/schemes.h"
#include "render/cells/grid.h"
#include "render/files/deflate.h"

/* Adds a malloc'ed text; NULL: it was out of memory. */
static void take(struct gm_provenance *provenance, const char *key, char *text)
{
    provenance->failed = provenance->failed || !text;
    if (text) {
        provenance->texts[provenance->count++] = (struct gm_png_text){key, text};
    }
}

/* Adds a text if `there`. */
__attribute__((format(printf, 4, 5))) static void add(struct gm_provenance *provenance, bool there,
                                                      const char *key, const char *format, ...)
{
    char *text = NULL;
    va_list values;
    va_start(values, format);
    if (there) {
        take(provenance, key, vasprintf(&text, format, values) < 0 ? NULL : text);
    }
    va_end(values);
}

/* Returns false, and closes it, if a text is missing. */
static bool is_whole(struct gm_provenance *provenance)
{
    if (provenance->failed) {
        gm_provenance_close(provenance);
    }
    return !provenance->failed;
}

/* A text that `put` writes; malloc'ed. Returns NULL when out of memory. */
static char *text_of(void (*put)(FILE *stream, const void *data), const void *data)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (stream) {
        put(stream, data);
    }
    return gm_stream_end(&writing);
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

bool gm_provenance_make(struct gm_provenance *provenance, const struct gm_request *request,
                        const struct gm_appearance *look, const char *backend)
{
    const struct gm_scene *scene = request->scene;
    *provenance = (struct gm_provenance){0};
    add(provenance, true, "Title", "%s", scene->title);
    add(provenance, true, "Software", "geomint %s", GM_VERSION);
    add(provenance, true, "geomint:scene", "%s", scene->name);
    take(provenance, "geomint:schemes", text_of(put_schemes, request));
    take(provenance, "geomint:parameters", text_of(put_parameters, request));
    take(provenance, GM_KEY_ARGUMENTS, gm_request_format(request));
    take(provenance, GM_KEY_CHANGES, gm_changes_format(request, ' ', '\n'));
    add(provenance, true, GM_KEY_PICTURE, "%dx%d %s", look->width, look->height, theme_name(look));
    add(provenance, is_scaled(look), GM_KEY_SCALE, "%.17g", look->scale);
    add(provenance, look->dpi > 0, GM_KEY_DPI, "%.17g", look->dpi);
    add(provenance, look->page_width > 0, GM_KEY_PAGE, "%.17gx%.17g", look->page_width, look->page_height);
    add(provenance, look->title, GM_KEY_TITLE, "%s", look->title);
    add(provenance, scene->source, GM_KEY_SYSTEM, "%s", scene->source);
    add(provenance, scene->room, GM_KEY_ROOM, "%s", scene->mark);
    add(provenance, true, GM_KEY_PAINTER, "%s", backend);
    return is_whole(provenance);
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
    provenance->failed = !options;
    add(provenance, true, "Software", "geomint %s", GM_VERSION);
    add(provenance, options, GM_KEY_COMMAND, "%s%s", command, options);
    add(provenance, system, GM_KEY_SYSTEM, "%s", system);
    add(provenance, true, GM_KEY_PAINTER, "%s", backend);
    free(options);
    return is_whole(provenance);
}

int gm_provenance_scene_place(const struct gm_arguments *command)
{
    return command->count > 2 && strcmp(command->words[1], GM_ON) == 0 ? 2 : 1;
}

void gm_provenance_close(struct gm_provenance *provenance)
{
    for (size_t i = 0; i < provenance->count; i++) {
        free((char *)provenance->texts[i].text);
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
    take(provenance, GM_KEY_STEPS, gm_provenance_steps(lanes, count));
    char *text = failures ? gm_provenance_failures(lanes, count) : NULL;
    if (failures && (!text || text[0])) {
        take(provenance, GM_KEY_FAILURES, text);
    } else {
        free(text);
    }
    return !provenance->failed;
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
        *checksum = gm_deflate()->libdeflate_crc32(*checksum, bytes, size);
    }
    const bool read = !ferror(file);
    fclose(file);
    return read;
}
