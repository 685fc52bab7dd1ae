/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_PROBLEM_H
#define GM_CORE_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>

#include "core/field.h"
#include "core/status.h"

struct gm_loops;
struct gm_scheme;
struct gm_settings;
struct gm_problem;
struct gm_burgers;
struct gm_dispersive;
struct gm_kdv;
struct gm_nls;
struct gm_moving_mesh; /* core/moving_mesh.h */
struct gm_flow;

/* Instruction sets that loops are compiled for. */
enum gm_isa { GM_ISA_BASELINE, GM_ISA_AVX2, GM_ISA_AVX512, GM_ISA_COUNT };

/* The families of schemes; the list is core/schemes.def. */
enum gm_family_id {
#define GM_FAMILY(name) GM_FAMILY_##name,
#include "core/schemes.def"
#undef GM_FAMILY
    GM_FAMILY_COUNT
};

/* What a family's loop is asked to do: `steps` steps of length dt for every member, reading `y` and writing
   `out` (both n * m, component-major; they do not overlap). Problems are autonomous. */
struct gm_task {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    double dt;
    long steps;
    long steps_before; /* that the run has made already */
    double limit;      /* a component above this is a blow-up */
    const double *y;
    double *out;
    const double *carry; /* what compensated summation carries over, n * m; NULL: plain summation */
    double *carry_out;
    const double *memory; /* the scheme's own, as its family says; NULL if it has none */
    double *memory_out;
    double t; /* the present time, t0 + n dt of this segment */
    double t0;
    long n;
    void *workspace; /* what the family opened for this run */
    const struct gm_settings *settings;
};

/* What it did. `done` steps succeeded for every member; if that is less than task.steps, `out` is
   void and `status` says why step done + 1 failed. Counts are sums over the members. */
struct gm_progress {
    long done;
    enum gm_status status;
    unsigned long evaluations, solves, iterations;
    unsigned long
        failed_iterations; /* of the step that was not solved, where they are not among the others */
    double t;              /* the time reached, of schemes that choose their own step */
};

typedef struct gm_progress gm_loop(const struct gm_task *task);

/* Facets: the structure a problem has. A NULL facet means that it has none of that kind.
   All arrays are component-major, [component * m + member], for the m members passed. */

/* y' = f(y), evaluated by gm_field (core/kernel/loops.h), its Jacobian by loops[...]->jacobian */
struct gm_ode {
    bool stiff;     /* implicit equations are solved by Newton's method from the first iteration on */
    bool quadratic; /* f is a polynomial of degree 2 */
};

/* H(q, p) = T(p) + V(q): exact flows of two parts; q are the first n / 2 components */
struct gm_split {
    bool nystrom; /* T is quadratic */
};

/* q' = w dH/dp, p' = -w dH/dq with q the first n / 2 components and w = weight(problem) (NULL: 1). So the
   gradient of H is made of the field: dH/dq = -p' / w, dH/dp = q' / w. */
struct gm_hamiltonian {
    void (*energy)(const struct gm_problem *problem, const double *y, double *energy, size_t m);
    double (*weight)(const struct gm_problem *problem);
    bool partial; /* `energy` is that of the first of several copies, as where tangent vectors are carried
                     along */
};

/* L(q, v) = v^2/2 - V(q), one degree of freedom: values[0..2] = V, V', V'' at q */
struct gm_lagrangian {
    void (*potential)(const struct gm_problem *problem, double q, double values[3]);
};

/* H = |p|^2/2 + sum_i omega_i^2 q_i^2 / 2 + U(q): a stiff linear part that is solved exactly */
struct gm_fast_linear {
    double (*frequency)(const struct gm_problem *problem,
                        size_t i); /* omega_i of component i < n / 2; 0: slow */
    /* -dU/dq (n/2 * m) */
    void (*slow_force)(const struct gm_problem *problem, const double *q, double *force, size_t m);
};

