/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Oriented simplicial complexes with their Hodge stars:
       star1(e) = (sum over the triangles of e of cot(opposite angle)) / 2
       star0(v) = sum over (triangle, edge at v) of |e|^2 cot(opposite angle) / 8 if it is circumcentric,
                  a third of the triangles around if it is barycentric
   Hirani, Discrete Exterior Calculus (2003); Mohamed, Hirani & Samtaney, J. Comput. Phys. 312 (2016) 175. */
#include "core/form/complex.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/functions/functions.h"
#include "core/linear/vectors.h"

/* A dual edge shorter than this part of its edge counts as none: two right angles that face each other leave
   round-off of either sign. */
static const double shortest_dual = 1e-9;

struct side;

/* A complex that is being built of triangles. */
struct building {
    struct gm_arena *arena; /* arena of the complex; temporary arrays come last and are released at the end */
    struct gm_complex *complex;
    const struct gm_triangles *from;
    struct gm_triangulation_fault *fault;
    const struct side *sides; /* of all triangles, sorted */
    size_t other;             /* the first triangle of a second piece, or 0 */
};

_Noreturn static void refuse(struct building *building, enum gm_triangulation_fault_kind kind)
{
    building->fault->kind = kind;
    gm_arena_leave(building->arena);
}

static long tag_of(const struct gm_triangles *from, int vertex)
{
    return from->tags ? from->tags[vertex] : vertex + 1L;
}

static void name_triangle(const struct gm_complex *complex, size_t triangle, const struct gm_triangles *from,
                          struct gm_triangulation_fault *fault)
{
    fault->triangle = (long)triangle + 1;
    for (int k = 0; k < 3; k++) {
        fault->nodes[k] = tag_of(from, complex->triangle[3 * triangle + (size_t)k]);
    }
}

_Noreturn static void refuse_triangle(struct building *building, size_t triangle,
                                      enum gm_triangulation_fault_kind kind)
{
    name_triangle(building->complex, triangle, building->from, building->fault);
    refuse(building, kind);
}

_Noreturn static void refuse_vertex(struct building *building, int vertex,
                                    enum gm_triangulation_fault_kind kind)
{
    building->fault->nodes[0] = tag_of(building->from, vertex);
    refuse(building, kind);
}

void gm_complex_vertex(const struct gm_complex *complex, size_t vertex, double point[3])
{
    for (size_t c = 0; c < 3; c++) {
        point[c] = c < complex->coordinates ? complex->point[complex->coordinates * vertex + c] : 0;
    }
}

void gm_complex_corners_in_space(const struct gm_complex *complex, size_t triangle, double corners[9])
{
    for (size_t k = 0; k < 3; k++) {
        double *corner = corners + 3 * k;
        gm_complex_vertex(complex, (size_t)complex->triangle[3 * triangle + k], corner);
        for (size_t c = 0; c < 2 && k > 0 && complex->period[c] > 0; c++) {
            corner[c] -= complex->period[c] * round((corner[c] - corners[c]) / complex->period[c]);
        }
    }
}

void gm_triangle_normal(const double p[9], double normal[3])
{
    double a[3], b[3];
    gm_subtract(p + 3, p, a);
    gm_subtract(p + 6, p, b);
    gm_cross(a, b, normal);
}

void gm_complex_corners(const struct gm_complex *complex, size_t triangle, double corners[6])
{
    double p[9];
    gm_complex_corners_in_space(complex, triangle, p);
    for (size_t i = 0; i < 6; i++) {
        corners[i] = p[i / 2 * 3 + i % 2];
    }
}

void gm_complex_centre(const struct gm_complex *complex, size_t triangle, double centre[2])
{
    double p[6];
    gm_complex_corners(complex, triangle, p);
    const double *w = complex->weight + 3 * triangle;
    for (int c = 0; c < 2; c++) {
        centre[c] = w[0] * p[c] + w[1] * p[2 + c] + w[2] * p[4 + c];
    }
}

