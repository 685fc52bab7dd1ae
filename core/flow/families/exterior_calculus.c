/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Incompressible flow in discrete exterior calculus (notation: core/flow/flow.h). With
       C(F) = -d0' diag(F) A + diag(max(q, 0)),   q = d0' F, what flows out of boundary cells
   and the share s of the new time, 1 (semi-implicit) or 1/2 (Crank-Nicolson), a step is
       half step   star0 (omega* - omega)/(dt/2) + [C(F) + nu K] omega = 0
                   K psi* + sheet = star0 omega*
       flow        star0 (omega' - omega)/dt + [C(F*) + nu K] (s omega' + (1 - s) omega) = 0
                   K psi' + sheet = star0 omega'
       scalar      star0 (theta' - theta)/dt + [-d0' diag(F*) A + diag(q) + kappa K] theta' = 0
   with F and F* the fluxes of psi and psi*. Temperature is carried like the scalar, before the flow, which
   takes the new one's buoyancy: waves of a layered fluid do not grow by that. Mohamed, Hirani & Samtaney, J.
   Comput. Phys. 312 (2016) 175; Razafindralandy et al. (2018), eqs. 153-155. The steady scheme takes C(F)
   omega + nu K omega = 0 by Newton's method, a correction a step. */
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <string.h>

#include "core/basics.h"
#include "core/flow/families/families.h"
#include "core/flow/solver.h"
#include "core/flow_scheme_texts.h"

/* A row: the share of the new time in convection and diffusion; 0 for the steady state. */
static const double backward = 1, centred = 0.5, steady = 0;

static double *block(const struct gm_flow *flow, double *y, enum gm_flow_block which)
{
    return y + (size_t)which * flow->complex->vertices;
}

/* The memory of the steady scheme: its current Reynolds number, the corrections made for it, and 1 if the
   last one was round-off. */
enum { LEVEL, CORRECTIONS, DONE, MEMORY };

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)problem;
    return scheme->coefficients == &steady ? MEMORY : 0;
}

/* Newton's method converges from rest up to about this Reynolds number. */
static const double first_level = 100;

static enum gm_status start(const struct gm_task *task)
{
    const struct gm_flow *flow = gm_flow_of(task->problem);
    if (task->scheme->coefficients == &steady) {
        task->memory_out[LEVEL] = fmin(flow->reynolds, first_level);
        task->memory_out[CORRECTIONS] = task->memory_out[DONE] = 0;
    }
    return GM_OK;
}

static void fluxes(struct gm_flow_solver *solver, const double *psi)
{
    gm_flow_fluxes(solver->flow->complex, psi, solver->centre, solver->flux);
}

/* Between walls without friction, where steps are made for omega, the circulation around a hole stays what it
   is (Kelvin): K psi of its wall, into solver->rate. */
static void keep_circulations(struct gm_flow_solver *solver, const double *psi)
{
    const struct gm_flow *flow = solver->flow;
    for (size_t v = 0; solver->vorticity_form && flow->holes > 0 && v < flow->complex->vertices; v++) {
        if (flow->hole[v] > 0) {
            solver->rate[v] = gm_flow_row(flow->complex, psi, v);
        }
    }
}

/* psi* of the fluxes, from the present vorticity. */
static void half_step(struct gm_flow_solver *solver, double dt, double *y)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    const double *omega = block(flow, y, GM_FLOW_OMEGA);
    double *psi_half = block(flow, y, GM_FLOW_PSI_HALF);
    fluxes(solver, y);
    gm_transport_assemble(&solver->transport, solver->flux, 0, 1, flow->viscosity, GM_BACKFLOW_ZERO);
    gm_transport_apply(&solver->transport, omega, solver->rate);
    for (size_t v = 0; v < complex->vertices; v++) {
        solver->rate[v] = complex->star0[v] * omega[v] - dt / 2 * solver->rate[v] - flow->sheet[v];
    }
    if (flow->heat) {
        gm_flow_add_lift(flow, block(flow, y, GM_FLOW_TEMPERATURE), dt / 2, solver->rate);
    }
    keep_circulations(solver, y);
    memcpy(psi_half, flow->psi, complex->vertices * sizeof *psi_half);
    if (solver->unknowns.count > 0) {
        gm_unknowns_solve_poisson(&solver->unknowns, flow, solver->poisson, solver->rate, solver->b,
                                  psi_half);
        solver->factor_solves++;
    }
}

