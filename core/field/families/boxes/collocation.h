/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step of Gauss-Legendre collocation in space and time for any M s_t + K s_x = grad S(s) whose state is s,
   or u of a wave's s = (u, v, w). */
#ifndef GM_CORE_FIELD_FAMILIES_BOXES_COLLOCATION_H
#define GM_CORE_FIELD_FAMILIES_BOXES_COLLOCATION_H

#include "core/arena.h"
#include "core/field/multisymplectic.h"
#include "core/linear/fourier.h"
#include "core/linear/ring/blocks.h"
#include "core/linear/ring/ring.h"

enum { GM_COLLOCATION_STAGES = 3, GM_COLLOCATION_PAST = 3 };

struct gm_collocation_tableau {
    size_t r;
    double a[GM_COLLOCATION_STAGES][GM_COLLOCATION_STAGES], b[GM_COLLOCATION_STAGES],
        c[GM_COLLOCATION_STAGES];
};

/* The factors of linear equations of a step: the equations of a cell solved for its stages, and the
   equations between the sides of cells. All cells share them if the coefficients are constant. */
struct gm_collocation_factors {
    double *cells;  /* [cell][row][column], rows and columns of a cell */
    size_t *pivots; /* [cell][column] */
    double *scales; /* [cell][row]: factor of the equations of sides, whose entries are then at most 1 */
    struct gm_ring_band sides;
    bool opened, shared, good; /* shared: one set of factors serves all cells */
    bool recursive;            /* the sides are solved by recursions, with `blocks` */
    struct gm_ring_blocks blocks;
};

/* The workspace. Every `points` numbers of an array hold one quantity in all cells. */
struct gm_collocation {
    const struct gm_problem *problem;
    const struct gm_collocation_tableau *tableau;
    size_t points, d, r, rank;    /* rank: of K */
    size_t state;                 /* components that the state has at the nodes: all, or u of a wave */
    size_t stages, sides;         /* numbers of a cell: d r r and r rank */
    double jump[GM_MOST_OF_FORM]; /* s(x + the ring) - s(x) */
    double basis[GM_MOST_OF_FORM]
                [GM_MOST_OF_FORM]; /* [component][k], k < rank: of the range of K, orthonormal */
    double slopes[GM_MOST_OF_FORM][GM_MOST_OF_FORM];                  /* K basis */
    size_t held[GM_MOST_OF_FORM * GM_COLLOCATION_STAGES], held_count; /* sides of potentials */
    double inverse[GM_COLLOCATION_STAGES][GM_COLLOCATION_STAGES],
        sums[GM_COLLOCATION_STAGES];             /* A^-1, A^-1 1 */
    double weights[GM_COLLOCATION_STAGES], rest; /* b' A^-1, and 1 - b' A^-1 1 */
    double *low, *high; /* s at the stages of the cells, before and after a step: [component][space stage] */
    double *z;          /* s at all stages: [component][time stage][space stage] */
    double *y;          /* basis' s at the left sides of the cells: [time stage][k] */
    double *past_z[GM_COLLOCATION_PAST],
        *past_y[GM_COLLOCATION_PAST]; /* z and y of previous steps, the last one first */
    double *first_z, *first_y;        /* z and y at the start of an iteration */
    double *gradient, *hessian;       /* [component][stage]; [row][column][stage] */
    double *right;                    /* [row]: what is left of the equations of a cell, then what changes */
    double _Complex *waves;           /* r * points */
    struct gm_fourier *fourier;
    struct gm_collocation_factors constant, newton; /* S'' at s = 0; at z */
    double constant_dt;                             /* 0: `constant` is not made */
    bool needs_newton;      /* `constant` did not serve a step; for steps of their own memory */
    double *scratch;        /* [side], and two more */
    struct gm_arena *arena; /* owner of all arrays */
};

/* Opens a workspace for gm_family; returns NULL when out of memory. */
void *gm_collocation_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_collocation_close(void *workspace);

/* One step from `low` to `high`, with the guess in z and y, which become the solution. GM_NO_CONVERGENCE. */
enum gm_status gm_collocation_step(struct gm_collocation *work, double dt, struct gm_progress *progress);

/* Linearises the equations at z, for steps of tangents from `low` to `high`, z and y. Returns false if
   they are singular, or when out of memory. */
bool gm_collocation_linearise(struct gm_collocation *work, double dt);
void gm_collocation_tangent(struct gm_collocation *work, double dt);
/* Fills in the faces of a step of tangents. */
void gm_collocation_faces(const struct gm_collocation *work, struct gm_faces *faces);

/* grad S at `count` points, [component * count + point]. */
void gm_collocation_gradients(const struct gm_collocation *work, const double *s, double *gradient,
                              size_t count);

/* The components of the state. Values at the nodes, [component * points + node], to those at the stages of
   cells, or to their second derivatives there, where a cell has several; and back. */
void gm_collocation_to_stages(struct gm_collocation *work, const double *nodes, bool second, double *stages);
void gm_collocation_to_nodes(struct gm_collocation *work, const double *stages, double *nodes);
/* The slopes of values at the stages, there. */
void gm_collocation_slopes(struct gm_collocation *work, const double *stages, double *slopes);
/* basis' s at the nodes, as a guess of y. */
void gm_collocation_guess_sides(struct gm_collocation *work, const double *nodes);

#endif
