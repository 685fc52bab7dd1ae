/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Oriented simplicial complexes with their Hodge stars:
       star1(e) = (sum over the triangles of e of cot(opposite angle)) / 2
       star0(v) = sum over (triangle, edge at v) of |e|^2 cot(opposite angle) / 8 where it is circumcentric,
                  a third of the triangles around where it is barycentric
   Hirani, Discrete Exterior Calculus (2003); Mohamed, Hirani & Samtaney, J. Comput. Phys. 312 (2016) 175. */
#include "core/flow/complex.h"
#include "core/count.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A dual edge shorter than this part of its edge counts as none: two right angles that face each other leave
   round-off of either sign. */
static const double shortest_dual = 1e-9;

static bool fail(struct gm_triangulation_fault *fault, enum gm_triangulation_fault_kind kind)
{
    fault->kind = kind;
    return false;
}

static long tag_of(const long *tags, int vertex)
{
    return tags ? tags[vertex] : vertex + 1L;
}

static void name_triangle(const struct gm_complex *complex, size_t triangle, const long *tags,
                          struct gm_triangulation_fault *fault)
{
    fault->triangle = (long)triangle + 1;
    for (int k = 0; k < 3; k++) {
        fault->nodes[k] = tag_of(tags, complex->triangle[3 * triangle + (size_t)k]);
    }
}

void gm_complex_corners(const struct gm_complex *complex, size_t triangle, double corners[6])
{
    const int *t = complex->triangle + 3 * triangle;
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 2; c++) {
            double x = complex->point[2 * t[k] + c];
            const double period = complex->period[c];
            if (period > 0 && k > 0) {
                x -= period * round((x - corners[c]) / period);
            }
            corners[2 * k + c] = x;
        }
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

