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
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/ode/problems/problems.h"
#include "scenes/common/entries.h"
#include "scenes/common/graph.h"
#include "scenes/ode/system/optional.h"

extern const struct gm_scene gm_scene_vortices;

enum { REDUCED, SQUARE, TWO_TURNED, ONE_TURNED, RANDOM, COLLISION, PATCHES };

struct vortices {
    struct gm_timing timing;
    int configuration;
    double angle, strength, multipole, distance; /* strength and multipole are a problem's parameters */
    long count, tracers, seed;
    int show;
    char trails[GM_TEXT_SIZE];
};

/* Returns the number of vortices in the state: two of the reduced system, whose images are z -> -z. */
static size_t carried_of(const struct vortices *vortices)
{
    return vortices->configuration == REDUCED ? 2 : (size_t)vortices->count;
}

/* tracks: radii of vortex 1 in the section; positions, x and y in turn, recent ones and all since the
   start */
enum { SECTION, TRAIL, PAST };

static const char *const configurations[] = {"reduced", "square",    "two-turned", "one-turned",
                                             "random",  "collision", "patches",    NULL};

static const char *const shows[] = {"all", GM_SHOW_MODIFIED, NULL};

_Static_assert(offsetof(struct vortices, multipole) == offsetof(struct vortices, strength) + sizeof(double),
               "both are one list of parameters");

static const struct gm_parameter parameters[] = {
    GM_DT("5e-3", 1e-9, 100),
    GM_UNTIL("25"),
    GM_CHOICE_ROW(
        struct vortices, configuration, "configuration", "reduced", configurations,
        "start: reduced (two-turned with its symmetry built in), square, two-turned, one-turned, random, "
        "collision (with strength 2*pi and dt .5/800, unless given), "
        "patches (two round ones, with count 3000, strength .003 and dt .02)"),
    {
        .key = "angle",
        .unit = "rad",
        .help = "by which one or two vortices are turned from the square",
        .type = GM_REAL,
        .offset = offsetof(struct vortices, angle),
        .standard = "pi/5",
        .lowest = -3.1415926535897932,
        .highest = 3.1415926535897932,
    },
    GM_INTEGER_ROW(struct vortices, count, "count", "4", 2, 1e6,
                   "number of vortices, for square (a regular polygon), random and patches",
                   .logarithmic = true),
    GM_REAL_ROW(
        struct vortices, multipole, "multipole", "0", 0, 0.01,
        "the largest error of a velocity, relative to the sum of the speeds that the others give it one by one: cells "
        "of vortices then act by their moments, which is faster from 2000 to 4000 on; 1e-9 and less for implicit "
        "schemes, whose equations a larger error that jumps leaves unsolved; 0: pair by pair"),
    GM_REAL_ROW(struct vortices, strength, "strength", "150", -1e6, 1e6, "of every vortex: its circulation"),
    GM_REAL_ROW(struct vortices, distance, "distance", "0.05", 0, 1, "of the close pair, for collision"),
    GM_INTEGER_ROW(struct vortices, tracers, "tracers", "0", 0, 1e6, "passive particles, half of them dyed",
                   .logarithmic = true),
    GM_INTEGER_ROW(struct vortices, seed, "seed", "1", 0, 1e9, "of the random start"),
    GM_CHOICE_ROW(struct vortices, show, "show", "all", shows,
                  "what the picture shows: all, or errors of the modified energy", .live = true),
    GM_TRAILS_ROW(struct vortices),
};

/* The exact solution of a regular polygon: it turns as a whole. */
static void turn_polygon(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)m;
    const size_t count = problem->n / 2;
    const double strength = *(const double *)problem->parameters;
    const double radius = gm_hypot(y0[0], y0[count]);
    const double turn = (double)(count - 1) * strength / (4 * M_PI * radius * radius) * t;
    for (size_t i = 0; i < count; i++) {
        y[i] = gm_cos(turn) * y0[i] - gm_sin(turn) * y0[count + i];
        y[count + i] = gm_sin(turn) * y0[i] + gm_cos(turn) * y0[count + i];
    }
}

