/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The flow of Arnold, Beltrami & Childress, (x, y, z),
       x' = A sin z + C cos y,  y' = B sin x + A cos z,  z' = C sin y + B cos x,
   A, B, C = ((const double *)parameters)[0..2]. It has no divergence. */
#define GM_COMPONENTS 3

GM_INLINE void K(field)(const real *y, real *f, const void *parameters)
{
    const double *abc = parameters;
    f[0] = abc[0] * K(sine)(y[2]) + abc[2] * K(cosine)(y[1]);
    f[1] = abc[1] * K(sine)(y[0]) + abc[0] * K(cosine)(y[2]);
    f[2] = abc[2] * K(sine)(y[1]) + abc[1] * K(cosine)(y[0]);
}

#ifdef GM_PASS_SCALAR
static void K(jacobian)(const double *y, double jacobian[][GM_COMPONENTS], const void *parameters)
{
    const double *abc = parameters;
    const double rows[3][3] = {{0, -abc[2] * sin(y[1]), abc[0] * cos(y[2])},
                               {abc[1] * cos(y[0]), 0, -abc[0] * sin(y[2])},
                               {-abc[1] * sin(y[0]), abc[2] * cos(y[1]), 0}};
    memcpy(jacobian, rows, sizeof rows);
}
#endif
