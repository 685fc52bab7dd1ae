/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cells of a grid as rows of CSV, and as JSON. */
#include <errno.h>
#include <math.h>
#include <stdio.h>

#include "app/grid/hooks.h"
#include "app/grid/judge.h"

void gm_work_put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell, int number)
{
    (void)number;
    if (grid->parameter) {
        gm_row_number(row, grid->parameter->key, cell->value, 17);
    }
    gm_row_number(row, "dt", cell->dt, 17);
    gm_row_count(row, "steps", (double)cell->steps);
    gm_row_number(row, "t", cell->t, 17);
    gm_row_text(row, "status", gm_status_name(cell->status));
    gm_row_number(row, row->form == GM_ROW_HEAD ? grid->measure : "error",
                  isfinite(cell->error) ? cell->error : NAN, 17);
    gm_row_number(row, "seconds", cell->seconds, 6);
    gm_row_count(row, "evaluations", cell->evaluations);
    gm_row_count(row, "solves", cell->solves);
}

void gm_stability_put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell,
                      int number)
{
    char judge[64];
    (void)number;
    gm_row_number(row, grid->parameter->key, cell->value, 17);
    gm_row_number(row, "step", cell->step, 17);
    gm_row_number(row, "dt", cell->dt, 17);
    gm_row_text(row, "verdict", gm_cell_word(grid, cell));
    gm_row_text(row, "status", gm_status_name(cell->status));
    gm_row_number(row, "t", cell->t, 17);
    gm_row_number(row, "ratio", isfinite(cell->ratio) ? cell->ratio : NAN, 9);
    gm_row_number(row, "error", isfinite(cell->error) ? cell->error : NAN, 9);
    if (row->form != GM_ROW_JSON) {
        snprintf(judge, sizeof judge, grid->accuracy < INFINITY ? "%s=%.9g" : "%s", gm_stability_judge(grid),
                 grid->accuracy);
        gm_row_text(row, "judge", judge);
    }
}

void gm_backward_put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell,
                     int number)
{
    (void)grid;
    gm_row_number(row, "dt", cell->dt, 17);
    gm_row_text(row, "status", gm_status_name(cell->status));
    gm_row_number(row, "t", cell->t, 17);
    if (row->form == GM_ROW_JSON) {
        gm_row_list(row, "errors", cell->errors, GM_POWERS);
        gm_row_list(row, "terms", cell->terms, GM_POWERS);
        gm_row_count(row, "best", cell->best);
    } else {
        gm_row_count(row, "power", number);
        gm_row_number(row, "error", cell->errors[number], 9);
        gm_row_number(row, "term", cell->terms[number], 9);
    }
    gm_row_number(row, "gamma", isfinite(cell->gamma) ? cell->gamma : NAN, 9);
    if (row->form == GM_ROW_JSON) {
        gm_row_number(row, "drift", exp(-cell->gamma / (2 * cell->dt)), 17);
    }
}

static void put_row(FILE *csv, enum gm_row_form form, const struct gm_grid *grid,
                    const struct gm_scheme *scheme, const struct gm_grid_cell *cell, int number)
{
    struct gm_row row = {.stream = csv, .form = form};
    gm_row_text(&row, "scene", grid->request.scene->name);
    gm_row_text(&row, "scheme", scheme->name);
    if (grid->row->ordered) {
        gm_row_count(&row, "order", scheme->order);
    }
    grid->row->put_cell(&row, grid, cell, number);
    fputc('\n', csv);
}

bool gm_cells_write(const struct gm_grid *grid, const char *path)
{
    FILE *csv = fopen(path, "w");
    if (!csv) {
        return false;
    }
    put_row(csv, GM_ROW_HEAD, grid, grid->lines[0].scheme, &grid->lines[0].cells[0], 0);
    for (size_t i = 0; i < grid->begun; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        for (size_t k = 0; k < line->count; k++) {
            for (int number = 0; line->cells[k].tried && number < grid->row->rows; number++) {
                put_row(csv, GM_ROW_CSV, grid, line->scheme, &line->cells[k], number);
            }
        }
    }
    const bool failed = ferror(csv) != 0;
    return fclose(csv) == 0 && !failed;
}

void gm_grid_put_cells(const struct gm_grid *grid, const struct gm_grid_line *line, const char *key,
                       struct gm_row *row)
{
    struct gm_row list = gm_row_open(row, key, ']');
    for (size_t k = 0; k < line->count; k++) {
        if (line->cells[k].tried) {
            struct gm_row cell = gm_row_open(&list, NULL, '}');
            grid->row->put_cell(&cell, grid, &line->cells[k], 0);
            gm_row_close(&cell);
        }
    }
    gm_row_close(&list);
}
