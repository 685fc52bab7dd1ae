/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search of the lists: of scenes and tours, and of schemes. */
#include "app/explorer/surface/search.h"

#include <ctype.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>

/* How a word stands in a text, the best first. */
enum { EXACT, PREFIX, WORD_START, ANYWHERE, NOWHERE };

static bool begins_with(const char *text, const char *word, size_t length)
{
    size_t i = 0;
    while (i < length && tolower((unsigned char)text[i]) == tolower((unsigned char)word[i])) {
        i++;
    }
    return i == length;
}

static int place_in(const char *text, const char *word, size_t length)
{
    int best = NOWHERE;
    for (const char *at = text; *at && best > WORD_START; at++) {
        if (begins_with(at, word, length)) {
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
            /* of equal places the one in the first text, which is the name, counts most */
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
