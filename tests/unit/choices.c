/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Choices of words in a system's file: which lines hold, one table of keys for all words, and what is wrong with them. */
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
#include "scenes/common/system/variants.h"
#include "tests/common/lane.h"

/* One mass on a spring, or two beside each other of which the second is at rest. */
static const char springs[] = "choice: masses = one of one, two; how many there are\n"
                              "parameter: k = 1; 0 .. 4; stiffness\n"
                              "coordinates: q\n"
                              "momenta: p\n"
                              "H: (p^2 + k*q^2)/2\n"
                              "start: q = 1, p = 0\n"
                              "observe: size = q\n"
                              "when: masses = two\n"
                              "parameter: k = 9; 0 .. 16; stiffness\n"
                              "parameter: c = 2; 0 .. 5; of the second\n"
                              "coordinates: q r\n"
                              "momenta: p s\n"
                              "H: (p^2 + k*q^2 + s^2 + c*r^2)/2\n"
                              "start: q = 1, r = 0, p = 0, s = 0\n"
                              "observe: other = r\n"
                              "when: masses = one\n"
                              "observe: speed = p\n"
                              "when: always\n"
                              "dt: 0.01\n"
                              "until: 1\n"
                              "schemes: gauss8\n";

static const struct gm_scene *open_scene(const char *text, struct gm_fault *fault, char *sentence)
{
    static const char *const words[] = {"system", NULL};
    struct gm_user_system system;
    if (!gm_equations_open(&system, text, strlen(text), NULL, 0, fault)) {
        gm_system_close(&system);
        snprintf(sentence, GM_MESSAGE, "%s", fault->sentence);
        return NULL;
    }
    return gm_system_scene_open(&system, &(struct gm_system_origin){.name = "test", .words = words},
                                &(struct gm_system_opening){.fault = fault, .sentence = sentence});
}

static struct gm_lane *lane_of(const struct gm_scene *scene, const char *key, const char *word)
{
    static const struct gm_settings settings = {.binding = 20, .tau0 = 0.02};
    char sentence[GM_MESSAGE] = "";
    void *parameters = gm_scene_defaults(scene);
    assert_non_null(parameters);
    assert_int_equal(gm_parameter_set(gm_scene_parameter(scene, key), parameters, word), GM_PARSED);
    assert_true(scene->settle(parameters, &key, 1, sentence));
    struct gm_lane *lane = gm_lane_open(scene, parameters, &settings, gm_scheme_find("gauss8"), sentence);
    free(parameters);
    assert_non_null(lane);
    assert_int_equal(gm_lane_to(lane, 100, 1), GM_OK);
    gm_lane_record(lane);
    return lane;
}

static const char *missing(const struct gm_lane *lane, const char *key)
{
    return gm_lane_missing(lane, (size_t)gm_scene_observable(lane->scene, key));
}

static void words_choose_systems(void **unused)
{
    (void)unused;
    struct gm_fault fault;
    char sentence[GM_MESSAGE] = "";
    const struct gm_scene *scene = open_scene(springs, &fault, sentence);
    if (!scene) {
        fail_msg("%s", sentence);
    }
    const struct gm_parameter *row = gm_scene_parameter(scene, "masses");
    assert_string_equal(row->help, "how many there are");
    assert_string_equal(row->standard, "one");
    assert_string_equal(row->choices[1], "two");
    assert_non_null(gm_scene_parameter(scene, "c"));
    assert_non_null(gm_scene_parameter(scene, "r"));
    assert_true(gm_scene_parameter(scene, "k")->highest == 16);

    struct gm_lane *one = lane_of(scene, "masses", "one"), *two = lane_of(scene, "masses", "two");
    assert_int_equal(one->problem.n, 2);
    assert_int_equal(two->problem.n, 4);
    assert_int_equal(one->scene->observable_count, two->scene->observable_count);
    assert_int_equal(one->scene->size, two->scene->size);
    for (size_t i = 0; i < one->scene->observable_count; i++) {
        assert_string_equal(one->scene->observables[i].key, two->scene->observables[i].key);
    }
    assert_float_equal(test_observed(one, "size"), cos(1), 1e-12);
    assert_float_equal(test_observed(two, "size"), cos(3), 1e-12); /* the block's own k */
    assert_float_equal(test_observed(one, "speed"), -sin(1), 1e-12);
    assert_float_equal(test_observed(two, "other"), 0, 1e-15);
    assert_true(isnan(test_observed(one, "other")) && isnan(test_observed(two, "speed")));
    assert_string_equal(missing(one, "other"), "it is not defined with masses=one");
    assert_string_equal(missing(two, "speed"), "it is not defined with masses=two");
    assert_string_equal(scene->idle(one->parameters, "c"), "it is not defined with masses=one");
    assert_null(scene->idle(two->parameters, "c"));
    gm_lane_close(one);
    gm_lane_close(two);
    gm_system_scene_close(scene);
}

