/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trigonometric methods for q'' = -omega^2 q + g(q), omega diagonal:
       p += h/2 a g(phi q);   (q, p) := flow of q'' = -omega^2 q over h;   p += h/2 a g(phi q),
   phi and a diagonal, functions of x = h omega; the filter psi of the literature is a sinc(x), and a method
   is symplectic if a = phi:
                                    phi        a                        psi
       mollified impulse            sinc(x)    sinc(x)                  sinc^2(x)
       Gautschi                     1          sinc^2(x/2) / sinc(x)    sinc^2(x/2)
   The memory is g(phi q) at the end of the step, which the next one begins with. Hairer, Lubich & Wanner
   (2006), sections XIII.1 to XIII.2. */
#include "core/functions/functions.h"
#include "core/ode/families/family.h"

enum filter { MOLLIFIED, GAUTSCHI };
static const enum filter mollified = MOLLIFIED, gautschi = GAUTSCHI;

static double sinc(double x)
{
    return fabs(x) < 1e-4 ? 1 - x * x / 6 : gm_sin(x) / x;
}

/* phi and a at h omega */
static void filters(enum filter filter, double x, double *phi, double *a)
{
    const double half = sinc(x / 2);
    *phi = filter == MOLLIFIED ? sinc(x) : 1;
    *a = filter == MOLLIFIED ? sinc(x) : half * half / sinc(x);
}

/* g(phi q) of member `member` of m, into g[component * stride] */
static void filtered_force(const struct gm_task *task, const double *q, size_t stride, double *at,
                           double *force, double *g)
{
    const struct gm_problem *problem = task->problem;
    const enum filter filter = *(const enum filter *)task->scheme->coefficients;
    const size_t half = problem->n / 2;
    for (size_t c = 0; c < half; c++) {
        double phi, a;
        filters(filter, task->dt * gm_ode_of(problem)->fast_linear->frequency(problem, c), &phi, &a);
        at[c] = phi * q[c * stride];
    }
    gm_ode_of(problem)->fast_linear->slow_force(problem, at, force, 1);
    for (size_t c = 0; c < half; c++) {
        g[c * stride] = force[c];
    }
}

/* The coefficients of one component, kept in the scratch while the step stays the same. */
struct component {
    double kick, cosine, sine_over_omega, omega_sine;
};
enum { PER_COMPONENT = sizeof(struct component) / sizeof(double) };

/* The scratch: the step that the coefficients are for, two arrays of n/2, the coefficients. */
enum { VECTORS = 1 + (2 + PER_COMPONENT) / 2 };
static struct component *components(const struct gm_task *task, struct gm_members *members)
{
    const struct gm_problem *problem = task->problem;
    const size_t half = members->n / 2;
    struct component *list = (struct component *)(void *)(members->scratch + 1 + 2 * half);
    if (members->scratch[0] == task->dt) {
        return list;
    }
    members->scratch[0] = task->dt;
    for (size_t c = 0; c < half; c++) {
        const double omega = gm_ode_of(problem)->fast_linear->frequency(problem, c), x = task->dt * omega;
        double phi, a;
        filters(*(const enum filter *)task->scheme->coefficients, x, &phi, &a);
        list[c] = (struct component){.kick = task->dt / 2 * a,
                                     .cosine = gm_cos(x),
                                     .sine_over_omega = task->dt * sinc(x),
                                     .omega_sine = omega * gm_sin(x)};
    }
    return list;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const size_t half = members->n / 2;
    const struct component *list = components(task, members);
    double *q = members->y, *p = members->y + half, *g = members->memory;
    for (size_t c = 0; c < half; c++) {
        const double kicked = p[c] + list[c].kick * g[c], before = q[c];
        q[c] = list[c].cosine * before + list[c].sine_over_omega * kicked;
        p[c] = list[c].cosine * kicked - list[c].omega_sine * before;
    }
    filtered_force(task, q, 1, members->scratch + 1, members->scratch + 1 + half, g);
    progress->evaluations++;
    for (size_t c = 0; c < half; c++) {
        p[c] += list[c].kick * g[c];
    }
    return GM_OK;
}

static enum gm_status start(const struct gm_task *task)
{
    struct gm_members *members = task->workspace;
    const size_t m = task->problem->m, half = task->problem->n / 2;
    for (size_t i = 0; i < m; i++) {
        filtered_force(task, task->y + i, m, members->scratch + 1, members->scratch + 1 + half,
                       task->memory_out + i);
    }
    return GM_OK;
}

const struct gm_family gm_family_trigonometric = {
    .title = "trigonometric",
    GM_MEMBERS_WITH_MEMORY(trigonometric, .step = step, .halves = 1, .vectors = VECTORS,
                           .evaluated_at_start = true),
    .start = start,
};
