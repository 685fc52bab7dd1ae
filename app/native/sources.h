/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_SOURCES_H
#define GM_APP_NATIVE_SOURCES_H

#include <stddef.h>

/* The folder that holds core/ode with the sources of loops: that of GEOMINT_KERNEL, or beside the installed program, or
   where it was installed to. Returns path. */
const char *gm_kernel_folder(char *path, size_t size);

#endif
