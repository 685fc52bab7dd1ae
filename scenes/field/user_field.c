/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined field as a scene, of six kinds:
       u_tt = u_xx - V'(u),   H = integral of u_t^2/2 + u_x^2/2 + V(u),   on a ring or between walls,
       the same between ends that hold u, on a moving mesh,
       (M u)_t = R(u, u_x, ..),   of one field or several,
       equations of Korteweg and de Vries, of Schroedinger, of heat and of Burgers, recognised by such rates, with
       the states of the schemes for them,
       K z_t + L z_x = grad S(z).
   A kind is a row: its keys, problem, start, observables and picture. Parameters of the file are keys, with
   the ring and its grid; its conserved and observed quantities are integrals of densities. The scene is made
   while the program runs, and does not change afterwards. */
#include "scenes/field/user_field.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/laws/form.h"
#include "core/field/families/laws/profile.h"
#include "core/field/problems/burgers.h"
#include "core/field/problems/dispersive.h"
#include "core/field/problems/heat.h"
#include "core/field/user/equation.h"
#include "core/field/user/form.h"
#include "core/field/user/potential.h"
#include "core/mesh/user/potential.h"
#include "core/model/equations.h"
#include "core/model/scope.h"
#include "core/ode/user/evolution.h"
#include "core/schemes.h"
#include "core/tape.h"
#include "scenes/common/system/hook.h"
#include "scenes/common/system/pieces.h"
#include "scenes/common/system/rows.h"
#include "scenes/common/system/studies.h"
#include "scenes/common/system/texts.h"
#include "scenes/common/written.h"
#include "scenes/field/frames.h"
#include "scenes/field/observed.h"
#include "scenes/field/profiles.h"
#include "scenes/mesh/observed.h"
#include "scenes/mesh/picture.h"

enum { DT, UNTIL };
enum { MOST_DENSITIES = 32, MOST_OBSERVABLES = 48, MOST_GRAPHS = 3, MOST_ROWS = 6 };
enum { MOST_NODES = 10000000 };
enum { SAMPLES = 4096 }; /* points at which a start is examined */

struct user_field;

/* A kind of field. */
struct kind {
    const struct gm_parameter *rows; /* the points of the grid, then keys of this kind */
    size_t row_count;
    const char *no_walls; /* the reason that the boundary cannot be walls; NULL: it can */
    const char *const *schemes;
    const struct gm_observable *observables;
    size_t observable_count;
    const struct gm_observable *errors; /* against an exact solution */
    size_t error_count;
    unsigned equation; /* facet of the schemes that are for this equation alone; 0: the kind has others */
    const char *graphs[2][MOST_GRAPHS]; /* graphs over time, without and with an exact solution; conserved */
    size_t graph_count;                 /* quantities of the file fill the rest */
    bool (*open)(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values);
    void (*close)(struct gm_problem *problem);
    /* Returns true if the start is possible; else false with a sentence. NULL: it is if it is finite. */
    bool (*closes)(const struct gm_problem *problem, char *sentence, size_t size);
    /* The same of a lane's other parameters; NULL: all are. */
    bool (*admits)(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence);
    void (*start)(const struct gm_problem *problem, double *y); /* NULL: two levels of a wave */
    void (*draw)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    int frame_shown; /* the choice that shows the moving frame, and its picture; NULL: the kind has none */
    void (*draw_frame)(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);
    bool profiles; /* profiles at rest are drawn instead of the surface over space and time */
    double (*value)(const struct gm_view *view,
                    size_t node); /* what the picture shows, and its exact value */
    double (*exact)(const struct gm_view *view, double x);
    const char *name, *content; /* of the value (NULL: of the first field), and of the third local law */
    const struct gm_preference *preferences;
    void (*failure)(const struct gm_view *view, char *text, size_t size); /* NULL: tell_failure */
    /* Returns values, then slopes, of one field after another, as the observed quantity needs them: `place`
       has them for the state. malloc'ed; NULL when out of memory. Without the function it has the state. */
    double *(*profile)(const struct gm_view *view);
    /* Sets the variables of a density at integration point `number`, from 0 on, and its weight; false after
       the last. NULL: the problem integrates. */
    bool (*place)(const struct gm_view *view, size_t number, double *values, double *weight);
};
static const struct kind waves, moving_waves, evolutions, korteweg, schroedinger, heat, burgers, forms;

struct user_field {
    struct gm_system_scene of_file; /* first, so that a pointer to the scene is one to this */
    struct gm_arena *arena;
    const struct kind *kind;
    struct gm_user_wave wave; /* only the member of the kind is used */
    struct gm_user_evolution evolution;
    struct gm_user_form form;
    struct gm_user_equation equation;
    bool elsewhere; /* schemes are asked for that are not for the usual kind of such a field */
    bool solved;    /* an exact solution is known */
    double resolutions[3], errors[3];
    double low, high; /* the range of u at the start */
};

static const struct user_field *owner_of(const struct gm_system_lane *lane)
{
    return (const struct user_field *)lane->owner; /* the system's scene is its first member */
}

static const struct user_field *field_of(const struct gm_view *view)
{
    return owner_of(view->parameters);
}

/* Returns the time at the start of a lane. */
static double begin_of(const void *parameters)
{
    const struct gm_user_system *system = &((const struct gm_system_lane *)parameters)->owner->system;
    return system->variables[system->n].value;
}

/* Returns the line, which all problems of such files have. */
static const struct gm_user_line *line_of(const struct gm_view *view)
{
    return view->problem->parameters;
}

/* ---- observables ---- */

/* Returns the free constant of a potential, by which it may differ from the exact solution; else 0. */
static double constant_of(const struct gm_view *view, size_t component)
{
    const struct kind *kind = field_of(view)->kind;
    const struct gm_grid1 *grid = &view->problem->line;
    return kind == &forms && gm_user_form_is_potential(view->problem, component)
               ? view->state[component * grid->points] -
                     gm_user_line_exact(line_of(view), component, gm_grid1_node(grid, 0), view->t)
               : 0;
}

/* Returns true if the exact solution holds at the view's time, as it does at the start. */
static bool is_known(const struct gm_view *view)
{
    const struct gm_system_scene *of_file = &field_of(view)->of_file;
    const struct gm_system_item *item = gm_system_item_of(&of_file->system, GM_WORD_EXACT_WHILE, 0);
    double value = 1;
    if (item && view->t != view->t0) {
        gm_system_values(&of_file->of_items[item - of_file->system.items], view, 0, &value);
    }
    return value > 0;
}

/* Returns the largest error of all components; of a complex field that of its value. */
static double solution_error(const struct gm_view *view)
{
    const struct user_field *field = field_of(view);
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t components = gm_line_components(&field->of_file.system);
    double constants[GM_MOST_OF_MATRICES], largest = is_known(view) ? 0 : NAN;
    for (size_t c = 0; c < components; c++) {
        constants[c] = constant_of(view, c);
    }
    const double shift = field->kind == &korteweg ? gm_kdv_shift(view) : 0;
    for (size_t i = 0; i < gm_grid1_seen(grid) && !isnan(largest); i++) {
        const double x = gm_grid1_node(grid, i) + shift;
        double error = 0;
        for (size_t c = 0; c < components; c++) {
            const double there = gm_user_line_exact(line_of(view), c, x, view->t),
                         by = view->state[c * grid->points + i] - constants[c] - there;
            error = field->kind == &schroedinger ? hypot(error, by) : gm_larger(fabs(by), error);
        }
        largest = gm_larger(error, largest);
    }
    return largest;
}

static double form_energy(const struct gm_view *view)
{
    return gm_form_energy(view->problem, view->scheme, view->memory);
}

static double form_momentum(const struct gm_view *view)
{
    return gm_form_momentum(view->problem, view->scheme, view->memory);
}

/* Returns the largest stable step by linear theory; NaN if the scheme has no limit. */
static double limit_at(const struct gm_view *view, const double *state)
{
    const struct gm_step_limit *limit = view->scheme->limit;
    return limit ? limit->longest(view->problem, state) : NAN;
}

static double longest_step(const struct gm_view *view)
{
    return limit_at(view, view->state);
}

static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const double longest = limit_at(view, view->start);
    text[0] = '\0';
    if (fabs(view->dt) > longest) {
        snprintf(text, size, "dt = %.4g is beyond %.4g, the limit of linear theory %s", fabs(view->dt),
                 longest, view->scheme->limit->condition);
    }
}

/* Returns the position of the first field's crest: the top of the parabola through the highest node and its
   neighbours. */
static double crest(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const double *u = view->state;
    const size_t points = grid->points;
    size_t top = 0;
    for (size_t i = 1; i < gm_grid1_seen(grid); i++) {
        top = u[i] > u[top] ? i : top;
    }
    const double left = u[top > 0 ? top - 1 : points - 1], right = u[top + 1 < points ? top + 1 : 0],
                 bend = left - 2 * u[top] + right;
    return gm_grid1_node(grid, top) + (bend < 0 ? grid->dx * (left - right) / (2 * bend) : 0);
}

