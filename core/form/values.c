/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Steps are computed one after another, constant ones once. The derivative of a step over the unknowns is a
   product of the matrices of the steps before it. */
#include "core/form/values.h"

#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/linear/cholesky.h"
#include "core/linear/vectors.h"

static size_t size_of(const struct gm_form_values *values, size_t step)
{
    return gm_form_size(values->space->complex, values->program->steps[step].type);
}

void gm_form_values_open(struct gm_form_values *values, struct gm_arena *arena,
                         const struct gm_form_program *program, struct gm_form_space *space,
                         const struct gm_user_system *system, const double *variables)
{
    const size_t parameters = system->velocities - system->parameters;
    double *constants = gm_arena_take(arena, GM_SAMPLE_INPUTS + parameters, sizeof *constants);
    memcpy(constants + GM_SAMPLE_INPUTS, variables + system->parameters, parameters * sizeof *constants);
    *values = (struct gm_form_values){.program = program, .space = space, .time = NAN};
    values->slot = gm_arena_take(arena, program->count + 1, sizeof *values->slot);
    values->tapes = gm_arena_take(arena, program->count + 1, sizeof *values->tapes);
    values->sampled = gm_arena_take(arena, program->count + 1, sizeof *values->sampled);
    values->zero = gm_arena_take(arena, 2 * program->count + 1, sizeof *values->zero);
    values->idle = values->zero + program->count;
    for (size_t i = 0; i < program->count; i++) {
        const struct gm_form_step *step = &program->steps[i];
        if (step->kind != GM_STEP_FORM) {
            values->slot[i] = gm_arena_take(arena, size_of(values, i), sizeof(double));
        }
        if (step->kind == GM_STEP_MATRIX) {
            gm_form_space_need(space, arena, (enum gm_form_matrix)step->number);
        }
        if ((step->kind == GM_STEP_EXACT || step->kind == GM_STEP_COEXACT) && !values->hodge) {
            values->hodge = gm_hodge_open(arena, space);
        }
        if (step->kind == GM_STEP_SAMPLE) {
            const size_t count =
                step->type.degree < 0 ? 1 : gm_form_points_of(space, arena, step->type)->count;
            values->sampled[i] = gm_arena_take(arena, 3 * count, sizeof(double));
            gm_tape_keep(arena, &values->tapes[i],
                         gm_tape_open(&values->tapes[i], &system->graph, step->nodes, step->components,
                                      GM_SAMPLE_INPUTS, constants));
        }
    }
}

static void sample(const struct gm_form_values *values, size_t i, double t)
{
    const struct gm_form_step *step = &values->program->steps[i];
    double *out = values->slot[i], *found = values->sampled[i];
    if (step->type.degree < 0) {
        const double here[GM_SAMPLE_INPUTS] = {[GM_FORM_PLACES] = t};
        gm_tape_values(&values->tapes[i], here, out, 1);
        return;
    }
    const struct gm_form_points *points = values->space->points[step->type.dual][step->type.degree];
    const size_t count = points->count;
    for (size_t k = 0; k < count; k++) {
        points->point[GM_FORM_PLACES * count + k] = t;
    }
    if (step->number > 0) {
        memcpy(points->point + (GM_FORM_PLACES - 1) * count, values->arcs[step->number - 1],
               count * sizeof t);
    }
    gm_tape_values(&values->tapes[i], points->point, found, count);
    for (size_t k = 0; k < count; k += points->each) {
        double sum = 0;
        for (size_t j = k; j < k + points->each; j++) {
            if (points->weight) {
                sum += points->weight[j] * found[j];
            }
            if (!points->weight && step->components == 1) { /* a density along the edge */
                sum += found[j] * gm_hypot(gm_hypot(points->vector[j], points->vector[count + j]),
                                           points->vector[2 * count + j]);
            }
            for (size_t c = 0; !points->weight && step->components > 1 && c < step->components; c++) {
                sum += points->vector[c * count + j] * found[c * count + j];
            }
        }
        out[k / points->each] = sum;
    }
}

