/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both engines side by side: the same bits of every state and of every count, by all schemes that have a loop
   over kernels, alone and in ensembles, on the systems that the program brings and on random formulas; and
   what becomes of a cache, a compiler and an entry that are not as they should be. Usage: unit_native KERNELS
   SYSTEMS [all] [baseline|avx2] [COMPILER]; with a compiler of that name as the system's, or as if the processor had
   no other instructions than those, the engines alone are compared. */
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/native/cache.h"
#include "app/native/engine.h"
#include "app/words/request.h"
#include "core/basics.h"
#include "core/kind.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/user/problem.h"
#include "core/schemes.h"
#include "tests/common/folder.h"
#include "tests/common/random_formula.h"

enum { MEMBERS = 13, STEPS = 37 };

static const char *kernels, *systems, *compiler;
static bool all;
static enum gm_isa most = GM_ISA_COUNT;
static char heard[GM_MESSAGE], folder[4096];

static void hear(const char *sentence)
{
    snprintf(heard, sizeof heard, "%s", sentence);
}

/* The linker puts it in the place of the program's. */
enum gm_isa __real_gm_isa_best(void);
enum gm_isa __wrap_gm_isa_best(void);
enum gm_isa __wrap_gm_isa_best(void)
{
    const enum gm_isa best = __real_gm_isa_best();
    return most < best ? most : best;
}

/* A compiler that is a script. */
static void with_compiler(const char *script)
{
    char path[4200];
    snprintf(path, sizeof path, "%s/bin", folder);
    mkdir(path, 0700);
    setenv("PATH", path, 1);
    strcat(path, "/cc");
    folder_script(path, script);
}

/* A cache of its own for each test, with the search path as it was. */
static bool never(void)
{
    return false;
}

static int begin(void **state)
{
    (void)state;
    static char path[8192];
    if (!path[0]) {
        snprintf(path, sizeof path, "%s", getenv("PATH"));
    }
    folder_make(folder, sizeof folder);
    setenv("XDG_CACHE_HOME", folder, 1);
    setenv("PATH", path, 1);
    setenv("GEOMINT_COMPILER_SECONDS", "200", 1); /* the machine may have much else to do */
    if (compiler) {
        char script[sizeof path + 100];
        snprintf(script, sizeof script, "#!/bin/sh\nPATH='%s'; exec %.20s \"$@\"\n", path, compiler);
        with_compiler(script);
    }
    heard[0] = '\0';
    gm_engine_choose(GM_ENGINE_NATIVE, kernels, hear, never);
    return 0;
}

static int end(void **state)
{
    (void)state;
    folder_remove(folder);
    return 0;
}

/* A lane of "SCENE|key=value|..." by a scheme, opened with that engine; NULL with a message. */
static struct gm_lane *try_lane(const char *words, const char *scheme, enum gm_engine engine, char *message)
{
    char text[8192], *list[16], *rest = text;
    int count = 0;
    snprintf(text, sizeof text, "%s|scheme=%s", words, scheme);
    for (char *word; count < 16 && (word = strsep(&rest, "|"));) {
        list[count++] = word;
    }
    struct gm_request request;
    gm_engine_choose(engine, kernels, hear, never);
    struct gm_lane *lane = NULL;
    if (gm_request_parse(&request, count, list, 1, message)) {
        lane = gm_request_open_lane(&request, 0, message);
    }
    gm_request_close(&request);
    return lane;
}

static struct gm_lane *lane_of(const char *words, const char *scheme, enum gm_engine engine)
{
    char message[GM_MESSAGE];
    struct gm_lane *lane = try_lane(words, scheme, engine, message);
    if (!lane) {
        fail_msg("%s: %s", words, message);
    }
    return lane;
}

static bool same(double a, double b)
{
    return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0;
}

