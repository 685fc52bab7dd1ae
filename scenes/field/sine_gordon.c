/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons of the sine-Gordon equation on a ring: a breather, a kink, two kinks that meet,
       u_tt - u_xx + sin u = 0,   H = integral of u_t^2/2 + u_x^2/2 + 1 - cos u
   What to look at: at dt = dx leapfrog roughens near t = 25 and breaks the breather, although its
   multisymplectic law holds to round-off: it is unstable there, as its limit is 4/dt^2 >= 4/dx^2 + 1. The
   local laws of energy and momentum show what each scheme breaks.

   Razafindralandy, Hamdouni & Chhay (2018), section "Multisymplectic integrators":
       figure 11   dt = dx, until the leapfrog has destroyed the breather
       figure 12   the energy-conserving and the multisymplectic scheme until t = 500
       figure 13   twice the time step, where the energy-conserving scheme blows up */
#include <math.h>

#include "core/field/problems/sine_gordon.h"
#include "core/field/problems/wave.h"
#include "scenes/field/observed.h"

struct scene {
    struct gm_timing timing;
    struct gm_sine_gordon solution;
    double half_length;
    long points;
    int show;
};

static const char *const initials[] = {"breather",      "kink",          "antikink",
                                       "kink-antikink", "antikink-kink", NULL};

static const char *const shown[] = {"field", "energy-law", "momentum-law", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.05", 1e-6, 100),
    GM_UNTIL("40"),
    GM_CHOICE_ROW(struct scene, solution.initial, "initial", "breather", initials,
                  "exact solution to start from; antikink-kink is a collision"),
    GM_REAL_ROW(struct scene, solution.frequency, "frequency", "0.5", 0.01, 0.9999, "of the breather, ω"),
    GM_REAL_ROW(struct scene, solution.velocity, "velocity", "0.5", -0.9999, 0.9999,
                "of the kinks, where light has 1"),
    GM_REAL_ROW(struct scene, solution.position, "position", "-5", -1e4, 1e4,
                "of a kink at t = 0; in a collision, of both from the middle"),
    GM_HALF_LENGTH(struct scene, half_length, "20", "the ring is −half_length ≤ x < half_length"),
    GM_POINTS(struct scene, points, "800", 3, "of the grid"),
    GM_LAW_ROW(struct scene, show, shown),
};

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct scene *scene = self;
    *problem = gm_problem_sine_gordon;
    problem->parameters = &scene->solution;
    problem->line = gm_ring(scene->half_length, scene->points);
    problem->line.jump = gm_sine_gordon_jump(&scene->solution);
    problem->n = gm_wave_size(problem->line.points);
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    gm_sine_gordon_levels(problem, 0, ((const struct gm_timing *)self)->dt, y);
}

/* Returns the exact solution; NaN if it is not known. */
static double exact(const struct gm_view *view, double x)
{
    const struct scene *scene = view->parameters;
    if (!gm_sine_gordon_is_known(&scene->solution, scene->half_length, view->t)) {
        return NAN;
    }
    return gm_sine_gordon_exact(&scene->solution, scene->half_length, x, view->t);
}

/* The error at nodes as gm_sine_gordon_levels places them: the start has no error at all. */
static double solution_error(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    double largest = 0;
    for (size_t i = 0; i < grid->points; i++) {
        const double error = fabs(view->state[i] - exact(view, grid->first + (double)i * grid->dx));
        largest = error > largest || isnan(error) ? error : largest;
    }
    return largest;
}

static const struct gm_observable observables[] = {
    GM_WAVE_INVARIANTS,
    GM_LOG_OBSERVABLE("solution_error", solution_error, "largest error of u",
                      .missing = "no exact solution is known of waves whose tails meet on a short ring"),
    GM_WAVE_LAWS,
};

static void record(const struct gm_view *view, double *entry)
{
    gm_surface_record_shown(view, ((const struct scene *)view->parameters)->show, gm_field_u, entry);
}

static const struct gm_track tracks[] = {GM_SURFACE_TRACK(record)};

