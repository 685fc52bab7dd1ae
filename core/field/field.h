/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets of fields on a line: Hamiltonian partial differential equations in one space dimension on a
   periodic grid, in their multisymplectic form
       M s_t + K s_x = grad S(s),   M, K constant and skew,
   and what elimination makes of them. T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184. */
#ifndef GM_CORE_FIELD_FIELD_H
#define GM_CORE_FIELD_FIELD_H

#include <math.h>
#include <string.h>

#include "core/kind.h"

/* Counts a step that has led to these values. Returns false if a value is beyond the task's limit, or not
   finite. */
static inline bool gm_field_stepped(const struct gm_task *task, struct gm_progress *progress,
                                    const double *values, size_t count)
{
    const double limit = task->limit;
    long outside = 0; /* all are counted, several at once */
    for (size_t i = 0; i < count; i++) {
        outside += !(fabs(values[i]) <= limit);
    }
    progress->status = progress->status == GM_OK && outside > 0 ? GM_BLOW_UP : progress->status;
    progress->done += progress->status == GM_OK;
    return progress->status == GM_OK;
}

struct gm_form {
    size_t dimension;    /* dimension of s */
    const double *m, *k; /* dimension * dimension, row by row */
    size_t first,
        kept; /* the components that the state keeps, where elimination has reduced it; u and u_t of a wave */
    /* S at one point, its gradient and its second derivatives at `count` of them, [component * count + point] and
       [(row * dimension + column) * count + point], and s(x + the ring) - s(x). A reduced state needs the second
       derivatives, and with potentials the gradient. */
    double (*function)(const void *parameters, const double *s);
    void (*gradients)(const void *parameters, const double *s, double *gradient, size_t count);
    void (*hessians)(const void *parameters, const double *s, double *hessian, size_t count);
    const double *jump; /* NULL: 0 */
    const char *const
        *names; /* of the components, if the state is s itself, [component * points + node]; else NULL */
    /* Components that S does not contain and whose slope an equation without M gives, k s_x = dS of that
       row. They follow from the others up to a constant, as in phi_x = u of Korteweg-de Vries. */
    const struct gm_form_potential {
        size_t component, row;
    } * potentials;
    size_t potential_count;
};

/* Returns true if the state is s itself. */
static inline bool gm_form_is_state(const struct gm_form *form)
{
    return form && form->names;
}

enum { GM_MOST_OF_FORM = 8 }; /* components of a state that is s itself */

/* u_tt - u_xx + V'(u) = 0. All arrays have `count` entries, and may be the same. */
struct gm_wave {
    double (*potential)(const struct gm_problem *problem, double u); /* V */
    double (*curvature)(const struct gm_problem *problem, double u); /* V'' */
    void (*slopes)(const struct gm_problem *problem, const double *u, double *slope, size_t count);
    /* [V(a) - V(b)] / (a - b), without cancellation, and if slope is not NULL its derivative in a */
    void (*quotients)(const struct gm_problem *problem, const double *a, const double *b, double *quotient,
                      double *slope, size_t count);
};

/* The box scheme of an equation of first order in time, after elimination:
       a A^p f_t + b D^p f + Q g(A f) = 0,   Q = A D or A
       A f = (f_i + f_{i+1})/2,   D f = (f_{i+1} - f_i)/dx
   The field is real, with the state of a wave problem, or complex, and its state is the real parts and the
   imaginary parts. */
struct gm_dispersive {
    int power;                                              /* p, 2 or 3 */
    double factor[2];                                       /* a, real and imaginary part */
    double (*dispersion)(const struct gm_problem *problem); /* b */
    bool derivative;                                        /* Q = A D */
    void (*nonlinear)(const struct gm_problem *problem, const double *re, const double *im, double *g_re,
                      double *g_im, size_t count); /* g */
    /* V with V' = g */
    double (*potential)(const struct gm_problem *problem, double re, double im);
    /* The residual of the local law of mass or charge over a step of the box from `now` to `next`, for
       every cell (real parts, then imaginary ones), with the solution's `means` in the cells; flux is scratch. */
    void (*content)(const struct gm_problem *problem, double dt, const double *means, const double *now,
                    const double *next, double *flux, double *residual);
};

/* State of a wave problem, 2 points + 1 numbers: u at the current time t, u at another time, and the
   second time minus t. A scheme of two steps needs nothing else: after a step of length dt the other time
   is t - dt, at a start from two exact levels it is t + dt. */
static inline size_t gm_wave_size(size_t points)
{
    return 2 * points + 1;
}
/* The state after the last step of a task. */
static inline void gm_wave_write(const struct gm_task *task, const double *now, const double *past)
{
    const size_t points = task->problem->line.points;
    memcpy(task->out, now, points * sizeof *now);
    memcpy(task->out + points, past, points * sizeof *past);
    task->out[2 * points] = -task->dt;
}

/* The facets of a field. */
enum gm_field_facet {
    GM_NEEDS_FORM = 1u << 0,    /* the multisymplectic form */
    GM_NEEDS_WAVE = 1u << 1,    /* u_tt - u_xx + V'(u) = 0 */
    GM_NEEDS_BURGERS = 1u << 2, /* u_t + u u_x = nu u_xx in moving frames */
    GM_NEEDS_KDV = 1u << 3,     /* u_t + eta u u_x + mu u_xxx = 0 */
    GM_NEEDS_NLS = 1u << 4,     /* i psi_t + psi_xx + k |psi|^2 psi = 0 */
    GM_NEEDS_HEAT = 1u << 5,    /* u_t = nu u_xx in moving frames, u > 0 */
    GM_NEEDS_ALL = 1u << 6,     /* the multisymplectic form, and all of its components as the state */
    GM_NEEDS_PAIRS = 1u << 7,   /* an even number of points */
};
struct gm_field {
    const struct gm_form *form; /* NULL: it has none, and so on */
    const struct gm_wave *wave;
    const struct gm_dispersive *dispersive;
    /* GM_NEEDS_BURGERS, _KDV, _NLS, _HEAT: the problem's parameters are then its constants; or 0. */
    unsigned equation;
    const struct gm_moving_frames
        *frames; /* of the first, second and last; their parameters begin with struct gm_framed */
};

extern const struct gm_kind gm_kind_field;

static inline const struct gm_field *gm_field_of(const struct gm_problem *problem)
{
    return problem->facets;
}

#endif
