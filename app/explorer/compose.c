/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the explorer's state to its screen: shots of the worker are taken, and a screen is composed. */
#include <stddef.h>
#include <stdint.h>

#include "app/explorer/events.h"
#include "app/explorer/view/view.h"
#include "render/clock.h"

enum { FRAME_MILLISECONDS = 16, SLOW_FRAME_MILLISECONDS = 33, LOOK_MILLISECONDS = 66 };
/* the part of a core up to which frames come at full pace */
static const double FRAMES_SHARE = 1.0 / 3;

/* Starts showing what to watch in a newly opened scene, for some seconds. */
static void begin_watch(struct gm_explorer *explorer)
{
    enum { WATCH_MILLISECONDS = 8000 };
    struct gm_face *face = &explorer->face;
    if (face->watched != explorer->open.shot->scene) {
        face->watched = explorer->open.shot->scene;
        face->watch_until = gm_clock_milliseconds() + WATCH_MILLISECONDS;
    }
}

/* Requests the measurement of the scheme on a page. */
static void ask_measure(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    if (face->page == GM_PAGE_HELP) {
        face->explained = explorer->open.shot->lanes[explorer->open.shot->selected].scheme;
    }
    if (face->page == GM_PAGE_HELP || face->page == GM_PAGE_SCHEME) {
        gm_measure_ask(&explorer->measure, face->explained);
        face->measured = gm_measure_text(&explorer->measure);
    }
}

bool gm_explorer_compose(struct gm_explorer *explorer)
{
    struct gm_screen *screen = &explorer->screen;
    if (explorer->list.shown) {
        bool looked = gm_explorer_is_looked_at(explorer);
        gm_screen_draw_start(screen, &explorer->face, &explorer->list.start,
                             looked ? explorer->open.shot : NULL, explorer->fresh,
                             looked ? explorer->open.said : "");
    } else if (explorer->open.shot) {
        ask_measure(explorer);
        begin_watch(explorer);
        gm_screen_draw_scene(screen, &explorer->face, explorer->open.shot, explorer->fresh);
    } else {
        return false;
    }
    if (explorer->face.loss) {
        const struct gm_sheet whole = {.cells = &screen->cells,
                                       .face = &explorer->face,
                                       .width = screen->cells.columns,
                                       .height = screen->cells.rows,
                                       .hits = &screen->hits};
        gm_screen_ask(&whole, explorer->face.loss);
    }
    explorer->fresh = false;
    return true;
}

/* ---- shots of the worker ---- */

/* Shows the requested command lines, and offers the first to the clipboard. */
static void read_command(struct gm_explorer *explorer)
{
    const struct gm_shot *shot = explorer->open.shot;
    if (shot->command_number == explorer->open.told) {
        return;
    }
    explorer->open.told = shot->command_number;
    explorer->face.awaited = false;
    if (explorer->editing) {
        gm_explorer_edit_system(explorer, shot->commands[GM_COMMAND_EXPLORER]);
        return;
    }
    explorer->face.page = GM_PAGE_COMMAND;
    explorer->face.scroll = 0;
    explorer->face.command = GM_COMMAND_PICTURE;
    gm_explorer_copy(explorer);
}

/* Returns the milliseconds between frames: costly ones and pictures of pixels come half as often, which
   leaves time for steps and other processes. */
static int period(const struct gm_explorer *explorer, const struct gm_shot *shot)
{
    const double affordable = 1000 * (shot->cost + explorer->draw_cost) / FRAMES_SHARE;
    if (explorer->list.shown) {
        return LOOK_MILLISECONDS;
    }
    if (explorer->face.pixels || affordable > SLOW_FRAME_MILLISECONDS) {
        return SLOW_FRAME_MILLISECONDS;
    }
    return affordable > FRAME_MILLISECONDS ? (int)affordable : FRAME_MILLISECONDS;
}

/* Returns the time of the next shot, at an even pace, with a pause that leaves others time. */
static int64_t next_time(int64_t last, int period)
{
    enum { LEAST_PAUSE = 5 };
    int64_t now = gm_clock_milliseconds();
    return last + period > now + LEAST_PAUSE ? last + period : now + LEAST_PAUSE;
}

bool gm_explorer_is_busy(struct gm_explorer *explorer)
{
    struct gm_check *check = &explorer->check;
    return (check->open && gm_job_is_busy(&check->job)) || gm_studies_are_busy(&explorer->open.studies) ||
           explorer->measure.fd >= 0;
}

void gm_explorer_take(struct gm_explorer *explorer, struct gm_shot *shot)
{
    if (shot) {
        explorer->open.shot = shot;
        explorer->open.scene = shot->scene; /* the worker has made the scene by now */
        explorer->open.asked = false;
        read_command(explorer);
        explorer->open.next_shot = next_time(explorer->open.next_shot, period(explorer, shot));
        explorer->dirty = true;
        explorer->fresh = explorer->fresh || shot->drawn;
        if (shot->drawn) {
            explorer->display.stale = true;
        }
    } else if (explorer->open.worker && !explorer->open.shot && !explorer->open.said[0] &&
               gm_worker_failed(explorer->open.worker, explorer->open.said)) {
        explorer->dirty = true;
        if (!explorer->list.shown) {
            gm_explorer_show_start(explorer);
        }
    }
}
