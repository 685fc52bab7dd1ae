/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads schemes: lines or the segments of a word, then names, then coefficients, each twice: as doubles, by
   the operations that every formula has, and as balls, which know what was written. */
#include "core/model/written_scheme.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/nearest.h"
#include "core/expression/number.h"
#include "core/model/choices.h"

enum {
    ONE_TABLEAU = 1 << GM_WRITTEN_RUNGE_KUTTA | 1 << GM_WRITTEN_EXPLICIT,
    PARTITIONED = 1 << GM_WRITTEN_PARTITIONED,
    NYSTROM = 1 << GM_WRITTEN_NYSTROM,
    COMPOSITION = 1 << GM_WRITTEN_COMPOSITION,
    SPLITTING = 1 << GM_WRITTEN_SPLITTING,
    PROCESSED = 1 << GM_WRITTEN_PROCESSED,
    ADJOINT = 1 << GM_WRITTEN_ADJOINT,
    SPLIT = 1 << GM_WRITTEN_SPLIT,
    CALLED = 1 << GM_WRITTEN_CALLED,
    OF_PARTS = 1 << GM_WRITTEN_LIE | 1 << GM_WRITTEN_STRANG | SPLIT | CALLED,
    PROJECTED = 1 << GM_WRITTEN_PROJECTED,
    HOLDING = PROJECTED | 1 << GM_WRITTEN_RELAXED,
    TABLEAUS = ONE_TABLEAU | PARTITIONED | NYSTROM,
    ANY = TABLEAUS | COMPOSITION | SPLITTING | PROCESSED | ADJOINT | OF_PARTS | HOLDING
};

static const struct gm_line_word words[GM_SCHEME_WORDS] = {
#define GM_SCHEME_WORD(constant, word, holds, kinds) {word, GM_LINE_ADDED, kinds},
#include "core/model/written_scheme.def"
#undef GM_SCHEME_WORD
};
static const struct gm_line_words lines_of_schemes = {"a scheme", words, GM_SCHEME_WORDS,
                                                      "; docs/own-schemes.md names them", 0};
static const enum {
    TEXT,
    NAMED,
    ROW,
    MATRIX,
    SCHEME
} holds[GM_SCHEME_WORDS] = {
#define GM_SCHEME_WORD(constant, word, holds, kinds) holds,
#include "core/model/written_scheme.def"
#undef GM_SCHEME_WORD
};

enum { LONGEST_POSITIONAL = 4 };

/* The lines that a word's parentheses give by their order, without a name. The first `required` must be given. */
static const struct {
    const char *name;
    int required, count;
    enum gm_scheme_word positional[LONGEST_POSITIONAL];
} kinds[GM_WRITTEN_KINDS] = {
    [GM_WRITTEN_RUNGE_KUTTA] = {"runge-kutta", 2, 3, {GM_SCHEME_WORD_A, GM_SCHEME_WORD_B, GM_SCHEME_WORD_C}},
    [GM_WRITTEN_EXPLICIT] = {"explicit", 2, 3, {GM_SCHEME_WORD_A, GM_SCHEME_WORD_B, GM_SCHEME_WORD_C}},
    [GM_WRITTEN_PARTITIONED] = {"partitioned",
                                3,
                                4,
                                {GM_SCHEME_WORD_A, GM_SCHEME_WORD_B, GM_SCHEME_WORD_AH, GM_SCHEME_WORD_BH}},
    [GM_WRITTEN_NYSTROM] = {"nystrom",
                            4,
                            4,
                            {GM_SCHEME_WORD_A, GM_SCHEME_WORD_B, GM_SCHEME_WORD_BV, GM_SCHEME_WORD_C}},
    [GM_WRITTEN_COMPOSITION] = {"composition", 2, 2, {GM_SCHEME_WORD_BASE, GM_SCHEME_WORD_STEPS}},
    [GM_WRITTEN_SPLITTING] = {"splitting", 2, 2, {GM_SCHEME_WORD_DRIFTS, GM_SCHEME_WORD_KICKS}},
    [GM_WRITTEN_PROCESSED] = {"processed", 2, 2, {GM_SCHEME_WORD_KERNEL, GM_SCHEME_WORD_PROCESSOR}},
    [GM_WRITTEN_ADJOINT] = {"adjoint", 1, 1, {GM_SCHEME_WORD_BASE}},
    [GM_WRITTEN_PROJECTED] = {"projected", 2, 2, {GM_SCHEME_WORD_BASE, GM_SCHEME_WORD_INVARIANTS}},
    [GM_WRITTEN_RELAXED] = {"relaxed", 2, 2, {GM_SCHEME_WORD_BASE, GM_SCHEME_WORD_INVARIANTS}},
    [GM_WRITTEN_LIE] = {"lie", 1, 1, {GM_SCHEME_WORD_PARTS}},
    [GM_WRITTEN_STRANG] = {"strang", 1, 1, {GM_SCHEME_WORD_PARTS}},
    [GM_WRITTEN_SPLIT] = {"split", 2, 2, {GM_SCHEME_WORD_PARTS, GM_SCHEME_WORD_STEPS}},
    [GM_WRITTEN_CALLED] = {"called", 2, 2, {GM_SCHEME_WORD_PARTS, GM_SCHEME_WORD_BASE}},
};