static const struct gm_exact polygon = {.solution = turn_polygon};

/* Sets the strength and step that suit a configuration, unless they are given. */
static bool settle(void *parameters_, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    struct vortices *vortices = parameters_;
    static const struct {
        const char *key, *in_collision, *in_patches; /* NULL: the usual value */
    } follow[] = {{"strength", "2*pi", "0.003"}, {"dt", ".5/800", "0.02"}, {"count", NULL, "3000"}};
    for (size_t i = 0; i < GM_COUNT(follow) && gm_is_given("configuration", keys, count); i++) {
        const struct gm_parameter *row = gm_scene_parameter(&gm_scene_vortices, follow[i].key);
        const char *its = vortices->configuration == COLLISION ? follow[i].in_collision
                          : vortices->configuration == PATCHES ? follow[i].in_patches
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

static void place(const struct vortices *vortices, size_t count, double *x, double *y)
{
    uint64_t random = (uint64_t)vortices->seed;
    const double patch = 0.4; /* radius; the pair fits into 1, 3 radii apart; two merge below 3.2 */
    static const double pair_x[] = {0.5, -0.5, 1, -1.2}, pair_y[] = {0, 0, 0.3, 0.1};
    for (size_t i = 0; i < count; i++) {
        double turn = 2 * M_PI * (double)i / (double)count, radius = 1;
        switch (vortices->configuration) {
        case REDUCED:
            turn = i == 0 ? 0 : M_PI / 2 + vortices->angle;
            break;
        case TWO_TURNED:
            turn += i % 2 == 1 ? vortices->angle : 0;
            break;
        case ONE_TURNED:
            turn += i == 1 ? vortices->angle : 0;
            break;
        case RANDOM:
            radius = sqrt(next_random(&random));
            turn = 2 * M_PI * next_random(&random);
            break;
        case PATCHES:
            radius = patch * sqrt(((double)(i / 2) + 0.5) / (double)((count + 1) / 2));
            turn = golden_angle * (double)(i / 2);
            break;
        default:
            break;
        }
        x[i] = radius * gm_cos(turn);
        y[i] = radius * gm_sin(turn);
        if (vortices->configuration == PATCHES) { /* odd ones are opposite to even ones */
            x[i] *= i % 2 == 0 ? 1 : -1;
            y[i] = (i % 2 == 0 ? 1 : -1) * (y[i] + 1 - patch);
        }
        if (vortices->configuration == COLLISION) {
            x[i] = i < 2 ? vortices->distance * pair_x[i] : pair_x[i];
            y[i] = pair_y[i];
        }
    }
}

/* Returns true if two of four vortices start at one point, where they would have no velocity. */
static bool coincide(const struct vortices *vortices)
{
    double x[4], y[4];
    place(vortices, carried_of(vortices), x, y);
    if (vortices->configuration == REDUCED) {
        for (size_t i = 0; i < 2; i++) {
            x[2 + i] = -x[i];
            y[2 + i] = -y[i];
        }
    }
    bool close = false;
    for (size_t i = 0; i < 4; i++) {
        for (size_t j = i + 1; j < 4; j++) {
            close |= gm_hypot(x[i] - x[j], y[i] - y[j]) < 1e-9;
        }
    }
    return close;
}

static void start(const void *parameters_, const struct gm_problem *problem, double *y)
{
    const struct vortices *vortices = parameters_;
    const size_t carried = carried_of(vortices), tracers = problem->passive;
    place(vortices, carried, y, y + carried);
    for (size_t k = 0; k < tracers; k++) {
        const double radius = 1.6 * sqrt(((double)k + 0.5) / (double)tracers),
                     turn = golden_angle * (double)k;
        y[2 * carried + k] = radius * gm_cos(turn);
        y[2 * carried + tracers + k] = radius * gm_sin(turn);
    }
}

/* ---- the scene ---- */

/* More vortices, pair by pair, take seconds per step. */
enum { BY_PAIRS = 10000 };
static const double least_multipole = 1e-15; /* doubles resolve nothing less */

static bool setup(const void *parameters_, struct gm_problem *problem, char *sentence)
{
    const struct vortices *vortices = parameters_;
    const bool any_count = vortices->configuration == SQUARE || vortices->configuration == RANDOM ||
                           vortices->configuration == PATCHES;
    const size_t carried = carried_of(vortices), tracers = (size_t)vortices->tracers;
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
                         vortices->configuration == COLLISION ? "distance" : "angle");
    }
    if (vortices->configuration == REDUCED) {
        *problem = tracers == 0 ? gm_problem_vortices_reduced : gm_problem_vortices_reduced_carrying;
    } else if (vortices->multipole > 0) {
        *problem = gm_problem_vortices_multipole;
    } else {
        *problem = tracers == 0 && carried == 4 ? gm_problem_vortices_four : gm_problem_vortices;
    }
    problem->n = 2 * carried + 2 * tracers;
    problem->passive = tracers;
    problem->parameters = &vortices->strength;
    problem->exact = vortices->configuration == SQUARE && tracers == 0 ? &polygon : NULL;
    return true;
}

