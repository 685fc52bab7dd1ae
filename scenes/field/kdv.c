/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons of the Korteweg-de Vries equation on a ring:
       u_t + eta u u_x + mu u_xxx = 0,   H = integral of mu u_x^2/2 - eta u^3/6
   with the mass, the integral of u, and that of u^2. One soliton, two of which the faster overtakes the
   other, or the cosine of Zabusky & Kruskal (Phys. Rev. Lett. 15 (1965) 240), which breaks up into solitons.
   What to look at: the largest stable step of each scheme, and its conserved quantities. Leapfrog is bound by
   dx^3, the multisymplectic box has no such limit. Razafindralandy, Hamdouni & Chhay (2018), section
   "Multisymplectic integrators", which has no figure of it.

   And the same from frames that move with the velocity lambda,
       (t, x, u) -> (t, x + lambda t, u + lambda/eta)
   drawn at rest: schemes that step in a moving frame, on nodes that move along, give one and the same from
   each; with show=frame the nodes around one and where the moving frame carries them, as in figures 19 to 23
   of that document for Burgers' equation. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/kdv_moving_frames.h"
#include "core/field/families/laws/profile.h"
#include "core/field/problems/dispersive.h"
#include "scenes/field/moving_frame.h"
#include "scenes/field/observed.h"

struct scene {
    struct gm_timing timing;
    struct gm_kdv kdv;
    double half_length, at;
    long points;
    int show;
};

static const char *const initials[] = {"soliton", "two-solitons", "cosine", NULL};

static const char *const frames[] = {"each", "fixed", "moving", NULL};

static const char *const shown[] = {"field", "energy-law", "momentum-law", "mass-law", "frame", NULL};
enum { SHOW_FRAME = 4 };

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
    GM_REAL_ROW(struct scene, kdv.lambda, "lambda", "0", -1e3, 1e3, "velocity of the frame"),
    GM_CHOICE_ROW(
        struct scene, kdv.frame, "frame", "each", frames,
        "nodes at rest in the frame, or moving by lambda dt per step, for invariant schemes only; each: "
        "moving for the invariant schemes, fixed for the others"),
    GM_CHOICE_ROW(
        struct scene, show, "show", "field", shown,
        "what is drawn over space and time: the field, or what each step leaves of a local law; or the "
        "moving frame: a node with its neighbours, and where the frame carries them"),
    GM_REAL_ROW(struct scene, at, "at", "31", -1e4, 1e4,
                "show=frame: the node nearest to this place of the original frame (31 for two solitons, "
                "1 beyond the start of one, 0.4 for the cosine, unless given)"),
};

/* The ring, the dispersion and the end that belong to a start. */
static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    (void)sentence;
    struct scene *scene = self;
    const bool cosine = scene->kdv.initial == GM_KDV_COSINE;
    if (!gm_is_given("at", keys, count) && scene->kdv.initial != GM_KDV_TWO) {
        scene->at = cosine ? 0.4 : scene->kdv.position + 1;
    }
    if (!gm_is_given("initial", keys, count)) {
        return true;
    }
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

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct scene *scene = self;
    *problem = gm_problem_kdv;
    problem->parameters = &scene->kdv;
    problem->line = gm_ring(scene->half_length, scene->points);
    if (scene->kdv.initial == GM_KDV_COSINE) {
        problem->line.first = 0;
    }
    problem->n = gm_wave_size(problem->line.points);
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    gm_kdv_levels(problem, ((const struct gm_timing *)self)->dt, y);
}

/* Returns how far the nodes have moved from their start, in the original frame. */
static double travelled(const struct gm_view *view)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    return gm_kdv_fixed(kdv, view->scheme) ? -kdv->lambda * view->t : 0;
}

/* Returns the exact solution in the original frame; NaN if it is not known. */
static double exact(const struct gm_view *view, double x)
{
    struct gm_kdv kdv = *gm_kdv_of(view->problem);
    if (!gm_kdv_is_known(&kdv, &view->problem->line, view->t)) {
        return NAN;
    }
    kdv.lambda = 0;
    return gm_kdv_exact(&kdv, &view->problem->line, x, view->t);
}

/* Returns the value in the original frame at a node's start; between nodes it is linear. */
static double at_rest(const struct gm_view *view, size_t node)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    const size_t points = view->problem->line.points;
    const double place = (double)node - travelled(view) / view->problem->line.dx;
    const double below = floor(place), part = place - below;
    const double around = below - floor(below / (double)points) * (double)points;
    const size_t here = around < (double)points ? (size_t)around : 0, next = here + 1 < points ? here + 1 : 0;
    const double u = part > 0 ? (1 - part) * view->state[here] + part * view->state[next] : view->state[here];
    return u - kdv->lambda / kdv->eta;
}

static double mass(const struct gm_view *view)
{
    return gm_kdv_mass(view->problem, view->state);
}