/* A number, or a let, before it is computed. */
struct formula {
    gm_node_id node;
    struct gm_span name, value; /* the name is that of a let */
    bool read;
};

/* The body of the scheme's arena, which a fault leaves; the sentence is empty when out of memory. */
struct reading {
    struct gm_written_scheme *scheme;
    struct gm_arena *arena; /* the scheme's */
    const char *text;
    struct gm_span span;
    struct gm_formula graph;
    struct gm_written_number *decimals; /* the graph's variables */
    size_t decimal_count;
    struct gm_decimals *gathered; /* or NULL */
    bool sums;                    /* what is read are the sums of rows */
    struct formula lets[GM_MOST_LETS];
    char let_names[GM_MOST_LETS][64];
    gm_node_id *nodes[GM_SCHEME_WORDS]; /* of each line's numbers */
    struct gm_fault *fault;
};

_Noreturn static void leave(const struct reading *reading, size_t place, const char *format,
                            va_list arguments)
{
    vsnprintf(reading->fault->sentence, sizeof reading->fault->sentence, format, arguments);
    reading->fault->offset = place;
    gm_arena_leave(reading->arena);
}

_Noreturn __attribute__((format(printf, 3, 4))) static void fail(const struct reading *reading, size_t place,
                                                                 const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    leave(reading, place, format, arguments);
}

__attribute__((format(printf, 4, 5))) static void fail_if(const struct reading *reading, bool wrong,
                                                          size_t place, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (wrong) {
        leave(reading, place, format, arguments);
    }
    va_end(arguments);
}

static int brief(struct gm_span span)
{
    const size_t length = span.end - span.begin;
    return (int)(length < 40 ? length : 40);
}

/* ---- words and lines ---- */

const char *gm_written_kind_name(enum gm_written_kind kind)
{
    return kinds[kind].name;
}

/* Returns GM_WRITTEN_KINDS if no kind has that name. */
static enum gm_written_kind kind_of(const char *text, size_t length)
{
    enum gm_written_kind kind = 0;
    while (kind < GM_WRITTEN_KINDS && !gm_span_is(text, (struct gm_span){0, length}, kinds[kind].name)) {
        kind++;
    }
    return kind;
}

bool gm_written_is_kind(const char *name)
{
    return kind_of(name, strlen(name)) < GM_WRITTEN_KINDS;
}

size_t gm_written_word_name(const char *text, size_t length)
{
    size_t end = 0;
    while (end < length && (isalnum((unsigned char)text[end]) || (text[end] && strchr("-_./", text[end])))) {
        end++;
    }
    return end < length && text[end] == '(' ? end : 0;
}

static const char *kind_name(size_t i, const void *data)
{
    return (void)data, kinds[i].name;
}

static void take_line(struct reading *reading, enum gm_scheme_word word, size_t place, struct gm_span value)
{
    struct gm_written_scheme *scheme = reading->scheme;
    const char *comment =
        holds[word] == TEXT ? memchr(reading->text + value.begin, '#', value.end - value.begin) : NULL;
    if (comment) {
        value =
            gm_span_trimmed(reading->text, (struct gm_span){value.begin, (size_t)(comment - reading->text)});
    }
    if (word == GM_SCHEME_WORD_LET) {
        fail_if(reading, scheme->let_count == GM_MOST_LETS, place, "a scheme has at most %d lets",
                GM_MOST_LETS);
        scheme->lets[scheme->let_count++] = value;
        return;
    }
    fail_if(reading, scheme->lines[word].said, place, "%s: is given twice", words[word].word);
    scheme->lines[word] = (struct gm_written_line){.said = true, .value = value};
}

static void find_kind(struct reading *reading, struct gm_span name)
{
    const char *text = reading->text + name.begin;
    reading->scheme->kind = kind_of(text, name.end - name.begin);
    if (reading->scheme->kind < GM_WRITTEN_KINDS) {
        return;
    }
    char copy[41];
    snprintf(copy, sizeof copy, "%.*s", brief(name), text);
    const char *near = gm_nearest(copy, GM_WRITTEN_KINDS, kind_name, NULL);
    fail(reading, name.begin, "there is no kind of schemes \"%s\"%s%s", copy,
         near ? "; did you mean "
              : "; there are runge-kutta, explicit, partitioned, nystrom, "
                "composition, splitting, processed, adjoint, projected, relaxed, lie, strang, split",
         near ? near : "");
}

