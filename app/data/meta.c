/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What was run, as JSON. */
#include "app/data/save.h"

#include <inttypes.h>
#include <stdlib.h>

#include "app/output/row.h"
#include "core/basics.h"

void gm_meta_parameters(FILE *stream, const struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    char text[GM_TEXT_SIZE];
    fputc('{', stream);
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        if (gm_scene_idle(scene, lane->parameters, row->key)) {
            continue;
        }
        fprintf(stream, "%s\"%s\":", i ? "," : "", row->key); /* the first, the step, always has an effect */
        if (row->type == GM_TEXT) {
            gm_json_put_text(stream, gm_parameter_format(row, lane->parameters, text, sizeof text));
        } else if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
            fprintf(stream, "\"%s\"", gm_parameter_format(row, lane->parameters, text, sizeof text));
        } else {
            gm_json_put_number(stream, gm_parameter_get(row, lane->parameters));
        }
    }
    for (const struct gm_parameter *const *row = lane->scheme->family->parameters; row && *row; row++) {
        fprintf(stream, ",\"%s\":\"%s\"", (*row)->key,
                gm_parameter_format(*row, &lane->settings, text, sizeof text));
    }
    fputc('}', stream);
}

void gm_meta_source(FILE *stream, const struct gm_scene *scene)
{
    const char *const texts[] = {scene->text, scene->room}, *const keys[] = {"system", "room"};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        if (texts[i]) {
            fprintf(stream, ",\"%s\":", keys[i]);
            gm_json_put_text(stream, texts[i]);
        }
    }
}

char *gm_meta_text(const struct gm_lane *lane, const char *status, const char *sentence)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    fprintf(stream, "{\"version\":\"geomint %s\",\"scene\":\"%s\"", GM_VERSION, lane->scene->name);
    gm_meta_source(stream, lane->scene);
    fprintf(stream, ",\"scheme\":\"%s\",\"parameters\":", lane->scheme->name);
    gm_meta_parameters(stream, lane);
    fprintf(stream, ",\"status\":\"%s\",\"message\":", status);
    gm_json_put_text(stream, sentence);
    fputs(",\"t\":", stream);
    gm_json_put_number(stream, lane->run->t);
    fprintf(stream, ",\"steps\":%" PRId64 ",\"units\":{\"t\":", lane->run->steps);
    gm_json_put_text(stream, lane->scene->time ? lane->scene->time : "");
    fputs("}}", stream);
    if (fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}
