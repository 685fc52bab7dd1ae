/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes/ode/system/ring.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/linear/curve.h"
#include "core/ode/ode.h"
#include "scenes/common/system/look.h"

/* Without tangents, the waves of fewer points are all short ones. */
enum { LEAST_POINTS = 5 };

static size_t points_of(const struct gm_view *view)
{
    const size_t points = view->problem->m - 1;
    const bool enough = points >= LEAST_POINTS || gm_system_scene_of(view)->system.tangents >= 2;
    return ((const struct gm_system_lane *)view->parameters)->shape == GM_SHAPE_DISC && enough ? points : 0;
}

const char *gm_ring_why(const struct gm_view *view)
{
    enum { LENGTH = 64 };
    const size_t points = points_of(view);
    struct gm_worked *worked = &view->worked[GM_WORKED_REASON];
    if (points == 0) {
        return "with members= of at least 6 in a disc alone";
    }
    if (!worked->data) {
        *worked = (struct gm_worked){malloc(LENGTH), free};
    }
    if (worked->data) {
        snprintf(worked->data, LENGTH, "the loop is not resolved with %zu points", points);
    }
    return worked->data;
}

/* ---- the area of a plane ---- */

/* Returns the area by the derivatives of the edge: the tangent map that each member carries, of those of the
   start's edge; from the centre so that little cancels. */
static double area_by_tangents(const struct gm_view *view, size_t points)
{
    const size_t m = view->problem->m, *disc = gm_system_scene_of(view)->disc;
    const double *x = view->start + disc[0] * m, *y = view->start + disc[1] * m,
                 *now_x = view->state + disc[0] * m, *now_y = view->state + disc[1] * m;
    double complex *edge = malloc(2 * points * sizeof *edge); /* the edge, then its derivatives */
    for (size_t i = 0; edge && i < points; i++) {
        double slope[2];
        for (size_t k = 0; k < 2; k++) {
            const double *const along[] = {gm_system_tangent(view, disc[k], disc[0]),
                                           gm_system_tangent(view, disc[k], disc[1])};
            slope[k] = along[0][i] * (y[points] - y[i]) + along[1][i] * (x[i] - x[points]);
        }
        edge[i] = now_x[i] - now_x[points] + I * (now_y[i] - now_y[points]);
        edge[points + i] = slope[0] + I * slope[1];
    }
    const double area = edge ? gm_curve_area(edge, edge + points, points) : NAN;
    free(edge);
    return area;
}

static double resolution_of(const struct gm_loop *loop)
{
    return loop->waves > 0 ? loop->short_waves / loop->waves : loop->waves;
}

static double resolved(const struct gm_loop *loop)
{
    return resolution_of(loop) <= 1e-3 ? loop->action : NAN;
}

double gm_ring_area(const struct gm_view *view)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    const size_t points = points_of(view), m = view->problem->m, *disc = system_scene->disc;
    struct gm_loop loop = {0};
    if (points > 0 && system_scene->system.tangents >= 2) {
        return area_by_tangents(view, points);
    }
    return points > 0 &&
                   gm_curve_add_loop(view->state + disc[0] * m, view->state + disc[1] * m, points, &loop)
               ? -resolved(&loop)
               : NAN;
}

/* ---- the action ---- */

static struct gm_loop loop_at(const struct gm_view *view, const double *state)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    const size_t points = points_of(view), m = view->problem->m, pairs = gm_system_motion(system) / 2;
    struct gm_loop loop = {0};
    bool found = points > 0;
    for (size_t k = 0; found && k < pairs; k++) {
        found = gm_curve_add_loop(state + gm_system_component(system, k, 0) * m,
                                  state + gm_system_component(system, pairs + k, 0) * m, points, &loop);
    }
    return found ? loop : (struct gm_loop){NAN, NAN, NAN, NAN};
}

double gm_ring_action(const struct gm_view *view)
{
    const struct gm_loop loop = loop_at(view, view->state);
    return resolved(&loop);
}

double gm_ring_resolution(const struct gm_view *view)
{
    const struct gm_loop loop = loop_at(view, view->state);
    return resolution_of(&loop);
}

/* The rate c of forces -c p; NaN: there are others, which change the action. */
static double friction_of(const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    return ode->action && ode->action->friction ? ode->action->friction(problem) : ode->forced ? NAN : 0;
}

double gm_ring_action_error(const struct gm_view *view)
{
    const struct gm_loop before = loop_at(view, view->start), now = loop_at(view, view->state);
    const double roundoff = 1e-12,
                 wanted = resolved(&before) * exp(-friction_of(view->problem) * (view->t - view->t0)),
                 divisor = fabs(wanted) <= roundoff * now.magnitude ? now.magnitude : wanted,
                 error = resolved(&now) - wanted;
    return error == 0 ? 0 : error / divisor;
}

const char *gm_ring_error_why(const struct gm_view *view)
{
    return isnan(friction_of(view->problem)) ? "forces change the action of the loop" : gm_ring_why(view);
}
