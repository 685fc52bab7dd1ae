/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A field that somebody wrote: a wave equation
       u_tt = u_xx - V'(u),   H = integral of u_t^2/2 + u_x^2/2 + V(u),
   or an evolution of one field or several
       (M u)_t = R(u, u_x, ..),
   or the components of a multisymplectic form,
       K z_t + L z_x = grad S(z),
   or the wave equation between ends that hold u, on a moving mesh, as a scene: the parameters of its file are
   keys, with the ring and its grid; what it keeps or observes are integrals of densities. The scene is made while
   the program runs, and does not change afterwards. */
#include "scenes/field/user_field.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/boxes/any_form.h"
#include "core/field/families/laws/form.h"
#include "core/field/user/form.h"
#include "core/field/user/potential.h"
#include "core/mesh/user/potential.h"
#include "core/model/equations.h"
#include "core/ode/user/evolution.h"
#include "core/schemes.h"
#include "core/tape.h"
#include "scenes/common/written.h"
#include "scenes/field/wave_observables.h"
#include "scenes/mesh/observed.h"
#include "scenes/mesh/picture.h"

enum {
    DT,
    UNTIL,
    HALF_LENGTH,
    POINTS,
    SPACE /* of an evolution */,
    SHOW = SPACE /* of others */,
    BOUNDARY,         /* but of a form, and */
    ALPHA = BOUNDARY, /* of a moving mesh */
    DENSITY,
    COMMON_ROWS
};
enum { MOST_DENSITIES = 32, MOST_PREFERRED = 32, COMMON = 9, MOST_GRAPHS = 3 };

struct user_field {
    struct gm_scene scene; /* first: a scene is found to be this */
    struct gm_user_system system;
    struct gm_user_wave wave;             /* one of the three, on a moving mesh where `moves` */
    struct gm_user_evolution evolution;   /* where `evolves` */
    struct gm_user_form form;             /* where `is_form` */
    bool evolves, is_form, moves, solved; /* solved: an exact solution is told */
    struct gm_parameter *rows;
    size_t row_count, values; /* the first row of the file's own */
    struct lane *initial;
    struct gm_observable observables[COMMON + 2 + MOST_DENSITIES];
    size_t observable_count;
    struct gm_tape densities[MOST_DENSITIES], jump; /* of all variables */
    size_t first_density;
    struct gm_track track;
    const char *schemes[MOST_PREFERRED + 1];
    struct gm_work work;
    double resolutions[3], errors[3];
    double low, high; /* of u at the start */
    struct gm_kept_texts texts;
};

/* Parameters of a run; behind the values of the file's own stand as many bytes: whether each was given. */
struct lane {
    struct gm_timing timing;
    int show; /* what the surfaces hold: scenes/field/local_laws.h; of a moving mesh enum gm_mesh_view */
    const struct user_field *owner;
    double half_length;
    long points;
    int space; /* enum gm_derivatives */
    int walls;
    double alpha; /* of a moving mesh */
    int density;  /* enum gm_mesh_density */
    double values[];
};

static const struct user_field *field_of(const struct gm_view *view)
{
    return ((const struct lane *)view->parameters)->owner;
}

static size_t parameter_count(const struct user_field *field)
{
    return field->row_count - field->values;
}

/* Values of all variables; `given`: of those parameters alone that were given, others follow. malloc'ed. */
static double *values_of(const struct lane *lane, const char *given)
{
    const struct gm_user_system *system = &lane->owner->system;
    double *known = malloc(system->variable_count * sizeof *known);
    for (size_t i = 0; known && i < system->variable_count; i++) {
        known[i] = NAN;
    }
    for (size_t i = 0; known && i < parameter_count(lane->owner); i++) {
        known[system->parameters + i] = !given || given[i] ? lane->values[i] : NAN;
    }
    double *values = known ? gm_equations_start(system, known) : NULL;
    free(known);
    return values;
}

/* ---- from parameters to problem and start ---- */

static bool settle(void *parameters, const char *const *keys, size_t count, char *sentence)
{
    struct lane *lane = parameters;
    const struct user_field *field = lane->owner;
    char *given = (char *)(lane->values + parameter_count(field));
    for (size_t i = 0; i < parameter_count(field); i++) {
        given[i] |= gm_is_given(field->rows[field->values + i].key, keys, count);
    }
    double *values = values_of(lane, given);
    bool good = values || gm_refuse(sentence, "not enough memory");
    for (size_t i = 0; i < parameter_count(field) && good; i++) {
        const struct gm_parameter *row = &field->rows[field->values + i];
        const double value = lane->values[i] = values[field->system.parameters + i];
        good = (value >= row->lowest && value <= row->highest) ||
               gm_refuse(sentence, "%s is %g with these values, and lies between %g and %g", row->key, value,
                         row->lowest, row->highest);
    }
    free(values);
    return good;
}

static void close_problem(struct gm_problem *problem)
{
    if (problem->kind == &gm_kind_ode) {
        gm_user_evolution_shut(problem);
    } else if (problem->kind == &gm_kind_mesh) {
        gm_user_mesh_close(problem);
    } else if (!gm_field_of(problem) || gm_field_of(problem)->wave) {
        gm_user_wave_close(problem);
    } else {
        gm_user_form_close(problem);
    }
}

