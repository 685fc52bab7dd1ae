/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An acute triangulation of a rectangle by M strips of height h. Even rows of vertices have N + 1 of them, a
   apart; odd rows have N, one above the middle of each edge but near the ends, which keep the distance c from
   the wall, so that the wall's triangle
       (0, 2 k h),   (c, (2 k + 1) h),   (0, (2 k + 2) h)
   is acute. If a/2 < h < c < a, all are: the foot of every apex lies inside its base and splits it into p + q
   <= a with p q <= a^2/4 < h^2.
   On other meshes vertices lie on circles of equal numbers, odd ones turned by half an edge; between two circles
   there are two triangles for each edge. A disc has 6 k vertices on its ring k:
       ring k, vertex j:  R k/n (cos 2 pi j/(6k), sin 2 pi j/(6k)).
   A strip is a row of equilateral triangles. A sphere is the icosahedron (0, +-1, +-g), (+-1, +-g, 0), (+-g, 0, +-1), g = (1 + sqrt(5))/2, each triangle
   of which is cut in four by the middles of its sides, again and again, all put on the sphere. */
#include "core/form/generators.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/residue.h"
#include "core/functions/functions.h"
#include "core/linear/vectors.h"

/* The points and corners that are laid. */
struct laying {
    struct gm_arena *arena;
    double *points; /* 3 a vertex; 2 of a rectangle */
    int *corners;
    size_t vertices, count;
    const double *number; /* of the generator */
    long rows;            /* strips, rings or levels, or circles */
    bool torus;           /* circles around a tube */
    const struct gm_rectangle *rectangle;
};

static void add_point(struct laying *laying, double x, double y, double z)
{
    double *p = laying->points + (laying->rectangle ? 2 : 3) * laying->vertices++;
    p[0] = x;
    p[1] = y;
    if (!laying->rectangle) {
        p[2] = z;
    }
}

static void add_triangle(struct laying *laying, long a, long b, long c)
{
    int *corner = laying->corners + 3 * laying->count++;
    corner[0] = (int)a;
    corner[1] = (int)b;
    corner[2] = (int)c;
}

static void reserve(struct laying *laying, size_t vertices, size_t triangles)
{
    laying->points =
        gm_arena_take(laying->arena, (laying->rectangle ? 2 : 3) * vertices, sizeof *laying->points);
    laying->corners = gm_arena_take(laying->arena, 3 * triangles, sizeof *laying->corners);
}

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

enum { MOST_STRIPS = 1000000 }; /* edges or strips: more make no mesh that a machine holds */

/* The height of a strip in edges. */
static const double best_ratio = 0.758;

long gm_rectangle_edges(const struct gm_rectangle *r)
{
    const double along = r->transposed ? r->height : r->width;
    return (long)fmin(fmax(4, round(best_ratio * along / strip_height(r))), MOST_STRIPS);
}

