/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line that is typed, from its first key to the order that it becomes. */
#include "app/explorer/view/prompt.h"

#include <stdio.h>
#include <string.h>

/* Where running ahead goes if no time is typed. */
static void ahead_text(const struct gm_shot *shot, char *text, size_t size)
{
    snprintf(text, size, "%.6g", shot->ahead);
}

enum gm_key_result gm_prompt_open(const struct gm_keystroke *press, enum gm_prompt prompt)
{
    struct gm_face *face = press->face;
    if (prompt == GM_PROMPT_VALUE && face->parameter >= press->shot->parameter_count) {
        return GM_KEY_DONE;
    }
    face->prompt = prompt;
    face->typed[0] = '\0';
    return GM_KEY_DONE;
}

enum gm_key_result gm_prompt_press(const struct gm_keystroke *press)
{
    struct gm_face *face = press->face;
    if (gm_key_is_escape(press->key)) {
        face->prompt = GM_PROMPT_NONE;
        return GM_KEY_DONE;
    }
    if (!gm_key_is_enter(press->key)) {
        gm_typed_key(face->typed, press->key);
        return GM_KEY_DONE;
    }
    enum gm_prompt prompt = face->prompt;
    face->prompt = GM_PROMPT_NONE;
    if (!face->typed[0] && prompt == GM_PROMPT_VALUE) {
        return GM_KEY_DONE;
    }
    struct gm_order order = {.kind = prompt == GM_PROMPT_AHEAD ? GM_ORDER_AHEAD : GM_ORDER_TYPE};
    if (face->typed[0]) {
        snprintf(order.text, sizeof order.text, "%s", face->typed);
    } else {
        ahead_text(press->shot, order.text, sizeof order.text);
    }
    if (prompt == GM_PROMPT_VALUE) {
        order.row = press->shot->parameters[face->parameter].row;
        order.of_scheme = press->shot->parameters[face->parameter].of_scheme;
    }
    return gm_keystroke_order(press, order);
}

/* As much of the end of what was typed as leaves room for the help, where keys are added. */
static const char *end_of(const char *typed, const char **before)
{
    enum { SHOWN = 40 };
    const size_t length = strlen(typed);
    *before = length > SHOWN ? "…" : "";
    return length > SHOWN ? typed + length - SHOWN : typed;
}

void gm_prompt_text(const struct gm_face *face, const struct gm_shot *shot, char *text, size_t size)
{
    const char *before, *typed = end_of(face->typed, &before);
    if (face->prompt == GM_PROMPT_AHEAD) {
        char standard[32] = "";
        ahead_text(shot, standard, sizeof standard);
        snprintf(text, size, "Run ahead to t = %s%s_   (enter alone: %s)", before, typed, standard);
    } else {
        const struct gm_parameter *row = shot->parameters[face->parameter].row;
        snprintf(text, size, "%s = %s%s_   (%s)", row->key, before, typed, row->help);
    }
}
