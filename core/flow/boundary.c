/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the sides of boundary edges to what is given at the boundary's vertices: psi, sheets, the scalar; and
   which vertices have one unknown psi together, around holes. */
#include "core/flow/boundary.h"

#include <math.h>
#include <string.h>

/* The construction of a boundary. */
struct maker {
    struct gm_flow *flow;
    const unsigned char *side_of;
    const struct gm_side *sides;
    enum gm_vertex_kind outlet;
};

static bool is_open(const struct gm_side *side)
{
    return side->kind == GM_EDGE_INLET || side->kind == GM_EDGE_OUTLET;
}

/* The value that a side gives at a point of its part s. */
static double given(const struct gm_side *side, enum gm_given what, double s, const double at[2])
{
    const double same[] = {[GM_GIVEN_THETA] = side->theta,
                           [GM_GIVEN_TEMPERATURE] = side->temperature,
                           [GM_GIVEN_TANGENTIAL] = side->speed,
                           [GM_GIVEN_HEAT] = side->heat};
    return side->varying ? side->varying(side->data, what, s, at) : same[what];
}

/* The integral of the profile over edge e, from the part s of the piece on, with Lobatto's rule of four
   points: they include the ends, so that a profile that is not finite there is detected. Adds that of the
   magnitude. */
static double through_edge(const struct gm_complex *complex, const struct gm_side *side, size_t e, double s,
                           double length, double *magnitude)
{
    static const double node[4] = {-1, -0.4472135954999579, 0.4472135954999579, 1},
                        weight[4] = {1.0 / 12, 5.0 / 12, 5.0 / 12, 1.0 / 12};
    const double own = complex->length[complex->boundary_edge[e]];
    const double *a = complex->point + 2 * complex->boundary_vertex[e],
                 *b = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, e)];
    double sum = 0, size = 0;
    for (int i = 0; i < 4; i++) {
        const double part = (1 + node[i]) / 2;
        const double at[2] = {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])};
        const double speed = side->profile(side->data, s + part * own / length, at);
        sum += weight[i] * own * speed;
        size += weight[i] * own * fabs(speed);
    }
    *magnitude += size;
    return sum;
}

/* Measures an opening's flow by its side's profile; the magnitude of the profile is integrated, too. */
static double measure_profile(const struct gm_complex *complex, const struct gm_side *side,
                              struct gm_opening *opening)
{
    double passed = opening->before, magnitude = 0;
    size_t e = opening->first;
    opening->profile = 0;
    for (size_t i = 0; side->profile && i < opening->count; i++, e = gm_complex_next(complex, e)) {
        opening->profile +=
            through_edge(complex, side, e, passed / opening->side_length, opening->side_length, &magnitude);
        passed += complex->length[complex->boundary_edge[e]];
    }
    return magnitude;
}

/* The pieces of inlets and outlets, in the order of the boundary. */
static enum gm_boundary_fault find_openings(const struct maker *maker)
{
    struct gm_flow *flow = maker->flow;
    const struct gm_complex *complex = flow->complex;
    size_t inlets = 0, outlets = 0;
    for (size_t e = 0; e < complex->boundary; e++) {
        const unsigned char side = maker->side_of[e];
        const bool begins = maker->side_of[gm_complex_previous(complex, e)] != side;
        if (!is_open(&maker->sides[side])) {
            continue;
        }
        /* in a mesh that overlaps itself no loop is within another */
        const bool elsewhere =
            flow->openings > 0 && complex->loop[e] != complex->loop[flow->opening[0].first];
        flow->faulty = side;
        if (flow->hole[complex->boundary_vertex[e]] > 0 || elsewhere) {
            return GM_BOUNDARY_IN_HOLE;
        }
        *(maker->sides[side].kind == GM_EDGE_INLET ? &inlets : &outlets) += 1;
        if (!begins) {
            continue;
        }
        struct gm_opening *opening = &flow->opening[flow->openings++];
        *opening =
            (struct gm_opening){.side = side, .first = e, .inlet = maker->sides[side].kind == GM_EDGE_INLET};
        for (opening->end = e; maker->side_of[opening->end] == side && opening->count < complex->boundary;
             opening->count++) {
            opening->end = gm_complex_next(complex, opening->end);
        }
        if (opening->count == 1) {
            return GM_BOUNDARY_SHORT;
        }
    }
    flow->faulty = 0;
    const bool whole = inlets + outlets == complex->boundary && complex->boundary > 0 && flow->openings < 2;
    return whole                           ? GM_BOUNDARY_WHOLE
           : (inlets > 0) != (outlets > 0) ? inlets > 0 ? GM_BOUNDARY_NO_OUTLET : GM_BOUNDARY_NO_INLET
                                           : GM_BOUNDARY_OK;
}

