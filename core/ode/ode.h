/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets of ordinary differential equations: the structure that a problem may have, and a scheme may
   need. */
#ifndef GM_CORE_ODE_ODE_H
#define GM_CORE_ODE_ODE_H

#include <string.h>

#include "core/expression/graph.h"
#include "core/functions/instructions.h"
#include "core/kind.h"

struct gm_arena; /* core/arena.h */
struct gm_loops; /* core/ode/kernel/loops.h */

/* Ordinary differential equations y' = f(y) and the structure that they may have. All arrays are
   component-major, [component * m + member], for the m members passed. */

/* H(q, p) = T(p) + V(q), or q' = p, p' = g(q, t): exact flows of two parts; q are the first n / 2 components */
struct gm_split {
    bool nystrom;      /* T is quadratic */
    bool unit_mass;    /* q' = p: needs no evaluation */
    bool no_potential; /* the force has none that is known */
    bool attracts;     /* H at p = 0 is negative at the start */
};

/* q' = w dH/dp, p' = -w dH/dq with q the first n / 2 components and w = weight(problem) (NULL: 1). So the
   gradient of H is made of the field: dH/dq = -p' / w, dH/dp = q' / w. */
struct gm_hamiltonian {
    void (*energy)(const struct gm_problem *problem, const double *y, double *energy, size_t m);
    double (*weight)(const struct gm_problem *problem);
    /* `energy` is the first copy's if there are several copies, for example of tangent vectors */
    bool partial;
    /* Writes H as a formula in a graph opened for it, of the components alone, by number. Returns false when
       out of memory. NULL: H has no formula. */
    bool (*formula)(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *energy);
};

/* The values and derivatives of an action, half = n / 2 coordinates; matrices by rows, row i for entry i of
   momenta or forces. */
struct gm_motion {
    double *momenta, *forces;                            /* dL/dv, dL/dq + F: half */
    double *momenta_q, *momenta_v, *forces_q, *forces_v; /* over q and v: half * half */
};

/* A regular Lagrangian L(t, q, v) with forces F(t, q, v) and constraints g(q) = 0; the state is q, p = dL/dv
   and, if the equations hold the time, t as its last component. */
struct gm_action {
    /* Fills the motion at (q, v) or (q, v, t), n numbers. NULL: H = T(p) + V(t, q), T quadratic, and forces,
       so that all follows from the field and the Jacobian of `free`. */
    void (*motion)(const struct gm_problem *problem, const double *at, const struct gm_motion *motion);
    const struct gm_loops *free; /* the loops without constraints; NULL: the problem's */
    const double *friction;      /* its rate: F = -rate p; NULL: F has another form */
    size_t constraints;          /* number of constraints g; 0: none */
    /* writes g (constraints), G = dg/dq (constraints * half), and d(G' multipliers)/dq (half * half) */
    void (*constrain)(const struct gm_problem *problem, const double *q, const double *multipliers, double *g,
                      double *slopes, double *curvature);
};

/* x' = v, v' = g(x, t) + W(x, t) v with W antisymmetric, in two or three dimensions */
struct gm_magnetic {
    bool canonical; /* the state is (x, p), H = c |p - A(x, t)|^2/2 + phi(x, t); else (x, v) */
    double c;
    /* -c A at the place and time of a whole state: n / 2 */
    void (*drift)(const struct gm_problem *problem, const double *y, double *drift);
    /* g, and W by rows: n / 2 + (n / 2)^2 */
    void (*forces)(const struct gm_problem *problem, const double *y, double *forces);
};

/* L(q, v) = v^2/2 - V(q), one degree of freedom: values[0..2] = V, V', V'' at q */
struct gm_lagrangian {
    void (*potential)(const struct gm_problem *problem, double q, double values[3]);
};

/* H = |p|^2/2 + sum_i omega_i^2 q_i^2 / 2 + U(q): a stiff linear part that is solved exactly */
struct gm_fast_linear {
    /* omega_i of component i < n / 2; 0: slow */
    double (*frequency)(const struct gm_problem *problem, size_t i);
    /* -dU/dq (n/2 * m) */
    void (*slow_force)(const struct gm_problem *problem, const double *q, double *force, size_t m);
};

/* H = |p|^2/2 + V(q), V = -1/|q| + W(q) < 0 in the plane, (q1, q2, p1, p2) */
struct gm_kepler_split {
    /* V, and -dW/dq (2 * m) */
    void (*potential)(const struct gm_problem *problem, const double *q, double *potential, size_t m);
    void (*perturbing_force)(const struct gm_problem *problem, const double *q, double *force, size_t m);
};

/* H = sum |p_i|^2/(2 m_i) - sum G m_i m_j/|q_i - q_j| in 2 or 3 dimensions: the heaviest body, then the others by their
   distances from it at the start */
