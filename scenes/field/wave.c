/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wave equation
       u_tt = u_xx,   H = integral of (u_t^2 + u_x^2)/2
   by the variational scheme of Razafindralandy, Hamdouni & Chhay (2018), eqs. 62 to 67, on the uniform mesh
   that it can be solved on, and the further equations of a variable mesh.

   The discrete action sum dt dx (-u_t^2 + u_x^2)/2 with forward differences gives, varied in u, t and x,
       (67a)   dt [ux_j - ux_{j-1}] - [dx ut_j^n - dx ut_j^{n-1}] = 0        leapfrog
       (67b)   dx [e_j^n - e_j^{n-1}] = 0
       (67c)   dt [e_j^n - e_{j-1}^n] = 0,   e = (ut^2 + ux^2)/2
   which are 3 J equations for the 2 J + 1 unknowns t^{n+1}, x_j^{n+1}, u_j^{n+1}, of which the x_j^{n+1}
   occur in none. What to look at: the residuals of (67b) and (67c), which fail by tens of per cent cell by
   cell along exact waves, and the rank of the system. */
#include <math.h>

#include "core/field/families/laws/wave.h"
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
    GM_CHOICE_ROW(struct scene, standing, "initial", "travelling", initials,
                  "a Gaussian that travels to the right, or one that parts both ways"),
    GM_REAL_ROW(struct scene, sharpness, "sharpness", "8", 0.1, 1e6, "a of the Gaussian exp(−a x²)",
                .logarithmic = true),
    GM_POINTS(struct scene, points, "72", 3, "of the mesh on the ring −π ≤ x < π"),
    GM_REAL_ROW(struct scene, courant, "courant", "0.9", 1e-6, 100, "dt / dx: either this or dt is given",
                .logarithmic = true),
};

static bool settle(void *self, const char *const *keys, size_t count, char *sentence)
{
    struct scene *scene = self;
    return gm_settle_courant(keys, count, 2 * M_PI / (double)scene->points, &scene->timing, &scene->courant,
                             sentence);
}

static bool setup(const void *self, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct scene *scene = self;
    *problem = gm_problem_wave;
    problem->line = gm_ring(M_PI, scene->points);
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

static void start(const void *self, const struct gm_problem *problem, double *y)
{
    const struct scene *scene = self;
    const size_t points = problem->line.points;
    for (size_t i = 0; i < points; i++) {
        const double x = gm_grid1_node(&problem->line, i);
        y[i] = exact_at(scene, x, 0);
        y[points + i] = exact_at(scene, x, scene->timing.dt);
    }
    y[2 * points] = scene->timing.dt;
}

static double exact(const struct gm_view *view, double x)
{
    return exact_at(view->parameters, x, view->t);
}

static double solution_error(const struct gm_view *view)
{
    return gm_field_error(view, exact);
}

static double energy(const struct gm_view *view)
{
    return gm_wave_own_energy(view->problem, view->scheme, view->state, view->memory);
}

/* The terms of the printed equations at a node, between the level before and one step of leapfrog ahead. */
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

/* Returns the rank of the equations' Jacobian. (67a) determines every u_j^{n+1}; the x_j^{n+1} have empty
   columns; eliminating the u_j^{n+1} from (67b) leaves the column of t^{n+1} with the entries ut_j (ux_j -
   ux_{j-1}). */
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
    GM_LOG_OBSERVABLE("solution_error", solution_error, "largest error of u"),
    GM_KEPT_OBSERVABLE("energy_error", energy, "H", "energy error"),
    GM_LOG_OBSERVABLE("energy_law_residual", energy_law, "energy law (67b) in a cell: residual"),
    GM_LOG_OBSERVABLE("energy_sum_residual", energy_sum, "energy law, summed over the cells"),
    GM_LOG_OBSERVABLE("momentum_law_residual", momentum_law, "momentum law (67c): residual"),
    GM_OBSERVABLE("unknowns", unknowns, "unknowns of a step"),
    GM_OBSERVABLE("equations", equations, "equations of a step"),
    GM_OBSERVABLE("rank", rank, "rank of their Jacobian"),
};

static const struct gm_track tracks[] = {GM_SURFACE_TRACK(gm_surface_record_u)};

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct scene *scene = lanes[0]->parameters;
    const struct gm_field_look look = {.value = gm_field_u,
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
    gm_draw_field(picture, lanes, count, &look, graphs, GM_COUNT(graphs));
}

static const char *const schemes[] = {"leapfrog", "box", NULL};

/* The error of the mesh hides that of the step, and the other way round: both are refined. */
static const double mesh_points[] = {64, 128, 256, 512};
static const double compared[] = {1e-1, 1e-2, 1e-3};
static const struct gm_work work = {.arguments = "until=2*pi",
                                    .measure = "solution_error",
                                    .coarsest = 0.2,
                                    .halvings = 6,
                                    .resolution = "points",
                                    .resolutions = mesh_points,
                                    .resolution_count = GM_COUNT(mesh_points),
                                    .errors = compared};

/* A Courant number of 1. */
static double crossing_time(const void *self)
{
    return 2 * M_PI / (double)((const struct scene *)self)->points;
}

static const double sharpnesses[] = {1, 2, 4, 8};
static const double courant_numbers[] = {0.25, 0.5, 0.9, 0.99, 1, 1.01, 1.1, 2, 4};

static const struct gm_stability stability = {
    .arguments = "until=4*pi",
    .parameter = "sharpness",
    .values = sharpnesses,
    .value_count = GM_COUNT(sharpnesses),
    .label = "Δt / Δx",
    .unit = crossing_time,
    .steps = courant_numbers,
    .step_count = GM_COUNT(courant_numbers),
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
    .parameter_count = GM_COUNT(parameters),
    .schemes = schemes,
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
};
