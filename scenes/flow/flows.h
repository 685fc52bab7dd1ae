/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_FLOWS_H
#define GM_SCENES_FLOW_FLOWS_H

#include "core/flow/boundary.h"
#include "core/flow/flow.h"
#include "core/flow/gmsh.h"
#include "core/flow/start.h"
#include "core/form/generators.h"
#include "scenes/common/lane.h"

/* The common part of all scenes of flows on complexes: room, and scenes from files. All solve, in the plane,
       omega_t + u . grad omega = nu Laplace omega,   omega = -Laplace psi,   u = (psi_y, -psi_x)
       theta_t + u . grad theta = kappa Laplace theta
   by discrete exterior calculus (core/flow/flow.h), whose velocity is divergence-free to round-off. */

enum gm_flows_show {
    GM_SHOW_SCALAR,
    GM_SHOW_VORTICITY,
    GM_SHOW_SPEED,
    GM_SHOW_PRESSURE,
    GM_SHOW_NONE,
    GM_SHOW_PROFILES,
    GM_SHOW_CONVERGENCE,
    GM_SHOW_DIVERGENCE,
    GM_SHOW_TEMPERATURE, /* only if heat is carried */
};

enum { GM_FLOWS_OWN = 8 /* most parameters, or choices, of a single file */ };

/* The parameters; a scene's table has rows for some. */
struct gm_flows {
    struct gm_timing timing;
    double reynolds, schmidt, viscosity, irregular, own[GM_FLOWS_OWN];
    long rows, columns, tracers, refine;
    char mesh[GM_TEXT_SIZE], inlet[GM_TEXT_SIZE], outlet[GM_TEXT_SIZE], lid[GM_TEXT_SIZE];
    int show, streamlines, arrows, grid, star, smoke, choices[GM_FLOWS_OWN];
    const struct gm_user_room *room; /* the room of a file (scenes/flow/user_room.h) */
};

extern const char *const gm_flows_shows[], *const gm_flows_warm_shows[], *const gm_flows_stars[];

/* Returns the mesh of a rectangle; `strips` 0: the best number. NULL with a sentence on failure. */
struct gm_complex *gm_flows_rectangle(struct gm_rectangle *rectangle, char *sentence);

/* Cuts each edge of the mesh of a file into `parts`, a power of two. On failure returns false with a sentence
   and closes the mesh. */
bool gm_flows_refine(const char *path, enum gm_star star, long parts, struct gm_triangulation *mesh,
                     char *sentence);

/* Reads the mesh of a file, or a built-in one if `inside` is not NULL. On failure returns false with a
   sentence that names the line or triangle. */
struct gm_built_in;
bool gm_flows_file(const char *path, const struct gm_built_in *inside, enum gm_star star,
                   struct gm_triangulation *mesh, char *sentence);

/* Notes the star that was used if the choice was left to the mesh. */
void gm_flows_chosen(const struct gm_problem *problem, void *parameters);
/* gm_scene.note: the axes of a mesh outside the plane of x and y, and the number of repeated triangles. */
void gm_flows_note(const struct gm_problem *problem, const void *parameters, char *sentence);

/* The possible words of the parameter `outlet`, NULL-terminated. */
extern const char *const gm_flows_outlets[];
/* Reads "soft", "dirichlet", "free", or GROUP, or GROUP:free and so on; *group: "outlet" unless named. */
bool gm_flows_outlet(const char *text, enum gm_vertex_kind *kind, char *group, char *sentence);

/* Returns why a parameter has no effect, with a mesh file or without; NULL if it has one. */
const char *gm_flows_idle(const void *parameters, const char *key);

/* A profile: `count` points from a to b. */
struct gm_profile {
    const char *name;
    double a[2], b[2];
    size_t count;
};
/* The parts of a scene's picture other than the field. */
struct gm_look {
    const char *title;
    /* The subtitle: real parameters by name and offset in struct gm_flows, if all lanes share them (else the
       panels show them); then mesh and scheme, and a remark. */
    struct {
        const char *name;
        size_t offset;
        const char *unit; /* NULL: none */
        bool nonzero;     /* it is left out if it is 0 */
    } told[2];
    const char *remark;     /* NULL: none */
    const char *clock_unit; /* the unit after the clock's time; "" */
    const char *axes[2];    /* labels of x and y of the field, if one lane is shown; NULL: none are drawn */
    double scalar_high;     /* the scalar's range; 0: inlet_scalar */
    double temperature[2];  /* the range of the temperature */
    const char *names[GM_SHOW_TEMPERATURE + 1]; /* labels of the colours; NULL: without a unit */
    double vorticity_range;                     /* the end of the colours */
    double speed_high;
    const char *const *sides; /* names of openings, by the number of their side; NULL: "inlet", "outlet" */
    const double *levels;     /* levels of psi; NULL: they are chosen by the flow through */
    size_t level_count;
    const char *graphs[2]; /* keys of observables */
    double graph_low[2], graph_high[2];
    void (*profiles)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                     enum gm_place place);
    bool profiles_below; /* profiles are below the field, if there are no graphs over time */
    const struct gm_look_error {
        const char *observable, *name;
    } * errors; /* the errors of the convergence picture, ended by NULL */
};

void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look);

#endif
