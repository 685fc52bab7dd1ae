/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One or two solitons on a moving mesh: the mesh and its density, the start, the exact solution. */
#include "tests/common/mesh_soliton.h"

#include <math.h>
#include <stdlib.h>

struct closed {
    struct gm_density density; /* first */
    struct gm_density_numbers numbers;
};

static void at_end(const struct gm_density_numbers *of, double s, double u, double x,
                   double P[GM_DENSITY_VALUES])
{
    const bool phi4 = of->field == GM_PHI4;
    const double square = of->alpha * of->alpha, limit = 1 / (of->steepest * of->steepest);
    const double share = of->which == GM_MIX ? 0.25 : 1, c = share * of->bend * of->bend * square * square;
    const double f = phi4 ? u * u * u - u : sin(u), f1 = phi4 ? 3 * u * u - 1 : cos(u),
                 f2 = phi4 ? 6 * u : -sin(u), q = sqrt(1 + c * f * f), w = 1 + limit * s * s;
    for (int i = 0; i < GM_DENSITY_VALUES; i++) {
        P[i] = 0;
    }
    switch (of->which) {
    case GM_ARCLENGTH:
        P[GM_P] = 1 + square * s * s;
        P[GM_P_S] = 2 * square * s;
        P[GM_P_SS] = 2 * square;
        break;
    case GM_LIMITED:
        P[GM_P] = 1 + square * s * s / w;
        P[GM_P_S] = 2 * square * s / (w * w);
        P[GM_P_SS] = 2 * square * (1 - 3 * limit * s * s) / (w * w * w);
        break;
    case GM_TEMPERED:
        P[GM_P] = 1 + 2 * square * s * s / (1 + sqrt(w));
        P[GM_P_S] = 2 * square * s / sqrt(w);
        P[GM_P_SS] = 2 * square / (w * sqrt(w));
        break;
    case GM_MIX:
    case GM_CURVATURE:
        P[GM_P] = q;
        P[GM_P_U] = c * f * f1 / q;
        P[GM_P_UU] = c * (f1 * f1 + f * f2) / q - P[GM_P_U] * P[GM_P_U] / q;
        if (of->which == GM_MIX) {
            P[GM_P] += square * s * s / 2;
            P[GM_P_S] = square * s;
            P[GM_P_SS] = square;
        }
        break;
    case GM_OF_ALL:
        P[GM_P] = 1 + square * s * s * (1 + sin(x) / 2) + u * u * cos(x) / 4 + s * u / 8;
        P[GM_P_S] = 2 * square * s * (1 + sin(x) / 2) + u / 8;
        P[GM_P_SS] = 2 * square * (1 + sin(x) / 2);
        P[GM_P_U] = u * cos(x) / 2 + s / 8;
        P[GM_P_X] = square * s * s * cos(x) / 2 - u * u * sin(x) / 4;
        P[GM_P_SU] = 1. / 8;
        P[GM_P_SX] = square * s * cos(x);
        P[GM_P_UU] = cos(x) / 2;
        P[GM_P_UX] = -u * sin(x) / 2;
        P[GM_P_XX] = -square * s * s * sin(x) / 2 - u * u * cos(x) / 4;
        break;
    }
}

static void values_of(const struct gm_density *density, const double *at, double *values, size_t m)
{
    const struct closed *closed = (const struct closed *)density;
    const size_t count = density->local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE;
    for (size_t i = 0; i < m; i++) {
        double P[GM_DENSITY_VALUES];
        at_end(&closed->numbers, at[i], density->local ? at[m + i] : 0, density->local ? at[2 * m + i] : 0,
               P);
        for (size_t k = 0; k < count; k++) {
            values[k * m + i] = P[k];
        }
    }
}

const struct gm_density *gm_closed_density(const struct gm_density_numbers *numbers)
{
    enum { MOST = 4096 };
    static struct closed all[MOST];
    static size_t count;
    for (size_t i = 0; i < count; i++) {
        const struct gm_density_numbers *other = &all[i].numbers;
        if (other->which == numbers->which && other->field == numbers->field &&
            other->alpha == numbers->alpha && other->steepest == numbers->steepest &&
            other->bend == numbers->bend) {
            return &all[i].density;
        }
    }
    if (count == MOST) {
        abort();
    }
    const bool of_slope =
        numbers->which == GM_ARCLENGTH || numbers->which == GM_LIMITED || numbers->which == GM_TEMPERED;
    all[count] = (struct closed){{.local = !of_slope, .values = values_of}, *numbers};
    return &all[count++].density;
}

