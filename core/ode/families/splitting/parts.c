/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splittings of f = f_1 + ... + f_k into parts with exact flows F_i: a list of F_i(c h), as
       lie(A, B)       F_B(h) F_A(h)
       strang(A, B)    F_A(h/2) F_B(h) F_A(h/2)
   of the parts that a row names, or of all pieces that a system has. A part that is not solved may take steps of
   another scheme. The time is moved by the first part that does not hold it.

   With a corrector the flow of p' = B'' M^-1 B' over c h^3, B' = dB/dq and p M^-1 p/2 in A, is added at both ends.
   G. Strang, SIAM J. Numer. Anal. 5 (1968) 506; R.I. McLachlan & G.R.W. Quispel, Acta Numerica 11 (2002) 341;
   J. Laskar & P. Robutel, Celest. Mech. Dyn. Astron. 80 (2001) 39. */
#include "core/ode/families/splitting/parts.h"

#include <stdio.h>

#include "core/expression/identity.h"
#include "core/expression/nearest.h"
#include "core/expression/reader.h"
#include "core/functions/functions.h"
#include "core/ode/families/base_scheme.h"
#include "core/ode/families/composition.h"
#include "core/ode/families/family.h"
#include "core/ode/families/invariants/held.h"
#include "core/ode/families/splitting/jacobi.h"
#include "core/ode/families/splitting/kepler.h"
#include "core/ode/families/splitting/linear_flow.h"

/* The ways in which the flow of a part is computed, with the words for them. */
enum how {
    KICK,
    ROTATION,
    KEPLER,
    JACOBI_KICK, /* this and the next move a state in Jacobi coordinates */
    JACOBI_KEPLER,
    SHEAR,
    SERIES,
    EXPONENTIAL,
    VOLUME,
    BRACKET,
    STEPS,
    HOWS
};
static const char *const words[HOWS] = {
    [KICK] = "a kick",
    [ROTATION] = "linear: a rotation of each coordinate and its momentum",
    [KEPLER] = "Kepler's motion, in universal variables",
    [JACOBI_KICK] = "a kick in Jacobi coordinates",
    [JACOBI_KEPLER] = "Kepler's motions in Jacobi coordinates, in universal variables",
    [SHEAR] = "a shear: what moves depends on what rests",
    [SERIES] = "linear in what moves: a series",
    [EXPONENTIAL] = "linear: exp(h L)",
};

struct part {
    enum how how;
    bool timed; /* it holds the time */
    struct gm_linear_flow flow;
    struct gm_tape tape;
    double inverse_mass, mu; /* KEPLER: of q' = inverse_mass p, q'' = -mu q/|q|^3 */
    /* KICK: the force on the momenta */
    void (*force)(const struct gm_problem *problem, const double *q, double *force, size_t m);
    /* STEPS: the scheme, with the part as its problem */
    struct gm_base_scheme by;
    struct gm_ode ode;
    struct gm_loops loops;
    struct gm_sparse jacobian;
    struct gm_tape slopes;
};

struct flow {
    size_t part;
    double fraction;
    bool cubed; /* over fraction h^3 */
    /* of exp(fraction h L), with its constant as the last column */
    struct entry {
        size_t row, column;
        double value;
    } * entries;
    size_t count;
};

struct work {
    struct gm_arena *arena;
    struct gm_formula graph;
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    const struct gm_parts_row *row;
    struct part *parts;
    size_t column;           /* of the part that is opened, from 1; 0: no word names it */
    size_t counted, carrier; /* counted: the last part with a flow; carrier: the part that moves the time */
    struct flow *flows;
    size_t flow_count;
    double dt; /* of the matrices */
    /* values: of a part's tape. If a step begins with the flow it ends with, they are known at the state `kept`. */
    double *values, *scratch, *moved, *kept, *member, *matrix;
    bool known, jacobi; /* jacobi: the state is in Jacobi coordinates */
    bool carries,
        continued; /* the task carries its end to the next one; it continues from that of the last one */
};

/* If all flows are in Jacobi coordinates, no bits depend on the tasks that a run is made in: its memory is dt, the state
   that a task ended with, and the one before the conversion, and before a flow that the next step joins, from which the
   next task continues. */
enum { CARRIED_DT, ENDED };

