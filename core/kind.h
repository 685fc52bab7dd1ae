/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one way in which the hall knows the wings: a struct of data and hooks for each kind of problem. */
#ifndef GM_CORE_KIND_H
#define GM_CORE_KIND_H

#include "core/scheme.h"

struct gm_certificate;
struct gm_certified_system;
struct gm_quantity;
struct gm_run;

/* What a facet is called. */
struct gm_facet_words {
    unsigned need;         /* GM_NEEDS_... of the kind; 0 ends a list */
    const char *structure; /* what a problem without it lacks: "a Hamiltonian" */
    const char *problems;  /* those that have it: "Hamiltonian systems" */
};

/* Two names of one method: where `holds`, the first makes the steps of the second, but for rounding. */
struct gm_same {
    const char *scheme, *other;
    bool (*holds)(const struct gm_problem *problem); /* of problems that both fit */
};

/* A kind of problem: a wing of core, which brings its facets, its problems, its families of schemes and what
   they are certified on. The hall knows a problem only through it. */
struct gm_kind {
    const char *name;     /* "ode" */
    const char *problems; /* "ordinary differential equations" */
    /* Those facets first that say most; NULL: none have words. */
    const struct gm_facet_words *words;
    /* The facets that a problem of this kind has, as bits. NULL: none have names. */
    unsigned (*facets)(const struct gm_problem *problem);
    /* What is in the way of those that it lacks, as words of them; NULL, or it returns NULL: nothing is. */
    const char *(*obstacle)(const struct gm_problem *problem, unsigned lacking);
    /* The loop over the problem's own kernels; NULL, or it returns NULL: the family's own. */
    gm_loop *(*loop)(const struct gm_scheme *scheme, const struct gm_problem *problem);
    /* Makes what steps of this scheme ask the problem for, where it is made late; NULL: nothing is. */
    void (*prepare)(const struct gm_scheme *scheme, const struct gm_problem *problem);
    /* Measures the order and the claims of a scheme of this kind. */
    void (*certify)(const struct gm_scheme *scheme, struct gm_certificate *certificate);
    /* The same on one system; NULL: what is certified on a given system is none of this kind. */
    void (*certify_on)(const struct gm_scheme *scheme, const struct gm_certified_system *system,
                       struct gm_certificate *certificate);
    size_t most_certified;                   /* components of such a system */
    const struct gm_family *const *families; /* NULL-terminated */
    const struct gm_same *same;              /* a row without a scheme ends them; NULL: there are none */
    /* What a run's states are called: gm_quantities of core/quantity.h. */
    size_t (*quantities)(const struct gm_run *run, struct gm_quantity *quantities);
};

/* The loop that advances this problem by this scheme: that over the problem's kernels, else the family's;
   NULL if there is neither. The family's workspace is opened for its own loop only. */
gm_loop *gm_scheme_loop(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* Opens the family's workspace for a loop of its own: NULL where it has none, or the loop is another. False: out
   of memory. */
bool gm_scheme_workspace_open(const struct gm_scheme *scheme, const struct gm_problem *problem,
                              void **workspace);
/* whether the problem has what the scheme needs */
bool gm_scheme_fits(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* What the scheme needs and the problem lacks, in words; NULL if it fits, or where there is no word for
   it. */
const char *gm_scheme_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem);
/* The problems that a scheme is for, in words: those of its kind, or of the facet that says most. */
const char *gm_scheme_problems(const struct gm_scheme *scheme);

#endif
