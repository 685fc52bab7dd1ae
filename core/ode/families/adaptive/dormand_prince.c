/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method of Dormand and Prince of order 5 with an error estimate of order 4, step size control, and dense
   output of order 4:
       k_i = f(y + h sum_{j<i} a_ij k_j),   y' = y + h sum_j a_7j k_j,   k_7 = f(y') is the next step's k_1
       r = sqrt(mean((h sum_i e_i k_i)_c^2 / (tol + tol max(|y_c|, |y'_c|))^2)),   accepted if r <= 1
       h is multiplied by min(5, max(1/5, 0.9 r^(-1/5))), by at most 1 after a rejection.
   The run's dt is the distance of its rows: their states are values of the interpolant, and the scheme's own
   steps depend neither on dt nor on the end of the run. Each member of an ensemble has its own steps.
   E. Hairer, S.P. Norsett & G. Wanner, Solving Ordinary Differential Equations I (1993), II.4 to II.6. */
#include "core/functions/functions.h"
#include "core/ode/families/family.h"
#include "core/theory/coefficients.h"

enum { STAGES = 7, ERROR = STAGES, DENSE };

/* Rows a_i; then e, the weights of order 5 less those of order 4; then d. */
static const double a[][STAGES] = {
    {0},
    {1. / 5},
    {3. / 40, 9. / 40},
    {44. / 45, -56. / 15, 32. / 9},
    {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
    {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84},
    {71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40},
    {-12715105075. / 11282082432, 0, 87487479700. / 32700410799, -10690763975. / 1880347072,
     701980252875. / 199316789632, -1453857185. / 822651844, 69997945. / 29380423},
};

/* A run fails after this number of rejected steps below round-off of t, and of own steps between two rows. */
enum { MOST_TOO_SMALL = 10, MOST_STEPS = 1000000 };

/* The memory of a member: three numbers, then five vectors of its n components. It is all 0 before the first
   step. */
enum { TIME, STEP, LENGTH, NUMBERS };

struct member {
    double *number;  /* time that its own steps reached, length of the next step, and of the last; signed */
    double *y, *k;   /* state and slope at that time */
    double *y0, *k0; /* state and slope before the last step */
    double *dense;   /* h sum_i d_i k_i of the last step; void if no row is in that step */
    size_t n;
    double tolerance;
    const struct gm_loops *loops; /* of this machine, which have the field */
};

/* The workspace is n numbers for a stage, at last the next state, then the slopes 1 .. 6 of n numbers each. */
static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return malloc(STAGES * problem->n * sizeof(double));
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return problem->m * (NUMBERS + 5 * problem->n);
}

static struct member member_of(const struct gm_task *task, size_t i)
{
    const double given = task->settings->tolerance;
    const size_t n = task->problem->n;
    double *number = task->memory_out + i * (NUMBERS + 5 * n), *v = number + NUMBERS;
    return (struct member){.number = number,
                           .y = v,
                           .k = v + n,
                           .y0 = v + 2 * n,
                           .k0 = v + 3 * n,
                           .dense = v + 4 * n,
                           .n = n,
                           .tolerance = given > 0 ? given : 1e-6,
                           .loops = gm_ode_of(task->problem)->loops[gm_isa_best()]};
}

/* Returns component c at the time t in the last step. */
static double value_at(const struct member *member, double t, size_t c)
{
    const double h = member->number[LENGTH], v = (member->number[TIME] - t) / h, u = 1 - v;
    const double y0 = member->y0[c], moved = member->y[c] - y0, bent = h * member->k0[c] - moved;
    const double bent_back = moved - h * member->k[c] - bent;
    return h == 0 ? member->y[c] : y0 + u * (moved + v * (bent + u * (bent_back + v * member->dense[c])));
}

/* Returns the norm of a difference in the scale of the member's state; the origin may be NULL. */
static double norm_of(const struct member *member, const double *vector, const double *origin)
{
    double sum = 0;
    for (size_t c = 0; c < member->n; c++) {
        const double scale = member->tolerance * (1 + fabs(member->y[c]));
        sum += gm_pow((vector[c] - (origin ? origin[c] : 0)) / scale, 2);
    }
    return sqrt(sum / (double)member->n);
}

/* Starts from the member's state in task->y: evaluates the slope there, and chooses the first step. */
static enum gm_status begin(const struct gm_task *task, struct member *member, size_t i,
                            struct gm_progress *progress)
{
    double *stage = task->workspace, *slope = stage + member->n;
    const double small = 1e-5, none = 1e-15;
    for (size_t c = 0; c < member->n; c++) {
        member->y[c] = task->y[c * task->problem->m + i];
    }
    gm_field(task->problem, member->y, member->k, 1);
    const double size = norm_of(member, member->y, NULL), rate = norm_of(member, member->k, NULL);
    const double guess = size < small || rate < small ? 1e-6 : 0.01 * size / rate;
    for (size_t c = 0; c < member->n; c++) {
        stage[c] = member->y[c] + copysign(guess, task->dt) * member->k[c];
    }
    gm_field(task->problem, stage, slope, 1);
    progress->evaluations += 2;
    const double steepest = fmax(rate, norm_of(member, slope, member->k) / guess);
    const double next = steepest > none ? gm_pow(0.01 / steepest, 0.2) : fmax(1e-6, guess / 1000);
    member->number[TIME] = task->t;
    member->number[STEP] = copysign(next > 0 ? fmin(100 * guess, next) : guess, task->dt);
    return isfinite(rate) ? GM_OK : GM_BLOW_UP;
}

/* Returns the sum of the slopes of component c with the weights of a row. */
static inline double sum_of(const struct gm_task *task, const struct member *member, int row, size_t c)
{
    const double *slopes = task->workspace;
    double sum = a[row][0] * member->k[c];
    for (int i = 1; i < row && i < STAGES; i++) {
        sum += a[row][i] * slopes[(size_t)i * member->n + c];
    }
    return sum;
}

/* Evaluates slope i of a step h; with a constant i its sums are unrolled. */
static inline void evaluate(const struct gm_task *task, const struct member *member, double h, int i)
{
    double *stage = task->workspace;
    for (size_t c = 0; c < member->n; c++) {
        stage[c] = member->y[c] + h * sum_of(task, member, i, c);
    }
    member->loops->field(task->problem, stage, stage + (size_t)i * member->n, 1);
}

/* Makes a step h into the workspace, and returns its error. */
static double try_step(const struct gm_task *task, const struct member *member, double h,
                       struct gm_progress *progress)
{
    const double *stage = task->workspace;
    double sum = 0;
    evaluate(task, member, h, 1);
    evaluate(task, member, h, 2);
    evaluate(task, member, h, 3);
    evaluate(task, member, h, 4);
    evaluate(task, member, h, 5);
    evaluate(task, member, h, 6);
    progress->evaluations += STAGES - 1;
    for (size_t c = 0; c < member->n; c++) {
        const double before = fabs(member->y[c]), after = fabs(stage[c]);
        const double error = sum_of(task, member, ERROR, c) / (1 + (after > before ? after : before));
        sum += error * error;
    }
    return fabs(h) / member->tolerance * sqrt(sum / (double)member->n);
}

/* Takes over the step h that was tried, with the sum for dense output if a row needs it. Returns false if a
   component is beyond the limit. */
static bool take_step(const struct gm_task *task, struct member *member, double h, bool has_row)
{
    const size_t n = member->n, size = n * sizeof(double);
    const double *stage = task->workspace;
    bool within = true;
    for (size_t c = 0; c < n; c++) {
        within = within && fabs(stage[c]) <= task->limit;
        member->dense[c] = has_row ? h * sum_of(task, member, DENSE, c) : 0;
    }
    memcpy(member->y0, member->y, 2 * size); /* with the slope */
    memcpy(member->y, stage, size);
    memcpy(member->k, stage + (STAGES - 1) * n, size);
    member->number[TIME] += within ? h : 0;
    member->number[LENGTH] = h;
    return within;
}

/* Makes the next step of a member, which stays at its time if none succeeds. `end` is the time of a row. */
static enum gm_status own_step(const struct gm_task *task, struct member *member, double end,
                               struct gm_progress *progress)
{
    const double t = member->number[TIME];
    double h = member->number[STEP], most = 5;
    for (int too_small = 0; too_small < MOST_TOO_SMALL && t + h != t;) {
        const double error = try_step(task, member, h, progress);
        const double factor = fmin(most, fmax(0.2, 0.9 * gm_pow(error, -0.2)));
        if (error <= 1) {
            progress->own_steps++;
            member->number[STEP] = h * factor;
            return take_step(task, member, h, (t + h - end) * h >= 0) ? GM_OK : GM_BLOW_UP;
        }
        progress->rejected++;
        too_small = fabs(h) < 1e-14 * fabs(t) ? too_small + 1 : 0;
        h *= factor;
        most = 1;
    }
    return GM_STEP_TOO_SMALL;
}

static double time_of_row(const struct gm_task *task, int64_t rows)
{
    return task->t0 + (double)(task->n + rows) * task->dt;
}

static struct gm_progress loop(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
    memcpy(task->memory_out, task->memory, memory(problem, task->scheme) * sizeof(double));
    for (size_t i = 0; i < problem->m; i++) {
        struct member member = member_of(task, i);
        const double end = time_of_row(task, progress.done), *t = &member.number[TIME];
        enum gm_status status = member.number[STEP] == 0 ? begin(task, &member, i, &progress) : GM_OK;
        for (int left = MOST_STEPS; status == GM_OK && (*t - end) * task->dt < 0; left--) {
            const double row = floor((*t - task->t0) / task->dt);
            status = left > 0 ? own_step(task, &member, end, &progress) : GM_STEP_TOO_SMALL;
            left = floor((*t - task->t0) / task->dt) > row ? MOST_STEPS : left;
        }
        for (; status != GM_OK && progress.done > 0 && (*t - time_of_row(task, progress.done)) * task->dt < 0;
             progress.done--) {
            progress.status = status;
        }
        for (size_t c = 0; status == GM_OK && c < problem->n; c++) {
            task->out[c * problem->m + i] = value_at(&member, end, c);
        }
    }
    return progress;
}

/* A member continues with its own steps after a change of dt; it begins again after any other change. */
static enum gm_status start(const struct gm_task *task)
{
    for (size_t i = 0; i < task->problem->m; i++) {
        const struct member member = member_of(task, i);
        bool same = member.number[STEP] * task->dt > 0;
        for (size_t c = 0; c < member.n; c++) {
            same = same && task->y[c * task->problem->m + i] == value_at(&member, task->t, c);
        }
        if (!same) {
            memset(member.number, 0, (NUMBERS + 5 * member.n) * sizeof(double));
        }
    }
    return GM_OK;
}

static void coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                              struct gm_coefficients *coefficients)
{
    (void)scheme;
    enum { USED = STAGES - 1 }; /* the last stage is the next step's first */
    gm_coefficients_open(arena, coefficients, GM_EQUATIONS_PLAIN, USED);
    gm_coefficients_write(coefficients, 0, a[0], STAGES, a[USED]);
}

const struct gm_family gm_family_dormand_prince = {
    .title = "Dormand-Prince",
    GM_ROWS(dormand_prince),
    .parameters = gm_settings_of_tolerance,
    .coefficients_open = coefficients_open,
    .loop = loop,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = free,
    .by_tolerance = true,
};
