/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each tree is made once, from the tree without its last branch and that branch. Branches are sorted in the order in
   which trees are made. */
#include "core/theory/trees.h"

#include <stdio.h>
#include <string.h>

#include "core/arena.h"

double gm_tree_density(const struct gm_tree *tree)
{
    return tree->order * tree->below;
}

static void add(struct gm_trees *trees, struct gm_tree tree)
{
    int *count = &trees->first[tree.order + 1];
    if (*count == trees->capacity) {
        trees->capacity = trees->capacity ? 2 * trees->capacity : 64;
        trees->trees =
            gm_arena_resize(trees->arena, trees->trees, (size_t)trees->capacity, sizeof *trees->trees);
    }
    trees->trees[(*count)++] = tree;
}

/* Returns true if the root of a tree may have this additional branch. */
static bool may_branch(enum gm_equations equations, const struct gm_tree *tree, const struct gm_tree *branch)
{
    switch (equations) {
    case GM_EQUATIONS_SEPARABLE:
        return tree->side != branch->side;
    case GM_EQUATIONS_NYSTROM:
        return tree->side != branch->side && (tree->side == GM_SIDE_P || tree->last < 0);
    default:
        return true;
    }
}

void gm_trees_grow(struct gm_trees *trees)
{
    const int order = ++trees->orders;
    trees->first[order + 1] = trees->first[order];
    if (order == 1) {
        const struct gm_tree vertex = {
            .order = 1, .without = -1, .last = -1, .symmetry = 1, .below = 1, .side = GM_SIDE_Q};
        struct gm_tree other = vertex;
        other.side = GM_SIDE_P;
        add(trees, vertex);
        if (trees->equations != GM_EQUATIONS_PLAIN) {
            add(trees, other);
        }
    }
    for (int without = 0; without < trees->first[order]; without++) {
        const int rest = order - trees->trees[without].order;
        for (int last = trees->first[rest]; last < trees->first[rest + 1]; last++) {
            const struct gm_tree *tree = &trees->trees[without], *branch = &trees->trees[last];
            if (last < tree->last || !may_branch(trees->equations, tree, branch)) {
                continue;
            }
            const int times = last == tree->last ? tree->times + 1 : 1;
            add(trees, (struct gm_tree){.order = order,
                                        .side = tree->side,
                                        .without = without,
                                        .last = last,
                                        .times = times,
                                        .symmetry = tree->symmetry * branch->symmetry * times,
                                        .below = tree->below * gm_tree_density(branch)});
        }
    }
}

/* Appends to the text, as far as there is room; how much there is then. */
static size_t append(char *text, size_t size, size_t used, const char *what)
{
    const int length = used < size ? snprintf(text + used, size - used, "%s", what) : 0;
    return used + (size_t)length;
}

static size_t print(const struct gm_trees *trees, int index, char *text, size_t size, size_t used)
{
    const struct gm_tree *tree = &trees->trees[index];
    if (tree->last < 0) {
        return append(text, size, used,
                      trees->equations == GM_EQUATIONS_PLAIN ? "t"
                      : tree->side == GM_SIDE_Q              ? "q"
                                                             : "p");
    }
    used = print(trees, tree->without, text, size, used);
    if (trees->trees[tree->without].last < 0) {
        used = append(text, size, used, "[");
    } else {
        used = append(text, size, used - 1, ","); /* replaces the bracket */
    }
    used = print(trees, tree->last, text, size, used);
    return append(text, size, used, "]");
}

void gm_tree_print(const struct gm_trees *trees, int index, char *text, size_t size)
{
    print(trees, index, text, size, 0);
}