/* Returns the line of the observed quantity, and its number among the file's invariants and observables. */
static const struct gm_system_item *density_of(const struct gm_view *view, size_t *number)
{
    const struct gm_user_system *system = &field_of(view)->of_file.system;
    const char *key = view->observable->key;
    const struct gm_system_item *item = system->items;
    for (*number = 0; item < system->items + system->item_count; item++) {
        const size_t length = strlen(item->name);
        const bool kept = item->word == GM_WORD_INVARIANT;
        if (!kept && item->word != GM_WORD_OBSERVE) {
            continue;
        }
        if (strncmp(key, item->name, length) == 0 && strcmp(key + length, kept ? "_error" : "") == 0) {
            break;
        }
        ++*number;
    }
    return item;
}

static double integral_of(const struct gm_view *view, bool magnitude)
{
    const struct user_field *field = field_of(view);
    const struct kind *kind = field->kind;
    const struct gm_system_scene *of_file = &field->of_file;
    if (!kind->place) {
        size_t number;
        density_of(view, &number);
        return gm_user_evolution_integral(view->problem, number, magnitude, view->state);
    }
    double *values = gm_system_start_values(view->parameters, NULL), weight, density;
    double *profile = kind->profile ? kind->profile(view) : NULL;
    const bool good = values && (profile || !kind->profile);
    struct gm_view placed = *view;
    placed.state = profile ? profile : view->state;
    double sum = good ? 0 : NAN;
    for (size_t i = 0; good && kind->place(&placed, i, values, &weight); i++) {
        gm_tape_values(&of_file->formulas[view->observable - of_file->observables], values, &density, 1);
        sum += weight * (magnitude ? fabs(density) : density);
    }
    free(values);
    free(profile);
    return sum;
}

/* Returns the scale that the file names for the error of an invariant. */
static double natural_scale(const struct gm_view *view)
{
    const struct gm_system_scene *of_file = &field_of(view)->of_file;
    double *values = gm_system_start_values(view->parameters, NULL), scale = NAN;
    if (values) {
        gm_tape_values(&of_file->terms[view->observable - of_file->observables], values, &scale, 1);
    }
    free(values);
    return scale;
}

static double integral(const struct gm_view *view)
{
    return integral_of(view, false);
}

static double terms(const struct gm_view *view)
{
    return integral_of(view, true);
}

static const struct gm_observable usual_errors[] = {
    GM_LOG_OBSERVABLE("solution_error", solution_error, "distance from the exact solution")};

/* ---- pictures ---- */

/* Widens a range to values, except those far beyond `most`. */
static void hold(double *low, double *high, double most, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (fabs(values[i]) <= most) {
            gm_range_add(low, high, values[i]);
        }
    }
}

static double highest_of(const struct user_field *field)
{
    return fmax(fabs(field->low), fabs(field->high));
}

static double exact_first(const struct gm_view *view, double x)
{
    return is_known(view) ? gm_user_line_exact(line_of(view), 0, x, view->t) : NAN;
}

/* Sets the graphs: the error, if an exact solution is known, and conserved quantities. Returns their
   number. */
static size_t graphs_of(const struct user_field *field, struct gm_graph *graphs)
{
    const struct gm_graph kept = {.highest = true, .scale = GM_LOG, .calm_low = 1e-16, .calm_high = 1e-2};
    const char *const *usual = field->kind->graphs[field->solved];
    const struct gm_system_item *item;
    size_t count = 0;
    for (; count < MOST_GRAPHS && (item = gm_system_item_of(&field->of_file.system, GM_WORD_GRAPH, count));
         count++) {
        graphs[count] = (struct gm_graph){.observable = item->name};
        gm_system_graph(item, &graphs[count]);
    }
    if (count > 0) {
        return count;
    }
    for (size_t i = 0; i < MOST_GRAPHS && usual[i]; i++) {
        graphs[count] = kept;
        graphs[count++].observable = usual[i];
    }
    if (field->solved) {
        graphs[0].calm_low = 1e-3;
        graphs[0].calm_high = 1;
    }
    for (size_t i = 0; i < field->of_file.observable_count && count < field->kind->graph_count; i++) {
        const struct gm_observable *observable = &field->of_file.observables[i];
        if (observable->kept && observable->evaluate == integral) {
            graphs[count] = kept;
            graphs[count++].observable = observable->key;
        }
    }
    if (count == 0) {
        graphs[count++] = (struct gm_graph){.observable = "amplitude", .highest = true};
    }
    return count;
}

static void record_shown(const struct gm_view *view, double *entry)
{
    const struct kind *kind = field_of(view)->kind;
    const int show = ((const struct gm_system_lane *)view->parameters)->grid.show;
    const bool of_frame = kind->draw_frame && show == kind->frame_shown;
    gm_surface_record_shown(view, of_frame ? GM_SHOW_FIELD : show, kind->value, entry);
}

/* Returns half the length of a lane's line. */
static double half_length_of(const struct gm_system_lane *lane)
{
    const struct gm_system_scene *owner = lane->owner;
    size_t row = GM_SYSTEM_ROWS;
    while (owner->variables[row] != owner->system.velocities - GM_RING_PARAMETERS) {
        row++;
    }
    return lane->values[row - GM_SYSTEM_ROWS];
}

/* Returns the part of the line that a picture of profiles shows. */
static double shown_of(const struct gm_user_system *system)
{
    const struct gm_system_item *item = gm_system_item_of(system, GM_WORD_HALF_LENGTH, 0);
    return item ? gm_system_option_number(item, GM_OPTION_SHOWN, 1) : 1;
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_system_lane *lane = lanes[0]->parameters;
    const struct user_field *field = owner_of(lane);
    const struct gm_system_scene *of_file = &field->of_file;
    const struct gm_system_item *colours = gm_system_item_of(&of_file->system, GM_WORD_COLOURS, 0);
    const struct gm_view first = gm_lane_view(lanes[0]);
    double ends[2] = {field->low, field->high};
    if (field->kind->draw_frame && lane->grid.show == field->kind->frame_shown) {
        field->kind->draw_frame(lanes, count, picture);
        return;
    }
    if (colours) {
        gm_system_values(&of_file->of_items[colours - of_file->system.items], &first, 0, ends);
    }
    /* of colours that the file names only symmetric ones are those of signs */
    const bool crosses = field->kind == &forms || ends[0] <= (colours ? -1 : -0.2) * ends[1];
    const double most = fmax(fabs(ends[0]), fabs(ends[1])), margin = colours ? 0 : 0.1 * (ends[1] - ends[0]);
    struct gm_field_look look = {
        .value = field->kind->value,
        .exact = field->solved && is_known(&first) ? field->kind->exact : NULL,
        .name = field->kind->name ? field->kind->name : of_file->system.variables[0].name,
        .content = field->kind->content,
        .low = crosses ? -most - margin : ends[0] - margin,
        .high = crosses ? most + margin : ends[1] + margin,
        .map = crosses ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL,
        .show = lane->grid.show,
        .reach = half_length_of(lane) * shown_of(&of_file->system),
    };
    const char *beyond = "";
    bool boosted = false;
    for (size_t i = 0; i < count; i++) {
        const struct gm_view view = gm_lane_view(lanes[i]);
        boosted |= field->kind->draw_frame && gm_framed_of(view.problem)->lambda != 0;
        if (lanes[i]->problem.line.walls && lane->grid.show == GM_SHOW_FIELD) {
            const struct gm_entries *rows = &lanes[i]->entries[0];
            /* a kink that comes back from a wall leads to other values than it came from */
            hold(&look.low, &look.high, 5 * most, rows->values, rows->count * rows->width);
        }
        const double longest = longest_step(&view);
        if (fabs(view.dt) > longest) {
            beyond = gm_picture_text(picture, ",  %s is unstable beyond Δt = %.3g", lanes[i]->scheme->title,
                                     longest);
        }
    }
    const char *subtitle = gm_system_shown_text(picture, lanes, count, GM_WORD_SUBTITLE, "");
    picture->title = gm_system_shown_text(picture, lanes, count, GM_WORD_TITLE, of_file->scene.title);
    if (boosted) {
        picture->title = gm_picture_text(picture, "%s, drawn at rest", picture->title);
    }
    picture->subtitle = gm_picture_text(
        picture, "%s%s%ld points,  Δx = %g%s%s", subtitle, subtitle[0] ? ",  " : "", lane->grid.points,
        lanes[0]->problem.line.dx, gm_shared_step(picture, lanes, count), beyond);
    struct gm_graph graphs[MOST_GRAPHS];
    const size_t graph_count = graphs_of(field, graphs);
    if (field->kind->profiles) {
        picture->subtitle = subtitle;
        gm_draw_profiles(picture, lanes, count, &look, graphs, graph_count);
    } else {
        gm_draw_field(picture, lanes, count, &look, graphs, graph_count);
    }
}

