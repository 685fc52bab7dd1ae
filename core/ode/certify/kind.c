/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kind of ordinary differential equations: its facets, the families of schemes that need them, and their
   certificates: every subject that fits a scheme is measured. */
#include "core/functions/functions.h"
#include "core/ode/ode.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/certify/measure.h"
#include "core/ode/families/composition.h"
#include "core/ode/families/families.h"
#include "core/ode/families/invariants/held.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/action.h"
#include "core/ode_scheme_texts.h"
#include "core/quantity.h"
#include "core/run.h"
#include "core/theory/certify.h"

static unsigned facets_of_bracket(const struct gm_poisson *poisson)
{
    const bool turns = poisson->turning != 0;
    return GM_NEEDS_POISSON | (turns ? GM_NEEDS_GROUP : 0) |
           (turns && poisson->spins > 0 ? GM_NEEDS_ROTATIONS : 0) |
           (turns && poisson->spins <= 1 && poisson->axes ? GM_NEEDS_AXES : 0) |
           (poisson->moments[0] != 0 ? GM_NEEDS_FREE_BODY : 0) | (poisson->pieces > 0 ? GM_NEEDS_PIECES : 0);
}

static unsigned facets(const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    const struct gm_split *split = ode->split;
    const bool held = gm_action_constraints(problem) > 0; /* the energy generates another motion */
    const struct gm_hamiltonian *hamiltonian = held ? NULL : ode->hamiltonian;
    const bool action = gm_has_action(problem);
    return (split ? GM_NEEDS_SPLIT : 0) | (hamiltonian ? GM_NEEDS_HAMILTONIAN : 0) |
           (ode->lagrangian ? GM_NEEDS_LAGRANGIAN : 0) | (ode->fast_linear ? GM_NEEDS_FAST_LINEAR : 0) |
           (ode->kepler_split ? GM_NEEDS_KEPLER_SPLIT : 0) |
           (ode->kepler_split || (split && split->attracts) ? GM_NEEDS_ATTRACTION : 0) |
           (ode->kepler_split || ode->gravity ? GM_NEEDS_KEPLER : 0) | (ode->volume ? GM_NEEDS_VOLUME : 0) |
           (ode->quadratic ? GM_NEEDS_QUADRATIC : 0) | (split && split->nystrom ? GM_NEEDS_NYSTROM : 0) |
           (hamiltonian && !split ? GM_NEEDS_INSEPARABLE : 0) |
           (hamiltonian && !hamiltonian->partial ? GM_NEEDS_ENERGY : 0) |
           (action && !held ? GM_NEEDS_ACTION : 0) | (action && held ? GM_NEEDS_CONSTRAINTS : 0) |
           (ode->action && ode->action->friction ? GM_NEEDS_FRICTION : 0) |
           (ode->monitor ? GM_NEEDS_MONITOR : 0) | (ode->poisson ? facets_of_bracket(ode->poisson) : 0) |
           (ode->semilinear ? GM_NEEDS_SEMILINEAR : 0) | (ode->parts ? GM_NEEDS_PARTS : 0) |
           (gm_part_is_given(problem, "kinetic") || gm_part_is_given(problem, "potential")
                ? 0
                : GM_NEEDS_UNNAMED) |
           (ode->magnetic ? GM_NEEDS_MAGNETIC : 0) | (ode->degenerate ? GM_NEEDS_DEGENERATE : 0) |
           (ode->loops[GM_ISA_BASELINE]->jacobian ? GM_NEEDS_JACOBIAN : 0);
}

static const char *obstacle(const struct gm_problem *problem, unsigned lacking)
{
    const unsigned energy = GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM | GM_NEEDS_HAMILTONIAN | GM_NEEDS_ENERGY |
                            GM_NEEDS_INSEPARABLE | GM_NEEDS_ATTRACTION;
    return gm_ode_of(problem)->forced && (lacking & energy)
               ? "a Hamiltonian on which no force acts; here the line force: adds one"
               : NULL;
}

static const struct gm_facet_words words[] = {GM_FACET_WORDS{0}};

static gm_loop *loop(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    /* the loops of wide registers are for ensembles */
    const struct gm_loops *loops =
        gm_ode_of(problem)->loops[problem->m == 1 ? GM_ISA_BASELINE : gm_isa_best()];
    return loops ? loops->over_kernels[scheme->family->over_kernels] : NULL;
}

static void prepare(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    if (ode->prepare) {
        ode->prepare(problem, scheme->needs);
    }
}

static void note(struct gm_certificate *certificate, enum gm_claim claim, double defect, const char *problem)
{
    if (isnan(defect)) {
        gm_certificate_undecided(certificate, claim, problem);
    } else {
        gm_certificate_note(certificate, claim, defect, problem);
    }
}

/* Returns true if a field's equations on its grid conserve a quantity; derivatives in space may break a
   conservation law. The test is its change along the rates, at the start and further along them, where the
   states have the mirror symmetries of the start. */
