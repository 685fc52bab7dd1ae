/* SPDX-License-Identifier: GPL-3.0-or-later */
/* X_k = sum_j x_j w^(jk), w = exp(-2 pi i / n), by passes: with n = r m and j = p + m a, k = b + r c,
       X_(b + r c) = sum_p w^(r c p) [w^(b p) sum_a exp(-2 pi i a b / r) x_(p + m a)],
   transforms of the length r, a turn by w^(b p), and r transforms of the length m, which are passed on side by
   side: the pass on s of them reads x_(q + s (p + m a)) and writes to q + s (b + r p), so that the result is in
   order (Stockham). T.G. Stockham, AFIPS Conf. Proc. 28 (1966) 229; C. Van Loan, Computational Frameworks for
   the Fast Fourier Transform, SIAM 1992, 1.7. Factors: 8, 4, 2, and odd ones, in pairs a and r - a.
   Where a prime factor is large, by the chirp z transform: with jk = (j^2 + k^2 - (k - j)^2)/2,
       X_k = v_k sum_j (x_j v_j) conj(v_(k-j)),  v_j = exp(-i pi j^2 / n),
   a convolution, which two transforms of another length make. L.I. Bluestein, IEEE Trans. Audio Electroacoust.
   18 (1970) 451.
   Of real x and an even n = 2 h, Z is the transform of z_j = x_(2j) + i x_(2j+1), and
       X_k = (Z_k + conj Z_(h-k))/2 - i w^k (Z_k - conj Z_(h-k))/2.
   Only + - * / of doubles, in one order: the bits are the same on every processor. */
#include "core/linear/fourier.h"

#include <complex.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/basics.h"

/* Odd factors above LARGEST_FACTOR cost more than the chirp. TILE: numbers that a pass holds at once. */
enum { LARGEST_FACTOR = 31, HALF_FACTOR = LARGEST_FACTOR / 2, MOST_PASSES = 64, TILE = 8, LINE = 64 };
#define INLINE static inline __attribute__((always_inline))

/* Complex numbers, real and imaginary parts apart: vectors need no shuffles. */
struct split {
    double *re, *im;
};

struct pass {
    size_t radix, m, s;
    struct split turns;  /* w^(b p), [b - 1][p], or [b - 1][q + s p] where along_p */
    struct split circle; /* exp(-2 pi i a / radix) */
    bool along_p;
    void (*apply)(const struct pass *pass, struct split x, struct split y);
};

struct gm_fourier {
    struct gm_arena *arena;
    size_t count, passes; /* no passes of a count above 1: by the chirp */
    struct pass pass[MOST_PASSES];
    struct split level[2]; /* count of each */
    struct chirp *chirp;
};

struct chirp {
    struct gm_fourier *fourier; /* of the convolution */
    struct split v, kernel;     /* kernel: the transform of conj(v), over the convolution's length */
};

/* ---- roots of unity, in pairs of doubles ---- */

/* An unevaluated sum, |low| <= ulp(high) / 2. T.J. Dekker, Numer. Math. 18 (1971) 224. */
struct pair {
    double high, low;
};

static struct pair sum_exactly(double a, double b)
{
    const double sum = a + b, part = sum - a;
    return (struct pair){sum, (a - (sum - part)) + (b - part)};
}