static void draw_mesh(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct user_field *field = owner_of(lanes[0]->parameters);
    const size_t nodes = gm_user_mesh_order(&field->wave);
    struct gm_mesh_look look = {
        .show = (enum gm_mesh_view)((const struct gm_system_lane *)lanes[0]->parameters)->grid.show,
        .front = gm_picture_text(picture, "means of V by %zu of Gauss’s points", nodes),
        .name = field->of_file.system.variables[0].name,
        .scale = GM_LINEAR,
        .low = field->low,
        .high = field->high,
    };
    for (size_t i = 0; i < count; i++) {
        hold(&look.low, &look.high, 5 * highest_of(field), gm_lane_view(lanes[i]).state,
             lanes[i]->problem.n / 4);
    }
    picture->title = field->of_file.scene.title;
    gm_mesh_draw(lanes, count, picture, &look);
}

static const char *const boundaries[] = {"ring", "walls", NULL},
                         *const spaces[] = {"differences", "fourier", NULL},
                         *const shown[] = {"field", "energy-law", "momentum-law", NULL};
#define LANE struct gm_system_lane
#define RING(least) GM_POINTS(LANE, grid.points, "", least, "of the grid")
#define SHOW GM_LAW_ROW(LANE, grid.show, shown)
#define BOUNDARY                                                                                             \
    GM_CHOICE_ROW(LANE, grid.walls, "boundary", "ring", boundaries,                                          \
                  "a ring, or walls that reflect: u_x = 0 at both ends")
#define HIGHEST                                                                                              \
    GM_OBSERVABLE("amplitude", gm_view_amplitude, "largest |u|"),                                            \
        GM_OBSERVABLE("crest", crest, "x where u is highest")
#define ROWS(list) .rows = list, .row_count = GM_COUNT(list)
#define OBSERVABLES(list) .observables = list, .observable_count = GM_COUNT(list)
#define ERRORS(list) .errors = list, .error_count = GM_COUNT(list)

/* ---- the kinds ---- */

/* Returns the ring, or the grid between walls. */
static struct gm_grid1 grid_of(const struct gm_system_lane *lane)
{
    const struct gm_system_item *item = gm_system_item_of(&lane->owner->system, GM_WORD_HALF_LENGTH, 0);
    struct gm_grid1 grid =
        (lane->grid.walls ? gm_between_walls : gm_ring)(half_length_of(lane), lane->grid.points);
    if (item && gm_system_option(item, GM_OPTION_LEFT) && !lane->grid.walls) {
        grid.first = gm_system_option_number(item, GM_OPTION_LEFT, 0);
    }
    return grid;
}

/* Returns the grid from one end of the line to the other. */
static struct gm_grid1 between_ends(const struct gm_system_lane *lane)
{
    const double half_length = half_length_of(lane);
    return (struct gm_grid1){.points = (size_t)lane->grid.points,
                             .dx = 2 * half_length / (double)(lane->grid.points - 1),
                             .first = -half_length};
}

static bool open_wave(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_grid1 grid = grid_of(lane);
    return gm_user_wave_open(problem, &owner_of(lane)->wave, values, &grid);
}

/* Evaluates in the middle between the two levels of the state. */
static bool place_wave(const struct gm_view *view, size_t i, double *values, double *weight)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t x = field_of(view)->of_file.system.velocities, right = i + 1 < grid->points ? i + 1 : 0,
                 left = i > 0 ? i - 1 : grid->points - 1;
    const double *u = view->state, *other = u + grid->points, gap = other[grid->points],
                 jump = right == 0 || i == 0 ? grid->jump : 0;
    if (i == gm_grid1_seen(grid)) {
        return false;
    }
    values[0] = (u[i] + other[i]) / 2;
    values[1] = (other[i] - u[i]) / gap;
    values[x] = gm_grid1_node(grid, i);
    values[x + 1] = ((u[right] + other[right] - u[left] - other[left]) / 2 + jump) / (2 * grid->dx);
    *weight = grid->dx * gm_grid1_share(grid, i);
    return true;
}

static const struct gm_parameter wave_rows[] = {RING(3), SHOW, BOUNDARY};
static const struct gm_observable of_waves[] = {
    GM_WAVE_INVARIANTS, GM_WAVE_LAWS,
    GM_OBSERVABLE("longest_step", longest_step, "longest stable step of linear theory",
                  .missing = "linear theory sets this scheme no limit")};

static const struct kind waves = {
    ROWS(wave_rows),
    OBSERVABLES(of_waves),
    ERRORS(usual_errors),
    .schemes = gm_wave_schemes,
    .graphs = {{"energy_error", "own_energy_error"}, {"solution_error", "own_energy_error"}},
    .graph_count = 2,
    .open = open_wave,
    .close = gm_user_wave_close,
    .closes = gm_user_wave_closes,
    .draw = draw,
    .value = gm_field_u,
    .exact = exact_first,
    .place = place_wave,
};

static bool open_mesh(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_mesh mesh = {half_length_of(lane), lane->grid.points, lane->grid.alpha,
                                      (enum gm_mesh_density)lane->grid.density};
    return gm_user_mesh_open(problem, &owner_of(lane)->wave, values, &mesh);
}

/* Returns field, position or their velocities (`number`) at node k, counted from the left end. */
static double at_node(const struct gm_view *view, const struct gm_mesh *mesh, size_t k, size_t number)
{
    const double left[4] = {mesh->left, mesh->first}, right[4] = {mesh->right, mesh->first + mesh->length};
    if (k == 0) {
        return left[number];
    }
    return k > mesh->points ? right[number] : view->state[number * mesh->points + k - 1];
}

/* Evaluates in the middle of an element. */
static bool place_on_mesh(const struct gm_view *view, size_t k, double *values, double *weight)
{
    const size_t x = field_of(view)->of_file.system.velocities;
    const struct gm_mesh mesh = gm_mesh_of(view);
    double sum[4], rise[4];
    if (k > mesh.points) {
        return false;
    }
    for (size_t i = 0; i < 4; i++) {
        const double before = at_node(view, &mesh, k, i), now = at_node(view, &mesh, k + 1, i);
        sum[i] = now + before;
        rise[i] = now - before;
    }
    values[0] = sum[0] / 2;
    values[1] = (sum[2] - rise[0] / rise[1] * sum[3]) / 2;
    values[x] = sum[1] / 2;
    values[x + 1] = rise[0] / rise[1];
    *weight = rise[1];
    return true;
}

static const struct gm_parameter mesh_rows[] = {
    GM_INTEGER_ROW(LANE, grid.points, "points", "", 1, 1e5, "nodes between the ends", .logarithmic = true),
    GM_CHOICE_ROW(
        LANE, grid.show, "show", "all", gm_mesh_views,
        "what the picture shows: all, the field, the paths of the nodes, the energy, or error over nodes",
        .live = true),
    GM_REAL_ROW(
        LANE, grid.alpha, "alpha", "auto", 0, 1e6,
        "weight of the field's slope in the mesh density; auto: 3/2 over the largest slope at the start, or π/10 of the "
        "length over what u goes up and down there, whichever is less",
        .automatic = true),
    GM_CHOICE_ROW(
        LANE, grid.density, "density", "arclength", gm_mesh_densities,
        "what the nodes equidistribute: arclength, curvature, a mix of both, or arclength that is limited or "
        "tempered where the field is steeper than at the start"),
};
static const struct gm_observable of_mesh[] = {GM_MESH_ENERGIES, GM_MESH_NODES},
                                  mesh_errors[] = {GM_MESH_ERRORS};
static const char *const strategies[] = {"multiplier-lobatto4", "control-gauss4", "uniform-gauss4", NULL};

static const struct kind moving_waves = {
    ROWS(mesh_rows),
    OBSERVABLES(of_mesh),
    ERRORS(mesh_errors),
    .no_walls = "boundary: walls mean u_x = 0, and the ends of a moving mesh hold u",
    .schemes = strategies,
    .open = open_mesh,
    .close = gm_user_mesh_close,
    .closes = gm_user_mesh_rests,
    .draw = draw_mesh,
    .value = gm_field_u,
    .place = place_on_mesh,
};

static bool open_evolution(struct gm_problem *problem, const struct gm_system_lane *lane,
                           const double *values)
{
    const struct gm_grid1 grid = grid_of(lane);
    return gm_user_evolution_open(problem, &owner_of(lane)->evolution, values, &grid,
                                  (enum gm_derivatives)lane->grid.space);
}

static const struct gm_parameter evolution_rows[] = {
    RING(5),
    GM_CHOICE_ROW(LANE, grid.space, "space", "differences", spaces,
                  "derivatives: central differences of order 2, or of waves through the nodes"),
    BOUNDARY};
static const struct gm_observable of_evolutions[] = {HIGHEST};
static const char *const semilinear[] = {"etdrk4", "midpoint", NULL};

static const struct kind evolutions = {
    ROWS(evolution_rows),
    OBSERVABLES(of_evolutions),
    ERRORS(usual_errors),
    .schemes = semilinear,
    .graphs = {{NULL}, {"solution_error"}},
    .graph_count = MOST_GRAPHS,
    .open = open_evolution,
    .close = gm_user_evolution_shut,
    .closes = gm_user_evolution_closes,
    .start = gm_user_evolution_start,
    .draw = draw,
    .value = gm_field_u,
    .exact = exact_first,
};

