/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_BOXES_MODES_H
#define GM_CORE_FIELD_FAMILIES_BOXES_MODES_H

#include "core/field/families/boxes/collocation.h"

/* Gauss-Legendre collocation on a ring by Fourier modes: a step of the scheme (gauss.c) and of a
   tangent. Values at the stages are [stage * points + cell]. */

#define GM_ROOT3 1.7320508075688772935

enum { GM_GAUSS_STAGES = 2 };

/* A branch of a mode: stage values vector * amplitude, |vector| = 1. */
struct gm_gauss_branch {
    double frequency; /* INFINITY: it is 0 */
    double _Complex vector[GM_GAUSS_STAGES];
    double inverse[GM_GAUSS_STAGES][GM_GAUSS_STAGES]; /* (1 + dt^2 frequency^2 A^2)^-1 */
};

struct gm_gauss_work {
    size_t points;
    const struct gm_collocation_tableau *tableau; /* the same in space and time */
    double dt;                                    /* what the branches were made for */
    struct gm_gauss_branch *branches;             /* [mode * r], modes 0 .. points/2 */
    struct gm_fourier *fourier;
    double *u, *v, *next_u, *next_v;      /* [stage * points + cell] */
    double *stages, *force;               /* [(time stage * r + stage) * points + cell] */
    double _Complex *hat_u, *hat_v, *hat; /* transforms of u, v, and of force or u'' */
    double *memory;
};

/* As the family's workspace; NULL when memory is short. */
void *gm_gauss_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_gauss_close(void *workspace);

/* The transform of a value a cell, and back; that is left as the values. */
void gm_gauss_forward(struct gm_gauss_work *work, const double *values, double _Complex *hat);
void gm_gauss_backward(struct gm_gauss_work *work, double _Complex *hat, double *values);

/* The angle of z for a mode, in (-pi, pi]. */
double gm_gauss_angle(size_t mode, size_t points);

/* Makes the branches for a step dt, unless they are made. */
void gm_gauss_prepare(struct gm_gauss_work *work, double dx, double dt);

/* The amplitude of a branch in the transforms of stage values, r arrays of `points`. */
double _Complex gm_gauss_amplitude(const struct gm_gauss_branch *branch, size_t r, size_t points, size_t mode,
                                   const double _Complex *hat);

/* u - jump x / length is periodic; that of stage m of cell i, of its node for m = r. */
double gm_gauss_slant(const struct gm_grid1 *grid, const struct gm_collocation_tableau *tableau, size_t m,
                      size_t i);

/* V' at all stages; of a tangent, V'' at those of the solution times the tangent. */
void gm_gauss_forces(struct gm_gauss_work *work, const struct gm_problem *problem, const double *curvature);

/* One step from u, v to next_u, next_v, which leaves u at the stages in time as well; with the `curvature`
   V'' at the stages that of a tangent. GM_NO_CONVERGENCE, GM_BLOW_UP. */
enum gm_status gm_gauss_step(struct gm_gauss_work *work, const struct gm_problem *problem, double dt,
                             const double *curvature, struct gm_progress *progress);

/* Values at the nodes from those at the stages. */
void gm_gauss_to_nodes(struct gm_gauss_work *work, const struct gm_grid1 *grid, const double *stages,
                       double *nodes);

/* Values at the stages from those at the nodes, and with `second` their second derivatives in space. */
void gm_gauss_to_stages(struct gm_gauss_work *work, const struct gm_grid1 *grid, const double *nodes,
                        double *stages, double *second);

/* Takes out the branch without a derivative of two stages: both get the same mean over the ring. */
void gm_gauss_share_mean(double *stages, size_t points);

#endif
