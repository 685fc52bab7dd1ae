/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stiff oscillation: the chain of Fermi, Pasta & Ulam with some stiff springs, and the stiff spring pendulum,
       fpu               H = (|x'|^2 + |y'|^2 + omega^2 |y|^2)/2 + sum_i d_i^4/4
                         (core/ode/problems/oscillators/fpu.kernel.h)
       spring-pendulum   H = |p|^2/2 + k (|q| - 1)^2/2 + q2
   The energy of the stiff springs is an adiabatic invariant: it wanders among them slowly, its sum
       I = sum_i I_i,   I_i = (y_i'^2 + omega^2 y_i^2)/2
   nearly stays. What to look at: I. Verlet keeps it while h omega < 2 and blows up beyond, RK4 kills it
   silently, the midpoint rule keeps it at any step. Hairer, Lubich & Wanner (2006), sections I.5 and XIII; no
   figure of the documents. */
#include <math.h>
#include <stdio.h>

#include "core/ode/problems/problems.h"
#include "scenes/common/graph.h"
#include "scenes/ode/asked.h"
#include "scenes/ode/hamiltonian.h"

enum { FPU, SPRING_PENDULUM };
/* Places of observables; of so many springs each has one. */
enum { TOLD = 3, ENERGY = 0, FIRST = 1, SUM = 4 };

struct stiff {
    struct gm_timing timing;
    int system;
    double omega, stiffness;
    long springs;
    int show;
};

static const char *const systems[] = {"fpu", "spring-pendulum", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.03", 1e-7, 10),
    GM_UNTIL("210"),
    GM_CHOICE_ROW(struct stiff, system, "system", "fpu", systems,
                  "fpu (a chain of stiff and soft springs in turn) or spring-pendulum"),
    GM_REAL_ROW(struct stiff, omega, "omega", "50", 0.1, 1e6, "frequency of the stiff springs (fpu)",
                .logarithmic = true),
    GM_INTEGER_ROW(struct stiff, springs, "springs", "3", 1, GM_FPU_SPRINGS,
                   "number of stiff springs; their energies are told of the first three (fpu)"),
    GM_REAL_ROW(struct stiff, stiffness, "stiffness", "1e4", 1, 1e12,
                "of the spring, the square of its frequency (spring-pendulum)", .logarithmic = true),
    GM_SHOW_ROW(struct stiff),
};

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct stiff *stiff = self;
    *problem = stiff->system == FPU ? gm_problem_fpu_of[stiff->springs - 1] : gm_problem_spring_pendulum;
    problem->parameters = stiff->system == FPU ? &stiff->omega : &stiff->stiffness;
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    const struct stiff *stiff = self;
    for (size_t c = 0; c < problem->n; c++) {
        y[c] = 0;
    }
    if (stiff->system == SPRING_PENDULUM) {
        y[0] = 1.001;
        return;
    }
    y[0] = 1;
    y[stiff->springs] = 1 / stiff->omega;
    y[2 * stiff->springs] = 1;
    y[3 * stiff->springs] = 1;
}

/* Of spring `i`; the pendulum has one. */
static double spring_energy(const struct gm_view *view, size_t i)
{
    const struct stiff *stiff = view->parameters;
    const double *y = view->state;
    if (stiff->system == SPRING_PENDULUM) {
        const double r = hypot(y[0], y[1]), speed = (y[0] * y[2] + y[1] * y[3]) / r;
        return i == 0 ? (speed * speed + stiff->stiffness * (r - 1) * (r - 1)) / 2 : NAN;
    }
    const size_t springs = (size_t)stiff->springs;
    if (i >= springs) {
        return NAN;
    }
    const double expansion = stiff->omega * y[springs + i], speed = y[3 * springs + i];
    return (speed * speed + expansion * expansion) / 2;
}

static double spring_1(const struct gm_view *view)
{
    return spring_energy(view, 0);
}
static double spring_2(const struct gm_view *view)
{
    return spring_energy(view, 1);
}
static double spring_3(const struct gm_view *view)
{
    return spring_energy(view, 2);
}