static struct pair multiply_exactly(double a, double b)
{
    const double split = 0x1p27 + 1, ca = split * a, cb = split * b;
    const double a1 = ca - (ca - a), a2 = a - a1, b1 = cb - (cb - b), b2 = b - b1, product = a * b;
    return (struct pair){product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

static struct pair add(struct pair a, struct pair b)
{
    const struct pair sum = sum_exactly(a.high, b.high);
    return sum_exactly(sum.high, sum.low + (a.low + b.low));
}

static struct pair multiply(struct pair a, struct pair b)
{
    const struct pair product = multiply_exactly(a.high, b.high);
    return sum_exactly(product.high, product.low + (a.high * b.low + a.low * b.high));
}

static struct pair divide(struct pair a, double b)
{
    const double first = a.high / b;
    const struct pair product = multiply_exactly(first, b);
    return sum_exactly(first, ((a.high - product.high) - product.low + a.low) / b);
}

struct root {
    struct pair re, im;
};

/* exp(-2 pi i k / n) by Taylor's series at an angle of at most pi: after 40 terms, or one below 2^-110, less than 1e-28 is
   left. */
static struct root root_of(size_t k, size_t n)
{
    enum { TERMS = 40 };
    const struct pair turn = {-0x1.921fb54442d18p+2, -0x1.1a62633145c07p-52};
    const double part = 2 * k > n ? -(double)(n - k) : (double)k;
    const struct pair angle = divide(multiply(turn, (struct pair){part, 0}), (double)n);
    struct root root = {{1, 0}, {0, 0}};
    struct pair term = {1, 0};
    for (int j = 1; j <= TERMS && fabs(term.high) > 0x1p-110; j++) {
        term = divide(multiply(term, angle), j);
        struct pair *to = j % 2 ? &root.im : &root.re;
        const struct pair minus = {-term.high, -term.low};
        *to = add(*to, j % 4 < 2 ? term : minus);
    }
    return root;
}

/* Roots are at least 2 pi / n or 0. */
static double rounded(struct pair a)
{
    return fabs(a.high) < 0x1p-80 ? 0 : a.high;
}

static struct split take(struct gm_arena *arena, size_t count)
{
    const size_t size = ((count + TILE) * sizeof(double) / LINE + 1) * LINE;
    struct split split;
    split.re = gm_arena_keep(arena, aligned_alloc(LINE, 2 * size), free);
    memset(split.re, 0, 2 * size);
    split.im = split.re + size / sizeof(double);
    return split;
}

/* All exp(-2 pi i k / n), rounded: products of the roots of whole steps and of the roots within one. */
static struct split take_roots(struct gm_arena *arena, size_t n)
{
    const struct split roots = take(arena, n);
    const size_t step = (size_t)sqrt((double)n);
    struct root *within = gm_arena_keep(arena, malloc(step * sizeof *within), free);
    for (size_t k = 0; k < step; k++) {
        within[k] = root_of(k, n);
    }
    for (size_t first = 0; first < n; first += step) {
        const struct root a = root_of(first, n), minus = {{0, 0}, {-a.im.high, -a.im.low}};
        for (size_t k = 0; k < step && first + k < n; k++) {
            const struct root b = within[k];
            roots.re[first + k] = rounded(add(multiply(a.re, b.re), multiply(minus.im, b.im)));
            roots.im[first + k] = rounded(add(multiply(a.re, b.im), multiply(a.im, b.re)));
        }
    }
    gm_arena_drop(arena, within);
    return roots;
}

/* ---- passes ---- */

/* TILE numbers side by side. The compiler makes registers of them, of any processor, lane by lane. */
typedef double lanes __attribute__((vector_size(TILE * sizeof(double))));
typedef double lanes_at
    __attribute__((vector_size(TILE * sizeof(double)), aligned(sizeof(double)), may_alias));

struct tile {
    lanes re, im;
};

INLINE struct tile load(struct split from, size_t at)
{
    return (struct tile){*(const lanes_at *)(from.re + at), *(const lanes_at *)(from.im + at)};
}

INLINE void store(struct split to, size_t at, struct tile a)
{
    *(lanes_at *)(to.re + at) = a.re;
    *(lanes_at *)(to.im + at) = a.im;
}

INLINE struct tile plus(struct tile a, struct tile b)
{
    return (struct tile){a.re + b.re, a.im + b.im};
}

INLINE struct tile minus(struct tile a, struct tile b)
{
    return (struct tile){a.re - b.re, a.im - b.im};
}

/* -i a */
INLINE struct tile turned_right(struct tile a)
{
    return (struct tile){a.im, -a.re};
}

INLINE struct tile times(struct tile a, struct tile b)
{
    return (struct tile){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/* The transforms of z_0 .. z_(radix - 1), which are replaced. */
typedef void butterfly(struct tile *z, size_t radix, struct split circle);

INLINE void by_2(struct tile *z, size_t radix, struct split circle)
{
    (void)radix, (void)circle;
    const struct tile a = z[0];
    z[0] = plus(a, z[1]);
    z[1] = minus(a, z[1]);
}

INLINE void by_4(struct tile *z, size_t radix, struct split circle)
{
    (void)radix, (void)circle;
    const struct tile s = plus(z[0], z[2]), d = minus(z[0], z[2]), t = plus(z[1], z[3]);
    const struct tile e = turned_right(minus(z[1], z[3]));
    z[0] = plus(s, t);
    z[1] = plus(d, e);
    z[2] = minus(s, t);
    z[3] = minus(d, e);
}

/* a / sqrt 2. The root in two parts: of one its error, of one sign, would grow with the steps of a run. */
INLINE struct tile over_root_2(struct tile a)
{
    const double high = 0x1.6a09e667f3bcdp-1, low = -0x1.bdd3413b26456p-55;
    return (struct tile){high * a.re + low * a.re, high * a.im + low * a.im};
}

/* Fours of the even and of the odd ones, these turned by eighths. */
INLINE void by_8(struct tile *z, size_t radix, struct split circle)
{
    struct tile even[4] = {z[0], z[2], z[4], z[6]}, odd[4] = {z[1], z[3], z[5], z[7]};
    by_4(even, radix, circle);
    by_4(odd, radix, circle);
    odd[1] = over_root_2(plus(odd[1], turned_right(odd[1])));
    odd[2] = turned_right(odd[2]);
    odd[3] = over_root_2(minus(turned_right(odd[3]), odd[3]));
    for (size_t b = 0; b < 4; b++) {
        z[b] = plus(even[b], odd[b]);
        z[b + 4] = minus(even[b], odd[b]);
    }
}

/* Cosines times the sums x_a + x_(r-a), and -+ i sines times the differences, make y_b and y_(r-b) together. */
INLINE void by_odd(struct tile *z, size_t radix, struct split circle)
{
    struct tile sum[HALF_FACTOR + 1], difference[HALF_FACTOR + 1];
    const struct tile first = z[0];
    for (size_t a = 1; a <= radix / 2; a++) {
        sum[a] = plus(z[a], z[radix - a]);
        difference[a] = minus(z[a], z[radix - a]);
        z[0] = plus(z[0], sum[a]);
    }
    for (size_t b = 1; b <= radix / 2; b++) {
        struct tile c = first, d = {{0}, {0}};
        for (size_t a = 1, at = b; a <= radix / 2; a++) {
            c.re += circle.re[at] * sum[a].re;
            c.im += circle.re[at] * sum[a].im;
            d.re -= circle.im[at] * difference[a].re;
            d.im -= circle.im[at] * difference[a].im;
            at += at + b < radix ? b : b - radix;
        }
        z[b] = plus(c, turned_right(d));
        z[radix - b] = minus(c, turned_right(d));
    }
}

INLINE void load_legs(struct tile *z, size_t radix, struct split x, size_t from, size_t apart)
{
    for (size_t a = 0; a < radix; a++) {
        z[a] = load(x, from + a * apart);
    }
}

/* Tiles of q, which share p and its turns. */
INLINE void along_q(butterfly *apply, size_t radix, const struct pass *pass, struct split x, struct split y)
{
    const size_t m = pass->m, s = pass->s;
    struct tile z[LARGEST_FACTOR];
    for (size_t p = 0; p < m; p++) {
        for (size_t q = 0; q < s; q += TILE) {
            load_legs(z, radix, x, s * p + q, s * m);
            apply(z, radix, pass->circle);
            for (size_t b = 0; b < radix; b++) {
                const size_t to = q + s * (radix * p + b), turn = (b - 1) * m + p;
                struct tile put = z[b];
                if (b > 0 && m > 1) {
                    const double re = pass->turns.re[turn], im = pass->turns.im[turn];
                    put = (struct tile){put.re * re - put.im * im, put.re * im + put.im * re};
                }
                if (s - q >= TILE) {
                    store(y, to, put);
                } else {
                    for (size_t lane = 0; lane < s - q; lane++) {
                        y.re[to + lane] = put.re[lane];
                        y.im[to + lane] = put.im[lane];
                    }
                }
            }
        }
    }
}

/* Tiles of q + s p, where q has few values. */
INLINE void along_p(butterfly *apply, size_t radix, const struct pass *pass, struct split x, struct split y)
{
    const size_t s = pass->s, all = pass->m * s;
    struct tile z[LARGEST_FACTOR];
    for (size_t i = 0; i < all; i += TILE) {
        load_legs(z, radix, x, i, all);
        apply(z, radix, pass->circle);
        for (size_t b = 1; b < radix; b++) {
            const size_t turn = (b - 1) * all + i;
            z[b] = times(z[b], load(pass->turns, turn));
        }
        const size_t width = all - i < TILE ? all - i : TILE;
        for (size_t lane = 0; lane < width; lane++) {
            const size_t to = (i + lane) % s + s * radix * ((i + lane) / s);
            for (size_t b = 0; b < radix; b++) {
                y.re[to + s * b] = z[b].re[lane];
                y.im[to + s * b] = z[b].im[lane];
            }
        }
    }
}

#define PASS(name, butterfly, radix)                                                                         \
    GM_CLONES static void name(const struct pass *pass, struct split x, struct split y)                      \
    {                                                                                                        \
        if (pass->along_p) {                                                                                 \
            along_p(butterfly, radix, pass, x, y);                                                           \
        } else {                                                                                             \
            along_q(butterfly, radix, pass, x, y);                                                           \
        }                                                                                                    \
    }
PASS(pass_2, by_2, 2)
PASS(pass_3, by_odd, 3)
PASS(pass_4, by_4, 4)
PASS(pass_5, by_odd, 5)
PASS(pass_7, by_odd, 7)
PASS(pass_8, by_8, 8)
PASS(pass_odd, by_odd, pass->radix)

static void copy(struct split from, struct split to, size_t count)
{
    memcpy(to.re, from.re, count * sizeof *to.re);
    memcpy(to.im, from.im, count * sizeof *to.im);
}

/* Transforms x; y is as long. Returns the one that has the result. */
static struct split pass_all(const struct gm_fourier *fourier, struct split x, struct split y)
{
    for (size_t i = 0; i < fourier->passes; i++) {
        const struct split from = x;
        fourier->pass[i].apply(&fourier->pass[i], x, y);
        x = y;
        y = from;
    }
    return x;
}

/* The inverse, without its factor, exchanges real and imaginary parts before and after. */
static struct split exchanged(struct split x)
{
    return (struct split){x.im, x.re};
}

/* ---- plans ---- */

/* A factor of the count that a pass has; 0: none. Large odd ones come last, where loops are long. */
static size_t factor_of(size_t count)
{
    for (size_t p = 3; p <= LARGEST_FACTOR && count % 2 == 1; p += 2) {
        if (count % p == 0) {
            return p;
        }
    }
    const size_t even[] = {8, 4, 2};
    for (size_t i = 0; i < GM_COUNT(even); i++) {
        if (count % even[i] == 0 && count != 16) {
            return even[i];
        }
    }
    return count == 16 ? 4 : 0;
}

static bool factors_well(size_t count)
{
    while (count > 1 && factor_of(count) > 0) {
        count /= factor_of(count);
    }
    return count == 1;
}

/* The least count from here on that is 2^a times 1, 3, 5, 9 or 15. */
static size_t convolution_length(size_t least)
{
    static const size_t odd[] = {1, 3, 5, 9, 15};
    size_t length = 0;
    for (size_t i = 0; i < GM_COUNT(odd); i++) {
        size_t other = odd[i];
        while (other < least) {
            other *= 2;
        }
        length = length == 0 || other < length ? other : length;
    }
    return length;
}

static const struct {
    size_t radix;
    void (*apply)(const struct pass *pass, struct split x, struct split y);
} passes[] = {{2, pass_2}, {3, pass_3}, {4, pass_4}, {5, pass_5}, {7, pass_7}, {8, pass_8}};

static void plan_pass(struct gm_fourier *fourier, struct split roots, size_t s)
{
    const size_t count = fourier->count, radix = factor_of(count / s), m = count / s / radix;
    struct pass *pass = &fourier->pass[fourier->passes++];
    const size_t row = s < TILE ? s * m : m;
    *pass = (struct pass){.radix = radix,
                          .m = m,
                          .s = s,
                          .along_p = s < TILE && m > 1,
                          .turns = take(fourier->arena, (radix - 1) * row)};
    pass->apply = pass_odd;
    for (size_t i = 0; i < GM_COUNT(passes); i++) {
        if (passes[i].radix == radix) {
            pass->apply = passes[i].apply;
        }
    }
    for (size_t i = 0; i < (radix - 1) * row; i++) {
        const size_t b = i / row + 1, p = s < TILE ? i % row / s : i % row;
        pass->turns.re[i] = roots.re[b * p * s];
        pass->turns.im[i] = roots.im[b * p * s];
    }
    pass->circle = take(fourier->arena, radix);
    for (size_t a = 0; a < radix; a++) {
        pass->circle.re[a] = roots.re[count / radix * a];
        pass->circle.im[a] = roots.im[count / radix * a];
    }
}

static void plan_chirp(struct gm_arena *arena, struct chirp *chirp, size_t count)
{
    const size_t length = convolution_length(2 * count - 1);
    const struct split roots = take_roots(arena, 2 * count);
    chirp->fourier = gm_arena_keep(arena, gm_fourier_open(length), gm_fourier_close);
    chirp->v = take(arena, count);
    const struct split x = chirp->fourier->level[0];
    for (size_t j = 0; j < count; j++) {
        /* the square in its period: no digit of the angle is lost */
        const size_t square = (size_t)((uint64_t)j * j % (2 * (uint64_t)count));
        chirp->v.re[j] = roots.re[square];
        chirp->v.im[j] = roots.im[square];
        const size_t at = j > 0 ? length - j : 0;
        x.re[j] = x.re[at] = roots.re[square] / (double)length;
        x.im[j] = x.im[at] = -roots.im[square] / (double)length;
    }
    chirp->kernel = take(arena, length);
    copy(pass_all(chirp->fourier, x, chirp->fourier->level[1]), chirp->kernel, length);
}

static void plan(struct gm_arena *arena, void *data)
{
    struct gm_fourier **opened = data, *fourier = gm_arena_take(arena, 1, sizeof *fourier);
    const size_t count = (*opened)->count;
    fourier->arena = arena;
    fourier->count = count;
    fourier->level[0] = take(arena, count);
    fourier->level[1] = take(arena, count);
    if (!factors_well(count)) {
        fourier->chirp = gm_arena_take(arena, 1, sizeof *fourier->chirp);
        plan_chirp(arena, fourier->chirp, count);
    } else {
        const struct split roots = take_roots(arena, count);
        for (size_t s = 1; s < count; s *= fourier->pass[fourier->passes - 1].radix) {
            plan_pass(fourier, roots, s);
        }
        gm_arena_drop(arena, roots.re);
    }
    *opened = fourier;
}

struct gm_fourier *gm_fourier_open(size_t count)
{
    struct gm_fourier wanted = {.count = count}, *fourier = &wanted;
    return gm_arena_made(plan, &fourier) ? fourier : NULL;
}

void gm_fourier_close(void *fourier)
{
    if (fourier) {
        gm_arena_close(((struct gm_fourier *)fourier)->arena);
    }
}

/* ---- transforms ---- */

/* z := z v */
GM_CLONES static void multiply_by(struct split z, struct split v, size_t count)
{
    for (size_t i = 0; i < count; i += TILE) { /* there is room for a tile at the end */
        store(z, i, times(load(z, i), load(v, i)));
    }
}

/* Transforms x by the chirp. */
static struct split convolve(const struct chirp *chirp, struct split x, size_t count)
{
    const struct gm_fourier *fourier = chirp->fourier;
    const struct split a = fourier->level[0], b = fourier->level[1];
    multiply_by(x, chirp->v, count);
    copy(x, a, count);
    memset(a.re + count, 0, (fourier->count - count) * sizeof *a.re);
    memset(a.im + count, 0, (fourier->count - count) * sizeof *a.im);
    struct split z = pass_all(fourier, a, b);
    multiply_by(z, chirp->kernel, fourier->count);
    z = exchanged(pass_all(fourier, exchanged(z), exchanged(z.re == a.re ? b : a)));
    multiply_by(z, chirp->v, count);
    return z;
}

GM_CLONES static void split_up(const double *x, struct split z, size_t count)
{
    double *restrict re = z.re, *restrict im = z.im;
    for (size_t i = 0; i < count; i++) {
        re[i] = x[2 * i];
        im[i] = x[2 * i + 1];
    }
}

GM_CLONES static void join(struct split z, double factor, double *restrict x, size_t count)
{
    const double *re = z.re, *im = z.im;
    for (size_t i = 0; i < count; i++) {
        x[2 * i] = factor * re[i];
        x[2 * i + 1] = factor * im[i];
    }
}

/* Returns the transform of level[0], or its inverse without its factor. */
static struct split transform(const struct gm_fourier *fourier, bool inverse)
{
    const struct split x = fourier->level[0], y = fourier->level[1], from = inverse ? exchanged(x) : x;
    const struct split z = fourier->chirp ? convolve(fourier->chirp, from, fourier->count)
                                          : pass_all(fourier, from, inverse ? exchanged(y) : y);
    return inverse ? exchanged(z) : z;
}

void gm_fourier_forward(struct gm_fourier *fourier, double complex *x)
{
    split_up((double *)x, fourier->level[0], fourier->count);
    join(transform(fourier, false), 1, (double *)x, fourier->count);
}

void gm_fourier_inverse(struct gm_fourier *fourier, double complex *x)
{
    split_up((double *)x, fourier->level[0], fourier->count);
    join(transform(fourier, true), 1 / (double)fourier->count, (double *)x, fourier->count);
}

/* ---- real fields ---- */

/* An even count goes by the transform of half of it, and the roots w^k; an odd one as a complex field. */
struct gm_real_fourier {
    struct gm_arena *arena;
    struct gm_fourier *fourier;
    struct split roots;
};

static void plan_real(struct gm_arena *arena, void *data)
{
    struct gm_modes *modes = data;
    const size_t points = modes->points;
    modes->fourier = gm_arena_take(arena, 1, sizeof *modes->fourier);
    *modes->fourier = (struct gm_real_fourier){
        .arena = arena,
        .fourier = gm_arena_keep(arena, gm_fourier_open(points % 2 ? points : points / 2), gm_fourier_close),
        .roots = take_roots(arena, points),
    };
}

bool gm_modes_open(struct gm_modes *modes, size_t points, size_t fields)
{
    *modes = (struct gm_modes){.points = points, .fields = fields};
    if (!gm_arena_made(plan_real, modes)) {
        modes->fourier = NULL;
    }
    return modes->fourier != NULL;
}

void gm_modes_close(void *modes)
{
    struct gm_modes *self = modes;
    if (self->fourier) {
        gm_arena_close(self->fourier->arena);
    }
    self->fourier = NULL;
}

/* X_k of Z, 0 < k < h; a wave is a pair of numbers */
GM_CLONES static void halves_to_waves(struct split z, struct split turns, double *restrict waves, size_t h)
{
    for (size_t k = 1; k < h; k++) {
        const double sr = (z.re[k] + z.re[h - k]) / 2, si = (z.im[k] - z.im[h - k]) / 2;
        const double dr = (z.im[k] + z.im[h - k]) / 2, di = (z.re[h - k] - z.re[k]) / 2;
        waves[2 * k] = sr + (dr * turns.re[k] - di * turns.im[k]);
        waves[2 * k + 1] = si + (dr * turns.im[k] + di * turns.re[k]);
    }
}

/* The other way round, Z times h. */
GM_CLONES static void waves_to_halves(const double *waves, struct split turns, struct split z, size_t h)
{
    double *restrict re = z.re, *restrict im = z.im;
    for (size_t k = 1; k < h; k++) {
        const double ar = waves[2 * k], ai = waves[2 * k + 1];
        const double br = waves[2 * (h - k)], bi = waves[2 * (h - k) + 1];
        const double dr = ar - br, di = ai + bi;
        const double tr = dr * turns.re[k] + di * turns.im[k], ti = di * turns.re[k] - dr * turns.im[k];
        re[k] = (ar + br - ti) / 2;
        im[k] = (ai - bi + tr) / 2;
    }
}

static void even_forward(const struct gm_real_fourier *real, const double *y, double *waves, size_t h)
{
    split_up(y, real->fourier->level[0], h);
    const struct split z = transform(real->fourier, false);
    halves_to_waves(z, real->roots, waves, h);
    waves[0] = z.re[0] + z.im[0];
    waves[2 * h] = z.re[0] - z.im[0];
    waves[1] = waves[2 * h + 1] = 0;
}

static void even_back(const struct gm_real_fourier *real, const double *waves, double *y, size_t h)
{
    const struct split z = real->fourier->level[0];
    waves_to_halves(waves, real->roots, z, h);
    z.re[0] = (waves[0] + waves[2 * h]) / 2;
    z.im[0] = (waves[0] - waves[2 * h]) / 2;
    join(transform(real->fourier, true), 1 / (double)h, y, h);
}

static void odd_forward(const struct gm_fourier *fourier, const double *y, double *waves)
{
    memcpy(fourier->level[0].re, y, fourier->count * sizeof *y);
    memset(fourier->level[0].im, 0, fourier->count * sizeof *y);
    join(transform(fourier, false), 1, waves, fourier->count / 2 + 1);
    waves[1] = 0;
}

static void odd_back(const struct gm_fourier *fourier, const double *waves, double *y)
{
    const size_t count = fourier->count;
    const struct split z = fourier->level[0];
    z.re[0] = waves[0];
    z.im[0] = 0;
    for (size_t k = 1; k <= count / 2; k++) {
        z.re[k] = z.re[count - k] = waves[2 * k];
        z.im[k] = waves[2 * k + 1];
        z.im[count - k] = -waves[2 * k + 1];
    }
    const struct split sum = transform(fourier, true);
    for (size_t j = 0; j < count; j++) {
        y[j] = sum.re[j] * (1 / (double)count);
    }
}

void gm_modes_forward(const struct gm_modes *modes, const double *y, double complex *waves)
{
    const struct gm_real_fourier *real = modes->fourier;
    for (size_t at = 0; at < modes->fields * modes->points; at += modes->points) {
        if (modes->points % 2 == 0) {
            even_forward(real, y + at, (double *)(waves + at), modes->points / 2);
        } else {
            odd_forward(real->fourier, y + at, (double *)(waves + at));
        }
    }
}

void gm_modes_back(const struct gm_modes *modes, const double complex *waves, double *y)
{
    const struct gm_real_fourier *real = modes->fourier;
    for (size_t at = 0; at < modes->fields * modes->points; at += modes->points) {
        if (modes->points % 2 == 0) {
            even_back(real, (const double *)(waves + at), y + at, modes->points / 2);
        } else {
            odd_back(real->fourier, (const double *)(waves + at), y + at);
        }
    }
}
