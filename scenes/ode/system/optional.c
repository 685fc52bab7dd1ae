/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The observables on request of ordinary differential equations, which cost time only when they are asked for. For the
   growth of distances and volumes a copy of the orbit runs with vectors along it, by the same scheme from the same
   start; the lane's own run is unchanged. The modified Hamiltonian is derived once and stored by the lane. */
#include "scenes/ode/system/optional.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/linear/curve.h"
#include "core/model/invariants.h"
#include "core/ode/backward/modified_energy.h"
#include "core/ode/families/families.h"
#include "core/ode/families/invariants/held.h"
#include "core/ode/indicators/growth.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/kernel/members.h"
#include "core/ode/ode.h"
#include "core/ode/user/problem.h"
#include "core/ode/variational/action.h"
#include "scenes/common/graph.h"
#include "scenes/common/system/look.h"

/* ---- the modified Hamiltonian ---- */

/* The stored energies of a state: the start is requested repeatedly. */
struct state {
    double *y; /* n */
    double terms[GM_MODIFIED_POWER + 1];
    bool known;
};

struct energies {
    const struct gm_scheme *scheme; /* the lane may change it */
    int power;
    size_t n;
    struct gm_modified_energy *energy; /* NULL: it does not exist; `why` has the reason */
    char why[GM_MODIFIED_WHY];
    struct state start, now;
    double memory[]; /* of both states */
};

static void forget_energies(void *data)
{
    struct energies *energies = data;
    gm_modified_energy_close(energies->energy);
    free(energies);
}

/* Returns the stored data of a lane; NULL when out of memory, which is noted. */
static struct energies *energies_of(const struct gm_view *view, int power)
{
    struct energies *energies = view->worked[GM_WORKED_ENERGY].data;
    if (energies && energies->scheme == view->scheme && energies->power >= power) {
        return energies;
    }
    if (energies) {
        forget_energies(energies);
    }
    const size_t n = view->problem->n;
    energies = calloc(1, sizeof *energies + 2 * n * sizeof *energies->memory);
    view->worked[GM_WORKED_ENERGY] = (struct gm_worked){energies, forget_energies};
    if (!energies) {
        return NULL;
    }
    energies->scheme = view->scheme;
    energies->power = power;
    energies->n = n;
    energies->start.y = energies->memory;
    energies->now.y = energies->memory + n;
    energies->energy = gm_modified_energy_open(view->problem, view->scheme, power, energies->why);
    return energies;
}

static double energy_of(struct energies *energies, struct state *state, const struct gm_view *view, int power)
{
    const size_t m = view->problem->m;
    bool same = state->known;
    for (size_t i = 0; i < energies->n; i++) {
        const double value = view->state[i * m + m - 1];
        same = same && value == state->y[i];
        state->y[i] = value;
    }
    if (!same) {
        gm_modified_energy_terms(energies->energy, state->y, state->terms);
        state->known = true;
    }
    double sum = 0;
    for (int k = power; k >= 0; k--) {
        sum = sum * view->dt + state->terms[k];
    }
    return sum;
}

/* Returns true if the run was stopped within a step: its last, shorter step has another modified
   Hamiltonian. */
static bool is_within_step(const struct gm_view *view)
{
    return view->run && view->run->n == 0 && view->run->stopped;
}

static double modified_error(const struct gm_view *view)
{
    const int power = view->observable->key[strlen("modified_energy")] - '0';
    struct energies *energies = energies_of(view, power);
    if (!energies || !energies->energy || is_within_step(view)) {
        return NAN;
    }
    struct gm_view before = *view;
    before.state = view->start;
    const double initial = energy_of(energies, &energies->start, &before, power);
    const int plain = gm_scene_observable(view->scene, "energy_error");
    const double scale =
        plain >= 0 ? gm_observable_scale(gm_scene_observable_at(view->scene, (size_t)plain), view) : 0;
    const double divisor = fmax(fabs(energies->start.terms[0]), scale);
    return fabs(energy_of(energies, &energies->now, view, power) - initial) / (divisor > 0 ? divisor : 1);
}

static const char *why_no_modified(const struct gm_view *view)
{
    const struct energies *energies = view->worked[GM_WORKED_ENERGY].data;
    return energies && energies->why[0] ? energies->why
           : is_within_step(view)
               ? "the run was stopped within a step, and a shorter step has another modified Hamiltonian"
               : NULL;
}

