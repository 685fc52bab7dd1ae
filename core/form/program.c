/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Types of forms follow from those of their parts, node by node of the graph of formulas:
       d: k -> k + 1,   star: k <-> dual 2 - k,   delta = -star d star,   laplace = -(d delta + delta d),
       lie(u, a) = d interior(u, a) + interior(u, d a).
   interior(u, c) of a dual 2-form c is the flux of the velocity u through dual edges, the transfer of star(u),
   times the mean of star(c) at both ends of the edge; of a primal 2-form, star(u) times the mean on both sides.
   Both are discrete products (Hirani, Discrete Exterior Calculus (2003)) that keep a constant. */
#include "core/form/program.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/model/equations.h"

static const size_t NONE = SIZE_MAX;

/* A part of a formula: a step, or a formula of place and time that becomes one where its type is known. */
struct part {
    struct gm_form_type type;
    size_t step; /* NONE: a formula */
    gm_node_id node;
};

/* A node of the graph. */
struct known {
    bool of_forms; /* it depends on forms or their operators */
    bool of_place; /* on x, y, z */
    bool of_time;
    bool of_arc;      /* on s */
    bool begun, made; /* its compilation */
    struct part part; /* if it is made */
};

struct compiling {
    struct gm_arena *arena; /* of the system */
    struct gm_form_program *program;
    struct gm_user_system *system;
    const struct gm_form_root *roots;
    struct gm_fault *fault;
    struct known *known;
    size_t nodes; /* of the graph when it began */
    bool linear;
    size_t along;   /* 1 + the item of the line `boundary:` whose value is compiled; 0: none */
    gm_node_id now; /* the node that is compiled */
};

static const struct gm_form_type any_number = {GM_FORM_NUMBER, false}, primal_0 = {0, false},
                                 primal_1 = {1, false}, primal_2 = {2, false}, dual_0 = {0, true},
                                 dual_1 = {1, true};

const char *gm_form_type_text(struct gm_form_type type)
{
    static const char *const texts[2][3] = {{"a 0-form", "a 1-form", "a 2-form"},
                                            {"a dual 0-form", "a dual 1-form", "a dual 2-form"}};
    return type.degree >= 0                ? texts[type.dual][type.degree]
           : type.degree == GM_FORM_NUMBER ? "a number"
           : type.degree == GM_FORM_PLACE  ? "a formula of the place"
                                           : "a 1-form by its components";
}

static bool same(struct gm_form_type a, struct gm_form_type b)
{
    return a.degree == b.degree && (a.degree < 0 || a.dual == b.dual);
}

/* Writes a part of a formula: "d(u)". */
static const char *text_of(const struct compiling *compiling, gm_node_id node, char *text, size_t size)
{
    const struct gm_user_system *system = compiling->system;
    const struct gm_node *at = &system->graph.nodes[node];
    static const char *const names[] = {
#define GM_FORM_OPERATOR(constant, name, ...) name,
#include "core/model/form_operators.def"
#undef GM_FORM_OPERATOR
    };
    if (at->operation == GM_CONSTANT) {
        snprintf(text, size, "%.6g", at->value);
    } else if (at->operation != GM_VARIABLE) {
        snprintf(text, size, "this");
    } else if (at->a < system->first_call) {
        snprintf(text, size, "%.40s", system->variables[at->a].name);
    } else {
        const struct gm_form_call *call = &system->calls[at->a - system->first_call];
        char inner[80];
        snprintf(text, size, "%s(%s%s)", names[call->operator],
                 text_of(compiling, call->operands[0], inner, size > 60 ? 60 : size / 2),
                 call->count > 1 ? ", .." : "");
    }
    return text;
}

/* Leaves with a fault at the node that is compiled. */
__attribute__((format(printf, 2, 3))) _Noreturn static void refuse(struct compiling *compiling,
                                                                   const char *format, ...)
{
    char sentence[GM_FAULT_SENTENCE];
    va_list list;
    va_start(list, format);
    vsnprintf(sentence, sizeof sentence, format, list);
    va_end(list);
    const uint32_t place = compiling->system->graph.places[compiling->now];
    gm_fail(compiling->fault, place == GM_NO_PLACE ? compiling->fault->offset : place, "%s", sentence);
    gm_arena_leave(compiling->arena);
}

/* Leaves with a fault if a rule about a part does not hold. */
static void require(struct compiling *compiling, bool holds, const char *rule, struct part part)
{
    if (!holds) {
        refuse(compiling, "%s, and this is %s", rule, gm_form_type_text(part.type));
    }
}

