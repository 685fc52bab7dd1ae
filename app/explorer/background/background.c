/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The thread behind studies, pictures of pixels, and frames of a movie; and a child process. */
#include "app/explorer/background/background.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "app/base/arguments.h"
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

/* ---- a child process of this program, and its output ---- */

extern char **environ;

static void end(struct gm_measure *measure)
{
    if (measure->fd >= 0) {
        close(measure->fd);
    }
    if (measure->child > 0) {
        kill(measure->child, SIGKILL);
        while (waitpid(measure->child, NULL, 0) < 0 && errno == EINTR) {
        }
    }
    measure->fd = -1;
    measure->child = 0;
}

/* Starts this program as a child that writes to our pipe and has no terminal. Returns false on failure. */
static bool start(struct gm_measure *measure, int out)
{
    posix_spawn_file_actions_t files;
    struct gm_arguments words = {0};
    gm_arguments_add(&words, "geomint");
    gm_arguments_split(&words, measure->words ? measure->words : "");
    if (words.failed || posix_spawn_file_actions_init(&files) != 0) {
        gm_arguments_close(&words);
        return false;
    }
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, out, STDERR_FILENO); /* the reason, if there is no answer */
    int error = posix_spawn(&measure->child, "/proc/self/exe", &files, NULL, words.words, environ);
    posix_spawn_file_actions_destroy(&files);
    gm_arguments_close(&words);
    if (error != 0) {
        measure->child = 0;
    }
    return error == 0;
}

void gm_measure_ask(struct gm_measure *measure, const char *words)
{
    if (measure->words && strcmp(measure->words, words) == 0) {
        return;
    }
    gm_measure_close(measure);
    measure->words = strdup(words);
    int ends[2];
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
        return;
    }
    fcntl(ends[1], F_SETFL, 0); /* the child may wait for us */
    measure->fd = ends[0];
    if (!start(measure, ends[1])) {
        end(measure);
    }
    close(ends[1]);
}

bool gm_measure_read(struct gm_measure *measure)
{
    char part[4096];
    for (;;) {
        ssize_t size = read(measure->fd, part, sizeof part);
        if (size < 0 && (errno == EAGAIN || errno == EINTR)) {
            return false;
        }
        if (size <= 0) {
            end(measure);
            return true;
        }
        char *more = realloc(measure->text, measure->length + (size_t)size + 1);
        if (!more) {
            end(measure);
            return true;
        }
        measure->text = more;
        memcpy(more + measure->length, part, (size_t)size);
        measure->length += (size_t)size;
        more[measure->length] = '\0';
    }
}

const char *gm_measure_text(const struct gm_measure *measure)
{
    if (measure->fd >= 0) {
        return NULL;
    }
    static const char prefix[] = "geomint: "; /* of a refusal */
    const char *text = measure->text ? measure->text : "could not be measured";
    return text + (strncmp(text, prefix, sizeof prefix - 1) == 0 ? sizeof prefix - 1 : 0);
}

void gm_measure_close(struct gm_measure *measure)
{
    end(measure);
    free(measure->text);
    free(measure->words);
    *measure = (struct gm_measure){.fd = -1};
}