static bool is_jacobi_part(const struct gm_problem *problem, const struct gm_named_part *named)
{
    const bool known = strcmp(named->name, "kepler") == 0 || strcmp(named->name, "interaction") == 0;
    return known && gm_ode_of(problem)->gravity && !named->by && !gm_part_is_given(problem, named->name);
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_parts_row *row = scheme->coefficients;
    bool carries = row->parts > 1;
    for (size_t i = 0; i < row->parts; i++) {
        carries = carries && is_jacobi_part(problem, &row->list[i]);
    }
    return carries ? ENDED + 2 * problem->n * problem->m : 0;
}

static bool is_jacobi(const struct part *part)
{
    return part->how == JACOBI_KICK || part->how == JACOBI_KEPLER;
}

/* ---- parts as formulas ---- */

static void part_field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_tape_values(&((const struct part *)problem->parameters)->tape, y, f, m);
}

static void part_jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    const struct part *part = problem->parameters;
    double values[GM_NEWTON_LARGEST * GM_NEWTON_LARGEST];
    gm_tape_values(&part->slopes, y, values, 1);
    memset(matrix, 0, problem->n * problem->n * sizeof *matrix);
    for (size_t i = 0; i < part->jacobian.count; i++) {
        matrix[part->jacobian.entries[i].row * problem->n + part->jacobian.entries[i].column] = values[i];
    }
}

/* " (column 8)": where a word names the part that is opened; "" if no word does. */
static const char *column_of(const struct work *work)
{
    return work->column > 0 ? gm_arena_print(work->arena, " (column %zu)", work->column) : "";
}

/* Opens a part that takes steps of a scheme, which may need a Jacobian and no other structure. */
static void open_steps(struct work *work, struct part *part, const char *name, const gm_node_id *rates)
{
    const size_t n = work->problem->n;
    const struct gm_scheme *by = part->by.scheme;
    if (!gm_scheme_composes(by) || by->needs & ~(unsigned)GM_NEEDS_JACOBIAN || n > GM_NEWTON_LARGEST) {
        gm_arena_refuse(work->arena, "a scheme for any field, of at most %d components, not %s by %s%s",
                        GM_NEWTON_LARGEST, name, by->name, column_of(work));
    }
    part->jacobian = gm_sparse_jacobian(work->arena, &work->graph, rates, n, NULL, n);
    const gm_node_id *slopes = gm_sparse_nodes(work->arena, NULL, 0, &part->jacobian);
    gm_tape_keep(work->arena, &part->tape, gm_tape_open(&part->tape, &work->graph, rates, n, n, NULL));
    gm_tape_keep(work->arena, &part->slopes,
                 gm_tape_open(&part->slopes, &work->graph, slopes, part->jacobian.count, n, NULL));
    part->how = STEPS;
    part->loops = (struct gm_loops){.field = part_field, .jacobian = part_jacobian};
    const struct gm_problem problem = {
        .name = name, .kind = &gm_kind_ode, .n = n, .m = 1, .parameters = part, .facets = &part->ode};
    for (int isa = 0; isa < GM_ISA_COUNT; isa++) {
        part->ode.loops[isa] = &part->loops;
    }
    gm_base_open(work->arena, &part->by, by, &problem, 1);
}

static const char *name_of(size_t i, const void *names)
{
    return ((const char *const *)names)[i];
}

/* The names of all parts, or the nearest one, in words. */
static const char *other_names(const struct work *work, const char *name)
{
    const struct gm_parts *parts = gm_ode_of(work->problem)->parts;
    size_t count = 0;
    const char *all = "";
    for (; parts->names[count]; count++) {
        all = gm_arena_print(work->arena, "%s%s%s", all, count ? ", " : "", parts->names[count]);
    }
    const char *near = gm_nearest(name, count, name_of, parts->names);
    if (near && strcmp(near, name) == 0) {
        return "this system does not have it";
    }
    return near ? gm_arena_print(work->arena, "did you mean %s", near)
                : gm_arena_print(work->arena, count ? "there are %s" : "this system has no parts%s", all);
}

static const gm_node_id *rates_of(struct work *work, const char *name)
{
    const struct gm_parts *parts = gm_ode_of(work->problem)->parts;
    gm_node_id *rates = gm_arena_take(work->arena, work->problem->n + 1, sizeof *rates);
    if (!parts) {
        gm_arena_refuse(work->arena, "a field that is a sum of named parts");
    }
    if (!parts->rates(work->arena, work->problem, name, &work->graph, rates)) {
        gm_arena_refuse(work->arena, "a part %.40s%s; %s", name, column_of(work), other_names(work, name));
    }
    return rates;
}