/* Adds a step. */
static struct part made(struct compiling *compiling, struct gm_form_step step)
{
    struct gm_form_program *program = compiling->program;
    program->steps = gm_arena_grown(compiling->arena, program->steps, program->count, sizeof *program->steps);
    program->steps[program->count] = step;
    return (struct part){step.type, program->count++, compiling->now};
}

/* Renumbers a formula in x y z s t and parameters. */
static gm_node_id renumbered(struct compiling *compiling, gm_node_id node)
{
    struct gm_user_system *system = compiling->system;
    gm_node_id *others = gm_system_no_nodes(system, system->variable_count);
    gm_arena_need(compiling->arena, others);
    others[system->n] = gm_formula_variable(&system->graph, GM_FORM_PLACES);
    for (size_t i = 0; i < GM_FORM_PLACES; i++) {
        others[system->velocities + i] = gm_formula_variable(&system->graph, i);
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        others[i] = gm_formula_variable(&system->graph, GM_SAMPLE_INPUTS + i - system->parameters);
    }
    gm_arena_need(compiling->arena,
                  gm_formula_substitute(&system->graph, &node, 1, others, system->variable_count));
    return node;
}

/* The part as a form of that type, or a number. */
static struct part sampled(struct compiling *compiling, struct part part, struct gm_form_type type)
{
    struct gm_form_step step = {.kind = GM_STEP_SAMPLE, .type = type, .components = 1};
    const struct gm_user_system *system = compiling->system;
    gm_node_id nodes[3] = {part.node, part.node, part.node};
    if (part.type.degree == GM_FORM_COVECTOR) {
        const struct gm_form_call *call =
            &system->calls[system->graph.nodes[part.node].a - system->first_call];
        step.components = call->count;
        memcpy(nodes, call->operands, call->count * sizeof *nodes);
    }
    for (size_t i = 0; i < step.components; i++) {
        const struct known *known = &compiling->known[nodes[i]];
        step.needs |= known->of_time ? GM_NEEDS_TIME : 0;
        step.number = known->of_arc ? compiling->along : step.number;
        if (known->of_arc && compiling->along == 0) {
            refuse(compiling, "s, the length along a part of the boundary, is in formulas without forms");
        }
        step.nodes[i] = renumbered(compiling, nodes[i]);
    }
    return made(compiling, step);
}

static bool is_formula(struct part part)
{
    return part.step == NONE;
}

/* A part whose type is decided: 0-forms at vertices, primal 1-forms, numbers, unless it is known. */
static struct part decided(struct compiling *compiling, struct part part)
{
    if (!is_formula(part)) {
        return part;
    }
    return sampled(compiling, part,
                   part.type.degree == GM_FORM_NUMBER     ? any_number
                   : part.type.degree == GM_FORM_COVECTOR ? primal_1
                                                          : primal_0);
}

/* The part as a form of that type; false if it is another one. A number is a 0-form. */
static bool fit(struct compiling *compiling, struct part *part, struct gm_form_type type)
{
    const int degree = part->type.degree;
    if (is_formula(*part) && (type.degree == degree || (type.degree == 0 && degree == GM_FORM_PLACE) ||
                              (type.degree == 1 && degree == GM_FORM_COVECTOR))) {
        *part = sampled(compiling, *part, type);
        return true;
    }
    if (degree == GM_FORM_NUMBER && type.degree <= 0) {
        *part = decided(compiling, *part);
        return true;
    }
    return same(part->type, type);
}

static unsigned needs_of(const struct compiling *compiling, struct part part)
{
    return compiling->program->steps[part.step].needs;
}

/* Adds a step on one part. */
static struct part made_of(struct compiling *compiling, enum gm_form_step_kind kind, size_t number,
                           struct part a, struct gm_form_type type)
{
    return made(
        compiling,
        (struct gm_form_step){
            .kind = kind, .type = type, .needs = needs_of(compiling, a), .a = a.step, .number = number});
}

