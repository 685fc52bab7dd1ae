/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Certification of schemes on moving meshes, on one soliton and a few nodes. */
#include "core/mesh/certify.h"

#include <math.h>
#include <string.h>

#include "core/mesh/nodes.h"
#include "core/mesh/subject.h"
#include "core/run.h"

enum { POINTS = 3, FINE_POINTS = 7, MOST = GM_MESH_SUBJECT_STATE, LEVELS = 4 };

static const struct gm_settings settings = {0};

static bool open_subject(struct gm_mesh_subject *subject, const struct gm_scheme *scheme, long points)
{
    subject->soliton =
        (struct gm_soliton){.solitons = 1, .points = points, .velocity = 0.5, .length = 12, .alpha = 1};
    gm_soliton_problem(&subject->soliton, &subject->problem);
    gm_moving_mesh_of(&subject->problem)->describe(&subject->problem, &subject->mesh);
    return gm_mesh_start(&subject->mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &subject->soliton,
                         subject->start);
}

bool gm_mesh_subject_advance(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt,
                             long steps, const double *from, double *end)
{
    struct gm_run *run = gm_run_open(&subject->problem, scheme, &settings, 0, dt, from);
    if (!run) {
        return false;
    }
    const bool good = gm_run_advance(run, steps) == GM_OK;
    memcpy(end, gm_run_state(run), subject->problem.n * sizeof *end);
    gm_run_close(run);
    return good;
}

static double distance(const double *a, const double *b, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(a[i] - b[i]));
    }
    return largest;
}

/* Differences of the field and nodes. A scheme that chooses its steps ends at times that differ in second
   order; what that makes is taken off with the velocities. */
static double measure_order(const struct gm_scheme *scheme)
{
    enum { LADDER = 7 };
    const double until = 1, round_off = 1e-10;
    struct gm_mesh_subject subject;
    if (!open_subject(&subject, scheme, FINE_POINTS)) {
        return NAN;
    }
    const size_t half = subject.problem.n / 2;
    double before[MOST] = {0}, previous = 0, order = NAN, t_before = 0;
    for (int i = 0; i < LADDER; i++) {
        const long steps = 5L << i;
        struct gm_run *run =
            gm_run_open(&subject.problem, scheme, &settings, 0, until / (double)steps, subject.start);
        if (!run || gm_run_advance(run, steps) != GM_OK) {
            gm_run_close(run);
            return NAN;
        }
        const double *state = gm_run_state(run);
        double change = 0;
        for (size_t k = 0; k < half; k++) {
            change = fmax(change, fabs(state[k] + (t_before - run->t) * state[half + k] - before[k]));
        }
        if (i > 1 && change > round_off) {
            order = log2(previous / change);
        }
        previous = change;
        memcpy(before, state, subject.problem.n * sizeof *state);
        t_before = run->t;
        gm_run_close(run);
    }
    return order;
}

static void turn(double *state, size_t points)
{
    for (size_t i = 2 * points; i < 4 * points; i++) {
        state[i] = -state[i];
    }
}

/* How far a run that turns round ends from its start: by the step -dt, or with the velocities turned. It
   remembers what the scheme remembers. */
static double return_defect(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt,
                            bool turned)
{
    struct gm_run *run = gm_run_open(&subject->problem, scheme, &settings, 0, dt, subject->start);
    double state[MOST], defect = INFINITY;
    bool good = run && gm_run_advance(run, 1) == GM_OK;
    if (good && turned) {
        memcpy(state, gm_run_state(run), subject->problem.n * sizeof *state);
        turn(state, subject->mesh.points);
        gm_run_set_state(run, state);
    } else if (good) {
        gm_run_set_step(run, -dt);
    }
    good = good && gm_run_advance(run, 1) == GM_OK;
    if (good) {
        memcpy(state, gm_run_state(run), subject->problem.n * sizeof *state);
        if (turned) {
            turn(state, subject->mesh.points);
        }
        defect = distance(state, subject->start, subject->problem.n);
    }
    gm_run_close(run);
    return defect;
}

/* q = (y, X) and p = dL/dqdot of a state */
static void momenta(const struct gm_mesh_subject *subject, const double *state, double *phase)
{
    const size_t points = subject->mesh.points;
    struct gm_elements stage;
    memcpy(phase, state, 2 * points * sizeof *phase);
    if (!gm_elements_open(&stage, &subject->mesh)) {
        return;
    }
    gm_elements_place(&stage, state);
    gm_elements_evaluate(&stage, &subject->mesh);
    for (size_t k = 1; k <= points; k++) {
        phase[2 * points + k - 1] = gm_momentum_u(&stage, k);
        phase[3 * points + k - 1] = gm_momentum_v(&stage, k);
    }
    gm_elements_close(&stage);
}

