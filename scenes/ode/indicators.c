/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A copy of the orbit runs with a vector along it, by the same scheme from the same start. The lane's own run
   is unchanged, and the copy costs time only on request. */
#include "scenes/ode/indicators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/families/families.h"
#include "core/ode/families/invariants/held.h"
#include "core/ode/indicators/growth.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/action.h"
#include "scenes/common/lane.h"

/* ---- growth ---- */

struct followed {
    const struct gm_scheme *scheme; /* the lane may change it */
    struct gm_growth *growth;
    double *start; /* the start of the last member, active components */
    size_t n;
    const char *why; /* the reason that there are no values; NULL: there are */
};

static void forget(void *data)
{
    struct followed *followed = data;
    gm_growth_close(followed->growth);
    free(followed->start);
    free(followed);
}

/* Returns component c of the last member. */
static double last_of(const struct gm_view *view, const double *state, size_t c)
{
    const size_t m = view->problem->m;
    return state[c * m + m - 1];
}

/* Opens the copy of the orbit; NULL when out of memory, which is noted. */
static struct followed *open_followed(const struct gm_view *view, size_t kind)
{
    struct gm_worked *worked = &view->worked[kind];
    struct followed *followed = calloc(1, sizeof *followed);
    worked->data = followed;
    worked->forget = forget;
    if (!followed) {
        return NULL;
    }
    followed->scheme = view->scheme;
    followed->n = view->problem->n - 2 * view->problem->passive;
    followed->start = malloc(followed->n * sizeof *followed->start);
    for (size_t c = 0; followed->start && c < followed->n; c++) {
        followed->start[c] = last_of(view, view->start, c);
    }
    if (!followed->start) {
        return NULL;
    }
    if (strcmp(gm_tangent_word(view->scheme), "none") == 0) {
        followed->why = view->scheme->family->by_tolerance
                            ? "the lengths of its steps follow a tolerance and have no derivative"
                            : "the state of the scheme is in a library: its steps have no derivative here";
    } else if (kind == GM_WORKED_VOLUME) {
        followed->why = followed->n > GM_NEWTON_LARGEST
                            ? "the volume of more than 64 components is not followed"
                        : gm_action_constraints(view->problem) > 0 ? "constraints leave no volume"
                        : view->scheme->family->adaptive ? "its steps have other lengths beside the orbit"
                                                         : NULL;
    }
    if (followed->why) {
        return followed;
    }
    followed->growth = gm_growth_open(view->problem, view->scheme, &view->run->settings, view->t0, view->dt,
                                      followed->start);
    if (kind == GM_WORKED_VOLUME && followed->growth && !gm_growth_follow_volume(followed->growth)) {
        gm_growth_close(followed->growth);
        followed->growth = NULL;
    }
    return followed->growth ? followed : NULL;
}

/* Returns true if the copy is the lane's orbit, to the last bit: the lane may have been changed during its
   run. */
static bool is_same(const struct gm_view *view, const struct followed *followed)
{
    const double *state = gm_run_state(gm_growth_run(followed->growth));
    bool same = true;
    for (size_t c = 0; c < followed->n; c++) {
        same = same && state[c] == last_of(view, view->state, c);
    }
    return same;
}

/* Returns the orbit, followed up to the view's step; NULL if there are no values. */
static const struct gm_growth *followed_to(const struct gm_view *view, size_t kind)
{
    struct gm_worked *worked = &view->worked[kind];
    struct followed *followed = worked->data;
    const int64_t steps = view->run->steps;
    const bool earlier = followed && followed->growth && gm_growth_run(followed->growth)->steps > steps;
    if (followed && (earlier || followed->scheme != view->scheme)) {
        worked->data = NULL; /* another scheme, or an earlier step of the view */
        forget(followed);
        followed = NULL;
    }
    followed = followed ? followed : open_followed(view, kind);
    if (!followed || !followed->growth) {
        return NULL;
    }
    const bool left = !isnan(gm_escape_time(view));
    followed->why = view->run->status != GM_OK               ? gm_status_name(view->run->status)
                    : left                                   ? "the run was stopped: its orbit has left"
                    : steps == 0                             ? "no step was made yet"
                    : !gm_growth_to(followed->growth, steps) ? "a step beside the orbit fails"
                    : !is_same(view, followed)               ? "the run was changed on its way"
                                                             : NULL;
    return followed->why ? NULL : followed->growth;
}

