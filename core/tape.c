/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a graph to straight code, and the two ways to compute it: one state with a register a number, or a
   block of members with a register a row, where an operation is decoded once for the whole row. */
#include "core/tape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/rows.h"

enum {
    LARGEST_BATCH = 256, /* operations of a group: operands fit into the fastest cache */
    LEAST_BATCH = 16,
    LEAST_RUN = 12,     /* operands in a row: fewer are gathered with their neighbours */
    LEAST_SUM = 8,      /* terms: fewer are added one by one */
    LEAST_ROWS = 100,   /* operations: shorter code has no rows for one state */
    LEAST_ROLLED = 1024 /* values: shorter code stays in the order of the formula */
};

/* A computed value. The numbers of values are first those of the inputs, then of the constants, then of
   the computed ones. */
struct value {
    uint32_t operation, number, a, b;
    uint32_t level; /* one more than the highest level of its operands: values of one level are independent */
    uint32_t shape; /* equal for values computed alike, from any inputs and constants */
    uint32_t a_rank, b_rank;    /* ranks of its operands, in the order of the code */
    uint32_t first_term, terms; /* terms of a long sum, which has no a and b; else 0 */
};

/* A term of a long sum. */
struct term {
    uint32_t number; /* number of its value */
    bool subtracted;
};

/* Registers of a group, which are taken and given back together. */
struct stretch {
    uint32_t first, alive; /* alive: number of values still needed */
    bool wide;
};

/* Values [begin, end) that are computed one after the other: all by the same operation, or one. */
struct group {
    size_t begin, end;
};

/* The state of a tape's compilation, inside a body of the tape's arena. */
struct writing {
    struct gm_arena *arena;
    struct gm_tape *tape;
    const struct gm_formula *graph;
    const gm_node_id *nodes; /* [tape->outputs] */
    const double *variables; /* values of the variables beyond the inputs */
    gm_node_id *parts;       /* nodes that the outputs depend on, ascending */
    size_t part_count;
    uint32_t *numbers; /* numbers of the nodes' values; NONE: not known yet */
    double *folded;    /* values of nodes that depend on no input */
    bool *dependent;   /* nodes that depend on an input */
    uint32_t one;      /* the constant 1, for powers that need it */
    uint32_t zero;     /* the constant 0 of long code, followed by -0 */
    struct value *values;
    struct term *terms;
    uint32_t *products;      /* hash table of the numbers of products in powers; 0: a free place */
    size_t product_capacity; /* a power of two, above twice as many */
    struct group *groups;    /* groups in the order of the code */
    size_t number_count;     /* number of values as found: numbers are below it */
    size_t value_count, group_count, batch_count, sums_count, list_count, term_count;
    size_t least_rolled; /* values; shorter code keeps the formula's order */
    bool rolled;
    /* register, last group that needs it and, for computed values, stretch of each value */
    uint32_t *place, *last, *home;
    struct stretch *stretches;
    uint32_t *free[2]; /* stretches of one register, and of LARGEST_BATCH, that may be used again */
    size_t stretch_count, free_count[2];
};
static const uint32_t NONE = UINT32_MAX;

/* ---- from nodes to values ---- */

/* the exponent of a whole power is not a node: it names a chain */
static gm_node_id second_operand(const struct gm_node *node)
{
    return node->operation == GM_OPERATION_WHOLE_POWER ? node->a : gm_second_operand(node);
}

/* Computes all nodes that depend on no input. */
static void fold(struct writing *writing)
{
    for (size_t k = 0; k < writing->part_count; k++) {
        const gm_node_id i = writing->parts[k];
        const struct gm_node *node = &writing->graph->nodes[i];
        const gm_node_id b = gm_second_operand(node);
        bool dependent = node->operation == GM_VARIABLE && node->a < writing->tape->inputs;
        if (node->operation > GM_VARIABLE) {
            dependent = writing->dependent[node->a] || writing->dependent[b];
        }
        writing->numbers[i] = NONE;
        writing->dependent[i] = dependent;
        if (!dependent) {
            writing->folded[i] =
                node->operation == GM_CONSTANT ? node->value
                : node->operation == GM_VARIABLE
                    ? writing->variables[node->a]
                    : gm_operation_value(node->operation, writing->folded[node->a], writing->folded[b]);
        }
    }
}

static uint32_t constant(struct writing *writing, double value)
{
    struct gm_tape *tape = writing->tape;
    tape->constants =
        gm_arena_grown(writing->arena, tape->constants, tape->constant_count, sizeof *tape->constants);
    tape->constants[tape->constant_count++] = value;
    return (uint32_t)(tape->inputs + tape->constant_count - 1);
}

static void need(struct writing *writing, gm_node_id i)
{
    if (!writing->dependent[i] && writing->numbers[i] == NONE) {
        writing->numbers[i] = constant(writing, writing->folded[i]);
    }
}

static void find_constants(struct writing *writing)
{
    enum { MOST_PRODUCTS = 8 }; /* of a power */
    bool inverts = false;
    size_t powers = 0;
    for (size_t k = 0; k < writing->part_count; k++) {
        const struct gm_node *node = &writing->graph->nodes[writing->parts[k]];
        if (writing->dependent[writing->parts[k]] && node->operation > GM_VARIABLE) {
            need(writing, node->a);
            need(writing, second_operand(node));
            if (node->operation == GM_OPERATION_WHOLE_POWER) {
                powers++;
                inverts |= writing->graph->nodes[node->b].value <= 0;
            }
        }
    }
    for (size_t k = 0; k < writing->tape->outputs; k++) {
        need(writing, writing->nodes[k]);
    }
    writing->product_capacity = 1;
    while (writing->product_capacity < 2 * MOST_PRODUCTS * powers) {
        writing->product_capacity *= 2;
    }
    writing->products = gm_arena_take(writing->arena, writing->product_capacity, sizeof *writing->products);
    writing->one = inverts ? constant(writing, 1) : NONE;
    writing->zero = NONE;
    if (writing->part_count >= writing->least_rolled) {
        writing->zero = constant(writing, 0.0);
        constant(writing, -0.0);
    }
}

static uint32_t compute_value(struct writing *writing, uint32_t operation, uint32_t a, uint32_t b)
{
    const size_t first = writing->tape->inputs + writing->tape->constant_count;
    const uint32_t number = (uint32_t)(first + writing->value_count);
    writing->values =
        gm_arena_grown(writing->arena, writing->values, writing->value_count, sizeof *writing->values);
    writing->values[writing->value_count++] =
        (struct value){.operation = operation, .number = number, .a = a, .b = b};
    return number;
}

