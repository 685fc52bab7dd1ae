/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of certificates: the tolerances, the verdicts, and the call of the kind's measurement. */
#include "core/theory/certify.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <gsl/gsl_errno.h>

#include "core/arena.h"
#include "core/functions/functions.h"
#include "core/memory.h"
#include "core/run.h"
#include "core/schemes.h"

struct gm_verdict *gm_certificate_claim(struct gm_certificate *certificate, enum gm_claim claim)
{
    return &certificate->claims[ffs((int)claim) - 1];
}

unsigned gm_certificate_given_up(const struct gm_certificate *certificate)
{
    const struct gm_scheme *scheme = certificate->scheme;
    unsigned lost = scheme->base ? scheme->base->claims & ~(scheme->claims | scheme->follows) : 0;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *verdict = &certificate->claims[bit];
        lost &= verdict->measured && verdict->defect <= verdict->tolerance ? ~(1u << bit) : ~0u;
    }
    return lost;
}

void gm_certificate_withhold(struct gm_certificate *certificate, enum gm_claim claim, const char *reason)
{
    struct gm_verdict *verdict = gm_certificate_claim(certificate, claim);
    verdict->reason = verdict->measured || verdict->undecided ? NULL
                      : verdict->reason                       ? verdict->reason
                                                              : reason;
}

void gm_certificate_withhold_all(struct gm_certificate *certificate, unsigned claims, const char *reason)
{
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (claims >> bit & 1) {
            gm_certificate_withhold(certificate, (enum gm_claim)(1u << bit), reason);
        }
    }
}

void gm_verdict_note(struct gm_verdict *verdict, double defect, const char *problem)
{
    if (!verdict->measured || !(defect <= verdict->defect)) {
        verdict->defect = defect;
        verdict->problem = problem;
    }
    verdict->measured = true;
}

void gm_certificate_note(struct gm_certificate *certificate, enum gm_claim claim, double defect,
                         const char *problem)
{
    gm_verdict_note(gm_certificate_claim(certificate, claim), defect, problem);
}

double gm_distance(const double *a, const double *b, size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(a[i] - b[i]));
    }
    return largest;
}

void gm_certificate_undecided(struct gm_certificate *certificate, enum gm_claim claim, const char *problem)
{
    struct gm_verdict *verdict = gm_certificate_claim(certificate, claim);
    verdict->undecided = true;
    verdict->problem = verdict->measured ? verdict->problem : problem;
}

double gm_invariant_value(const void *invariant, const double *y, const double *memory)
{
    const struct gm_invariant *of = invariant;
    (void)memory;
    return of->value(of->problem, y);
}

/* Differences of this many steps, up to 3, of a conserved quantity from a state of n numbers along a
   direction, relative to the size of its values: 0 for a polynomial of lower degree. NaN when out of
   memory. */
static double differences_of(const struct gm_kept *kept, const double *start, size_t n, int steps,
                             const double *direction)
{
    static const double weights[][4] = {{0}, {-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}};
    double *y = malloc(n * sizeof *y), sum = 0, size = 0;
    if (!y) {
        return NAN;
    }
    for (int i = 0; i <= steps; i++) {
        for (size_t c = 0; c < n; c++) {
            y[c] = start[c] + i * direction[c];
        }
        const double value = weights[steps][i] * kept->value(kept->data, y, NULL);
        sum += value;
        size += fabs(value);
    }
    free(y);
    return size > 0 ? fabs(sum) / size : 0;
}

