/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_READER_H
#define GM_CORE_MODEL_READER_H

#include "core/model/system.h"

/* Reads a system, without derived equations (gm_equations_open). False with a fault, whose sentence is empty
   when out of memory. The caller closes the system in both cases. */
bool gm_system_read(struct gm_user_system *system, const char *text, size_t length,
                    const struct gm_system_value *values, size_t count, struct gm_fault *fault);

#endif
