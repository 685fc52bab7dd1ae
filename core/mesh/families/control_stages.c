/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The equations at the stages of core/mesh/families/control.c, and their derivative. */
#include "core/mesh/families/control.h"

void gm_control_place(void *self, const double *state, double step)
{
    struct gm_control_work *work = self;
    work->h = step;
    const size_t points = work->mesh.points;
    work->state = state;
    gm_elements_place(&work->ends, state);
    gm_elements_evaluate(&work->ends, &work->mesh);
    for (size_t k = 1; k <= points; k++) {
        work->momenta[k - 1] = gm_momentum_u(&work->ends, k);
    }
    for (size_t i = 0; i < work->row->tableau->stages; i++) {
        gm_elements_place(&work->stages[i], state);
    }
}

void gm_control_guess(void *self, double *unknowns)
{
    struct gm_control_work *work = self;
    const size_t points = work->mesh.points, stages = work->row->tableau->stages,
                 per_stage = gm_control_width(work->row);
    for (size_t k = 0; k < points; k++) {
        for (size_t i = 0; i < stages; i++) {
            double *at = unknowns + (k * stages + i) * per_stage;
            at[0] = work->state[2 * points + k];
            if (per_stage == 3) {
                at[1] = work->state[points + k];
                at[2] = work->state[3 * points + k];
            }
        }
    }
}

bool gm_control_residual(void *self, const double *unknowns, double *out)
{
    struct gm_control_work *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t points = work->mesh.points, stages = tableau->stages,
                 per_stage = gm_control_width(work->row);
    const size_t per_node = stages * per_stage;
    for (size_t i = 0; i < stages; i++) {
        struct gm_elements *stage = &work->stages[i];
        for (size_t k = 0; k < points; k++) {
            const double *at = unknowns + k * per_node;
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                sum += tableau->a[i][j] * at[j * per_stage];
            }
            stage->y[k + 1] = work->state[k] + work->h * sum;
            stage->u[k + 1] = at[i * per_stage];
            if (per_stage == 3) {
                stage->x[k + 1] = at[i * per_stage + 1];
                stage->v[k + 1] = at[i * per_stage + 2];
            }
        }
        if (!gm_elements_evaluate(stage, &work->mesh)) {
            return false;
        }
        if (per_stage == 3) {
            gm_elements_constrain(stage, &work->mesh);
        }
    }
    for (size_t i = 0; i < stages; i++) {
        const struct gm_elements *stage = &work->stages[i];
        for (size_t k = 1; k <= points; k++) {
            double *at = out + (k - 1) * per_node + i * per_stage;
            double sum = 0;
            for (size_t j = 0; j < stages; j++) {
                const struct gm_elements *other = &work->stages[j];
                sum += tableau->abar[i][j] * (other->force_y1[k - 1] + other->force_y0[k]);
            }
            at[0] = gm_momentum_u(stage, k) - work->momenta[k - 1] - work->h * sum;
            if (per_stage == 3) {
                at[1] = gm_jump(stage->ell, k);
                at[2] = gm_jump(stage->rate, k);
            }
        }
    }
    return true;
}

/* Rows and columns that do not exist are left out of a 4 x 4 block by the places (y, y) of a 2 x 2 one. */
static void add(struct gm_banded *matrix, const struct gm_control_work *work, size_t element, size_t row,
                size_t column, double factor, double block[4][4], size_t from, size_t by)
{
    const size_t points = work->mesh.points, per_node = gm_control_unknowns(work->row);
    for (size_t a = 0; a < 2; a++) {
        const size_t i = element + a;
        for (size_t b = 0; b < 2; b++) {
            const size_t j = element + b;
            if (i >= 1 && i <= points && j >= 1 && j <= points) {
                gm_banded_add(matrix, (i - 1) * per_node + row, (j - 1) * per_node + column,
                              factor * block[2 * a + from][2 * b + by]);
            }
        }
    }
}

/* The derivative of an element quantity by y (by = 0) or X (by = 1), in the constraint rows. */
static void add_row(struct gm_banded *matrix, const struct gm_control_work *work, size_t element, size_t row,
                    size_t column, double factor, const double values[4], size_t by)
{
    const size_t points = work->mesh.points, per_node = gm_control_unknowns(work->row);
    for (size_t b = 0; b < 2; b++) {
        const size_t j = element + b;
        if (j < 1 || j > points) {
            continue;
        }
        if (element >= 1) {
            gm_banded_add(matrix, (element - 1) * per_node + row, (j - 1) * per_node + column,
                          factor * values[2 * b + by]);
        }
        if (element < points) {
            gm_banded_add(matrix, element * per_node + row, (j - 1) * per_node + column,
                          -factor * values[2 * b + by]);
        }
    }
}

static void transpose(double block[4][4], double out[4][4])
{
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < 4; b++) {
            out[a][b] = block[b][a];
        }
    }
}

void gm_control_jacobian(void *self, const double *unknowns, struct gm_banded *matrix)
{
    (void)unknowns;
    struct gm_control_work *work = self;
    const struct gm_tableau *tableau = work->row->tableau;
    const size_t stages = tableau->stages, per_stage = gm_control_width(work->row);
    const bool mesh_moves = gm_control_moves(work->row);
    const double h = work->h;
    enum { Y, X };
    for (size_t e = 0; e <= work->mesh.points; e++) {
        struct gm_element_matrices at[GM_STAGES];
        double turned[GM_STAGES][4][4]; /* d2l / dz dzdot */
        for (size_t i = 0; i < stages; i++) {
            gm_elements_matrices(&work->stages[i], &work->mesh, e, mesh_moves, &at[i]);
            transpose(at[i].mixed, turned[i]);
        }
        for (size_t i = 0; i < stages; i++) {
            const size_t row = i * per_stage;
            for (size_t m = 0; m < stages; m++) {
                const size_t column = m * per_stage;
                const double a = tableau->a[i][m], abar = tableau->abar[i][m];
                add(matrix, work, e, row, column, h * a, at[i].mixed, Y, Y);
                add(matrix, work, e, row, column, -h * abar, turned[m], Y, Y);
                for (size_t j = 0; j < stages; j++) {
                    add(matrix, work, e, row, column, -h * h * tableau->abar[i][j] * tableau->a[j][m],
                        at[j].stiff, Y, Y);
                }
                if (mesh_moves) {
                    add(matrix, work, e, row, column + 1, -h * abar, at[m].stiff, Y, X);
                    add(matrix, work, e, row, column + 2, -h * abar, turned[m], Y, X);
                    add_row(matrix, work, e, row + 1, column, h * a, at[i].gradient, Y);
                    add_row(matrix, work, e, row + 2, column, h * a, at[i].bend, Y);
                }
            }
            add(matrix, work, e, row, row, 1, at[i].mass, Y, Y);
            if (mesh_moves) {
                add(matrix, work, e, row, row + 1, 1, at[i].mixed, Y, X);
                add(matrix, work, e, row, row + 2, 1, at[i].mass, Y, X);
                add_row(matrix, work, e, row + 1, row + 1, 1, at[i].gradient, X);
                add_row(matrix, work, e, row + 2, row, 1, at[i].gradient, Y);
                add_row(matrix, work, e, row + 2, row + 1, 1, at[i].bend, X);
                add_row(matrix, work, e, row + 2, row + 2, 1, at[i].gradient, X);
            }
        }
    }
}
