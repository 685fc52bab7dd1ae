/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plane Kepler problem, a = 1, started at the pericentre of an ellipse of eccentricity e:
       H = |p|^2/2 - 1/|q| - perturbation/|q|^2,   q = (1 - e, 0),   p = (0, sqrt((1 + e)/(1 - e)))
   The exact motion keeps H, the angular momentum L = q1 p2 - q2 p1 and, unperturbed, the direction of the
   axis, that of the Laplace-Runge-Lenz vector p x L - q/|q|. What to look at: RK4 begins more accurate than
   the symplectic methods and loses, because its energy error grows and theirs does not; the axis turns under
   nearly all, whatever they keep.

   Razafindralandy, Hamdouni & Chhay (2018), section "Kepler's problem":
       figure 3   the energy errors of RK2 and RK4 grow
       figure 6   that of the symplectic method of order 4 stays bounded */
#include <math.h>
#include <stdio.h>

#include "core/expression/number.h"
#include "core/ode/problems/problems.h"
#include "scenes/common/graph.h"
#include "scenes/ode/asked.h"
#include "scenes/ode/hamiltonian.h"

enum { Q1, Q2, P1, P2 };

struct kepler {
    struct gm_timing timing;
    double eccentricity, perturbation;
    int show;
};

static const struct gm_parameter parameters[] = {
    GM_DT("2*pi/100", 1e-7, 1000),
    GM_UNTIL("40*pi"),
    GM_REAL_ROW(struct kepler, eccentricity, "eccentricity", "0.5", 0, 0.9999,
                "of the orbit, which starts at the pericentre"),
    GM_REAL_ROW(struct kepler, perturbation, "perturbation", "0", -0.1, 0.1,
                "the potential is −1/r − perturbation/r²"),
    GM_SHOW_ROW(struct kepler),
};

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct kepler *kepler = self;
    *problem = kepler->perturbation == 0 ? gm_problem_kepler : gm_problem_kepler_perturbed;
    problem->parameters = &kepler->perturbation;
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    (void)problem;
    const double e = ((const struct kepler *)self)->eccentricity;
    y[Q1] = 1 - e;
    y[Q2] = 0;
    y[P1] = 0;
    y[P2] = sqrt((1 + e) / (1 - e));
}

static double angular_momentum(const struct gm_view *view)
{
    const double *y = view->state;
    return y[Q1] * y[P2] - y[Q2] * y[P1];
}

/* The direction of p x L - q/r, which points to the pericentre. Of a circle it has none. */
static double lrl_angle(const struct gm_view *view)
{
    const struct kepler *kepler = view->parameters;
    const double *y = view->state;
    const double r = hypot(y[Q1], y[Q2]), momentum = angular_momentum(view);
    const double x = y[P2] * momentum - y[Q1] / r, z = -y[P1] * momentum - y[Q2] / r;
    return kepler->eccentricity < 1e-8 ? NAN : atan2(z, x);
}

static double position_error(const struct gm_view *view)
{
    if (!view->problem->exact) {
        return NAN;
    }
    double exact[4];
    view->problem->exact->solution(view->problem, view->t - view->t0, view->start, exact, 1);
    return hypot(view->state[Q1] - exact[Q1], view->state[Q2] - exact[Q2]);
}

/* That of the unperturbed orbit, to whatever the perturbation adds. */
static double natural_energy(const void *self)
{
    return (void)self, 0.5;
}

static const struct gm_observable observables[] = {
    GM_KEPT_OBSERVABLE("energy_error", gm_hamiltonian_energy, "H", "energy error", .scale = natural_energy,
                       .scale_text = "1/2"),
    GM_KEPT_OBSERVABLE("angular_momentum_error", angular_momentum, "L", "angular momentum error"),
    {.key = "lrl_angle",
     .title = "turn of the orbit's axis",
     .missing = "a circle has no axis",
     .unit = "rad",
     .evaluate = lrl_angle,
     .period = 2 * M_PI},
    GM_LOG_OBSERVABLE("position_error", position_error, "distance from the exact position",
                      .missing = "no exact solution is known with a perturbation"),
};

static void remember(const struct gm_view *view, double *entry)
{
    entry[0] = view->state[Q1];
    entry[1] = view->state[Q2];
}

static const struct gm_track tracks[] = {
    {.key = "trail", .numbers = 2, .every = 2 * M_PI / 160, .bound = 320, .recent = true, .record = remember},
};

/* A planet farther away than so many apocentres has left its orbit: its panel follows it, with a scale of its
   own. */
static const double farthest = 1.5;

static bool has_left(const struct gm_lane *lane)
{
    const struct kepler *kepler = lane->parameters;
    const double *state = gm_run_state(lane->run);
    return hypot(state[Q1], state[Q2]) > farthest * (1 + kepler->eccentricity);
}