/* ---- returning, and leaving ---- */

static double return_time(const struct gm_view *view)
{
    const size_t section = gm_scene_section(view->scene);
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

static const char *why_no_return(const struct gm_view *view)
{
    return gm_scene_section(view->scene) < view->scene->track_count ? "the section was not passed yet"
                                                                    : "there is no section to pass";
}

static double escape_time(const struct gm_view *view)
{
    return view->run->stopped || view->run->status == GM_BLOW_UP ? fabs(view->t - view->t0) : NAN;
}

static const char *why_no_escape(const struct gm_view *view)
{
    return view->run->status != GM_OK ? gm_status_name(view->run->status) : "the orbit has not left";
}

/* ---- growth ---- */

struct followed {
    const struct gm_scheme *scheme;      /* the lane may change it */
    struct gm_arena *arena;              /* of the motion */
    const struct gm_user_motion *motion; /* without the tangents of a file; NULL: it has none */
    struct gm_growth *growth;
    const char *why; /* the reason that there are no values; NULL: there are */
};

static void forget(void *data)
{
    struct followed *followed = data;
    gm_growth_close(followed->growth);
    gm_arena_close(followed->arena);
    free(followed);
}

/* Returns the active components of the last member; malloc'ed, NULL when out of memory. */
static double *last_of(const struct gm_view *view, const double *state)
{
    const size_t n = view->problem->n - 2 * view->problem->passive, m = view->problem->m;
    double *last = malloc(n * sizeof *last);
    if (last) {
        gm_member_take(state, last, n, m, m - 1);
    }
    return last;
}

/* The same without tangents. */
static double *motion_of(const struct gm_view *view, const struct followed *followed, const double *state)
{
    const struct gm_user_motion *motion = followed->motion;
    double *last = last_of(view, state);
    for (size_t c = 0; last && motion && c < motion->problem.n; c++) {
        last[c] = last[gm_system_component(motion->whole, c, 0)];
    }
    return last;
}

struct alone {
    const struct gm_problem *problem;
    struct followed *followed;
};

/* The body of an arena: takes the motion alone, for the exponents of tangents of tangents are others. */
static void take_motion(struct gm_arena *arena, void *data)
{
    const struct alone *alone = data;
    alone->followed->motion = gm_user_problem_motion(arena, alone->problem);
}

/* The reason why the indicators of n components are not followed; NULL: they are. */
static const char *why_none(const struct gm_view *view, size_t kind, size_t n)
{
    const struct gm_family *family = view->scheme->family;
    if (strcmp(gm_tangent_word(view->scheme), "none") == 0) {
        return family->by_tolerance
                   ? "the lengths of its steps follow a tolerance and have no derivative"
                   : "the state of the scheme is in a library: its steps have no derivative here";
    }
    return kind != GM_WORKED_VOLUME ? NULL
           : n > GM_NEWTON_LARGEST  ? "the volume of more than 64 components is not followed"
           : gm_action_constraints(view->problem) > 0 ? "constraints leave no volume"
           : family->adaptive                         ? "its steps have other lengths beside the orbit"
                                                      : NULL;
}

/* Opens the copy of the orbit; without a growth if there are no values, or when out of memory, which is noted. */
static struct followed *open_followed(const struct gm_view *view, size_t kind)
{
    struct followed *followed = calloc(1, sizeof *followed);
    view->worked[kind] = (struct gm_worked){followed, forget};
    if (!followed) {
        return NULL;
    }
    followed->scheme = view->scheme;
    struct alone alone = {view->problem, followed};
    const bool written = gm_ode_of(view->problem)->written;
    followed->arena = written ? gm_arena_made(take_motion, &alone) : NULL;
    const struct gm_user_motion *motion = followed->motion;
    followed->why =
        why_none(view, kind, motion ? motion->problem.n : view->problem->n - 2 * view->problem->passive);
    const bool short_of_memory = written && !followed->arena;
    double *start = followed->why || short_of_memory ? NULL : motion_of(view, followed, view->start);
    if (start) {
        followed->growth = gm_growth_open(motion ? &motion->problem : view->problem, view->scheme,
                                          &view->run->settings, view->t0, view->dt, start);
    }
    if (kind == GM_WORKED_VOLUME && followed->growth && !gm_growth_follow_all(followed->growth)) {
        gm_growth_close(followed->growth);
        followed->growth = NULL;
    }
    free(start);
    return followed;
}

/* Returns true if the copy is the lane's orbit, to the last bit: the lane may have been changed during its run. Of a lane
   that carries tangents, which may be iterated with the motion, the last bits are its own. */
static bool is_same(const struct gm_view *view, const struct followed *followed)
{
    const double close = followed->motion ? 1e-6 : 0;
    const struct gm_run *run = gm_growth_run(followed->growth);
    double *last = motion_of(view, followed, view->state), apart = 0, size = 0;
    for (size_t c = 0; last && c < run->problem->n; c++) {
        apart = fmax(apart, fabs(gm_run_state(run)[c] - last[c]));
        size = fmax(size, fabs(last[c]));
    }
    const bool same = last && run->dt == view->run->dt && run->t == view->t && apart <= close * size;
    free(last);
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
    const bool left = !isnan(escape_time(view));
    followed->why = view->run->status != GM_OK ? gm_status_name(view->run->status)
                    : left                     ? "the run was stopped: its orbit has left"
                    : steps == 0               ? "no step was made yet"
                                               : gm_growth_to(followed->growth, steps);
    if (!followed->why && !is_same(view, followed)) {
        followed->why = "the run was changed on its way";
    }
    return followed->why ? NULL : followed->growth;
}

static struct gm_growth_values values_of(const struct gm_view *view, size_t kind)
{
    const struct gm_growth *growth = followed_to(view, kind);
    return growth ? gm_growth_values(growth) : (struct gm_growth_values){NAN, NAN, NAN, NAN, NAN, NAN, NAN};
}

/* lyapunov, megno, or the change of one of them. */
static double growth(const struct gm_view *view)
{
    const struct gm_growth_values values = values_of(view, GM_WORKED_GROWTH);
    const bool megno = view->observable->key[0] == 'm';
    return strchr(view->observable->key, '_') ? (megno ? values.megno_change : values.exponent_change)
                                              : (megno ? values.megno : values.exponent);
}

static bool is_projection(const struct gm_view *view)
{
    return view->observable->key[0] == 'p';
}

/* The size that a projected or a relaxed scheme noted of the last member's last step. */
static double correction(const struct gm_view *view)
{
    const struct gm_family *family = is_projection(view) ? &gm_family_projected : &gm_family_relaxed;
    const struct gm_holding *holding = view->scheme->family == family ? view->scheme->coefficients : NULL;
    const size_t m = view->problem->m;
    return holding && !holding->constraints ? view->memory[GM_HELD_CORRECTION * m + m - 1] : NAN;
}

static const char *why_no_correction(const struct gm_view *view)
{
    return !isnan(correction(view)) ? NULL
           : is_projection(view)    ? "the scheme is not projected(...; an invariant, ...)"
                                    : "the scheme is not relaxed(...; an invariant)";
}

static const char *why_no_growth(const struct gm_view *view)
{
    const struct followed *followed = view->worked[GM_WORKED_GROWTH].data;
    return followed ? followed->why : NULL;
}

static double when_finite(double value)
{
    return isfinite(value) ? value : NAN;
}

static double log_volume(const struct gm_view *view)
{
    return when_finite(values_of(view, GM_WORKED_VOLUME).log_volume);
}

static double volume_error(const struct gm_view *view)
{
    const struct gm_growth_values values = values_of(view, GM_WORKED_VOLUME);
    return when_finite(gm_expm1(values.log_volume - values.divergence));
}

/* Writes the Lyapunov exponents in descending order, and returns their number; 0: not known. */
static size_t exponents_of(const struct gm_view *view, double exponents[GM_NEWTON_LARGEST])
{
    const struct gm_growth *growth = followed_to(view, GM_WORKED_VOLUME);
    return growth ? gm_growth_exponents(growth, exponents) : 0;
}

/* lyapunov1, lyapunov2, ... */
static double spectrum(const struct gm_view *view)
{
    double exponents[GM_NEWTON_LARGEST];
    const size_t number = strtoul(view->observable->key + strlen("lyapunov"), NULL, 10);
    return number <= exponents_of(view, exponents) ? when_finite(exponents[number - 1]) : NAN;
}

static double lyapunov_sum(const struct gm_view *view)
{
    const struct gm_growth_values values = values_of(view, GM_WORKED_VOLUME);
    return when_finite(values.log_volume / values.time);
}

static double divergence_mean(const struct gm_view *view)
{
    const struct gm_growth_values values = values_of(view, GM_WORKED_VOLUME);
    return values.divergence / values.time;
}

/* D = k + (l_1 + ... + l_k) / |l_(k+1)|, with the largest k whose sum is not negative. J. L. Kaplan & J. A. Yorke,
   Lecture Notes in Mathematics 730 (1979) 204. */
static double lyapunov_dimension(const struct gm_view *view)
{
    double exponents[GM_NEWTON_LARGEST], sum = 0;
    const size_t count = exponents_of(view, exponents);
    size_t k = 0;
    for (; k < count && sum + exponents[k] >= 0; k++) {
        sum += exponents[k];
    }
    return count == 0 ? NAN : when_finite((double)k + (k < count ? sum / fabs(exponents[k]) : 0));
}

static const char *why_no_volume(const struct gm_view *view)
{
    const struct followed *followed = view->worked[GM_WORKED_VOLUME].data;
    if (!followed || followed->why) {
        return followed ? followed->why : NULL;
    }
    const struct gm_growth_values values = values_of(view, GM_WORKED_VOLUME);
    return values.log_volume == -INFINITY ? "a step of the scheme has the determinant 0"
           : isnan(values.divergence)     ? "the divergence of the equations is not known"
                                          : "it is beyond the largest number: log_volume has its logarithm";
}

/* ---- the ring of members ---- */

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

/* Returns the transform of the ring's points, whose number never changes; NULL without a ring or memory. */
static struct gm_fourier *transform_of(const struct gm_view *view, size_t points)
{
    struct gm_worked *worked = &view->worked[GM_WORKED_TRANSFORM];
    if (!worked->data && points > 0) {
        *worked = (struct gm_worked){gm_fourier_open(points), gm_fourier_close};
    }
    return points > 0 ? worked->data : NULL;
}

static struct gm_curve_action loop_at(const struct gm_view *view, const double *state)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    const size_t points = points_of(view), m = view->problem->m, pairs = gm_system_motion(system) / 2;
    struct gm_fourier *fourier = transform_of(view, points);
    struct gm_curve_action loop = {0};
    bool found = fourier;
    for (size_t k = 0; found && k < pairs; k++) {
        found = gm_curve_add_action(fourier, state + gm_system_component(system, k, 0) * m,
                                    state + gm_system_component(system, pairs + k, 0) * m, points, &loop);
    }
    return found ? loop : (struct gm_curve_action){NAN, NAN, NAN, NAN, NAN};
}

