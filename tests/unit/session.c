/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A session without a terminal: the past can be visited and gone on from, forks share it, and time runs both
   ways. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/base/arguments.h"
#include "app/explorer/surface/surface.h"
#include "app/explorer/view/view.h"
#include "app/runs/session.h"
#include "app/words/drive.h"
#include "core/basics.h"
#include "core/schemes.h"
#include "tests/common/folder.h"
#include "tests/common/meshes.h"

static char message[GM_MESSAGE];

static void open_session(struct gm_session *session)
{
    char *words[] = {"kepler", "scheme=rk4,verlet", "dt=0.05"};
    struct gm_request request;
    assert_true(gm_request_parse(&request, 3, words, 1, message));
    assert_true(gm_session_open(session, &request, message));
    gm_request_close(&request);
}

static void go(struct gm_session *session, double t)
{
    while (gm_session_advance(session, t)) {
    }
}

static double *copy_state(const struct gm_lane *lane)
{
    size_t size = lane->problem.n * lane->problem.m * sizeof(double);
    double *copy = malloc(size);
    assert_non_null(copy);
    memcpy(copy, gm_run_state(lane->run), size);
    return copy;
}

static bool is_state(const struct gm_lane *lane, const double *state)
{
    return memcmp(state, gm_run_state(lane->run), lane->problem.n * lane->problem.m * sizeof(double)) == 0;
}

static void past_is_visited(void **unused)
{
    (void)unused;
    struct gm_session session;
    open_session(&session);
    go(&session, 2.0001);
    const struct gm_lane *lane = session.lanes[0];
    double *end = copy_state(lane);
    const size_t bins = lane->history.count, entries = lane->entries[0].count;

    assert_true(gm_session_visit(&session, 1, message));
    assert_true(fabs(gm_session_gone(&session) - 1) < 1e-9);
    assert_true(lane->history.count < bins && lane->entries[0].count < entries);
    assert_true(gm_session_visit(&session, 0, message));
    assert_true(lane->run->steps == 0);
    assert_true(fabs(gm_session_reach(&session) - 2) < 1e-9);
    /* forwards again, all is as it was */
    assert_true(gm_session_visit(&session, INFINITY, message));
    assert_true(is_state(lane, end));
    assert_int_equal(lane->history.count, bins);
    assert_int_equal(lane->entries[0].count, entries);
    /* a lane that goes on from the past makes another future: this one is the same */
    assert_true(gm_session_visit(&session, 1, message));
    go(&session, 2.0001);
    assert_true(is_state(lane, end));
    assert_true(fabs(gm_session_reach(&session) - 2) < 1e-9);
    free(end);
    gm_session_close(&session);
}

static void forks_share_the_past(void **unused)
{
    (void)unused;
    struct gm_session session;
    open_session(&session);
    go(&session, 1.0001);
    double *there = copy_state(session.lanes[0]);
    assert_true(gm_session_fork(&session, 0, gm_scheme_find("gauss4"), message));
    assert_int_equal(session.count, 3);
    struct gm_lane *fork = session.lanes[2];
    assert_true(is_state(fork, there));
    assert_string_equal(fork->scheme->name, "gauss4");
    go(&session, 1.5001);
    double *end = copy_state(fork);
    assert_false(is_state(session.lanes[0], end));
    /* before the fork both are one; after it they part as they did */
    assert_true(gm_session_visit(&session, 0.5, message));
    double *before = copy_state(session.lanes[0]);
    assert_true(is_state(fork, before));
    assert_string_equal(fork->scheme->name, "rk4");
    assert_true(gm_session_visit(&session, INFINITY, message));
    assert_true(is_state(session.lanes[2], end));
    assert_string_equal(fork->scheme->name, "gauss4");
    /* step by step over the fork, and back */
    for (int i = 0; i < 12; i++) {
        assert_true(gm_session_back(&session, message));
    }
    assert_string_equal(session.lanes[2]->scheme->name, "rk4");
    free(before);
    free(end);
    free(there);
    gm_session_close(&session);
}

