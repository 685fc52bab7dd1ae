/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The coefficients of methods, of compositions and of adjoints. */
#include "core/theory/coefficients.h"

#include <string.h>

#include "core/arena.h"

void gm_coefficients_open(struct gm_arena *arena, struct gm_coefficients *coefficients,
                          enum gm_equations equations, int stages)
{
    const size_t s = (size_t)stages;
    *coefficients = (struct gm_coefficients){.equations = equations, .stages = stages, .evaluations = stages};
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        struct gm_ball *a = coefficients->a[side] = gm_arena_take(arena, s * s + s, sizeof *a);
        coefficients->b[side] = a + s * s;
        for (size_t i = 0; i < s * s + s; i++) {
            a[i] = gm_ball_of(0);
        }
    }
}

void gm_coefficients_write(struct gm_coefficients *coefficients, int side, const double *a, size_t stride,
                           const double *b)
{
    const size_t s = (size_t)coefficients->stages;
    for (size_t i = 0; i < s; i++) {
        for (size_t j = 0; j < s; j++) {
            coefficients->a[side][i * s + j] = gm_ball_written(a[i * stride + j]);
        }
        coefficients->b[side][i] = gm_ball_written(b[i]);
    }
}

void gm_coefficients_copy(struct gm_arena *arena, struct gm_coefficients *copy,
                          const struct gm_coefficients *coefficients)
{
    const size_t s = (size_t)coefficients->stages, count = (size_t)coefficients->moved_count;
    *copy = *coefficients;
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        struct gm_ball *a = copy->a[side] = gm_arena_take(arena, s * s + s, sizeof *a);
        copy->b[side] = a + s * s;
        memcpy(a, coefficients->a[side], s * s * sizeof *a);
        memcpy(copy->b[side], coefficients->b[side], s * sizeof *a);
    }
    copy->moved = gm_arena_take(arena, count, sizeof *copy->moved);
    for (size_t i = 0; i < count; i++) {
        gm_coefficients_copy(arena, &copy->moved[i], &coefficients->moved[i]);
    }
}

static bool is_same_stage(const struct gm_coefficients *coefficients, int i, int j)
{
    const int s = coefficients->stages;
    bool same = true;
    for (int k = 0; k < s * gm_coefficients_sides(coefficients) && same; k++) {
        const struct gm_ball *a = coefficients->a[k / s] + k % s;
        same = gm_ball_is_same(&a[i * s], &a[j * s]);
    }
    return same;
}

static bool is_unused(const struct gm_coefficients *coefficients, int stage)
{
    const int s = coefficients->stages;
    bool unused = s > 1;
    for (int side = 0; side < gm_coefficients_sides(coefficients) && unused; side++) {
        unused = gm_ball_is_zero(&coefficients->b[side][stage]);
        for (int i = 0; i < s && unused; i++) {
            unused = i == stage || gm_ball_is_zero(&coefficients->a[side][i * s + stage]);
        }
    }
    return unused;
}

/* Removes stage `gone` of s from one side. If kept >= 0, stage `kept` is equal to it and takes over its
   weights. */
static void drop_from(struct gm_ball *a, struct gm_ball *b, int s, int gone, int kept)
{
    for (int i = 0; i < s && kept >= 0; i++) {
        a[i * s + kept] = gm_ball_add(a[i * s + kept], a[i * s + gone]);
    }
    if (kept >= 0) {
        b[kept] = gm_ball_add(b[kept], b[gone]);
    }
    for (int i = 0, row = 0; i < s; i++) {
        for (int j = 0, column = 0; j < s && i != gone; j++) {
            if (j != gone) {
                a[row * (s - 1) + column++] = a[i * s + j];
            }
        }
        if (i != gone) {
            b[row++] = b[i];
        }
    }
}

