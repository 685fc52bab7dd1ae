/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes for u_t + eta u u_x + mu u_xxx = 0 that step in a moving frame, and so commute with its boosts and
   scalings (frames.h). The time step is k, the nodes are h apart and move by sigma per step, which
   the boost of velocity b turns into sigma + b k;
       D0 u = (u_{j+1} - u_{j-1})/(2h),   D3 u = (u_{j+2} - 2 u_{j+1} + 2 u_{j-1} - u_{j-2})/(2 h^3)

   Leapfrog of Zabusky and Kruskal has the convection eta A u D0 u, A u the mean of u_{j-1}, u_j and u_{j+1}.
   The boost b = -eta A u carries the three to values whose mean is 0: there is no convection there, but the
   node arrives sigma + b k away, and along that way u_x counts,
       v = u^{n-1} + 2 k [(sigma/k - eta A u) D0 u - mu D3 u]
   The step from which it starts is the midpoint rule with the same right hand side.

   Evolution and projection: b = -eta w, w the mean of the value where a point that moves with the wave leaves
   the old level and of v where it arrives on the new one, at a node. There the point rests, and its step is
   that of a linear equation; the old level is known at nodes, and interpolated from six of them
   (P, the polynomial of degree 5):
       v + (mu k/2) D3 v = (P (u - (mu k/2) D3 u))(y),   y = x_j + sigma - eta w k,   w = ((P u)(y) + v_j)/2
   It is iterated to round-off, which it reaches if neighbours that move with the wave do not meet in a
   step, eta |u_x| k < 2; it has no other limit.

   Both preserve scalings, as does every scheme whose terms are all of one degree in h^-1, k^-1/3 and u^1/2.
   After A. Bihlo, X. Coiteux-Roy & P. Winternitz, J. Phys. A 48 (2015) 055201, whose schemes are of first
   order in time, and explicit; the frames as those of Razafindralandy et al. (2018), eqs. 86 to 91. */
#include "core/field/families/family.h"
#include "core/field/families/frames.h"
#include "core/field/families/two_step.h"
#include "core/field/problems/problems.h"
#include "core/linear/settled.h"

enum { REACH = 2 /* radius of D3 */, KNOWN = 6 /* nodes that P goes through */ };

/* One step from the present level: k, h, and what the nodes are displaced by. */
struct step {
    const struct gm_kdv *kdv;
    double h, k, sigma;
};

struct row {
    struct gm_two_step_row loop; /* first */
    enum gm_status (*make)(struct gm_two_step_work *work, const struct step *step,
                           struct gm_progress *progress);
};

static bool solves(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_kdv_moving_frames &&
           ((const struct row *)scheme->coefficients)->loop.single;
}

static double third(const double *u, double h)
{
    return (u[2] - 2 * u[1] + 2 * u[-1] - u[-2]) / (2 * h * h * h);
}

/* next = base + factor k u_t along the nodes */
static void add_rate(const struct step *step, size_t points, double *u, const double *base, double factor,
                     double *next)
{
    const double h = step->h, centred = factor / (2 * h);
    gm_kdv_add_terms(u, base, next, points, centred * step->sigma, centred * step->k * step->kdv->eta / 3,
                     centred * step->k * step->kdv->mu / (h * h));
}

static enum gm_status leapfrog(struct gm_two_step_work *work, const struct step *step,
                               struct gm_progress *progress)
{
    double *now = work->level[1], *middle = work->force;
    progress->evaluations++;
    if (work->first) {
        add_rate(step, work->points, now, now, 0.5, middle);
        add_rate(step, work->points, middle, now, 1, work->level[2]);
        progress->evaluations++;
        return GM_OK;
    }
    add_rate(step, work->points, now, work->level[0], 2, work->level[2]);
    return GM_OK;
}

static bool factor(struct gm_two_step_work *work, const struct step *step)
{
    if (step->k == work->factored_k && step->h == work->factored_h) {
        return true;
    }
    const double c = step->kdv->mu * step->k / (4 * step->h * step->h * step->h);
    const double weights[2 * REACH + 1] = {-c, 2 * c, 1, -2 * c, c};
    gm_ring_band_clear(&work->newton.band);
    for (size_t j = 0; j < work->points; j++) {
        for (long by = -REACH; by <= REACH; by++) {
            gm_ring_band_add(&work->newton.band, j, 0, by, 0, weights[by + REACH]);
        }
    }
    const bool factored = gm_ring_band_factor(&work->newton.band);
    work->factored_k = factored ? step->k : 0;
    work->factored_h = step->h;
    return factored;
}

