/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An invariant is a combination of products of given degree, the candidates m_i, along which the motion does nothing:

       sum_i c_i (f . grad) m_i = 0   at every point.

   At as many random points as there are candidates, and thirty more, these are linear equations for c. They are solved
   modulo a prime, so that there is no rounding: the rank is exact. A part of a formula that is not a polynomial, such as
   1/r, is one more variable, whose rate is derived. A. Goriely, Integrability and Nonintegrability of Dynamical Systems
   (2001), 2.5; J. T. Schwartz, J. ACM 27 (1980) 701, for the random points. Symmetries are found so, too. */
#include "core/model/invariants.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/breaks.h"
#include "core/model/equations.h"

/* ---- elimination in the field ---- */

/* Values of some nodes of the system's graph, for its values of parameters, from random point `first` on. */
static struct gm_random_values random_values_of(const struct gm_user_system *system, struct gm_arena *arena,
                                                const gm_node_id *nodes, size_t count, uint64_t first)
{
    struct gm_random_values values = {.graph = &system->graph,
                                      .fixed = gm_arena_keep(arena, gm_equations_fixed(system), free),
                                      .variables = system->variable_count,
                                      .number = first};
    gm_arena_need(arena, !system->graph.failed);
    values.parts =
        gm_arena_keep(arena, gm_formula_parts_of(&system->graph, nodes, count, &values.count), free);
    values.values = gm_arena_take(arena, system->graph.count, sizeof *values.values);
    return values;
}

/* Rows in echelon form: rows[c] begins with a 1 in column c; NULL: no row begins there. */
struct echelon {
    struct gm_arena *arena;
    size_t columns;
    gm_residue **rows;
    gm_residue *rest; /* [columns], of the last row that was reduced */
};

static struct echelon echelon_open(struct gm_arena *arena, size_t columns)
{
    return (struct echelon){arena, columns, gm_arena_take(arena, columns + 1, sizeof(gm_residue *)),
                            gm_arena_take(arena, columns + 1, sizeof(gm_residue))};
}

enum { TOGETHER = 8 }; /* products that are added with one reduction modulo the prime */

struct multiples {
    gm_residue factors[TOGETHER]; /* 0: none */
    const gm_residue *rows[TOGETHER];
};

static inline gm_residue with_multiples(const struct multiples *multiples, gm_residue entry, size_t column)
{
    gm_wide sum = entry;
    for (size_t k = 0; k < TOGETHER; k++) {
        sum += (gm_wide)multiples->factors[k] * multiples->rows[k][column];
    }
    return gm_residue_folded(sum);
}

/* Subtracts multiples of the rows from a copy. Returns the column in which the rest begins; `columns`: the row is a
   combination of the others. */
static size_t echelon_reduce(const struct echelon *echelon, const gm_residue *given)
{
    struct multiples multiples;
    gm_residue *row = memcpy(echelon->rest, given, echelon->columns * sizeof *row);
    size_t c = 0;
    for (bool stopped = false; !stopped;) { /* rows wait for others */
        size_t count = 0;
        for (size_t k = 0; k < TOGETHER; k++) {
            multiples.factors[k] = 0;
            multiples.rows[k] = row;
        }
        for (; count < TOGETHER && !stopped; c += !stopped) {
            stopped = c == echelon->columns;
            if (!stopped) {
                row[c] = count ? with_multiples(&multiples, row[c], c) : row[c];
                stopped = row[c] && !echelon->rows[c];
            }
            if (!stopped && row[c]) {
                multiples.factors[count] = gm_residue_minus(row[c]);
                multiples.rows[count++] = echelon->rows[c];
                row[c] = 0;
            }
        }
        for (size_t i = c + stopped; i < echelon->columns && count; i++) {
            row[i] = with_multiples(&multiples, row[i], i);
        }
    }
    return c;
}

/* Reduces a row, and adds the rest. Returns false if nothing is left. */
static bool echelon_add(struct echelon *echelon, const gm_residue *row)
{
    const size_t c = echelon_reduce(echelon, row);
    if (c == echelon->columns) {
        return false;
    }
    gm_residue *rest = gm_arena_take(echelon->arena, echelon->columns, sizeof *rest);
    const gm_residue factor = gm_residue_inverse(echelon->rest[c]);
    for (size_t i = c; i < echelon->columns; i++) {
        rest[i] = gm_residue_times(factor, echelon->rest[i]);
    }
    echelon->rows[c] = rest;
    return true;
}

