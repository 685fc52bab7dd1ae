/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of all scenes: every observable that they ask for is there, and they can be read at any
   size. */
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
#include "core/basics.h"
#include "scenes/common/graph.h"
#include "scenes/common/symbol.h"
#include "scenes/flow/room_scene.h"
#include "scenes/mesh/observed.h"
#include "tests/common/layout_faults.h"

enum { MOST_LANES = 24, SCHEMES = 3 /* without a list, as render shows them */ };

struct drawn {
    struct gm_request request;
    struct gm_lane *lanes[MOST_LANES];
    struct gm_picture *picture;
};

/* The picture of "SCENE key=value ..." after some steps of every lane; false with a sentence where it cannot
   be opened. */
static bool draw(const char *arguments, long steps, struct drawn *drawn, char *message)
{
    char text[512], *words[16], *rest = NULL;
    int count = 0;
    snprintf(text, sizeof text, "%s", arguments);
    for (char *word = strtok_r(text, " ", &rest); word && count < 16; word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    *drawn = (struct drawn){.picture = gm_picture_open()};
    assert_non_null(drawn->picture);
    if (!gm_request_parse(&drawn->request, count, words, SCHEMES, message)) {
        return false;
    }
    assert_true(drawn->request.count <= MOST_LANES);
    for (size_t i = 0; i < drawn->request.count; i++) {
        drawn->lanes[i] = gm_request_open_lane(&drawn->request, i, message);
        if (!drawn->lanes[i]) {
            return false;
        }
        for (long k = 0; k < steps; k++) {
            gm_lane_to(drawn->lanes[i], drawn->lanes[i]->run->steps + 1, INFINITY);
            gm_lane_record(drawn->lanes[i]);
        }
    }
    gm_lanes_draw((const struct gm_lane *const *)drawn->lanes, drawn->request.count, drawn->picture);
    return true;
}

static void close_drawn(struct drawn *drawn)
{
    for (size_t i = 0; i < MOST_LANES; i++) {
        gm_lane_close(drawn->lanes[i]);
    }
    gm_request_close(&drawn->request);
    gm_picture_close(drawn->picture);
}

/* Scenes whose problem is made for each lane take the time of a mesh for every step. */
static long steps_of(const struct gm_scene *scene)
{
    return scene->close ? 2 : 40;
}

static void check_observables(const char *arguments, const struct gm_picture *picture)
{
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        if (strncmp(panel->title, GM_NO_OBSERVABLE, strlen(GM_NO_OBSERVABLE)) == 0) {
            fail_msg("%s: %s", arguments, panel->title);
        }
    }
}

/* The default picture, and one for every choice of every parameter that has choices. */
static void pictures_ask_for_observables_that_there_are(void **state)
{
    (void)state;
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        const char *small = gm_scene_parameter(scene, "mesh") || scene->close ? " rows=10 columns=8" : "";
        for (size_t p = 0; p < scene->parameter_count; p++) {
            const struct gm_parameter *row = &scene->parameters[p];
            for (size_t c = 0; row->type == GM_CHOICE && row->choices[c]; c++) {
                char arguments[256], message[GM_MESSAGE];
                struct drawn drawn;
                snprintf(arguments, sizeof arguments, "%s %s=%s%s", scene->name, row->key, row->choices[c],
                         small);
                if (draw(arguments, 2, &drawn, message)) { /* some start does not exist for every scheme */
                    check_observables(arguments, drawn.picture);
                }
                close_drawn(&drawn);
            }
        }
    }
}

static void check_key(const struct gm_scene *scene, const char *key)
{
    if (key && gm_scene_observable(scene, key) < 0) {
        fail_msg("%s: there is no observable %s", scene->name, key);
    }
}

static void tables_name_observables_that_there_are(void **state)
{
    (void)state;
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        check_key(scene, scene->work ? scene->work->measure : NULL);
        check_key(scene, scene->stability ? scene->stability->kept : NULL);
        check_key(scene, scene->stability ? scene->stability->error : NULL);
    }
}

