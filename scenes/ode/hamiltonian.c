/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What scenes of Hamiltonian systems observe alike. */
#include "scenes/ode/hamiltonian.h"

#include <complex.h>
#include <math.h>

double gm_hamiltonian_energy(const struct gm_view *view)
{
    double value = 0;
    gm_ode_of(view->problem)->hamiltonian->energy(view->problem, view->state, &value, 1);
    return value;
}

/* The trapezoidal rule, which on a closed curve converges faster than any power of `count`. A chord is the mean
   derivative of its ends times a length that is exact for every ellipse; where that is off by a hundredth of the
   edge's length, the area of a pendulum's disc of 8 and more points is right to 1e-6. */
double gm_edge_area(const double complex *edge, const double complex *derivatives, size_t count)
{
    const double most = 0.01, step = 2 * M_PI / (double)count, chord = tan(step / 2);
    double sum = 0, length = 0, apart = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t next = i + 1 < count ? i + 1 : 0;
        const double complex along = edge[next] - edge[i];
        sum += cimag(conj(edge[i]) * derivatives[i]);
        length += cabs(along);
        apart += cabs(along - chord * (derivatives[i] + derivatives[next]));
    }
    return apart <= most * length ? sum * step / 2 : NAN;
}
