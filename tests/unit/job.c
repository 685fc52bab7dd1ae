/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A background job: it sleeps until it is asked, an asking while it works is not lost, and what was asked for
   is done before it ends. */
#include <semaphore.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/explorer/background/background.h"
#include "render/message.h"

struct counted {
    sem_t begun, go_on; /* the work tells that it has begun, and waits */
    int done, ended;    /* times; it ends in the thread that worked */
    pthread_t worker;
};

static void count(void *self)
{
    struct counted *counted = self;
    counted->worker = pthread_self();
    sem_post(&counted->begun);
    sem_wait(&counted->go_on);
    counted->done++;
}

static void end(void *self)
{
    struct counted *counted = self;
    counted->ended += pthread_equal(counted->worker, pthread_self()) != 0;
}

static void open_job(struct gm_job *job, struct counted *counted, int wake)
{
    char message[GM_MESSAGE];
    *counted = (struct counted){0};
    sem_init(&counted->begun, 0, 0);
    sem_init(&counted->go_on, 0, 0);
    assert_true(gm_job_open(job, count, end, counted, wake, message));
}

static void asked_while_working(void **state)
{
    (void)state;
    struct gm_job job;
    struct counted counted;
    const int wake = eventfd(0, EFD_CLOEXEC);
    uint64_t told;
    open_job(&job, &counted, wake);
    assert_false(gm_job_is_busy(&job));
    gm_job_begin(&job);
    assert_true(gm_job_is_busy(&job));
    sem_wait(&counted.begun);
    gm_job_begin(&job); /* twice is once more: there is one thing to do */
    gm_job_begin(&job);
    sem_post(&counted.go_on);
    sem_wait(&counted.begun);
    assert_true(gm_job_is_busy(&job));
    assert_int_equal(read(wake, &told, sizeof told), sizeof told);
    assert_int_equal(told, 1);
    sem_post(&counted.go_on);
    assert_int_equal(read(wake, &told, sizeof told), sizeof told);
    assert_int_equal(counted.done, 2);
    assert_false(gm_job_is_busy(&job)); /* it tells only once it is free */
    gm_job_close(&job);
    assert_int_equal(counted.done, 2);
    assert_int_equal(counted.ended, 1);
    close(wake);
}

static void asked_before_its_end(void **state)
{
    (void)state;
    struct gm_job job;
    struct counted counted;
    open_job(&job, &counted, -1);
    sem_post(&counted.go_on);
    gm_job_begin(&job);
    gm_job_close(&job);
    assert_int_equal(counted.done, 1);
    assert_int_equal(counted.ended, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(asked_while_working),
        cmocka_unit_test(asked_before_its_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
