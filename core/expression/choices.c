/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choices of a text, and the lines that hold for their words. */
#include "core/expression/choices.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/nearest.h"

static const char *const own_words[] = {"choice", "when", NULL};
enum { CHOICE, WHEN };

/* False if the word is empty, too long or not one word. */
static bool copy(const char *text, struct gm_span span, char word[GM_CHOICE_SIZE])
{
    const size_t length = span.end - span.begin;
    snprintf(word, GM_CHOICE_SIZE, "%.*s", (int)(length < GM_CHOICE_SIZE ? length : GM_CHOICE_SIZE),
             text + span.begin);
    return length > 0 && length < GM_CHOICE_SIZE && strcspn(word, " \t\r\n#={}\"'") == length;
}

static const char *name_at(size_t i, const void *choices)
{
    return ((const struct gm_written_choices *)choices)->list[i].name;
}

static const char *word_at(size_t i, const void *choice)
{
    return ((const struct gm_written_choice *)choice)->words[i];
}

/* The names of choices, or the words of one. */
struct list {
    const char *what, *(*at)(size_t i, const void *data);
    const void *data;
    size_t count;
};

static struct list names_of(const struct gm_written_choices *choices)
{
    return (struct list){"choice", name_at, choices, choices->count};
}

static struct list words_of(const struct gm_written_choice *choice)
{
    return (struct list){"word", word_at, choice, choice->count};
}

static size_t find(const char *word, struct list list)
{
    size_t i = 0;
    while (i < list.count && strcmp(list.at(i, list.data), word) != 0) {
        i++;
    }
    return i;
}

/* Finds a word among others; else false, with a fault that proposes the nearest. */
static bool seek(const char *text, struct gm_span span, struct list list, size_t *found,
                 struct gm_fault *fault)
{
    char word[GM_CHOICE_SIZE];
    if (span.begin == span.end) {
        return gm_fail(fault, span.begin, "a %s was expected", list.what);
    }
    *found = copy(text, span, word) ? find(word, list) : list.count;
    const char *near = *found < list.count ? NULL : gm_nearest(word, list.count, list.at, list.data);
    return *found < list.count || gm_fail(fault, span.begin, "there is no %s \"%s\"%s%s", list.what, word,
                                          near ? "; did you mean " : "", near ? near : "");
}

const struct gm_written_choice *gm_choice_named(const struct gm_written_choices *choices, const char *name)
{
    const size_t found = find(name, names_of(choices));
    return found < choices->count ? &choices->list[found] : NULL;
}

bool gm_choices_take(struct gm_written_choices *choices, const char *name, const char *word)
{
    struct gm_written_choice *choice = (struct gm_written_choice *)gm_choice_named(choices, name);
    const size_t found = choice ? find(word, words_of(choice)) : GM_MOST_CHOICE_WORDS;
    if (choice && found < choice->count) {
        choice->chosen = found;
    }
    return choice && found < choice->count;
}

/* Reads WORD, WORD. */
static bool read_words(struct gm_written_choice *choice, const char *text, struct gm_span list,
                       struct gm_fault *fault)
{
    struct gm_span word;
    while (gm_span_take(text, &list, ",", &word)) {
        if (choice->count == GM_MOST_CHOICE_WORDS) {
            return gm_fail(fault, word.begin, "a choice has at most %d words", GM_MOST_CHOICE_WORDS);
        }
        char *copied = choice->words[choice->count];
        if (!copy(text, word, copied)) {
            return gm_fail(
                fault, word.begin,
                "a word of a choice has 1 to %d bytes without blanks, quotes, # and =", GM_CHOICE_SIZE - 1);
        }
        if (find(copied, words_of(choice)) < choice->count) {
            return gm_fail(fault, word.begin, "%s is named twice", copied);
        }
        choice->count++;
    }
    return choice->count > 1 || gm_fail(fault, choice->place, "a choice has at least two words");
}

