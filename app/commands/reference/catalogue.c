/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What fits what, in words: shared by `list`, the manual, the pages and completion, so that they agree. */
#include "app/commands/reference/catalogue.h"

#include <stdio.h>
#include <string.h>

#include "core/schemes.h"

bool gm_catalogue_shares_name(const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *other = gm_scheme_at(i);
        if (other != scheme && strcmp(other->name, scheme->name) == 0) {
            return true;
        }
    }
    return false;
}

char *gm_catalogue_range(const struct gm_parameter *row, char *text, size_t size)
{
    char low[40], high[40];
    size_t used = 0;
    switch (row->type) {
    case GM_TEXT:
        snprintf(text, size, "a word");
        return text;
    case GM_BOOLEAN:
        snprintf(text, size, "no, yes");
        return text;
    case GM_CHOICE:
        for (size_t i = 0; row->choices[i] && used < size; i++) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", row->choices[i]);
        }
        return text;
    case GM_REAL:
    case GM_INTEGER:
        break;
    }
    snprintf(text, size, "%s to %s", gm_number_format(row->lowest, low, sizeof low),
             gm_number_format(row->highest, high, sizeof high));
    return text;
}

void gm_catalogue_letters(const struct gm_scheme *scheme, char *letters)
{
    size_t used = 0;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            letters[used++] = gm_claim_letter(bit)[0];
        }
    }
    letters[used] = '\0';
}