/* A vector that all rows send to 0; no other one of its basis has an entry at `last`. */
struct null_vector {
    gm_residue *entries; /* [columns]; entry `last` is 1, later ones are 0 */
    size_t last, terms;  /* terms: entries that are not 0 */
};
/* A basis of the null space, [*count], by rising `last`. */
static struct null_vector *echelon_null_space(const struct echelon *echelon, size_t *count)
{
    struct null_vector *basis = gm_arena_take(echelon->arena, echelon->columns + 1, sizeof *basis);
    *count = 0;
    for (size_t last = 0; last < echelon->columns; last++) {
        if (echelon->rows[last]) {
            continue;
        }
        gm_residue *entries = gm_arena_take(echelon->arena, echelon->columns, sizeof *entries);
        size_t terms = 1;
        entries[last] = 1;
        for (size_t c = last; c-- > 0;) {
            gm_residue sum = 0;
            for (size_t i = c + 1; i <= last && echelon->rows[c];) {
                gm_wide part = sum;
                for (const size_t end = i + TOGETHER; i < end && i <= last; i++) {
                    part += (gm_wide)echelon->rows[c][i] * entries[i];
                }
                sum = gm_residue_folded(part);
            }
            entries[c] = gm_residue_minus(sum);
            terms += sum != 0;
        }
        basis[(*count)++] = (struct null_vector){entries, last, terms};
    }
    return basis;
}

/* ---- invariants ---- */

enum { SPARE_POINTS = 30 };
static const uint64_t FRESH = UINT64_C(1) << 40; /* the first point of a proof */

/* A product of variables: the product `parent` times one more variable. Product 0 is 1. */
struct candidate {
    size_t parent, factor, degree;
};

/* An invariant that the system has a name for. */
struct named {
    const struct gm_system_item *item; /* NULL: H */
    gm_node_id node;
    gm_residue *values; /* [points] */
    bool reached;       /* a polynomial in the generators */
};

struct generator {
    size_t degree;
    const gm_residue *values;           /* [samples] */
    const struct named *named;          /* or */
    const struct null_vector *combined; /* of kept candidates */
};

struct search {
    struct gm_user_system *system;
    struct gm_arena *arena;
    size_t degree, n;
    gm_node_id *variables, *slopes; /* components and parts, and their rates */
    size_t variable_count;
    struct candidate *candidates;
    size_t count, points;
    gm_residue **values, **slope_values; /* [points][count] */
    struct null_vector *basis;           /* of all invariants, by rising degree; of candidates but for 1 */
    size_t basis_count, samples;         /* points at which invariants differ */
    struct named *named;
    size_t named_count;
    struct generator *generators;
    size_t generator_count;
};

static void add_variable(struct search *search, gm_node_id node)
{
    for (size_t v = 0; v < search->variable_count; v++) {
        if (search->variables[v] == node) {
            return;
        }
    }
    search->variables[search->variable_count++] = node;
}

/* Adds a function; sin goes with cos, sinh with cosh. */
static void add_function(struct search *search, gm_node_id node)
{
    static const enum gm_operation pairs[][2] = {{GM_OPERATION_SIN, GM_OPERATION_COS},
                                                 {GM_OPERATION_SINH, GM_OPERATION_COSH}};
    struct gm_formula *graph = &search->system->graph;
    const struct gm_node function = graph->nodes[node];
    add_variable(search, node);
    for (size_t i = 0; i < 4; i++) {
        if (pairs[i / 2][i % 2] == function.operation) {
            add_variable(search, gm_simplified(graph, pairs[i / 2][1 - i % 2], function.a, function.a));
        }
    }
}

/* sqrt(x) of x^(k/2), which is a power of it; else the node. */
static gm_node_id base_of(struct gm_formula *graph, gm_node_id node)
{
    const struct gm_node power = graph->nodes[node], *exponent = &graph->nodes[power.b];
    const bool halves = exponent->operation == GM_CONSTANT && fmod(exponent->value, 1) != 0 &&
                        fmod(2 * exponent->value, 1) == 0;
    return halves ? gm_simplified(graph, GM_OPERATION_SQRT, power.a, power.a) : node;
}

/* The components, then the parts of H, or else of the rates, that are not polynomials: functions, and 1/b of a
   quotient a/b. */
