/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Native loops: compiled, cached, checked, taken. */
#include "app/native/engine.h"

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "app/native/cache.h"
#include "core/basics.h"
#include "core/memory.h"
#include "core/ode/families/composition.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/user/problem.h"
#include "render/message.h"

/* The flags of the build for built-in problems: no operation is fused or exchanged. (The search for common
   subexpressions would take a fifth of the time and find nothing.) */
static const char *const flags[] = {
    GM_NATIVE_FLAGS, "-D_GNU_SOURCE", "-DGM_PROBLEM=user", "-DGM_ISA=native", "-w", "-shared", "-fPIC"};
static const char *const isa_flags[GM_ISA_COUNT][3] = {
    [GM_ISA_AVX2] = {"-mavx2"},
    [GM_ISA_AVX512] = {"-march=skylake-avx512", "-mno-fma", "-mprefer-vector-width=512"},
};
static const char *const family_flags[GM_OVER_COUNT + 1] = {
    [GM_OVER_NONE] = "-DGM_LOOP_NONE",         [GM_OVER_EXPLICIT] = "-DGM_LOOP_EXPLICIT",
    [GM_OVER_IMPLICIT] = "-DGM_LOOP_IMPLICIT", [GM_OVER_SPLITTING] = "-DGM_LOOP_SPLITTING",
    [GM_OVER_ALL] = "-UGM_LOOP_NONE",
};

/* With small single states halves of q and p would be paired in registers and separated again: without that
   a step of Verlet takes .83 of the time (Kepler, Henon-Heiles), and none takes longer. */
static const char unpaired[] = "-fno-tree-slp-vectorize";

/* The compiled part of the loops: a family's, for single runs or for ensembles. */
struct part {
    int family;
    bool alone, frozen; /* frozen: of motions with frozen switches */
    enum gm_isa isa;
};

enum state { REFUSED, COMPILING, READY };

/* The loops of one kernel's text. */
struct build {
    struct build *next;
    struct gm_digest source; /* the digest of text and part */
    struct part part;
    enum state state;
    const struct gm_loops *loops;
    struct gm_compilation compilation;
    struct gm_cache_key key;
    char text_name[80], library_name[80]; /* names of temporary files, while it compiles */
    char sentence[GM_MESSAGE];            /* the reason, as long as it is refused */
    bool said;
};

/* Lanes of all threads share them; they stay as long as the program does. */
static pthread_mutex_t making = PTHREAD_MUTEX_INITIALIZER;
static struct build *builds;
static enum gm_engine chosen = GM_ENGINE_AUTO;
static char kernel_folder[GM_CACHE_PATH]; /* "": nothing can be compiled */
static void (*tell)(const char *sentence);
static bool (*interrupted)(void);
static atomic_bool stopping; /* the program ends, and its compilations with it */
static double spent_in_all;

static bool is_written(const struct gm_lane *lane)
{
    return lane->problem.kind == &gm_kind_ode && gm_ode_of(&lane->problem)->written;
}

/* Returns the loops of which steps are made. */
static const struct gm_loops *taken_by(const struct gm_lane *lane)
{
    const struct gm_problem *motion = gm_run_motion(lane->run);
    return motion ? gm_user_problem_taken(motion) : NULL;
}

static void let_take(struct gm_lane *lane, const struct gm_loops *loops)
{
    if (gm_run_locates(lane->run)) {
        gm_user_problem_take_frozen(&lane->problem, loops);
    } else {
        gm_user_problem_take(&lane->problem, loops);
    }
}

/* Returns true if the lane has compiled code, with the loops that its scheme calls. */
static bool is_native(const struct gm_lane *lane)
{
    const struct gm_loops *taken = taken_by(lane);
    const int over = gm_scheme_over_kernels(lane->scheme);
    if (taken && over == GM_OVER_ALL) {
        return taken->over_kernels[GM_OVER_EXPLICIT] && taken->over_kernels[GM_OVER_IMPLICIT];
    }
    return taken && (over == GM_OVER_NONE || taken->over_kernels[over]);
}

const char *gm_engine_of(const struct gm_lane *lane)
{
    return !is_written(lane) ? NULL : is_native(lane) ? "native" : "interpreted";
}

/* Wide registers gain nothing if one of them holds all of a single state: moving its halves, q and p,
   within it takes longer (Kepler with rk4 1.15 times the baseline's time, with yoshida4 1.11). A step of
   rk4 on three bodies takes .8 of its time with them. */