/* The title, whole, in lines one below the other. */
static bool has_whole_title(const struct gm_layout *layout, const char *title)
{
    char told[256] = "";
    for (size_t i = 0; i < layout->label_count; i++) {
        const struct gm_label *label = &layout->labels[i];
        if (label->size == GM_TEXT_TITLE && label->bold) {
            const size_t length = strlen(told);
            snprintf(told + length, sizeof told - length, "%s%s", length ? " " : "", label->text);
        }
    }
    return strcmp(told, title) == 0;
}

/* Whether frames, colour bars and labels leave a third of the surface empty in one piece, from edge to
   edge. */
static bool has_empty_third(const struct gm_layout *layout, const struct gm_metrics *metrics)
{
    enum { PARTS = 60 };
    bool full[2][PARTS] = {{false}};
    for (size_t i = 0; i < layout->frame_count; i++) {
        const struct gm_box *box = &layout->frames[i].box;
        for (int k = 0; k < PARTS; k++) {
            const double x = metrics->width * (k + 0.5) / PARTS, y = metrics->height * (k + 0.5) / PARTS;
            full[0][k] = full[0][k] || (x >= box->x && x <= box->x + box->width);
            full[1][k] = full[1][k] || (y >= box->y && y <= box->y + box->height);
        }
    }
    for (int side = 0; side < 2; side++) {
        int empty = 0;
        for (int k = 0; k < PARTS; k++) {
            empty = full[side][k] ? 0 : empty + 1;
            if (empty >= PARTS / 3) {
                return true;
            }
        }
    }
    return false;
}

static void default_pictures_can_be_read_at_any_size(void **state)
{
    (void)state;
    static const double sizes[][2] = {{300, 200},  {1000, 1000}, {2000, 400}, {640, 360},
                                      {1280, 720}, {1920, 1080}, {720, 1280}};
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        char message[GM_MESSAGE];
        struct drawn drawn;
        if (!draw(scene->name, steps_of(scene), &drawn, message)) {
            fail_msg("%s: %s", scene->name, message);
        }
        check_observables(scene->name, drawn.picture);
        for (size_t k = 0; k < GM_COUNT(sizes); k++) {
            struct gm_metrics metrics = metrics_of(sizes[k][0], sizes[k][1]);
            const char *fault = layout_fault(drawn.picture, &metrics);
            if (fault) {
                fail_msg("%s at %gx%g: %s", scene->name, sizes[k][0], sizes[k][1], fault);
            }
            const struct gm_layout *layout = gm_layout_make(drawn.picture, &metrics);
            if (!has_whole_title(layout, drawn.picture->title)) {
                fail_msg("%s at %gx%g: the title is cut", scene->name, sizes[k][0], sizes[k][1]);
            }
            /* one panel of equal axes has its own shape */
            const bool shaped = layout->frame_count == 1 && layout->frames[0].panel->equal;
            if (!shaped && has_empty_third(layout, &metrics)) {
                fail_msg("%s at %gx%g: a third is empty", scene->name, sizes[k][0], sizes[k][1]);
            }
        }
        close_drawn(&drawn);
    }
}

static const struct gm_panel *panel_titled(const struct gm_picture *picture, const char *title)
{
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        if (strstr(panel->title, title)) {
            return panel;
        }
    }
    fail_msg("no panel \"%s\"", title);
    return NULL;
}

static void open_drawn(const char *arguments, long steps, struct drawn *drawn)
{
    char message[GM_MESSAGE];
    if (!draw(arguments, steps, drawn, message)) {
        fail_msg("%s: %s", arguments, message);
    }
}

