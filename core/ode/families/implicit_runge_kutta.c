/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit Runge-Kutta methods, for the increments z_i of the stages:
       z_i = h sum_j a_ij f(y0 + z_j)
       y1  = y0 + h sum_i b_i f(y0 + z_i)
   solved to round-off by fixed-point iteration, and where that does not contract, or the problem is stiff, by
   Newton's method. A method is symplectic if b_i a_ij + b_j a_ji = b_i b_j. E. Hairer, C. Lubich & G. Wanner,
   Geometric Numerical Integration (2006), sections II.1, VI.4, VIII.6. */
#include "core/ode/families/implicit_runge_kutta.h"

#include <stdlib.h>

#include "core/ode/families/compositions.h"
#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta_any.h"
#include "core/ode/kernel/loops.h"

#define SQRT2 1.4142135623730950488016887242097
#define SQRT3 1.7320508075688772935274463415058724
#define SQRT6 2.4494897427831780981972840747059
#define SQRT15 3.8729833462074168851792653997824

#define ONE_STEP .substeps = 1, .fractions = {1}

static const struct gm_implicit_row implicit_euler = {.stages = 1, .a = {{1}}, .b = {1}, ONE_STEP};
static const struct gm_implicit_row midpoint = {.stages = 1, .a = {{0.5}}, .b = {1}, ONE_STEP};
static const struct gm_implicit_row trapezoidal = {
    .stages = 2, .a = {{0, 0}, {0.5, 0.5}}, .b = {0.5, 0.5}, ONE_STEP};
static const struct gm_implicit_row gauss4 = {
    .stages = 2, .a = {{0.25, 0.25 - SQRT3 / 6}, {0.25 + SQRT3 / 6, 0.25}}, .b = {0.5, 0.5}, ONE_STEP};
static const struct gm_implicit_row gauss6 = {
    .stages = 3,
    .a = {{5. / 36, 2. / 9 - SQRT15 / 15, 5. / 36 - SQRT15 / 30},
          {5. / 36 + SQRT15 / 24, 2. / 9, 5. / 36 - SQRT15 / 24},
          {5. / 36 + SQRT15 / 30, 2. / 9 + SQRT15 / 15, 5. / 36}},
    .b = {5. / 18, 4. / 9, 5. / 18},
    ONE_STEP,
};
/* collocation at the zeros of the shifted Legendre polynomial of degree 4 */
static const struct gm_implicit_row gauss8 = {
    .stages = 4,
    .a = {{0.08696371128436346434327, -0.02660418008499879331339, 0.01262746268940472451506,
           -0.003555149685795683156911},
          {0.1881181174998680716507, 0.1630362887156365356567, -0.02788042860247089522415,
           0.006735500594538155515399},
          {0.1671919219741887731711, 0.3539530060337439665376, 0.1630362887156365356567,
           -0.01419069493114114296415},
          {0.1774825722545226118434, 0.3134451147418683467984, 0.3526767575162718646269,
           0.08696371128436346434327}},
    .b = {0.1739274225687269286865, 0.3260725774312730713135, 0.3260725774312730713135,
          0.1739274225687269286865},
    ONE_STEP,
};
static const struct gm_implicit_row radau3 = {
    .stages = 2, .a = {{5. / 12, -1. / 12}, {0.75, 0.25}}, .b = {0.75, 0.25}, ONE_STEP};
static const struct gm_implicit_row radau5 = {
    .stages = 3,
    .a = {{(88 - 7 * SQRT6) / 360, (296 - 169 * SQRT6) / 1800, (-2 + 3 * SQRT6) / 225},
          {(296 + 169 * SQRT6) / 1800, (88 + 7 * SQRT6) / 360, (-2 - 3 * SQRT6) / 225},
          {(16 - SQRT6) / 36, (16 + SQRT6) / 36, 1. / 9}},
    .b = {(16 - SQRT6) / 36, (16 + SQRT6) / 36, 1. / 9},
    ONE_STEP,
};
static const struct gm_implicit_row sdirk2 = {.stages = 2,
                                              .a = {{1 - SQRT2 / 2, 0}, {SQRT2 / 2, 1 - SQRT2 / 2}},
                                              .b = {SQRT2 / 2, 1 - SQRT2 / 2},
                                              ONE_STEP};

