/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/arena.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* A block of memory follows its entry; `thing` is a kept thing with its own memory. */
struct gm_arena_entry {
    struct gm_arena_entry *before, *after;
    size_t number; /* number in the order of taking; a resized block has its old number */
    void *thing;
    void (*close)(void *thing); /* NULL: a block */
    _Alignas(max_align_t) unsigned char block[];
};

struct gm_arena {
    struct gm_arena_entry *top;
    size_t taken;
    jmp_buf *leave; /* NULL: no body runs */
    char reason[512];
};

static const char no_memory[] = "not enough memory";

struct gm_arena *gm_arena_open(void)
{
    return calloc(1, sizeof(struct gm_arena));
}

void gm_arena_release(struct gm_arena *arena, size_t mark)
{
    while (arena->top && arena->top->number > mark) {
        struct gm_arena_entry *entry = arena->top;
        arena->top = entry->before;
        if (arena->top) {
            arena->top->after = NULL;
        }
        if (entry->close) {
            entry->close(entry->thing);
        }
        free(entry);
    }
}

void gm_arena_drop(struct gm_arena *arena, const void *thing)
{
    struct gm_arena_entry *entry = arena->top;
    while (entry->thing != thing) {
        entry = entry->before;
    }
    if (entry->before) {
        entry->before->after = entry->after;
    }
    if (entry->after) {
        entry->after->before = entry->before;
    } else {
        arena->top = entry->before;
    }
    entry->close(entry->thing);
    free(entry);
}

size_t gm_arena_mark(const struct gm_arena *arena)
{
    return arena->taken;
}

void gm_arena_close(struct gm_arena *arena)
{
    if (arena) {
        gm_arena_release(arena, 0);
        free(arena);
    }
}

bool gm_arena_run(struct gm_arena *arena, void (*body)(struct gm_arena *arena, void *data), void *data)
{
    if (!arena) {
        return false;
    }
    const size_t mark = gm_arena_mark(arena);
    jmp_buf *const outer = arena->leave;
    jmp_buf here;
    bool whole = false;
    if (setjmp(here) == 0) {
        arena->leave = &here;
        body(arena, data);
        whole = true;
    }
    arena->leave = outer;
    if (!whole) {
        gm_arena_release(arena, mark);
    }
    return whole;
}

struct gm_arena *gm_arena_made(void (*body)(struct gm_arena *arena, void *data), void *data)
{
    struct gm_arena *arena = gm_arena_open();
    if (gm_arena_run(arena, body, data)) {
        return arena;
    }
    gm_arena_close(arena);
    return NULL;
}

bool gm_arena_run_once(void (*body)(struct gm_arena *arena, void *data), void *data)
{
    struct gm_arena *arena = gm_arena_made(body, data);
    const bool whole = arena;
    gm_arena_close(arena);
    return whole;
}

const char *gm_arena_reason(const struct gm_arena *arena)
{
    return arena ? arena->reason : no_memory;
}

void gm_arena_leave(struct gm_arena *arena)
{
    longjmp(*arena->leave, 1);
}

void gm_arena_refuse(struct gm_arena *arena, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(arena->reason, sizeof arena->reason, format, arguments);
    va_end(arguments);
    gm_arena_leave(arena);
}

void gm_arena_refuse_if(struct gm_arena *arena, bool wrong, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (wrong) {
        vsnprintf(arena->reason, sizeof arena->reason, format, arguments);
        va_end(arguments);
        gm_arena_leave(arena);
    }
    va_end(arguments);
}

void gm_arena_check(struct gm_arena *arena, bool done, const char *message)
{
    if (!done) {
        gm_arena_refuse(arena, "%s", message);
    }
}

static void *refused(struct gm_arena *arena)
{
    if (arena->leave) {
        gm_arena_refuse(arena, "%s", no_memory);
    }
    return NULL;
}

void gm_arena_need(struct gm_arena *arena, bool there)
{
    gm_arena_check(arena, there, no_memory);
}

static struct gm_arena_entry *add(struct gm_arena *arena, struct gm_arena_entry *entry)
{
    entry->before = arena->top;
    entry->number = ++arena->taken;
    if (arena->top) {
        arena->top->after = entry;
    }
    return arena->top = entry;
}

/* Bytes of an entry with a block; 0: more than there can be. */
static size_t bytes_of(size_t count, size_t size)
{
    const size_t head = sizeof(struct gm_arena_entry);
    return size > 0 && count > (SIZE_MAX - head) / size ? 0 : head + count * size;
}

void *gm_arena_take(struct gm_arena *arena, size_t count, size_t size)
{
    const size_t bytes = bytes_of(count, size);
    struct gm_arena_entry *entry = bytes > 0 ? calloc(1, bytes) : NULL;
    return entry ? add(arena, entry)->block : refused(arena);
}

void *gm_arena_take_unset(struct gm_arena *arena, size_t count, size_t size)
{
    void *block = gm_arena_take(arena, 0, size);
    return block ? gm_arena_resize(arena, block, count, size) : NULL;
}

void *gm_arena_resize(struct gm_arena *arena, void *block, size_t count, size_t size)
{
    if (!block) {
        return gm_arena_take(arena, count, size);
    }
    const size_t bytes = bytes_of(count, size);
    struct gm_arena_entry *entry = (void *)((unsigned char *)block - offsetof(struct gm_arena_entry, block));
    entry = bytes > 0 ? realloc(entry, bytes) : NULL;
    if (!entry) {
        return refused(arena);
    }
    if (entry->before) {
        entry->before->after = entry;
    }
    if (entry->after) {
        entry->after->before = entry;
    } else {
        arena->top = entry;
    }
    return entry->block;
}

void *gm_arena_grown(struct gm_arena *arena, void *array, size_t count, size_t size)
{
    const bool is_full = (count & (count - 1)) == 0;
    return is_full ? gm_arena_resize(arena, array, count > 0 ? 2 * count : 1, size) : array;
}

char *gm_arena_print(struct gm_arena *arena, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int letters = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    const size_t size = (size_t)letters + 1;
    char *text = letters >= 0 ? gm_arena_take(arena, size, 1) : refused(arena);
    if (text) {
        va_start(arguments, format);
        vsnprintf(text, size, format, arguments);
        va_end(arguments);
    }
    return text;
}

void *gm_arena_keep(struct gm_arena *arena, void *thing, void (*close)(void *thing))
{
    struct gm_arena_entry *entry = thing ? calloc(1, sizeof *entry) : NULL;
    if (!entry) {
        if (thing) {
            close(thing);
        }
        return refused(arena);
    }
    entry->thing = thing;
    entry->close = close;
    return add(arena, entry)->thing;
}
