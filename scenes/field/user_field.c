/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined field as a scene, of six kinds:
       u_tt = u_xx - V'(u),   H = integral of u_t^2/2 + u_x^2/2 + V(u),   on a ring or between walls,
       the same between ends that hold u, on a moving mesh,
       (M u)_t = R(u, u_x, ..),   of one field or several,
       equations of Korteweg and de Vries, of Schroedinger, of heat and of Burgers, recognised by such rates, with
       the states of the schemes for them,
       K z_t + L z_x = grad S(z).
   A kind is a row: its keys, problem, start, observables and picture. Parameters of the file are keys, with
   the ring and its grid; its conserved and observed quantities are integrals of densities. The scene is made
   while the program runs, and does not change afterwards. */
#include "core/functions/functions.h"
#include "scenes/field/kind.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/memory.h"
#include "core/model/equations.h"
#include "core/model/scope.h"
#include "core/schemes.h"
#include "core/tape.h"
#include "scenes/common/system/hook.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/common/system/variants.h"
#include "scenes/common/written.h"
#include "scenes/field/user_field.h"
#include "scenes/mesh/observed.h"

enum { DT, UNTIL };
enum { MOST_DENSITIES = 32, MOST_OBSERVABLES = 48, MOST_ROWS = 8 };

/* Refuses a name of the file that keys have, or formulas of a moving mesh, where it would mean nothing. */
static void check_name(struct gm_arena *arena, const struct gm_field_kind *kind, const char *name,
                       const char *what)
{
    static const char *const in_formulas[] = {"steepest", "bend", "X"};
    bool taken = false;
    for (size_t k = 0; k < kind->row_count; k++) {
        taken |= strcmp(kind->rows[k].key, name) == 0;
    }
    for (size_t w = 0; kind->moves && w < GM_COUNT(in_formulas); w++) {
        taken |= strcmp(in_formulas[w], name) == 0;
    }
    if (taken) {
        gm_arena_refuse(arena, "%.60s is a key of moving meshes: a %s needs another name", name, what);
    }
}

static void make_rows(struct gm_user_field *field)
{
    static const enum gm_system_word chosen[] = {GM_WORD_SPACE, GM_WORD_BOUNDARY, GM_WORD_DENSITY,
                                                 GM_WORD_MESH,  GM_WORD_RELAX,    GM_WORD_CELL,
                                                 GM_WORD_NODES, GM_WORD_BETWEEN};
    struct gm_system_scene *of_file = &field->of_file;
    const struct gm_user_system *system = &of_file->system;
    const struct gm_field_kind *kind = field->kind;
    struct gm_arena *arena = field->of_file.arena;
    const double *values = gm_arena_keep(arena, gm_equations_start(system, NULL), free);
    /* a moving mesh needs fewer nodes than a ring, for which a file of other schemes gives them */
    const double half_length = values[system->velocities - 2], grid = values[system->velocities - 1],
                 points = kind->moves && !system->alone && !field->written_elsewhere
                              ? fmax(1, floor(grid / 4))
                              : grid;
    const struct gm_parameter timing[GM_SYSTEM_ROWS] = {[DT] = GM_DT("", 1e-9, 1e6), [UNTIL] = GM_UNTIL("")};
    struct gm_parameter common[MOST_ROWS];
    memcpy(common, kind->rows, kind->row_count * sizeof *common);
    if (points > common[0].highest) {
        gm_arena_refuse(arena, "points: %.15g are more than the %g nodes that a moving mesh may have", points,
                        common[0].highest);
    }
    common[0].standard = gm_written_number(arena, points, NULL);
    for (size_t i = 0; i < kind->row_count; i++) {
        for (size_t k = 0; k < GM_COUNT(chosen); k++) {
            const char *text = system->texts[chosen[k]];
            const bool here = text && strcmp(common[i].key, gm_system_words[chosen[k]].word) == 0;
            common[i].standard = here ? text : common[i].standard;
            if (here && strlen(text) >= GM_TEXT_SIZE) {
                gm_arena_refuse(arena, "%s: has at most %d characters", common[i].key, GM_TEXT_SIZE - 1);
            }
            double number = 0;
            if (here && common[i].type == GM_REAL &&
                !(gm_number_parse(text, &number) && number >= common[i].lowest &&
                  number <= common[i].highest)) {
                gm_arena_refuse(arena, "%s: is a number between %g and %g", common[i].key, common[i].lowest,
                                common[i].highest);
            }
        }
    }
    gm_system_make_rows(of_file, timing, common, kind->row_count, false);
    struct gm_parameter *last = &of_file->rows[of_file->row_count - 1];
    if (of_file->variables[of_file->row_count - 1] == system->velocities - GM_RING_PARAMETERS) {
        last->lowest = 0.01; /* half the length, unless it follows from other keys */
        last->highest = 1e5;
        last->logarithmic = true;
    }
    const struct gm_system_item *let;
    for (size_t i = GM_SYSTEM_ROWS; i < of_file->row_count; i++) {
        check_name(arena, kind, of_file->rows[i].key, "parameter");
    }
    for (size_t i = 0; kind->moves && (let = gm_system_item_of(system, GM_WORD_LET, i)); i++) {
        check_name(arena, kind, let->name, "let");
    }
    const size_t own = of_file->row_count + kind->row_count;
    gm_parameters_reset(of_file->rows + GM_SYSTEM_ROWS, own - GM_SYSTEM_ROWS, of_file->initial);
    double numbers[GM_SYSTEM_TIMES];
    gm_system_open_timing(of_file, numbers);
    const double dt = numbers[0] > 0 ? numbers[0] : gm_written_rounded(half_length / grid),
                 steps = numbers[2] >= 0 ? numbers[2] : 2 * half_length / dt,
                 until = numbers[1] >= 0 ? numbers[1] : steps * dt;
    gm_written_timing(arena, system, dt, until, of_file->rows);
    gm_parameters_reset(of_file->rows, GM_SYSTEM_ROWS, of_file->initial);
}

