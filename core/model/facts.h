/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The structure of a system, found in its formulas. */
#ifndef GM_CORE_MODEL_FACTS_H
#define GM_CORE_MODEL_FACTS_H

#include "core/model/system.h"

enum gm_fact {
    GM_FACT_SEPARABLE,    /* H = T(p) + V(q) */
    GM_FACT_NYSTROM,      /* H = T(p, t) + V(q, t), and T is quadratic */
    GM_FACT_SECOND_ORDER, /* x' = v, v' = g(x, t), all x before all v */
    /* x' = v, v' = g + W v, W antisymmetric, or H = c |p - A|^2/2 + phi, in two or three dimensions */
    GM_FACT_MAGNETIC,
    GM_FACT_LINEAR,          /* the rates are polynomials of degree 1 */
    GM_FACT_QUADRATIC,       /* the rates are polynomials of degree 2 */
    GM_FACT_VOLUME,          /* no rate contains its own variable: exact flows without divergence */
    GM_FACT_DIVERGENCE_FREE, /* the sum of d rate / d component is 0 */
    GM_FACT_SMOOTH,          /* no corner and no jump */
    GM_FACT_AUTONOMOUS,      /* t does not occur */
    /* H = |p|^2/2 + sum of omega_i^2 q_i^2 / 2 + U(q); nodes: all omega_i, all -dU/dq_i */
    GM_FACT_FAST_LINEAR,
    /* H = |p|^2/2 + V(q), V = -1/|q| + W(q) < 0 in the plane; nodes: V, both -dW/dq_i */
    GM_FACT_KEPLER_SPLIT,
    /* H = sum |p_i|^2/(2 m_i) - sum G m_i m_j/|q_i - q_j| over all pairs of two bodies or more; nodes: the number of
       dimensions, 2 or 3; the coordinates, body by body; all 1/m_i; G */
    GM_FACT_GRAVITY,
    GM_FACT_LAGRANGIAN, /* L = v^2/2 - V(q), one degree of freedom; nodes: V, V', V'' */
    GM_FACT_CONFORMAL,  /* every force is -c p with the same constant c, its node */
    GM_FACT_DEGENERATE, /* L = theta(q) . q' - H(q) */
    GM_FACT_HALF_GAUGE, /* half of theta, or more, are 0 */
    GM_FACTS
};

struct gm_finding {
    bool asked; /* applies to this kind of system */
    bool holds;
    enum gm_identity how;    /* proved, or tested at random points for the system's parameters */
    gm_node_id term;         /* the reason against it, or what it leaves out; GM_NO_NODE */
    size_t component;        /* component whose rate has the term; n: H or L */
    const char *why;         /* reason in words; NULL: the usual words */
    const gm_node_id *nodes; /* nodes of the facet of core/ode/ode.h, if it holds; owned by the system */
};

/* The word of a fact: "separable". */
const char *gm_fact_word(enum gm_fact fact);
/* Finds all facts. False when out of memory. */
bool gm_facts_find(struct gm_user_system *system, struct gm_finding findings[GM_FACTS]);
/* The reason in words: the method of the proof, or the term with its place. The caller frees; NULL when out
   of memory. */
char *gm_fact_reason(const struct gm_user_system *system, enum gm_fact fact,
                     const struct gm_finding *finding);

#endif
