/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Carries out orders on a session, in the thread that steps. The next shot reports what failed. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/explorer/worker/session.h"
#include "core/basics.h"

/* Returns true for a parameter of the schemes. */
static bool is_of_scheme(const struct gm_parameter *row)
{
    return row >= gm_settings_parameters && row < gm_settings_parameters + gm_settings_parameter_count;
}

/* ---- undoing ---- */

/* the lane of a change that every lane has */
static const double all_lanes = -1;

/* Stores the order that undoes a change; the oldest one gives way. A dragged slider makes one change. */
static void note_undo(struct gm_play *play, struct gm_order order)
{
    const struct gm_order *last = play->undo_count > 0 ? &play->undos[play->undo_count - 1] : NULL;
    if (last && order.amount && last->amount && last->row == order.row && last->value == order.value) {
        return;
    }
    if (play->undo_count == GM_UNDOS) {
        memmove(play->undos, play->undos + 1, --play->undo_count * sizeof *play->undos);
    }
    play->undos[play->undo_count++] = order;
}

static bool undo(struct gm_play *play, char *message)
{
    if (play->undo_count == 0) {
        return gm_refuse(message, "There is nothing to undo.");
    }
    const struct gm_order *order = &play->undos[--play->undo_count];
    const size_t lane = order->value == all_lanes ? play->selected : (size_t)order->value;
    const bool scheme = order->kind == GM_ORDER_SWITCH;
    if (scheme ? !gm_session_switch(&play->session, lane, order->scheme, message)
               : !gm_session_set(&play->session, lane, order->row, is_of_scheme(order->row), order->text,
                                 &play->restart, message)) {
        return false;
    }
    gm_play_say(play, "Undone: %s is %.300s again.", scheme ? "the scheme" : order->row->key,
                scheme ? order->scheme->title : order->text);
    return true;
}

/* Forgets the changes that a removed lane had alone. */
static void forget_undos(struct gm_play *play, size_t lane)
{
    size_t count = 0;
    for (size_t i = 0; i < play->undo_count; i++) {
        if (play->undos[i].value != (double)lane) {
            play->undos[count] = play->undos[i];
            play->undos[count++].value -= play->undos[i].value > (double)lane;
        }
    }
    play->undo_count = count;
}

static void move_parameter(struct gm_play *play, const struct gm_order *order)
{
    char text[GM_TYPED], message[GM_MESSAGE];
    const struct gm_parameter *row = order->row;
    const void *owner = gm_session_owner(&play->session, play->selected, is_of_scheme(row));
    if (order->kind == GM_ORDER_STANDARD) {
        snprintf(text, sizeof text, "%s", row->standard);
    } else if (order->kind == GM_ORDER_TYPE) {
        snprintf(text, sizeof text, "%s", order->text);
    } else if (order->kind == GM_ORDER_SLIDE) {
        if (!gm_slider_at(row, order->value, text)) {
            return;
        }
    } else if (!gm_slider_next(row, owner, order->amount, order->kind == GM_ORDER_NUDGE, text)) {
        gm_play_say(play,
                    row->type == GM_TEXT ? "%s is a word of your own: enter types it."
                                         : "%s is at the end of its range.",
                    row->key);
        return;
    }
    if (play->undo_count > 0 && (order->kind != GM_ORDER_SLIDE || order->amount)) {
        play->undos[play->undo_count - 1].amount = 0; /* an earlier drag has ended */
    }
    const bool alone = gm_session_differs(&play->session, row, is_of_scheme(row));
    struct gm_order back = {.kind = GM_ORDER_TYPE,
                            .amount = order->kind == GM_ORDER_SLIDE,
                            .value = alone ? (double)play->selected : all_lanes,
                            .row = row};
    gm_parameter_format(row, owner, back.text, sizeof back.text);
    if (!gm_session_set(&play->session, play->selected, row, is_of_scheme(row), text, &play->restart,
                        message)) {
        gm_play_say(play, "%s", message);
    } else if (strcmp(back.text, text) != 0) {
        note_undo(play, back);
    }
}

/* Switches the selected lane, unless it has the scheme. */
static bool switch_scheme(struct gm_play *play, const struct gm_scheme *scheme, char *message)
{
    const struct gm_scheme *before = play->session.lanes[play->selected]->scheme;
    if (!gm_session_switch(&play->session, play->selected, scheme, message)) {
        return false;
    }
    if (before != scheme) {
        note_undo(play, (struct gm_order){
                            .kind = GM_ORDER_SWITCH, .value = (double)play->selected, .scheme = before});
    }
    return true;
}

/* Moves the camera: the azimuth wraps around, elevation and zoom stop at their limits. */
static bool look(struct gm_play *play, const struct gm_order *order, char *message)
{
    struct gm_session *session = &play->session;
    const void *owner = gm_session_owner(session, play->selected, false);
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
            !gm_session_set(session, play->selected, row, false, text, &play->restart, message)) {
            return false;
        }
    }
    return true;
}

static bool run_ahead(struct gm_play *play, const char *text, char *message)
{
    double to;
    if (!gm_number_parse(text, &to) || !isfinite(to)) {
        return gm_refuse(message, "\"%s\" is not a time.", text);
    }
    if (gm_play_left_until(play, to) <= 0) {
        return gm_refuse(message, "t = %g has already passed.", to);
    }
    gm_play_run_ahead(play, to);
    return true;
}

/* Returns the snapshot time of an order: one up or down is a twentieth of the past, or at least one
   snapshot. */
static double moment_of(const struct gm_session *session, const struct gm_order *order)
{
    double gone = gm_session_gone(session), part = gm_session_reach(session) / 20;
    return order->amount == 0  ? order->value
           : order->amount < 0 ? gone - part
                               : fmax(gone + part, gm_session_after(session, gone));
}

