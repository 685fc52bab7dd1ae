/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FAMILIES_H
#define GM_CORE_FAMILIES_H

#include "core/scheme.h"

#define GM_FAMILY(name) extern const struct gm_family gm_family_##name;
#include "core/schemes.def"
#undef GM_FAMILY

/* The parameters of families that add increments: compensated. */
extern const struct gm_parameter *const gm_settings_of_sums[];
extern const struct gm_parameter *const gm_settings_of_tao[];              /* binding */
extern const struct gm_parameter *const gm_settings_of_variational_time[]; /* tau0 */
extern const struct gm_parameter *const gm_settings_of_gsl[];              /* tolerance */

#endif
