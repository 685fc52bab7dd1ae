/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_ROWS_H
#define GM_SCENES_COMMON_ROWS_H

#include "core/basics.h"
#include "core/parameter.h"

/* The rows of a scene's tables, beside the rows of parameters in core/parameter.h. A row ends with the title of an
   observable, and further fields of its struct may follow, as there. */

/* The two parameters of every scene. */
#define GM_DT(standard, low, high)                                                                           \
    GM_REAL_ROW(struct gm_timing, dt, "dt", standard, low, high, "time step", .logarithmic = true,           \
                .live = true)
#define GM_UNTIL(standard)                                                                                   \
    GM_REAL_ROW(struct gm_timing, until, "until", standard, 0, GM_NEVER,                                     \
                "time at which run and render stop", .logarithmic = true, .live = true)

/* Observables: the value of `evaluate`; the same on a log axis; the error of a conserved quantity, whose
   symbol in formulas is `symbol`. */
#define GM_OBSERVABLE(key_, evaluate_, ...)                                                                  \
    {                                                                                                        \
        .key = key_, .unit = "", .evaluate = evaluate_, .title = __VA_ARGS__                                 \
    }
#define GM_LOG_OBSERVABLE(key, evaluate, ...) GM_OBSERVABLE(key, evaluate, __VA_ARGS__, .logarithmic = true)
#define GM_KEPT_OBSERVABLE(key, evaluate, symbol_, ...)                                                      \
    GM_LOG_OBSERVABLE(key, evaluate, __VA_ARGS__, .error = true, .symbol = symbol_, .kept = true)

#endif
