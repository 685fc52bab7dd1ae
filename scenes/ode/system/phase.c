/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The phase portrait: arrows of the field's direction, nullclines, equilibria. */
#include "core/functions/functions.h"
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/kernel/loops.h"
#include "scenes/common/symbol.h"

static const char chosen[] = "auto"; /* the window that the picture chooses */

/* ---- parameters ---- */

bool gm_system_is_plane(const struct gm_system_scene *system_scene, char *sentence)
{
    const struct gm_user_system *system = &system_scene->system;
    if (system_scene->model.constraints.count > 0) {
        return gm_refuse(sentence, "portrait needs a plane: this system has constraints");
    }
    if (system->tangents > 0) {
        return gm_refuse(sentence, "portrait needs a plane: this system carries tangents of its motion");
    }
    if (system->n != 2) {
        return gm_refuse(sentence, "portrait needs a plane: this system has %zu component%s", system->n,
                         gm_plural((double)system->n));
    }
    return !system->timed || gm_refuse(sentence, "portrait needs a field that does not depend on t");
}

bool gm_system_admits_portrait(const struct gm_parameter *row, const char *text, char *sentence)
{
    const struct gm_system_scene *system_scene = row->admitting;
    while (system_scene && !gm_system_is_plane(system_scene, sentence)) {
        system_scene = system_scene->next;
    }
    return strcmp(text, "yes") != 0 || system_scene || gm_system_is_plane(row->admitting, sentence);
}

/* Reads "XMIN,XMAX,YMIN,YMAX". Returns false with a sentence for any other text. */
static bool read_window(const char *text, struct gm_window *window, char *sentence)
{
    double bounds[4];
    char part[GM_TEXT_SIZE];
    const char *from = text;
    for (size_t k = 0; k < 4; k++) {
        const size_t length = strcspn(from, ",");
        memcpy(part, from, length);
        part[length] = '\0';
        const bool is_last = from[length] != ',';
        if (!gm_number_parse(part, &bounds[k]) || !isfinite(bounds[k]) || is_last != (k == 3)) {
            return gm_refuse(sentence, "window=%.60s is not four finite numbers XMIN,XMAX,YMIN,YMAX", text);
        }
        from += length + 1;
    }
    *window = (struct gm_window){{bounds[0], bounds[2]}, {bounds[1], bounds[3]}};
    return (bounds[0] < bounds[1] && bounds[2] < bounds[3]) ||
           gm_refuse(sentence, "window=%.60s is empty: XMIN lies below XMAX, and YMIN below YMAX", text);
}

bool gm_system_admits_window(const struct gm_parameter *row, const char *text, char *sentence)
{
    struct gm_window window;
    (void)row;
    return strcmp(text, chosen) == 0 || read_window(text, &window, sentence);
}

bool gm_system_window(const struct gm_system_lane *lane, const struct gm_sight *sight,
                      struct gm_window *window)
{
    char sentence[GM_MESSAGE];
    return sight->dimensions == 2 && !sight->over_time && lane->window[0] &&
           strcmp(lane->window, chosen) != 0 && read_window(lane->window, window, sentence);
}

bool gm_system_has_portrait(const struct gm_system_lane *lane, const struct gm_sight *sight)
{
    char sentence[GM_MESSAGE];
    return lane->portrait && sight->dimensions == 2 && sight->components[0] == 0 &&
           sight->components[1] == 1 && gm_system_is_plane(lane->owner, sentence);
}

