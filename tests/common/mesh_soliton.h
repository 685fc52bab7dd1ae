/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_MESH_SOLITON_H
#define GM_TESTS_COMMON_MESH_SOLITON_H

#include "core/mesh/moving_mesh.h"

/* One or two solitons of the sine-Gordon equation, or kinks of phi^4, between the walls of a box, on a moving
   mesh. Tyranowski & Desbrun (2019), section 5. */

/* W = (phi^2 - 1)^2 / 4 with its means in closed form */
extern const struct gm_potential gm_potential_phi4;

enum gm_soliton_field { GM_SINE_GORDON, GM_PHI4 };

/* Densities in closed form, in the order of gm_user_densities; the last depends on slope, field and place. */
enum gm_closed_density { GM_ARCLENGTH, GM_CURVATURE, GM_MIX, GM_LIMITED, GM_TEMPERED, GM_OF_ALL };
struct gm_density_numbers {
    enum gm_closed_density which;
    enum gm_soliton_field field;
    double alpha, steepest, bend;
};
/* Returns the density, which lives as long as the program. */
const struct gm_density *gm_closed_density(const struct gm_density_numbers *numbers);

struct gm_soliton {
    int field;   /* enum gm_soliton_field */
    int density; /* enum gm_closed_density */
    long solitons, points;
    double velocity, length;
    double alpha; /* NaN: one that puts about half of the nodes where the field changes */
};

/* The problem for these parameters, which outlive it. */
void gm_soliton_problem(const struct gm_soliton *soliton, struct gm_problem *problem);

/* alpha, resolved */
double gm_soliton_alpha(const struct gm_soliton *soliton);

/* The field at the start, a gm_mesh_profile of a struct gm_soliton. */
void gm_soliton_profile(const void *soliton, const double *x, size_t count, double *value, double *slope,
                        double *rate);

/* The solution, exact up to the contribution of images of the soliton beyond the walls (about 1e-12); NaN
   if none is known, as for phi^4 after a kink has come near a wall or another kink. Their eq. 168. */
double gm_soliton_exact(const struct gm_soliton *soliton, double x, double t);

/* The energy of the solitons on the line. */
double gm_soliton_energy(const struct gm_soliton *soliton);

#endif