/* The iterations of a step that failed are not compared: loops over kernels make its other parts, too. */
static void compare_runs(const struct gm_run *one, const struct gm_run *other, const char *what)
{
    const double *a = gm_run_state(one), *b = gm_run_state(other);
    for (size_t i = 0; i < one->problem->n * one->problem->m; i++) {
        if (!same(a[i], b[i])) {
            fail_msg("%s, %s: number %zu is %.17g and %.17g", one->problem->name, what, i, a[i], b[i]);
        }
    }
    if (one->status != other->status || one->steps != other->steps || one->iterations != other->iterations ||
        one->evaluations != other->evaluations || one->solves != other->solves) {
        fail_msg("%s, %s: %s after %ld steps, %lu evaluations, %lu iterations; and %s after %ld, %lu, %lu",
                 one->problem->name, what, gm_status_name(one->status), one->steps, one->evaluations,
                 one->iterations, gm_status_name(other->status), other->steps, other->evaluations,
                 other->iterations);
    }
}

/* Every scheme of a family on two problems that are one but for the engine. */
static int compare_family(const struct gm_problem *native, const struct gm_problem *interpreted, int family,
                          const double *start, double dt)
{
    int compared = 0;
    for (size_t k = 0; k < 2 * gm_scheme_count(); k++) {
        const struct gm_scheme *scheme = gm_scheme_at(k / 2);
        const struct gm_settings settings = {.compensated = k % 2 == 1};
        if (scheme->family->over_kernels != family || !gm_scheme_fits(scheme, interpreted)) {
            continue;
        }
        assert_ptr_not_equal(gm_scheme_loop(scheme, native), gm_scheme_loop(scheme, interpreted));
        struct gm_run *one = gm_run_open(native, scheme, &settings, 0, dt, start);
        struct gm_run *other = gm_run_open(interpreted, scheme, &settings, 0, dt, start);
        assert_non_null(one);
        assert_non_null(other);
        for (int part = 0; part < 2; part++) {
            gm_run_advance(one, STEPS);
            gm_run_advance(other, STEPS);
            compare_runs(one, other, scheme->name);
        }
        gm_run_close(one);
        gm_run_close(other);
        compared++;
    }
    return compared;
}

/* One family of schemes on a system, for so many members: also where steps are so large that they fail. */
static int compare_members(const char *system, const char *scheme, int members)
{
    char words[200];
    int compared = 0;
    snprintf(words, sizeof words, members > 1 ? "%s|members=%d" : "%s", system, members);
    char message[GM_MESSAGE];
    struct gm_lane *native = try_lane(words, scheme, GM_ENGINE_NATIVE, message);
    if (!native && strstr(message, "has no parameter \"members\"")) {
        return 0; /* a hook or another key places them */
    }
    assert_non_null(native);
    struct gm_lane *interpreted = lane_of(words, scheme, GM_ENGINE_INTERPRETED);
    if (strcmp(gm_engine_of(native), "native") != 0) {
        fail_msg("%s by %s: %s", words, scheme, heard);
    }
    assert_string_equal(gm_engine_of(interpreted), "interpreted");
    for (int large = 0; large < 2; large++) {
        const double dt = native->run->dt * (large ? 400 : 1);
        const int schemes = compare_family(&native->problem, &interpreted->problem,
                                           native->scheme->family->over_kernels, native->start, dt);
        assert_true(schemes > 0);
        compared += schemes;
    }
    gm_lane_close(native);
    gm_lane_close(interpreted);
    return compared;
}

static int compare_system(const char *system, const char *scheme)
{
    return compare_members(system, scheme, 1) + compare_members(system, scheme, MEMBERS);
}

static void engines_agree(void **state)
{
    (void)state;
    compare_system("figure-eight", "verlet");
    compare_system("lorenz", "rk4");
    compare_system("driven-pendulum", "gauss4");
}

