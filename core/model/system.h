/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined system: its file, as formulas of one graph. docs/systems.md describes the words. */
#ifndef GM_CORE_MODEL_SYSTEM_H
#define GM_CORE_MODEL_SYSTEM_H

#include "core/arena.h"
#include "core/expression/derivative.h"
#include "core/expression/identity.h"
#include "core/expression/writer.h"
#include "core/model/choices.h"

enum gm_system_kind {
    GM_CANONICAL,  /* coordinates, then their momenta; H */
    GM_LAGRANGIAN, /* the same state; L of coordinates and velocities */
    GM_RATES,      /* components with their rates */
    GM_POISSON,    /* components, a bracket, H; or coordinates, theta, H */
    GM_FIELD,      /* u of x and t, and u_t: u_tt = u_xx - V'(u) */
    GM_EVOLUTION,  /* fields u, v .. of x and t, with their rates, or rates of their masses */
    GM_MATRICES,   /* components z of x and t: K z_t + L z_x = grad S(z), K and L skew */
    GM_FORMS,      /* discrete differential forms on triangles, with their rates or equations */
    GM_ROOM,       /* a flow in a room (core/flow/room.h), which reads lines of its own */
    GM_SYSTEM_KINDS
};

enum gm_system_word {
#define GM_WORD(constant, ...) GM_WORD_##constant,
#include "core/model/words.def"
#undef GM_WORD
    GM_WORDS
};

enum { GM_LARGEST_SYSTEM = 100 << 20, GM_MOST_COMPONENTS = 100000 };

/* The last parameters of every field: half_length, points. */
enum { GM_RING_PARAMETERS = 2 };

/* Limits of an evolution: fields, and the order of derivatives over x in their rates. */
enum { GM_MOST_FIELDS = 4, GM_MOST_DERIVATIVES = 4 };
enum { GM_MOST_TANGENTS = 8 };
/* The most components of a system of matrices. */
enum { GM_MOST_OF_MATRICES = 8 };

/* The last variables of a room before calls: the place and the part of an inlet, as systems of forms have them, and
   measures of its flow, once that is made. Parameters are constants in its formulas. */
enum gm_room_variable {
    GM_ROOM_AT_X,
    GM_ROOM_AT_Y,
    GM_ROOM_AT_Z, /* without a name */
    GM_ROOM_PART,
    GM_ROOM_PERIMETER,
    GM_ROOM_AREA,
    GM_ROOM_INLET_LENGTH,
    GM_ROOM_UNTIL,
    GM_ROOM_VARIABLES
};

/* The operators of forms: what a formula of a GM_FORMS system may call. */
enum gm_form_operator {
#define GM_FORM_OPERATOR(constant, ...) GM_FORM_##constant,
#include "core/model/form_operators.def"
#undef GM_FORM_OPERATOR
    GM_FORM_OPERATORS
};
/* The forms of a room's flow, which its lets and observables may hold. */
enum gm_room_form { GM_ROOM_PSI, GM_ROOM_W, GM_ROOM_U, GM_ROOM_THETA, GM_ROOM_WARMTH, GM_ROOM_FORMS };
/* The most calls of such a system. */
enum { GM_MOST_FORM_CALLS = 256, GM_FORM_PLACES = 4 /* x y z s */ };

/* A call in a formula: variable number `calls` of the system + its own. */
struct gm_form_call {
    enum gm_form_operator operator;
    gm_node_id operands[4];
    size_t count;
};

/* A form that is declared: a k-form, or a dual one, that evolves or is unknown; its formulas. */
struct gm_form_declared {
    int degree;
    bool dual, unknown;
    size_t place;
    gm_node_id start, exact;
    gm_node_id left, right; /* equation of an unknown */
    size_t equation;        /* its place in the text */
};

/* A variable of the graph. The numbers of variables: n components; t; parameters; for a Lagrangian n / 2
   velocities, for a field x and u_x, for matrices x, for an evolution x, all u_x, all u_xx .. u_xxxx; n
   components at the start, x(0); and, without fields, n components of the exact solution, exact(x). Forms: n forms; t;
   parameters; x, y, z and s, the length along a part of the boundary; calls. Rooms: the forms of the flow; t; parameters;
   enum gm_room_variable; calls. */
