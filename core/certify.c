/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/certify.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "core/certify_complex.h"
#include "core/kernel/loops.h"
#include "core/problems/problems.h"
#include "core/run.h"

enum { MOST = 4 /* components of a certification problem */ };

/* A quantity that some schemes keep. */
typedef double invariant(const struct gm_problem *problem, const double *y);

struct subject {
    struct gm_problem problem; /* m = 1 */
    double start[MOST];
    bool canonical;        /* (q, p), Hamiltonian and reversible under p -> -p */
    invariant *linear[2], *quadratic[2]; /* NULL where it has none */
};

static const double well = 0.3, no_well = 0;

static double momentum(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[2] + y[3];
}

static double sphere(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]) / 2;
}

static double ellipsoid(const struct gm_problem *problem, const double *y)
{
    (void)problem;
    return y[0] * y[0] / 4 + y[1] * y[1] / 2 + 3 * y[2] * y[2] / 4;
}

static double energy(const struct gm_problem *problem, const double *y)
{
    double value = 0;
    problem->hamiltonian->energy(problem, y, &value, 1);
    return value;
}

enum { SUBJECTS = 5 };

static void list_subjects(struct subject subjects[SUBJECTS])
{
    const struct subject list[SUBJECTS] = {
        {gm_problem_pendulum, {0.6, 1.1}, true, {NULL}, {NULL}},
        {gm_problem_particles, {0.5, -0.4, 0.3, 0.8}, true, {NULL}, {NULL}},
        {gm_problem_particles, {0.7, -0.2, 0.4, -0.9}, true, {momentum}, {NULL}},
        {gm_problem_product, {0.5, -0.6}, true, {NULL}, {NULL}},
        {gm_problem_rigid_body, {0.9, 0.5, -0.7}, false, {NULL}, {sphere, ellipsoid}},
    };
    memcpy(subjects, list, sizeof list);
    subjects[1].problem.parameters = &well;
    subjects[2].problem.parameters = &no_well;
}

/* One run of m members from y to `end`; false if it failed. */
static bool integrate(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt, long steps,
                      const double *y, double *end)
{
    const struct gm_settings settings = {0};
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, y);
    if (!run) {
        return false;
    }
    bool good = gm_run_advance(run, steps) == GM_OK;
    memcpy(end, gm_run_state(run), problem->n * problem->m * sizeof *end);
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

static int field_for_gsl(double t, const double y[], double f[], void *problem)
{
    (void)t;
    const struct gm_problem *self = problem;
    self->loops[GM_ISA_BASELINE]->field(self, y, f, 1);
    return GSL_SUCCESS;
}

static bool solve_by_gsl(const struct subject *subject, double until, double *y)
{
    struct gm_problem problem = subject->problem;
    gsl_odeiv2_system system = {field_for_gsl, NULL, problem.n, &problem};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-3, 1e-15, 1e-15);
    if (!driver) {
        return false;
    }
    memcpy(y, subject->start, sizeof subject->start);
    double t = 0;
    int status = gsl_odeiv2_driver_apply(driver, &t, until, y);
    gsl_odeiv2_driver_free(driver);
    return status == GSL_SUCCESS;
}

/* The slope of log error against log dt, by least squares over the finest three steps whose error stands clear of
   round-off; NaN if there are not three. */
static double measure_order(const struct subject *subject, const struct gm_scheme *scheme)
{
    enum { LADDER = 9 };
    const double until = 2, plateau = 3e-12;
    double exact[MOST];
    if (!solve_by_gsl(subject, until, exact)) {
        return NAN;
    }
    double x[LADDER], e[LADDER];
    int count = 0;
    long steps = 4;
    for (int i = 0; i < LADDER; i++, steps *= 2) {
        double end[MOST];
        if (!integrate(&subject->problem, scheme, until / (double)steps, steps, subject->start, end)) {
            continue;
        }
        double error = distance(end, exact, subject->problem.n);
        if (error > plateau) {
            x[count] = log(until / (double)steps);
            e[count] = log(error);
            count++;
        }
    }
    if (count < 3) {
        return NAN;
    }
    const double *xs = x + count - 3, *es = e + count - 3;
    const double mean_x = (xs[0] + xs[1] + xs[2]) / 3, mean_e = (es[0] + es[1] + es[2]) / 3;
    double above = 0, below = 0;
    for (int i = 0; i < 3; i++) {
        above += (xs[i] - mean_x) * (es[i] - mean_e);
        below += (xs[i] - mean_x) * (xs[i] - mean_x);
    }
    return above / below;
}