/* star0 omega / dt less what the old time contributes, into solver->rate. Leaves the matrix of the step
   assembled. */
static void make_equation(struct gm_flow_solver *solver, double share, double dt, double *y)
{
    const double *omega = block(solver->flow, y, GM_FLOW_OMEGA);
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    struct gm_transport *transport = &solver->transport;
    if (share < 1) {
        gm_transport_assemble(transport, solver->flux, 0, 1 - share, flow->viscosity, GM_BACKFLOW_ZERO);
        gm_transport_apply(transport, omega, solver->rate);
    } else {
        memset(solver->rate, 0, complex->vertices * sizeof *solver->rate);
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        solver->rate[v] = complex->star0[v] * omega[v] / dt - solver->rate[v];
    }
    if (flow->heat) {
        gm_flow_add_lift(flow, block(solver->flow, y, GM_FLOW_TEMPERATURE), 1, solver->rate);
    }
    gm_transport_assemble(transport, solver->flux, 1 / dt, share, flow->viscosity, GM_BACKFLOW_ZERO);
}

/* The step for omega itself, where boundary values of psi do not enter it. */
static bool advance_vorticity(struct gm_flow_solver *solver, double share, double dt, double *y,
                              struct gm_progress *progress)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    double *omega = block(flow, y, GM_FLOW_OMEGA);
    make_equation(solver, share, dt, y);
    memcpy(solver->field, omega, complex->vertices * sizeof *omega);
    if (!gm_transport_solve(&solver->transport, solver->held, solver->rate, solver->field, solver->bicgstab,
                            &progress->iterations)) {
        return false;
    }
    double *used = block(flow, y, GM_FLOW_OMEGA_USED);
    for (size_t v = 0; v < complex->vertices; v++) {
        used[v] = share * solver->field[v] + (1 - share) * omega[v];
        omega[v] = solver->field[v];
        solver->rate[v] = complex->star0[v] * omega[v];
    }
    keep_circulations(solver, y);
    if (solver->unknowns.count > 0) {
        gm_unknowns_solve_poisson(&solver->unknowns, flow, solver->poisson, solver->rate, solver->b, y);
        solver->factor_solves++;
    }
    progress->solves += 2;
    return true;
}

/* The unknowns' residual of the equation that is assembled, right side in solver->rate, into solver->b. */
static double residual(struct gm_flow_solver *solver, const double *omega)
{
    const struct gm_unknowns *unknowns = &solver->unknowns;
    double *product = solver->field, sum = 0, size = 0;
    gm_transport_apply(&solver->transport, omega, product);
    for (size_t i = 0; i < unknowns->flow; i++) {
        solver->b[i] = 0;
        for (int k = unknowns->start[i]; k < unknowns->start[i + 1]; k++) {
            const int v = unknowns->vertex[k];
            solver->b[i] += solver->rate[v] - product[v];
            size += solver->rate[v] * solver->rate[v];
        }
        sum += solver->b[i] * solver->b[i];
    }
    return sqrt(fmax(sum, size));
}

/* Adds solver->x to psi, to omega of soft vertices and, if it is unknown, to the temperature, and makes omega of the
   others. */
static void correct(const struct gm_flow_solver *solver, bool warm, double *y)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_unknowns *unknowns = &solver->unknowns;
    double *omega = block(flow, y, GM_FLOW_OMEGA);
    for (size_t i = 0; i < (warm ? unknowns->all : unknowns->flow); i++) {
        double *values = i < unknowns->count  ? y
                         : i < unknowns->flow ? omega
                                              : block(flow, y, GM_FLOW_TEMPERATURE);
        for (int k = unknowns->start[i]; k < unknowns->start[i + 1]; k++) {
            values[unknowns->vertex[k]] += solver->x[i];
        }
    }
    gm_flow_vorticity(flow, y, omega);
}

/* The step for psi, and for omega at vertices without a formula. The first guess extrapolates the last
   step. */
