/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of fields between ends, from frames that move with the velocity lambda: the heat equation, and Burgers'. They are
   not Hamiltonian: what counts are their symmetries, boosts and projections among them, with which the exact flow
   commutes. Razafindralandy, Hamdouni & Chhay (2018), section "Invariant integrators", eqs. 73 to 75 and 83. */
#include <math.h>
#include <stdio.h>

#include "core/basics.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/field/frames.h"

enum { MOST_NODES = 10000000 };

static double lambda_of(const struct gm_view *view)
{
    return gm_framed_of(view->problem)->lambda;
}

/* The exact value at a node; what starts there if the file gives none. */
static double exact_at_node(const struct gm_view *view, size_t node)
{
    const struct gm_framed *framed = gm_framed_of(view->problem);
    return gm_frame_exact(framed, gm_frame_rests(framed, view->scheme) ? 0 : framed->lambda,
                          gm_grid1_node(&view->problem->line, node), view->t);
}

/* Returns a value as the original frame sees it, on nodes that start at x and rest in the frame or move along. */
static double seen(const struct gm_view *view, bool fixed, double x, double u)
{
    return gm_moving_frames_of(view->problem)->seen(gm_framed_of(view->problem), fixed, x, view->t, u);
}

static double at_rest(const struct gm_view *view, size_t node)
{
    return seen(view, gm_frame_rests(gm_framed_of(view->problem), view->scheme),
                gm_grid1_node(&view->problem->line, node), view->state[node]);
}

static double exact_at_rest(const struct gm_view *view, double x)
{
    return seen(view, false, x, gm_frame_exact(gm_framed_of(view->problem), lambda_of(view), x, view->t));
}

/* Evaluates at the nodes from end to end. */
static bool place_between_ends(const struct gm_view *view, size_t i, double *values, double *weight)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t last = grid->points - 1, x = gm_viewed_field(view)->of_file.system.velocities,
                 left = i > 0 ? i - 1 : 0, right = i < last ? i + 1 : last;
    const double *u = view->state;
    if (i > last) {
        return false;
    }
    values[0] = u[i];
    values[x] = gm_grid1_node(grid, i);
    values[x + 1] = (u[right] - u[left]) / (grid->dx * (double)(right - left));
    *weight = i == 0 || i == last ? grid->dx / 2 : grid->dx;
    return true;
}

#define BETWEEN_ENDS                                                                                         \
    .graph_count = GM_MOST_FIELD_GRAPHS, .frame_shown = 1, .paint = gm_draw_profiles,                        \
    .place = place_between_ends, .value = at_rest, .exact = exact_at_rest

#define PROFILES_ROW                                                                                         \
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.show, "show", "profiles", profiles_or_frame,                           \
                  "the profiles, or the moving frame: a node with its neighbours, and where the frame "      \
                  "carries them")
static const char *const profiles_or_frame[] = {"profiles", "frame", NULL};
/* ---- the heat equation ---- */

/* Returns the divisor of a value at a node that gives the value in the original frame. */
static double factor(const struct gm_view *view, size_t j)
{
    const struct gm_framed *framed = gm_framed_of(view->problem);
    return gm_heat_factor(framed, gm_frame_rests(framed, view->scheme),
                          gm_grid1_node(&view->problem->line, j), view->t);
}

static double heat_error(const struct gm_view *view)
{
    double largest = 0;
    for (size_t j = 0; j < view->problem->n; j++) {
        largest = fmax(largest, fabs(view->state[j] - exact_at_node(view, j)) / factor(view, j));
    }
    return largest;
}

static void heat_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_grid1 *grid = &view->problem->line;
    text[0] = '\0';
    for (size_t j = 1; view->scheme->claims & GM_EQUIVARIANT && j + 1 < grid->points; j++) {
        struct gm_point_symmetry frame;
        if (gm_frames_of_heat.find(view->problem, view->scheme, view->dt, view->state, j, &frame)) {
            continue;
        }
        if (!isfinite(frame.boost)) {
            snprintf(text, size, "u is not positive near x = %.4g, where no boost levels it",
                     gm_grid1_node(grid, j));
        } else {
            snprintf(text, size, "no projection levels u near x = %.4g: p dt = %.3g is not below 1",
                     gm_grid1_node(grid, j), frame.projection * view->dt);
        }
        return;
    }
}

