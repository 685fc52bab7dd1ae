/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The zero of a value along a step that is repeated with other lengths: T. R. Chandrupatla, Adv. Eng.
   Software 28 (1997) 145, inverse quadratic interpolation if it is safe, else bisection. */
#include "scenes/common/crossing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/run.h"

/* A fraction of the step, and its value. */
struct place {
    double s, value;
};

struct step {
    struct gm_view view; /* view of the last place evaluated */
    double (*value)(const struct gm_view *view);
    double begin, h;
    double *storage; /* storage of gm_run_part */
    bool failed;
};

static struct place place_at(struct step *step, double s)
{
    const struct gm_run *run = step->view.run;
    if (s > 0) {
        step->failed |= !gm_run_part(run, s, step->storage);
    } else {
        memcpy(step->storage, gm_run_before(run), run->problem->n * run->problem->m * sizeof *step->storage);
    }
    step->view.t = step->begin + s * step->h;
    const double value = step->failed ? NAN : step->value(&step->view);
    step->failed |= isnan(value);
    return (struct place){s, value};
}

/* Returns the next place as a fraction of the way from the newest place to the other; `third` is the one
   before. */
static double share(struct place newest, struct place other, struct place third)
{
    const double xi = (newest.s - other.s) / (third.s - other.s),
                 phi = (newest.value - other.value) / (third.value - other.value);
    if (!(phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)) {
        return 0.5;
    }
    return newest.value / (other.value - newest.value) * third.value / (other.value - third.value) +
           (third.s - newest.s) / (other.s - newest.s) * newest.value / (third.value - newest.value) *
               other.value / (third.value - other.value);
}

double gm_crossing_find(const struct gm_view *view, double (*value)(const struct gm_view *view),
                        double *state)
{
    enum { MOST = 60, ALIGNMENT = 128 };
    const double tolerance = 2.2e-16;
    const size_t size = view->problem->n * view->problem->m * sizeof *state;
    struct step step = {.view = *view, .value = value, .begin = view->t - view->dt, .h = view->dt};
    step.storage = gm_run_repeats(view->run)
                       ? aligned_alloc(ALIGNMENT, (2 * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT)
                       : NULL;
    if (!step.storage) {
        return NAN;
    }
    step.view.state = step.storage;
    struct place other = place_at(&step, 0), newest = place_at(&step, 1), third = other;
    const bool below = newest.value < 0; /* sign at the end of the step */
    step.failed |= (other.value < 0) == below;
    double t = 0.5;
    for (int i = 0; i < MOST && !step.failed && fabs(newest.s - other.s) > 2 * tolerance; i++) {
        const struct place next = place_at(&step, newest.s + t * (other.s - newest.s));
        if ((next.value < 0) == (newest.value < 0)) {
            third = newest;
        } else {
            third = other;
            other = newest;
        }
        newest = next;
        const double least = tolerance / fabs(other.s - newest.s);
        t = fmin(fmax(share(newest, other, third), least), 1 - least);
    }
    const struct place beyond = (newest.value < 0) == below ? newest : other;
    place_at(&step, beyond.s);
    memcpy(state, step.storage, size);
    free(step.storage);
    return step.failed ? NAN : beyond.s;
}
