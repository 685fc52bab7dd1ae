/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The heat equation, seen from frames that move with the velocity lambda:
       u_t = nu u_xx,   (t, x, u) -> (t, x + lambda t, u exp(-lambda x/(2 nu) - lambda^2 t/(4 nu)))
   Scalings, boosts and projections turn solutions into solutions. The ordinary scheme preserves only the
   scalings, and its error grows with the frame's velocity; schemes that step in a moving frame give one and
   the same profile from each. What to look at: the error at the end, from frames that are faster and faster,
   and how exact the scheme with projections is on a kernel. With show=frame: the nodes around one and the
   values there, and where the moving frame carries them.

   Razafindralandy, Hamdouni & Chhay (2018), section "Invariant integrators", eqs. 73 to 75 and 83. */
#include <math.h>
#include <stdio.h>

#include "core/field/families/heat.h"
#include "scenes/field/field.h"
#include "scenes/field/moving_frame.h"

struct scene {
    struct gm_timing timing;
    struct gm_heat heat;
    double dx, half_length, at;
    int show;
};

static const char *const starts[] = {"kernel", "two-kernels", "front", NULL};
static const char *const frames[] = {"each", "fixed", "moving", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.0025", 1e-9, 10),
    GM_UNTIL("0.5"),
    GM_CHOICE_ROW(
        struct scene, heat.start, "start", "two-kernels", starts,
        "a kernel, exp(−x²/4νs)/√s of the age s; two of different ages; a front, which is one of erfc"),
    GM_REAL_ROW(struct scene, heat.diffusivity, "diffusivity", "1", 1e-6, 1e3, "ν", .logarithmic = true),
    GM_REAL_ROW(struct scene, heat.age, "age", "0.25", 1e-6, 1e3, "of the start: the older, the wider",
                .logarithmic = true),
    GM_REAL_ROW(struct scene, dx, "dx", "0.1", 1e-5, 10, "distance of the nodes; made to divide the interval",
                .logarithmic = true),
    GM_REAL_ROW(struct scene, half_length, "half_length", "6", 1e-2, 1e3,
                "half the length of the interval, whose middle is drawn", .logarithmic = true),
    GM_REAL_ROW(struct scene, heat.lambda, "lambda", "0", -1e3, 1e3, "velocity of the frame"),
    GM_CHOICE_ROW(
        struct scene, heat.frame, "frame", "each", frames,
        "nodes at rest in the frame, or moving by lambda dt per step, for invariant schemes only; each: "
        "moving for the invariant schemes, fixed for the other"),
    GM_FRAME_ROWS(struct scene, show, at, "0.5"),
};

static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    (void)keys, (void)count, (void)sentence;
    struct scene *scene = self;
    scene->dx = 2 * scene->half_length / fmax(4, round(2 * scene->half_length / scene->dx));
    return true;
}

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    const struct scene *scene = self;
    const double pieces = round(2 * scene->half_length / scene->dx), most = 1e7, most_power = 300;
    const double lambda = fabs(scene->heat.lambda), travel = lambda * fmin(scene->timing.until, 1e6);
    const double power =
        lambda / (4 * scene->heat.diffusivity) * (2 * scene->half_length + 2 * travel + travel);
    if (!(pieces < most)) {
        return gm_refuse(sentence, "%.3g nodes are more than 1e7", pieces + 1);
    }
    if (!(power <= most_power)) {
        return gm_refuse(
            sentence,
            "the boost multiplies the ends by exp(%.3g), and exp(300) is the most: a smaller lambda, "
            "half_length or until, or a larger diffusivity",
            power);
    }
    *problem = gm_problem_heat;
    problem->parameters = &scene->heat;
    problem->line =
        (struct gm_grid1){.points = (size_t)pieces + 1, .dx = scene->dx, .first = -scene->half_length};
    problem->n = problem->line.points;
    return true;
}

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    (void)self;
    for (size_t j = 0; j < problem->n; j++) {
        y[j] = gm_heat_exact(gm_heat_of(problem), true, gm_grid1_node(&problem->line, j), 0);
    }
}

/* Returns the value at a node in the original frame. */
static double at_rest(const struct gm_view *view, size_t j)
{
    const struct gm_heat *heat = gm_heat_of(view->problem);
    return view->state[j] / gm_heat_factor(heat, gm_heat_fixed(heat, view->scheme),
                                           gm_grid1_node(&view->problem->line, j), view->t);
}

static double sup_error(const struct gm_view *view)
{
    const struct gm_heat *heat = gm_heat_of(view->problem);
    const bool fixed = gm_heat_fixed(heat, view->scheme);
    double largest = 0;
    for (size_t j = 0; j < view->problem->n; j++) {
        const double x = gm_grid1_node(&view->problem->line, j);
        const double exact = gm_heat_exact(heat, fixed, x, view->t);
        largest = fmax(largest, fabs(view->state[j] - exact) / gm_heat_factor(heat, fixed, x, view->t));
    }
    return largest;
}

static double defect(const struct gm_view *view, const struct gm_heat_symmetry *symmetry)
{
    return gm_heat_defect(view->problem, view->scheme, view->dt, symmetry, view->state);
}