/* Measures lengths of openings and their places in their sides, which begin counter-clockwise from the
   lowest of the leftmost points of the wall. */
static void measure_openings(struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    double length[256] = {0};
    size_t corner = 0;
    for (size_t b = 0; b < complex->boundary; b++) {
        const double *p = complex->point + 2 * complex->boundary_vertex[b],
                     *least = complex->point + 2 * complex->boundary_vertex[corner];
        corner = p[0] < least[0] || (p[0] == least[0] && p[1] < least[1]) ? b : corner;
    }
    size_t first = 0;
    while (first < flow->openings && flow->opening[first].first < corner) {
        first++;
    }
    for (size_t i = 0; i < flow->openings; i++) {
        struct gm_opening *opening = &flow->opening[(first + i) % flow->openings];
        size_t e = opening->first;
        for (size_t k = 0; k < opening->count; k++, e = gm_complex_next(complex, e)) {
            opening->length += complex->length[complex->boundary_edge[e]];
        }
        opening->before = length[opening->side];
        length[opening->side] += opening->length;
    }
    for (size_t i = 0; i < flow->openings; i++) {
        flow->opening[i].side_length = length[flow->opening[i].side];
    }
}

/* Computes the flow through each opening, and the largest speed. */
static enum gm_boundary_fault share_flow(const struct maker *maker)
{
    struct gm_flow *flow = maker->flow;
    double in = 0, out = 0, open_length = 0, side_profile[256] = {0};
    measure_openings(flow);
    for (size_t i = 0; i < flow->openings; i++) {
        struct gm_opening *opening = &flow->opening[i];
        const double size = measure_profile(flow->complex, &maker->sides[opening->side], opening);
        side_profile[opening->side] += opening->profile;
        flow->faulty = opening->side;
        if (size > 0 && !(opening->profile > 1e-9 * size)) {
            return GM_BOUNDARY_PROFILE;
        }
    }
    for (size_t i = 0; i < flow->openings; i++) {
        struct gm_opening *opening = &flow->opening[i];
        const struct gm_side *side = &maker->sides[opening->side];
        flow->faulty = opening->side;
        if (side->profile && side->flow > 0 && !(side_profile[opening->side] > 0)) {
            return GM_BOUNDARY_PROFILE;
        }
        if (!isnan(side->flow)) {
            const double part = side_profile[opening->side] > 0
                                    ? opening->profile / side_profile[opening->side]
                                    : opening->length / opening->side_length;
            opening->flow = side->flow * part;
        } else if (side->profile) {
            opening->flow = opening->profile;
        } else if (opening->inlet) {
            opening->flow = 2.0 / 3 * side->speed * opening->length;
        } else {
            open_length += opening->length;
        }
        *(opening->inlet ? &in : &out) += opening->flow;
    }
    flow->faulty = 0;
    if (!isfinite(in) || !isfinite(out)) {
        return GM_BOUNDARY_OVERFLOW;
    }
    if (open_length == 0 && fabs(in - out) > 1e-9 * fmax(fabs(in), fabs(out))) {
        return GM_BOUNDARY_UNBALANCED;
    }
    const double all = in - out, rest = fabs(all) > 1e-9 * fmax(fabs(in), fabs(out)) ? all : 0;
    for (size_t i = 0; i < flow->openings; i++) {
        struct gm_opening *opening = &flow->opening[i];
        const struct gm_side *side = &maker->sides[opening->side];
        const bool left = isnan(side->flow) && !side->profile && !opening->inlet;
        if (left && rest < 0) {
            return GM_BOUNDARY_BACKWARDS;
        }
        opening->flow = left ? rest * (opening->length / open_length) : opening->flow;
        if (!opening->inlet || side->profile || !isnan(side->flow)) {
            flow->speed = fmax(flow->speed, 1.5 * fabs(opening->flow) / opening->length);
        }
    }
    return GM_BOUNDARY_OK;
}

