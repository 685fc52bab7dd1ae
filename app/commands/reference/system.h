/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What geomint list tells of a system. */
#ifndef GM_APP_COMMANDS_REFERENCE_SYSTEM_H
#define GM_APP_COMMANDS_REFERENCE_SYSTEM_H

#include "app/base/arguments.h"
#include "app/base/files.h"

enum gm_telling { GM_TELL_SHORT, GM_TELL_ALL, GM_TELL_LATEX, GM_TELL_JSON };

/* geomint list SYSTEM: what a system says, and what was found out about it. The words behind the first give
   parameters other values; without a file they are all there is, "system H=... key=value ...". Returns the
   exit status. */
int gm_list_system(const struct gm_arguments *arguments, const struct gm_file *file, enum gm_telling telling);

/* ,"file":"systems/toda.system","source":"..."; null both where there is no file. */
void gm_list_file_json(const struct gm_file *file, const char *source);

#endif
