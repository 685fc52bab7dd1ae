/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One reader for all that rooms say between semicolons, and one check of it. */
#include "core/flow/statements.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/number.h"

enum {
    OFTEN = 10000,
    FIXED = 1,  /* it says the same for every word of a choice */
    NAMED = 2,  /* no two of them begin with the same word */
    COMMAS = 4, /* its pieces are parted by commas */
};

enum type {
    NOTHING,
    TEXT,
    REST,          /* a text to the end of the line */
    NUMBER,        /* one that needs no parameter */
    FORMULA,       /* one that parameters may make */
    WHOLE,         /* a whole one */
    FORMULAS,      /* such numbers with commas between them */
    PLACE,         /* two */
    POINTS,        /* pairs, of which the second number may be missing */
    KEYED,         /* a parameter, and numbers */
    ASSIGNED,      /* a parameter = a number */
    RANGE,         /* low .. high */
    RANGE_OF_FLOW, /* one that may hold measures of the flow */
    UNIT,          /* such a number, unless nothing follows: then a text */
    FILLED,        /* a text with such numbers in braces */
    ARGUMENTS,     /* key=value by blanks */
    SIDEWAYS,      /* y */
    CONDITIONS,    /* x = 0, y > 4 */
};

static const struct line {
    const char *word;
    size_t most;
    unsigned flags;
    const char *written;
    enum type type;
    double low, high;
} lines[GM_LINES] = {
#define GM_STATEMENT(constant, ...) {__VA_ARGS__},
#define GM_PIECE(...)
#include "core/flow/statements.def"
#undef GM_STATEMENT
#undef GM_PIECE
};

static const struct row {
    enum gm_statement_word line;
    const char *option, *written;
    enum type type;
    double low, high;
    size_t least, most;
} rows[GM_ROWS_OF_LINES] = {
#define GM_STATEMENT(...)
#define GM_PIECE(line, constant, ...) {GM_LINE_##line, __VA_ARGS__},
#include "core/flow/statements.def"
#undef GM_STATEMENT
#undef GM_PIECE
};

/* A line while it is read. */
struct reading {
    struct gm_room_names *names;
    struct gm_statement *statement;
    const char *called; /* what numbers are called */
    double low, high;   /* between which they lie */
    struct gm_fault *fault;
};

/* "dt: is written NUMBER; low .. high" */
static bool fail_form(struct reading *reading, size_t place)
{
    const enum gm_statement_word word = reading->statement->word;
    char form[240];
    size_t used = (size_t)snprintf(form, sizeof form, "%s", lines[word].written);
    for (size_t row = 0; row < GM_ROWS_OF_LINES; row++) {
        if (rows[row].line == word && used < sizeof form) {
            used += (size_t)snprintf(form + used, sizeof form - used, "%s%s%s%s",
                                     used == 0                    ? ""
                                     : lines[word].flags & COMMAS ? ", "
                                                                  : "; ",
                                     rows[row].option, rows[row].option[0] ? " " : "", rows[row].written);
        }
    }
    return gm_fail(reading->fault, place, "%s: is written %s", lines[word].word, form);
}

static bool push(struct gm_piece *piece, double number)
{
    double *more = realloc(piece->numbers, (piece->count + 1) * sizeof *more);
    if (more) {
        piece->numbers = more;
        more[piece->count++] = number;
    }
    return more != NULL;
}

static bool add_number(struct reading *reading, struct gm_piece *piece, size_t place, double number)
{
    const double low = reading->low, high = reading->high;
    if (!push(piece, number)) {
        return false;
    }
    if (!isfinite(number) || (low > 0 && !(number > 0))) {
        return gm_fail(reading->fault, place, "%s: is a %s number", reading->called,
                       low > 0 ? "positive" : "finite");
    }
    return (number >= low && number <= high) ||
           gm_fail(reading->fault, place, "%s: lies between %g and %g", reading->called, low, high);
}

static bool add_formula(struct reading *reading, struct gm_piece *piece, struct gm_span span)
{
    double number = NAN;
    return gm_room_number(reading->names, span, &number, reading->fault) &&
           add_number(reading, piece, span.begin, number);
}

static bool add_formulas(struct reading *reading, struct gm_piece *piece, struct gm_span rest)
{
    struct gm_span part;
    bool good = true;
    while (good && gm_span_take(reading->names->text, &rest, ",", &part)) {
        good = add_formula(reading, piece, part);
    }
    return good && (piece->count > 0 || fail_form(reading, piece->span.begin));
}

