/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/request.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/nearest.h"

enum { MOST_LISTS = 32, MOST_LANES = 64, MOST_VALUES = 64 };

/* One key with its list of values, as typed. */
struct list {
    char *key;
    char *values[MOST_VALUES];
    size_t count;
};

struct lists {
    struct list list[MOST_LISTS];
    size_t count;
    bool zip;
    bool overlay;
};

__attribute__((format(printf, 2, 3))) static bool refuse(char *message, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, GM_MESSAGE, format, arguments);
    va_end(arguments);
    return false;
}

static const char *scene_name(size_t i, const void *data)
{
    return (void)data, gm_scene_at(i)->name;
}

static const char *scheme_name(size_t i, const void *data)
{
    return (void)data, gm_scheme_at(i)->name;
}

static const char *const app_keys[] = {"scheme", "steps", "zip", "overlay"};
enum { APP_KEYS = 4 };

static const char *key_name(size_t i, const void *data)
{
    const struct gm_scene *scene = data;
    if (i < APP_KEYS) {
        return app_keys[i];
    }
    i -= APP_KEYS;
    return i < scene->parameter_count ? scene->parameters[i].key
                                      : gm_settings_parameters[i - scene->parameter_count].key;
}

static const struct gm_parameter *setting(const char *key)
{
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        if (strcmp(gm_settings_parameters[i].key, key) == 0) {
            return &gm_settings_parameters[i];
        }
    }
    return NULL;
}

static bool uses(const struct gm_scheme *scheme, const struct gm_parameter *row)
{
    for (const struct gm_parameter *const *at = scheme->family->parameters; at && *at; at++) {
        if (*at == row) {
            return true;
        }
    }
    return false;
}

static void lists_close(struct lists *lists)
{
    for (size_t i = 0; i < lists->count; i++) {
        free(lists->list[i].key);
        for (size_t k = 0; k < lists->list[i].count; k++) {
            free(lists->list[i].values[k]);
        }
    }
    lists->count = 0;
}

static bool add_value(struct list *list, const char *text, size_t length, char *message)
{
    if (length == 0) {
        return refuse(message, "%s= has an empty value", list->key);
    }
    if (list->count == MOST_VALUES) {
        return refuse(message, "%s= has more than %d values", list->key, MOST_VALUES);
    }
    list->values[list->count] = strndup(text, length);
    if (!list->values[list->count]) {
        return refuse(message, "not enough memory");
    }
    list->count++;
    return true;
}

static bool known_key(const struct gm_scene *scene, const char *key)
{
    for (size_t i = 0; i < APP_KEYS; i++) {
        if (strcmp(app_keys[i], key) == 0) {
            return true;
        }
    }
    return gm_scene_parameter(scene, key) || setting(key);
}

static bool read_word(struct lists *lists, const struct gm_scene *scene, const char *word, char *message)
{
    const char *equals = strchr(word, '=');
    if (!equals || equals == word) {
        return refuse(message, "\"%.60s\" is not of the form key=value", word);
    }
    if (lists->count == MOST_LISTS) {
        return refuse(message, "more than %d keys", MOST_LISTS);
    }
    struct list *list = &lists->list[lists->count];
    *list = (struct list){.key = strndup(word, (size_t)(equals - word))};
    if (!list->key) {
        return refuse(message, "not enough memory");
    }
    lists->count++;
    if (!known_key(scene, list->key)) {
        const size_t names = APP_KEYS + scene->parameter_count + gm_settings_parameter_count;
        const char *near = gm_nearest(list->key, names, key_name, scene);
        return refuse(message, "scene %s has no parameter \"%.40s\"%s%s", scene->name, list->key,
                      near ? "; did you mean " : "; see geomint list ", near ? near : scene->name);
    }
    for (size_t i = 0; i + 1 < lists->count; i++) {
        if (strcmp(lists->list[i].key, list->key) == 0) {
            return refuse(message, "%s= is given twice", list->key);
        }
    }
    const char *at = equals + 1;
    for (;;) {
        const char *comma = strchr(at, ',');
        if (!add_value(list, at, comma ? (size_t)(comma - at) : strlen(at), message)) {
            return false;
        }
        if (!comma) {
            return true;
        }
        at = comma + 1;
    }
}

static struct list *find_list(struct lists *lists, const char *key)
{
    for (size_t i = 0; i < lists->count; i++) {
        if (strcmp(lists->list[i].key, key) == 0) {
            return &lists->list[i];
        }
    }
    return NULL;
}