static bool is_kept_on_the_grid(const struct gm_subject *subject, const struct gm_kept *kept)
{
    enum { STATES = 3 };
    const size_t n = subject->problem.n;
    double y[GM_SUBJECT_COMPONENTS], rate[GM_SUBJECT_COMPONENTS], side[GM_SUBJECT_COMPONENTS];
    memcpy(y, subject->start, n * sizeof *y);
    for (int k = 0; k < STATES; k++) {
        double fastest = 0, value[2];
        gm_field(&subject->problem, y, rate, 1);
        for (size_t c = 0; c < n; c++) {
            fastest = fmax(fastest, fabs(rate[c]));
        }
        const double step = fastest > 0 ? subject->scale / fastest : 0;
        for (int end = 0; end < 2; end++) {
            for (size_t c = 0; c < n; c++) {
                side[c] = y[c] + (end ? step : -step) * rate[c];
            }
            value[end] = kept->value(kept->data, side, NULL);
        }
        if (!(fabs(value[1] - value[0]) <= 1e-10 * (fabs(value[0]) + fabs(value[1])))) {
            return false;
        }
        for (size_t c = 0; c < n; c++) {
            y[c] += 0.3 * step * rate[c];
        }
    }
    return true;
}

/* Returns true if the bracket of a quantity with every component is 0, up to the error of differences. */
static bool is_casimir(const struct gm_subject *subject, const struct gm_kept *kept)
{
    const struct gm_poisson *poisson = gm_ode_of(&subject->problem)->poisson;
    const size_t n = subject->problem.n;
    double y[GM_SUBJECT_COMPONENTS], slope[GM_SUBJECT_COMPONENTS], largest = 0, sum = 0;
    double *matrix = poisson ? malloc(n * n * sizeof *matrix) : NULL;
    memcpy(y, subject->start, n * sizeof *y);
    for (size_t c = 0; matrix && c < n; c++) {
        const double h = 1e-5 * gm_subject_size(subject, c);
        y[c] = subject->start[c] + h;
        const double above = kept->value(kept->data, y, NULL);
        y[c] = subject->start[c] - h;
        slope[c] = (above - kept->value(kept->data, y, NULL)) / (2 * h);
        y[c] = subject->start[c];
    }
    if (matrix) {
        poisson->bracket(&subject->problem, y, matrix);
    }
    for (size_t i = 0; matrix && i < n; i++) {
        double moved = 0;
        for (size_t j = 0; j < n; j++) {
            moved += matrix[i * n + j] * slope[j];
            sum += fabs(matrix[i * n + j] * slope[j]);
        }
        largest = fmax(largest, fabs(moved));
    }
    free(matrix);
    return poisson && sum > 0 && largest <= 1e-6 * sum;
}

/* Returns true if the energy is even in the momenta. */
static bool is_even(const struct gm_subject *subject)
{
    double y[GM_SUBJECT_COMPONENTS], turned[GM_SUBJECT_COMPONENTS];
    for (int k = 1; k <= 4; k++) {
        for (size_t c = 0; c < subject->problem.n; c++) {
            y[c] = subject->start[c] + 0.1 * gm_subject_size(subject, c) * gm_sin(k * (double)(3 * c + 1));
            turned[c] = c < subject->problem.n / 2 ? y[c] : -y[c];
        }
        const double there = gm_energy(&subject->problem, y), back = gm_energy(&subject->problem, turned);
        if (!(fabs(there - back) <= 1e-12 * (fabs(there) + fabs(back)))) {
            return false;
        }
    }
    return true;
}

/* Measures the order on one system. The lowest settled order counts. Before the asymptotic regime an order
   may look too high, and if errors cancel, too low. */
static void measure_order(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    struct gm_ladder ladder;
    const double order = gm_measure_order(subject, &ladder);
    ladder.fails = ladder.fails && (!certificate->order_problem[0] || certificate->ladder.fails);
    const bool first = !certificate->order_problem[0] || isnan(certificate->order);
    if (first ||
        (ladder.settled == certificate->ladder.settled ? order < certificate->order : ladder.settled)) {
        certificate->order = order;
        certificate->ladder = ladder;
        certificate->order_problem = subject->problem.name;
    }
}

/* Returns the claims that concern a quantity that a system conserves; none if differences in space change it. */
static unsigned claims_of(const struct gm_subject *subject, const struct gm_kept *kept)
{
    const size_t n = subject->problem.n;
    if (subject->problem.line.points > 0 && !is_kept_on_the_grid(subject, kept)) {
        return 0;
    }
    return gm_kept_claims(kept, subject->start, n, n, subject->scale, subject->sizes) |
           (is_casimir(subject, kept) ? GM_KEEPS_CASIMIRS : 0);
}

