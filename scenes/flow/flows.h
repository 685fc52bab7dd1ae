/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_FLOWS_H
#define GM_SCENES_FLOW_FLOWS_H

#include "core/flow/boundary.h"
#include "core/flow/flow.h"
#include "core/flow/gmsh.h"
#include "core/flow/rectangle.h"
#include "core/flow/start.h"
#include "scenes/common/lane.h"

/* What the scenes of flows on complexes have in common: room, and those of files. All solve, in the plane,
       omega_t + u . grad omega = nu Laplace omega,   omega = -Laplace psi,   u = (psi_y, -psi_x)
       theta_t + u . grad theta = kappa Laplace theta
   by discrete exterior calculus (core/flow/flow.h), whose velocity has no divergence but rounding. */

enum gm_flows_show {
    GM_SHOW_SCALAR,
    GM_SHOW_VORTICITY,
    GM_SHOW_SPEED,
    GM_SHOW_PRESSURE,
    GM_SHOW_NONE,
    GM_SHOW_PROFILES,
    GM_SHOW_CONVERGENCE,
    GM_SHOW_DIVERGENCE,
    GM_SHOW_TEMPERATURE, /* of flows that carry heat */
};

enum { GM_FLOWS_OWN = 8 /* parameters and choices of a file's that only it knows */ };

/* The parameters; a scene's table has rows for those that it uses. */
struct gm_flows {
    struct gm_timing timing;
    double reynolds, schmidt, viscosity, irregular, own[GM_FLOWS_OWN];
    long rows, columns, tracers, refine;
    char mesh[GM_TEXT_SIZE], inlet[GM_TEXT_SIZE], outlet[GM_TEXT_SIZE], lid[GM_TEXT_SIZE];
    int show, streamlines, arrows, grid, star, smoke, choices[GM_FLOWS_OWN];
    const struct gm_user_room *room; /* of a file's (scenes/flow/user_room.h) */
};

extern const char *const gm_flows_shows[], *const gm_flows_warm_shows[], *const gm_flows_stars[];

/* The mesh of a rectangle; `strips` 0: the best number. NULL with a sentence. */
struct gm_complex *gm_flows_rectangle(struct gm_rectangle *rectangle, char *sentence);

/* Cuts each edge of the mesh of a file into `parts`, a power of two. False with a sentence, and the mesh closed. */
bool gm_flows_refine(const char *path, enum gm_star star, long parts, struct gm_triangulation *mesh,
                     char *sentence);

/* The mesh of a file, or of one that is built in (NULL: it is not). False with a sentence that names the line or
   triangle. */
struct gm_built_in;
bool gm_flows_file(const char *path, const struct gm_built_in *inside, enum gm_star star,
                   struct gm_triangulation *mesh, char *sentence);

/* Notes the star that was taken where it was left to the mesh. */
void gm_flows_chosen(const struct gm_problem *problem, void *parameters);
/* gm_scene.note: the axes of a mesh that lies in another plane than that of x and y, and triangles that are there twice. */
void gm_flows_note(const struct gm_problem *problem, const void *parameters, char *sentence);

/* What an outlet may be, NULL-terminated: the usual words of the parameter. */
extern const char *const gm_flows_outlets[];
/* Reads "soft", "dirichlet", "free", or GROUP, or GROUP:free and so on; *group: "outlet" unless named. */
bool gm_flows_outlet(const char *text, enum gm_vertex_kind *kind, char *group, char *sentence);

/* Writes why a boundary makes no flow; true for GM_BOUNDARY_OK. */
bool gm_flows_boundary(enum gm_boundary_fault fault, char *sentence);

/* With a mesh file nothing makes a mesh, and without one nothing is named in it. */
const char *gm_flows_idle(const void *parameters, const char *key);

/* A profile: along the line from a to b, `count` points. */
struct gm_profile {
    const char *name;
    double a[2], b[2];
    size_t count;
};
/* What a scene's picture shows besides the field. */
struct gm_look {
    const char *title;
    /* The subtitle: real parameters by name and place in struct gm_flows, those that all lanes share (where
       they differ, the panels tell); then mesh and scheme, and a remark. */
    struct {
        const char *name;
        size_t offset;
        const char *unit; /* NULL: none */
        bool nonzero;     /* it is left out where it is 0 */
    } told[2];
    const char *remark;     /* NULL: none */
    const char *clock_unit; /* after the clock's time; "" */
    const char *axes[2];    /* of the field, x and y, where one lane is shown; NULL: none are drawn */
    double scalar_high;     /* the scalar's range; 0: inlet_scalar */
    double temperature[2];  /* its range */
    const char *names[GM_SHOW_TEMPERATURE + 1]; /* beside the colours; NULL: without a unit */
    double vorticity_range;                     /* what the colours end at */
    double speed_high;
    const char *const *sides; /* names of openings, by the number of their side; NULL: "inlet", "outlet" */
    const double *levels;     /* of psi, where they are not chosen by the flow through; NULL */
    size_t level_count;
    const char *graphs[2]; /* observables */
    double graph_low[2], graph_high[2];
    void (*profiles)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                     enum gm_place place);
    bool profiles_below; /* the field, where there are no graphs over time */
    const struct gm_look_error {
        const char *observable, *name;
    } * errors; /* of the convergence picture, ended by NULL */
};

void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look);

#endif
