/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_SHEET_H
#define GM_SCENES_FLOW_SHEET_H

#include "core/flow/flow.h"
#include "render/picture/picture.h"

/* A mesh as it is drawn: refined if it is coarse, unfolded if it is a torus. */
struct gm_flow_sheet {
    const double *points, *psi, *field; /* field: NULL for none */
    const int *triangles;
    size_t vertices, count;
};

/* Makes the sheet in the picture's arena; psi and field are values at the vertices. False when out of
   memory. */
bool gm_flow_sheet_make(struct gm_picture *picture, const struct gm_complex *complex, const double *psi,
                        const double *field, struct gm_flow_sheet *sheet);

#endif