bool gm_system_portrait(const struct gm_lane *lane, struct gm_portrait *portrait)
{
    const struct gm_system_lane *parameters = lane->parameters;
    const struct gm_sight *sight = gm_system_sight(parameters);
    const struct gm_view view = gm_lane_view(lane);
    struct gm_window window;
    if (!gm_system_has_portrait(parameters, sight)) {
        return false;
    }
    const bool is_given = gm_system_window(parameters, sight, &window);
    const struct gm_entries *past = &lane->entries[GM_TRACK_PAST];
    for (size_t c = 0; c < 2 && !is_given; c++) {
        double low = view.state[c * view.problem->m + gm_system_centre(&view)], high = low;
        for (size_t i = 0; i < past->count; i++) {
            gm_range_add(&low, &high, past->values[2 * i + c]);
        }
        const double margin = high > low ? (high - low) / 8 : fmax(fabs(high), 1);
        window.low[c] = low - margin;
        window.high[c] = high + margin;
    }
    const bool good = gm_portrait_open(portrait, &lane->problem, &window);
    if (!good) {
        gm_portrait_close(portrait);
    }
    return good;
}

/* ---- drawing ---- */

/* A net of arrows, for panels whose shorter side has at least that many dots, and fewer than those of the next. */
enum { ARROWS = 20 * 15 };
static const struct net {
    size_t columns, rows;
    double least, most;
} nets[] = {{5, 4, 0, 48}, {10, 8, 48, 144}, {20, 15, 144, 0}};

/* Draws arrows of one length on the panel, whose axes' lengths are taken as alike. */
static void draw_directions(struct gm_picture *picture, struct gm_panel *panel,
                            const struct gm_problem *problem, const struct net *net)
{
    double places[2 * ARROWS] = {0}, field[2 * ARROWS];
    const size_t count = net->columns * net->rows;
    const double cell[] = {(panel->x.high - panel->x.low) / (double)net->columns,
                           (panel->y.high - panel->y.low) / (double)net->rows};
    /* one length on the screen: in units of the axes, or of cells if these are about square */
    const double least = fmin(cell[0], cell[1]);
    const double unit[] = {panel->equal ? least : cell[0], panel->equal ? least : cell[1]};
    for (size_t k = 0; k < count; k++) {
        places[k] = panel->x.low + cell[0] * ((double)(k % net->columns) + 0.5);
        places[count + k] = panel->y.low + cell[1] * ((double)(k / net->columns) + 0.5);
    }
    gm_field(problem, places, field, count);
    for (size_t k = 0; k < count; k++) {
        const double u = field[k] / unit[0], v = field[count + k] / unit[1], length = gm_hypot(u, v);
        if (!(length > 0) || !isfinite(length)) {
            continue;
        }
        const double along[] = {0.34 * u / length, 0.34 * v / length};
        double line[10];
        const double corners[5][2] = {{-1, 0}, {1, 0}, {0.35, 0.4}, {1, 0}, {0.35, -0.4}};
        for (size_t i = 0; i < 5; i++) {
            const double ahead = corners[i][0], aside = corners[i][1];
            line[2 * i] = places[k] + unit[0] * (ahead * along[0] - aside * along[1]);
            line[2 * i + 1] = places[count + k] + unit[1] * (ahead * along[1] + aside * along[0]);
        }
        struct gm_mark *mark =
            gm_mark_line(picture, panel, (struct gm_style){GM_SECONDARY, 0.45, 1, GM_SOLID}, line, 5, false);
        mark->least = net->least;
        mark->most = net->most;
    }
}

/* Returns the distance of a point from equilibria and from the edge, in parts of the axes. */
static double room_at(const struct gm_panel *panel, const double *point, const struct gm_portrait *portrait)
{
    const double width = panel->x.high - panel->x.low, height = panel->y.high - panel->y.low;
    const double x = (point[0] - panel->x.low) / width, y = (point[1] - panel->y.low) / height;
    double room = fmin(fmin(x, 1 - x), fmin(y, 1 - y));
    for (size_t k = 0; k < portrait->count; k++) {
        const double *at = portrait->equilibria[k].at;
        room = fmin(room, gm_hypot(x - (at[0] - panel->x.low) / width, y - (at[1] - panel->y.low) / height));
    }
    return room;
}