static void time_runs_both_ways(void **unused)
{
    (void)unused;
    struct gm_session session;
    open_session(&session);
    go(&session, 2.0001);
    const size_t entries = session.lanes[0]->entries[0].count;
    assert_true(gm_session_turn(&session, message));
    assert_true(gm_session_direction(&session) < 0);
    go(&session, 1 - 1e-9);
    assert_true(fabs(gm_session_gone(&session) - 3) < 1e-9);
    go(&session, -1e-9);
    /* Verlet is symmetric; RK4 is not, and misses by far more than round-off */
    assert_true(gm_session_from_start(&session, 1) < 1e-13);
    assert_true(gm_session_from_start(&session, 0) > 1e-6);
    /* the moment of the turn is still within reach */
    assert_true(gm_session_visit(&session, 2, message));
    assert_true(fabs(session.lanes[0]->run->t - 2) < 1e-9);
    assert_int_equal(session.lanes[0]->entries[0].count, entries);
    /* a new start is forwards */
    assert_true(gm_session_restart(&session, message));
    assert_true(gm_session_direction(&session) > 0 && session.lanes[0]->run->t == 0);
    /* who chooses its own step cannot turn */
    assert_true(gm_session_switch(&session, 0, gm_scheme_find("logh2"), message));
    assert_false(gm_session_turn(&session, message));
    gm_session_close(&session);
}

static void lanes_are_overlaid(void **unused)
{
    (void)unused;
    /* of a product of lists each says all that tells it apart */
    char *product[] = {"kepler", "scheme=rk4,verlet", "dt=0.05,0.1", "overlay=yes"};
    struct gm_request request;
    assert_true(gm_request_parse(&request, 4, product, 1, message));
    assert_string_equal(request.lanes[3].shown.colour_name, "Verlet, Δt = 0.1");
    gm_request_close(&request);
    /* with the title of the row that fits the scene, where one name has several */
    char *frames[] = {"burgers", "lambda=0,1", "scheme=ftcs,crank-nicolson"};
    assert_true(gm_request_parse(&request, 3, frames, 1, message));
    assert_string_equal(request.lanes[1].shown.colour_name, request.lanes[1].scheme->title);
    gm_request_close(&request);
    struct gm_session session;
    open_session(&session);
    assert_true(gm_session_overlay(&session, message));
    assert_int_equal(session.lanes[1]->shown.panel, 0);
    assert_int_equal(session.lanes[1]->shown.colour, 1);
    /* what the lanes' arguments say is what is shown */
    char *text = gm_request_format(&session.log), *words[16], *rest = NULL;
    int count = 0;
    assert_non_null(text);
    assert_non_null(strstr(text, " overlay=yes"));
    for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    struct gm_request again;
    assert_true(gm_request_parse(&again, count, words, 1, message));
    for (size_t i = 0; i < session.count; i++) {
        assert_memory_equal(&again.lanes[i].shown, &session.lanes[i]->shown, sizeof again.lanes[i].shown);
    }
    gm_request_close(&again);
    free(text);
    assert_true(gm_session_overlay(&session, message));
    assert_int_equal(session.lanes[1]->shown.panel, 1);
    /* a lane that is left alone has its own panel */
    assert_true(gm_session_overlay(&session, message));
    assert_true(gm_session_remove(&session, 0, message));
    assert_false(session.log.overlay);
    assert_false(gm_session_overlay(&session, message));
    gm_session_close(&session);
}

/* ---- sliders ---- */

struct numbers {
    double value;
};
#define NUMBER(standard_, low, high, logarithmic_)                                                           \
    {                                                                                                        \
        .key = "value", .unit = "", .help = "", .type = GM_REAL, .offset = offsetof(struct numbers, value),  \
        .standard = standard_, .lowest = low, .highest = high, .logarithmic = logarithmic_,                  \
    }

static void move(const struct gm_parameter *row, struct numbers *numbers, int direction, bool fine)
{
    char text[GM_TEXT_SIZE];
    assert_true(gm_slider_next(row, numbers, direction, fine, text));
    assert_true(gm_number_parse(text, &numbers->value));
}

