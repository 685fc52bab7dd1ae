/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The components of a field on a line, as a file and the values of its parameters define them: their start and their
   exact solution. */
#ifndef GM_CORE_USER_LINE_H
#define GM_CORE_USER_LINE_H

#include "core/arena.h"
#include "core/model/system.h"
#include "core/problem.h"
#include "core/tape.h"

/* The formulas, with x as variable 0 and t as variable 1. */
struct gm_line_formulas {
    gm_node_id start[GM_MOST_OF_MATRICES], exact[GM_MOST_OF_MATRICES];
};
/* Returns the number of components of a state at each node; a wave has one, and another level of it. */
size_t gm_line_components(const struct gm_user_system *system);
/* Returns true if the exact solution of all components is known. */
bool gm_line_is_solved(const struct gm_user_system *system);
/* Derives the formulas; false where memory was refused. The graph grows. */
bool gm_line_derive(struct gm_line_formulas *formulas, struct gm_user_system *system);

/* First in the parameters of every problem that is made of such a file. */
struct gm_user_line {
    struct gm_arena *arena; /* owns the parameters */
    const struct gm_user_system *system;
    struct gm_tape start; /* of x: the components, and behind them derivatives over t of the first */
    struct gm_tape exact; /* of x and t; without outputs if the file gives no exact solution */
    double begin;         /* the time of the start */
};
/* A problem that is being opened, the formulas of its kind, the values of all variables (gm_equations_start), and
   what else its kind needs. */
struct gm_line_opening {
    struct gm_problem *problem;
    const void *formulas;
    const double *values;
    const void *more;
};
/* Opens a problem of such a file by a body, in an arena of its own. Returns false when out of memory: the problem then
   has no parameters. */
bool gm_user_line_problem(void (*body)(struct gm_arena *arena, void *opening),
                          struct gm_line_opening *opening);
/* Closes any problem of such a file. */
void gm_user_line_close(struct gm_problem *problem);
/* The next three work in that body. Takes the problem's parameters, `size` bytes. */
void *gm_user_line_take(struct gm_arena *arena, struct gm_problem *problem,
                        const struct gm_user_system *system, size_t size);
/* Opens the line; `values` are those of all variables (gm_equations_start), `outputs` is the number of nodes of the
   start. */
void gm_user_line_open(struct gm_user_line *line, const gm_node_id *start, size_t outputs,
                       const gm_node_id *exact, const double *values);
/* Opens a tape of other nodes of the file. */
void gm_user_line_tape(const struct gm_user_line *line, struct gm_tape *tape, const gm_node_id *nodes,
                       size_t count, size_t inputs, const double *values);

/* The exact solution of a component; NaN if the file gives none. */
double gm_user_line_exact(const struct gm_user_line *line, size_t component, double x, double t);

/* Writes the exact solution at `count` places and times, [places, then times], as [component * count + i]; without one,
   what starts there. */
void gm_user_line_events(const struct gm_user_line *line, const double *events, size_t count, double *values);

/* The greatest number of nodes that are evaluated together, and that of their outputs. */
enum { GM_LINE_ROOM = 128, GM_LINE_BLOCK = GM_LINE_ROOM * GM_MOST_OF_MATRICES };

/* Writes the outputs at all nodes, [output * points + node]. */
void gm_user_line_start(const struct gm_user_line *line, const struct gm_grid1 *grid, double *y);

/* Writes two levels of one field, at the start and `gap` later, and then the gap. The second is exact if the file gives
   the exact solution; else it follows from the derivatives over t by Taylor's formula. */
void gm_user_line_levels(const struct gm_user_line *line, const struct gm_grid1 *grid, double gap, double *y);

/* Writes formulas of constants and parameters; false when out of memory. */
bool gm_user_line_numbers(const struct gm_user_system *system, const gm_node_id *nodes, size_t count,
                          const double *values, double *numbers);

/* Between which values a component starts, and where at both ends. */
struct gm_line_ends {
    double low, high, left, right;
};
/* Returns true if a component's start is finite and, on a ring, the same at both ends but for the jump (NaN: any) and a
   thousandth of its range; else false with a sentence. */
bool gm_user_line_closes(const struct gm_user_line *line, const struct gm_grid1 *grid, size_t component,
                         double jump, struct gm_line_ends *ends, struct gm_fault *fault);

#endif
