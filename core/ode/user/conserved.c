/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy, declared invariants, Casimirs and momentum maps, lets, and I1, I2, ..., those that are found and
   have no name. A quantity I is taken if its rate is 0 at all states,
       dI/dt = sum_i dI/dy_i f_i(y) = 0
   for the values of the parameters. */
#include "core/ode/user/data.h"
#include "core/ode/user/model.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/model/invariants.h"

enum { DEGREE = 4 }; /* up to which invariants are found */

struct naming {
    const struct gm_problem *problem;
    const struct gm_user_data *data;
    const char *name;
    struct gm_formula *graph;
    gm_node_id node; /* in `graph` */
    char *lacks;
    bool searched; /* for those without a name, of which there are `unnamed` */
    size_t unnamed;
};

_Noreturn __attribute__((format(printf, 3, 4))) static void
refuse(struct gm_arena *arena, const struct naming *naming, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(naming->lacks, GM_FAULT_SENTENCE, format, arguments);
    va_end(arguments);
    gm_arena_leave(arena);
}

/* The node in the system's graph; *trusted if its rate was found to be 0 when the system was read. */
static gm_node_id declared(const struct naming *naming, bool *trusted)
{
    const struct gm_user_system *system = naming->data->model->system;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (gm_system_is_observed(item) && strcmp(item->name, naming->name) == 0 &&
            gm_system_conserved(system, item) != GM_NO_NODE) {
            *trusted = !system->timed && (item->check == GM_ZERO_PROVED ||
                                          (item->check == GM_ZERO_TESTED && system->kind == GM_LAGRANGIAN));
            return gm_system_conserved(system, item);
        }
    }
    for (size_t i = 0; i < system->part_count; i++) {
        if (system->parts[i] && strcmp(system->parts[i], naming->name) == 0) {
            return (gm_node_id)i;
        }
    }
    if (strcmp(naming->name, "H") != 0 || (system->kind != GM_CANONICAL && system->kind != GM_POISSON)) {
        return GM_NO_NODE;
    }
    /* Hamilton's equations conserve it; no long proof of that is needed at every start of a run */
    *trusted = system->kind == GM_CANONICAL && !system->timed && !gm_ode_of(naming->problem)->forced;
    return system->energy;
}

/* A system and its invariants; the last searches of the process are kept. */
struct found {
    struct gm_arena *arena;
    struct gm_user_system *system;
    struct gm_found_invariants invariants;
};
enum { KEPT = 4 };
static struct found kept[KEPT];
static size_t next_kept;
static pthread_mutex_t turn = PTHREAD_MUTEX_INITIALIZER;

struct finding {
    struct found *found;
    const struct gm_user_data *data;
};

static void find(struct gm_arena *arena, void *data)
{
    const struct finding *finding = data;
    struct found *found = finding->found;
    found->system = gm_arena_take(arena, 1, sizeof *found->system);
    gm_arena_keep(arena, found->system, gm_system_close);
    gm_user_system_again(arena, finding->data->model->system, finding->data->values, false, found->system);
    gm_invariants_find(found->system, arena, DEGREE, &found->invariants);
}

/* Returns true if these are the invariants of that text with the same choices and parameters. */
static bool is_of(const struct found *found, const struct gm_user_data *data)
{
    const struct gm_user_system *one = found->system, *other = data->model->system;
    bool same = one && one->length == other->length && memcmp(one->source, other->source, one->length) == 0;
    for (size_t i = 0; same && i < one->choices.count; i++) {
        same = one->choices.list[i].chosen == other->choices.list[i].chosen;
    }
    for (size_t i = same ? one->parameters : 0; same && i < one->velocities; i++) {
        same = one->variables[i].value == data->values[i];
    }
    return same;
}

/* The invariants of the system with its values, during `turn`; NULL when out of memory. */
static const struct found *found_of(const struct gm_user_data *data)
{
    for (size_t i = 0; i < KEPT; i++) {
        if (is_of(&kept[i], data)) {
            return &kept[i];
        }
    }
    struct found *found = &kept[next_kept];
    next_kept = (next_kept + 1) % KEPT;
    gm_arena_close(found->arena);
    found->arena = gm_arena_made(find, &(struct finding){found, data});
    if (!found->arena) {
        *found = (struct found){0};
    }
    return found->arena ? found : NULL;
}

