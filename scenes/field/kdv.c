/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons of the Korteweg-de Vries equation on a ring:
       u_t + eta u u_x + mu u_xxx = 0,   H = integral of mu u_x^2/2 - eta u^3/6
   with the mass, the integral of u, and that of u^2. One soliton, two of which the faster overtakes the
   other, or the cosine of Zabusky & Kruskal (Phys. Rev. Lett. 15 (1965) 240), which breaks up into solitons.
   What to look at: how long a step each scheme bears, and what it keeps: leapfrog is bound by dx^3, the
   multisymplectic box by no such limit. Razafindralandy, Hamdouni & Chhay (2018), section "Multisymplectic
   integrators", which has no figure of it. */
#include <math.h>
#include <string.h>

#include "core/field/problems/dispersive.h"
#include "scenes/field/local_laws.h"

struct scene {
    struct gm_timing timing;
    struct gm_kdv kdv;
    double half_length;
    long points;
    int show;
};

static const char *const initials[] = {"soliton", "two-solitons", "cosine", NULL};

static const char *const shown[] = {"field", "energy-law", "momentum-law", "mass-law", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.05", 1e-9, 10),
    GM_UNTIL("40"),
    GM_CHOICE_ROW(
        struct scene, kdv.initial, "initial", "two-solitons", initials,
        "one soliton; two that overtake; cos πx, which breaks up into solitons (half_length 1, mu 0.022², "
        "until 3.6/π unless given)"),
    GM_REAL_ROW(struct scene, kdv.velocity, "velocity", "1", 1e-3, 100, "of the one soliton, c",
                .logarithmic = true),
    GM_REAL_ROW(struct scene, kdv.position, "position", "-5", -1e4, 1e4, "of the one soliton at t = 0"),
    GM_REAL_ROW(struct scene, kdv.eta, "eta", "1", 1e-6, 1e3, "coefficient of u uₓ", .logarithmic = true),
    GM_REAL_ROW(struct scene, kdv.mu, "mu", "1", 1e-9, 1e3, "coefficient of uₓₓₓ", .logarithmic = true),
    GM_HALF_LENGTH(
        struct scene, half_length, "50",
        "half the length of the ring (50 for two solitons, 20 for one, 1 for the cosine, unless given)"),
    GM_POINTS(struct scene, points, "1001", 5, "of the grid"),
    GM_LAW_ROW(struct scene, show, shown),
};

/* The ring, the dispersion and the end that belong to a start. */
static bool settle(void *own, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    struct scene *scene = own;
    if (!gm_is_given("initial", keys, count)) {
        return true;
    }
    const bool cosine = scene->kdv.initial == GM_KDV_COSINE;
    if (!gm_is_given("half_length", keys, count)) {
        scene->half_length = cosine ? 1 : scene->kdv.initial == GM_KDV_TWO ? 50 : 20;
    }
    if (!gm_is_given("mu", keys, count)) {
        scene->kdv.mu = cosine ? 0.022 * 0.022 : 1;
    }
    if (cosine && !gm_is_given("until", keys, count)) {
        scene->timing.until = 3.6 / M_PI;
    }
    if (cosine && !gm_is_given("dt", keys, count)) {
        scene->timing.dt = 1e-3;
    }
    return true;
}

static bool setup(const void *own, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct scene *scene = own;
    *problem = gm_problem_kdv;
    problem->parameters = &scene->kdv;
    problem->line = gm_ring(scene->half_length, scene->points);
    if (scene->kdv.initial == GM_KDV_COSINE) {
        problem->line.first = 0;
    }
    problem->n = gm_wave_size(problem->line.points);
    return true;
}

static void start(const void *own, const struct gm_problem *problem, double *y)
{
    gm_kdv_levels(problem, ((const struct gm_timing *)own)->dt, y);
}

/* NaN where it is not known. */
static double exact(const struct gm_view *view, double x)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    if (!gm_kdv_is_known(kdv, &view->problem->line, view->t)) {
        return NAN;
    }
    return gm_kdv_exact(kdv, &view->problem->line, x, view->t);
}

static double mass(const struct gm_view *view)
{
    return gm_kdv_mass(view->problem, view->state);
}

static double square(const struct gm_view *view)
{
    return gm_kdv_square(view->problem, view->state);
}

static double energy(const struct gm_view *view)
{
    return gm_kdv_energy(view->problem, view->state);
}

static double solution_error(const struct gm_view *view)
{
    return gm_field_error(view, exact);
}

/* The halves of the cosine cancel in u and in u³: the integrals of |u| and η|u|³/6 over its period. */
static double mass_of_cosine(const void *own)
{
    return ((const struct scene *)own)->kdv.initial == GM_KDV_COSINE ? 4 / M_PI : 0;
}
static double energy_of_cosine(const void *own)
{
    const struct gm_kdv *kdv = &((const struct scene *)own)->kdv;
    return kdv->initial == GM_KDV_COSINE ? 4 * kdv->eta / (9 * M_PI) : 0;
}

