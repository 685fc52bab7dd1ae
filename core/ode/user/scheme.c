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

#include "core/expression/reader.h"
#include "core/ode/families/composition.h"
#include "core/ode/families/families.h"
#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/runge_kutta/nystrom.h"
#include "core/ode/families/runge_kutta/partitioned.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/schemes.h"
#include "core/theory/theory.h"

/* Schemes in schemes; stages that theory is asked about. */
enum { DEEPEST = 8, MOST_STAGES = 256 };

/* The row and all that it is made of. */
struct own {
    struct gm_scheme row; /* first */
    struct gm_coefficients exact;
    struct own *next; /* of the schemes that were made for it */
    struct own *made;
    char *texts[4]; /* name, title, word, reference */
    void *coefficients;
};

/* Coefficients, each with one decimal moved, which the scheme takes over. */
struct moved {
    struct gm_coefficients *at;
    int count;
};

struct making {
    const struct gm_user_scheme_source *source;
    struct gm_fault *fault;
    int depth;
    struct moved *moved; /* of the whole scheme; or NULL */
};

__attribute__((format(printf, 3, 4))) static void *fail(const struct making *making, size_t place,
                                                        const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(making->fault->sentence, sizeof making->fault->sentence, format, arguments);
    va_end(arguments);
    making->fault->offset = place;
    return NULL;
}

static void *no_memory(const struct making *making)
{
    *making->fault = (struct gm_fault){0};
    return NULL;
}

static void close_user(struct own *self)
{
    if (!self) {
        return;
    }
    while (self->made) {
        struct own *made = self->made;
        self->made = made->next;
        close_user(made);
    }
    gm_coefficients_close(&self->exact);
    for (size_t i = 0; i < GM_COUNT(self->texts); i++) {
        free(self->texts[i]);
    }
    free(self->coefficients);
    free(self);
}

void gm_user_scheme_close(const struct gm_scheme *scheme)
{
    close_user((struct own *)(void *)scheme);
}

static struct own *open_user(size_t coefficients)
{
    struct own *self = calloc(1, sizeof *self);
    if (self) {
        self->coefficients = calloc(1, coefficients);
        self->row.coefficients = self->coefficients;
    }
    if (!self || !self->coefficients) {
        close_user(self);
        return NULL;
    }
    return self;
}

__attribute__((format(printf, 1, 2))) static char *text_of(const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return length < 0 ? NULL : text;
}

/* -- tableaus
   ------------------------------------------------------------------------------------------------ */

/* A tableau of `stages` stages with entry(i, j), and weights as its row i = stages. */
struct tableau {
    int stages;
    struct gm_written_number at[(GM_MOST_STAGES + 1) * GM_MOST_STAGES];
};

static struct gm_written_number *entry(struct tableau *tableau, int i, int j)
{
    return &tableau->at[i * tableau->stages + j];
}

static struct own *of_tableau(struct tableau *tableau)
{
    const int stages = tableau->stages;
    bool is_explicit = true;
    for (int i = 0; i < stages; i++) {
        for (int j = i; j < stages; j++) {
            is_explicit = is_explicit && entry(tableau, i, j)->value == 0;
        }
    }
    struct own *self =
        open_user(is_explicit ? sizeof(struct gm_explicit_user) : sizeof(struct gm_implicit_row));
    if (!self || !gm_coefficients_open(&self->exact, GM_EQUATIONS_PLAIN, stages)) {
        close_user(self);
        return NULL;
    }
    struct gm_explicit_user *explicit_row = is_explicit ? self->coefficients : NULL;
    struct gm_implicit_row *implicit_row = is_explicit ? NULL : self->coefficients;
    self->row.family = is_explicit ? &gm_family_explicit : &gm_family_implicit;
    if (is_explicit) {
        explicit_row->row = GM_EXPLICIT_USER;
        explicit_row->tableau.stages = stages;
    } else {
        implicit_row->stages = stages;
        implicit_row->composition = &gm_composition_none;
    }
    for (int i = 0; i <= stages; i++) {
        double *row = is_explicit ? (i < stages ? explicit_row->tableau.a[i] : explicit_row->tableau.b)
                                  : (i < stages ? implicit_row->a[i] : implicit_row->b);
        struct gm_ball *exact = i < stages ? self->exact.a[0] + i * stages : self->exact.b[0];
        for (int j = 0; j < stages; j++) {
            row[j] = entry(tableau, i, j)->value;
            exact[j] = entry(tableau, i, j)->ball;
        }
    }
    return self;
}

static struct own *make_runge_kutta(const struct making *making, const struct gm_written_scheme *written)
{
    const struct gm_written_line *a = &written->lines[GM_SCHEME_WORD_A],
                                 *b = &written->lines[GM_SCHEME_WORD_B];
    struct tableau tableau = {.stages = a->rows};
    const size_t stages = (size_t)a->rows;
    memcpy(tableau.at, a->numbers, stages * stages * sizeof *a->numbers);
    memcpy(tableau.at + stages * stages, b->numbers, stages * sizeof *b->numbers);
    struct own *self = of_tableau(&tableau);
    return self ? self : no_memory(making);
}

