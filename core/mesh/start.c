/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States on a mesh: of a given field, of another mesh's state, and what is measured of them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_interp.h>

#include "core/linear/eigenvalues.h"
#include "core/mesh/nodes.h"

/* Continuation: the density 1 + f^2 (P - 1) leads from f = 0, the uniform mesh, to 1, which for arclength is alpha growing
   (Tyranowski & Desbrun 2019, section 5.2). The first step of f is one in this many; a step that is too long is halved, and
   the one after a mesh that was found is twice as long. */
enum { CONTINUATION = 50, SHORTEST = CONTINUATION * 64 };

struct bench {
    struct gm_elements stage;
    struct gm_banded matrix;
    double *change; /* 2 N + 2: N of its own, then the last good mesh */
};

static void bench_close(struct bench *bench)
{
    gm_elements_close(&bench->stage);
    gm_banded_close(&bench->matrix);
    free(bench->change);
}

static bool bench_open(struct bench *bench, const struct gm_mesh *mesh)
{
    *bench = (struct bench){.change = calloc(2 * mesh->points + 2, sizeof(double))};
    if (!gm_elements_open(&bench->stage, mesh) || !gm_banded_open(&bench->matrix, mesh->points, 1) ||
        !bench->change) {
        bench_close(bench);
        return false;
    }
    return true;
}

static void place_evenly(const struct gm_mesh *mesh, double *x)
{
    for (size_t k = 0; k <= mesh->points + 1; k++) {
        x[k] = mesh->first + mesh->length * (double)k / (double)(mesh->points + 1);
    }
}

void gm_mesh_places(const struct gm_mesh *mesh, const double *label, size_t count, double t, double *x,
                    double *rate)
{
    enum { BLOCK = 128 };
    double at[2 * BLOCK], made[2 * BLOCK];
    for (size_t from = 0, some; from < count; from += some) {
        some = count - from < BLOCK ? count - from : BLOCK;
        for (size_t i = 0; i < some; i++) {
            at[i] = label[from + i];
            at[some + i] = t;
        }
        gm_tape_values(mesh->map, at, made, some);
        memcpy(x + from, made, some * sizeof *x);
        memcpy(rate + from, made + some, some * sizeof *rate);
    }
}

void gm_mesh_known(const struct gm_mesh *mesh, enum gm_mesh_kind kind, double t, struct gm_elements *stage)
{
    if (kind == GM_MESH_UNIFORM || kind == GM_MESH_GIVEN) {
        place_evenly(mesh, stage->x);
        memset(stage->v, 0, (mesh->points + 2) * sizeof *stage->v);
    }
    if (kind == GM_MESH_GIVEN && mesh->map) {
        gm_mesh_places(mesh, stage->x + 1, mesh->points, t, stage->x + 1, stage->v + 1);
    }
}

static bool continue_to(struct bench *bench, const struct gm_mesh *mesh, gm_mesh_profile *profile,
                        const void *context)
{
    double *x = bench->stage.x, *good = bench->change + mesh->points;
    const size_t size = (mesh->points + 2) * sizeof *x;
    place_evenly(mesh, x);
    memcpy(good, x, size);
    double reached = 0, step = 1. / CONTINUATION;
    while (reached < 1 && step > 1. / SHORTEST) {
        const double next = reached + step < 1 - 1e-9 ? reached + step : 1;
        struct gm_mesh part = *mesh;
        part.even = 1 - next * next;
        if (gm_nodes_equidistribute(&bench->stage, &part, profile, context, &bench->matrix, bench->change)) {
            reached = next;
            step *= 2;
            memcpy(good, x, size);
        } else {
            step /= 2;
            memcpy(x, good, size);
        }
    }
    return reached >= 1;
}

