/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A lane that was packed and unpacked goes on as if nothing had happened: every scene, every scheme. What a
   lane tells of its losses, and of memory that it was refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "app/words/request.h"
#include "app/words/system.h"
#include "core/basics.h"
#include "core/field/families/laws/laws.h"
#include "core/flow/flow.h"
#include "core/memory.h"
#include "core/quantity.h"
#include "core/schemes.h"
#include "scenes/common/lane_pack.h"
#include "tests/common/lane.h"

enum { BEFORE = 7, AFTER = 6 };

/* What makes a scene with large meshes small, and what asks of a scene what it does not do by itself. */
static const char *const arguments[] = {
    "disc points=12",
    "disc points=12 scheme=verlet compensated=yes",
    "kepler",
    "kepler perturbation=0.01",
    "vortices",
    "vortices configuration=random count=12 tracers=50",
    "stiff",
    "stiff system=spring-pendulum",
    "henon-heiles",
    "oscillator",
    "abc",
    "sine-gordon points=100",
    "burgers",
    "kdv points=60",
    "nls points=60",
    "wave",
    "soliton points=15",
    "soliton solitons=2 points=15",
    "room rows=10 columns=14 tracers=40",
    "channel columns=40 rows=5",
    "couette",
    "poiseuille",
    "cavity columns=8 rows=10",
    "taylor-green columns=8 rows=10",
};