/* ---- equations that are recognised ---- */

static bool open_equation(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct user_field *field = owner_of(lane);
    const struct gm_grid1 grid = field->kind->profiles ? between_ends(lane) : grid_of(lane);
    const bool good = gm_user_equation_open(problem, &field->equation, values, &grid);
    if (good && field->kind->draw_frame) {
        ((struct gm_framed *)problem->parameters)->frame = lane->grid.frame;
    }
    return good;
}

static void start_line(const struct gm_problem *problem, double *y)
{
    gm_user_line_start(problem->parameters, &problem->line, y);
}

/* Represents the field as the scheme does, unless the line of the quantity says where. */
static double *profile_of(const struct gm_view *view)
{
    const size_t points = view->problem->line.points, n = field_of(view)->of_file.system.n;
    size_t number;
    const char *on = gm_system_option_text(density_of(view, &number), GM_OPTION_ON, NULL);
    struct gm_scheme scheme = *view->scheme;
    if (on) {
        scheme.in_cells = strcmp(on, "cells") == 0;
        scheme.in_modes = false;
    }
    double *all = malloc(2 * n * points * sizeof *all);
    for (size_t c = 0; all && c < n; c++) {
        double *one = gm_field_profile(view->problem, &scheme, view->state + c * points);
        for (size_t i = 0; i < 2 * points; i++) {
            all[2 * c * points + i] = one ? one[i] : NAN;
        }
        free(one);
    }
    return all;
}

static bool place_profile(const struct gm_view *view, size_t i, double *values, double *weight)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_user_system *system = &field_of(view)->of_file.system;
    if (i == grid->points) {
        return false;
    }
    for (size_t c = 0; c < system->n; c++) {
        values[c] = view->state[2 * c * grid->points + i];
        values[system->velocities + 1 + c] = view->state[(2 * c + 1) * grid->points + i];
    }
    values[system->velocities] = gm_grid1_node(grid, i);
    *weight = grid->dx;
    return true;
}

static double modulus(const struct gm_view *view, size_t node)
{
    return hypot(view->state[node], view->state[view->problem->line.points + node]);
}

static double exact_modulus(const struct gm_view *view, double x)
{
    return is_known(view) ? hypot(gm_user_line_exact(line_of(view), 0, x, view->t),
                                  gm_user_line_exact(line_of(view), 1, x, view->t))
                          : NAN;
}

static double modulus_error(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    double largest = is_known(view) ? 0 : NAN;
    for (size_t i = 0; i < grid->points && !isnan(largest); i++) {
        largest = gm_larger(fabs(modulus(view, i) - exact_modulus(view, gm_grid1_node(grid, i))), largest);
    }
    return largest;
}

/* Returns the exact value in the original frame. */
static double exact_at_rest(const struct gm_view *view, double x)
{
    const struct gm_kdv *kdv = gm_kdv_of(view->problem);
    return exact_first(view, x + kdv->framed.lambda * view->t) - kdv->framed.lambda / kdv->eta;
}

/* Laws and frames need schemes that have them. */
static const struct gm_preference preferences[] = {
    {"show=energy-law", {"box"}}, {"show=momentum-law", {"box"}},           {"show=charge-law", {"box"}},
    {"show=mass-law", {"box"}},   {"show=frame", {"evolution-projection"}}, {NULL, {NULL}}};
#define NO_FRAME "the scheme does not step in a moving frame, or the step from here is not solved"
#define EQUATION                                                                                             \
    .no_walls = "boundary: the schemes for this equation alone need no walls",                               \
    .close = gm_user_equation_close, .draw = draw
#define ON_RING                                                                                              \
    .open = open_equation, .preferences = preferences, .profile = profile_of, .place = place_profile

#define FRAME_ROW                                                                                            \
    GM_CHOICE_ROW(                                                                                           \
        LANE, grid.frame, "frame", "each", frames,                                                           \
        "nodes at rest in the frame, or moving by lambda dt per step, for invariant schemes only; each: "    \
        "moving for the invariant schemes, fixed for the others")
static const char *const frames[] = {"each", "fixed", "moving", NULL},
                         *const shown_of_mass[] = {"field",    "energy-law", "momentum-law",
                                                   "mass-law", "frame",      NULL},
                         *const shown_of_charge[] = {"field", "energy-law", "momentum-law", "charge-law",
                                                     NULL};
static const struct gm_parameter korteweg_rows[] = {
    RING(5),
    FRAME_ROW,
    GM_CHOICE_ROW(
        LANE, grid.show, "show", "field", shown_of_mass,
        "what is drawn over space and time: the field, or what each step leaves of a local law; or the "
        "moving frame: a node with its neighbours, and where the frame carries them"),
};
static const struct gm_observable of_korteweg[] = {
    GM_LOCAL_LAWS,
    GM_LOG_OBSERVABLE("local_mass_residual", gm_view_content_residual, "residual of the local mass law",
                      .missing = GM_NO_LAW),
    GM_FORM_RESIDUAL,
    GM_LOG_OBSERVABLE("boost_defect", gm_kdv_boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_FRAME),
    GM_LOG_OBSERVABLE("scaling_defect", gm_kdv_scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_FRAME),
};
static const char *const schemes_of_korteweg[] = {"box", "zabusky-kruskal", "fourier-rk4", NULL};
static const struct kind korteweg = {
    ROWS(korteweg_rows),
    OBSERVABLES(of_korteweg),
    ERRORS(usual_errors),
    EQUATION,
    ON_RING,
    .equation = GM_NEEDS_KDV,
    .frame_shown = 4,
    .draw_frame = gm_kdv_draw_frame,
    .schemes = schemes_of_korteweg,
    .graphs = {{NULL}, {"solution_error"}},
    .graph_count = 2,
    .value = gm_kdv_at_rest,
    .exact = exact_at_rest,
    .content = "mass",
    .failure = gm_kdv_failure,
};

static const struct gm_parameter schroedinger_rows[] = {RING(3),
                                                        GM_LAW_ROW(LANE, grid.show, shown_of_charge)};
static const struct gm_observable of_schroedinger[] = {
    GM_LOCAL_LAWS,
    GM_LOG_OBSERVABLE("local_charge_residual", gm_view_content_residual, "residual of the local charge law",
                      .missing = GM_NO_LAW),
    GM_FORM_RESIDUAL};
static const struct gm_observable schroedinger_errors[] = {
    GM_LOG_OBSERVABLE("solution_error", solution_error, "distance from the exact solution"),
    GM_LOG_OBSERVABLE("modulus_error", modulus_error, "largest error of |ψ|")};
static const char *const schemes_of_schroedinger[] = {"box", "split-step2", "euler-box", NULL};
static const struct kind schroedinger = {
    ROWS(schroedinger_rows),
    OBSERVABLES(of_schroedinger),
    ERRORS(schroedinger_errors),
    EQUATION,
    ON_RING,
    .equation = GM_NEEDS_NLS,
    .schemes = schemes_of_schroedinger,
    .graph_count = 2,
    .start = start_line,
    .value = modulus,
    .exact = exact_modulus,
    .name = "|ψ|",
    .content = "charge",
};

/* Evaluates at the nodes from end to end. */
static bool place_between_ends(const struct gm_view *view, size_t i, double *values, double *weight)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t last = grid->points - 1, x = field_of(view)->of_file.system.velocities,
                 left = i > 0 ? i - 1 : 0, right = i < last ? i + 1 : last;
    const double *u = view->state;
    if (i > last) {
        return false;
    }
    values[0] = u[i];
    values[x] = gm_grid1_node(grid, i);
    values[x + 1] = (u[right] - u[left]) / (grid->dx * (double)(right - left));
    *weight = i == 0 || i == last ? grid->dx / 2 : grid->dx;
    return true;
}

#define PROFILES_ROW                                                                                         \
    GM_CHOICE_ROW(LANE, grid.show, "show", "profiles", profiles_or_frame,                                    \
                  "the profiles, or the moving frame: a node with its neighbours, and where the frame "      \
                  "carries them")
static const char *const profiles_or_frame[] = {"profiles", "frame", NULL};
static const struct gm_parameter heat_rows[] = {RING(5), FRAME_ROW, PROFILES_ROW};
#define NO_SYMMETRY "a value is not positive, or the projection does not exist"
static const struct gm_observable of_heat[] = {
    GM_LOG_OBSERVABLE("boost_defect", gm_heat_boost_defect, "defect of a step under a boost by 1/2",
                      .missing = NO_SYMMETRY),
    GM_LOG_OBSERVABLE("projection_defect", gm_heat_projection_defect,
                      "defect of a step under a projection by 1/2", .missing = NO_SYMMETRY),
    GM_LOG_OBSERVABLE("scaling_defect", gm_heat_scaling_defect, "defect of a step under a scaling by 1.3",
                      .missing = NO_SYMMETRY)};
