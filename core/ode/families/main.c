/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program that the build runs: writes schemes of share/schemes as rows of the families that advance them, and the
   texts of other rows.
   Usage: write_schemes implicit|splitting|corrected|compositions OUT.def NAME.scheme ...
          write_schemes texts OUT.h schemes.text
   The coefficients of each row, as the doubles of their formulas, are a constant of the family's type, and the rows are
       #define GM_SCHEMES_implicit {members of struct gm_scheme}, ...
   A composition of Verlet's method is
       GM_COMPOSITION(identifier, steps)
   The texts of a row, and the rows of a family that are named there, are
       #define GM_TEXTS_identifier members of struct gm_scheme
       #define GM_SCHEMES_family {GM_TEXTS_identifier}, ... */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/lines.h"
#include "core/files/generated.h"
#include "core/model/written_scheme.h"
#include "core/scheme.h"

static void put_numbers(FILE *out, const struct gm_written_number *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        fprintf(out, "%s%a", i ? ", " : "{", numbers[i].value);
    }
    fputs("}", out);
}

static void put_tableau(FILE *out, const struct gm_written_scheme *scheme)
{
    const struct gm_written_line *a = &scheme->lines[GM_SCHEME_WORD_A];
    fprintf(out, ".stages = %d, .a = {", a->rows);
    for (int i = 0; i < a->rows; i++) {
        fputs(i ? ", " : "", out);
        put_numbers(out, a->numbers + i * a->columns, a->columns);
    }
    fputs("}, .b = ", out);
    put_numbers(out, scheme->lines[GM_SCHEME_WORD_B].numbers, a->rows);
    fputs(", .composition = &gm_composition_none", out);
}

static void put_piece(FILE *out, int i, bool kick, double fraction)
{
    fprintf(out, "%s{%s, %a}", i ? ", " : "", kick ? "GM_KICK" : "GM_DRIFT", fraction);
}

static void put_pieces(FILE *out, const struct gm_written_scheme *scheme)
{
    const struct gm_written_line *drifts = &scheme->lines[GM_SCHEME_WORD_DRIFTS],
                                 *kicks = &scheme->lines[GM_SCHEME_WORD_KICKS];
    const int count = drifts->columns + kicks->columns;
    fprintf(out, "%d, {", count);
    for (int i = 0; i < count; i++) {
        const bool kick = (i % 2 == 0) == scheme->kick_first;
        put_piece(out, i, kick, (kick ? kicks : drifts)->numbers[i / 2].value);
    }
    fputs("}", out);
}

/* A composition of Verlet's method (kick, drift, kick) with neighbouring kicks merged. */
static void put_pieces_of_verlet(FILE *out, const struct gm_written_line *steps)
{
    double before = 0;
    fprintf(out, "%d, {", 2 * steps->columns + 1);
    for (int i = 0; i < steps->columns; i++) {
        const double fraction = steps->numbers[i].value;
        put_piece(out, i, true, (before + fraction) / 2);
        put_piece(out, 1, false, fraction);
        before = fraction;
    }
    put_piece(out, 1, true, before / 2);
    fputs("}", out);
}

/* The steps of a symmetric composition, as far as the middle one. */
static void put_composition(FILE *out, const struct gm_written_line *steps)
{
    fprintf(out, "{%d, ", steps->columns);
    put_numbers(out, steps->numbers, (steps->columns + 1) / 2);
    fputs("}", out);
}

/* Writes a value as a member of the row. A further line that begins with " | " begins a line of the text, another one
   continues it. */
static void put_text(FILE *out, const char *member, const char *text, struct gm_span value)
{
    char *copy = strndup(text + value.begin, value.end - value.begin);
    size_t length = 0;
    fprintf(out, ", .%s = ", member);
    for (const char *at = copy; at && *at; at++) {
        const size_t between = *at == '\n' ? 1 + strspn(at + 1, " ") : 0;
        at += between;
        if (between > 0 && *at == '|') {
            gm_string_put(out, copy, length);
            fputs(" \"\\n\" ", out);
            length = 0;
            at += 2;
        } else if (between > 0) {
            copy[length++] = ' ';
        }
        copy[length++] = *at;
    }
    if (copy) {
        gm_string_put(out, copy, length);
    }
    free(copy);
}