static void sliders_move_finely(void **unused)
{
    (void)unused;
    const struct gm_parameter step = NUMBER("0.02", 1e-6, 100, true), wide = NUMBER("0", -1e4, 1e4, false),
                              narrow = NUMBER("0.5", 0.01, 0.9999, false);
    struct numbers numbers = {0.02};
    /* to 0.013 by keys alone: coarse, then fine */
    move(&step, &numbers, -1, false);
    move(&step, &numbers, -1, false);
    assert_true(fabs(numbers.value - 0.012) < 1e-12);
    for (int i = 0; i < 5; i++) {
        move(&step, &numbers, 1, true);
    }
    assert_true(fabs(numbers.value - 0.013) < 1e-12);
    /* a fine value lies within 2.5 % everywhere, there and back, borders of decades included */
    for (double start = 0.9; start < 12; start *= 1.013) {
        numbers.value = start;
        move(&step, &numbers, 1, true);
        assert_true(numbers.value > start && numbers.value < 1.0251 * start);
        numbers.value = start;
        move(&step, &numbers, -1, true);
        assert_true(numbers.value < start && numbers.value > 0.9749 * start);
    }
    numbers.value = 0;
    move(&wide, &numbers, 1, false);
    const double coarse = numbers.value;
    numbers.value = 0;
    move(&wide, &numbers, 1, true);
    assert_true(fabs(coarse - 10 * numbers.value) < 1e-12);
    numbers.value = 0.9999;
    char text[GM_TEXT_SIZE];
    assert_false(gm_slider_next(&narrow, &numbers, 1, true, text));
}

static void sliders_tell_places(void **unused)
{
    (void)unused;
    const struct gm_parameter rows[] = {NUMBER("0.02", 1e-6, 100, true), NUMBER("0", -1e4, 1e4, false),
                                        NUMBER("150", -1e6, 1e6, false), NUMBER("0.5", 0.01, 0.9999, false),
                                        NUMBER("5e-3", 0, 10, true)};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        double before = -INFINITY;
        for (double place = 0; place <= 1; place += 1. / 16) {
            char text[GM_TEXT_SIZE];
            struct numbers numbers;
            assert_true(gm_slider_at(&rows[i], place, text));
            assert_true(gm_number_parse(text, &numbers.value));
            assert_true(numbers.value > before);
            before = numbers.value;
            assert_true(fabs(gm_slider_position(&rows[i], &numbers) - place) < 0.01);
        }
        assert_true(before == rows[i].highest);
    }
    /* of a range that is far wider than what is of use, a quarter is for values near the usual ones */
    struct numbers numbers = {-10}, other = {10};
    assert_true(gm_slider_position(&rows[1], &other) - gm_slider_position(&rows[1], &numbers) > 0.25);
    /* and no part of it is for what no one means */
    const struct gm_parameter endless = NUMBER("1000", -1e300, 1e300, false);
    char text[GM_TEXT_SIZE];
    assert_true(gm_slider_at(&endless, 1, text) && gm_number_parse(text, &other.value));
    assert_true(other.value <= 1e9);
    numbers.value = 0.255;
    assert_true(fabs(gm_slider_position(&rows[3], &numbers) - 0.2475) < 0.001);
}

/* Of a name that tells several things of a lane, a change replaces the one that it changes. */
static void names_follow_changes(void **unused)
{
    (void)unused;
    char *words[] = {"kepler", "scheme=rk4,verlet", "dt=0.05,0.1", "eccentricity=0.2,0.3", "zip=yes"};
    struct gm_request request;
    struct gm_session session;
    bool restart = false;
    assert_true(gm_request_parse(&request, 5, words, 1, message));
    assert_true(gm_session_open(&session, &request, message));
    gm_request_close(&request);
    const struct gm_shown *shown = &session.lanes[1]->shown;
    assert_string_equal(session.lanes[0]->shown.panel_name, "RK4, Δt = 0.05, eccentricity = 0.2");
    const struct gm_parameter *dt = gm_scene_parameter(session.log.scene, "dt");
    assert_true(gm_session_set(&session, 1, dt, "0.025", &restart, message));
    assert_string_equal(shown->panel_name, "Verlet, Δt = 0.025, eccentricity = 0.3");
    assert_true(gm_session_switch(&session, 1, gm_scheme_find("rk4sym"), message));
    assert_string_equal(session.lanes[1]->shown.panel_name, "RK4sym, Δt = 0.025, eccentricity = 0.3");
    /* in one panel and back again */
    assert_true(gm_session_overlay(&session, message));
    assert_string_equal(session.lanes[1]->shown.colour_name, "RK4sym, Δt = 0.025, eccentricity = 0.3");
    assert_true(gm_session_overlay(&session, message));
    assert_string_equal(session.lanes[1]->shown.panel_name, "RK4sym, Δt = 0.025, eccentricity = 0.3");
    gm_session_close(&session);
}

