/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Discrete exterior calculus on triangles. Edge e has the vector t from its low to its high vertex, its dual the
   direction J t from the triangle on its right to the one on its left, J the rotation by 90 degrees. star star
   is -1 in degree 1. With lambda_i the barycentric coordinates, Whitney's 1-form of an edge i -> j is
       lambda_i d lambda_j - lambda_j d lambda_i;
   their mass matrix in a triangle, edges i -> j and k -> l, g the gradients, L_ab = area (1 + delta_ab)/12, is
       L_ik g_j.g_l - L_il g_j.g_k - L_jk g_i.g_l + L_jl g_i.g_k.
   Hirani, Discrete Exterior Calculus (2003); Whitney, Geometric Integration Theory (1957). */
#include "core/form/space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/linear/cholesky.h"
#include "core/linear/vectors.h"

size_t gm_form_size(const struct gm_complex *complex, struct gm_form_type type)
{
    const int simplex = type.dual ? 2 - type.degree : type.degree;
    return type.degree < 0 ? 1
           : simplex == 0  ? complex->vertices
           : simplex == 1  ? complex->edges
                           : complex->triangles;
}

long gm_form_betti(const struct gm_complex *complex, int degree)
{
    const long euler = (long)complex->vertices - (long)complex->edges + (long)complex->triangles;
    const long pieces = (long)complex->pieces, closed = (long)complex->closed;
    return degree == 0 ? pieces : degree == 2 ? closed : pieces + closed - euler;
}

/* The gradients of barycentric coordinates: e_a turned by 90 degrees over 2 area, e_a opposite to corner a. */
static void gradients(const struct gm_complex *complex, size_t t, double g[3][3])
{
    double p[9], n[3];
    gm_complex_corners_in_space(complex, t, p);
    gm_triangle_normal(p, n);
    for (int a = 0; a < 3; a++) {
        double side[3];
        gm_subtract(p + (a + 2) % 3 * 3, p + (a + 1) % 3 * 3, side);
        gm_cross(n, side, g[a]);
        for (int c = 0; c < 3; c++) {
            g[a][c] /= 4 * complex->area[t] * complex->area[t];
        }
    }
}

static struct gm_matrix mass_of(struct gm_form_space *space)
{
    const struct gm_complex *complex = space->complex;
    struct gm_matrix_entries entries = gm_matrix_entries(space->arena, 9 * complex->triangles);
    for (size_t t = 0; t < complex->triangles; t++) {
        double g[3][3];
        gradients(complex, t, g);
        for (size_t a = 0; a < 3; a++) {
            for (size_t b = 0; b < 3; b++) {
                const size_t i = a, j = (a + 1) % 3, k = b, l = (b + 1) % 3;
                const double sign = complex->triangle_sign[3 * t + a] * complex->triangle_sign[3 * t + b];
                const double unit = complex->area[t] / 12;
                const double value =
                    unit * ((1 + (i == k)) * gm_dot(g[j], g[l]) - (1 + (i == l)) * gm_dot(g[j], g[k]) -
                            (1 + (j == k)) * gm_dot(g[i], g[l]) + (1 + (j == l)) * gm_dot(g[i], g[k]));
                gm_matrix_put(&entries, (size_t)complex->triangle_edge[3 * t + a],
                              (size_t)complex->triangle_edge[3 * t + b], sign * value);
            }
        }
    }
    return gm_matrix_of(&entries, complex->edges, complex->edges);
}

/* Whitney's forms along dual edges, by the piece of each in a triangle, from its dual vertex w to the middle m of
   its edge number `side`: the integral of the form of i -> j is h_i l_j - h_j l_i, h = (w + m)/2, l = m - w;
   negative on the left. With GM_INTERIOR_WHITNEY the mean of the forms of both triangles, each of which is
   continued beyond its own to the other's dual vertex. */