struct gm_system_variable {
    char *name;           /* "q", "m[2]" */
    double value;         /* value of a parameter; of t its value at the start; else NaN */
    char *text;           /* text of a parameter's value; else NULL */
    double low, high;     /* range of values; NaN: no range */
    char *meaning, *unit; /* "" or NULL: not given */
    bool fixed;           /* part of an index or a bound: another value is another graph */
    bool angle;           /* periodic */
    bool derived;         /* start follows from parameters and other starts, and is not a key */
    /* The start of a component, or of a given velocity; the formula of a parameter in other parameters,
       unless its value was given. Else GM_NO_NODE. */
    gm_node_id start;
    size_t start_place; /* offset of the start; for a parameter, of its name */
    gm_node_id force, exact;
    gm_node_id jump; /* component of matrices only */
};

enum gm_system_option_word {
#define GM_OPTION(constant, ...) GM_OPTION_##constant,
#include "core/model/option_words.def"
#undef GM_OPTION
    GM_OPTIONS
};

/* An option of a line: its word, and the text, formula or numbers after it. */
struct gm_system_option {
    enum gm_system_option_word word;
    size_t place;
    char *text;
    gm_node_id node;
    double *numbers;
    size_t count;
};

/* The contents of a line with formulas or options. */
struct gm_system_item {
    enum gm_system_word word;
    char *name;  /* name of let, invariant, casimir, symmetry, observe, graph, figure; key of stability; "" */
    char *words; /* key=value of figure, work, stability, separated by blanks; NULL */
    char *text;  /* text of the line, also after require, level, figure, dt and until; NULL */
    struct gm_system_option *options;
    size_t option_count;
    size_t place; /* offset of the line's text */
    gm_node_id *nodes;
    size_t count;
    double low, high;       /* range of dt, until, members, spread; their meaning is the text; NaN: none */
    double value;           /* of the parameter that compile: names; of dt, until, members, spread */
    size_t variable;        /* compile: number of the parameter */
    bool periodic;          /* a section at equal times: nodes[0] is the period */
    bool in_section;        /* a level in the section */
    bool alone;             /* a section that is the default picture */
    bool at_event;          /* a section at the event `name` */
    bool ends;              /* an event that ends the run */
    enum gm_identity check; /* invariants, Casimirs and symmetries only */
};
/* nodes, by word. boundary of forms: the formula, and the let that it is given for, if it is one; `name` is the part of
   the boundary, `variable` the form. section: the function that becomes 0, two functions to show, a function that must be
   positive. event and stop: the function that becomes 0, then for each component its new value, unless the event ends
   the run; then conditions. symmetry: the generator, one per coordinate or component, and last its momentum map. rod: one end
   and the other. surface: three half axes. mass: the formula. dt, until and steps: the number, in parameters.
   require, level and exact-while: first the formula. Every text: then the nodes of its braces, GM_NO_NODE for a key of the
   scene. */