static double boost_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_heat_symmetry){.boost = 0.5, .scale = 1});
}

static double projection_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_heat_symmetry){.projection = 0.5, .scale = 1});
}

static double scaling_defect(const struct gm_view *view)
{
    return defect(view, &(const struct gm_heat_symmetry){.scale = 1.3});
}

#define NO_FRAME "a value is not positive, or the projection does not exist"

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("sup_error", sup_error, "largest error, at rest"),
    GM_LOG_OBSERVABLE("boost_defect", boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_FRAME),
    GM_LOG_OBSERVABLE("projection_defect", projection_defect, "defect of a step under a projection by 1/2",
                      .missing = NO_FRAME),
    GM_LOG_OBSERVABLE("scaling_defect", scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_FRAME),
};

/* Writes why an invariant scheme cannot step. */
static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_grid1 *grid = &view->problem->line;
    for (size_t j = 1; gm_heat_keeps(view->scheme) & GM_HEAT_BOOSTS && j + 1 < grid->points; j++) {
        const struct gm_heat_symmetry frame = gm_heat_frame(
            view->scheme, gm_heat_of(view->problem)->diffusivity, grid->dx, view->state + j - 1);
        if (!isfinite(frame.boost)) {
            snprintf(text, size, "u is not positive near x = %.4g, where no boost levels it",
                     gm_grid1_node(grid, j));
            return;
        }
        if (frame.projection * view->dt >= 1) {
            snprintf(text, size, "no projection levels u near x = %.4g: p dt = %.3g is not below 1",
                     gm_grid1_node(grid, j), frame.projection * view->dt);
            return;
        }
    }
}

/* Returns the moving frame at a node: the frame of the lane's scheme, or boosts if that has no frame. */
static struct gm_moving_frame stencil(const struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct scene *scene = lane->parameters;
    const struct gm_grid1 *grid = &view.problem->line;
    const bool fixed = gm_heat_fixed(&scene->heat, view.scheme);
    const double travelled = fixed ? scene->heat.lambda * view.t : 0, k = view.dt;
    const double sigma = fixed ? 0 : scene->heat.lambda * k, nu = scene->heat.diffusivity;
    const size_t j = gm_stencil_node(grid, scene->at + travelled);
    const struct gm_heat_symmetry frame = gm_heat_frame(view.scheme, nu, grid->dx, view.state + j - 1);
    struct gm_moving_frame made = {.known = isfinite(frame.boost) && frame.projection * k < 1};
    for (size_t e = 0; made.known && e < 2 * GM_STENCIL; e++) {
        const size_t i = j + e % GM_STENCIL - GM_STENCIL / 2;
        const bool next = e >= GM_STENCIL;
        struct gm_event event = {.t = next ? k : 0, .u = view.state[i] / view.state[j]};
        event.x = ((double)i - (double)j) * grid->dx + (next ? sigma : 0);
        made.carried[e] = gm_heat_carried(nu, &frame, event);
        made.carried[e].u = log(made.carried[e].u);
        event.u = log(event.u);
        made.seen[e] = event;
    }
    return made;
}

static void draw_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    struct gm_moving_frame *stencils = gm_picture_memory(picture, count * sizeof *stencils);
    bool any = false, all = true;
    for (size_t i = 0; stencils && i < count; i++) {
        stencils[i] = stencil(lanes[i]);
        const bool projected = gm_heat_keeps(lanes[i]->scheme) & GM_HEAT_PROJECTIONS;
        any |= projected;
        all &= projected;
    }
    picture->title = "The moving frame at a node of the heat equation";
    picture->subtitle =
        gm_picture_text(picture, "the node nearest to x = %g,  ν = %g,  h = %g,  k = %s", scene->at,
                        scene->heat.diffusivity, scene->dx, gm_step_text(picture, lanes[0]->run->dt));
    const struct gm_axes_style look = {.h = scene->dx,
                                       .k = lanes[0]->run->dt,
                                       .value = "ln u/uⱼ",
                                       .carried = "ln û/ûⱼ",
                                       .section = all   ? "ûⱼ₋₁ = ûⱼ = ûⱼ₊₁"
                                                  : any ? "ûⱼ₋₁ = ûⱼ₊₁, by projections = ûⱼ"
                                                        : "ûⱼ₋₁ = ûⱼ₊₁"};
    if (stencils) {
        gm_draw_moving_frame(picture, lanes, count, stencils, &look);
    }
}

/* The nodes inside the panel, in the original frame. */
static void draw_profile(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    enum { DRAWN = 1600 };
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_grid1 *grid = &view.problem->line;
    const struct gm_heat *heat = gm_heat_of(view.problem);
    const double travelled = gm_heat_fixed(heat, view.scheme) ? heat->lambda * view.t : 0;
    const size_t stride = (grid->points + DRAWN - 1) / DRAWN;
    double *points = gm_picture_memory(picture, 2 * (DRAWN + 1) * sizeof *points);
    size_t count = 0;
    for (size_t j = 0; points && j < grid->points; j += stride) {
        const double x = gm_grid1_node(grid, j) - travelled;
        if (x >= panel->x.low && x <= panel->x.high) {
            points[2 * count] = x;
            points[2 * count + 1] = at_rest(&view, j);
            count++;
        }
    }
    gm_mark_line(picture, panel, gm_lane_style(lane, lane->run->status != GM_OK ? 0.55 : 1, 2.2), points,
                 count, false);
}