static struct gm_matrix transfer_of(const struct gm_form_space *space, struct gm_arena *arena)
{
    const struct gm_complex *complex = space->complex;
    struct gm_matrix_entries entries = gm_matrix_entries(arena, 18 * complex->triangles);
    for (size_t t = 0; t < complex->triangles; t++) {
        double g[3][3];
        gradients(complex, t, g);
        for (size_t side = 0; side < 3; side++) {
            const size_t e = (size_t)complex->triangle_edge[3 * t + side];
            const int *pair = complex->edge_triangle + 2 * e, other = pair[0] == (int)t ? pair[1] : pair[0];
            const bool averaged = space->interior == GM_INTERIOR_WHITNEY && other >= 0;
            double p[9];
            gm_complex_corners_in_space(complex, other >= 0 ? (size_t)other : t, p);
            for (int half = 0; half < (averaged ? 2 : 1); half++) {
                double from[3], to[3];
                for (size_t c = 0; c < 3; c++) {
                    const double m = c == (side + 2) % 3 ? 0 : 0.5;
                    from[c] = half ? m : complex->weight[3 * t + c];
                    to[c] = m;
                }
                size_t edge = 0;
                while (half && (size_t)complex->triangle_edge[3 * other + (int)edge] != e) {
                    edge++;
                }
                for (size_t k = 0; k < 9 && half; k++) {
                    const double middle = (p[3 * edge + k % 3] + p[(edge + 1) % 3 * 3 + k % 3]) / 2;
                    to[k / 3] += g[k / 3][k % 3] * (space->dual_vertex[3 * (size_t)other + k % 3] - middle);
                }
                for (size_t i = 0; i < 3; i++) {
                    const size_t j = (i + 1) % 3;
                    const double along =
                        (from[i] + to[i]) / 2 * (to[j] - from[j]) - (from[j] + to[j]) / 2 * (to[i] - from[i]);
                    gm_matrix_put(&entries, e, (size_t)complex->triangle_edge[3 * t + i],
                                  -complex->triangle_sign[3 * t + side] * complex->triangle_sign[3 * t + i] *
                                      along * (averaged ? 0.5 : 1));
                }
            }
        }
    }
    return gm_matrix_of(&entries, complex->edges, complex->edges);
}

/* The components of Whitney's forms at centres of mass, (g_j - g_i)/3 of an edge i -> j. */
static void make_centres(struct gm_form_space *space, struct gm_arena *arena)
{
    const struct gm_complex *complex = space->complex;
    for (int c = 0; c < 3; c++) {
        struct gm_matrix_entries entries = gm_matrix_entries(arena, 3 * complex->triangles);
        for (size_t t = 0; t < complex->triangles; t++) {
            double g[3][3];
            gradients(complex, t, g);
            for (size_t a = 0; a < 3; a++) {
                gm_matrix_put(&entries, t, (size_t)complex->triangle_edge[3 * t + a],
                              complex->triangle_sign[3 * t + a] * (g[(a + 1) % 3][c] - g[a][c]) / 3);
            }
        }
        space->matrix[GM_MATRIX_CENTRE_X + c] = gm_matrix_of(&entries, complex->triangles, complex->edges);
    }
}

