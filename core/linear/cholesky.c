/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse Cholesky and LU factors, by SuiteSparse: the only file that knows it. */
#include "core/linear/cholesky.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <suitesparse/SuiteSparse_config.h>
#include <suitesparse/cholmod.h>
#include <suitesparse/umfpack.h>

struct gm_cholesky {
    cholmod_common common;
    cholmod_factor *factor;
    cholmod_dense *b, *x, *y, *e;
};

/* The libraries' memory is the program's, where a refusal is noted: CHOLMOD may go on with an ordering that
   needs less, and another rounding. */
static void let_libraries_take(void)
{
#if SUITESPARSE_MAIN_VERSION >= 7
    SuiteSparse_config_malloc_func_set(malloc);
    SuiteSparse_config_calloc_func_set(calloc);
    SuiteSparse_config_realloc_func_set(realloc);
#else
    SuiteSparse_config.malloc_func = malloc;
    SuiteSparse_config.calloc_func = calloc;
    SuiteSparse_config.realloc_func = realloc;
#endif
}

static void prepare_libraries(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, let_libraries_take);
}

/* The lower triangle by rows is the upper one by columns. */
static cholmod_sparse *upper_triangle(size_t n, const int *start, const int *column, const double *value,
                                      cholmod_common *common)
{
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        for (int k = start[i]; k < start[i + 1]; k++) {
            count += (size_t)column[k] <= i;
        }
    }
    cholmod_sparse *matrix = cholmod_allocate_sparse(n, n, count, 0, 1, 1, CHOLMOD_REAL, common);
    if (!matrix) {
        return NULL;
    }
    int *p = matrix->p, *row = matrix->i, used = 0;
    double *x = matrix->x;
    for (size_t i = 0; i < n; i++) {
        p[i] = used;
        for (int k = start[i]; k < start[i + 1]; k++) {
            if ((size_t)column[k] <= i) {
                row[used] = column[k];
                x[used++] = value[k];
            }
        }
    }
    p[n] = used;
    return matrix;
}

struct gm_cholesky *gm_cholesky_open(size_t n, const int *start, const int *column, const double *value)
{
    struct gm_cholesky *cholesky = calloc(1, sizeof *cholesky);
    if (!cholesky) {
        return NULL;
    }
    cholmod_common *common = &cholesky->common;
    prepare_libraries();
    cholmod_start(common);
    common->print = 0;
    /* measured: solving takes two thirds of the time without supernodes at 3000 unknowns, as long at 20000 */
    common->supernodal = n < 12000 ? CHOLMOD_SIMPLICIAL : CHOLMOD_AUTO;
    common->error_handler = NULL;
    common->quick_return_if_not_posdef = 1;
    cholmod_sparse *matrix = upper_triangle(n, start, column, value, common);
    if (matrix) {
        cholesky->factor = cholmod_analyze(matrix, common);
    }
    bool good = cholesky->factor && cholmod_factorize(matrix, cholesky->factor, common) &&
                common->status == CHOLMOD_OK && cholesky->factor->minor == n;
    cholmod_free_sparse(&matrix, common);
    cholesky->b = cholmod_zeros(n, 1, CHOLMOD_REAL, common);
    if (good && cholesky->b) {
        /* makes room for the solution and for scratch */
        good = cholmod_solve2(CHOLMOD_A, cholesky->factor, cholesky->b, NULL, &cholesky->x, NULL,
                              &cholesky->y, &cholesky->e, common);
    }
    if (!good || !cholesky->b) {
        gm_cholesky_close(cholesky);
        return NULL;
    }
    return cholesky;
}

void gm_cholesky_close(struct gm_cholesky *cholesky)
{
    if (!cholesky) {
        return;
    }
    cholmod_common *common = &cholesky->common;
    cholmod_free_factor(&cholesky->factor, common);
    cholmod_free_dense(&cholesky->b, common);
    cholmod_free_dense(&cholesky->x, common);
    cholmod_free_dense(&cholesky->y, common);
    cholmod_free_dense(&cholesky->e, common);
    cholmod_finish(common);
    free(cholesky);
}

void gm_cholesky_solve(struct gm_cholesky *cholesky, const double *b, double *x)
{
    const size_t size = cholesky->b->nrow * sizeof(double);
    memcpy(cholesky->b->x, b, size);
    if (cholmod_solve2(CHOLMOD_A, cholesky->factor, cholesky->b, NULL, &cholesky->x, NULL, &cholesky->y,
                       &cholesky->e, &cholesky->common)) {
        memcpy(x, cholesky->x->x, size);
    }
}

bool gm_lu_solve(size_t n, const int *start, const int *column, const double *value, const double *b,
                 double *x)
{
    double control[UMFPACK_CONTROL];
    void *symbolic = NULL, *numeric = NULL;
    prepare_libraries();
    umfpack_di_defaults(control);
    /* the rows are the columns of the transpose */
    bool good =
        umfpack_di_symbolic((int)n, (int)n, start, column, value, &symbolic, control, NULL) == UMFPACK_OK &&
        umfpack_di_numeric(start, column, value, symbolic, &numeric, control, NULL) == UMFPACK_OK &&
        umfpack_di_solve(UMFPACK_At, start, column, value, x, b, numeric, control, NULL) == UMFPACK_OK;
    umfpack_di_free_symbolic(&symbolic);
    umfpack_di_free_numeric(&numeric);
    return good;
}