static bool turn(struct gm_play *play, char *message)
{
    struct gm_session *session = &play->session;
    if (!gm_session_turn(session, message)) {
        return false;
    }
    const struct gm_lane *lane = session->lanes[0];
    play->homewards = gm_play_left_until(play, lane->t0) > 0.5 * fabs(lane->run->dt);
    gm_play_say(play, play->homewards ? "Time runs back to the start." : "Time runs the other way.");
    return true;
}

/* Restarts all lanes from a point of the picture. */
static bool start_from(struct gm_play *play, double x, double y, char *message)
{
    struct gm_session *session = &play->session;
    struct gm_choice choices[GM_CHOICES];
    const struct gm_scene *scene = session->scene;
    const void *parameters = gm_session_owner(session, play->selected, false);
    const bool errors = scene->asked_shown && scene->asked_shown(scene, parameters) > 0;
    if (!scene->point || errors) { /* a picture of errors has no starts */
        return true;
    }
    size_t count = scene->point(parameters, x, y, choices);
    for (size_t i = 0; i < count; i++) {
        const struct gm_parameter *row = gm_scene_parameter(scene, choices[i].key);
        if (!gm_session_set(session, play->selected, row, false, choices[i].value, &play->restart, message)) {
            return false;
        }
    }
    return true;
}

static bool add_lane(struct gm_play *play, char *message)
{
    const struct gm_scheme *scheme = gm_session_unused(&play->session);
    if (!scheme) {
        return gm_refuse(message, "Every scheme that fits has a lane already.");
    }
    if (!gm_session_add(&play->session, play->selected, scheme, message)) {
        return false;
    }
    play->selected = play->session.count - 1;
    return true;
}

void gm_order_obey(const struct gm_order *order, struct gm_play *play, struct gm_capture *capture)
{
    struct gm_session *session = &play->session;
    char message[GM_MESSAGE] = "";
    if (play->restart && order->kind < GM_ORDER_SPEED) {
        gm_play_restart(play); /* a later order acts on the restarted lanes */
    }
    double due = gm_play_due(play);
    /* The other orders preserve the elapsed part of a step. */
    bool jumps = order->kind <= GM_ORDER_RECORD || order->kind == GM_ORDER_RESTART;
    bool ok = true;
    switch (order->kind) {
    case GM_ORDER_PAUSE:
        play->paused = !play->paused;
        break;
    case GM_ORDER_FORWARD: {
        const double next = gm_session_next(session);
        play->paused = true;
        while (isfinite(next) && gm_session_advance(session, next)) {
        }
        break;
    }
    case GM_ORDER_RESTART:
        play->restart = true;
        break;
    case GM_ORDER_SPEED:
        gm_play_set_speed(play, play->speed + order->amount);
        break;
    case GM_ORDER_BACK:
        play->paused = true;
        ok = gm_session_back(session, message);
        break;
    case GM_ORDER_TURN:
        ok = turn(play, message);
        break;
    case GM_ORDER_VISIT:
        play->paused = true;
        ok = gm_session_visit(session, moment_of(session, order), message);
        break;
    case GM_ORDER_AHEAD:
        ok = run_ahead(play, order->text, message);
        break;
    case GM_ORDER_HALT:
        play->ahead = false;
        break;
    case GM_ORDER_SELECT:
        if (order->amount != 0) {
            play->selected = (play->selected + session->count + (size_t)order->amount) % session->count;
        } else if (order->value < (double)session->count) {
            play->selected = (size_t)order->value;
        }
        break;
    case GM_ORDER_LOOK:
        ok = look(play, order, message);
        break;
    case GM_ORDER_POINT:
        ok = start_from(play, order->x, order->y, message);
        break;
    case GM_ORDER_MOVE:
    case GM_ORDER_NUDGE:
    case GM_ORDER_STANDARD:
    case GM_ORDER_TYPE:
    case GM_ORDER_SLIDE:
        move_parameter(play, order);
        break;
    case GM_ORDER_SWITCH:
        ok = switch_scheme(play, order->scheme, message);
        break;
    case GM_ORDER_FORK:
        ok = gm_session_fork(session, play->selected, order->scheme, message);
        play->selected = ok ? session->count - 1 : play->selected;
        break;
    case GM_ORDER_OVERLAY:
        ok = gm_session_overlay(session, message);
        break;
    case GM_ORDER_ADD:
        ok = add_lane(play, message);
        break;
    case GM_ORDER_REMOVE:
        ok = gm_session_remove(session, play->selected, message);
        if (ok) {
            forget_undos(play, play->selected);
        }
        play->selected = play->selected < session->count ? play->selected : session->count - 1;
        break;
    case GM_ORDER_RECORD:
        gm_capture_record(capture, play, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_UNDO:
        ok = undo(play, message);
        break;
    case GM_ORDER_TELL:
        gm_capture_tell(capture, session, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_SAVE:
        gm_capture_save(play, (enum gm_theme)order->amount);
        break;
    case GM_ORDER_SYSTEM:
        gm_capture_save_system(play);
        break;
    case GM_ORDER_TOUR:
        gm_play_tour_step(play, order->tour, order->step, order->amount != 0);
        break;
    case GM_ORDER_RUN:
        play->paused = false;
        break;
    }
    if (!ok) {
        gm_play_say(play, "%s", message);
    }
    if (order->kind == GM_ORDER_BACK || order->kind == GM_ORDER_TURN || order->kind == GM_ORDER_VISIT) {
        gm_agenda_rewind(&play->agenda, gm_session_time(session));
    }
    gm_play_set_clock(play, jumps ? gm_session_time(session) : due);
    play->changed = capture->unrecorded = true;
}