static void find_variables(struct search *search)
{
    enum { FACTOR = 1, DIVISOR = 2 };
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const bool rates = system->kind == GM_RATES;
    const gm_node_id *roots = rates ? system->rates : &system->energy;
    size_t count = 0, root_count = rates ? system->n : 1;
    gm_node_id *parts =
        gm_arena_keep(search->arena, gm_formula_parts_of(graph, roots, root_count, &count), free);
    unsigned *use = gm_arena_take(search->arena, graph->count, sizeof *use);
    bool *components = gm_arena_take(search->arena, search->n, sizeof *components);
    memset(components, true, search->n * sizeof *components);
    const bool *moving =
        gm_arena_keep(search->arena, gm_formula_dependent(graph, components, search->n), free);
    search->variables = gm_arena_take(search->arena, search->n + 3 * count, sizeof *search->variables);
    for (size_t i = 0; i < search->n; i++) {
        add_variable(search, gm_formula_variable(graph, i));
    }
    for (size_t i = 0; i < root_count; i++) {
        use[roots[i]] = FACTOR;
    }
    for (size_t k = count; k-- > 0 && !graph->failed;) {
        const struct gm_node node = graph->nodes[parts[k]];
        const unsigned here = use[parts[k]], turned = here / 2 + here % 2 * 2;
        gm_node_id part = parts[k];
        bool whole = true, turns = false; /* a quotient has 1/node as a variable, not 1/factor */
        switch (here && moving[parts[k]] ? node.operation : GM_CONSTANT) {
        case GM_CONSTANT:
            whole = false;
            break;
        case GM_VARIABLE:
            break;
        case GM_OPERATION_ADD:
        case GM_OPERATION_SUBTRACT:
            use[node.a] |= FACTOR;
            use[node.b] |= FACTOR;
            break;
        case GM_OPERATION_MULTIPLY:
        case GM_OPERATION_DIVIDE:
            use[node.a] |= here;
            use[node.b] |= node.operation == GM_OPERATION_DIVIDE ? turned : here;
            whole = false;
            break;
        case GM_OPERATION_NEGATE:
            use[node.a] |= here;
            whole = false;
            break;
        case GM_OPERATION_WHOLE_POWER:
            use[node.a] |= graph->nodes[node.b].value < 0 ? turned : here;
            whole = false;
            break;
        case GM_OPERATION_POWER:
            part = base_of(graph, parts[k]);
            turns = part != parts[k] && graph->nodes[node.b].value < 0;
            add_function(search, part);
            break;
        default:
            add_function(search, parts[k]);
        }
        if (whole && (turns ? turned : here) & DIVISOR) {
            add_variable(search,
                         gm_simplified(graph, GM_OPERATION_DIVIDE, gm_formula_constant(graph, 1), part));
        }
    }
}

/* The number of products of at most `degree` of the variables, but for 1. */
static size_t count_candidates(size_t variables, size_t degree)
{
    size_t count = 1;
    for (size_t d = 1; d <= degree && count <= 2 * GM_MOST_CANDIDATES; d++) {
        count = count * (variables + d) / d;
    }
    return count - 1;
}

/* All products, by rising degree. */
static void list_candidates(struct search *search)
{
    search->candidates =
        gm_arena_take(search->arena, count_candidates(search->variable_count, search->degree) + 1,
                      sizeof *search->candidates);
    search->candidates[search->count++] = (struct candidate){0};
    for (size_t degree = 1, first = 0; degree <= search->degree; degree++) {
        const size_t end = search->count;
        for (size_t parent = first; parent < end; parent++) {
            for (size_t v = search->candidates[parent].factor; v < search->variable_count; v++) {
                search->candidates[search->count++] = (struct candidate){parent, v, degree};
            }
        }
        first = end;
    }
}

/* Values at random points: of candidates, their slopes along the motion, and declared invariants. False: they do not
   exist. */
