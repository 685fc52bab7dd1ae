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
#include "core/field/problems/problems.h"
#include "core/linear/ring/ring.h"
#include "core/linear/settled.h"

enum {
    REACH = 2 /* radius of D3 */,
    PAD = 3,
    KNOWN = 6 /* nodes that P goes through */
};

/* Levels have PAD more points on both sides, level[-PAD] to level[points + PAD - 1]. */
struct work {
    size_t points;
    double *level[3];         /* past, present, next */
    double *rest, *mean;      /* u - (mu k/2) D3 u; w */
    struct gm_ring_band band; /* 1 + (mu k/2) D3, of rows that solve */
    double factored_k, factored_h;
};

/* One step from the levels past and present to the next: k, h, and what the nodes are displaced by. */
struct step {
    const struct gm_kdv *kdv;
    double h, k, sigma;
    bool first; /* there is no level in the past */
};

struct row {
    enum gm_status (*make)(struct work *work, const struct step *step, struct gm_progress *progress);
    bool solves;
};

static void close_ring(double *level, size_t points)
{
    for (size_t i = 0; i < PAD; i++) {
        level[(ptrdiff_t)i - PAD] = level[points - PAD + i];
        level[points + i] = level[i];
    }
}

static double third(const double *u, double h)
{
    return (u[2] - 2 * u[1] + 2 * u[-1] - u[-2]) / (2 * h * h * h);
}

GM_CLONES static void add_terms(const double *u, const double *base, double *restrict next, size_t points,
                                double drift, double convection, double dispersion)
{
    for (size_t j = 0; j < points; j++) {
        const double *here = u + j, right = here[1], left = here[-1];
        next[j] = base[j] + (drift - convection * (left + here[0] + right)) * (right - left) -
                  dispersion * (here[2] - 2 * right + 2 * left - here[-2]);
    }
}

/* next = base + factor k u_t along the nodes */
static void add_rate(const struct step *step, size_t points, const double *u, const double *base,
                     double factor, double *next)
{
    const double h = step->h, centred = factor / (2 * h);
    add_terms(u, base, next, points, centred * step->sigma, centred * step->k * step->kdv->eta / 3,
              centred * step->k * step->kdv->mu / (h * h));
    close_ring(next, points);
}

static enum gm_status leapfrog(struct work *work, const struct step *step, struct gm_progress *progress)
{
    const double *now = work->level[1];
    progress->evaluations++;
    if (step->first) {
        add_rate(step, work->points, now, now, 0.5, work->rest);
        add_rate(step, work->points, work->rest, now, 1, work->level[2]);
        progress->evaluations++;
        return GM_OK;
    }
    add_rate(step, work->points, now, work->level[0], 2, work->level[2]);
    return GM_OK;
}

