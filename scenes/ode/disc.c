/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A disc of initial conditions in the phase plane, carried by a scheme: Liouville's theorem made visible.
       oscillator   H = p^2/2 + q^2/2        pendulum   H = p^2/2 - cos q
   The exact flow preserves the disc's area. What to look at: the area, which explicit schemes blow up,
   implicit ones shrink and symplectic ones preserve, whatever the step; and the energy error, which stays
   bounded for them.

   Razafindralandy, Hamdouni & Chhay (2018), section "Harmonic oscillator":
       figures 1, 2   the area and the energy error of explicit and implicit Euler
       figures 4, 5   the same of symplectic Euler and of the midpoint rule

   The members of the ensemble are the points of the disc's edge and, last, its centre. Every member carries
   two tangent vectors: they give the edge's derivative, and so its area without the coarseness of a polygon;
   their mean determinant is the area's factor; and the edge between two points is drawn as the cubic that they
   give. */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/linear/curve.h"
#include "core/ode/problems/problems.h"
#include "scenes/common/graph.h"
#include "scenes/ode/asked.h"

enum { Q, XI_1, XI_2, P, ETA_1, ETA_2, COMPONENTS };
enum { OSCILLATOR, PENDULUM };
enum { SHOW_ALL, SHOW_DISC, SHOW_ENERGY };
enum { ENERGY_ERROR = 4 /* index of an observable */ };
enum {
    DRAWN = 1024,     /* most points of a drawn edge */
    REMEMBERED = 256, /* points of an earlier shape */
    TURN = 12,        /* shapes per period of the oscillator: older ones have faded */
    MOST_TURNS = 16,  /* most turns of the pendulum in one outline */
};

struct disc {
    struct gm_timing timing;
    int system;
    long points;
    double radius, q0, p0;
    int show;
};

static const char *const systems[] = {"oscillator", "pendulum", NULL};
static const char *const shows[] = {"all", "disc", "energy", GM_SHOW_MODIFIED, NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("pi/12", 1e-6, 100),
    GM_UNTIL("3*pi/2"),
    GM_CHOICE_ROW(struct disc, system, "system", "oscillator", systems, "H = p²/2 + q²/2 or p²/2 − cos q"),
    GM_INTEGER_ROW(struct disc, points, "points", "256", 3, 1e6, "points on the edge of the disc",
                   .logarithmic = true),
    GM_REAL_ROW(struct disc, radius, "radius", "0.2", 1e-6, 100, "radius of the disc", .logarithmic = true),
    GM_REAL_ROW(struct disc, q0, "q0", "0", -100, 100, "position of its centre"),
    GM_REAL_ROW(struct disc, p0, "p0", "1", -100, 100, "momentum of its centre"),
    GM_CHOICE_ROW(struct disc, show, "show", "all", shows,
                  "what the picture shows: all, the disc alone, the energy error alone, or errors of the "
                  "modified energy",
                  .live = true),
};

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct disc *disc = self;
    *problem = disc->system == PENDULUM ? gm_problem_pendulum_tangent : gm_problem_oscillator_tangent;
    problem->m = (size_t)disc->points + 1;
    return true;
}

static double angle(const struct disc *disc, size_t point)
{
    return 2 * M_PI * (double)point / (double)disc->points;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    const struct disc *disc = self;
    const size_t m = problem->m;
    for (size_t i = 0; i < m; i++) {
        const double radius = i + 1 < m ? disc->radius : 0;
        y[Q * m + i] = disc->q0 + radius * cos(angle(disc, i));
        y[P * m + i] = disc->p0 + radius * sin(angle(disc, i));
        y[XI_1 * m + i] = 1;
        y[ETA_1 * m + i] = 0;
        y[XI_2 * m + i] = 0;
        y[ETA_2 * m + i] = 1;
    }
}

/* Returns the disc's area, from its centre so that little cancels; the tangent map M turns the start's edge
   into the current one. */
static double area(const struct gm_view *view)
{
    const size_t m = view->problem->m, points = m - 1;
    const double *y = view->state, *q = view->start + Q * m, *p = view->start + P * m;
    double complex *edge = malloc(2 * points * sizeof *edge); /* the edge, then its derivatives */
    for (size_t i = 0; edge && i < points; i++) {
        const double dq = p[points] - p[i], dp = q[i] - q[points];
        edge[i] = y[Q * m + i] - y[Q * m + points] + I * (y[P * m + i] - y[P * m + points]);
        edge[points + i] =
            y[XI_1 * m + i] * dq + y[XI_2 * m + i] * dp + I * (y[ETA_1 * m + i] * dq + y[ETA_2 * m + i] * dp);
    }
    const double value = edge ? gm_curve_area(edge, edge + points, points) : NAN;
    free(edge);
    return value;
}

