/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/certify_mesh.h"

#include <math.h>
#include <string.h>

#include "core/mesh/nodes.h"
#include "core/problems/soliton.h"
#include "core/run.h"

enum { POINTS = 3, FINE_POINTS = 7, MOST = 4 * FINE_POINTS, LEVELS = 4 };

static const struct gm_settings settings = {0};

struct subject {
    struct gm_soliton soliton;
    struct gm_problem problem;
    struct gm_mesh mesh;
    double start[MOST];
};

static bool open_subject(struct subject *subject, const struct gm_scheme *scheme, long points)
{
    subject->soliton =
        (struct gm_soliton){.solitons = 1, .points = points, .velocity = 0.5, .length = 12, .alpha = 1};
    gm_soliton_problem(&subject->soliton, &subject->problem);
    subject->problem.moving_mesh->describe(&subject->problem, &subject->mesh);
    return gm_mesh_start(&subject->mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &subject->soliton,
                         subject->start);
}

static bool integrate(const struct subject *subject, const struct gm_scheme *scheme, double dt, long steps,
                      const double *from, double *end)
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
    struct subject subject;
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

static double symmetry_defect(const struct subject *subject, const struct gm_scheme *scheme, double dt,
                              bool turned)
{
    double there[MOST], back[MOST];
    if (!integrate(subject, scheme, dt, 1, subject->start, there)) {
        return INFINITY;
    }
    if (turned) {
        turn(there, subject->mesh.points);
    }
    if (!integrate(subject, scheme, turned ? dt : -dt, 1, there, back)) {
        return INFINITY;
    }
    if (turned) {
        turn(back, subject->mesh.points);
    }
    return distance(back, subject->start, subject->problem.n);
}

/* q = (y, X) and p = dL/dqdot of a state */
static void momenta(const struct subject *subject, const double *state, double *phase)
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
static bool shift(const struct subject *subject, enum gm_mesh_kind kind, size_t direction, double by,
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

/* The symplectic form of tangent vectors before and after a step; vectors by central differences at 4
   distances, extrapolated by Romberg. */
static double symplecticity_defect(const struct subject *subject, const struct gm_scheme *scheme, double dt)
{
    const size_t points = subject->mesh.points, n = 4 * points, directions = 2 * points;
    const enum gm_mesh_kind kind = gm_scheme_mesh(scheme);
    const double widest = 0.05;
    double before[2 * POINTS][4 * POINTS], after[2 * POINTS][4 * POINTS];
    for (size_t direction = 0; direction < directions; direction++) {
        double tables[2][LEVELS][4 * POINTS];
        for (int level = 0; level < LEVELS; level++) {
            double phase[2][2][4 * POINTS]; /* [side][before, after] */
            const double by = ldexp(widest, -level);
            for (int side = 0; side < 2; side++) {
                double state[4 * POINTS], end[4 * POINTS];
                if (!shift(subject, kind, direction, side ? by : -by, state) ||
                    !integrate(subject, scheme, dt, 1, state, end)) {
                    return INFINITY;
                }
                momenta(subject, state, phase[side][0]);
                momenta(subject, end, phase[side][1]);
            }
            for (int which = 0; which < 2; which++) {
                for (size_t i = 0; i < n; i++) {
                    tables[which][level][i] = (phase[1][which][i] - phase[0][which][i]) / (2 * by);
                }
            }
        }
        for (int which = 0; which < 2; which++) {
            double power = 4;
            for (int done = 1; done < LEVELS; done++, power *= 4) {
                for (int level = LEVELS - 1; level >= done; level--) {
                    for (size_t i = 0; i < n; i++) {
                        tables[which][level][i] +=
                            (tables[which][level][i] - tables[which][level - 1][i]) / (power - 1);
                    }
                }
            }
            memcpy(which ? after[direction] : before[direction], tables[which][LEVELS - 1],
                   n * sizeof(double));
        }
    }
    double defect = 0;
    for (size_t a = 0; a < directions; a++) {
        for (size_t b = 0; b < a; b++) {
            defect =
                fmax(defect, fabs(form(after[a], after[b], points) - form(before[a], before[b], points)));
        }
    }
    return defect;
}

static double energy_drift(const struct subject *subject, const struct gm_scheme *scheme, double dt,
                           long steps)
{
    const double initial = gm_mesh_energy(&subject->mesh, subject->start);
    double state[MOST];
    if (!integrate(subject, scheme, dt, steps, subject->start, state)) {
        return INFINITY;
    }
    return fabs(gm_mesh_energy(&subject->mesh, state) - initial) / initial;
}

struct gm_mesh_measures gm_measure_on_mesh(const struct gm_scheme *scheme)
{
    const double dt = 0.2;
    struct gm_mesh_measures measures = {NAN, INFINITY, INFINITY, INFINITY, INFINITY};
    struct subject subject;
    measures.order = measure_order(scheme);
    if (open_subject(&subject, scheme, POINTS)) {
        measures.symmetry = symmetry_defect(&subject, scheme, dt, false);
        measures.reversibility = symmetry_defect(&subject, scheme, dt, true);
        measures.symplecticity = symplecticity_defect(&subject, scheme, dt);
        measures.energy = energy_drift(&subject, scheme, dt, 20);
    }
    return measures;
}