/* Lanes as words are these lanes again, where the scene has others of its own. */
static void words_are_whole(void **unused)
{
    (void)unused;
    static char *const typed[][3] = {{"burgers", "scheme=ftcs", "lambda=0"},
                                     {"henon-heiles", "scheme=verlet,rk4", "q2=.1"},
                                     {"kdv", "scheme=box", "dt=.05"}};
    for (size_t i = 0; i < GM_COUNT(typed); i++) {
        struct gm_request request, again;
        struct gm_session session;
        bool restart = false;
        assert_true(gm_request_parse(&request, 3, typed[i], 1, message));
        assert_true(gm_session_open(&session, &request, message));
        const struct gm_parameter *until = gm_scene_parameter(session.scene, "until");
        assert_true(gm_session_set(&session, 0, until, "3", &restart, message));
        assert_true(gm_session_restart(&session, message)); /* these are not the typed words any more */
        char *text = gm_request_format(&session.log);
        struct gm_arguments words = {0};
        assert_true(text && gm_arguments_split(&words, text));
        assert_true(gm_request_parse(&again, words.count, words.words, GM_RENDER_SCHEMES, message));
        assert_int_equal(again.count, request.count);
        assert_int_equal(again.overlay, request.overlay);
        for (size_t k = 0; k < again.count; k++) {
            assert_ptr_equal(again.lanes[k].scheme, request.lanes[k].scheme);
            struct gm_timing *timing = request.lanes[k].parameters;
            timing->until = 3;
            for (size_t row = 0; row < session.scene->parameter_count; row++) {
                const struct gm_parameter *parameter = &session.scene->parameters[row];
                char one[GM_TEXT_SIZE], other[GM_TEXT_SIZE];
                assert_string_equal(
                    gm_parameter_format(parameter, again.lanes[k].parameters, one, sizeof one),
                    gm_parameter_format(parameter, timing, other, sizeof other));
            }
        }
        gm_request_close(&again);
        gm_arguments_close(&words);
        free(text);
        gm_session_close(&session);
        gm_request_close(&request);
    }
}

/* What is out of range is refused as on the command line, by the same sentence. */
static void ranges_hold(void **unused)
{
    (void)unused;
    char *words[] = {"kepler", "dt=5e9"}, typed[GM_MESSAGE];
    struct gm_request request;
    struct gm_session session;
    bool restart = false;
    assert_false(gm_request_parse(&request, 2, words, 1, typed));
    assert_string_equal(typed, "dt=5e9 is out of range: it lies between 1e-7 and 1000; the nearest is 1000");
    assert_true(gm_request_parse(&request, 1, words, 1, message));
    assert_true(gm_session_open(&session, &request, message));
    static const char *const wrong[][2] = {{"dt", "5e9"},     {"dt", "-0.1"},        {"dt", "abc"},
                                           {"until", "1e13"}, {"eccentricity", "2"}, {"show", "no"}};
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        char word[64], *line[] = {"kepler", word};
        snprintf(word, sizeof word, "%s=%s", wrong[i][0], wrong[i][1]);
        struct gm_request refused;
        assert_false(gm_request_parse(&refused, 2, line, 1, typed));
        const struct gm_parameter *row = gm_scene_parameter(session.scene, wrong[i][0]);
        assert_false(gm_session_set(&session, 0, row, wrong[i][1], &restart, message));
        assert_string_equal(message, typed);
    }
    assert_true(session.lanes[0]->run->dt == ((const struct gm_timing *)request.lanes[0].parameters)->dt);
    /* and so in changes of a picture's run */
    assert_true(gm_change_add(&request, 0, 1, "dt=5e9"));
    assert_false(gm_change_check(&request, &request.changes[0], message));
    assert_non_null(strstr(message, "is out of range: it lies between 1e-7 and 1000"));
    gm_session_close(&session);
    gm_request_close(&request);
}

