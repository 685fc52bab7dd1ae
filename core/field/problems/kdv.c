/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Korteweg-de Vries equation u_t + eta u u_x + mu u_xxx = 0 in multisymplectic form, s = (phi, u, v, w):
        u_t/2   + w_x = 0
       -phi_t/2 - v_x = -w + eta u^2/2
        u_x           = v/mu
       -phi_x         = -u
       S = v^2/(2 mu) - u w + eta u^3/6
   U. Ascher & R.I. McLachlan, Appl. Numer. Math. 48 (2004) 255. The field u comes second. */
#include <math.h>

#include "core/field/multisymplectic.h"
#include "core/field/problems/dispersive.h"
#include "core/linear/ring/ring.h"

static const double m[16] = {0, 0.5, 0, 0, -0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
static const double k[16] = {0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, -1, 0, 0, 0};

static double dispersion(const struct gm_problem *problem)
{
    return gm_kdv_of(problem)->mu;
}

static void nonlinear(const struct gm_problem *problem, const double *re, const double *im, double *g_re,
                      double *g_im, size_t count)
{
    (void)im;
    const double half = gm_kdv_of(problem)->eta / 2;
    for (size_t i = 0; i < count; i++) {
        g_re[i] = half * re[i] * re[i];
        g_im[i] = 0;
    }
}

static void linearised(const struct gm_problem *problem, const double *base, const double *f, double *g,
                       size_t count)
{
    for (size_t i = 0; i < count; i++) {
        g[i] = gm_kdv_of(problem)->eta * base[i] * f[i];
        g[count + i] = 0;
    }
}

enum { PHI, U, V, W, DIMENSION };

/* The components of s that the scheme eliminated, each from one equation:
       phi   from D_x phi = A_x u, 0 at the first node of every level: its constant in x is free, and w goes
             with it
       v     from D_x u = A_x v / mu
       w     from D_t A_x u/2 + D_x w = 0, and from the mean over the ring of
                 -D_t phi/2 - D_x v = -A_x w + eta m u,
             which else is the scheme; its alternating part is the one of v on an even number of points
   Taking w from the last one would invert A_x twice and rounding with it. */
static void complete(const struct gm_problem *problem, double dt, const double *base, const double *now,
                     const double *next, struct gm_faces *faces)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx;
    double phi_now = 0, phi_next = 0;
    double *sides = faces->sides;
    for (size_t i = 0; i <= points; i++) {
        const size_t here = i < points ? i : 0, r = i + 1 < points ? i + 1 : 0;
        double *side = sides + i * DIMENSION;
        side[PHI] = (phi_now + phi_next) / 2;
        side[U] = (now[here] + next[here]) / 2;
        if (i < points) {
            double *lower = faces->lower + i * DIMENSION, *upper = faces->upper + i * DIMENSION;
            lower[U] = (now[here] + now[r]) / 2;
            upper[U] = (next[here] + next[r]) / 2;
            lower[PHI] = phi_now + dx / 2 * lower[U];
            upper[PHI] = phi_next + dx / 2 * upper[U];
            phi_now += dx * lower[U];
            phi_next += dx * upper[U];
        }
    }
    double *slope = faces->scratch, alternating = 0;
    for (size_t i = 0; i < points; i++) {
        const double u = (faces->lower[i * DIMENSION + U] + faces->upper[i * DIMENSION + U]) / 2;
        const double force = gm_kdv_of(problem)->eta * base[i] * u / (double)points;
        alternating += i % 2 ? -force : force;
        slope[i] = gm_kdv_of(problem)->mu * (sides[(i + 1) * DIMENSION + U] - sides[i * DIMENSION + U]) / dx;
    }
    gm_ring_unaverage(slope, points);
    for (size_t i = 0; points % 2 == 0 && i < points; i++) {
        const double free = dx / 2 * alternating;
        slope[i] += i % 2 ? -free : free;
    }
    for (size_t i = 0; i <= points; i++) {
        sides[i * DIMENSION + V] = slope[i < points ? i : 0];
    }
    double w = 0, mean = 0;
    for (size_t i = 0; i <= points; i++) {
        sides[i * DIMENSION + W] = w;
        if (i < points) {
            const double *lower = faces->lower + i * DIMENSION, *upper = faces->upper + i * DIMENSION;
            const double change = dx * (upper[U] - lower[U]) / (2 * dt);
            mean += (upper[PHI] - lower[PHI]) / (2 * dt) +
                    gm_kdv_of(problem)->eta * base[i] * (lower[U] + upper[U]) / 2 - (w - change / 2);
            w -= change;
        }
    }
    for (size_t i = 0; i <= points; i++) {
        sides[i * DIMENSION + W] += mean / (double)points;
    }
}