struct gm_gravity {
    size_t bodies, dimensions;
    size_t *places;        /* component of each coordinate, body by body; its momentum is n / 2 behind */
    double *masses, *sums; /* sums[i] = m_0 + ... + m_i */
    double G;
};

/* Q(y) > 0: the density of an adaptive scheme's steps, ds = Q dt */
struct gm_monitor {
    /* one member's Q; gradient: dQ/dy (n), or NULL */
    void (*density)(const struct gm_problem *problem, const double *y, double *density, double *gradient);
    bool of_places; /* Q holds the first n / 2 components alone */
};

/* y' = B(y) dH/dy, B skew: the bracket {y_i, y_j} = B_ij */
struct gm_poisson {
    /* one member's H, dH/dy (n), and B by rows (n * n) */
    double (*energy)(const struct gm_problem *problem, const double *y);
    void (*gradient)(const struct gm_problem *problem, const double *y, double *gradient);
    void (*bracket)(const struct gm_problem *problem, const double *y, double *matrix);
    /* s = +-1 if the bracket is that of angular momenta, y' = s y x dH/dy; or, with six components, of an
       angular momentum y and a vector z that it rotates, y' = s (y x dH/dy + z x dH/dz), z' = s z x dH/dy. 0:
       another bracket */
    double turning;
    size_t spins; /* number of angular momenta, in three lists of their components; 0: a top, or none */
    bool axes;    /* H is a sum of functions of one component of y each, and of one of z */
    /* The moments of inertia of a free body, H = sum y_i^2 / (2 moments_i); 0: not a free body. */
    double moments[3];
    /* H = H_1 + ..., each with an exact flow: y := the flow of piece number `piece` over h, one member, in
       place. 0: not known */
    size_t pieces;
    void (*flow)(const struct gm_problem *problem, size_t piece, double h, double *y);
};

/* L = theta(q) . q' - H(q): Omega q' = dH/dq, Omega_ij = d theta_j/d q_i - d theta_i/d q_j */
struct gm_degenerate {
    bool half_gauge; /* half of theta, or more, are 0 */
    /* At q, of one member: theta_1 .. theta_n and H (n + 1), their derivatives by rows ((n + 1) * n), and the matrix
       of second derivatives of their sum with these weights (n * n). theta is NaN when out of memory, which is noted. */
    void (*functions)(const struct gm_problem *problem, const double *q, const double *weights,
                      double *values, double *slopes, double *curvature);
};

/* f = f_0 + ... + f_(pieces - 1), each without divergence and with an exact flow */
struct gm_volume {
    size_t pieces;
    /* y := the exact flow of f_piece over h, in place */
    void (*flow)(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m);
};

/* y' = L y + N(y) of `fields` consecutive lists of equal length on a ring: L is the same at every point, so
   that it multiplies waves by matrices. */
struct gm_semilinear {
    size_t fields;
    /* L on the wave of number `mode` <= points / 2, exp(2 pi i mode j / points): fields * fields by rows */
    void (*symbol)(const struct gm_problem *problem, size_t mode, double _Complex *matrix);
    /* N(y) of one member */
    void (*nonlinear)(const struct gm_problem *problem, const double *y, double *rest);
};

/* Parts of the field that have names. */
struct gm_parts {
    const char *const *names; /* NULL-terminated: the file's own, then those of the structure */
    size_t given;             /* the number of the first */
    bool timed;               /* the last component is the time, which no part moves */
    /* These work in the arena's body, which is left when out of memory. */
    /* Writes the rates of a part as formulas of the components, n. Returns false if no part has this name. */
    bool (*rates)(struct gm_arena *arena, const struct gm_problem *problem, const char *name,
                  struct gm_formula *graph, gm_node_id *rates);
    /* Returns NULL if these parts sum to the field, else the reason in words. */
    const char *(*differ)(struct gm_arena *arena, const struct gm_problem *problem, const char *const *names,
                          size_t count);
};

/* The facets of a system. For a constant n, `loops` has loops over the problem's kernels. For an n chosen at
   run time (vortices) it has none, and a family steps through gm_field if it can. */
