/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions common to all keys, and the search. */
#include "app/explorer/surface/surface.h"

#include <ctype.h>
#include <curses.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>

enum { ESCAPE = 27 };

bool gm_key_is_enter(int key)
{
    return key == '\n' || key == '\r' || key == KEY_ENTER;
}

bool gm_key_is_erase(int key)
{
    return key == KEY_BACKSPACE || key == 127 || key == 8;
}

bool gm_key_is_escape(int key)
{
    return key == ESCAPE;
}

bool gm_typed_key(char *typed, int key)
{
    size_t length = strlen(typed);
    if (gm_key_is_erase(key)) {
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

enum gm_key_result gm_keystroke_order(const struct gm_keystroke *press, struct gm_order order)
{
    gm_worker_order(press->worker, order);
    return GM_KEY_DONE;
}

enum gm_key_result gm_keystroke_page(const struct gm_keystroke *press, enum gm_page page,
                                     const struct gm_scheme *scheme)
{
    press->face->page = page;
    press->face->explained = scheme;
    press->face->scroll = 0;
    return GM_KEY_DONE;
}

/* ---- searching ---- */

/* The place of a word in a text, the best first. */
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
