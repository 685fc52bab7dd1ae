/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Well-known equations of fields on a line, recognised by their rates. */
#ifndef GM_CORE_MODEL_RECOGNITION_H
#define GM_CORE_MODEL_RECOGNITION_H

#include "core/model/system.h"

enum { GM_EQUATION_CONSTANTS = 2 };
struct gm_recognised {
    const char *name; /* "Korteweg-de Vries"; NULL: none of those that are known */
    const char *constants[GM_EQUATION_CONSTANTS]; /* "eta"; NULL behind the last */
    gm_node_id values[GM_EQUATION_CONSTANTS];     /* in parameters */
};

/* Finds the equation of the rates, whatever the order of their terms. The graph grows. False when out of memory. */
bool gm_equation_recognise(struct gm_user_system *system, struct gm_recognised *found);

#endif