/* Of two lists every curve of the common graph has its own pair of colour and dash, and dashes are named. */
static void curves_of_a_product_are_told_apart(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("kepler scheme=rk4,verlet dt=.1,.2,.4", 30, &drawn);
    const struct gm_panel *graph = panel_titled(drawn.picture, "energy error");
    size_t lines = 0, keys = 0;
    for (const struct gm_mark *mark = graph->first; mark; mark = mark->next) {
        if (mark->kind == GM_MARK_LINE && mark->style.role >= GM_LANE) {
            lines++;
        }
        for (const struct gm_mark *other = graph->first; other != mark; other = other->next) {
            assert_false(mark->style.role >= GM_LANE && mark->style.role == other->style.role &&
                         mark->style.dash == other->style.dash);
        }
    }
    for (const struct gm_key *key = graph->first_key; key; key = key->next) {
        keys++;
    }
    assert_int_equal(lines, 6);
    assert_int_equal(keys, 2);
    close_drawn(&drawn);
}

static double width_of(const struct drawn *drawn, const char *title)
{
    const struct gm_panel *panel = panel_titled(drawn->picture, title);
    return panel->x.high - panel->x.low;
}

/* A lane that runs away has a scale of its own, and leaves that of the others alone, in one panel too. */
static void who_runs_away_leaves_the_scale(void **state)
{
    (void)state;
    static const char *const runs[] = {"disc scheme=explicit-euler,midpoint",
                                       "kepler scheme=explicit-euler,verlet dt=.3"};
    for (size_t i = 0; i < GM_COUNT(runs); i++) {
        char words[256];
        struct drawn drawn, together;
        open_drawn(runs[i], 230, &drawn);
        snprintf(words, sizeof words, "%s overlay=yes", runs[i]);
        open_drawn(words, 230, &together);
        const char *other = i == 0 ? "midpoint" : "Verlet";
        assert_true(width_of(&drawn, other) < 6);
        assert_true(width_of(&drawn, "explicit Euler") > 3 * width_of(&drawn, other));
        assert_true(width_of(&together, "all lanes") == width_of(&drawn, other));
        close_drawn(&drawn);
        close_drawn(&together);
    }
}

/* The pendulum's angle counts modulo 2 pi, and no line of an outline that goes around crosses the panel. */
static void the_pendulum_goes_around(void **state)
{
    (void)state;
    static const char *const more[] = {"", " points=40", " points=2000", " q0=20", " points=5"};
    for (size_t k = 0; k < GM_COUNT(more); k++) {
        for (long steps = 60; steps <= 960; steps *= 4) {
            char words[256];
            struct drawn drawn;
            snprintf(words, sizeof words, "disc system=pendulum p0=1.9 scheme=midpoint dt=0.1%s", more[k]);
            open_drawn(words, steps, &drawn);
            const struct gm_panel *panel = drawn.picture->first;
            assert_true(panel->x.low >= -4 && panel->x.high <= 4);
            for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
                for (size_t i = 0; i < mark->count && mark->style.role != GM_EXACT; i++) {
                    const double *at = mark->points + 2 * i;
                    assert_false(i > 0 && mark->kind == GM_MARK_LINE && fabs(at[0] - at[-2]) > M_PI);
                }
            }
            close_drawn(&drawn);
        }
    }
}

/* What a law leaves at a tenth of the step is seen beside what the long step leaves: colours end near the largest
   value of each lane, and every lane has the bar that says where. */
static void residuals_have_colours_of_their_own(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("sine-gordon scheme=box points=201 dt=0.1,0.01 show=energy-law", 40, &drawn);
    double high[2];
    size_t images = 0;
    for (const struct gm_panel *panel = drawn.picture->first; panel; panel = panel->next) {
        for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
            if (mark->kind != GM_MARK_IMAGE) {
                continue;
            }
            double most = 0;
            for (size_t i = 0; i < mark->rows * mark->columns; i++) {
                most = fmax(most, fabs(mark->values[i]));
            }
            assert_true(panel->colour_bar);
            assert_true(most > mark->high / 4 && most <= mark->high && mark->low == -mark->high);
            assert_true(images < 2);
            high[images++] = mark->high;
        }
    }
    assert_int_equal(images, 2);
    assert_true(high[0] > 10 * high[1]);
    close_drawn(&drawn);
}

