/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations of the unknowns U are L U = -r, r their residuals at U = 0. Rows of degree 0 are multiplied by
   the areas of their cells, so that K of -laplace(u) is symmetric. Where constants on a piece solve L U = 0, one
   number of it is pinned, the mean of r there is removed, and then that of U. */
#include "core/ode/user/forms.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/form/generators.h"
#include "core/form/gmsh.h"
#include "core/form/values.h"
#include "core/linear/cholesky.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/stages.h"
#include "core/user/line.h"

enum { MOST_FACTORS = 8, MOST_PASSES = 4 };

/* The factors of stages, 1 - h a (x) J, for one h a: by Cholesky's method if the matrix is symmetric with cells as
   weights, as that of diffusion is. */
struct stage_factor {
    struct gm_arena *arena;                                  /* NULL: none */
    double scaled[2][GM_TABLEAU_STAGES * GM_TABLEAU_STAGES]; /* h a of both halves of the components */
    size_t count;
    struct gm_matrix matrix;
    double *weight;               /* that its rows were multiplied by */
    struct gm_cholesky *cholesky; /* NULL: `lu` */
    struct gm_lu *lu;
};

/* The arguments of the body that opens a problem. */
struct opening {
    struct own *own;
    const struct gm_form_model *model;
    struct gm_triangulation file;
    const double *variables;
    struct gm_form_choice choice;
    double numbers[GM_GENERATOR_NUMBERS]; /* of the mesh */
};

/* A number that is held: entry `from` of a root of the held values, with a sign. */
struct held_number {
    size_t root, from, to; /* to: a number of the state, or of the unknowns */
    double sign;
    bool unknown;
};

/* A problem that is closed waits for one with the same numbers: a command opens it to see which schemes fit, and again
   to run it. */
struct gm_form_idle {
    pthread_mutex_t turn;
    struct own *own; /* or NULL */
};

struct own {
    struct gm_ode facets;
    struct gm_split split;
    struct gm_loops loops;
    struct gm_arena *arena; /* owns all of this */
    const struct gm_form_model *model;
    struct gm_form_choice choice;
    double *variables;            /* that it was opened with */
    struct gm_triangulation file; /* the groups of its edges */
    struct gm_form_space space;
    struct gm_form_values rates, exacts, equations, observed;
    struct gm_matrix *closings; /* for each item of the system */
    double **arcs;              /* for each item of the system: s at the points of its samples, or NULL */
    struct gm_matrix *around;   /* for each part of the boundary in integral(PART, a) */
    pthread_mutex_t turn;       /* one call after another */
    size_t n, half;             /* of the state, if it splits: forms of the first group are padded to it */
    size_t *offset;             /* of each form in the state, or among the unknowns */
    double **forms;             /* where each form is */
    size_t unknowns;
    bool *held, *held_unknown; /* of each number of the state, and of the unknowns */
    struct held_number *held_numbers;
    size_t held_count;
    bool held_changes; /* in time */
    struct gm_form_values held_values;
    double *current; /* a state with what is held now */
    double *given;   /* values of held unknowns, else 0 */
    double *unknown, *residual, *start, *seen, *scratch;
    double seen_time;        /* of the state whose unknowns and observables are there; NaN: none */
    bool observes, measures; /* what is observed was computed; residuals are measured */
    struct gm_matrix matrix;
    size_t size; /* of the matrix: unknowns, and numbers of stars of 1-forms that are solved for */
    struct gm_cholesky *factor; /* NULL: `lu` */
    struct gm_lu *lu;
    double sign;    /* that the matrix was multiplied by, but for pinned rows */
    double *cell;   /* of each number of the state: the area of a 0-form's cell, over that of a 2-form, 1 */
    double *weight; /* areas of the cells of the unknowns, 0 where the degree is not 0 */
    int *piece;     /* of each number of the unknowns that constants of its piece solve for; -1 */
    double *defect, *remainder; /* of each form: what its equation cannot meet, and what is left of it */
    struct stage_factor factors[MOST_FACTORS];
    size_t next_factor;
    struct gm_arena *derived; /* holds `rows`; NULL: none */
    struct gm_matrix rows;    /* the Jacobian of the rates, with the rows of stars that are solved for */
    double *derived_at;       /* the state that `rows` are of */
};

static struct own *own_of(const struct gm_problem *problem)
{
    return (struct own *)(uintptr_t)problem->parameters;
}

static struct gm_form_type type_of(const struct gm_user_system *system, size_t form)
{
    return (struct gm_form_type){system->forms[form].degree, system->forms[form].dual};
}

static size_t size_of(const struct own *own, size_t form)
{
    return gm_form_size(own->space.complex, type_of(own->model->system, form));
}

/* The areas of the cells of forms of degree 0. */
static const double *cells_of(const struct own *own, bool dual)
{
    return dual ? own->space.complex->area : own->space.complex->star0;
}

static double *doubles(const struct own *own, size_t count)
{
    return gm_arena_take(own->arena, count, sizeof(double));
}

/* ---- the model ---- */

/* The body of the system's arena that compiles. */
struct compiling {
    struct gm_form_model *model;
    struct gm_fault *fault;
};

static void compile(const struct compiling *compiling, struct gm_form_program *program,
                    const struct gm_form_root *roots, size_t count, bool linear)
{
    struct gm_user_system *system = compiling->model->system;
    gm_arena_need(system->arena, gm_form_compile(program, system, roots, count, linear, compiling->fault));
}

/* All that the steps of a program need. */
static unsigned needs_of(const struct gm_form_program *program)
{
    unsigned needs = 0;
    for (size_t i = 0; i < program->count; i++) {
        needs |= program->steps[i].needs;
    }
    return needs;
}

/* Refuses values that are not of x, y, z, t and parameters alone. */
static void limit(const struct compiling *compiling, const struct gm_form_program *program,
                  const struct gm_form_root *roots, const char *sentence)
{
    gm_arena_need(compiling->model->system->arena,
                  !(needs_of(program) & (GM_NEEDS_FIELDS | GM_NEEDS_UNKNOWNS)) ||
                      gm_fail(compiling->fault, roots[0].place, "%s", sentence));
}

static void compile_forms(const struct compiling *compiling)
{
    struct gm_form_model *model = compiling->model;
    struct gm_user_system *system = model->system;
    struct gm_arena *arena = system->arena;
    const size_t n = system->n;
    struct gm_form_root *rates = gm_arena_take(arena, 4 * n + 1, sizeof *rates), *starts = rates + n,
                        *exact = starts + n, *residuals = exact + n;
    size_t exacts = 0;
    model->fields = gm_arena_take(arena, n + 1, sizeof *model->fields);
    model->unknowns = gm_arena_take(arena, n + 1, sizeof *model->unknowns);
    for (size_t i = 0; i < n; i++) {
        const struct gm_form_declared *form = &system->forms[i];
        const struct gm_form_type type = type_of(system, i);
        if (form->exact != GM_NO_NODE) {
            exact[exacts++] = (struct gm_form_root){form->exact, type, true, 0, form->place};
        }
        if (form->unknown) {
            system->graph.place = (uint32_t)form->equation;
            const gm_node_id node =
                gm_formula_apply(&system->graph, GM_OPERATION_SUBTRACT, form->left, form->right);
            system->graph.place = GM_NO_PLACE;
            residuals[model->unknown_count] =
                (struct gm_form_root){node, {GM_FORM_ANY, false}, false, 0, form->place};
            model->unknowns[model->unknown_count++] = i;
            continue;
        }
        starts[model->field_count] = (struct gm_form_root){form->start, type, true, 0, form->place};
        rates[model->field_count] = (struct gm_form_root){system->rates[i], type, false, 0, form->place};
        model->fields[model->field_count++] = i;
    }
    compile(compiling, &model->rates, rates, model->field_count, false);
    compile(compiling, &model->starts, starts, model->field_count, false);
    compile(compiling, &model->exacts, exact, exacts, false);
    compile(compiling, &model->equations, residuals, model->unknown_count, true);
    model->equation_types = gm_arena_take(arena, n + 1, sizeof *model->equation_types);
    for (size_t k = 0; k < model->unknown_count; k++) {
        const size_t i = model->unknowns[k];
        const struct gm_form_type type = type_of(system, i),
                                  found = model->equations.steps[model->equations.roots[k]].type;
        model->equation_types[k] = found;
        const int places = type.dual ? 2 - type.degree : type.degree,
                  rows = found.dual ? 2 - found.degree : found.degree;
        if (found.degree < 0 || places != rows) {
            gm_fail(compiling->fault, system->forms[i].equation,
                    "the equation of %s, which is %s, is of %s: it has not one number for each of %s",
                    system->variables[i].name, gm_form_type_text(type), gm_form_type_text(found),
                    system->variables[i].name);
            gm_arena_leave(arena);
        }
    }
    limit(compiling, &model->starts, starts, "start: holds formulas of x, y, z, t and parameters alone");
    limit(compiling, &model->exacts, exact, "exact: holds formulas of x, y, z, t and parameters alone");
}

