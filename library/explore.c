/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes that are explored: the orders of the explorer as functions, and what its screen shows as JSON. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/output/row.h"
#include "app/output/scheme_json.h"
#include "app/words/names.h"
#include "app/words/words.h"
#include "core/arena.h"
#include "core/expression/nearest.h"
#include "core/schemes.h"
#include "library/handle.h"
#include "render/layout/panel.h"

static void open_session(struct gm_arena *arena, void *data)
{
    char message[GM_MESSAGE];
    struct gm_handle_words *opening = data;
    geomint *handle = opening->handle;
    gm_handle_read(arena, opening, GM_RENDER_SCHEMES);
    struct gm_session *session = gm_arena_take(arena, 1, sizeof *session);
    struct gm_shot *shot = gm_arena_take(arena, 1, sizeof *shot);
    gm_arena_check(arena, gm_session_open(session, handle->request, message), message);
    gm_arena_keep(arena, session, gm_session_close);
    gm_arena_need(arena, gm_shot_open(shot));
    handle->shot = gm_arena_keep(arena, shot, gm_shot_close);
    handle->request = &session->log;
    handle->session = session;
    handle->mark = gm_arena_mark(arena);
    gm_handle_show(handle);
}

geomint *geomint_explore(int count, const char *const words[])
{
    return gm_handle_open((struct gm_handle_words){.count = count, .words = words}, open_session);
}

/* ---- orders ---- */

/* stands for the selected lane */
static const size_t selected = SIZE_MAX;

/* Begins a call for a lane and selects it. Returns its session, or NULL with a message. */
static struct gm_session *begin(struct gm_call *call, geomint *handle, size_t lane)
{
    *call = gm_call_begin(handle);
    if (!gm_handle_has(handle, lane == selected ? 0 : lane)) {
        return NULL;
    }
    if (!handle->session) {
        gm_handle_refuse(handle, GEOMINT_USAGE, "geomint_explore opens lanes that can be changed");
    } else if (lane != selected) {
        handle->session->selected = lane;
    }
    return handle->session;
}

static int end(const struct gm_call *call, bool made, int refusal, const char *message)
{
    geomint *handle = call->handle;
    if (handle && handle->session && geomint_lanes(handle) > 0) {
        gm_handle_show(handle);
    }
    if (!made && geomint_status(handle) == GEOMINT_OK) {
        gm_handle_refuse(handle, refusal, message);
    }
    return gm_call_end(call);
}

static const char *key_at(size_t i, const void *scene)
{
    return ((const struct gm_scene *)scene)->parameters[i].key;
}

/* Completes an order by the scheme or the parameter that a word names; returns false with a message. */
static bool complete(struct gm_order *order, const struct gm_session *session, const char *word, int *refusal,
                     char *message)
{
    const struct gm_scene *scene = session->scene;
    switch (order->kind) {
    case GM_ORDER_SWITCH:
    case GM_ORDER_FORK:
    case GM_ORDER_ADD:
        order->scheme = gm_scheme_sought(word, refusal, message);
        if (order->scheme) {
            const struct gm_problem *problem = &session->lanes[session->selected]->problem;
            order->scheme = gm_scheme_find_for(gm_scheme_word(order->scheme), problem);
            *refusal = GEOMINT_USAGE;
        }
        return order->scheme;
    default: {
        char typed[256];
        gm_arguments_tell_scene(scene, typed, sizeof typed);
        const char *near = gm_nearest(word, scene->parameter_count, key_at, scene);
        order->row = gm_word_parameter(scene, word);
        return order->row || gm_refuse(message, "there is no parameter \"%.60s\"; %s%s", word,
                                       near ? "did you mean " : "see geomint list ", near ? near : typed);
    }
    }
}

/* Carries out an order on a lane, with the restart that is then due. `role` is the word's name in geomint.h; NULL: the
   order has none. */
static int act(geomint *handle, size_t lane, struct gm_order order, const char *role, const char *word)
{
    struct gm_call call;
    char message[GM_MESSAGE] = "";
    int refusal = GEOMINT_USAGE;
    struct gm_session *session = begin(&call, handle, lane);
    const bool made = session &&
                      (!role || (gm_handle_given(handle, word, role) &&
                                 complete(&order, session, word, &refusal, message))) &&
                      gm_session_obey(session, &order, message) &&
                      (!session->restart || gm_session_restart(session, message));
    return end(&call, made, refusal, message);
}

int geomint_forward(geomint *handle)
{
    return act(handle, selected, (struct gm_order){.kind = GM_ORDER_FORWARD}, NULL, NULL);
}

int geomint_back(geomint *handle)
{
    return act(handle, selected, (struct gm_order){.kind = GM_ORDER_BACK}, NULL, NULL);
}

