/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The match of schemes and problems: both are of one kind, and the problem has the facets that the scheme
   needs. */
#include "core/kind.h"

static unsigned facets_of(const struct gm_problem *problem)
{
    return problem->kind->facets ? problem->kind->facets(problem) : 0;
}

gm_loop *gm_scheme_loop(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const struct gm_kind *kind = problem->kind;
    gm_loop *by_kernels = kind->loop ? kind->loop(scheme, problem) : NULL;
    return by_kernels ? by_kernels : scheme->family->loop;
}

bool gm_scheme_workspace_open(const struct gm_scheme *scheme, const struct gm_problem *problem,
                              void **workspace)
{
    const struct gm_family *family = scheme->family;
    const bool needed = family->workspace_open && gm_scheme_loop(scheme, problem) == family->loop;
    *workspace = needed ? family->workspace_open(problem, scheme) : NULL;
    return !needed || *workspace;
}

bool gm_scheme_fits(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    return scheme->family->kind == problem->kind && (scheme->needs & ~facets_of(problem)) == 0 &&
           gm_scheme_loop(scheme, problem) && (problem->passive == 0 || scheme->family->carries_passive) &&
           (problem->m == 1 || !scheme->family->adaptive) &&
           !(scheme->family->lacks && scheme->family->lacks(scheme, problem));
}

/* The words of the first of these facets; NULL if none has words. */
static const struct gm_facet_words *words_of(const struct gm_kind *kind, unsigned needs)
{
    for (const struct gm_facet_words *words = kind->words; words && words->need; words++) {
        if (needs & words->need) {
            return words;
        }
    }
    return NULL;
}

const char *gm_scheme_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    if (scheme->family->kind != problem->kind) {
        return gm_scheme_problems(scheme);
    }
    const unsigned lacking = scheme->needs & ~facets_of(problem);
    const char *obstacle = problem->kind->obstacle ? problem->kind->obstacle(problem, lacking) : NULL;
    if (obstacle) {
        return obstacle;
    }
    const struct gm_facet_words *words = words_of(problem->kind, lacking);
    if (lacking && !words && scheme->by_names) {
        return gm_scheme_lacks(scheme->by_names, problem);
    }
    const char *alone =
        scheme->family->adaptive && problem->m > 1 ? "a single member, for its time is its own" : NULL;
    return words                             ? words->structure
           : alone || !scheme->family->lacks ? alone
                                             : scheme->family->lacks(scheme, problem);
}

const char *gm_scheme_problems(const struct gm_scheme *scheme)
{
    const struct gm_kind *kind = scheme->family->kind;
    const struct gm_facet_words *words = words_of(kind, scheme->needs);
    return words ? words->problems : kind->problems;
}
