/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_FLOWS_H
#define GM_SCENES_FLOW_FLOWS_H

#include "core/flow/boundary.h"
#include "core/flow/flow.h"
#include "core/flow/gmsh.h"
#include "core/flow/rectangle.h"
#include "core/flow/start.h"
#include "scenes/frame/lane.h"

/* What the scenes of flows on complexes have in common: room, channel, couette, poiseuille, cavity,
   taylor-green. All solve, in the plane,
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
};

enum { GM_DOMAIN_TORUS, GM_DOMAIN_BOX };

/* The parameters; a scene's table has rows for those that it uses. */
struct gm_flows {
    struct gm_timing timing;
    double reynolds, schmidt, viscosity, irregular, inlet_scalar, speed;
    long rows, columns, tracers;
    char mesh[GM_TEXT_SIZE], inlet[GM_TEXT_SIZE], outlet[GM_TEXT_SIZE], lid[GM_TEXT_SIZE];
    int show, streamlines, arrows, grid, domain;
};

#define GM_FLOWS_NUMBER(name, text, standard_text, low, high, by_factors)                                    \
    {                                                                                                        \
        .key = #name, .unit = "", .help = text, .type = GM_REAL, .offset = offsetof(struct gm_flows, name),  \
        .standard = standard_text, .lowest = low, .highest = high, .logarithmic = by_factors,                \
    }
#define GM_FLOWS_WHOLE(name, text, standard_text, low, high)                                                 \
    {                                                                                                        \
        .key = #name, .unit = "", .help = text, .type = GM_INTEGER,                                          \
        .offset = offsetof(struct gm_flows, name), .standard = standard_text, .lowest = low,                 \
        .highest = high, .logarithmic = true,                                                                \
    }
#define GM_FLOWS_WORD(name, text, standard_text, list)                                                       \
    {                                                                                                        \
        .key = #name, .unit = "", .help = text, .type = GM_TEXT, .offset = offsetof(struct gm_flows, name),  \
        .standard = standard_text, .choices = list,                                                          \
    }
#define GM_FLOWS_MESH(text)                                                                                  \
    {                                                                                                        \
        .key = "mesh", .unit = "", .help = text, .type = GM_TEXT, .offset = offsetof(struct gm_flows, mesh), \
        .standard = "none", .file = true,                                                                    \
    }
#define GM_FLOWS_CHOICE(name, text, standard_text, list, acts)                                               \
    {                                                                                                        \
        .key = #name, .unit = "", .help = text, .type = GM_CHOICE,                                           \
        .offset = offsetof(struct gm_flows, name), .standard = standard_text, .choices = list, .live = acts, \
    }
#define GM_FLOWS_FLAG(name, text, standard_text)                                                             \
    {                                                                                                        \
        .key = #name, .unit = "", .help = text, .type = GM_BOOLEAN,                                          \
        .offset = offsetof(struct gm_flows, name), .standard = standard_text, .lowest = 0, .highest = 1,     \
        .live = true,                                                                                        \
    }
#define GM_FLOWS_IRREGULAR                                                                                   \
    GM_FLOWS_NUMBER(irregular, "random shift of the vertices, as a part of their shortest edge", "0", 0,     \
                    0.45, false)
#define GM_FLOWS_LOOKS(shown, streamlines_shown)                                                             \
    GM_FLOWS_CHOICE(show, "what the picture shows", shown, gm_flows_shows, true),                            \
        GM_FLOWS_FLAG(streamlines, "streamlines, as level lines of the stream function", streamlines_shown), \
        GM_FLOWS_FLAG(arrows, "arrows of velocity", "no"),                                                   \
        GM_FLOWS_FLAG(grid, "the edges of the mesh", "no")
#define GM_FLOWS_TRACERS(count)                                                                              \
    GM_FLOWS_WHOLE(tracers, "particles that the flow carries along", count, 0, 20000)

extern const char *const gm_flows_shows[];

/* The mesh of a rectangle: `rows` edges on the walls that strips end at, `columns` strips (0: chosen). NULL
   with a sentence. */
struct gm_complex *gm_flows_rectangle(struct gm_rectangle *rectangle, char *sentence);

/* The mesh of a file. False with a sentence that names the line or triangle. */
bool gm_flows_file(const char *path, struct gm_triangulation *mesh, char *sentence);

/* Whether the mesh of the parameters, if they name one, can be read; a sentence if not. */
bool gm_flows_readable(const void *parameters, char *sentence);

/* The tag of the boundary group `name`, which `key` was to name; 0 with a sentence. */
long gm_flows_group(const struct gm_triangulation *mesh, const char *key, const char *name, char *sentence);

/* What an outlet may be, NULL-terminated: the usual words of the parameter. */
extern const char *const gm_flows_outlets[];
/* Reads "soft", "dirichlet", "free", or GROUP, or GROUP:free and so on; *group: "outlet" unless named. */
bool gm_flows_outlet(const char *text, enum gm_vertex_kind standard, enum gm_vertex_kind *kind, char *group,
                     char *sentence);

/* Writes why a boundary makes no flow; true for GM_BOUNDARY_OK. */
bool gm_flows_boundary(enum gm_boundary_fault fault, char *sentence);

/* Makes flow the problem's; gm_flows_close frees it again. */
void gm_flows_problem(struct gm_problem *problem, struct gm_flow *flow, const char *name);
void gm_flows_close(struct gm_problem *problem);

/* The time, in a scene's own unit, in which a speed of 1 passes a mean edge: the Courant number is dt over
   it. NAN if setup refuses. */