int geomint_reverse(geomint *handle)
{
    return act(handle, selected, (struct gm_order){.kind = GM_ORDER_TURN}, NULL, NULL);
}

int geomint_restart(geomint *handle)
{
    return act(handle, selected, (struct gm_order){.kind = GM_ORDER_RESTART}, NULL, NULL);
}

int geomint_undo(geomint *handle)
{
    return act(handle, selected, (struct gm_order){.kind = GM_ORDER_UNDO}, NULL, NULL);
}

int geomint_visit(geomint *handle, double passed)
{
    return act(handle, selected, (struct gm_order){.kind = GM_ORDER_VISIT, .value = passed}, NULL, NULL);
}

int geomint_advance(geomint *handle, double t)
{
    struct gm_call call;
    const struct gm_session *session = begin(&call, handle, selected);
    while (session && isfinite(t) && gm_session_advance(handle->session, t)) {
    }
    return end(&call, isfinite(t), GEOMINT_USAGE, "the time must be a finite number");
}

int geomint_remove(geomint *handle, size_t lane)
{
    return act(handle, lane, (struct gm_order){.kind = GM_ORDER_REMOVE}, NULL, NULL);
}

int geomint_switch(geomint *handle, size_t lane, const char *scheme)
{
    return act(handle, lane, (struct gm_order){.kind = GM_ORDER_SWITCH}, "scheme", scheme);
}

int geomint_fork(geomint *handle, size_t lane, const char *scheme)
{
    return act(handle, lane, (struct gm_order){.kind = GM_ORDER_FORK}, "scheme", scheme);
}

int geomint_add(geomint *handle, size_t lane, const char *scheme)
{
    return act(handle, lane, (struct gm_order){.kind = GM_ORDER_ADD}, "scheme", scheme);
}

int geomint_set(geomint *handle, size_t lane, const char *key, const char *value)
{
    struct gm_order order = {.kind = value ? GM_ORDER_TYPE : GM_ORDER_STANDARD};
    snprintf(order.text, sizeof order.text, "%s", value ? value : "");
    return act(handle, lane, order, "key", key);
}

int geomint_slide(geomint *handle, size_t lane, const char *key, double position)
{
    return act(handle, lane, (struct gm_order){.kind = GM_ORDER_SLIDE, .value = position}, "key", key);
}

int geomint_look(geomint *handle, double azimuth, double elevation, double zoom)
{
    return act(handle, selected,
               (struct gm_order){.kind = GM_ORDER_LOOK, .x = azimuth, .y = elevation, .value = zoom}, NULL,
               NULL);
}

int geomint_point(geomint *handle, double across, double down)
{
    struct gm_call call;
    char message[GM_MESSAGE] = "";
    struct gm_spot spot = {0};
    const struct gm_session *session = begin(&call, handle, selected);
    struct gm_canvas *canvas = session ? handle->kept.canvas : NULL;
    const bool can = canvas && session->scene->point;
    struct gm_picture *picture = can ? gm_picture_open() : NULL;
    if (picture) {
        gm_lanes_draw((const struct gm_lane *const *)session->lanes, session->count, picture);
        spot = gm_canvas_locate(canvas, picture, across, down);
    } else {
        gm_refuse(message, canvas ? "the scene has no points to start from"
                                  : "the program's own rasteriser has drawn no picture");
    }
    const bool drawn = picture, hit = spot.panel;
    gm_picture_close(picture);
    const int status = end(&call, drawn, GEOMINT_USAGE, message);
    const struct gm_order order = {.kind = GM_ORDER_POINT, .x = spot.x, .y = spot.y};
    return hit ? act(handle, selected, order, NULL, NULL) : status;
}

int geomint_press(geomint *handle, const char *key)
{
    struct gm_order order;
    if (key && gm_key_order(gm_key_named(key, strlen(key)), &order)) {
        return act(handle, selected, order, NULL, NULL);
    }
    struct gm_call call;
    const struct gm_session *session = begin(&call, handle, selected);
    if (session && gm_handle_given(handle, key, "key")) {
        gm_handle_refuse(handle, GEOMINT_USAGE, "this key gives no order by itself");
    }
    return gm_call_end(&call);
}

/* ---- texts ---- */