/* Vertical lines at t, over the whole of a graph. */
static int marks_at(const struct gm_picture *picture, double t)
{
    int marks = 0;
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
            marks += panel->place == GM_PLACE_GRAPH && mark->kind == GM_MARK_LINE && mark->count == 2 &&
                     fabs(mark->points[0] - t) < 1e-9 && fabs(mark->points[2] - t) < 1e-9 &&
                     mark->points[1] == panel->y.low && mark->points[3] == panel->y.high;
        }
    }
    return marks;
}

static int marks_of(const struct gm_session *session, double t)
{
    struct gm_picture *picture = gm_picture_open();
    assert_non_null(picture);
    gm_lanes_draw((const struct gm_lane *const *)session->lanes, session->count, picture);
    const int marks = marks_at(picture, t);
    gm_picture_close(picture);
    return marks;
}

/* A scheme that takes over does not sign what the one before it made: name and graphs tell when. */
static void switches_are_told(void **unused)
{
    (void)unused;
    struct gm_session session;
    open_session(&session);
    const struct gm_lane *lane = session.lanes[0];
    /* before the first step there is nothing to tell */
    assert_true(gm_session_switch(&session, 0, gm_scheme_find("rk4sym"), message));
    assert_string_equal(lane->schemes, "RK4sym");
    assert_true(gm_session_switch(&session, 0, gm_scheme_find("rk4"), message));
    assert_string_equal(lane->shown.panel_name, "");
    go(&session, 1.0001);
    const double t = lane->run->t;
    assert_int_equal(marks_of(&session, t), 0);
    assert_true(gm_session_switch(&session, 0, gm_scheme_find("gauss4"), message));
    /* of two at one moment only the last one has made anything */
    assert_true(gm_session_switch(&session, 0, gm_scheme_find("verlet"), message));
    assert_string_equal(lane->shown.panel_name, "Verlet, after RK4");
    assert_string_equal(session.lanes[1]->shown.panel_name, "");
    go(&session, 1.5001);
    const int marks = marks_of(&session, t);
    assert_true(marks > 0);
    /* a fork has the same past */
    assert_true(gm_session_fork(&session, 0, gm_scheme_find("gauss4"), message));
    assert_string_equal(session.lanes[2]->shown.panel_name, "Gauss 4, after Verlet, RK4");
    assert_int_equal(marks_of(&session, t), 2 * marks);
    assert_true(gm_session_remove(&session, 2, message));
    /* in one panel */
    assert_true(gm_session_overlay(&session, message));
    assert_string_equal(lane->shown.colour_name, "Verlet, after RK4");
    assert_true(gm_session_overlay(&session, message));
    /* earlier there was none, and it comes back */
    assert_true(gm_session_visit(&session, 0.5, message));
    assert_string_equal(lane->schemes, "RK4");
    assert_int_equal(marks_of(&session, t), 0);
    assert_true(gm_session_visit(&session, INFINITY, message));
    assert_string_equal(lane->shown.panel_name, "Verlet, after RK4");
    for (int i = 0; i < 12; i++) {
        assert_true(gm_session_back(&session, message));
    }
    assert_string_equal(lane->schemes, "RK4");
    go(&session, 2);
    assert_string_equal(lane->schemes, "RK4");
    /* a render with these changes says the same */
    assert_true(gm_session_switch(&session, 0, gm_scheme_find("verlet"), message));
    const double last = lane->run->t;
    go(&session, 2.5001);
    struct gm_lane *again = gm_request_open_lane(&session.log, 0, message);
    struct gm_drive drive = {.lane = again, .request = &session.log};
    assert_true(gm_drive_to(&drive, lane->run->steps, true, message));
    assert_true(is_state(again, gm_run_state(lane->run)));
    assert_memory_equal(&again->shown, &lane->shown, sizeof again->shown);
    assert_true(again->switch_count == 1 && again->switches[0].t == last);
    gm_lane_close(again);
    /* a new start is the new scheme's own */
    assert_true(gm_session_restart(&session, message));
    assert_string_equal(session.lanes[0]->schemes, "Verlet");
    gm_session_close(&session);
}

