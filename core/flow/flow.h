/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_FLOW_H
#define GM_CORE_FLOW_FLOW_H

#include "core/form/complex.h"
#include "core/kind.h"

/* An incompressible flow on a simplicial complex and a scalar that it carries, in the discrete exterior
   calculus of Mohamed, Hirani & Samtaney (2016). Velocity u = (d psi/dy, -d psi/dx).
       psi     stream function, at the vertices
       U       = -star1 d0 psi, its circulation along dual edges
       K       = d0' star1 d0, minus the Laplacian times the cells' area
       omega   = (K psi + sheet) / star0, vorticity, at the vertices; sheet: the circulation that moving walls
                 add to a boundary cell
       F       = (d1' P - boundary midpoints) psi, the flux through dual edges, exactly free of divergence on
                 inner dual cells; P interpolates to the dual vertices
       convection of a quantity a: -d0' diag(F) A a, A the mean of an edge's ends
   Warm air rises (Boussinesq): buoyancy (T - reference) along y in the momentum equation. */

/* The condition on psi and omega at a vertex. */
enum gm_vertex_kind {
    GM_VERTEX_FREE,  /* psi unknown: the interior */
    GM_VERTEX_OPEN,  /* psi unknown on an outlet ("free") */
    GM_VERTEX_FIXED, /* psi given, on a hole's wall one unknown, omega by the formula: walls, inlets */
    GM_VERTEX_SOFT,  /* psi given, omega unknown: an outlet without tangential condition */
    GM_VERTEX_SLIP,  /* psi given, omega = 0: a wall without friction */
};

/* The points of inlets where tracers that leave return, in order, in proportion to the flux between them. */
struct gm_inflow {
    size_t count;
    double *point; /* 2 each */
    double *psi;   /* monotonic */
    int *triangle; /* on the boundary edge that begins there */
};

/* A point of a triangle. */
struct gm_flow_place {
    double x[2];
    int triangle;
};

/* A piece of the boundary through which air enters or leaves. */
struct gm_opening {
    size_t first, count; /* boundary edges, on from the first along its loop */
    size_t end;          /* the edge behind the last */
    size_t side;         /* number of its side (core/flow/boundary.h) */
    bool inlet;
    double length, before, side_length; /* lengths: itself, its side's pieces before it, all of them */
    double profile;                     /* flow of its profile before scaling; 0: no profile */
    double flow;                        /* flow in or out */
};

/* The opening around a vertex. */
enum gm_opening_kind { GM_OPEN_NOT, GM_OPEN_INLET, GM_OPEN_OUTLET };

struct gm_flow {
    struct gm_arena *arena; /* holds the flow, its complex and arrays */
    struct gm_complex *complex;
    double viscosity, diffusivity;
    double time_unit;    /* time unit of a run, in the flow's own time */
    double reynolds;     /* end of the continuation of steady states; 0: none is needed */
    double speed;        /* the largest speed of an inlet, an outlet or a lid; 0: none */
    bool scalar;         /* theta is carried */
    unsigned char *kind; /* enum gm_vertex_kind, a vertex */
    double *psi;         /* given values, 0 elsewhere */
    size_t holes;
    int *hole;           /* per vertex, the hole on whose wall it is, from 1, with one unknown psi; 0: none */
    unsigned char *open; /* enum gm_opening_kind, a vertex */
    struct gm_opening *opening;
    size_t openings;
    double inlet_length; /* total length of all inlets */
    double *sheet;
    bool *theta_fixed;
    double *theta;                          /* given values; elsewhere the start's */
    double *vorticity;                      /* of the start; NULL: none */
    double *source;                         /* source of the scalar at each vertex, per unit of time; NULL:
                                               none */
    bool heat;                              /* temperature is carried, with the scalar's diffusivity */
    double buoyancy, reference_temperature; /* g beta; T without buoyancy */
    /* The arrays of temperature, like those of theta; holder: 1 + the side that holds or heats a vertex,
       0: none; heating: the heat from walls to the cells at them, per unit of time, over density and heat
       capacity. */
    bool *temperature_fixed;
    double *temperature;
    unsigned char *temperature_holder;
    double *heating;
    /* The ranges in a room over its time: the largest given theta, and the least and largest expected
       temperature. */
    double theta_high, temperature_range[2];
    size_t tracers;
    bool smoke; /* tracers enter one after the other, with the air and at sources */
    struct gm_flow_place *smoking;
    size_t smoking_count;
    struct gm_inflow inflow;
    size_t faulty; /* the side with a fault (core/flow/boundary.h); 0: no single side */
    /* Sets the boundary values of `now` to those at the time t. Returns false if the boundary is not
       valid: a value is not finite, or flows do not balance. NULL: the boundary is constant. */
    bool (*give)(const struct gm_flow *flow, double t, struct gm_flow *now);
    const void *given_by;
    unsigned char *side_of; /* a boundary edge, as in core/flow/boundary.h; NULL if constant */
};

