/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system that somebody wrote down: what its file says, as formulas of one graph. docs/systems.md tells the
   words. */
#ifndef GM_CORE_MODEL_SYSTEM_H
#define GM_CORE_MODEL_SYSTEM_H

#include "core/expression/choices.h"
#include "core/expression/derivative.h"
#include "core/expression/identity.h"
#include "core/expression/reader.h"
#include "core/expression/writer.h"

enum gm_system_kind {
    GM_CANONICAL,  /* coordinates, then their momenta; H */
    GM_LAGRANGIAN, /* the same state; L of coordinates and velocities */
    GM_RATES,      /* components with their rates */
    GM_POISSON,    /* components, a bracket, H */
    GM_FIELD,      /* u of x and t, and u_t: u_tt = u_xx - V'(u) */
    GM_EVOLUTION,  /* fields u, v .. of x and t, whose rates, or those of their masses, are told */
    GM_MATRICES,   /* components z of x and t: K z_t + L z_x = grad S(z), K and L skew */
    GM_SYSTEM_KINDS
};

enum gm_system_word {
#define GM_WORD(constant, ...) GM_WORD_##constant,
#include "core/model/words.def"
#undef GM_WORD
    GM_WORDS
};

enum { GM_LARGEST_SYSTEM = 100000000, GM_MOST_COMPONENTS = 100000 };

/* Of an evolution: the most fields, and the highest derivative over x that their rates may hold. */
enum { GM_MOST_FIELDS = 4, GM_MOST_DERIVATIVES = 4 };
/* Of a system of matrices: the most components. */
enum { GM_MOST_OF_MATRICES = 8 };

/* A variable of the graph. Their numbers: the n components, t, the parameters, of a Lagrangian the n / 2
   velocities, of a field x and u_x, of matrices x, of an evolution x, all u_x, all u_xx .. u_xxxx, the n components at the
   start, x(0), and, of what moves in t alone, the n components of the exact solution, exact(x). */
struct gm_system_variable {
    char *name;           /* "q", "m[2]" */
    double value;         /* of a parameter; else NaN */
    char *text;           /* of a parameter, as it is written; else NULL */
    double low, high;     /* its range; NaN: none is given */
    char *meaning, *unit; /* "" or NULL: none is given */
    bool fixed;           /* it is in an index or a bound: another value is another graph */
    bool angle;           /* periodic */
    bool derived;         /* its start follows from parameters and other starts, and is not a key */
    /* Of components, and of velocities where they are given; of a parameter its formula in others, unless it
       was given. Else GM_NO_NODE. */
    gm_node_id start;
    size_t start_place; /* where that stands in the text; of a parameter its name */
    gm_node_id force, exact;
    gm_node_id jump; /* of a component of matrices */
};

enum gm_system_option_word {
#define GM_OPTION(constant, ...) GM_OPTION_##constant,
#include "core/model/option_words.def"
#undef GM_OPTION
    GM_OPTIONS
};

/* An option of a line: its word, and what of text, formula and numbers follows that word. */
struct gm_system_option {
    enum gm_system_option_word word;
    size_t place;
    char *text;
    gm_node_id node;
    double *numbers;
    size_t count;
};

/* What a line with formulas, or with options, says. */
struct gm_system_item {
    enum gm_system_word word;
    char *name; /* of let, invariant, casimir, symmetry, observe, graph, figure; the key of a stability; "" */
    char *words; /* of figure, work, stability: key=value by blanks; NULL */
    char *text;  /* of a text, also behind require, level, figure, dt and until; NULL */
    struct gm_system_option *options;
    size_t option_count;
    size_t place; /* of the line's text */
    gm_node_id *nodes;
    size_t count;
    double low, high; /* of dt and until, with their meaning as the text: the range; NaN: none is given */
    double value;     /* of compile: of a parameter, and */
    size_t variable;  /* its number */
    bool periodic;    /* a section at equal times: nodes[0] is the period */
    bool in_section;  /* a level */
    bool alone;       /* a section that is the usual picture */
    enum gm_identity check; /* of invariants, Casimirs and symmetries */
};
/* nodes: of a section what becomes 0, the two that are shown, and what must be positive; of a symmetry the
   generator, one for a coordinate or component, and last its momentum map; of a rod one end and the other; of a
   surface its three half axes; of a mass the formula; of dt, until and steps the number, in parameters; of require
   and level the formula first, and of every text then those in its braces, GM_NO_NODE for a key of the scene. */

