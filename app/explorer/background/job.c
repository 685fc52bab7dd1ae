/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The thread behind studies, pictures of pixels, and frames of a movie. */
#include "app/explorer/background/background.h"

#include <string.h>
#include <sys/eventfd.h>
#include <time.h>

#include "render/files/thread.h"
#include "render/message.h"

static void *go_on(void *self)
{
    struct gm_job *job = self;
    pthread_mutex_lock(&job->lock);
    while (job->asked || !job->leave) {
        if (!job->asked) {
            pthread_cond_wait(&job->news, &job->lock);
            continue;
        }
        job->asked = false;
        job->working = true;
        pthread_mutex_unlock(&job->lock);
        job->work(job->self);
        pthread_mutex_lock(&job->lock);
        job->working = false;
        if (job->wake >= 0) {
            eventfd_write(job->wake, 1); /* if the count is full, the waiting thread is awake */
        }
    }
    pthread_mutex_unlock(&job->lock);
    if (job->end) {
        job->end(job->self);
    }
    return NULL;
}

bool gm_job_open(struct gm_job *job, void (*work)(void *self), void (*end)(void *self), void *self, int wake,
                 char *message)
{
    *job = (struct gm_job){.work = work, .end = end, .self = self, .wake = wake};
    pthread_mutex_init(&job->lock, NULL);
    pthread_cond_init(&job->news, NULL);
    const int error = gm_thread_start(&job->thread, go_on, job);
    if (error != 0) {
        gm_refuse(message, "No thread could be started: %s.", strerror(error));
        pthread_mutex_destroy(&job->lock);
        pthread_cond_destroy(&job->news);
    }
    return error == 0;
}

void gm_job_close(struct gm_job *job)
{
    pthread_mutex_lock(&job->lock);
    job->leave = true;
    pthread_cond_signal(&job->news);
    pthread_mutex_unlock(&job->lock);
    pthread_join(job->thread, NULL);
    pthread_mutex_destroy(&job->lock);
    pthread_cond_destroy(&job->news);
}

void gm_job_begin(struct gm_job *job)
{
    gm_job_tell(job, &job->asked);
}

void gm_job_tell(struct gm_job *job, bool *flag)
{
    pthread_mutex_lock(&job->lock);
    *flag = job->asked = true;
    pthread_cond_signal(&job->news);
    pthread_mutex_unlock(&job->lock);
}

bool gm_job_is_busy(struct gm_job *job)
{
    pthread_mutex_lock(&job->lock);
    const bool busy = job->asked || job->working;
    pthread_mutex_unlock(&job->lock);
    return busy;
}

void gm_job_wait(struct gm_job *job)
{
    while (gm_job_is_busy(job)) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
}