static void read_file(struct reading *reading, struct gm_span span)
{
    struct gm_read_lines lines = {.arena = reading->arena,
                                  .fault = reading->fault,
                                  .words = &lines_of_schemes,
                                  .text = reading->text,
                                  .span = span};
    gm_lines_read(&lines);
    for (size_t i = 0; i < lines.count; i++) {
        take_line(reading, (enum gm_scheme_word)lines.list[i].word, lines.list[i].place, lines.list[i].value);
    }
    const struct gm_written_line *kind = &reading->scheme->lines[GM_SCHEME_WORD_KIND];
    fail_if(reading, !kind->said, span.begin, "what kind of scheme is it? It needs a line kind:");
    find_kind(reading, kind->value);
}

/* Returns the position of the parenthesis that closes the one at span.begin, or the end. */
static size_t closing(const char *text, struct gm_span span)
{
    int depth = 0;
    size_t at = span.begin;
    do {
        depth += (text[at] == '(') - (text[at] == ')');
        at++;
    } while (at < span.end && depth > 0);
    return depth == 0 ? at - 1 : span.end;
}

static void read_word(struct reading *reading, struct gm_span span)
{
    const char *text = reading->text;
    const size_t open = span.begin + gm_written_word_name(text + span.begin, span.end - span.begin);
    const size_t close = closing(text, (struct gm_span){open, span.end});
    fail_if(reading, close == span.end, open, "this parenthesis is not closed");
    fail_if(reading, close + 1 < span.end, close + 1, "the scheme ends before this");
    struct gm_span rest = {open + 1, close}, segment;
    int positional = 0;
    reading->scheme->kind = kind_of(text + span.begin, open - span.begin);
    const bool called = reading->scheme->kind == GM_WRITTEN_KINDS; /* by its name, which is the base */
    if (called) {
        reading->scheme->kind = GM_WRITTEN_CALLED;
        take_line(reading, GM_SCHEME_WORD_BASE, span.begin, (struct gm_span){span.begin, open});
    }
    while (gm_span_take(text, &rest, ";", &segment)) {
        const size_t name = gm_name_length(text + segment.begin, segment.end - segment.begin);
        const size_t colon = segment.begin + name;
        if (name > 0 && colon < segment.end && text[colon] == ':') {
            const struct gm_text_line line = {
                {segment.begin, colon}, gm_span_trimmed(text, (struct gm_span){colon + 1, segment.end})};
            size_t word;
            gm_arena_need(reading->arena,
                          gm_line_find(&lines_of_schemes, text, &line, &word, reading->fault));
            take_line(reading, (enum gm_scheme_word)word, segment.begin, line.value);
        } else if (positional < (called ? 1 : kinds[reading->scheme->kind].count)) {
            take_line(reading, kinds[reading->scheme->kind].positional[positional++], segment.begin, segment);
        } else {
            fail(reading, segment.begin, "there is more between the parentheses than %.*s has",
                 (int)(open - span.begin), text + span.begin);
        }
    }
    const struct gm_written_line *kind = &reading->scheme->lines[GM_SCHEME_WORD_KIND];
    fail_if(reading,
            kind->said && kind_of(text + kind->value.begin, kind->value.end - kind->value.begin) !=
                              reading->scheme->kind,
            kind->value.begin, "the word says that it is of the kind %s", kinds[reading->scheme->kind].name);
}

/* Checks that every given line belongs to the kind, and that the lines it needs are given. */
static void check_lines(const struct reading *reading)
{
    const struct gm_written_scheme *scheme = reading->scheme;
    const char *name = kinds[scheme->kind].name;
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        fail_if(reading, scheme->lines[word].said && !(words[word].kinds >> scheme->kind & 1),
                scheme->lines[word].value.begin, "a scheme of the kind %s has no %s:", name,
                words[word].word);
    }
    const struct gm_span base = scheme->lines[GM_SCHEME_WORD_BASE].value;
    fail_if(reading, scheme->kind == GM_WRITTEN_CALLED && !scheme->lines[GM_SCHEME_WORD_PARTS].said,
            base.begin,
            "%.*s() names no parts; a splitting takes those of a system, as in aba864(kinetic, potential)",
            brief(base), reading->text + base.begin);
    for (int i = 0; i < kinds[scheme->kind].required; i++) {
        const enum gm_scheme_word word = kinds[scheme->kind].positional[i];
        fail_if(reading, !scheme->lines[word].said, reading->span.begin,
                i == 0 ? "a scheme of the kind %s needs %s:"
                       : "a scheme of the kind %s needs %s:, after a semicolon",
                name, words[word].word);
    }
}