static struct gm_lane *open_lane(const char *text, const char *scheme)
{
    char copy[256], message[GM_MESSAGE], *words[16], *rest = NULL;
    int count = 0;
    snprintf(copy, sizeof copy, "%s%s%s", text, scheme ? " scheme=" : "", scheme ? scheme : "");
    for (char *word = strtok_r(copy, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    struct gm_request request;
    if (!gm_request_parse(&request, count, words, 1, message)) {
        fail_msg("%s: %s", text, message);
    }
    struct gm_lane *lane = gm_request_open_lane(&request, 0, message);
    gm_request_close(&request);
    return lane;
}

static void *packed(const struct gm_lane *lane, size_t *size)
{
    *size = gm_lane_pack_size(lane);
    void *bytes = malloc(*size);
    assert_non_null(bytes);
    gm_lane_pack(lane, bytes);
    return bytes;
}

static void advance(struct gm_lane *lane, int steps)
{
    for (int i = 0; i < steps; i++) {
        gm_run_advance(lane->run, 1);
        gm_lane_record(lane);
    }
}

/* Whether two lanes are the same in every bit that is packed but the pointers of the run's head. */
static bool same(const struct gm_lane *a, const struct gm_lane *b)
{
    size_t size_a = 0, size_b = 0;
    unsigned char *bytes_a = packed(a, &size_a), *bytes_b = packed(b, &size_b);
    const size_t head = sizeof(struct gm_run);
    const bool good = size_a == size_b && memcmp(bytes_a + head, bytes_b + head, size_a - head) == 0 &&
                      a->run->t == b->run->t && a->run->steps == b->run->steps &&
                      a->run->status == b->run->status && a->run->evaluations == b->run->evaluations;
    free(bytes_a);
    free(bytes_b);
    return good;
}

static void packed_lanes_go_on(void **unused)
{
    (void)unused;
    size_t tried = 0;
    for (size_t i = 0; i < GM_COUNT(arguments); i++) {
        struct gm_lane *first = open_lane(arguments[i], NULL);
        assert_non_null(first);
        for (size_t k = 0; k < gm_scheme_count(); k++) {
            const struct gm_scheme *scheme = gm_scheme_at(k);
            const bool named = strstr(arguments[i], "scheme=") != NULL;
            if (!gm_scheme_fits(scheme, &first->problem) || scheme->family->not_resumable ||
                (named && scheme != first->scheme)) {
                continue;
            }
            const char *name = named ? NULL : scheme->name;
            struct gm_lane *whole = open_lane(arguments[i], name);
            struct gm_lane *resumed = whole ? open_lane(arguments[i], name) : NULL;
            if (!resumed) {
                continue; /* a start that does not exist for this scheme */
            }
            advance(whole, BEFORE);
            size_t size = 0;
            void *bytes = packed(whole, &size);
            size_t taken = size;
            assert_true(gm_lane_unpack(resumed, bytes, &taken));
            assert_int_equal(taken, size);
            struct gm_lane *copy = gm_lane_copy(whole);
            assert_non_null(copy);
            free(bytes);
            advance(whole, AFTER);
            advance(resumed, AFTER);
            advance(copy, AFTER);
            if (!same(whole, resumed) || !same(whole, copy)) {
                fail_msg("%s, %s: a packed lane goes another way", arguments[i], scheme->name);
            }
            gm_lane_close(whole);
            gm_lane_close(resumed);
            gm_lane_close(copy);
            tried++;
        }
        gm_lane_close(first);
    }
    assert_true(tried > 200);
}

/* Whatever its rows and columns, a channel has an inlet, an outlet, and a hot wall all along the top. */
static void channels_have_their_walls(void **unused)
{
    (void)unused;
    static const char *const channels[] = {
        "channel rows=6 columns=0",   "channel rows=10 columns=0",  "channel rows=12 columns=0",
        "channel rows=18 columns=0",  "channel rows=23 columns=0",  "channel rows=49 columns=0",
        "channel rows=7 columns=50",  "channel rows=11 columns=82", "channel rows=14 columns=100",
        "channel rows=14 columns=98",
    };
    for (size_t i = 0; i < GM_COUNT(channels); i++) {
        struct gm_lane *lane = open_lane(channels[i], NULL);
        if (!lane) {
            fail_msg("%s: it could not be opened", channels[i]);
        }
        const struct gm_flow *flow = gm_flow_of(&lane->problem);
        const struct gm_complex *complex = flow->complex;
        size_t hot = 0, top = 0;
        for (size_t v = 0; v < complex->vertices; v++) {
            top += complex->point[2 * v + 1] > 1 - 1e-9;
            hot += flow->theta_fixed[v] && flow->theta[v] == 20;
        }
        assert_true(top > 20);
        assert_int_equal(hot, top);
        gm_lane_close(lane);
    }
}

/* Bytes that are cut short, or whose counts are nonsense, are refused without a read or write too far. */
static void damaged_bytes_are_refused(void **unused)
{
    (void)unused;
    struct gm_lane *lane = open_lane("kepler", NULL), *other = open_lane("kepler", NULL);
    advance(lane, BEFORE);
    size_t size = 0;
    unsigned char *bytes = packed(lane, &size);
    for (size_t less = 1; less < size; less += 97) {
        size_t taken = size - less;
        unsigned char *part = malloc(taken);
        memcpy(part, bytes, taken);
        assert_false(gm_lane_unpack(other, part, &taken));
        free(part);
    }
    const size_t count_at = gm_run_snapshot_size(lane->run);
    memset(bytes + count_at, 0x7f, sizeof(size_t));
    size_t taken = size;
    assert_false(gm_lane_unpack(other, bytes, &taken));
    free(bytes);
    gm_lane_close(lane);
    gm_lane_close(other);
}

/* Clocks tell the time with as many decimals as the step moves, in flows with their unit behind it. */
static void clocks_follow_the_step(void **unused)
{
    (void)unused;
    static const struct {
        const char *arguments, *clock;
    } wanted[] = {
        {"kepler dt=0.0005", "t = 0.0035"},
        {"taylor-green columns=8 rows=10 dt=0.0005", "t = 0.0035"},
        {"channel columns=40 rows=5 dt=0.0005", "t = 0.0035 H²/ν"},
        {"couette dt=0.0005 scheme=semi-implicit", "t = 0.0035 H²/ν"},
        {"cavity columns=8 rows=10 dt=0.05 scheme=semi-implicit", "t = 0.35 L/U"},
        {"room rows=10 columns=14 dt=0.0005", "t = 0.0035 τ"},
    };
    for (size_t i = 0; i < GM_COUNT(wanted); i++) {
        struct gm_lane *lane = open_lane(wanted[i].arguments, NULL);
        struct gm_picture *picture = gm_picture_open();
        assert_true(lane && picture);
        advance(lane, BEFORE);
        gm_lanes_draw((const struct gm_lane *const *)&lane, 1, picture);
        assert_string_equal(picture->clock, wanted[i].clock);
        gm_picture_close(picture);
        gm_lane_close(lane);
    }
}

static double seven(const struct gm_view *view)
{
    (void)view;
    return 7;
}

/* An observable that is above what it may be is told with its number. */
static void excess_is_told(void **unused)
{
    (void)unused;
    char text[GM_MESSAGE];
    struct gm_lane *lane = open_lane("kepler dt=0.1", NULL);
    assert_non_null(lane);
    const struct gm_scene *given = lane->scene;
    const struct gm_observable one = {
        .key = "rest", .title = "what is left", .evaluate = seven, .most = 1e-9};
    struct gm_scene scene = *given;
    scene.observables = &one;
    scene.observable_count = 1;
    lane->scene = &scene;
    gm_lane_warning(lane, text, sizeof text);
    assert_string_equal(text, "rest is 7, above 1e-09: what is left");
    struct gm_observable less = one;
    less.most = 8;
    scene.observables = &less;
    gm_lane_warning(lane, text, sizeof text);
    assert_string_equal(text, "");
    lane->scene = given;
    gm_lane_close(lane);
}

/* A problem of forms that was closed is the next one with its numbers; one in use is not shared. */
static void closed_problems_return(void **unused)
{
    (void)unused;
    char message[GM_MESSAGE];
    struct gm_problem first = {0}, second = {0};
    struct gm_lane *lane = open_lane("form-poisson level=1", NULL);
    assert_non_null(lane);
    assert_true(lane->scene->setup(lane->parameters, &first, message));
    const void *was = first.parameters;
    assert_ptr_not_equal(was, lane->problem.parameters);
    lane->scene->close(&first);
    assert_true(lane->scene->setup(lane->parameters, &second, message));
    assert_ptr_equal(second.parameters, was);
    lane->scene->close(&second);
    gm_lane_close(lane);
}

/* Implicit Euler divides the area by 1 + h^2 in each step, explicit Euler multiplies it. */
static void losses_are_told(void **unused)
{
    (void)unused;
    const double h = 0.5, factor = 1 + h * h;
    const struct {
        const char *arguments, *part;
        int steps; /* the first after which it is lost */
    } wanted[] = {
        {"disc points=8 dt=0.5 scheme=implicit-euler", "left of a quantity",
         (int)ceil(log(10) / log(factor))},
        {"disc points=8 dt=0.5 scheme=explicit-euler", "has lost a quantity",
         (int)ceil(log(11) / log(factor))},
    };
    for (size_t i = 0; i < GM_COUNT(wanted); i++) {
        char text[GM_MESSAGE];
        struct gm_lane *lane = open_lane(wanted[i].arguments, NULL);
        assert_non_null(lane);
        advance(lane, wanted[i].steps - 1);
        gm_lane_warning(lane, text, sizeof text);
        assert_string_equal(text, "");
        advance(lane, 1);
        gm_lane_warning(lane, text, sizeof text);
        assert_non_null(strstr(text, "_error is")); /* of the area, or of the energy, which does the same */
        assert_non_null(strstr(text, wanted[i].part));
        gm_lane_close(lane);
    }
}

/* Where a section is passed, and where a run is stopped, is as good as the scheme is: x = cos(t) of an
   oscillator, by steps that do not meet the zeros. */
static void crossings_are_found_by_the_scheme(void **unused)
{
    (void)unused;
    char *words[] = {"section.system", "dt=0.1"}, message[GM_MESSAGE];
    static const struct {
        const char *scheme;
        double bound;
    } runs[] = {{"gauss8", 1e-12}, {"gauss6", 1e-7}, {"rk4", 1e-4}};
    assert_true(gm_system_recall("section.system",
                                 "H: (p_x^2 + x^2)/2\ncoordinates: x\nstart: x = 1, p_x = 0\n"
                                 "section: x = 0, p_x > 0; x, p_x\nstop: t + 0.1*p_x - 30.5\n"));
    for (size_t k = 0; k < GM_COUNT(runs); k++) {
        int status = 0;
        const struct gm_scene *scene = gm_system_scene(2, words, &status, message);
        assert_non_null(scene);
        void *parameters = gm_scene_defaults(scene);
        assert_non_null(parameters);
        ((struct gm_timing *)parameters)->dt = 0.1;
        const struct gm_settings settings = {0};
        struct gm_lane *lane =
            gm_lane_open(scene, parameters, &settings, gm_scheme_find(runs[k].scheme), message);
        assert_non_null(lane);
        gm_lane_to(lane, 1000, 100);
        const struct gm_entries *entries = &lane->entries[scene->track_count - 1];
        for (size_t i = 0; i < entries->count; i++) {
            const double wanted = 1.5 * M_PI + 2 * M_PI * (double)i;
            if (!(fabs(entries->times[i] - wanted) < runs[k].bound)) {
                fail_msg("%s crosses at %.17g, not %.17g", runs[k].scheme, entries->times[i], wanted);
            }
        }
        assert_int_equal(entries->count, 5);
        /* t - sin(t)/10 = 30.5: the state is just beyond it */
        const double t = lane->run->t, *state = gm_run_state(lane->run), beyond = t + 0.1 * state[1] - 30.5;
        assert_true(lane->run->stopped && beyond >= 0 && beyond < 1e-13);
        assert_true(fabs(t - 0.1 * sin(t) - 30.5) < runs[k].bound);
        gm_lane_close(lane);
        free(parameters);
    }
}

/* A record that was thinned knows the steps of its entries: it is shown as it was at any earlier step. */
static void thinned_records_are_shown_at_every_step(void **unused)
{
    (void)unused;
    enum { STEPS = 20000, EACH = 4 /* the bound of the record is 8192 */ };
    struct gm_lane *lane = open_lane("kepler dt=0.01", "verlet"),
                   *earlier = open_lane("kepler dt=0.01", "verlet");
    struct gm_entries *past = &lane->entries[0];
    advance(lane, STEPS);
    assert_int_equal(past->count, STEPS / EACH + 1);
    for (size_t i = 0; i < past->count; i++) {
        assert_int_equal(past->steps[i], EACH * (int64_t)i);
        assert_true(fabs(past->times[i] - 0.01 * EACH * (double)i) < 1e-9);
    }
    for (int64_t step = 0; step <= STEPS; step += 1777) {
        advance(earlier, (int)(step - earlier->run->steps));
        gm_entries_show(past, &lane->scene->tracks[0], earlier->run);
        assert_int_equal(past->count, step / EACH + 1);
        const struct gm_entries *other = &earlier->entries[0];
        const size_t common = (size_t)(step - step % EACH); /* a step of both records */
        assert_memory_equal(past->values + past->width * (common / EACH),
                            other->values + past->width * (common / (size_t)other->every),
                            past->width * sizeof(double));
    }
    gm_lane_close(earlier);
    gm_lane_close(lane);
}

/* Steps whose stops are looked at together end where they do one by one, to the last bit: also where a stop is
   passed to and fro between two looks, and where a step fails. */
static void stops_together(void **unused)
{
    (void)unused;
    static const char *const stops[] = {"t - 0.5",      "t - 6.395",       "t - 6.4",       "t - 6.405",
                                        "x + 0.999999", "p_x - 0.9999999", "t - 6.4 + 0*x", "t - 1e9"};
    static const char *const forms[] = {"(p_x^2 + x^2)/2", "p_x^2/2 - x^4"};
    for (size_t k = 0; k < 2 * GM_COUNT(stops); k++) {
        char text[200], message[GM_MESSAGE];
        char *words[] = {"stop.system"};
        int status = 0;
        snprintf(text, sizeof text, "coordinates: x\nH: %s\nstart: x = 0.1, p_x = 1\nstop: %s\ndt: 0.01\n",
                 forms[k % 2], stops[k / 2]);
        assert_true(gm_system_recall("stop.system", text));
        const struct gm_scene *scene = gm_system_scene(1, words, &status, message);
        assert_non_null(scene);
        void *parameters = gm_scene_defaults(scene);
        const struct gm_settings settings = {0};
        struct gm_lane *lanes[2];
        for (int i = 0; i < 2; i++) {
            lanes[i] = gm_lane_open(scene, parameters, &settings, gm_scheme_find("verlet"), message);
            assert_non_null(lanes[i]);
        }
        gm_lane_to(lanes[0], 5000, 50);
        while (gm_run_goes_on(lanes[1]->run, 5000, 50)) {
            gm_lane_to(lanes[1], lanes[1]->run->steps + 1, 50);
        }
        const struct gm_run *run = lanes[0]->run, *other = lanes[1]->run;
        if (run->steps != other->steps || run->t != other->t || run->status != other->status ||
            run->evaluations != other->evaluations ||
            memcmp(gm_run_state(run), gm_run_state(other), 2 * sizeof(double)) != 0) {
            fail_msg("%s: %ld steps, t = %.17g; one by one %ld, %.17g", text, run->steps, run->t,
                     other->steps, other->t);
        }
        gm_lane_close(lanes[0]);
        gm_lane_close(lanes[1]);
        free(parameters);
    }
}

static bool find_no_mesh(const void *own, const struct gm_problem *problem, const struct gm_scheme *scheme,
                         double *y, char *sentence)
{
    (void)own;
    (void)problem;
    (void)scheme;
    (void)y;
    gm_memory_refused();
    return gm_refuse(sentence, "no mesh was found");
}

static void refused_memory_is_no_fault_of_a_mesh(void **unused)
{
    (void)unused;
    struct gm_scene scene = *gm_scene_find("soliton");
    scene.start_with = find_no_mesh;
    scene.variant = NULL; /* which would be the scene itself */
    void *parameters = malloc(scene.size);
    assert_non_null(parameters);
    memcpy(parameters, scene.initial, scene.size);
    char sentence[GM_MESSAGE] = "";
    const struct gm_settings settings = {0};
    assert_null(gm_lane_open(&scene, parameters, &settings, gm_scheme_find("multiplier-lobatto4"), sentence));
    assert_string_equal(sentence, "not enough memory");
    free(parameters);
}

/* What lists know of scenes without opening their files is what the scenes say. */
static void lists_know_scenes(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < gm_scene_count(); i++) {
        assert_string_equal(gm_scene_name(i), gm_scene_at(i)->name);
        assert_string_equal(gm_scene_title(i), gm_scene_at(i)->title);
        assert_int_equal(gm_scene_number(gm_scene_name(i)), i);
    }
    assert_int_equal(gm_scene_number("system"), gm_scene_count());
}

/* Steps that are followed together leave the tracks that single steps leave, to the bit. */
static void tracks_know_no_calls(void **unused)
{
    (void)unused;
    static const char *const runs[] = {
        "henon-heiles scheme=verlet",
        "henon-heiles scheme=gauss4 dt=.3",
        "henon-heiles scheme=yoshida4",
        "henon-heiles scheme=rk4 dt=2", /* it blows up */
        "lorenz scheme=rk4",
        "lorenz scheme=kahan2",
        "lorenz scheme=dopri5",
        "driven-pendulum scheme=rk4", /* the section is at equal times */
        "double-pendulum scheme=gauss4",
        "kepler-space scheme=verlet",
        "restricted-three-body scheme=rk4",
        "henon-heiles scheme=verlet compensated=yes",
        "vortices",
        "vortices configuration=random count=12 tracers=5",
    };
    enum { STEPS = 3000 };
    static const int64_t calls[] = {1, 2, 700, 701, 1900, STEPS};
    for (size_t r = 0; r < GM_COUNT(runs); r++) {
        struct gm_lane *single = open_lane(runs[r], NULL), *together = open_lane(runs[r], NULL);
        assert_non_null(single);
        assert_non_null(together);
        assert_int_equal(single->scene->follow, 1);
        while (gm_run_goes_on(single->run, STEPS, INFINITY)) {
            gm_run_to(single->run, single->run->steps + 1, INFINITY);
            gm_lane_record(single);
        }
        for (size_t i = 0; i < GM_COUNT(calls); i++) {
            gm_lane_to(together, calls[i], INFINITY);
        }
        const struct gm_run *one = single->run, *other = together->run;
        const size_t numbers = single->problem.n * single->problem.m;
        assert_int_equal(one->steps, other->steps);
        assert_int_equal(one->status, other->status);
        assert_int_equal(one->evaluations, other->evaluations);
        assert_memory_equal(gm_run_state(one), gm_run_state(other), numbers * sizeof(double));
        assert_memory_equal(single->angles, together->angles,
                            single->scene->observable_count * sizeof(double));
        for (size_t i = 0; i < single->scene->track_count; i++) {
            const struct gm_entries *a = &single->entries[i], *b = &together->entries[i];
            assert_int_equal(a->count, b->count);
            assert_int_equal(a->kept, b->kept);
            assert_int_equal(a->every, b->every);
            assert_int_equal(a->skipped, b->skipped);
            assert_memory_equal(a->before, b->before, a->sections * sizeof(double));
            assert_memory_equal(a->times, b->times, a->count * sizeof(double));
            assert_memory_equal(a->steps, b->steps, a->count * sizeof *a->steps);
            assert_memory_equal(a->values, b->values, a->count * a->width * sizeof(double));
        }
        gm_lane_close(together);
        gm_lane_close(single);
    }
}

/* The laws of a variable mesh for u_tt = u_xx (Razafindralandy, Hamdouni & Chhay (2018), eqs. 67b and 67c), from three
   successive levels: e = (u_t^2 + u_x^2)/2 with forward differences in each cell. */
static void laws_of_a_variable_mesh(void **unused)
{
    (void)unused;
    enum { POINTS = 24, LEVELS = 3, BEFORE_THEM = 13 /* when the wave passes the end */ };
    struct gm_lane *lane = test_lane("wave points=24 courant=0.7 sharpness=2 scheme=leapfrog");
    double u[LEVELS][POINTS], e[LEVELS - 1][POINTS], energy = 0, momentum = 0, largest = 0, seen[5] = {0};
    static const char *const keys[] = {"energy_law_residual", "momentum_law_residual", "unknowns",
                                       "equations", "rank"};
    const double dt = lane->run->dt, dx = lane->problem.line.dx;
    for (size_t level = 0; level < LEVELS; level++) {
        gm_lane_to(lane, (int64_t)(BEFORE_THEM + level), 1e9);
        memcpy(u[level], gm_run_state(lane->run), sizeof u[level]);
        for (size_t k = 0; k < GM_COUNT(keys) && level == 1; k++) {
            seen[k] = test_observed(lane, keys[k]);
        }
    }
    for (size_t j = 0; j < POINTS; j++) {
        for (size_t level = 0; level + 1 < LEVELS; level++) {
            e[level][j] = (pow((u[level + 1][j] - u[level][j]) / dt, 2) +
                           pow((u[level][(j + 1) % POINTS] - u[level][j]) / dx, 2)) /
                          2;
        }
        energy = fmax(energy, fabs(e[1][j] - e[0][j]));
        largest = fmax(largest, e[1][j]);
    }
    for (size_t j = 0; j < POINTS; j++) {
        momentum = fmax(momentum, fabs(e[1][j] - e[1][(j + 1) % POINTS]));
    }
    assert_true(energy > 0.1 * largest && momentum > 0.1 * largest); /* the laws do not hold */
    assert_true(fabs(seen[0] - energy / largest) < 1e-12);
    assert_true(fabs(seen[1] - momentum / largest) < 1e-12);
    /* t, and x and u of every node; an equation for each of t, x, and u of a node; only t and the u are determined */
    assert_true(seen[2] == 2 * POINTS + 1 && seen[3] == 3 * POINTS && seen[4] == POINTS + 1);
    gm_lane_close(lane);
}

/* The momentum of a wave may be small, or 0: then its error is not relative. */
static void errors_of_a_small_momentum_are_absolute(void **unused)
{
    (void)unused;
    struct gm_lane *lane =
        test_lane("sine-gordon points=100 scheme=energy-conserving initial=kink velocity=0.1");
    const double before = gm_wave_momentum(&lane->problem, gm_run_state(lane->run));
    gm_lane_to(lane, 40, 1e9);
    const double change = fabs(gm_wave_momentum(&lane->problem, gm_run_state(lane->run)) - before);
    assert_true(change > 1e-9 && fabs(before) < 1);
    assert_true(fabs(test_observed(lane, "momentum_error") - change) < 1e-12);
    gm_lane_close(lane);
}

/* The earlier schemes of a lane are in the name that tells it from others: its colour's, or else its panel's. */
static void switches_are_in_one_name(void **unused)
{
    (void)unused;
    static const struct {
        const char *panel, *colour, *panel_after, *colour_after;
    } rows[] = {
        {"", "", "RK4, after Verlet", ""},
        {"e = 0.5", "", "RK4, e = 0.5, after Verlet", ""},
        {"", "Verlet, Δt = 0.1", "", "RK4, Δt = 0.1, after Verlet"},
        {"e = 0.5", "Verlet, Δt = 0.1", "e = 0.5", "RK4, Δt = 0.1, after Verlet"},
    };
    struct gm_lane *lane = test_lane("kepler scheme=verlet dt=0.1");
    char sentence[GM_MESSAGE];
    gm_lane_to(lane, 5, 1e9);
    assert_true(gm_lane_switch(lane, gm_scheme_find("rk4"), sentence));
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_shown named = {0};
        snprintf(named.panel_name, sizeof named.panel_name, "%s", rows[i].panel);
        snprintf(named.colour_name, sizeof named.colour_name, "%s", rows[i].colour);
        gm_lane_show(lane, &named);
        assert_string_equal(lane->shown.panel_name, rows[i].panel_after);
        assert_string_equal(lane->shown.colour_name, rows[i].colour_after);
    }
    gm_lane_close(lane);
}

