/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_MOVING_MESH_H
#define GM_CORE_MESH_MOVING_MESH_H

#include "core/kind.h"
#include "core/run.h"

/* The facet moving-mesh: a scalar field on [first, first + length] with the Lagrangian density
       phi_t^2 / 2 - phi_X^2 / 2 - W(phi),
   fixed at both ends, on linear elements whose nodes move so that a mesh density is equidistributed.
   Tyranowski & Desbrun (2019), sections 2, 3 and 5.

   Canonical state, n = 4 N components of one member, N = points between the ends: the field y_1 ... y_N at
   the nodes, the nodes' places X_1 ... X_N, and the velocities dy/dt (following the node) and dX/dt of both.
   Every strategy starts from it and ends every step with it, so a run may change its strategy. A state of a
   moving mesh meets the constraint, and its velocities the constraint's derivative; of a uniform mesh, X is
   uniform and dX/dt = 0. A scheme that receives a state of the other kind interpolates the field and its
   velocity phi_t = dy/dt - phi_X dX/dt onto a mesh of its own kind. */

struct gm_potential {
    const char *name;
    /* The means over n elements of W(phi) for phi linear with mean `middle` and difference `rise` of its
       ends: w and its derivatives by middle (m) and rise (r). */
    void (*first)(const struct gm_potential *potential, const double *middle, const double *rise, size_t n,
                  double *w, double *w_m, double *w_r);
    /* second derivatives of the same, of one element */
    void (*second)(const struct gm_potential *potential, double middle, double rise, double *w_mm,
                   double *w_mr, double *w_rr);
    /* dW/dphi and its two derivatives at one place */
    void (*force)(const struct gm_potential *potential, double phi, double force[3]);
};
extern const struct gm_potential gm_potential_sine_gordon; /* W = 1 - cos phi */
extern const struct gm_potential gm_potential_phi4;        /* W = (phi^2 - 1)^2 / 4 */

/* The mesh density that a mesh equidistributes: every element has the same
       ell = alpha^2 R + d^2 sqrt(1 + curvature^2 (W'(y0)^2 + W'(y1)^2) / 2),
   d its width, y0 and y1 the field at its ends, r its rise, and R = r^2 as a rule. alpha alone: generalised
   arclength (their eq. 28). curvature alone: the error of linear interpolation, as phi_XX is W'(phi) but for
   a factor in a travelling wave.

   The density is regularised, so that no wrinkle of the field makes cells that are too small for the step, by
       limited:   R = r^2 / (1 + w),                w = (r / (steepest d))^2,
       tempered:  R = 2 r^2 / (1 + sqrt(1 + w)):
   slopes above `steepest` draw hardly more nodes, or as their square root. Tempered, ell stays convex in r,
   which keeps the field smooth on strong densities; limited, the cells are bounded from below. */
enum gm_mesh_reach { GM_REACH_FULL, GM_REACH_LIMITED, GM_REACH_TEMPERED };

struct gm_mesh {
    size_t points;
    double first, length; /* left end and length */
    double left, right;   /* the field at both ends */
    double alpha, curvature;
    enum gm_mesh_reach reach;
    double steepest; /* a slope, unless reach is full */
    const struct gm_potential *potential;
};

/* The mesh density: arclength, the error of interpolation, half of each, or arclength regularised in one
   of two ways. */
enum gm_mesh_density { GM_ARCLENGTH, GM_CURVATURE, GM_MIX, GM_LIMITED, GM_TEMPERED };

/* Sets alpha, curvature, reach and steepest. `bend` times alpha^2 is the curvature with which the first two
   densities have the same greatest value; the regularised ones begin to be at the slope `steepest`. */
void gm_mesh_weigh(struct gm_mesh *mesh, enum gm_mesh_density density, double alpha, double steepest,
                   double bend);

/* A field and its rate of change in time: values, slopes and rates at `count` places x. */
typedef void gm_mesh_profile(const void *context, const double *x, size_t count, double *value, double *slope,
                             double *rate);

/* The facets of a problem on a moving mesh. */
struct gm_moving_mesh {
    /* the mesh for the problem's parameters */
    void (*describe)(const struct gm_problem *problem, struct gm_mesh *mesh);
    gm_mesh_profile *start; /* the start, from the problem's parameters */
    /* the exact solution for these parameters; NaN if it is not known */
    double (*exact)(const void *parameters, double x, double t);
};

extern const struct gm_kind gm_kind_mesh;

static inline const struct gm_moving_mesh *gm_moving_mesh_of(const struct gm_problem *problem)
{
    return problem->facets;
}

enum gm_mesh_kind { GM_MESH_UNIFORM, GM_MESH_MOVING };

/* The kind of mesh that a scheme of the mesh families works on. */
enum gm_mesh_kind gm_scheme_mesh(const struct gm_scheme *scheme);

/* Writes the canonical state of a profile on a mesh of that kind: nodes by continuation from the uniform
   mesh, velocities consistent with the constraint (their section 5.2). Returns false if no mesh was found,
   or when out of memory. */
bool gm_mesh_start(const struct gm_mesh *mesh, enum gm_mesh_kind kind, gm_mesh_profile *profile,
                   const void *context, double *state);

/* Carries a state onto a mesh of that kind; as it is if it is of that kind already. `state` and `out` may be
   the same. */
bool gm_mesh_carry(const struct gm_mesh *mesh, enum gm_mesh_kind kind, const double *state, double *out);

/* The discrete energy E_N (their eq. 169). */
double gm_mesh_energy(const struct gm_mesh *mesh, const double *state);
/* The largest |ell - ell of the neighbour| over the largest ell. */
double gm_mesh_constraint_defect(const struct gm_mesh *mesh, const double *state);
double gm_mesh_smallest_cell(const struct gm_mesh *mesh, const double *state);

/* The largest Lagrange multiplier of the run's last step (0: the scheme has none), and the number of
   matrices factored since the start. */
double gm_mesh_multiplier_norm(const struct gm_run *run);
double gm_mesh_factorisations(const struct gm_run *run);

#endif
