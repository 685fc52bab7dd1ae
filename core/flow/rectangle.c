/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An acute triangulation of a rectangle by M strips of height h. Even rows of vertices have N + 1 of them, a
   apart; odd rows have N, one above the middle of each edge but near the ends, which keep the distance c from
   the wall, so that the wall's triangle
       (0, 2 k h),   (c, (2 k + 1) h),   (0, (2 k + 2) h)
   is acute. If a/2 < h < c < a, all are: the foot of every apex lies inside its base and splits it into p + q
   <= a with p q <= a^2/4 < h^2. */
#include "core/flow/rectangle.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"

static double strip_height(const struct gm_rectangle *r)
{
    return (r->transposed ? r->width : r->height) / (double)r->strips;
}

static double base(const struct gm_rectangle *r)
{
    return (r->transposed ? r->height : r->width) / (double)r->edges;
}

bool gm_rectangle_is_acute(const struct gm_rectangle *r)
{
    const double h = strip_height(r), a = base(r);
    return h > a / 2 * (1 + 1e-9) && h < a * (1 - 1e-9);
}

enum { MOST = 1000000 }; /* edges or strips: more make no mesh that a machine holds */

/* The height of a strip in edges. */
static const double best_ratio = 0.758;

long gm_rectangle_edges(const struct gm_rectangle *r)
{
    const double along = r->transposed ? r->height : r->width;
    return (long)fmin(fmax(4, round(best_ratio * along / strip_height(r))), MOST);
}

long gm_rectangle_strips(double width, double height, long edges, bool transposed)
{
    const double along = transposed ? height : width, across = transposed ? width : height;
    const double strips = across / (best_ratio * along / (double)edges);
    return 2 * (long)fmin(fmax(1, round(strips / 2)), MOST);
}

/* c such that the wall triangle's apex and the corner beside it are equally wide. */
static double wall_distance(double h, double a)
{
    double low = h, high = a;
    for (int i = 0; i < 100; i++) {
        const double c = (low + high) / 2;
        const bool far = 2 * gm_atan(h / c) < gm_atan(h / (a - c));
        low = far ? low : c;
        high = far ? c : high;
    }
    return (low + high) / 2;
}

struct pattern {
    double *points;
    int *triangles;
    size_t vertices, count;
};

static void add_point(struct pattern *pattern, const struct gm_rectangle *r, double along, double across)
{
    double *p = pattern->points + 2 * pattern->vertices++;
    p[0] = r->transposed ? across : along;
    p[1] = r->transposed ? along : across;
}

static void add_triangle(struct pattern *pattern, long a, long b, long c)
{
    int *t = pattern->triangles + 3 * pattern->count++;
    t[0] = (int)a;
    t[1] = (int)b;
    t[2] = (int)c;
}

/* The first vertex of a row of the rectangle. */
static long row_begin(long n, long row)
{
    return row / 2 * (2 * n + 1) + (row % 2) * (n + 1);
}

static void lay_rectangle(struct pattern *pattern, const struct gm_rectangle *r)
{
    const long n = r->edges, m = r->strips;
    const double h = strip_height(r), a = base(r), c = wall_distance(h, a), decay = 0.6;
    /* the far walls have their given places, which N a and M h miss by a rounding */
    const double length = r->transposed ? r->height : r->width, depth = r->transposed ? r->width : r->height;
    /* the bend from the other wall takes a little of c, which matters in short rows alone */
    const double rest = n < 6 ? 1 / (1 - gm_pow(decay, (double)(n - 1))) : 1;
    for (long row = 0; row <= m; row++) {
        const double across = row == m ? depth : h * (double)row;
        for (long k = 0; row % 2 == 0 && k <= n; k++) {
            add_point(pattern, r, k == n ? length : a * (double)k, across);
        }
        for (long k = 0; row % 2 == 1 && k < n; k++) {
            const double bend = gm_pow(decay, (double)k) - gm_pow(decay, (double)(n - 1 - k));
            add_point(pattern, r, ((double)k + 0.5) * a + (c - a / 2) * rest * bend, across);
        }
    }
    for (long row = 0; row < m; row++) {
        const long even = row_begin(n, row + row % 2), odd = row_begin(n, row + 1 - row % 2);
        for (long k = 0; k < n; k++) {
            add_triangle(pattern, even + k, even + k + 1, odd + k);
        }
        for (long k = 0; k + 1 < n; k++) {
            add_triangle(pattern, odd + k, odd + k + 1, even + k + 1);
        }
        if (row % 2 == 1) {
            const long below = row_begin(n, row - 1), middle = row_begin(n, row),
                       above = row_begin(n, row + 1);
            add_triangle(pattern, below, middle, above);
            add_triangle(pattern, below + n, middle + n - 1, above + n);
        }
    }
}

static void lay_torus(struct pattern *pattern, const struct gm_rectangle *r)
{
    const long n = r->edges, m = r->strips;
    const double h = strip_height(r), a = base(r);
    for (long row = 0; row < m; row++) {
        for (long k = 0; k < n; k++) {
            add_point(pattern, r, ((double)k + (row % 2 ? 0.5 : 0)) * a, h * (double)row);
        }
    }
    for (long row = 0; row < m; row++) {
        const long here = row * n, above = (row + 1) % m * n, shift = row % 2;
        for (long k = 0; k < n; k++) {
            const long next = (k + 1) % n, top = (k + shift) % n, top_before = (k + shift + n - 1) % n;
            add_triangle(pattern, here + k, here + next, above + top);
            add_triangle(pattern, here + k, above + top, above + top_before);
        }
    }
}