void gm_complex_coordinates(const struct gm_complex *complex, size_t triangle, const double x[2], double w[3])
{
    double p[6], at[2];
    gm_complex_corners(complex, triangle, p);
    for (int c = 0; c < 2; c++) {
        const double period = complex->period[c];
        at[c] = x[c] - p[c];
        at[c] -= period > 0 ? period * round(at[c] / period) : 0;
    }
    const double twice = 2 * complex->area[triangle];
    w[1] = (at[0] * (p[5] - p[1]) - at[1] * (p[4] - p[0])) / twice;
    w[2] = (at[1] * (p[2] - p[0]) - at[0] * (p[3] - p[1])) / twice;
    w[0] = 1 - w[1] - w[2];
}

void gm_complex_middle(const struct gm_complex *complex, size_t edge, double middle[2])
{
    const double *a = complex->point + 2 * complex->edge[2 * edge],
                 *b = complex->point + 2 * complex->edge[2 * edge + 1];
    for (int c = 0; c < 2; c++) {
        middle[c] = (a[c] + b[c]) / 2;
    }
}

int gm_complex_edge(const struct gm_complex *complex, int a, int b)
{
    for (int k = complex->ring_start[a]; k < complex->ring_start[a + 1]; k++) {
        if (complex->ring_vertex[k] == b) {
            return complex->ring_edge[k];
        }
    }
    return -1;
}

void gm_complex_quarter(const struct gm_complex *complex, double *points, int *corners)
{
    const size_t n = complex->vertices;
    memcpy(points, complex->point, 2 * n * sizeof *points);
    for (size_t e = 0; e < complex->edges; e++) {
        gm_complex_middle(complex, e, points + 2 * (n + e));
    }
    for (size_t t = 0; t < complex->triangles; t++) {
        const int *v = complex->triangle + 3 * t, *e = complex->triangle_edge + 3 * t;
        const int m[3] = {(int)n + e[0], (int)n + e[1], (int)n + e[2]};
        const int four[12] = {v[0], m[0], m[2], m[0], v[1], m[1], m[2], m[1], v[2], m[0], m[1], m[2]};
        memcpy(corners + 12 * t, four, sizeof four);
    }
}

static void flip(int *corner)
{
    const int swap = corner[1];
    corner[1] = corner[2];
    corner[2] = swap;
}

/* Measures areas; in the plane, whose normal is z, triangles are turned counter-clockwise. */
static void orient(struct building *building, bool in_plane)
{
    struct gm_complex *complex = building->complex;
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[9], normal[3], side[3], longest = 0;
        gm_complex_corners_in_space(complex, t, p);
        for (int k = 0; k < 3; k++) {
            gm_subtract(p + (k + 1) % 3 * 3, p + 3 * k, side);
            longest = fmax(longest, gm_length(side));
        }
        gm_triangle_normal(p, normal);
        const double twice = in_plane ? normal[2] : gm_length(normal);
        const int *v = complex->triangle + 3 * t;
        const bool flat = !(fabs(twice) > 1e-12 * longest * longest) || !isfinite(twice);
        if (flat || v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            refuse_triangle(building, t, GM_TRIANGULATION_DEGENERATE);
        }
        if (twice < 0) {
            flip(complex->triangle + 3 * t);
        }
        complex->area[t] = fabs(twice) / 2;
        complex->total_area += complex->area[t];
    }
}

/* A side of a triangle on its way to becoming an edge. */
struct side {
    int low, high;
    int place; /* 3 * triangle + side */
};

static int compare_sides(const void *a, const void *b)
{
    const struct side *p = a, *q = b;
    const int first = (p->low > q->low) - (p->low < q->low);
    const int second = (p->high > q->high) - (p->high < q->high);
    return first ? first : second ? second : (p->place > q->place) - (p->place < q->place);
}