/* Every family with a loop over kernels that fits; 0 where a system has none or, told why, no native loops. */
static int compare_families(const char *system)
{
    const char *lacks = NULL;
    char message[GM_MESSAGE], first[GM_OVER_COUNT][80] = {""};
    gm_engine_choose(GM_ENGINE_INTERPRETED, kernels, hear, never);
    struct gm_request request;
    struct gm_lane *lane = NULL;
    if (gm_request_parse(&request, 1, (char *[]){(char *)system}, 1, message)) {
        lane = gm_request_open_lane(&request, 0, message);
    }
    gm_request_close(&request);
    if (!lane) {
        fail_msg("%s: %s", system, message);
    }
    if (!gm_engine_of(lane)) {
        lacks = "no ordinary differential equation";
    }
    for (int over = GM_OVER_NONE + 1; gm_engine_of(lane) && over < GM_OVER_COUNT; over++) {
        char *text = gm_user_problem_kernel(&lane->problem, over, &lacks);
        const bool has_loop = text && (over != GM_OVER_SPLITTING || strstr(text, "GM_SEPARABLE"));
        free(text);
        for (size_t k = 0; has_loop && !first[over][0] && k < gm_scheme_count(); k++) {
            const struct gm_scheme *scheme = gm_scheme_at(k);
            if (scheme->family->over_kernels == over && gm_scheme_fits(scheme, &lane->problem)) {
                snprintf(first[over], sizeof first[0], "%s", scheme->name);
            }
        }
    }
    gm_lane_close(lane);
    int compared = 0;
    for (int family = 0; family < GM_OVER_COUNT; family++) {
        compared += first[family][0] ? compare_system(system, first[family]) : 0;
    }
    print_message("%s: %d pairs of runs%s%s\n", system, compared, lacks ? ": " : "", lacks ? lacks : "");
    return compared;
}

static void engines_agree_on_all(void **state)
{
    (void)state;
    int compared = 0, native = 0;
    DIR *files = all ? opendir(systems) : NULL;
    assert_true(files || !all);
    for (const struct dirent *file; files && (file = readdir(files));) {
        char name[256];
        snprintf(name, sizeof name, "%s", file->d_name);
        char *end_of_name = strstr(name, ".system");
        if (end_of_name) {
            *end_of_name = '\0';
            const int count = compare_families(name);
            compared += count;
            native += count > 0;
        }
    }
    if (files) {
        closedir(files);
        print_message("%d pairs of runs on %d systems\n", compared, native);
        assert_true(native >= 15);
    }
}

/* A parameter is no part of what is compiled: the next lane takes the same loops. */
static void parameters_need_no_compiler(void **state)
{
    (void)state;
    struct gm_lane *one = lane_of("lotka-volterra", "rk4", GM_ENGINE_NATIVE);
    assert_string_equal(gm_engine_of(one), "native");
    setenv("PATH", "/nowhere", 1);
    struct gm_lane *other = lane_of("lotka-volterra|a=3|b=0.5", "rk2", GM_ENGINE_NATIVE);
    struct gm_lane *wanted = lane_of("lotka-volterra|a=3|b=0.5", "rk2", GM_ENGINE_INTERPRETED);
    assert_string_equal(gm_engine_of(other), "native");
    gm_run_advance(other->run, STEPS);
    gm_run_advance(wanted->run, STEPS);
    compare_runs(other->run, wanted->run, "other parameters");
    gm_lane_close(one);
    gm_lane_close(other);
    gm_lane_close(wanted);
}

/* How many entries there were of a cache from which all can be removed. */
static size_t cleared(const char *cache)
{
    size_t count = 0;
    char sentence[GM_MESSAGE];
    assert_true(gm_cache_clear(cache, &count, sentence));
    return count;
}

/* A system that no other test has: what was refused once is not tried again. */
static const char *fresh(void)
{
    static char words[160];
    static int number;
    snprintf(words, sizeof words, "system|rate=x = y*%d|rate=y = -x*sin(x", number % 10 + 2);
    for (int i = 0; i < number; i++) {
        strcat(words, "+y");
    }
    strcat(words, ")|x=1|y=0");
    number++;
    return words;
}

/* Chosen by itself: what will take longer than compiling does is compiled beside, and taken between two
   steps; what will not is left to the interpreter. No clock is asked: how long steps take is told. */
static void auto_takes_over(void **state)
{
    (void)state;
    char cache[4200], words[160];
    snprintf(cache, sizeof cache, "%s/geomint", folder);
    snprintf(words, sizeof words, "%s", fresh());
    struct gm_lane *wanted = lane_of(words, "rk4", GM_ENGINE_INTERPRETED);
    struct gm_lane *lane = lane_of(words, "rk4", GM_ENGINE_AUTO);
    gm_engine_look(lane, 0, 4);
    assert_string_equal(gm_engine_of(lane), "interpreted");
    assert_int_not_equal(access(cache, F_OK), 0);
    for (int look = 0; look < 100000 && strcmp(gm_engine_of(lane), "native") != 0; look++) {
        gm_engine_look(lane, 0, 6);
        if (look < 20) {
            gm_run_advance(lane->run, 1);
        }
        usleep(2000);
    }
    assert_string_equal(gm_engine_of(lane), "native");
    gm_run_advance(lane->run, STEPS);
    gm_run_advance(wanted->run, lane->run->steps);
    compare_runs(lane->run, wanted->run, "chosen by itself");
    gm_lane_close(lane);
    gm_lane_close(wanted);
    /* and where it is not to be chosen it is not */
    lane = lane_of(fresh(), "rk4", GM_ENGINE_INTERPRETED);
    gm_engine_look(lane, 0, 1000);
    assert_string_equal(gm_engine_of(lane), "interpreted");
    gm_lane_close(lane);
}

