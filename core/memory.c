/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The allocators of the whole program, wrapped: a refusal is noted, and handed on. */
#include "core/memory.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

static _Thread_local unsigned long refusals;
static atomic_bool was_short;

void gm_memory_refused(void)
{
    refusals++;
    atomic_store(&was_short, true);
}

static void note_error(const char *reason, const char *file, int line, int error)
{
    (void)reason;
    (void)file;
    (void)line;
    if (error == GSL_ENOMEM) {
        gm_memory_refused();
    }
}

void gm_memory_heed_gsl(void)
{
    gsl_set_error_handler(note_error);
}

unsigned long gm_memory_refusals(void)
{
    return refusals;
}

bool gm_memory_was_short(void)
{
    return atomic_load(&was_short);
}

static void *noted(void *memory)
{
    if (!memory) {
        gm_memory_refused();
    }
    return memory;
}

/* What the linker takes for malloc ... (--wrap), and what it then calls __real_malloc ...: the names are its
   own. Nothing else calls them, and no header declares them. */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
char *__real_strdup(const char *text);
char *__real_strndup(const char *text, size_t length);
int __real_vasprintf(char **text, const char *format, va_list arguments);
FILE *__real_open_memstream(char **text, size_t *size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
char *__wrap_strdup(const char *text);
char *__wrap_strndup(const char *text, size_t length);
FILE *__wrap_open_memstream(char **text, size_t *size);
int __wrap_vasprintf(char **text, const char *format, va_list arguments);
int __wrap_asprintf(char **text, const char *format, ...);

/* none of nothing is no shortage, whatever the C library makes of it */
void *__wrap_malloc(size_t size)
{
    return noted(__real_malloc(size > 0 ? size : 1));
}

void *__wrap_calloc(size_t count, size_t size)
{
    return count > 0 && size > 0 ? noted(__real_calloc(count, size)) : noted(__real_calloc(1, 1));
}

void *__wrap_realloc(void *memory, size_t size)
{
    return noted(__real_realloc(memory, size > 0 ? size : 1));
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return noted(__real_aligned_alloc(alignment, size));
}

char *__wrap_strdup(const char *text)
{
    return noted(__real_strdup(text));
}

char *__wrap_strndup(const char *text, size_t length)
{
    return noted(__real_strndup(text, length));
}

FILE *__wrap_open_memstream(char **text, size_t *size)
{
    return noted(__real_open_memstream(text, size));
}

int __wrap_vasprintf(char **text, const char *format, va_list arguments)
{
    const int length = __real_vasprintf(text, format, arguments);
    if (length < 0) {
        gm_memory_refused();
    }
    return length;
}

int __wrap_asprintf(char **text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = __wrap_vasprintf(text, format, arguments);
    va_end(arguments);
    return length;
}
