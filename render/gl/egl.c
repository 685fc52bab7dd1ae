/* SPDX-License-Identifier: GPL-3.0-or-later */
/* EGL on Mesa's surfaceless platform, without a screen, a window or an X server. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The window system's headers are left out. */
#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "render/gl/backend.h"

struct egl {
    EGLDisplay display;
    EGLContext context;
    PFNEGLGETPROCADDRESSPROC get_proc_address;
    PFNEGLQUERYSTRINGPROC query_string;
    PFNEGLINITIALIZEPROC initialize;
    PFNEGLTERMINATEPROC terminate;
    PFNEGLBINDAPIPROC bind_api;
    PFNEGLCHOOSECONFIGPROC choose_config;
    PFNEGLCREATECONTEXTPROC create_context;
    PFNEGLDESTROYCONTEXTPROC destroy_context;
    PFNEGLMAKECURRENTPROC make_current;
    PFNEGLRELEASETHREADPROC release_thread;
};

static bool find_functions(struct egl *egl, void *library)
{
    const struct gm_library_symbol symbols[] = {
        {"eglGetProcAddress", &egl->get_proc_address},
        {"eglQueryString", &egl->query_string},
        {"eglInitialize", &egl->initialize},
        {"eglTerminate", &egl->terminate},
        {"eglBindAPI", &egl->bind_api},
        {"eglChooseConfig", &egl->choose_config},
        {"eglCreateContext", &egl->create_context},
        {"eglDestroyContext", &egl->destroy_context},
        {"eglMakeCurrent", &egl->make_current},
        {"eglReleaseThread", &egl->release_thread},
    };
    return gm_library_find(library, symbols, sizeof symbols / sizeof *symbols);
}

static bool egl_use(void *self)
{
    struct egl *egl = self;
    return egl->bind_api(EGL_OPENGL_API) &&
           egl->make_current(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl->context);
}

static void egl_release(void *self)
{
    struct egl *egl = self;
    egl->make_current(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl->release_thread();
}

static void egl_close(void *self)
{
    struct egl *egl = self;
    if (egl->context != EGL_NO_CONTEXT) {
        egl_release(self);
        egl->destroy_context(egl->display, egl->context);
    }
    /* The display is not terminated: EGL shares it between all contexts of the process. */
    free(egl);
}

/* Returns NULL, or the fault as a predicate of "EGL". */
static const char *context_create(struct egl *egl)
{
    const char *extensions = egl->query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!extensions || !strstr(extensions, "EGL_MESA_platform_surfaceless")) {
        return "has no surfaceless platform";
    }
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)egl->get_proc_address("eglGetPlatformDisplayEXT");
    if (!get_platform_display) {
        return "has no eglGetPlatformDisplayEXT";
    }
    egl->display = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (egl->display == EGL_NO_DISPLAY || !egl->initialize(egl->display, NULL, NULL)) {
        return "gives no surfaceless display";
    }
    static const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    static const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                        3,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
    EGLConfig config = NULL;
    EGLint count = 0;
    if (!egl->bind_api(EGL_OPENGL_API) || !egl->choose_config(egl->display, wanted, &config, 1, &count) ||
        count < 1) {
        return "offers no configuration for OpenGL";
    }
    egl->context = egl->create_context(egl->display, config, EGL_NO_CONTEXT, attributes);
    if (egl->context == EGL_NO_CONTEXT || !egl_use(egl)) {
        return "gives no OpenGL 3.3 context";
    }
    return NULL;
}

static void *egl_load(char *message, size_t size)
{
    static const char *const libraries[] = {"libEGL.so.1", NULL};
    return gm_library_open(libraries, message, size);
}

static void *egl_open(void *library, char *message, size_t size)
{
    struct egl *egl = calloc(1, sizeof *egl);
    if (!egl) {
        snprintf(message, size, "there is not enough memory for EGL");
        return NULL;
    }
    const char *reason = find_functions(egl, library) ? context_create(egl) : "is too old";
    if (reason) {
        snprintf(message, size, "EGL %s", reason);
        egl_close(egl);
        return NULL;
    }
    return egl;
}

static gm_library_function egl_find(void *self, const char *name)
{
    struct egl *egl = self;
    return (gm_library_function)egl->get_proc_address(name);
}

const struct gm_backend gm_backend_egl = {
    .load = egl_load,
    .open = egl_open,
    .close = egl_close,
    .use = egl_use,
    .release = egl_release,
    .find = egl_find,
};