static const struct gm_observable observables[] = {
    GM_KEPT_OBSERVABLE("mass_error", mass, "M", "error of the mass ∫u", .scale = mass_of_cosine,
                       .scale_text = "4/π for the cosine"),
    GM_KEPT_OBSERVABLE("square_error", square, "S", "error of ∫u²"),
    GM_KEPT_OBSERVABLE("energy_error", energy, "H", "energy error", .scale = energy_of_cosine,
                       .scale_text = "4η/9π for the cosine"),
    GM_LOG_OBSERVABLE(
        "solution_error", solution_error, "largest error of u",
        .missing =
            "no exact solution is known of the cosine, nor of solitons whose tails meet on a short ring"),
    GM_LOCAL_LAWS,
    GM_LOG_OBSERVABLE("local_mass_residual", gm_view_content_residual, "residual of the local mass law",
                      .missing = GM_NO_LAW),
    GM_FORM_RESIDUAL,
};

static void record(const struct gm_view *view, double *entry)
{
    gm_surface_record_shown(view, ((const struct scene *)view->parameters)->show, gm_field_u, entry);
}

static const struct gm_track tracks[] = {GM_SURFACE_TRACK(record)};

/* The one soliton starts there. */
static size_t point(const void *own, double x, double u, struct gm_choice *choices)
{
    (void)u;
    gm_choose(&choices[0], "position", x);
    return ((const struct scene *)own)->kdv.initial == GM_KDV_SOLITON ? 1 : 0;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    static const char *const titles[] = {"A soliton of the Korteweg-de Vries equation",
                                         "One Korteweg-de Vries soliton overtakes another",
                                         "A cosine breaks up into Korteweg-de Vries solitons"};
    const bool cosine = scene->kdv.initial == GM_KDV_COSINE;
    const double highest = cosine                             ? 2.5
                           : scene->kdv.initial == GM_KDV_TWO ? 5 * scene->kdv.mu / scene->kdv.eta
                                                              : 3.2 * scene->kdv.velocity / scene->kdv.eta;
    const struct gm_field_look look = {.value = gm_field_u,
                                       .exact = cosine ? NULL : exact,
                                       .name = "u",
                                       .low = cosine ? -1 : 0,
                                       .high = highest,
                                       .map = GM_MAP_SEQUENTIAL,
                                       .show = scene->show,
                                       .content = "mass"};
    picture->title = titles[scene->kdv.initial];
    picture->subtitle = gm_picture_text(picture, "η = %g,  μ = %.3g,  %ld points%s", scene->kdv.eta,
                                        scene->kdv.mu, scene->points, gm_shared_step(picture, lanes, count));
    const struct gm_graph graphs[] = {
        {.observable = "solution_error", .highest = true, .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 1},
        {.observable = "square_error",
         .highest = true,
         .scale = GM_LOG,
         .calm_low = 1e-12,
         .calm_high = 1e-2},
    };
    /* the cosine has no exact solution */
    gm_draw_field(picture, lanes, count, &look, cosine ? graphs + 1 : graphs, cosine ? 1 : 2);
}

static const char *const schemes[] = {"box",       "zabusky-kruskal", "fourier-rk4",
                                      "euler-box", "midpoint-box",    NULL};

/* The error of the mesh hides that of the step, and the other way round: both are refined. */
static const double mesh_points[] = {101, 201, 401, 801};
static const double compared[] = {1e-1, 1e-2, 1e-3};
static const struct gm_work work = {.arguments = "initial=soliton until=4",
                                    .measure = "solution_error",
                                    .coarsest = 0.2,
                                    .halvings = 7,
                                    .resolution = "points",
                                    .resolutions = mesh_points,
                                    .resolution_count = GM_COUNT(mesh_points),
                                    .errors = compared};

/* What leapfrog can take: 0.385 dx^3/mu (Zabusky & Kruskal). */
static double dispersion_time(const void *own)
{
    const struct scene *scene = own;
    const double dx = 2 * scene->half_length / (double)scene->points;
    return dx * dx * dx / scene->kdv.mu;
}

/* The amplitude of a soliton is 3 times its velocity. */
static const double velocities[] = {0.25, 0.5, 1, 2};
static const double steps[] = {0.1, 0.2, 0.3, 0.37, 0.4, 0.5, 1, 4, 16};

static const struct gm_stability stability = {
    .arguments = "initial=soliton points=101 until=10",
    .parameter = "velocity",
    .values = velocities,
    .value_count = GM_COUNT(velocities),
    .label = "Δt μ / Δx³",
    .unit = dispersion_time,
    .steps = steps,
    .step_count = GM_COUNT(steps),
    .kept = "square_error",
};

const struct gm_scene gm_scene_kdv = {
    .name = "kdv",
    .title = "Solitons of the Korteweg-de Vries equation",
    .blurb =
        "One soliton, two, or Zabusky's and Kruskal's cosine, by the multisymplectic box and by leapfrog, whose step "
        "is bound by 0.385 Δx³/μ; the Euler box and the midpoint box are explicit and multisymplectic, bound by "
        "Δx³/4μ and Δx³/μ.",
    .watch =
        "Watch what a step costs: at Δx = 0.2 leapfrog blows up beyond Δt = 0.003, the box runs with 0.05; at "
        "equal Δt and Δx its error is the larger one, by a factor of 1.5, so the box gains its step and nothing else. The "
        "Fourier method has a hundredth of its error with Δt = 0.025, and blows up with 0.05, where the box goes on.",
    .time = "that in which the equation has η and μ as given",
    .size = sizeof(struct scene),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .lanes = "scheme=box,zabusky-kruskal dt=0.05,0.0025 points=501 zip=yes",
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .tracks = tracks,
    .track_count = GM_COUNT(tracks),
    .work = &work,
    .stability = &stability,
    .settle = settle,
    .setup = setup,
    .start = start,
    .draw = draw,
    .point = point,
};