/* Takes the first word of a span off its front. */
static struct gm_span take_word(const char *text, struct gm_span *rest)
{
    struct gm_span word = {rest->begin, rest->begin};
    while (word.end < rest->end && !strchr(" \t\r\n", text[word.end])) {
        word.end++;
    }
    *rest = gm_span_trimmed(text, (struct gm_span){word.end, rest->end});
    return word;
}

static bool add_points(struct reading *reading, struct gm_piece *piece, struct gm_span rest)
{
    struct gm_span point;
    bool good = true;
    while (good && gm_span_take(reading->names->text, &rest, ",", &point)) {
        good = add_formula(reading, piece, take_word(reading->names->text, &point)) &&
               (point.begin < point.end ? add_formula(reading, piece, point) : push(piece, NAN));
    }
    return good;
}

/* A parameter's name becomes the piece's text. */
static bool add_keyed(struct reading *reading, struct gm_piece *piece, struct gm_span name,
                      struct gm_span rest)
{
    free(piece->text);
    piece->text = gm_span_words(reading->names->text, name);
    return piece->text &&
           (gm_room_parameter(reading->names, piece->text) || fail_form(reading, name.begin)) &&
           add_formulas(reading, piece, rest);
}

/* What needs the flow can be read, and waits for it. */
static bool check_late(struct reading *reading, struct gm_span span, bool range)
{
    struct gm_room_names known = *reading->names;
    struct gm_room_range ends;
    double value;
    for (int i = 0; i < GM_ROOM_MEASURES; i++) {
        known.measures[i] = isnan(known.measures[i]) ? 1 : known.measures[i];
    }
    const size_t dots = range ? gm_span_until(known.text, span, "..") : span.end;
    return range && dots == span.end
               ? gm_room_range_of(&known, span, &ends, reading->fault)
               : gm_room_number(&known, (struct gm_span){span.begin, dots}, &value, reading->fault) &&
                     (!range ||
                      gm_room_number(&known, (struct gm_span){dots + 2, span.end}, &value, reading->fault));
}

/* {F} or {F:nonzero} */
static bool check_braces(struct reading *reading, struct gm_span rest)
{
    const char *text = reading->names->text;
    for (rest.begin = gm_span_until(text, rest, "{"); rest.begin < rest.end;
         rest.begin = gm_span_until(text, rest, "{")) {
        const size_t open = rest.begin, close = gm_span_until(text, rest, "}"),
                     colon = gm_span_until(text, (struct gm_span){open, close}, ":");
        if (close == rest.end ||
            (colon < close &&
             !gm_room_is_word(reading->names, (struct gm_span){colon + 1, close}, "nonzero"))) {
            return fail_form(reading, open);
        }
        if (!check_late(reading, (struct gm_span){open + 1, colon}, false)) {
            return false;
        }
        rest.begin = close + 1;
    }
    return true;
}

static bool check_arguments(struct reading *reading, const struct gm_piece *piece)
{
    for (const char *word = piece->text; *word; word += strcspn(word, " "), word += *word == ' ') {
        if (strcspn(word, "=") >= strcspn(word, " ")) {
            return gm_fail(reading->fault, piece->span.begin, "%.60s is no word key=value: until=100", word);
        }
    }
    return true;
}

static bool check_conditions(struct reading *reading, struct gm_span rest)
{
    const double origin[GM_ROOM_AT] = {0};
    struct gm_span part;
    bool good = true;
    while (good && gm_span_take(reading->names->text, &rest, ",", &part)) {
        struct gm_span sides[2];
        double value;
        good = gm_condition_sign(reading->names->text, part, sides) != '\0' || fail_form(reading, part.begin);
        for (int k = 0; k < 2; k++) {
            good = good && gm_room_value_of(reading->names, sides[k], 1u << GM_ROOM_AT_X | 1u << GM_ROOM_AT_Y,
                                            origin, &value, reading->fault);
        }
    }
    return good;
}

