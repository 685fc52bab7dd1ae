/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes during a run, and a request as text, which a PNG stores so that it can be reproduced. */
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/names.h"
#include "app/words/request.h"
#include "core/expression/number.h"
#include "core/schemes.h"
#include "render/cells/text.h"

/* The value of a row in a lane; NULL: the scheme. */
static const char *value_of(const struct gm_request *request, size_t lane, const struct gm_parameter *row,
                            char *text)
{
    struct gm_lane_spec *spec = &request->lanes[lane];
    return row ? gm_parameter_format(row, gm_lane_owner(spec, row), text, GM_TEXT_SIZE)
               : gm_scheme_word(spec->scheme);
}

/* Returns true if all lanes have the same value of the row. */
static bool are_alike(const struct gm_request *request, const struct gm_parameter *row)
{
    char room[GM_TEXT_SIZE], text[GM_TEXT_SIZE];
    const char *first = value_of(request, 0, row, room);
    bool alike = true;
    for (size_t i = 1; i < request->count; i++) {
        alike &= strcmp(first, value_of(request, i, row, text)) == 0;
    }
    return alike;
}

/* The rows of the scene, then those of schemes. */
static size_t row_count(const struct gm_request *request)
{
    return request->scene->parameter_count + gm_settings_parameter_count;
}

static const struct gm_parameter *row_at(const struct gm_request *request, size_t i)
{
    const size_t own = request->scene->parameter_count;
    return i < own ? &request->scene->parameters[i] : &gm_settings_parameters[i - own];
}

/* Returns true if all lanes have the same values, so that no key is a list. */
static bool are_copies(const struct gm_request *request)
{
    bool alike = request->count > 1 && are_alike(request, NULL);
    for (size_t i = 0; i < row_count(request); i++) {
        const struct gm_parameter *row = row_at(request, i);
        alike = alike && (!gm_request_uses(request, row->key) || are_alike(request, row));
    }
    return alike;
}

/* One key of the formatted request: the value of every lane if they differ or are `listed`; else that of all, unless it is
   the standard one. Returns whether they are a list. */
static bool format_key(FILE *stream, const struct gm_request *request, const struct gm_parameter *row,
                       const char *standard, bool listed)
{
    char room[GM_TEXT_SIZE], text[GM_TEXT_SIZE];
    const char *first = value_of(request, 0, row, room);
    listed = listed || !are_alike(request, row);
    if (!listed && standard && strcmp(first, standard) == 0) {
        return false;
    }
    fprintf(stream, " %s=", row ? row->key : "scheme");
    gm_arguments_put(stream, first);
    for (size_t i = 1; i < request->count && listed; i++) {
        fputc(',', stream);
        gm_arguments_put(stream, value_of(request, i, row, text));
    }
    return listed;
}

static bool has_key(const struct gm_arguments *words, const char *key)
{
    char word[96];
    snprintf(word, sizeof word, "%s=", key);
    return gm_arguments_have(words, word);
}

char *gm_request_format(const struct gm_request *request)
{
    if (request->arguments) {
        return strdup(request->arguments);
    }
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    /* keys of the scene's default lanes are always written: otherwise the default would be used */
    struct gm_arguments arguments = {0};
    if (request->scene->lanes && !gm_arguments_split(&arguments, request->scene->lanes)) {
        gm_arguments_close(&arguments);
        free(gm_stream_end(&writing));
        return NULL;
    }
    gm_arguments_put_scene(stream, request->scene);
    int lists = format_key(stream, request, NULL, NULL, are_copies(request));
    for (size_t i = 0; i < row_count(request); i++) {
        const struct gm_parameter *row = row_at(request, i);
        const bool always = row->required || has_key(&arguments, row->key);
        if (gm_request_uses(request, row->key)) {
            lists += format_key(stream, request, row, always ? NULL : row->standard, false);
        }
    }
    if (lists > 1) {
        fputs(" zip=yes", stream);
    }
    if (request->overlay || has_key(&arguments, "overlay")) {
        fprintf(stream, " overlay=%s", request->overlay ? "yes" : "no");
    }
    gm_arguments_close(&arguments);
    return gm_stream_end(&writing);
}

char *gm_changes_format(const struct gm_request *request, char between, char end)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    for (size_t i = 0; i < request->change_count; i++) {
        const struct gm_change *change = &request->changes[i];
        fprintf(stream, "%zu%c%" PRId64 "%c%s%c", change->lane, between, change->step, between, change->text,
                end);
    }
    return gm_stream_end(&writing);
}

bool gm_change_add(struct gm_request *request, size_t lane, int64_t step, const char *text)
{
    struct gm_change *grown =
        realloc(request->changes, (request->change_count + 1) * sizeof *request->changes);
    if (!grown) {
        return false;
    }
    request->changes = grown;
    char *copy = strdup(text);
    if (!copy) {
        return false;
    }
    grown[request->change_count++] = (struct gm_change){.lane = lane, .step = step, .text = copy};
    return true;
}

