/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any text as a room: it is read, and what its boundary gives can be evaluated, or it is refused with a sentence. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/room.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* Of every line what it gives at a point; sources and probes have their own. */
static void evaluate(const struct gm_room *room, size_t size)
{
    const double at[4] = {0.5, 0.25, 0.75, 1.5};
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        double point[2] = {0, 0};
        for (enum gm_room_key key = 0; key < GM_ROOM_KEYS; key++) {
            const double value = gm_room_value(room, line, key, at, -7);
            require(line->value[key].place > 0 || value == -7);
        }
        if (line->word == GM_ROOM_SOURCE || line->word == GM_ROOM_PROBE) {
            gm_room_point(room, line, point);
        }
        require(memchr(line->name, '\0', sizeof line->name) && line->place <= size);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    require(text != NULL);
    memcpy(text, data, size);
    text[size] = '\0';
    struct gm_fault fault = {.sentence = ""};
    struct gm_room *room = gm_room_open(&(struct gm_room_input){.text = text, .length = size}, &fault);
    if (room) {
        evaluate(room, size);
    } else {
        require(fault.sentence[0] && strlen(fault.sentence) < GM_FAULT_SENTENCE && fault.offset <= size);
    }
    gm_room_close(room);
    free(text);
    return 0;
}