struct gm_user_system {
    enum gm_system_kind kind;
    char *source; /* the text that it was read from, closed by a NUL */
    size_t length;
    bool typed; /* the text is made of words: its lines are nobody's */
    struct gm_written_choices choices;
    struct gm_formula graph;
    char *texts[GM_WORDS]; /* of the words that are texts; NULL: not given */
    size_t n;
    bool timed; /* t occurs in its equations */
    struct gm_system_variable *variables;
    size_t variable_count, parameters, velocities, initial,
        exact; /* where these begin; parameters end at velocities, `exact` is variable_count of fields */
    gm_node_id energy; /* H, L, V or S */
    /* Of the n components; of a Lagrangian those of the coordinates are missing, of a field the second is
       without u_xx, of matrices they are the derivatives of S. */
    gm_node_id *rates;
    gm_node_id *momenta;     /* of a Lagrangian: dL/dv */
    struct gm_sparse mass;   /* and d2L/dv2, of dL/dv number `row` over velocity number `column` */
    gm_node_id *bracket;     /* of a Poisson system, n * n */
    gm_node_id *matrices;    /* K, then L, n * n each, and */
    size_t *matrix_places;   /* where their entries stand in the text */
    enum gm_identity jacobi; /* of the bracket */
    size_t bracket_place;    /* of the bracket's last line in the text */
    struct gm_system_item *items;
    size_t item_count;
    gm_node_id *facets; /* what core/model/facts.c found */
    const char **parts; /* names of nodes, by number, for naming; NULL behind part_count */
    size_t part_count;  /* that were read; what follows was derived */
};

/* A parameter that is to have another value, "N", "5", or a choice another word. */
struct gm_system_value {
    const char *name, *text;
};

void gm_system_close(struct gm_user_system *system);

/* Whether it is a field on a line. */
static inline bool gm_system_is_field(const struct gm_user_system *system)
{
    return system->kind == GM_FIELD || system->kind == GM_EVOLUTION || system->kind == GM_MATRICES;
}

/* Formulas of a field anew, with x as variable 0 and t as variable 1. False: out of memory. */
bool gm_system_place(struct gm_user_system *system, gm_node_id *nodes, size_t count);

/* Item number `number` of those that a word made; NULL: there are fewer. */
const struct gm_system_item *gm_system_item_of(const struct gm_user_system *system, enum gm_system_word word,
                                               size_t number);

/* What lists call it: its name, or else its title; NULL: it has none. */
static inline const char *gm_system_title(const struct gm_user_system *system)
{
    return system->texts[GM_WORD_NAME] ? system->texts[GM_WORD_NAME] : system->texts[GM_WORD_TITLE];
}

/* Whether an item's name is that of an observable, or of its error. */
static inline bool gm_system_is_observed(const struct gm_system_item *item)
{
    return item->word == GM_WORD_OBSERVE || item->word == GM_WORD_INVARIANT ||
           item->word == GM_WORD_CASIMIR || item->word == GM_WORD_SYMMETRY;
}

/* An item's option; NULL: it has none of that word. */
const struct gm_system_option *gm_system_option(const struct gm_system_item *item,
                                                enum gm_system_option_word word);
/* The text of that option, or of none `otherwise`. */
const char *gm_system_option_text(const struct gm_system_item *item, enum gm_system_option_word word,
                                  const char *otherwise);

/* The first number of that option, or of none `otherwise`. */
double gm_system_option_number(const struct gm_system_item *item, enum gm_system_option_word word,
                               double otherwise);

/* The names of variables and of lets. It holds as long as the system. */
struct gm_naming gm_system_naming(const struct gm_user_system *system);

#endif