/* An operation on entries, with the type of the form if the other part is a number. */
static struct part operate(struct compiling *compiling, enum gm_operation operation, struct part a,
                           struct part b)
{
    const bool unary = gm_operation_rows[operation].arity == 1;
    const unsigned p = needs_of(compiling, a), q = unary ? 0 : needs_of(compiling, b);
    const bool sum = operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT ||
                     operation == GM_OPERATION_NEGATE;
    const bool scaled = operation == GM_OPERATION_MULTIPLY || operation == GM_OPERATION_DIVIDE;
    if (compiling->linear && ((p | q) & GM_NEEDS_UNKNOWNS) && !sum) {
        const unsigned factor = p & GM_NEEDS_UNKNOWNS ? q : p;
        if (!scaled || (factor & GM_NEEDS_UNKNOWNS) ||
            (operation == GM_OPERATION_DIVIDE && (q & GM_NEEDS_UNKNOWNS))) {
            refuse(compiling, "an equation is linear in its unknowns, and this is not");
        }
        if (factor) {
            refuse(compiling, "the factor of an unknown does not change in time");
        }
    }
    const struct gm_form_type type = a.type.degree == GM_FORM_NUMBER && !unary ? b.type : a.type;
    return made(compiling, (struct gm_form_step){.kind = GM_STEP_OPERATE,
                                                 .type = type,
                                                 .needs = p | q,
                                                 .a = a.step,
                                                 .b = unary ? a.step : b.step,
                                                 .number = operation});
}

static struct part times(struct compiling *compiling, enum gm_form_matrix matrix, struct part a,
                         struct gm_form_type type)
{
    return made_of(compiling, GM_STEP_MATRIX, matrix, a, type);
}

static struct part zero_of(struct compiling *compiling, struct gm_form_type type)
{
    const gm_node_id zero = gm_formula_constant(&compiling->system->graph, 0);
    return made(compiling, (struct gm_form_step){.kind = GM_STEP_SAMPLE,
                                                 .type = type,
                                                 .components = type.degree == 1 ? 2 : 1,
                                                 .nodes = {zero, zero}});
}

static struct part negative(struct compiling *compiling, struct part a)
{
    return operate(compiling, GM_OPERATION_NEGATE, a, a);
}

/* ---- operators ---- */

/* A part as a form: a formula without a place is a 0-form here. */
static struct part form_of(struct compiling *compiling, struct part part)
{
    return is_formula(part) && part.type.degree == GM_FORM_NUMBER ? sampled(compiling, part, primal_0)
                                                                  : decided(compiling, part);
}

static struct part star(struct compiling *compiling, struct part a)
{
    a = form_of(compiling, a);
    require(compiling, a.type.degree != GM_FORM_NUMBER, "star is of a form", a);
    const struct gm_form_type type = {2 - a.type.degree, !a.type.dual};
    /* star star is 1, or -1 of a 1-form: nothing is computed */
    const struct gm_form_step *step = &compiling->program->steps[a.step];
    const bool minus = step->kind == GM_STEP_OPERATE && step->number == GM_OPERATION_NEGATE;
    const struct gm_form_step *inner = minus ? &compiling->program->steps[step->a] : step;
    if (inner->kind == GM_STEP_MATRIX && inner->number >= GM_MATRIX_STAR0 &&
        inner->number <= GM_MATRIX_DUAL_STAR2) {
        const struct part before = {type, inner->a, compiling->now};
        return (a.type.degree == 1) != minus ? negative(compiling, before) : before;
    }
    return times(
        compiling,
        (enum gm_form_matrix)((a.type.dual ? GM_MATRIX_DUAL_STAR0 : GM_MATRIX_STAR0) + a.type.degree), a,
        type);
}

static struct part d(struct compiling *compiling, struct part a)
{
    a = decided(compiling, a);
    if (a.type.degree < 0 || a.type.degree == 2) {
        char text[80];
        refuse(compiling, "d is of a 0-form or a 1-form, and %s is %s",
               text_of(compiling, a.node, text, sizeof text), gm_form_type_text(a.type));
    }
    const struct gm_form_type type = {a.type.degree + 1, a.type.dual};
    const struct gm_form_step *step = &compiling->program->steps[a.step];
    if (step->kind == GM_STEP_MATRIX &&
        step->number == (a.type.dual ? (size_t)GM_MATRIX_DUAL_D0 : (size_t)GM_MATRIX_D0)) { /* d d = 0 */
        return zero_of(compiling, type);
    }
    return times(compiling,
                 (enum gm_form_matrix)((a.type.dual ? GM_MATRIX_DUAL_D0 : GM_MATRIX_D0) + a.type.degree), a,
                 type);
}

static struct part delta(struct compiling *compiling, struct part a)
{
    a = decided(compiling, a);
    require(compiling, a.type.degree >= 1, "delta is of a 1-form or a 2-form", a);
    return negative(compiling, star(compiling, d(compiling, star(compiling, a))));
}

