/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of fields by what their files say: waves in a potential, on a ring, between walls or on a moving mesh; rates; matrices. */
#include <math.h>
#include <stdio.h>

#include "core/basics.h"
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/laws/laws.h"
#include "core/field/user/potential.h"
#include "scenes/common/system/pieces.h"
#include "scenes/field/kind.h"
#include "scenes/mesh/observed.h"
#include "scenes/mesh/picture.h"

static const char *const boundaries[] = {"ring", "walls", NULL},
                         *const spaces[] = {"differences", "fourier", NULL},
                         *const shown[] = {"field", "energy-law", "momentum-law", NULL};
#define SHOW GM_LAW_ROW(shown)
#define BOUNDARY                                                                                             \
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.walls, "boundary", "ring", boundaries,                                 \
                  "a ring, or walls that reflect: u_x = 0 at both ends")
#define HIGHEST                                                                                              \
    GM_OBSERVABLE("amplitude", gm_view_amplitude, "largest |u|"),                                            \
        GM_OBSERVABLE("crest", crest, "x where u is highest")

static double value_of_first(const struct gm_view *view, size_t node)
{
    return view->state[node];
}

/* The scale is 1: the momentum of a breather is 0, of a sine-Gordon kink its mass 8 times its velocity. */
static double unit_momentum(const struct gm_view *view)
{
    return (void)view, 1;
}

static double form_energy(const struct gm_view *view)
{
    return gm_form_energy(view->problem, view->scheme, view->memory);
}

static double form_momentum(const struct gm_view *view)
{
    return gm_form_momentum(view->problem, view->scheme, view->memory);
}

/* Returns the position of the first field's crest: the top of the parabola through the highest node and its
   neighbours. */
static double crest(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const double *u = view->state;
    const size_t points = grid->points;
    size_t top = 0;
    for (size_t i = 1; i < gm_grid1_seen(grid); i++) {
        top = u[i] > u[top] ? i : top;
    }
    const double left = u[top > 0 ? top - 1 : points - 1], right = u[top + 1 < points ? top + 1 : 0],
                 bend = left - 2 * u[top] + right;
    return gm_grid1_node(grid, top) + (bend < 0 ? grid->dx * (left - right) / (2 * bend) : 0);
}

/* The left end of the line, which the file may say. */
static double left_of(const struct gm_system_lane *lane)
{
    const struct gm_system_item *item = gm_system_item_of(&lane->owner->system, GM_WORD_HALF_LENGTH, 0);
    const double usual = -gm_system_half_length(lane);
    return item ? gm_system_option_number(item, GM_OPTION_LEFT, usual) : usual;
}

struct gm_grid1 gm_field_grid(const struct gm_system_lane *lane)
{
    const double half_length = gm_system_half_length(lane);
    const size_t points = (size_t)lane->grid.points, cells = lane->grid.walls ? points - 1 : points;
    return (struct gm_grid1){.points = lane->grid.walls ? 2 * cells : points,
                             .dx = 2 * half_length / (double)cells,
                             .first = lane->grid.walls ? -half_length : left_of(lane),
                             .walls = lane->grid.walls};
}

static bool open_wave(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_grid1 grid = gm_field_grid(lane);
    return gm_user_wave_open(problem, &gm_user_field_of(lane)->wave, values, &grid);
}

/* Evaluates in the middle between the two levels of the state. */
static bool place_wave(const struct gm_view *view, size_t i, double *values, double *weight)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t x = gm_viewed_field(view)->of_file.system.velocities,
                 right = i + 1 < grid->points ? i + 1 : 0, left = i > 0 ? i - 1 : grid->points - 1;
    const double *u = view->state, *other = u + grid->points, gap = other[grid->points],
                 jump = right == 0 || i == 0 ? grid->jump : 0;
    if (i == gm_grid1_seen(grid)) {
        return false;
    }
    values[0] = (u[i] + other[i]) / 2;
    values[1] = (other[i] - u[i]) / gap;
    values[x] = gm_grid1_node(grid, i);
    values[x + 1] = ((u[right] + other[right] - u[left] - other[left]) / 2 + jump) / (2 * grid->dx);
    *weight = grid->dx * gm_grid1_share(grid, i);
    return true;
}

static double energy(const struct gm_view *view)
{
    return gm_field_seen(view, gm_wave_energy(view->problem, view->state));
}

static double momentum(const struct gm_view *view)
{
    return view->problem->line.walls ? NAN : gm_wave_momentum(view->problem, view->state);
}

