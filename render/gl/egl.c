/* SPDX-License-Identifier: GPL-3.0-or-later */
/* EGL on Mesa's surfaceless platform, without a screen, a window or an X server. */
#include <string.h>

/* The window system's headers are left out. */
#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "render/gl/backend.h"

static struct {
    EGLDisplay display;
    EGLContext context;
    PFNEGLGETPROCADDRESSPROC get_proc_address;
    PFNEGLQUERYSTRINGPROC query_string;
    PFNEGLINITIALIZEPROC initialize;
    PFNEGLBINDAPIPROC bind_api;
    PFNEGLCHOOSECONFIGPROC choose_config;
    PFNEGLCREATECONTEXTPROC create_context;
    PFNEGLDESTROYCONTEXTPROC destroy_context;
    PFNEGLMAKECURRENTPROC make_current;
    PFNEGLRELEASETHREADPROC release_thread;
} egl;

static const struct gm_library_symbol symbols[] = {
    {"eglGetProcAddress", &egl.get_proc_address}, {"eglQueryString", &egl.query_string},
    {"eglInitialize", &egl.initialize},           {"eglBindAPI", &egl.bind_api},
    {"eglChooseConfig", &egl.choose_config},      {"eglCreateContext", &egl.create_context},
    {"eglDestroyContext", &egl.destroy_context},  {"eglMakeCurrent", &egl.make_current},
    {"eglReleaseThread", &egl.release_thread},
};

static bool use(void)
{
    return egl.bind_api(EGL_OPENGL_API) &&
           egl.make_current(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl.context);
}

static void release(void)
{
    egl.make_current(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl.release_thread();
}

/* The display is not terminated: EGL shares it between all contexts of the process. */
static void close_context(void)
{
    if (egl.context != EGL_NO_CONTEXT) {
        release();
        egl.destroy_context(egl.display, egl.context);
        egl.context = EGL_NO_CONTEXT;
    }
}

static const char *open_context(void *library)
{
    if (!gm_library_find(library, symbols, sizeof symbols / sizeof *symbols)) {
        return "EGL is too old";
    }
    const char *extensions = egl.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!extensions || !strstr(extensions, "EGL_MESA_platform_surfaceless")) {
        return "EGL has no surfaceless platform";
    }
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)egl.get_proc_address("eglGetPlatformDisplayEXT");
    if (!get_platform_display) {
        return "EGL has no eglGetPlatformDisplayEXT";
    }
    egl.display = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (egl.display == EGL_NO_DISPLAY || !egl.initialize(egl.display, NULL, NULL)) {
        return "EGL gives no surfaceless display";
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
    if (!egl.bind_api(EGL_OPENGL_API) || !egl.choose_config(egl.display, wanted, &config, 1, &count) ||
        count < 1) {
        return "EGL offers no configuration for OpenGL";
    }
    egl.context = egl.create_context(egl.display, config, EGL_NO_CONTEXT, attributes);
    return egl.context != EGL_NO_CONTEXT && use() ? NULL : "EGL gives no OpenGL 3.3 context";
}

static void *load(char *message, size_t size)
{
    static const char *const libraries[] = {"libEGL.so.1", NULL};
    return gm_library_open(libraries, message, size);
}

static gm_library_function find(const char *name)
{
    return (gm_library_function)egl.get_proc_address(name);
}

const struct gm_backend gm_backend_egl = {load, open_context, close_context, use, release, find};
