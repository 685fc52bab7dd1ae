/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sparse Cholesky and LU factors, by SuiteSparse: the only file that knows it. It is opened when a flow is:
   with its LAPACK, BLAS and METIS it is a quarter of all that the program would load at every start.

   Triangular solves by supernodes, after E. Ng & B. Peyton, SIAM J. Sci. Comput. 14 (1993) 1034: with x_s the
   columns of a supernode, D its triangle, M what is below it in the rows R,
       L x = b:   x_s = D^-1 b_s,   b_R -= M x_s      from the first supernode on
       L' x = b:  x_s = D^-T (b_s - M' x_R)           from the last one back */
#include "core/linear/cholesky.h"

#include <dlfcn.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <suitesparse/SuiteSparse_config.h>
#include <suitesparse/cholmod.h>
#include <suitesparse/umfpack.h>

#include "core/basics.h"
#include "core/memory.h"

/* ---- triangles ---- */

/* A lower triangular matrix L by supernodes: columns first[s] .. first[s + 1] have their entries in the same
   rows, row[row_start[s]] .. row[row_start[s + 1]] in increasing order, the first of which are the columns
   themselves. The entries are a panel, column by column, from value_start[s] on. Its entries on or above the
   diagonal of L are ignored. Values are doubles, floats, or integers with a unit S_jj for each column,
   L = M S; the two other pointers are NULL. */
struct supernodes {
    size_t n, supernodes, most_rows; /* most_rows: of a panel */
    const int *first, *row_start, *row, *value_start;
    double *wide;
    float *narrow;
    int16_t *whole;
    double *inverse; /* n: 1 / L_ii, or 1 / M_ii */
    double *weight;  /* n: 1 / S_ii^2; not of doubles */
};

#define REAL double
#define STORED double
#define LANES 4
#define VALUES wide
#define PASS(name) name##_wide
#include "core/linear/supernodes.loop.h"

#define REAL float
#define STORED float
#define LANES 8
#define VALUES narrow
#define PASS(name) name##_narrow
#include "core/linear/supernodes.loop.h"

#define REAL float
#define STORED int16_t
#define LANES 8
#define VALUES whole
#define PASS(name) name##_whole
#include "core/linear/supernodes.loop.h"

/* Computes `inverse` from the diagonal. */
static void invert_diagonal(struct supernodes *triangle)
{
    for (size_t s = 0; s < triangle->supernodes; s++) {
        const double *at = triangle->wide + triangle->value_start[s];
        const int rows = triangle->row_start[s + 1] - triangle->row_start[s];
        for (int j = triangle->first[s]; j < triangle->first[s + 1]; j++, at += rows + 1) {
            triangle->inverse[j] = 1 / *at;
        }
    }
}

/* Writes `count` doubles below a diagonal as integers and returns their unit, for which the largest integer
   has its largest value. Here and below the output overwrites doubles that are not needed any more. */
static double make_whole(size_t count, const double *below, double diagonal, char *into)
{
    double most = 1e-9 * diagonal;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, fabs(below[i]));
    }
    const double unit = most / INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        const int16_t whole = (int16_t)rint(below[i] / unit);
        memcpy(into + i * sizeof whole, &whole, sizeof whole);
    }
    return unit;
}

static double make_floats(size_t count, const double *below, char *into)
{
    for (size_t i = 0; i < count; i++) {
        const float narrow = (float)below[i];
        memcpy(into + i * sizeof narrow, &narrow, sizeof narrow);
    }
    return 1;
}

/* Converts the doubles to floats, or to integers if this number of values is then read faster, in the same
   memory. Returns the number of bytes per value. */
static size_t make_narrow(struct supernodes *triangle, size_t values)
{
    const size_t in_cache = (size_t)1 << 20; /* these take less time as floats, which need not be converted */
    const bool whole = values > in_cache;
    const size_t bytes = whole ? sizeof *triangle->whole : sizeof *triangle->narrow;
    char *into = (char *)triangle->wide;
    for (size_t s = 0; s < triangle->supernodes; s++) {
        const size_t rows = (size_t)(triangle->row_start[s + 1] - triangle->row_start[s]),
                     start = (size_t)triangle->value_start[s], first = (size_t)triangle->first[s],
                     columns = (size_t)triangle->first[s + 1] - first;
        for (size_t j = 0; j < columns; j++) {
            const size_t at = start + j * rows + j + 1, count = rows - j - 1;
            const double *below = triangle->wide + at;
            double *inverse = triangle->inverse + first + j;
            const double unit = whole ? make_whole(count, below, 1 / *inverse, into + at * bytes)
                                      : make_floats(count, below, into + at * bytes);
            *inverse *= unit;
            triangle->weight[first + j] = 1 / (unit * unit);
        }
    }
    triangle->whole = whole ? (int16_t *)(void *)into : NULL;
    triangle->narrow = whole ? NULL : (float *)(void *)into;
    triangle->wide = NULL;
    return bytes;
}