static void put_line(FILE *out, const struct gm_written_scheme *scheme, enum gm_scheme_word word,
                     const char *member)
{
    if (scheme->lines[word].said) {
        put_text(out, member, scheme->text, scheme->lines[word].value);
    }
}

static bool is_text(const struct gm_written_scheme *scheme, enum gm_scheme_word word, const char *text)
{
    return scheme->lines[word].said && gm_span_is(scheme->text, scheme->lines[word].value, text);
}

enum family { IMPLICIT, SPLITTING, CORRECTED, COMPOSITIONS, TEXTS, FAMILIES };
static const struct {
    const char *name, *family, *type, *prefix, *head; /* the head of the coefficients */
} families[FAMILIES] = {
    {"implicit", "implicit", "const struct gm_tableau", "gm_implicit_", ""},
    {"splitting", "splitting", "static const struct gm_splitting", "", ""},
    {"corrected", "parts", "static const struct gm_parts_row", "",
     ".parts = 2, .list = {{.name = \"kinetic\"}, {.name = \"potential\"}}, "},
    {.name = "compositions"},
    {.name = "texts"},
};

/* The name of a scheme, and words behind it, as an identifier. */
static char *identifier_of(char identifier[64], const char *name, size_t length)
{
    snprintf(identifier, 64, "%.*s", (int)length, name);
    for (char *at = identifier; (at = strpbrk(at, "- "));) {
        *at = '_';
    }
    return identifier;
}

/* Returns true if the steps are palindromic: a row holds half of them. */
static bool is_symmetric(const struct gm_written_line *steps)
{
    bool same = true;
    for (int i = 0; i < steps->columns; i++) {
        same = same && steps->numbers[i].value == steps->numbers[steps->columns - 1 - i].value;
    }
    return same && steps->columns % 2 == 1;
}

static void put_coefficients(FILE *out, const struct gm_written_scheme *scheme, const char *identifier,
                             enum family family)
{
    const struct gm_written_line *corrector = &scheme->lines[GM_SCHEME_WORD_CORRECTOR],
                                 *steps = &scheme->lines[GM_SCHEME_WORD_STEPS];
    fprintf(out, "%s %s%s = {%s", families[family].type, families[family].prefix, identifier,
            families[family].head);
    if (is_text(scheme, GM_SCHEME_WORD_BASE, "verlet")) {
        put_pieces_of_verlet(out, steps);
    } else if (is_text(scheme, GM_SCHEME_WORD_BASE, "midpoint")) {
        fputs(".stages = 1, .a = {{0.5}}, .b = {1}, .composition = &(const struct gm_composition)", out);
        put_composition(out, steps);
    } else if (family == CORRECTED) {
        fputs(".splitting = {", out);
        put_pieces(out, scheme);
        fprintf(out, "}, .corrector = %a", corrector->numbers[0].value);
    } else if (family == SPLITTING) {
        put_pieces(out, scheme);
    } else {
        put_tableau(out, scheme);
    }
    fputs("};\n", out);
}