/* An impulse, by its observable, as a mean over the vortices and their images: so it is divided by the sum of the
   strengths, its natural scale, times the radius 1. */
static double impulse(const struct gm_view *view)
{
    const struct vortices *vortices = view->parameters;
    const char *key = view->observable->key;
    const size_t count = carried_of(vortices);
    const double *x = view->state, *y = x + count;
    const bool angular = key[0] == 'a', across = strcmp(key, "impulse_x_error") == 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += angular ? x[i] * x[i] + y[i] * y[i] : (across ? x : y)[i];
    }
    return !angular && vortices->configuration == REDUCED ? 0 : sum / (double)count;
}

static double symmetry_defect(const struct gm_view *view)
{
    const struct vortices *vortices = view->parameters;
    const double *s = view->state;
    if (vortices->count != 4 || vortices->configuration == RANDOM || vortices->configuration == PATCHES) {
        return NAN;
    }
    return vortices->configuration == REDUCED
               ? 0
               : fmax(gm_hypot(s[0] + s[2], s[4] + s[6]), gm_hypot(s[1] + s[3], s[5] + s[7]));
}

static double pair_distance(const struct gm_view *view)
{
    const struct vortices *vortices = view->parameters;
    const size_t count = carried_of(vortices);
    if (vortices->configuration != COLLISION) {
        return NAN;
    }
    return gm_hypot(view->state[0] - view->state[1], view->state[count] - view->state[count + 1]);
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
    return gm_hypot(view->state[0] - gm_cos(turn), view->state[count] - gm_sin(turn));
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
    const size_t count = carried_of(view->parameters);
    const double *x = view->state, *y = x + count;
    const double along = x[0] * x[1] + y[0] * y[1], across = x[0] * y[1] - y[0] * x[1];
    return across > 0 ? -along : NAN;
}

static void record_crossing(const struct gm_view *view, double *entry)
{
    const size_t count = carried_of(view->parameters);
    entry[0] = gm_hypot(view->state[0], view->state[count]);
}