static double stiff_energy(const struct gm_view *view)
{
    const struct stiff *stiff = view->parameters;
    double sum = 0;
    for (size_t i = 0; i < (stiff->system == FPU ? (size_t)stiff->springs : 1); i++) {
        sum += spring_energy(view, i);
    }
    return sum;
}

/* Of the pendulum, which is let go level with its pivot: its weight times its length. */
static double natural_energy(const void *self)
{
    return ((const struct stiff *)self)->system == SPRING_PENDULUM ? 1 : 0;
}

static const char fewer[] = "there are fewer stiff springs";

static const struct gm_observable observables[] = {
    [ENERGY] = GM_KEPT_OBSERVABLE("energy_error", gm_hamiltonian_energy, "H", "energy error",
                                  .scale = natural_energy, .scale_text = "1 for the spring pendulum"),
    [FIRST] = GM_OBSERVABLE("stiff_energy_1", spring_1, "energy of the first stiff spring"),
    GM_OBSERVABLE("stiff_energy_2", spring_2, "energy of the second stiff spring", .missing = fewer),
    GM_OBSERVABLE("stiff_energy_3", spring_3, "energy of the third stiff spring", .missing = fewer),
    [SUM] = GM_OBSERVABLE("stiff_energy", stiff_energy, "energy of the stiff springs"),
    GM_LOG_OBSERVABLE("adiabatic_error", stiff_energy, "error of the adiabatic invariant", .error = true,
                      .symbol = "I"),
};

static void remember(const struct gm_view *view, double *entry)
{
    entry[0] = view->state[0];
    entry[1] = view->state[1];
}

static const struct gm_track tracks[] = {
    {.key = "trail", .numbers = 2, .every = 0.01, .bound = 400, .recent = true, .record = remember},
};

/* Of the stiff energy to its start. */
static double stiff_ratio(const struct gm_lane *lane)
{
    const struct gm_view now = gm_lane_view(lane);
    struct gm_view before = now;
    before.state = now.start;
    return stiff_energy(&now) / stiff_energy(&before);
}

/* The middle of every few bins: what swings fast within them is left out. */
static size_t middles(const struct gm_lane *lane, size_t series, double *points)
{
    enum { SHOWN = 128 };
    const struct gm_history *history = &lane->history;
    const size_t group = (history->count + SHOWN - 1) / SHOWN;
    size_t count = 0;
    for (size_t b = 0; b < history->count; b += group, count++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t k = b; k < b + group && k < history->count; k++) {
            const struct gm_bin *bin = &history->bins[k * history->series + series];
            low = fmin(low, bin->low);
            high = fmax(high, bin->high);
            points[2 * count] = bin->t;
        }
        points[2 * count + 1] = (low + high) / 2;
    }
    return count;
}

static size_t springs_of(const struct gm_lane *lane)
{
    return (size_t)((const struct stiff *)lane->parameters)->springs;
}

/* The energies of the first stiff springs and the sum of all over time: one panel a lane. */
static const char *ratio_text(struct gm_picture *picture, const struct gm_lane *lane)
{
    const double ratio = stiff_ratio(lane);
    return gm_picture_text(picture, "stiff energy × %s",
                           ratio < 0.01 ? gm_power_text(picture, ratio)
                                        : gm_picture_text(picture, "%.3g", ratio));
}

/* The highest value of the axis of energies: room for the sum where a lane that has not failed needs it. */
static double highest_energy(const struct gm_lane *const *lanes, size_t count)
{
    static const double usual = 1.5, most = 3;
    double highest = 0;
    for (size_t i = 0; i < count; i++) {
        const struct gm_history *history = &lanes[i]->history;
        for (size_t b = 0; b < history->count && lanes[i]->run->status == GM_OK; b++) {
            highest = fmax(highest, history->bins[b * history->series + SUM].high);
        }
    }
    return highest <= usual ? usual : highest <= 2 ? 2 : most;
}