/* Returns true if a node is a constant of all states. */
static bool is_constant(struct work *work, gm_node_id node)
{
    const size_t n = work->problem->n;
    gm_node_id *gradient = gm_arena_take(work->arena, n, sizeof *gradient);
    bool constant = gm_gradient(&work->graph, node, NULL, n, gradient);
    for (size_t c = 0; c < n && constant; c++) {
        const enum gm_identity identity = gm_identity_of(&work->graph, gradient[c], NULL, 0);
        constant = identity == GM_ZERO_PROVED || identity == GM_ZERO_TESTED;
    }
    return constant;
}

/* Returns true if the rates are those of |p|^2/(2m) - k/|q| of one body in a plane or in space, with k > 0, and takes
   1/m and k/m: q_i'/p_i and p_i' |q|^3/q_i are the same constants for all i. */
static bool find_kepler(struct work *work, struct part *part, const gm_node_id *rates)
{
    const size_t n = work->problem->n, half = n / 2;
    struct gm_formula *graph = &work->graph;
    double y[6] = {0.3, 0.5, 0.7, 0.9, 1.1, 1.3}, at[6];
    gm_node_id square = gm_formula_constant(graph, 0), ratios[6];
    if (n != 4 && n != 6) {
        return false;
    }
    for (size_t i = 0; i < half; i++) {
        const gm_node_id q = gm_formula_variable(graph, i);
        square = gm_sum(graph, square, gm_product(graph, q, q));
    }
    const gm_node_id cube =
        gm_product(graph, square, gm_simplified(graph, GM_OPERATION_SQRT, square, square));
    bool found = true;
    for (size_t i = 0; i < n && found; i++) {
        const gm_node_id above = i < half ? rates[i] : gm_product(graph, rates[i], cube);
        ratios[i] =
            gm_simplified(graph, GM_OPERATION_DIVIDE, above, gm_formula_variable(graph, (i + half) % n));
        found = is_constant(work, ratios[i]);
    }
    gm_arena_need(work->arena, !graph->failed);
    double *values = gm_arena_take(work->arena, graph->count, sizeof *values);
    gm_formula_evaluate(graph, graph->count, y, values);
    for (size_t i = 0; i < n && found; i++) {
        at[i] = values[ratios[i]];
        found = fabs(at[i] - at[i / half * half]) <= 1e-14 * fabs(at[i]);
    }
    part->inverse_mass = found ? at[0] : 0;
    part->mu = found ? -at[0] * at[half] : 0;
    return part->mu > 0;
}

static void open_formula(struct work *work, struct part *part, const char *name, const gm_node_id *rates)
{
    const size_t n = work->problem->n;
    if (!gm_linear_flow_derive(work->arena, &part->flow, &work->graph, rates, n, n)) {
        if (find_kepler(work, part, rates)) {
            part->how = KEPLER;
            return;
        }
        gm_arena_refuse(
            work->arena,
            "a known flow of %.40s%s, which is neither a drift, a kick, linear nor Kepler's motion of a body: "
            "write %.40s by gauss4",
            name, column_of(work), name);
    }
    const size_t slopes = part->flow.slopes.count;
    gm_tape_keep(work->arena, &part->tape,
                 gm_tape_open(&part->tape, &work->graph, part->flow.nodes, n + slopes, n, NULL));
    part->how = slopes == 0 ? SHEAR : part->flow.constant && n <= GM_NEWTON_LARGEST ? EXPONENTIAL : SERIES;
}

/* Opens a part by its name: what the structure's facets solve, unless the file gives the name, or a formula. */
static void open_part(struct work *work, struct part *part, const struct gm_named_part *named)
{
    const struct gm_ode *ode = gm_ode_of(work->problem);
    const char *name = named->name;
    work->column = named->column;
    const bool given = named->by || gm_part_is_given(work->problem, name);
    part->by.scheme = named->by;
    if (!given && ode->kepler_split && strcmp(name, "kepler") == 0) {
        *part = (struct part){.how = KEPLER, .inverse_mass = 1, .mu = 1};
    } else if (is_jacobi_part(work->problem, named)) {
        part->how = name[0] == 'k' ? JACOBI_KEPLER : JACOBI_KICK;
    } else if (!given && ode->kepler_split && strcmp(name, "interaction") == 0) {
        part->force = ode->kepler_split->perturbing_force;
    } else if (!given && ode->fast_linear && strcmp(name, "linear") == 0) {
        part->how = ROTATION;
    } else if (!given && ode->fast_linear && strcmp(name, "rest") == 0) {
        part->force = ode->fast_linear->slow_force;
    } else {
        const gm_node_id *rates = rates_of(work, name);
        bool *time = gm_arena_take(work->arena, work->problem->n, sizeof *time);
        time[work->problem->n - 1] = ode->parts->timed;
        for (size_t i = 0; i < work->problem->n; i++) {
            part->timed = part->timed || gm_formula_holds(&work->graph, rates[i], time, work->problem->n);
        }
        (named->by ? open_steps : open_formula)(work, part, name, rates);
    }
}