/* The place in a table of products for that of a and b: its own, or a free one. */
static uint32_t *product_place(const struct writing *writing, uint32_t a, uint32_t b)
{
    const size_t first = writing->tape->inputs + writing->tape->constant_count,
                 mask = writing->product_capacity - 1;
    size_t at = ((size_t)a * 0x9e3779b1 ^ (size_t)b * 0x85ebca6b) & mask;
    while (writing->products[at] > 0 && (writing->values[writing->products[at] - first].a != a ||
                                         writing->values[writing->products[at] - first].b != b)) {
        at = (at + 1) & mask;
    }
    return &writing->products[at];
}

/* A product within a power: powers of one number share theirs. */
static uint32_t product_of(struct writing *writing, uint32_t a, uint32_t b)
{
    uint32_t *place = product_place(writing, a, b);
    if (*place == 0) {
        *place = compute_value(writing, GM_OPERATION_MULTIPLY, a, b);
    }
    return *place;
}

/* x^n as gm_whole_power computes it, without its questions */
static uint32_t power_of(struct writing *writing, uint32_t x, double n)
{
    const int whole = (int)fabs(n);
    int bit = GM_MOST_CHAINED;
    if (whole == 0) {
        return compute_value(writing, GM_VARIABLE, writing->one, writing->one);
    }
    while (bit > 1 && !(whole & bit)) {
        bit /= 2;
    }
    uint32_t power = x;
    for (bit /= 2; bit > 0; bit /= 2) {
        power = product_of(writing, power, power);
        power = whole & bit ? product_of(writing, power, x) : power;
    }
    return n < 0 ? compute_value(writing, GM_OPERATION_DIVIDE, writing->one, power) : power;
}

static void find_values(struct writing *writing)
{
    struct gm_tape *tape = writing->tape;
    const uint32_t *const numbers = writing->numbers;
    for (size_t k = 0; k < writing->part_count; k++) {
        const gm_node_id i = writing->parts[k];
        const struct gm_node *node = &writing->graph->nodes[i];
        if (!writing->dependent[i]) {
            continue;
        }
        if (node->operation == GM_VARIABLE) {
            writing->numbers[i] = node->a;
            tape->first_used = node->a < tape->first_used ? node->a : tape->first_used;
            tape->last_used = node->a >= tape->last_used ? node->a + (size_t)1 : tape->last_used;
        } else if (node->operation == GM_OPERATION_WHOLE_POWER) {
            writing->numbers[i] = power_of(writing, numbers[node->a], writing->graph->nodes[node->b].value);
        } else {
            writing->numbers[i] =
                compute_value(writing, node->operation, numbers[node->a], numbers[second_operand(node)]);
        }
    }
}

/* ---- long sums ---- */

static bool is_sum(const struct value *value)
{
    return value->operation == GM_OPERATION_ADD || value->operation == GM_OPERATION_SUBTRACT;
}

/* The sum that only leads to the one at `at`; without such a sum `at` itself. */
static size_t sum_below(const struct value *straight, size_t at, uint32_t fixed, const uint32_t *used)
{
    const uint32_t operands[] = {straight[at].a, straight[at].b};
    for (int k = 0; k < (straight[at].operation == GM_OPERATION_ADD ? 2 : 1); k++) {
        if (operands[k] >= fixed && used[operands[k]] == 1 && is_sum(&straight[operands[k] - fixed])) {
            return operands[k] - fixed;
        }
    }
    return at;
}

/* Merges sums that only lead to this one into one value, if they are many: its terms, in the order of the
   formula. used: number of uses of each number. Merged values have no level. */
static void gather_sum(struct writing *writing, struct value *straight, size_t last, const uint32_t *used)
{
    const uint32_t fixed = (uint32_t)(writing->tape->inputs + writing->tape->constant_count);
    uint32_t length = 1;
    size_t at, next;
    for (at = last; (next = sum_below(straight, at, fixed, used)) != at; at = next) {
        length++;
    }
    if (length < LEAST_SUM) {
        return;
    }
    for (uint32_t k = 0; k <= length; k++) {
        writing->terms =
            gm_arena_grown(writing->arena, writing->terms, writing->term_count + k, sizeof *writing->terms);
    }
    struct term *term = writing->terms + writing->term_count + length; /* the last one is met first */
    for (at = last; (next = sum_below(straight, at, fixed, used)) != at; at = next) {
        const struct value *value = &straight[at];
        *term-- = (struct term){value->a == next + fixed ? value->b : value->a,
                                value->operation == GM_OPERATION_SUBTRACT};
        straight[next].level = NONE;
    }
    term[0] = (struct term){straight[at].b, straight[at].operation == GM_OPERATION_SUBTRACT};
    term[-1] = (struct term){straight[at].a, false};
    straight[last].operation = GM_SUMMED;
    straight[last].first_term = (uint32_t)writing->term_count;
    straight[last].terms = length + 1;
    writing->term_count += length + 1;
}

static void find_sums(struct writing *writing, struct value *straight, uint32_t *used)
{
    for (size_t i = 0; i < writing->value_count; i++) {
        used[straight[i].a]++;
        used[straight[i].b] += straight[i].b != straight[i].a || is_sum(&straight[i]);
    }
    for (size_t k = 0; k < writing->tape->outputs; k++) {
        used[writing->numbers[writing->nodes[k]]] += 2; /* it has to be there */
    }
    for (size_t i = writing->value_count; i-- > 0;) {
        if (is_sum(&straight[i]) && straight[i].level != NONE) {
            gather_sum(writing, straight, i, used);
        }
    }
}

/* The number of a value's operands. */
static size_t operand_count(const struct value *value)
{
    return value->terms > 0 ? value->terms : 2;
}

static uint32_t operand(const struct writing *writing, const struct value *value, size_t k)
{
    return value->terms > 0 ? writing->terms[value->first_term + k].number : k > 0 ? value->b : value->a;
}

/* ---- from values to code ---- */

