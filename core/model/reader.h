/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_READER_H
#define GM_CORE_MODEL_READER_H

#include "core/model/system.h"

/* Reads what a system says, not yet what follows from it: that is gm_equations_open. False with a fault,
   whose sentence is empty where memory was refused. To be closed in both cases. */
bool gm_system_read(struct gm_user_system *system, const char *text, size_t length,
                    const struct gm_system_value *values, size_t count, struct gm_fault *fault);

#endif
