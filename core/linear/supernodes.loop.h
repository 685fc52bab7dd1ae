/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangular solves in one precision. core/linear/cholesky.c includes this file with REAL, the type of the
   solve, STORED, the type of the values, LANES, the number of partial sums, VALUES, the array of values, and
   PASS(name). Panels are read once, four columns at a time, since memory takes most of the time. */

typedef REAL PASS(lanes) __attribute__((vector_size(LANES * sizeof(REAL)), aligned(sizeof(REAL)), may_alias));
/* Returns values in the precision of the solve, and prefetches the next ones, `ahead` bytes from them. */
static inline __attribute__((always_inline)) const REAL *PASS(read)(const STORED *value, size_t count,
                                                                    ptrdiff_t ahead, REAL *restrict into)
{
    if (sizeof(REAL) == sizeof(STORED)) {
        return (const REAL *)(const void *)value;
    }
    for (size_t i = 0; i < count; i += 64 / sizeof(STORED)) {
        __builtin_prefetch((const char *)(value + i) + ahead);
    }
    for (size_t i = 0; i < count; i++) {
        into[i] = (REAL)value[i];
    }
    return into;
}

/* L x = b */
GM_CLONES static void PASS(forward)(const struct supernodes *triangle, REAL *restrict x, REAL *restrict t,
                                    REAL *restrict buffer)
{
    for (size_t s = 0; s < triangle->supernodes; s++) {
        const int *row = triangle->row + triangle->row_start[s];
        const STORED *panel = triangle->VALUES + triangle->value_start[s];
        const size_t rows = (size_t)(triangle->row_start[s + 1] - triangle->row_start[s]),
                     columns = (size_t)(triangle->first[s + 1] - triangle->first[s]);
        const double *inverse = triangle->inverse + triangle->first[s];
        REAL *mine = x + triangle->first[s];
        for (size_t i = 0; i < columns; i++) {
            t[i] = mine[i];
        }
        for (size_t i = columns; i < rows; i++) {
            t[i] = 0;
        }
        size_t j = 0;
        for (; j + 4 <= columns; j += 4) {
            const REAL *restrict a = PASS(read)(panel + j * rows, 4 * rows, 4096, buffer),
                                 *restrict b = a + rows, *restrict c = b + rows, *restrict d = c + rows;
            const REAL p = t[j] * (REAL)inverse[j], q = (t[j + 1] - a[j + 1] * p) * (REAL)inverse[j + 1],
                       r = (t[j + 2] - a[j + 2] * p - b[j + 2] * q) * (REAL)inverse[j + 2],
                       u = (t[j + 3] - a[j + 3] * p - b[j + 3] * q - c[j + 3] * r) * (REAL)inverse[j + 3];
            t[j] = p;
            t[j + 1] = q;
            t[j + 2] = r;
            t[j + 3] = u;
            for (size_t i = j + 4; i < rows; i++) {
                t[i] -= (a[i] * p + b[i] * q) + (c[i] * r + d[i] * u);
            }
        }
        for (; j < columns; j++) {
            const REAL *restrict a = PASS(read)(panel + j * rows, rows, 4096, buffer);
            const REAL p = t[j] * (REAL)inverse[j];
            t[j] = p;
            for (size_t i = j + 1; i < rows; i++) {
                t[i] -= a[i] * p;
            }
        }
        for (size_t i = 0; i < columns; i++) {
            mine[i] = t[i];
        }
        for (size_t i = columns; i < rows; i++) {
            x[row[i]] += t[i];
        }
    }
}

static inline __attribute__((always_inline)) REAL PASS(sum)(const PASS(lanes) * lanes)
{
    REAL sum = 0;
    for (size_t k = 0; k < LANES; k++) {
        sum += (*lanes)[k];
    }
    return sum;
}

/* L' x = b */
GM_CLONES static void PASS(backward)(const struct supernodes *triangle, REAL *restrict x, REAL *restrict t,
                                     REAL *restrict buffer)
{
    for (size_t s = triangle->supernodes; s-- > 0;) {
        const int *row = triangle->row + triangle->row_start[s];
        const STORED *panel = triangle->VALUES + triangle->value_start[s];
        const size_t rows = (size_t)(triangle->row_start[s + 1] - triangle->row_start[s]),
                     columns = (size_t)(triangle->first[s + 1] - triangle->first[s]);
        const double *inverse = triangle->inverse + triangle->first[s];
        REAL *mine = x + triangle->first[s];
        for (size_t i = 0; i < columns; i++) {
            t[i] = mine[i];
        }
        for (size_t i = columns; i < rows; i++) {
            t[i] = x[row[i]];
        }
        size_t j = columns;
        for (; j % 4 > 0; j--) {
            const REAL *a = PASS(read)(panel + (j - 1) * rows, rows, -4096, buffer);
            REAL p = 0;
            for (size_t i = j; i < rows; i++) {
                p += a[i] * t[i];
            }
            t[j - 1] = (t[j - 1] - p) * (REAL)inverse[j - 1];
        }
        for (; j > 0; j -= 4) {
            const REAL *a = PASS(read)(panel + (j - 4) * rows, 4 * rows, -4096, buffer), *b = a + rows,
                       *c = b + rows, *d = c + rows;
            PASS(lanes) wide[4] = {{0}};
            REAL p = 0, q = 0, r = 0, u = 0;
            size_t i = j;
            for (; i + LANES <= rows; i += LANES) {
                const PASS(lanes) at = *(const PASS(lanes) *)(t + i);
                wide[0] += *(const PASS(lanes) *)(a + i) * at;
                wide[1] += *(const PASS(lanes) *)(b + i) * at;
                wide[2] += *(const PASS(lanes) *)(c + i) * at;
                wide[3] += *(const PASS(lanes) *)(d + i) * at;
            }
            for (; i < rows; i++) {
                p += a[i] * t[i];
                q += b[i] * t[i];
                r += c[i] * t[i];
                u += d[i] * t[i];
            }
            t[j - 1] = (t[j - 1] - (u + PASS(sum)(&wide[3]))) * (REAL)inverse[j - 1];
            t[j - 2] = (t[j - 2] - (r + PASS(sum)(&wide[2])) - c[j - 1] * t[j - 1]) * (REAL)inverse[j - 2];
            t[j - 3] = (t[j - 3] - (q + PASS(sum)(&wide[1])) - b[j - 1] * t[j - 1] - b[j - 2] * t[j - 2]) *
                       (REAL)inverse[j - 3];
            t[j - 4] = (t[j - 4] - (p + PASS(sum)(&wide[0])) - a[j - 1] * t[j - 1] - a[j - 2] * t[j - 2] -
                        a[j - 3] * t[j - 3]) *
                       (REAL)inverse[j - 4];
        }
        for (size_t i = 0; i < columns; i++) {
            mine[i] = t[i];
        }
    }
}

#undef REAL
#undef STORED
#undef LANES
#undef VALUES
#undef PASS