double gm_ring_area(const struct gm_view *view)
{
    const size_t points = points_of(view), m = view->problem->m, *disc = gm_system_scene_of(view)->disc;
    /* tighter than of an action: an area is shown unasked, and a scheme that changes it is warned of */
    const double share = 1e-5;
    struct gm_fourier *fourier = transform_of(view, points);
    struct gm_curve_action loop = {0};
    const bool found = fourier && gm_curve_add_action(fourier, view->state + disc[0] * m,
                                                      view->state + disc[1] * m, points, &loop);
    return found ? -resolved(&loop, share) : NAN;
}

static double loop_action(const struct gm_view *view)
{
    const struct gm_curve_action loop = loop_at(view, view->state);
    return resolved(&loop, most);
}

static double loop_resolution(const struct gm_view *view)
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

/* Returns what waves between the points may add to the action, if they fall as those of the last two octaves do. */
static double left_out(const struct gm_curve_action *loop)
{
    return loop->short_waves * fmin(1, loop->short_waves / loop->middle_waves);
}

/* An error that is not far above what the points leave out, or above round-off, is theirs and not the scheme's. */
static double loop_action_error(const struct gm_view *view)
{
    const double roundoff = 1e-12, above = 10;
    const struct gm_curve_action before = loop_at(view, view->start), now = loop_at(view, view->state);
    const double wanted =
                     resolved(&before, most) * gm_exp(-friction_of(view->problem) * (view->t - view->t0)),
                 divisor = fabs(wanted) <= roundoff * now.magnitude ? now.magnitude : wanted,
                 error = resolved(&now, most) - wanted, least = fmax(fabs(error), roundoff * fabs(divisor));
    return error == 0 ? 0 : above * (left_out(&before) + left_out(&now)) > least ? NAN : error / divisor;
}