/* Random rates: fields and Jacobians of many states, and steps of those members that stay finite. */
static void random_formulas_agree(void **state)
{
    (void)state;
    enum { RATES = 4, TRIALS = 3, POINTS = 400 };
    static const double special[] = {0, -0.0, 1, -1, INFINITY, -INFINITY, NAN, M_PI_2, 1e-310, 1e308};
    srand(5);
    for (int trial = 0; trial < (all ? 12 : TRIALS); trial++) {
        char *words = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&words, &size);
        assert_non_null(out);
        fprintf(out, "system");
        for (int i = 0; i < RATES; i++) {
            fprintf(out, "|rate=%c = ", "xyzw"[i]);
            for (int part = 0; part < 6; part++) {
                fprintf(out, "%s(", part ? " + 0.01*" : "");
                gm_random_formula(out, "xyzw", 4);
                fprintf(out, ")");
            }
        }
        fprintf(out, "|x=1|y=0.5|z=0.25|w=2|members=%d", MEMBERS);
        fclose(out);
        char message[GM_MESSAGE];
        struct gm_lane *other = try_lane(words, "explicit-euler", GM_ENGINE_INTERPRETED, message);
        if (!other) { /* not finite at the start */
            assert_non_null(strstr(message, "finite"));
            trial--;
            free(words);
            continue;
        }
        struct gm_lane *native = lane_of(words, "explicit-euler", GM_ENGINE_NATIVE);
        if (strcmp(gm_engine_of(native), "native") != 0) {
            fail_msg("%s: %s", words, heard);
        }
        double many[RATES * POINTS];
        size_t kept = 0;
        for (int point = 0; point < POINTS; point++) {
            double y[RATES], f[2][RATES], jacobian[2][RATES * RATES];
            bool finite = true;
            for (int i = 0; i < RATES; i++) {
                y[i] = point % 5 == 0 ? special[rand() % 10] : 4. * rand() / RAND_MAX - 2;
            }
            gm_field(&native->problem, y, f[0], 1);
            gm_field(&other->problem, y, f[1], 1);
            gm_ode_of(&native->problem)->loops[0]->jacobian(&native->problem, y, jacobian[0]);
            gm_ode_of(&other->problem)->loops[0]->jacobian(&other->problem, y, jacobian[1]);
            for (int i = 0; i < RATES * RATES; i++) {
                if (!same(jacobian[0][i], jacobian[1][i]) || (i < RATES && !same(f[0][i], f[1][i]))) {
                    fail_msg("%s at %.17g %.17g %.17g %.17g", words, y[0], y[1], y[2], y[3]);
                }
            }
            for (int i = 0; i < RATES; i++) {
                finite = finite && fabs(y[i]) < 1e3 && fabs(f[0][i]) < 1e6;
            }
            for (int i = 0; finite && i < RATES; i++) {
                many[(size_t)i * POINTS + kept] = y[i];
            }
            kept += finite;
        }
        /* registers of several: one step of all that are finite */
        if (kept > 0) {
            double start[RATES * POINTS];
            struct gm_problem ensemble = native->problem, theirs = other->problem;
            ensemble.m = theirs.m = kept;
            for (size_t i = 0; i < RATES * kept; i++) {
                start[i] = many[i / kept * POINTS + i % kept];
            }
            const struct gm_settings settings = {0};
            struct gm_run *one = gm_run_open(&ensemble, native->scheme, &settings, 0, 1e-3, start);
            struct gm_run *two = gm_run_open(&theirs, native->scheme, &settings, 0, 1e-3, start);
            assert_non_null(one);
            assert_non_null(two);
            assert_int_equal(gm_run_advance(one, 1), GM_OK);
            gm_run_advance(two, 1);
            compare_runs(one, two, words);
            gm_run_close(one);
            gm_run_close(two);
        }
        gm_lane_close(native);
        gm_lane_close(other);
        free(words);
    }
}

