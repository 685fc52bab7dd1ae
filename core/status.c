/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of the statuses, as run --json prints them. */
#include "core/status.h"

#include "core/basics.h"

const char *gm_status_name(enum gm_status status)
{
    static const char *const names[] = {[GM_OK] = "ok",
                                        [GM_BLOW_UP] = "blow-up",
                                        [GM_NO_CONVERGENCE] = "no-convergence",
                                        [GM_MESH_CROSSING] = "mesh-crossing",
                                        [GM_STEP_COLLAPSE] = "step-collapse",
                                        [GM_OUT_OF_MEMORY] = "out-of-memory",
                                        [GM_STEP_TOO_SMALL] = "step-too-small",
                                        [GM_EVENTS_ACCUMULATE] = "events-accumulate",
                                        [GM_SLIDING] = "sliding",
                                        [GM_NO_TANGENT] = "no-tangent"};
    return (unsigned)status < GM_COUNT(names) ? names[status] : "unknown";
}