static bool advance_stream(struct gm_flow_solver *solver, double share, double dt, double *y,
                           const double *psi_before, struct gm_progress *progress)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    double *omega = block(flow, y, GM_FLOW_OMEGA), *used = block(flow, y, GM_FLOW_OMEGA_USED);
    const double last = gm_flow_step(flow, y), ratio = last != 0 ? dt / last : 0;
    make_equation(solver, share, dt, y);
    memcpy(used, omega, complex->vertices * sizeof *used);
    for (int i = 0; i < solver->unknowns.start[solver->unknowns.count]; i++) {
        const int v = solver->unknowns.vertex[i];
        y[v] += ratio * (y[v] - psi_before[v]);
    }
    gm_flow_vorticity(flow, y, omega);
    const double size = residual(solver, omega);
    if (!gm_flow_solver_correct(solver, size, &progress->iterations)) {
        return false;
    }
    correct(solver, false, y);
    for (size_t v = 0; v < complex->vertices; v++) {
        used[v] = share * omega[v] + (1 - share) * used[v];
    }
    progress->solves += 2;
    return true;
}

/* The scalar, or temperature, by the fluxes in solver->flux; source: per unit of time, NULL: none. transport,
   rate: scratch. */
static bool advance_carried(struct gm_flow_solver *solver, struct gm_transport *transport, double *rate,
                            double dt, double *theta, const bool *fixed, const double *source,
                            unsigned long *iterations)
{
    const struct gm_flow *flow = solver->flow;
    const struct gm_complex *complex = flow->complex;
    const double shift = dt > 0 || dt < 0 ? 1 / dt : 0;
    gm_transport_assemble(transport, solver->flux, shift, 1, flow->diffusivity, GM_BACKFLOW_OWN);
    for (size_t v = 0; v < complex->vertices; v++) {
        rate[v] = shift * complex->star0[v] * theta[v];
        if (source) {
            rate[v] += source[v];
        }
    }
    return shift != 0 ? gm_transport_solve(transport, fixed, rate, theta, solver->bicgstab, iterations)
                      : gm_transport_solve_directly(transport, fixed, rate, theta);
}

static bool advance_temperature(struct gm_flow_solver *solver, double dt, double *y,
                                struct gm_progress *progress)
{
    const struct gm_flow *flow = solver->flow;
    if (!flow->heat) {
        return true;
    }
    progress->solves++;
    return advance_carried(solver, &solver->transport, solver->rate, dt, block(flow, y, GM_FLOW_TEMPERATURE),
                           flow->temperature_fixed, flow->heating, &progress->iterations);
}

/* The scalar's part of a step, which needs only the previous fluxes of the flow: on another core, if there is
   one. It writes nothing that the flow uses in the meantime, so no bit depends on the core. */
struct scalar_part {
    struct gm_flow_solver *solver;
    double dt, *theta;
    unsigned long iterations;
    bool good, beside;
    pthread_t thread;
};

static void *advance_scalar(void *data)
{
    struct scalar_part *part = data;
    struct gm_flow_solver *solver = part->solver;
    const struct gm_flow *flow = solver->flow;
    part->good =
        !flow->scalar || advance_carried(solver, &solver->carried, solver->carried_rate, part->dt,
                                         part->theta, flow->theta_fixed, flow->source, &part->iterations);
    return NULL;
}

/* Begins the part, in a thread that leaves signals to this one; `alone`: does it at once. */
static void begin_scalar(struct scalar_part *part, bool alone)
{
    cpu_set_t cores;
    if (!alone && (sched_getaffinity(0, sizeof cores, &cores) != 0 || CPU_COUNT(&cores) > 1)) {
        static const int own[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL};
        sigset_t others, before;
        sigfillset(&others);
        for (size_t i = 0; i < GM_COUNT(own); i++) {
            sigdelset(&others, own[i]);
        }
        pthread_sigmask(SIG_BLOCK, &others, &before);
        part->beside = pthread_create(&part->thread, NULL, advance_scalar, part) == 0;
        pthread_sigmask(SIG_SETMASK, &before, NULL);
    }
    if (!part->beside) {
        advance_scalar(part);
    }
}

/* Waits for the part. */
static bool take_scalar(const struct scalar_part *part, struct gm_progress *progress)
{
    if (part->beside) {
        pthread_join(part->thread, NULL);
    }
    progress->solves += part->solver->flow->scalar;
    progress->iterations += part->iterations;
    return part->good;
}

static void keep_carried(const struct gm_flow *flow, double *y)
{
    const size_t size = flow->complex->vertices * sizeof *y;
    if (flow->scalar) {
        memcpy(block(flow, y, GM_FLOW_THETA_BEFORE), block(flow, y, GM_FLOW_THETA), size);
    }
    if (flow->heat) {
        memcpy(block(flow, y, GM_FLOW_TEMPERATURE_BEFORE), block(flow, y, GM_FLOW_TEMPERATURE), size);
    }
}