/* The doubles and the balls of one that is in a loop of tableaus; false: it is none. */
static bool tableau_of(const struct gm_scheme *scheme, const struct gm_coefficients *exact,
                       struct tableau *tableau)
{
    const struct gm_implicit_row *implicit_row = NULL;
    const struct gm_explicit_tableau *explicit_row = NULL;
    if (scheme->family == &gm_family_explicit) {
        explicit_row = gm_explicit_tableau_of(scheme->coefficients);
        tableau->stages = explicit_row->stages;
    } else if (scheme->family == &gm_family_implicit) {
        implicit_row = scheme->coefficients;
        tableau->stages = implicit_row->stages;
    }
    if (!(explicit_row || implicit_row) || exact->stages != tableau->stages) {
        return false;
    }
    for (int i = 0; i <= tableau->stages; i++) {
        const bool weights = i == tableau->stages;
        const double *row = explicit_row ? (weights ? explicit_row->b : explicit_row->a[i])
                                         : (weights ? implicit_row->b : implicit_row->a[i]);
        for (int j = 0; j < tableau->stages; j++) {
            *entry(tableau, i, j) = (struct gm_written_number){
                .value = row[j], .ball = weights ? exact->b[0][j] : exact->a[0][i * tableau->stages + j]};
        }
    }
    return true;
}

/* -- partitioned tableaus
   --------------------------------------------------------------------------------- */

static struct own *make_partitioned(const struct making *making, const struct gm_written_scheme *written)
{
    const struct gm_written_line *a = &written->lines[GM_SCHEME_WORD_A],
                                 *b = &written->lines[GM_SCHEME_WORD_B];
    const struct gm_written_line *c = &written->lines[GM_SCHEME_WORD_AH],
                                 *d = &written->lines[GM_SCHEME_WORD_BH];
    const int stages = a->rows;
    d = d->said ? d : b;
    struct own *self = open_user(sizeof(struct gm_partitioned_row));
    if (!self || !gm_coefficients_open(&self->exact, GM_EQUATIONS_PARTITIONED, stages)) {
        close_user(self);
        return no_memory(making);
    }
    struct gm_partitioned_row *row = self->coefficients;
    self->row.family = &gm_family_partitioned;
    self->row.needs = GM_NEEDS_HAMILTONIAN;
    row->stages = (size_t)stages;
    for (int i = 0; i < stages; i++) {
        row->b[i] = b->numbers[i].value;
        row->d[i] = d->numbers[i].value;
        self->exact.b[GM_SIDE_Q][i] = b->numbers[i].ball;
        self->exact.b[GM_SIDE_P][i] = d->numbers[i].ball;
        for (int j = 0; j < stages; j++) {
            row->a[i][j] = a->numbers[i * stages + j].value;
            row->c[i][j] = c->numbers[i * stages + j].value;
            self->exact.a[GM_SIDE_Q][i * stages + j] = a->numbers[i * stages + j].ball;
            self->exact.a[GM_SIDE_P][i * stages + j] = c->numbers[i * stages + j].ball;
        }
    }
    return self;
}

/* -- Nystrom methods
   ----------------------------------------------------------------------------------------- */

static struct own *make_nystrom(const struct making *making, const struct gm_written_scheme *written)
{
    static const enum gm_scheme_word words[] = {GM_SCHEME_WORD_A, GM_SCHEME_WORD_B, GM_SCHEME_WORD_BV,
                                                GM_SCHEME_WORD_C};
    const struct gm_written_line *lines = written->lines;
    const int stages = lines[GM_SCHEME_WORD_A].rows;
    const size_t s = (size_t)stages;
    struct own *self = open_user(sizeof(struct gm_nystrom_row));
    struct gm_ball *balls = self ? malloc((s + 3) * s * sizeof *balls) : NULL;
    struct gm_ball *at = balls, *b = balls ? balls + s * s : NULL;
    for (size_t k = 0; balls && k < GM_COUNT(words); k++) {
        for (int i = 0; i < lines[words[k]].rows * stages; i++) {
            *at++ = lines[words[k]].numbers[i].ball;
        }
    }
    if (!balls || !gm_coefficients_open_nystrom(&self->exact, stages, balls, b, b + s, b + 2 * s)) {
        free(balls);
        close_user(self);
        return no_memory(making);
    }
    free(balls);
    struct gm_nystrom_row *row = self->coefficients;
    self->row.family = &gm_family_nystrom;
    self->row.needs = GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM;
    row->stages = stages;
    for (int i = 0; i < stages; i++) {
        row->b[i] = lines[GM_SCHEME_WORD_B].numbers[i].value;
        row->bv[i] = lines[GM_SCHEME_WORD_BV].numbers[i].value;
        row->c[i] = lines[GM_SCHEME_WORD_C].numbers[i].value;
        for (int j = 0; j < stages; j++) {
            row->a[i][j] = lines[GM_SCHEME_WORD_A].numbers[i * stages + j].value;
        }
    }
    return self;
}

