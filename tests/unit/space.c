/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Space as it is seen: projections against numbers by hand, depth, and what surfaces hide. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/form/generators.h"
#include "scenes/common/space.h"
#include "scenes/form/form.h"

static void assert_near(double have, double want)
{
    if (!(fabs(have - want) <= 1e-14)) {
        fail_msg("%.17g, expected %.17g", have, want);
    }
}

static struct gm_space from(double azimuth, double elevation)
{
    struct gm_space space = {0};
    gm_space_turn(&space, &(struct gm_camera){.azimuth = azimuth, .elevation = elevation, .zoom = 1}, 0);
    return space;
}

static void check_place(const struct gm_space *space, const double point[3], double x, double y, double depth)
{
    double place[2];
    assert_near(gm_space_place(space, point, place), depth);
    assert_near(place[0], x);
    assert_near(place[1], y);
}

/* From -y the plane of x and z is seen as it is drawn on paper; from above with azimuth -90 that of x and y. */
static void test_projection(void **state)
{
    (void)state;
    const double point[] = {1, 2, 3};
    struct gm_space space = from(-90, 0);
    check_place(&space, point, 1, 3, -2);
    space = from(-90, 90);
    check_place(&space, point, 1, 2, 3);
    space = from(0, 0);
    check_place(&space, point, 2, 3, 1);
    space = from(180, -90); /* from below */
    check_place(&space, point, -2, -1, -3);
    /* azimuth 30, elevation 60: right (-1/2, r, 0), up (-3/4, -r/2, 1/2), to the eye (r/2, 1/4, r), r = sqrt(3)/2 */
    space = from(30, 60);
    check_place(&space, (const double[]){4, 0, 0}, -2, -3, 1.7320508075688772);
    check_place(&space, (const double[]){0, 4, 0}, 3.4641016151377544, -1.7320508075688772, 1);
    check_place(&space, (const double[]){0, 0, 4}, 0, 2, 3.4641016151377544);
}

/* A camera that turns by 30 degrees for each unit of time is after three where another one stands. */
static void test_turn(void **state)
{
    (void)state;
    struct gm_space space = {0};
    gm_space_turn(&space, &(struct gm_camera){.azimuth = -90, .turn = 30, .zoom = 1}, 3);
    check_place(&space, (const double[]){1, 2, 3}, 2, 3, 1);
}

static void test_hidden(void **state)
{
    (void)state;
    static const struct gm_ellipsoid surfaces[] = {{{1, 1, 1}}, {{2, 0.5, 0.5}}};
    struct gm_space space = from(0, 0); /* the eye is on the axis of x */
    space.surfaces = surfaces;
    space.surface_count = 1;
    assert_true(gm_space_hides(&space, (const double[]){-3, 0, 0}, NULL));     /* behind */
    assert_false(gm_space_hides(&space, (const double[]){3, 0, 0}, NULL));     /* before */
    assert_false(gm_space_hides(&space, (const double[]){-3, 1.01, 0}, NULL)); /* beside */
    assert_true(gm_space_hides(&space, (const double[]){-3, 0.99, 0}, NULL));  /* just not */
    assert_true(gm_space_hides(&space, (const double[]){-0.6, 0.8, 0}, NULL)); /* on it, turned away */
    assert_false(gm_space_hides(&space, (const double[]){0.6, 0.8, 0}, NULL)); /* on it, turned here */
    assert_true(gm_space_hides(&space, (const double[]){-0.5, 0, 0}, NULL)); /* within, in its farther half */
    assert_false(gm_space_hides(&space, (const double[]){0.5, 0, 0}, NULL)); /* and its nearer */
    assert_false(gm_space_hides(&space, (const double[]){NAN, NAN, NAN}, NULL)); /* nowhere */
    space.surface_count = 2;
    assert_true(gm_space_hides(&space, (const double[]){-1.5, 0.25, 0}, NULL)); /* by the second alone */
    assert_false(gm_space_hides(&space, (const double[]){1, 0, 0}, NULL));      /* within that, in front */
    assert_true(
        gm_space_hides(&space, (const double[]){1, 0, 0}, &surfaces[0])); /* as part of a surface in it */
    assert_false(gm_space_hides(&space, (const double[]){0.6, 0.8, 0}, &surfaces[0]));
}