static void draw_exact(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                       double t, struct gm_style style)
{
    enum { DRAWN = 600 };
    struct gm_heat heat = *gm_heat_of(&lane->problem);
    heat.lambda = 0;
    double *points = gm_picture_memory(picture, 2 * DRAWN * sizeof *points);
    for (size_t i = 0; points && i < DRAWN; i++) {
        points[2 * i] = panel->x.low + (panel->x.high - panel->x.low) * (double)i / (DRAWN - 1);
        points[2 * i + 1] = gm_heat_exact(&heat, true, points[2 * i], t);
    }
    gm_mark_line(picture, panel, style, points, points ? DRAWN : 0, false);
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    gm_draw_clock(picture, lanes, count);
    if (scene->show == GM_FRAME_SHOWN) {
        draw_frame(lanes, count, picture);
        return;
    }
    picture->title = "Heat, from moving frames, drawn at rest";
    picture->subtitle =
        gm_picture_text(picture, "ν = %g,  Δx = %g,  νΔt/Δx² = %.3g,  exact solution in grey, start in red",
                        scene->heat.diffusivity, scene->dx,
                        scene->heat.diffusivity * lanes[0]->run->dt / (scene->dx * scene->dx));
    picture->graphs_below = true;
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            panel = gm_walk_panel(picture, &walk, "");
            panel->axes = true;
            const double reach = scene->half_length / 2;
            panel->x = (struct gm_axis){.label = "x", .low = -reach, .high = reach};
            panel->y = (struct gm_axis){.label = "", .low = -0.1, .high = 1.15};
            draw_exact(picture, panel, walk.lane, 0, (struct gm_style){GM_INITIAL, 0.5, 1.2, GM_SOLID});
            draw_exact(picture, panel, walk.lane, walk.lane->run->t,
                       (struct gm_style){GM_EXACT, 0.8, 4, GM_SOLID});
        }
        draw_profile(picture, panel, walk.lane);
    }
    const struct gm_graph graphs[] = {
        {.observable = "sup_error", .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 1e-1},
        {.observable = "boost_defect", .highest = true, .scale = GM_LOG, .calm_low = 1e-16, .calm_high = 1},
    };
    gm_draw_graphs(picture, lanes, count, graphs, 2);
}

static const char *const schemes[] = {"heat-ftcs", "heat-boosts", "heat-projections", NULL};

/* A frame of boosts and projections needs the scheme that steps in it. */
static const struct gm_preference preferences[] = {
    {"show=frame", {"heat-projections"}},
    {NULL, {NULL}},
};

/* The mesh ratio follows the square of dx. */
static const double mesh[] = {0.4, 0.2, 0.1, 0.05};
static const double compared[] = {1e-1, 1e-2, 1e-3};
static const struct gm_work work = {
    .arguments = "until=0.5",
    .measure = "sup_error",
    .coarsest = 0.05,
    .halvings = 6,
    .resolution = "dx",
    .resolutions = mesh,
    .resolution_count = GM_COUNT(mesh),
    .errors = compared,
};

/* A mesh ratio of 1. */
static double diffusion_time(const void *self)
{
    const struct scene *scene = self;
    return scene->dx * scene->dx / scene->heat.diffusivity;
}

static const double velocities[] = {0, 1, 2, 3, 4};
static const double ratios[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8};
static const struct gm_stability stability = {
    .arguments = "dx=0.2 until=1",
    .parameter = "lambda",
    .values = velocities,
    .value_count = GM_COUNT(velocities),
    .label = "ν Δt / Δx²",
    .unit = diffusion_time,
    .steps = ratios,
    .step_count = GM_COUNT(ratios),
    .error = "sup_error",
};

const struct gm_scene gm_scene_heat = {
    .name = "heat",
    .title = "The heat equation from moving frames",
    .blurb =
        "Heat that spreads, and the same seen from a frame that moves with lambda. The equation does not care; the "
        "ordinary scheme keeps scalings alone, schemes in a moving frame keep boosts and projections too.",
    .watch =
        "Watch the error of the ordinary scheme grow with lambda, where the invariant ones have one and the same to "
        "round-off; on a kernel the one that keeps projections is exact.",
    .time = "length² / diffusivity, in the units of x",
    .size = sizeof(struct scene),
    .parameters = parameters,
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
    .preferences = preferences,
    .lanes = "scheme=heat-ftcs,heat-boosts,heat-projections lambda=0,3,6",
    .observables = observables,
    .observable_count = GM_COUNT(observables),
    .work = &work,
    .stability = &stability,
    .settle = settle,
    .setup = setup,
    .start = start,
    .failure = tell_failure,
    .draw = draw,
};
