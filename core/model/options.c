/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of a line, and texts with values in them. */
#include "core/model/scope.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "core/expression/nearest.h"

/* The bit of a word, in the set of lines that may have an option; words from number 64 on have none. */
#define LINE(word) (UINT64_C(1) << GM_WORD_##word)

static const struct row {
    const char *word;
    enum { NOTHING, TEXT, WORD, NUMBER, NUMBERS, RANGE, FORMULA, NAMED_FORMULA } follows;
    uint64_t lines;
} rows[GM_OPTIONS] = {
#define GM_OPTION(constant, word, follows, lines) {word, follows, lines},
#include "core/model/option_words.def"
#undef GM_OPTION
};

static const char *row_word(size_t i, const void *lines)
{
    return rows[i].lines & *(const uint64_t *)lines ? rows[i].word : ""; /* excluded from proposals */
}

/* The row of a line's option with this word; GM_OPTIONS without one. */
static size_t find_row(uint64_t lines, const char *word, size_t letters)
{
    size_t row = 0;
    while (row < GM_OPTIONS && (!(rows[row].lines & lines) ||
                                !gm_text_same(rows[row].word, strlen(rows[row].word), word, letters))) {
        row++;
    }
    return row;
}

void gm_item_add(struct gm_reading *reading, struct gm_system_item *item, gm_node_id node)
{
    item->nodes = gm_arena_grown(reading->system->arena, item->nodes, item->count, sizeof *item->nodes);
    item->nodes[item->count++] = node;
}

void gm_item_add_formulas(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest)
{
    struct gm_span piece;
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        gm_item_add(reading, item, gm_reading_formula(reading, piece));
    }
}

static struct gm_system_option *add_option(struct gm_reading *reading, struct gm_system_item *item,
                                           enum gm_system_option_word word, size_t place)
{
    item->options =
        gm_arena_grown(reading->system->arena, item->options, item->option_count, sizeof *item->options);
    struct gm_system_option *option = &item->options[item->option_count++];
    *option = (struct gm_system_option){.word = word, .place = place, .node = GM_NO_NODE};
    return option;
}

static void put_number(struct gm_reading *reading, struct gm_system_option *option, double number)
{
    option->numbers =
        gm_arena_grown(reading->system->arena, option->numbers, option->count, sizeof *option->numbers);
    option->numbers[option->count++] = number;
}

static void add_number(struct gm_reading *reading, struct gm_system_option *option, struct gm_span span)
{
    put_number(reading, option, gm_reading_finite(reading, span));
}

/* Numbers separated by commas; "usual" stands for the default list. */
static void add_numbers(struct gm_reading *reading, struct gm_system_option *option, struct gm_span rest)
{
    struct gm_span piece;
    while (!gm_span_is(reading->text, rest, "usual") && gm_span_take(reading->text, &rest, ",", &piece)) {
        add_number(reading, option, piece);
    }
}

void gm_item_number(struct gm_reading *reading, struct gm_system_item *item, double number)
{
    struct gm_system_option *option = item->options;
    put_number(reading, option ? option : add_option(reading, item, GM_OPTION_VALUES, item->place), number);
}

size_t gm_item_numbers(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest)
{
    struct gm_span piece;
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        gm_item_number(reading, item, gm_reading_finite(reading, piece));
    }
    return item->options ? item->options->count : 0;
}

/* low .. high */
static void add_range(struct gm_reading *reading, struct gm_system_option *option, struct gm_span span)
{
    const size_t dots = gm_span_until(reading->text, span, "..");
    gm_system_refuse_if(reading->system, dots == span.end, span.begin, "a range was expected, low .. high");
    add_number(reading, option, (struct gm_span){span.begin, dots});
    add_number(reading, option, (struct gm_span){dots + 2, span.end});
    gm_system_refuse_if(reading->system, !(option->numbers[0] < option->numbers[1]), span.begin,
                        "a range's lower end comes first");
}

/* F, or F = NAME */
static void add_formula(struct gm_reading *reading, struct gm_system_option *option, struct gm_span span,
                        bool named)
{
    const size_t equals = named ? gm_span_until(reading->text, span, "=") : span.end;
    const struct gm_span name =
        gm_reading_between(reading, equals < span.end ? equals + 1 : equals, span.end);
    gm_system_refuse_if(reading->system, named && name.begin == name.end, span.begin,
                        "a unit has a name: unit 2*pi = h / T");
    option->text = named ? gm_reading_text(reading, name) : NULL;
    option->node = gm_reading_formula(reading, gm_reading_between(reading, span.begin, equals));
}

/* A word for show= that it does not have already. */
static void add_word(struct gm_reading *reading, struct gm_system_option *option, struct gm_span value)
{
    static const char *const taken[] = {"all", "section", "modified", NULL};
    const size_t length = value.end - value.begin;
    option->text = gm_reading_text(reading, value);
    gm_system_refuse_if(reading->system,
                        gm_name_length(reading->text + value.begin, length) < length ||
                            gm_span_among(reading->text, value, taken) < 3,
                        value.begin, "%.60s is not a new word for show=, as in show plane", option->text);
}