/* Adds an observable, and returns it. */
static struct gm_observable *add(struct gm_user_field *field, struct gm_observable row)
{
    struct gm_system_scene *of_file = &field->of_file;
    const size_t count = of_file->observable_count++;
    for (size_t k = 0; k < count; k++) {
        if (gm_observables_clash(row.key, of_file->observables[k].key)) {
            gm_arena_refuse(field->of_file.arena, "there are two observables %s", row.key);
        }
    }
    of_file->observables[count] = row;
    return &of_file->observables[count];
}

static void add_errors(struct gm_user_field *field)
{
    const struct gm_system_item *known = gm_system_item_of(&field->of_file.system, GM_WORD_EXACT_WHILE, 0);
    for (size_t i = 0; i < field->kind->error_count; i++) {
        struct gm_observable *row = add(field, field->kind->errors[i]);
        row->missing = known && !row->missing ? known->text : row->missing;
    }
}

static void add_densities(struct gm_user_field *field)
{
    static const char infinite[] = "its density is not finite everywhere";
    struct gm_system_scene *of_file = &field->of_file;
    struct gm_arena *arena = of_file->arena;
    size_t count = 0;
    for (size_t i = 0; i < of_file->system.item_count; i++) {
        const struct gm_system_item *item = &of_file->system.items[i];
        const bool kept = item->word == GM_WORD_INVARIANT;
        if (!kept && item->word != GM_WORD_OBSERVE) {
            continue;
        }
        const char *on = gm_system_option_text(item, GM_OPTION_ON, "nodes");
        if (strcmp(on, "nodes") != 0 && strcmp(on, "cells") != 0) {
            gm_arena_refuse(arena, "%.60s: an integral is on nodes or on cells, not on %.60s", item->name,
                            on);
        }
        if (count++ == MOST_DENSITIES) {
            gm_arena_refuse(arena, "a field has at most %d invariants and observables", MOST_DENSITIES);
        }
        const char *key = gm_arena_print(arena, kept ? "%s_error" : "%s", item->name);
        const struct gm_system_option *scale = gm_system_option(item, GM_OPTION_SCALE);
        struct gm_observable *row = add(
            field,
            kept ? (struct gm_observable)GM_KEPT_OBSERVABLE(
                       key, gm_field_integral, item->name, item->name, .scale = scale ? gm_field_scale : NULL,
                       .scale_text = scale ? scale->text : NULL, .terms = gm_field_terms, .missing = infinite)
                 : (struct gm_observable)GM_OBSERVABLE(key, gm_field_integral, item->name,
                                                       .missing = infinite));
        const size_t number = of_file->observable_count - 1;
        gm_written_options(row, item);
        of_file->measures[number].formula = gm_system_take_tape(of_file, item->nodes, 1);
        if (scale) {
            of_file->measures[number].terms = gm_system_take_tape(of_file, &scale->node, 1);
        }
    }
}