/* Left and right walk through words too: choices, answers, and the usual ones of a text. */
static void sliders_walk_through_words(void **unused)
{
    (void)unused;
    const struct gm_scene *scene = gm_scene_find("channel");
    const struct gm_parameter *row = gm_scene_parameter(scene, "outlet");
    char text[GM_TEXT_SIZE];
    void *own = calloc(1, scene->size);
    static const char *const order[] = {"soft", "dirichlet", "free", "soft"};
    assert_non_null(own);
    for (size_t i = 0; i + 1 < GM_COUNT(order); i++) {
        assert_int_equal(gm_parameter_set(row, own, order[i]), GM_PARSED);
        assert_true(gm_slider_next(row, own, 1, false, text));
        assert_string_equal(text, order[i + 1]);
        assert_int_equal(gm_parameter_set(row, own, order[i + 1]), GM_PARSED);
        assert_true(gm_slider_next(row, own, -1, true, text));
        assert_string_equal(text, order[i]);
    }
    /* from a word of one's own to the first or the last */
    assert_int_equal(gm_parameter_set(row, own, "door"), GM_PARSED);
    assert_true(gm_slider_next(row, own, 1, false, text));
    assert_string_equal(text, "soft");
    assert_true(gm_slider_next(row, own, -1, false, text));
    assert_string_equal(text, "free");
    /* where there are no usual ones, there is nothing to walk through */
    const struct gm_parameter *mesh = gm_scene_parameter(gm_scene_find("room"), "mesh");
    void *room = calloc(1, gm_scene_find("room")->size);
    assert_non_null(room);
    assert_int_equal(gm_parameter_set(mesh, room, "none"), GM_PARSED);
    assert_false(gm_slider_next(mesh, room, 1, false, text));
    free(room);
    free(own);
}

static const struct gm_shot *next_shot(struct gm_worker *worker)
{
    const struct gm_shot *shot = NULL;
    gm_worker_want(worker);
    for (int i = 0; i < 20000 && !shot; i++) {
        shot = gm_worker_take(worker);
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    assert_non_null(shot);
    return shot;
}

static size_t place_of(const struct gm_shot *shot, const char *key)
{
    for (size_t i = 0; i < shot->parameter_count; i++) {
        if (strcmp(shot->parameters[i].row->key, key) == 0) {
            return i;
        }
    }
    fail_msg("there is no %s", key);
    return 0;
}

/* Types an answer for a parameter, a key at a time; returns what the session made of it. */
static const struct gm_shot *type_value(struct gm_worker *worker, struct gm_face *face, const char *key,
                                        const char *value)
{
    const struct gm_shot *shot = next_shot(worker);
    const unsigned long told = shot->message_number;
    const size_t place = place_of(shot, key);
    struct gm_order order = {.kind = GM_ORDER_TYPE, .row = shot->parameters[place].row};
    for (face->typed[0] = '\0'; *value; value++) {
        gm_typed_key(face->typed, *value);
    }
    char typed[GM_TYPED];
    snprintf(typed, sizeof typed, "%s", face->typed);
    snprintf(order.text, sizeof order.text, "%s", typed);
    gm_worker_order(worker, order);
    for (int i = 0; i < 1000; i++) {
        shot = next_shot(worker);
        if (strcmp(shot->parameters[place].value, typed) == 0 || shot->message_number != told) {
            return shot;
        }
    }
    fail_msg("%s = %s is neither taken nor refused", key, typed);
    return NULL;
}

/* Texts are whole in shots, in the words of a study and in what is typed, up to the most bytes of a text; a
   longer one is refused. */
static void long_texts_stay_whole(void **unused)
{
    (void)unused;
    char folder[128], path[224], other[232], words[232], longer[GM_TEXT_SIZE + 8];
    folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a mesh whose path with its blanks is of more than sixty-four bytes.msh",
             folder);
    snprintf(other, sizeof other, "%s.2", path);
    snprintf(words, sizeof words, "mesh=%s", path);
    size_t size;
    char *text = mesh_text("room-small.msh", &size);
    const char *const paths[] = {path, other};
    for (size_t i = 0; i < 2; i++) {
        FILE *file = fopen(paths[i], "w");
        assert_non_null(file);
        assert_int_equal(fwrite(text, 1, size, file), size);
        assert_int_equal(fclose(file), 0);
    }
    free(text);

    char *typed[] = {"room", words, "inlet=inlet", "outlet=outlet", "tracers=0"};
    struct gm_request request;
    const int wake = eventfd(0, 0);
    assert_true(gm_request_parse(&request, 5, typed, 1, message));
    struct gm_worker *worker = gm_worker_open(&(struct gm_worker_plan){.request = &request}, wake, message);
    assert_non_null(worker);
    gm_request_close(&request);

    const struct gm_shot *shot = next_shot(worker);
    assert_string_equal(shot->parameters[place_of(shot, "mesh")].value, path);
    struct gm_studies studies = {0};
    gm_studies_begin(&studies, GM_STUDY_STABILITY, shot, wake);
    assert_non_null(studies.studies[GM_STUDY_STABILITY]);
    struct gm_arguments arguments = {0};
    char *said = gm_studies_words(shot);
    assert_non_null(said);
    assert_true(gm_arguments_split(&arguments, said));
    free(said);
    bool whole = false;
    for (int i = 0; i < arguments.count; i++) {
        whole = whole || strcmp(arguments.words[i], words) == 0;
    }
    assert_true(whole);
    gm_arguments_close(&arguments);
    gm_studies_close(&studies);

    struct gm_face face = {0};
    shot = type_value(worker, &face, "mesh", other);
    assert_string_equal(shot->parameters[place_of(shot, "mesh")].value, other);
    memset(longer, 'x', sizeof longer - 1);
    longer[sizeof longer - 1] = '\0';
    shot = type_value(worker, &face, "mesh", longer);
    assert_non_null(strstr(shot->message, "is not a word of at most 255 bytes"));
    assert_string_equal(shot->parameters[place_of(shot, "mesh")].value, other);
    gm_worker_close(worker, message);
    close(wake);
    folder_remove(folder);
}

