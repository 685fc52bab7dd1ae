/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of formulas: one table of priorities and one recursive function, of bounded depth. */
#include "core/expression/reader.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
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

/* A call of a function of the text. */
struct call {
    struct gm_definition *definition;
    const struct call *caller;
    size_t first;    /* number of indices that are bound outside of the body */
    unsigned hidden; /* bit k: the caller does not see index k */
    struct argument {
        struct gm_span text; /* empty: an unknown number */
        gm_node_id node;
        bool read;
    } arguments[GM_MOST_ARGUMENTS];
};

struct reader {
    struct gm_formula *graph;
    struct gm_scope scope; /* scope, with the indices of loops */
    const char *text;
    size_t at, end;
    int depth, fixed;  /* depth in parentheses; in brackets and bounds */
    int64_t operands;  /* counted in units of 1 / OF_AN_INDEX */
    int bounds;        /* depth in bounds of loops */
    unsigned varying;  /* bit k: a bound uses index k, so the rounds of its loop differ */
    unsigned hidden;   /* bit k: index k is of a text around this one */
    struct call *call; /* the function whose body is read; NULL: none */
    jmp_buf leave;     /* out of the reading: it has a fault, or is out of memory */
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

_Noreturn __attribute__((format(printf, 3, 4))) static void fail(struct reader *reader, size_t offset,
                                                                 const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tell(reader->fault, offset, format, arguments);
    va_end(arguments);
    longjmp(reader->leave, 1);
}

__attribute__((format(printf, 4, 5))) static void fail_if(struct reader *reader, bool wrong, size_t offset,
                                                          const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (wrong) {
        tell(reader->fault, offset, format, arguments);
        longjmp(reader->leave, 1);
    }
    va_end(arguments);
}

static void need_graph(struct reader *reader)
{
    if (reader->graph->failed) {
        longjmp(reader->leave, 1);
    }
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
_Noreturn static void expected(struct reader *reader, const char *what)
{
    if (peek(reader) == '\0') {
        fail(reader, reader->at, "the formula ends where %s was expected", what);
    }
    const char *here = reader->text + reader->at;
    size_t length = 1;
    while (length < 4 && reader->at + length < reader->end && ((unsigned char)here[length] & 0xc0) == 0x80) {
        length++;
    }
    if (gm_text_valid(here, length) < length) {
        fail(reader, reader->at, "the byte 0x%02x is not text; %s was expected", (unsigned char)*here, what);
    }
    if ((unsigned char)*here < ' ') {
        fail(reader, reader->at, "the character 0x%02x has no meaning; %s was expected", (unsigned char)*here,
             what);
    }
    fail_if(reader, *here == '<' || *here == '>', reader->at,
            "a comparison is a condition, not a number; if(a %c b, 1, 0) is one", *here);
    fail(reader, reader->at, "%s was expected, not \"%.*s\"", what, (int)length, here);
}

/* Takes a sign that has to be there. */
static void need_sign(struct reader *reader, char sign, const char *what)
{
    if (!take(reader, sign)) {
        expected(reader, what);
    }
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
    static const char *const names[][2] = {{"arcsin", "asin"},   {"arccos", "acos"},       {"arctan", "atan"},
                                           {"arctan2", "atan2"}, {"fabs", "abs"},          {"tg", "tan"},
                                           {"sh", "sinh"},       {"ch", "cosh"},           {"th", "tanh"},
                                           {"pow", "^"},         {"log2", "log(x)/log(2)"}};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(word, names[i][0]) == 0) {
            return names[i][1];
        }
    }
    return NULL;
}

bool gm_is_random(const char *word)
{
    static const char *const words[] = {"noise", "wiener", "randn", "normal", "ran", "rand", "random"};
    size_t i = 0;
    while (i < sizeof words / sizeof *words && strcmp(words[i], word) != 0) {
        i++;
    }
    return i < sizeof words / sizeof *words;
}

