/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the lines of a system's file make of its scene: options of observables, exact solutions, requirements, texts
   with values, curves, graphs, figures and studies. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/model/equations.h"
#include "core/schemes.h"
#include "render/message.h"
#include "scenes/common/lane.h"
#include "scenes/common/system/look.h"
#include "scenes/common/system/variants.h"
#include "tests/common/lane.h"

#define OSCILLATOR                                                                                           \
    "coordinates: q\nmomenta: p\nparameter: k = 1; 0 .. 9\nH: (p^2 + k*q^2)/2\nstart: q = 1, p = 0\n"        \
    "view: q, p\ndt: pi/50\nuntil: 2*pi\n"

/* The scene of a text; NULL with a sentence. */
static const struct gm_scene *open_scene(const char *text, char *sentence)
{
    static const char *const words[] = {"system", NULL};
    struct gm_user_system system;
    struct gm_fault fault;
    if (!gm_equations_open(&system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    return gm_system_scene_open(&system, &(struct gm_system_origin){.name = "test", .words = words},
                                &(struct gm_system_opening){.fault = &fault, .sentence = sentence});
}

static const struct gm_scene *scene_of(const char *text)
{
    char sentence[GM_MESSAGE] = "";
    const struct gm_scene *scene = open_scene(text, sentence);
    if (!scene) {
        fail_msg("%s: %s", text, sentence);
    }
    return scene;
}

/* A lane with other values, "k=2 q=1", where they are settled. */
static struct gm_lane *lane_of(const struct gm_scene *scene, const char *values, const char *scheme,
                               char *sentence)
{
    static const struct gm_settings settings = {.binding = 20, .tau0 = 0.02};
    void *parameters = gm_scene_defaults(scene);
    const char *keys[8];
    char copy[200], *rest = NULL;
    size_t count = 0;
    snprintf(copy, sizeof copy, "%s", values);
    for (char *word = strtok_r(copy, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        char *value = strchr(word, '=');
        *value++ = '\0';
        assert_int_equal(gm_parameter_set(gm_scene_parameter(scene, word), parameters, value), GM_PARSED);
        keys[count++] = word;
    }
    struct gm_lane *lane = scene->settle(parameters, keys, count, sentence)
                               ? gm_lane_open(scene, parameters, &settings, gm_scheme_find(scheme), sentence)
                               : NULL;
    free(parameters);
    return lane;
}

static struct gm_lane *running(const struct gm_scene *scene, const char *values, const char *scheme,
                               double until)
{
    char sentence[GM_MESSAGE] = "";
    struct gm_lane *lane = lane_of(scene, values, scheme, sentence);
    if (!lane) {
        fail_msg("%s: %s", values, sentence);
    }
    for (int64_t steps = llround(until / lane->run->dt), i = 1; i <= steps; i++) {
        assert_int_equal(gm_lane_to(lane, i, until), GM_OK);
        gm_lane_record(lane);
    }
    return lane;
}

static void options_describe_observables(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of(OSCILLATOR "let: E = (p^2 + k*q^2)/2\ninvariant: energy2 = E; scale 3; title the same\n"
                            "observe: turn = atan2(p, q); title phase; unit rad; angle\n"
                            "observe: size = abs(q) + 1; log\n"
                            "observe: part = q; while q; missing q is not above 0\n"
                            "observe: other = turn + size; title both\n");
    const struct gm_observable *rows = scene->observables;
    assert_true(scene->observable_count >= 6);
    assert_string_equal(rows[1].key, "energy2_error");
    assert_string_equal(rows[1].title, "the same");
    assert_string_equal(rows[1].symbol, "E");
    assert_true(rows[1].least == 3 && rows[1].logarithmic && rows[1].error);
    assert_string_equal(rows[2].title, "phase");
    assert_string_equal(rows[2].unit, "rad");
    assert_true(rows[2].period == 2 * M_PI && !rows[2].logarithmic && scene->follow > 0);
    assert_true(rows[3].logarithmic && rows[3].period == 0);
    assert_string_equal(rows[3].title, "size");
    assert_string_equal(rows[4].missing, "q is not above 0");
    /* an angle is unwrapped over three turns, and a name with options is known to other lines */
    struct gm_lane *lane = running(scene, "", "gauss8", 6 * M_PI);
    assert_float_equal(test_observed(lane, "turn"), -6 * M_PI, 1e-6);
    assert_float_equal(test_observed(lane, "size"), 2, 1e-6);
    assert_float_equal(test_observed(lane, "part"), 1, 1e-6);
    gm_lane_close(lane);
    lane = running(scene, "", "gauss8", M_PI);
    assert_true(isnan(test_observed(lane, "part")));
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

#define KEPLER                                                                                               \
    "coordinates: q1 q2\nmomenta: p1 p2\nparameter: e = 0.5; 0 .. 0.9\nparameter: w = 0; -1 .. 1\n"          \
    "H: (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2) - w/(q1^2 + q2^2)\n"                                           \
    "start: q1 = 1 - e, q2 = 0, p1 = 0, p2 = sqrt((1 + e)/(1 - e))\nview: q1, q2\ndt: 2*pi/100\n"            \
    "observe: away = sqrt((q1 - exact(q1))^2 + (q2 - exact(q2))^2); missing with w\n"                        \
    "observe: there = exact(q1)\nobserve: first = q1(0)\n"

static void exact_solutions_are_values(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of(OSCILLATOR "exact: q = q(0)*cos(sqrt(k)*t)\n"
                            "observe: away = q - exact(q)\nobserve: p0 = exact(p)\n");
    struct gm_lane *lane = running(scene, "q=2", "explicit-euler", M_PI);
    const double q = gm_run_state(lane->run)[0];
    assert_true(fabs(test_observed(lane, "away") - (q - 2 * cos(lane->run->t))) < 1e-14);
    assert_true(fabs(test_observed(lane, "away")) > 1e-3 && isnan(test_observed(lane, "p0")));
    gm_lane_close(lane);
    gm_system_scene_close(scene);

    /* that of Kepler's part of H is known without a line */
    scene = scene_of(KEPLER);
    lane = running(scene, "", "gauss8", 5 * M_PI);
    assert_true(fabs(test_observed(lane, "there") + 1.5) < 1e-12);
    assert_true(test_observed(lane, "first") == 0.5);
    assert_true(test_observed(lane, "away") < 1e-6);
    gm_lane_close(lane);
    lane = running(scene, "w=0.1", "gauss8", 1);
    assert_true(isnan(test_observed(lane, "away")));
    gm_lane_close(lane);
    gm_system_scene_close(scene);

    /* in a start, too: at t = 0, and x(0) is the start of x */
    scene = scene_of("components: x y\nrate: x = -x, y = 0\nparameter: a = 3\nexact: x = a*exp(-t)\n"
                     "start: x = exact(x), y = 2*x(0)\n");
    lane = running(scene, "a=4", "rk4", 0);
    assert_true(gm_run_state(lane->run)[0] == 4 && gm_run_state(lane->run)[1] == 8);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

/* A membrane whose current is a function with an argument; the state is from an integrator of order 8 with tolerance
   1e-13. */
static void functions_are_called(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of("parameter: I = 0.1\nlet: m(v) = (1 + tanh((v + 0.01)/0.15))/2\n"
                 "rate: v = I + 0.5*(-0.5 - v) + 2*w*(-0.7 - v) - m(v)*(v - 1)\n"
                 "rate: w = 0.333*cosh((v - 0.1)/0.29)*((1 + tanh((v - 0.1)/0.145))/2 - w)\n"
                 "start: v = 0, w = 0\ndt: 0.05\n");
    struct gm_lane *lane = running(scene, "", "gauss8", 100);
    assert_float_equal(gm_run_state(lane->run)[0], 0.25239867, 5e-9);
    assert_float_equal(gm_run_state(lane->run)[1], 0.27887723, 5e-9);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

/* Several parameters on a line have the same range; lists need lines of their own. */
static void parameters_share_a_line(void **unused)
{
    (void)unused;
    const struct gm_scene *scene = scene_of(
        "components: x\nparameter: a = 1, b = max(2, c), c = 3; 0 .. 9; factors\nrate: x = a + 10*b + 100*c\n"
        "start: x = 0\ndt: 1\n");
    struct gm_lane *lane = running(scene, "c=4", "rk4", 1);
    assert_true(gm_run_state(lane->run)[0] == 441);
    gm_lane_close(lane);
    void *parameters = gm_scene_defaults(scene);
    assert_int_not_equal(gm_parameter_set(gm_scene_parameter(scene, "b"), parameters, "10"), GM_PARSED);
    free(parameters);
    gm_system_scene_close(scene);
}

/* x(0) in rates and lets is the start of the run, not of the file. */
static void starts_are_known(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of("components: x[1..2]\nrate: x[1] = x[2](0), x[2] = a\nlet: a = x[1]( 0 )\n"
                 "start: x[1] = 1, x[2] = 2\nobserve: off = x[1] - x[1](0)\ndt: 1\n");
    struct gm_lane *lane = running(scene, "x[1]=3", "rk4", 2);
    assert_true(gm_run_state(lane->run)[0] == 7 && gm_run_state(lane->run)[1] == 8);
    assert_true(test_observed(lane, "off") == 4);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

static void requirements_refuse(void **unused)
{
    (void)unused;
    char sentence[GM_MESSAGE] = "";
    const struct gm_scene *scene = scene_of(
        OSCILLATOR "parameter: E = 2\nrequire: E - q^2/2; with E = {E} there is no q={q}, and dt={dt:pi}\n");
    assert_null(lane_of(scene, "q=-2.5", "rk4", sentence));
    assert_string_equal(sentence, "with E = 2 there is no q=-2.5, and dt=π/50");
    struct gm_lane *lane = lane_of(scene, "q=-1.5", "rk4", sentence);
    assert_non_null(lane);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
    assert_null(open_scene(OSCILLATOR "require: -k; k is {k}\n", sentence));
    assert_string_equal(sentence, "k is 1");
}

static struct gm_picture *picture_of(struct gm_lane *const *lanes, size_t count)
{
    struct gm_picture *picture = gm_picture_open();
    assert_non_null(picture);
    gm_lanes_draw((const struct gm_lane *const *)lanes, count, picture);
    return picture;
}

static void derived_starts_follow(void **unused)
{
    (void)unused;
    static const char text[] = "coordinates: q\nmomenta: p\nparameter: E = 2; 0 .. 9\nH: (p^2 + q^2)/2\n"
                               "start: q = 1; -2 .. 2\nstart: p = sqrt(2*E - q^2); derived\n";
    const struct gm_scene *scene = scene_of(text);
    assert_non_null(gm_scene_parameter(scene, "q"));
    assert_null(gm_scene_parameter(scene, "p"));
    struct gm_lane *lane = running(scene, "q=1.5 E=3", "rk4", 0);
    assert_true(lane->start[0] == 1.5 && lane->start[1] == sqrt(6 - 2.25));
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

/* A sight that is chosen during a run shows all of it, as if it had been chosen before. */
static void sights_are_live(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of("coordinates: x y\nmomenta: u v\nH: (u^2 + v^2 + x^2)/2 + 2*y^2\n"
                 "start: x = 1, y = 0.5, u = 0, v = 1\nview: x, x*y\nrod: 0, 0; x, y\ndt: 0.1\n");
    const struct gm_parameter *show = gm_scene_parameter(scene, "show");
    assert_true(show->live);
    assert_null(strstr(show->help, "section"));
    struct gm_lane *before = running(scene, "show=x:u", "rk4", 5), *now = running(scene, "", "rk4", 5);
    assert_int_equal(gm_parameter_set(show, now->parameters, "x:u"), GM_PARSED);
    struct gm_picture *pictures[] = {picture_of(&before, 1), picture_of(&now, 1)};
    const struct gm_panel *panels[] = {pictures[0]->first, pictures[1]->first};
    assert_true(panels[0]->x.low == panels[1]->x.low && panels[0]->y.high == panels[1]->y.high);
    const struct gm_mark *mark = panels[0]->first, *other = panels[1]->first;
    size_t most = 0;
    for (; mark && other; mark = mark->next, other = other->next) {
        assert_int_equal(mark->count, other->count);
        assert_memory_equal(mark->points, other->points, 2 * mark->count * sizeof *mark->points);
        most = mark->count > most ? mark->count : most;
    }
    assert_true(!mark && !other && most >= 50);
    gm_picture_close(pictures[0]);
    gm_picture_close(pictures[1]);
    gm_lane_close(before);
    gm_lane_close(now);
    gm_system_scene_close(scene);
}

static void texts_hold_values(void **unused)
{
    (void)unused;
    static const char text[] = OSCILLATOR
        "name: A spring\ntitle: A spring by {schemes} for {t/(2*pi)} turns\n"
        "subtitle: k = {k}; start {q(0)}; {k/6:/} of it; q {-k:nonzero}; Δt = {dt:pi}; "
        "{k} spring{k:s}; {4*k} spring{4*k:s} in {dt*k}\n"
        "caption: {k - 1:nonzero}\ntime: a radian\nlevel: q^2 + p^2 - q(0)^2 - p(0)^2; the circle\n";
    const struct gm_scene *scene = scene_of(text);
    assert_string_equal(scene->title, "A spring");
    assert_string_equal(scene->time, "a radian");
    struct gm_lane *lanes[] = {running(scene, "", "rk4", 2 * M_PI), running(scene, "q=2", "rk4", 2 * M_PI)};
    struct gm_picture *picture = picture_of(lanes, 1);
    assert_string_equal(picture->title, "A spring by RK4 for 1 turns");
    assert_string_equal(picture->subtitle,
                        "k = 1,  start 1,  1/6 of it,  q −1,  Δt = π/50,  1 spring,  4 springs in 0.06283"
                        ";  grey: the circle");
    assert_string_equal(picture->caption, "");
    gm_picture_close(picture);
    picture = picture_of(lanes, 2);
    assert_string_equal(picture->subtitle,
                        "k = 1,  1/6 of it,  q −1,  Δt = π/50,  1 spring,  4 springs in 0.06283"
                        ";  grey: the circle");
    gm_picture_close(picture);
    gm_lane_close(lanes[1]);
    lanes[1] = running(scene, "", "gauss4", 2 * M_PI);
    picture = picture_of(lanes, 2);
    assert_string_equal(picture->title, "A spring by two schemes for 1 turns");
    gm_picture_close(picture);
    gm_lane_close(lanes[1]);
    gm_lane_close(lanes[0]);
    gm_system_scene_close(scene);
}

/* Asserts that all points of the grey lines of a panel have this distance from the origin. Returns the first line. */
static const struct gm_mark *circle_of(const struct gm_panel *panel, double radius)
{
    const struct gm_mark *first = NULL;
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        const bool grey = mark->kind == GM_MARK_LINE && mark->style.role == GM_EXACT;
        for (size_t i = 0; grey && i < mark->count; i++) {
            assert_float_equal(hypot(mark->points[2 * i], mark->points[2 * i + 1]), radius, 0.01);
        }
        first = grey && !first ? mark : first;
    }
    assert_non_null(first);
    return first;
}

/* Levels are traced once for lanes of the same system and start, and each panel shows those of its own lane. */
static void levels_are_shared_by_equal_lanes(void **unused)
{
    (void)unused;
    const struct gm_scene *scene = scene_of(OSCILLATOR "level: q^2 + p^2 - q(0)^2 - p(0)^2; the circle\n");
    struct gm_lane *lanes[] = {running(scene, "", "rk4", 2), running(scene, "", "gauss4", 2),
                               running(scene, "q=2", "rk4", 2)};
    for (size_t i = 0; i < GM_COUNT(lanes); i++) {
        lanes[i]->shown.panel = i;
    }
    struct gm_picture *picture = picture_of(lanes, GM_COUNT(lanes));
    const struct gm_panel *panel = picture->first;
    const struct gm_mark *circle = circle_of(panel, 1);
    assert_ptr_equal(circle_of(panel->next, 1)->points, circle->points);
    circle_of(panel->next->next, 2);
    gm_picture_close(picture);
    lanes[1]->start[0] = 1.5; /* as after a click into the picture */
    picture = picture_of(lanes, GM_COUNT(lanes));
    circle_of(picture->first, 1);
    circle_of(picture->first->next, 1.5);
    gm_picture_close(picture);
    for (size_t i = 0; i < GM_COUNT(lanes); i++) {
        gm_lane_close(lanes[i]);
    }
    gm_system_scene_close(scene);
}

/* Curves over time have their titles in the picture. */
static void curves_have_titles(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of("coordinates: q\nmomenta: p\nH: (p^2 + q^2)/2\nstart: q = 1, p = 0\n"
                 "view: t, q; title the place\nview: t, p\ndt: pi/50\n");
    struct gm_lane *lane = running(scene, "", "rk4", 2 * M_PI);
    struct gm_picture *picture = picture_of(&lane, 1);
    size_t titles = 0;
    for (const struct gm_mark *mark = picture->first->first; mark; mark = mark->next) {
        titles += mark->kind == GM_MARK_TEXT && strcmp(mark->text, "the place") == 0;
    }
    assert_int_equal(titles, 1);
    gm_picture_close(picture);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

/* How far the grey lines of a panel reach, and how far they are from the circle of that radius at most. */
static double grey_reach(const struct gm_panel *panel, double radius, double *away)
{
    double reach = 0;
    *away = 0;
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        for (size_t i = 0; i < mark->count && mark->style.role == GM_EXACT; i++) {
            const double r = hypot(mark->points[2 * i], mark->points[2 * i + 1]);
            reach = fmax(reach, r);
            *away = fmax(*away, fabs(r - radius));
        }
    }
    return reach;
}

static void levels_are_drawn(void **unused)
{
    (void)unused;
    double away;
    const struct gm_scene *scene = scene_of(
        OSCILLATOR "level: q^2 + p^2 - q(0)^2 - p(0)^2; the circle\nlevel: q - 99; a line; while k - 1\n");
    /* at once, before the motion has shown its range */
    struct gm_lane *lane = running(scene, "q=1.5", "rk4", 0);
    struct gm_picture *picture = picture_of(&lane, 1);
    const struct gm_panel *panel = picture->first;
    assert_float_equal(grey_reach(panel, 1.5, &away), 1.5, 1e-3);
    assert_true(away < 1e-3);
    assert_true(panel->x.low <= -1.5 && panel->x.high >= 1.5 && panel->y.low <= -1.5 && panel->y.high >= 1.5);
    assert_true(panel->x.low >= -3 && panel->x.high <= 3);
    gm_picture_close(picture);
    gm_lane_close(lane);
    gm_system_scene_close(scene);

    /* around a start that lies inside, in the section; another branch is not followed */
    scene = scene_of(
        "coordinates: x y\nmomenta: u v\nparameter: E = 1/6\nH: (u^2 + v^2 + x^2 + y^2)/2 + x^2*y - y^3/3\n"
        "start: x = 0, y = 0, v = 0, u = sqrt(2*E)\nsection: x = 0, u > 0; y, v\n"
        "level: section; E - y^2/2 + y^3/3 - v^2/2; the border\ndt: 0.1\n");
    lane = running(scene, "", "rk4", 1);
    picture = picture_of(&lane, 1);
    panel = picture->last;
    assert_string_equal(panel->title, "Poincaré section");
    assert_true(panel->x.low <= -0.5 && panel->x.low > -0.8 && panel->x.high >= 0.95 && panel->x.high < 1.4);
    assert_true(panel->y.high >= sqrt(1. / 3) && panel->y.high < 0.9 && panel->equal);
    assert_true(grey_reach(panel, 0, &away) > 0.9);
    gm_picture_close(picture);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

static void graphs_are_those_of_the_file(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of(OSCILLATOR "observe: size = q^2 + 1; title the size; unit m\nobserve: rest = p\n"
                            "graph: size; 1e-3 .. 1e3; log; highest; relative\n"
                            "graph: rest; -9 .. 9; title what is left\n");
    struct gm_lane *lane = running(scene, "", "rk4", 0.5);
    struct gm_picture *picture = picture_of(&lane, 1);
    const struct gm_panel *first = picture->first->next, *second = first->next;
    assert_string_equal(first->title, "the size, m");
    assert_true(first->y.scale == GM_LOG && first->y.low <= 1e-3 && first->y.high >= 1e3);
    assert_string_equal(second->title, "what is left");
    assert_true(second->y.scale == GM_LINEAR && second->y.low <= -9 && second->y.high >= 9);
    assert_null(second->next);
    gm_picture_close(picture);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

static void studies_are_those_of_the_file(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of(OSCILLATOR "observe: far = abs(q)\nfigure: paper-1; scheme=rk4 dt=.1; it grows\n"
                            "work: until=3 k=2; measure far; coarsest pi/4; halvings 5; errors .1, .01, .001"
                            "; reference gauss8; solves gauss4; schemes rk4 verlet\n"
                            "stability: until=9; k 1/2, 1, 4; unit 2*pi/sqrt(k) = h / T; steps 1/8, 0.5"
                            "; lost energy_error; wrong far; settle 40; largest; schemes rk4\n");
    assert_int_equal(scene->figure_count, 1);
    assert_string_equal(scene->figures[0].name, "paper-1");
    assert_string_equal(scene->figures[0].arguments, "scheme=rk4 dt=.1");
    assert_string_equal(scene->figures[0].statement, "it grows");
    const struct gm_work *work = scene->work;
    assert_string_equal(work->arguments, "until=3 k=2");
    assert_string_equal(work->measure, "far");
    assert_string_equal(work->reference, "gauss8");
    assert_string_equal(work->is_exact, "gauss4");
    assert_true(work->coarsest == M_PI / 4 && work->halvings == 5 && work->errors[2] == .001);
    assert_string_equal(work->schemes[1], "verlet");
    assert_null(work->schemes[2]);
    const struct gm_stability *map = scene->stability;
    assert_string_equal(map->arguments, "until=9");
    assert_string_equal(map->parameter, "k");
    assert_string_equal(map->label, "h / T");
    assert_string_equal(map->kept, "energy_error");
    assert_string_equal(map->error, "far");
    assert_true(map->value_count == 3 && map->values[0] == 0.5 && map->step_count == 2 &&
                map->steps[0] == 0.125);
    assert_true(map->settle == 40 && map->throughout && !map->told && !map->schemes[1]);
    struct gm_lane *lane = running(scene, "k=4", "rk4", 0);
    assert_true(fabs(map->unit(lane->parameters) - M_PI) < 1e-15);
    gm_lane_close(lane);
    gm_system_scene_close(scene);

    scene = scene_of(OSCILLATOR "work: ; halvings 1\n");
    assert_int_equal(scene->work->halvings, 1);
    gm_system_scene_close(scene);
    /* without a line, a field is followed as long as its lanes are */
    scene = scene_of("field: u\nV: u^2/2\nstart: u = exp(-x^2), u_t = 0\n");
    assert_int_equal(scene->work->halvings, 5);
    assert_string_equal(scene->work->arguments, "");
    gm_system_scene_close(scene);
    scene = scene_of(OSCILLATOR "stability: until=9; k 1, 2; steps usual; schemes usual\n");
    assert_true(scene->stability->step_count > 2 && !scene->stability->schemes &&
                !scene->stability->throughout);
    assert_string_equal(scene->stability->label, "h ω");
    gm_system_scene_close(scene);
}

/* A cell of a flow without divergence has one volume, and of one that shrinks every length by exp(-t) that of exp(-3 t). */
static void hooks_join(void **unused)
{
    (void)unused;
    static const char *const texts[] = {"rate: x = sin(z), y = sin(x), z = sin(y)\n",
                                        "rate: x = -x, y = -y, z = -z\n"};
    for (int i = 0; i < 2; i++) {
        char text[300];
        snprintf(
            text, sizeof text, "components: x y z\n%sstart: x = 0.5, y = 1, z = -0.4\ndt: 0.1\n%s", texts[i],
            "hook: cell\nobserve: place = x\ngraph: log_volume; log; to-last\nstability: none; missing it ends\n");
        const struct gm_scene *scene = scene_of(text);
        assert_null(scene->stability);
        assert_non_null(strstr(scene->no_stability, "it ends; "));
        assert_null(gm_scene_parameter(scene, "members"));
        assert_non_null(gm_scene_parameter(scene, "show"));
        struct gm_lane *lane = running(scene, "", "gauss8", 1);
        assert_float_equal(test_observed(lane, "log_volume"), i == 0 ? 0 : -3, 1e-6);
        assert_true(test_observed(lane, "place") == gm_run_state(lane->run)[0]);
        struct gm_picture *picture = picture_of(&lane, 1);
        gm_picture_close(picture);
        gm_lane_close(lane);
        gm_system_scene_close(scene);
    }
    char sentence[GM_MESSAGE];
    assert_null(open_scene(OSCILLATOR "hook: cell\n", sentence));
    assert_string_equal(sentence, "the hook \"cell\" is for three components without the time");
    assert_null(open_scene(OSCILLATOR "hook: no\n", sentence));
    assert_string_equal(sentence, "hook: there is no hook \"no\"");
}

/* Tangents are the derivatives of a step over its start: as differences of two near runs, of a rate and of H, with lists,
   a force and the time. Their area is that of Liouville. */
static void tangents_are_derivatives(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *names, *scheme;
        size_t motion, list, tangents; /* components, in lists of so many */
        double area;                   /* at t = 1; NaN: none */
    } rows[] = {
        {"coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nforce: q = -p/5\n", "q xi1_q xi2_q p xi1_p xi2_p",
         "rk4", 2, 1, 2, 0.818730753},
        {"coordinates: x[1..2]\nH: (p_x[1]^2 + p_x[2]^2)/2 + (x[1] - x[2])^4 + x[1]^2\n",
         "x[1] x[2] xi1_x[1] xi1_x[2] xi2_x[1] xi2_x[2] p_x[1] p_x[2] xi1_p_x[1] xi1_p_x[2] xi2_p_x[1] xi2_p_x[2]",
         "verlet", 4, 2, 2, 1},
        {"components: a b\nrate: a = sin(b)*t\nrate: b = -a - b\n", "a b xi1_a xi1_b xi2_a xi2_b", "rk4", 2,
         2, 2, 0.367879441},
        {"components: a b c\nrate: a = b*c\nrate: b = -a\nrate: c = a*b\n", "a b c xi1_a xi1_b xi1_c",
         "midpoint", 3, 3, 1, NAN},
    };
    for (size_t row = 0; row < GM_COUNT(rows); row++) {
        char text[600], line[64] = "";
        const size_t n = rows[row].motion, list = rows[row].list, each = list * (1 + rows[row].tangents);
        const char *const names[][4] = {
            {"q", "p"}, {"x[1]", "x[2]", "p_x[1]", "p_x[2]"}, {"a", "b"}, {"a", "b", "c"}};
        size_t used = 0;
        for (size_t c = 0; c < n; c++) {
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s = %g",
                                     c ? ", " : "start: ", names[row][c], 0.4 + 0.3 * (double)c);
        }
        snprintf(text + used, sizeof text - used, "\ndt: 0.05\n%stangents: %zu\n", rows[row].text,
                 rows[row].tangents);
        const struct gm_scene *scene = scene_of(text);
        struct gm_lane *lane = running(scene, "", rows[row].scheme, 1);
        const double *y = gm_run_state(lane->run);
        char told[200] = "";
        const struct gm_user_system *system =
            &((const struct gm_system_lane *)lane->parameters)->owner->system;
        for (size_t i = 0, at = 0; i < system->n; i++) {
            at += (size_t)snprintf(told + at, sizeof told - at, "%s%s", i ? " " : "",
                                   system->variables[i].name);
        }
        assert_string_equal(told, rows[row].names);
        for (size_t k = 0; k < rows[row].tangents; k++) {
            /* the first tangent starts along the first coordinate, the second along its momentum */
            const size_t along = list < n ? k % 2 * list + k / 2 : k;
            double ends[2][4];
            for (int side = 0; side < 2; side++) {
                snprintf(line, sizeof line, "%s=%.10g", names[row][along],
                         0.4 + 0.3 * (double)along + (side ? 1e-5 : -1e-5));
                struct gm_lane *near = running(scene, line, rows[row].scheme, 1);
                for (size_t c = 0; c < n; c++) {
                    ends[side][c] = gm_run_state(near->run)[c / list * each + c % list];
                }
                gm_lane_close(near);
            }
            for (size_t c = 0; c < n; c++) {
                const double slope = (ends[1][c] - ends[0][c]) / 2e-5;
                assert_float_equal(y[c / list * each + (1 + k) * list + c % list], slope, 1e-8);
            }
        }
        if (isnan(rows[row].area)) {
            assert_int_equal(gm_scene_observable(scene, "area_tangent"), -1);
        } else {
            assert_float_equal(test_observed(lane, "area_tangent"), rows[row].area, 1e-6);
        }
        assert_null(gm_scene_parameter(scene, "xi1_a")); /* a tangent's start is no key */
        gm_lane_close(lane);
        gm_system_scene_close(scene);
    }
}

#define PLANE                                                                                                \
    "coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 0.2, p = 1\nangle: q\ndt: 0.1\nuntil: 3\n"

/* The keys of an ensemble have the file's names and ranges; a key with a name does not count the centre. */
static void ensembles_have_keys(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of(PLANE "members: points = 4*2; 3 .. 50; on the edge\nspread: radius = 0.3; 0.1 .. 1\n");
    const struct gm_parameter *points = gm_scene_parameter(scene, "points"),
                              *radius = gm_scene_parameter(scene, "radius");
    assert_non_null(points);
    assert_non_null(radius);
    assert_true(points->lowest == 3 && points->highest == 50 && radius->lowest == 0.1 &&
                radius->highest == 1);
    assert_string_equal(points->help, "on the edge");
    assert_string_equal(points->standard, "4*2");
    assert_null(gm_scene_parameter(scene, "members"));
    assert_null(gm_scene_parameter(scene, "spread"));
    struct gm_lane *lane = running(scene, "points=5 radius=0.5", "rk4", 0);
    const double *y = gm_run_state(lane->run);
    assert_int_equal(lane->problem.m, 6);
    assert_true(y[5] == 0.2 && y[0] == 0.7 && y[11] == 1);
    gm_lane_close(lane);
    gm_system_scene_close(scene);

    scene = scene_of(PLANE "members: 9; 5 .. 20\nspread: 0.3\n");
    lane = running(scene, "", "rk4", 0);
    assert_int_equal(lane->problem.m, 9);
    assert_float_equal(gm_run_state(lane->run)[0], 0.5, 1e-15);
    assert_true(gm_scene_parameter(scene, "members")->highest == 20);
    gm_lane_close(lane);
    gm_system_scene_close(scene);
}

/* A word of show= draws a plane, or one graph, alone. The edge of a disc with tangents is curved, and an angle's outline is
   drawn once for each turn. */
static void pictures_are_named(void **unused)
{
    (void)unused;
    const struct gm_scene *scene =
        scene_of(PLANE "members: points = 8; 3 .. 50\ntangents: 2\nview: q, p; show plane\n"
                       "graph: area; relative; log\ngraph: energy_error; log; show law\n");
    static const struct {
        const char *show;
        size_t panels, corners; /* points of the last closed line in the first panel; 0: none */
    } rows[] = {{"show=all", 3, 1024}, {"show=plane", 1, 1024}, {"show=law", 1, 0}};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_lane *lane = running(scene, rows[i].show, "verlet", 1);
        struct gm_picture *picture = picture_of(&lane, 1);
        size_t corners = 0, panels = 0;
        for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
            panels++;
        }
        assert_int_equal(panels, rows[i].panels);
        for (const struct gm_mark *mark = picture->first->first; mark; mark = mark->next) {
            corners = mark->closed ? mark->count : corners;
        }
        assert_int_equal(corners, rows[i].corners);
        gm_picture_close(picture);
        gm_lane_close(lane);
    }
    gm_system_scene_close(scene);
}

/* What a file claims about its scene, and what is wrong with it. */
static void what_is_wrong_is_named(void **unused)
{
    (void)unused;
    static const struct {
        const char *line, *sentence;
    } wrong[] = {
        {"caption: {scheme}\n", "caption: {scheme} is not a value of this system"},
        {"level: q + t; grey\n", "level: t is not shown: a curve holds q and p"},
        {"graph: energy; log\n", "graph: energy is not an observable"},
        {"work: ; measure far\n", "work: far is not an observable"},
        {"work: ; solves verlt\n", "work: verlt is not a scheme"},
        {"work: ; errors 1, 2, 3\n", "work: errors are three numbers that fall"},
        {"work: ; coarsest -1\n", "work: a ladder of steps begins above 0"},
        {"work: ; halvings 0\n", "work: a ladder of steps begins above 0"},
        {"work: ; schemes verlt\n", "schemes: verlt is not a scheme"},
        {"stability: until=1\n", "stability: a parameter and its values are missing"},
        {"stability: ; g 1, 2\n", "stability: g is not a parameter"},
        {"stability: ; k 1, 12\n", "stability: k lies between 0 and 9, and one of its values is 12"},
        {"stability: ; k 1, 2; steps 0, 1\n", "stability: a step is above 0"},
        {"stability: ; k 1, 2; lost far\n", "stability: far is not an observable"},
    };
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        char text[600], sentence[GM_MESSAGE] = "";
        snprintf(text, sizeof text, OSCILLATOR "%s", wrong[i].line);
        if (open_scene(text, sentence) || !strstr(sentence, wrong[i].sentence)) {
            fail_msg("%s: %s", wrong[i].line, sentence);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_describe_observables),
        cmocka_unit_test(exact_solutions_are_values),
        cmocka_unit_test(functions_are_called),
        cmocka_unit_test(parameters_share_a_line),
        cmocka_unit_test(starts_are_known),
        cmocka_unit_test(requirements_refuse),
        cmocka_unit_test(derived_starts_follow),
        cmocka_unit_test(sights_are_live),
        cmocka_unit_test(texts_hold_values),
        cmocka_unit_test(levels_are_shared_by_equal_lanes),
        cmocka_unit_test(curves_have_titles),
        cmocka_unit_test(levels_are_drawn),
        cmocka_unit_test(graphs_are_those_of_the_file),
        cmocka_unit_test(studies_are_those_of_the_file),
        cmocka_unit_test(hooks_join),
        cmocka_unit_test(tangents_are_derivatives),
        cmocka_unit_test(ensembles_have_keys),
        cmocka_unit_test(pictures_are_named),
        cmocka_unit_test(what_is_wrong_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
