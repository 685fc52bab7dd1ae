/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_FRAMES_H
#define GM_CORE_FIELD_FAMILIES_FRAMES_H

#include "core/field/problems/problems.h"

/* A point of space and time with the value of the field there: what a symmetry moves. */
struct gm_event {
    double t, x, u;
};

/* A symmetry about (t, x) = (0, 0), in burgers.c, heat.c and kdv_moving_frames.c: a boost by a velocity and a
   projection (Korteweg and de Vries' equation has none), then a scaling. */
struct gm_point_symmetry {
    double boost, projection, scale;
};

/* The symmetries of an equation, and the moving frames of its schemes. */
struct gm_moving_frames {
    struct gm_event (*carry)(const struct gm_framed *framed, const struct gm_point_symmetry *symmetry,
                             struct gm_event event);
    /* Finds the frame that carries node j of the state y, and those around it, to where a step dt is made. Returns
       false if no such frame exists. */
    bool (*find)(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt, const double *y,
                 size_t j, struct gm_point_symmetry *frame);
    /* Returns the defect of a step dt under a symmetry: the step of the carried state against the carried step. NaN if
       it has no meaning for the scheme, or if a step fails. */
    double (*defect)(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                     const struct gm_point_symmetry *symmetry, const double *y);
    /* Returns what the original frame sees of the value u at time t, at the node that was at x at the start and rests there
       (fixed) or moves along. */
    double (*seen)(const struct gm_framed *framed, bool fixed, double x, double t, double u);
    /* Returns true if a scheme's frames are of another kind than the usual one: of Burgers' equation, those of a and d;
       of heat, with projections; of Korteweg and de Vries', those of evolution and projection. */
    bool (*are_special)(const struct gm_scheme *scheme);
};
extern const struct gm_moving_frames gm_frames_of_burgers, gm_frames_of_heat, gm_frames_of_kdv;

/* Returns those of a problem; NULL: its equation has none, and its parameters do not begin with struct gm_framed. */
static inline const struct gm_moving_frames *gm_moving_frames_of(const struct gm_problem *problem)
{
    switch (gm_field_of(problem)->equation) {
    case GM_NEEDS_BURGERS:
        return &gm_frames_of_burgers;
    case GM_NEEDS_HEAT:
        return &gm_frames_of_heat;
    case GM_NEEDS_KDV:
        return &gm_frames_of_kdv;
    default:
        return NULL;
    }
}

/* Returns the exact value at time t at the node that starts at x and moves with this speed. */
double gm_frame_exact(const struct gm_framed *framed, double speed, double x, double t);

/* The heat equation: the divisor of the value at time t, in the new frame, at the node that was at x at the start and
   rests there (fixed) or moves, which gives the value in the original frame. */
double gm_heat_factor(const struct gm_framed *framed, bool fixed, double x, double t);

#endif