/* The sides of all triangles, sorted: the sides of one edge are adjacent. */
static const struct side *sort_sides(struct building *building)
{
    const struct gm_complex *complex = building->complex;
    const size_t count = 3 * complex->triangles;
    struct side *sides = gm_arena_take(building->arena, count, sizeof *sides);
    struct side *sorted = gm_arena_take(building->arena, count, sizeof *sorted);
    size_t *start = gm_arena_take(building->arena, complex->vertices + 1, sizeof *start);
    for (size_t i = 0; i < count; i++) {
        const int a = complex->triangle[i], b = complex->triangle[i % 3 == 2 ? i - 2 : i + 1];
        sides[i] = (struct side){a < b ? a : b, a < b ? b : a, (int)i};
        start[sides[i].low + 1]++;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        start[v + 1] += start[v];
    }
    for (size_t i = 0; i < count; i++) {
        sorted[start[sides[i].low]++] = sides[i];
    }
    for (size_t v = 0, from = 0; v < complex->vertices; from = start[v++]) {
        qsort(sorted + from, start[v] - from, sizeof *sorted, compare_sides);
    }
    return sorted;
}

/* Returns where each side meets another one: -1 at the boundary. */
static int *link_sides(struct building *building)
{
    const size_t count = 3 * building->complex->triangles;
    int *across = gm_arena_take(building->arena, count, sizeof *across);
    memset(across, -1, count * sizeof *across);
    for (size_t i = 0; i + 1 < count; i++) {
        const struct side *a = &building->sides[i], *b = a + 1;
        if (a->low == b->low && a->high == b->high && across[a->place] < 0) {
            across[a->place] = b->place;
            across[b->place] = a->place;
        }
    }
    return across;
}

/* Finds the pieces. In space the triangles of each are turned like its first one, and a closed piece encloses
   a positive volume. */
static void find_pieces(struct building *building, bool in_plane)
{
    struct gm_complex *complex = building->complex;
    const int *across = link_sides(building);
    int *queue = gm_arena_take(building->arena, complex->triangles, sizeof *queue);
    signed char *sense = gm_arena_take(building->arena, complex->triangles, sizeof *sense);
    for (size_t first = 0, begin = 0, end = 0; first < complex->triangles; first++) {
        if (sense[first]) {
            continue;
        }
        bool closed = true;
        double volume = 0, p[9], normal[3];
        int least = complex->triangle[3 * first];
        sense[first] = 1;
        queue[end++] = (int)first;
        building->other = complex->pieces++ == 1 ? first : building->other;
        for (size_t i = begin; i < end; i++) {
            const int t = queue[i];
            gm_complex_corners_in_space(complex, (size_t)t, p);
            gm_cross(p + 3, p + 6, normal);
            volume += sense[t] * gm_dot(p, normal);
            complex->triangle_piece[t] = (int)first;
            for (int k = 0; k < 3; k++) {
                const int here = 3 * t + k, there = across[here];
                least = complex->triangle[here] < least ? complex->triangle[here] : least;
                closed &= there >= 0;
                if (there < 0) {
                    continue;
                }
                const bool along = complex->triangle[here] == complex->triangle[there] && !in_plane;
                const signed char right = (signed char)(along ? -sense[t] : sense[t]);
                if (sense[there / 3] && sense[there / 3] != right) {
                    building->fault->nodes[1] =
                        tag_of(building->from, complex->triangle[3 * t + (k + 1) % 3]);
                    refuse_vertex(building, complex->triangle[here], GM_TRIANGULATION_ONE_SIDED);
                }
                if (!sense[there / 3]) {
                    sense[there / 3] = right;
                    queue[end++] = there / 3;
                }
            }
        }
        complex->closed += closed;
        for (; begin < end; begin++) {
            for (int k = 0; k < 3; k++) {
                complex->vertex_piece[complex->triangle[3 * queue[begin] + k]] = least;
            }
            if (!in_plane && (sense[queue[begin]] < 0) != (closed && volume < 0)) {
                flip(complex->triangle + 3 * queue[begin]);
            }
        }
    }
}

