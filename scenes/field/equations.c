/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Kinds of fields on a ring whose rates are the equation of Korteweg and de Vries, or Schroedinger's, with the states of the
   schemes for them. Korteweg and de Vries' is drawn at rest: schemes that step in a moving frame, on nodes that move along,
   give one and the same from each frame. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/laws/laws.h"
#include "core/field/problems/problems.h"
#include "core/functions/functions.h"
#include "scenes/common/system/pieces.h"
#include "scenes/field/frames.h"

struct gm_grid1 gm_field_between_ends(const struct gm_system_lane *lane)
{
    const double half_length = gm_system_half_length(lane);
    return (struct gm_grid1){.points = (size_t)lane->grid.points,
                             .dx = 2 * half_length / (double)(lane->grid.points - 1),
                             .first = -half_length};
}

bool gm_equation_open(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_field *field = gm_user_field_of(lane);
    const struct gm_grid1 grid = field->kind->paint ? gm_field_between_ends(lane) : gm_field_grid(lane);
    const bool opened = gm_user_equation_open(problem, &field->equation, values, &grid);
    if (opened && field->kind->frame_shown) {
        ((struct gm_framed *)problem->parameters)->frame = lane->grid.frame;
    }
    return opened;
}

void gm_equation_start(const struct gm_problem *problem, double *y)
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
        if (!gm_field_profile(view->problem, &scheme, view->state + c * points, all + 2 * c * points)) {
            free(all);
            return NULL;
        }
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

static double shift(const struct gm_view *view)
{
    return gm_kdv_of(view->problem)->framed.lambda * view->t - gm_frame_travel(view);
}

static double at_rest(const struct gm_view *view, size_t node)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    const size_t points = view->problem->line.points;
    const double place = (double)node + gm_frame_travel(view) / view->problem->line.dx;
    const double below = floor(place), part = place - below;
    const double around = below - floor(below / (double)points) * (double)points;
    const size_t here = around < (double)points ? (size_t)around : 0, next = here + 1 < points ? here + 1 : 0;
    const double u = part > 0 ? (1 - part) * view->state[here] + part * view->state[next] : view->state[here];
    return u - kdv->framed.lambda / kdv->eta;
}

static void failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    double steepest = 0;
    for (size_t i = 0; i < grid->points; i++) {
        const size_t right = i + 1 < grid->points ? i + 1 : 0;
        steepest = fmax(steepest, kdv->eta * fabs(view->state[right] - view->state[i]) / grid->dx);
    }
    text[0] = '\0';
    if (gm_frames_of_kdv.are_special(view->scheme) && steepest * fabs(view->dt) >= 2) {
        snprintf(text, size,
                 "neighbours that move with the wave meet within a step: eta |u_x| dt = %.3g is not below 2",
                 steepest * fabs(view->dt));
    }
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
#define ON_RING                                                                                              \
    .open = gm_equation_open, .preferences = preferences, .profile = profile_of, .place = place_profile

const char *const gm_frame_choices[] = {"each", "fixed", "moving", NULL};
static const char *const shown_of_mass[] = {"field", "energy-law", "momentum-law", "mass-law", "frame", NULL},
                         *const shown_of_charge[] = {"field", "energy-law", "momentum-law", "charge-law",
                                                     NULL};
static const struct gm_parameter korteweg_rows[] = {
    GM_FIELD_POINTS(5),
    GM_FRAME_ROW,
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
    GM_LOG_OBSERVABLE("boost_defect", gm_boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_FRAME),
    GM_LOG_OBSERVABLE("scaling_defect", gm_scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_FRAME),
};
static const char *const schemes_of_korteweg[] = {"box", "zabusky-kruskal", "fourier-rk4", NULL};
const struct gm_field_kind gm_field_korteweg = {
    GM_FIELD_ROWS(korteweg_rows),
    GM_FIELD_OBSERVABLES(of_korteweg),
    GM_FIELD_ERRORS(gm_usual_errors),
    GM_EQUATION,
    ON_RING,
    .equation = GM_NEEDS_KDV,
    .frame_shown = 4,
    .shift = shift,
    .schemes = schemes_of_korteweg,
    .graphs = {{NULL}, {"solution_error"}},
    .graph_count = 2,
    .value = at_rest,
    .exact = exact_at_rest,
    .content = "mass",
    .failure = failure,
};

static const struct gm_parameter schroedinger_rows[] = {GM_FIELD_POINTS(3), GM_LAW_ROW(shown_of_charge)};
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
    GM_EQUATION,
    ON_RING,
    .equation = GM_NEEDS_NLS,
    .complex_valued = true,
    .schemes = schemes_of_schroedinger,
    .graph_count = 2,
    .start = gm_equation_start,
    .value = modulus,
    .exact = exact_modulus,
    .name = "|ψ|",
    .content = "charge",
};