/* Opens the problem with these values. */
static bool open_problem(const struct lane *lane, struct gm_problem *problem, const double *values)
{
    const struct user_field *field = lane->owner;
    const struct gm_grid1 grid = lane->walls ? gm_between_walls(lane->half_length, lane->points)
                                             : gm_ring(lane->half_length, lane->points);
    if (field->evolves) {
        return gm_user_evolution_open(problem, &field->evolution, values, &grid,
                                      (enum gm_derivatives)lane->space);
    }
    if (field->is_form) {
        return gm_user_form_open(problem, &field->form, values, &grid);
    }
    if (field->moves) {
        const struct gm_user_mesh mesh = {lane->half_length, lane->points, lane->alpha,
                                          (enum gm_mesh_density)lane->density};
        return gm_user_mesh_open(problem, &field->wave, values, &mesh);
    }
    if (!gm_user_wave_open(problem, &field->wave, values)) {
        return false;
    }
    problem->line = grid;
    problem->n = gm_wave_size(grid.points);
    if (field->jump.outputs > 0) {
        gm_tape_values(&field->jump, values, &problem->line.jump, 1);
    }
    return true;
}

static bool closes(const struct user_field *field, const struct gm_problem *problem, char *sentence)
{
    return field->evolves   ? gm_user_evolution_closes(problem, sentence, GM_MESSAGE)
           : field->is_form ? gm_user_form_closes(problem, sentence, GM_MESSAGE)
           : field->moves
               ? gm_user_mesh_rests(problem, field->system.variables[0].name, sentence, GM_MESSAGE)
               : gm_user_wave_closes(problem, field->system.variables[0].name, sentence, GM_MESSAGE);
}

enum { SAMPLES = 4096 }; /* that tell whether an exact solution begins as the start does */

/* Whether they are the same but for what is `least` visible. */
static bool begins_as(const struct user_field *field, size_t component, double x, double exact, double start,
                      double least, char *sentence)
{
    return fabs(exact - start) <= least ||
           gm_refuse(sentence, "exact: %.60s would begin at %.6g where x = %.6g, and it starts at %.6g",
                     field->system.variables[component].name, exact, x, start);
}

static double visible(double largest)
{
    return 1e-3 * fmax(1e-9, largest);
}

/* The same on a moving mesh, wherever its nodes are. */
static bool mesh_begins_exactly(const struct user_field *field, const struct gm_problem *problem,
                                char *sentence)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    struct gm_mesh mesh;
    moving->describe(problem, &mesh);
    double u[SAMPLES + 1], largest = 0, slope, rate;
    for (size_t i = 0; i <= SAMPLES; i++) {
        moving->start(problem->parameters, mesh.first + mesh.length * (double)i / SAMPLES, &u[i], &slope,
                      &rate);
        largest = fmax(largest, fabs(u[i]));
    }
    for (size_t i = 0; i <= SAMPLES; i++) {
        const double x = mesh.first + mesh.length * (double)i / SAMPLES;
        if (!begins_as(field, 0, x, moving->exact(problem->parameters, x, 0), u[i], visible(largest),
                       sentence)) {
            return false;
        }
    }
    return true;
}

static bool setup(const void *parameters, struct gm_problem *problem, char *sentence)
{
    const struct lane *lane = parameters;
    double *values = values_of(lane, NULL);
    bool good = (values && open_problem(lane, problem, values)) || gm_refuse(sentence, "not enough memory");
    if (good) {
        problem->name = lane->owner->scene.name;
        good =
            closes(lane->owner, problem, sentence) && (!lane->owner->moves || !lane->owner->solved ||
                                                       mesh_begins_exactly(lane->owner, problem, sentence));
    }
    if (!good && values) {
        close_problem(problem);
    }
    free(values);
    return good;
}

static void start(const void *parameters, const struct gm_problem *problem, double *y)
{
    if (problem->kind == &gm_kind_ode) {
        gm_user_evolution_start(problem, y);
    } else if (gm_field_of(problem)->form->hessians) {
        gm_user_form_start(problem, y);
    } else {
        gm_user_wave_levels(problem, ((const struct gm_timing *)parameters)->dt, y);
    }
}

/* Of a component, which of a wave is the first. */
static double exact_component(const struct gm_view *view, size_t component, double x)
{
    const struct user_field *field = field_of(view);
    return field->evolves   ? gm_user_evolution_exact(view->problem, component, x, view->t)
           : field->is_form ? gm_user_form_exact(view->problem, component, x, view->t)
                            : gm_user_wave_exact(view->problem, x, view->t);
}

/* How many components a state has at each node. */
static size_t components_of(const struct gm_view *view)
{
    const struct user_field *field = field_of(view);
    return field->evolves || field->is_form ? view->problem->n / view->problem->line.points : 1;
}

/* By how much a component may be off from the exact solution: a potential's constant is free. */
static double free_constant(const struct gm_view *view, size_t component)
{
    const struct gm_grid1 *grid = &view->problem->line;
    return field_of(view)->is_form && gm_user_form_is_potential(view->problem, component)
               ? view->state[component * grid->points] -
                     exact_component(view, component, gm_grid1_node(grid, 0))
               : 0;
}

/* Largest magnitude of what is finite; *wrong is the first entry that is not, or `count`. */
static double largest_of(const double *values, size_t count, size_t *wrong)
{
    double largest = 0;
    *wrong = count;
    for (size_t i = count; i-- > 0;) {
        *wrong = isfinite(values[i]) ? *wrong : i;
        largest = isfinite(values[i]) ? fmax(largest, fabs(values[i])) : largest;
    }
    return largest;
}