static struct gm_growth_values values_of(const struct gm_view *view, size_t kind)
{
    const struct gm_growth *growth = followed_to(view, kind);
    return growth ? gm_growth_values(growth) : (struct gm_growth_values){NAN, NAN, NAN, NAN, NAN, NAN};
}

double gm_lyapunov(const struct gm_view *view)
{
    return values_of(view, GM_WORKED_GROWTH).exponent;
}

double gm_lyapunov_change(const struct gm_view *view)
{
    return values_of(view, GM_WORKED_GROWTH).exponent_change;
}

double gm_megno(const struct gm_view *view)
{
    return values_of(view, GM_WORKED_GROWTH).megno;
}

double gm_megno_change(const struct gm_view *view)
{
    return values_of(view, GM_WORKED_GROWTH).megno_change;
}

/* The size that a scheme of this family noted of the last member's last step. */
static double correction(const struct gm_view *view, const struct gm_family *family)
{
    const struct gm_holding *holding = view->scheme->family == family ? view->scheme->coefficients : NULL;
    const size_t m = view->problem->m;
    return holding && !holding->constraints ? view->memory[GM_HELD_CORRECTION * m + m - 1] : NAN;
}

double gm_projection(const struct gm_view *view)
{
    return correction(view, &gm_family_projected);
}

const char *gm_projection_why(const struct gm_view *view)
{
    return isnan(gm_projection(view)) ? "the scheme is not projected(...; an invariant, ...)" : NULL;
}

double gm_relaxation(const struct gm_view *view)
{
    return correction(view, &gm_family_relaxed);
}

const char *gm_relaxation_why(const struct gm_view *view)
{
    return isnan(gm_relaxation(view)) ? "the scheme is not relaxed(...; an invariant)" : NULL;
}

const char *gm_growth_why(const struct gm_view *view)
{
    const struct followed *followed = view->worked[GM_WORKED_GROWTH].data;
    return followed ? followed->why : NULL;
}

double gm_log_volume(const struct gm_view *view)
{
    return values_of(view, GM_WORKED_VOLUME).log_volume;
}

double gm_volume_error(const struct gm_view *view)
{
    const struct gm_growth_values values = values_of(view, GM_WORKED_VOLUME);
    return expm1(values.log_volume - values.divergence);
}

const char *gm_volume_why(const struct gm_view *view)
{
    const struct followed *followed = view->worked[GM_WORKED_VOLUME].data;
    if (!followed || followed->why) {
        return followed ? followed->why : NULL;
    }
    return gm_log_volume(view) == -INFINITY ? "a step of the scheme has the determinant 0"
                                            : "the divergence of the equations is not known";
}

/* ---- coming back, and leaving ---- */

/* Returns the number of the scene's first section; its count of tracks without one. */
static size_t section_of(const struct gm_scene *scene)
{
    size_t found = 0;
    while (found < scene->track_count && !scene->tracks[found].section) {
        found++;
    }
    return found;
}

double gm_return_time(const struct gm_view *view)
{
    const size_t section = section_of(view->scene);
    if (section == view->scene->track_count || !view->tracks) {
        return NAN;
    }
    /* a start on the section does not count as a return */
    const double least = 1e-9 * fabs(view->dt);
    const struct gm_entries *entries = &view->tracks[section];
    for (size_t i = 0; i < entries->count; i++) {
        if (fabs(entries->times[i] - view->t0) > least) {
            return fabs(entries->times[i] - view->t0);
        }
    }
    return NAN;
}

const char *gm_return_why(const struct gm_view *view)
{
    return section_of(view->scene) < view->scene->track_count ? "the section was not passed yet"
                                                              : "there is no section to pass";
}

double gm_escape_time(const struct gm_view *view)
{
    return gm_view_stopped(view) || view->run->status == GM_BLOW_UP ? fabs(view->t - view->t0) : NAN;
}

const char *gm_escape_why(const struct gm_view *view)
{
    return view->run->status != GM_OK ? gm_status_name(view->run->status) : "the orbit has not left";
}
