/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choices of a text, and the lines that hold for their words. */
#include "core/expression/choices.h"

#include <stdio.h>
#include <string.h>

#include "core/expression/nearest.h"

static const char *const own_words[] = {"choice", "when", NULL};
enum { CHOICE, WHEN };

static bool is_same(const char *text, struct gm_span a, struct gm_span b)
{
    return a.end - a.begin == b.end - b.begin && memcmp(text + a.begin, text + b.begin, a.end - a.begin) == 0;
}

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

static size_t find(const char *word, size_t count, const char *(*at)(size_t i, const void *data),
                   const void *data)
{
    size_t i = 0;
    while (i < count && strcmp(at(i, data), word) != 0) {
        i++;
    }
    return i;
}

/* Finds a word among others; else false, with a fault that proposes the nearest. */
static bool seek(const char *text, struct gm_span span, size_t count,
                 const char *(*at)(size_t i, const void *data), const void *data, size_t *found,
                 struct gm_fault *fault)
{
    char word[GM_CHOICE_SIZE];
    *found = copy(text, span, word) ? find(word, count, at, data) : count;
    const char *near = *found < count ? NULL : gm_nearest(word, count, at, data);
    return *found < count ||
           gm_fail(fault, span.begin, "there is no %s \"%s\"%s%s", at == name_at ? "choice" : "word", word,
                   near ? "; did you mean " : "", near ? near : "");
}

const struct gm_written_choice *gm_choice_named(const struct gm_written_choices *choices, const char *name)
{
    const size_t found = find(name, choices->count, name_at, choices);
    return found < choices->count ? &choices->list[found] : NULL;
}

bool gm_choices_take(struct gm_written_choices *choices, const char *name, const char *word)
{
    struct gm_written_choice *choice = (struct gm_written_choice *)gm_choice_named(choices, name);
    const size_t found = choice ? find(word, choice->count, word_at, choice) : GM_MOST_CHOICE_WORDS;
    if (choice && found < choice->count) {
        choice->chosen = found;
    }
    return choice && found < choice->count;
}

/* NAME = WORD of WORD, WORD; meaning */
static bool read_choice(struct gm_written_choices *choices, const char *text, struct gm_span rest,
                        struct gm_fault *fault)
{
    struct gm_written_choice *choice = &choices->list[choices->count];
    struct gm_span head, word;
    if (choices->count == GM_MOST_CHOICES) {
        return gm_fail(fault, rest.begin, "a file has at most %d choices", GM_MOST_CHOICES);
    }
    gm_span_take(text, &rest, ";", &head);
    const size_t equals = gm_span_until(text, head, "="), of = gm_span_until(text, head, " of ");
    const struct gm_span name = gm_span_trimmed(text, (struct gm_span){head.begin, equals}),
                         standard = gm_span_trimmed(text, (struct gm_span){equals + 1, of});
    *choice = (struct gm_written_choice){.meaning = gm_span_trimmed(text, rest), .place = name.begin};
    bool good = copy(text, name, choice->name) &&
                strlen(choice->name) == gm_name_length(choice->name, strlen(choice->name));
    for (struct gm_span list = {of + 4, head.end}; good && gm_span_take(text, &list, ",", &word);) {
        good = choice->count < GM_MOST_CHOICE_WORDS && copy(text, word, choice->words[choice->count]);
        if (good && find(choice->words[choice->count], choice->count, word_at, choice) < choice->count) {
            return gm_fail(fault, word.begin, "%s is named twice", choice->words[choice->count]);
        }
        choice->count += good;
    }
    if (!good || choice->count < 2) {
        return gm_fail(fault, name.begin,
                       "a choice has a name and 2 to 16 words: system = harmonic of harmonic, pendulum");
    }
    if (gm_choice_named(choices, choice->name)) {
        return gm_fail(fault, name.begin, "%s is defined twice", choice->name);
    }
    choices->count++;
    return seek(text, standard, choice->count, word_at, choice, &choice->standard, fault) &&
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
    size_t number;
    if (!end_block(blocks, fault)) {
        return false;
    }
    if (gm_span_among(text, rest, always) == 0) {
        blocks->open = NULL;
        return true;
    }
    gm_span_take(text, &rest, "=", &name);
    if (!seek(text, name, blocks->choices->count, name_at, blocks->choices, &number, fault)) {
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
        if (!seek(text, word, choice->count, word_at, choice, &number, fault)) {
            return false;
        }
        blocks->holds = blocks->holds || number == choice->chosen;
    } while (rest.begin < rest.end);
    return true;
}

static bool pass(struct blocks *blocks, const struct gm_text_line *line, struct gm_fault *fault)
{
    const size_t word = gm_span_among(blocks->text, line->word, own_words);
    if (word == WHEN) {
        return begin_block(blocks, line->value, fault);
    }
    blocks->empty = false;
    return word != CHOICE || !blocks->open ||
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

/* The text before the = of an assignment; empty without an =. */
static struct gm_span name_of(const char *text, struct gm_span piece)
{
    const size_t equals = gm_span_until(text, piece, "=");
    return gm_span_trimmed(text, (struct gm_span){piece.begin, equals < piece.end ? equals : piece.begin});
}

/* True if two lines assign to one name. */
static bool share_name(const char *text, struct gm_span a, struct gm_span b)
{
    struct gm_span one, other;
    for (a = assignments(text, a); gm_span_take(text, &a, ",", &one);) {
        const struct gm_span name = name_of(text, one);
        for (struct gm_span rest = assignments(text, b); gm_span_take(text, &rest, ",", &other);) {
            if (name.begin < name.end && is_same(text, name, name_of(text, other))) {
                return true;
            }
        }
    }
    return false;
}

/* True if a line of a block replaces this line outside of blocks. */
static bool is_replaced(const struct gm_written_choices *choices, const char *text, size_t length,
                        const struct gm_text_line *outside, bool named)
{
    struct blocks blocks = {.choices = choices, .text = text};
    struct gm_text_line line;
    struct gm_fault fault;
    for (size_t at = 0; gm_lines_next(text, length, &at, &line, &fault) && pass(&blocks, &line, &fault);) {
        if (blocks.open && blocks.holds && is_same(text, line.word, outside->word) &&
            (!named || share_name(text, line.value, outside->value))) {
            return true;
        }
    }
    return false;
}

bool gm_choices_apply(const struct gm_written_choices *choices, char *text, size_t length,
                      enum gm_line_identity (*identity)(const char *text, struct gm_span word),
                      struct gm_fault *fault)
{
    struct blocks blocks;
    struct gm_text_line line;
    for (int last = 0; last < 2; last++) { /* replaced lines go while all blocks still exist */
        blocks = (struct blocks){.choices = choices, .text = text};
        for (size_t at = 0; gm_lines_next(text, length, &at, &line, fault);) {
            if (!pass(&blocks, &line, fault)) {
                return false;
            }
            const enum gm_line_identity own = identity(text, line.word);
            const bool replaced = choices->count > 0 && !blocks.open && own != GM_LINE_ADDED &&
                                  is_replaced(choices, text, length, &line, own == GM_LINE_NAMED);
            const bool passed =
                gm_span_among(text, line.word, own_words) <= WHEN || (blocks.open && !blocks.holds);
            for (size_t i = line.word.begin; (last ? passed : replaced) && i < line.value.end; i++) {
                text[i] = text[i] == '\n' || text[i] == '\r' ? text[i] : '#';
            }
        }
        if (!end_block(&blocks, fault)) {
            return false;
        }
    }
    return true;
}
