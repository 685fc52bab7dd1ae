/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The variational scheme of Razafindralandy, Hamdouni & Chhay (2018), eqs. 62 to 67, for u_tt = u_xx, on the uniform mesh
   that it can be solved on, and the further equations of a variable mesh.

   The discrete action sum dt dx (-u_t^2 + u_x^2)/2 with forward differences gives, varied in u, t and x,
       (67a)   dt [ux_j - ux_{j-1}] - [dx ut_j^n - dx ut_j^{n-1}] = 0        leapfrog
       (67b)   dx [e_j^n - e_j^{n-1}] = 0
       (67c)   dt [e_j^n - e_{j-1}^n] = 0,   e = (ut^2 + ux^2)/2
   which are 3 J equations for the 2 J + 1 unknowns t^{n+1}, x_j^{n+1}, u_j^{n+1}, of which the x_j^{n+1}
   occur in none. The hook observes the residuals of (67b) and (67c), which fail by tens of per cent cell by
   cell along exact waves, and the rank of the system. */
#include <math.h>

#include "scenes/common/system/hook.h"
#include "scenes/field/kind.h"

/* The laws are those of waves without a potential. */
static bool suits(const struct gm_user_system *system)
{
    return system->kind == GM_FIELD && gm_is_constant(&system->graph, system->energy, 0);
}

/* The terms of the printed equations at all nodes, between the level before and one step of leapfrog ahead. */
struct laws {
    double energy, momentum; /* the largest change of e at a node in time, and between neighbours */
    double change;           /* the sum of the changes in time */
    double scale, sum;       /* the largest e, and the sum */
    double step;             /* the largest entry in the column of t^{n+1} */
};

static struct laws laws_of(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t points = grid->points;
    const double dx = grid->dx, dt = view->dt, *u = view->state, *o = u + points;
    /* at the start the other level is the next one, and leapfrog leads back from it */
    const bool forward = o[points] == dt;
    struct laws laws = {0};
    double first = 0, last = 0;
    for (size_t j = 0; j < points; j++) {
        double other[2], change[2];
        for (size_t k = 0; k < 2; k++) { /* at the node and to its right */
            const size_t i = (j + k) % points;
            change[k] = u[(i + 1) % points] - 2 * u[i] + u[(i + points - 1) % points];
            other[k] = 2 * u[i] - o[i] + dt * dt / (dx * dx) * change[k];
        }
        const double next = forward ? o[j] : other[0], before = forward ? other[0] : o[j],
                     before_right = forward ? other[1] : o[(j + 1) % points];
        const double ut = (next - u[j]) / dt, ux = (u[(j + 1) % points] - u[j]) / dx,
                     ut_before = (u[j] - before) / dt, ux_before = (before_right - before) / dx;
        const double e = (ut * ut + ux * ux) / 2,
                     e_before = (ut_before * ut_before + ux_before * ux_before) / 2;
        first = j == 0 ? e : first;
        last = j == 0 ? e : last;
        laws.energy = fmax(laws.energy, fabs(e - e_before));
        laws.momentum = fmax(laws.momentum, fabs(e - last));
        laws.change += e - e_before;
        laws.scale = fmax(laws.scale, e);
        laws.sum += e;
        laws.step = fmax(laws.step, fabs(ut * (change[0] / dx)));
        last = e;
    }
    laws.momentum = fmax(laws.momentum, fabs(first - last));
    return laws;
}

static double energy_law(const struct gm_view *view)
{
    const struct laws laws = laws_of(view);
    return laws.energy / laws.scale;
}

static double energy_sum(const struct gm_view *view)
{
    const struct laws laws = laws_of(view);
    return fabs(laws.change) / laws.sum;
}

static double momentum_law(const struct gm_view *view)
{
    const struct laws laws = laws_of(view);
    return laws.momentum / laws.scale;
}

static double unknowns(const struct gm_view *view)
{
    return 2 * (double)view->problem->line.points + 1;
}

static double equations(const struct gm_view *view)
{
    return 3 * (double)view->problem->line.points;
}

/* Returns the rank of the equations' Jacobian. (67a) determines every u_j^{n+1}; the x_j^{n+1} have empty
   columns; eliminating the u_j^{n+1} from (67b) leaves the column of t^{n+1} with the entries ut_j (ux_j -
   ux_{j-1}). */
static double rank(const struct gm_view *view)
{
    return (double)view->problem->line.points + (laws_of(view).step > 1e-12);
}

static const struct gm_observable observables[] = {
    GM_KEPT_OBSERVABLE("energy_error", gm_view_own_energy, "H", "energy error"),
    GM_LOG_OBSERVABLE("energy_law_residual", energy_law, "energy law (67b) in a cell: residual"),
    GM_LOG_OBSERVABLE("energy_sum_residual", energy_sum, "energy law, summed over the cells"),
    GM_LOG_OBSERVABLE("momentum_law_residual", momentum_law, "momentum law (67c): residual"),
    GM_OBSERVABLE("unknowns", unknowns, "unknowns of a step"),
    GM_OBSERVABLE("equations", equations, "equations of a step"),
    GM_OBSERVABLE("rank", rank, "rank of their Jacobian"),
};

const struct gm_hook gm_hook_mesh_laws = {
    .name = "mesh-laws",
    .needs = "waves without a potential, V: 0",
    .suits = suits,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
};
