/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elementary functions with the same bits on every machine, for every compiler and set of instructions. Their errors
   are below one unit in the last place (gm_erfc: six), and special values are those of C17, F.10. */
#ifndef GM_CORE_FUNCTIONS_FUNCTIONS_H
#define GM_CORE_FUNCTIONS_FUNCTIONS_H

#define GM_OF_ARITY_1 double
#define GM_OF_ARITY_2 double, double
#define GM_FUNCTION(name, arity) double gm_##name(GM_OF_ARITY_##arity);
#include "core/functions/functions.def"

#endif
