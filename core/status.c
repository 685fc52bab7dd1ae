/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of the statuses, as run --json prints them. */
#include "core/status.h"

const char *gm_status_name(enum gm_status status)
{
    switch (status) {
    case GM_OK:
        return "ok";
    case GM_BLOW_UP:
        return "blow-up";
    case GM_NO_CONVERGENCE:
        return "no-convergence";
    case GM_MESH_CROSSING:
        return "mesh-crossing";
    case GM_STEP_COLLAPSE:
        return "step-collapse";
    case GM_OUT_OF_MEMORY:
        return "out-of-memory";
    case GM_STEP_TOO_SMALL:
        return "step-too-small";
    case GM_EVENTS_ACCUMULATE:
        return "events-accumulate";
    }
    return "unknown";
}
