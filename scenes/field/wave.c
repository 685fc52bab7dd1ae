/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wave equation
       u_tt = u_xx,   H = integral of (u_t^2 + u_x^2)/2
   by the variational scheme of Razafindralandy, Hamdouni & Chhay (2018), eqs. 62 to 67, on the uniform mesh
   that it can be solved on, and what varying the mesh as well would ask for.

   The discrete action sum dt dx (-u_t^2 + u_x^2)/2 with forward differences gives, varied in u, t and x,
       (67a)   dt [ux_j - ux_{j-1}] - [dx ut_j^n - dx ut_j^{n-1}] = 0        leapfrog
       (67b)   dx [e_j^n - e_j^{n-1}] = 0
       (67c)   dt [e_j^n - e_{j-1}^n] = 0,   e = (ut^2 + ux^2)/2
   which are 3 J equations for the 2 J + 1 unknowns t^{n+1}, x_j^{n+1}, u_j^{n+1}, of which the x_j^{n+1}
   occur in none. What to look at: the residuals of (67b) and (67c), which fail by tens of per cent cell by
   cell along exact waves, and the rank of the system. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/field/families/wave_laws.h"
#include "core/field/problems/wave.h"
#include "scenes/field/field.h"

struct scene {
    struct gm_timing timing;
    int standing;
    long points;
    double courant, sharpness;
};

static const char *const initials[] = {"travelling", "standing", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.9*2*pi/72", 1e-9, 100),
    GM_UNTIL("4*pi"),
    {
        .key = "initial",
        .unit = "",
        .help = "a Gaussian that travels to the right, or one that parts both ways",
        .type = GM_CHOICE,
        .offset = offsetof(struct scene, standing),
        .standard = "travelling",
        .choices = initials,
    },
    {
        .key = "sharpness",
        .unit = "",
        .help = "a of the Gaussian exp(−a x²)",
        .type = GM_REAL,
        .offset = offsetof(struct scene, sharpness),
        .standard = "8",
        .lowest = 0.1,
        .highest = 1e6,
        .logarithmic = true,
    },
    GM_POINTS(struct scene, points, "72", 3, "of the mesh on the ring −π ≤ x < π"),
    {
        .key = "courant",
        .unit = "",
        .help = "dt / dx: either this or dt is given",
        .type = GM_REAL,
        .offset = offsetof(struct scene, courant),
        .standard = "0.9",
        .lowest = 1e-6,
        .highest = 100,
        .logarithmic = true,
    },
};

static bool settle(void *own, const char *const *keys, size_t count, char *sentence)
{
    struct scene *scene = own;
    bool dt = false, courant = false;
    for (size_t i = 0; i < count; i++) {
        dt |= strcmp(keys[i], "dt") == 0;
        courant |= strcmp(keys[i], "courant") == 0;
    }
    const double dx = 2 * M_PI / (double)scene->points, follows = scene->courant * dx;
    if (dt && courant && fabs(follows - scene->timing.dt) > 1e-9 * follows) {
        snprintf(sentence, GM_SENTENCE,
                 "dt= and courant= are both given; one of them follows from the other");
        return false;
    }
    if (dt) {
        scene->courant = scene->timing.dt / dx;
    } else {
        scene->timing.dt = follows;
    }
    return true;
}

static bool setup(const void *own, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct scene *scene = own;
    *problem = gm_problem_wave;
    problem->line = (struct gm_line){
        .points = (size_t)scene->points,
        .dx = 2 * M_PI / (double)scene->points,
        .first = -M_PI,
    };
    problem->n = gm_wave_size(problem->line.points);
    return true;
}

static double bump(const struct scene *scene, double x)
{
    const double away = x - 2 * M_PI * floor(x / (2 * M_PI) + 0.5);
    return exp(-scene->sharpness * away * away);
}

static double exact_at(const struct scene *scene, double x, double t)
{
    return scene->standing ? (bump(scene, x - t) + bump(scene, x + t)) / 2 : bump(scene, x - t);
}

static void start(const void *own, const struct gm_problem *problem, double *y)
{
    const struct scene *scene = own;
    const size_t points = problem->line.points;
    for (size_t i = 0; i < points; i++) {
        const double x = gm_line_node(&problem->line, i);
        y[i] = exact_at(scene, x, 0);
        y[points + i] = exact_at(scene, x, scene->timing.dt);
    }
    y[2 * points] = scene->timing.dt;
}

