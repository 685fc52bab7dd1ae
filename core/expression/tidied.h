/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas as a reader of them would write them. */
#ifndef GM_CORE_EXPRESSION_TIDIED_H
#define GM_CORE_EXPRESSION_TIDIED_H

#include "core/expression/writer.h"

/* A node of the same value, up to rounding, for print alone: products are one fraction, in which equal factors are
   one power and whole numbers are reduced; sums begin with what is added. Parts with a name stay, and their powers
   take the place of their square. The node itself where it is too long; GM_NO_NODE: out of memory. */
gm_node_id gm_formula_tidied(struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);

#endif