/* -- splittings
   --------------------------------------------------------------------------------------------- */

struct pieces {
    int count;
    struct {
        enum gm_piece piece;
        struct gm_written_number fraction;
    } at[GM_SPLITTING_PIECES];
};

/* Two pieces of one kind that meet are one. False: there are too many. */
static bool add_piece(struct pieces *pieces, enum gm_piece piece, double value, struct gm_ball ball)
{
    const int last = pieces->count - 1;
    if (last >= 0 && pieces->at[last].piece == piece) {
        pieces->at[last].fraction.value += value;
        pieces->at[last].fraction.ball = gm_ball_add(pieces->at[last].fraction.ball, ball);
        return true;
    }
    if (pieces->count == GM_SPLITTING_PIECES) {
        return false;
    }
    pieces->at[pieces->count].piece = piece;
    pieces->at[pieces->count++].fraction = (struct gm_written_number){.value = value, .ball = ball};
    return true;
}

static struct own *of_pieces(const struct pieces *pieces, unsigned needs)
{
    struct own *self = open_user(sizeof(struct gm_splitting_row));
    if (!self) {
        return NULL;
    }
    struct gm_splitting_row *row = self->coefficients;
    self->row.family = &gm_family_splitting;
    self->row.needs = GM_NEEDS_SPLIT | needs;
    row->splitting.count = pieces->count;
    for (int i = 0; i < pieces->count; i++) {
        row->splitting.pieces[i].piece = pieces->at[i].piece;
        row->splitting.pieces[i].fraction = pieces->at[i].fraction.value;
    }
    if (pieces->count > MOST_STAGES) {
        return self;
    }
    /* the family says where each fraction stands, and which force is a step's first one again */
    if (!gm_family_splitting.coefficients_open(&self->row, &self->exact)) {
        close_user(self);
        return NULL;
    }
    for (int j = 0; j < pieces->count; j++) {
        const int side = pieces->at[j].piece == GM_KICK ? GM_SIDE_P : GM_SIDE_Q;
        self->exact.b[side][j] = pieces->at[j].fraction.ball;
        for (int i = j + 1; i < pieces->count; i++) {
            self->exact.a[side][i * pieces->count + j] = pieces->at[j].fraction.ball;
        }
    }
    return self;
}

static struct own *make_splitting(const struct making *making, const struct gm_written_scheme *written)
{
    const struct gm_written_line *drifts = &written->lines[GM_SCHEME_WORD_DRIFTS];
    const struct gm_written_line *kicks = &written->lines[GM_SCHEME_WORD_KICKS];
    struct pieces *pieces = calloc(1, sizeof *pieces);
    struct own *self = NULL;
    if (pieces) {
        const int all = drifts->columns + kicks->columns;
        bool kick = written->kick_first;
        for (int i = 0; i < all; i++, kick = !kick) {
            const struct gm_written_number *number = (kick ? kicks : drifts)->numbers + i / 2;
            const bool only = i + 1 == all && pieces->count == 0;
            if (number->value != 0 || only) { /* tables are filled up with zeros, which are no pieces */
                add_piece(pieces, kick ? GM_KICK : GM_DRIFT, number->value, number->ball);
            }
        }
        self = of_pieces(pieces, written->nystrom ? GM_NEEDS_NYSTROM : 0);
    }
    free(pieces);
    return self ? self : no_memory(making);
}

/* -- compositions
   ------------------------------------------------------------------------------------------- */

/* Steps of schemes, one after the other. */
struct substeps {
    int count;
    struct {
        const struct gm_scheme *scheme;
        struct gm_written_number fraction;
    } at[GM_MOST_SUBSTEPS];
};

/* The pieces of substeps that are all splittings. */
static struct own *flatten(const struct making *making, const struct substeps *substeps)
{
    struct pieces *pieces = calloc(1, sizeof *pieces);
    unsigned needs = 0;
    bool good = pieces != NULL, fits = true;
    for (int k = 0; good && fits && k < substeps->count; k++) {
        const struct gm_written_number *fraction = &substeps->at[k].fraction;
        const struct gm_scheme *scheme = substeps->at[k].scheme;
        struct gm_splitting made;
        const struct gm_splitting *table = gm_splitting_of(scheme->coefficients, &made);
        struct gm_coefficients exact;
        good = gm_scheme_coefficients_open(scheme, &exact);
        needs |= scheme->needs;
        for (int i = 0; good && fits && i < table->count; i++) {
            const int side = table->pieces[i].piece == GM_KICK ? GM_SIDE_P : GM_SIDE_Q;
            fits = add_piece(pieces, table->pieces[i].piece, table->pieces[i].fraction * fraction->value,
                             gm_ball_multiply(exact.b[side][i], fraction->ball));
        }
        if (good) {
            gm_coefficients_close(&exact);
        }
    }
    struct own *self = good && fits ? of_pieces(pieces, needs) : NULL;
    free(pieces);
    return self   ? self
           : fits ? no_memory(making)
                  : fail(making, 0, "these are more than %d drifts and kicks", GM_SPLITTING_PIECES);
}