static double lorentz(const struct gm_soliton *soliton)
{
    return 1 / sqrt((1 - soliton->velocity) * (1 + soliton->velocity));
}

/* When two solitons meet; at 5 in the document's box of 25. */
static double encounter(const struct gm_soliton *soliton)
{
    return soliton->length / 5;
}

/* The position of the right one of two phi^4 kinks at the start. */
static double kink_place(const struct gm_soliton *soliton)
{
    return soliton->velocity * encounter(soliton);
}

double gm_soliton_alpha(const struct gm_soliton *soliton)
{
    if (!isnan(soliton->alpha)) {
        return soliton->alpha;
    }
    /* the document's 2.5 and 1.5 for sine-Gordon; phi^4 rises by 2 a kink, not 2 pi */
    const double sine_gordon = soliton->solitons == 2 ? 1.5 : 2.5;
    return soliton->field == GM_PHI4 ? sine_gordon * M_PI : sine_gordon;
}

static void describe(const struct gm_problem *problem, struct gm_mesh *mesh)
{
    const struct gm_soliton *soliton = problem->parameters;
    const bool sine_gordon = soliton->field == GM_SINE_GORDON, two = soliton->solitons == 2;
    const double alpha = gm_soliton_alpha(soliton);
    *mesh = (struct gm_mesh){
        .level = 1,
        .points = (size_t)soliton->points,
        .length = soliton->length,
        .left = sine_gordon ? (two ? -2 * M_PI : 0) : -1,
        .right = sine_gordon ? 2 * M_PI
                 : two       ? -1
                             : 1,
        .potential = sine_gordon ? &gm_potential_sine_gordon : &gm_potential_phi4,
    };
    /* nothing has to be resolved that is steeper than a soliton in its middle */
    const double steep = lorentz(soliton);
    mesh->density = gm_closed_density(&(const struct gm_density_numbers){
        (enum gm_closed_density)soliton->density, (enum gm_soliton_field)soliton->field, alpha,
        steep * (sine_gordon ? 2 : M_SQRT1_2), 4 * steep * steep});
}

static double exact(const void *soliton, double x, double t)
{
    return gm_soliton_exact(soliton, x, t);
}

static const struct gm_moving_mesh moving_mesh = {
    .describe = describe, .start = gm_soliton_profile, .exact = exact};

void gm_soliton_problem(const struct gm_soliton *soliton, struct gm_problem *problem)
{
    *problem = (struct gm_problem){
        .name = "soliton",
        .n = 4 * (size_t)soliton->points,
        .m = 1,
        .parameters = soliton,
        .kind = &gm_kind_mesh,
        .facets = &moving_mesh,
    };
}

/* 4 arctan(v sinh(gamma x) / cosh(v gamma t)), two solitons that meet at x = 0, t = 0 (eq. 164). */
static void pair(double velocity, double gamma, double x, double t, double *value, double *slope,
                 double *rate)
{
    const double a = fabs(gamma * x), b = fabs(velocity * gamma * t);
    const double scale = velocity * exp(fmin(a - b, 300)) / (1 + exp(-2 * b));
    const double s = copysign(scale * -expm1(-2 * a), x);
    *value = 4 * atan(s);
    *slope = 4 * gamma * scale * (1 + exp(-2 * a)) / (1 + s * s);
    *rate = -4 * velocity * gamma * s * copysign(tanh(b), t) / (1 + s * s);
}

static void kink(double gamma, double x, double velocity, double *value, double *slope, double *rate)
{
    const double z = gamma * x / M_SQRT2, sech = 1 / cosh(z);
    *value += tanh(z);
    *slope += gamma / M_SQRT2 * sech * sech;
    *rate -= velocity * gamma / M_SQRT2 * sech * sech;
}