/* ---- what is not as it should be ---- */

/* The interpreter goes on, and why is said. */
static void refused(const char *why)
{
    const char *words = fresh();
    struct gm_lane *lane = lane_of(words, "rk4", GM_ENGINE_NATIVE);
    struct gm_lane *wanted = lane_of(words, "rk4", GM_ENGINE_INTERPRETED);
    assert_string_equal(gm_engine_of(lane), "interpreted");
    if (!strstr(heard, why)) {
        fail_msg("\"%s\" says nothing of \"%s\"", heard, why);
    }
    gm_run_advance(lane->run, STEPS);
    gm_run_advance(wanted->run, STEPS);
    compare_runs(lane->run, wanted->run, why);
    /* said once */
    heard[0] = '\0';
    struct gm_lane *again = lane_of(words, "rk4", GM_ENGINE_NATIVE);
    assert_string_equal(heard, "");
    gm_lane_close(again);
    gm_lane_close(lane);
    gm_lane_close(wanted);
}

/* Whether a process of its own, which has loaded nothing yet, steps that as the interpreter does: natively or,
   where a word is given, interpreted with a sentence that holds it. */
static bool is_stepped_elsewhere(const char *words, const char *says)
{
    int how = 0;
    const pid_t process = fork();
    if (process == 0) {
        char message[GM_MESSAGE];
        struct gm_lane *lane = try_lane(words, "rk4", GM_ENGINE_NATIVE, message);
        struct gm_lane *wanted = try_lane(words, "rk4", GM_ENGINE_INTERPRETED, message);
        bool good = lane && wanted && strcmp(gm_engine_of(lane), says ? "interpreted" : "native") == 0 &&
                    (!says || strstr(heard, says));
        if (good) {
            gm_run_advance(lane->run, STEPS);
            gm_run_advance(wanted->run, STEPS);
            good = memcmp(gm_run_state(lane->run), gm_run_state(wanted->run),
                          lane->problem.n * sizeof(double)) == 0;
        }
        if (!good) {
            print_error("%s: %s\n", words, heard);
        }
        _exit(!good);
    }
    return process > 0 && waitpid(process, &how, 0) == process && how == 0;
}

static void compilers_fail(void **state)
{
    (void)state;
    setenv("PATH", "/nowhere::relative", 1);
    refused("there is no C compiler");
    with_compiler("#!/bin/sh\necho 'no licence\033[31m' >&2\nexit 1\n");
    refused("the compiler failed: no licence");
    /* it looks for its own programs in folders that have one meaning */
    char path[8300];
    with_compiler("#!/bin/sh\necho \"[$PATH]\" >&2\nexit 1\n");
    snprintf(path, sizeof path, "relative:%s:.", getenv("PATH"));
    setenv("PATH", path, 1);
    snprintf(path, sizeof path, "[%s/bin]", folder);
    refused(path);
    with_compiler("#!/bin/sh\nexit 0\n");
    refused("the compiler wrote nothing");
    with_compiler("#!/bin/sh\nwhile [ \"$1\" != -o ]; do shift; done\necho nonsense >\"$2\"\n");
    refused("could not be loaded");
    with_compiler("#!/bin/sh\nkill -SEGV $$\n");
    refused("the compiler failed");
    with_compiler("#!/bin/sh\nwhile [ \"$1\" != -o ]; do shift; done\n"
                  "PATH=/usr/bin:/bin; echo 'int nothing;' | /usr/bin/cc -shared -fPIC -o \"$2\" -x c -\n");
    refused("it holds no loops");
    /* loops whose numbers are others */
    with_compiler("#!/bin/sh\nPATH=/usr/bin:/bin; sed -i 's/K(sin)/K(cos)/' *.h; exec cc \"$@\"\n");
    refused("bit by bit");
}

/* What is in the cache under the right key, whole, but lacks a symbol or is no library: it is refused, goes, and the
   next start makes it anew. Each start is a process of its own, as one remembers what it has loaded. */