static const struct gm_parameter wave_rows[] = {GM_FIELD_POINTS(3), SHOW, BOUNDARY};
static const struct gm_observable of_waves[] = {
    /* The energy of nodes compares schemes but does not judge them: for boxes it has an error of the grid.
       own_energy_error is a scheme's own loss. */
    GM_LOG_OBSERVABLE("energy_error", energy, "energy error", .error = true, .symbol = "H"),
    GM_KEPT_OBSERVABLE("own_energy_error", gm_view_own_energy, "H", "error of the scheme’s own energy",
                       .missing = "the scheme has no energy of its own"),
    GM_KEPT_OBSERVABLE("momentum_error", momentum, "P", "momentum error", .scale = unit_momentum,
                       .scale_text = "1", .missing = "walls take up momentum"),
    GM_OBSERVABLE("amplitude", gm_view_amplitude, "largest |u|"),
    GM_LOCAL_LAWS,
    GM_FORM_RESIDUAL,
    GM_OBSERVABLE("longest_step", gm_field_longest_step, "longest stable step of linear theory",
                  .missing = "linear theory sets this scheme no limit")};

static const char *const wave_schemes[] = {
    "leapfrog",   "energy-conserving", "box",          "euler-box",        "midpoint-box",
    "gauss-box3", "lobatto-box2",      "lobatto-box4", "lobatto-nystrom4", NULL};

const struct gm_field_kind gm_field_waves = {
    GM_FIELD_ROWS(wave_rows),
    GM_FIELD_OBSERVABLES(of_waves),
    GM_FIELD_ERRORS(gm_usual_errors),
    .schemes = wave_schemes,
    .graphs = {{"energy_error", "own_energy_error"}, {"solution_error", "own_energy_error"}},
    .graph_count = 2,
    .open = open_wave,
    .closes = gm_user_wave_closes,
    .draw = gm_field_draw,
    .value = value_of_first,
    .exact = gm_field_exact,
    .place = place_wave,
};

static bool open_mesh(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_mesh mesh = {.first = left_of(lane),
                                      .length = 2 * gm_system_half_length(lane),
                                      .points = lane->grid.points,
                                      .alpha = lane->grid.alpha,
                                      .density = lane->grid.density,
                                      .map = lane->grid.mesh,
                                      .cell = lane->grid.cell,
                                      .nodes = lane->grid.nodes,
                                      .between = lane->grid.between,
                                      .relax = lane->grid.relax,
                                      .until = lane->timing.until};
    return gm_user_mesh_open(problem, &gm_user_field_of(lane)->wave, values, &mesh);
}

/* Returns field, position or their velocities (`number`) at node k, counted from the left end. */
static double at_node(const struct gm_view *view, const struct gm_mesh *mesh, size_t k, size_t number)
{
    const double left[4] = {mesh->left, mesh->first}, right[4] = {mesh->right, mesh->first + mesh->length};
    if (k == 0) {
        return left[number];
    }
    return k > mesh->points ? right[number] : view->state[number * mesh->points + k - 1];
}

/* Evaluates in the middle of an element. */
static bool place_on_mesh(const struct gm_view *view, size_t k, double *values, double *weight)
{
    const size_t x = gm_viewed_field(view)->of_file.system.velocities;
    const struct gm_mesh mesh = gm_mesh_of(view);
    double sum[4], rise[4];
    if (k > mesh.points) {
        return false;
    }
    for (size_t i = 0; i < 4; i++) {
        const double before = at_node(view, &mesh, k, i), now = at_node(view, &mesh, k + 1, i);
        sum[i] = now + before;
        rise[i] = now - before;
    }
    values[0] = sum[0] / 2;
    values[1] = (sum[2] - rise[0] / rise[1] * sum[3]) / 2;
    values[x] = sum[1] / 2;
    values[x + 1] = rise[0] / rise[1];
    *weight = rise[1];
    return true;
}

static bool admits_view(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    (void)problem;
    return lane->grid.show != GM_MESH_CONVERGENCE || gm_user_field_of(lane)->solved ||
           gm_refuse(sentence,
                     "show=convergence draws the error, and the file has no exact solution, exact:");
}

/* Remark 3 of Tyranowski & Desbrun (2019), section 3.3. */
static void mesh_failure(const struct gm_view *view, char *text, size_t size)
{
    struct gm_mesh mesh = gm_mesh_of(view);
    double rank, own, bare;
    bool meet = gm_scheme_mesh(view->scheme) == GM_MESH_FREE;
    if (meet && mesh.cell) { /* cells without inertia do not change the mass matrix */
        meet = gm_mesh_mass(&mesh, view->state, &rank, &own);
        mesh.cell = NULL;
        meet = meet && gm_mesh_mass(&mesh, view->state, &rank, &bare) && own == bare;
    }
    snprintf(text, size, "%s",
             meet ? "slopes meet at a node that is free, and the mass matrix is singular there; a line cell: "
                    "with inertia makes it regular"
                  : "");
}