static double twice_area(const double p[6])
{
    return (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
}

static bool orient(struct gm_complex *complex, const long *tags, struct gm_triangulation_fault *fault)
{
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[6];
        gm_complex_corners(complex, t, p);
        double longest = 0;
        for (int k = 0; k < 3; k++) {
            const int n = (k + 1) % 3;
            longest = fmax(longest, hypot(p[2 * n] - p[2 * k], p[2 * n + 1] - p[2 * k + 1]));
        }
        const double twice = twice_area(p);
        const int *v = complex->triangle + 3 * t;
        const bool flat = !(fabs(twice) > 1e-12 * longest * longest) || !isfinite(twice);
        if (flat || v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            name_triangle(complex, t, tags, fault);
            return fail(fault, GM_TRIANGULATION_DEGENERATE);
        }
        if (twice < 0) {
            int *corner = complex->triangle + 3 * t;
            const int swap = corner[1];
            corner[1] = corner[2];
            corner[2] = swap;
        }
        complex->area[t] = fabs(twice) / 2;
        complex->total_area += complex->area[t];
    }
    return true;
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

/* The sides of all triangles, sorted: those of an edge stand together. */
static struct side *sort_sides(const struct gm_complex *complex)
{
    const size_t count = 3 * complex->triangles;
    struct side *sides = malloc(count * sizeof *sides);
    struct side *sorted = malloc(count * sizeof *sorted);
    size_t *start = calloc(complex->vertices + 1, sizeof *start);
    if (!sides || !sorted || !start) {
        free(sides);
        free(sorted);
        free(start);
        return NULL;
    }
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
    free(sides);
    free(start);
    return sorted;
}

static bool make_edges(struct gm_complex *complex, const struct side *sides, const long *tags,
                       struct gm_triangulation_fault *fault)
{
    const size_t count = 3 * complex->triangles;
    size_t edges = 0;
    for (size_t i = 0, end = 0; i < count; i = end, edges++) {
        int *pair = complex->edge_triangle + 2 * edges;
        pair[0] = pair[1] = -1;
        complex->edge[2 * edges] = sides[i].low;
        complex->edge[2 * edges + 1] = sides[i].high;
        for (end = i; end < count && sides[end].low == sides[i].low && sides[end].high == sides[i].high;
             end++) {
            const int place = sides[end].place;
            const bool along = complex->triangle[place] == sides[end].low;
            int *seat = &pair[along ? 0 : 1];
            if (end - i == 2) {
                fault->nodes[0] = tag_of(tags, sides[i].low);
                fault->nodes[1] = tag_of(tags, sides[i].high);
                return fail(fault, GM_TRIANGULATION_EDGE_OF_THREE);
            }
            complex->triangle_edge[place] = (int)edges;
            complex->triangle_sign[place] = along ? 1 : -1;
            if (*seat < 0) {
                *seat = place / 3;
            } else {
                /* two on one side; a third one of the same edge is told first */
                const bool third = end + 1 < count && sides[end + 1].low == sides[i].low &&
                                   sides[end + 1].high == sides[i].high;
                if (!third) {
                    name_triangle(complex, (size_t)(place / 3), tags, fault);
                    return fail(fault, GM_TRIANGULATION_OVERLAP);
                }
            }
        }
    }
    complex->edges = edges;
    return true;
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
static bool check_fans(const struct gm_complex *complex, const int *leaves, const long *tags,
                       struct gm_triangulation_fault *fault)
{
    int *corners = calloc(complex->vertices, sizeof *corners);
    int *first = malloc(complex->vertices * sizeof *first);
    bool good = corners && first;
    if (!good) {
        fail(fault, GM_TRIANGULATION_MEMORY);
    }
    for (size_t i = 0; good && i < 3 * complex->triangles; i++) {
        corners[complex->triangle[i]]++;
        first[complex->triangle[i]] = (int)i;
    }
    for (size_t v = 0; good && v < complex->vertices; v++) {
        /* from the triangle of the boundary edge that leaves v, where there is one, counter-clockwise */
        int place = first[v];
        if (leaves[v] >= 0) {
            const int *pair = complex->edge_triangle + 2 * leaves[v];
            const int t = pair[0] >= 0 ? pair[0] : pair[1];
            place = 3 * t;
            while (complex->triangle[place] != (int)v) {
                place++;
            }
        }
        const int begin = place;
        int met = 0;
        do {
            met++;
            const int t = place / 3, k = place % 3, side = 3 * t + (k + 2) % 3;
            const int *pair = complex->edge_triangle + 2 * complex->triangle_edge[side];
            const int next = pair[0] == t ? pair[1] : pair[0];
            if (next < 0) {
                break;
            }
            place = 3 * next;
            while (complex->triangle[place] != (int)v) {
                place++;
            }
        } while (place != begin && met < corners[v]);
        if (met != corners[v]) {
            fault->nodes[0] = tag_of(tags, (int)v);
            good = fail(fault, GM_TRIANGULATION_PINCHED);
        }
    }
    free(corners);
    free(first);
    return good;
}

static bool make_boundary(struct gm_complex *complex, const long *tags, struct gm_triangulation_fault *fault)
{
    int *leaves = malloc(complex->vertices * sizeof *leaves); /* the boundary edge that begins at a vertex */
    if (!leaves) {
        return fail(fault, GM_TRIANGULATION_MEMORY);
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        leaves[v] = -1;
    }
    bool good = true;
    for (size_t e = 0; good && e < complex->edges; e++) {
        const int *pair = complex->edge_triangle + 2 * e;
        if (pair[0] >= 0 && pair[1] >= 0) {
            continue;
        }
        const int begin = complex->edge[2 * e + (pair[0] >= 0 ? 0 : 1)];
        if (leaves[begin] >= 0) {
            fault->nodes[0] = tag_of(tags, begin);
            good = fail(fault, GM_TRIANGULATION_PINCHED);
        }
        leaves[begin] = (int)e;
        complex->boundary++;
    }
    good = good && check_fans(complex, leaves, tags, fault);
    size_t count = 0;
    for (size_t v = 0; good && v < complex->vertices; v++) {
        int at = (int)v;
        if (leaves[v] >= 0) {
            complex->loop_start[complex->loops++] = count;
        }
        while (leaves[at] >= 0) {
            const int e = leaves[at];
            leaves[at] = -1;
            complex->boundary_edge[count] = e;
            complex->boundary_vertex[count++] = at;
            at = complex->edge[2 * e] == at ? complex->edge[2 * e + 1] : complex->edge[2 * e];
        }
        complex->loop_start[complex->loops] = count;
    }
    free(leaves);
    return good;
}

static bool in_one_piece(const struct gm_complex *complex, const long *tags,
                         struct gm_triangulation_fault *fault)
{
    int *queue = malloc(complex->triangles * sizeof *queue);
    bool *met = calloc(complex->triangles, sizeof *met);
    bool good = queue && met;
    if (!good) {
        fail(fault, GM_TRIANGULATION_MEMORY);
    }
    size_t count = 0;
    if (good) {
        queue[count++] = 0;
        met[0] = true;
    }
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            const int *pair = complex->edge_triangle + 2 * complex->triangle_edge[3 * queue[i] + k];
            const int next = pair[0] == queue[i] ? pair[1] : pair[0];
            if (next >= 0 && !met[next]) {
                met[next] = true;
                queue[count++] = next;
            }
        }
    }
    if (good && count != complex->triangles) {
        size_t apart = 0;
        while (met[apart]) {
            apart++;
        }
        good = fail(fault, GM_TRIANGULATION_PIECES);
        name_triangle(complex, apart, tags, fault);
    }
    free(queue);
    free(met);
    return good;
}

