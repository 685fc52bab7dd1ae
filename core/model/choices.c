/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choices of a text, and the lines that hold for their words. */
#include "core/model/choices.h"

#include <stdarg.h>
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

/* The names of choices, or the words of one. */
struct list {
    const char *what, *first;
    size_t count, apart; /* number of bytes from one to the next */
};

static const char *member(size_t i, const void *list)
{
    return ((const struct list *)list)->first + i * ((const struct list *)list)->apart;
}

static struct list names_of(const struct gm_written_choices *choices)
{
    return (struct list){"choice", choices->list[0].name, choices->count, sizeof choices->list[0]};
}

static struct list words_of(const struct gm_written_choice *choice)
{
    return (struct list){"word", choice->words[0], choice->count, sizeof choice->words[0]};
}

static size_t find(const char *word, struct list list)
{
    size_t i = 0;
    while (i < list.count && strcmp(member(i, &list), word) != 0) {
        i++;
    }
    return i;
}

/* Leaves the body of the arena with a fault if something is wrong. */
__attribute__((format(printf, 4, 5))) static void refuse_if(const struct gm_read_lines *lines, bool wrong,
                                                            size_t place, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (wrong) {
        *lines->fault = (struct gm_fault){.offset = place};
        vsnprintf(lines->fault->sentence, sizeof lines->fault->sentence, format, arguments);
        gm_arena_leave(lines->arena);
    }
    va_end(arguments);
}

