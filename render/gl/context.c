/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An OpenGL context without a screen, from OSMesa or EGL. Their libraries are loaded when the first context
   is opened. */
#include "render/gl/context.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "render/address_space.h"
#include "render/message.h"

static const struct gm_backend *const backends[GM_CONTEXT_KINDS] = {
#ifdef GM_HAVE_OSMESA
    [GM_CONTEXT_OSMESA] = &gm_backend_osmesa,
#endif
#ifdef GM_HAVE_EGL
    [GM_CONTEXT_EGL] = &gm_backend_egl,
#endif
};

static void *load(enum gm_context_kind kind, char *message, size_t size)
{
    snprintf(message, size, "this geomint was built without it");
    void *library = backends[kind] ? backends[kind]->load(message, size) : NULL;
    if (!library && gm_address_space_is_limited() && !gm_address_space_has(GM_CONTEXT_TAKES)) {
        snprintf(message, size, "there is not enough memory for it");
    }
    return library;
}

bool gm_context_load(enum gm_context_kind kind, char *message, size_t size)
{
    return load(kind, message, size) != NULL;
}

const struct gm_backend *gm_context_open(enum gm_context_kind kind, char *message, size_t size)
{
    void *library = load(kind, message, size);
    const char *reason = library ? backends[kind]->open(library) : NULL;
    if (reason) {
        snprintf(message, size, "%s", reason);
        backends[kind]->close();
    }
    return library && !reason ? backends[kind] : NULL;
}

static const int crashes[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
enum { CRASHES = sizeof crashes / sizeof crashes[0] };
/* written in advance: the handler of a crash must not format */
static char sentence[GM_MESSAGE];
static int exit_status;

static void end(int number)
{
    (void)number;
    const ssize_t written = write(STDERR_FILENO, sentence, strlen(sentence));
    (void)written;
    _exit(exit_status);
}

static void make_sentence(void)
{
    struct rlimit space;
    const bool limited = getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY;
    const int length =
        snprintf(sentence, sizeof sentence, "geomint: Mesa, which paints the pictures, crashed");
    const size_t used = (size_t)length;
    exit_status = limited ? 5 : 3; /* 5: not enough memory; 3: no file was written */
    if (limited) {
        snprintf(sentence + used, sizeof sentence - used, "; its address space is limited to %.0f MB.\n",
                 (double)space.rlim_cur / 1e6);
    } else {
        snprintf(sentence + used, sizeof sentence - used, ".\n");
    }
}

static bool answers; /* false inside another program */

void gm_context_answer_crashes(void)
{
    answers = true;
}

void gm_context_guard(void)
{
    if (!answers) {
        return;
    }
    make_sentence();
    for (size_t i = 0; i < CRASHES; i++) {
        struct sigaction ours = {.sa_handler = end, .sa_flags = (int)SA_RESETHAND}, before;
        sigemptyset(&ours.sa_mask);
        if (sigaction(crashes[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL) {
            sigaction(crashes[i], &ours, NULL);
        }
    }
}

void gm_context_unguard(void)
{
    for (size_t i = 0; answers && i < CRASHES; i++) {
        struct sigaction now;
        if (sigaction(crashes[i], NULL, &now) == 0 && now.sa_handler == end) {
            signal(crashes[i], SIG_DFL);
        }
    }
}
