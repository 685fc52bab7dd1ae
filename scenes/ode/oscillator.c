/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One oscillator under integrators whose time steps follow from the variational principle: time is varied as
   well as place, and the discrete energy is kept.
       harmonic   H = p^2/2 + q^2/2        pendulum   H = p^2/2 - cos q
   What to look at: the step tau. By the rectangle rule as printed it grows without bound before a turning
   point, and the run ends there; with restarts it goes on; by the midpoint rule it is constant for the
   harmonic oscillator, where the rule is the implicit midpoint rule.

   Razafindralandy, Hamdouni & Chhay (2018), section "Total variation", equations 55 to 59:
       figure 16   q against the sine        figure 17   the energy error */
#include <math.h>
#include <stdio.h>

#include "core/expression/number.h"
#include "core/ode/families/adaptive/variational_time.h"
#include "core/ode/families/families.h"
#include "core/ode/problems/problems.h"
#include "scenes/common/graph.h"
#include "scenes/ode/asked.h"
#include "scenes/ode/hamiltonian.h"

enum { HARMONIC, PENDULUM };
enum { Q, P };
enum { ENERGY, TAU, RESTARTS, PHASE /* places of observables */ };

struct oscillator {
    struct gm_timing timing;
    int system;
    double q0, p0;
    int show;
};

static const char *const systems[] = {"harmonic", "pendulum", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.02", 1e-7, 100),
    GM_UNTIL("20"),
    GM_CHOICE_ROW(struct oscillator, system, "system", "harmonic", systems,
                  "H = p²/2 + q²/2 or p²/2 − cos q"),
    /* sin 0.3 and cos 0.3 */
    GM_REAL_ROW(struct oscillator, q0, "q0", "0.29552020666133957", -100, 100, "position at the start"),
    GM_REAL_ROW(struct oscillator, p0, "p0", "0.955336489125606", -100, 100, "momentum at the start"),
    GM_SHOW_ROW(struct oscillator),
};

static void turn(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        y[i] = cos(t) * y0[i] + sin(t) * y0[m + i];
        y[m + i] = cos(t) * y0[m + i] - sin(t) * y0[i];
    }
}

static const struct gm_exact harmonic = {.solution = turn};

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct oscillator *oscillator = self;
    *problem = oscillator->system == PENDULUM ? gm_problem_pendulum : gm_problem_oscillator;
    problem->exact = oscillator->system == PENDULUM ? NULL : &harmonic;
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    (void)problem;
    y[Q] = ((const struct oscillator *)self)->q0;
    y[P] = ((const struct oscillator *)self)->p0;
}

static bool varies_time(const struct gm_view *view)
{
    return view->scheme->family == &gm_family_variational_time;
}

static double tau(const struct gm_view *view)
{
    const bool chosen = view->scheme->family->parameters == gm_settings_of_variational_time;
    return view->memory && chosen ? view->memory[GM_VARIATIONAL_TAU] : view->dt;
}

static double restarts(const struct gm_view *view)
{
    return view->memory && varies_time(view) ? view->memory[GM_VARIATIONAL_RESTARTS] : 0;
}

/* How far the harmonic oscillator is ahead in its turn of where it ought to be. */
static double phase_error(const struct gm_view *view)
{
    const struct oscillator *self = view->parameters;
    if (self->system == PENDULUM) {
        return NAN;
    }
    const double now = atan2(view->state[Q], view->state[P]), then = atan2(view->start[Q], view->start[P]);
    return remainder(now - then - (view->t - view->t0), 2 * M_PI);
}

/* The pendulum's energy passes zero; the oscillator's is the square of its amplitude. */
static double natural_energy(const void *self)
{
    return ((const struct oscillator *)self)->system == PENDULUM ? 1 : 0;
}

static const struct gm_observable observables[] = {
    [ENERGY] = GM_KEPT_OBSERVABLE("energy_error", gm_hamiltonian_energy, "H", "energy error",
                                  .scale = natural_energy, .scale_text = "1 for the pendulum"),
    [TAU] = GM_LOG_OBSERVABLE("tau", tau, "time step τ"),
    [RESTARTS] = GM_OBSERVABLE("restarts", restarts, "restarts"),
    [PHASE] = {.key = "phase_error",
               .title = "phase error",
               .missing = "the phase of the pendulum is not followed",
               .unit = "rad",
               .evaluate = phase_error,
               .period = 2 * M_PI},
};

static void remember(const struct gm_view *view, double *entry)
{
    entry[0] = view->t;
    entry[1] = view->state[Q];
}

static const struct gm_track tracks[] = {
    {.key = "entries", .numbers = 2, .bound = 4096, .record = remember},
};

