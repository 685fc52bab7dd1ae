/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes and families of schemes: the rows of data, and the functions of a family. */
#ifndef GM_CORE_SCHEME_H
#define GM_CORE_SCHEME_H

#include "core/parameter.h"
#include "core/problem.h"

/* The claims of a scheme, as bits; certify and the tests check every row. */
enum gm_claim {
    GM_SYMPLECTIC = 1u << 0,
    GM_SYMMETRIC = 1u << 1,       /* step(-dt) undoes step(dt), also in the scheme's memory */
    GM_REVERSIBLE = 1u << 2,      /* reversible under p -> -p */
    GM_KEEPS_ENERGY = 1u << 3,    /* energy of every Hamiltonian system */
    GM_KEEPS_QUADRATIC = 1u << 4, /* every quadratic invariant */
    GM_KEEPS_LINEAR = 1u << 5,    /* every linear invariant */
    GM_KEEPS_VOLUME = 1u << 6,
    GM_MULTISYMPLECTIC = 1u << 7,
    GM_EQUIVARIANT = 1u << 8,          /* commutes with the problem's symmetry group */
    GM_DIVERGENCE_FREE = 1u << 9,      /* d1 d0 psi = 0: no mass is made */
    GM_KEEPS_CONSTANTS = 1u << 10,     /* a constant scalar stays constant */
    GM_CLOSES_BUDGET = 1u << 11,       /* the scalar changes by what crosses the boundary */
    GM_KEEPS_BILINEAR = 1u << 12,      /* every invariant q' A p, as angular momentum is one */
    GM_KEEPS_MOMENTUM_MAPS = 1u << 13, /* momentum map of every symmetry that acts by affine maps */
    GM_CONFORMAL = 1u << 14,           /* a friction -c p shrinks every area by exp(-c t) */
    GM_KEEPS_CONSTRAINTS = 1u << 15,   /* constraints g(q) = 0 */
    GM_KEEPS_HIDDEN = 1u << 16,        /* hidden constraints dg/dq v = 0 */
    GM_KEEPS_CASIMIRS = 1u << 17,      /* Casimirs of every bracket that the scheme fits */
    GM_POISSON_MAP = 1u << 18,         /* derivative M preserves the bracket: M B(y0) M' = B(y1) */
    GM_CLAIM_COUNT = 19,
};

/* The words of claims, by their bit numbers. */
extern const struct gm_claim_words {
    const char *letter; /* on screens: "H" */
    const char *key;    /* in files and JSON: "keeps energy" */
    const char *word;   /* in sentences and tables: "conserves energy" */
} gm_claims[GM_CLAIM_COUNT];
/* Reads claims by their keys, one after the other, or "none". Returns false with the position of another word. */
bool gm_claims_read(const char *words, size_t length, unsigned *claims, size_t *wrong);

/* Parameters of schemes; every lane whose scheme uses one shares it. */
struct gm_settings {
    int compensated;  /* compensated summation of the increments */
    double binding;   /* binding of the two copies of phase space, of Tao's schemes */
    double tau0;      /* the first step of the schemes with variational time */
    double tolerance; /* tolerance of dopri5 (0: 1e-6) and of GSL's steppers (0: fixed step) */
    double newmark_beta;
};
extern const struct gm_parameter gm_settings_parameters[];
extern const size_t gm_settings_parameter_count;
/* Returns the row with that key, or NULL. */
const struct gm_parameter *gm_setting_find(const char *key);
/* Returns true for one of these rows: it is of schemes, not of a scene. */
static inline bool gm_is_setting(const struct gm_parameter *row)
{
    return row >= gm_settings_parameters && row < gm_settings_parameters + gm_settings_parameter_count;
}
/* Rows for families, NULL-terminated. */
extern const struct gm_parameter *const gm_settings_of_sums[];             /* compensated */
extern const struct gm_parameter *const gm_settings_of_tao[];              /* binding */
extern const struct gm_parameter *const gm_settings_of_variational_time[]; /* tau0 */
extern const struct gm_parameter *const gm_settings_of_tolerance[];        /* tolerance */
extern const struct gm_parameter *const gm_settings_of_newmark[];          /* newmark_beta */

struct gm_arena;
struct gm_coefficients;  /* core/theory/coefficients.h */
struct gm_law;           /* core/field/multisymplectic.h */
struct gm_member_family; /* core/ode/kernel/members.h */

/* The bound of linear theory on a scheme's steps dt of a wave, square/dt^2 >= stiffness/dx^2 + V'' wherever u is. */
struct gm_step_limit {
    const char *condition; /* "4/dt^2 >= 4/dx^2 + V''" */
    double square, stiffness;
    bool helped; /* V'' lengthens the step: square/dt^2 + V'' >= stiffness/dx^2 */
};