static const struct gm_observable heat_errors[] = {
    GM_LOG_OBSERVABLE("sup_error", gm_heat_error, "largest error, at rest")};
static const char *const schemes_of_heat[] = {"heat-ftcs", "heat-boosts", "heat-projections", NULL};
/* A frame of boosts and projections needs the scheme that steps in it. */
static const struct gm_preference heat_preferences[] = {{"show=frame", {"heat-projections"}}, {NULL, {NULL}}};

/* The boost multiplies the ends by a power of e. */
static bool is_bounded(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    const struct gm_heat *of = gm_heat_of(problem);
    const double lambda = fabs(of->framed.lambda), most = 300;
    const double power = lambda / (4 * of->diffusivity) *
                         (2 * half_length_of(lane) + 3 * lambda * fmin(lane->timing.until, 1e6));
    return power <= most ||
           gm_refuse(
               sentence,
               "the boost multiplies the ends by exp(%.3g), and exp(300) is the most: a smaller lambda, "
               "half_length or until, or a larger diffusivity",
               power);
}

static const struct kind heat = {
    ROWS(heat_rows),
    OBSERVABLES(of_heat),
    ERRORS(heat_errors),
    EQUATION,
    .open = open_equation,
    .preferences = heat_preferences,
    .equation = GM_NEEDS_HEAT,
    .graphs = {{"boost_defect"}, {"sup_error", "boost_defect"}},
    .graph_count = MOST_GRAPHS,
    .schemes = schemes_of_heat,
    .admits = is_bounded,
    .start = start_line,
    .frame_shown = 1,
    .draw_frame = gm_heat_draw_frame,
    .profiles = true,
    .value = gm_heat_at_rest,
    .exact = gm_heat_exact_at_rest,
    .failure = gm_heat_failure,
    .place = place_between_ends,
};

/* A grid at rest extends to the front's last position. */
static bool open_burgers(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_user_system *system = &lane->owner->system;
    const double lambda = gm_frames_number(system, values, "lambda", 0);
    const double travel =
        lane->grid.frame == GM_FRAME_MOVING ? 0 : lambda * (lane->timing.until - begin_of(lane));
    struct gm_grid1 grid = between_ends(lane);
    const double more = fmin(round(fabs(travel) / grid.dx), MOST_NODES);
    grid.first += gm_frames_number(system, values, "offset", 0) * grid.dx - (travel < 0 ? more * grid.dx : 0);
    grid.points += (size_t)more;
    const bool good = gm_user_equation_open(problem, &owner_of(lane)->equation, values, &grid);
    if (good) {
        struct gm_burgers *opened = (struct gm_burgers *)problem->parameters;
        opened->framed.frame = lane->grid.frame;
        opened->printed = lane->grid.printed;
    }
    return good;
}

/* Behind the field its companion in the frame at rest. */
static void start_burgers(const struct gm_problem *problem, double *y)
{
    const size_t points = problem->line.points;
    const double lambda = gm_framed_of(problem)->lambda;
    start_line(problem, y);
    for (size_t j = 0; j < points && lambda != 0; j++) {
        y[points + j] = y[j] - lambda;
        y[2 * points] = 1;
    }
}

static bool is_held(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    (void)lane;
    const double nodes = (double)problem->line.points;
    return nodes <= MOST_NODES ||
           gm_refuse(
               sentence,
               "the grid would need more than %.3g nodes to hold the front until the end; 1e7 is the most",
               nodes);
}

static const char *const forms_of_convection[] = {"conservative", "printed", NULL};
static const struct gm_parameter burgers_rows[] = {
    RING(5), FRAME_ROW,
    GM_CHOICE_ROW(LANE, grid.printed, "form", "conservative", forms_of_convection,
                  "of the convection in ftcs and crank-nicolson: D(u²/2), or u Du as printed"),
    PROFILES_ROW};
static const struct gm_observable of_burgers[] = {
    GM_OBSERVABLE("overshoot", gm_burgers_overshoot, "overshoot"),
    GM_OBSERVABLE("amplitude", gm_burgers_amplitude, "largest |u − λ|"),
    GM_OBSERVABLE("compression", gm_burgers_compression, "compression in a step, −Δt D₀u"),
    GM_LOG_OBSERVABLE("galilean_defect", gm_burgers_galilean_defect, "difference from the run at λ = 0",
                      .missing = "the run at λ = 0 has failed"),
    GM_LOG_OBSERVABLE("projection_defect", gm_burgers_projection_defect,
                      "defect of a step under a projection by 1/2"),
    GM_LOG_OBSERVABLE("scaling_defect", gm_burgers_scaling_defect,
                      "defect of a step under a scaling by 1.3")};
static const struct gm_observable burgers_errors[] = {
    GM_LOG_OBSERVABLE("sup_error", gm_burgers_sup_error, "largest error"),
    GM_LOG_OBSERVABLE("l1_error", gm_burgers_l1_error, "mean error, h Σ|e|")};
static const char *const schemes_of_burgers[] = {"ftcs", "lax-wendroff", "ftcs-invariant", NULL};
/* A frame needs a scheme that steps in it. */
static const struct gm_preference burgers_preferences[] = {{"show=frame", {"ftcs-invariant"}},
                                                           {NULL, {NULL}}};

static const struct kind burgers = {
    ROWS(burgers_rows),
    OBSERVABLES(of_burgers),
    ERRORS(burgers_errors),
    EQUATION,
    .open = open_burgers,
    .preferences = burgers_preferences,
    .equation = GM_NEEDS_BURGERS,
    .graphs = {{"amplitude"}, {"sup_error", "galilean_defect"}},
    .graph_count = MOST_GRAPHS,
    .schemes = schemes_of_burgers,
    .admits = is_held,
    .start = start_burgers,
    .frame_shown = 1,
    .draw_frame = gm_burgers_draw_frame,
    .profiles = true,
    .value = gm_burgers_at_rest,
    .exact = gm_burgers_exact_at_rest,
    .place = place_between_ends,
};

static bool open_form(struct gm_problem *problem, const struct gm_system_lane *lane, const double *values)
{
    const struct gm_grid1 grid = grid_of(lane);
    return gm_user_form_open(problem, &owner_of(lane)->form, values, &grid);
}

/* Evaluates at the stages of the cells, which a run stores, by Gauss's rule; at the nodes before the first
   step. */
static bool place_in_cell(const struct gm_view *view, size_t number, double *values, double *weight)
{
    static const double left = 0, whole = 1;
    const struct gm_user_system *system = &field_of(view)->of_file.system;
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_collocation_tableau *tableau = view->scheme->coefficients;
    const bool stepped = view->memory != NULL;
    const size_t r = stepped ? tableau->r : 1, i = number / r, m = number % r;
    const double *stages = stepped ? gm_any_form_stages(view->memory) : view->state;
    const double *nodes = stepped ? tableau->c : &left, *weights = stepped ? tableau->b : &whole;
    if (i == grid->points) {
        return false;
    }
    for (size_t c = 0; c < system->n; c++) {
        values[c] = stages[(c * r + m) * grid->points + i];
    }
    values[system->velocities] = gm_grid1_node(grid, i) + nodes[m] * grid->dx;
    *weight = grid->dx * weights[m];
    return true;
}

static const struct gm_parameter form_rows[] = {RING(3), SHOW};
static const struct gm_observable of_forms[] = {
    GM_KEPT_OBSERVABLE("energy_error", form_energy, "H", "energy error"),
    GM_KEPT_OBSERVABLE("momentum_error", form_momentum, "P", "momentum error", .scale = gm_unit_momentum,
                       .scale_text = "1"),
    HIGHEST, GM_LOCAL_LAWS};
static const char *const boxes[] = {"box", "gauss-box3", "gauss-box4", NULL};

static const struct kind forms = {
    ROWS(form_rows),
    OBSERVABLES(of_forms),
    ERRORS(usual_errors),
    .no_walls = "an equation by matrices needs a ring: how a wall reflects its components is not defined",
    .schemes = boxes,
    .graphs = {{"energy_error"}, {"solution_error", "energy_error"}},
    .graph_count = MOST_GRAPHS,
    .open = open_form,
    .close = gm_user_form_close,
    .closes = gm_user_form_closes,
    .start = gm_user_form_start,
    .draw = draw,
    .value = gm_field_u,
    .exact = exact_first,
    .place = place_in_cell,
};

/* ---- from parameters to problem and start ---- */

static struct gm_system_scene *open_other(struct gm_user_system *system, const struct gm_system_scene *first,
                                          char *sentence);

static bool settle(void *parameters, const char *const *keys, size_t count, char *sentence)
{
    return gm_system_settle(parameters, keys, count, open_other, sentence);
}

static void start(const void *parameters, const struct gm_problem *problem, double *y)
{
    const struct gm_system_lane *lane = parameters;
    if (owner_of(lane)->kind->start) {
        owner_of(lane)->kind->start(problem, y);
    } else {
        gm_user_line_levels(problem->parameters, &problem->line, lane->timing.dt, y);
    }
}

