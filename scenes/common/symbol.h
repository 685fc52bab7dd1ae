/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names as pictures write them. */
#ifndef GM_SCENES_COMMON_SYMBOL_H
#define GM_SCENES_COMMON_SYMBOL_H

#include <stddef.h>

/* The Greek letter of that name, of so many bytes: "lambda" is "λ"; NULL: there is none. */
const char *gm_greek(const char *name, size_t length);

/* A key of a parameter as labels of lanes and axes have it: "dt" is "Δt", "lambda" is "λ", any other itself. */
const char *gm_key_symbol(const char *key);

#endif