/* Solves L L' x = b in place. scratch: n + 3 most_rows numbers. In single precision unless the values are doubles. The
   order of sums does not depend on the processor. */
static void solve_both(const struct supernodes *triangle, double *x, double *scratch)
{
    if (triangle->wide) {
        forward_wide(triangle, x, scratch, NULL);
        backward_wide(triangle, x, scratch, NULL);
        return;
    }
    /* M S S M' x = b */
    float *narrow = (float *)(void *)scratch, *panel = narrow + triangle->n,
          *read = panel + triangle->most_rows;
    for (size_t i = 0; i < triangle->n; i++) {
        narrow[i] = (float)x[i];
    }
    (triangle->whole ? forward_whole : forward_narrow)(triangle, narrow, panel, read);
    for (size_t i = 0; i < triangle->n; i++) {
        narrow[i] = (float)(narrow[i] * triangle->weight[i]);
    }
    (triangle->whole ? backward_whole : backward_narrow)(triangle, narrow, panel, read);
    for (size_t i = 0; i < triangle->n; i++) {
        x[i] = (double)narrow[i];
    }
}

/* ---- factors ---- */

/* L L' = P A P': L and P are CHOLMOD's, which makes them once; solving with them, again and again, is not. */
struct gm_cholesky {
    cholmod_common common;
    cholmod_factor *factor;
    struct supernodes triangle; /* the triangle, in the factor's memory */
    double *numbers;            /* the memory of the next two, and of the triangle's */
    double *permuted, *scratch;
};

/* clang-format off */
#define FUNCTIONS(F) \
    F(cholmod_analyze) F(cholmod_factorize) F(cholmod_finish) F(cholmod_free_factor) F(cholmod_rcond) F(cholmod_start) \
    F(umfpack_di_defaults) F(umfpack_di_free_numeric) F(umfpack_di_free_symbolic) F(umfpack_di_get_numeric) F(umfpack_di_numeric) \
    F(umfpack_di_solve) F(umfpack_di_symbolic)

static struct {
#define POINTER(name) __typeof__(name) *name;
    FUNCTIONS(POINTER)
} suite;
/* clang-format on */

static char missing[256]; /* why the libraries cannot be opened, after the first attempt */

static bool find(void *library, const char *function, void *pointer)
{
    void *found = library ? dlsym(library, function) : NULL;
    memcpy(pointer, &found, sizeof found);
    return found;
}

/* Makes the libraries use the program's allocator, which notes refusals. After a refusal CHOLMOD may continue
   with an ordering that needs less memory and rounds differently. */
static bool let_libraries_take(void *library)
{
#if SUITESPARSE_MAIN_VERSION >= 7
    __typeof__(SuiteSparse_config_malloc_func_set) *set_malloc;
    __typeof__(SuiteSparse_config_calloc_func_set) *set_calloc;
    __typeof__(SuiteSparse_config_realloc_func_set) *set_realloc;
    if (!find(library, "SuiteSparse_config_malloc_func_set", &set_malloc) ||
        !find(library, "SuiteSparse_config_calloc_func_set", &set_calloc) ||
        !find(library, "SuiteSparse_config_realloc_func_set", &set_realloc)) {
        return false;
    }
    set_malloc(malloc);
    set_calloc(calloc);
    set_realloc(realloc);
#else
    struct SuiteSparse_config_struct *config;
    if (!find(library, "SuiteSparse_config", &config)) {
        return false;
    }
    config->malloc_func = malloc;
    config->calloc_func = calloc;
    config->realloc_func = realloc;
#endif
    return true;
}

/* Opens the libraries. The loader's error message shows if memory was the reason of a failure. */
static void open_libraries(void)
{
/* a file's name ends with the version of the interface that the headers have */
#define NAME(library, version) SO(library, version)
#define SO(library, version) "lib" #library ".so." #version
    void *cholmod = dlopen(NAME(cholmod, CHOLMOD_MAIN_VERSION), RTLD_NOW | RTLD_LOCAL);
    void *umfpack = cholmod ? dlopen(NAME(umfpack, UMFPACK_MAIN_VERSION), RTLD_NOW | RTLD_LOCAL) : NULL;
    bool good = umfpack && let_libraries_take(cholmod);
#define FIND(name) good = good && find(#name[0] == 'c' ? cholmod : umfpack, #name, &suite.name);
    FUNCTIONS(FIND)
    if (!good) {
        const char *reason = dlerror();
        snprintf(missing, sizeof missing, "%s", reason ? reason : "it lacks a function");
        if (strstr(missing, "memory")) {
            gm_memory_refused();
        }
    }
}

