/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_FLOWS_H
#define GM_SCENES_FLOW_FLOWS_H

#include "core/flow/boundary.h"
#include "core/flow/flow.h"
#include "core/flow/gmsh.h"
#include "core/flow/rectangle.h"
#include "core/flow/start.h"
#include "scenes/common/lane.h"

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
    GM_SHOW_TEMPERATURE, /* of flows that carry heat */
};

enum { GM_DOMAIN_TORUS, GM_DOMAIN_BOX };

/* The parameters; a scene's table has rows for those that it uses. */
struct gm_flows {
    struct gm_timing timing;
    double reynolds, schmidt, viscosity, irregular, inlet_scalar, speed;
    long rows, columns, tracers, refine;
    char mesh[GM_TEXT_SIZE], inlet[GM_TEXT_SIZE], outlet[GM_TEXT_SIZE], lid[GM_TEXT_SIZE];
    int show, streamlines, arrows, grid, domain, star, smoke;
    const struct gm_user_room *room; /* of a file's (scenes/flow/user_room.h) */
};

/* Rows that several of them have. */
#define GM_FLOWS_IRREGULAR                                                                                   \
    GM_REAL_ROW(struct gm_flows, irregular, "irregular", "0", 0, 0.45,                                       \
                "random shift of the vertices, as a part of their shortest edge")
#define GM_FLOWS_STAR                                                                                        \
    GM_CHOICE_ROW(                                                                                           \
        struct gm_flows, star, "star", "auto", gm_flows_stars,                                               \
        "Hodge star of a mesh=FILE: circumcentric needs Delaunay triangles, barycentric, or galerkin, takes any")
#define GM_FLOWS_REFINE                                                                                      \
    GM_INTEGER_ROW(struct gm_flows, refine, "refine", "1", 1, 64,                                            \
                   "parts that each edge of a mesh=FILE is cut into: 1, 2, 4 ...", .logarithmic = true)
#define GM_FLOWS_TRACERS(count)                                                                              \
    GM_INTEGER_ROW(struct gm_flows, tracers, "tracers", count, 0, 20000,                                     \
                   "particles that the flow carries along", .logarithmic = true)
#define GM_FLOWS_SMOKE                                                                                       \
    GM_BOOLEAN_ROW(struct gm_flows, smoke, "smoke", "no",                                                    \
                   "tracers come in at inlets and sources, and do not fill the room at the start")
#define GM_FLOWS_LOOKS(shown, streamlines_shown)                                                             \
    GM_CHOICE_ROW(struct gm_flows, show, "show", shown, gm_flows_shows, "what the picture shows",            \
                  .live = true),                                                                             \
        GM_BOOLEAN_ROW(struct gm_flows, streamlines, "streamlines", streamlines_shown,                       \
                       "streamlines, as level lines of the stream function", .live = true),                  \
        GM_BOOLEAN_ROW(struct gm_flows, arrows, "arrows", "no", "arrows of velocity", .live = true),         \
        GM_BOOLEAN_ROW(struct gm_flows, grid, "grid", "no", "the edges of the mesh", .live = true)

extern const char *const gm_flows_shows[], *const gm_flows_warm_shows[], *const gm_flows_stars[];

/* For settle: of rows and columns the one that is not among the keys follows from the one that is. Transposed, the
   rows are edges, and the columns strips; else the other way round. */
void gm_flows_follow(struct gm_flows *flows, struct gm_rectangle rectangle, const char *const *keys,
                     size_t count);
/* settle of a unit square with the edges along x, so that the columns are edges; and with the edges along y. */
bool gm_flows_settle_columns(void *self, const char *const *keys, size_t count, char *sentence);
bool gm_flows_settle_rows(void *self, const char *const *keys, size_t count, char *sentence);
/* A flow on the mesh of a rectangle; `strips` 0: the best number. NULL with a sentence. */
struct gm_flow *gm_flows_rectangle(struct gm_rectangle *rectangle, char *sentence);

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

/* Makes flow the problem's; gm_flows_close frees it again. False with a sentence, and flow is freed, where there is
   nothing that could solve its equations. */
bool gm_flows_problem(struct gm_problem *problem, struct gm_flow *flow, const char *name, char *sentence);
void gm_flows_close(struct gm_problem *problem);

/* The time, in a scene's own unit, in which a speed of 1 passes a mean edge: the Courant number is dt over
   it. NAN if setup refuses. */
