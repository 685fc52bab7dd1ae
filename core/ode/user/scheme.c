/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From coefficients to rows: a tableau is one of the explicit or of the implicit family, drifts and kicks are
   a splitting, and so is a composition of splittings, whose pieces that meet are one; every other composition
   is a list of substeps. The adjoint, the inverse of the step backwards, of
       y1 = y0 + h sum b_i f(Y_i)    has    a*_ij = b_j' - a_i'j',  b*_i = b_i',  i' = s + 1 - i,
   that of a composition consists of the adjoints in the opposite order. A processed method is the composition
   of the processor's inverse, its adjoint by -h, of the kernel and of the processor. Hairer, Lubich & Wanner
   (2006), sections II.3, II.4, V.2, V.3.3. */
#include "core/ode/user/scheme.h"
#include "core/basics.h"
#include "core/expression/number.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/aliases.h"
#include "core/arena.h"
#include "core/expression/reader.h"
#include "core/ode/families/composition.h"
#include "core/ode/families/families.h"
#include "core/ode/families/invariants/held.h"
#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/splitting/parts.h"
#include "core/schemes.h"
#include "core/theory/theory.h"

/* The most nested schemes; the most stages of a scheme in theory. */
enum { DEEPEST = 8, MOST_STAGES = 256 };

/* A row with its coefficients. */
struct own {
    struct gm_scheme row; /* first */
    struct gm_coefficients exact;
    void *coefficients;
    struct gm_arena *arena; /* the opened scheme's: owns all its parts */
};

/* The schemes that a line names. */
struct named {
    int count;
    const struct gm_scheme **at;
};

/* The body of an arena, which a fault leaves; the sentence is empty when out of memory. */
struct making {
    const struct gm_user_scheme_source *source;
    struct gm_fault *fault;
    struct gm_arena *arena;
    const struct gm_written_scheme *written; /* the part of the text that is made at this depth */
    struct named schemes[GM_SCHEME_WORDS];   /* that its lines name */
    int depth;
    bool by_names;    /* kinetic and potential are parts of the system's own, not its drift and its kick */
    bool *names_both; /* set if the two names are those of the drift and the kick */
    struct gm_coefficients *moved; /* of the whole scheme, each with one decimal moved */
    int moved_count;
    struct own *made; /* the whole scheme */
};

_Noreturn __attribute__((format(printf, 3, 4))) static void fail(const struct making *making, size_t place,
                                                                 const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(making->fault->sentence, sizeof making->fault->sentence, format, arguments);
    va_end(arguments);
    making->fault->offset = place;
    gm_arena_leave(making->arena);
}

static void close_user(void *scheme)
{
    gm_arena_close(((struct own *)scheme)->arena);
}

void gm_user_scheme_close(const struct gm_scheme *scheme)
{
    if (scheme) {
        close_user((void *)scheme);
    }
}

static const struct gm_written_line *line_of(const struct making *making, enum gm_scheme_word word)
{
    return &making->written->lines[word];
}

/* The first scheme that a line names; NULL: it names none. */
static const struct gm_scheme *first_of(const struct making *making, enum gm_scheme_word word)
{
    const struct named *named = &making->schemes[word];
    return named->count > 0 ? named->at[0] : NULL;
}

/* The text of a span, with single blanks. */
static char *words_of(const struct making *making, struct gm_span span)
{
    return gm_arena_keep(making->arena, gm_span_words(making->source->text, span), free);
}

static struct own *open_user(const struct making *making, size_t coefficients)
{
    struct own *self = gm_arena_take(making->arena, 1, sizeof *self);
    self->coefficients = gm_arena_take(making->arena, 1, coefficients);
    self->row.coefficients = self->coefficients;
    return self;
}

/* ---- tableaus ---- */

/* Writes `rows` rows of numbers to a row's arrays, and as balls one after the other. */
static void put(const struct gm_written_number *numbers, int rows, int columns,
                double (*to)[GM_TABLEAU_STAGES], struct gm_ball *exact)
{
    for (int i = 0; i < rows * columns; i++) {
        to[i / columns][i % columns] = numbers[i].value;
        exact[i] = numbers[i].ball;
    }
}

/* The row of a tableau with these coefficients; its family follows from them. */
static struct own *close_tableau(struct own *self, const struct gm_tableau *tableau)
{
    bool is_explicit = true;
    for (int i = 0; i < tableau->stages; i++) {
        for (int j = i; j < tableau->stages; j++) {
            is_explicit = is_explicit && tableau->a[i][j] == 0;
        }
    }
    struct gm_tableau *row = self->coefficients;
    *row = *tableau;
    row->composition = is_explicit ? NULL : &gm_composition_none;
    self->row.family = is_explicit ? &gm_family_explicit : &gm_family_implicit;
    return self;
}

static struct own *make_runge_kutta(const struct making *making)
{
    const struct gm_written_line *lines = making->written->lines;
    const int stages = lines[GM_SCHEME_WORD_A].rows;
    struct own *self = open_user(making, sizeof(struct gm_tableau));
    struct gm_tableau tableau = {.stages = stages};
    gm_coefficients_open(making->arena, &self->exact, GM_EQUATIONS_PLAIN, stages);
    put(lines[GM_SCHEME_WORD_A].numbers, stages, stages, tableau.a, self->exact.a[0]);
    put(lines[GM_SCHEME_WORD_B].numbers, 1, stages, &tableau.b, self->exact.b[0]);
    return close_tableau(self, &tableau);
}

static struct own *make_partitioned(const struct making *making)
{
    const struct gm_written_line *lines = making->written->lines;
    const struct gm_written_number *b = lines[GM_SCHEME_WORD_B].numbers,
                                   *d = lines[GM_SCHEME_WORD_BH].numbers;
    const int stages = lines[GM_SCHEME_WORD_A].rows;
    struct own *self = open_user(making, sizeof(struct gm_partitioned_row));
    struct gm_coefficients *exact = &self->exact;
    gm_coefficients_open(making->arena, exact, GM_EQUATIONS_PARTITIONED, stages);
    struct gm_partitioned_row *row = self->coefficients;
    self->row.family = &gm_family_partitioned;
    self->row.needs = GM_NEEDS_HAMILTONIAN;
    row->stages = (size_t)stages;
    put(lines[GM_SCHEME_WORD_A].numbers, stages, stages, row->a, exact->a[GM_SIDE_Q]);
    put(lines[GM_SCHEME_WORD_AH].numbers, stages, stages, row->c, exact->a[GM_SIDE_P]);
    put(b, 1, stages, &row->b, exact->b[GM_SIDE_Q]);
    put(d ? d : b, 1, stages, &row->d, exact->b[GM_SIDE_P]);
    return self;
}

static struct own *make_nystrom(const struct making *making)
{
    const struct gm_written_line *lines = making->written->lines;
    const int stages = lines[GM_SCHEME_WORD_A].rows;
    const size_t s = (size_t)stages;
    struct own *self = open_user(making, sizeof(struct gm_nystrom_row));
    struct gm_nystrom_row *row = self->coefficients;
    struct gm_ball *a = gm_arena_take(making->arena, (s + 3) * s, sizeof *a), *b = a + s * s;
    self->row.family = &gm_family_nystrom;
    self->row.needs = GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM;
    row->stages = stages;
    put(lines[GM_SCHEME_WORD_A].numbers, stages, stages, row->a, a);
    put(lines[GM_SCHEME_WORD_B].numbers, 1, stages, &row->b, b);
    put(lines[GM_SCHEME_WORD_BV].numbers, 1, stages, &row->bv, b + s);
    put(lines[GM_SCHEME_WORD_C].numbers, 1, stages, &row->c, b + 2 * s);
    gm_coefficients_open_nystrom(making->arena, &self->exact, stages,
                                 &(struct gm_nystrom_balls){a, b, b + s, b + 2 * s});
    return self;
}