static void entries_are_libraries(void **state)
{
    (void)state;
    static const struct {
        const char *source, *into, *says;
    } lacking[] = {
        {"int nothing;", "cc -shared -fPIC -x c - -o", "it holds no loops"},
        {"int gone(void); int gm_loops_user_native(void) { return gone(); }", "cc -shared -fPIC -x c - -o",
         "undefined symbol: gone"},
        {"rubbish", "cat >", "could not be loaded"},
    };
    char cache[GM_CACHE_PATH], aside[GM_CACHE_PATH + 8], command[2 * GM_CACHE_PATH], message[GM_MESSAGE];
    assert_true(gm_cache_folder(cache, message));
    snprintf(aside, sizeof aside, "%s/aside", cache);
    for (size_t i = 0; i < GM_COUNT(lacking); i++) {
        const char *words = fresh();
        struct gm_cache_entry *entries = NULL;
        size_t count = 0;
        assert_true(is_stepped_elsewhere(words, NULL));
        assert_true(gm_cache_list(cache, &entries, &count));
        assert_int_equal(count, 1);
        snprintf(command, sizeof command, "echo '%s' | %s '%s'", lacking[i].source, lacking[i].into, aside);
        assert_int_equal(system(command), 0);
        assert_true(gm_cache_keep(cache, aside, &entries[0].key, message));
        free(entries);
        assert_true(is_stepped_elsewhere(words, lacking[i].says));
        assert_true(gm_cache_list(cache, &entries, &count));
        assert_int_equal(count, 0);
        assert_true(is_stepped_elsewhere(words, NULL));
        assert_int_equal(cleared(cache), 1);
    }
}

static void compilers_hang(void **state)
{
    (void)state;
    with_compiler("#!/bin/sh\n/bin/sleep 1000\n");
    setenv("GEOMINT_COMPILER_SECONDS", "1", 1);
    refused("hung for 1 second");
    with_compiler("#!/bin/sh\nwhile :; do :; done\n");
    refused("more than 1 second");
    with_compiler("#!/bin/sh\nexec /usr/bin/yes flood >&2\n");
    refused("the compiler complained without end: flood");
    /* each process that it starts is within the limit of one */
    with_compiler("#!/bin/sh\nwhile :; do (i=0; while [ $i -lt 9999 ]; do i=$((i+1)); done); done\n");
    refused("more than 1 second");
}

/* What it has written aside it removes when it is asked to end. */
static void compilers_clear_up(void **state)
{
    (void)state;
    char cache[4200];
    with_compiler("#!/bin/sh\ntrap '/bin/rm -f \"$TMPDIR/aside\"; exit 1' TERM\n: >\"$TMPDIR/aside\"\n"
                  "/bin/sleep 1000 & wait\n");
    setenv("GEOMINT_COMPILER_SECONDS", "1", 1);
    refused("hung for 1 second");
    snprintf(cache, sizeof cache, "%s/geomint", folder);
    assert_int_equal(rmdir(cache), 0);
}

/* Streams that whoever started the program has closed. */
static void streams_are_closed(void **state)
{
    (void)state;
    const char *words = fresh();
    int how = 0;
    const pid_t process = fork();
    if (process == 0) {
        close(STDIN_FILENO);
        close(STDERR_FILENO);
        _exit(!is_stepped_elsewhere(words, NULL));
    }
    assert_true(process > 0 && waitpid(process, &how, 0) == process);
    assert_int_equal(how, 0);
}

/* One that is slow by the clock, since a processor seldom has time for it, is no hanging one. */
static void compilers_are_slow(void **state)
{
    (void)state;
    with_compiler("#!/bin/sh\n"
                  "for round in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18; do\n"
                  "  i=0; while [ $i -lt 20000 ]; do i=$((i+1)); done; /bin/sleep 0.2\n"
                  "done\n"
                  "PATH=/usr/bin:/bin; exec cc \"$@\"\n");
    setenv("GEOMINT_COMPILER_SECONDS", "3", 1);
    struct gm_lane *lane = lane_of(fresh(), "rk4", GM_ENGINE_NATIVE);
    if (strcmp(gm_engine_of(lane), "native") != 0) {
        fail_msg("%s", heard);
    }
    gm_lane_close(lane);
}