static bool set_parameter(const struct gm_parameter *row, void *owner, const char *text, char *message)
{
    switch (gm_parameter_set(row, owner, text)) {
    case GM_PARSED:
        return true;
    case GM_NOT_UNDERSTOOD:
        if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
            char choices[GM_MESSAGE / 2] = "no, yes";
            size_t used = 0;
            for (size_t i = 0; row->type == GM_CHOICE && row->choices[i] && used < sizeof choices; i++) {
                used += (size_t)snprintf(choices + used, sizeof choices - used, "%s%s", i ? ", " : "",
                                         row->choices[i]);
            }
            return refuse(message, "%s=%.60s is none of: %s", row->key, text, choices);
        }
        return refuse(message, "%s=%.60s is not %s", row->key, text,
                      row->type == GM_TEXT      ? "a word of at most 255 bytes without blanks"
                      : row->type == GM_INTEGER ? "a whole number"
                                                : "a number");
    case GM_OUT_OF_RANGE:
        break;
    }
    char low[40], high[40], nearest[64] = "";
    double value = NAN;
    gm_number_parse(text, &value);
    gm_number_format(row->lowest, low, sizeof low);
    gm_number_format(row->highest, high, sizeof high);
    if (!isnan(value)) {
        snprintf(nearest, sizeof nearest, "; the nearest is %s", value < row->lowest ? low : high);
    }
    return refuse(message, "%s=%.60s is out of range: it lies between %s and %s%s", row->key, text, low, high,
                  nearest);
}

static bool set_scheme(const struct gm_scene *scene, struct gm_lane_spec *spec, const char *name,
                       char *message)
{
    spec->scheme = gm_scheme_find(name);
    if (!spec->scheme) {
        const char *near = gm_nearest(name, gm_scheme_count(), scheme_name, NULL);
        return refuse(message, "there is no scheme \"%.40s\"%s%s", name,
                      near ? "; did you mean " : "; see geomint list ", near ? near : scene->name);
    }
    return true;
}

/* Applies value `index` of a list to a lane. steps, zip and overlay are not the lane's. */
static bool apply(const struct gm_scene *scene, struct gm_lane_spec *spec, const struct list *list,
                  size_t index, char *message)
{
    const char *text = list->values[index];
    if (strcmp(list->key, "scheme") == 0) {
        return set_scheme(scene, spec, text, message);
    }
    if (strcmp(list->key, "zip") == 0 || strcmp(list->key, "overlay") == 0) {
        return true;
    }
    if (strcmp(list->key, "steps") == 0) {
        double steps = 0;
        if (!gm_number_parse(text, &steps) || !(steps >= 0 && steps <= 1e15) || steps != floor(steps)) {
            return refuse(message, "steps=%.60s is not a whole number from 0 to 1e15", text);
        }
        spec->steps = (long)steps;
        return true;
    }
    const struct gm_parameter *row = gm_scene_parameter(scene, list->key);
    return row ? set_parameter(row, spec->parameters, text, message)
               : set_parameter(setting(list->key), &spec->settings, text, message);
}

/* "Δt = 0.1" for a key and its value; "" for a scheme, whose title says more. */
static void name_of(const struct list *list, size_t index, char *name, size_t size)
{
    if (strcmp(list->key, "scheme") == 0) {
        snprintf(name, size, "%s", "");
        return;
    }
    snprintf(name, size, "%s = %s", strcmp(list->key, "dt") == 0 ? "Δt" : list->key, list->values[index]);
}

/* Which value of list i lane number `lane` takes. The first list changes slowest. */
static size_t choice(const struct lists *lists, size_t i, size_t lane)
{
    if (lists->list[i].count == 1) {
        return 0;
    }
    if (lists->zip) {
        return lane;
    }
    for (size_t k = lists->count - 1; k > i; k--) {
        lane /= lists->list[k].count;
    }
    return lane % lists->list[i].count;
}

void gm_show_in_order(struct gm_shown *shown, size_t lane, const struct gm_scheme *scheme, bool overlay)
{
    char name[sizeof shown->panel_name];
    const char *own = shown->colour_name[0] ? shown->colour_name : shown->panel_name;
    snprintf(name, sizeof name, "%s", strcmp(own, scheme->title) == 0 ? "" : own);
    *shown = (struct gm_shown){.panel = overlay ? 0 : lane, .colour = lane};
    if (overlay) {
        snprintf(shown->panel_name, sizeof shown->panel_name, "all lanes");
        snprintf(shown->colour_name, sizeof shown->colour_name, "%s", name[0] ? name : scheme->title);
    } else {
        memcpy(shown->panel_name, name, sizeof name);
    }
}

