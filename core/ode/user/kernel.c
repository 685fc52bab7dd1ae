/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of kernels, written from tapes. */
#include "core/ode/user/kernel.h"
#include "core/basics.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/families/runge_kutta/explicit.h"
#include "core/ode/families/runge_kutta/implicit.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/kernel/loops.h"

/* Code beyond INLINED instructions is a function of its own, which a scheme's stages share; beyond MOST a
   compiler would take longer than most runs. */
enum { INLINED = 150, MOST = 4000 };

static const struct {
    const char *name, *arguments;
    bool momenta; /* true: its array starts with the momenta */
    bool alone;   /* true: it takes doubles, not registers */
} functions[GM_KERNEL_FUNCTIONS] = {
    [GM_KERNEL_FIELD] = {"K(field)", "const real *y, real *f", false, false},
    [GM_KERNEL_VELOCITY] = {"K(velocity)", "const real *y, real *f", true, false},
    [GM_KERNEL_FORCE] = {"K(force)", "const real *y, real *f", false, false},
    [GM_KERNEL_JACOBIAN] = {"K(jacobian)", "const double *y, double f[][GM_COMPONENTS]", false, true},
    [GM_KERNEL_ENERGY] = {"K(energy)", "const double *y, double *f", false, true},
    [GM_KERNEL_POTENTIAL] = {"K(potential)", "const double *y, double *f", false, true},
    [GM_KERNEL_SURFACES] = {"K(surfaces)", "const double *y, double *f", false, true},
};

