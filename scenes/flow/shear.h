/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_SHEAR_H
#define GM_SCENES_FLOW_SHEAR_H

#include "scenes/flow/flows.h"
#include "scenes/frame/graph.h"

/* What couette, poiseuille and channel share. */

bool gm_shear_setup(const void *parameters, const struct gm_shear *shear, const char *name,
                    struct gm_problem *problem, char *sentence);

/* Profiles of u and theta along a line, the exact ones thin and grey beneath (NULL: none). */
void gm_shear_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                            enum gm_place place, const struct gm_profile *line, double (*velocity)(double),
                            double (*theta)(double));

/* What the convergence pictures of couette and poiseuille show, and how their work is measured. */
extern const struct gm_look_error gm_shear_errors[];
extern const struct gm_work gm_shear_work;

#define GM_SHEAR_PARAMETERS                                                                                  \
    GM_DT("0.05", 1e-7, 10), GM_UNTIL("5"),                                                                  \
        GM_REAL_ROW(struct gm_flows, reynolds, "reynolds", "1", 0.01, 1e5, "Reynolds number U H / ν",        \
                    .logarithmic = true),                                                                    \
        GM_INTEGER_ROW(struct gm_flows, rows, "rows", "24", 3, 1000, "edges at the bottom and at the top",   \
                       .logarithmic = true),                                                                 \
        GM_INTEGER_ROW(struct gm_flows, columns, "columns", "0", 0, 2000,                                    \
                       "strips of triangles along y; 0: the best", .logarithmic = true),                     \
        GM_FLOWS_IRREGULAR, GM_FLOWS_TRACERS("0"), GM_FLOWS_LOOKS("speed", "yes")

/* The observables of a shear flow, whose struct gm_shear is called `shear`. */
#define GM_SHEAR_MEASURE(name)                                                                               \
    static double name(const struct gm_view *view)                                                           \
    {                                                                                                        \
        return gm_shear_##name(&shear, view);                                                                \
    }
#define GM_SHEAR_MEASURES                                                                                    \
    GM_SHEAR_MEASURE(solution_error)                                                                         \
    GM_SHEAR_MEASURE(psi_error)                                                                              \
    GM_SHEAR_MEASURE(theta_error)                                                                            \
    GM_SHEAR_MEASURE(flux_error)                                                                             \
    GM_SHEAR_MEASURE(velocity_error)                                                                         \
    GM_SHEAR_MEASURE(pressure_error)                                                                         \
    GM_SHEAR_MEASURE(pressure_error_middle)
#define GM_SHEAR_OBSERVABLES                                                                                 \
    {.key = "solution_error",                                                                                \
     .title = "error of ψ",                                                                                  \
     .unit = "",                                                                                             \
     .evaluate = solution_error,                                                                             \
     .logarithmic = true},                                                                                   \
        {.key = "psi_error",                                                                                 \
         .title = "relative error of ψ",                                                                     \
         .unit = "",                                                                                         \
         .evaluate = psi_error,                                                                              \
         .logarithmic = true},                                                                               \
        {.key = "theta_error",                                                                               \
         .title = "relative error of θ",                                                                     \
         .unit = "",                                                                                         \
         .evaluate = theta_error,                                                                            \
         .logarithmic = true},                                                                               \
        {.key = "flux_error",                                                                                \
         .title = "relative error of the flux",                                                              \
         .unit = "",                                                                                         \
         .evaluate = flux_error,                                                                             \
         .logarithmic = true},                                                                               \
        {.key = "velocity_error",                                                                            \
         .title = "relative error of the velocity",                                                          \
         .unit = "",                                                                                         \
         .evaluate = velocity_error,                                                                         \
         .logarithmic = true},                                                                               \
        {.key = "pressure_error",                                                                            \
         .title = "relative error of the total pressure",                                                    \
         .unit = "",                                                                                         \
         .evaluate = pressure_error,                                                                         \
         .logarithmic = true},                                                                               \
        {.key = "pressure_error_middle",                                                                     \
         .title = "relative error of the total pressure away from the walls",                                \
         .unit = "",                                                                                         \
         .evaluate = pressure_error_middle,                                                                  \
         .logarithmic = true},                                                                               \
        {.key = "mean_edge", .title = "mean edge", .unit = "", .evaluate = gm_flows_mean_edge},              \
        GM_FLOWS_DIVERGENCE, GM_FLOWS_ENERGY, GM_FLOWS_CHANGE, GM_FLOWS_TRIANGLES

#endif
