/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splittings of x' = v, v' = g(x, t) + W(x, t) v with W antisymmetric, in two or three dimensions:
       x := x + h/2 v,  v := v + h/2 g,  v := R(h W) v,  v := v + h/2 g,  x := x + h/2 v
   with g and W at the middle place and time. R(A) = (1 - A/2)^-1 (1 + A/2) is the rotation of J. P. Boris (1970),
   R(A) = exp(A) the exact one: Y. He, Y. Sun, J. Liu & H. Qin, J. Comput. Phys. 281 (2015) 135. Both are explicit,
   symmetric, and preserve the volume of (x, v).

   For H = c |p - A(x, t)|^2/2 + phi the state is (x, p). With v = c (p - A),
       W_ij = d v_i/d x_j - d v_j/d x_i,   g = c p' + d v/dt at v = 0 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode_scheme_texts.h"

enum { MOST = 3, COMPONENTS = 2 * MOST + 1 };

/* A step's place and time, in a whole state, and the problem there. */
struct place {
    const struct gm_problem *problem;
    size_t n, half;
    bool canonical;
    double y[COMPONENTS];
};

/* Writes the velocity -c A of p = 0 at the place. */
static void find_drag(struct place *place, double *drag)
{
    double f[COMPONENTS];
    memset(place->y + place->half, 0, place->half * sizeof *place->y);
    gm_field(place->problem, place->y, f, 1);
    memcpy(drag, f, place->half * sizeof *drag);
}

/* Writes g, W by rows, and c, at the place. Returns false if there is no Jacobian. */
static bool find_forces(struct place *place, double *g, double *w, double *c)
{
    const size_t n = place->n, half = place->half;
    double f[COMPONENTS], matrix[COMPONENTS * COMPONENTS], drag[MOST] = {0};
    memset(place->y + half, 0, half * sizeof *place->y);
    if (place->canonical) {
        find_drag(place, drag);
    }
    if (!gm_jacobian(place->problem, place->y, matrix)) {
        return false;
    }
    *c = place->canonical ? matrix[half] : 1; /* dv/dp, at any p */
    for (size_t i = 0; i < half; i++) {
        place->y[half + i] = -drag[i] / *c;
    }
    gm_field(place->problem, place->y, f, 1);
    for (size_t i = 0; i < half; i++) {
        const double drift = place->canonical && n > 2 * half ? matrix[i * n + 2 * half] : 0;
        g[i] = *c * f[half + i] + drift;
        for (size_t j = 0; j < half; j++) {
            w[i * half + j] =
                place->canonical ? matrix[i * n + j] - matrix[j * n + i] : matrix[(half + i) * n + half + j];
        }
    }
    return true;
}

/* v := (1 + a A + b A^2) v, A = h W, with a and b of Cayley's map or of the exponential: A^3 = -angle^2 A */
static void rotate(const struct place *place, double h, bool exact, const double *w, double *v)
{
    const size_t half = place->half;
    double square = 0, once[MOST] = {0}, twice[MOST] = {0};
    for (size_t i = 0; i < half * half; i++) {
        once[i / half] += h * w[i] * v[i % half];
        square += h * h * w[i] * w[i] / 2;
    }
    for (size_t i = 0; i < half * half; i++) {
        twice[i / half] += h * w[i] * once[i % half];
    }
    const double angle = sqrt(square), sinc = angle > 0 ? sin(angle) / angle : 1,
                 sinc_half = angle > 0 ? sin(angle / 2) / (angle / 2) : 1;
    const double a = exact ? sinc : 1 / (1 + square / 4), b = exact ? sinc_half * sinc_half / 2 : a / 2;
    for (size_t i = 0; i < half; i++) {
        v[i] += a * once[i] + b * twice[i];
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const size_t n = members->n, half = n / 2;
    const double h = task->dt;
    struct place place = {.problem = task->problem,
                          .n = n,
                          .half = half,
                          .canonical = gm_ode_of(task->problem)->magnetic->canonical};
    double v[MOST], g[MOST], w[MOST * MOST], drag[MOST], c, f[COMPONENTS];
    gm_field(task->problem, members->y, f, 1);
    memcpy(v, f, half * sizeof *v);
    memcpy(place.y, members->y, n * sizeof *place.y);
    for (size_t i = 0; i < half; i++) {
        place.y[i] += h / 2 * v[i];
    }
    if (n > 2 * half) {
        place.y[2 * half] += h / 2;
    }
    if (!find_forces(&place, g, w, &c)) {
        return GM_NO_CONVERGENCE;
    }
    for (size_t i = 0; i < half; i++) {
        v[i] += h / 2 * g[i];
    }
    rotate(&place, h, task->scheme->coefficients != NULL, w, v);
    for (size_t i = 0; i < half; i++) {
        v[i] += h / 2 * g[i];
        place.y[i] += h / 2 * v[i];
    }
    if (n > 2 * half) {
        place.y[2 * half] += h / 2;
    }
    if (place.canonical) {
        find_drag(&place, drag);
    }
    for (size_t i = 0; i < half; i++) {
        place.y[half + i] = place.canonical ? (v[i] - drag[i]) / c : v[i];
    }
    memcpy(members->y, place.y, n * sizeof *place.y);
    progress->evaluations += place.canonical ? 4 : 2;
    return GM_OK;
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_boris2, .family = &gm_family_magnetic, .needs = GM_NEEDS_MAGNETIC},
    {GM_TEXTS_magnetic_splitting2, .family = &gm_family_magnetic, .needs = GM_NEEDS_MAGNETIC,
     .coefficients = "exact"},
};

const struct gm_family gm_family_magnetic = {
    .title = "rotation by a magnetic field",
    GM_MEMBERS(.step = step),
};