/* ---- the list of flows ---- */

/* Neighbours of one part are one flow. */
static void add_flow(struct work *work, size_t part, double fraction)
{
    struct flow *last = work->flow_count > 0 ? &work->flows[work->flow_count - 1] : NULL;
    if (last && last->part == part && work->parts[part].how != STEPS) {
        last->fraction += fraction;
    } else {
        work->flows[work->flow_count++] = (struct flow){.part = part, .fraction = fraction};
    }
}

/* The pieces of the system's own, which the facets solve. */
static void list_pieces(struct work *work)
{
    const struct gm_ode *ode = gm_ode_of(work->problem);
    const struct gm_composition *steps = work->row->of_pieces;
    const bool bracket = ode->poisson && ode->poisson->pieces > 0;
    const bool volume = work->scheme->needs & GM_NEEDS_VOLUME || !bracket;
    if (volume && !ode->volume) {
        gm_arena_refuse(work->arena, "pieces whose flows are exact");
    }
    const size_t count = volume ? ode->volume->pieces : ode->poisson->pieces;
    work->counted = count - 1;
    work->parts = gm_arena_take(work->arena, count, sizeof *work->parts);
    work->flows =
        gm_arena_take(work->arena, steps ? 2 * count * (size_t)steps->steps : count, sizeof *work->flows);
    for (size_t i = 0; i < count; i++) {
        work->parts[i].how = volume ? VOLUME : BRACKET;
    }
    for (size_t i = 0; i < count && !steps; i++) {
        add_flow(work, i, 1);
    }
    for (int k = 0; steps && k < steps->steps; k++) {
        const double half = gm_composition_fraction(steps, k) / 2;
        for (size_t i = 0; i < 2 * count; i++) {
            add_flow(work, i < count ? i : 2 * count - 1 - i, half);
        }
    }
}

/* Opens the flow of p' = D g M^-1 g, g = -B', as the last part, and adds it at both ends. */
static void open_corrector(struct work *work, size_t number)
{
    struct gm_formula *graph = &work->graph;
    const size_t n = work->problem->n, half = n / 2;
    const struct gm_named_part *list = work->row->list;
    const gm_node_id *a = rates_of(work, list[0].name), *g = rates_of(work, list[1].name),
                     zero = gm_formula_constant(graph, 0);
    gm_node_id *rates = gm_arena_take(work->arena, n, sizeof *rates),
               *along = gm_arena_take(work->arena, 2 * n, sizeof *along), *masses = along + n;
    bool *momenta = gm_arena_take(work->arena, n, sizeof *momenta),
         good = n % 2 == gm_ode_of(work->problem)->parts->timed && !is_jacobi(&work->parts[0]);
    for (size_t i = 0; i < n; i++) {
        momenta[i] = i >= half && i < 2 * half;
        along[i] = rates[i] = zero;
    }
    for (size_t i = 0; i < half; i++) {
        gm_arena_need(work->arena, gm_gradient(graph, a[i], momenta, n, masses));
        good = good && gm_is_constant(graph, g[i], 0) && !gm_formula_holds(graph, g[half + i], momenta, n);
        for (size_t k = half; k < 2 * half; k++) {
            good = good && graph->nodes[masses[k]].operation == GM_CONSTANT;
            along[i] = gm_sum(graph, along[i], gm_product(graph, masses[k], g[k]));
        }
    }
    for (size_t i = half; i < 2 * half; i++) {
        rates[i] = gm_derivative_along(graph, g[i], along, n);
    }
    gm_arena_need(work->arena, !graph->failed);
    if (!good) {
        gm_arena_refuse(work->arena,
                        "for its corrector a part %s that is quadratic in the momenta, and a part %s of "
                        "coordinates alone",
                        list[0].name, list[1].name);
    }
    open_formula(work, &work->parts[number], "the corrector", rates);
    const struct flow end = {.part = number, .fraction = work->row->corrector, .cubed = true};
    memmove(work->flows + 1, work->flows, work->flow_count * sizeof *work->flows);
    work->flows[0] = work->flows[work->flow_count + 1] = end;
    work->flow_count += 2;
}

