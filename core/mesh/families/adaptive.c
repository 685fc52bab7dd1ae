/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multiplier strategy with a time-symmetric step: the density rho of steps follows the mesh,
       rho_{n+1/2} = rho_n + dt/2 G(q_n, qdot_n)
       h           = dt / rho_{n+1/2}
       rho_{n+1}   = rho_{n+1/2} + dt/2 G(q_{n+1}, qdot_{n+1})
       G           = d/dt log sigma,   sigma = (c^-4 + sum_e d_e^-4)^(1/8),   rho_0 = 1
   with d_e the cells' widths and c = 0.208 of their mean: steps shrink with the smallest cells, as the square
   root, and do not grow without bound where all cells are wide. Changing the signs of dt and of the run of
   time undoes it exactly: (q, p, rho) is reversible. It delays the loss of energy on coarse meshes with a
   strong density; a density that is limited (core/mesh/moving_mesh.h) prevents it. E. Hairer & G. Soderlind,
   SIAM J. Sci. Comput. 26 (2005) 1838; Tyranowski & Desbrun (2019), section 6.3, leave this step open. */
#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/mesh/families/families.h"
#include "core/mesh_scheme_texts.h"

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return gm_mesh_memory(problem, scheme) + 1;
}

static double *density(const struct gm_task *task)
{
    return task->memory_out + gm_mesh_memory(task->problem, task->scheme);
}

static double growth(const struct gm_mesh *mesh, const double *state)
{
    const size_t points = mesh->points;
    const double *x = state + points, *v = state + 3 * points;
    const double coarse = 0.208 * mesh->length / (double)(points + 1);
    double x0 = mesh->first, v0 = 0, sum = gm_pow(coarse, -4), change = 0;
    for (size_t e = 0; e <= points; e++) {
        const double x1 = e < points ? x[e] : mesh->first + mesh->length, v1 = e < points ? v[e] : 0;
        const double d = x1 - x0, weight = 1 / (d * d * d * d);
        sum += weight;
        change -= weight * (v1 - v0) / d;
        x0 = x1;
        v0 = v1;
    }
    return change / (2 * sum);
}

static enum gm_status start(const struct gm_task *task)
{
    /* a reversed run keeps its density; a new run has the density zero */
    double *rho = density(task);
    *rho = *rho > 0 ? *rho : 1;
    return gm_mesh_restart(task);
}

static struct gm_progress loop(const struct gm_task *task)
{
    const size_t count = memory(task->problem, task->scheme);
    const struct gm_mesh *mesh = &((struct gm_mesh_solver *)task->workspace)->mesh;
    struct gm_progress progress = {.status = GM_OK, .t = task->t};
    memcpy(task->out, task->y, task->problem->n * sizeof *task->out);
    memcpy(task->memory_out, task->memory, count * sizeof *task->memory_out);
    struct gm_task each = *task;
    each.steps = 1;
    each.y = task->out;
    each.memory = task->memory_out;
    double *rho = density(task);
    while (progress.done < task->steps && progress.t < task->until) {
        const double half = *rho + task->dt / 2 * growth(mesh, task->out);
        if (!(half > 1e-3 && half < 1e3)) {
            progress.status = GM_STEP_COLLAPSE;
            break;
        }
        each.dt = task->dt / half;
        const struct gm_progress one = gm_mesh_loop(&each);
        progress.evaluations += one.evaluations;
        progress.solves += one.solves;
        progress.iterations += one.iterations;
        if (one.status != GM_OK) {
            progress.status = one.status;
            break;
        }
        *rho = half + task->dt / 2 * growth(mesh, task->out);
        progress.t += each.dt;
        progress.done++;
    }
    return progress;
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_multiplier_adaptive4, .family = &gm_family_adaptive, .coefficients = &gm_mesh_multiplier4},
};

const struct gm_family gm_family_adaptive = {
    .title = "moving meshes with a time-symmetric step",
    GM_MESH_FAMILY,
    .loop = loop,
    .memory = memory,
    .start = start,
    .adaptive = true,
};