struct gm_user_system {
    struct gm_arena *arena; /* all that is read, until the system is closed */
    struct gm_fault *fault; /* where gm_system_refuse writes, while the text is read and checked */
    enum gm_system_kind kind;
    bool
        alone; /* of kind GM_FIELD: nodes whose cells have a Lagrangian, with a field that is 0 and has no name */
    char *source; /* source text, closed by a NUL */
    size_t length;
    bool typed; /* the text is made of words: its line numbers have no meaning */
    struct gm_written_choices choices;
    bool ignores_breaks; /* given: breaks=ignored (core/model/breaks.h) */
    struct gm_formula graph;
    char *texts[GM_WORDS]; /* texts of the words that have one; NULL: not given */
    size_t n;
    size_t tangents; /* tangent vectors that are carried along; their components are among the n */
    struct gm_form_declared *forms; /* [n] */
    struct gm_form_call *calls;
    size_t call_count, first_call; /* the number of the variable of the first call */
    const char *
        *boundaries; /* parts of the boundary in integral(PART, a), whose first operand is the number */
    size_t boundary_count;
    bool timed; /* equations depend on t */
    struct gm_system_variable *variables;
    size_t variable_count, parameters, velocities, initial,
        exact;         /* first numbers; parameters end at velocities; `exact` is variable_count for fields */
    gm_node_id energy; /* H, L, V or S */
    gm_node_id drift;  /* start: X_t = .. of free nodes; GM_NO_NODE: not given */
    /* [n]; a Lagrangian has none for coordinates, the second of a field is without u_xx, and rates of
       matrices are the derivatives of S. */
    gm_node_id *rates;
    gm_node_id *momenta;   /* Lagrangian: dL/dv */
    struct gm_sparse mass; /* Lagrangian: d2L/dv2, of dL/dv number `row` over velocity number `column` */
    gm_node_id *bracket;   /* Poisson system: [n * n] */
    /* The Poisson system of L = theta(q, t) . q' - H(q, t): theta [n], and Omega [n * n], the inverse of its bracket
       (core/model/equations.c); else NULL. Its velocities are variables. */
    gm_node_id *theta, *omega;
    gm_node_id pfaffian;     /* of Omega: pf^2 = det */
    gm_node_id *matrices;    /* K, then L, [n * n] each */
    size_t *matrix_places;   /* offsets of the entries of `matrices` in the text */
    enum gm_identity jacobi; /* result of the check of Jacobi's identity */
    size_t bracket_place;    /* offset of the bracket's last line */
    struct gm_system_item *items;
    size_t item_count;
    gm_node_id *facets; /* nodes of core/model/facts.c */
    const char **parts; /* names of nodes, by number; NULL from part_count on */
    size_t part_count;  /* number of read nodes; later ones are derived, but for the last, a Pfaffian */
};

/* A new value of a parameter, "N", "5", or a new word of a choice. With the name GM_WITHOUT_TANGENTS the motion alone
   is read. */
#define GM_WITHOUT_TANGENTS "tangents:"
/* The choice of systems with switches whose breaks can be located (core/model/breaks.h). */
#define GM_BREAKS_KEY "breaks"
struct gm_system_value {
    const char *name, *text;
};

/* Reads a system, without derived equations (gm_equations_open). False with a fault, whose sentence is empty
   when out of memory. The caller closes the system in both cases. */
bool gm_system_read(struct gm_user_system *system, const char *text, size_t length,
                    const struct gm_system_value *values, size_t count, struct gm_fault *fault);
void gm_system_close(void *system);

/* Leaves the body of the system's arena with a fault at this place of the text. */
__attribute__((format(printf, 3, 4))) _Noreturn void gm_system_refuse(const struct gm_user_system *system,
                                                                      size_t place, const char *format, ...);
/* The same if something is wrong. */
__attribute__((format(printf, 4, 5))) void
gm_system_refuse_if(const struct gm_user_system *system, bool wrong, size_t place, const char *format, ...);
/* Leaves it for lack of memory if the graph has failed. */
void gm_system_need_graph(const struct gm_user_system *system);

/* True for a field on a line. */
static inline bool gm_system_is_field(const struct gm_user_system *system)
{
    return system->kind == GM_FIELD || system->kind == GM_EVOLUTION || system->kind == GM_MATRICES;
}

/* True for a room. */
static inline bool gm_system_is_room(const struct gm_user_system *system)
{
    return system->kind == GM_ROOM;
}

/* True for a system of forms on a mesh of triangles. */
static inline bool gm_system_is_form(const struct gm_user_system *system)
{
    return system->kind == GM_FORMS;
}

/* The number of components without tangents. */
static inline size_t gm_system_motion(const struct gm_user_system *system)
{
    return system->n / (1 + system->tangents);
}

/* The number of component c of the motion, or of tangent `tangent` from 1 on: the coordinates, their tangents one
   after another, the momenta, their tangents; or components, then their tangents. */