static void drop_stage(struct gm_coefficients *coefficients, int gone, int kept)
{
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        drop_from(coefficients->a[side], coefficients->b[side], coefficients->stages, gone, kept);
    }
    coefficients->stages--;
    coefficients->nystrom -= coefficients->nystrom > 0;
    for (int k = 0; k < coefficients->moved_count; k++) {
        drop_stage(&coefficients->moved[k], gone, kept);
    }
}

void gm_coefficients_reduce(struct gm_coefficients *coefficients)
{
    /* the last two stages of a Nystrom method have their places */
    for (int i = 0; i < (coefficients->nystrom > 0 ? coefficients->nystrom : coefficients->stages); i++) {
        int same = -1;
        for (int j = 0; j < i && same < 0; j++) {
            same = is_same_stage(coefficients, i, j) ? j : -1;
        }
        if (same >= 0 || is_unused(coefficients, i)) {
            drop_stage(coefficients, i, same);
            i = -1; /* others may be the same now */
        }
    }
}

void gm_coefficients_open_nystrom(struct gm_arena *arena, struct gm_coefficients *coefficients, int stages,
                                  const struct gm_nystrom_balls *balls)
{
    const int all = stages + 2, start = stages, end = stages + 1;
    gm_coefficients_open(arena, coefficients, GM_EQUATIONS_NYSTROM, all);
    coefficients->evaluations = coefficients->nystrom = stages;
    for (int i = 0; i < stages; i++) {
        coefficients->b[GM_SIDE_P][i] = balls->bv[i];
        coefficients->a[GM_SIDE_P][end * all + i] = balls->b[i];
        coefficients->a[GM_SIDE_Q][i * all + i] = gm_ball_of(1);
        coefficients->a[GM_SIDE_Q][i * all + start] = gm_ball_subtract(balls->c[i], gm_ball_of(1));
        for (int j = 0; j < stages; j++) {
            coefficients->a[GM_SIDE_P][i * all + j] = balls->a[i * stages + j];
        }
    }
    coefficients->b[GM_SIDE_Q][end] = gm_ball_of(1);
}

/* The time of a stage of a Nystrom method, and that of its end, of which c - 1 are coefficients. */
static struct gm_ball time_of(const struct gm_coefficients *coefficients, int stage)
{
    const int start = coefficients->nystrom;
    return gm_ball_add(coefficients->a[GM_SIDE_Q][stage * coefficients->stages + start], gm_ball_of(1));
}

static struct gm_ball end_of(const struct gm_coefficients *coefficients)
{
    return gm_ball_add(coefficients->b[GM_SIDE_Q][coefficients->nystrom], gm_ball_of(1));
}

/* Writes a part for equations that are among its own: both sides of a plain method have its coefficients. */
static void narrow(struct gm_coefficients *part, enum gm_equations equations)
{
    if (part->equations == GM_EQUATIONS_PLAIN) {
        part->a[GM_SIDE_P] = part->a[GM_SIDE_Q];
        part->b[GM_SIDE_P] = part->b[GM_SIDE_Q];
    }
    part->equations = equations;
}

/* Writes a method with two sides as a Nystrom method: if f_q is linear it has, with A = a_q and e = sum_j b_q,j,
       a = A a_p,   b = b_q a_p,   bv = b_p,   c_i = sum_j A_ij */
static void make_nystrom(struct gm_arena *arena, struct gm_coefficients *part)
{
    const int s = part->stages;
    struct gm_ball *products = gm_arena_take(arena, ((size_t)s + 1) * ((size_t)s + 1), sizeof *products),
                   *times = products + (s + 1) * s;
    struct gm_coefficients made;
    for (int i = 0; i <= s; i++) {
        const struct gm_ball *row = i < s ? part->a[GM_SIDE_Q] + i * s : part->b[GM_SIDE_Q];
        times[i] = gm_ball_of(0);
        for (int j = 0; j < s; j++) {
            struct gm_ball sum = gm_ball_of(0);
            for (int k = 0; k < s; k++) {
                sum = gm_ball_add(sum, gm_ball_multiply(row[k], part->a[GM_SIDE_P][k * s + j]));
            }
            products[i * s + j] = sum;
            times[i] = gm_ball_add(times[i], row[j]);
        }
    }
    gm_coefficients_open_nystrom(
        arena, &made, s, &(struct gm_nystrom_balls){products, products + s * s, part->b[GM_SIDE_P], times});
    made.b[GM_SIDE_Q][s] = gm_ball_subtract(times[s], gm_ball_of(1));
    made.evaluations = part->evaluations;
    *part = made;
}

