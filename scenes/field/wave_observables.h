/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_WAVE_OBSERVABLES_H
#define GM_SCENES_FIELD_WAVE_OBSERVABLES_H

#include "scenes/field/local_laws.h"

/* What scenes of u_tt = u_xx - V'(u) have in common: rows of observables, and the schemes. */

double gm_view_energy(const struct gm_view *view);
double gm_view_own_energy(const struct gm_view *view);
double gm_view_momentum(const struct gm_view *view);
double gm_view_amplitude(const struct gm_view *view);
double gm_unit_momentum(const void *parameters);

/* The energy of nodes compares schemes and is no verdict: in boxes the grid errs in it. What a scheme loses is of its
   own. */
/* clang-format off */
#define GM_WAVE_INVARIANTS                                                                                   \
    GM_LOG_OBSERVABLE("energy_error", gm_view_energy, "energy error", .error = true, .symbol = "H"),         \
    GM_KEPT_OBSERVABLE("own_energy_error", gm_view_own_energy, "H", "error of the scheme’s own energy",      \
                       .missing = "the scheme has no energy of its own"),                                    \
    GM_KEPT_OBSERVABLE("momentum_error", gm_view_momentum, "P", "momentum error",                            \
                       .scale = gm_unit_momentum, .scale_text = "1",                                         \
                       .missing = "walls take up momentum")
#define GM_WAVE_LAWS                                                                                         \
    GM_OBSERVABLE("amplitude", gm_view_amplitude, "largest |u|"),                                            \
    GM_LOCAL_LAWS,                                                                                           \
    GM_FORM_RESIDUAL
/* clang-format on */

extern const char *const gm_wave_schemes[]; /* NULL-terminated */

#endif