/* Two choices: a pair of words is made when it is first asked for, and once. */
static void choices_are_combined(void **unused)
{
    (void)unused;
    static const char text[] =
        "choice: branch = plus of plus, minus\nchoice: power = first of first, second\n"
        "rate: x = x\nstart: x = 1\ndt: 0.01\nuntil: 1\nschemes: gauss8\n"
        "let: f = 1\nlet: g = 1\n"
        "when: branch = minus\nlet: f = -1\nobserve: lower = f\n"
        "when: always\nwhen: power = second\nlet: g = 2\nobserve: twice = g\n"
        "when: always\nrate: y = f*g\nstart: y = 0\n";
    struct gm_fault fault;
    char sentence[GM_MESSAGE] = "";
    const struct gm_scene *scene = open_scene(text, &fault, sentence);
    if (!scene) {
        fail_msg("%s", sentence);
    }
    static const struct {
        const char *branch, *power;
        double y;
        const char *lower, *twice; /* why there is no such observable */
    } rows[] = {
        {"plus", "first", 1, "it is not defined with branch=plus", "it is not defined with power=first"},
        {"minus", "first", -1, NULL, "it is not defined with power=first"},
        {"plus", "second", 2, "it is not defined with branch=plus", NULL},
        {"minus", "second", -2, NULL, NULL},
        {"minus", "second", -2, NULL, NULL}};
    const struct gm_scene *last = NULL;
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        static const struct gm_settings settings = {.binding = 20};
        const char *const keys[] = {"branch", "power"};
        void *parameters = gm_scene_defaults(scene);
        gm_parameter_set(gm_scene_parameter(scene, "branch"), parameters, rows[i].branch);
        gm_parameter_set(gm_scene_parameter(scene, "power"), parameters, rows[i].power);
        assert_true(scene->settle(parameters, keys, 2, sentence));
        struct gm_lane *lane = gm_lane_open(scene, parameters, &settings, gm_scheme_find("gauss8"), sentence);
        assert_int_equal(gm_lane_to(lane, 100, 1), GM_OK);
        assert_float_equal(gm_run_state(lane->run)[1], rows[i].y, 1e-12);
        assert_true(i < 4 || lane->scene == last);
        const char *const reasons[] = {missing(lane, "lower"), missing(lane, "twice")};
        assert_true(!rows[i].lower == !reasons[0] && !rows[i].twice == !reasons[1]);
        assert_string_equal(reasons[0] ? reasons[0] : "", rows[i].lower ? rows[i].lower : "");
        assert_string_equal(reasons[1] ? reasons[1] : "", rows[i].twice ? rows[i].twice : "");
        last = lane->scene;
        gm_lane_close(lane);
        free(parameters);
    }
    gm_system_scene_close(scene);
}