static void list_parts(struct work *work)
{
    const struct gm_parts_row *row = work->row;
    const struct gm_parts *parts = gm_ode_of(work->problem)->parts;
    const char *names[GM_MOST_PARTS];
    size_t count = 0, timed = 0;
    if (row->corrector != 0 && work->problem->n > GM_NEWTON_LARGEST) {
        gm_arena_refuse(work->arena, "for its corrector at most %d components", GM_NEWTON_LARGEST);
    }
    work->parts = gm_arena_take(work->arena, row->parts + 1, sizeof *work->parts);
    work->flows = gm_arena_take(work->arena, GM_SPLITTING_PIECES + 2, sizeof *work->flows);
    work->counted = work->carrier = row->parts;
    for (size_t i = 0; i < row->parts; i++) {
        size_t same = 0;
        open_part(work, &work->parts[i], &row->list[i]);
        while (same < count && strcmp(names[same], row->list[i].name) != 0) {
            same++;
        }
        names[same] = row->list[i].name;
        timed += same == count && work->parts[i].timed;
        count += same == count;
        work->counted = work->parts[i].how != STEPS ? i : work->counted;
        work->carrier = work->carrier == row->parts && !work->parts[i].timed ? i : work->carrier;
    }
    work->column = 0;
    const char *difference = parts ? parts->differ(work->arena, work->problem, names, count) : NULL;
    if (difference) {
        gm_arena_refuse(work->arena, "%s", difference);
    }
    if (timed > 1 || (timed > 0 && work->carrier == row->parts)) {
        gm_arena_refuse(work->arena, "the time in one part, and another part that moves it");
    }
    for (int i = 0; i < row->splitting.count; i++) {
        add_flow(work, (size_t)row->splitting.pieces[i].piece, row->splitting.pieces[i].fraction);
    }
    if (row->corrector != 0) {
        open_corrector(work, row->parts);
    }
}

static void open_work(struct gm_arena *arena, void *data)
{
    struct gm_workspace *opening = data;
    struct work *work = opening->opened = gm_arena_take(arena, 1, sizeof *work);
    const size_t n = opening->problem->n;
    size_t largest = n;
    *work = (struct work){.arena = arena,
                          .problem = opening->problem,
                          .scheme = opening->scheme,
                          .row = opening->scheme->coefficients,
                          .dt = NAN};
    gm_formula_open(&work->graph);
    gm_arena_keep(arena, &work->graph, gm_formula_close);
    (work->row->parts > 0 ? list_parts : list_pieces)(work);
    for (size_t i = 0; i < work->flow_count; i++) {
        const struct part *part = &work->parts[work->flows[i].part];
        const size_t most = part->how == EXPONENTIAL ? n * (n + 1) : part->how == ROTATION ? 2 * n : 0;
        work->flows[i].entries = gm_arena_take(arena, most, sizeof *work->flows[i].entries);
        largest = n + part->flow.slopes.count > largest ? n + part->flow.slopes.count : largest;
    }
    work->values = gm_arena_take(arena, largest + 6 * n, sizeof *work->values);
    work->scratch = work->values + largest;
    work->moved = work->scratch + 3 * n;
    work->kept = work->moved + n;
    work->member = work->kept + n;
    const bool dense = n <= GM_NEWTON_LARGEST;
    work->matrix = gm_arena_take(arena, dense ? 3 * (n + 1) * (n + 1) : 0, sizeof *work->matrix);
}

/* NULL: the sentence is the reason. */
static struct work *open_by(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            char sentence[GM_FAULT_SENTENCE])
{
    struct gm_arena *arena = gm_arena_open();
    struct gm_workspace opening = {problem, scheme, NULL};
    if (gm_arena_run(arena, open_work, &opening)) {
        return opening.opened;
    }
    snprintf(sentence, GM_FAULT_SENTENCE, "%s", gm_arena_reason(arena));
    gm_arena_close(arena);
    return NULL;
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    char sentence[GM_FAULT_SENTENCE];
    return open_by(problem, scheme, sentence);
}

static const char *lacks(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    static _Thread_local char sentence[GM_FAULT_SENTENCE];
    const struct gm_parts_row *row = scheme->coefficients;
    if (!scheme->word && row->corrector == 0) {
        return NULL; /* the facets solve the parts of the program's own rows */
    }
    struct work *work = open_by(problem, scheme, sentence);
    if (!work) {
        return sentence;
    }
    gm_workspace_close(work);
    return NULL;
}