#define MIDPOINTS .stages = 1, .a = {{0.5}}, .b = {1}
static const struct gm_implicit_row rk4sym = {MIDPOINTS, .substeps = 3,
                                              .fractions = {GM_YOSHIDA4(GM_PALINDROME_3)}};
static const struct gm_implicit_row midpoint_suzuki4 = {MIDPOINTS, .substeps = 5,
                                                        .fractions = {GM_SUZUKI4(GM_PALINDROME_5)}};
static const struct gm_implicit_row midpoint_kahan_li6 = {MIDPOINTS, .substeps = 9,
                                                          .fractions = {GM_KAHAN_LI6(GM_PALINDROME_9)}};
static const struct gm_implicit_row midpoint_kahan_li8 = {MIDPOINTS, .substeps = 17,
                                                          .fractions = {GM_KAHAN_LI8(GM_PALINDROME_17)}};

#define IMPLICIT .family = &gm_family_implicit_runge_kutta
#define SYMPLECTIC_RK                                                                                        \
    (GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_QUADRATIC | GM_KEEPS_BILINEAR | GM_KEEPS_LINEAR)

static const struct gm_scheme schemes[] = {
    {
        .name = "implicit-euler",
        .title = "implicit Euler",
        .formula = "y₁ = y₀ + h f(y₁)",
        .reference = "A.-L. Cauchy, lectures of 1824; Hairer & Wanner, Solving ODEs II, IV.3",
        .coefficients = &implicit_euler,
        .order = 1,
        .claims = GM_KEEPS_LINEAR,
        IMPLICIT,
    },
    {
        .name = "midpoint",
        .title = "midpoint",
        .formula = "y₁ = y₀ + h f((y₀ + y₁)/2)",
        .reference = "Hairer, Lubich & Wanner (2006), I.1.2; Razafindralandy et al. (2018), eq. 25",
        .coefficients = &midpoint,
        .order = 2,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "trapezoidal",
        .title = "trapezoidal",
        .formula = "y₁ = y₀ + h/2 [f(y₀) + f(y₁)]",
        .reference =
            "Hairer, Lubich & Wanner (2006), VI.8: conjugate to the midpoint rule, not symplectic itself",
        .coefficients = &trapezoidal,
        .order = 2,
        .claims = GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_LINEAR,
        IMPLICIT,
    },
    {
        .name = "gauss4",
        .title = "Gauss 4",
        .formula = "Yᵢ = y₀ + h Σⱼ aᵢⱼ f(Yⱼ),  y₁ = y₀ + h/2 [f(Y₁) + f(Y₂)]\n"
                   "a = [1/4, 1/4 − √3/6; 1/4 + √3/6, 1/4]",
        .reference =
            "J. Kuntzmann (1961); J.C. Butcher, Math. Comp. 18 (1964) 50; symplectic: Sanz-Serna (1988)",
        .coefficients = &gauss4,
        .order = 4,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "gauss6",
        .title = "Gauss 6",
        .formula = "Yᵢ = y₀ + h Σⱼ aᵢⱼ f(Yⱼ),  y₁ = y₀ + h [5 f(Y₁) + 8 f(Y₂) + 5 f(Y₃)]/18,  3 Gauss nodes",
        .reference = "J.C. Butcher, Math. Comp. 18 (1964) 50; Hairer, Lubich & Wanner (2006), II.1.3",
        .coefficients = &gauss6,
        .order = 6,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "gauss8",
        .title = "Gauss 8",
        .formula = "Yᵢ = y₀ + h Σⱼ aᵢⱼ f(Yⱼ),  y₁ = y₀ + h Σᵢ bᵢ f(Yᵢ),  4 Gauss nodes",
        .reference = "J.C. Butcher, Math. Comp. 18 (1964) 50; Hairer, Lubich & Wanner (2006), II.1.3",
        .coefficients = &gauss8,
        .order = 8,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "rk4sym",
        .alias = "midpoint-yoshida4",
        .title = "RK4sym",
        .formula = "three midpoint steps of lengths bh, (1 − 2b)h, bh,  b = (2 + ∛2 + 1/∛2)/3",
        .reference = "Sanz-Serna & Abia, SIAM J. Numer. Anal. 28 (1991) 1081; "
                     "Razafindralandy et al. (2018), eq. 28 (its exponent 1/2 in b is a misprint for 1/3)",
        .coefficients = &rk4sym,
        .order = 4,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "midpoint-suzuki4",
        .title = "midpoint Suzuki 4",
        .formula = "five midpoint steps of lengths bh, bh, (1 − 4b)h, bh, bh,  b = 1/(4 − ∛4)",
        .reference = "M. Suzuki, Phys. Lett. A 146 (1990) 319; Hairer, Lubich & Wanner (2006), II.4.5",
        .coefficients = &midpoint_suzuki4,
        .order = 4,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "midpoint-kahan-li6",
        .title = "midpoint Kahan-Li 6",
        .formula = "nine midpoint steps of lengths γ₁h, …, γ₉h,  γ₁₀₋ᵢ = γᵢ",
        .reference = "W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089",
        .coefficients = &midpoint_kahan_li6,
        .order = 6,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "midpoint-kahan-li8",
        .title = "midpoint Kahan-Li 8",
        .formula = "seventeen midpoint steps of lengths γ₁h, …, γ₁₇h,  γ₁₈₋ᵢ = γᵢ",
        .reference = "W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089",
        .coefficients = &midpoint_kahan_li8,
        .order = 8,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
    {
        .name = "radau3",
        .title = "Radau IIA 3",
        .formula = "Y₁ = y₀ + h [5 f(Y₁) − f(y₁)]/12,  y₁ = y₀ + h [3 f(Y₁) + f(y₁)]/4",
        .reference = "B.L. Ehle (1969); Hairer & Wanner, Solving ODEs II, IV.5",
        .coefficients = &radau3,
        .order = 3,
        .claims = GM_KEEPS_LINEAR,
        IMPLICIT,
    },
    {
        .name = "radau5",
        .title = "Radau IIA 5",
        .formula = "Yᵢ = y₀ + h Σⱼ aᵢⱼ f(Yⱼ),  y₁ = Y₃,  nodes (4 ∓ √6)/10 and 1",
        .reference = "B.L. Ehle (1969); Hairer & Wanner, Solving ODEs II, IV.5",
        .coefficients = &radau5,
        .order = 5,
        .claims = GM_KEEPS_LINEAR,
        IMPLICIT,
    },
    {
        .name = "sdirk2",
        .title = "SDIRK 2",
        .formula = "Y₁ = y₀ + γh f(Y₁),  y₁ = y₀ + (1 − γ)h f(Y₁) + γh f(y₁),  γ = 1 − 1/√2",
        .reference = "R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006",
        .coefficients = &sdirk2,
        .order = 2,
        .claims = GM_KEEPS_LINEAR,
        IMPLICIT,
    },
};

const struct gm_family gm_family_implicit_runge_kutta = {
    .kind = &gm_kind_ode,
    .over_kernels = GM_OVER_IMPLICIT,
    .title = "implicit Runge-Kutta",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .parameters = gm_settings_of_sums,
    .loop = gm_implicit_any_loop,
    .carries_passive = true,
    .workspace_open = gm_implicit_any_open,
    .workspace_close = free,
};