/* Whether the exact solution begins as the start does, at as many nodes as tell it. */
static bool begins_exactly(const void *parameters, const struct gm_problem *problem, const double *y,
                           char *sentence)
{
    const struct user_field *field = ((const struct lane *)parameters)->owner;
    const struct gm_grid1 *grid = &problem->line;
    const struct gm_view view = {.problem = problem, .parameters = parameters, .state = y};
    const size_t components = components_of(&view), apart = gm_grid1_seen(grid) / SAMPLES + 1;
    size_t wrong;
    const double least = visible(largest_of(y, components * grid->points, &wrong));
    for (size_t c = 0; c < components; c++) {
        const double constant = free_constant(&view, c);
        for (size_t i = 0; i < gm_grid1_seen(grid); i += apart) {
            const double x = gm_grid1_node(grid, i);
            if (!begins_as(field, c, x, exact_component(&view, c, x) + constant, y[c * grid->points + i],
                           least, sentence)) {
                return false;
            }
        }
    }
    return true;
}

/* Whether the other level of a wave is one that a step can lead to. */
static bool has_levels(const struct user_field *field, const struct gm_problem *problem, const double *y,
                       char *sentence)
{
    const double most = 1e10; /* as a run takes for a blow-up */
    const size_t points = problem->line.points;
    size_t wrong;
    const double start = largest_of(y, points, &wrong), further = largest_of(y + points, points, &wrong);
    if (wrong < points) {
        return gm_refuse(sentence, "%.60s is not finite where x = %.6g one step after the start",
                         field->system.variables[0].name, gm_grid1_node(&problem->line, wrong));
    }
    return further <= most * fmax(1, start) ||
           gm_refuse(
               sentence,
               "%.60s would be %.3g one step after the start: V' is too large there, or dt = %.3g too long",
               field->system.variables[0].name, further, y[2 * points]);
}

static bool start_checked(const void *parameters, const struct gm_problem *problem,
                          const struct gm_scheme *scheme, double *y, char *sentence)
{
    const struct user_field *field = ((const struct lane *)parameters)->owner;
    (void)scheme;
    start(parameters, problem, y);
    return (!field->solved || begins_exactly(parameters, problem, y, sentence)) &&
           (field->evolves || field->is_form || has_levels(field, problem, y, sentence));
}

static bool start_mesh(const void *parameters, const struct gm_problem *problem,
                       const struct gm_scheme *scheme, double *y, char *sentence)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    const struct lane *lane = parameters;
    struct gm_mesh mesh;
    moving->describe(problem, &mesh);
    return gm_mesh_start(&mesh, gm_scheme_mesh(scheme), moving->start, problem->parameters, y) ||
           gm_refuse(
               sentence,
               "no mesh of %ld nodes was found for alpha = %g: the homotopy from the uniform mesh fails; a "
               "smaller alpha helps",
               lane->points, lane->alpha);
}

/* The weight of the slope that was left to the start. */
static void note_alpha(const struct gm_problem *problem, void *parameters)
{
    ((struct lane *)parameters)->alpha = gm_user_mesh_alpha(problem);
}

/* ---- what is observed ---- */

static double exact(const struct gm_view *view, double x)
{
    return exact_component(view, 0, x);
}