static bool is_timed(const struct gm_form_program *program)
{
    return needs_of(program) & GM_NEEDS_TIME;
}

/* Compiles the values of forms that are held on a part of the boundary. */
static void compile_held(const struct compiling *compiling)
{
    struct gm_form_model *model = compiling->model;
    struct gm_user_system *system = model->system;
    struct gm_form_root *roots = gm_arena_take(system->arena, system->item_count + 1, sizeof *roots);
    model->held_item = gm_arena_take(system->arena, system->item_count + 1, sizeof *model->held_item);
    size_t count = 0;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word != GM_WORD_BOUNDARY || item->count > 1) {
            continue;
        }
        const struct gm_form_type type = type_of(system, item->variable);
        if (type.dual ? type.degree != 2 : type.degree == 2) {
            gm_fail(compiling->fault, item->place, "%s is %s: a 0-form, a 1-form or a dual 2-form is held",
                    system->variables[item->variable].name, gm_form_type_text(type));
            gm_arena_leave(system->arena);
        }
        model->held_item[count] = i;
        roots[count++] = (struct gm_form_root){item->nodes[0], type, true, i + 1, item->place};
    }
    compile(compiling, &model->held, roots, count, false);
    for (size_t k = 0; k < count; k++) {
        const struct gm_form_declared *form = &system->forms[system->items[model->held_item[k]].variable];
        gm_arena_need(
            system->arena,
            !form->unknown || !(model->held.steps[model->held.roots[k]].needs & GM_NEEDS_UNKNOWNS) ||
                gm_fail(
                    compiling->fault, roots[k].place,
                    "an unknown is held at formulas and fields: what other unknowns give is an equation"));
    }
    system->timed |= is_timed(&model->held);
}

/* True if values that are held are made of forms. */
static bool holds_forms(const struct gm_form_model *model)
{
    return needs_of(&model->held) & (GM_NEEDS_FIELDS | GM_NEEDS_UNKNOWNS);
}

/* Finds a split of the fields, in their order, into two groups such that no rate holds fields of its own group. */
static void find_split(struct gm_form_model *model)
{
    const struct gm_user_system *system = model->system;
    const struct gm_form_program *rates = &model->rates;
    const size_t fields = model->field_count;
    bool *needs = gm_arena_take(system->arena, (rates->count + 1) * (system->n + 1), sizeof *needs);
    for (size_t i = 0; i < rates->count; i++) {
        const struct gm_form_step *step = &rates->steps[i];
        bool *mine = needs + i * system->n;
        const bool binary = step->kind == GM_STEP_OPERATE || step->kind == GM_STEP_WEDGE,
                   leaf = step->kind == GM_STEP_FORM || step->kind == GM_STEP_SAMPLE;
        for (size_t f = 0; f < system->n; f++) {
            mine[f] = (step->kind == GM_STEP_FORM && step->number == f) ||
                      (!leaf && needs[step->a * system->n + f]) || (binary && needs[step->b * system->n + f]);
        }
    }
    for (size_t split = 1; split < fields && model->unknown_count == 0 && !holds_forms(model); split++) {
        bool splits = true;
        for (size_t i = 0; i < fields; i++) {
            for (size_t f = 0; f < fields; f++) {
                splits &= (i < split) != (f < split) || !needs[rates->roots[i] * system->n + f];
            }
        }
        if (splits) {
            model->split = split;
            return;
        }
    }
}

/* Adds a form that files and pictures have by its name. */
static void name_form(const struct compiling *compiling, struct gm_form_named form, size_t place)
{
    static const char *const taken[] = {"numbers", "mesh", "points", "triangles", "edges", "dual_vertices"};
    struct gm_form_model *model = compiling->model;
    for (size_t k = 0; k < GM_COUNT(taken); k++) {
        gm_arena_need(model->system->arena,
                      strcmp(form.name, taken[k]) != 0 ||
                          gm_fail(compiling->fault, place,
                                  "a form cannot be called %s: pictures or files of forms have that word",
                                  form.name));
    }
    gm_arena_need(model->system->arena,
                  model->named_count < GM_MOST_NAMED_FORMS ||
                      gm_fail(compiling->fault, place,
                              "a system has at most %d forms, lets that are forms included",
                              GM_MOST_NAMED_FORMS));
    model->named[model->named_count++] = form;
}

/* Lets another problem wait, or none. Returns the one that waited, or NULL. */
static struct own *exchange_idle(struct gm_form_idle *idle, struct own *own)
{
    pthread_mutex_lock(&idle->turn);
    struct own *before = idle->own;
    idle->own = own;
    pthread_mutex_unlock(&idle->turn);
    return before;
}

static void close_own(struct own *own)
{
    gm_arena_close(own ? own->arena : NULL);
}

static void close_idle(void *data)
{
    struct gm_form_idle *idle = data;
    close_own(idle->own);
    pthread_mutex_destroy(&idle->turn);
}

/* Refuses values on the boundary of a let that is not a dual 1-form: nothing would take them. */
static void refuse_boundary(const struct compiling *compiling, gm_node_id let, struct gm_form_type type)
{
    const struct gm_user_system *system = compiling->model->system;
    for (size_t i = 0; i < system->item_count && !(type.degree == 1 && type.dual); i++) {
        const struct gm_system_item *item = &system->items[i];
        gm_arena_need(system->arena, item->word != GM_WORD_BOUNDARY || item->count < 2 ||
                                         item->nodes[1] != let ||
                                         gm_fail(compiling->fault, item->place,
                                                 "a boundary of a let is along a dual 1-form, and this is %s",
                                                 gm_form_type_text(type)));
    }
}

static void compile_all(struct gm_arena *arena, void *data)
{
    const struct compiling *compiling = data;
    struct gm_form_model *model = compiling->model;
    struct gm_user_system *system = model->system;
    struct gm_form_root *observed = gm_arena_take(arena, system->item_count + 1, sizeof *observed);
    model->observed_item = gm_arena_take(arena, system->item_count + 1, sizeof *model->observed_item);
    model->idle = gm_arena_take(arena, 1, sizeof *model->idle);
    gm_arena_need(arena, pthread_mutex_init(&model->idle->turn, NULL) == 0);
    gm_arena_keep(arena, model->idle, close_idle);
    compile_forms(compiling);
    system->timed |= is_timed(&model->rates) || is_timed(&model->equations);
    compile_held(compiling);
    find_split(model);
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_INVARIANT || item->word == GM_WORD_OBSERVE || item->word == GM_WORD_LET) {
            const int degree = item->word == GM_WORD_LET ? GM_FORM_ANY : GM_FORM_NUMBER;
            model->observed_item[model->observed_count] = i;
            observed[model->observed_count++] =
                (struct gm_form_root){item->nodes[0], {degree, false}, false, 0, item->place};
        }
    }
    compile(compiling, &model->observed, observed, model->observed_count, false);
    model->named = gm_arena_take(arena, system->n + model->observed_count + 1, sizeof *model->named);
    for (size_t i = 0; i < system->n; i++) {
        name_form(compiling, (struct gm_form_named){system->variables[i].name, type_of(system, i), true, i},
                  system->forms[i].place);
    }
    for (size_t i = 0; i < model->observed_count; i++) {
        const struct gm_system_item *item = &system->items[model->observed_item[i]];
        const struct gm_form_type type = model->observed.steps[model->observed.roots[i]].type;
        if (item->word == GM_WORD_LET) {
            refuse_boundary(compiling, item->nodes[0], type);
        }
        if (item->word == GM_WORD_LET && type.degree >= 0) {
            name_form(compiling, (struct gm_form_named){item->name, type, false, i}, item->place);
        }
    }
}

