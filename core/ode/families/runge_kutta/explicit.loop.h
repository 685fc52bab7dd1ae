/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The explicit Runge-Kutta family over a problem's kernels, for one pass; see core/ode/compiled/pass.h. */

GM_INLINE mask K(explicit_step)(const struct gm_tableau *tableau, struct K(block) * block, double h,
                                const void *parameters, bool compensated, bool stiff,
                                struct K(counts) * counts)
{
    (void)stiff;
    real k[GM_EXPLICIT_LISTED_STAGES][GM_COMPONENTS];
    GM_UNROLL
    for (int i = 0; i < tableau->stages; i++) {
        real stage[GM_COMPONENTS];
        GM_UNROLL
        for (int c = 0; c < GM_COMPONENTS; c += GM_AT_ONCE) {
            some at = K(take)(block->y + c);
            GM_UNROLL
            for (int j = 0; j < GM_EXPLICIT_LISTED_STAGES; j++) { /* a count that every compiler can unroll */
                if (j < i && tableau->a[i][j] != 0) {
                    at += h * tableau->a[i][j] * K(take)(&k[j][c]);
                }
            }
            K(put)(&stage[c], at);
        }
        K(field)(stage, k[i], parameters);
    }
    GM_UNROLL
    for (int c = 0; c < GM_COMPONENTS; c += GM_AT_ONCE) {
        some increment = h * tableau->b[0] * K(take)(&k[0][c]);
        GM_UNROLL
        for (int i = 1; i < tableau->stages; i++) {
            increment += h * tableau->b[i] * K(take)(&k[i][c]);
        }
        K(add_some)(&block->y[c], &block->carry[c], increment, compensated);
    }
    counts->evaluations += (unsigned long)(tableau->stages * counts->lanes);
    return K(all)();
}

#define GM_DRIVE K(explicit_drive)
#define GM_ROW struct gm_tableau
#define GM_STEP K(explicit_step)
#define GM_ABREAST K(ABREAST)
#define GM_QUICK
#include "core/ode/kernel/drive.h"

/* A tableau that is known at run time alone, without its zeros, multiplied by h: stage i adds entries
   from[i] .. from[i + 1), the last row being b. */
struct K(explicit_terms) {
    int stages, from[GM_TABLEAU_STAGES + 2];
    struct {
        int of; /* stage */
        double factor;
    } terms[GM_TABLEAU_STAGES * (GM_TABLEAU_STAGES + 1)];
};

GM_INLINE mask K(explicit_own_step)(const struct K(explicit_terms) * table, struct K(block) * block, double h,
                                    const void *parameters, bool compensated, bool stiff,
                                    struct K(counts) * counts)
{
    (void)h;
    (void)stiff;
    real k[GM_TABLEAU_STAGES][GM_COMPONENTS];
    for (int i = 0; i < table->stages; i++) {
        real stage[GM_COMPONENTS];
        for (int c = 0; c < GM_COMPONENTS; c++) {
            stage[c] = block->y[c];
        }
        for (int t = table->from[i]; t < table->from[i + 1]; t++) {
            for (int c = 0; c < GM_COMPONENTS; c++) {
                stage[c] += table->terms[t].factor * k[table->terms[t].of][c];
            }
        }
        K(field)(stage, k[i], parameters);
    }
    real increment[GM_COMPONENTS];
    int t = table->from[table->stages];
    for (int c = 0; c < GM_COMPONENTS; c++) {
        increment[c] = table->terms[t].factor * k[0][c];
    }
    for (t++; t < table->from[table->stages + 1]; t++) {
        for (int c = 0; c < GM_COMPONENTS; c++) {
            increment[c] += table->terms[t].factor * k[table->terms[t].of][c];
        }
    }
    for (int c = 0; c < GM_COMPONENTS; c++) {
        K(add)(&block->y[c], &block->carry[c], increment[c], compensated);
    }
    counts->evaluations += (unsigned long)(table->stages * counts->lanes);
    return K(all)();
}

#define GM_DRIVE K(explicit_own_drive)
#define GM_ROW struct K(explicit_terms)
#define GM_STEP K(explicit_own_step)
#include "core/ode/kernel/drive.h"

/* The weights are all there, as in the loops of the list. */
static struct gm_progress K(explicit_own_run)(const struct gm_task *task, const struct gm_tableau *tableau)
{
    struct K(explicit_terms) table = {.stages = tableau->stages};
    int count = 0;
    for (int i = 0; i <= tableau->stages; i++) {
        const bool weights = i == tableau->stages;
        const double *row = weights ? tableau->b : tableau->a[i];
        for (int j = 0; j < i; j++) {
            if (weights || row[j] != 0) {
                table.terms[count].of = j;
                table.terms[count++].factor = task->dt * row[j];
            }
        }
        table.from[i + 1] = count;
    }
    return K(explicit_own_drive)(task, &table, task->carry != NULL);
}

__attribute__((unused)) static struct gm_progress K(explicit_runge_kutta_run)(const struct gm_task *task)
{
    const struct gm_tableau *tableau = task->scheme->coefficients;
    switch ((enum gm_explicit_row)tableau->listed) {
#define GM_EXPLICIT(identifier, ...)                                                                         \
    case GM_EXPLICIT_##identifier:                                                                           \
        if (!task->carry) {                                                                                  \
            return K(explicit_drive)(task, &gm_explicit_##identifier, false);                                \
        }                                                                                                    \
        break;
#include "core/ode/families/runge_kutta/explicit.def"
#undef GM_EXPLICIT
    case GM_EXPLICIT_NOT_LISTED:
        break;
    }
    return K(explicit_own_run)(task, tableau); /* compensated runs have no loop of one row */
}