/* Notes the change of a quantity that a system conserves, under every claim that concerns it. */
static void measure_kept(struct gm_certificate *certificate, const struct gm_subject *subject,
                         const struct gm_kept *kept)
{
    const char *const name = kept->name ? kept->name : subject->problem.name;
    const unsigned claims = claims_of(subject, kept);
    const double drift = claims ? gm_drift(subject, kept) : 0;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const enum gm_claim claim = (enum gm_claim)(1u << bit);
        const bool changes = drift > certificate->claims[bit].tolerance;
        if (!(claims & claim)) {
            continue;
        }
        if (changes && gm_ode_of(&subject->problem)->rough && isnan(subject->passed)) {
            /* the quantity may differ across a corner of the field */
            gm_certificate_undecided(certificate, claim, name);
        } else if (changes && drift < gm_round_off_of(subject, kept) / gm_kept_size(subject, kept)) {
            gm_certificate_withhold(certificate, claim,
                                    "round-off hides it: it is small beside the numbers that it is made of");
        } else {
            note(certificate, claim, drift, name);
        }
    }
}

/* The values of what a scheme holds. */
struct held {
    struct gm_conserved conserved;
    size_t number;
};

static double value_of_held(const void *data, const double *y, const double *memory)
{
    const struct held *held = data;
    double values[GM_MOST_CONSERVED];
    (void)memory;
    gm_conserved_values(&held->conserved, y, values);
    return values[held->number];
}

/* Notes the changes of the invariants that the scheme holds by name. */
static void measure_held(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    const struct gm_holding *holding = gm_holding_of(certificate->scheme);
    struct held held;
    char lacks[GM_FAULT_SENTENCE];
    certificate->held_count = holding ? holding->count : 0;
    if (certificate->held_count == 0 ||
        !gm_conserved_open(&held.conserved, &subject->problem, holding->names, holding->count, lacks)) {
        return;
    }
    for (held.number = 0; held.number < holding->count; held.number++) {
        struct gm_held_verdict *row = &certificate->held[held.number];
        const struct gm_kept kept = {.value = value_of_held, .data = &held};
        row->name = holding->names[held.number];
        row->verdict.tolerance = gm_certificate_claim(certificate, GM_KEEPS_ENERGY)->tolerance;
        const double drift = gm_drift(subject, &kept);
        if (!isnan(drift) || !subject->scheme->family->adaptive) {
            gm_verdict_note(&row->verdict, drift, subject->problem.name);
        }
    }
    gm_conserved_close(&held.conserved);
}

/* Measures the order and every claim that means something on a system; the others get the reason why not. */
static void measure(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    const struct gm_ode *ode = gm_ode_of(&subject->problem);
    const size_t n = subject->problem.n;
    const bool hamiltonian = ode->hamiltonian && !ode->hamiltonian->partial && n % 2 == 0,
               even = hamiltonian && is_even(subject), poisson = ode->poisson != NULL,
               form = hamiltonian || ode->degenerate, damped = gm_subject_friction(subject) != 0,
               held = gm_action_constraints(&subject->problem) > 0,
               differentiable = !subject->scheme->family->adaptive && n <= GM_SUBJECT_TANGENTS,
               on_a_grid = subject->problem.line.points > 0;
    const char *const no_energy = "the system has no Hamiltonian of the whole state";
    const char *const no_bracket = "the system has no bracket";
    const char *const no_constraints = "the system has no constraints";
    const char *const no_derivative = n > GM_SUBJECT_TANGENTS
                                          ? "a step is differentiated for at most 64 components"
                                          : "the length of a step depends on the state";
    const struct {
        enum gm_claim claim;
        bool measured;
        const char *otherwise;
    } claims[] = {
        {GM_SYMMETRIC, true, NULL},
        {GM_REVERSIBLE, even,
         hamiltonian ? "its Hamiltonian changes where the momenta turn round" : no_energy},
        {GM_SYMPLECTIC, form && differentiable, form ? no_derivative : no_energy},
        {GM_CONFORMAL, damped && differentiable, damped ? no_derivative : "the system has no friction -c p"},
        {GM_POISSON_MAP, poisson && differentiable, poisson ? no_derivative : no_bracket},
        {GM_KEEPS_VOLUME, ((ode->volume && subject->volume && n == 3) || ode->magnetic) && differentiable,
         "the system is neither magnetic nor of three components without divergence"},
        {GM_KEEPS_ENERGY, (hamiltonian || poisson) && !ode->energy_jumps,
         ode->energy_jumps ? "H jumps, and the equations have no force for that" : no_energy},
        {GM_KEEPS_CONSTRAINTS, held, no_constraints},
        {GM_KEEPS_HIDDEN, held, no_constraints},
        {GM_KEEPS_LINEAR, false,
         on_a_grid ? "no linear invariant is named that its derivatives in space keep"
                   : "the system names no linear invariant"},
        {GM_KEEPS_QUADRATIC, false,
         on_a_grid ? "no quadratic invariant is named that its derivatives in space keep"
                   : "the system names no quadratic invariant"},
        {GM_KEEPS_BILINEAR, false, "the system names no invariant of the form q' A p"},
        {GM_KEEPS_MOMENTUM_MAPS, false, "the system names no symmetry that moves q by affine maps"},
        {GM_KEEPS_CASIMIRS, false, poisson ? "the system names no Casimir" : no_bracket},
    };
    struct gm_subject between = gm_subject_between_events(subject);
    between.start = subject->away ? subject->away : between.start;
    measure_order(certificate, subject);
    for (size_t i = 0; i < subject->kept_count; i++) {
        measure_kept(certificate, subject, &subject->kept[i]);
    }
    measure_held(certificate, subject);
    for (size_t i = 0; i < GM_COUNT(claims); i++) {
        const enum gm_claim claim = claims[i].claim;
        const double tolerance = gm_certificate_claim(certificate, claim)->tolerance;
        const double defect = claims[i].measured ? gm_defect(subject, claim, tolerance) : 0;
        const bool by_event = subject->problem.events && defect > tolerance &&
                              gm_defect(&between, claim, tolerance) <= tolerance;
        if (!claims[i].measured || by_event) {
            gm_certificate_withhold(certificate, claim,
                                    by_event ? "it holds between events and breaks, not through them"
                                             : claims[i].otherwise);
        } else {
            note(certificate, claim, defect, subject->problem.name);
        }
    }
    const struct gm_settings settings = gm_subject_settings(subject->dt);
    gm_certificate_note_same(certificate, &subject->problem, &settings, subject->dt, subject->start);
}

