/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of formulas: one table of priorities and one recursive function, of bounded depth. */
#include "core/expression/reader.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/nearest.h"

enum {
    DEEPEST = 200,           /* nested parentheses */
    MOST_OPERANDS = 1 << 23, /* operands read; a loop counts its operands in every round */
    OF_AN_INDEX = 4,         /* operands of brackets and bounds that count as one */
    UNARY = 12               /* priority of minus before an operand */
};

/* Priorities of binary operators to the left and to the right; ^ binds to the right. */
static const struct {
    char sign;
    unsigned char left, right;
    enum gm_operation operation;
} operators[] = {
    {'+', 10, 10, GM_OPERATION_ADD},      {'-', 10, 10, GM_OPERATION_SUBTRACT},
    {'*', 11, 11, GM_OPERATION_MULTIPLY}, {'/', 11, 11, GM_OPERATION_DIVIDE},
    {'^', 14, 13, GM_OPERATION_POWER},
};

struct reader {
    struct gm_formula *graph;
    struct gm_scope scope; /* scope, with the indices of loops */
    const char *text;
    size_t at, end;
    int depth, fixed; /* depth in parentheses; in brackets and bounds */
    int64_t operands; /* counted in units of 1 / OF_AN_INDEX */
    int bounds;       /* depth in bounds of loops */
    unsigned varying; /* bit k: a bound uses index k, so the rounds of its loop differ */
    bool failed;
    struct gm_fault *fault;
};

static void tell(struct gm_fault *fault, size_t offset, const char *format, va_list arguments)
{
    vsnprintf(fault->sentence, sizeof fault->sentence, format, arguments);
    fault->offset = offset;
    fault->earlier = 0;
}

bool gm_fail(struct gm_fault *fault, size_t offset, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tell(fault, offset, format, arguments);
    va_end(arguments);
    return false;
}

bool gm_fail_first(struct gm_first_fault *first, size_t offset, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (!first->failed) {
        tell(first->fault, offset, format, arguments);
    }
    va_end(arguments);
    first->failed = true;
    return false;
}

bool gm_fail_memory(struct gm_first_fault *first)
{
    if (!first->failed) {
        *first->fault = (struct gm_fault){0};
    }
    first->failed = first->no_memory = true;
    return false;
}

__attribute__((format(printf, 3, 4))) static gm_node_id fail(struct reader *reader, size_t offset,
                                                             const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (!reader->failed) {
        tell(reader->fault, offset, format, arguments);
    }
    va_end(arguments);
    reader->failed = true;
    reader->at = reader->end;
    return 0;
}

bool gm_is_letter(char character)
{
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           character == '_';
}

static bool is_digit(char character)
{
    return character >= '0' && character <= '9';
}

size_t gm_name_length(const char *text, size_t length)
{
    size_t i = 0;
    while (i < length && (gm_is_letter(text[i]) || (i > 0 && is_digit(text[i])))) {
        i++;
    }
    return i;
}

bool gm_word_ends(const char *word, const char *ending)
{
    const size_t length = strlen(word), wanted = strlen(ending);
    return length > wanted && strcmp(word + length - wanted, ending) == 0;
}

/* The next character after blanks; '\0' at the end. */
static char peek(struct reader *reader)
{
    while (reader->at < reader->end) {
        const char next = reader->text[reader->at];
        if (next == '#' && reader->scope.lines) {
            const char *newline = memchr(reader->text + reader->at, '\n', reader->end - reader->at);
            reader->at = newline ? (size_t)(newline - reader->text) : reader->end;
        } else if (next == ' ' || next == '\t' || (reader->scope.lines && (next == '\n' || next == '\r'))) {
            reader->at++;
        } else {
            return next ? next : '\1';
        }
    }
    return '\0';
}

static bool take(struct reader *reader, char wanted)
{
    const bool is_there = peek(reader) == wanted;
    reader->at += is_there;
    return is_there;
}

static bool is_range(const struct reader *reader, size_t at)
{
    return at + 1 < reader->end && reader->text[at] == '.' && reader->text[at + 1] == '.';
}