static bool take_values(struct search *search)
{
    struct gm_arena *arena = search->arena;
    const size_t variables = search->variable_count, node_count = 2 * variables + search->named_count;
    gm_node_id *nodes = gm_arena_take(arena, node_count, sizeof *nodes);
    memcpy(nodes, search->variables, variables * sizeof *nodes);
    memcpy(nodes + variables, search->slopes, variables * sizeof *nodes);
    search->points = search->count + SPARE_POINTS;
    for (size_t i = 0; i < search->named_count; i++) {
        nodes[2 * variables + i] = search->named[i].node;
        search->named[i].values = gm_arena_take(arena, search->points, sizeof(gm_residue));
    }
    struct gm_random_values random = random_values_of(search->system, search->arena, nodes, node_count, 0);
    search->values = gm_arena_take(arena, search->points, sizeof *search->values);
    search->slope_values = gm_arena_take(arena, search->points, sizeof *search->slope_values);
    for (size_t p = 0; p < search->points; p++) {
        const gm_residue *at = gm_random_values_next(&random);
        if (!at) {
            return false;
        }
        gm_residue *value = gm_arena_take(arena, search->count, sizeof *value),
                   *slope = gm_arena_take(arena, search->count, sizeof *slope);
        value[0] = 1;
        for (size_t i = 1; i < search->count; i++) {
            const struct candidate *of = &search->candidates[i];
            const gm_residue factor = at[search->variables[of->factor]];
            value[i] = gm_residue_times(value[of->parent], factor);
            slope[i] = gm_residue_fused(value[of->parent], at[search->slopes[of->factor]],
                                        gm_residue_times(slope[of->parent], factor));
        }
        for (size_t i = 0; i < search->named_count; i++) {
            search->named[i].values[p] = at[search->named[i].node];
        }
        search->values[p] = value;
        search->slope_values[p] = slope;
    }
    return true;
}

/* Solves the equations for the coefficients. */
static void solve(struct search *search)
{
    struct echelon equations = echelon_open(search->arena, search->count - 1);
    for (size_t p = 0; p < search->points; p++) {
        echelon_add(&equations, search->slope_values[p] + 1);
    }
    search->basis = echelon_null_space(&equations, &search->basis_count);
    search->samples = search->basis_count + 1 + SPARE_POINTS;
}

static size_t degree_of(const struct search *search, const struct null_vector *vector)
{
    return search->candidates[1 + vector->last].degree;
}

/* The values of an invariant at the samples. */
static gm_residue *values_of(const struct search *search, const struct null_vector *vector)
{
    gm_residue *values = gm_arena_take(search->arena, search->samples, sizeof *values);
    for (size_t p = 0; p < search->samples; p++) {
        for (size_t i = 0; i <= vector->last; i++) {
            if (vector->entries[i]) {
                values[p] = gm_residue_fused(vector->entries[i], search->values[p][1 + i], values[p]);
            }
        }
    }
    return values;
}

/* The values of 1 at the samples. */
static const gm_residue *ones_of(const struct search *search)
{
    gm_residue *ones = gm_arena_take(search->arena, search->samples, sizeof *ones);
    for (size_t p = 0; p < search->samples; p++) {
        ones[p] = 1;
    }
    return ones;
}

/* Takes out invariants that as functions are combinations of earlier ones. They come from candidates that are such
   combinations, r^2 = x^2 + y^2: an invariant whose last candidate is one is of earlier candidates, too. */
static void keep_independent(struct search *search)
{
    struct echelon functions = echelon_open(search->arena, search->samples);
    size_t kept = 0;
    echelon_add(&functions, ones_of(search));
    for (size_t i = 0; i < search->basis_count; i++) {
        if (echelon_add(&functions, values_of(search, &search->basis[i]))) {
            search->basis[kept++] = search->basis[i];
        }
    }
    search->basis_count = kept;
    search->samples = kept + 1 + SPARE_POINTS;
}

/* Adds all products of a degree of generators from number `first` on, times products[degree]. */
static void add_products(const struct search *search, struct echelon *functions, size_t first, size_t degree,
                         gm_residue **products)
{
    for (size_t g = first; g < search->generator_count; g++) {
        const struct generator *generator = &search->generators[g];
        if (generator->degree > degree) {
            continue;
        }
        const size_t rest = degree - generator->degree;
        for (size_t p = 0; p < search->samples; p++) {
            products[rest][p] = gm_residue_times(products[degree][p], generator->values[p]);
        }
        if (rest > 0) {
            add_products(search, functions, g, rest, products);
        } else {
            echelon_add(functions, products[0]);
        }
    }
}

static int by_terms(const void *a, const void *b)
{
    const struct null_vector *x = a, *y = b;
    return x->terms != y->terms ? (x->terms > y->terms) - (x->terms < y->terms)
                                : (x->last > y->last) - (x->last < y->last);
}

