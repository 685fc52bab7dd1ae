/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equilibria by Newton's method from a coarse grid, and from every cell of a fine one where both components of f
   change their signs. On an edge with a change of sign bisection shows if there is a zero: if the values do not fall,
   there is a pole or a jump. */
#include "core/ode/portrait/portrait.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/functions.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"

enum {
    COLUMNS = GM_PORTRAIT_COLUMNS,
    ROWS = GM_PORTRAIT_ROWS,
    CORNERS = (COLUMNS + 1) * (ROWS + 1),
    START_COLUMNS = 24,
    START_ROWS = 18,
    MOST_STEPS = 80,
    BISECTIONS = 10
};

/* Bounds relative to the window. A multiple zero is known to `alike_multiple` only. */
static const double alike = 1e-6, alike_multiple = 1e-4, converged = 1e-7, round_off = 1e-15;
/* Bounds relative to what f and its Jacobian reach beside the point: at this distance, a part of the window. */
static const double beside = 1e-3, residual = 1e-9, uncertain = 1e-4, negligible = 1e-12, kink = 0.1;
/* The values beside a zero fall below this part of those at the ends of its edge. */
static const double fallen = 0.1;

const char *gm_equilibrium_kind_name(enum gm_equilibrium_kind kind)
{
    static const char *const names[] = {[GM_SADDLE] = "saddle",
                                        [GM_STABLE_NODE] = "stable node",
                                        [GM_STABLE_FOCUS] = "stable focus",
                                        [GM_UNSTABLE_NODE] = "unstable node",
                                        [GM_UNSTABLE_FOCUS] = "unstable focus",
                                        [GM_CENTRE] = "centre",
                                        [GM_DEGENERATE] = "degenerate",
                                        [GM_NOT_SMOOTH] = "not smooth"};
    return names[kind];
}

/* ---- the grid ---- */

/* Writes x and y of a corner to places[0] and places[apart]. */
static void place_corner(const struct gm_window *window, size_t corner, double *places, size_t apart)
{
    const double across = (double)(corner % (COLUMNS + 1)) / COLUMNS,
                 up = (double)(corner / (COLUMNS + 1)) / ROWS;
    places[0] = window->low[0] + across * (window->high[0] - window->low[0]);
    places[apart] = window->low[1] + up * (window->high[1] - window->low[1]);
}

static bool has_change(double a, double b)
{
    return isfinite(a) && isfinite(b) && (a > 0) != (b > 0);
}

/* Returns true if the component changes its sign between two corners by a zero: bisection makes its values fall. */
static bool has_zero(const struct gm_portrait *portrait, const struct gm_problem *problem, size_t component,
                     const size_t corners[2])
{
    double ends[2][2], middle[2], f[2];
    double values[] = {portrait->fields[component][corners[0]], portrait->fields[component][corners[1]]};
    const double before = fmax(fabs(values[0]), fabs(values[1]));
    place_corner(&portrait->window, corners[0], ends[0], 1);
    place_corner(&portrait->window, corners[1], ends[1], 1);
    for (int i = 0; i < BISECTIONS; i++) {
        middle[0] = (ends[0][0] + ends[1][0]) / 2;
        middle[1] = (ends[0][1] + ends[1][1]) / 2;
        gm_field(problem, middle, f, 1);
        const size_t end = (f[component] > 0) == (values[0] > 0) ? 0 : 1;
        memcpy(ends[end], middle, sizeof middle);
        values[end] = f[component];
    }
    return fmax(fabs(values[0]), fabs(values[1])) <= fallen * before;
}

/* Marks the ends of edges with a pole or a jump. */
static void mark_poles(const struct gm_portrait *portrait, const struct gm_problem *problem)
{
    for (size_t k = 0; k < (size_t)4 * CORNERS; k++) { /* per corner two edges of two components */
        const size_t corner = k / 4, component = k % 2, i = corner % (COLUMNS + 1);
        const bool is_across = k % 4 < 2,
                   is_inside = is_across ? i < COLUMNS : corner < CORNERS - COLUMNS - 1;
        const size_t ends[] = {corner, corner + (is_across ? 1 : COLUMNS + 1)};
        double *field = portrait->fields[component];
        if (is_inside && has_change(field[ends[0]], field[ends[1]]) &&
            !has_zero(portrait, problem, component, ends)) {
            field[ends[0]] = field[ends[1]] = NAN;
        }
    }
}