static struct part laplace(struct compiling *compiling, struct part a)
{
    a = decided(compiling, a);
    require(compiling, a.type.degree != GM_FORM_NUMBER, "laplace is of a form", a);
    if (a.type.degree == 0 && !a.type.dual) {
        return times(compiling, GM_MATRIX_LAPLACE, a, a.type);
    }
    if (a.type.degree == 2 && a.type.dual) {
        return star(compiling, laplace(compiling, star(compiling, a)));
    }
    const struct part up = a.type.degree < 2 ? delta(compiling, d(compiling, a)) : a,
                      down = a.type.degree > 0 ? d(compiling, delta(compiling, a)) : a;
    const struct part sum = a.type.degree == 0   ? up
                            : a.type.degree == 2 ? down
                                                 : operate(compiling, GM_OPERATION_ADD, up, down);
    return negative(compiling, sum);
}

static struct part wedge(struct compiling *compiling, struct part a, struct part b)
{
    a = form_of(compiling, a);
    b = form_of(compiling, b);
    const int j = a.type.degree, k = b.type.degree;
    if (j < 0 || k < 0 || a.type.dual || b.type.dual || j + k > 2) {
        refuse(compiling, "wedge is of primal forms of degrees up to 2 together, and these are %s and %s",
               gm_form_type_text(a.type), gm_form_type_text(b.type));
    }
    if (j == 1 && k == 1) {
        if (compiling->linear && ((needs_of(compiling, a) | needs_of(compiling, b)) & GM_NEEDS_UNKNOWNS)) {
            refuse(compiling, "the wedge product of an unknown 1-form is not assembled");
        }
        return made(compiling, (struct gm_form_step){.kind = GM_STEP_WEDGE,
                                                     .type = primal_2,
                                                     .needs = needs_of(compiling, a) | needs_of(compiling, b),
                                                     .a = a.step,
                                                     .b = b.step});
    }
    const struct part scalar = j == 0 ? a : b, other = j == 0 ? b : a;
    const int degree = other.type.degree;
    const struct part mean =
        degree == 0 ? scalar
                    : times(compiling, degree == 1 ? GM_MATRIX_MEAN1 : GM_MATRIX_MEAN2, scalar, other.type);
    return operate(compiling, GM_OPERATION_MULTIPLY, mean, other);
}

/* The velocity's flux; refuses what is not a velocity. */
static struct part flux_of(struct compiling *compiling, struct part u)
{
    const bool fits = fit(compiling, &u, dual_1);
    require(compiling, fits, "the velocity of interior and lie is a dual 1-form", u);
    return star(compiling, u);
}

/* The speed along a 1-form at centres of mass: a(v) area = a ^ star(u); of a dual a, the product of both stars, which
   are turned by 90 degrees. */
static struct part speed_along(struct compiling *compiling, struct part flux, struct part a)
{
    if (!a.type.dual) {
        return star(compiling, wedge(compiling, a, flux));
    }
    const struct part turned = star(compiling, a);
    struct part sum = {0};
    for (int c = 0; c < 3; c++) {
        const enum gm_form_matrix matrix = (enum gm_form_matrix)(GM_MATRIX_CENTRE_X + c);
        const struct part product =
            operate(compiling, GM_OPERATION_MULTIPLY, times(compiling, matrix, flux, dual_0),
                    times(compiling, matrix, turned, dual_0));
        sum = c == 0 ? product : operate(compiling, GM_OPERATION_ADD, sum, product);
    }
    return sum;
}

static struct part interior(struct compiling *compiling, struct part u, struct part a)
{
    a = decided(compiling, a);
    struct part flux = flux_of(compiling, u);
    if (a.type.degree == 1) {
        return speed_along(compiling, flux, a);
    }
    require(compiling, a.type.degree == 2, "interior is of a 1-form or a 2-form", a);
    const bool dual = a.type.dual;
    const struct part density = star(compiling, a);
    const struct gm_form_type type = {1, dual};
    flux = dual ? times(compiling, GM_MATRIX_TRANSFER, flux, type) : flux;
    flux.type = type;
    const struct part mean = times(compiling, dual ? GM_MATRIX_MEAN1 : GM_MATRIX_ACROSS, density, type),
                      jump = times(compiling, dual ? GM_MATRIX_JUMP1 : GM_MATRIX_JUMP2, density, type),
                      size = operate(compiling, GM_OPERATION_ABS, flux, flux);
    return operate(compiling, GM_OPERATION_SUBTRACT, operate(compiling, GM_OPERATION_MULTIPLY, flux, mean),
                   operate(compiling, GM_OPERATION_MULTIPLY, size, jump));
}

/* d interior(u, c). What flows out of a dual cell through the boundary carries its own value; what flows in brings
   nothing. */
