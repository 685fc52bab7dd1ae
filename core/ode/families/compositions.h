/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric compositions of a symmetric method of order 2 with itself, steps of lengths g_1 h, ..., g_s h
   with
       g_{s+1-i} = g_i,   sum_i g_i = 1
   For a symmetric method the order that s steps reach depends on the g alone, whatever the method is. Hairer,
   Lubich & Wanner (2006), section V.3. */
#ifndef GM_CORE_ODE_FAMILIES_COMPOSITIONS_H
#define GM_CORE_ODE_FAMILIES_COMPOSITIONS_H

enum { GM_COMPOSITION_STEPS = 35, GM_COMPOSITION_HALF = (GM_COMPOSITION_STEPS + 1) / 2 };

/* A row of gammas. */
struct gm_composition {
    int steps;                          /* s, odd */
    double gammas[GM_COMPOSITION_HALF]; /* g_1 up to the middle one */
};

/* Returns step i's fraction of h, i = 0, ..., s - 1. */
static inline double gm_composition_fraction(const struct gm_composition *composition, int i)
{
    const int mirrored = composition->steps - 1 - i;
    return composition->gammas[i < mirrored ? i : mirrored];
}

/* The first is the method itself; the names of the others end in their order. */
extern const struct gm_composition gm_composition_none, gm_composition_yoshida4, gm_composition_suzuki4,
    gm_composition_mclachlan4, gm_composition_yoshida6, gm_composition_kahan_li6,
    gm_composition_suzuki_umeno8, gm_composition_kahan_li8, gm_composition_sofroniou_spaletta10;

#endif
