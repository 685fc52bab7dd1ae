/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elementary functions of one pass, after core/functions/lanes.h: K(sin)(x). Their errors are below one unit in
   the last place, and their bits are those of gm_sin on every machine: all they do is add, multiply, divide, take
   roots and move bits, unfused. */
#undef GM_FUNCTION_OF_PASS
#define GM_FUNCTION_OF_PASS static __attribute__((noinline, unused))

#include "core/functions/pairs.h"

#include "core/functions/circular.h"
#include "core/functions/exponential.h"
#include "core/functions/logarithm.h"

#include "core/functions/angle.h"
#include "core/functions/errors.h"
#include "core/functions/roots.h"