static void make_edges(struct building *building)
{
    struct gm_complex *complex = building->complex;
    const struct side *sides = building->sides;
    const size_t count = 3 * complex->triangles;
    size_t edges = 0;
    for (size_t i = 0, end = 0; i < count; i = end, edges++) {
        int *pair = complex->edge_triangle + 2 * edges;
        pair[0] = pair[1] = -1;
        complex->edge[2 * edges] = sides[i].low;
        complex->edge[2 * edges + 1] = sides[i].high;
        while (end < count && sides[end].low == sides[i].low && sides[end].high == sides[i].high) {
            end++;
        }
        if (end - i > 2) {
            building->fault->nodes[1] = tag_of(building->from, sides[i].high);
            refuse_vertex(building, sides[i].low, GM_TRIANGULATION_EDGE_OF_THREE);
        }
        for (size_t k = i; k < end; k++) {
            const int place = sides[k].place;
            const bool along = complex->triangle[place] == sides[k].low;
            complex->triangle_edge[place] = (int)edges;
            complex->triangle_sign[place] = along ? 1 : -1;
            if (pair[along ? 0 : 1] >= 0) {
                refuse_triangle(building, (size_t)(place / 3), GM_TRIANGULATION_OVERLAP);
            }
            pair[along ? 0 : 1] = place / 3;
        }
    }
    complex->edges = edges;
}

static void make_rings(struct gm_complex *complex)
{
    for (size_t i = 0; i < 2 * complex->edges; i++) {
        complex->ring_start[complex->edge[i] + 1]++;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        complex->ring_start[v + 1] += complex->ring_start[v];
    }
    /* Edges are in lexicographic order: lower neighbours come first when heads are taken before tails. */
    int *next = complex->ring_start;
    for (int head = 1; head >= 0; head--) {
        for (size_t e = 0; e < complex->edges; e++) {
            const int at = complex->edge[2 * e + (size_t)head],
                      other = complex->edge[2 * e + 1 - (size_t)head];
            const int place = next[at]++;
            complex->ring_vertex[place] = other;
            complex->ring_edge[place] = (int)e;
            complex->edge_ring[2 * e + (size_t)head] = place;
        }
    }
    memmove(next + 1, next, complex->vertices * sizeof *next);
    next[0] = 0;
}

/* Turns around every vertex: its triangles must be one fan. */
static void check_fans(struct building *building, const int *leaves)
{
    const struct gm_complex *complex = building->complex;
    int *corners = gm_arena_take(building->arena, complex->vertices, sizeof *corners);
    int *last = gm_arena_take(building->arena, complex->vertices, sizeof *last);
    for (size_t i = 0; i < 3 * complex->triangles; i++) {
        corners[complex->triangle[i]]++;
        last[complex->triangle[i]] = (int)(i / 3);
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        /* from the triangle of the boundary edge that leaves v, if any, counter-clockwise */
        const int *pair = complex->edge_triangle;
        int t = last[v], met = 0;
        if (leaves[v] >= 0) {
            pair += 2 * leaves[v];
            t = pair[0] >= 0 ? pair[0] : pair[1];
        }
        const int begin = t;
        do {
            int place = 3 * t;
            while (complex->triangle[place] != (int)v) {
                place++;
            }
            pair = complex->edge_triangle + 2 * complex->triangle_edge[3 * t + (place + 2) % 3];
            t = pair[0] == t ? pair[1] : pair[0];
            met++;
        } while (t >= 0 && t != begin && met < corners[v]);
        if (met != corners[v]) {
            refuse_vertex(building, (int)v, GM_TRIANGULATION_PINCHED);
        }
    }
}