static int compare(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

/* Orders of the values of a level that have one shape, one of which may leave rows whole. */
static int order(const uint32_t keys[2][2])
{
    return keys[0][0] != keys[1][0] ? compare(keys[0][0], keys[1][0]) : compare(keys[0][1], keys[1][1]);
}

static int by_shape(const void *a, const void *b)
{
    const struct value *x = a, *y = b;
    return x->operation != y->operation ? compare(x->operation, y->operation)
           : x->shape != y->shape       ? compare(x->shape, y->shape)
                                        : compare(x->number, y->number);
}

static int by_first(const void *a, const void *b)
{
    const struct value *x = a, *y = b;
    return order((const uint32_t[2][2]){{x->a_rank, x->b_rank}, {y->a_rank, y->b_rank}});
}

static int by_second(const void *a, const void *b)
{
    const struct value *x = a, *y = b;
    return order((const uint32_t[2][2]){{x->b_rank, x->a_rank}, {y->b_rank, y->a_rank}});
}

static int by_distance(const void *a, const void *b)
{
    const struct value *x = a, *y = b;
    return order(
        (const uint32_t[2][2]){{x->b_rank - x->a_rank, x->a_rank}, {y->b_rank - y->a_rank, y->a_rank}});
}

/* The number of operands that neither stay nor advance by one. */
static size_t breaks_of(const struct value *values, size_t count)
{
    size_t breaks = 0;
    for (size_t i = 1; i < count; i++) {
        breaks += values[i].a_rank - values[i - 1].a_rank > 1 || values[i].b_rank - values[i - 1].b_rank > 1;
    }
    return breaks;
}

static void sort_alike(struct value *values, size_t count)
{
    static int (*const orders[])(const void *, const void *) = {by_first, by_second, by_distance};
    enum { ORDERS = GM_COUNT(orders), FEW = 16 };
    size_t least = SIZE_MAX;
    int best = 0, last = 0;
    for (int k = 0; k < ORDERS && least > count / FEW; k++) {
        qsort(values, count, sizeof *values, orders[k]);
        const size_t breaks = breaks_of(values, count);
        best = breaks < least ? k : best;
        least = breaks < least ? breaks : least;
        last = k;
    }
    if (best != last) {
        qsort(values, count, sizeof *values, orders[best]);
    }
}

/* Sorts a level so that values with one role in a sum's terms become a row, as do values computed from
   them. */
static void sort_level(struct value *values, size_t count)
{
    qsort(values, count, sizeof *values, by_shape);
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin + 1; end < count && values[end].operation == values[begin].operation &&
                              values[end].shape == values[begin].shape;
             end++) {
        }
        sort_alike(values + begin, end - begin);
    }
}

/* The end of the group that begins at `begin`. */
static size_t end_of(const struct writing *writing, size_t begin)
{
    const struct value *values = writing->values;
    size_t end = begin + 1;
    while (writing->rolled && end < writing->value_count && end - begin < LARGEST_BATCH &&
           values[end].level == values[begin].level && values[end].operation == values[begin].operation &&
           (values[end].shape == values[begin].shape || end - begin < LEAST_BATCH)) {
        end++;
    }
    return end - begin < LEAST_BATCH && values[begin].operation != GM_SUMMED ? begin + 1 : end;
}

static void find_groups(struct writing *writing)
{
    writing->group_count = 0;
    for (size_t begin = 0, end; begin < writing->value_count; begin = end) {
        end = end_of(writing, begin);
        writing->groups[writing->group_count++] = (struct group){begin, end};
    }
}

/* Sorts the values of `straight` by level, and within a level so that rows are computed from rows. counts:
   room for the number of values + 1. */
static void sort(struct writing *writing, struct value *straight, uint32_t *rank, size_t *counts)
{
    const size_t fixed = writing->tape->inputs + writing->tape->constant_count, all = writing->value_count;
    struct value *values = writing->values;
    for (size_t i = 0; i < all; i++) {
        if (straight[i].level == NONE) {
            continue;
        }
        uint32_t level = 0, shape = straight[i].operation;
        for (size_t k = 0; k < operand_count(&straight[i]); k++) {
            const uint32_t number = operand(writing, &straight[i], k),
                           below = number < fixed ? 0 : straight[number - fixed].level;
            level = below > level ? below : level;
            if (straight[i].terms == 0) {
                shape = shape * 0x85ebca6b + (number < writing->tape->inputs ? 1
                                              : number < fixed               ? 2
                                                               : straight[number - fixed].shape);
                shape ^= shape >> 15;
            }
        }
        straight[i].level = level + 1;
        straight[i].shape = shape;
        counts[level + 1]++;
    }
    for (size_t level = 1; level <= all; level++) {
        counts[level] += counts[level - 1];
    }
    const size_t count = writing->value_count = counts[all];
    for (size_t i = 0; i < all; i++) {
        if (straight[i].level != NONE) {
            values[counts[straight[i].level - 1]++] = straight[i];
        }
    }
    for (uint32_t i = 0; i < fixed; i++) {
        rank[i] = i;
    }
    for (size_t begin = 0, end; begin < count; begin = end) {
        for (end = begin; end < count && values[end].level == values[begin].level; end++) {
            const bool summed = values[end].operation == GM_SUMMED; /* sums keep their operands */
            values[end].a_rank = summed ? values[end].number : rank[values[end].a];
            values[end].b_rank = summed ? values[end].number : rank[values[end].b];
        }
        sort_level(values + begin, end - begin);
        for (size_t i = begin; i < end; i++) {
            rank[values[i].number] = (uint32_t)(fixed + i);
        }
    }
}

/* Sorts values, if then most of them share a group. */
static bool roll(struct writing *writing)
{
    const size_t fixed = writing->tape->inputs + writing->tape->constant_count, count = writing->value_count;
    struct value *straight = gm_arena_take(writing->arena, count, sizeof *straight),
                 *before = gm_arena_take(writing->arena, count, sizeof *before);
    uint32_t *rank = gm_arena_take(writing->arena, fixed + count, sizeof *rank);
    memcpy(straight, writing->values, count * sizeof *straight);
    memcpy(before, writing->values, count * sizeof *before);
    find_sums(writing, straight, rank);
    sort(writing, straight, rank, gm_arena_take(writing->arena, count + 1, sizeof(size_t)));
    writing->rolled = true;
    find_groups(writing);
    if (writing->group_count > count / 2) {
        memcpy(writing->values, before, count * sizeof *before);
        writing->value_count = count;
        writing->rolled = false;
        find_groups(writing);
    }
    return writing->rolled;
}

/* Orders groups by need, from the last one down: each follows its operands closely, so that values from
   one to the next are still in the fastest cache. */
