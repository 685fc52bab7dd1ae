/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quantities over time: names are found among components, velocities, the energy, and what the file observes or
   conserves. */
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/expression/nearest.h"
#include "scenes/common/symbol.h"

enum { MOST_LISTED = 12 };
static const char all[] = "all", energy[] = "energy";

/* ---- names ---- */

static size_t velocity_count(const struct gm_user_system *system)
{
    return system->kind == GM_LAGRANGIAN ? system->initial - system->velocities : 0;
}

/* Returns the observable of that name, or of its error, that is a formula; NULL without one. */
static const struct gm_observable *formula_of(const struct gm_system_scene *system_scene, const char *name)
{
    const size_t length = strlen(name);
    for (size_t i = 0; i < system_scene->observable_count; i++) {
        const char *key = system_scene->observables[i].key;
        if (strncmp(key, name, length) == 0 && (!key[length] || strcmp(key + length, "_error") == 0) &&
            system_scene->measures[i].formula) {
            return &system_scene->observables[i];
        }
    }
    return NULL;
}

static size_t name_count(const struct gm_system_scene *system_scene)
{
    const struct gm_user_system *system = &system_scene->system;
    return system->n + velocity_count(system) + 1 + system->item_count;
}

/* Returns name i of the system; "" if a line of the file has none, or a name before it. */
static const char *name_at(size_t i, const void *data)
{
    const struct gm_system_scene *system_scene = data;
    const struct gm_user_system *system = &system_scene->system;
    const size_t n = system->n, velocities = velocity_count(system);
    if (i < n + velocities) {
        return system->variables[i < n ? i : system->velocities + i - n].name;
    }
    const struct gm_system_item *item = i > n + velocities ? &system->items[i - n - velocities - 1] : NULL;
    const bool is_named =
        !item || (gm_system_is_observed(item) && item->name && strcmp(item->name, energy) != 0);
    const char *name = item ? item->name : energy;
    return is_named && formula_of(system_scene, name) ? name : "";
}

/* Finds the quantity of the first `length` bytes of a text. */
static bool find_curve(const struct gm_system_scene *system_scene, const char *text, size_t length,
                       struct gm_curve *curve)
{
    for (size_t i = 0; i < name_count(system_scene) && length > 0; i++) {
        const char *name = name_at(i, system_scene);
        if (strncmp(name, text, length) == 0 && !name[length]) {
            const struct gm_observable *row = formula_of(system_scene, name);
            const bool is_formula = i >= system_scene->system.n + velocity_count(&system_scene->system);
            *curve = (struct gm_curve){.name = name, .number = i};
            if (is_formula) {
                curve->tape = system_scene->measures[row - system_scene->observables].formula;
                curve->period = row->period;
            }
            return true;
        }
    }
    return false;
}

/* Refuses a name in all of the text after t:, with the one that was probably meant, and the first names; false. */
static bool refuse_name(const struct gm_system_scene *system_scene, const char *whole, const char *text,
                        size_t length, char *sentence)
{
    char name[64], names[GM_MESSAGE / 2] = "";
    size_t used = 0, listed = 0;
    snprintf(name, sizeof name, "%.*s", (int)(length < 60 ? length : 60), text);
    for (size_t i = 0; i < name_count(system_scene) && listed <= MOST_LISTED; i++) {
        const char *own = name_at(i, system_scene);
        if (own[0] && used + strlen(own) + sizeof ", …" < sizeof names) {
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", listed ? ", " : "",
                                     listed == MOST_LISTED ? "…" : own);
            listed++;
        }
    }
    const char *near = length > 0 ? gm_nearest(name, name_count(system_scene), name_at, system_scene) : NULL;
    return length == 0 ? gm_refuse(sentence, "show=t:%.60s needs a name%s; the names are %s", whole,
                                   *whole ? " before and after each +" : "", names)
                       : gm_refuse(sentence, "show=t:%s: there is no \"%s\"%s%s; the names are %s", name,
                                   name, near ? "; did you mean " : "", near ? near : "", names);
}