bool gm_form_model_open(struct gm_form_model *model, struct gm_user_system *system, struct gm_fault *fault)
{
    *model = (struct gm_form_model){.system = system};
    *fault = (struct gm_fault){0};
    return gm_arena_run(system->arena, compile_all, &(struct compiling){model, fault});
}

/* ---- the mesh ---- */

bool gm_form_reads_mesh(const struct gm_user_system *system)
{
    return strpbrk(gm_system_item_of(system, GM_WORD_MESH, 0)->name, "./") != NULL;
}

/* Refuses a mesh, with the sentence about its fault. */
static bool refuse_mesh(const char *name, const struct gm_triangulation_fault *wrong, size_t place,
                        struct gm_fault *fault)
{
    char sentence[GM_TRIANGULATION_SENTENCE];
    return gm_fail(fault, place, "mesh: %s", gm_triangulation_explain(name, wrong, sentence));
}

/* Makes or reads the mesh. */
static bool open_mesh(struct opening *opening, enum gm_star star, struct gm_fault *fault)
{
    const struct gm_form_model *model = opening->model;
    const struct gm_user_system *system = model->system;
    const struct gm_system_item *mesh = gm_system_item_of(system, GM_WORD_MESH, 0);
    struct gm_triangulation_fault wrong;
    if (model->mesh_text) {
        return gm_triangulation_read_in_space(model->mesh_text, model->mesh_size, star, &opening->file,
                                              &wrong) ||
               refuse_mesh(model->mesh_name, &wrong, mesh->place, fault);
    }
    if (mesh->count > GM_GENERATOR_NUMBERS) {
        return gm_fail(fault, mesh->place, "a mesh has at most five numbers");
    }
    if ((mesh->count > 0 &&
         !gm_user_line_numbers(system, mesh->nodes, mesh->count, opening->variables, opening->numbers)) ||
        !gm_generator_check(mesh->name, opening->numbers, mesh->count, mesh->place, fault)) {
        return false;
    }
    const bool made =
        gm_generator_open(mesh->name, opening->numbers, mesh->count, star, &opening->file, &wrong);
    if (!made && wrong.kind == GM_TRIANGULATION_NOT_DELAUNAY) {
        return gm_fail(
            fault, mesh->place,
            "this mesh has a dual edge that is not positive, beside an angle of %.1f degrees, and its least star "
            "entry is %s: take star=auto or star=barycentric",
            wrong.value, wrong.text);
    }
    return made;
}

/* ---- unknowns ---- */

/* Finds the pieces on which constants of an unknown of degree 0 solve the equations. */
static void find_constants(struct own *own, size_t form)
{
    const struct gm_form_type type = type_of(own->model->system, form);
    const size_t first = own->offset[form], n = size_of(own, form);
    bool free_of = type.degree == 0;
    for (size_t i = 0; i < own->size && free_of; i++) {
        double sum = 0, size = 0;
        for (int k = own->matrix.start[i]; k < own->matrix.start[i + 1]; k++) {
            const size_t column = (size_t)own->matrix.column[k];
            if (column >= first && column < first + n) {
                sum += own->matrix.value[k];
                size += fabs(own->matrix.value[k]);
            }
        }
        free_of = fabs(sum) <= 1e-10 * size;
    }
    const struct gm_complex *complex = own->space.complex;
    const int *piece = type.dual ? complex->triangle_piece : complex->vertex_piece;
    for (size_t i = 0; i < n && free_of; i++) {
        own->piece[first + i] = (int)first + piece[i]; /* the number that is pinned */
    }
}

/* True if a number of the unknowns is held, or pinned. */
static bool is_pinned(const struct own *own, size_t i)
{
    return own->held_unknown[i] || own->piece[i] == (int)i;
}

/* Replaces rows and columns of pinned numbers by those of the identity. */
static void pin(struct own *own)
{
    const struct gm_matrix *a = &own->matrix;
    for (size_t i = 0; i < own->size; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            const int j = a->column[k];
            if (is_pinned(own, i) || is_pinned(own, (size_t)j)) {
                a->value[k] = j == (int)i ? 1 : 0;
            }
        }
    }
}

/* Factors the matrix: if it is symmetric and, but for its sign, definite, by Cholesky's method. Refuses equations that
   do not determine their unknowns. */
static void factor(struct own *own)
{
    struct gm_matrix *a = &own->matrix;
    const size_t n = own->size;
    double trace = 0, *signs = gm_arena_take(own->arena, n, sizeof *signs);
    for (size_t i = 0; i < n; i++) {
        for (int k = a->start[i]; k < a->start[i + 1]; k++) {
            trace += a->column[k] == (int)i && !is_pinned(own, i) ? a->value[k] : 0;
        }
    }
    own->sign = trace < 0 ? -1 : 1;
    for (size_t i = 0; i < n; i++) {
        signs[i] = is_pinned(own, i) ? 1 : own->sign;
    }
    gm_matrix_scale(a, signs);
    for (size_t i = 0; i < n; i++) {
        signs[i] = 1;
    }
    own->factor = gm_matrix_is_symmetric(a, signs) ? gm_matrix_factor(own->arena, a) : NULL;
    if (own->factor && gm_cholesky_condition(own->factor) > 1e-13) {
        return;
    }
    size_t vanishing = 0;
    own->factor = NULL;
    own->lu = gm_lu_open(n, a->start, a->column, a->value, &vanishing);
    gm_arena_need(own->arena, own->lu);
    gm_arena_keep(own->arena, own->lu, gm_lu_close);
    if (vanishing > 0) {
        const struct gm_form_model *model = own->model;
        const char *names = "";
        for (size_t k = 0; k < model->unknown_count; k++) {
            names = gm_arena_print(own->arena, "%s%s%s", names, k > 0 ? ", " : "",
                                   model->system->variables[model->unknowns[k]].name);
        }
        gm_arena_refuse(own->arena, "equation: the equations do not determine %s: %zu number%s free", names,
                        vanishing, vanishing == 1 ? " is" : "s are");
    }
}

static void assemble(struct own *own)
{
    const struct gm_form_model *model = own->model;
    struct gm_arena *arena = own->arena;
    own->matrix = gm_form_values_matrix(
        &own->equations, arena,
        &(struct gm_form_layout){GM_NEEDS_UNKNOWNS, model->unknowns, own->offset, own->unknowns});
    own->size = own->matrix.rows;
    own->weight = doubles(own, own->size);
    own->unknown = doubles(own, own->size);
    own->residual = doubles(own, own->size);
    own->piece = gm_arena_take(arena, own->size, sizeof *own->piece);
    own->held_unknown = gm_arena_resize(arena, own->held_unknown, own->size, sizeof *own->held_unknown);
    memset(own->held_unknown + own->unknowns, 0, own->size - own->unknowns);
    for (size_t i = 0; i < own->size; i++) {
        own->weight[i] = 1;
        own->piece[i] = -1;
    }
    for (size_t k = 0; k < model->unknown_count; k++) {
        const struct gm_form_type found = model->equation_types[k];
        if (found.degree == 0) {
            const size_t form = model->unknowns[k];
            memcpy(own->weight + own->offset[form], cells_of(own, found.dual),
                   size_of(own, form) * sizeof(double));
        }
    }
    gm_matrix_scale(&own->matrix, own->weight);
    pin(own);
    for (size_t k = 0; k < model->unknown_count; k++) {
        find_constants(own, model->unknowns[k]);
    }
    pin(own);
    factor(own);
}

