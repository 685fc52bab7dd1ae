/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/functions/functions.h"

#define GM_PASS_SCALAR
#include "core/functions/lanes.h"

#include "core/functions/pass.h"

#define GM_DEFINE_1(name)                                                                                    \
    double gm_##name(double x)                                                                               \
    {                                                                                                        \
        return K(name)(x);                                                                                   \
    }
#define GM_DEFINE_2(name)                                                                                    \
    double gm_##name(double x, double y)                                                                     \
    {                                                                                                        \
        return K(name)(x, y);                                                                                \
    }
#define GM_FUNCTION(name, arity) GM_DEFINE_##arity(name)
#include "core/functions/functions.def"
