/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas of forms as typed steps: what they are made of, found and checked without a mesh. */
#ifndef GM_CORE_FORM_PROGRAM_H
#define GM_CORE_FORM_PROGRAM_H

#include "core/form/space.h"
#include "core/model/system.h"

/* The time, fields and unknowns that a step depends on, as bits. */
enum { GM_NEEDS_TIME = 1, GM_NEEDS_FIELDS = 2, GM_NEEDS_UNKNOWNS = 4 };

/* A step makes one form, or a number, of those of earlier steps a and b. */
struct gm_form_step {
    enum gm_form_step_kind {
        GM_STEP_FORM,    /* form `number` of the system */
        GM_STEP_SAMPLE,  /* the formulas of the place and the time, by integrals of densities */
        GM_STEP_MATRIX,  /* matrix `number` times a */
        GM_STEP_OPERATE, /* operation `number` on the entries of a and b, of which one may be a number */
        GM_STEP_WEDGE,   /* of two primal 1-forms: the integral of the product of Whitney's forms */
        GM_STEP_CLOSING, /* boundary line `number`: the part of dual cells along it, of the integrals a */
        GM_STEP_EXACT,   /* parts of a 1-form by Hodge */
        GM_STEP_COEXACT,
        GM_STEP_AROUND, /* the integral of a along boundary part `number` */
        GM_STEP_AT,     /* the value of a at the place whose coordinates are the steps `nodes` */
        GM_STEP_SUM,
        GM_STEP_LARGEST,
        GM_STEP_LEAST,
    } kind;
    struct gm_form_type type;
    unsigned needs;
    size_t a, b, number; /* of a sample: 1 + the item of the line `boundary:` that s is of; 0: none */
    gm_node_id nodes[3]; /* of variables x y z s t, then the parameters */
    size_t components;   /* how many nodes: 3 of a 1-form */
};
enum { GM_SAMPLE_INPUTS = GM_FORM_PLACES + 1 }; /* x y z s t */

struct gm_form_program {
    struct gm_form_step *steps;
    size_t count;
    size_t *roots; /* the step of each root */
    size_t root_count;
};

/* A formula, and the form it has to be. */
struct gm_form_root {
    gm_node_id node;
    struct gm_form_type type; /* degree GM_FORM_ANY: what it is */
    bool density;             /* a formula of the place is the density of the form */
    size_t along; /* 1 + the item of a line `boundary:`: of a 1-form the density is along an edge; else 0 */
    size_t place; /* of its text */
};
enum { GM_FORM_ANY = -9 };

/* Compiles roots, in the system's memory; the graph grows. With `linear` every root has to be linear in the
   unknowns, with coefficients that do not change. False with a fault, whose sentence is empty when out of
   memory. */
bool gm_form_compile(struct gm_form_program *program, struct gm_user_system *system,
                     const struct gm_form_root *roots, size_t count, bool linear, struct gm_fault *fault);

/* "a dual 1-form", "a number" */
const char *gm_form_type_text(struct gm_form_type type);

#endif
