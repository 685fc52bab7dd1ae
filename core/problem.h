/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_PROBLEM_H
#define GM_CORE_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>

#include "core/status.h"

struct gm_loops;
struct gm_scheme;
struct gm_settings;
struct gm_problem;
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
    double limit; /* a component above this is a blow-up */
    const double *y;
    double *out;
    const double *carry; /* what compensated summation carries over, n * m; NULL: plain summation */
    double *carry_out;
    const double *memory; /* the scheme's own, as its family says; NULL if it has none */
    double *memory_out;
    double t;                            /* the present time */
    void *workspace;                     /* what the family opened for this run */
    const struct gm_settings *settings;
};

/* What it did. `done` steps succeeded for every member; if that is less than task.steps, `out` is
   void and `status` says why step done + 1 failed. Counts are sums over the members. */
struct gm_progress {
    long done;
    enum gm_status status;
    unsigned long evaluations, solves, iterations;
    double t; /* the time reached, of schemes that choose their own step */
};

typedef struct gm_progress gm_loop(const struct gm_task *task);

/* Facets: the structure a problem has. A NULL facet means that it has none of that kind.
   All arrays are component-major, [component * m + member], for the m members passed. */

/* y' = f(y), evaluated by loops[...]->field */
struct gm_ode {
    bool stiff; /* implicit equations are solved by Newton's method from the first iteration on */
};

/* H(q, p) = T(p) + V(q): exact flows of two parts; q are the first n / 2 components */
struct gm_split {
    bool nystrom; /* T is quadratic */
};

struct gm_hamiltonian {
    void (*energy)(const struct gm_problem *problem, const double *y, double *energy, size_t m);
};

/* the exact, or a trusted, solution from y0 after the time t */
struct gm_exact {
    void (*solution)(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m);
};

enum gm_facet {
    GM_NEEDS_ODE = 1u << 0,
    GM_NEEDS_SPLIT = 1u << 1,
    GM_NEEDS_COMPLEX = 1u << 6,
};

/* A problem: n components for m members (an ensemble; m = 1 is an ordinary run). The struct is plain
   data: a scene copies one of core/problems and sets m and parameters. */
struct gm_problem {
    const char *name;
    size_t n, m;
    const void *parameters; /* constants of the kernels; they outlive every run */
    const struct gm_ode *ode;
    const struct gm_split *split;
    const struct gm_hamiltonian *hamiltonian;
    const struct gm_exact *exact;
    const struct gm_flow *flow; /* a simplicial complex and the flow on it: core/flow/flow.h */
    const struct gm_loops *loops[GM_ISA_COUNT]; /* made of the problem's kernels by core/kernel/loops.c */
};

#endif