void gm_cholesky_do_without(const char *reason)
{
    snprintf(missing, sizeof missing, "%s", reason);
}

const char *gm_cholesky_missing(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, open_libraries);
    return missing[0] ? missing : NULL;
}

static size_t largest_panel(const struct supernodes *triangle)
{
    size_t most = 0;
    for (size_t s = 0; s < triangle->supernodes; s++) {
        const size_t rows = (size_t)(triangle->row_start[s + 1] - triangle->row_start[s]);
        most = rows > most ? rows : most;
    }
    return most;
}

/* Stores the factor in half the memory or less, which halves the time of a solve. The test is the loss of the
   solution of A x = 1, which consists mostly of the softest modes of a Laplacian. If a twentieth of it is
   lost, an iteration takes 8 % more steps, for a third 60 %. Returns false if too much is lost; the factor is
   then unusable. */
static bool narrow(struct gm_cholesky *cholesky)
{
    const double good_enough = .25;
    struct supernodes *triangle = &cholesky->triangle;
    cholmod_factor *factor = cholesky->factor;
    const size_t n = triangle->n;
    double *x = malloc(2 * n * sizeof *x);
    if (!x) {
        return false;
    }
    double *rough = x + n, error = 0, size = 0;
    for (size_t i = 0; i < n; i++) {
        x[i] = rough[i] = 1;
    }
    solve_both(triangle, x, cholesky->scratch);
    void *less = realloc(factor->x, factor->xsize * make_narrow(triangle, factor->xsize));
    if (less) {
        factor->x = less;
        triangle->whole = triangle->whole ? less : NULL;
        triangle->narrow = triangle->narrow ? less : NULL;
    }
    solve_both(triangle, rough, cholesky->scratch);
    for (size_t i = 0; i < n; i++) {
        error += (rough[i] - x[i]) * (rough[i] - x[i]);
        size += x[i] * x[i];
    }
    free(x);
    return error <= good_enough * good_enough * size;
}

double gm_cholesky_condition(struct gm_cholesky *cholesky)
{
    return suite.cholmod_rcond(cholesky->factor, &cholesky->common);
}

size_t gm_cholesky_entries(const struct gm_cholesky *cholesky)
{
    return cholesky->factor->xsize;
}

struct gm_cholesky *gm_cholesky_open(size_t n, const int *start, const int *column, const double *value,
                                     enum gm_cholesky_precision precision)
{
    struct gm_cholesky *cholesky = gm_cholesky_missing() ? NULL : calloc(1, sizeof *cholesky);
    if (!cholesky) {
        return NULL;
    }
    cholmod_common *common = &cholesky->common;
    suite.cholmod_start(common);
    common->print = 0;
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->error_handler = NULL;
    common->quick_return_if_not_posdef = 1;
    /* the lower triangle by rows is the upper one by columns; CHOLMOD does not write to it */
    cholmod_sparse matrix = {.nrow = n,
                             .ncol = n,
                             .nzmax = (size_t)start[n],
                             .p = (int *)start,
                             .i = (int *)column,
                             .x = (double *)value,
                             .stype = 1,
                             .itype = CHOLMOD_INT,
                             .xtype = CHOLMOD_REAL,
                             .dtype = CHOLMOD_DOUBLE,
                             .packed = 1};
    cholmod_factor *factor = cholesky->factor = suite.cholmod_analyze(&matrix, common);
    bool good = factor && suite.cholmod_factorize(&matrix, factor, common) && common->status == CHOLMOD_OK &&
                factor->minor == n;
    if (good) {
        struct supernodes *triangle = &cholesky->triangle;
        *triangle = (struct supernodes){.n = n,
                                        .supernodes = factor->nsuper,
                                        .first = factor->super,
                                        .row_start = factor->pi,
                                        .row = factor->s,
                                        .value_start = factor->px,
                                        .wide = factor->x};
        triangle->most_rows = largest_panel(triangle);
        cholesky->numbers = malloc((4 * n + 3 * triangle->most_rows) * sizeof *cholesky->numbers);
        good = cholesky->numbers;
    }
    if (!good) {
        gm_cholesky_close(cholesky);
        return NULL;
    }
    cholesky->triangle.inverse = cholesky->numbers;
    cholesky->triangle.weight = cholesky->numbers + n;
    cholesky->permuted = cholesky->numbers + 2 * n;
    cholesky->scratch = cholesky->numbers + 3 * n;
    invert_diagonal(&cholesky->triangle);
    if (precision == GM_CHOLESKY_ROUGH && !narrow(cholesky)) {
        gm_cholesky_close(cholesky);
        return gm_cholesky_open(n, start, column, value, GM_CHOLESKY_EXACT);
    }
    return cholesky;
}

