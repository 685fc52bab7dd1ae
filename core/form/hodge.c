/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A primal 1-form is the sum of three that are orthogonal: an exact one, a coexact one and a harmonic one, which is
   closed, without sources and tangent to the boundary,
       a = d alpha + delta beta + h,   K alpha = D0' S1 a,   D1 c = D1 a with S1 c = D1' gamma, c = delta beta.
   alpha is found up to constants on each piece, gamma up to those on closed ones: one number of each is 0.
   Hodge, The Theory and Applications of Harmonic Integrals (1941); Hirani, Discrete Exterior Calculus (2003). */
#include "core/form/hodge.h"

#include <math.h>
#include <string.h>

#include "core/linear/cholesky.h"

struct gm_hodge {
    const struct gm_form_space *space;
    struct gm_matrix potential, saddle; /* K; [S1 -D1'; D1 0] */
    struct gm_cholesky *factor;
    struct gm_lu *lu;
    bool *pinned;          /* vertices, then triangles */
    double *right, *found; /* edges + triangles, or vertices */
};

/* Marks a vertex of each piece, and a triangle of each closed one. */
static void pin(struct gm_hodge *hodge)
{
    const struct gm_complex *complex = hodge->space->complex;
    bool *of_triangle = hodge->pinned + complex->vertices;
    for (size_t v = 0; v < complex->vertices; v++) {
        hodge->pinned[v] = complex->vertex_piece[v] == (int)v;
    }
    for (size_t t = 0; t < complex->triangles; t++) {
        of_triangle[t] = complex->triangle_piece[t] == (int)t;
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const int *pair = complex->edge_triangle + 2 * complex->boundary_edge[b];
        of_triangle[complex->triangle_piece[pair[0] >= 0 ? pair[0] : pair[1]]] = false;
    }
}

static void make_potential(struct gm_hodge *hodge, struct gm_arena *arena)
{
    const struct gm_form_space *space = hodge->space;
    struct gm_matrix *k = &hodge->potential;
    const struct gm_matrix flux = gm_matrix_product(arena, &space->matrix[GM_MATRIX_STAR1],
                                                    &space->matrix[GM_MATRIX_D0]),
                           back = gm_matrix_product(arena, &space->matrix[GM_MATRIX_DUAL_D1], &flux);
    *k = gm_matrix_sum(arena, -1, &back, 0, NULL);
    for (size_t i = 0; i < k->rows; i++) {
        for (int l = k->start[i]; l < k->start[i + 1]; l++) {
            const int j = k->column[l];
            k->value[l] = hodge->pinned[i] || hodge->pinned[j] ? j == (int)i : k->value[l];
        }
    }
    hodge->factor = gm_matrix_factor(arena, k);
    gm_arena_need(arena, hodge->factor);
}

static void make_saddle(struct gm_hodge *hodge, struct gm_arena *arena)
{
    const struct gm_form_space *space = hodge->space;
    const size_t edges = space->complex->edges, triangles = space->complex->triangles;
    const bool *pinned = hodge->pinned + space->complex->vertices;
    const struct gm_matrix *star = &space->matrix[GM_MATRIX_STAR1];
    struct gm_matrix d = gm_matrix_sum(arena, 1, &space->matrix[GM_MATRIX_D1], 0, NULL);
    double *moves = gm_arena_take(arena, triangles, sizeof *moves);
    struct gm_matrix_entries all = gm_matrix_entries(arena, gm_matrix_count(star) + 7 * triangles);
    for (size_t t = 0; t < triangles; t++) {
        moves[t] = pinned[t] ? 0 : 1;
        gm_matrix_put(&all, edges + t, edges + t, pinned[t]);
    }
    gm_matrix_scale(&d, moves);
    const struct gm_matrix back = gm_matrix_transposed(arena, &d, -1);
    gm_matrix_put_block(&all, star, 0, 0, 1);
    gm_matrix_put_block(&all, &d, edges, 0, 1);
    gm_matrix_put_block(&all, &back, 0, edges, 1);
    hodge->saddle = gm_matrix_of(&all, edges + triangles, edges + triangles);
    hodge->lu =
        gm_lu_open(hodge->saddle.rows, hodge->saddle.start, hodge->saddle.column, hodge->saddle.value, NULL);
    gm_arena_need(arena, hodge->lu);
    gm_arena_keep(arena, hodge->lu, gm_lu_close);
}

struct gm_hodge *gm_hodge_open(struct gm_arena *arena, const struct gm_form_space *space)
{
    const struct gm_complex *complex = space->complex;
    struct gm_hodge *hodge = gm_arena_take(arena, 1, sizeof *hodge);
    hodge->space = space;
    hodge->pinned = gm_arena_take(arena, complex->vertices + complex->triangles, sizeof *hodge->pinned);
    hodge->right = gm_arena_take(arena, 2 * (complex->edges + complex->triangles), sizeof *hodge->right);
    hodge->found = hodge->right + complex->edges + complex->triangles;
    pin(hodge);
    make_potential(hodge, arena);
    make_saddle(hodge, arena);
    return hodge;
}

const struct gm_cholesky *gm_hodge_factor(const struct gm_hodge *hodge)
{
    return hodge->factor;
}

const struct gm_lu *gm_hodge_lu(const struct gm_hodge *hodge)
{
    return hodge->lu;
}

void gm_hodge_exact(struct gm_hodge *hodge, const double *a, double *part)
{
    const struct gm_matrix *matrix = hodge->space->matrix;
    gm_matrix_apply(&matrix[GM_MATRIX_STAR1], a, hodge->found);
    gm_matrix_apply(&matrix[GM_MATRIX_DUAL_D1], hodge->found, hodge->right);
    for (size_t v = 0; v < hodge->space->complex->vertices; v++) {
        hodge->right[v] = hodge->pinned[v] ? 0 : -hodge->right[v];
    }
    gm_cholesky_solve(hodge->factor, hodge->right, hodge->found);
    gm_matrix_apply(&matrix[GM_MATRIX_D0], hodge->found, part);
}

void gm_hodge_coexact(struct gm_hodge *hodge, const double *a, double *part)
{
    const struct gm_complex *complex = hodge->space->complex;
    double *right = hodge->right;
    memset(right, 0, complex->edges * sizeof *right);
    gm_matrix_apply(&hodge->space->matrix[GM_MATRIX_D1], a, right + complex->edges);
    for (size_t t = 0; t < complex->triangles; t++) {
        right[complex->edges + t] *= hodge->pinned[complex->vertices + t] ? 0 : 1;
    }
    const bool solved = gm_lu_apply(hodge->lu, right, hodge->found);
    for (size_t e = 0; e < complex->edges; e++) {
        part[e] = solved ? hodge->found[e] : NAN;
    }
}