/* Of all components. */
static double solution_error(const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const size_t components = components_of(view);
    double largest = 0;
    for (size_t c = 0; c < components; c++) {
        const double *u = view->state + c * grid->points, constant = free_constant(view, c);
        for (size_t i = 0; i < gm_grid1_seen(grid); i++) {
            const double error = fabs(u[i] - constant - exact_component(view, c, gm_grid1_node(grid, i)));
            largest = error > largest || isnan(error) ? error : largest;
        }
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

/* What linear theory says about the state, before a step beyond it blows up. */
static double longest_step(const struct gm_view *view)
{
    const struct gm_step_limit *limit = view->scheme->limit;
    return limit ? limit->longest(view->problem, view->state) : NAN;
}

/* Where the first field is highest: of the parabola through the highest node and both beside it. */
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

/* The integral of a density of components, by Gauss's rule at the stages of the cells, which a run remembers; at the
   nodes of a state that no run has come to. */
static double integral_of_cells(const struct gm_view *view, const struct gm_tape *density, bool magnitude)
{
    static const double left = 0, whole = 1;
    const struct gm_user_system *system = &field_of(view)->system;
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_collocation_tableau *tableau = view->scheme->coefficients;
    const bool stepped = view->memory != NULL;
    const size_t r = stepped ? tableau->r : 1;
    const double *stages = stepped ? gm_any_form_stages(view->memory) : view->state;
    const double *nodes = stepped ? tableau->c : &left, *weights = stepped ? tableau->b : &whole;
    double *values = values_of(view->parameters, NULL), sum = values ? 0 : NAN, value;
    for (size_t at = 0; values && at < r * grid->points; at++) {
        const size_t i = at / r, m = at % r;
        for (size_t c = 0; c < system->n; c++) {
            values[c] = stages[(c * r + m) * grid->points + i];
        }
        values[system->velocities] = gm_grid1_node(grid, i) + nodes[m] * grid->dx;
        gm_tape_values(density, values, &value, 1);
        sum += weights[m] * (magnitude ? fabs(value) : value);
    }
    free(values);
    return sum * grid->dx;
}

/* The integral of a density on a moving mesh, of the middles of its elements. */
static double integral_of_elements(const struct gm_view *view, const struct gm_tape *density, bool magnitude)
{
    const struct gm_user_system *system = &field_of(view)->system;
    const struct gm_mesh mesh = gm_mesh_of(view);
    const size_t points = mesh.points;
    double *values = values_of(view->parameters, NULL), sum = values ? 0 : NAN, value;
    /* field, place and the velocities of both: at the node before, and at this one */
    double before[4] = {mesh.left, mesh.first}, now[4];
    for (size_t k = 0; values && k <= points; k++) {
        const double end[4] = {mesh.right, mesh.first + mesh.length};
        for (size_t i = 0; i < GM_COUNT(now); i++) {
            now[i] = k < points ? view->state[i * points + k] : end[i];
        }
        const double width = now[1] - before[1], slope = (now[0] - before[0]) / width;
        values[0] = (now[0] + before[0]) / 2;
        values[1] = (now[2] + before[2] - slope * (now[3] + before[3])) / 2;
        values[system->velocities] = (now[1] + before[1]) / 2;
        values[system->velocities + 1] = slope;
        gm_tape_values(density, values, &value, 1);
        sum += width * (magnitude ? fabs(value) : value);
        memcpy(before, now, sizeof now);
    }
    free(values);
    return sum;
}

/* The integral of a density or of its magnitude, of a wave in the middle between the two levels of the state. */
static double integral_of(const struct gm_view *view, bool magnitude)
{
    const struct user_field *field = field_of(view);
    const struct gm_user_system *system = &field->system;
    const size_t number = (size_t)(view->observable - field->observables) - field->first_density;
    const struct gm_grid1 *grid = &view->problem->line;
    if (field->evolves) {
        return gm_user_evolution_integral(view->problem, number, magnitude, view->state);
    }
    if (field->is_form) {
        return integral_of_cells(view, &field->densities[number], magnitude);
    }
    if (field->moves) {
        return integral_of_elements(view, &field->densities[number], magnitude);
    }
    const double *u = view->state, *other = u + grid->points, gap = other[grid->points];
    double *values = values_of(view->parameters, NULL), sum = values ? 0 : NAN, density;
    for (size_t i = 0; values && i < gm_grid1_seen(grid); i++) {
        const size_t right = i + 1 < grid->points ? i + 1 : 0, left = i > 0 ? i - 1 : grid->points - 1;
        const double jump = right == 0 || i == 0 ? grid->jump : 0;
        values[0] = (u[i] + other[i]) / 2;
        values[1] = (other[i] - u[i]) / gap;
        values[system->velocities] = gm_grid1_node(grid, i);
        values[system->velocities + 1] =
            ((u[right] + other[right] - u[left] - other[left]) / 2 + jump) / (2 * grid->dx);
        gm_tape_values(&field->densities[number], values, &density, 1);
        sum += gm_grid1_share(grid, i) * (magnitude ? fabs(density) : density);
    }
    free(values);
    return sum * grid->dx;
}

static double integral(const struct gm_view *view)
{
    return integral_of(view, false);
}

static double terms(const struct gm_view *view)
{
    return integral_of(view, true);
}

/* The error, where it is known, and what is kept: of a wave its energies, of an evolution what its file names, of a form
   its energy and that. */
static size_t graphs_of(const struct user_field *field, struct gm_graph *graphs)
{
    const struct gm_graph kept = {.highest = true, .scale = GM_LOG, .calm_low = 1e-16, .calm_high = 1e-2};
    size_t count = 0;
    if (field->solved) {
        graphs[count] = kept;
        graphs[count].observable = "solution_error";
        graphs[count].calm_low = 1e-3;
        graphs[count++].calm_high = 1;
    }
    if (field->is_form) {
        graphs[count] = kept;
        graphs[count++].observable = "energy_error";
    } else if (!field->evolves) {
        static const char *const energies[] = {"energy_error", "own_energy_error"};
        for (size_t i = field->solved ? 1 : 0; i < GM_COUNT(energies); i++) {
            graphs[count] = kept;
            graphs[count++].observable = energies[i];
        }
        return count;
    }
    for (size_t i = field->first_density; i < field->observable_count && count < MOST_GRAPHS; i++) {
        if (field->observables[i].kept) {
            graphs[count] = kept;
            graphs[count++].observable = field->observables[i].key;
        }
    }
    if (count == 0) {
        graphs[count++] = (struct gm_graph){.observable = "amplitude", .highest = true};
    }
    return count;
}

static void record_shown(const struct gm_view *view, double *entry)
{
    gm_surface_record_shown(view, ((const struct lane *)view->parameters)->show, gm_field_u, entry);
}

static void draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct lane *lane = lanes[0]->parameters;
    const struct user_field *field = lane->owner;
    /* components of a form swing to both sides, though the start may show one of them */
    const bool crosses = field->is_form || field->low < -0.2 * field->high;
    const double most = fmax(fabs(field->low), fabs(field->high)), margin = 0.1 * (field->high - field->low);
    struct gm_field_look look = {
        .value = gm_field_u,
        .exact = field->solved ? exact : NULL,
        .name = field->system.variables[0].name,
        .low = crosses ? -most - margin : field->low - margin,
        .high = crosses ? most + margin : field->high + margin,
        .map = crosses ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL,
        .show = lane->show,
    };
    for (size_t i = 0; i < count && lanes[i]->problem.line.walls && lane->show == GM_SHOW_FIELD; i++) {
        /* a kink that comes back from a wall leads to other values than it came from */
        const struct gm_entries *rows = &lanes[i]->entries[0];
        for (size_t k = 0; k < rows->count * rows->width; k++) {
            if (fabs(rows->values[k]) <= 5 * most) {
                gm_range_add(&look.low, &look.high, rows->values[k]);
            }
        }
    }
    const char *beyond = "";
    for (size_t i = 0; i < count; i++) {
        const struct gm_view view = gm_lane_view(lanes[i]);
        const double longest = longest_step(&view);
        if (fabs(view.dt) > longest) {
            beyond = gm_picture_text(picture, ",  %s is unstable beyond Δt = %.3g", lanes[i]->scheme->title,
                                     longest);
        }
    }
    picture->title = field->scene.title;
    picture->subtitle =
        gm_picture_text(picture, "%ld points,  Δx = %g%s%s", lane->points, lanes[0]->problem.line.dx,
                        gm_shared_step(picture, lanes, count), beyond);
    struct gm_graph graphs[MOST_GRAPHS];
    gm_draw_field(picture, lanes, count, &look, graphs, graphs_of(field, graphs));
}

static void draw_mesh(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct user_field *field = ((const struct lane *)lanes[0]->parameters)->owner;
    const size_t nodes = gm_user_mesh_order(&field->wave);
    struct gm_mesh_look look = {
        .front = gm_picture_text(picture, "means of V by %zu of Gauss’s points", nodes),
        .name = field->system.variables[0].name,
        .scale = GM_LINEAR,
        .low = field->low,
        .high = field->high,
    };
    const double most = 5 * fmax(fabs(field->low), fabs(field->high));
    for (size_t i = 0; i < count; i++) {
        const double *state = gm_lane_view(lanes[i]).state;
        for (size_t k = 0; k < lanes[i]->problem.n / 4; k++) {
            if (fabs(state[k]) <= most) {
                gm_range_add(&look.low, &look.high, state[k]);
            }
        }
    }
    picture->title = field->scene.title;
    gm_mesh_draw(lanes, count, picture, &look);
}

/* The limit of the scheme's steps at the state that a run was started in. */
static void tell_failure(const struct gm_view *view, char *text, size_t size)
{
    const struct gm_step_limit *limit = view->scheme->limit;
    const double longest = limit ? limit->longest(view->problem, view->start) : INFINITY;
    text[0] = '\0';
    if (fabs(view->dt) > longest) {
        snprintf(text, size, "dt = %.4g is beyond %.4g, the limit of linear theory %s", fabs(view->dt),
                 longest, limit->condition);
    }
}

/* ---- the scene is made ---- */

/* What a line of one number says with the file's own values; `usual` where there is none. */
static double number_of(const struct user_field *field, const double *values, enum gm_system_word word,
                        double usual)
{
    const struct gm_system_item *item = gm_system_item_of(&field->system, word, 0);
    const struct gm_formula *graph = &field->system.graph;
    double *all = item ? malloc((graph->count + (size_t)1) * sizeof *all) : NULL;
    if (all) {
        gm_formula_evaluate(graph, graph->count, values, all);
        usual = all[item->nodes[0]];
    }
    free(all);
    return usual;
}

/* A tape whose inputs are all variables, so that lanes with different parameters share it. */
static bool open_tape(const struct user_field *field, struct gm_tape *tape, gm_node_id node)
{
    const size_t inputs = field->system.variable_count;
    double *unused = calloc(inputs, sizeof *unused);
    const bool good = unused && gm_tape_open(tape, &field->system.graph, &node, 1, inputs, unused);
    free(unused);
    return good;
}

static bool make_rows(struct user_field *field, char *sentence)
{
    const struct gm_user_system *system = &field->system;
    const size_t parameters = system->velocities - system->parameters;
    field->values = field->is_form ? BOUNDARY : field->moves ? COMMON_ROWS : DENSITY;
    field->row_count = field->values + parameters;
    field->rows = calloc(field->row_count, sizeof *field->rows);
    field->initial = calloc(1, sizeof *field->initial + parameters * (sizeof(double) + 1));
    double *values = gm_equations_start(system, NULL);
    if (!field->rows || !field->initial || !values) {
        free(values);
        return false;
    }
    field->initial->owner = field;
    const long least = field->evolves ? 5 : 3;
    const double half_length = number_of(field, values, GM_WORD_HALF_LENGTH, 20),
                 grid = number_of(field, values, GM_WORD_POINTS, 400),
                 points = field->moves ? fmax(1, floor(grid / 4)) : grid, /* they are where they are needed */
        dt = number_of(field, values, GM_WORD_DT, gm_written_rounded(half_length / grid)),
                 steps = number_of(field, values, GM_WORD_STEPS, 2 * half_length / dt),
                 until = number_of(field, values, GM_WORD_UNTIL, steps * dt);
    static const char *const spaces[] = {"differences", "fourier", NULL};
    const char *space = system->texts[GM_WORD_SPACE];
    static const char *const shown[] = {"field", "energy-law", "momentum-law", NULL};
    struct gm_parameter common[COMMON_ROWS] = {
        [DT] = GM_DT("", 1e-9, 1e6),
        [UNTIL] = GM_UNTIL(""),
        [HALF_LENGTH] =
            GM_HALF_LENGTH(struct lane, half_length, gm_kept_number(&field->texts, half_length, NULL),
                           "the ring is −half_length ≤ x < half_length"),
        [POINTS] =
            GM_POINTS(struct lane, points, gm_kept_number(&field->texts, points, NULL), least, "of the grid"),
        [SHOW] = GM_LAW_ROW(struct lane, show, shown),
    };
    static const char *const boundaries[] = {"ring", "walls", NULL};
    const char *boundary = system->texts[GM_WORD_BOUNDARY];
    common[BOUNDARY] = (struct gm_parameter)GM_CHOICE_ROW(
        struct lane, walls, "boundary", boundary ? boundary : boundaries[0], boundaries,
        "a ring, or walls that reflect: u_x = 0 at both ends");
    if (field->evolves) {
        common[SPACE] = (struct gm_parameter)GM_CHOICE_ROW(
            struct lane, space, "space", space ? space : spaces[0], spaces,
            "derivatives: central differences of order 2, or of waves through the nodes");
    }
    if (field->moves) {
        common[POINTS] = (struct gm_parameter)GM_INTEGER_ROW(
            struct lane, points, "points", gm_kept_number(&field->texts, points, NULL), 1, 1e5,
            "nodes between the ends", .logarithmic = true);
        common[SHOW] = (struct gm_parameter)GM_CHOICE_ROW(
            struct lane, show, "show", "all", gm_mesh_views,
            "what the picture shows: all, the field, the paths of the nodes, the energy, or error over nodes",
            .live = true);
        common[ALPHA] = (struct gm_parameter)GM_REAL_ROW(
            struct lane, alpha, "alpha", "auto", 0, 1e6,
            "weight of the field's slope in the mesh density; auto: 3/2 over the largest slope at the start, or π/10 of the "
            "length over what u goes up and down there, whichever is less",
            .automatic = true);
        common[DENSITY] = (struct gm_parameter)GM_CHOICE_ROW(
            struct lane, density, "density", "arclength", gm_mesh_densities,
            "what the nodes equidistribute: arclength, curvature, a mix of both, or arclength that is limited or "
            "tempered where the field is steeper than at the start");
    }
    memcpy(field->rows, common, field->values * sizeof *common);
    bool good = gm_written_timing(&field->texts, system, dt, until, &field->rows[DT], &field->rows[UNTIL]);
    for (size_t i = 0; i < parameters && good; i++) {
        const struct gm_system_variable *variable = &system->variables[system->parameters + i];
        const bool ranged = !isnan(variable->low);
        for (size_t k = 0; k < field->values; k++) {
            good = good &&
                   (strcmp(common[k].key, variable->name) != 0 ||
                    gm_refuse(sentence, "%.60s is a key of moving meshes: a parameter needs another name",
                              variable->name));
        }
        field->rows[field->values + i] = (struct gm_parameter){
            .key = variable->name,
            .unit = variable->unit ? variable->unit : "",
            .help = variable->meaning && variable->meaning[0] ? variable->meaning : "a parameter",
            .type = GM_REAL,
            .offset = offsetof(struct lane, values) + i * sizeof(double),
            .standard = gm_kept_number(&field->texts, values[system->parameters + i], variable->text),
            .lowest = variable->fixed ? variable->value
                      : ranged        ? variable->low
                                      : -1e300,
            .highest = variable->fixed ? variable->value
                       : ranged        ? variable->high
                                       : 1e300,
        };
    }
    for (size_t i = 0; i < field->row_count; i++) {
        good = good && field->rows[i].standard;
    }
    free(values);
    if (good) {
        gm_parameters_reset(field->rows, field->row_count, field->initial);
    }
    return good;
}

static bool make_observables(struct user_field *field, char *sentence)
{
    static const struct gm_observable common[] = {
        GM_WAVE_INVARIANTS, GM_WAVE_LAWS,
        GM_OBSERVABLE("longest_step", longest_step, "longest stable step of linear theory",
                      .missing = "linear theory sets this scheme no limit")};
    static const struct gm_observable evolving[] = {
        GM_OBSERVABLE("amplitude", gm_view_amplitude, "largest |u|"),
        GM_OBSERVABLE("crest", crest, "x where u is highest"),
    };
    static const struct gm_observable of_form[] = {
        GM_KEPT_OBSERVABLE("energy_error", form_energy, "H", "energy error"),
        GM_KEPT_OBSERVABLE("momentum_error", form_momentum, "P", "momentum error", .scale = gm_unit_momentum,
                           .scale_text = "1"),
        GM_OBSERVABLE("amplitude", gm_view_amplitude, "largest |u|"),
        GM_OBSERVABLE("crest", crest, "x where u is highest"),
        GM_LOCAL_LAWS,
    };
    static const struct gm_observable moving[] = {GM_MESH_ENERGIES, GM_MESH_NODES},
                                      errors[] = {GM_MESH_ERRORS};
    static const char infinite[] = "its density is not finite everywhere";
    static const struct gm_observable error =
        GM_LOG_OBSERVABLE("solution_error", solution_error, "distance from the exact solution");
    const struct gm_user_system *system = &field->system;
    const struct gm_observable *list = field->evolves   ? evolving
                                       : field->is_form ? of_form
                                       : field->moves   ? moving
                                                        : common;
    field->observable_count = field->evolves   ? GM_COUNT(evolving)
                              : field->is_form ? GM_COUNT(of_form)
                              : field->moves   ? GM_COUNT(moving)
                                               : GM_COUNT(common);
    memcpy(field->observables, list, field->observable_count * sizeof *list);
    if (field->solved && field->moves) {
        memcpy(field->observables + field->observable_count, errors, sizeof errors);
        field->observable_count += GM_COUNT(errors);
    } else if (field->solved) {
        field->observables[field->observable_count++] = error;
    }
    field->first_density = field->observable_count;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        const bool kept = item->word == GM_WORD_INVARIANT;
        if (!kept && item->word != GM_WORD_OBSERVE) {
            continue;
        }
        const size_t number = field->observable_count - field->first_density;
        char *key = NULL;
        if (number == MOST_DENSITIES) {
            return gm_refuse(sentence, "a field has at most %d invariants and observables", MOST_DENSITIES);
        }
        if (asprintf(&key, kept ? "%s_error" : "%s", item->name) < 0) {
            key = NULL;
        }
        if (!gm_kept_texts_add(&field->texts, key) ||
            !open_tape(field, &field->densities[number], item->nodes[0])) {
            return false;
        }
        for (size_t k = 0; k < field->observable_count; k++) {
            if (gm_observables_clash(key, field->observables[k].key)) {
                return gm_refuse(sentence, "there are two observables %s", key);
            }
        }
        struct gm_observable *row = &field->observables[field->observable_count++];
        *row = kept ? (struct gm_observable)GM_KEPT_OBSERVABLE(
                          key, integral, item->name, item->name,
                          .least = gm_system_option_number(item, GM_OPTION_SCALE, 0), .terms = terms,
                          .missing = infinite)
                    : (struct gm_observable)GM_OBSERVABLE(key, integral, item->name, .missing = infinite);
        gm_written_options(row, item);
    }
    return true;
}