unsigned gm_kept_claims(const struct gm_kept *kept, const double *start, size_t n, size_t varied, double size,
                        const double *sizes)
{
    enum { DIRECTIONS = 4 };
    const double none = 1e-11;
    const size_t half = n / 2;
    double *all = calloc(3 * n, sizeof *all), *q = all ? all + n : NULL, *p = all ? q + n : NULL;
    bool varies = false, linear = true, quadratic = true, bilinear = true, of_momenta = true;
    for (int k = 1; all && k <= DIRECTIONS; k++) {
        for (size_t c = 0; c < varied; c++) {
            all[c] = (sizes ? sizes[c] : size) * gm_sin(k * (double)(3 * c + 1)); /* any direction */
            *(c < half ? &q[c] : &p[c]) = all[c];
        }
        varies = varies || !(differences_of(kept, start, n, 1, all) < none);
        bilinear = bilinear && differences_of(kept, start, n, 2, q) < none &&
                   differences_of(kept, start, n, 2, p) < none;
        linear = linear && bilinear && differences_of(kept, start, n, 2, all) < none;
        /* large squares of momenta hide a small potential along directions of both */
        quadratic = quadratic && differences_of(kept, start, n, 3, all) < none &&
                    differences_of(kept, start, n, 3, q) < none &&
                    differences_of(kept, start, n, 3, p) < none;
        of_momenta = of_momenta && fabs(kept->value(kept->data, q, NULL)) <=
                                       none * fabs(kept->value(kept->data, all, NULL));
    }
    free(all);
    const unsigned map = bilinear && of_momenta && 2 * half == n ? GM_KEEPS_MOMENTUM_MAPS : 0;
    if (!varies || !quadratic) {
        return 0;
    }
    if (linear) {
        return GM_KEEPS_LINEAR | map;
    }
    return GM_KEEPS_QUADRATIC | (bilinear ? GM_KEEPS_BILINEAR | map : 0);
}

/* Copies the state and, if a scheme has a second copy of phase space in its memory, that copy after it. */
static void copy_state(const struct gm_run *run, double *y)
{
    const size_t count = run->problem->n * run->problem->m;
    memcpy(y, gm_run_state(run), count * sizeof *y);
    if (run->scheme->family->doubled) {
        memcpy(y + count, gm_run_memory(run), count * sizeof *y);
    }
}

static void set_state(struct gm_run *run, const double *y)
{
    const size_t count = run->problem->n * run->problem->m;
    gm_run_set_state(run, y, run->scheme->family->doubled ? y + count : NULL);
}

/* A run after the trial's steps, or at the last one before a failure; NULL when out of memory. */
static struct gm_run *make_steps(const struct gm_trial *trial, const double *start)
{
    struct gm_run *run = gm_run_open(trial->problem, trial->scheme, trial->settings, 0, trial->dt, start);
    if (run && trial->scheme->family->doubled) {
        set_state(run, start);
    }
    if (run) {
        gm_run_advance(run, trial->steps);
    }
    return run;
}

bool gm_trial_advance(const struct gm_trial *trial, const double *start, double *end)
{
    struct gm_run *run = make_steps(trial, start);
    const bool advanced = run && run->status == GM_OK;
    if (run) {
        copy_state(run, end);
    }
    gm_run_close(run);
    return advanced;
}

static void reflect(const struct gm_trial *trial, double *y)
{
    const size_t n = trial->problem->n, copies = trial->scheme->family->doubled ? 2 : 1;
    for (size_t c = 0; c < copies * n; c++) {
        y[c] = c % n >= n / 2 ? -y[c] : y[c];
    }
}

bool gm_trial_turn(const struct gm_trial *trial, const double *start, bool reflected, double push,
                   double *end)
{
    struct gm_run *run = make_steps(trial, start);
    if (!run || run->status != GM_OK) {
        gm_run_close(run);
        return false;
    }
    copy_state(run, end);
    if (reflected) {
        reflect(trial, end);
    } else {
        gm_run_set_step(run, -trial->dt);
    }
    end[0] += push;
    if (reflected || push != 0 || trial->scheme->family->doubled) {
        set_state(run, end);
    }
    const bool returned = gm_run_advance(run, trial->steps) == GM_OK;
    copy_state(run, end);
    if (reflected) {
        reflect(trial, end);
    }
    gm_run_close(run);
    return returned;
}

struct solution {
    const gsl_odeiv2_system *equations;
    double tolerance, until, *y;
};

