/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The compositions from which several families make their higher orders. The build writes the compositions of
   Verlet's method from share/schemes. */
#include "core/ode/families/compositions.h"

const struct gm_composition gm_composition_none = {1, {1}};

#define GM_COMPOSITION(identifier, ...) const struct gm_composition gm_composition_##identifier = __VA_ARGS__;
#include "core/compositions_schemes.def"
#undef GM_COMPOSITION

/* M. Sofroniou & G. Spaletta, Optim. Methods Softw. 20 (2005) 597 */
const struct gm_composition gm_composition_sofroniou_spaletta10 = {
    35,
    {0.07879572252168641926, 0.31309610341510852776, 0.02791838323507806611, -0.22959284159390709415,
     0.13096206107716486317, -0.26973340565451071434, 0.07497334315589143567, 0.11199342399981020489,
     0.36613344954622675119, -0.39910563013603589788, 0.10308739852747107732, 0.41143087395589023782,
     -0.00486636058313526176, -0.39203335370863990645, 0.05194250296244964704, 0.05066509075992449634,
     0.04967437063972987906, 0.04931773575959453792}};