static const char *why_no_loop_error(const struct gm_view *view)
{
    return isnan(friction_of(view->problem))
               ? "forces other than a friction -c p may change the action of the loop"
               : gm_ring_why(view);
}

/* ---- invariants without a name ---- */

enum { GM_FOUND = 4 /* the largest number of them that have an observable */ };

struct unnamed {
    size_t count;
    struct gm_conserved invariants[GM_FOUND];
    char lacks[GM_FAULT_SENTENCE]; /* what the system has instead of the next one */
};

static void forget_unnamed(void *data)
{
    struct unnamed *unnamed = data;
    for (size_t i = 0; i < unnamed->count; i++) {
        gm_conserved_close(&unnamed->invariants[i]);
    }
    free(unnamed);
}

/* The unnamed invariants of the lane, for its values of parameters; NULL when out of memory. */
static const struct unnamed *unnamed_of(const struct gm_view *view)
{
    struct gm_worked *worked = &view->worked[GM_WORKED_FOUND];
    struct unnamed *unnamed = worked->data ? worked->data : calloc(1, sizeof *unnamed);
    if (unnamed && !worked->data) {
        const char *word = gm_found_word(&gm_system_scene_of(view)->system);
        bool opened = true;
        while (opened && unnamed->count < GM_FOUND) {
            char name[16];
            snprintf(name, sizeof name, "%s%zu", word, unnamed->count + 1);
            opened = gm_conserved_open(&unnamed->invariants[unnamed->count], view->problem,
                                       (const char *[]){name}, 1, unnamed->lacks);
            unnamed->count += opened;
        }
        *worked = (struct gm_worked){unnamed, forget_unnamed};
    }
    return unnamed;
}

