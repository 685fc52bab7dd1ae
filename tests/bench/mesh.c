/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Processor time of a step of the r-adaptive schemes: one soliton, dt = 0.01, medians of several runs; and
   how the cost grows with the number of points. Usage: bench_mesh [runs]

   bench_mesh energy: how well two solitons keep their energy to t = 2000, and what that costs, with constant
   and time-symmetric steps and with densities; rows of like cost compare. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/files/files.h"
#include "core/mesh/user/potential.h"
#include "core/model/equations.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/user/line.h"
#include "tests/bench/timing.h"
#include "tests/common/mesh_soliton.h"

/* A row of the table: a scheme on one soliton, of this program's C or of the built-in file with these lines. */
struct row {
    const char *scheme;
    long points, steps;
    const char *density, *cell, *map; /* no density: the soliton is C */
};

/* Microseconds a step, the median over the runs; negative if a run failed. */
static double time_steps(const struct row *row, const struct gm_problem *problem, int runs)
{
    enum { MOST = 99 };
    /* the same Courant number on every mesh: Lobatto IIIA-IIIB is explicit in what it knows of waves */
    const double dt = row->points <= 31 ? 0.01 : 0.01 * 32 / (double)(row->points + 1);
    const struct gm_settings settings = {0};
    const struct gm_scheme *scheme = gm_scheme_find(row->scheme);
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    struct gm_mesh mesh;
    double times[MOST];
    moving->describe(problem, &mesh);
    double *state = malloc(problem->n * sizeof *state);
    bool good = state && scheme &&
                gm_mesh_start(&mesh, gm_scheme_mesh(scheme), moving->start, problem->parameters, state);
    for (int i = 0; i < runs && i < MOST && good; i++) {
        struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, dt, state);
        if (!run) {
            good = false;
            break;
        }
        const double before = seconds();
        good = gm_run_advance(run, row->steps) == GM_OK;
        times[i] = 1e6 * (seconds() - before) / (double)row->steps;
        if (i == 0 && row->points == 31) {
            printf("  %-24s %5.2f residuals, %5.3f factorisations a step\n", row->scheme,
                   (double)run->evaluations / (double)run->steps,
                   gm_mesh_factorisations(run) / (double)run->steps);
        }
        gm_run_close(run);
    }
    free(state);
    return good ? median(times, (size_t)(runs < MOST ? runs : MOST)) : -1;
}

static double measure(const struct row *row, int runs)
{
    struct gm_problem problem;
    if (!row->density) {
        const struct gm_soliton soliton = {
            .solitons = 1, .points = row->points, .velocity = 0.9, .length = 25, .alpha = 2.5};
        gm_soliton_problem(&soliton, &problem);
        return time_steps(row, &problem, runs);
    }
    const struct gm_built_in *file = gm_built_in_find(GM_FILE_SYSTEM, "soliton");
    struct gm_user_system system;
    struct gm_user_wave wave;
    struct gm_fault fault;
    double *values = gm_equations_open(&system, file->text, file->length, NULL, 0, &fault)
                         ? gm_equations_start(&system, NULL)
                         : NULL,
           time = -1;
    const struct gm_user_mesh chosen = {.length = 25,
                                        .points = row->points,
                                        .alpha = NAN,
                                        .density = row->density,
                                        .map = row->map,
                                        .cell = row->cell};
    if (values && gm_user_wave_derive(&wave, &system)) {
        time = gm_user_mesh_open(&problem, &wave, values, &chosen) ? time_steps(row, &problem, runs) : -1;
        gm_user_line_close(&problem);
    }
    free(values);
    gm_system_close(&system);
    return time;
}

static void keep_energy(const char *name, int density, double alpha, double dt)
{
    static const char *const densities[] = {"arclength", "curvature", "mix", "limited", "tempered"};
    const struct gm_soliton soliton = {
        .solitons = 2, .density = density, .points = 25, .velocity = 0.9, .length = 25, .alpha = alpha};
    const struct gm_settings settings = {0};
    const struct gm_scheme *scheme = gm_scheme_find(name);
    struct gm_problem problem;
    struct gm_mesh mesh;
    double state[100];
    gm_soliton_problem(&soliton, &problem);
    gm_moving_mesh_of(&problem)->describe(&problem, &mesh);
    struct gm_run *run = NULL;
    if (!scheme || !gm_mesh_start(&mesh, GM_MESH_MOVING, gm_soliton_profile, &soliton, state) ||
        !(run = gm_run_open(&problem, scheme, &settings, 0, dt, state))) {
        printf("  %s could not be started\n", name);
        return;
    }
    const double initial = gm_mesh_energy(&mesh, state);
    double spent = 0, farthest = 0, error = 0;
    while (run->t < 2000 && run->status == GM_OK) {
        const double before = seconds();
        gm_run_advance(run, 1);
        spent += seconds() - before;
        const double *end = gm_run_state(run);
        farthest = fmax(farthest, fabs(gm_mesh_energy(&mesh, end) / initial - 1));
        for (size_t k = 0; run->t <= 50 && k < 25; k++) {
            error = fmax(error, fabs(end[k] - gm_soliton_exact(&soliton, end[25 + k], run->t)));
        }
    }
    printf("  %-22s %-10s %5.2f %6.3f %9.2f %12.1e %9.2f   %s at %.0f\n", name, densities[density], alpha, dt,
           spent, farthest, error, gm_status_name(run->status), run->t);
    gm_run_close(run);
}