/* Removes means over pieces: of residuals, whose defect is noted, or of unknowns. */
static void remove_means(struct own *own, size_t form, double *numbers, bool residual)
{
    const size_t first = own->offset[form], n = size_of(own, form);
    const double *cell = cells_of(own, own->model->system->forms[form].dual);
    own->defect[form] = residual ? 0 : own->defect[form];
    for (size_t pin = first; pin < first + n; pin++) {
        if (own->piece[pin] != (int)pin) {
            continue;
        }
        double sum = 0, size = 0, area = 0;
        for (size_t i = 0; i < n; i++) {
            if (own->piece[first + i] == (int)pin) {
                sum += numbers[first + i] * (residual ? 1 : cell[i]);
                size += fabs(numbers[first + i]);
                area += cell[i];
            }
        }
        for (size_t i = 0; i < n; i++) {
            if (own->piece[first + i] == (int)pin) {
                numbers[first + i] -= sum / area * (residual ? cell[i] : 1);
            }
        }
        if (residual) {
            own->defect[form] = fmax(own->defect[form], size > 0 ? fabs(sum) / size : 0);
            numbers[pin] = 0;
        }
    }
}

/* Notes the largest residual of each equation, relative to its terms. */
static void measure_residuals(struct own *own)
{
    const struct gm_form_model *model = own->model;
    const struct gm_matrix *a = &own->matrix;
    for (size_t k = 0; k < model->unknown_count; k++) {
        const size_t form = model->unknowns[k], first = own->offset[form];
        double largest = 0, scale = 0;
        for (size_t i = first; i < first + size_of(own, form); i++) {
            double sum = -own->residual[i], terms = fabs(own->residual[i]);
            for (int l = a->start[i]; l < a->start[i + 1]; l++) {
                sum += a->value[l] * own->unknown[a->column[l]];
                terms += fabs(a->value[l] * own->unknown[a->column[l]]);
            }
            largest = fmax(largest, fabs(sum));
            scale = fmax(scale, terms);
        }
        own->remainder[form] = scale > 0 ? largest / scale : 0;
    }
}

/* Solves for the unknowns at fields that own->forms has. */
static void solve(struct own *own, double t)
{
    const struct gm_form_model *model = own->model;
    double *right = own->residual;
    bool good = true;
    if (own->unknowns == 0) {
        return;
    }
    memcpy(own->unknown, own->given, own->unknowns * sizeof *own->unknown);
    memset(right, 0, own->size * sizeof *right);
    gm_form_values_run(&own->equations, t, own->forms);
    for (size_t k = 0; k < model->unknown_count; k++) {
        const size_t form = model->unknowns[k], first = own->offset[form], size = size_of(own, form);
        const double *residual = gm_form_values_root(&own->equations, k);
        for (size_t j = 0; j < size; j++) {
            right[first + j] = -residual[j] * own->weight[first + j];
        }
        remove_means(own, form, right, true);
    }
    for (size_t i = 0; i < own->unknowns; i++) {
        right[i] = own->held_unknown[i] ? 0 : own->sign * right[i];
    }
    if (own->factor) {
        gm_cholesky_solve(own->factor, right, own->unknown);
    } else {
        good = gm_lu_apply(own->lu, right, own->unknown);
    }
    if (own->measures) {
        measure_residuals(own);
    }
    for (size_t i = 0; i < own->unknowns; i++) {
        own->unknown[i] = good ? own->unknown[i] + own->given[i] : NAN;
    }
    for (size_t k = 0; k < model->unknown_count; k++) {
        remove_means(own, model->unknowns[k], own->unknown, false);
    }
}

/* ---- the equations of motion ---- */

/* Writes the values that are held at a time, of unknowns, and in a state unless it is NULL. Returns the largest change
   over the largest value. */
static double set_held(struct own *own, double t, double *y)
{
    double change = 0, largest = 0;
    gm_form_values_run(&own->held_values, t, own->forms);
    for (size_t k = 0; k < own->held_count; k++) {
        const struct held_number *held = &own->held_numbers[k];
        const double value = held->sign * gm_form_values_root(&own->held_values, held->root)[held->from];
        double *to = held->unknown ? own->given : y;
        if (to) {
            change = fmax(change, fabs(to[held->to] - value));
            largest = fmax(largest, fabs(value));
            to[held->to] = value;
        }
    }
    return largest > 0 ? change / largest : 0;
}

/* Lets forms be those of this state. */
static void point_at(struct own *own, double *state)
{
    const struct gm_user_system *system = own->model->system;
    for (size_t i = 0; i < system->n; i++) {
        own->forms[i] = (system->forms[i].unknown ? own->unknown : state) + own->offset[i];
    }
}

/* Lets forms be those of a state; if values that are held change, of a copy with their values now, which may be made of
   others. */
static void place_forms(struct own *own, const double *y, double t)
{
    double *state = (double *)(uintptr_t)y;
    if (own->held_changes) {
        state = memcpy(own->current, y, own->n * sizeof *y);
        point_at(own, state);
        const unsigned needs = needs_of(&own->model->held);
        double change = 1;
        for (int pass = 0; pass < (needs == GM_NEEDS_TIME ? 1 : MOST_PASSES) && change > 0; pass++) {
            if (needs & GM_NEEDS_UNKNOWNS) {
                set_held(own, t, NULL);
                solve(own, t);
            }
            change = set_held(own, t, state);
        }
    }
    point_at(own, state);
}

/* Writes the rates of fields first .. last - 1; f[0] is the rate of the state's number `base`. */
static void write_rates(const struct gm_problem *problem, const double *y, double *f, size_t first,
                        size_t last, size_t base)
{
    struct own *own = own_of(problem);
    const struct gm_form_model *model = own->model;
    const double t = model->system->timed ? y[problem->n - 1] : 0;
    pthread_mutex_lock(&own->turn);
    own->seen_time = NAN;
    place_forms(own, y, t);
    solve(own, t);
    gm_form_values_run(&own->rates, t, own->forms);
    for (size_t k = first; k < last; k++) {
        const size_t form = model->fields[k], offset = own->offset[form];
        const double *rate = gm_form_values_root(&own->rates, k);
        const size_t size = size_of(own, form);
        for (size_t j = 0; j < size; j++) {
            f[offset - base + j] = own->held[offset + j] ? 0 : rate[j];
        }
    }
    pthread_mutex_unlock(&own->turn);
}

static void field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    (void)m;
    memset(f, 0, problem->n * sizeof *f);
    write_rates(problem, y, f, 0, own_of(problem)->model->field_count, 0);
    if (own_of(problem)->model->system->timed) {
        f[problem->n - 1] = 1;
    }
}

static void velocity(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    (void)m;
    memset(f, 0, own_of(problem)->half * sizeof *f);
    write_rates(problem, y, f, 0, own_of(problem)->model->split, 0);
}

static void force(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    const struct own *own = own_of(problem);
    (void)m;
    memset(f, 0, own->half * sizeof *f);
    write_rates(problem, y, f, own->model->split, own->model->field_count, own->half);
}

/* ---- implicit steps ---- */

/* True if an operation's derivative changes with the fields, or in time. */
static bool bends(const struct gm_form_program *program, const struct gm_form_step *step)
{
    const unsigned p = program->steps[step->a].needs, q = program->steps[step->b].needs;
    switch ((enum gm_operation)step->number) {
    case GM_OPERATION_ADD:
    case GM_OPERATION_SUBTRACT:
    case GM_OPERATION_NEGATE:
        return false;
    case GM_OPERATION_MULTIPLY:
        return p && q;
    case GM_OPERATION_DIVIDE:
        return q;
    default:
        return true;
    }
}