static bool read_value(struct reading *reading, enum type type, struct gm_piece *piece)
{
    const char *text = reading->names->text;
    const struct gm_span span = piece->span;
    struct gm_span rest = span, first;
    struct gm_room_range range;
    double number = NAN;
    switch (type) {
    case NUMBER:
        gm_number_parse(piece->text, &number);
        return add_number(reading, piece, span.begin, number);
    case FORMULA:
        return add_formula(reading, piece, span);
    case WHOLE:
        return add_formula(reading, piece, span) &&
               (piece->numbers[0] == floor(piece->numbers[0]) ||
                gm_fail(reading->fault, span.begin, "%s: is a whole number", reading->called));
    case FORMULAS:
        return add_formulas(reading, piece, span);
    case PLACE:
        return add_formulas(reading, piece, span) && (piece->count == 2 || fail_form(reading, span.begin));
    case POINTS:
        return add_points(reading, piece, span);
    case KEYED:
        first = take_word(text, &rest);
        return add_keyed(reading, piece, first, rest);
    case ASSIGNED:
        gm_span_take(text, &rest, "=", &first);
        return add_keyed(reading, piece, first, rest) &&
               (piece->count == 1 || fail_form(reading, span.begin));
    case RANGE:
        return gm_room_range_of(reading->names, span, &range, reading->fault) &&
               add_number(reading, piece, span.begin, range.least) &&
               add_number(reading, piece, span.begin, range.most);
    case UNIT:
    case RANGE_OF_FLOW:
        return check_late(reading, span, type == RANGE_OF_FLOW);
    case FILLED:
        return check_braces(reading, span);
    case ARGUMENTS:
        return check_arguments(reading, piece);
    case SIDEWAYS:
        return strcmp(piece->text, "y") == 0 || fail_form(reading, span.begin);
    case CONDITIONS:
        return check_conditions(reading, span);
    default:
        return true;
    }
}

static size_t count_pieces(const struct gm_statement *statement, size_t row)
{
    size_t count = 0;
    for (size_t i = 0; i < statement->count; i++) {
        count += statement->pieces[i].row == row;
    }
    return count;
}

/* The row of a piece: that of its option, else the next one without an option that it can be. */
static size_t find_row(const struct reading *reading, struct gm_span piece, struct gm_span word)
{
    const struct gm_statement *statement = reading->statement;
    const bool range = gm_span_until(reading->names->text, piece, "..") < piece.end;
    size_t next = GM_ROWS_OF_LINES;
    for (size_t row = GM_ROWS_OF_LINES; row-- > 0;) {
        const bool ranges = rows[row].type == RANGE || rows[row].type == RANGE_OF_FLOW;
        if (rows[row].line != statement->word) {
            continue;
        }
        if (rows[row].option[0] && gm_room_is_word(reading->names, word, rows[row].option)) {
            return row;
        }
        if (!rows[row].option[0] && (!ranges || range) && count_pieces(statement, row) == 0) {
            next = row;
        }
    }
    return next;
}

/* Adds a piece, the first one as the head, and takes it off the line's rest. */
static bool take_piece(struct reading *reading, struct gm_span *rest)
{
    struct gm_statement *statement = reading->statement;
    const struct line *line = &lines[statement->word];
    const char *text = reading->names->text;
    const struct gm_span all = gm_span_trimmed(text, *rest);
    struct gm_span span;
    gm_span_take(text, rest, line->flags & COMMAS ? "," : ";", &span);
    enum type type = line->type;
    size_t row = GM_ROWS_OF_LINES;
    reading->called = line->word;
    reading->low = line->low;
    reading->high = line->high;
    if (statement->count > 0) {
        struct gm_span value = span;
        const struct gm_span word = take_word(text, &value);
        row = find_row(reading, span, word);
        if (row == GM_ROWS_OF_LINES) {
            return fail_form(reading, span.begin);
        }
        if (count_pieces(statement, row) == rows[row].most) {
            return gm_fail(reading->fault, span.begin, "%s: %s is given %s", line->word,
                           rows[row].option[0] ? rows[row].option : rows[row].written,
                           rows[row].most == 1 ? "twice" : "too often");
        }
        type = rows[row].type;
        reading->called = rows[row].option[0] ? rows[row].option : line->word;
        reading->low = rows[row].low;
        reading->high = rows[row].high;
        span = rows[row].option[0] ? value : span;
    }
    if (type == REST || type == FILLED) {
        span = all;
        rest->begin = rest->end;
    }
    type = type == UNIT && gm_span_trimmed(text, *rest).begin >= rest->end ? REST : type;
    if (type != NOTHING && span.begin == span.end) {
        return fail_form(reading, span.begin);
    }
    struct gm_piece *more = realloc(statement->pieces, (statement->count + 1) * sizeof *more);
    if (!more) {
        return false;
    }
    statement->pieces = more;
    struct gm_piece *piece = &more[statement->count++];
    *piece = (struct gm_piece){.row = row, .span = span, .text = gm_span_words(text, span)};
    return piece->text && read_value(reading, type, piece);
}

char gm_condition_sign(const char *text, struct gm_span condition, struct gm_span sides[2])
{
    size_t sign = condition.begin;
    while (sign < condition.end && !strchr("=<>", text[sign])) {
        sign++;
    }
    sides[0] = (struct gm_span){condition.begin, sign};
    sides[1] = (struct gm_span){sign + 1, condition.end};
    return (char)(sign < condition.end ? text[sign] : '\0');
}

