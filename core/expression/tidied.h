/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas, rewritten for a human reader. */
#ifndef GM_CORE_EXPRESSION_TIDIED_H
#define GM_CORE_EXPRESSION_TIDIED_H

#include "core/expression/writer.h"

/* A node of the same value, up to rounding, for print alone: products are one fraction, with one power for
   equal factors and reduced whole numbers; sums begin with a positive term. Named parts stay, and powers of a
   named root replace powers of its square. Returns the node itself if it is too long; GM_NO_NODE when out of
   memory. */
gm_node_id gm_formula_tidied(struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming);

#endif
