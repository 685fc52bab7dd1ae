/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The allocators of the whole program, wrapped: a refusal is noted and returned. */
#include "core/memory.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

static _Thread_local unsigned long refusals;
static _Thread_local jmp_buf *way_out; /* jump target of GSL's errors */
static atomic_bool was_short;

void gm_memory_refused(void)
{
    refusals++;
    atomic_store(&was_short, true);
}

/* GSL has one handler for all threads, and it may be somebody else's: it is exchanged while at least one
   thread is in here, and hears meanwhile what happens in other threads. */
static struct {
    pthread_mutex_t lock;
    unsigned inside;
    gsl_error_handler_t *others; /* NULL: GSL's own, which prints the error and aborts */
} handling = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void note_error(const char *reason, const char *file, int line, int error)
{
    if (!way_out) {
        pthread_mutex_lock(&handling.lock);
        gsl_error_handler_t *const others = handling.others;
        pthread_mutex_unlock(&handling.lock);
        if (others) {
            others(reason, file, line, error);
        } else {
            gsl_stream_printf("ERROR", file, line, reason);
            abort();
        }
    } else if (error == GSL_ENOMEM) {
        gm_memory_refused();
        longjmp(*way_out, 1);
    }
}

static void exchange_handler(bool enter)
{
    pthread_mutex_lock(&handling.lock);
    if (enter && handling.inside++ == 0) {
        handling.others = gsl_set_error_handler(note_error);
    } else if (!enter && --handling.inside == 0) {
        gsl_set_error_handler(handling.others);
    }
    pthread_mutex_unlock(&handling.lock);
}

bool gm_memory_guard_gsl(bool (*work)(void *data), void *data)
{
    jmp_buf here, *const outer = way_out;
    exchange_handler(true);
    way_out = &here;
    bool done = false;
    if (setjmp(here) == 0) {
        done = work(data);
    }
    way_out = outer;
    exchange_handler(false);
    return done;
}

unsigned long gm_memory_refusals(void)
{
    return refusals;
}

bool gm_memory_was_short(void)
{
    return atomic_load(&was_short);
}

void gm_memory_forget(void)
{
    atomic_store(&was_short, false);
}

static void *noted(void *memory)
{
    if (!memory) {
        gm_memory_refused();
    }
    return memory;
}

/* The linker's names for malloc ... (--wrap), and for the originals, __real_malloc ... Nothing else calls
   them, and no header declares them. */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
char *__real_strdup(const char *text);
char *__real_strndup(const char *text, size_t length);
int __real_fclose(FILE *stream);
int __real_vasprintf(char **text, const char *format, va_list arguments);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
char *__wrap_strdup(const char *text);
char *__wrap_strndup(const char *text, size_t length);
FILE *__wrap_open_memstream(char **text, size_t *size);
int __wrap_fclose(FILE *stream);
int __wrap_vasprintf(char **text, const char *format, va_list arguments);
int __wrap_asprintf(char **text, const char *format, ...);

/* NULL for 0 bytes would not be a refusal, whichever way the C library decides */
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

/* A stream into memory; the C library's own one ignores a refusal and continues with part of the text. */
struct growing {
    char **text, *bytes;
    size_t *size, used, capacity;
    bool lost;
};

static ssize_t grow(void *cookie, const char *bytes, size_t size)
{
    struct growing *growing = cookie;
    if (growing->used + size >= growing->capacity) { /* a byte is left for the end */
        const size_t capacity = 2 * (growing->used + size + 1);
        char *grown = growing->lost ? NULL : __wrap_realloc(growing->bytes, capacity);
        if (!grown) {
            growing->lost = true;
            return 0;
        }
        growing->bytes = grown;
        growing->capacity = capacity;
    }
    memcpy(growing->bytes + growing->used, bytes, size);
    growing->used += size;
    return (ssize_t)size;
}

static int hand_over(void *cookie)
{
    struct growing *growing = cookie;
    grow(growing, "", 0); /* even an empty text has an end */
    const bool whole = !growing->lost;
    if (whole) {
        growing->bytes[growing->used] = '\0';
        *growing->text = growing->bytes;
        *growing->size = growing->used;
    } else {
        free(growing->bytes);
    }
    free(growing);
    return whole ? 0 : EOF;
}

FILE *__wrap_open_memstream(char **text, size_t *size)
{
    struct growing *growing = __wrap_calloc(1, sizeof *growing);
    FILE *stream =
        growing ? noted(fopencookie(growing, "w", (cookie_io_functions_t){.write = grow, .close = hand_over}))
                : NULL;
    *text = NULL;
    *size = 0;
    if (!stream) {
        free(growing);
        return NULL;
    }
    *growing = (struct growing){.text = text, .size = size};
    return stream;
}

/* Text lost by a stream into memory is a lack of memory; text lost by a file is a fault of the file. */
int __wrap_fclose(FILE *stream)
{
    const bool in_memory = fileno(stream) < 0;
    const int result = __real_fclose(stream);
    if (result != 0 && in_memory) {
        gm_memory_refused();
    }
    return result;
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