enum gm_ode_facet {
    GM_NEEDS_SPLIT = 1u << 0,
    GM_NEEDS_HAMILTONIAN = 1u << 1,
    GM_NEEDS_LAGRANGIAN = 1u << 2,
    GM_NEEDS_FAST_LINEAR = 1u << 3,
    GM_NEEDS_KEPLER_SPLIT = 1u << 4,
    GM_NEEDS_VOLUME = 1u << 5,
    GM_NEEDS_QUADRATIC = 1u << 6,    /* the field is quadratic */
    GM_NEEDS_NYSTROM = 1u << 7,      /* a split whose kinetic energy is quadratic */
    GM_NEEDS_INSEPARABLE = 1u << 8,  /* a hamiltonian without a split */
    GM_NEEDS_ENERGY = 1u << 9,       /* a hamiltonian whose energy generates the whole field */
    GM_NEEDS_ACTION = 1u << 10,      /* an action without constraints, or a Hamiltonian that makes one */
    GM_NEEDS_CONSTRAINTS = 1u << 11, /* an action with constraints */
    GM_NEEDS_FRICTION = 1u << 12,    /* forces -rate p and no others */
    GM_NEEDS_MONITOR = 1u << 13,
    GM_NEEDS_POISSON = 1u << 14,
    GM_NEEDS_ROTATIONS = 1u << 15, /* the bracket of angular momenta alone */
    GM_NEEDS_AXES = 1u << 16,      /* one angular momentum, or with a vector; H is a sum over the axes */
    GM_NEEDS_FREE_BODY = 1u << 17,
    GM_NEEDS_SEMILINEAR = 1u << 18,
    GM_NEEDS_GROUP = 1u << 19,      /* the bracket of angular momenta alone, or with a vector */
    GM_NEEDS_PIECES = 1u << 20,     /* a bracket, and an energy in pieces that have exact flows */
    GM_NEEDS_ATTRACTION = 1u << 21, /* a split and an energy, V(q) < 0 */
    GM_NEEDS_JACOBIAN = 1u << 22,   /* the matrix of derivatives of the field is written out */
    GM_NEEDS_MAGNETIC = 1u << 23,
    GM_NEEDS_PARTS = 1u << 24,   /* parts with names */
    GM_NEEDS_UNNAMED = 1u << 25, /* no part of the system's own that is named kinetic or potential */
    GM_NEEDS_KEPLER = 1u << 26,  /* a Kepler split, or gravity: parts kepler and interaction */
    GM_NEEDS_DEGENERATE = 1u << 27,
};
struct gm_ode {
    /* The names of the components, "q1 q2 p1 p2", or of lists of equal length, "x[] y[]"; NULL: "y[]". */
    const char *components;
    const bool *angles; /* [n] components that count modulo 2 pi; NULL: none */
    bool energy_jumps;  /* H does where a switch turns, and the rates have no force for that */
    bool stiff;         /* implicit equations are solved by Newton's method from the first iteration on */
    bool quadratic;     /* f is a polynomial of degree 2 */
    bool linear;        /* f is of degree 1, with coefficients that do not depend on the time */
    bool rough;         /* f is not smooth: no order can be measured */
    bool written;       /* the system is user-defined (core/ode/user/problem.h) */
    bool forms;         /* the state is of discrete forms (core/ode/user/forms.h) */
    bool forced;        /* a force acts beside the energy's field */
    const struct gm_split *split; /* NULL: the problem has no such facet; so below */
    const struct gm_hamiltonian *hamiltonian;
    const struct gm_lagrangian *lagrangian;
    const struct gm_action *action; /* NULL: a quadratic T(p) makes one (core/ode/variational/action.h) */
    const struct gm_fast_linear *fast_linear;
    const struct gm_kepler_split *kepler_split;
    const struct gm_gravity *gravity;
    const struct gm_volume *volume;
    const struct gm_magnetic *magnetic;
    const struct gm_monitor *monitor;
    const struct gm_poisson *poisson;
    const struct gm_degenerate *degenerate;
    const struct gm_semilinear *semilinear;
    const struct gm_parts *parts;
    /* Writes the quantity of that name, which the motion conserves, in a graph opened for it, of the components by
       number. Returns GM_NO_NODE with what the problem lacks, worded like a facet, "" when out of memory, in
       GM_FAULT_SENTENCE bytes. NULL: there are no names but H. */
    gm_node_id (*conserved)(const struct gm_problem *problem, const char *name, struct gm_formula *graph,
                            char *lacks);
    /* Makes the parts that schemes with these needs (GM_NEEDS_...) use and that are otherwise made at first
       use; NULL: nothing to make. */
    void (*prepare)(const struct gm_problem *problem, unsigned needs);
    /* made of the problem's kernels by core/ode/compiled/over_kernels.c */
    const struct gm_loops *loops[GM_ISA_COUNT];
};

extern const struct gm_kind gm_kind_ode;

static inline const struct gm_ode *gm_ode_of(const struct gm_problem *problem)
{
    return problem->facets;
}

/* Returns true if the last component is the time: neighbouring orbits have the same. */
static inline bool gm_has_time(const struct gm_problem *problem)
{
    const char *names = gm_ode_of(problem)->components, *last = names ? strrchr(names, ' ') : NULL;
    return last && strcmp(last, " t") == 0;
}

/* The weight w of its Hamiltonian. */
static inline double gm_weight_of(const struct gm_problem *problem)
{
    const struct gm_hamiltonian *hamiltonian = gm_ode_of(problem)->hamiltonian;
    return hamiltonian->weight ? hamiltonian->weight(problem) : 1;
}

#endif