/* Fails: `what` was expected at this place. */
static gm_node_id expected(struct reader *reader, const char *what)
{
    if (peek(reader) == '\0') {
        return fail(reader, reader->at, "the formula ends where %s was expected", what);
    }
    const char *here = reader->text + reader->at;
    size_t length = 1;
    while (length < 4 && reader->at + length < reader->end && ((unsigned char)here[length] & 0xc0) == 0x80) {
        length++;
    }
    if (gm_text_valid(here, length) < length) {
        return fail(reader, reader->at, "the byte 0x%02x is not text; %s was expected", (unsigned char)*here,
                    what);
    }
    if ((unsigned char)*here < ' ') {
        return fail(reader, reader->at, "the character 0x%02x has no meaning; %s was expected",
                    (unsigned char)*here, what);
    }
    return fail(reader, reader->at, "%s was expected, not \"%.*s\"", what, (int)length, here);
}

static const char *candidate(size_t i, const void *data)
{
    static const char *const words[] = {"pi", "sum", "prod"};
    const struct reader *reader = data;
    const size_t functions = GM_OPERATION_BELOW - GM_OPERATION_SQRT;
    if (i < functions) {
        return gm_operation_rows[GM_OPERATION_SQRT + i].name;
    }
    i -= functions;
    return i < 3 ? words[i] : reader->scope.known ? reader->scope.known(i - 3, reader->scope.data) : NULL;
}

/* The name of a function that has another one elsewhere, or NULL. */
static const char *other_name(const char *word)
{
    static const char *const names[][2] = {{"ln", "log"},
                                           {"arcsin", "asin"},
                                           {"arccos", "acos"},
                                           {"arctan", "atan"},
                                           {"arctan2", "atan2"},
                                           {"fabs", "abs"},
                                           {"tg", "tan"},
                                           {"sh", "sinh"},
                                           {"ch", "cosh"},
                                           {"th", "tanh"},
                                           {"pow", "^"},
                                           {"log10", "log(x)/log(10)"},
                                           {"log2", "log(x)/log(2)"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(word, names[i][0]) == 0) {
            return names[i][1];
        }
    }
    return NULL;
}

static gm_node_id unknown(struct reader *reader, size_t offset, const char *text, size_t length,
                          const char *what)
{
    size_t count = 0;
    while (candidate(count, reader)) {
        count++;
    }
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)(length < 60 ? length : 60), text);
    const char *near = other_name(word);
    near = near ? near : gm_nearest(word, count, candidate, reader);
    return fail(reader, offset, "there is no %s %s%s%.60s", what, word, near ? "; did you mean " : "",
                near ? near : "");
}

static bool is_word(const char *word, const char *text, size_t length)
{
    return strlen(word) == length && memcmp(word, text, length) == 0;
}

static enum gm_operation function_of(const char *text, size_t length)
{
    for (enum gm_operation i = GM_OPERATION_SQRT; i < GM_OPERATIONS; i++) {
        if (is_word(gm_operation_rows[i].name, text, length)) {
            return i;
        }
    }
    return GM_CONSTANT;
}

bool gm_formula_reserves(const char *text, size_t length)
{
    return function_of(text, length) != GM_CONSTANT || is_word("sum", text, length) ||
           is_word("prod", text, length) || is_word("pi", text, length);
}

static gm_node_id read_expression(struct reader *reader, int limit);

static gm_node_id read_number(struct reader *reader)
{
    const char *text = reader->text;
    const size_t begin = reader->at;
    size_t at = begin;
    while (at < reader->end && is_digit(text[at])) {
        at++;
    }
    if (at < reader->end && text[at] == '.' && !is_range(reader, at)) {
        at++;
        while (at < reader->end && is_digit(text[at])) {
            at++;
        }
    }
    if (at == begin + 1 && text[begin] == '.') {
        return expected(reader, "a number, a name or (");
    }
    if (at < reader->end && (text[at] == 'e' || text[at] == 'E')) {
        size_t digit = at + 1;
        digit += digit < reader->end && (text[digit] == '+' || text[digit] == '-');
        if (digit < reader->end && is_digit(text[digit])) {
            while (digit < reader->end && is_digit(text[digit])) {
                digit++;
            }
            at = digit;
        }
    }
    char brief[64], *copy = at - begin < sizeof brief ? brief : malloc(at - begin + 1);
    if (!copy) {
        reader->graph->failed = true;
        return 0;
    }
    memcpy(copy, text + begin, at - begin);
    copy[at - begin] = '\0';
    const double value = strtod(copy, NULL);
    if (copy != brief) {
        free(copy);
    }
    if (isinf(value)) {
        return fail(reader, begin, "%.*s is beyond the largest number, %.2g",
                    (int)(at - begin < 30 ? at - begin : 30), text + begin, DBL_MAX);
    }
    reader->at = at;
    const char next = at < reader->end ? text[at] : '\0';
    if (gm_is_letter(next)) {
        return fail(
            reader, at,
            "there is no operator between a number and a name; a product is written with *: %.*s*%.*s",
            (int)(at - begin < 30 ? at - begin : 30), text + begin,
            (int)gm_name_length(text + at, reader->end - at < 30 ? reader->end - at : 30), text + at);
    }
    const struct gm_scope *scope = &reader->scope;
    return scope->decimal ? scope->decimal(scope->data, text + begin, at - begin, value)
                          : gm_formula_constant(reader->graph, value);
}

