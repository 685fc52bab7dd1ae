/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines that are typed where there is no shell: their words, and the place of what is wrong. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "app/base/arguments.h"
#include "app/words/request.h"
#include "app/words/system.h"
#include "app/words/typed_file.h"
#include "app/words/words.h"
#include "core/basics.h"
#include "core/run.h"

/* The words with a bar between them. */
static void splits(const char *line, const char *words)
{
    struct gm_arguments split = {0}, again = {0};
    char all[512] = "";
    assert_true(gm_typed_split(&split, line));
    for (int i = 0; i < split.count; i++) {
        strcat(all, i ? "|" : "");
        strcat(all, split.words[i]);
    }
    assert_string_equal(all, words);
    /* and joined they are the same words */
    char *joined = gm_typed_join(&split);
    assert_non_null(joined);
    assert_true(gm_typed_split(&again, joined));
    assert_int_equal(split.count, again.count);
    for (int i = 0; i < split.count; i++) {
        assert_string_equal(split.words[i], again.words[i]);
    }
    free(joined);
    gm_arguments_close(&split);
    gm_arguments_close(&again);
}

static void words(void **unused)
{
    (void)unused;
    splits("", "");
    splits("   ", "");
    splits("H=p^2/2 - cos(q) q=2 p=0", "H=p^2/2 - cos(q)|q=2|p=0");
    splits("  H= p^2/2   -  q  q=2 ", "H=p^2/2   -  q|q=2");
    splits("H='p^2/2 + q^4/4' q=1.5", "H=p^2/2 + q^4/4|q=1.5");
    splits("'H=p^2/2 + q' q=1", "H=p^2/2 + q|q=1");
    splits("rate=x = y rate=y = -x + sin(t) x=1 y=0", "rate=x = y|rate=y = -x + sin(t)|x=1|y=0");
    splits("H=sum(i = 1 .. 3, p[i]^2/2 + sum( j=1 .. 2, q[j])) q[1]=2 N=3",
           "H=sum(i = 1 .. 3, p[i]^2/2 + sum( j=1 .. 2, q[j]))|q[1]=2|N=3");
    splits("'./my system.system' k=2 scheme=composition(verlet; 1/2, 1/2),rk4",
           "./my system.system|k=2|scheme=composition(verlet; 1/2, 1/2),rk4");
    splits("title='a b=c' k=1", "title=a b=c|k=1");
    splits("k=\"it's\" q=1", "k=it's|q=1");
}

/* A shell reads the word that was put. */
static void quoted(void **unused)
{
    (void)unused;
    static const char *const put[] = {"plain",           "it's", "./my 'x'.system", "about=it's a=b",
                                      "$HOME `x` \\ \"", "''"};
    for (size_t i = 0; i < GM_COUNT(put); i++) {
        char line[200] = "", read[100] = "";
        FILE *stream = fmemopen(line, sizeof line, "w");
        fputs("printf %s ", stream);
        gm_arguments_put_shell(stream, put[i]);
        assert_int_equal(fclose(stream), 0);
        FILE *shell = popen(line, "r");
        assert_non_null(shell);
        const size_t count = fread(read, 1, sizeof read - 1, shell);
        assert_int_equal(pclose(shell), 0);
        assert_int_equal(count, strlen(put[i]));
        assert_string_equal(read, put[i]);
    }
}

/* A sentence that holds `says`, and the place of the bar in the line. */
static void is_wrong(const char *marked, const char *says)
{
    char line[512] = "";
    struct gm_typed_fault fault;
    const char *bar = strchr(marked, '!');
    strncat(line, marked, bar ? (size_t)(bar - marked) : 500);
    strncat(line, bar ? bar + 1 : "", 200);
    assert_false(gm_typed_check(line, &fault));
    if (!strstr(fault.sentence, says) || fault.at != (bar ? bar - marked : -1)) {
        print_error("%s: %ld, %s\n", marked, fault.at, fault.sentence);
    }
    assert_non_null(strstr(fault.sentence, says));
    assert_null(strchr(fault.sentence, '\n'));
    assert_int_equal(fault.at, bar ? bar - marked : -1);
}