/* The changes of an invariant within a quarter of the run. */
struct quarter {
    double low, high;
};

static double largest(const struct quarter *quarter)
{
    return fmax(-quarter->low, quarter->high);
}

/* An error that grows in proportion to the time is four times as large in the last quarter as in the first, one that
   oscillates is not twice as large, and comes back to values that it had before. A loss that ends has changed by a part of
   the invariant, and rests. */
static bool drifts(const struct quarter *first, const struct quarter *last, double low, double high,
                   double scale)
{
    const bool rests = last->high - last->low < 0.05 * (high - low) && high - low > 0.05 * scale;
    const bool left = last->low > first->high || last->high < first->low;
    return rests || left || largest(last) > 2 * largest(first);
}

/* The change of an invariant by one rounding of its components: the larger one of the start and of the end, as
   components may grow, such as angles that turn. */
static double rounding_of(const struct gm_subject *subject, const struct gm_kept *kept, const double *end)
{
    struct gm_subject last = *subject;
    last.start = end;
    for (size_t c = 0; c < last.problem.n; c++) {
        last.scale = fmax(last.scale, fabs(end[c]));
    }
    return fmax(gm_round_off_of(subject, kept), gm_round_off_of(&last, kept)) / 100;
}

/* Judges claims by an invariant that was followed: a change beyond ten roundings of each step refutes them, and what
   could not be decided without a step is not measured. */
static void judge(struct gm_certificate *certificate, const struct gm_subject *subject,
                  const struct gm_followed *row, const struct gm_kept *kept, unsigned claims, double rounding)
{
    const bool refutes =
        !gm_ode_of(&subject->problem)->rough && row->defect > 10 * (double)row->steps * rounding;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_verdict *verdict = &certificate->claims[bit];
        if (!(claims >> bit & 1)) {
            continue;
        }
        if (row->steps == 0 && verdict->undecided && !verdict->measured) {
            verdict->undecided = false;
            verdict->reason = "the scheme makes no step from this start";
        } else if (refutes && row->defect > verdict->tolerance) {
            gm_verdict_note(verdict, row->defect, kept->name ? kept->name : subject->problem.name);
        }
    }
}

/* The sum of the jumps that events give an invariant. */
struct jumps {
    const struct gm_kept *kept;
    double sum;
};

static void see_jump(void *data, const struct gm_event_part *part)
{
    struct jumps *jumps = data;
    const struct gm_kept *kept = jumps->kept;
    jumps->sum += kept->value(kept->data, part->after, NULL) - kept->value(kept->data, part->before, NULL);
}

/* The change of the invariant from x0, without the jumps. */
static double change_from(const struct gm_run *run, const struct jumps *jumps, double x0)
{
    const struct gm_kept *kept = jumps->kept;
    return kept->value(kept->data, gm_run_state(run), gm_run_memory(run)) - x0 - jumps->sum;
}

/* Returns false if a small change that grew so far stops to grow when the run is made up to sixteen times as long, as in a
   beat or a slow oscillation. Large systems are taken at their word. */
