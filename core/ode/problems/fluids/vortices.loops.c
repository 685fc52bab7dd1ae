/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sums of Kirchhoff's equations for any number of vortices, and the velocities of passive particles,
   compiled once for each instruction set GM_ISA. Blocks have eight lanes on every instruction set, so the
   order of the additions, and with it every bit, is the same. */
#include <math.h>
#include <string.h>

#include "core/ode/kernel/loops.h"
#include "core/ode/problems/fluids/logarithms.h"

enum {
    LANES = 8,
    STRETCH = 8 * LANES /* number of pairs whose squares are multiplied at once */
};
typedef double lanes __attribute__((vector_size(LANES * 8)));
typedef long long answers __attribute__((vector_size(LANES * 8))); /* -1: yes */

static inline lanes load(const double *from)
{
    lanes value;
    memcpy(&value, from, sizeof value);
    return value;
}

static inline void store(double *to, lanes value)
{
    memcpy(to, &value, sizeof value);
}

static inline double sum_of(lanes value)
{
    return ((value[0] + value[4]) + (value[2] + value[6])) + ((value[1] + value[5]) + (value[3] + value[7]));
}

static double factor_of(const struct gm_problem *problem)
{
    return *(const double *)problem->parameters / (2 * M_PI);
}

/* Adds the effects between vortex i at (x_i, y_i) and the eight vortices from j on, with opposite signs. */
static inline void give(double x_i, double y_i, const double *x, const double *y, size_t j, lanes *mine_x,
                        lanes *mine_y, double *sum_x, double *sum_y)
{
    const lanes dx = x_i - load(x + j), dy = y_i - load(y + j);
    const lanes inverse = 1 / (dx * dx + dy * dy);
    const lanes give_x = dx * inverse, give_y = dy * inverse;
    *mine_x += give_x;
    *mine_y += give_y;
    store(sum_x + j, load(sum_x + j) - give_x);
    store(sum_y + j, load(sum_y + j) - give_y);
}

/* A sum of logarithms as products, one for each lane. */
struct logarithms {
    struct gm_logarithms singly; /* 0, 1 */
    lanes products;
    bool begun; /* false: the products are all 1, whatever is written there */
};

static double logarithms_sum(struct logarithms *sum)
{
    for (int k = 0; k < LANES && sum->begun; k++) {
        gm_logarithms_add(&sum->singly, sum->products[k]);
    }
    sum->begun = false;
    return gm_logarithms_sum(&sum->singly);
}

/* Multiplies by the squares of the distances of (x_i, y_i) from vortices j .. end - 1, whole lanes. Returns
   false, without a change, if a product is near underflow or overflow. */
static inline bool multiply_squares(struct logarithms *sum, double x_i, double y_i, const double *x,
                                    const double *y, size_t j, size_t end)
{
    lanes product = sum->begun ? sum->products : 1 - (lanes){0};
    answers of_note = product == product;
    for (; j < end; j += LANES) {
        const lanes dx = x_i - load(x + j), dy = y_i - load(y + j);
        product *= dx * dx + dy * dy;
        of_note &= (product > 1e-150) & (product < 1e150);
    }
    bool all = true;
    for (int k = 0; k < LANES; k++) {
        all &= of_note[k] != 0;
    }
    if (all) {
        sum->products = product;
        sum->begun = true;
    }
    return all;
}

/* Adds ln of the squares of the distances of (x_i, y_i) from vortices j .. end - 1. */
static inline void add_logarithms(struct logarithms *sum, double x_i, double y_i, const double *x,
                                  const double *y, size_t j, size_t end)
{
    while (j < end) {
        const size_t whole = (end - j) / LANES * LANES, last = j + (whole < STRETCH ? whole : STRETCH);
        if (last > j && multiply_squares(sum, x_i, y_i, x, y, j, last)) {
            j = last;
        } else if (last > j && sum->begun) {
            logarithms_sum(sum);
        } else {
            for (const size_t rest = last > j ? last : end; j < rest; j++) {
                const double dx = x_i - x[j], dy = y_i - y[j];
                gm_logarithms_add(&sum->singly, dx * dx + dy * dy);
            }
        }
    }
}

/* Each pair once. */
static void pair_sum(const struct gm_problem *problem, const double *state, double *f, size_t m)
{
    (void)m;
    const size_t count = (problem->n - 2 * problem->passive) / 2;
    const double *x = state, *y = state + count;
    double *sum_x = f + count, *sum_y = f;
    memset(f, 0, 2 * count * sizeof *f);
    for (size_t i = 0; i < count; i++) {
        const double x_i = x[i], y_i = y[i];
        lanes mine_x = {0}, mine_y = {0};
        size_t j = i + 1;
        for (; j + LANES <= count; j += LANES) {
            give(x_i, y_i, x, y, j, &mine_x, &mine_y, sum_x, sum_y);
        }
        double rest_x = sum_of(mine_x), rest_y = sum_of(mine_y);
        for (; j < count; j++) {
            const double dx = x_i - x[j], dy = y_i - y[j], inverse = 1 / (dx * dx + dy * dy);
            const double give_x = dx * inverse, give_y = dy * inverse;
            rest_x += give_x;
            rest_y += give_y;
            sum_x[j] -= give_x;
            sum_y[j] -= give_y;
        }
        sum_x[i] += rest_x;
        sum_y[i] += rest_y;
    }
    const double factor = factor_of(problem);
    for (size_t i = 0; i < count; i++) {
        sum_y[i] *= -factor;
        sum_x[i] *= factor;
    }
}