/* Digits at the end of a name are its index; those of a number and of a function that is called are none. */
static void names_are_typeset(void **state)
{
    (void)state;
    static const char *const texts[][2] = {
        {"p_x^2 - 2*q1", "pₓ² − 2 q₁"},
        {"q10 + q101", "q₁₀ + q₁₀₁"},
        {"1e12 + 1.5E12", "1e12 + 1.5E12"},
        {"1e-12*x2", "1e−12 x₂"},
        {"log10(q) + log1p(q)", "log10(q) + log1p(q)"},
        {"atan2(y1, x1) + log2(2)", "atan2(y₁, x₁) + log2(2)"},
        {"log2 + f2(x)", "log₂ + f₂(x)"},
        {"eps0 + lambda12", "ε₀ + λ₁₂"},
        {"x[12] + 3q1e5", "x₁₂ + 3q₁e₅"},
        {"q^2.5 + q^2.", "q^2.5 + q²."},
    };
    struct gm_picture *picture = gm_picture_open();
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        assert_string_equal(gm_typeset(picture, texts[i][0]), texts[i][1]);
    }
    gm_picture_close(picture);
}

/* The marks of a panel of one kind in the colours of lanes. */
static size_t marks_of(const struct gm_panel *panel, enum gm_mark_kind kind)
{
    size_t count = 0;
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        count += mark->kind == kind && mark->style.role >= GM_LANE;
    }
    return count;
}

/* A few points of a flow are a line, those of a map are not; the only value of a graph is a dot. */
static void few_steps_are_seen(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("system H=p^2/2+q^2/2 q=1 p=0 scheme=verlet dt=.1", 30, &drawn);
    assert_true(marks_of(panel_titled(drawn.picture, "Verlet"), GM_MARK_LINE) > 0);
    assert_int_equal(marks_of(panel_titled(drawn.picture, "Verlet"), GM_MARK_POINTS), 1);
    assert_int_equal(marks_of(panel_titled(drawn.picture, "energy error"), GM_MARK_POINTS), 0);
    close_drawn(&drawn);
    open_drawn("kicked-rotor scheme=verlet", 30, &drawn);
    const struct gm_panel *panel = panel_titled(drawn.picture, "Verlet");
    assert_int_equal(marks_of(panel, GM_MARK_LINE), 0);
    assert_int_equal(marks_of(panel, GM_MARK_POINTS), 2);
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        assert_true(mark->kind != GM_MARK_POINTS || mark->style.alpha > .5);
    }
    close_drawn(&drawn);
    open_drawn("system H=p^2/2+q^2/2 q=1 p=0 scheme=verlet dt=.1", 1, &drawn);
    assert_int_equal(marks_of(panel_titled(drawn.picture, "energy error"), GM_MARK_POINTS), 1);
    close_drawn(&drawn);
}

/* A lane that has blown up does not set the colours and the linear graphs of all. */
static void a_blow_up_hides_no_lane(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("form-wave level=2 scheme=verlet,midpoint dt=0.4", 30, &drawn);
    assert_int_equal(drawn.lanes[0]->run->status, GM_BLOW_UP);
    for (const struct gm_panel *panel = drawn.picture->first; panel; panel = panel->next) {
        for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
            if (mark->kind == GM_MARK_MESH) {
                assert_true(mark->high <= 1 && mark->low == -mark->high);
                assert_true(strcmp(panel->title, "midpoint") == 0 || (mark->below && mark->above));
            }
        }
    }
    const struct gm_panel *mean = panel_titled(drawn.picture, "mean");
    assert_true(mean->y.low > -1e-12 && mean->y.high < 1e-12);
    close_drawn(&drawn);
}

/* The graph of the cell's volume ends where it does, not at the end of the run. */
static void the_volume_fills_its_graph(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("abc", 5000, &drawn);
    const struct gm_panel *volume = panel_titled(drawn.picture, "volume /");
    assert_true(volume->x.high < 120);
    /* the clock says 500: the title tells where the graph ends */
    const char *end = strstr(volume->title, "measurable up to t = ");
    assert_non_null(end);
    const double last = strtod(end + strlen("measurable up to t = "), NULL);
    assert_true(last > 40 && last <= volume->x.high);
    close_drawn(&drawn);
    open_drawn("abc", 200, &drawn);
    assert_null(strstr(panel_titled(drawn.picture, "volume /")->title, "measurable"));
    close_drawn(&drawn);
}

