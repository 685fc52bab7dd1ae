/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names as written in pictures (symbol.h). */
#include "scenes/common/symbol.h"

#include <string.h>

#include "core/basics.h"

const char *gm_greek(const char *name, size_t length)
{
    static const char *const letters[][2] = {
        {"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},  {"eps", "ε"},  {"epsilon", "ε"},
        {"eta", "η"},   {"theta", "θ"}, {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},   {"nu", "ν"},
        {"xi", "ξ"},    {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},    {"phi", "φ"},  {"chi", "χ"},
        {"psi", "ψ"},   {"omega", "ω"}, {"pi", "π"},    {"Omega", "Ω"},  {"Delta", "Δ"}};
    for (size_t i = 0; i < GM_COUNT(letters); i++) {
        if (strlen(letters[i][0]) == length && memcmp(letters[i][0], name, length) == 0) {
            return letters[i][1];
        }
    }
    return NULL;
}

const char *gm_key_symbol(const char *key)
{
    const char *letter = gm_greek(key, strlen(key));
    return letter ? letter : strcmp(key, "dt") == 0 ? "Δt" : strcmp(key, "dx") == 0 ? "Δx" : key;
}
