/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Identities, by random points in a prime field and, if these are inconclusive, in doubles. J. T. Schwartz,
   J. ACM 27 (1980) 701; W. A. Martin, J. Symb. Comp. 18 (1994) 1, for functions other than rational ones; N. J. Higham,
   Accuracy and Stability of Numerical Algorithms (2002), 3.3, for the rounding error of an evaluation. */
#include "core/expression/identity.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum {
    PROOFS = 3,
    PROOFS_BY_SIGN = 30,
    TESTS = 20,
    TRIES = 1000,
    LEAST_TRIES = PROOFS_BY_SIGN,
    WORK = 1 << 22 /* values of nodes: a long formula is tested at fewer points */
};

static bool is_square(gm_residue a)
{
    return gm_residue_power(a, (GM_PRIME - 1) / 2) <= 1;
}

/* A pseudorandom number for f(a, b), free of relations. */
static gm_residue unrelated(uint64_t seed, unsigned operation, gm_residue a, gm_residue b)
{
    return gm_mixed(gm_mixed(gm_mixed(seed ^ operation) ^ a) ^ b) % GM_PRIME;
}

/* f(-x) follows from f(x): the sign of a, and a number of |a| as the parameter of the operation. */
static bool is_turned(gm_residue a)
{
    return a > GM_PRIME / 2;
}

static gm_residue parameter(uint64_t seed, unsigned operation, gm_residue a)
{
    return unrelated(seed, operation, is_turned(a) ? gm_residue_minus(a) : a, 0);
}

static gm_residue exponential(uint64_t seed, gm_residue a)
{
    const gm_residue t = parameter(seed, GM_OPERATION_EXP, a);
    return a == 0 ? 1 : is_turned(a) ? gm_residue_inverse(t) : t;
}

/* A point of the circle: cos, or sin, times scale = 1 + t^2. */
static gm_residue on_circle(uint64_t seed, gm_residue a, bool is_sine, gm_residue *scale)
{
    const gm_residue t = parameter(seed, GM_OPERATION_SIN, a), square = gm_residue_times(t, t);
    *scale = a == 0 ? 1 : gm_residue_plus(1, square);
    if (is_sine) {
        return a == 0 ? 0 : gm_residue_times(2, is_turned(a) ? gm_residue_minus(t) : t);
    }
    return a == 0 ? 1 : gm_residue_plus(1, gm_residue_minus(square));
}

/* sinh or cosh, from the exponential */
static gm_residue hyperbolic(gm_residue up, bool is_sine)
{
    const gm_residue down = gm_residue_inverse(up);
    return gm_residue_times(gm_residue_inverse(2),
                            gm_residue_plus(up, is_sine ? gm_residue_minus(down) : down));
}

static bool is_below(uint64_t seed, gm_residue a, gm_residue b)
{
    return a != b && (a < b) == (unrelated(seed, GM_OPERATION_BELOW, a < b ? a : b, a < b ? b : a) & 1);
}

/* a^exponent, for halves of whole numbers, with the root of a; other exponents have no relations. */
static gm_residue power_of(uint64_t seed, gm_residue a, gm_residue b, double exponent, bool *exists)
{
    enum { LARGEST = 1 << 20 };
    const double halves = fabs(2 * exponent);
    if (!(halves <= LARGEST && halves == floor(halves))) {
        return unrelated(seed, GM_OPERATION_POWER, a, b);
    }
    const bool is_root = fmod(halves, 2) != 0;
    const gm_residue base = is_root ? gm_residue_power(a, (GM_PRIME + 1) / 4) : a;
    *exists &= (exponent >= 0 || a != 0) && (!is_root || gm_residue_times(base, base) == a);
    return gm_residue_power(exponent < 0 ? gm_residue_inverse(base) : base,
                            (uint64_t)(is_root ? halves : halves / 2));
}

