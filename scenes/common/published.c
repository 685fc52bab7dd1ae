/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statements of documents on their figures, as numbers. Bounds are the document's own if it gives a number. A
   word means the same throughout, and its bound is a part of a named size: a number "grows" if its largest
   value in the second half of the time is at least a tenth above that in the first, else it is "bounded";
   "round-off" is at most 1e-13; "close", "the same" and "very similar" are within 5 % of the solution's size,
   or of the number compared with; "much smaller" is at most a tenth; at most 1 % is not seen; "about" is up
   to twice as much. */
#include "scenes/common/published.h"

#include <math.h>
#include <string.h>

#include "scenes/common/rows.h"

#define AT_MOST(number) .low = -INFINITY, .high = (number)
#define AT_LEAST(number) .low = (number), .high = INFINITY
#define BETWEEN(least, most) .low = (least), .high = (most)
#define GROWS .measure = GM_GROWTH, AT_LEAST(1.1)
#define BOUNDED .measure = GM_GROWTH, AT_MOST(1.1)
#define ROUND_OFF .measure = GM_MAXIMUM, AT_MOST(1e-13)
#define BELOW_MACHINE_PRECISION .measure = GM_MAXIMUM, AT_MOST(0x1p-52)
/* Parts of a size */
#define CLOSE 0.05
#define SEEN 0.01
#define MUCH_SMALLER AT_MOST(0.1)
#define VERY_SIMILAR BETWEEN(1 - CLOSE, 1 + CLOSE)
#define ABOUT(number) AT_MOST(2 * (number))
#define AT_TIME(time) BETWEEN(0.99 * (time), 1.01 * (time))
#define OF_ORDER(order) .measure = GM_AT_END, AT_LEAST((order)-0.05)
#define STATEMENTS(...)                                                                                      \
    .statements = (const struct gm_statement[]){__VA_ARGS__},                                                \
    .count = sizeof((const struct gm_statement[]){__VA_ARGS__}) / sizeof(struct gm_statement)

static const struct gm_figure_scale circle = {"the circle's radius", .size = 1};
static const struct gm_figure_scale breather = {"the breather's height", .size = 4 * M_PI / 3};
static const struct gm_figure_scale soliton = {"the soliton's height, 2π", .size = 2 * M_PI};
static const struct gm_figure_scale front = {"the front's amplitude", .size = 1};
static const struct gm_figure_scale shock = {"the solution's size", .observable = "amplitude"};
static const struct gm_figure_scale temperatures = {"the range of θ", .size = 20};
static const struct gm_figure_scale amplitude = {"the amplitude", .size = 1};

/* Statements on Figure 24 */
#define OSCILLATES .observable = "overshoot", .measure = GM_MAXIMUM, .scale = &front, BETWEEN(SEEN, 1)
#define MOVING_FRAME                                                                                         \
    {"FTCS blows up when λ = 1, before t = 1", .lanes = "scheme=ftcs lambda=1", .measure = GM_LASTS,         \
     AT_MOST(0.99)},                                                                                         \
        {"Lax-Wendroff oscillates when λ = 1", .lanes = "scheme=lax-wendroff lambda=1", OSCILLATES},         \
        {"so does Crank-Nicolson", .lanes = "scheme=crank-nicolson lambda=1", OSCILLATES},                   \
    {                                                                                                        \
        "the error of Crank-Nicolson grows with λ: at 1 it is larger than at 0.5",                           \
            .lanes = "scheme=crank-nicolson lambda=1", .against = "scheme=crank-nicolson lambda=0.5",        \
            .observable = "sup_error", .measure = GM_AT_END, AT_LEAST(1)                                     \
    }
/* Statements on Figure 25 */
#define IS_CALM .observable = "overshoot", .measure = GM_MAXIMUM, .scale = &front, AT_MOST(SEEN)
#define IS_INVARIANT                                                                                         \
    .observable = "galilean_defect", .measure = GM_MAXIMUM, .open = "offset", .scale = &front, AT_MOST(CLOSE)