static inline size_t gm_system_component(const struct gm_user_system *system, size_t c, size_t tangent)
{
    const size_t list = gm_system_motion(system) / (system->kind == GM_CANONICAL ? 2 : 1);
    return (c / list * (1 + system->tangents) + tangent) * list + c % list;
}

/* True if a component belongs to a tangent. */
static inline bool gm_system_is_tangent(const struct gm_user_system *system, size_t component)
{
    const size_t list = gm_system_motion(system) / (system->kind == GM_CANONICAL ? 2 : 1);
    return component < system->n && component / list % (1 + system->tangents) > 0;
}

/* Returns true if the points of a field's grid follow from parameters. */
static inline bool gm_system_points_follow(const struct gm_user_system *system)
{
    const gm_node_id node = system->variables[system->velocities - 1].start;
    return node != GM_NO_NODE && system->graph.nodes[node].operation != GM_CONSTANT;
}

/* Returns the derivative of a node over one variable; GM_NO_NODE when out of memory, which the graph notes. */
gm_node_id gm_system_derivative(struct gm_user_system *system, gm_node_id node, size_t variable);
/* Returns `count` entries GM_NO_NODE in the system's memory; NULL when out of memory. */
gm_node_id *gm_system_no_nodes(struct gm_user_system *system, size_t count);
/* Rewrites formulas of a field with x as variable 0 and t as variable 1. False: out of memory. */
bool gm_system_place(struct gm_user_system *system, gm_node_id *nodes, size_t count);

/* Item number `number` of a word, or NULL. */
const struct gm_system_item *gm_system_item_of(const struct gm_user_system *system, enum gm_system_word word,
                                               size_t number);
/* The first item of a word with this name, or NULL. */
const struct gm_system_item *gm_system_item_named(const struct gm_user_system *system,
                                                  enum gm_system_word word, const char *name);

/* The words that a line of few words may have, then NULL: space, boundary of a line, star, interior. */
const char *const *gm_system_choices(enum gm_system_word word);
/* Returns true if the steps of the system end at breaks. */
bool gm_system_locates_breaks(const struct gm_user_system *system);
/* The index of the system's word among these; 0, the first, without such a line. */
size_t gm_system_chosen(const struct gm_user_system *system, enum gm_system_word word);

/* The name in lists: its name, or else its title; NULL: none. */
static inline const char *gm_system_title(const struct gm_user_system *system)
{
    return system->texts[GM_WORD_NAME] ? system->texts[GM_WORD_NAME] : system->texts[GM_WORD_TITLE];
}

/* True if an item's name is an observable, or has an error that is one. */
static inline bool gm_system_is_observed(const struct gm_system_item *item)
{
    return item->word == GM_WORD_OBSERVE || item->word == GM_WORD_INVARIANT ||
           item->word == GM_WORD_CASIMIR || item->word == GM_WORD_SYMMETRY;
}

/* The quantity that an item declares to be constant, a momentum map for a symmetry; GM_NO_NODE: it declares none. */
static inline gm_node_id gm_system_conserved(const struct gm_user_system *system,
                                             const struct gm_system_item *item)
{
    if (item->word == GM_WORD_SYMMETRY) {
        return system->kind <= GM_LAGRANGIAN ? item->nodes[system->n / 2] : GM_NO_NODE;
    }
    return item->word == GM_WORD_INVARIANT || item->word == GM_WORD_CASIMIR ? item->nodes[0] : GM_NO_NODE;
}

/* The option of an item, or NULL. */
const struct gm_system_option *gm_system_option(const struct gm_system_item *item,
                                                enum gm_system_option_word word);
/* The text of that option, or `otherwise`. */
const char *gm_system_option_text(const struct gm_system_item *item, enum gm_system_option_word word,
                                  const char *otherwise);

/* The first number of that option, or `otherwise`. */
double gm_system_option_number(const struct gm_system_item *item, enum gm_system_option_word word,
                               double otherwise);

/* The names of variables and of lets, valid as long as the system. */
struct gm_naming gm_system_naming(const struct gm_user_system *system);

#endif