/* The weights of the six nodes about a place that lies by `part` of a node beyond the third. */
static void weigh(double part, double weights[KNOWN])
{
    for (int i = 0; i < KNOWN; i++) {
        weights[i] = 1;
        for (int k = 0; k < KNOWN; k++) {
            weights[i] *= k == i ? 1 : (part + 2 - k) / (i - k);
        }
    }
}

static enum gm_status evolve_and_project(struct gm_two_step_work *work, const struct step *step,
                                         struct gm_progress *progress)
{
    enum { MOST = 100 };
    const size_t points = work->points;
    const double eta = step->kdv->eta, half = step->kdv->mu * step->k / 2;
    double *now = work->level[1], *next = work->level[2], *rest = work->right, *mean = work->guess;
    double last = INFINITY, size = 1;
    if (!factor(work, step)) {
        return GM_NO_CONVERGENCE;
    }
    gm_level_close_ring(now, points);
    for (size_t j = 0; j < points; j++) {
        rest[j] = now[j] - half * third(now + j, step->h);
        next[j] = mean[j] = now[j];
        size = fmax(size, fabs(now[j]));
    }
    gm_level_close_ring(rest, points);
    for (int i = 0; i < MOST; i++) {
        double change = 0, weights[KNOWN];
        double *arrived = work->level[0]; /* no step needs the past */
        for (size_t j = 0; j < points; j++) {
            const double place = (double)j + (step->sigma - eta * step->k * mean[j]) / step->h;
            const double turns = floor(place / (double)points);
            const double around = place - turns * (double)points, below = floor(around);
            if (!(below >= 0 && below <= (double)points)) {
                return GM_NO_CONVERGENCE;
            }
            const ptrdiff_t at = below < (double)points ? (ptrdiff_t)below - 2 : -2;
            weigh(around - below, weights);
            double sum = 0, left = 0;
            for (int m = 0; m < KNOWN; m++) {
                sum += weights[m] * rest[at + m];
                left += weights[m] * now[at + m];
            }
            arrived[j] = sum;
            mean[j] = left / 2;
        }
        gm_ring_band_solve(&work->newton.band, arrived);
        for (size_t j = 0; j < points; j++) {
            mean[j] += arrived[j] / 2;
            change = gm_larger(fabs(arrived[j] - next[j]), change);
            next[j] = arrived[j];
        }
        progress->iterations++;
        progress->solves++;
        progress->evaluations++;
        if (!isfinite(change)) {
            return GM_NO_CONVERGENCE;
        }
        if (gm_is_settled_within(change, 1e-16 * size, 1e-12 * size, &last)) {
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

static void *open_work(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    struct gm_two_step_work *work = gm_two_step_open(problem, scheme);
    if (work && solves(scheme) && !gm_ring_newton_open(&work->newton, work->points, 1, REACH)) {
        free(work);
        return NULL;
    }
    return work;
}

/* A number, 1 when the scheme has made the other level of the state, on nodes that moved as it takes them
   to. */
static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)problem, (void)scheme;
    return 1;
}

static enum gm_status start(const struct gm_task *task)
{
    const double gap = task->y[2 * task->problem->line.points];
    if (fabs(gap) != fabs(task->dt)) {
        task->memory_out[0] = 0;
    }
    return GM_OK;
}

static struct step step_of(const struct gm_problem *problem, const struct gm_scheme *scheme, double k)
{
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    const double speed = gm_frame_rests(&kdv->framed, scheme) ? 0 : kdv->framed.lambda;
    return (struct step){.kdv = kdv, .h = problem->line.dx, .k = k, .sigma = speed * k};
}

static enum gm_status make_step(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                struct gm_progress *progress)
{
    const struct step step = step_of(problem, work->scheme, dt);
    return ((const struct row *)work->scheme->coefficients)->make(work, &step, progress);
}

/* (t, x, u) -> (t, x + b t, u + b/eta)
   (t, x, u) -> (s^3 t, s x, u/s^2) */
static struct gm_event carry(const struct gm_framed *framed, const struct gm_point_symmetry *symmetry,
                             struct gm_event event)
{
    const double b = symmetry->boost, s = symmetry->scale, eta = ((const struct gm_kdv *)framed)->eta;
    return (struct gm_event){
        .t = s * s * s * event.t, .x = s * (event.x + b * event.t), .u = (event.u + b / eta) / (s * s)};
}

/* A first step of length k from values at nodes, each as a symmetry carries it; the next level is in
   level[2] of the workspace, which the caller closes. Returns NULL if the scheme has no frames or the step fails, or when
   out of memory. */
static struct gm_two_step_work *make_carried(const struct gm_problem *problem, const struct gm_scheme *scheme,
                                             double k, const struct gm_point_symmetry *symmetry,
                                             const double *y)
{
    const bool has_frames = scheme->family == &gm_family_kdv_moving_frames;
    struct gm_two_step_work *work = has_frames ? open_work(problem, scheme) : NULL;
    if (!work) {
        return NULL;
    }
    const double s = symmetry->scale;
    struct step step = step_of(problem, scheme, k);
    step.sigma = s * (step.sigma + symmetry->boost * k);
    step.h *= s;
    step.k *= s * s * s;
    struct gm_progress uncounted = {.status = GM_OK};
    for (size_t j = 0; j < work->points; j++) {
        work->level[1][j] = carry(gm_framed_of(problem), symmetry, (struct gm_event){.u = y[j]}).u;
    }
    work->first = true;
    if (((const struct row *)scheme->coefficients)->make(work, &step, &uncounted) != GM_OK) {
        gm_two_step_close(work);
        return NULL;
    }
    return work;
}

static const struct gm_point_symmetry identity = {.scale = 1};

static bool find(const struct gm_problem *problem, const struct gm_scheme *scheme, double k, const double *y,
                 size_t j, struct gm_point_symmetry *frame)
{
    struct gm_two_step_work *work = make_carried(problem, scheme, k, &identity, y);
    *frame = identity;
    if (work) {
        const double *u = work->level[1] + j;
        const double mean = solves(scheme) ? work->guess[j] : (u[-1] + u[0] + u[1]) / 3;
        frame->boost = -gm_kdv_of(problem)->eta * mean;
        gm_two_step_close(work);
    }
    return work != NULL;
}

/* The largest over all nodes, in units of the carried u. */
static double defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                     const struct gm_point_symmetry *symmetry, const double *y)
{
    struct gm_two_step_work *plain = make_carried(problem, scheme, k, &identity, y),
                            *carried = plain ? make_carried(problem, scheme, k, symmetry, y) : NULL;
    double largest = carried ? 0 : NAN;
    for (size_t j = 0; carried && j < plain->points; j++) {
        const struct gm_event event = {.t = k, .u = plain->level[2][j]};
        const double moved = carry(gm_framed_of(problem), symmetry, event).u;
        largest = gm_larger(fabs(carried->level[2][j] - moved), largest);
    }
    if (plain) {
        gm_two_step_close(plain);
    }
    if (carried) {
        gm_two_step_close(carried);
    }
    return largest;
}

