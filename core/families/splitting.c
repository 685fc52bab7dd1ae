/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splitting methods for H(q, p) = T(p) + V(q): compositions of the exact flows
       drift  q := q + c h dT/dp(p),      kick  p := p - c h dV/dq(q).
   Each flow is symplectic, so is every composition.
   McLachlan & Quispel, Acta Numerica 11 (2002) 341; Hairer, Lubich & Wanner (2006), section II.5. */
#include "core/families/splitting.h"

#include "core/families/families.h"

#define DRIFT(c)                                                                                             \
    {                                                                                                        \
        GM_DRIFT, c                                                                                          \
    }
#define KICK(c)                                                                                              \
    {                                                                                                        \
        GM_KICK, c                                                                                           \
    }

static const struct gm_splitting symplectic_euler = {2, {KICK(1), DRIFT(1)}};
static const struct gm_splitting symplectic_euler_adjoint = {2, {DRIFT(1), KICK(1)}};
static const struct gm_splitting verlet = {3, {KICK(0.5), DRIFT(1), KICK(0.5)}};

#define SPLITTING .family = &gm_family_splitting, .needs = GM_NEEDS_ODE | GM_NEEDS_SPLIT

static const struct gm_scheme schemes[] = {
    {
        .name = "symplectic-euler",
        .title = "symplectic Euler",
        .formula = "p₁ = p₀ − h ∂H/∂q(q₀),  q₁ = q₀ + h ∂H/∂p(p₁)",
        .reference = "R. de Vogelaere (1956); Razafindralandy et al. (2018), eq. 24",
        .coefficients = &symplectic_euler,
        .order = 1,
        .claims = GM_SYMPLECTIC | GM_KEEPS_LINEAR,
        SPLITTING,
    },
    {
        .name = "symplectic-euler-adjoint",
        .title = "symplectic Euler (adjoint)",
        .formula = "q₁ = q₀ + h ∂H/∂p(p₀),  p₁ = p₀ − h ∂H/∂q(q₁)",
        .reference = "Hairer, Lubich & Wanner (2006), VI.3",
        .coefficients = &symplectic_euler_adjoint,
        .order = 1,
        .claims = GM_SYMPLECTIC | GM_KEEPS_LINEAR,
        SPLITTING,
    },
    {
        .name = "verlet",
        .title = "Verlet",
        .formula = "p½ = p₀ − h/2 ∂V(q₀),  q₁ = q₀ + h ∂T(p½),  p₁ = p½ − h/2 ∂V(q₁)",
        .reference = "L. Verlet, Phys. Rev. 159 (1967) 98; C. Størmer (1907)",
        .coefficients = &verlet,
        .order = 2,
        .claims = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_LINEAR,
        SPLITTING,
    },
};

const struct gm_family gm_family_splitting = {
    .id = GM_FAMILY_splitting,
    .title = "splitting",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .parameters = gm_settings_of_sums,
};