/* Moves a slider. */
static void slide(struct gm_worker *worker, const struct gm_parameter *row, int begins, double value)
{
    gm_worker_order(worker,
                    (struct gm_order){.kind = GM_ORDER_SLIDE, .row = row, .amount = begins, .value = value});
}

/* A drag of a slider is one change to undo, and so is the next drag of the same slider. */
static void drags_are_undone_one_by_one(void **unused)
{
    (void)unused;
    char *typed[] = {"kepler"}, text[GM_TEXT_SIZE];
    struct gm_request request;
    const int wake = eventfd(0, 0);
    assert_true(gm_request_parse(&request, 1, typed, 1, message));
    struct gm_worker *worker = gm_worker_open(&(struct gm_worker_plan){.request = &request}, wake, message);
    assert_non_null(worker);
    gm_request_close(&request);
    const struct gm_parameter *row = gm_scene_parameter(gm_scene_find("kepler"), "eccentricity");
    assert_non_null(row);
    const struct gm_shot *shot = next_shot(worker);
    const size_t place = place_of(shot, "eccentricity");
    const double drags[] = {0.2, 0.3, 0.6, 0.7};
    for (int i = 0; i < 4; i++) {
        slide(worker, row, i % 2 == 0, drags[i]);
    }
    assert_true(gm_slider_at(row, drags[1], text));
    for (int i = 0; i < 2; i++) {
        const unsigned long told = shot->message_number;
        gm_worker_order(worker, (struct gm_order){.kind = GM_ORDER_UNDO});
        for (int k = 0; k < 1000 && shot->message_number == told; k++) {
            shot = next_shot(worker);
        }
        assert_string_equal(shot->parameters[place].value, i == 0 ? text : row->standard);
    }
    gm_worker_close(worker, message);
    close(wake);
}

/* Who saves and leaves at once has what was saved, and is told of it; whether it is left for the shell or for another
   scene. */
