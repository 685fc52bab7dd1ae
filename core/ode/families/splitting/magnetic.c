/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splittings of x' = v, v' = g(x, t) + W(x, t) v with W antisymmetric, in two or three dimensions:
       x := x + h/2 v,  v := v + h/2 g,  v := R(h W) v,  v := v + h/2 g,  x := x + h/2 v
   with g and W at the middle place and time. R(A) = (1 - A/2)^-1 (1 + A/2) is the rotation of J. P. Boris (1970),
   R(A) = exp(A) the exact one: Y. He, Y. Sun, J. Liu & H. Qin, J. Comput. Phys. 281 (2015) 135. Both are explicit,
   symmetric, and preserve the volume of (x, v).

   For H = c |p - A(x, t)|^2/2 + phi the state is (x, p), v = c (p - A). */
#include "core/functions/functions.h"
#include "core/ode/families/family.h"

enum { MOST = 3 };

/* v := (1 + a A + b A^2) v, A = h W, with a and b of Cayley's map or of the exponential: A^3 = -angle^2 A */
static void rotate(size_t half, double h, bool exact, const double *w, double *v)
{
    double square = 0, once[MOST] = {0}, twice[MOST] = {0};
    for (size_t i = 0; i < half * half; i++) {
        once[i / half] += h * w[i] * v[i % half];
        square += h * h * w[i] * w[i] / 2;
    }
    for (size_t i = 0; i < half * half; i++) {
        twice[i / half] += h * w[i] * once[i % half];
    }
    double a = 1 / (1 + square / 4), b = a / 2;
    if (exact && square > 0) {
        const double angle = sqrt(square), sinc = gm_sin(angle / 2) / (angle / 2);
        a = gm_sin(angle) / angle;
        b = sinc * sinc / 2;
    }
    for (size_t i = 0; i < half; i++) {
        v[i] += a * once[i] + b * twice[i];
    }
}

/* Moves the place, and the time if it is a component, by half a step. */
static void move(size_t n, double h, const double *v, double *y)
{
    const size_t half = n / 2;
    for (size_t i = 0; i < half; i++) {
        y[i] += h / 2 * v[i];
    }
    if (n > 2 * half) {
        y[2 * half] += h / 2;
    }
}

static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_magnetic *magnetic = gm_ode_of(task->problem)->magnetic;
    const size_t n = members->n, half = n / 2;
    const double h = task->dt;
    const bool exact = task->scheme->coefficients != NULL;
    double *y = members->y, v[MOST], drift[MOST] = {0}, forces[MOST + MOST * MOST];
    if (magnetic->canonical) {
        magnetic->drift(task->problem, y, drift);
    }
    for (size_t i = 0; i < half; i++) {
        v[i] = magnetic->c * y[half + i] + drift[i];
    }
    move(n, h, v, y);
    magnetic->forces(task->problem, y, forces);
    for (size_t i = 0; i < half; i++) {
        v[i] += h / 2 * forces[i];
    }
    rotate(half, h, exact, forces + half, v);
    for (size_t i = 0; i < half; i++) {
        v[i] += h / 2 * forces[i];
    }
    move(n, h, v, y);
    if (magnetic->canonical) {
        magnetic->drift(task->problem, y, drift);
    }
    for (size_t i = 0; i < half; i++) {
        y[half + i] = (v[i] - drift[i]) / magnetic->c;
    }
    progress->evaluations++;
    return GM_OK;
}

static const bool by_exponential = true;

const struct gm_family gm_family_magnetic = {
    .title = "rotation by a magnetic field",
    GM_MEMBERS(magnetic, .step = step),
};