/* Writes the scheme if the family advances it: its coefficients, or its row. False if it cannot be a row. */
static bool put_scheme(FILE *out, const struct gm_written_scheme *scheme, const char *name,
                       enum family family, bool row)
{
    const bool of_verlet = is_text(scheme, GM_SCHEME_WORD_BASE, "verlet"),
               of_midpoint = is_text(scheme, GM_SCHEME_WORD_BASE, "midpoint");
    const struct gm_span claimed = scheme->lines[GM_SCHEME_WORD_CLAIMS].value;
    unsigned claims = 0;
    size_t wrong;
    char identifier[64];
    identifier_of(identifier, name, strlen(name));
    if (!gm_claims_read(scheme->text + claimed.begin, claimed.end - claimed.begin, &claims, &wrong) ||
        (scheme->kind == GM_WRITTEN_COMPOSITION
             ? !(of_verlet || of_midpoint) || !is_symmetric(&scheme->lines[GM_SCHEME_WORD_STEPS])
             : scheme->kind != GM_WRITTEN_RUNGE_KUTTA && scheme->kind != GM_WRITTEN_SPLITTING)) {
        return false;
    }
    const bool splitting = scheme->kind == GM_WRITTEN_SPLITTING || of_verlet;
    if (family == COMPOSITIONS && of_verlet && !row) {
        fprintf(out, "GM_COMPOSITION(%s, ", identifier);
        put_composition(out, &scheme->lines[GM_SCHEME_WORD_STEPS]);
        fputs(")\n", out);
    }
    const bool corrected = scheme->lines[GM_SCHEME_WORD_CORRECTOR].said;
    if (family != (corrected ? CORRECTED : splitting ? SPLITTING : IMPLICIT)) {
        return true;
    }
    if (!row) {
        put_coefficients(out, scheme, identifier, family);
        return true;
    }
    fprintf(out,
            " {.family = &gm_family_%s, .coefficients = &%s%s, .name = \"%s\", .order = %d, .claims = %#x",
            families[family].family, families[family].prefix, identifier, name, scheme->order, claims);
    fputs(corrected ? ", .needs = GM_NEEDS_PARTS" : splitting ? ", .needs = GM_NEEDS_SPLIT" : "", out);
    fputs(scheme->nystrom || corrected ? " | GM_NEEDS_NYSTROM" : "", out);
    put_line(out, scheme, GM_SCHEME_WORD_TITLE, "title");
    put_line(out, scheme, GM_SCHEME_WORD_FORMULA, "formula");
    put_line(out, scheme, GM_SCHEME_WORD_REFERENCE, "reference");
    fputs("},", out);
    return true;
}

/* The lines of a list of rows. */
enum { SCHEME, FAMILY = 4, ROW, NEEDS, ORDER, CLAIMS, FACET, STRUCTURE, PROBLEMS, WORDS };
static const char *const words[] = {"scheme", "title",  "formula", "reference", "family",   "row", "needs",
                                    "order",  "claims", "facet",   "structure", "problems", NULL};

static const char *const with_rows[] = {
#define GM_FAMILY(name) #name,
#include "core/ode/families/families.def"
#undef GM_FAMILY
    NULL};

static void put_facet(FILE *out, const char *text, struct gm_span facet)
{
    fputs("GM_NEEDS_", out);
    for (size_t i = facet.begin; i < facet.end; i++) {
        fputc(toupper((unsigned char)text[i]), out);
    }
}

static void put_needs(FILE *out, const char *text, struct gm_span rest)
{
    const char *before = ", .needs = ";
    for (struct gm_span need; gm_span_take(text, &rest, ",", &need); before = " | ") {
        fputs(before, out);
        put_facet(out, text, need);
    }
}

/* Writes the words of facets as members of struct gm_facet_words. */
static void put_facets(FILE *out, const char *text, size_t length, struct gm_fault *fault)
{
    struct gm_text_line line;
    const char *before = "\n#define GM_FACET_WORDS {";
    for (size_t at = 0; gm_lines_next(text, length, &at, &line, fault);) {
        const size_t word = gm_span_among(text, line.word, words);
        if (word == FACET) {
            fputs(before, out);
            before = " {";
            put_facet(out, text, line.value);
        } else if (word == STRUCTURE || word == PROBLEMS) {
            put_text(out, words[word], text, line.value);
            fputs(word == PROBLEMS ? "}," : "", out);
        }
    }
}

/* Writes the rows that name a family, in their order. */
static void put_rows(FILE *out, const char *text, size_t length, const char *family, struct gm_fault *fault)
{
    struct gm_text_line line;
    char identifier[64] = "";
    bool begun = false;
    for (size_t at = 0; gm_lines_next(text, length, &at, &line, fault);) {
        if (gm_span_is(text, line.word, words[SCHEME])) {
            identifier_of(identifier, text + line.value.begin, line.value.end - line.value.begin);
        } else if (gm_span_is(text, line.word, words[FAMILY]) && gm_span_is(text, line.value, family)) {
            fprintf(out, "%s%s {GM_TEXTS_%s},", begun ? "" : "\n#define GM_SCHEMES_", begun ? "" : family,
                    identifier);
            begun = true;
        }
    }
}