static void make_boundary(struct building *building)
{
    struct gm_complex *complex = building->complex;
    /* the boundary edge that begins at a vertex */
    int *leaves = gm_arena_take(building->arena, complex->vertices, sizeof *leaves);
    for (size_t v = 0; v < complex->vertices; v++) {
        leaves[v] = -1;
    }
    for (size_t e = 0; e < complex->edges; e++) {
        const int *pair = complex->edge_triangle + 2 * e;
        if (pair[0] >= 0 && pair[1] >= 0) {
            continue;
        }
        const int begin = complex->edge[2 * e + (pair[0] >= 0 ? 0 : 1)];
        if (leaves[begin] >= 0) {
            refuse_vertex(building, begin, GM_TRIANGULATION_PINCHED);
        }
        leaves[begin] = (int)e;
        complex->boundary++;
    }
    check_fans(building, leaves);
    size_t count = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        int at = (int)v;
        if (leaves[v] >= 0) {
            complex->loop_start[complex->loops++] = count;
        }
        while (leaves[at] >= 0) {
            const int e = leaves[at];
            leaves[at] = -1;
            complex->boundary_edge[count] = e;
            complex->loop[count] = complex->loops - 1;
            complex->boundary_vertex[count++] = at;
            at = complex->edge[2 * e] == at ? complex->edge[2 * e + 1] : complex->edge[2 * e];
        }
        complex->loop_start[complex->loops] = count;
    }
}

/* Returns the dot product of both sides of corner k, and the side that faces it. */
static double face(const double p[9], int k, double side[3])
{
    double a[3], b[3];
    gm_subtract(p + (k + 1) % 3 * 3, p + 3 * k, a);
    gm_subtract(p + (k + 2) % 3 * 3, p + 3 * k, b);
    gm_subtract(b, a, side);
    return gm_dot(a, b);
}

static void measure(struct gm_complex *complex)
{
    complex->smallest_angle = 180;
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[9], share[3], sum = 0;
        gm_complex_corners_in_space(complex, t, p);
        bool obtuse = false;
        for (int k = 0; k < 3; k++) {
            double side[3];
            const double dot = face(p, k, side), cross = 2 * complex->area[t];
            const int e = complex->triangle_edge[3 * t + (size_t)(k + 1) % 3];
            complex->star1[e] += dot / cross / 2;
            complex->length[e] = gm_length(side);
            share[k] = gm_dot(side, side) * dot / cross;
            sum += share[k];
            obtuse |= dot < 0;
            const double angle = gm_atan2(cross, dot) * 180 / M_PI;
            complex->smallest_angle = fmin(complex->smallest_angle, angle);
            complex->largest_angle = fmax(complex->largest_angle, angle);
        }
        complex->obtuse += obtuse;
        for (int k = 0; k < 3; k++) {
            complex->weight[3 * t + (size_t)k] = share[k] / sum;
            /* half of the part of edge k + 1, k + 2 to each of its ends */
            complex->star0[complex->triangle[3 * t + (size_t)(k + 1) % 3]] += share[k] / 8;
            complex->star0[complex->triangle[3 * t + (size_t)(k + 2) % 3]] += share[k] / 8;
        }
    }
    complex->star_least = INFINITY;
    for (size_t e = 0; e < complex->edges; e++) {
        complex->mean_edge += complex->length[e] / (double)complex->edges;
        complex->star_least = fmin(complex->star_least, complex->star1[e]);
    }
}

/* The angle of a triangle opposite to edge e, in degrees. */
static double angle_facing(const struct gm_complex *complex, int triangle, int e)
{
    double p[9], side[3];
    gm_complex_corners_in_space(complex, (size_t)triangle, p);
    int a = 0;
    while (complex->triangle_edge[3 * triangle + a] != e) {
        a++;
    }
    return fabs(gm_atan2(2 * complex->area[triangle], face(p, (a + 2) % 3, side))) * 180 / M_PI;
}