/* NAME = WORD of WORD, WORD; meaning */
static bool read_choice(struct gm_written_choices *choices, const char *text, struct gm_span rest,
                        struct gm_fault *fault)
{
    struct gm_written_choice *choice = &choices->list[choices->count];
    struct gm_span head;
    if (choices->count == GM_MOST_CHOICES) {
        return gm_fail(fault, rest.begin, "a file has at most %d choices", GM_MOST_CHOICES);
    }
    gm_span_take(text, &rest, ";", &head);
    const size_t equals = gm_span_until(text, head, "="), of = gm_span_until(text, head, " of ");
    const struct gm_span name = gm_span_trimmed(text, (struct gm_span){head.begin, equals}),
                         standard = gm_span_trimmed(text, (struct gm_span){equals + 1, of});
    *choice = (struct gm_written_choice){.meaning = gm_span_trimmed(text, rest), .place = name.begin};
    if (of == head.end || equals > of) {
        return gm_fail(fault, head.begin,
                       "a choice has a name, a default and words: system = harmonic of harmonic, pendulum");
    }
    if (!copy(text, name, choice->name) ||
        strlen(choice->name) != gm_name_length(choice->name, strlen(choice->name))) {
        return gm_fail(fault, name.begin, "the name of a choice has 1 to %d letters, digits and _",
                       GM_CHOICE_SIZE - 1);
    }
    if (gm_choice_named(choices, choice->name)) {
        return gm_fail(fault, name.begin, "%s is defined twice", choice->name);
    }
    choices->count++;
    return read_words(choice, text, (struct gm_span){of + 4, head.end}, fault) &&
           seek(text, standard, words_of(choice), &choice->standard, fault) &&
           gm_choices_take(choices, choice->name, choice->words[choice->standard]);
}

bool gm_choices_read(struct gm_written_choices *choices, const char *text, size_t length,
                     struct gm_fault *fault)
{
    struct gm_text_line line;
    *choices = (struct gm_written_choices){0};
    for (size_t at = 0; gm_lines_next(text, length, &at, &line, fault);) {
        if (gm_span_among(text, line.word, own_words) == CHOICE &&
            !read_choice(choices, text, line.value, fault)) {
            return false;
        }
    }
    return true; /* the reader refuses a faulty line */
}

/* The blocks of a text, while its lines are read. */
struct blocks {
    const struct gm_written_choices *choices;
    const char *text;
    const struct gm_written_choice *open; /* the choice whose block is open; NULL: none is open */
    bool holds, empty;
    size_t place; /* byte offset where the block begins */
};

static bool end_block(const struct blocks *blocks, struct gm_fault *fault)
{
    return !(blocks->open && blocks->empty) ||
           gm_fail(fault, blocks->place, "this block has no lines: write the lines for these words below it");
}

/* NAME = WORD, WORD or always */
static bool begin_block(struct blocks *blocks, struct gm_span rest, struct gm_fault *fault)
{
    static const char *const always[] = {"always", NULL};
    const char *text = blocks->text;
    struct gm_span name, word;
    size_t number = 0;
    if (!end_block(blocks, fault)) {
        return false;
    }
    if (gm_span_among(text, rest, always) == 0) {
        blocks->open = NULL;
        return true;
    }
    gm_span_take(text, &rest, "=", &name);
    if (!seek(text, name, names_of(blocks->choices), &number, fault)) {
        return false;
    }
    const struct gm_written_choice *choice = &blocks->choices->list[number];
    if (blocks->open && blocks->open != choice) {
        return gm_fail(fault, name.begin, "a block of %s is inside one of %s: end that by \"when: always\"",
                       choice->name, blocks->open->name);
    }
    *blocks = (struct blocks){blocks->choices, text, choice, false, true, name.begin};
    do {
        gm_span_take(text, &rest, ",", &word);
        if (!seek(text, word, words_of(choice), &number, fault)) {
            return false;
        }
        blocks->holds = blocks->holds || number == choice->chosen;
    } while (rest.begin < rest.end);
    return true;
}

static bool pass(struct blocks *blocks, const struct gm_text_line *line, bool own, struct gm_fault *fault)
{
    if (own && gm_span_among(blocks->text, line->word, own_words) == WHEN) {
        return begin_block(blocks, line->value, fault);
    }
    blocks->empty = false;
    return !own || !blocks->open ||
           gm_fail(fault, line->word.begin,
                   "a choice belongs outside of blocks: write \"when: always\" above it");
}

/* The assignments of a line: the text before its first semicolon, or before the second if the line is
   repeated, as in i = 1 .. 3; x[i] = 0. */
static struct gm_span assignments(const char *text, struct gm_span rest)
{
    struct gm_span piece;
    gm_span_take(text, &rest, ";", &piece);
    if (gm_span_until(text, piece, "..") < piece.end) {
        gm_span_take(text, &rest, ";", &piece);
    }
    return piece;
}

/* A line with one of the names to which it assigns, or without a name. Lines in blocks replace the lines
   outside of them with the same word and name. */
struct heading {
    const char *text;
    struct gm_span name;
    size_t word, line; /* number of the line */
    bool inside;
};

static int compare_headings(const struct heading *a, const struct heading *b)
{
    const size_t one = a->name.end - a->name.begin, other = b->name.end - b->name.begin;
    return a->word != b->word ? (a->word > b->word) - (a->word < b->word)
           : one != other     ? (one > other) - (one < other)
                              : memcmp(a->text + a->name.begin, b->text + b->name.begin, one);
}

