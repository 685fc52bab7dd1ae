/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs: the same bits however they are called, cut, copied or vectorised; how they fail; what they count. */
#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <gsl/gsl_errno.h>

#include "core/basics.h"
#include "core/events.h"
#include "core/memory.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/problems/problems.h"

static const double constants[3] = {0.3, 0.4, 0.5}; /* the parameters of every problem that has some */
static const struct gm_settings settings_of[2] = {{.compensated = 0, .binding = 20, .tau0 = 0.01},
                                                  {.compensated = 1, .binding = 20, .tau0 = 0.01}};

enum { PROBLEMS = 9, MOST = 12 };

static struct gm_problem problem_at(int i)
{
    const struct gm_problem *const list[PROBLEMS] = {
        &gm_problem_pendulum,     &gm_problem_pendulum_tangent, &gm_problem_particles,
        &gm_problem_product,      &gm_problem_rigid_body,       &gm_problem_kepler,
        &gm_problem_henon_heiles, &gm_problem_vortices_four,    &gm_problem_fpu,
    };
    struct gm_problem problem = *list[i];
    problem.parameters = constants;
    return problem;
}

/* A start that differs from member to member; moderate, so that every scheme gets through. */
static void start_of(const struct gm_problem *problem, double *y)
{
    for (size_t c = 0; c < problem->n; c++) {
        for (size_t i = 0; i < problem->m; i++) {
            y[c * problem->m + i] = 0.5 * sin(1.0 + 2.3 * (double)c + 0.7 * (double)i);
        }
    }
    const bool vortices = gm_ode_of(problem)->hamiltonian && gm_ode_of(problem)->hamiltonian->weight;
    for (size_t c = 0; vortices && c < 4; c++) { /* apart from each other */
        for (size_t i = 0; i < problem->m; i++) {
            const double angle = 1.6 * (double)c + 0.7 * (double)i;
            y[c * problem->m + i] = cos(angle);
            y[(4 + c) * problem->m + i] = sin(angle);
        }
    }
    for (size_t i = 0; gm_ode_of(problem)->kepler_split && i < problem->m;
         i++) { /* orbits that stay away from the centre */
        const double angle = 0.7 * (double)i, speed = 1 + 0.1 * sin(2.3 * (double)i);
        const double orbit[4] = {cos(angle), sin(angle), -speed * sin(angle), speed * cos(angle)};
        for (size_t c = 0; c < 4; c++) {
            y[c * problem->m + i] = orbit[c];
        }
    }
}

typedef void each(const struct gm_problem *problem, const struct gm_scheme *scheme,
                  const struct gm_settings *settings);

/* Not for long: the one loses its root from any start (tests/unit/reference.c follows it there), the other
   falls into the centre. */
static bool is_tested(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    return !(gm_ode_of(problem)->fast_linear && !(scheme->needs & GM_NEEDS_FAST_LINEAR)) &&
           strcmp(scheme->name, "variational-rectangle") != 0 &&
           !(gm_ode_of(problem)->kepler_split && strcmp(scheme->name, "implicit-euler") == 0);
}

static void for_all(size_t members, each *function)
{
    for (int p = 0; p < PROBLEMS; p++) {
        struct gm_problem problem = problem_at(p);
        problem.m = members;
        for (size_t s = 0; s < gm_scheme_count(); s++) {
            if (gm_scheme_fits(gm_scheme_at(s), &problem) && is_tested(gm_scheme_at(s), &problem)) {
                function(&problem, gm_scheme_at(s), &settings_of[0]);
                function(&problem, gm_scheme_at(s), &settings_of[1]);
            }
        }
    }
}

static struct gm_run *open_run(const struct gm_problem *problem, const struct gm_scheme *scheme,
                               const struct gm_settings *settings, double dt)
{
    double start[MOST * 64];
    assert_true(problem->n * problem->m <= MOST * 64);
    start_of(problem, start);
    struct gm_run *run = gm_run_open(problem, scheme, settings, 0, dt, start);
    assert_non_null(run);
    return run;
}

static void expect_same_state(const struct gm_run *a, const struct gm_run *b)
{
    const size_t size = a->problem->n * a->problem->m * sizeof(double);
    if (memcmp(gm_run_state(a), gm_run_state(b), size) != 0) {
        fail_msg("%s on %s: different bits", a->scheme->name, a->problem->name);
    }
}

