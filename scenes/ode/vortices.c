/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Point vortices of equal strength g in the plane, and passive tracers that they carry, z = x + i y:
       H = -(1/2 pi) sum_{i<j} g^2 ln |z_i - z_j|,   q_i = g x_i,   p_i = y_i
   Energy, impulse sum g z_i and angular impulse sum g |z_i|^2 are conserved. In `reduced` the symmetry
   z3 = -z1 and z4 = -z2 is built in, so that rounding cannot break it; beyond a turn of 35.12 degrees it
   does so in the full system, whatever the scheme. What to look at: the Poincare section
   arg z2 - arg z1 = pi/2 of the reduced system, a curve on which symplectic methods stay and RK4 does not;
   and the angular impulse.

   Razafindralandy, Hamdouni & Chhay (2018), section "Vortex dynamic", with the factor and the sense of
   rotation of Kirchhoff's equations (30) corrected:
       figures 7, 9     four vortices on a square
       figures 8, 10    two opposite ones turned by an angle */
#include "scenes/ode/vortices_draw.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/ode/problems/problems.h"
#include "scenes/common/entries.h"
#include "scenes/common/graph.h"
#include "scenes/ode/system/optional.h"

extern const struct gm_scene gm_scene_vortices;

static const char *const configurations[] = {"reduced", "square",    "two-turned", "one-turned",
                                             "random",  "collision", "patches",    NULL};

static const char *const shows[] = {"all", GM_SHOW_MODIFIED, NULL};

_Static_assert(offsetof(struct gm_vortices, multipole) ==
                   offsetof(struct gm_vortices, strength) + sizeof(double),
               "both are one list of parameters");

static const struct gm_parameter parameters[] = {
    GM_DT("5e-3", 1e-9, 100),
    GM_UNTIL("25"),
    GM_CHOICE_ROW(
        struct gm_vortices, configuration, "configuration", "reduced", configurations,
        "start: reduced (two-turned with its symmetry built in), square, two-turned, one-turned, random, "
        "collision (with strength 2*pi and dt .5/800, unless given), "
        "patches (two round ones, with count 3000, strength .003 and dt .02)"),
    {
        .key = "angle",
        .unit = "rad",
        .help = "by which one or two vortices are turned from the square",
        .type = GM_REAL,
        .offset = offsetof(struct gm_vortices, angle),
        .standard = "pi/5",
        .lowest = -3.1415926535897932,
        .highest = 3.1415926535897932,
    },
    GM_INTEGER_ROW(struct gm_vortices, count, "count", "4", 2, 1e6,
                   "number of vortices, for square (a regular polygon), random and patches",
                   .logarithmic = true),
    GM_REAL_ROW(
        struct gm_vortices, multipole, "multipole", "0", 0, 0.01,
        "the largest error of a velocity, relative to the sum of the speeds that the others give it one by one: cells "
        "of vortices then act by their moments, which is faster from 2000 to 4000 on; 1e-9 and less for implicit "
        "schemes, whose equations a larger error that jumps leaves unsolved; 0: pair by pair"),
    GM_REAL_ROW(struct gm_vortices, strength, "strength", "150", -1e6, 1e6,
                "of every vortex: its circulation"),
    GM_REAL_ROW(struct gm_vortices, distance, "distance", "0.05", 0, 1, "of the close pair, for collision"),
    GM_INTEGER_ROW(struct gm_vortices, tracers, "tracers", "0", 0, 1e6,
                   "passive particles, half of them dyed", .logarithmic = true),
    GM_INTEGER_ROW(struct gm_vortices, seed, "seed", "1", 0, 1e9, "of the random start"),
    GM_CHOICE_ROW(struct gm_vortices, show, "show", "all", shows,
                  "what the picture shows: all, or errors of the modified energy", .live = true),
    GM_TRAILS_ROW(struct gm_vortices),
};

/* The exact solution of a regular polygon: it turns as a whole. */
static void turn_polygon(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)m;
    const size_t count = problem->n / 2;
    const double strength = *(const double *)problem->parameters;
    const double radius = hypot(y0[0], y0[count]);
    const double turn = (double)(count - 1) * strength / (4 * M_PI * radius * radius) * t;
    for (size_t i = 0; i < count; i++) {
        y[i] = cos(turn) * y0[i] - sin(turn) * y0[count + i];
        y[count + i] = sin(turn) * y0[i] + cos(turn) * y0[count + i];
    }
}

static const struct gm_exact polygon = {.solution = turn_polygon};