static void operate(const struct gm_form_values *values, size_t i)
{
    const struct gm_form_step *step = &values->program->steps[i];
    const double *a = values->slot[step->a], *b = values->slot[step->b];
    const size_t n = size_of(values, i), p = size_of(values, step->a) == n ? 1 : 0,
                 q = size_of(values, step->b) == n ? 1 : 0;
    double *out = values->slot[i];
    switch ((enum gm_operation)step->number) {
    case GM_OPERATION_ADD:
        for (size_t k = 0; k < n; k++) {
            out[k] = a[p * k] + b[q * k];
        }
        break;
    case GM_OPERATION_SUBTRACT:
        for (size_t k = 0; k < n; k++) {
            out[k] = a[p * k] - b[q * k];
        }
        break;
    case GM_OPERATION_MULTIPLY:
        for (size_t k = 0; k < n; k++) {
            out[k] = a[p * k] * b[q * k];
        }
        break;
    case GM_OPERATION_NEGATE:
        for (size_t k = 0; k < n; k++) {
            out[k] = -a[k];
        }
        break;
    default:
        for (size_t k = 0; k < n; k++) {
            out[k] = gm_operation_value((enum gm_operation)step->number, a[p * k], b[q * k]);
        }
    }
}

/* The integral of the product of two Whitney forms over each triangle. */
static void wedge(const struct gm_form_values *values, size_t i)
{
    const struct gm_complex *complex = values->space->complex;
    const struct gm_form_step *step = &values->program->steps[i];
    const double *a = values->slot[step->a], *b = values->slot[step->b];
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[3], q[3], sum = 0;
        for (size_t k = 0; k < 3; k++) {
            const int sign = complex->triangle_sign[3 * t + k], e = complex->triangle_edge[3 * t + k];
            p[k] = sign * a[e];
            q[k] = sign * b[e];
        }
        for (int k = 0; k < 3; k++) {
            const int next = (k + 1) % 3;
            sum += p[k] * q[next] - p[next] * q[k];
        }
        values->slot[i][t] = sum / 6;
    }
}

/* y = matrix x; the star of dual 1-forms is solved for where its inverse is a mass matrix. */
static void multiply(const struct gm_form_space *space, enum gm_form_matrix matrix, const double *x,
                     double *y)
{
    if (matrix == GM_MATRIX_DUAL_STAR1 && space->mass) {
        for (size_t e = 0; e < space->complex->edges; e++) {
            y[e] = space->held && space->held[e] ? 0 : -x[e];
        }
        gm_cholesky_solve(space->mass, y, y);
    } else {
        gm_matrix_apply(&space->matrix[matrix], x, y);
    }
}

static void reduce(const struct gm_form_values *values, size_t i)
{
    const struct gm_form_step *step = &values->program->steps[i];
    const double *a = values->slot[step->a];
    double result = step->kind == GM_STEP_SUM ? 0 : a[0];
    for (size_t k = 0; k < size_of(values, step->a); k++) {
        result = step->kind == GM_STEP_SUM       ? result + a[k]
                 : step->kind == GM_STEP_LARGEST ? fmax(result, a[k])
                                                 : fmin(result, a[k]);
    }
    values->slot[i][0] = result;
}

/* The squared distance of a place from a point of a triangle that is near to it, and barycentric coordinates of that
   point: its place in the plane of the triangle, with what is negative cut off. */
static double distance_to(const double corners[9], const double place[3], double weight[3])
{
    double u[3], v[3], w[3], off = 0;
    gm_subtract(corners + 3, corners, u);
    gm_subtract(corners + 6, corners, v);
    gm_subtract(place, corners, w);
    const double uu = gm_dot(u, u), uv = gm_dot(u, v), vv = gm_dot(v, v), uw = gm_dot(u, w),
                 vw = gm_dot(v, w);
    weight[1] = fmax(0, (vv * uw - uv * vw) / (uu * vv - uv * uv));
    weight[2] = fmax(0, (uu * vw - uv * uw) / (uu * vv - uv * uv));
    weight[0] = fmax(0, 1 - weight[1] - weight[2]);
    const double sum = weight[0] + weight[1] + weight[2];
    for (int k = 0; k < 3; k++) {
        weight[k] /= sum;
    }
    for (int k = 0; k < 3; k++) {
        const double gap = w[k] - weight[1] * u[k] - weight[2] * v[k];
        off += gap * gap;
    }
    return off;
}