static void cut_in_pieces(const struct gm_problem *problem, const struct gm_scheme *scheme,
                          const struct gm_settings *settings)
{
    struct gm_run *whole = open_run(problem, scheme, settings, 0.05);
    struct gm_run *pieces = open_run(problem, scheme, settings, 0.05);
    if (gm_run_advance(whole, 100) != GM_OK) {
        fail_msg("%s on %s fails", scheme->name, problem->name);
    }
    for (long done = 0, piece = 1; done < 100;
         done += piece, piece = done + 2 * piece <= 100 ? 2 * piece : 1) {
        assert_int_equal(gm_run_advance(pieces, piece), GM_OK);
    }
    assert_int_equal(pieces->steps, 100);
    expect_same_state(whole, pieces);
    assert_true(whole->t == pieces->t && (scheme->family->adaptive || whole->t == 100 * 0.05));
    assert_true(whole->evaluations == pieces->evaluations);
    gm_run_close(whole);
    gm_run_close(pieces);
}

static void pieces_do_not_matter(void **unused)
{
    (void)unused;
    for_all(1, cut_in_pieces);
    for_all(21, cut_in_pieces);
}

static void compare_members(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const struct gm_settings *settings)
{
    struct gm_run *ensemble = open_run(problem, scheme, settings, 0.05);
    assert_int_equal(gm_run_advance(ensemble, 40), GM_OK);
    double start[MOST * 64];
    start_of(problem, start);
    struct gm_problem alone = *problem;
    alone.m = 1;
    unsigned long evaluations = 0;
    for (size_t i = 0; i < problem->m; i++) {
        double y[MOST];
        for (size_t c = 0; c < problem->n; c++) {
            y[c] = start[c * problem->m + i];
        }
        struct gm_run *single = gm_run_open(&alone, scheme, settings, 0, 0.05, y);
        assert_int_equal(gm_run_advance(single, 40), GM_OK);
        evaluations += single->evaluations;
        for (size_t c = 0; c < problem->n; c++) {
            const double there = gm_run_state(ensemble)[c * problem->m + i];
            if (memcmp(&there, &gm_run_state(single)[c], sizeof there) != 0) {
                fail_msg("%s on %s: member %zu feels its neighbours", scheme->name, problem->name, i);
            }
        }
        gm_run_close(single);
    }
    assert_true(ensemble->evaluations == evaluations);
    gm_run_close(ensemble);
}

static void members_do_not_feel_each_other(void **unused)
{
    (void)unused;
    for_all(21, compare_members);
}

static void compare_instruction_sets(const struct gm_problem *problem, const struct gm_scheme *scheme,
                                     const struct gm_settings *settings)
{
    if (gm_scheme_loop(scheme, problem) == scheme->family->loop) {
        return; /* no kernels in it */
    }
    const size_t count = problem->n * problem->m;
    double y[MOST * 64], carry[MOST * 64] = {0}, out[GM_ISA_COUNT][MOST * 64], carry_out[MOST * 64];
    start_of(problem, y);
    for (int isa = 0; isa <= (int)gm_isa_best(); isa++) {
        const struct gm_task task = {
            .problem = problem,
            .scheme = scheme,
            .dt = 0.05,
            .steps = 40,
            .limit = 1e10,
            .y = y,
            .out = out[isa],
            .carry = settings->compensated ? carry : NULL,
            .carry_out = settings->compensated ? carry_out : NULL,
        };
        const struct gm_progress progress =
            gm_ode_of(problem)->loops[isa]->over_kernels[scheme->family->over_kernels](&task);
        assert_int_equal(progress.done, 40);
        if (memcmp(out[isa], out[0], count * sizeof(double)) != 0) {
            fail_msg("%s on %s: %s differs from baseline", scheme->name, problem->name,
                     gm_isa_name((enum gm_isa)isa));
        }
    }
}

static void instruction_sets_agree(void **unused)
{
    (void)unused;
    for_all(1, compare_instruction_sets);
    for_all(21, compare_instruction_sets);
}

