/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kind of fields on moving meshes: its families of schemes and their certification. */
#include "core/functions/functions.h"
#include "core/mesh/moving_mesh.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/mesh/certify/subject.h"
#include "core/mesh/families/families.h"
#include "core/mesh/nodes.h"
#include "core/quantity.h"
#include "core/run.h"
#include "core/theory/certify.h"

enum { MOST = GM_MESH_SUBJECT_STATE };
/* Numbers of tangent directions, two for each node before and after a step, and of their values. */
enum { DIRECTIONS = 2 * GM_MESH_SUBJECT_POINTS, OBSERVED = 8 * GM_MESH_SUBJECT_POINTS };

/* Differences of the field and nodes between runs with halved steps, of which the longest is `dt`. Runs of
   an adaptive scheme end at times that differ in second order; the velocities correct for that difference. */
static double measure_order(const struct gm_mesh_subject *subject, double dt, struct gm_ladder *ladder)
{
    enum { STEPS = 7 };
    const double until = 5 * dt, round_off = 1e-10;
    const struct gm_trial *trial = &subject->trial;
    const size_t half = trial->problem->n / 2;
    double before[MOST] = {0}, previous = 0, order = NAN, t_before = NAN;
    for (int i = 0; i < STEPS; i++) {
        const int64_t steps = INT64_C(5) << i;
        struct gm_run *run = gm_run_open(trial->problem, trial->scheme, trial->settings, 0,
                                         until / (double)steps, subject->start);
        if (!run || gm_run_advance(run, steps) != GM_OK) {
            gm_run_close(run);
            return NAN;
        }
        const double *state = gm_run_state(run);
        double change = 0;
        for (size_t k = 0; k < half; k++) {
            change = fmax(change, fabs(state[k] + (t_before - run->t) * state[half + k] - before[k]));
        }
        if (change > round_off) {
            order = previous > 0 ? gm_log2(previous / change) : NAN;
            ladder->dt[ladder->count] = until / (double)steps;
            ladder->error[ladder->count++] = change;
        }
        previous = change;
        memcpy(before, state, 2 * half * sizeof *state);
        t_before = run->t;
        gm_run_close(run);
    }
    return order;
}

/* The distance from its start at which a reversed run ends. */
static double return_defect(const struct gm_mesh_subject *subject, bool reflected)
{
    double state[MOST];
    return gm_trial_turn(&subject->trial, subject->start, reflected, 0, state)
               ? gm_distance(state, subject->start, subject->trial.problem->n)
               : INFINITY;
}

/* q = (y, X) and p = dL/dqdot of a state */
static void momenta(const struct gm_mesh_subject *subject, const double *state, double *phase)
{
    const size_t points = subject->mesh.points;
    const bool alone = subject->mesh.alone;
    struct gm_elements stage;
    memset(phase, 0, 4 * points * sizeof *phase); /* nodes alone have a field that is 0 */
    memcpy(phase + alone * points, state, (2 - alone) * points * sizeof *phase);
    const bool good = gm_elements_open_at(&stage, &subject->mesh, state);
    for (size_t k = 1; good && k <= points; k++) {
        phase[2 * points + k - 1] = gm_momentum_u(&stage, k);
        phase[3 * points + k - 1] = gm_momentum_v(&stage, k);
    }
    gm_elements_close(&stage);
}

static double form(const double *a, const double *b, size_t points)
{
    double sum = 0;
    for (size_t i = 0; i < 2 * points; i++) {
        sum += a[i] * b[2 * points + i] - b[i] * a[2 * points + i];
    }
    return sum;
}

/* (q, p) before and after a step from a shifted start */
static bool step_in_phase_space(const void *context, const double *by, double *values)
{
    const struct gm_mesh_subject *subject = context;
    double state[MOST], end[MOST];
    if (!gm_mesh_subject_shift(subject, by, state) || !gm_trial_advance(&subject->trial, state, end)) {
        return false;
    }
    momenta(subject, state, values);
    momenta(subject, end, values + 4 * subject->mesh.points);
    return true;
}

/* The symplectic form of tangent vectors before and after a step. */
static double symplecticity_defect(const struct gm_mesh_subject *subject)
{
    const size_t points = subject->mesh.points, n = 4 * points;
    const struct gm_map map = {step_in_phase_space, subject, 2 * points, 2 * n};
    double tangents[DIRECTIONS][OBSERVED];
    double defect = 0;
    for (size_t a = 0; a < 2 * points; a++) {
        if (!gm_mesh_derive(&map, a, tangents[a])) {
            return INFINITY;
        }
        for (size_t b = 0; b < a; b++) {
            defect = fmax(defect, fabs(form(tangents[a] + n, tangents[b] + n, points) -
                                       form(tangents[a], tangents[b], points)));
        }
    }
    return defect;
}