/* Returns true if both components change their signs between the corners of a cell. */
static bool has_both(const struct gm_portrait *portrait, size_t i, size_t j)
{
    bool both = true;
    for (size_t c = 0; c < 2; c++) {
        const double *low = portrait->fields[c] + j * (COLUMNS + 1) + i, *high = low + COLUMNS + 1;
        both = both &&
               (has_change(low[0], low[1]) || has_change(high[0], high[1]) || has_change(low[0], high[0]));
    }
    return both;
}

/* Fills the fields. Returns false when out of memory. */
static bool fill_fields(struct gm_portrait *portrait, const struct gm_problem *problem)
{
    double *places = malloc((size_t)2 * CORNERS * sizeof *places);
    portrait->fields[0] = malloc((size_t)2 * CORNERS * sizeof *portrait->fields[0]);
    const bool ready = places && portrait->fields[0];
    for (size_t k = 0; ready && k < CORNERS; k++) {
        place_corner(&portrait->window, k, places + k, CORNERS);
    }
    if (ready) {
        portrait->fields[1] = portrait->fields[0] + CORNERS;
        gm_field(problem, places, portrait->fields[0], CORNERS);
    }
    free(places);
    return ready;
}

/* ---- equilibria ---- */

struct search {
    const struct gm_problem *problem;
    struct gm_portrait *portrait;
    double size[2]; /* of the window */
};

/* Largest values on a ring around a point, at `beside`. */
struct ring {
    double field[2], entries[4];      /* |f|, and entries of |J| */
    double entry, trace, determinant; /* changes of them from their values at the point */
};

static struct ring look_around(const struct search *search, const double *at, const double *jacobian)
{
    static const double directions[][2] = {{1, 0},   {-1, 0},   {0, 1},    {0, -1},
                                           {.7, .7}, {-.7, .7}, {.7, -.7}, {-.7, -.7}};
    struct ring ring = {.entry = 0};
    const double trace = jacobian[0] + jacobian[3],
                 determinant = jacobian[0] * jacobian[3] - jacobian[1] * jacobian[2];
    for (size_t i = 0; i < GM_COUNT(directions); i++) {
        double point[2], f[2], j[4];
        for (size_t k = 0; k < 2; k++) {
            point[k] = at[k] + beside * directions[i][k] * search->size[k];
        }
        gm_field(search->problem, point, f, 1);
        if (!isfinite(f[0] + f[1]) || !gm_jacobian(search->problem, point, j)) {
            continue;
        }
        for (size_t k = 0; k < 4; k++) {
            ring.field[k / 2] = fmax(ring.field[k / 2], fabs(f[k / 2]));
            ring.entries[k] = fmax(ring.entries[k], fabs(j[k]));
            ring.entry = fmax(ring.entry, fabs(j[k] - jacobian[k]));
        }
        ring.trace = fmax(ring.trace, fabs(j[0] + j[3] - trace));
        ring.determinant = fmax(ring.determinant, fabs(j[0] * j[3] - j[1] * j[2] - determinant));
    }
    return ring;
}

/* Returns true if the Jacobian jumps at a point: very near it changes as much as it does on the ring. */
static bool has_kink(const struct search *search, const double *at, const struct ring *ring)
{
    double j[2][4], jump = 0, largest = 0;
    for (size_t side = 0; side < 4; side++) {
        double point[2] = {at[0], at[1]};
        point[side / 2] += (side % 2 ? 1e-4 : -1e-4) * beside * search->size[side / 2];
        if (!gm_jacobian(search->problem, point, j[side % 2])) {
            return false;
        }
        for (size_t k = 0; k < 4 && side % 2; k++) {
            jump = fmax(jump, fabs(j[1][k] - j[0][k]));
            largest = fmax(largest, ring->entries[k]);
        }
    }
    return jump > kink * ring->entry && jump > residual * largest;
}