/* Finds the quantities of a text after t:. Returns their number; 0 with a sentence on failure. */
static size_t find_curves(const struct gm_system_scene *system_scene, const char *text,
                          struct gm_curve curves[GM_MOST_OVER_TIME], char *sentence)
{
    const struct gm_user_system *system = &system_scene->system;
    size_t count = 1;
    if (strcmp(text, all) == 0) {
        for (size_t i = 0; i < system->n && i < GM_MOST_OVER_TIME; i++) {
            curves[i] = (struct gm_curve){.name = system->variables[i].name, .number = i};
        }
        if (system->n > GM_MOST_OVER_TIME) {
            gm_refuse(sentence,
                      "show=t:all: a graph has at most %d names, and this system has %zu components",
                      GM_MOST_OVER_TIME, system->n);
        }
        return system->n > GM_MOST_OVER_TIME ? 0 : system->n;
    }
    for (const char *at = text; *at; at++) {
        count += *at == '+';
    }
    if (count > GM_MOST_OVER_TIME) {
        gm_refuse(sentence, "show=t:%.60s has %zu names; a graph has at most %d", text, count,
                  GM_MOST_OVER_TIME);
        return 0;
    }
    const char *at = text;
    for (size_t i = 0; i < count; i++) {
        const size_t length = strcspn(at, "+");
        if (!find_curve(system_scene, at, length, &curves[i])) {
            refuse_name(system_scene, text, at, length, sentence);
            return 0;
        }
        for (size_t k = 0; k < i; k++) {
            if (curves[k].number == curves[i].number) {
                gm_refuse(sentence, "show=t:%.60s has %.60s twice", text, curves[i].name);
                return 0;
            }
        }
        at += length + 1;
    }
    return count;
}

static bool has_curves(const struct gm_system_scene *system_scene, const char *show, char *sentence)
{
    struct gm_curve curves[GM_MOST_OVER_TIME];
    return find_curves(system_scene, show + strlen(GM_SHOW_OVER_TIME), curves, sentence) > 0;
}

bool gm_system_can_show(const struct gm_system_lane *lane, char *sentence)
{
    return strncmp(lane->show, GM_SHOW_OVER_TIME, strlen(GM_SHOW_OVER_TIME)) != 0 ||
           has_curves(lane->owner, lane->show, sentence);
}

static const char *choice_at(size_t i, const void *choices)
{
    return ((const char *const *)choices)[i];
}

bool gm_system_admits_show(const struct gm_parameter *row, const char *text, char *sentence)
{
    const size_t length = strlen(GM_SHOW_OVER_TIME);
    size_t count = 0;
    for (; row->choices[count]; count++) {
        if (strcmp(row->choices[count], text) == 0) {
            return true;
        }
    }
    if (strncmp(text, GM_SHOW_OVER_TIME, length) == 0) {
        const struct gm_system_scene *system_scene = row->admitting;
        while (system_scene && !has_curves(system_scene, text, sentence)) {
            system_scene = system_scene->next;
        }
        return system_scene || has_curves(row->admitting, text, sentence);
    }
    char words[GM_MESSAGE / 2], front[GM_TEXT_SIZE];
    const char *near = gm_nearest(text, count, choice_at, row->choices), *colon = strchr(text, ':');
    if (!near && colon) { /* the second component is unknown */
        snprintf(front, sizeof front, "%.*s", (int)(colon + 1 - text), text);
        near = gm_nearest(front, count, choice_at, row->choices);
    }
    return gm_refuse(sentence, "%s=%.60s is none of: %s, t:NAME%s%s", row->key, text,
                     gm_parameter_choices(row, words, sizeof words), near ? "; did you mean " : "",
                     near ? near : "");
}

const struct gm_sight *gm_system_curves(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_system_lane *parameters = lane->parameters;
    const struct gm_sight *sight = gm_system_sight(parameters);
    if (sight->bodies + sight->rods > 0) {
        return sight;
    }
    char sentence[GM_MESSAGE];
    struct gm_sight *made = gm_picture_memory(picture, sizeof *made);
    struct gm_curve *curves = gm_picture_memory(picture, GM_MOST_OVER_TIME * sizeof *curves);
    bool *fixed = gm_picture_memory(picture, GM_MOST_OVER_TIME * sizeof *fixed);
    const size_t count =
        find_curves(parameters->owner, parameters->show + strlen(GM_SHOW_OVER_TIME), curves, sentence);
    memset(fixed, 0, GM_MOST_OVER_TIME * sizeof *fixed);
    *made = *sight;
    made->curves = curves;
    made->bodies = count;
    made->fixed = fixed;
    made->labels[1] = count == 1 ? curves[0].name : NULL;
    return made;
}

/* ---- drawing ---- */

/* Averages groups if there are many points, which shows the slow motion in a fast swing. Returns their
   number. */
static size_t average(double *points, size_t count)
{
    enum { SHOWN = 128 };
    const size_t group = (count + SHOWN - 1) / SHOWN;
    size_t made = 0;
    for (size_t i = 0; i < count; i += group, made++) {
        const size_t end = i + group < count ? i + group : count;
        double sum[2] = {0, 0};
        for (size_t k = 2 * i; k < 2 * end; k++) {
            sum[k % 2] += points[k] / (double)(end - i);
        }
        memcpy(points + 2 * made, sum, sizeof sum);
    }
    return made;
}

/* Writes the curve of a body, and its current point unless `now` is NULL; angles are unwrapped. At an event, which has two
   entries, a curve of one quantity is interrupted, so that no line joins the values before and after a jump. Returns the
   number of points, at most twice that of the entries and the current point. */
