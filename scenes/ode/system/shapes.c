/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shapes of a disc of members. If these carry two tangents, the arc between two of them is a cubic. */
#include "core/functions/functions.h"
#include "scenes/ode/system/parts.h"

#include <math.h>

enum {
    DRAWN = 1024,    /* most points of a curved edge */
    TURN = 12,       /* earlier shapes: older ones have faded */
    MOST_TURNS = 16, /* most turns of an angle in one outline */
    MOST_DOTS = 64   /* most members that are drawn as dots on their curved edge */
};

bool gm_system_is_disc(const struct gm_lane *lane, const struct gm_sight *sight)
{
    const struct gm_system_lane *own = lane->parameters;
    const struct gm_system_scene *system_scene = own->owner;
    return lane->problem.m > 3 && own->shape == GM_SHAPE_DISC &&
           gm_system_motion(&system_scene->system) == 2 &&
           sight->components[0] == (long)system_scene->disc[0] &&
           sight->components[1] == (long)system_scene->disc[1] && !sight->angles[1];
}

static double turn_of(double angle)
{
    return round(angle / (2 * M_PI));
}

/* Returns true if every angle of an outline is at most pi from the next one; beyond that, the arc between
   them is not known. */
static bool is_known(const double *angles, size_t stride, size_t count)
{
    bool known = true;
    for (size_t i = 0; i < count; i++) {
        known = known && fabs(angles[i * stride] - angles[(i + 1) % count * stride]) <= M_PI;
    }
    return known;
}

/* Returns the members' derivatives of a component over the start of another one, by the tangents that a plane's
   members carry. */
static const double *tangent_of(const struct gm_view *view, size_t component, size_t start)
{
    return view->state +
           gm_system_component(&gm_system_scene_of(view)->system, component > 0, start > 0 ? 2 : 1) *
               view->problem->m;
}

/* Writes the edge as pairs, `pieces` for each member: on a cubic between two members whose ends have the
   derivatives M d(start)/d(angle), M the tangent map that each member carries. */
static void put_edge(const struct gm_lane *lane, size_t pieces, double *points)
{
    const struct gm_system_lane *own = lane->parameters;
    const struct gm_view view = gm_lane_view(lane);
    const size_t m = lane->problem.m, members = m - 1, *disc = own->owner->disc;
    const double turn = 2 * M_PI / (double)members, step = turn * own->spread;
    for (size_t i = 0; i < members * pieces; i++) {
        const size_t from = i / pieces, to = (from + 1) % members;
        const double s = (double)(i % pieces) / (double)pieces, r = 1 - s;
        const double a = turn * (double)from, b = turn * (double)to;
        for (size_t k = 0; k < 2; k++) {
            const double *y = view.state + disc[k] * m;
            points[2 * i + k] = y[from];
            if (s > 0) {
                const double *along_x = tangent_of(&view, disc[k], disc[0]),
                             *along_y = tangent_of(&view, disc[k], disc[1]);
                const double leave = gm_cos(a) * along_y[from] - gm_sin(a) * along_x[from],
                             arrive = gm_cos(b) * along_y[to] - gm_sin(b) * along_x[to];
                points[2 * i + k] = r * r * (1 + 2 * s) * y[from] + s * s * (3 - 2 * s) * y[to] +
                                    s * r * step * (r * leave - s * arrive);
            }
        }
    }
}

/* Draws an outline and its inside, for angles once for each turn, in the part that the panel shows, so that
   no line crosses it. Points show an outline that is not known. */
static void draw_outline(struct gm_picture *picture, struct gm_panel *panel, const struct gm_style styles[2],
                         const double *points, size_t count)
{
    double first = 0, last = 0;
    for (size_t i = 0; i < count && panel->x.scale == GM_PI; i++) {
        first = i > 0 ? fmin(first, turn_of(points[2 * i])) : turn_of(points[0]);
        last = i > 0 ? fmax(last, turn_of(points[2 * i])) : first;
    }
    double *shown = gm_picture_memory(picture, 2 * count * sizeof *shown);
    const bool known = (first == 0 && last == 0) || (is_known(points, 2, count) && last - first < MOST_TURNS);
    for (double turn = first; turn <= (known ? last : first); turn++) {
        for (size_t i = 0; i < count; i++) {
            shown[2 * i] = points[2 * i] - 2 * M_PI * (known ? turn : turn_of(points[2 * i]));
            shown[2 * i + 1] = points[2 * i + 1];
        }
        if (known) {
            gm_mark_polygon(picture, panel, styles[0], shown, count);
            gm_mark_line(picture, panel, styles[1], shown, count, true);
        } else {
            gm_mark_points(picture, panel, (struct gm_style){styles[1].role, styles[1].alpha, 2, GM_SOLID},
                           shown, count);
        }
    }
}

void gm_system_draw_shapes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    const struct gm_system_lane *own = lane->parameters;
    const struct gm_entries *shapes = &lane->entries[GM_TRACK_SHAPES];
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const size_t corners = shapes->width / 2, oldest = shapes->count > TURN ? shapes->count - TURN : 1,
                 members = lane->problem.m - 1;
    for (size_t i = oldest; i < shapes->count; i++) {
        const double fresh = (double)(i + 1 - oldest) / (double)(shapes->count - oldest);
        const struct gm_style styles[] = {{.role = role, .alpha = 0.03 + 0.2 * fresh},
                                          {role, 0.15 + 0.6 * fresh, 1.1, GM_SOLID}};
        if (shapes->times[i] != lane->run->t) {
            draw_outline(picture, panel, styles, shapes->values + i * shapes->width, corners);
        }
    }
    draw_outline(
        picture, panel,
        (const struct gm_style[]){{.role = GM_INITIAL, .alpha = 0.14}, {GM_INITIAL, 0.9, 1.6, GM_SOLID}},
        shapes->values, corners);
    /* a linear map of a polygon is a polygon */
    const bool curved = own->owner->system.tangents >= 2 && !gm_ode_of(&lane->problem)->linear &&
                        members < DRAWN &&
                        is_known(gm_run_state(lane->run) + own->owner->disc[0] * lane->problem.m, 1, members);
    const size_t pieces = curved ? DRAWN / members : 1;
    double *points = gm_picture_memory(picture, 2 * pieces * members * sizeof *points);
    if (lane->run->t == lane->t0) {
        return;
    }
    put_edge(lane, pieces, points);
    draw_outline(picture, panel,
                 (const struct gm_style[]){{.role = role, .alpha = 0.42}, {role, 1, 2.4, GM_SOLID}}, points,
                 pieces * members);
    if (pieces > 1 && members <= MOST_DOTS) {
        for (size_t i = 0; i < members; i++) {
            const double x = points[2 * i * pieces];
            points[2 * i] = panel->x.scale == GM_PI ? x - 2 * M_PI * turn_of(x) : x;
            points[2 * i + 1] = points[2 * i * pieces + 1];
        }
        gm_mark_points(picture, panel, (struct gm_style){role, 1, 5, GM_SOLID}, points, members);
    }
}