bool gm_mesh_start(const struct gm_mesh *mesh, enum gm_mesh_kind kind, gm_mesh_profile *profile,
                   const void *context, double *state)
{
    const size_t points = mesh->points, place = gm_mesh_place(mesh), rate = (mesh->alone ? 1 : 3) * points;
    const bool drifts = kind == GM_MESH_FREE && mesh->drift;
    struct bench bench;
    if (!bench_open(&bench, mesh)) {
        return false;
    }
    struct gm_elements *stage = &bench.stage;
    bool good = true;
    if (kind == GM_MESH_UNIFORM || kind == GM_MESH_GIVEN || mesh->listed) {
        gm_mesh_known(mesh, kind, mesh->t, stage);
        memcpy(mesh->listed ? stage->x + 1 : bench.change, mesh->listed ? mesh->listed : stage->v + 1,
               points * sizeof *bench.change);
        profile(context, stage->x + 1, points, stage->y + 1, stage->u + 1, stage->v + 1);
    } else {
        good = continue_to(&bench, mesh, profile, context) &&
               (drifts || gm_nodes_set_in_motion(stage, &bench.matrix, bench.change));
    }
    if (drifts) {
        gm_tape_values(mesh->drift, stage->x + 1, bench.change, points);
    }
    for (size_t k = 0; k < points; k++) {
        if (!mesh->alone) {
            state[k] = stage->y[k + 1];
            state[2 * points + k] = stage->u[k + 1] * bench.change[k] + stage->v[k + 1];
        }
        state[place + k] = stage->x[k + 1];
        state[rate + k] = bench.change[k];
    }
    bench_close(&bench);
    return good;
}

/* The field of a state: monotone cubics between the nodes (Fritsch & Carlson 1980), its rate linear. */
struct field {
    size_t count; /* nodes, ends included */
    double *x, *y, *slope, *rate;
};

/* gm_mesh_profile */
static void field_at(const void *context, const double *x, size_t count, double *value, double *slope,
                     double *rate)
{
    const struct field *field = context;
    for (size_t i = 0; i < count; i++) {
        const size_t low = gsl_interp_bsearch(field->x, x[i], 0, field->count - 1), high = low + 1;
        const double d = field->x[high] - field->x[low], s = (x[i] - field->x[low]) / d, r = 1 - s;
        const double leave = d * field->slope[low], arrive = d * field->slope[high];
        const double rise = field->y[high] - field->y[low];
        value[i] = field->y[low] + s * s * (3 - 2 * s) * rise + s * r * (r * leave - s * arrive);
        slope[i] = (6 * s * r * rise + r * (1 - 3 * s) * leave + s * (3 * s - 2) * arrive) / d;
        rate[i] = r * field->rate[low] + s * field->rate[high];
    }
}

static void slopes(const struct gm_elements *stage, double *slope)
{
    const size_t last = stage->count;
    for (size_t k = 0; k <= last; k++) {
        if (k == 0 || k == last) {
            slope[k] = stage->slope[k == 0 ? 0 : last - 1];
            continue;
        }
        const double before = stage->slope[k - 1], after = stage->slope[k];
        const double d0 = stage->width[k - 1], d1 = stage->width[k];
        slope[k] = before * after > 0 ? 3 * (d0 + d1) / ((2 * d1 + d0) / before + (d1 + 2 * d0) / after) : 0;
    }
}

/* Returns true if the state is on a mesh of that kind; `stage` is changed. */
static bool is_of(const struct gm_mesh *mesh, enum gm_mesh_kind kind, const double *state,
                  struct gm_elements *stage)
{
    const size_t points = mesh->points;
    if (kind == GM_MESH_FREE || kind == GM_MESH_MOVING) {
        return kind == GM_MESH_FREE || gm_mesh_measure(mesh, state, GM_MEASURE_DEFECT) < 1e-7;
    }
    gm_mesh_known(mesh, kind, mesh->t, stage);
    for (size_t k = 0; k < points; k++) {
        if (!(fabs(state[points + k] - stage->x[k + 1]) <= 1e-12 * mesh->length) ||
            !(fabs(state[3 * points + k] - stage->v[k + 1]) <= 1e-12 * mesh->length)) {
            return false;
        }
    }
    return true;
}

bool gm_mesh_carry(const struct gm_mesh *mesh, enum gm_mesh_kind kind, const double *state, double *out)
{
    const size_t points = mesh->points;
    struct gm_elements stage;
    if (mesh->alone) { /* its nodes are free */
        memmove(out, state, 2 * points * sizeof *out);
        return kind == GM_MESH_FREE;
    }
    if (!gm_elements_open(&stage, mesh)) {
        return false;
    }
    if (is_of(mesh, kind, state, &stage)) {
        memmove(out, state, 4 * points * sizeof *out);
        gm_elements_close(&stage);
        return true;
    }
    gm_elements_place(&stage, state);
    double *memory = malloc(2 * (points + 2) * sizeof *memory);
    bool good = gm_elements_evaluate(&stage, mesh) && memory;
    if (good) {
        const struct field field = {points + 2, stage.x, stage.y, memory, memory + points + 2};
        slopes(&stage, field.slope);
        for (size_t k = 0; k < points + 2; k++) {
            field.rate[k] = stage.u[k] - field.slope[k] * stage.v[k];
        }
        good = gm_mesh_start(mesh, kind, field_at, &field, out);
    }
    free(memory);
    gm_elements_close(&stage);
    return good;
}