typedef bool gm_flows_setup(const void *parameters, struct gm_problem *problem, char *sentence);
double gm_flows_courant_time(gm_flows_setup *setup, const void *parameters);

/* With a mesh file nothing makes a mesh, and without one nothing is named in it. */
const char *gm_flows_idle(const void *parameters, const char *key);

/* The middle of a boundary edge. */
void gm_flows_middle(const struct gm_complex *complex, size_t boundary_edge, double middle[2]);

/* The start without vorticity. */
void gm_flows_start(const void *parameters, const struct gm_problem *problem, double *y);

/* Observables that all flows have. */
double gm_flows_kinetic_energy(const struct gm_view *view);
double gm_flows_enstrophy(const struct gm_view *view);
double gm_flows_divergence(const struct gm_view *view);
double gm_flows_circulation_error(const struct gm_view *view);
double gm_flows_scalar_total(const struct gm_view *view);
double gm_flows_scalar_outflow(const struct gm_view *view);
double gm_flows_budget_defect(const struct gm_view *view);
double gm_flows_psi_low(const struct gm_view *view);
double gm_flows_speed_max(const struct gm_view *view);
/* how far psi moved in the last step, relative to its largest value */
double gm_flows_change(const struct gm_view *view);
double gm_flows_triangles(const struct gm_view *view);

#define GM_FLOWS_ENERGY                                                                                      \
    {                                                                                                        \
        .key = "kinetic_energy", .title = "kinetic energy", .unit = "", .evaluate = gm_flows_kinetic_energy  \
    }
#define GM_FLOWS_ENSTROPHY                                                                                   \
    {                                                                                                        \
        .key = "enstrophy", .title = "enstrophy", .unit = "", .evaluate = gm_flows_enstrophy                 \
    }
#define GM_FLOWS_SPEED                                                                                       \
    {                                                                                                        \
        .key = "speed_max", .title = "largest speed, of a triangle or of the boundary", .unit = "",          \
        .evaluate = gm_flows_speed_max                                                                       \
    }
#define GM_FLOWS_DIVERGENCE                                                                                  \
    {                                                                                                        \
        .key = "divergence", .title = "divergence  max |d₁ d₀ ψ|", .unit = "",                               \
        .evaluate = gm_flows_divergence, .logarithmic = true                                                 \
    }
#define GM_FLOWS_CHANGE                                                                                      \
    {                                                                                                        \
        .key = "change", .title = "change of ψ in a step", .unit = "", .evaluate = gm_flows_change,          \
        .logarithmic = true                                                                                  \
    }
#define GM_FLOWS_TRIANGLES                                                                                   \
    {                                                                                                        \
        .key = "triangles", .title = "triangles", .unit = "", .evaluate = gm_flows_triangles                 \
    }

/* Flow between walls, u = U(y) with psi, theta and the total pressure known everywhere. */
struct gm_shear {
    double (*velocity)(double y);
    double (*psi)(double y);
    double (*pressure)(double x, double y, double viscosity);
    double (*theta)(double y); /* NULL: it is y */
};
double gm_shear_psi_error(const struct gm_shear *shear, const struct gm_view *view);
double gm_shear_theta_error(const struct gm_shear *shear, const struct gm_view *view);
double gm_shear_flux_error(const struct gm_shear *shear, const struct gm_view *view);
double gm_shear_velocity_error(const struct gm_shear *shear, const struct gm_view *view);
double gm_shear_pressure_error(const struct gm_shear *shear, const struct gm_view *view);
/* the same away from the walls, further than .2 from each: there the layer of wrong vorticity along the
   walls, one cell wide, is not met */
double gm_shear_pressure_error_middle(const struct gm_shear *shear, const struct gm_view *view);
/* max |psi - exact| */
double gm_shear_solution_error(const struct gm_shear *shear, const struct gm_view *view);
double gm_flows_mean_edge(const struct gm_view *view);

/* What a scene's picture shows besides the field. */
struct gm_look {
    const char *title;
    const char *(*subtitle)(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count);
    const char *clock_unit;  /* after the clock's time; "" */
    const char *axes[2];     /* of the field, x and y, where one lane is shown; NULL: none are drawn */
    double scalar_high;      /* the scalar's range; 0: inlet_scalar */
    const char *scalar_name; /* beside its colours; NULL: "concentration θ" */
    double vorticity_range;  /* what the colours end at */
    double speed_high;
    const double *levels; /* of psi, where they are not chosen by the flow through; NULL */
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
/* "NAME VALUE,  " of the real parameter at this offset of struct gm_flows; "" where lanes differ in it: then
   their panels tell. */
const char *gm_flows_common(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                            const char *name, size_t offset);
/* "6600 triangles,  semi-implicit"; the scheme where it is the same in all lanes */
const char *gm_flows_mesh_and_scheme(struct gm_picture *picture, const struct gm_lane *const *lanes,
                                     size_t count);

void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look);

/* Rows of a profile: along the line from a to b, `count` points; reference(s) where it is known, s = 0 ..
   1. */
struct gm_profile {
    const char *name;
    double a[2], b[2];
    size_t count;
    double (*reference)(const struct gm_view *view, double s); /* NULL: none */
};
void gm_flows_write_profile(const struct gm_view *view, const char *front, const struct gm_profile *profile,
                            FILE *stream);
void gm_flows_write_sample(const struct gm_view *view, const char *front, const char *name, double x,
                           double z, double reference, FILE *stream);

#endif