/* Sets the strength and step that suit a configuration, unless they are given. */
static bool settle(void *parameters_, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    struct gm_vortices *vortices = parameters_;
    static const struct {
        const char *key, *in_collision, *in_patches; /* NULL: the usual value */
    } follow[] = {{"strength", "2*pi", "0.003"}, {"dt", ".5/800", "0.02"}, {"count", NULL, "3000"}};
    for (size_t i = 0; i < GM_COUNT(follow) && gm_is_given("configuration", keys, count); i++) {
        const struct gm_parameter *row = gm_scene_parameter(&gm_scene_vortices, follow[i].key);
        const char *its = vortices->configuration == GM_VORTEX_COLLISION ? follow[i].in_collision
                          : vortices->configuration == GM_PATCHES        ? follow[i].in_patches
                                                                         : NULL;
        if (!gm_is_given(row->key, keys, count)) {
            gm_parameter_set(row, vortices, its ? its : row->standard);
        }
    }
    return true;
}

/* ---- the start: on a polygon, turned, at random, or nearly colliding ---- */

/* splitmix64 (Steele, Lea & Flood 2014): a number in [0, 1) */
static double next_random(uint64_t *state)
{
    *state += 0x9e3779b97f4a7c15u;
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static const double golden_angle = 2.3999632297286533; /* fills a disc evenly */

static void place(const struct gm_vortices *vortices, size_t count, double *x, double *y)
{
    uint64_t random = (uint64_t)vortices->seed;
    const double patch = 0.4; /* radius; the pair fits into 1, 3 radii apart; two merge below 3.2 */
    static const double pair_x[] = {0.5, -0.5, 1, -1.2}, pair_y[] = {0, 0, 0.3, 0.1};
    for (size_t i = 0; i < count; i++) {
        double turn = 2 * M_PI * (double)i / (double)count, radius = 1;
        switch (vortices->configuration) {
        case GM_REDUCED:
            turn = i == 0 ? 0 : M_PI / 2 + vortices->angle;
            break;
        case GM_TWO_TURNED:
            turn += i % 2 == 1 ? vortices->angle : 0;
            break;
        case GM_ONE_TURNED:
            turn += i == 1 ? vortices->angle : 0;
            break;
        case GM_RANDOM:
            radius = sqrt(next_random(&random));
            turn = 2 * M_PI * next_random(&random);
            break;
        case GM_PATCHES:
            radius = patch * sqrt(((double)(i / 2) + 0.5) / (double)((count + 1) / 2));
            turn = golden_angle * (double)(i / 2);
            break;
        default:
            break;
        }
        x[i] = radius * cos(turn);
        y[i] = radius * sin(turn);
        if (vortices->configuration == GM_PATCHES) { /* odd ones are opposite to even ones */
            x[i] *= i % 2 == 0 ? 1 : -1;
            y[i] = (i % 2 == 0 ? 1 : -1) * (y[i] + 1 - patch);
        }
        if (vortices->configuration == GM_VORTEX_COLLISION) {
            x[i] = i < 2 ? vortices->distance * pair_x[i] : pair_x[i];
            y[i] = pair_y[i];
        }
    }
}

/* Returns true if two of four vortices start at one point, where they would have no velocity. */
static bool coincide(const struct gm_vortices *vortices)
{
    double x[4], y[4];
    place(vortices, gm_vortices_carried(vortices), x, y);
    if (vortices->configuration == GM_REDUCED) {
        for (size_t i = 0; i < 2; i++) {
            x[2 + i] = -x[i];
            y[2 + i] = -y[i];
        }
    }
    bool close = false;
    for (size_t i = 0; i < 4; i++) {
        for (size_t j = i + 1; j < 4; j++) {
            close |= hypot(x[i] - x[j], y[i] - y[j]) < 1e-9;
        }
    }
    return close;
}

static void start(const void *parameters_, const struct gm_problem *problem, double *y)
{
    const struct gm_vortices *vortices = parameters_;
    const size_t carried = gm_vortices_carried(vortices), tracers = problem->passive;
    place(vortices, carried, y, y + carried);
    for (size_t k = 0; k < tracers; k++) {
        const double radius = 1.6 * sqrt(((double)k + 0.5) / (double)tracers),
                     turn = golden_angle * (double)k;
        y[2 * carried + k] = radius * cos(turn);
        y[2 * carried + tracers + k] = radius * sin(turn);
    }
}

/* ---- the scene ---- */

/* More vortices, pair by pair, take seconds per step. */
enum { BY_PAIRS = 10000 };
static const double least_multipole = 1e-15; /* doubles resolve nothing less */

static bool setup(const void *parameters_, struct gm_problem *problem, char *sentence)
{
    const struct gm_vortices *vortices = parameters_;
    const bool any_count = vortices->configuration == GM_SQUARE || vortices->configuration == GM_RANDOM ||
                           vortices->configuration == GM_PATCHES;
    const size_t carried = gm_vortices_carried(vortices), tracers = (size_t)vortices->tracers;
    if (vortices->strength == 0) {
        return gm_refuse(sentence, "strength=0: vortices without strength do not move");
    }
    if (!any_count && vortices->count != 4) {
        return gm_refuse(sentence,
                         "configuration=%s has four vortices; count goes with square, random and patches",
                         configurations[vortices->configuration]);
    }
    if (!any_count && vortices->multipole > 0) {
        return gm_refuse(sentence,
                         "configuration=%s has four vortices; multipole goes with square, random and patches",
                         configurations[vortices->configuration]);
    }
    if (vortices->multipole > 0 && vortices->multipole < least_multipole) {
        return gm_refuse(sentence,
                         "multipole=%g is less than round-off: it is at least %g, or 0 for pair by pair",
                         vortices->multipole, least_multipole);
    }
    if (vortices->multipole == 0 && vortices->count > BY_PAIRS) {
        return gm_refuse(sentence, "count=%ld without multipole: more than %d are for multipole=1e-9",
                         vortices->count, BY_PAIRS);
    }
    if (!any_count && coincide(vortices)) { /* others are never so close */
        return gm_refuse(sentence, "two vortices coincide at the start: another %s is needed",
                         vortices->configuration == GM_VORTEX_COLLISION ? "distance" : "angle");
    }
    if (vortices->configuration == GM_REDUCED) {
        *problem = tracers == 0 ? gm_problem_vortices_reduced : gm_problem_vortices_reduced_carrying;
    } else if (vortices->multipole > 0) {
        *problem = gm_problem_vortices_multipole;
    } else {
        *problem = tracers == 0 && carried == 4 ? gm_problem_vortices_four : gm_problem_vortices;
    }
    problem->n = 2 * carried + 2 * tracers;
    problem->passive = tracers;
    problem->parameters = &vortices->strength;
    problem->exact = vortices->configuration == GM_SQUARE && tracers == 0 ? &polygon : NULL;
    return true;
}

/* Sums over the vortices, including images, two for each of the reduced system. */
static double mean_of(const struct gm_view *view, bool squares, size_t side)
{
    const struct gm_vortices *vortices = view->parameters;
    const size_t count = gm_vortices_carried(vortices);
    const double *x = view->state, *y = x + count;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += squares ? x[i] * x[i] + y[i] * y[i] : view->state[side * count + i];
    }
    return !squares && vortices->configuration == GM_REDUCED ? 0 : sum / (double)count;
}