static void resume(const struct gm_problem *problem, const struct gm_scheme *scheme,
                   const struct gm_settings *settings)
{
    if (scheme->family->not_resumable) {
        return;
    }
    struct gm_run *run = open_run(problem, scheme, settings, 0.05);
    struct gm_run *other = open_run(problem, scheme, settings, 0.05);
    void *snapshot = malloc(gm_run_snapshot_size(run));
    assert_non_null(snapshot);
    gm_run_advance(run, 33);
    gm_run_save(run, snapshot);
    gm_run_advance(run, 50);
    gm_run_load(other, snapshot);
    assert_int_equal(other->steps, 33);
    gm_run_advance(other, 50);
    expect_same_state(run, other);
    assert_true(run->t == other->t && run->evaluations == other->evaluations);
    free(snapshot);
    gm_run_close(run);
    gm_run_close(other);
}

static void snapshots_resume_bit_for_bit(void **unused)
{
    (void)unused;
    for_all(5, resume);
}

/* A loop whose second step is refused memory by a library, and takes no notice of it. */
static struct gm_progress greedy(const struct gm_task *task)
{
    memcpy(task->out, task->y, task->problem->n * task->problem->m * sizeof *task->y);
    task->out[0] += 1;
    if (task->steps_before == 1) {
        gm_memory_refused();
    }
    return (struct gm_progress){.done = task->steps, .status = GM_OK};
}

static void refused_memory_is_no_step(void **unused)
{
    (void)unused;
    const struct gm_family family = {.kind = &gm_kind_ode, .loop = greedy};
    const struct gm_scheme scheme = {.name = "greedy", .family = &family};
    struct gm_problem problem = gm_problem_oscillator;
    problem.m = 1;
    const double start[2] = {0.5, 0};
    struct gm_run *run = gm_run_open(&problem, &scheme, &settings_of[0], 0, 0.1, start);
    assert_non_null(run);
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    assert_int_equal(gm_run_advance(run, 1), GM_OUT_OF_MEMORY);
    assert_string_equal(gm_status_name(run->status), "out-of-memory");
    assert_int_equal(run->steps, 1);
    assert_true(run->t == 0.1 && gm_run_state(run)[0] == 1.5);
    assert_true(gm_memory_was_short());
    gm_run_close(run);
}

/* GSL as it is where it does not look: after its handler it goes on with the null pointer. */
static bool use_gsl(void *data)
{
    int *error = data;
    gsl_error("failed to allocate space", __FILE__, __LINE__, *error);
    *error = 0; /* it went on */
    return true;
}

static void gsl_is_left_where_it_is_refused_memory(void **unused)
{
    (void)unused;
    const unsigned long before = gm_memory_refusals();
    int error = GSL_ENOMEM;
    assert_false(gm_memory_guard_gsl(use_gsl, &error));
    assert_int_equal(error, GSL_ENOMEM);
    assert_int_equal(gm_memory_refusals(), before + 1);
    error = GSL_EMAXITER;
    assert_true(gm_memory_guard_gsl(use_gsl, &error));
    assert_int_equal(error, 0);
    assert_int_equal(gm_memory_refusals(), before + 1);
}

/* Explicit Euler on the oscillator: |y| = (1 + dt^2)^(n/2) |y_0|, so the step that leaves the bound is
   known. */
static void blow_up_is_found_to_the_step(void **unused)
{
    (void)unused;
    struct gm_problem problem = gm_problem_oscillator;
    problem.m = 3;
    const double start[6] = {0, 0.5, 0, 0.5, 0, 1}; /* the middle member stays at rest */
    const struct gm_scheme *scheme = gm_scheme_find("explicit-euler");
    const double y[6] = {start[0], 0, start[2], 1, 0, start[5]};
    struct gm_run *far = gm_run_open(&problem, scheme, &settings_of[0], 0, 2, y);
    struct gm_run *near = gm_run_open(&problem, scheme, &settings_of[0], 0, 2, y);
    assert_int_equal(gm_run_advance(far, 1000), GM_BLOW_UP);
    while (near->status == GM_OK) {
        gm_run_advance(near, 1);
    }
    assert_int_equal(near->steps, far->steps);
    expect_same_state(near, far);
    assert_true(far->t == 2.0 * (double)far->steps);
    double q = 0, p = 1;
    long steps = 0;
    for (;;) {
        const double next_q = q + 2 * p, next_p = p - 2 * q;
        if (!(fabs(next_q) <= 1e10 && fabs(next_p) <= 1e10)) {
            break;
        }
        q = next_q;
        p = next_p;
        steps++;
    }
    assert_int_equal(far->steps, steps);
    assert_true(gm_run_state(far)[0] == q && gm_run_state(far)[3] == p);
    const long stopped = far->steps;
    assert_int_equal(gm_run_advance(far, 10), GM_BLOW_UP);
    assert_int_equal(far->steps, stopped);
    gm_run_close(far);
    gm_run_close(near);
}

