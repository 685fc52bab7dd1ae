/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exponential Runge-Kutta methods for y' = L y + N(y) on a ring, L exactly: it multiplies a wave of one number
   by a small matrix. With e = exp(h L), E = exp(h L/2), phi_k = phi_k(h L) as in core/linear/complex_matrix.h,
   and psi = phi_1(h L/2)/2:
       exponential Euler    y1 = e y0 + h phi_1 N(y0)
       Lawson 4             a = E y0 + h/2 E N(y0),   b = E y0 + h/2 N(a),   c = e y0 + h E N(b)
                            y1 = e y0 + h/6 [e N(y0) + 2 E N(a) + 2 E N(b) + N(c)]
       ETD RK4              a = E y0 + h psi N(y0),   b = E y0 + h psi N(a)
                            c = e y0 + h psi [(E - 1) N(y0) + 2 N(b)]
                            y1 = e y0 + h [(phi_1 - 3 phi_2 + 4 phi_3) N(y0) + (2 phi_2 - 4 phi_3) (N(a) + N(b))
                                           + (4 phi_3 - phi_2) N(c)]
   J.D. Lawson, SIAM J. Numer. Anal. 4 (1967) 372; S.M. Cox & P.C. Matthews, J. Comput. Phys. 176 (2002) 430;
   M. Hochbruck & A. Ostermann, Acta Numerica 19 (2010) 209. */
#include <complex.h>

#include "core/linear/complex_matrix.h"
#include "core/linear/fourier.h"
#include "core/ode/families/family.h"

enum { STAGES = 4, LARGEST = GM_COMPLEX_LARGEST, SIZE = LARGEST * LARGEST };

/* A stage, or the end, is F y0 + h sum_j M_j N_j: of a mode the matrices F, M_0 .. M_(stages - 1). They are sums of
   multiples of the unit matrix and of phi_k of z = h L, WHOLE + k, and of z/2, HALF + k. */
enum { PER_STAGE = STAGES + 1 };
enum { UNIT, WHOLE, HALF = WHOLE + GM_PHI_MOST, MATRICES = HALF + GM_PHI_MOST };
struct exponential {
    size_t stages; /* evaluations of N */
    const struct term {
        double factor; /* 0: the end of the list */
        size_t of, row, column;
    } * terms;
};

static const struct term euler_terms[] = {{1, WHOLE, 0, 0}, {1, WHOLE + 1, 0, 1}, {.factor = 0}};
static const struct term lawson_terms[] = {
    {1, HALF, 0, 0},      {0.5, HALF, 0, 1},    {1, HALF, 1, 0},      {0.5, UNIT, 1, 2},
    {1, WHOLE, 2, 0},     {1, HALF, 2, 3},      {1, WHOLE, 3, 0},     {1. / 6, WHOLE, 3, 1},
    {1. / 3, HALF, 3, 2}, {1. / 3, HALF, 3, 3}, {1. / 6, UNIT, 3, 4}, {.factor = 0},
};
/* psi (E - 1) = phi_1(h L) - phi_1(h L/2), as E phi_1(h L/2) = 2 phi_1(h L) - phi_1(h L/2) */
static const struct term etd_terms[] = {
    {1, HALF, 0, 0},       {0.5, HALF + 1, 0, 1}, {1, HALF, 1, 0},       {0.5, HALF + 1, 1, 2},
    {1, WHOLE, 2, 0},      {1, WHOLE + 1, 2, 1},  {-1, HALF + 1, 2, 1},  {1, HALF + 1, 2, 3},
    {1, WHOLE, 3, 0},      {1, WHOLE + 1, 3, 1},  {-3, WHOLE + 2, 3, 1}, {4, WHOLE + 3, 3, 1},
    {2, WHOLE + 2, 3, 2},  {-4, WHOLE + 3, 3, 2}, {2, WHOLE + 2, 3, 3},  {-4, WHOLE + 3, 3, 3},
    {-1, WHOLE + 2, 3, 4}, {4, WHOLE + 3, 3, 4},  {.factor = 0},
};

/* to += factor from, for `size` numbers */
static void add_vector(size_t size, double factor, const double complex *from, double complex *to)
{
    for (size_t i = 0; i < size; i++) {
        to[i] += factor * from[i];
    }
}

/* The workspace of a run: the matrices of every mode for one step. */
struct work {
    struct gm_modes modes;
    double dt;                /* the step of the matrices; 0: none */
    double complex *matrices; /* [mode][row][PER_STAGE][fields * fields] */
    double complex *state, *rest, *stage;
};