/* Finds the text before, between and after an operation's operands. */
static bool spell(enum gm_operation operation, const char *words[3])
{
    static const struct {
        enum gm_operation operation;
        const char *words[3];
    } own[] = {
        {GM_OPERATION_ADD, {"", " + ", ""}},
        {GM_OPERATION_SUBTRACT, {"", " - ", ""}},
        {GM_OPERATION_MULTIPLY, {"", " * ", ""}},
        {GM_OPERATION_DIVIDE, {"", " / ", ""}},
        {GM_OPERATION_NEGATE, {"-", NULL, ""}},
        {GM_OPERATION_SQRT, {"K(root)(", NULL, ")"}},
        {GM_OPERATION_ABS, {"K(magnitude)(", NULL, ")"}},
        {GM_OPERATION_MIN, {"K(smaller)(", ", ", ")"}},
        {GM_OPERATION_MAX, {"K(larger)(", ", ", ")"}},
        {GM_OPERATION_BELOW, {"K(below)(", ", ", ")"}},
        {GM_OPERATION_SIGN, {"K(sign)(", NULL, ")"}},
        {GM_OPERATION_CHOSEN, {"K(chosen)(", ", ", ")"}},
#define GM_FORMULA_FUNCTION(constant, name, arity)                                                           \
    {GM_OPERATION_##constant, {"K(" #name ")(", (arity) == 2 ? ", " : NULL, ")"}},
#include "core/functions/functions.def"
    };
    static const char *const others[GM_OPERATIONS] = {
#define GM_OPERATION(constant, ...) [GM_OPERATION_##constant] = "K(value_" #constant ")(",
#include "core/expression/operations.def"
#undef GM_OPERATION
    };
    words[0] = (size_t)operation < GM_OPERATIONS ? others[operation] : NULL;
    words[1] = ", ";
    words[2] = ")";
    for (size_t i = 0; i < GM_COUNT(own); i++) {
        if (own[i].operation == operation) {
            memcpy(words, own[i].words, sizeof own[i].words);
        }
    }
    return words[0];
}

/* A function's text while it is written: each statement makes a variable of its own. */
struct writing {
    FILE *out;
    const struct gm_tape *tape;
    size_t parameters;        /* inputs from this one on */
    size_t statements, first; /* the input that the array begins with */
    size_t *made;             /* per register: the last statement that wrote it */
};

static void put_register(const struct writing *writing, uint32_t place)
{
    const struct gm_tape *tape = writing->tape;
    if (place < tape->inputs && place >= writing->parameters) {
        fprintf(writing->out, "K(constant)(given[%zu])", place - writing->parameters);
    } else if (place < tape->inputs) {
        fprintf(writing->out, "y[%zu]", place - writing->first);
    } else if (place < tape->inputs + tape->constant_count) {
        fprintf(writing->out, "K(constant)(c[%zu])", place - tape->inputs);
    } else {
        fprintf(writing->out, "t%zu", writing->made[place]);
    }
}

/* The next statement: an operation on registers. */
static bool put_statement(struct writing *writing, uint32_t operation, uint32_t to, uint32_t a, uint32_t b)
{
    const char *words[3] = {"", NULL, ""};
    if (operation != GM_VARIABLE && !spell((enum gm_operation)operation, words)) {
        return false;
    }
    fprintf(writing->out, "    const real t%zu = %s", writing->statements, words[0]);
    put_register(writing, a);
    if (words[1]) {
        fputs(words[1], writing->out);
        put_register(writing, b);
    }
    fprintf(writing->out, "%s;\n", words[2]);
    writing->made[to] = writing->statements++;
    return true;
}

/* Writes repeated operations one by one. */
static bool put_code(struct writing *writing)
{
    struct gm_tape_place at = {0};
    struct gm_instruction now;
    while (gm_tape_next(writing->tape, &at, &now)) {
        if (!put_statement(writing, now.operation, now.to, now.a, now.b)) {
            return false;
        }
    }
    return true;
}

static size_t statements_of(const struct gm_tape *tape)
{
    struct gm_tape_place at = {0};
    struct gm_instruction now;
    size_t count = 0;
    while (gm_tape_next(tape, &at, &now)) {
        count++;
    }
    return count;
}

/* Names a function's constants and parameters. */
static void put_constants(FILE *out, const struct gm_kernel_source *source, enum gm_kernel_function which)
{
    const struct gm_tape *tape = source->tapes[which];
    if (!source->written_out) {
        fprintf(out, "    const double *const c = ((const double *const *)parameters)[%d];\n", (int)which);
    } else {
        fputs(
            "    const double *const given = parameters;\n    (void)given;\n    static const double c[] = {",
            out);
        for (size_t i = 0; i < tape->constant_count; i++) {
            fprintf(out, "%a, ", tape->constants[i]);
        }
        fputs("0};\n", out);
    }
    fputs("    (void)c;\n    (void)y;\n", out);
}

/* Writes a function. Returns false if an operation cannot be written. */
static bool put_function(FILE *out, const struct gm_kernel_source *source, enum gm_kernel_function which,
                         size_t *made)
{
    const struct gm_tape *tape = source->tapes[which];
    const bool is_jacobian = which == GM_KERNEL_JACOBIAN, alone = functions[which].alone,
               large = statements_of(tape) > INLINED;
    struct writing writing = {.out = out,
                              .tape = tape,
                              .parameters = source->written_out ? source->parameters : SIZE_MAX,
                              .first = functions[which].momenta ? source->components / 2 : 0,
                              .made = made};
    const size_t results = tape->inputs + tape->constant_count;
    fprintf(out, "%s\n%s void %s(%s, const void *parameters)\n{\n", alone ? "\n#ifdef GM_PASS_SCALAR" : "",
            large || is_jacobian ? "static __attribute__((noinline, unused))" : "GM_INLINE",
            functions[which].name, functions[which].arguments);
    put_constants(out, source, which);
    if (is_jacobian) {
        fprintf(out, "    memset(f, 0, sizeof(double[GM_COMPONENTS][GM_COMPONENTS]));\n");
    }
    if (!put_code(&writing)) {
        return false;
    }
    for (size_t k = 0; k < tape->outputs; k++) {
        if (is_jacobian) {
            const struct gm_sparse_entry *entry = &source->jacobian->entries[k];
            fprintf(out, "    f[%zu][%zu] = ", (size_t)entry->row, (size_t)entry->column);
        } else {
            fprintf(out, "    f[%zu] = ", k);
        }
        put_register(&writing, (uint32_t)(results + k));
        fputs(";\n", out);
    }
    fprintf(out, "}\n%s", alone ? "#endif\n" : "");
    return true;
}

static const char assertion[] = "_Static_assert";

/* Compilation fails if structs that loops and program share differ in layout. A browser has shorter pointers than the
   machine that writes its loops. */
static void put_layout(FILE *out)
{
#define GM_LAID_OUT(type)                                                                                    \
    {                                                                                                        \
        "struct " #type, sizeof(struct type)                                                                 \
    }
    static const struct {
        const char *type;
        size_t size;
    } layout[] = {
        GM_LAID_OUT(gm_task), GM_LAID_OUT(gm_problem), GM_LAID_OUT(gm_progress), GM_LAID_OUT(gm_scheme),
        GM_LAID_OUT(gm_ode),  GM_LAID_OUT(gm_loops),   GM_LAID_OUT(gm_tableau),  GM_LAID_OUT(gm_splitting),
    };
#undef GM_LAID_OUT
    for (size_t i = 0; i < GM_COUNT(layout); i++) {
        fprintf(out, "%s(sizeof(void *) != %zu || sizeof(%s) == %zu, \"of another build\");\n", assertion,
                sizeof(void *), layout[i].type, layout[i].size);
    }
}

struct gm_digest gm_kernel_digest(const char *text)
{
    const char *layout = strstr(text, assertion);
    struct gm_digest digest = gm_digest_open();
    gm_digest_add(&digest, text, layout ? (size_t)(layout - text) : strlen(text));
    return digest;
}

/* Returns true if the tape reads one of the inputs [first, last). */
static bool reads(const struct gm_tape *tape, size_t first, size_t last)
{
    struct gm_tape_place at = {0};
    struct gm_instruction now;
    bool found = false;
    while (gm_tape_next(tape, &at, &now)) {
        found = found || (now.a >= first && now.a < last) || (now.b >= first && now.b < last);
    }
    return found;
}

bool gm_kernel_splits(const struct gm_kernel_source *source)
{
    const size_t n = source->components;
    return n % 2 == 0 && !reads(source->tapes[GM_KERNEL_VELOCITY], 0, n / 2) &&
           !reads(source->tapes[GM_KERNEL_FORCE], n / 2, n);
}

char *gm_kernel_text(const struct gm_kernel_source *source, const char **lacks)
{
    /* a system that depends on the time is a field in these loops, as in the interpreter */
    const bool separable = source->tapes[GM_KERNEL_FORCE] && source->components % 2 == 0;
    bool wanted[GM_KERNEL_FUNCTIONS];
    for (int k = 0; k < GM_KERNEL_FUNCTIONS; k++) {
        const bool of_split = k == GM_KERNEL_VELOCITY || k == GM_KERNEL_FORCE;
        wanted[k] = source->tapes[k] && (k == GM_KERNEL_FIELD ? !separable : separable || !of_split);
    }
    size_t registers = 0, length = 0, size = 0;
    *lacks = NULL;
    for (int k = 0; k < GM_KERNEL_FUNCTIONS; k++) {
        const struct gm_tape *tape = wanted[k] ? source->tapes[k] : NULL;
        registers = tape && tape->registers > registers ? tape->registers : registers;
        length += tape ? statements_of(tape) : 0;
    }
    if (!source->jacobian_wanted && wanted[GM_KERNEL_JACOBIAN] && length > MOST) {
        wanted[GM_KERNEL_JACOBIAN] = false;
        length -= statements_of(source->tapes[GM_KERNEL_JACOBIAN]);
    }
    if ((source->jacobian_wanted && !wanted[GM_KERNEL_JACOBIAN]) || length > MOST) {
        *lacks = "it is too large to be compiled";
        return NULL;
    }
    if (separable && !gm_kernel_splits(source)) {
        *lacks = "it splits as a whole alone, not part by part";
        return NULL;
    }
    char *text = NULL;
    size_t *made = malloc((registers + 1) * sizeof *made);
    FILE *out = made ? open_memstream(&text, &size) : NULL;
    bool good = out != NULL, known = true;
    if (good) {
        fprintf(out, "#define GM_COMPONENTS %zu\n%s%s#include \"core/ode/kernel/formula.h\"\n",
                source->components, separable ? "#define GM_SEPARABLE\n" : "",
                wanted[GM_KERNEL_JACOBIAN] ? "" : "#define GM_WITHOUT_JACOBIAN\n");
        if (wanted[GM_KERNEL_SURFACES]) {
            fprintf(out, "#define GM_SURFACES %zu\n", source->tapes[GM_KERNEL_SURFACES]->outputs);
        }
        for (int k = 0; k < GM_KERNEL_FUNCTIONS; k++) {
            known = known && (!wanted[k] || put_function(out, source, (enum gm_kernel_function)k, made));
        }
        put_layout(out);
        good = !ferror(out);
        good = fclose(out) == 0 && good;
    }
    free(made);
    if (!good || !known) {
        *lacks = good ? "it holds what has no form in C yet" : NULL;
        free(text);
        text = NULL;
    }
    return text;
}