/* Generators degree by degree: first what the system has a name for, then what has the fewest terms, unless it is a
   polynomial in earlier ones. */
static void find_generators(struct search *search)
{
    struct gm_arena *arena = search->arena;
    struct echelon all = echelon_open(arena, search->samples), /* invariants up to a degree */
        reached = echelon_open(arena, search->samples);        /* polynomials in generators */
    gm_residue *products[GM_LARGEST_DEGREE + 1];
    const gm_residue *ones = ones_of(search);
    for (size_t d = 0; d <= search->degree; d++) {
        products[d] = gm_arena_take(arena, search->samples, sizeof *products[d]);
    }
    echelon_add(&all, ones);
    echelon_add(&reached, ones);
    search->generators = gm_arena_take(arena, search->basis_count + 1, sizeof *search->generators);
    for (size_t degree = 1, first = 0, end = 0; degree <= search->degree; degree++, first = end) {
        for (; end < search->basis_count && degree_of(search, &search->basis[end]) == degree; end++) {
            echelon_add(&all, values_of(search, &search->basis[end]));
        }
        memcpy(products[degree], ones, search->samples * sizeof *ones);
        add_products(search, &reached, 0, degree, products);
        for (size_t i = 0; i < search->named_count; i++) {
            struct named *named = &search->named[i];
            if (!named->reached && echelon_reduce(&all, named->values) == search->samples) {
                named->reached = true;
                if (echelon_add(&reached, named->values)) {
                    search->generators[search->generator_count++] =
                        (struct generator){.degree = degree, .values = named->values, .named = named};
                }
            }
        }
        qsort(search->basis + first, end - first, sizeof *search->basis, by_terms);
        for (size_t i = first; i < end; i++) {
            const gm_residue *values = values_of(search, &search->basis[i]);
            if (echelon_add(&reached, values)) {
                search->generators[search->generator_count++] =
                    (struct generator){.degree = degree, .values = values, .combined = &search->basis[i]};
            }
        }
    }
}

/* A combination of candidates as a formula; GM_NO_NODE if its coefficients are not short fractions. */
static gm_node_id formula_of(const struct search *search, const struct null_vector *vector)
{
    struct gm_formula *graph = &search->system->graph;
    const size_t count = search->count - 1;
    double *coefficients = gm_arena_take(search->arena, count + 1, sizeof *coefficients);
    gm_node_id sum = gm_formula_constant(graph, 0);
    if (!gm_residues_whole(vector->entries, count, coefficients)) {
        return GM_NO_NODE;
    }
    for (size_t i = 0; i < count; i++) {
        if (coefficients[i] == 0) {
            continue;
        }
        gm_node_id product = gm_formula_constant(graph, 1);
        size_t factors[GM_LARGEST_DEGREE], degree = 0; /* the last first */
        for (size_t c = 1 + i; c > 0; c = search->candidates[c].parent) {
            factors[degree++] = search->candidates[c].factor;
        }
        while (degree-- > 0) {
            product = gm_product(graph, product, search->variables[factors[degree]]);
        }
        product = gm_product(graph, gm_formula_constant(graph, coefficients[i]), product);
        sum = gm_sum(graph, sum, product);
    }
    return sum;
}

/* The rank of `count` gradients at a random point. */
static size_t rank_of(struct search *search, const gm_node_id *gradients, size_t count)
{
    const size_t n = search->n;
    struct gm_random_values random = random_values_of(search->system, search->arena, gradients, count * n, 0);
    struct echelon rows = echelon_open(search->arena, n);
    gm_residue *row = gm_arena_take(search->arena, n, sizeof *row);
    size_t rank = 0;
    const gm_residue *at = gm_random_values_next(&random);
    for (size_t g = 0; g < count && at; g++) {
        for (size_t i = 0; i < n; i++) {
            row[i] = at[gradients[g * n + i]];
        }
        rank += echelon_add(&rows, row);
    }
    return rank;
}

/* True if a node is 0 at fresh points of the field; and in doubles, where coefficients are what is printed. */
static bool is_zero(struct search *search, gm_node_id node)
{
    struct gm_random_values random = random_values_of(search->system, search->arena, &node, 1, FRESH);
    bool zero = true;
    for (int p = 0; p < SPARE_POINTS && zero; p++) {
        const gm_residue *at = gm_random_values_next(&random);
        zero = at && at[node] == 0;
    }
    const enum gm_identity found = zero ? gm_equations_vanishes(search->system, node) : GM_NOT_ZERO;
    return found == GM_ZERO_PROVED || found == GM_ZERO_TESTED;
}