/* True if the rates are linear in the fields: with one Jacobian for all states. */
static bool is_linear(const struct gm_form_program *rates)
{
    bool linear = true;
    for (size_t i = 0; i < rates->count; i++) {
        const struct gm_form_step *step = &rates->steps[i];
        linear &= !(step->needs & GM_NEEDS_FIELDS) || step->kind != GM_STEP_OPERATE || !bends(rates, step);
    }
    return linear;
}

/* The Jacobian of the rates at own->forms, without what they depend on through unknowns. */
static void derive(struct gm_arena *arena, void *data)
{
    struct own *own = data;
    own->rows = gm_form_values_matrix(
        &own->rates, arena,
        &(struct gm_form_layout){GM_NEEDS_FIELDS, own->model->fields, own->offset, own->n});
    double *moves = gm_arena_take(arena, own->rows.rows, sizeof *moves);
    for (size_t i = 0; i < own->rows.rows; i++) {
        moves[i] = i < own->n && own->held[i] ? 0 : 1;
    }
    gm_matrix_scale(&own->rows, moves);
}

/* Closes the factors of stages, and the Jacobian that they are of. */
static void drop_factors(void *data)
{
    struct own *own = data;
    for (size_t i = 0; i < MOST_FACTORS; i++) {
        gm_arena_close(own->factors[i].arena);
        own->factors[i] = (struct stage_factor){0};
    }
    gm_arena_close(own->derived);
    own->derived = NULL;
}

/* Makes `rows` at a state, unless they are those. False when out of memory. */
static bool derive_at(struct own *own, const double *y, double t)
{
    if (own->derived && (own->facets.stiff || memcmp(own->derived_at, y, own->n * sizeof *y) == 0)) {
        return true;
    }
    drop_factors(own);
    memcpy(own->derived_at, y, own->n * sizeof *y);
    place_forms(own, own->derived_at, t);
    solve(own, t);
    gm_form_values_run(&own->rates, t, own->forms);
    own->derived = gm_arena_made(derive, own);
    return own->derived;
}

/* The arguments of the body that makes a factor. */
struct factoring {
    struct own *own;
    struct stage_factor *factor;
};

/* Factors 1 - h a (x) J; rows of stars that are solved for are those of each stage. */
static void factor_stages(struct gm_arena *arena, void *data)
{
    const struct factoring *factoring = data;
    const struct own *own = factoring->own;
    struct stage_factor *factor = factoring->factor;
    const struct gm_matrix *rows = &own->rows;
    const size_t n = own->n, each = rows->rows, count = factor->count;
    struct gm_matrix_entries all =
        gm_matrix_entries(arena, count * count * gm_matrix_count(rows) + count * n);
    for (size_t i = 0; i < count; i++) {
        for (size_t r = 0; r < each; r++) {
            const double *scaled = factor->scaled[r >= n / 2] + i * GM_TABLEAU_STAGES;
            const size_t row = i * each + r;
            if (r < n) {
                gm_matrix_put(&all, row, row, 1);
            }
            for (size_t j = r < n ? 0 : i; j < (r < n ? count : i + 1); j++) {
                const double by = r < n ? -scaled[j] : 1;
                for (int k = rows->start[r]; k < rows->start[r + 1] && by != 0; k++) {
                    gm_matrix_put(&all, row, j * each + (size_t)rows->column[k], by * rows->value[k]);
                }
            }
        }
    }
    struct gm_matrix *matrix = &factor->matrix;
    *matrix = gm_matrix_of(&all, count * each, count * each);
    factor->weight = gm_arena_take(arena, count * each, sizeof *factor->weight);
    for (size_t i = 0; i < count * each; i++) {
        factor->weight[i] = i % each < n ? own->cell[i % each] : 1;
    }
    if (gm_matrix_is_symmetric(matrix, factor->weight)) {
        gm_matrix_scale(matrix, factor->weight);
        factor->cholesky = gm_matrix_factor(arena, matrix);
    } else {
        factor->weight = NULL;
    }
    if (!factor->cholesky) {
        factor->lu = gm_lu_open(count * each, matrix->start, matrix->column, matrix->value, NULL);
        gm_arena_need(arena, factor->lu);
        gm_arena_keep(arena, factor->lu, gm_lu_close);
    }
}

/* The factors for these stages, new ones in the place of the oldest. NULL if the matrix is singular, or when out of
   memory. */
static const struct stage_factor *factor_of(struct own *own, const struct gm_stages *stages)
{
    struct stage_factor wanted = {.count = stages->count};
    for (size_t i = 0; i < stages->count; i++) {
        for (size_t j = 0; j < stages->count; j++) {
            wanted.scaled[0][i * GM_TABLEAU_STAGES + j] = stages->h * stages->a[i][j];
            wanted.scaled[1][i * GM_TABLEAU_STAGES + j] = stages->h * stages->c[i][j];
        }
    }
    for (size_t i = 0; i < MOST_FACTORS; i++) {
        const struct stage_factor *factor = &own->factors[i];
        if (factor->arena && factor->count == wanted.count &&
            memcmp(factor->scaled, wanted.scaled, sizeof wanted.scaled) == 0) {
            return factor;
        }
    }
    struct stage_factor *factor = &own->factors[own->next_factor++ % MOST_FACTORS];
    gm_arena_close(factor->arena);
    *factor = wanted;
    factor->arena = gm_arena_made(factor_stages, &(struct factoring){own, factor});
    return factor->arena ? factor : NULL;
}

/* gm_loops.correct */
static bool correct(const struct gm_problem *problem, const struct gm_stages *stages, double *residual)
{
    struct own *own = own_of(problem);
    const size_t n = own->n;
    pthread_mutex_lock(&own->turn);
    own->seen_time = NAN;
    const bool derived = derive_at(own, stages->y, own->model->system->timed ? stages->y[n - 1] : 0);
    const struct stage_factor *factor = derived ? factor_of(own, stages) : NULL;
    const size_t each = own->rows.rows, size = stages->count * each;
    double *right = factor ? calloc(2 * size, sizeof *right) : NULL;
    for (size_t j = 0; j < stages->count && right; j++) {
        memcpy(right + j * each, residual + j * n, n * sizeof *right);
    }
    for (size_t i = 0; i < size && right && factor->weight; i++) {
        right[i] *= factor->weight[i];
    }
    bool solved = right != NULL;
    if (solved && factor->cholesky) {
        gm_cholesky_solve(factor->cholesky, right, right + size);
    } else {
        solved = solved && gm_lu_apply(factor->lu, right, right + size);
    }
    for (size_t j = 0; j < stages->count && solved; j++) {
        memcpy(residual + j * n, right + size + j * each, n * sizeof *right);
    }
    free(right);
    pthread_mutex_unlock(&own->turn);
    return solved;
}

/* ---- the problem ---- */

/* Marks the edges of the boundary that are on a part. Leaves the body if there is none of this name; `line` is the word
   of its line. */
static void mark_part(const struct own *own, const char *line, const char *part, bool *edges)
{
    const struct gm_complex *complex = own->space.complex;
    const bool all = strcmp(part, "all") == 0 && complex->boundary > 0;
    const long group = all ? 0 : gm_triangulation_group(&own->file, part);
    char groups[200];
    gm_arena_refuse_if(own->arena, !all && group == 0,
                       "%s: %.40s is not a part of the boundary; the parts of %.60s are: %s", line, part,
                       gm_system_item_of(own->model->system, GM_WORD_MESH, 0)->name,
                       gm_triangulation_group_names(&own->file, groups, sizeof groups));
    memset(edges, 0, complex->edges * sizeof *edges);
    for (size_t b = 0; b < complex->boundary; b++) {
        const size_t e = (size_t)complex->boundary_edge[b];
        edges[e] = all || gm_triangulation_has(&own->file, e, group);
    }
}

/* Makes the matrices of lines that close dual cells: half of an edge belongs to each of its ends. Later lines of the
   same let win. */
