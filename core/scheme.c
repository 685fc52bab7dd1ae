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

const char *gm_claim_letter(unsigned bit)
{
    return claims[bit].letter;
}

const char *gm_claim_word(unsigned bit)
{
    return claims[bit].word;
}

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
    {
        .key = "binding",
        .unit = "",
        .help = "frequency that binds the two copies of phase space (tao2, tao4)",
        .type = GM_REAL,
        .offset = offsetof(struct gm_settings, binding),
        .standard = "20",
        .lowest = 0,
        .highest = 1e6,
    },
    {
        .key = "tau0",
        .unit = "",
        .help = "first time step of the schemes that choose their step by the variational principle",
        .type = GM_REAL,
        .offset = offsetof(struct gm_settings, tau0),
        .standard = "0.02",
        .lowest = 1e-6,
        .highest = 1,
        .logarithmic = true,
    },
    {
        .key = "tolerance",
        .unit = "",
        .help =
            "error that a GSL stepper allows within a time step; 0: a fixed step (multistep methods: 1e-8)",
        .type = GM_REAL,
        .offset = offsetof(struct gm_settings, tolerance),
        .standard = "0",
        .lowest = 0,
        .highest = 1,
    },
};
const size_t gm_settings_parameter_count = sizeof gm_settings_parameters / sizeof gm_settings_parameters[0];

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
const struct gm_parameter *const gm_settings_of_gsl[] = {&gm_settings_parameters[3], NULL};

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
        if (strcmp(scheme->name, name) == 0 || (scheme->alias && strcmp(scheme->alias, name) == 0)) {
            return scheme;
        }
    }
    return NULL;
}

const struct gm_scheme *gm_scheme_find_for(const char *name, const struct gm_problem *problem)
{
    const struct gm_scheme *found = gm_scheme_find(name);
    for (size_t i = 0; found && i < gm_scheme_count() && !gm_scheme_fits(found, problem); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (strcmp(scheme->name, name) == 0 && gm_scheme_fits(scheme, problem)) {
            return scheme;
        }
    }
    return found;
}

static unsigned facets_of(const struct gm_problem *problem)
{
    const struct gm_ode *ode = problem->ode;
    const struct gm_split *split = problem->split;
    const struct gm_hamiltonian *hamiltonian = problem->hamiltonian;
    return (ode ? GM_NEEDS_ODE : 0) | (split ? GM_NEEDS_SPLIT : 0) |
           (hamiltonian ? GM_NEEDS_HAMILTONIAN : 0) | (problem->lagrangian ? GM_NEEDS_LAGRANGIAN : 0) |
           (problem->fast_linear ? GM_NEEDS_FAST_LINEAR : 0) |
           (problem->kepler_split ? GM_NEEDS_KEPLER_SPLIT : 0) | (problem->volume ? GM_NEEDS_VOLUME : 0) |
           (hamiltonian && !split ? GM_NEEDS_INSEPARABLE : 0) |
           (hamiltonian && !hamiltonian->partial ? GM_NEEDS_ENERGY : 0) |
           (ode && ode->quadratic ? GM_NEEDS_QUADRATIC : 0) |
           (split && split->nystrom ? GM_NEEDS_NYSTROM : 0) | (problem->field ? GM_NEEDS_FIELD : 0) |
           (problem->wave ? GM_NEEDS_WAVE : 0) | (problem->burgers ? GM_NEEDS_BURGERS : 0) |
           (problem->kdv ? GM_NEEDS_KDV : 0) | (problem->nls ? GM_NEEDS_NLS : 0) |
           (problem->moving_mesh ? GM_NEEDS_MOVING_MESH : 0) | (problem->flow ? GM_NEEDS_COMPLEX : 0);
}

gm_loop *gm_scheme_loop(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    /* the loops of wide registers are for ensembles */
    const struct gm_loops *loops = problem->loops[problem->m == 1 ? GM_ISA_BASELINE : gm_isa_best()];
    gm_loop *by_kernels = loops ? loops->family[scheme->family->id] : NULL;
    return by_kernels ? by_kernels : scheme->family->loop;
}

bool gm_scheme_fits(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    return (scheme->needs & ~facets_of(problem)) == 0 && gm_scheme_loop(scheme, problem) &&
           (problem->passive == 0 || scheme->family->carries_passive) &&
           (problem->m == 1 || !scheme->family->own_time);
}
