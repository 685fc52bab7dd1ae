/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts through a room: drawn with exact and published values, and written as rows of numbers. */
#include "scenes/flow/room_scene.h"

#include <math.h>
#include <string.h>

#include "scenes/common/graph.h"

/* Returns true if published points hold for a lane's parameters. */
static bool holds(const struct gm_system_item *table, const struct gm_flows *flows)
{
    const struct gm_parameter *row = gm_scene_parameter(&flows->room->of_file.scene, table->text);
    return strcmp(flows->mesh, "none") == 0 && gm_parameter_get(row, flows) == table->value;
}

/* Returns the coordinate that runs along a profile from end to end: 0, or 1 if it is steeper. */
static int along(const double ends[4])
{
    return fabs(ends[3] - ends[1]) >= fabs(ends[2] - ends[0]);
}

/* Returns the number of points of a table, each with its position and value. */
static size_t points_of(const struct gm_system_item *table)
{
    return table->options ? table->options->count / 2 : 0;
}

static void draw_profile(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         enum gm_place place, const struct gm_system_item *profile, char quantity)
{
    enum { POINTS = 97 };
    const struct gm_user_system *system = &gm_user_room_of(lanes[0]->parameters)->room.system;
    const double *ends = profile->options->numbers;
    const int up = along(ends);
    double at[2 * POINTS], (*points)[2 * POINTS] = gm_picture_memory(picture, (count + 2) * sizeof *points);
    size_t *made = gm_picture_memory(picture, count * sizeof *made);
    struct gm_panel *panel = gm_panel_add(picture, place, "");
    struct gm_axis value = {.label = profile->text     ? profile->text
                                     : quantity == 's' ? "θ"
                                     : quantity == 'v' ? "v"
                                                       : "u",
                            .low = 1,
                            .high = 0};
    for (size_t i = 0; i < POINTS; i++) {
        for (size_t c = 0; c < 2; c++) {
            at[2 * i + c] = ends[c] + (ends[2 + c] - ends[c]) * (double)i / (POINTS - 1);
        }
    }
    const struct gm_view view = gm_lane_view(lanes[0]);
    bool known = true;
    for (size_t i = 0; i < POINTS && known; i++) {
        double *point = points[count] + 2 * i;
        point[up] = at[2 * i + (size_t)up];
        point[1 - up] = gm_room_exact(&view, gm_room_key_of(quantity), at + 2 * i);
        known = !isnan(point[1 - up]);
        gm_range_add(&value.low, &value.high, point[1 - up]);
    }
    for (size_t k = 0; k < count; k++) {
        made[k] = 0;
        for (size_t i = 0; i < POINTS; i++) {
            struct gm_sample sample;
            if (gm_flow_sample(gm_flow_of(&lanes[k]->problem), gm_run_state(lanes[k]->run), at[2 * i],
                               at[2 * i + 1], &sample)) {
                double *point = points[k] + 2 * made[k]++;
                point[up] = at[2 * i + (size_t)up];
                point[1 - up] = gm_room_quantity(&sample, quantity);
                if (!known) {
                    gm_range_add(&value.low, &value.high, point[1 - up]);
                }
            }
        }
    }
    if (known) { /* the lanes lie around it */
        const double margin = 0.1 * (value.high - value.low);
        value.low -= margin;
        value.high += margin;
    } else {
        gm_range_round(&value.low, &value.high, GM_LINEAR);
    }
    if (!isnan(profile->low)) {
        value.low = profile->low;
        value.high = profile->high;
    }
    const struct gm_axis axis = {.label = up ? "y" : "x", .low = ends[up], .high = ends[2 + up]};
    panel->axes = true;
    panel->x = up ? value : axis;
    panel->y = up ? axis : value;
    if (known) { /* broader than the lanes, which agree with it */
        gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 0.9, 7, GM_SOLID}, points[count], POINTS,
                     false);
    }
    for (size_t k = 0; k < count; k++) {
        gm_mark_line(picture, panel, gm_lane_style(lanes[k], 1, 2.4), points[k], made[k], false);
        const struct gm_system_item *table;
        for (size_t i = 0; (table = gm_system_item_of(system, GM_WORD_TABLE, i)); i++) {
            const bool here = strcmp(table->words, profile->name) == 0 && quantity == profile->words[0] &&
                              holds(table, lanes[k]->parameters);
            size_t published = 0;
            for (size_t p = 0; here && p < points_of(table) && published < POINTS; p++) {
                double *point = points[count + 1] + 2 * published;
                point[up] = table->options->numbers[2 * p];
                point[1 - up] = table->options->numbers[2 * p + 1];
                published += !isnan(point[1 - up]);
            }
            gm_mark_points(picture, panel, (struct gm_style){.role = GM_INITIAL, .alpha = 1, .width = 5.5},
                           points[count + 1], published);
        }
    }
    const char *caption = gm_room_of(&lanes[0]->problem)->system.texts[GM_WORD_CAPTION];
    picture->caption = caption ? gm_picture_text(picture, "%s", caption) : known ? "Grey, broad: exact." : "";
}

void gm_room_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                           enum gm_place place)
{
    const struct gm_system_item *profile;
    for (size_t i = 0; (profile = gm_system_item_of(&gm_user_room_of(lanes[0]->parameters)->room.system,
                                                    GM_WORD_PROFILE, i));
         i++) {
        for (const char *what = profile->words; *what; what++) {
            draw_profile(picture, lanes, count, place, profile, *what);
        }
    }
}

static void write_sample(const struct gm_view *view, const char *front, const char *name, const double at[2],
                         double reference, FILE *stream)
{
    struct gm_sample s;
    if (!gm_flow_sample(gm_flow_of(view->problem), view->state, at[0], at[1], &s)) {
        return;
    }
    fprintf(stream, "%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,", front, name, at[0], at[1], s.psi, s.u,
            s.v, s.theta, s.omega);
    if (!isnan(reference)) {
        fprintf(stream, "%.17g", reference);
    }
    fputc('\n', stream);
}

void gm_room_write_profiles(const struct gm_view *view, const char *front, FILE *stream)
{
    const struct gm_user_system *system = &gm_user_room_of(view->parameters)->room.system;
    const struct gm_system_item *table, *profile;
    for (size_t i = 0; (table = gm_system_item_of(system, GM_WORD_TABLE, i)); i++) {
        const double *ends = gm_system_item_named(system, GM_WORD_PROFILE, table->words)->options->numbers;
        for (size_t k = 0; holds(table, view->parameters) && k < points_of(table); k++) {
            const double *point = table->options->numbers + 2 * k;
            double at[2] = {ends[0], ends[1]};
            at[along(ends)] = point[0];
            write_sample(view, front, table->name, at, point[1], stream);
        }
    }
    for (size_t i = 0; (profile = gm_system_item_of(system, GM_WORD_PROFILE, i)); i++) {
        const double *ends = profile->options->numbers;
        const size_t count = (size_t)fmin(fmax(ends[4], 2), 1e6);
        const char quantity = profile->words[0];
        for (size_t k = 0; k < count; k++) {
            const double s = (double)k / (double)(count - 1),
                         at[2] = {ends[0] + s * (ends[2] - ends[0]), ends[1] + s * (ends[3] - ends[1])};
            write_sample(view, front, profile->name, at,
                         quantity ? gm_room_exact(view, gm_room_key_of(quantity), at) : NAN, stream);
        }
    }
}
