/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boxes of waves, u_tt - u_xx + V'(u) = 0, by the collocation of any form (any_form.c). */
#include "core/basics.h"
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/families.h"

static double wave_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    return (s[1] * s[1] + slope[0] * slope[0]) / 2 + gm_field_of(problem)->wave->potential(problem, s[0]);
}

static double wave_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *remembered)
{
    return (void)y, gm_any_form_integral(problem, scheme, remembered, wave_density);
}

static const struct gm_scheme schemes[] = {
    {
        .name = "gauss-box3",
        .title = "Gauss box, r = s = 2",
        .formula = "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1)]/Δx,  two stages of Gauss in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473; the order is that of the stages",
        .family = &gm_family_gauss,
        .coefficients = &gm_collocation_gauss4,
        .order = 3,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
};

const struct gm_family gm_family_gauss = {
    .kind = &gm_kind_field,
    .title = "multisymplectic Gauss collocation",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = gm_any_form_advance,
    .memory = gm_any_form_memory,
    .start = gm_any_form_start,
    .workspace_open = gm_collocation_open,
    .workspace_close = gm_collocation_close,
    .form = gm_any_form_law,
    .wave_energy = wave_energy,
};