/* |I - I(0)| / |I(0)| of the last member; |I| if I(0) = 0. */
static double found_error(const struct gm_view *view)
{
    const size_t number = strtoul(strpbrk(view->observable->key, "123456789"), NULL, 10);
    const struct unnamed *unnamed = unnamed_of(view);
    if (!unnamed || number > unnamed->count) {
        return NAN;
    }
    double before = NAN, now = NAN, *start = last_of(view, view->start), *state = last_of(view, view->state);
    if (start && state) {
        gm_conserved_values(&unnamed->invariants[number - 1], start, &before);
        gm_conserved_values(&unnamed->invariants[number - 1], state, &now);
    }
    free(start);
    free(state);
    return fabs(now - before) / (before == 0 ? 1 : fabs(before));
}

static const char *why_not_found(const struct gm_view *view)
{
    const struct unnamed *unnamed = unnamed_of(view);
    return gm_ode_of(view->problem)->rough ? "invariants are not searched: the system is not smooth"
           : gm_system_scene_of(view)->system.timed
               ? "invariants are not searched: the rates depend on the time"
           : unnamed && unnamed->lacks[0]
               ? "the system has no further invariant without a name: list --invariants"
               : NULL;
}

/* ---- the rows ---- */

#define MODIFIED(power, powers)                                                                              \
    {                                                                                                        \
        .key = "modified_energy" #power "_error", .unit = "", .evaluate = modified_error,                    \
        .title = "error of the modified energy, up to Δt" powers, .logarithmic = true,                       \
        .why = why_no_modified, .whole_steps = true                                                          \
    }
#define INDICATOR(name, function, reason, of_steps, words)                                                   \
    {                                                                                                        \
        .key = name, .title = words, .unit = "", .evaluate = function, .why = reason,                        \
        .whole_steps = of_steps                                                                              \
    }

const struct gm_observable gm_ode_asked[GM_ODE_ASKED + GM_RING_OBSERVABLES] = {
    MODIFIED(2, "²"),
    MODIFIED(4, "⁴"),
    MODIFIED(6, "⁶"),
    INDICATOR("lyapunov", growth, why_no_growth, true, "largest Lyapunov exponent"),
    INDICATOR("lyapunov_change", growth, why_no_growth, true, "change of the exponent over the last half"),
    INDICATOR("megno", growth, why_no_growth, true, "mean MEGNO"),
    INDICATOR("megno_change", growth, why_no_growth, true, "change of MEGNO over the last half"),
    {.key = "return_time",
     .title = "time until the section is passed again",
     .unit = "",
     .evaluate = return_time,
     .recalls = true,
     .why = why_no_return},
    INDICATOR("escape_time", escape_time, why_no_escape, false, "time until the orbit has left"),
    INDICATOR("projection", correction, why_no_correction, false,
              "length of the last move back to the invariants"),
    INDICATOR("relaxation", correction, why_no_correction, false, "length of the last step beside Δt, −1"),
    INDICATOR("volume_error", volume_error, why_no_volume, true,
              "error of the volume against exp(∫ div f dt)"),
    INDICATOR("log_volume", log_volume, why_no_volume, true, "ln of the volume that the steps make of 1"),
    INDICATOR("loop_action", loop_action, gm_ring_why, false, "sum of ∮ p dq along the ring of members"),
    INDICATOR("loop_action_error", loop_action_error, why_no_loop_error, false,
              "relative error of the loop's action"),
    INDICATOR("loop_resolution", loop_resolution, gm_ring_why, false,
              "share of short waves in the loop's action"),
};