/* What theory knows substeps by. Left alone where it knows nothing of one, or they are too many. */
static bool open_exact(struct gm_coefficients *exact, const struct substeps *substeps)
{
    const size_t count = (size_t)substeps->count;
    struct gm_coefficients *parts = calloc(count, sizeof *parts);
    struct gm_ball *fractions = malloc(count * sizeof *fractions);
    int stages = 0, opened = 0;
    bool good = parts && fractions, known = true;
    while (good && known && opened < substeps->count) {
        const struct gm_scheme *scheme = substeps->at[opened].scheme;
        known = scheme->exact || scheme->family->coefficients_open;
        good = !known || gm_scheme_coefficients_open(scheme, &parts[opened]);
        if (good && known) {
            fractions[opened] = substeps->at[opened].fraction.ball;
            stages += parts[opened].stages;
            known = parts[opened].equations == parts[0].equations &&
                    !parts[opened].nystrom == !parts[0].nystrom && stages <= MOST_STAGES;
            opened++;
        }
    }
    if (good && known) {
        good = gm_coefficients_open_composition(exact, parts, fractions, substeps->count);
    }
    while (opened > 0) {
        gm_coefficients_close(&parts[--opened]);
    }
    free(parts);
    free(fractions);
    return good;
}

static struct own *compose(const struct making *making, const struct substeps *substeps)
{
    bool splittings = true, carrying = true;
    unsigned needs = 0;
    for (int i = 0; i < substeps->count; i++) {
        const struct gm_scheme *scheme = substeps->at[i].scheme;
        splittings = splittings && scheme->family == &gm_family_splitting;
        carrying = carrying && scheme->family->carries_passive;
        needs |= scheme->needs;
        if (!gm_scheme_composes(scheme)) {
            return fail(making, 0,
                        "%.60s cannot be a part of a step: it remembers, or chooses its step itself",
                        scheme->name);
        }
    }
    if (splittings) {
        return flatten(making, substeps);
    }
    struct own *self =
        open_user(sizeof(struct gm_substeps) + (size_t)substeps->count * sizeof(struct gm_substep));
    if (!self || !open_exact(&self->exact, substeps)) {
        close_user(self);
        return no_memory(making);
    }
    struct gm_substeps *row = self->coefficients;
    self->row.family = carrying ? &gm_family_composition_carrying : &gm_family_composition;
    self->row.needs = needs;
    row->count = substeps->count;
    for (int i = 0; i < substeps->count; i++) {
        row->at[i] = (struct gm_substep){substeps->at[i].scheme, substeps->at[i].fraction.value};
    }
    return self;
}

/* -- adjoints
   ------------------------------------------------------------------------------------------------- */

/* A row of its own for a scheme that is its own adjoint. */
static struct own *same(const struct making *making, const struct gm_scheme *scheme)
{
    struct own *self = open_user(1);
    const bool known = scheme->exact || scheme->family->coefficients_open;
    if (!self || (known && !gm_scheme_coefficients_open(scheme, &self->exact))) {
        close_user(self);
        return no_memory(making);
    }
    self->row.family = scheme->family;
    self->row.coefficients = scheme->coefficients;
    self->row.needs = scheme->needs;
    return self;
}

static struct own *adjoint_splitting(const struct making *making, const struct gm_scheme *scheme,
                                     const struct gm_coefficients *exact)
{
    struct gm_splitting made;
    const struct gm_splitting *table = gm_splitting_of(scheme->coefficients, &made);
    struct pieces *pieces = calloc(1, sizeof *pieces);
    for (int i = table->count - 1; pieces && i >= 0; i--) {
        const int side = table->pieces[i].piece == GM_KICK ? GM_SIDE_P : GM_SIDE_Q;
        add_piece(pieces, table->pieces[i].piece, table->pieces[i].fraction, exact->b[side][i]);
    }
    struct own *self = pieces ? of_pieces(pieces, scheme->needs) : NULL;
    free(pieces);
    return self ? self : no_memory(making);
}

static struct own *adjoint_tableau(const struct making *making, const struct tableau *tableau)
{
    struct tableau right = *tableau, adjoint = {.stages = tableau->stages};
    const int last = tableau->stages - 1;
    for (int i = 0; i <= last; i++) {
        for (int j = 0; j <= last; j++) {
            const struct gm_written_number *b = entry(&right, last + 1, last - j);
            const struct gm_written_number *a = entry(&right, last - i, last - j);
            *entry(&adjoint, i, j) = (struct gm_written_number){.value = b->value - a->value,
                                                                .ball = gm_ball_subtract(b->ball, a->ball)};
        }
        *entry(&adjoint, last + 1, i) = *entry(&right, last + 1, last - i);
    }
    struct own *self = of_tableau(&adjoint);
    return self ? self : no_memory(making);
}