/* Reads a whole number that is known while reading: an index, a bound of a loop. */
static long read_whole(struct reader *reader, const char *what)
{
    peek(reader);
    const size_t begin = reader->at;
    reader->fixed++;
    const gm_node_id node = read_expression(reader, 0);
    reader->fixed--;
    if (reader->failed || reader->graph->failed) {
        return 0;
    }
    const double value = reader->graph->nodes[node].value;
    if (reader->graph->nodes[node].operation != GM_CONSTANT) {
        fail(reader, begin, "%s holds whole numbers, indices of loops and parameters alone", what);
        return 0;
    }
    if (value != floor(value)) {
        fail(reader, begin, "%s has to be a whole number, not %g", what, value);
        return 0;
    }
    if (fabs(value) > GM_LARGEST_INDEX) {
        fail(reader, begin, "%s lies between -%d and %d, and this is %g", what, GM_LARGEST_INDEX,
             GM_LARGEST_INDEX, value);
        return 0;
    }
    return (long)value;
}

/* Moves to the closing parenthesis of a loop without rounds. */
static void skip_loop(struct reader *reader)
{
    int depth = 1;
    while (depth > 0 && peek(reader) != '\0') {
        const char next = reader->text[reader->at];
        depth += (next == '(') - (next == ')');
        reader->at += depth > 0;
    }
}

static const struct gm_index *index_of(const struct reader *reader, const char *text, size_t length)
{
    for (size_t i = reader->scope.index_count; i-- > 0;) {
        const struct gm_index *index = &reader->scope.indices[i];
        if (index->length == length && memcmp(index->text, text, length) == 0) {
            return index;
        }
    }
    return NULL;
}

/* True if the head of a loop, NAME =, follows. */
static bool is_head(struct reader *reader)
{
    peek(reader);
    const size_t begin = reader->at;
    reader->at += gm_name_length(reader->text + begin, reader->end - begin);
    const bool is_there = reader->at > begin && peek(reader) == '=';
    reader->at = begin;
    return is_there;
}

struct loop {
    enum gm_operation operation;
    bool any; /* a term was read */
    gm_node_id value;
    size_t begin;
};

static bool has_room_for(struct reader *reader, size_t place, int64_t operands)
{
    if (operands <= (int64_t)MOST_OPERANDS * OF_AN_INDEX) {
        return true;
    }
    fail(reader, place, "the formula, with its loops written out, has more than %d operands", MOST_OPERANDS);
    return false;
}

static long read_bound(struct reader *reader)
{
    reader->bounds++;
    const long bound = read_whole(reader, "a bound");
    reader->bounds--;
    return bound;
}

/* Reads i = low .. high, then another head, or the term. Afterwards `at` is at the parenthesis that closes
   the loop. The terms are joined from left to right. */
