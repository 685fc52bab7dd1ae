/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system with the values that it has now, as the text of a file. */
#ifndef GM_APP_WORDS_CURRENT_VALUES_H
#define GM_APP_WORDS_CURRENT_VALUES_H

struct gm_scene;

/* The text of a system's scene with these values of its parameters and its start; malloc'ed, NULL: no
   memory. */
char *gm_system_now(const struct gm_scene *scene, const void *parameters);

#endif
