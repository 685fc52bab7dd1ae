/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interface of a kind of problem to the rest of core: a struct of data and hooks. */
#ifndef GM_CORE_KIND_H
#define GM_CORE_KIND_H

#include "core/scheme.h"

struct gm_certificate;
struct gm_certified_system;
struct gm_quantity;
struct gm_run;

/* The words for a facet. */
struct gm_facet_words {
    unsigned need;         /* GM_NEEDS_... of the kind; 0 ends a list */
    const char *structure; /* missing from a problem without the facet: "a Hamiltonian" */
    const char *problems;  /* problems with the facet: "Hamiltonian systems" */
};

/* Two names of one method: if `holds`, the first makes the steps of the second, up to rounding. */
struct gm_same {
    const char *scheme, *other;
    bool (*holds)(const struct gm_problem *problem); /* for problems that fit both */
};

/* A kind of problem: its facets, its problems, its families of schemes and the systems for their
   certification. The rest of core knows a problem only through it. */
struct gm_kind {
    const char *name;     /* "ode" */
    const char *problems; /* "ordinary differential equations" */
    /* The words for facets, the most specific first; NULL: none. */
    const struct gm_facet_words *words;
    /* The facets that a problem of this kind has, as bits. NULL: none have names. */
    unsigned (*facets)(const struct gm_problem *problem);
    /* The reason for facets that a problem lacks, worded like a facet; NULL, or it returns NULL: none. */
    const char *(*obstacle)(const struct gm_problem *problem, unsigned lacking);
    /* The loop over the problem's own kernels; NULL, or it returns NULL: the family's own. */
    gm_loop *(*loop)(const struct gm_scheme *scheme, const struct gm_problem *problem);
    /* Makes the parts of a problem that steps of this scheme need, if they are made on demand; NULL: none
       are. */
    void (*prepare)(const struct gm_scheme *scheme, const struct gm_problem *problem);
    /* Measures the order and the claims of a scheme of this kind. */
    void (*certify)(const struct gm_scheme *scheme, struct gm_certificate *certificate);
    /* Measures a scheme on one system; NULL: this kind has no certification on given systems. */
    void (*certify_on)(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate);
    size_t most_certified;                   /* most components for certify_on */
    const struct gm_family *const *families; /* NULL-terminated */
    const struct gm_same *same;              /* ends with a row without a scheme; NULL: none */
    /* The named arrays of a run's states: gm_quantities of core/quantity.h. */
    size_t (*quantities)(const struct gm_run *run, struct gm_quantity *quantities);
};

/* The loop that advances this problem with this scheme: the loop over the problem's kernels, else the
   family's, else NULL. The family's workspace is opened for its own loop only. */
gm_loop *gm_scheme_loop(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* Opens the family's workspace for a loop of its own: NULL without one, or with another loop. Returns
   false when out of memory. */
bool gm_scheme_workspace_open(const struct gm_scheme *scheme, const struct gm_problem *problem,
                              void **workspace);
/* Returns true if the problem has all needed facets. */
bool gm_scheme_fits(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* The facet that the scheme needs and the problem lacks, in words; NULL if it fits, or without words. */
const char *gm_scheme_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* The problems that a scheme is for, in words: all of its kind, or those with the most specific facet. */
const char *gm_scheme_problems(const struct gm_scheme *scheme);

#endif