static double seen(const struct gm_framed *framed, bool fixed, double x, double t, double u)
{
    return (void)fixed, (void)x, (void)t, u - framed->lambda / ((const struct gm_kdv *)framed)->eta;
}

const struct gm_moving_frames gm_frames_of_kdv = {carry, find, defect, seen, solves};

#define OF_KDV_MOVING_FRAMES .family = &gm_family_kdv_moving_frames, .needs = GM_NEEDS_KDV

#define ROW .loop.step = make_step, .loop.law = GM_LAW_NONE, .loop.keeps_origin = true
static const struct gm_scheme schemes[] = {
    {GM_TEXTS_zabusky_kruskal_invariant, OF_KDV_MOVING_FRAMES,
     .coefficients = &(const struct row){ROW, .make = leapfrog}},
    {GM_TEXTS_evolution_projection, OF_KDV_MOVING_FRAMES,
     .coefficients = &(const struct row){ROW, .make = evolve_and_project, .loop.single = true}},
};

const struct gm_family gm_family_kdv_moving_frames = {
    .title = "Korteweg-de Vries, invariantised",
    GM_FIELD_FAMILY,
    .loop = gm_two_step_advance,
    .memory = memory,
    .start = start,
    .workspace_open = open_work,
    .workspace_close = gm_two_step_close,
};
