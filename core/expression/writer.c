/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writer of formulas, as they are or tidied. */
#include "core/expression/writer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/number.h"
#include "core/expression/reader.h"
#include "core/functions/functions.h"

/* The priorities of nodes, as in the reader's table. */
enum { SUM = 10, PRODUCT = 11, SIGN = 12, RAISED = 14, WHOLE = 20 };

/* The texts of a notation around operands and between them. */
static const struct notation {
    const char *open, *close, *times, *raise, *raised, *negation, *conjunction, *disjunction, *choice;
} plain = {"(", ")", "*", "^", "", "not (", ") and (", ") or (", "if("}, latex = {"\\left(",
                                                                                  "\\right)",
                                                                                  "\\,",
                                                                                  "^{",
                                                                                  "}",
                                                                                  "\\neg\\left(",
                                                                                  "\\right) \\wedge \\left(",
                                                                                  "\\right) \\vee \\left(",
                                                                                  "\\operatorname{if}("};

struct writer {
    const struct gm_formula *graph;
    const struct gm_naming *naming;
    FILE *out;
    gm_node_id root;
    bool latex;
    const struct notation *notation;
};

static const char *name_of(const struct gm_naming *naming, gm_node_id node, gm_node_id root)
{
    return node != root && naming->part ? naming->part(node, naming->data) : NULL;
}

/* The number of operations and operands written for a node, at most SIZE_MAX; a named part below it counts as
   one. */
static size_t written_size(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming)
{
    size_t count = 0, size = SIZE_MAX;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    size_t *sizes = malloc((node + (size_t)1) * sizeof *sizes); /* [node], set for parts alone */
    for (size_t k = 0; parts && sizes && k < count; k++) {
        const struct gm_node *here = &graph->nodes[parts[k]];
        size = 1;
        if (here->operation > GM_VARIABLE && !name_of(naming, parts[k], node)) {
            const size_t b = gm_operation_rows[here->operation].arity == 2 ? sizes[here->b] : 0;
            const bool is_small = sizes[here->a] < SIZE_MAX / 4 && b < SIZE_MAX / 4;
            size = is_small ? 1 + sizes[here->a] + b : SIZE_MAX;
        }
        sizes[parts[k]] = size;
    }
    free(parts);
    free(sizes);
    return size;
}

/* True if a sum is a choice between two values; finds its part where the condition holds, and the other one. */
static bool is_choice(const struct writer *writer, const struct gm_node *here, const struct gm_node **chosen,
                      const struct gm_node **other)
{
    const struct gm_node *nodes = writer->graph->nodes;
    *chosen = &nodes[here->a];
    *other = &nodes[here->b];
    if ((*chosen)->operation != GM_OPERATION_CHOSEN || (*other)->operation != GM_OPERATION_CHOSEN) {
        return false;
    }
    const struct gm_node *first = &nodes[(*chosen)->a], *second = &nodes[(*other)->a];
    if (first->operation == GM_OPERATION_SUBTRACT && first->b == (*other)->a) {
        *chosen = &nodes[here->b];
        *other = &nodes[here->a];
        return true;
    }
    return second->operation == GM_OPERATION_SUBTRACT && second->b == (*chosen)->a;
}

/* True for a constant that is written as a product or a quotient, such as 2*pi. */
static bool is_compound(const struct writer *writer, gm_node_id node)
{
    const struct gm_node *here = &writer->graph->nodes[node];
    char text[64];
    return here->operation == GM_CONSTANT &&
           strpbrk(gm_number_format(here->value, text, sizeof text), "*/") != NULL;
}

static int priority_of(const struct writer *writer, gm_node_id node)
{
    const struct gm_node *here = &writer->graph->nodes[node];
    if (name_of(writer->naming, node, writer->root)) {
        return WHOLE;
    }
    const struct gm_node *chosen, *other;
    switch (here->operation) {
    case GM_CONSTANT:
        return signbit(here->value) ? SIGN : !writer->latex && is_compound(writer, node) ? PRODUCT : WHOLE;
    case GM_OPERATION_ADD:
        return is_choice(writer, here, &chosen, &other) ? WHOLE : SUM;
    case GM_OPERATION_SUBTRACT:
        return SUM;
    case GM_OPERATION_MULTIPLY:
        return PRODUCT;
    case GM_OPERATION_DIVIDE:
        return writer->latex ? WHOLE : PRODUCT;
    case GM_OPERATION_NEGATE:
        return SIGN;
    case GM_OPERATION_POWER:
    case GM_OPERATION_WHOLE_POWER:
        return RAISED;
    default:
        return WHOLE;
    }
}

