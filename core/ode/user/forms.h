/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of discrete forms as a problem: fields that evolve are ordinary differential equations, unknowns are
   solved for at every time. */
#ifndef GM_CORE_ODE_USER_FORMS_H
#define GM_CORE_ODE_USER_FORMS_H

#include "core/form/program.h"
#include "core/ode/ode.h"
#include "core/quantity.h"

/* A form that files and pictures have by its name. */
struct gm_form_named {
    const char *name;
    struct gm_form_type type;
    bool
        declared; /* a field or an unknown, `number` of the system; else a let, `number` of what is observed */
    size_t number;
};

/* The programs of a system of forms, which know no mesh. */
struct gm_form_model {
    struct gm_user_system *system;
    struct gm_form_program rates, starts, exacts, equations, observed, held;
    size_t *fields, field_count;     /* the forms that evolve, as roots of `rates` and `starts` are */
    size_t *unknowns, unknown_count; /* the others, as roots of `equations` are */
    size_t *held_item;               /* the line of each root of `held` */
    size_t observed_count;           /* invariants, observables and lets, in the order of the items */
    size_t *observed_item;
    struct gm_form_named *named; /* declared forms, then lets */
    size_t named_count;
    const char *mesh_name,
        *mesh_text; /* the file of the mesh, and its bytes, which the caller keeps; NULL: generated */
    size_t mesh_size;
    struct gm_form_type *equation_types; /* of each unknown */
    struct gm_form_idle *idle;           /* the problem that was closed last, for its next use */
    size_t split; /* fields before this one have rates of those from it on, and these of those; 0: none */
};

/* Compiles all lines. False with a fault, whose sentence is empty when out of memory. */
bool gm_form_model_open(struct gm_form_model *model, struct gm_user_system *system, struct gm_fault *fault);

/* True if the mesh is a file; its name is that of the line's item. */
bool gm_form_reads_mesh(const struct gm_user_system *system);

/* The choices of keys. */
struct gm_form_choice {
    enum gm_star star;
    enum gm_interior interior;
};

/* Opens the problem with these values of all variables. False with a fault; its offset is 0 if it is not of a
   line. The caller closes with gm_form_problem_close. */
bool gm_form_problem_open(struct gm_problem *problem, const struct gm_form_model *model,
                          struct gm_form_choice choice, const double *variables, struct gm_fault *fault);
void gm_form_problem_close(struct gm_problem *problem);

/* Writes the state at the start. */
void gm_form_start(const struct gm_problem *problem, double *y);

const struct gm_form_space *gm_form_space_of(const struct gm_problem *problem);
const struct gm_form_model *gm_form_model_of(const struct gm_problem *problem);
/* The numbers of a named form in a state, which for an unknown are solved for; valid until the next call. */
const double *gm_form_numbers(const struct gm_problem *problem, const double *y, double t, size_t named);
/* The arrays of files (gm_quantities): the mesh, 4, and of each named form one for tables and one for pictures. */
enum { GM_MOST_NAMED_FORMS = (GM_QUANTITIES - 4) / 2 };
size_t gm_form_quantities(const struct gm_run *run, struct gm_quantity *quantities);
/* The value of what is observed, a number or a form; valid until the next call. */
const double *gm_form_observed(const struct gm_problem *problem, const double *y, double t, size_t observed);
/* The error of form i at a time, relative to the exact form; NaN without an `exact:`. */
double gm_form_error(const struct gm_problem *problem, const double *y, double t, size_t form);
/* The largest residual of the equations of the unknown i, relative to the largest sum of their terms' magnitudes, and
   the relative part of its right side that no unknown can meet. */
double gm_form_balance(const struct gm_problem *problem, const double *y, double t, size_t form,
                       double *defect);

/* The factors that are made when a problem is opened; `symmetric`: Cholesky's, else those by LU. Returns their number. */
enum { GM_FORM_FACTORS = 4 };
struct gm_form_factor {
    const char *matrix;
    bool symmetric;
    size_t entries;
    double megabytes;
};
size_t gm_form_factors(const struct gm_problem *problem, struct gm_form_factor factors[GM_FORM_FACTORS]);

/* The rate of an observed number along the equations, at the start with random numbers added: relative, in the time in
   which the state would change by as much as it is. About 1e-13: the mesh keeps it. NaN when out of memory. */
double gm_form_drift(const struct gm_problem *problem, size_t observed);

#endif
