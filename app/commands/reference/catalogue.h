/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_REFERENCE_CATALOGUE_H
#define GM_APP_COMMANDS_REFERENCE_CATALOGUE_H

#include "scenes/common/lane.h"

/* What the tables say, in words: for `list`, the manual and completion. */

/* Whether there are further schemes of its name, for other kinds. */
bool gm_catalogue_shares_name(const struct gm_scheme *scheme);

/* What a parameter may be: "0 to 1", "light, dark", "a word". Returns text. */
char *gm_catalogue_range(const struct gm_parameter *row, char *text, size_t size);

/* The letters of a scheme's claims, "S=R"; needs GM_CLAIM_COUNT + 1 bytes. */
void gm_catalogue_letters(const struct gm_scheme *scheme, char *letters);

/* Schemes and scenes as the documentation has them, in Markdown, on standard output. */
void gm_catalogue_schemes_markdown(void);
void gm_catalogue_scenes_markdown(void);

#endif