/* Of many members one grows, in the middle or the last, until it leaves the bound; the others are at rest. All
   stop at the last step that it makes, whether steps are made one by one, a few at a time or many at once, and
   explicit Euler's is known, as above. */
static void one_of_many_blows_up(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        double dt;
    } schemes[] = {
        {"explicit-euler", 3}, {"explicit-euler", 0.6}, {"symplectic-euler", 2.02}, {"verlet", 2.02},
        {"rk4", 2.9},          {"midpoint", 3}};
    static const size_t members[] = {16, 67, 1000, 13001};
    enum { VARIANTS = 2 * GM_COUNT(settings_of), CASES = GM_COUNT(schemes) * GM_COUNT(members) * VARIANTS };
    for (size_t k = 0; k < CASES; k++) {
        const char *name = schemes[k / VARIANTS % GM_COUNT(schemes)].name;
        const double dt = schemes[k / VARIANTS % GM_COUNT(schemes)].dt;
        const struct gm_settings *settings = &settings_of[k % VARIANTS / 2];
        const bool grows = strcmp(name, "midpoint") != 0; /* which is bounded whatever the step */
        struct gm_problem problem = gm_problem_oscillator_tangent;
        problem.m = members[k / VARIANTS / GM_COUNT(schemes)];
        const size_t q = k % 2 == 0 ? problem.m * 5 / 9 : problem.m - 1, p = problem.n / 2 * problem.m + q;
        double *start = calloc(problem.n * problem.m, sizeof *start);
        assert_non_null(start);
        start[q] = 1;
        struct gm_run *runs[3];
        for (int i = 0; i < 3; i++) {
            runs[i] = gm_run_open(&problem, gm_scheme_find(name), settings, 0, dt, start);
            while (runs[i]->steps < (grows ? 1000 : 40) && runs[i]->status == GM_OK) {
                gm_run_advance(runs[i], i == 0 ? 1000 : i == 1 ? 8 : 1);
            }
            if (runs[i]->status != (grows ? GM_BLOW_UP : GM_OK)) {
                fail_msg("%s: %s", name, gm_status_name(runs[i]->status));
            }
            if (grows) {
                expect_same_state(runs[i], runs[0]);
                assert_int_equal(runs[i]->steps, runs[0]->steps);
                assert_int_equal(runs[i]->evaluations, runs[0]->evaluations);
                assert_true(runs[i]->t == dt * (double)runs[i]->steps);
            }
        }
        if (strcmp(name, "explicit-euler") == 0 && !settings->compensated) {
            double at[2] = {1, 0};
            long steps = 0;
            for (;; steps++) {
                const double next[2] = {at[0] + dt * at[1], at[1] - dt * at[0]};
                if (!(fabs(next[0]) <= 1e10 && fabs(next[1]) <= 1e10)) {
                    break;
                }
                memcpy(at, next, sizeof at);
            }
            assert_int_equal(runs[2]->steps, steps);
            assert_true(gm_run_state(runs[2])[q] == at[0] && gm_run_state(runs[2])[p] == at[1]);
        }
        for (int i = 0; i < 3; i++) {
            gm_run_close(runs[i]);
        }
        free(start);
    }
}

