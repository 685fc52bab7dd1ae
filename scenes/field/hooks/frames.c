/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An equation seen from frames of reference: the file's parameters lambda, the velocity of the frame, `at`, the node whose
   moving frame is drawn, and, of Burgers' equation, a, d and offset belong to the schemes for that equation
   (core/field/user/equation.h). */
#include "scenes/common/system/hook.h"

static bool suits(const struct gm_user_system *system)
{
    return system->kind == GM_EVOLUTION && system->n == 1;
}

const struct gm_hook gm_hook_frames = {
    .name = "frames",
    .needs = "the rate of one field",
    .suits = suits,
};
