/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Invariants, and affine symmetries, that the equations of a system have, found and proved. */
#ifndef GM_CORE_MODEL_INVARIANTS_H
#define GM_CORE_MODEL_INVARIANTS_H

#include "core/model/system.h"

enum { GM_MOST_CANDIDATES = 3000, GM_LARGEST_DEGREE = 8 };

struct gm_found_invariant {
    const struct gm_system_item *item; /* the declared one; NULL: H, or found */
    bool energy;                       /* H */
    gm_node_id node;                   /* in the system's graph; what was found has whole coefficients */
    size_t degree;                     /* in the components and in parts that are not polynomials; 0: above */
    bool proved;                       /* else tested at random points */
};

/* No invariant of a list is a polynomial in the others; `independent` of them have independent gradients. The list has
   all invariants with a name, whatever their degree, and even if nothing was searched. */
struct gm_found_invariants {
    size_t degree;     /* largest degree that was searched */
    bool lowered;      /* a larger one was wanted; it has more than GM_MOST_CANDIDATES */
    size_t candidates; /* products of components and parts */
    struct gm_found_invariant *list;
    size_t count, independent;
    size_t unwritten;  /* further invariants: their coefficients are not short fractions */
    const char *lacks; /* the reason why nothing was searched, in words, with `independent` 0; NULL: it was */
};

/* Finds the polynomial invariants up to a degree, for the system's values of parameters. Inside a body of the arena,
   which is left when out of memory. The graph grows. */
void gm_invariants_find(struct gm_user_system *system, struct gm_arena *arena, size_t degree,
                        struct gm_found_invariants *found);

/* The word before the numbers of those without a name: "I", or "found" where the system has a name such as I1. */
const char *gm_found_word(const struct gm_user_system *system);

enum { GM_MOST_WITH_SYMMETRIES = 20 /* components */ };

/* A field a + A y whose flow sends motions into motions, which become faster for c > 0. */
struct gm_symmetry {
    gm_node_id *field; /* [n], with whole coefficients, in the system's graph */
    double scaling;    /* c */
    gm_node_id
        momentum_map; /* G, constant in the motion of a canonical system, with the field J grad G; or GM_NO_NODE */
    size_t paired; /* the number of the invariant that G is a function of; or their count */
};

/* Finds a basis of the affine symmetries for the values of parameters, of a system of which gm_invariants_find lacks
   nothing. Returns their number, without the *unwritten ones, whose coefficients are not short fractions; 0 for too many
   components.
   Inside a body of the arena, which is left when out of memory. The graph grows. */
size_t gm_symmetries_find(struct gm_user_system *system, struct gm_arena *arena,
                          const struct gm_found_invariants *invariants, struct gm_symmetry **symmetries,
                          size_t *unwritten);

#endif