/* The first list of several values gives the panels, the others the colours. */
static void show(const struct lists *lists, size_t lane, struct gm_lane_spec *spec)
{
    struct gm_shown *shown = &spec->shown;
    *shown = (struct gm_shown){.panel = lane, .colour = lane};
    const struct list *first = NULL;
    for (size_t i = 0; i < lists->count; i++) {
        const struct list *list = &lists->list[i];
        if (list->count == 1) {
            continue;
        }
        const size_t index = choice(lists, i, lane);
        if (!first) {
            first = list;
            name_of(list, index, shown->panel_name, sizeof shown->panel_name);
            if (!lists->zip) {
                shown->panel = index;
            }
        } else if (!lists->zip) {
            shown->colour =
                shown->colour == lane && !shown->colour_name[0] ? index : shown->colour * list->count + index;
            if (strcmp(list->key, "scheme") == 0) {
                snprintf(shown->colour_name, sizeof shown->colour_name, "%s", spec->scheme->title);
            } else {
                name_of(list, index, shown->colour_name, sizeof shown->colour_name);
            }
        }
    }
}

static bool count_lanes(const struct lists *lists, size_t *lanes, char *message)
{
    *lanes = 1;
    for (size_t i = 0; i < lists->count; i++) {
        const size_t count = lists->list[i].count;
        if (count == 1) {
            continue;
        }
        if (lists->zip && *lanes > 1 && *lanes != count) {
            return refuse(message, "zip=yes pairs lists of equal length; %s= has %zu values, not %zu",
                          lists->list[i].key, count, *lanes);
        }
        *lanes = lists->zip ? count : *lanes * count;
        if (*lanes > MOST_LANES) {
            return refuse(message, "that makes more than %d lanes", MOST_LANES);
        }
    }
    return true;
}

/* dt and until, or steps, to whole steps; with `steps` until follows. */
static bool settle_time(const struct gm_scene *scene, struct gm_lane_spec *spec, bool steps_given,
                        char *message)
{
    struct gm_timing *timing = spec->parameters;
    const bool own_time = spec->scheme && spec->scheme->family->own_time;
    const double t0 = gm_scene_t0(scene, spec->parameters);
    if (steps_given) {
        timing->until = own_time ? GM_NEVER : t0 + (double)spec->steps * timing->dt;
        return true;
    }
    if (own_time) {
        spec->steps = (long)1e15; /* it ends at the first t >= until, after steps that it chooses */
        return true;
    }
    const double steps = round((timing->until - t0) / timing->dt);
    if (steps < 0) {
        return refuse(message, "until=%g lies before the start, t = %g", timing->until, t0);
    }
    if (!(steps <= 1e15)) {
        return refuse(message, "until / dt is %.3g steps; 1e15 is the most", steps);
    }
    spec->steps = (long)steps;
    return true;
}

static bool check_settings(const struct gm_request *request, const struct lists *lists, char *message)
{
    for (size_t i = 0; i < lists->count; i++) {
        const struct gm_parameter *row = setting(lists->list[i].key);
        bool used = !row || gm_scene_parameter(request->scene, lists->list[i].key);
        for (size_t k = 0; k < request->count && !used; k++) {
            used = uses(request->lanes[k].scheme, row);
        }
        if (!used) {
            return refuse(message, "none of these schemes has the parameter %s", row->key);
        }
    }
    return true;
}

static bool make_lanes(struct gm_request *request, struct lists *lists, char *message)
{
    const struct gm_scene *scene = request->scene;
    size_t count = 0;
    if (!count_lanes(lists, &count, message)) {
        return false;
    }
    if (lists->overlay && count > GM_LANE_COLOURS) {
        return refuse(message, "overlay=yes takes up to %d lanes, a colour for each; these are %zu",
                      GM_LANE_COLOURS, count);
    }
    request->lanes = calloc(count, sizeof *request->lanes);
    if (!request->lanes) {
        return refuse(message, "not enough memory");
    }
    const bool steps_given = find_list(lists, "steps") != NULL;
    if (steps_given && find_list(lists, "until")) {
        return refuse(message, "steps= and until= are both given; one of them follows from the other");
    }
    const char *keys[MOST_LISTS] = {NULL};
    for (size_t i = 0; i < lists->count && i < MOST_LISTS; i++) {
        keys[i] = lists->list[i].key;
    }
    for (size_t k = 0; k < count; k++) {
        struct gm_lane_spec *spec = &request->lanes[k];
        spec->parameters = calloc(1, scene->size);
        request->count++;
        if (!spec->parameters) {
            return refuse(message, "not enough memory");
        }
        gm_parameters_reset(scene->parameters, scene->parameter_count, spec->parameters);
        gm_parameters_reset(gm_settings_parameters, gm_settings_parameter_count, &spec->settings);
        for (size_t i = 0; i < lists->count; i++) {
            if (!apply(scene, spec, &lists->list[i], choice(lists, i, k), message)) {
                return false;
            }
        }
        show(lists, k, spec);
        if (lists->overlay) {
            gm_show_in_order(&spec->shown, k, spec->scheme, true);
        }
        if (scene->settle && !scene->settle(spec->parameters, keys, lists->count, message)) {
            return false;
        }
        if (!settle_time(scene, spec, steps_given, message)) {
            return false;
        }
        struct gm_problem problem = {0};
        if (!scene->setup(spec->parameters, &problem, message)) {
            return false;
        }
        spec->scheme = gm_scheme_find_for(spec->scheme->name, &problem);
        const bool fits = gm_scheme_fits(spec->scheme, &problem);
        if (scene->close) {
            scene->close(&problem);
        }
        if (!fits) {
            return refuse(message, "scheme %s does not fit scene %s; geomint list %s names those that do",
                          spec->scheme->name, scene->name, scene->name);
        }
    }
    return check_settings(request, lists, message);
}