/* Writes and proves the generators, then what has a name and was not reached. Those without a gradient are constants:
   exp(x - y) exp(y - x). */
static void write_all(struct search *search, struct gm_found_invariants *found)
{
    struct gm_user_system *system = search->system;
    struct gm_formula *graph = &system->graph;
    const size_t n = search->n, most = search->generator_count + search->named_count;
    gm_node_id *gradients = gm_arena_take(search->arena, most * n + 1, sizeof *gradients);
    found->list = gm_arena_take(search->arena, most + 1, sizeof *found->list);
    for (size_t g = 0; g < search->generator_count; g++) {
        const struct generator *generator = &search->generators[g];
        const struct named *named = generator->named;
        const gm_node_id node = named ? named->node : formula_of(search, generator->combined);
        gm_node_id *gradient = gradients + found->count * n;
        if (node == GM_NO_NODE || !is_zero(search, gm_derivative_along(graph, node, system->rates, n))) {
            found->unwritten++;
            continue;
        }
        gm_arena_need(search->arena, gm_gradient(graph, node, NULL, n, gradient));
        if (rank_of(search, gradient, 1) == 1) {
            found->list[found->count++] = (struct gm_found_invariant){
                named ? named->item : NULL, named && !named->item, node, generator->degree, true};
        }
    }
    found->independent = found->lacks ? 0 : rank_of(search, gradients, found->count);
    for (size_t i = 0; i < search->named_count; i++) {
        const struct named *named = &search->named[i];
        const enum gm_identity identity =
            named->reached
                ? GM_NOT_ZERO
                : gm_equations_vanishes(system, gm_derivative_along(graph, named->node, system->rates, n));
        if (identity != GM_ZERO_PROVED && identity != GM_ZERO_TESTED) {
            continue;
        }
        gm_arena_need(search->arena, gm_gradient(graph, named->node, NULL, n, gradients + found->count * n));
        const size_t rank = found->lacks ? 0 : rank_of(search, gradients, found->count + 1);
        if (found->lacks || rank > found->independent) {
            found->independent = rank;
            found->list[found->count++] = (struct gm_found_invariant){named->item, !named->item, named->node,
                                                                      0, identity == GM_ZERO_PROVED};
        }
    }
}

static bool passes(const struct search *search, const gm_node_id *node)
{
    struct gm_user_system *system = search->system;
    gm_node_id at = GM_NO_NODE;
    return gm_breaks_pass(search->arena, system, node, 1, system->rates, system->n, &at) == GM_ZERO_PROVED;
}

/* H, and the invariants that were declared, unless they jump along the motion. */
static void find_named(struct search *search)
{
    struct gm_user_system *system = search->system;
    search->named = gm_arena_take(search->arena, system->item_count + 1, sizeof *search->named);
    if (system->kind != GM_RATES && passes(search, &system->energy)) {
        search->named[search->named_count++].node = system->energy;
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        const gm_node_id node = gm_system_conserved(system, item);
        if (node != GM_NO_NODE && passes(search, &node)) {
            search->named[search->named_count++] = (struct named){.item = item, .node = node};
        }
    }
}

/* The reason against a search, or NULL. */
static const char *find_lack(const struct search *search)
{
    struct gm_user_system *system = search->system;
    bool *all = gm_arena_take(search->arena, system->n, sizeof *all), kinked = false;
    memset(all, true, system->n * sizeof *all);
    if (gm_system_is_field(system)) {
        return "it is a field";
    }
    if (system->kind == GM_LAGRANGIAN) {
        return "a Lagrangian has no formulas of its rates; its H has";
    }
    if (gm_system_item_of(system, GM_WORD_CONSTRAINT, 0)) {
        return "it has constraints";
    }
    for (size_t i = 0; i < system->n; i++) {
        kinked |= gm_formula_kink(&system->graph, system->rates[i], all, system->n) != GM_NO_NODE;
    }
    return system->timed ? "its rates depend on the time" : kinked ? "it is not smooth" : NULL;
}

