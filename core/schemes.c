/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of problems and, through them, all schemes. */
#include "core/schemes.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/aliases.h"
#include "core/expression/nearest.h"

#define GM_KIND(name) extern const struct gm_kind gm_kind_##name;
#include "core/basics.h"
#include "core/kinds.def"
#undef GM_KIND

static const struct gm_kind *const kinds[] = {
#define GM_KIND(name) &gm_kind_##name,
#include "core/kinds.def"
#undef GM_KIND
};
enum { KINDS = GM_COUNT(kinds) };

size_t gm_scheme_count(void)
{
    size_t count = 0;
    for (size_t i = 0; i < KINDS; i++) {
        for (const struct gm_family *const *family = kinds[i]->families; *family; family++) {
            count += (*family)->count;
        }
    }
    return count;
}

const struct gm_scheme *gm_scheme_at(size_t index)
{
    for (size_t i = 0; i < KINDS; i++) {
        for (const struct gm_family *const *family = kinds[i]->families; *family; family++) {
            if (index < (*family)->count) {
                return &(*family)->schemes[index];
            }
            index -= (*family)->count;
        }
    }
    return NULL;
}

/* Scheme i of a list; NULL: of all. */
static const struct gm_scheme *scheme_of(const struct gm_scheme *const *list, size_t i)
{
    return list ? list[i] : gm_scheme_at(i);
}

static const char *name_of(size_t i, const void *list)
{
    return scheme_of(list, i)->name;
}

static bool is_known_as(const struct gm_scheme *scheme, const char *word)
{
    bool known = gm_word_is_part(word, scheme->name) || gm_word_is_part(word, scheme->title);
    const char *alias;
    for (size_t i = 0; !known && (alias = gm_alias_of(scheme->name, i)); i++) {
        known = gm_word_is_part(word, alias);
    }
    return known;
}

const char *gm_scheme_near(const char *word, const struct gm_scheme *const *among, size_t count)
{
    const struct gm_near *row = gm_near_find(GM_NEAR_SCHEME, word, 0);
    count = among ? count : gm_scheme_count();
    for (size_t i = 0; row && i < count; i++) {
        if (strcmp(scheme_of(among, i)->name, row->meant) == 0) {
            return row->meant;
        }
    }
    const char *near = gm_nearest(word, count, name_of, among);
    for (size_t i = 0; !near && i < count; i++) {
        near = is_known_as(scheme_of(among, i), word) ? scheme_of(among, i)->name : NULL;
    }
    return near;
}

/* The user-defined schemes, which any thread may add. */
static struct {
    pthread_mutex_t lock;
    const struct gm_scheme **schemes;
    size_t count;
} brought = {.lock = PTHREAD_MUTEX_INITIALIZER};

bool gm_scheme_bring(const struct gm_scheme *scheme)
{
    pthread_mutex_lock(&brought.lock);
    const struct gm_scheme **more = realloc(brought.schemes, (brought.count + 1) * sizeof(*more));
    if (more) {
        brought.schemes = more;
        more[brought.count++] = scheme;
    }
    pthread_mutex_unlock(&brought.lock);
    return more != NULL;
}

const char *gm_scheme_word(const struct gm_scheme *scheme)
{
    return scheme->word ? scheme->word : scheme->name;
}

/* The last one of that name that fits; problem NULL: the last one. */
static const struct gm_scheme *find_brought(const char *name, const struct gm_problem *problem)
{
    const struct gm_scheme *found = NULL;
    pthread_mutex_lock(&brought.lock);
    for (size_t i = brought.count; i-- > 0 && !found;) {
        const struct gm_scheme *scheme = brought.schemes[i];
        const bool named = strcmp(scheme->name, name) == 0 || strcmp(scheme->word, name) == 0;
        const struct gm_scheme *other = problem ? scheme->by_names : NULL;
        found = !named                                        ? NULL
                : !problem || gm_scheme_fits(scheme, problem) ? scheme
                : other && gm_scheme_fits(other, problem)     ? other
                                                              : NULL;
    }
    pthread_mutex_unlock(&brought.lock);
    return found;
}

/* The first scheme of the program with that name, by a comparison of strings, that fits; problem NULL: the
   first one. */
static const struct gm_scheme *find_row(const char *name, int (*compare)(const char *a, const char *b),
                                        const struct gm_problem *problem)
{
    const struct gm_scheme *scheme;
    size_t i = 0;
    while ((scheme = gm_scheme_at(i)) &&
           (compare(scheme->name, name) != 0 || (problem && !gm_scheme_fits(scheme, problem)))) {
        i++;
    }
    return scheme;
}

const struct gm_scheme *gm_scheme_find(const char *name)
{
    const struct gm_scheme *scheme = find_row(name, strcmp, NULL);
    scheme = scheme ? scheme : find_brought(name, NULL);
    const char *meaning = scheme ? NULL : gm_alias_meaning(name);
    scheme = meaning ? find_row(meaning, strcmp, NULL) : scheme;
    return scheme ? scheme : find_row(name, strcasecmp, NULL);
}

const struct gm_scheme *gm_scheme_find_for(const char *name, const struct gm_problem *problem)
{
    const struct gm_scheme *found = gm_scheme_find(name), *fitting = NULL;
    if (found) {
        fitting = found->word ? find_brought(name, problem) : find_row(found->name, strcmp, problem);
    }
    const char *meaning = found && !fitting ? gm_alias_meaning(name) : NULL;
    fitting = meaning ? find_row(meaning, strcmp, problem) : fitting;
    return fitting ? fitting : found;
}

/* Schemes that a user wrote are compared with none. */
const struct gm_scheme *gm_scheme_same_as(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    for (const struct gm_same *row = problem->kind->same; row && row->scheme && !scheme->word; row++) {
        const bool named = strcmp(row->scheme, scheme->name) == 0;
        const struct gm_scheme *other = named ? gm_scheme_find_for(row->other, problem) : NULL;
        if (other && gm_scheme_fits(scheme, problem) && gm_scheme_fits(other, problem) &&
            row->holds(problem)) {
            return other;
        }
    }
    return NULL;
}
