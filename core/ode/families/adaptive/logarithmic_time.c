/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The logarithmic Hamiltonian, for attractions: H = T(p) + V(q), V < 0, B = -H at the start. In the phase
   space extended by t and its momentum B the motion of
       ln(T(p) + B) - ln(-V(q)),
   where its value is 0, is that of H in a fictitious time s, dt = ds / (-V): the deeper the potential, the
   shorter the steps. Both its parts have exact flows,
       drift   d = ds / (T(p) + B),   q += d dT/dp,   t += d
       kick    p += ds F(q) / (-V(q)),   F = -grad V
   so that half a drift, a kick and half a drift are explicit, symmetric and, in the extended phase space,
   symplectic; and so are their compositions with themselves, for which the s are the times. In Kepler's
   problem every point lies on the exact orbit, and only the time has an error. The run's dt is ds; the memory
   is B and the compensation of the sum of times.

   S. Mikkola & K. Tanikawa, Celest. Mech. Dyn. Astron. 74 (1999) 287; M. Preto & S. Tremaine, Astron. J. 118
   (1999) 2532. */
#include "core/ode/families/family.h"

enum { BINDING, TIME_CARRY, REMEMBERED };

/* A step in progress: the place is (q, 0), at rest, so that V is its energy and F its rates. */
struct passing {
    const struct gm_problem *problem;
    double binding, time; /* B; the time passed in this step */
    double *place, *y;    /* n each; y has the right q only after moving() */
    double *rates;        /* n */
};

/* Returns y with its q, needed if velocities are not the momenta. */
static const double *moving(const struct passing *at)
{
    memcpy(at->y, at->place, at->problem->n / 2 * sizeof *at->y);
    return at->y;
}

/* Drifts by ds. Returns false if T + B is not positive. */
static bool drift(struct passing *at, double ds)
{
    const struct gm_problem *problem = at->problem;
    const size_t half = problem->n / 2;
    const double *velocity = at->y + half;
    double kinetic = 0;
    if (gm_ode_of(problem)->split->unit_mass) {
        for (size_t c = 0; c < half; c++) {
            kinetic += velocity[c] * velocity[c] / 2;
        }
    } else {
        gm_field(problem, moving(at), at->rates, 1);
        velocity = at->rates;
        kinetic = gm_energy(problem, at->y) - gm_energy(problem, at->place);
    }
    const double whole = kinetic + at->binding, d = ds / whole;
    for (size_t c = 0; c < half; c++) {
        at->place[c] += d * velocity[c];
    }
    at->time += d;
    return whole > 0;
}

/* Kicks by ds. Returns false if V is not negative at this place. */
static bool kick(const struct passing *at, double ds)
{
    const size_t half = at->problem->n / 2;
    gm_field(at->problem, at->place, at->rates, 1);
    const double V = gm_energy(at->problem, at->place);
    for (size_t c = half; c < 2 * half; c++) {
        at->y[c] -= ds * at->rates[c] / V;
    }
    return V < 0;
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_composition *composition = task->scheme->coefficients;
    double *memory = members->memory, last = 0;
    bool forwards = true;
    struct passing at = {.problem = task->problem,
                         .binding = memory[BINDING],
                         .place = members->scratch,
                         .y = members->y,
                         .rates = members->scratch + members->n};
    memcpy(at.place, at.y, members->n / 2 * sizeof *at.place);
    for (int i = 0; i < composition->steps; i++) {
        const double ds = gm_composition_fraction(composition, i) * task->dt;
        forwards = drift(&at, (last + ds) / 2) && forwards;
        forwards = kick(&at, ds) && forwards;
        last = ds;
    }
    forwards = drift(&at, last / 2) && forwards;
    moving(&at);
    const int drifts = gm_ode_of(at.problem)->split->unit_mass
                           ? 0
                           : composition->steps + 1; /* drifts that evaluate the field */
    progress->evaluations += (unsigned long)(composition->steps + drifts);
    forwards = forwards && isfinite(at.time) && at.time * task->dt > 0;
    return forwards ? gm_members_pass(progress, at.time, &memory[TIME_CARRY]) : GM_STEP_COLLAPSE;
}

static enum gm_status start(const struct gm_task *task)
{
    /* a reversed run has its B, and so comes back; a new run's B is still zero */
    double *binding = &task->memory_out[BINDING];
    *binding = *binding != 0 ? *binding : -gm_energy(task->problem, task->y);
    const struct gm_members *members = task->workspace;
    memcpy(members->scratch, task->y, members->n / 2 * sizeof *task->y);
    return gm_energy(task->problem, members->scratch) < 0 ? GM_OK : GM_STEP_COLLAPSE;
}

const struct gm_family gm_family_logarithmic_time = {
    .title = "logarithmic Hamiltonian",
    GM_MEMBERS_WITH_MEMORY(logarithmic_time, .step = step, .remembered = REMEMBERED, .vectors = 2),
    .start = start,
    .adaptive = true,
};
