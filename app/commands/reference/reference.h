/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_COMMANDS_REFERENCE_REFERENCE_H
#define GM_APP_COMMANDS_REFERENCE_REFERENCE_H

#include "core/theory/theory.h"
#include "scenes/common/lane.h"

/* The tables in words, for `list`, the manual, the pages and completion. */

/* The range of a parameter: "0 to 1", "light, dark", "a word". Returns text. */
char *gm_catalogue_range(const struct gm_parameter *row, char *text, size_t size);

/* The letters of a scheme's claims, "S=R"; needs GM_CLAIM_COUNT + 1 bytes. */
void gm_catalogue_letters(const struct gm_scheme *scheme, char *letters);

/* The words of claims, "symplectic, symmetric", each after its letter if `letters`; "none" without claims. Returns
   text. */
char *gm_catalogue_claims(unsigned claims, bool letters, char *text, size_t size);

/* Schemes and scenes as the documentation has them, in Markdown, on standard output. */
void gm_catalogue_schemes_markdown(void);
void gm_catalogue_scenes_markdown(void);

/* Prints the theory of a scheme to standard output, as lines that begin with `indent`. */
void gm_theory_print(const struct gm_theory *theory, const char *indent);

/* --version: the program and the libraries. Returns the exit status. */
int gm_version(void);

#endif
