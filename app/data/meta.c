/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The description of a run, as JSON. */
#include "app/data/save.h"

#include <stdlib.h>

#include "app/base/arguments.h"
#include "app/output/row.h"

void gm_meta_parameter(struct gm_row *row, const struct gm_parameter *parameter, const void *owner)
{
    char text[GM_TEXT_SIZE];
    if (parameter->type == GM_REAL || parameter->type == GM_INTEGER) {
        gm_row_number(row, parameter->key, gm_parameter_get(parameter, owner), 17);
    } else {
        gm_row_text(row, parameter->key, gm_parameter_format(parameter, owner, text, sizeof text));
    }
}

void gm_meta_parameters(struct gm_row *row, const struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    char text[GM_TEXT_SIZE];
    struct gm_row parameters = gm_row_open(row, "parameters", '}');
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *parameter = &scene->parameters[i];
        if (!gm_scene_idle(scene, lane->parameters, parameter->key)) {
            gm_meta_parameter(&parameters, parameter, lane->parameters);
        }
    }
    for (const struct gm_parameter *const *set = lane->scheme->family->parameters; set && *set; set++) {
        gm_row_text(&parameters, (*set)->key, gm_parameter_format(*set, &lane->settings, text, sizeof text));
    }
}

void gm_meta_source(struct gm_row *row, const struct gm_scene *scene)
{
    if (scene->text) {
        gm_row_put(row, "system %s", scene->text);
    }
    if (scene->room) {
        gm_row_put(row, "room %s", scene->room);
    }
}

char *gm_meta_text(const struct gm_lane *lane, const char *status, const char *sentence)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    struct gm_row row = gm_row_begin(stream);
    gm_row_put(&row, "version %s, scene %s", "geomint " GM_VERSION, lane->scene->name);
    gm_meta_source(&row, lane->scene);
    gm_row_put(&row, "scheme %s", lane->scheme->name);
    gm_meta_parameters(&row, lane);
    gm_row_put(&row, "status %s, message %s, t %.17g, steps %.0f", status, sentence, lane->run->t,
               (double)lane->run->steps);
    struct gm_row units = gm_row_open(&row, "units", '}');
    gm_row_put(&units, "t %s", lane->scene->time ? lane->scene->time : "");
    gm_row_close(&row, "");
    return gm_stream_end(&writing);
}