static bool holds(const struct gm_side *side, enum gm_given what)
{
    return what == GM_GIVEN_THETA ? !side->theta_free : !side->temperature_free;
}

/* The side that holds the scalar or the temperature where two sides meet: a wall before an inlet; NULL: neither
   holds it. */
static const struct gm_side *winner(const struct gm_side *before, const struct gm_side *side,
                                    enum gm_given what)
{
    const struct gm_side *meet[2] = {before, side}, *holder = NULL;
    for (int k = 0; k < 2; k++) {
        const bool wall = !is_open(meet[k]), inlet = meet[k]->kind == GM_EDGE_INLET;
        holder = holds(meet[k], what) && (wall || (inlet && !holder)) ? meet[k] : holder;
    }
    return holder;
}

/* The scalar or the temperature of vertex v, at the part s of the side, is held at what it gives; NULL: it is
   not held. */
static void hold(const struct maker *maker, enum gm_given what, int v, const struct gm_side *side, double s)
{
    struct gm_flow *flow = maker->flow;
    if (what == GM_GIVEN_TEMPERATURE && !flow->heat) {
        return;
    }
    const double value = side ? given(side, what, s, flow->complex->point + 2 * v) : 0;
    if (what == GM_GIVEN_THETA) {
        flow->theta_fixed[v] = side != NULL;
        flow->theta[v] = value;
    } else {
        flow->temperature_fixed[v] = side != NULL;
        flow->temperature[v] = side ? value : flow->reference_temperature;
        flow->temperature_holder[v] = (unsigned char)(side ? 1 + (side - maker->sides) : 0);
    }
}

/* Holds the values of an inlet at the part s: at every inner vertex, and at its ends if no wall and no
   previous inlet holds them. An outlet holds nothing. */
static void hold_opening(const struct maker *maker, const struct gm_side *side, size_t e, bool inside,
                         double s)
{
    const struct gm_complex *complex = maker->flow->complex;
    const struct gm_side *before = &maker->sides[maker->side_of[gm_complex_previous(complex, e)]],
                         *behind = &maker->sides[maker->side_of[e]];
    const bool inlet = side->kind == GM_EDGE_INLET;
    for (int what = GM_GIVEN_THETA; what <= GM_GIVEN_TEMPERATURE; what++) {
        if (inside || (inlet && winner(before, behind, (enum gm_given)what) == side)) {
            hold(maker, (enum gm_given)what, complex->boundary_vertex[e],
                 inlet && holds(side, (enum gm_given)what) ? side : NULL, s);
        }
    }
}