/* The node of number `number` among those without a name, in `graph`. */
static gm_node_id found(struct gm_arena *arena, struct naming *naming, size_t number)
{
    gm_node_id node = GM_NO_NODE;
    pthread_mutex_lock(&turn);
    const struct found *all = found_of(naming->data);
    for (size_t i = 0; all && i < all->invariants.count; i++) {
        const struct gm_found_invariant *invariant = &all->invariants.list[i];
        const bool unnamed = !invariant->item && !invariant->energy;
        naming->unnamed += unnamed;
        if (unnamed && naming->unnamed == number) {
            node = gm_formula_graft(naming->graph, &all->system->graph, invariant->node, all->system->n,
                                    naming->data->values);
        }
    }
    pthread_mutex_unlock(&turn);
    naming->searched = true;
    gm_arena_need(arena, all && (number > naming->unnamed || node != GM_NO_NODE));
    return node;
}

/* "H, L, and I1, I2, ...": the names that there are. */
static const char *names_of(struct gm_arena *arena, const struct gm_user_system *system)
{
    const char *names = system->kind <= GM_LAGRANGIAN || system->kind == GM_POISSON ? "H" : "";
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (gm_system_is_observed(item) && gm_system_conserved(system, item) != GM_NO_NODE && item->name[0]) {
            names = gm_arena_print(arena, "%s%s%.40s", names, names[0] ? ", " : "", item->name);
        }
    }
    return names;
}

/* Refuses a quantity unless its rate is 0 at all states. */
static void check_rate(struct gm_arena *arena, const struct naming *naming)
{
    const struct gm_user_model *model = naming->data->model;
    const double *values = naming->data->values;
    struct gm_formula *graph = naming->graph;
    const size_t n = naming->problem->n;
    if (model->system->kind == GM_LAGRANGIAN) {
        refuse(arena, naming,
               "an invariant %.40s that is proved, which is a line invariant: or symmetry:", naming->name);
    }
    gm_node_id *rates = gm_arena_take(arena, n, sizeof *rates);
    for (size_t i = 0; i < n; i++) {
        rates[i] = gm_formula_graft(graph, &model->system->graph, model->rates->nodes[i], n, values);
        gm_arena_need(arena, rates[i] != GM_NO_NODE);
    }
    const gm_node_id rate = gm_derivative_along(graph, naming->node, rates, n);
    gm_arena_need(arena, rate != GM_NO_NODE);
    const enum gm_identity identity = gm_identity_of(graph, rate, NULL, 0);
    if (identity != GM_ZERO_PROVED && identity != GM_ZERO_TESTED) {
        double *all = gm_arena_take(arena, graph->count, sizeof *all);
        gm_formula_evaluate(graph, graph->count, values, all);
        refuse(arena, naming,
               all[rate] == 0 ? "a constant %.40s (its rate is 0 at the start alone)"
                              : "a constant %.40s (its rate at the start is %.6g)",
               naming->name, all[rate]);
    }
}

static void resolve(struct gm_arena *arena, void *data)
{
    struct naming *naming = data;
    const struct gm_user_system *system = naming->data->model->system;
    const char *word = gm_found_word(system);
    const size_t letters = strlen(word);
    bool trusted = false;
    char after;
    size_t number = 0;
    const gm_node_id node = declared(naming, &trusted);
    if (system->tangents > 0) {
        refuse(arena, naming, "a motion without tangents, which a correction does not carry along");
    }
    if (node != GM_NO_NODE) {
        naming->node =
            gm_formula_graft(naming->graph, &system->graph, node, naming->problem->n, naming->data->values);
        gm_arena_need(arena, naming->node != GM_NO_NODE);
    } else if (strncmp(naming->name, word, letters) == 0 &&
               sscanf(naming->name + letters, "%zu%c", &number, &after) == 1 && number > 0) {
        naming->node = found(arena, naming, number);
    }
    if (naming->node == GM_NO_NODE) {
        const char *names = names_of(arena, system);
        const char *others =
            !naming->searched
                ? gm_arena_print(arena, " those that list --invariants finds: %s1, %s2, ...", word, word)
            : naming->unnamed > 0 ? gm_arena_print(arena, " %s1 to %s%zu", word, word, naming->unnamed)
                                  : " list --invariants finds no other";
        refuse(arena, naming, "an invariant %.40s (there are %.160s%s%s)", naming->name, names,
               names[0] ? ", and" : "only", others);
    }
    if (!trusted) {
        check_rate(arena, naming);
    }
}

gm_node_id gm_user_conserved(const struct gm_problem *problem, const char *name, struct gm_formula *graph,
                             char *lacks)
{
    struct naming naming = {problem, gm_user_data_of(problem), name, graph, GM_NO_NODE, lacks, false, 0};
    lacks[0] = '\0';
    return gm_arena_run_once(resolve, &naming) ? naming.node : GM_NO_NODE;
}