/* Two words may contradict each other alone; more than sixteen rows may decide which system it is. */
static void combinations_are_checked(void **unused)
{
    (void)unused;
    char text[4000] = "choice: a = p of p, q\nchoice: b = r of r, s\n", sentence[GM_MESSAGE] = "";
    size_t used = strlen(text);
    for (int i = 0; i < 20; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "parameter: n%d = 1; 1 .. 3\n", i);
    }
    snprintf(
        text + used, sizeof text - used, "%s",
        "rate: x = x\nstart: x = 1\nlet: f = 1\nobserve: size = sum(i = 1 .. n0, 1) + sum(i = 1 .. n19, 1)"
        "\nwhen: a = q\nlet: f = 2\nwhen: always\nwhen: b = s\nlet: f = 3\nwhen: always\n");
    for (int i = 1; i < 19; i++) {
        used = strlen(text);
        snprintf(text + used, sizeof text - used, "observe: z%d = sum(i = 1 .. n%d, 1)\n", i, i);
    }
    struct gm_fault fault;
    struct gm_user_system system;
    assert_true(gm_equations_open(&system, text, strlen(text), NULL, 0, &fault));
    const struct gm_scene *scene =
        gm_system_scene_open(&system, &(struct gm_system_origin){.name = "test"},
                             &(struct gm_system_opening){.fault = &fault, .sentence = sentence});
    if (!scene) {
        fail_msg("%s", sentence);
    }
    const char *const keys[] = {"a", "b", "n19"};
    void *parameters = gm_scene_defaults(scene);
    gm_parameter_set(gm_scene_parameter(scene, "a"), parameters, "q");
    gm_parameter_set(gm_scene_parameter(scene, "n19"), parameters, "3");
    assert_true(scene->settle(parameters, keys, 3, sentence));
    assert_string_equal(sentence, "");
    const struct gm_scene *const made = scene->variant(parameters);
    assert_true(made != scene && gm_parameter_get(gm_scene_parameter(made, "n19"), made->initial) == 3);
    gm_parameter_set(gm_scene_parameter(scene, "b"), parameters, "s");
    assert_false(scene->settle(parameters, keys, 3, sentence));
    assert_string_equal(sentence, "line 31: with a=q, b=s: f is defined twice");
    free(parameters);
    gm_system_scene_close(scene);
}

#define HEAD "choice: kind = a of a, b\nchoice: other = u of u, v\nrate: x = -x\nstart: x = 1\n"

static void what_is_wrong_is_named(void **unused)
{
    (void)unused;
    static const struct {
        const char *lines, *at, *sentence;
    } wrong[] = {
        {"when: knd = b\nlet: y = 1\n", "knd", "there is no choice \"knd\"; did you mean kind"},
        {"when: other = w\nlet: y = 1\n", "w\nlet", "there is no word \"w\""},
        {"when: other = u, vv\nlet: y = 1\n", "vv", "there is no word \"vv\"; did you mean v"},
        {"when: kind = \nlet: y = 1\n", NULL, "a word was expected"},
        {"when: = a\nlet: y = 1\n", "= a\nlet", "a choice was expected"},
        {"when: kind = b\nwhen: always\n", "kind = b\nwhen", "this block has no lines"},
        {"when: kind = b\n", "kind = b\n", "this block has no lines"},
        {"when: kind = b\nlet: y = 1\nwhen: other = v\nlet: z = 1\n", "other = v\nlet",
         "a block of other is inside one of kind: end that by \"when: always\""},
        {"when: kind = b\nchoice: c = p of p, q\n", "choice: c", "a choice belongs outside of blocks"},
        {"let: y = kind + 1\n", "kind + 1",
         "kind is a choice of words: write lines below \"when: kind = ...\""},
        {"parameter: kind = 1\n", "kind = 1", "kind is defined twice"},
        {"choice: kind = p of p, q\n", "kind = p of", "kind is defined twice"},
        {"choice: c = p\n", "c = p", "a choice has a name, a default and words"},
        {"choice: c of p, q\n", "c of p", "a choice has a name, a default and words"},
        {"choice: c = p of p\n", "c = p of", "a choice has at least two words"},
        {"choice: c = r of p, q\n", "r of", "there is no word \"r\""},
        {"choice: c =  of p, q\n", NULL, "a word was expected"},
        {"choice: c = p of p, q, p\n", "p\n", "p is named twice"},
        {"choice: 1c = p of p, q\n", "1c", "the name of a choice has 1 to 31 letters, digits and _"},
        {"choice: c = p of p, q r\n", "q r", "a word of a choice has 1 to 31 bytes without blanks"},
        {"choice: c = p of p, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, q\n", "q\n",
         "a choice has at most 16 words"},
        {"choice: show = p of p, q\n", "show", "the name show is reserved"},
        {"choice: H = p of p, q\n", "H = p", "the name H is reserved"},
        {"choice: lanes = p of p, q\n", "lanes = p", "the name lanes is reserved"},
        {"choice: lyapunov = p of p, q\n", NULL, "choice: lyapunov is an observable of this system"},
        {"choice: azimuth = p of p, q\n", "azimuth = p", "the name azimuth is reserved"},
        {"when: kind = b\nrate: x = zz\n", "zz", "with kind=b: there is no name zz"},
        {"when: kind = b\nrate: y = x\n", "x = 1", "with kind=b: y has no value at the start"},
        {"when: kind = b\nstart: y = 1\n", "y = 1", "with kind=b: there is no name y"},
        {"compile: kind = c\n", "kind = c", "compile: kind has no word c"},
    };
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        char text[600], sentence[GM_MESSAGE] = "";
        struct gm_fault fault = {0};
        snprintf(text, sizeof text, HEAD "%s", wrong[i].lines);
        const char *place = wrong[i].at ? strstr(text, wrong[i].at) : NULL;
        const struct gm_scene *scene = open_scene(text, &fault, sentence);
        if (scene || !strstr(sentence, wrong[i].sentence)) {
            fail_msg("%s: %s", wrong[i].lines, sentence);
        }
        if (place && fault.offset != (size_t)(place - text)) {
            fail_msg("%s: at %zu, not %zu", wrong[i].lines, fault.offset, (size_t)(place - text));
        }
    }
}

