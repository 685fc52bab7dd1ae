/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_SCOPE_H
#define GM_CORE_MODEL_SCOPE_H

#include "core/expression/choices.h"
#include "core/model/system.h"

/* A system's text while it is read: its lines, the names that they declare, and formulas, in which a name that
   needs another one first waits for it. Everything that returns a bool says by false that reading->fault has
   been told. */

struct gm_system_word_row {
    const char *word;
    enum gm_line_identity identity;
    unsigned kinds; /* 1 << enum gm_system_kind of those that may have it */
};
extern const struct gm_system_word_row gm_system_words[GM_WORDS];

struct gm_system_line {
    enum gm_system_word word;
    size_t place;
    struct gm_span value;
};

enum gm_entry_role {
    GM_ENTRY_COMPONENT,
    GM_ENTRY_VELOCITY,
    GM_ENTRY_PARAMETER,
    GM_ENTRY_TIME,
    GM_ENTRY_CHOICE, /* of words */
    GM_ENTRY_NAMED,
    GM_ENTRY_OBSERVED /* named, too, by a line of its own that is read later */
};

/* A name of the system, or an element of a list. */
struct gm_entry {
    char *name;                   /* its own, closed by a NUL, once it is among the entries */
    size_t length, place, number; /* the number among those of its role */
    bool indexed;
    long index;
    enum gm_entry_role role;
    bool read;            /* of parameters and what is named: `node` is what they are */
    struct gm_span value; /* their formula */
    long element;         /* the value of the index that is bound in it */
    struct gm_span bound; /* that index; empty: none */
    gm_node_id node;
};

struct gm_reading {
    struct gm_user_system *system;
    const char *text;
    size_t length;
    char *chosen; /* a text of the reading's own, in which other words of choices are comments */
    struct gm_system_line *lines;
    size_t line_count;
    struct gm_entry *entries;
    size_t entry_count, entry_capacity;
    uint32_t *table; /* open addressing, number + 1 */
    size_t slots;
    uint32_t wanted;        /* the entry that has to be read first */
    bool fixed;             /* parameters are constants in what is read */
    bool structural;        /* and the graph depends on their values */
    bool initial;           /* NAME(0) has a meaning */
    bool exact;             /* exact(NAME) has one */
    struct gm_span counter; /* the index that a line is repeated with, and its value; empty: there is none */
    long counted;
    size_t component_count, velocity_count, parameter_count;
    const struct gm_system_value *values; /* that were given */
    size_t value_count;
    struct gm_first_fault fault;
};

/* Frees what the reading holds beside the system. */
void gm_reading_close(struct gm_reading *reading);

/* Room for one more of an array of `count` that grows by doubling. */
bool gm_reading_reserve(struct gm_reading *reading, void **array, size_t count, size_t size);

/* Those that hold for the words that are chosen. */
bool gm_reading_lines(struct gm_reading *reading);
/* The first line with a word; NULL: there is none. */
const struct gm_system_line *gm_reading_line(const struct gm_reading *reading, enum gm_system_word word);
/* Says that what stands at a place has the name of an entry. Returns false. */
bool gm_reading_fail_twice(struct gm_reading *reading, size_t place, const struct gm_entry *first);
/* Words with one blank between them; malloc'ed. NULL: told as a fault. */
char *gm_reading_text(struct gm_reading *reading, struct gm_span span);

/* Whether a name is a key of command lines, a column of tables or a function. */
bool gm_reading_reserves(const char *name, size_t length);
/* NULL: there is no such name. It holds until a name is added. */
struct gm_entry *gm_reading_entry(const struct gm_reading *reading, const char *name, size_t length,
                                  bool indexed, long index);
/* A copy of the entry, whose name may be a part of the text. */
bool gm_reading_add(struct gm_reading *reading, struct gm_entry entry);
/* Reads a parameter or a let, and first what it needs. */
bool gm_reading_define(struct gm_reading *reading, uint32_t number);

bool gm_reading_formula(struct gm_reading *reading, struct gm_span span, gm_node_id *node);
/* With an index of the name `bound` that is `element`; NULL: none. */
bool gm_reading_bound(struct gm_reading *reading, struct gm_span span, const struct gm_span *bound,
                      long element, gm_node_id *node);
/* A number that parameters alone make. */
bool gm_reading_number(struct gm_reading *reading, struct gm_span span, double *value);
/* A whole one, on which the graph is built. */
bool gm_reading_whole(struct gm_reading *reading, struct gm_span span, long *value);
/* low .. high, of `what` there are at most GM_MOST_COMPONENTS; low - 1 says that there is none. False without a fault:
   the span has no bounds. */
bool gm_reading_bounds(struct gm_reading *reading, struct gm_span span, const char *what, long *low,
                       long *high);

/* What may follow a value: low .. high; meaning; unit. NaN: no range is given. */
struct gm_written_range {
    double low, high;
    struct gm_span meaning, unit; /* empty: none is given */
};
bool gm_reading_range(struct gm_reading *reading, struct gm_span rest, struct gm_written_range *range);

/* NAME, NAME[low .. high], NAME[index] */
struct gm_target {
    struct gm_span name, index; /* empty: there is none */
    struct gm_span value;       /* behind the = */
};
/* Takes a target off the front of `rest`. */
bool gm_reading_target(struct gm_reading *reading, struct gm_span *rest, struct gm_target *target);
/* What a target with that index, if it has one, means; NULL: told as a fault. */
struct gm_entry *gm_reading_sought(struct gm_reading *reading, const struct gm_target *target, long index);
/* NAME = formula */
bool gm_reading_assignment(struct gm_reading *reading, struct gm_span span, struct gm_target *target);
struct gm_entry gm_reading_entry_for(const struct gm_reading *reading, const struct gm_target *target,
                                     enum gm_entry_role role);
/* Calls `each`, with its formula, for the elements that a target names: one, or, where the index is a free
   name, all of a list. */
bool gm_reading_elements(struct gm_reading *reading, const struct gm_target *target,
                         bool (*each)(struct gm_reading *reading, struct gm_entry *entry,
                                      const struct gm_target *target, gm_node_id node, void *data),
                         void *data);

#endif