static void put_lanes(struct gm_row *view, const struct gm_session *session, const struct gm_shot *shot)
{
    struct gm_row lanes = gm_row_open(view, "lanes", ']');
    for (size_t i = 0; i < shot->lane_count; i++) {
        const struct gm_shot_lane *lane = &shot->lanes[i];
        const struct gm_run *run = session->lanes[i]->run;
        char sentence[GM_MESSAGE];
        gm_failure_sentence(session->lanes[i], sentence, sizeof sentence);
        struct gm_row row = gm_row_open(&lanes, NULL, '}');
        gm_row_put(
            &row,
            "scheme %s, title %s, status %s, message %s, t %.17g, steps %.0f, evaluations %.0f, from_start %.17g",
            lane->scheme->name, lane->scheme->title, gm_status_name(lane->status), sentence, lane->t,
            (double)run->steps, gm_run_per_member(run, run->evaluations), gm_session_from_start(session, i));
        struct gm_row values = gm_row_open(&row, "values", '}');
        for (size_t k = 0; k < shot->observable_count; k++) {
            if (shot->measured[k]) {
                gm_row_number(&values, shot->scene->observables[k].key, lane->values[k], 17);
            }
        }
    }
}

static void put_observables(struct gm_row *view, const struct gm_shot *shot)
{
    struct gm_row observables = gm_row_open(view, "observables", ']');
    for (size_t k = 0; k < shot->observable_count; k++) {
        const struct gm_observable *observable = &shot->scene->observables[k];
        if (shot->measured[k]) {
            struct gm_row row = gm_row_open(&observables, NULL, '}');
            gm_row_put(&row, "key %s, title %s, unit %s", observable->key, observable->title,
                       observable->unit);
        }
    }
}

static void put_parameters(struct gm_row *view, const struct gm_shot *shot)
{
    struct gm_row parameters = gm_row_open(view, "parameters", ']');
    for (size_t k = 0; k < shot->parameter_count; k++) {
        const struct gm_shot_parameter *parameter = &shot->parameters[k];
        const struct gm_parameter *row = parameter->row;
        struct gm_row one = gm_row_open(&parameters, NULL, '}');
        gm_row_put(&one, "key %s, value %s, position %.17g, live %d, differs %d, unit %s, help %s", row->key,
                   parameter->value, parameter->position < 0 ? NAN : parameter->position, row->live,
                   parameter->differs, row->unit, row->help);
        struct gm_row choices = gm_row_open(&one, "choices", ']');
        static const char *const answers[] = {"no", "yes", NULL};
        const char *const *choice = row->type == GM_BOOLEAN ? answers : row->choices;
        for (; choice && *choice; choice++) {
            gm_row_text(&choices, NULL, *choice);
        }
    }
}

/* Writes a text of a session; `put` returns false when out of memory. */
static const char *tell(geomint *handle, bool (*put)(FILE *stream, geomint *handle))
{
    struct gm_call call;
    struct gm_text_stream writing;
    const char *text = NULL;
    FILE *stream = begin(&call, handle, selected) ? gm_stream_begin(&writing) : NULL;
    if (stream && put(stream, handle)) {
        text = gm_handle_written(handle, &writing);
    } else if (stream) {
        free(gm_stream_end(&writing));
    }
    gm_call_end(&call);
    return text;
}

static bool put_view(FILE *stream, geomint *handle)
{
    const struct gm_session *session = handle->session;
    struct gm_shot *shot = handle->shot;
    gm_shot_take(shot, session, false);
    struct gm_row row = gm_row_begin(stream);
    gm_row_put(&row, "scene %s, title %s, unit %s, t %.17g, passed %.17g, reach %.17g, ahead %.17g",
               shot->scene->name, shot->scene->title, shot->scene->time ? shot->scene->time : "",
               gm_session_time(session), shot->gone, shot->reach, shot->ahead);
    gm_row_put(&row, "backwards %d, turned %d, overlaid %d, in_space %d, selected %i", shot->backwards,
               shot->turned, shot->overlaid, shot->in_space, (int)shot->selected);
    put_lanes(&row, session, shot);
    put_observables(&row, shot);
    put_parameters(&row, shot);
    gm_row_close(&row, "");
    return true;
}

const char *geomint_view(geomint *handle)
{
    return tell(handle, put_view);
}

static bool put_schemes(FILE *stream, geomint *handle)
{
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES];
    const size_t count = gm_session_fits(handle->session, schemes);
    for (size_t i = 0; i < count; i++) {
        fputc(i > 0 ? ',' : '[', stream);
        gm_scheme_put(stream, schemes[i]);
    }
    fputc(']', stream);
    return true;
}

const char *geomint_schemes(geomint *handle)
{
    return tell(handle, put_schemes);
}

static bool put_commands(FILE *stream, geomint *handle)
{
    char *picture = gm_session_picture_command(handle->session, handle->theme);
    char *explorer = picture ? gm_session_explorer_command(handle->session) : NULL;
    if (explorer) {
        struct gm_row row = gm_row_begin(stream);
        gm_row_put(&row, "picture %s, explorer %s", picture, explorer);
        gm_row_close(&row, "");
    }
    const bool made = explorer;
    free(picture);
    free(explorer);
    return made;
}

const char *geomint_commands(geomint *handle)
{
    return tell(handle, put_commands);
}