static void make_closings(struct own *own)
{
    const struct gm_user_system *system = own->model->system;
    const struct gm_complex *complex = own->space.complex;
    struct gm_arena *arena = own->arena;
    own->closings = gm_arena_take(arena, system->item_count + 1, sizeof *own->closings);
    bool *edges = gm_arena_take(arena, complex->edges, sizeof *edges),
         *later = gm_arena_take(arena, complex->edges, sizeof *later);
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word != GM_WORD_BOUNDARY || item->count < 2) {
            continue;
        }
        mark_part(own, "boundary", item->name, edges);
        for (size_t j = i + 1; j < system->item_count; j++) {
            const struct gm_system_item *next = &system->items[j];
            if (next->word != GM_WORD_BOUNDARY || next->count < 2 || next->nodes[1] != item->nodes[1]) {
                continue;
            }
            mark_part(own, "boundary", next->name, later);
            for (size_t e = 0; e < complex->edges; e++) {
                edges[e] &= !later[e];
            }
        }
        struct gm_matrix_entries entries = gm_matrix_entries(arena, 2 * complex->edges);
        for (size_t e = 0; e < complex->edges; e++) {
            for (size_t k = 0; k < 2 && edges[e]; k++) {
                gm_matrix_put(&entries, (size_t)complex->edge[2 * e + k], e, 0.5);
            }
        }
        own->closings[i] = gm_matrix_of(&entries, complex->vertices, complex->edges);
    }
}

/* Makes the rows of integrals along parts of the boundary, with the surface on the left. */
static void make_around(struct own *own)
{
    const struct gm_user_system *system = own->model->system;
    const struct gm_complex *complex = own->space.complex;
    struct gm_arena *arena = own->arena;
    bool *edges = gm_arena_take(arena, complex->edges, sizeof *edges);
    own->around = gm_arena_take(arena, system->boundary_count + 1, sizeof *own->around);
    for (size_t i = 0; i < system->boundary_count; i++) {
        struct gm_matrix_entries entries = gm_matrix_entries(arena, complex->edges);
        mark_part(own, "observe", system->boundaries[i], edges);
        for (size_t e = 0; e < complex->edges; e++) {
            if (edges[e]) {
                gm_matrix_put(&entries, 0, e, complex->edge_triangle[2 * e] >= 0 ? 1 : -1);
            }
        }
        own->around[i] = gm_matrix_of(&entries, 1, complex->edges);
    }
}

static void open_values(struct own *own, struct gm_form_values *values, const struct gm_form_program *program,
                        const double *variables)
{
    gm_form_values_open(values, own->arena, program, &own->space, own->model->system, variables);
}

/* True if a program has a step of this kind and number. */
static bool has_step(const struct gm_form_program *program, enum gm_form_step_kind kind, size_t number)
{
    size_t i = 0;
    while (i < program->count && (program->steps[i].kind != kind || program->steps[i].number != number)) {
        i++;
    }
    return i < program->count;
}

/* s at the points of samples on a part of the boundary: the length of its edges before them, with the surface on the
   left, from where a chain of them begins; a closed chain begins at its vertex of the lowest number. */
static void measure_arcs(struct own *own, const bool *edges, struct gm_form_type type, double *arc)
{
    const struct gm_complex *complex = own->space.complex;
    const size_t vertices = complex->vertices, count = type.degree == 1 ? 5 * complex->edges : vertices;
    const double *points = gm_form_points_of(&own->space, own->arena, type)->point;
    int *leaving = gm_arena_take(own->arena, 2 * vertices, sizeof *leaving), *entering = leaving + vertices;
    for (size_t e = 0; e < complex->edges; e++) {
        const bool back = complex->edge_triangle[2 * e] < 0;
        if (edges[e]) {
            leaving[complex->edge[2 * e + back]] = entering[complex->edge[2 * e + !back]] = (int)e + 1;
        }
    }
    for (size_t i = 0; i < 2 * vertices; i++) { /* open chains, then closed ones */
        const size_t begin = i % vertices;
        double s = 0;
        for (size_t v = begin; leaving[v] > 0 && (i >= vertices || s > 0 || entering[v] == 0);) {
            const size_t e = (size_t)leaving[v] - 1;
            double tail[3];
            gm_complex_vertex(complex, v, tail);
            for (size_t k = 5 * e; k < 5 * e + 5 && type.degree == 1; k++) {
                arc[k] = s + gm_hypot(gm_hypot(points[k] - tail[0], points[count + k] - tail[1]),
                                      points[2 * count + k] - tail[2]);
            }
            leaving[v] = 0;
            s += complex->length[e];
            v = (size_t)complex->edge[2 * e + ((size_t)complex->edge[2 * e] == v)];
            if (type.degree != 1 && v != begin) {
                arc[v] = s;
            }
        }
    }
}

/* Measures s for the samples of lines `boundary:` that hold it. */
static void make_arcs(struct own *own, struct gm_form_values *values)
{
    const struct gm_form_program *program = values->program;
    bool *edges = gm_arena_take(own->arena, own->space.complex->edges, sizeof *edges);
    values->arcs = own->arcs;
    for (size_t i = 0; i < program->count; i++) {
        const struct gm_form_step *step = &program->steps[i];
        if (step->kind == GM_STEP_SAMPLE && step->number > 0 && !own->arcs[step->number - 1]) {
            double *arc = doubles(own, gm_form_points_of(&own->space, own->arena, step->type)->count);
            mark_part(own, "boundary", own->model->system->items[step->number - 1].name, edges);
            measure_arcs(own, edges, step->type, arc);
            own->arcs[step->number - 1] = arc;
        }
    }
}

static void hold_number(struct own *own, size_t root, size_t from, double sign)
{
    const size_t variable = own->model->system->items[own->model->held_item[root]].variable;
    const bool unknown = own->model->system->forms[variable].unknown;
    const size_t to = own->offset[variable] + from, count = own->held_count++;
    own->held_numbers = gm_arena_grown(own->arena, own->held_numbers, count, sizeof *own->held_numbers);
    own->held_numbers[count] = (struct held_number){root, from, to, sign, unknown};
    (unknown ? own->held_unknown : own->held)[to] = true;
}

/* Finds the numbers of forms that are held, and their values at the start. */
static void hold(struct own *own, const double *variables)
{
    const struct gm_form_model *model = own->model;
    const struct gm_user_system *system = model->system;
    const struct gm_complex *complex = own->space.complex;
    bool *edges = gm_arena_take(own->arena, complex->edges, sizeof *edges), given = false,
         *own_edges = gm_arena_take(own->arena, complex->edges, sizeof *own_edges);
    open_values(own, &own->held_values, &model->held, variables);
    make_arcs(own, &own->held_values);
    for (size_t i = 0; i < model->held.root_count; i++) {
        const struct gm_form_step *step = &model->held.steps[model->held.roots[i]];
        const bool density = step->kind == GM_STEP_SAMPLE && step->components == 1;
        const struct gm_system_item *item = &system->items[model->held_item[i]];
        const int degree = system->forms[item->variable].degree;
        mark_part(own, "boundary", item->name, edges);
        for (size_t e = 0; e < complex->edges; e++) {
            if (edges[e] && degree == 1) {
                own_edges[e] = true;
                hold_number(
                    own, i, e,
                    density && complex->edge_triangle[2 * e] < 0 ? -1 : 1); /* the surface is on its left */
            }
            for (size_t k = 0; k < 2 && edges[e] && degree != 1; k++) {
                hold_number(own, i, (size_t)complex->edge[2 * e + k], 1);
            }
        }
    }
    own->held_changes = needs_of(&model->held) != 0;
    if (!holds_forms(model)) {
        set_held(own, 0, own->start);
    }
    for (size_t k = 0; k < own->held_count; k++) {
        const struct held_number *held = &own->held_numbers[k];
        given |= system->forms[system->items[model->held_item[held->root]].variable].degree == 1 &&
                 (held->unknown ? own->given : own->start)[held->to] != 0;
    }
    const size_t inverse = GM_MATRIX_DUAL_STAR1;
    const bool inverts = own->space.mass && (has_step(&model->equations, GM_STEP_MATRIX, inverse) ||
                                             has_step(&model->rates, GM_STEP_MATRIX, inverse));
    gm_arena_refuse_if(
        own->arena, (given || own->held_changes) && inverts,
        "a 1-form is held at values that are not 0, and its star is inverted: write star(f) = k*d(p), "
        "not f = -k*star(d(p)), or take star=circumcentric");
    gm_arena_need(own->arena, gm_form_space_hold(&own->space, own_edges));
}

