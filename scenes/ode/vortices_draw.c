/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of point vortices: their positions and paths, tracers, the section, losses. */
#include <math.h>
#include <string.h>

#include "scenes/common/graph.h"
#include "scenes/ode/system/optional.h"
#include "scenes/ode/vortices_draw.h"

/* The greatest distance from the middle that is drawn; the number of vortices from which on a dye shows them,
   and of dyed points from which on the dye is a field. */
static const double farthest = 4;
enum { CROWD = 1000, FIELD = 4000 };

static double reach_of(const struct gm_lane *const *lanes, size_t count)
{
    double reach = 1.15;
    for (size_t i = 0; i < count; i++) {
        const struct gm_vortices *vortices = lanes[i]->parameters;
        const struct gm_entries *past = &lanes[i]->entries[GM_PAST];
        for (size_t k = 0; k < past->count * past->width; k++) {
            const double away = fabs(past->values[k]);
            reach = away < farthest ? fmax(reach, 1.08 * away) : reach;
        }
        reach = vortices->tracers > 0 || vortices->configuration == GM_PATCHES ? fmax(reach, 1.75) : reach;
    }
    /* the scale moves in rare steps, so that a movie is calm */
    return 0.25 * ceil(reach / 0.25 - 1e-9);
}

/* Draws the dye: `many` points, whose x and then y begin at `first` in the state, are dyed if they started
   above the axis. */
static void draw_dye(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                     size_t first, size_t many, double reach)
{
    const double *x = gm_run_state(lane->run) + first, *y = x + many, *dye = lane->start + first + many;
    if (many < FIELD) {
        double *points = gm_picture_memory(picture, 2 * many * sizeof *points);
        for (int dyed = 0; points && dyed < 2; dyed++) {
            size_t count = 0;
            for (size_t k = 0; k < many; k++) {
                if ((dye[k] > 0) == (dyed == 1)) {
                    points[2 * count] = x[k];
                    points[2 * count + 1] = y[k];
                    count++;
                }
            }
            const enum gm_role role = dyed ? gm_lane_role(lane->shown.colour) : GM_SECONDARY;
            gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.8, .width = 2.4},
                           points, count);
        }
        return;
    }
    const size_t side = many < 50000 ? 128 : 256, cells = side * side;
    double *values = gm_picture_memory(picture, cells * sizeof *values);
    double *there = gm_picture_memory(picture, cells * sizeof *there);
    if (!values || !there) {
        return;
    }
    memset(values, 0, cells * sizeof *values);
    memset(there, 0, cells * sizeof *there);
    for (size_t k = 0; k < many; k++) {
        const double column = (x[k] + reach) / (2 * reach) * (double)side,
                     row = (y[k] + reach) / (2 * reach) * (double)side;
        if (column >= 0 && column < (double)side && row >= 0 && row < (double)side) {
            const size_t cell = (size_t)row * side + (size_t)column;
            values[cell] += dye[k] > 0 ? 1 : -1;
            there[cell] += 1;
        }
    }
    for (size_t cell = 0; cell < cells; cell++) {
        values[cell] = there[cell] > 0 ? values[cell] / there[cell] : 0;
    }
    const double corners[] = {-reach, -reach, reach, reach};
    gm_mark_image(picture, panel, GM_MAP_DIVERGING, -1, 1, corners, values, side, side);
}