/* ---- numbers ---- */

/* Puts it behind the others, of which there are *count and which are the caller's. */
static void gather(struct reading *reading, struct gm_decimal **all, size_t *count, struct gm_decimal decimal)
{
    struct gm_decimal *more = realloc(*all, (*count + 1) * sizeof *more);
    gm_arena_need(reading->arena, more);
    *all = more;
    more[(*count)++] = decimal;
}

/* The decimal of the whole text, or the value that replaces it. */
static struct gm_written_number known_decimal(struct reading *reading, const char *text, size_t length,
                                              double value)
{
    struct gm_written_number number = {.value = value, .ball = gm_ball_decimal(text, length, value)};
    struct gm_decimals *gathered = reading->gathered;
    const size_t place = (size_t)(text - reading->text);
    size_t i = 0;
    if (!gathered || number.ball.radius == 0 || reading->sums) {
        return number;
    }
    while (i < gathered->count && gathered->at[i].place != place) {
        i++;
    }
    if (gathered->instead && i < gathered->count) {
        number.ball = gathered->instead[i];
        number.value = gm_ball_midpoint(number.ball);
    } else if (i == gathered->count) {
        gather(reading, &gathered->at, &gathered->count, (struct gm_decimal){place, length, number.ball});
    }
    return number;
}

static gm_node_id decimal(void *data, const char *text, size_t length, double value)
{
    struct reading *reading = data;
    const bool whole = strcspn(text, ".eE") >= length;
    if (whole && value < 1e15) {
        return gm_formula_constant(&reading->graph, value);
    }
    fail_if(reading, whole && length > GM_BALL_DIGITS, (size_t)(text - reading->text),
            "a whole number has at most %d digits", GM_BALL_DIGITS);
    const size_t count = reading->decimal_count;
    reading->decimals = gm_arena_grown(reading->arena, reading->decimals, count, sizeof *reading->decimals);
    reading->decimals[count] = known_decimal(reading, text, length, value);
    reading->decimal_count++;
    return gm_formula_variable(&reading->graph, count);
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    const struct reading *reading = data;
    for (int i = 0; i < reading->scheme->let_count; i++) {
        const struct formula *let = &reading->lets[i];
        if (gm_text_same(reading->text + let->name.begin, let->name.end - let->name.begin, name->text,
                         name->length)) {
            *node = let->node;
            if (name->indexed) {
                snprintf(sentence, GM_FAULT_SENTENCE, "%s is not a list", reading->let_names[i]);
                return GM_REFUSED;
            }
            return let->read ? GM_KNOWN : GM_POSTPONED;
        }
    }
    return GM_UNKNOWN;
}

static const char *known(size_t i, const void *data)
{
    const struct reading *reading = data;
    return i < (size_t)reading->scheme->let_count ? reading->let_names[i] : NULL;
}

/* Returns false if a let has to be read before. */
static bool read_formula(struct reading *reading, struct gm_span span, gm_node_id *node)
{
    const struct gm_scope scope = {
        .find = find, .known = known, .decimal = decimal, .data = reading, .lines = true};
    const bool complete =
        gm_formula_read(&reading->graph, reading->text, span.begin, span.end, &scope, node, reading->fault);
    gm_arena_need(reading->arena, complete || (!reading->graph.failed && !reading->fault->sentence[0]));
    return complete;
}

static void name_let(struct reading *reading, int i)
{
    const struct gm_span span = reading->scheme->lets[i];
    const char *text = reading->text;
    struct formula *let = &reading->lets[i];
    const size_t length = gm_name_length(text + span.begin, span.end - span.begin);
    let->name = (struct gm_span){span.begin, span.begin + length};
    const struct gm_span rest = gm_span_trimmed(text, (struct gm_span){let->name.end, span.end});
    fail_if(reading, length == 0 || rest.begin == rest.end || text[rest.begin] != '=',
            length ? rest.begin : span.begin, "a let is a name, = and a formula");
    fail_if(reading, length >= sizeof reading->let_names[0] || gm_formula_reserves(text + span.begin, length),
            span.begin, "the name %.*s is %s", brief(let->name), text + span.begin,
            length >= sizeof reading->let_names[0] ? "too long" : "reserved");
    memcpy(reading->let_names[i], text + span.begin, length);
    for (int k = 0; k < i; k++) {
        fail_if(reading, strcmp(reading->let_names[k], reading->let_names[i]) == 0, span.begin,
                "%s is defined twice", reading->let_names[i]);
    }
    let->value = gm_span_trimmed(text, (struct gm_span){rest.begin + 1, rest.end});
}

