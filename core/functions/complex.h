/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions of complex numbers, some units of their size off. */
#ifndef GM_CORE_FUNCTIONS_COMPLEX_H
#define GM_CORE_FUNCTIONS_COMPLEX_H

/* a / b, which compilers leave to libraries of their own, each with other last digits. These are those of GCC since
   version 12, but where the quotient is not finite. M. Baudin & R. L. Smith, arXiv:1210.4539. */
double _Complex gm_cdivide(double _Complex a, double _Complex b);
double gm_cabs(double _Complex z);
double gm_carg(double _Complex z);
double _Complex gm_cexp(double _Complex z);
/* z^n for z != 0 */
double _Complex gm_cpow(double _Complex z, double n);
/* the root with a real part >= 0, without cancellation */
double _Complex gm_csqrt(double _Complex z);

#endif