static void make_observables(struct gm_user_field *field)
{
    struct gm_system_scene *of_file = &field->of_file;
    gm_system_take_observables(of_file, MOST_OBSERVABLES);
    if (field->kind->equation) { /* laws and symmetries come last */
        add_densities(field);
    }
    const bool moves = field->kind->moves, observed = moves || field->kind == &gm_field_waves;
    const struct gm_hook *hook =
        of_file->hook && observed && of_file->hook->on_moving_mesh == moves ? of_file->hook : NULL;
    const struct gm_observable *rows = field->kind->observables;
    const size_t row_count = hook && !moves ? 0 : field->kind->observable_count;
    for (size_t i = 0; hook && i < hook->observable_count; i++) {
        add(field, hook->observables[i]);
    }
    for (size_t i = 0; !field->kind->equation && i < row_count; i++) {
        add(field, rows[i]);
    }
    if (field->solved) {
        add_errors(field);
    }
    for (size_t i = 0; field->kind->equation && i < row_count; i++) {
        add(field, rows[i]);
    }
    if (!field->kind->equation) {
        add_densities(field);
    }
    of_file->scene.observable_count = of_file->observable_count;
}

static void make_schemes(struct gm_user_field *field, const struct gm_problem *problem)
{
    const char *text = field->of_file.system.texts[GM_WORD_SCHEMES];
    const size_t count = gm_written_schemes(
        field->of_file.arena, field->written_elsewhere == field->of_file.origin.elsewhere ? text : NULL,
        problem, field->of_file.schemes);
    field->of_file.scene.schemes = count > 0 ? field->of_file.schemes : field->kind->schemes;
    field->of_file.scene.lanes = field->of_file.system.texts[GM_WORD_LANES];
}

/* Refines the grid with the step if there is an exact solution, or, on a moving mesh, against a run on more
   nodes: each strategy moves given nodes differently. Else the distance from a reference run on the same grid
   is measured. */
static void make_work(struct gm_user_field *field)
{
    const struct gm_system_lane *initial = field->of_file.initial;
    const double points = (double)initial->grid.points;
    struct gm_work *work = &field->of_file.work;
    *work = (struct gm_work){.arguments = "", .halvings = 5};
    if (!field->of_file.system.alone) { /* nodes alone have no grid to compare a step with */
        work->coarsest = gm_system_half_length(initial) / points * 2;
    }
    if (field->solved) {
        work->measure = "solution_error";
    } else if (field->kind == &gm_field_moving_waves) { /* peakons have nodes of their own number */
        work->reference = "multiplier-lobatto4";
        work->distance = gm_mesh_distance;
        work->distance_title = "distance from a finer run";
    }
    if (work->measure || work->distance) {
        work->resolution = "points";
        work->resolutions = field->resolutions;
        work->resolution_count = GM_COUNT(field->resolutions);
        work->errors = field->errors;
        for (size_t i = 0; i < GM_COUNT(field->resolutions); i++) {
            field->resolutions[i] = fmax(field->kind->rows->lowest, floor(ldexp(points, (int)i - 1)));
            field->errors[i] = gm_pow(10, -1 - (double)i);
        }
    }
}

/* The reason why a key has no effect: places that are listed leave nothing to the number and the density of nodes. */
static const char *idle(const void *parameters, const char *key)
{
    const struct gm_system_lane *lane = parameters;
    const bool places = strcmp(key, "points") == 0 || strcmp(key, "density") == 0;
    return places && lane->owner->system.alone && gm_mesh_lists_nodes(lane->grid.nodes)
               ? "nodes: lists the places, unless it is nodes=density"
               : gm_system_idle(parameters, key);
}