_Noreturn static void unknown(struct reader *reader, size_t offset, const char *text, size_t length,
                              const char *what)
{
    size_t count = 0;
    while (candidate(count, reader)) {
        count++;
    }
    char word[64];
    snprintf(word, sizeof word, "%.*s", gm_brief_length(length), text);
    fail_if(reader, gm_is_random(word), offset, "%s", GM_NO_NOISE);
    const char *near = other_name(word);
    near = near ? near : gm_nearest(word, count, candidate, reader);
    fail(reader, offset, "there is no %s %s%s%.60s", what, word, near ? "; did you mean " : "",
         near ? near : "");
}

static bool is_word(const char *word, const char *text, size_t length)
{
    return gm_text_same(word, strlen(word), text, length);
}

static enum gm_operation function_of(const char *text, size_t length)
{
    for (enum gm_operation i = GM_OPERATION_SQRT; i < GM_OPERATIONS; i++) {
        if (is_word(gm_operation_rows[i].name, text, length)) {
            return i;
        }
    }
    if (is_word("ln", text, length)) {
        return GM_OPERATION_LOG;
    }
    return is_word("heav", text, length) ? GM_OPERATION_HEAVISIDE : GM_CONSTANT;
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
        expected(reader, "a number, a name or (");
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
    reader->graph->failed |= !copy;
    need_graph(reader);
    memcpy(copy, text + begin, at - begin);
    copy[at - begin] = '\0';
    const double value = strtod(copy, NULL);
    if (copy != brief) {
        free(copy);
    }
    fail_if(reader, isinf(value), begin, "%.*s is beyond the largest number, %.2g",
            (int)(at - begin < 30 ? at - begin : 30), text + begin, DBL_MAX);
    reader->at = at;
    const char next = at < reader->end ? text[at] : '\0';
    if (gm_is_letter(next)) {
        fail(reader, at,
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
    need_graph(reader);
    const double value = reader->graph->nodes[node].value;
    fail_if(reader, reader->graph->nodes[node].operation != GM_CONSTANT, begin,
            "%s holds whole numbers, indices of loops and parameters alone", what);
    fail_if(reader, value != floor(value), begin, "%s has to be a whole number, not %g", what, value);
    fail_if(reader, fabs(value) > GM_LARGEST_INDEX, begin, "%s lies between -%d and %d, and this is %g", what,
            GM_LARGEST_INDEX, GM_LARGEST_INDEX, value);
    return (long)value;
}

/* Moves to the parenthesis that closes the open one, or to a comma before it. */
static void skip(struct reader *reader, bool to_comma)
{
    for (int depth = 1; peek(reader) != '\0'; reader->at++) {
        const char next = reader->text[reader->at];
        depth += (next == '(') - (next == ')');
        if (depth == 0 || (to_comma && depth == 1 && next == ',')) {
            return;
        }
    }
}

static const struct gm_index *index_of(const struct reader *reader, const char *text, size_t length)
{
    for (size_t i = reader->scope.index_count; i-- > 0;) {
        const struct gm_index *index = &reader->scope.indices[i];
        if (!(reader->hidden & 1U << i) && gm_text_same(index->text, index->length, text, length)) {
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

/* The number of the argument of that name in the body that is read, or GM_MOST_ARGUMENTS. */
static size_t argument_of(const struct reader *reader, const char *text, size_t length)
{
    const struct gm_definition *definition = reader->call ? reader->call->definition : NULL;
    for (size_t i = 0; definition && i < definition->count; i++) {
        const struct gm_span name = definition->arguments[i];
        if (gm_text_same(reader->text + name.begin, name.end - name.begin, text, length)) {
            return i;
        }
    }
    return GM_MOST_ARGUMENTS;
}

struct loop {
    enum gm_operation operation;
    bool any; /* a term was read */
    gm_node_id value;
    size_t begin;
};

static void need_room_for(struct reader *reader, size_t place, int64_t operands)
{
    if (operands > (int64_t)MOST_OPERANDS * OF_AN_INDEX) {
        fail(reader, place,
             "the formula, with its loops and functions written out, has more than %d operands",
             MOST_OPERANDS);
    }
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
    fail_if(reader, scope->index_count == GM_MOST_INDICES, begin, "more than %d loops in each other",
            GM_MOST_INDICES);
    fail_if(reader,
            gm_formula_reserves(name.text, length) || index_of(reader, name.text, length) ||
                argument_of(reader, name.text, length) < GM_MOST_ARGUMENTS ||
                (scope->find && scope->find(scope->data, &name, &node, sentence) != GM_UNKNOWN),
            begin, "%.*s has a meaning already and cannot be the index of a loop", gm_brief_length(length),
            name.text);
    reader->at = begin + length;
    take(reader, '=');
    const long low = read_bound(reader);
    peek(reader);
    if (!is_range(reader, reader->at)) {
        expected(reader, "..");
    }
    reader->at += 2;
    const long high = read_bound(reader);
    need_sign(reader, ',', "a comma");
    const size_t body = reader->at;
    const int64_t before = reader->operands;
    const unsigned own = 1U << scope->index_count;
    reader->varying &= ~own;
    for (long value = low; value <= high; value++) {
        scope->indices[scope->index_count++] = (struct gm_index){name.text, length, value};
        reader->at = body;
        read_loop(reader, loop);
        scope->index_count--;
        if (value == low && !(reader->varying & own)) { /* all rounds have the length of the first */
            need_room_for(reader, begin,
                          reader->operands + ((int64_t)high - low) * (reader->operands - before));
        }
    }
    if (low > high) {
        skip(reader, false);
    }
}

static gm_node_id read_sum(struct reader *reader, size_t begin, bool is_sum)
{
    struct loop loop = {.operation = is_sum ? GM_OPERATION_ADD : GM_OPERATION_MULTIPLY, .begin = begin};
    if (!is_head(reader)) {
        expected(reader, "an index, as in sum(i = 1 .. 3, q[i]),");
    }
    read_loop(reader, &loop);
    need_sign(reader, ')', ")");
    return loop.any ? loop.value : gm_formula_constant(reader->graph, is_sum ? 0 : 1);
}

static gm_node_id read_condition(struct reader *reader);

/* 1 - a, for a condition */
static gm_node_id other_than(struct reader *reader, gm_node_id a)
{
    return gm_formula_apply(reader->graph, GM_OPERATION_SUBTRACT, gm_formula_constant(reader->graph, 1), a);
}

/* Takes a word of a condition. */
static bool take_word(struct reader *reader, const char *word)
{
    peek(reader);
    const size_t length = gm_name_length(reader->text + reader->at, reader->end - reader->at);
    const bool is_there = is_word(word, reader->text + reader->at, length);
    reader->at += is_there ? length : 0;
    return is_there;
}

/* True if the next parenthesis encloses a condition, not a part of a formula: nothing follows it that compares or
   computes. */
static bool is_enclosed(struct reader *reader)
{
    const size_t begin = reader->at++;
    skip(reader, false);
    reader->at += reader->at < reader->end;
    const char next = peek(reader);
    reader->at = begin;
    return next == '\0' || !strchr("<>=!+-*/^", next);
}

/* a < b, a <= b, a > b, a >= b; or another condition in parentheses */
static gm_node_id read_comparison(struct reader *reader)
{
    if (peek(reader) == '(' && is_enclosed(reader)) {
        reader->at++;
        const gm_node_id node = read_condition(reader);
        need_sign(reader, ')', ")");
        return node;
    }
    const gm_node_id left = read_expression(reader, 0);
    const char sign = peek(reader);
    const size_t place = reader->at;
    if (sign == '=' || sign == '!') {
        fail(reader, place, "equality of computed numbers is not a condition; %s",
             reader->scope.is_condition ? "compare by < or >" : "use an event");
    }
    fail_if(reader, sign != '<' && sign != '>', place,
            "a condition compares two values, as in x > 0: <, <=, > or >= was expected");
    reader->at++;
    const bool equal = reader->at < reader->end && reader->text[reader->at] == '=';
    reader->at += equal;
    const gm_node_id right = read_expression(reader, 0);
    if (peek(reader) == '<' || peek(reader) == '>') {
        fail(reader, reader->at, "a condition compares two values: write a < b and b < c");
    }
    const bool turned = (sign == '>') != equal; /* a <= b is not b < a */
    reader->graph->place = (uint32_t)place;
    const gm_node_id node =
        gm_formula_apply(reader->graph, GM_OPERATION_BELOW, turned ? right : left, turned ? left : right);
    return equal ? other_than(reader, node) : node;
}

/* Conditions with "and" between them, with "not" before each. */
static gm_node_id read_all(struct reader *reader)
{
    gm_node_id all = 0;
    bool first = true;
    do {
        const bool not = take_word(reader, "not");
        if (++reader->depth > DEEPEST) {
            fail(reader, reader->at, "parentheses, powers or signs are nested more than %d deep", DEEPEST);
        }
        const gm_node_id one = read_comparison(reader), node = not ? other_than(reader, one) : one;
        reader->depth--;
        all = first ? node : gm_formula_apply(reader->graph, GM_OPERATION_MULTIPLY, all, node);
        first = false;
    } while (take_word(reader, "and"));
    return all;
}

/* A condition, as a node that is 1 or 0: a and b is a*b, a or b is not (not a and not b). */
static gm_node_id read_condition(struct reader *reader)
{
    gm_node_id any = read_all(reader);
    while (take_word(reader, "or")) {
        const gm_node_id next = read_all(reader);
        any = other_than(reader, gm_formula_apply(reader->graph, GM_OPERATION_MULTIPLY,
                                                  other_than(reader, any), other_than(reader, next)));
    }
    return any;
}

/* condition, a, b): the sum of two parts, one of which is 0 */
static gm_node_id read_choice(struct reader *reader, size_t begin)
{
    gm_node_id parts[2] = {0, 0};
    const gm_node_id condition = read_condition(reader);
    for (int i = 0; i < 2; i++) {
        if (!take(reader, ',')) {
            fail(reader, reader->at, "if takes a condition and two values: if(x > 0, a, b)");
        }
        parts[i] = read_expression(reader, 0);
    }
    if (peek(reader) == ',') {
        fail(reader, reader->at, "if takes a condition and two values: if(x > 0, a, b)");
    }
    need_sign(reader, ')', ")");
    need_graph(reader);
    reader->graph->place = (uint32_t)begin;
    const gm_node_id other = other_than(reader, condition);
    if (reader->graph->nodes[condition].operation == GM_CONSTANT) {
        return parts[reader->graph->nodes[condition].value == 0];
    }
    return gm_formula_apply(reader->graph, GM_OPERATION_ADD,
                            gm_formula_apply(reader->graph, GM_OPERATION_CHOSEN, condition, parts[0]),
                            gm_formula_apply(reader->graph, GM_OPERATION_CHOSEN, other, parts[1]));
}

/* Takes the ) of a name that is called, and makes its node. */
static gm_node_id make_called(struct reader *reader, size_t begin, const struct gm_name *name,
                              const gm_node_id *operands, size_t count)
{
    char sentence[GM_FAULT_SENTENCE] = "";
    gm_node_id node = 0;
    need_sign(reader, ')', ")");
    reader->graph->place = (uint32_t)begin;
    if (reader->scope.call(reader->scope.data, name, operands, count, &node, sentence) != GM_KNOWN) {
        fail(reader, begin, "%s", sentence);
    }
    return node;
}

/* Reads the operands that follow the first `count` ones, and makes the node of a name that is called. */
static gm_node_id read_called(struct reader *reader, size_t begin, const struct gm_name *name,
                              gm_node_id *operands, size_t count)
{
    do {
        if (count == GM_MOST_OPERANDS) {
            expected(reader, ")");
        }
        operands[count++] = read_expression(reader, 0);
    } while (take(reader, ','));
    return make_called(reader, begin, name, operands, count);
}

/* Reads a first operand, NAME before a comma, that the scope takes as a word. Returns the number of operands read. */
static size_t read_word(struct reader *reader, const struct gm_name *called, gm_node_id *operands)
{
    const struct gm_scope *scope = &reader->scope;
    const size_t length =
        gm_is_letter(peek(reader)) ? gm_name_length(reader->text + reader->at, reader->end - reader->at) : 0;
    const struct gm_name word = {.text = reader->text + reader->at, .length = length};
    const size_t begin = reader->at;
    reader->at += length;
    if (length > 0 && peek(reader) == ',' && scope->word &&
        scope->word(scope->data, called, &word, operands)) {
        take(reader, ',');
        return 1;
    }
    reader->at = begin;
    return 0;
}

static gm_node_id read_call(struct reader *reader, size_t begin, enum gm_operation operation)
{
    if (operation == GM_OPERATION_CHOSEN) {
        return read_choice(reader, begin);
    }

    const struct gm_operation_row *row = &gm_operation_rows[operation];
    gm_node_id operands[2] = {0, 0};
    for (unsigned i = 0; i < row->arity; i++) {
        const struct gm_name name = {.text = row->name, .length = strlen(row->name)};
        if (i > 0 && peek(reader) == ')' && reader->scope.calls &&
            reader->scope.calls(reader->scope.data, &name)) { /* of one operand it is another function */
            return make_called(reader, begin, &name, operands, 1);
        }
        if (i > 0 && peek(reader) == ')') {
            fail(reader, reader->at, "%s takes two values", row->name);
        }
        if (i > 0) {
            need_sign(reader, ',', "a comma");
        }
        operands[i] = read_expression(reader, 0);
    }
    if (peek(reader) == ',') {
        fail(reader, reader->at, "%s takes %s", row->name, row->arity == 1 ? "one value" : "two values");
    }
    need_sign(reader, ')', ")");
    reader->graph->place = (uint32_t)begin;
    return gm_formula_apply(reader->graph, operation, operands[0], operands[1]);
}

/* Reads all of a span, a formula or a condition. */
static gm_node_id read_span(struct reader *reader, struct gm_span span, bool is_condition)
{
    const size_t at = reader->at, end = reader->end;
    reader->at = span.begin;
    reader->end = span.end;
    const gm_node_id node = is_condition ? read_condition(reader) : read_expression(reader, 0);
    need_graph(reader);
    const char next = peek(reader);
    if (next == '<' || next == '>') {
        fail(reader, reader->at, "a condition belongs in the first place of if( and in section:");
    } else if (next == '(' || next == '.' || gm_is_letter(next) || is_digit(next)) {
        fail(reader, reader->at, "there is no operator here; a product is written with *");
    } else if (next == ')') {
        fail(reader, reader->at, "this parenthesis was never opened");
    } else if (next != '\0') {
        expected(reader, "an operator");
    }
    reader->end = end;
    reader->at = at;
    return node;
}

/* Reads an argument of the body's call, where the caller wrote it: once, and again in each index. */
static gm_node_id read_argument(struct reader *reader, size_t number)
{
    struct call *call = reader->call;
    struct argument *argument = &call->arguments[number];
    if (argument->read && reader->fixed == 0) {
        return argument->node;
    }
    if (argument->text.begin == argument->text.end) {
        fail_if(reader, reader->fixed > 0, reader->at, "%s", "");
        return gm_formula_constant(reader->graph, NAN);
    }
    const unsigned hidden = reader->hidden;
    reader->call = (struct call *)call->caller;
    reader->hidden = call->hidden | (((1U << reader->scope.index_count) - 1) & ~((1U << call->first) - 1));
    const gm_node_id node = read_span(reader, argument->text, false);
    reader->hidden = hidden;
    reader->call = call;
    if (reader->fixed == 0) {
        argument->node = node;
        argument->read = true;
    }
    return node;
}

/* Reads the body of a call. */
static gm_node_id read_body(struct reader *reader, struct call *call)
{
    struct gm_definition *definition = call->definition;
    definition->called = true;
    reader->call = call;
    reader->hidden = (1U << call->first) - 1;
    const gm_node_id node = read_span(reader, definition->body, false);
    for (size_t i = 0; i < definition->count; i++) {
        read_argument(reader, i); /* an operand that the body does not use may have a fault */
    }
    reader->hidden = call->hidden;
    reader->call = (struct call *)call->caller;
    return node;
}

/* Returns how many operands the body of a function has at least: one, and those of the functions that it calls. */
static int64_t least_operands(struct reader *reader, struct gm_definition *definition, int depth)
{
    if (definition->least > 0 || depth > DEEPEST) {
        return definition->least > 0 ? definition->least : 1;
    }
    int64_t sum = definition->least =
        1; /* also while it is counted: a recursive function is refused elsewhere */
    for (size_t at = definition->body.begin, length; at < definition->body.end;
         at += length + (length == 0)) {
        length = gm_name_length(reader->text + at, definition->body.end - at);
        const char *after = reader->text + at + length;
        const size_t blanks = strspn(after, " \t");
        struct gm_definition *called =
            length > 0 && after[blanks] == '('
                ? reader->scope.definition(reader->scope.data, reader->text + at, length)
                : NULL;
        sum += called ? least_operands(reader, called, depth + 1) : 0;
        sum = sum > MOST_OPERANDS ? MOST_OPERANDS + 1 : sum;
    }
    definition->least = sum;
    return sum;
}

/* Reads the operands and ) of a call, then the body. */
static gm_node_id read_defined(struct reader *reader, size_t begin, struct gm_definition *definition)
{
    struct call call = {
        definition, reader->call, reader->scope.index_count, reader->hidden, {{{0, 0}, 0, false}}};
    const int length = (int)(definition->name.end - definition->name.begin);
    const char *name = reader->text + definition->name.begin;
    size_t count = 0;
    for (bool more = peek(reader) != ')'; more; more = take(reader, ',')) {
        peek(reader);
        const size_t operand = reader->at;
        skip(reader, true);
        if (operand == reader->at) {
            expected(reader, "a value");
        }
        if (count < GM_MOST_ARGUMENTS) {
            call.arguments[count].text = (struct gm_span){operand, reader->at};
        }
        count++;
    }
    need_sign(reader, ')', ")");
    fail_if(reader, count != definition->count, begin, "%.*s takes %zu argument%s, not %zu", length, name,
            definition->count, definition->count == 1 ? "" : "s", count);
    for (const struct call *caller = reader->call; caller; caller = caller->caller) {
        fail_if(reader, caller->definition == definition, begin, "%.*s is defined by itself", length, name);
    }
    need_room_for(reader, begin,
                  reader->operands +
                      least_operands(reader, definition, 0) * (reader->fixed > 0 ? 1 : OF_AN_INDEX));
    return read_body(reader, &call);
}

/* Takes (0), also as 0.0. */
static bool take_zero(struct reader *reader)
{
    const size_t begin = reader->at;
    char *end;
    if (take(reader, '(') && strchr("0.", peek(reader)) && strtod(reader->text + reader->at, &end) == 0) {
        reader->at = (size_t)(end - reader->text);
        if (take(reader, ')')) {
            return true;
        }
    }
    reader->at = begin;
    return false;
}

/* Refuses the parenthesis behind a name that is not a function. */
_Noreturn static void refuse_call(struct reader *reader, const struct gm_name *name)
{
    const size_t begin = reader->at++;
    const int brief = gm_brief_length(name->length);
    struct gm_name start = *name;
    gm_node_id node;
    char sentence[GM_FAULT_SENTENCE], *end;
    start.initial = true;
    if (!reader->scope.initial ||
        reader->scope.find(reader->scope.data, &start, &node, sentence) != GM_KNOWN) {
        fail(reader, begin, "%.*s is not a function; a product is written with *: %.*s*(", brief, name->text,
             brief, name->text);
    }
    peek(reader);
    const char *inside = reader->text + reader->at;
    skip(reader, false);
    size_t length = (size_t)(reader->text + reader->at - inside);
    while (length > 0 && inside[length - 1] == ' ') {
        length--;
    }
    const bool brief_too = length < 40 && !memchr(inside, '\n', length);
    const char *shown = brief_too ? inside : "...";
    strtod(inside, &end);
    bool timed = false;
    for (size_t i = 0; i < length; i++) {
        timed |= inside[i] == 't' && gm_name_length(inside + i, length - i) == 1 &&
                 (i == 0 || gm_name_length(inside + i - 1, 2) == 0);
    }
    fail_if(reader, end != inside + length && !timed, begin,
            "%.*s(%.*s): %.*s is not a function; a product is written with *: %.*s*(%.*s)", brief, name->text,
            brief_too ? (int)length : 3, shown, brief, name->text, brief, name->text,
            brief_too ? (int)length : 3, shown);
    fail(reader, begin,
         length > 0 && end == inside + length
             ? "%.*s(%.*s): only %.*s(0), the start, is known"
             : "%.*s(%.*s) is a delay; delay equations are not solved; a product is written with *: %.*s*(",
         brief, name->text, brief_too ? (int)length : 3, shown, brief, name->text);
}

static gm_node_id read_name(struct reader *reader, bool exact);

/* Reads (NAME) of exact(NAME). */
static gm_node_id read_exact(struct reader *reader)
{
    take(reader, '(');
    if (!gm_is_letter(peek(reader))) {
        expected(reader, "a component, as in exact(x),");
    }
    const gm_node_id node = read_name(reader, true);
    need_sign(reader, ')', ")");
    return node;
}

static gm_node_id read_name(struct reader *reader, bool exact)
{
    const size_t begin = reader->at, length = gm_name_length(reader->text + begin, reader->end - begin);
    struct gm_scope *scope = &reader->scope;
    struct gm_name name = {
        .text = reader->text + begin, .length = length, .fixed = reader->fixed > 0, .exact = exact};
    const int brief = gm_brief_length(length);
    reader->at += length;
    const bool called = peek(reader) == '(';
    gm_node_id operands[GM_MOST_OPERANDS];
    if (called && scope->calls && scope->calls(scope->data, &name) &&
        function_of(name.text, length) == GM_CONSTANT) {
        take(reader, '(');
        return read_called(reader, begin, &name, operands, read_word(reader, &name, operands));
    }
    const enum gm_operation function = function_of(name.text, length);
    const bool sum = is_word("sum", name.text, length), product = is_word("prod", name.text, length);
    const bool is_constant = is_word("pi", name.text, length) || index_of(reader, name.text, length);
    if (called && scope->exact && !exact && is_word("exact", name.text, length)) {
        return read_exact(reader);
    }
    if (exact && (sum || product || function != GM_CONSTANT || is_constant)) {
        fail(reader, begin, "%.*s is not a component: it has no exact solution", brief, name.text);
    }
    if (sum || product || (function != GM_CONSTANT && (function != GM_OPERATION_BELOW || scope->derives))) {
        if (!take(reader, '(')) {
            fail(reader, reader->at, "%.*s is a function: ( was expected", brief, name.text);
        }
        return sum || product ? read_sum(reader, begin, sum) : read_call(reader, begin, function);
    }
    struct gm_definition *definition =
        called && scope->definition ? scope->definition(scope->data, name.text, length) : NULL;
    if (definition && !exact && !index_of(reader, name.text, length)) {
        take(reader, '(');
        return read_defined(reader, begin, definition);
    }
    gm_node_id node = 0;
    const struct gm_index *index = index_of(reader, name.text, length);
    const size_t argument = index ? GM_MOST_ARGUMENTS : argument_of(reader, name.text, length);
    if (argument < GM_MOST_ARGUMENTS) {
        node = read_argument(reader, argument);
    } else if (index || is_word("pi", name.text, length)) {
        node = gm_formula_constant(reader->graph, index ? (double)index->value : M_PI);
        reader->varying |= index && reader->bounds > 0 ? 1U << (index - scope->indices) : 0;
    } else {
        const size_t after = reader->at;
        if (take(reader, '[')) {
            name.indexed = true;
            name.index = read_whole(reader, "an index");
            need_sign(reader, ']', "]");
        }
        name.initial = scope->initial && !exact && take_zero(reader);
        char sentence[GM_FAULT_SENTENCE] = "";
        reader->graph->place = (uint32_t)begin;
        const enum gm_meaning meaning =
            scope->find ? scope->find(scope->data, &name, &node, sentence) : GM_UNKNOWN;
        if (meaning == GM_UNKNOWN) {
            unknown(reader, begin, name.text, length, called && after == reader->at ? "function" : "name");
        }
        if (meaning != GM_KNOWN) {
            fail(reader, begin, "%s", sentence);
        }
    }
    if (peek(reader) == '(') {
        refuse_call(reader, &name);
    }
    return node;
}

static gm_node_id read_operand(struct reader *reader)
{
    const char next = peek(reader);
    reader->operands += reader->fixed > 0 ? 1 : OF_AN_INDEX;
    need_room_for(reader, reader->at, reader->operands);
    need_graph(reader);
    if (is_digit(next) || next == '.') {
        return read_number(reader);
    }
    if (gm_is_letter(next)) {
        return read_name(reader, false);
    }
    if (take(reader, '(')) {
        const gm_node_id node = read_expression(reader, 0);
        need_sign(reader, ')', ")");
        return node;
    }
    fail_if(reader, next == '*' && reader->at > 0 && reader->text[reader->at - 1] == '*', reader->at - 1,
            "a power is written with ^, not with **");
    expected(reader, "a number, a name or (");
}

/* Reads an operand with all operators of a priority above `limit`. */
static gm_node_id read_expression(struct reader *reader, int limit)
{
    const char first = peek(reader);
    const size_t begin = reader->at;
    struct gm_formula *graph = reader->graph;
    gm_node_id left = 0;
    if (++reader->depth > DEEPEST) {
        fail(reader, begin, "parentheses, powers or signs are nested more than %d deep", DEEPEST);
    }
    if (first == '-' || first == '+') {
        reader->at++;
        left = read_expression(reader, UNARY);
        graph->place = (uint32_t)begin;
        left = first == '-' ? gm_formula_apply(graph, GM_OPERATION_NEGATE, left, left) : left;
    } else {
        left = read_operand(reader);
    }
    for (size_t i = 0; i < sizeof operators / sizeof *operators;) {
        if (peek(reader) != operators[i].sign || operators[i].left <= limit) {
            i++;
            continue;
        }
        reader->at++;
        const gm_node_id right = read_expression(reader, operators[i].right);
        graph->place = (uint32_t)begin;
        left = gm_formula_apply(graph, operators[i].operation, left, right);
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
    const struct gm_span all = {begin, end};
    *fault = (struct gm_fault){.offset = begin};
    *node = 0;
    const bool whole = setjmp(reader.leave) == 0;
    if (whole) {
        *node = read_span(&reader, all, scope->is_condition);
    }
    graph->place = GM_NO_PLACE;
    return whole;
}

bool gm_formula_check(struct gm_formula *graph, const char *text, struct gm_definition *definition,
                      const struct gm_scope *scope, struct gm_fault *fault)
{
    struct reader reader = {.graph = graph, .scope = *scope, .text = text, .fault = fault};
    struct call call = {.definition = definition};
    *fault = (struct gm_fault){.offset = definition->body.begin};
    const bool whole = setjmp(reader.leave) == 0;
    if (whole) {
        read_body(&reader, &call);
    }
    graph->place = GM_NO_PLACE;
    return whole;
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