void gm_form_space_need(struct gm_form_space *space, struct gm_arena *arena, enum gm_form_matrix number)
{
    const struct gm_complex *complex = space->complex;
    const bool upwind = space->interior == GM_INTERIOR_UPWIND;
    if (space->matrix[number].start) {
        return;
    }
    if (number == GM_MATRIX_TRANSFER) {
        space->matrix[number] = transfer_of(space, arena);
        return;
    }
    if (number >= GM_MATRIX_CENTRE_X) {
        make_centres(space, arena);
        return;
    }
    struct gm_matrix_entries entries =
        gm_matrix_entries(arena, number == GM_MATRIX_MEAN2 ? 3 * complex->triangles : 2 * complex->edges);
    for (size_t k = 0; k < 3 * complex->triangles && number == GM_MATRIX_MEAN2; k++) {
        gm_matrix_put(&entries, k / 3, (size_t)complex->triangle[k], 1.0 / 3);
    }
    for (size_t k = 0; k < 2 * complex->edges && number != GM_MATRIX_MEAN2; k++) {
        const size_t e = k / 2, end = (size_t)complex->edge[k];
        const int side = complex->edge_triangle[k];
        const bool inside = side >= 0 && complex->edge_triangle[k ^ 1] >= 0;
        if (number == GM_MATRIX_MEAN1) {
            gm_matrix_put(&entries, e, end, 0.5);
        } else if (number == GM_MATRIX_ACROSS && side >= 0) {
            gm_matrix_put(&entries, e, (size_t)side, inside ? 0.5 : 1);
        } else if (number == GM_MATRIX_JUMP1 && upwind) {
            gm_matrix_put(&entries, e, end, k % 2 ? 0.5 : -0.5);
        } else if (number == GM_MATRIX_JUMP2 && upwind && inside) {
            gm_matrix_put(&entries, e, (size_t)side, k % 2 ? 0.5 : -0.5);
        } else if (number == GM_MATRIX_HALVES && !inside) {
            gm_matrix_put(&entries, end, e, 0.25);
        } else if (number == GM_MATRIX_OUT && !inside && side >= 0) {
            gm_matrix_put(&entries, e, e, k % 2 ? -1 : 1);
        }
    }
    const size_t cells = number == GM_MATRIX_HALVES  ? complex->vertices
                         : number == GM_MATRIX_MEAN2 ? complex->triangles
                                                     : complex->edges,
                 columns = number == GM_MATRIX_MEAN1 || number == GM_MATRIX_MEAN2 || number == GM_MATRIX_JUMP1
                               ? complex->vertices
                           : number == GM_MATRIX_ACROSS || number == GM_MATRIX_JUMP2 ? complex->triangles
                                                                                     : complex->edges;
    space->matrix[number] = gm_matrix_of(&entries, cells, columns);
}

static void make_derivatives(struct gm_form_space *space)
{
    const struct gm_complex *complex = space->complex;
    struct gm_matrix *matrix = space->matrix;
    const size_t vertices = complex->vertices, edges = complex->edges, triangles = complex->triangles;
    struct gm_matrix_entries d0 = gm_matrix_entries(space->arena, 2 * edges),
                             d1 = gm_matrix_entries(space->arena, 3 * triangles);
    for (size_t k = 0; k < 2 * edges; k++) {
        gm_matrix_put(&d0, k / 2, (size_t)complex->edge[k], k % 2 ? 1 : -1);
    }
    for (size_t k = 0; k < 3 * triangles; k++) {
        gm_matrix_put(&d1, k / 3, (size_t)complex->triangle_edge[k], complex->triangle_sign[k]);
    }
    matrix[GM_MATRIX_D0] = gm_matrix_of(&d0, edges, vertices);
    matrix[GM_MATRIX_D1] = gm_matrix_of(&d1, triangles, edges);
    matrix[GM_MATRIX_DUAL_D0] = gm_matrix_transposed(space->arena, &matrix[GM_MATRIX_D1], 1);
    matrix[GM_MATRIX_DUAL_D1] = gm_matrix_transposed(space->arena, &matrix[GM_MATRIX_D0], -1);
}

struct gm_cholesky *gm_matrix_factor(struct gm_arena *arena, const struct gm_matrix *a)
{
    struct gm_cholesky *factor = gm_cholesky_open(a->rows, a->start, a->column, a->value, GM_CHOLESKY_EXACT);
    return factor ? gm_arena_keep(arena, factor, gm_cholesky_close) : NULL;
}

static void make_stars(struct gm_form_space *space)
{
    const struct gm_complex *complex = space->complex;
    struct gm_arena *arena = space->arena;
    struct gm_matrix *matrix = space->matrix;
    matrix[GM_MATRIX_STAR0] = gm_matrix_diagonal(arena, complex->star0, complex->vertices, 1, 1);
    matrix[GM_MATRIX_DUAL_STAR2] = gm_matrix_diagonal(arena, complex->star0, complex->vertices, -1, 1);
    matrix[GM_MATRIX_STAR2] = gm_matrix_diagonal(arena, complex->area, complex->triangles, -1, 1);
    matrix[GM_MATRIX_DUAL_STAR0] = gm_matrix_diagonal(arena, complex->area, complex->triangles, 1, 1);
    struct gm_matrix diagonal = gm_matrix_diagonal(arena, complex->star1, complex->edges, 1, 1);
    const struct gm_matrix flux = gm_matrix_product(arena, &diagonal, &matrix[GM_MATRIX_D0]),
                           back = gm_matrix_product(arena, &matrix[GM_MATRIX_DUAL_D1], &flux);
    matrix[GM_MATRIX_LAPLACE] = gm_matrix_product(arena, &matrix[GM_MATRIX_DUAL_STAR2], &back);
    if (complex->star == GM_STAR_CIRCUMCENTRIC) {
        matrix[GM_MATRIX_STAR1] = diagonal;
        matrix[GM_MATRIX_DUAL_STAR1] = gm_matrix_diagonal(arena, complex->star1, complex->edges, -1, -1);
    } else {
        matrix[GM_MATRIX_STAR1] = mass_of(space);
        space->inner = matrix[GM_MATRIX_STAR1];
        space->mass = gm_matrix_factor(arena, &space->inner);
        gm_arena_need(arena, space->mass);
    }
}