static bool make_schemes(struct user_field *field, const struct gm_problem *problem, char *sentence)
{
    size_t count;
    const char *text = field->system.texts[GM_WORD_SCHEMES];
    size_t others;
    if (!gm_written_schemes(field->moves && gm_user_field_moving(text, &others) == 0 ? NULL : text, problem,
                            field->schemes, MOST_PREFERRED, &count, sentence)) {
        return false;
    }
    static const char *const evolving[] = {"etdrk4", "midpoint", NULL};
    static const char *const boxes[] = {"box", "gauss-box3", "gauss-box4", NULL};
    static const char *const moving[] = {"multiplier-lobatto4", "control-gauss4", "uniform-gauss4", NULL};
    field->scene.schemes = count > 0        ? field->schemes
                           : field->evolves ? evolving
                           : field->is_form ? boxes
                           : field->moves   ? moving
                                            : gm_wave_schemes;
    field->scene.lanes = field->system.texts[GM_WORD_LANES];
    return true;
}

/* With an exact solution the grid is refined with the step, and on a moving mesh, where each strategy has a motion of
   its own on given nodes, so that the same is measured against a run on more of them; else the distance from a reference
   run on the same grid is measured. */
static void make_work(struct user_field *field)
{
    field->work =
        (struct gm_work){.arguments = "",
                         .coarsest = field->initial->half_length / (double)field->initial->points * 2,
                         .halvings = 5};
    if (field->solved) {
        field->work.measure = "solution_error";
    } else if (field->moves) {
        field->work.reference = "multiplier-lobatto4";
        field->work.distance = gm_mesh_distance;
        field->work.distance_title = "distance from a finer run";
    }
    if (field->solved || field->moves) {
        field->work.resolution = "points";
        field->work.resolutions = field->resolutions;
        field->work.resolution_count = GM_COUNT(field->resolutions);
        field->work.errors = field->errors;
        for (size_t i = 0; i < GM_COUNT(field->resolutions); i++) {
            field->resolutions[i] = ldexp((double)field->initial->points, (int)i - 1);
            field->errors[i] = pow(10, -1 - (double)i);
        }
        field->resolutions[0] = fmax(field->moves ? 1 : 3, floor(field->resolutions[0]));
    }
}