/* The value of a 0-form at a place: linear in the nearest triangle, or constant there if it is a dual one. */
static double value_at(const struct gm_form_values *values, size_t i)
{
    const struct gm_form_step *step = &values->program->steps[i];
    const struct gm_complex *complex = values->space->complex;
    const double *a = values->slot[step->a];
    double point[3] = {0}, nearest = INFINITY, value = NAN;
    for (size_t k = 0; k < step->components; k++) {
        point[k] = values->slot[step->nodes[k]][0];
    }
    for (size_t t = 0; t < complex->triangles; t++) {
        double corners[9], weight[3];
        gm_complex_corners_in_space(complex, t, corners);
        const double off = distance_to(corners, point, weight);
        const int *v = complex->triangle + 3 * t;
        if (off < nearest) {
            nearest = off;
            value = values->program->steps[step->a].type.dual
                        ? a[t]
                        : weight[0] * a[v[0]] + weight[1] * a[v[1]] + weight[2] * a[v[2]];
        }
    }
    return value;
}

static bool is_inverse(const struct gm_form_values *values, const struct gm_form_step *step)
{
    return step->kind == GM_STEP_MATRIX && step->number == GM_MATRIX_DUAL_STAR1 && values->space->mass;
}

/* True if a step is 0 whatever the forms are, as its parts are: a constant 0, what an empty matrix makes, products with
   either. */
static bool vanishes(const struct gm_form_values *values, size_t i)
{
    const struct gm_form_step *step = &values->program->steps[i];
    const bool a = values->zero[step->a], b = values->zero[step->b];
    if (step->kind == GM_STEP_MATRIX) {
        return a || (gm_matrix_count(&values->space->matrix[step->number]) == 0 && !is_inverse(values, step));
    }
    if (step->kind == GM_STEP_OPERATE) {
        const bool product = step->number == GM_OPERATION_MULTIPLY,
                   sum = step->number == GM_OPERATION_ADD || step->number == GM_OPERATION_SUBTRACT ||
                         step->number == GM_OPERATION_NEGATE || step->number == GM_OPERATION_ABS;
        return (product && (a || b)) || (sum && a && b);
    }
    bool zero = !(step->needs & ~values->fixed) && step->kind != GM_STEP_FORM;
    for (size_t k = 0; zero && k < size_of(values, i); k++) {
        zero = values->slot[i][k] == 0;
    }
    return zero;
}

/* After the first run: finds the steps that later ones leave out. */
static void find_idle(struct gm_form_values *values)
{
    const struct gm_form_program *program = values->program;
    bool *idle = values->idle;
    for (size_t i = 0; i < program->count; i++) {
        values->zero[i] = vanishes(values, i);
        idle[i] = true; /* unless a root or a step needs it */
    }
    for (size_t k = 0; k < program->root_count; k++) {
        idle[program->roots[k]] = false;
    }
    for (size_t i = program->count; i-- > 0;) {
        const struct gm_form_step *step = &program->steps[i];
        const bool leaf = step->kind == GM_STEP_FORM || step->kind == GM_STEP_SAMPLE;
        idle[i] |= values->zero[i] || (step->kind != GM_STEP_FORM && !(step->needs & ~values->fixed));
        if (idle[i] || leaf) {
            continue;
        }
        idle[step->a] = false;
        if (step->kind == GM_STEP_OPERATE || step->kind == GM_STEP_WEDGE) {
            idle[step->b] = false;
        }
        for (size_t c = 0; step->kind == GM_STEP_AT && c < step->components; c++) {
            idle[step->nodes[c]] = false;
        }
    }
}

void gm_form_values_run(struct gm_form_values *values, double t, double *const *forms)
{
    const bool first = isnan(values->time), later = values->time != t;
    for (size_t i = 0; i < values->program->count; i++) {
        const struct gm_form_step *step = &values->program->steps[i];
        if (!first && (values->idle[i] || ((step->needs & ~values->fixed) == GM_NEEDS_TIME && !later))) {
            continue;
        }
        switch (step->kind) {
        case GM_STEP_FORM:
            values->slot[i] = forms[step->number];
            break;
        case GM_STEP_SAMPLE:
            sample(values, i, t);
            break;
        case GM_STEP_MATRIX:
            multiply(values->space, (enum gm_form_matrix)step->number, values->slot[step->a],
                     values->slot[i]);
            break;
        case GM_STEP_OPERATE:
            operate(values, i);
            break;
        case GM_STEP_WEDGE:
            wedge(values, i);
            break;
        case GM_STEP_CLOSING:
            gm_matrix_apply(&values->closings[step->number], values->slot[step->a], values->slot[i]);
            break;
        case GM_STEP_EXACT:
            gm_hodge_exact(values->hodge, values->slot[step->a], values->slot[i]);
            break;
        case GM_STEP_COEXACT:
            gm_hodge_coexact(values->hodge, values->slot[step->a], values->slot[i]);
            break;
        case GM_STEP_AROUND:
            gm_matrix_apply(&values->around[step->number], values->slot[step->a], values->slot[i]);
            break;
        case GM_STEP_AT:
            values->slot[i][0] = value_at(values, i);
            break;
        default:
            reduce(values, i);
        }
    }
    if (first) {
        find_idle(values);
    }
    values->time = t;
}