/* Gives the vertices inside a piece their kind and the profile, and returns psi after it. */
static double open_piece(const struct maker *maker, const struct gm_opening *opening, double level)
{
    struct gm_flow *flow = maker->flow;
    const struct gm_complex *complex = flow->complex;
    const struct gm_side *side = &maker->sides[opening->side];
    const enum gm_vertex_kind kind = opening->inlet ? GM_VERTEX_FIXED : maker->outlet;
    const double length = opening->length, whole = opening->side_length,
                 rise = opening->inlet ? -opening->flow : opening->flow, all = opening->profile;
    double passed = 0, sum = 0, magnitude = 0;
    size_t e = opening->first;
    for (size_t i = 0; i <= opening->count; i++, e = gm_complex_next(complex, e)) {
        const int v = complex->boundary_vertex[e];
        const double s = passed / length;
        const bool inside = i > 0 && i < opening->count;
        hold_opening(maker, side, e, inside, (opening->before + passed) / whole);
        if (i == opening->count) {
            break;
        }
        if (inside) {
            flow->kind[v] = (unsigned char)kind;
            flow->psi[v] = kind == GM_VERTEX_OPEN ? 0
                           : side->profile        ? level + rise * (all != 0 ? sum / all : s)
                                                  : level + rise * s * s * (3 - 2 * s);
            flow->open[v] = opening->inlet ? GM_OPEN_INLET : GM_OPEN_OUTLET;
        }
        sum += side->profile
                   ? through_edge(complex, side, e, (opening->before + passed) / whole, whole, &magnitude)
                   : 0;
        passed += complex->length[complex->boundary_edge[e]];
    }
    return level + rise;
}

/* Lists the points where tracers return: all inlets as one line, along which psi is continuous. */
static void list_inflow(struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    struct gm_inflow *inflow = &flow->inflow;
    inflow->count = 0;
    flow->inlet_length = 0;
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        size_t e = opening->first;
        const double shift =
            inflow->count > 0 ? inflow->psi[inflow->count - 1] - flow->psi[complex->boundary_vertex[e]] : 0;
        for (size_t k = 0; opening->inlet && k <= opening->count; k++, e = gm_complex_next(complex, e)) {
            const int v = complex->boundary_vertex[e];
            const int *pair = complex->edge_triangle + 2 * (size_t)complex->boundary_edge[e];
            inflow->triangle[inflow->count] = pair[0] >= 0 ? pair[0] : pair[1];
            inflow->point[2 * inflow->count] = complex->point[2 * v];
            inflow->point[2 * inflow->count + 1] = complex->point[2 * v + 1];
            inflow->psi[inflow->count++] = flow->psi[v] + shift;
        }
        flow->inlet_length += opening->inlet ? opening->length : 0;
    }
}

static void number_holes(struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t loop = 0; loop < complex->loops; loop++) {
        if (gm_complex_loop_area(complex, loop) >= 0) {
            continue;
        }
        flow->holes++;
        for (size_t b = complex->loop_start[loop]; b < complex->loop_start[loop + 1]; b++) {
            flow->hole[complex->boundary_vertex[b]] = (int)flow->holes;
        }
    }
}

/* The vertices of boundary edge e, with the value that a side gives at the middle of each vertex's half.
   Returns the length of half an edge. */
static double halves(const struct gm_flow *flow, const struct gm_side *side, size_t e, enum gm_given what,
                     int vertex[2], double value[2])
{
    const struct gm_complex *complex = flow->complex;
    vertex[0] = complex->boundary_vertex[e];
    vertex[1] = complex->boundary_vertex[gm_complex_next(complex, e)];
    for (int k = 0; k < 2; k++) {
        const double *near = complex->point + 2 * vertex[k], *far = complex->point + 2 * vertex[1 - k],
                     middle[2] = {near[0] + (far[0] - near[0]) / 4, near[1] + (far[1] - near[1]) / 4};
        value[k] = given(side, what, 0, middle);
    }
    return complex->length[complex->boundary_edge[e]] / 2;
}

/* A wall that moves adds to the circulation of both cells at its edge. */
static void push(struct gm_flow *flow, const struct gm_side *side, size_t e)
{
    int vertex[2];
    double speed[2];
    const double half = halves(flow, side, e, GM_GIVEN_TANGENTIAL, vertex, speed);
    for (int k = 0; k < 2; k++) {
        flow->sheet[vertex[k]] -= speed[k] * half;
        flow->speed = fmax(flow->speed, fabs(speed[k]));
    }
}