static void draw_positions(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    const struct gm_vortices *vortices = lane->parameters;
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const struct gm_entries *trail = &lane->entries[GM_TRAIL], *past = &lane->entries[GM_PAST];
    const size_t followed = trail->width / 2, carried = gm_vortices_carried(vortices);
    const bool images = vortices->configuration == GM_REDUCED;
    const size_t past_from = gm_trails_from(vortices->trails, past, lane->run->t),
                 trail_from = gm_trails_from(vortices->trails, trail, lane->run->t);
    const size_t most = past->count > trail->count ? past->count : trail->count;
    const double *state = gm_run_state(lane->run);
    double *points = gm_picture_memory(picture, 2 * (most + carried + 1) * sizeof *points);
    if (!points) {
        return;
    }
    for (int sign = 1; sign >= (images ? -1 : 1); sign -= 2) {
        for (size_t i = 0; i < followed && vortices->tracers == 0; i++) {
            for (size_t k = 0; k < past->count && followed <= 8; k++) {
                points[2 * k] = sign * past->values[k * past->width + 2 * i];
                points[2 * k + 1] = sign * past->values[k * past->width + 2 * i + 1];
            }
            if (followed <= 8) {
                gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.22, .width = 2},
                               points + 2 * past_from, past->count - past_from);
            }
        }
        for (size_t i = 0; i < followed; i++) {
            for (size_t k = 0; k < trail->count; k++) {
                points[2 * k] = sign * trail->values[k * trail->width + 2 * i];
                points[2 * k + 1] = sign * trail->values[k * trail->width + 2 * i + 1];
            }
            points[2 * trail->count] = sign * state[i];
            points[2 * trail->count + 1] = sign * state[carried + i];
            gm_draw_trail(picture, panel, (struct gm_style){role, 0.9, 1.8, GM_SOLID},
                          points + 2 * trail_from, trail->count + 1 - trail_from);
        }
        for (size_t i = 0; i < carried; i++) {
            points[2 * i] = sign * state[i];
            points[2 * i + 1] = sign * state[carried + i];
        }
        const double width = carried <= 16 ? 10 : carried <= 200 ? 6 : 3;
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = width}, points,
                       carried);
    }
}

/* Returns a note on the number of vortices outside of the panel. */
static const char *note_of(struct gm_picture *picture, const struct gm_lane *lane, double reach)
{
    const size_t carried = gm_vortices_carried(lane->parameters);
    const double *state = gm_run_state(lane->run);
    size_t gone = 0;
    for (size_t i = 0; i < carried; i++) {
        gone += fmax(fabs(state[i]), fabs(state[carried + i])) > reach;
    }
    return gone == 0         ? ""
           : gone == carried ? "out of the picture"
                             : gm_picture_text(picture, "%zu of %zu out of the picture", gone, carried);
}

static void draw_plane(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const double reach = reach_of(lanes, count);
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            panel = gm_walk_panel(picture, &walk, note_of(picture, walk.lane, reach));
            panel->x = panel->y = (struct gm_axis){.label = "", .low = -reach, .high = reach};
            panel->equal = true;
        }
        const size_t tracers = walk.lane->problem.passive, active = walk.lane->problem.n - 2 * tracers;
        if (tracers > 0) {
            draw_dye(picture, panel, walk.lane, active, tracers, reach);
        }
        if (active / 2 < CROWD) {
            draw_positions(picture, panel, walk.lane);
        } else if (tracers == 0) {
            draw_dye(picture, panel, walk.lane, 0, active / 2, reach);
        }
    }
}

/* Draws the shift of the radius of vortex 1 since its first section, whenever vortex 2 is a quarter turn
   ahead: on its curve it is constant. */
static void draw_section(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    enum { SHOWN = 700 };
    struct gm_panel *panel =
        gm_panel_add(picture, GM_PLACE_GRAPH, "Poincaré section: shift of the radius r₁");
    panel->axes = true;
    panel->title_role = GM_INK;
    gm_time_axis(&panel->x, lanes, count);
    panel->y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = -1e-6, .high = 1e-6};
    for (size_t i = 0; i < count; i++) {
        const struct gm_entries *section = &lanes[i]->entries[GM_SECTION];
        for (size_t k = 0; k < section->count; k++) {
            if (section->values[k] < 2 * farthest) {
                gm_range_add(&panel->y.low, &panel->y.high, section->values[k] - section->values[0]);
            }
        }
    }
    gm_range_round(&panel->y.low, &panel->y.high, GM_LINEAR);
    double points[2 * SHOWN];
    for (size_t i = 0; i < count; i++) {
        const struct gm_entries *section = &lanes[i]->entries[GM_SECTION];
        const size_t stride = (section->count + SHOWN - 1) / SHOWN;
        size_t shown = 0;
        for (size_t k = 0; stride > 0 && k < section->count && shown < SHOWN; k += stride, shown++) {
            points[2 * shown] = section->times[k];
            points[2 * shown + 1] = section->values[k] - section->values[0];
        }
        gm_mark_points(
            picture, panel,
            (struct gm_style){.role = gm_lane_role(lanes[i]->shown.colour), .alpha = 0.8, .width = 2.6},
            points, shown);
    }
}