static void places(void **unused)
{
    (void)unused;
    struct gm_typed_fault fault;
    assert_true(gm_typed_check("H=p^2/2 - cos(q) q=2 p=0", &fault));
    assert_string_equal(fault.sentence, "");
    assert_true(gm_typed_check("geomint system H='p^2/2 - cos(q)' q=2 p=0 scheme=verlet dt=0.1", &fault));
    assert_true(gm_typed_check("kepler eccentricity=0.5", &fault));
    is_wrong("H=p^2/2 + !cso(q) q=2 p=0", "did you mean cos");
    is_wrong("  H=p^2/2 + 2!q q=2 p=0", "no operator");
    is_wrong("H='p^2/2 + 2!q' q=2 p=0", "no operator");
    is_wrong("H=p^2/2 + !k*q q=2 p=0", "not given: k=");
    is_wrong("H=p^2/2 + !dt*q + k q=2 p=0", "the name dt is reserved");
    is_wrong("rate=x = y rate=y = -x +!   x=1 y=0", "");
    is_wrong("H=p^2/2 - cos(q) q=2 p=0 !foo=3", "no parameter");
    is_wrong("H=p^2/2 - cos(q) q=2 p=0 dt=!abc", "is not a number");
    is_wrong("H=p^2/2 - cos(q) q=2 p=0 scheme=!vrlet", "vrlet");
    is_wrong("H=p^2/2 - cos(q) q=2 p=1+!", "");
    is_wrong("!nothing k=2", "there is no scene");
    is_wrong("q=1", "needs a formula");
    is_wrong("", "needs a formula");
    is_wrong("!./none.system", "");
    is_wrong("H=p^2/2 + !é q=1 p=0", "");
}

static void schemes(void **unused)
{
    (void)unused;
    struct gm_typed_fault fault;
    assert_true(gm_typed_check_scheme("kepler\nverlet", &fault));
    assert_true(gm_typed_check_scheme("kepler\nscheme='composition(verlet; 1/2, 1/2)'", &fault));
    assert_false(gm_typed_check_scheme("kepler\ncomposition(verlet; 1/2, 1)", &fault));
    assert_non_null(strstr(fault.sentence, "sum to 1.5"));
    assert_false(gm_typed_check_scheme("kepler\n  composition(vrlet; 1)", &fault));
    assert_int_equal(fault.at, 14);
    assert_true(gm_typed_check_scheme("kepler\ncomposition(rk4, adjoint(rk4); 1/2, 1/2)", &fault));
    assert_false(gm_typed_check_scheme("kepler\ncomposition(rk4, vrlet; 1/2, 1/2)", &fault));
    assert_int_equal(fault.at, 17);
    assert_false(gm_typed_check_scheme("kepler\nvrlet", &fault));
    assert_int_equal(fault.at, 0);
    assert_false(gm_typed_check_scheme("kepler\nboris2", &fault));
    assert_non_null(strstr(fault.sentence, "it needs a magnetic field"));
    assert_int_equal(fault.at, 0);
    assert_false(gm_typed_check_scheme("system H=p^2/2-cos(q) q=2 p=0\nstrang(kinetic, foo)", &fault));
    assert_non_null(strstr(fault.sentence, "it needs a part foo"));
    assert_int_equal(fault.at, 16);
    assert_false(gm_typed_check_scheme(
        "system H=p^2/2-cos(q) q=2 p=0\n scheme='composition(strang(kinetic, foo); 1)'", &fault));
    assert_int_equal(fault.at, 9 + 28);
    /* behind the same name in another place, and inside of other schemes */
    assert_false(
        gm_typed_check_scheme("system H=p^2/2-cos(q) q=2 p=0\n"
                              "composition(strang(kinetic, potential), projected(rk4; foo); 1/2, 1/2)",
                              &fault));
    assert_int_equal(fault.at, 40);
    assert_false(
        gm_typed_check_scheme("system H=p^2/2-cos(q) q=2 p=0\n"
                              "projected(composition(strang(kinetic, potential), lie(kinetic by rk4, foo); "
                              "1/2, 1/2); foo)",
                              &fault));
    assert_non_null(strstr(fault.sentence, "a part foo (column 71)"));
    assert_int_equal(fault.at, 70);
    assert_false(
        gm_typed_check("system H=p^2/2-cos(q) q=2 p=0 scheme='verlet,strang(kinetic, foo)'", &fault));
    assert_int_equal(fault.at, 38 + 7 + 16);
    assert_true(
        gm_typed_scheme("runge-kutta(0, 0 | 2/3, 0; 1/4, 3/4)", &(const struct gm_scheme *){NULL}, &fault));
}