/* H = |p|^2/2 + V(q), V = -1/|q| + W(q) < 0 in the plane, (q1, q2, p1, p2) */
struct gm_kepler_split {
    void (*potential)(const struct gm_problem *problem, const double *q, double *potential, size_t m); /* V */
    void (*perturbing_force)(const struct gm_problem *problem, const double *q, double *force,
                             size_t m); /* -dW/dq */
};

/* f = f_0 + ... + f_(pieces - 1), each without divergence and with an exact flow */
struct gm_volume {
    size_t pieces;
    void (*flow)(const struct gm_problem *problem, size_t piece, double h, double *y,
                 size_t m); /* in place */
};

/* the exact, or a trusted, solution from y0 after the time t */
struct gm_exact {
    void (*solution)(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m);
};

enum gm_facet {
    GM_NEEDS_ODE = 1u << 0,
    GM_NEEDS_SPLIT = 1u << 1,
    GM_NEEDS_HAMILTONIAN = 1u << 2,
    GM_NEEDS_LAGRANGIAN = 1u << 3,
    GM_NEEDS_FAST_LINEAR = 1u << 4,
    GM_NEEDS_KEPLER_SPLIT = 1u << 5,
    GM_NEEDS_VOLUME = 1u << 6,
    GM_NEEDS_QUADRATIC = 1u << 7,   /* an ode whose field is quadratic */
    GM_NEEDS_NYSTROM = 1u << 8,     /* a split whose kinetic energy is quadratic */
    GM_NEEDS_INSEPARABLE = 1u << 9, /* a hamiltonian without a split */
    GM_NEEDS_ENERGY = 1u << 10,     /* a hamiltonian whose energy generates the whole field */
    GM_NEEDS_FIELD = 1u << 16,      /* the multisymplectic form */
    GM_NEEDS_WAVE = 1u << 17,       /* u_tt - u_xx + V'(u) = 0 */
    GM_NEEDS_BURGERS = 1u << 18,    /* u_t + u u_x = nu u_xx in moving frames */
    GM_NEEDS_KDV = 1u << 19,        /* u_t + eta u u_x + mu u_xxx = 0 */
    GM_NEEDS_NLS = 1u << 20,        /* i psi_t + psi_xx + |psi|^2 psi = 0 */
    GM_NEEDS_MOVING_MESH = 1u << 11,
    GM_NEEDS_COMPLEX = 1u << 12,
};

/* A problem: n components for m members (an ensemble; m = 1 is an ordinary run). The struct is plain
   data: a scene copies one of core/problems and sets m and parameters.

   Where n is a constant, loops[...]->family holds loops over the problem's kernels. Where n is chosen at run
   time (vortices) it holds none, and a family steps through gm_field if it can.

   The last 2 * passive components are a passive block, x of all then y of all: particles in the plane that
   the others, the active components, carry and that act on nothing. A scheme advances the active ones alone
   and then the passive ones with the active states of its stages, so looking at tracers changes no
   trajectory. */
struct gm_problem {
    const char *name;
    size_t n, m;
    size_t passive;         /* 0, or m is 1 */
    const void *parameters; /* constants of the kernels; they outlive every run */
    const struct gm_ode *ode;
    const struct gm_split *split;
    const struct gm_hamiltonian *hamiltonian;
    const struct gm_lagrangian *lagrangian;
    const struct gm_fast_linear *fast_linear;
    const struct gm_kepler_split *kepler_split;
    const struct gm_volume *volume;
    const struct gm_exact *exact;
    double bound;        /* a component above this is a blow-up; 0: the default of core/run.c */
    struct gm_line line; /* the grid of a field */
    const struct gm_field *field;
    const struct gm_wave *wave;
    const struct gm_dispersive *dispersive;
    const struct gm_kdv *kdv;
    const struct gm_nls *nls;
    const struct gm_burgers *burgers;
    const struct gm_moving_mesh *moving_mesh;
    const struct gm_flow *flow; /* a simplicial complex and the flow on it: core/flow/flow.h */
    const struct gm_loops *loops[GM_ISA_COUNT]; /* made of the problem's kernels by core/kernel/loops.c */
};

#endif