/* Writes Newton's step -J^+ f in units of the window, where each row of J and f has length 1: with the pseudoinverse
   J' / |J|^2 if J has rank 1. */
static void find_step(const struct search *search, const double *jacobian, const double *f, double *step)
{
    double j[4], u[2];
    for (size_t row = 0; row < 2; row++) {
        const double *entry = jacobian + 2 * row,
                     length = gm_hypot(entry[0] * search->size[0], entry[1] * search->size[1]);
        const bool none = length == 0 && f[row] == 0; /* the component is 0 here, and does not change */
        u[row] = none ? 0 : f[row] / length;
        for (size_t k = 0; k < 2; k++) {
            j[2 * row + k] = none ? 0 : entry[k] * search->size[k] / length;
        }
    }
    const double det = j[0] * j[3] - j[1] * j[2],
                 square = j[0] * j[0] + j[1] * j[1] + j[2] * j[2] + j[3] * j[3];
    if (fabs(det) > 1e-13) {
        step[0] = (j[1] * u[1] - j[3] * u[0]) / det;
        step[1] = (j[2] * u[0] - j[0] * u[1]) / det;
    } else {
        step[0] = -(j[0] * u[0] + j[2] * u[1]) / square;
        step[1] = -(j[1] * u[0] + j[3] * u[1]) / square;
    }
}

/* Returns the factor of a step that is `ratio` of the one before. At a multiple zero this ratio is constant, and
   the remaining steps are a geometric series, which is summed (Aitken). */
static double stretch(double ratio, double ratio_before)
{
    static const double alike_ratios = 0.01, quick = 0.3, slow = 0.95;
    return fabs(ratio - ratio_before) < alike_ratios && ratio > quick && ratio < slow ? 1 / (1 - ratio) : 1;
}

/* Moves a point to an equilibrium, with the Jacobian there and what lies around. Returns false if it finds none in the
   window. */
static bool solve(const struct search *search, double *at, double *jacobian, struct ring *ring)
{
    const struct gm_window *window = &search->portrait->window;
    double f[2], step[2], length = INFINITY, ratio = 0;
    for (int i = 0; i < MOST_STEPS && length > round_off; i++) {
        gm_field(search->problem, at, f, 1);
        if (!gm_jacobian(search->problem, at, jacobian)) {
            return false;
        }
        if (f[0] == 0 && f[1] == 0) {
            length = 0;
            break;
        }
        find_step(search, jacobian, f, step);
        const double before = length;
        length = fmax(fabs(step[0]), fabs(step[1]));
        if (!isfinite(length) || (length < converged && length >= before)) { /* the rest is round-off */
            length = before;
            break;
        }
        const double ratio_before = ratio;
        ratio = length / before;
        const double factor = stretch(ratio, ratio_before);
        for (size_t k = 0; k < 2; k++) {
            at[k] += factor * step[k] * search->size[k];
            if (at[k] < window->low[k] - search->size[k] || at[k] > window->high[k] + search->size[k]) {
                return false;
            }
        }
    }
    gm_field(search->problem, at, f, 1);
    if (!(length < converged && gm_jacobian(search->problem, at, jacobian))) {
        return false;
    }
    bool found = true;
    *ring = look_around(search, at, jacobian);
    for (size_t k = 0; k < 2; k++) {
        at[k] = fabs(at[k]) < round_off * search->size[k] ? 0 : at[k];
        const double beyond = fmax(window->low[k] - at[k], at[k] - window->high[k]);
        found = found && fabs(f[k]) <= residual * ring->field[k] && beyond <= round_off * search->size[k];
    }
    return found;
}

/* Writes the eigenvalues and the kind that they make. The place of a multiple zero is uncertain, and with it the
   determinant and the trace there: what the ring shows decides if they are 0. */