static void close_turn(void *turn)
{
    pthread_mutex_destroy(turn);
}

/* Lays out the state: fields in their order, both groups of a split from equal halves. */
static void lay_out(struct own *own)
{
    const struct gm_form_model *model = own->model;
    size_t at = 0, first = 0;
    for (size_t k = 0; k < model->unknown_count; k++) {
        own->offset[model->unknowns[k]] = own->unknowns;
        own->unknowns += size_of(own, model->unknowns[k]);
    }
    for (size_t k = 0; k < model->field_count; k++) {
        first = k == model->split ? at : first;
        own->offset[model->fields[k]] = at;
        at += size_of(own, model->fields[k]);
    }
    own->n = at > 0 ? at : 1; /* a steady problem has a state of nothing */
    if (model->split > 0) {
        own->half = first > at - first ? first : at - first;
        for (size_t k = model->split; k < model->field_count; k++) {
            own->offset[model->fields[k]] += own->half - first;
        }
        own->n = 2 * own->half;
    }
    own->n += model->system->timed;
}

static void take_start(struct own *own, const double *variables)
{
    const struct gm_form_model *model = own->model;
    struct gm_form_values starts;
    open_values(own, &starts, &model->starts, variables);
    gm_form_values_run(&starts, 0, own->forms);
    for (size_t k = 0; k < model->field_count; k++) {
        const size_t form = model->fields[k], size = size_of(own, form);
        const double *values = gm_form_values_root(&starts, k);
        memcpy(own->start + own->offset[form], values, size * sizeof *values);
        for (size_t j = 0; j < size; j++) {
            if (!isfinite(values[j])) {
                gm_arena_refuse(own->arena, "start: %s is not finite at its number %zu",
                                model->system->variables[form].name, j + 1);
            }
        }
    }
}

/* Holds values that are made of forms, at the start. With numbers for a start that are not 0 they have to be the same
   once they are held. */
static void hold_forms(struct own *own)
{
    double *state = doubles(own, own->n);
    for (size_t i = 0; i < own->n; i++) {
        state[i] = own->start[i] + (i % 7 + 1) / 8.0;
    }
    place_forms(own, state, 0);
    solve(own, 0);
    gm_arena_refuse_if(own->arena, set_held(own, 0, own->current) > 1e-9,
                       "boundary: a value that is held is made of forms that it changes");
    place_forms(own, own->start, 0);
    memcpy(own->start, own->current, own->n * sizeof *own->start);
}

static void make(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    const struct gm_form_model *model = opening->model;
    const struct gm_user_system *system = model->system;
    const double *variables = opening->variables;
    struct own *own = opening->own = gm_arena_take(arena, 1, sizeof *own);
    struct gm_complex *complex = opening->file.complex;
    own->arena = arena;
    own->model = model;
    own->seen_time = NAN;
    own->file = opening->file;
    opening->file = (struct gm_triangulation){0};
    gm_arena_keep(arena, &own->file, gm_triangulation_close);
    gm_arena_need(arena, gm_form_space_open(&own->space, complex));
    gm_arena_keep(arena, &own->space, gm_form_space_close);
    own->space.interior = opening->choice.interior;
    own->choice = opening->choice;
    own->variables = doubles(own, system->variable_count);
    memcpy(own->variables, variables, system->variable_count * sizeof *variables);
    gm_arena_need(arena, pthread_mutex_init(&own->turn, NULL) == 0);
    gm_arena_keep(arena, &own->turn, close_turn);
    own->offset = gm_arena_take(arena, system->n + 1, sizeof *own->offset);
    own->forms = gm_arena_take(arena, system->n + 1, sizeof *own->forms);
    own->defect = doubles(own, system->n + 1);
    own->remainder = doubles(own, system->n + 1);
    lay_out(own);
    own->unknown = doubles(own, own->unknowns + 1);
    own->derived_at = doubles(own, own->n);
    own->given = doubles(own, own->unknowns + 1);
    own->start = doubles(own, own->n);
    own->seen = doubles(own, own->n);
    own->current = doubles(own, own->n);
    own->scratch = doubles(own, 3 * (complex->edges + 1));
    own->held = gm_arena_take(arena, own->n, sizeof *own->held);
    own->held_unknown = gm_arena_take(arena, own->unknowns + 1, sizeof *own->held_unknown);
    own->cell = doubles(own, own->n);
    for (size_t i = 0; i < own->n; i++) {
        own->cell[i] = 1;
    }
    for (size_t k = 0; k < model->field_count; k++) {
        const struct gm_form_type type = type_of(system, model->fields[k]);
        const double *cell = cells_of(own, (type.degree == 2) != type.dual);
        for (size_t j = 0; j < size_of(own, model->fields[k]) && type.degree != 1; j++) {
            own->cell[own->offset[model->fields[k]] + j] = type.degree == 0 ? cell[j] : 1 / cell[j];
        }
    }
    own->arcs = gm_arena_take(arena, system->item_count + 1, sizeof *own->arcs);
    make_closings(own);
    open_values(own, &own->rates, &model->rates, variables);
    open_values(own, &own->exacts, &model->exacts, variables);
    open_values(own, &own->equations, &model->equations, variables);
    open_values(own, &own->observed, &model->observed, variables);
    take_start(own, variables);
    hold(own, variables);
    make_around(own);
    own->rates.around = own->equations.around = own->observed.around = own->held_values.around = own->around;
    make_arcs(own, &own->rates);
    make_arcs(own, &own->equations);
    make_arcs(own, &own->observed);
    own->rates.closings = own->equations.closings = own->observed.closings = own->held_values.closings =
        own->closings;
    own->equations.fixed = own->held_changes ? 0 : GM_NEEDS_UNKNOWNS; /* it is run at those that are given */
    if (own->unknowns > 0) {
        memcpy(own->unknown, own->given, own->unknowns * sizeof *own->unknown);
        point_at(own, own->start);
        gm_form_values_run(&own->equations, 0, own->forms);
        assemble(own);
    }
    if (holds_forms(model)) {
        hold_forms(own);
    }
    gm_arena_keep(arena, own, drop_factors);
    own->loops = (struct gm_loops){.field = field, .correct = correct};
    own->facets.forms = true;
    own->facets.stiff = model->unknown_count == 0 && is_linear(&model->rates) && !holds_forms(model);
    if (model->split > 0 && !system->timed) {
        own->loops.velocity = velocity;
        own->loops.force = force;
        own->split.no_potential = true;
        own->facets.split = &own->split;
    }
    for (size_t isa = 0; isa < GM_ISA_COUNT; isa++) {
        own->facets.loops[isa] = &own->loops;
    }
}

/* True if a program takes a part of a 1-form, for which equations are solved. */
static bool decomposes(const struct gm_form_program *program)
{
    return has_step(program, GM_STEP_EXACT, 0) || has_step(program, GM_STEP_COEXACT, 0);
}

static struct gm_problem problem_of(struct own *own)
{
    return (struct gm_problem){.name = "forms",
                               .kind = &gm_kind_ode,
                               .n = own->n,
                               .m = 1,
                               .facets = &own->facets,
                               .parameters = own};
}

