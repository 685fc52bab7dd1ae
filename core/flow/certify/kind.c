/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kind of flows on complexes: its families of schemes and their certification. */
#include "core/flow/flow.h"
#include "core/functions/functions.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "core/files/files.h"
#include "core/flow/families/families.h"
#include "core/flow/room.h"
#include "core/quantity.h"
#include "core/run.h"
#include "core/theory/certify.h"

enum { EDGES = 6, STRIPS = 8, MOST = EDGES * STRIPS, STATE = GM_FLOW_BLOCKS * MOST + 1 };

static const struct gm_settings no_settings;

static struct gm_problem problem_of(const struct gm_flow *flow)
{
    return (struct gm_problem){
        .name = "flow", .n = gm_flow_size(flow), .m = 1, .kind = &gm_kind_flow, .parameters = flow};
}

/* The flow of a file of share/subjects; NULL when out of memory. */
static struct gm_flow *open_flow(const char *name, const char *viscosity)
{
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SUBJECT, name);
    const struct gm_system_value given = {"viscosity", viscosity};
    struct gm_triangulation_fault wrong;
    struct gm_fault fault;
    struct gm_room *room = gm_room_open(&(struct gm_room_input){file->text, file->length, &given, 1}, &fault);
    struct gm_triangulation mesh = {.complex = room ? gm_rectangle_open(&room->rectangle, &wrong) : NULL};
    struct gm_flow *flow = mesh.complex ? gm_room_flow(room, &mesh, &fault) : NULL;
    if (!flow) {
        gm_room_close(room);
    }
    return flow;
}

static void close_flow(const struct gm_flow *flow)
{
    gm_room_close((struct gm_room *)(uintptr_t)flow->given_by);
}

/* The flow on the torus with its start; NULL when out of memory. */
static struct gm_flow *open_torus(const char *viscosity, double *start)
{
    struct gm_flow *flow = open_flow("swirls", viscosity);
    if (flow && !gm_flow_start(flow, flow->vorticity, start)) {
        close_flow(flow);
        return NULL;
    }
    return flow;
}

/* The semi-discrete equations, with the stream function of a start from this vorticity. */
static int rates(double t, const double *omega, double *rate, void *data)
{
    (void)t;
    const struct gm_flow *flow = data;
    const struct gm_complex *complex = flow->complex;
    double start[STATE], centre[2 * MOST], flux[3 * MOST];
    if (!gm_flow_start(flow, omega, start)) {
        return GSL_ENOMEM;
    }
    gm_flow_fluxes(complex, gm_flow_block(flow, start, GM_FLOW_PSI), centre, flux);
    memset(rate, 0, complex->vertices * sizeof *rate);
    for (size_t e = 0; e < complex->edges; e++) {
        const int a = complex->edge[2 * e], b = complex->edge[2 * e + 1];
        const double carried =
            flux[e] * (omega[a] + omega[b]) / 2 - flow->viscosity * complex->star1[e] * (omega[b] - omega[a]);
        rate[a] -= carried / complex->star0[a];
        rate[b] += carried / complex->star0[b];
    }
    return GSL_SUCCESS;
}

/* The slope between the outer ones of three steps. */
static void measure_order(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    enum { LADDER = 3, STEPS = 64 };
    const double until = 0.1;
    double exact[MOST], start[STATE], end[STATE];
    struct gm_flow *flow = open_torus("0.02", start);
    if (!flow) {
        return;
    }
    const struct gm_problem problem = problem_of(flow);
    const size_t n = flow->complex->vertices;
    const gsl_odeiv2_system equations = {rates, NULL, n, flow};
    struct gm_ladder *ladder = &certificate->ladder;
    memcpy(exact, gm_flow_block(flow, start, GM_FLOW_OMEGA), n * sizeof *exact);
    bool made = gm_certify_solve(&equations, 1e-13, until, exact);
    for (int i = 0; made && i < LADDER; i++) {
        const int64_t steps = STEPS << i;
        const struct gm_trial trial = {&problem, scheme, &no_settings, until / (double)steps, steps};
        made = gm_trial_advance(&trial, start, end);
        ladder->dt[i] = trial.dt;
        ladder->error[i] = gm_distance(gm_flow_block(flow, end, GM_FLOW_OMEGA), exact, n);
    }
    close_flow(flow);
    ladder->count = made ? LADDER : 0;
    certificate->order = made ? gm_log(ladder->error[0] / ladder->error[LADDER - 1]) / gm_log(4) : NAN;
    certificate->order_problem = "torus";
    certificate->order_holds = fabs(certificate->order - scheme->order) < 0.15;
}

/* Without viscosity: the circulation and the enstrophy of a closed surface. */
static void measure_torus(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    double start[STATE], end[STATE];
    struct gm_flow *flow = open_torus("0", start);
    if (!flow) {
        return;
    }
    const struct gm_problem problem = problem_of(flow);
    const struct gm_trial trial = {&problem, scheme, &no_settings, 0.01, 50};
    if (gm_trial_advance(&trial, start, end)) {
        const double before = gm_flow_enstrophy(flow, start);
        gm_certificate_note(certificate, GM_KEEPS_LINEAR, gm_flow_circulation_error(flow, end), "torus");
        gm_certificate_note(certificate, GM_KEEPS_QUADRATIC,
                            fabs(gm_flow_enstrophy(flow, end) - before) / before, "torus");
    }
    close_flow(flow);
}

static void measure_room(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    enum { STEPS = 20 };
    struct gm_flow *flow = open_flow("ventilated", "0.02");
    double *start = flow ? malloc(gm_flow_size(flow) * sizeof *start) : NULL;
    if (!flow) {
        return;
    }
    const struct gm_problem problem = problem_of(flow);
    const size_t n = flow->complex->vertices;
    for (int constant = 0; constant < 2 && start; constant++) {
        for (size_t v = 0; constant && v < n; v++) {
            flow->theta[v] = 1;
        }
        struct gm_run *run = gm_flow_start(flow, flow->vorticity, start)
                                 ? gm_run_open(&problem, scheme, &no_settings, 0, 0.1, start)
                                 : NULL;
        for (int i = 0; run && i < STEPS && gm_run_advance(run, 1) == GM_OK; i++) {
            const double *y = gm_run_state(run), *theta = gm_flow_block(flow, y, GM_FLOW_THETA);
            gm_certificate_note(certificate, GM_DIVERGENCE_FREE, gm_flow_divergence(flow, y), "room");
            if (!constant) {
                gm_certificate_note(certificate, GM_CLOSES_BUDGET, gm_flow_budget(flow, y).defect, "room");
            }
            for (size_t v = 0; constant && v < n; v++) {
                gm_certificate_note(certificate, GM_KEEPS_CONSTANTS, fabs(theta[v] - 1), "room");
            }
        }
        gm_run_close(run);
    }
    free(start);
    close_flow(flow);
}

/* Measures a scheme for flows on complexes: fills the certificate's order and claims. */
static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    if (scheme->order > 0) {
        measure_order(scheme, certificate);
        measure_torus(scheme, certificate);
    } else {
        certificate->order = 0; /* there is no time in it */
        certificate->order_problem = "steady";
        certificate->order_holds = true;
    }
    measure_room(scheme, certificate);
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/flow/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_flow = {
    .name = "flow",
    .problems = "flows on a mesh",
    .certify = certify,
    .families = families,
    .quantities = gm_flow_quantities,
};
