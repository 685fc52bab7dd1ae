/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Room for the coefficients of a method. */
#include "core/theory/coefficients.h"

#include <stdlib.h>
#include <string.h>

bool gm_coefficients_open(struct gm_coefficients *coefficients, enum gm_equations equations, int stages)
{
    const size_t s = (size_t)stages;
    *coefficients = (struct gm_coefficients){.equations = equations, .stages = stages, .evaluations = stages};
    bool good = true;
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        struct gm_ball *room = malloc((s * s + s) * sizeof *room);
        coefficients->a[side] = room;
        coefficients->b[side] = room ? room + s * s : NULL;
        good = good && room;
        for (size_t i = 0; room && i < s * s + s; i++) {
            room[i] = gm_ball_of(0);
        }
    }
    if (!good) {
        gm_coefficients_close(coefficients);
    }
    return good;
}

static bool copy_moved(struct gm_coefficients *copy, const struct gm_coefficients *coefficients)
{
    const size_t count = (size_t)coefficients->moved_count;
    copy->moved = count ? calloc(count, sizeof *copy->moved) : NULL;
    for (size_t i = 0; copy->moved && i < count; i++) {
        if (!gm_coefficients_copy(&copy->moved[i], &coefficients->moved[i])) {
            return false;
        }
        copy->moved_count++;
    }
    return count == 0 || copy->moved;
}

bool gm_coefficients_copy(struct gm_coefficients *copy, const struct gm_coefficients *coefficients)
{
    const size_t s = (size_t)coefficients->stages;
    if (!gm_coefficients_open(copy, coefficients->equations, coefficients->stages)) {
        return false;
    }
    copy->evaluations = coefficients->evaluations;
    copy->nystrom = coefficients->nystrom;
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        memcpy(copy->a[side], coefficients->a[side], s * s * sizeof(struct gm_ball));
        memcpy(copy->b[side], coefficients->b[side], s * sizeof(struct gm_ball));
    }
    if (!copy_moved(copy, coefficients)) {
        gm_coefficients_close(copy);
        return false;
    }
    return true;
}

bool gm_coefficients_open_nystrom(struct gm_coefficients *coefficients, int stages, const struct gm_ball *a,
                                  const struct gm_ball *b, const struct gm_ball *bv, const struct gm_ball *c)
{
    const int all = stages + 2, start = stages, end = stages + 1;
    if (!gm_coefficients_open(coefficients, GM_EQUATIONS_NYSTROM, all)) {
        return false;
    }
    coefficients->evaluations = coefficients->nystrom = stages;
    for (int i = 0; i < stages; i++) {
        coefficients->b[GM_SIDE_P][i] = bv[i];
        coefficients->a[GM_SIDE_P][end * all + i] = b[i];
        coefficients->a[GM_SIDE_Q][i * all + i] = gm_ball_of(1);
        coefficients->a[GM_SIDE_Q][i * all + start] = gm_ball_subtract(c[i], gm_ball_of(1));
        for (int j = 0; j < stages; j++) {
            coefficients->a[GM_SIDE_P][i * all + j] = a[i * stages + j];
        }
    }
    coefficients->b[GM_SIDE_Q][end] = gm_ball_of(1);
    return true;
}

void gm_coefficients_close(struct gm_coefficients *coefficients)
{
    for (int i = 0; i < coefficients->moved_count; i++) {
        gm_coefficients_close(&coefficients->moved[i]);
    }
    free(coefficients->moved);
    for (int side = 0; side < GM_SIDES; side++) {
        free(coefficients->a[side]);
        coefficients->a[side] = coefficients->b[side] = NULL;
    }
}