static void read_value(struct gm_reading *reading, struct gm_system_option *option, struct gm_span value)
{
    switch (rows[option->word].follows) {
    case NOTHING:
        break;
    case TEXT:
        option->text = gm_reading_text(reading, value);
        break;
    case WORD:
        add_word(reading, option, value);
        break;
    case NUMBER: /* a field's scale may depend on parameters, and have a name */
        if (option->word == GM_OPTION_SCALE && gm_system_is_field(reading->system)) {
            add_formula(reading, option, value, gm_span_until(reading->text, value, "=") < value.end);
        } else {
            add_number(reading, option, value);
        }
        break;
    case NUMBERS:
        add_numbers(reading, option, value);
        break;
    case RANGE:
        add_range(reading, option, value);
        break;
    case FORMULA:
    case NAMED_FORMULA:
        add_formula(reading, option, value, rows[option->word].follows == NAMED_FORMULA);
        break;
    }
}

static void read_option(struct gm_reading *reading, struct gm_system_item *item, struct gm_span piece)
{
    const uint64_t lines = item->word < 64 ? UINT64_C(1) << item->word : 0;
    const char *text = reading->text + piece.begin;
    size_t letters = 0;
    while (piece.begin + letters < piece.end && !strchr(" \t\r\n", text[letters])) {
        letters++;
    }
    const struct gm_span value = gm_reading_between(reading, piece.begin + letters, piece.end);
    const bool some = value.begin < value.end;
    size_t row = find_row(lines, text, letters);
    const bool is_range = row == GM_OPTIONS && gm_span_until(reading->text, piece, "..") < piece.end;
    if ((row == GM_OPTION_WHILE || row == GM_OPTION_ON || row == GM_OPTION_SHOW) &&
        (row == GM_OPTION_ON) != gm_system_is_field(reading->system)) {
        row =
            GM_OPTIONS; /* an integral applies always, no other quantity has a grid, fields show their own words */
    }
    row = is_range ? find_row(lines, "range", 5) : row;
    const bool is_key = lines == LINE(STABILITY) ||
                        (lines == LINE(WORK) && gm_reading_entry(reading, text, letters, false, 0));
    if (row == GM_OPTIONS && is_key && !item->name[0] && some) { /* KEY with its values */
        item->name = gm_reading_text(reading, (struct gm_span){piece.begin, piece.begin + letters});
        row = GM_OPTION_VALUES;
    }
    char word[64];
    snprintf(word, sizeof word, "%.*s", gm_brief_length(letters), text);
    if (row == GM_OPTIONS) {
        const char *near = gm_nearest(word, GM_OPTIONS, row_word, &lines);
        gm_system_refuse(reading->system, piece.begin, "%s: has no option \"%s\"%s%s",
                         gm_system_words[item->word].word, word, near ? "; did you mean " : "",
                         near ? near : "");
    }
    gm_system_refuse_if(reading->system, gm_system_option(item, (enum gm_system_option_word)row), piece.begin,
                        "%s is given twice", word);
    gm_system_refuse_if(reading->system, !is_range && some != (rows[row].follows != NOTHING),
                        some ? value.begin : piece.begin,
                        some ? "nothing follows the option %s" : "the option %s needs a value", word);
    read_value(reading, add_option(reading, item, (enum gm_system_option_word)row, piece.begin),
               is_range ? piece : value);
}

void gm_options_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest)
{
    struct gm_span piece;
    while (gm_span_take(reading->text, &rest, ";", &piece)) {
        read_option(reading, item, piece);
    }
}

/* FORMULA, KEY or KEY*FORMULA, with :format or without it, between braces */
static void read_braces(struct gm_reading *reading, struct gm_system_item *item, struct gm_span inside)
{
    static const char *const formats[] = {"pi", "T", "/", "nonzero", "s", NULL};
    const size_t colon = gm_span_until(reading->text, inside, ":");
    struct gm_span formula = gm_reading_between(reading, inside.begin, colon);
    const struct gm_span format = {colon < inside.end ? colon + 1 : colon, inside.end};
    gm_system_refuse_if(
        reading->system, format.begin < format.end && !formats[gm_span_among(reading->text, format, formats)],
        format.begin, "a value is written as {x}, {x:pi}, {x:T}, {x:/}, {x:nonzero} or {x:s}");
    const char *name = reading->text + formula.begin;
    const size_t length = gm_name_length(name, formula.end - formula.begin);
    const bool named = gm_reading_reserves(name, length) ||
                       (gm_system_is_room(reading->system) && /* which has keys from lines */
                        gm_line_word(reading->words, reading->text, formula) < GM_WORDS),
               is_key = named && !gm_formula_reserves(name, length) &&
                        !gm_reading_entry(reading, name, length, false, 0);
    formula.begin += is_key ? length : 0;
    const bool alone = is_key && formula.begin == formula.end;
    formula.begin += is_key && !alone && reading->text[formula.begin] == '*';
    gm_item_add(reading, item, alone ? GM_NO_NODE : gm_reading_formula_of_exact(reading, formula));
}

void gm_text_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span span)
{
    item->text = gm_reading_text(reading, span);
    bool comment = false;
    for (size_t at = span.begin; at < span.end; at++) {
        const char c = reading->text[at];
        comment = c != '\n' && (comment || c == '#');
        const char *close = c == '{' ? memchr(reading->text + at, '}', span.end - at) : NULL;
        if (comment || (c != '{' && c != '}')) {
            continue;
        }
        gm_system_refuse_if(reading->system, !close, at, "this brace has no counterpart");
        const size_t end = (size_t)(close - reading->text);
        read_braces(reading, item, (struct gm_span){at + 1, end});
        at = end;
    }
}
