/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The structure that a system has, found in its formulas. */
#ifndef GM_CORE_MODEL_FACTS_H
#define GM_CORE_MODEL_FACTS_H

#include "core/model/system.h"

enum gm_fact {
    GM_FACT_SEPARABLE,       /* H = T(p) + V(q) */
    GM_FACT_NYSTROM,         /* and T is quadratic */
    GM_FACT_LINEAR,          /* the rates are polynomials of degree 1, */
    GM_FACT_QUADRATIC,       /* or of degree 2 */
    GM_FACT_VOLUME,          /* no rate contains its own variable: exact flows without divergence */
    GM_FACT_DIVERGENCE_FREE, /* the sum of d rate / d component is 0 */
    GM_FACT_SMOOTH,          /* no min, max, abs, mod */
    GM_FACT_AUTONOMOUS,      /* t does not occur */
    /* H = |p|^2/2 + sum of omega_i^2 q_i^2 / 2 + U(q); nodes: all omega_i, all -dU/dq_i */
    GM_FACT_FAST_LINEAR,
    /* H = |p|^2/2 + V(q), V = -1/|q| + W(q) < 0 in the plane; nodes: V, both -dW/dq_i */
    GM_FACT_KEPLER_SPLIT,
    GM_FACT_LAGRANGIAN, /* L = v^2/2 - V(q), one degree of freedom; nodes: V, V', V'' */
    GM_FACT_CONFORMAL,  /* every force is -c p with the same constant c, its node */
    GM_FACTS
};

struct gm_finding {
    bool asked; /* the kind of system has such a structure, or not */
    bool holds;
    enum gm_identity how; /* proved, or tested at random points, with the parameters as they are */
    gm_node_id term;      /* what stands in its way; GM_NO_NODE */
    size_t component;     /* in the rate of this component; n: in H or L */
    const char *why;      /* it does; NULL: as usual */
    const gm_node_id
        *nodes; /* that make the facet of core/ode/ode.h, where it holds; they are the system's */
};

/* "separable" */
const char *gm_fact_word(enum gm_fact fact);
/* Finds all. False where memory was refused. */
bool gm_facts_find(struct gm_user_system *system, struct gm_finding findings[GM_FACTS]);
/* The reason in words: what was found how, or the term with its place. malloc'ed; NULL: no memory. */
char *gm_fact_reason(const struct gm_user_system *system, enum gm_fact fact,
                     const struct gm_finding *finding);

#endif
