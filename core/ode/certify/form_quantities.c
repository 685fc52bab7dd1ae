/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of a system of forms, and its forms at a time: in tables by their numbers; in pictures 0-forms by value and
   2-forms by density, at vertices or triangles, and 1-forms by vectors at centres of mass. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/form/values.h"
#include "core/memory.h"
#include "core/ode/user/forms.h"
#include "core/quantity.h"
#include "core/run.h"

static const struct gm_form_space *space_of(const struct gm_run *run)
{
    return gm_form_space_of(run->problem);
}

static void points(const struct gm_run *run, size_t first, double *values)
{
    const struct gm_complex *complex = space_of(run)->complex;
    memcpy(values, complex->point + first, complex->coordinates * complex->vertices * sizeof *values);
}

/* The vertices of triangles, 3, or of edges, 2. */
static void corners(const struct gm_run *run, size_t each, double *values)
{
    const struct gm_complex *complex = space_of(run)->complex;
    const int *corner = each == 3 ? complex->triangle : complex->edge;
    for (size_t i = 0; i < each * (each == 3 ? complex->triangles : complex->edges); i++) {
        values[i] = corner[i];
    }
}

static void dual_vertices(const struct gm_run *run, size_t first, double *values)
{
    memcpy(values, space_of(run)->dual_vertex + first,
           3 * space_of(run)->complex->triangles * sizeof *values);
}

/* A form's numbers, and its type. */
static const double *form_at(const struct gm_run *run, size_t named, struct gm_form_type *type)
{
    *type = gm_form_model_of(run->problem)->named[named].type;
    return gm_form_numbers(run->problem, gm_run_state(run), run->t, named);
}

static void numbers(const struct gm_run *run, size_t named, double *values)
{
    struct gm_form_type type;
    const double *form = form_at(run, named, &type);
    memcpy(values, form, gm_form_size(space_of(run)->complex, type) * sizeof *values);
}

static void densities(const struct gm_run *run, size_t named, double *values)
{
    struct gm_form_type type;
    const struct gm_complex *complex = space_of(run)->complex;
    const double *form = form_at(run, named, &type), *cell = type.dual ? complex->star0 : complex->area;
    for (size_t i = 0; i < gm_form_size(complex, type); i++) {
        values[i] = form[i] / (type.degree == 2 ? cell[i] : 1);
    }
}

/* NaN when out of memory, which is noted. */
static void vectors(const struct gm_run *run, size_t named, double *values)
{
    struct gm_form_type type;
    const struct gm_form_space *space = space_of(run);
    const double *form = form_at(run, named, &type);
    double *scratch = malloc(space->complex->edges * sizeof *scratch);
    if (scratch) {
        gm_form_vectors(space, type.dual, form, scratch, values);
    } else {
        gm_memory_refused();
        values[0] = NAN;
    }
    free(scratch);
}

size_t gm_form_quantities(const struct gm_run *run, struct gm_quantity *quantities)
{
    const struct gm_complex *complex = space_of(run)->complex;
    const struct gm_form_model *model = gm_form_model_of(run->problem);
    const struct gm_quantity mesh[] = {
        {"points", GM_ON_NODES, complex->vertices, complex->coordinates, .axis = 1,
         .period = {complex->period[0], complex->period[1]}, .fixed = true, .derive = points},
        {"triangles", GM_ON_CELLS, complex->triangles, 3, 3, .fixed = true, .whole = true, .derive = corners},
        {"edges", GM_ON_EDGES, complex->edges, 2, 2, .fixed = true, .whole = true, .derive = corners},
        {"dual_vertices", GM_ON_CELLS, complex->triangles, 3, .fixed = true, .use = GM_FOR_TABLES,
         .derive = dual_vertices}};
    size_t count = GM_COUNT(mesh);
    memcpy(quantities, mesh, sizeof mesh);
    for (size_t k = 0; k < model->named_count; k++) {
        const struct gm_form_named *form = &model->named[k];
        const size_t places[] = {complex->vertices, complex->edges, complex->triangles};
        const enum gm_support supports[] = {GM_ON_NODES, GM_ON_EDGES, GM_ON_CELLS};
        const int simplex = form->type.dual ? 2 - form->type.degree : form->type.degree;
        struct gm_quantity table = {.support = supports[simplex],
                                    .count = places[simplex],
                                    .width = 1,
                                    .first = k,
                                    .use = GM_FOR_TABLES,
                                    .derive = numbers};
        snprintf(table.name, sizeof table.name, "%s", form->name);
        struct gm_quantity picture = table;
        picture.use = GM_FOR_PICTURES;
        picture.derive = densities;
        if (simplex == 1) {
            picture.support = GM_ON_CELLS;
            picture.count = complex->triangles;
            picture.width = 3;
            picture.derive = vectors;
        }
        quantities[count++] = picture;
        if (form->declared) {
            quantities[count++] = table;
        }
    }
    return count;
}