long gm_rectangle_strips(double width, double height, long edges, bool transposed)
{
    const double along = transposed ? height : width, across = transposed ? width : height;
    const double strips = across / (best_ratio * along / (double)edges);
    return 2 * (long)fmin(fmax(1, round(strips / 2)), MOST_STRIPS);
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

/* Adds a point of the rectangle. */
static void put_point(struct laying *laying, double along, double across)
{
    const bool transposed = laying->rectangle->transposed;
    add_point(laying, transposed ? across : along, transposed ? along : across, 0);
}

/* The first vertex of a row of the rectangle. */
static long row_begin(long n, long row)
{
    return row / 2 * (2 * n + 1) + (row % 2) * (n + 1);
}

static void lay_rectangle(struct laying *laying)
{
    const struct gm_rectangle *r = laying->rectangle;
    const long n = r->edges, m = r->strips;
    const double h = strip_height(r), a = base(r), c = wall_distance(h, a), decay = 0.6;
    /* the far walls have their given places, which N a and M h miss by a rounding */
    const double length = r->transposed ? r->height : r->width, depth = r->transposed ? r->width : r->height;
    /* the bend from the other wall takes a little of c, which matters in short rows alone */
    const double rest = n < 6 ? 1 / (1 - gm_pow(decay, (double)(n - 1))) : 1;
    reserve(laying, (size_t)((m + 1) * (n + 1)), (size_t)(2 * n * m));
    for (long row = 0; row <= m; row++) {
        const double across = row == m ? depth : h * (double)row;
        for (long k = 0; row % 2 == 0 && k <= n; k++) {
            put_point(laying, k == n ? length : a * (double)k, across);
        }
        for (long k = 0; row % 2 == 1 && k < n; k++) {
            const double bend = gm_pow(decay, (double)k) - gm_pow(decay, (double)(n - 1 - k));
            put_point(laying, ((double)k + 0.5) * a + (c - a / 2) * rest * bend, across);
        }
    }
    for (long row = 0; row < m; row++) {
        const long even = row_begin(n, row + row % 2), odd = row_begin(n, row + 1 - row % 2);
        for (long k = 0; k < n; k++) {
            add_triangle(laying, even + k, even + k + 1, odd + k);
        }
        for (long k = 0; k + 1 < n; k++) {
            add_triangle(laying, odd + k, odd + k + 1, even + k + 1);
        }
        if (row % 2 == 1) {
            const long below = row_begin(n, row - 1), middle = row_begin(n, row),
                       above = row_begin(n, row + 1);
            add_triangle(laying, below, middle, above);
            add_triangle(laying, below + n, middle + n - 1, above + n);
        }
    }
}

static void lay_flat_torus(struct laying *laying)
{
    const struct gm_rectangle *r = laying->rectangle;
    const long n = r->edges, m = r->strips;
    const double h = strip_height(r), a = base(r);
    reserve(laying, (size_t)(m * n), (size_t)(2 * n * m));
    for (long row = 0; row < m; row++) {
        for (long k = 0; k < n; k++) {
            put_point(laying, ((double)k + (row % 2 ? 0.5 : 0)) * a, h * (double)row);
        }
    }
    for (long row = 0; row < m; row++) {
        const long here = row * n, above = (row + 1) % m * n, shift = row % 2;
        for (long k = 0; k < n; k++) {
            const long next = (k + 1) % n, top = (k + shift) % n, top_before = (k + shift + n - 1) % n;
            add_triangle(laying, here + k, here + next, above + top);
            add_triangle(laying, here + k, above + top, above + top_before);
        }
    }
}

/* The same meshes on every machine. */
static double random_in_unit(uint64_t *state)
{
    const uint64_t bits = gm_mixed(*state);
    *state += UINT64_C(0x9e3779b97f4a7c15);
    return (double)(bits >> 11) * 0x1p-53;
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

static double largest_angle(const struct laying *laying, const double *points, size_t triangle)
{
    const struct gm_rectangle *r = laying->rectangle;
    struct gm_complex one = {.coordinates = 2,
                             .point = (double *)(uintptr_t)points,
                             .triangle = laying->corners,
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
static void jiggle(struct laying *laying, const struct gm_complex *regular)
{
    enum { ROUNDS = 40 };
    const struct gm_rectangle *r = laying->rectangle;
    const size_t n = laying->vertices;
    double *shift = gm_arena_take(laying->arena, 2 * n, sizeof *shift),
           *moved = gm_arena_take(laying->arena, 2 * n, sizeof *moved);
    const double widest = fmax(88, regular->largest_angle + 1e-6);
    uint64_t state = 2018;
    for (size_t v = 0; v < n; v++) {
        const double *p = laying->points + 2 * v;
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
            moved[i] = laying->points[i] + shift[i];
        }
        for (size_t t = 0; t < laying->count; t++) {
            if (largest_angle(laying, moved, t) <= widest) {
                continue;
            }
            for (int k = 0; k < 3; k++) {
                double *s = shift + 2 * laying->corners[3 * t + (size_t)k];
                bad |= s[0] != 0 || s[1] != 0;
                s[0] *= round < ROUNDS ? 0.6 : 0;
                s[1] *= round < ROUNDS ? 0.6 : 0;
            }
        }
    }
    memcpy(laying->points, moved, 2 * n * sizeof *moved);
}

/* Lays the circles of an annulus or a torus, odd ones turned by half an edge, and joins them to the next; of a torus
   the last to the first. */
static void lay_circles(struct laying *laying)
{
    const bool torus = laying->torus;
    const double p = laying->number[0], q = laying->number[1];
    const long n = (long)laying->number[2], m = laying->rows, circles = m + !torus;
    reserve(laying, (size_t)(circles * n), (size_t)(2 * m * n));
    for (long j = 0; j < circles; j++) {
        const double tube = 2 * M_PI * (double)j / (double)m,
                     r = torus   ? p + q * gm_cos(tube)
                         : j < m ? p * gm_pow(q / p, (double)j / (double)m)
                                 : q;
        for (long i = 0; i < n; i++) {
            const double a = 2 * M_PI * ((double)i + (j % 2 ? 0.5 : 0)) / (double)n;
            add_point(laying, r * gm_cos(a), r * gm_sin(a), torus ? q * gm_sin(tube) : 0);
        }
    }
    for (long j = 0; j < m; j++) {
        const long here = j * n, above = (j + 1) % circles * n, odd = j % 2;
        for (long i = 0; i < n; i++) {
            const long next = (i + 1) % n;
            add_triangle(laying, here + i, here + next, above + (odd ? next : i));
            add_triangle(laying, above + next, above + i, here + (odd ? i : next));
        }
    }
}

static void lay_disc(struct laying *laying)
{
    const long n = laying->rows;
    reserve(laying, (size_t)(1 + 3 * n * (n + 1)), (size_t)(6 * n * n));
    add_point(laying, 0, 0, 0);
    for (long k = 1; k <= n; k++) {
        const long outer = 1 + 3 * k * (k - 1), inner = k > 1 ? 1 + 3 * (k - 1) * (k - 2) : 0,
                   within = k > 1 ? 6 * (k - 1) : 1;
        for (long j = 0; j < 6 * k; j++) {
            const double r = laying->number[0] * (double)k / (double)n,
                         a = 2 * M_PI * (double)j / (double)(6 * k);
            add_point(laying, r * gm_cos(a), r * gm_sin(a), 0);
            /* sector s, the i-th edge of the ring in it */
            const long s = j / k, i = j % k, next = outer + (j + 1) % (6 * k);
            add_triangle(laying, inner + (s * (k - 1) + i) % within, outer + j, next);
            if (i > 0) {
                add_triangle(laying, inner + (s * (k - 1) + i) % within,
                             inner + (s * (k - 1) + i - 1) % within, outer + j);
            }
        }
    }
}

/* Equilateral triangles of one side in a row, every other one on its top; the lower points first. */
static void lay_strip(struct laying *laying)
{
    const long n = laying->rows, lower = (n + 3) / 2;
    const double side = laying->number[0];
    reserve(laying, (size_t)n + 2, (size_t)n);
    for (long v = 0; v < n + 2; v++) {
        const bool above = v >= lower;
        add_point(laying, side * (above ? (double)(v - lower) + 0.5 : (double)v),
                  above ? side * sqrt(3) / 2 : 0, 0);
    }
    for (long k = 0; k < n; k++) {
        const long j = k / 2;
        add_triangle(laying, j + k % 2, k % 2 ? lower + j + 1 : j + 1, lower + j);
    }
}

static void put_on_sphere(double *p, double radius)
{
    const double length = sqrt(gm_dot(p, p));
    for (int c = 0; c < 3; c++) {
        p[c] *= radius / length;
    }
}

/* Cuts every triangle in four. */
static void refine(struct laying *laying, double radius)
{
    const struct laying coarse = *laying;
    struct gm_triangulation_fault fault;
    struct gm_complex *complex = gm_complex_open(&(struct gm_triangles){.points = coarse.points,
                                                                        .in_space = true,
                                                                        .vertices = coarse.vertices,
                                                                        .corners = coarse.corners,
                                                                        .count = coarse.count},
                                                 &fault);
    gm_arena_keep(laying->arena, complex, gm_complex_close);
    reserve(laying, coarse.vertices + complex->edges, 4 * coarse.count);
    memcpy(laying->points, coarse.points, 3 * coarse.vertices * sizeof *coarse.points);
    for (size_t e = 0; e < complex->edges; e++) {
        const double *p = coarse.points + 3 * complex->edge[2 * e],
                     *q = coarse.points + 3 * complex->edge[2 * e + 1];
        add_point(laying, (p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2);
        put_on_sphere(laying->points + 3 * (laying->vertices - 1), radius);
    }
    laying->count = 0;
    for (size_t t = 0; t < coarse.count; t++) {
        const int *v = coarse.corners + 3 * t;
        long m[3];
        for (int k = 0; k < 3; k++) {
            m[k] = (long)coarse.vertices + gm_complex_edge(complex, v[k], v[(k + 1) % 3]);
        }
        add_triangle(laying, v[0], m[0], m[2]);
        add_triangle(laying, v[1], m[1], m[0]);
        add_triangle(laying, v[2], m[2], m[1]);
        add_triangle(laying, m[0], m[1], m[2]);
    }
    gm_arena_drop(laying->arena, complex);
}

static void lay_sphere(struct laying *laying)
{
    const double g = (1 + sqrt(5)) / 2, radius = laying->number[0];
    reserve(laying, 12, 20);
    for (int axis = 0; axis < 3; axis++) {
        for (int k = 0; k < 4; k++) {
            double p[3] = {0, 0, 0};
            p[(axis + 1) % 3] = k & 2 ? -1 : 1;
            p[(axis + 2) % 3] = k & 1 ? -g : g;
            put_on_sphere(p, radius);
            add_point(laying, p[0], p[1], p[2]);
        }
    }
    /* the faces are the triples of neighbours, which are 2/sqrt(1 + g^2) radii apart */
    const double edge = 2 / sqrt(1 + g * g) * radius * 1.01;
    for (int a = 0; a < 12; a++) {
        for (int b = a + 1; b < 12; b++) {
            for (int c = b + 1; c < 12; c++) {
                const int corner[4] = {a, b, c, a};
                double side[3];
                bool near = true;
                for (int k = 0; k < 3; k++) {
                    gm_subtract(laying->points + 3 * corner[k], laying->points + 3 * corner[k + 1], side);
                    near &= gm_length(side) < edge;
                }
                if (near) {
                    add_triangle(laying, a, b, c);
                }
            }
        }
    }
    for (long level = 0; level < laying->rows; level++) {
        refine(laying, radius);
    }
}

enum which { RECTANGLE, FLAT_TORUS, DISC, ANNULUS, SPHERE, TORUS, STRIP, GENERATORS };

static const struct {
    const char *word, *numbers;
    size_t least, most; /* how many numbers */
    size_t lengths;     /* the first of them are lengths; the others are whole numbers */
    long lowest, highest;
    size_t rows; /* the place of the number of rows, which may be missing */
    /* The fewest rows, which come in pairs if they are `even`, and the fewest vertices of one. */
    long fewest, around;
    bool even;
    void (*lay)(struct laying *laying);
} generators[GENERATORS] = {
    {"rectangle", "W H N [M [irregular]]", 3, 5, 2, 1, 4000, 3, 2, 1, true, lay_rectangle},
    {"flat-torus", "W H N [M [irregular]]", 3, 5, 2, 1, 4000, 3, 4, 3, true, lay_flat_torus},
    {"disc", "R n", 2, 2, 1, 1, 4000, 1, 0, 0, false, lay_disc},
    {"annulus", "R1 R2 N [m]", 3, 4, 2, 1, 4000, 3, 1, 3, false, lay_circles},
    {"sphere", "R level", 2, 2, 1, 0, 9, 1, 0, 0, false, lay_sphere},
    {"torus", "R r N [M]", 3, 4, 2, 1, 4000, 3, 4, 3, true, lay_circles},
    {"strip", "L n", 2, 2, 1, 1, 4000, 1, 0, 0, false, lay_strip},
};

static enum which which_of(const char *word)
{
    size_t i = 0;
    while (i < GENERATORS && strcmp(generators[i].word, word) != 0) {
        i++;
    }
    return (enum which)i;
}

static long rows_of(enum which which, const double *number, size_t count)
{
    const double n = count > 2 ? number[2] : 0;
    if (count > generators[which].rows && number[generators[which].rows] > 0) { /* 0: the best number */
        return (long)number[generators[which].rows];
    }
    return which == RECTANGLE ? gm_rectangle_strips(number[0], number[1], (long)n, false)
           : which == ANNULUS ? lround(n * gm_log(number[1] / number[0]) / (2 * M_PI) / (sqrt(3) / 2))
                              : 2 * lround(n * number[1] / (sqrt(3) * number[0]));
}

static struct gm_rectangle rectangle_of(enum which which, const double *number, size_t count)
{
    return (struct gm_rectangle){.width = number[0],
                                 .height = number[1],
                                 .edges = (long)number[2],
                                 .strips = rows_of(which, number, count),
                                 .torus = which == FLAT_TORUS,
                                 .irregular = count > 4 ? number[4] : 0};
}

/* Refuses the strips of a rectangle with the numbers of them that make acute triangles. */
static bool refuse_strips(const struct gm_rectangle *rectangle, size_t place, struct gm_fault *fault)
{
    long least = 0, most = 0;
    struct gm_rectangle other = *rectangle;
    for (other.strips = 2; other.strips <= generators[RECTANGLE].highest; other.strips += 2) {
        if (gm_rectangle_is_acute(&other)) {
            least = least > 0 ? least : other.strips;
            most = other.strips;
        }
    }
    if (least == 0) {
        return gm_fail(
            fault, place,
            "mesh: rectangle: %ld edges and %ld strips do not make acute triangles; with %ld strips it "
            "takes about %ld edges",
            rectangle->edges, rectangle->strips, rectangle->strips, gm_rectangle_edges(rectangle));
    }
    return gm_fail(fault, place, "mesh: rectangle: with %ld edges it takes %ld to %ld strips, not %ld",
                   rectangle->edges, least, most, rectangle->strips);
}

bool gm_generator_check(const char *word, const double *number, size_t count, size_t place,
                        struct gm_fault *fault)
{
    const enum which which = which_of(word);
    if (which == GENERATORS) {
        return gm_fail(fault, place,
                       "mesh: there is no mesh %.40s: rectangle W H N, flat-torus W H N, disc R n, "
                       "annulus R1 R2 N, sphere R level, torus R r N and strip L n are made",
                       word);
    }
    if (count < generators[which].least || count > generators[which].most) {
        return gm_fail(fault, place, "mesh: %s has the numbers %s", word, generators[which].numbers);
    }
    for (size_t i = 0; i < count && i < 4; i++) {
        const long lowest = generators[which].lowest, highest = generators[which].highest;
        const bool whole = i >= generators[which].lengths;
        if (!whole && !(number[i] > 0 && isfinite(number[i]))) {
            return gm_fail(fault, place, "mesh: %s: %g is not a length: it has to be above 0", word,
                           number[i]);
        }
        const bool best = i == generators[which].rows && number[i] == 0 && generators[which].even;
        if (whole && !best &&
            !(number[i] == floor(number[i]) && number[i] >= (double)lowest && number[i] <= (double)highest)) {
            const bool within = number[i] > (double)lowest && number[i] < (double)highest;
            return within ? gm_fail(fault, place, "mesh: %s: %g is not a whole number", word, number[i])
                          : gm_fail(fault, place, "mesh: %s: %g is not a whole number from %ld to %ld", word,
                                    number[i], lowest, highest);
        }
    }
    if (count > 4 && !(number[4] >= 0 && number[4] < 0.5)) {
        return gm_fail(fault, place, "mesh: %s: vertices are moved by %g of an edge: it has to be below 1/2",
                       word, number[4]);
    }
    const long rows = rows_of(which, number, count);
    if (which == ANNULUS && number[1] <= number[0]) {
        return gm_fail(fault, place, "mesh: annulus: its outer radius %g has to be above the inner one %g",
                       number[1], number[0]);
    }
    if (which == TORUS && number[0] <= number[1]) {
        return gm_fail(fault, place, "mesh: torus: its radius %g has to be above that of its tube, %g",
                       number[0], number[1]);
    }
    if ((generators[which].even && rows % 2 != 0) || rows < generators[which].fewest ||
        (count > 2 && number[2] < (double)generators[which].around)) {
        return gm_fail(fault, place, "mesh: %s: %ld rows of %g are too few, or not an even number", word,
                       rows, number[2]);
    }
    if (which != RECTANGLE) {
        return true;
    }
    const struct gm_rectangle pattern = rectangle_of(which, number, count);
    return gm_rectangle_is_acute(&pattern) || refuse_strips(&pattern, place, fault);
}

/* The mesh while it is made. */
struct making {
    struct laying laying;
    void (*lay)(struct laying *laying);
    struct gm_triangles from;
    struct gm_triangulation_fault *fault;
    struct gm_complex *complex;
};

static void make(struct gm_arena *arena, void *data)
{
    struct making *making = data;
    struct laying *laying = &making->laying;
    struct gm_triangles *from = &making->from;
    laying->arena = arena;
    making->lay(laying);
    from->points = laying->points;
    from->vertices = laying->vertices;
    from->corners = laying->corners;
    from->count = laying->count;
    struct gm_complex *complex = gm_complex_open(from, making->fault);
    if (complex && laying->rectangle && laying->rectangle->irregular > 0) {
        gm_arena_keep(arena, complex, gm_complex_close);
        making->fault->kind = GM_TRIANGULATION_MEMORY;
        jiggle(laying, complex);
        gm_arena_drop(arena, complex);
        complex = gm_complex_open(from, making->fault);
    }
    making->complex = complex;
}

static struct gm_complex *open_complex(struct making making)
{
    *making.fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY};
    gm_arena_run_once(make, &making);
    return making.complex;
}

struct gm_complex *gm_rectangle_open(const struct gm_rectangle *r, struct gm_triangulation_fault *fault)
{
    return open_complex(
        (struct making){.laying.rectangle = r,
                        .lay = generators[r->torus ? FLAT_TORUS : RECTANGLE].lay,
                        .from = {.period = {r->torus ? r->width : 0, r->torus ? r->height : 0},
                                 .star = r->star ? r->star : GM_STAR_CIRCUMCENTRIC},
                        .fault = fault});
}

/* The parts of the boundary of a mesh that is made, as groups. */
struct naming {
    struct gm_triangulation *mesh;
    enum which which;
    const double *number;
};

/* The part, from 1, of an edge of the boundary with this middle. */
static int part_of(const struct naming *naming, const double middle[3])
{
    const double *number = naming->number;
    const bool sides[] = {middle[0] == 0, middle[0] == number[0], middle[1] == 0, true};
    int part = 0;
    while (naming->which == RECTANGLE && !sides[part]) {
        part++;
    }
    return 1 + part + (naming->which == ANNULUS && gm_hypot(middle[0], middle[1]) > number[0] * 1.001);
}

static void name_parts(struct gm_arena *arena, void *data)
{
    static const char *const parts[GENERATORS][5] = {
        [RECTANGLE] = {"left", "right", "bottom", "top"}, [DISC] = {"rim"}, [ANNULUS] = {"inner", "outer"}};
    const struct naming *naming = data;
    struct gm_triangulation *mesh = naming->mesh;
    const struct gm_complex *complex = mesh->complex;
    const char *const *names = parts[naming->which];
    struct gm_triangulation_member *members = gm_arena_take(arena, complex->boundary + 1, sizeof *members);
    mesh->group = gm_arena_take(arena, GM_COUNT(parts[0]), sizeof *mesh->group);
    for (; names[mesh->groups]; mesh->groups++) {
        struct gm_triangulation_group *group = &mesh->group[mesh->groups];
        group->tag = (long)mesh->groups + 1;
        snprintf(group->name, sizeof group->name, "%s", names[mesh->groups]);
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        double middle[3], end[3];
        members[b].edge = complex->boundary_edge[b];
        gm_complex_vertex(complex, (size_t)complex->edge[2 * members[b].edge], middle);
        gm_complex_vertex(complex, (size_t)complex->edge[2 * members[b].edge + 1], end);
        for (int c = 0; c < 3; c++) {
            middle[c] = (middle[c] + end[c]) / 2;
        }
        members[b].tag = names[0] ? part_of(naming, middle) : 0;
    }
    gm_triangulation_join(mesh, members, complex->boundary);
}

bool gm_generator_open(const char *word, const double *number, size_t count, enum gm_star star,
                       struct gm_triangulation *mesh, struct gm_triangulation_fault *fault)
{
    const enum which which = which_of(word);
    struct gm_rectangle rectangle;
    if (which <= FLAT_TORUS) {
        rectangle = rectangle_of(which, number, count);
        rectangle.star = star;
    }
    *mesh = (struct gm_triangulation){
        .complex = which <= FLAT_TORUS
                       ? gm_rectangle_open(&rectangle, fault)
                       : open_complex((struct making){.laying = {.number = number,
                                                                 .rows = rows_of(which, number, count),
                                                                 .torus = which == TORUS},
                                                      .lay = generators[which].lay,
                                                      .from = {.in_space = true, .star = star},
                                                      .fault = fault})};
    mesh->arena = mesh->complex ? gm_arena_open() : NULL;
    if (mesh->complex && !gm_arena_run(mesh->arena, name_parts, &(struct naming){mesh, which, number})) {
        fault->kind = GM_TRIANGULATION_MEMORY;
        gm_triangulation_close(mesh);
    }
    return mesh->complex;
}