/* Formulas of a file, with the lines that go on them. */
static void formulas(void **unused)
{
    (void)unused;
    struct gm_arguments found = {0};
    assert_true(gm_typed_file_formulas(
        "title: H: no\nH: p^2/2 # kinetic\n  + q^2/2\nrate: x = -x\n  # alone\nlet: f(v) = v\nstart: q = 1\n",
        &found));
    assert_int_equal(found.count, 3);
    assert_string_equal(found.words[0], "H=p^2/2 + q^2/2");
    assert_string_equal(found.words[1], "rate=x = -x");
    assert_string_equal(found.words[2], "let=f(v) = v");
    gm_arguments_close(&found);
}

/* A system is saved with the values that it has now, elements of lists and lines that go on among them. */
static void saved(void **unused)
{
    (void)unused;
    static const char text[] =
        "parameter: k[1..3] = 1, 2,\n  3; 0 .. 10\ncoordinates: q[1..3]\n"
        "H: sum(i=1..3, (p_q[i]^2 + k[i]*q[i]^2)/2) + c*q[1]\nstart: q[i] = i,\n  p_q[i] = 0\n"
        "parameter: c = 0.5 # a push\ndt: 0.1\nuntil: 1\n"
        "lanes: dt=1,2\n";
    char *words[] = {"lists", "k[2]=5", "q[3]=7", "c=0.25"}, message[GM_MESSAGE];
    struct gm_request request;
    assert_true(gm_system_recall("lists", text));
    assert_true(gm_request_parse(&request, 4, words, 1, message));
    char *now = gm_system_now(request.scene, request.lanes[0].parameters, NULL);
    assert_non_null(now);
    assert_non_null(strstr(now, "parameter: k[1..3] = 1, 5, 3; 0 .. 10\n"));
    assert_non_null(strstr(now, "q[1] = 1, q[2] = 2, q[3] = 7,\n"));
    assert_non_null(strstr(now, "parameter: c = 0.25 # a push\n"));
    assert_null(strstr(now, "lanes")); /* they would have another dt */
    gm_request_close(&request);
    /* and what was saved means these values */
    char *plain[] = {"again"};
    assert_true(gm_system_recall("again", now));
    assert_true(gm_request_parse(&request, 1, plain, 1, message));
    struct gm_lane *lane = gm_request_open_lane(&request, 0, message);
    assert_non_null(lane);
    const double *state = gm_run_state(lane->run), wanted[] = {1, 2, 7, 0, 0, 0};
    for (size_t i = 0; i < 6; i++) {
        assert_true(state[i] == wanted[i]);
    }
    gm_lane_close(lane);
    gm_request_close(&request);
    free(now);
    /* of a system in words, too, how it runs */
    char *typed[] = {"system", "H=p^2/2 + q^4/4", "q=1", "p=0", "dt=0.05", "until=7", "members=9"};
    assert_true(gm_request_parse(&request, 7, typed, 1, message));
    now = gm_system_now(request.scene, request.lanes[0].parameters, NULL);
    assert_non_null(now);
    assert_non_null(strstr(now, "\ndt: 0.05\n"));
    assert_non_null(strstr(now, "\nuntil: 7\n"));
    assert_non_null(strstr(now, "\nmembers: 9\n"));
    gm_request_close(&request);
    free(now);
    /* keys with names of the file, one of them that of a field's line */
    char *named[] = {"named", "points=7", "size=0.5"};
    assert_true(gm_system_recall("named",
                                 "coordinates: q\nmomenta: p\nH: p^2/2 + q^4/4\nstart: q = 1, p = 0\n"
                                 "members: points = 4; 3 .. 9\nspread: size = 0.1 # small\n"));
    assert_true(gm_request_parse(&request, 3, named, 1, message));
    now = gm_system_now(request.scene, request.lanes[0].parameters, NULL);
    assert_non_null(now);
    assert_non_null(strstr(now, "\nmembers: points = 7; 3 .. 9\nspread: size = 0.5 # small\n"));
    assert_null(strstr(now, "\npoints: "));
    gm_request_close(&request);
    free(now);
}