static const char *title_of(struct user_field *field)
{
    enum { SHORT = 48 };
    const struct gm_user_system *system = &field->system;
    const struct gm_naming naming = gm_system_naming(system);
    if (system->texts[GM_WORD_TITLE]) {
        return system->texts[GM_WORD_TITLE];
    }
    if (field->evolves || field->is_form) {
        return "A field of one’s own";
    }
    char *formula = gm_formula_text(&system->graph, system->energy, &naming), *text = NULL;
    const bool brief = formula && strlen(formula) <= SHORT;
    if (brief && asprintf(&text, "Waves in the potential V = %s", formula) < 0) {
        text = NULL;
    }
    free(formula);
    const char *kept = gm_kept_texts_add(&field->texts, text);
    return kept ? kept : "Waves in a potential of one’s own";
}

static bool on_a_mesh(const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_mesh;
}

size_t gm_user_field_moving(const char *schemes, size_t *others)
{
    size_t moving = 0;
    char name[64];
    for (*others = 0; gm_listed_word(&schemes, name, sizeof name);) {
        const struct gm_scheme *scheme = gm_scheme_find(name);
        const bool moves = scheme && on_a_mesh(scheme);
        moving += moves;
        *others += !moves;
    }
    return moving;
}

static bool on_a_ring(const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_field &&
           !(scheme->needs & ~(unsigned)(GM_NEEDS_WAVE | GM_NEEDS_FORM | GM_NEEDS_PAIRS));
}

