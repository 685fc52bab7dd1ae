/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One or two solitons on a moving mesh: the mesh and its density, the start, the exact solution. */
#include "tests/common/mesh_soliton.h"

#include <math.h>

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
    gm_mesh_weigh(mesh, (enum gm_mesh_density)soliton->density, alpha, steep * (sine_gordon ? 2 : M_SQRT1_2),
                  4 * steep * steep);
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
