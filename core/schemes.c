/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of problems and, through them, all schemes. */
#include "core/schemes.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

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

const char *gm_scheme_known_as(const char *word)
{
    static const char *const names[][2] = {
        {"leapfrog", "verlet"},
        {"velocity-verlet", "verlet"},
        {"stormer-verlet", "verlet"},
        {"kick-drift-kick", "verlet"},
        {"position-verlet", "verlet-position"},
        {"drift-kick-drift", "verlet-position"},
        {"euler", "explicit-euler"},
        {"forward-euler", "explicit-euler"},
        {"backward-euler", "implicit-euler"},
        {"semi-implicit-euler", "symplectic-euler"},
        {"euler-cromer", "symplectic-euler"},
        {"implicit-midpoint", "midpoint"},
        {"implicit-trapezoidal", "trapezoidal"},
        {"crank-nicolson", "trapezoidal"},
        {"heun", "rk2"},
        {"runge-kutta", "rk4"},
        {"preissmann", "box"},
    };
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        if (strcmp(names[i][0], word) == 0) {
            return names[i][1];
        }
    }
    return NULL;
}

static const char *name_at(size_t i, const void *data)
{
    return (void)data, gm_scheme_at(i)->name;
}

const char *gm_scheme_near(const char *word)
{
    const char *known = gm_scheme_known_as(word);
    return known ? known : gm_nearest(word, gm_scheme_count(), name_at, NULL);
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
        found = named && (!problem || gm_scheme_fits(scheme, problem)) ? scheme : NULL;
    }
    pthread_mutex_unlock(&brought.lock);
    return found;
}

static bool is_called(const struct gm_scheme *scheme, const char *name)
{
    bool called = strcmp(scheme->name, name) == 0;
    for (size_t i = 0; i < GM_COUNT(scheme->alias) && scheme->alias[i]; i++) {
        called |= strcmp(scheme->alias[i], name) == 0;
    }
    return called;
}

const struct gm_scheme *gm_scheme_find(const char *name)
{
    const struct gm_scheme *scheme;
    for (size_t i = 0; (scheme = gm_scheme_at(i)); i++) {
        if (is_called(scheme, name)) {
            return scheme;
        }
    }
    return find_brought(name, NULL);
}

const struct gm_scheme *gm_scheme_find_for(const char *name, const struct gm_problem *problem)
{
    const struct gm_scheme *found = gm_scheme_find(name);
    if (found && found->word) {
        const struct gm_scheme *fitting = find_brought(name, problem);
        return fitting ? fitting : found;
    }
    for (size_t i = 0; found && i < gm_scheme_count() && !gm_scheme_fits(found, problem); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (strcmp(scheme->name, found->name) == 0 && gm_scheme_fits(scheme, problem)) {
            return scheme;
        }
    }
    return found;
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
