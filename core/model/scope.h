/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_SCOPE_H
#define GM_CORE_MODEL_SCOPE_H

#include "core/model/system.h"

/* A system's text while it is read: its lines, the names that they declare, and formulas, in which a name
   that needs another one first waits for it. All functions are called inside a body of the system's arena, which they
   leave with a fault (gm_system_refuse) or when out of memory. */

extern const struct gm_line_word gm_system_words[GM_WORDS]; /* kinds: enum gm_system_kind */

enum gm_entry_role {
    GM_ENTRY_COMPONENT,
    GM_ENTRY_VELOCITY,
    GM_ENTRY_PARAMETER,
    GM_ENTRY_TIME,
    GM_ENTRY_CHOICE,   /* choice of words */
    GM_ENTRY_FUNCTION, /* with arguments */
    GM_ENTRY_NAMED,
    GM_ENTRY_OBSERVED /* named by its own line, which is read later */
};

/* A name of the system, or an element of a list. */
struct gm_entry {
    const char *name;             /* NUL-terminated among the entries */
    size_t length, place, number; /* number within its role */
    bool indexed;
    long index;
    enum gm_entry_role role;
    bool read;            /* parameters and names: `node` is read */
    struct gm_span value; /* formula of a parameter or a name */
    gm_node_id node;
};

struct gm_reading {
    struct gm_user_system *system;
    const char *text;
    size_t length;
    struct gm_arena *scratch; /* until the text is read */
    const struct gm_line_words *words;
    struct gm_read_line *lines;
    size_t line_count;
    struct gm_entry *entries;
    size_t entry_count, entry_capacity;
    uint32_t *table; /* open addressing, entry number + 1 */
    size_t slots;
    uint32_t wanted; /* entry that must be read first */
    struct gm_reading_context {
        bool fixed;               /* parameters are constants in formulas */
        bool exact;               /* exact(NAME) has a meaning */
        struct gm_index repeated; /* the index of a repeated line; without letters: none */
        struct gm_index element;  /* the index of all elements of an assigned list; without letters: none */
    } context;
    bool structural;       /* the graph depends on values of parameters */
    bool without_tangents; /* the motion alone is read */
    bool ignores_breaks;   /* given: breaks=ignored */
    bool along;            /* the value of a form on a part of the boundary is read, which may hold s */
    bool degenerate;       /* L is linear in the velocities: the text is read again, without momenta */
    size_t component_count, velocity_count, parameter_count;
    struct gm_definition *definitions; /* the functions of the text */
    size_t definition_count;
    const struct gm_system_value *values; /* given by the caller */
    size_t value_count;
    /* Rooms only: reads a line, or returns false to leave it to the reader of systems; and returns why a formula
       may not hold a part, or NULL. */
    bool (*line)(struct gm_reading *reading, const struct gm_read_line *line);
    bool without_forms; /* a formula is read that may not hold forms of the flow */
    const char *(*withheld)(struct gm_reading *reading, gm_node_id part);
};

/* Reads the whole text, of a system whose kind is found first, or of a room. In a body of the system's arena. */
void gm_reading_read(struct gm_reading *reading);
/* A line mesh: of a generator while it is read: its numbers in their order, "rectangle 2 1 16", then options after
   semicolons, which may be numbers by their names, "width 2; height 1; edges 16". */
enum { GM_MESH_NUMBERS = 5 }; /* width, height, edges, strips, irregular */
struct gm_mesh_line {
    struct gm_span numbers, options; /* what is not read yet */
    size_t count, number; /* of numbers in their order; of the last one, GM_MESH_NUMBERS for an option */
    struct gm_span value; /* of the last number, or the whole option */
};
/* Begins it. Returns the span of the generator's word. */
struct gm_span gm_mesh_begin(struct gm_reading *reading, const struct gm_read_line *line,
                             struct gm_mesh_line *mesh);
/* Reads the next number or option; false after the last. */
bool gm_mesh_next(struct gm_reading *reading, struct gm_mesh_line *mesh);
/* Adds an item of a line. */
struct gm_system_item *gm_reading_item(struct gm_reading *reading, const struct gm_read_line *line,
                                       struct gm_span name);

/* True if exact(NAME) has a meaning for such a system. */
static inline bool gm_reading_has_solution(const struct gm_reading *reading)
{
    return reading->system->kind <= GM_POISSON;
}

/* Reads the lines that hold for the chosen words. */
void gm_reading_lines(struct gm_reading *reading);
/* The first line that has the word; NULL: none. */
const struct gm_read_line *gm_reading_line(const struct gm_reading *reading, enum gm_system_word word);
/* Refuses a second definition of an entry. */
_Noreturn void gm_reading_refuse_second(struct gm_reading *reading, size_t place,
                                        const struct gm_entry *first);
/* Words with one blank between them, in the system's memory. */
char *gm_reading_text(struct gm_reading *reading, struct gm_span span);
/* Takes the first word off the front; what is left has no blanks before it. */
struct gm_span gm_reading_word(const struct gm_reading *reading, struct gm_span *rest);
/* The text from one offset to another, without blanks and comments around it. */
struct gm_span gm_reading_between(const struct gm_reading *reading, size_t begin, size_t end);

