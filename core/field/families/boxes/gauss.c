/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boxes of waves, u_tt - u_xx + V'(u) = 0, by the collocation of any form (any_form.c). */
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/family.h"

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
    {GM_TEXTS_gauss_box3_of_waves, .family = &gm_family_gauss, .needs = GM_NEEDS_WAVE,
     .coefficients = &gm_collocation_gauss4},
};

const struct gm_family gm_family_gauss = {
    .title = "multisymplectic Gauss collocation",
    GM_FIELD_FAMILY,
    .loop = gm_any_form_advance,
    .memory = gm_any_form_memory,
    .start = gm_any_form_start,
    .workspace_open = gm_any_form_open,
    .workspace_close = gm_any_form_close,
    .form = gm_any_form_law,
    .wave_energy = wave_energy,
};