static bool make(struct user_field *field, const char *name, const char *const *words, char *sentence)
{
    struct gm_user_system *system = &field->system;
    gm_refuse(sentence, "not enough memory");
    field->evolves = system->kind == GM_EVOLUTION;
    field->is_form = system->kind == GM_MATRICES;
    if (field->is_form && system->texts[GM_WORD_BOUNDARY] &&
        strcmp(system->texts[GM_WORD_BOUNDARY], "walls") == 0) {
        return gm_refuse(sentence,
                         "an equation by matrices is one on a ring: what its components are in the mirror "
                         "of a wall is not told");
    }
    if (field->moves && system->texts[GM_WORD_BOUNDARY] &&
        strcmp(system->texts[GM_WORD_BOUNDARY], "walls") == 0) {
        return gm_refuse(sentence, "boundary: walls mean u_x = 0, and the ends of a moving mesh hold u");
    }
    if (!(field->evolves   ? gm_user_evolution_derive(&field->evolution, system)
          : field->is_form ? gm_user_form_derive(&field->form, system)
                           : gm_user_wave_derive(&field->wave, system)) ||
        !make_rows(field, sentence)) {
        return false;
    }
    field->solved = (field->evolves   ? field->evolution.exact[0]
                     : field->is_form ? field->form.exact[0]
                                      : field->wave.exact) != GM_NO_NODE;
    const struct gm_system_item *jump = gm_system_item_of(system, GM_WORD_JUMP, 0);
    field->track =
        field->moves ? (struct gm_track)GM_MESH_PATHS_TRACK : (struct gm_track)GM_SURFACE_TRACK(record_shown);
    field->scene = (struct gm_scene){
        .name = name,
        .title = title_of(field),
        .blurb = system->texts[GM_WORD_ABOUT] ? system->texts[GM_WORD_ABOUT] : "A field of one’s own.",
        .watch = system->texts[GM_WORD_WATCH] ? system->texts[GM_WORD_WATCH] : "",
        .time =
            field->evolves || field->is_form ? "that of the equation" : "what light needs for a length of 1",
        .size = sizeof *field->initial + parameter_count(field) * (sizeof(double) + 1),
        .initial = field->initial,
        .words = words,
        .source = system->source,
        .text = system->source,
        .mark = gm_kept_texts_add(&field->texts, gm_written_mark(name, system->source)),
        .parameters = field->rows,
        .parameter_count = field->row_count,
        .tracks = &field->track,
        .track_count = 1,
        .work = &field->work,
        .settle = settle,
        .elsewhere = field->moves                                         ? on_a_ring
                     : system->kind == GM_FIELD && !field->initial->walls ? on_a_mesh
                                                                          : NULL,
        .setup = setup,
        .close = close_problem,
        .start = start,
        .start_with = field->moves ? start_mesh : start_checked,
        .chosen = field->moves ? note_alpha : NULL,
        .draw = field->moves ? draw_mesh : draw,
        .failure = tell_failure,
    };
    struct gm_problem problem;
    if (!field->scene.mark || (jump && !open_tape(field, &field->jump, jump->nodes[0])) ||
        !setup(field->initial, &problem, sentence)) {
        return false;
    }
    const size_t points = field->moves ? 400 : problem.line.points;
    double *y = malloc((field->moves ? points : problem.n) * sizeof *y);
    bool good = y && make_observables(field, sentence) && make_schemes(field, &problem, sentence);
    if (good && field->moves) {
        for (size_t i = 0; i < points; i++) {
            const double x = field->initial->half_length * (2 * (double)i / (double)(points - 1) - 1);
            double slope, rate;
            gm_moving_mesh_of(&problem)->start(problem.parameters, x, &y[i], &slope, &rate);
        }
    } else if (good) {
        good = start_checked(field->initial, &problem, NULL, y, sentence);
    }
    if (good) {
        field->low = field->high = y[0];
        for (size_t i = 0; i < points; i++) {
            gm_range_add(&field->low, &field->high, y[i]);
        }
        if (!(field->high > field->low)) {
            field->high += 1;
            field->low -= 1;
        }
    }
    free(y);
    close_problem(&problem);
    make_work(field);
    static const struct gm_observable law[] = {
        GM_FORM_RESIDUAL}; /* a look at it takes as long as two steps */
    field->scene.asked = law;
    field->scene.asked_count = field->is_form ? GM_COUNT(law) : 0;
    field->scene.observables = field->observables;
    field->scene.observable_count = field->observable_count;
    return good;
}

const struct gm_scene *gm_user_field_open(struct gm_user_system *system, const char *name,
                                          const char *const *words, bool moves, char *sentence)
{
    struct user_field *field = calloc(1, sizeof *field);
    if (!field) {
        gm_system_close(system);
        gm_refuse(sentence, "not enough memory");
        return NULL;
    }
    field->system = *system;
    field->moves = moves && system->kind == GM_FIELD;
    if (!make(field, name, words, sentence)) {
        gm_user_field_close(&field->scene);
        return NULL;
    }
    return &field->scene;
}

void gm_user_field_close(const struct gm_scene *scene)
{
    struct user_field *field = (struct user_field *)scene; /* which it is the first member of */
    for (size_t i = 0; i < MOST_DENSITIES; i++) {
        gm_tape_close(&field->densities[i]);
    }
    gm_tape_close(&field->jump);
    gm_user_evolution_close(&field->evolution);
    gm_kept_texts_close(&field->texts);
    gm_system_close(&field->system);
    free(field->rows);
    free(field->initial);
    free(field);
}
