/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of the multiplier strategy, for families that vary the step. */
#ifndef GM_CORE_MESH_FAMILIES_MULTIPLIER_H
#define GM_CORE_MESH_FAMILIES_MULTIPLIER_H

#include "core/mesh/tableau.h"
#include "core/scheme.h"

/* A row of the family: its tableau, the kernel of a and the left kernel of abar. */
struct gm_multiplier {
    const struct gm_tableau *tableau;
    double kappa[GM_STAGES]; /* a kappa = 0 */
    double left[GM_STAGES];  /* left^T abar = 0 */
};
extern const struct gm_multiplier gm_multiplier_lobatto4;

size_t gm_multiplier_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_multiplier_start(const struct gm_task *task);
struct gm_progress gm_multiplier_advance(const struct gm_task *task);
void *gm_multiplier_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_multiplier_workspace_close(void *workspace);
void gm_multiplier_workspace_reset(void *workspace);

#endif