static void caches_fail(void **state)
{
    (void)state;
    char path[4200];
    snprintf(path, sizeof path, "%s/geomint", folder);
    mkdir(path, 0755);
    chmod(path, 0755);
    refused("only you may open");
    rmdir(path);
    assert_int_equal(symlink("/tmp", path), 0);
    refused("only you may open");
    unlink(path);
    assert_int_equal(symlink("/nowhere", path), 0);
    refused("only you may open");
    unlink(path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    refused("only you may open");
    unlink(path);
    setenv("XDG_CACHE_HOME", "/proc/nowhere", 1);
    refused("could not be made");
    if (geteuid() != 0) {
        setenv("XDG_CACHE_HOME", folder, 1);
        mkdir(path, 0500);
        refused("the cache could not be written");
    }
}

/* No room for the text, or for what the compiler makes of it: nothing of it stays. The limit of a file's size
   stands for that of a disk. */
static void disks_are_full(void **state)
{
    (void)state;
    static const rlim_t rooms[] = {100, 20000};
    static const char *const says[] = {"the cache could not be written: File too large",
                                       "nothing that can be kept"};
    for (int i = 0; i < 2; i++) {
        const char *words = fresh();
        int how = 0;
        const pid_t process = fork();
        if (process == 0) {
            signal(SIGXFSZ, SIG_IGN);
            const struct rlimit limit = {rooms[i], RLIM_INFINITY};
            setrlimit(RLIMIT_FSIZE, &limit);
            _exit(!is_stepped_elsewhere(words, says[i]));
        }
        assert_true(process > 0 && waitpid(process, &how, 0) == process);
        assert_int_equal(how, 0);
        char cache[4200];
        snprintf(cache, sizeof cache, "%s/geomint", folder);
        assert_int_equal(rmdir(cache), 0);
    }
}

/* What is stored under a key is whole, or is not there. */
static void entries_are_whole(void **state)
{
    (void)state;
    char cache[GM_CACHE_PATH], path[GM_CACHE_PATH + 64], other[GM_CACHE_PATH + 64], message[GM_MESSAGE],
        aside[GM_CACHE_PATH + 8];
    size_t count = 0;
    assert_true(gm_cache_folder(cache, message));
    struct gm_digest digest = gm_digest_open();
    const struct gm_cache_key key = gm_digest_key(&digest);
    gm_digest_add(&digest, "x", 1);
    const struct gm_cache_key second = gm_digest_key(&digest);
    snprintf(aside, sizeof aside, "%s/aside", cache);
    snprintf(path, sizeof path, "%s/%s.so", cache, key.text);
    snprintf(other, sizeof other, "%s/%s.so", cache, second.text);
    for (int fault = 0; fault < 8; fault++) {
        FILE *file = fopen(aside, "w");
        assert_non_null(file);
        fprintf(file, "a library");
        fclose(file);
        assert_int_equal(gm_cache_find(cache, &key), -1);
        assert_true(gm_cache_keep(cache, aside, &key, message));
        const int found = gm_cache_find(cache, &key);
        assert_in_range(found, 0, 1000);
        close(found);
        assert_int_not_equal(access(aside, F_OK), 0);
        switch (fault) {
        case 0: /* a byte */
            file = fopen(path, "r+");
            fputc('A', file);
            fclose(file);
            break;
        case 1: /* its end */
            assert_int_equal(truncate(path, 20), 0);
            break;
        case 2: /* all of it */
            assert_int_equal(truncate(path, 0), 0);
            break;
        case 3: /* another one's name */
            assert_int_equal(gm_cache_find(cache, &second), -1);
            assert_int_equal(rename(path, other), 0);
            assert_int_equal(gm_cache_find(cache, &second), -1);
            assert_int_not_equal(access(other, F_OK), 0);
            break;
        case 4: /* a pipe in its place, which nobody writes to */
            assert_int_equal(unlink(path), 0);
            assert_int_equal(mkfifo(path, 0600), 0);
            break;
        case 5: /* a folder in its place, which is empty */
            assert_int_equal(unlink(path), 0);
            assert_int_equal(mkdir(path, 0700), 0);
            break;
        case 6: /* which is not empty: it is somebody's until its owner has emptied it */
            assert_int_equal(unlink(path), 0);
            assert_int_equal(mkdir(path, 0700), 0);
            snprintf(other, sizeof other, "%s/%s.so/kept", cache, key.text);
            assert_int_equal(mkdir(other, 0700), 0);
            assert_int_equal(gm_cache_find(cache, &key), -1);
            assert_false(gm_cache_clear(cache, &count, message));
            assert_non_null(strstr(message, key.text));
            assert_non_null(strstr(message, "could not be removed: Directory not empty"));
            assert_int_equal(count, 0);
            assert_int_equal(rmdir(other), 0);
            assert_int_equal(cleared(cache), 1);
            break;
        default:
            assert_int_equal(cleared(cache), 1);
        }
        assert_int_equal(gm_cache_find(cache, &key), -1);
        assert_int_not_equal(access(path, F_OK), 0);
    }
}

static void caches_are_bounded(void **state)
{
    (void)state;
    char cache[GM_CACHE_PATH], message[GM_MESSAGE], aside[GM_CACHE_PATH + 8];
    assert_true(gm_cache_folder(cache, message));
    snprintf(aside, sizeof aside, "%s/aside", cache);
    struct gm_digest digest = gm_digest_open();
    for (int i = 0; i < 300; i++) {
        FILE *file = fopen(aside, "w");
        assert_non_null(file);
        fprintf(file, "library %d", i);
        fclose(file);
        gm_digest_add(&digest, &i, sizeof i);
        const struct gm_cache_key key = gm_digest_key(&digest);
        assert_true(gm_cache_keep(cache, aside, &key, message));
    }
    size_t count = 0;
    struct gm_cache_entry *entries = NULL;
    assert_true(gm_cache_list(cache, &entries, &count));
    free(entries);
    assert_in_range(count, 1, 256);
    assert_int_equal(cleared(cache), count);
    assert_true(gm_cache_list(cache, &entries, &count));
    assert_null(entries);
}

int main(int argc, char *argv[])
{
    char path[GM_CACHE_PATH];
    struct stat about;
    kernels = argc > 1 ? argv[1] : ".";
    systems = argc > 2 ? argv[2] : "share/systems";
    for (int i = 3; i < argc; i++) {
        const bool is_all = strcmp(argv[i], "all") == 0, is_baseline = strcmp(argv[i], "baseline") == 0,
                   is_avx2 = strcmp(argv[i], "avx2") == 0;
        all |= is_all;
        most = is_baseline ? GM_ISA_BASELINE : is_avx2 ? GM_ISA_AVX2 : most;
        compiler = is_all || is_baseline || is_avx2 ? compiler : argv[i];
    }
    if (compiler && !gm_program_find(compiler, path, &about)) {
        printf("there is no %s here\n", compiler);
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(engines_agree, begin, end),
        cmocka_unit_test_setup_teardown(random_formulas_agree, begin, end),
        cmocka_unit_test_setup_teardown(engines_agree_on_all, begin, end),
    };
    const struct CMUnitTest with_faults[] = {
        cmocka_unit_test_setup_teardown(entries_are_whole, begin, end),
        cmocka_unit_test_setup_teardown(caches_are_bounded, begin, end),
        cmocka_unit_test_setup_teardown(caches_fail, begin, end),
        cmocka_unit_test_setup_teardown(disks_are_full, begin, end),
        cmocka_unit_test_setup_teardown(entries_are_libraries, begin, end),
        cmocka_unit_test_setup_teardown(compilers_fail, begin, end),
        cmocka_unit_test_setup_teardown(compilers_hang, begin, end),
        cmocka_unit_test_setup_teardown(compilers_are_slow, begin, end),
        cmocka_unit_test_setup_teardown(compilers_clear_up, begin, end),
        cmocka_unit_test_setup_teardown(streams_are_closed, begin, end),
        cmocka_unit_test_setup_teardown(auto_takes_over, begin, end),
        cmocka_unit_test_setup_teardown(parameters_need_no_compiler, begin, end),
    };
    const int failed = compiler || most < GM_ISA_COUNT ? 0 : cmocka_run_group_tests(with_faults, NULL, NULL);
    return failed + cmocka_run_group_tests(tests, NULL, NULL);
}