/* The energy of an element. */
static double energy(const struct gm_mesh *mesh, const struct gm_elements *stage, size_t e)
{
    const double g = stage->slope[e];
    const double kinetic = ((stage->u[e] - g * stage->v[e]) * stage->momentum_u0[e] +
                            (stage->u[e + 1] - g * stage->v[e + 1]) * stage->momentum_u1[e]) /
                           2;
    double of_cell = 0;
    if (mesh->cell) { /* d_t LC_dt + m_t LC_m - LC */
        const double *at = stage->cells + e, *of = at + GM_CELL_INPUTS * stage->count;
        of_cell =
            at[stage->count] * of[2 * stage->count] + at[2 * stage->count] * of[3 * stage->count] - of[0];
    }
    return of_cell + (kinetic + stage->rise[e] * g / 2 + stage->width[e] * stage->w[e]);
}

double gm_mesh_measure(const struct gm_mesh *mesh, const double *state, enum gm_mesh_measure measure)
{
    struct gm_elements stage;
    const bool good = gm_elements_open_at(&stage, mesh, state);
    double sum = good ? energy(mesh, &stage, 0) : NAN, momentum = 0, jump = 0, size = 0, least = INFINITY,
           narrow = stage.memory ? stage.width[0] : NAN;
    if (good && measure == GM_MEASURE_DEFECT) {
        gm_elements_constrain(&stage, mesh);
    }
    for (size_t k = 1; stage.memory && k <= mesh->points; k++) {
        narrow = fmin(narrow, stage.width[k]);
        sum += energy(mesh, &stage, k);
        momentum += gm_momentum_v(&stage, k);
        least = fmin(least, fabs(stage.slope[k] - stage.slope[k - 1]));
        jump = fmax(jump, fabs(gm_jump(stage.ell, k)));
        size = fmax(size, fmax(stage.ell[k], stage.ell[k - 1]));
    }
    gm_elements_close(&stage);
    const double values[] = {sum, momentum, jump / size, least, narrow};
    return good || measure == GM_MEASURE_NARROWEST ? values[measure] : NAN;
}

double gm_mesh_energy(const struct gm_mesh *mesh, const double *state)
{
    return gm_mesh_measure(mesh, state, GM_MEASURE_ENERGY);
}

bool gm_mesh_mass_matrix(const struct gm_mesh *mesh, const double *state, double *matrix)
{
    const size_t n = 2 * mesh->points;
    struct gm_elements stage;
    if (mesh->points > GM_DENSE_POINTS) {
        return false;
    }
    const bool good = gm_elements_open_at(&stage, mesh, state);
    memset(matrix, 0, n * n * sizeof *matrix);
    for (size_t e = 0; good && e < stage.count; e++) {
        struct gm_element_matrices at;
        gm_elements_matrices(&stage, mesh, e, false, &at);
        for (size_t i = 0; i < 16; i++) {
            const size_t a = 2 * e + i / 4, b = 2 * e + i % 4; /* 2 and 3 are of the first node that moves */
            if (a >= 2 && b >= 2 && a < n + 2 && b < n + 2) {
                matrix[(a - 2) * n + b - 2] += at.mass[i / 4][i % 4];
            }
        }
    }
    gm_elements_close(&stage);
    return good;
}

bool gm_mesh_mass(const struct gm_mesh *mesh, const double *state, double *rank, double *condition)
{
    const size_t n = mesh->points <= GM_DENSE_POINTS ? 2 * mesh->points : 0;
    double *matrix = malloc((n * n + 2 * n + 1) * sizeof *matrix), *values = matrix ? matrix + n * n : NULL;
    const bool good =
        matrix && gm_mesh_mass_matrix(mesh, state, matrix) && gm_eigenvalues(matrix, n, values, values + n);
    double least = INFINITY, largest = 0, sign = 1;
    for (size_t i = 0; good && i < n; i++) {
        largest = fmax(largest, fabs(values[i]));
        least = fmin(least, fabs(values[i]));
    }
    *rank = 0;
    for (size_t i = 0; good && i < n; i++) {
        *rank += fabs(values[i]) > 1e-12 * largest;
        sign = values[i] < -1e-12 * largest ? -1 : sign;
    }
    *condition = sign * largest / least;
    free(matrix);
    return good;
}