/* A planet that is thrown out is in its panel, and the others keep their scale. */
static void an_orbit_that_leaves_is_followed(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("kepler scheme=rk2,verlet until=2000", 30000, &drawn);
    const struct gm_panel *left = panel_titled(drawn.picture, "RK2"), *other = left->next;
    const double *at = gm_run_state(drawn.lanes[0]->run);
    assert_true(hypot(at[0], at[1]) > 3);
    assert_true(at[0] > left->x.low && at[0] < left->x.high && at[1] > left->y.low && at[1] < left->y.high);
    assert_true(other->x.high - other->x.low < 8);
    close_drawn(&drawn);
}

/* A steady state has corrections and no time; a scheme's own charge is round-off under each. */
static void graphs_say_what_they_show(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("cavity rows=10 columns=8", 3, &drawn);
    assert_string_equal(panel_titled(drawn.picture, "kinetic")->x.label, "corrections");
    assert_string_equal(drawn.picture->clock, "");
    close_drawn(&drawn);
    open_drawn("room rows=10 columns=14 tracers=0", 3, &drawn);
    assert_string_equal(panel_titled(drawn.picture, "pollutant in")->x.label, "t / τ");
    assert_non_null(strstr(drawn.picture->subtitle, "τ = 20 h/U"));
    close_drawn(&drawn);
    open_drawn("nls", 40, &drawn);
    const int charge = gm_scene_observable(drawn.request.scene, "own_charge_error");
    panel_titled(drawn.picture, "own charge");
    for (size_t i = 0; i < drawn.request.count; i++) {
        assert_true(gm_lane_observe(drawn.lanes[i], (size_t)charge) < 1e-12);
    }
    close_drawn(&drawn);
    /* a flow has a panel of its own whatever its colour stands for */
    open_drawn("poiseuille rows=8 scheme=semi-implicit,crank-nicolson dt=0.05,0.1", 2, &drawn);
    panel_titled(drawn.picture, "semi-implicit, Δt = 0.1");
    panel_titled(drawn.picture, "Crank–Nicolson, Δt = 0.05");
    close_drawn(&drawn);
    open_drawn("couette rows=8", 3, &drawn);
    panel_titled(drawn.picture, "divergence");
    close_drawn(&drawn);
}

/* Whether a text among the marks stands there, whole, in one line or in two. */
static bool has_note(const struct gm_layout *layout, const char *text)
{
    for (size_t i = 0; i < layout->label_count; i++) {
        const struct gm_label *label = &layout->labels[i];
        const size_t length = strlen(label->text);
        if (label->among_marks && strncmp(text, label->text, length) == 0 &&
            (text[length] == '\0' || (text[length] == ' ' && i + 1 < layout->label_count &&
                                      strcmp(text + length + 1, layout->labels[i + 1].text) == 0))) {
            return true;
        }
    }
    return false;
}

/* The names of curves that end close to each other find their places in a small picture too. */
static void every_curve_over_frames_is_named(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("burgers scheme=ftcs,lax-wendroff,ftcs-invariant,lax-wendroff-invariant lambda=0,0.5,1", 100,
               &drawn);
    struct gm_metrics metrics = metrics_of(300, 200);
    metrics.self = &metrics;
    const struct gm_layout *layout = gm_layout_make(drawn.picture, &metrics);
    const struct gm_panel *graph = panel_titled(drawn.picture, "largest error so far");
    size_t names = 0;
    for (const struct gm_mark *mark = graph->first; mark; mark = mark->next) {
        if (mark->kind == GM_MARK_TEXT) {
            names++;
            if (!has_note(layout, mark->text)) {
                fail_msg("%s has no name at 300x200", mark->text);
            }
        }
    }
    assert_int_equal(names, 4);
    close_drawn(&drawn);
}

