/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts through a room: drawn with exact and published values, and written as rows of numbers. */
#include "scenes/flow/look.h"

#include <math.h>
#include <string.h>

#include "scenes/common/graph.h"

/* Returns true if published points hold for a lane's parameters. */
static bool holds(const struct gm_room_table *table, const struct gm_flows *flows)
{
    return strcmp(flows->mesh, "none") == 0 && gm_parameter_get(table->row, flows) == table->item->value;
}

/* Returns the coordinate that runs along a profile: 0, or 1 if it is steeper. */
static int along(const struct gm_room_profile *profile)
{
    return fabs(profile->b[1] - profile->a[1]) >= fabs(profile->b[0] - profile->a[0]);
}

static void draw_profile(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         enum gm_place place, const struct gm_room_profile *profile, char quantity)
{
    enum { POINTS = 97 };
    const struct gm_user_room *user_room = gm_user_room_of(lanes[0]->parameters);
    const int up = along(profile);
    double at[2 * POINTS], (*points)[2 * POINTS] = gm_picture_memory(picture, (count + 2) * sizeof *points);
    size_t *made = gm_picture_memory(picture, count * sizeof *made);
    if (!points || !made) {
        return;
    }
    struct gm_panel *panel = gm_panel_add(picture, place, "");
    struct gm_axis value = {.label = profile->item->text ? profile->item->text
                                     : quantity == 's'   ? "θ"
                                     : quantity == 'v'   ? "v"
                                                         : "u",
                            .low = 1,
                            .high = 0};
    for (size_t i = 0; i < POINTS; i++) {
        for (size_t c = 0; c < 2; c++) {
            at[2 * i + c] = profile->a[c] + (profile->b[c] - profile->a[c]) * (double)i / (POINTS - 1);
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
    if (!known) {
        gm_range_round(&value.low, &value.high, GM_LINEAR);
    }
    if (!isnan(profile->item->low)) {
        value.low = profile->item->low;
        value.high = profile->item->high;
    }
    const struct gm_axis axis = {.label = up ? "y" : "x", .low = profile->a[up], .high = profile->b[up]};
    panel->axes = true;
    panel->x = up ? value : axis;
    panel->y = up ? axis : value;
    if (known) { /* broader than the lanes, which agree with it */
        gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 0.9, 7, GM_SOLID}, points[count], POINTS,
                     false);
    }
    for (size_t k = 0; k < count; k++) {
        gm_mark_line(picture, panel, gm_lane_style(lanes[k], 1, 2.4), points[k], made[k], false);
        for (size_t i = 0; i < user_room->table_count; i++) {
            const struct gm_room_table *table = &user_room->tables[i];
            size_t published = 0;
            for (size_t p = 0; table->profile == profile && quantity == profile->item->words[0] &&
                               holds(table, lanes[k]->parameters) && p < table->count && published < POINTS;
                 p++) {
                double *point = points[count + 1] + 2 * published;
                point[up] = table->points[2 * p];
                point[1 - up] = table->points[2 * p + 1];
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
    const struct gm_user_room *user_room = gm_user_room_of(lanes[0]->parameters);
    for (size_t i = 0; i < user_room->profile_count; i++) {
        for (const char *what = user_room->profiles[i].item->words; *what; what++) {
            draw_profile(picture, lanes, count, place, &user_room->profiles[i], *what);
        }
    }
}

static void write_sample(const struct gm_view *view, const char *front, const char *name, double x, double z,
                         double reference, FILE *stream)
{
    struct gm_sample s;
    if (!gm_flow_sample(gm_flow_of(view->problem), view->state, x, z, &s)) {
        return;
    }
    fprintf(stream, "%s,%s,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,", front, name, x, z, s.psi, s.u, s.v,
            s.theta, s.omega);
    if (!isnan(reference)) {
        fprintf(stream, "%.17g", reference);
    }
    fputc('\n', stream);
}

void gm_room_write_profiles(const struct gm_view *view, const char *front, FILE *stream)
{
    const struct gm_user_room *user_room = gm_user_room_of(view->parameters);
    for (size_t i = 0; i < user_room->table_count; i++) {
        const struct gm_room_table *table = &user_room->tables[i];
        const struct gm_room_profile *profile = table->profile;
        for (size_t k = 0; holds(table, view->parameters) && k < table->count; k++) {
            double at[2] = {profile->a[0], profile->a[1]};
            at[along(profile)] = table->points[2 * k];
            write_sample(view, front, table->item->name, at[0], at[1], table->points[2 * k + 1], stream);
        }
    }
    for (size_t i = 0; i < user_room->profile_count; i++) {
        const struct gm_room_profile *profile = &user_room->profiles[i];
        const char quantity = profile->item->words[0];
        for (size_t k = 0; k < profile->count; k++) {
            const double s = (double)k / (double)(profile->count - 1),
                         at[2] = {profile->a[0] + s * (profile->b[0] - profile->a[0]),
                                  profile->a[1] + s * (profile->b[1] - profile->a[1])};
            write_sample(view, front, profile->item->name, at[0], at[1],
                         quantity ? gm_room_exact(view, gm_room_key_of(quantity), at) : NAN, stream);
        }
    }
}
