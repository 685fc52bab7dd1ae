/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_SURFACE_SEARCH_H
#define GM_APP_EXPLORER_SURFACE_SEARCH_H

#include <stddef.h>

/* How well texts answer what was typed, capitals or not. */

/* The texts (the name first, NULL ends them) against the typed words: 0 at best, by the typed word that fares
   worst. A text that is the word is better than one that begins with it, then comes the beginning of a word
   in it, then any other place; below 0: a typed word is nowhere. */
enum { GM_SEARCH_TEXTS = 8 };
int gm_search_rank(const char *typed, const char *const *texts);
/* Puts a rank behind those from `first` to `count` that are as good, where there is room for one more.
   Returns its place. */
size_t gm_search_place(int *ranks, size_t first, size_t count, int rank);

#endif