static void profile_at(const struct gm_soliton *soliton, double x, double *value, double *slope, double *rate)
{
    const double gamma = lorentz(soliton), velocity = soliton->velocity,
                 from_middle = x - soliton->length / 2;
    if (soliton->field == GM_PHI4) {
        *slope = *rate = 0;
        if (soliton->solitons == 1) {
            *value = 0;
            kink(gamma, from_middle, velocity, value, slope, rate);
            return;
        }
        /* a kink from the left and an antikink from the right */
        *value = -1;
        double minus = 0, minus_slope = 0, minus_rate = 0;
        kink(gamma, from_middle + kink_place(soliton), velocity, value, slope, rate);
        kink(gamma, from_middle - kink_place(soliton), -velocity, &minus, &minus_slope, &minus_rate);
        *value -= minus;
        *slope -= minus_slope;
        *rate -= minus_rate;
        return;
    }
    if (soliton->solitons == 2) {
        pair(velocity, gamma, from_middle, -encounter(soliton), value, slope, rate);
        return;
    }
    *value = 4 * atan(exp(gamma * from_middle));
    *slope = 2 * gamma / cosh(gamma * from_middle);
    *rate = -velocity * *slope;
}

void gm_soliton_profile(const void *context, const double *x, size_t count, double *value, double *slope,
                        double *rate)
{
    for (size_t i = 0; i < count; i++) {
        profile_at(context, x[i], &value[i], &slope[i], &rate[i]);
    }
}

/* The time that a soliton takes from the middle of a box to its wall. */
static double passage(const struct gm_soliton *soliton, double box)
{
    const double gamma = lorentz(soliton), a = gamma * box / 2;
    /* acosh(v sinh a), also where sinh overflows */
    const double high = a > 20 ? log(soliton->velocity) + a : acosh(fmax(1, soliton->velocity * sinh(a)));
    return high / (soliton->velocity * gamma);
}

double gm_soliton_exact(const struct gm_soliton *soliton, double x, double t)
{
    const double gamma = lorentz(soliton), velocity = soliton->velocity, length = soliton->length;
    if (soliton->field == GM_PHI4) {
        double value = 0, slope = 0, rate = 0;
        const double clear = 8 * M_SQRT2 / gamma;
        if (soliton->solitons == 2 || fabs(velocity * t) > length / 2 - clear) {
            return NAN;
        }
        kink(gamma, x - length / 2 - velocity * t, velocity, &value, &slope, &rate);
        return value;
    }
    /* two solitons are one in the right half of the box, and its image in the left one */
    const bool two = soliton->solitons == 2;
    const double box = two ? length / 2 : length, place = two ? fabs(x - length / 2) : x;
    const double quarter = passage(soliton, box);
    double phase = two ? t - encounter(soliton) + 3 * quarter : t;
    phase -= 4 * quarter * floor(phase / (4 * quarter));
    double value, slope, rate;
    if (phase <= 2 * quarter) {
        pair(velocity, gamma, place - box, phase - quarter, &value, &slope, &rate);
        value += 2 * M_PI;
    } else {
        pair(velocity, gamma, place, phase - 3 * quarter, &value, &slope, &rate);
    }
    return two && x < length / 2 ? -value : value;
}

double gm_soliton_energy(const struct gm_soliton *soliton)
{
    const double rest = soliton->field == GM_PHI4 ? 2 * M_SQRT2 / 3 : 8;
    return rest * (double)soliton->solitons * lorentz(soliton);
}

/* phi^4: over an element phi^2 has the mean m^2 + r^2 / 12, phi^4 the mean m^4 + m^2 r^2 / 2 + r^4 / 80. */

static void phi4_first(const struct gm_potential *potential, const double *restrict middle,
                       const double *restrict rise, size_t n, double *restrict w, double *restrict w_m,
                       double *restrict w_r)
{
    (void)potential;
    for (size_t e = 0; e < n; e++) {
        const double m = middle[e], r = rise[e], mm = m * m, rr = r * r;
        w[e] = ((mm - 1) * (mm - 1) + mm * rr / 2 + rr * rr / 80 - rr / 6) / 4;
        w_m[e] = m * (mm - 1) + m * rr / 4;
        w_r[e] = r * (mm + rr / 20 - 1. / 3) / 4;
    }
}

static void phi4_second(const struct gm_potential *potential, double middle, double rise, double *w_mm,
                        double *w_mr, double *w_rr)
{
    (void)potential;
    *w_mm = 3 * middle * middle - 1 + rise * rise / 4;
    *w_mr = middle * rise / 2;
    *w_rr = (middle * middle + 3 * rise * rise / 20 - 1. / 3) / 4;
}

const struct gm_potential gm_potential_phi4 = {
    .name = "phi4",
    .first = phi4_first,
    .second = phi4_second,
};