static bool start_mesh(const void *parameters, const struct gm_problem *problem,
                       const struct gm_scheme *scheme, double *y, char *sentence)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    const struct gm_system_lane *lane = parameters;
    struct gm_mesh mesh;
    moving->describe(problem, &mesh);
    return gm_mesh_start(&mesh, gm_scheme_mesh(scheme), moving->start, problem->parameters, y) ||
           gm_refuse(
               sentence,
               "no mesh of %ld nodes was found for alpha = %g: the homotopy from the uniform mesh fails; a "
               "smaller alpha helps",
               lane->grid.points, lane->grid.alpha);
}

/* Notes the weight of the slope if the start chose it. */
static void note_alpha(const struct gm_problem *problem, void *parameters)
{
    ((struct gm_system_lane *)parameters)->grid.alpha = gm_user_mesh_alpha(problem);
}

/* Returns the start on a grid: the ring's, or a fine one if the mesh moves. malloc'ed; NULL when out of
   memory. */
static double *start_on(const struct gm_system_lane *lane, const struct gm_problem *problem,
                        struct gm_grid1 *grid)
{
    const bool moves = owner_of(lane)->kind == &moving_waves;
    *grid = moves ? gm_ring(half_length_of(lane), SAMPLES) : problem->line;
    grid->points += moves;
    double *y = malloc((moves ? grid->points : problem->n) * sizeof *y), slope, rate;
    if (y && !moves) {
        start(lane, problem, y);
    }
    for (size_t i = 0; y && moves && i < grid->points; i++) {
        gm_moving_mesh_of(problem)->start(problem->parameters, gm_grid1_node(grid, i), &y[i], &slope, &rate);
    }
    return y;
}

/* Returns true if the exact solution begins like the start, up to 0.1 %, at enough nodes. */
static bool begins_exactly(const struct gm_view *view, const struct gm_grid1 *grid, char *sentence)
{
    const struct user_field *field = field_of(view);
    const size_t apart = gm_grid1_seen(grid) / (SAMPLES + 2) + 1;
    double largest = 1e-9;
    for (size_t i = 0; i < gm_line_components(&field->of_file.system) * grid->points; i++) {
        largest = fmax(largest, fabs(view->state[i]));
    }
    for (size_t c = 0; c < gm_line_components(&field->of_file.system); c++) {
        const double constant = constant_of(view, c);
        for (size_t i = 0; i < gm_grid1_seen(grid); i += apart) {
            const double x = gm_grid1_node(grid, i), begin = view->state[c * grid->points + i],
                         exact = gm_user_line_exact(line_of(view), c, x, line_of(view)->begin) + constant;
            if (!(fabs(exact - begin) <= 1e-3 * largest)) {
                return gm_refuse(sentence,
                                 "exact: %.60s would begin at %.6g where x = %.6g, and it starts at %.6g",
                                 field->of_file.system.variables[c].name, exact, x, begin);
            }
        }
    }
    return true;
}

/* Returns true if a step can lead to the other level of a wave; else false with a sentence. */
static bool has_levels(const struct gm_problem *problem, const char *name, const double *y, char *sentence)
{
    const double most = 1e10; /* the growth that a run treats as a blow-up */
    const size_t points = problem->line.points;
    double begin = 1, further = 0;
    for (size_t i = 0; i < points; i++) {
        if (!isfinite(y[points + i])) {
            return gm_refuse(sentence, "%.60s is not finite where x = %.6g one step after the start", name,
                             gm_grid1_node(&problem->line, i));
        }
        begin = fmax(begin, fabs(y[i]));
        further = fmax(further, fabs(y[points + i]));
    }
    return further <= most * begin ||
           gm_refuse(
               sentence,
               "%.60s would be %.3g one step after the start: V' is too large there, or dt = %.3g too long",
               name, further, y[2 * points]);
}

static bool is_finite(const struct user_field *field, const struct gm_problem *problem, const double *y,
                      char *sentence)
{
    const size_t points = problem->line.points;
    for (size_t i = 0; i < problem->n; i++) {
        if (!isfinite(y[i])) {
            return gm_refuse(
                sentence, "%.60s at the start is not finite where x = %.6g",
                field->of_file.system.variables[i < points ? 0 : field->of_file.system.n - 1].name,
                gm_grid1_node(&problem->line, i % points));
        }
    }
    return true;
}

static bool check_start(const struct gm_system_lane *lane, const struct gm_problem *problem, char *sentence)
{
    const struct user_field *field = owner_of(lane);
    struct gm_grid1 grid;
    if (field->kind->closes && !field->kind->closes(problem, sentence, GM_MESSAGE)) {
        return false;
    }
    double *y = start_on(lane, problem, &grid);
    const struct gm_view view = {.problem = problem, .parameters = lane, .state = y};
    const bool written =
        field->of_file.system.variables[0].start_place > 0; /* else it is the exact solution */
    const bool good = y ? (field->kind->closes || is_finite(field, problem, y, sentence)) &&
                              (!field->solved || !written || begins_exactly(&view, &grid, sentence)) &&
                              (field->kind != &waves ||
                               has_levels(problem, field->of_file.system.variables[0].name, y, sentence))
                        : gm_refuse(sentence, "not enough memory");
    free(y);
    return good;
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct gm_system_lane *lane = parameters;
    const struct kind *kind = owner_of(lane)->kind;
    double *values = gm_system_start_values(lane, NULL);
    if (!values) {
        return gm_refuse(sentence, "not enough memory");
    }
    if (!gm_system_is_admitted(lane, values, sentence)) {
        free(values);
        return false;
    }
    bool good = kind->open(problem, lane, values) || gm_refuse(sentence, "not enough memory");
    problem->name = lane->owner->scene.name;
    free(values);
    good = good && (!kind->admits || kind->admits(lane, problem, sentence)) &&
           check_start(lane, problem, sentence);
    if (!good) {
        kind->close(problem);
    }
    return good;
}

/* Sets the parameter `position`, if the start depends on it. */
static size_t point(const void *parameters, double x, double u, struct gm_choice *choices)
{
    static const char key[] = "position";
    const struct gm_user_system *system = &((const struct gm_system_lane *)parameters)->owner->system;
    size_t count = 0, found = 0;
    gm_node_id *parts = gm_formula_parts(&system->graph, system->variables[0].start, &count);
    for (size_t i = 0; parts && i < count; i++) {
        const struct gm_node *node = &system->graph.nodes[parts[i]];
        found |= node->operation == GM_VARIABLE && strcmp(system->variables[node->a].name, key) == 0;
    }
    free(parts);
    (void)u;
    gm_choose(&choices[0], key, x);
    return found;
}

/* ---- the scene is made ---- */

struct making {
    struct gm_user_system *system;
    const char *name;
    const char *const *words;
    bool elsewhere;
    struct user_field *field;
    struct gm_problem problem; /* the problem of the file's own values */
};

static void close_field(void *thing)
{
    struct user_field *field = thing;
    gm_user_evolution_close(&field->evolution);
    gm_system_close_rows(&field->of_file);
}

static void make_rows(struct user_field *field)
{
    static const enum gm_system_word chosen[] = {GM_WORD_SPACE, GM_WORD_BOUNDARY};
    struct gm_system_scene *of_file = &field->of_file;
    const struct gm_user_system *system = &of_file->system;
    const struct kind *kind = field->kind;
    struct gm_arena *arena = field->arena;
    const double *values = gm_arena_keep(arena, gm_equations_start(system, NULL), free);
    /* a moving mesh needs fewer nodes */
    const double half_length = values[system->velocities - 2], grid = values[system->velocities - 1],
                 points = kind == &moving_waves ? fmax(1, floor(grid / 4)) : grid;
    const struct gm_parameter timing[GM_SYSTEM_ROWS] = {[DT] = GM_DT("", 1e-9, 1e6), [UNTIL] = GM_UNTIL("")};
    struct gm_parameter common[MOST_ROWS];
    memcpy(common, kind->rows, kind->row_count * sizeof *common);
    common[0].standard = gm_kept_number(&of_file->texts, points, NULL);
    for (size_t i = 0; i < kind->row_count; i++) {
        for (size_t k = 0; k < GM_COUNT(chosen); k++) {
            const char *text = system->texts[chosen[k]];
            const bool here = text && strcmp(common[i].key, gm_system_words[chosen[k]].word) == 0;
            common[i].standard = here ? text : common[i].standard;
        }
        gm_arena_need(arena, common[i].standard);
    }
    gm_arena_need(arena, gm_system_make_rows(of_file, timing, common, kind->row_count, false));
    struct gm_parameter *last = &of_file->rows[of_file->row_count - 1];
    last->lowest = 0.01;
    last->highest = 1e5;
    last->logarithmic = true;
    for (size_t i = GM_SYSTEM_ROWS; i < of_file->row_count; i++) {
        for (size_t k = 0; k < kind->row_count; k++) {
            if (strcmp(common[k].key, of_file->rows[i].key) == 0) {
                gm_arena_refuse(arena, "%.60s is a key of moving meshes: a parameter needs another name",
                                common[k].key);
            }
        }
    }
    const size_t own = of_file->row_count + kind->row_count;
    gm_parameters_reset(of_file->rows + GM_SYSTEM_ROWS, own - GM_SYSTEM_ROWS, of_file->initial);
    double numbers[GM_SYSTEM_TIMES];
    char sentence[GM_MESSAGE];
    if (!gm_system_open_timing(of_file, numbers, sentence)) {
        gm_arena_refuse(arena, "%s", sentence);
    }
    const double dt = numbers[0] > 0 ? numbers[0] : gm_written_rounded(half_length / grid),
                 steps = numbers[2] >= 0 ? numbers[2] : 2 * half_length / dt,
                 until = numbers[1] >= 0 ? numbers[1] : steps * dt;
    gm_arena_need(arena, gm_written_timing(&of_file->texts, system, dt, until, &of_file->rows[DT],
                                           &of_file->rows[UNTIL]));
    gm_parameters_reset(of_file->rows, GM_SYSTEM_ROWS, of_file->initial);
}