/* What makes the square's mesh says nothing of a mesh from a file. */
static void a_mesh_file_leaves_no_rows(void **state)
{
    (void)state;
    const struct gm_scene *room = gm_scene_find("room");
    struct gm_flows own = {.mesh = "none"};
    assert_null(gm_scene_idle(room, &own, "rows"));
    assert_non_null(gm_scene_idle(room, &own, "inlet"));
    snprintf(own.mesh, sizeof own.mesh, "other.msh");
    assert_non_null(gm_scene_idle(room, &own, "rows"));
    assert_non_null(gm_scene_idle(room, &own, "columns"));
    assert_non_null(gm_scene_idle(room, &own, "irregular"));
    assert_null(gm_scene_idle(room, &own, "inlet"));
    assert_null(gm_scene_idle(room, &own, "reynolds"));
}

/* Lanes in the order of their panels, then in their own; a panel without lanes is passed over. */
static void a_walk_goes_panel_by_panel(void **state)
{
    (void)state;
    struct gm_lane made[5] = {0};
    const struct gm_lane *lanes[5];
    const size_t panels[5] = {3, 0, 3, 1, 0}, order[5] = {1, 4, 3, 0, 2};
    const bool first[5] = {true, false, true, true, false};
    for (size_t i = 0; i < 5; i++) {
        made[i].shown.panel = panels[i];
        lanes[i] = &made[i];
    }
    struct gm_walk walk = {.lanes = lanes, .count = 5};
    for (size_t i = 0; i < 5; i++) {
        assert_true(gm_walk_next(&walk));
        assert_ptr_equal(walk.lane, lanes[order[i]]);
        assert_int_equal(walk.panel, panels[order[i]]);
        assert_int_equal(walk.first, first[i]);
    }
    assert_false(gm_walk_next(&walk));
    struct gm_walk none = {.lanes = lanes};
    assert_false(gm_walk_next(&none));
}

/* Returns the first text among the marks of a panel that holds `text`. */
static const struct gm_mark *text_in(const struct gm_panel *panel, const char *text)
{
    const struct gm_mark *mark = panel->first;
    while (mark && (mark->kind != GM_MARK_TEXT || !strstr(mark->text, text))) {
        mark = mark->next;
    }
    assert_non_null(mark);
    return mark;
}

/* Paths of three lanes, and fields above paths of two, are side by side. */
static void panels_of_meshes_are_side_by_side(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("soliton scheme=multiplier-lobatto4,uniform-gauss4,given-gauss4 points=7 show=mesh", 2,
               &drawn);
    assert_int_equal(drawn.picture->state_columns, 3);
    close_drawn(&drawn);
    open_drawn("soliton scheme=multiplier-lobatto4,uniform-gauss4 points=7", 2, &drawn);
    assert_int_equal(drawn.picture->state_columns, 2);
    close_drawn(&drawn);
}

/* The note of a surface that a scheme has not is in its middle. */
static void empty_surfaces_have_a_note(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("sine-gordon scheme=lobatto-nystrom4,box points=32 until=4 show=energy-law", 2, &drawn);
    const struct gm_panel *panel = drawn.picture->first;
    const struct gm_mark *note = text_in(panel, "the scheme has no such law");
    assert_true(fabs(note->points[0]) < 1e-12); /* the line is from -20 to 20, and the time from 0 to 4 */
    assert_true(fabs(note->points[1] - 2) < 1e-12);
    close_drawn(&drawn);
}

/* The name of an error is to the right of its first point, and in the panel. */
static void names_of_errors_are_beside_them(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("poiseuille show=convergence rows=4,8 steps=2", 2, &drawn);
    const struct gm_panel *panel = drawn.picture->first;
    size_t names = 0;
    const double *first = NULL;
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        if (mark->kind == GM_MARK_LINE) {
            first = mark->points;
        } else if (mark->kind == GM_MARK_TEXT) {
            assert_non_null(first);
            assert_true(mark->points[0] > first[0] && mark->points[0] < 1.1 * first[0] &&
                        mark->points[1] == first[1]);
            assert_true(mark->points[0] < panel->x.high);
            names++;
        }
    }
    assert_true(names > 1);
    close_drawn(&drawn);
}

