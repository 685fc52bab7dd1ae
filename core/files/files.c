/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search for a built-in file, by kind and name. */
#include "core/files/files.h"

#include <string.h>

const struct gm_built_in *gm_built_in_find(enum gm_file_kind kind, const char *name)
{
    for (size_t i = 0; i < gm_built_in_count; i++) {
        if (gm_built_in_files[i].kind == kind && strcmp(gm_built_in_files[i].name, name) == 0) {
            return &gm_built_in_files[i];
        }
    }
    return NULL;
}