static double area_tangent(const struct gm_view *view)
{
    const size_t m = view->problem->m;
    const double *y = view->state;
    double sum = 0;
    for (size_t i = 0; i < m; i++) {
        sum += y[XI_1 * m + i] * y[ETA_2 * m + i] - y[XI_2 * m + i] * y[ETA_1 * m + i];
    }
    return sum / (double)m;
}

static double energy_at(int system, double q, double p)
{
    return p * p / 2 + (system == PENDULUM ? -cos(q) : q * q / 2);
}

static double energy(const struct gm_view *view)
{
    const struct disc *disc = view->parameters;
    const size_t m = view->problem->m;
    return energy_at(disc->system, view->state[Q * m + m - 1], view->state[P * m + m - 1]);
}

/* The pendulum's energy passes zero; the oscillator's is the square of its amplitude. */
static double natural_energy(const struct gm_view *view)
{
    return ((const struct disc *)view->parameters)->system == PENDULUM ? 1 : 0;
}

static const struct gm_observable observables[] = {
    GM_OBSERVABLE("area", area, "area", .missing = GM_UNRESOLVED_EDGE),
    GM_KEPT_OBSERVABLE("area_error", area, "A", "area error", .missing = GM_UNRESOLVED_EDGE),
    GM_OBSERVABLE("area_tangent", area_tangent,
                  "determinant of the tangent map, mean over the edge and the centre"),
    GM_OBSERVABLE("energy", energy, "energy of the centre"),
    [ENERGY_ERROR] = GM_KEPT_OBSERVABLE("energy_error", energy, "H", "energy error", .scale = natural_energy,
                                        .scale_text = "1 for the pendulum"),
};

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

/* Writes the edge as points to draw, at most `most`. On the pendulum the arc between two members is a cubic
   with the tangents M d(start)/d(angle), M the tangent map that each member carries, where all are near
   enough to their neighbours; `refined` is the number of points drawn for each member. */
static size_t edge(const struct gm_view *view, size_t most, double *points, size_t *refined)
{
    const struct disc *disc = view->parameters;
    const size_t m = view->problem->m, members = m - 1;
    const double *y = view->state;
    const size_t stride = (members + most - 1) / most;
    const bool curved = disc->system == PENDULUM && stride == 1 && is_known(y + Q * m, 1, members);
    const size_t pieces = curved ? most / members : 1;
    size_t count = 0;
    for (size_t i = 0; i < members; i += stride) {
        const size_t next = i + 1 < members ? i + 1 : 0;
        const double step = angle(disc, 1) * disc->radius;
        for (size_t k = 0; k < pieces; k++) {
            const double s = (double)k / (double)pieces;
            for (size_t half = 0; half < 2; half++) {
                const size_t at = half ? P : Q, first = half ? ETA_1 : XI_1, second = half ? ETA_2 : XI_2;
                double value = y[at * m + i];
                if (k > 0) {
                    const double a = angle(disc, i), b = angle(disc, next), end = y[at * m + next];
                    const double leave = step * (cos(a) * y[second * m + i] - sin(a) * y[first * m + i]);
                    const double arrive =
                        step * (cos(b) * y[second * m + next] - sin(b) * y[first * m + next]);
                    const double r = 1 - s;
                    value = r * r * (1 + 2 * s) * value + s * s * (3 - 2 * s) * end +
                            s * r * (r * leave - s * arrive);
                }
                points[2 * count + half] = value;
            }
            count++;
        }
    }
    *refined = pieces;
    return count;
}

static size_t remembered(const struct gm_view *view)
{
    const size_t members = view->problem->m - 1;
    const size_t stride = (members + REMEMBERED - 1) / REMEMBERED;
    return 2 * ((members + stride - 1) / stride);
}

static void remember(const struct gm_view *view, double *entry)
{
    const size_t m = view->problem->m, members = m - 1;
    const size_t stride = (members + REMEMBERED - 1) / REMEMBERED;
    for (size_t i = 0; i < members; i += stride, entry += 2) {
        entry[0] = view->state[Q * m + i];
        entry[1] = view->state[P * m + i];
    }
}

static const struct gm_track tracks[] = {
    {.key = "shapes", .width = remembered, .every = M_PI / 6, .bound = 96, .record = remember},
};

