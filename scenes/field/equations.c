/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of fields whose rates are a well-known equation, with the states of the schemes for it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/laws/profile.h"
#include "core/field/problems/burgers.h"
#include "core/field/problems/dispersive.h"
#include "core/field/problems/heat.h"
#include "core/functions/functions.h"
#include "scenes/common/system/pieces.h"
#include "scenes/field/frames.h"
#include "scenes/field/kind.h"
#include "scenes/field/observed.h"

enum { MOST_NODES = 10000000 };

/* Returns the grid from one end of the line to the other. */
static struct gm_grid1 between_ends(const struct gm_system_lane *lane)
{
    const double half_length = gm_system_half_length(lane);
    return (struct gm_grid1){.points = (size_t)lane->grid.points,
                             .dx = 2 * half_length / (double)(lane->grid.points - 1),
                             .first = -half_length};
}

static bool open_equation(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_field *field = gm_user_field_of(lane);
    const struct gm_grid1 grid = field->kind->paint ? between_ends(lane) : gm_field_grid(lane);
    const bool good = gm_user_equation_open(problem, &field->equation, values, &grid);
    if (good && field->kind->draw_frame) {
        ((struct gm_framed *)problem->parameters)->frame = lane->grid.frame;
    }
    return good;
}

static void start_line(const struct gm_problem *problem, double *y)
{
    gm_user_line_start(problem->parameters, &problem->line, y);
}

/* Represents the field as the scheme does, unless the line of the quantity says where. */
static double *profile_of(const struct gm_view *view)
{
    const size_t points = view->problem->line.points, n = gm_viewed_field(view)->of_file.system.n;
    size_t number;
    const char *on = gm_system_option_text(gm_field_density(view, &number), GM_OPTION_ON, NULL);
    struct gm_scheme scheme = *view->scheme;
    if (on) {
        scheme.in_cells = strcmp(on, "cells") == 0;
        scheme.in_modes = false;
    }
    double *all = malloc(2 * n * points * sizeof *all);
    for (size_t c = 0; all && c < n; c++) {
        double *one = gm_field_profile(view->problem, &scheme, view->state + c * points);
        for (size_t i = 0; i < 2 * points; i++) {
            all[2 * c * points + i] = one ? one[i] : NAN;
        }
        free(one);
    }
    return all;
}

static bool place_profile(const struct gm_view *view, size_t i, double *values, double *weight)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_user_system *system = &gm_viewed_field(view)->of_file.system;
    if (i == grid->points) {
        return false;
    }
    for (size_t c = 0; c < system->n; c++) {
        values[c] = view->state[2 * c * grid->points + i];
        values[system->velocities + 1 + c] = view->state[(2 * c + 1) * grid->points + i];
    }
    values[system->velocities] = gm_grid1_node(grid, i);
    *weight = grid->dx;
    return true;
}

static double modulus(const struct gm_view *view, size_t node)
{
    return gm_hypot(view->state[node], view->state[view->problem->line.points + node]);
}

static double exact_modulus(const struct gm_view *view, double x)
{
    return gm_field_is_known(view) ? gm_hypot(gm_user_line_exact(gm_field_line(view), 0, x, view->t),
                                              gm_user_line_exact(gm_field_line(view), 1, x, view->t))
                                   : NAN;
}

static double modulus_error(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    double largest = gm_field_is_known(view) ? 0 : NAN;
    for (size_t i = 0; i < grid->points && !isnan(largest); i++) {
        largest = gm_larger(fabs(modulus(view, i) - exact_modulus(view, gm_grid1_node(grid, i))), largest);
    }
    return largest;
}

/* Returns the exact value in the original frame. */
static double exact_at_rest(const struct gm_view *view, double x)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    return gm_field_exact(view, x + kdv->framed.lambda * view->t) - kdv->framed.lambda / kdv->eta;
}

/* Laws and frames need schemes that have them. */
static const struct gm_preference preferences[] = {
    {"show=energy-law", {"box"}}, {"show=momentum-law", {"box"}},           {"show=charge-law", {"box"}},
    {"show=mass-law", {"box"}},   {"show=frame", {"evolution-projection"}}, {NULL, {NULL}}};
#define NO_FRAME "the scheme does not step in a moving frame, or the step from here is not solved"
#define EQUATION                                                                                             \
    .no_walls = "boundary: the schemes for this equation alone need no walls",                               \
    .close = gm_user_equation_close, .draw = gm_field_draw
#define ON_RING                                                                                              \
    .open = open_equation, .preferences = preferences, .profile = profile_of, .place = place_profile

#define FRAME_ROW                                                                                            \
    GM_CHOICE_ROW(                                                                                           \
        GM_FIELD_LANE, grid.frame, "frame", "each", frames,                                                  \
        "nodes at rest in the frame, or moving by lambda dt per step, for invariant schemes only; each: "    \
        "moving for the invariant schemes, fixed for the others")