static const char *title_of(struct gm_user_field *field)
{
    enum { SHORT = 48 };
    const struct gm_user_system *system = &field->of_file.system;
    if (system->kind != GM_FIELD || system->alone) {
        return system->alone ? "Nodes alone" : "A user-defined field";
    }
    const struct gm_naming naming = gm_system_naming(system);
    char *formula = gm_formula_text(&system->graph, system->energy, &naming);
    if (formula) { /* a long formula is left out */
        gm_arena_keep(field->of_file.arena, formula, free);
    }
    return formula && strlen(formula) <= SHORT
               ? gm_arena_print(field->of_file.arena, "Waves in the potential V = %s", formula)
               : "Waves in a user-defined potential";
}

static bool on_a_mesh(const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_mesh;
}

static bool on_rates(const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_ode;
}

static bool is_for(const struct gm_scheme *scheme, unsigned facet)
{
    return scheme->family->kind == &gm_kind_field &&
           !(scheme->needs & ~(unsigned)(facet | GM_NEEDS_FORM | GM_NEEDS_PAIRS));
}

static bool on_a_ring(const struct gm_scheme *scheme)
{
    return is_for(scheme, GM_NEEDS_WAVE);
}

#define ON(equation, facet)                                                                                  \
    static bool on_##equation(const struct gm_scheme *scheme)                                                \
    {                                                                                                        \
        return is_for(scheme, facet);                                                                        \
    }
ON(korteweg, GM_NEEDS_KDV)
ON(schroedinger, GM_NEEDS_NLS)
ON(heat, GM_NEEDS_HEAT)
ON(burgers, GM_NEEDS_BURGERS)

/* The kinds of equations that are recognised, and the schemes for them alone. */
static const struct {
    const struct gm_field_kind *kind;
    bool (*is_for)(const struct gm_scheme *scheme);
} of_equations[] = {{&gm_field_korteweg, on_korteweg},
                    {&gm_field_schroedinger, on_schroedinger},
                    {&gm_field_heat, on_heat},
                    {&gm_field_burgers, on_burgers}};

size_t gm_user_field_elsewhere(const struct gm_user_system *system, const char *schemes, size_t *others)
{
    const enum gm_system_kind kind = system->kind;
    const struct gm_kind *const of_rates = kind == GM_EVOLUTION ? &gm_kind_field : NULL,
                                *const there = kind == GM_FIELD ? &gm_kind_mesh : of_rates;
    size_t count = 0;
    char name[64];
    for (*others = 0; gm_listed_word(&schemes, name, sizeof name);) {
        const struct gm_scheme *scheme = gm_scheme_find(name);
        bool is_there = scheme && scheme->family->kind == there;
        for (size_t i = 0; scheme && there && !is_there && i < gm_scheme_count();
             i++) { /* kinds may share a name */
            const struct gm_scheme *other = gm_scheme_at(i);
            is_there = other->family->kind == there && strcmp(other->name, scheme->name) == 0;
        }
        count += is_there;
        *others += !is_there;
    }
    return count + system->alone;
}

/* Finds the range of the field at the start. */
static void find_range(struct gm_user_field *field, const struct gm_problem *problem)
{
    struct gm_grid1 grid;
    const double *y =
        gm_arena_keep(field->of_file.arena, gm_field_start_on(field->of_file.initial, problem, &grid), free);
    const struct gm_view view = {.problem = problem,
                                 .scheme = gm_scheme_find(field->of_file.scene.schemes[0]),
                                 .state = y,
                                 .t0 = gm_field_t0(field->of_file.initial),
                                 .t = gm_field_t0(field->of_file.initial)};
    field->low = field->high = field->kind->value(&view, 0);
    for (size_t i = 0; i < grid.points; i++) {
        gm_range_add(&field->low, &field->high, field->kind->value(&view, i));
    }
    if (!(field->high > field->low)) {
        field->high += 1;
        field->low -= 1;
    }
}

static bool derive(struct gm_user_field *field)
{
    const unsigned long before = gm_memory_refusals();
    switch (field->of_file.system.kind) {
    case GM_EVOLUTION:
        return field->kind != &gm_field_evolutions ||
               gm_user_evolution_derive(&field->evolution, &field->of_file.system);
    case GM_MATRICES:
        return gm_user_form_derive(&field->form, &field->of_file.system);
    default:
        return gm_user_wave_derive(&field->wave, &field->of_file.system) && gm_memory_refusals() == before;
    }
}