/* splitmix64: the same meshes on every machine */
static double random_in_unit(uint64_t *state)
{
    uint64_t z = (*state += UINT64_C(0x9e3779b97f4a7c15));
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static bool is_fixed(const struct gm_rectangle *r, const double *p)
{
    for (size_t i = 0; i < r->fixed_count; i++) {
        if (gm_hypot(p[0] - r->fixed[2 * i], p[1] - r->fixed[2 * i + 1]) < 1e-9 * (r->width + r->height)) {
            return true;
        }
    }
    return false;
}

static double largest_angle(const struct gm_rectangle *r, const struct pattern *pattern, const double *points,
                            size_t triangle)
{
    struct gm_complex one = {.point = (double *)(uintptr_t)points,
                             .triangle = pattern->triangles,
                             .period = {r->torus ? r->width : 0, r->torus ? r->height : 0}};
    double p[6], largest = 0;
    gm_complex_corners(&one, triangle, p);
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        const double ax = p[2 * i] - p[2 * k], ay = p[2 * i + 1] - p[2 * k + 1];
        const double bx = p[2 * j] - p[2 * k], by = p[2 * j + 1] - p[2 * k + 1];
        largest = fmax(largest, gm_atan2(fabs(ax * by - ay * bx), ax * bx + ay * by));
    }
    return largest * 180 / M_PI;
}

/* Moves the vertices at random, those on a wall along it, and takes back what makes an angle too wide. */
static bool jiggle(struct pattern *pattern, const struct gm_rectangle *r, const struct gm_complex *regular)
{
    enum { ROUNDS = 40 };
    const size_t n = pattern->vertices;
    double *shift = calloc(2 * n, sizeof *shift), *moved = malloc(2 * n * sizeof *moved);
    const double widest = fmax(88, regular->largest_angle + 1e-6);
    uint64_t state = 2018;
    if (!shift || !moved) {
        free(shift);
        free(moved);
        return false;
    }
    for (size_t v = 0; v < n; v++) {
        const double *p = pattern->points + 2 * v;
        double shortest = INFINITY;
        for (int k = regular->ring_start[v]; k < regular->ring_start[v + 1]; k++) {
            shortest = fmin(shortest, regular->length[regular->ring_edge[k]]);
        }
        const double turn = 2 * M_PI * random_in_unit(&state);
        const double far = r->irregular * shortest * sqrt(random_in_unit(&state));
        const bool side = !r->torus && (p[0] == 0 || p[0] == r->width);
        const bool floor_or_lid = !r->torus && (p[1] == 0 || p[1] == r->height);
        if ((side && floor_or_lid) || is_fixed(r, p)) {
            continue;
        }
        shift[2 * v] = side ? 0 : far * gm_cos(turn);
        shift[2 * v + 1] = floor_or_lid ? 0 : far * gm_sin(turn);
    }
    bool bad = true;
    for (int round = 0; bad; round++) {
        bad = false;
        for (size_t i = 0; i < 2 * n; i++) {
            moved[i] = pattern->points[i] + shift[i];
        }
        for (size_t t = 0; t < pattern->count; t++) {
            if (largest_angle(r, pattern, moved, t) <= widest) {
                continue;
            }
            for (int k = 0; k < 3; k++) {
                double *s = shift + 2 * pattern->triangles[3 * t + (size_t)k];
                bad |= s[0] != 0 || s[1] != 0;
                s[0] *= round < ROUNDS ? 0.6 : 0;
                s[1] *= round < ROUNDS ? 0.6 : 0;
            }
        }
    }
    memcpy(pattern->points, moved, 2 * n * sizeof *moved);
    free(shift);
    free(moved);
    return true;
}

struct gm_complex *gm_rectangle_open(const struct gm_rectangle *r, struct gm_triangulation_fault *fault)
{
    const size_t n = (size_t)r->edges, m = (size_t)r->strips;
    struct pattern pattern = {.points = malloc(2 * (m + 1) * (n + 1) * sizeof(double)),
                              .triangles = malloc(3 * 2 * n * m * sizeof(int))};
    struct gm_triangles from = {.points = pattern.points,
                                .corners = pattern.triangles,
                                .period = {r->torus ? r->width : 0, r->torus ? r->height : 0},
                                .star = GM_STAR_CIRCUMCENTRIC};
    struct gm_complex *complex = NULL;
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY};
    if (pattern.points && pattern.triangles) {
        if (r->torus) {
            lay_torus(&pattern, r);
        } else {
            lay_rectangle(&pattern, r);
        }
        from.vertices = pattern.vertices;
        from.count = pattern.count;
        complex = gm_complex_open(&from, fault);
    }
    if (complex && r->irregular > 0) {
        const bool moved = jiggle(&pattern, r, complex);
        gm_complex_close(complex);
        complex = NULL;
        *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY};
        if (moved) {
            complex = gm_complex_open(&from, fault);
        }
    }
    free(pattern.points);
    free(pattern.triangles);
    return complex;
}
