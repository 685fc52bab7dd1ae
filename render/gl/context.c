/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An OpenGL context without a screen, by OSMesa or EGL, whose libraries are loaded only when one is
   wanted. */
#include "render/gl/context.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "render/gl/backend.h"
#include "render/message.h"

static const struct gm_backend *const backends[] = {
#ifdef GM_HAVE_OSMESA
    &gm_backend_osmesa,
#endif
#ifdef GM_HAVE_EGL
    &gm_backend_egl,
#endif
    NULL,
};

struct gm_context {
    const struct gm_backend *backend;
    void *self;
};

static struct gm_context *open_with(const struct gm_backend *backend, char *message, size_t size)
{
    struct gm_context *context = malloc(sizeof *context);
    if (!context) {
        snprintf(message, size, "There is not enough memory for an OpenGL context.");
        return NULL;
    }
    *context = (struct gm_context){.backend = backend, .self = backend->open(message, size)};
    if (!context->self) {
        free(context);
        return NULL;
    }
    return context;
}

static void unknown_backend(const char *wanted, char *message, size_t size)
{
    char known[64] = "";
    for (size_t i = 0; backends[i]; i++) {
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i > 0 ? " and " : "",
                 backends[i]->key);
    }
    snprintf(message, size, "GEOMINT_GL is \"%.40s\", but this geomint knows only %s.", wanted,
             known[0] != '\0' ? known : "none");
}

/* Whether the environment variable GEOMINT_GL lets this one be tried. */
static bool is_wanted(const struct gm_backend *backend)
{
    const char *wanted = getenv("GEOMINT_GL");
    return !wanted || wanted[0] == '\0' || strcmp(wanted, backend->key) == 0;
}

struct gm_context *gm_context_open(char *message, size_t size)
{
    const char *wanted = getenv("GEOMINT_GL");
    char reasons[2][192] = {"", ""};
    size_t tried = 0;
    for (size_t i = 0; backends[i]; i++) {
        if (!is_wanted(backends[i])) {
            continue;
        }
        struct gm_context *context = open_with(backends[i], reasons[tried], sizeof reasons[tried]);
        if (context) {
            return context;
        }
        tried++;
    }
    if (tried == 0 && wanted && wanted[0] != '\0') {
        unknown_backend(wanted, message, size);
    } else if (tried == 0) {
        snprintf(message, size,
                 "This geomint was built without OSMesa and EGL, so it cannot paint pictures.");
    } else {
        snprintf(message, size, "No OpenGL context could be opened: %s%s%s.", reasons[0],
                 tried > 1 ? "; " : "", reasons[1]);
    }
    return NULL;
}

void gm_context_close(struct gm_context *context)
{
    if (!context) {
        return;
    }
    context->backend->close(context->self);
    free(context);
}

bool gm_context_use(const struct gm_context *context)
{
    return context->backend->use(context->self);
}

gm_library_function gm_context_find(const struct gm_context *context, const char *name)
{
    return context->backend->find(context->self, name);
}

const char *gm_context_name(const struct gm_context *context)
{
    return context->backend->name;
}

static const int crashes[] = {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
enum { CRASHES = sizeof crashes / sizeof crashes[0] };
/* made before they are needed: a crash is no time to format */
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
    const char *driver = getenv("GALLIUM_DRIVER");
    struct rlimit space;
    const bool limited = getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY;
    const int length =
        snprintf(sentence, sizeof sentence, "geomint: Mesa, which paints the pictures, crashed");
    const size_t used = (size_t)length;
    exit_status = !driver && limited ? 5 : 3; /* not enough memory; no file was written */
    if (driver) {
        snprintf(sentence + used, sizeof sentence - used,
                 "; the environment variable GALLIUM_DRIVER asks for its driver \"%.60s\".\n", driver);
    } else if (limited) {
        snprintf(sentence + used, sizeof sentence - used, "; its address space is limited to %.0f MB.\n",
                 (double)space.rlim_cur / 1e6);
    } else {
        snprintf(sentence + used, sizeof sentence - used, ".\n");
    }
}

static bool answers; /* not in somebody else's program */

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