/* A line through a sphere: its part before it is strong, that behind it faint, that beside it strong again. */
static void test_hidden_line(void **state)
{
    (void)state;
    static const struct gm_ellipsoid sphere = {{1, 1, 1}};
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    struct gm_space space = from(-90, 0);
    space.surfaces = &sphere;
    space.surface_count = 1;
    space.back = -3;
    space.front = 3;
    const double points[] = {-2, 1.1, 0, -1.5, 1.1, 0, -0.5, 1.1, 0, 0.5, 1.1, 0, 1.5, 1.1, 0, 2, 1.1, 0};
    const struct gm_stroke_in_space stroke = {.style = {GM_INK, 1, 2, GM_SOLID}};
    gm_space_line(picture, panel, &space, stroke, points, 6);
    const struct gm_mark *before = panel->first, *hidden = before->next, *after = hidden->next;
    assert_null(after->next);
    assert_int_equal(before->count, 3);
    assert_int_equal(hidden->count, 2);
    assert_int_equal(after->count, 3);
    assert_true(hidden->style.alpha < 0.5 * before->style.alpha);
    assert_true(before->style.alpha == after->style.alpha && before->style.width == after->style.width);
    assert_near(hidden->points[0], -0.5);
    assert_near(hidden->points[1], 0);
    gm_picture_close(picture);
}

/* What is near is larger, and drawn last. */
static void test_depth(void **state)
{
    (void)state;
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    struct gm_space space = from(-90, 0);
    space.back = -1;
    space.front = 1;
    const double points[] = {1, -1, 0, 2, 1, 0, 3, 0, 0};
    gm_space_points(picture, panel, &space, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 10},
                    points, 3);
    const struct gm_mark *far = panel->first, *between = far->next, *near = between->next;
    assert_near(far->points[0], 2);
    assert_near(between->points[0], 3);
    assert_near(near->points[0], 1);
    assert_true(far->style.width < between->style.width && between->style.width < near->style.width);
    gm_picture_close(picture);
}

/* The scale is the same from every azimuth, half of it shows twice as much; and with surfaces from everywhere. */
static void test_fit(void **state)
{
    (void)state;
    struct gm_panel panel = {0}, other = {0};
    struct gm_space space = from(-90, 0), turned = from(17, 0), above = from(40, 70);
    for (size_t k = 0; k < 3; k++) {
        space.low[k] = turned.low[k] = -1;
        space.high[k] = turned.high[k] = 2;
    }
    gm_space_fit(&space, &(struct gm_camera){.zoom = 1}, 0, &panel);
    gm_space_fit(&turned, &(struct gm_camera){.zoom = 2}, 0, &other);
    assert_near(panel.x.high - panel.x.low, 2 * (other.x.high - other.x.low));
    assert_near(0.5 * (panel.x.high + panel.x.low), 0.5);
    gm_space_fit(&space, &(struct gm_camera){.zoom = 1}, 3, &panel);
    gm_space_fit(&above, &(struct gm_camera){.zoom = 1}, 3, &other);
    assert_near(panel.y.high, other.y.high);
    assert_true(panel.equal && panel.y.high > 3);
}

