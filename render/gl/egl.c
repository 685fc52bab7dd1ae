/* SPDX-License-Identifier: GPL-3.0-or-later */
/* EGL on Mesa's surfaceless platform, without a screen, a window or an X server. */
#include <string.h>

/* The window system's headers are left out. */
#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "render/gl/backend.h"

/* clang-format off */
#define FUNCTIONS(F) \
    F(eglBindAPI) F(eglChooseConfig) F(eglCreateContext) F(eglDestroyContext) F(eglGetProcAddress) \
    F(eglInitialize) F(eglMakeCurrent) F(eglQueryString) F(eglReleaseThread)
/* clang-format on */
static struct {
    EGLDisplay display;
    EGLContext context;
} egl;
static struct {
    FUNCTIONS(GM_LIBRARY_POINTER)
} functions;

static bool use(void)
{
    return functions.eglBindAPI(EGL_OPENGL_API) &&
           functions.eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl.context);
}

static void release(void)
{
    functions.eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    functions.eglReleaseThread();
}

/* The display is not terminated: EGL shares it between all contexts of the process. */
static void close_context(void)
{
    if (egl.context != EGL_NO_CONTEXT) {
        release();
        functions.eglDestroyContext(egl.display, egl.context);
        egl.context = EGL_NO_CONTEXT;
    }
}

static const char *open_context(void *library)
{
    if (!gm_library_find(library, FUNCTIONS(GM_LIBRARY_NAME), &functions)) {
        return "EGL is too old";
    }
    const char *extensions = functions.eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!extensions || !strstr(extensions, "EGL_MESA_platform_surfaceless")) {
        return "EGL has no surfaceless platform";
    }
    const PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)functions.eglGetProcAddress("eglGetPlatformDisplayEXT");
    if (!get_platform_display) {
        return "EGL has no eglGetPlatformDisplayEXT";
    }
    egl.display = get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (egl.display == EGL_NO_DISPLAY || !functions.eglInitialize(egl.display, NULL, NULL)) {
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
    if (!functions.eglBindAPI(EGL_OPENGL_API) ||
        !functions.eglChooseConfig(egl.display, wanted, &config, 1, &count) || count < 1) {
        return "EGL offers no configuration for OpenGL";
    }
    egl.context = functions.eglCreateContext(egl.display, config, EGL_NO_CONTEXT, attributes);
    return egl.context != EGL_NO_CONTEXT && use() ? NULL : "EGL gives no OpenGL 3.3 context";
}

static void *load(char *message, size_t size)
{
    static const char *const libraries[] = {"libEGL.so.1", NULL};
    return gm_library_open(libraries, message, size);
}

static gm_library_function find(const char *name)
{
    return (gm_library_function)functions.eglGetProcAddress(name);
}

const struct gm_backend gm_backend_egl = {load, open_context, close_context, use, release, find};