void gm_invariants_find(struct gm_user_system *system, struct gm_arena *arena, size_t degree,
                        struct gm_found_invariants *found)
{
    struct search search = {.system = system, .arena = arena, .n = system->n, .degree = degree};
    *found = (struct gm_found_invariants){.lacks = find_lack(&search)};
    if (found->lacks) {
        return;
    }
    const size_t n = system->n;
    find_variables(&search);
    while (search.degree > 0 && count_candidates(search.variable_count, search.degree) > GM_MOST_CANDIDATES) {
        search.degree--;
    }
    if (search.degree == 0) {
        found->lacks = "it has more than 3000 components and parts";
        return;
    }
    search.slopes = gm_arena_take(arena, search.variable_count, sizeof *search.slopes);
    for (size_t v = 0; v < search.variable_count; v++) {
        search.slopes[v] = gm_derivative_along(&system->graph, search.variables[v], system->rates, n);
    }
    find_named(&search);
    list_candidates(&search);
    found->lacks = take_values(&search) ? NULL : "the search finds no values of its roots";
    if (!found->lacks) {
        solve(&search);
        keep_independent(&search);
        find_generators(&search);
        found->degree = search.degree;
        found->lowered = search.degree < degree;
        found->candidates = search.count - 1;
    }
    write_all(&search, found);
}

const char *gm_found_word(const struct gm_user_system *system)
{
    bool taken = false;
    for (size_t i = 0; i < system->variable_count; i++) {
        const char *name = system->variables[i].name;
        taken |= name && name[0] == 'I' && (name[1] == '[' || (name[1] >= '0' && name[1] <= '9'));
    }
    return taken ? "found" : "I";
}

/* ---- symmetries ---- */

/* The field a + A y is a symmetry of y' = f(y) if with some number c

       f'(y) (a + A y) - A f(y) = c f(y)   for all y.

   At random points these are linear equations for a, A and c. P. J. Olver, Applications of Lie Groups to Differential
   Equations (1993), 2.3. Here is the one of component k: the coefficients of a [n], A [n][n] and c. */
static void set_equation(gm_residue *row, size_t n, size_t k, const gm_residue *const point[3])
{
    const gm_residue *y = point[0], *f = point[1], *slope = point[2] + k * n; /* of f[k] */
    for (size_t i = 0; i < n; i++) {
        row[i] = slope[i];
        for (size_t j = 0; j < n; j++) {
            row[n + i * n + j] =
                gm_residue_plus(gm_residue_times(slope[i], y[j]), i == k ? gm_residue_minus(f[j]) : 0);
        }
    }
    row[n + n * n] = gm_residue_minus(f[k]);
}

/* a + A y */
static gm_node_id *write_field(struct gm_user_system *system, struct gm_arena *arena, const double *entries)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n;
    gm_node_id *field = gm_arena_take(arena, n, sizeof *field);
    for (size_t i = 0; i < n; i++) {
        field[i] = gm_formula_constant(graph, entries[i]);
        for (size_t j = 0; j < n; j++) {
            const gm_node_id factor = gm_formula_constant(graph, entries[n + i * n + j]);
            field[i] = gm_sum(graph, field[i], gm_product(graph, factor, gm_formula_variable(graph, j)));
        }
    }
    gm_arena_need(arena, !graph->failed);
    return field;
}

/* G = b' y + y' B y / 2 with J (b + B y) = a + A y, if B is symmetric and G constant in the motion; else GM_NO_NODE. */
static gm_node_id write_momentum_map(struct gm_user_system *system, struct gm_arena *arena,
                                     const double *entries)
{
    struct gm_formula *graph = &system->graph;
    const size_t n = system->n, half = n / 2;
    gm_node_id map = gm_formula_constant(graph, 0);
    double *matrix = gm_arena_take(arena, n * n, sizeof *matrix);
    for (size_t i = 0; i < n && system->kind == GM_CANONICAL; i++) {
        const size_t conjugate = (i + half) % n;
        const double sign = i < half ? -1 : 1;
        const gm_node_id y = gm_formula_variable(graph, i),
                         factor = gm_formula_constant(graph, sign * entries[conjugate]);
        map = gm_sum(graph, map, gm_product(graph, factor, y));
        for (size_t j = 0; j < n; j++) {
            matrix[i * n + j] = sign * entries[n + conjugate * n + j];
        }
        for (size_t j = 0; j <= i; j++) {
            if (matrix[i * n + j] != matrix[j * n + i]) {
                return GM_NO_NODE;
            }
            const gm_node_id part = gm_formula_constant(graph, matrix[i * n + j] / (i == j ? 2 : 1));
            map = gm_sum(graph, map,
                         gm_product(graph, part, gm_product(graph, gm_formula_variable(graph, j), y)));
        }
    }
    return system->kind == GM_CANONICAL &&
                   gm_equations_vanishes(system, gm_derivative_along(graph, map, system->rates, n)) ==
                       GM_ZERO_PROVED
               ? map
               : GM_NO_NODE;
}

