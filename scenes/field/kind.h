/* SPDX-License-Identifier: GPL-3.0-or-later */
/* User-defined fields: their kinds, as rows of properties, and what the files of this folder share. */
#ifndef GM_SCENES_FIELD_KIND_H
#define GM_SCENES_FIELD_KIND_H

#include "core/field/user/equation.h"
#include "core/field/user/form.h"
#include "core/mesh/user/potential.h"
#include "core/ode/user/evolution.h"
#include "scenes/common/graph.h"
#include "scenes/common/system/look.h"

/* The choice drawn over space and time: the field, or a law, number GM_SHOW_FIELD + 1 + enum gm_local_law. */
enum { GM_SHOW_FIELD };

/* The look of a lane's field. */
struct gm_field_look {
    double (*value)(const struct gm_view *view, size_t node);
    double (*exact)(const struct gm_view *view, double x); /* NULL: not drawn */
    const char *name;                                      /* the name of the value, for axes: "u" */
    double low, high;                                      /* the least range of values that is shown */
    enum gm_colour_map map;
    double reach;        /* half of the line's part that is drawn, of profiles at rest */
    int show;            /* the content of the surfaces: GM_SHOW_FIELD or a law */
    const char *content; /* the name of the third law: "mass" */
};

enum { GM_MOST_FIELD_GRAPHS = 3 };

/* A kind of field. */
struct gm_field_kind {
    const struct gm_parameter *rows; /* the points of the grid, then keys of this kind */
    size_t row_count;
    const char *no_walls; /* the reason that the boundary cannot be walls; NULL: it can */
    const char *const *schemes;
    const struct gm_observable *observables;
    size_t observable_count;
    const struct gm_observable *errors; /* against an exact solution */
    size_t error_count;
    unsigned equation; /* facet of the schemes that are for this equation alone; 0: the kind has others */
    const char *
        graphs[2][GM_MOST_FIELD_GRAPHS]; /* graphs over time, without and with an exact solution; conserved */
    size_t graph_count;                  /* quantities of the file fill the rest */
    bool (*open)(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values);
    /* Returns true if the start is possible; else false with a sentence. NULL: it is if it is finite. */
    bool (*closes)(const struct gm_problem *problem, struct gm_fault *fault);
    /* The same of a lane's other parameters; NULL: all are. */
    bool (*admits)(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence);
    void (*start)(const struct gm_problem *problem, double *y); /* NULL: two levels of a wave */
    void (*draw)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    int frame_shown; /* the choice that shows the moving frame; 0: the kind has none */
    bool by_matrices, complex_valued, moves;     /* moves: on a moving mesh */
    double (*shift)(const struct gm_view *view); /* how far the nodes have moved; NULL: not at all */
    /* Draws the field; NULL: as a surface over space and time, and profiles. With it the line has two ends. */
    void (*paint)(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                  const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count);
    double (*value)(const struct gm_view *view,
                    size_t node); /* what the picture shows, and its exact value */
    double (*exact)(const struct gm_view *view, double x);
    const char *name, *content; /* of the value (NULL: of the first field), and of the third local law */
    const struct gm_preference *preferences;
    void (*failure)(const struct gm_view *view, char *text, size_t size); /* NULL: gm_field_failure */
    /* Returns values, then slopes, of one field after another, as the observed quantity needs them: `place`
       has them for the state. malloc'ed; NULL when out of memory. Without the function it has the state. */
    double *(*profile)(const struct gm_view *view);
    /* Sets the variables of a density at integration point `number`, from 0 on, and its weight; false after
       the last. NULL: the problem integrates. */
    bool (*place)(const struct gm_view *view, size_t number, double *values, double *weight);
};

/* Waves, the same on a moving mesh, nodes alone, rates, equations by matrices (kinds.c); equations that are recognised (equations.c). */
extern const struct gm_field_kind gm_field_waves, gm_field_moving_waves, gm_field_nodes, gm_field_evolutions,
    gm_field_forms;
extern const struct gm_field_kind gm_field_korteweg, gm_field_schroedinger, gm_field_heat, gm_field_burgers;

struct gm_user_field {
    struct gm_system_scene of_file; /* first, so that a pointer to the scene is one to this */
    const struct gm_field_kind *kind;
    struct gm_user_wave wave; /* only the member of the kind is used */
    struct gm_user_evolution evolution;
    struct gm_user_form form;
    struct gm_user_equation equation;
    bool written_elsewhere; /* the file's own schemes are not for the usual kind of such a field */
    bool solved;            /* an exact solution is known */
    double resolutions[3], errors[3];
    double low, high; /* the range of u at the start */
};

static inline const struct gm_user_field *gm_user_field_of(const struct gm_system_lane *lane)
{
    return (const struct gm_user_field *)lane->owner; /* the system's scene is its first member */
}

static inline const struct gm_user_field *gm_viewed_field(const struct gm_view *view)
{
    return gm_user_field_of(view->parameters);
}

/* Returns the time at the start of a lane. */
static inline double gm_field_t0(const void *parameters)
{
    const struct gm_user_system *system = &((const struct gm_system_lane *)parameters)->owner->system;
    return system->variables[system->n].value;
}

/* Returns the line, which all problems of such files have. */
static inline const struct gm_user_line *gm_field_line(const struct gm_view *view)
{
    return view->problem->parameters;
}

