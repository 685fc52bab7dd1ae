/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The soliton that schemes on meshes are certified on. */
#include "core/mesh/certify/subject.h"

#include <stdlib.h>
#include <string.h>

#include "core/certify.h"
#include "core/linear/differences.h"
#include "core/mesh/nodes.h"
#include "core/model/equations.h"

static const struct gm_settings settings = {0};

/* One sine-Gordon soliton in the middle of a box; with a mesh that swings, and for free nodes inertia between them,
   with which their mass matrix is regular. */
static const char soliton[] = "field: u\nV: 1 - cos(u)\nlet: g = 1/sqrt(0.75)\n"
                              "start: u = 4*atan(exp(g*(x - 6))), u_t = -g/cosh(g*(x - 6))\n"
                              "ends: 0, 2*pi\nhalf_length: 6; left 0\n";

bool gm_mesh_subject_open(struct gm_mesh_subject *subject, const struct gm_scheme *scheme, size_t points)
{
    const struct gm_user_mesh chosen = {.length = 12,
                                        .points = (long)points,
                                        .alpha = 1,
                                        .density = "arclength",
                                        .map = "X = x + 0.8*sin(pi*x/12)*sin(1.1*t + 0.3)",
                                        .cell = "(d_t/d)^2/20"};
    struct gm_fault fault;
    *subject = (struct gm_mesh_subject){0};
    double *values = NULL;
    const bool good = gm_equations_open(&subject->system, soliton, strlen(soliton), NULL, 0, &fault) &&
                      gm_user_wave_derive(&subject->wave, &subject->system) &&
                      (values = gm_equations_start(&subject->system, NULL)) &&
                      gm_user_mesh_open(&subject->own, &subject->wave, values, &chosen) &&
                      gm_mesh_subject_open_on(subject, scheme, &subject->own);
    free(values);
    return good;
}

void gm_mesh_subject_close(struct gm_mesh_subject *subject)
{
    gm_user_mesh_close(&subject->own);
    gm_system_close(&subject->system);
}

bool gm_mesh_subject_open_on(struct gm_mesh_subject *subject, const struct gm_scheme *scheme,
                             const struct gm_problem *problem)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    subject->problem = *problem;
    moving->describe(problem, &subject->mesh);
    subject->mesh.cell = gm_scheme_mesh(scheme) == GM_MESH_FREE ? subject->mesh.cell : NULL;
    return subject->mesh.points <= GM_MESH_SUBJECT_POINTS &&
           (!subject->mesh.alone || gm_scheme_mesh(scheme) == GM_MESH_FREE) &&
           gm_mesh_start(&subject->mesh, gm_scheme_mesh(scheme), moving->start, problem->parameters,
                         subject->start);
}

bool gm_mesh_subject_advance(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt,
                             int64_t steps, const double *from, double *end)
{
    const struct gm_trial trial = {&subject->problem, scheme, &settings, dt, steps};
    return gm_trial_advance(&trial, from, end);
}

/* The state near the start whose y and then dy/dt are shifted, and X and dX/dt follow from the constraint. */
static bool shift(const struct gm_mesh_subject *subject, enum gm_mesh_kind kind, const double *by,
                  double *state)
{
    const size_t points = subject->mesh.points;
    memcpy(state, subject->start, subject->problem.n * sizeof *state);
    for (size_t i = 0; i < 2 * points && subject->mesh.alone; i++) {
        state[i] += by[i];
    }
    for (size_t i = 0; i < points && !subject->mesh.alone; i++) {
        state[i] += by[i];
        state[2 * points + i] += by[points + i];
        if (kind == GM_MESH_FREE) { /* nodes move by other shares of the same directions */
            state[points + i] += by[points - 1 - i] / 4;
            state[3 * points + i] += by[2 * points - 1 - i] / 4 - by[i] / 8;
        }
    }
    if (kind != GM_MESH_MOVING) {
        return true;
    }
    struct gm_elements stage = {0};
    struct gm_banded matrix = {0};
    double change[GM_MESH_SUBJECT_POINTS];
    bool good = gm_elements_open(&stage, &subject->mesh) && gm_banded_open(&matrix, points, 1);
    if (good) {
        gm_elements_place(&stage, state);
        good = gm_nodes_equidistribute(&stage, &subject->mesh, NULL, NULL, &matrix, change);
    }
    if (good) {
        /* dX/dt for dy/dt given: no slope, the rate is dy/dt */
        memcpy(state + points, stage.x + 1, points * sizeof *state);
        memcpy(stage.v + 1, state + 2 * points, points * sizeof *state);
        memset(stage.u, 0, (points + 2) * sizeof *stage.u);
        good = gm_nodes_set_in_motion(&stage, &matrix, state + 3 * points);
    }
    gm_banded_close(&matrix);
    gm_elements_close(&stage);
    return good;
}

struct observation {
    const struct gm_mesh_subject *subject;
    enum gm_mesh_kind kind;
    gm_mesh_observe *observe;
    const void *context;
};

static bool observe_shifted(const void *data, const double *by, double *values)
{
    const struct observation *of = data;
    double state[GM_MESH_SUBJECT_STATE];
    return shift(of->subject, of->kind, by, state) && of->observe(of->subject, of->context, state, values);
}

bool gm_mesh_subject_derive(const struct gm_mesh_subject *subject, enum gm_mesh_kind kind, size_t direction,
                            gm_mesh_observe *observe, const void *context, size_t count, double *derivative)
{
    const double start[2 * GM_MESH_SUBJECT_POINTS] = {0};
    double along[2 * GM_MESH_SUBJECT_POINTS] = {0};
    along[direction] = 1;
    const struct observation observation = {subject, kind, observe, context};
    const struct gm_map map = {observe_shifted, &observation, 2 * subject->mesh.points, count};
    return gm_differentiate(&map, start, along, derivative);
}