static bool grows_on(struct gm_run *run, const struct jumps *jumps, double x0, double so_far)
{
    enum { DOUBLINGS = 4, STEPS = 10, SMALL = 32 };
    for (int k = 0; k < DOUBLINGS && run->problem->n <= SMALL; k++) {
        double most = 0;
        for (const int64_t end = 2 * run->steps; run->steps < end;) {
            if (gm_run_advance(run, STEPS) != GM_OK) {
                return true;
            }
            most = fmax(most, fabs(change_from(run, jumps, x0)));
        }
        if (most < 1.5 * so_far) {
            return false;
        }
        so_far = most;
    }
    return true;
}

/* Notes what becomes of an invariant in 4000 steps, beside the jumps of events, and judges the claims that concern it. */
static void follow(struct gm_certificate *certificate, const struct gm_subject *subject, const char *name,
                   const struct gm_kept *kept, unsigned claims)
{
    enum { QUARTERS = 4, LOOKS = 100, STEPS = 10 };
    const double round_off = 1e-12, x0 = kept->value(kept->data, subject->start, NULL);
    const double unit = gm_kept_unit(subject, kept), scale = fabs(x0) > round_off * unit ? fabs(x0) : unit;
    const char *end = strstr(name, "_error");
    const struct gm_settings settings = gm_subject_settings(subject->dt);
    struct quarter quarters[QUARTERS];
    double low = 0, high = 0;
    struct gm_run *run =
        certificate->followed_count < GM_MOST_FOLLOWED
            ? gm_run_open(&subject->problem, certificate->scheme, &settings, 0, subject->dt, subject->start)
            : NULL;
    if (!run) {
        return;
    }
    struct jumps jumps = {kept, 0};
    run->witness = (struct gm_event_witness){see_jump, &jumps};
    int look = 0;
    for (; look < QUARTERS * LOOKS && gm_run_advance(run, STEPS) == GM_OK; look++) {
        const double change = change_from(run, &jumps, x0);
        struct quarter *now = &quarters[look / LOOKS];
        *now = look % LOOKS == 0 ? (struct quarter){change, change}
                                 : (struct quarter){fmin(now->low, change), fmax(now->high, change)};
        low = fmin(low, change);
        high = fmax(high, change);
    }
    struct gm_followed *row = &certificate->followed[certificate->followed_count++];
    snprintf(row->name, sizeof row->name, "%.*s", (int)(end ? end - name : (ptrdiff_t)strlen(name)), name);
    row->defect = fmax(-low, high) / scale;
    row->steps = run->steps;
    row->status = run->status;
    const double rounding = rounding_of(subject, kept, gm_run_state(run)) / scale;
    if (look < QUARTERS * LOOKS) {
        row->verdict = "not measured";
    } else if (row->defect <= fmax(round_off, (double)row->steps * rounding)) {
        row->verdict = "conserved";
    } else {
        const bool grows = drifts(&quarters[0], &quarters[QUARTERS - 1], low, high, scale),
                   small = high - low < 0.05 * scale;
        row->verdict =
            grows && (!small || grows_on(run, &jumps, x0, fmax(-low, high))) ? "drifts" : "oscillates";
    }
    judge(certificate, subject, row, kept, claims, rounding);
    gm_run_close(run);
}

/* Follows H, the invariants that the system names, and those that are found: I1, I2, ..., or found1, found2, ... */
static void follow_all(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    static const char *const found_words[] = {"I", "found"};
    const struct gm_ode *ode = gm_ode_of(&subject->problem);
    const struct gm_invariant energy = {ode->hamiltonian ? gm_energy
                                        : ode->poisson   ? ode->poisson->energy
                                                         : NULL,
                                        &subject->problem};
    char name[16] = "H", lacks[GM_FAULT_SENTENCE];
    const char *const names[] = {name};
    struct held held = {.number = 0};
    if (energy.value && !(ode->hamiltonian && ode->hamiltonian->partial)) {
        const struct gm_kept kept = {.value = gm_invariant_value, .data = &energy};
        follow(certificate, subject, name, &kept, GM_KEEPS_ENERGY | claims_of(subject, &kept));
    }
    for (size_t i = 0; i < subject->kept_count; i++) {
        if (strcmp(subject->kept[i].name, "energy_error") != 0) {
            follow(certificate, subject, subject->kept[i].name, &subject->kept[i],
                   claims_of(subject, &subject->kept[i]));
        }
    }
    for (size_t k = 0; k < GM_COUNT(found_words); k++) {
        for (int number = 1; ode->conserved && number < GM_MOST_FOLLOWED; number++) {
            snprintf(name, sizeof name, "%s%d", found_words[k], number);
            if (!gm_conserved_open(&held.conserved, &subject->problem, names, 1, lacks)) {
                break;
            }
            const struct gm_kept found = {.value = value_of_held, .data = &held};
            measure_kept(certificate, subject, &found);
            follow(certificate, subject, name, &found, claims_of(subject, &found));
            gm_conserved_close(&held.conserved);
        }
    }
}