static void make(struct gm_system_making *making)
{
    struct gm_system_scene *of_file = making->scene;
    struct gm_user_field *field = (struct gm_user_field *)of_file;
    struct gm_arena *arena = of_file->arena;
    const bool elsewhere = of_file->origin.elsewhere;
    const char *const *words = of_file->origin.words;
    struct gm_user_system *system = &of_file->system;
    static const struct gm_observable law[] = {GM_FORM_RESIDUAL}; /* it costs as much as two steps */
    const bool in_potential = system->kind == GM_FIELD, moves = in_potential && elsewhere,
               by_matrices = system->kind == GM_MATRICES;
    size_t others;
    field->written_elsewhere = gm_user_field_elsewhere(system, system->texts[GM_WORD_SCHEMES], &others) > 0;
    gm_arena_need(arena, gm_user_equation_derive(&field->equation, system));
    size_t known = 0;
    while (known < GM_COUNT(of_equations) && of_equations[known].kind->equation != field->equation.needs) {
        known++;
    }
    const bool is_known = known < GM_COUNT(of_equations);
    const struct gm_field_kind *const of_rates = is_known && elsewhere ? of_equations[known].kind
                                                                       : &gm_field_evolutions,
                                      *const of_matrices = by_matrices ? &gm_field_forms : of_rates,
                                      *const on_mesh =
                                          system->alone ? &gm_field_nodes : &gm_field_moving_waves,
                                      *const of_potentials = moves ? on_mesh : &gm_field_waves,
                                      *const kind = in_potential ? of_potentials : of_matrices;
    field->kind = kind;
    const char *const *texts = (const char *const *)system->texts;
    if (kind->no_walls && texts[GM_WORD_BOUNDARY] && strcmp(texts[GM_WORD_BOUNDARY], "walls") == 0) {
        gm_arena_refuse(arena, "%s", kind->no_walls);
    }
    gm_system_find_hook(of_file);
    field->solved = gm_line_is_solved(system);
    gm_arena_need(arena, derive(field));
    make_rows(field);
    gm_system_describe(of_file,
                       (struct gm_scene){
                           .title = title_of(field),
                           .blurb = "A user-defined field.",
                           .time = in_potential && !system->alone ? "what light needs for a length of 1"
                                                                  : "the unit of the equation",
                           .tracks = moves ? &gm_mesh_paths_track : &gm_surface_track,
                           .track_count = !kind->paint,
                           .work = &of_file->work,
                           .asked = law,
                           .asked_count = by_matrices ? GM_COUNT(law) : 0,
                           .lacking = kind->no_walls ? "boundary" : NULL,
                           .lacking_why = kind->no_walls,
                           .preferences = kind->preferences,
                           .t0 = gm_field_t0,
                           .idle = idle,
                           .setup = gm_field_setup,
                           .close = gm_user_line_close,
                           .start = gm_field_start,
                           .draw = kind->draw,
                           .point = gm_field_point,
                           .failure = kind->failure ? kind->failure : gm_field_failure,
                       });
    if (moves) {
        of_file->scene.elsewhere = system->alone ? NULL : on_a_ring;
        of_file->scene.start_with = gm_field_start_mesh;
        of_file->scene.chosen = gm_field_note_mesh;
        of_file->scene.takes = gm_field_takes;
    }
    if (moves && !system->alone) {
        of_file->scene.asked = gm_mesh_asked;
        of_file->scene.asked_count = GM_COUNT(gm_mesh_asked);
    } else if (in_potential && words && !of_file->initial->grid.walls) {
        of_file->scene.elsewhere = on_a_mesh;
    } else if (is_known && words) {
        of_file->scene.elsewhere = kind->equation ? on_rates : of_equations[known].is_for;
    }
    gm_system_open_items(of_file);
    gm_system_open_problem(making);
    make_observables(field);
    make_schemes(field, &making->problem);
    if (!gm_system_item_of(system, GM_WORD_COLOURS, 0)) {
        find_range(field, &making->problem);
    }
    make_work(field);
    gm_system_make_studies(of_file, &making->problem, NULL);
}

const struct gm_system_maker gm_system_fields = {.size = sizeof(struct gm_user_field), .make = make};
