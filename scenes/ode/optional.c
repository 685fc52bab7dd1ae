/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of the observables on request. */
#include "scenes/ode/asked.h"

#include "scenes/ode/system/ring.h"

#define MODIFIED(power, powers)                                                                              \
    {                                                                                                        \
        .key = "modified_energy" #power "_error", .unit = "", .evaluate = gm_modified_error_##power,         \
        .title = "error of the modified energy, up to Δt" powers, .logarithmic = true,                       \
        .why = gm_modified_why                                                                               \
    }
#define INDICATOR(name, function, reason, words)                                                             \
    {                                                                                                        \
        .key = name, .title = words, .unit = "", .evaluate = function, .why = reason                         \
    }

const struct gm_observable gm_ode_asked[GM_ODE_ASKED + GM_RING_OBSERVABLES] = {
    MODIFIED(2, "²"),
    MODIFIED(4, "⁴"),
    MODIFIED(6, "⁶"),
    INDICATOR("lyapunov", gm_lyapunov, gm_growth_why, "largest Lyapunov exponent"),
    INDICATOR("lyapunov_change", gm_lyapunov_change, gm_growth_why,
              "change of the exponent over the last half"),
    INDICATOR("megno", gm_megno, gm_growth_why, "mean MEGNO"),
    INDICATOR("megno_change", gm_megno_change, gm_growth_why, "change of MEGNO over the last half"),
    {.key = "return_time",
     .title = "time until the section is passed again",
     .unit = "",
     .evaluate = gm_return_time,
     .recalls = true,
     .why = gm_return_why},
    INDICATOR("escape_time", gm_escape_time, gm_escape_why, "time until the orbit has left"),
    INDICATOR("projection", gm_projection, gm_projection_why,
              "length of the last move back to the invariants"),
    INDICATOR("relaxation", gm_relaxation, gm_relaxation_why, "length of the last step beside Δt, −1"),
    INDICATOR("volume_error", gm_volume_error, gm_volume_why, "error of the volume against exp(∫ div f dt)"),
    INDICATOR("log_volume", gm_log_volume, gm_volume_why, "ln of the volume that the steps make of 1"),
    INDICATOR("loop_action", gm_ring_action, gm_ring_why, "sum of ∮ p dq along the ring of members"),
    INDICATOR("loop_action_error", gm_ring_action_error, gm_ring_error_why,
              "relative error of the loop's action"),
    INDICATOR("loop_resolution", gm_ring_resolution, gm_ring_why,
              "share of short waves in the loop's action"),
};