#define INVARIANTISED                                                                                        \
    {"invariantised FTCS does not oscillate", .lanes = "scheme=ftcs-invariant", IS_CALM},                    \
        {"nor does invariantised Lax-Wendroff", .lanes = "scheme=lax-wendroff-invariant", IS_CALM},          \
        {"nor does invariantised Crank-Nicolson", .lanes = "scheme=crank-nicolson-invariant", IS_CALM},      \
        {"the solutions of the first two are quasi-identical when λ changes",                                \
         .lanes = "scheme=ftcs-invariant,lax-wendroff-invariant", IS_INVARIANT},                             \
    {                                                                                                        \
        "so are those of the third", .lanes = "scheme=crank-nicolson-invariant", IS_INVARIANT                \
    }

static const struct gm_document documents[] = {
    {"razafindralandy",
     "D. Razafindralandy, A. Hamdouni and M. Chhay, “A review of some geometric integrators”, Advanced Modeling "
     "and Simulation in Engineering Sciences 5:16 (2018)",
     "https://doi.org/10.1186/s40323-018-0110-y"},
    {"tyranowski",
     "T. M. Tyranowski and M. Desbrun, “R-adaptive multisymplectic and variational integrators”, Mathematics "
     "7(7), 642 (2019)",
     "https://doi.org/10.3390/math7070642"},
};