static const char *const frames[] = {"each", "fixed", "moving", NULL},
                         *const shown_of_mass[] = {"field",    "energy-law", "momentum-law",
                                                   "mass-law", "frame",      NULL},
                         *const shown_of_charge[] = {"field", "energy-law", "momentum-law", "charge-law",
                                                     NULL};
static const struct gm_parameter korteweg_rows[] = {
    GM_FIELD_POINTS(5),
    FRAME_ROW,
    GM_CHOICE_ROW(
        GM_FIELD_LANE, grid.show, "show", "field", shown_of_mass,
        "what is drawn over space and time: the field, or what each step leaves of a local law; or the "
        "moving frame: a node with its neighbours, and where the frame carries them"),
};
static const struct gm_observable of_korteweg[] = {
    GM_LOCAL_LAWS,
    GM_LOG_OBSERVABLE("local_mass_residual", gm_view_content_residual, "residual of the local mass law",
                      .missing = GM_NO_LAW),
    GM_FORM_RESIDUAL,
    GM_LOG_OBSERVABLE("boost_defect", gm_kdv_boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_FRAME),
    GM_LOG_OBSERVABLE("scaling_defect", gm_kdv_scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_FRAME),
};
static const char *const schemes_of_korteweg[] = {"box", "zabusky-kruskal", "fourier-rk4", NULL};
const struct gm_field_kind gm_field_korteweg = {
    GM_FIELD_ROWS(korteweg_rows),
    GM_FIELD_OBSERVABLES(of_korteweg),
    GM_FIELD_ERRORS(gm_usual_errors),
    EQUATION,
    ON_RING,
    .equation = GM_NEEDS_KDV,
    .frame_shown = 4,
    .draw_frame = gm_kdv_draw_frame,
    .shift = gm_kdv_shift,
    .schemes = schemes_of_korteweg,
    .graphs = {{NULL}, {"solution_error"}},
    .graph_count = 2,
    .value = gm_kdv_at_rest,
    .exact = exact_at_rest,
    .content = "mass",
    .failure = gm_kdv_failure,
};

static const struct gm_parameter schroedinger_rows[] = {
    GM_FIELD_POINTS(3), GM_LAW_ROW(GM_FIELD_LANE, grid.show, shown_of_charge)};
static const struct gm_observable of_schroedinger[] = {
    GM_LOCAL_LAWS,
    GM_LOG_OBSERVABLE("local_charge_residual", gm_view_content_residual, "residual of the local charge law",
                      .missing = GM_NO_LAW),
    GM_FORM_RESIDUAL};
static const struct gm_observable schroedinger_errors[] = {
    GM_LOG_OBSERVABLE("solution_error", gm_field_solution_error, "distance from the exact solution"),
    GM_LOG_OBSERVABLE("modulus_error", modulus_error, "largest error of |ψ|")};
static const char *const schemes_of_schroedinger[] = {"box", "split-step2", "euler-box", NULL};
const struct gm_field_kind gm_field_schroedinger = {
    GM_FIELD_ROWS(schroedinger_rows),
    GM_FIELD_OBSERVABLES(of_schroedinger),
    GM_FIELD_ERRORS(schroedinger_errors),
    EQUATION,
    ON_RING,
    .equation = GM_NEEDS_NLS,
    .complex_valued = true,
    .schemes = schemes_of_schroedinger,
    .graph_count = 2,
    .start = start_line,
    .value = modulus,
    .exact = exact_modulus,
    .name = "|ψ|",
    .content = "charge",
};

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
    .place = place_between_ends

#define PROFILES_ROW                                                                                         \
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.show, "show", "profiles", profiles_or_frame,                           \
                  "the profiles, or the moving frame: a node with its neighbours, and where the frame "      \
                  "carries them")
static const char *const profiles_or_frame[] = {"profiles", "frame", NULL};
static const struct gm_parameter heat_rows[] = {GM_FIELD_POINTS(5), FRAME_ROW, PROFILES_ROW};
#define NO_SYMMETRY "a value is not positive, or the projection does not exist"
static const struct gm_observable of_heat[] = {
    GM_LOG_OBSERVABLE("boost_defect", gm_heat_boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_SYMMETRY),
    GM_LOG_OBSERVABLE("projection_defect", gm_heat_projection_defect,
                      "defect of a step under a projection by 1/2", .missing = NO_SYMMETRY),
    GM_LOG_OBSERVABLE("scaling_defect", gm_heat_scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_SYMMETRY)};
static const struct gm_observable heat_errors[] = {
    GM_LOG_OBSERVABLE("sup_error", gm_heat_error, "largest error, at rest")};
static const char *const schemes_of_heat[] = {"heat-ftcs", "heat-boosts", "heat-projections", NULL};
/* A frame of boosts and projections needs the scheme that steps in it. */
static const struct gm_preference heat_preferences[] = {{"show=frame", {"heat-projections"}}, {NULL, {NULL}}};