static void read_loop(struct reader *reader, struct loop *loop)
{
    struct gm_scope *scope = &reader->scope;
    if (!is_head(reader)) {
        const gm_node_id term = read_expression(reader, 0);
        reader->graph->place = (uint32_t)loop->begin;
        loop->value = loop->any ? gm_formula_apply(reader->graph, loop->operation, loop->value, term) : term;
        loop->any = true;
        return;
    }
    const size_t begin = reader->at, length = gm_name_length(reader->text + begin, reader->end - begin);
    const struct gm_name name = {.text = reader->text + begin, .length = length};
    gm_node_id node;
    char sentence[GM_FAULT_SENTENCE];
    if (scope->index_count == GM_MOST_INDICES) {
        fail(reader, begin, "more than %d loops in each other", GM_MOST_INDICES);
    } else if (gm_formula_reserves(name.text, length) || index_of(reader, name.text, length) ||
               (scope->find && scope->find(scope->data, &name, &node, sentence) != GM_UNKNOWN)) {
        fail(reader, begin, "%.*s has a meaning already and cannot be the index of a loop",
             (int)(length < 60 ? length : 60), name.text);
    }
    reader->at = reader->failed ? reader->end : begin + length;
    take(reader, '=');
    const long low = read_bound(reader);
    peek(reader);
    if (!reader->failed && !is_range(reader, reader->at)) {
        expected(reader, "..");
    }
    reader->at += reader->failed ? 0 : 2;
    const long high = read_bound(reader);
    if (!reader->failed && !take(reader, ',')) {
        expected(reader, "a comma");
    }
    const size_t body = reader->at;
    const int64_t before = reader->operands;
    const unsigned own = 1U << scope->index_count;
    reader->varying &= ~own;
    for (long value = low; value <= high && !reader->failed && !reader->graph->failed; value++) {
        scope->indices[scope->index_count++] = (struct gm_index){name.text, length, value};
        reader->at = body;
        read_loop(reader, loop);
        scope->index_count--;
        if (value == low && !(reader->varying & own)) { /* all rounds have the length of the first */
            has_room_for(reader, begin,
                         reader->operands + ((int64_t)high - low) * (reader->operands - before));
        }
    }
    if (low > high) {
        skip_loop(reader);
    }
}

static gm_node_id read_sum(struct reader *reader, size_t begin, bool is_sum)
{
    struct loop loop = {.operation = is_sum ? GM_OPERATION_ADD : GM_OPERATION_MULTIPLY, .begin = begin};
    if (!is_head(reader)) {
        return expected(reader, "an index, as in sum(i = 1 .. 3, q[i]),");
    }
    read_loop(reader, &loop);
    if (!reader->failed && !take(reader, ')')) {
        return expected(reader, ")");
    }
    return loop.any ? loop.value : gm_formula_constant(reader->graph, is_sum ? 0 : 1);
}

/* Reads the operands that follow the first `count` ones, and makes the node of a name that is called. */
static gm_node_id read_called(struct reader *reader, size_t begin, const struct gm_name *name,
                              gm_node_id *operands, size_t count)
{
    char sentence[GM_FAULT_SENTENCE] = "";
    gm_node_id node = 0;
    do {
        if (count == GM_MOST_OPERANDS) {
            return expected(reader, ")");
        }
        operands[count++] = read_expression(reader, 0);
    } while (!reader->failed && take(reader, ','));
    if (!reader->failed && !take(reader, ')')) {
        return expected(reader, ")");
    }
    reader->graph->place = (uint32_t)begin;
    if (!reader->failed &&
        reader->scope.call(reader->scope.data, name, operands, count, &node, sentence) != GM_KNOWN) {
        return fail(reader, begin, "%s", sentence);
    }
    return node;
}

static gm_node_id read_call(struct reader *reader, size_t begin, enum gm_operation operation)
{
    const struct gm_operation_row *row = &gm_operation_rows[operation];
    gm_node_id operands[2] = {0, 0};
    for (unsigned i = 0; i < row->arity && !reader->failed; i++) {
        const struct gm_name name = {.text = row->name, .length = strlen(row->name)};
        if (i > 0 && peek(reader) == ')' && reader->scope.calls &&
            reader->scope.calls(reader->scope.data, &name)) { /* of one operand it is another function */
            char sentence[GM_FAULT_SENTENCE] = "";
            gm_node_id node = 0;
            take(reader, ')');
            reader->graph->place = (uint32_t)begin;
            return reader->scope.call(reader->scope.data, &name, operands, 1, &node, sentence) == GM_KNOWN
                       ? node
                       : fail(reader, begin, "%s", sentence);
        }
        if (i > 0 && !take(reader, ',')) {
            return peek(reader) == ')' ? fail(reader, reader->at, "%s takes two values", row->name)
                                       : expected(reader, "a comma");
        }
        operands[i] = read_expression(reader, 0);
    }
    if (!reader->failed && !take(reader, ')')) {
        return peek(reader) == ',' ? fail(reader, reader->at, "%s takes %s", row->name,
                                          row->arity == 1 ? "one value" : "two values")
                                   : expected(reader, ")");
    }
    reader->graph->place = (uint32_t)begin;
    return gm_formula_apply(reader->graph, operation, operands[0], operands[1]);
}

/* True if the next parenthesis begins with the time t and has more. */
static bool is_at_time(const struct reader *reader)
{
    size_t at = reader->at + 1;
    while (at < reader->end && reader->text[at] == ' ') {
        at++;
    }
    if (gm_name_length(reader->text + at, reader->end - at) != 1 || reader->text[at] != 't') {
        return false;
    }
    return at + 1 < reader->end && reader->text[at + 1] != ')';
}

