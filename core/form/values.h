/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program of forms on one mesh, for given parameters: its values, and its matrices in the unknowns. */
#ifndef GM_CORE_FORM_VALUES_H
#define GM_CORE_FORM_VALUES_H

#include "core/form/hodge.h"
#include "core/form/program.h"
#include "core/tape.h"

struct gm_form_values {
    const struct gm_form_program *program;
    struct gm_form_space *space;
    double **slot;                    /* the value of each step */
    struct gm_tape *tapes;            /* for each step that samples */
    double **sampled;                 /* scratch of each of these */
    const struct gm_matrix *closings; /* for each item of the system: edges to vertices */
    const struct gm_matrix *around;   /* for each part in integral(PART, a): edges to a number */
    double *const *arcs;              /* for each item of the system: s at the points of its samples */
    struct gm_hodge *hodge;           /* NULL: no step needs it */
    double time;                      /* of the samples; NaN: none were made */
    unsigned fixed; /* set before the first run: those bits of steps' needs that never change */
    bool *zero;     /* of each step, found by the first run: it is 0 whatever the forms are */
    bool *idle;     /* later runs leave it out: its value stays, or nothing needs it */
};

/* Called in a body of the arena, which owns all. `variables` has the values of all variables of the system. */
void gm_form_values_open(struct gm_form_values *values, struct gm_arena *arena,
                         const struct gm_form_program *program, struct gm_form_space *space,
                         const struct gm_user_system *system, const double *variables);

/* Computes all steps for these forms, of which form i of the system is forms[i]. */
void gm_form_values_run(struct gm_form_values *values, double t, double *const *forms);

/* The root's form or number, after a run. */
const double *gm_form_values_root(const struct gm_form_values *values, size_t root);

/* The rows and columns of a matrix of derivatives. */
struct gm_form_layout {
    unsigned needs;       /* over the forms of GM_NEEDS_FIELDS or GM_NEEDS_UNKNOWNS */
    const size_t *forms;  /* of each root: the form whose rows it has */
    const size_t *offset; /* of each form */
    size_t count;         /* of rows, and of columns */
};

/* The derivatives of all roots: a body of the arena, after a run. Integrals and the wedge product of 1-forms are left
   out. Steps that solve with a mass matrix have numbers of their own after `count`, and rows that are 0 with them. The
   whole diagonal has entries. */
struct gm_matrix gm_form_values_matrix(const struct gm_form_values *values, struct gm_arena *arena,
                                       const struct gm_form_layout *layout);

/* The sum of a times star a, of one form; scratch: as many numbers. */
double gm_form_square(const struct gm_form_space *space, struct gm_form_type type, const double *a,
                      double *scratch);

/* The vectors of a 1-form at centres of mass, 3 a triangle; scratch: a number for each edge. With a (g_j - g_i)/3 for
   each edge i -> j, g the gradients of barycentric coordinates, Whitney's form has that vector there; a dual 1-form u is
   n x the vector of u over the star. */
void gm_form_vectors(const struct gm_form_space *space, bool dual, const double *form, double *scratch,
                     double *vectors);

#endif
