/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_TREES_H
#define GM_CORE_THEORY_TREES_H

#include <stddef.h>

#include "core/theory/coefficients.h"

/* Rooted trees, order by order. Each stands for an elementary differential of the solution, so for a
   condition of the order that it has vertices; in partitioned systems a vertex has a side, the side of
   its function. If f_q depends on p alone and f_p on q alone, sides alternate. If f_q is linear, a vertex of q
   has at most one branch. E. Hairer, S.P. Norsett & G. Wanner, Solving Ordinary Differential
   Equations I (1993), II.2, II.14, II.15. */

enum { GM_TREES_ORDER = 10 };

struct gm_tree {
    int order, side;
    int without, last; /* the tree `without` with one more branch, the tree `last`; -1: a single vertex */
    int times;         /* number of branches equal to the last one */
    double symmetry;   /* sigma: the order of its group of symmetries */
    double below;      /* the product of the densities of its branches */
};

struct gm_trees {
    struct gm_arena *arena; /* owns the trees */
    enum gm_equations equations;
    int orders;                    /* number of complete orders */
    int first[GM_TREES_ORDER + 2]; /* first tree of each order, and the end of the last one */
    int capacity;
    struct gm_tree *trees;
};

/* Returns no trees yet. */
static inline struct gm_trees gm_trees_open(struct gm_arena *arena, enum gm_equations equations)
{
    return (struct gm_trees){.arena = arena, .equations = equations};
}
/* Adds the next order; leaves the arena's body when out of memory. */
void gm_trees_grow(struct gm_trees *trees);

/* The density gamma: in the exact solution the tree's coefficient is 1 / gamma. */
double gm_tree_density(const struct gm_tree *tree);

/* Writes a tree: a vertex without branches is "t", or "q", "p" by its side; branches follow in brackets, as
   in t[t,t[t]]. */
void gm_tree_print(const struct gm_trees *trees, int index, char *text, size_t size);

#endif