/* "LANE STEP KEY=VALUE"; false if it is anything else. */
static bool parse_change(struct gm_request *request, const char *line)
{
    if (!isdigit((unsigned char)*line)) {
        return false;
    }
    char *end = NULL;
    errno = 0;
    const unsigned long lane = strtoul(line, &end, 10);
    if (errno || *end != ' ' || !isdigit((unsigned char)end[1]) || lane >= request->count) {
        return false;
    }
    const int64_t step = strtoll(end + 1, &end, 10);
    if (errno || *end != ' ' || step > GM_MOST_STEPS || !strchr(end, '=')) {
        return false;
    }
    const char *text = end + strspn(end, " ");
    return gm_text_is_plain(text) && gm_change_add(request, lane, step, text);
}

bool gm_changes_parse(struct gm_request *request, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        char *line = strndup(text, length);
        const bool parsed = line && parse_change(request, line);
        free(line);
        if (!parsed) {
            return false;
        }
        text += length + (text[length] == '\n');
    }
    return true;
}

/* The meaning of a change: a scheme's name, a step size, or (neither) a live parameter or a setting, which is stored. A scheme
   keeps its settings: a change is for one that follows. `scheme` is NULL if it is not known. */
struct meaning {
    const struct gm_scheme *scheme;
    double dt;
};

static bool understand(const struct gm_scene *scene, void *parameters, struct gm_settings *settings,
                       const struct gm_scheme *scheme, const char *text, struct meaning *meaning,
                       char *message)
{
    const char *equals = strchr(text, '=');
    if (!equals) {
        return gm_refuse(message, "\"%.60s\" is not of the form key=value", text);
    }
    char key[96];
    snprintf(key, sizeof key, "%.*s", (int)(equals - text < 95 ? equals - text : 95), text);
    const char *value = equals + 1;
    *meaning = (struct meaning){.dt = NAN};
    if (strcmp(key, "scheme") == 0) {
        bool unreadable;
        meaning->scheme = gm_scheme_named(value, &unreadable, message);
        return meaning->scheme || (!message[0] && gm_refuse(message, "there is no scheme \"%.40s\"", value));
    }
    if (strcmp(key, "dt") == 0) {
        /* the sign may change, which no range in the table allows */
        if (!gm_number_parse(value, &meaning->dt) || !isfinite(meaning->dt) || meaning->dt == 0) {
            return gm_refuse(message, "dt=%.60s is not a step", value);
        }
        return true;
    }
    const struct gm_parameter *row = gm_scene_parameter(scene, key),
                              *setting = row ? NULL : gm_setting_find(key);
    if (setting ? scheme && gm_scheme_takes(scheme, setting) : !row || !row->live) {
        return gm_refuse(message, "%.60s cannot be changed during the run", text);
    }
    return setting ? gm_value_read(setting, settings, value, message)
                   : gm_value_read(row, parameters, value, message);
}

/* The scheme of a lane at the time of a change; NULL: a change to it names none. */
static const struct gm_scheme *scheme_at(const struct gm_request *request, const struct gm_change *change)
{
    const struct gm_scheme *scheme = request->lanes[change->lane].scheme;
    for (size_t i = 0; i < request->change_count && &request->changes[i] != change; i++) {
        const struct gm_change *earlier = &request->changes[i];
        if (earlier->lane == change->lane && earlier->step <= change->step &&
            strncmp(earlier->text, "scheme=", 7) == 0) {
            char message[GM_MESSAGE];
            bool unreadable;
            scheme = gm_scheme_named(earlier->text + 7, &unreadable, message);
        }
    }
    return scheme;
}

bool gm_change_check(const struct gm_request *request, const struct gm_change *change, char *message)
{
    const struct gm_lane_spec *spec = &request->lanes[change->lane];
    if (change->step > spec->steps) {
        return gm_refuse(message, "a change after %" PRId64 " step%s comes too late: lane %zu makes %" PRId64,
                         change->step, gm_plural((double)change->step), change->lane, spec->steps);
    }
    void *parameters = gm_parameters_copy(request->scene, spec->parameters);
    if (!parameters) {
        return gm_refuse(message, "not enough memory");
    }
    struct meaning meaning;
    const double usual = ((const struct gm_timing *)parameters)->dt;
    struct gm_settings settings = spec->settings;
    const bool understood = understand(request->scene, parameters, &settings, scheme_at(request, change),
                                       change->text, &meaning, message);
    free(parameters);
    if (!understood || isnan(meaning.dt) || fabs(meaning.dt) == fabs(usual)) { /* the sign may change */
        return understood;
    }
    char size[64];
    return gm_value_read(gm_scene_parameter(request->scene, "dt"), NULL,
                         gm_number_format(fabs(meaning.dt), size, sizeof size), message);
}

bool gm_change_apply(struct gm_lane *lane, const char *text, char *message)
{
    struct meaning meaning;
    if (!understand(lane->scene, lane->parameters, &lane->settings, lane->scheme, text, &meaning, message)) {
        return false;
    }
    if (meaning.scheme) {
        return gm_lane_switch(lane, gm_scheme_find_for(gm_scheme_word(meaning.scheme), &lane->problem),
                              message);
    }
    if (!isnan(meaning.dt)) {
        gm_lane_set_step(lane, meaning.dt);
    }
    return true;
}
