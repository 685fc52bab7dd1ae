/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Typed words, and the search. */
#include "app/explorer/surface/surface.h"

#include <ctype.h>
#include <curses.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>

#include "core/basics.h"

bool gm_typed_key(char *typed, int key)
{
    size_t length = strlen(typed);
    if (key == KEY_BACKSPACE) {
        typed[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key < ' ' || key > '~' || length + 1 >= GM_TYPED) {
        return key >= ' ' && key <= '~';
    }
    typed[length] = (char)key;
    typed[length + 1] = '\0';
    return true;
}

/* ---- searching ---- */

/* The place of a word in a text, the best first. */
enum { EXACT, PREFIX, WORD_START, ANYWHERE, NOWHERE };

static int place_in(const char *text, const char *word, size_t length)
{
    int best = NOWHERE;
    for (const char *at = text; *at && best > WORD_START; at++) {
        if (strncasecmp(at, word, length) == 0) {
            const bool start = at == text || !isalnum((unsigned char)at[-1]);
            best = at == text ? (at[length] ? PREFIX : EXACT) : start ? WORD_START : ANYWHERE;
        }
    }
    return best;
}

int gm_search_rank(const char *typed, const char *const *texts)
{
    int worst = 0;
    while (*typed) {
        const size_t length = strcspn(typed, " ");
        int best = length == 0 ? 0 : INT_MAX;
        for (int i = 0; length > 0 && texts[i]; i++) {
            const int place = place_in(texts[i], typed, length);
            /* among equal places the first text, the name, ranks first */
            const int rank = place == NOWHERE ? INT_MAX : place * GM_SEARCH_TEXTS + i;
            best = rank < best ? rank : best;
        }
        worst = best > worst ? best : worst;
        typed += length + (typed[length] == ' ');
    }
    return worst == INT_MAX ? -1 : worst;
}

size_t gm_search_place(int *ranks, size_t first, size_t count, int rank)
{
    size_t at = count;
    for (; at > first && ranks[at - 1] > rank; at--) {
        ranks[at] = ranks[at - 1];
    }
    ranks[at] = rank;
    return at;
}
