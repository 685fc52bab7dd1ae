/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The discrete multisymplectic laws that core/field/multisymplectic.h states, summed over cells and nodes. */
#include "core/field/multisymplectic.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/linear/differences.h"

/* a0' G b1 - b0' G a1 with the upper triangle of a skew matrix or the whole of it for G. With the triangle
   and both at one place this is a' matrix b. */
static double form(size_t d, const double *matrix, bool whole, const double *a0, const double *a1,
                   const double *b0, const double *b1)
{
    double sum = 0;
    for (size_t i = 0; i < d; i++) {
        for (size_t k = whole ? 0 : i + 1; k < d; k++) {
            const double entry = matrix[i * d + k];
            if (entry != 0) {
                sum += entry * (a0[i] * b1[k] - b0[i] * a1[k]);
            }
        }
    }
    return sum;
}

static double form_at(size_t d, const double *matrix, const double *a, const double *b)
{
    return form(d, matrix, false, a, a, b, b);
}

struct measurement {
    struct gm_law *law;
    void (*measure)(const struct gm_law *law, void *data);
    void *data;
};

static void measure(struct gm_arena *arena, void *data)
{
    const struct measurement *self = data;
    struct gm_law *law = self->law;
    const struct gm_family *family = law->scheme->family;
    law->arena = arena;
    law->work =
        gm_arena_keep(arena, family->workspace_open(law->problem, law->scheme), family->workspace_close);
    self->measure(law, self->data);
}

bool gm_law_measure(struct gm_law *law, void (*body)(const struct gm_law *law, void *data), void *data)
{
    struct measurement self = {law, body, data};
    return gm_arena_run_once(measure, &self);
}

bool gm_law_step(const struct gm_law *law, int64_t steps, const double *y, const double *memory, double *out,
                 double *memory_out)
{
    const struct gm_task task = {
        .problem = law->problem,
        .scheme = law->scheme,
        .dt = law->dt,
        .steps = steps,
        .limit = INFINITY,
        .y = y,
        .out = out,
        .memory = memory,
        .memory_out = memory_out,
        .workspace = law->work,
    };
    return law->scheme->family->loop(&task).status == GM_OK;
}

struct flow {
    const struct gm_law *law;
    size_t state, memory; /* sizes of each */
};

/* The image of a map: a state, followed by the memory, to both a step later. */
static bool one_step(const void *context, const double *from, double *to)
{
    const struct flow *flow = context;
    const bool remembers = flow->memory > 0;
    return gm_law_step(flow->law, 1, from, remembers ? from + flow->state : NULL, to,
                       remembers ? to + flow->state : NULL);
}

void gm_law_differentiate(const struct gm_law *law, const double *y, const double *memory,
                          const double *direction, double *slope)
{
    const struct flow flow = {law, law->problem->n,
                              memory ? law->scheme->family->memory(law->problem, law->scheme) : 0};
    const size_t size = flow.state + flow.memory;
    double *from = gm_arena_take(law->arena, size, sizeof *from);
    memcpy(from, y, flow.state * sizeof *from);
    if (memory) {
        memcpy(from + flow.state, memory, flow.memory * sizeof *from);
    }
    if (!gm_differentiate(&(const struct gm_map){one_step, &flow, size, size}, from, direction, slope)) {
        gm_arena_leave(law->arena);
    }
}

void gm_law_differentiate_levels(const struct gm_law *law, size_t count, const double *const from[],
                                 const double *const along[], double *const to[])
{
    const size_t n = law->problem->n, points = law->problem->line.points, all = n + 2 * points;
    const size_t first[] = {0, points, n, n + points};
    double *start = gm_arena_take(law->arena, 3 * all, sizeof *start), *direction = start + all,
           *slope = direction + all;
    for (size_t k = 0; k < count; k++) {
        memcpy(start + first[k], from[k], points * sizeof *start);
        memcpy(direction + first[k], along[k], points * sizeof *start);
    }
    if (n == gm_wave_size(points)) {
        start[2 * points] = -law->dt;
    }
    gm_law_differentiate(law, start, count > 2 ? start + n : NULL, direction, slope);
    for (size_t k = 0; k < count; k++) {
        if (to[k]) {
            memcpy(to[k], slope + first[k], points * sizeof *slope);
        }
    }
}