static void what_was_asked_for_is_saved(void **unused)
{
    (void)unused;
    char folder[128], before[4096];
    folder_make(folder, sizeof folder);
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    void (*const leave[])(struct gm_worker *, char *) = {gm_worker_abandon, gm_worker_close};
    static const char *const files[] = {"disc-0001.png", "disc-0002.png"};
    const int wake = eventfd(0, 0);
    for (size_t i = 0; i < GM_COUNT(leave); i++) {
        char *typed[] = {"disc"}, parting[GM_MESSAGE];
        struct gm_request request;
        assert_true(gm_request_parse(&request, 1, typed, 1, message));
        struct gm_worker *worker =
            gm_worker_open(&(struct gm_worker_plan){.request = &request}, wake, message);
        assert_non_null(worker);
        gm_request_close(&request);
        gm_worker_order(worker, (struct gm_order){.kind = GM_ORDER_SAVE});
        leave[i](worker, parting);
        assert_int_equal(folder_count("."), i + 1); /* with nothing that is half written */
        assert_int_equal(access(files[i], R_OK), 0);
        assert_non_null(strstr(parting, files[i]));
    }
    /* where there is no room nothing stays of a file, and that is told */
    char *typed[] = {"system", "H=p^2/2+q^2", "q=1", "p=0"}, parting[GM_MESSAGE];
    struct gm_request request;
    struct rlimit room;
    assert_true(gm_request_parse(&request, GM_COUNT(typed), typed, 1, message));
    struct gm_worker *worker = gm_worker_open(&(struct gm_worker_plan){.request = &request}, wake, message);
    assert_non_null(worker);
    gm_request_close(&request);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &room), 0);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){.rlim_max = room.rlim_max}), 0);
    gm_worker_order(worker, (struct gm_order){.kind = GM_ORDER_SYSTEM});
    gm_worker_close(worker, parting);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &room), 0);
    assert_int_equal(folder_count("."), GM_COUNT(leave));
    assert_string_equal(parting, "Not saved: system-0001.system: File too large");
    close(wake);
    assert_int_equal(chdir(before), 0);
    folder_remove(folder);
}

/* The order of a search's answers: what is called so, what begins so, a word in it that does, any place. */
static void searches_prefer_names(void **unused)
{
    (void)unused;
    const char *const named[] = {"soliton", "Mesh points that follow a soliton", NULL},
                      *const begun[] = {"solitons", "", NULL}, *const later[] = {"two-soliton", "", NULL},
                      *const within[] = {"antisoliton", "", NULL},
                      *const told[] = {"sine-gordon", "Solitons of the sine-Gordon equation", NULL},
                      *const other[] = {"disc", "", NULL};
    const int best = gm_search_rank("soliton", named), second = gm_search_rank("soliton", begun),
              third = gm_search_rank("Soliton", later), last = gm_search_rank("soliton", within);
    assert_int_equal(best, 0);
    assert_true(best < second && second < third && third < last);
    assert_true(gm_search_rank("soliton", told) > second && gm_search_rank("soliton", told) < third);
    assert_true(gm_search_rank("soliton", other) < 0);
    /* every word counts, and nothing typed is answered by all */
    assert_true(gm_search_rank("soliton sine", named) < 0);
    assert_true(gm_search_rank("sine soliton", told) >= 0);
    assert_int_equal(gm_search_rank("", other), 0);
    assert_int_equal(gm_search_rank("disc ", other), 0);
    int ranks[4];
    assert_int_equal(gm_search_place(ranks, 0, 0, 7), 0);
    assert_int_equal(gm_search_place(ranks, 0, 1, 3), 0);
    assert_int_equal(gm_search_place(ranks, 0, 2, 3), 1);
    assert_int_equal(gm_search_place(ranks, 2, 3, 0), 2); /* those before `first` are another list */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(past_is_visited),
        cmocka_unit_test(forks_share_the_past),
        cmocka_unit_test(time_runs_both_ways),
        cmocka_unit_test(lanes_are_overlaid),
        cmocka_unit_test(names_follow_changes),
        cmocka_unit_test(ranges_hold),
        cmocka_unit_test(words_are_whole),
        cmocka_unit_test(sliders_move_finely),
        cmocka_unit_test(sliders_tell_places),
        cmocka_unit_test(switches_are_told),
        cmocka_unit_test(searches_prefer_names),
        cmocka_unit_test(sliders_walk_through_words),
        cmocka_unit_test(long_texts_stay_whole),
        cmocka_unit_test(what_was_asked_for_is_saved),
        cmocka_unit_test(drags_are_undone_one_by_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