/* The point of line k that its name stands above: where the lines of the true motion are apart, and out of
   the band that the sum may have become. `made` if there is none. */
static size_t name_place(const struct gm_lane *lane, size_t k, size_t made, const double *points)
{
    static const size_t percent[] = {12, 55, 85, 92};
    const struct gm_history *history = &lane->history;
    for (size_t later = 0; made > 20 && later < 100; later += 8) {
        const size_t at = made * ((percent[k] + later) % 100) / 100;
        const struct gm_bin *sum = &history->bins[at * history->count / made * history->series + SUM];
        const double y = points[2 * at + 1];
        if (k == TOLD || y < sum->low - 0.15 || y > sum->high + 0.1) {
            return at;
        }
    }
    return made;
}

static void draw_exchange(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    static const char *const names[] = {"I₁", "I₂", "I₃", "I"};
    struct gm_axis x;
    gm_time_axis(&x, lanes, count);
    const double high = highest_energy(lanes, count);
    for (size_t i = 0; i < count; i++) {
        const struct gm_lane *lane = lanes[i];
        const enum gm_role role = gm_lane_role(lane->shown.colour);
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, gm_lane_title(lane));
        panel->axes = true;
        panel->title_role = role;
        panel->x = x;
        panel->y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = 0, .high = high};
        const char *failure = gm_lane_failure(picture, lane);
        panel->note = failure[0] ? failure : ratio_text(picture, lane);
        double *points = gm_picture_memory(picture, 4 * GM_HISTORY_BINS * sizeof *points);
        for (size_t k = 0; points && k < TOLD + 1; k++) {
            if (k < TOLD && k >= springs_of(lane)) {
                continue;
            }
            const size_t made =
                k < TOLD ? middles(lane, FIRST + k, points) : gm_history_points(lane, SUM, points);
            const struct gm_style style = {role, k < TOLD ? 0.75 : 1, k < TOLD ? 1.3 : 2.4,
                                           k < TOLD ? gm_lane_dash(k) : GM_SOLID};
            for (size_t m = 0; m < made; m++) {
                points[2 * m + 1] = fmin(points[2 * m + 1], 2 * high); /* far beyond the panel is beyond it */
            }
            gm_mark_line(picture, panel, style, points, made, false);
            gm_mark_switches(picture, panel, lane, false);
            const size_t at = name_place(lane, k, made, points);
            if (at < made && points[2 * at + 1] < high - 0.1) {
                gm_mark_text(picture, panel, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 1},
                             points[2 * at], points[2 * at + 1] + 0.05 * high, GM_ANCHOR_CENTRE, names[k]);
            }
        }
    }
}