static const struct gm_parameter heat_rows[] = {GM_FIELD_POINTS(5), GM_FRAME_ROW, PROFILES_ROW};
#define NO_SYMMETRY "a value is not positive, or the projection does not exist"
static const struct gm_observable of_heat[] = {
    GM_LOG_OBSERVABLE("boost_defect", gm_boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_SYMMETRY),
    GM_LOG_OBSERVABLE("projection_defect", gm_projection_defect, "defect of a step under a projection by 1/2",
                      .missing = NO_SYMMETRY),
    GM_LOG_OBSERVABLE("scaling_defect", gm_scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_SYMMETRY)};
static const struct gm_observable heat_errors[] = {
    GM_LOG_OBSERVABLE("sup_error", heat_error, "largest error, at rest")};
static const char *const schemes_of_heat[] = {"heat-ftcs", "heat-boosts", "heat-projections", NULL};
/* A frame of boosts and projections needs the scheme that steps in it. */
static const struct gm_preference heat_preferences[] = {{"show=frame", {"heat-projections"}}, {NULL, {NULL}}};

/* The boost multiplies the ends by a power of e. */
static bool is_bounded(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    const struct gm_framed *of = gm_framed_of(problem);
    const double lambda = fabs(of->lambda), most = 300;
    const double power = lambda / (4 * of->viscosity) *
                         (2 * gm_system_half_length(lane) + 3 * lambda * fmin(lane->timing.until, 1e6));
    return power <= most ||
           gm_refuse(
               sentence,
               "the boost multiplies the ends by exp(%.3g), and exp(300) is the most: a smaller lambda, "
               "half_length or until, or a larger diffusivity",
               power);
}

const struct gm_field_kind gm_field_heat = {
    GM_FIELD_ROWS(heat_rows),     GM_FIELD_OBSERVABLES(of_heat),
    GM_FIELD_ERRORS(heat_errors), GM_EQUATION,
    .open = gm_equation_open,     .preferences = heat_preferences,
    .equation = GM_NEEDS_HEAT,    .graphs = {{"boost_defect"}, {"sup_error", "boost_defect"}},
    .schemes = schemes_of_heat,   .admits = is_bounded,
    .start = gm_equation_start,   BETWEEN_ENDS,
    .failure = heat_failure,
};

/* ---- Burgers' equation ---- */

/* Returns the largest error at a node; *sum is that of all. */
static double error(const struct gm_view *view, double *sum)
{
    double largest = *sum = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        const double one = fabs(view->state[j] - exact_at_node(view, j));
        largest = fmax(largest, one);
        *sum += one;
    }
    return largest;
}

static double sup_error(const struct gm_view *view)
{
    double sum;
    return error(view, &sum);
}

static double l1_error(const struct gm_view *view)
{
    double sum;
    error(view, &sum);
    return view->problem->line.dx * sum;
}

static double amplitude(const struct gm_view *view)
{
    double largest = 0;
    for (size_t j = 0; j < view->problem->line.points; j++) {
        largest = fmax(largest, fabs(at_rest(view, j)));
    }
    return largest;
}

static double overshoot(const struct gm_view *view)
{
    return fmax(0, amplitude(view) - 1);
}

static double galilean_defect(const struct gm_view *view)
{
    const double lambda = lambda_of(view);
    const size_t points = view->problem->line.points;
    if (lambda == 0) {
        return 0;
    }
    const double *companion = view->state + points;
    if (companion[points] == 0) {
        return NAN;
    }
    const double back = gm_frame_travel(view) / view->problem->line.dx;
    double largest = 0;
    for (size_t j = 0; j < points; j++) {
        const double place = (double)j - back, nearest = round(place);
        const double below = fabs(place - nearest) < 1e-6 ? nearest : floor(place), part = place - below;
        if (!(below >= 0 && below + 1 < (double)points)) {
            continue;
        }
        const size_t at = (size_t)below;
        const double there =
            fabs(part) < 1e-6 ? companion[at] : (1 - part) * companion[at] + part * companion[at + 1];
        largest = fmax(largest, fabs(view->state[j] - lambda - there));
    }
    return largest;
}