static double potential(const struct gm_problem *problem, double re, double im)
{
    (void)im;
    return gm_kdv_of(problem)->eta * re * re * re / 6;
}

/* D_t A^3 u + D_x [A g + mu D^2 A_t u], g in the cells: the mass */
static void content(const struct gm_problem *problem, double dt, double *means, const double *now,
                    const double *next, struct gm_faces *faces, double *residual)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx, eta = gm_kdv_of(problem)->eta, mu = gm_kdv_of(problem)->mu;
    double *flux = faces->scratch;
    for (size_t i = 0; i < points; i++) {
        const size_t r = (i + 1) % points, r2 = (i + 2) % points;
        const double bend = (now[r2] + next[r2] - 2 * (now[r] + next[r]) + now[i] + next[i]) / 2;
        flux[i] = eta / 4 * (means[i] * means[i] + means[r] * means[r]) + mu * bend / (dx * dx);
    }
    for (size_t i = 0; i < points; i++) {
        const size_t r = (i + 1) % points, r2 = (i + 2) % points, r3 = (i + 3) % points;
        const double change =
            next[i] - now[i] + 3 * (next[r] - now[r] + next[r2] - now[r2]) + next[r3] - now[r3];
        residual[i] = change / (8 * dt) + (flux[r] - flux[i]) / dx;
    }
}

/* The distance from a place on the ring. */
static double around(const struct gm_grid1 *grid, double distance)
{
    const double period = grid->dx * (double)grid->points;
    return distance - period * floor(distance / period + 0.5);
}

/* The k of the two solitons, whose heights are 3 mu k^2 / eta and velocities mu k^2, and their places at
   the start. */
static const double fast = 1.2, slow = 0.8, fast_start = -30, slow_start = -15;

/* (ln F)_xx with F = 1 + e^a + e^b + A e^(a + b), everything divided by the largest exponential; a is fast
   times the way from the faster soliton before they meet, b likewise from the slower one after it. */
static double two_solitons(double a, double b, double log_a)
{
    const double exponents[4] = {0, a, b, a + b + log_a}, rates[4] = {0, fast, slow, fast + slow};
    double largest = 0, sum = 0, first = 0, second = 0;
    for (int i = 0; i < 4; i++) {
        largest = fmax(largest, exponents[i]);
    }
    for (int i = 0; i < 4; i++) {
        const double e = exp(exponents[i] - largest);
        sum += e;
        first += rates[i] * e;
        second += rates[i] * rates[i] * e;
    }
    return second / sum - first / sum * (first / sum);
}

/* On the covering line of the ring the faster soliton meets one image of the slower one after another. A
   meeting moves it forwards by shift / fast and the other one back by shift / slow, so that the m-th is
   the first one with other starts. What counts is the nearest meeting; its own images, a period apart, are
   added. */
static double two_solitons_around(const struct gm_kdv *kdv, const struct gm_grid1 *grid, double x, double t)
{
    const double period = grid->dx * (double)grid->points;
    const double shift = 2 * log((fast + slow) / (fast - slow));
    const double overtakes = kdv->mu * (fast * fast - slow * slow) * t;
    const double first = slow_start + shift / (2 * slow) - (fast_start + shift / (2 * fast));
    const double between = period - shift / fast - shift / slow;
    const double passed = between > 0 ? floor((overtakes - first) / between + 0.5) : 0;
    const double fast_at = fast_start + passed * shift / fast + kdv->mu * fast * fast * t;
    const double slow_at = slow_start + passed * (period - shift / slow) + kdv->mu * slow * slow * t;
    const double middle = (fast_at + slow_at) / 2, place = middle + around(grid, x - middle);
    double sum = 0;
    for (int image = -1; image <= 1; image++) {
        const double there = place + image * period;
        sum += two_solitons(fast * (there - fast_at), slow * (there - slow_at), -shift);
    }
    return sum;
}

