/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H
#define GM_CORE_FIELD_FAMILIES_BOXES_ANY_FORM_H

#include "core/field/multisymplectic.h"

enum { GM_COLLOCATION_STAGES = 3 };
struct gm_collocation_tableau {
    size_t r;
    double a[GM_COLLOCATION_STAGES][GM_COLLOCATION_STAGES], b[GM_COLLOCATION_STAGES],
        c[GM_COLLOCATION_STAGES];
};

extern const struct gm_collocation_tableau gm_collocation_gauss4;

/* The functions of a family of boxes; see gm_family. */
void *gm_any_form_open(const struct gm_problem *problem, const struct gm_scheme *scheme);
void gm_any_form_close(void *workspace);
size_t gm_any_form_memory(const struct gm_problem *problem, const struct gm_scheme *scheme);
enum gm_status gm_any_form_start(const struct gm_task *task);
struct gm_progress gm_any_form_advance(const struct gm_task *task);
double gm_any_form_law(const struct gm_law *law);

/* s at the stages of the cells, [(component * r + stage) * points + cell], as a memory of the family has
   them. The scheme's coefficients are a gm_collocation_tableau. */
const double *gm_any_form_stages(const double *memory);

/* The integral of a density of s and the slopes of the state's components, with Gauss's rule at the stages
   of the cells; NaN when out of memory, or if `memory` is NULL. */
double gm_any_form_integral(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const double *memory,
                            double (*density)(const struct gm_problem *problem, const double *s,
                                              const double *slope));

/* The integrals of S(s) - s' K s_x / 2 and s' M s_x / 2, the energy and the momentum that follow from M s_t + K s_x = grad
   S(s) by the product with s_t and with s_x, at the stages of the cells with the slopes that the boxes have there: of one
   stage dx sum [S(A s) - (A s)' K D s / 2] and dx sum (A s)' M D s / 2. `memory` belongs to a run with the scheme, a row
   of gm_family_any_form. NaN if it is NULL, or when out of memory. */
double gm_form_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *memory);
double gm_form_momentum(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        const double *memory);

#endif