/* Finds a word among others, or proposes the nearest. */
static size_t seek(const struct gm_read_lines *lines, struct gm_span span, struct list list)
{
    char word[GM_CHOICE_SIZE];
    refuse_if(lines, span.begin == span.end, span.begin, "a %s was expected", list.what);
    const size_t found = copy(lines->text, span, word) ? find(word, list) : list.count;
    const char *near = found < list.count ? NULL : gm_nearest(word, list.count, member, &list);
    refuse_if(lines, found == list.count, span.begin, "there is no %s \"%s\"%s%s", list.what, word,
              near ? "; did you mean " : "", near ? near : "");
    return found;
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
static void read_words(const struct gm_read_lines *lines, struct gm_written_choice *choice,
                       struct gm_span list)
{
    struct gm_span word;
    while (gm_span_take(lines->text, &list, ",", &word)) {
        refuse_if(lines, choice->count == GM_MOST_CHOICE_WORDS, word.begin, "a choice has at most %d words",
                  GM_MOST_CHOICE_WORDS);
        char *copied = choice->words[choice->count];
        refuse_if(lines, !copy(lines->text, word, copied), word.begin,
                  "a word of a choice has 1 to %d bytes without blanks, quotes, # and =", GM_CHOICE_SIZE - 1);
        refuse_if(lines, find(copied, words_of(choice)) < choice->count, word.begin, "%s is named twice",
                  copied);
        choice->count++;
    }
    refuse_if(lines, choice->count < 2, choice->place, "a choice has at least two words");
}

/* NAME = WORD of WORD, WORD; meaning */
static void read_choice(const struct gm_read_lines *lines, struct gm_span rest)
{
    struct gm_written_choices *choices = lines->choices;
    struct gm_written_choice *choice = &choices->list[choices->count];
    const char *text = lines->text;
    struct gm_span head;
    refuse_if(lines, choices->count == GM_MOST_CHOICES, rest.begin, "a file has at most %d choices",
              GM_MOST_CHOICES);
    gm_span_take(text, &rest, ";", &head);
    const size_t equals = gm_span_until(text, head, "="), of = gm_span_until(text, head, " of ");
    const struct gm_span name = gm_span_trimmed(text, (struct gm_span){head.begin, equals}),
                         standard = gm_span_trimmed(text, (struct gm_span){equals + 1, of});
    *choice = (struct gm_written_choice){.meaning = gm_span_trimmed(text, rest), .place = name.begin};
    refuse_if(lines, of == head.end || equals > of, head.begin,
              "a choice has a name, a default and words: system = harmonic of harmonic, pendulum");
    refuse_if(lines,
              !copy(text, name, choice->name) ||
                  strlen(choice->name) != gm_name_length(choice->name, strlen(choice->name)),
              name.begin, "the name of a choice has 1 to %d letters, digits and _", GM_CHOICE_SIZE - 1);
    refuse_if(lines, gm_choice_named(choices, choice->name), name.begin, "%s is defined twice", choice->name);
    choices->count++;
    read_words(lines, choice, (struct gm_span){of + 4, head.end});
    choice->chosen = choice->standard = seek(lines, standard, words_of(choice));
}

void gm_choices_read(const struct gm_read_lines *lines)
{
    struct gm_text_line line;
    *lines->choices = (struct gm_written_choices){0};
    for (size_t at = 0; gm_lines_next(lines->text, lines->span.end, &at, &line, lines->fault);) {
        if (gm_span_among(lines->text, line.word, own_words) == CHOICE) {
            read_choice(lines, line.value);
        }
    } /* gm_lines_read refuses a faulty line */
}

/* The block that is open while lines are read. */
struct block {
    const struct gm_written_choice *choice; /* NULL: none is open */
    bool holds, empty;
    size_t place; /* byte offset where it begins */
};

static void end_block(const struct gm_read_lines *lines, const struct block *block)
{
    refuse_if(lines, block->choice && block->empty, block->place,
              "this block has no lines: write the lines for these words below it");
}

/* NAME = WORD, WORD or always */
static void begin_block(const struct gm_read_lines *lines, struct block *block, struct gm_span rest)
{
    struct gm_span name, word;
    end_block(lines, block);
    if (gm_span_is(lines->text, rest, "always")) {
        block->choice = NULL;
        return;
    }
    gm_span_take(lines->text, &rest, "=", &name);
    const struct gm_written_choice *choice =
        &lines->choices->list[seek(lines, name, names_of(lines->choices))];
    refuse_if(lines, block->choice && block->choice != choice, name.begin,
              "a block of %s is inside one of %s: end that by \"when: always\"", choice->name,
              block->choice ? block->choice->name : "");
    *block = (struct block){choice, false, true, name.begin};
    do {
        gm_span_take(lines->text, &rest, ",", &word);
        block->holds |= seek(lines, word, words_of(choice)) == choice->chosen;
    } while (rest.begin < rest.end);
}

/* Takes a line choice: or when: itself. Returns false for another one. */
static bool take_own(const struct gm_read_lines *lines, struct block *block, const struct gm_text_line *line)
{
    const size_t own = lines->choices ? gm_span_among(lines->text, line->word, own_words) : WHEN + 1;
    if (own == WHEN) {
        begin_block(lines, block, line->value);
        return true;
    }
    block->empty = false;
    refuse_if(lines, own == CHOICE && block->choice, line->word.begin,
              "a choice belongs outside of blocks: write \"when: always\" above it");
    return own == CHOICE;
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

void gm_lines_read(struct gm_read_lines *lines)
{
    const struct gm_line_word *words = lines->words->list;
    const char *text = lines->text;
    const bool chosen = lines->choices && lines->choices->count > 0;
    struct block block = {.choice = NULL};
    struct gm_text_line line;
    size_t most = 1, count = 0, word;
    bool given[GM_MOST_LINE_WORDS] = {false};
    for (size_t i = lines->span.begin; i < lines->span.end; i++) {
        most += text[i] == ':' || text[i] == '=';
    }
    lines->list = gm_arena_take(lines->arena, most, sizeof *lines->list);
    const size_t mark = gm_arena_mark(lines->arena);
    struct heading *headings = gm_arena_take(lines->arena, chosen ? most : 1, sizeof *headings);
    for (size_t at = lines->span.begin; gm_lines_next(text, lines->span.end, &at, &line, lines->fault);) {
        if (take_own(lines, &block, &line)) {
            continue;
        }
        if (!gm_line_find(lines->words, text, &line, &word, lines->fault)) {
            gm_arena_leave(lines->arena);
        }
        refuse_if(lines, block.choice && !(words[word].kinds & lines->inside), line.word.begin,
                  "this line cannot depend on a choice: write it outside of blocks");
        if (block.choice && !block.holds) {
            continue;
        }
        if (chosen && words[word].identity != GM_LINE_ADDED) {
            const struct heading heading = {text, {0, 0}, word, lines->count, block.choice};
            count = add_headings(headings, count, heading, line.value, words[word].identity == GM_LINE_NAMED);
        }
        lines->list[lines->count++] = (struct gm_read_line){word, line.word.begin, line.value};
    }
    if (lines->fault->sentence[0]) {
        gm_arena_leave(lines->arena);
    }
    end_block(lines, &block);
    remove_replaced(lines, headings, count);
    gm_arena_release(lines->arena, mark);
    for (size_t i = 0; i < lines->count; i++) {
        word = lines->list[i].word;
        refuse_if(lines, given[word] && words[word].identity == GM_LINE_ONCE, lines->list[i].place,
                  "%s: is given twice", words[word].word);
        given[word] = true;
    }
}
