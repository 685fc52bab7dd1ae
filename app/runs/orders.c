/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders of the user to a session, without a clock: changes of lanes, of parameters and schemes, and what undoes
   them. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/runs/session.h"
#include "core/basics.h"

/* the lane of a change that every lane has */
static const double all_lanes = -1;

/* Stores the order that undoes a change; the oldest one gives way. A dragged slider makes one change. */
static void note_undo(struct gm_session *session, struct gm_order order)
{
    const struct gm_order *last = session->undo_count > 0 ? &session->undos[session->undo_count - 1] : NULL;
    if (last && order.amount && last->amount && last->row == order.row && last->value == order.value) {
        return;
    }
    if (session->undo_count == GM_UNDOS) {
        memmove(session->undos, session->undos + 1, --session->undo_count * sizeof *session->undos);
    }
    session->undos[session->undo_count++] = order;
}

static bool undo(struct gm_session *session, char *message)
{
    if (session->undo_count == 0) {
        return gm_refuse(message, "There is nothing to undo.");
    }
    const struct gm_order *order = &session->undos[--session->undo_count];
    const size_t lane = order->value == all_lanes ? session->selected : (size_t)order->value;
    const bool scheme = order->kind == GM_ORDER_SWITCH;
    if (scheme ? !gm_session_switch(session, lane, order->scheme, message)
               : !gm_session_set(session, lane, order->row, order->text, &session->restart, message)) {
        return false;
    }
    gm_refuse(message, "Undone: %s is %.300s again.", scheme ? "the scheme" : order->row->key,
              scheme ? order->scheme->title : order->text);
    return true;
}

/* Forgets the changes that a removed lane had alone. */
static void forget_undos(struct gm_session *session, size_t lane)
{
    size_t count = 0;
    for (size_t i = 0; i < session->undo_count; i++) {
        if (session->undos[i].value != (double)lane) {
            session->undos[count] = session->undos[i];
            session->undos[count++].value -= session->undos[i].value > (double)lane;
        }
    }
    session->undo_count = count;
}

static bool move_parameter(struct gm_session *session, const struct gm_order *order, char *message)
{
    char text[GM_TYPED];
    const struct gm_parameter *row = order->row;
    const void *owner = gm_session_owner(session, session->selected, gm_is_setting(row));
    if (order->kind == GM_ORDER_STANDARD) {
        snprintf(text, sizeof text, "%s", row->standard);
    } else if (order->kind == GM_ORDER_TYPE) {
        if (row->type != GM_TEXT && strlen(order->text) >= GM_TEXT_SIZE) {
            return gm_refuse(message, "A value has at most %d letters.", GM_TEXT_SIZE - 1);
        }
        snprintf(text, sizeof text, "%s", order->text);
    } else if (order->kind == GM_ORDER_SLIDE) {
        if (!gm_slider_at(row, order->value, text)) {
            return gm_refuse(message, "%s has no range.", row->key);
        }
    } else if (!gm_slider_next(row, owner, order->amount, order->kind == GM_ORDER_NUDGE, text)) {
        return gm_refuse(message,
                         row->type == GM_TEXT ? "%s is a word of your own: enter types it."
                                              : "%s is at the end of its range.",
                         row->key);
    }
    if (session->undo_count > 0 && (order->kind != GM_ORDER_SLIDE || order->amount)) {
        session->undos[session->undo_count - 1].amount = 0; /* an earlier drag has ended */
    }
    const bool alone = gm_session_differs(session, row);
    struct gm_order back = {.kind = GM_ORDER_TYPE,
                            .amount = order->kind == GM_ORDER_SLIDE,
                            .value = alone ? (double)session->selected : all_lanes,
                            .row = row};
    gm_parameter_format(row, owner, back.text, sizeof back.text);
    if (!gm_session_set(session, session->selected, row, text, &session->restart, message)) {
        return false;
    }
    if (strcmp(back.text, text) != 0) {
        note_undo(session, back);
    }
    return true;
}

/* Switches the selected lane, unless it has the scheme. */
static bool switch_scheme(struct gm_session *session, const struct gm_scheme *scheme, char *message)
{
    const struct gm_scheme *before = session->lanes[session->selected]->scheme;
    if (!gm_session_switch(session, session->selected, scheme, message)) {
        return false;
    }
    if (before != scheme) {
        note_undo(
            session,
            (struct gm_order){.kind = GM_ORDER_SWITCH, .value = (double)session->selected, .scheme = before});
    }
    return true;
}