/* Adds an observable, and returns it. */
static struct gm_observable *add(struct user_field *field, struct gm_observable row)
{
    struct gm_system_scene *of_file = &field->of_file;
    const size_t count = of_file->observable_count++;
    for (size_t k = 0; k < count; k++) {
        if (gm_observables_clash(row.key, of_file->observables[k].key)) {
            gm_arena_refuse(field->arena, "there are two observables %s", row.key);
        }
    }
    of_file->observables[count] = row;
    return &of_file->observables[count];
}

static void add_errors(struct user_field *field)
{
    const struct gm_system_item *known = gm_system_item_of(&field->of_file.system, GM_WORD_EXACT_WHILE, 0);
    for (size_t i = 0; i < field->kind->error_count; i++) {
        struct gm_observable *row = add(field, field->kind->errors[i]);
        row->missing = known && field->kind != &moving_waves ? known->text : row->missing;
    }
}

static void add_densities(struct user_field *field)
{
    static const char infinite[] = "its density is not finite everywhere";
    struct gm_system_scene *of_file = &field->of_file;
    size_t count = 0;
    for (size_t i = 0; i < of_file->system.item_count; i++) {
        const struct gm_system_item *item = &of_file->system.items[i];
        const bool kept = item->word == GM_WORD_INVARIANT;
        if (!kept && item->word != GM_WORD_OBSERVE) {
            continue;
        }
        const char *on = gm_system_option_text(item, GM_OPTION_ON, "nodes");
        if (strcmp(on, "nodes") != 0 && strcmp(on, "cells") != 0) {
            gm_arena_refuse(field->arena, "%.60s: an integral is on nodes or on cells, not on %.60s",
                            item->name, on);
        }
        if (count++ == MOST_DENSITIES) {
            gm_arena_refuse(field->arena, "a field has at most %d invariants and observables",
                            MOST_DENSITIES);
        }
        const char *key = gm_arena_print(field->arena, kept ? "%s_error" : "%s", item->name);
        const struct gm_system_option *scale = gm_system_option(item, GM_OPTION_SCALE);
        struct gm_observable *row =
            add(field,
                kept ? (struct gm_observable)GM_KEPT_OBSERVABLE(
                           key, integral, item->name, item->name, .scale = scale ? natural_scale : NULL,
                           .scale_text = scale ? scale->text : NULL, .terms = terms, .missing = infinite)
                     : (struct gm_observable)GM_OBSERVABLE(key, integral, item->name, .missing = infinite));
        const size_t number = of_file->observable_count - 1;
        gm_written_options(row, item);
        gm_arena_need(field->arena,
                      gm_system_open_tape(of_file, &of_file->formulas[number], item->nodes, 1) &&
                          (!scale || gm_system_open_tape(of_file, &of_file->terms[number], &scale->node, 1)));
    }
}

static void make_observables(struct user_field *field)
{
    struct gm_system_scene *of_file = &field->of_file;
    of_file->observables =
        gm_arena_take(of_file->system.arena, MOST_OBSERVABLES, sizeof *of_file->observables);
    of_file->formulas = gm_arena_take(of_file->system.arena, MOST_OBSERVABLES, sizeof *of_file->formulas);
    of_file->terms = gm_arena_take(of_file->system.arena, MOST_OBSERVABLES, sizeof *of_file->terms);
    gm_arena_need(field->arena, of_file->observables && of_file->formulas && of_file->terms);
    of_file->scene.observables = of_file->observables;
    if (field->kind->equation) { /* laws and symmetries come last */
        add_densities(field);
    }
    const struct gm_hook *hook = field->kind == &waves ? of_file->hook : NULL;
    const struct gm_observable *rows = hook ? hook->observables : field->kind->observables;
    const size_t row_count = hook ? hook->observable_count : field->kind->observable_count;
    for (size_t i = 0; !field->kind->equation && i < row_count; i++) {
        add(field, rows[i]);
    }
    if (field->solved) {
        add_errors(field);
    }
    for (size_t i = 0; field->kind->equation && i < row_count; i++) {
        add(field, rows[i]);
    }
    if (!field->kind->equation) {
        add_densities(field);
    }
    of_file->scene.observable_count = of_file->observable_count;
}

static void make_schemes(struct user_field *field, const struct gm_problem *problem)
{
    size_t count, others;
    char sentence[GM_MESSAGE];
    const char *text = field->of_file.system.texts[GM_WORD_SCHEMES];
    const bool elsewhere = gm_user_field_elsewhere(field->of_file.system.kind, text, &others) > 0;
    if (!gm_written_schemes(elsewhere == field->elsewhere ? text : NULL, problem, field->of_file.schemes,
                            GM_MOST_PREFERRED, &count, sentence)) {
        gm_arena_refuse(field->arena, "%s", sentence);
    }
    field->of_file.scene.schemes = count > 0 ? field->of_file.schemes : field->kind->schemes;
    field->of_file.scene.lanes = field->of_file.system.texts[GM_WORD_LANES];
}

/* Refines the grid with the step if there is an exact solution, or, on a moving mesh, against a run on more
   nodes: each strategy moves given nodes differently. Else the distance from a reference run on the same grid
   is measured. */
static void make_work(struct user_field *field)
{
    const struct gm_system_lane *initial = field->of_file.initial;
    const double points = (double)initial->grid.points;
    struct gm_work *work = &field->of_file.work;
    *work =
        (struct gm_work){.arguments = "", .coarsest = half_length_of(initial) / points * 2, .halvings = 5};
    if (field->solved) {
        work->measure = "solution_error";
    } else if (field->kind == &moving_waves) {
        work->reference = "multiplier-lobatto4";
        work->distance = gm_mesh_distance;
        work->distance_title = "distance from a finer run";
    }
    if (work->measure || work->distance) {
        work->resolution = "points";
        work->resolutions = field->resolutions;
        work->resolution_count = GM_COUNT(field->resolutions);
        work->errors = field->errors;
        for (size_t i = 0; i < GM_COUNT(field->resolutions); i++) {
            field->resolutions[i] = fmax(field->kind->rows->lowest, floor(ldexp(points, (int)i - 1)));
            field->errors[i] = pow(10, -1 - (double)i);
        }
    }
}

static const char *title_of(struct user_field *field)
{
    enum { SHORT = 48 };
    const struct gm_user_system *system = &field->of_file.system;
    if (gm_system_title(system)) {
        return gm_system_title(system);
    }
    if (system->kind != GM_FIELD) {
        return "A user-defined field";
    }
    const struct gm_naming naming = gm_system_naming(system);
    char *formula = gm_formula_text(&system->graph, system->energy, &naming);
    if (formula) { /* a long formula is left out */
        gm_arena_keep(field->arena, formula, free);
    }
    return formula && strlen(formula) <= SHORT
               ? gm_arena_print(field->arena, "Waves in the potential V = %s", formula)
               : "Waves in a user-defined potential";
}

static bool on_a_mesh(const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_mesh;
}

static bool on_rates(const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_ode;
}

static bool is_for(const struct gm_scheme *scheme, unsigned facet)
{
    return scheme->family->kind == &gm_kind_field &&
           !(scheme->needs & ~(unsigned)(facet | GM_NEEDS_FORM | GM_NEEDS_PAIRS));
}

static bool on_a_ring(const struct gm_scheme *scheme)
{
    return is_for(scheme, GM_NEEDS_WAVE);
}

static bool on_korteweg(const struct gm_scheme *scheme)
{
    return is_for(scheme, GM_NEEDS_KDV);
}

static bool on_schroedinger(const struct gm_scheme *scheme)
{
    return is_for(scheme, GM_NEEDS_NLS);
}

static bool on_heat(const struct gm_scheme *scheme)
{
    return is_for(scheme, GM_NEEDS_HEAT);
}

static bool on_burgers(const struct gm_scheme *scheme)
{
    return is_for(scheme, GM_NEEDS_BURGERS);
}