/* ---- splittings ---- */

struct pieces {
    int count;
    struct {
        enum gm_piece piece;
        struct gm_written_number fraction;
    } at[GM_SPLITTING_PIECES];
};

/* A short dyadic fraction, which is exact. */
static struct gm_written_number number_of(double value)
{
    return (struct gm_written_number){.value = value, .ball = gm_ball_of(value)};
}

/* Adds a piece; neighbours of one kind are merged. Returns false if there are too many. */
static bool add_piece(struct pieces *pieces, enum gm_piece piece, struct gm_written_number fraction)
{
    const int last = pieces->count - 1;
    if (last >= 0 && pieces->at[last].piece == piece) {
        pieces->at[last].fraction.value += fraction.value;
        pieces->at[last].fraction.ball = gm_ball_add(pieces->at[last].fraction.ball, fraction.ball);
        return true;
    }
    if (pieces->count == GM_SPLITTING_PIECES) {
        return false;
    }
    pieces->at[pieces->count].piece = piece;
    pieces->at[pieces->count++].fraction = fraction;
    return true;
}

/* The side of a piece in theory: the first of two names is that of drifts, and a name of its own that of kicks. NULL:
   pieces are drifts and kicks. */
static int side_of(const struct gm_parts_row *parts, enum gm_piece piece)
{
    const bool kick = parts ? strcmp(parts->list[piece].name, parts->list[0].name) != 0 : piece == GM_KICK;
    return kick ? GM_SIDE_P : GM_SIDE_Q;
}

/* True for parts of two names: what takes steps of a scheme and of its adjoint has one. */
static bool have_two_names(const struct gm_parts_row *parts)
{
    bool two = parts->parts > 1;
    for (size_t k = 2; k < parts->parts; k++) {
        two = two && (strcmp(parts->list[k].name, parts->list[0].name) == 0 ||
                      strcmp(parts->list[k].name, parts->list[1].name) == 0);
    }
    return two;
}

/* Returns the row of drifts and kicks; with `parts`, pieces are these parts by their numbers. */
static struct own *of_pieces(const struct making *making, const struct pieces *pieces, unsigned needs,
                             const struct gm_parts_row *parts)
{
    struct own *self = open_user(making, sizeof(struct gm_parts_row));
    struct gm_parts_row *row = self->coefficients;
    *row = parts ? *parts : (struct gm_parts_row){.parts = 0};
    struct gm_splitting *splitting = &row->splitting;
    bool exact = pieces->count <= MOST_STAGES && row->corrector == 0 && (!parts || have_two_names(parts));
    self->row.family = parts ? &gm_family_parts : &gm_family_splitting;
    self->row.needs = (parts ? GM_NEEDS_PARTS : GM_NEEDS_SPLIT) | needs;
    splitting->count = pieces->count;
    for (int i = 0; i < pieces->count; i++) {
        splitting->pieces[i].piece = pieces->at[i].piece;
        splitting->pieces[i].fraction = pieces->at[i].fraction.value;
    }
    if (!exact) {
        return self;
    }
    if (parts) { /* by exact flows */
        gm_coefficients_open(making->arena, &self->exact, GM_EQUATIONS_SEPARABLE, pieces->count);
    } else { /* the family places the fractions in a and b, and marks the force shared by consecutive steps */
        gm_family_splitting.coefficients_open(making->arena, &self->row, &self->exact);
    }
    for (int j = 0; j < pieces->count; j++) {
        const int side = side_of(parts, pieces->at[j].piece);
        self->exact.b[side][j] = pieces->at[j].fraction.ball;
        for (int i = j + 1; i < pieces->count; i++) {
            self->exact.a[side][i * pieces->count + j] = pieces->at[j].fraction.ball;
        }
    }
    return self;
}

/* The parts of a scheme of the family of splittings by parts; NULL: it has drifts and kicks. */
static const struct gm_parts_row *parts_of(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_parts ? scheme->coefficients : NULL;
}

/* Adds the pieces of a splitting, each times a fraction, forwards or backwards. */
static bool add_pieces(const struct making *making, struct pieces *pieces, const struct gm_scheme *scheme,
                       struct gm_written_number fraction, bool backwards)
{
    const struct gm_splitting *table = scheme->coefficients;
    struct gm_coefficients exact;
    const bool known = gm_scheme_coefficients_open(making->arena, scheme, &exact);
    for (int k = 0; k < table->count; k++) {
        const int i = backwards ? table->count - 1 - k : k;
        const int side = table->pieces[i].piece == GM_KICK ? GM_SIDE_P : GM_SIDE_Q;
        const struct gm_ball ball = known ? exact.b[side][i] : gm_ball_written(table->pieces[i].fraction);
        const struct gm_written_number product = {.value = table->pieces[i].fraction * fraction.value,
                                                  .ball = gm_ball_multiply(ball, fraction.ball)};
        if (!add_piece(pieces, table->pieces[i].piece, product)) {
            return false;
        }
    }
    return true;
}

static struct own *make_splitting(const struct making *making)
{
    const struct gm_written_line *drifts = line_of(making, GM_SCHEME_WORD_DRIFTS),
                                 *kicks = line_of(making, GM_SCHEME_WORD_KICKS),
                                 *corrector = line_of(making, GM_SCHEME_WORD_CORRECTOR);
    struct pieces pieces = {0};
    const int all = drifts->columns + kicks->columns;
    bool kick = making->written->kick_first;
    for (int i = 0; i < all; i++, kick = !kick) {
        const struct gm_written_number *number = (kick ? kicks : drifts)->numbers + i / 2;
        const bool only = i + 1 == all && pieces.count == 0;
        if (number->value != 0 || only) { /* zeros that fill up tables are skipped */
            add_piece(&pieces, kick ? GM_KICK : GM_DRIFT, *number);
        }
    }
    const struct gm_parts_row corrected = {.parts = 2,
                                           .list = {{.name = "kinetic"}, {.name = "potential"}},
                                           .corrector = corrector->said ? corrector->numbers[0].value : 0};
    return of_pieces(making, &pieces, making->written->nystrom || corrector->said ? GM_NEEDS_NYSTROM : 0,
                     corrector->said ? &corrected : NULL);
}

/* ---- splittings by parts ---- */

static struct own *adjoint_of(const struct making *making, const struct gm_scheme *scheme, size_t place);
static const struct gm_scheme *scheme_of(const struct making *making, struct gm_span span);

/* Refuses a scheme that cannot be a part of a step, with the reason. */
static void check_part(const struct making *making, const struct gm_scheme *scheme, size_t place)
{
    const struct gm_family *family = scheme->family;
    if (gm_scheme_composes(scheme)) {
        return;
    }
    fail(making, place, "%.60s cannot be a part of a step: %s", scheme->name,
         gm_holding_of(scheme) ? "whole steps are corrected, as in projected(composition(...); H, L)"
         : family->adaptive || family->by_tolerance ? "it is adaptive"
                                                    : "it carries data from one step to the next");
}

