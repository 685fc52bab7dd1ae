/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_CERTIFY_SUBJECT_H
#define GM_CORE_MESH_CERTIFY_SUBJECT_H

#include "core/mesh/moving_mesh.h"
#include "core/scheme.h"

/* Test problems of schemes on meshes: a field on a few nodes, usually one soliton, and derivatives along
   its motions. */

enum {
    GM_MESH_SUBJECT_POINTS = 7, /* most nodes of the mesh */
    GM_MESH_SUBJECT_STATE = 4 * GM_MESH_SUBJECT_POINTS,
};

struct gm_mesh_subject {
    struct gm_problem problem;
    struct gm_mesh mesh;
    double start[GM_MESH_SUBJECT_STATE];
};

struct gm_mesh_step {
    const struct gm_scheme *scheme;
    double dt;
};

/* A soliton on a mesh of `points` nodes for a scheme, with its start. Returns false when out of memory. */
bool gm_mesh_subject_open(struct gm_mesh_subject *subject, const struct gm_scheme *scheme, size_t points);

/* Opens a subject on a problem of at most `points` nodes, with its own start. */
bool gm_mesh_subject_open_on(struct gm_mesh_subject *subject, const struct gm_scheme *scheme,
                             const struct gm_problem *problem);

/* Steps of a run that starts from the state `from`; false if it fails. */
bool gm_mesh_subject_advance(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt,
                             int64_t steps, const double *from, double *end);

/* Numbers that follow from a start; false if it fails. */
typedef bool gm_mesh_observe(const struct gm_mesh_subject *subject, const void *context, const double *state,
                             double *values);

/* The derivatives of `count` observed numbers by component `direction` of dy and then d(dy/dt), where X
   and dX/dt follow from the constraint, by differences (core/linear/differences.h). Returns false if a run
   fails. */
bool gm_mesh_subject_derive(const struct gm_mesh_subject *subject, enum gm_mesh_kind kind, size_t direction,
                            gm_mesh_observe *observe, const void *context, size_t count, double *derivative);

/* The defect of the local law that core/mesh/certify/law.c states; NaN if it does not apply. */
double gm_mesh_law_defect(const struct gm_mesh_subject *subject, const struct gm_scheme *scheme, double dt);

#endif