/* Returns the ring, or the grid between walls. */
struct gm_grid1 gm_field_grid(const struct gm_system_lane *lane);

/* Rows of a kind's keys, and of its tables. */
#define GM_FIELD_LANE struct gm_system_lane
#define GM_FIELD_POINTS(least)                                                                               \
    GM_INTEGER_ROW(GM_FIELD_LANE, grid.points, "points", "", least, 1e7, "of the grid", .logarithmic = true)
#define GM_FIELD_ROWS(list) .rows = list, .row_count = GM_COUNT(list)
#define GM_FIELD_OBSERVABLES(list) .observables = list, .observable_count = GM_COUNT(list)
#define GM_FIELD_ERRORS(list) .errors = list, .error_count = GM_COUNT(list)

/* Observables (observables.c). */

/* Why there is no residual of a law. */
#define GM_NO_LAW "the scheme has no such law, or the step from here is not solved"

/* The largest residuals of the local laws over the grid (enum gm_local_law), and that of the discrete multisymplectic law
   (core/field/multisymplectic.h). */
double gm_view_energy_residual(const struct gm_view *view);
double gm_view_momentum_residual(const struct gm_view *view);
double gm_view_content_residual(const struct gm_view *view);
double gm_field_form_residual(const struct gm_view *view);
/* clang-format off */
#define GM_LOCAL_LAWS                                                                                        \
    GM_LOG_OBSERVABLE("local_energy_residual", gm_view_energy_residual, "residual of the local energy law",  \
                      .missing = GM_NO_LAW),                                                                 \
    GM_LOG_OBSERVABLE("local_momentum_residual", gm_view_momentum_residual,                                  \
                      "residual of the local momentum law", .missing = GM_NO_LAW)
#define GM_FORM_RESIDUAL                                                                                     \
    GM_LOG_OBSERVABLE("multisymplectic_residual", gm_field_form_residual,                                    \
                      "residual of the multisymplectic law", .missing = GM_NO_LAW)
/* clang-format on */
/* The row that chooses between the field and a law; `list` has "field", "energy-law", "momentum-law" and possibly the law
   of mass or charge. */
#define GM_LAW_ROW(list)                                                                                     \
    GM_CHOICE_ROW(GM_FIELD_LANE, grid.show, "show", "field", list,                                           \
                  "what is drawn over space and time: the field, or what each step leaves of a local law")
/* The surface over space and time. */
extern const struct gm_track gm_surface_track;

/* Returns the part of a ring's integral that is seen: between walls its other half is the mirror image. */
static inline double gm_field_seen(const struct gm_view *view, double of_ring)
{
    return view->problem->line.walls ? of_ring / 2 : of_ring;
}
/* Returns the energy that belongs to a scheme for waves in a potential. */
double gm_view_own_energy(const struct gm_view *view);
/* Returns the largest |u|. */
double gm_view_amplitude(const struct gm_view *view);

/* Returns true if the exact solution holds at the view's time by the file's line exact-while. */
bool gm_field_holds(const struct gm_view *view);
/* The same, and at the start, which is exact on a ring. */
bool gm_field_is_known(const struct gm_view *view);
/* Returns the exact value of the first field; NaN if it is not known. */
double gm_field_exact(const struct gm_view *view, double x);
/* Returns the free constant of a potential, by which it may differ from the exact solution; else 0. */
double gm_field_constant(const struct gm_view *view, size_t component);
/* Returns the largest error of all components; of a complex field that of its value. */
double gm_field_solution_error(const struct gm_view *view);
extern const struct gm_observable gm_usual_errors[1];
/* Returns the largest stable step by linear theory; NaN if the scheme has no limit. Writes that a step is longer. */
double gm_field_longest_step(const struct gm_view *view);
void gm_field_failure(const struct gm_view *view, char *text, size_t size);
/* Returns the line of the observed quantity, and its number among the file's invariants and observables. */
const struct gm_system_item *gm_field_density(const struct gm_view *view, size_t *number);
/* Returns the integral of the observed density, and of its magnitude; the scale that the file names for its error. */
double gm_field_integral(const struct gm_view *view);
double gm_field_terms(const struct gm_view *view);
double gm_field_scale(const struct gm_view *view);

/* Problem and start of a lane (start.c), as the hooks of struct gm_scene. */

bool gm_field_setup(const void *parameters, struct gm_problem *problem, char *sentence);
void gm_field_start(const void *parameters, const struct gm_problem *problem, double *y);
bool gm_field_start_mesh(const void *parameters, const struct gm_problem *problem,
                         const struct gm_scheme *scheme, double *y, char *sentence);
/* Returns false for a key that a scheme on a moving mesh does not use. */
bool gm_field_takes(const struct gm_scheme *scheme, const char *key);
void gm_field_note_mesh(const struct gm_problem *problem, void *parameters);
size_t gm_field_point(const void *parameters, double x, double u, struct gm_choice *choices);
/* Returns the start on a grid: the ring's, or a fine one if the mesh moves. malloc'ed; NULL when out of
   memory. */
double *gm_field_start_on(const struct gm_system_lane *lane, const struct gm_problem *problem,
                          struct gm_grid1 *grid);

/* Pictures (picture.c). */

void gm_field_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
void gm_field_draw_mesh(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
