/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The terminal painter: marks become glyphs where they belong, text stays text, and no size is too small. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "render/cells/grid.h"

static struct gm_cells cells_of(int columns, int rows)
{
    struct gm_cells cells = {.columns = columns, .rows = rows};
    cells.cells = calloc((size_t)columns * (size_t)rows, sizeof(struct gm_cell));
    assert_non_null(cells.cells);
    return cells;
}

/* A filled disc of radius 1 about the origin in a panel from -2 to 2, and a graph with a rising line. */
static struct gm_picture *make_picture(void)
{
    enum { POINTS = 64 };
    struct gm_picture *picture = gm_picture_open();
    assert_non_null(picture);
    picture->title = "A disc";
    picture->subtitle = picture->caption = "";
    picture->clock = "t = π/2";
    struct gm_panel *state = gm_panel_add(picture, GM_PLACE_STATE, "explicit Euler");
    state->note = "";
    state->x = state->y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = -2, .high = 2};
    state->equal = true;
    double disc[2 * POINTS];
    for (int i = 0; i < POINTS; i++) {
        disc[2 * i] = cos(2 * M_PI * i / POINTS);
        disc[2 * i + 1] = sin(2 * M_PI * i / POINTS);
    }
    const struct gm_style fill = {.role = GM_LANE, .alpha = 0.6}, edge = {GM_LANE, 1, 2, GM_SOLID};
    gm_mark_polygon(picture, state, fill, disc, POINTS);
    gm_mark_line(picture, state, edge, disc, POINTS, true);
    struct gm_panel *graph = gm_panel_add(picture, GM_PLACE_GRAPH, "error");
    graph->note = "";
    graph->x = (struct gm_axis){.label = "t", .scale = GM_LINEAR, .low = 0, .high = 10};
    graph->y = (struct gm_axis){.label = "", .scale = GM_LOG, .low = 1e-6, .high = 1};
    graph->axes = true;
    double line[] = {0, 1e-6, 5, NAN, 6, 1e-3, 10, 1};
    gm_mark_line(picture, graph, (struct gm_style){GM_LANE + 1, 1, 2, GM_LONG_DASH}, line, 4, false);
    return picture;
}

/* One row as text, what is not ASCII as '~'. */
static void row_text(const struct gm_cells *cells, int row, char *text)
{
    for (int i = 0; i < cells->columns; i++) {
        uint32_t glyph = cells->cells[row * cells->columns + i].glyph;
        text[i] = glyph < 0x7F ? (char)glyph : '~';
    }
    text[cells->columns] = '\0';
}

static bool has_text(const struct gm_cells *cells, const char *wanted)
{
    char text[512];
    for (int row = 0; row < cells->rows; row++) {
        row_text(cells, row, text);
        if (strstr(text, wanted)) {
            return true;
        }
    }
    return false;
}

static size_t count_role(const struct gm_cells *cells, enum gm_role role, double *column, double *row)
{
    size_t count = 0;
    *column = *row = 0;
    for (int y = 0; y < cells->rows; y++) {
        for (int x = 0; x < cells->columns; x++) {
            const struct gm_cell *cell = &cells->cells[y * cells->columns + x];
            if (cell->role == role &&
                (cell->glyph >= 0x2580 || strchr("#@*+-:./\\|'\"_", (int)cell->glyph))) {
                count++;
                *column += x + 0.5;
                *row += y + 0.5;
            }
        }
    }
    *column /= (double)count;
    *row /= (double)count;
    return count;
}

static bool is_text_of(enum gm_blocks blocks, uint32_t glyph)
{
    if (glyph < 0x2500 || glyph == 0x2500 || glyph == 0x2502 || glyph == 0x253C || glyph == 0x2514) {
        return true; /* letters and the axes */
    }
    return blocks == GM_BRAILLE && glyph >= 0x2800 && glyph < 0x2900;
}

static void every_block(void **state)
{
    (void)state;
    for (int blocks = 0; blocks < GM_BLOCKS_COUNT; blocks++) {
        struct gm_picture *picture = make_picture();
        struct gm_cells cells = cells_of(120, 36);
        assert_true(gm_cells_paint(&cells, picture, GM_THEME_DARK, (enum gm_blocks)blocks));
        double column, row;
        size_t count = count_role(&cells, GM_LANE, &column, &row);
        /* a disc is as wide as it is high: cells are twice as high as wide */
        assert_true(count > 60);
        assert_true(column > 20 && column < 60);
        assert_true(row > 12 && row < 26);
        assert_true(count_role(&cells, GM_LANE + 1, &column, &row) > 3);
        assert_true(has_text(&cells, "A disc"));
        assert_true(has_text(&cells, "explicit Euler"));
        assert_true(has_text(&cells, blocks == GM_ASCII ? "t = pi/2" : "t = ~/2"));
        for (int i = 0; i < 120 * 36; i++) {
            const struct gm_cell *cell = &cells.cells[i];
            assert_true(cell->glyph >= ' ' && cell->glyph != 0x2800);
            assert_true(blocks != GM_ASCII || cell->glyph < 0x7F);
            assert_true(is_text_of((enum gm_blocks)blocks, cell->glyph) ||
                        (cell->glyph >= 0x2580 && cell->glyph <= 0x259F));
            assert_true(cell->role < GM_ROLE_COUNT);
        }
        free(cells.cells);
        gm_picture_close(picture);
    }
}

