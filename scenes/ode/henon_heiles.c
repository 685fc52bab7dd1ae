/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A star in a galaxy's plane, after Henon & Heiles (Astron. J. 69 (1964) 73):
       H = (|p|^2 + |q|^2)/2 + q1^2 q2 - q2^3/3
   An orbit starts in the section q1 = 0, p1 > 0 at (q2, p2); p1 follows from the energy. What to look at: the
   points (q2, p2) where it comes through that section. They lie on a curve if the orbit is quasi-periodic and
   fill an area if it is chaotic, as more and more are from the energy 1/12 over 1/8 to 1/6; a scheme that is
   not symplectic thickens curves. It reproduces no figure of the documents; it is the classic. */
#include <math.h>

#include "core/ode/problems/problems.h"
#include "scenes/common/graph.h"
#include "scenes/ode/asked.h"
#include "scenes/ode/hamiltonian.h"

enum { Q1, Q2, P1, P2 };
enum { CROSSINGS = 1 << 14 };

struct henon_heiles {
    struct gm_timing timing;
    double energy, q2, p2;
    int show;
};

static const struct gm_parameter parameters[] = {
    GM_DT("0.1", 1e-7, 10),
    GM_UNTIL("20000"),
    GM_REAL_ROW(struct henon_heiles, energy, "energy", "1/12", 1e-6, 1. / 6,
                "1/12: nearly all orbits are regular; 1/8: part of them; 1/6: nearly none (escape beyond)"),
    GM_REAL_ROW(struct henon_heiles, q2, "q2", "0.1", -0.5, 1,
                "start in the section: q1 = 0, p1 > 0 follows from the energy"),
    GM_REAL_ROW(struct henon_heiles, p2, "p2", "0.1", -0.6, 0.6, "start in the section"),
    GM_SHOW_ROW(struct henon_heiles),
};

static double potential(double q1, double q2)
{
    return (q1 * q1 + q2 * q2) / 2 + q1 * q1 * q2 - q2 * q2 * q2 / 3;
}

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    const struct henon_heiles *orbit = self;
    if (!(orbit->energy - potential(0, orbit->q2) - orbit->p2 * orbit->p2 / 2 >= 0)) {
        return gm_refuse(sentence, "with the energy %.4g there is no orbit through q2=%.4g, p2=%.4g",
                         orbit->energy, orbit->q2, orbit->p2);
    }
    *problem = gm_problem_henon_heiles;
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    (void)problem;
    const struct henon_heiles *orbit = self;
    y[Q1] = 0;
    y[Q2] = orbit->q2;
    y[P2] = orbit->p2;
    y[P1] = sqrt(2 * (orbit->energy - potential(0, orbit->q2)) - orbit->p2 * orbit->p2);
}

static const struct gm_observable observables[] = {
    GM_KEPT_OBSERVABLE("energy_error", gm_hamiltonian_energy, "H", "energy error"),
};

static double first_coordinate(const struct gm_view *view)
{
    return view->state[Q1];
}

static void record_crossing(const struct gm_view *view, double *entry)
{
    entry[0] = view->state[Q2];
    entry[1] = view->state[P2];
}

static const struct gm_track tracks[] = {
    {.key = "section",
     .numbers = 2,
     .section = first_coordinate,
     .bound = CROSSINGS,
     .record = record_crossing},
};

/* The ends in q2 of what an energy allows in the section: V(0, q2) rises to it on both sides of 0. */
static void ends_of(double level, double ends[2])
{
    for (int side = 0; side < 2; side++) {
        double inside = 0, outside = side == 0 ? -1 : 1;
        for (int i = 0; i < 60; i++) {
            const double middle = (outside + inside) / 2;
            *(potential(0, middle) > level ? &outside : &inside) = middle;
        }
        ends[side] = inside;
    }
}

/* Where p1 = 0 in the section: nothing of this energy lies outside. */
static void draw_border(struct gm_picture *picture, struct gm_panel *panel, double level)
{
    enum { POINTS = 200 };
    double points[4 * POINTS + 4], ends[2];
    ends_of(level, ends);
    for (size_t i = 0; i <= POINTS; i++) {
        const double q2 = (ends[0] + ends[1]) / 2 - (ends[1] - ends[0]) / 2 * cos(M_PI * (double)i / POINTS);
        const double p2 = sqrt(fmax(0, 2 * (level - potential(0, q2))));
        points[2 * i] = points[2 * (2 * POINTS + 1 - i)] = q2;
        points[2 * i + 1] = p2;
        points[2 * (2 * POINTS + 1 - i) + 1] = -p2;
    }
    gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 1.4, GM_SOLID}, points, 2 * POINTS + 2, true);
}

