/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes in flight, and a request as text: what a PNG keeps so that it can be made again. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/request.h"

/* One key of the formatted request: the value of every lane. */
static void format_key(FILE *stream, const struct gm_request *request, const char *key,
                       const char *(*value)(const struct gm_request *, size_t lane, const void *row,
                                            char *text),
                       const void *row, const char *standard, size_t *lists)
{
    char first[96], text[96];
    bool same = true;
    snprintf(first, sizeof first, "%s", value(request, 0, row, text));
    for (size_t i = 1; i < request->count; i++) {
        same &= strcmp(first, value(request, i, row, text)) == 0;
    }
    if (same && standard && strcmp(first, standard) == 0) {
        return;
    }
    fprintf(stream, " %s=%s", key, first);
    for (size_t i = 1; i < request->count && !same; i++) {
        fprintf(stream, ",%s", value(request, i, row, text));
    }
    *lists += same ? 0 : 1;
}

enum { VALUE = 96 };

static const char *scheme_value(const struct gm_request *request, size_t lane, const void *row, char *text)
{
    (void)row;
    snprintf(text, VALUE, "%s", request->lanes[lane].scheme->name);
    return text;
}

static const char *parameter_value(const struct gm_request *request, size_t lane, const void *row, char *text)
{
    return gm_parameter_format(row, request->lanes[lane].parameters, text, VALUE);
}

static const char *setting_value(const struct gm_request *request, size_t lane, const void *row, char *text)
{
    return gm_parameter_format(row, &request->lanes[lane].settings, text, VALUE);
}

char *gm_request_format(const struct gm_request *request)
{
    if (request->arguments) {
        return strdup(request->arguments);
    }
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    size_t lists = 0;
    fputs(request->scene->name, stream);
    format_key(stream, request, "scheme", scheme_value, NULL, NULL, &lists);
    for (size_t i = 0; i < request->scene->parameter_count; i++) {
        const struct gm_parameter *row = &request->scene->parameters[i];
        format_key(stream, request, row->key, parameter_value, row, row->standard, &lists);
    }
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        const struct gm_parameter *row = &gm_settings_parameters[i];
        format_key(stream, request, row->key, setting_value, row, row->standard, &lists);
    }
    if (lists > 1) {
        fputs(" zip=yes", stream);
    }
    if (request->overlay) {
        fputs(" overlay=yes", stream);
    }
    fclose(stream);
    return text;
}

char *gm_changes_format(const struct gm_request *request)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    for (size_t i = 0; i < request->change_count; i++) {
        const struct gm_change *change = &request->changes[i];
        fprintf(stream, "%zu %ld %s\n", change->lane, change->step, change->text);
    }
    fclose(stream);
    return text;
}

bool gm_change_add(struct gm_request *request, size_t lane, long step, const char *text)
{
    struct gm_change *grown =
        realloc(request->changes, (request->change_count + 1) * sizeof *request->changes);
    if (!grown) {
        return false;
    }
    request->changes = grown;
    struct gm_change *change = &grown[request->change_count++];
    *change = (struct gm_change){.lane = lane, .step = step};
    snprintf(change->text, sizeof change->text, "%s", text);
    return true;
}

bool gm_changes_parse(struct gm_request *request, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        size_t lane = 0;
        long step = 0;
        int used = 0;
        char line[256];
        if (length >= sizeof line) {
            return false;
        }
        memcpy(line, text, length);
        line[length] = '\0';
        if (sscanf(line, "%zu %ld %n", &lane, &step, &used) != 2 || lane >= request->count || step < 0 ||
            !gm_change_add(request, lane, step, line + used)) {
            return false;
        }
        text += length + (text[length] == '\n');
    }
    return true;
}

bool gm_change_apply(struct gm_lane *lane, const char *text, char *message)
{
    char key[96];
    snprintf(key, sizeof key, "%s", text);
    char *equals = strchr(key, '=');
    if (!equals) {
        snprintf(message, GM_MESSAGE, "\"%.60s\" is not of the form key=value", text);
        return false;
    }
    *equals = '\0';
    const char *value = equals + 1;
    if (strcmp(key, "scheme") == 0) {
        const struct gm_scheme *scheme = gm_scheme_find_for(value, &lane->problem);
        if (!scheme) {
            snprintf(message, GM_MESSAGE, "there is no scheme \"%.40s\"", value);
            return false;
        }
        return gm_lane_switch(lane, scheme, message);
    }
    if (strcmp(key, "dt") == 0) {
        /* its sign may turn, which no range in the table allows */
        double dt = 0;
        if (!gm_number_parse(value, &dt) || !(dt > 0 || dt < 0)) {
            snprintf(message, GM_MESSAGE, "dt=%.60s is not a step", value);
            return false;
        }
        gm_lane_set_step(lane, dt);
        return true;
    }
    const struct gm_parameter *row = gm_scene_parameter(lane->scene, key);
    if (!row || !row->live || gm_parameter_set(row, lane->parameters, value) != GM_PARSED) {
        snprintf(message, GM_MESSAGE, "%.60s cannot be changed in flight", text);
        return false;
    }
    return true;
}
