/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Data of the scene of a room, in its arena. */
#include "scenes/flow/room_scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

const char *gm_room_keep(struct gm_user_room *user_room, struct gm_span span)
{
    return gm_arena_keep(user_room->arena, gm_span_words(user_room->room.text, span), free);
}

char *gm_room_format(struct gm_user_room *user_room, const char *format, ...)
{
    va_list arguments;
    char *text = NULL;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return gm_arena_keep(user_room->arena, length < 0 ? NULL : text, free);
}

const char *gm_room_text(struct gm_picture *picture, const struct gm_room *room, struct gm_span span)
{
    return gm_picture_text(picture, "%.*s", (int)(span.end - span.begin), room->text + span.begin);
}

void gm_room_refuse(struct gm_user_room *user_room, const struct gm_fault *fault)
{
    *user_room->wrong = *fault;
    gm_arena_refuse(user_room->arena, "%s", fault->sentence[0] ? fault->sentence : "not enough memory");
}