/* True if the text begins with a minus. */
static bool leads_with_minus(const struct writer *writer, gm_node_id node)
{
    int priority = priority_of(writer, node);
    while ((priority == SUM || priority == PRODUCT) && writer->graph->nodes[node].operation != GM_CONSTANT) {
        node = writer->graph->nodes[node].a;
        const int inner = priority_of(writer, node);
        if (inner < priority) {
            return false;
        }
        priority = inner;
    }
    return priority == SIGN;
}

static void write_node(const struct writer *writer, gm_node_id node);

/* Writes two operands, and the texts around them; an operand GM_NO_NODE is not written. */
static void write_pair(const struct writer *writer, const char *before, gm_node_id a, const char *between,
                       gm_node_id b, const char *behind)
{
    fputs(before, writer->out);
    write_node(writer, a);
    fputs(between, writer->out);
    if (b != GM_NO_NODE) {
        write_node(writer, b);
    }
    fputs(behind, writer->out);
}

static void write_enclosed(const struct writer *writer, gm_node_id node, bool is_enclosed)
{
    write_pair(writer, is_enclosed ? writer->notation->open : "", node,
               is_enclosed ? writer->notation->close : "", GM_NO_NODE, "");
}

static void write_operand(const struct writer *writer, gm_node_id node, int limit, bool is_first)
{
    write_enclosed(writer, node,
                   priority_of(writer, node) < limit || (!is_first && leads_with_minus(writer, node)));
}

/* sums and products */
static void write_binary(const struct writer *writer, const struct gm_node *here, const char *sign,
                         int priority)
{
    write_operand(writer, here->a, priority, true);
    fputs(sign, writer->out);
    write_operand(writer, here->b, priority + 1, false);
}

static void write_power(const struct writer *writer, const struct gm_node *here)
{
    const bool simple =
        priority_of(writer, here->b) >= RAISED ||
        (writer->graph->nodes[here->b].operation == GM_CONSTANT && !is_compound(writer, here->b));
    /* a base that LaTeX writes as a fraction or a function needs parentheses */
    const bool is_leaf =
        name_of(writer->naming, here->a, writer->root) ||
        (writer->graph->nodes[here->a].operation <= GM_VARIABLE && !is_compound(writer, here->a));
    write_enclosed(writer, here->a, priority_of(writer, here->a) < WHOLE || (writer->latex && !is_leaf));
    fputs(writer->notation->raise, writer->out);
    write_enclosed(writer, here->b, !simple && !writer->latex);
    fputs(writer->notation->raised, writer->out);
}

static void write_condition(const struct writer *writer, gm_node_id node)
{
    const struct gm_node *nodes = writer->graph->nodes, *here = &nodes[node], *rest = here;
    const struct notation *notation = writer->notation;
    if (here->operation == GM_OPERATION_SUBTRACT && nodes[here->b].operation == GM_OPERATION_MULTIPLY) {
        rest = &nodes[here->b]; /* not (not a and not b) is a or b */
    }
    const bool either = rest != here && nodes[rest->a].operation == GM_OPERATION_SUBTRACT &&
                        nodes[rest->b].operation == GM_OPERATION_SUBTRACT;
    if (here->operation == GM_OPERATION_BELOW) {
        write_pair(writer, "", here->a, " < ", here->b, "");
    } else if (either || here->operation == GM_OPERATION_MULTIPLY) {
        fputs(notation->open, writer->out);
        write_condition(writer, either ? nodes[rest->a].b : here->a);
        fputs(either ? notation->disjunction : notation->conjunction, writer->out);
        write_condition(writer, either ? nodes[rest->b].b : here->b);
        fputs(notation->close, writer->out);
    } else if (here->operation == GM_OPERATION_SUBTRACT) { /* from 1 */
        fputs(notation->negation, writer->out);
        write_condition(writer, here->b);
        fputs(notation->close, writer->out);
    } else {
        write_pair(writer, "", node, " > 0", GM_NO_NODE, "");
    }
}

/* if(condition, a, b) */
static void write_choice(const struct writer *writer, const struct gm_node *chosen,
                         const struct gm_node *other)
{
    fputs(writer->notation->choice, writer->out);
    write_condition(writer, chosen->a);
    write_pair(writer, ", ", chosen->b, other ? ", " : ", 0", other ? other->b : GM_NO_NODE, ")");
}

