/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Hamiltonian that a symplectic method really solves, as a sum over trees. */
#ifndef GM_CORE_THEORY_MODIFIED_H
#define GM_CORE_THEORY_MODIFIED_H

#include "core/theory/trees.h"

enum { GM_MODIFIED_ORDER = 7 /* most vertices of a tree: up to dt^6 */ };

/* H~ = sum over terms of dt^(|tree| - 1) weight H(tree), with the elementary Hamiltonian H(tree) = D^m
   H(F(u_1), ..., F(u_m)) of the root's branches u_i and their elementary differentials F. Trees that
   differ only in the choice of the root have the same H(tree) up to the sign. The sum contains the one whose
   branches have at most half of its vertices, so F(u) is needed up to GM_MODIFIED_BRANCH vertices. If there
   are two such trees, each has half of the weight. E. Hairer, C. Lubich & G. Wanner, Geometric
   Numerical Integration (2006), IX.9, IX.10. */
enum { GM_MODIFIED_BRANCH = GM_MODIFIED_ORDER / 2 };

struct gm_modified_term {
    int tree; /* index in `trees`; if the side of the root does not matter, it is GM_SIDE_Q */
    double weight;
};

struct gm_modified {
    struct gm_trees trees; /* for a splitting the trees of T(p) + V(q) */
    struct gm_modified_term *terms;
    size_t count;
};

/* Finds the terms with at most `order` <= GM_MODIFIED_ORDER vertices of a symplectic method
   (gm_theory_is_symplectic), without terms that vanish to the precision of the coefficients, in an arena's body. */
struct gm_modified gm_modified_of(struct gm_arena *arena, const struct gm_coefficients *coefficients,
                                  int order);

/* The coefficients of the modified equation itself, y' = sum of dt^(|tree| - 1) / sigma b(tree) F(tree), of
   all trees that `trees` has, at most GM_MODIFIED_ORDER vertices, of any method; in the arena of the trees. */
struct gm_ball *gm_modified_equation(const struct gm_trees *trees,
                                     const struct gm_coefficients *coefficients);

#endif
