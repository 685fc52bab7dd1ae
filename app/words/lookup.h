/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names of scenes, systems and rooms. */
#ifndef GM_APP_WORDS_LOOKUP_H
#define GM_APP_WORDS_LOOKUP_H

#include <stdbool.h>

/* Proposes for a word that is no name the nearest name of a scene, a system or a room, in `near`. False: none is near;
   the message then says which folder of the environment could not be opened, "" where all can. */
enum { GM_NEAR = 64 };
bool gm_system_near(const char *word, char near[GM_NEAR], char *message);

#endif