static struct part lie(struct compiling *compiling, struct part u, struct part c)
{
    c = decided(compiling, c);
    require(compiling, c.type.degree == 2, "lie is of a 2-form here", c);
    const struct part inside = d(compiling, interior(compiling, u, c));
    if (!c.type.dual) {
        return inside;
    }
    const struct part out = times(compiling, GM_MATRIX_OUT, flux_of(compiling, u), primal_1),
                      twice = operate(compiling, GM_OPERATION_ADD, out,
                                      operate(compiling, GM_OPERATION_ABS, out, out)),
                      through = times(compiling, GM_MATRIX_HALVES, twice, c.type);
    struct part density = star(compiling, c);
    density.type = c.type;
    return operate(compiling, GM_OPERATION_ADD, inside,
                   operate(compiling, GM_OPERATION_MULTIPLY, through, density));
}

/* Refuses a number that is made of forms in an equation. */
static void refuse_nonlocal(struct compiling *compiling, struct part a)
{
    if (compiling->linear && (needs_of(compiling, a) & GM_NEEDS_UNKNOWNS)) {
        refuse(compiling, "an equation has no numbers that are made of its unknowns, and no parts of them");
    }
}

static struct part reduced(struct compiling *compiling, enum gm_form_step_kind kind, struct part a)
{
    refuse_nonlocal(compiling, a);
    return made_of(compiling, kind, 0, a, any_number);
}

static struct part integral(struct compiling *compiling, struct part a)
{
    a = form_of(compiling, a);
    require(compiling, a.type.degree == 0 || a.type.degree == 2, "integral is of a 0-form or a 2-form", a);
    return reduced(compiling, GM_STEP_SUM, a.type.degree == 0 ? star(compiling, a) : a);
}

/* integral(PART, a) */
static struct part around(struct compiling *compiling, gm_node_id part, struct part a)
{
    const struct gm_node *node = &compiling->system->graph.nodes[part];
    if (node->operation != GM_CONSTANT) {
        refuse(compiling, "integral(PART, a) begins with a part of the boundary");
    }
    const bool fits = fit(compiling, &a, primal_1);
    require(compiling, fits, "the integral along a part of the boundary is of a 1-form", a);
    refuse_nonlocal(compiling, a);
    return made_of(compiling, GM_STEP_AROUND, (size_t)node->value, a, any_number);
}

/* at(a, x, y, z) */
static struct part at(struct compiling *compiling, const struct gm_form_call *call)
{
    const struct part a = decided(compiling, compiling->known[call->operands[0]].part);
    require(compiling, a.type.degree == 0, "at is of a 0-form", a);
    refuse_nonlocal(compiling, a);
    struct gm_form_step step = {.kind = GM_STEP_AT,
                                .type = any_number,
                                .needs = needs_of(compiling, a),
                                .a = a.step,
                                .components = call->count - 1};
    for (size_t i = 0; i < step.components; i++) {
        const struct part place = compiling->known[call->operands[i + 1]].part;
        require(compiling, place.type.degree == GM_FORM_NUMBER, "the coordinates of at are numbers", place);
        const struct part number = decided(compiling, place);
        step.needs |= needs_of(compiling, number);
        step.nodes[i] = (gm_node_id)number.step;
    }
    return made(compiling, step);
}

/* Parts of a 1-form by Hodge. */
static struct part part_of(struct compiling *compiling, enum gm_form_operator operator, struct part a)
{
    const bool fits = fit(compiling, &a, primal_1);
    require(compiling, fits, "exact, coexact and harmonic are of a 1-form", a);
    refuse_nonlocal(compiling, a);
    if (operator!= GM_FORM_HARMONIC) {
        return made_of(compiling, operator== GM_FORM_EXACT ? GM_STEP_EXACT : GM_STEP_COEXACT, 0, a, primal_1);
    }
    const struct part exact = made_of(compiling, GM_STEP_EXACT, 0, a, primal_1),
                      coexact = made_of(compiling, GM_STEP_COEXACT, 0, a, primal_1);
    return operate(compiling, GM_OPERATION_SUBTRACT, operate(compiling, GM_OPERATION_SUBTRACT, a, exact),
                   coexact);
}

static struct part inner(struct compiling *compiling, struct part a, struct part b)
{
    if (is_formula(a) && !is_formula(b)) {
        const struct part swap = a;
        a = b;
        b = swap;
    }
    a = decided(compiling, a);
    if (a.type.degree < 0 || !fit(compiling, &b, a.type)) {
        refuse(compiling, "inner is of two forms of one type, and these are %s and %s",
               gm_form_type_text(a.type), gm_form_type_text(b.type));
    }
    require(compiling, b.type.degree != GM_FORM_NUMBER, "inner is of two forms", b);
    struct part other = star(compiling, b);
    other.type = a.type;
    if (a.type.degree == 1 && a.type.dual) {
        other = negative(compiling, other);
        other.type = a.type;
    }
    return reduced(compiling, GM_STEP_SUM, operate(compiling, GM_OPERATION_MULTIPLY, a, other));
}