static void order_by_need(struct writing *writing)
{
    const size_t fixed = writing->tape->inputs + writing->tape->constant_count, count = writing->group_count;
    struct open_group {
        uint32_t group;
        size_t value, operand; /* the first of its values', that is not seen to yet */
    } *path = gm_arena_take(writing->arena, count, sizeof *path);
    struct group *ordered = gm_arena_take(writing->arena, count, sizeof *ordered);
    uint32_t *group_of = gm_arena_take(writing->arena, writing->number_count, sizeof *group_of);
    bool *met = gm_arena_take(writing->arena, count, sizeof *met);
    for (uint32_t k = 0; k < count; k++) {
        for (size_t i = writing->groups[k].begin; i < writing->groups[k].end; i++) {
            group_of[writing->values[i].number - fixed] = k;
        }
    }
    size_t done = 0;
    for (size_t root = count; root-- > 0;) {
        size_t depth = 0;
        if (!met[root]) {
            met[root] = true;
            path[depth++] = (struct open_group){.group = (uint32_t)root};
        }
        while (depth > 0) {
            struct open_group *last = &path[depth - 1];
            const struct group *group = &writing->groups[last->group];
            const struct value *value = &writing->values[group->begin + last->value];
            if (group->begin + last->value == group->end) {
                ordered[done++] = *group;
                depth--;
                continue;
            }
            const uint32_t number = operand(writing, value, last->operand++);
            if (last->operand == operand_count(value)) {
                last->value++;
                last->operand = 0;
            }
            if (number >= fixed && !met[group_of[number - fixed]]) {
                const uint32_t needed = group_of[number - fixed];
                met[needed] = true;
                path[depth++] = (struct open_group){.group = needed};
            }
        }
    }
    memcpy(writing->groups, ordered, count * sizeof *ordered);
}

/* A stretch for the values of a group. */
static uint32_t take(struct writing *writing, size_t count)
{
    const bool wide = count > 1;
    uint32_t taken = (uint32_t)writing->stretch_count;
    if (writing->free_count[wide] > 0) {
        taken = writing->free[wide][--writing->free_count[wide]];
    } else {
        const uint32_t first = (uint32_t)writing->tape->registers;
        writing->stretches[writing->stretch_count++] = (struct stretch){first, 0, wide};
        writing->tape->registers += wide ? LARGEST_BATCH : 1;
    }
    writing->stretches[taken].alive = (uint32_t)count;
    return taken;
}

/* Gives back the register of a value that only this group still needs. */
static void release(struct writing *writing, uint32_t number, uint32_t group)
{
    if (writing->last[number] == group) {
        const uint32_t home = writing->home[number];
        struct stretch *stretch = &writing->stretches[home];
        writing->last[number] = NONE; /* once, if it is both operands */
        if (--stretch->alive == 0) {
            writing->free[stretch->wide][writing->free_count[stretch->wide]++] = home;
        }
    }
}

static void put(struct writing *writing, uint32_t operation, uint32_t to, uint32_t a, uint32_t b)
{
    struct gm_tape *tape = writing->tape;
    tape->code = gm_arena_grown(writing->arena, tape->code, tape->length, sizeof *tape->code);
    const struct gm_instruction *before =
        tape->length > 0 && operation < GM_REPEATED ? &tape->code[tape->length - 1] : NULL;
    const bool near = before && before->operation < GM_REPEATED;
    const uint32_t way =
        4 * operation + (near && a == before->to ? 1 : 0) + (near && b == before->to ? 2 : 0);
    tape->code[tape->length++] = (struct gm_instruction){(uint16_t)operation, (uint16_t)way, to, a, b};
}

static uint32_t register_of(const struct writing *writing, const struct value *value, bool second)
{
    return writing->place[second ? value->b : value->a];
}

static void put_in_list(struct writing *writing, uint32_t entry)
{
    struct gm_tape *tape = writing->tape;
    tape->lists = gm_arena_grown(writing->arena, tape->lists, writing->list_count, sizeof *tape->lists);
    tape->lists[writing->list_count++] = entry;
}

static struct gm_operands operands_of(struct writing *writing, const struct value *values, size_t count,
                                      bool second, bool may_be_one)
{
    const uint32_t first = register_of(writing, values, second), list = (uint32_t)writing->list_count;
    bool row = true, one = may_be_one;
    for (size_t i = 0; i < count; i++) {
        row = row && register_of(writing, &values[i], second) == first + i;
        one = one && register_of(writing, &values[i], second) == first;
    }
    for (size_t i = 0; i < count && !row && !one; i++) {
        put_in_list(writing, register_of(writing, &values[i], second));
    }
    return row   ? (struct gm_operands){GM_IN_A_ROW, first}
           : one ? (struct gm_operands){GM_THE_SAME, first}
                 : (struct gm_operands){GM_LISTED, list};
}

static void put_repeated(struct writing *writing, const struct gm_repeated *batch)
{
    struct gm_tape *tape = writing->tape;
    tape->batches =
        gm_arena_grown(writing->arena, tape->batches, writing->batch_count, sizeof *tape->batches);
    /* registers 0: they are read before anybody looks at the operation */
    put(writing, GM_REPEATED, (uint32_t)writing->batch_count, 0, 0);
    tape->batches[writing->batch_count++] = *batch;
}

static void put_batch(struct writing *writing, const struct value *values, size_t count, uint32_t to)
{
    struct gm_repeated batch = {.operation = values[0].operation, .count = (uint32_t)count, .to = to};
    batch.a = operands_of(writing, values, count, false, true);
    batch.b = batch.a;
    if (gm_operation_rows[batch.operation].arity == 2) {
        batch.b = operands_of(writing, values, count, true, batch.a.lie != GM_THE_SAME);
    }
    put_repeated(writing, &batch);
}

/* The number of values from this one on whose operands are in a row, or all the same. */
static size_t run_of(const struct writing *writing, const struct value *values, size_t count)
{
    size_t run = count;
    for (unsigned k = 0; k < gm_operation_rows[values->operation].arity; k++) {
        const uint32_t first = register_of(writing, values, k);
        const uint32_t apart = count > 1 ? register_of(writing, &values[1], k) - first : 0;
        size_t length = 1;
        while (length < run && apart <= 1 &&
               register_of(writing, &values[length], k) == first + length * apart) {
            length++;
        }
        run = length;
    }
    return run;
}

/* A group as a few instructions, most of which need not gather their operands. */
static void put_group(struct writing *writing, const struct value *values, size_t count, uint32_t to)
{
    for (size_t begin = 0, end; begin < count; begin = end) {
        bool gathers = false;
        end = begin + run_of(writing, values + begin, count - begin);
        while ((end - begin < LEAST_RUN || gathers) && end < count &&
               run_of(writing, values + end, count - end) < LEAST_RUN) {
            gathers = true;
            end++;
        }
        put_batch(writing, values + begin, end - begin, to + (uint32_t)begin);
    }
}