static bool solve(void *data)
{
    const struct solution *solution = data;
    const gsl_odeiv2_system *equations = solution->equations;
    double *rates = malloc(equations->dimension * sizeof *rates), size = 0, reach = 0;
    if (!rates || equations->function(0, solution->y, rates, equations->params) != GSL_SUCCESS) {
        free(rates);
        return false;
    }
    for (size_t i = 0; i < equations->dimension; i++) {
        size = fmax(size, fabs(solution->y[i]));
        reach = fmax(reach, fabs(solution->until * rates[i]));
    }
    free(rates);
    /* in units that make all numbers small the errors of schemes are as small; small components beside large ones take
       part in the round-off of these: no step is short enough for less */
    reach = fmax(size, reach);
    const double tolerance = solution->tolerance * (reach > 0 ? fmin(reach, 1) : 1);
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(
        equations, gsl_odeiv2_step_rk8pd, 1e-3, fmax(tolerance, DBL_EPSILON / 2 * size), solution->tolerance);
    if (!driver) {
        return false;
    }
    double t = 0;
    const int status = gsl_odeiv2_driver_apply(driver, &t, solution->until, solution->y);
    gsl_odeiv2_driver_free(driver);
    return status == GSL_SUCCESS;
}

bool gm_certify_solve(const gsl_odeiv2_system *equations, double tolerance, double until, double *y)
{
    return gm_memory_guard_gsl(solve, &(struct solution){equations, tolerance, until, y});
}

/* The body of an arena. */
struct theorising {
    const struct gm_scheme *scheme;
    struct gm_theory theory;
};

static void find_theory(struct gm_arena *arena, void *data)
{
    struct theorising *theorising = data;
    struct gm_coefficients coefficients;
    if (gm_scheme_coefficients_open(arena, theorising->scheme, &coefficients)) {
        theorising->theory = gm_theory_of(arena, &coefficients);
    }
}

struct gm_theory gm_scheme_theory(const struct gm_scheme *scheme)
{
    struct theorising theorising = {.scheme = scheme};
    gm_arena_run_once(find_theory, &theorising);
    return theorising.theory;
}

/* The claims that these coefficients cannot satisfy on every system. Symplectic methods are those that conserve all q' A p,
   and all quadratic invariants if p has the coefficients of q; reversible ones are the symmetric ones. No finite number of
   coefficients conserves every energy: of H = p + V(q) they compute an integral of V' by a quadrature. But a scheme that
   no user wrote may be made for energies of one form. Hairer, Lubich & Wanner (2006), IV.2, V.1; E. Celledoni et al.,
   ESAIM: M2AN 43 (2009) 645. */
static unsigned refuted_by(const struct gm_theory *theory, bool written)
{
    const unsigned bilinear = GM_KEEPS_BILINEAR | GM_KEEPS_MOMENTUM_MAPS;
    return (written ? GM_KEEPS_ENERGY : 0) |
           (theory->symplectic ? 0 : GM_SYMPLECTIC | GM_KEEPS_QUADRATIC | bilinear) |
           (theory->plain ? 0 : GM_KEEPS_QUADRATIC) | (theory->symmetric ? 0 : GM_SYMMETRIC | GM_REVERSIBLE);
}

/* `given`: the measurement is on one given system. It refutes no order that theory proves: the proof needs more derivatives
   than the system may have, and of a stiff system steps shorter than its fastest time. */
static void ask_theory(struct gm_certificate *certificate, bool given)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const struct gm_theory theory = gm_scheme_theory(scheme);
    certificate->theory = theory;
    certificate->theory_holds = true;
    if (!theory.known) {
        return;
    }
    const bool proved = scheme->order <= theory.order ||
                        (theory.at_least && (theory.at_most == 0 || scheme->order <= theory.at_most));
    certificate->refuted = refuted_by(&theory, scheme->word) & scheme->claims;
    certificate->theory_holds = proved && certificate->refuted == 0;
    /* a measured order above the theoretical one is special to a problem */
    const int least = theory.order > scheme->order ? theory.order : scheme->order;
    const bool reached = certificate->order > 0.95 * least || (proved && !certificate->ladder.settled);
    certificate->order_holds = reached || (given && proved);
    if (!reached && certificate->order_holds && !certificate->order_reason) {
        certificate->order_reason =
            "not reached on this system, which is stiff for these steps or has too few "
            "derivatives; theory proves the order";
    }
}