const double *gm_form_values_root(const struct gm_form_values *values, size_t root)
{
    return values->slot[values->program->roots[root]];
}

/* The derivative of an operation over one of its operands. */
static double slope_of(enum gm_operation operation, double a, double b, bool second)
{
    switch (operation) {
    case GM_OPERATION_ADD:
        return 1;
    case GM_OPERATION_SUBTRACT:
        return second ? -1 : 1;
    case GM_OPERATION_NEGATE:
        return -1;
    case GM_OPERATION_MULTIPLY:
        return second ? a : b;
    case GM_OPERATION_DIVIDE:
        return second ? -a / (b * b) : 1 / b;
    default: { /* by a central difference: near enough for an iteration */
        const double h = 0x1p-18 * fmax(1, fabs(second ? b : a)), p = second ? 0 : h, q = second ? h : 0;
        const double slope =
            (gm_operation_value(operation, a + p, b + q) - gm_operation_value(operation, a - p, b - q)) /
            (2 * h);
        return isfinite(slope) ? slope : 0;
    }
    }
}

/* The derivative of an operation on entries, over operands of as many numbers that have one; none: no matrix. */
static struct gm_matrix derivative(const struct gm_form_values *values, struct gm_arena *arena, size_t i,
                                   const struct gm_matrix *parts)
{
    const struct gm_form_step *step = &values->program->steps[i];
    const enum gm_operation operation = (enum gm_operation)step->number;
    const size_t n = size_of(values, i), operands[2] = {step->a, step->b},
                 used = gm_operation_rows[operation].arity == 1 ? 1 : 2;
    const size_t p = size_of(values, step->a) == n, q = size_of(values, step->b) == n;
    const double *a = values->slot[step->a], *b = values->slot[step->b];
    struct gm_matrix sum = {0};
    for (size_t k = 0; k < used; k++) {
        if (!parts[operands[k]].start || size_of(values, operands[k]) != n) {
            continue;
        }
        struct gm_matrix part = gm_matrix_sum(arena, 1, &parts[operands[k]], 0, NULL);
        double *slopes = gm_arena_take(arena, n, sizeof *slopes);
        for (size_t j = 0; j < n; j++) {
            slopes[j] = slope_of(operation, a[p * j], b[q * j], k == 1);
        }
        gm_matrix_scale(&part, slopes);
        sum = sum.start ? gm_matrix_sum(arena, 1, &sum, 1, &part) : part;
    }
    return sum;
}

static struct gm_matrix unit(struct gm_arena *arena, size_t n, size_t columns, size_t first)
{
    struct gm_matrix_rows rows = gm_matrix_begin(arena, n, columns, n);
    for (size_t k = 0; k < n; k++) {
        gm_matrix_add(&rows, (int)(first + k), 1);
        gm_matrix_end_row(&rows, false);
    }
    return gm_matrix_end(&rows);
}

/* The matrices of the rows m + M^-1 a = 0 of a step that solves with the mass matrix M, written M m + a = 0; numbers
   that are held are 0. */
static struct gm_matrix inverse(const struct gm_form_values *values, struct gm_arena *arena,
                                const struct gm_matrix *a, const struct gm_matrix *m)
{
    const struct gm_form_space *space = values->space;
    const struct gm_matrix whole = gm_matrix_product(arena, &space->inner, m);
    struct gm_matrix right = gm_matrix_sum(arena, 1, a, 0, NULL);
    double *free_of = gm_arena_take(arena, right.rows, sizeof *free_of);
    for (size_t e = 0; e < right.rows; e++) {
        free_of[e] = space->held && space->held[e] ? 0 : 1;
    }
    gm_matrix_scale(&right, free_of);
    return gm_matrix_sum(arena, 1, &whole, 1, &right);
}