static gm_node_id read_name(struct reader *reader, bool exact);

/* Reads (NAME) of exact(NAME). */
static gm_node_id read_exact(struct reader *reader)
{
    take(reader, '(');
    if (!gm_is_letter(peek(reader))) {
        return expected(reader, "a component, as in exact(x),");
    }
    const gm_node_id node = read_name(reader, true);
    return reader->failed || take(reader, ')') ? node : expected(reader, ")");
}

static gm_node_id read_name(struct reader *reader, bool exact)
{
    const size_t begin = reader->at, length = gm_name_length(reader->text + begin, reader->end - begin);
    struct gm_scope *scope = &reader->scope;
    struct gm_name name = {
        .text = reader->text + begin, .length = length, .fixed = reader->fixed > 0, .exact = exact};
    const int brief = (int)(length < 60 ? length : 60);
    reader->at += length;
    const bool called = peek(reader) == '(';
    gm_node_id operands[GM_MOST_OPERANDS];
    if (called && scope->calls && scope->calls(scope->data, &name) &&
        function_of(name.text, length) == GM_CONSTANT) {
        take(reader, '(');
        return read_called(reader, begin, &name, operands, 0);
    }
    const enum gm_operation function = function_of(name.text, length);
    const bool sum = is_word("sum", name.text, length), product = is_word("prod", name.text, length);
    const bool is_constant = is_word("pi", name.text, length) || index_of(reader, name.text, length);
    if (called && scope->exact && !exact && is_word("exact", name.text, length)) {
        return read_exact(reader);
    }
    if (exact && (sum || product || function != GM_CONSTANT || is_constant)) {
        return fail(reader, begin, "%.*s is not a component: it has no exact solution", brief, name.text);
    }
    if (sum || product || (function != GM_CONSTANT && (function != GM_OPERATION_BELOW || scope->derives))) {
        if (!take(reader, '(')) {
            return fail(reader, reader->at, "%.*s is a function: ( was expected", brief, name.text);
        }
        return sum || product ? read_sum(reader, begin, sum) : read_call(reader, begin, function);
    }
    gm_node_id node = 0;
    const struct gm_index *index = index_of(reader, name.text, length);
    if (index || is_word("pi", name.text, length)) {
        node = gm_formula_constant(reader->graph, index ? (double)index->value : M_PI);
        reader->varying |= index && reader->bounds > 0 ? 1U << (index - scope->indices) : 0;
    } else {
        const size_t after = reader->at;
        if (take(reader, '[')) {
            name.indexed = true;
            name.index = read_whole(reader, "an index");
            if (!reader->failed && !take(reader, ']')) {
                return expected(reader, "]");
            }
        } else if (called && scope->initial && !exact && reader->at + 2 < reader->end &&
                   memcmp(reader->text + reader->at, "(0)", 3) == 0) {
            name.initial = true;
            reader->at += 3;
        }
        char sentence[GM_FAULT_SENTENCE] = "";
        reader->graph->place = (uint32_t)begin;
        const enum gm_meaning meaning = reader->failed ? GM_KNOWN
                                        : scope->find  ? scope->find(scope->data, &name, &node, sentence)
                                                       : GM_UNKNOWN;
        if (meaning == GM_UNKNOWN) {
            return unknown(reader, begin, name.text, length,
                           called && after == reader->at ? "function" : "name");
        }
        if (meaning != GM_KNOWN) {
            return fail(reader, begin, "%s", sentence);
        }
    }
    if (!reader->failed && peek(reader) == '(' && is_at_time(reader)) {
        return fail(reader, reader->at,
                    "%.*s(t...) is %.*s at another time: delays are not known; a product is written with *",
                    brief, name.text, brief, name.text);
    }
    if (!reader->failed && peek(reader) == '(') {
        return fail(reader, reader->at, "%.*s is not a function; a product is written with *: %.*s*(", brief,
                    name.text, brief, name.text);
    }
    return node;
}