/* True if a name is a key of command lines, a column of tables or a function. */
#define GM_RESERVED " is reserved: it is a key, a line, a column of tables or a function"
bool gm_reading_reserves(const char *name, size_t length);
/* The names of a room's last variables, then NULL. */
extern const char *const gm_room_variables[GM_ROOM_VARIABLES + 1];
/* The entry of that name, valid until a name is added, or NULL. */
struct gm_entry *gm_reading_entry(const struct gm_reading *reading, const char *name, size_t length,
                                  bool indexed, long index);
/* The entry of a name in the text, without an index; NULL: none. */
struct gm_entry *gm_reading_named(const struct gm_reading *reading, struct gm_span name);
/* Adds a copy of the entry; its name may be a part of the text. */
void gm_reading_add(struct gm_reading *reading, struct gm_entry entry);
/* Reads the body of a function that no formula has called, for its faults. */
void gm_reading_check(struct gm_reading *reading, struct gm_definition *definition);
/* Reads a parameter or a let, after all names that it needs. */
void gm_reading_define(struct gm_reading *reading, uint32_t number);

gm_node_id gm_reading_formula(struct gm_reading *reading, struct gm_span span);
/* Reads a formula that may hold exact(NAME). */
gm_node_id gm_reading_formula_of_exact(struct gm_reading *reading, struct gm_span span);
/* Reads a condition, as a node that is 1 or 0. */
gm_node_id gm_reading_condition(struct gm_reading *reading, struct gm_span span);
/* Reads a number in parameters alone. */
double gm_reading_number(struct gm_reading *reading, struct gm_span span);
/* Reads such a number that has to be finite. */
double gm_reading_finite(struct gm_reading *reading, struct gm_span span);
/* Reads a whole number on which the graph depends. */
long gm_reading_whole(struct gm_reading *reading, struct gm_span span);
/* Reads low .. high, at most GM_MOST_COMPONENTS of `what`; high = low - 1: none. False: the span has no bounds. */
bool gm_reading_bounds(struct gm_reading *reading, struct gm_span span, const char *what, long *low,
                       long *high);

/* A range after a value: low .. high; meaning; unit. NaN: no range. */
struct gm_written_range {
    double low, high;
    struct gm_span meaning, unit; /* empty: not given */
};
struct gm_written_range gm_reading_range(struct gm_reading *reading, struct gm_span rest);

/* NAME, NAME[low .. high], NAME[index] */
struct gm_target {
    struct gm_span name, index; /* empty: a name without index */
    struct gm_span value;       /* text after the = */
};
/* Takes a target off the front of `rest`. */
struct gm_target gm_reading_target(struct gm_reading *reading, struct gm_span *rest);
/* The entry of a target, with the index if it has one. */
struct gm_entry *gm_reading_sought(struct gm_reading *reading, const struct gm_target *target, long index);
/* Reads NAME = formula. */
struct gm_target gm_reading_assignment(struct gm_reading *reading, struct gm_span span);
struct gm_entry gm_reading_entry_for(const struct gm_reading *reading, const struct gm_target *target,
                                     enum gm_entry_role role);
/* Calls `each`, with its formula, for the elements of a target: one, or all of a list if the index is a free
   name. */
void gm_reading_elements(struct gm_reading *reading, const struct gm_target *target,
                         void (*each)(struct gm_reading *reading, struct gm_entry *entry,
                                      const struct gm_target *target, gm_node_id node, void *data),
                         void *data);

/* ---- core/model/options.c ---- */

/* Adds a node, or the nodes of formulas separated by commas, to an item. */
void gm_item_add(struct gm_reading *reading, struct gm_system_item *item, gm_node_id node);
void gm_item_add_formulas(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest);
/* Adds a number, or numbers separated by commas, to the values of an item without other options; returns how
   many it has now. */
void gm_item_number(struct gm_reading *reading, struct gm_system_item *item, double number);
size_t gm_item_numbers(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest);
/* Reads options, separated by semicolons, into the item of their line. */
void gm_options_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest);
/* Reads a text with {FORMULA}, {FORMULA:pi} and the like into an item. The formulas become its nodes, in
   order; GM_NO_NODE stands for a key of the scene that the system does not define ({dt}, {schemes}). */
void gm_text_read(struct gm_reading *reading, struct gm_system_item *item, struct gm_span span);

/* ---- core/model/declarations.c, in this order: each needs the earlier ones ---- */

/* Finds the kind of the system, and checks that every line belongs to it. */
void gm_declared_kind(struct gm_reading *reading);
/* Finds the lets with arguments, which every formula may call. */
void gm_declared_functions(struct gm_reading *reading);
void gm_declared_parameters(struct gm_reading *reading);
/* Declares components, velocities and the time; the variables then have the order of struct
   gm_system_variable. */
void gm_declared_state(struct gm_reading *reading);
/* Reads the formulas of parameters in other parameters, after all have their numbers. */
void gm_declared_relations(struct gm_reading *reading);
/* Declares lets and observables, except elements of a list. */
void gm_declared_lets(struct gm_reading *reading);

#endif