/* Walls that give heat: to cells where no other wall holds the temperature. */
static void heat_walls(const struct maker *maker)
{
    struct gm_flow *flow = maker->flow;
    for (size_t e = 0; flow->heat && e < flow->complex->boundary; e++) {
        const struct gm_side *side = &maker->sides[maker->side_of[e]];
        int vertex[2];
        double heat[2];
        if (!side->heats) {
            continue;
        }
        const double half = halves(flow, side, e, GM_GIVEN_HEAT, vertex, heat);
        for (int k = 0; k < 2; k++) {
            const int v = vertex[k];
            flow->heating[v] += heat[k] * half;
            if (!flow->temperature_fixed[v]) {
                flow->temperature_holder[v] = (unsigned char)(1 + (side - maker->sides));
            }
        }
    }
}

static void set_walls(const struct maker *maker)
{
    struct gm_flow *flow = maker->flow;
    const struct gm_complex *complex = flow->complex;
    for (size_t e = 0; e < complex->boundary; e++) {
        const struct gm_side *side = &maker->sides[maker->side_of[e]],
                             *before = &maker->sides[maker->side_of[gm_complex_previous(complex, e)]];
        const int v = complex->boundary_vertex[e];
        const bool slip = side->kind == GM_EDGE_SLIP && before->kind == GM_EDGE_SLIP;
        flow->kind[v] = slip ? GM_VERTEX_SLIP : GM_VERTEX_FIXED;
        for (int what = GM_GIVEN_THETA; what <= GM_GIVEN_TEMPERATURE; what++) {
            /* the values of inlets depend on s, which only openings have */
            const struct gm_side *holder = winner(before, side, (enum gm_given)what);
            hold(maker, (enum gm_given)what, v, holder && !is_open(holder) ? holder : NULL, 0);
        }
        if (side->kind == GM_EDGE_LID) {
            push(flow, side, e);
        }
        if (side->kind == GM_EDGE_INLET) {
            flow->speed = fmax(flow->speed, fabs(side->speed));
        }
    }
}

enum gm_boundary_fault gm_flow_set_sides(struct gm_flow *flow, const unsigned char *side_of,
                                         const struct gm_side *sides, enum gm_vertex_kind outlet)
{
    const struct gm_complex *complex = flow->complex;
    const struct maker maker = {flow, side_of, sides, outlet};
    flow->openings = flow->holes = 0;
    memset(flow->sheet, 0, complex->vertices * sizeof *flow->sheet);
    memset(flow->heating, 0, complex->vertices * sizeof *flow->heating);
    number_holes(flow);
    enum gm_boundary_fault fault = find_openings(&maker);
    if (fault != GM_BOUNDARY_OK) {
        return fault;
    }
    set_walls(&maker);
    heat_walls(&maker);
    fault = share_flow(&maker);
    if (fault != GM_BOUNDARY_OK || flow->openings == 0) {
        return fault;
    }
    size_t start = 0;
    while (flow->opening[start].inlet) {
        start++;
    }
    /* psi rises over outlets, stays along walls, and falls over inlets */
    double level = 0, through = 0;
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[(start + i) % flow->openings],
                                *next = &flow->opening[(start + i + 1) % flow->openings];
        flow->psi[complex->boundary_vertex[opening->first]] = level;
        level = open_piece(&maker, opening, level);
        through += opening->flow;
        if (fabs(level) <= 1e-12 * through) {
            level = 0; /* all that entered has left, but for rounding */
        }
        for (size_t e = opening->end; i + 1 < flow->openings && e != next->first;
             e = gm_complex_next(complex, e)) {
            flow->psi[complex->boundary_vertex[e]] = level;
        }
    }
    list_inflow(flow);
    return GM_BOUNDARY_OK;
}
