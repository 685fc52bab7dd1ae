/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implicit Runge-Kutta methods:  z_i = h sum_j a_ij f(y + z_j),  y' = y + h sum_i b_i f(y + z_i),
   solved for the increments z to round-off: by fixed-point iteration, and where that does not contract, or
   the problem is stiff, by Newton's method. A method is symplectic if b_i a_ij + b_j a_ji = b_i b_j. Hairer,
   Lubich & Wanner, Geometric Numerical Integration (2006), sections II.1, VI.4, VIII.6. */
#include "core/families/implicit_runge_kutta.h"

#include "core/families/families.h"

#define SQRT3 1.7320508075688772935274463415058724
/* b of the symmetric triple jump, 1 / (2 - 2^(1/3)) = (2 + 2^(1/3) + 2^(-1/3)) / 3 */
#define TRIPLE_JUMP 1.3512071919596576340476878089715

#define ONE_STEP .substeps = 1, .fractions = {1}

static const struct gm_implicit_row implicit_euler = {.stages = 1, .a = {{1}}, .b = {1}, ONE_STEP};
static const struct gm_implicit_row midpoint = {.stages = 1, .a = {{0.5}}, .b = {1}, ONE_STEP};
static const struct gm_implicit_row trapezoidal = {
    .stages = 2, .a = {{0, 0}, {0.5, 0.5}}, .b = {0.5, 0.5}, ONE_STEP};
static const struct gm_implicit_row gauss4 = {
    .stages = 2, .a = {{0.25, 0.25 - SQRT3 / 6}, {0.25 + SQRT3 / 6, 0.25}}, .b = {0.5, 0.5}, ONE_STEP};
static const struct gm_implicit_row rk4sym = {.stages = 1,
                                              .a = {{0.5}},
                                              .b = {1},
                                              .substeps = 3,
                                              .fractions = {TRIPLE_JUMP, 1 - 2 * TRIPLE_JUMP, TRIPLE_JUMP}};

#define IMPLICIT .family = &gm_family_implicit_runge_kutta, .needs = GM_NEEDS_ODE
#define SYMPLECTIC_RK (GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_QUADRATIC | GM_KEEPS_LINEAR)

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
        .name = "rk4sym",
        .title = "RK4sym",
        .formula = "three midpoint steps of lengths bh, (1 − 2b)h, bh,  b = (2 + ∛2 + 1/∛2)/3",
        .reference = "Sanz-Serna & Abia, SIAM J. Numer. Anal. 28 (1991) 1081; "
                     "Razafindralandy et al. (2018), eq. 28 (its exponent 1/2 in b is a misprint for 1/3)",
        .coefficients = &rk4sym,
        .order = 4,
        .claims = SYMPLECTIC_RK,
        IMPLICIT,
    },
};

const struct gm_family gm_family_implicit_runge_kutta = {
    .id = GM_FAMILY_implicit_runge_kutta,
    .title = "implicit Runge-Kutta",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .parameters = gm_settings_of_sums,
};