/* Draws the centre's exact orbit: the level line of its energy, as one or two polylines. */
static void draw_orbit(struct gm_picture *picture, struct gm_panel *panel, const struct disc *disc)
{
    enum { ORBIT = 256 };
    const struct gm_style style = {GM_EXACT, 0.9, 1.2, GM_SHORT_DASH};
    const double level = energy_at(disc->system, disc->q0, disc->p0);
    double points[2 * ORBIT];
    if (disc->system == OSCILLATOR || level < 1) {
        const double widest = disc->system == OSCILLATOR ? sqrt(2 * level) : acos(-level);
        for (size_t i = 0; i < ORBIT; i++) {
            const double turn = 2 * M_PI * (double)i / ORBIT;
            const double q = widest * sin(turn);
            const double kinetic = disc->system == OSCILLATOR ? level - q * q / 2 : level + cos(q);
            points[2 * i] = q;
            points[2 * i + 1] = copysign(sqrt(2 * fmax(kinetic, 0)), cos(turn));
        }
        gm_mark_line(picture, panel, style, points, ORBIT, true);
        return;
    }
    for (size_t i = 0; i < ORBIT; i++) {
        const double q = panel->x.low + (panel->x.high - panel->x.low) * (double)i / (ORBIT - 1);
        points[2 * i] = q;
        points[2 * i + 1] = copysign(sqrt(2 * (level + cos(q))), disc->p0);
    }
    gm_mark_line(picture, panel, style, points, ORBIT, false);
}

/* Returns a bound that moves outwards in steps of a tenth. */
static double calm(double value)
{
    const double size = fmax(fabs(value), 1e-9);
    return copysign(pow(1.1, ceil(log(size) / log(1.1) - 1e-9)), value);
}

static void hold(struct gm_axis *x, struct gm_axis *y, const double *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gm_range_add(&x->low, &x->high, points[2 * i]);
        gm_range_add(&y->low, &y->high, points[2 * i + 1]);
    }
}

/* A lane farther than this multiple of the exact motion no longer sets the scale of others. */
static const double farthest = 4;

static bool has_left(const struct gm_lane *lane)
{
    const struct disc *disc = lane->parameters;
    const size_t m = lane->problem.m;
    const double level = energy_at(disc->system, disc->q0, disc->p0);
    const double reach =
        farthest * (sqrt(2 * (disc->system == OSCILLATOR ? level : level + 1)) + disc->radius);
    const double *state = gm_run_state(lane->run);
    bool left = false;
    for (size_t i = 0; i < m; i++) {
        left |=
            fabs(state[P * m + i]) > reach || (disc->system == OSCILLATOR && fabs(state[Q * m + i]) > reach);
    }
    return left;
}

/* Sets the range of all lanes on one scale, except those that have left; or of those in one `panel`, which
   have all left. The pendulum's angle counts modulo 2 pi: a lane that has come around shows all of the
   circle. */
static void state_range(const struct gm_lane *const *lanes, size_t count, const size_t *panel,
                        struct gm_axis *x, struct gm_axis *y)
{
    const struct disc *disc = lanes[0]->parameters;
    *x = *y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = 1, .high = 0};
    x->scale = disc->system == PENDULUM ? GM_PI : GM_LINEAR;
    const double level = energy_at(disc->system, disc->q0, disc->p0);
    if (!panel && (disc->system == OSCILLATOR || level < 1)) {
        const double wide = disc->system == OSCILLATOR ? sqrt(2 * level) : acos(-level);
        const double tall = disc->system == OSCILLATOR ? wide : sqrt(2 * (level + 1));
        const double corners[] = {-wide, -tall, wide, tall};
        hold(x, y, corners, 2);
    }
    for (size_t i = 0; i < count; i++) {
        if (panel ? lanes[i]->shown.panel != *panel : has_left(lanes[i])) {
            continue;
        }
        const struct gm_entries *shapes = &lanes[i]->entries[0];
        hold(x, y, shapes->values, shapes->count * shapes->width / 2);
        const struct gm_view view = gm_lane_view(lanes[i]);
        const size_t m = view.problem->m;
        for (size_t k = 0; k < m; k++) {
            gm_range_add(&x->low, &x->high, view.state[Q * m + k]);
            gm_range_add(&y->low, &y->high, view.state[P * m + k]);
        }
    }
    const double reach = fmax(disc->radius, 1e-6);
    const bool around = disc->system == PENDULUM && (x->low < -M_PI || x->high > M_PI);
    x->low = calm(x->low - 0.1 * reach);
    x->high = calm(x->high + 0.1 * reach);
    y->low = calm(y->low - 0.1 * reach);
    y->high = calm(y->high + 0.1 * reach);
    if (around) {
        x->low = -M_PI;
        x->high = M_PI;
    }
}