static void measure(struct gm_complex *complex)
{
    complex->smallest_angle = 180;
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[6], share[3], sum = 0;
        gm_complex_corners(complex, t, p);
        bool obtuse = false;
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            const double ax = p[2 * a] - p[2 * k], ay = p[2 * a + 1] - p[2 * k + 1];
            const double bx = p[2 * b] - p[2 * k], by = p[2 * b + 1] - p[2 * k + 1];
            const double dot = ax * bx + ay * by, cross = 2 * complex->area[t];
            const double x = bx - ax, y = by - ay;
            const int e = complex->triangle_edge[3 * t + (size_t)a];
            complex->star1[e] += dot / cross / 2;
            complex->length[e] = hypot(x, y);
            share[k] = (x * x + y * y) * dot / cross;
            sum += share[k];
            obtuse |= dot < 0;
            const double angle = atan2(cross, dot) * 180 / M_PI;
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
    double p[6];
    gm_complex_corners(complex, (size_t)triangle, p);
    int a = 0;
    while (complex->triangle_edge[3 * triangle + a] != e) {
        a++;
    }
    const int k = (a + 2) % 3, b = (a + 1) % 3;
    return fabs(atan2(2 * complex->area[triangle],
                      (p[2 * a] - p[2 * k]) * (p[2 * b] - p[2 * k]) +
                          (p[2 * a + 1] - p[2 * k + 1]) * (p[2 * b + 1] - p[2 * k + 1]))) *
           180 / M_PI;
}

static bool check_stars(const struct gm_complex *complex, const long *tags,
                        struct gm_triangulation_fault *fault)
{
    double worst = 0;
    for (size_t e = 0; e < complex->edges; e++) {
        for (int side = 0; complex->star1[e] <= shortest_dual && side < 2; side++) {
            const int t = complex->edge_triangle[2 * e + (size_t)side];
            const double angle = t >= 0 ? angle_facing(complex, t, (int)e) : 0;
            if (angle > worst) {
                worst = angle;
                name_triangle(complex, (size_t)t, tags, fault);
                fault->value = angle;
            }
        }
    }
    if (worst > 0) {
        return fail(fault, GM_TRIANGULATION_NOT_DELAUNAY);
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        if (!(complex->star0[v] > 0)) {
            fault->nodes[0] = tag_of(tags, (int)v);
            return fail(fault, GM_TRIANGULATION_DUAL_CELL);
        }
    }
    return true;
}

/* The dual that is asked for. */
static bool take_star(struct gm_complex *complex, enum gm_star star, const long *tags,
                      struct gm_triangulation_fault *fault)
{
    struct gm_triangulation_fault obstacle = {.kind = GM_TRIANGULATION_OK};
    complex->star = GM_STAR_CIRCUMCENTRIC;
    if ((star == GM_STAR_AUTO || star == GM_STAR_CIRCUMCENTRIC) && check_stars(complex, tags, &obstacle)) {
        return true;
    }
    if (star == GM_STAR_CIRCUMCENTRIC) {
        *fault = obstacle;
        return false;
    }
    complex->star = GM_STAR_BARYCENTRIC;
    memset(complex->star0, 0, complex->vertices * sizeof *complex->star0);
    for (size_t k = 0; k < 3 * complex->triangles; k++) {
        complex->weight[k] = 1.0 / 3;
        complex->star0[complex->triangle[k]] += complex->area[k / 3] / 3;
    }
    return true;
}

size_t gm_complex_loop(const struct gm_complex *complex, size_t boundary_edge)
{
    size_t loop = 0, behind = complex->loops;
    while (behind - loop > 1) {
        const size_t middle = (loop + behind) / 2;
        *(boundary_edge < complex->loop_start[middle] ? &behind : &loop) = middle;
    }
    return loop;
}