static struct part part_of(const struct gm_lane *lane)
{
    enum { FILLS_ONE = 4 };
    const bool alone = lane->problem.m == 1;
    return (struct part){
        .family = gm_scheme_over_kernels(lane->scheme),
        .alone = alone,
        .frozen = gm_run_locates(lane->run),
        .isa = alone && lane->problem.n <= FILLS_ONE ? GM_ISA_BASELINE : gm_isa_best(),
    };
}

static const char *alone_flag(struct part part)
{
    return part.alone ? "-DGM_ALONE" : "-UGM_ALONE";
}

/* ---- from a kernel's text to loops ---- */

/* Loads the entry of the build's key. Returns false if it does not exist. */
static bool load(struct build *build, const char *folder)
{
    char path[64];
    const int file = gm_cache_find(folder, &build->key);
    if (file < 0) {
        return false;
    }
    /* The path is the checked file's, even if another one has its name now. The file stays open as long as
       it is loaded: the loader identifies libraries by their names. */
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const char *error = library ? NULL : dlerror();
    build->loops = library ? dlsym(library, "gm_loops_user_native") : NULL;
    if (build->loops) {
        build->state = READY;
        return true;
    }
    gm_refuse(build->sentence, "what was compiled could not be loaded: %.300s",
              error ? error : "it holds no loops");
    /* the next start compiles it again; that is useless if nothing can be loaded, as from a folder mounted
       noexec */
    if (!error || !strstr(error, "failed to map segment")) {
        gm_cache_drop(folder, &build->key);
    }
    if (library) {
        dlclose(library);
    }
    close(file);
    return true;
}

static void remove_aside(const char *folder, const struct build *build)
{
    const char *const names[] = {build->text_name, build->library_name};
    for (size_t i = 0; i < 2; i++) {
        char path[GM_CACHE_PATH];
        snprintf(path, sizeof path, "%.3900s/%s", folder, names[i]);
        unlink(path);
    }
}

static void compile(struct build *build, const char *folder, const char *compiler, const char *text)
{
    enum { MOST = GM_COUNT(flags) + 17 };
    const struct part part = build->part;
    static unsigned number;
    const char *arguments[MOST];
    char kernels[128], source[GM_CACHE_PATH];
    size_t count = 0;
    gm_cache_sweep(folder);
    snprintf(build->text_name, sizeof build->text_name, "%s-%d-%u.h", build->key.text, (int)getpid(),
             ++number);
    snprintf(build->library_name, sizeof build->library_name, "%s-%d-%u.aside", build->key.text,
             (int)getpid(), number);
    snprintf(kernels, sizeof kernels, "-DGM_KERNELS=\"%s\"", build->text_name);
    snprintf(source, sizeof source, "%.3900s/core/ode/compiled/over_kernels.c", kernel_folder);
    char path[GM_CACHE_PATH];
    snprintf(path, sizeof path, "%.3900s/%s", folder, build->text_name);
    FILE *file = fopen(path, "wxe");
    const bool written = file && fputs(text, file) >= 0;
    if (!file || fclose(file) != 0 || !written) {
        gm_refuse(build->sentence, "the cache could not be written: %s", strerror(errno));
        remove_aside(folder, build);
        return;
    }
    arguments[count++] = compiler;
    for (size_t i = 0; i < GM_COUNT(flags); i++) {
        arguments[count++] = flags[i];
    }
    for (size_t i = 0; i < 3; i++) {
        if (isa_flags[part.isa][i]) {
            arguments[count++] = isa_flags[part.isa][i];
        }
    }
    if (part.family == GM_OVER_SPLITTING && part.alone && part.isa == GM_ISA_BASELINE) {
        arguments[count++] = unpaired;
    }
    const char *const rest[] = {
        family_flags[part.family], alone_flag(part), kernels, "-I", kernel_folder, "-I", ".", "-o",
        build->library_name,       source,           "-lm",   NULL};
    memcpy(arguments + count, rest, sizeof rest);
    if (gm_compilation_start(&build->compilation, folder, arguments, build->sentence)) {
        build->state = COMPILING;
    } else {
        remove_aside(folder, build);
    }
}

static void add_word(struct gm_digest *digest, const char *word)
{
    gm_digest_add(digest, word ? word : "", word ? strlen(word) + 1 : 1);
}