/* Moves the camera: the azimuth wraps around, elevation and zoom stop at their limits. */
static bool look(struct gm_session *session, const struct gm_order *order, char *message)
{
    const void *owner = gm_session_owner(session, session->selected, false);
    static const char *const keys[] = {"azimuth", "elevation", "zoom"};
    for (size_t k = 0; k < GM_COUNT(keys); k++) {
        const struct gm_parameter *row = gm_scene_parameter(session->scene, keys[k]);
        if (!row || gm_scene_idle(session->scene, owner, keys[k])) {
            return true; /* this picture is not in space */
        }
        const double value = gm_parameter_get(row, owner);
        double moved = k == 0 ? value + order->x : k == 1 ? value + order->y : value * order->value;
        moved -= k == 0 ? 360 * floor((moved + 180) / 360) : 0;
        moved = fmin(fmax(moved, row->lowest), row->highest);
        char text[GM_TYPED];
        snprintf(text, sizeof text, "%.4g", moved);
        if (moved != value &&
            !gm_session_set(session, session->selected, row, text, &session->restart, message)) {
            return false;
        }
    }
    return true;
}

/* Returns the snapshot time of an order: up or down by twentieths of the past, or by one snapshot at least. */
static double moment_of(const struct gm_session *session, const struct gm_order *order)
{
    const double gone = gm_session_gone(session);
    const double there = gone + order->amount * gm_session_reach(session) / 20;
    return order->amount == 0  ? order->value
           : order->amount < 0 ? there
                               : fmax(there, gm_session_after(session, gone));
}

/* Restarts all lanes from a point of the picture. */
static bool start_from(struct gm_session *session, double x, double y, char *message)
{
    struct gm_choice choices[GM_CHOICES];
    const struct gm_scene *scene = session->scene;
    const void *parameters = gm_session_owner(session, session->selected, false);
    const bool errors = scene->asked_shown && scene->asked_shown(scene, parameters) > 0;
    if (!scene->point || errors) { /* a picture of errors has no starts */
        return true;
    }
    size_t count = scene->point(parameters, x, y, choices);
    for (size_t i = 0; i < count; i++) {
        const struct gm_parameter *row = gm_scene_parameter(scene, choices[i].key);
        if (!gm_session_set(session, session->selected, row, choices[i].value, &session->restart, message)) {
            return false;
        }
    }
    return true;
}

/* The first scheme, in the scene's order, that fits and that no lane has, or NULL. */
static const struct gm_scheme *unused_scheme(const struct gm_session *session)
{
    const struct gm_scheme *schemes[GM_FITTING_SCHEMES];
    const size_t count = gm_session_fits(session, schemes);
    for (size_t i = 0; i < count; i++) {
        size_t k = 0;
        while (k < session->count && session->lanes[k]->scheme != schemes[i]) {
            k++;
        }
        if (k == session->count) {
            return schemes[i];
        }
    }
    return NULL;
}

/* A NULL scheme stands for the first unused one. */
static bool add_lane(struct gm_session *session, const struct gm_scheme *scheme, char *message)
{
    scheme = scheme ? scheme : unused_scheme(session);
    if (!scheme) {
        return gm_refuse(message, "Every scheme that fits has a lane already.");
    }
    if (!gm_session_add(session, session->selected, scheme, message)) {
        return false;
    }
    session->selected = session->count - 1;
    return true;
}

bool gm_session_obey(struct gm_session *session, const struct gm_order *order, char *message)
{
    size_t *selected = &session->selected;
    bool ok = true;
    message[0] = '\0';
    switch (order->kind) {
    case GM_ORDER_FORWARD: {
        const double next = gm_session_next(session);
        while (isfinite(next) && gm_session_advance(session, next)) {
        }
        return true;
    }
    case GM_ORDER_BACK:
        return gm_session_back(session, message);
    case GM_ORDER_TURN:
        return gm_session_turn(session, message);
    case GM_ORDER_VISIT:
        return gm_session_visit(session, moment_of(session, order), message);
    case GM_ORDER_SELECT:
        if (order->amount != 0) {
            *selected = (*selected + session->count + (size_t)order->amount) % session->count;
        } else if (order->value < (double)session->count) {
            *selected = (size_t)order->value;
        }
        return true;
    case GM_ORDER_SWITCH:
        return switch_scheme(session, order->scheme, message);
    case GM_ORDER_FORK:
        ok = gm_session_fork(session, *selected, order->scheme, message);
        *selected = ok ? session->count - 1 : *selected;
        return ok;
    case GM_ORDER_ADD:
        return add_lane(session, order->scheme, message);
    case GM_ORDER_REMOVE:
        ok = gm_session_remove(session, *selected, message);
        if (ok) {
            forget_undos(session, *selected);
        }
        *selected = *selected < session->count ? *selected : session->count - 1;
        return ok;
    case GM_ORDER_OVERLAY:
        return gm_session_overlay(session, message);
    case GM_ORDER_UNDO:
        return undo(session, message);
    case GM_ORDER_MOVE:
    case GM_ORDER_NUDGE:
    case GM_ORDER_STANDARD:
    case GM_ORDER_TYPE:
    case GM_ORDER_SLIDE:
        return move_parameter(session, order, message);
    case GM_ORDER_LOOK:
        return look(session, order, message);
    case GM_ORDER_POINT:
        return start_from(session, order->x, order->y, message);
    case GM_ORDER_RESTART:
        session->restart = true;
        return true;
    default:
        return gm_refuse(message, "Only the explorer can do this.");
    }
}
