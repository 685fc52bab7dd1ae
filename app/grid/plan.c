/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of all kinds: from the words of a command line to lines and cells, and cells as rows of
   CSV and as JSON. */
#include <math.h>
#include <stdio.h>

#include "app/grid/hooks.h"
#include "app/words/words.h"
#include "core/arena.h"

struct gm_timing *gm_grid_timing(const struct gm_grid *grid)
{
    return grid->request.lanes[0].parameters;
}

void gm_axis_add(struct gm_grid_axis *axis, double value)
{
    for (size_t i = 0; i < axis->count; i++) {
        if (axis->values[i] == value) {
            return;
        }
    }
    axis->values[axis->count++] = value;
}

struct gm_grid_line *gm_grid_find(const struct gm_grid *grid, const struct gm_scheme *scheme)
{
    for (size_t i = 0; i < grid->count; i++) {
        if (grid->lines[i].scheme == scheme) {
            return &grid->lines[i];
        }
    }
    return NULL;
}

struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most)
{
    struct gm_grid_line *line = &grid->lines[grid->count++];
    *line = (struct gm_grid_line){.scheme = scheme,
                                  .cells = gm_arena_take(grid->arena, most, sizeof *line->cells)};
    return line;
}

void gm_cells_open(struct gm_grid *grid)
{
    char message[GM_MESSAGE];
    const struct gm_arguments *typed = grid->typed;
    const struct gm_study_row *row = grid->row;
    gm_arena_refuse_if(grid->arena, typed->count == 0, "%s", row->which);
    const struct gm_scene *scene =
        gm_request_scene(typed->count, typed->words, &grid->request.refusal, message);
    gm_arena_check(grid->arena, scene, message);
    struct gm_arguments *words = gm_arguments_in(grid->arena);
    gm_arena_need(grid->arena, gm_words_complete(words, scene, typed, row->usual(grid, scene)));
    if (row->edit) {
        row->edit(grid, words);
    }
    gm_arena_check(grid->arena,
                   gm_request_parse(&grid->request, words->count, words->words, row->schemes, message),
                   message);
    gm_arena_keep(grid->arena, &grid->request, gm_request_close);
    row->lay_out(grid, words);
}

static void put_scheme(struct gm_row *row, const struct gm_grid *grid, const struct gm_scheme *scheme)
{
    gm_row_put(row, "scene %s, scheme %s", grid->request.scene->name, scheme->name);
    if (grid->row->ordered) {
        gm_row_put(row, "order %i", scheme->order);
    }
}

static void put_row(struct gm_row row, const struct gm_grid *grid, const struct gm_grid_line *line,
                    size_t cell, int number)
{
    put_scheme(&row, grid, line->scheme);
    grid->row->put_cell(&row, grid, &line->cells[cell], number);
    fputc('\n', row.stream);
}

bool gm_cells_write(const struct gm_grid *grid, FILE *csv)
{
    put_row((struct gm_row){.stream = csv, .form = GM_ROW_HEAD}, grid, &grid->lines[0], 0, 0);
    for (size_t i = 0; i < grid->begun; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        for (size_t k = 0; k < line->count; k++) {
            for (int number = 0; line->cells[k].tried && number < grid->row->rows; number++) {
                put_row((struct gm_row){.stream = csv, .form = GM_ROW_CSV}, grid, line, k, number);
            }
        }
    }
    return true;
}

static void put_cells(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line)
{
    struct gm_row list = gm_row_open(row, grid->row->cells, ']');
    for (size_t k = 0; k < line->count; k++) {
        if (line->cells[k].tried) {
            struct gm_row cell = gm_row_open(&list, NULL, '}');
            grid->row->put_cell(&cell, grid, &line->cells[k], 0);
            gm_row_close(&cell);
        }
    }
    gm_row_close(&list);
}

static void put_line(const struct gm_grid *grid, const struct gm_grid_line *line)
{
    struct gm_row row = gm_row_begin(stdout);
    put_scheme(&row, grid, line->scheme);
    grid->row->put_front(&row, grid, line);
    put_cells(&row, grid, line);
    if (grid->row->put_end) {
        grid->row->put_end(&row, grid, line);
    }
    gm_row_close(&row);
    putchar('\n');
}

void gm_grid_print(const struct gm_grid *grid, bool json)
{
    if (!json) {
        grid->row->print(grid);
        return;
    }
    for (size_t i = 0; i < grid->begun; i++) {
        put_line(grid, &grid->lines[i]);
    }
}

void gm_print_number(const char *format, int width, double value)
{
    if (isfinite(value)) {
        printf(format, value);
    } else {
        printf(" %*s", width, "-");
    }
}