static void write_call(const struct writer *writer, const struct gm_node *here)
{
    const struct gm_operation_row *row = &gm_operation_rows[here->operation];
    const gm_node_id b = row->arity == 2 ? here->b : GM_NO_NODE;
    if (here->operation ==
        GM_OPERATION_BELOW) { /* Iverson's bracket, in the derivative of |x|: 1 if true, else 0 */
        write_pair(writer, writer->latex ? "\\left[" : "if(", here->a, " < ", b,
                   writer->latex ? "\\right]" : ", 1, 0)");
        return;
    }
    const bool root = writer->latex && here->operation == GM_OPERATION_SQRT,
               bars = writer->latex && here->operation == GM_OPERATION_ABS;
    const char *close = root ? "}" : bars ? "\\right|" : writer->notation->close;
    fputs(writer->latex ? row->latex : row->name, writer->out);
    write_pair(writer,
               root   ? "{"
               : bars ? ""
                      : writer->notation->open,
               here->a, b != GM_NO_NODE ? ", " : "", b, close);
}

static void write_constant(const struct writer *writer, double value)
{
    char text[64];
    gm_number_format(value, text, sizeof text);
    const char *exponent = writer->latex ? strchr(text, 'e') : NULL;
    if (isinf(value)) {
        fputs(value > 0 ? "1e999" : "-1e999", writer->out);
    } else if (isnan(value)) {
        fputs("0/0", writer->out);
    } else if (exponent) {
        fprintf(writer->out, "%.*s \\cdot 10^{%s}", (int)(exponent - text), text, exponent + 1);
    } else if (writer->latex && strstr(text, "pi")) {
        const char *pi = strstr(text, "pi");
        const int before = (int)(pi - text);
        fprintf(writer->out, "%.*s\\pi{}%s", before > 0 && pi[-1] == '*' ? before - 1 : before, text, pi + 2);
    } else {
        fputs(text, writer->out);
    }
}

/* Writes a word of a name: a letter, a Greek one, one letter repeated as in derivatives, or upright. */
static void write_word(FILE *out, const char *word, size_t length)
{
    static const char greek[] =
        " alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi rho sigma "
        "tau upsilon phi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega ";
    char wanted[16];
    size_t same = 1;
    while (same < length && word[same] == word[0]) {
        same++;
    }
    if (length < 12) {
        snprintf(wanted, sizeof wanted, " %.*s ", (int)length, word);
    }
    if (length > 1 && length < 12 && strstr(greek, wanted)) {
        fprintf(out, "\\%.*s", (int)length, word);
    } else {
        fprintf(out, same < length && gm_is_letter(word[0]) ? "\\mathrm{%.*s}" : "%.*s", (int)length, word);
    }
}

static void write_name(FILE *out, const char *name)
{
    size_t length = strcspn(name, "_[");
    while (length > 1 && name[length - 1] >= '0' && name[length - 1] <= '9') {
        length--;
    }
    write_word(out, name, length);
    const char *rest = name + length;
    fputs(*rest ? "_{" : "", out);
    for (const char *comma = ""; *rest; comma = ",") {
        rest += strspn(rest, "_[]");
        const size_t word = strcspn(rest, "_[]");
        fputs(word ? comma : "", out);
        write_word(out, rest, word);
        rest += word;
    }
    fputs(name[length] ? "}" : "", out);
}

static void write_node(const struct writer *writer, gm_node_id node)
{
    const struct gm_node *here = &writer->graph->nodes[node];
    const char *name = name_of(writer->naming, node, writer->root);
    if (!name && here->operation == GM_VARIABLE) {
        name = writer->naming->variable(here->a, writer->naming->data);
    }
    if (name && writer->latex) {
        write_name(writer->out, name);
        return;
    }
    if (name) {
        fputs(name, writer->out);
        return;
    }
    const struct gm_node *chosen, *other;
    switch (here->operation) {
    case GM_CONSTANT:
        write_constant(writer, here->value);
        break;
    case GM_OPERATION_ADD:
        if (is_choice(writer, here, &chosen, &other)) {
            write_choice(writer, chosen, other);
        } else {
            write_binary(writer, here, " + ", SUM);
        }
        break;
    case GM_OPERATION_CHOSEN:
        write_choice(writer, here, NULL);
        break;
    case GM_OPERATION_SUBTRACT:
        write_binary(writer, here, " - ", SUM);
        break;
    case GM_OPERATION_MULTIPLY:
        write_binary(writer, here, writer->notation->times, PRODUCT);
        break;
    case GM_OPERATION_DIVIDE:
        if (writer->latex) {
            write_pair(writer, "\\frac{", here->a, "}{", here->b, "}");
        } else {
            write_binary(writer, here, "/", PRODUCT);
        }
        break;
    case GM_OPERATION_NEGATE:
        fputs("-", writer->out);
        write_operand(writer, here->a, PRODUCT, false);
        break;
    case GM_OPERATION_POWER:
    case GM_OPERATION_WHOLE_POWER:
        write_power(writer, here);
        break;
    default:
        write_call(writer, here);
    }
}

