/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The known word nearest to an unknown one. */
#include "core/expression/nearest.h"

#include <string.h>
#include <strings.h>

enum { LONGEST = 63, SHORT = 3 };

/* Levenshtein's distance; transposed neighbours count as one. */
static size_t distance(const char *a, const char *b)
{
    const size_t m = strlen(a), n = strlen(b);
    if (m > LONGEST || n > LONGEST) {
        return m > n ? m : n;
    }
    size_t rows[3][LONGEST + 1];
    size_t *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= n; j++) {
        above[j] = j;
    }
    for (size_t i = 1; i <= m; i++) {
        row[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t best = above[j - 1] + (a[i - 1] != b[j - 1]);
            best = above[j] + 1 < best ? above[j] + 1 : best;
            best = row[j - 1] + 1 < best ? row[j - 1] + 1 : best;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < best) {
                best = before[j - 2] + 1;
            }
            row[j] = best;
        }
        size_t *spare = before;
        before = above;
        above = row;
        row = spare;
    }
    return above[n];
}

/* True if the word begins like the name and its letters occur in the name in this order: "ecty". */
static bool abbreviates(const char *word, const char *name)
{
    const char *letter = word;
    for (const char *at = name; *at && *letter; at++) {
        letter += *at == *letter;
    }
    return *letter == '\0' && word[0] == name[0] && strlen(word) > 1;
}

const char *gm_nearest(const char *word, size_t count, const char *(*candidate)(size_t i, const void *data),
                       const void *data)
{
    const size_t length = strlen(word), slips = (length + 1) / 3;
    const char *same = NULL, *begun = NULL, *shortened = NULL, *slipped = NULL;
    size_t smallest = slips + 1;
    for (size_t i = 0; length > 0 && i < count; i++) {
        const char *name = candidate(i, data);
        const size_t away = distance(word, name);
        if (strcasecmp(name, word) == 0) { /* equal but for case */
            same = name;
        }
        if (!begun && strncmp(name, word, length) == 0) {
            begun = name;
        }
        if (abbreviates(word, name) && (!shortened || strlen(name) < strlen(shortened))) {
            shortened = name;
        }
        if (away < smallest) {
            slipped = name;
            smallest = away;
        }
    }
    const bool close = smallest == 1 && length > SHORT; /* "verlett" */
    return same ? same : begun ? begun : close ? slipped : shortened ? shortened : slipped;
}

bool gm_word_is_part(const char *word, const char *text)
{
    return strlen(word) > 2 && strcasestr(text, word);
}