static size_t curve_of(const struct gm_path *path, const struct gm_sight *sight, size_t body,
                       const double *now, double *points)
{
    const double period = sight->curves ? sight->curves[body].period : 0;
    double before = NAN;
    size_t count = 0;
    for (size_t i = 0; i < path->count + (now ? 1 : 0); i++, count++) {
        const double *from = (i < path->count ? path->points + i * path->width : now) + 2 * body;
        if (sight->curves && i > 0 && i < path->count && path->times[i] == path->times[i - 1]) {
            points[2 * count] = points[2 * count + 1] = NAN;
            count++;
        }
        points[2 * count] = from[0];
        points[2 * count + 1] =
            period > 0 && isfinite(before) ? from[1] + period * round((before - from[1]) / period) : from[1];
        before = points[2 * count + 1];
    }
    return count;
}

/* Writes the title of a curve over time above one of its points, those of several curves side by side. */
static void draw_title(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                       size_t body, const double *points, size_t count)
{
    const struct gm_system_lane *parameters = lane->parameters;
    const struct gm_system_item *item = gm_system_item_of(&parameters->owner->system, GM_WORD_VIEW, body);
    const char *title = item ? gm_system_option_text(item, GM_OPTION_TITLE, NULL) : NULL;
    const size_t bodies = gm_system_sight(parameters)->bodies;
    const double *at = points + 2 * ((bodies - body) * count / (bodies + 1)); /* parts differ late */
    const double height = panel->y.high - panel->y.low;
    if (title && count > 20 && at[1] < panel->y.high - 0.1 * height) {
        gm_mark_text(picture, panel, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 1}, at[0],
                     at[1] + 0.05 * height, GM_ANCHOR_CENTRE, title);
    }
}

/* Draws the curve of a body: of views, only the last of several in full; dots for steps that are apart. Returns the
   number of its points. */
static size_t draw_curve(struct gm_picture *picture, struct gm_panel *panel, const struct gm_paths *paths,
                         struct gm_style style, size_t body, const double *now, double *points)
{
    enum { APART = 1500, APART_OF_NAMES = 80 };
    const struct gm_sight *sight = paths->sight;
    const bool in_full = sight->curves || body + 1 == sight->bodies;
    const size_t apart = sight->curves ? APART_OF_NAMES : APART;
    size_t count = curve_of(&paths->past, sight, body, now, points);
    count = in_full ? count : average(points, count);
    gm_mark_line(picture, panel, style, points, count, false);
    style.width = 3.4;
    style.dash = GM_SOLID;
    gm_mark_points(picture, panel, style, points, in_full && count < apart ? count : 0);
    return count;
}

void gm_system_draw_curves(struct gm_picture *picture, struct gm_panel *panel, const struct gm_walk *walk,
                           const struct gm_paths *paths, const double *now)
{
    const struct gm_lane *lane = walk->lane;
    const struct gm_sight *sight = paths->sight;
    const bool several = sight->curves && sight->bodies > 1,
               alone = gm_lane_is_alone(walk->lanes, walk->count, walk->lane), leads = walk->first;
    double *points = gm_picture_memory(
        picture, 4 * (lane->entries[GM_TRACK_PAST].count + lane->entries[GM_TRACK_MEMBERS].count + 1) *
                     sizeof *points);
    for (size_t body = 0; body < sight->bodies; body++) {
        const bool is_last = body + 1 == sight->bodies;
        struct gm_style style = {gm_lane_role(lane->shown.colour), sight->curves ? 1 : 0.9,
                                 sight->curves ? 2.2 : 1.6,
                                 is_last && !several ? GM_SOLID : gm_lane_dash(body)};
        style.role = several && alone ? gm_lane_role(body) : style.role;
        struct gm_style thin = style;
        thin.alpha = 0.25;
        thin.width = 1;
        thin.dash = GM_SOLID;
        for (size_t i = 0; i < paths->member_count; i++) {
            const size_t count = curve_of(&paths->members[i], sight, body, NULL, points);
            gm_mark_line(picture, panel, thin, points, count, false);
        }
        const size_t count = draw_curve(picture, panel, paths, style, body, now, points);
        if (!sight->curves) {
            draw_title(picture, panel, lane, body, points, count);
        }
        gm_mark_points(picture, panel, (struct gm_style){style.role, 1, 5, GM_SOLID}, now + 2 * body, 1);
        if (several && leads) {
            style.role = alone ? style.role : GM_SECONDARY;
            gm_panel_key(picture, panel, style, gm_typeset(picture, sight->curves[body].name));
        }
    }
    if (several && alone) { /* names replace the note */
        panel->title_role = GM_INK;
        panel->title =
            panel->note[0] ? gm_picture_text(picture, "%s, %s", panel->title, panel->note) : panel->title;
        panel->note = "";
    }
    gm_mark_switches(picture, panel, lane, false);
}