/* Reads NAME, or NAME by SCHEME. */
static struct gm_named_part read_part(const struct making *making, struct gm_span piece)
{
    const char *text = making->source->text;
    const size_t end = piece.begin + gm_name_length(text + piece.begin, piece.end - piece.begin);
    const struct gm_span given = {piece.begin, end},
                         by = gm_span_trimmed(text, (struct gm_span){end, piece.end});
    const bool typed = !making->source->title; /* not in a file */
    struct gm_named_part part = {.name = words_of(making, given), .column = typed ? piece.begin + 1 : 0};
    const bool nameless = end == piece.begin || strcmp(part.name, "by") == 0,
               written = strncmp(text + by.begin, "by ", 3) == 0;
    if (nameless || (by.begin < by.end && !written)) {
        fail(making, nameless ? piece.begin : by.begin,
             "a part is a name, or NAME by SCHEME, as in A by gauss4");
    }
    if (written && by.begin < by.end) {
        const struct gm_span scheme = gm_span_trimmed(text, (struct gm_span){by.begin + 3, by.end});
        part.by = scheme_of(making, scheme);
        check_part(making, part.by, scheme.begin);
    }
    return part;
}

static void read_parts(const struct making *making, struct gm_span rest, struct gm_parts_row *row)
{
    struct gm_span piece;
    const size_t end = rest.end;
    for (; gm_span_take(making->source->text, &rest, ",", &piece); row->parts++) {
        if (piece.begin == piece.end || (rest.begin == end && making->source->text[end - 1] == ',')) {
            fail(making, piece.begin, "a part has no name: it is missing beside this comma");
        }
        if (row->parts == GM_MOST_PARTS / 2) {
            fail(making, piece.begin, "a splitting has at most %d parts", GM_MOST_PARTS / 2);
        }
        row->list[row->parts] = read_part(making, piece);
        for (size_t i = 0; i < row->parts; i++) {
            if (strcmp(row->list[i].name, row->list[row->parts].name) == 0) {
                fail(making, piece.begin, "the part %.40s is given twice", row->list[i].name);
            }
        }
    }
}

/* A part's steps sum to 1. */
static void check_parts(const struct making *making, const struct gm_parts_row *row,
                        const struct pieces *pieces, size_t place)
{
    for (size_t k = 0; k < row->parts; k++) {
        double sum = 0;
        for (int i = 0; i < pieces->count; i++) {
            sum += (size_t)pieces->at[i].piece == k ? pieces->at[i].fraction.value : 0;
        }
        if (fabs(sum - 1) > 1e-3) {
            fail(making, place, "the steps of %.40s sum to %.15g, not to 1", row->list[k].name, sum);
        }
    }
}

/* The palindrome of half steps; in its second half a part by a scheme takes steps of the adjoint. */
static void put_strang(const struct making *making, struct gm_parts_row *row, struct pieces *pieces,
                       size_t place)
{
    const size_t count = row->parts;
    size_t mirrored[GM_MOST_PARTS];
    for (size_t k = 0; k < count; k++) {
        const struct gm_scheme *by = row->list[k].by;
        mirrored[k] = k;
        if (by && !(by->claims & GM_SYMMETRIC)) {
            struct own *adjoint = adjoint_of(making, by, place);
            adjoint->row.name = by->name;
            mirrored[k] = row->parts++;
            row->list[mirrored[k]] = row->list[k];
            row->list[mirrored[k]].by = &adjoint->row;
        }
        add_piece(pieces, (enum gm_piece)k, number_of(0.5));
    }
    for (size_t k = count; k-- > 0;) {
        add_piece(pieces, (enum gm_piece)mirrored[k], number_of(0.5));
    }
}

/* lie, strang and split, and splittings that are called with parts. */
static struct own *make_parts(const struct making *making)
{
    const struct gm_scheme *base = first_of(making, GM_SCHEME_WORD_BASE);
    const enum gm_written_kind kind = making->written->kind;
    const struct gm_written_line *parts = line_of(making, GM_SCHEME_WORD_PARTS),
                                 *steps = line_of(making, GM_SCHEME_WORD_STEPS);
    struct pieces pieces = {0};
    struct gm_parts_row row = {.parts = 0};
    const size_t place = parts->value.begin;
    read_parts(making, parts->value, &row);
    if (base) {
        const struct gm_parts_row *named = parts_of(base);
        const size_t wanted = named ? named->parts : 2;
        if ((!named && base->family != &gm_family_splitting) || wanted == 0) {
            fail(making, line_of(making, GM_SCHEME_WORD_BASE)->value.begin,
                 "%.60s is not a splitting of named parts", base->name);
        }
        if (row.parts != wanted) {
            fail(making, place, "%.60s splits into %zu parts, not into %zu", base->name, wanted, row.parts);
        }
        row.corrector = named ? named->corrector : 0;
        add_pieces(making, &pieces, base, number_of(1), false);
    } else if (kind == GM_WRITTEN_SPLIT) {
        for (int i = 0; i < steps->columns; i++) {
            add_piece(&pieces, (enum gm_piece)((size_t)i % row.parts), steps->numbers[i]);
        }
        check_parts(making, &row, &pieces, steps->value.begin);
    } else if (row.parts == 1 && strcmp(row.list[0].name, "pieces") == 0) {
        row = (struct gm_parts_row){.of_pieces = kind == GM_WRITTEN_LIE ? NULL : &gm_composition_none};
    } else if (row.parts == 1) {
        fail(making, place, "%s splits into 2 parts or more, not into %.40s alone",
             gm_written_kind_name(kind), row.list[0].name);
    } else if (kind == GM_WRITTEN_STRANG) {
        put_strang(making, &row, &pieces, place);
    } else {
        for (size_t k = 0; k < row.parts; k++) {
            add_piece(&pieces, (enum gm_piece)k, number_of(1));
        }
    }
    const bool turned = row.parts == 2 && strcmp(row.list[0].name, "potential") == 0;
    if (!making->by_names && row.parts == 2 && row.corrector == 0 && !row.list[0].by && !row.list[1].by &&
        strcmp(row.list[turned].name, "kinetic") == 0 && strcmp(row.list[!turned].name, "potential") == 0) {
        struct pieces drifts = pieces;
        for (int i = 0; i < pieces.count; i++) {
            drifts.at[i].piece = (pieces.at[i].piece == GM_KICK) != turned ? GM_KICK : GM_DRIFT;
        }
        *making->names_both = true;
        return of_pieces(making, &drifts, GM_NEEDS_UNNAMED, NULL);
    }
    return of_pieces(making, &pieces, 0, &row);
}

/* ---- compositions ---- */

/* The pieces of steps that are all splittings into the same parts. */
static struct own *flatten(const struct making *making, const struct named *steps,
                           const struct gm_written_number *fractions, size_t place)
{
    struct pieces pieces = {0};
    unsigned needs = 0;
    for (int k = 0; k < steps->count; k++) {
        needs |= steps->at[k]->needs;
        if (!add_pieces(making, &pieces, steps->at[k], fractions[k], false)) {
            fail(making, place, "these are more than %d drifts and kicks", GM_SPLITTING_PIECES);
        }
    }
    return of_pieces(making, &pieces, needs, parts_of(steps->at[0]));
}

/* True if the flows of two splittings are of the same parts, each by its exact flow. */
static bool splits_alike(const struct gm_scheme *a, const struct gm_scheme *b)
{
    const struct gm_parts_row *one = parts_of(a), *other = parts_of(b);
    if (a->family != b->family || (a->family != &gm_family_splitting && !one)) {
        return false;
    }
    bool same = !one || (one->parts > 0 && one->parts == other->parts && one->corrector == 0 &&
                         other->corrector == 0);
    for (size_t i = 0; one && same && i < one->parts; i++) {
        same = strcmp(one->list[i].name, other->list[i].name) == 0 && one->list[i].by == other->list[i].by;
    }
    return same;
}

