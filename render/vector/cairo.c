/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/vector/cairo.h"

#include <errno.h>
#include <pthread.h>

#include "render/address_space.h"
#include "render/gl/library.h"
#include "render/message.h"

enum { TAKEN = 16 << 20 /* bytes of address space that Cairo and its libraries take */ };

struct gm_cairo gm_cairo;

static bool opened;
static char reason[GM_MESSAGE];

static void open_once(void)
{
    static const char *const names[] = {"libcairo.so.2", NULL};
#define SYMBOL(name) {"cairo_" #name, &gm_cairo.name},
    static const struct gm_library_symbol symbols[] = {GM_CAIRO_FUNCTIONS(SYMBOL)};
    void *library = gm_library_open(names, reason, sizeof reason);
    opened = library && gm_library_find(library, symbols, sizeof symbols / sizeof *symbols);
    if (library && !opened) {
        gm_refuse(reason, "libcairo is too old");
    }
}

bool gm_cairo_open(char *message)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, open_once);
    if (!opened) {
        gm_refuse(message, "a PDF needs Cairo, but %s", reason);
        errno = gm_address_space_has(TAKEN) ? ENOENT : ENOMEM; /* the loader gives only a text */
    }
    return opened;
}