/* Leaves satisfied claims undecided on a system that is not smooth: the few steps may all lie on one side of
   a corner. A failed claim stays so. Where breaks are located and the stretch passes each of them twice, a drift is decided;
   so are steps forth and back through the only one. */
static void doubt(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    const unsigned drifts = GM_KEEPS_ENERGY | GM_KEEPS_LINEAR | GM_KEEPS_QUADRATIC | GM_KEEPS_BILINEAR |
                            GM_KEEPS_MOMENTUM_MAPS,
                   back = GM_SYMMETRIC | GM_REVERSIBLE,
                   decided = isnan(subject->passed)                 ? 0
                             : subject->problem.events->breaks == 1 ? drifts | back
                                                                    : drifts;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_verdict *verdict = &certificate->claims[bit];
        const bool held = verdict->measured && verdict->defect <= verdict->tolerance;
        if (!(decided >> bit & 1) && (held || verdict->undecided)) {
            verdict->measured = false;
            verdict->undecided = true;
            verdict->reason = "the system is not smooth, and these few steps may not have crossed a corner";
        }
    }
}

/* True if no step moves the start. */
static bool rests(const struct gm_subject *subject)
{
    double rate[GM_SUBJECT_COMPONENTS];
    bool moves = false;
    gm_field(&subject->problem, subject->start, rate, 1);
    for (size_t c = 0; c < subject->problem.n; c++) {
        moves = moves || !(fabs(subject->dt * rate[c]) <= DBL_EPSILON * gm_subject_size(subject, c));
    }
    return !moves;
}

/* Leaves claims undecided that hold in steps which any scheme would make: from an equilibrium, or so short that the error of
   a step is not seen. What theory proves needs no error. */
static void doubt_steps(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    const unsigned differentiated = GM_SYMPLECTIC | GM_CONFORMAL | GM_POISSON_MAP | GM_KEEPS_VOLUME,
                   of_step = differentiated | GM_SYMMETRIC | GM_REVERSIBLE;
    const bool resting = rests(subject), exempt = !subject->scheme->word || subject->scheme->family->adaptive;
    const double seen = 1e-8, error = exempt ? INFINITY : gm_step_error(subject); /* by any tolerance */
    const double visible = error < seen && gm_scheme_theory(subject->scheme).known ? INFINITY : error;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_verdict *verdict = &certificate->claims[bit];
        const bool rest = resting && !(differentiated >> bit & 1),
                   hidden = of_step >> bit & 1 && visible <= 10 * verdict->tolerance;
        if ((rest || hidden) && verdict->measured && verdict->defect <= verdict->tolerance) {
            verdict->measured = false;
            verdict->undecided = true;
            verdict->reason =
                rest ? "the start is an equilibrium, from which no step moves: start elsewhere"
                     : "these steps are exact to the digits that count, so that nothing of the scheme "
                       "shows: take a longer dt";
        }
    }
}

/* *first := the time of the first event or break, if it is NaN. */
static void see_first(void *data, const struct gm_event_part *part)
{
    double *first = data;
    *first = isnan(*first) ? part->before[part->ahead->n] : *first;
}

/* Returns true if a run has passed each break twice; without breaks, some event. */
static bool has_passed(const struct gm_run *run)
{
    const struct gm_events *events = run->problem->events;
    const double *memory = gm_run_events(run);
    bool passed = events->breaks > 0 || gm_events_happened(run->problem, memory, events->count) > 0;
    for (size_t i = events->written; i < events->written + events->breaks; i++) {
        passed &= gm_events_happened(run->problem, memory, i) >= 2;
    }
    return passed;
}

/* Returns the state half a step before the first event or break of a run, and one a whole step earlier, from which one step
   meets none. From the first a stretch of length *passed passes
   each break twice, if that is not NaN; the caller frees. NULL: none happens in 2000 steps, or when out of memory. */
static double *start_before_event(const struct gm_subject *subject, double *passed)
{
    const struct gm_problem *problem = &subject->problem;
    const struct gm_events *events = problem->events;
    const struct gm_settings settings = gm_subject_settings(subject->dt);
    const size_t bytes = problem->n * sizeof(double);
    const bool looks = events && (events->changes || events->breaks > 0);
    double *state = looks ? malloc(2 * bytes) : NULL, first = NAN;
    struct gm_run *run =
        state ? gm_run_open(problem, subject->scheme, &settings, 0, subject->dt, subject->start) : NULL;
    *passed = NAN;
    if (run) {
        run->witness = (struct gm_event_witness){see_first, &first};
        while (run->steps < 2000 && !has_passed(run) && gm_run_advance(run, 1) == GM_OK) {
        }
        *passed = has_passed(run) && !events->changes ? run->t : NAN;
    }
    gm_run_close(run);
    const double until = first - subject->dt / 2, whole = floor(until / subject->dt);
    *passed -= whole >= 0 ? until : 0;
    run =
        whole >= 0 ? gm_run_open(problem, subject->scheme, &settings, 0, subject->dt, subject->start) : NULL;
    bool there = run && (whole < 1 || gm_run_advance(run, (int64_t)whole - 1) == GM_OK);
    if (there) {
        memcpy(state + problem->n, gm_run_state(run), bytes);
        there = whole < 1 || gm_run_advance(run, 1) == GM_OK;
    }
    if (there) {
        gm_run_set_step(run, until - whole * subject->dt);
        there = gm_run_advance(run, 1) == GM_OK;
        memcpy(state, gm_run_state(run), bytes);
    }
    gm_run_close(run);
    if (!there) {
        free(state);
    }
    return there ? state : NULL;
}