/* The boost multiplies the ends by a power of e. */
static bool is_bounded(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    const struct gm_heat *of = gm_heat_of(problem);
    const double lambda = fabs(of->framed.lambda), most = 300;
    const double power = lambda / (4 * of->diffusivity) *
                         (2 * gm_system_half_length(lane) + 3 * lambda * fmin(lane->timing.until, 1e6));
    return power <= most ||
           gm_refuse(
               sentence,
               "the boost multiplies the ends by exp(%.3g), and exp(300) is the most: a smaller lambda, "
               "half_length or until, or a larger diffusivity",
               power);
}

const struct gm_field_kind gm_field_heat = {
    GM_FIELD_ROWS(heat_rows),
    GM_FIELD_OBSERVABLES(of_heat),
    GM_FIELD_ERRORS(heat_errors),
    EQUATION,
    .open = open_equation,
    .preferences = heat_preferences,
    .equation = GM_NEEDS_HEAT,
    .graphs = {{"boost_defect"}, {"sup_error", "boost_defect"}},
    .schemes = schemes_of_heat,
    .admits = is_bounded,
    .start = start_line,
    BETWEEN_ENDS,
    .draw_frame = gm_heat_draw_frame,
    .value = gm_heat_at_rest,
    .exact = gm_heat_exact_at_rest,
    .failure = gm_heat_failure,
};

/* A grid at rest extends to the front's last position. */
static bool open_burgers(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_system *system = &lane->owner->system;
    const double lambda = gm_frames_number(system, values, "lambda", 0);
    const double travel =
        lane->grid.frame == GM_FRAME_MOVING ? 0 : lambda * (lane->timing.until - gm_field_t0(lane));
    struct gm_grid1 grid = between_ends(lane);
    const double more = fmin(round(fabs(travel) / grid.dx), MOST_NODES);
    grid.first += gm_frames_number(system, values, "offset", 0) * grid.dx - (travel < 0 ? more * grid.dx : 0);
    grid.points += (size_t)more;
    const bool good = gm_user_equation_open(problem, &gm_user_field_of(lane)->equation, values, &grid);
    if (good) {
        struct gm_burgers *opened = (struct gm_burgers *)problem->parameters;
        opened->framed.frame = lane->grid.frame;
        opened->printed = lane->grid.printed;
    }
    return good;
}

/* Behind the field its companion in the frame at rest. */
static void start_burgers(const struct gm_problem *problem, double *y)
{
    const size_t points = problem->line.points;
    const double lambda = gm_framed_of(problem)->lambda;
    start_line(problem, y);
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
    GM_FIELD_POINTS(5), FRAME_ROW,
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.printed, "form", "conservative", forms_of_convection,
                  "of the convection in ftcs and crank-nicolson: D(u²/2), or u Du as printed"),
    PROFILES_ROW};
static const struct gm_observable of_burgers[] = {
    GM_OBSERVABLE("overshoot", gm_burgers_overshoot, "overshoot"),
    GM_OBSERVABLE("amplitude", gm_burgers_amplitude, "largest |u − λ|"),
    GM_OBSERVABLE("compression", gm_burgers_compression, "compression in a step, −Δt D₀u"),
    GM_LOG_OBSERVABLE("galilean_defect", gm_burgers_galilean_defect, "difference from the run at λ = 0",
                      .missing = "the run at λ = 0 has failed"),
    GM_LOG_OBSERVABLE("projection_defect", gm_burgers_projection_defect,
                      "defect of a step under a projection by 1/2"),
    GM_LOG_OBSERVABLE("scaling_defect", gm_burgers_scaling_defect,
                      "defect of a step under a scaling by 1.3")};
static const struct gm_observable burgers_errors[] = {
    GM_LOG_OBSERVABLE("sup_error", gm_burgers_sup_error, "largest error"),
    GM_LOG_OBSERVABLE("l1_error", gm_burgers_l1_error, "mean error, h Σ|e|")};
static const char *const schemes_of_burgers[] = {"ftcs", "lax-wendroff", "ftcs-invariant", NULL};
/* A frame needs a scheme that steps in it. */
static const struct gm_preference burgers_preferences[] = {{"show=frame", {"ftcs-invariant"}},
                                                           {NULL, {NULL}}};

const struct gm_field_kind gm_field_burgers = {
    GM_FIELD_ROWS(burgers_rows),
    GM_FIELD_OBSERVABLES(of_burgers),
    GM_FIELD_ERRORS(burgers_errors),
    EQUATION,
    .open = open_burgers,
    .preferences = burgers_preferences,
    .equation = GM_NEEDS_BURGERS,
    .graphs = {{"amplitude"}, {"sup_error", "galilean_defect"}},
    .schemes = schemes_of_burgers,
    .admits = is_held,
    .start = start_burgers,
    BETWEEN_ENDS,
    .draw_frame = gm_burgers_draw_frame,
    .value = gm_burgers_at_rest,
    .exact = gm_burgers_exact_at_rest,
};