/* The value of a node; *exists becomes false if it has none at this point. */
static gm_residue value_of(const struct gm_node *node, gm_residue a, gm_residue b, double exponent,
                           uint64_t seed, bool *exists)
{
    gm_residue scale;
    if (gm_is_rational(node->operation)) {
        return gm_rational_residue(node->operation, a, b, exponent, exists);
    }
    switch (node->operation) {
    case GM_OPERATION_POWER:
        return power_of(seed, a, b, exponent, exists);
    case GM_OPERATION_SQRT:
        return power_of(seed, a, b, 0.5, exists);
    case GM_OPERATION_EXP:
        return exponential(seed, a);
    case GM_OPERATION_SINH:
    case GM_OPERATION_COSH:
        return hyperbolic(exponential(seed, a), node->operation == GM_OPERATION_SINH);
    case GM_OPERATION_TANH:
        return gm_residue_times(hyperbolic(exponential(seed, a), true),
                                gm_residue_inverse(hyperbolic(exponential(seed, a), false)));
    case GM_OPERATION_SIN:
    case GM_OPERATION_COS: {
        const gm_residue point = on_circle(seed, a, node->operation == GM_OPERATION_SIN, &scale);
        return gm_residue_times(point, gm_residue_inverse(scale));
    }
    case GM_OPERATION_TAN:
        return gm_residue_times(on_circle(seed, a, true, &scale),
                                gm_residue_inverse(on_circle(seed, a, false, &scale)));
    case GM_OPERATION_ABS:
        return is_square(a) ? a : gm_residue_minus(a);
    case GM_OPERATION_MIN:
        return is_below(seed, a, b) ? a : b;
    case GM_OPERATION_MAX:
        return is_below(seed, b, a) ? a : b;
    case GM_OPERATION_BELOW:
        return is_below(seed, a, b);
    default:
        return unrelated(seed, node->operation, a, b);
    }
}

static bool is_fixed(const struct gm_random_values *random, const struct gm_node *variable)
{
    return variable->a < random->variables && !isnan(random->fixed[variable->a]);
}

/* Sets the values at the next point. False: they do not exist there. */
static bool take_point(struct gm_random_values *random)
{
    const uint64_t seed = gm_mixed(random->number++);
    gm_residue *values = random->values;
    bool exists = true;
    for (size_t k = 0; k < random->count && exists; k++) {
        const gm_node_id i = random->parts[k];
        const struct gm_node *node = &random->graph->nodes[i];
        if (node->operation == GM_CONSTANT) {
            exists = isfinite(node->value);
            gm_formula_residue(random->graph, i, &values[i]);
        } else if (node->operation == GM_VARIABLE) {
            values[i] = unrelated(seed, GM_VARIABLE, node->a, 0);
            if (is_fixed(random, node)) {
                exists = isfinite(random->fixed[node->a]);
                gm_residue_of(random->fixed[node->a], &values[i]);
            }
        } else {
            const gm_node_id b = gm_second_operand(node);
            const struct gm_node *of_b = &random->graph->nodes[b];
            values[i] = value_of(node, values[node->a], values[b],
                                 of_b->operation == GM_CONSTANT ? of_b->value : NAN, seed, &exists);
        }
    }
    return exists;
}

const gm_residue *gm_random_values_next(struct gm_random_values *values)
{
    for (int tries = 0; tries < TRIES; tries++) {
        if (take_point(values)) {
            return values->values;
        }
    }
    return NULL;
}

/* True if a part is defined in pieces: random points may miss one. */
static bool has_pieces(const struct gm_formula *graph, const gm_node_id *parts, size_t count)
{
    bool found = false;
    for (size_t k = 0; k < count; k++) {
        const enum gm_operation operation = graph->nodes[parts[k]].operation;
        found |= operation > GM_VARIABLE && !gm_operation_rows[operation].smooth;
    }
    return found;
}

/* True if a part has one of two values, as a sign or a root, so that a further point is half a proof at
   most. */
static bool has_signs(const struct gm_formula *graph, const gm_node_id *parts, size_t count)
{
    bool found = has_pieces(graph, parts, count);
    for (size_t k = 0; k < count; k++) {
        const enum gm_operation operation = graph->nodes[parts[k]].operation;
        found |= operation == GM_OPERATION_SQRT || operation == GM_OPERATION_POWER;
    }
    return found;
}

/* The number of points that refute a formula if it is 0 at none of them; 0: the field cannot. A rational formula of known
   numbers has the same values there. A root may have the wrong sign, at half of the points. */
static int points_to_refute(const struct gm_random_values *random)
{
    bool known = true;
    int roots = 0;
    gm_residue residue;
    for (size_t k = 0; k < random->count && known; k++) {
        const struct gm_node *node = &random->graph->nodes[random->parts[k]];
        known = node->operation == GM_CONSTANT ? gm_formula_residue(random->graph, random->parts[k], &residue)
                : node->operation == GM_VARIABLE
                    ? !is_fixed(random, node) || gm_residue_of(random->fixed[node->a], &residue)
                    : gm_is_rational(node->operation) || node->operation == GM_OPERATION_SQRT;
        roots += node->operation == GM_OPERATION_SQRT;
    }
    return !known || roots > 1 ? 0 : roots ? PROOFS_BY_SIGN : 1;
}

