/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_MESH_OBSERVED_H
#define GM_SCENES_MESH_OBSERVED_H

#include "core/mesh/moving_mesh.h"
#include "scenes/common/scene.h"

/* The observables of every field on a moving mesh. */

struct gm_mesh gm_mesh_of(const struct gm_view *view);
/* The mesh with the cells' Lagrangian if the scheme integrates it. */
struct gm_mesh gm_mesh_integrated(const struct gm_view *view);
/* Returns the exact solution; NaN if none is known. */
double gm_mesh_exact(const struct gm_view *view, double x, double t);
/* Returns the largest difference of a lane's field at its nodes from the field of a lane with more nodes,
   linear between them. */
double gm_mesh_distance(const struct gm_lane *lane, const struct gm_lane *finer);

double gm_view_mesh_energy(const struct gm_view *view);
double gm_view_field_energy(const struct gm_view *view);
/* Observables that are computed on request. */
extern const struct gm_observable gm_mesh_asked[3];
double gm_view_constraint_defect(const struct gm_view *view);
double gm_view_multiplier_norm(const struct gm_view *view);
double gm_view_smallest_cell(const struct gm_view *view);
double gm_view_newton_iterations(const struct gm_view *view);
double gm_view_factorisations(const struct gm_view *view);

/* Observables against an exact solution, and of every run. */
extern const struct gm_observable gm_mesh_errors[2];
#define GM_MESH_ENERGIES                                                                                     \
    GM_OBSERVABLE("energy", gm_view_mesh_energy, "discrete energy"),                                         \
        GM_KEPT_OBSERVABLE("energy_error", gm_view_mesh_energy, "E", "energy error"),                        \
        GM_KEPT_OBSERVABLE("field_energy_error", gm_view_field_energy, "E",                                  \
                           "energy error of the field alone",                                                \
                           .missing = "cells have no energy of their own")
#define GM_MESH_NODES                                                                                        \
    GM_LOG_OBSERVABLE("constraint_defect", gm_view_constraint_defect, "defect of the mesh constraint",       \
                      .missing = "this mesh does not move"),                                                 \
        GM_OBSERVABLE("multiplier_norm", gm_view_multiplier_norm, "largest multiplier"), GM_MESH_SOLVING
#define GM_MESH_SOLVING                                                                                      \
    GM_LOG_OBSERVABLE("smallest_cell", gm_view_smallest_cell, "smallest cell"),                              \
        GM_OBSERVABLE("newton_iterations", gm_view_newton_iterations, "Newton iterations"),                  \
        GM_OBSERVABLE("factorisations", gm_view_factorisations, "matrices factored")

/* The paths of all nodes, or of evenly chosen ones. */
extern const struct gm_track gm_mesh_paths_track;

#endif