static void mark_operands(const struct gm_user_system *system, bool *marked, size_t end);
static void compile_nodes(struct compiling *compiling, const bool *marked, size_t end);

/* The integrals along edges of what line `item` gives a let: of a density, or a 1-form. */
static struct part along_edges(struct compiling *compiling, size_t item)
{
    const gm_node_id value = compiling->system->items[item].nodes[0], now = compiling->now;
    if (!compiling->known[value].of_forms) {
        compiling->along = item + 1;
        const struct part along =
            sampled(compiling, (struct part){{GM_FORM_PLACE, false}, NONE, value}, primal_1);
        compiling->along = 0;
        return along;
    }
    bool *marked = gm_arena_take(compiling->arena, compiling->nodes, sizeof *marked);
    marked[value] = true;
    mark_operands(compiling->system, marked, (size_t)value + 1);
    compile_nodes(compiling, marked, (size_t)value + 1);
    compiling->now = now;
    const struct part density = decided(compiling, compiling->known[value].part);
    if (same(density.type, primal_1)) { /* in the sense of the boundary */
        return times(compiling, GM_MATRIX_OUT, density, primal_1);
    }
    require(compiling, density.type.degree == GM_FORM_NUMBER || same(density.type, primal_0),
            "what a let has on the boundary is a 1-form, or its density: a number or a 0-form", density);
    const gm_node_id one = gm_formula_constant(&compiling->system->graph, 1);
    const struct part length = made(
        compiling,
        (struct gm_form_step){.kind = GM_STEP_SAMPLE, .type = primal_1, .components = 1, .nodes = {one}});
    return density.type.degree == 0 ? wedge(compiling, density, length)
                                    : operate(compiling, GM_OPERATION_MULTIPLY, density, length);
}

/* Adds what lines `boundary:` of a let, a dual 1-form, give to its derivative: the parts of dual cells that lie on
   the boundary. */
static struct part closed(struct compiling *compiling, gm_node_id let, struct part derivative)
{
    const struct gm_user_system *system = compiling->system;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word != GM_WORD_BOUNDARY || item->count < 2 || item->nodes[1] != let) {
            continue;
        }
        if (derivative.type.degree != 2 || !derivative.type.dual) {
            refuse(compiling, "a boundary of a let is along a dual 1-form");
        }
        const struct part along = along_edges(compiling, i);
        derivative = operate(compiling, GM_OPERATION_ADD, derivative,
                             made_of(compiling, GM_STEP_CLOSING, i, along, derivative.type));
    }
    return derivative;
}

static struct part called(struct compiling *compiling, const struct gm_form_call *call)
{
    const struct part a = compiling->known[call->operands[0]].part,
                      b = compiling->known[call->operands[call->count > 1 ? 1 : 0]].part;
    switch (call->operator) {
    case GM_FORM_D:
        return closed(compiling, call->operands[0], d(compiling, a));
    case GM_FORM_STAR:
        return star(compiling, a);
    case GM_FORM_DELTA:
        return delta(compiling, a);
    case GM_FORM_LAPLACE:
        return laplace(compiling, a);
    case GM_FORM_WEDGE:
        return wedge(compiling, a, b);
    case GM_FORM_INTERIOR:
        return interior(compiling, a, b);
    case GM_FORM_LIE:
        return lie(compiling, a, b);
    case GM_FORM_FORM:
        for (size_t i = 0; i < call->count; i++) {
            if (compiling->known[call->operands[i]].of_forms) {
                refuse(compiling, "form(f, g) has formulas of x, y, z and t");
            }
        }
        return (struct part){{GM_FORM_COVECTOR, false}, NONE, compiling->now};
    case GM_FORM_EXACT:
    case GM_FORM_COEXACT:
    case GM_FORM_HARMONIC:
        return part_of(compiling, call->operator, a);
    case GM_FORM_AT:
        return at(compiling, call);
    case GM_FORM_INTEGRAL:
        return call->count > 1 ? around(compiling, call->operands[0], b) : integral(compiling, a);
    case GM_FORM_INNER:
        return inner(compiling, a, b);
    default: {
        const struct part c = decided(compiling, a);
        require(compiling, c.type.degree <= 0, "max and min of one form are of a 0-form", c);
        return reduced(compiling, call->operator== GM_FORM_LARGEST ? GM_STEP_LARGEST : GM_STEP_LEAST, c);
    }
    }
}