/* Sums beside each other: in every row the sum with the most remaining terms decides the operation. */
static void put_sums(struct writing *writing, const struct value *values, size_t count, uint32_t to)
{
    struct gm_tape *tape = writing->tape;
    struct gm_sums sums = {.to = to, .count = (uint32_t)count, .at = (uint32_t)writing->list_count};
    uint32_t done[GM_ABREAST] = {0};
    const uint32_t zero = writing->place[writing->zero];
    for (bool more = true; more; sums.rows++) {
        uint32_t most = 0;
        bool subtracted = false;
        for (size_t k = 0; k < count; k++) {
            const uint32_t left = values[k].terms - done[k];
            if (left > most) {
                most = left;
                subtracted = writing->terms[values[k].first_term + done[k]].subtracted;
            }
        }
        if (most == 0) {
            break;
        }
        put_in_list(writing, sums.rows == 0 ? GM_VARIABLE
                             : subtracted   ? GM_OPERATION_SUBTRACT
                                            : GM_OPERATION_ADD);
        for (size_t k = 0; k < GM_ABREAST; k++) {
            const struct term *term = k < count && done[k] < values[k].terms
                                          ? &writing->terms[values[k].first_term + done[k]]
                                          : NULL;
            const bool takes = term && term->subtracted == subtracted;
            put_in_list(writing, takes ? writing->place[term->number] : subtracted ? zero : zero + 1);
            done[takes ? k : 0] += takes;
        }
    }
    tape->sums = gm_arena_grown(writing->arena, tape->sums, writing->sums_count, sizeof *tape->sums);
    put(writing, GM_SUMMED, (uint32_t)writing->sums_count, 0, 0);
    tape->sums[writing->sums_count++] = sums;
}

static void put_all_sums(struct writing *writing, const struct value *values, size_t count, uint32_t to)
{
    for (size_t begin = 0; begin < count; begin += GM_ABREAST) {
        const size_t left = count - begin;
        put_sums(writing, values + begin, left < GM_ABREAST ? left : GM_ABREAST, to + (uint32_t)begin);
    }
}

/* Finds each value's place and last use. */
static void prepare(struct writing *writing)
{
    struct gm_tape *tape = writing->tape;
    const size_t count = tape->outputs;
    const uint32_t fixed = (uint32_t)(tape->inputs + tape->constant_count);
    for (uint32_t i = 0; i < fixed + writing->number_count; i++) {
        writing->place[i] = i < fixed ? i : NONE;
        writing->last[i] = NONE;
    }
    for (uint32_t k = 0; k < writing->group_count; k++) {
        for (size_t i = writing->groups[k].begin; i < writing->groups[k].end; i++) {
            for (size_t j = 0; j < operand_count(&writing->values[i]); j++) {
                const uint32_t number = operand(writing, &writing->values[i], j);
                writing->last[number] = number < fixed ? NONE : k;
            }
        }
    }
    /* the first output that is this value */
    for (size_t k = count; k-- > 0;) {
        const uint32_t number = writing->numbers[writing->nodes[k]];
        if (number >= fixed) {
            writing->place[number] = fixed + (uint32_t)k;
            writing->last[number] = NONE;
        }
    }
    tape->registers = fixed + count;
}

/* Outputs that were made elsewhere; many in a row at once. */
static void put_copies(struct writing *writing)
{
    const gm_node_id *nodes = writing->nodes;
    const size_t count = writing->tape->outputs;
    const uint32_t first = (uint32_t)(writing->tape->inputs + writing->tape->constant_count);
    for (size_t begin = 0, end; begin < count; begin = end) {
        const uint32_t to = first + (uint32_t)begin, from = writing->place[writing->numbers[nodes[begin]]];
        end = begin + 1;
        while (writing->rolled && from != to && end < count &&
               writing->place[writing->numbers[nodes[end]]] == from + (end - begin)) {
            end++;
        }
        if (end - begin >= LEAST_RUN) {
            const struct gm_operands row = {GM_IN_A_ROW, from};
            put_repeated(writing, &(struct gm_repeated){GM_VARIABLE, (uint32_t)(end - begin), to, row, row});
        } else if (from != to) {
            put(writing, GM_VARIABLE, to, from, from);
            end = begin + 1;
        }
    }
}

static void write_code(struct writing *writing)
{
    prepare(writing);
    for (uint32_t group = 0; group < writing->group_count; group++) {
        const size_t begin = writing->groups[group].begin, end = writing->groups[group].end;
        const struct value *first = &writing->values[begin];
        const bool is_output = end - begin == 1 && writing->place[first->number] != NONE;
        const uint32_t home = is_output ? NONE : take(writing, end - begin),
                       to = is_output ? writing->place[first->number] : writing->stretches[home].first;
        if (first->operation == GM_SUMMED) {
            put_all_sums(writing, first, end - begin, to);
        } else if (end - begin > 1) {
            put_group(writing, first, end - begin, to);
        } else {
            put(writing, first->operation, to, writing->place[first->a], writing->place[first->b]);
        }
        for (size_t i = begin; i < end; i++) {
            const struct value *value = &writing->values[i];
            writing->place[value->number] = to + (uint32_t)(i - begin);
            writing->home[value->number] = home;
            for (size_t j = 0; j < operand_count(value); j++) {
                release(writing, operand(writing, value, j), group);
            }
        }
    }
    put_copies(writing);
}

static void compile(struct gm_arena *arena, void *data)
{
    struct writing *writing = data;
    struct gm_tape *tape = writing->tape;
    tape->code = gm_arena_take(arena, 1, sizeof *tape->code);
    tape->batches = gm_arena_take(arena, 1, sizeof *tape->batches);
    tape->sums = gm_arena_take(arena, 1, sizeof *tape->sums);
    tape->lists = gm_arena_take(arena, 1, sizeof *tape->lists);
    tape->constants = gm_arena_take(arena, 1, sizeof *tape->constants);
    const size_t mark = gm_arena_mark(arena); /* what follows is scratch */
    writing->parts = gm_arena_keep(
        arena, gm_formula_parts_of(writing->graph, writing->nodes, tape->outputs, &writing->part_count),
        free);
    const size_t capacity = writing->part_count > 0 ? writing->parts[writing->part_count - 1] + (size_t)1 : 1;
    writing->numbers = gm_arena_take(arena, capacity, sizeof *writing->numbers);
    writing->folded = gm_arena_take(arena, capacity, sizeof *writing->folded);
    writing->dependent = gm_arena_take(arena, capacity, sizeof *writing->dependent);
    fold(writing);
    find_constants(writing);
    find_values(writing);
    writing->number_count = writing->value_count;
    writing->groups = gm_arena_take(arena, writing->value_count + 1, sizeof *writing->groups);
    if (writing->value_count < writing->least_rolled || writing->zero == NONE) {
        find_groups(writing);
    } else if (roll(writing)) {
        order_by_need(writing);
    }
    const size_t all = tape->inputs + tape->constant_count + writing->number_count + 1;
    uint32_t **const lists[] = {&writing->place, &writing->last, &writing->home, &writing->free[0],
                                &writing->free[1]};
    for (size_t i = 0; i < GM_COUNT(lists); i++) {
        *lists[i] = gm_arena_take(arena, all, sizeof **lists[i]);
    }
    writing->stretches = gm_arena_take(arena, all, sizeof *writing->stretches);
    write_code(writing);
    tape->rolled = writing->rolled;
    gm_arena_release(arena, mark);
}