static gm_node_id read_operand(struct reader *reader)
{
    const char next = peek(reader);
    reader->operands += reader->fixed > 0 ? 1 : OF_AN_INDEX;
    if (!has_room_for(reader, reader->at, reader->operands)) {
        return 0;
    }
    if (is_digit(next) || next == '.') {
        return read_number(reader);
    }
    if (gm_is_letter(next)) {
        return read_name(reader, false);
    }
    if (take(reader, '(')) {
        const gm_node_id node = read_expression(reader, 0);
        if (!reader->failed && !take(reader, ')')) {
            return expected(reader, ")");
        }
        return node;
    }
    if (next == '*' && reader->at > 0 && reader->text[reader->at - 1] == '*') {
        return fail(reader, reader->at - 1, "a power is written with ^, not with **");
    }
    return expected(reader, "a number, a name or (");
}

/* Reads an operand with all operators of a priority above `limit`. */
static gm_node_id read_expression(struct reader *reader, int limit)
{
    const char first = peek(reader);
    const size_t begin = reader->at;
    struct gm_formula *graph = reader->graph;
    gm_node_id left = 0;
    if (reader->failed || graph->failed) {
        return 0;
    }
    if (++reader->depth > DEEPEST) {
        fail(reader, begin, "parentheses, powers or signs are nested more than %d deep", DEEPEST);
    } else if (first == '-' || first == '+') {
        reader->at++;
        left = read_expression(reader, UNARY);
        graph->place = (uint32_t)begin;
        left =
            first == '-' && !reader->failed ? gm_formula_apply(graph, GM_OPERATION_NEGATE, left, left) : left;
    } else {
        left = read_operand(reader);
    }
    for (size_t i = 0; i < sizeof operators / sizeof *operators && !reader->failed && !graph->failed;) {
        if (peek(reader) != operators[i].sign || operators[i].left <= limit) {
            i++;
            continue;
        }
        reader->at++;
        const gm_node_id right = read_expression(reader, operators[i].right);
        graph->place = (uint32_t)begin;
        left = reader->failed ? 0 : gm_formula_apply(graph, operators[i].operation, left, right);
        i = 0;
    }
    reader->depth--;
    return left;
}

bool gm_formula_read(struct gm_formula *graph, const char *text, size_t begin, size_t end,
                     const struct gm_scope *scope, gm_node_id *node, struct gm_fault *fault)
{
    struct reader reader = {
        .graph = graph, .scope = *scope, .text = text, .at = begin, .end = end, .fault = fault};
    *fault = (struct gm_fault){.offset = begin};
    *node = read_expression(&reader, 0);
    if (!reader.failed && !graph->failed && peek(&reader) != '\0') {
        const char next = peek(&reader);
        if (next == '(' || next == '.' || gm_is_letter(next) || is_digit(next)) {
            fail(&reader, reader.at, "there is no operator here; a product is written with *");
        } else if (next == ')') {
            fail(&reader, reader.at, "this parenthesis was never opened");
        } else {
            expected(&reader, "an operator");
        }
    }
    graph->place = GM_NO_PLACE;
    return !reader.failed && !graph->failed;
}

size_t gm_text_valid(const char *text, size_t length)
{
    for (size_t i = 0; i < length;) {
        const unsigned char first = (unsigned char)text[i];
        const size_t more = first < 0x80   ? 0
                            : first < 0xc2 ? 9
                            : first < 0xe0 ? 1
                            : first < 0xf0 ? 2
                            : first < 0xf5 ? 3
                                           : 9;
        if (first == 0 || i + more >= length) {
            return i;
        }
        uint32_t character = more == 0 ? first : first & (0x3fu >> more);
        for (size_t k = 1; k <= more; k++) {
            if (((unsigned char)text[i + k] & 0xc0) != 0x80) {
                return i;
            }
            character = character << 6 | ((unsigned char)text[i + k] & 0x3f);
        }
        if ((more == 2 && (character < 0x800 || (character >= 0xd800 && character < 0xe000))) ||
            (more == 3 && (character < 0x10000 || character > 0x10ffff))) {
            return i;
        }
        i += more + 1;
    }
    return length;
}

bool gm_text_has_mark(const char *text, size_t length)
{
    return length >= GM_TEXT_MARK && memcmp(text, "\xef\xbb\xbf", GM_TEXT_MARK) == 0;
}

void gm_text_place(const char *text, size_t offset, size_t *line, size_t *column)
{
    *line = *column = 1;
    for (size_t i = gm_text_has_mark(text, offset) ? GM_TEXT_MARK : 0; i < offset; i++) {
        if (text[i] == '\n') {
            (*line)++;
            *column = 1;
        } else if (((unsigned char)text[i] & 0xc0) != 0x80) {
            (*column)++;
        }
    }
}