/* ---- formulas ---- */

/* 0 is of every type. */
static bool is_zero(const struct compiling *compiling, struct part part)
{
    const struct gm_node *node = &compiling->system->graph.nodes[part.node];
    return is_formula(part) && node->operation == GM_CONSTANT && node->value == 0;
}

static struct part two(struct compiling *compiling, enum gm_operation operation, struct part a, struct part b)
{
    const bool sum = operation == GM_OPERATION_ADD || operation == GM_OPERATION_SUBTRACT;
    const bool product = operation == GM_OPERATION_MULTIPLY;
    if (sum && is_zero(compiling, b)) {
        return decided(compiling, a);
    }
    /* decide both from each other: the one that is known, or else the first */
    if (is_formula(a) && !is_formula(b)) {
        b = decided(compiling, b);
    } else {
        a = decided(compiling, a);
    }
    struct part known = is_formula(a) ? b : a, *open = is_formula(a) ? &a : &b;
    if (product && known.type.degree > 0 && !known.type.dual && open->type.degree == GM_FORM_PLACE) {
        return wedge(compiling, a, b);
    }
    if (is_formula(*open) && !(known.type.degree >= 0 && fit(compiling, open, known.type))) {
        *open = decided(compiling, *open);
    }
    const int p = a.type.degree, q = b.type.degree;
    const bool numbers = p == GM_FORM_NUMBER || q == GM_FORM_NUMBER;
    const bool scalars = p <= 0 && q <= 0 && (numbers || same(a.type, b.type));
    if (scalars || (sum && same(a.type, b.type)) || (product && numbers) ||
        (operation == GM_OPERATION_DIVIDE && q == GM_FORM_NUMBER)) {
        return operate(compiling, operation, a, b);
    }
    if (product && !a.type.dual && !b.type.dual && (p == 0 || q == 0)) {
        return wedge(compiling, a, b);
    }
    char first[80], second[80];
    refuse(compiling, "%s is %s and %s %s: they cannot be %s",
           text_of(compiling, a.node, first, sizeof first), gm_form_type_text(a.type),
           text_of(compiling, b.node, second, sizeof second), gm_form_type_text(b.type),
           sum       ? "added"
           : product ? "multiplied with *; wedge(a, b) is a product of forms"
                     : "combined so");
}

static struct part compile(struct compiling *compiling, gm_node_id id)
{
    const struct gm_user_system *system = compiling->system;
    const struct gm_node node = system->graph.nodes[id];
    compiling->now = id;
    if (!compiling->known[id].of_forms) {
        return (struct part){
            {compiling->known[id].of_place ? GM_FORM_PLACE : GM_FORM_NUMBER, false}, NONE, id};
    }
    if (node.operation == GM_VARIABLE && node.a < system->n) {
        const struct gm_form_declared *form = &system->forms[node.a];
        return made(compiling,
                    (struct gm_form_step){.kind = GM_STEP_FORM,
                                          .type = {form->degree, form->dual},
                                          .needs = form->unknown ? GM_NEEDS_UNKNOWNS : GM_NEEDS_FIELDS,
                                          .number = node.a});
    }
    if (node.operation == GM_VARIABLE) {
        return called(compiling, &system->calls[node.a - system->first_call]);
    }
    struct part a = compiling->known[node.a].part;
    if (gm_operation_rows[node.operation].arity == 2) {
        return two(compiling, node.operation, a, compiling->known[node.b].part);
    }
    a = decided(compiling, a);
    if (node.operation != GM_OPERATION_NEGATE && a.type.degree > 0) {
        refuse(compiling, "%s is of a number or a 0-form, and this is %s",
               gm_operation_rows[node.operation].name, gm_form_type_text(a.type));
    }
    return operate(compiling, node.operation, a, a);
}

/* Marks what marked nodes with numbers below `end` are made of, which have lower numbers. */
static void mark_operands(const struct gm_user_system *system, bool *marked, size_t end)
{
    for (size_t i = end; i-- > 0;) {
        const struct gm_node *node = &system->graph.nodes[i];
        if (!marked[i] || node->operation == GM_CONSTANT) {
            continue;
        }
        if (node->operation == GM_VARIABLE) {
            const size_t call = node->a - system->first_call;
            for (size_t k = 0; node->a >= system->first_call && k < system->calls[call].count; k++) {
                marked[system->calls[call].operands[k]] = true;
            }
            continue;
        }
        marked[node->a] = marked[gm_second_operand(node)] = true;
    }
}