/* Returns true if dual edges and cells are positive; if not, the fault names the worst one. */
static bool star_is_positive(const struct gm_complex *complex, const struct gm_triangles *from,
                             struct gm_triangulation_fault *fault)
{
    double worst = 0;
    for (size_t e = 0; e < complex->edges; e++) {
        for (int side = 0; complex->star1[e] <= shortest_dual && side < 2; side++) {
            const int t = complex->edge_triangle[2 * e + (size_t)side];
            const double angle = t >= 0 ? angle_facing(complex, t, (int)e) : 0;
            if (angle > worst) {
                worst = angle;
                name_triangle(complex, (size_t)t, from, fault);
                fault->value = angle;
                snprintf(fault->text, sizeof fault->text, "%.2g", complex->star_least);
                fault->kind = GM_TRIANGULATION_NOT_DELAUNAY;
            }
        }
    }
    for (size_t v = 0; v < complex->vertices && worst == 0; v++) {
        if (!(complex->star0[v] > 0)) {
            fault->nodes[0] = tag_of(from, (int)v);
            fault->kind = GM_TRIANGULATION_DUAL_CELL;
            return false;
        }
    }
    return worst == 0;
}

/* The dual that is asked for. */
static void take_star(struct building *building)
{
    struct gm_complex *complex = building->complex;
    const enum gm_star star = building->from->star;
    struct gm_triangulation_fault obstacle = {.kind = GM_TRIANGULATION_OK};
    complex->star = GM_STAR_CIRCUMCENTRIC;
    if ((star == GM_STAR_AUTO || star == GM_STAR_CIRCUMCENTRIC) &&
        star_is_positive(complex, building->from, &obstacle)) {
        return;
    }
    if (star == GM_STAR_CIRCUMCENTRIC) {
        *building->fault = obstacle;
        gm_arena_leave(building->arena);
    }
    complex->star = star == GM_STAR_INCENTRIC ? star : GM_STAR_BARYCENTRIC;
    memset(complex->star0, 0, complex->vertices * sizeof *complex->star0);
    for (size_t k = 0; k < 3 * complex->triangles; k++) {
        const size_t t = k / 3;
        const int *side = complex->triangle_edge + 3 * t;
        const double around = complex->length[side[0]] + complex->length[side[1]] + complex->length[side[2]],
                     opposite = complex->length[side[(k % 3 + 1) % 3]];
        const bool inside = star == GM_STAR_INCENTRIC;
        complex->weight[k] = inside ? opposite / around : 1.0 / 3;
        /* two triangles of height r, the radius inside, on half of each side */
        complex->star0[complex->triangle[k]] +=
            inside ? complex->area[t] * (around - opposite) / (2 * around) : complex->area[t] / 3;
    }
}

size_t gm_complex_next(const struct gm_complex *complex, size_t boundary_edge)
{
    const size_t loop = complex->loop[boundary_edge];
    return boundary_edge + 1 < complex->loop_start[loop + 1] ? boundary_edge + 1 : complex->loop_start[loop];
}

size_t gm_complex_previous(const struct gm_complex *complex, size_t boundary_edge)
{
    const size_t loop = complex->loop[boundary_edge];
    return (boundary_edge > complex->loop_start[loop] ? boundary_edge : complex->loop_start[loop + 1]) - 1;
}

double gm_complex_loop_area(const struct gm_complex *complex, size_t loop)
{
    double sum = 0;
    for (size_t b = complex->loop_start[loop]; b < complex->loop_start[loop + 1]; b++) {
        const double *p = complex->point + 2 * complex->boundary_vertex[b],
                     *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)];
        sum += (p[0] * q[1] - q[0] * p[1]) / 2;
    }
    return sum;
}