/* The depth of a triangle of a sheet over a place; -infinity beside it. */
static double depth_at(const struct gm_form_sheet *sheet, size_t i, const double at[2])
{
    const double *p = sheet->places + 6 * i;
    const double area = (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
    const double b = ((at[0] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (at[1] - p[1])) / area,
                 c = ((p[2] - p[0]) * (at[1] - p[1]) - (at[0] - p[0]) * (p[3] - p[1])) / area;
    double z[3], place[2];
    for (size_t k = 0; k < 3; k++) {
        z[k] = gm_space_place(&sheet->sight, sheet->corners + 9 * i + 3 * k, place);
    }
    return b >= 0 && c >= 0 && b + c <= 1 ? z[0] + b * (z[1] - z[0]) + c * (z[2] - z[0]) : -INFINITY;
}

/* The triangle that is painted last at a place is the nearest there, and what is far behind another is hidden. */
static void test_surfaces(void **state)
{
    (void)state;
    static const struct {
        const char *word;
        double numbers[3];
        size_t count;
    } meshes[] = {
        {"torus", {2, 0.8, 24}, 3}, {"torus", {1, 0.3, 40}, 3}, {"sphere", {1, 2}, 2}, {"sphere", {1, 0}, 2}};
    for (size_t m = 0; m < GM_COUNT(meshes); m++) {
        struct gm_triangulation_fault fault;
        struct gm_triangulation mesh;
        assert_true(gm_generator_open(meshes[m].word, meshes[m].numbers, meshes[m].count, GM_STAR_AUTO, &mesh,
                                      &fault));
        const struct gm_complex *complex = mesh.complex;
        for (int view = 0; view < 7; view++) {
            struct gm_picture *picture = gm_picture_open();
            struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
            struct gm_form_sheet sheet;
            size_t covered = 0;
            gm_form_sheet_make(
                picture, panel, complex,
                &(struct gm_camera){.azimuth = 50 * view, .elevation = 30 * view - 90, .zoom = 1}, 0, &sheet);
            assert_true(sheet.count > complex->triangles / 3 && sheet.count < complex->triangles);
            for (size_t n = 0; n < 3000; n++) { /* places that fill the panel evenly */
                const double at[2] = {
                    panel->x.low + fmod(0.7548776662466927 * (double)n, 1) * (panel->x.high - panel->x.low),
                    panel->y.low + fmod(0.5698402909980532 * (double)n, 1) * (panel->y.high - panel->y.low)};
                double last = -INFINITY, nearest = -INFINITY;
                for (size_t i = 0; i < sheet.count; i++) {
                    const double depth = depth_at(&sheet, i, at);
                    last = isfinite(depth) ? depth : last;
                    nearest = fmax(nearest, depth);
                }
                covered += isfinite(nearest);
                assert_true(last == nearest || nearest - last < 0.02);
            }
            assert_true(covered > 1000);
            size_t wrong = 0;
            for (size_t i = 0; i < sheet.count; i++) {
                const double *p = sheet.places + 6 * i,
                             middle[2] = {(p[0] + p[2] + p[4]) / 3, (p[1] + p[3] + p[5]) / 3};
                double nearest = -INFINITY;
                for (size_t other = 0; other < sheet.count; other++) {
                    nearest = fmax(nearest, depth_at(&sheet, other, middle));
                }
                const double before = nearest - depth_at(&sheet, i, middle);
                wrong += sheet.hidden[i] ? before < 0.01 : !(before < 0.9); /* thin ones between cells */
                for (size_t k = 3 * i; k < 3 * i + 3; k++) {
                    assert_true(sheet.light[k] >= 0.45 && sheet.light[k] <= 1);
                }
            }
            assert_true(10 * wrong <= sheet.count);
            gm_picture_close(picture);
        }
        gm_triangulation_close(&mesh);
    }
}

/* A surface away from z = 0 has the scale that it has there. */
static void test_raised_surface(void **state)
{
    (void)state;
    struct gm_triangulation_fault fault;
    struct gm_triangulation mesh;
    struct gm_panel shown[2];
    assert_true(gm_generator_open("torus", (const double[]){2, 0.8, 24}, 3, GM_STAR_AUTO, &mesh, &fault));
    struct gm_picture *picture = gm_picture_open();
    for (size_t k = 0; k < 2; k++) {
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
        struct gm_form_sheet sheet;
        gm_form_sheet_make(picture, panel, mesh.complex, &(struct gm_camera){.elevation = 20, .zoom = 1}, 0,
                           &sheet);
        shown[k] = *panel;
        for (size_t v = 0; v < mesh.complex->vertices; v++) {
            mesh.complex->point[3 * v + 2] += 5;
        }
    }
    assert_near(shown[0].x.high - shown[0].x.low, shown[1].x.high - shown[1].x.low);
    assert_near(shown[0].y.high - shown[0].y.low, shown[1].y.high - shown[1].y.low);
    assert_near(shown[0].y.low + 5 * cos(20 * M_PI / 180), shown[1].y.low);
    gm_picture_close(picture);
    gm_triangulation_close(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_projection), cmocka_unit_test(test_turn),
        cmocka_unit_test(test_hidden),     cmocka_unit_test(test_hidden_line),
        cmocka_unit_test(test_depth),      cmocka_unit_test(test_fit),
        cmocka_unit_test(test_surfaces),   cmocka_unit_test(test_raised_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