/* Equal headings are in the order: inside of blocks, outside. */
static int compare(const void *a, const void *b)
{
    const struct heading *one = a, *other = b;
    const int headings = compare_headings(one, other);
    return headings != 0 ? headings : other->inside - one->inside;
}

/* Adds a heading once, or with each name of its line. Returns the new number of headings. */
static size_t add_headings(struct heading *list, size_t count, struct heading heading, struct gm_span rest,
                           bool named)
{
    struct gm_span piece;
    list[count] = heading;
    rest = assignments(heading.text, rest);
    while (named && gm_span_take(heading.text, &rest, ",", &piece)) {
        const size_t equals = gm_span_until(heading.text, piece, "="),
                     arguments = gm_span_until(heading.text, (struct gm_span){piece.begin, equals}, "(");
        list[count] = heading;
        list[count].name = gm_span_trimmed(heading.text, (struct gm_span){piece.begin, arguments});
        count += equals < piece.end && list[count].name.begin < list[count].name.end;
    }
    return count + !named;
}

/* Removes the lines outside of blocks that a line in a block replaces. */
static void remove_replaced(struct gm_read_lines *lines, struct heading *list, size_t count)
{
    size_t kept = 0;
    if (count > 0) {
        qsort(list, count, sizeof *list, compare);
    }
    for (size_t i = 0, first = 0; i < count; i++) {
        first = compare_headings(&list[first], &list[i]) == 0 ? first : i;
        if (list[first].inside && !list[i].inside) {
            lines->list[list[i].line].word = lines->words->count;
        }
    }
    for (size_t i = 0; i < lines->count; i++) {
        if (lines->list[i].word < lines->words->count) {
            lines->list[kept++] = lines->list[i];
        }
    }
    lines->count = kept;
}

/* Reads the lines and their headings, for which there is room. */
static bool read_lines(struct gm_read_lines *lines, struct heading *headings, struct gm_fault *fault)
{
    const struct gm_line_word *words = lines->words->list;
    const char *text = lines->text;
    const bool chosen = lines->choices && lines->choices->count > 0;
    struct blocks blocks = {.choices = lines->choices, .text = text};
    struct gm_text_line line;
    size_t count = 0, word;
    bool given[GM_MOST_LINE_WORDS] = {false};
    for (size_t at = lines->span.begin; gm_lines_next(text, lines->span.end, &at, &line, fault);) {
        const bool own = lines->choices && gm_span_among(text, line.word, own_words) <= WHEN;
        if (!pass(&blocks, &line, own, fault) ||
            !(own || gm_line_find(lines->words, text, &line, &word, fault))) {
            return false;
        }
        if (!own && blocks.open && !(words[word].kinds & lines->inside)) {
            return gm_fail(fault, line.word.begin,
                           "this line cannot depend on a choice: write it outside of blocks");
        }
        if (own || (blocks.open && !blocks.holds)) {
            continue;
        }
        if (chosen && words[word].identity != GM_LINE_ADDED) {
            const struct heading heading = {text, {0, 0}, word, lines->count, blocks.open};
            count = add_headings(headings, count, heading, line.value, words[word].identity == GM_LINE_NAMED);
        }
        lines->list[lines->count++] = (struct gm_read_line){word, line.word.begin, line.value};
    }
    if (fault->sentence[0] || !end_block(&blocks, fault)) {
        return false;
    }
    remove_replaced(lines, headings, count);
    for (size_t i = 0; i < lines->count; i++) {
        word = lines->list[i].word;
        if (given[word] && words[word].identity == GM_LINE_ONCE) {
            return gm_fail(fault, lines->list[i].place, "%s: is given twice", words[word].word);
        }
        given[word] = true;
    }
    return true;
}

bool gm_lines_read(struct gm_read_lines *lines, struct gm_fault *fault)
{
    size_t most = 1;
    for (size_t i = lines->span.begin; i < lines->span.end; i++) {
        most += lines->text[i] == ':' || lines->text[i] == '=';
    }
    const bool chosen = lines->choices && lines->choices->count > 0;
    struct heading *headings = malloc((chosen ? most : 1) * sizeof *headings);
    lines->list = malloc(most * sizeof *lines->list);
    *fault = (struct gm_fault){0};
    const bool good = lines->list && headings && read_lines(lines, headings, fault);
    free(headings);
    if (!good) {
        free(lines->list);
        lines->list = NULL;
        lines->count = 0;
    }
    return good;
}