/* The mass matrix without the held edges, space->held. */
static void hold(struct gm_arena *arena, void *data)
{
    struct gm_form_space *space = data;
    const bool *held = space->held;
    struct gm_matrix inner = gm_matrix_sum(arena, 1, &space->matrix[GM_MATRIX_STAR1], 0, NULL);
    for (size_t e = 0; e < inner.rows; e++) {
        for (int k = inner.start[e]; k < inner.start[e + 1]; k++) {
            const int column = inner.column[k];
            inner.value[k] = held[e] || held[column] ? column == (int)e : inner.value[k];
        }
    }
    space->inner = inner;
    gm_arena_drop(arena, space->mass);
    space->mass = gm_matrix_factor(arena, &inner);
    gm_arena_need(arena, space->mass);
}

bool gm_form_space_hold(struct gm_form_space *space, const bool *held)
{
    space->held = space->mass ? held : NULL;
    return !space->mass || gm_arena_run(space->arena, hold, space);
}

static void make(struct gm_arena *arena, void *data)
{
    struct gm_form_space *space = data;
    make_derivatives(space);
    make_stars(space);
    space->dual_vertex = gm_arena_take(arena, 3 * space->complex->triangles, sizeof(double));
    for (size_t t = 0; t < space->complex->triangles; t++) {
        double p[9];
        gm_complex_corners_in_space(space->complex, t, p);
        const double *w = space->complex->weight + 3 * t;
        for (size_t c = 0; c < 3; c++) {
            space->dual_vertex[3 * t + c] = w[0] * p[c] + w[1] * p[3 + c] + w[2] * p[6 + c];
        }
    }
}

bool gm_form_space_open(struct gm_form_space *space, struct gm_complex *complex)
{
    *space = (struct gm_form_space){.arena = gm_arena_open(), .complex = complex};
    if (!space->arena) {
        return false;
    }
    if (!gm_arena_run(space->arena, make, space)) {
        gm_form_space_close(space);
        return false;
    }
    return true;
}

void gm_form_space_close(void *space)
{
    struct gm_form_space *self = space;
    gm_arena_close(self->arena);
    self->arena = NULL;
}

/* ---- integrals ---- */

/* Gauss' five points and weights on [0, 1] */
static const double gauss[5][2] = {{0.046910077030668004, 0.11846344252809454},
                                   {0.23076534494715845, 0.23931433524968324},
                                   {0.5, 0.28444444444444444},
                                   {0.7692346550528415, 0.23931433524968324},
                                   {0.953089922969332, 0.11846344252809454}};

/* Radon's seven points of degree 5: barycentric coordinates a, b, b and the weight */
static const double radon[3][3] = {
    {1.0 / 3, 1.0 / 3, 0.225},
    {0.05971587178976982, 0.47014206410511509, 0.13239415278850618},
    {0.79742698535308732, 0.10128650732345634, 0.12593918054482715},
};

static struct gm_form_points *room_for(struct gm_arena *arena, size_t numbers, size_t each, bool vectors)
{
    const size_t count = numbers * each;
    struct gm_form_points *points = gm_arena_take(arena, 1, sizeof *points);
    *points = (struct gm_form_points){
        .count = count, .each = each, .point = gm_arena_take(arena, 5 * count, sizeof(double))};
    if (vectors) {
        points->vector = gm_arena_take(arena, 3 * count, sizeof(double));
    } else {
        points->weight = gm_arena_take(arena, count, sizeof(double));
    }
    return points;
}

