/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parameter trails= (trails.h). */
#include "scenes/common/trails.h"

#include <math.h>
#include <string.h>

#include "render/message.h"

const char *const gm_trails_words[] = {"yes", "no", NULL};

bool gm_trails_admit(const struct gm_parameter *row, const char *text, char *sentence)
{
    double length = 0;
    const bool is_word = strcmp(text, gm_trails_words[0]) == 0 || strcmp(text, gm_trails_words[1]) == 0;
    return is_word || (gm_number_parse(text, &length) && length > 0 && isfinite(length)) ||
           gm_refuse(sentence, "%s=%.60s is not yes, no or a time above 0", row->key, text);
}

size_t gm_trails_from(const char *text, const struct gm_entries *entries, double t)
{
    double length = INFINITY;
    size_t first = strcmp(text, gm_trails_words[1]) == 0 ? entries->count : 0;
    gm_number_parse(text, &length);
    while (first < entries->count && fabs(t - entries->times[first]) > length) {
        first++;
    }
    return first;
}