/* Draws a nullcline, with its name at the point with most room. */
static void draw_nullcline(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                           const struct gm_portrait *portrait, size_t component)
{
    const struct gm_system_lane *parameters = lane->parameters;
    const struct gm_style style = {GM_INK, 0.75, 1.7, component == 0 ? GM_LONG_DASH : GM_DOTS};
    const struct gm_mark *before = panel->last;
    const double *place = NULL;
    double most = -INFINITY;
    gm_system_draw_zeros(picture, panel, style, portrait->fields[component],
                         (const size_t[]){GM_PORTRAIT_COLUMNS, GM_PORTRAIT_ROWS});
    for (const struct gm_mark *mark = before ? before->next : panel->first; mark; mark = mark->next) {
        for (size_t i = 0; i < mark->count; i++) {
            const double room = room_at(panel, mark->points + 2 * i, portrait);
            place = room > most ? mark->points + 2 * i : place;
            most = fmax(room, most);
        }
    }
    if (place) {
        const char *name = parameters->owner->system.variables[component].name;
        gm_mark_text(picture, panel, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 1}, place[0],
                     place[1], GM_ANCHOR_CENTRE,
                     gm_picture_text(picture, "%s′ = 0", gm_typeset(picture, name)));
    }
}

/* Draws the equilibria, and adds the kinds that are new to the caption. */
static void draw_equilibria(struct gm_picture *picture, struct gm_panel *panel,
                            const struct gm_portrait *portrait)
{
    static const struct {
        enum gm_glyph glyph;
        const char *name;
    } signs[] = {
        [GM_SADDLE] = {GM_HALF_DISC, "◐ saddle"},      [GM_STABLE_NODE] = {GM_DISC, "● stable"},
        [GM_STABLE_FOCUS] = {GM_DISC, "● stable"},     [GM_UNSTABLE_NODE] = {GM_RING, "○ unstable"},
        [GM_UNSTABLE_FOCUS] = {GM_RING, "○ unstable"}, [GM_CENTRE] = {GM_DOTTED_RING, "◌ centre"},
        [GM_DEGENERATE] = {GM_CROSS, "× degenerate"},  [GM_NOT_SMOOTH] = {GM_CROSS, "× not smooth"},
    };
    for (size_t i = 0; i < portrait->count; i++) {
        const struct gm_style style = {GM_INK, 1, 11, GM_SOLID};
        const enum gm_equilibrium_kind kind = portrait->equilibria[i].kind;
        gm_mark_points(picture, panel, style, portrait->equilibria[i].at, 1)->glyph = signs[kind].glyph;
        if (!strstr(picture->caption, signs[kind].name)) {
            picture->caption = gm_picture_text(picture, "%s%s%s", picture->caption,
                                               picture->caption[0] ? "  " : "", signs[kind].name);
        }
    }
}

struct drawn {
    struct gm_panel *panel;
    const struct gm_lane *lane;
    struct gm_portrait portrait;
};

static void draw(const void *data, struct gm_picture *picture)
{
    const struct drawn *drawn = data;
    for (size_t i = 0; i < GM_COUNT(nets); i++) {
        draw_directions(picture, drawn->panel, &drawn->lane->problem, &nets[i]);
    }
    draw_nullcline(picture, drawn->panel, drawn->lane, &drawn->portrait, 0);
    draw_nullcline(picture, drawn->panel, drawn->lane, &drawn->portrait, 1);
    draw_equilibria(picture, drawn->panel, &drawn->portrait);
}

void gm_system_draw_portrait(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    struct drawn drawn = {.panel = panel, .lane = lane};
    const struct gm_window window = {{panel->x.low, panel->y.low}, {panel->x.high, panel->y.high}};
    if (gm_portrait_open(&drawn.portrait, &lane->problem, &window)) {
        gm_picture_draw(picture, draw, &drawn);
    }
    gm_portrait_close(&drawn.portrait);
}