/* Writes the schemes of a request, each once, in the order of its lanes. Returns their number. */
static size_t schemes_of(const struct gm_request *request, const struct gm_scheme **schemes)
{
    size_t count = 0;
    for (size_t i = 0; i < request->count; i++) {
        size_t k = 0;
        while (k < count && schemes[k] != request->lanes[i].scheme) {
            k++;
        }
        schemes[k] = request->lanes[i].scheme;
        count += k == count;
    }
    return count;
}

/* A key that is given replaces the default values of that key alone: the schemes of the default lanes stay, for
   every key of every scene. */
static void default_lanes(void **unused)
{
    (void)unused;
    size_t tried = 0;
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        char word[2 * GM_TEXT_SIZE], message[GM_MESSAGE], *words[] = {(char *)scene->name, word};
        struct gm_request usual, given;
        const struct gm_scheme *schemes[2][GM_MOST_REQUESTED];
        assert_true(gm_request_parse(&usual, 1, words, GM_RENDER_SCHEMES, message));
        const size_t count = schemes_of(&usual, schemes[0]);
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const char *key = scene->parameters[k].key;
            snprintf(word, sizeof word, "%s=%s", key, scene->parameters[k].standard);
            if (!gm_request_parse(&given, 2, words, GM_RENDER_SCHEMES, message)) {
                /* with the default values and schemes */
                if (!strstr(message, "has no effect here") && !strstr(message, "; these do: ")) {
                    fail_msg("%s %s: %s", scene->name, word, message);
                }
                continue;
            }
            const bool listed = scene->lanes && strstr(scene->lanes, key);
            assert_true(listed || given.count == usual.count);
            assert_int_equal(schemes_of(&given, schemes[1]), count);
            assert_memory_equal(schemes[0], schemes[1], count * sizeof schemes[0][0]);
            gm_request_close(&given);
            tried++;
        }
        gm_request_close(&usual);
    }
    assert_true(tried > 200);
}