static bool factor(struct work *work, const struct step *step)
{
    if (step->k == work->factored_k && step->h == work->factored_h) {
        return true;
    }
    const double c = step->kdv->mu * step->k / (4 * step->h * step->h * step->h);
    const double weights[2 * REACH + 1] = {-c, 2 * c, 1, -2 * c, c};
    gm_ring_band_clear(&work->band);
    for (size_t j = 0; j < work->points; j++) {
        for (long by = -REACH; by <= REACH; by++) {
            gm_ring_band_add(&work->band, j, 0, by, 0, weights[by + REACH]);
        }
    }
    const bool factored = gm_ring_band_factor(&work->band);
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

static enum gm_status evolve_and_project(struct work *work, const struct step *step,
                                         struct gm_progress *progress)
{
    enum { MOST = 100 };
    const size_t points = work->points;
    const double eta = step->kdv->eta, half = step->kdv->mu * step->k / 2;
    const double *now = work->level[1];
    double *next = work->level[2], *rest = work->rest, *mean = work->mean, last = INFINITY, size = 1;
    if (!factor(work, step)) {
        return GM_NO_CONVERGENCE;
    }
    for (size_t j = 0; j < points; j++) {
        rest[j] = now[j] - half * third(now + j, step->h);
        next[j] = mean[j] = now[j];
        size = fmax(size, fabs(now[j]));
    }
    close_ring(rest, points);
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
        gm_ring_band_solve(&work->band, arrived);
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
            close_ring(next, points);
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

static void close_work(void *workspace)
{
    struct work *work = workspace;
    if (work->band.right) {
        gm_ring_band_close(&work->band);
    }
    free(work);
}

static void *open_work(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    enum { ARRAYS = 5 };
    const struct row *row = scheme->coefficients;
    const size_t points = problem->line.points, length = points + 2 * PAD;
    struct work *work = calloc(1, sizeof *work + ARRAYS * length * sizeof(double));
    if (!work || (row->solves && !gm_ring_band_open(&work->band, points, 1, REACH))) {
        free(work);
        return NULL;
    }
    double **const arrays[ARRAYS] = {&work->level[0], &work->level[1], &work->level[2], &work->rest,
                                     &work->mean};
    work->points = points;
    for (size_t i = 0; i < ARRAYS; i++) {
        *arrays[i] = (double *)(work + 1) + i * length + PAD;
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

static struct gm_progress advance(const struct gm_task *task)
{
    const struct row *row = task->scheme->coefficients;
    struct work *work = task->workspace;
    const struct gm_kdv *kdv = gm_kdv_of(task->problem);
    const size_t points = work->points, size = points * sizeof(double);
    const double gap = task->y[2 * points];
    const bool known = task->memory[0] == 1, back = known && gap == task->dt && !row->solves;
    struct step step = {
        .kdv = kdv,
        .h = task->problem->line.dx,
        .k = task->dt,
        .sigma = gm_frame_rests(&kdv->framed, task->scheme) ? 0 : kdv->framed.lambda * task->dt,
        .first = !(known && gap == -task->dt),
    };
    struct gm_progress progress = {.status = GM_OK};
    memcpy(work->level[1], task->y, size);
    memcpy(work->level[0], task->y + points, size);
    close_ring(work->level[1], points);
    for (int64_t i = 0; i < task->steps; i++) {
        if (i == 0 && back) { /* along the levels it came from */
            memcpy(work->level[2], task->y + points, size);
            close_ring(work->level[2], points);
        } else {
            progress.status = row->make(work, &step, &progress);
        }
        if (!gm_field_stepped(task, &progress, work->level[2], points)) {
            return progress;
        }
        double *past = work->level[0];
        work->level[0] = work->level[1];
        work->level[1] = work->level[2];
        work->level[2] = past;
        step.first = false;
    }
    gm_wave_write(task, work->level[1], work->level[0]);
    task->memory_out[0] = 1;
    return progress;
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

static bool solves(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_kdv_moving_frames &&
           ((const struct row *)scheme->coefficients)->solves;
}

/* A first step of length k from values at nodes, each as a symmetry carries it; the next level is in
   level[2] of the workspace, which the caller closes. Returns NULL if the scheme has no frames or the step fails, or when
   out of memory. */
static struct work *make_carried(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                                 const struct gm_point_symmetry *symmetry, const double *y)
{
    const bool has_frames = scheme->family == &gm_family_kdv_moving_frames;
    struct work *work = has_frames ? open_work(problem, scheme) : NULL;
    if (!work) {
        return NULL;
    }
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    const double s = symmetry->scale,
                 sigma = gm_frame_rests(&kdv->framed, scheme) ? 0 : kdv->framed.lambda * k;
    const struct step step = {.kdv = kdv,
                              .h = s * problem->line.dx,
                              .k = s * s * s * k,
                              .sigma = s * (sigma + symmetry->boost * k),
                              .first = true};
    struct gm_progress uncounted = {.status = GM_OK};
    for (size_t j = 0; j < work->points; j++) {
        work->level[1][j] = carry(&kdv->framed, symmetry, (struct gm_event){.u = y[j]}).u;
    }
    close_ring(work->level[1], work->points);
    if (((const struct row *)scheme->coefficients)->make(work, &step, &uncounted) != GM_OK) {
        close_work(work);
        return NULL;
    }
    return work;
}

static const struct gm_point_symmetry identity = {.scale = 1};

static bool find(const struct gm_problem *problem, const struct gm_scheme *scheme, double k, const double *y,
                 size_t j, struct gm_point_symmetry *frame)
{
    struct work *work = make_carried(problem, scheme, k, &identity, y);
    *frame = identity;
    if (work) {
        const double *u = work->level[1] + j;
        const double mean = solves(scheme) ? work->mean[j] : (u[-1] + u[0] + u[1]) / 3;
        frame->boost = -gm_kdv_of(problem)->eta * mean;
        close_work(work);
    }
    return work != NULL;
}

/* The largest over all nodes, in units of the carried u. */
static double defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                     const struct gm_point_symmetry *symmetry, const double *y)
{
    struct work *plain = make_carried(problem, scheme, k, &identity, y),
                *carried = plain ? make_carried(problem, scheme, k, symmetry, y) : NULL;
    double largest = carried ? 0 : NAN;
    for (size_t j = 0; carried && j < plain->points; j++) {
        const struct gm_event event = {.t = k, .u = plain->level[2][j]};
        const double moved = carry(gm_framed_of(problem), symmetry, event).u;
        largest = gm_larger(fabs(carried->level[2][j] - moved), largest);
    }
    if (plain) {
        close_work(plain);
    }
    if (carried) {
        close_work(carried);
    }
    return largest;
}

static double seen(const struct gm_framed *framed, bool fixed, double x, double t, double u)
{
    return (void)fixed, (void)x, (void)t, u - framed->lambda / ((const struct gm_kdv *)framed)->eta;
}

const struct gm_moving_frames gm_frames_of_kdv = {carry, find, defect, seen, solves};

#define OF_KDV_MOVING_FRAMES .family = &gm_family_kdv_moving_frames, .needs = GM_NEEDS_KDV

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_zabusky_kruskal_invariant, OF_KDV_MOVING_FRAMES,
     .coefficients = &(const struct row){.make = leapfrog}},
    {GM_TEXTS_evolution_projection, OF_KDV_MOVING_FRAMES,
     .coefficients = &(const struct row){.make = evolve_and_project, .solves = true}},
};

const struct gm_family gm_family_kdv_moving_frames = {
    .title = "Korteweg-de Vries, invariantised",
    GM_FIELD_FAMILY,
    .loop = advance,
    .memory = memory,
    .start = start,
    .workspace_open = open_work,
    .workspace_close = close_work,
};