bool gm_form_problem_open(struct gm_problem *problem, const struct gm_form_model *model,
                          struct gm_form_choice choice, const double *variables, struct gm_fault *fault)
{
    *fault = (struct gm_fault){0};
    struct opening opening = {.model = model, .variables = variables, .choice = choice};
    struct own *idle = exchange_idle(model->idle, NULL);
    if (idle && idle->choice.star == choice.star && idle->choice.interior == choice.interior &&
        memcmp(idle->variables, variables, model->system->variable_count * sizeof *variables) == 0) {
        idle->seen_time = NAN;
        *problem = problem_of(idle);
        return true;
    }
    close_own(idle);
    const bool opened = open_mesh(&opening, choice.star, fault);
    const bool solves =
        opened && (model->unknown_count > 0 || decomposes(&model->rates) || decomposes(&model->equations) ||
                   decomposes(&model->observed) || opening.file.complex->star != GM_STAR_CIRCUMCENTRIC);
    if (solves && gm_cholesky_missing()) { /* else the library is not even loaded */
        gm_triangulation_close(&opening.file);
        return gm_fail(fault, 0, "equations of forms are solved by SuiteSparse: %s", gm_cholesky_missing());
    }
    struct gm_arena *arena = opened ? gm_arena_open() : NULL;
    if (!arena || !gm_arena_run(arena, make, &opening)) {
        if (arena && !fault->sentence[0]) {
            gm_fail(fault, 0, "%s", gm_arena_reason(arena));
        }
        gm_triangulation_close(&opening.file);
        gm_arena_close(arena);
        return false;
    }
    *problem = problem_of(opening.own);
    return true;
}

void gm_form_problem_close(struct gm_problem *problem)
{
    if (problem->parameters) {
        struct own *own = own_of(problem);
        close_own(exchange_idle(own->model->idle, own));
        problem->parameters = NULL;
    }
}

void gm_form_start(const struct gm_problem *problem, double *y)
{
    memcpy(y, own_of(problem)->start, problem->n * sizeof *y);
}

const struct gm_form_space *gm_form_space_of(const struct gm_problem *problem)
{
    return &own_of(problem)->space;
}

const struct gm_form_model *gm_form_model_of(const struct gm_problem *problem)
{
    return own_of(problem)->model;
}

/* Solves for the unknowns of a state, unless it was the last one, and takes the turn. */
static struct own *look(const struct gm_problem *problem, const double *y, double t)
{
    struct own *own = own_of(problem);
    pthread_mutex_lock(&own->turn);
    if (own->seen_time != t || memcmp(own->seen, y, problem->n * sizeof *y) != 0) {
        memcpy(own->seen, y, problem->n * sizeof *y);
        own->seen_time = t;
        place_forms(own, own->seen, t);
        own->measures = true;
        solve(own, t);
        own->observes = own->measures = false;
    }
    return own;
}

const double *gm_form_observed(const struct gm_problem *problem, const double *y, double t, size_t observed)
{
    struct own *own = look(problem, y, t);
    if (!own->observes) {
        gm_form_values_run(&own->observed, t, own->forms);
        own->observes = true;
    }
    pthread_mutex_unlock(&own->turn);
    return gm_form_values_root(&own->observed, observed);
}

const double *gm_form_numbers(const struct gm_problem *problem, const double *y, double t, size_t named)
{
    const struct gm_form_named *form = &own_of(problem)->model->named[named];
    if (!form->declared) {
        return gm_form_observed(problem, y, t, form->number);
    }
    struct own *own = look(problem, y, t);
    pthread_mutex_unlock(&own->turn);
    return own->forms[form->number];
}

double gm_form_error(const struct gm_problem *problem, const double *y, double t, size_t form)
{
    struct own *own = look(problem, y, t);
    const struct gm_user_system *system = own->model->system;
    const struct gm_form_type type = type_of(system, form);
    const size_t n = size_of(own, form);
    size_t number = 0;
    for (size_t i = 0; i < form; i++) {
        number += system->forms[i].exact != GM_NO_NODE;
    }
    gm_form_values_run(&own->exacts, t, own->forms);
    const double *exact = gm_form_values_root(&own->exacts, number), *found = own->forms[form],
                 *cell = cells_of(own, type.dual);
    double *difference = own->scratch, *known = difference + n, *weighted = known + n, mean = 0;
    if (system->forms[form].unknown && own->piece[own->offset[form]] >= 0) {
        for (size_t i = 0; i < n; i++) {
            mean += cell[i] * exact[i] / own->space.complex->total_area;
        }
    }
    for (size_t i = 0; i < n; i++) {
        known[i] = exact[i] - mean;
        difference[i] = found[i] - known[i];
    }
    const double size = sqrt(gm_form_square(&own->space, type, known, weighted)),
                 error = sqrt(gm_form_square(&own->space, type, difference, weighted));
    pthread_mutex_unlock(&own->turn);
    return error / (size > 0 ? size : 1);
}

double gm_form_balance(const struct gm_problem *problem, const double *y, double t, size_t form,
                       double *defect)
{
    struct own *own = look(problem, y, t);
    pthread_mutex_unlock(&own->turn);
    *defect = own->defect[form];
    return own->remainder[form];
}

size_t gm_form_factors(const struct gm_problem *problem, struct gm_form_factor factors[GM_FORM_FACTORS])
{
    const struct own *own = own_of(problem);
    const struct gm_hodge *hodge = own->rates.hodge       ? own->rates.hodge
                                   : own->equations.hodge ? own->equations.hodge
                                                          : own->observed.hodge;
    const struct {
        const char *matrix;
        const struct gm_cholesky *cholesky;
        const struct gm_lu *lu;
    } all[GM_FORM_FACTORS] = {{"equations", own->factor, own->lu},
                              {"mass matrix of 1-forms", own->space.mass, NULL},
                              {"potential of exact parts", hodge ? gm_hodge_factor(hodge) : NULL, NULL},
                              {"coexact parts", NULL, hodge ? gm_hodge_lu(hodge) : NULL}};
    size_t count = 0;
    for (size_t i = 0; i < GM_FORM_FACTORS; i++) {
        if (all[i].cholesky || all[i].lu) {
            const size_t entries =
                all[i].cholesky ? gm_cholesky_entries(all[i].cholesky) : gm_lu_entries(all[i].lu);
            const size_t bytes = sizeof(double) + (all[i].lu ? sizeof(int) : 0); /* of LU with its place */
            factors[count++] = (struct gm_form_factor){all[i].matrix, all[i].cholesky, entries,
                                                       (double)(entries * bytes) / 1e6};
        }
    }
    return count;
}

double gm_form_drift(const struct gm_problem *problem, size_t observed)
{
    const struct own *own = own_of(problem);
    const size_t n = own->n;
    double *y = calloc(3 * n, sizeof *y), *f = y ? y + n : NULL, *at = y ? f + n : NULL, size = 0, rate = 0;
    const double part = 1e-3, weights[5] = {1, -8, 0, 8, -1};
    double change = 0, value = 0;
    uint32_t seed = 1;
    for (size_t i = 0; i < n && y; i++) {
        size = fmax(size, fabs(own->start[i]));
    }
    for (size_t i = 0; i < n && y; i++) {
        seed = seed * 1664525u + 1013904223u;
        y[i] = own->start[i] +
               (own->held[i] || i + own->model->system->timed == n ? 0 : size * (seed / 0x1p33 - 0.25));
    }
    if (y) {
        field(problem, y, f, 1);
    }
    for (size_t i = 0; i < n && y; i++) {
        rate = fmax(rate, fabs(f[i]));
    }
    for (int k = 0; k < 5 && y; k++) { /* exact for polynomials of degree 4 */
        for (size_t i = 0; i < n; i++) {
            at[i] = y[i] + (k - 2) * part * size / rate * f[i];
        }
        const double here =
            *gm_form_observed(problem, at, own->model->system->timed ? at[n - 1] : 0, observed);
        change += weights[k] * here / (12 * part);
        value = k == 2 ? here : value;
    }
    const double drift = y ? fabs(change / value) : NAN;
    free(y);
    return drift;
}