/* As gm_coefficients_open_adjoint, in doubles. */
static struct own *adjoint_nystrom(const struct making *making, const struct gm_scheme *scheme,
                                   const struct gm_coefficients *exact)
{
    const struct gm_nystrom_row *row = scheme->coefficients;
    const int stages = row->stages, last = stages - 1;
    struct own *self = open_user(sizeof *row);
    if (!self || !gm_coefficients_open_adjoint(&self->exact, exact)) {
        close_user(self);
        return no_memory(making);
    }
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

static struct own *adjoint_of(const struct making *making, const struct gm_scheme *scheme, size_t place);

static void keep_made(struct own **made, struct own *self)
{
    self->next = *made;
    *made = self;
}

static void close_all(struct own *made)
{
    while (made) {
        struct own *next = made->next;
        close_user(made);
        made = next;
    }
}

/* The adjoints of the parts, in the opposite order. */
static struct own *adjoint_composition(const struct making *making, const struct gm_scheme *scheme,
                                       size_t place)
{
    const struct gm_substeps *substeps = scheme->coefficients;
    const size_t count = (size_t)substeps->count;
    struct own *made = NULL;
    struct own *self = open_user(sizeof(struct gm_substeps) + count * sizeof(struct gm_substep));
    bool good = self != NULL;
    struct gm_substeps *reversed = good ? self->coefficients : NULL;
    for (size_t i = 0; good && i < count; i++) {
        const struct gm_substep *part = &substeps->at[count - 1 - i];
        size_t same = 0;
        while (substeps->at[count - 1 - same].scheme != part->scheme) {
            same++;
        }
        struct own *adjoint = same == i ? adjoint_of(making, part->scheme, place) : NULL;
        if (adjoint) {
            adjoint->row.name = part->scheme->name;
            keep_made(&made, adjoint);
        }
        good = same < i || adjoint;
        reversed->at[i] =
            (struct gm_substep){same < i ? reversed->at[same].scheme : &adjoint->row, part->fraction};
    }
    if (good) {
        reversed->count = substeps->count;
        self->row.family = scheme->family;
        self->row.needs = scheme->needs;
        self->made = made;
        if (!scheme->exact || gm_coefficients_open_adjoint(&self->exact, scheme->exact)) {
            return self;
        }
        close_user(self);
        return no_memory(making);
    }
    const bool begun = self != NULL;
    close_all(made);
    close_user(self);
    return begun ? NULL : no_memory(making);
}

/* The adjoint of what is made of coefficients alone. */
static struct own *adjoint_single(const struct making *making, const struct gm_scheme *scheme, size_t place)
{
    struct gm_coefficients exact;
    if (!scheme->exact && !scheme->family->coefficients_open) {
        return fail(making, place,
                    "the adjoint of %.60s is not known: it is no Runge-Kutta method and no splitting",
                    scheme->name);
    }
    if (!gm_scheme_coefficients_open(scheme, &exact)) {
        return no_memory(making);
    }
    struct tableau tableau;
    struct own *self = NULL;
    if (scheme->family == &gm_family_splitting) {
        self = adjoint_splitting(making, scheme, &exact);
    } else if (scheme->family == &gm_family_nystrom) {
        self = adjoint_nystrom(making, scheme, &exact);
    } else if (tableau_of(scheme, &exact, &tableau)) {
        self = adjoint_tableau(making, &tableau);
    } else {
        fail(making, place, "the adjoint of %.60s is not known", scheme->name);
    }
    gm_coefficients_close(&exact);
    return self;
}

/* The adjoint of a scheme, which outlives it. */
static struct own *adjoint_of(const struct making *making, const struct gm_scheme *scheme, size_t place)
{
    const bool composed =
        scheme->family == &gm_family_composition || scheme->family == &gm_family_composition_carrying;
    struct own *self = scheme->claims & GM_SYMMETRIC ? same(making, scheme)
                       : composed                    ? adjoint_composition(making, scheme, place)
                                                     : adjoint_single(making, scheme, place);
    if (self) {
        self->row.exact = self->exact.stages > 0 ? &self->exact : NULL;
    }
    return self;
}

/* -- schemes of schemes
   -------------------------------------------------------------------------------------- */

static struct own *make(const struct making *making, struct gm_span span, const char *name,
                        const char *title);

/* The scheme that a line names, which is put among those that were made if it is a word. */
static const struct gm_scheme *scheme_of(const struct making *making, const struct gm_written_line *line,
                                         struct own **made)
{
    const struct gm_span span = line->value;
    const char *text = making->source->text;
    char *name = gm_span_words(text, span);
    if (!name) {
        return no_memory(making);
    }
    const struct gm_scheme *scheme = NULL;
    char sentence[GM_FAULT_SENTENCE] = "";
    if (gm_written_is_word(text + span.begin, span.end - span.begin)) {
        struct own *self = make(making, span, name, NULL);
        if (self) {
            keep_made(made, self);
            scheme = &self->row;
        }
    } else if (gm_word_ends(name, ".scheme")) {
        scheme = making->source->bring(making->source->data, name, sentence);
        if (!scheme) {
            sentence[0] ? fail(making, span.begin, "%s", sentence) : no_memory(making);
        }
    } else {
        scheme = gm_scheme_find(name);
        if (!scheme || scheme->family->kind != &gm_kind_ode) {
            const char *near = scheme ? gm_scheme_known_as(name) : gm_scheme_near(name);
            fail(making, span.begin,
                 scheme ? "%.40s is no scheme for ordinary differential equations%s%s"
                        : "there is no scheme \"%.40s\"%s%s",
                 name, near ? "; did you mean " : "", near ? near : "");
            scheme = NULL;
        }
    }
    free(name);
    return scheme;
}

/* Faults of what has no place of its own are those of the line. */
static struct own *at_line(const struct making *making, struct own *self, const struct gm_written_line *line)
{
    if (!self && making->fault->sentence[0] && making->fault->offset == 0) {
        making->fault->offset = line->value.begin;
    }
    return self;
}

static struct own *make_composition(const struct making *making, const struct gm_written_scheme *written,
                                    const struct gm_scheme *base)
{
    const struct gm_written_line *steps = &written->lines[GM_SCHEME_WORD_STEPS];
    struct substeps *substeps = calloc(1, sizeof *substeps);
    if (!substeps) {
        return no_memory(making);
    }
    for (int i = 0; i < steps->columns; i++) {
        substeps->at[i].scheme = base;
        substeps->at[i].fraction = steps->numbers[i];
    }
    substeps->count = steps->columns;
    struct own *self = compose(making, substeps);
    free(substeps);
    return at_line(making, self, &written->lines[GM_SCHEME_WORD_BASE]);
}

static struct own *make_processed(const struct making *making, const struct gm_written_scheme *written,
                                  const struct gm_scheme *kernel, const struct gm_scheme *processor,
                                  struct own **made)
{
    struct own *adjoint = adjoint_of(making, processor, written->lines[GM_SCHEME_WORD_PROCESSOR].value.begin);
    struct substeps *substeps = adjoint ? calloc(1, sizeof *substeps) : NULL;
    if (!adjoint) {
        return NULL;
    }
    keep_made(made, adjoint);
    if (!substeps) {
        return no_memory(making);
    }
    const struct gm_scheme *const parts[] = {&adjoint->row, kernel, processor};
    adjoint->row.name = processor->name;
    for (int i = 0; i < 3; i++) {
        const double fraction = i == 0 ? -1 : 1;
        substeps->at[i].scheme = parts[i];
        substeps->at[i].fraction =
            (struct gm_written_number){.value = fraction, .ball = gm_ball_of(fraction)};
    }
    substeps->count = 3;
    struct own *self = compose(making, substeps);
    free(substeps);
    return at_line(making, self, &written->lines[GM_SCHEME_WORD_KERNEL]);
}

/* -- what the row says
   ---------------------------------------------------------------------------------------- */

/* Words of claims, one after the other. */
static bool read_claims(const struct making *making, const struct gm_written_line *line, unsigned *claims)
{
    const char *text = making->source->text;
    struct gm_span rest = line->value;
    const bool none = rest.end - rest.begin == 4 && memcmp(text + rest.begin, "none", 4) == 0;
    for (*claims = 0; rest.begin < rest.end && !none;) {
        unsigned found = GM_CLAIM_COUNT;
        for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
            const char *word = gm_claim_word(bit);
            const size_t length = strlen(word), left = rest.end - rest.begin;
            if (length <= left && memcmp(text + rest.begin, word, length) == 0 &&
                (length == left || strchr(" \t\n,", text[rest.begin + length]))) {
                found = bit;
            }
        }
        if (found == GM_CLAIM_COUNT) {
            fail(making, rest.begin,
                 "a claim was expected: symplectic, symmetric, reversible, keeps energy, keeps quadratic "
                 "invariants, keeps bilinear invariants, keeps linear invariants, keeps volume; or none");
            return false;
        }
        *claims |= 1u << found;
        rest.begin += strlen(gm_claim_word(found));
        while (rest.begin < rest.end && strchr(" \t\n\r,", text[rest.begin])) {
            rest.begin++;
        }
    }
    return true;
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

/* A name for pictures where none is said. */
static char *title_of(const struct gm_written_scheme *written,
                      const struct gm_scheme *const schemes[GM_SCHEME_WORDS])
{
    const struct gm_written_line *lines = written->lines;
    const int stages = lines[GM_SCHEME_WORD_A].rows, steps = lines[GM_SCHEME_WORD_STEPS].columns;
    char numbers[64], others[64];
    switch (written->kind) {
    case GM_WRITTEN_COMPOSITION:
        return text_of("%d step%s of %s (%s)", steps, gm_plural(steps), schemes[GM_SCHEME_WORD_BASE]->title,
                       numbers_of(&lines[GM_SCHEME_WORD_STEPS], numbers));
    case GM_WRITTEN_ADJOINT:
        return text_of("adjoint of %s", schemes[GM_SCHEME_WORD_BASE]->title);
    case GM_WRITTEN_PROCESSED:
        return text_of("%s, processed by %s", schemes[GM_SCHEME_WORD_KERNEL]->title,
                       schemes[GM_SCHEME_WORD_PROCESSOR]->title);
    case GM_WRITTEN_SPLITTING:
        return text_of("splitting (%s / %s)", numbers_of(&lines[GM_SCHEME_WORD_DRIFTS], numbers),
                       numbers_of(&lines[GM_SCHEME_WORD_KICKS], others));
    default:
        return text_of("own %s, %d stage%s (b: %s)", gm_written_kind_name(written->kind), stages,
                       gm_plural(stages), numbers_of(&lines[GM_SCHEME_WORD_B], numbers));
    }
}

/* Each side's weights sum to 1, but for a part of another scheme. */
static bool check_weights(const struct making *making, const struct gm_written_scheme *written,
                          const struct gm_coefficients *exact)
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
            const enum gm_scheme_word word =
                weights[written->kind][side] ? weights[written->kind][side] : GM_SCHEME_WORD_B;
            const struct gm_written_line *line = &written->lines[word];
            const char *what =
                written->kind == GM_WRITTEN_SPLITTING ? side == GM_SIDE_Q ? "drifts" : "kicks" : "weights";
            return fail(making, line->said ? line->value.begin : 0, "the %s sum to %.15g, not to 1", what,
                        sum);
        }
    }
    return true;
}