struct gm_matrix gm_form_values_matrix(const struct gm_form_values *values, struct gm_arena *arena,
                                       const struct gm_form_layout *layout)
{
    const struct gm_form_program *program = values->program;
    struct gm_matrix *parts = gm_arena_take(arena, program->count + 1, sizeof *parts),
                     *solved = gm_arena_take(arena, program->count + 1, sizeof *solved);
    size_t columns = layout->count, inner = columns;
    for (size_t i = 0; i < program->count; i++) {
        const bool inverse_of = is_inverse(values, &program->steps[i]);
        columns += inverse_of && (program->steps[i].needs & layout->needs) ? size_of(values, i) : 0;
    }
    size_t most = columns;
    for (size_t i = 0; i < program->count; i++) {
        const struct gm_form_step *step = &program->steps[i];
        const size_t n = size_of(values, i);
        if (!(step->needs & layout->needs)) {
            continue;
        }
        if (step->kind == GM_STEP_FORM && step->needs == layout->needs) {
            parts[i] = unit(arena, n, columns, layout->offset[step->number]);
        } else if (step->kind == GM_STEP_OPERATE) {
            parts[i] = derivative(values, arena, i, parts);
        } else if (step->kind == GM_STEP_MATRIX && parts[step->a].start && is_inverse(values, step)) {
            parts[i] = unit(arena, n, columns, inner);
            solved[i] = inverse(values, arena, &parts[step->a], &parts[i]);
            inner += n;
        } else if (step->kind == GM_STEP_MATRIX && parts[step->a].start) {
            parts[i] = gm_matrix_product(arena, &values->space->matrix[step->number], &parts[step->a]);
        } else if (step->kind == GM_STEP_CLOSING && parts[step->a].start) {
            parts[i] = gm_matrix_product(arena, &values->closings[step->number], &parts[step->a]);
        }
        most += gm_matrix_count(&solved[i]);
    }
    for (size_t k = 0; k < program->root_count; k++) {
        most += gm_matrix_count(&parts[program->roots[k]]);
    }
    struct gm_matrix_entries all = gm_matrix_entries(arena, most);
    for (size_t i = 0; i < columns; i++) {
        gm_matrix_put(&all, i, i, 0);
    }
    for (size_t i = 0, row = layout->count; i < program->count; row += solved[i++].rows) {
        gm_matrix_put_block(&all, &solved[i], row, 0, 1);
    }
    for (size_t k = 0; k < program->root_count; k++) {
        gm_matrix_put_block(&all, &parts[program->roots[k]], layout->offset[layout->forms[k]], 0, 1);
    }
    return gm_matrix_of(&all, columns, columns);
}

double gm_form_square(const struct gm_form_space *space, struct gm_form_type type, const double *a,
                      double *scratch)
{
    double sum = 0;
    multiply(space, (enum gm_form_matrix)((type.dual ? GM_MATRIX_DUAL_STAR0 : GM_MATRIX_STAR0) + type.degree),
             a, scratch);
    for (size_t k = 0; k < gm_form_size(space->complex, type); k++) {
        sum += a[k] * scratch[k];
    }
    return fabs(sum);
}

void gm_form_vectors(const struct gm_form_space *space, bool dual, const double *form, double *scratch,
                     double *vectors)
{
    const struct gm_complex *complex = space->complex;
    if (dual) {
        multiply(space, GM_MATRIX_DUAL_STAR1, form, scratch);
        form = scratch;
    }
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[9], n[3], w[3] = {0, 0, 0}, *v = vectors + 3 * t;
        gm_complex_corners_in_space(complex, t, p);
        gm_triangle_normal(p, n);
        const double twice = 2 * complex->area[t];
        for (size_t k = 0; k < 3; k++) {
            const double value =
                complex->triangle_sign[3 * t + k] * form[complex->triangle_edge[3 * t + k]] / (3 * twice);
            /* n x (g_j - g_i) times twice the area is the edge from the middle of ij to the third corner, thrice */
            for (size_t c = 0; c < 3; c++) {
                w[c] += value * (p[3 * k + c] + p[3 * ((k + 1) % 3) + c] - 2 * p[3 * ((k + 2) % 3) + c]);
            }
        }
        gm_cross(n, w, v);
        for (size_t c = 0; c < 3; c++) {
            v[c] = dual ? w[c] : v[c] / twice;
        }
    }
}
