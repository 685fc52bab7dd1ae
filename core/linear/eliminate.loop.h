/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gaussian elimination with partial pivoting: of real numbers in core/linear/iteration.h, of complex ones in
   core/linear/complex_matrix.c. They include this file with ENTRY, the type of an entry, MAGNITUDE, its absolute
   value, DIVIDE(a, b), and ELIMINATE, the name of the function. The loops over kernels include it too. */

/* Solves a x = r for `columns` right sides, a an n * n matrix by rows. Each x overwrites its r; a becomes the upper
   triangle of the elimination. Returns false if a is singular. */
static inline __attribute__((always_inline)) bool ELIMINATE(size_t n, ENTRY *restrict a, size_t columns,
                                                            ENTRY *restrict r)
{
    for (size_t k = 0; k < n; k++) {
        size_t pivot = k;
        double largest = MAGNITUDE(a[k * n + k]);
        for (size_t i = k + 1; i < n; i++) {
            const double entry = MAGNITUDE(a[i * n + k]);
            pivot = entry > largest ? i : pivot;
            largest = entry > largest ? entry : largest;
        }
        if (!(largest > 0)) {
            return false;
        }
        if (pivot != k) {
            for (size_t j = k; j < n; j++) {
                const ENTRY swap = a[k * n + j];
                a[k * n + j] = a[pivot * n + j];
                a[pivot * n + j] = swap;
            }
            for (size_t c = 0; c < columns; c++) {
                const ENTRY swap = r[c * n + k];
                r[c * n + k] = r[c * n + pivot];
                r[c * n + pivot] = swap;
            }
        }
        for (size_t i = k + 1; i < n; i++) {
            ENTRY *restrict row = a + i * n;
            const ENTRY *top = a + k * n, factor = DIVIDE(row[k], top[k]);
            for (size_t j = k + 1; j < n; j++) {
                row[j] -= factor * top[j];
            }
            for (size_t c = 0; c < columns; c++) {
                r[c * n + i] -= factor * r[c * n + k];
            }
        }
    }
    for (size_t c = 0; c < columns; c++) {
        for (size_t k = n; k-- > 0;) {
            ENTRY sum = r[c * n + k];
            for (size_t j = k + 1; j < n; j++) {
                sum -= a[k * n + j] * r[c * n + j];
            }
            r[c * n + k] = DIVIDE(sum, a[k * n + k]);
        }
    }
    return true;
}

#undef ENTRY
#undef DIVIDE
#undef MAGNITUDE
#undef ELIMINATE