/* Copies the values that the boundary gives into the state. */
static void take_given(const struct gm_flow_solver *solver, double *y)
{
    const struct gm_flow *flow = solver->flow;
    double *theta = block(flow, y, GM_FLOW_THETA);
    double *temperature = flow->heat ? block(flow, y, GM_FLOW_TEMPERATURE) : NULL;
    for (size_t v = 0; solver->now && v < flow->complex->vertices; v++) {
        y[v] = solver->unknowns.index[v] < 0 ? flow->psi[v] : y[v];
        theta[v] = flow->theta_fixed[v] ? flow->theta[v] : theta[v];
        if (temperature && flow->temperature_fixed[v]) {
            temperature[v] = flow->temperature[v];
        }
    }
}

/* Vertices from which on the scalar takes longer than to begin a thread. */
enum { WORTH_A_THREAD = 1500 };

/* From the time t on. */
static enum gm_status step(struct gm_flow_solver *solver, double share, double t, double dt, int64_t number,
                           double *y, struct gm_progress *progress)
{
    const struct gm_flow *flow = solver->flow;
    const size_t n = flow->complex->vertices;
    double *before = block(flow, y, GM_FLOW_PSI_BEFORE), *psi_before = solver->velocities;
    memcpy(psi_before, before, n * sizeof *before);
    memcpy(before, y, n * sizeof *before);
    if (!gm_flow_solver_give(solver, t + dt / 2)) {
        return GM_BLOW_UP;
    }
    if (!gm_flow_solver_factor(solver, 1 / dt, share * flow->viscosity)) {
        return GM_NO_CONVERGENCE;
    }
    half_step(solver, dt, y);
    fluxes(solver, block(flow, y, GM_FLOW_PSI_HALF));
    if (!gm_flow_solver_give(solver, t + dt)) {
        return GM_BLOW_UP;
    }
    keep_carried(flow, y);
    take_given(solver, y);
    if (!advance_temperature(solver, dt, y, progress)) {
        return GM_NO_CONVERGENCE;
    }
    struct scalar_part scalar = {.solver = solver, .dt = dt, .theta = block(flow, y, GM_FLOW_THETA)};
    begin_scalar(&scalar, !flow->scalar || solver->vorticity_form || n < WORTH_A_THREAD);
    const bool moved = solver->vorticity_form ? advance_vorticity(solver, share, dt, y, progress)
                                              : advance_stream(solver, share, dt, y, psi_before, progress);
    if (!take_scalar(&scalar, progress) || !moved) {
        return GM_NO_CONVERGENCE;
    }
    if (!(gm_flow_kinetic_energy(flow, y) <= solver->energy_limit)) {
        return GM_BLOW_UP;
    }
    if (flow->tracers > 0) {
        gm_flow_vertex_velocities(flow->complex, block(flow, y, GM_FLOW_PSI_HALF), solver->velocities);
        gm_tracers_carry(flow, solver->velocities, dt, number, y, y);
    }
    y[gm_flow_block_numbers(flow)] = dt;
    progress->evaluations += 2;
    return GM_OK;
}

/* One correction of Newton's method at the present Reynolds number; a change small enough leads to the next
   one. */
