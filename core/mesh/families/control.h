/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_FAMILIES_CONTROL_H
#define GM_CORE_MESH_FAMILIES_CONTROL_H

#include "core/mesh/families/mesh.h"
#include "core/mesh/nodes.h"
#include "core/mesh/tableau.h"

/* A row of the family, its scratch, and the equations of a step. Unknowns at a node, stage by stage: dy/dt,
   and where the mesh moves X and dX/dt. */

struct gm_control {
    enum gm_mesh_kind kind;
    const struct gm_tableau *tableau;
};

struct gm_control_work {
    struct gm_mesh mesh;
    const struct gm_control *row;
    double h;
    const double *state;
    struct gm_solver solver;
    struct gm_elements stages[GM_STAGES];
    struct gm_elements ends;  /* of a step: the start, then the end */
    struct gm_banded places;  /* N, for the mesh at the end */
    struct gm_banded motions; /* velocities from momenta */
    double *momenta, *scratch;
};

static inline bool gm_control_moves(const struct gm_control *row)
{
    return row->kind == GM_MESH_MOVING;
}

/* unknowns at a node for one stage, and for all */
static inline size_t gm_control_width(const struct gm_control *row)
{
    return gm_control_moves(row) ? 3 : 1;
}

static inline size_t gm_control_unknowns(const struct gm_control *row)
{
    return gm_control_width(row) * row->tableau->stages;
}

/* What struct gm_equations asks for; `self` is a struct gm_control_work. */
void gm_control_place(void *self, const double *state, double step);
void gm_control_guess(void *self, double *unknowns);
bool gm_control_residual(void *self, const double *unknowns, double *residual);
void gm_control_jacobian(void *self, const double *unknowns, struct gm_banded *matrix);

#endif
