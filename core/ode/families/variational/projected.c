/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Methods for any differential equation on systems with constraints g(q) = 0, G = dg/dq: a step Phi_h of the
   motion with the multipliers of g'' = 0, and the way back onto the manifold,
       (q, p) = Phi_h(y_0),   q_1 = q + M^-1 G' mu,  g(q_1) = 0,   p_1 = p + G' nu,  G v_1 = 0
   Both constraints are kept, and the order of Phi; that Phi is symplectic or symmetric is lost: a control
   beside the schemes that are made for constraints. Hairer, Lubich & Wanner (2006), section IV.4; E. Hairer &
   G. Wanner, Solving Ordinary Differential Equations II (1996), section VII.2. */
#include <stdlib.h>

#include "core/basics.h"
#include "core/ode/families/composition.h"
#include "core/ode/families/families.h"
#include "core/ode_scheme_texts.h"
#include "core/schemes.h"

/* The coefficients are the name of the scheme whose step it is. */
static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    struct gm_substeps *step = malloc(sizeof *step + sizeof step->at[0]);
    if (!step) {
        return NULL;
    }
    step->count = 1;
    step->at[0] = (struct gm_substep){gm_scheme_find(scheme->coefficients), 1};
    return gm_composition_open(problem, step, step);
}

#define PROJECTED .family = &gm_family_projected, .needs = GM_NEEDS_CONSTRAINTS

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_projected_gauss4, .coefficients = "gauss4", PROJECTED},
    {GM_TEXTS_projected_gauss6, .coefficients = "gauss6", PROJECTED},
    {GM_TEXTS_projected_rk4, .coefficients = "rk4", PROJECTED},
};

const struct gm_family gm_family_projected = {
    .kind = &gm_kind_ode,
    .title = "projected onto constraints",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = gm_composition_loop,
    .workspace_open = workspace_open,
    .workspace_close = gm_composition_close,
};
