/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data painter: pictures as text that tests compare number by number. Its format is part of the golden
   files, so that it changes only together with them. */
#include "tests/common/picture_text.h"

static const char *const role_names[] = {"paper", "ink", "secondary", "grid", "initial", "exact", "over"};
static const char *const dash_names[GM_DASH_COUNT] = {"solid",    "long-dash",  "dots",
                                                      "dash-dot", "short-dash", "dash-dot-dot"};
static const char *const scale_names[] = {"linear", "log", "pi"};
static const char *const map_names[] = {"sequential", "diverging"};
static const char *const anchor_names[] = {"left", "centre", "right"};

static void write_number(FILE *stream, double value)
{
    fprintf(stream, " %.9g", value == 0.0 ? 0.0 : value); /* no negative zero */
}

static void write_numbers(FILE *stream, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        write_number(stream, values[i]);
    }
}

static void write_text(FILE *stream, const char *text)
{
    fputs(" \"", stream);
    for (; text && *text != '\0'; text++) {
        if (*text == '\n') {
            fputs("\\n", stream);
        } else if (*text == '"' || *text == '\\') {
            fprintf(stream, "\\%c", *text);
        } else {
            fputc(*text, stream);
        }
    }
    fputc('"', stream);
}

static void write_role(FILE *stream, enum gm_role role)
{
    if (role >= GM_LANE) {
        fprintf(stream, " lane%d", (int)role - GM_LANE);
    } else {
        fprintf(stream, " %s", role_names[role]);
    }
}

static void write_style(FILE *stream, const struct gm_style *style)
{
    write_role(stream, style->role);
    write_number(stream, style->alpha);
    write_number(stream, style->width);
    fprintf(stream, " %s", dash_names[style->dash]);
}

static void write_map(FILE *stream, const struct gm_mark *mark)
{
    fprintf(stream, " %s", map_names[mark->map]);
    write_number(stream, mark->low);
    write_number(stream, mark->high);
}

static void write_mesh(FILE *stream, const struct gm_mark *mark)
{
    fputs("mesh", stream);
    write_map(stream, mark);
    fprintf(stream, " %zu %zu", mark->count, mark->triangle_count);
    for (size_t i = 0; i < mark->count; i++) {
        write_numbers(stream, mark->points + 2 * i, 2);
        write_number(stream, mark->values[i]);
        if (mark->light) {
            write_number(stream, mark->light[i]);
        }
    }
    for (size_t i = 0; i < 3 * mark->triangle_count; i++) {
        fprintf(stream, " %d", mark->triangles[i]);
    }
}

static void write_mark(FILE *stream, const struct gm_mark *mark)
{
    switch (mark->kind) {
    case GM_MARK_LINE:
        fputs("line", stream);
        write_style(stream, &mark->style);
        fprintf(stream, " %s %zu", mark->closed ? "closed" : "open", mark->count);
        write_numbers(stream, mark->points, 2 * mark->count);
        break;
    case GM_MARK_POINTS:
    case GM_MARK_POLYGON:
        fputs(mark->kind == GM_MARK_POINTS ? "points" : "polygon", stream);
        write_style(stream, &mark->style);
        fprintf(stream, " %zu", mark->count);
        write_numbers(stream, mark->points, 2 * mark->count);
        break;
    case GM_MARK_MESH:
        write_mesh(stream, mark);
        break;
    case GM_MARK_IMAGE:
        fputs("image", stream);
        write_map(stream, mark);
        fprintf(stream, " %zu %zu", mark->rows, mark->columns);
        write_numbers(stream, mark->points, 4);
        write_numbers(stream, mark->values, mark->rows * mark->columns);
        break;
    case GM_MARK_TEXT:
        fputs("text", stream);
        write_style(stream, &mark->style);
        fprintf(stream, " %s", anchor_names[mark->anchor]);
        write_numbers(stream, mark->points, 2);
        write_text(stream, mark->text);
        break;
    }
    fputc('\n', stream);
}

static void write_axis(FILE *stream, const char *name, const struct gm_axis *axis)
{
    fprintf(stream, "%s", name);
    write_text(stream, axis->label);
    fprintf(stream, " %s", scale_names[axis->scale]);
    write_number(stream, axis->low);
    write_number(stream, axis->high);
    fputc('\n', stream);
}

static void write_panel(FILE *stream, const struct gm_panel *panel)
{
    fprintf(stream, "panel %s", panel->place == GM_PLACE_STATE ? "state" : "graph");
    write_role(stream, panel->title_role);
    write_text(stream, panel->title);
    write_text(stream, panel->note);
    for (const struct gm_key *key = panel->first_key; key; key = key->next) {
        fputs(" key", stream);
        write_style(stream, &key->style);
        write_text(stream, key->name);
    }
    fprintf(stream, "%s%s", panel->equal ? " equal" : "", panel->axes ? " axes" : "");
    if (panel->colour_bar) {
        fputs(" colour-bar", stream);
        write_text(stream, panel->colour_bar_label);
    }
    fputc('\n', stream);
    write_axis(stream, "x", &panel->x);
    write_axis(stream, "y", &panel->y);
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        write_mark(stream, mark);
    }
}

void test_picture_write(const struct gm_picture *picture, FILE *stream)
{
    fputs("picture", stream);
    write_text(stream, picture->title);
    write_text(stream, picture->subtitle);
    write_text(stream, picture->clock);
    write_text(stream, picture->caption);
    fputc('\n', stream);
    for (size_t i = 0; i < picture->told_count; i++) {
        fputs("told", stream);
        write_role(stream, picture->told[i].role);
        write_text(stream, picture->told[i].text);
        fputc('\n', stream);
    }
    for (const struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        write_panel(stream, panel);
    }
}
