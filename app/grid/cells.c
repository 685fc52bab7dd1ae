/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cells of a grid as rows of CSV, and as JSON. */
#include <stdio.h>

#include "app/grid/hooks.h"

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