/* ---- steps ---- */

static void put_entry(struct flow *flow, size_t row, size_t column, double value)
{
    if (value != 0) {
        flow->entries[flow->count++] = (struct entry){row, column, value};
    }
}

/* The flow over h of a linear part. */
static void make_matrix(struct work *work, struct flow *flow, double h)
{
    const struct gm_problem *problem = work->problem;
    const struct part *part = &work->parts[flow->part];
    const size_t n = problem->n, half = n / 2, size = n + 1;
    double *A = work->matrix, *E = A + size * size;
    flow->count = 0;
    if (part->how == ROTATION) {
        for (size_t i = 0; i < half; i++) {
            const double omega = gm_ode_of(problem)->fast_linear->frequency(problem, i), x = h * omega;
            put_entry(flow, i, i, gm_cos(x));
            put_entry(flow, i, half + i, fabs(x) < 1e-4 ? h * (1 - x * x / 6) : gm_sin(x) / omega);
            put_entry(flow, half + i, i, -omega * gm_sin(x));
            put_entry(flow, half + i, half + i, gm_cos(x));
        }
        return;
    }
    memset(A, 0, size * size * sizeof *A);
    memset(work->moved, 0, n * sizeof *work->moved);
    for (size_t j = size; j-- > 0;) { /* the constant, then the columns of L */
        work->moved[j < n ? j : 0] = j < n;
        gm_tape_values(&part->tape, work->moved, work->values, 1);
        for (size_t i = 0; i < n; i++) {
            A[i * size + j] = h * work->values[i] - (j < n ? A[i * size + n] : 0);
        }
        work->moved[j < n ? j : 0] = 0;
    }
    gm_exponential(size, A, E, E + size * size);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < size; j++) {
            put_entry(flow, i, j, E[i * size + j]);
        }
    }
}

/* Makes a step of the part's own scheme. */
static bool advance_steps(const struct gm_task *task, struct work *work, struct part *part, double h,
                          double *y, struct gm_progress *progress)
{
    gm_base_begin(&part->by, task);
    const enum gm_status status = gm_base_step(&part->by, h, y, work->moved, progress);
    memcpy(y, work->moved, work->problem->n * sizeof *y);
    return status == GM_OK;
}

/* The flow of one member; false: it is not found. */
static bool advance_member(const struct gm_task *task, struct work *work, size_t number, double h, double *y,
                           struct gm_progress *progress)
{
    const struct gm_problem *problem = work->problem;
    struct flow *flow = &work->flows[number];
    struct part *part = &work->parts[flow->part];
    const size_t n = problem->n, half = n / 2;
    const bool shear = part->how == SHEAR || part->how == KICK || part->how == JACOBI_KICK,
               first = number == 0 && problem->m == 1,
               last = number + 1 == work->flow_count && flow->part == work->flows[0].part && problem->m == 1;
    const bool known = shear && first && work->known && memcmp(work->kept, y, n * sizeof *y) == 0;
    switch (part->how) {
    case KEPLER:
        for (size_t i = half; i < n; i++) {
            y[i] *= part->inverse_mass;
        }
        if (!gm_kepler_flow(half, part->mu, h, y, y + half)) {
            return false;
        }
        for (size_t i = half; i < n; i++) {
            y[i] /= part->inverse_mass;
        }
        return true;
    case JACOBI_KEPLER:
        return gm_jacobi_kepler(gm_ode_of(problem)->gravity, h, y);
    case BRACKET:
        gm_ode_of(problem)->poisson->flow(problem, flow->part, h, y);
        return true;
    case STEPS:
        return advance_steps(task, work, part, h, y, progress);
    case ROTATION:
    case EXPONENTIAL:
        memset(work->moved, 0, n * sizeof *work->moved);
        for (size_t i = 0; i < flow->count; i++) {
            const struct entry *entry = &flow->entries[i];
            work->moved[entry->row] += entry->value * (entry->column < n ? y[entry->column] : 1);
        }
        memcpy(y, work->moved, n * sizeof *y);
        return true;
    case KICK:
    case JACOBI_KICK:
        if (!known && part->how == JACOBI_KICK) {
            gm_jacobi_interaction(gm_ode_of(problem)->gravity, y, work->values, work->scratch);
        } else if (!known) {
            part->force(problem, y, work->values, 1);
        }
        for (size_t i = 0; i < half; i++) {
            y[half + i] += h * work->values[i];
        }
        break;
    default:
        if (!known) {
            gm_tape_values(&part->tape, y, work->values, 1);
        }
        gm_linear_flow_advance(&part->flow, h, work->values, work->scratch, y);
    }
    work->known = shear && last;
    if (work->known) {
        memcpy(work->kept, y, n * sizeof *y);
    }
    return true;
}

