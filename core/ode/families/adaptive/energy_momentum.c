/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A variational integrator that varies time as well, of any number of degrees of freedom: the action of
   L_d = tau L((q_0 + q_1)/2, (q_1 - q_0)/tau) is stationary under variations of q and of the times, so that with
   the momenta p_0 = -dL_d/dq_0, p_1 = dL_d/dq_1 the energy -dL_d/dtau of every step is that of the one before:
   the midpoint rule, whose step tau is such that in the middle H is E,
       z = y_0 + tau/2 f(z),   H(z) = E,   y_1 = 2 z - y_0
   E is fixed by a first step of length tau0. With one degree of freedom it is variational-midpoint. H(z) -
   H(y_0) is about -tau^2/8 f' H'' f: if that changes its sign no root exists, and the run ends:
   step-collapse. (The rectangle rule has none wherever the force does no work, and stays one of one degree of
   freedom.)

   C. Kane, J.E. Marsden & M. Ortiz, J. Math. Phys. 40 (1999) 3353; Razafindralandy et al. (2018), eqs. 55 and
   56. The run's dt gives the direction of time only; the memory is the next tau, 0 if no root exists, and
   the energy. */
#include "core/ode/families/adaptive/variational_time.h"
#include "core/ode/families/family.h"

enum { TAU = GM_VARIATIONAL_TAU, ENERGY = GM_VARIATIONAL_ENERGY, REMEMBERED };
enum { ITERATIONS = 50 };

/* The scratch: the middle, the field and its Jacobian there, a right side, and the scratch of Newton's
   method. */
struct storage {
    double *middle, *field, *jacobian, *right, *scratch;
};

static size_t room_of(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return 3 * problem->n + problem->n * problem->n + gm_newton_scratch(problem->n);
}

static struct storage lay(const struct gm_problem *problem, double *scratch)
{
    const size_t n = problem->n;
    return (struct storage){scratch, scratch + n, scratch + 3 * n, scratch + 2 * n, scratch + 3 * n + n * n};
}

/* matrix := 1 - tau/2 J */
static void fill(const struct gm_problem *problem, const struct storage *storage, double tau, double *matrix)
{
    const size_t n = problem->n;
    for (size_t i = 0; i < n * n; i++) {
        matrix[i] = (i % (n + 1) == 0) - tau / 2 * storage->jacobian[i];
    }
}

/* The arguments of the equations for a step's middle. */
struct half_step {
    const struct gm_problem *problem;
    const struct storage *storage;
    const double *y;
    double tau;
    struct gm_progress *progress;
};

/* y + tau/2 f(z) - z */
static bool linear(void *data, const double *z, double *residual, double *matrix, double *scale)
{
    const struct half_step *half = data;
    const struct storage *storage = half->storage;
    gm_field(half->problem, z, storage->field, 1);
    half->progress->evaluations++;
    for (size_t c = 0; c < half->problem->n; c++) {
        residual[c] = half->y[c] - z[c] + half->tau / 2 * storage->field[c];
        *scale += fabs(half->y[c]) + fabs(half->tau * storage->field[c]);
    }
    const bool found = gm_jacobian(half->problem, z, storage->jacobian);
    fill(half->problem, storage, half->tau, matrix);
    return found;
}

/* The middle of a step tau from y, with field and Jacobian there. */
static bool find_middle(const struct gm_problem *problem, const double *y, double tau,
                        const struct storage *storage, struct gm_progress *progress)
{
    const size_t n = problem->n;
    struct half_step half = {problem, storage, y, tau, progress};
    const struct gm_implicit_equations equations = {
        .linear = linear, .size = n, .data = &half, .counted = n, .roundoff = 0x1p-50};
    memcpy(storage->middle, y, n * sizeof *y);
    if (!gm_newton_solve(&equations, storage->scratch, storage->middle, progress)) {
        return false;
    }
    gm_field(problem, storage->middle, storage->field, 1);
    return gm_jacobian(problem, storage->middle, storage->jacobian);
}

/* Finds the step from y in whose middle H is E, by Newton's method from the last one; the scalar equation is
   nested, as both at once would find steps backwards. */
static bool find_step(const struct gm_problem *problem, const double *y, double energy, double *tau,
                      const struct storage *storage, struct gm_progress *progress)
{
    const size_t half = problem->n / 2;
    const double last = *tau, weight = gm_weight_of(problem);
    double previous = INFINITY;
    for (int i = 0; i < ITERATIONS; i++) {
        if (!find_middle(problem, y, *tau, storage, progress)) {
            return false;
        }
        const double excess = gm_energy(problem, storage->middle) - energy;
        for (size_t c = 0; c < problem->n; c++) {
            storage->right[c] = storage->field[c] / 2;
        }
        fill(problem, storage, *tau, storage->scratch);
        if (!gm_eliminate(problem->n, storage->scratch, storage->right)) {
            return false;
        }
        double derivative = 0, size = fabs(energy);
        for (size_t c = 0; c < half; c++) {
            const double of_momenta = storage->field[c] / weight,
                         of_places = -storage->field[half + c] / weight;
            derivative += of_places * storage->right[c] + of_momenta * storage->right[half + c];
            size += fabs(of_momenta * storage->middle[half + c]);
        }
        const double change = excess / derivative;
        if (!isfinite(change)) {
            return excess == 0;
        }
        *tau -= change;
        if (!(*tau / last > 0.2 && *tau / last < 5)) {
            return false;
        }
        if (gm_is_settled(fabs(change), 0x1p-48 * size / fabs(derivative), &previous)) {
            return true;
        }
    }
    return false;
}

/* Makes the step whose tau the memory holds, and stores the next tau, 0 if the search finds no root. */
static enum gm_status midpoint_step(const struct gm_task *task, struct gm_members *members,
                                    struct gm_progress *progress)
{
    const struct gm_problem *problem = task->problem;
    const struct storage storage = lay(problem, members->scratch);
    double *y = members->y, *memory = members->memory;
    if (memory[TAU] == 0 || !find_middle(problem, y, memory[TAU], &storage, progress)) {
        return GM_STEP_COLLAPSE;
    }
    for (size_t c = 0; c < problem->n; c++) {
        y[c] += memory[TAU] * storage.field[c];
    }
    progress->t += memory[TAU];
    if (!find_step(problem, y, memory[ENERGY], &memory[TAU], &storage, progress)) {
        memory[TAU] = 0;
    }
    return GM_OK;
}

/* A reversed run conserves its energy, and so comes back; the step of a new run is still zero. */
static enum gm_status start(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const struct storage storage = lay(problem, ((struct gm_members *)task->workspace)->scratch);
    double *memory = task->memory_out;
    const double last = memory[TAU];
    struct gm_progress ignored = {0};
    memory[TAU] = copysign(last != 0 ? last : task->settings->tau0, task->dt);
    if (last != 0) {
        const bool found = find_step(problem, task->y, memory[ENERGY], &memory[TAU], &storage, &ignored);
        memory[TAU] = found ? memory[TAU] : 0;
        return GM_OK;
    }
    if (!find_middle(problem, task->y, memory[TAU], &storage, &ignored)) {
        return GM_STEP_COLLAPSE;
    }
    memory[ENERGY] = gm_energy(problem, storage.middle);
    return GM_OK;
}

const struct gm_family gm_family_energy_momentum = {
    .title = "symplectic-energy-momentum",
    GM_MEMBERS_WITH_MEMORY(energy_momentum, .step = midpoint_step, .remembered = REMEMBERED, .room = room_of),
    .parameters = gm_settings_of_variational_time,
    .start = start,
    .lacks = gm_lacks_events,
    .adaptive = true,
};
