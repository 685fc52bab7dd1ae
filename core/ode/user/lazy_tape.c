/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/user/lazy_tape.h"

#include <math.h>
#include <stdlib.h>

static void close_tape(struct gm_tape *tape)
{
    if (tape) {
        gm_tape_close(tape);
    }
    free(tape);
}

const struct gm_tape *gm_late_tape(struct gm_late_tape *late)
{
    struct gm_tape *tape = atomic_load_explicit(&late->tape, memory_order_acquire), *others = NULL;
    if (tape) {
        return tape;
    }
    tape = calloc(1, sizeof *tape);
    const bool good =
        tape && gm_tape_open(tape, late->graph, late->nodes, late->count, late->inputs, late->values);
    if (!good || !atomic_compare_exchange_strong(&late->tape, &others, tape)) {
        close_tape(tape);
        tape = others;
    }
    return tape;
}

void gm_late_tape_block(struct gm_late_tape *late, const double *inputs, size_t inputs_apart, double *outputs,
                        size_t outputs_apart, size_t m)
{
    const struct gm_tape *tape = gm_late_tape(late);
    for (size_t k = 0; !tape && k < late->count; k++) {
        for (size_t i = 0; i < m; i++) {
            outputs[k * outputs_apart + i] = NAN;
        }
    }
    if (tape) {
        gm_tape_block(tape, inputs, inputs_apart, outputs, outputs_apart, m);
    }
}

void gm_late_tape_values(struct gm_late_tape *late, const double *inputs, double *outputs, size_t m)
{
    const struct gm_tape *tape = gm_late_tape(late);
    if (tape && m == 1) {
        gm_tape_values(tape, inputs, outputs, m);
    } else {
        gm_late_tape_block(late, inputs, m, outputs, m, m);
    }
}

void gm_late_tape_close(void *late)
{
    close_tape(atomic_load(&((struct gm_late_tape *)late)->tape));
}
