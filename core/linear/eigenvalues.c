/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eigenvalues of a small dense matrix, by GSL. */
#include "core/linear/eigenvalues.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>

#include "core/memory.h"

struct work {
    double *matrix, *real, *imaginary;
    size_t n;
};

static bool solve(void *data)
{
    const struct work *work = data;
    gsl_eigen_nonsymm_workspace *workspace = gsl_eigen_nonsymm_alloc(work->n);
    gsl_vector_complex *values = gsl_vector_complex_alloc(work->n);
    gsl_matrix_view view = gsl_matrix_view_array(work->matrix, work->n, work->n);
    const bool good =
        workspace && values && gsl_eigen_nonsymm(&view.matrix, values, workspace) == GSL_SUCCESS;
    for (size_t i = 0; good && i < work->n; i++) {
        work->real[i] = GSL_REAL(gsl_vector_complex_get(values, i));
        work->imaginary[i] = GSL_IMAG(gsl_vector_complex_get(values, i));
    }
    if (workspace) {
        gsl_eigen_nonsymm_free(workspace);
    }
    if (values) {
        gsl_vector_complex_free(values);
    }
    return good;
}

bool gm_eigenvalues(double *matrix, size_t n, double *real, double *imaginary)
{
    for (size_t i = 0; i < n * n; i++) {
        if (!isfinite(matrix[i])) {
            return false;
        }
    }
    return gm_memory_guard_gsl(solve, &(struct work){matrix, real, imaginary, n});
}