static void allocate(struct gm_complex *complex, struct gm_arena *arena)
{
    const size_t v = complex->vertices, t = complex->triangles, sides = 3 * t;
    complex->point = gm_arena_take(arena, complex->coordinates * v, sizeof *complex->point);
    complex->triangle = gm_arena_take(arena, sides, sizeof *complex->triangle);
    complex->triangle_edge = gm_arena_take(arena, sides, sizeof *complex->triangle_edge);
    complex->triangle_sign = gm_arena_take(arena, sides, sizeof *complex->triangle_sign);
    complex->edge = gm_arena_take(arena, 2 * sides, sizeof *complex->edge);
    complex->edge_triangle = gm_arena_take(arena, 2 * sides, sizeof *complex->edge_triangle);
    complex->ring_start = gm_arena_take(arena, v + 1, sizeof *complex->ring_start);
    complex->ring_vertex = gm_arena_take(arena, 2 * sides, sizeof *complex->ring_vertex);
    complex->ring_edge = gm_arena_take(arena, 2 * sides, sizeof *complex->ring_edge);
    complex->edge_ring = gm_arena_take(arena, 2 * sides, sizeof *complex->edge_ring);
    complex->boundary_edge = gm_arena_take(arena, sides, sizeof *complex->boundary_edge);
    complex->boundary_vertex = gm_arena_take(arena, sides, sizeof *complex->boundary_vertex);
    complex->loop_start = gm_arena_take(arena, sides + 1, sizeof *complex->loop_start);
    complex->loop = gm_arena_take(arena, sides, sizeof *complex->loop);
    complex->triangle_piece = gm_arena_take(arena, t, sizeof *complex->triangle_piece);
    complex->vertex_piece = gm_arena_take(arena, v, sizeof *complex->vertex_piece);
    complex->length = gm_arena_take(arena, sides, sizeof *complex->length);
    complex->area = gm_arena_take(arena, t, sizeof *complex->area);
    complex->weight = gm_arena_take(arena, sides, sizeof *complex->weight);
    complex->star0 = gm_arena_take(arena, v, sizeof *complex->star0);
    complex->star1 = gm_arena_take(arena, sides, sizeof *complex->star1);
}

static void build(struct gm_arena *arena, void *data)
{
    struct building *building = data;
    const struct gm_triangles *from = building->from;
    struct gm_complex *complex = building->complex = gm_arena_take(arena, 1, sizeof *complex);
    complex->arena = arena;
    complex->vertices = from->vertices;
    complex->triangles = from->count;
    complex->coordinates = from->in_space ? 3 : 2;
    allocate(complex, arena);
    const size_t whole = gm_arena_mark(arena);
    memcpy(complex->point, from->points, complex->coordinates * from->vertices * sizeof *from->points);
    memcpy(complex->triangle, from->corners, 3 * from->count * sizeof *from->corners);
    memcpy(complex->period, from->period, sizeof complex->period);
    bool in_plane = true;
    for (size_t v = 0; v < from->vertices && from->in_space; v++) {
        in_plane &= from->points[3 * v + 2] == from->points[2];
    }
    orient(building, in_plane);
    building->sides = sort_sides(building);
    find_pieces(building, in_plane);
    if (!in_plane) { /* some were turned */
        building->sides = sort_sides(building);
    }
    make_edges(building);
    make_boundary(building);
    if (building->other > 0 && !from->in_space) {
        refuse_triangle(building, building->other, GM_TRIANGULATION_PIECES);
    }
    make_rings(complex);
    measure(complex);
    take_star(building);
    gm_arena_release(arena, whole);
}

struct gm_complex *gm_complex_open(const struct gm_triangles *from, struct gm_triangulation_fault *fault)
{
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_EMPTY};
    if (from->count == 0) {
        return NULL;
    }
    fault->kind = GM_TRIANGULATION_MEMORY; /* unless it is built, or refused for another reason */
    struct building building = {.arena = gm_arena_open(), .from = from, .fault = fault};
    if (!gm_arena_run(building.arena, build, &building)) {
        gm_arena_close(building.arena);
        return NULL;
    }
    fault->kind = GM_TRIANGULATION_OK;
    return building.complex;
}

void gm_complex_close(void *complex)
{
    if (complex) {
        gm_arena_close(((struct gm_complex *)complex)->arena);
    }
}