/* Returns an integral with the scheme's own gauge of space: another would show the error of the gauge. */
static double integral(const struct gm_view *view,
                       double (*of)(const struct gm_problem *problem, const double *profile))
{
    double *profile = gm_field_profile(view->problem, view->scheme, view->state);
    const double value = profile ? of(view->problem, profile) : NAN;
    free(profile);
    return value;
}

static double square(const struct gm_view *view)
{
    return integral(view, gm_kdv_square);
}

static double energy(const struct gm_view *view)
{
    return integral(view, gm_kdv_energy);
}

static double solution_error(const struct gm_view *view)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    double largest = 0;
    for (size_t i = 0; i < view->problem->line.points; i++) {
        const double here = exact(view, gm_grid1_node(&view->problem->line, i) + travelled(view));
        largest = gm_larger(fabs(view->state[i] - kdv->lambda / kdv->eta - here), largest);
    }
    return largest;
}

static double boost_defect(const struct gm_view *view)
{
    return gm_kdv_defect(view->problem, view->scheme, view->dt,
                         &(const struct gm_kdv_symmetry){.boost = 0.5, .scale = 1}, view->state);
}

static double scaling_defect(const struct gm_view *view)
{
    return gm_kdv_defect(view->problem, view->scheme, view->dt, &(const struct gm_kdv_symmetry){.scale = 1.3},
                         view->state);
}

#define NO_FRAME "the scheme does not step in a moving frame, or the step from here is not solved"

/* The halves of the cosine cancel in u and in u³: the integrals of |u| and η|u|³/6 over its period. */
static double mass_of_cosine(const void *self)
{
    return ((const struct scene *)self)->kdv.initial == GM_KDV_COSINE ? 4 / M_PI : 0;
}
static double energy_of_cosine(const void *self)
{
    const struct gm_kdv *kdv = &((const struct scene *)self)->kdv;
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
            "no exact solution is known for the cosine, nor for solitons whose tails meet on a short ring"),
    GM_LOCAL_LAWS,
    GM_LOG_OBSERVABLE("local_mass_residual", gm_view_content_residual, "residual of the local mass law",
                      .missing = GM_NO_LAW),
    GM_FORM_RESIDUAL,
    GM_LOG_OBSERVABLE("boost_defect", boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_FRAME),
    GM_LOG_OBSERVABLE("scaling_defect", scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_FRAME),
};

static void record(const struct gm_view *view, double *entry)
{
    const int show = ((const struct scene *)view->parameters)->show;
    gm_surface_record_shown(view, show == SHOW_FRAME ? GM_SHOW_FIELD : show, at_rest, entry);
}

static const struct gm_track tracks[] = {GM_SURFACE_TRACK(record)};

/* The one soliton starts there. */
static size_t point(const void *self, double x, double u, struct gm_choice *choices)
{
    (void)u;
    gm_choose(&choices[0], "position", x);
    return ((const struct scene *)self)->kdv.initial == GM_KDV_SOLITON ? 1 : 0;
}

/* Returns the moving frame at a node in which the lane's scheme steps next; the scaling that makes the nodes
   `unit` apart follows the boost. */
static struct gm_moving_frame moving_frame(const struct gm_lane *lane, double unit)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_kdv *kdv = gm_kdv_of(view.problem);
    const struct gm_grid1 *grid = &view.problem->line;
    const size_t points = grid->points;
    const double sigma = gm_kdv_fixed(kdv, view.scheme) ? 0 : kdv->lambda * view.dt;
    const double at = ((const struct scene *)view.parameters)->at - travelled(&view);
    const double turns = floor((at - grid->first) / (grid->dx * (double)points));
    const size_t j = gm_stencil_node(grid, at - turns * grid->dx * (double)points);
    double *boosts = malloc(points * sizeof *boosts);
    struct gm_moving_frame made = {
        .known = gm_kdv_has_frames(view.scheme) && boosts &&
                 gm_kdv_moving_frames(view.problem, view.scheme, view.dt, view.state, boosts)};
    const struct gm_kdv_symmetry frame = {.boost = made.known ? boosts[j] : 0, .scale = unit / grid->dx};
    for (size_t e = 0; made.known && e < 2 * GM_STENCIL; e++) {
        const size_t i = j + e % GM_STENCIL - GM_STENCIL / 2;
        const bool next = e >= GM_STENCIL;
        made.seen[e] = (struct gm_event){.t = next ? view.dt : 0,
                                         .x = ((double)i - (double)j) * grid->dx + (next ? sigma : 0),
                                         .u = view.state[i]};
        made.carried[e] = gm_kdv_carried(kdv, &frame, made.seen[e]);
    }
    free(boosts);
    return made;
}