static char *text_of(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming,
                     bool is_latex)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = written_size(graph, node, naming) <= GM_LONGEST_FORMULA ? open_memstream(&text, &size) : NULL;
    if (!out) {
        return NULL;
    }
    write_node(&(struct writer){graph, naming, out, node, is_latex, is_latex ? &latex : &plain}, node);
    return fclose(out) == 0 ? text : NULL;
}

char *gm_formula_text(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming)
{
    return text_of(graph, node, naming, false);
}

char *gm_formula_latex(const struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming)
{
    return text_of(graph, node, naming, true);
}

char *gm_name_latex(const char *name)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) {
        return NULL;
    }
    write_name(out, name);
    return fclose(out) == 0 ? text : NULL;
}

/* ---- tidied formulas ---- */

/* From the leaves upwards: products by their factors, sums by their terms. */
enum { MOST = 32, MOST_VISITED = 4 * MOST, MOST_POWER = 64 };

struct tidying {
    struct gm_formula *graph;
    const struct gm_naming *naming;
    int visited; /* nodes visited in the current product or sum; one that is too long stays as it is */
};

/* above / below times the factors, each raised to halves / 2 */
struct product {
    double above, below;
    struct {
        gm_node_id base;
        long halves;
    } factors[MOST];
    size_t count;
};

struct sum {
    struct {
        gm_node_id node;
        bool minus;
    } terms[MOST];
    size_t count;
};

static bool is_named(const struct tidying *tidying, gm_node_id node)
{
    return tidying->naming->part && tidying->naming->part(node, tidying->naming->data);
}

static bool is_sum(const struct tidying *tidying, gm_node_id node)
{
    const enum gm_operation operation = tidying->graph->nodes[node].operation;
    return operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT;
}

static gm_node_id apply(const struct tidying *tidying, enum gm_operation operation, gm_node_id a,
                        gm_node_id b)
{
    return gm_formula_apply(tidying->graph, operation, a, b);
}

/* ---- products ---- */

/* Adds a factor, in the order of numbers, so that equal products are one node. False: too many. */
static bool add_factor(struct product *product, gm_node_id base, long halves)
{
    size_t i = 0;
    while (i < product->count && product->factors[i].base < base) {
        i++;
    }
    if (i < product->count && product->factors[i].base == base) {
        product->factors[i].halves += halves;
        return true;
    }
    if (product->count == MOST) {
        return false;
    }
    memmove(&product->factors[i + 1], &product->factors[i],
            (product->count++ - i) * sizeof product->factors[i]);
    product->factors[i].base = base;
    product->factors[i].halves = halves;
    return true;
}

/* Multiplies by the power halves / 2 of a tidy node. False: too long. */
static bool multiply(struct tidying *tidying, struct product *product, gm_node_id node, long halves)
{
    const struct gm_node here = tidying->graph->nodes[node];
    if (++tidying->visited > MOST_VISITED) {
        return false;
    }
    if (halves % 2 == 0 && here.operation == GM_OPERATION_SQRT) {
        return add_factor(product, here.a, halves / 2);
    }
    if (halves % 2 != 0 || labs(halves) > MOST_POWER || is_named(tidying, node)) {
        return add_factor(product, node, halves);
    }
    switch (here.operation) {
    case GM_CONSTANT:
        *(halves > 0 ? &product->above : &product->below) *= gm_pow(here.value, (double)labs(halves / 2));
        return true;
    case GM_OPERATION_NEGATE:
        product->above *= halves / 2 % 2 ? -1 : 1;
        return multiply(tidying, product, here.a, halves);
    case GM_OPERATION_MULTIPLY:
        return multiply(tidying, product, here.a, halves) && multiply(tidying, product, here.b, halves);
    case GM_OPERATION_DIVIDE:
        return multiply(tidying, product, here.a, halves) && multiply(tidying, product, here.b, -halves);
    case GM_OPERATION_POWER:
    case GM_OPERATION_WHOLE_POWER: {
        const struct gm_node exponent = tidying->graph->nodes[here.b];
        if (exponent.operation == GM_CONSTANT && exponent.value == floor(exponent.value) &&
            fabs(exponent.value) <= MOST_POWER) {
            return multiply(tidying, product, here.a, halves * (long)exponent.value);
        }
        return add_factor(product, node, halves);
    }
    default:
        return add_factor(product, node, halves);
    }
}

