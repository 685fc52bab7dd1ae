/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_COEFFICIENTS_H
#define GM_CORE_THEORY_COEFFICIENTS_H

#include "core/theory/ball.h"

/* The coefficients of a Runge-Kutta method, plain or partitioned, for y' = f(y) or (q, p)' = (f_q, f_p):
       Y_i = y0 + h sum_j a_ij f(Y_j)            Q_i = q0 + h sum_j a_ij f_q(Q_j, P_j),   P_i with c_ij
       y1  = y0 + h sum_i b_i  f(Y_i)            q1  = q0 + h sum_i b_i  f_q(Q_i, P_i),   p1  with d_i
   A splitting is one of the second form: each of its pieces is a stage. So is a Nystrom method of s stages,
   whose Q_i need the velocity at two more stages, at p0 and at p0 + h sum b_j F_j:
       V_i = p0 + h sum_j a_ij F(Q_j),   Q_i = q0 + h [(c_i - 1) f_q(p0) + f_q(V_i)],
   the weights d being bv. A step whose end is not at the time 1, as a part of another one, takes (e - 1)
   f_q(p0) besides f_q at its last stage. */

/* What the method is for; its order is that for all such systems. */
enum gm_equations {
    GM_EQUATIONS_PLAIN,       /* y' = f(y) */
    GM_EQUATIONS_PARTITIONED, /* (q, p)' = (f_q(q, p), f_p(q, p)) */
    GM_EQUATIONS_SEPARABLE,   /* (f_q(p), f_p(q)) */
    GM_EQUATIONS_NYSTROM,     /* (f_q(p), f_p(q)) with f_q linear */
};

/* The first side is that of q, or all there is. */
enum { GM_SIDE_Q, GM_SIDE_P, GM_SIDES };

struct gm_coefficients {
    enum gm_equations equations;
    int stages;
    int evaluations; /* of f, or of the force, in a step */
    int nystrom;     /* so many of the stages are those of a Nystrom method; 0: it is none */
    struct gm_ball *a[GM_SIDES], *b[GM_SIDES]; /* stages * stages by rows, stages; a[GM_SIDE_P]: c, d */
    /* The same, each with one of the decimals that they are made of moved by half a unit of its last digit: a
       decimal that occurs several times is one number, and doubts of one condition may cancel. None: balls
       say all. */
    struct gm_coefficients *moved;
    int moved_count;
};

/* All zeros. False: out of memory. */
bool gm_coefficients_open(struct gm_coefficients *coefficients, enum gm_equations equations, int stages);
/* Opens a copy. False: out of memory. */
bool gm_coefficients_copy(struct gm_coefficients *copy, const struct gm_coefficients *coefficients);
/* Those of a Nystrom method with a, b, bv and c as above, as said there. False: out of memory. */
bool gm_coefficients_open_nystrom(struct gm_coefficients *coefficients, int stages, const struct gm_ball *a,
                                  const struct gm_ball *b, const struct gm_ball *bv, const struct gm_ball *c);
/* Those of steps of these fractions, one after the other, of parts for the same equations, which all are
   Nystrom methods or none. False: out of memory. */
bool gm_coefficients_open_composition(struct gm_coefficients *composed, const struct gm_coefficients *parts,
                                      const struct gm_ball *fractions, int count);
/* Those of the adjoint, the inverse of the step backwards. False: out of memory. */
bool gm_coefficients_open_adjoint(struct gm_coefficients *adjoint, const struct gm_coefficients *exact);
/* The same plain method with no stage written twice, and none that nothing is made of (Hairer, Lubich & Wanner,
   VI.7.3); `evaluations` stays. What is left of other kinds is all. */
void gm_coefficients_reduce(struct gm_coefficients *coefficients);
void gm_coefficients_close(struct gm_coefficients *coefficients);

static inline int gm_coefficients_sides(const struct gm_coefficients *coefficients)
{
    return coefficients->equations == GM_EQUATIONS_PLAIN ? 1 : GM_SIDES;
}

#endif