/* The state near the start whose y and dy/dt are shifted, and X and dX/dt follow as the constraint says. */
static bool shift(const struct gm_mesh_subject *subject, enum gm_mesh_kind kind, size_t direction, double by,
                  double *state)
{
    const size_t points = subject->mesh.points;
    memcpy(state, subject->start, 4 * points * sizeof *state);
    state[direction < points ? direction : points + direction] += by;
    if (kind == GM_MESH_UNIFORM) {
        return true;
    }
    struct gm_elements stage;
    struct gm_banded matrix;
    double change[FINE_POINTS];
    if (!gm_elements_open(&stage, &subject->mesh)) {
        return false;
    }
    if (!gm_banded_open(&matrix, points, 1)) {
        gm_elements_close(&stage);
        return false;
    }
    gm_elements_place(&stage, state);
    bool good = gm_nodes_equidistribute(&stage, &subject->mesh, NULL, NULL, &matrix, change);
    if (good) {
        /* dX/dt for dy/dt given: no slope, the rate is dy/dt */
        memcpy(state + points, stage.x + 1, points * sizeof *state);
        memcpy(stage.v + 1, state + 2 * points, points * sizeof *state);
        memset(stage.u, 0, (points + 2) * sizeof *stage.u);
        good = gm_nodes_set_in_motion(&stage, &matrix, state + 3 * points);
    }
    gm_banded_close(&matrix);
    gm_elements_close(&stage);
    return good;
}

static double form(const double *a, const double *b, size_t points)
{
    double sum = 0;
    for (size_t i = 0; i < 2 * points; i++) {
        sum += a[i] * b[2 * points + i] - b[i] * a[2 * points + i];
    }
    return sum;
}

bool gm_mesh_subject_derive(const struct gm_mesh_subject *subject, enum gm_mesh_kind kind, size_t direction,
                            gm_mesh_observe *observe, const void *context, size_t count, double *derivative)
{
    const double widest = 0.05;
    double table[LEVELS][GM_MESH_OBSERVED], sides[2][GM_MESH_OBSERVED], state[MOST];
    for (int level = 0; level < LEVELS; level++) {
        const double by = ldexp(widest, -level);
        for (int side = 0; side < 2; side++) {
            if (!shift(subject, kind, direction, side ? by : -by, state) ||
                !observe(subject, context, state, sides[side])) {
                return false;
            }
        }
        for (size_t i = 0; i < count; i++) {
            table[level][i] = (sides[1][i] - sides[0][i]) / (2 * by);
        }
    }
    double power = 4;
    for (int done = 1; done < LEVELS; done++, power *= 4) {
        for (int level = LEVELS - 1; level >= done; level--) {
            for (size_t i = 0; i < count; i++) {
                table[level][i] += (table[level][i] - table[level - 1][i]) / (power - 1);
            }
        }
    }
    memcpy(derivative, table[LEVELS - 1], count * sizeof *derivative);
    return true;
}

/* (q, p) before and after a step */
static bool step_in_phase_space(const struct gm_mesh_subject *subject, const void *context,
                                const double *state, double *values)
{
    const struct gm_mesh_step *step = context;
    double end[MOST];
    if (!gm_mesh_subject_advance(subject, step->scheme, step->dt, 1, state, end)) {
        return false;
    }
    momenta(subject, state, values);
    momenta(subject, end, values + subject->problem.n);
    return true;
}

/* The symplectic form of tangent vectors before and after a step. */
static double symplecticity_defect(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme,
                                   double dt)
{
    const size_t points = subject->mesh.points, n = subject->problem.n;
    const struct gm_mesh_step step = {scheme, dt};
    double tangents[2 * POINTS][8 * POINTS];
    double defect = 0;
    for (size_t a = 0; a < 2 * points; a++) {
        if (!gm_mesh_subject_derive(subject, gm_scheme_mesh(scheme), a, step_in_phase_space, &step, 2 * n,
                                    tangents[a])) {
            return INFINITY;
        }
        for (size_t b = 0; b < a; b++) {
            defect = fmax(defect, fabs(form(tangents[a] + n, tangents[b] + n, points) -
                                       form(tangents[a], tangents[b], points)));
        }
    }
    return defect;
}

static double energy_drift(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt,
                           long steps)
{
    const double initial = gm_mesh_energy(&subject->mesh, subject->start);
    double state[MOST];
    if (!gm_mesh_subject_advance(subject, scheme, dt, steps, subject->start, state)) {
        return INFINITY;
    }
    return fabs(gm_mesh_energy(&subject->mesh, state) - initial) / initial;
}

void gm_certify_mesh(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    const double dt = 0.2;
    struct gm_mesh_subject subject;
    certificate->order = measure_order(scheme);
    certificate->order_problem = "soliton";
    certificate->order_holds = fabs(certificate->order - scheme->order) < 0.15;
    const bool open = open_subject(&subject, scheme, POINTS);
    /* Equations on meshes are solved to 1e-11, no better: multipliers carry the round-off of the squared
       step; and two claims are derivatives. */
    const struct {
        enum gm_claim claim;
        double tolerance, defect;
    } list[] = {
        {GM_SYMMETRIC, 1e-11, open ? return_defect(&subject, scheme, dt, false) : INFINITY},
        {GM_REVERSIBLE, 1e-11, open ? return_defect(&subject, scheme, dt, true) : INFINITY},
        {GM_SYMPLECTIC, 1e-9, open ? symplecticity_defect(&subject, scheme, dt) : INFINITY},
        {GM_KEEPS_ENERGY, 1e-11, open ? energy_drift(&subject, scheme, dt, 20) : INFINITY},
        {GM_MULTISYMPLECTIC, 1e-9, open ? gm_mesh_law_defect(&subject, scheme, dt) : INFINITY},
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        gm_certificate_claim(certificate, list[i].claim)->tolerance = list[i].tolerance;
        if (!isnan(list[i].defect)) {
            gm_certificate_note(certificate, list[i].claim, list[i].defect, "soliton");
        }
    }
}