/* The state of a run: blocks of one number per vertex, then the flow's step that led here and the tracers.
   The values that a step used (psi_half: the stream function of its fluxes; previous values) are stored,
   so that budgets and pressure are functions of the state alone. */
enum gm_flow_block {
    GM_FLOW_PSI,
    GM_FLOW_OMEGA,
    GM_FLOW_THETA,
    GM_FLOW_PSI_HALF,
    GM_FLOW_OMEGA_USED, /* omega that the step convected and diffused */
    GM_FLOW_PSI_BEFORE,
    GM_FLOW_THETA_BEFORE,
    GM_FLOW_BLOCKS,
    /* only if heat is carried */
    GM_FLOW_TEMPERATURE = GM_FLOW_BLOCKS,
    GM_FLOW_TEMPERATURE_BEFORE,
    GM_FLOW_MOST_BLOCKS,
};

/* Numbers of a tracer: its place, its triangle, and its age in steps; a tracer that has not entered yet
   has a negative age, and its future place of entry. */
enum { GM_TRACER_X, GM_TRACER_Y, GM_TRACER_TRIANGLE, GM_TRACER_AGE, GM_TRACER_NUMBERS };

extern const struct gm_kind gm_kind_flow;

/* The flow of a problem: its parameters. */
static inline const struct gm_flow *gm_flow_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

size_t gm_flow_size(const struct gm_flow *flow);
/* The size of all blocks together, which is the offset of the step. */
size_t gm_flow_block_numbers(const struct gm_flow *flow);
const double *gm_flow_block(const struct gm_flow *flow, const double *y, enum gm_flow_block block);
/* The flow's time step that led to this state; 0 at the start and for steady states. */
double gm_flow_step(const struct gm_flow *flow, const double *y);
const double *gm_flow_tracer(const struct gm_flow *flow, const double *y, size_t tracer);

/* A flow that owns the complex, everything free and 0. Returns NULL, and closes the complex, when out of
   memory. */
struct gm_flow *gm_flow_open(struct gm_complex *complex);
void gm_flow_close(void *flow); /* for arenas too */
/* The flow with a boundary of its own, for `give`, in an arena of its own; the complex and sources still
   belong to `flow`. Returns NULL when out of memory. */
struct gm_flow *gm_flow_open_now(const struct gm_flow *flow);
/* Adds heat to a flow, nowhere held, everywhere at the reference temperature. */
void gm_flow_carry_heat(struct gm_flow *flow, double buoyancy, double reference_temperature);

/* A state that a run may start from: psi for this vorticity at the vertices, the given scalar, tracers strewn evenly.
   K psi = star0 omega inside, omega less its mean on a closed surface; without a vorticity, NULL, K psi = 0, and
   omega = 0 on soft outlets. Returns false when out of memory, or if the boundary leaves psi undetermined. */
bool gm_flow_start(const struct gm_flow *flow, const double *omega, double *y);

/* The flux through the dual of an edge. */
double gm_flow_flux(const struct gm_complex *complex, const double *psi, size_t edge);

/* (star1 d0 values) of an inner edge: what the turned gradients of its triangles sum up to along the dual
   edge. */
double gm_flow_star(const struct gm_complex *complex, const double *values, size_t edge);

/* Buoyancy along the dual of an edge: buoyancy times the integral of (T - reference) dy, exact for a T that
   is linear on the triangles, so that a layered fluid rests. */
double gm_flow_lift(const struct gm_flow *flow, const double *temperature, size_t edge);
/* Adds `scale` times the contribution of buoyancy to the circulations of dual cells, per unit of time.
   Boundary cells are closed along the boundary, except on the wall of a hole, whose sum runs along the
   dual edges around it. */
void gm_flow_add_lift(const struct gm_flow *flow, const double *temperature, double scale, double *rate);

/* All fluxes; scratch: a number for each triangle. */
void gm_flow_fluxes(const struct gm_complex *complex, const double *psi, double *scratch, double *flux);

/* (K psi) of a vertex. */
double gm_flow_row(const struct gm_complex *complex, const double *psi, size_t vertex);