/* Composes the exact coefficients of steps. Does nothing if one has none, or they are too many. */
static void open_exact(const struct making *making, struct gm_coefficients *exact, const struct named *steps,
                       const struct gm_written_number *fractions)
{
    const size_t count = (size_t)steps->count;
    struct gm_coefficients *parts = gm_arena_take(making->arena, count, sizeof *parts);
    struct gm_ball *balls = gm_arena_take(making->arena, count, sizeof *balls);
    int stages = 0;
    for (size_t k = 0; k < count; k++) {
        if (!gm_scheme_coefficients_open(making->arena, steps->at[k], &parts[k])) {
            return;
        }
        balls[k] = fractions[k].ball;
        stages += parts[k].stages;
        if (stages > MOST_STAGES) {
            return;
        }
    }
    gm_coefficients_open_composition(making->arena, exact, parts, balls, steps->count);
}

/* Makes a composition of steps of schemes, one after the other, of these fractions; faults are reported at `place`. */
static struct own *compose(const struct making *making, const struct named *steps,
                           const struct gm_written_number *fractions, size_t place)
{
    bool splittings = true, carrying = true;
    unsigned needs = 0;
    for (int i = 0; i < steps->count; i++) {
        splittings = splittings && splits_alike(steps->at[0], steps->at[i]);
        carrying = carrying && steps->at[i]->family->carries_passive;
        needs |= steps->at[i]->needs;
    }
    if (splittings) {
        return flatten(making, steps, fractions, place);
    }
    struct own *self =
        open_user(making, sizeof(struct gm_substeps) + (size_t)steps->count * sizeof(struct gm_substep));
    open_exact(making, &self->exact, steps, fractions);
    struct gm_substeps *row = self->coefficients;
    self->row.family = carrying ? &gm_family_composition_carrying : &gm_family_composition;
    /* on an energy that splits, schemes for others are schemes that it has under another name */
    self->row.needs = needs & GM_NEEDS_SPLIT ? needs & ~(unsigned)GM_NEEDS_INSEPARABLE : needs;
    row->count = steps->count;
    for (int i = 0; i < steps->count; i++) {
        row->at[i] = (struct gm_substep){steps->at[i], fractions[i].value};
    }
    return self;
}

/* ---- adjoints ---- */

/* A row of its own for a scheme that is its own adjoint. */
static struct own *same(const struct making *making, const struct gm_scheme *scheme)
{
    struct own *self = open_user(making, 1);
    gm_scheme_coefficients_open(making->arena, scheme, &self->exact);
    self->row.family = scheme->family;
    self->row.coefficients = scheme->coefficients;
    self->row.needs = scheme->needs;
    self->row.claims = scheme->claims;
    return self;
}

/* The pieces in the opposite order, and the adjoints of the schemes that parts take steps of. */
static struct own *adjoint_splitting(const struct making *making, const struct gm_scheme *scheme,
                                     size_t place)
{
    struct pieces pieces = {0};
    const struct gm_parts_row *parts = parts_of(scheme);
    struct gm_parts_row row = parts ? *parts : (struct gm_parts_row){.parts = 0};
    for (size_t i = 0; i < row.parts; i++) {
        if (row.list[i].by) {
            struct own *adjoint = adjoint_of(making, row.list[i].by, place);
            adjoint->row.name = row.list[i].by->name;
            row.list[i].by = &adjoint->row;
        }
    }
    add_pieces(making, &pieces, scheme, number_of(1), true);
    return of_pieces(making, &pieces, scheme->needs, parts ? &row : NULL);
}

static struct own *adjoint_tableau(const struct making *making, const struct gm_coefficients *exact)
{
    const int stages = exact->stages;
    struct own *self = open_user(making, sizeof(struct gm_tableau));
    struct gm_tableau adjoint = {.stages = stages};
    gm_coefficients_open_adjoint(making->arena, &self->exact, exact);
    for (int i = 0; i < stages; i++) {
        for (int j = 0; j < stages; j++) {
            adjoint.a[i][j] = gm_ball_midpoint(self->exact.a[0][i * stages + j]);
        }
        adjoint.b[i] = gm_ball_midpoint(self->exact.b[0][i]);
    }
    return close_tableau(self, &adjoint);
}

/* The counterpart of gm_coefficients_open_adjoint in doubles. */
static struct own *adjoint_nystrom(const struct making *making, const struct gm_scheme *scheme,
                                   const struct gm_coefficients *exact)
{
    const struct gm_nystrom_row *row = scheme->coefficients;
    const int stages = row->stages, last = stages - 1;
    struct own *self = open_user(making, sizeof *row);
    gm_coefficients_open_adjoint(making->arena, &self->exact, exact);
    struct gm_nystrom_row *adjoint = self->coefficients;
    adjoint->stages = stages;
    for (int i = 0; i < stages; i++) {
        const int k = last - i;
        adjoint->c[i] = 1 - row->c[k];
        adjoint->bv[i] = row->bv[k];
        adjoint->b[i] = row->bv[k] - row->b[k];
        for (int j = 0; j < stages; j++) {
            const int l = last - j;
            adjoint->a[i][j] = row->a[k][l] + ((1 - row->c[k]) * row->bv[l] - row->b[l]);
        }
    }
    self->row.family = scheme->family;
    self->row.needs = scheme->needs;
    return self;
}

/* The adjoints of the parts, in the opposite order. */
static struct own *adjoint_composition(const struct making *making, const struct gm_scheme *scheme,
                                       size_t place)
{
    const struct gm_substeps *substeps = scheme->coefficients;
    const size_t count = (size_t)substeps->count;
    struct own *self = open_user(making, sizeof(struct gm_substeps) + count * sizeof(struct gm_substep));
    struct gm_substeps *reversed = self->coefficients;
    for (size_t i = 0; i < count; i++) {
        const struct gm_substep *part = &substeps->at[count - 1 - i];
        size_t same = 0;
        while (substeps->at[count - 1 - same].scheme != part->scheme) {
            same++;
        }
        reversed->at[i] = (struct gm_substep){reversed->at[same].scheme, part->fraction};
        if (same == i) {
            struct own *adjoint = adjoint_of(making, part->scheme, place);
            adjoint->row.name = part->scheme->name;
            reversed->at[i].scheme = &adjoint->row;
        }
    }
    reversed->count = substeps->count;
    self->row.family = scheme->family;
    self->row.needs = scheme->needs;
    self->row.claims = scheme->claims;
    if (scheme->exact) {
        gm_coefficients_open_adjoint(making->arena, &self->exact, scheme->exact);
    }
    return self;
}

/* Makes the adjoint of a scheme made of coefficients alone. */
static struct own *adjoint_single(const struct making *making, const struct gm_scheme *scheme, size_t place)
{
    if (scheme->family == &gm_family_splitting || (parts_of(scheme) && parts_of(scheme)->parts > 0)) {
        return adjoint_splitting(making, scheme, place);
    }
    struct gm_coefficients exact;
    if (!gm_scheme_coefficients_open(making->arena, scheme, &exact)) {
        fail(making, place,
             "the adjoint of %.60s is unknown: it is neither a Runge-Kutta method nor a splitting",
             scheme->name);
    }
    const struct gm_tableau *row = scheme->coefficients;
    if (scheme->family == &gm_family_nystrom) {
        return adjoint_nystrom(making, scheme, &exact);
    }
    if ((scheme->family != &gm_family_explicit && scheme->family != &gm_family_implicit) ||
        exact.stages != row->stages) {
        fail(making, place, "the adjoint of %.60s is not known", scheme->name);
    }
    return adjoint_tableau(making, &exact);
}

