/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eigenvalues and singular values of a small dense matrix, by GSL. */
#include "core/linear/eigenvalues.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

#include "core/memory.h"

struct work {
    double *matrix, *real, *imaginary;
    size_t n;
    double cutoff, *x; /* of gm_singular_solve */
};

static bool is_finite(const double *matrix, size_t count)
{
    size_t i = 0;
    while (i < count && isfinite(matrix[i])) {
        i++;
    }
    return i == count;
}

static bool solve(void *data)
{
    const struct work *work = data;
    gsl_eigen_nonsymm_workspace *workspace = gsl_eigen_nonsymm_alloc(work->n);
    gsl_vector_complex *values = gsl_vector_complex_alloc(work->n);
    gsl_matrix_view view = gsl_matrix_view_array(work->matrix, work->n, work->n);
    const bool solved =
        workspace && values && gsl_eigen_nonsymm(&view.matrix, values, workspace) == GSL_SUCCESS;
    for (size_t i = 0; solved && i < work->n; i++) {
        work->real[i] = GSL_REAL(gsl_vector_complex_get(values, i));
        work->imaginary[i] = GSL_IMAG(gsl_vector_complex_get(values, i));
    }
    gsl_eigen_nonsymm_free(workspace);
    gsl_vector_complex_free(values);
    return solved;
}

bool gm_eigenvalues(double *matrix, size_t n, double *real, double *imaginary)
{
    return is_finite(matrix, n * n) &&
           gm_memory_guard_gsl(solve, &(struct work){matrix, real, imaginary, n, 0, NULL});
}

static bool solve_singular(void *data)
{
    const struct work *work = data;
    const size_t n = work->n;
    gsl_matrix *v = gsl_matrix_alloc(n, n);
    gsl_vector *values = gsl_vector_alloc(n), *spare = gsl_vector_alloc(n);
    gsl_matrix_view u = gsl_matrix_view_array(work->matrix, n, n);
    gsl_vector_view x = gsl_vector_view_array(work->x, n);
    bool good = v && values && spare && gsl_linalg_SV_decomp(&u.matrix, v, values, spare) == GSL_SUCCESS;
    for (size_t i = 0; good && i < n; i++) { /* a value of 0 is left out of the solution */
        const double value = gsl_vector_get(values, i);
        gsl_vector_set(values, i, value < work->cutoff * gsl_vector_get(values, 0) ? 0 : value);
    }
    good = good && gsl_vector_memcpy(spare, &x.vector) == GSL_SUCCESS &&
           gsl_linalg_SV_solve(&u.matrix, v, values, spare, &x.vector) == GSL_SUCCESS;
    gsl_matrix_free(v);
    gsl_vector_free(values);
    gsl_vector_free(spare);
    return good;
}

bool gm_singular_solve(double *matrix, size_t n, double cutoff, double *x)
{
    return is_finite(matrix, n * n) && is_finite(x, n) &&
           gm_memory_guard_gsl(solve_singular, &(struct work){matrix, NULL, NULL, n, cutoff, x});
}