/* |M' J M - J|, M the derivative of one step: central differences at 4 distances, extrapolated by Romberg, all
   as one ensemble. Error of the differences about 1e-13. */
static double symplecticity_defect(const struct subject *subject, const struct gm_scheme *scheme, double dt)
{
    enum { LEVELS = 4, MEMBERS = MOST * LEVELS * 2 };
    const size_t n = subject->problem.n;
    const size_t members = n * LEVELS * 2;
    struct gm_problem ensemble = subject->problem;
    ensemble.m = members;
    double start[MOST * MEMBERS], end[MOST * MEMBERS];
    const double widest = 0.02;
    for (size_t column = 0; column < n; column++) {
        for (size_t level = 0; level < LEVELS; level++) {
            for (size_t side = 0; side < 2; side++) {
                size_t member = (column * LEVELS + level) * 2 + side;
                for (size_t c = 0; c < n; c++) {
                    double shift = c == column ? ldexp(widest, -(int)level) : 0;
                    start[c * members + member] = subject->start[c] + (side ? -shift : shift);
                }
            }
        }
    }
    if (!integrate(&ensemble, scheme, dt, 1, start, end)) {
        return INFINITY;
    }
    double tangent[MOST][MOST];
    for (size_t row = 0; row < n; row++) {
        for (size_t column = 0; column < n; column++) {
            double table[LEVELS];
            for (size_t level = 0; level < LEVELS; level++) {
                const size_t at = row * members + (column * LEVELS + level) * 2;
                const size_t from = column * members + (column * LEVELS + level) * 2;
                table[level] = (end[at] - end[at + 1]) / (start[from] - start[from + 1]);
            }
            double power = 4;
            for (size_t done = 1; done < LEVELS; done++, power *= 4) {
                for (size_t level = LEVELS - 1; level >= done; level--) {
                    table[level] += (table[level] - table[level - 1]) / (power - 1);
                }
            }
            tangent[row][column] = table[LEVELS - 1];
        }
    }
    const size_t half = n / 2;
    double defect = 0;
    for (size_t a = 0; a < n; a++) {
        for (size_t b = 0; b < n; b++) {
            double form = b == a + half ? -1 : a == b + half ? 1 : 0;
            for (size_t k = 0; k < half; k++) {
                form += tangent[k][a] * tangent[half + k][b] - tangent[half + k][a] * tangent[k][b];
            }
            defect = fmax(defect, fabs(form));
        }
    }
    return defect;
}

/* |step(-dt) step(dt) y - y| */
static double symmetry_defect(const struct subject *subject, const struct gm_scheme *scheme, double dt)
{
    double there[MOST], back[MOST];
    if (!integrate(&subject->problem, scheme, dt, 1, subject->start, there) ||
        !integrate(&subject->problem, scheme, -dt, 1, there, back)) {
        return INFINITY;
    }
    return distance(back, subject->start, subject->problem.n);
}

/* |R step(dt) R step(dt) y - y|, R: p -> -p */
static double reversibility_defect(const struct subject *subject, const struct gm_scheme *scheme, double dt)
{
    const size_t n = subject->problem.n;
    double there[MOST], back[MOST];
    if (!integrate(&subject->problem, scheme, dt, 1, subject->start, there)) {
        return INFINITY;
    }
    for (size_t c = n / 2; c < n; c++) {
        there[c] = -there[c];
    }
    if (!integrate(&subject->problem, scheme, dt, 1, there, back)) {
        return INFINITY;
    }
    for (size_t c = n / 2; c < n; c++) {
        back[c] = -back[c];
    }
    return distance(back, subject->start, n);
}