#define MESH_ROWS(views, about)                                                                              \
    GM_INTEGER_ROW(GM_FIELD_LANE, grid.points, "points", "", 1, 1e5, "nodes between the ends",               \
                   .logarithmic = true),                                                                     \
        GM_CHOICE_ROW(GM_FIELD_LANE, grid.show, "show", "all", views, about, .live = true)
static const struct gm_parameter mesh_rows[] = {
    MESH_ROWS(
        gm_mesh_views,
        "what the picture shows: all, the field, the paths of the nodes, the energy, the error over nodes, the "
        "error of the energy over steps, or with the field the inertia of every node"),
    GM_REAL_ROW(
        GM_FIELD_LANE, grid.alpha, "alpha", "auto", 0, 1e6,
        "weight of the field's slope in the mesh density; auto: the file's, or else 3/2 over the largest slope at the start, or π/10 of the "
        "length over what u goes up and down there, whichever is less",
        .automatic = true),
    GM_TEXT_ROW(
        GM_FIELD_LANE, grid.density, "density", "arclength",
        "what the nodes equidistribute: arclength, curvature, a mix of both, arclength that is limited or tempered where "
        "the field is steeper than at the start, or a formula in u, u_x, x, V_u, alpha, steepest and bend",
        .choices = gm_user_densities, .names = true),
    GM_TEXT_ROW(GM_FIELD_LANE, grid.mesh, "mesh", "X = x",
                "where the node with label x is at time t, for given- schemes", .names = true),
    GM_TEXT_ROW(GM_FIELD_LANE, grid.cell, "cell", "0",
                "the Lagrangian of a cell in d, d_t, m_t and u_x, for free- schemes", .names = true),
    GM_REAL_ROW(GM_FIELD_LANE, grid.relax, "relax", "0", 0, 1e6,
                "time T in which nodes tend to their places, for control- schemes; 0: they are there"),
};
static const char *const strategies[] = {"multiplier-lobatto4", "control-gauss4", "uniform-gauss4", NULL};

const struct gm_field_kind gm_field_moving_waves = {
    GM_FIELD_ROWS(mesh_rows),
    GM_FIELD_OBSERVABLES(gm_mesh_observables),
    GM_FIELD_ERRORS(gm_mesh_errors),
    .moves = true,
    .no_walls = "boundary: walls mean u_x = 0, and the ends of a moving mesh hold u",
    .schemes = strategies,
    .failure = mesh_failure,
    .open = open_mesh,
    .closes = gm_user_mesh_rests,
    .admits = admits_view,
    .draw = gm_field_draw_mesh,
    .value = value_of_first,
    .place = place_on_mesh,
};

/* The number of the fastest node. */
static size_t fastest(const struct gm_view *view)
{
    const size_t points = view->problem->n / 2;
    size_t top = 0;
    for (size_t k = 1; k < points; k++) {
        top = view->state[points + k] > view->state[points + top] ? k : top;
    }
    return top;
}

static double crest_of_nodes(const struct gm_view *view)
{
    return view->state[fastest(view)];
}

static double height_of_nodes(const struct gm_view *view)
{
    return view->state[view->problem->n / 2 + fastest(view)];
}

static const struct gm_parameter node_rows[] = {
    MESH_ROWS(gm_node_views,
              "what the picture shows: all, the velocity, the paths of the nodes, or the energy"),
    GM_TEXT_ROW(GM_FIELD_LANE, grid.density, "density", "1",
                "what the nodes equidistribute at the start, a formula in x", .names = true),
    GM_TEXT_ROW(GM_FIELD_LANE, grid.cell, "cell", "0", "the Lagrangian of a cell in d, d_t and m_t",
                .names = true),
    GM_TEXT_ROW(GM_FIELD_LANE, grid.nodes, "nodes", "density", "their places at the start, or density",
                .names = true),
    GM_TEXT_ROW(GM_FIELD_LANE, grid.between, "between", "(1 - s)*v0 + s*v1",
                "the velocity between nodes of distance d and velocities v0 and v1, for s from 0 to 1",
                .names = true)};
static const struct gm_observable of_nodes[] = {
    GM_OBSERVABLE("energy", gm_view_mesh_measure, "energy"),
    GM_KEPT_OBSERVABLE("energy_error", gm_view_mesh_measure, "E", "energy error"),
    /* walls and a total derivative in cell: change the momentum, so that it is not lost */
    GM_LOG_OBSERVABLE("momentum_error", gm_view_mesh_measure, "momentum error", .error = true, .symbol = "P"),
    GM_OBSERVABLE("crest", crest_of_nodes, "place of the fastest node"),
    GM_OBSERVABLE("amplitude", height_of_nodes, "its velocity"), GM_MESH_SOLVING};