enum gm_statement_word gm_statement_word_of(const struct gm_room_names *names, struct gm_text_line line)
{
    static const char *const made[] = {"rectangle", "flat-torus", NULL};
    struct gm_span rest = line.value, head;
    enum gm_statement_word word = 0;
    while (word < GM_LINES && !gm_room_is_word(names, line.word, lines[word].word)) {
        word++;
    }
    gm_span_take(names->text, &rest, ";", &head);
    return word == GM_LINE_MESH && made[gm_span_among(names->text, head, made)] ? GM_LINE_RECTANGLE : word;
}

const char *gm_statement_name(size_t word)
{
    return word < GM_LINES ? lines[word].word : NULL;
}

struct gm_room_range gm_statement_range(enum gm_statement_word word)
{
    return (struct gm_room_range){lines[word].low, lines[word].high};
}

bool gm_statement_is_fixed(enum gm_statement_word word)
{
    return word < GM_LINES && lines[word].flags & FIXED;
}

/* Whether two texts begin with the same word. */
static bool have_one_name(const char *one, const char *other)
{
    const size_t length = strcspn(one, " ");
    return length == strcspn(other, " ") && strncmp(one, other, length) == 0;
}

bool gm_statement_read(struct gm_statements *statements, struct gm_room_names *names,
                       enum gm_statement_word word, struct gm_text_line line, struct gm_fault *fault)
{
    size_t before = 0;
    for (size_t i = 0; i < statements->count; i++) {
        before += strcmp(lines[statements->list[i].word].word, lines[word].word) == 0;
    }
    if (before == lines[word].most) {
        return gm_fail(fault, line.word.begin, "%s: is given %s", lines[word].word,
                       before == 1 ? "twice" : "too often");
    }
    if (line.value.begin == line.value.end) {
        return gm_fail(fault, line.word.begin, "%s: says nothing", lines[word].word);
    }
    struct gm_statement *more = realloc(statements->list, (statements->count + 1) * sizeof *more);
    if (!more) {
        return false;
    }
    statements->list = more;
    struct gm_statement *statement = &more[statements->count++];
    *statement = (struct gm_statement){.word = word, .place = line.word.begin};
    struct reading reading = {.names = names, .statement = statement, .fault = fault};
    struct gm_span rest = line.value, nothing = {rest.begin, rest.begin};
    bool good = take_piece(&reading, lines[word].type == NOTHING ? &nothing : &rest);
    while (good && rest.begin < rest.end) {
        good = take_piece(&reading, &rest);
    }
    for (size_t i = 0; good && lines[word].flags & NAMED && i + 1 < statements->count; i++) {
        good = more[i].word != word || !have_one_name(more[i].pieces[0].text, statement->pieces[0].text) ||
               gm_fail(fault, line.value.begin, "%s: %.60s is given twice", lines[word].word,
                       statement->pieces[0].text);
    }
    for (size_t row = 0; good && row < GM_ROWS_OF_LINES; row++) {
        good = rows[row].line != word || count_pieces(statement, row) >= rows[row].least ||
               fail_form(&reading, line.value.begin);
    }
    return good;
}

void gm_statements_close(struct gm_statements *statements)
{
    for (size_t i = 0; i < statements->count; i++) {
        for (size_t k = 0; k < statements->list[i].count; k++) {
            free(statements->list[i].pieces[k].text);
            free(statements->list[i].pieces[k].numbers);
        }
        free(statements->list[i].pieces);
    }
    free(statements->list);
}

const struct gm_statement *gm_statement(const struct gm_statements *statements, enum gm_statement_word word,
                                        size_t number)
{
    size_t i = 0;
    while (i < statements->count && (statements->list[i].word != word || number-- > 0)) {
        i++;
    }
    return i < statements->count ? &statements->list[i] : NULL;
}

const struct gm_piece *gm_statement_piece(const struct gm_statement *statement, enum gm_statement_row row)
{
    size_t i = 0;
    while (statement && i < statement->count && statement->pieces[i].row != row) {
        i++;
    }
    return statement && i < statement->count ? &statement->pieces[i] : NULL;
}

double gm_statement_number(const struct gm_statement *statement, enum gm_statement_row row, double otherwise)
{
    const struct gm_piece *piece = gm_statement_piece(statement, row);
    return piece ? piece->numbers[0] : otherwise;
}

const char *gm_statement_text(const struct gm_statements *statements, enum gm_statement_word word)
{
    const struct gm_statement *statement = gm_statement(statements, word, 0);
    return statement ? statement->pieces[0].text : NULL;
}

double gm_statement_value(const struct gm_statements *statements, enum gm_statement_word word,
                          double otherwise)
{
    const struct gm_statement *statement = gm_statement(statements, word, 0);
    return statement ? statement->pieces[0].numbers[0] : otherwise;
}