/* Converts all members to or from Jacobi coordinates, unless they are in these. */
static void convert(struct work *work, bool jacobi, double *y)
{
    const struct gm_problem *problem = work->problem;
    const size_t n = problem->n, m = problem->m;
    for (size_t l = 0; l < m && work->jacobi != jacobi; l++) {
        gm_member_take(y, work->member, n, m, l);
        (jacobi ? gm_jacobi_from_state : gm_jacobi_to_state)(gm_ode_of(problem)->gravity, work->member,
                                                             work->scratch);
        gm_member_put(work->member, y, n, m, l);
    }
    work->jacobi = jacobi;
}

/* The flow of all members over h. */
static bool advance_flow(const struct gm_task *task, struct work *work, size_t number, double h, double *y,
                         struct gm_progress *progress)
{
    const struct gm_problem *problem = work->problem;
    const struct flow *flow = &work->flows[number];
    const size_t n = problem->n, m = problem->m;
    bool good = true;
    convert(work, is_jacobi(&work->parts[flow->part]), y);
    if (work->parts[flow->part].how == VOLUME) {
        gm_ode_of(problem)->volume->flow(problem, flow->part, h, y, m);
    } else if (m == 1) {
        good = advance_member(task, work, number, h, y, progress);
    }
    for (size_t l = 0; l < m && m > 1 && good && work->parts[flow->part].how != VOLUME; l++) {
        gm_member_take(y, work->member, n, m, l);
        good = advance_member(task, work, number, h, work->member, progress);
        gm_member_put(work->member, y, n, m, l);
    }
    const bool timed = gm_ode_of(problem)->parts && gm_ode_of(problem)->parts->timed && work->row->parts > 0;
    for (size_t l = 0; l < m && timed && flow->part == work->carrier; l++) {
        y[(n - 1) * m + l] += h;
    }
    return good;
}

/* Returns the time of a flow. In Jacobi coordinates the last flow of a step and the first of the next are one if they are
   of one part, except at the ends of a task. */
static double time_of(const struct gm_task *task, const struct work *work, size_t number, int64_t step)
{
    const struct flow *first = work->flows, *last = first + work->flow_count - 1, *flow = first + number;
    const bool joined = last > first && first->part == last->part && is_jacobi(&work->parts[first->part]);
    if (flow->cubed) {
        return flow->fraction * task->dt * task->dt * task->dt;
    }
    if (joined && flow == last && step + 1 < task->steps) {
        return 0;
    }
    return (flow->fraction +
            (joined && flow == first && (step > 0 || work->continued) ? last->fraction : 0)) *
           task->dt;
}

/* One evaluation is a flow of the last part that has one. The evaluations of the schemes of parts count, too. */
static enum gm_status make_step(const struct gm_task *task, struct gm_progress *progress)
{
    struct work *work = task->workspace;
    const size_t m = task->problem->m, n = task->problem->n;
    for (size_t i = 0; i < work->flow_count; i++) {
        const double h = time_of(task, work, i, progress->done);
        const bool joined = work->flows[0].part == work->flows[i].part;
        if (work->carries && joined && i > 0 && i + 1 == work->flow_count &&
            progress->done + 1 == task->steps) {
            memcpy(task->memory_out + ENDED + n * m, task->out, n * m * sizeof *task->out);
        }
        if (h != 0 && !advance_flow(task, work, i, h, task->out, progress)) {
            progress->unsolved.obstacle = GM_NOT_FINITE;
            return GM_NO_CONVERGENCE;
        }
        progress->evaluations += h != 0 && work->flows[i].part == work->counted ? m : 0;
    }
    return gm_is_within(task->out, task->problem->n * m, task->limit) ? GM_OK : GM_BLOW_UP;
}