/* The adjoint of a scheme, which outlives it. */
static struct own *adjoint_of(const struct making *making, const struct gm_scheme *scheme, size_t place)
{
    struct own *self = scheme->claims & GM_SYMMETRIC      ? same(making, scheme)
                       : gm_scheme_is_composition(scheme) ? adjoint_composition(making, scheme, place)
                                                          : adjoint_single(making, scheme, place);
    self->row.exact = self->exact.stages > 0 && !parts_of(&self->row) ? &self->exact : NULL;
    self->row.order = scheme->order;
    return self;
}

static bool are_adjoint(const struct making *making, const struct gm_scheme *a, const struct gm_scheme *b);

/* The same of two lists of flows, whose parts may take steps of schemes. */
static bool are_adjoint_parts(const struct making *making, const struct gm_parts_row *a,
                              const struct gm_parts_row *b)
{
    const struct gm_splitting *of_a = &a->splitting, *of_b = &b->splitting;
    bool mirrored = of_a->count > 0 && of_a->count == of_b->count && a->corrector == b->corrector;
    for (int i = 0, last = of_b->count - 1; i <= last && mirrored; i++) {
        const struct gm_named_part *here = &a->list[of_a->pieces[i].piece],
                                   *there = &b->list[of_b->pieces[last - i].piece];
        mirrored = strcmp(here->name, there->name) == 0 &&
                   fabs(of_a->pieces[i].fraction - of_b->pieces[last - i].fraction) < 1e-15 &&
                   (here->by && there->by ? are_adjoint(making, here->by, there->by) : here->by == there->by);
    }
    return mirrored;
}

/* Returns true if two schemes are known to be adjoint to each other: one that is its own adjoint, compositions
   of such schemes or lists of flows in the opposite order, or coefficients that satisfy the conditions. */
static bool are_adjoint(const struct making *making, const struct gm_scheme *a, const struct gm_scheme *b)
{
    bool mirrored = (a->claims | b->claims) & GM_SYMMETRIC && a->family == b->family &&
                    a->coefficients == b->coefficients;
    if (!mirrored && gm_scheme_is_composition(a) && gm_scheme_is_composition(b)) {
        const struct gm_substeps *of_a = a->coefficients, *of_b = b->coefficients;
        mirrored = of_a->count == of_b->count;
        for (int i = 0, last = of_b->count - 1; i <= last && mirrored; i++) {
            const struct gm_substep *here = &of_a->at[i], *there = &of_b->at[last - i];
            mirrored = fabs(here->fraction - there->fraction) < 1e-15 &&
                       are_adjoint(making, here->scheme, there->scheme);
        }
    }
    mirrored =
        mirrored || (parts_of(a) && parts_of(b) && are_adjoint_parts(making, parts_of(a), parts_of(b)));
    struct gm_coefficients parts[2], both;
    if (mirrored || !gm_scheme_coefficients_open(making->arena, a, &parts[0]) ||
        !gm_scheme_coefficients_open(making->arena, b, &parts[1])) {
        return mirrored;
    }
    /* then a step of one after a step of the other is symmetric */
    const struct gm_ball fractions[] = {gm_ball_of(1), gm_ball_of(1)};
    gm_coefficients_open_composition(making->arena, &both, parts, fractions, 2);
    return parts[0].stages == parts[1].stages && gm_theory_is_symmetric(making->arena, &both);
}

/* ---- schemes of schemes ---- */

static struct own *make(const struct making *making, struct gm_span span, const char *name,
                        const char *title);

bool gm_user_scheme_is_word(const char *text, size_t length)
{
    char name[256];
    const size_t letters = gm_written_word_name(text, length);
    if (letters == 0 || letters >= sizeof name) {
        return false;
    }
    snprintf(name, sizeof name, "%.*s", (int)letters, text);
    return gm_written_is_kind(name) || gm_word_ends(name, ".scheme") || gm_scheme_find(name);
}

/* The scheme that a piece of the text names. */
static const struct gm_scheme *scheme_of(const struct making *making, struct gm_span span)
{
    const char *text = making->source->text;
    const char *comment = memchr(text + span.begin, '#', span.end - span.begin);
    if (comment) {
        span = gm_span_trimmed(text, (struct gm_span){span.begin, (size_t)(comment - text)});
    }
    const char *name = words_of(making, span);
    char sentence[GM_FAULT_SENTENCE] = "";
    if (gm_user_scheme_is_word(text + span.begin, span.end - span.begin)) {
        return &make(making, span, name, NULL)->row;
    }
    if (gm_word_ends(name, ".scheme")) {
        const struct gm_scheme *scheme = making->source->bring(making->source->data, name, sentence);
        if (!scheme && sentence[0]) {
            fail(making, span.begin, "%s", sentence);
        }
        gm_arena_need(making->arena, scheme);
        return scheme;
    }
    const struct gm_scheme *scheme = gm_scheme_find(name);
    const bool elsewhere = scheme && scheme->family->kind != &gm_kind_ode;
    const char *meaning = elsewhere ? gm_alias_meaning(name) : NULL;
    if (meaning) {
        return gm_scheme_find(meaning);
    }
    if (!scheme || elsewhere) {
        const char *near = scheme ? NULL : gm_scheme_near(name, NULL, 0);
        near = near && gm_scheme_composes(gm_scheme_find(near)) ? near : NULL;
        fail(making, span.begin,
             scheme ? "%.40s is not a scheme for ordinary differential equations%s%s"
                    : "there is no scheme \"%.40s\"%s%s",
             name, near ? "; did you mean " : "", near ? near : "");
    }
    return scheme;
}

static struct named schemes_of(const struct making *making, enum gm_scheme_word word)
{
    const struct gm_written_line *line = line_of(making, word);
    struct named named = {.count = line->said ? line->columns : 0};
    struct gm_span rest = line->value, piece;
    named.at = gm_arena_take(making->arena, (size_t)named.count, sizeof(*named.at));
    for (int i = 0; i < named.count; i++) {
        gm_span_take(making->source->text, &rest, ",", &piece);
        named.at[i] = scheme_of(making, piece);
        if (making->written->kind != GM_WRITTEN_ADJOINT) {
            check_part(making, named.at[i], piece.begin);
        }
    }
    return named;
}

/* The words or the titles of schemes, between commas. */
static const char *join(const struct making *making, const struct named *named, bool titles)
{
    const char *text = "";
    for (int i = 0; i < named->count; i++) {
        text = gm_arena_print(making->arena, "%s%s%s", text, i ? ", " : "",
                              titles ? named->at[i]->title : gm_scheme_word(named->at[i]));
    }
    return text;
}

/* The bases take turns. */
static struct own *make_composition(const struct making *making)
{
    const struct named *bases = &making->schemes[GM_SCHEME_WORD_BASE];
    const struct gm_written_line *steps = line_of(making, GM_SCHEME_WORD_STEPS);
    const size_t count = (size_t)steps->columns;
    struct named parts = {steps->columns, gm_arena_take(making->arena, count, sizeof(*parts.at))};
    for (int i = 0; i < parts.count; i++) {
        parts.at[i] = bases->at[i % bases->count];
    }
    return compose(making, &parts, steps->numbers, line_of(making, GM_SCHEME_WORD_BASE)->value.begin);
}