/* Draws an outline and its inside, for angles once for each turn, in the part that the panel shows, so that
   no line crosses it. Points show an outline that is not known. */
static void draw_shape(struct gm_picture *picture, struct gm_panel *panel, struct gm_style fill,
                       struct gm_style line, const double *points, size_t count)
{
    double first = 0, last = 0;
    for (size_t i = 0; i < count && panel->x.scale == GM_PI; i++) {
        first = i > 0 ? fmin(first, turn_of(points[2 * i])) : turn_of(points[0]);
        last = i > 0 ? fmax(last, turn_of(points[2 * i])) : first;
    }
    if (first == 0 && last == 0) {
        gm_mark_polygon(picture, panel, fill, points, count);
        gm_mark_line(picture, panel, line, points, count, true);
        return;
    }
    double *shown = gm_picture_memory(picture, 2 * count * sizeof *shown);
    const bool known = is_known(points, 2, count) && last - first < MOST_TURNS;
    for (double turn = first; shown && turn <= (known ? last : first); turn++) {
        for (size_t i = 0; i < count; i++) {
            shown[2 * i] = points[2 * i] - 2 * M_PI * (known ? turn : turn_of(points[2 * i]));
            shown[2 * i + 1] = points[2 * i + 1];
        }
        if (known) {
            gm_mark_polygon(picture, panel, fill, shown, count);
            gm_mark_line(picture, panel, line, shown, count, true);
        } else {
            gm_mark_points(picture, panel, (struct gm_style){line.role, line.alpha, 2, GM_SOLID}, shown,
                           count);
        }
    }
}

static void draw_lane(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    const struct gm_entries *shapes = &lane->entries[0];
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const size_t corners = shapes->width / 2;
    const bool at_start = lane->run->t == lane->t0;
    const size_t oldest = shapes->count > TURN ? shapes->count - TURN : 1;
    for (size_t i = oldest; i < shapes->count; i++) {
        const double *shape = shapes->values + i * shapes->width;
        if (shapes->times[i] == lane->run->t) {
            continue;
        }
        const double fresh = (double)(i + 1 - oldest) / (double)(shapes->count - oldest);
        draw_shape(picture, panel, (struct gm_style){.role = role, .alpha = 0.03 + 0.2 * fresh},
                   (struct gm_style){role, 0.15 + 0.6 * fresh, 1.1, GM_SOLID}, shape, corners);
    }
    draw_shape(picture, panel, (struct gm_style){.role = GM_INITIAL, .alpha = 0.14},
               (struct gm_style){GM_INITIAL, 0.9, 1.6, GM_SOLID}, shapes->values, corners);
    if (at_start) {
        return;
    }
    double *points = gm_picture_memory(picture, 2 * DRAWN * sizeof *points);
    if (!points) {
        return;
    }
    const struct gm_view view = gm_lane_view(lane);
    size_t refined = 1;
    const size_t count = edge(&view, DRAWN, points, &refined);
    draw_shape(picture, panel, (struct gm_style){.role = role, .alpha = 0.42},
               (struct gm_style){role, 1, 2.4, GM_SOLID}, points, count);
    /* a few members are drawn as dots on the interpolated edge */
    const size_t members = count / refined;
    if (refined > 1 && members <= 64) {
        for (size_t i = 0; i < members; i++) {
            const double q = points[2 * i * refined];
            points[2 * i] = panel->x.scale == GM_PI ? q - 2 * M_PI * turn_of(q) : q;
            points[2 * i + 1] = points[2 * i * refined + 1];
        }
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 5}, points,
                       members);
    }
}

static void draw_states(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    struct gm_axis x, y;
    state_range(lanes, count, NULL, &x, &y);
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            const struct gm_view view = gm_lane_view(walk.lane);
            struct gm_view before = view;
            before.state = view.start;
            const double factor = area(&view) / area(&before);
            panel = gm_walk_panel(picture, &walk,
                                  isnan(factor) ? "edge not resolved"
                                                : gm_picture_text(picture, "area × %.3f", factor));
            panel->x = x;
            panel->y = y;
            if (gm_walk_has_left(&walk, has_left)) {
                state_range(lanes, count, &walk.panel, &panel->x, &panel->y);
            }
            panel->equal = panel->x.low != -M_PI || panel->x.high != M_PI;
            draw_orbit(picture, panel, walk.lane->parameters);
        }
        draw_lane(picture, panel, walk.lane);
    }
}