/* The vertices of a room's outlet are of the kind that is chosen. */
static void outlets_are_chosen(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        enum gm_vertex_kind kind;
    } rows[] = {{"room rows=10 columns=14 tracers=0", GM_VERTEX_SOFT},
                {"room rows=10 columns=14 tracers=0 outlet=soft", GM_VERTEX_SOFT},
                {"room rows=10 columns=14 tracers=0 outlet=free", GM_VERTEX_OPEN}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_lane *lane = test_lane(rows[i].words);
        const struct gm_flow *flow = gm_flow_of(&lane->problem);
        size_t counts[2] = {0};
        for (size_t v = 0; v < flow->complex->vertices; v++) {
            counts[0] += flow->kind[v] == GM_VERTEX_SOFT;
            counts[1] += flow->kind[v] == GM_VERTEX_OPEN;
        }
        const size_t open = rows[i].kind == GM_VERTEX_OPEN;
        assert_true(counts[open] > 0 && counts[1 - open] == 0);
        gm_lane_close(lane);
    }
}

/* The names of a field's arrays: those of its parts, and of a second level only where a state has one. */
static void states_have_their_arrays(void **unused)
{
    (void)unused;
    static const struct {
        const char *words, *names;
    } rows[] = {{"burgers dx=0.1", "grid u"},
                {"nls points=16", "grid psi_re psi_im"},
                {"wave points=16", "grid u u_other other_time"},
                {"kdv points=16 scheme=zabusky-kruskal", "grid u u_other other_time"}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_lane *lane = test_lane(rows[i].words);
        struct gm_quantity quantities[GM_QUANTITIES];
        const size_t count = gm_quantities(lane->run, quantities);
        char names[200] = "";
        for (size_t k = 0; k < count; k++) {
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s%.40s", k > 0 ? " " : "",
                     quantities[k].name);
        }
        assert_string_equal(names, rows[i].names);
        gm_lane_close(lane);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_know_scenes),
        cmocka_unit_test(clocks_follow_the_step),
        cmocka_unit_test(packed_lanes_go_on),
        cmocka_unit_test(losses_are_told),
        cmocka_unit_test(excess_is_told),
        cmocka_unit_test(closed_problems_return),
        cmocka_unit_test(refused_memory_is_no_fault_of_a_mesh),
        cmocka_unit_test(channels_have_their_walls),
        cmocka_unit_test(damaged_bytes_are_refused),
        cmocka_unit_test(crossings_are_found_by_the_scheme),
        cmocka_unit_test(thinned_records_are_shown_at_every_step),
        cmocka_unit_test(stops_together),
        cmocka_unit_test(tracks_know_no_calls),
        cmocka_unit_test(switches_are_in_one_name),
        cmocka_unit_test(outlets_are_chosen),
        cmocka_unit_test(states_have_their_arrays),
        cmocka_unit_test(laws_of_a_variable_mesh),
        cmocka_unit_test(errors_of_a_small_momentum_are_absolute),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