/* Who looks back at an ensemble finds where each step began, and can make it again. */
static void ensembles_are_looked_back_at(void **unused)
{
    (void)unused;
    enum { MEMBERS = 68, STEPS = 5 };
    struct gm_problem problem = gm_problem_oscillator_tangent;
    problem.m = MEMBERS;
    const size_t count = problem.n * MEMBERS;
    double *before = aligned_alloc(128, 4 * count * sizeof *before), *part = before + 2 * count;
    assert_non_null(before);
    for (size_t i = 0; i < count; i++) {
        before[i] = sin(1.0 + (double)i);
    }
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("verlet"), &settings_of[0], 0, 0.05, before);
    run->looks_back = true;
    for (int i = 0; i < STEPS; i++) {
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        assert_true(gm_run_repeats(run));
        assert_memory_equal(gm_run_before(run), before, count * sizeof *before);
        assert_true(gm_run_part(run, gm_run_before(run), run->t - run->dt, 1, part));
        assert_memory_equal(gm_run_state(run), part, count * sizeof *part);
        memcpy(before, part, count * sizeof *before);
    }
    gm_run_advance(run, 2);
    assert_false(gm_run_repeats(run));
    struct gm_run *next = gm_run_switch(run, gm_scheme_find("rk4"));
    assert_non_null(next);
    for (int i = 0; i < 2; i++) {
        gm_run_advance(next, 1);
        assert_true(gm_run_repeats(next));
    }
    gm_run_close(next);
    gm_run_close(run);
    free(before);
}

/* The head of a snapshot comes from a file: what does not exist is refused. */
static void damaged_heads_are_refused(void **unused)
{
    (void)unused;
    const double start[] = {1, 0};
    struct gm_run *run =
        gm_run_open(&gm_problem_pendulum, gm_scheme_find("midpoint"), &settings_of[1], 0, 0.1, start);
    assert_non_null(run);
    struct gm_run *snapshot = malloc(gm_run_snapshot_size(run));
    assert_non_null(snapshot);
    gm_run_save(run, snapshot);
    assert_true(gm_run_load(run, snapshot));
    snapshot->unsolved.obstacle = (enum gm_obstacle)(GM_STAYS_OFF + 1);
    assert_false(gm_run_load(run, snapshot));
    free(snapshot);
    gm_run_close(run);
}

/* Single steps that fail are made again from where the run began anew, not from before: after another step, another
   state and a snapshot. Of two runs one looks back, so none of its steps is made in place. */
static void beginnings_are_not_passed(void **unused)
{
    (void)unused;
    enum { MEMBERS = 67, COUNT = MOST * MEMBERS };
    struct gm_problem problem = gm_problem_oscillator_tangent;
    problem.m = MEMBERS;
    double start[COUNT], other[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        start[i] = sin(1.0 + (double)i);
        other[i] = cos(1.0 + (double)i);
    }
    for (int what = 0; what < 3; what++) {
        struct gm_run *runs[2];
        for (int i = 0; i < 2; i++) {
            struct gm_run *run = runs[i] =
                gm_run_open(&problem, gm_scheme_find("explicit-euler"), &settings_of[1], 0, 3, start);
            run->looks_back = i == 0;
            void *snapshot = malloc(gm_run_snapshot_size(run));
            assert_non_null(snapshot);
            for (int k = 0; k < 8; k++) {
                if (k == 5) {
                    gm_run_save(run, snapshot);
                    gm_run_set_state(run, other, NULL); /* to where the snapshot does not lead */
                }
                gm_run_advance(run, 1);
            }
            if (what == 0) {
                gm_run_set_step(run, 2.5);
            } else if (what == 1) {
                gm_run_set_state(run, start, NULL);
            } else {
                assert_true(gm_run_load(run, snapshot));
            }
            free(snapshot);
            while (run->status == GM_OK && run->steps < 60) {
                gm_run_advance(run, 1);
            }
            assert_int_equal(run->status, GM_BLOW_UP);
            expect_same_state(run, runs[0]);
            assert_int_equal(run->steps, runs[0]->steps);
            assert_int_equal(run->evaluations, runs[0]->evaluations);
        }
        gm_run_close(runs[0]);
        gm_run_close(runs[1]);
    }
}

/* What fails in the middle of single steps is found as that of many at once: the equations of one member have no
   root. */