static void blank_is_a_space(void **state)
{
    (void)state;
    for (int blocks = 0; blocks < GM_BLOCKS_COUNT; blocks++) {
        struct gm_picture *picture = gm_picture_open();
        picture->title = picture->subtitle = picture->clock = picture->caption = "";
        struct gm_cells cells = cells_of(40, 12);
        struct gm_rgb paper = gm_theme_colour(GM_THEME_LIGHT, GM_PAPER);
        assert_true(gm_cells_paint(&cells, picture, GM_THEME_LIGHT, (enum gm_blocks)blocks));
        for (int i = 0; i < 40 * 12; i++) {
            assert_int_equal(cells.cells[i].glyph, ' ');
            assert_memory_equal(&cells.cells[i].background, &paper, sizeof paper);
        }
        free(cells.cells);
        gm_picture_close(picture);
    }
}

/* The middle of a disc is filled on every side alike, its corners are not. */
static void half_blocks_fill(void **state)
{
    (void)state;
    struct gm_picture *picture = make_picture();
    struct gm_cells cells = cells_of(120, 36);
    assert_true(gm_cells_paint(&cells, picture, GM_THEME_DARK, GM_HALF_BLOCKS));
    double column, row;
    count_role(&cells, GM_LANE, &column, &row);
    struct gm_rgb paper = gm_theme_colour(GM_THEME_DARK, GM_PAPER);
    const struct gm_cell *middle = &cells.cells[(int)row * 120 + (int)column];
    assert_int_equal(middle->glyph, 0x2588);
    assert_int_not_equal(middle->foreground.b, paper.b);
    int width = 0, height = 0;
    for (int x = 0; x < 80; x++) {
        width +=
            cells.cells[(int)row * 120 + x].role == GM_LANE && cells.cells[(int)row * 120 + x].glyph != ' ';
    }
    for (int y = 6; y < 36; y++) {
        height += cells.cells[y * 120 + (int)column].role == GM_LANE &&
                  cells.cells[y * 120 + (int)column].glyph != ' ';
    }
    assert_true(abs(width - 2 * height) <= 3);
    free(cells.cells);
    gm_picture_close(picture);
}

static void any_size(void **state)
{
    (void)state;
    static const int columns[] = {1, 2, 3, 5, 8, 13, 20, 40, 79, 80, 160, 300};
    static const int rows[] = {1, 2, 3, 5, 12, 24, 45, 100};
    for (size_t i = 0; i < GM_COUNT(columns); i++) {
        for (size_t k = 0; k < GM_COUNT(rows); k++) {
            for (int blocks = 0; blocks < GM_BLOCKS_COUNT; blocks++) {
                struct gm_picture *picture = make_picture();
                struct gm_cells cells = cells_of(columns[i], rows[k]);
                assert_true(gm_cells_paint(&cells, picture, GM_THEME_DARK, (enum gm_blocks)blocks));
                free(cells.cells);
                gm_picture_close(picture);
            }
        }
    }
}

/* Fields: an image becomes a background of the map's colours, a mesh likewise. */
static void fields(void **state)
{
    (void)state;
    for (int blocks = 0; blocks < GM_BLOCKS_COUNT; blocks++) {
        struct gm_picture *picture = gm_picture_open();
        picture->title = picture->subtitle = picture->clock = picture->caption = "";
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
        panel->note = "";
        panel->x = panel->y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = 0, .high = 1};
        double corners[] = {0, 0, 1, 0.5}, values[] = {0, 1, NAN, 0.5};
        gm_mark_image(picture, panel, GM_MAP_SEQUENTIAL, 0, 1, corners, values, 2, 2);
        double points[] = {0, 0.5, 1, 0.5, 0.5, 1}, heights[] = {0, 1, 0.5};
        int triangle[] = {0, 1, 2};
        gm_mark_mesh(picture, panel, GM_MAP_DIVERGING, 0, 1, points, heights, 3, triangle, 1);
        struct gm_cells cells = cells_of(60, 20);
        assert_true(gm_cells_paint(&cells, picture, GM_THEME_DARK, (enum gm_blocks)blocks));
        size_t drawn = 0;
        for (int i = 0; i < 60 * 20; i++) {
            drawn += cells.cells[i].glyph != ' ';
        }
        assert_true(drawn > 200);
        free(cells.cells);
        gm_picture_close(picture);
    }
}

/* A colour bar has a point at an end beyond which values lie, and none at the other. */
static void bars_point(void **state)
{
    (void)state;
    for (int blocks = 0; blocks < GM_BLOCKS_COUNT; blocks++) {
        for (int end = 0; end < 2; end++) {
            struct gm_picture *picture = gm_picture_open();
            picture->title = picture->subtitle = picture->clock = picture->caption = "";
            struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
            panel->note = panel->colour_bar_label = "";
            panel->x = panel->y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = 0, .high = 1};
            panel->colour_bar = true;
            gm_mark_image(picture, panel, GM_MAP_SEQUENTIAL, 0, 1, (const double[]){0, 0, 1, 1},
                          (const double[]){0, 0.5, end ? 2 : -1, 1}, 2, 2);
            struct gm_cells cells = cells_of(60, 20);
            assert_true(gm_cells_paint(&cells, picture, GM_THEME_DARK, (enum gm_blocks)blocks));
            size_t points[2] = {0, 0};
            for (int i = 0; i < 60 * 20; i++) {
                const uint32_t glyph = cells.cells[i].glyph;
                points[0] += glyph == (blocks == GM_ASCII ? 'v' : 0x25BC);
                points[1] += glyph == (blocks == GM_ASCII ? '^' : 0x25B2);
            }
            assert_true(points[end] > 0 && points[!end] == 0);
            free(cells.cells);
            gm_picture_close(picture);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_block), cmocka_unit_test(blank_is_a_space), cmocka_unit_test(half_blocks_fill),
        cmocka_unit_test(any_size),    cmocka_unit_test(fields),           cmocka_unit_test(bars_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