static struct own *make_processed(const struct making *making)
{
    const struct gm_scheme *kernel = first_of(making, GM_SCHEME_WORD_KERNEL),
                           *processor = first_of(making, GM_SCHEME_WORD_PROCESSOR);
    struct own *adjoint =
        adjoint_of(making, processor, line_of(making, GM_SCHEME_WORD_PROCESSOR)->value.begin);
    const struct gm_scheme *parts[] = {&adjoint->row, kernel, processor};
    const struct gm_written_number fractions[] = {number_of(-1), number_of(1), number_of(1)};
    adjoint->row.name = processor->name;
    return compose(making, &(struct named){3, parts}, fractions,
                   line_of(making, GM_SCHEME_WORD_KERNEL)->value.begin);
}

/* The name in a piece of the line, of those that are held before it. */
static const char *held_name(const struct making *making, const struct gm_holding *holding,
                             struct gm_span piece)
{
    const char *text = making->source->text;
    const char *name = words_of(making, piece);
    if (gm_name_length(text + piece.begin, piece.end - piece.begin) != piece.end - piece.begin ||
        piece.end == piece.begin) {
        fail(making, piece.begin, "the name of an invariant was expected: H, or one of the system");
    }
    for (size_t i = 0; i < holding->count; i++) {
        if (strcmp(holding->names[i], name) == 0) {
            fail(making, piece.begin, "%.60s is named twice", name);
        }
    }
    return name;
}

/* A scheme that holds invariants keeps the order of its base, and of its claims the symmetry if that is asked for, or
   what every part of a step keeps. */
static struct own *make_holding(const struct making *making)
{
    const struct gm_scheme *base = first_of(making, GM_SCHEME_WORD_BASE);
    const struct gm_written_scheme *written = making->written;
    const struct gm_written_line *symmetric = line_of(making, GM_SCHEME_WORD_SYMMETRIC);
    const struct gm_span named = line_of(making, GM_SCHEME_WORD_INVARIANTS)->value;
    const bool relaxed = written->kind == GM_WRITTEN_RELAXED;
    const size_t most = relaxed ? 1 : GM_MOST_CONSERVED;
    struct own *self = open_user(making, sizeof(struct gm_holding));
    struct gm_holding *holding = self->coefficients;
    struct gm_span rest = named, piece;
    while (gm_span_take(written->text, &rest, ",", &piece)) {
        if (holding->count == most) {
            fail(making, piece.begin,
                 relaxed ? "relaxed takes one invariant; projected takes several"
                         : "projected takes at most %d invariants",
                 GM_MOST_CONSERVED);
        }
        const char *name = held_name(making, holding, piece);
        holding->columns[holding->count] = making->source->title ? 0 : piece.begin + 1; /* 0: in a file */
        holding->names[holding->count++] = name;
    }
    if (holding->count == 0 || written->text[named.end - 1] == ',') {
        fail(making, named.end, "the name of an invariant was expected: H, or one of the system");
    }
    holding->constraints = strcmp(holding->names[0], "constraints") == 0;
    holding->symmetric = symmetric->said && gm_span_is(written->text, symmetric->value, "yes");
    if (symmetric->said && !holding->symmetric && !gm_span_is(written->text, symmetric->value, "no")) {
        fail(making, symmetric->value.begin, "symmetric: is yes or no");
    }
    if (holding->constraints && (relaxed || holding->symmetric || holding->count > 1)) {
        fail(making, named.begin, "constraints are held alone, by projected(S; constraints)");
    }
    self->row.family = relaxed ? &gm_family_relaxed : &gm_family_projected;
    self->row.base = base;
    self->row.needs = base->needs | (holding->constraints ? GM_NEEDS_CONSTRAINTS : 0);
    self->row.claims = (relaxed ? base->claims & GM_KEEPS_LINEAR : 0) |
                       (holding->symmetric ? base->claims & GM_SYMMETRIC : 0) |
                       (holding->constraints ? GM_KEEPS_CONSTRAINTS | GM_KEEPS_HIDDEN : 0);
    for (size_t i = 0; i < holding->count; i++) {
        self->row.claims |= strcmp(holding->names[i], "H") == 0 ? GM_KEEPS_ENERGY : 0;
    }
    /* what is reversible has an even energy; other invariants may have parts of both kinds */
    self->row.claims |= holding->symmetric && holding->count == 1 && self->row.claims & GM_KEEPS_ENERGY
                            ? base->claims & GM_REVERSIBLE
                            : 0;
    holding->count = holding->constraints ? 0 : holding->count;
    return self;
}

/* ---- what the row says ---- */

static void read_claims(const struct making *making, const struct gm_written_line *line, unsigned *claims)
{
    size_t wrong;
    if (!gm_claims_read(making->source->text + line->value.begin, line->value.end - line->value.begin, claims,
                        &wrong)) {
        fail(making, line->value.begin + wrong,
             "a claim was expected: symplectic, symmetric, reversible, keeps energy, keeps quadratic "
             "invariants, keeps bilinear invariants, keeps linear invariants, keeps volume; or none");
    }
}

/* The first numbers of a line, for a title. */
static const char *numbers_of(const struct gm_written_line *line, char text[64])
{
    enum { SHOWN = 3 };
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < line->columns && i <= SHOWN; i++) {
        char number[24];
        snprintf(number, sizeof number, "%.4g", line->numbers[i].value);
        used += (size_t)snprintf(text + used, 64 - used, "%s%s", i ? ", " : "", i < SHOWN ? number : "…");
    }
    return text;
}

/* Returns the title in pictures if the text gives none. */
static char *title_of(const struct making *making)
{
    const struct gm_scheme *base = first_of(making, GM_SCHEME_WORD_BASE);
    const enum gm_written_kind kind = making->written->kind;
    const struct gm_written_line *lines = making->written->lines;
    const int stages = lines[GM_SCHEME_WORD_A].rows, steps = lines[GM_SCHEME_WORD_STEPS].columns;
    char numbers[64], others[64];
    switch (kind) {
    case GM_WRITTEN_COMPOSITION:
        return gm_arena_print(making->arena, "%d step%s of %s (%s)", steps, gm_plural(steps),
                              join(making, &making->schemes[GM_SCHEME_WORD_BASE], true),
                              numbers_of(&lines[GM_SCHEME_WORD_STEPS], numbers));
    case GM_WRITTEN_ADJOINT:
        return gm_arena_print(making->arena, "adjoint of %s", base->title);
    case GM_WRITTEN_PROJECTED:
    case GM_WRITTEN_RELAXED:
        return gm_arena_print(making->arena, "%s, %s (%s)", base->title, gm_written_kind_name(kind),
                              words_of(making, lines[GM_SCHEME_WORD_INVARIANTS].value));
    case GM_WRITTEN_PROCESSED:
        return gm_arena_print(making->arena, "%s, processed by %s",
                              first_of(making, GM_SCHEME_WORD_KERNEL)->title,
                              first_of(making, GM_SCHEME_WORD_PROCESSOR)->title);
    case GM_WRITTEN_SPLITTING:
        return gm_arena_print(making->arena, "splitting (%s / %s)",
                              numbers_of(&lines[GM_SCHEME_WORD_DRIFTS], numbers),
                              numbers_of(&lines[GM_SCHEME_WORD_KICKS], others));
    case GM_WRITTEN_LIE:
    case GM_WRITTEN_STRANG:
    case GM_WRITTEN_SPLIT:
    case GM_WRITTEN_CALLED:
        return gm_arena_print(making->arena, "%s of %s", base ? base->title : gm_written_kind_name(kind),
                              words_of(making, lines[GM_SCHEME_WORD_PARTS].value));
    default:
        return gm_arena_print(making->arena, "own %s, %d stage%s (b: %s)", gm_written_kind_name(kind), stages,
                              gm_plural(stages), numbers_of(&lines[GM_SCHEME_WORD_B], numbers));
    }
}