static const struct gm_observable spectrum_rows[] = {
    INDICATOR("lyapunov_sum", lyapunov_sum, why_no_volume, true, "sum of the Lyapunov exponents"),
    INDICATOR("divergence_mean", divergence_mean, why_no_volume, true,
              "mean of div f, and of ln |det S| at events"),
    INDICATOR("lyapunov_dimension", lyapunov_dimension, why_no_volume, true, "dimension of Kaplan and Yorke"),
};

void gm_ode_ask(struct gm_arena *arena, struct gm_scene *scene, const struct gm_observable *rows,
                size_t count, size_t n)
{
    const size_t exponents = n <= GM_NEWTON_LARGEST ? n : 0,
                 more = exponents > 0 ? exponents + GM_COUNT(spectrum_rows) : 0;
    struct gm_observable *asked = gm_arena_take(arena, count + more + GM_FOUND, sizeof *asked);
    const char *word = gm_found_word(&((const struct gm_system_scene *)scene)->system);
    memcpy(asked, rows, count * sizeof *asked);
    for (size_t k = 0; k < more; k++) {
        struct gm_observable *row = &asked[count + k];
        *row = k >= exponents
                   ? spectrum_rows[k - exponents]
                   : (struct gm_observable)INDICATOR(gm_arena_print(arena, "lyapunov%zu", k + 1), spectrum,
                                                     why_no_volume, true,
                                                     gm_arena_print(arena, "Lyapunov exponent %zu", k + 1));
        row->group = "lyapunov_spectrum";
    }
    for (size_t k = 0; k < GM_FOUND; k++) {
        asked[count + more + k] = (struct gm_observable){
            .key = gm_arena_print(arena, "%s%zu_error", word, k + 1),
            .title = gm_arena_print(arena, "error of %s%zu, an invariant of list --invariants", word, k + 1),
            .unit = "",
            .evaluate = found_error,
            .logarithmic = true,
            .why = why_not_found};
    }
    scene->asked = asked;
    scene->asked_count = count + more + GM_FOUND;
}

/* ---- the picture of modified energies ---- */

size_t gm_modified_shown(const struct gm_scene *scene, const void *parameters)
{
    const struct gm_parameter *show = gm_scene_parameter(scene, "show");
    if (!show) {
        return 0;
    }
    /* this is asked after every recorded step: the word is not copied */
    const char *word = show->type == GM_TEXT ? (const char *)parameters + show->offset
                                             : show->choices[(int)gm_parameter_get(show, parameters)];
    return strcmp(word, GM_SHOW_MODIFIED) == 0 ? GM_MODIFIED_OBSERVABLES : 0;
}

bool gm_draw_modified(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    static const struct gm_together together[] = {
        {"energy_error", "H"},
        {"modified_energy2_error", "to Δt²"},
        {"modified_energy4_error", "to Δt⁴"},
        {"modified_energy6_error", "to Δt⁶"},
    };
    const bool one = gm_one_step(lanes, count);
    if (gm_lane_asked_shown(lanes[0]) == 0) {
        return false;
    }
    picture->title = "The conserved quantity: the modified energy";
    picture->subtitle =
        gm_picture_text(picture, "%s%s%s;  errors of H + Δt H₁ + Δt² H₂ + …, cut off", lanes[0]->scene->title,
                        one ? ",  Δt = " : "", one ? gm_step_text(picture, lanes[0]->run->dt) : "");
    picture->caption =
        "A symplectic scheme solves an equation with another Hamiltonian almost exactly: the more terms "
        "of it are taken, the flatter the line.";
    gm_draw_clock(picture, lanes, count);
    gm_draw_together(picture, lanes, count, together, GM_COUNT(together));
    return true;
}