static const char *const free_schemes[] = {"free-gauss4", "free-gauss2", NULL};

const struct gm_field_kind gm_field_nodes = {
    GM_FIELD_ROWS(node_rows),
    GM_FIELD_OBSERVABLES(of_nodes),
    .moves = true,
    .schemes = free_schemes,
    .open = open_mesh,
    .closes = gm_user_mesh_rests,
    .draw = gm_field_draw_mesh,
    .value = value_of_first,
};

static bool open_evolution(struct gm_problem *problem, const struct gm_system_lane *lane,
                           const double *values)
{
    const struct gm_grid1 grid = gm_field_grid(lane);
    return gm_user_evolution_open(problem, &gm_user_field_of(lane)->evolution, values, &grid,
                                  (enum gm_derivatives)lane->grid.space);
}

static const struct gm_parameter evolution_rows[] = {
    GM_FIELD_POINTS(5),
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.space, "space", "differences", spaces,
                  "derivatives: central differences of order 2, or of waves through the nodes"),
    BOUNDARY};
static const struct gm_observable of_evolutions[] = {HIGHEST};
static const char *const semilinear[] = {"etdrk4", "midpoint", NULL};

const struct gm_field_kind gm_field_evolutions = {
    GM_FIELD_ROWS(evolution_rows),
    GM_FIELD_OBSERVABLES(of_evolutions),
    GM_FIELD_ERRORS(gm_usual_errors),
    .schemes = semilinear,
    .graphs = {{NULL}, {"solution_error"}},
    .graph_count = GM_MOST_FIELD_GRAPHS,
    .open = open_evolution,
    .closes = gm_user_evolution_closes,
    .start = gm_user_evolution_start,
    .draw = gm_field_draw,
    .value = value_of_first,
    .exact = gm_field_exact,
};

static bool open_form(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_grid1 grid = gm_field_grid(lane);
    return gm_user_form_open(problem, &gm_user_field_of(lane)->form, values, &grid);
}

/* Evaluates at the stages of the cells, which a run stores, by Gauss's rule; at the nodes before the first
   step. */
static bool place_in_cell(const struct gm_view *view, size_t number, double *values, double *weight)
{
    static const double left = 0, whole = 1;
    const struct gm_user_system *system = &gm_viewed_field(view)->of_file.system;
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_collocation_tableau *tableau = view->scheme->coefficients;
    const bool stepped = view->memory != NULL;
    const size_t r = stepped ? tableau->r : 1, i = number / r, m = number % r;
    const double *stages = stepped ? gm_any_form_stages(view->memory) : view->state;
    const double *nodes = stepped ? tableau->c : &left, *weights = stepped ? tableau->b : &whole;
    if (i == grid->points) {
        return false;
    }
    for (size_t c = 0; c < system->n; c++) {
        values[c] = stages[(c * r + m) * grid->points + i];
    }
    values[system->velocities] = gm_grid1_node(grid, i) + nodes[m] * grid->dx;
    *weight = grid->dx * weights[m];
    return true;
}

static const struct gm_parameter form_rows[] = {GM_FIELD_POINTS(3), SHOW};
static const struct gm_observable of_forms[] = {
    GM_KEPT_OBSERVABLE("energy_error", form_energy, "H", "energy error"),
    GM_KEPT_OBSERVABLE("momentum_error", form_momentum, "P", "momentum error", .scale = unit_momentum,
                       .scale_text = "1"),
    HIGHEST, GM_LOCAL_LAWS};
static const char *const boxes[] = {"box", "gauss-box3", "gauss-box4", NULL};

const struct gm_field_kind gm_field_forms = {
    .by_matrices = true,
    GM_FIELD_ROWS(form_rows),
    GM_FIELD_OBSERVABLES(of_forms),
    GM_FIELD_ERRORS(gm_usual_errors),
    .no_walls = "an equation by matrices needs a ring: how a wall reflects its components is not defined",
    .schemes = boxes,
    .graphs = {{"energy_error"}, {"solution_error", "energy_error"}},
    .graph_count = GM_MOST_FIELD_GRAPHS,
    .open = open_form,
    .closes = gm_user_form_closes,
    .start = gm_user_form_start,
    .draw = gm_field_draw,
    .value = value_of_first,
    .exact = gm_field_exact,
    .place = place_in_cell,
};
