/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The compositions that several families make their higher orders of. */
#include "core/ode/families/compositions.h"

const struct gm_composition gm_composition_none = {1, {1}};

/* 1 / (2 - 2^(1/3)) = (2 + 2^(1/3) + 2^(-1/3)) / 3. E. Forest & R.D. Ruth, Physica D 43 (1990) 105;
   H. Yoshida, Phys. Lett. A 150 (1990) 262 */
#define TRIPLE_JUMP 1.3512071919596576340476878089715
const struct gm_composition gm_composition_yoshida4 = {3, {TRIPLE_JUMP, 1 - 2 * TRIPLE_JUMP}};

/* 1 / (4 - 4^(1/3)). M. Suzuki, Phys. Lett. A 146 (1990) 319 */
#define QUINTUPLE_JUMP 0.4144907717943757371424
const struct gm_composition gm_composition_suzuki4 = {
    5, {QUINTUPLE_JUMP, QUINTUPLE_JUMP, 1 - 4 * QUINTUPLE_JUMP}};

/* R.I. McLachlan, SIAM J. Sci. Comput. 16 (1995) 151 */
const struct gm_composition gm_composition_mclachlan4 = {
    5, {0.28, 0.62546642846767004501, -0.81093285693534009002}};

/* H. Yoshida, Phys. Lett. A 150 (1990) 262, solution A */
const struct gm_composition gm_composition_yoshida6 = {
    7, {0.78451361047755726382, 0.23557321335935813368, -1.17767998417887100695, 1.31518632068391121888}};

/* W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089 */
const struct gm_composition gm_composition_kahan_li6 = {9,
                                                        {0.39216144400731413928, 0.33259913678935943860,
                                                         -0.70624617255763935981, 0.08221359629355080023,
                                                         0.79854399093482996340}};

/* M. Suzuki & K. Umeno, in: Computer Simulation Studies in Condensed-Matter Physics VI (1993) 74; the digits
   as in Hairer, Lubich & Wanner (2006), section V.3.2 */
const struct gm_composition gm_composition_suzuki_umeno8 = {
    15,
    {0.74167036435061295345, -0.40910082580003159400, 0.19075471029623837995, -0.57386247111608226666,
     0.29906418130365592384, 0.33462491824529818378, 0.31529309239676659663, -0.79688793935291635402}};

/* W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089 */
const struct gm_composition gm_composition_kahan_li8 = {
    17,
    {0.13020248308889008088, 0.56116298177510838456, -0.38947496264484728641, 0.15884190655515560090,
     -0.39590389413323757734, 0.18453964097831570709, 0.25837438768632204729, 0.29501172360931029887,
     -0.60550853383003451170}};

/* M. Sofroniou & G. Spaletta, Optim. Methods Softw. 20 (2005) 597 */
const struct gm_composition gm_composition_sofroniou_spaletta10 = {
    35,
    {0.07879572252168641926, 0.31309610341510852776, 0.02791838323507806611, -0.22959284159390709415,
     0.13096206107716486317, -0.26973340565451071434, 0.07497334315589143567, 0.11199342399981020489,
     0.36613344954622675119, -0.39910563013603589788, 0.10308739852747107732, 0.41143087395589023782,
     -0.00486636058313526176, -0.39203335370863990645, 0.05194250296244964704, 0.05066509075992449634,
     0.04967437063972987906, 0.04931773575959453792}};