/* Compiles the marked nodes below `end` that were not compiled before. */
static void compile_nodes(struct compiling *compiling, const bool *marked, size_t end)
{
    for (gm_node_id i = 0; i < end; i++) {
        struct known *known = &compiling->known[i];
        if (marked[i] && !known->made) {
            compiling->now = i;
            if (known->begun) {
                refuse(compiling, "what a let has on the boundary depends on itself");
            }
            known->begun = true;
            known->part = compile(compiling, i);
            known->made = true;
        }
    }
}

/* Marks what the roots need, and then what depends on forms, place and time. What lines `boundary:` give to lets is
   looked at as well, and compiled where d of the let is. */
static bool *survey(struct compiling *compiling)
{
    const struct gm_user_system *system = compiling->system;
    const size_t nodes = compiling->nodes = system->graph.count;
    struct known *known = compiling->known = gm_arena_take(compiling->arena, nodes + 1, sizeof *known);
    bool *marked = gm_arena_take(compiling->arena, nodes + 1, sizeof *marked);
    for (size_t i = 0; i < compiling->program->root_count; i++) {
        marked[compiling->roots[i].node] = true;
    }
    mark_operands(system, marked, nodes);
    for (size_t i = 0; i < nodes; i++) {
        const struct gm_node *node = &system->graph.nodes[i];
        struct known *here = &known[i];
        if (node->operation == GM_CONSTANT) {
            continue;
        }
        if (node->operation == GM_VARIABLE) {
            const size_t number = node->a;
            here->of_forms = number < system->n || number >= system->first_call;
            here->of_place = number >= system->velocities && number < system->first_call;
            here->of_time = number == system->n;
            here->of_arc = number == system->velocities + GM_FORM_PLACES - 1;
            continue;
        }
        const struct known *a = &known[node->a], *b = &known[gm_second_operand(node)];
        here->of_forms = a->of_forms || b->of_forms;
        here->of_place = a->of_place || b->of_place;
        here->of_time = a->of_time || b->of_time;
        here->of_arc = a->of_arc || b->of_arc;
    }
    return marked;
}

/* The step of a root, of the type that it has to be. */
static void finish(struct compiling *compiling, const struct gm_form_root *root, size_t *step)
{
    struct part part = compiling->known[root->node].part;
    compiling->now = root->node;
    compiling->fault->offset = root->place;
    compiling->along = root->along;
    const bool formula = is_formula(part) && part.type.degree != GM_FORM_COVECTOR;
    const bool zero = root->type.degree >= 0 && is_zero(compiling, part);
    if (root->type.degree == GM_FORM_ANY) {
        part = decided(compiling, part);
    } else if (zero) {
        part = zero_of(compiling, root->type);
    } else if ((root->density && formula && (root->type.degree != 1 || root->along)) ||
               (formula && root->type.degree == 0)) {
        part = sampled(compiling, part, root->type);
    } else if (!fit(compiling, &part, root->type)) {
        char text[80];
        refuse(compiling, "%s is %s, and has to be %s here",
               text_of(compiling, root->node, text, sizeof text), gm_form_type_text(part.type),
               gm_form_type_text(root->type));
    } else if (part.type.degree == GM_FORM_NUMBER && root->type.degree == 0) {
        part = operate(compiling, GM_OPERATION_ADD, zero_of(compiling, root->type), part);
    }
    *step = part.step;
}

static void compile_all(struct gm_arena *arena, void *data)
{
    struct compiling *compiling = data;
    struct gm_form_program *program = compiling->program;
    compiling->arena = arena;
    program->roots = gm_arena_take(arena, program->root_count + 1, sizeof *program->roots);
    const bool *marked = survey(compiling);
    compile_nodes(compiling, marked, compiling->nodes);
    for (size_t i = 0; i < program->root_count; i++) {
        finish(compiling, &compiling->roots[i], &program->roots[i]);
    }
    gm_arena_need(arena, !compiling->system->graph.failed);
}

bool gm_form_compile(struct gm_form_program *program, struct gm_user_system *system,
                     const struct gm_form_root *roots, size_t count, bool linear, struct gm_fault *fault)
{
    struct compiling compiling = {
        .program = program, .system = system, .roots = roots, .fault = fault, .linear = linear};
    *program = (struct gm_form_program){.root_count = count};
    *fault = (struct gm_fault){0};
    return gm_arena_run(system->arena, compile_all, &compiling);
}