/* The row's texts, its word among them. */
static bool tell(const struct making *making, const struct gm_written_scheme *written, struct own *self,
                 const char *name, const char *title, const struct gm_scheme *const schemes[GM_SCHEME_WORDS])
{
    const struct gm_written_line *lines = written->lines;
    const char *words[GM_SCHEME_WORDS] = {NULL};
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS; word++) {
        words[word] = schemes[word] ? gm_scheme_word(schemes[word]) : NULL;
    }
    self->texts[0] = strdup(name);
    self->texts[1] = lines[GM_SCHEME_WORD_TITLE].said
                         ? gm_span_words(written->text, lines[GM_SCHEME_WORD_TITLE].value)
                     : title ? strdup(title)
                             : title_of(written, schemes);
    self->texts[2] = self->texts[1] ? gm_written_word(written, self->texts[1], words) : NULL;
    self->texts[3] = lines[GM_SCHEME_WORD_REFERENCE].said
                         ? gm_span_words(written->text, lines[GM_SCHEME_WORD_REFERENCE].value)
                         : strdup("brought along");
    self->row.name = self->texts[0];
    self->row.title = self->texts[1];
    self->row.formula = self->row.word = self->texts[2];
    self->row.reference = self->texts[3];
    return (self->row.name && self->row.title && self->row.word && self->row.reference) || no_memory(making);
}