static double section_shift(const struct gm_view *view)
{
    if (!view->tracks) {
        return 0;
    }
    const struct gm_entries *section = &view->tracks[SECTION];
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
    const struct vortices *vortices = parameters_of;
    const double turned = gm_atan2(y, x) - M_PI / 2; /* the first vortex of the square is at pi/2 */
    switch (vortices->configuration) {
    case REDUCED:
    case TWO_TURNED: /* its mirror image is as near */
        gm_choose(&choices[0], "angle", remainder(turned, M_PI));
        return 1;
    case ONE_TURNED:
        gm_choose(&choices[0], "angle", remainder(turned, 2 * M_PI));
        return 1;
    case COLLISION:
        gm_choose(&choices[0], "distance", fmin(2 * gm_hypot(x, y), 1));
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
    const double strength = ((const struct vortices *)view->parameters)->strength;
    return strength * strength / (4 * M_PI);
}

static const struct gm_observable observables[] = {
    GM_KEPT_OBSERVABLE("energy_error", energy, "H", "energy error", .scale = natural_energy,
                       .scale_text = "strength²/4π"),
    GM_KEPT_OBSERVABLE("impulse_x_error", impulse, "X", "impulse error, x", .least = 1, .scale_text = "1"),
    GM_KEPT_OBSERVABLE("impulse_y_error", impulse, "Y", "impulse error, y", .least = 1, .scale_text = "1"),
    GM_KEPT_OBSERVABLE("angular_impulse_error", impulse, "I", "angular impulse error"),
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
    const struct vortices *vortices = parameters_;
    const double count = vortices->configuration == REDUCED ? 4 : (double)vortices->count;
    return 8 * M_PI * M_PI / (fabs(vortices->strength) * (count - 1));
}

/* The most vortices whose past is recorded. */
enum { FOLLOWED = 64 };

static size_t followed(const struct gm_view *view)
{
    const size_t count = carried_of(view->parameters);
    return 2 * (count < FOLLOWED ? count : FOLLOWED);
}

static void record_positions(const struct gm_view *view, double *entry)
{
    const size_t count = carried_of(view->parameters), width = followed(view);
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
    [SECTION] = {.key = "section",
                 .numbers = 1,
                 .section = quarter_turn,
                 .bound = 1 << 15,
                 .record = record_crossing},
    [TRAIL] = {.key = "trail",
               .width = followed,
               .interval = short_interval,
               .bound = 48,
               .recent = true,
               .record = record_positions},
    [PAST] = {.key = "past",
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
    const struct vortices *vortices = parameters_;
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

/* ---- the picture: positions and paths, tracers, the section, losses ---- */

/* The greatest distance from the middle that is drawn; the number of vortices from which on a dye shows them,
   and of dyed points from which on the dye is a field. */
static const double farthest = 4;
enum { CROWD = 1000, FIELD = 4000 };

static double reach_of(const struct gm_lane *const *lanes, size_t count)
{
    double reach = 1.15;
    for (size_t i = 0; i < count; i++) {
        const struct vortices *vortices = lanes[i]->parameters;
        const struct gm_entries *past = &lanes[i]->entries[PAST];
        for (size_t k = 0; k < past->count * past->width; k++) {
            const double away = fabs(past->values[k]);
            reach = away < farthest ? fmax(reach, 1.08 * away) : reach;
        }
        reach = vortices->tracers > 0 || vortices->configuration == PATCHES ? fmax(reach, 1.75) : reach;
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
        for (int dyed = 0; dyed < 2; dyed++) {
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
    const struct vortices *vortices = lane->parameters;
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const struct gm_entries *trail = &lane->entries[TRAIL], *past = &lane->entries[PAST];
    const size_t followed = trail->width / 2, carried = carried_of(vortices);
    const bool images = vortices->configuration == REDUCED;
    const size_t past_from = gm_trails_from(vortices->trails, past, lane->run->t),
                 trail_from = gm_trails_from(vortices->trails, trail, lane->run->t);
    const size_t most = past->count > trail->count ? past->count : trail->count;
    const double *state = gm_run_state(lane->run);
    double *points = gm_picture_memory(picture, 2 * (most + carried + 1) * sizeof *points);
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
    const size_t carried = carried_of(lane->parameters);
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
        const struct gm_entries *section = &lanes[i]->entries[SECTION];
        for (size_t k = 0; k < section->count; k++) {
            if (section->values[k] < 2 * farthest) {
                gm_range_add(&panel->y.low, &panel->y.high, section->values[k] - section->values[0]);
            }
        }
    }
    gm_range_round(&panel->y.low, &panel->y.high, GM_LINEAR);
    double points[2 * SHOWN];
    for (size_t i = 0; i < count; i++) {
        const struct gm_entries *section = &lanes[i]->entries[SECTION];
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

static const char *caption_of(const struct vortices *vortices)
{
    switch (vortices->configuration) {
    case REDUCED:
        return "With the symmetry built in the motion has one curve to stay on: a symplectic method stays, RK4 leaves it.";
    case TWO_TURNED:
        return fabs(vortices->angle) > threshold
                   ? "Turned by more than 35.12° this motion is unstable: rounding breaks its symmetry under every scheme, "
                     "at about the same time. The published contrast of two schemes is not reproduced here."
                   : "The symmetric motion is stable at this angle; what sets schemes apart is the angular impulse.";
    case ONE_TURNED:
        return "This motion is chaotic itself: only its invariants distinguish schemes.";
    case PATCHES:
        return "Two patches of similar vorticity this near merge: they turn about each other, and what each gives up "
               "is wound into arms.";
    case COLLISION:
        return "A pair this close turns faster than the rest: a step that is too long for it goes wrong without a sound.";
    default:
        return "";
    }
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    static const char *const starts[] = {"two turned, symmetry built in",
                                         "a regular polygon",
                                         "two of a square turned",
                                         "one of a square turned",
                                         "a random disc",
                                         "a close pair and two more",
                                         "two round patches"};
    const struct vortices *self = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    if (gm_draw_modified(lanes, count, picture)) {
        return;
    }
    bool one_start = true, one_strength = true;
    for (size_t i = 1; i < count; i++) {
        const struct vortices *other = lanes[i]->parameters;
        one_start &= other->configuration == self->configuration && other->angle == self->angle;
        one_strength &= other->strength == self->strength;
    }
    const long vortices = self->configuration == REDUCED ? 4 : self->count;
    const char *number = vortices == 4 ? "Four" : gm_picture_text(picture, "%ld", vortices);
    picture->title = self->tracers > 0 ? gm_picture_text(picture, "%s vortices stir a dye, by %s", number,
                                                         gm_counted_schemes(lanes, count))
                                       : gm_picture_text(picture, "%s vortices, followed by %s", number,
                                                         gm_counted_schemes(lanes, count));
    const bool turned = self->configuration == REDUCED || self->configuration == TWO_TURNED ||
                        self->configuration == ONE_TURNED;
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
    if (one_start && self->configuration == REDUCED) {
        draw_section(picture, lanes, count);
    }
    if (self->configuration == TWO_TURNED) {
        draw_log(picture, lanes, count, "symmetry_defect");
    }
    if (self->configuration == COLLISION) {
        draw_log(picture, lanes, count, "pair_distance_error");
    }
    if (self->configuration == SQUARE && self->tracers == 0) {
        draw_log(picture, lanes, count, "position_error");
    }
    if (self->configuration == RANDOM || self->configuration == PATCHES ||
        self->configuration == ONE_TURNED) {
        draw_log(picture, lanes, count, "energy_error");
    }
    draw_log(picture, lanes, count, "angular_impulse_error");
}

const struct gm_scene gm_scene_vortices = {
    .name = "vortices",
    .title = "Point vortices",
    .blurb =
        "Point vortices carry one another and whatever floats between them. Their motion is Hamiltonian: energy, "
        "impulse and angular impulse are kept; with symmetry built in, four of them move quasi-periodically.",
    .watch =
        "Watch the Poincaré section: under RK4 the orbit wanders off its curve, under a symplectic method it stays.",
    .time = "R²/Γ, the circle’s radius squared over a circulation of 1",
    .size = sizeof(struct vortices),
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
    .draw = draw,
    .point = point,
};
