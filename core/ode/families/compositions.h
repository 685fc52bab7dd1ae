/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric compositions of a symmetric method of order 2 with itself, steps of lengths g_1 h, ..., g_s h
   with
       g_{s+1-i} = g_i,   sum_i g_i = 1
   For a symmetric method the order that s steps reach depends on the g alone, whatever the method is. Hairer,
   Lubich & Wanner (2006), section V.3. Each list takes a macro that receives the first half of the fractions,
   the middle one included. */
#ifndef GM_CORE_ODE_FAMILIES_COMPOSITIONS_H
#define GM_CORE_ODE_FAMILIES_COMPOSITIONS_H

/* 1 / (2 - 2^(1/3)) = (2 + 2^(1/3) + 2^(-1/3)) / 3. E. Forest & R.D. Ruth, Physica D 43 (1990) 105;
   H. Yoshida, Phys. Lett. A 150 (1990) 262 */
#define GM_TRIPLE_JUMP 1.3512071919596576340476878089715
#define GM_YOSHIDA4(OF) OF(GM_TRIPLE_JUMP, 1 - 2 * GM_TRIPLE_JUMP)

/* 1 / (4 - 4^(1/3)). M. Suzuki, Phys. Lett. A 146 (1990) 319 */
#define GM_QUINTUPLE_JUMP 0.4144907717943757371424
#define GM_SUZUKI4(OF) OF(GM_QUINTUPLE_JUMP, GM_QUINTUPLE_JUMP, 1 - 4 * GM_QUINTUPLE_JUMP)

/* R.I. McLachlan, SIAM J. Sci. Comput. 16 (1995) 151 */
#define GM_MCLACHLAN4(OF) OF(0.28, 0.62546642846767004501, -0.81093285693534009002)

/* H. Yoshida, Phys. Lett. A 150 (1990) 262, solution A */
#define GM_YOSHIDA6(OF)                                                                                      \
    OF(0.78451361047755726382, 0.23557321335935813368, -1.17767998417887100695, 1.31518632068391121888)

/* W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089 */
#define GM_KAHAN_LI6(OF)                                                                                     \
    OF(0.39216144400731413928, 0.33259913678935943860, -0.70624617255763935981, 0.08221359629355080023,      \
       0.79854399093482996340)

/* M. Suzuki & K. Umeno, in: Computer Simulation Studies in Condensed-Matter Physics VI (1993) 74; the digits
   as in Hairer, Lubich & Wanner (2006), section V.3.2 */
#define GM_SUZUKI_UMENO8(OF)                                                                                 \
    OF(0.74167036435061295345, -0.40910082580003159400, 0.19075471029623837995, -0.57386247111608226666,     \
       0.29906418130365592384, 0.33462491824529818378, 0.31529309239676659663, -0.79688793935291635402)

/* W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089 */
#define GM_KAHAN_LI8(OF)                                                                                     \
    OF(0.13020248308889008088, 0.56116298177510838456, -0.38947496264484728641, 0.15884190655515560090,      \
       -0.39590389413323757734, 0.18453964097831570709, 0.25837438768632204729, 0.29501172360931029887,      \
       -0.60550853383003451170)

/* All fractions of the composition. */
#define GM_PALINDROME_3(a, b) a, b, a
#define GM_PALINDROME_5(a, b, c) a, b, c, b, a
#define GM_PALINDROME_9(a, b, c, d, e) a, b, c, d, e, d, c, b, a
#define GM_PALINDROME_17(a, b, c, d, e, f, g, h, i) a, b, c, d, e, f, g, h, i, h, g, f, e, d, c, b, a

#endif