static enum gm_status step_steady(struct gm_flow_solver *solver, double *carried, double *y,
                                  struct gm_progress *progress)
{
    enum { MOST_CORRECTIONS = 25 };
    const double roundoff = 1e-7, good_start = 0.1, factor = carried[LEVEL] < 1000 ? 2.5 : 1.5;
    const struct gm_flow *flow = solver->flow;
    const size_t n = flow->complex->vertices;
    double *omega = block(flow, y, GM_FLOW_OMEGA);
    memcpy(block(flow, y, GM_FLOW_PSI_BEFORE), y, n * sizeof *y);
    if (flow->heat) {
        memcpy(block(flow, y, GM_FLOW_TEMPERATURE_BEFORE), block(flow, y, GM_FLOW_TEMPERATURE),
               n * sizeof *y);
    }
    if (solver->now) {
        return GM_NO_CONVERGENCE; /* a boundary that changes has no steady state */
    }
    if (carried[DONE] != 0) {
        return GM_OK;
    }
    const double ratio = flow->reynolds > 0 ? flow->reynolds / carried[LEVEL] : 1;
    if (solver->unknowns.count > 0) {
        fluxes(solver, y);
        if (flow->heat) {
            gm_transport_assemble(&solver->heat, solver->flux, 0, 1, ratio * flow->diffusivity,
                                  GM_BACKFLOW_OWN);
        }
        gm_transport_assemble(&solver->transport, solver->flux, 0, 1, ratio * flow->viscosity,
                              GM_BACKFLOW_ZERO);
        memset(solver->rate, 0, n * sizeof *solver->rate);
        double *temperature = flow->heat ? block(flow, y, GM_FLOW_TEMPERATURE) : NULL;
        if (temperature) {
            gm_flow_add_lift(flow, temperature, 1, solver->rate);
        }
        residual(solver, omega);
        if (!gm_flow_solver_newton(solver, omega, temperature)) {
            return GM_NO_CONVERGENCE;
        }
        correct(solver, flow->heat, y);
    }
    double change = 0, size = 0;
    for (size_t v = 0; v < n; v++) {
        change = fmax(change, fabs(y[v] - block(flow, y, GM_FLOW_PSI_BEFORE)[v]));
        size = fmax(size, fabs(y[v]));
    }
    memcpy(block(flow, y, GM_FLOW_PSI_HALF), y, n * sizeof *y);
    memcpy(block(flow, y, GM_FLOW_OMEGA_USED), omega, n * sizeof *y);
    y[gm_flow_block_numbers(flow)] = 0;
    fluxes(solver, y);
    memcpy(block(flow, y, GM_FLOW_THETA_BEFORE), block(flow, y, GM_FLOW_THETA), n * sizeof *y);
    struct scalar_part scalar = {.solver = solver, .theta = block(flow, y, GM_FLOW_THETA)};
    advance_scalar(&scalar);
    if (!take_scalar(&scalar, progress)) {
        return GM_NO_CONVERGENCE;
    }
    progress->evaluations++;
    progress->solves++;
    progress->iterations++;
    if (++carried[CORRECTIONS] > MOST_CORRECTIONS) {
        return GM_NO_CONVERGENCE;
    }
    if (carried[LEVEL] < flow->reynolds && change <= good_start * size) {
        carried[LEVEL] = fmin(flow->reynolds, factor * carried[LEVEL]);
        carried[CORRECTIONS] = 0;
    } else if (carried[LEVEL] >= flow->reynolds && change <= roundoff * size) {
        carried[DONE] = 1;
    }
    return GM_OK;
}

static bool within(const double *y, size_t n, double limit)
{
    for (size_t i = 0; i < n; i++) {
        if (!(fabs(y[i]) <= limit)) {
            return false;
        }
    }
    return true;
}

static struct gm_progress loop(const struct gm_task *task)
{
    const struct gm_flow *flow = gm_flow_of(task->problem);
    const double *share = task->scheme->coefficients;
    struct gm_progress progress = {.status = GM_OK};
    struct gm_flow_solver *solver = task->workspace;
    const unsigned long factor_solves = solver->factor_solves;
    memcpy(task->out, task->y, task->problem->n * sizeof *task->y);
    if (share == &steady) {
        memcpy(task->memory_out, task->memory, MEMORY * sizeof *task->memory);
    }
    while (progress.done < task->steps) {
        progress.status =
            share == &steady
                ? step_steady(solver, task->memory_out, task->out, &progress)
                : step(solver, *share,
                       (task->t0 + task->dt * (double)(task->n + progress.done)) * flow->time_unit,
                       task->dt * flow->time_unit, task->steps_before + progress.done, task->out, &progress);
        if (progress.status == GM_OK && !within(task->out, task->problem->n, task->limit)) {
            progress.status = GM_BLOW_UP;
        }
        if (progress.status != GM_OK) {
            break;
        }
        progress.done++;
    }
    progress.factor_solves = solver->factor_solves - factor_solves;
    return progress;
}

#define FLOW .family = &gm_family_exterior_calculus
#define EXACT_CALCULUS (GM_DIVERGENCE_FREE | GM_KEEPS_CONSTANTS | GM_CLOSES_BUDGET)

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_semi_implicit, .coefficients = &backward, FLOW},
    {GM_TEXTS_crank_nicolson, .coefficients = &centred, FLOW},
    {GM_TEXTS_steady, .coefficients = &steady, .steady = true, FLOW},
};

const struct gm_family gm_family_exterior_calculus = {
    .kind = &gm_kind_flow,
    .title = "discrete exterior calculus",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .memory = memory,
    .start = start,
    .workspace_open = gm_flow_solver_open,
    .workspace_close = gm_flow_solver_close,
};
