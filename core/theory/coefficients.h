/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_COEFFICIENTS_H
#define GM_CORE_THEORY_COEFFICIENTS_H

#include "core/theory/ball.h"

struct gm_arena;

/* The coefficients of a Runge-Kutta method, plain or partitioned, for y' = f(y) or (q, p)' = (f_q, f_p):
       Y_i = y0 + h sum_j a_ij f(Y_j)            Q_i = q0 + h sum_j a_ij f_q(Q_j, P_j),   P_i with c_ij
       y1  = y0 + h sum_i b_i  f(Y_i)            q1  = q0 + h sum_i b_i  f_q(Q_i, P_i),   p1  with d_i
   A splitting is one of the second form: each of its pieces is a stage. So is a Nystrom method of s stages,
   whose Q_i need the velocity at two more stages, at p0 and at p0 + h sum b_j F_j:
       V_i = p0 + h sum_j a_ij F(Q_j),   Q_i = q0 + h [(c_i - 1) f_q(p0) + f_q(V_i)],
   the weights d being bv. A step whose end is not at the time 1, as a part of another one, takes (e - 1)
   f_q(p0) besides f_q at its last stage. */

/* The systems that a method is made for; its order holds for all of them. Each kind includes the next. */
enum gm_equations {
    GM_EQUATIONS_PLAIN,       /* y' = f(y) */
    GM_EQUATIONS_PARTITIONED, /* (q, p)' = (f_q(q, p), f_p(q, p)) */
    GM_EQUATIONS_SEPARABLE,   /* (f_q(p), f_p(q)) */
    GM_EQUATIONS_NYSTROM,     /* (f_q(p), f_p(q)) with f_q linear */
};

/* The first side belongs to q; plain methods have no other side. */
enum { GM_SIDE_Q, GM_SIDE_P, GM_SIDES };

struct gm_coefficients {
    enum gm_equations equations;
    int stages;
    int evaluations; /* of f, or of the force, in a step */
    int nystrom;     /* number of stages of the Nystrom method; 0: another kind of method */
    struct gm_ball *a[GM_SIDES], *b[GM_SIDES]; /* stages * stages by rows, stages; a[GM_SIDE_P]: c, d */
    /* Copies, each with one of the typed decimals moved by half a unit of its last digit. A decimal that occurs
       several times is one number, so uncertainties of a condition may cancel. NULL: the radii of the balls are
       the only bounds. */
    struct gm_coefficients *moved;
    int moved_count;
};

/* The functions below take memory from an arena, in its body, which is left when out of memory. */

/* Opens coefficients that are all 0. */
void gm_coefficients_open(struct gm_arena *arena, struct gm_coefficients *coefficients,
                          enum gm_equations equations, int stages);
/* Writes the coefficients of a side from those of a table, a by rows of `stride` numbers. */
void gm_coefficients_write(struct gm_coefficients *coefficients, int side, const double *a, size_t stride,
                           const double *b);
/* Opens a copy. */
void gm_coefficients_copy(struct gm_arena *arena, struct gm_coefficients *copy,
                          const struct gm_coefficients *coefficients);
/* The coefficients of a Nystrom method by their names in the literature: stages * stages by rows, then stages each. */
struct gm_nystrom_balls {
    const struct gm_ball *a, *b, *bv, *c;
};
/* Opens the coefficients of a Nystrom method, in the form above. */
void gm_coefficients_open_nystrom(struct gm_arena *arena, struct gm_coefficients *coefficients, int stages,
                                  const struct gm_nystrom_balls *balls);
/* Opens the composition of steps with these fractions. The parts are first written for the equations that all
   of them are made for, as Nystrom methods if one is. */
void gm_coefficients_open_composition(struct gm_arena *arena, struct gm_coefficients *composed,
                                      struct gm_coefficients *parts, const struct gm_ball *fractions,
                                      int count);
/* Opens the adjoint, the inverse of the step backwards. */
void gm_coefficients_open_adjoint(struct gm_arena *arena, struct gm_coefficients *adjoint,
                                  const struct gm_coefficients *exact);
/* Removes the stages that occur twice or have no effect (Hairer, Lubich & Wanner, VI.7.3). `evaluations`
   stays. */
void gm_coefficients_reduce(struct gm_coefficients *coefficients);

static inline int gm_coefficients_sides(const struct gm_coefficients *coefficients)
{
    return coefficients->equations == GM_EQUATIONS_PLAIN ? 1 : GM_SIDES;
}

#endif
