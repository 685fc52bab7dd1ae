/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions of complex numbers, some units of their size off. */
#ifndef GM_CORE_FUNCTIONS_COMPLEX_H
#define GM_CORE_FUNCTIONS_COMPLEX_H

double gm_cabs(double _Complex z);
double gm_carg(double _Complex z);
double _Complex gm_cexp(double _Complex z);
/* z^n for z != 0 */
double _Complex gm_cpow(double _Complex z, double n);
/* the root with a real part >= 0, without cancellation */
double _Complex gm_csqrt(double _Complex z);

#endif