/* Reads the lines `let:`, which are in any order: first those that need no other one. */
static void read_lets(struct reading *reading)
{
    const int count = reading->scheme->let_count;
    for (int i = 0; i < count; i++) {
        name_let(reading, i);
    }
    for (bool again = true; again;) {
        again = false;
        for (int i = 0; i < count; i++) {
            struct formula *let = &reading->lets[i];
            if (!let->read) {
                let->read = read_formula(reading, let->value, &let->node);
                again = again || let->read;
            }
        }
    }
    for (int i = 0; i < count; i++) {
        fail_if(reading, !reading->lets[i].read, reading->lets[i].name.begin,
                "%s is defined by itself, through other lets", reading->let_names[i]);
    }
}

/* Takes the piece before the next separator, which another piece must follow. Returns false at the end. */
static bool take_piece(const struct reading *reading, struct gm_span *rest, const char *separator,
                       struct gm_span *piece)
{
    const size_t end = gm_span_until(reading->text, *rest, separator);
    fail_if(reading, end < rest->end && end + 1 == rest->end, end, "nothing follows this %s", separator);
    return gm_span_take(reading->text, rest, separator, piece);
}

/* Counts the schemes that each line names. Only those of a composition take turns. */
static void count_schemes(struct reading *reading)
{
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        struct gm_written_line *line = &reading->scheme->lines[word];
        struct gm_span rest = line->value, piece;
        for (bool more = line->said && holds[word] == SCHEME; more; more = rest.begin < rest.end) {
            take_piece(reading, &rest, ",", &piece);
            fail_if(reading, ++line->columns > 1 && reading->scheme->kind != GM_WRITTEN_COMPOSITION,
                    piece.begin, "%s: names one scheme", words[word].word);
        }
    }
}

/* The length up to the last character that is neither blank nor part of a comment. */
static size_t length_of(const char *text, struct gm_span span)
{
    size_t end = span.begin;
    for (struct gm_span rest = span; rest.begin < rest.end; rest = gm_span_trimmed(text, rest)) {
        end = ++rest.begin;
    }
    return end - span.begin;
}

/* Rows between |, entries between commas. */
static void read_numbers(struct reading *reading, enum gm_scheme_word word)
{
    struct gm_written_line *line = &reading->scheme->lines[word];
    const bool stages = words[word].kinds & TABLEAUS;
    const int most = stages ? GM_MOST_STAGES : GM_MOST_SUBSTEPS;
    const size_t capacity = (size_t)most * (holds[word] == MATRIX ? (size_t)most : 1);
    line->numbers = gm_arena_take(reading->arena, capacity, sizeof *line->numbers);
    reading->nodes[word] = gm_arena_take(reading->arena, capacity, sizeof *reading->nodes[word]);
    struct gm_span rows = line->value, row, entry;
    for (int count = 0; take_piece(reading, &rows, "|", &row); line->rows++) {
        const size_t begin = row.begin;
        int columns = 0;
        fail_if(reading, holds[word] != MATRIX && line->rows == 1, begin, "%s is one row", words[word].word);
        fail_if(reading, line->rows == most, begin, "a scheme has at most %d stages", most);
        for (; take_piece(reading, &row, ",", &entry); columns++, count++) {
            fail_if(reading, columns == most, entry.begin, "a scheme has at most %d %s", most,
                    stages ? "stages" : "steps");
            line->numbers[count].place = entry.begin;
            line->numbers[count].length = length_of(reading->text, entry);
            gm_arena_need(reading->arena, read_formula(reading, entry, &reading->nodes[word][count]));
        }
        fail_if(reading, line->rows > 0 && columns != line->columns, begin,
                "row %d of %s has %d entries, the first has %d", line->rows + 1, words[word].word, columns,
                line->columns);
        line->columns = columns;
    }
}

