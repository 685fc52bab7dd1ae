/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_MOVING_MESH_H
#define GM_CORE_MESH_MOVING_MESH_H

#include "core/kind.h"
#include "core/run.h"
#include "core/tape.h"

/* The facet moving-mesh: a scalar field on [first, first + length] with the Lagrangian density
       phi_t^2 / 2 - phi_X^2 / 2 - W(phi),
   fixed at both ends, on linear elements whose nodes move so that a mesh density is equidistributed.
   Tyranowski & Desbrun (2019), sections 2, 3 and 5.

   Canonical state, n = 4 N components of one member, N = points between the ends: the field y_1 ... y_N at
   the nodes, the nodes' places X_1 ... X_N, and the velocities dy/dt (following the node) and dX/dt of both.
   Every strategy starts from it and ends every step with it, so a run may change its strategy. A state of a
   moving mesh meets the constraint, and its velocities the constraint's derivative; of a uniform mesh, X is
   uniform and dX/dt = 0. A scheme that receives a state of the other kind interpolates the field and its
   velocity phi_t = dy/dt - phi_X dX/dt onto a mesh of its own kind.

   Nodes alone are a mesh whose field is 0: their state has the 2 N components X and dX/dt. */

struct gm_potential {
    const char *name;
    /* The means over n elements of W(phi) for phi linear with mean `middle` and difference `rise` of its
       ends: w and its derivatives by middle (m) and rise (r). */
    void (*first)(const struct gm_potential *potential, const double *middle, const double *rise, size_t n,
                  double *w, double *w_m, double *w_r);
    /* second derivatives of the same, of one element */
    void (*second)(const struct gm_potential *potential, double middle, double rise, double *w_mm,
                   double *w_mr, double *w_rr);
};
extern const struct gm_potential gm_potential_sine_gordon; /* W = 1 - cos phi */

/* The mesh density rho that a mesh equidistributes: every element has the same
       ell = d^2 (P(left end) + P(right end)) / 2,   P = rho^2,
   d its width, P a function of the slope s of the field in the element, and, if `local`, of the field u and the
   place x at the end. P = 1 + alpha^2 s^2: generalised arclength (their eq. 28). */
enum gm_density_value {
    GM_P,
    GM_P_S,
    GM_P_SS, /* the last without `local` */
    GM_P_U,
    GM_P_X,
    GM_P_SU,
    GM_P_SX,
    GM_P_UU,
    GM_P_UX,
    GM_P_XX,
    GM_DENSITY_VALUES,
    GM_DENSITY_OF_SLOPE = GM_P_SS + 1
};
struct gm_density {
    bool local;
    /* Writes P and its derivatives at m ends: `at` holds s, then u and x if `local`, [number * m + end], and so
       do the values. */
    void (*values)(const struct gm_density *density, const double *at, double *values, size_t m);
};

/* The Lagrangian of one cell, which is added to that of the field if nodes are free. It depends on the cell's width d,
   the rate d_t of the width, the velocity m_t of its middle, and its slope s, in this order. */
enum { GM_CELL_INPUTS = 4 };
struct gm_mesh_cell {
    struct gm_tape first;  /* the Lagrangian, and its derivatives by the four */
    struct gm_tape second; /* the second derivatives */
};

struct gm_mesh {
    size_t points;
    bool alone;           /* the nodes have no field */
    const double *listed; /* places of the nodes at the start; NULL: by the density */
    double first, length; /* left end and length */
    double left, right;   /* the field at both ends */
    double even;          /* the homotopy of the start has (1 - even) P + even instead of P; else 0 */
    const struct gm_density *density;
    double level; /* a power of 2: P is divided by it, as equations are solved best with numbers near 1 */
    const struct gm_mesh_cell *cell; /* NULL: none */
    double relax;                    /* T of a mesh that is smoothed in time; 0: it is not */
    double t;                        /* the time of states that are started or carried */
    /* of a label, which has equal distances from the next ones, and t: the node's place and velocity; NULL: nodes are
       at their labels */
    const struct gm_tape *map;
    const struct gm_tape *drift; /* of x: dX/dt of free nodes at the start; NULL: as the density moves */
    const struct gm_potential *potential;
};

/* The number of the first X in a state. */
static inline size_t gm_mesh_place(const struct gm_mesh *mesh)
{
    return mesh->alone ? 0 : mesh->points;
}

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

static inline struct gm_mesh gm_mesh_of_problem(const struct gm_problem *problem)
{
    struct gm_mesh mesh;
    gm_moving_mesh_of(problem)->describe(problem, &mesh);
    return mesh;
}

/* The mesh is uniform, known, equidistributes a density, or may be any; the last two start alike. */
enum gm_mesh_kind { GM_MESH_UNIFORM, GM_MESH_GIVEN, GM_MESH_MOVING, GM_MESH_FREE };

/* The kind of mesh that a scheme of the mesh families works on. */
enum gm_mesh_kind gm_scheme_mesh(const struct gm_scheme *scheme);

/* True if a scheme of the mesh families has a form that is smoothed in time. */
bool gm_scheme_relaxes(const struct gm_scheme *scheme);

/* Writes the canonical state of a profile on a mesh of that kind: nodes by continuation from the uniform
   mesh, velocities consistent with the constraint (their section 5.2). Returns false if no mesh was found,
   or when out of memory. */
bool gm_mesh_start(const struct gm_mesh *mesh, enum gm_mesh_kind kind, gm_mesh_profile *profile,
                   const void *context, double *state);

/* Carries a state onto a mesh of that kind; as it is if it is of that kind already. `state` and `out` may be
   the same. */
bool gm_mesh_carry(const struct gm_mesh *mesh, enum gm_mesh_kind kind, const double *state, double *out);

enum gm_mesh_measure {
    GM_MEASURE_ENERGY,      /* the discrete energy E_N (their eq. 169) */
    GM_MEASURE_MOMENTUM,    /* the sum of dL/d(dX/dt) over the nodes */
    GM_MEASURE_DEFECT,      /* the largest |ell - ell of the neighbour| over the largest ell */
    GM_MEASURE_STRAIGHTEST, /* the least difference of the slopes on both sides of a node */
    GM_MEASURE_NARROWEST,   /* the width of the smallest cell */
};
/* Measures a state; NaN where its cells are tangled, or when out of memory. */
double gm_mesh_measure(const struct gm_mesh *mesh, const double *state, enum gm_mesh_measure measure);
/* The energy alone. */
double gm_mesh_energy(const struct gm_mesh *mesh, const double *state);
/* Writes the mass matrix M of field and nodes, 2 N x 2 N, y and X node by node (their eqs. 47-48). Returns false above
   GM_DENSE_POINTS nodes, or when out of memory. */
enum { GM_DENSE_POINTS = 255 };
bool gm_mesh_mass_matrix(const struct gm_mesh *mesh, const double *state, double *matrix);
/* The rank of M, from eigenvalues whose size is above 1e-12 of the largest, and its condition, below 0 if M is not
   positive; or false as before. det M is a product of squared differences of slopes: every straight node takes 1 off the
   rank (their proposition 7). */
bool gm_mesh_mass(const struct gm_mesh *mesh, const double *state, double *rank, double *condition);

/* The largest Lagrange multiplier of the run's last step (0: the scheme has none), and the number of
   matrices factored since the start. */
double gm_mesh_multiplier_norm(const struct gm_run *run);
double gm_mesh_factorisations(const struct gm_run *run);

#endif
