/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes/ode/system/ring.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/linear/curve.h"
#include "core/ode/ode.h"
#include "scenes/common/system/look.h"

enum { LEAST_POINTS = 5 };       /* all waves of fewer points are short ones */
static const double most = 1e-3; /* the share of short waves of an action that is resolved */

static size_t points_of(const struct gm_view *view)
{
    const size_t points = view->problem->m - 1;
    const bool disc = ((const struct gm_system_lane *)view->parameters)->shape == GM_SHAPE_DISC;
    return disc && points >= LEAST_POINTS ? points : 0;
}

const char *gm_ring_why(const struct gm_view *view)
{
    enum { LENGTH = 64 };
    const size_t points = points_of(view);
    struct gm_worked *worked = &view->worked[GM_WORKED_REASON];
    if (points == 0) {
        return "it needs a disc of at least 5 members around the one in its centre";
    }
    if (!worked->data) {
        *worked = (struct gm_worked){malloc(LENGTH), free};
    }
    if (worked->data) {
        snprintf(worked->data, LENGTH, "the loop is not resolved with %zu points", points);
    }
    return worked->data;
}

static double resolution_of(const struct gm_curve_action *loop)
{
    return loop->waves > 0 ? loop->short_waves / loop->waves : loop->waves;
}

/* Returns the action; NaN with a larger share of short waves. */
static double resolved(const struct gm_curve_action *loop, double share)
{
    return resolution_of(loop) <= share ? loop->action : NAN;
}

static struct gm_curve_action loop_at(const struct gm_view *view, const double *state)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    const size_t points = points_of(view), m = view->problem->m, pairs = gm_system_motion(system) / 2;
    struct gm_curve_action loop = {0};
    bool found = points > 0;
    for (size_t k = 0; found && k < pairs; k++) {
        found = gm_curve_add_action(state + gm_system_component(system, k, 0) * m,
                                    state + gm_system_component(system, pairs + k, 0) * m, points, &loop);
    }
    return found ? loop : (struct gm_curve_action){NAN, NAN, NAN, NAN};
}

double gm_ring_area(const struct gm_view *view)
{
    const size_t points = points_of(view), m = view->problem->m, *disc = gm_system_scene_of(view)->disc;
    /* tighter than of an action: an area is shown unasked, and a scheme that changes it is warned of */
    const double share = 1e-5;
    struct gm_curve_action loop = {0};
    const bool found = points > 0 && gm_curve_add_action(view->state + disc[0] * m, view->state + disc[1] * m,
                                                         points, &loop);
    return found ? -resolved(&loop, share) : NAN;
}

double gm_ring_action(const struct gm_view *view)
{
    const struct gm_curve_action loop = loop_at(view, view->state);
    return resolved(&loop, most);
}

double gm_ring_resolution(const struct gm_view *view)
{
    const struct gm_curve_action loop = loop_at(view, view->state);
    return resolution_of(&loop);
}

/* The rate c of forces -c p; NaN: there are others, which change the action. */
static double friction_of(const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    return ode->action && ode->action->friction ? *ode->action->friction : ode->forced ? NAN : 0;
}

double gm_ring_action_error(const struct gm_view *view)
{
    const struct gm_curve_action before = loop_at(view, view->start), now = loop_at(view, view->state);
    const double roundoff = 1e-12,
                 wanted = resolved(&before, most) * exp(-friction_of(view->problem) * (view->t - view->t0)),
                 divisor = fabs(wanted) <= roundoff * now.magnitude ? now.magnitude : wanted,
                 error = resolved(&now, most) - wanted;
    return error == 0 ? 0 : error / divisor;
}

const char *gm_ring_error_why(const struct gm_view *view)
{
    return isnan(friction_of(view->problem))
               ? "forces other than a friction -c p may change the action of the loop"
               : gm_ring_why(view);
}