static double value(const struct gm_view *view, size_t node)
{
    return view->state[node];
}

static double exact(const struct gm_view *view, double x)
{
    return exact_at(view->parameters, x, view->t);
}

static double solution_error(const struct gm_view *view)
{
    double largest = 0;
    for (size_t i = 0; i < view->problem->line.points; i++) {
        largest = fmax(largest, fabs(view->state[i] - exact(view, gm_line_node(&view->problem->line, i))));
    }
    return largest;
}

static double energy(const struct gm_view *view)
{
    return gm_wave_energy(view->problem, view->state);
}

/* What the terms of the printed equations are at a node, between the level before and one step of leapfrog
   ahead. */
struct terms {
    double e_before, e, ut, ux_change;
};

static struct terms terms_at(const struct gm_view *view, size_t j)
{
    const size_t points = view->problem->line.points, right = j + 1 < points ? j + 1 : 0,
                 left = j ? j - 1 : points - 1;
    const double dx = view->problem->line.dx, dt = view->dt;
    const double *u = view->state, *o = view->state + points;
    const double change = u[right] - 2 * u[j] + u[left];
    /* at the start the other level is the next one, and leapfrog leads back from it */
    const bool forward = o[points] == dt;
    const double other = 2 * u[j] - o[j] + dt * dt / (dx * dx) * change;
    const double next = forward ? o[j] : other, before = forward ? other : o[j];
    const double right_other =
        2 * u[right] - o[right] +
        dt * dt / (dx * dx) * (u[right + 1 < points ? right + 1 : 0] - 2 * u[right] + u[j]);
    const double before_right = forward ? right_other : o[right];
    const double ut = (next - u[j]) / dt, ux = (u[right] - u[j]) / dx;
    const double ut_before = (u[j] - before) / dt, ux_before = (before_right - before) / dx;
    return (struct terms){
        .e_before = (ut_before * ut_before + ux_before * ux_before) / 2,
        .e = (ut * ut + ux * ux) / 2,
        .ut = ut,
        .ux_change = change / dx,
    };
}

/* (67b), cell by cell, against the largest energy of a cell */
static double energy_law(const struct gm_view *view)
{
    double largest = 0, scale = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        const struct terms terms = terms_at(view, j);
        largest = fmax(largest, fabs(terms.e - terms.e_before));
        scale = fmax(scale, terms.e);
    }
    return largest / scale;
}

/* the sum of (67b) over the cells, against the whole energy */
static double energy_sum(const struct gm_view *view)
{
    double change = 0, sum = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        const struct terms terms = terms_at(view, j);
        change += terms.e - terms.e_before;
        sum += terms.e;
    }
    return fabs(change) / sum;
}

/* (67c) */
static double momentum_law(const struct gm_view *view)
{
    const size_t points = view->problem->line.points;
    double largest = 0, scale = 0, left = terms_at(view, points - 1).e;
    for (size_t j = 0; j < points; j++) {
        const double e = terms_at(view, j).e;
        largest = fmax(largest, fabs(e - left));
        scale = fmax(scale, e);
        left = e;
    }
    return largest / scale;
}

static double unknowns(const struct gm_view *view)
{
    return 2 * (double)view->problem->line.points + 1;
}

static double equations(const struct gm_view *view)
{
    return 3 * (double)view->problem->line.points;
}

/* Of the equations' Jacobian. (67a) determines every u_j^{n+1}; the x_j^{n+1} have empty columns; eliminating
   the u_j^{n+1} from (67b) leaves the column of t^{n+1} with the entries ut_j (ux_j - ux_{j-1}). */
static double rank(const struct gm_view *view)
{
    const size_t points = view->problem->line.points;
    for (size_t j = 0; j < points; j++) {
        const struct terms terms = terms_at(view, j);
        if (fabs(terms.ut * terms.ux_change) > 1e-12) {
            return (double)points + 1;
        }
    }
    return (double)points;
}