/* The first `schemes` of the scene's preferred ones, as if they had been typed in front. */
static bool prefer(struct lists *lists, const struct gm_scene *scene, size_t schemes, char *message)
{
    if (find_list(lists, "scheme")) {
        return true;
    }
    if (lists->count == MOST_LISTS) {
        return refuse(message, "more than %d keys", MOST_LISTS);
    }
    struct list list = {.key = strdup("scheme")};
    bool good = list.key != NULL;
    for (size_t i = 0; good && i < schemes && scene->schemes[i]; i++) {
        good = add_value(&list, scene->schemes[i], strlen(scene->schemes[i]), message);
    }
    memmove(&lists->list[1], &lists->list[0], lists->count * sizeof lists->list[0]);
    lists->list[0] = list;
    lists->count++;
    return good || refuse(message, "not enough memory");
}

/* A yes or no that is not a lane's. */
static bool read_yes(struct lists *lists, const char *key, bool *value, char *message)
{
    const struct list *list = find_list(lists, key);
    *value = list && strcmp(list->values[0], "yes") == 0;
    return !list || (list->count == 1 && (*value || strcmp(list->values[0], "no") == 0)) ||
           refuse(message, "%s= is one of: no, yes", key);
}

static char *join(const struct gm_scene *scene, const struct lists *lists)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    fputs(scene->name, stream);
    for (size_t i = 0; i < lists->count; i++) {
        fprintf(stream, " %s=", lists->list[i].key);
        for (size_t k = 0; k < lists->list[i].count; k++) {
            fprintf(stream, "%s%s", k ? "," : "", lists->list[i].values[k]);
        }
    }
    fclose(stream);
    return text;
}

bool gm_request_parse(struct gm_request *request, int count, char *const words[], size_t schemes,
                      char *message)
{
    *request = (struct gm_request){0};
    if (count == 0) {
        return refuse(message, "which scene? geomint list names them");
    }
    request->scene = gm_scene_find(words[0]);
    if (!request->scene) {
        const char *near = gm_nearest(words[0], gm_scene_count(), scene_name, NULL);
        return refuse(message, "there is no scene \"%.40s\"%s%s", words[0],
                      near ? "; did you mean " : "; see geomint list", near ? near : "");
    }
    struct lists lists;
    memset(&lists, 0, sizeof lists);
    bool good = true;
    for (int i = 1; i < count && good; i++) {
        good = read_word(&lists, request->scene, words[i], message);
    }
    if (count == 1 && schemes > 1 && request->scene->lanes) {
        char shown[256], *rest = NULL;
        snprintf(shown, sizeof shown, "%s", request->scene->lanes);
        for (char *word = strtok_r(shown, " ", &rest); word && good; word = strtok_r(NULL, " ", &rest)) {
            good = read_word(&lists, request->scene, word, message);
        }
    }
    good = good && read_yes(&lists, "zip", &lists.zip, message) &&
           read_yes(&lists, "overlay", &lists.overlay, message);
    request->overlay = lists.overlay;
    good = good && prefer(&lists, request->scene, schemes, message) && make_lanes(request, &lists, message);
    if (good) {
        request->arguments = join(request->scene, &lists);
        good = request->arguments || refuse(message, "not enough memory");
    }
    lists_close(&lists);
    if (!good) {
        gm_request_close(request);
    }
    return good;
}

void gm_request_close(struct gm_request *request)
{
    for (size_t i = 0; i < request->count; i++) {
        free(request->lanes[i].parameters);
    }
    free(request->lanes);
    free(request->changes);
    free(request->arguments);
    *request = (struct gm_request){0};
}

struct gm_lane *gm_request_open_lane(const struct gm_request *request, size_t index, char *message)
{
    const struct gm_lane_spec *spec = &request->lanes[index];
    struct gm_lane *lane =
        gm_lane_open(request->scene, spec->parameters, &spec->settings, spec->scheme, message);
    if (lane) {
        lane->shown = spec->shown;
    }
    return lane;
}