static void put(const struct gm_form_points *points, size_t at, const double *p, double weight)
{
    for (size_t c = 0; c < 3; c++) {
        points->point[c * points->count + at] = p[c];
    }
    points->weight[at] = weight;
}

/* Five points of the straight piece from p to q. */
static void put_piece(const struct gm_form_points *points, size_t at, const double *p, const double *q)
{
    for (size_t i = 0; i < 5; i++) {
        for (size_t c = 0; c < 3; c++) {
            points->point[c * points->count + at + i] = p[c] + gauss[i][0] * (q[c] - p[c]);
            points->vector[c * points->count + at + i] = gauss[i][1] * (q[c] - p[c]);
        }
    }
}

static struct gm_form_points *points_of_lines(const struct gm_form_space *space, struct gm_arena *arena,
                                              bool dual)
{
    const struct gm_complex *complex = space->complex;
    struct gm_form_points *points = room_for(arena, complex->edges, dual ? 10 : 5, true);
    for (size_t k = 0; k < 3 * complex->triangles; k++) {
        double p[9], middle[3];
        gm_complex_corners_in_space(complex, k / 3, p);
        const double *from = p + 3 * (k % 3), *to = p + 3 * ((k + 1) % 3);
        for (size_t c = 0; c < 3; c++) {
            middle[c] = (from[c] + to[c]) / 2;
        }
        const size_t e = (size_t)complex->triangle_edge[k];
        /* the triangle is on the left of the edge, which runs from its low to its high vertex */
        const bool left = complex->triangle_sign[k] > 0;
        const double *centre = space->dual_vertex + 3 * (k / 3);
        const int *pair = complex->edge_triangle + 2 * e;
        if (dual && (pair[0] < 0 || pair[1] < 0)) { /* half of a dual edge: the other one has no length */
            put_piece(points, pair[0] < 0 ? 10 * e : 10 * e + 5, middle, middle);
        }
        if (!dual) {
            put_piece(points, 5 * e, left ? from : to, left ? to : from);
        } else if (left) { /* the dual edge ends here */
            put_piece(points, 10 * e, middle, centre);
        } else {
            put_piece(points, 10 * e + 5, centre, middle);
        }
    }
    return points;
}

static struct gm_form_points *points_of_cells(const struct gm_form_space *space, struct gm_arena *arena,
                                              struct gm_form_type type)
{
    const struct gm_complex *complex = space->complex;
    const bool vertices = (type.degree == 0) != type.dual;
    const size_t numbers = vertices ? complex->vertices : complex->triangles,
                 each = type.degree == 2 && !type.dual ? 7 : 1;
    struct gm_form_points *points = room_for(arena, numbers, each, false);
    for (size_t i = 0; i < numbers && each == 1; i++) {
        double p[3];
        if (vertices) {
            gm_complex_vertex(complex, i, p);
        }
        put(points, i, vertices ? p : space->dual_vertex + 3 * i, type.degree == 2 ? complex->star0[i] : 1);
    }
    for (size_t t = 0; t < numbers && each == 7; t++) {
        double p[9];
        gm_complex_corners_in_space(complex, t, p);
        for (size_t i = 0; i < 7; i++) {
            const double *rule = radon[(i + 2) / 3];
            double at[3];
            for (size_t c = 0; c < 3; c++) {
                at[c] = 0;
                for (size_t corner = 0; corner < 3; corner++) {
                    at[c] += p[3 * corner + c] * (corner == (i + 2) % 3 ? rule[0] : rule[1]);
                }
            }
            put(points, 7 * t + i, at, rule[2] * complex->area[t]);
        }
    }
    return points;
}

const struct gm_form_points *gm_form_points_of(struct gm_form_space *space, struct gm_arena *arena,
                                               struct gm_form_type type)
{
    struct gm_form_points **points = &space->points[type.dual][type.degree];
    if (!*points) {
        *points =
            type.degree == 1 ? points_of_lines(space, arena, type.dual) : points_of_cells(space, arena, type);
    }
    return *points;
}
