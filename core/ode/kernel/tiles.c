/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tiles of an ensemble: gathered, advanced, scattered; a tile that is the whole ensemble stays in place. */
#include "core/ode/kernel/tiles.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/ode/kernel/loops.h"

/* The most members are 31 lines of the cache: rows that are a power of two apart would be in each other's way. */
enum { MOST_MEMBERS = 248, IN_CACHE = 4096, LINE = 64 };

/* The rows of a tile begin where lines of the cache do: else every register that is loaded lies in two of them. */
struct tiles {
    struct gm_arena *arena; /* owns all of this */
    size_t members;         /* members of a tile */
    double *y, *carry, *scratch, *shared;
};

static size_t members_of(const struct gm_problem *problem)
{
    const size_t fit = IN_CACHE / (problem->n + 1) / 8 * 8;
    const size_t most = fit < 8 ? 8 : fit > MOST_MEMBERS ? MOST_MEMBERS : fit;
    return problem->m < most ? problem->m : most;
}

/* The arguments of the body that opens tiles. */
struct opening {
    const struct gm_problem *problem;
    size_t scratch, shared;
    struct tiles *tiles;
};

static void open_tiles(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    const struct gm_problem *problem = opening->problem;
    struct tiles *tiles = opening->tiles = gm_arena_take(arena, 1, sizeof *tiles);
    const size_t members = members_of(problem), gathered = members < problem->m ? problem->n * members : 0,
                 count = 2 * gathered + opening->scratch * members + opening->shared;
    tiles->arena = arena;
    tiles->members = members;
    tiles->y = gm_arena_keep(arena, aligned_alloc(LINE, (count * sizeof(double) + LINE) / LINE * LINE), free);
    tiles->carry = tiles->y + gathered;
    tiles->scratch = tiles->carry + gathered;
    tiles->shared = tiles->scratch + opening->scratch * members;
}

void *gm_tiles_open(const struct gm_problem *problem, size_t scratch, size_t shared)
{
    struct opening opening = {problem, scratch, shared, NULL};
    return gm_arena_made(open_tiles, &opening) ? opening.tiles : NULL;
}

/* Copies `count` members of a component-major array with m members per component into one with `width`. */
static void copy(const double *from, size_t m, double *to, size_t width, size_t n, size_t count)
{
    for (size_t c = 0; c < n; c++) {
        memcpy(to + c * width, from + c * m, count * sizeof *to);
    }
}

/* Returns true if all are finite and at most limit (a NaN compares false); the counter is as wide as a
   number, so that many are compared at once. */
GM_CLONES static bool are_within(const double *y, size_t count, double limit)
{
    int64_t within = 0;
    for (size_t i = 0; i < count; i++) {
        within += fabs(y[i]) <= limit ? 1 : 0;
    }
    return within == (int64_t)count;
}

static void advance(const struct gm_task *task, gm_tile_step *step, struct gm_tile *tile,
                    struct gm_progress *progress)
{
    const size_t active = gm_tile_components(task->problem) * tile->members;
    double *trace = task->trace;
    for (int64_t done = 0; done < progress->done; done++) {
        enum gm_status status = step(task, tile, progress);
        if (status == GM_OK && !are_within(tile->y, active, task->limit)) {
            status = GM_BLOW_UP;
        }
        if (status != GM_OK) {
            progress->done = done;
            progress->status = status;
        } else if (__builtin_expect(trace != NULL, false)) {
            memcpy(trace, tile->y, active * sizeof *tile->y);
            trace += active;
        }
    }
}

struct gm_progress gm_tiles_advance(const struct gm_task *task, const void *row, gm_tile_step *step)
{
    const struct tiles *tiles = task->workspace;
    const struct gm_loops *loops = gm_ode_of(task->problem)->loops[gm_isa_best()];
    const size_t n = task->problem->n, m = task->problem->m;
    struct gm_progress progress = {.done = task->steps, .status = GM_OK, .traced = task->trace != NULL};
    const bool whole = tiles->members == m;
    for (size_t first = 0; first < m; first += tiles->members) {
        const size_t count = m - first < tiles->members ? m - first : tiles->members;
        struct gm_tile tile = {.loops = loops,
                               .row = row,
                               .members = count,
                               .y = whole ? task->out : tiles->y,
                               .scratch = tiles->scratch,
                               .shared = tiles->shared};
        copy(task->y + first, m, tile.y, count, n, count);
        if (task->carry) {
            tile.carry = whole ? task->carry_out : tiles->carry;
            copy(task->carry + first, m, tile.carry, count, n, count);
        }
        advance(task, step, &tile, &progress);
        if (!whole) {
            copy(tile.y, count, task->out + first, m, n, count);
        }
        if (!whole && tile.carry) {
            copy(tile.carry, count, task->carry_out + first, m, n, count);
        }
    }
    return progress;
}
