/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of a step on a mesh, the workspace that they share with Newton's method (core/mesh/solver.c), and steps. */
#ifndef GM_CORE_MESH_EQUATIONS_H
#define GM_CORE_MESH_EQUATIONS_H

#include "core/mesh/nodes.h"
#include "core/scheme.h"

/* Partitioned Runge-Kutta coefficients: a for places, abar for momenta, the same weights b
   (Hairer, Lubich & Wanner 2006, chapters II and IV; Hairer & Wanner 1996, IV.5). */
enum { GM_STAGES = 3 };
struct gm_mesh_tableau {
    size_t stages;
    bool stiffly_accurate; /* the last stage is the end of the step, for places */
    double a[GM_STAGES][GM_STAGES], abar[GM_STAGES][GM_STAGES], b[GM_STAGES];
    double kappa[GM_STAGES]; /* a kappa = 0 */
    double left[GM_STAGES];  /* left^T abar = 0 */
};

extern const struct gm_mesh_tableau gm_tableau_gauss2, gm_tableau_gauss4, gm_tableau_lobatto2,
    gm_tableau_lobatto4, gm_tableau_radau3, gm_tableau_radau5;

/* A row of the families. */
struct gm_mesh_row {
    enum gm_mesh_kind kind;
    const struct gm_mesh_tableau *tableau;
    bool multiplied;   /* multipliers hold the mesh */
    bool one_velocity; /* the same at all stages, whose rows are added up */
};

/* The unknowns of a node, which has as many rows: at each stage dy/dt, then X of a mesh that is held, then dX/dt unless
   it is known; and behind all stages, of multipliers, the slack W and Lambda_1 .. Lambda_(s-1). */
struct gm_mesh_layout {
    size_t per_stage, per_node;
    size_t stride;            /* from the unknowns of a stage to those of the next; 0: all have the same */
    size_t slack, multiplier; /* the numbers of W and of Lambda_1; 0: no multipliers */
    bool held, drifts;        /* X is an unknown; or follows from dX/dt, as y from dy/dt */
    bool smoothed, pushed;    /* pushed: X has momenta, as y */
    bool constrained;         /* the density takes part */
    size_t projected;         /* unknowns per node of velocities at the end */
};

/* The workspace. */
struct gm_mesh_solver {
    struct gm_mesh mesh;
    const struct gm_mesh_row *row;
    enum gm_mesh_kind kind; /* the row has it; free if it is smoothed in time */
    struct gm_mesh_layout of;
    size_t stages;
    /* the current step: its time and length, its start, and the momenta there, then at the end, y and X node by node */
    double t, h;
    const double *state;
    double *momenta;
    double *whole;           /* 4 N: the state of nodes alone with a field that is 0 */
    struct gm_elements ends; /* the start, then the end */
    struct gm_elements stage[GM_STAGES];
    struct gm_banded matrix, projection;
    struct gm_banded places;       /* N, for the mesh at the end */
    double stamp;                  /* identifies the factors; 0: none */
    double noise;                  /* change of the unknowns that round-off alone makes */
    double weights[3 * GM_STAGES]; /* of changes of a node's unknowns, in the test of convergence */
    double *unknowns, *residual, *trial;
    double *motion;                   /* 3 N */
    double *forces[GM_STAGES];        /* y and X, node by node */
    double *slack, *share[GM_STAGES]; /* arrays of elements, from unknowns at the nodes (gm_nodes_spread) */
};

struct gm_mesh_layout gm_mesh_layout_of(const struct gm_mesh_row *row, const struct gm_mesh *mesh);
/* Takes the state that a step of this length starts from at time t. */
void gm_step_place(struct gm_mesh_solver *solver, const double *state, double t, double h);
/* Writes the unknowns of a scheme that has no past. */
void gm_step_guess(const struct gm_mesh_solver *solver, double *unknowns);
/* Writes solver->residual at these unknowns. False: a cell is not positive. */
bool gm_step_residual(struct gm_mesh_solver *solver, const double *unknowns);
/* Adds the derivative of the residual by the unknowns of one element, at the unknowns of its last call. */
void gm_step_matrix(struct gm_mesh_solver *solver, const struct gm_assembly *assembly);
/* Finds the start's own velocities on a mesh that is smoothed in time, dX/dt = g/E and dy/dt by its momenta, in
   solver->ends; after gm_step_place. False: a cell is not positive. */
bool gm_step_begin(struct gm_mesh_solver *solver);
/* Finds the end of the step from its solved stages, in solver->ends, and the largest multiplier. */
enum gm_status gm_step_end(struct gm_mesh_solver *solver, double *multiplier);

/* The steps of all schemes on meshes: the same number of unknowns at every node, node by node, so that
   matrices are banded.

   The LU factors are kept over iterations and steps until they converge too slowly. They are derived data:
   what they were made from (a state and unknowns) is part of the scheme's memory, so a run that is resumed
   recomputes the same factors and continues with the same bits. First guesses are extrapolated from the last
   six steps. */

/* The functions that all families share. */
const char *gm_mesh_lacks(const struct gm_scheme *scheme, const struct gm_problem *problem);
size_t gm_mesh_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_mesh_restart(const struct gm_task *task);
/* Makes steps, in place if task->out is task->y. */
struct gm_progress gm_mesh_loop(const struct gm_task *task);
void *gm_mesh_workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_mesh_workspace_close(void *workspace);
void gm_mesh_workspace_reset(void *workspace);

#endif