static double pair_energy(const struct gm_problem *problem, const double *state)
{
    const size_t count = (problem->n - 2 * problem->passive) / 2;
    struct logarithms sum = {.singly = {.product = 1}};
    for (size_t i = 0; i < count; i++) {
        add_logarithms(&sum, state[i], state[count + i], state, state + count, i + 1, count);
    }
    return -*(const double *)problem->parameters * factor_of(problem) / 2 * logarithms_sum(&sum);
}

#include "core/ode/problems/fluids/multipole.loop.h"

/* Two vortices and their images under z -> -z. */
static void reduced(const struct gm_problem *problem, const double *state, double *f, size_t m)
{
    (void)m;
    const double factor = factor_of(problem);
    const double dx = state[0] - state[1], dy = state[2] - state[3];
    const double sx = state[0] + state[1], sy = state[2] + state[3];
    const double near = 1 / (dx * dx + dy * dy), far = 1 / (sx * sx + sy * sy);
    for (int i = 0; i < 2; i++) {
        const double sign = i == 0 ? 1 : -1, x = state[i], y = state[2 + i], own = 0.5 / (x * x + y * y);
        f[i] = -(factor * (sign * dy * near + y * own + sy * far));
        f[2 + i] = factor * (sign * dx * near + x * own + sx * far);
    }
}

/* Writes `count` velocities at (x, y), due to the active vortices, or to two of them and their images; if strain
   is not NULL also their derivatives, [a, b; b, -a] with a = strain[i], b = strain[count + i]. */
static inline __attribute__((always_inline)) void
carry(const struct gm_problem *problem, const double *active, const double *x, const double *y,
      double *velocity_x, double *velocity_y, double *strain, size_t count, bool images)
{
    const size_t vortices = images ? 2 : (problem->n - 2 * problem->passive) / 2;
    const double *at_x = active, *at_y = active + vortices, factor = factor_of(problem);
    for (size_t i = 0; i < count; i += LANES) {
        const size_t members = count - i < LANES ? count - i : LANES;
        lanes x_i = {0}, y_i = {0}, sum_x = {0}, sum_y = {0}, a = {0}, b = {0};
        memcpy(&x_i, x + i, members * sizeof *x);
        memcpy(&y_i, y + i, members * sizeof *y);
        for (size_t j = 0; j < vortices; j++) {
            for (int sign = 1; sign >= (images ? -1 : 1); sign -= 2) {
                const lanes dx = x_i - sign * at_x[j], dy = y_i - sign * at_y[j];
                const lanes inverse = 1 / (dx * dx + dy * dy);
                sum_x += dx * inverse;
                sum_y += dy * inverse;
                if (strain) {
                    a += 2 * dx * dy * inverse * inverse;
                    b += (dy * dy - dx * dx) * inverse * inverse;
                }
            }
        }
        sum_y *= -factor;
        sum_x *= factor;
        memcpy(velocity_x + i, &sum_y, members * sizeof *x);
        memcpy(velocity_y + i, &sum_x, members * sizeof *y);
        if (strain) {
            a *= factor;
            b *= factor;
            memcpy(strain + i, &a, members * sizeof *x);
            memcpy(strain + count + i, &b, members * sizeof *x);
        }
    }
}

/* gm_loops.passive; without derivatives the loop has no trace of them */
#define CARRIED(name, images)                                                                                \
    static void name(const struct gm_problem *problem, const double *active, const double *x,                \
                     const double *y, double *velocity_x, double *velocity_y, double *strain, size_t count)  \
    {                                                                                                        \
        if (strain) {                                                                                        \
            carry(problem, active, x, y, velocity_x, velocity_y, strain, count, images);                     \
        } else {                                                                                             \
            carry(problem, active, x, y, velocity_x, velocity_y, NULL, count, images);                       \
        }                                                                                                    \
    }
CARRIED(carried, false)
CARRIED(carried_by_four, true)

const struct gm_loops GM_LOOPS_NAME(vortices,
                                    GM_ISA) = {.field = pair_sum, .energy = pair_energy, .passive = carried};
const struct gm_loops GM_LOOPS_NAME(vortices_multipole, GM_ISA) = {
    .field = multipole_field, .energy = multipole_energy, .passive = carried};
const struct gm_loops GM_LOOPS_NAME(vortices_reduced_carrying, GM_ISA) = {.field = reduced,
                                                                          .passive = carried_by_four};