size_t gm_complex_next(const struct gm_complex *complex, size_t boundary_edge)
{
    const size_t loop = gm_complex_loop(complex, boundary_edge);
    return boundary_edge + 1 < complex->loop_start[loop + 1] ? boundary_edge + 1 : complex->loop_start[loop];
}

size_t gm_complex_previous(const struct gm_complex *complex, size_t boundary_edge)
{
    const size_t loop = gm_complex_loop(complex, boundary_edge);
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

static bool allocate(struct gm_complex *complex)
{
    const size_t v = complex->vertices, t = complex->triangles, sides = 3 * t;
    const struct {
        void **place;
        size_t size;
    } wanted[] = {
        {(void **)&complex->point, 2 * v * sizeof(double)},
        {(void **)&complex->triangle, sides * sizeof(int)},
        {(void **)&complex->triangle_edge, sides * sizeof(int)},
        {(void **)&complex->triangle_sign, sides},
        {(void **)&complex->edge, 2 * sides * sizeof(int)},
        {(void **)&complex->edge_triangle, 2 * sides * sizeof(int)},
        {(void **)&complex->ring_start, (v + 1) * sizeof(int)},
        {(void **)&complex->ring_vertex, 2 * sides * sizeof(int)},
        {(void **)&complex->ring_edge, 2 * sides * sizeof(int)},
        {(void **)&complex->edge_ring, 2 * sides * sizeof(int)},
        {(void **)&complex->boundary_edge, sides * sizeof(int)},
        {(void **)&complex->boundary_vertex, sides * sizeof(int)},
        {(void **)&complex->loop_start, (sides + 1) * sizeof(size_t)},
        {(void **)&complex->length, sides * sizeof(double)},
        {(void **)&complex->area, t * sizeof(double)},
        {(void **)&complex->weight, sides * sizeof(double)},
        {(void **)&complex->star0, v * sizeof(double)},
        {(void **)&complex->star1, sides * sizeof(double)},
    };
    for (size_t i = 0; i < GM_COUNT(wanted); i++) {
        *wanted[i].place = calloc(1, wanted[i].size);
        if (!*wanted[i].place) {
            return false;
        }
    }
    return true;
}

struct gm_complex *gm_complex_open(const double *points, size_t vertices, const int *triangles, size_t count,
                                   const double period[2], enum gm_star star, const long *tags,
                                   struct gm_triangulation_fault *fault)
{
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_OK};
    if (count == 0) {
        fail(fault, GM_TRIANGULATION_EMPTY);
        return NULL;
    }
    struct gm_complex *complex = calloc(1, sizeof *complex);
    if (!complex) {
        fail(fault, GM_TRIANGULATION_MEMORY);
        return NULL;
    }
    complex->vertices = vertices;
    complex->triangles = count;
    bool good = allocate(complex) || fail(fault, GM_TRIANGULATION_MEMORY);
    struct side *sides = NULL;
    if (good) {
        memcpy(complex->point, points, 2 * vertices * sizeof *points);
        memcpy(complex->triangle, triangles, 3 * count * sizeof *triangles);
        memcpy(complex->period, period, sizeof complex->period);
        good = orient(complex, tags, fault);
    }
    if (good) {
        sides = sort_sides(complex);
        good = sides || fail(fault, GM_TRIANGULATION_MEMORY);
    }
    good = good && make_edges(complex, sides, tags, fault) && make_boundary(complex, tags, fault) &&
           in_one_piece(complex, tags, fault);
    if (good) {
        make_rings(complex);
        measure(complex);
        good = take_star(complex, star, tags, fault);
    }
    free(sides);
    if (!good) {
        gm_complex_close(complex);
        return NULL;
    }
    return complex;
}

void gm_complex_close(struct gm_complex *complex)
{
    if (!complex) {
        return;
    }
    void *const owned[] = {complex->point,         complex->triangle,      complex->triangle_edge,
                           complex->triangle_sign, complex->edge,          complex->edge_triangle,
                           complex->ring_start,    complex->ring_vertex,   complex->ring_edge,
                           complex->edge_ring,     complex->boundary_edge, complex->boundary_vertex,
                           complex->length,        complex->area,          complex->weight,
                           complex->star0,         complex->star1,         complex->loop_start};
    for (size_t i = 0; i < GM_COUNT(owned); i++) {
        free(owned[i]);
    }
    free(complex);
}