/* Impulses are divided by the sum of the strengths: their natural scale, times the radius 1. */
static double impulse_x(const struct gm_view *view)
{
    return mean_of(view, false, 0);
}
static double impulse_y(const struct gm_view *view)
{
    return mean_of(view, false, 1);
}
static double angular_impulse(const struct gm_view *view)
{
    return mean_of(view, true, 0);
}

static double symmetry_defect(const struct gm_view *view)
{
    const struct gm_vortices *vortices = view->parameters;
    const double *s = view->state;
    if (vortices->count != 4 || vortices->configuration == GM_RANDOM ||
        vortices->configuration == GM_PATCHES) {
        return NAN;
    }
    return vortices->configuration == GM_REDUCED
               ? 0
               : fmax(hypot(s[0] + s[2], s[4] + s[6]), hypot(s[1] + s[3], s[5] + s[7]));
}

static double pair_distance(const struct gm_view *view)
{
    const struct gm_vortices *vortices = view->parameters;
    const size_t count = gm_vortices_carried(vortices);
    if (vortices->configuration != GM_VORTEX_COLLISION) {
        return NAN;
    }
    return hypot(view->state[0] - view->state[1], view->state[count] - view->state[count + 1]);
}

static double position_error(const struct gm_view *view)
{
    const struct gm_problem *problem = view->problem;
    if (!problem->exact || view->state == view->start) {
        return problem->exact ? 0 : NAN;
    }
    /* the first vortex; the others are the same, turned */
    const size_t count = problem->n / 2;
    const double turn =
        (double)(count - 1) * *(const double *)problem->parameters / (4 * M_PI) * (view->t - view->t0);
    return hypot(view->state[0] - cos(turn), view->state[count] - sin(turn));
}

