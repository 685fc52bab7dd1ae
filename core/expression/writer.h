/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas as text, with as few parentheses as possible, for the reader or for LaTeX. */
#ifndef GM_CORE_EXPRESSION_WRITER_H
#define GM_CORE_EXPRESSION_WRITER_H

#include "core/expression/graph.h"

/* The names of variables and parts. */
struct gm_naming {
    const char *(*variable)(size_t number, const void *data); /* "q", "m[2]" */
    /* The name of a part, NULL: it is written out. NULL itself: no part has one. */
    const char *(*part)(gm_node_id node, const void *data);
    const void *data;
};

/* The caller frees the text; NULL when out of memory, or above GM_LONGEST_FORMULA operations and operands.
   Read again, it has the same values, bit for bit. */
enum { GM_LONGEST_FORMULA = 2000 };
char *gm_formula_text(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);
char *gm_formula_latex(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);
/* A node of the same value, up to rounding, for print alone: products are one fraction, with one power for
   equal factors and reduced whole numbers; sums begin with a positive term. Named parts stay, and powers of a
   named root replace powers of its square. Returns the node itself if it is too long; GM_NO_NODE when out of
   memory. */
gm_node_id gm_formula_tidied(struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);
/* A name in LaTeX, freed by the caller: "p_theta" as p_{\theta}, "q[2]" as q_{2}, "omega" as \omega. */
char *gm_name_latex(const char *name);

#endif
