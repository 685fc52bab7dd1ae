/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_CERTIFY_SUBJECT_H
#define GM_CORE_MESH_CERTIFY_SUBJECT_H

#include "core/linear/differences.h"
#include "core/mesh/user/potential.h"
#include "core/theory/certify.h"

/* Test problems of schemes on meshes: a field on a few nodes, usually one soliton, and derivatives along
   its motions. */

enum {
    GM_MESH_SUBJECT_POINTS = 7, /* most nodes of the mesh */
    GM_MESH_SUBJECT_STATE = 4 * GM_MESH_SUBJECT_POINTS,
};

struct gm_mesh_subject {
    struct gm_trial trial; /* one step of a scheme on the problem */
    enum gm_mesh_kind kind;
    struct gm_mesh mesh;
    double start[GM_MESH_SUBJECT_STATE];
};

/* The file of share/subjects. Opens it with `points` nodes; false when out of memory. The caller closes it in both cases. */
struct gm_mesh_soliton {
    struct gm_user_system system;
    struct gm_user_wave wave;
    struct gm_problem problem;
};
bool gm_mesh_soliton_open(struct gm_mesh_soliton *soliton, size_t points);
void gm_mesh_soliton_close(struct gm_mesh_soliton *soliton);

/* Opens a subject on a problem of at most GM_MESH_SUBJECT_POINTS nodes, with the problem's start for the scheme. False
   if it has no start, or when out of memory. */
bool gm_mesh_subject_open(struct gm_mesh_subject *subject, const struct gm_scheme *scheme,
                          const struct gm_problem *problem, double dt);

/* The state near the start whose y and then dy/dt are shifted, and X and dX/dt follow from the constraint. */
bool gm_mesh_subject_shift(const struct gm_mesh_subject *subject, const double *by, double *state);

/* The derivatives of the numbers that a map makes of such shifts, along component `direction` of them. Returns false if
   the map fails. */
bool gm_mesh_derive(const struct gm_map *map, size_t direction, double *derivative);

/* The defect of the local law that core/mesh/certify/law.c states; NaN if it does not apply. */
double gm_mesh_law_defect(const struct gm_mesh_subject *subject);

#endif