static const struct gm_observable observables[] = {
    {.key = "solution_error",
     .title = "largest error of u",
     .unit = "",
     .evaluate = solution_error,
     .logarithmic = true},
    {.key = "energy_error",
     .title = "energy error",
     .unit = "",
     .evaluate = energy,
     .error = true,
     .symbol = "H",
     .kept = true,
     .logarithmic = true},
    {.key = "energy_law_residual",
     .title = "energy law (67b) in a cell: residual",
     .unit = "",
     .evaluate = energy_law,
     .logarithmic = true},
    {.key = "energy_sum_residual",
     .title = "energy law, summed over the cells",
     .unit = "",
     .evaluate = energy_sum,
     .logarithmic = true},
    {.key = "momentum_law_residual",
     .title = "momentum law (67c): residual",
     .unit = "",
     .evaluate = momentum_law,
     .logarithmic = true},
    {.key = "unknowns", .title = "unknowns of a step", .unit = "", .evaluate = unknowns},
    {.key = "equations", .title = "equations of a step", .unit = "", .evaluate = equations},
    {.key = "rank", .title = "rank of their Jacobian", .unit = "", .evaluate = rank},
};

static void record(const struct gm_view *view, double *entry)
{
    gm_surface_record(view, value, entry);
}

static const struct gm_track tracks[] = {GM_SURFACE_TRACK(record)};

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    const struct gm_field_look look = {.value = value,
                                       .exact = exact,
                                       .name = "u",
                                       .low = -0.5,
                                       .high = 1,
                                       .map = GM_MAP_SEQUENTIAL,
                                       .x_scale = GM_PI};
    const struct gm_view view = gm_lane_view(lanes[0]);
    picture->title = "The wave equation on a mesh that cannot move";
    picture->subtitle =
        gm_picture_text(picture,
                        "%ld points,  Courant number %.4g;  mesh and time varied too: %.0f "
                        "equations for %.0f unknowns, of rank %.0f",
                        scene->points, scene->courant, equations(&view), unknowns(&view), rank(&view));
    const struct gm_graph graphs[] = {
        {.observable = "energy_law_residual", .scale = GM_LOG, .calm_low = 1e-3, .calm_high = 1},
        {.observable = "energy_sum_residual", .scale = GM_LOG, .calm_low = 1e-17, .calm_high = 1e-2},
    };
    gm_draw_field(picture, lanes, count, &look, graphs, sizeof graphs / sizeof graphs[0]);
}

static const char *const schemes[] = {"leapfrog", "box", NULL};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* The error of the mesh hides that of the step, and the other way round: both are refined. */
static const double mesh_points[] = {64, 128, 256, 512};
static const double compared[] = {1e-1, 1e-2, 1e-3};
static const struct gm_work work = {.arguments = "until=2*pi",
                                    .measure = "solution_error",
                                    .coarsest = 0.2,
                                    .halvings = 6,
                                    .resolution = "points",
                                    .resolutions = mesh_points,
                                    .resolution_count = sizeof mesh_points / sizeof mesh_points[0],
                                    .errors = compared};

/* A Courant number of 1. */
static double crossing_time(const void *own)
{
    return 2 * M_PI / (double)((const struct scene *)own)->points;
}

static const double sharpnesses[] = {1, 2, 4, 8};
static const double courant_numbers[] = {0.25, 0.5, 0.9, 0.99, 1, 1.01, 1.1, 2, 4};

static const struct gm_stability stability = {
    .arguments = "until=4*pi",
    .parameter = "sharpness",
    .values = sharpnesses,
    .value_count = COUNT(sharpnesses),
    .label = "Δt / Δx",
    .unit = crossing_time,
    .steps = courant_numbers,
    .step_count = COUNT(courant_numbers),
    .kept = "energy_error",
};

const struct gm_scene gm_scene_wave = {
    .name = "wave",
    .title = "The wave equation, varied in time and space",
    .blurb =
        "A Gaussian on a ring by the variational scheme, which on a uniform mesh is leapfrog, and the laws of energy "
        "and momentum that it would have to obey if the mesh were to adapt.",
    .watch =
        "Watch the two laws: along exact waves the law of energy fails by tens of per cent cell by cell and holds "
        "only as a sum, so no mesh can satisfy the published system, which has more equations than rank.",
    .time = "what a wave needs for a length of 1",
    .size = sizeof(struct scene),
    .parameters = parameters,
    .parameter_count = COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = COUNT(observables),
    .tracks = tracks,
    .track_count = COUNT(tracks),
    .work = &work,
    .stability = &stability,
    .settle = settle,
    .setup = setup,
    .start = start,
    .draw = draw,
};