/* The key of the compiled code: the text, this build of the program, the compiler, its flags, the
   processor. */
static bool find_key(struct build *build, char compiler[GM_CACHE_PATH])
{
    struct gm_digest digest = build->source;
    struct stat program;
    if (stat("/proc/self/exe", &program) == 0) {
        gm_digest_add(&digest, &program.st_size, sizeof program.st_size);
        gm_digest_add(&digest, &program.st_mtim, sizeof program.st_mtim);
    }
    add_word(&digest, GM_VERSION);
    add_word(&digest, kernel_folder);
    for (size_t i = 0; i < GM_COUNT(flags); i++) {
        add_word(&digest, flags[i]);
    }
    for (size_t i = 0; i < 3; i++) {
        add_word(&digest, isa_flags[build->part.isa][i]);
    }
    const bool found = gm_compiler_find(compiler, &digest);
    build->key = gm_digest_key(&digest);
    return found;
}

static void begin(struct build *build, const char *text)
{
    char folder[GM_CACHE_PATH], compiler[GM_CACHE_PATH];
    if (!kernel_folder[0]) {
        gm_refuse(build->sentence, "the sources of its loops are not there");
    } else if (!find_key(build, compiler)) {
        gm_refuse(build->sentence, "there is no C compiler (cc, gcc or clang) in PATH");
    } else if (gm_cache_folder(folder, build->sentence) && !load(build, folder)) {
        compile(build, folder, compiler, text);
    }
}

static void look(struct build *build)
{
    char folder[GM_CACHE_PATH], library[GM_CACHE_PATH];
    const enum gm_compiled how = gm_compilation_look(&build->compilation, build->sentence);
    if (how == GM_COMPILES) {
        return;
    }
    build->state = REFUSED; /* unless it can be loaded */
    if (!gm_cache_folder(folder, build->sentence)) {
        return;
    }
    snprintf(library, sizeof library, "%.3900s/%s", folder, build->library_name);
    if (how == GM_COMPILED && gm_cache_keep(folder, library, &build->key, build->sentence)) {
        gm_refuse(build->sentence, "what was compiled is gone from the cache");
        load(build, folder);
    }
    remove_aside(folder, build);
}

/* The build of a lane's problem and scheme, started if it is new; NULL when out of memory. The problem
   stores it, so that the text is written only once. */
static struct build *build_of(const struct gm_lane *lane)
{
    const char *lacks = NULL;
    const struct part part = part_of(lane);
    void **note = gm_user_problem_note(&lane->problem);
    const struct build *noted = *note;
    if (noted && noted->part.family == part.family && noted->part.alone == part.alone &&
        noted->part.frozen == part.frozen) {
        return *note;
    }
    const struct gm_problem *motion = gm_run_motion(lane->run);
    char *text = motion ? gm_user_problem_kernel(motion, part.family, &lacks) : NULL;
    struct gm_digest source = gm_digest_open();
    if (!text && !lacks) {
        return NULL;
    }
    add_word(&source, text ? text : lacks);
    add_word(&source, family_flags[part.family]);
    add_word(&source, alone_flag(part));
    struct build *build = builds;
    while (build && (build->source.a != source.a || build->source.b != source.b)) {
        build = build->next;
    }
    if (!build && (build = calloc(1, sizeof *build))) {
        build->source = source;
        build->part = part;
        build->next = builds;
        builds = build;
        if (text) {
            begin(build, text);
        } else {
            gm_refuse(build->sentence, "%s", lacks);
        }
    }
    free(text);
    *note = build;
    return build;
}

/* ---- lanes ---- */

/* A run after some steps from a snapshot on, as another snapshot. */
static bool try_steps(struct gm_run *run, const void *before, void *after)
{
    enum { BLOCK = 20 };
    if (!gm_run_load(run, before)) {
        return false;
    }
    gm_run_advance(run, BLOCK);
    gm_run_save(run, after);
    return true;
}

/* Returns true if both engines make the same steps from the lane's state: in all counts, and in every bit
   of the run's state. The lane's state does not change; if they agree, it has taken the compiled code. */
