/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_RANGE_H
#define GM_APP_WORDS_RANGE_H

#include <stdbool.h>
#include <stddef.h>

/* Values between two ends, both included: "0..0.9:10" evenly, "1e-4..1e-1:log7" by equal factors. */

struct gm_range {
    double first, last; /* first < last; of equal factors: of one sign */
    size_t count;       /* at least 2, at most 1e15 */
    bool logarithmic;
};

/* How long the first value of a list, or of a range, is: the sum in sum(i = 1 .. 3, q[i]) is one. */
size_t gm_word_first(const char *value);

/* Whether a text is to be read as a range: ".." is read before numbers. */
bool gm_range_is(const char *text);

/* Reads "END..END:COUNT" or "END..END:logCOUNT", the ends numbers as gm_number_parse takes them. False with a
   sentence (GM_MESSAGE bytes) that names the key. `whole`: its values have to be whole numbers. */
bool gm_range_read(struct gm_range *range, const char *key, const char *text, bool whole, char *message);

/* Value `index`, 0 <= index < count. The ends are as typed; between them 0.3 is what "0.3" is read as, not
   its neighbour, and values by equal factors have 15 digits: so what is printed is what one would type. */
double gm_range_at(const struct gm_range *range, size_t index);

#endif