/* The kinds of equations that are recognised, and the schemes for them alone. */
static const struct {
    const struct kind *kind;
    bool (*is_for)(const struct gm_scheme *scheme);
} of_equations[] = {
    {&korteweg, on_korteweg}, {&schroedinger, on_schroedinger}, {&heat, on_heat}, {&burgers, on_burgers}};

size_t gm_user_field_elsewhere(enum gm_system_kind kind, const char *schemes, size_t *others)
{
    const struct gm_kind *const of_rates = kind == GM_EVOLUTION ? &gm_kind_field : NULL,
                                *const there = kind == GM_FIELD ? &gm_kind_mesh : of_rates;
    size_t count = 0;
    char name[64];
    for (*others = 0; gm_listed_word(&schemes, name, sizeof name);) {
        const struct gm_scheme *scheme = gm_scheme_find(name);
        bool is_there = scheme && scheme->family->kind == there;
        for (size_t i = 0; scheme && !is_there && i < gm_scheme_count(); i++) { /* kinds may share a name */
            const struct gm_scheme *other = gm_scheme_at(i);
            is_there = other->family->kind == there && strcmp(other->name, scheme->name) == 0;
        }
        count += is_there;
        *others += !is_there;
    }
    return count;
}

/* Finds the range of the field at the start. */
static void find_range(struct user_field *field, const struct gm_problem *problem)
{
    struct gm_grid1 grid;
    const double *y = gm_arena_keep(field->arena, start_on(field->of_file.initial, problem, &grid), free);
    const struct gm_view view = {.problem = problem,
                                 .scheme = gm_scheme_find(field->of_file.scene.schemes[0]),
                                 .state = y,
                                 .t0 = begin_of(field->of_file.initial),
                                 .t = begin_of(field->of_file.initial)};
    field->low = field->high = field->kind->value(&view, 0);
    for (size_t i = 0; i < grid.points; i++) {
        gm_range_add(&field->low, &field->high, field->kind->value(&view, i));
    }
    if (!(field->high > field->low)) {
        field->high += 1;
        field->low -= 1;
    }
}

static void close_problem(void *thing)
{
    struct making *making = thing;
    making->field->kind->close(&making->problem);
}

static bool derive(struct user_field *field)
{
    switch (field->of_file.system.kind) {
    case GM_EVOLUTION:
        return field->kind != &evolutions ||
               gm_user_evolution_derive(&field->evolution, &field->of_file.system);
    case GM_MATRICES:
        return gm_user_form_derive(&field->form, &field->of_file.system);
    default:
        return gm_user_wave_derive(&field->wave, &field->of_file.system);
    }
}

static void make(struct gm_arena *arena, void *data)
{
    struct making *making = data;
    struct user_field *field = making->field = gm_arena_take(arena, 1, sizeof *field);
    struct gm_system_scene *of_file = &field->of_file;
    struct gm_user_system *system = &of_file->system;
    static const struct gm_track surface[] = {GM_SURFACE_TRACK(record_shown)},
                                 paths[] = {GM_MESH_PATHS_TRACK};
    static const struct gm_observable law[] = {GM_FORM_RESIDUAL}; /* it costs as much as two steps */
    char sentence[GM_MESSAGE];
    gm_arena_keep(arena, field, close_field);
    field->arena = arena;
    *system = *making->system;
    *making->system = (struct gm_user_system){0};
    const bool in_potential = system->kind == GM_FIELD, moves = in_potential && making->elsewhere,
               by_matrices = system->kind == GM_MATRICES;
    field->elsewhere = making->elsewhere;
    gm_arena_need(arena, gm_user_equation_derive(&field->equation, system));
    size_t known = 0;
    while (known < GM_COUNT(of_equations) && of_equations[known].kind->equation != field->equation.needs) {
        known++;
    }
    const bool is_known = known < GM_COUNT(of_equations);
    const struct kind *const of_rates =
                                 is_known && making->elsewhere ? of_equations[known].kind : &evolutions,
                             *const of_matrices = by_matrices ? &forms : of_rates,
                             *const of_potentials = moves ? &moving_waves : &waves,
                             *const kind = in_potential ? of_potentials : of_matrices;
    field->kind = kind;
    const char *const *texts = (const char *const *)system->texts;
    if (kind->no_walls && texts[GM_WORD_BOUNDARY] && strcmp(texts[GM_WORD_BOUNDARY], "walls") == 0) {
        gm_arena_refuse(arena, "%s", kind->no_walls);
    }
    if (!gm_system_find_hook(of_file, sentence)) {
        gm_arena_refuse(arena, "%s", sentence);
    }
    field->solved = gm_line_is_solved(system);
    gm_arena_need(arena, derive(field));
    make_rows(field);
    of_file->scene = (struct gm_scene){
        .name = making->name,
        .title = title_of(field),
        .blurb = texts[GM_WORD_ABOUT] ? texts[GM_WORD_ABOUT] : "A user-defined field.",
        .watch = texts[GM_WORD_WATCH] ? texts[GM_WORD_WATCH] : "",
        .time = texts[GM_WORD_TIME] ? texts[GM_WORD_TIME]
                : in_potential      ? "what light needs for a length of 1"
                                    : "the unit of the equation",
        .size = sizeof *of_file->initial + of_file->row_count * (sizeof(double) + 1),
        .initial = of_file->initial,
        .words = making->words,
        .source = making->words ? system->source : NULL,
        .text = making->words ? system->source : NULL,
        .mark =
            making->words ? gm_arena_keep(arena, gm_written_mark(making->name, system->source), free) : NULL,
        .parameters = of_file->rows,
        .parameter_count = of_file->row_count + of_file->common_count,
        .tracks = moves ? paths : surface,
        .track_count = !kind->profiles,
        .work = &of_file->work,
        .asked = law,
        .asked_count = by_matrices ? GM_COUNT(law) : 0,
        .preferences = kind->preferences,
        .variant = gm_system_variant,
        .t0 = begin_of,
        .idle = gm_system_idle,
        .settle = settle,
        .setup = setup,
        .close = kind->close,
        .start = start,
        .draw = kind->draw,
        .point = point,
        .failure = kind->failure ? kind->failure : tell_failure,
    };
    if (moves) {
        of_file->scene.elsewhere = on_a_ring;
        of_file->scene.start_with = start_mesh;
        of_file->scene.chosen = note_alpha;
    } else if (in_potential && making->words && !of_file->initial->grid.walls) {
        of_file->scene.elsewhere = on_a_mesh;
    } else if (is_known && making->words) {
        of_file->scene.elsewhere = kind->equation ? on_rates : of_equations[known].is_for;
    }
    if (!gm_system_open_items(of_file, sentence) || !setup(of_file->initial, &making->problem, sentence)) {
        gm_arena_refuse(arena, "%s", sentence);
    }
    gm_arena_keep(arena, making, close_problem);
    make_observables(field);
    make_schemes(field, &making->problem);
    if (moves || !gm_system_item_of(system, GM_WORD_COLOURS, 0)) {
        find_range(field, &making->problem);
    }
    make_work(field);
    if (!gm_system_make_studies(of_file, &making->problem, NULL, sentence)) {
        gm_arena_refuse(arena, "%s", sentence);
    }
    gm_arena_drop(arena, making);
}

/* Opens the scene of a system, which it takes. */
static struct gm_system_scene *open_one(struct gm_user_system *system, const char *name,
                                        const char *const *words, bool elsewhere, char *sentence)
{
    struct making making = {.system = system, .name = name, .words = words, .elsewhere = elsewhere};
    struct gm_arena *arena = gm_arena_open();
    if (!gm_arena_run(arena, make, &making)) {
        gm_system_close(system);
        gm_refuse(sentence, "%s", gm_arena_reason(arena));
        gm_arena_close(arena);
        return NULL;
    }
    return &making.field->of_file;
}

static struct gm_system_scene *open_other(struct gm_user_system *system, const struct gm_system_scene *first,
                                          char *sentence)
{
    const bool elsewhere = ((const struct user_field *)first)->elsewhere;
    return open_one(system, first->scene.name, first->scene.words, elsewhere, sentence);
}

const struct gm_scene *gm_user_field_open(struct gm_user_system *system, const char *name,
                                          const char *const *words, bool elsewhere, struct gm_fault *fault,
                                          char *sentence)
{
    const bool choices = system->choices.count > 0;
    struct gm_system_scene *first = open_one(system, name, words, elsewhere, sentence);
    *fault = (struct gm_fault){0};
    if (first && choices &&
        !gm_system_unite(first, &(struct gm_system_opening){open_other, fault, sentence})) {
        gm_user_field_close(&first->scene);
        return NULL;
    }
    return first ? &first->scene : NULL;
}

void gm_user_field_close(const struct gm_scene *scene)
{
    const struct user_field *field = (const struct user_field *)scene; /* the scene is its first member */
    if (field->of_file.next) {
        gm_user_field_close(&field->of_file.next->scene);
    }
    gm_arena_close(field->arena);
}