/* A typed word replaces that of its key among a scene's own lanes, and no other. */
static void lanes(void **unused)
{
    (void)unused;
    static const struct {
        const char *typed, *read;
    } rows[] = {
        {"kepler", "kepler scheme=rk2,rk4,verlet,rk4sym"},
        {"kepler until=20", "kepler scheme=rk2,rk4,verlet,rk4sym until=20"},
        {"nls until=1", "nls scheme=box,split-step2 until=1"},
        {"burgers dt=.01",
         "burgers scheme=ftcs,lax-wendroff,ftcs-invariant,lax-wendroff-invariant lambda=0,0.5,1 dt=.01"},
        {"burgers scheme=ftcs", "burgers scheme=ftcs lambda=0,0.5,1"},
        {"burgers show=frame", "burgers scheme=ftcs-invariant lambda=0,0.5,1 show=frame"},
        {"kdv until=5", "kdv scheme=box,zabusky-kruskal dt=0.05,0.0025 points=501 zip=yes until=5"},
        {"kdv dt=0.01", "kdv scheme=box,zabusky-kruskal dt=0.01 points=501 zip=yes"},
        /* other schemes take no part in the pairs */
        {"kdv scheme=fourier-rk4", "kdv scheme=fourier-rk4 points=501"},
        {"taylor-green steps=9",
         "taylor-green scheme=crank-nicolson,semi-implicit viscosity=0 speed=1 steps=9"},
        {"henon-heiles dt=.1", "henon-heiles scheme=verlet q2=0,.1,.2,.3 energy=1/8 overlay=yes dt=.1"},
        {"henon-heiles scheme=verlet,rk4", /* more lanes than colours */
         "henon-heiles scheme=verlet,rk4 q2=0,.1,.2,.3 energy=1/8 overlay=no"},
        {"waves c=2", "waves scheme=verlet,rk4 b=1,2 c=2"},
    };
    static const char text[] = "parameter: b = 1\nparameter: c = 1\ncoordinates: q\nH: p_q^2/2 + b*c*q^2/2\n"
                               "start: q = 1, p_q = 0\nlanes: scheme=verlet,rk4 b=1,2\n";
    char message[GM_MESSAGE];
    struct gm_request request;
    assert_true(gm_system_recall("waves", text));
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_arguments words = {0};
        assert_true(gm_arguments_split(&words, rows[i].typed));
        assert_true(gm_request_parse(&request, words.count, words.words, GM_RENDER_SCHEMES, message));
        assert_string_equal(request.arguments, rows[i].read);
        gm_request_close(&request);
        gm_arguments_close(&words);
    }
    char *longer[] = {"kdv", "dt=0.01,0.02,0.03"}, *twice[] = {"kdv", "dt=1", "dt=2"};
    assert_false(gm_request_parse(&request, 2, longer, GM_RENDER_SCHEMES, message));
    assert_string_equal(message, "zip=yes pairs lists of equal length; dt= has 3 values, not 2");
    assert_false(gm_request_parse(&request, 3, twice, GM_RENDER_SCHEMES, message));
    assert_string_equal(message, "dt= is given twice");
    char *formless[] = {"kepler", "=5"}, *bare[] = {"kepler", "foo"};
    assert_false(gm_request_parse(&request, 2, formless, GM_RUN_SCHEMES, message));
    assert_string_equal(message, "\"=5\" is not of the form key=value");
    assert_false(gm_request_parse(&request, 2, bare, GM_RUN_SCHEMES, message));
    assert_string_equal(message, "\"foo\" is not of the form key=value");
    /* a run takes the first scheme alone */
    assert_true(gm_request_parse(&request, 1, longer, GM_RUN_SCHEMES, message));
    assert_string_equal(request.arguments, "kdv scheme=box");
    gm_request_close(&request);
}

/* A system that was typed stays when its request was read: runs are opened of it after others were typed. */
static void typed_systems_stay(void **unused)
{
    (void)unused;
    enum { SYSTEMS = 3 };
    struct gm_request requests[SYSTEMS];
    for (size_t i = 0; i < SYSTEMS; i++) {
        char line[80], message[GM_MESSAGE];
        struct gm_typed_fault fault;
        snprintf(line, sizeof line, "H=p^2/2 + q^%zu/4 q=%zu p=%zu", 2 + i, 3 + i, 5 * i);
        assert_true(gm_typed_request(&requests[i], line, 1, &fault));
        for (size_t k = 0; k <= i; k++) {
            struct gm_lane *lane = gm_request_open_lane(&requests[k], 0, message);
            assert_non_null(lane);
            const double *state = gm_run_state(lane->run);
            assert_true(state[0] == (double)(3 + k) && state[1] == (double)(5 * k));
            gm_lane_close(lane);
        }
    }
    for (size_t i = 0; i < SYSTEMS; i++) {
        gm_request_close(&requests[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(words),   cmocka_unit_test(places),        cmocka_unit_test(quoted),
        cmocka_unit_test(schemes), cmocka_unit_test(formulas),      cmocka_unit_test(saved),
        cmocka_unit_test(lanes),   cmocka_unit_test(default_lanes), cmocka_unit_test(typed_systems_stay),
    };
    return cmocka_run_group_tests_name("typed", tests, NULL, NULL);
}
