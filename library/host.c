/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library restores what belongs to the host: the locale and the OpenGL context of a thread. */
#include "library/host.h"

#include <pthread.h>

static locale_t inside; /* 0: there is no memory for it, and the host's stays */

/* When the library is loaded. It is never freed: a thread may be in it while the host ends. */
__attribute__((constructor)) static void make_locale(void)
{
    inside = newlocale(LC_ALL_MASK, "C.UTF-8", (locale_t)0);
    if (!inside) {
        inside = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    }
}

locale_t gm_host_leave_outside(void)
{
    return uselocale(inside);
}

void gm_host_return(locale_t outside)
{
    uselocale(outside);
}

struct errand {
    void (*work)(void *data);
    void *data;
};

static void *run_errand(void *data)
{
    const struct errand *errand = data;
    gm_host_leave_outside();
    errand->work(errand->data);
    return NULL;
}

bool gm_host_spare(void (*work)(void *data), void *data)
{
    pthread_t thread;
    struct errand errand = {work, data};
    return pthread_create(&thread, NULL, run_errand, &errand) == 0 && pthread_join(thread, NULL) == 0;
}