typedef bool gm_flows_setup(const void *parameters, struct gm_problem *problem, char *sentence);
double gm_flows_courant_time(gm_flows_setup *setup, const void *parameters);

/* Of a map over Reynolds and Courant numbers: where schemes that march through time keep the speed. */
enum { GM_FLOWS_COURANT_NUMBERS = 8 };
extern const double gm_flows_courant_numbers[GM_FLOWS_COURANT_NUMBERS];
extern const char *const gm_flows_marching[];
#define GM_FLOWS_STABILITY                                                                                   \
    .parameter = "reynolds", .label = "Courant number", .steps = gm_flows_courant_numbers,                   \
    .step_count = GM_FLOWS_COURANT_NUMBERS, .kept = "speed_max", .schemes = gm_flows_marching

#define GM_FLOWS_NO_STABILITY                                                                                \
    "its exact solution is known, and work-precision measures its steps; stability cavity maps the same schemes"

/* With a mesh file nothing makes a mesh, and without one nothing is named in it. */
const char *gm_flows_idle(const void *parameters, const char *key);

/* The middle of a boundary edge. */
void gm_flows_middle(const struct gm_complex *complex, size_t boundary_edge, double middle[2]);

/* What each boundary edge is (enum gm_edge_kind), by where its middle is. NULL with a sentence. */
unsigned char *gm_flows_sides(const struct gm_flow *flow, unsigned char (*side)(const double middle[2]),
                              char *sentence);

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
double gm_flows_obtuse_share(const struct gm_view *view);
double gm_flows_star_least(const struct gm_view *view);

#define GM_FLOWS_ENERGY GM_OBSERVABLE("kinetic_energy", gm_flows_kinetic_energy, "kinetic energy")
#define GM_FLOWS_ENSTROPHY GM_OBSERVABLE("enstrophy", gm_flows_enstrophy, "enstrophy")
#define GM_FLOWS_SPEED                                                                                       \
    GM_OBSERVABLE("speed_max", gm_flows_speed_max, "largest speed, of a triangle or of the boundary")
#define GM_FLOWS_DIVERGENCE GM_LOG_OBSERVABLE("divergence", gm_flows_divergence, "divergence  max |d₁ d₀ ψ|")
#define GM_FLOWS_CHANGE GM_LOG_OBSERVABLE("change", gm_flows_change, "change of ψ in a step")
#define GM_FLOWS_OBTUSE GM_OBSERVABLE("obtuse_share", gm_flows_obtuse_share, "share of obtuse triangles")
#define GM_FLOWS_STAR_LEAST                                                                                  \
    GM_OBSERVABLE("star_least", gm_flows_star_least, "least entry of the circumcentric star")
#define GM_FLOWS_TRIANGLES GM_OBSERVABLE("triangles", gm_flows_triangles, "triangles")
/* Those of rooms. */
#define GM_FLOWS_OF_ROOMS                                                                                    \
    GM_OBSERVABLE("scalar_total", gm_flows_scalar_total, "pollutant in the room"),                           \
        GM_OBSERVABLE("scalar_outflow", gm_flows_scalar_outflow, "outflow of pollutant"),                    \
        GM_LOG_OBSERVABLE("budget_defect", gm_flows_budget_defect, "defect of the pollutant's budget"),      \
        GM_FLOWS_DIVERGENCE, GM_FLOWS_ENERGY, GM_FLOWS_ENSTROPHY, GM_FLOWS_SPEED, GM_FLOWS_CHANGE,           \
        GM_FLOWS_TRIANGLES

double gm_flows_mean_edge(const struct gm_view *view);
/* max |psi - exact|, of a flow along x whose stream function is known */
double gm_flows_psi_error(const struct gm_view *view, double (*psi)(double y));

/* A profile: along the line from a to b, `count` points; reference(s) where it is known, s = 0 .. 1. */
struct gm_profile {
    const char *name;
    double a[2], b[2];
    size_t count;
    double (*reference)(const struct gm_view *view, double s); /* NULL: none */
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

/* Two panels: u and theta along the profile, which runs upwards, the exact ones dashed and grey on them. */
void gm_flows_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                            enum gm_place place, const struct gm_profile *line, double (*velocity)(double y),
                            double (*theta)(double y));
/* Rows of CSV. */
void gm_flows_write_profile(const struct gm_view *view, const char *front, const struct gm_profile *profile,
                            FILE *stream);
void gm_flows_write_sample(const struct gm_view *view, const char *front, const char *name, double x,
                           double z, double reference, FILE *stream);

#endif
