/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory that is returned together, and one way out of straight code that needs much of it.

   A body that gm_arena_run calls asks nothing: memory that the system refuses, and a refusal of its own,
   leave it by a jump, after which everything that the body took is closed in reverse order. So a body holds
   no lock, opens no stream that it does not keep, and starts no thread. An arena belongs to one thing that is
   opened: a mesh, a system, a picture. Loops that step take nothing from one. */
#ifndef GM_CORE_ARENA_H
#define GM_CORE_ARENA_H

#include <stdbool.h>
#include <stddef.h>

struct gm_arena;

/* NULL: out of memory. */
struct gm_arena *gm_arena_open(void);
/* Closes what was kept and returns all memory, the last first. The arena may be NULL. */
void gm_arena_close(struct gm_arena *arena);

/* Calls the body. Returns false if it was left: all that it took or kept is closed, and gm_arena_reason
   has the reason. A NULL arena means out of memory. */
bool gm_arena_run(struct gm_arena *arena, void (*body)(struct gm_arena *arena, void *data), void *data);
/* Returns a new arena in which the body was called; NULL if it was left. */
struct gm_arena *gm_arena_made(void (*body)(struct gm_arena *arena, void *data), void *data);
/* The same in an arena that is closed afterwards. */
bool gm_arena_run_once(void (*body)(struct gm_arena *arena, void *data), void *data);
/* The sentence with which the last body was left: "not enough memory", or from gm_arena_refuse. */
const char *gm_arena_reason(const struct gm_arena *arena);

/* Returns zeros. Inside a body it never returns NULL, outside of one NULL when out of memory. */
void *gm_arena_take(struct gm_arena *arena, size_t count, size_t size);
/* The same without zeros: the pages of a large array are not touched before they are needed. */
void *gm_arena_take_unset(struct gm_arena *arena, size_t count, size_t size);
/* A block that was taken (or NULL), with another size; what is new is not set. */
void *gm_arena_resize(struct gm_arena *arena, void *block, size_t count, size_t size);
/* An array of the arena (or NULL) with room for one more than its `count` elements: it doubles when it is full. */
void *gm_arena_grown(struct gm_arena *arena, void *array, size_t count, size_t size);
/* A formatted text; leaves the body if it cannot be encoded, or when out of memory. */
__attribute__((format(printf, 2, 3))) char *gm_arena_print(struct gm_arena *arena, const char *format, ...);
/* Closes the thing with the arena; at once, if the memory to note it is refused. A thing that is NULL was
   refused. */
void *gm_arena_keep(struct gm_arena *arena, void *thing, void (*close)(void *thing));

/* Closes a thing that was kept before the others. */
void gm_arena_drop(struct gm_arena *arena, const void *thing);

/* gm_arena_mark returns a mark; gm_arena_release closes all that was taken after it, such as scratch
   memory. */
size_t gm_arena_mark(const struct gm_arena *arena);
void gm_arena_release(struct gm_arena *arena, size_t mark);

/* Leaves the body, for lack of memory, if `there` is false: another function returned nothing. */
void gm_arena_need(struct gm_arena *arena, bool there);
/* Leaves the body, with this message, if something could not be done. */
void gm_arena_check(struct gm_arena *arena, bool done, const char *message);
/* Leaves the body, with a message, if that is so. */
__attribute__((format(printf, 3, 4))) void gm_arena_refuse_if(struct gm_arena *arena, bool wrong,
                                                              const char *format, ...);
/* Leave the body, with a message, or with a reason in the body's data. */
__attribute__((format(printf, 2, 3))) _Noreturn void gm_arena_refuse(struct gm_arena *arena,
                                                                     const char *format, ...);
_Noreturn void gm_arena_leave(struct gm_arena *arena);

#endif