static struct gm_faces faces_of(const struct gm_law *law, const struct gm_lattice *cells)
{
    const size_t d = gm_field_of(law->problem)->form->dimension;
    const size_t face = cells->points * cells->r * d, sides = (cells->points + 1) * cells->s * d;
    double *lower = gm_arena_take(law->arena, 2 * face + sides, sizeof *lower);
    return (struct gm_faces){lower, lower + face, lower + 2 * face};
}

double gm_lattice_law(const struct gm_law *law, const struct gm_lattice *cells,
                      void (*advance)(const struct gm_law *law, struct gm_faces faces[2]))
{
    const struct gm_form *field = gm_field_of(law->problem)->form;
    const size_t d = field->dimension;
    struct gm_faces faces[2] = {faces_of(law, cells), faces_of(law, cells)};
    const struct gm_faces *a = &faces[0], *b = &faces[1];
    double largest = 0;
    advance(law, faces);
    for (size_t i = 0; i < cells->points; i++) {
        double residual = 0;
        for (size_t m = 0; m < cells->r; m++) {
            const size_t at = (i * cells->r + m) * d;
            residual += cells->space[m] / cells->dt *
                        (form_at(d, field->m, a->upper + at, b->upper + at) -
                         form_at(d, field->m, a->lower + at, b->lower + at));
        }
        for (size_t j = 0; j < cells->s; j++) {
            const size_t left = (i * cells->s + j) * d, right = left + cells->s * d;
            residual += cells->time[j] / cells->dx *
                        (form_at(d, field->k, a->sides + right, b->sides + right) -
                         form_at(d, field->k, a->sides + left, b->sides + left));
        }
        largest = gm_larger(fabs(residual), largest);
    }
    return largest;
}

double gm_nodes_law(const struct gm_law *law, bool centred, gm_complete_node *complete, const void *a,
                    const void *b)
{
    const struct gm_form *field = gm_field_of(law->problem)->form;
    const size_t d = field->dimension, points = law->problem->line.points;
    const double dx = law->problem->line.dx, dt = law->dt;
    const double over_t = 1 / (centred ? 2 * dt : dt), over_x = 1 / (centred ? 2 * dx : dx);
    /* both tangents at a node and the next; the flux in space after a node is the one before the next */
    double sides[2][2][3 * GM_LARGEST_FORM] = {{{0}}};
    double largest = 0, before = 0;
    complete(a, points - 1, sides[0][0]);
    complete(b, points - 1, sides[0][1]);
    for (size_t i = 0; i <= points; i++) {
        double(*const left)[3 * GM_LARGEST_FORM] = sides[i % 2];
        double(*const here)[3 * GM_LARGEST_FORM] = sides[(i + 1) % 2];
        complete(a, i < points ? i : 0, here[0]);
        complete(b, i < points ? i : 0, here[1]);
        const double behind = form(d, field->k, centred, left[0] + d, here[0] + d, left[1] + d, here[1] + d);
        if (i > 0) {
            const double earlier = form(d, field->m, centred, left[0], left[0] + d, left[1], left[1] + d);
            const double later =
                form(d, field->m, centred, left[0] + d, left[0] + 2 * d, left[1] + d, left[1] + 2 * d);
            const double residual = fabs(over_t * (later - earlier) + over_x * (behind - before));
            largest = gm_larger(residual, largest);
        }
        before = behind;
    }
    return largest;
}

static void find_residual(const struct gm_law *law, void *residual)
{
    *(double *)residual = law->scheme->family->form(law);
}

double gm_form_residual(struct gm_law law)
{
    double residual = NAN;
    return law.scheme->family->form && gm_law_measure(&law, find_residual, &residual) ? residual : NAN;
}

void gm_tangent_start(double *tangent, size_t points, double waves, double phase)
{
    for (size_t i = 0; i < points; i++) {
        tangent[i] = gm_cos(2 * M_PI * waves * (double)i / (double)points + phase);
    }
}
