/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a lane is called, also after schemes were switched in flight. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/frame/lane.h"

/* Of a name "RK4, Δt = 0.1": the part that begins so, and ends with it or, for a parameter, before the next
   comma; NULL if it has none. */
static const char *part_of(const char *name, const char *front, bool parameter, size_t *length)
{
    const size_t known = strlen(front);
    for (const char *part = name; part; part = strstr(part, ", ")) {
        part += part == name ? 0 : 2;
        *length = known;
        if (strncmp(part, front, known) == 0) {
            *length += parameter ? strcspn(part + known, ",") : 0;
            if (part[*length] == '\0' || part[*length] == ',') {
                return part;
            }
        }
    }
    return NULL;
}

void gm_shown_rename(struct gm_shown *shown, const char *before, const char *after, bool parameter)
{
    char *names[] = {shown->panel_name, shown->colour_name};
    for (size_t k = 0; k < 2; k++) {
        char was[sizeof shown->panel_name];
        size_t length = 0;
        snprintf(was, sizeof was, "%s", names[k]);
        const char *part = part_of(was, before, parameter, &length);
        if (part) {
            snprintf(names[k], sizeof was, "%.*s%s%s", (int)(part - was), was, after, part + length);
        }
    }
}

/* "name, then Verlet, then RK4"; of many switches the last two. */
static void add_switches(const struct gm_lane *lane, char *name, size_t size)
{
    size_t used = strlen(name);
    const size_t first = lane->switch_count > 2 ? lane->switch_count - 2 : 0;
    for (size_t i = first; i < lane->switch_count && used < size; i++) {
        used += (size_t)snprintf(name + used, size - used, "%s, then %s", i == first && first > 0 ? " …" : "",
                                 lane->switches[i].scheme->title);
    }
}

/* The names as they are to be shown now. */
static void compose(struct gm_lane *lane)
{
    struct gm_shown *shown = &lane->shown;
    *shown = lane->named;
    snprintf(lane->schemes, sizeof lane->schemes, "%s", lane->first_scheme->title);
    add_switches(lane, lane->schemes, sizeof lane->schemes);
    if (lane->switch_count == 0) {
        return;
    }
    if (shown->colour_name[0]) {
        add_switches(lane, shown->colour_name, sizeof shown->colour_name);
        return;
    }
    if (!shown->panel_name[0]) {
        snprintf(shown->panel_name, sizeof shown->panel_name, "%s", lane->first_scheme->title);
    }
    add_switches(lane, shown->panel_name, sizeof shown->panel_name);
}

void gm_lane_show(struct gm_lane *lane, const struct gm_shown *named)
{
    lane->named = *named;
    compose(lane);
}

bool gm_lane_note_switch(struct gm_lane *lane, const struct gm_scheme *scheme)
{
    const long step = lane->run->steps;
    struct gm_switch *longer = realloc(lane->switches, (lane->switch_count + 1) * sizeof *lane->switches);
    if (!longer) {
        return false;
    }
    lane->switches = longer;
    while (lane->switch_count > 0 && longer[lane->switch_count - 1].step >= step) {
        lane->switch_count--;
    }
    const size_t count = lane->switch_count;
    if (step == 0) { /* nothing was made by the one before */
        gm_shown_rename(&lane->named, lane->first_scheme->title, scheme->title, false);
        lane->first_scheme = scheme;
    } else if (scheme != (count > 0 ? longer[count - 1].scheme : lane->first_scheme)) {
        longer[lane->switch_count++] = (struct gm_switch){.scheme = scheme, .step = step, .t = lane->run->t};
    }
    lane->switches_kept = lane->switch_count;
    compose(lane);
    return true;
}

void gm_lane_show_switches(struct gm_lane *lane, long step)
{
    lane->switch_count = lane->switches_kept;
    while (lane->switch_count > 0 && lane->switches[lane->switch_count - 1].step > step) {
        lane->switch_count--;
    }
    compose(lane);
}

bool gm_lane_copy_switches(struct gm_lane *lane, const struct gm_lane *from)
{
    const size_t size = from->switch_count * sizeof *from->switches;
    struct gm_switch *copy = malloc(size ? size : 1);
    if (!copy) {
        return false;
    }
    if (size > 0) {
        memcpy(copy, from->switches, size);
    }
    free(lane->switches);
    lane->switches = copy;
    lane->switch_count = lane->switches_kept = from->switch_count;
    lane->first_scheme = from->first_scheme;
    gm_lane_show(lane, &from->named);
    return true;
}