/* The largest relative change of the invariants over 100 steps. */
static double drift(const struct subject *subject, const struct gm_scheme *scheme, double dt,
                    invariant *const *quantities, size_t count)
{
    double end[MOST], largest = 0;
    if (!integrate(&subject->problem, scheme, dt, 100, subject->start, end)) {
        return INFINITY;
    }
    for (size_t i = 0; i < count && quantities[i]; i++) {
        const double before = quantities[i](&subject->problem, subject->start);
        const double after = quantities[i](&subject->problem, end);
        largest = fmax(largest, fabs(after - before) / fmax(1, fabs(before)));
    }
    return largest;
}

static void note(struct gm_measure *measure, double defect, const char *problem)
{
    if (!measure->measured || !(defect <= measure->defect)) {
        measure->defect = defect;
        measure->problem = problem;
    }
    measure->measured = true;
}

static unsigned bit_of(enum gm_claim claim)
{
    unsigned bit = 0;
    while (1u << bit != (unsigned)claim) {
        bit++;
    }
    return bit;
}

struct gm_certificate gm_certify(const struct gm_scheme *scheme)
{
    /* large enough that RK4 shows a symplecticity defect above 1e-6 */
    const double dt = 0.6;
    struct gm_certificate certificate = {.scheme = scheme, .order = NAN, .order_problem = ""};
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        certificate.claims[bit].claimed = scheme->claims >> bit & 1;
        certificate.claims[bit].tolerance = 1e-12;
        certificate.claims[bit].problem = "";
    }
    struct gm_measure *symplectic = &certificate.claims[bit_of(GM_SYMPLECTIC)];
    symplectic->tolerance = 1e-10;

    struct subject subjects[SUBJECTS];
    list_subjects(subjects);
    double farthest = -1;
    for (size_t i = 0; i < SUBJECTS; i++) {
        const struct subject *subject = &subjects[i];
        const char *name = subject->problem.name;
        if (!gm_scheme_fits(scheme, &subject->problem)) {
            continue;
        }
        const double order = measure_order(subject, scheme);
        const double away = isnan(order) ? INFINITY : fabs(order - scheme->order);
        if (away > farthest) {
            farthest = away;
            certificate.order = order;
            certificate.order_problem = name;
        }
        note(&certificate.claims[bit_of(GM_SYMMETRIC)], symmetry_defect(subject, scheme, dt), name);
        if (subject->canonical) {
            static invariant *const energies[] = {energy};
            note(symplectic, symplecticity_defect(subject, scheme, dt), name);
            note(&certificate.claims[bit_of(GM_REVERSIBLE)], reversibility_defect(subject, scheme, dt), name);
            note(&certificate.claims[bit_of(GM_KEEPS_ENERGY)], drift(subject, scheme, dt / 24, energies, 1), name);
        }
        if (subject->linear[0]) {
            note(&certificate.claims[bit_of(GM_KEEPS_LINEAR)], drift(subject, scheme, dt / 24, subject->linear, 2),
                 name);
        }
        if (subject->quadratic[0]) {
            note(&certificate.claims[bit_of(GM_KEEPS_QUADRATIC)],
                 drift(subject, scheme, dt / 24, subject->quadratic, 2), name);
        }
    }
    certificate.order_holds = farthest >= 0 && farthest < 0.15;
    if (scheme->needs & GM_NEEDS_COMPLEX) {
        gm_certify_complex(scheme, &certificate);
    }
    certificate.holds = certificate.order_holds;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_measure *measure = &certificate.claims[bit];
        measure->holds = measure->measured && measure->defect <= measure->tolerance;
        certificate.holds &= !measure->claimed || measure->holds;
    }
    return certificate;
}