static void *open_work(struct gm_members *members, const struct gm_problem *problem,
                       const struct gm_scheme *scheme)
{
    const struct exponential *row = scheme->coefficients;
    const size_t n = problem->n, fields = gm_ode_of(problem)->semilinear->fields, points = n / fields;
    struct work *work = gm_arena_take(members->arena, 1, sizeof *work);
    gm_arena_keep(members->arena, &work->modes, gm_modes_close);
    gm_arena_need(members->arena, gm_modes_open(&work->modes, points, fields));
    work->matrices =
        gm_arena_take(members->arena, gm_modes_half(points) * row->stages * PER_STAGE * fields * fields,
                      sizeof *work->matrices);
    work->state = gm_arena_take(members->arena, (2 + row->stages) * n, sizeof *work->state);
    work->stage = work->state + n;
    work->rest = work->stage + n;
    return work;
}

static void make_matrices(const struct gm_task *task, struct work *work)
{
    const struct exponential *row = task->scheme->coefficients;
    const struct gm_semilinear *semilinear = gm_ode_of(task->problem)->semilinear;
    const size_t fields = work->modes.fields, size = fields * fields, each = row->stages * PER_STAGE * size;
    double complex *to = work->matrices;
    for (size_t mode = 0; mode < gm_modes_half(work->modes.points); mode++, to += each) {
        double complex z[2][SIZE], of[MATRICES * SIZE] = {0};
        semilinear->symbol(task->problem, mode, z[0]);
        for (size_t i = 0; i < size; i++) {
            of[UNIT * size + i] = i % (fields + 1) == 0;
            z[0][i] *= task->dt;
            z[1][i] = z[0][i] / 2;
        }
        gm_complex_phi(fields, z[0], GM_PHI_MOST, of + WHOLE * size);
        gm_complex_phi(fields, z[1], GM_PHI_MOST, of + HALF * size);
        memset(to, 0, each * sizeof *to);
        for (const struct term *term = row->terms; term->factor != 0; term++) {
            add_vector(size, term->factor, of + term->of * size,
                       to + (term->row * PER_STAGE + term->column) * size);
        }
    }
    work->dt = task->dt;
}

/* The waves of a row: F y0 + h sum of M_j N_j over the first `known`. */
static void combine(const struct gm_task *task, struct work *work, size_t row, size_t known)
{
    const struct exponential *method = task->scheme->coefficients;
    const size_t fields = work->modes.fields, size = fields * fields, points = work->modes.points,
                 n = fields * points;
    for (size_t mode = 0; mode < gm_modes_half(points); mode++) {
        const double complex *matrices = work->matrices + (mode * method->stages + row) * PER_STAGE * size;
        double complex sum[LARGEST] = {0}, of[LARGEST], part[LARGEST];
        for (size_t j = 0; j <= known; j++) {
            const double complex *waves = j == 0 ? work->state : work->rest + (j - 1) * n;
            for (size_t i = 0; i < fields; i++) {
                of[i] = waves[i * points + mode];
            }
            gm_complex_multiply(fields, matrices + j * size, of, part);
            add_vector(fields, j == 0 ? 1 : task->dt, part, sum);
        }
        for (size_t i = 0; i < fields; i++) {
            work->stage[i * points + mode] = sum[i];
        }
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct exponential *row = task->scheme->coefficients;
    const struct gm_semilinear *semilinear = gm_ode_of(task->problem)->semilinear;
    struct work *work = members->family;
    if (work->dt != task->dt) {
        make_matrices(task, work);
    }
    gm_modes_forward(&work->modes, members->y, work->state);
    for (size_t stage = 0; stage < row->stages; stage++) {
        semilinear->nonlinear(task->problem, members->y, members->scratch);
        gm_modes_forward(&work->modes, members->scratch, work->rest + stage * members->n);
        combine(task, work, stage, stage + 1);
        gm_modes_back(&work->modes, work->stage, members->y);
    }
    progress->evaluations += row->stages;
    return GM_OK;
}

static const struct exponential euler = {1, euler_terms}, lawson = {4, lawson_terms}, etd = {4, etd_terms};

const struct gm_family gm_family_exponential = {
    .title = "exponential Runge-Kutta",
    GM_MEMBERS(exponential, .step = step, .open = open_work, .vectors = 1),
};