static double tracers_lost(const struct gm_view *view)
{
    const struct gm_problem *problem = view->problem;
    const double *x = view->state + (problem->n - 2 * problem->passive);
    double lost = 0;
    for (size_t k = 0; k < problem->passive; k++) {
        lost += !isfinite(x[k]);
    }
    return lost;
}

/* Returns -cos of the angle from z1 to z2, if that is positive, else NaN: it passes zero upwards at a quarter
   turn. */
static double quarter_turn(const struct gm_view *view)
{
    const size_t count = gm_vortices_carried(view->parameters);
    const double *x = view->state, *y = x + count;
    const double along = x[0] * x[1] + y[0] * y[1], across = x[0] * y[1] - y[0] * x[1];
    return across > 0 ? -along : NAN;
}

static void record_crossing(const struct gm_view *view, double *entry)
{
    const size_t count = gm_vortices_carried(view->parameters);
    entry[0] = hypot(view->state[0], view->state[count]);
}

static double section_shift(const struct gm_view *view)
{
    if (!view->tracks) {
        return 0;
    }
    const struct gm_entries *section = &view->tracks[GM_SECTION];
    const size_t tenth = section->count / 10;
    double first = 0, last = 0;
    for (size_t i = 0; i < tenth; i++) {
        first += section->values[i];
        last += section->values[section->count - 1 - i];
    }
    return tenth > 0 ? (last - first) / (double)tenth : 0;
}

/* Turns vortices of the square to the direction of the point from the middle; sets the close pair as far
   apart as the point. */
static size_t point(const void *parameters_of, double x, double y, struct gm_choice *choices)
{
    const struct gm_vortices *vortices = parameters_of;
    const double turned = atan2(y, x) - M_PI / 2; /* the first vortex of the square is at pi/2 */
    switch (vortices->configuration) {
    case GM_REDUCED:
    case GM_TWO_TURNED: /* its mirror image is as near */
        gm_choose(&choices[0], "angle", remainder(turned, M_PI));
        return 1;
    case GM_ONE_TURNED:
        gm_choose(&choices[0], "angle", remainder(turned, 2 * M_PI));
        return 1;
    case GM_VORTEX_COLLISION:
        gm_choose(&choices[0], "distance", fmin(2 * hypot(x, y), 1));
        return 1;
    default:
        return 0;
    }
}

static double energy(const struct gm_view *view)
{
    double value = 0;
    gm_ode_of(view->problem)->hamiltonian->energy(view->problem, view->state, &value, 1);
    return value;
}

/* Returns the energy by which a pair differs if its distance grows by the factor e. */
static double natural_energy(const struct gm_view *view)
{
    const double strength = ((const struct gm_vortices *)view->parameters)->strength;
    return strength * strength / (4 * M_PI);
}

static const struct gm_observable observables[] = {
    GM_KEPT_OBSERVABLE("energy_error", energy, "H", "energy error", .scale = natural_energy,
                       .scale_text = "strength²/4π"),
    GM_KEPT_OBSERVABLE("impulse_x_error", impulse_x, "X", "impulse error, x", .least = 1, .scale_text = "1"),
    GM_KEPT_OBSERVABLE("impulse_y_error", impulse_y, "Y", "impulse error, y", .least = 1, .scale_text = "1"),
    GM_KEPT_OBSERVABLE("angular_impulse_error", angular_impulse, "I", "angular impulse error"),
    GM_OBSERVABLE("section_shift", section_shift, "shift of the section"),
    GM_LOG_OBSERVABLE("symmetry_defect", symmetry_defect, "asymmetry  |z₁ + z₃|, |z₂ + z₄|",
                      .missing = "only four vortices that start so have this symmetry"),
    GM_LOG_OBSERVABLE("pair_distance_error", pair_distance, "error of the close pair’s distance",
                      .missing = "only configuration=collision has a close pair", .error = true,
                      .symbol = "d"),
    GM_LOG_OBSERVABLE("position_error", position_error, "distance from the exact position",
                      .missing = "only configuration=square without tracers has an exact solution"),
    GM_OBSERVABLE("tracers_lost", tracers_lost, "tracers lost"),
};

/* Returns the time in which the regular polygon of these vortices turns once. */
static double turning_time(const void *parameters_)
{
    const struct gm_vortices *vortices = parameters_;
    const double count = vortices->configuration == GM_REDUCED ? 4 : (double)vortices->count;
    return 8 * M_PI * M_PI / (fabs(vortices->strength) * (count - 1));
}

/* The most vortices whose past is recorded. */
enum { FOLLOWED = 64 };