/* The orbits that are compared share a range: the exact orbit's, more where one has left it, but no more than
   lets the exact one be seen. */
static void range_of(const struct gm_lane *const *lanes, size_t count, double bound, struct gm_axis *x,
                     struct gm_axis *y)
{
    double reach = 0;
    *x = *y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = 1, .high = 0};
    for (size_t i = 0; i < count; i++) {
        const struct kepler *kepler = lanes[i]->parameters;
        const double e = kepler->eccentricity, narrow = sqrt(1 - e * e);
        reach = fmax(reach, 1 + e);
        gm_range_add(&x->low, &x->high, -(1 + e));
        gm_range_add(&x->low, &x->high, 1 - e);
        gm_range_add(&y->low, &y->high, -narrow);
        gm_range_add(&y->low, &y->high, narrow);
    }
    for (size_t i = 0; i < count; i++) {
        const struct gm_entries *trail = &lanes[i]->entries[0];
        for (size_t k = 0; k < trail->count; k++) {
            const double *at = trail->values + 2 * k;
            if (hypot(at[0], at[1]) < bound * reach) {
                gm_range_add(&x->low, &x->high, at[0]);
                gm_range_add(&y->low, &y->high, at[1]);
            }
        }
    }
    /* in rare steps, so that a movie is calm */
    const double size = fmax(x->high - x->low, y->high - y->low);
    const double step = reach / 5 * fmax(1, pow(2, floor(log2(size / (4 * reach))))), air = 0.2;
    x->low = step * floor(x->low / step - air);
    x->high = step * ceil(x->high / step + air);
    y->low = step * floor(y->low / step - air);
    y->high = step * ceil(y->high / step + air);
}

static void draw_exact(struct gm_picture *picture, struct gm_panel *panel, double e)
{
    enum { POINTS = 240 };
    double points[2 * POINTS];
    for (size_t i = 0; i < POINTS; i++) {
        const double turn = 2 * M_PI * (double)i / POINTS;
        points[2 * i] = cos(turn) - e;
        points[2 * i + 1] = sqrt(1 - e * e) * sin(turn);
    }
    gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 1.4, GM_SOLID}, points, POINTS, true);
}

static const char *note_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const double *state = gm_run_state(lane->run), r = hypot(state[Q1], state[Q2]);
    if (has_left(lane)) {
        return gm_picture_text(picture, "%.3g from the sun, on a scale of its own", r);
    }
    /* the graph tells the greatest of every stretch of time */
    return gm_picture_text(picture, "energy error now %s", gm_power_text(picture, gm_lane_observe(lane, 0)));
}

static void draw_orbits(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    struct gm_axis x, y;
    range_of(lanes, count, farthest, &x, &y);
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const struct kepler *kepler = walk.lane->parameters;
        if (walk.first) {
            panel = gm_walk_panel(picture, &walk, note_of(picture, walk.lane));
            panel->x = x;
            panel->y = y;
            if (gm_walk_has_left(&walk, has_left)) {
                range_of(&walk.lane, 1, INFINITY, &panel->x, &panel->y);
            }
            panel->equal = true;
            const double sun[] = {0, 0};
            gm_mark_points(picture, panel, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 9}, sun, 1);
        }
        if (kepler->perturbation == 0) {
            draw_exact(picture, panel, kepler->eccentricity);
        }
        const struct gm_entries *trail = &walk.lane->entries[0];
        const enum gm_role role = gm_lane_role(walk.lane->shown.colour);
        gm_draw_trail(picture, panel, (struct gm_style){role, 0.9, 1.8, GM_SOLID}, trail->values,
                      trail->count);
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 10},
                       gm_run_state(walk.lane->run), 1);
    }
}