/* Writes the texts of all rows of a list. False if a line has no meaning. */
static bool put_texts(FILE *out, const char *text, size_t length, struct gm_fault *fault)
{
    struct gm_text_line line;
    for (size_t at = 0; gm_lines_next(text, length, &at, &line, fault);) {
        const char *value = text + line.value.begin;
        const size_t size = line.value.end - line.value.begin, word = gm_span_among(text, line.word, words);
        unsigned claims;
        size_t wrong;
        char identifier[64];
        if (word == WORDS || (word == CLAIMS && !gm_claims_read(value, size, &claims, &wrong)) ||
            (word == FAMILY && gm_span_among(text, line.value, with_rows) == GM_COUNT(with_rows) - 1)) {
            snprintf(fault->sentence, sizeof fault->sentence, "%.*s is not such a line", (int)size, value);
            return false;
        }
        if (word == SCHEME) {
            const char *further = memchr(value, ' ', size);
            fprintf(out, "\n#define GM_TEXTS_%s .name = \"%.*s\"", identifier_of(identifier, value, size),
                    (int)(further ? further - value : (ptrdiff_t)size), value);
        } else if (word == FAMILY) {
            fprintf(out, ", .family = &gm_family_%.*s", (int)size, value);
        } else if (word == ROW) {
            fprintf(out, ", .coefficients = &%.*s", (int)size, value);
        } else if (word == NEEDS) {
            put_needs(out, text, line.value);
        } else if (word >= FACET) {
            continue;
        } else if (word == ORDER) {
            fprintf(out, ", .order = %.*s", (int)size, value);
        } else if (word == CLAIMS) {
            fprintf(out, ", .claims = %#x", claims);
        } else {
            put_text(out, words[word], text, line.value);
        }
    }
    put_facets(out, text, length, fault);
    for (size_t i = 0; with_rows[i]; i++) {
        put_rows(out, text, length, with_rows[i], fault);
    }
    return !fault->sentence[0];
}

static bool put_file(FILE *out, const char *path, enum family family, bool row)
{
    size_t length = 0;
    char *text = gm_input_read(path, &length), name[64];
    const char *slash = strrchr(path, '/');
    snprintf(name, sizeof name, "%.*s", (int)strcspn(slash ? slash + 1 : path, "."),
             slash ? slash + 1 : path);
    struct gm_written_scheme scheme = {.text = NULL};
    struct gm_fault fault = {.sentence = "it could not be read"};
    const bool put = text && (family == TEXTS ? put_texts(out, text, length, &fault)
                                              : gm_written_open(&scheme, text, 0, length, NULL, &fault) &&
                                                    put_scheme(out, &scheme, name, family, row));
    if (!put) {
        fprintf(stderr, "%s: %s\n", path, fault.sentence[0] ? fault.sentence : "it is not a row of a family");
    }
    gm_written_close(&scheme);
    free(text);
    return put;
}

int main(int argc, char *argv[])
{
    enum family family = 0;
    while (argc > 3 && family < FAMILIES && strcmp(argv[1], families[family].name) != 0) {
        family++;
    }
    FILE *out = argc > 3 && family < FAMILIES ? fopen(argv[2], "w") : NULL;
    bool good = out != NULL;
    for (int i = 3; i < argc && good; i++) {
        good = put_file(out, argv[i], family, false);
    }
    if (good && families[family].type) {
        fprintf(out, "#define GM_SCHEMES_%s", families[family].name);
    }
    for (int i = 3; i < argc && good && families[family].type; i++) {
        good = put_file(out, argv[i], family, true);
    }
    if (good) {
        fputc('\n', out); /* compilers warn of a last line that does not end */
    }
    return out && fclose(out) == 0 && good ? EXIT_SUCCESS : EXIT_FAILURE;
}
