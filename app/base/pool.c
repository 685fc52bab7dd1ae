/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pool of threads for pieces of work in their order: a free thread begins the next one. */
#include "app/base/pool.h"

#include <pthread.h>
#include <sched.h>
#include <stdlib.h>

#include "render/files/thread.h"

struct crew {
    const struct gm_pool *pool;
    pthread_mutex_t lock;
    pthread_cond_t ready, room; /* the next piece can be taken; a further one may begin */
    size_t next, taken, working;
    bool leave;
    bool *done; /* one per slot */
};

size_t gm_pool_cores(void)
{
    cpu_set_t cores;
    const int count = sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
    return count > 1 ? (size_t)count : 1;
}

static bool is_stopped(const struct gm_pool *pool)
{
    return pool->stopped && pool->stopped(pool->self);
}

/* Begins a piece and returns its number, or `count` after the last one. The caller holds the lock. */
static size_t begin(struct crew *crew)
{
    const struct gm_pool *pool = crew->pool;
    while (!crew->leave && crew->next < pool->count && crew->next - crew->taken >= pool->window) {
        pthread_cond_wait(&crew->room, &crew->lock);
    }
    if (is_stopped(pool)) {
        crew->leave = true;
        pthread_cond_broadcast(&crew->room);
    }
    if (crew->leave || crew->next == pool->count) {
        return pool->count;
    }
    if (crew->next + 1 == pool->count) { /* waiting threads find no further piece */
        pthread_cond_broadcast(&crew->room);
    }
    return crew->next++;
}

static void *work(void *self)
{
    struct crew *crew = self;
    const struct gm_pool *pool = crew->pool;
    pthread_mutex_lock(&crew->lock);
    for (size_t index; (index = begin(crew)) < pool->count;) {
        pthread_mutex_unlock(&crew->lock);
        pool->work(pool->self, index, index % pool->window);
        pthread_mutex_lock(&crew->lock);
        crew->done[index % pool->window] = true;
        if (index == crew->taken) {
            pthread_cond_signal(&crew->ready);
        }
    }
    crew->working--;
    pthread_cond_signal(&crew->ready);
    pthread_mutex_unlock(&crew->lock);
    return NULL;
}

/* Takes in order, as long as there are pieces to wait for. */
static void take_all(struct crew *crew)
{
    const struct gm_pool *pool = crew->pool;
    pthread_mutex_lock(&crew->lock);
    while (crew->taken < pool->count) {
        const size_t slot = crew->taken % pool->window;
        if (!crew->done[slot]) {
            if (crew->working == 0) {
                break;
            }
            pthread_cond_wait(&crew->ready, &crew->lock);
            continue;
        }
        pthread_mutex_unlock(&crew->lock);
        const bool more = pool->take(pool->self, crew->taken, slot);
        pthread_mutex_lock(&crew->lock);
        if (!more) {
            crew->leave = true;
            pthread_cond_broadcast(&crew->room);
            break;
        }
        crew->done[slot] = false;
        crew->taken++;
        pthread_cond_signal(&crew->room);
    }
    pthread_mutex_unlock(&crew->lock);
}

/* One piece after the other, in this thread. */
static size_t run_alone(const struct gm_pool *pool)
{
    size_t index = 0;
    while (index < pool->count && !is_stopped(pool)) {
        pool->work(pool->self, index, 0);
        if (!pool->take(pool->self, index, 0)) {
            break;
        }
        index++;
    }
    return index;
}

size_t gm_pool_run(const struct gm_pool *pool)
{
    struct crew crew = {.pool = pool};
    const size_t wanted = pool->jobs > 0 ? pool->jobs : gm_pool_cores();
    const size_t useful = pool->count < pool->window ? pool->count : pool->window;
    const size_t most = wanted < useful ? wanted : useful;
    pthread_t *threads = most > 1 ? calloc(most, sizeof *threads) : NULL;
    crew.done = threads ? calloc(pool->window, sizeof *crew.done) : NULL;
    size_t started = 0;
    if (crew.done) {
        pthread_mutex_init(&crew.lock, NULL);
        pthread_cond_init(&crew.ready, NULL);
        pthread_cond_init(&crew.room, NULL);
        pthread_mutex_lock(&crew.lock);
        while (started < most && gm_thread_start(&threads[started], work, &crew) == 0) {
            started++;
        }
        crew.working = started;
        pthread_mutex_unlock(&crew.lock);
        take_all(&crew);
        for (size_t i = 0; i < started; i++) {
            pthread_join(threads[i], NULL);
        }
        pthread_mutex_destroy(&crew.lock);
        pthread_cond_destroy(&crew.ready);
        pthread_cond_destroy(&crew.room);
    }
    free(crew.done);
    free(threads);
    return started > 0 ? crew.taken : run_alone(pool); /* without a thread the caller does the work */
}