static void draw_position(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    enum { EXACT = 600 };
    struct gm_axis time;
    gm_time_axis(&time, lanes, count);
    double reach = 1;
    for (size_t i = 0; i < count; i++) {
        const struct gm_entries *entries = &lanes[i]->entries[0];
        for (size_t k = 0; k < entries->count; k++) {
            reach = fmax(reach, fmin(fabs(entries->values[2 * k + 1]), 10));
        }
    }
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const struct gm_lane *lane = walk.lane;
        const struct oscillator *self = lane->parameters;
        const enum gm_role role = gm_lane_role(lane->shown.colour);
        if (walk.first) {
            const double again = gm_lane_observe(lane, RESTARTS);
            panel = gm_walk_panel(
                picture, &walk,
                again > 0 ? gm_picture_text(picture, "%.0f restart%s", again, gm_plural(again)) : "");
            panel->axes = true;
            panel->x = time;
            panel->y = (struct gm_axis){.label = "q", .low = -1.15 * reach, .high = 1.15 * reach};
        }
        if (walk.first && self->system == HARMONIC) {
            double exact[2 * EXACT];
            for (size_t k = 0; k < EXACT; k++) {
                const double t = time.low + (time.high - time.low) * (double)k / (EXACT - 1);
                exact[2 * k] = t;
                exact[2 * k + 1] = self->q0 * cos(t - lane->t0) + self->p0 * sin(t - lane->t0);
            }
            gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 1.4, GM_SOLID}, exact, EXACT, false);
        }
        const struct gm_entries *entries = &lane->entries[0];
        gm_mark_line(picture, panel, (struct gm_style){role, 0.8, 1.6, gm_lane_dash(lane->shown.colour)},
                     entries->values, entries->count, false);
        gm_mark_switches(picture, panel, lane, false);
        if (entries->count < 1500) {
            gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 3.4},
                           entries->values, entries->count);
        }
    }
}

/* The curve begins as high as the point is. */
static size_t point(const void *self, double t, double q, struct gm_choice *choices)
{
    (void)self;
    (void)t;
    gm_choose(&choices[0], "q0", q);
    return 1;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct oscillator *self = lanes[0]->parameters;
    bool collapsed = false;
    for (size_t i = 0; i < count; i++) {
        collapsed |= lanes[i]->run->status == GM_STEP_COLLAPSE;
    }
    picture->title = gm_picture_text(picture, "Integrators that choose their step so that energy is kept");
    picture->subtitle =
        gm_picture_text(picture, "%s,  first step τ₀ = %.4g;  dots: the steps%s",
                        self->system == PENDULUM ? "pendulum" : "harmonic oscillator",
                        lanes[0]->settings.tau0, self->system == HARMONIC ? ",  grey: the exact motion" : "");
    picture->caption =
        collapsed
            ? "The printed rectangle rule finds no real step at the first turning point; the published motion over "
              "several periods needs restarts there."
            : "Energy is kept to round-off by construction; the price is a slip in phase.";
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    draw_position(picture, lanes, count);
    static const struct gm_graph graphs[] = {
        {.observable = "tau", .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 0.1},
        {.observable = "energy_error",
         .highest = true,
         .scale = GM_LOG,
         .calm_low = 1e-17,
         .calm_high = 1e-2},
    };
    gm_draw_graphs(picture, lanes, count, graphs, GM_COUNT(graphs));
}

static const char *const schemes[] = {"variational-rectangle",
                                      "variational-rectangle-restart",
                                      "variational-midpoint",
                                      "verlet",
                                      "midpoint",
                                      "rk4",
                                      NULL};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-16",
        .statement = "the solution of the rectangle-rule variational integrator is very close to the sine",
        .arguments = "scheme=variational-rectangle,variational-rectangle-restart tau0=0.02,5e-4 until=20",
    },
    {
        .name = "razafindralandy-17",
        .statement = "the error on the energy is below the machine precision",
        .arguments = "scheme=variational-rectangle-restart,variational-midpoint until=20",
    },
};

const struct gm_scene gm_scene_oscillator = {
    .name = "oscillator",
    .title = "One oscillator, steps by variation",
    .blurb =
        "If the action is varied in time as well as in place, the time step follows from the discrete energy balance, "
        "and the energy is kept to round-off.",
    .watch =
        "Watch the step τ near the turning points, where q changes slowly: as printed the rectangle rule ends there.",
    .time =
        "1/2π of the harmonic oscillator’s period; of the pendulum √(l/g), 1/2π of the period of a small swing",
    .size = sizeof(struct oscillator),
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
    .no_stability =
        "its schemes choose their steps; stability --region SCHEME shows the limit of one that does not",
    .follow = 1,
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