static void draw_pendulum(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const enum gm_role role = gm_lane_role(walk.lane->shown.colour);
        if (walk.first) {
            panel = gm_walk_panel(picture, &walk, ratio_text(picture, walk.lane));
            panel->x = (struct gm_axis){.label = "", .low = -1.2, .high = 1.2};
            panel->y = (struct gm_axis){.label = "", .low = -1.3, .high = 0.5};
            panel->equal = true;
        }
        const double *state = gm_run_state(walk.lane->run);
        const double spring[] = {0, 0, state[0], state[1]};
        const struct gm_entries *trail = &walk.lane->entries[0];
        gm_draw_trail(picture, panel, (struct gm_style){role, 0.8, 1.8, GM_SOLID}, trail->values,
                      trail->count);
        gm_mark_line(picture, panel, (struct gm_style){GM_SECONDARY, 1, 1.4, GM_SOLID}, spring, 2, false);
        gm_mark_points(picture, panel, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 7}, spring, 1);
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 12}, state, 1);
    }
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct stiff *stiff = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    bool one_system = true;
    for (size_t i = 1; i < count; i++) {
        const struct stiff *other = lanes[i]->parameters;
        one_system &= other->system == stiff->system && other->omega == stiff->omega &&
                      other->springs == stiff->springs;
    }
    const double omega = stiff->system == FPU ? stiff->omega : sqrt(stiff->stiffness);
    static const char *const counted[] = {"A stiff spring keeps its", "Two stiff springs trade their",
                                          "Three stiff springs trade their", "Four stiff springs trade their",
                                          "Five stiff springs trade their"};
    picture->title =
        stiff->system == SPRING_PENDULUM
            ? gm_picture_text(picture, "A stiff spring pendulum, followed by %s",
                              gm_counted_schemes(lanes, count))
            : gm_picture_text(picture, "%s energy, by %s",
                              one_system ? counted[stiff->springs - 1] : "Stiff springs trade their",
                              gm_counted_schemes(lanes, count));
    picture->subtitle = gm_picture_text(
        picture, "%s%s%s", stiff->system == FPU ? "chain of Fermi, Pasta and Ulam" : "spring and gravity",
        one_system ? gm_picture_text(picture, ",  ω = %.4g", omega) : "",
        one_system && one_step ? gm_picture_text(picture, ",  Δt = %.4g,  Δt ω = %.3g", dt, dt * omega) : "");
    picture->caption = stiff->system == FPU
                           ? "Springs may trade energy; their sum I should nearly stay. RK4 and other "
                             "damping methods let it die without a word."
                           : "";
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    if (stiff->system == FPU) {
        draw_exchange(picture, lanes, count);
    } else {
        draw_pendulum(picture, lanes, count);
    }
    static const struct gm_graph graphs[] = {
        {.observable = "adiabatic_error", .highest = true, .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 2},
        {.observable = "energy_error", .highest = true, .scale = GM_LOG, .calm_low = 1e-6, .calm_high = 1},
    };
    gm_draw_graphs(picture, lanes, count, graphs, GM_COUNT(graphs));
}

static const char *const schemes[] = {"verlet",     "rk4",       "midpoint",       "gauss4",       "impulse2",
                                      "mollified2", "gautschi2", "implicit-euler", "blanes-moan4", NULL};

static const struct gm_work work = {
    .arguments = "until=10", .coarsest = 0.04, .halvings = 10, .reference = "gauss8"};

static double spring_time(const void *self)
{
    const struct stiff *stiff = self;
    return stiff->system == FPU ? 1 / stiff->omega : 1 / sqrt(stiff->stiffness);
}

static const double omegas[] = {20, 50, 100, 200};
static const double steps[] = {0.2, 0.5, 1, 1.5, 1.95, 2.05, 2.6, 3.5, 5};
static const char *const mapped[] = {"verlet",         "rk4",      "midpoint", "gauss4",
                                     "implicit-euler", "impulse2", NULL};

static const struct gm_stability stability = {
    .arguments = "until=50",
    .parameter = "omega",
    .values = omegas,
    .value_count = GM_COUNT(omegas),
    .label = "h ω",
    .unit = spring_time,
    .steps = steps,
    .step_count = GM_COUNT(steps),
    .kept = "stiff_energy",
    .settle = 20,
    .schemes = mapped,
};

const struct gm_scene gm_scene_stiff = {
    .name = "stiff",
    .title = "Stiff springs",
    .blurb =
        "Soft and stiff springs in one system. The stiff ones swing fast; the energy in them is an adiabatic invariant "
        "that a scheme may keep, lose or blow up.",
    .watch =
        "Watch the sum I of the stiff energies: Verlet keeps it while h ω < 2 and blows up beyond, RK4 kills it "
        "silently, the midpoint rule keeps it at any step.",
    .time = "that in which the stiff springs of the chain have the frequency omega; of the pendulum √(l/g)",
    .size = sizeof(struct stiff),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    GM_ASKED_OF_HAMILTONIAN,
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .work = &work,
    .stability = &stability,
    .setup = setup,
    .start = start,
    .draw = draw,
};
