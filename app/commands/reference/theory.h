/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_REFERENCE_THEORY_H
#define GM_APP_COMMANDS_REFERENCE_THEORY_H

#include "core/theory/theory.h"

/* What theory says of a scheme, on standard output: as lines that begin with `indent`; as the value of a JSON
   key, null where nothing is known. */
void gm_theory_print(const struct gm_theory *theory, const char *indent);
void gm_theory_print_json(const struct gm_theory *theory);

#endif