/* The orbit that has its pericentre or its apocentre as far from the centre as that. */
static size_t point(const void *self, double x, double y, struct gm_choice *choices)
{
    (void)self;
    gm_choose(&choices[0], "eccentricity", fmin(fabs(1 - hypot(x, y)), 0.99));
    return 1;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct kepler *kepler = lanes[0]->parameters;
    const double dt = lanes[0]->run->dt;
    const bool one_step = gm_one_step(lanes, count);
    bool one_orbit = true;
    for (size_t i = 1; i < count; i++) {
        const struct kepler *other = lanes[i]->parameters;
        one_orbit &=
            other->eccentricity == kepler->eccentricity && other->perturbation == kepler->perturbation;
    }
    double end = 0;
    for (size_t i = 0; i < count; i++) {
        end = fabs(lanes[i]->run->t) > fabs(end) ? lanes[i]->run->t : end;
    }
    const double periods = end / (2 * M_PI);
    picture->title = gm_picture_text(picture, "A Kepler orbit, followed by %s for %.4g period%s",
                                     gm_counted_schemes(lanes, count), periods, gm_plural(periods));
    const double part = 2 * M_PI / dt;
    const char *step = fabs(part - round(part)) < 1e-9 * part
                           ? gm_picture_text(picture, "T/%.0f", round(part))
                           : gm_picture_text(picture, "%.4g T", 1 / part);
    picture->subtitle = gm_picture_text(
        picture, "%s%s%s%s%s",
        one_orbit ? gm_picture_text(picture, "eccentricity %g", kepler->eccentricity) : "",
        one_orbit && kepler->perturbation != 0
            ? gm_picture_text(picture, ",  potential −1/r − %g/r²", kepler->perturbation)
            : "",
        one_step && one_orbit ? ",  " : "", one_step ? gm_picture_text(picture, "Δt = %s", step) : "",
        kepler->perturbation == 0 ? ";  grey: the exact orbit" : "");
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    draw_orbits(picture, lanes, count);
    static const struct gm_graph graphs[] = {
        {.observable = "energy_error", .highest = true, .scale = GM_LOG, .calm_low = 1e-6, .calm_high = 1},
        {.observable = "lrl_angle",
         .title = "turn of the orbit's axis, rad",
         .magnitude = true,
         .highest = true,
         .scale = GM_LOG,
         .calm_low = 1e-4,
         .calm_high = 1},
        {.observable = "angular_momentum_error",
         .highest = true,
         .scale = GM_LOG,
         .calm_low = 1e-16,
         .calm_high = 1e-2},
    };
    gm_draw_graphs(picture, lanes, count, graphs, GM_COUNT(graphs));
}

static const char *const schemes[] = {
    "rk2",   "rk4",         "rk4sym",           "gauss4",         "verlet",    "yoshida4", "midpoint",
    "logh2", "levi-civita", "symplectic-euler", "wisdom-holman2", "kahan-li8", NULL};

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-3",
        .statement = "the energy errors of RK2 and RK4 grow without limit",
        .arguments = "scheme=rk2,rk4 dt=2*pi/100 until=400*pi",
    },
    {
        .name = "razafindralandy-3-steps",
        .statement = "a shorter step reduces the error of RK2, not its growth",
        .arguments = "scheme=rk2 dt=2*pi/100,2*pi/200,2*pi/400,2*pi/800 until=400*pi",
    },
    {
        .name = "razafindralandy-6",
        .statement = "the energy error of the symplectic fourth-order method stays bounded, RK4's does not",
        .arguments = "scheme=rk2,rk4,rk4sym dt=2*pi/100 until=400*pi",
    },
};

static const struct gm_work work = {.arguments = "until=40*pi",
                                    .measure = "position_error",
                                    .coarsest = 2 * M_PI / 30,
                                    .halvings = 10,
                                    .is_exact = "wisdom-holman2"};

static double period(const void *self)
{
    (void)self;
    return 2 * M_PI;
}

static const double eccentricities[] = {0, 0.17, 0.33, 0.5, 0.66, 0.83, 0.99};
static const double steps[] = {1. / 2000, 1. / 1000, 1. / 500, 1. / 200, 1. / 100, 1. / 60, 1. / 40, 1. / 20};
static const char *const mapped[] = {"verlet", "rk4", "rk4sym", "gauss4", "logh2", "levi-civita", NULL};

static const struct gm_stability stability = {
    .arguments = "until=40*pi",
    .parameter = "eccentricity",
    .values = eccentricities,
    .value_count = GM_COUNT(eccentricities),
    .label = "h / T",
    .unit = period,
    .steps = steps,
    .step_count = GM_COUNT(steps),
    .kept = "energy_error",
    .error = "position_error",
    .schemes = mapped,
};

const struct gm_scene gm_scene_kepler = {
    .name = "kepler",
    .title = "A Kepler orbit",
    .blurb =
        "A planet on an ellipse, started at the pericentre. The exact motion keeps energy, angular momentum and the "
        "direction of the ellipse's axis, the Laplace-Runge-Lenz vector.",
    .watch =
        "Watch the energy: RK4 starts out more accurate than the symplectic methods and loses, because its error "
        "grows and theirs does not. Steps of equal length turn the axis, but for wisdom-holman2, which without "
        "perturbation is exact; it stands under logh2, what is composed of it and levi-civita, which step in a "
        "fictitious time and err in nothing but time, and nearly so where steps follow the motion and the order is high.",
    .time = "1/2π of the unperturbed orbit’s period, whatever its eccentricity",
    .size = sizeof(struct kepler),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .lanes = "scheme=rk2,rk4,verlet,rk4sym",
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    GM_ASKED_OF_HAMILTONIAN,
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .work = &work,
    .stability = &stability,
    .follow = 64,
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