static const struct gm_published published[] = {
    {"razafindralandy-1",
     STATEMENTS({"explicit: every step multiplies the area by 1 + Δt², so 18 steps by 3.2978",
                 .lanes = "scheme=explicit-euler", .observable = "area", .measure = GM_FACTOR,
                 BETWEEN(3.2977, 3.2979)},
                {"implicit: every step divides it by 1 + Δt², so 18 steps leave 0.3032",
                 .lanes = "scheme=implicit-euler", .observable = "area", .measure = GM_FACTOR,
                 BETWEEN(0.3032, 0.3033)})},
    {"razafindralandy-2",
     STATEMENTS({"explicit: even with Δt = 0.02 the error is 10 % at t = 5",
                 .lanes = "scheme=explicit-euler dt=0.02", .observable = "energy_error", .measure = GM_AT_END,
                 BETWEEN(0.09, 0.11)},
                {"implicit: the same", .lanes = "scheme=implicit-euler dt=0.02", .observable = "energy_error",
                 .measure = GM_AT_END, BETWEEN(0.09, 0.11)},
                {"the error increases, with both schemes and every step", .lanes = "",
                 .observable = "energy_error", GROWS},
                {"a smaller step reduces the error: a step of 0.06 instead of 0.1", .lanes = "dt=0.06",
                 .against = "dt=0.1", .observable = "energy_error", .measure = GM_AT_END, AT_MOST(1)})},
    {"razafindralandy-3",
     .remark = "A relative error cannot grow much beyond 1, where the orbit has nothing left to lose: RK2 "
               "gets there within the time shown, and with twice the step grows no more.",
     STATEMENTS({"the energy error of RK2 has an increasing trend", .lanes = "scheme=rk2", .open = "dt until",
                 .observable = "energy_error", GROWS},
                {"so has its error on the angular momentum", .lanes = "scheme=rk2", .open = "dt until",
                 .observable = "angular_momentum_error", GROWS},
                {"increasing the order is not the solution: RK4's energy error grows as well",
                 .lanes = "scheme=rk4", .observable = "energy_error", GROWS})},
    {"razafindralandy-3-steps",
     .remark =
         "This is the document's remark on Figure 3 with shorter steps. The error of RK2 is proportional to the "
         "time, whatever the step, as long as it is small; with 100 steps per period it is not.",
     STATEMENTS(
         {"a shorter step reduces the error (divided by that with twice the step)",
          .lanes = "dt=2*pi/200,2*pi/400,2*pi/800", .against = "dt=2*pi/100,2*pi/200,2*pi/400",
          .observable = "energy_error", .measure = GM_MAXIMUM, AT_MOST(1)},
         {"the growth rate is essentially the same whatever the step (growth divided by that with half the step)",
          .lanes = "dt=2*pi/100,2*pi/200,2*pi/400", .against = "dt=2*pi/200,2*pi/400,2*pi/800", .open = "dt",
          .observable = "energy_error", .measure = GM_GROWTH, VERY_SIMILAR})},
    {"razafindralandy-4",
     STATEMENTS(
         {"symplectic Euler preserves the area to round-off", .lanes = "scheme=symplectic-euler",
          .observable = "area_error", ROUND_OFF},
         {"so does the midpoint rule", .lanes = "scheme=midpoint", .observable = "area_error", ROUND_OFF})},
    {"razafindralandy-5",
     .remark = "What the midpoint rule loses is round-off, which adds up over thousands of steps to a few "
               "times the machine precision, 2.2e-16; with compensated=yes it is at most twice that.",
     STATEMENTS({"the error of symplectic Euler is bounded", .lanes = "scheme=symplectic-euler",
                 .observable = "energy_error", BOUNDED},
                {"the error of the midpoint rule is round-off", .lanes = "scheme=midpoint",
                 .observable = "energy_error", ROUND_OFF},
                {"it is below the machine precision", .lanes = "scheme=midpoint",
                 .observable = "energy_error", BELOW_MACHINE_PRECISION})},
    {"razafindralandy-5-euler",
     .remark =
         "This is the document's remark on Figures 5 and 2 together. Until t = 5, the time that it names for "
         "Figure 2, the error of implicit Euler is 7 to 9 times as large, later more.",
     STATEMENTS({"the error of symplectic Euler is much smaller than that of explicit Euler",
                 .lanes = "scheme=symplectic-euler", .against = "scheme=explicit-euler", .open = "until",
                 .observable = "energy_error", .measure = GM_MAXIMUM, MUCH_SMALLER},
                {"and than that of implicit Euler", .lanes = "scheme=symplectic-euler",
                 .against = "scheme=implicit-euler", .open = "until", .observable = "energy_error",
                 .measure = GM_MAXIMUM, MUCH_SMALLER})},
    {"razafindralandy-6",
     STATEMENTS({"the energy error of RK4 is smaller than that of the second-order scheme",
                 .lanes = "scheme=rk4", .against = "scheme=rk2", .observable = "energy_error",
                 .measure = GM_MAXIMUM, AT_MOST(1)},
                {"so is its error on the angular momentum", .lanes = "scheme=rk4", .against = "scheme=rk2",
                 .observable = "angular_momentum_error", .measure = GM_MAXIMUM, AT_MOST(1)},
                {"the energy error of RK4 increases without limit", .lanes = "scheme=rk4",
                 .observable = "energy_error", GROWS},
                {"so does its error on the angular momentum", .lanes = "scheme=rk4",
                 .observable = "angular_momentum_error", GROWS},
                {"the energy error of the symplectic RK4 stays almost the same", .lanes = "scheme=rk4sym",
                 .observable = "energy_error", BOUNDED},
                {"it conserves the angular momentum (to round-off)", .lanes = "scheme=rk4sym",
                 .observable = "angular_momentum_error", ROUND_OFF})},
    {"razafindralandy-7",
     STATEMENTS({"the motion is periodic: the distance from the turning square stays small", .lanes = "",
                 .observable = "position_error", .measure = GM_MAXIMUM, .scale = &circle, AT_MOST(CLOSE)},
                {"the configuration remains symmetric at any time", .lanes = "",
                 .observable = "symmetry_defect", ROUND_OFF})},
    {"razafindralandy-8",
     .remark =
         "The document says that the angle is small. The centrally symmetric orbit is unstable beyond 35.12 "
         "degrees, and π/5, the angle of Figure 10, is 36: rounding errors grow until opposite vortices "
         "part, here after t = 1200, whatever the integrator.",
     STATEMENTS(
         {"the motion is quasi-periodic: opposite vortices stay opposite", .lanes = "", .open = "angle until",
          .observable = "symmetry_defect", .measure = GM_MAXIMUM, .scale = &circle, AT_MOST(CLOSE)},
         {GM_OURS "and the energy is kept", .lanes = "angle=pi/10", .observable = "energy_error", BOUNDED})},
    {"razafindralandy-9",
     .remark =
         "The document gives the step and the number of steps, not the strength, which decides how far the "
         "square turns in a step: 10 degrees with 150, 0.07 with 1. With 150 RK4 loses a tenth of the energy, "
         "and the symplectic RK4, on the circle still, is half a turn behind; with 1 nothing sets the two "
         "apart in Figure 10.",
     STATEMENTS({"RK4 reproduces the periodic motion, even over a long time", .lanes = "scheme=rk4",
                 .open = "strength", .observable = "position_error", .measure = GM_MAXIMUM, .scale = &circle,
                 AT_MOST(CLOSE)},
                {"so does the symplectic RK4", .lanes = "scheme=rk4sym", .open = "strength",
                 .observable = "position_error", .measure = GM_MAXIMUM, .scale = &circle, AT_MOST(CLOSE)})},
    {"razafindralandy-10",
     .remark =
         "With the printed start both integrators lose quasi-periodicity, with either strength, at the same time "
         "and for the same reason: the centrally symmetric orbit is unstable beyond an angle of 35.12 degrees, "
         "and rounding suffices to leave it; π/5 is 36 degrees. What sets the two apart is the angular impulse, "
         "with a strength of 150, and the section of the system reduced by the symmetry "
         "(configuration=reduced).",
     STATEMENTS({"RK4 loses quasi-periodicity: opposite vortices do not stay opposite", .lanes = "scheme=rk4",
                 .open = "strength", .observable = "symmetry_defect", .measure = GM_MAXIMUM, .scale = &circle,
                 AT_LEAST(CLOSE)},
                {"the symplectic RK4 reproduces it: they do", .lanes = "scheme=rk4sym", .open = "strength",
                 .observable = "symmetry_defect", .measure = GM_MAXIMUM, .scale = &circle, AT_MOST(CLOSE)},
                {GM_OURS "RK4 loses more than 1 % of the angular impulse", .lanes = "scheme=rk4",
                 .open = "strength", .observable = "angular_impulse_error", .measure = GM_MAXIMUM,
                 AT_LEAST(SEEN)},
                {GM_OURS "the symplectic RK4 keeps it to 1e-8", .lanes = "scheme=rk4sym", .open = "strength",
                 .observable = "angular_impulse_error", .measure = GM_MAXIMUM, AT_MOST(1e-8)})},
    {"razafindralandy-11",
     STATEMENTS({"where Δt = Δx the leapfrog scheme loses stability before t = 30: the error passes a "
                 "quarter of the breather's height",
                 .lanes = "scheme=leapfrog", .observable = "solution_error", .measure = GM_EXCEEDS,
                 .scale = &breather, .level = 0.25, AT_MOST(30)},
                {"the multisymplectic scheme remains stable: close to the exact breather",
                 .lanes = "scheme=box", .observable = "solution_error", .measure = GM_MAXIMUM,
                 .scale = &breather, AT_MOST(CLOSE)})},
    {"razafindralandy-12", .quick = "points=200 dt=0.2",
     STATEMENTS(
         {"the energy-conserving scheme remains stable until t = 500", .lanes = "scheme=energy-conserving",
          .measure = GM_LASTS, AT_LEAST(499.99)},
         {"so does the multisymplectic scheme", .lanes = "scheme=box", .measure = GM_LASTS, AT_LEAST(499.99)},
         {GM_OURS "neither grows beyond the breather's height by more than 5 %", .lanes = "",
          .observable = "amplitude", .measure = GM_MAXIMUM, .scale = &breather, AT_MOST(1 + CLOSE)})},
    {"razafindralandy-13",
     STATEMENTS(
         {"the energy-conserving scheme fails with twice the time step: it blows up from the first "
          "iterations (within 20)",
          .lanes = "scheme=energy-conserving", .measure = GM_LASTS, AT_MOST(20 * 0.1)},
         {"the multisymplectic scheme is relatively well behaved with twice the time step: its energy is "
          "kept within 1 %",
          .lanes = "scheme=box", .observable = "energy_error", .measure = GM_MAXIMUM, AT_MOST(SEEN)},
         {GM_OURS "and the breather does not grow by more than 5 %", .lanes = "scheme=box",
          .observable = "amplitude", .measure = GM_MAXIMUM, .scale = &breather, AT_MOST(1 + CLOSE)})},
    {"razafindralandy-16",
     .remark =
         "As printed, the equations have no solution for the next time beyond the first turning point: the "
         "step grows without bound there. With a restart at each such point the run continues, but its "
         "phase drifts, the less the shorter the first step, τ₀.",
     STATEMENTS({"the scheme as printed goes on over a period at least",
                 .lanes = "scheme=variational-rectangle", .measure = GM_LASTS, AT_LEAST(2 * M_PI)},
                {"with restarts it stays very close to the sine: its phase",
                 .lanes = "scheme=variational-rectangle-restart", .open = "tau0", .observable = "phase_error",
                 .measure = GM_AT_END, .scale = &amplitude, BETWEEN(-CLOSE, CLOSE)})},
    {"razafindralandy-17", STATEMENTS({GM_OURS "with the midpoint rule the error on the energy is round-off",
                                       .lanes = "scheme=variational-midpoint", .open = "tau0",
                                       .observable = "energy_error", ROUND_OFF},
                                      {"with the rectangle rule it is not above the machine precision",
                                       .lanes = "scheme=variational-rectangle-restart",
                                       .observable = "energy_error", BELOW_MACHINE_PRECISION})},
    {"razafindralandy-24",
     .remark =
         "The document does not define a scheme in the moving frame. Here the boosted solution is computed "
         "on a grid that is fixed in the new frame, and the convective term is in conservative form; as "
         "printed, FTCS and Crank-Nicolson fail already at λ = 0 on this grid. With the document's Courant "
         "number, 1/2, the wave runs at twice the frame's velocity when λ = 1 and crosses a cell in a step: "
         "Lax-Wendroff is then beyond its limit of stability. With 0.4 it oscillates "
         "(razafindralandy-24-finer).",
     STATEMENTS(MOVING_FRAME)},
    {"razafindralandy-24-finer", .remark = "Figure 24 with a Courant number of 0.4 instead of 1/2.",
     .variant = true, STATEMENTS(MOVING_FRAME)},
    {"razafindralandy-25",
     .remark =
         "On the document's grid, Δx = 0.02, only Lax-Wendroff does not oscillate; on one that is twice "
         "as fine none does (razafindralandy-25-finer). With nodes shifted by half a cell (offset=0.5) the solutions of "
         "FTCS differ by a third of the amplitude when λ changes.",
     STATEMENTS(INVARIANTISED)},
    {"razafindralandy-25-finer", .remark = "Figure 25 with Δx = 0.01 instead of 0.02.", .variant = true,
     STATEMENTS(INVARIANTISED)},
    {"razafindralandy-26",
     .remark = "The solution is taken with the sign that makes it one: as printed, (127) does not solve the "
               "equation. The shock, of width 2ν = 0.02, is narrower than a cell.",
     STATEMENTS({"invariantised FTCS remains close to the exact solution", .lanes = "scheme=ftcs-invariant",
                 .observable = "sup_error", .measure = GM_AT_END, .scale = &shock, AT_MOST(CLOSE)},
                {"the original scheme performs poorly at the shock: its error is more than twice that",
                 .lanes = "scheme=ftcs", .against = "scheme=ftcs-invariant", .observable = "sup_error",
                 .measure = GM_AT_END, AT_LEAST(2)})},
    {"razafindralandy-30",
     .remark =
         "The document's mean edge, 0.02989, needs some 18000 triangles on this channel, not 2744, and its "
         "inlet velocity is not given; with 18144 triangles our error is 8.5e-4.",
     STATEMENTS({"the average error of the velocity at 3 L/4 is about 2.4e-4", .lanes = "",
                 .observable = "u_error", .measure = GM_AT_END, ABOUT(2.4e-4)},
                {"θ is linear there, as the exact solution is", .lanes = "", .observable = "theta_error",
                 .measure = GM_AT_END, .scale = &temperatures, AT_MOST(SEEN)})},
    {"razafindralandy-31",
     STATEMENTS({"θ has a linear profile downstream", .lanes = "", .observable = "theta_error",
                 .measure = GM_AT_END, .scale = &temperatures, AT_MOST(SEEN)})},
    {"razafindralandy-32",
     .remark =
         "The document's mesh is not given, and its pressure equation (157) carries terms that do not belong "
         "to this flow; the pressure here follows from the momentum equation edge by edge. Its error near the "
         "walls is of first order; farther than 0.2 from them it is of second order.",
     STATEMENTS(
         {"the stream function converges with order 1.84, at least", .lanes = "", .observable = "psi_error",
          .over = "mean_edge", .measure = GM_AT_END, AT_LEAST(1.84)},
         {"the temperature with order 2", .lanes = "", .observable = "theta_error", .over = "mean_edge",
          OF_ORDER(2)},
         {"the flux with order 1", .lanes = "", .observable = "flux_error", .over = "mean_edge", OF_ORDER(1)},
         {"the velocity with order 1", .lanes = "", .observable = "velocity_error", .over = "mean_edge",
          OF_ORDER(1)},
         {"the pressure with order 1.65", .lanes = "", .observable = "pressure_error", .over = "mean_edge",
          OF_ORDER(1.65)},
         {GM_OURS "it does in the middle of the channel", .lanes = "", .observable = "pressure_error_middle",
          .over = "mean_edge", OF_ORDER(1.65)})},
    {"razafindralandy-33",
     STATEMENTS(
         {"the stream function converges with order 1.37, at least", .lanes = "", .observable = "psi_error",
          .over = "mean_edge", .measure = GM_AT_END, AT_LEAST(1.37)},
         {"the temperature with order 1.95", .lanes = "", .observable = "theta_error", .over = "mean_edge",
          OF_ORDER(1.95)},
         {"the flux with order 1", .lanes = "", .observable = "flux_error", .over = "mean_edge", OF_ORDER(1)},
         {"the velocity with order 1", .lanes = "", .observable = "velocity_error", .over = "mean_edge",
          OF_ORDER(1)})},
    {"razafindralandy-34-couette",
     STATEMENTS({"the divergence stays below 2e-16 at all times", .lanes = "", .observable = "divergence",
                 .measure = GM_MAXIMUM, AT_MOST(2e-16)})},
    {"razafindralandy-34-poiseuille",
     STATEMENTS({"the divergence stays below 2e-16 at all times", .lanes = "", .observable = "divergence",
                 .measure = GM_MAXIMUM, AT_MOST(2e-16)})},
    {"razafindralandy-35", .remark = "A drawing of the room; the document gives only its proportions."},
    {"razafindralandy-36",
     .remark = "The document's counts belong to a mesh that is not given. Our family of acute meshes comes "
               "nearest with 3384 vertices and 6600 triangles.",
     STATEMENTS({"6670 triangles", .lanes = "", .open = "rows columns", .observable = "triangles",
                 .measure = GM_AT_END, BETWEEN(6670, 6670)})},
    {"razafindralandy-37",
     .remark =
         "The document shows pictures and gives no numbers. What can be checked is that no pollutant is lost "
         "or made: what is in the room is what came in less what left.",
     .quick = "rows=25 columns=32",
     STATEMENTS({GM_OURS "the budget of the pollutant closes to round-off", .lanes = "",
                 .observable = "budget_defect", .measure = GM_AT_END, AT_MOST(1e-13)},
                {"the velocity stays free of divergence", .lanes = "", .observable = "divergence",
                 .measure = GM_MAXIMUM, AT_MOST(2e-16)})},
    {"tyranowski-2", .remark = "The exact solution; nothing is integrated.",
     STATEMENTS({GM_OURS "the mesh is spread evenly along its arc, to 1e-10", .lanes = "",
                 .observable = "constraint_defect", .measure = GM_AT_END, AT_MOST(1e-10)})},
    {"tyranowski-3", .remark = "The exact solution; nothing is integrated.",
     STATEMENTS({GM_OURS "the mesh is spread evenly along its arc, to 1e-10", .lanes = "",
                 .observable = "constraint_defect", .measure = GM_AT_END, AT_MOST(1e-10)})},
    {"tyranowski-4",
     STATEMENTS({"merely 17 mesh points capture the motion: the largest error is below a tenth of its height",
                 .lanes = "", .observable = "solution_error", .measure = GM_MAXIMUM, .scale = &soliton,
                 AT_MOST(0.1)},
                {"it bounces from the right wall at 13.84: this is when it is farthest to the right",
                 .lanes = "", .observable = "position", .measure = GM_PEAKS, AT_TIME(13.84)},
                {"and from the left wall at 41.52", .lanes = "", .observable = "position", .measure = GM_DIPS,
                 AT_TIME(41.52)})},
    {"tyranowski-5",
     STATEMENTS({GM_OURS "33 points capture the motion: the largest error is below a tenth of its height",
                 .lanes = "", .observable = "solution_error", .measure = GM_MAXIMUM, .scale = &soliton,
                 AT_MOST(0.1)})},
    {"tyranowski-6",
     STATEMENTS({GM_OURS "the integration reaches t = 50", .lanes = "", .measure = GM_LASTS, AT_LEAST(49.99)},
                {"Gauss and Lobatto are of very similar accuracy (errors divided)",
                 .lanes = "scheme=control-gauss4", .against = "scheme=control-lobatto4",
                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR})},
    {"tyranowski-7",
     STATEMENTS({GM_OURS "the integration reaches t = 50", .lanes = "", .measure = GM_LASTS, AT_LEAST(49.99)},
                {"Gauss and Lobatto are of very similar accuracy (errors divided)",
                 .lanes = "scheme=control-gauss4", .against = "scheme=control-lobatto4",
                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR})},
    {"tyranowski-8", STATEMENTS({GM_OURS "the mesh stays spread evenly along the arc, to 1e-8", .lanes = "",
                                 .observable = "constraint_defect", .measure = GM_MAXIMUM, AT_MOST(1e-8)},
                                {GM_OURS "no two points come closer than 1e-3", .lanes = "",
                                 .observable = "smallest_cell", .measure = GM_AT_END, AT_LEAST(1e-3)})},
    {"tyranowski-9", STATEMENTS({"Gauss and Lobatto yield a very similar result (errors divided)",
                                 .lanes = "scheme=control-gauss4", .against = "scheme=control-lobatto4",
                                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR},
                                {GM_OURS "the mesh stays spread evenly along the arc, to 1e-8", .lanes = "",
                                 .observable = "constraint_defect", .measure = GM_MAXIMUM, AT_MOST(1e-8)},
                                {GM_OURS "no two points come closer than 1e-3", .lanes = "",
                                 .observable = "smallest_cell", .measure = GM_AT_END, AT_LEAST(1e-3)})},
    {"tyranowski-10",
     STATEMENTS({"Gauss and Lobatto are of very similar accuracy (errors divided)",
                 .lanes = "scheme=uniform-gauss4", .against = "scheme=uniform-lobatto4",
                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR},
                {GM_OURS
                 "the uniform mesh does not resolve the soliton: the largest error is more than half of "
                 "its height",
                 .lanes = "", .observable = "solution_error", .measure = GM_MAXIMUM, .scale = &soliton,
                 AT_LEAST(0.5)})},
    {"tyranowski-11", .quick = "dt=0.05",
     .remark =
         "With 15 points the control-theoretic strategy breaks down at t = 36; orders are those between 31 "
         "and 127.",
     STATEMENTS(
         {"the multiplier strategy is more accurate than the control-theoretic one (its error divided by "
          "the other's)",
          .lanes = "scheme=multiplier-lobatto4 points=31,63,127",
          .against = "scheme=control-gauss4 points=31,63,127", .observable = "solution_error",
          .measure = GM_MAXIMUM, AT_MOST(1)},
         {"the control-theoretic strategy converges with near order 2 (1.7 to 2.3)",
          .lanes = "scheme=control-gauss4 points=31,63,127", .observable = "solution_error", .over = "points",
          .measure = GM_MAXIMUM, BETWEEN(1.7, 2.3)},
         {"the multiplier strategy converges slightly slower: its order is lower, by less than a quarter",
          .lanes = "scheme=multiplier-lobatto4 points=31,63,127",
          .against = "scheme=control-gauss4 points=31,63,127", .observable = "solution_error",
          .over = "points", .measure = GM_MAXIMUM, BETWEEN(0.75, 1)})},
    {"tyranowski-11-schemes", .quick = "dt=0.05",
     .remark =
         "This is the remark on other integrators in the caption of Figure 11. With 127 points the multiplier strategy "
         "of second order ends at t = 13.83, where mesh points would meet.",
     STATEMENTS({"Lobatto is of very similar accuracy for the control-theoretic strategy (errors divided)",
                 .lanes = "scheme=control-lobatto4", .against = "scheme=control-gauss4",
                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR},
                {"and for the uniform mesh", .lanes = "scheme=uniform-lobatto4",
                 .against = "scheme=uniform-gauss4", .observable = "solution_error", .measure = GM_MAXIMUM,
                 VERY_SIMILAR},
                {"integrators of second order give very similar plots: the control-theoretic strategy",
                 .lanes = "scheme=control-gauss2", .against = "scheme=control-gauss4",
                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR},
                {"the uniform mesh", .lanes = "scheme=uniform-gauss2", .against = "scheme=uniform-gauss4",
                 .observable = "solution_error", .measure = GM_MAXIMUM, VERY_SIMILAR},
                {"the multiplier strategy", .lanes = "scheme=multiplier-lobatto2",
                 .against = "scheme=multiplier-lobatto4", .open = "points", .observable = "solution_error",
                 .measure = GM_MAXIMUM, VERY_SIMILAR})},
    {"tyranowski-11-uniform", .quick = "dt=0.05",
     .remark = "The uniform mesh of Figure 11, which the document takes to 361 points.",
     STATEMENTS(
         {"as points are added, the uniform mesh becomes quadratically convergent (between 255 and 361)",
          .lanes = "points=255,361", .observable = "solution_error", .over = "smallest_cell",
          .measure = GM_MAXIMUM, BETWEEN(1.9, 2.1)})},
    {"tyranowski-12",
     STATEMENTS(
         {"the solitons bounce off each other at t = 5: this is when the right one is farthest to the left",
          .lanes = "", .observable = "position", .measure = GM_DIPS, .to = 15, AT_TIME(5)},
         {"off the walls at 18.79", .lanes = "", .observable = "position", .measure = GM_PEAKS, .to = 27,
          AT_TIME(18.79)},
         {"and off each other again at 32.57", .lanes = "", .observable = "position", .measure = GM_DIPS,
          .from = 20, .to = 45, AT_TIME(32.57)},
         {"the multiplier solution gets ahead of the exact one", .lanes = "scheme=multiplier-lobatto4",
          .observable = "lead", .measure = GM_AT_END, AT_LEAST(0)},
         {"the control-theoretic solution lags behind", .lanes = "scheme=control-gauss4",
          .observable = "lead", .measure = GM_AT_END, AT_MOST(0)})},
    {"tyranowski-12-breakdown", .quick = "dt=0.2",
     .remark =
         "What the document says at the end of section 5.4 of these runs, without a figure. After hundreds "
         "of bounces the hour of the breakdown is a matter of chance: it depends on the order of the "
         "scheme, and Radau IIA, of the control-theoretic strategy too, does not reach 1000.",
     STATEMENTS(
         {"the multiplier strategy breaks down at about 600 (to the digit given)",
          .lanes = "scheme=multiplier-lobatto2,multiplier-lobatto4", .measure = GM_LASTS, BETWEEN(550, 650)},
         {"the control-theoretic strategy, symplectic, beyond 1000",
          .lanes = "scheme=control-gauss4,control-lobatto4", .measure = GM_LASTS, AT_LEAST(1000)},
         {"with Radau IIA as well", .lanes = "scheme=control-radau5", .measure = GM_LASTS, AT_LEAST(1000)},
         {"the control-theoretic strategy retains good mesh quality longer (its times divided by the longer of "
          "the multiplier's)",
          .lanes = "scheme=control-gauss4,control-lobatto4,control-radau5",
          .against = "scheme=multiplier-lobatto2", .measure = GM_LASTS, AT_LEAST(1)})},
    {"tyranowski-13",
     STATEMENTS({"the energy stays nearly constant, but for spikes (within 5 %)", .lanes = "",
                 .open = "until", .observable = "energy_error", .measure = GM_MAXIMUM, AT_MOST(CLOSE)},
                {"the oscillations are reduced with a higher order", .lanes = "scheme=multiplier-lobatto4",
                 .against = "scheme=multiplier-lobatto2", .observable = "energy_error", .measure = GM_MAXIMUM,
                 AT_MOST(1)})},
    {"tyranowski-14",
     STATEMENTS(
         {"the energy is more erratic than the multiplier strategy's (errors divided)",
          .lanes = "scheme=control-gauss4,control-lobatto4,control-radau5",
          .against = "scheme=multiplier-lobatto4", .observable = "energy_error", .measure = GM_MAXIMUM,
          AT_LEAST(1)},
         {"Gauss, symplectic, shows virtually the same energy as Radau IIA, which is not (errors divided)",
          .lanes = "scheme=control-gauss4", .against = "scheme=control-radau5", .open = "until",
          .observable = "energy_error", .measure = GM_MAXIMUM, VERY_SIMILAR},
         {"so does Lobatto", .lanes = "scheme=control-lobatto4", .against = "scheme=control-radau5",
          .open = "until", .observable = "energy_error", .measure = GM_MAXIMUM, VERY_SIMILAR})},
};

size_t gm_document_count(void)
{
    return GM_COUNT(documents);
}

const struct gm_document *gm_document_at(size_t index)
{
    return &documents[index];
}

size_t gm_published_count(void)
{
    return GM_COUNT(published);
}

const struct gm_published *gm_published_at(size_t index)
{
    return &published[index];
}

const struct gm_published *gm_published_find(const char *figure)
{
    for (size_t i = 0; i < gm_published_count(); i++) {
        if (strcmp(published[i].figure, figure) == 0) {
            return &published[i];
        }
    }
    return NULL;
}
