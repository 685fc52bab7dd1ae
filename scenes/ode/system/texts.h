/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of a system's file with values in them: {x}, {dt:pi}, {schemes}. */
#ifndef GM_SCENES_ODE_SYSTEM_TEXTS_H
#define GM_SCENES_ODE_SYSTEM_TEXTS_H

#include "scenes/ode/system/look.h"

/* Opens the tapes of texts, requirements and levels. False with a sentence. */
bool gm_system_open_items(struct gm_system_scene *system_scene, char *sentence);

/* The text of a line in a picture of lanes; `otherwise` if the file has no such line. Of a subtitle the parts that
   semicolons separate are left out where they differ between lanes. */
const char *gm_system_shown_text(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                                 enum gm_system_word word, const char *otherwise);
/* Whether the file's text names the schemes itself. */
bool gm_system_names_schemes(const struct gm_system_scene *system_scene, enum gm_system_word word);

/* Whether these values of all variables at the start, of which `lane` has the keys, fulfil every require:. A sentence
   if they do not. */
bool gm_system_is_admitted(const struct gm_system_lane *lane, const double *values, char *sentence);

#endif