static double energy_drift(const struct gm_mesh_subject *subject, int64_t steps)
{
    const double initial = gm_mesh_energy(&subject->mesh, subject->start);
    struct gm_trial trial = subject->trial;
    double state[MOST];
    trial.steps = steps;
    if (!gm_trial_advance(&trial, subject->start, state)) {
        return INFINITY;
    }
    return fabs(gm_mesh_energy(&subject->mesh, state) / initial - 1);
}

/* The order, from differences between runs with halved steps; return after a reversed step; the change of
   dy dp_y + dX dp_X over a step, on the states that the mesh constraint allows; the energy; and the defect
   of the local law of the trapezoidal discrete Lagrangian, or on a uniform mesh of that of the midpoint
   rule if that is less, over all stretches of three nodes (not where the step varies). Defects are of
   numbers of a size, or of products of two. With a reason, a step that fails measures nothing. */
static void measure(struct gm_certificate *certificate, const struct gm_mesh_subject *subject, double size,
                    const char *failing)
{
    /* Equations on meshes are solved to 1e-11, no better: multipliers carry the round-off of the squared
       step; and two claims are derivatives. */
    const struct {
        enum gm_claim claim;
        double tolerance, defect;
    } list[] = {
        {GM_SYMMETRIC, 1e-11, return_defect(subject, false) / size},
        {GM_REVERSIBLE, 1e-11, return_defect(subject, true) / size},
        {GM_SYMPLECTIC, 1e-9, symplecticity_defect(subject) / (size * size)},
        {GM_KEEPS_ENERGY, 1e-11, energy_drift(subject, 20)},
        {GM_MULTISYMPLECTIC, 1e-9, gm_mesh_law_defect(subject) / (size * size)},
    };
    for (size_t i = 0; i < GM_COUNT(list); i++) {
        gm_certificate_claim(certificate, list[i].claim)->tolerance = list[i].tolerance;
        if (failing && isinf(list[i].defect)) {
            gm_certificate_withhold(certificate, list[i].claim, failing);
        } else if (!isnan(list[i].defect)) {
            gm_certificate_note(certificate, list[i].claim, list[i].defect, subject->trial.problem->name);
        }
    }
}

/* On one soliton on a few nodes. */
static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    const double dt = 0.2;
    struct gm_mesh_soliton fine, few;
    struct gm_mesh_subject subject;
    const bool good = gm_mesh_soliton_open(&fine, GM_MESH_SUBJECT_POINTS);
    if (good && gm_mesh_subject_open(&subject, scheme, &fine.problem, dt)) {
        certificate->order = measure_order(&subject, dt, &certificate->ladder);
    }
    certificate->order_problem = "soliton";
    certificate->order_holds = fabs(certificate->order - scheme->order) < 0.15;
    if (gm_mesh_soliton_open(&few, 3) && good && gm_mesh_subject_open(&subject, scheme, &few.problem, dt)) {
        measure(certificate, &subject, 1, NULL);
    }
    gm_mesh_soliton_close(&fine);
    gm_mesh_soliton_close(&few);
}

/* On the mesh of a given system, which has few nodes too. */
static void certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate)
{
    struct gm_mesh_subject subject = {0};
    if (gm_mesh_subject_open(&subject, scheme, system->problem, system->dt)) {
        certificate->order = measure_order(&subject, 2 * system->dt, &certificate->ladder);
        double size = 1;
        for (size_t i = 0; i < system->problem->n; i++) {
            size = fmax(size, fabs(subject.start[i]));
        }
        measure(certificate, &subject, size, "a step fails: a shorter one, dt=, may be measured");
    }
    if (subject.mesh.relax > 0) { /* a mesh that is smoothed in time has no reversal */
        gm_certificate_claim(certificate, GM_REVERSIBLE)->claimed &= !gm_scheme_relaxes(scheme);
    }
    certificate->order_problem = system->problem->name;
    certificate->order_reason = isnan(certificate->order)
                                    ? "differences between runs with steps from 2 dt down are not clear of "
                                      "round-off, or the runs fail"
                                    : NULL;
    certificate->order_holds = !(certificate->order <= scheme->order - 0.15);
    gm_certificate_withhold(certificate, GM_MULTISYMPLECTIC,
                            scheme->family->adaptive ? "the scheme is adaptive"
                            : subject.mesh.alone     ? "it is a law of fields"
                                                     : "the law is measured on 3 nodes: points=3");
    gm_certificate_withhold_all(certificate, scheme->claims, "it means nothing of waves on moving meshes");
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/mesh/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_mesh = {
    .name = "mesh",
    .problems = "waves on moving meshes",
    .certify = certify,
    .certify_on = certify_on,
    .most_certified = GM_MESH_SUBJECT_STATE,
    .families = families,
    .quantities = gm_mesh_quantities,
};
