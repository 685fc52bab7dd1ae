/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_EDGES_H
#define GM_APP_STUDIES_EDGES_H

#include <stdbool.h>
#include <stddef.h>

/* The count + 1 edges of the cells around `count` >= 1 values in order: halfway between them, on the axis'
   scale. */
void gm_edges_of(const double *values, size_t count, bool logarithmic, double *edges);

#endif