static void draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    const double h = lanes[0]->problem.line.dx;
    struct gm_moving_frame *made = gm_picture_memory(picture, count * sizeof *made);
    bool any = false, all = true;
    for (size_t i = 0; made && i < count; i++) {
        made[i] = moving_frame(lanes[i], h);
        any |= gm_kdv_solves(lanes[i]->scheme);
        all &= gm_kdv_solves(lanes[i]->scheme);
    }
    picture->title = "The moving frame at a node of the Korteweg-de Vries equation";
    picture->subtitle = gm_picture_text(picture, "the node nearest to x = %g,  h = %.3g,  k = %s,  and ĥ = h",
                                        scene->at, h, gm_step_text(picture, lanes[0]->run->dt));
    const struct gm_axes_style look = {.h = h,
                                       .k = lanes[0]->run->dt,
                                       .value = "u",
                                       .carried = "û",
                                       .section = all ? "û + v̂ⱼ = 0 where the node arrives"
                                                  : any
                                                      ? "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0, or û + v̂ⱼ = 0 where it arrives"
                                                      : "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0"};
    gm_draw_clock(picture, lanes, count);
    if (made) {
        gm_draw_moving_frame(picture, lanes, count, made, &look);
    }
}

/* Writes why evolution and projection cannot step. */
static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    double steepest = 0;
    for (size_t i = 0; i < grid->points; i++) {
        const size_t right = i + 1 < grid->points ? i + 1 : 0;
        steepest = fmax(steepest, kdv->eta * fabs(view->state[right] - view->state[i]) / grid->dx);
    }
    text[0] = '\0';
    if (gm_kdv_solves(view->scheme) && steepest * fabs(view->dt) >= 2) {
        snprintf(text, size,
                 "neighbours that move with the wave meet within a step: eta |u_x| dt = %.3g is not below 2",
                 steepest * fabs(view->dt));
    }
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    if (scene->show == SHOW_FRAME) {
        draw_frame(lanes, count, picture);
        return;
    }
    static const char *const titles[] = {"A soliton of the Korteweg-de Vries equation",
                                         "One Korteweg-de Vries soliton overtakes another",
                                         "A cosine breaks up into Korteweg-de Vries solitons"};
    const bool cosine = scene->kdv.initial == GM_KDV_COSINE;
    const double highest = cosine                             ? 2.5
                           : scene->kdv.initial == GM_KDV_TWO ? 5 * scene->kdv.mu / scene->kdv.eta
                                                              : 3.2 * scene->kdv.velocity / scene->kdv.eta;
    bool boosted = false;
    for (size_t i = 0; i < count; i++) {
        boosted |= gm_kdv_of(&lanes[i]->problem)->lambda != 0;
    }
    const struct gm_field_look look = {.value = at_rest,
                                       .exact = cosine ? NULL : exact,
                                       .name = "u",
                                       .low = cosine ? -1 : 0,
                                       .high = highest,
                                       .map = GM_MAP_SEQUENTIAL,
                                       .show = scene->show,
                                       .content = "mass"};
    picture->title = titles[scene->kdv.initial];
    if (boosted) {
        picture->title = gm_picture_text(picture, "%s, drawn at rest", picture->title);
    }
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

static const char *const schemes[] = {
    "box",          "zabusky-kruskal",           "fourier-rk4",          "euler-box",
    "midpoint-box", "zabusky-kruskal-invariant", "evolution-projection", NULL};

/* Laws and frames need schemes that have them. */
static const struct gm_preference preferences[] = {
    {"show=energy-law", {"box"}},
    {"show=momentum-law", {"box"}},
    {"show=mass-law", {"box"}},
    {"show=frame", {"evolution-projection"}},
    {NULL, {NULL}},
};

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

/* Returns the scale of leapfrog's limit, 0.385 dx^3/mu (Zabusky & Kruskal). */
static double dispersion_time(const void *self)
{
    const struct scene *scene = self;
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
        "One soliton, two, or Zabusky's and Kruskal's cosine, with the multisymplectic box and with leapfrog, whose "
        "step is bounded by 0.385 Δx³/μ; the Euler box and the midpoint box are explicit and multisymplectic, bound by "
        "Δx³/4μ and Δx³/μ. Two schemes step in a moving frame, and give the same whatever lambda is.",
    .watch =
        "Watch what a step costs: at Δx = 0.2 leapfrog blows up beyond Δt = 0.003, the box runs with 0.05; at "
        "equal Δt and Δx its error is the larger one, by a factor of 1.5, so the box gains its step and nothing else. The "
        "Fourier method has a hundredth of its error with Δt = 0.025, and blows up with 0.05, unlike the box. From "
        "a frame of velocity 4 leapfrog's error is six times that at rest; the invariant one has the same to round-off.",
    .time = "that in which the equation has η and μ as given",
    .size = sizeof(struct scene),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .preferences = preferences,
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
    .failure = tell_failure,
    .draw = draw,
    .point = point,
};