static struct gm_progress loop(const struct gm_task *task)
{
    struct work *work = task->workspace;
    struct gm_progress progress = {.status = GM_OK};
    const size_t all = task->problem->n * task->problem->m, size = all * sizeof(double);
    work->carries = task->memory && memory(task->problem, task->scheme) > 0;
    work->continued = work->carries && task->memory[CARRIED_DT] == task->dt &&
                      memcmp(task->memory + ENDED, task->y, size) == 0;
    work->jacobi = work->continued;
    memcpy(task->out, work->continued ? task->memory + ENDED + all : task->y, size);
    for (size_t i = 0; i < work->flow_count && work->dt != task->dt; i++) {
        const enum how how = work->parts[work->flows[i].part].how;
        if (how == ROTATION || how == EXPONENTIAL) {
            make_matrix(work, &work->flows[i], work->flows[i].fraction * task->dt);
            work->known = false;
        }
    }
    work->dt = task->dt;
    while (progress.done < task->steps && (progress.status = make_step(task, &progress)) == GM_OK) {
        progress.done++;
    }
    if (work->carries && work->flows[0].part != work->flows[work->flow_count - 1].part) {
        memcpy(task->memory_out + ENDED + all, task->out, size);
    }
    convert(work, false, task->out);
    if (work->carries) {
        memcpy(task->memory_out + ENDED, task->out, size);
        task->memory_out[CARRIED_DT] = progress.done == task->steps ? task->dt : 0;
    }
    return progress;
}

/* ---- rows ---- */

/* Opens the only part. */
static void open_one(struct gm_arena *arena, void *data)
{
    struct work *work = data;
    gm_formula_open(&work->graph);
    gm_arena_keep(arena, &work->graph, gm_formula_close);
    open_part(work, work->parts, &work->row->list[0]);
}

/* Returns how the flow of a part is computed; HOWS: it is not known. */
static enum how how_of(const struct gm_problem *problem, const struct gm_named_part *named)
{
    const struct gm_parts_row row = {.list = {*named}};
    struct part part = {.how = KICK};
    struct work work = {.arena = gm_arena_open(), .problem = problem, .row = &row, .parts = &part};
    const bool known = gm_arena_run(work.arena, open_one, &work);
    gm_arena_close(work.arena);
    return known ? part.how : HOWS;
}

const char *gm_part_flow(const struct gm_problem *problem, const char *name)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    const bool kinetic = strcmp(name, "kinetic") == 0;
    if (ode->split && (kinetic || strcmp(name, "potential") == 0) && !gm_part_is_given(problem, name)) {
        return kinetic ? "a drift" : words[KICK];
    }
    const enum how how = how_of(problem, &(struct gm_named_part){.name = name});
    return how < HOWS ? words[how] : NULL;
}

size_t gm_parts_column(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    const struct gm_scheme *named = scheme->by_names ? scheme->by_names : scheme;
    const struct gm_substeps *substeps = gm_scheme_is_composition(named) ? named->coefficients : NULL;
    const struct gm_parts_row *row = named->family == &gm_family_parts ? named->coefficients : NULL;
    if (problem->kind != &gm_kind_ode) { /* it has no parts at all */
        return 0;
    }
    size_t column = named->base ? gm_parts_column(named->base, problem) : 0;
    for (int i = 0; substeps && i < substeps->count && column == 0; i++) {
        column = gm_parts_column(substeps->at[i].scheme, problem);
    }
    for (size_t i = 0; row && i < row->parts && column == 0; i++) {
        column = how_of(problem, &row->list[i]) == HOWS ? row->list[i].column : 0;
    }
    return column == 0 && gm_holding_of(named) ? gm_held_column(named, problem) : column;
}

#include "core/corrected_schemes.def"

static const struct gm_parts_row interaction_kepler = {.splitting = {3, {{0, 0.5}, {1, 1}, {0, 0.5}}},
                                                       .parts = 2,
                                                       .list = {{.name = "interaction"}, {.name = "kepler"}}},
                                 rest_linear = {.splitting = {3, {{0, 0.5}, {1, 1}, {0, 0.5}}},
                                                .parts = 2,
                                                .list = {{.name = "rest"}, {.name = "linear"}}},
                                 once = {.parts = 0}, twice = {.of_pieces = &gm_composition_none},
                                 suzuki4 = {.of_pieces = &gm_composition_suzuki4},
                                 kahan_li6 = {.of_pieces = &gm_composition_kahan_li6};

static const struct gm_scheme schemes[] = {GM_SCHEMES_parts GM_SCHEMES_corrected};

const struct gm_family gm_family_parts = {
    .title = "splitting by parts",
    GM_ROWS_LISTED,
    .loop = loop,
    .memory = memory,
    .joins = true,
    .workspace_open = workspace_open,
    .workspace_close = gm_workspace_close,
    .lacks = lacks,
};