/* What is not said is what theory says; without theory the order is that of what it is made of. Of a scheme
   that was brought along before, and says the same, it is known. */
static bool finish(const struct making *making, const struct gm_written_scheme *written, struct own *self,
                   const char *name, const char *title,
                   const struct gm_scheme *const schemes[GM_SCHEME_WORDS])
{
    struct gm_scheme *row = &self->row;
    const struct gm_written_line *lines = written->lines;
    row->exact = self->exact.stages > 0 ? &self->exact : NULL;
    const struct gm_decimals *decimals = making->source->decimals;
    const bool tried = decimals && (decimals->instead || decimals->alone);
    if (making->depth == 1 && making->moved && row->exact) {
        self->exact.moved = making->moved->at;
        self->exact.moved_count = making->moved->count;
        *making->moved = (struct moved){0};
    }
    if (making->depth == 1 && !making->source->part && !tried && row->exact &&
        !check_weights(making, written, row->exact)) {
        return false;
    }
    if (!tell(making, written, self, name, title, schemes)) {
        return false;
    }
    const struct gm_scheme *known = gm_scheme_find(name);
    if (known && known->word && strcmp(known->word, row->word) == 0) {
        row->order = known->order;
        row->claims = known->claims;
        return true;
    }
    struct gm_theory theory = {.known = false};
    if (row->exact && !tried && (written->order == 0 || !lines[GM_SCHEME_WORD_CLAIMS].said)) {
        theory = gm_theory_of(row->exact);
        if (!theory.known) {
            return no_memory(making);
        }
    }
    for (enum gm_scheme_word word = 0; word < GM_SCHEME_WORDS && !theory.known; word++) {
        theory.order = schemes[word] && theory.order == 0 ? schemes[word]->order : theory.order;
    }
    row->order = written->order > 0 ? written->order : theory.order > 0 ? theory.order : 1;
    row->claims = (theory.symplectic ? GM_SYMPLECTIC : 0) | (theory.symmetric ? GM_SYMMETRIC : 0);
    return !lines[GM_SCHEME_WORD_CLAIMS].said ||
           read_claims(making, &lines[GM_SCHEME_WORD_CLAIMS], &row->claims);
}