/* lambda = 0 */
static double unboosted(const struct gm_kdv *kdv, const struct gm_grid1 *grid, double x, double t)
{
    if (kdv->initial == GM_KDV_COSINE) {
        return t == 0 ? cos(M_PI * x) : NAN;
    }
    if (kdv->initial == GM_KDV_TWO) {
        return 12 * kdv->mu / kdv->eta * two_solitons_around(kdv, grid, x, t);
    }
    const double c = kdv->velocity, away = around(grid, x - kdv->position - c * t);
    const double sech = 1 / cosh(sqrt(c / kdv->mu) / 2 * away);
    return 3 * c / kdv->eta * sech * sech;
}

double gm_kdv_exact(const struct gm_kdv *kdv, const struct gm_grid1 *grid, double x, double t)
{
    return unboosted(kdv, grid, x - kdv->lambda * t, t) + kdv->lambda / kdv->eta;
}

bool gm_kdv_is_known(const struct gm_kdv *kdv, const struct gm_grid1 *grid, double t)
{
    const double half = grid->dx * (double)grid->points / 2;
    const double rate = kdv->initial == GM_KDV_TWO ? slow : sqrt(kdv->velocity / kdv->mu);
    return t == 0 || (kdv->initial != GM_KDV_COSINE && 4 * exp(-rate * half) <= 1e-3);
}

void gm_kdv_levels(const struct gm_problem *problem, double dt, double *y)
{
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    const struct gm_grid1 *grid = &problem->line;
    for (size_t i = 0; i < grid->points; i++) {
        const double x = gm_grid1_node(grid, i);
        y[i] = gm_kdv_exact(kdv, grid, x, 0);
        if (kdv->initial == GM_KDV_COSINE) {
            const double slope = -M_PI * sin(M_PI * x), third = M_PI * M_PI * M_PI * sin(M_PI * x);
            y[grid->points + i] = y[i] - dt * (kdv->eta * y[i] * slope + kdv->mu * third);
        } else {
            y[grid->points + i] = gm_kdv_exact(kdv, grid, x, dt);
        }
    }
    y[2 * grid->points] = dt;
}

/* The value of u = 0 in the original frame. */
static double level_of(const struct gm_problem *problem)
{
    return gm_kdv_of(problem)->lambda / gm_kdv_of(problem)->eta;
}

double gm_kdv_mass(const struct gm_problem *problem, const double *y)
{
    const double level = level_of(problem);
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += y[i] - level;
    }
    return problem->line.dx * sum;
}

double gm_kdv_square(const struct gm_problem *problem, const double *profile)
{
    const double level = level_of(problem);
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        sum += (profile[i] - level) * (profile[i] - level);
    }
    return problem->line.dx * sum;
}

double gm_kdv_energy(const struct gm_problem *problem, const double *profile)
{
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    const double level = level_of(problem), *slopes = profile + problem->line.points;
    double sum = 0;
    for (size_t i = 0; i < problem->line.points; i++) {
        const double value = profile[i] - level;
        sum += kdv->mu * slopes[i] * slopes[i] / 2 - kdv->eta * value * value * value / 6;
    }
    return problem->line.dx * sum;
}

static const struct gm_form form = {.dimension = 4, .m = m, .k = k};
static const struct gm_dispersive dispersive = {.power = 3,
                                                .factor = {1, 0},
                                                .dispersion = dispersion,
                                                .derivative = true,
                                                .nonlinear = nonlinear,
                                                .linearised = linearised,
                                                .potential = potential,
                                                .content = content,
                                                .complete = complete};

const struct gm_problem gm_problem_kdv = {
    .name = "Korteweg-de Vries",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.form = &form, .dispersive = &dispersive, .equation = GM_NEEDS_KDV},
    .m = 1,
    .bound = 1e3,
};
