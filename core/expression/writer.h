/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas as text, with no more parentheses than are needed: to be read again, or by LaTeX. */
#ifndef GM_CORE_EXPRESSION_WRITER_H
#define GM_CORE_EXPRESSION_WRITER_H

#include "core/expression/graph.h"

/* What things are called. */
struct gm_naming {
    const char *(*variable)(size_t number, const void *data); /* "q", "m[2]" */
    /* The name of a part that has one, NULL: it is written out. NULL itself: no part has one. */
    const char *(*part)(gm_node_id node, const void *data);
    const void *data;
};

/* Text is malloc'ed; NULL where memory is short, or where more than GM_LONGEST_FORMULA would be written. What
   is written, read again, has the same values, bit for bit. */
enum { GM_LONGEST_FORMULA = 2000 };
char *gm_formula_text(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);
char *gm_formula_latex(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);
/* A name as LaTeX writes it: "p_theta" as p_{\theta}, "q[2]" as q_{2}, "omega" as \omega. */
char *gm_name_latex(const char *name);

#endif