/* True without an order, or with a low one that other steps do not confirm: their errors may be those of the reference. */
static bool doubts_order(const struct gm_certificate *certificate, const struct gm_scheme *scheme)
{
    return isnan(certificate->order) ||
           (!certificate->ladder.settled && certificate->order <= 0.95 * scheme->order);
}

/* Returns true if the steps of a composition that lose energy are all of one scheme with coefficients, and of one sign.
   Each loses the same leading term, and steps between them that conserve the energy change it in higher orders alone. */
static bool loses_energy(const struct gm_scheme *scheme)
{
    const struct gm_substeps *steps = gm_scheme_is_composition(scheme) ? scheme->coefficients : NULL;
    const struct gm_substep *first = NULL;
    bool same = steps != NULL;
    for (int i = 0; same && i < steps->count; i++) {
        const struct gm_substep *step = &steps->at[i];
        if (!(step->scheme->claims & GM_KEEPS_ENERGY)) {
            first = first ? first : step;
            same = step->scheme == first->scheme && step->fraction * first->fraction > 0;
        }
    }
    return same && first && gm_scheme_has_coefficients(first->scheme);
}

/* Returns the sizes of canonical coordinates, one of all q and one of all p, so that dq dp has one unit: of each the
   largest number, or its change in a step. The scale becomes the larger one. The caller frees; NULL: neither is far from
   the scale, or out of memory. Other components may be small for another reason than their unit, such as a field's far
   from a wave. */
static double *sizes_of(struct gm_subject *subject)
{
    const double other = 1e4;
    const size_t n = subject->problem.n, half = n / 2;
    double *sizes =
        facets(&subject->problem) & GM_NEEDS_ENERGY && n % 2 == 0 ? malloc(2 * n * sizeof *sizes) : NULL;
    double of[2] = {0};
    if (!sizes) {
        return NULL;
    }
    gm_field(&subject->problem, subject->start, sizes + n, 1);
    for (size_t c = 0; c < n; c++) {
        of[c / half] = fmax(of[c / half], fmax(fabs(subject->start[c]), fabs(subject->dt * sizes[n + c])));
    }
    const double largest = fmax(of[0], of[1]);
    if (!(fmin(of[0], of[1]) > 0 && isfinite(largest) &&
          (largest > other * subject->scale || fmin(of[0], of[1]) * other < subject->scale))) {
        free(sizes);
        return NULL;
    }
    subject->scale = fmax(subject->scale, largest);
    for (size_t c = 0; c < n; c++) {
        sizes[c] = of[c / half] * other < subject->scale ? of[c / half] : subject->scale;
    }
    return sizes;
}

