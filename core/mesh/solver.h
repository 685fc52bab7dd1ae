/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_SOLVER_H
#define GM_CORE_MESH_SOLVER_H

#include "core/mesh/nodes.h"
#include "core/scheme.h"

/* The steps of all schemes on meshes: the same number of unknowns at every node, node by node, so that
   matrices are banded. A strategy defines their equations.

   The LU factors are kept over iterations and steps until they converge too slowly. They are derived data:
   what they were made from (a state and unknowns) is part of the scheme's memory, so a run that is resumed
   recomputes the same factors and continues with the same bits. First guesses are extrapolated from the last
   six steps. */

struct gm_mesh_solver;

struct gm_mesh_strategy {
    enum gm_mesh_kind kind;
    const struct gm_mesh_strategy
        *relaxed;     /* instead of it where the mesh is smoothed in time; NULL: never */
    bool free;        /* nothing holds the mesh: the strategy's end has velocities, not momenta */
    bool multiplied;  /* multipliers hold the mesh: a slack and one less than stages at every node */
    size_t unknowns;  /* unknowns per node and stage */
    size_t projected; /* unknowns per node in gm_nodes_project */
    /* weight of a change of a node's unknown in the test of convergence; NULL: 1 */
    double (*weight)(size_t stages, size_t unknown, double step);
    /* the unknowns of a scheme that has no past */
    void (*guess)(const struct gm_mesh_solver *solver, double *unknowns);
    /* false: a cell is not positive */
    bool (*residual)(struct gm_mesh_solver *solver, const double *unknowns, double *residual);
    /* adds the derivative of the residual by the unknowns of one element, at the unknowns of its last call */
    void (*jacobian)(struct gm_mesh_solver *solver, const struct gm_assembly *assembly);
    /* The end of the step: the elements there, with the momenta at them in solver->motion; and the largest
       multiplier. NULL: the mesh is tangled. */
    struct gm_elements *(*end)(struct gm_mesh_solver *solver, double *multiplier);
};

/* Partitioned Runge-Kutta coefficients: a for places, abar for momenta, the same weights b
   (Hairer, Lubich & Wanner 2006, chapters II and IV; Hairer & Wanner 1996, IV.5). */
enum { GM_STAGES = 3 };
struct gm_mesh_tableau {
    size_t stages;
    bool stiffly_accurate; /* the last stage is the end of the step, for places */
    double a[GM_STAGES][GM_STAGES], abar[GM_STAGES][GM_STAGES], b[GM_STAGES];
};

extern const struct gm_mesh_tableau gm_tableau_gauss2, gm_tableau_gauss4, gm_tableau_lobatto2,
    gm_tableau_lobatto4, gm_tableau_radau3, gm_tableau_radau5;

/* A row of the families: a strategy, and the coefficients of its stages. */
struct gm_mesh_row {
    const struct gm_mesh_strategy *strategy;
    const struct gm_mesh_tableau *tableau; /* NULL: the strategy has its own, with one stage */
    double kappa[GM_STAGES];               /* a kappa = 0 */
    double left[GM_STAGES];                /* left^T abar = 0 */
};

/* The workspace. */
struct gm_mesh_solver {
    struct gm_mesh mesh;
    const struct gm_mesh_row *row;
    const struct gm_mesh_strategy *strategy;
    size_t stages, per_node;
    /* the current step: its time and length, its start, and the momenta there, y and X node by node */
    double t, h;
    const double *state;
    double *momenta;
    double *whole;           /* 4 N: the state of nodes alone with a field that is 0 */
    struct gm_elements ends; /* the start, then the end */
    struct gm_elements stage[GM_STAGES];
    struct gm_banded matrix, projection;
    struct gm_banded places; /* N, for the mesh at the end */
    double stamp;            /* identifies the factors; 0: none */
    double noise;            /* change of the unknowns that round-off alone makes */
    double weights[3 * GM_STAGES];
    double *unknowns, *residual, *trial;
    double *motion;                   /* at the end: momenta, then velocities */
    double *forces[GM_STAGES];        /* y and X, node by node */
    double *slack, *share[GM_STAGES]; /* arrays of elements, from unknowns at the nodes (gm_nodes_spread) */
};

/* The largest of these unknowns of a node, numbered from 0. */
double gm_mesh_largest(const struct gm_mesh_solver *solver, size_t unknown);

/* The functions that all families share. */
size_t gm_mesh_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_mesh_restart(const struct gm_task *task);
/* Makes steps, in place if task->out is task->y. */
struct gm_progress gm_mesh_loop(const struct gm_task *task);
void *gm_mesh_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_mesh_workspace_close(void *workspace);
void gm_mesh_workspace_reset(void *workspace);

#endif