/* Each side's weights sum to 1, but for a part of another scheme. */
static void check_weights(const struct making *making, const struct gm_coefficients *exact)
{
    static const enum gm_scheme_word weights[][GM_SIDES] = {
        [GM_WRITTEN_SPLITTING] = {GM_SCHEME_WORD_DRIFTS, GM_SCHEME_WORD_KICKS},
        [GM_WRITTEN_PARTITIONED] = {GM_SCHEME_WORD_B, GM_SCHEME_WORD_BH},
        [GM_WRITTEN_NYSTROM] = {GM_SCHEME_WORD_BV, GM_SCHEME_WORD_BV},
        [GM_WRITTEN_KINDS - 1] = {0},
    };
    for (int side = 0; side < gm_coefficients_sides(exact); side++) {
        double sum = 0;
        for (int i = 0; i < exact->stages; i++) {
            sum += gm_ball_midpoint(exact->b[side][i]);
        }
        if (fabs(sum - 1) > 1e-3) {
            const enum gm_written_kind kind = making->written->kind;
            const enum gm_scheme_word word = weights[kind][side] ? weights[kind][side] : GM_SCHEME_WORD_B;
            const struct gm_written_line *line = line_of(making, word);
            const char *what =
                kind == GM_WRITTEN_SPLITTING ? side == GM_SIDE_Q ? "drifts" : "kicks" : "weights";
            fail(making, line->said ? line->value.begin : 0, "the %s sum to %.15g, not to 1", what, sum);
        }
    }
}

/* The row's texts, its word among them. */
static void tell(const struct making *making, struct own *self, const char *name, const char *title)
{
    const struct gm_written_line *own_title = line_of(making, GM_SCHEME_WORD_TITLE),
                                 *reference = line_of(making, GM_SCHEME_WORD_REFERENCE);
    struct gm_scheme *row = &self->row;
    const char *words[GM_SCHEME_WORDS] = {NULL};
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        words[word] = join(making, &making->schemes[word], false);
    }
    row->name = gm_arena_print(making->arena, "%s", name);
    row->title = own_title->said ? words_of(making, own_title->value)
                 : title         ? gm_arena_print(making->arena, "%s", title)
                                 : title_of(making);
    row->formula = row->word =
        gm_written_word(making->arena, making->written, own_title->said || title ? row->title : NULL, words);
    row->reference = reference->said ? words_of(making, reference->value) : "user-defined";
}

/* The order of a composition of steps of one symmetric scheme without coefficients. The conditions on the lengths of
   the steps are the same for all symmetric schemes of its order, of which Gauss's method is one. Hairer, Lubich & Wanner
   (2006), section III.3; 0: not known. */
static int order_of_steps(const struct making *making, const struct gm_scheme *base)
{
    static const char *const gauss[] = {[2] = "midpoint", [4] = "gauss4", [6] = "gauss6", [8] = "gauss8"};
    const size_t order = (size_t)base->order;
    const struct gm_written_line *steps = line_of(making, GM_SCHEME_WORD_STEPS);
    struct gm_coefficients exact = {.stages = 0};
    if (!(base->claims & GM_SYMMETRIC) || order >= GM_COUNT(gauss) || !gauss[order]) {
        return 0;
    }
    const size_t count = (size_t)steps->columns;
    struct named of_gauss = {steps->columns, gm_arena_take(making->arena, count, sizeof *of_gauss.at)};
    for (size_t i = 0; i < count; i++) {
        of_gauss.at[i] = gm_scheme_find(gauss[order]);
    }
    open_exact(making, &exact, &of_gauss, steps->numbers);
    return exact.stages > 0 ? gm_theory_of(making->arena, &exact).order : 0;
}

/* Claims of a composition that follow from its bases if theory does not apply: what a single base preserves, and what
   follows from the steps and the order of the list. A symmetric scheme has an even order. */
static struct gm_theory theory_of_bases(const struct making *making, struct gm_scheme *row,
                                        const struct named *bases)
{
    const unsigned both = GM_SYMMETRIC | GM_REVERSIBLE;
    struct gm_theory theory = {.order = bases->at[0]->order, .symmetric = are_adjoint(making, row, row)};
    unsigned all = ~0u;
    for (int i = 0; i < bases->count; i++) {
        /* the form of constrained motions is kept by schemes for them alone */
        const unsigned changes = (bases->at[i]->needs ^ row->needs) & GM_NEEDS_CONSTRAINTS;
        theory.order = bases->at[i]->order < theory.order ? bases->at[i]->order : theory.order;
        all &= changes ? bases->at[i]->claims & ~(unsigned)GM_SYMPLECTIC : bases->at[i]->claims;
    }
    theory.symplectic = all & GM_SYMPLECTIC;
    theory.order += theory.symmetric ? theory.order % 2 : 0;
    const int of_steps = bases->count == 1 ? order_of_steps(making, bases->at[0]) : 0;
    theory.order = of_steps > theory.order ? of_steps : theory.order;
    all = bases->count == 1 ? all : 0;
    row->claims = theory.symmetric && (all & both) == both ? all : all & ~both;
    return theory;
}

/* Order and structure of a splitting by parts, by its list; `order`: of the list by theory, or of the splitting that is
   called; 0: not known. A palindrome is symmetric. Parts that take steps of schemes have at most their order and their
   symmetry. */
static struct gm_theory theory_of_parts(const struct making *making, const struct gm_parts_row *row,
                                        int order)
{
    struct gm_theory theory = {.symplectic = true};
    theory.symmetric = row->parts > 0 ? are_adjoint_parts(making, row, row) : row->of_pieces != NULL;
    theory.order = order > 0 ? order : 1 + theory.symmetric;
    for (size_t k = 0; k < row->parts; k++) {
        const struct gm_scheme *by = row->list[k].by;
        theory.symplectic = theory.symplectic && (!by || by->claims & GM_SYMPLECTIC);
        const int least = by ? by->order + (theory.symmetric ? by->order % 2 : 0) : theory.order;
        theory.order = least < theory.order ? least : theory.order;
    }
    return theory;
}

/* The claims of a splitting that is called with parts. What drifts and kicks preserve, any parts need not, and a part by
   a scheme preserves no more than that. */
static unsigned claims_of_called(const struct gm_scheme *called, const struct gm_parts_row *row)
{
    const unsigned of_drifts = GM_REVERSIBLE | GM_KEEPS_LINEAR | GM_KEEPS_BILINEAR | GM_KEEPS_MOMENTUM_MAPS;
    const bool by_names = parts_of(called) && parts_of(called)->corrector == 0;
    unsigned claims = called->claims & ~(by_names || !row ? 0 : of_drifts);
    for (size_t k = 0; row && k < row->parts; k++) {
        claims &= row->list[k].by ? row->list[k].by->claims : ~0u;
    }
    return claims;
}

/* Fills order and claims that the text does not give from theory; without theory they follow from the
   parts. A scheme that is already open under this name with the same text passes on its order and claims. */