/* Returns the value of a node, from the values of earlier nodes. */
static struct gm_ball ball_of(const struct reading *reading, const struct gm_ball *balls, gm_node_id id)
{
    const struct gm_node *node = &reading->graph.nodes[id];
    const struct gm_ball a = node->operation > GM_VARIABLE ? balls[node->a] : gm_ball_of(0);
    const struct gm_ball b = node->operation > GM_VARIABLE ? balls[node->b] : gm_ball_of(0);
    switch (node->operation) {
    case GM_CONSTANT:
        return node->value == M_PI ? gm_ball_pi() : gm_ball_of(node->value);
    case GM_VARIABLE:
        return reading->decimals[node->a].ball;
    case GM_OPERATION_ADD:
        return gm_ball_add(a, b);
    case GM_OPERATION_SUBTRACT:
        return gm_ball_subtract(a, b);
    case GM_OPERATION_MULTIPLY:
        return gm_ball_multiply(a, b);
    case GM_OPERATION_DIVIDE:
        return gm_ball_divide(a, b);
    case GM_OPERATION_NEGATE:
        return gm_ball_subtract(gm_ball_of(0), a);
    case GM_OPERATION_WHOLE_POWER: {
        struct gm_ball power = gm_ball_of(1);
        const double exponent = reading->graph.nodes[node->b].value;
        for (int i = 0; i < fabs(exponent); i++) {
            power = gm_ball_multiply(power, a);
        }
        return exponent < 0 ? gm_ball_divide(gm_ball_of(1), power) : power;
    }
    case GM_OPERATION_POWER:
        return gm_ball_exp(gm_ball_multiply(b, gm_ball_log(a)));
    case GM_OPERATION_SQRT:
        return gm_ball_sqrt(a);
    case GM_OPERATION_EXP:
        return gm_ball_exp(a);
    case GM_OPERATION_LOG:
        return gm_ball_log(a);
    case GM_OPERATION_SIN:
        return gm_ball_sin(a);
    case GM_OPERATION_COS:
        return gm_ball_cos(a);
    default: {
        const uint32_t place = reading->graph.places[id];
        fail(reading, place == GM_NO_PLACE ? 0 : place,
             "coefficients are made of numbers, + - * / ^, sqrt, exp, log, sin, cos and pi alone");
    }
    }
}

static void compute(struct reading *reading)
{
    const gm_node_id count = reading->graph.count;
    struct gm_ball *balls = gm_arena_take(reading->arena, count, sizeof *balls);
    double *values = gm_arena_take(reading->arena, count, sizeof *values);
    double *variables = gm_arena_take(reading->arena, reading->decimal_count, sizeof *variables);
    for (size_t i = 0; i < reading->decimal_count; i++) {
        variables[i] = reading->decimals[i].value;
    }
    gm_formula_evaluate(&reading->graph, count, variables, values);
    for (gm_node_id id = 0; id < count; id++) {
        balls[id] = ball_of(reading, balls, id);
    }
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        struct gm_written_line *line = &reading->scheme->lines[word];
        for (int i = 0; i < line->rows * line->columns; i++) {
            struct gm_written_number *number = &line->numbers[i];
            const gm_node_id node = reading->nodes[word][i];
            number->value = values[node];
            number->ball = balls[node];
            fail_if(reading, isnan(number->value), number->place, "this coefficient is not a number");
            fail_if(reading, !(isfinite(number->ball.radius) && fabs(number->value) < 1e6), number->place,
                    "this coefficient is %g: no finite number below a million", number->value);
        }
    }
}

/* ---- what has to fit ---- */

static const struct gm_written_number *entry_of(const struct gm_written_line *a, int i, int j)
{
    return &a->numbers[i * a->columns + j];
}

/* Checks that c: repeats the sums of the rows. If other numbers replace the typed ones, differences are gathered. */
static void check_sums(struct reading *reading, const struct gm_written_line *a,
                       const struct gm_written_line *c)
{
    const double rounding = 1e-60;
    const bool tried = reading->gathered && reading->gathered->instead;
    struct gm_row_sums *sums = tried ? reading->gathered->sums : NULL;
    for (int i = 0; i < a->rows; i++) {
        const struct gm_written_number *said = &c->numbers[i];
        struct gm_ball sum = gm_ball_of(0);
        for (int j = 0; j < a->rows; j++) {
            sum = gm_ball_add(sum, entry_of(a, i, j)->ball);
        }
        const bool same = gm_ball_may_vanish(gm_ball_subtract(sum, said->ball));
        fail_if(reading, !same && !tried, said->place, "row %d of a sums to %.15g, c says %.15g", i + 1,
                gm_ball_midpoint(sum), said->value);
        if (sums && (!same || said->ball.radius > rounding)) {
            gather(reading, &sums->at, &sums->count, (struct gm_decimal){said->place, said->length, sum});
        }
    }
}