/* The point becomes the centre of the disc. */
static size_t point(const void *self, double x, double y, struct gm_choice *choices)
{
    (void)self;
    gm_choose(&choices[0], "q0", x);
    gm_choose(&choices[1], "p0", y);
    return 2;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct disc *disc = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    picture->title = gm_picture_text(picture, "%s, carried by %s",
                                     disc->show == SHOW_ENERGY ? "The energy of the disc’s centre"
                                                               : "A disc of initial conditions",
                                     gm_counted_schemes(lanes, count));
    picture->subtitle =
        gm_picture_text(picture, "%s%s%s%s", disc->system == PENDULUM ? "pendulum" : "harmonic oscillator",
                        one_step ? ",  Δt = " : "", one_step ? gm_step_text(picture, dt) : "",
                        disc->show == SHOW_ENERGY ? "" : ",  shapes every π/6");
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    if (disc->show != SHOW_ENERGY) {
        draw_states(picture, lanes, count);
    }
    if (disc->show == SHOW_ALL) {
        const struct gm_graph area_ratio = {.observable = "area",
                                            .title = "area / initial area",
                                            .relative = true,
                                            .scale = GM_LOG,
                                            .calm_low = 0.5,
                                            .calm_high = 2};
        gm_draw_graphs(picture, lanes, count, &area_ratio, 1);
    }
    struct gm_graph error = {.observable = "energy_error", .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 1};
    if (disc->show == SHOW_ALL) {
        gm_draw_graphs(picture, lanes, count, &error, 1);
    }
    if (disc->show != SHOW_ENERGY) {
        return;
    }
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            error.title = gm_picture_text(picture, "%s: %s", gm_lane_title(walk.lane),
                                          gm_error_title(picture, lanes, count, ENERGY_ERROR));
            error.panel_of = walk.lane;
            error.named = true;
            gm_draw_graphs(picture, lanes, count, &error, 1);
        }
    }
}

static const char *const schemes[] = {"explicit-euler",
                                      "implicit-euler",
                                      "symplectic-euler",
                                      "midpoint",
                                      "verlet",
                                      "rk2",
                                      "rk4",
                                      "gauss4",
                                      "rk4sym",
                                      NULL};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-1",
        .statement =
            "the area increases drastically with the explicit and decreases with the implicit scheme",
        .arguments = "scheme=explicit-euler,implicit-euler dt=pi/12 until=3*pi/2 show=disc",
    },
    {
        .name = "razafindralandy-2",
        .statement = "even with a step of 0.02 the relative error on the energy is 10 % at t = 5",
        .arguments = "scheme=explicit-euler,implicit-euler dt=0.1,0.06,0.02 until=5 show=energy",
    },
    {
        .name = "razafindralandy-4",
        .statement = "symplectic Euler deforms the disc, the midpoint rule does not; both preserve its area",
        .arguments = "scheme=symplectic-euler,midpoint dt=pi/12 until=3*pi/2 show=disc",
    },
    {
        .name = "razafindralandy-5",
        .statement =
            "the energy error of symplectic Euler is bounded, that of the midpoint rule is round-off",
        .arguments = "scheme=symplectic-euler,midpoint dt=0.1,0.06,0.02 until=60 show=energy",
    },
    {
        .name = "razafindralandy-5-euler",
        .statement = "the energy error of symplectic Euler is much smaller than those of the other two",
        .arguments = "scheme=symplectic-euler,explicit-euler,implicit-euler dt=0.1,0.06,0.02 until=5,60 "
                     "show=energy",
    },
};

const struct gm_scene gm_scene_disc = {
    .name = "disc",
    .title = "A disc of initial conditions",
    .blurb =
        "A disc in the phase plane of an oscillator or a pendulum, carried by a scheme. The exact flow preserves "
        "its area (Liouville); a symplectic scheme does so too, whatever its step.",
    .watch = "Watch the area: a symplectic map may shear the disc, but it never grows.",
    .time = "1/2π of the oscillator’s period; of the pendulum √(l/g), 1/2π of the period of a small swing",
    .size = sizeof(struct disc),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    GM_ASKED_OF_HAMILTONIAN,
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .no_stability = "the limit of an oscillator depends on dt alone; stability --region SCHEME shows it",
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
