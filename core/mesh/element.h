/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_ELEMENT_H
#define GM_CORE_MESH_ELEMENT_H

#include "core/mesh/moving_mesh.h"

/* The element Lagrangian and the mesh constraint with their derivatives, for all elements of one stage.

   Element e joins nodes e and e + 1, 0 <= e <= N; rise r = y1 - y0, width d = X1 - X0, slope g = r / d,
   middle m = (y0 + y1) / 2. With u, V the velocities of y, X at the ends
       l   = (d Kuu - r KuV + (r^2 / d) KVV) / 6 - r^2 / (2 d) - d w(m, r)
       Kuu = u0^2 + u0 u1 + u1^2
       KuV = 2 u0 V0 + u0 V1 + u1 V0 + 2 u1 V1
       KVV = V0^2 + V0 V1 + V1^2
   (Tyranowski & Desbrun 2019, eq. 44), w the mean of the potential; and the constraint's ell, with the
   density's square P at both ends (struct gm_density),
       ell         = d^2 (P0 + P1) / 2
       d ell / dr  = d S                       S = (dP0/dg + dP1/dg) / 2
       d ell / dd  = d (P0 + P1) - d g S
   and, where P depends on the field or the place, d ell / dy0 = d^2 (dP0/dy) / 2 and its like besides.
   Multipliers enter element by element:
       sum_k lambda_k (ell_k - ell_{k-1}) = sum_e (lambda_e - lambda_{e+1}) ell_e
       lambda_0 = lambda_{N+1} = 0 */

struct gm_elements {
    size_t count; /* N + 1 */
    double *memory;
    double *y, *x, *u, *v; /* at the nodes, N + 2 each, ends included */
    /* at the elements */
    double *middle, *rise, *width, *slope, *w, *w_m, *w_r;
    double *force_y0, *force_y1;       /* dl/dy at both ends */
    double *force_d;                   /* dl/dX1 = -dl/dX0 */
    double *momentum_u0, *momentum_u1; /* dl/du; dl/dV is -slope times them */
    double *ell, *rate;                /* ell, and its rate: the gradient times the velocity */
    double *gradient[4], *bend[4]; /* the gradient of ell by z = (y0, X0, y1, X1), its Hessian times zdot */
    double *cells;                 /* of gm_mesh_cell: what they depend on, then values; NULL: no cells */
    double *cell_v0, *cell_v1;     /* their momenta dLC/dV at both ends */
    double *ends, *density;        /* what a density depends on, and its values (struct gm_density) */
};

/* Derivatives of one element by z = (y0, X0, y1, X1) and zdot, [row][column]. */
struct gm_element_matrices {
    double mass[4][4];    /* d2l / dzdot dzdot */
    double mixed[4][4];   /* d2l / dzdot dz */
    double stiff[4][4];   /* d2l / dz dz */
    double hessian[4][4]; /* d2 ell / dz dz */
    double gradient[4];   /* gradient of ell */
    double bend[4];       /* hessian zdot */
};

/* Returns false when out of memory. Sets the ends' places and values, which never change. */
bool gm_elements_open(struct gm_elements *stage, const struct gm_mesh *mesh);
void gm_elements_close(struct gm_elements *stage);

/* Fills the nodes from a canonical state. */
void gm_elements_place(struct gm_elements *stage, const double *state);

/* Opens the elements of a problem's state, which nodes alone have half of, and evaluates them. Returns false if it
   cannot; the caller closes them in both cases. */
bool gm_elements_open_at(struct gm_elements *stage, const struct gm_mesh *mesh, const double *state);

/* Computes places and velocities of labels on a mesh with a map. */
void gm_mesh_places(const struct gm_mesh *mesh, const double *label, size_t count, double t, double *x,
                    double *rate);
/* Sets the places and velocities of the nodes at time t on a mesh that is uniform or known; else nothing. */
void gm_mesh_known(const struct gm_mesh *mesh, enum gm_mesh_kind kind, double t, struct gm_elements *stage);

/* Computes geometry, forces and momenta from the nodes. Returns false if a width is not positive (the mesh
   is tangled) or a value is not finite; the rest is void then. */
bool gm_elements_evaluate(struct gm_elements *stage, const struct gm_mesh *mesh);
/* Computes ell and its derivatives. */
void gm_elements_constrain(struct gm_elements *stage, const struct gm_mesh *mesh);

/* Both only at the places y, X: true if all widths are positive. */
bool gm_elements_measure(struct gm_elements *stage, const struct gm_mesh *mesh);

/* After gm_elements_evaluate and, if `constrained`, gm_elements_constrain. */
void gm_elements_matrices(const struct gm_elements *stage, const struct gm_mesh *mesh, size_t element,
                          bool constrained, struct gm_element_matrices *matrices);

/* The mass matrix alone. */
void gm_elements_mass(const struct gm_elements *stage, size_t element, double mass[4][4]);

/* Momenta at node k = 1 ... N. */
static inline double gm_momentum_u(const struct gm_elements *stage, size_t k)
{
    return stage->momentum_u1[k - 1] + stage->momentum_u0[k];
}

static inline double gm_momentum_v(const struct gm_elements *stage, size_t k)
{
    return -(stage->slope[k - 1] * stage->momentum_u1[k - 1] + stage->slope[k] * stage->momentum_u0[k]) +
           (stage->cells ? stage->cell_v1[k - 1] + stage->cell_v0[k] : 0);
}

#endif