/* A kink starts there; the second of two at the mirror image. */
static size_t point(const void *self, double x, double u, struct gm_choice *choices)
{
    const struct scene *scene = self;
    (void)u;
    const bool one = scene->solution.initial == GM_KINK || scene->solution.initial == GM_ANTIKINK;
    gm_choose(&choices[0], "position", one ? x : -fabs(x));
    return one || scene->solution.initial == GM_KINK_COLLISION ? 1 : 0;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    static const char *const titles[] = {
        "A breather of the sine-Gordon equation", "A kink of the sine-Gordon equation",
        "An antikink of the sine-Gordon equation", "A sine-Gordon kink and antikink part",
        "A sine-Gordon antikink and kink collide"};
    const double jump = gm_sine_gordon_jump(&scene->solution);
    const bool whole = jump != 0;
    const double highest = scene->solution.initial == GM_BREATHER ? 5 : 2 * M_PI;
    struct gm_field_look look = {.value = gm_field_u,
                                 .exact = exact,
                                 .name = "u",
                                 .low = -highest,
                                 .high = highest,
                                 .show = scene->show};
    look.map = whole ? GM_MAP_SEQUENTIAL : GM_MAP_DIVERGING;
    look.low = whole ? 0 : -highest;
    picture->title = titles[scene->solution.initial];
    picture->subtitle = gm_picture_text(
        picture, "%s = %g,  %ld points,  Δx = %g%s",
        scene->solution.initial == GM_BREATHER ? "ω" : "velocity",
        scene->solution.initial == GM_BREATHER ? scene->solution.frequency : scene->solution.velocity,
        scene->points, lanes[0]->problem.line.dx, gm_shared_step(picture, lanes, count));
    const struct gm_graph graphs[] = {
        {.observable = "solution_error", .highest = true, .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 1},
        {.observable = "own_energy_error",
         .highest = true,
         .scale = GM_LOG,
         .calm_low = 1e-16,
         .calm_high = 1e-2},
    };
    gm_draw_field(picture, lanes, count, &look, graphs, GM_COUNT(graphs));
}

static const struct gm_figure figures[] = {
    {
        .name = "razafindralandy-11",
        .statement =
            "at Δt = Δx leapfrog is unstable and destroys the breather before t = 30, the box scheme does not",
        .arguments = "scheme=leapfrog,box dt=0.05 until=40",
    },
    {
        .name = "razafindralandy-12",
        .statement = "the energy-conserving and the multisymplectic scheme stay stable until t = 500",
        .arguments = "scheme=energy-conserving,box dt=0.05 until=500",
    },
    {
        .name = "razafindralandy-13",
        .statement =
            "with twice the time step the energy-conserving scheme blows up, the multisymplectic one "
            "still gives a breather",
        .arguments = "scheme=energy-conserving,box dt=0.1 until=140",
    },
};

/* The error of the mesh hides that of the step, and the other way round: both are refined. */
static const double mesh_points[] = {300, 600, 1200, 2400};
static const double compared[] = {1e-1, 1e-2, 1e-3};
static const struct gm_work work = {.arguments = "until=10 half_length=30",
                                    .measure = "solution_error",
                                    .coarsest = 0.4,
                                    .halvings = 5,
                                    .resolution = "points",
                                    .resolutions = mesh_points,
                                    .resolution_count = GM_COUNT(mesh_points),
                                    .errors = compared};

/* A Courant number of 1. */
static double crossing_time(const void *self)
{
    const struct scene *scene = self;
    return 2 * scene->half_length / (double)scene->points;
}

/* The lower its frequency, the higher a breather: up to 4 atan(sqrt(1 - w^2) / w). */
static const double frequencies[] = {0.1, 0.3, 0.5, 0.7, 0.9};
static const double courant_numbers[] = {0.25, 0.5, 0.9, 0.99, 1, 1.01, 1.5, 2, 4, 8};

static const struct gm_stability stability = {
    .arguments = "until=60 points=200",
    .parameter = "frequency",
    .values = frequencies,
    .value_count = GM_COUNT(frequencies),
    .label = "Δt / Δx",
    .unit = crossing_time,
    .steps = courant_numbers,
    .step_count = GM_COUNT(courant_numbers),
    .kept = "energy_error",
};

const struct gm_scene gm_scene_sine_gordon = {
    .name = "sine-gordon",
    .title = "Solitons of the sine-Gordon equation",
    .blurb =
        "A breather, a kink or a collision on a ring, by leapfrog, which is explicit, an energy-conserving scheme "
        "and the box; leapfrog and the box are multisymplectic. At Δt = Δx leapfrog lies beyond its Courant limit 4/Δt² ≥ 4/Δx² + 1: rounding grows "
        "until it destroys the wave. The box has no such limit: up to Δt = 2 the equations of its step "
        "have one solution, beyond maybe several.",
    .watch =
        "Watch leapfrog roughen near t = 25 and break the breather by t = 31, as published; it is not for want of "
        "a multisymplectic law, which leapfrog keeps to round-off, but of stability: until=600 shows it blow up.",
    .time = "what light needs for a length of 1",
    .size = sizeof(struct scene),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = gm_wave_schemes,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .figures = figures,
    .figure_count = GM_COUNT(figures),
    .work = &work,
    .stability = &stability,
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