/* The orbit through that point of the section; there is none where the energy does not reach. */
static size_t point(const void *self, double x, double y, struct gm_choice *choices)
{
    const struct henon_heiles *orbit = self;
    if (!(y * y / 2 + potential(0, x) < orbit->energy) || fabs(x) > 1) {
        return 0;
    }
    gm_choose(&choices[0], "q2", x);
    gm_choose(&choices[1], "p2", y);
    return 2;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct henon_heiles *orbit = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    bool one_scheme = true, one_energy = true;
    double widest = 0;
    for (size_t i = 0; i < count; i++) {
        const struct henon_heiles *other = lanes[i]->parameters;
        one_scheme &= lanes[i]->scheme == lanes[0]->scheme;
        one_energy &= other->energy == orbit->energy;
        widest = fmax(widest, other->energy);
    }
    picture->title = gm_picture_text(picture, "A star in a galaxy: Poincaré section by %s",
                                     one_scheme ? lanes[0]->scheme->title : gm_counted_schemes(lanes, count));
    picture->subtitle = gm_picture_text(
        picture, "q₂ and p₂ whenever q₁ = 0, p₁ > 0%s%s;  grey: the border of what this energy allows",
        one_energy ? gm_picture_text(picture, ",  energy 1/%.4g", 1 / orbit->energy) : "",
        one_step ? gm_picture_text(picture, ",  Δt = %.4g", dt) : "");
    picture->caption =
        "A regular orbit draws a curve, a chaotic one fills an area; an integrator that gains or loses energy "
        "smears the curve.";
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    const double tall = 1.08 * sqrt(2 * widest);
    double ends[2];
    ends_of(widest, ends);
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const struct henon_heiles *self = walk.lane->parameters;
        if (walk.first) {
            panel = gm_walk_panel(picture, &walk, "");
            if (one_scheme && gm_panel_count(lanes, count) == 1) {
                panel->title = walk.lane->scheme->title; /* that of all */
            }
            panel->x = (struct gm_axis){.label = "q₂", .low = 1.1 * ends[0], .high = 1.08 * ends[1]};
            panel->y = (struct gm_axis){.label = "p₂", .low = -tall, .high = tall};
            panel->axes = true;
            panel->equal = true;
            draw_border(picture, panel, self->energy);
        }
        const struct gm_entries *section = &walk.lane->entries[0];
        const enum gm_role role = gm_lane_role(walk.lane->shown.colour);
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.75, .width = 2.2},
                       section->values, section->count);
    }
    static const struct gm_graph graph = {
        .observable = "energy_error", .highest = true, .scale = GM_LOG, .calm_low = 1e-6, .calm_high = 1};
    gm_draw_graphs(picture, lanes, count, &graph, 1);
}

static const char *const schemes[] = {"verlet", "rk4",      "rk2",      "gauss4",
                                      "kahan2", "yoshida4", "midpoint", NULL};

static const struct gm_work work = {
    .arguments = "until=100", .coarsest = 0.5, .halvings = 8, .reference = "gauss8"};

/* Small oscillations turn by a radian in it. */
static double radian_time(const void *self)
{
    return (void)self, 1;
}

static const double energies[] = {1. / 24, 1. / 12, 1. / 8, 0.16};
static const double steps[] = {0.1, 0.2, 0.5, 0.8, 1.2, 1.6, 1.95, 2.05};
static const char *const mapped[] = {"verlet", "rk4", "rk4sym", "gauss4", "kahan2", "yoshida4", NULL};

static const struct gm_stability stability = {
    .arguments = "until=500",
    .parameter = "energy",
    .values = energies,
    .value_count = GM_COUNT(energies),
    .label = "h ω",
    .unit = radian_time,
    .steps = steps,
    .step_count = GM_COUNT(steps),
    .kept = "energy_error",
    .schemes = mapped,
};

const struct gm_scene gm_scene_henon_heiles = {
    .name = "henon-heiles",
    .title = "Hénon-Heiles",
    .blurb =
        "The orbit of a star in a galaxy's potential, seen through a Poincaré section. Energy 1/12, 1/8, 1/6: from "
        "order to chaos.",
    .watch =
        "Watch the section: is it a curve, islands, or dust? An integrator that is not symplectic thickens curves.",
    .time = "1/2π of the period of a small oscillation",
    .size = sizeof(struct henon_heiles),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .lanes = "scheme=verlet q2=0,.1,.2,.3 energy=1/8 overlay=yes",
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    GM_ASKED_OF_HAMILTONIAN,
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .work = &work,
    .stability = &stability,
    .follow = 1,
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