static size_t followed(const struct gm_view *view)
{
    const size_t count = gm_vortices_carried(view->parameters);
    return 2 * (count < FOLLOWED ? count : FOLLOWED);
}

static void record_positions(const struct gm_view *view, double *entry)
{
    const size_t count = gm_vortices_carried(view->parameters), width = followed(view);
    for (size_t i = 0; i < width / 2; i++) {
        entry[2 * i] = view->state[i];
        entry[2 * i + 1] = view->state[count + i];
    }
}

static double short_interval(const void *self)
{
    return turning_time(self) / 60;
}
/* an irregular part of the turn, which shows no pattern of its own */
static double long_interval(const void *self)
{
    return turning_time(self) / 7.310;
}

static const struct gm_track tracks[] = {
    [GM_SECTION] = {.key = "section",
                    .numbers = 1,
                    .section = quarter_turn,
                    .bound = 1 << 15,
                    .record = record_crossing},
    [GM_TRAIL] = {.key = "trail",
                  .width = followed,
                  .interval = short_interval,
                  .bound = 48,
                  .recent = true,
                  .record = record_positions},
    [GM_PAST] = {.key = "past",
                 .width = followed,
                 .interval = long_interval,
                 .bound = 1024,
                 .record = record_positions},
};

static const char *const schemes[] = {"rk4",  "rk4sym", "gauss4", "midpoint",           "rk2",
                                      "tao4", "avf2",   "gauss8", "midpoint-kahan-li8", NULL};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-7",
        .statement = "four vortices on a square move periodically",
        .arguments = "scheme=gauss4 configuration=square strength=1 dt=0.05 until=100",
    },
    {
        .name = "razafindralandy-8",
        .statement = "two opposite vortices turned by an angle: a quasi-periodic motion",
        .arguments = "scheme=gauss4 configuration=two-turned angle=pi/10,pi/5 strength=1 dt=0.05 until=1600",
    },
    {
        .name = "razafindralandy-9",
        .statement = "both integrators reproduce the square's periodic motion over 5e5 steps",
        .arguments = "scheme=rk4,rk4sym configuration=square strength=1,150 dt=5e-3 steps=500000",
    },
    {
        .name = "razafindralandy-10",
        .statement = "with two opposite vortices turned by π/5, RK4 loses quasi-periodicity, RK4sym keeps it",
        .arguments =
            "scheme=rk4,rk4sym configuration=two-turned angle=pi/5 strength=1,150 dt=5e-3 steps=500000",
    },
};

static const struct gm_work work = {.arguments = "configuration=reduced strength=1 until=100",
                                    .coarsest = 2,
                                    .halvings = 9,
                                    .reference = "gauss8"};

/* Returns the time in which the close pair turns by a radian: 1/omega, omega = g / (pi d^2). */
static double pair_time(const void *parameters_)
{
    const struct gm_vortices *vortices = parameters_;
    return M_PI * vortices->distance * vortices->distance / fabs(vortices->strength);
}

static const double distances[] = {0.02, 0.05, 0.1, 0.2, 0.5};
static const double steps[] = {0.05, 0.1, 0.2, 0.5, 1, 1.5, 2, 3};
static const char *const mapped[] = {"rk2", "rk4", "midpoint", "rk4sym", "gauss4", "gauss8", NULL};

static const struct gm_stability stability = {
    .arguments = "configuration=collision strength=2*pi until=0.5",
    .parameter = "distance",
    .values = distances,
    .value_count = GM_COUNT(distances),
    .label = "h ω of the close pair",
    .unit = pair_time,
    .steps = steps,
    .step_count = GM_COUNT(steps),
    .kept = "pair_distance_error",
    .error = "pair_distance_error",
    .schemes = mapped,
};

const struct gm_scene gm_scene_vortices = {
    .name = "vortices",
    .title = "Point vortices",
    .blurb =
        "Point vortices carry one another and whatever floats between them. Their motion is Hamiltonian: energy, "
        "impulse and angular impulse are kept; with symmetry built in, four of them move quasi-periodically.",
    .watch =
        "Watch the Poincaré section: under RK4 the orbit wanders off its curve, under a symplectic method it stays.",
    .time = "R²/Γ, the circle’s radius squared over a circulation of 1",
    .size = sizeof(struct gm_vortices),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .asked = gm_ode_asked,
    .asked_count = GM_ODE_ASKED,
    .asked_shown = gm_modified_shown,
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .work = &work,
    .stability = &stability,
    .follow = 1,
    .settle = settle,
    .setup = setup,
    .start = start,
    .draw = gm_vortices_draw,
    .point = point,
};