/* Opens code, in rows if it has writing.least_rolled values or more, most of which share a group. */
static bool open_code(struct gm_tape *tape, struct writing writing, size_t outputs, size_t inputs)
{
    *tape = (struct gm_tape){
        .inputs = inputs, .outputs = outputs, .first_used = inputs, .arena = gm_arena_open()};
    writing.tape = tape;
    writing.arena = tape->arena;
    return gm_arena_run(tape->arena, compile, &writing);
}

bool gm_tape_open(struct gm_tape *tape, const struct gm_formula *graph, const gm_node_id *nodes, size_t count,
                  size_t inputs, const double *values)
{
    struct writing writing = {
        .graph = graph, .nodes = nodes, .variables = values, .least_rolled = LEAST_ROLLED};
    bool good = open_code(tape, writing, count, inputs);
    if (good && !tape->rolled && tape->length >= LEAST_ROWS) {
        writing.least_rolled = LEAST_ROWS;
        tape->rows = gm_arena_take(tape->arena, 1, sizeof *tape->rows);
        good = tape->rows && open_code(tape->rows, writing, count, inputs);
        if (good && !tape->rows->rolled) {
            gm_tape_close(tape->rows);
            tape->rows = NULL;
        }
    }
    return good;
}

void gm_tape_close(struct gm_tape *tape)
{
    if (tape->rows) {
        gm_tape_close(tape->rows);
    }
    gm_arena_close(tape->arena);
    *tape = (struct gm_tape){0};
}

static void close_tape(void *tape)
{
    gm_tape_close(tape);
}

void gm_tape_keep(struct gm_arena *arena, struct gm_tape *tape, bool opened)
{
    gm_arena_keep(arena, tape, close_tape);
    gm_arena_need(arena, opened);
}

struct gm_sparse gm_sparse_jacobian(struct gm_arena *arena, struct gm_formula *graph, const gm_node_id *nodes,
                                    size_t rows, const bool *marked, size_t variables)
{
    size_t capacity = 64;
    struct gm_sparse jacobian = {.entries = gm_arena_take(arena, capacity, sizeof *jacobian.entries)};
    const size_t mark = gm_arena_mark(arena);
    gm_node_id *gradient = gm_arena_take(arena, variables, sizeof *gradient);
    for (size_t row = 0; row < rows; row++) {
        gm_arena_need(arena, gm_gradient(graph, nodes[row], marked, variables, gradient));
        for (size_t column = 0; column < variables; column++) {
            if (gm_is_constant(graph, gradient[column], 0)) {
                continue;
            }
            if (jacobian.count == capacity) {
                capacity *= 2;
                jacobian.entries =
                    gm_arena_resize(arena, jacobian.entries, capacity, sizeof *jacobian.entries);
            }
            jacobian.entries[jacobian.count++] = (struct gm_sparse_entry){row, column, gradient[column]};
        }
    }
    gm_arena_release(arena, mark);
    return jacobian;
}

gm_node_id *gm_sparse_nodes(struct gm_arena *arena, const gm_node_id *before, size_t count,
                            const struct gm_sparse *jacobian)
{
    gm_node_id *nodes = gm_arena_take(arena, count + jacobian->count + 1, sizeof *nodes);
    for (size_t i = 0; i < count + jacobian->count; i++) {
        nodes[i] = i < count ? before[i] : jacobian->entries[i - count].node;
    }
    return nodes;
}

/* ---- code to numbers ---- */

static struct gm_instruction member(const struct gm_tape *tape, const struct gm_repeated *batch, uint32_t i)
{
    const struct gm_operands *const operands[] = {&batch->a, &batch->b};
    uint32_t at[2];
    for (int k = 0; k < 2; k++) {
        const uint32_t from = operands[k]->at;
        at[k] = operands[k]->lie == GM_LISTED ? tape->lists[from + i]
                                              : from + (operands[k]->lie == GM_IN_A_ROW ? i : 0);
    }
    return (struct gm_instruction){
        .operation = (uint16_t)batch->operation, .to = batch->to + i, .a = at[0], .b = at[1]};
}

static struct gm_instruction term(const struct gm_tape *tape, const struct gm_sums *sums, uint32_t sum,
                                  uint32_t row)
{
    const uint32_t *list = tape->lists + sums->at + row * (1 + GM_ABREAST);
    const uint32_t to = sums->to + sum, next = list[1 + sum];
    return (struct gm_instruction){
        .operation = (uint16_t)list[0], .to = to, .a = row > 0 ? to : next, .b = next};
}

bool gm_tape_next(const struct gm_tape *tape, struct gm_tape_place *at, struct gm_instruction *now)
{
    if (at->instruction == tape->length) {
        return false;
    }
    *now = tape->code[at->instruction];
    uint32_t rows = 1, members = 1;
    if (now->operation == GM_REPEATED) {
        const struct gm_repeated *batch = &tape->batches[now->to];
        members = batch->count;
        *now = member(tape, batch, at->member);
    } else if (now->operation == GM_SUMMED) {
        const struct gm_sums *sums = &tape->sums[now->to];
        members = sums->count;
        rows = sums->rows;
        *now = term(tape, sums, at->member, at->row);
    }
    at->row = at->row + 1 < rows ? at->row + 1 : 0;
    at->member += at->row == 0;
    if (at->member == members) {
        at->member = 0;
        at->instruction++;
    }
    return true;
}

/* An operation for rows of `count` numbers; of an operand that is the same for all, `one`, there is one
   number. */
