/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes of a graph as straight code, to be computed many times: for one state, or for many at once. What a
   sum over a list has written out becomes a loop again: the same operation on many operands is one
   instruction, and so are the sums of many terms. */
#ifndef GM_CORE_TAPE_H
#define GM_CORE_TAPE_H

#include "core/arena.h"
#include "core/expression/derivative.h"

/* One operation on registers. GM_VARIABLE is a copy of a; GM_REPEATED is batch number `to`, GM_SUMMED sums
   number `to`. */
struct gm_instruction {
    uint16_t operation;
    uint16_t way; /* four times the operation, + 1 if a, + 2 if b is what the instruction before has made */
    uint32_t to, a, b;
};
enum { GM_REPEATED = GM_OPERATIONS, GM_SUMMED };

/* An operation repeated `count` times, for registers to, to + 1 ..: the operands lie in as many registers
   from `at` on, are all register `at`, or those of lists[at], lists[at + 1] .. */
struct gm_repeated {
    uint32_t operation, count, to;
    struct gm_operands {
        enum { GM_IN_A_ROW, GM_THE_SAME, GM_LISTED } lie;
        uint32_t at;
    } a, b;
};

/* Up to GM_ABREAST long sums beside each other, for registers to, to + 1 ..: lists[at] begins with a row
   of first terms; each row that follows has the operation, GM_OPERATION_ADD or _SUBTRACT, and then the
   registers of the next terms. A sum that has no such term now adds -0 or subtracts 0, which changes no
   bit. */
enum { GM_ABREAST = 8 };
struct gm_sums {
    uint32_t to, count, rows, at;
};

/* The registers: inputs, constants, outputs, and what lies between. It does not change while it is computed,
   so threads may share it. */
struct gm_tape {
    struct gm_instruction *code;
    size_t length;
    struct gm_repeated *batches;
    struct gm_sums *sums;
    uint32_t *lists;
    double *constants;
    struct gm_arena *arena; /* that owns these */
    size_t inputs, constant_count, outputs, registers;
    size_t first_used, last_used; /* the inputs that occur are among [first, last) */
    bool rolled;                  /* it has batches and sums */
    /* The tape for one state alone, if batches are faster there but not for blocks of members; else NULL. */
    struct gm_tape *rows;
};

/* The code of `count` nodes. Variables 0 .. inputs - 1 are its inputs, every other one is the constant
   values[number]; what depends on no input is computed here, once. The operations are those of the graph,
   one by one, so that the bits are those of gm_formula_evaluate. The time is that of what the nodes are
   made of, not of the graph. Returns false when out of memory; the caller closes it in both cases. */
bool gm_tape_open(struct gm_tape *tape, const struct gm_formula *graph, const gm_node_id *nodes, size_t count,
                  size_t inputs, const double *values);
void gm_tape_close(struct gm_tape *tape);
/* Leaves the body of an arena if the tape was not opened, else lets the arena close it. */
void gm_tape_keep(struct gm_arena *arena, struct gm_tape *tape, bool opened);

/* The Jacobian matrix d nodes[row] / d variable; of the components of a gradient, the Hessian. Inside a body of the
   arena, which holds the entries. */
struct gm_sparse gm_sparse_jacobian(struct gm_arena *arena, struct gm_formula *graph, const gm_node_id *nodes,
                                    size_t rows, const bool *marked, size_t variables);
/* Returns `count` nodes, followed by those of a matrix. */
gm_node_id *gm_sparse_nodes(struct gm_arena *arena, const gm_node_id *before, size_t count,
                            const struct gm_sparse *jacobian);

/* Goes through the operations one by one, those that are repeated and the terms of sums as well: false at the
   end. `at` is {0} at first. */
struct gm_tape_place {
    size_t instruction;
    uint32_t member, row;
};
bool gm_tape_next(const struct gm_tape *tape, struct gm_tape_place *at, struct gm_instruction *now);

/* The nodes' values for m members: inputs (inputs * m) and outputs (count * m) lie [number * m + member],
   and do not overlap. When out of memory, which is noted (core/memory.h), the outputs are NaN. A member's
   bits do not depend on m. */
void gm_tape_values(const struct gm_tape *tape, const double *inputs, double *outputs, size_t m);

/* gm_tape_values with member i's number k at inputs[k * inputs_apart + i], outputs[k * outputs_apart + i]. */
void gm_tape_block(const struct gm_tape *tape, const double *inputs, size_t inputs_apart, double *outputs,
                   size_t outputs_apart, size_t m);

#endif
