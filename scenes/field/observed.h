/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_OBSERVED_H
#define GM_SCENES_FIELD_OBSERVED_H

#include "scenes/field/field.h"

/* Residuals of the local laws of a field (enum gm_local_law), as observables, the largest over the grid, and
   over space and time instead of the field. */

double gm_view_energy_residual(const struct gm_view *view);
double gm_view_momentum_residual(const struct gm_view *view);
double gm_view_content_residual(const struct gm_view *view);

/* clang-format off */
#define GM_LOCAL_LAWS                                                                                        \
    GM_LOG_OBSERVABLE("local_energy_residual", gm_view_energy_residual, "residual of the local energy law",  \
                      .missing = GM_NO_LAW),                                                                 \
    GM_LOG_OBSERVABLE("local_momentum_residual", gm_view_momentum_residual,                                  \
                      "residual of the local momentum law", .missing = GM_NO_LAW)
/* clang-format on */

/* The row of a parameter table that chooses between the field and a law, in an `int` of the scene's own
   struct; `list` has "field", "energy-law", "momentum-law" and possibly the law of mass or charge. */
#define GM_LAW_ROW(own, member, list)                                                                        \
    GM_CHOICE_ROW(own, member, "show", "field", list,                                                        \
                  "what is drawn over space and time: the field, or what each step leaves of a local law")

/* Fills a row of the surface: u, or the residual that `show` chooses. NaN if the scheme has no such law. */
void gm_surface_record_shown(const struct gm_view *view, int show,
                             double (*value)(const struct gm_view *, size_t), double *entry);

/* The common part of scenes of u_tt = u_xx - V'(u): rows of observables, and the schemes. */

double gm_view_energy(const struct gm_view *view);
double gm_view_own_energy(const struct gm_view *view);
double gm_view_momentum(const struct gm_view *view);
double gm_view_amplitude(const struct gm_view *view);
double gm_unit_momentum(const struct gm_view *view);

/* The energy of nodes compares schemes but does not judge them: for boxes it has an error of the grid.
   own_energy_error is a scheme's own loss. */
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
