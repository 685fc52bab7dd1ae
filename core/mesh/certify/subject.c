/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The soliton that schemes on meshes are certified on, and steps from its start. */
#include "core/mesh/certify/subject.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/files/files.h"
#include "core/mesh/nodes.h"
#include "core/model/equations.h"
#include "core/user/line.h"

static const struct gm_settings settings = {0};

bool gm_mesh_soliton_open(struct gm_mesh_soliton *soliton, size_t points)
{
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SUBJECT, "soliton");
    struct gm_user_system *system = &soliton->system;
    struct gm_fault fault;
    *soliton = (struct gm_mesh_soliton){.problem.n = 0};
    double *values = gm_equations_open(system, file->text, file->length, NULL, 0, &fault)
                         ? gm_equations_start(system, NULL)
                         : NULL;
    const struct gm_user_mesh chosen = {.length = 12,
                                        .points = (long)points,
                                        .alpha = NAN,
                                        .density = system->texts[GM_WORD_DENSITY],
                                        .map = system->texts[GM_WORD_MESH],
                                        .cell = system->texts[GM_WORD_CELL]};
    const bool good = values && gm_user_wave_derive(&soliton->wave, system) &&
                      gm_user_mesh_open(&soliton->problem, &soliton->wave, values, &chosen);
    free(values);
    soliton->problem.name = "soliton";
    return good;
}

void gm_mesh_soliton_close(struct gm_mesh_soliton *soliton)
{
    gm_user_line_close(&soliton->problem);
    gm_system_close(&soliton->system);
}

bool gm_mesh_subject_open(struct gm_mesh_subject *subject, const struct gm_scheme *scheme,
                          const struct gm_problem *problem, double dt)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    struct gm_mesh *mesh = &subject->mesh;
    subject->trial = (struct gm_trial){problem, scheme, &settings, dt, 1};
    const struct gm_trial begin = {problem, scheme, &settings, dt, 0}; /* no step: as the scheme begins */
    subject->kind = gm_scheme_mesh(scheme);
    *mesh = gm_mesh_of_problem(problem);
    mesh->cell = subject->kind == GM_MESH_FREE ? mesh->cell : NULL;
    return mesh->points <= GM_MESH_SUBJECT_POINTS && (!mesh->alone || subject->kind == GM_MESH_FREE) &&
           gm_mesh_start(mesh, subject->kind, moving->start, problem->parameters, subject->start) &&
           gm_trial_advance(&begin, subject->start, subject->start);
}

bool gm_mesh_subject_shift(const struct gm_mesh_subject *subject, const double *by, double *state)
{
    const size_t points = subject->mesh.points;
    memcpy(state, subject->start, subject->trial.problem->n * sizeof *state);
    for (size_t i = 0; i < 2 * points && subject->mesh.alone; i++) {
        state[i] += by[i];
    }
    for (size_t i = 0; i < points && !subject->mesh.alone; i++) {
        state[i] += by[i];
        state[2 * points + i] += by[points + i];
        if (subject->kind == GM_MESH_FREE) { /* nodes move by other shares of the same directions */
            state[points + i] += by[points - 1 - i] / 4;
            state[3 * points + i] += by[2 * points - 1 - i] / 4 - by[i] / 8;
        }
    }
    if (subject->kind != GM_MESH_MOVING) {
        return true;
    }
    struct gm_elements stage = {0};
    struct gm_banded matrix = {0};
    double change[GM_MESH_SUBJECT_POINTS];
    gm_elements_open_at(&stage, &subject->mesh, state);
    bool good = stage.memory && gm_banded_open(&matrix, points, 1) &&
                gm_nodes_equidistribute(&stage, &subject->mesh, NULL, NULL, &matrix, change);
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

bool gm_mesh_derive(const struct gm_map *map, size_t direction, double *derivative)
{
    const double start[2 * GM_MESH_SUBJECT_POINTS] = {0};
    double along[2 * GM_MESH_SUBJECT_POINTS] = {0};
    along[direction] = 1;
    return gm_differentiate(map, start, along, derivative);
}