static void draw_log(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                     const char *key)
{
    const struct gm_graph graph = {
        .observable = key, .highest = true, .scale = GM_LOG, .calm_low = 1e-15, .calm_high = 1e-2};
    gm_draw_graphs(picture, lanes, count, &graph, 1);
}

/* 35.12 degrees: beyond, the centrally symmetric motion of two-turned vortices is unstable */
static const double threshold = 0.61296;

static const char *caption_of(const struct gm_vortices *vortices)
{
    switch (vortices->configuration) {
    case GM_REDUCED:
        return "With the symmetry built in the motion has one curve to stay on: a symplectic method stays, RK4 leaves it.";
    case GM_TWO_TURNED:
        return fabs(vortices->angle) > threshold
                   ? "Turned by more than 35.12° this motion is unstable: rounding breaks its symmetry under every scheme, "
                     "at about the same time. The published contrast of two schemes is not reproduced here."
                   : "The symmetric motion is stable at this angle; what sets schemes apart is the angular impulse.";
    case GM_ONE_TURNED:
        return "This motion is chaotic itself: only its invariants distinguish schemes.";
    case GM_PATCHES:
        return "Two patches of similar vorticity this near merge: they turn about each other, and what each gives up "
               "is wound into arms.";
    case GM_VORTEX_COLLISION:
        return "A pair this close turns faster than the rest: a step that is too long for it goes wrong without a sound.";
    default:
        return "";
    }
}

void gm_vortices_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    static const char *const starts[] = {"two turned, symmetry built in",
                                         "a regular polygon",
                                         "two of a square turned",
                                         "one of a square turned",
                                         "a random disc",
                                         "a close pair and two more",
                                         "two round patches"};
    const struct gm_vortices *self = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    if (gm_draw_modified(lanes, count, picture)) {
        return;
    }
    bool one_start = true, one_strength = true;
    for (size_t i = 1; i < count; i++) {
        const struct gm_vortices *other = lanes[i]->parameters;
        one_start &= other->configuration == self->configuration && other->angle == self->angle;
        one_strength &= other->strength == self->strength;
    }
    const long vortices = self->configuration == GM_REDUCED ? 4 : self->count;
    const char *number = vortices == 4 ? "Four" : gm_picture_text(picture, "%ld", vortices);
    picture->title = self->tracers > 0 ? gm_picture_text(picture, "%s vortices stir a dye, by %s", number,
                                                         gm_counted_schemes(lanes, count))
                                       : gm_picture_text(picture, "%s vortices, followed by %s", number,
                                                         gm_counted_schemes(lanes, count));
    const bool turned = self->configuration == GM_REDUCED || self->configuration == GM_TWO_TURNED ||
                        self->configuration == GM_ONE_TURNED;
    picture->subtitle = gm_picture_text(
        picture, "%s%s%s%s%s%s", one_start ? starts[self->configuration] : "", one_start ? ",  " : "",
        one_start && turned ? gm_picture_text(picture, "angle %.4g°,  ", self->angle * 180 / M_PI) : "",
        one_strength ? gm_picture_text(picture, "strength %.6g%s", self->strength, one_step ? ",  " : "")
                     : "",
        one_step ? "Δt = " : "", one_step ? gm_step_text(picture, dt) : "");
    picture->caption = one_start ? caption_of(self) : "";
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    draw_plane(picture, lanes, count);
    if (one_start && self->configuration == GM_REDUCED) {
        draw_section(picture, lanes, count);
    }
    if (self->configuration == GM_TWO_TURNED) {
        draw_log(picture, lanes, count, "symmetry_defect");
    }
    if (self->configuration == GM_VORTEX_COLLISION) {
        draw_log(picture, lanes, count, "pair_distance_error");
    }
    if (self->configuration == GM_SQUARE && self->tracers == 0) {
        draw_log(picture, lanes, count, "position_error");
    }
    if (self->configuration == GM_RANDOM || self->configuration == GM_PATCHES ||
        self->configuration == GM_ONE_TURNED) {
        draw_log(picture, lanes, count, "energy_error");
    }
    draw_log(picture, lanes, count, "angular_impulse_error");
}