static bool agrees(struct gm_lane *lane, const struct gm_loops *loops)
{
    struct gm_run *run = lane->run;
    const size_t size = gm_run_snapshot_size(run), head = size - run->half_size;
    char *before = malloc(3 * size), *one = before ? before + size : NULL,
         *other = before ? one + size : NULL;
    bool equal = false;
    const struct gm_event_witness witness = run->witness;
    run->witness = (struct gm_event_witness){0}; /* trial steps are not followed */
    if (before) {
        gm_run_save(run, before);
        const bool tried = try_steps(run, before, one);
        struct gm_run then = *run;
        let_take(lane, loops);
        equal = tried && try_steps(run, before, other) && run->status == then.status &&
                run->steps == then.steps && run->evaluations == then.evaluations &&
                run->iterations == then.iterations && run->solves == then.solves;
        const double *numbers = (const double *)(const void *)(one + head),
                     *others = (const double *)(const void *)(other + head);
        for (size_t i = 0; equal && i < run->half_size / sizeof *numbers; i++) {
            equal = (isnan(numbers[i]) && isnan(others[i])) ||
                    memcmp(&numbers[i], &others[i], sizeof *numbers) == 0;
        }
        gm_run_load(run, before);
    }
    run->witness = witness;
    if (!equal) {
        let_take(lane, NULL);
    }
    free(before);
    return equal;
}

/* The loops of a build that is ready go to a lane. */
static void give(struct build *build, struct gm_lane *lane)
{
    if (build->state != READY || lane->run->status != GM_OK || taken_by(lane) == build->loops) {
        return;
    }
    const unsigned long refusals = gm_memory_refusals();
    if (!agrees(lane, build->loops) && refusals == gm_memory_refusals()) {
        gm_refuse(build->sentence, "its steps are not those of the interpreter, bit by bit");
        build->state = REFUSED;
    }
}

void gm_engine_meet(struct gm_lane *lane)
{
    if (chosen == GM_ENGINE_INTERPRETED || !is_written(lane)) {
        return;
    }
    if (!gm_run_locates(lane->run)) {
        gm_user_problem_take_compiled(&lane->problem, gm_scheme_over_kernels(lane->scheme));
    }
    if (chosen != GM_ENGINE_NATIVE || is_native(lane)) {
        return;
    }
    pthread_mutex_lock(&making);
    struct build *build = build_of(lane);
    while (build && build->state == COMPILING && !stopping && !interrupted()) {
        nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
        look(build);
    }
    if (build) {
        give(build, lane);
    }
    if (build && build->state == READY && taken_by(lane) == build->loops && !is_native(lane)) {
        gm_refuse(build->sentence, "splittings have native loops where H = T(p) + V(q) holds no time");
        build->state = REFUSED;
    }
    if (build && build->state == REFUSED && tell && !build->said) {
        char sentence[GM_MESSAGE];
        gm_refuse(sentence, "the formulas are interpreted: %.400s", build->sentence);
        tell(sentence);
        build->said = true;
    }
    pthread_mutex_unlock(&making);
}

void gm_engine_look(struct gm_lane *lane, double spent, double left)
{
    static const double building = 5; /* seconds */
    if (chosen == GM_ENGINE_INTERPRETED || !*kernel_folder || !is_written(lane) || is_native(lane) ||
        stopping || pthread_mutex_trylock(&making) != 0) {
        return;
    }
    spent_in_all += spent;
    const bool pays = chosen == GM_ENGINE_NATIVE || spent_in_all + left > building;
    struct build *build = pays ? build_of(lane) : NULL;
    if (build && build->state == COMPILING) {
        look(build);
    }
    if (build) {
        give(build, lane);
    }
    pthread_mutex_unlock(&making);
}

static void stop_all(void)
{
    char folder[GM_CACHE_PATH], sentence[GM_MESSAGE];
    stopping = true;
    pthread_mutex_lock(&making);
    for (struct build *build = builds; build; build = build->next) {
        if (build->state == COMPILING) {
            gm_compilation_stop(&build->compilation);
            build->state = REFUSED;
            if (gm_cache_folder(folder, sentence)) {
                remove_aside(folder, build);
            }
        }
    }
    pthread_mutex_unlock(&making);
}

void gm_engine_choose(enum gm_engine engine, const char *kernels, void (*teller)(const char *sentence),
                      bool (*asked)(void))
{
    chosen = engine;
    tell = teller;
    interrupted = asked;
    static bool stops;
    /* the compiler works in a separate folder */
    if (strlen(kernels) >= sizeof kernel_folder || !realpath(kernels, kernel_folder)) {
        kernel_folder[0] = '\0';
    }
    if (!stops) {
        stops = atexit(stop_all) == 0;
    }
}