static struct own *make_written(const struct making *making, const struct gm_written_scheme *written,
                                const char *name, const char *title)
{
    static const enum gm_scheme_word of_schemes[] = {GM_SCHEME_WORD_BASE, GM_SCHEME_WORD_KERNEL,
                                                     GM_SCHEME_WORD_PROCESSOR};
    const struct gm_scheme *schemes[GM_SCHEME_WORDS] = {NULL};
    struct own *made = NULL, *own = NULL;
    bool good = true;
    for (size_t i = 0; good && i < GM_COUNT(of_schemes); i++) {
        const struct gm_written_line *line = &written->lines[of_schemes[i]];
        schemes[of_schemes[i]] = line->said ? scheme_of(making, line, &made) : NULL;
        good = !line->said || schemes[of_schemes[i]];
    }
    const struct gm_scheme *base = schemes[GM_SCHEME_WORD_BASE];
    switch (good ? written->kind : GM_WRITTEN_KINDS) {
    case GM_WRITTEN_RUNGE_KUTTA:
    case GM_WRITTEN_EXPLICIT:
        own = make_runge_kutta(making, written);
        break;
    case GM_WRITTEN_PARTITIONED:
        own = make_partitioned(making, written);
        break;
    case GM_WRITTEN_NYSTROM:
        own = make_nystrom(making, written);
        break;
    case GM_WRITTEN_COMPOSITION:
        own = make_composition(making, written, base);
        break;
    case GM_WRITTEN_SPLITTING:
        own = make_splitting(making, written);
        break;
    case GM_WRITTEN_PROCESSED:
        own = make_processed(making, written, schemes[GM_SCHEME_WORD_KERNEL],
                             schemes[GM_SCHEME_WORD_PROCESSOR], &made);
        break;
    case GM_WRITTEN_ADJOINT:
        own = adjoint_of(making, base, written->lines[GM_SCHEME_WORD_BASE].value.begin);
        break;
    case GM_WRITTEN_KINDS:
        break;
    }
    if (!own) {
        close_all(made);
        return NULL;
    }
    struct own **end = &own->made;
    while (*end) {
        end = &(*end)->next;
    }
    *end = made;
    if (!finish(making, written, own, name, title, schemes)) {
        close_user(own);
        own = NULL;
    }
    return own;
}

static struct own *make(const struct making *making, struct gm_span span, const char *name, const char *title)
{
    struct making inner = *making;
    struct own *self = NULL;
    if (++inner.depth > DEEPEST) {
        return fail(making, span.begin, "schemes are made of schemes more than %d deep", DEEPEST);
    }
    struct gm_written_scheme *written = malloc(sizeof *written);
    if (!written) {
        return no_memory(making);
    }
    if (gm_written_open(written, making->source->text, span.begin, span.end, making->source->decimals,
                        making->fault)) {
        self = make_written(&inner, written, name, title);
    }
    gm_written_close(written);
    free(written);
    return self;
}

/* `moved` may be NULL. */
static struct own *open_source(const struct gm_user_scheme_source *source, struct moved *moved,
                               struct gm_fault *fault)
{
    const struct making making = {.source = source, .fault = fault, .moved = moved};
    *fault = (struct gm_fault){0};
    return make(&making, (struct gm_span){0, source->length}, source->name, source->title);
}

/* The coefficients of the scheme with each of its decimals moved by half a unit of its last digit; of a
   scheme with very many it is left alone. False with a fault. */
static bool open_moved(const struct gm_user_scheme_source *source, struct moved *moved,
                       struct gm_fault *fault)
{
    enum { MOST = 1000 }; /* decimals times stages */
    struct gm_decimals decimals = {0};
    struct gm_user_scheme_source tried = *source;
    tried.decimals = &decimals;
    decimals.alone = true;
    struct own *self = open_source(&tried, NULL, fault);
    const size_t all = decimals.count;
    const bool asked = self && self->exact.stages > 0 && all > 0 && all * (size_t)self->exact.stages <= MOST;
    close_user(self);
    if (!asked) {
        free(decimals.at);
        return self != NULL;
    }
    struct gm_ball *x = malloc(all * sizeof *x);
    moved->at = calloc(all, sizeof *moved->at);
    bool good = x && moved->at;
    for (size_t k = 0; good && k < all; k++) {
        for (size_t i = 0; i < all; i++) {
            x[i] = decimals.at[i].ball;
            x[i].radius = 0;
        }
        x[k] = gm_ball_add(x[k], gm_ball_of(decimals.at[k].ball.radius));
        decimals.instead = x;
        struct own *other = open_source(&tried, NULL, fault);
        good = other && gm_coefficients_copy(&moved->at[k], &other->exact);
        moved->count += good;
        close_user(other);
    }
    free(x);
    free(decimals.at);
    return good;
}

const struct gm_scheme *gm_user_scheme_open(const struct gm_user_scheme_source *source,
                                            struct gm_fault *fault)
{
    struct moved moved = {0};
    const bool good = source->decimals || open_moved(source, &moved, fault);
    struct own *self = good ? open_source(source, &moved, fault) : NULL;
    for (int k = 0; k < moved.count; k++) {
        gm_coefficients_close(&moved.at[k]);
    }
    free(moved.at);
    return self ? &self->row : NULL;
}
