/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_ROWS_H
#define GM_SCENES_COMMON_ROWS_H

#include "core/basics.h"
#include "core/parameter.h"

/* The rows of a scene's tables. A row ends with a text (the help of a parameter, the title of an observable),
   and further fields of its struct may follow: GM_REAL_ROW(struct disc, radius, "radius", "0.2", 1e-6, 100,
   "radius of the disc", .logarithmic = true). */

/* Parameters: `member` of the scene's own struct `own`, of a type of enum gm_type. */
#define GM_ROW(own, member, key_, type_, standard_, ...)                                                     \
    .key = key_, .unit = "", .type = type_, .offset = offsetof(own, member), .standard = standard_,          \
    .help = __VA_ARGS__
#define GM_REAL_ROW(own, member, key, standard, low, high, ...)                                              \
    {                                                                                                        \
        GM_ROW(own, member, key, GM_REAL, standard, __VA_ARGS__), .lowest = low, .highest = high             \
    }
#define GM_INTEGER_ROW(own, member, key, standard, low, high, ...)                                           \
    {                                                                                                        \
        GM_ROW(own, member, key, GM_INTEGER, standard, __VA_ARGS__), .lowest = low, .highest = high          \
    }
#define GM_CHOICE_ROW(own, member, key, standard, list, ...)                                                 \
    {                                                                                                        \
        GM_ROW(own, member, key, GM_CHOICE, standard, __VA_ARGS__), .choices = list                          \
    }
#define GM_BOOLEAN_ROW(own, member, key, standard, ...)                                                      \
    {                                                                                                        \
        GM_ROW(own, member, key, GM_BOOLEAN, standard, __VA_ARGS__), .highest = 1                            \
    }
#define GM_TEXT_ROW(own, member, key, standard, ...)                                                         \
    {                                                                                                        \
        GM_ROW(own, member, key, GM_TEXT, standard, __VA_ARGS__)                                             \
    }

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