static void one_of_many_is_not_solved(void **unused)
{
    (void)unused;
    enum { MEMBERS = 67 };
    struct gm_problem problem = gm_problem_henon_heiles; /* by kernels, so in place */
    problem.m = MEMBERS;
    double start[4 * MEMBERS];
    for (size_t i = 0; i < GM_COUNT(start); i++) {
        start[i] = 0.1 * sin((double)i);
    }
    start[MEMBERS + 37] = 0.7; /* it escapes */
    start[3 * MEMBERS + 37] = 0.3;
    struct gm_run *runs[2];
    for (int i = 0; i < 2; i++) {
        runs[i] = gm_run_open(&problem, gm_scheme_find("midpoint"), &settings_of[0], 0, 0.4, start);
        while (runs[i]->status == GM_OK && runs[i]->steps < 1000) {
            gm_run_advance(runs[i], i == 0 ? 1000 : 1);
        }
        assert_int_equal(runs[i]->status, GM_NO_CONVERGENCE);
        assert_true(runs[i]->steps > 2);
        expect_same_state(runs[i], runs[0]);
        assert_int_equal(runs[i]->steps, runs[0]->steps);
        assert_int_equal(runs[i]->iterations, runs[0]->iterations);
        assert_int_equal(runs[i]->evaluations, runs[0]->evaluations);
        assert_int_equal(runs[i]->unsolved.obstacle, runs[0]->unsolved.obstacle);
    }
    gm_run_close(runs[0]);
    gm_run_close(runs[1]);
}

/* Single steps go through an ensemble in an order of their own, and end with members that were made before: from
   the first to the last each makes the step once. */
static void single_steps_are_many_at_once(void **unused)
{
    (void)unused;
    static const char *const names[] = {"explicit-euler", "symplectic-euler", "verlet", "rk4"};
    static const size_t members[] = {16, 33, 47, 6200, 13001};
    enum { STEPS = 140 };
    for (size_t k = 0; k < GM_COUNT(names) * GM_COUNT(members) * GM_COUNT(settings_of); k++) {
        const char *name = names[k % GM_COUNT(names)];
        struct gm_problem problem = gm_problem_oscillator_tangent;
        problem.m = members[k / GM_COUNT(names) % GM_COUNT(members)];
        const struct gm_settings *settings = &settings_of[k / GM_COUNT(names) / GM_COUNT(members)];
        const size_t count = problem.n * problem.m;
        double *start = calloc(count, sizeof *start);
        assert_non_null(start);
        for (size_t i = 0; i < count; i++) {
            start[i] = sin(1.0 + (double)i);
        }
        struct gm_run *runs[2];
        for (int i = 0; i < 2; i++) {
            runs[i] = gm_run_open(&problem, gm_scheme_find(name), settings, 0, 0.05, start);
            while (runs[i]->steps < STEPS) {
                assert_int_equal(gm_run_advance(runs[i], i == 0 ? STEPS : 1), GM_OK);
            }
        }
        expect_same_state(runs[1], runs[0]);
        assert_true(runs[1]->evaluations == runs[0]->evaluations);
        gm_run_close(runs[0]);
        gm_run_close(runs[1]);
        free(start);
    }
}

/* Implicit Euler with so large a step that p' = -q (1 + p^2), q' = p (1 + q^2) leaves Newton without a
   root. */
static void failed_solves_are_told(void **unused)
{
    (void)unused;
    const struct gm_problem problem = gm_problem_product;
    const double start[2] = {3, 3};
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("midpoint"), &settings_of[0], 0, 10, start);
    assert_int_equal(gm_run_advance(run, 1000), GM_NO_CONVERGENCE);
    assert_true(isfinite(gm_run_state(run)[0]) && isfinite(gm_run_state(run)[1]));
    assert_true(run->t == 10.0 * (double)run->steps);
    gm_run_close(run);
}

/* Where fixed-point iteration cannot contract, Newton takes over: the midpoint rule at dt = 50 is the
   rational map with cos = (1 - dt^2/4)/(1 + dt^2/4), and keeps q^2 + p^2. */
static void newton_takes_over_at_large_steps(void **unused)
{
    (void)unused;
    const struct gm_problem problem = gm_problem_oscillator;
    const double start[2] = {0, 1}, dt = 50;
    struct gm_run *run = gm_run_open(&problem, gm_scheme_find("midpoint"), &settings_of[0], 0, dt, start);
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    assert_true(run->solves > 0);
    const double cosine = (1 - dt * dt / 4) / (1 + dt * dt / 4);
    assert_true(fabs(gm_run_state(run)[1] - cosine) < 1e-13);
    assert_int_equal(gm_run_advance(run, 999), GM_OK);
    const double *y = gm_run_state(run);
    assert_true(fabs(y[0] * y[0] + y[1] * y[1] - 1) < 1e-11);
    gm_run_close(run);
}