static gm_node_id times_power(const struct tidying *tidying, gm_node_id product, gm_node_id base,
                              long exponent)
{
    const gm_node_id number = gm_formula_constant(tidying->graph, (double)exponent);
    const gm_node_id power = exponent == 1 ? base : apply(tidying, GM_OPERATION_POWER, base, number);
    return product == GM_NO_NODE ? power : apply(tidying, GM_OPERATION_MULTIPLY, product, power);
}

/* Divides two numbers by their common divisor; 0.5 becomes 1 above 2. */
static void reduce(double *above, double *below)
{
    enum { PARTS = 1024 };
    double a = fabs(*above) * PARTS, b = fabs(*below) * PARTS;
    if (a != floor(a) || b != floor(b) || fmax(a, b) > 0x1p53) {
        return;
    }
    while (b > 0) {
        const double rest = fmod(a, b);
        a = b;
        b = rest;
    }
    *above *= PARTS / a;
    *below *= PARTS / a;
}

/* The node; GM_NO_NODE if its numbers are not finite. */
static gm_node_id written_product(const struct tidying *tidying, struct product *product)
{
    if (!isfinite(product->above) || !isfinite(product->below) || product->below == 0) {
        return GM_NO_NODE;
    }
    if (product->above == 0) {
        return gm_formula_constant(tidying->graph, 0);
    }
    reduce(&product->above, &product->below);
    const bool minus = (product->above < 0) != (product->below < 0);
    gm_node_id sides[2] = {GM_NO_NODE, GM_NO_NODE};
    const double numbers[2] = {fabs(product->above), fabs(product->below)};
    for (int side = 0; side < 2; side++) {
        if (numbers[side] != 1) {
            sides[side] = gm_formula_constant(tidying->graph, numbers[side]);
        }
        for (size_t i = 0; i < product->count; i++) {
            const gm_node_id base = product->factors[i].base;
            const long halves = side ? -product->factors[i].halves : product->factors[i].halves;
            const gm_node_id root = apply(tidying, GM_OPERATION_SQRT, base, base);
            const bool rooted = halves > 0 && is_named(tidying, root);
            if (halves > 1 && !rooted) {
                sides[side] = times_power(tidying, sides[side], base, halves / 2);
            }
            if (rooted || (halves > 0 && halves % 2)) {
                sides[side] = times_power(tidying, sides[side], root, rooted ? halves : 1);
            }
        }
    }
    gm_node_id node = sides[0] == GM_NO_NODE ? gm_formula_constant(tidying->graph, 1) : sides[0];
    node = sides[1] == GM_NO_NODE ? node : apply(tidying, GM_OPERATION_DIVIDE, node, sides[1]);
    return minus ? apply(tidying, GM_OPERATION_NEGATE, node, node) : node;
}

/* ---- sums ---- */

/* Adds the terms of a node; a term cancels an equal one with the other sign. False: too long. */
static bool add(struct tidying *tidying, struct sum *sum, gm_node_id node, bool minus)
{
    const struct gm_node here = tidying->graph->nodes[node];
    const bool named = is_named(tidying, node);
    if (++tidying->visited > MOST_VISITED || sum->count == MOST) {
        return false;
    }
    if (!named && is_sum(tidying, node)) {
        return add(tidying, sum, here.a, minus) &&
               add(tidying, sum, here.b, minus != (here.operation == GM_OPERATION_SUBTRACT));
    }
    if (!named && here.operation == GM_OPERATION_NEGATE) {
        return add(tidying, sum, here.a, !minus);
    }
    for (size_t i = 0; i < sum->count; i++) {
        if (sum->terms[i].node == node && sum->terms[i].minus != minus) {
            memmove(&sum->terms[i], &sum->terms[i + 1], (--sum->count - i) * sizeof sum->terms[i]);
            return true;
        }
    }
    if (named || !gm_is_constant(tidying->graph, node, 0)) {
        sum->terms[sum->count].node = node;
        sum->terms[sum->count++].minus = minus;
    }
    return true;
}

