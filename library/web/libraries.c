/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The browser's loader: FreeType and MPFR are linked, fontconfig is the three fonts of the folder /fonts, and every
   other library is missing. Threads do their work when they are started, since a page without special headers has none. */
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>

#include "core/theory/ball.h"
#include "render/drawing/fonts.h"

/* ---- fontconfig: a pattern is a font ---- */

struct _FcPattern {
    bool is_mono, is_bold;
};

static struct _FcPattern pattern;
/* The bold letters of fixed width are those of screens of a terminal, which a page does not draw. */
static const char *const files[2][2] = {{"/fonts/DejaVuSans.ttf", "/fonts/DejaVuSans-Bold.ttf"},
                                        {"/fonts/DejaVuSansMono.ttf", "/fonts/DejaVuSansMono.ttf"}};

FcConfig *FcInitLoadConfigAndFonts(void)
{
    return (FcConfig *)&pattern;
}

void FcConfigDestroy(FcConfig *config)
{
    (void)config;
}

FcPattern *FcPatternCreate(void)
{
    return &pattern;
}

void FcPatternDestroy(FcPattern *wanted)
{
    (void)wanted;
}

FcBool FcPatternAddString(FcPattern *wanted, const char *object, const FcChar8 *family)
{
    (void)object;
    wanted->is_mono = strstr((const char *)family, "Mono") != NULL;
    return FcTrue;
}

FcBool FcPatternAddInteger(FcPattern *wanted, const char *object, int value)
{
    wanted->is_bold = strcmp(object, FC_WEIGHT) == 0 ? value == FC_WEIGHT_BOLD : wanted->is_bold;
    return FcTrue;
}

FcBool FcPatternAddBool(FcPattern *wanted, const char *object, FcBool value)
{
    (void)wanted, (void)object, (void)value;
    return FcTrue;
}

FcBool FcConfigSubstitute(FcConfig *config, FcPattern *wanted, FcMatchKind kind)
{
    (void)config, (void)wanted, (void)kind;
    return FcTrue;
}

void FcDefaultSubstitute(FcPattern *wanted)
{
    (void)wanted;
}

FcPattern *FcFontMatch(FcConfig *config, FcPattern *wanted, FcResult *result)
{
    (void)config;
    *result = FcResultMatch;
    return wanted;
}

FcResult FcPatternGetString(const FcPattern *found, const char *object, int n, FcChar8 **name)
{
    (void)object, (void)n;
    *name = (FcChar8 *)files[found->is_mono][found->is_bold];
    return FcResultMatch;
}

/* ---- the loader ---- */

/* The linker's names for the C library's calls (--wrap). */
void *__wrap_dlopen(const char *name, int mode);
int __wrap_dlclose(void *library);
char *__wrap_dlerror(void);
void *__wrap_dlsym(void *library, const char *name);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *kind, void *(*work)(void *), void *self);
int __wrap_pthread_join(pthread_t thread, void **result);

void *__wrap_dlopen(const char *name, int mode)
{
    (void)mode;
    static char linked;
    return strcmp(name, "libfontconfig.so.1") == 0 || strcmp(name, "libmpfr.so.6") == 0 ? &linked : NULL;
}

int __wrap_dlclose(void *library)
{
    (void)library;
    return 0;
}

char *__wrap_dlerror(void)
{
    static char reason[] = "a browser does not have it";
    return reason;
}

#define ROW(name) {#name, (gm_library_function)name},

void *__wrap_dlsym(void *library, const char *name)
{
    (void)library;
    static const struct {
        const char *name;
        gm_library_function function;
    } linked[] = {GM_FONT_FUNCTIONS(ROW) GM_MPFR_FUNCTIONS(ROW)};
    for (size_t i = 0; i < sizeof linked / sizeof *linked; i++) {
        if (strcmp(linked[i].name, name) == 0) {
            return (void *)linked[i].function;
        }
    }
    return NULL;
}

/* ---- threads ---- */

/* The number of cores is unknown, so one thread is used. */
int sched_getaffinity(pid_t process, size_t size, cpu_set_t *cores)
{
    (void)process, (void)size, (void)cores;
    return -1;
}

int __sched_cpucount(size_t size, const cpu_set_t *cores)
{
    (void)size, (void)cores;
    return 1;
}

int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *kind, void *(*work)(void *), void *self)
{
    (void)kind;
    *thread = pthread_self();
    work(self);
    return 0;
}

int __wrap_pthread_join(pthread_t thread, void **result)
{
    (void)thread, (void)result;
    return 0;
}

/* ---- files in memory, for processes that a browser does not start ---- */

int memfd_create(const char *name, unsigned flags)
{
    (void)name, (void)flags;
    errno = ENOSYS;
    return -1;
}