static double compression(const struct gm_view *view)
{
    const double half = view->dt / (2 * view->problem->line.dx);
    double largest = 0;
    for (size_t j = 1; j + 1 < view->problem->line.points; j++) {
        largest = fmax(largest, half * (view->state[j - 1] - view->state[j + 1]));
    }
    return largest;
}

/* A grid at rest extends to the front's last position. */
static bool open_burgers(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_system *system = &lane->owner->system;
    const double lambda = gm_frames_number(system, values, "lambda", 0);
    const double travel =
        lane->grid.frame == GM_FRAME_MOVING ? 0 : lambda * (lane->timing.until - gm_field_t0(lane));
    struct gm_grid1 grid = gm_field_between_ends(lane);
    const double more = fmin(round(fabs(travel) / grid.dx), MOST_NODES);
    grid.first += gm_frames_number(system, values, "offset", 0) * grid.dx - (travel < 0 ? more * grid.dx : 0);
    grid.points += (size_t)more;
    const bool derived = gm_user_equation_open(problem, &gm_user_field_of(lane)->equation, values, &grid);
    if (derived) {
        struct gm_burgers *opened = (struct gm_burgers *)problem->parameters;
        opened->framed.frame = lane->grid.frame;
        opened->printed = lane->grid.printed;
    }
    return derived;
}

/* Behind the field its companion in the frame at rest. */
static void start_burgers(const struct gm_problem *problem, double *y)
{
    const size_t points = problem->line.points;
    const double lambda = gm_framed_of(problem)->lambda;
    gm_equation_start(problem, y);
    for (size_t j = 0; j < points && lambda != 0; j++) {
        y[points + j] = y[j] - lambda;
        y[2 * points] = 1;
    }
}

static bool is_held(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    (void)lane;
    const double nodes = (double)problem->line.points;
    return nodes <= MOST_NODES ||
           gm_refuse(
               sentence,
               "the grid would need more than %.3g nodes to hold the front until the end; 1e7 is the most",
               nodes);
}

static const char *const forms_of_convection[] = {"conservative", "printed", NULL};
static const struct gm_parameter burgers_rows[] = {
    GM_FIELD_POINTS(5), GM_FRAME_ROW,
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.printed, "form", "conservative", forms_of_convection,
                  "of the convection in ftcs and crank-nicolson: D(u²/2), or u Du as printed"),
    PROFILES_ROW};
static const struct gm_observable of_burgers[] = {
    GM_OBSERVABLE("overshoot", overshoot, "overshoot"),
    GM_OBSERVABLE("amplitude", amplitude, "largest |u − λ|"),
    GM_OBSERVABLE("compression", compression, "compression in a step, −Δt D₀u"),
    GM_LOG_OBSERVABLE("galilean_defect", galilean_defect, "difference from the run at λ = 0",
                      .missing = "the run at λ = 0 has failed"),
    GM_LOG_OBSERVABLE("projection_defect", gm_projection_defect,
                      "defect of a step under a projection by 1/2"),
    GM_LOG_OBSERVABLE("scaling_defect", gm_scaling_defect, "defect of a step under a scaling by 1.3")};
static const struct gm_observable burgers_errors[] = {
    GM_LOG_OBSERVABLE("sup_error", sup_error, "largest error"),
    GM_LOG_OBSERVABLE("l1_error", l1_error, "mean error, h Σ|e|")};
static const char *const schemes_of_burgers[] = {"ftcs", "lax-wendroff", "ftcs-invariant", NULL};
/* A frame needs a scheme that steps in it. */
static const struct gm_preference burgers_preferences[] = {{"show=frame", {"ftcs-invariant"}},
                                                           {NULL, {NULL}}};

const struct gm_field_kind gm_field_burgers = {
    GM_FIELD_ROWS(burgers_rows),
    GM_FIELD_OBSERVABLES(of_burgers),
    GM_FIELD_ERRORS(burgers_errors),
    GM_EQUATION,
    .open = open_burgers,
    .preferences = burgers_preferences,
    .equation = GM_NEEDS_BURGERS,
    .graphs = {{"amplitude"}, {"sup_error", "galilean_defect"}},
    .schemes = schemes_of_burgers,
    .admits = is_held,
    .start = start_burgers,
    BETWEEN_ENDS,
};