#define GM_ROW(value_, x_, y_)                                                                               \
    for (size_t i = 0; i < count; i++) {                                                                     \
        const double a = x_, b = y_;                                                                         \
        (void)b;                                                                                             \
        to[i] = value_;                                                                                      \
    }
#define GM_ROWS(value_)                                                                                      \
    if (one_x) {                                                                                             \
        GM_ROW(value_, *x, y[i])                                                                             \
    } else if (one_y) {                                                                                      \
        GM_ROW(value_, x[i], *y)                                                                             \
    } else {                                                                                                 \
        GM_ROW(value_, x[i], y[i])                                                                           \
    }

/* Returns true for one instruction of the processor: copies, arithmetic and the root. */
static inline bool is_instruction(uint32_t operation)
{
    return operation <= GM_OPERATION_NEGATE || operation == GM_OPERATION_SQRT;
}

/* Returns true for what core/functions computes for rows. */
static inline bool is_function(uint32_t operation)
{
    switch (operation) {
#define GM_FORMULA_FUNCTION(constant, name, arity) case GM_OPERATION_##constant:
#include "core/functions/functions.def"
        return true;
    default:
        return false;
    }
}

static void compute_by_function(uint32_t operation, double *to, const double *x, bool one_x, const double *y,
                                bool one_y, size_t count)
{
    const struct gm_function_rows *rows = gm_function_rows();
    switch (operation) {
#define GM_FORMULA_FUNCTION(constant, name, arity)                                                           \
    case GM_OPERATION_##constant:                                                                            \
        rows->name(to, x, one_x, y, one_y, count);                                                           \
        break;
#include "core/functions/functions.def"
    }
}

/* Two functions, since one that calls others has to save registers, at every row; neither is inlined, where
   compilers would forget that rows do not overlap. */