/* omega at every vertex from psi, but for soft outlets, whose values stay as they are. */
void gm_flow_vorticity(const struct gm_flow *flow, const double *psi, double *omega);

/* The velocity of a triangle: u, v. */
void gm_flow_velocity(const struct gm_complex *complex, const double *psi, size_t triangle,
                      double velocity[2]);
/* The largest speed of a triangle, or of the boundary. */
double gm_flow_largest_speed(const struct gm_flow *flow, const double *psi);
/* The velocities of the vertices, u and v of each: the mean over their triangles, weighted by area. The array
   has 3 * vertices numbers; the last third is scratch. */
void gm_flow_vertex_velocities(const struct gm_complex *complex, const double *psi, double *velocities);

/* Carries the tracers of y for the time dt into those of out, with the midpoint rule and velocities
   interpolated linearly between the vertices (gm_flow_vertex_velocities). They are passive: the flow does
   not depend on them. A tracer that leaves through an outlet returns at the inflow, at a place given by
   `step` and its number. */
void gm_tracers_carry(const struct gm_flow *flow, const double *velocities, double dt, int64_t step,
                      const double *y, double *out);

/* Strews the tracers of the start y evenly, or has them wait outside, to come in one after the other. */
void gm_tracers_strew(const struct gm_flow *flow, double *y);

/* Functionals of a state y. */
double gm_flow_kinetic_energy(const struct gm_flow *flow, const double *y);
double gm_flow_enstrophy(const struct gm_flow *flow, const double *y);
/* |sum star0 omega| relative to sum star0 |omega| */
double gm_flow_circulation_error(const struct gm_flow *flow, const double *y);
/* max |d1 d0 psi| */
double gm_flow_divergence(const struct gm_flow *flow, const double *y);
double gm_flow_scalar_total(const struct gm_flow *flow, const double *y);

/* The scalar's budget over the last step; all rates per unit of the flow's own time. */
struct gm_budget {
    double rate;      /* rate of change of the total */
    double convected; /* inflow at vertices with given theta */
    double reaction;  /* source that holds theta at these vertices */
    double outflow;   /* outflow at all other boundary vertices */
    double sourced;   /* sources at vertices without given theta */
    double defect;    /* |rate - convected - reaction + outflow - sourced|, relative to the largest of them */
};
struct gm_budget gm_flow_budget(const struct gm_flow *flow, const double *y);

/* The heat, over density and heat capacity, that a side's vertices give to the air per unit of time, after
   the last step: the heat that holds the temperature there, or the given heat. The sum over all sides
   warms the room. */
double gm_flow_heat(const struct gm_flow *flow, const double *y, size_t side);
/* An estimate of the temperature difference from the heat of walls: the value for conduction over the
   room's size, less if air rises, over .4 Ra^(1/5) of the Rayleigh number of that heat, and at most twice
   the warming of the air that passes through. 0: walls give no heat. */
double gm_flow_heated(const struct gm_flow *flow);
double gm_flow_temperature_mean(const struct gm_flow *flow, const double *y);

/* The total pressure p/rho + |u|^2/2 of the triangles, of mean 0, after the last step: its differences
   over inner dual edges are summed along a spanning tree. Returns false on a torus, and when out of
   memory. */
bool gm_flow_pressure(const struct gm_flow *flow, const double *y, double *pressure);

/* The circulation around a hole, from 1, counter-clockwise: along the dual edges around its wall. */
double gm_flow_circulation(const struct gm_flow *flow, const double *y, size_t hole);

/* The force of the flow on the wall of a hole, over the density, after at least one step: the pressure at the
   middles of its edges, extrapolated from the triangles by the momentum equation on the half dual edges, and
   friction, viscosity times vorticity. The pressure is known up to a constant, which has no force on a closed wall. */
void gm_flow_force(const struct gm_flow *flow, const double *y, size_t hole, double force[2]);

/* Velocity at a point by the cubic polynomial fitted to psi at the 24 nearest vertices, with the weight
   exp(-2 (distance / largest)^2); theta likewise. gm_flow_sample returns false if the mesh is too small. */
struct gm_sample {
    double psi, u, v, theta, omega, temperature; /* the last 0 without heat */
};
bool gm_flow_sample(const struct gm_flow *flow, const double *y, double x, double z,
                    struct gm_sample *sample);
/* The pressure p/rho at a point, after the last step: the total pressure fitted to the 24 nearest
   triangles, less |u|^2/2. Returns false without a pressure. */
bool gm_flow_pressure_at(const struct gm_flow *flow, const double *y, double x, double z, double *pressure);

#endif
