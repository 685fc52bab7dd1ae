/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words for claims, and the parameters that schemes bring. */
#include "core/scheme.h"

#include <string.h>

#include "core/basics.h"

const struct gm_claim_words gm_claims[GM_CLAIM_COUNT] = {
    {"S", "symplectic", "symplectic"},
    {"=", "symmetric", "symmetric"},
    {"R", "reversible", "reversible"},
    {"H", "keeps energy", "conserves energy"},
    {"Q", "keeps quadratic invariants", "conserves quadratic invariants"},
    {"L", "keeps linear invariants", "conserves linear invariants"},
    {"V", "keeps volume", "preserves volume"},
    {"M", "multisymplectic", "multisymplectic"},
    {"G", "equivariant", "equivariant"},
    {"D", "divergence-free", "divergence-free"},
    {"C", "keeps constants", "preserves constants"},
    {"B", "closes budgets", "closes budgets"},
    {"A", "keeps bilinear invariants", "conserves bilinear invariants"},
    {"N", "keeps momentum maps", "conserves momentum maps"},
    {"F", "conformal symplectic", "conformal symplectic"},
    {"K", "keeps constraints", "satisfies constraints"},
    {"T", "keeps hidden constraints", "satisfies hidden constraints"},
    {"O", "keeps Casimirs", "conserves Casimirs"},
    {"P", "a Poisson map", "a Poisson map"},
};

bool gm_claims_read(const char *words, size_t length, unsigned *claims, size_t *wrong)
{
    const bool none = length == 4 && memcmp(words, "none", 4) == 0;
    *claims = 0;
    for (size_t at = 0; at < length && !none; at += strspn(words + at, " \t\n\r,")) {
        unsigned found = GM_CLAIM_COUNT;
        for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
            const size_t letters = strlen(gm_claims[bit].key), left = length - at;
            if (letters <= left && memcmp(words + at, gm_claims[bit].key, letters) == 0 &&
                (letters == left || strchr(" \t\n,", words[at + letters]))) {
                found = bit;
            }
        }
        if (found == GM_CLAIM_COUNT) {
            *wrong = at;
            return false;
        }
        *claims |= 1u << found;
        at += strlen(gm_claims[found].key);
    }
    return true;
}

const struct gm_parameter gm_settings_parameters[] = {
    GM_BOOLEAN_ROW(struct gm_settings, compensated, "compensated", "no",
                   "compensated summation: carry the rounding error of every step along"),
    GM_REAL_ROW(
        struct gm_settings, binding, "binding", "20", 0, 1e6,
        "frequency that binds the two copies of phase space; stiff springs allow at most 1/(dt Ω)² (tao2), half of it (tao4)"),
    GM_REAL_ROW(struct gm_settings, tau0, "tau0", "0.02", 1e-6, 1,
                "first time step of the schemes whose step follows from the variational principle",
                .logarithmic = true),
    GM_REAL_ROW(
        struct gm_settings, tolerance, "tolerance", "0", 0, 1,
        "error allowed in a step of dopri5 (0: 1e-6), or of a GSL stepper within dt (0: fixed step; multistep: 1e-8)",
        .least = 1e-15),
    GM_REAL_ROW(struct gm_settings, newmark_beta, "newmark_beta", "0.25", 0, 0.5,
                "how implicit Newmark's method is (variational-newmark2); 0: Verlet, 1/4: linear motion is "
                "stable with every time step"),
};
const size_t gm_settings_parameter_count = GM_COUNT(gm_settings_parameters);

const struct gm_parameter *gm_setting_find(const char *key)
{
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        if (strcmp(gm_settings_parameters[i].key, key) == 0) {
            return &gm_settings_parameters[i];
        }
    }
    return NULL;
}

const struct gm_parameter *const gm_settings_of_sums[] = {&gm_settings_parameters[0], NULL};
const struct gm_parameter *const gm_settings_of_tao[] = {&gm_settings_parameters[1], NULL};
const struct gm_parameter *const gm_settings_of_variational_time[] = {&gm_settings_parameters[2], NULL};
const struct gm_parameter *const gm_settings_of_tolerance[] = {&gm_settings_parameters[3], NULL};
const struct gm_parameter *const gm_settings_of_newmark[] = {&gm_settings_parameters[4], NULL};

bool gm_scheme_takes(const struct gm_scheme *scheme, const struct gm_parameter *row)
{
    const struct gm_parameter *const *at = scheme->family->parameters;
    while (at && *at && *at != row) {
        at++;
    }
    return at && *at;
}