static void check_tableau(struct reading *reading)
{
    const struct gm_written_scheme *scheme = reading->scheme;
    const struct gm_written_line *a = &scheme->lines[GM_SCHEME_WORD_A], *c = &scheme->lines[GM_SCHEME_WORD_C];
    const int stages = a->rows;
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        const struct gm_written_line *line = &scheme->lines[word];
        fail_if(reading, holds[word] == MATRIX && line->said && line->rows != line->columns,
                line->value.begin, "%s has %d rows of %d entries: it is not square", words[word].word,
                line->rows, line->columns);
        if (line->rows > 0 && line->columns != stages) {
            fail(reading, line->value.begin, "%s has %d entries%s; the rows of a make %d stages",
                 words[word].word, line->columns, line->rows > 1 ? " in a row" : "", stages);
        }
    }
    for (int i = 0; scheme->kind == GM_WRITTEN_EXPLICIT && i < stages; i++) {
        for (int j = i; j < stages; j++) {
            fail_if(reading, entry_of(a, i, j)->value != 0, entry_of(a, i, j)->place,
                    "entry %d, %d is %s the diagonal and not 0: the scheme is not explicit", i + 1, j + 1,
                    i == j ? "on" : "above");
        }
    }
    if (scheme->kind != GM_WRITTEN_NYSTROM && c->said) {
        check_sums(reading, a, c);
    }
}

static void check_steps(struct reading *reading)
{
    const struct gm_written_line *steps = &reading->scheme->lines[GM_SCHEME_WORD_STEPS];
    const int bases = reading->scheme->lines[GM_SCHEME_WORD_BASE].columns;
    double sum = 0;
    fail_if(reading, steps->columns % bases != 0, steps->value.begin,
            "%d step%s cannot be shared by %d bases in turns", steps->columns, gm_plural(steps->columns),
            bases);
    for (int i = 0; i < steps->columns; i++) {
        sum += steps->numbers[i].value;
    }
    const bool tried = reading->gathered && reading->gathered->instead;
    fail_if(reading, !tried && !(fabs(sum - 1) <= 1e-3), steps->value.begin,
            "the steps sum to %.15g, not to 1", sum);
}

static bool is_text(const struct reading *reading, const struct gm_written_line *line, const char *word)
{
    return gm_span_is(reading->text, line->value, word);
}

static void check_pieces(struct reading *reading)
{
    struct gm_written_scheme *scheme = reading->scheme;
    const struct gm_written_line *first = &scheme->lines[GM_SCHEME_WORD_FIRST];
    const struct gm_written_line *purpose = &scheme->lines[GM_SCHEME_WORD_FOR];
    const int drifts = scheme->lines[GM_SCHEME_WORD_DRIFTS].columns;
    const int kicks = scheme->lines[GM_SCHEME_WORD_KICKS].columns;
    fail_if(reading, abs(drifts - kicks) > 1, scheme->lines[GM_SCHEME_WORD_KICKS].value.begin,
            "%d drifts and %d kicks cannot take turns", drifts, kicks);
    scheme->kick_first = kicks > drifts || (first->said && is_text(reading, first, "kick"));
    fail_if(reading, first->said && !is_text(reading, first, "kick") && !is_text(reading, first, "drift"),
            first->value.begin, "first: is kick or drift");
    fail_if(reading,
            first->said && drifts != kicks && is_text(reading, first, kicks > drifts ? "drift" : "kick"),
            first->value.begin, "there is one more %s: a %s is first",
            kicks > drifts ? "kick than drifts" : "drift than kicks", kicks > drifts ? "kick" : "drift");
    scheme->nystrom = purpose->said && is_text(reading, purpose, "nystrom");
    fail_if(reading, purpose->said && !scheme->nystrom, purpose->value.begin,
            "for: is nystrom, where T is quadratic, or is left out");
}

static void read_order(struct reading *reading)
{
    enum { MOST = 20 };
    const struct gm_written_line *order = &reading->scheme->lines[GM_SCHEME_WORD_ORDER];
    for (size_t i = order->value.begin; i < order->value.end; i++) {
        const char digit = reading->text[i];
        const bool fits = digit >= '0' && digit <= '9' && reading->scheme->order <= MOST;
        reading->scheme->order = fits ? 10 * reading->scheme->order + digit - '0' : MOST + 1;
    }
    fail_if(reading, order->said && (reading->scheme->order == 0 || reading->scheme->order > MOST),
            order->value.begin, "order: is a whole number from 1 to %d", MOST);
}

/* A title is a part of the word, which is cut at semicolons and ends with its parenthesis: a title has no semicolon, its
   parentheses match, and its brackets too. */
static void check_title(const struct reading *reading)
{
    const struct gm_written_line *title = &reading->scheme->lines[GM_SCHEME_WORD_TITLE];
    int round = 0, square = 0;
    bool whole = true;
    for (size_t i = title->value.begin; i < title->value.end && whole; i++) {
        const char here = reading->text[i];
        round += (here == '(') - (here == ')');
        square += (here == '[') - (here == ']');
        whole = here != ';' && round >= 0 && square >= 0;
    }
    fail_if(reading, !whole || round != 0 || square != 0, title->value.begin,
            "a title has no semicolon, and closes its parentheses and brackets");
}