/* Lines outside of a block of their name go; others are added, and all keep their places. */
static void lines_are_replaced(void **unused)
{
    (void)unused;
    static const char text[] =
        "choice: kind = a of a, b\nlet: f = 1 # outside\nlet: g = 3\n"
        "when: kind = b\nlet: f = 2\n  + 2\nobserve: i = 1 .. 2; z[i] = i\nwhen: always\n"
        "observe: i = 1 .. 2; z[i] = f\nobserve: w = g\nrate: x = -x\nstart: x = 1\n";
    for (size_t k = 0; k < 2; k++) {
        const struct gm_system_value value = {"kind", k ? "b" : "a"};
        struct gm_user_system system;
        struct gm_fault fault;
        assert_true(gm_equations_open(&system, text, strlen(text), &value, 1, &fault));
        double value_of[3] = {0};
        for (size_t i = 0; i < 3; i++) {
            const struct gm_system_item *item = gm_system_item_of(&system, GM_WORD_OBSERVE, i);
            assert_non_null(item);
            value_of[i] = system.graph.nodes[item->nodes[0]].value;
        }
        assert_null(gm_system_item_of(&system, GM_WORD_OBSERVE, 3));
        assert_string_equal(system.source, text);
        assert_true(k ? value_of[0] == 1 && value_of[1] == 2 : value_of[0] == 1 && value_of[1] == 1);
        assert_true(value_of[2] == 3);
        gm_system_close(&system);
    }
}

/* The time to choose lines is proportional to their number. */
static void many_blocks_are_read(void **unused)
{
    (void)unused;
    enum { BLOCKS = 20000 };
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    fputs("choice: kind = a of a, b\nrate: x = f1\nstart: x = 1\n", stream);
    for (int i = 0; i < BLOCKS; i++) {
        fprintf(stream, "let: f%d = 1\nwhen: kind = b\nlet: f%d = 2\nwhen: always\n", i, i);
    }
    fclose(stream);
    const struct gm_system_value value = {"kind", "b"};
    struct gm_user_system system;
    struct gm_fault fault;
    assert_true(gm_equations_open(&system, text, size, &value, 1, &fault));
    assert_true(system.graph.nodes[system.rates[0]].value == 2);
    gm_system_close(&system);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_blocks_are_read),   cmocka_unit_test(words_choose_systems),
        cmocka_unit_test(choices_are_combined),   cmocka_unit_test(combinations_are_checked),
        cmocka_unit_test(what_is_wrong_is_named), cmocka_unit_test(lines_are_replaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