static void newton_agrees_with_fixed_point(void **unused)
{
    (void)unused;
    const char *const names[] = {"implicit-euler", "midpoint", "trapezoidal", "gauss4", "rk4sym"};
    for (int p = 0; p < PROBLEMS; p++) {
        for (size_t i = 0; i < GM_COUNT(names); i++) {
            struct gm_problem problem = problem_at(p), hard = problem;
            if (gm_ode_of(&problem)->stiff || !is_tested(gm_scheme_find(names[i]), &problem)) {
                continue;
            }
            struct gm_ode stiff = *gm_ode_of(&problem);
            stiff.stiff = true;
            hard.facets = &stiff;
            struct gm_run *easy_run = open_run(&problem, gm_scheme_find(names[i]), &settings_of[0], 0.2);
            struct gm_run *hard_run = open_run(&hard, gm_scheme_find(names[i]), &settings_of[0], 0.2);
            assert_int_equal(gm_run_advance(easy_run, 20), GM_OK);
            assert_int_equal(gm_run_advance(hard_run, 20), GM_OK);
            assert_true(easy_run->solves == 0 && hard_run->solves >= 20);
            for (size_t c = 0; c < problem.n; c++) {
                assert_true(fabs(gm_run_state(easy_run)[c] - gm_run_state(hard_run)[c]) < 1e-13);
            }
            gm_run_close(easy_run);
            gm_run_close(hard_run);
        }
    }
}

static void evaluations_are_counted(void **unused)
{
    (void)unused;
    const struct {
        const char *scheme;
        double evaluations;
    } expected[] = {
        {"explicit-euler", 100}, {"rk2", 200}, {"rk4", 400}, {"symplectic-euler", 100}, {"verlet", 101}};
    for (size_t i = 0; i < GM_COUNT(expected); i++) {
        struct gm_problem problem = gm_problem_pendulum;
        problem.m = 21;
        struct gm_run *run = open_run(&problem, gm_scheme_find(expected[i].scheme), &settings_of[0], 0.05);
        for (int k = 0; k < 100; k++) {
            gm_run_advance(run, 1);
        }
        assert_true(gm_run_per_member(run, run->evaluations) == expected[i].evaluations);
        gm_run_close(run);
    }
}

static void segments_continue_time(void **unused)
{
    (void)unused;
    const struct gm_problem problem = gm_problem_pendulum;
    struct gm_run *run = open_run(&problem, gm_scheme_find("verlet"), &settings_of[0], 0.1);
    double start[2] = {gm_run_state(run)[0], gm_run_state(run)[1]};
    gm_run_advance(run, 10);
    struct gm_run *next = gm_run_switch(run, gm_scheme_find("gauss4"));
    assert_non_null(next);
    expect_same_state(run, next);
    assert_true(next->t == run->t && next->steps == 10);
    gm_run_close(next);
    /* back again with the same scheme and -dt: Verlet is symmetric */
    gm_run_set_step(run, -0.1);
    gm_run_advance(run, 10);
    assert_int_equal(run->steps, 20);
    assert_true(fabs(run->t) < 1e-15);
    assert_true(fabs(gm_run_state(run)[0] - start[0]) < 1e-14 &&
                fabs(gm_run_state(run)[1] - start[1]) < 1e-14);
    gm_run_close(run);
}

/* A time is the whole number of steps that is nearest to it; a scheme that chooses its steps goes on to the
   first that is not before it, or misses it by round-off alone. */
