/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields on a line: well-known equations, recognised by their rates, and waves in a user-defined potential, on any
   nodes. */
#ifndef GM_CORE_MODEL_RECOGNITION_H
#define GM_CORE_MODEL_RECOGNITION_H

#include "core/model/system.h"

enum { GM_EQUATION_CONSTANTS = 2 };
struct gm_recognised {
    const char *name; /* "Korteweg-de Vries"; NULL: none of those that are known */
    const char *constants[GM_EQUATION_CONSTANTS]; /* "eta"; NULL behind the last */
    gm_node_id values[GM_EQUATION_CONSTANTS];     /* in parameters */
};

/* Finds the equation of the rates, whatever the order of their terms. The graph grows. False when out of memory. */
bool gm_equation_recognise(struct gm_user_system *system, struct gm_recognised *found);

/* u and its time derivatives at the start, as levels need them; derivatives of V */
enum { GM_TYPED_START = 5, GM_TYPED_DERIVATIVES = 3 };

/* The formulas of a field, in its system's graph. */
struct gm_user_wave {
    const struct gm_user_system *system;
    gm_node_id by_u[GM_TYPED_DERIVATIVES]; /* V', V'', V''' */
    bool sine_gordon; /* V = 1 - cos u, whose means over an element are known in closed form */
    double degree;    /* degree of V' in u; INFINITY: not written as a polynomial */
    /* formulas in x as variable 0; the exact solution has t as variable 1; GM_NO_NODE: not given */
    gm_node_id start[GM_TYPED_START], start_slope /* u_x */, exact, drift /* X_t */;
    gm_node_id exact_while; /* of x and t: above 0 while the exact solution holds */
};

/* Returns the number of formulas of the start: u and u_t, and further derivatives without an exact solution. */
static inline size_t gm_wave_start_count(const struct gm_user_wave *wave)
{
    return wave->exact == GM_NO_NODE ? GM_TYPED_START : 2;
}

/* Derives the formulas and adds them to the graph. False when out of memory; where memory was refused (core/memory.h) a
   known potential may not have been recognised. */
bool gm_user_wave_derive(struct gm_user_wave *wave, struct gm_user_system *system);

#endif