static int keep_energies(void)
{
    printf("two solitons, 25 points, to t = 2000\n  %-22s %-10s %5s %6s %9s %12s %9s\n", "scheme", "density",
           "alpha", "dt", "CPU s", "energy err", "err t<50");
    for (double dt = 0.05; dt > 0.034; dt -= 0.005) {
        keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 1.5, dt);
        keep_energy("multiplier-adaptive4", GM_ARCLENGTH, 1.5, dt);
        keep_energy("multiplier-lobatto4", GM_LIMITED, 1.5, dt);
        keep_energy("multiplier-adaptive4", GM_LIMITED, 1.5, dt);
    }
    keep_energy("multiplier-lobatto4", GM_TEMPERED, 1.5, 0.05);
    keep_energy("multiplier-lobatto4", GM_TEMPERED, 1.5, 0.045);
    keep_energy("multiplier-lobatto4", GM_TEMPERED, 1.5, 0.04);
    keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 1, 0.05);
    keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 1.25, 0.05);
    keep_energy("multiplier-lobatto4", GM_ARCLENGTH, 2, 0.05);
    keep_energy("multiplier-lobatto4", GM_LIMITED, 2, 0.05);
    keep_energy("multiplier-lobatto4", GM_LIMITED, 2, 0.045);
    keep_energy("multiplier-lobatto4", GM_LIMITED, 2, 0.04);
    return 0;
}

int main(int count, char **words)
{
    if (count > 1 && strcmp(words[1], "energy") == 0) {
        return keep_energies();
    }
    const int runs = count > 1 && atoi(words[1]) > 0 ? atoi(words[1]) : 5;
    /* wanted: the file at most 1.5 of C, a typed density at most 1.3 of arclength; free and given steps at most 1.5 of
       those of multipliers with as many stages */
    /* `same` moves nodes as arclength does: it costs what a typed density costs; another mesh needs other factors */
    static const char typed[] = "sqrt(1 + 2*u_x^2 + 0.3*u^2)", same[] = "sqrt(1 + alpha^2*u_x^2 + 1e-9*u^2)",
                      inertia[] = "0.5*(d_t/d)^2", swings[] = "X = x + sin(pi*x/25)*sin(t)";
    static const struct row rows[] = {{"uniform-gauss4", 31, 1000, NULL, NULL, NULL},
                                      {"control-gauss4", 31, 1000, NULL, NULL, NULL},
                                      {"control-radau5", 31, 1000, NULL, NULL, NULL},
                                      {"multiplier-lobatto2", 31, 1000, NULL, NULL, NULL},
                                      {"multiplier-trapezoidal", 31, 1000, NULL, NULL, NULL},
                                      {"multiplier-lobatto4", 31, 1000, NULL, NULL, NULL},
                                      {"multiplier-lobatto4", 31, 1000, "arclength", NULL, NULL},
                                      {"multiplier-lobatto4", 31, 1000, same, NULL, NULL},
                                      {"multiplier-lobatto4", 31, 1000, typed, NULL, NULL},
                                      {"control-gauss4", 31, 1000, "arclength", NULL, NULL},
                                      {"multiplier-lobatto2", 31, 1000, "arclength", NULL, NULL},
                                      {"free-gauss2", 31, 600, "arclength", inertia, NULL},
                                      {"free-gauss4", 31, 600, "arclength", inertia, NULL},
                                      {"given-gauss4", 31, 1000, "arclength", NULL, swings},
                                      {"given-lobatto4", 31, 1000, "arclength", NULL, swings}};
    printf("31 points, steps of 0.01\n");
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        printf("  %-24s %8.2f us a step, %s\n", rows[i].scheme, measure(&rows[i], runs),
               rows[i].density ? rows[i].density : "in C");
    }
    printf("multiplier-lobatto4, 40 steps of 0.32 / (points + 1)\n  %8s %12s %14s\n", "points", "us a step",
           "ns a point");
    for (long points = 63; points <= 4095; points = 2 * points + 1) {
        const double time = measure(&(struct row){"multiplier-lobatto4", points, 40, NULL, NULL, NULL}, runs);
        printf("  %8ld %12.1f %14.1f\n", points, time, 1e3 * time / (double)points);
    }
    return 0;
}