static void runs_end_where_they_are_to(void **unused)
{
    (void)unused;
    const struct gm_problem pendulum = gm_problem_pendulum, kepler = problem_at(5);
    struct gm_run *run = open_run(&pendulum, gm_scheme_find("verlet"), &settings_of[0], 0.1);
    assert_int_equal(gm_run_steps_at(run, 1.04), 10);
    assert_int_equal(gm_run_until(run, 1.04), GM_OK);
    assert_int_equal(run->steps, 10);
    /* a picture of a time shows the last step that is not after it */
    assert_true(gm_run_steps_by(run, 1.19) == 11 && gm_run_steps_by(run, 1.2) == 12 &&
                gm_run_steps_by(run, 0.5) == 5);
    assert_int_equal(gm_run_until(run, 0.5), GM_OK);
    assert_int_equal(run->steps, 10); /* behind it: nothing */
    gm_run_set_step(run, -0.05);
    assert_int_equal(gm_run_steps_at(run, 0), 30);
    gm_run_to(run, 25, NAN);
    assert_int_equal(run->steps, 25);
    assert_true(!gm_run_goes_on(run, 25, NAN) && gm_run_goes_on(run, 26, NAN));
    run->status = GM_BLOW_UP;
    assert_false(gm_run_goes_on(run, 26, NAN));
    gm_run_close(run);

    struct gm_run *chooses = open_run(&kepler, gm_scheme_find("logh2"), &settings_of[0], 0.1);
    struct gm_run *counts = open_run(&kepler, gm_scheme_find("logh2"), &settings_of[0], 0.1);
    assert_int_equal(gm_run_until(chooses, 1), GM_OK);
    assert_true(chooses->t >= 1 && chooses->steps > 1);
    assert_true(gm_run_steps_by(chooses, chooses->t) == chooses->steps &&
                gm_run_steps_by(chooses, 2) == chooses->steps + 1);
    gm_run_to(counts, chooses->steps - 1, 1);
    assert_true(counts->t < 1);
    assert_true(gm_run_goes_on(counts, LONG_MAX, 1) && gm_run_goes_on(chooses, LONG_MAX, 1.1));
    assert_false(gm_run_goes_on(chooses, LONG_MAX, chooses->t * (1 + 1e-15)));
    gm_run_close(chooses);
    gm_run_close(counts);
}

/* A function along a step that is 0 at a place, and how often it was asked for. */
struct along {
    double (*function)(double distance);
    double place;
    int asked;
};

static double value_along(void *data, double s)
{
    struct along *along = data;
    along->asked++;
    return along->function(s - along->place);
}

static double curved(double x)
{
    return sin(0.1 * x) * (1 + 0.03 * x) + 0.002 * x * x;
}

static double rounded(double x)
{
    return 1e3 + 0.1 * x - 1e3;
}

static double flat(double x)
{
    return x * x * x;
}

static double resting(double x)
{
    return fabs(x) < 1e-9 ? 0 : x;
}

static double jumping(double x)
{
    return x < 0 ? -1 : 2;
}

/* A step is made for each value, so a section costs as much as values are asked for. */
static void zeros_need_few_values(void **unused)
{
    (void)unused;
    const struct {
        double (*function)(double distance);
        int most;
        double accuracy; /* of the place, as far as round-off lets it be seen */
    } rows[] = {{curved, 7, 5e-16},
                {rounded, 40, 3e-12},
                {flat, 80, 5e-16},
                {resting, 45, 1.1e-9},
                {jumping, 60, 5e-16}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        for (int k = 1; k < 100; k++) {
            struct along along = {rows[i].function, k / 100.0 + 1e-3 / k, 0};
            const double s = gm_zero_beyond(value_along, &along, 0, along.function(-along.place),
                                            along.function(1 - along.place));
            assert_true(along.asked <= rows[i].most);
            assert_true(fabs(s - along.place) < rows[i].accuracy);
            assert_true(along.function(s - along.place) >= 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zeros_need_few_values),
        cmocka_unit_test(pieces_do_not_matter),
        cmocka_unit_test(members_do_not_feel_each_other),
        cmocka_unit_test(instruction_sets_agree),
        cmocka_unit_test(snapshots_resume_bit_for_bit),
        cmocka_unit_test(refused_memory_is_no_step),
        cmocka_unit_test(blow_up_is_found_to_the_step),
        cmocka_unit_test(one_of_many_blows_up),
        cmocka_unit_test(ensembles_are_looked_back_at),
        cmocka_unit_test(beginnings_are_not_passed),
        cmocka_unit_test(one_of_many_is_not_solved),
        cmocka_unit_test(single_steps_are_many_at_once),
        cmocka_unit_test(runs_end_where_they_are_to),
        cmocka_unit_test(failed_solves_are_told),
        cmocka_unit_test(newton_takes_over_at_large_steps),
        cmocka_unit_test(newton_agrees_with_fixed_point),
        cmocka_unit_test(evaluations_are_counted),
        cmocka_unit_test(segments_continue_time),
        cmocka_unit_test(damaged_heads_are_refused),
        cmocka_unit_test(gsl_is_left_where_it_is_refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
