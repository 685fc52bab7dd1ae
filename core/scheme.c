/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/scheme.h"

#include <string.h>

#include "core/families/families.h"
#include "core/kernel/loops.h"

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/schemes.def"
#undef GM_FAMILY
};

static const struct {
    const char *letter, *word;
} claims[GM_CLAIM_COUNT] = {
    {"S", "symplectic"},
    {"=", "symmetric"},
    {"R", "reversible"},
    {"H", "keeps energy"},
    {"Q", "keeps quadratic invariants"},
    {"L", "keeps linear invariants"},
    {"V", "keeps volume"},
    {"M", "multisymplectic"},
    {"G", "equivariant"},
    {"D", "divergence-free"},
    {"C", "keeps constants"},
    {"B", "closes budgets"},
};

const char *gm_claim_letter(unsigned bit) { return claims[bit].letter; }

const char *gm_claim_word(unsigned bit) { return claims[bit].word; }

const struct gm_parameter gm_settings_parameters[] = {
    {
        .key = "compensated",
        .unit = "",
        .help = "compensated summation: carry the rounding error of every step along",
        .type = GM_BOOLEAN,
        .offset = offsetof(struct gm_settings, compensated),
        .standard = "no",
        .lowest = 0,
        .highest = 1,
    },
};
const size_t gm_settings_parameter_count = sizeof gm_settings_parameters / sizeof gm_settings_parameters[0];

const struct gm_parameter *const gm_settings_of_sums[] = {&gm_settings_parameters[0], NULL};

size_t gm_scheme_count(void)
{
    size_t count = 0;
    for (size_t i = 0; i < GM_FAMILY_COUNT; i++) {
        count += families[i]->count;
    }
    return count;
}

const struct gm_scheme *gm_scheme_at(size_t index)
{
    for (size_t i = 0; i < GM_FAMILY_COUNT; i++) {
        if (index < families[i]->count) {
            return &families[i]->schemes[index];
        }
        index -= families[i]->count;
    }
    return NULL;
}

const struct gm_scheme *gm_scheme_find(const char *name)
{
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (strcmp(scheme->name, name) == 0) {
            return scheme;
        }
    }
    return NULL;
}

bool gm_scheme_fits(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const unsigned has = (problem->ode ? GM_NEEDS_ODE : 0) | (problem->split ? GM_NEEDS_SPLIT : 0) |
                         (problem->flow ? GM_NEEDS_COMPLEX : 0);
    const struct gm_loops *loops = problem->loops[GM_ISA_BASELINE];
    return (scheme->needs & ~has) == 0 && (scheme->family->loop || (loops && loops->family[scheme->family->id]));
}