/* The number of points, up to `enough`, where the value is 0; minus that, up to `most`, where it never is; 0: both. */
static int zeros(struct gm_random_values *random, gm_node_id node, int enough, int most, uint64_t tries)
{
    int found = 0, others = 0;
    for (uint64_t i = 0; i < tries && found < enough && others < most && !(found && others); i++) {
        if (take_point(random)) {
            *(random->values[node] == 0 ? &found : &others) += 1;
        }
    }
    return found && others ? 0 : found - others;
}

/* A value, and the sum of the magnitudes of its terms and of theirs: its rounding error in units of the last place. */
struct sized {
    double value, size;
};

static struct sized size_of(enum gm_operation operation, struct sized a, struct sized b)
{
    const double slight = 1e-6, value = gm_operation_value(operation, a.value, b.value);
    double size = fabs(value);
    size += fabs(gm_operation_value(operation, a.value + slight * a.size, b.value) - value) / slight;
    if (gm_operation_rows[operation].arity == 2 && operation != GM_OPERATION_WHOLE_POWER) {
        size += fabs(gm_operation_value(operation, a.value, b.value + slight * b.size) - value) / slight;
    }
    return (struct sized){value, size};
}

static struct sized size_there(const struct gm_random_values *random, uint64_t seed, struct sized *values)
{
    const struct gm_formula *graph = random->graph;
    for (size_t k = 0; k < random->count; k++) {
        const gm_node_id i = random->parts[k];
        const struct gm_node *node = &graph->nodes[i];
        gm_residue residue;
        const bool cancels = node->operation == GM_CONSTANT && node->a && /* 0.1 + 0.2 - 0.3 */
                             gm_formula_residue(graph, i, &residue) && residue == 0;
        double value = cancels ? 0 : node->value;
        if (node->operation == GM_VARIABLE) {
            const uint64_t drawn = gm_mixed(seed ^ gm_mixed(node->a));
            value = ((double)(drawn >> 12) * 0x1p-52 * 1.8 + .2) * (drawn & 1 && seed % 2 ? -1 : 1);
            value *= seed % 4 == 3 ? 10 : 1; /* beyond a bound that a formula may have */
            value = is_fixed(random, node) ? random->fixed[node->a] : value;
        }
        values[i] = node->operation > GM_VARIABLE ? size_of(node->operation, values[node->a], values[node->b])
                                                  : (struct sized){value, fabs(value)};
    }
    return values[random->parts[random->count - 1]];
}

enum gm_identity gm_identity_of(const struct gm_formula *graph, gm_node_id node, const double *fixed,
                                size_t variables)
{
    if (graph->failed) {
        return GM_UNTESTED;
    }
    if (graph->nodes[node].operation == GM_CONSTANT) {
        gm_residue residue = 0;
        const bool zero =
            isfinite(graph->nodes[node].value) && (gm_formula_residue(graph, node, &residue), residue == 0);
        return zero ? GM_ZERO_PROVED : GM_NOT_ZERO;
    }
    /* the field has 2^61 = 1: what is 0 in it has to be small in doubles */
    const double rounding = 8 * DBL_EPSILON, small = 1e-6;
    union {
        gm_residue exact;
        struct sized sized;
    } *memory = malloc((node + (size_t)1) * sizeof *memory);
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    enum gm_identity found = GM_UNTESTED;
    if (memory && parts) {
        const int enough = has_signs(graph, parts, count) ? PROOFS_BY_SIGN : PROOFS;
        const uint64_t most = WORK / count, tries = most > TRIES         ? TRIES
                                                    : most > LEAST_TRIES ? most
                                                                         : LEAST_TRIES;
        struct gm_random_values random = {
            .graph = graph, .parts = parts, .count = count, .values = &memory->exact};
        const bool proved = zeros(&random, node, enough, 1, tries) == enough;
        random.fixed = fixed;
        random.variables = variables;
        const int refuting = points_to_refute(&random),
                  here = proved ? enough : zeros(&random, node, enough, refuting + !refuting, tries);
        const double bound = here == enough ? small : rounding;
        int tests = here < 0 && -here == refuting ? -1 : 0;
        for (uint64_t i = 0; i < tries && tests >= 0 && tests < (proved ? 1 : TESTS); i++) {
            const struct sized there = size_there(&random, i, &memory->sized);
            if (isfinite(there.value) && isfinite(there.size)) {
                tests = fabs(there.value) <= bound * there.size ? tests + 1 : -1;
            }
        }
        const bool meets_all = here == enough || !has_pieces(graph, parts, count);
        found = tests < 0                ? GM_NOT_ZERO
                : proved                 ? GM_ZERO_PROVED
                : tests > 0 && meets_all ? GM_ZERO_TESTED
                                         : GM_UNTESTED;
    }
    free(memory);
    free(parts);
    return found;
}