static void finish(const struct making *making, struct own *self, const char *name, const char *title)
{
    const struct gm_written_scheme *written = making->written;
    const struct named *schemes = making->schemes;
    struct gm_scheme *row = &self->row;
    const struct gm_written_line *claims = line_of(making, GM_SCHEME_WORD_CLAIMS);
    row->exact = self->exact.stages > 0 ? &self->exact : NULL;
    const struct gm_decimals *decimals = making->source->decimals;
    const bool tried = decimals && (decimals->instead || decimals->alone);
    if (making->depth == 1) {
        self->exact.moved = making->moved;
        self->exact.moved_count = making->moved_count;
    }
    if (making->depth == 1 && !making->source->part && !tried && row->exact) {
        check_weights(making, row->exact);
    }
    tell(making, self, name, title);
    const struct gm_scheme *known = gm_scheme_find(name);
    if (known && known->word && strcmp(known->word, row->word) == 0) {
        row->order = known->order;
        row->claims = known->claims;
        return;
    }
    struct gm_theory theory = {.known = false};
    if (row->exact && !tried && (written->order == 0 || !claims->said)) {
        theory = gm_theory_of(making->arena, row->exact);
    }
    if (!row->exact && !tried && written->kind == GM_WRITTEN_COMPOSITION) {
        theory = theory_of_bases(making, row, &schemes[GM_SCHEME_WORD_BASE]);
    }
    const struct gm_scheme *called =
        written->kind == GM_WRITTEN_CALLED ? first_of(making, GM_SCHEME_WORD_BASE) : NULL;
    /* its order counts, but one of a quadratic T is another one of any parts */
    if (called && (theory.order == 0 || !(called->needs & GM_NEEDS_NYSTROM))) {
        theory.order = called->order;
    }
    if (parts_of(row)) {
        theory = theory_of_parts(making, parts_of(row), theory.order);
        row->exact = NULL;                                                        /* theory is of T and V */
        theory.symplectic = theory.symplectic && !(row->needs & GM_NEEDS_VOLUME); /* no Hamiltonian */
    }
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS && !theory.known && theory.order == 0; word++) {
        theory.order = schemes[word].count > 0 ? schemes[word].at[0]->order : 0;
    }
    row->order = written->order > 0 ? written->order : theory.order > 0 ? theory.order : 1;
    row->claims = (theory.known ? 0 : row->claims) | (theory.symplectic ? GM_SYMPLECTIC : 0) |
                  (theory.symmetric ? GM_SYMMETRIC : 0);
    if (called) {
        row->claims = claims_of_called(called, parts_of(row));
    }
    if (written->kind == GM_WRITTEN_ADJOINT) { /* what a map preserves, its inverse does, too */
        const struct gm_scheme *base = first_of(making, GM_SCHEME_WORD_BASE);
        row->order = written->order > 0 ? written->order : base->order;
        row->claims = base->claims;
    }
    row->follows = row->claims;
    if (claims->said) {
        read_claims(making, claims, &row->claims);
    }
}

static struct own *make_adjoint(const struct making *making)
{
    return adjoint_of(making, first_of(making, GM_SCHEME_WORD_BASE),
                      line_of(making, GM_SCHEME_WORD_BASE)->value.begin);
}

static struct own *make(const struct making *outer, struct gm_span span, const char *name, const char *title)
{
    static struct own *(*const makers[GM_WRITTEN_KINDS])(const struct making *making) = {
        [GM_WRITTEN_RUNGE_KUTTA] = make_runge_kutta,
        [GM_WRITTEN_EXPLICIT] = make_runge_kutta,
        [GM_WRITTEN_PARTITIONED] = make_partitioned,
        [GM_WRITTEN_NYSTROM] = make_nystrom,
        [GM_WRITTEN_COMPOSITION] = make_composition,
        [GM_WRITTEN_SPLITTING] = make_splitting,
        [GM_WRITTEN_PROCESSED] = make_processed,
        [GM_WRITTEN_ADJOINT] = make_adjoint,
        [GM_WRITTEN_PROJECTED] = make_holding,
        [GM_WRITTEN_RELAXED] = make_holding,
        [GM_WRITTEN_LIE] = make_parts,
        [GM_WRITTEN_STRANG] = make_parts,
        [GM_WRITTEN_SPLIT] = make_parts,
        [GM_WRITTEN_CALLED] = make_parts,
    };
    static const enum gm_scheme_word of_schemes[] = {GM_SCHEME_WORD_BASE, GM_SCHEME_WORD_KERNEL,
                                                     GM_SCHEME_WORD_PROCESSOR};
    struct making making = *outer;
    memset(making.schemes, 0, sizeof making.schemes);
    if (++making.depth > DEEPEST) {
        fail(outer, span.begin, "schemes are made of schemes more than %d deep", DEEPEST);
    }
    struct gm_written_scheme *written = gm_arena_take(making.arena, 1, sizeof *written);
    gm_arena_keep(making.arena, written, gm_written_close);
    making.written = written;
    gm_arena_need(making.arena, gm_written_open(written, making.source->text, span.begin, span.end,
                                                making.source->decimals, making.fault));
    for (size_t i = 0; i < GM_COUNT(of_schemes); i++) {
        making.schemes[of_schemes[i]] = schemes_of(&making, of_schemes[i]);
    }
    struct own *own = makers[written->kind](&making);
    finish(&making, own, name, title);
    return own;
}

/* Opens the coefficients of the scheme with each of its decimals moved by half a unit of its last digit; none if
   there are too many. */
static void open_moved(struct making *making)
{
    enum { MOST = 1000 }; /* decimals times stages */
    struct gm_arena *arena = making->arena;
    struct gm_decimals decimals = {.alone = true};
    struct gm_user_scheme_source tried = *making->source;
    tried.decimals = &decimals;
    const struct gm_scheme *typed = gm_user_scheme_open(&tried, making->fault);
    const size_t stages = typed && typed->exact ? (size_t)typed->exact->stages : 0, count = decimals.count;
    gm_user_scheme_close(typed);
    if (decimals.at) {
        gm_arena_keep(arena, decimals.at, free);
    }
    gm_arena_need(arena, typed);
    const size_t asked = count * stages <= MOST && stages > 0 ? count : 0;
    struct gm_ball *x = gm_arena_take(arena, count, sizeof *x);
    making->moved = gm_arena_take(arena, asked, sizeof *making->moved);
    for (size_t k = 0; k < asked; k++) {
        for (size_t i = 0; i < count; i++) {
            x[i] = decimals.at[i].ball;
            x[i].radius = 0;
        }
        x[k] = gm_ball_add(x[k], gm_ball_of(decimals.at[k].ball.radius));
        decimals.instead = x;
        struct own *other = (void *)gm_user_scheme_open(&tried, making->fault);
        gm_arena_need(arena, other);
        gm_arena_keep(arena, other, close_user);
        gm_coefficients_copy(arena, &making->moved[making->moved_count++], &other->exact);
        gm_arena_drop(arena, other);
    }
}

static void make_whole(struct gm_arena *arena, void *data)
{
    struct making *making = data;
    const struct gm_user_scheme_source *source = making->source;
    const struct gm_span whole = {0, source->length};
    bool names_both = false;
    making->arena = arena;
    making->names_both = &names_both;
    if (!source->decimals) {
        open_moved(making);
    }
    making->made = make(making, whole, source->name, source->title);
    if (names_both && !source->decimals) {
        making->by_names = true;
        making->made->row.by_names = &make(making, whole, source->name, source->title)->row;
    }
    making->made->arena = arena;
}

const struct gm_scheme *gm_user_scheme_open(const struct gm_user_scheme_source *source,
                                            struct gm_fault *fault)
{
    struct making making = {.source = source, .fault = fault};
    *fault = (struct gm_fault){0};
    return gm_arena_made(make_whole, &making) ? &making.made->row : NULL;
}