/* The node; it begins with a positive term, if there is one. */
static gm_node_id written_sum(const struct tidying *tidying, const struct sum *sum)
{
    size_t first = 0;
    while (first < sum->count && sum->terms[first].minus) {
        first++;
    }
    gm_node_id node = first < sum->count ? sum->terms[first].node : gm_formula_constant(tidying->graph, 0);
    for (size_t i = 0; i < sum->count; i++) {
        const gm_node_id term = sum->terms[i].node;
        if (i == 0 && first == sum->count) {
            node = apply(tidying, GM_OPERATION_NEGATE, term, term);
        } else if (i != first) {
            node = apply(tidying, sum->terms[i].minus ? GM_OPERATION_SUBTRACT : GM_OPERATION_ADD, node, term);
        }
    }
    return node;
}

/* ---- both ---- */

/* The node of a product. A derived sum among the factors is multiplied out: differentiation adds parentheses
   that were not typed. GM_NO_NODE: too long. */
static gm_node_id expanded(struct tidying *tidying, struct product *product)
{
    size_t at = 0;
    while (at < product->count &&
           (product->factors[at].halves != 2 || !is_sum(tidying, product->factors[at].base) ||
            is_named(tidying, product->factors[at].base) ||
            tidying->graph->places[product->factors[at].base] != GM_NO_PLACE)) {
        at++;
    }
    if (at == product->count) {
        return written_product(tidying, product);
    }
    struct sum sum = {.count = 0}, all = {.count = 0};
    tidying->visited = 0;
    if (!add(tidying, &sum, product->factors[at].base, false)) {
        return GM_NO_NODE;
    }
    product->factors[at].halves = 0;
    for (size_t i = 0; i < sum.count; i++) {
        struct product term = *product;
        tidying->visited = 0;
        const gm_node_id node =
            multiply(tidying, &term, sum.terms[i].node, 2) ? written_product(tidying, &term) : GM_NO_NODE;
        if (node == GM_NO_NODE || !add(tidying, &all, node, sum.terms[i].minus)) {
            return GM_NO_NODE;
        }
    }
    return written_sum(tidying, &all);
}

/* Tidies a node whose operands are tidy. */
static gm_node_id tidy(struct tidying *tidying, gm_node_id node)
{
    const struct gm_node here = tidying->graph->nodes[node];
    struct sum sum = {.count = 0};
    struct product product = {.above = 1, .below = 1};
    gm_node_id tidied = GM_NO_NODE;
    tidying->visited = 0;
    if (is_sum(tidying, node) || (here.operation == GM_OPERATION_NEGATE && is_sum(tidying, here.a))) {
        tidied = add(tidying, &sum, node, false) ? written_sum(tidying, &sum) : GM_NO_NODE;
    } else if (here.operation == GM_OPERATION_MULTIPLY || here.operation == GM_OPERATION_DIVIDE ||
               here.operation == GM_OPERATION_NEGATE || here.operation == GM_OPERATION_WHOLE_POWER) {
        tidied = multiply(tidying, &product, node, 2) ? expanded(tidying, &product) : GM_NO_NODE;
    }
    return tidied == GM_NO_NODE ? node : tidied;
}

gm_node_id gm_formula_tidied(struct gm_formula *graph, gm_node_id node, const struct gm_naming *naming)
{
    struct tidying tidying = {graph, naming, 0};
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, node, &count);
    gm_node_id *tidied = malloc((node + (size_t)1) * sizeof *tidied); /* [node], set for parts alone */
    graph->failed |= !parts || !tidied;
    for (size_t k = 0; k < count && !graph->failed; k++) {
        const gm_node_id part = parts[k];
        const struct gm_node here = graph->nodes[part];
        tidied[part] = part;
        if (here.operation > GM_VARIABLE && (part == node || !is_named(&tidying, part))) {
            const gm_node_id second = tidied[gm_second_operand(&here)];
            tidied[part] = tidy(&tidying, apply(&tidying, here.operation, tidied[here.a], second));
        }
    }
    node = graph->failed ? GM_NO_NODE : tidied[node];
    free(parts);
    free(tidied);
    return node;
}