void gm_certificate_note_same(struct gm_certificate *certificate, const struct gm_problem *problem,
                              const struct gm_settings *settings, double dt, const double *start)
{
    enum { STEPS = 9 };
    const struct gm_trial trial = {problem, certificate->scheme, settings, dt, STEPS};
    struct gm_trial twin = trial;
    twin.scheme = gm_scheme_same_as(certificate->scheme, problem);
    const size_t n = problem->n;
    double *ends = twin.scheme ? malloc(2 * n * sizeof *ends) : NULL, size = 0;
    if (!ends) {
        return;
    }
    const bool advanced = gm_trial_advance(&trial, start, ends) && gm_trial_advance(&twin, start, ends + n);
    for (size_t c = 0; c < n; c++) {
        size = fmax(size, fabs(ends[c]));
    }
    const double difference = gm_distance(ends, ends + n, n) / (size > 0 ? size : 1);
    struct gm_sameness *same = &certificate->same;
    if (advanced && (!same->other || !(difference <= same->difference))) {
        *same =
            (struct gm_sameness){.other = twin.scheme, .difference = difference, .problem = problem->name};
    }
    free(ends);
}

static struct gm_certificate begin(const struct gm_scheme *scheme)
{
    struct gm_certificate certificate = {.scheme = scheme, .order = NAN, .order_problem = ""};
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        certificate.claims[bit].claimed = scheme->claims >> bit & 1;
        certificate.claims[bit].tolerance = 1e-12;
        certificate.claims[bit].problem = "";
    }
    gm_certificate_claim(&certificate, GM_SYMPLECTIC)->tolerance = 1e-10;
    gm_certificate_claim(&certificate, GM_KEEPS_VOLUME)->tolerance = 1e-10;
    gm_certificate_claim(&certificate, GM_CONFORMAL)->tolerance = 1e-10;
    gm_certificate_claim(&certificate, GM_POISSON_MAP)->tolerance = 1e-10;
    return certificate;
}

static void conclude(struct gm_certificate *certificate, bool given)
{
    const double rounding = 1e-11;
    ask_theory(certificate, given);
    struct gm_sameness *same = &certificate->same;
    same->holds = same->other && same->difference <= rounding;
    certificate->holds = certificate->order_holds && certificate->theory_holds &&
                         (!same->other || same->holds || same->undecided);
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_verdict *result = &certificate->claims[bit];
        const bool open = !result->measured && (result->undecided || result->reason);
        result->holds =
            result->measured && result->defect <= result->tolerance && !(certificate->refuted >> bit & 1);
        certificate->holds &= !result->claimed || result->holds || open;
    }
    for (size_t i = 0; i < certificate->held_count; i++) {
        struct gm_verdict *result = &certificate->held[i].verdict;
        result->holds = result->measured && result->defect <= result->tolerance;
        certificate->holds &= result->holds || !result->measured;
    }
}

struct gm_certificate gm_certify(const struct gm_scheme *scheme)
{
    struct gm_certificate certificate = begin(scheme);
    scheme->family->kind->certify(scheme, &certificate);
    /* on the program's own systems nothing excuses a claim; but a user's scheme may fit none of them */
    const bool untried = scheme->word && !certificate.order_problem[0];
    const char *reason = untried ? "no problem of the certificates fits it: name a system, --on SYSTEM"
                                 : "no problem of the certificates measures it: name a system, --on SYSTEM";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *verdict = &certificate.claims[bit];
        const bool open = scheme->word && verdict->claimed && !verdict->measured && !verdict->undecided;
        certificate.claims[bit].reason = open ? reason : NULL;
    }
    const bool fails = scheme->word && certificate.ladder.fails; /* an order is not refuted by no errors */
    certificate.order_reason =
        untried ? reason
        : fails ? "with every step the run fails before its end: name a system, --on SYSTEM"
                : certificate.order_reason;
    certificate.order_holds = certificate.order_holds || untried || fails;
    conclude(&certificate, false);
    return certificate;
}

struct gm_certificate gm_certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system)
{
    struct gm_certificate certificate = begin(scheme);
    scheme->family->kind->certify_on(scheme, system, &certificate);
    certificate.same.undecided = true; /* an equation of a long step may have several solutions */
    conclude(&certificate, true);
    return certificate;
}
