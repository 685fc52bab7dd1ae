/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_MULTISYMPLECTIC_H
#define GM_CORE_FIELD_MULTISYMPLECTIC_H

#include "core/arena.h"
#include "core/field/field.h"

/* The law that a multisymplectic scheme for M s_t + K s_x = grad S(s), M and K skew, keeps for any two
   solutions a and b of the linearised scheme:
       D_t omega(a, b) + D_x kappa(a, b) = 0,   omega(a, b) = a' M b,   kappa(a, b) = a' K b
   with difference quotients of the scheme's own. T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184;
   S. Reich, J. Comput. Phys. 157 (2000) 473; B. Moore & S. Reich, Numer. Math. 95 (2003) 625. */

/* A tangent solution on the faces of a row of cells between two levels: on the lower and the upper face at
   the r stages of the scheme in space, [(cell * r + stage) * dimension + component], on the left side of
   every cell and the right one of the last at its s stages in time, [(side * s + stage) * dimension +
   component]. The box has one stage each: means of the corners. */
struct gm_faces {
    double *lower, *upper; /* points * r * dimension */
    double *sides;         /* (points + 1) * s * dimension */
};

/* Stages and weights (of sum 1) of such a scheme, and the sides of its cells. */
struct gm_lattice {
    size_t points, r, s;
    const double *space, *time;
    double dx, dt;
};

/* The subject of a law's measurement: a state, and trial steps from it. A measurement takes its memory
   from the arena, and leaves it when a step fails. */
struct gm_law {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    double dt;
    const double *y, *memory; /* the state, and the scheme's own memory, or NULL */
    bool by_differences;      /* tangents are differences of the scheme's own steps */
    struct gm_arena *arena;
    void *work; /* the scheme's workspace */
};

/* Opens the arena and the workspace for a measurement, and closes them. Returns false if it was left. */
bool gm_law_measure(struct gm_law *law, void (*measure)(const struct gm_law *law, void *data), void *data);

/* Makes steps from a state and a memory, both of which may be parts of the law; returns false if one
   fails. */
bool gm_law_step(const struct gm_law *law, int64_t steps, const double *y, const double *memory, double *out,
                 double *memory_out);

/* The derivative of a step along a tangent, by differences. `direction` and `slope` each hold a state,
   then a memory (NULL: none). Leaves the measurement when a step fails. */
void gm_law_differentiate(const struct gm_law *law, const double *y, const double *memory,
                          const double *direction, double *slope);

/* The same for schemes of two levels: along `count` arrays of points, the two of the state and, of 4, two of the memory,
   of which those in `to` that are not NULL receive the derivative. The levels of a two-step scheme are dt apart. */
void gm_law_differentiate_levels(const struct gm_law *law, size_t count, const double *const from[],
                                 const double *const along[], double *const to[]);

/* The largest |sum space_m D_t omega_m + sum time_j D_x kappa_j| of a cell; `advance` starts two tangents,
   makes a step, and fills in their faces. */
double gm_lattice_law(const struct gm_law *law, const struct gm_lattice *cells,
                      void (*advance)(const struct gm_law *law, struct gm_faces faces[2]));

/* Fills in a tangent at a node at the three levels n - 1, n, n + 1, [level * dimension + component]. */
typedef void gm_complete_node(const void *tangent, size_t node, double *s);

/* The largest residual of schemes of nodes: with M+ and K+ the upper triangles
       M+ D_t^+ s - M+' D_t^- s + K+ D_x^+ s - K+' D_x^- s = grad S(s)        (Euler box)
   or with `centred` the whole matrices and centred differences (midpoint). Tangents a and b on a ring; no
   dimension is above GM_LARGEST_FORM. */
enum { GM_LARGEST_FORM = 4 };
double gm_nodes_law(const struct gm_law *law, bool centred, gm_complete_node *complete, const void *a,
                    const void *b);

/* The residual of the scheme's multisymplectic law over the grid, with two tangent solutions that start from unit waves at
   the last levels of the state and make one step of the linearised scheme; the variables that elimination left out are found
   again from the scheme's equations. With tangents that are extrapolated differences of the scheme's own steps the law tests
   only the step itself; it is then accurate to about 1e-9. Needs no arena. NaN if a scheme lacks such a law, when out of
   memory or when the next step fails. */
double gm_form_residual(struct gm_law law);

/* The box of one stage, linearised at a solution whose means in the cells are these (gm_form.kept), for tangents of
   schemes that make the same steps with all but these components eliminated. In the law's arena, which it leaves where the
   equations are singular. */
struct gm_box_tangents *gm_box_linearise(const struct gm_law *law, const double *cells);
/* Fills in the faces of a step from a tangent at the nodes; with `next`, that of the scheme itself, to it. */
void gm_box_advance_tangent(struct gm_box_tangents *box, double dt, const double *now, const double *next,
                            struct gm_faces *faces);

/* The local laws of a field on the line: of what its flow carries along (mass, charge), of energy and of
   momentum,
       dF1/dt + dF2/dx = 0,   dG1/dt + dG2/dx = 0
   which follow from M s_t + K s_x = grad S(s) by the product with s_t and with s_x. */
enum gm_local_law { GM_LAW_OF_ENERGY, GM_LAW_OF_MOMENTUM, GM_LAW_OF_CONTENT };

/* Fills a component of a tangent at its start: cos(2 pi waves i / points + phase). */
void gm_tangent_start(double *tangent, size_t points, double waves, double phase);

#endif