void gm_cholesky_close(void *factor)
{
    struct gm_cholesky *cholesky = factor;
    if (!cholesky) {
        return;
    }
    suite.cholmod_free_factor(&cholesky->factor, &cholesky->common);
    suite.cholmod_finish(&cholesky->common);
    free(cholesky->numbers);
    free(cholesky);
}

void gm_cholesky_solve(struct gm_cholesky *cholesky, const double *b, double *x)
{
    const int *place = cholesky->factor->Perm;
    for (size_t i = 0; i < cholesky->triangle.n; i++) {
        cholesky->permuted[i] = b[place[i]];
    }
    solve_both(&cholesky->triangle, cholesky->permuted, cholesky->scratch);
    for (size_t i = 0; i < cholesky->triangle.n; i++) {
        x[place[i]] = cholesky->permuted[i];
    }
}

struct gm_lu {
    const int *start, *column;
    const double *value;
    double control[UMFPACK_CONTROL];
    void *numeric;
    double entries;
};

/* The number of pivots that are round-off beside the largest; n when out of memory. */
static size_t vanishing_pivots(const struct gm_lu *lu, size_t n)
{
    double *pivots = malloc((n + 1) * sizeof *pivots), largest = 0;
    int scaled_by_division;
    size_t count = 0;
    if (!pivots || suite.umfpack_di_get_numeric(NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, pivots,
                                                &scaled_by_division, NULL, lu->numeric) != UMFPACK_OK) {
        free(pivots);
        return n;
    }
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(pivots[i]));
    }
    for (size_t i = 0; i < n; i++) {
        count += !(fabs(pivots[i]) > 1e-13 * largest);
    }
    free(pivots);
    return count;
}

struct gm_lu *gm_lu_open(size_t n, const int *start, const int *column, const double *value,
                         size_t *vanishing)
{
    struct gm_lu *lu = gm_cholesky_missing() ? NULL : calloc(1, sizeof *lu);
    void *symbolic = NULL;
    double info[UMFPACK_INFO];
    if (!lu) {
        return NULL;
    }
    *lu = (struct gm_lu){.start = start, .column = column, .value = value};
    suite.umfpack_di_defaults(lu->control);
    /* nested dissection (METIS) takes longer than minimum degree, but gives faster solves from about this
       size on */
    lu->control[UMFPACK_ORDERING] = n > 20000 ? UMFPACK_ORDERING_METIS : UMFPACK_ORDERING_AMD;
    /* the rows are the columns of the transpose */
    int status =
        suite.umfpack_di_symbolic((int)n, (int)n, start, column, value, &symbolic, lu->control, NULL);
    if (status == UMFPACK_OK) {
        status = suite.umfpack_di_numeric(start, column, value, symbolic, &lu->numeric, lu->control, info);
    }
    suite.umfpack_di_free_symbolic(&symbolic);
    if (status != UMFPACK_OK && !(vanishing && status == UMFPACK_WARNING_singular_matrix)) {
        gm_lu_close(lu);
        return NULL;
    }
    if (vanishing) {
        *vanishing = vanishing_pivots(lu, n);
    }
    lu->entries = info[UMFPACK_LNZ] + info[UMFPACK_UNZ];
    return lu;
}

size_t gm_lu_entries(const struct gm_lu *lu)
{
    return (size_t)lu->entries;
}

void gm_lu_close(void *factors)
{
    struct gm_lu *lu = factors;
    if (lu) {
        suite.umfpack_di_free_numeric(&lu->numeric);
        free(lu);
    }
}

bool gm_lu_apply(const struct gm_lu *lu, const double *b, double *x)
{
    return suite.umfpack_di_solve(UMFPACK_At, lu->start, lu->column, lu->value, x, b, lu->numeric,
                                  lu->control, NULL) == UMFPACK_OK;
}

bool gm_lu_solve(size_t n, const int *start, const int *column, const double *value, const double *b,
                 double *x)
{
    struct gm_lu *lu = gm_lu_open(n, start, column, value, NULL);
    const bool solved = lu && gm_lu_apply(lu, b, x);
    gm_lu_close(lu);
    return solved;
}