/* A scheme is a row of data. A number at the end of a name is the order. */
struct gm_scheme {
    const char *name;      /* "rk4" */
    const char *title;     /* "RK4", as pictures write it */
    const char *formula;   /* Unicode, lines separated by \n */
    const char *reference; /* source of the scheme */
    const struct gm_family *family;
    const void *coefficients; /* of a type defined by the family */
    int order;                /* 0: variable order */
    unsigned needs;           /* facets of its kind of problem, GM_NEEDS_*; all of them */
    unsigned claims;          /* GM_SYMPLECTIC | ... */
    unsigned follows;         /* of a user's scheme: the claims that follow from its parts, listed or not */
    /* The fields below are for pictures and messages. */
    const struct gm_step_limit *limit; /* NULL: none is known */
    bool steady;                       /* steps lead to a steady state: there is no time */
    bool in_modes;                     /* a field is the trigonometric polynomial through its nodes */
    bool in_cells; /* conserved quantities are of means in cells, not of values at nodes */
    /* The word that makes a user-defined scheme, usable instead of a name, and its coefficients for
       theory. NULL: the scheme is a row of its family. */
    const char *word;
    const struct gm_coefficients *exact;
    /* The same word where the system itself gives the parts that it names; NULL: none */
    const struct gm_scheme *by_names;
    const struct gm_scheme *base; /* whose steps it corrects, so that it may give up claims; NULL: none */
};

/* A line of a list families.def: a family with a folder of its own below families/. */
#define GM_FAMILY_IN(folder, name) GM_FAMILY(name)

struct gm_family {
    const struct gm_kind *kind; /* kind of the problems that it advances */
    const char *title;
    const struct gm_scheme *schemes;
    size_t count;
    const struct gm_parameter *const *parameters; /* rows of gm_settings_parameters, NULL-terminated */
    /* The number of the family's loop over a problem's kernels, defined by the kind; 0: none. */
    int over_kernels;
    /* Opens the coefficients of a scheme in an arena's body, if its rows are Runge-Kutta methods, plain or
       partitioned, or splittings. NULL: they are not. */
    void (*coefficients_open)(struct gm_arena *arena, const struct gm_scheme *scheme,
                              struct gm_coefficients *coefficients);

    /* The fields below are for families that are not loops over a problem's kernels. */
    /* Advances any problem that has the facets, unless its kind has another loop; NULL: none. */
    gm_loop *loop;
    bool carries_passive;                   /* loop advances a passive block too */
    const struct gm_member_family *members; /* NULL: loop is not the one of core/ode/kernel/members.h */
    /* Doubles of memory that a scheme carries from step to step, in the run's block. */
    size_t (*memory)(const struct gm_problem *problem, const struct gm_scheme *scheme);
    /* Fills task->memory_out from the canonical state task->y: at the start, after a switch, for a new dt.
       After every step `out` holds the canonical state again. */
    enum gm_status (*start)(const struct gm_task *task);
    /* The structure that a problem with the facets lacks, worded like a facet; NULL: nothing. It is valid until the next call in
       this thread. NULL: the facets are all. */
    const char *(*lacks)(const struct gm_scheme *scheme, const struct gm_problem *problem);
    /* Scratch and factors: derived from the state alone, rebuilt when a run is resumed. Returns NULL when
       out of memory. */
    void *(*workspace_open)(const struct gm_problem *problem, const struct gm_scheme *scheme);
    void (*workspace_close)(void *workspace);
    void (*workspace_reset)(void *workspace); /* forgets data derived from an earlier state */
    /* The scheme has step size control: the loop returns the time, dt is defined by its rows. One member
       only. */
    bool adaptive;
    /* The scheme's own steps follow the tolerance; dt is the distance of its rows, which are interpolated. */
    bool by_tolerance;
    /* The memory is a second copy of phase space, and the scheme is symplectic on both together. */
    bool doubled;
    /* The residual of the discrete multisymplectic law, for gm_form_residual. NULL: the family has no such
       law. */
    double (*form)(const struct gm_law *law);
    /* The energy of a wave in the family's own space and memory; NaN: out of memory. NULL: it follows from
       the two levels of the state. */
    double (*wave_energy)(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory);
    bool not_resumable; /* the workspace holds a library's stepper, which no snapshot can take along */
    bool joins;         /* the memory changes no step: with it two flows of two steps are one */
};

/* Returns true if theory knows the coefficients of a scheme. */
static inline bool gm_scheme_has_coefficients(const struct gm_scheme *scheme)
{
    return scheme->exact || scheme->family->coefficients_open;
}

/* Returns true if steps follow from more than the state. */
static inline bool gm_scheme_has_memory(const struct gm_scheme *scheme)
{
    return scheme->family->memory && !scheme->family->joins;
}

/* Returns true if steps of fixed length follow from the state alone; and if a repeated step is the same to the bit. */
static inline bool gm_scheme_has_one_step(const struct gm_scheme *scheme)
{
    const struct gm_family *family = scheme->family;
    return !family->adaptive && !gm_scheme_has_memory(scheme) && !family->by_tolerance &&
           !family->not_resumable;
}
static inline bool gm_scheme_repeats_steps(const struct gm_scheme *scheme)
{
    return gm_scheme_has_one_step(scheme) && !scheme->family->workspace_reset;
}

/* Returns true if a scheme has this parameter, a row of gm_settings_parameters. */
bool gm_scheme_takes(const struct gm_scheme *scheme, const struct gm_parameter *row);

#endif