/* Steps of Nystrom methods are one of all their stages: `begin` is the time at which the next one begins,
   the composition's own b and bv, as far as they are filled, are where those before it have led to. */
static void add_nystrom(struct gm_coefficients *composed, int first, const struct gm_coefficients *part,
                        struct gm_ball fraction, struct gm_ball *begin)
{
    const int all = composed->stages, start = all - 2, end = all - 1, stages = part->nystrom;
    const struct gm_ball square = gm_ball_multiply(fraction, fraction);
    struct gm_ball *moved = composed->a[GM_SIDE_P] + end * all, *kicked = composed->b[GM_SIDE_P];
    for (int i = 0; i < stages; i++) {
        const struct gm_ball time = gm_ball_multiply(fraction, time_of(part, i));
        struct gm_ball *row = composed->a[GM_SIDE_P] + (first + i) * all;
        composed->a[GM_SIDE_Q][(first + i) * all + first + i] = gm_ball_of(1);
        composed->a[GM_SIDE_Q][(first + i) * all + start] =
            gm_ball_subtract(gm_ball_add(*begin, time), gm_ball_of(1));
        for (int j = 0; j < first; j++) {
            row[j] = gm_ball_add(moved[j], gm_ball_multiply(time, kicked[j]));
        }
        for (int j = 0; j < stages; j++) {
            row[first + j] = gm_ball_multiply(square, part->a[GM_SIDE_P][i * part->stages + j]);
        }
    }
    const struct gm_ball length = gm_ball_multiply(fraction, end_of(part));
    for (int j = 0; j < first; j++) {
        moved[j] = gm_ball_add(moved[j], gm_ball_multiply(length, kicked[j]));
    }
    for (int j = 0; j < stages; j++) {
        const struct gm_ball b = part->a[GM_SIDE_P][(stages + 1) * part->stages + j];
        moved[first + j] = gm_ball_multiply(square, b);
        kicked[first + j] = gm_ball_multiply(fraction, part->b[GM_SIDE_P][j]);
    }
    *begin = gm_ball_add(*begin, length);
}

/* The stages of a step know the whole steps before it. */
static void add_tableau(struct gm_coefficients *composed, int first, const struct gm_coefficients *part,
                        struct gm_ball fraction)
{
    const int all = composed->stages, stages = part->stages;
    for (int side = 0; side < gm_coefficients_sides(composed); side++) {
        for (int j = 0; j < stages; j++) {
            const struct gm_ball b = gm_ball_multiply(fraction, part->b[side][j]);
            composed->b[side][first + j] = b;
            for (int i = 0; i < stages; i++) {
                composed->a[side][(first + i) * all + first + j] =
                    gm_ball_multiply(fraction, part->a[side][i * stages + j]);
            }
            for (int i = first + stages; i < all; i++) {
                composed->a[side][i * all + first + j] = b;
            }
        }
    }
}