static void classify(const struct search *search, struct gm_equilibrium *equilibrium, const struct ring *ring)
{
    double *j = equilibrium->jacobian;
    for (size_t k = 0; k < 4; k++) {
        j[k] = fabs(j[k]) <= negligible * ring->entries[k] ? 0 : j[k];
    }
    const double trace = j[0] + j[3], det = j[0] * j[3] - j[1] * j[2],
                 products = fabs(j[0] * j[3]) + fabs(j[1] * j[2]);
    /* (trace / 2)^2 - det without cancellation */
    const double root = (j[0] - j[3]) * (j[0] - j[3]) / 4 + j[1] * j[2];
    double(*values)[2] = equilibrium->eigenvalues;
    memset(values, 0, sizeof equilibrium->eigenvalues);
    if (has_kink(search, equilibrium->at, ring)) {
        equilibrium->kind = GM_NOT_SMOOTH;
        values[0][0] = values[0][1] = values[1][0] = values[1][1] = NAN;
        return;
    }
    if (fabs(det) <= uncertain * ring->determinant || fabs(det) <= negligible * products) {
        const double other = fabs(trace) <= uncertain * ring->trace ? 0 : trace;
        equilibrium->kind = GM_DEGENERATE;
        values[0][0] = fmax(other, 0);
        values[1][0] = fmin(other, 0);
        return;
    }
    if (root < 0) {
        values[0][0] = values[1][0] = trace / 2;
        values[0][1] = sqrt(-root);
        values[1][1] = -values[0][1];
    } else { /* the smaller one from the product */
        const double large = trace / 2 + copysign(sqrt(root), trace), small = large != 0 ? det / large : 0;
        values[0][0] = fmax(large, small);
        values[1][0] = fmin(large, small);
    }
    const double balance = fmax(fabs(j[0]), fabs(j[3]));
    if (det < 0) {
        equilibrium->kind = GM_SADDLE;
    } else if (fabs(trace) <= negligible * balance + residual * ring->trace) {
        equilibrium->kind = GM_CENTRE;
        values[0][0] = values[1][0] = 0;
    } else if (root >= 0) {
        equilibrium->kind = trace < 0 ? GM_STABLE_NODE : GM_UNSTABLE_NODE;
    } else {
        equilibrium->kind = trace < 0 ? GM_STABLE_FOCUS : GM_UNSTABLE_FOCUS;
    }
}

/* Returns true if two equilibria are one, as far as their places are known. */
static bool is_same(const struct search *search, const struct gm_equilibrium *a,
                    const struct gm_equilibrium *b)
{
    const bool multiple = a->kind == GM_DEGENERATE && b->kind == GM_DEGENERATE;
    const double most = multiple ? alike_multiple : alike;
    return fabs(a->at[0] - b->at[0]) <= most * search->size[0] &&
           fabs(a->at[1] - b->at[1]) <= most * search->size[1];
}

/* Returns true if a is before b, by x, then y. */
static bool is_before(const struct search *search, const double *a, const double *b)
{
    return fabs(a[0] - b[0]) > alike * search->size[0] ? a[0] < b[0] : a[1] < b[1];
}

/* Returns true if an equilibrium is one point of a curve of them: from a point beside it, along the null vector of J,
   Newton's method finds another. It finds the same one if that is isolated. */
static bool is_on_curve(const struct search *search, const struct gm_equilibrium *equilibrium)
{
    const double *j = equilibrium->jacobian, *row = gm_hypot(j[0], j[1]) > gm_hypot(j[2], j[3]) ? j : j + 2,
                 null[] = {row[1], -row[0]};
    const double largest = fmax(fabs(null[0]) / search->size[0], fabs(null[1]) / search->size[1]);
    for (double sign = -1; sign <= 1; sign += 2) {
        double other[2], jacobian[4], moved = 0;
        struct ring ring;
        for (size_t k = 0; k < 2; k++) {
            other[k] =
                equilibrium->at[k] + sign * beside * (largest > 0 ? null[k] / largest : search->size[k]);
        }
        const bool found = solve(search, other, jacobian, &ring);
        for (size_t k = 0; found && k < 2; k++) {
            moved = fmax(moved, fabs(other[k] - equilibrium->at[k]) / search->size[k]);
        }
        if (moved > beside / 2) {
            return true;
        }
    }
    return false;
}

