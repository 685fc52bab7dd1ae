/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_MESH_OBSERVED_H
#define GM_SCENES_MESH_OBSERVED_H

#include "core/mesh/moving_mesh.h"
#include "scenes/common/scene.h"

/* The observables of every field on a moving mesh. */

/* The mesh, with the cells' Lagrangian if the scheme integrates it. */
struct gm_mesh gm_mesh_of(const struct gm_view *view);
/* Returns a measure of the state by the key of the observable (enum gm_mesh_measure). */
double gm_view_mesh_measure(const struct gm_view *view);
/* Returns the exact solution; NaN if none is known. */
double gm_mesh_exact(const struct gm_view *view, double x, double t);
/* Returns the largest difference of a lane's field at its nodes from the field of a lane with more nodes,
   linear between them. */
double gm_mesh_distance(const struct gm_lane *lane, const struct gm_lane *finer);

double gm_view_newton_iterations(const struct gm_view *view);
double gm_view_factorisations(const struct gm_view *view);
#define GM_MESH_SOLVING                                                                                      \
    GM_LOG_OBSERVABLE("smallest_cell", gm_view_mesh_measure, "smallest cell"),                               \
        GM_OBSERVABLE("newton_iterations", gm_view_newton_iterations, "Newton iterations"),                  \
        GM_OBSERVABLE("factorisations", gm_view_factorisations, "matrices factored")

/* Observables of every field, against an exact solution, and those that are computed on request. */
extern const struct gm_observable gm_mesh_observables[8], gm_mesh_errors[2], gm_mesh_asked[3];

/* The paths of all nodes, or of evenly chosen ones. */
extern const struct gm_track gm_mesh_paths_track;

#endif