static void read(struct gm_arena *arena, void *data)
{
    struct reading *reading = data;
    struct gm_written_scheme *scheme = reading->scheme;
    const struct gm_span span = reading->span;
    const size_t length = span.end - span.begin;
    gm_formula_open(&reading->graph);
    reading->graph.keeps = true;
    gm_arena_keep(arena, &reading->graph, gm_formula_close);
    fail_if(reading, length > GM_LARGEST_SCHEME, span.begin, "a scheme has at most %d bytes",
            GM_LARGEST_SCHEME);
    if (!gm_lines_are_text(reading->text + span.begin, length, reading->fault)) {
        reading->fault->offset += span.begin;
        gm_arena_leave(arena);
    }
    (gm_written_word_name(reading->text + span.begin, length) > 0 ? read_word : read_file)(reading, span);
    check_lines(reading);
    const struct gm_written_line *format = &scheme->lines[GM_SCHEME_WORD_GEOMINT];
    if (format->said && !is_text(reading, format, "1")) {
        fail(reading, format->value.begin, "this is of a later format; this geomint reads 1");
    }
    read_order(reading);
    check_title(reading);
    count_schemes(reading);
    read_lets(reading);
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        reading->sums = word == GM_SCHEME_WORD_C && scheme->kind != GM_WRITTEN_NYSTROM;
        if (scheme->lines[word].said && (holds[word] == ROW || holds[word] == MATRIX)) {
            read_numbers(reading, word);
        }
    }
    compute(reading);
    if (TABLEAUS >> scheme->kind & 1) {
        check_tableau(reading);
    } else if (scheme->kind == GM_WRITTEN_COMPOSITION) {
        check_steps(reading);
    } else if (scheme->kind == GM_WRITTEN_SPLITTING) {
        check_pieces(reading);
    }
    gm_arena_drop(arena, &reading->graph);
}

bool gm_written_open(struct gm_written_scheme *scheme, const char *text, size_t begin, size_t end,
                     struct gm_decimals *decimals, struct gm_fault *fault)
{
    *scheme = (struct gm_written_scheme){.text = text, .arena = gm_arena_open()};
    *fault = (struct gm_fault){0};
    struct reading reading = {.scheme = scheme,
                              .arena = scheme->arena,
                              .text = text,
                              .span = gm_span_trimmed(text, (struct gm_span){begin, end}),
                              .gathered = decimals,
                              .fault = fault};
    const bool opened = gm_arena_run(scheme->arena, read, &reading);
    gm_ball_forget();
    return opened;
}

void gm_written_close(void *written)
{
    struct gm_written_scheme *scheme = written;
    gm_arena_close(scheme->arena);
    *scheme = (struct gm_written_scheme){0};
}

char *gm_written_word(struct gm_arena *arena, const struct gm_written_scheme *scheme, const char *title,
                      const char *const schemes[GM_SCHEME_WORDS])
{
    const char *base = schemes[GM_SCHEME_WORD_BASE];
    const bool called = scheme->kind == GM_WRITTEN_CALLED && !strchr(base, '(');
    const int positional = called ? 1 : kinds[scheme->kind].count;
    bool written[GM_SCHEME_WORDS] = {[GM_SCHEME_WORD_BASE] = called};
    char *text = gm_arena_print(arena, "%s(", called ? base : kinds[scheme->kind].name);
    for (int pass = 0; pass < 2; pass++) { /* the lines that need no name, then the others */
        for (int i = 0; i < (pass ? GM_SCHEME_WORDS : positional); i++) {
            const enum gm_scheme_word word =
                pass ? (enum gm_scheme_word)i : kinds[scheme->kind].positional[i];
            const struct gm_written_line *line = &scheme->lines[word];
            if (!line->said && !pass) {
                break;
            }
            if (!line->said || written[word] || word < GM_SCHEME_WORD_ORDER) {
                continue;
            }
            const char *value = holds[word] == SCHEME
                                    ? schemes[word]
                                    : gm_arena_keep(arena, gm_span_words(scheme->text, line->value), free);
            text = gm_arena_print(arena, "%s%s%s%s; ", text, pass ? words[word].word : "", pass ? ": " : "",
                                  value);
            written[word] = true;
        }
    }
    for (int i = 0; i < scheme->let_count; i++) {
        const char *let = gm_arena_keep(arena, gm_span_words(scheme->text, scheme->lets[i]), free);
        text = gm_arena_print(arena, "%slet: %s; ", text, let);
    }
    text = title ? gm_arena_print(arena, "%stitle: %s; ", text, title) : text;
    strcpy(text + strlen(text) - 2, ")"); /* instead of the last semicolon */
    return text;
}