/* Margins around a room are parts of its size, wherever it is. */
static void rooms_have_their_size_anywhere(void **state)
{
    (void)state;
    struct drawn drawn;
    open_drawn("room rows=10 columns=14 tracers=0", 1, &drawn);
    const struct gm_complex *complex = gm_flow_of(&drawn.lanes[0]->problem)->complex;
    double heights[2];
    for (size_t k = 0; k < 2; k++) {
        struct gm_picture *picture = gm_picture_open();
        gm_lanes_draw((const struct gm_lane *const *)drawn.lanes, 1, picture);
        heights[k] = picture->first->y.high - picture->first->y.low;
        gm_picture_close(picture);
        for (size_t v = 0; v < complex->vertices; v++) {
            complex->point[2 * v + 1] += 50;
        }
    }
    assert_true(heights[0] > 1 && fabs(heights[1] - heights[0]) < 1e-9);
    close_drawn(&drawn);
}

/* The distance from a run on another mesh, whose field is linear between its nodes and its ends, when the soliton is at
   its right end. */
static void meshes_are_compared_up_to_their_ends(void **state)
{
    (void)state;
    enum { COARSE = 5, FINE = 15 };
    struct drawn drawn;
    open_drawn("soliton scheme=uniform-gauss4 length=4 points=15,5", 40, &drawn);
    const double *fine = gm_run_state(drawn.lanes[0]->run), *coarse = gm_run_state(drawn.lanes[1]->run);
    const struct gm_view view = gm_lane_view(drawn.lanes[1]);
    const struct gm_mesh mesh = gm_mesh_of(&view);
    double u[COARSE + 2] = {mesh.left}, x[COARSE + 2] = {mesh.first}, largest = 0;
    memcpy(u + 1, coarse, COARSE * sizeof *u);
    memcpy(x + 1, coarse + COARSE, COARSE * sizeof *x);
    u[COARSE + 1] = mesh.right;
    x[COARSE + 1] = mesh.first + mesh.length;
    for (size_t k = 0; k < FINE; k++) {
        const double here = fine[FINE + k];
        for (size_t i = 0; i < COARSE + 1; i++) {
            if (here >= x[i] && here <= x[i + 1]) {
                const double share = (here - x[i]) / (x[i + 1] - x[i]);
                largest = fmax(largest, fabs(fine[k] - (1 - share) * u[i] - share * u[i + 1]));
            }
        }
    }
    assert_true(largest > 0.01);
    assert_true(fabs(gm_mesh_distance(drawn.lanes[0], drawn.lanes[1]) - largest) < 1e-12);
    close_drawn(&drawn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_ask_for_observables_that_there_are),
        cmocka_unit_test(tables_name_observables_that_there_are),
        cmocka_unit_test(default_pictures_can_be_read_at_any_size),
        cmocka_unit_test(curves_of_a_product_are_told_apart),
        cmocka_unit_test(who_runs_away_leaves_the_scale),
        cmocka_unit_test(the_pendulum_goes_around),
        cmocka_unit_test(residuals_have_colours_of_their_own),
        cmocka_unit_test(names_are_typeset),
        cmocka_unit_test(few_steps_are_seen),
        cmocka_unit_test(a_blow_up_hides_no_lane),
        cmocka_unit_test(the_volume_fills_its_graph),
        cmocka_unit_test(an_orbit_that_leaves_is_followed),
        cmocka_unit_test(graphs_say_what_they_show),
        cmocka_unit_test(every_curve_over_frames_is_named),
        cmocka_unit_test(a_mesh_file_leaves_no_rows),
        cmocka_unit_test(a_walk_goes_panel_by_panel),
        cmocka_unit_test(panels_of_meshes_are_side_by_side),
        cmocka_unit_test(empty_surfaces_have_a_note),
        cmocka_unit_test(names_of_errors_are_beside_them),
        cmocka_unit_test(rooms_have_their_size_anywhere),
        cmocka_unit_test(meshes_are_compared_up_to_their_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