static void certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate)
{
    struct gm_subject subject = {.problem = *system->problem,
                                 .scheme = scheme,
                                 .start = system->start,
                                 .dt = system->dt,
                                 .unit = 16 * fabs(system->dt),
                                 .volume = true,
                                 .kept = system->kept,
                                 .kept_count = system->kept_count};
    for (size_t c = 0; c < subject.problem.n; c++) {
        subject.scale = fmax(subject.scale, fabs(system->start[c]));
    }
    subject.scale = subject.scale > 0 ? subject.scale : 1;
    double *sizes = sizes_of(&subject);
    subject.sizes = sizes;
    const struct gm_degenerate *degenerate = gm_ode_of(system->problem)->degenerate;
    if (degenerate && !(degenerate->half_gauge && (scheme->needs & GM_NEEDS_DEGENERATE))) {
        /* of other schemes the claim is about canonical coordinates, and of this one about half of theta */
        gm_certificate_claim(certificate, GM_SYMPLECTIC)->claimed = false;
    }
    if (gm_action_constraints(system->problem) > 0 && !(scheme->needs & GM_NEEDS_CONSTRAINTS)) {
        /* the motion is Hamiltonian, and has its invariants, where the constraints hold: this scheme leaves that place */
        static const enum gm_claim of_the_manifold[] = {GM_SYMPLECTIC, GM_KEEPS_QUADRATIC, GM_KEEPS_BILINEAR,
                                                        GM_KEEPS_MOMENTUM_MAPS};
        for (size_t i = 0; i < GM_COUNT(of_the_manifold); i++) {
            gm_certificate_claim(certificate, of_the_manifold[i])->claimed = false;
        }
    }
    double *start = start_before_event(&subject, &subject.passed);
    subject.away = start && !isnan(subject.passed) ? start + subject.problem.n : NULL;
    subject.start = start ? start : subject.start;
    subject.unit = fmax(subject.unit, subject.passed / 2);
    measure(certificate, &subject);
    certificate->refuted = loses_energy(scheme) ? scheme->claims & GM_KEEPS_ENERGY : 0;
    follow_all(certificate, &subject);
    /* an order needs short steps, and the dt of a map may be long */
    for (int shorter = 0; doubts_order(certificate, scheme) && shorter < 4; shorter++) {
        subject.unit /= 8;
        measure_order(certificate, &subject);
    }
    const bool unclear = !isnan(certificate->order) && doubts_order(certificate, scheme);
    certificate->order = unclear ? NAN : certificate->order;
    const bool rough = gm_ode_of(system->problem)->rough;
    if (rough && isnan(subject.passed)) {
        certificate->order = NAN;
        certificate->ladder.settled = false;
        certificate->order_reason =
            subject.problem.events && subject.problem.events->breaks > 0 &&
                    !subject.problem.events->changes && gm_scheme_locates_breaks(scheme)
                ? "the system is not smooth, and 2000 steps do not pass each break twice"
                : "the system is not smooth, so that no order can be measured";
    } else if (unclear) {
        certificate->order_reason = "the errors of shorter steps follow no power of dt";
    } else if (isnan(certificate->order)) {
        certificate->order_reason =
            certificate->ladder.fails ? "with every step from 8 dt down the run fails before its end"
            : certificate->ladder.large
                ? "errors of all steps from 8 dt down are as large as the motion: take a shorter dt"
                : "no errors of steps from 8 dt down exceed round-off: take a longer dt";
    }
    certificate->order_holds = !(certificate->order <= 0.95 * scheme->order) || !certificate->ladder.settled;
    gm_certificate_withhold_all(certificate, UINT_MAX, "it means nothing of ordinary differential equations");
    if (rough) {
        doubt(certificate, &subject);
    }
    doubt_steps(certificate, &subject);
    free(start);
    free(sizes);
}

static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    for (size_t i = 0; i < gm_subject_count(); i++) {
        struct gm_subject subject;
        if (gm_subject_open(&subject, i, scheme)) {
            measure(certificate, &subject);
        }
        gm_subject_close(&subject);
    }
    certificate->refuted = loses_energy(scheme) ? scheme->claims & GM_KEEPS_ENERGY : 0;
    /* a scheme that chooses its order has to follow its tolerance; a user's has at least the order of its parts */
    const double least = scheme->order == 0 ? 0.5 : 0.95 * scheme->order;
    certificate->order_holds = certificate->order > least && (scheme->order == 0 || scheme->word ||
                                                              certificate->order < 1.05 * scheme->order);
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/ode/families/families.def"
#undef GM_FAMILY
    NULL,
};

static bool is_linear(const struct gm_problem *problem)
{
    return gm_ode_of(problem)->linear;
}

/* H = T(p) + V(q), T quadratic, without a force or a constraint */
static bool is_natural(const struct gm_problem *problem)
{
    return (~facets(problem) & (GM_NEEDS_NYSTROM | GM_NEEDS_ENERGY | GM_NEEDS_ACTION)) == 0;
}

/* H = T(p) + V(q), without a force or a constraint: the flows of all q commute, and so do those of all p */
static bool is_separable(const struct gm_problem *problem)
{
    return (~facets(problem) & (GM_NEEDS_SPLIT | GM_NEEDS_ENERGY)) == 0;
}

static const struct gm_same same[] = {
    {"variational-midpoint2", "midpoint", is_natural},
    {"variational-trapezoidal2", "verlet", is_natural},
    {"variational-simpson4", "lobatto4", is_natural},
    {"trapezoidal", "midpoint", is_linear},
    {"avf2", "midpoint", is_linear},
    {"discrete-gradient2", "midpoint", is_linear},
    {"kahan2", "midpoint", is_linear},
    {"avf4", "rk4sym", is_linear},
    {"volume-splitting1", "symplectic-euler-adjoint", is_separable},
    {"volume-splitting2", "verlet-position", is_separable},
    {0},
};

const struct gm_kind gm_kind_ode = {
    .name = "ode",
    .problems = "ordinary differential equations",
    .words = words,
    .facets = facets,
    .obstacle = obstacle,
    .loop = loop,
    .prepare = prepare,
    .certify = certify,
    .certify_on = certify_on,
    .most_certified = GM_SUBJECT_COMPONENTS,
    .families = families,
    .same = same,
    .quantities = gm_ode_quantities,
};