GM_CLONES static void compute_by_instruction(uint32_t operation, double *restrict to,
                                             const double *restrict x, bool one_x, const double *restrict y,
                                             bool one_y, size_t count)
{
    switch ((enum gm_operation)operation) {
#define GM_OPERATION(constant, name, latex, arity, smooth, value_, over_a, over_b)                           \
    case GM_OPERATION_##constant:                                                                            \
        if (!is_instruction(GM_OPERATION_##constant)) {                                                      \
            __builtin_unreachable();                                                                         \
        }                                                                                                    \
        GM_ROWS(value_)                                                                                      \
        break;
#include "core/expression/operations.def"
#undef GM_OPERATION
    case GM_CONSTANT:
    case GM_VARIABLE:
    case GM_OPERATIONS:
        GM_ROWS(a)
        break;
    }
}

GM_CLONES static void compute_by_call(uint32_t operation, double *restrict to, const double *restrict x,
                                      bool one_x, const double *restrict y, bool one_y, size_t count)
{
    switch ((enum gm_operation)operation) {
#define GM_OPERATION(constant, name, latex, arity, smooth, value_, over_a, over_b)                           \
    case GM_OPERATION_##constant:                                                                            \
        if (is_instruction(GM_OPERATION_##constant) || is_function(GM_OPERATION_##constant)) {               \
            __builtin_unreachable();                                                                         \
        }                                                                                                    \
        GM_ROWS(value_)                                                                                      \
        break;
#include "core/expression/operations.def"
#undef GM_OPERATION
    case GM_CONSTANT:
    case GM_VARIABLE:
    case GM_OPERATIONS:
        __builtin_unreachable();
    }
}

static inline void compute_row(uint32_t operation, double *to, const double *x, bool one_x, const double *y,
                               bool one_y, size_t count)
{
    if (is_instruction(operation)) {
        compute_by_instruction(operation, to, x, one_x, y, one_y, count);
    } else if (is_function(operation)) {
        compute_by_function(operation, to, x, one_x, y, one_y, count);
    } else {
        compute_by_call(operation, to, x, one_x, y, one_y, count);
    }
}

/* The operands of a batch for one state, in a row: in place, or gathered. */
static inline const double *gathered(const struct gm_tape *tape, const struct gm_operands *operands,
                                     uint32_t count, const double *r, double *scratch)
{
    if (operands->lie != GM_LISTED) {
        return r + operands->at;
    }
    const uint32_t *list = tape->lists + operands->at;
    for (uint32_t i = 0; i < count; i++) {
        scratch[i] = r[list[i]];
    }
    return scratch;
}

/* Not inlined: what it needs would burden every other instruction of a single state. */
__attribute__((noinline)) static void compute_batch(const struct gm_tape *tape,
                                                    const struct gm_repeated *batch, double *r)
{
    double scratch[2][LARGEST_BATCH];
    const double *x = gathered(tape, &batch->a, batch->count, r, scratch[0]),
                 *y = gathered(tape, &batch->b, batch->count, r, scratch[1]);
    compute_row(batch->operation, r + batch->to, x, batch->a.lie == GM_THE_SAME, y,
                batch->b.lie == GM_THE_SAME, batch->count);
}

/* Sums for one state: as many chains of additions as a processor has under way at once. */
__attribute__((noinline)) static void compute_sums(const struct gm_tape *tape, const struct gm_sums *sums,
                                                   double *r)
{
    const uint32_t *list = tape->lists + sums->at;
    double sum[GM_ABREAST];
    for (size_t k = 0; k < GM_ABREAST; k++) {
        sum[k] = r[list[1 + k]];
    }
    for (uint32_t row = 1; row < sums->rows; row++) {
        list += 1 + GM_ABREAST;
        if (list[0] == GM_OPERATION_ADD) {
            for (size_t k = 0; k < GM_ABREAST; k++) {
                sum[k] += r[list[1 + k]];
            }
        } else {
            for (size_t k = 0; k < GM_ABREAST; k++) {
                sum[k] -= r[list[1 + k]];
            }
        }
    }
    for (uint32_t k = 0; k < sums->count; k++) {
        r[sums->to + k] = sum[k];
    }
}

/* One state: r holds all registers. What the instruction before has made is not read back from there: in a
   chain of operations a store and a load take longer than most of them. */
static void compute(const struct gm_tape *tape, double *r)
{
    const struct gm_instruction *const end = tape->code + tape->length;
    double last = 0;
    for (const struct gm_instruction *at = tape->code; at < end; at++) {
        switch (at->way) {
#define GM_WAY(number, a_, b_, value_)                                                                       \
    case number: {                                                                                           \
        const double a = a_, b = b_;                                                                         \
        (void)b;                                                                                             \
        last = value_;                                                                                       \
        break;                                                                                               \
    }
#define GM_WAYS(operation, value_)                                                                           \
    GM_WAY(4 * (operation), r[at->a], r[at->b], value_)                                                      \
    GM_WAY(4 * (operation) + 1, last, r[at->b], value_)                                                      \
    GM_WAY(4 * (operation) + 2, r[at->a], last, value_)                                                      \
    GM_WAY(4 * (operation) + 3, last, last, value_)
#define GM_OPERATION(constant, name, latex, arity, smooth, value_, over_a, over_b)                           \
    GM_WAYS(GM_OPERATION_##constant, value_)
#include "core/expression/operations.def"
#undef GM_OPERATION
            GM_WAYS(GM_VARIABLE, a)
#undef GM_WAYS
#undef GM_WAY
        case 4 * GM_REPEATED:
            compute_batch(tape, &tape->batches[at->to], r);
            continue;
        case 4 * GM_SUMMED:
            compute_sums(tape, &tape->sums[at->to], r);
            continue;
        default: /* it need not be asked */
            __builtin_unreachable();
        }
        r[at->to] = last;
    }
}

/* A term for a row of sums. */
GM_CLONES static void add_row(double *restrict to, const double *restrict term, bool one, bool subtracted,
                              size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] += subtracted ? -term[one ? 0 : i] : term[one ? 0 : i];
    }
}

/* An operation for a block of members: at[register] is its row, or of a constant its one number. */
static inline void compute_rows_of(const struct gm_tape *tape, const struct gm_instruction *now,
                                   double *const *at, size_t count)
{
    const bool one_a = now->a - tape->inputs < tape->constant_count,
               one_b = now->b - tape->inputs < tape->constant_count;
    if (now->a == now->to) {
        add_row(at[now->to], at[now->b], one_b, now->operation == GM_OPERATION_SUBTRACT, count);
    } else {
        compute_row(now->operation, at[now->to], at[now->a], one_a, at[now->b], one_b, count);
    }
}

static void compute_rows(const struct gm_tape *tape, double *const *at, size_t count)
{
    for (size_t k = 0; k < tape->length; k++) {
        if (tape->code[k].operation < GM_REPEATED) {
            compute_rows_of(tape, &tape->code[k], at, count);
            continue;
        }
        struct gm_tape_place place = {.instruction = k};
        struct gm_instruction now;
        while (place.instruction == k && gm_tape_next(tape, &place, &now)) {
            compute_rows_of(tape, &now, at, count);
        }
    }
}

/* Registers that lie on the stack; of longer code they are allocated. A block is as many members as a tile
   has (core/ode/kernel/tiles.c). */
enum { ON_STACK = 2048, LARGEST_BLOCK = 248, IN_CACHE = 4096, LINE = 64 };

/* A few one by one: a wide load of numbers that were just stored one by one would have to wait for all of
   them. */
static inline void copy_each(double *to, size_t to_apart, const double *from, size_t from_apart, size_t count)
{
    enum { FEW = 64 };
    if (count > FEW && to_apart == 1 && from_apart == 1) {
        memcpy(to, from, count * sizeof *to);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        to[i * to_apart] = from[i * from_apart];
        __asm__ volatile("");
    }
}

static void one_state(const struct gm_tape *tape, const double *inputs, size_t inputs_apart, double *outputs,
                      size_t outputs_apart)
{
    double few[ON_STACK], *many = NULL, *r = few;
    if (tape->registers > ON_STACK) {
        r = many = malloc(tape->registers * sizeof *many);
    }
    if (!r) {
        for (size_t k = 0; k < tape->outputs; k++) {
            outputs[k * outputs_apart] = NAN;
        }
        return;
    }
    double *const constants = r + tape->inputs, *const results = constants + tape->constant_count;
    copy_each(r + tape->first_used, 1, inputs + tape->first_used * inputs_apart, inputs_apart,
              tape->last_used > tape->first_used ? tape->last_used - tape->first_used : 0);
    copy_each(constants, 1, tape->constants, 1, tape->constant_count);
    compute(tape, r);
    copy_each(outputs, outputs_apart, results, 1, tape->outputs);
    free(many);
}

void gm_tape_block(const struct gm_tape *tape, const double *inputs, size_t inputs_apart, double *outputs,
                   size_t outputs_apart, size_t m)
{
    if (tape->rolled) { /* rows are as long as a block's; rows of members would leave the cache */
        for (size_t i = 0; i < m; i++) {
            one_state(tape, inputs + i, inputs_apart, outputs + i, outputs_apart);
        }
        return;
    }
    const size_t fixed = tape->inputs + tape->constant_count + tape->outputs,
                 between = tape->registers - fixed;
    size_t block = between > 0 ? IN_CACHE / between / 8 * 8 : LARGEST_BLOCK;
    block = block < 8 ? 8 : block > LARGEST_BLOCK ? LARGEST_BLOCK : block;
    _Alignas(LINE) double few[IN_CACHE];
    double *few_rows[ON_STACK], *many = NULL, **many_rows = NULL;
    double *scratch = few, **at = few_rows;
    if (between * block > IN_CACHE || tape->registers > ON_STACK) {
        scratch = many = aligned_alloc(LINE, (between + 1) * block * sizeof *many);
        at = many_rows = malloc(tape->registers * sizeof *many_rows);
    }
    const bool short_of_memory = !scratch || !at;
    for (size_t k = 0; short_of_memory && k < tape->outputs; k++) {
        for (size_t i = 0; i < m; i++) {
            outputs[k * outputs_apart + i] = NAN;
        }
    }
    for (size_t first = 0; !short_of_memory && first < m; first += block) {
        double **next = at;
        for (size_t i = 0; i < tape->inputs; i++) {
            *next++ = (double *)inputs + i * inputs_apart + first; /* never written to */
        }
        for (size_t i = 0; i < tape->constant_count; i++) {
            *next++ = &tape->constants[i];
        }
        for (size_t i = 0; i < tape->outputs; i++) {
            *next++ = outputs + i * outputs_apart + first;
        }
        for (size_t i = 0; i < between; i++) {
            *next++ = scratch + i * block;
        }
        compute_rows(tape, at, m - first < block ? m - first : block);
    }
    free(many);
    free(many_rows);
}

void gm_tape_values(const struct gm_tape *tape, const double *inputs, double *outputs, size_t m)
{
    if (m == 1) {
        one_state(tape->rows ? tape->rows : tape, inputs, 1, outputs, 1);
    } else {
        gm_tape_block(tape, inputs, m, outputs, m, m);
    }
}