/* Adds the equilibrium that Newton's method finds from a point, in its place, unless it is there or on a curve. Looks
   for others beside a new one, of which a cell may hold several. */
static void add_from(const struct search *search, double x, double y)
{
    struct gm_portrait *portrait = search->portrait;
    struct gm_equilibrium found = {.at = {x, y}};
    struct ring ring;
    if (!solve(search, found.at, found.jacobian, &ring)) {
        return;
    }
    classify(search, &found, &ring);
    size_t place = 0;
    for (size_t i = 0; i < portrait->count; i++) {
        if (is_same(search, &portrait->equilibria[i], &found)) {
            return;
        }
        place += is_before(search, portrait->equilibria[i].at, found.at);
    }
    if (found.kind == GM_DEGENERATE && is_on_curve(search, &found)) {
        portrait->missing = "equilibria fill a curve, which is not listed";
        return;
    }
    if (portrait->count == GM_MOST_EQUILIBRIA) {
        portrait->missing = "the window has more than 64 equilibria; a smaller one shows the others";
        return;
    }
    memmove(portrait->equilibria + place + 1, portrait->equilibria + place,
            (portrait->count - place) * sizeof found);
    portrait->equilibria[place] = found;
    portrait->count++;
    for (int i = 0; i < 8; i++) {
        const double aside = (i < 4 ? beside : 3 * beside);
        add_from(search, found.at[0] + (i % 2 ? aside : -aside) * search->size[0],
                 found.at[1] + (i % 4 < 2 ? aside : -aside) * search->size[1]);
    }
}

/* Starts from the middle of cell `cell` of a grid over the window. */
static void add_from_cell(const struct search *search, size_t cell, size_t columns, size_t rows)
{
    const struct gm_window *window = &search->portrait->window;
    const double i = (double)(cell % columns) + 0.5, j = (double)(cell / columns) + 0.5;
    add_from(search, window->low[0] + search->size[0] * i / (double)columns,
             window->low[1] + search->size[1] * j / (double)rows);
}

bool gm_portrait_open(struct gm_portrait *portrait, const struct gm_problem *problem,
                      const struct gm_window *window)
{
    enum { MOST_CELLS = 256 };
    *portrait = (struct gm_portrait){.window = *window};
    struct search search = {.problem = problem,
                            .portrait = portrait,
                            .size = {window->high[0] - window->low[0], window->high[1] - window->low[1]}};
    if (!fill_fields(portrait, problem)) {
        return false;
    }
    bool is_finite = false, moves = false;
    for (size_t k = 0; k < CORNERS && !moves; k++) {
        const double f[] = {portrait->fields[0][k], portrait->fields[1][k]};
        is_finite = is_finite || (isfinite(f[0]) && isfinite(f[1]));
        moves = isfinite(f[0]) && isfinite(f[1]) && (f[0] != 0 || f[1] != 0);
    }
    portrait->missing = !is_finite ? "the field is nowhere finite in the window"
                        : !moves   ? "the field is 0 in the whole window"
                                   : NULL;
    mark_poles(portrait, problem);
    size_t cells = 0;
    for (size_t cell = 0; cell < (size_t)COLUMNS * ROWS && cells < MOST_CELLS; cell++) {
        if (has_both(portrait, cell % COLUMNS, cell / COLUMNS)) {
            cells++;
            add_from_cell(&search, cell, COLUMNS, ROWS);
        }
    }
    for (size_t cell = 0; cell < (size_t)START_COLUMNS * START_ROWS && moves; cell++) {
        add_from_cell(&search, cell, START_COLUMNS, START_ROWS);
    }
    return true;
}

void gm_portrait_close(struct gm_portrait *portrait)
{
    free(portrait->fields[0]);
}