void gm_coefficients_open_composition(struct gm_arena *arena, struct gm_coefficients *composed,
                                      struct gm_coefficients *parts, const struct gm_ball *fractions,
                                      int count)
{
    enum gm_equations equations = GM_EQUATIONS_PLAIN;
    bool nystrom = false;
    for (int k = 0; k < count; k++) {
        equations = parts[k].equations > equations ? parts[k].equations : equations;
        nystrom = nystrom || parts[k].nystrom > 0;
    }
    int stages = nystrom ? 2 : 0, evaluations = 0;
    for (int k = 0; k < count; k++) {
        narrow(&parts[k], equations);
        if (nystrom && parts[k].nystrom == 0) {
            make_nystrom(arena, &parts[k]);
        }
        stages += nystrom ? parts[k].nystrom : parts[k].stages;
        evaluations += parts[k].evaluations;
    }
    gm_coefficients_open(arena, composed, equations, stages);
    composed->evaluations = evaluations;
    struct gm_ball begin = gm_ball_of(0);
    int first = 0;
    for (int k = 0; k < count; k++) {
        if (nystrom) {
            add_nystrom(composed, first, &parts[k], fractions[k], &begin);
            first += parts[k].nystrom;
        } else {
            add_tableau(composed, first, &parts[k], fractions[k]);
            first += parts[k].stages;
        }
    }
    if (nystrom) {
        composed->nystrom = first;
        composed->b[GM_SIDE_Q][first] = gm_ball_subtract(begin, gm_ball_of(1));
        composed->b[GM_SIDE_Q][first + 1] = gm_ball_of(1);
    }
}

/* With k = s + 1 - i, l = s + 1 - j and the end e, which is 1 of a whole step:
       c*_i = e - c_k,   bv*_i = bv_k,   b*_i = e bv_k - b_k,   a*_ij = a_kl + (e - c_k) bv_l - b_l */
static void turn_nystrom(struct gm_coefficients *adjoint, const struct gm_coefficients *exact)
{
    const int s = exact->nystrom, all = exact->stages, last = s - 1;
    const struct gm_ball end = end_of(exact), *bv = exact->b[GM_SIDE_P];
    const struct gm_ball *a = exact->a[GM_SIDE_P], *b = a + (s + 1) * all;
    for (int i = 0; i < s; i++) {
        const int k = last - i;
        const struct gm_ball rest = gm_ball_subtract(end, time_of(exact, k));
        adjoint->b[GM_SIDE_P][i] = bv[k];
        adjoint->a[GM_SIDE_P][(s + 1) * all + i] = gm_ball_subtract(gm_ball_multiply(end, bv[k]), b[k]);
        adjoint->a[GM_SIDE_Q][i * all + i] = gm_ball_of(1);
        adjoint->a[GM_SIDE_Q][i * all + s] = gm_ball_subtract(rest, gm_ball_of(1));
        for (int j = 0; j < s; j++) {
            const int l = last - j;
            const struct gm_ball back = gm_ball_subtract(gm_ball_multiply(rest, bv[l]), b[l]);
            adjoint->a[GM_SIDE_P][i * all + j] = gm_ball_add(a[k * all + l], back);
        }
    }
    adjoint->b[GM_SIDE_Q][s] = exact->b[GM_SIDE_Q][s];
    adjoint->b[GM_SIDE_Q][s + 1] = gm_ball_of(1);
    adjoint->nystrom = s;
}

/* a*_ij = b_l - a_kl,  b*_i = b_k, on each side the same */
static void turn_tableau(struct gm_coefficients *adjoint, const struct gm_coefficients *exact)
{
    const int stages = exact->stages, last = stages - 1;
    for (int side = 0; side < gm_coefficients_sides(exact); side++) {
        for (int i = 0; i < stages; i++) {
            adjoint->b[side][i] = exact->b[side][last - i];
            for (int j = 0; j < stages; j++) {
                const struct gm_ball *b = &exact->b[side][last - j],
                                     *a = &exact->a[side][(last - i) * stages + last - j];
                adjoint->a[side][i * stages + j] =
                    gm_ball_is_same(a, b) ? gm_ball_of(0) : gm_ball_subtract(*b, *a);
            }
        }
    }
}

void gm_coefficients_open_adjoint(struct gm_arena *arena, struct gm_coefficients *adjoint,
                                  const struct gm_coefficients *exact)
{
    gm_coefficients_open(arena, adjoint, exact->equations, exact->stages);
    adjoint->evaluations = exact->evaluations;
    exact->nystrom > 0 ? turn_nystrom(adjoint, exact) : turn_tableau(adjoint, exact);
}
