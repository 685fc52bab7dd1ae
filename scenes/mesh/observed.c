/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes/mesh/observed.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "scenes/common/lane.h"

enum { PATHS = 255 /* most nodes whose paths are recorded */, RECORDS = 400 };

struct gm_mesh gm_mesh_of(const struct gm_view *view)
{
    struct gm_mesh mesh = gm_mesh_of_problem(view->problem);
    mesh.cell = view->scheme && gm_scheme_mesh(view->scheme) == GM_MESH_FREE ? mesh.cell : NULL;
    return mesh;
}

double gm_view_mesh_measure(const struct gm_view *view)
{
    /* in the order of enum gm_mesh_measure; energy_error is the energy, until its start is subtracted */
    static const char *const keys[] = {"energy", "momentum_error", "constraint_defect", "straightest",
                                       "smallest_cell"};
    const struct gm_mesh mesh = gm_mesh_of(view);
    size_t i = 0;
    while (strncmp(view->observable->key, keys[i], strlen(keys[i])) != 0) {
        i++;
    }
    return i == GM_MEASURE_DEFECT && gm_scheme_mesh(view->scheme) != GM_MESH_MOVING
               ? NAN
               : gm_mesh_measure(&mesh, view->state, (enum gm_mesh_measure)i);
}

double gm_mesh_exact(const struct gm_view *view, double x, double t)
{
    return gm_moving_mesh_of(view->problem)->exact(view->problem->parameters, x, t);
}

double gm_mesh_distance(const struct gm_lane *lane, const struct gm_lane *finer)
{
    const struct gm_view view = gm_lane_view(lane), other = gm_lane_view(finer);
    const struct gm_mesh mesh = gm_mesh_of(&other);
    const size_t points = lane->problem.n / 4, finest = mesh.points;
    double largest = 0;
    for (size_t k = 0, right = 0; k < points; k++) {
        const double x = view.state[points + k];
        while (right < finest && other.state[finest + right] < x) {
            right++;
        }
        const double u0 = right > 0 ? other.state[right - 1] : mesh.left,
                     u1 = right < finest ? other.state[right] : mesh.right,
                     x0 = right > 0 ? other.state[finest + right - 1] : mesh.first,
                     x1 = right < finest ? other.state[finest + right] : mesh.first + mesh.length;
        largest = gm_larger(largest, fabs(view.state[k] - u0 - (u1 - u0) * (x - x0) / (x1 - x0)));
    }
    return largest;
}

static double mesh_error(const struct gm_view *view)
{
    const size_t points = view->problem->n / 4;
    double largest = 0;
    for (size_t k = 0; k < points; k++) {
        const double difference =
            fabs(view->state[k] - gm_mesh_exact(view, view->state[points + k], view->t));
        largest = gm_larger(largest, difference);
    }
    return largest;
}

/* Returns the time by which the exact solution has to be shifted to fit the nodes best (least squares, by
   Gauss and Newton's iteration): positive if the numerical one is ahead. NaN if no shift below 1 is found, as
   at a bounce, where the field is at rest, or if no exact solution is known. */
static double lead(const struct gm_view *view)
{
    enum { MOST_ITERATIONS = 6 };
    const double near = 1e-5, close_enough = 1e-4;
    const size_t points = view->problem->n / 4;
    double shift = 0;
    for (int i = 0; i < MOST_ITERATIONS; i++) {
        double sum = 0, weight = 0;
        for (size_t k = 0; k < points; k++) {
            const double x = view->state[points + k], t = view->t + shift;
            const double exact = gm_mesh_exact(view, x, t);
            const double rate = (gm_mesh_exact(view, x, t + near) - exact) / near;
            sum += (view->state[k] - exact) * rate;
            weight += rate * rate;
        }
        shift += sum / weight;
        if (!(fabs(sum / weight) > close_enough)) {
            break;
        }
    }
    return fabs(shift) < 1 ? shift : NAN;
}

const struct gm_observable gm_mesh_errors[2] = {
    GM_LOG_OBSERVABLE("solution_error", mesh_error, "error  max |u − exact| at the nodes"),
    GM_OBSERVABLE("lead", lead, "time ahead of the exact solution",
                  .missing = "no shift in time brings the exact solution near"),
};

static double field_energy(const struct gm_view *view)
{
    struct gm_mesh mesh = gm_mesh_of(view);
    const bool adds = mesh.cell;
    mesh.cell = NULL;
    return adds ? gm_mesh_energy(&mesh, view->state) : NAN;
}

/* The rank of the mass matrix, or its condition, by the observable's key. */
static double mass(const struct gm_view *view)
{
    const struct gm_mesh mesh = gm_mesh_of(view);
    double rank, condition;
    const bool good = gm_mesh_mass(&mesh, view->state, &rank, &condition);
    return !good ? NAN : strcmp(view->observable->key, "mass_rank") == 0 ? rank : condition;
}

const struct gm_observable gm_mesh_asked[3] = {
    GM_LOG_OBSERVABLE("straightest", gm_view_mesh_measure, "least difference of slopes at a node"),
    GM_OBSERVABLE("mass_rank", mass, "rank of the mass matrix", .missing = "there are more than 255 nodes"),
    GM_LOG_OBSERVABLE("mass_condition", mass, "condition of the mass matrix",
                      .missing = "there are more than 255 nodes"),
};

static double multiplier_norm(const struct gm_view *view)
{
    return gm_mesh_multiplier_norm(view->run);
}

double gm_view_newton_iterations(const struct gm_view *view)
{
    return (double)view->run->iterations;
}

double gm_view_factorisations(const struct gm_view *view)
{
    return gm_mesh_factorisations(view->run);
}

const struct gm_observable gm_mesh_observables[8] = {
    GM_OBSERVABLE("energy", gm_view_mesh_measure, "discrete energy"),
    GM_KEPT_OBSERVABLE("energy_error", gm_view_mesh_measure, "E", "energy error"),
    /* cells take energy from the field, so that it is not lost */
    GM_LOG_OBSERVABLE("field_energy_error", field_energy, "energy error of the field alone", .error = true,
                      .symbol = "E", .missing = "cells have no energy of their own"),
    GM_LOG_OBSERVABLE("constraint_defect", gm_view_mesh_measure, "defect of the mesh constraint",
                      .missing = "nothing constrains this mesh"),
    GM_OBSERVABLE("multiplier_norm", multiplier_norm, "largest multiplier"),
    GM_MESH_SOLVING,
};

/* Paths of all nodes, or of evenly chosen ones. */
static size_t path_stride(size_t points)
{
    return (points + PATHS - 1) / PATHS;
}

static size_t path_count(const struct gm_view *view)
{
    const size_t points = gm_mesh_of(view).points, stride = path_stride(points);
    return (points + stride - 1) / stride;
}

static double path_interval(const void *parameters)
{
    return ((const struct gm_timing *)parameters)->until / (RECORDS / 2 - 1);
}

static void record_paths(const struct gm_view *view, double *entry)
{
    const struct gm_mesh mesh = gm_mesh_of(view);
    const size_t stride = path_stride(mesh.points);
    for (size_t k = 0; k < mesh.points; k += stride) {
        *entry++ = view->state[gm_mesh_place(&mesh) + k];
    }
}

const struct gm_track gm_mesh_paths_track = {
    .key = "paths", .width = path_count, .interval = path_interval, .bound = RECORDS, .record = record_paths};
