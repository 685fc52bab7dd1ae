/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_REFERENCE_THEORY_H
#define GM_APP_COMMANDS_REFERENCE_THEORY_H

#include "core/theory/theory.h"

/* What theory says of a scheme, on standard output, as lines that begin with `indent`. */
void gm_theory_print(const struct gm_theory *theory, const char *indent);

#endif