static bool has_gradient_along(struct gm_user_system *system, struct gm_arena *arena, gm_node_id node,
                               const gm_node_id *slopes)
{
    struct gm_formula *graph = &system->graph;
    gm_node_id *own = gm_arena_take(arena, system->n, sizeof *own);
    gm_arena_need(arena, gm_gradient(graph, node, NULL, system->n, own));
    bool parallel = true;
    for (size_t i = 1; i < system->n && parallel; i++) {
        for (size_t j = 0; j < i && parallel; j++) {
            const gm_node_id crossed = gm_difference(graph, gm_product(graph, slopes[i], own[j]),
                                                     gm_product(graph, slopes[j], own[i]));
            parallel = gm_equations_vanishes(system, crossed) == GM_ZERO_PROVED;
        }
    }
    return parallel;
}

/* The number of the first invariant that a momentum map is a function of; their count: of none. */
static size_t paired_with(struct gm_user_system *system, struct gm_arena *arena, gm_node_id map,
                          const struct gm_found_invariants *invariants)
{
    if (map == GM_NO_NODE) {
        return invariants->count;
    }
    gm_node_id *slopes = gm_arena_take(arena, system->n, sizeof *slopes);
    gm_arena_need(arena, gm_gradient(&system->graph, map, NULL, system->n, slopes));
    size_t number = 0;
    while (number < invariants->count &&
           !has_gradient_along(system, arena, invariants->list[number].node, slopes)) {
        number++;
    }
    return number;
}

size_t gm_symmetries_find(struct gm_user_system *system, struct gm_arena *arena,
                          const struct gm_found_invariants *invariants, struct gm_symmetry **symmetries,
                          size_t *unwritten)
{
    *unwritten = 0;
    const size_t n = system->n, unknowns = n + n * n + 1, points = 6 * n + 20, nodes = 2 * n + n * n;
    if (n > GM_MOST_WITH_SYMMETRIES) {
        return 0;
    }
    gm_node_id *wanted = gm_arena_take(arena, nodes, sizeof *wanted); /* y, f, f' */
    for (size_t i = 0; i < n; i++) {
        wanted[i] = gm_formula_variable(&system->graph, i);
        wanted[n + i] = system->rates[i];
        gm_gradient(&system->graph, system->rates[i], NULL, n, wanted + 2 * n + i * n);
    }
    struct gm_random_values random = random_values_of(system, arena, wanted, nodes, 0);
    struct echelon equations = echelon_open(arena, unknowns);
    gm_residue *row = gm_arena_take(arena, unknowns + nodes, sizeof *row), *values = row + unknowns;
    const gm_residue *at = values;
    for (size_t p = 0; p < points && at; p++) {
        at = gm_random_values_next(&random);
        for (size_t i = 0; i < nodes && at; i++) {
            values[i] = at[wanted[i]];
        }
        for (size_t k = 0; k < n && at; k++) {
            set_equation(row, n, k, (const gm_residue *const[]){values, values + n, values + 2 * n});
            echelon_add(&equations, row);
        }
    }
    size_t count = 0, found = 0;
    const struct null_vector *basis = echelon_null_space(&equations, &count);
    double *whole = gm_arena_take(arena, unknowns, sizeof *whole);
    *symmetries = gm_arena_take(arena, count + 1, sizeof **symmetries);
    for (size_t i = 0; i < count && at; i++) {
        const bool rest = basis[i].terms == 1 && basis[i].last == unknowns - 1; /* c alone, as f = 0 */
        if (rest) {
            continue;
        }
        if (!gm_residues_whole(basis[i].entries, unknowns, whole)) {
            ++*unwritten;
        } else {
            const gm_node_id map = write_momentum_map(system, arena, whole);
            (*symmetries)[found++] =
                (struct gm_symmetry){write_field(system, arena, whole), whole[unknowns - 1], map,
                                     paired_with(system, arena, map, invariants)};
        }
    }
    return found;
}
